//! The statements in words and the figures: each decided by a computation of its own.

use std::f64::consts::TAU;
use std::fmt;

use nalgebra::Vector2;

use super::context::{Context, Found};
use crate::agreement::worse;
use crate::corner;
use crate::flight::{Flight, State};
use crate::impact::rebound;
use crate::published::Verdict;
use crate::section::StroboscopicMap;
use crate::simulate::{Machine, SimulateError};
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

/// `holds` or `otherwise`, with the numbers.
fn decide(holds: bool, otherwise: Verdict, evidence: String) -> Found {
    Found { verdict: if holds { Verdict::Holds } else { otherwise }, evidence }
}

/// eq:fb1, by second differences of a flight that knows only its closed form.
pub(super) fn equation_of_motion(context: &Context<'_>) -> Found {
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
    let evidence = format!(
        "after 0.01 s, q'' by differences and by the equation: {} and {} m/s^2",
        round(acceleration),
        round(law)
    );
    decide((acceleration - law).abs() <= tolerance::DIFFERENCED.value * size.max(1.0), Verdict::Refuted, evidence)
}

fn round(value: f64) -> String {
    format!("{value:.3}")
}

/// eq:i1.
pub(super) fn restitution_law(context: &Context<'_>) -> Found {
    let r = context.model.follower.restitution;
    let (incoming, cam) = (-3.0, 1.0);
    let (computed, printed) = (rebound(r, incoming, cam), (1.0 + r) * cam - r * incoming);
    let evidence = format!("from -3 m/s on a cam at 1 m/s: {} and {} m/s", Shown(computed), Shown(printed));
    decide((computed - printed).abs() <= tolerance::IDENTITY.value, Verdict::Refuted, evidence)
}

/// Fig. camprofile: every corner of the cam is one of acceleration.
pub(super) fn acceleration_jumps(context: &Context<'_>) -> Found {
    let corners = context.cam.corners();
    let angles: Vec<_> = corners.iter().map(|corner| format!("{:.3}", corner.angle.to_degrees())).collect();
    let orders = corners.iter().all(|corner| corner.jump_order == 2);
    let evidence = format!("only the second derivative jumps, at {} deg", angles.join(", "));
    decide(orders && corners.len() == 6, Verdict::Refuted, evidence)
}

/// The coordinates and radii that the drawing is made of.
pub(super) fn drawn_circles(_: &Context<'_>) -> Found {
    let (axis, base) = (Vector2::new(3.25, 4.0), 2.0);
    let (flank, flank_radius) = (Vector2::new(1.8114, 3.4764), 3.5310);
    let (nose, nose_radius, top) = (Vector2::new(4.0440, 1.8184), 0.745, 3.0716);
    let gaps: [f64; 3] = [
        (flank - axis).norm() - (flank_radius - base),
        (flank - nose).norm() - (flank_radius - nose_radius),
        (nose - axis).norm() + nose_radius - top,
    ];
    let largest = gaps.iter().fold(0.0_f64, |largest, gap| largest.max(gap.abs()));
    // Where flank and nose arcs end, in degrees: they should end together, at P.
    let (flank_ends, nose_ends) = ([143.4024, 36.5976], [147.1976, 32.8367]);
    let past = flank_ends
        .iter()
        .zip(nose_ends)
        .fold(0.0_f64, |past, (flank, nose): (&f64, f64)| past.max((flank - nose).abs()));
    let evidence = format!(
        "the circles miss touching by at most {largest:.3} of a base radius of 2; in panel (b) the nose arcs run {past:.1} deg \
         past P; and the drawing is of another cam (flank from 70 deg, radii 2, 3.53, 0.745) than the one computed with"
    );
    decide(largest < tolerance::DRAWING.value && past < tolerance::DRAWING.value, Verdict::Misprint, evidence)
}

/// A reference is checked by reading; its equation is proved elsewhere.
pub(super) fn appendix_b(_: &Context<'_>) -> Found {
    Found { verdict: Verdict::Misprint, evidence: "the paper ends with Appendix A; eq:gff is proved without it".into() }
}

/// Words are checked by reading: no computation decides what a sentence should have said.
pub(super) fn wording(_: &Context<'_>) -> Found {
    Found { verdict: Verdict::Misprint, evidence: "by reading: the formulas around it mean what is right".into() }
}

/// At the corners the lift and its slope have one value, the second derivative two.
pub(super) fn profile_is_continuous(context: &Context<'_>) -> Found {
    let corners = context.cam.corners();
    let continuous = corners.iter().all(|corner| corner.jump_order > 1);
    let orders: Vec<_> = corners.iter().map(|corner| corner.jump_order.to_string()).collect();
    let evidence = format!("first derivative to jump at each of the {} corners: {}", corners.len(), orders.join(", "));
    decide(!continuous, Verdict::Misprint, evidence)
}

/// The lowest speed at which the cam would have to pull the follower: `c'' w^2 < a(c)`.
pub(super) fn detachment(context: &Context<'_>) -> Found {
    const SAMPLES: usize = 2000;
    let flight = Flight::new(&context.model.follower);
    let mut lowest = (f64::INFINITY, 0.0);
    for segment in context.cam.segments() {
        for sample in 0..=SAMPLES {
            let angle = segment.start + (segment.end - segment.start) * sample as f64 / SAMPLES as f64;
            let lift = segment.law.lift(angle);
            // Undamped: a = f(c), and the cam leaves the follower behind from w^2 = f/c'' on.
            let squared = flight.force(lift.value) / lift.curvature;
            if lift.curvature < 0.0 && squared < lowest.0 {
                lowest = (squared, angle);
            }
        }
    }
    let (speed, angle) = (lowest.0.sqrt() * 60.0 / TAU, lowest.1.to_degrees());
    let evidence = format!("contact force first vanishes at {speed:.2} rpm, at cam angle {angle:.2} deg");
    decide((speed - 114.0).abs() <= tolerance::ABOUT_RPM.value, Verdict::Refuted, evidence)
}

/// A run of the stroboscopic map from x*, at another speed.
struct Run {
    /// Impacts of each revolution, over the last hundred.
    impacts: Vec<usize>,
    /// Largest move of the state from one revolution to the next, over the last hundred, in metres.
    move_per_revolution: f64,
    /// Cam angle of the last impact, rad.
    last_impact: f64,
    /// Mean growth of a small deviation per revolution, as a logarithm.
    growth: f64,
}

/// Runs `revolutions` from x* at `rpm`, beside a second run that starts a hair off and is brought back every time.
fn run(context: &Context<'_>, rpm: f64, revolutions: usize) -> Result<Run, SimulateError> {
    const HAIR: f64 = 1e-8;
    let at = &context.findings.at;
    let follower = &context.model.follower;
    let omega = rpm * TAU / 60.0;
    let machine = Machine::new(context.cam.clone(), follower, omega);
    let map = StroboscopicMap { machine, cam_angle: at.section_angle() };
    let mut state = at.state;
    let mut beside = State { position: state.position + HAIR, ..state };
    let mut result = Run { impacts: Vec::new(), move_per_revolution: 0.0, last_impact: 0.0, growth: 0.0 };
    for revolution in 0..revolutions {
        let (back, other) = (map.apply(state)?, map.apply(beside)?);
        let apart = Vector2::new(
            other.state.position - back.state.position,
            (other.state.velocity - back.state.velocity) / omega,
        );
        let distance = apart.norm().max(f64::MIN_POSITIVE);
        result.growth += (distance / HAIR).ln() / revolutions as f64;
        if revolution + 100 >= revolutions {
            result.impacts.push(back.impacts().count());
            result.move_per_revolution = result.move_per_revolution.max((back.state.position - state.position).abs());
        }
        result.last_impact = back.impacts().last().map_or(result.last_impact, |impact| impact.cam_angle);
        state = back.state;
        let scale = HAIR / distance;
        beside =
            State { position: state.position + apart[0] * scale, velocity: state.velocity + apart[1] * omega * scale };
    }
    Ok(result)
}

impl Run {
    fn is_period_one(&self) -> bool {
        self.impacts.iter().all(|impacts| *impacts == 1) && self.move_per_revolution < tolerance::SETTLED.value
    }
}

/// A statement about runs; one that the simulator gives up leaves it open.
fn by_runs(decision: Result<Found, SimulateError>) -> Found {
    decision.unwrap_or_else(|error| Found { verdict: Verdict::Open, evidence: error.to_string() })
}

/// The speeds between 660 and 750 rpm at which runs are held against the paper's diagrams.
const ABOVE: [f64; 5] = [673.3, 680.0, 700.0, 720.0, 735.0];

pub(super) fn period_one_above(context: &Context<'_>) -> Found {
    let decision = || {
        let mut settled = Vec::new();
        for rpm in ABOVE {
            if run(context, rpm, 3000)?.is_period_one() {
                settled.push(format!("{rpm}"));
            }
        }
        let evidence = format!(
            "of 3000 revolutions from x* each, those at {} rpm end on one impact a revolution, in one state",
            settled.join(", ")
        );
        Ok(decide(settled.len() == ABOVE.len(), Verdict::Refuted, evidence))
    };
    by_runs(decision())
}

/// One impact line from 673.23 up, many impacts below; and what the diagram's upper end does.
pub(super) fn impact_diagram(context: &Context<'_>) -> Found {
    let decision = || {
        let mut one_line = true;
        for rpm in ABOVE {
            one_line &= run(context, rpm, 3000)?.is_period_one();
        }
        let mut scattered = true;
        for rpm in [661.0, 665.0, 670.0, 673.0] {
            scattered &= !run(context, rpm, 3000)?.is_period_one();
        }
        let end = if run(context, 745.0, 3000)?.is_period_one() { "still one line" } else { "no longer one line" };
        let evidence = format!(
            "one impact, in one place, at all of 673.3, 680, 700, 720, 735 rpm: {one_line}; none such at 661, 665, 670, 673 rpm: {scattered}; at 745 rpm {end}"
        );
        Ok(decide(one_line && scattered, Verdict::Refuted, evidence))
    };
    by_runs(decision())
}

pub(super) fn chaos_below(context: &Context<'_>) -> Found {
    let decision = || {
        // A chaotic mean moves in its second digit with the machine's sine: the evidence says what it is compared with.
        let threshold = tolerance::CHAOTIC_GROWTH.value;
        let chaotic_at_670 = run(context, 670.0, 4000)?.growth > threshold;
        let chaotic_at_680 = run(context, 680.0, 4000)?.growth > threshold;
        let evidence = format!(
            "largest Lyapunov exponent over 4000 revolutions above {threshold} a revolution: {chaotic_at_670} at 670 rpm, \
             {chaotic_at_680} at 680 rpm"
        );
        let chaotic = chaotic_at_670 && !chaotic_at_680;
        Ok(decide(chaotic, Verdict::Refuted, evidence))
    };
    by_runs(decision())
}

pub(super) fn transition(context: &Context<'_>) -> Found {
    let speed = context.findings.at.speed_rpm();
    let decision = || {
        let above = run(context, speed + 0.01, 6000)?.is_period_one();
        let below = run(context, speed - 0.01, 6000)?.is_period_one();
        let evidence = format!(
            "one impact a revolution after 6000 from x*: {above} at 0.01 rpm above {speed:.6} rpm, {below} at 0.01 rpm below"
        );
        Ok(decide(above && !below, Verdict::Refuted, evidence))
    };
    by_runs(decision())
}

pub(super) fn orbit_at_700(context: &Context<'_>) -> Found {
    let decision = || {
        let at_700 = run(context, 700.0, 1000)?;
        let corner = context.findings.at.corner.angle;
        let evidence = format!(
            "at 700 rpm the impact is at {:.2} deg, the corner at {:.2} deg; they meet at {:.6} rpm",
            at_700.last_impact.to_degrees(),
            corner.to_degrees(),
            context.findings.at.speed_rpm()
        );
        Ok(decide((at_700.last_impact - corner).abs() <= tolerance::CORNER_ANGLE.value, Verdict::Misprint, evidence))
    };
    by_runs(decision())
}

/// By symmetry in time of the undamped flight only: with a little damping it is not so.
pub(super) fn at_rest(context: &Context<'_>) -> Found {
    let velocity = context.findings.at.x_star()[1];
    let mut damped = context.model.clone();
    damped.follower.damping = 2.0 * damped.follower.mass;
    let elsewhere = corner::locate(&damped, context.cam).map(|(at, _)| at.x_star()[1]);
    let beside = elsewhere.map_or_else(|error| error.to_string(), |velocity| format!("{velocity:.4} m/s"));
    let evidence = format!("{} m/s, because the follower is undamped; with zeta = 1/s it is {beside}", Shown(velocity));
    decide(velocity.abs() <= tolerance::DISPLAYED_ZERO.value, Verdict::Refuted, evidence)
}

/// Each revolution that an estimator samples must have one impact, near the corner, or the estimator fails.
pub(super) fn one_impact(context: &Context<'_>) -> Found {
    let ran: Vec<_> =
        context.findings.routes.iter().map(|route| route.name).filter(|name| *name != "closed_form").collect();
    let evidence =
        format!("so has the located orbit in simulation, and each perturbed revolution of {}", ran.join(" and "));
    decide(ran.contains(&"least_squares") && ran.contains(&"finite_difference"), Verdict::Refuted, evidence)
}

pub(super) fn two_sides(context: &Context<'_>) -> Found {
    let map = &context.findings.closed_form().map;
    let jumps = [(map.plus.a - map.minus.a).abs().max(), (map.plus.b - map.minus.b).abs().max()];
    let sizes = [map.minus.a.abs().max(), map.minus.b.abs().max()];
    let evidence = format!("entries of A jump by up to {}, of B by up to {}", Shown(jumps[0]), Shown(jumps[1]));
    let jumping = jumps.iter().zip(sizes).all(|(jump, size)| *jump > tolerance::IDENTITY.value * size);
    decide(jumping, Verdict::Refuted, evidence)
}

/// Undamped, A has equal diagonal entries; the printed matrices have them, to all digits.
pub(super) fn positive_constants(context: &Context<'_>) -> Found {
    let difference = |quantity: &str| {
        let number = context.findings.published.iter().find(|number| number.agreement.quantity == quantity)?;
        let entry = |index: usize| number.printed.get(index)?.parse::<f64>().ok();
        Some(entry(0)? - entry(3)?)
    };
    let mut damped = context.model.clone();
    damped.follower.damping = 2.0 * damped.follower.mass;
    let with_damping = corner::locate(&damped, context.cam)
        .map(|(at, _)| corner::closed_form::route(&damped, &at).map.plus.a)
        .map_or_else(|error| error.to_string(), |a| format!("{:.4}", a[(0, 0)] - a[(1, 1)]));
    match (difference("A_minus"), difference("A_plus")) {
        (Some(minus), Some(plus)) => {
            let evidence = format!(
                "the printed A- and A+ have equal diagonals (differences {minus} and {plus}), which needs b = 0: zeta = 1/s \
                 would part those of A+ by {with_damping}"
            );
            decide(minus != 0.0 && plus != 0.0, Verdict::Refuted, evidence)
        }
        _ => Found { verdict: Verdict::Open, evidence: "the printed matrices were not compared".into() },
    }
}

pub(super) fn validation(context: &Context<'_>) -> Found {
    let entries: Vec<_> = context
        .findings
        .comparisons
        .iter()
        .filter(|entry| {
            entry.routes == ["closed_form", "least_squares"]
                && ["A", "B"].iter().any(|m| entry.quantity.starts_with(&format!("{m}_")))
        })
        .collect();
    let agree = entries.len() == 4 && entries.iter().all(|entry| entry.agrees);
    {
        let worst = entries.iter().fold(0.0_f64, |worst, entry| worst.max(entry.max_abs_diff));
        let within = if worst < tolerance::FIVE_DECIMALS { "within" } else { "beyond" };
        let evidence = format!("this program's fit of all twelve entries is {within} five decimals of the closed form");
        decide(agree, Verdict::Refuted, evidence)
    }
}

pub(super) fn five_decimals(context: &Context<'_>) -> Found {
    let estimates = context.findings.published.iter().filter(|number| number.agreement.quantity.contains("_hat_"));
    let parts: Vec<_> = estimates
        .clone()
        .map(|number| format!("{} {:.1e}", number.agreement.quantity, number.agreement.max_abs_diff))
        .collect();
    let all = estimates.clone().count() == 4 && estimates.clone().all(|number| number.agreement.agrees);
    decide(all, Verdict::Refuted, format!("largest differences: {}; five decimals allow 5e-6", parts.join(", ")))
}

/// A statement about the classification; without one it is open.
fn by_classification(
    context: &Context<'_>,
    decide: impl Fn(&crate::border_collision::Classification) -> Found,
) -> Found {
    let degenerate = || Found { verdict: Verdict::Open, evidence: "the map is degenerate".into() };
    context.findings.classification.as_ref().map_or_else(degenerate, decide)
}

pub(super) fn odd_count(context: &Context<'_>) -> Found {
    by_classification(context, |verdict| {
        let evidence = format!(
            "{} and {} real eigenvalues above 1; det(I - A-) = {:.6}, det(I - A+) = {:.6}",
            verdict.minus.above_one, verdict.plus.above_one, verdict.minus.determinant, verdict.plus.determinant
        );
        let opposite = verdict.minus.determinant * verdict.plus.determinant < 0.0;
        decide((verdict.minus.above_one, verdict.plus.above_one) == (1, 0) && opposite, Verdict::Refuted, evidence)
    })
}

pub(super) fn nonsmooth_fold(context: &Context<'_>) -> Found {
    by_classification(context, |verdict| {
        let same = verdict.minus.exists_for == verdict.plus.exists_for;
        let evidence = format!(
            "{}; fixed points exist at speeds {} (minus) and {} (plus) than omega*",
            verdict.scenario.name(),
            verdict.minus.exists_for.name(),
            verdict.plus.exists_for.name()
        );
        decide(verdict.scenario.name() == "nonsmooth-fold" && same, Verdict::Refuted, evidence)
    })
}

pub(super) fn figure_of_the_local_map(context: &Context<'_>) -> Found {
    by_classification(context, |verdict| {
        let (minus, plus) = (verdict.minus.exists_for.name(), verdict.plus.exists_for.name());
        let evidence =
            format!("minus side's fixed point at speeds {minus} than omega*, plus side's {plus}: faster is dT < 0");
        decide(minus == "slower" && plus == "slower", Verdict::Refuted, evidence)
    })
}

pub(super) fn fixed_points_above(context: &Context<'_>) -> Found {
    by_classification(context, |verdict| {
        let (minus, plus) = (&verdict.minus, &verdict.plus);
        let above = minus.exists_for.name() == "faster" && plus.exists_for.name() == "faster";
        let evidence = format!(
            "plus: stable {}, exists at speeds {} than omega*; minus: stable {}, {}",
            plus.stable,
            plus.exists_for.name(),
            minus.stable,
            minus.exists_for.name()
        );
        decide(above && plus.stable && !minus.stable, Verdict::Refuted, evidence)
    })
}

/// On the border the two sides of this model's map are one.
pub(super) fn continuity(context: &Context<'_>) -> Found {
    let map = &context.findings.closed_form().map;
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
