//! Sources of the ± on a page: the measured cam, and the errors of the follower's numbers.

use corner_impact::measured::Measured;
use corner_impact::model::FollowerErrors;
use corner_impact::uncertainty::SourcedUncertainty;

use super::block::{Words, words};
use super::digits::{Digits, at_most, part_of_error, with_error};
use super::words::{accuracy, listed, spoken};

/// Sources of the uncertainty on a page.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sources<'a> {
    /// Accuracy of the cam, if its rows have noise.
    pub cam: Option<&'a Measured>,
    /// Standard deviations of the follower's numbers.
    pub errors: FollowerErrors,
}

impl<'a> Sources<'a> {
    pub(crate) fn of(measured: &'a Option<Measured>, errors: FollowerErrors) -> Self {
        Self { cam: Measured::noisy(measured), errors }
    }

    /// Returns the sources, if any.
    pub(crate) fn if_any(self) -> Option<Self> {
        (self.cam.is_some() || !self.errors.are_none()).then_some(self)
    }

    /// Name of the sources: the cam, the numbers, or both.
    pub(crate) fn name(self) -> &'static str {
        match (self.cam, self.errors.are_none()) {
            (Some(_), true) => "the cam",
            (Some(_), false) => "the cam and the numbers",
            (None, _) => "the numbers",
        }
    }

    /// Name of machines that the sources allow.
    pub(crate) fn machines(self) -> &'static str {
        if self.errors.are_none() { "cams" } else { "machines" }
    }

    /// Parts of an uncertainty: `13 from the cam (lift rounded to 0.001 mm), 45 from the numbers (stiffness 40, mass 20)`. For a cam alone
    /// it gives only the cam's accuracy.
    pub(crate) fn parts(self, error: &SourcedUncertainty) -> String {
        /// Least part of the whole that is listed.
        const LEAST: f64 = 0.005;
        let each = error.of_each().into_iter().filter(|(_, part)| *part >= LEAST * error.total());
        let each: Vec<String> = each.map(|(name, part)| format!("{} {}", spoken(name), part_of_error(part))).collect();
        let each = match (each.as_slice(), error.each) {
            ([], None) => " (together)".to_owned(),
            ([], Some(_)) => String::new(),
            (each, _) => format!(" ({})", each.join(", ")),
        };
        match (self.cam, self.errors.are_none()) {
            (Some(cam), true) => accuracy(cam),
            (Some(cam), false) => format!(
                "{} from the cam ({}), {} from the numbers{each}",
                part_of_error(error.cam),
                accuracy(cam),
                part_of_error(error.numbers)
            ),
            (None, _) => format!("from the numbers{each}"),
        }
    }

    /// Reason for an uncertainty whose size is unknown.
    pub(crate) fn why(self) -> String {
        let numbers = self.numbers();
        match (self.cam, self.errors.are_none()) {
            (Some(cam), true) => accuracy(cam),
            (Some(cam), false) => format!("{}, and errors of {numbers}", accuracy(cam)),
            (None, _) => format!("errors of {numbers}"),
        }
    }

    /// Returns a note on the sources that ± includes, and on those that are taken as exact.
    pub(crate) fn note(self) -> String {
        /// Number of the follower's quantities: the spring has either a preload or a rest position.
        const NUMBERS: usize = FollowerErrors::COUNT - 1;
        let others = match (self.cam, self.errors.uncertain().count()) {
            (Some(_), NUMBERS) => "",
            (Some(_), _) => " The follower's other numbers are taken as exact.",
            (None, NUMBERS) => " The cam is taken as exact.",
            (None, _) => " The cam and the follower's other numbers are taken as exact.",
        };
        let numbers = self.numbers();
        match (self.cam, self.errors.are_none()) {
            (Some(_), true) => "± is from the cam alone: the model gives no error of the follower's numbers.".into(),
            (Some(_), false) => format!(
                "± is the root of the sum of two squares: the part from the cam, and two standard deviations from the errors of {numbers}.{others}"
            ),
            (None, _) => format!("± is two standard deviations, from the errors of {numbers}.{others}"),
        }
    }

    /// Uncertain numbers of the follower.
    fn numbers(self) -> String {
        listed(&self.errors.uncertain().map(|(name, _)| spoken(name)).collect::<Vec<_>>())
    }

    /// Speed with its uncertainty and the sources of it.
    pub(crate) fn speed(self, rpm: f64, digits: Digits, error: Option<SourcedUncertainty>) -> Words {
        match error.filter(|error| error.total().is_finite() && error.total() >= rpm) {
            // A ± that reaches 0 is no longer symmetric.
            Some(error) => {
                let (from, bound) = (format!(" rpm{}", self.from(&error)), at_most(rpm + error.total()));
                words![(rpm, with_error(error.total()).0), ", ", bound, from]
            }
            None => self.value((rpm, digits), " rpm", error),
        }
    }

    /// Parts of an uncertainty, written after it.
    fn from(self, error: &SourcedUncertainty) -> String {
        let parts = self.parts(error);
        match (self.cam, self.errors.are_none()) {
            (Some(_), true) => format!(" (± from the cam: {parts})"),
            (Some(_), false) => format!(": {parts}"),
            (None, _) => format!(", {parts}"),
        }
    }

    /// Value in a unit, with a space before it, with its uncertainty and the sources of it.
    pub(crate) fn value(self, (value, digits): (f64, Digits), unit: &str, error: Option<SourcedUncertainty>) -> Words {
        match (error.filter(|error| error.total().is_finite()), self.if_any()) {
            (Some(error), Some(sources)) => {
                let (digits, total) = with_error(error.total());
                words![(value, digits), " ± ", (total, digits), format!("{unit}{}", sources.from(&error))]
            }
            (None, Some(sources)) => {
                words![(value, digits), format!("{unit}, with an unknown uncertainty: {}", sources.why())]
            }
            _ => words![(value, digits), unit],
        }
    }
}
