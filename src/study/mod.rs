//! One module per question that a user can ask.

pub mod basins;
pub mod locate;
pub mod speeds;
pub mod verify;
