//! Accuracy of a cam given by the rows of a table, estimated from the rows themselves, and the cams that are equally likely.
//!
//! The best estimate of the cam is the smoothing spline. Tables of its lifts with the noise of the rows, smoothed in the same way, are as
//! likely as the measured table. Their spread gives the uncertainty of everything that depends on the cam; their common offset is the
//! effect of the smoothing itself.

use rayon::prelude::*;
use serde::Serialize;

use crate::cam::{Cam, Fit, Stray, fit, spline_of_rows, spread, strays};
use crate::model::{Model, ModelError, Reading, Smoothing, SmoothingTolerance, TableProfile, TableRow};
use crate::tolerance;

/// Accuracy of a measured cam.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// Interpretation of the rows.
    pub reading: Reading,
    /// Step of the decimal grid of all lifts, m; `None` if no such step is above the rounding of a double.
    pub step_m: Option<f64>,
    /// Standard deviation of the rows about a smooth motion, m, by generalised cross-validation; NaN if it is unknown.
    pub noise_m: f64,
    /// Reason why the noise of a spline through the rows is unknown: no smooth motion could be fitted to them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise_unknown: Option<String>,
    /// Rows far from the value that their neighbours suggest.
    pub strays: Vec<Stray>,
    /// Largest distance of the cam from a row, m.
    pub largest_distance_m: f64,
    /// Whether the noise of the rows changes results that depend on the second derivative.
    pub is_noisy: bool,
    /// Whether the cam is a smoothing spline.
    pub is_smoothed: bool,
    /// Places of the jumps of a smoothing spline's second derivative, degrees.
    pub corners_deg: Vec<f64>,
    /// Whether the corners were found in the rows, not given.
    pub corners_are_found: bool,
    /// Angles that may be corners and are left out of the cam; `None` if there is no doubt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub doubtful_corners: Option<DoubtfulCorners>,
    /// Dwells of a smoothing spline, from and to, degrees.
    pub dwells_deg: Vec<[f64; 2]>,
    /// Whether the dwells were found in the rows, not given.
    pub dwells_are_found: bool,
    /// Largest second derivative of the cam, m/rad^2.
    pub largest_curvature: f64,
    /// Uncertainty of the largest second derivative, m/rad^2; NaN if the noise is unknown.
    pub curvature_error: f64,
}

impl Measured {
    /// Returns the measured cam if its noise makes results uncertain.
    pub fn noisy(measured: &Option<Self>) -> Option<&Self> {
        measured.as_ref().filter(|cam| cam.is_noisy)
    }

    /// Largest likely error of a row, m: that of rounding, or of the spread of the rows.
    pub fn row_error(&self) -> f64 {
        row_error(self.step_m.unwrap_or(0.0) / 2.0, self.noise_m)
    }

    /// Whether the noise is rounding alone.
    pub fn is_rounded(&self) -> bool {
        /// Noise above which it is more than rounding, in standard deviations of the rounding.
        const MORE: f64 = 1.5;
        self.step_m.is_some_and(|step| self.noise_m <= MORE * step / 12.0_f64.sqrt())
    }
}

/// Angles where a jump of the acceleration fits the rows better than a smooth motion, but not by enough to be certain.
#[derive(Clone, Debug, Serialize)]
pub struct DoubtfulCorners {
    /// Places, degrees.
    pub at_deg: Vec<f64>,
    /// Line of the model file that rules them out.
    pub ruled_out_by: String,
    /// Line of the model file that makes them corners.
    pub ruled_in_by: String,
}

impl DoubtfulCorners {
    /// Doubtful corners of a fitted spline.
    fn of(fitted: &Fit) -> Option<Self> {
        let at_deg = Some(fitted.doubtful_deg()).filter(|doubtful| !doubtful.is_empty())?;
        let line = |mut corners: Vec<f64>| {
            corners.sort_by(f64::total_cmp);
            let corners: Vec<String> =
                corners.iter().map(|corner| ((corner * 1000.0).round() / 1000.0).to_string()).collect();
            format!("corners_deg = [{}]", corners.join(", "))
        };
        let certain = fitted.corners_deg();
        let (ruled_out_by, ruled_in_by) = (line(certain.clone()), line([certain, at_deg.clone()].concat()));
        Some(Self { at_deg, ruled_out_by, ruled_in_by })
    }
}

/// Model with its cam.
pub type LikelyCam = (Model, Cam);

/// Best estimate of a measured cam, and other cams that are equally likely, as models.
#[derive(Clone, Debug)]
pub struct PlausibleCams {
    /// Accuracy of the model's cam.
    pub measured: Measured,
    /// Model with the smoothing spline; `None` if the rows have no noise that a spline through them would follow.
    pub best: Option<LikelyCam>,
    /// Model with ten times the weight of the best estimate on the rows, for a cam with corners.
    pub closer: Option<LikelyCam>,
    /// Models of tables that might have been measured.
    pub others: Vec<LikelyCam>,
}

/// Largest error, m, that is uniformly distributed like rounding, from half a step of the decimals and a standard deviation.
fn row_error(half_step: f64, noise: f64) -> f64 {
    half_step.max(3.0_f64.sqrt() * noise)
}

/// Number of tables that might have been measured: the largest of this many deviations is near two standard deviations.
const TABLES: u64 = 16;
/// One in this many tables may lack a number, or have no cam.
const WITHOUT: usize = 8;

impl PlausibleCams {
    /// One in this many machines may lack the numbers.
    pub(crate) const WITHOUT: usize = 8;

    /// Estimates the accuracy of a model's cam; `None` if the cam is not given by a table, or if the table has too few rows.
    ///
    /// A spline through the rows needs no smoothing: if no smooth motion can be fitted to them, only their noise is unknown. The same
    /// applies if the follower does not fit on likely contours.
    pub fn of(model: &Model) -> Result<Option<Self>, ModelError> {
        let Some(profile) = model.table().filter(|table| table.may_be_smoothed()) else { return Ok(None) };
        let own = profile.spline.smoothing();
        match Self::fitted(model, profile, own) {
            Err(why) if own.is_none() || model.cam.contact().is_some() => Self::unknown(model, profile, &why).map(Some),
            likely => likely.map(Some),
        }
    }

    /// Accuracy of a spline through rows whose noise is unknown.
    fn unknown(model: &Model, profile: &TableProfile, why: &ModelError) -> Result<Self, ModelError> {
        let largest = curvatures(&Cam::new(model)?).into_iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        let reading = Reading::clone(&profile.reading);
        let measured = Measured {
            step_m: reading.step.map(|step| reading.in_model.inside(step)),
            reading,
            noise_m: f64::NAN,
            noise_unknown: Some(why.allowed.clone()),
            strays: strays(profile),
            largest_distance_m: 0.0,
            is_noisy: false,
            is_smoothed: false,
            corners_deg: Vec::new(),
            corners_are_found: false,
            doubtful_corners: None,
            dwells_deg: Vec::new(),
            dwells_are_found: false,
            largest_curvature: largest,
            curvature_error: f64::NAN,
        };
        Ok(Self { measured, best: None, closer: None, others: Vec::new() })
    }

    /// Estimates the accuracy from the smoothing spline near the rows.
    fn fitted(model: &Model, profile: &TableProfile, own: Option<&Smoothing>) -> Result<Self, ModelError> {
        let fitted = fit(model, profile, own.unwrap_or(&Smoothing::default()))?;
        let half_step = profile.reading.half_step();
        let noise = if fitted.noise.is_finite() { fitted.noise } else { 0.0 };
        let lifts = fitted.lifts(profile);
        let size = lifts.iter().fold(0.0_f64, |size, lift| size.max((lift - lifts[0]).abs()));
        let spread = row_error(half_step, noise);
        let is_noisy = spread > tolerance::NOISE_SEEN.value * size;
        let (corners, are_found) = (fitted.corners_deg(), own.is_none_or(|own| own.corners_deg.is_none()));
        let smoothed = |lifts: &[f64], weight: f64| {
            let model = model.with_lifts(lifts, (&corners, are_found), &fitted.dwells_deg(), weight)?;
            Cam::new(&model).map(|cam| (model, cam))
        };
        let own_cam = Cam::new(model)?;
        let table = |seed: u64| {
            let noisy = lifts.iter().zip(0..).map(|(lift, row)| lift + spread * even(seed, row)).collect::<Vec<f64>>();
            smoothed(&noisy, fitted.weight)
        };
        let rows: Vec<f64> = profile.rows.iter().map(|row| row.lift).collect();
        let has_corners = is_noisy && !corners.is_empty();
        let closer = has_corners.then(|| smoothed(&rows, fitted.weight + 1.0)).transpose()?;
        let best = match own {
            _ if !is_noisy => None,
            Some(_) => Some((model.clone(), own_cam.clone())),
            None => Some(smoothed(&rows, fitted.weight)?),
        };
        let count = if is_noisy { TABLES } else { 0 };
        let tried: Vec<_> = (0..count).into_par_iter().map(table).collect();
        // A follower may not fit on a few of the likely contours.
        let mut failed = tried.iter().filter_map(|one| one.as_ref().err());
        if let Some(why) = failed.nth(TABLES as usize / WITHOUT) {
            return Err(why.clone());
        }
        let others = tried.into_iter().flatten().collect::<Vec<_>>();
        let measured = measured(
            (Reading::clone(&profile.reading), &own_cam),
            &fitted,
            (own, noise, strays(profile)),
            (best.as_ref(), &others),
        );
        Ok(Self { measured, best, closer, others })
    }

    /// Returns the cams under the follower of another model.
    pub(crate) fn under(&self, model: &Model) -> Self {
        let under = |(likely, cam): &LikelyCam| (model.on_cam_of(likely, cam), cam.clone());
        Self {
            measured: self.measured.clone(),
            best: self.best.as_ref().map(under),
            closer: self.closer.as_ref().map(under),
            others: self.others.iter().map(under).collect(),
        }
    }

    /// Returns the uncertainties of numbers that depend on the cam. Each has three terms: the distance from the number of the best
    /// estimate, twice the largest deviation among the equally likely cams, and the effect of corners. `of` returns the numbers of a model, or
    /// `None`. The result is `None` if this happens for more than a few models.
    pub fn errors(&self, numbers: &[f64], of: impl Fn(&Model, &Cam) -> Option<Vec<f64>> + Sync) -> Option<Vec<f64>> {
        self.spread(numbers, (self.others.len(), 0, 2.0), of)
    }

    /// Returns the uncertainty of a number found by slow runs, from a few of the tables, one of which may give a wrong number. The second
    /// largest of these few deviations is less than half of the largest of all.
    pub fn error_by_runs(&self, number: f64, of: impl Fn(&Model, &Cam) -> Option<f64> + Sync) -> Option<f64> {
        const FEW: usize = 4;
        self.spread(&[number], (FEW, 1, 4.5), |model, cam| of(model, cam).map(|number| vec![number]))?.pop()
    }

    /// Estimates the uncertainties from `tables` tables, without the `left_out` largest deviations, scaled by `times`.
    fn spread(
        &self,
        numbers: &[f64],
        (tables, left_out, times): (usize, usize, f64),
        of: impl Fn(&Model, &Cam) -> Option<Vec<f64>> + Sync,
    ) -> Option<Vec<f64>> {
        let others = &self.others[..tables.min(self.others.len())];
        let Some((best, cam)) = &self.best else { return Some(vec![0.0; numbers.len()]) };
        let centre = of(best, cam)?;
        // At each corner the third derivative bends to 0 over a range that shrinks with the sixth root of the weight. Ten times the weight
        // removes a third of this effect, and of its effect on the corner's angle.
        let closer = match &self.closer {
            Some((model, cam)) => of(model, cam)?,
            None => centre.clone(),
        };
        let all: Vec<Vec<f64>> = others.par_iter().filter_map(|(model, cam)| of(model, cam)).collect();
        let error = |(index, number): (usize, &f64)| {
            let mut apart: Vec<f64> = all.iter().map(|one| (one[index] - centre[index]).abs()).collect();
            apart.sort_by(|one, two| two.total_cmp(one));
            let apart = apart.get(left_out).copied().unwrap_or_default();
            (centre[index] - number).abs() + times * apart + 6.0 * (closer[index] - centre[index]).abs()
        };
        (all.len() + others.len() / Self::WITHOUT >= others.len())
            .then(|| numbers.iter().enumerate().map(error).collect())
    }
}

/// Pseudorandom number in [-1, 1] for a table and a row: SplitMix64 (Steele, Lea and Flood 2014), the same on every machine.
pub(crate) fn even(table: u64, row: u64) -> f64 {
    let mut bits = ((table << 32) + row + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    (bits >> 11) as f64 / 2.0_f64.powi(52) - 1.0
}

/// Second derivatives of a cam, m/rad^2, at angles over one turn.
fn curvatures(cam: &Cam) -> Vec<f64> {
    /// Number of angles: four per degree, none at a row of whole degrees.
    const ANGLES: u32 = 1439;
    let angle = |part: u32| std::f64::consts::TAU * (f64::from(part) + 0.5) / f64::from(ANGLES);
    (0..ANGLES).map(|part| cam.lift(angle(part)).curvature).collect()
}

fn measured(
    (reading, own_cam): (Reading, &Cam),
    fitted: &Fit,
    (own, noise_m, strays): (Option<&Smoothing>, f64, Vec<Stray>),
    (best, others): (Option<&LikelyCam>, &[LikelyCam]),
) -> Measured {
    let own_curvatures = curvatures(own_cam);
    let mut curvature_error = 0.0_f64;
    if let Some((_, best)) = best {
        let centre = curvatures(best);
        let mut apart = vec![0.0_f64; centre.len()];
        for (_, other) in others {
            for (most, (one, middle)) in apart.iter_mut().zip(curvatures(other).iter().zip(&centre)) {
                *most = most.max((one - middle).abs());
            }
        }
        for (apart, (middle, own)) in apart.iter().zip(centre.iter().zip(&own_curvatures)) {
            curvature_error = curvature_error.max((middle - own).abs() + 2.0 * apart);
        }
    }
    Measured {
        step_m: reading.step.map(|step| reading.in_model.inside(step)),
        reading,
        noise_m,
        noise_unknown: None,
        strays,
        largest_distance_m: if own.is_some() { fitted.distance() } else { 0.0 },
        is_noisy: best.is_some(),
        is_smoothed: own.is_some(),
        corners_deg: if own.is_some() { fitted.corners_deg() } else { Vec::new() },
        corners_are_found: own.is_some_and(|own| own.corners_deg.is_none()),
        doubtful_corners: own.and_then(|_| DoubtfulCorners::of(fitted)),
        dwells_deg: if own.is_some() { fitted.dwells_deg() } else { Vec::new() },
        dwells_are_found: own.is_some_and(|own| own.dwells_deg.is_none()),
        largest_curvature: own_curvatures.into_iter().fold(0.0, |most, one| most.max(one.abs())),
        curvature_error,
    }
}

/// Remarks on the rows of a table, or on the settings of a spline near them.
#[derive(Clone, Debug, Default)]
pub struct Remarks {
    /// Rows far from the value that their neighbours suggest.
    pub strays: Vec<Stray>,
    /// A tolerance and the spread of the rows, m, if the spread is far smaller.
    pub loose: Option<[f64; 2]>,
    /// Largest distance of the smoothed cam from a row and a tolerance that the rows allow, m, if the distance is far larger.
    pub smoothed_away: Option<[f64; 2]>,
    /// Row that contradicts the given corners or dwells.
    pub contradicted: Option<Contradicted>,
}

/// Row far from the cam because of the given corners or dwells.
#[derive(Clone, Copy, Debug)]
pub struct Contradicted {
    /// Field that was given.
    pub field: &'static str,
    /// Angle of the row, degrees.
    pub cam_angle_deg: f64,
    /// Distance of the cam from the row, m.
    pub off_m: f64,
}

impl Remarks {
    /// Checks the cam of a model; there are no remarks on a cam that is not a table.
    pub fn on(model: &Model) -> Result<Self, ModelError> {
        let Some(profile) = model.table() else { return Ok(Self::default()) };
        let Some(own) = profile.spline.smoothing() else {
            return Ok(Self { strays: strays(profile), ..Self::default() });
        };
        let spread = spread(profile);
        let within = if let SmoothingTolerance::Within(within) = own.tolerance { Some(within) } else { None };
        let smoothed_away = match own.tolerance {
            SmoothingTolerance::Auto => {
                let fitted = fit(model, profile, own)?;
                let distance = fitted.distance();
                let allowed = (2.0 * profile.reading.half_step()).max(tolerance::ULP.value * profile.rise());
                // Rows that are constant on a dwell have no noise beyond their decimals.
                let is_still = fitted.dwells_deg().iter().any(|dwell| range(profile, dwell) <= allowed);
                let is_noise = !is_still && distance <= spread / tolerance::FAR_SMOOTHED.value;
                // A mistake in a row also keeps the cam away from it.
                let is_far =
                    strays(profile).is_empty() && !is_noise && allowed < tolerance::SMOOTHED_AWAY.value * distance;
                is_far.then_some([distance, allowed])
            }
            _ => None,
        };
        let loose = within.filter(|within| spread < tolerance::SMOOTHED_AWAY.value * within);
        Ok(Self {
            strays: strays(profile),
            loose: loose.map(|within| [within, spread]),
            smoothed_away,
            contradicted: contradicted(model, profile, own, within.unwrap_or(spread))?,
        })
    }
}

/// Range of the lifts of rows on a dwell, m.
fn range(profile: &TableProfile, [from, to]: &[f64; 2]) -> f64 {
    let is_inside = |row: &&TableRow| (row.angle_deg - from).rem_euclid(360.0) <= to - from;
    let lifts = profile.rows.iter().filter(is_inside).map(|row| row.lift);
    lifts.clone().fold(f64::NEG_INFINITY, f64::max) - lifts.fold(f64::INFINITY, f64::min)
}

/// Finds the row farthest from a smoothing spline, which is meant to be within `within` m of the rows.
fn contradicted(
    model: &Model,
    profile: &TableProfile,
    own: &Smoothing,
    within: f64,
) -> Result<Option<Contradicted>, ModelError> {
    /// Distance that counts as far, relative to the tolerance or the spread of the rows: noise stays within twice these.
    const FAR: f64 = 10.0;
    let field = match (&own.corners_deg, &own.dwells_deg) {
        (_, Some(dwells)) if !dwells.is_empty() => "cam.dwells_deg",
        (Some(_), _) => "cam.corners_deg",
        _ => return Ok(None),
    };
    // Spline through the rows, independent of the settings.
    let cam = spline_of_rows(model, profile)?;
    let off = |row: &TableRow| (cam.lift(row.angle_deg.to_radians()).value - row.lift).abs();
    let worst = profile.rows.iter().map(|row| (row, off(row))).max_by(|one, two| one.1.total_cmp(&two.1));
    let least = tolerance::NOISE_SEEN.value * profile.rise();
    let Some((row, off_m)) = worst.filter(|(_, off)| *off > FAR * within.max(least)) else { return Ok(None) };
    // A row that is as far from the spline without the given features is not far because of them.
    let found = Smoothing { corners_deg: None, dwells_deg: None, ..own.clone() };
    let without = fit(model, profile, &found).map(|fit| {
        let index = profile.rows.iter().position(|other| other == row).unwrap_or_default();
        fit.lifts(profile)[index]
    });
    let is_theirs = without.map_or(true, |lift| 2.0 * (lift - row.lift).abs() < off_m);
    Ok(is_theirs.then_some(Contradicted { field, cam_angle_deg: row.angle_deg, off_m }))
}

/// Uncertainty of a cam from the noise of its table.
#[derive(Clone, Debug)]
pub enum CamUncertainty {
    /// Estimate from equally likely cams.
    Told(Box<Measured>),
    /// Spread of the rows, m, of a table with too many rows for a quick estimate.
    Noise(f64),
    /// Failure to fit a smooth motion to the rows, for this reason.
    Unknown(String),
}

impl CamUncertainty {
    /// Estimates the uncertainty of a model's cam; `None` if the rows have no noise.
    pub fn of(model: &Model) -> Result<Option<Self>, ModelError> {
        /// Number of rows above which the estimate takes longer than many commands.
        const MOST_ROWS: usize = 4000;
        let Some(profile) = model.table().filter(|profile| profile.may_be_smoothed()) else { return Ok(None) };
        let spread = spread(profile);
        if spread <= tolerance::NOISE_SEEN.value * profile.rise() {
            return Ok(None);
        }
        if profile.rows.len() > MOST_ROWS {
            return Ok(Some(Self::Noise(spread)));
        }
        Ok(PlausibleCams::of(model)?.and_then(|PlausibleCams { measured, .. }| match measured.noise_unknown {
            Some(why) => Some(Self::Unknown(why)),
            None => measured.is_noisy.then(|| Self::Told(Box::new(measured))),
        }))
    }
}
