//! What the paper prints, held against what comes out here.

pub mod published;
