//! Macros that define how values are named and written in documents.

#[doc(hidden)]
#[macro_export]
/// Writes the values of each type by their names in documents.
macro_rules! named {
    ($($kind:ty),+) => {$(
        impl std::fmt::Display for $kind {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                serde::Serialize::serialize(self, f)
            }
        }
    )+};
}

#[doc(hidden)]
#[macro_export]
/// Writes values of a type into documents with computed entries: each entry's name, and its formula. An entry with `if_any` after its name
/// is left out if it is `None`. A type whose entries are its fields derives `Serialize` instead.
macro_rules! document {
    (@entry $map:ident $name:ident [] $value:expr) => { $map.serialize_entry(stringify!($name), &$value)? };
    (@entry $map:ident $name:ident [if_any] $value:expr) => {
        if let Some(value) = &$value {
            $map.serialize_entry(stringify!($name), value)?
        }
    };
    ($kind:ty as $it:ident { $($name:ident $($if_any:ident)?: $value:expr),+ $(,)? }) => {
        impl serde::Serialize for $kind {
            fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                use serde::ser::SerializeMap;
                let $it = self;
                let mut map = to.serialize_map(None)?;
                $($crate::document!(@entry map $name [$($if_any)?] $value);)+
                map.end()
            }
        }
    };
}
