//! Location (x*, T*) of the orbit with one impact in one revolution that hits a corner of the cam's acceleration, from the model alone.

use std::fmt;

pub use super::corner_impact::CornerImpact;
use super::period_equation::{PeriodEquation, RootVerdict};
use super::range::{RangeError, Rejected, one_impact};
use crate::cam::{Cam, Corner};
use crate::model::{Model, ModelError};

/// Reason why there is no corner impact to study.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the message says what each number is")]
pub enum LocateError {
    /// Model without a range of speeds, or with an impossible one.
    #[error("{0}")]
    Model(#[from] ModelError),
    #[error("{}", .0)]
    NotFound(#[source] Box<NotFound>),
    /// Only candidate that touches the corner without relative velocity.
    #[error(
        "{file}: grazing impact at {speed_rpm:.6} rpm: the follower touches the corner at {:.6} deg with v = c' = {velocity} in the model's units; \
         there the map has no linear part, so there is no A and B to check",
        cam_angle.to_degrees()
    )]
    Grazing { file: String, cam_angle: f64, speed_rpm: f64, velocity: f64 },
}

/// Error: `[study]` contains no corner impact.
#[derive(Clone, Debug, PartialEq)]
pub struct NotFound {
    study: ModelError,
    corners: Vec<f64>,
    rejected: Vec<Rejected>,
}

impl std::error::Error for NotFound {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.study)
    }
}

impl fmt::Display for NotFound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; ", self.study)?;
        if self.corners.is_empty() {
            return write!(f, "the cam has no corner where its acceleration jumps");
        }
        let degrees: Vec<_> = self.corners.iter().map(|angle| format!("{:.4}", angle.to_degrees())).collect();
        write!(f, "looked at the corners at {} deg; ", degrees.join(", "))?;
        if self.rejected.is_empty() {
            write!(f, "no flight of one period starts and ends on any of them")?;
        } else {
            write!(f, "found instead:")?;
        }
        for Rejected { cam_angle, speed_rpm, why } in &self.rejected {
            write!(f, "\n  {speed_rpm:.6} rpm at {:.4} deg: {why}", cam_angle.to_degrees())?;
        }
        write!(f, "\n  `corner-impact locate` looks for corner impacts of orbits with several impacts, too")
    }
}

/// Returns the slowest corner impact in `[study]`, and the others by rising speed.
#[doc(hidden)]
pub fn locate(model: &Model, cam: &Cam) -> Result<(CornerImpact, Vec<CornerImpact>), LocateError> {
    let study = model.study()?;
    let corners: Vec<Corner> = cam.corners().iter().copied().filter(|corner| corner.jump_order == 2).collect();
    let complaint = |error: RangeError| {
        let words = match error {
            RangeError::TooWide { radians, .. } => format!(
                "spans too much: between it and study.rpm_max the period grows by {radians:.3e} radians of the follower's \
                 motion, and at most {:.3e} are searched",
                PeriodEquation::MOST_RADIANS
            ),
            RangeError::NotFinite { .. } => {
                "gives periods at which the follower's motion overflows a double: check the model's magnitudes".into()
            }
            other @ RangeError::NoRange { .. } => other.to_string(),
        };
        model.reject("study.rpm_min", words)
    };
    let (mut found, mut rejected, mut grazing) = (Vec::new(), Vec::new(), None);
    for (corner, period, verdict) in one_impact(model, cam, &corners, study, 1).map_err(complaint)?.0 {
        let (cam_angle, speed_rpm) = (corner.angle, 60.0 / period);
        match verdict {
            RootVerdict::Orbit(orbit) => found.push(*orbit),
            RootVerdict::Rejected(why) => rejected.push(Rejected { cam_angle, speed_rpm, why }),
            RootVerdict::Grazing(velocity) => {
                let file = model.file().into();
                grazing.get_or_insert(LocateError::Grazing { file, cam_angle, speed_rpm, velocity });
            }
        }
    }
    found.sort_by(|a, b| b.period.total_cmp(&a.period));
    let mut found = found.into_iter();
    if let Some(first) = found.next() {
        return Ok((first, found.collect()));
    }
    Err(grazing.unwrap_or_else(|| {
        let words =
            format!("no corner impact of a one-impact, one-revolution orbit up to study.rpm_max = {}", study.rpm_max);
        let corners = corners.iter().map(|corner| corner.angle).collect();
        LocateError::NotFound(Box::new(NotFound { study: model.reject("study.rpm_min", words), corners, rejected }))
    }))
}
