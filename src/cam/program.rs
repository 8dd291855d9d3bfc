//! Standard motions of cam design, each from rest to rest: the `program` law.
//!
//! Formulas are for a rise of 1 over a span of 1, `x` from 0 to 1; every motion is antisymmetric about its middle, `s(1 - x) = 1 - s(x)`.
//! Norton, Cam Design and Manufacturing Handbook, gives them and their peak values.

use std::f64::consts::{PI, TAU};

use super::law::Law;
use super::polynomial::Polynomial;
use super::sinusoid::Sinusoid;
use super::{Cam, Joint};
use crate::model::{Model, ModelError, MotionSegment, ProgramProfile, StandardMotion};
use crate::tolerance;

/// Motion placed on the cam: its start, rad, its span, rad, and its lift at start and end, m.
#[derive(Clone, Copy)]
struct Placed {
    start: f64,
    span: f64,
    from: f64,
    to: f64,
}

impl Placed {
    fn rise(&self) -> f64 {
        self.to - self.from
    }

    /// Angle at the part `x` of the span.
    fn angle(&self, x: f64) -> f64 {
        self.start + x * self.span
    }

    /// `value + rise sum a_k (x - at)^k`.
    fn polynomial(&self, at: f64, value: f64, unit: &[f64]) -> Law {
        let mut scale = self.rise();
        let mut coefficients: Vec<f64> = Vec::with_capacity(unit.len());
        for a in unit {
            coefficients.push(scale * a);
            scale /= self.span;
        }
        coefficients[0] += value;
        Law::Polynomial(Polynomial::new(self.angle(at), &coefficients))
    }

    /// `value + rise (velocity y + sine (phi - sin phi) + cosine (1 - cos phi))`, `y = x - at`, `phi = frequency y`.
    fn sinusoid(&self, at: f64, value: f64, wave: Wave) -> Law {
        let rise = self.rise();
        Law::Sinusoid(Sinusoid {
            start: self.angle(at),
            value,
            tilt: rise * wave.velocity / self.span,
            sine: rise * wave.sine,
            cosine: rise * wave.cosine,
            frequency: wave.frequency / self.span,
        })
    }
}

/// A sine on a straight line, for a rise of 1 over a span of 1.
#[derive(Clone, Copy)]
struct Wave {
    velocity: f64,
    sine: f64,
    cosine: f64,
    frequency: f64,
}

impl Wave {
    /// Wave with acceleration `peak sin(frequency y)` and velocity `velocity` at y = 0: the double integral.
    fn of_acceleration(peak: f64, frequency: f64, velocity: f64) -> Self {
        Self { velocity, sine: peak / (frequency * frequency), cosine: 0.0, frequency }
    }
}

/// Laws of a motion with the angles where they start.
fn laws(motion: StandardMotion, placed: &Placed) -> Vec<(f64, Law)> {
    let start = placed.start;
    match motion {
        StandardMotion::Dwell => vec![(start, Law::Dwell(placed.from))],
        // s = 2 x^2, then 1 - 2 (1 - x)^2
        StandardMotion::Parabolic => vec![
            (start, placed.polynomial(0.0, placed.from, &[0.0, 0.0, 2.0])),
            (placed.angle(0.5), placed.polynomial(1.0, placed.to, &[0.0, 0.0, -2.0])),
        ],
        // s = (1 - cos(pi x))/2
        StandardMotion::Harmonic => {
            let wave = Wave { velocity: 0.0, sine: 0.0, cosine: 0.5, frequency: PI };
            vec![(start, placed.sinusoid(0.0, placed.from, wave))]
        }
        // s = x - sin(2 pi x)/(2 pi)
        StandardMotion::Cycloidal => {
            let wave = Wave { velocity: 0.0, sine: 1.0 / TAU, cosine: 0.0, frequency: TAU };
            vec![(start, placed.sinusoid(0.0, placed.from, wave))]
        }
        StandardMotion::ModifiedTrapezoid => modified_trapezoid(placed),
        StandardMotion::ModifiedSine => modified_sine(placed),
        // s = 10 x^3 - 15 x^4 + 6 x^5
        StandardMotion::Poly345 => halves(placed, [10.0, -15.0, 6.0, 0.0, 0.0]),
        // s = 35 x^4 - 84 x^5 + 70 x^6 - 20 x^7
        StandardMotion::Poly4567 => halves(placed, [0.0, 35.0, -84.0, 70.0, -20.0]),
    }
}

/// Two halves, `s = sum a_k x^k`, k from 3 to 7, and about the end, `s = 1 - sum a_k (1 - x)^k`: at rest to the last bit at both ends.
fn halves(placed: &Placed, [a3, a4, a5, a6, a7]: [f64; 5]) -> Vec<(f64, Law)> {
    vec![
        (placed.start, placed.polynomial(0.0, placed.from, &[0.0, 0.0, 0.0, a3, a4, a5, a6, a7])),
        (placed.angle(0.5), placed.polynomial(1.0, placed.to, &[0.0, 0.0, 0.0, a3, -a4, a5, -a6, a7])),
    ]
}

/// Acceleration `C sin(4 pi x)` up to x = 1/8, C up to 3/8, `C cos(4 pi (x - 3/8))` up to 5/8, then antisymmetric.
///
/// The velocity is `C/(4 pi)` at 1/8, `C/4` more at 3/8, `C/(4 pi)` more at 1/2, and half of that on average:
/// `s(1) = (C/(2 pi) + C/4)/2 = 1` gives `C = 8 pi/(pi + 2)`.
fn modified_trapezoid(placed: &Placed) -> Vec<(f64, Law)> {
    let peak = 8.0 * PI / (PI + 2.0);
    let frequency = 4.0 * PI;
    let (rise, from, to) = (placed.rise(), placed.from, placed.to);
    // At 1/8: s = C/(4 pi)^2 (pi/2 - 1), s' = C/(4 pi).
    let covered = peak / (frequency * frequency) * (0.5 * PI - 1.0);
    let velocity = peak / frequency;
    // At 1/2: s' = C/(4 pi) + C/4 + C/(4 pi) = 2.
    let fastest = 2.0 * velocity + 0.25 * peak;
    let quarter = Wave::of_acceleration(peak, frequency, 0.0);
    // Near the end, y = x - 1: acceleration C sin(4 pi y), at rest at y = 0.
    vec![
        (placed.start, placed.sinusoid(0.0, from, quarter)),
        (placed.angle(0.125), placed.polynomial(0.125, from + rise * covered, &[0.0, velocity, 0.5 * peak])),
        (
            placed.angle(0.375),
            placed.sinusoid(0.5, from + 0.5 * rise, Wave::of_acceleration(-peak, frequency, fastest)),
        ),
        (placed.angle(0.625), placed.polynomial(0.875, to - rise * covered, &[0.0, velocity, -0.5 * peak])),
        (placed.angle(0.875), placed.sinusoid(1.0, to, quarter)),
    ]
}

/// Acceleration `C sin(4 pi x)` up to x = 1/8, `C sin(pi/3 + 4 pi x/3)` up to 7/8, `C sin(4 pi (x - 1))` up to 1.
///
/// The velocity is `C/(4 pi)` at 1/8 and `C/pi` at 1/2; its integral up to there, 1/2, gives `C = 4 pi^2/(pi + 4)`.
fn modified_sine(placed: &Placed) -> Vec<(f64, Law)> {
    let peak = 4.0 * PI * PI / (PI + 4.0);
    let (rise, from, to) = (placed.rise(), placed.from, placed.to);
    let fastest = peak / PI;
    let quarter = Wave::of_acceleration(peak, 4.0 * PI, 0.0);
    // About the middle, y = x - 1/2: pi/3 + 4 pi x/3 = pi + 4 pi y/3.
    let middle = Wave::of_acceleration(-peak, 4.0 * PI / 3.0, fastest);
    vec![
        (placed.start, placed.sinusoid(0.0, from, quarter)),
        (placed.angle(0.125), placed.sinusoid(0.5, from + 0.5 * rise, middle)),
        (placed.angle(0.875), placed.sinusoid(1.0, to, quarter)),
    ]
}

/// Builds the cam of a `program` profile.
pub(super) fn build(model: &Model, profile: &ProgramProfile) -> Result<Cam, ModelError> {
    let segments = &profile.segments;
    let last = format!("cam.segment[{}]", segments.len() - 1);
    let degrees: f64 = segments.iter().map(|segment| segment.span_deg).sum();
    if !((degrees - 360.0).abs() <= tolerance::CAM_CLOSURE.value * 360.0) {
        let words = format!("spans add up to {degrees}: must be 360 degrees");
        return Err(model.reject(&format!("{last}.span_deg"), words));
    }
    let (total, size) = segments
        .iter()
        .fold((0.0, 0.0), |(total, size): (f64, f64), MotionSegment { rise, .. }| (total + rise, size + rise.abs()));
    if !(total.abs() <= tolerance::CAM_CLOSURE.value * size) {
        let words = format!("rises add up to {total}: must be 0, or the lift jumps at 360 degrees");
        return Err(model.reject(&format!("{last}.rise"), words));
    }
    let last_motion = segments.iter().rposition(|segment| segment.motion != StandardMotion::Dwell);
    let mut placed = Placed { start: 0.0, span: 0.0, from: profile.base, to: profile.base };
    let (mut turned, mut lifted) = (0.0, 0.0);
    let mut all = Vec::new();
    for (index, segment) in segments.iter().enumerate() {
        turned += segment.span_deg;
        lifted += segment.rise;
        // The last motion ends exactly where the first began; a dwell keeps its lift.
        placed.to = match segment.motion {
            StandardMotion::Dwell => placed.from,
            _ if Some(index) == last_motion => profile.base,
            _ => profile.base + lifted,
        };
        let end = TAU * (turned / degrees);
        placed.span = end - placed.start;
        all.extend(laws(segment.motion, &placed));
        (placed.start, placed.from) = (end, placed.to);
    }
    Cam::from_laws(all, Joint::Free).without_steps(|_| (model, last.clone() + ".rise"))
}
