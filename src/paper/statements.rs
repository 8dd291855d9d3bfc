//! The statements in words and the figures: each decided by a computation of its own.

use std::fmt;

use nalgebra::Vector2;

use super::context::{Context, Decision, decide};
use crate::agreement::{Quantity, worse};
use crate::border_collision::Classification;
use crate::border_collision::feigin::{Scenario, Speeds};
use crate::cam::Side;
use crate::corner::map::RouteName;
use crate::corner::{self, CornerImpact, LocateError};
use crate::flight::{Flight, State};
use crate::model::Model;
use crate::published::Verdict;
use crate::simulate::{EventKind, Machine};
use crate::tolerance;

/// A number with ten significant digits, zero where rounding made it.
pub(super) struct Shown(pub f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.0;
        if value.abs() <= tolerance::DISPLAYED_ZERO.value {
            return write!(f, "0");
        }
        let places = (9.0 - value.abs().log10().floor()).clamp(0.0, 15.0) as usize;
        let text = format!("{value:.places$}");
        write!(f, "{}", if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text })
    }
}

/// eq:fb1, by second differences of a flight that knows only its closed form.
pub(super) fn equation_of_motion(context: &Context<'_>) -> Decision {
    let follower = &context.model.follower;
    let flight = Flight::new(follower);
    let start = State { position: follower.rest_position + 0.2, velocity: 1.0 };
    let (time, step) = (0.01, 1e-4);
    let at = |time: f64| flight.fly(start, time).1;
    let (before, now, after) = (at(time - step), at(time), at(time + step));
    let acceleration = (after.velocity - before.velocity) / (2.0 * step);
    let spring = follower.stiffness * (now.position - follower.rest_position);
    let law = -(follower.damping * now.velocity + spring) / follower.mass - follower.gravity;
    let size = follower.gravity.abs() + (spring.abs() + follower.damping * now.velocity.abs()) / follower.mass;
    let evidence =
        format!("after 0.01 s, q'' by differences and by the equation: {acceleration:.3} and {law:.3} m/s^2");
    decide((acceleration - law).abs() <= tolerance::DIFFERENCED.value * size.max(1.0), Verdict::Refuted, evidence)
}

/// eq:i1 at every impact of a run, with the cam's velocity from its law: the simulator's impacts are held against the print.
pub(super) fn restitution_law(context: &Context<'_>) -> Decision {
    const REVOLUTIONS: u64 = 20;
    let omega = context.findings.at.angular_velocity();
    let machine = Machine::new(context.cam.clone(), &context.model.follower, omega);
    let mut motion = machine.start_on_cam(0.0, 0.0)?;
    let (r, mut furthest) = (machine.restitution(), None);
    machine.watch(&mut motion, REVOLUTIONS, |event| {
        if event.kind == EventKind::Impact {
            let (cam, incoming) = (omega * context.cam.lift(event.cam_angle).slope, event.velocity_before);
            let printed = (1.0 + r) * cam - r * incoming;
            let off = (event.velocity_after - printed).abs() / (cam.abs() + incoming.abs());
            furthest = Some(furthest.map_or(off, |furthest| worse(furthest, off)));
        }
    })?;
    let furthest = furthest.ok_or("the follower that starts on the cam meets no impact")?;
    let evidence = format!(
        "at each impact of {REVOLUTIONS} revolutions from rest on the cam, at omega*, the simulated velocity is off by {} of its \
         size at most",
        Shown(furthest)
    );
    decide(furthest <= tolerance::IDENTITY.value, Verdict::Refuted, evidence)
}

/// Fig. camprofile: every corner of the cam is one of acceleration.
pub(super) fn acceleration_jumps(context: &Context<'_>) -> Decision {
    let corners = context.cam.corners();
    let angles: Vec<_> = corners.iter().map(|corner| format!("{:.3}", corner.angle.to_degrees())).collect();
    let orders = corners.iter().all(|corner| corner.jump_order == 2);
    let evidence = format!("only the second derivative jumps, at {} deg", angles.join(", "));
    decide(orders && corners.len() == 6, Verdict::Refuted, evidence)
}

/// At the corners the lift and its slope have one value, the second derivative two.
pub(super) fn profile_is_continuous(context: &Context<'_>) -> Decision {
    let corners = context.cam.corners();
    let continuous = corners.iter().all(|corner| corner.jump_order > 1);
    let orders: Vec<_> = corners.iter().map(|corner| corner.jump_order.to_string()).collect();
    let evidence = format!("first derivative to jump at each of the {} corners: {}", corners.len(), orders.join(", "));
    decide(!continuous, Verdict::Misprint, evidence)
}

/// What `of` says of the corner impact of the same machine with zeta = 1/s.
fn damped<T>(context: &Context<'_>, of: impl Fn(&Model, &CornerImpact) -> T) -> Result<T, LocateError> {
    let mut model = context.model.clone();
    model.follower.damping = 2.0 * model.follower.mass;
    let (at, _) = corner::locate(&model, context.cam)?;
    Ok(of(&model, &at))
}

/// By symmetry in time of the undamped flight only: with a little damping it is not so.
pub(super) fn at_rest(context: &Context<'_>) -> Decision {
    let velocity = context.findings.at.x_star()[1];
    let beside = damped(context, |_, at| at.x_star()[1])
        .map_or_else(|error| error.to_string(), |velocity| format!("{velocity:.4} m/s"));
    let evidence = format!("{} m/s, because the follower is undamped; with zeta = 1/s it is {beside}", Shown(velocity));
    decide(velocity.abs() <= tolerance::DISPLAYED_ZERO.value, Verdict::Refuted, evidence)
}

/// Each revolution that an estimator samples must have one impact, near the corner, or the estimator fails.
pub(super) fn one_impact(context: &Context<'_>) -> Decision {
    let estimates = context.findings.routes.iter().filter(|route| route.uncertainty.is_some());
    let ran: Vec<_> = estimates.map(|route| route.name).collect();
    let names = ran.iter().map(RouteName::to_string).collect::<Vec<_>>().join(" and ");
    let evidence = format!("so has the located orbit in simulation, and each perturbed revolution of {names}");
    let both = [RouteName::LeastSquares, RouteName::FiniteDifference].iter().all(|name| ran.contains(name));
    decide(both, Verdict::Refuted, evidence)
}

pub(super) fn two_sides(context: &Context<'_>) -> Decision {
    let map = &context.findings.map;
    let jumps = [(map.plus.a - map.minus.a).abs().max(), (map.plus.b - map.minus.b).abs().max()];
    let sizes = [map.minus.a.abs().max(), map.minus.b.abs().max()];
    let evidence = format!("entries of A jump by up to {}, of B by up to {}", Shown(jumps[0]), Shown(jumps[1]));
    let jumping = jumps.iter().zip(sizes).all(|(jump, size)| *jump > tolerance::IDENTITY.value * size);
    decide(jumping, Verdict::Refuted, evidence)
}

/// Undamped, A has equal diagonal entries; the printed matrices have them, to all digits.
pub(super) fn positive_constants(context: &Context<'_>) -> Decision {
    let difference = |quantity: Quantity| {
        let number = context.findings.published.iter().find(|number| number.agreement.quantity == quantity)?;
        let entry = |index: usize| number.printed.get(index)?.parse::<f64>().ok();
        Some(entry(0)? - entry(3)?)
    };
    let with_damping = damped(context, |model, at| corner::closed_form::route(model, at).map.plus.a)
        .map_or_else(|error| error.to_string(), |a| format!("{:.4}", a[(0, 0)] - a[(1, 1)]));
    let differences = difference(Quantity::A(Side::Minus)).zip(difference(Quantity::A(Side::Plus)));
    let (minus, plus) = differences.ok_or("the printed matrices were not compared")?;
    let evidence = format!(
        "the printed A- and A+ have equal diagonals (differences {minus} and {plus}), which needs b = 0: zeta = 1/s would \
         part those of A+ by {with_damping}"
    );
    decide(minus != 0.0 && plus != 0.0, Verdict::Refuted, evidence)
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
    let all = estimates.clone().count() == 4 && estimates.clone().all(|number| number.agreement.agrees);
    decide(all, Verdict::Refuted, format!("largest differences: {}; five decimals allow 5e-6", parts.join(", ")))
}

/// What decides about the local map; a degenerate one has none.
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
        "{}; fixed points exist at speeds {} (minus) and {} (plus) than omega*",
        verdict.scenario, verdict.minus.exists_for, verdict.plus.exists_for
    );
    decide(verdict.scenario == Scenario::NonsmoothFold && same, Verdict::Refuted, evidence)
}

pub(super) fn figure_of_the_local_map(context: &Context<'_>) -> Decision {
    let verdict = classification(context)?;
    let (minus, plus) = (verdict.minus.exists_for, verdict.plus.exists_for);
    let evidence =
        format!("minus side's fixed point at speeds {minus} than omega*, plus side's {plus}: faster is dT < 0");
    decide(minus == Speeds::Slower && plus == Speeds::Slower, Verdict::Refuted, evidence)
}

pub(super) fn fixed_points_above(context: &Context<'_>) -> Decision {
    let verdict = classification(context)?;
    let (minus, plus) = (&verdict.minus, &verdict.plus);
    let above = minus.exists_for == Speeds::Faster && plus.exists_for == Speeds::Faster;
    let evidence = format!(
        "plus: stable {}, exists at speeds {} than omega*; minus: stable {}, {}",
        plus.stable, plus.exists_for, minus.stable, minus.exists_for
    );
    decide(above && plus.stable && !minus.stable, Verdict::Refuted, evidence)
}

/// On the border the two sides of this model's map are one.
pub(super) fn continuity(context: &Context<'_>) -> Decision {
    let map = &context.findings.map;
    let (c, d) = (map.c(), map.d());
    let (jump_a, jump_b) = (map.plus.a - map.minus.a, map.plus.b - map.minus.b);
    // Two directions span the border: along it in the state, and from it with dT.
    let directions = [(Vector2::new(-c[1], c[0]), 0.0), (Vector2::new(-d / c[0], 0.0), 1.0)];
    let jump = |(dx, dt): &(Vector2<f64>, f64)| {
        (jump_a * dx + jump_b * *dt).norm() / (jump_a.norm() * dx.norm() + jump_b.norm() * dt.abs())
    };
    let largest = directions.iter().map(jump).fold(0.0_f64, worse);
    let evidence = format!(
        "on C dx + D dT = 0 the two sides differ by {} of their jump elsewhere, with C and D of this model",
        Shown(largest)
    );
    decide(largest <= tolerance::IDENTITY.value && jump_a.norm() > 0.0, Verdict::Refuted, evidence)
}
