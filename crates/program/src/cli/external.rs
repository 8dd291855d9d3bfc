//! Options for the routes in Python.

use corner_impact::study::verify::External;

/// Routes in Python (symbolic, scipy, certificate): they run unless this says otherwise, and the result says which were left out.
#[derive(clap::Args)]
pub(super) struct ExternalArguments {
    /// Run the routes that need Python; this is the default.
    #[arg(long, overrides_with = "no_external")]
    external: bool,
    /// Leave out the routes that need Python (symbolic, scipy, certificate). The result lists them as left out.
    #[arg(long)]
    no_external: bool,
}

impl ExternalArguments {
    pub(super) fn routes(&self) -> External {
        if self.no_external && !self.external { External::LeftOut } else { External::Run }
    }
}
