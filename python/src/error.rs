//! Conversion of Rust errors to Python exceptions.

use std::error::Error;

use corner_impact::model::ModelError;
use corner_impact::untrusted::sentence;
use pyo3::exceptions::{PyImportError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

/// Builds a `ModelError`, with its place, if an error in a model is the cause; else a `ValueError`.
pub(crate) fn raised(error: &(dyn Error + 'static)) -> PyErr {
    // Options of the command are arguments here.
    let words = sentence(&error.to_string()).replace("--rpm R", "rpm").replace("--rpm", "rpm");
    let causes = std::iter::successors(Some(error), |error| (*error).source());
    match causes.filter_map(|error| error.downcast_ref::<ModelError>()).next() {
        Some(at) => Python::attach(|py| about_model(py, &words, at)).unwrap_or_else(|error| error),
        // Message of a Python script about its packages.
        None if ["ModuleNotFoundError", "python-flint is missing"].iter().any(|sign| words.contains(sign)) => {
            PyImportError::new_err(words)
        }
        None => PyValueError::new_err(words),
    }
}

/// Builds a `ModelError` with this message, about a place.
pub(crate) fn about_model(py: Python<'_>, words: &str, at: &ModelError) -> PyResult<PyErr> {
    // Python's own class: a class that extends another Python class cannot be made here for all Python versions at once.
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let class = CLASS.import(py, "corner_impact._errors", "ModelError")?;
    let error = class.call1((words, &*at.file, at.line, &at.field))?;
    Ok(PyErr::from_value(error))
}

/// Conversion of a result to a Python result.
pub(crate) trait OrRaise<T> {
    fn or_raise(self) -> PyResult<T>;
}

impl<T, E: Error + 'static> OrRaise<T> for Result<T, E> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(|error| raised(&error))
    }
}
