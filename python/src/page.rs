//! Live page of a model in a notebook.

use std::path::PathBuf;

use corner_impact_cli::live;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::model::Model;

/// Live page of a model: HTML that needs no server and no other file. `Model.explore` makes it, and a notebook shows it.
#[pyclass(frozen, module = "corner_impact")]
pub(crate) struct Page {
    /// The whole page as HTML.
    #[pyo3(get)]
    html: String,
}

impl Page {
    pub(crate) fn of(model: &Model) -> PyResult<Self> {
        let html = live::page(&model.model).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(Self { html })
    }
}

#[pymethods]
impl Page {
    /// Writes the page to a file for a browser.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        Ok(std::fs::write(path, &self.html)?)
    }

    /// The page in a frame of its own, for a notebook.
    fn _repr_html_(&self) -> String {
        let html = self.html.replace('&', "&amp;").replace('"', "&quot;");
        format!(
            "<iframe title=\"corner-impact\" style=\"width: 100%; height: 52rem; border: 0\" srcdoc=\"{html}\"></iframe>"
        )
    }

    fn __repr__(&self) -> String {
        format!("<Page of {} bytes>", self.html.len())
    }
}
