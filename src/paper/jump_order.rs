//! Check of the paper's conjecture that the order of the derivative that jumps decides the local map, at several corners.

use std::error::Error;
use std::f64::consts::TAU;

use super::context::{Context, Decision, decide};
use crate::cam::{Cam, Corner};
use crate::corner::jump_order::Approach;
use crate::corner::jump_order::compared::{Compared, compare};
use crate::corner::jump_order::predicted::Hits;
use crate::model::{CamProfile, Model, OSORIO_2008};
use crate::published::Verdict;

/// A flight onto a corner of a model that is built in.
#[derive(Clone, Copy, Debug)]
pub struct Example {
    /// The machine and the event, in a few words.
    pub name: &'static str,
    file: &'static str,
    text: &'static str,
    /// Whether humps are turned into hollows.
    upside_down: bool,
    /// The corner's place among the cam's corners.
    corner: usize,
    /// Speed, rpm.
    pub rpm: f64,
    /// u-, m/s.
    pub closing_velocity: f64,
}

const SINE: Example = Example {
    name: "",
    file: "rectified-sine.toml",
    text: include_str!("../../models/laws/rectified-sine.toml"),
    upside_down: false,
    corner: 1,
    rpm: 60.0 / TAU,
    closing_velocity: 4.0,
};

const PROGRAM: Example =
    Example { file: "program.toml", text: include_str!("../../models/laws/program.toml"), rpm: 600.0, ..SINE };

const JERK: Example =
    Example { file: "jerk.toml", text: include_str!("../../models/jump-order/jerk.toml"), rpm: 706.0, ..SINE };

/// Flights onto corners: at least one for each order from 1 to 4, and for order 1 one for each way to hit.
pub static EXAMPLES: [Example; 11] = [
    Example { name: "rectified sine, one impact on either side", ..SINE },
    Example { name: "rectified sine, a second impact after the corner", closing_velocity: 1.0, ..SINE },
    Example { name: "hollows, no impact after the corner", upside_down: true, closing_velocity: 0.5, ..SINE },
    Example { name: "hollows, one impact on either side", upside_down: true, ..SINE },
    Example {
        name: "the paper's cam at P",
        file: "osorio-2008.toml",
        text: OSORIO_2008,
        corner: 1,
        rpm: 673.234445003848821,
        closing_velocity: 193.667598912036,
        ..SINE
    },
    Example { name: "program, dwell to harmonic", corner: 11, closing_velocity: 5.0, ..PROGRAM },
    Example { name: "jerk, rising", corner: 1, closing_velocity: 50.0, ..JERK },
    Example { name: "jerk, near the top", corner: 2, closing_velocity: 30.0, ..JERK },
    Example { name: "program, dwell to cycloidal", corner: 1, closing_velocity: 5.0, ..PROGRAM },
    Example { name: "program, within a modified sine", corner: 8, closing_velocity: 5.0, ..PROGRAM },
    Example { name: "program, 4-5-6-7 polynomial to dwell", corner: 0, closing_velocity: 5.0, ..PROGRAM },
];

impl Example {
    /// Model, cam and flight.
    pub fn build(&self) -> Result<(Model, Cam, Approach), Box<dyn Error>> {
        let mut model = Model::parse(self.file, self.text)?;
        if let CamProfile::RectifiedSine(profile) = &mut model.cam {
            profile.amplitude *= if self.upside_down { -1.0 } else { 1.0 };
        }
        let cam = Cam::new(&model)?;
        let corners = cam.corners();
        let no_corner =
            || format!("{}: the cam has {} corners, none with index {}", self.name, corners.len(), self.corner);
        let corner: Corner = *corners.get(self.corner).ok_or_else(no_corner)?;
        let omega = crate::simulate::angular_velocity(self.rpm);
        let approach = Approach::new(corner, omega, omega * corner.minus.slope - self.closing_velocity)?;
        Ok((model, cam, approach))
    }

    /// Predictions and measurements for the flight.
    pub fn compare(&self) -> Result<Compared, Box<dyn Error>> {
        let (model, cam, approach) = self.build()?;
        Ok(compare(&model, &cam, &approach)?)
    }
}

/// Compares exponents and coefficients at corners of order 1 to 4, by simulation and by formula.
pub(super) fn order_of_the_jump(_: &Context<'_>) -> Decision {
    let compared = EXAMPLES.iter().map(Example::compare).collect::<Result<Vec<_>, _>>()?;
    let of_order = |order: usize| compared.iter().filter(move |one| one.approach.corner.jump_order == order);
    // The first row of each comparison is that of the velocity.
    let velocities = |order: usize| of_order(order).filter_map(|one| one.rows.first());
    let furthest = |order: usize| {
        let expected = order as f64 - 1.0;
        let off = |exponent: f64| (exponent - expected).abs();
        let exponents = velocities(order).map(|row| row.measured.exponent.value);
        exponents.fold(expected, |furthest, found| if off(found) > off(furthest) { found } else { furthest })
    };
    // Rounding decides the sign of a zero; adding 0 removes it.
    let shown = |exponent: f64| (exponent * 1e3).round() / 1e3 + 0.0;
    let parts: Vec<_> = (1..=4).map(|order| format!("{:.3} for order {order}", shown(furthest(order)))).collect();
    let rows = compared.iter().map(|one| one.rows.len()).sum::<usize>();
    let agree = compared.iter().filter(|one| one.agrees()).count();
    let ways = [Hits::Once, Hits::NeverAfter, Hits::TwiceBefore];
    let complete = (1..=4).all(|order| of_order(order).next().is_some())
        && ways.iter().all(|way| of_order(1).any(|one| one.hits == *way));
    let evidence = format!(
        "the velocities after an impact s before or after the corner differ by (1+r) J s^(j-1)/(j-1)!, with J the jump of the j-th \
         derivative. Simulation gives exponents of {}. At {agree} of {} corners, all exponents and coefficients ({rows}) agree with \
         the formulas. Order 1 gives a gap, order 2 a jump of the derivative, order 3 a jump of the second derivative (docs/jump-order.md)",
        parts.join(", "),
        compared.len()
    );
    decide(complete && agree == compared.len(), Verdict::Refuted, evidence)
}
