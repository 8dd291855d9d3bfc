//! A model whole: what its fields say, and what of the follower needs the cam.

use std::path::Path;

use crate::cam::Cam;
use crate::model::{Model, ModelError, OSORIO_2008};

impl Model {
    /// Reads and checks a model file.
    pub fn read(path: &Path) -> Result<Self, ModelError> {
        let file = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|error| ModelError::file(&file, format!("cannot be read: {error}")))?;
        Self::parse(&file, &text)
    }

    /// The paper's model, which needs no file.
    pub fn built_in() -> Result<Self, ModelError> {
        Self::parse(Self::BUILT_IN, OSORIO_2008)
    }

    /// Checks the text of a model file; `file` is the name that complaints carry.
    pub fn parse(file: &str, text: &str) -> Result<Self, ModelError> {
        Self::written(file, text)?.sprung()
    }

    /// Checks a document with the fields of a model file; `name` is the name that complaints carry.
    pub fn of_document(name: &str, document: &serde_json::Value) -> Result<Self, ModelError> {
        Self::written_as(name, document)?.sprung()
    }

    /// The same model with another number in `field`, a dotted path, checked as the file is.
    pub fn with_number(&self, field: &str, number: f64) -> Result<Self, ModelError> {
        self.rewritten(field, number)?.sprung()
    }

    /// The same model with other numbers, of `[study]` as well, each named as for [`Self::path_of`], checked together as the
    /// file is; they become a part of its name.
    pub fn changed(&self, numbers: &[(String, f64)]) -> Result<Self, ModelError> {
        self.renamed(numbers)?.sprung()
    }

    /// Whether follower and cam are the paper's, whatever the model is called.
    pub fn is_the_papers(&self) -> Result<bool, ModelError> {
        let paper = Self::built_in()?;
        Ok(self.follower == paper.follower && self.cam == paper.cam && self.units.length == paper.units.length)
    }

    /// The model with the spring slack where its preload says: `k (c_min - rest_position) = preload`.
    fn sprung(mut self) -> Result<Self, ModelError> {
        if let Some(preload) = self.preload {
            let lowest = Cam::new(&self)?.lowest().value;
            self.follower.rest_position = lowest - preload / self.follower.stiffness;
            if !self.follower.rest_position.is_finite() {
                return Err(self.reject("follower.preload", "is too large for this stiffness"));
            }
        }
        Ok(self)
    }
}
