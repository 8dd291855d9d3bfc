//! Figures as PDF, made from their SVG: paths remain paths, and letters remain letters of embedded fonts.
//!
//! Supports only the elements that figures have: plain colours, paths, words, clipping rectangles, and images of one colour.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use resvg::tiny_skia::{Path, PathSegment, Transform};
use resvg::usvg::fontdb::{Database, ID};
use resvg::usvg::{Fill, FillRule, Group, ImageKind, LineCap, LineJoin, Node, Paint, Stroke, Text};

use super::font::{Glyphs, cut, number, used};
use super::look::Look;
use super::{Figure, svg};

/// Reason why there is no PDF.
#[derive(Debug, thiserror::Error)]
pub enum PdfError {
    /// SVG that could not be written.
    #[error("the figure could not be written as SVG: {0}")]
    Svg(#[from] std::fmt::Error),
    /// SVG that could not be read back.
    #[error("the figure's SVG could not be read: {0}")]
    Read(#[from] resvg::usvg::Error),
    /// Image of a cloud that could not be read.
    #[error("a cloud of points could not be read back: {0}")]
    Image(#[from] png::DecodingError),
    /// Broken font.
    #[error("the font {0} could not be cut down to the letters that are used")]
    Font(String),
    /// Stream that could not be compressed.
    #[error("the file could not be packed: {0}")]
    Pack(#[from] std::io::Error),
}

/// Encoding of glyphs by their numbers in the font.
const IDENTITY: SystemInfo<'_> = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// Renders the figure on one page of the figure's size.
pub fn render(figure: &Figure, look: &Look) -> Result<Vec<u8>, PdfError> {
    let fonts = look.fonts.clone().unwrap_or_default();
    let tree = fonts.tree(&svg::document(figure, look)?)?;
    let mut writer =
        Writer { pdf: Pdf::new(), last: 0, page: Content::new(), images: Vec::new(), opacities: Vec::new() };
    let [catalog, pages, page, contents, info] = [(); 5].map(|()| writer.next());
    let scale = look.points() as f32 / tree.size().width();
    let [width, height] = [tree.size().width(), tree.size().height()].map(|length| scale * length);
    let fonts: Vec<(ID, Glyphs, Ref)> =
        used(&tree).into_iter().map(|(id, glyphs)| (id, glyphs, writer.next())).collect();
    // The vertical axis is upwards on paper and downwards in an SVG.
    writer.page.transform([scale, 0.0, 0.0, -scale, 0.0, height]);
    let names: Vec<ID> = fonts.iter().map(|(id, ..)| *id).collect();
    writer.group(tree.root(), 1.0, &names)?;
    writer.pdf.catalog(catalog).pages(pages);
    writer.pdf.pages(pages).kids([page]).count(1);
    writer.pdf.document_info(info).title(TextStr(&figure.title)).creator(TextStr("corner-impact"));
    let mut sheet = writer.pdf.page(page);
    sheet.parent(pages).media_box(Rect::new(0.0, 0.0, width, height)).contents(contents);
    let mut resources = sheet.resources();
    let mut named = resources.fonts();
    fonts.iter().enumerate().for_each(|(at, (.., font))| _ = named.pair(Name(name('F', at).as_bytes()), *font));
    named.finish();
    let mut named = resources.x_objects();
    writer.images.iter().enumerate().for_each(|(at, image)| _ = named.pair(Name(name('I', at).as_bytes()), *image));
    named.finish();
    let mut states = resources.ext_g_states();
    for (at, [fill, stroke]) in writer.opacities.iter().enumerate() {
        let mut state =
            states.insert(Name(name('O', at).as_bytes())).start::<pdf_writer::writers::ExtGraphicsState<'_>>();
        state.non_stroking_alpha(*fill).stroking_alpha(*stroke);
    }
    states.finish();
    resources.finish();
    sheet.finish();
    for (id, glyphs, font) in &fonts {
        writer.font(tree.fontdb(), *id, glyphs, *font)?;
    }
    let content = packed(&std::mem::replace(&mut writer.page, Content::new()).finish())?;
    writer.pdf.stream(contents, &content).filter(Filter::FlateDecode);
    Ok(writer.pdf.finish())
}

fn packed(bytes: &[u8]) -> Result<Vec<u8>, std::io::Error> {
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
    packer.write_all(bytes)?;
    packer.finish()
}

fn name(kind: char, at: usize) -> String {
    format!("{kind}{at}")
}

fn matrix(at: Transform) -> [f32; 6] {
    [at.sx, at.ky, at.kx, at.sy, at.tx, at.ty]
}

struct Writer {
    pdf: Pdf,
    last: i32,
    page: Content,
    images: Vec<Ref>,
    /// Opacities of fill and stroke in the figure.
    opacities: Vec<[f32; 2]>,
}

impl Writer {
    fn next(&mut self) -> Ref {
        self.last += 1;
        Ref::new(self.last)
    }

    fn group(&mut self, group: &Group, opacity: f32, fonts: &[ID]) -> Result<(), PdfError> {
        let opacity = opacity * group.opacity().get();
        self.page.save_state().transform(matrix(group.transform()));
        if let Some(clip) = group.clip_path() {
            // A clip without a path hides everything.
            for node in clip.root().children() {
                if let Node::Path(path) = node {
                    self.path(path.data(), clip.transform().pre_concat(path.abs_transform()));
                }
            }
            self.page.clip_nonzero().end_path();
        }
        for node in group.children() {
            match node {
                Node::Group(group) => self.group(group, opacity, fonts)?,
                Node::Path(path) if path.is_visible() => {
                    self.paint(path.data(), path.fill(), path.stroke(), opacity);
                }
                Node::Text(text) => self.text(text, opacity, fonts)?,
                Node::Image(image) => {
                    if let ImageKind::PNG(data) = image.kind() {
                        self.image(data, [image.size().width(), image.size().height()], opacity)?;
                    }
                }
                Node::Path(_) => {}
            }
        }
        self.page.restore_state();
        Ok(())
    }

    fn path(&mut self, path: &Path, place: Transform) {
        let mut last = resvg::tiny_skia::Point::zero();
        for segment in path.clone().transform(place).iter().flat_map(|path| path.segments()) {
            last = match segment {
                PathSegment::MoveTo(to) => {
                    self.page.move_to(to.x, to.y);
                    to
                }
                PathSegment::LineTo(to) => {
                    self.page.line_to(to.x, to.y);
                    to
                }
                PathSegment::QuadTo(by, to) => {
                    // Control points of the curve as a cubic: two thirds of the way to the quadratic's control point.
                    let [one, other] =
                        [last, to].map(|end| [end.x + (by.x - end.x) / 1.5, end.y + (by.y - end.y) / 1.5]);
                    self.page.cubic_to(one[0], one[1], other[0], other[1], to.x, to.y);
                    to
                }
                PathSegment::CubicTo(one, other, to) => {
                    self.page.cubic_to(one.x, one.y, other.x, other.y, to.x, to.y);
                    to
                }
                PathSegment::Close => {
                    self.page.close_path();
                    last
                }
            };
        }
    }

    /// Sets the opacities of the next fill and stroke.
    fn opacity(&mut self, both: [f32; 2]) {
        let at = self.opacities.iter().position(|other| *other == both).unwrap_or_else(|| {
            self.opacities.push(both);
            self.opacities.len() - 1
        });
        self.page.set_parameters(Name(name('O', at).as_bytes()));
    }

    fn filled(&mut self, fill: &Fill) {
        let [red, green, blue] = colour(fill.paint());
        self.page.set_fill_rgb(red, green, blue);
    }

    fn paint(&mut self, path: &Path, fill: Option<&Fill>, stroke: Option<&Stroke>, opacity: f32) {
        let shares = [fill.map(|fill| fill.opacity().get()), stroke.map(|stroke| stroke.opacity().get())];
        self.opacity(shares.map(|share| opacity * share.unwrap_or(1.0)));
        if let Some(fill) = fill {
            self.filled(fill);
        }
        if let Some(stroke) = stroke {
            let [red, green, blue] = colour(stroke.paint());
            self.page.set_stroke_rgb(red, green, blue).set_line_width(stroke.width().get());
            self.page.set_miter_limit(stroke.miterlimit().get()).set_line_cap(match stroke.linecap() {
                LineCap::Butt => LineCapStyle::ButtCap,
                LineCap::Round => LineCapStyle::RoundCap,
                LineCap::Square => LineCapStyle::ProjectingSquareCap,
            });
            self.page.set_line_join(match stroke.linejoin() {
                LineJoin::Miter | LineJoin::MiterClip => LineJoinStyle::MiterJoin,
                LineJoin::Round => LineJoinStyle::RoundJoin,
                LineJoin::Bevel => LineJoinStyle::BevelJoin,
            });
            self.page.set_dash_pattern(stroke.dasharray().unwrap_or_default().iter().copied(), stroke.dashoffset());
        }
        self.path(path, Transform::identity());
        let odd = fill.is_some_and(|fill| fill.rule() == FillRule::EvenOdd);
        match (fill.is_some(), stroke.is_some()) {
            (true, true) if odd => self.page.fill_even_odd_and_stroke(),
            (true, true) => self.page.fill_nonzero_and_stroke(),
            (true, false) if odd => self.page.fill_even_odd(),
            (true, false) => self.page.fill_nonzero(),
            (false, true) => self.page.stroke(),
            (false, false) => self.page.end_path(),
        };
    }

    fn text(&mut self, text: &Text, opacity: f32, fonts: &[ID]) -> Result<(), PdfError> {
        // The rim of a word is drawn as a path; drawn as letters, the word would be found twice.
        if text.layouted().iter().any(|span| span.stroke.is_some()) {
            return self.group(text.flattened(), opacity, fonts);
        }
        for span in text.layouted().iter().filter(|span| span.visible) {
            let Some(fill) = &span.fill else { continue };
            self.opacity([opacity * fill.opacity().get(); 2]);
            self.filled(fill);
            self.page.begin_text();
            let mut set = None;
            for glyph in &span.positioned_glyphs {
                let Some(at) = fonts.iter().position(|id| *id == glyph.font) else { continue };
                // The outline's transform maps font units to the page; the font defines the number of units per em.
                let (size, place) = (glyph.font_size(), glyph.outline_transform());
                let units = size / place.get_scale().0;
                let place = place.pre_concat(Transform::from_scale(units / size, units / size));
                if set.replace((at, size)) != Some((at, size)) {
                    self.page.set_font(Name(name('F', at).as_bytes()), size);
                }
                self.page.set_text_matrix(matrix(place)).show(Str(&number(glyph.id).to_be_bytes()));
            }
            self.page.end_text();
        }
        Ok(())
    }

    /// Draws an image of one colour, with its opacity as a mask.
    fn image(&mut self, data: &[u8], [width, height]: [f32; 2], opacity: f32) -> Result<(), PdfError> {
        let mut decoder = png::Decoder::new(std::io::Cursor::new(data));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info()?;
        let mut pixels = vec![0; reader.output_buffer_size().unwrap_or(0)];
        let shape = reader.next_frame(&mut pixels)?;
        let one = pixels.first_chunk().copied().map_or([0; 3], |[red, green, blue]: [u8; 3]| [red, green, blue]);
        let opaque: Vec<u8> = pixels.as_chunks::<4>().0.iter().map(|pixel| pixel[3]).collect();
        let [image, mask] = [(); 2].map(|()| self.next());
        let opaque = packed(&opaque)?;
        let mut through = self.pdf.image_xobject(mask, &opaque);
        through.width(shape.width.cast_signed()).height(shape.height.cast_signed()).bits_per_component(8);
        through.color_space().device_gray();
        through.filter(Filter::FlateDecode);
        through.finish();
        let mut plain = self.pdf.image_xobject(image, &one);
        plain.width(1).height(1).bits_per_component(8).s_mask(mask).color_space().device_rgb();
        plain.finish();
        self.opacity([opacity; 2]);
        self.page.save_state().transform([width, 0.0, 0.0, -height, 0.0, height]);
        self.page.x_object(Name(name('I', self.images.len()).as_bytes())).restore_state();
        self.images.push(image);
        Ok(())
    }

    /// Embeds a font with the letters that are used and the text that they represent, so that words can be searched and copied.
    fn font(&mut self, database: &Database, id: ID, glyphs: &Glyphs, font: Ref) -> Result<(), PdfError> {
        let full = database.face(id).map(|face| face.post_script_name.clone()).unwrap_or_default();
        let cut = database.with_face_data(id, |data, index| cut(data, index, glyphs)).flatten();
        let cut = cut.ok_or_else(|| PdfError::Font(full.clone()))?;
        let [descendant, descriptor, file, words] = [(); 4].map(|()| self.next());
        // A prefix of six capitals marks a subset.
        let base = format!("LETTER+{full}");
        let base = Name(base.as_bytes());
        let mut whole = self.pdf.type0_font(font);
        whole.base_font(base).encoding_predefined(Name(b"Identity-H")).descendant_font(descendant).to_unicode(words);
        whole.finish();
        let thousandth = |part: f32| 1000.0 * part / cut.units_per_em;
        let mut part = self.pdf.cid_font(descendant);
        part.subtype(if cut.is_true_type { CidFontType::Type2 } else { CidFontType::Type0 });
        part.base_font(base).system_info(IDENTITY).font_descriptor(descriptor).default_width(0.0);
        if cut.is_true_type {
            part.cid_to_gid_map_predefined(Name(b"Identity"));
        }
        let mut widths = part.widths();
        for glyph in glyphs.keys() {
            widths.consecutive(*glyph, [thousandth(f32::from(cut.width(*glyph)))]);
        }
        widths.finish();
        part.finish();
        let [left, bottom, right, top] = cut.around.map(|part| thousandth(f32::from(part)));
        let [ascent, descent] = cut.ascent.map(|part| thousandth(f32::from(part)));
        let mut about = self.pdf.font_descriptor(descriptor);
        about.name(base).flags(FontFlags::SYMBOLIC).bbox(Rect::new(left, bottom, right, top)).italic_angle(0.0);
        about.ascent(ascent).descent(descent).cap_height(ascent).stem_v(80.0);
        if cut.is_true_type {
            about.font_file2(file)
        } else {
            about.font_file3(file)
        };
        about.finish();
        let mut map = UnicodeCmap::new(Name(b"Letters"), IDENTITY);
        glyphs.iter().for_each(|(glyph, text)| map.pair_with_multiple(*glyph, text.chars()));
        self.pdf.cmap(words, &map.finish());
        let data = packed(&cut.data)?;
        let mut stream = self.pdf.stream(file, &data);
        stream.filter(Filter::FlateDecode);
        if cut.is_true_type {
            stream.pair(Name(b"Length1"), cut.data.len() as i32);
        } else {
            stream.pair(Name(b"Subtype"), Name(b"OpenType"));
        }
        stream.finish();
        Ok(())
    }
}

/// Red, green and blue, each from 0 to 1; figures have only plain colours.
fn colour(paint: &Paint) -> [f32; 3] {
    match paint {
        Paint::Color(colour) => [colour.red, colour.green, colour.blue].map(|part| f32::from(part) / 255.0),
        Paint::LinearGradient(_) | Paint::RadialGradient(_) | Paint::Pattern(_) => [0.0; 3],
    }
}
