//! Can the figures be read: ticks, labels, lines and clouds, from any data, in a small file?

use std::f64::consts::TAU;
use std::path::Path;

use corner_impact::cam::Cam;
use corner_impact::flight::State;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::section::TraceSample;
use corner_impact::simulate::{Event, EventKind};
use corner_impact_cli::figures::{
    CornerMark, TracedRun, cam_figure, corner_marks, impact_diagram, phase_plane, strobe_diagram, time_trace,
};
use corner_impact_plot::layout::{Layout, PanelLayout, TEXT, Text, WIDTH, width};
use corner_impact_plot::ticks::{Tick, ticks, unit};
use corner_impact_plot::{
    Cloud, Colour, Data, Density, Figure, FigureAxis, Look, Mark, Marker, Panel, Series, Stroke, TickSpacing, png, svg,
    thin,
};
use resvg::tiny_skia::Pixmap;
use resvg::usvg::{Options, Tree, roxmltree::Document};

use crate::common;

fn series(data: Data) -> Series {
    Series { label: "f".into(), name: String::new(), colour: Colour::Blue, data }
}

fn figure(data: Data) -> Figure {
    let panel =
        Panel { y: FigureAxis::new("up", "m"), height: 0.4, series: vec![series(data)], marks: vec![], own_x: None };
    Figure {
        title: "T".into(),
        x: FigureAxis::new("across", "s"),
        marks: vec![],
        panels: vec![panel],
        note: String::new(),
    }
}

fn line(points: Vec<[f64; 2]>) -> Data {
    Data::Line { points, stroke: Stroke::Solid }
}

fn parabola() -> Figure {
    figure(line((0..100).map(|i| [f64::from(i), f64::from(i * i)]).collect()))
}

/// The SVG, after it was read as XML and as SVG.
fn drawn(figure: &Figure) -> String {
    let text = svg::render(figure, &Look::default()).unwrap();
    Document::parse(&text).unwrap();
    Tree::from_str(&text, &Options::default()).unwrap();
    text
}

/// Without their colours, too.
#[test]
fn markers_are_told_apart_by_their_shapes() {
    let shapes = [Marker::Ring, Marker::Square, Marker::Diamond, Marker::Triangle, Marker::Cross, Marker::Plus];
    let svg = |marker: Marker, count: usize| {
        let points = (0..count).map(|index| [index as f64, index as f64]).collect();
        drawn(&figure(Data::Points { points, marker }))
    };
    for count in [20, 100] {
        // The longest path is that of the points; the legend has one by itself.
        let path =
            |marker| attribute(&svg(marker, count), "path", "d").into_iter().max_by_key(|d| d.len()).map(str::to_owned);
        let paths = shapes.map(path);
        for (index, path) in paths.iter().enumerate() {
            assert!(paths[..index].iter().all(|other| other != path), "{:?} of {count}", shapes[index]);
        }
    }
    let long = |count: usize| attribute(&svg(Marker::Square, count), "path", "stroke-width").join(" ");
    assert!(long(100).contains("0.7") && !long(20).contains("0.7"), "many are small: {}", long(100));
}

fn texts(svg: &str) -> Vec<String> {
    let document = Document::parse(svg).unwrap();
    let texts = document.descendants().filter(|node| node.has_tag_name("text"));
    texts.map(|node| node.text().unwrap_or_default().to_owned()).collect()
}

/// Whether one of some texts is this one, or some in a row are its lines.
fn says(texts: &[String], text: &str) -> bool {
    let lines = |count: usize| texts.windows(count).any(|lines| lines.join(" ") == text);
    (1..4).any(lines)
}

fn attribute<'a>(svg: &'a str, tag: &str, name: &str) -> Vec<&'a str> {
    let tags = svg.split('<').filter(|part| part.starts_with(&format!("{tag} ")));
    tags.filter_map(|part| part.split(&format!(" {name}=\"")).nth(1)?.split('"').next()).collect()
}

/// A made-up sweep: chaos below 673.2 rpm, a single line above.
fn sweep(speeds: usize, impacts: usize, mut push: impl FnMut(f64, f64)) {
    let mut x: f64 = 0.3;
    for speed in 0..speeds {
        let rpm = 660.0 + 90.0 * speed as f64 / speeds as f64;
        for _ in 0..impacts {
            x = 3.99 * x * (1.0 - x);
            push(rpm, if rpm < 673.2 { 100.0 + 110.0 * x } else { 150.0 + 0.6 * (rpm - 673.2) });
        }
    }
}

/// Hops and rests by turns, 0.002 revolutions a sample, with impacts after 2 and after 6 tenths of a revolution.
fn motion() -> TracedRun {
    let sample = |i: i32| {
        let (turned, contact) = (0.3 + f64::from(i) * 0.002 * TAU, (i / 100) % 2 == 1);
        let gap = if contact { 0.0 } else { (f64::from(i % 100) / 100.0 * TAU / 2.0).sin() * 0.02 };
        let lift = 0.4 + 0.1 * turned.sin();
        let velocity = (f64::from(i % 100) / 100.0 * TAU / 2.0).cos();
        TraceSample {
            turned,
            cam_angle: turned,
            state: State { position: lift + gap, velocity },
            lift,
            cam_velocity: 0.0,
            gap,
            contact,
            pressing: 0.0,
        }
    };
    let impact = |turned: f64| Event {
        kind: EventKind::Impact,
        revolution: 0,
        cam_angle: 0.3 + turned * TAU,
        position: 0.45,
        velocity_before: -1.0,
        velocity_after: 1.0,
        cam_velocity: 0.0,
        segment: 0,
    };
    TracedRun { rpm: 60.0, samples: (0..600).map(sample).collect(), events: [0.2, 0.6].map(impact).to_vec() }
}

#[test]
fn ticks_are_round_and_inside() {
    for range in
        [[0.0, 1.0], [-3.7, 12.9], [0.4, 0.5537], [660.0, 750.0], [673.2344, 673.2345], [-2e-7, 5e-7], [0.0, 3e9]]
    {
        let found = ticks(range, TickSpacing::Decimal, 8, |_| true);
        let at: Vec<f64> = found.ticks.iter().map(|tick| tick.at).collect();
        assert!((3..=8).contains(&at.len()), "{range:?}: {at:?}");
        assert!(at.iter().all(|at| (range[0]..=range[1]).contains(at)), "{range:?}: {at:?}");
        let step = (at[1] - at[0]) / 10_f64.powf((at[1] - at[0]).log10().floor());
        let nice = [1.0, 2.0, 5.0, 10.0].iter().any(|nice| (step / nice - 1.0).abs() < 1e-3);
        assert!(nice, "{range:?}: {at:?}");
        let labels: Vec<&str> = found.ticks.iter().map(|tick| tick.label.as_str()).collect();
        for (tick, label) in found.ticks.iter().zip(&labels) {
            let value: f64 = label.replace('−', "-").parse().unwrap();
            let shown = value * 10_f64.powi(found.exponent);
            assert!((shown - tick.at).abs() <= 1e-6 * (range[1] - range[0]), "{tick:?}");
            assert_eq!(labels.iter().filter(|other| *other == label).count(), 1, "{labels:?}");
            assert!(label.chars().count() <= 10, "{label}");
        }
    }
}

#[test]
fn angles_are_cut_into_parts_of_a_circle() {
    let steps = |range, most| {
        let found = ticks(range, TickSpacing::Degrees, most, |_| true).ticks;
        found[1].at - found[0].at
    };
    assert_eq!(steps([0.0, 360.0], 13), 30.0);
    assert_eq!(steps([0.0, 360.0], 9), 45.0);
    assert_eq!(steps([0.0, 360.0], 7), 60.0);
    assert_eq!(steps([0.0, 360.0], 5), 90.0);
    assert_eq!(steps([90.0, 230.0], 10), 15.0);
    assert_eq!(steps([149.0, 152.0], 8), 0.5);
    assert_eq!(steps([0.0, 3600.0], 6), 720.0);
}

#[test]
fn impossible_ranges_have_no_ticks() {
    for range in [[0.0, 0.0], [1.0, 0.0], [f64::NAN, 1.0], [0.0, f64::INFINITY], [-1e308, 1e308]] {
        assert!(ticks(range, TickSpacing::Decimal, 8, |_| true).ticks.is_empty(), "{range:?}");
    }
    // Labels that never fit end the search.
    assert!(ticks([0.0, 1.0], TickSpacing::Degrees, 8, |_| false).ticks.len() <= 1);
    assert_eq!(unit("m", -3), "10⁻³ m");
    assert_eq!(unit("", 12), "10¹²");
    assert_eq!(unit("rpm", 0), "rpm");
}

fn overlap(one: &Text, other: &Text) -> bool {
    let apart = |text: &Text| (text.at[0], text.at[0] + width(&text.text, TEXT));
    let ((left, right), (other_left, other_right)) = (apart(one), apart(other));
    left < other_right && other_left < right && (one.at[1] - other.at[1]).abs() < TEXT
}

#[test]
fn no_label_covers_another() {
    for count in [2_usize, 6, 12] {
        for spread in [0.5, 10.0, 340.0] {
            let mark = |i: usize| Mark {
                at: 5.0 + spread * i as f64 / count as f64,
                label: format!("P{i} {:.1}°", 5.0 + spread * i as f64 / count as f64),
            };
            let marks: Vec<Mark> = (0..count).map(mark).collect();
            let mut figure = figure(line(vec![[0.0, 0.0], [360.0, 360.0]]));
            figure.x = FigureAxis::degrees("angle").over([0.0, 360.0]);
            figure.panels[0].y = FigureAxis::degrees("phase").over([0.0, 360.0]);
            figure.marks.clone_from(&marks);
            figure.panels[0].marks = marks;
            let layout = Layout::new(&figure, &Look::default());
            let frame = layout.panels[0].frame;
            let mut labels: Vec<Text> = layout.marks.iter().map(|mark| mark.label.clone().unwrap()).collect();
            for (mark, label) in layout.marks.iter().map(|mark| (mark, mark.label.as_ref().unwrap())) {
                let crossed = labels.iter().find(|other| {
                    let inside = other.at[0] < mark.at && mark.at < other.at[0] + width(&other.text, TEXT);
                    inside && other.at[1] >= label.at[1] && other.at != label.at
                });
                assert!(crossed.is_none(), "the line of {label:?} runs through {crossed:?}");
            }
            labels.extend(layout.panels[0].marks.iter().map(|mark| mark.label.clone().unwrap()));
            labels.extend(layout.panels[0].legend.iter().map(|(_, text)| text.clone()));
            let tick = |tick: &Tick| {
                let middle = frame.left + frame.width * tick.at / 360.0;
                Text { at: [middle - width(&tick.label, TEXT) / 2.0, frame.bottom() + 20.0], text: tick.label.clone() }
            };
            labels.extend(layout.panels.iter().flat_map(|panel| &panel.across.ticks).map(tick));
            for (index, label) in labels.iter().enumerate() {
                assert!(label.at[0] >= 0.0 && label.at[0] + width(&label.text, TEXT) <= WIDTH, "{label:?}");
                assert!(label.at[1] > TEXT && label.at[1] < layout.height, "{label:?}");
                let covered = labels[index + 1..].iter().find(|other| overlap(label, other));
                assert!(covered.is_none(), "{label:?} covers {covered:?}");
            }
        }
    }
}

#[test]
fn legends_wrap_instead_of_running_off_the_page() {
    let mut figure = parabola();
    let many = (0..9)
        .map(|i| Series { label: format!("a rather long name, number {i}"), ..figure.panels[0].series[0].clone() });
    figure.panels[0].series = many.collect();
    let layout = Layout::new(&figure, &Look::default());
    let panel = &layout.panels[0];
    assert_eq!(panel.legend.len(), 9);
    for (index, (_, label)) in panel.legend.iter().enumerate() {
        assert!(label.at[0] + width(&label.text, TEXT) <= WIDTH, "{label:?}");
        assert!(label.at[1] < panel.frame.top, "{label:?}");
        assert!(panel.legend[index + 1..].iter().all(|(_, other)| !overlap(label, other)), "{label:?}");
    }
}

#[test]
fn every_axis_says_its_name_and_unit() {
    let model = Model::parse("osorio-2008.toml", OSORIO_2008).unwrap();
    let figure = cam_figure(&model, &Cam::new(&model).unwrap(), "The cam");
    let texts = texts(&drawn(&figure));
    for text in [
        "The cam",
        "lift c (m)",
        "velocity dc/dθ (m/rad)",
        "acceleration d²c/dθ² (m/rad²)",
        "cam angle θ (deg)",
        "P 150.2°",
        "Q' 200.0°",
        "R' 270.0°",
        "360",
        "0.55",
        "−0.2",
    ] {
        assert!(says(&texts, text), "{text}: {texts:?}");
    }
    // Small values bear their power of ten beside the unit.
    let small = drawn(&self::figure(line(vec![[0.0, 0.0], [1.0, 4e-4]])));
    assert!(small.contains("up (10⁻⁶ m)"), "{small}");
}

/// A lift that follows from a contour is drawn above that, with an axis of its own; another lift alone.
#[test]
fn a_cam_with_a_contour_is_drawn_with_its_shape() {
    for (name, panels) in [("machines/tangent-roller", 4), ("machines/flat-face-arcs", 4), ("laws/harmonic", 3)] {
        let model = common::read(Path::new(&format!("models/{name}.toml")));
        let figure = cam_figure(&model, &Cam::new(&model).unwrap(), "");
        assert_eq!(figure.panels.len(), panels, "{name}");
        let (layout, texts) = (Layout::new(&figure, &Look::default()), texts(&drawn(&figure)));
        assert!(says(&texts, "cam angle θ (deg)"), "{texts:?}");
        assert_eq!(says(&texts, "from the axis, across (m)"), panels == 4, "{texts:?}");
        assert_eq!(says(&texts, "path of the roller's centre"), name.ends_with("roller"), "{texts:?}");
        let Some(shape) = layout.panels.get(3) else { continue };
        assert!(
            shape.across.is_own && layout.panels[2].across.name.is_some() && layout.panels[1].across.name.is_none()
        );
        let is_round = |shape: &PanelLayout| {
            let scale = [shape.frame.width, shape.frame.height].into_iter().zip([shape.across.range, shape.range]);
            let scale: Vec<f64> = scale.map(|(length, [low, high])| length / (high - low)).collect();
            (scale[0] / scale[1] - 1.0).abs() < 1e-9
        };
        assert!(is_round(shape), "{shape:?}");
        // Another height keeps circles round, too.
        for factor in [0.7, 1.2] {
            let height = Some(factor * layout.height * Look::default().points() / WIDTH);
            let other = Layout::new(&figure, &Look { height, ..Look::default() });
            assert!((other.height / layout.height - factor).abs() < 0.01, "{} {}", other.height, layout.height);
            assert!(is_round(&other.panels[3]), "{other:?}");
        }
    }
}

/// A long label at a line on the right leaves the frame its width: it stands over its own line.
#[test]
fn a_label_without_room_beside_its_line_stands_over_it() {
    let with_label = |label: &str| {
        let mark = Mark { at: 0.9, label: label.into() };
        Figure { marks: vec![mark], ..figure(line(vec![[0.0, 0.0], [1.0, 1.0]])) }
    };
    let look = Look { width: Some(240.0), ..Look::default() };
    let [short, long] = ["s", "separation, 2915 ± 13 rpm"].map(|label| Layout::new(&with_label(label), &look));
    assert_eq!(short.panels[0].frame, long.panels[0].frame);
    let label = long.marks[0].label.as_ref().unwrap();
    assert!(label.at[0] < long.marks[0].at && label.at[0] + width(&label.text, TEXT) <= look.across(), "{label:?}");
    let right_of_line = short.marks[0].label.as_ref().unwrap().at[0] > short.marks[0].at;
    assert!(right_of_line, "{:?}", short.marks);
}

#[test]
fn the_cam_is_drawn_with_its_jumps_left_open() {
    let model = Model::parse("osorio-2008.toml", OSORIO_2008).unwrap();
    let cam = Cam::new(&model).unwrap();
    let figure = cam_figure(&model, &cam, "");
    for (order, (panel, breaks)) in figure.panels.iter().zip([0, 0, 6]).enumerate() {
        let Data::Line { points, .. } = &panel.series[0].data else { panic!() };
        assert_eq!(points.iter().filter(|point| point[0].is_nan()).count(), breaks);
        for point in points.iter().filter(|point| !point[0].is_nan()) {
            let on = |angle: f64| {
                let lift = cam.lift(angle.to_radians().min(TAU - 1e-12));
                [lift.value, lift.slope, lift.curvature][order]
            };
            let near = [-1e-7, 1e-7].map(|shift| (on((point[0] + shift).max(0.0)) - point[1]).abs());
            assert!(near[0].min(near[1]) < 1e-6, "{order} {point:?}");
        }
    }
    let names: Vec<String> = corner_marks(&cam).into_iter().map(|mark| mark.name).collect();
    assert_eq!(names, ["R", "P", "Q", "Q'", "P'", "R'"]);
    // Seven strokes in the panel of the acceleration, one in the others.
    let strokes: Vec<usize> =
        attribute(&drawn(&figure), "path", "d").iter().map(|path| path.matches('M').count()).collect();
    assert!(strokes.contains(&7), "{strokes:?}");
}

#[test]
fn nothing_to_draw_is_said() {
    let nan = f64::NAN;
    let density = |x, y| Data::Density(Density::new(x, y));
    let mut outside = Density::new([0.0, 1.0], [0.0, 1.0]);
    for (x, y) in [(2.0, 0.5), (nan, 0.5), (0.5, f64::INFINITY)] {
        outside.push(x, y);
    }
    assert_eq!((outside.outside(), outside.occupied(), outside.extent()), (3, 0, None));
    for data in [
        line(vec![]),
        line(vec![[nan, 1.0], [1.0, nan], [f64::INFINITY, f64::NEG_INFINITY]]),
        Data::Area { points: vec![[nan, nan]], stroke: Stroke::Thin },
        Data::Points { points: vec![[1e308, -1e308]], marker: Marker::Ring },
        Data::Density(outside),
        density([1.0, 0.0], [nan, 3.0]),
        Data::Density(Cloud::new([0.0, 1.0]).finish()),
    ] {
        let figure = figure(data);
        let svg = drawn(&figure);
        assert!(svg.contains(">no data<"), "{svg}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(png::render(figure.clone(), &Look::default(), 300).is_ok());
    }
    let empty = TracedRun { rpm: 60.0, samples: vec![], events: vec![] };
    assert_eq!(drawn(&time_trace("", &empty)).matches(">no data<").count(), 2);
    let none = Figure { panels: vec![], ..parabola() };
    assert!(drawn(&none).contains("<svg") && png::render(none.clone(), &Look::default(), 100).is_ok());
    assert!(!drawn(&parabola()).contains("no data"));
}

#[test]
fn wild_data_are_drawn_without_panic() {
    let wild =
        [0.0, -0.0, 1e-320, 5e-324, 1.0, -1.0, 1e300, -9e299, 1e308, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.1];
    let points: Vec<[f64; 2]> = wild.iter().flat_map(|x| wild.iter().map(move |y| [*x, *y])).collect();
    for range in [None, Some([1.0, 0.0]), Some([f64::NAN, 1.0]), Some([1.0, 1.0 + 1e-15]), Some([-1e-300, 1e-300])] {
        for stroke in [Stroke::Thin, Stroke::Dashed, Stroke::Thick] {
            let mut figure = figure(line(points.clone()));
            figure.x.range = range;
            figure.panels[0].y = FigureAxis { range, ..FigureAxis::degrees("φ") };
            figure.panels[0].height = if stroke == Stroke::Thin { f64::NAN } else { 0.3 };
            figure.panels[0].series.push(series(Data::Area { points: points.clone(), stroke }));
            figure.panels[0].series.push(series(Data::Points { points: points.clone(), marker: Marker::Below }));
            figure.marks = wild.iter().map(|at| Mark { at: *at, label: "m".into() }).collect();
            figure.panels[0].marks.clone_from(&figure.marks);
            let svg = drawn(&figure);
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
        }
    }
    let mut cloud = Cloud::new([0.0, 1.0]);
    for i in 0..10_000 {
        cloud.push(0.5, wild[i % wild.len()]);
    }
    assert!(cloud.finish().occupied() > 0);
}

#[test]
#[ignore = "slow"]
fn a_million_points_stay_small() {
    let mut grid = Density::new([660.0, 750.0], [90.0, 230.0]);
    sweep(2000, 500, |rpm, phase| grid.push(rpm, phase));
    assert!(grid.occupied() > 50_000, "{}", grid.occupied());
    let mut noise = Density::new([0.0, 1.0], [0.0, 1.0]);
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..1_000_000).for_each(|_| noise.push(random(), random()));
    let lines = |points: Vec<[f64; 2]>| svg::render(&figure(line(points)), &Look::default()).unwrap().len();
    let wave = |i: i32| [f64::from(i) * 1e-6, (f64::from(i) * 0.7).sin()];
    for (what, size) in [
        ("sweep", svg::render(&figure(Data::Density(grid)), &Look::default()).unwrap().len()),
        ("noise", svg::render(&figure(Data::Density(noise)), &Look::default()).unwrap().len()),
        ("fast wave", lines((0..1_000_000).map(wave).collect())),
        ("tangle", lines((0..1_000_000).map(|_| [random(), random()]).collect())),
        ("scatter", {
            let points = (0..1_000_000).map(|_| [random(), random()]).collect();
            svg::render(&figure(Data::Points { points, marker: Marker::Ring }), &Look::default()).unwrap().len()
        }),
    ] {
        assert!((5_000..1_000_000).contains(&size), "{what}: {size} bytes");
    }
}

/// A grid keeps what was pushed; a cloud keeps what it did not expect.
#[test]
fn grids_keep_every_point() {
    let mut whole = Density::new([660.0, 750.0], [90.0, 230.0]);
    sweep(200, 50, |rpm, phase| whole.push(rpm, phase));
    let [low, high] = whole.extent().unwrap();
    assert!((99.0..103.0).contains(&low) && (207.0..211.0).contains(&high), "{low} {high}");

    let mut cloud = Cloud::new([0.0, 1.0]);
    for i in 0..20_000 {
        cloud.push(0.5, if i < 10_000 { f64::from(i % 10) } else { f64::from(i % 10) - 40.0 });
    }
    cloud.push(0.5, 300.0);
    let grid = cloud.finish();
    assert_eq!(grid.outside(), 0);
    assert_eq!(grid.occupied(), 21);
    let [low, high] = grid.extent().unwrap();
    assert!((-41.0..=-40.0).contains(&low) && (300.0..=301.0).contains(&high), "{low} {high}");
}

/// Where it was pushed is where it is drawn: up is up, and a point that came often is darker.
#[test]
fn points_are_drawn_where_they_are() {
    let mut grid = Density::new([0.0, 1.0], [0.0, 1.0]);
    grid.push(0.25, 0.9);
    (0..50).for_each(|_| grid.push(0.75, 0.9));
    let of = |data: Data| {
        let mut figure = figure(data);
        figure.x.range = Some([0.0, 1.0]);
        figure.panels[0].y.range = Some([0.0, 1.0]);
        let frame = Layout::new(&figure, &Look::default()).panels[0].frame;
        let image = Pixmap::decode_png(&png::render(figure.clone(), &Look::default(), 2880).unwrap()).unwrap();
        move |x: f64, y: f64| {
            let at = [frame.left + frame.width * x, frame.bottom() - frame.height * y].map(|part| (4.0 * part) as u32);
            image.pixel(at[0], at[1]).unwrap().red()
        }
    };
    let few = of(Data::Density(grid));
    assert!(few(0.25, 0.9) < 255 && few(0.75, 0.9) < few(0.25, 0.9), "{} {}", few(0.25, 0.9), few(0.75, 0.9));
    assert_eq!((few(0.25, 0.1), few(0.5, 0.9)), (255, 255));
    let mut many = Density::new([0.0, 1.0], [0.0, 1.0]);
    sweep(2000, 200, |rpm, phase| many.push((rpm - 660.0) / 90.0 * 0.5, 0.5 + (phase - 90.0) / 280.0));
    assert!(many.occupied() > 25_000);
    let many = of(Data::Density(many));
    assert!(many(0.03, 0.6) < 250 && many(0.03, 0.4) == 255 && many(0.75, 0.75) == 255);
    let line = of(line(vec![[0.0, 0.8], [1.0, 0.8]]));
    assert!(line(0.5, 0.8) < 40 && line(0.5, 0.2) == 255);
}

/// In a PNG a grid is drawn by itself: within its frame, without a seam, over what comes before and under what comes after.
#[test]
fn a_grid_lies_between_what_is_below_and_above_it() {
    let mut grid = Density::new([-1.0, 2.0], [-1.0, 2.0]);
    (0..400_000).for_each(|i| grid.push(f64::from(i % 800) / 300.0 - 0.9, f64::from(i / 800) / 180.0 - 0.9));
    assert!(grid.occupied() > 25_000);
    let mut few = Density::new([-1.0, 2.0], [-1.0, 2.0]);
    (0..20_000).for_each(|i| few.push(0.5, f64::from(i) / 10_000.0 - 0.5));
    assert!(few.occupied() < 25_000);
    for (grid, seam) in [(grid, 0.4), (few, 0.5)] {
        let line = |y: f64, colour| Series { colour, ..series(line(vec![[0.0, y], [1.0, y]])) };
        let (below, above) = (line(0.3, Colour::Ink), line(0.8, Colour::Vermilion));
        let mut figure = figure(Data::Density(grid));
        figure.x.range = Some([0.0, 1.0]);
        figure.panels[0].y.range = Some([0.0, 1.0]);
        figure.panels[0].series.insert(0, below);
        figure.panels[0].series.push(above);
        let frame = Layout::new(&figure, &Look::default()).panels[0].frame;
        let image = Pixmap::decode_png(&png::render(figure.clone(), &Look::default(), 2880).unwrap()).unwrap();
        let pixel = |x: f64, y: f64| {
            let at = [frame.left + frame.width * x, frame.bottom() - frame.height * y].map(|part| (4.0 * part) as u32);
            let pixel = image.pixel(at[0], at[1]).unwrap();
            [pixel.red(), pixel.green(), pixel.blue()]
        };
        let blue = |[red, _, blue]: [u8; 3]| blue > red && red < 200;
        assert!(blue(pixel(seam, 0.3)), "{:?} over a line", pixel(seam, 0.3));
        assert_eq!(pixel(seam, 0.8), [0xd5, 0x5e, 0x00], "under a line");
        for outside in [[seam, -0.02], [seam, 1.02], [-0.005, 0.43], [1.005, 0.43]] {
            assert_eq!(pixel(outside[0], outside[1]), [255; 3], "{outside:?} is outside the frame");
        }
        let column: Vec<[u8; 3]> = (350..750).map(|part| pixel(seam, f64::from(part) / 1000.0)).collect();
        assert!(column.iter().all(|pixel| blue(*pixel)), "{column:?}");
    }
}

#[test]
fn thinned_lines_keep_their_shape_and_breaks() {
    let wave = |i: i32| [f64::from(i) * 0.01, 100.0 + 50.0 * (f64::from(i) * 0.0005).sin()];
    let points: Vec<[f64; 2]> = (0..60_000).map(wave).collect();
    let strokes = thin::strokes(points.iter().copied(), 40_000);
    assert_eq!(strokes.len(), 1);
    assert!(strokes[0].len() < 2000, "{}", strokes[0].len());
    assert_eq!((strokes[0].first(), strokes[0].last()), (points.first(), points.last()));
    for point in &points {
        let pair = strokes[0].windows(2).find(|pair| pair[0][0] <= point[0] && point[0] <= pair[1][0]).unwrap();
        let share = (point[0] - pair[0][0]) / (pair[1][0] - pair[0][0]);
        let off = pair[0][1] + share * (pair[1][1] - pair[0][1]) - point[1];
        assert!(off.abs() < 0.1, "{point:?} off by {off}");
    }
    let nan = [f64::NAN; 2];
    let broken = thin::strokes([[0.0, 0.0], [1.0, 0.0], nan, nan, [2.0, 0.0], [3.0, 9.0], nan], 100);
    assert_eq!(broken, [vec![[0.0, 0.0], [1.0, 0.0]], vec![[2.0, 0.0], [3.0, 9.0]]]);
    // There and back again is not nowhere.
    assert_eq!(thin::strokes([[0.0, 0.0], [9.0, 0.0], [0.0, 0.0]], 100)[0].len(), 3);
    // Too long for its width: the peaks stay.
    let spikes = (0..1000).map(|i| [f64::from(i) * 1e-3, if i == 437 { 77.0 } else { f64::from(i % 2) }]);
    let thinned = thin::strokes(spikes, 50);
    assert!(thinned[0].len() <= 12 && thinned[0].contains(&[0.437, 77.0]), "{thinned:?}");
}

#[test]
fn a_diagram_shows_corners_and_exponents() {
    let corner = |name: &str, degrees: f64| CornerMark { angle_rad: degrees.to_radians(), name: name.into() };
    let corners = [corner("P", 150.2), corner("Q", 160.0)];
    let mut grid = Density::new([660.0, 750.0], [90.0, 230.0]);
    sweep(200, 50, |rpm, phase| grid.push(rpm, phase));
    let exponents = [[660.0, 0.4], [673.0, 0.2], [674.0, -0.1], [750.0, -0.3]];
    let with = texts(&drawn(&impact_diagram("D", grid.clone(), &corners, Some(&exponents[..]))));
    for text in [
        "cam angle at impact φ (deg)",
        "P 150.2°",
        "Q 160.0°",
        "cam speed ω (rpm)",
        "Lyapunov exponent λ (per revolution)",
        "0.0",
    ] {
        assert!(says(&with, text), "{text}: {with:?}");
    }
    let strobe = texts(&drawn(&strobe_diagram("D", grid, None)));
    assert!(strobe.iter().any(|found| found == "follower position q at the section (m)"), "{strobe:?}");
    assert!(!strobe.iter().any(|found| found.contains("Lyapunov") || found.contains("150.2")), "{strobe:?}");
}

#[test]
fn a_trace_shows_contact_and_impacts() {
    let run = motion();
    let figure = time_trace("M", &run);
    let svg = drawn(&figure);
    let found = texts(&svg);
    for text in
        ["position (m)", "cam c", "follower q", "in contact", "impact", "gap q − c (m)", "revolutions of the cam"]
    {
        assert_eq!(found.iter().filter(|found| *found == text).count(), 1, "{text}: {found:?}");
    }
    let series = |label: &str| &figure.panels[0].series.iter().find(|series| series.label == label).unwrap().data;
    let Data::Line { points: riding, stroke: Stroke::Thick } = series("in contact") else { panic!("{figure:?}") };
    let shown: Vec<bool> = riding.iter().map(|point| !point[0].is_nan()).collect();
    assert_eq!(shown, run.samples.iter().map(|sample| sample.contact).collect::<Vec<_>>());
    let Data::Points { points: impacts, .. } = series("impact") else { panic!("{figure:?}") };
    for ([turned, position], wanted) in impacts.iter().zip([0.2, 0.6]) {
        assert!((turned - wanted).abs() < 1e-12 && *position == 0.45, "{impacts:?}");
    }
    assert!(svg.contains(r#"stroke-width="4.5""#));
    assert!((figure.x.range.unwrap()[1] - 599.0 * 0.002).abs() < 1e-12);
    let figure = phase_plane("P", &run);
    let plane = texts(&drawn(&figure));
    let marked = |shape: Marker| {
        let of = |series: &Series| match &series.data {
            Data::Points { points, marker } if *marker == shape => Some(points.clone()),
            _ => None,
        };
        figure.panels[0].series.iter().find_map(of).unwrap()
    };
    assert_eq!((marked(Marker::Cross), marked(Marker::Ring)), (vec![[0.0, -1.0]; 2], vec![[0.0, 1.0]; 2]));
    let arrows = figure.panels[0].series.iter().find_map(|series| match &series.data {
        Data::Arrow { points, .. } => Some(points.clone()),
        _ => None,
    });
    let arrows = arrows.unwrap();
    assert!(arrows.len() >= 3 * 5, "{arrows:?}");
    for arrow in arrows.chunks(3) {
        let [[..], [from, speed], [to, _]] = arrow else { panic!("{arrows:?}") };
        // The gap grows where its velocity is above 0.
        assert!(from.max(*to) > 0.0 && (to - from) * speed >= 0.0, "{arrow:?}");
    }
    assert!(plane.contains(&"gap q − c (m)".to_owned()) && plane.contains(&"gap velocity q' − c' (m/s)".to_owned()));
}

#[test]
fn any_text_is_only_text() {
    let mut figure = parabola();
    let wild = "a<b & \"c\" > 'd' ]]> \u{1} \u{ffff} <script>";
    figure.title = wild.into();
    figure.x.label = wild.into();
    figure.panels[0].series[0].label = wild.into();
    figure.panels[0].marks.push(Mark { at: 100.0, label: wild.into() });
    figure.note = wild.into();
    let svg = drawn(&figure);
    let document = Document::parse(&svg).unwrap();
    assert!(!document.descendants().any(|node| node.has_tag_name("script")));
    let shown = texts(&svg).into_iter().filter(|text| text.starts_with("a<b & \"c\" > 'd' ]]>")).count();
    assert_eq!(shown, 5, "{svg}");
}

#[test]
fn light_on_paper_and_dark_on_a_dark_screen() {
    let svg = drawn(&parabola());
    assert!(svg.contains("@media screen and (prefers-color-scheme: dark)"));
    for colour in ["#ffffff", "#1a1a1a", "#0072b2"] {
        assert!(svg.contains(&format!("=\"{colour}\"")), "{colour}");
    }
    // Every class that is used has its dark colour.
    let style = svg.split("<style>").nth(1).unwrap().split("</style>").next().unwrap();
    let document = Document::parse(&svg).unwrap();
    let classes: Vec<&str> = document.descendants().filter_map(|node| node.attribute("class")).collect();
    assert!(classes.len() > 3);
    assert!(classes.iter().all(|class| style.contains(&format!(".{class} {{"))), "{classes:?}");
    // What has a colour has a class.
    let painted = document.descendants().filter(|node| {
        ["fill", "stroke"].iter().any(|name| node.attribute(*name).is_some_and(|value| value != "none"))
    });
    assert!(painted.clone().count() > 3 && painted.clone().all(|node| node.attribute("class").is_some()));
    let image = Pixmap::decode_png(&png::render(parabola(), &Look::default(), 400).unwrap()).unwrap();
    let corner = image.pixel(0, 0).unwrap();
    assert_eq!((corner.red(), corner.green(), corner.blue(), corner.alpha()), (255, 255, 255, 255));
}

#[test]
fn a_png_has_its_size_and_letters() {
    let image =
        |figure: &Figure| Pixmap::decode_png(&png::render(figure.clone(), &Look::default(), 900).unwrap()).unwrap();
    let (plain, mut other) = (image(&parabola()), parabola());
    let layout = Layout::new(&other, &Look::default());
    assert_eq!(plain.width(), 900);
    assert!((f64::from(plain.height()) - 900.0 * layout.height / WIDTH).abs() <= 1.0);
    other.title = "U".into();
    let differing = |other: &Pixmap| {
        let pairs = plain.pixels().iter().zip(other.pixels()).enumerate();
        pairs.filter(|(_, (one, other))| one != other).map(|(at, _)| at / 900).collect::<Vec<_>>()
    };
    let rows = differing(&image(&other));
    assert!(rows.len() > 10 && rows.iter().all(|row| *row < 40), "{rows:?}");
    // A raised minus comes from another face than the letters around it.
    other = parabola();
    other.panels[0].y.unit = "10⁻".into();
    let mut unknown = parabola();
    unknown.panels[0].y.unit = "10\u{e123}".into();
    assert_ne!(image(&other), image(&unknown), "both are drawn as the box of a missing letter");
    for width in [0, 10_001, u32::MAX] {
        assert!(png::render(parabola(), &Look::default(), width).unwrap_err().to_string().contains(&width.to_string()));
    }
}

#[test]
fn the_same_figure_is_the_same_bytes() {
    let build = || {
        let mut grid = Density::new([660.0, 750.0], [90.0, 230.0]);
        sweep(2000, 100, |rpm, phase| grid.push(rpm, phase));
        impact_diagram("D", grid, &[], None)
    };
    assert_eq!(svg::render(&build(), &Look::default()).unwrap(), svg::render(&build(), &Look::default()).unwrap());
    assert_eq!(
        png::render(build(), &Look::default(), 500).unwrap(),
        png::render(build(), &Look::default(), 500).unwrap()
    );
    let json = serde_json::to_string(&build()).unwrap();
    assert!(
        json.contains("\"density\"") && json.contains("\"cam speed ω\"") && json.len() < 2_000_000,
        "{}",
        json.len()
    );
}
