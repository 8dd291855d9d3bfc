//! Cams with rounded corners, as on every machined cam.
//!
//! Over an angle e around a corner of the acceleration, the lift is the polynomial of fifth degree that meets the laws on both sides with
//! their slopes and curvatures. With x from 0 to 1 over the angle, and p, q the lifts at its ends,
//!
//! ```text
//! c = p + p' x + p''/2 x^2 + (10 a - 4 b + d/2) x^3 + (-15 a + 7 b - d) x^4 + (6 a - 3 b + d/2) x^5
//! a = q - p - p' - p''/2,   b = q' - p' - p'',   d = q'' - p''          derivatives by x
//! ```
//!
//! The third derivative jumps at its ends.

use super::law::Law;
use super::polynomial::Polynomial;
use super::{Cam, Joint};
use crate::model::{CORNER_ROUNDING, Model, ModelError};

impl Cam {
    /// Returns the cam with each corner of its acceleration rounded over this angle, degrees.
    pub(super) fn rounded(self, model: &Model, degrees: f64) -> Result<Self, ModelError> {
        let corners: Vec<_> = self.corners().iter().copied().filter(|corner| corner.jump_order == 2).collect();
        if corners.is_empty() {
            return Err(model.reject(CORNER_ROUNDING, "must be 0: the acceleration of this cam has no jump to round"));
        }
        let half = 0.5 * degrees.to_radians();
        let is_corner = |segment: usize| corners.iter().any(|corner| corner.segment == segment);
        let mut laws = Vec::new();
        for (index, segment) in self.segments().iter().enumerate() {
            let ends = [index, (index + 1) % self.segments().len()].map(|meeting| f64::from(is_corner(meeting)));
            let room = (segment.end - segment.start) / (ends[0] + ends[1]);
            if !(half < room) {
                let most = 2.0 * room.to_degrees();
                let words =
                    format!("must be below {most} degrees: rounded corners would meet on the segment between them");
                return Err(model.reject(CORNER_ROUNDING, words));
            }
            laws.push((segment.start + ends[0] * half, segment.law.clone()));
        }
        for corner in &corners {
            let (before, after) = (&self.segments()[self.before(corner.segment)], &self.segments()[corner.segment]);
            let from = before.end - half;
            laws.push((from, Law::Polynomial(blend((&before.law, before.end), (&after.law, after.start), half))));
        }
        laws.sort_by(|one, two| one.0.total_cmp(&two.0));
        Ok(Self::from_laws(laws, Joint::Free))
    }
}

/// Polynomial from `half` before a corner to `half` after it; each side is a law with the angle at which it meets the corner.
fn blend((before, end): (&Law, f64), (after, start): (&Law, f64), half: f64) -> Polynomial {
    let angle = 2.0 * half;
    let (from, to) = (before.lift(end - half), after.lift(start + half));
    // In units of the angle. `rise` keeps digits that the difference of two lifts loses.
    let rise = after.rise(start, half) - before.rise(end, -half);
    let [dp, ddp] = [from.slope * angle, from.curvature * angle * angle];
    let [dq, ddq] = [to.slope * angle, to.curvature * angle * angle];
    let (a, b, d) = (rise - dp - 0.5 * ddp, dq - dp - ddp, ddq - ddp);
    let parts =
        [from.value, dp, 0.5 * ddp, 10.0 * a - 4.0 * b + 0.5 * d, -15.0 * a + 7.0 * b - d, 6.0 * a - 3.0 * b + 0.5 * d];
    let coefficients: Vec<f64> = (0..).zip(parts).map(|(power, part)| part / angle.powi(power)).collect();
    Polynomial::new(end - half, &coefficients)
}
