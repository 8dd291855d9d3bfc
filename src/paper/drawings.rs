//! Checks of Appendix A and of the drawn cams, by the coordinates of the figures in the arXiv source and by the printed lift.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;
use serde::Deserialize;

use super::context::{Context, Decision, decide};
use super::statements::Shown;
use crate::agreement::worse;
use crate::elementary;
use crate::model::{ArcsProfile, CamProfile};
use crate::published::Verdict;
use crate::tolerance;

/// File with the arcs of the drawn cams.
const DRAWN: &str = include_str!("../../golden/published/drawings.json");

/// Names of the letters of Appendix A, in the order used here.
const LETTERS: [&str; 6] = ["rho0", "kappa1", "rho1", "kappa2", "rho2", "rho3"];

#[derive(Deserialize)]
struct Drawings {
    drawings: Vec<Drawing>,
}

/// A drawn cam.
#[derive(Deserialize)]
struct Drawing {
    figure: String,
    /// Counterclockwise from the base circle: flank, nose, top, nose, flank.
    arcs: [DrawnArc; 6],
    /// The angle that is marked as the cam's turn from R to P, deg.
    marked_deg: Option<f64>,
}

/// An arc: its centre, its radius, and the angles at which it begins and ends, degrees.
#[derive(Clone, Copy, Deserialize)]
struct DrawnArc(f64, f64, f64, f64, f64);

impl DrawnArc {
    fn centre(self) -> Vector2<f64> {
        Vector2::new(self.0, self.1)
    }

    fn at(self, degrees: f64) -> Vector2<f64> {
        let (sin, cos) = elementary::sin_cos(degrees.to_radians());
        self.centre() + self.2 * Vector2::new(cos, sin)
    }
}

impl Drawing {
    fn of(figure: &str) -> Result<Self, Box<dyn std::error::Error>> {
        let all: Drawings = serde_json::from_str(DRAWN)?;
        let found = all.drawings.into_iter().find(|drawing| drawing.figure == figure);
        Ok(found.ok_or_else(|| format!("golden/published/drawings.json: no {figure}"))?)
    }

    /// rho0, kappa1, rho1, kappa2, rho2, rho3 as [`LETTERS`] has them.
    fn lengths(&self) -> [f64; 6] {
        let [base, _, _, top, nose, flank] = self.arcs;
        let from_axis = |arc: DrawnArc| (arc.centre() - base.centre()).norm();
        [base.2, from_axis(flank), flank.2, from_axis(nose), nose.2, top.2]
    }

    /// R, P and Q as vectors from the axis: the points where base circle and flank, flank and nose, nose and top meet, on the half that is
    /// drawn last.
    fn points(&self) -> [Vector2<f64>; 3] {
        let [base, _, _, _, nose, flank] = self.arcs;
        [flank.at(flank.4), flank.at(flank.3), nose.at(nose.3)].map(|point| point - base.centre())
    }

    /// Returns the largest gap between two circles that should touch, and the largest angle by which an arc runs past the next, degrees.
    fn misses(&self) -> (f64, f64) {
        let neighbours = self.arcs.iter().zip(self.arcs.iter().cycle().skip(1));
        neighbours.fold((0.0, 0.0), |(gap, past), (one, next)| {
            let apart = (one.centre() - next.centre()).norm() - (one.2 - next.2).abs();
            let turned = (one.4 - next.3 + 180.0).rem_euclid(360.0) - 180.0;
            (worse(gap, apart.abs()), worse(past, turned.abs()))
        })
    }
}

/// Polar angle of a point, deg, in (-180, 180].
fn polar(point: Vector2<f64>) -> f64 {
    elementary::atan2(point[1], point[0]).to_degrees()
}

fn with_places(numbers: &[f64], places: usize) -> String {
    numbers.iter().map(|number| format!("{number:.places$}")).collect::<Vec<_>>().join(", ")
}

/// Returns the lengths of Appendix A for the model's cam, and theta1, theta2, theta3, rad and signed. Those that the model file does not give
/// follow from tangency.
fn computed_with(context: &Context<'_>) -> Result<([f64; 6], [f64; 3]), &'static str> {
    let CamProfile::Arcs(ArcsProfile { base_radius, flank_radius, nose_radius, flank_start_deg, nose_end_deg, .. }) =
        context.model.cam
    else {
        return Err("the cam is not one of arcs");
    };
    let (sin, cos) = elementary::sin_cos((nose_end_deg - flank_start_deg).to_radians());
    // kappa1 = rho1 - rho0 and |O1 O2| = rho1 - rho2, by the law of cosines.
    let kappa1 = flank_radius - base_radius;
    let kappa2 = ((flank_radius - nose_radius).powi(2) - (kappa1 * sin).powi(2)).sqrt() - kappa1 * cos;
    let p = context.cam.corners().get(1).ok_or("the cam has no corner P")?.angle;
    let angles = [flank_start_deg.to_radians(), p, nose_end_deg.to_radians()].map(|angle| PI / 2.0 - angle);
    Ok(([base_radius, kappa1, flank_radius, kappa2, nose_radius, kappa2 + nose_radius], angles))
}

/// Compares Fig. camprofile (a) with the model: its lengths divided by 5, and its angle from R to P.
pub(super) fn drawn_profile(context: &Context<'_>) -> Decision {
    const SCALE: f64 = 5.0;
    let drawing = Drawing::of("camprofile (a)")?;
    let (lengths, [theta1, theta2, _]) = computed_with(context)?;
    let drawn = drawing.lengths().map(|length| length / SCALE);
    let otherwise: Vec<usize> = (0..LETTERS.len())
        .filter(|index| (drawn[*index] - lengths[*index]).abs() > tolerance::DRAWN_LENGTH.value * lengths[*index])
        .collect();
    let [r, p, _] = drawing.points().map(polar);
    let marked = drawing.marked_deg.ok_or("the drawing marks no angle")?;
    let computed = (theta1 - theta2).to_degrees();
    let names: Vec<_> = otherwise.iter().map(|index| LETTERS[*index]).collect();
    let evidence = format!(
        "the drawn {} divided by {SCALE} are {}; the model has {}. The angle from R to P is {marked:.4} deg as marked, {:.4} deg by the arcs, and {computed:.4} deg in \
         the model. Lengths that differ from the model: {}",
        LETTERS.join(", "),
        with_places(&drawn, 5),
        with_places(&lengths, 5),
        r - p,
        if names.is_empty() { "none".into() } else { names.join(", ") }
    );
    let same_angle = [marked, r - p].iter().all(|turn| (turn - computed).abs() <= tolerance::DRAWN_DEGREES.value);
    decide(otherwise.is_empty() && same_angle, if same_angle { Verdict::InPart } else { Verdict::Refuted }, evidence)
}

/// Checks that the cam of Fig. pushroadvalve is that of Fig. camprofile (a), moved.
pub(super) fn drawn_valve_train(_: &Context<'_>) -> Decision {
    let [there, here] = ["pushroadvalve", "camprofile (a)"].map(Drawing::of);
    let (there, here) = (there?, here?);
    let moved = there.arcs[0].centre() - here.arcs[0].centre();
    let off = there.arcs.iter().zip(here.arcs).map(|(one, other)| {
        let centre = (one.centre() - other.centre() - moved).norm();
        [centre, (one.2 - other.2).abs(), (one.3 - other.3).abs(), (one.4 - other.4).abs()].into_iter().fold(0.0, worse)
    });
    let off = off.fold(0.0, worse);
    let evidence = format!(
        "the drawn cam has the arcs of Fig. camprofile (a), moved by ({}, {}), to within {}. No computation can contradict the \
         drawing of lifter, rod, rocker and valve",
        Shown(moved[0]),
        Shown(moved[1]),
        Shown(off)
    );
    decide(off <= tolerance::DISPLAYED_ZERO.value, Verdict::Misprint, evidence)
}

/// Checks in Fig. camprofileeq that circles which should touch do so, and that each arc ends where the next begins.
pub(super) fn drawn_construction(_: &Context<'_>) -> Decision {
    let [(gap_a, past_a), (gap_b, past_b)] =
        [Drawing::of("camprofileeq (a)")?.misses(), Drawing::of("camprofileeq (b)")?.misses()];
    let [rho0, _, rho1, _, rho2, _] = Drawing::of("camprofileeq (a)")?.lengths();
    let evidence = format!(
        "by their drawn coordinates, the circles miss touching by at most {:.3}, with a base radius of {rho0}. In \
         panel (a) each arc ends where the next begins; in panel (b) the nose arcs run {past_b:.1} deg past P. The drawing is of \
         another cam (flank from 70 deg, radii {rho0}, {rho1}, {rho2}) than the paper's computations",
        worse(gap_a, gap_b)
    );
    let touch = worse(gap_a, gap_b) <= tolerance::DRAWN_LENGTH.value * rho0;
    let ends = [past_a, past_b].map(|past| past <= tolerance::DRAWN_DEGREES.value);
    decide(touch && ends == [true, true], if touch { Verdict::Misprint } else { Verdict::Refuted }, evidence)
}

/// kappa_i and rho_i are lengths of Fig. camprofileeq: definitions, three of which follow from the others.
pub(super) fn lengths_defined(_: &Context<'_>) -> Decision {
    let drawing = Drawing::of("camprofileeq (a)")?;
    let [rho0, kappa1, rho1, kappa2, rho2, rho3] = drawing.lengths();
    let [.., nose, flank] = drawing.arcs;
    let apart = (flank.centre() - nose.centre()).norm();
    let off = [kappa1 - (rho1 - rho0), apart - (rho1 - rho2), rho3 - (kappa2 + rho2)];
    let evidence = format!(
        "in Fig. camprofileeq (a), as drawn, {} are {}. Arcs that meet without a kink need kappa1 = rho1 - rho0, |O1 O2| = rho1 - \
         rho2 and rho3 = kappa2 + rho2; the drawing has this within {:.3}",
        LETTERS.join(", "),
        with_places(&drawing.lengths(), 4),
        off.iter().fold(0.0_f64, |worst, off| worse(worst, off.abs()))
    );
    Ok((Verdict::Definition, evidence))
}

/// Checks the order of the pieces of the lift. Angles between rays have no sign; but the pieces follow each other only if the angles of P and
/// Q, below the axis S, are negative.
pub(super) fn angles_defined(_: &Context<'_>) -> Decision {
    let signed = Drawing::of("camprofileeq (a)")?.points().map(polar);
    let ends = |angles: [f64; 3]| angles.map(|angle| 90.0 - angle);
    let rises = |ends: [f64; 3]| ends[0] < ends[1] && ends[1] < ends[2];
    let unsigned = signed.map(f64::abs);
    let evidence = format!(
        "R, P and Q of Fig. camprofileeq (a) are drawn {} deg from S, so the pieces end at {} deg. But an angle between two rays \
         has no sign. As defined, the angles are {}, and the pieces would end at {} deg, each before the piece that it follows",
        with_places(&signed, 2),
        with_places(&ends(signed), 2),
        with_places(&unsigned, 2),
        with_places(&ends(unsigned), 2)
    );
    decide(rises(ends(unsigned)), if rises(ends(signed)) { Verdict::Misprint } else { Verdict::Refuted }, evidence)
}

/// Returns the printed lift of Appendix A at an angle in (0, pi]; none where no piece, or more than one, contains the angle.
fn printed_lift(lengths: [f64; 6], [theta1, theta2, theta3]: [f64; 3], angle: f64) -> Option<f64> {
    let [rho0, kappa1, rho1, kappa2, rho2, rho3] = lengths;
    let [r, p, q] = [theta1, theta2, theta3].map(|theta| PI / 2.0 - theta);
    // c_1 = -kappa1 sin(theta + theta1) + (rho1^2 - kappa1^2 cos(theta + theta1)^2)^(1/2), c_2 likewise
    let circle = |kappa: f64, rho: f64, turned: f64| {
        let (sin, cos) = elementary::sin_cos(turned);
        kappa * sin + (rho * rho - (kappa * cos).powi(2)).sqrt()
    };
    let pieces = [
        (0.0 < angle && angle <= r, rho0),
        (r < angle && angle <= p, circle(-kappa1, rho1, angle + theta1)),
        (p < angle && angle <= q, circle(kappa2, rho2, angle + theta3)),
        (q < angle && angle <= PI, rho3),
    ];
    let mut held = pieces.into_iter().filter(|(holds, _)| *holds).map(|(_, lift)| lift);
    held.next().filter(|_| held.next().is_none())
}

/// Compares the printed pieces of the lift with the cam of the computations, with signed angles and without.
pub(super) fn pieces_of_the_lift(context: &Context<'_>) -> Decision {
    const ANGLES: u32 = 3600;
    let (lengths, signed) = computed_with(context)?;
    let furthest = |angles: [f64; 3]| {
        (1..=ANGLES).fold((0.0_f64, 0_u32), |(furthest, without), step| {
            let angle = 0.5 * TAU * f64::from(step) / f64::from(ANGLES);
            match printed_lift(lengths, angles, angle) {
                Some(lift) => (worse(furthest, (lift - context.cam.lift(angle).value).abs()), without),
                None => (furthest, without + 1),
            }
        })
    };
    let (with_signs, without) = (furthest(signed), furthest(signed.map(f64::abs)));
    let evidence = format!(
        "at {ANGLES} angles up to pi: with signed theta_i ({} deg), the pieces as printed are the cam within {} m. Without \
         signs, {} of the angles have no piece or two pieces, and the lift at others is wrong by up to {:.3} m",
        with_places(&signed.map(f64::to_degrees), 4),
        Shown(with_signs.0),
        without.1,
        without.0
    );
    let is_cam = |(off, without): (f64, u32)| off <= tolerance::IDENTITY.value && without == 0;
    decide(is_cam(without), if is_cam(with_signs) { Verdict::Misprint } else { Verdict::Refuted }, evidence)
}

/// Checks the label c(tau) - c(0) of the lift in Fig. cam-shaft, by the gravity that the printed x* would need with a spring that is slack
/// at 0, as in eq:fb1.
pub(super) fn label_of_the_lift(context: &Context<'_>) -> Decision {
    const EARTHS: f64 = 9.80665;
    let x_star = context.printed_entry("x_star", 0)?;
    let period = context.printed_entry("T_star", 0)?;
    let follower = context.model.follower;
    let omega0_squared = follower.stiffness / follower.mass;
    // q + g/omega0^2 = h phi_{T/2} x* = x1* cos(omega0 T/2) at the corner, without damping and with x2* = 0
    let first = x_star * elementary::cos(omega0_squared.sqrt() * 0.5 * period);
    let lift = context.findings.at.corner.minus.value;
    let gravity = |from: f64| omega0_squared * (first - (lift - from));
    let [labelled, from_axis] = [context.cam.lift(0.0).value, 0.0].map(gravity);
    let evidence = format!(
        "by the printed x*, the follower is {first:.6} m above the equilibrium at the corner, where c(tau) - c(0) is {:.6} m. With a spring \
         slack at 0, as in eq:fb1, that needs g = {labelled:.2} m/s^2. With c measured from the axis, as in Appendix A, it needs {from_axis:.2} \
         m/s^2. With c measured from {} m, where the spring of the authors' example is slack, it needs {:.2} m/s^2",
        lift - context.cam.lift(0.0).value,
        follower.rest_position,
        // Rounding decides the sign of a zero; adding 0 removes it.
        (100.0 * gravity(follower.rest_position)).round() / 100.0 + 0.0
    );
    decide(labelled.round() == EARTHS.round(), Verdict::Misprint, evidence)
}
