//! corner-impact
pub mod tolerance;
pub mod model;
pub mod cam;
pub mod flight;
pub mod impact;
pub mod simulate;
pub mod section;
pub mod corner;
