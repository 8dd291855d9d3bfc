//! Builds a complete model from its fields, including those of the follower that depend on the cam.

use std::f64::consts::TAU;
use std::path::Path;

use crate::cam::Cam;
use crate::file;
use crate::model::{Follower, FollowerErrors, Model, ModelError, Moves, Numeral, OSORIO_2008};
use crate::tolerance;

impl Model {
    /// Reads and checks a model file.
    pub fn read(path: &Path) -> Result<Self, ModelError> {
        let file = path.display().to_string();
        let text = file::text(path).map_err(|error| ModelError::file(&file, format!("cannot be read: {error}")))?;
        Self::parse(&file, &text)
    }

    /// Returns the paper's model, which needs no file.
    pub fn built_in() -> Result<Self, ModelError> {
        Self::parse(Self::BUILT_IN, OSORIO_2008)
    }

    /// Checks the text of a model file; `file` is its name in error messages.
    pub fn parse(file: &str, text: &str) -> Result<Self, ModelError> {
        Self::written(file, text)?.sprung()
    }

    /// Checks the text of a model file that needs no other file; `file` is its name in error messages. A text that names a table is
    /// rejected.
    pub fn parse_alone(file: &str, text: &str) -> Result<Self, ModelError> {
        Self::written_alone(file, text)?.sprung()
    }

    /// Checks a document with the fields of a model file; `name` is its name in error messages.
    pub fn of_document(name: &str, document: &serde_json::Value) -> Result<Self, ModelError> {
        Self::written_as(name, document)?.sprung()
    }

    /// Returns the model with another number in `field`, a dotted path, checked like a file. Numbers moved by their errors stay moved,
    /// except this one.
    pub fn with_number(&self, field: &str, number: f64) -> Result<Self, ModelError> {
        self.rewritten(field, number)?.shifted(&self.moves).sprung()
    }

    /// Returns the model with other numbers, also of `[study]`, each named as for [`Self::path_of`]. They are checked together like a file,
    /// and become part of the model's name.
    pub fn changed<N: Clone + Into<Numeral>>(&self, numbers: &[(String, N)]) -> Result<Self, ModelError> {
        let numbers: Vec<_> = numbers.iter().map(|(name, number)| (name.clone(), number.clone().into())).collect();
        self.renamed(&numbers)?.sprung()
    }

    /// Returns the model with a smoothing spline near other lifts, m, at the angles of its table. The spline has a weight given by its
    /// logarithm, corners at or near these angles, and these dwells, degrees.
    pub(crate) fn with_lifts(
        &self,
        lifts: &[f64],
        corners: (&[f64], bool),
        dwells: &[[f64; 2]],
        weight: f64,
    ) -> Result<Self, ModelError> {
        self.relifted(lifts, corners, dwells, weight)?.sprung()
    }

    /// Whether follower and cam are the paper's, under any name of the model.
    pub fn is_the_papers(&self) -> Result<bool, ModelError> {
        let paper = Self::built_in()?;
        Ok(self.follower == paper.follower && self.cam == paper.cam && self.units.length == paper.units.length)
    }

    /// Returns a doubt about numbers, in the units that are stated or assumed, at the given speeds, rpm, or those of `[study]`. The doubt
    /// is a question for the user, not an error. Only sizes that no working machine has are questioned.
    pub fn doubt(&self, rpm: Option<[f64; 2]>) -> Result<Option<String>, ModelError> {
        /// Largest plausible rise of a cam, m.
        const LARGEST_RISE: f64 = 5.0;
        /// Largest spring force, in weights of the follower.
        const MOST_WEIGHTS: f64 = 2000.0;
        /// Largest ratio of the cam's speed to the frequency of follower and spring, and of a spring's compression to the rise.
        const MOST_TIMES: f64 = 15.0;
        const MOST_RISES: f64 = 100.0;
        /// Gravity, m/s^2, for weights, also if the model has none; and the largest gravity of a machine.
        const GRAVITY: f64 = 9.81;
        const MOST_GRAVITY: f64 = 1000.0;
        /// Factor between N/m and N/mm.
        const THOUSAND: f64 = 1000.0;
        let units = &self.units;
        let [says_length, says_mass, says_stiffness] = units.says;
        let cam = Cam::new(self)?;
        let Follower { mass, stiffness, rest_position, gravity, .. } = self.follower;
        let lowest = cam.lowest().value;
        let (rise, compressed) = (cam.top() - lowest, lowest - rest_position);
        let [risen, pulled] = [rise, gravity].map(|length| units.length.inside(length));
        let (length, shown) = (units.length.name(), |length: f64| (length * 1e4).round() / 1e4);
        let weights = stiffness * compressed / (mass * units.length.told(GRAVITY));
        let own = (stiffness / mass).sqrt() / TAU * 60.0;
        let slowest = rpm.or(self.study.map(|study| [study.rpm_min, study.rpm_max])).map(|[low, _]| low);
        let too_soft = |speed: f64| speed > MOST_TIMES * own && speed < MOST_TIMES * THOUSAND.sqrt() * own;
        let is_compressed = stiffness > 0.0 && rise > 0.0 && compressed > MOST_RISES * rise;
        let is_soft = is_compressed || stiffness > 0.0 && slowest.is_some_and(too_soft);
        let written = units.mass.told(mass);
        let meant = if risen > LARGEST_RISE {
            let meant = if says_length { "is it in the unit that is said?" } else { "did you mean mm?" };
            format!("the lift rises by {} {length}: {meant}", shown(rise))
        } else if pulled.abs() > MOST_GRAVITY {
            format!("gravity of {pulled} m/s^2: did you mean mm/s^2?")
        } else if !says_stiffness && is_soft {
            format!("stiffness {stiffness} with mass {written}: did you mean N/mm?")
        } else if is_compressed {
            let (times, unit) = (compressed / rise, units.stiffness.name());
            format!(
                "the spring is pressed together by {} {length}, {times:.0} times as far as the lift rises: is its stiffness in {unit}?",
                shown(compressed)
            )
        } else if !says_mass && weights > MOST_WEIGHTS && weights.is_finite() {
            let (force, unit) = (units.force.told(stiffness * compressed), units.force.name());
            format!(
                "the spring presses with {force:.0} {unit}, {weights:.0} times the weight of mass {written}: is it in kg?"
            )
        } else {
            return Ok(None);
        };
        Ok(Some(format!("{meant} [units] sets the units of the numbers")))
    }

    /// Moves the follower's numbers by multiples of their standard deviations. The cam is unchanged, and `lowest` is its lowest lift.
    pub(crate) fn moved(&self, lowest: f64, by: &Moves) -> Self {
        let mut model = self.clone().shifted(by);
        model.rest(lowest);
        model
    }

    /// Moves the follower's numbers without the rest position that follows from a preload.
    fn shifted(mut self, by: &Moves) -> Self {
        for ((name, error), by) in FollowerErrors::names().zip(self.errors.all()).zip(by) {
            if let Some(number) = self.of_follower_mut(name).filter(|_| error > 0.0 && *by != 0.0) {
                *number = FollowerErrors::moved(name, *number, by * error);
            }
        }
        self.moves = *by;
        self
    }

    /// Puts this model's follower, with its spring, on the cam of another model.
    pub(crate) fn on_cam_of(&self, other: &Self, cam: &Cam) -> Self {
        let mut model = other.clone();
        (model.follower, model.preload, model.study) = (self.follower, self.preload, self.study);
        (model.errors, model.moves) = (self.errors, self.moves);
        model.rest(cam.lowest().value);
        model
    }

    /// Returns the model with a spring that presses on the lowest lift with a force, in internal units.
    pub(crate) fn preloaded(&self, lowest: f64, preload: f64) -> Self {
        let mut model = self.clone();
        model.preload = Some(preload);
        model.errors = model.errors.without("follower.preload").without("follower.rest_position");
        model.rest(lowest);
        model
    }

    /// Sets the rest position of the spring from the preload and the lowest lift: `k (c_min - rest_position) = preload`.
    fn rest(&mut self, lowest: f64) {
        if let Some(preload) = self.preload {
            self.follower.rest_position = lowest - preload / self.follower.stiffness;
        }
    }

    /// Sets the rest position of the spring from the preload on the model's own cam.
    fn sprung(mut self) -> Result<Self, ModelError> {
        if self.preload.is_some() {
            let lowest = Cam::new(&self)?.lowest().value;
            self.rest(lowest);
            if !self.follower.rest_position.is_finite() {
                return Err(self.reject("follower.preload", "is too large for this stiffness"));
            }
        }
        self.sized()?;
        Ok(self)
    }

    /// Rejects numbers from which the computed quantities would leave the range of a double.
    fn sized(&self) -> Result<(), ModelError> {
        let (most, least) = (tolerance::LEAST_SIZE.value.recip(), tolerance::LEAST_SIZE.value);
        let Follower { mass, damping, stiffness, gravity, rest_position, restitution: _ } = self.follower;
        let products = [
            ("follower.mass", "mass", mass),
            ("follower.damping", "damping / mass", damping / mass),
            ("follower.stiffness", "stiffness / mass", stiffness / mass),
        ];
        let sums = [
            ("follower.gravity", "gravity", gravity),
            ("follower.rest_position", "rest_position", rest_position),
            ("follower.rest_position", "stiffness * rest_position / mass", stiffness / mass * rest_position),
        ];
        let is_small = |size: f64| size > 0.0 && size < least;
        let odd = products.iter().find(|(.., size)| is_small(*size) || !(*size <= most));
        match odd.or_else(|| sums.iter().find(|(.., size)| !(size.abs() <= most))) {
            Some((field, what, size)) => {
                let bound =
                    if is_small(*size) { format!("below {least:.0e}") } else { format!("above {most:.0e} in size") };
                let words = format!("makes {what} {size:e}, {bound}: use other units");
                Err(self.reject(field, words))
            }
            None => Ok(()),
        }
    }
}
