//! Do figures stand on paper as they are asked to: as wide, with letters as high, in the font, between the ends?

use std::collections::BTreeSet;
use std::io::Read;
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use corner_impact::cam::Cam;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::progress::Unwatched;
use corner_impact::study::attractors::{Resolution, Step};
use corner_impact::study::speeds::{AttractorRow, SpeedSurvey};
use corner_impact::study::survey::Place;
use corner_impact_cli::figures::{cam_figure, corner_marks, impact_diagram, speeds_figure};
use corner_impact_plot::font::Fonts;
use corner_impact_plot::layout::{Layout, TEXT, Text, WIDTH, width};
use corner_impact_plot::{
    Beside, Colour, Data, Density, Figure, FigureAxis, Label, Look, Marker, Panel, Series, Stroke, Theme, TitleChoice,
    pdf, png, svg,
};
use flate2::read::ZlibDecoder;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::Source;
use resvg::usvg::roxmltree::{Document, ParsingOptions};
use resvg::usvg::{Options, Tree};

use crate::common;

/// Points of a millimetre.
const MM: f64 = 72.0 / 25.4;

/// 85 mm wide, with letters of 8 pt.
fn column() -> Look {
    Look { width: Some(85.0 * MM), size: Some(8.0), theme: Theme::Print, ..Look::default() }
}

fn parabola() -> Figure {
    let points: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i), f64::from(i * i)]).collect();
    let series = |colour, data| Series { label: String::new(), name: String::new(), colour, data };
    let word = Label { at: [50.0, 2500.0], text: "half_way".into(), beside: Beside::Right };
    let mut cloud = Density::new([0.0, 100.0], [0.0, 1e4]);
    (0..200).for_each(|i| (0..200).for_each(|j| cloud.push(0.5 * f64::from(i), 50.0 * f64::from(j))));
    let all = vec![
        series(Colour::Grey, Data::Density(cloud)),
        series(Colour::Blue, Data::Line { points: points.clone(), stroke: Stroke::Dashed }),
        series(Colour::Green, Data::Points { points, marker: Marker::Ring }),
        series(Colour::Ink, Data::Words(vec![word])),
    ];
    let panel = |series| Panel { y: FigureAxis::new("height", "m"), height: 0.4, series, marks: vec![], own_x: None };
    let panels = vec![panel(all.clone()), panel(all)];
    Figure {
        title: "A parabola".into(), x: FigureAxis::new("length", "s"), marks: vec![], panels, note: "noté".into()
    }
}

/// The streams of a PDF that are packed, and all the rest of it as text.
fn streams(pdf: &[u8]) -> (Vec<Vec<u8>>, String) {
    let (mut streams, mut rest, mut text) = (Vec::new(), pdf, String::new());
    let find = |bytes: &[u8], what: &[u8]| bytes.windows(what.len()).position(|part| part == what);
    while let Some(at) = find(rest, b"stream\n") {
        text += &String::from_utf8_lossy(&rest[..at]);
        let body = &rest[at + 7..];
        let end = find(body, b"\nendstream").unwrap();
        let mut unpacked = Vec::new();
        let is_packed = ZlibDecoder::new(&body[..end]).read_to_end(&mut unpacked).is_ok();
        streams.push(if is_packed { unpacked } else { body[..end].to_vec() });
        rest = &body[end + 10..];
    }
    (streams, text + &String::from_utf8_lossy(rest))
}

/// How high letters are on the page, each time that a font is set.
fn heights(content: &str) -> Vec<f64> {
    let (mut scale, mut kept, mut heights) = (1.0, Vec::new(), Vec::new());
    for line in content.lines() {
        let part = |at: usize| line.split(' ').nth(at).and_then(|part| part.parse::<f64>().ok());
        match line.rsplit(' ').next() {
            Some("q") => kept.push(scale),
            Some("Q") => scale = kept.pop().unwrap(),
            Some("cm") => scale *= part(0).unwrap(),
            Some("Tf") => heights.push(scale * part(1).unwrap()),
            _ => {}
        }
    }
    heights
}

/// The bytes of a string of a PDF in brackets.
fn unescaped(text: &[u8]) -> Vec<u8> {
    let (mut bytes, mut rest) = (Vec::new(), text.iter().copied().peekable());
    while let Some(byte) = rest.next() {
        let octal = |byte: &u8| (b'0'..b'8').contains(byte);
        match byte {
            b'\\' if rest.peek().is_some_and(octal) => {
                let digits: Vec<u8> = rest.by_ref().take(3).collect();
                bytes.push(digits.iter().fold(0, |all, digit| 8 * all + (digit - b'0')));
            }
            b'\\' => bytes.extend(rest.next().map(|byte| match byte {
                b'n' => b'\n',
                b'r' => b'\r',
                b't' => b'\t',
                b'b' => 8,
                b'f' => 12,
                byte => byte,
            })),
            byte => bytes.push(byte),
        }
    }
    bytes
}

#[test]
#[ignore = "slow"]
fn a_figure_is_as_wide_and_its_letters_as_high_as_asked() {
    let figure = parabola();
    for (mm, size) in [(85.0, 8.0), (85.0, 6.0), (170.0, 10.0), (60.0, 5.0)] {
        let look = Look { width: Some(mm * MM), size: Some(size), ..column() }.checked().unwrap();
        let text = svg::render(&figure, &look).unwrap();
        let options = ParsingOptions::default();
        let document = Document::parse_with_options(&text, options).unwrap();
        let root = document.root_element();
        let points: f64 = root.attribute("width").unwrap().strip_suffix("pt").unwrap().parse().unwrap();
        let across: f64 = root.attribute("viewBox").unwrap().split(' ').nth(2).unwrap().parse().unwrap();
        let letters: f64 = root.attribute("font-size").unwrap().parse().unwrap();
        assert!(
            (points - mm * MM).abs() < 0.01 && (letters * points / across - size).abs() < 0.01,
            "{mm}: {text:.300}"
        );

        let (streams, rest) = streams(&pdf::render(&figure, &look).unwrap());
        let page: Vec<f64> = rest
            .split("/MediaBox [")
            .nth(1)
            .unwrap()
            .split(']')
            .next()
            .unwrap()
            .split(' ')
            .map(|side| side.parse().unwrap())
            .collect();
        assert!((page[2] - mm * MM).abs() < 0.01, "{page:?}");
        let content =
            streams.iter().map(|stream| String::from_utf8_lossy(stream)).find(|stream| stream.contains(" Tf")).unwrap();
        let letters = heights(&content);
        // Most letters; the title's are higher, lowered ones smaller.
        assert!(
            letters.iter().filter(|height| (**height - size).abs() < 0.01).count() > letters.len() / 2,
            "{letters:?}"
        );
    }
    let image = png::render(figure.clone(), &column(), column().pixels()).unwrap();
    let decoder = ::png::Decoder::new(std::io::Cursor::new(&image));
    let reader = decoder.read_info().unwrap();
    let (dots, across) = (reader.info().pixel_dims.unwrap(), reader.info().width);
    assert!((f64::from(across) / f64::from(dots.xppu) - 0.085).abs() < 1e-4, "{across} at {dots:?}");
    assert_eq!(dots.xppu, dots.yppu);
}

/// Whatever the width: nothing beyond the page, and three labels at least on each axis.
#[test]
fn a_narrow_figure_holds_its_words_and_ticks() {
    let model = Model::parse("osorio-2008.toml", OSORIO_2008).unwrap();
    let cam = Cam::new(&model).unwrap();
    let mut cloud = Density::new([660.0, 750.0], [0.0, 360.0]);
    (0..90).for_each(|i| cloud.push(660.0 + f64::from(i), f64::from(4 * i)));
    let impacts = impact_diagram("impacts of 100 revolutions", cloud, &corner_marks(&cam), None);
    for figure in [parabola(), cam_figure(&model, &cam, "osorio-2008"), impacts] {
        for mm in [70.0, 85.0, 120.0, 170.0] {
            let look = Look { width: Some(mm * MM), ..column() };
            let (wide, layout) = (look.across(), Layout::new(&figure, &look));
            let panels = layout.panels.iter();
            let labels = panels.clone().flat_map(|panel| panel.legend.iter().map(|(_, label)| label));
            let labels =
                labels.chain(panels.flat_map(|panel| panel.marks.iter().filter_map(|mark| mark.label.as_ref())));
            let labels = labels.chain(layout.marks.iter().filter_map(|mark| mark.label.as_ref()));
            for Text { at, text } in
                labels.chain(layout.panels.iter().filter_map(|panel| panel.across.name.as_ref())).chain(&layout.note)
            {
                assert!(at[0] >= 0.0 && at[0] + width(text, TEXT) <= wide, "{mm} mm: \"{text}\" at {at:?} of {wide}");
            }
            for (panel, Text { at, text }) in
                layout.panels.iter().flat_map(|panel| panel.name.iter().map(move |line| (panel, line)))
            {
                let [low, high] = [panel.frame.top, panel.frame.bottom()];
                assert!(
                    at[0] >= TEXT && at[0] < panel.frame.left && low < at[1] && at[1] < high,
                    "\"{text}\" at {at:?}"
                );
            }
            assert!(
                layout.panels[0].across.ticks.len() > 2 && layout.panels.iter().all(|panel| panel.ticks.len() > 2),
                "{}: {mm} mm",
                figure.title
            );
        }
    }
}

/// A reader without the font sees the same letters: those of the font that the SVG brings alone.
#[test]
fn an_svg_brings_its_letters() {
    // Letters by themselves: those that are pushed together are so by a table that is left out. This one is put together from two.
    let mut figure = Figure { title: "é".into(), x: FigureAxis::new("é", ""), note: "é".into(), ..parabola() };
    for panel in &mut figure.panels {
        panel.series.pop();
        panel.y = FigureAxis::new("é", "");
    }
    let look = Look { fonts: Some(Fonts::default()), ..column() };
    let text = svg::render(&figure, &look).unwrap();
    let brought = text.split("font/ttf;base64,").nth(1).and_then(|rest| STANDARD.decode(rest.split(')').next()?).ok());
    let brought = brought.unwrap();
    assert!(brought.len() < epaint_default_fonts::UBUNTU_LIGHT.len() / 10, "{} bytes of letters", brought.len());
    let image = |font: &[u8]| {
        let mut options = Options::default();
        options.fontdb_mut().load_font_source(Source::Binary(Arc::new(font.to_vec())));
        let mut image = Pixmap::new(1200, 1200).unwrap();
        let tree = Tree::from_str(&text, &options).unwrap();
        resvg::render(&tree, Transform::from_scale(3.0, 3.0), &mut image.as_mut());
        image
    };
    let [brought, full, none] = [brought.as_slice(), epaint_default_fonts::UBUNTU_LIGHT, &[]].map(image);
    assert!(brought == full && full != none);
    // In a page it has those of the page, and in a file of its own the program's.
    assert!(!svg::render(&figure, &Look::default()).unwrap().contains("@font-face"));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cam.svg");
    assert!(
        common::corner_impact(["cam", "models/osorio-2008.toml", "--out", file.to_str().unwrap()]).status.success()
    );
    let text = std::fs::read_to_string(file).unwrap();
    assert!(
        text.contains("font-family=\"'Ubuntu', sans-serif\"") && text.contains("@font-face { font-family: 'Ubuntu';")
    );
}

/// Letters of a PDF can be looked for and copied: glyphs, by the table that says what they stand for, are the words.
#[test]
fn a_pdf_has_its_words_and_fonts() {
    let look = Look { title: TitleChoice::Shown, ..column() };
    let (streams, rest) = streams(&pdf::render(&parabola(), &look).unwrap());
    assert!(rest.contains("LETTER+Ubuntu-Light") && rest.contains("/FontFile2") && rest.contains("/SMask"), "{rest}");
    let text = |stream: &[u8]| String::from_utf8_lossy(stream).into_owned();
    let map = streams.iter().map(|stream| text(stream)).find(|stream| stream.contains("beginbfchar")).unwrap();
    let meant = |glyph: u16| {
        let line = map.lines().find_map(|line| line.strip_prefix(&format!("<{glyph:04X}> <")))?;
        char::from_u32(u32::from_str_radix(line.get(..4)?, 16).ok()?)
    };
    let content = streams.iter().find(|stream| text(stream).contains(" Tf")).unwrap();
    let mut words = String::new();
    for part in content.split(|byte| *byte == b'\n').filter(|line| line.ends_with(b" Tj")) {
        let inside = &part[1..part.len() - 4];
        let hex = || u16::from_str_radix(&text(inside), 16).unwrap().to_be_bytes().to_vec();
        let glyph = if part[0] == b'<' { hex() } else { unescaped(inside) };
        let glyph: [u8; 2] = glyph.try_into().unwrap();
        words.extend(meant(u16::from_be_bytes(glyph)));
    }
    for said in ["A parabola", "length (s)", "noté"] {
        assert!(words.contains(said), "no \"{said}\" in {words}");
    }
    assert_eq!(words.matches("half").count(), 2, "once a panel, the rim being none of it: {words}");
}

#[test]
fn titles_and_ends_of_axes_are_as_asked() {
    let look = Look { x: Some([20.0, 60.0]), y: Some([500.0, 2500.0]), ..column() };
    let figure = look.framed(parabola()).unwrap();
    let layout = Layout::new(&figure, &look);
    assert_eq!((layout.panels[0].across.range, layout.panels[0].range), ([20.0, 60.0], [500.0, 2500.0]));
    assert!(layout.panels[1].range[1] > 9000.0, "the second panel keeps its own: {:?}", layout.panels[1].range);
    let text = svg::render(&figure, &look).unwrap();
    assert_eq!(text.matches("A parabola").count(), 1, "for a reader aloud alone, where a width is given");
    for (title, says, count) in [
        (TitleChoice::Shown, "A parabola", 2),
        (TitleChoice::Hidden, "A parabola", 1),
        (TitleChoice::Words("Another name".into()), "Another name", 1),
    ] {
        let text = svg::render(&figure, &Look { title, ..look.clone() }).unwrap();
        assert_eq!(text.matches(says).count(), count, "{says}");
    }
    assert_eq!(svg::render(&figure, &Look::default()).unwrap().matches("A parabola").count(), 2, "without a width");
    for (x, y, says) in [
        (Some([200.0, 300.0]), None, "--x-range from 200 to 300 shows nothing"),
        (Some([20.0, 20.5]), None, "--x-range from 20 to 20.5 is less than a hundredth"),
        (None, Some([2e4, 3e4]), "--y-range from 20000 to 30000 shows nothing"),
    ] {
        let why = Look { x, y, ..column() }.framed(parabola()).unwrap_err().to_string();
        assert!(why.contains(says), "{why}");
    }
    for (width, size) in [(5.0, None), (f64::NAN, None), (240.0, Some(40.0)), (240.0, Some(0.1)), (1e9, None)] {
        assert!(Look { width: Some(width), size, ..Look::default() }.checked().is_err(), "{width} {size:?}");
    }
}

#[test]
fn a_font_of_a_file_is_taken_or_refused() {
    let folder = tempfile::TempDir::new().unwrap();
    let file = folder.path().join("letters.ttf");
    let name = file.to_str().unwrap();
    let fonts = Fonts::of_file(name, epaint_default_fonts::HACK_REGULAR.to_vec()).unwrap();
    assert_eq!(fonts.family(), "Hack");
    let look = Look { fonts: Some(fonts), ..column() };
    assert!(svg::render(&parabola(), &look).unwrap().contains("font-family=\"'Hack', sans-serif\""));
    let (_, rest) = streams(&pdf::render(&parabola(), &look).unwrap());
    assert!(rest.contains("LETTER+Hack-Regular") && !rest.contains("Ubuntu"), "{rest}");
    // Cut off anywhere, a font is refused or drawn without the letters that are gone; nothing breaks.
    let whole = epaint_default_fonts::HACK_REGULAR;
    for share in [0.0, 0.001, 0.3, 0.9] {
        if let Ok(fonts) = Fonts::of_file(name, whole[..(share * whole.len() as f64) as usize].to_vec()) {
            let look = Look { fonts: Some(fonts), ..column() };
            let _ = (svg::render(&parabola(), &look), pdf::render(&parabola(), &look));
        }
    }
    assert!(
        Fonts::named("No Such Letters").unwrap_err().to_string().contains("no font \"No Such Letters\" is installed")
    );
    assert!(
        Fonts::of_file(name, Vec::new()).unwrap_err().to_string().contains("letters.ttf: cannot be read as a font")
    );
    let names = [
        ("letters.ttf", true),
        ("a/Hack", true),
        ("a\\Hack", true),
        ("Hack.OTF", true),
        ("Hack", false),
        ("ttf", false),
    ];
    names.iter().for_each(|(name, is_file)| assert_eq!(Fonts::is_file(name), *is_file, "{name}"));
    // By the program, which reads the file.
    std::fs::write(&file, whole).unwrap();
    let drawn = folder.path().join("cam.svg");
    let words = ["cam", "models/osorio-2008.toml", "--out", drawn.to_str().unwrap(), "--font", name];
    assert_eq!(crate::common::corner_impact(words).status.code(), Some(0));
    assert!(std::fs::read_to_string(drawn).unwrap().contains("'Hack'"));
}

/// Readable in grey: motions that repeat are told apart by the shapes of their points, and a bar bears the shape of its motion.
#[test]
#[ignore = "slow"]
fn attractors_are_told_apart_by_shapes() {
    let model = common::osorio();
    let resolution =
        Resolution::new(Step::for_values([738.8, 739.4], 12, corner_impact::study::survey::Spacing::Linear), 8);
    let found = common::speeds(&model, [738.8, 739.4], &resolution, &Unwatched).unwrap();
    let figure = speeds_figure(&found, &[], WIDTH);
    let shapes = |panel: &Panel| {
        let of = |series: &Series| match &series.data {
            Data::Points { marker, .. } => Some((format!("{:?}", series.colour), format!("{marker:?}"))),
            _ => None,
        };
        panel.series.iter().filter_map(of).collect::<BTreeSet<_>>()
    };
    let [places, bars] = [&figure.panels[0], &figure.panels[1]].map(shapes);
    let (colours, markers): (BTreeSet<_>, BTreeSet<_>) = places.iter().cloned().unzip();
    assert!(colours.len() > 1 && markers.len() == places.len(), "{places:?}");
    assert!(markers.contains("Diamond"), "a cloud has its own: {places:?}");
    assert!(places.is_subset(&bars), "{places:?}, {bars:?}");
}

/// Names stand beside each other or in lanes, also at the right edge; of many attractors those that are there for a short range have none.
#[test]
fn names_of_attractors_have_room() {
    let model = common::osorio();
    let resolution =
        Resolution::new(Step::for_values([700.0, 701.0], 2, corner_impact::study::survey::Spacing::Linear), 4);
    let mut found = common::speeds(&model, [700.0, 701.0], &resolution, &Unwatched).unwrap();
    let one = found.attractors[0].clone();
    let over = |from: f64, to: f64, index: usize| AttractorRow {
        id: format!("A{index}"),
        ends: [from, to].map(Place::of_speed),
        ..one.clone()
    };
    let words = |found: &SpeedSurvey, across: f64| {
        let figure = speeds_figure(found, &[], across);
        let bars = figure.panels[1].series.iter();
        let words =
            bars.filter_map(|series| if let Data::Words(words) = &series.data { Some(words.clone()) } else { None });
        (words.flatten().collect::<Vec<_>>(), figure.note)
    };
    found.attractors = vec![over(700.0, 700.94, 1), over(700.97, 701.0, 2), over(700.98, 701.0, 3)];
    for across in [240.0, WIDTH] {
        let (words, _) = words(&found, across);
        // The first name ends before the second begins, which ends before its bar does.
        let lanes: Vec<f64> = words.iter().map(|word| word.at[1]).collect();
        assert_eq!(lanes, [0.0, -1.0, -2.0], "{across}: {words:?}");
    }
    found.attractors[0].ends[1] = Place::of_speed(700.2);
    let (few, note) = words(&found, WIDTH);
    assert_eq!((few[0].at[1], few[1].at[1], few.len(), note.as_str()), (0.0, 0.0, 3, ""), "{few:?}");
    found.attractors.extend((4..40).map(|index| over(700.5, 700.5009, index)));
    let (many, note) = words(&found, WIDTH);
    let names: Vec<&str> = many.iter().map(|word| word.text.as_str()).collect();
    assert_eq!(names, ["A1", "A2", "A3", "36 brief"]);
    assert_eq!(note, "small grey dots: 36 more motions, each over less than a thousandth of the range");
    // A little longer they have lanes of their own, unless these are too many to look through.
    found.attractors.truncate(5);
    found.attractors.iter_mut().skip(3).for_each(|it| it.ends[1] = Place::of_speed(700.502));
    assert_eq!((words(&found, WIDTH).0.len(), words(&found, WIDTH).1.as_str()), (5, ""));
    found.attractors.extend((6..40).map(|index| over(700.5, 700.502, index)));
    assert_eq!(
        words(&found, WIDTH).1,
        "small grey dots: 36 more motions, each over less than a hundredth of the range"
    );
}

/// Every command that draws has the options of paper.
#[test]
fn every_picture_takes_the_options() {
    for command in
        ["cam", "simulate", "diagram", "chart", "figure", "speeds", "basins", "continue", "curve", "chaos", "design"]
    {
        let help = common::text(common::corner_impact([command, "--help"]).stdout);
        for option in [
            "--width <",
            "--height <",
            "--size <",
            "--font <",
            "--title",
            "--no-title",
            "--legend <",
            "--theme <",
            "--x-range <",
            "--y-range <",
            "--script <",
            ".pdf",
        ] {
            assert!(help.contains(option), "{command}: no {option}");
        }
    }
    let folder = tempfile::TempDir::new().unwrap();
    for name in ["a.svg", "a.png", "a.pdf"] {
        let file = folder.path().join(name);
        let line = format!(
            "simulate --rpm 183 --revolutions 3 --width 85mm --size 8pt --y 0.4:0.5 --theme print --trace {}",
            file.display()
        );
        let output = common::corner_impact(line.split(' '));
        assert_eq!(output.status.code(), Some(0), "{line}: {}", common::text(output.stderr));
        let begins: [&[u8]; 3] = [b"<svg", b"\x89PNG", b"%PDF"];
        assert!(begins.iter().any(|begin| std::fs::read(&file).unwrap().starts_with(begin)), "{name}");
    }
}
