//! JSON documents in the units of a model.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::ser::{CharEscape, CompactFormatter, Formatter, PrettyFormatter, Serializer};

use crate::model::{Converted, Units};
use crate::untrusted;

/// Writes one document, indented, with a line end.
pub fn render(document: &impl Serialize, units: &Units) -> Result<String, serde_json::Error> {
    let text = if units.are_given {
        in_units(document, InUnits::new(units, PrettyFormatter::new()))?
    } else {
        serde_json::to_string_pretty(document)?
    };
    Ok(untrusted::json(text + "\n"))
}

/// Writes one document in one line, without a line end.
pub fn compact(document: &impl Serialize, units: &Units) -> Result<String, serde_json::Error> {
    // SI units change nothing: one writer is enough, which halves the size of the live page.
    Ok(untrusted::json(in_units(document, InUnits::new(units, CompactFormatter))?))
}

fn in_units(document: &impl Serialize, layout: impl Formatter) -> Result<String, serde_json::Error> {
    let mut bytes = Vec::new();
    document.serialize(&mut Serializer::with_formatter(&mut bytes, layout))?;
    // serde_json writes nothing but UTF-8.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Formatter of a document with names and numbers in the units of a model.
struct InUnits<'a, F> {
    layout: F,
    units: &'a Units,
    /// Name of the next value, in escaped form.
    name: Option<Vec<u8>>,
    /// Whether that name is still being written.
    is_named: bool,
    /// Conversion of the numbers in each open list; `None` for an object, whose names decide.
    open: Vec<Option<Converted>>,
}

impl<'a, F: Formatter> InUnits<'a, F> {
    fn new(units: &'a Units, layout: F) -> Self {
        Self { layout, units, name: None, is_named: false, open: Vec::new() }
    }

    /// Writes the name before a value, and returns the conversion of the numbers in it.
    fn enter<W: ?Sized + Write>(&mut self, writer: &mut W, is_object: bool) -> io::Result<Option<Converted>> {
        let Some(name) = self.name.take() else { return Ok(self.open.last().copied().flatten()) };
        let name = String::from_utf8_lossy(&name);
        let is_plain = name.bytes().all(|letter| letter.is_ascii_alphanumeric() || letter == b'_');
        let convert = if is_plain { self.units.converted(&name) } else { None };
        // A ball stays in the unit of its proof.
        let is_kept = !is_plain || (convert.is_some() && is_object);
        let told = if is_kept { name.into_owned() } else { self.units.field(&name) };
        write!(writer, "\"{told}\": ")?;
        Ok(convert.filter(|_| !is_object))
    }
}

/// Writes words, which are never converted, and whole numbers, which become decimal where their name is converted.
macro_rules! values {
    ($whole:ident: $($write:ident($kind:ty)),+) => {$(
        fn $write<W: ?Sized + Write>(&mut self, writer: &mut W, value: $kind) -> io::Result<()> {
            // A name may be a number.
            if let (true, Some(name)) = (self.is_named, &mut self.name) {
                return self.layout.$write(name, value);
            }
            let convert = self.enter(writer, false)?;
            values!(@$whole self, writer, convert, value);
            self.layout.$write(writer, value)
        }
    )+};
    (@words $self:ident, $writer:ident, $convert:ident, $value:ident) => { _ = $convert };
    (@whole $self:ident, $writer:ident, $convert:ident, $value:ident) => {
        if let Some(convert) = $convert {
            return $self.layout.write_f64($writer, convert($self.units, $value as f64));
        }
    };
}

impl<F: Formatter> Formatter for InUnits<'_, F> {
    values!(words: write_bool(bool), write_number_str(&str), write_raw_fragment(&str));
    values!(whole: write_i8(i8), write_i16(i16), write_i32(i32), write_i64(i64), write_i128(i128));
    values!(whole: write_u8(u8), write_u16(u16), write_u32(u32), write_u64(u64), write_u128(u128));

    fn write_f64<W: ?Sized + Write>(&mut self, writer: &mut W, value: f64) -> io::Result<()> {
        let convert = self.enter(writer, false)?;
        self.layout.write_f64(writer, convert.map_or(value, |convert| convert(self.units, value)))
    }

    fn write_f32<W: ?Sized + Write>(&mut self, writer: &mut W, value: f32) -> io::Result<()> {
        self.write_f64(writer, value.into())
    }

    fn write_null<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.enter(writer, false)?;
        self.layout.write_null(writer)
    }

    fn begin_string<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        if self.is_named {
            return Ok(());
        }
        self.enter(writer, false)?;
        self.layout.begin_string(writer)
    }

    fn end_string<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        if self.is_named { Ok(()) } else { self.layout.end_string(writer) }
    }

    fn write_string_fragment<W: ?Sized + Write>(&mut self, writer: &mut W, fragment: &str) -> io::Result<()> {
        match (self.is_named, &mut self.name) {
            (true, Some(name)) => self.layout.write_string_fragment(name, fragment),
            _ => self.layout.write_string_fragment(writer, fragment),
        }
    }

    fn write_char_escape<W: ?Sized + Write>(&mut self, writer: &mut W, escape: CharEscape) -> io::Result<()> {
        match (self.is_named, &mut self.name) {
            (true, Some(name)) => self.layout.write_char_escape(name, escape),
            _ => self.layout.write_char_escape(writer, escape),
        }
    }

    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        let convert = self.enter(writer, false)?;
        self.open.push(convert);
        self.layout.begin_array(writer)
    }

    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open.pop();
        self.layout.end_array(writer)
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.layout.begin_array_value(writer, first)
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.layout.end_array_value(writer)
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.enter(writer, true)?;
        self.open.push(None);
        self.layout.begin_object(writer)
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.open.pop();
        self.layout.end_object(writer)
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        (self.name, self.is_named) = (Some(Vec::new()), true);
        self.layout.begin_object_key(writer, first)
    }

    fn end_object_key<W: ?Sized + Write>(&mut self, _: &mut W) -> io::Result<()> {
        self.is_named = false;
        Ok(())
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, _: &mut W) -> io::Result<()> {
        Ok(())
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.layout.end_object_value(writer)
    }
}
