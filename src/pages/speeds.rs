//! The page of `speeds`: the short answer first, then every attractor with where it begins and ends.

use crate::measured::Measured;
use crate::orbit::long_run::Budget;
use crate::show::Paged;
use crate::show::block::{Block, Column, Mark, Table, Words, words};
use crate::show::digits::{Digits, with_error};
use crate::show::words;
use crate::study::attractors::Change;
use crate::study::speeds::{Attractor, Speeds};
use crate::study::survey::Sample;

impl Paged for Speeds {
    fn blocks(&self) -> Vec<Block> {
        let [low, high] = self.rpm;
        let heading = |text: String| Block::Line((Mark::Heading, text.as_str()).into());
        let mut page = vec![heading(format!("{}, {low} to {high} rpm", self.model)), Block::Gap];
        page.push(Block::Line(words!["  leaves the cam first at  ", detachment(self)]));
        let together = together(self);
        let together =
            if together.is_empty() { "nowhere".into() } else { words![Words::joined(together, ", "), " rpm"] };
        page.extend([
            Block::Line(words!["  several attractors        ", together]),
            Block::Gap,
            Block::Table(table(self)),
        ]);
        for attractor in &self.attractors {
            page.extend(rests(attractor).map(Block::paragraph));
        }
        page.extend(self.off_for_good().map(|off| Block::paragraph(off.words)));
        page.extend(dangers(self));
        page.push(Block::paragraph(how(self)));
        page.extend(self.measured.iter().filter_map(cam));
        page.extend(self.failed.iter().map(|failed| {
            let what = match failed.starts {
                Some(1) => "one start".to_owned(),
                Some(starts) => format!("{starts} starts"),
                None => "nothing".to_owned(),
            };
            let of_them = if failed.starts.is_some() { "could not be run" } else { "could be run" };
            Block::paragraph(format!("At {} rpm {what} {of_them}: {}.", failed.speed_rpm, failed.why))
        }));
        page
    }
}

/// Where there are several attractors, ranges that meet as one.
pub(crate) fn together(found: &Speeds) -> Vec<Words> {
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for over in &found.coexistence {
        match joined.last_mut() {
            Some(last) if over.from_rpm <= last[1] => last[1] = over.to_rpm,
            _ => joined.push([over.from_rpm, over.to_rpm]),
        }
    }
    joined.into_iter().map(|[from, to]| words![open_to(found, from), "–", open_to(found, to)]).collect()
}

/// Where attractors begin and end.
fn ends(found: &Speeds) -> impl Iterator<Item = &Change> {
    found.attractors.iter().flat_map(|attractor| attractor.birth.iter().chain(&attractor.death))
}

/// A speed at which an attractor begins or ends, in no more digits than a measured cam leaves it.
fn open_to(found: &Speeds, rpm: f64) -> Words {
    match ends(found).find(|end| end.rpm == rpm) {
        Some(end) => words![(rpm, open(found, end).map_or(Digits::Fixed(2), |error| with_error(error).0))],
        None => words![(rpm, Digits::Fixed(2))],
    }
}

/// How far a measured cam may have moved an end, as far as digits go, rpm: one of which that is not known has no more of them than
/// the best known, and no decimals where none is known.
fn open(found: &Speeds, end: &Change) -> Option<f64> {
    const WHOLE: f64 = 10.0;
    let best = || ends(found).filter_map(|end| end.error).reduce(f64::min);
    end.error.or_else(|| Measured::noisy(&found.measured).map(|_| best().unwrap_or(WHOLE)))
}

/// Where the follower first leaves the cam.
pub(crate) fn detachment(found: &Speeds) -> Words {
    match found.detachment() {
        Some([rpm, _]) => measured_speed(rpm, Digits::Fixed(6), found.detachment_error(), found.measured.as_ref()),
        None if found.separation.speed() > found.rpm[1] => "no speed in between".into(),
        None => format!("{} rpm already, or below", found.rpm[0]).into(),
    }
}

/// A speed with what the accuracy of a measured cam leaves open, and why.
pub(crate) fn measured_speed(rpm: f64, digits: Digits, error: Option<f64>, cam: Option<&Measured>) -> Words {
    match (error, cam.filter(|cam| cam.is_noisy)) {
        (Some(error), Some(cam)) => {
            let (digits, error) = with_error(error);
            words![(rpm, digits), " ± ", (error, digits), format!(" rpm: {}", words::accuracy(cam))]
        }
        (None, Some(cam)) => {
            words![(rpm, digits), format!(" rpm, and how far off is not known: {}", words::accuracy(cam))]
        }
        _ => words![(rpm, digits), " rpm"],
    }
}

/// How it was found out, and what that can miss.
pub(crate) fn how(found: &Speeds) -> String {
    const LOCATED: &str = " A speed with six decimals was located by the equations of what happens there; others are known from runs \
                           alone, to the digits shown.";
    let located = if Measured::noisy(&found.measured).is_some() { "" } else { LOCATED };
    let Budget { transient, patience, .. } = found.budget;
    let followed = format!(
        " Runs that settle on nothing within {transient} revolutions are followed for {patience} more, all of a speed together, before \
         that is called chaos: a rest that is rarer than that is not seen."
    );
    let step = found.step;
    if let Sample::Given(starts) = &found.sample {
        let starts = words::many(starts.len() as u64, "start");
        return format!(
            "Sampled: {starts} that {} given, at each of the speeds {step} rpm apart.{followed}{located}",
            if starts == "1 start" { "is" } else { "are" }
        );
    }
    let listed = if found.two_impacts { ", and of two in one that a search by intervals finds" } else { "" };
    format!(
        "Sampled: {} starts at each of the speeds {step} rpm apart, on the cam at any angle and up to the velocity that impacts keep \
         up; rest on the cam wherever that lets go; and the stable orbits of one impact in up to three revolutions{listed}. Another \
         attractor with a basin of less than {:.1} % of the starts may be missed at a speed, and what is there between two speeds only.{followed}{located}",
        found.sample.count(),
        100.0 * found.missed(),
    )
}

/// What errors stand for, where the cam is measured.
pub(crate) fn cam(measured: &Measured) -> Option<Block> {
    if let Some(why) = &measured.noise_unknown {
        return Some(Block::paragraph(words::noise_unknown(why)));
    }
    let words = format!(
        "± is what the cam leaves open, {}: how far the event moves among cams that are as likely. It is ? where that is not known: \
         the event is not there on each of those cams, or runs could not tell.",
        words::accuracy(measured)
    );
    measured.is_noisy.then(|| Block::paragraph(words))
}

/// How often a motion rests that bounces as chaos does in between.
pub(crate) fn rests(attractor: &Attractor) -> Option<String> {
    let rests = attractor.rests()?;
    let id = &attractor.id;
    Some(match rests.rate_error {
        Some(error) => format!(
            "{id} rests on the cam once in {:.0} ± {:.0} revolutions where it is chaotic in between ({} rests in {} revolutions): \
             what looks like chaos there is on its way to a rest, and repeats from then on.",
            1.0 / rests.rate,
            error / rests.rate.powi(2),
            rests.rests,
            rests.revolutions
        ),
        None => format!(
            "{id} did not rest on the cam once in {} revolutions: if it ever does, it is less than once in {:.0}.",
            rests.revolutions,
            1.0 / rests.rate
        ),
    })
}

/// The corner impacts at which there is danger.
pub(crate) fn dangers(found: &Speeds) -> impl Iterator<Item = Block> {
    found.dangers.iter().map(|it| {
        let (speed, angle) = ((it.speed_rpm, Digits::Fixed(6)), (it.cam_angle.to_degrees(), Digits::Fixed(2)));
        let attractors = it.attractors.join(", ");
        let mut words = words!["At ", speed, " rpm ", attractors, " has a corner impact at ", angle, " deg: "];
        let lines = std::iter::once(words::danger(&it.danger)).chain(words::returns(&it.danger));
        words.push(words![Words::joined(lines, "; "), "."]);
        Block::paragraph(words)
    })
}

/// The attractors, with where each begins and ends.
pub(crate) fn table(found: &Speeds) -> Table {
    let columns = [
        Column::left("", 2, 3),
        Column { gap: 1, ..Column::right("from (rpm)", 10) },
        Column { gap: 1, ..Column::right("to (rpm)", 10) },
        Column::left("motion", 2, 20),
        Column { gap: 1, ..Column::right("starts (%)", 8) },
        Column::left("begins with – ends with", 2, 0),
    ];
    let mut table = Table::new("Attractors by rising speed", columns);
    for attractor in &found.attractors {
        let shares = || attractor.at.iter().map(|at| 100.0 * at.share.value);
        let [least, most] = [shares().fold(f64::INFINITY, f64::min), shares().fold(0.0, f64::max)];
        let share = match (least, most) {
            (least, most) if least.round() == most.round() => format!("{most:.0}"),
            (least, most) if least.is_finite() => format!("{least:.0}–{most:.0}"),
            _ => String::new(),
        };
        let ends = [&attractor.birth, &attractor.death];
        let [from, to] = [0, 1].map(|side| speed(found, attractor.rpm[side], ends[side].as_ref()));
        let ends = ends.map(|end| end.as_ref().map_or(String::new(), words::change)).join(" – ");
        table.row([
            attractor.id.as_str().into(),
            from,
            to,
            words::attractor(attractor).into(),
            share.into(),
            ends.into(),
        ]);
    }
    table
}

/// A speed to the digits that it is known to.
fn speed(found: &Speeds, rpm: f64, change: Option<&Change>) -> Words {
    /// Of a located speed.
    const LOCATED: f64 = 6.0;
    let Some(change) = change else { return words![(rpm, Digits::UpTo(LOCATED as usize))] };
    let places = match open(found, change).map(with_error) {
        Some((digits, error)) if change.error.is_some() => return words![(rpm, digits), " ± ", (error, digits)],
        Some((digits, _)) => return words![(rpm, digits), " ± ?"],
        None if change.is_located() => LOCATED,
        None => (-(change.bracket[1] - change.bracket[0]).log10()).ceil().clamp(0.0, LOCATED),
    };
    words![(rpm, Digits::Fixed(places as usize))]
}
