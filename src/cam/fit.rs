//! Fit of a smoothing spline to the rows of a table, and the noise that the rows show.
//!
//! With a tolerance, the weight makes the largest distance from a row equal to it. Without one, the weight minimises generalised
//! cross-validation (Craven and Wahba 1978; the factor: Kim and Gu 2004), an estimate of the error at a row that is left out:
//!
//! ```text
//! V = n sum of residuals^2 / (n - 1.4 p)^2      p degrees of freedom of the spline, noise^2 = sum of residuals^2 / (n - p)
//! ```
//!
//! over the rows outside dwells. The distances are allowed to reach half of the rounding step of the lifts, since a true lift may be that
//! far from its row.

use std::f64::consts::TAU;

use super::features::{self, Features};
use super::smoothing::{Fitted, Layout, Smoothed};
use super::{Cam, Joint, apart};
use crate::bracket::{Width, halve};
use crate::elementary;
use crate::model::{Model, ModelError, Smoothing, SmoothingTolerance, TableProfile};

/// Smoothing spline fitted to a table.
#[derive(Clone, Debug)]
pub(crate) struct Fit {
    layout: Layout,
    spline: Smoothed,
    /// Logarithm of the weight of the rows.
    pub weight: f64,
    /// Corners and dwells, given or found.
    features: Features,
    /// Doubtful corners, which are left out, rad.
    doubtful: Vec<f64>,
    /// Standard deviation of the rows from a smooth motion, m; NaN if the spline passes through them.
    pub noise: f64,
}

/// Logarithms of the smallest and the largest weight tried: a curve of the first harmonics only, and one through the rows.
const WEIGHTS: [f64; 2] = [-9.0, 9.0];

impl Fit {
    /// Largest distance from a row, m.
    pub fn distance(&self) -> f64 {
        largest(&self.spline.residuals)
    }

    /// Lifts of the spline at the rows, m.
    pub fn lifts(&self, profile: &TableProfile) -> Vec<f64> {
        profile.rows.iter().zip(&self.spline.residuals).map(|(row, residual)| row.lift - residual).collect()
    }

    /// Corners, degrees.
    pub fn corners_deg(&self) -> Vec<f64> {
        self.features.corners.iter().map(|corner| corner.to_degrees()).collect()
    }

    /// Doubtful corners, which are left out, degrees.
    pub fn doubtful_deg(&self) -> Vec<f64> {
        self.doubtful.iter().map(|corner| corner.to_degrees()).collect()
    }

    /// Start and end of each dwell, degrees.
    pub fn dwells_deg(&self) -> Vec<[f64; 2]> {
        self.features.dwells.iter().map(|dwell| dwell.map(f64::to_degrees)).collect()
    }

    pub fn cam(&self) -> Cam {
        let (laws, breaks) = self.layout.laws(&self.spline);
        Cam::from_laws(laws, Joint::Spline { degree: 5, breaks: breaks.into() })
    }
}

/// Choices made for the smoothing spline of a model, for programs that compute it by other means; `None` if its cam is not a smoothing
/// spline.
pub(crate) fn fitted(model: &Model) -> Result<Option<Fitted>, ModelError> {
    let smoothed = model.table().and_then(|table| Some((table, table.spline.smoothing()?)));
    let fitted = smoothed.map(|(table, smoothing)| {
        let fit = fit(model, table, smoothing)?;
        Ok(fit.layout.fitted(elementary::powf(10.0_f64, fit.weight)))
    });
    fitted.transpose()
}

fn largest(residuals: &[f64]) -> f64 {
    residuals.iter().fold(0.0, |largest, residual| largest.max(residual.abs()))
}

/// Fits the spline of a profile.
pub(crate) fn fit(model: &Model, profile: &TableProfile, smoothing: &Smoothing) -> Result<Fit, ModelError> {
    let angles: Vec<f64> = profile.rows.iter().map(|row| row.angle_deg.to_radians()).collect();
    let lifts: Vec<f64> = profile.rows.iter().map(|row| row.lift).collect();
    let half_step = profile.reading.half_step();
    let (mut features, doubtful) = features::of(smoothing, &angles, &lifts, half_step);
    let layout = |features: &Features| {
        let too_few = || {
            model.reject(
                "cam.dwells_deg",
                "leaves fewer than three rows outside the dwells: give fewer or shorter dwells",
            )
        };
        Layout::new(&angles, features).ok_or_else(too_few)
    };
    let weighed = |layout: &Layout| {
        weight(model, profile, smoothing.tolerance, &|weight| {
            layout.smoothed(&lifts, elementary::powf(10.0_f64, weight))
        })
    };
    // Found dwells that leave no motion between them are dropped: the rows are so rough that all of them look alike. Dwells between which
    // the lift steps from one row to the next, as after a slip of a gauge, are dropped as well.
    let [smoothest, _] = WEIGHTS;
    let is_none = |laid: Layout| laid.smoothed(&lifts, elementary::powf(10.0_f64, smoothest)).is_none();
    if smoothing.dwells_deg.is_none() && layout(&features).map_or(true, is_none) {
        features.dwells.clear();
    }
    // A dwell that the model gives was checked when the model was read.
    let in_dwell = |corner: &&f64| features.dwells.iter().any(|dwell| features::is_inside(corner.to_radians(), dwell));
    if let Some(corner) = smoothing.corners_deg.iter().flatten().find(in_dwell) {
        let words = format!(
            "has {corner}, which is inside a dwell found in the rows: leave it out, or set other dwells by dwells_deg"
        );
        return Err(model.reject("cam.corners_deg", words));
    }
    let are_found = smoothing.corners_deg.is_none();
    let near = |mut features: Features| {
        let mut laid = layout(&features)?;
        let mut weight = weighed(&laid)?;
        if (are_found || smoothing.are_near) && !features.corners.is_empty() {
            features = polished(features, TAU / angles.len() as f64, |features| {
                layout(features).ok()?.smoothed(&lifts, elementary::powf(10.0_f64, weight)).map(|spline| spline.least)
            });
            laid = layout(&features)?;
            weight = weighed(&laid)?;
        }
        let spline =
            laid.smoothed(&lifts, elementary::powf(10.0_f64, weight)).ok_or_else(|| overflow(model, profile))?;
        Ok((features, laid, weight, spline))
    };
    // Between the end of a given dwell and a found corner within a row of it there is no row: no spline fits both.
    let ends: Vec<f64> = features.dwells.iter().flatten().copied().collect();
    let is_at_end = |corner: &f64| ends.iter().any(|end| apart(*corner, *end) < TAU / angles.len() as f64);
    let mut fewer = features.clone();
    fewer.corners.retain(|corner| !is_at_end(corner));
    let is_open = are_found && fewer.corners.len() < features.corners.len();
    let (features, laid, weight, spline) =
        near(features).or_else(|why| if is_open { near(fewer) } else { Err(why) })?;
    let noise = (spline.squares / (spline.moving - spline.freedom)).sqrt();
    Ok(Fit { layout: laid, weight, noise, spline, features, doubtful })
}

fn overflow(model: &Model, profile: &TableProfile) -> ModelError {
    model.reject(profile.place(), "has lifts too large, or angles too close, for a spline near them")
}

/// Moves each found corner within a gap to the minimum of the functional that the spline minimises.
fn polished(mut features: Features, gap: f64, least: impl Fn(&Features) -> Option<f64>) -> Features {
    /// First step of a corner, as a part of a gap, and the number of times that it is halved.
    const PARTS: f64 = 0.25;
    const ROUNDS: i32 = 7;
    for corner in 0..features.corners.len() {
        let mut best = least(&features).unwrap_or(f64::INFINITY);
        let mut step = PARTS * gap;
        for _ in 0..ROUNDS {
            for sign in [-1.0, 1.0] {
                let moved = features.moved(corner, sign * step);
                if let Some(found) = least(&moved).filter(|found| *found < best) {
                    (features, best) = (moved, found);
                    break;
                }
            }
            step *= 0.5;
        }
    }
    features
}

/// Logarithm of the weight that meets a tolerance.
fn weight(
    model: &Model,
    profile: &TableProfile,
    tolerance: SmoothingTolerance,
    at: &impl Fn(f64) -> Option<Smoothed>,
) -> Result<f64, ModelError> {
    let overflow = || overflow(model, profile);
    match tolerance {
        SmoothingTolerance::Auto => {
            let too_few = || {
                let words = "has too few rows outside the dwells for a smoothing spline: give more rows, or spline = \"quintic\"";
                model.reject(profile.place(), words)
            };
            let [low, _] = WEIGHTS;
            at(low).ok_or_else(overflow)?;
            let cross_validated = cross_validated(at).ok_or_else(too_few)?;
            // The smoother of the two.
            Ok(match within(at, profile.reading.half_step()) {
                Some(Kept::At(weight)) => cross_validated.min(weight),
                Some(Kept::Always) => WEIGHTS[0],
                Some(Kept::Never(_)) | None => cross_validated,
            })
        }
        SmoothingTolerance::Weighted(weight) => Ok(weight),
        SmoothingTolerance::Within(limit) => match within(at, limit).ok_or_else(overflow)? {
            Kept::At(weight) => Ok(weight),
            Kept::Always => {
                let words = "is too large: a cam of constant lift is within it of every row; give a smaller one";
                Err(model.reject("cam.tolerance", words))
            }
            Kept::Never(least) => {
                let (least, unit) = (profile.reading.in_model.told(least), &profile.reading.unit);
                let words = format!(
                    "cannot be kept: with corners and dwells as they are a row is {least:.3e} {unit} off, however closely the spline \
                     follows"
                );
                Err(model.reject("cam.tolerance", words))
            }
        },
    }
}

/// Weights at which all rows are within a limit.
enum Kept {
    /// Every weight from this logarithm on.
    At(f64),
    /// Every weight.
    Always,
    /// No weight; with the distance left at the largest weight.
    Never(f64),
}

/// Finds the least weight at which no row is farther than `limit`.
fn within(at: &impl Fn(f64) -> Option<Smoothed>, limit: f64) -> Option<Kept> {
    /// Number of halvings of the logarithm: the distance then equals the limit to ten digits.
    const HALVINGS: u32 = 40;
    let distance = |weight: f64| at(weight).map(|spline| largest(&spline.residuals));
    let [low, high] = WEIGHTS;
    let least = distance(high)?;
    if least > limit {
        return Some(Kept::Never(least));
    }
    if distance(low)? <= limit {
        return Some(Kept::Always);
    }
    let kept = |weight: f64| distance(weight).map(|distance| distance > limit).ok_or(());
    let [weight, _] = halve([high, low], Width::Halvings(HALVINGS), kept).ok()?;
    Some(Kept::At(weight))
}

/// Logarithm of the weight with the least generalised cross-validation.
fn cross_validated(at: &impl Fn(f64) -> Option<Smoothed>) -> Option<f64> {
    /// Step between the weights tried, in their logarithm.
    const STEP: f64 = 0.75;
    /// Factor on the degrees of freedom. Without it cross-validation follows the noise in some tables.
    const CHARGED: f64 = 1.4;
    /// Largest ratio of degrees of freedom to rows, well below the one where the charged degrees of freedom equal the rows.
    const MOST: f64 = 0.6;
    /// Number of steps of the golden section, which give the logarithm to a hundredth.
    const SECTIONS: u32 = 10;
    let score = |weight: f64| {
        let spline = at(weight)?;
        // A spline through the rows leaves no residuals to judge it by.
        if spline.freedom > MOST * spline.moving {
            return Some(f64::INFINITY);
        }
        Some(spline.moving * spline.squares / (spline.moving - CHARGED * spline.freedom).powi(2))
    };
    let [low, high] = WEIGHTS;
    let tries = ((high - low) / STEP) as i32;
    let tried = (0..=tries).map(|index| low + STEP * f64::from(index));
    let scored = tried.filter_map(|weight| Some((score(weight)?, weight))).filter(|(score, _)| score.is_finite());
    let (_, best) = scored.min_by(|one, two| one.0.total_cmp(&two.0))?;
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut from, mut to) = ((best - STEP).max(low), (best + STEP).min(high));
    for _ in 0..SECTIONS {
        let [one, two] = [to - golden * (to - from), from + golden * (to - from)];
        if score(one)? < score(two)? { to = two } else { from = one }
    }
    Some(0.5 * (from + to))
}
