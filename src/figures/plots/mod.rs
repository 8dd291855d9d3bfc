//! The figures that this program draws, each built from plain data; nothing is simulated here.

mod basins;
mod branches;
mod cam;
mod composition;
mod curve;
mod diagram;
mod local_map;
mod outline;
mod trace;

pub use basins::{BasinsPicture, basins_figure};
pub use branches::{Branches, branches_figure};
pub use cam::{CornerMark, cam_figure, corner_marks};
pub use composition::{composition_figure, discontinuity_mapping_figure};
pub use curve::curve_figure;
pub use diagram::{Diagram, attractor, impact_diagram, section_diagram, shown_impacts, strobe_diagram};
pub use local_map::local_map_figure;
pub use outline::outline_figure;
pub use trace::{Against, ImpactPoint, Trace, TracePoint, phase_plane, time_trace};

use crate::draw::{Axis, Colour, Data, Mark, Panel, Series, Stroke};

/// A line without a name.
fn plain(points: Vec<[f64; 2]>, colour: Colour, stroke: Stroke) -> Series {
    Series { label: String::new(), colour, data: Data::Line { points, stroke } }
}

/// A panel of one or more series with marks.
fn panel(y: Axis, height: f64, series: Vec<Series>, marks: Vec<Mark>) -> Panel {
    Panel { y, height, series, marks }
}

/// The plain line of zero.
fn zero() -> Mark {
    Mark { at: 0.0, label: String::new() }
}
