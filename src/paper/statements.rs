//! Checks of the statements in words and of the figures, each by a computation of its own.

use std::error::Error;
use std::fmt;

use nalgebra::{Matrix2, Vector2};

use super::context::{Context, Decision, decide};
use crate::agreement::{Quantity, worse};
use crate::border_collision::feigin::{Scenario, Speeds, classify};
use crate::border_collision::{Classification, Refusal};
use crate::corner::map::RouteName;
use crate::corner::{self, CornerImpact, LocateError};
use crate::elementary;
use crate::flight::{Flight, State};
use crate::model::{Model, Study};
use crate::published::{PrintedNumber, Verdict};
use crate::simulate::{EventKind, Machine};
use crate::study::verify::{External, verify};
use crate::tolerance;

/// A number with ten significant digits; 0 where it is only rounding.
pub(super) struct Shown(pub f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.0;
        if value.abs() <= tolerance::DISPLAYED_ZERO.value {
            return write!(f, "0");
        }
        let places = (9.0 - elementary::log10(value.abs()).floor()).clamp(0.0, 15.0) as usize;
        let text = format!("{value:.places$}");
        write!(f, "{}", if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text })
    }
}

/// Finds the t_i that solves eq:H, for a motion beside x* that hits the cam left of t = 0 and for one that hits it right of t = 0.
pub(super) fn side_of_the_impact(context: &Context<'_>) -> Decision {
    /// Decreases of the velocity at x*, m/s. With the first the follower is lower and hits the cam earlier, with the second later.
    const SLOWER: [f64; 2] = [1.0, -1.0];
    let at = &context.findings.at;
    let (omega, corner) = (at.angular_velocity(), at.corner.angle);
    let machine = Machine::new(context.cam.clone(), &context.model.follower, omega);
    let flight = Flight::new(&context.model.follower);
    let (mut opposite, mut told) = (true, Vec::new());
    for slower in SLOWER {
        let start = State { velocity: at.state.velocity - slower, ..at.state };
        let mut motion = machine.start(at.section_angle(), start)?;
        let mut hit = None;
        machine.watch(&mut motion, 1, |event| {
            if event.kind == EventKind::Impact && hit.is_none() {
                hit = Some((event.cam_angle - corner) / omega);
            }
        })?;
        let time = hit.ok_or("the motion beside x* does not hit the cam")?;
        // eq:H   h (phi_-ti x_d - y_-ti), x_d = phi_{T/2} x as if there were no impact
        let gap = |t_i: f64| {
            let (_, state) = flight.fly(start, 0.5 * at.period - t_i);
            (state.position - context.cam.lift(corner - omega * t_i).value).abs()
        };
        let [same, other] = [gap(time), gap(-time)];
        opposite &= other < same;
        told.push(format!(
            "for an impact at {time:.6} s, {} of t = 0, H is {same:.5} m at t_i = {time:.6} s and {} m at t_i = {:.6} s",
            if time < 0.0 { "left" } else { "right" },
            Shown(other),
            -time
        ));
    }
    decide(!opposite, Verdict::Misprint, told.join("; "))
}

/// Compares the printed estimates with A and with -A, which a fit of x* - x_{n+1} would give.
pub(super) fn sign_of_the_deviation(context: &Context<'_>) -> Decision {
    let mut distances = [0.0_f64; 2];
    for (estimate, matrix) in [("A_hat_minus", "A_minus"), ("A_hat_plus", "A_plus")] {
        for index in 0..4 {
            let (hatted, entry) = (context.printed_entry(estimate, index)?, context.printed_entry(matrix, index)?);
            distances = [worse(distances[0], (hatted - entry).abs()), worse(distances[1], (hatted + entry).abs())];
        }
    }
    let evidence = format!(
        "a fit to deviations with the printed sign would give -A- and -A+. The printed estimates are within {:.1e} of the printed \
         A- and A+, but up to {:.1} from -A- and -A+",
        distances[0], distances[1]
    );
    decide(distances[1] < distances[0], Verdict::Misprint, evidence)
}

/// Evaluates eq:fixedp at T*, as printed and with its sign corrected.
pub(super) fn fixed_point_as_printed(context: &Context<'_>) -> Decision {
    let (at, follower) = (&context.findings.at, &context.model.follower);
    let flight = Flight::new(follower);
    let y0 = Vector2::new(
        at.x_star()[0] + at.corner.minus.value - at.state.position,
        at.angular_velocity() * at.corner.minus.slope,
    );
    let restitution = Matrix2::new(0.0, 0.0, 0.0, -(1.0 + follower.restitution));
    let [half, whole] = [0.5 * at.period, at.period].map(|time| flight.propagator(time));
    // eq:fixedp   x* = -[I - phi_T + sign F R F]^-1 F R y0, F = phi_{T/2}
    let solved = |sign: f64| {
        let inverse = (Matrix2::identity() - whole + sign * half * restitution * half).try_inverse();
        inverse.map(|inverse| -(inverse * (half * (restitution * y0))))
    };
    let [as_printed, repaired] = [solved(1.0), solved(-1.0)];
    let (Some(as_printed), Some(repaired)) = (as_printed, repaired) else {
        return Err("the matrix has no inverse".into());
    };
    let printed = context.printed_entry("x_star", 0)?;
    let evidence = format!(
        "at T* the equation as printed gives x1 = {:.6} m. With a minus before F R F it gives {:.6} m, and {printed:.6} m is printed. T* \
         itself is a root of h (F x* - y0) = 0, which is found numerically",
        as_printed[0], repaired[0]
    );
    let near = |x: Vector2<f64>| (x[0] - printed).abs() <= tolerance::IDENTITY.value * 10.0 * printed.abs();
    decide(near(as_printed), if near(repaired) { Verdict::Misprint } else { Verdict::Refuted }, evidence)
}

/// Checks the local map at r = 0. The law of restitution covers r from 0 to 1, but the map needs a follower that leaves the cam.
pub(super) fn plastic_impact(context: &Context<'_>) -> Decision {
    let mut model = context.model.clone();
    model.follower.restitution = 0.0;
    model.study = Some(Study { rpm_min: 700.0, rpm_max: 900.0 });
    let found = verify(&model, External::LeftOut)?;
    let speed = found.at.speed_rpm();
    let (fails, says) = match &found.classification {
        Err(refusal @ Refusal::Sticking { .. }) => (true, refusal.to_string()),
        Err(refusal) => return Err(refusal.to_string().into()),
        Ok(kind) => (false, format!("it is a {}", kind.scenario)),
    };
    let evidence = format!("with r = 0, the orbit of one impact has its impact on P at {speed:.6} rpm: {says}");
    decide(!fails, Verdict::InPart, evidence)
}

/// Checks that the acceleration jumps at every corner of the cam (Fig. camprofile).
pub(super) fn acceleration_jumps(context: &Context<'_>) -> Decision {
    let corners = context.cam.corners();
    let angles: Vec<_> = corners.iter().map(|corner| format!("{:.3}", corner.angle.to_degrees())).collect();
    let orders = corners.iter().all(|corner| corner.jump_order == 2);
    let evidence = format!("only the second derivative jumps, at {} deg", angles.join(", "));
    decide(orders && corners.len() == 6, Verdict::Refuted, evidence)
}

/// Checks that lift and slope are continuous at the corners, where the second derivative jumps.
pub(super) fn profile_is_continuous(context: &Context<'_>) -> Decision {
    let corners = context.cam.corners();
    let continuous = corners.iter().all(|corner| corner.jump_order > 1);
    let orders: Vec<_> = corners.iter().map(|corner| corner.jump_order.to_string()).collect();
    let evidence = format!(
        "the order of the lowest derivative that jumps, at each of the {} corners: {}",
        corners.len(),
        orders.join(", ")
    );
    decide(!continuous, Verdict::Misprint, evidence)
}

/// Returns the value of `of` at the corner impact of the same machine with zeta = 1/s.
fn damped<T>(context: &Context<'_>, of: impl Fn(&Model, &CornerImpact) -> T) -> Result<T, LocateError> {
    let mut model = context.model.clone();
    model.follower.damping = 2.0 * model.follower.mass;
    let (at, _) = corner::locate(&model, context.cam)?;
    Ok(of(&model, &at))
}

/// Checks that x* is at rest. The reason is the symmetry in time of the undamped flight, which damping destroys.
pub(super) fn at_rest(context: &Context<'_>) -> Decision {
    let velocity = context.findings.at.x_star()[1];
    let beside = damped(context, |_, at| at.x_star()[1])
        .map_or_else(|error| error.to_string(), |velocity| format!("{velocity:.4} m/s"));
    let evidence = format!(
        "the velocity is {} m/s, because the follower is undamped; with zeta = 1/s it is {beside}",
        Shown(velocity)
    );
    decide(velocity.abs() <= tolerance::DISPLAYED_ZERO.value, Verdict::Refuted, evidence)
}

/// Checks that the estimators ran: each fails if a sampled revolution does not have one impact, near the corner.
pub(super) fn one_impact(context: &Context<'_>) -> Decision {
    let estimates = context.findings.routes.iter().filter(|route| route.uncertainty.is_some());
    let ran: Vec<_> = estimates.map(|route| route.name).collect();
    let names = ran.iter().map(RouteName::to_string).collect::<Vec<_>>().join(" and ");
    let evidence = format!(
        "in simulation, the located orbit and each perturbed revolution of {names} have one impact a revolution"
    );
    let both = [RouteName::LeastSquares, RouteName::FiniteDifference].iter().all(|name| ran.contains(name));
    decide(both, Verdict::Refuted, evidence)
}

/// Bounds zeta by the digits of the printed matrices, from A11 - A22 = 2 zeta A12 (proved by computer algebra).
pub(super) fn positive_constants(context: &Context<'_>) -> Decision {
    context.proves(&["A11 - A22 = 2 zeta A12, on either side"])?;
    let bound = |quantity: &str| -> Result<[f64; 2], Box<dyn Error>> {
        let entry = |index| context.printed_entry(quantity, index);
        let decimals = context.printed(quantity)?.printed[0].split_once('.').map_or(0, |(_, decimals)| decimals.len());
        // Half a unit of the last digit of either entry.
        let unit = 10f64.powi(-(decimals as i32));
        let (difference, twice) = ((entry(0)? - entry(3)?).abs(), 2.0 * entry(1)?.abs());
        Ok([(difference - unit) / twice, (difference + unit) / twice])
    };
    let [minus, plus] = [bound("A_minus")?, bound("A_plus")?];
    let follower = &context.model.follower;
    let evidence = format!(
        "A11 - A22 = 2 zeta A12, by computer algebra. So the printed A- gives |zeta| <= {:.0e}/s, and the printed A+ |zeta| <= {:.0e}/s. \
         The formulas need only b >= 0. The authors' example has b = {} and g = {}",
        minus[1], plus[1], follower.damping, follower.gravity
    );
    decide(minus[0] > 0.0 || plus[0] > 0.0, Verdict::Misprint, evidence)
}

pub(super) fn validation(context: &Context<'_>) -> Decision {
    let entries: Vec<_> = context
        .findings
        .comparisons
        .iter()
        .filter(|entry| {
            entry.routes == [RouteName::ClosedForm, RouteName::LeastSquares] && entry.quantity.is_of_the_map()
        })
        .collect();
    let agree = entries.len() == 4 && entries.iter().all(|entry| entry.agrees);
    let worst = entries.iter().fold(0.0_f64, |worst, entry| worst.max(entry.max_abs_diff));
    let within = if worst < tolerance::FIVE_DECIMALS { "within" } else { "beyond" };
    let evidence = format!("this program's fit of all twelve entries is {within} five decimals of the closed form");
    decide(agree, Verdict::Refuted, evidence)
}

pub(super) fn five_decimals(context: &Context<'_>) -> Decision {
    let hatted = |quantity| matches!(quantity, Quantity::AHat(_) | Quantity::BHat(_));
    let estimates = context.findings.published.iter().filter(|number| hatted(number.agreement.quantity));
    let parts: Vec<_> = estimates
        .clone()
        .map(|number| format!("{} {:.1e}", number.agreement.quantity, number.agreement.max_abs_diff))
        .collect();
    let five = |number: &PrintedNumber| number.agreement.max_abs_diff <= tolerance::FIVE_DECIMALS;
    let all = estimates.clone().count() == 4 && estimates.clone().all(five);
    decide(all, Verdict::Refuted, format!("largest differences: {}; five decimals allow 5e-6", parts.join(", ")))
}

/// Returns the classification of the local map; a degenerate map has none.
fn classification<'a>(context: &'a Context<'_>) -> Result<&'a Classification, &'static str> {
    context.findings.classification.as_ref().map_err(|_| "the map is degenerate")
}

pub(super) fn odd_count(context: &Context<'_>) -> Decision {
    let verdict = classification(context)?;
    let evidence = format!(
        "{} and {} real eigenvalues above 1; det(I - A-) = {:.6}, det(I - A+) = {:.6}",
        verdict.minus.above_one, verdict.plus.above_one, verdict.minus.determinant, verdict.plus.determinant
    );
    let opposite = verdict.minus.determinant * verdict.plus.determinant < 0.0;
    decide((verdict.minus.above_one, verdict.plus.above_one) == (1, 0) && opposite, Verdict::Refuted, evidence)
}

pub(super) fn nonsmooth_fold(context: &Context<'_>) -> Decision {
    let verdict = classification(context)?;
    let same = verdict.minus.exists_for == verdict.plus.exists_for;
    let evidence = format!(
        "it is a {}: the fixed point of the minus side exists at speeds {} than omega*, that of the plus side at {} ones",
        verdict.scenario, verdict.minus.exists_for, verdict.plus.exists_for
    );
    decide(verdict.scenario == Scenario::NonsmoothFold && same, Verdict::Refuted, evidence)
}

pub(super) fn figure_of_the_local_map(context: &Context<'_>) -> Decision {
    let verdict = classification(context)?;
    let (minus, plus) = (verdict.minus.exists_for, verdict.plus.exists_for);
    let map = &context.findings.map;
    // The region as printed, with A+ where C dx + D dT > 0.
    let as_printed = classify(map, (map.c(), map.d())).map_err(|error| error.to_string())?;
    let evidence = format!(
        "the fixed point of the minus side exists at speeds {minus} than omega*, that of the plus side at {plus} ones; faster means dT < 0. \
         With A+ where C dx + D dT > 0, as in eq:pwlf, they would exist at {} and {} speeds, as the caption says",
        as_printed.minus.exists_for, as_printed.plus.exists_for
    );
    decide(minus == Speeds::Slower && plus == Speeds::Slower, Verdict::Refuted, evidence)
}

pub(super) fn fixed_points_above(context: &Context<'_>) -> Decision {
    let verdict = classification(context)?;
    let (minus, plus) = (&verdict.minus, &verdict.plus);
    let above = minus.exists_for == Speeds::Faster && plus.exists_for == Speeds::Faster;
    let evidence = format!(
        "the fixed point of the plus side (stable: {}) exists at speeds {} than omega*, that of the minus side (stable: {}) at {} ones",
        plus.stable, plus.exists_for, minus.stable, minus.exists_for
    );
    decide(above && plus.stable && !minus.stable, Verdict::Refuted, evidence)
}

/// Checks that the two sides of this model's map agree on the border.
pub(super) fn continuity(context: &Context<'_>) -> Decision {
    let map = &context.findings.map;
    let (c, d) = (map.c(), map.d());
    let (jump_a, jump_b) = (map.plus.a - map.minus.a, map.plus.b - map.minus.b);
    // Two directions span the border: one along it with the state alone, one with dT.
    let directions = [(Vector2::new(-c[1], c[0]), 0.0), (Vector2::new(-d / c[0], 0.0), 1.0)];
    let jump = |(dx, dt): &(Vector2<f64>, f64)| {
        (jump_a * dx + jump_b * *dt).norm() / (jump_a.norm() * dx.norm() + jump_b.norm() * dt.abs())
    };
    let largest = directions.iter().map(jump).fold(0.0_f64, worse);
    let evidence = format!(
        "on C dx + D dT = 0, the two sides differ by {} of their difference elsewhere, with C and D of this model",
        Shown(largest)
    );
    decide(largest <= tolerance::IDENTITY.value && jump_a.norm() > 0.0, Verdict::Refuted, evidence)
}
