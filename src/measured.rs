//! What the rows of a table tell of their own accuracy, and the cams that they may as well be of.
//!
//! The best guess at the cam is the smoothing spline. Tables of its lifts with the noise that the rows have, smoothed alike, are as
//! likely as the table that was measured: what they differ by is how well anything is known that depends on the cam, and what they
//! are off on the whole is what smoothing itself does.

use rayon::prelude::*;
use serde::Serialize;

use crate::cam::{Cam, Fit, Stray, fit, spread, strays};
use crate::model::{Model, ModelError, Reading, Row, Smoothing, TableProfile, Tolerance};
use crate::tolerance;

/// How well a measured cam is known.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// How the rows were understood.
    pub reading: Reading,
    /// The step of the decimal grid that all lifts lie on, m; none where there is none above the rounding of a double.
    pub step_m: Option<f64>,
    /// The standard deviation of the rows about a smooth motion, m, by generalised cross-validation; not a number where it is unknown.
    pub noise_m: f64,
    /// Why the noise is unknown, of a spline through the rows: no smooth motion could be fitted to them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise_unknown: Option<String>,
    /// Rows that are far from where the rows beside them say.
    pub strays: Vec<Stray>,
    /// How far the cam is from a row at most, m.
    pub largest_distance_m: f64,
    /// Whether the rows have noise that moves what depends on the second derivative.
    pub is_noisy: bool,
    /// Whether it is a smoothing spline.
    pub is_smoothed: bool,
    /// Where the second derivative jumps, of a smoothing spline, degrees.
    pub corners_deg: Vec<f64>,
    /// Whether the corners were found in the rows, not given.
    pub corners_are_found: bool,
    /// Where the lift stays, of a smoothing spline, from and to, degrees.
    pub dwells_deg: Vec<[f64; 2]>,
    /// Whether the dwells were found in the rows, not given.
    pub dwells_are_found: bool,
    /// Its largest second derivative, m/rad^2.
    pub largest_curvature: f64,
    /// How far that may be off, m/rad^2; not a number where the noise is unknown.
    pub curvature_error: f64,
}

impl Measured {
    /// A measured cam that leaves what is asked of it open.
    pub fn noisy(measured: &Option<Self>) -> Option<&Self> {
        measured.as_ref().filter(|cam| cam.is_noisy)
    }

    /// Whether rounding is all the noise that there is.
    pub fn is_rounded(&self) -> bool {
        /// Beyond which the noise is more than that, in standard deviations of the rounding.
        const MORE: f64 = 1.5;
        self.step_m.is_some_and(|step| self.noise_m <= MORE * step / 12.0_f64.sqrt())
    }
}

/// A model with its cam.
pub type LikelyCam = (Model, Cam);

/// The best guess at a measured cam, and others that are as likely, as models.
#[derive(Clone, Debug)]
pub struct Likely {
    /// What is known of the model's cam.
    pub measured: Measured,
    /// The model with the smoothing spline; none where the rows have no noise that a spline through them would follow.
    pub best: Option<LikelyCam>,
    /// The same with ten times its weight on the rows, of a cam with corners.
    pub closer: Option<LikelyCam>,
    /// Models of tables that might have been measured.
    pub others: Vec<LikelyCam>,
}

/// Tables that might have been measured: the largest of so many deviations is near two standard deviations.
const TABLES: u64 = 16;

impl Likely {
    /// The accuracy of the cam of a model; none where that is not of a table, or of one with too few rows to tell.
    ///
    /// A spline through the rows needs no smoothing: where no smooth motion can be fitted to them, only their noise is unknown.
    pub fn of(model: &Model) -> Result<Option<Self>, ModelError> {
        let Some(profile) = model.table().filter(|table| table.may_be_smoothed()) else { return Ok(None) };
        let own = profile.spline.smoothing();
        match Self::fitted(model, profile, own) {
            Err(why) if own.is_none() => Self::unknown(model, profile, &why).map(Some),
            likely => likely.map(Some),
        }
    }

    /// The accuracy of a spline through rows whose noise is unknown.
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
            dwells_deg: Vec::new(),
            dwells_are_found: false,
            largest_curvature: largest,
            curvature_error: f64::NAN,
        };
        Ok(Self { measured, best: None, closer: None, others: Vec::new() })
    }

    /// The accuracy by the smoothing spline near the rows.
    fn fitted(model: &Model, profile: &TableProfile, own: Option<&Smoothing>) -> Result<Self, ModelError> {
        let fitted = fit(model, profile, own.unwrap_or(&Smoothing::default()))?;
        let half_step = profile.reading.half_step();
        let noise = if fitted.noise.is_finite() { fitted.noise } else { 0.0 };
        let lifts = fitted.lifts(profile);
        let size = lifts.iter().fold(0.0_f64, |size, lift| size.max((lift - lifts[0]).abs()));
        // Evenly spread, as rounding is.
        let spread = half_step.max(3.0_f64.sqrt() * noise);
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
        let others = (0..count).into_par_iter().map(table).collect::<Result<Vec<_>, _>>()?;
        let measured = measured(
            (Reading::clone(&profile.reading), &own_cam),
            &fitted,
            (own, noise, strays(profile)),
            (best.as_ref(), &others),
        );
        Ok(Self { measured, best, closer, others })
    }

    /// How far numbers that depend on the cam may be off: by how far they are from those of the best guess, by twice what they differ
    /// by, at most, among those that are as likely, and by what corners do to them. `of` tells the numbers of a model, none of one that has none; where
    /// more than a few have none, nothing is known.
    pub fn error<const N: usize>(
        &self,
        numbers: [f64; N],
        of: impl Fn(&Model, &Cam) -> Option<[f64; N]> + Sync,
    ) -> Option<[f64; N]> {
        self.errors(&numbers, |model, cam| of(model, cam).map(Vec::from))?.try_into().ok()
    }

    /// The same of as many numbers as there are.
    pub fn errors(&self, numbers: &[f64], of: impl Fn(&Model, &Cam) -> Option<Vec<f64>> + Sync) -> Option<Vec<f64>> {
        self.spread(numbers, (self.others.len(), 0, 2.0), of)
    }

    /// The same of a number that runs tell, which takes long: of few of the tables, of which one may be told wrongly. The next to
    /// largest of so few deviations is less than half as large as the largest of all.
    pub fn error_by_runs(&self, number: f64, of: impl Fn(&Model, &Cam) -> Option<f64> + Sync) -> Option<f64> {
        const FEW: usize = 4;
        self.spread(&[number], (FEW, 1, 4.5), |model, cam| of(model, cam).map(|number| vec![number]))?.pop()
    }

    /// By so many tables, of which so many that differ most are left out, and so many times by what the others differ by.
    fn spread(
        &self,
        numbers: &[f64],
        (tables, left_out, times): (usize, usize, f64),
        of: impl Fn(&Model, &Cam) -> Option<Vec<f64>> + Sync,
    ) -> Option<Vec<f64>> {
        /// One in so many of the tables may do without.
        const WITHOUT: usize = 8;
        let others = &self.others[..tables.min(self.others.len())];
        let Some((best, cam)) = &self.best else { return Some(vec![0.0; numbers.len()]) };
        let centre = of(best, cam)?;
        // The third derivative is bent to 0 over a stretch at each corner that shrinks with the sixth root of the weight: ten times the
        // weight takes a third of what that does, and of what it does to where the corner is found.
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
        (all.len() + others.len() / WITHOUT >= others.len()).then(|| numbers.iter().enumerate().map(error).collect())
    }
}

/// A number of [-1, 1] for a table and a row: SplitMix64 (Steele, Lea and Flood 2014), the same on every machine.
fn even(table: u64, row: u64) -> f64 {
    let mut bits = ((table << 32) + row + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    (bits >> 11) as f64 / 2.0_f64.powi(52) - 1.0
}

/// The second derivatives of a cam, m/rad^2, at angles all round.
fn curvatures(cam: &Cam) -> Vec<f64> {
    /// Four to a degree, and none at a row of whole degrees.
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
        dwells_deg: if own.is_some() { fitted.dwells_deg() } else { Vec::new() },
        dwells_are_found: own.is_some_and(|own| own.dwells_deg.is_none()),
        largest_curvature: own_curvatures.into_iter().fold(0.0, |most, one| most.max(one.abs())),
        curvature_error,
    }
}

/// What is odd about the rows of a table, or about what is asked of a spline near them.
#[derive(Clone, Debug, Default)]
pub struct Remarks {
    /// Rows that are far from where the rows beside them say.
    pub strays: Vec<Stray>,
    /// A tolerance and what the rows spread by, m, where that is far less.
    pub loose: Option<[f64; 2]>,
    /// Where the rows are otherwise than corners or dwells that were given.
    pub contradicted: Option<Contradicted>,
}

/// A row that what was given keeps the cam away from.
#[derive(Clone, Copy, Debug)]
pub struct Contradicted {
    /// The field that was given.
    pub field: &'static str,
    /// The row's angle, degrees.
    pub cam_angle_deg: f64,
    /// How far the cam is from it, m.
    pub off_m: f64,
}

impl Remarks {
    /// On the cam of a model; none on one that is no table.
    pub fn on(model: &Model) -> Result<Self, ModelError> {
        let Some(profile) = model.table() else { return Ok(Self::default()) };
        let Some(own) = profile.spline.smoothing() else {
            return Ok(Self { strays: strays(profile), ..Self::default() });
        };
        let spread = spread(profile);
        let within = if let Tolerance::Within(within) = own.tolerance { Some(within) } else { None };
        let loose = within.filter(|within| spread < tolerance::SMOOTHED_AWAY.value * within);
        Ok(Self {
            strays: strays(profile),
            loose: loose.map(|within| [within, spread]),
            contradicted: contradicted(model, profile, own, within.unwrap_or(spread))?,
        })
    }
}

/// Where a smoothing spline is far from the rows, within some m of which it is meant to be.
fn contradicted(
    model: &Model,
    profile: &TableProfile,
    own: &Smoothing,
    within: f64,
) -> Result<Option<Contradicted>, ModelError> {
    /// Of the tolerance, or of what the rows spread by: noise keeps within two of these.
    const FAR: f64 = 10.0;
    let field = match (&own.corners_deg, &own.dwells_deg) {
        (_, Some(dwells)) if !dwells.is_empty() => "cam.dwells_deg",
        (Some(_), _) => "cam.corners_deg",
        _ => return Ok(None),
    };
    let cam = Cam::new(model)?;
    let off = |row: &Row| (cam.lift(row.angle_deg.to_radians()).value - row.lift).abs();
    let worst = profile.rows.iter().map(|row| (row.angle_deg, off(row))).max_by(|one, two| one.1.total_cmp(&two.1));
    let least = tolerance::NOISE_SEEN.value * profile.rise();
    let is_far = |(_, off): &(f64, f64)| *off > FAR * within.max(least);
    Ok(worst.filter(is_far).map(|(cam_angle_deg, off_m)| Contradicted { field, cam_angle_deg, off_m }))
}

/// What the noise of a table leaves open of its cam.
#[derive(Clone, Debug)]
pub enum Openness {
    /// As it is told by cams that are as likely.
    Told(Box<Measured>),
    /// Of a table of too many rows to be told at once: what its rows spread by, m.
    Noise(f64),
    /// No smooth motion could be fitted to the rows, for this reason.
    Unknown(String),
}

impl Openness {
    /// On the cam of a model; none where the rows have no noise.
    pub fn of(model: &Model) -> Result<Option<Self>, ModelError> {
        /// Of more rows it takes longer than many a command does.
        const MOST_ROWS: usize = 4000;
        let Some(profile) = model.table().filter(|profile| profile.may_be_smoothed()) else { return Ok(None) };
        let spread = spread(profile);
        if spread <= tolerance::NOISE_SEEN.value * profile.rise() {
            return Ok(None);
        }
        if profile.rows.len() > MOST_ROWS {
            return Ok(Some(Self::Noise(spread)));
        }
        Ok(Likely::of(model)?.and_then(|Likely { measured, .. }| match measured.noise_unknown {
            Some(why) => Some(Self::Unknown(why)),
            None => measured.is_noisy.then(|| Self::Told(Box::new(measured))),
        }))
    }
}
