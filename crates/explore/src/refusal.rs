//! Reasons why a question has no answer.

use corner_impact::model::ModelError;
use serde::Serialize;

/// Reason in the program's words, with the place in the model file if there is one.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PageRefusal {
    /// Sentence with the reason.
    pub sentence: String,
    /// File of the reason.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Line in the file, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// Dotted path of the field.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
}

impl PageRefusal {
    /// Builds a reason without a place.
    pub fn of_words(sentence: impl ToString) -> Self {
        Self { sentence: sentence.to_string(), ..Self::default() }
    }
}

impl From<ModelError> for PageRefusal {
    fn from(error: ModelError) -> Self {
        let sentence = error.to_string();
        Self { sentence, file: Some(error.file.into_string()), line: error.line, field: error.field }
    }
}

impl From<String> for PageRefusal {
    fn from(sentence: String) -> Self {
        Self::of_words(sentence)
    }
}

macro_rules! in_words {
    ($($error:ty),+ $(,)?) => {$(
        impl From<$error> for PageRefusal {
            fn from(error: $error) -> Self {
                Self::of_words(error)
            }
        }
    )+};
}

in_words!(
    corner_impact::corner::LocateError,
    corner_impact::orbit::FamilyError,
    corner_impact::simulate::SimulateError,
    corner_impact::study::StudyError,
    corner_impact::study::attractors::AttractorsError,
    corner_impact::study::basins::GridError,
    corner_impact::study::survey::OverError,
    corner_impact::study::survey::SurveyError,
    corner_impact::study::survey::SweepError,
);
