//! Lift of a flat face or a roller on a contour: the exact envelope, in polynomial pieces.
//!
//! The contour is `P = R(phi) e^{i phi}`, `phi` its polar angle. With `N = |P'| = sqrt(R^2 + R'^2)` its outward normal is
//! `n = (R - i R')/N`, turned by `e^{i phi}` like everything here, and its curvature `(R^2 + 2 R'^2 - R R'')/N^3`.
//!
//! ```text
//! flat face:  c = R^2/N,                 theta = phi + arg n
//! roller:     Z = R + a n,  c = sqrt(|Z|^2 - e^2),  theta = phi + arg Z - asin(e/|Z|)
//! theta' = 1 + Im(conj(n) n')            flat face
//! theta' = 1 + (Im(conj(Z) Z') + e c')/|Z|^2
//! ```
//!
//! `a` is the radius of the roller, `Z` its centre, and `e` the offset of the line of motion. Derivatives of the lift follow from two power
//! series, `d/dtheta = (1/theta') d/dphi`. A polynomial of degree 11 matches the lift and five derivatives at both ends of a piece.

use super::law::Law;
use super::polynomial::Polynomial;
use super::series::{derivative, product, quotient, square_root};
use super::{Cam, Corner, Joint, Lift, Segment, within_a_turn, within_turn};
use crate::elementary;
use crate::model::{FollowerContact, ModelError};
use crate::tolerance;

/// Number of coefficients of a series: the lift needs five derivatives, and the radius one or two more.
const TERMS: usize = 7;
/// Number of derivatives, with the lift, that a piece matches at either end.
const MATCHED: usize = 6;
/// Largest number of times that a piece is halved.
const HALVINGS: u32 = 16;

type Series = [f64; TERMS];

/// Reason why a follower cannot follow a contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unfollowed {
    /// Radius that is not above 0.
    NoRadius,
    /// Hollow or straight contour, which a flat face does not touch; with its radius of curvature.
    Hollow { radius: f64 },
    /// Hollow into which the roller does not fit; with its radius of curvature.
    Undercut { radius: f64 },
    /// Line of motion that does not cross the path of the roller's centre.
    Beside,
    /// Lift that changes over less than the pieces resolve.
    Sharp,
}

/// Contact of the follower with the contour at a polar angle.
struct Touch {
    /// Cam angle, rad.
    angle: f64,
    /// Lift and its derivatives by the cam angle.
    lift: [f64; MATCHED],
}

impl Touch {
    /// Contact of a follower with a contour whose radius has this law, at a polar angle, rad.
    fn new(law: &Law, polar: f64, contact: FollowerContact) -> Result<Self, Unfollowed> {
        let jet = law.jet(polar).series();
        let radius: Series = std::array::from_fn(|n| jet[n]);
        if !(radius[0] > 0.0) {
            return Err(Unfollowed::NoRadius);
        }
        let slope = derivative(&radius);
        let speed = square_root(sum(&product(&radius, &radius), &product(&slope, &slope)));
        // n = (cos, sin)
        let (cos, sin) = (quotient(&radius, &speed), quotient(&slope.map(|it| -it), &speed));
        let turn = |x: &Series, y: &Series| {
            let [along, across] = [product(x, &derivative(y)), product(y, &derivative(x))];
            std::array::from_fn(|n| along[n] - across[n])
        };
        // The normal turns by 1 + Im(conj(n) n') for each radian of phi: |P'| times the curvature.
        let mut normal: Series = turn(&cos, &sin);
        normal[0] += 1.0;
        let of_curvature = speed[0] / normal[0];
        let (lift, rate, angle) = match contact {
            FollowerContact::Flat if normal[0] > 0.0 => {
                (product(&radius, &cos), normal, polar + elementary::atan2(sin[0], cos[0]))
            }
            FollowerContact::Flat => return Err(Unfollowed::Hollow { radius: of_curvature }),
            // A point is a roller of radius 0.
            FollowerContact::Point | FollowerContact::Roller { .. } => {
                let [a, e] = match contact {
                    FollowerContact::Roller { roller_radius, offset } => [roller_radius, offset],
                    _ => [0.0; 2],
                };
                // The centre moves by |P'| + a (rate of the normal): backwards if the roller is too large.
                if !(speed[0] + a * normal[0] > 0.0) {
                    return Err(Unfollowed::Undercut { radius: of_curvature });
                }
                let x = std::array::from_fn(|n| radius[n] + a * cos[n]);
                let y = sin.map(|it| a * it);
                let square = sum(&product(&x, &x), &product(&y, &y));
                let mut root = square;
                root[0] = (square[0].sqrt() - e) * (square[0].sqrt() + e);
                if !(root[0] > 0.0) {
                    return Err(Unfollowed::Beside);
                }
                let lift = square_root(root);
                let moved = derivative(&lift);
                let turned: Series = turn(&x, &y);
                let mut rate = quotient(&std::array::from_fn(|n| turned[n] + e * moved[n]), &square);
                rate[0] += 1.0;
                if !(rate[0] > 0.0) {
                    return Err(Unfollowed::Beside);
                }
                let early = elementary::asin(e / square[0].sqrt());
                (lift, rate, polar + elementary::atan2(y[0], x[0]) - early)
            }
        };
        let mut by_angle = lift;
        let derivatives = std::array::from_fn(|order| {
            if order > 0 {
                by_angle = quotient(&derivative(&by_angle), &rate);
            }
            by_angle[0]
        });
        if derivatives.iter().all(|it| it.is_finite()) {
            Ok(Self { angle, lift: derivatives })
        } else {
            Err(Unfollowed::Sharp)
        }
    }
}

fn sum(a: &Series, b: &Series) -> Series {
    std::array::from_fn(|n| a[n] + b[n])
}

/// Coefficients of the powers 6 to 11 of x, from the remainders at x = 1 of the lift and of `derivative/order!` up to the fifth; lower
/// powers are 0.
#[rustfmt::skip]
const HERMITE: [[f64; MATCHED]; MATCHED] = [
    [462.0, -210.0, 84.0, -28.0, 7.0, -1.0],
    [-1980.0, 930.0, -384.0, 132.0, -34.0, 5.0],
    [3465.0, -1665.0, 705.0, -249.0, 66.0, -10.0],
    [-3080.0, 1505.0, -650.0, 235.0, -64.0, 10.0],
    [1386.0, -686.0, 301.0, -111.0, 31.0, -5.0],
    [-252.0, 126.0, -56.0, 21.0, -6.0, 1.0],
];

/// Polynomial of degree 11 in the angle from `from`, which matches lift and derivatives at both ends. They are `width` apart; a negative
/// width puts the other end before `from`.
fn hermite(from: &Touch, other: &Touch, width: f64) -> Polynomial {
    let scaled = |lift: &[f64; MATCHED]| {
        let mut scale = 1.0;
        let each: [f64; MATCHED] = std::array::from_fn(|order| {
            scale *= if order > 0 { width / order as f64 } else { 1.0 };
            lift[order] * scale
        });
        each
    };
    let (start, end) = (scaled(&from.lift), scaled(&other.lift));
    // Remainder at the end: t_k = end_k - sum_{j >= k} binomial(j, k) start_j.
    let mut left: [f64; MATCHED] = std::array::from_fn(|k| {
        let mut binomial = 1.0;
        let taken = (k..MATCHED).map(|j| {
            binomial *= if j > k { j as f64 / (j - k) as f64 } else { 1.0 };
            binomial * start[j]
        });
        end[k] - taken.sum::<f64>()
    });
    // A remainder of the size of rounding is set to 0: over a short piece it would make a large derivative.
    if left[0].abs() <= ROUNDINGS * tolerance::ULP.value * start[0].abs() {
        left[0] = 0.0;
    }
    let high = HERMITE.map(|row| row.iter().zip(left).map(|(entry, left)| entry * left).sum::<f64>());
    let mut scale = 1.0;
    let coefficients = start.into_iter().chain(high).map(|part| {
        let coefficient = part / scale;
        scale *= width;
        coefficient
    });
    let coefficients: Vec<f64> = coefficients.collect();
    Polynomial::new(from.angle, &coefficients)
}

/// Rounding error of a lift from its series, in ulps.
const ROUNDINGS: f64 = 16.0;

/// Builder of the lift's pieces.
struct Pieces {
    contact: FollowerContact,
    /// Height of the contour, m.
    rise: f64,
    /// Laws with the cam angles where they start, rad.
    laws: Vec<(f64, Law)>,
}

impl Pieces {
    /// Adds the pieces of a law of the radius between two polar angles; `rests` is whether a dwell follows.
    fn add(
        &mut self,
        law: &Law,
        polar: [f64; 2],
        touches: [&Touch; 2],
        rests: bool,
        halvings: u32,
    ) -> Result<(), (f64, Unfollowed)> {
        let [start, end] = touches;
        let width = end.angle - start.angle;
        // Expanded about the end if a dwell follows, so that the lift is constant there to the last bit.
        let piece = if rests { hermite(end, start, -width) } else { hermite(start, end, width) };
        let middle = 0.5 * (polar[0] + polar[1]);
        let mut is_near = true;
        for part in [0.5, 0.25, 0.75] {
            let at = polar[0] + part * (polar[1] - polar[0]);
            let touch = Touch::new(law, at, self.contact).map_err(|why| (at, why))?;
            is_near &= self.is_near(&piece, &touch, width);
        }
        if is_near {
            self.laws.push((start.angle, Law::Polynomial(piece)));
            return Ok(());
        }
        let touch = Touch::new(law, middle, self.contact).map_err(|why| (middle, why))?;
        if halvings == 0 {
            return Err((middle, self.likely(&touch)));
        }
        self.add(law, [polar[0], middle], [start, &touch], false, halvings - 1)?;
        self.add(law, [middle, polar[1]], [&touch, end], rests, halvings - 1)
    }

    /// Likely reason where no piece resolves the lift.
    fn likely(&self, touch: &Touch) -> Unfollowed {
        /// Tangent of a pressure angle that counts as 90 degrees.
        const STEEP: f64 = 10.0;
        let [value, slope, curvature, third, ..] = touch.lift;
        let angle = self.contact.touches(touch.angle, &Lift { value, slope, curvature, third }).pressure_angle;
        let (sin, cos) = elementary::sin_cos(angle);
        if sin.abs() > STEEP * cos { Unfollowed::Beside } else { Unfollowed::Sharp }
    }

    /// Whether a piece has the lift and the second derivative of a contact.
    fn is_near(&self, piece: &Polynomial, touch: &Touch, width: f64) -> bool {
        let found = piece.lift(touch.angle);
        let rounding = ROUNDINGS * tolerance::ULP.value * touch.lift[0].abs();
        let [lift, bend] =
            [tolerance::ENVELOPE_LIFT.value, tolerance::ENVELOPE_BEND.value].map(|part| part * self.rise);
        (found.value - touch.lift[0]).abs() <= lift + rounding
            && (found.curvature - touch.lift[2]).abs()
                <= bend + 64.0 * rounding / (width * width) + 64.0 * tolerance::ULP.value * touch.lift[2].abs()
    }
}

impl Cam {
    /// Sharpest hollow into which the follower does not fit, among sampled angles; with its polar angle, rad.
    fn sharpest_hollow(&self, contact: FollowerContact) -> Option<(f64, Unfollowed)> {
        /// Samples of all segments together, and largest number in one segment.
        const SAMPLES: usize = 1 << 16;
        const OF_ONE: usize = 64;
        let samples = (SAMPLES / self.segments().len()).clamp(1, OF_ONE);
        let of_segment = |segment: &Segment| {
            let at = |sample: usize| segment.start + (segment.end - segment.start) * sample as f64 / samples as f64;
            let hollow = |polar: f64| match Touch::new(&segment.law, polar, contact) {
                Err(Unfollowed::Hollow { radius } | Unfollowed::Undercut { radius }) => Some((polar, radius)),
                _ => None,
            };
            (0..=samples).filter_map(|sample| hollow(at(sample))).collect::<Vec<_>>()
        };
        let all = self.segments().iter().flat_map(of_segment);
        let (polar, radius) = all.min_by(|one, two| one.1.abs().total_cmp(&two.1.abs()))?;
        let is_face = contact == FollowerContact::Flat;
        Some((polar, if is_face { Unfollowed::Hollow { radius } } else { Unfollowed::Undercut { radius } }))
    }

    /// Returns the lift of a follower on a contour; `self` is the contour's radius over the polar angle. `reject` turns the reason for a
    /// failure and its polar angle, rad, into an error.
    pub(super) fn enveloped(
        self,
        contact: FollowerContact,
        reject: impl Fn(f64, Unfollowed) -> ModelError,
    ) -> Result<Self, ModelError> {
        if contact.is_point() {
            return Ok(self);
        }
        let bounds = self.segments().iter().map(|segment| segment.bounds.lift);
        let [low, high] =
            bounds.fold([f64::INFINITY, f64::NEG_INFINITY], |all, it| [all[0].min(it[0]), all[1].max(it[1])]);
        let mut pieces = Pieces { contact, rise: high - low, laws: Vec::new() };
        let mut starts = Vec::new();
        let reject = |polar: f64, why: Unfollowed| {
            let (polar, why) = self.sharpest_hollow(contact).unwrap_or((polar, why));
            reject(polar, why)
        };
        for (index, segment) in self.segments().iter().enumerate() {
            let Segment { start, end, law, .. } = segment;
            let touch = |polar: f64| Touch::new(law, polar, contact).map_err(|why| reject(polar, why));
            let [first, last] = [touch(*start)?, touch(*end)?];
            starts.push(pieces.laws.len());
            if let Law::Dwell(_) = law {
                pieces.laws.push((first.angle, Law::Dwell(first.lift[0])));
                continue;
            }
            let rests = matches!(self.segments()[(index + 1) % self.segments().len()].law, Law::Dwell(_));
            pieces
                .add(law, [*start, *end], [&first, &last], rests, HALVINGS)
                .map_err(|(polar, why)| reject(polar, why))?;
        }
        let mut laws: Vec<(f64, Law)> = pieces.laws.into_iter().map(within_turn).collect();
        let corner = |corner: &Corner| (within_a_turn(laws[starts[corner.segment]].0), corner.jump_order);
        let mut corners: Vec<(f64, usize)> = self.corners().iter().map(corner).collect();
        corners.sort_by(|one, two| one.0.total_cmp(&two.0));
        let degree = if let Joint::Spline { degree, .. } = self.joint { degree } else { MATCHED };
        laws.sort_by(|one, two| one.0.total_cmp(&two.0));
        Ok(Self::from_laws(laws, Joint::Listed { degree, corners: corners.into() }))
    }
}
