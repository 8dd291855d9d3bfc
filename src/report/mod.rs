//! One document value, several renderers. No renderer computes anything but how many digits to show.

pub mod cam;
pub mod claims;
pub mod document;
pub mod json;
pub mod text;

pub use cam::CamDocument;
pub use claims::ClaimsDocument;
pub use document::Verification;
