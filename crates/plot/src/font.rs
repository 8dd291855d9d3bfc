//! Fonts of a figure, and subsets of fonts with only the glyphs that a figure uses.
//!
//! A file that must look the same everywhere embeds its letters. Only the used glyphs of a TrueType font are embedded. Glyph numbers are
//! unchanged, so that the font's tables of letters and widths remain valid.

use std::collections::BTreeMap;
use std::sync::Arc;

use resvg::usvg::fontdb::{Database, Family, ID, Query, Source};
use resvg::usvg::{GlyphId, Group, Node, Options, Tree};

/// Replacement of the raised minus, which the built-in font lacks: one letter from another font would change the font of its whole line.
const RAISED_MINUS: &str = r#"<tspan baseline-shift="35%" font-size="70%">−</tspan>"#;

/// Fonts of figures: one family, and the built-in font for letters that it lacks.
#[derive(Clone, Debug)]
pub struct Fonts {
    database: Arc<Database>,
    family: String,
}

/// Reason why a font is not available.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FontError {
    /// Family that is not installed on this machine.
    #[error("no font \"{0}\" is installed: give the name of an installed font, or a font file (.ttf, .otf)")]
    Family(String),
    /// File that is not a font.
    #[error("{0}: cannot be read as a font")]
    File(String),
}

impl Default for Fonts {
    /// Returns the built-in font, for machines without fonts.
    fn default() -> Self {
        Self::with(Database::new(), None)
    }
}

impl Fonts {
    /// Whether a name denotes a font file and not a family.
    pub fn is_file(name: &str) -> bool {
        name.contains(['/', '\\']) || [".ttf", ".otf", ".ttc"].iter().any(|end| name.to_lowercase().ends_with(end))
    }

    /// Fonts of a font file with these contents.
    pub fn of_file(name: &str, data: Vec<u8>) -> Result<Self, FontError> {
        let mut database = Database::new();
        database.load_font_data(data);
        let family = database.faces().next().and_then(|face| Some(face.families.first()?.0.clone()));
        let family = family.ok_or_else(|| FontError::File(name.into()))?;
        Ok(Self::with(database, Some(family)))
    }

    /// Fonts of an installed family.
    pub fn named(name: &str) -> Result<Self, FontError> {
        let mut database = Database::new();
        database.load_system_fonts();
        let mut families = database.faces().flat_map(|face| &face.families).map(|(family, _)| family);
        let family = families.find(|family| family.to_lowercase() == name.to_lowercase()).cloned();
        let family = family.ok_or_else(|| FontError::Family(name.into()))?;
        let query = Query { families: &[Family::Name(&family)], ..Query::default() };
        let face = database.query(&query).and_then(|id| database.face(id)).cloned();
        // Only this face is used: no letter falls back on another font of the machine.
        let mut alone = Database::new();
        face.ok_or_else(|| FontError::Family(name.into())).map(|face| alone.push_face_info(face))?;
        Ok(Self::with(alone, Some(family)))
    }

    fn with(mut database: Database, family: Option<String>) -> Self {
        let own = [epaint_default_fonts::UBUNTU_LIGHT, epaint_default_fonts::HACK_REGULAR];
        let mut first = None;
        // The second font serves only for letters that the first one lacks: a model's name may have any letters.
        for font in own {
            let ids = database.load_font_source(Source::Binary(Arc::new(font)));
            first = first.or_else(|| Some(database.face(*ids.first()?)?.families.first()?.0.clone()));
        }
        let family = family.or(first).unwrap_or_default();
        database.set_sans_serif_family(family.clone());
        Self { database: Arc::new(database), family }
    }

    /// Name of the family.
    pub fn family(&self) -> &str {
        &self.family
    }

    /// Parses an SVG for drawing with these fonts.
    pub(super) fn tree(&self, svg: &str) -> Result<Tree, resvg::usvg::Error> {
        let options = Options { fontdb: Arc::clone(&self.database), ..Options::default() };
        Tree::from_str(&svg.replace('⁻', RAISED_MINUS), &options)
    }
}

/// Glyphs of a font in a figure, each with the text that it represents.
pub(super) type Glyphs = BTreeMap<u16, String>;

/// Converts the number of a glyph: fonts have fewer than 65536.
pub(super) fn number(glyph: GlyphId) -> u16 {
    u16::try_from(glyph.0).unwrap_or(0)
}

/// Fonts of a figure and their glyphs, in order of first use.
pub(super) fn used(tree: &Tree) -> Vec<(ID, Glyphs)> {
    let mut fonts = Vec::new();
    gather(tree.root(), &mut fonts);
    fonts
}

fn gather(group: &Group, fonts: &mut Vec<(ID, Glyphs)>) {
    for node in group.children() {
        match node {
            Node::Group(group) => gather(group, fonts),
            Node::Text(text) => {
                for glyph in text.layouted().iter().flat_map(|span| &span.positioned_glyphs) {
                    let at = fonts.iter().position(|(id, _)| *id == glyph.font).unwrap_or_else(|| {
                        fonts.push((glyph.font, Glyphs::new()));
                        fonts.len() - 1
                    });
                    fonts[at].1.entry(number(glyph.id)).or_insert_with(|| glyph.text.clone());
                }
            }
            Node::Path(_) | Node::Image(_) => {}
        }
    }
}

/// Font reduced to some glyphs, with the data that a page needs.
pub(super) struct Cut {
    /// Contents of the font file.
    pub(super) data: Vec<u8>,
    /// Whether the outlines are TrueType; otherwise PostScript.
    pub(super) is_true_type: bool,
    /// Units of a font's em square.
    pub(super) units_per_em: f32,
    /// Bounding box of all glyphs: left, bottom, right, top.
    pub(super) around: [i16; 4],
    /// Extent above and below the base line.
    pub(super) ascent: [i16; 2],
    widths: Vec<u8>,
    long_widths: u16,
}

impl Cut {
    /// Advance width of a glyph.
    pub(super) fn width(&self, glyph: u16) -> u16 {
        // Glyphs after the last width share that width.
        u16_at(&self.widths, 4 * usize::from(glyph.min(self.long_widths.saturating_sub(1)))).unwrap_or(0)
    }
}

fn u16_at(data: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_be_bytes(data.get(at..at + 2)?.try_into().ok()?))
}

fn u32_at(data: &[u8], at: usize) -> Option<usize> {
    Some(u32::from_be_bytes(data.get(at..at + 4)?.try_into().ok()?) as usize)
}

/// Names of the tables that a reader of the file needs. Tables for other placement of letters and for variable outlines are omitted.
const KEPT: [&[u8; 4]; 14] = [
    b"OS/2", b"CFF ", b"cmap", b"cvt ", b"fpgm", b"glyf", b"head", b"hhea", b"hmtx", b"kern", b"loca", b"maxp",
    b"name", b"prep",
];

/// Reduces a face of a font file to the outlines of `glyphs`; `None` if the file is broken.
pub(super) fn cut(data: &[u8], index: u32, glyphs: &Glyphs) -> Option<Cut> {
    let start = if data.starts_with(b"ttcf") { u32_at(data, 12 + 4 * index as usize)? } else { 0 };
    let count = usize::from(u16_at(data, start + 4)?);
    let table = |name: &[u8; 4]| {
        let mut records = (0..count).filter_map(|record| data.get(start + 12 + 16 * record..start + 28 + 16 * record));
        let record = records.find(|record| record.starts_with(name))?;
        let from = u32_at(record, 8)?;
        data.get(from..from + u32_at(record, 12)?)
    };
    let (head, line) = (table(b"head")?, table(b"hhea")?);
    let mut tables: BTreeMap<&[u8], Vec<u8>> =
        KEPT.into_iter().filter_map(|name| Some((name.as_slice(), table(name)?.to_vec()))).collect();
    // Version 3: without glyph names.
    let post = table(b"post").and_then(|post| post.get(4..32)).unwrap_or(&[0; 28]);
    tables.insert(b"post", [[0, 3, 0, 0].as_slice(), post].concat());
    let outlines = table(b"glyf").zip(table(b"loca"));
    if let Some((glyf, loca)) = outlines {
        let long = u16_at(head, 50)? == 1;
        let (kept, places) = outlines_of(glyf, loca, long, glyphs)?;
        tables.insert(b"glyf", kept);
        tables.insert(b"loca", places);
        tables.get_mut(b"head".as_slice())?.get_mut(50..52)?.copy_from_slice(&[0, 1]);
    }
    let signed = |table: &[u8], at: usize| u16_at(table, at).map(u16::cast_signed);
    Some(Cut {
        is_true_type: outlines.is_some(),
        units_per_em: f32::from(u16_at(head, 18)?.max(1)),
        around: [signed(head, 36)?, signed(head, 38)?, signed(head, 40)?, signed(head, 42)?],
        ascent: [signed(line, 4)?, signed(line, 6)?],
        widths: table(b"hmtx")?.to_vec(),
        long_widths: u16_at(line, 34)?,
        data: file(tables, outlines.is_some())?,
    })
}

/// Outlines of glyphs and of their component glyphs, with the offset of each in four bytes.
fn outlines_of(glyf: &[u8], loca: &[u8], long: bool, glyphs: &Glyphs) -> Option<(Vec<u8>, Vec<u8>)> {
    let place =
        |glyph: usize| if long { u32_at(loca, 4 * glyph) } else { Some(2 * usize::from(u16_at(loca, 2 * glyph)?)) };
    let outline = |glyph: u16| glyf.get(place(usize::from(glyph))?..place(usize::from(glyph) + 1)?);
    let count = loca.len() / if long { 4 } else { 2 } - 1;
    let mut wanted = vec![false; count];
    // Glyph 0 represents missing letters and must always be included.
    let mut open: Vec<u16> = glyphs.keys().copied().chain([0]).collect();
    while let Some(glyph) = open.pop() {
        let seen = wanted.get_mut(usize::from(glyph))?;
        if !std::mem::replace(seen, true) {
            open.extend(parts(outline(glyph)?));
        }
    }
    let (mut kept, mut places) = (Vec::new(), Vec::new());
    for (glyph, wanted) in wanted.into_iter().enumerate() {
        places.extend((kept.len() as u32).to_be_bytes());
        if wanted {
            kept.extend_from_slice(outline(glyph as u16)?);
            kept.resize(kept.len().next_multiple_of(4), 0);
        }
    }
    places.extend((kept.len() as u32).to_be_bytes());
    Some((kept, places))
}

/// Component glyphs of an outline; empty for most.
fn parts(outline: &[u8]) -> Vec<u16> {
    const WORDS: u16 = 1;
    const ONE_SCALE: u16 = 8;
    const MORE: u16 = 32;
    const TWO_SCALES: u16 = 64;
    const FOUR_SCALES: u16 = 128;
    let (mut parts, mut at) = (Vec::new(), 10);
    let mut goes_on = u16_at(outline, 0).is_some_and(|contours| contours.cast_signed() < 0);
    while let Some((flags, part)) = u16_at(outline, at).zip(u16_at(outline, at + 2)).filter(|_| goes_on) {
        parts.push(part);
        let scales = [(ONE_SCALE, 2), (TWO_SCALES, 4), (FOUR_SCALES, 8)];
        let scales: usize = scales.into_iter().filter(|(flag, _)| flags & flag != 0).map(|(_, bytes)| bytes).sum();
        at += 4 + if flags & WORDS != 0 { 4 } else { 2 } + scales;
        goes_on = flags & MORE != 0;
    }
    parts
}

/// Assembles tables into a font file.
fn file(tables: BTreeMap<&[u8], Vec<u8>>, is_true_type: bool) -> Option<Vec<u8>> {
    /// Constant for the checksum of the whole file, from which the sum of its words is subtracted (OpenType, "head").
    const SUM: u32 = 0xB1B0_AFBA;
    let sum = |data: &[u8]| {
        let word =
            |part: &[u8]| part.iter().chain(&[0; 4]).take(4).fold(0_u32, |word, byte| (word << 8) | u32::from(*byte));
        data.chunks(4).map(word).fold(0_u32, u32::wrapping_add)
    };
    let count = tables.len() as u16;
    let power = count.ilog2() as u16;
    let mut file = if is_true_type { vec![0, 1, 0, 0] } else { b"OTTO".to_vec() };
    for number in [count, 16 << power, power, 16 * (count - (1 << power))] {
        file.extend(number.to_be_bytes());
    }
    let (mut body, begin) = (Vec::new(), 12 + 16 * tables.len());
    let mut head = None;
    for (name, mut data) in tables {
        if name == b"head" {
            data.get_mut(8..12)?.fill(0);
            head = Some(begin + body.len());
        }
        file.extend_from_slice(name);
        for number in [sum(&data) as usize, begin + body.len(), data.len()] {
            file.extend((number as u32).to_be_bytes());
        }
        body.append(&mut data);
        body.resize(body.len().next_multiple_of(4), 0);
    }
    file.append(&mut body);
    let rest = SUM.wrapping_sub(sum(&file));
    file.get_mut(head? + 8..head? + 12)?.copy_from_slice(&rest.to_be_bytes());
    Some(file)
}
