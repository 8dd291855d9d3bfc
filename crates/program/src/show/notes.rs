//! Remarks on a model before any computation, a sentence each.

use crate::show::digits::Digits;
use crate::show::words::{accuracy, known_to, listed, noise_unknown, spoken};
use corner_impact::cam::Stray;
use corner_impact::measured::{CamUncertainty, Remarks};
use corner_impact::model::{Model, ModelError, TableProfile};

/// Remarks on a model at the requested speeds, rpm, or at those of `[study]`: numbers in unlikely units, rows with apparent errors, and
/// given values that contradict the rows.
pub fn notes(model: &Model, rpm: Option<[f64; 2]>) -> Result<Vec<String>, ModelError> {
    let mut notes: Vec<String> = model.doubt(rpm)?.into_iter().collect();
    let Some(profile) = model.table() else { return Ok(notes) };
    notes.extend(profile.doubts());
    let Remarks { strays, loose, smoothed_away, contradicted } = Remarks::on(model)?;
    let reading = &profile.reading;
    let told = |length: f64| Digits::Aligned(2).text(reading.in_model.told(length));
    notes.extend(slips(profile, &strays));
    notes.extend(loose.map(|[within, spread]| {
        format!(
            "cam.tolerance: {} {unit} is far more than the spread of the rows, about {} {unit}; the spline may smooth features of the cam away, \
             and ± does not include that",
            told(within),
            told(spread),
            unit = reading.unit
        )
    }));
    notes.extend(smoothed_away.map(|[distance, allowed]| {
        format!(
            "cam.tolerance: the smoothed cam is up to {} {unit} from the rows, far more than their decimals; if the rows are that accurate, set \
             tolerance = {} in [cam]",
            told(distance),
            told(allowed),
            unit = reading.unit
        )
    }));
    notes.extend(contradicted.map(|row| {
        format!(
            "{}: the rows contradict it: at {} deg the cam is {} {} from them",
            row.field,
            row.cam_angle_deg,
            told(row.off_m),
            reading.unit
        )
    }));
    Ok(notes)
}

/// Rows that lie far from the trend of their neighbours; only the first are named.
fn slips(profile: &TableProfile, strays: &[Stray]) -> Vec<String> {
    /// Largest number of rows that are named.
    const NAMED: usize = 3;
    let reading = &profile.reading;
    let told = |Stray { line, cam_angle_deg, lift_m, off_m }: &Stray| {
        let place = profile.file.as_ref().map_or("cam.rows".into(), |file| format!("{file}, line {line}"));
        let (lift, off, unit) = (reading.in_model.told(*lift_m), reading.in_model.told(*off_m), &reading.unit);
        let side = if off < 0.0 { "below" } else { "above" };
        let off = Digits::Aligned(2).text(off.abs());
        format!(
            "{place}: {} {lift} at {cam_angle_deg} deg is {off} {unit} {side} the trend of the rows beside it: is it a slip, or does the cam \
             turn sharply there?",
            reading.holds.value()
        )
    };
    let mut slips: Vec<String> = strays.iter().take(NAMED).map(told).collect();
    if strays.len() > NAMED {
        slips.push(format!("{} more rows are off as well: `cam --json` lists them", strays.len() - NAMED));
    }
    slips
}

/// Uncertainty of the machine, for a result without its own ±; `None` if the rows have no noise and the numbers no errors.
pub fn as_drawn(model: &Model) -> Result<Option<String>, ModelError> {
    let numbers: Vec<String> = model.errors.uncertain().map(|(name, _)| spoken(name)).collect();
    let exact = (!numbers.is_empty()).then(|| {
        let numbers = listed(&numbers);
        format!(
            "the results take {numbers} as exact and have no ± from their errors: `speeds`, `design`, `locate`, `verify` and `orbit` give a ±"
        )
    });
    let drawn = cam_as_drawn(model)?;
    Ok(match (drawn, exact) {
        (Some(drawn), Some(exact)) => Some(format!("{drawn}; {exact}")),
        (drawn, exact) => drawn.or(exact),
    })
}

fn cam_as_drawn(model: &Model) -> Result<Option<String>, ModelError> {
    let Some((open, profile)) = CamUncertainty::of(model)?.zip(model.table()) else { return Ok(None) };
    let (accuracy, open) = match open {
        CamUncertainty::Told(cam) => {
            let percent = Digits::Aligned(2).text(100.0 * cam.curvature_error / cam.largest_curvature);
            (accuracy(&cam), format!("by {percent} % of its largest value"))
        }
        CamUncertainty::Unknown(why) => return Ok(Some(noise_unknown(&why))),
        CamUncertainty::Noise(spread) => (known_to(&profile.reading, spread), "by an amount that `cam` prints".into()),
    };
    Ok(Some(format!(
        "{accuracy}, so the cam's second derivative is uncertain {open}; the results are for the cam as it is drawn through the rows, \
         without a ±: `speeds`, `design` and `orbit` give a ±"
    )))
}
