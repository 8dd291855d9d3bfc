//! A value's name is the one that documents have for it: what it serializes as.

/// Writes values of each type by their names in documents.
macro_rules! named {
    ($($kind:ty),+) => {$(
        impl std::fmt::Display for $kind {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                serde::Serialize::serialize(self, f)
            }
        }
    )+};
}
