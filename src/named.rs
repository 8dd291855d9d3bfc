//! How values stand in documents, and that a value is named elsewhere as it is there.

#[doc(hidden)]
#[macro_export]
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

#[doc(hidden)]
#[macro_export]
/// Writes values of a type into documents where an entry is computed: each entry's name, and its value as a formula of the value. An entry
/// that has `if_any` behind its name is left out where there is none. A type whose entries are its fields derives `Serialize`.
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
