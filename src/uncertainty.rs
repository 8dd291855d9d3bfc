//! Uncertainty of results, by its sources: the noise of a measured cam, and the errors of the follower's numbers.
//!
//! The cam's part is estimated from equally likely cams, see [`crate::measured`]. The part of a number is two standard deviations: twice
//! half the difference of the results with the number one error larger and one error smaller. Parts are independent, and the whole is the
//! root of the sum of their squares. A result that is not linear in the numbers has one common part for all numbers, from an ensemble of
//! machines.

use rayon::prelude::*;
use serde::ser::{Serialize, SerializeMap, Serializer};

use crate::cam::Cam;
use crate::elementary;
use crate::measured::{Measured, PlausibleCams, even};
use crate::model::{FollowerErrors, Model, ModelError, Moves};
use crate::tolerance;

/// Number of standard deviations in the ± of a number of the follower.
const DEVIATIONS: f64 = 2.0;

/// Uncertainty of a result, by its sources.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SourcedUncertainty {
    /// Part of the measured cam.
    pub cam: f64,
    /// Common part of the follower's numbers.
    pub numbers: f64,
    /// Part of each of these numbers, in the order of [`FollowerErrors::names`]; `None` if the result is not linear in them.
    pub each: Option<[f64; FollowerErrors::COUNT]>,
}

impl SourcedUncertainty {
    /// Unknown uncertainty.
    pub const UNKNOWN: Self = Self { cam: f64::NAN, numbers: f64::NAN, each: None };

    /// Uncertainty whose part of the numbers is unknown.
    pub(crate) const UNKNOWN_OF_NUMBERS: Self = Self { cam: 0.0, numbers: f64::NAN, each: None };

    /// Adds an uncertainty that is independent of this one. A result that is linear in both has a part of each number.
    pub(crate) fn with_independent(&self, other: &Self) -> Self {
        let hypot = |one: f64, other: f64| elementary::hypot(one, other);
        let of_each = |it: &Self| it.each.or((it.numbers == 0.0).then(Default::default));
        let each = of_each(self).zip(of_each(other));
        Self {
            cam: hypot(self.cam, other.cam),
            numbers: hypot(self.numbers, other.numbers),
            each: each.map(|(one, other)| std::array::from_fn(|index| hypot(one[index], other[index]))),
        }
    }

    /// Combines the parts of a cam with the parts of the follower's numbers.
    pub(crate) fn joined(of_cam: Vec<f64>, of_numbers: Vec<Self>) -> Vec<Self> {
        of_cam.into_iter().zip(of_numbers).map(|(cam, part)| Self { cam, ..part }).collect()
    }

    /// Total uncertainty.
    pub fn total(&self) -> f64 {
        elementary::hypot(self.cam, self.numbers)
    }

    /// Uncertainty of `factor` times the result.
    pub fn times(&self, factor: f64) -> Self {
        let factor = factor.abs();
        let each = self.each.map(|each| each.map(|part| factor * part));
        Self { cam: factor * self.cam, numbers: factor * self.numbers, each }
    }

    /// Ends of the uncertainty range around a value.
    pub fn around(&self, value: f64) -> [f64; 2] {
        [value - self.total(), value + self.total()]
    }

    /// Returns the uncertainty with all its parts scaled down if the total is above `most`.
    pub(crate) fn at_most(&self, most: f64) -> Self {
        let total = self.total();
        if total > most { self.times(most / total) } else { *self }
    }

    /// Numbers with a separate part, each with that part, the largest first.
    pub fn of_each(&self) -> Vec<(&'static str, f64)> {
        let each = FollowerErrors::names().zip(self.each.unwrap_or_default());
        let mut each: Vec<_> = each.filter(|(_, part)| *part > 0.0).collect();
        each.sort_by(|(_, one), (_, other)| other.total_cmp(one));
        each
    }

    /// Interpolates linearly between this uncertainty and another; `part` is 0 here and 1 there.
    pub(crate) fn towards(&self, other: &Self, part: f64) -> Self {
        let between = |one: f64, other: f64| one + (other - one) * part;
        let each = self.each.zip(other.each);
        Self {
            cam: between(self.cam, other.cam),
            numbers: between(self.numbers, other.numbers),
            each: each.map(|(one, other)| std::array::from_fn(|index| between(one[index], other[index]))),
        }
    }
}

/// Parts of an uncertainty in a document: the names of the sources, each with the unit of its number, such as `_rpm`.
pub struct UncertaintyParts(pub SourcedUncertainty, pub &'static str);

impl Serialize for UncertaintyParts {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Self(error, unit) = self;
        let mut parts = to.serialize_map(None)?;
        parts.serialize_entry(&format!("cam{unit}"), &error.cam)?;
        parts.serialize_entry(&format!("numbers{unit}"), &error.numbers)?;
        for (name, part) in error.of_each() {
            parts.serialize_entry(&format!("{name}{unit}"), &part)?;
        }
        parts.end()
    }
}

/// Machine of a model, and other machines that its cam's rows and its numbers' errors allow.
#[derive(Clone, Debug)]
pub struct PlausibleMachines<'a> {
    /// Accuracy of the cam and equally likely cams, if it is measured.
    pub cams: Option<PlausibleCams>,
    /// Model.
    pub model: &'a Model,
    /// Cam of the model.
    pub cam: &'a Cam,
    errors: FollowerErrors,
    lowest: f64,
}

impl<'a> PlausibleMachines<'a> {
    /// Collects the uncertain quantities of a model with this cam.
    pub fn of(model: &'a Model, cam: &'a Cam) -> Result<Self, ModelError> {
        Ok(Self { cams: PlausibleCams::of(model)?, ..Self::of_numbers(model, cam, model.errors) })
    }

    /// Collects the uncertain quantities of a model from the same file with another number at `path`, and its cam. That number is exact.
    /// The likely cams are unchanged if it is a number of the follower.
    pub fn elsewhere<'b>(
        &self,
        path: &str,
        model: &'b Model,
        cam: &'b Cam,
    ) -> Result<PlausibleMachines<'b>, ModelError> {
        let cams = match &self.cams {
            Some(cams) if path.starts_with("follower.") => Some(cams.under(model)),
            Some(_) => PlausibleCams::of(model)?,
            None => None,
        };
        Ok(PlausibleMachines { cams, ..PlausibleMachines::of_numbers(model, cam, model.errors) })
    }

    /// Returns machines that differ only in the follower's numbers, except the one at `path`.
    pub(crate) fn without(&self, path: &str) -> Self {
        Self { cams: None, errors: self.errors.without(path), ..*self }
    }

    /// Collects machines that differ only in the follower's numbers, by these errors.
    pub fn of_numbers(model: &'a Model, cam: &'a Cam, errors: FollowerErrors) -> Self {
        let lowest = if errors.are_none() { f64::NAN } else { cam.lowest().value };
        Self { cams: None, model, cam, errors, lowest }
    }

    /// Returns the machines if anything is uncertain.
    pub fn uncertain(&self) -> Option<&Self> {
        let is_noisy = self.cams.as_ref().is_some_and(|cams| cams.best.is_some());
        (is_noisy || !self.errors.are_none()).then_some(self)
    }

    /// Standard deviations of the follower's numbers.
    pub fn deviations(&self) -> FollowerErrors {
        self.errors
    }

    /// Accuracy of the cam, if it is measured.
    pub fn measured(self) -> Option<Measured> {
        self.cams.map(|cams| cams.measured)
    }

    /// Returns the uncertainties of numbers that depend on the machine. `of` returns the numbers of another machine, or `None`. The result
    /// is `None` if this happens for more than a few machines.
    pub fn error<const N: usize>(
        &self,
        numbers: [f64; N],
        of: impl Fn(&Model, &Cam) -> Option<[f64; N]> + Sync,
    ) -> Option<[SourcedUncertainty; N]> {
        self.errors(&numbers, |model, cam| of(model, cam).map(Vec::from))?.try_into().ok()
    }

    /// Returns the uncertainties of any number of quantities, as [`Self::error`] does.
    pub fn errors(
        &self,
        numbers: &[f64],
        of: impl Fn(&Model, &Cam) -> Option<Vec<f64>> + Sync,
    ) -> Option<Vec<SourcedUncertainty>> {
        let of_cam = self.errors_of_cam(numbers, &of)?;
        Some(SourcedUncertainty::joined(of_cam, self.errors_of_numbers(numbers, of)?))
    }

    /// Returns the uncertainties that a measured cam causes.
    pub fn errors_of_cam(
        &self,
        numbers: &[f64],
        of: impl Fn(&Model, &Cam) -> Option<Vec<f64>> + Sync,
    ) -> Option<Vec<f64>> {
        self.cams.as_ref().map_or_else(|| Some(vec![0.0; numbers.len()]), |cams| cams.errors(numbers, of))
    }

    /// Returns the uncertainties that the errors of the follower's numbers cause, on the model's own cam.
    pub fn errors_of_numbers(
        &self,
        numbers: &[f64],
        of: impl Fn(&Model, &Cam) -> Option<Vec<f64>> + Sync,
    ) -> Option<Vec<SourcedUncertainty>> {
        if self.errors.are_none() {
            return Some(vec![SourcedUncertainty::default(); numbers.len()]);
        }
        let at = |moves: &Moves| of(&self.machine(moves), self.cam);
        let steps: Vec<Step> = (0..FollowerErrors::COUNT).filter_map(|index| self.step(index)).collect();
        let sides = steps.par_iter().map(|step| Some([at(&step.moves(0))?, at(&step.moves(1))?]));
        let sides: Option<Vec<[Vec<f64>; 2]>> = sides.collect();
        let linear = |index: usize| linear(numbers[index], index, &steps, sides.as_ref()?);
        let parts: Vec<Option<SourcedUncertainty>> = (0..numbers.len()).map(linear).collect();
        if parts.iter().all(Option::is_some) {
            return parts.into_iter().collect();
        }
        let draws = draws();
        let all: Vec<Vec<f64>> = draws.par_iter().filter_map(at).collect();
        let is_enough = all.len() + draws.len() / PlausibleCams::WITHOUT >= draws.len();
        let spread = |(index, part): (usize, Option<SourcedUncertainty>)| {
            part.unwrap_or_else(|| {
                let numbers = root_mean_square(all.iter().map(|one| one[index] - numbers[index]));
                SourcedUncertainty { numbers: DEVIATIONS * numbers, ..SourcedUncertainty::default() }
            })
        };
        is_enough.then(|| parts.into_iter().enumerate().map(spread).collect())
    }

    /// Returns the uncertainty of a number found by slow runs, from a few machines. Each of the follower's numbers is one error larger or
    /// smaller, in combinations that keep the parts apart.
    pub fn error_by_runs(
        &self,
        number: f64,
        of: impl Fn(&Model, &Cam) -> Option<f64> + Sync,
    ) -> Option<SourcedUncertainty> {
        let cam = match &self.cams {
            Some(cams) => cams.error_by_runs(number, &of)?,
            None => 0.0,
        };
        let uncertain: Vec<usize> = self.uncertain_numbers().collect();
        if uncertain.is_empty() {
            return Some(SourcedUncertainty { cam, ..SourcedUncertainty::default() });
        }
        // One column of signs per number, orthogonal to each other: Sylvester's Hadamard matrix without its first column.
        let runs = (uncertain.len() + 1).next_power_of_two();
        let sign =
            |run: usize, column: usize| if (run & (column + 1)).count_ones().is_multiple_of(2) { 1.0 } else { -1.0 };
        let moves = |run: usize| {
            let mut moves = Moves::default();
            uncertain.iter().enumerate().for_each(|(column, index)| moves[*index] = sign(run, column));
            moves
        };
        let moved = (0..runs).into_par_iter().map(|run| of(&self.machine(&moves(run)), self.cam));
        let apart: Vec<f64> = moved.map(|found| Some(found? - number)).collect::<Option<_>>()?;
        let mut each = [0.0; FollowerErrors::COUNT];
        for (column, index) in uncertain.iter().enumerate() {
            let sum: f64 = apart.iter().enumerate().map(|(run, apart)| sign(run, column) * apart).sum();
            each[*index] = DEVIATIONS * (sum / runs as f64).abs();
        }
        let numbers = DEVIATIONS * root_mean_square(apart.into_iter());
        Some(SourcedUncertainty { cam, numbers, each: Some(each) })
    }

    /// Returns the results of `of` on each equally likely cam, and for each machine drawn from the errors of the follower's numbers.
    /// Machines without a result are left out.
    pub fn each<T: Send>(&self, of: impl Fn(&Model, &Cam) -> Option<T> + Sync) -> Vec<T> {
        let cams = self.cams.iter().flat_map(|cams| &cams.others).collect::<Vec<_>>();
        let mut found: Vec<T> = cams.par_iter().filter_map(|(model, cam)| of(model, cam)).collect();
        found.extend(self.drawn(of));
        found
    }

    /// Returns the results of `of` for each machine drawn from the errors of the follower's numbers, on the model's own cam.
    pub fn drawn<T: Send>(&self, of: impl Fn(&Model, &Cam) -> Option<T> + Sync) -> Vec<T> {
        let draws = if self.errors.are_none() { Vec::new() } else { draws() };
        draws.par_iter().filter_map(|moves| of(&self.machine(moves), self.cam)).collect()
    }

    fn uncertain_numbers(&self) -> impl Iterator<Item = usize> {
        self.errors.all().into_iter().enumerate().filter(|(_, error)| *error > 0.0).map(|(index, _)| index)
    }

    /// Model with its numbers moved.
    fn machine(&self, moves: &Moves) -> Model {
        self.model.moved(self.lowest, moves)
    }

    /// Steps of a number by one error down and up; `None` for an exact number. A number at the end of its range moves to one side only.
    fn step(&self, index: usize) -> Option<Step> {
        let error = Some(self.errors.all()[index]).filter(|error| *error > 0.0)?;
        let name = FollowerErrors::names().nth(index)?;
        let value = self.model.of_follower(name)?;
        let to = |by: f64| (FollowerErrors::moved(name, value, by * error) - value) / error;
        Some(Step { index, to: [to(-1.0), to(1.0)] })
    }
}

/// Step of one number down and up.
struct Step {
    index: usize,
    /// Multiples of the standard deviation: the first is 0 or negative, the second 0 or positive.
    to: [f64; 2],
}

impl Step {
    fn moves(&self, side: usize) -> Moves {
        let mut moves = Moves::default();
        moves[self.index] = self.to[side];
        moves
    }
}

/// Returns the uncertainty of the number at `index` of each machine's numbers, by differences. `None` if the result is curved: the slopes
/// on the two sides differ by more than a certain part of all slopes together.
fn linear(number: f64, index: usize, steps: &[Step], sides: &[[Vec<f64>; 2]]) -> Option<SourcedUncertainty> {
    let rounding = tolerance::JET_ROUNDING.value * number.abs();
    let slope = |(step, [low, high]): (&Step, &[Vec<f64>; 2])| {
        let apart = high[index] - low[index];
        if apart.abs() <= rounding { 0.0 } else { apart / (step.to[1] - step.to[0]) }
    };
    let slopes: Vec<f64> = steps.iter().zip(sides).map(slope).collect();
    let all = slopes.iter().map(|slope| slope * slope).sum::<f64>().sqrt();
    let is_straight = |(step, sides): (&Step, &[Vec<f64>; 2])| {
        let [low, high] = [0, 1].map(|side| (sides[side][index] - number) / step.to[side]);
        let is_one_sided = step.to.contains(&0.0);
        is_one_sided
            || (high - low).abs()
                <= (tolerance::CURVED.value * all).max(tolerance::UNCERTAINTY_SEEN.value * number.abs())
    };
    if !steps.iter().zip(sides).all(is_straight) {
        return None;
    }
    let mut each = [0.0; FollowerErrors::COUNT];
    steps.iter().zip(slopes).for_each(|(step, slope)| each[step.index] = DEVIATIONS * slope.abs());
    Some(SourcedUncertainty { cam: 0.0, numbers: DEVIATIONS * all, each: Some(each) })
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0_u32, 0.0), |(count, sum), value| (count + 1, sum + value * value));
    (sum / f64::from(count)).sqrt()
}

/// Moves of an ensemble of machines: pairs of opposite normal draws. They are made uncorrelated, with a mean square of 1 for each number. A
/// linear result then gets the spread of the limit of many draws.
fn draws() -> Vec<Moves> {
    /// Number of pairs, one more than numbers.
    const PAIRS: usize = FollowerErrors::COUNT + 1;
    let uniform = |number: usize, pair: usize| 0.5 + 0.5 * even(number as u64, pair as u64);
    // Box and Muller (1958).
    let normal = |number: usize, pair: usize| {
        let [length, angle] = [uniform(number, pair), uniform(number, PAIRS + pair)];
        (-2.0 * elementary::ln(1.0 - length)).sqrt() * elementary::cos(std::f64::consts::TAU * angle)
    };
    let mut columns: Vec<[f64; PAIRS]> = Vec::new();
    for number in 0..FollowerErrors::COUNT {
        let mut column: [f64; PAIRS] = std::array::from_fn(|pair| normal(number, pair));
        let product = |one: &[f64; PAIRS], other: &[f64; PAIRS]| {
            one.iter().zip(other).map(|(one, other)| one * other).sum::<f64>() / PAIRS as f64
        };
        for before in &columns {
            let along = product(before, &column);
            column.iter_mut().zip(before).for_each(|(one, before)| *one -= along * before);
        }
        let size = product(&column, &column).sqrt();
        columns.push(column.map(|one| one / size));
    }
    let draw = |pair: usize, sign: f64| std::array::from_fn(|number| sign * columns[number][pair]);
    (0..PAIRS).flat_map(|pair| [draw(pair, 1.0), draw(pair, -1.0)]).collect()
}
