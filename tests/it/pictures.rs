//! Can figures be read in a column of 85 mm, and do scripts draw the same ones?

use std::path::Path;

use corner_impact::model::{Model, OSORIO_2008};
use corner_impact_cli::figures::{Effort, FigureContext, plates};
use corner_impact_plot::layout::{Layout, TEXT, width};
use corner_impact_plot::{
    Colour, Data, Density, Figure, FigureAxis, LegendPlace, Look, Marker, Panel, Series, Stroke, TickSpacing, svg,
};

use crate::common;

/// Height of a row of a legend.
const ROW: f64 = 15.0;

fn column() -> Look {
    Look { width: Some(85.0 * 72.0 / 25.4), ..Look::default() }
}

/// A figure with a line for each label.
fn lines(labels: &[&str], range: [f64; 2], height: f64) -> Figure {
    let line = |(index, label): (usize, &&str)| {
        let at = index as f64 / labels.len() as f64;
        let y = |share: f64| range[0] + share * (range[1] - range[0]);
        Series::line(label, Colour::Blue, Stroke::Solid, [[0.0, y(at)], [1.0, y(at)]])
    };
    let series = labels.iter().enumerate().map(line).collect();
    let panel = Panel::new(FigureAxis::new("a quantity", "m/s").over(range), height, series);
    Figure::new("a title", FigureAxis::new("time", "s"), vec![panel])
}

/// Rows of a layout's legend: entries at one height are one row.
fn rows(layout: &Layout) -> usize {
    let entries = layout.panels.iter().flat_map(|panel| &panel.legend);
    let mut heights: Vec<i64> = entries.map(|(_, text)| (10.0 * text.at[1]) as i64).collect();
    heights.sort_unstable();
    heights.dedup();
    heights.len()
}

/// Whether the legend takes at most a sixth of a figure, no entry leaves the page, and each axis of numbers has three labels.
fn assert_readable(name: &str, figure: &Figure, look: &Look) {
    let layout = Layout::new(figure, look);
    let legend = ROW * rows(&layout) as f64;
    assert!(6.0 * legend <= layout.height + 0.01, "{name}: a legend of {legend} in {}", layout.height);
    for (_, text) in layout.panels.iter().flat_map(|panel| &panel.legend) {
        assert!(text.at[0] > 0.0 && text.at[0] + width(&text.text, TEXT) <= look.across(), "{name}: {text:?}");
    }
    let up = figure.panels.iter().zip(&layout.panels).map(|(panel, place)| (&panel.y, &place.ticks));
    for (axis, ticks) in up.chain([(&figure.x, &layout.panels[0].across.ticks)]) {
        let is_named = axis.spacing == TickSpacing::Nothing;
        assert!(is_named || ticks.len() >= 3, "{name}, {}: {ticks:?}", axis.label);
    }
}

#[test]
fn a_legend_takes_at_most_a_sixth_of_a_column() {
    let labels: Vec<String> = (0..15).map(|index| format!("a long name, number {index}")).collect();
    for count in 1..=labels.len() {
        let labels: Vec<&str> = labels[..count].iter().map(String::as_str).collect();
        for height in [0.1, 0.3, 0.66] {
            let figure = lines(&labels, [0.0, 1.0], height);
            assert_eq!(Layout::new(&figure, &column()).panels[0].legend.len(), count);
            assert_readable(&format!("{count} entries in {height}"), &figure, &column());
            assert_readable("below", &figure, &Look { legend: LegendPlace::Below, ..column() });
        }
    }
    assert_eq!(rows(&Layout::new(&lines(&["a"], [0.0, 1.0], 0.3), &Look { legend: LegendPlace::None, ..column() })), 0);
}

#[test]
fn an_axis_has_three_labels() {
    // Any part of a decade, at any place, in the lowest frame.
    let spans = (0..60).map(|index| 10_f64.powf(f64::from(index) / 20.0 - 1.0));
    for (index, span) in spans.enumerate() {
        for part in 0..7 {
            let low = span * (f64::from(part) / 7.0 + f64::from(index as u32 % 5));
            let figure = lines(&["a"], [low, low + span], 0.08);
            let figure = Figure { x: FigureAxis::new("time", "s").over([low, low + span]), ..figure };
            assert_readable(&format!("{low} and {span} above"), &figure, &column());
            let mut degrees = figure.clone();
            (degrees.x, degrees.panels[0].y.spacing) =
                (FigureAxis::degrees("angle").over([low, low + span]), TickSpacing::Degrees);
            assert_readable(&format!("{low} degrees and {span} above"), &degrees, &column());
            let mut powers = figure;
            powers.panels[0].y.spacing = TickSpacing::Logarithmic;
            powers.panels[0].y.range = Some([low.min(5.0), low.min(5.0) + span.min(20.0)]);
            assert_readable(&format!("decades from {low}, {span} of them"), &powers, &column());
        }
    }
}

#[test]
fn a_legend_names_what_is_inside_the_frame() {
    let mut cells = Density::new([0.0, 1.0], [0.0, 1.0]);
    cells.push(0.9, 0.9);
    let region = Series::new("region", Colour::Green, Data::Region { cells, strength: 0.5 });
    let point = Series::points("point", Colour::Ink, Marker::Disc, [[0.8, 0.8]]);
    let outside = Series::line("outside", Colour::Blue, Stroke::Solid, [[0.6, 0.0], [1.0, 1.0]]);
    let through = Series::line("through", Colour::Blue, Stroke::Solid, [[0.0, 0.2], [1.0, 0.2]]);
    let band = Series::band("band", Colour::Grey, [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0]]);
    let panel = Panel::new(FigureAxis::new("y", "").over([0.0, 1.0]), 0.5, vec![region, point, outside, through, band]);
    let figure = |ends| Figure::new("", FigureAxis::new("x", "").over(ends), vec![panel.clone()]);
    let names = |ends| -> Vec<String> {
        Layout::new(&figure(ends), &column()).panels[0].legend.iter().map(|(_, text)| text.text.clone()).collect()
    };
    assert_eq!(names([0.0, 1.0]), ["region", "point", "outside", "through", "band"]);
    assert_eq!(names([0.2, 0.5]), ["through", "band"]);
}

/// The height is as asked, or there is a reason; and so is the place of the legend.
#[test]
fn a_figure_is_as_high_as_asked() {
    let figure = lines(&["one", "other"], [0.0, 1.0], 0.5);
    for height in [150.0, 200.0, 400.0] {
        for legend in [LegendPlace::None, LegendPlace::Above, LegendPlace::Below, LegendPlace::Right] {
            let look = Look { height: Some(height), legend, ..column() }.checked().unwrap();
            let text = svg::render(&look.framed(figure.clone()).unwrap(), &look).unwrap();
            let written = text.split("height=\"").nth(1).unwrap().split("pt\"").next().unwrap();
            assert!((written.parse::<f64>().unwrap() - height).abs() < 1.0, "{height}: {written}");
            assert_eq!(text.contains(">other</text>"), legend != LegendPlace::None);
        }
    }
    let low = Look { height: Some(60.0), ..column() }.framed(figure).unwrap_err().to_string();
    assert!(low.contains("cannot be 21.2 mm high") && low.contains("it needs"), "{low}");
    let long = lines(&["a name that is longer than half of the column"], [0.0, 1.0], 0.5);
    let right = Look { legend: LegendPlace::Right, ..column() }.framed(long).unwrap_err().to_string();
    assert!(right.contains("leaves no room") && right.contains("--legend below"), "{right}");
}

/// A curve over regions has a rim in the colour of the paper, in ink that none of them has; on paper alone it has none.
#[test]
fn curves_contrast_with_what_is_behind() {
    let curve = Series::line("fold", Colour::Ink, Stroke::Solid, [[0.0, 0.0], [1.0, 1.0]]);
    let mut cells = Density::new([0.0, 1.0], [0.0, 1.0]);
    (0..1000).for_each(|index| cells.push(f64::from(index) / 1000.0, 0.5));
    let region = Series::new("chaotic", Colour::Vermilion, Data::Region { cells, strength: 0.75 });
    let drawn = |series| {
        let panel = Panel::new(FigureAxis::new("y", ""), 0.5, series);
        svg::render(&Figure::new("", FigureAxis::new("x", ""), vec![panel]), &column()).unwrap()
    };
    let over = drawn(vec![region, curve.clone()]);
    let (rim, line) =
        (over.find("stroke=\"#ffffff\" stroke-width=\"4.1\"").unwrap(), over.find("stroke-width=\"1.5\"").unwrap());
    assert!(rim < line, "the rim is below the curve: {over}");
    assert!(!drawn(vec![curve]).contains("stroke=\"#ffffff\""));
}

#[test]
#[ignore = "slow"]
fn every_figure_of_the_report_is_readable_in_a_column() {
    let model = Model::parse("osorio-2008.toml", OSORIO_2008).unwrap();
    let mut subject = FigureContext::new(&model, None).unwrap();
    subject.slow_effort = Effort { speeds: 40, transient: 60, record: 8 };
    subject.fast_effort = subject.slow_effort;
    for plate in plates(&subject, &mut |_, _| {}) {
        assert_readable(plate.id, &plate.drawn.unwrap().figure, &column());
    }
}

/// Commands that draw, each with what it draws.
const DRAWN: [&str; 17] = [
    "design",
    "design --limit impact-speed=0.5m/s --limit force=500N",
    "design --rpm 200",
    "design --need no_separation_to_200_rpm --over mass=1:2:5",
    "speeds models/damped-heavy.toml --rpm 300:320 --speeds 20",
    "speeds --rpm 640:700 --speeds 20 --starts 8",
    "chart --over rpm=600:760:30 --over restitution=0.5:0.95:20 --with-curves",
    "chart --over rpm=600:760:12 --over restitution=0.5:0.95:8 --show growth --legend below",
    "continue --rpm 700 --over rpm=660:760 --runs 50",
    "curve --rpm 600:760 --over restitution=0.5:0.95",
    "simulate --rpm 183 --revolutions 5",
    "diagram --rpm 600:760:30",
    "diagram --rpm 660:700:20 --section strobe --lyapunov",
    "basins --rpm 678 --strobe 5.76 --grid 20x15",
    "cam",
    "chaos --rpm 670",
    "figure composition --title",
];

/// Each command writes a picture of 85 mm with its script; the scripts run, and what they draw is readable and has all data. Without
/// matplotlib they are compiled alone, and the test says so.
#[test]
#[ignore = "slow"]
fn scripts_draw_every_figure() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: String| folder.path().join(name).to_str().unwrap().to_owned();
    let mut scripts = Vec::new();
    for (index, line) in DRAWN.iter().enumerate() {
        let [picture, script] = [file(format!("{index}.svg")), file(format!("{index}.py"))];
        let looks = ["--out", &picture, "--width", "85mm", "--script", &script];
        let words = line.split(' ').map(|word| word.replace('_', " ")).chain(looks.map(str::to_owned));
        let output = common::corner_impact(words);
        assert_eq!(output.status.code(), Some(0), "{line}: {}", common::text(output.stderr));
        assert!(Path::new(&script).with_extension("csv").is_file(), "{line}");
        scripts.push(script);
    }
    let python = Path::new(common::ROOT).join(".venv/bin/python");
    assert!(python.is_file(), "run `make test`, which sets up .venv");
    let run =
        |first: &[&str], rest: &[String]| std::process::Command::new(&python).args(first).args(rest).output().unwrap();
    let has = run(&["-c", "import matplotlib"], &[]).status.success();
    if !has {
        println!("matplotlib is not installed: the scripts are compiled and not run");
    }
    let checker = Path::new(common::ROOT).join("tests/it/pictures.py");
    let first = if has { vec![checker.to_str().unwrap()] } else { vec!["-m", "py_compile"] };
    let output = run(&first, &scripts);
    assert!(output.status.success(), "{}", common::text(output.stderr));
    assert!(!has || common::text(output.stdout).trim() == DRAWN.len().to_string());
}

/// A script and its data, or neither.
#[test]
fn a_script_comes_with_its_data() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let line = format!(
        "cam models/laws/harmonic.toml --out {} --script {}",
        path("cam.svg").display(),
        path("cam.py").display()
    );
    let output = common::corner_impact(line.split(' '));
    assert_eq!(output.status.code(), Some(0), "{}", common::text(output.stderr));
    let [script, data] = ["cam.py", "cam.csv"].map(|name| std::fs::read_to_string(path(name)).unwrap());
    assert!(script.contains("DATA = \"cam.csv\"") && script.lines().count() < 150, "{script}");
    assert!(data.starts_with("panel,series,kind,x,y,count,width,height,panel_number,series_number\n"), "{data:.100}");
    // The picture cannot be, so there is no script either.
    for name in ["cam.svg", "cam.py", "cam.csv"] {
        std::fs::remove_file(path(name)).unwrap();
    }
    std::fs::create_dir(path("cam.csv")).unwrap();
    assert_eq!(common::corner_impact(line.split(' ')).status.code(), Some(2));
    let output = common::corner_impact(format!("{line} --height 10pt").split(' '));
    assert_eq!(output.status.code(), Some(2));
    assert!(!path("cam.svg").exists() && !path("cam.py").exists());
}

/// A curve of loads bends between the speeds of the table, which stay what they are without a picture.
#[test]
fn loads_are_drawn_from_more_speeds_than_the_table_has() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [picture, script] = [path("loads.svg"), path("loads.py")];
    let plain = common::corner_impact(["design", "--json", "--limit", "impact-speed=0.5m/s"]);
    let drawn = ["design", "--json", "--limit", "impact-speed=0.5m/s", "--out", &picture, "--script", &script];
    let drawn = common::corner_impact(drawn);
    assert_eq!(drawn.status.code(), Some(0), "{}", common::text(drawn.stderr));
    assert_eq!(common::text(plain.stdout), common::text(drawn.stdout));
    let data = std::fs::read_to_string(path("loads.csv")).unwrap();
    let of = |panel: usize, series: usize| -> Vec<[f64; 2]> {
        let rows = data.lines().filter(|line| line.ends_with(&format!(",{panel},{series}")));
        let number =
            |row: &str, from_the_end: usize| row.rsplit(',').nth(from_the_end).unwrap().parse::<f64>().unwrap();
        rows.map(|row| [number(row, 6), number(row, 5)]).collect()
    };
    let (greatest, least, impacts) = (of(0, 0), of(0, 1), of(1, 0));
    assert!(greatest.len() >= 241 && least.len() == greatest.len() && impacts.len() > 100, "{}", impacts.len());
    for points in [&greatest, &least, &impacts] {
        assert!(points.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    }
    assert!(greatest.iter().zip(&least).all(|(most, least)| most[1] >= least[1]));
    // The limit's line, and the ring where it is first exceeded.
    assert!(of(1, 1).iter().all(|[_, value]| *value == 0.5) && of(1, 1).len() == 2, "{:?}", of(1, 1));
    let [[passed, _]] = of(1, 3)[..] else { panic!("{:?}", of(1, 3)) };
    let below = impacts.iter().filter(|[rpm, _]| *rpm < 0.998 * passed).all(|[_, speed]| *speed < 0.5);
    assert!(below && impacts.iter().any(|[rpm, speed]| *rpm > passed && *speed > 0.5), "{passed}");
}

/// Between two speeds of the table the band of ± is linearly between those that the table has.
#[test]
fn the_band_of_loads_is_that_of_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let valve = folder.path().join("valve.toml").display().to_string();
    assert_eq!(common::corner_impact(["new", &valve, "--law", "table"]).status.code(), Some(0));
    let [_, data] = script(&format!("design {valve} --rpm 2000:2800 --speeds 3"));
    let number = |row: &str, from_the_end: usize| row.rsplit(',').nth(from_the_end).unwrap().parse::<f64>().unwrap();
    let rows: Vec<&str> = data.lines().filter(|row| row.contains(",band,") && row.ends_with(",0,0")).collect();
    let width = |rpm: f64| number(rows.iter().find(|row| number(row, 6) == rpm).unwrap(), 2);
    for [low, middle, high] in [[2000.0, 2200.0, 2400.0], [2400.0, 2600.0, 2800.0]] {
        assert!(width(low) < width(high));
        approx::assert_relative_eq!(width(middle), 0.5 * (width(low) + width(high)), max_relative = 1e-7);
    }
}

/// Runs a command that draws, and returns its script and its data.
fn script(line: &str) -> [String; 2] {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let line = format!("{line} --out {} --script {}", path("it.svg").display(), path("it.py").display());
    let output = common::corner_impact(line.split(' '));
    assert_eq!(output.status.code(), Some(0), "{line}: {}", common::text(output.stderr));
    ["it.py", "it.csv"].map(|name| std::fs::read_to_string(path(name)).unwrap())
}

/// Where the follower leaves the cam at the low end of a range, the greatest force goes on by rising values.
#[test]
fn the_greatest_force_is_one_curve() {
    let [_, data] = script("design models/preloaded.toml --rpm 126 --over stiffness=300:3000:6");
    let greatest = data.lines().filter(|line| line.ends_with(",0,0"));
    let places: Vec<f64> = greatest.map(|row| row.rsplit(',').nth(6).unwrap().parse().unwrap()).collect();
    assert!(places.len() >= 241 && places.windows(2).all(|pair| pair[0] < pair[1]), "{places:?}");
}

/// The vertical axis of `continue` spans the branches, also where runs settle elsewhere.
#[test]
fn branches_fill_their_axis() {
    let [script, data] = script("continue --rpm 700 --over rpm=690:710 --runs 40");
    let panel = script.split("PANELS = [").nth(1).unwrap();
    let range = panel.split("\"range\": (").nth(1).unwrap().split(')').next().unwrap();
    let ends: Vec<f64> = range.split(", ").map(|end| end.parse().unwrap()).collect();
    let lines = data.lines().filter(|line| line.contains(",line,"));
    let angles: Vec<f64> =
        lines.filter_map(|line| line.split(",line,").nth(1)?.split(',').nth(1)?.parse().ok()).collect();
    let [low, high] = corner_impact_plot::extent(angles);
    assert!(ends[0] <= low && high <= ends[1] && ends[1] - ends[0] < 1.2 * (high - low), "{ends:?}: {low} to {high}");
}

/// Curves of events are in ink: no class of a chart is, at full strength.
#[test]
fn curves_of_events_are_in_ink() {
    let [script, _] = script("curve --rpm 600:760 --over restitution=0.5:0.95");
    let lines: Vec<&str> = script.lines().filter(|line| line.contains("\"kind\": \"line\"")).collect();
    assert!(lines.len() > 3 && lines.iter().all(|line| line.contains("#1a1a1a")), "{lines:?}");
}

/// An attractor that only one of the speeds has would be a line of no length.
#[test]
#[ignore = "slow"]
fn the_share_of_an_attractor_of_one_speed_is_a_point() {
    let folder = tempfile::TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let words = ["speeds", "--rpm", "600:760", "--speeds", "5", "--starts", "8", "--out"];
    let words = words.map(String::from).into_iter().chain([at("speeds.svg"), "--script".into(), at("speeds.py")]);
    assert_eq!(common::corner_impact(words).status.code(), Some(0));
    let rows = std::fs::read_to_string(folder.path().join("speeds.csv")).unwrap();
    let kinds = |attractor: &str| -> Vec<&str> {
        let rows = rows.lines().filter(|row| row.contains("share of starts") && row.contains(attractor));
        rows.map(|row| row.rsplit("\",").next().unwrap().split(',').next().unwrap()).collect()
    };
    assert_eq!(kinds("\"A1\""), ["line"; 3]);
    assert!(kinds("\"A4\"").iter().all(|kind| *kind == "point"), "{:?}", kinds("\"A4\""));
    assert_eq!(kinds("\"A4\"").len(), 1);
}
