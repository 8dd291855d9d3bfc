//! Native half of the Python package, which only converts values and computes nothing.

mod arrays;
mod error;
mod grid;
mod local;
mod model;
mod page;
mod studies;
mod values;
mod work;

/// The module `corner_impact._native`.
#[pyo3::pymodule]
mod _native {
    use std::ffi::OsString;

    use corner_impact_cli::cli::{Terminal, run_at};
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::grid::{Grid, blocks_done, chart_variables};
    #[pymodule_export]
    use crate::local::Local;
    #[pymodule_export]
    use crate::model::Model;
    #[pymodule_export]
    use crate::page::Page;

    #[pymodule_export]
    use crate::arrays::events;

    /// Runs the command `corner-impact` with the words of a command line, its name first, and returns the exit code.
    #[pyfunction]
    fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
        py.detach(|| {
            let (mut out, mut err) = (std::io::stdout().lock(), std::io::stderr());
            run_at(Terminal::of_process(), words, &mut out, &mut err) as u8
        })
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        // Scripts run in the interpreter whose packages the user has installed.
        let interpreter: Option<std::path::PathBuf> = module.py().import("sys")?.getattr("executable")?.extract()?;
        if let Some(interpreter) = interpreter.filter(|path| !path.as_os_str().is_empty()) {
            corner_impact::python::loaded_by(interpreter);
        }
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
