//! Do `simulate`, `diagram` and `cam` keep their contract: columns, fields, streams, and one answer however asked?

use std::f64::consts::TAU;
use std::path::Path;

use crate::common;
use approx::assert_relative_eq;
use serde_json::Value;
use tempfile::TempDir;

const MODEL: &str = "models/osorio-2008.toml";
const EVENTS: &str =
    "revolution,time_s,cam_angle_rad,event,position_m,velocity_before_m_s,velocity_after_m_s,cam_velocity_m_s";
const STROBE: &str = "revolution,position_m,velocity_m_s,gap_m,contact";
const IMPACTS: &str = "rpm,revolution,cam_angle_rad,event,position_m,velocity_before_m_s,velocity_after_m_s";

/// Standard output of a command that is done and has nothing to complain about.
#[track_caller]
fn prints(arguments: &[&str]) -> String {
    let output = common::corner_impact(arguments);
    let complaints = common::text(output.stderr);
    assert_eq!((output.status.code(), complaints.as_str()), (Some(0), ""), "{arguments:?}");
    common::text(output.stdout)
}

#[track_caller]
fn document(arguments: &[&str]) -> Value {
    serde_json::from_str(&prints(arguments)).unwrap()
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// The rows under a header, by cells.
#[track_caller]
fn rows(table: &str, header: &str) -> Vec<Vec<String>> {
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some(header));
    assert!(table.ends_with('\n'));
    let rows: Vec<Vec<String>> = lines.map(|line| line.split(',').map(String::from).collect()).collect();
    assert!(rows.iter().all(|row| row.len() == header.split(',').count()), "{table}");
    rows
}

fn number(cell: &str) -> f64 {
    let number: f64 = cell.parse().unwrap_or_else(|error| panic!("{cell}: {error}"));
    // The fewest digits that read back as the same number.
    assert_eq!(cell, format!("{number}"));
    number
}

/// At 183 rpm the follower bounces, sticks and is let go, turn after turn.
#[test]
fn events_have_the_columns_of_the_contract() {
    let start_angle = 0.5;
    let simulate = ["simulate", MODEL, "--rpm", "183", "--revolutions", "20", "--start-angle", "0.5", "--events", "-"];
    let rows = rows(&prints(&simulate), EVENTS);
    let omega = 183.0 * TAU / 60.0;
    let mut last = 0.0;
    for kind in ["impact", "stick", "release"] {
        assert!(rows.iter().filter(|row| row[3] == kind).count() >= 10, "{kind}: {}", rows.len());
    }
    for row in &rows {
        let revolution: u64 = row[0].parse().unwrap();
        let (time, angle) = (number(&row[1]), number(&row[2]));
        assert!((0.0..TAU).contains(&angle) && revolution <= 20 && time >= last, "{row:?}");
        last = time;
        let expected = (revolution as f64 * TAU + angle - start_angle) / omega;
        assert!((time - expected).abs() <= 1e-15 * (1.0 + revolution as f64 * TAU / omega), "{row:?}: {expected}");
        let [before, after, cam] = [5, 6, 7].map(|column| number(&row[column]));
        number(&row[4]);
        match row[3].as_str() {
            "impact" => assert!((after - cam + 0.8 * (before - cam)).abs() < 1e-13 && before < cam, "{row:?}"),
            "stick" | "release" => assert!(before == after && after == cam, "{row:?}"),
            other => panic!("{other}"),
        }
    }
}

#[test]
fn a_summary_has_the_fields_of_the_contract() {
    let arguments = ["simulate", MODEL, "--rpm", "183", "--revolutions", "20", "--summary"];
    let summary = document(&arguments);
    for field in ["schema", "revolutions", "impacts", "sticks", "releases", "final", "wall_s"] {
        assert!(keys(&summary).contains(&field), "{field}: {summary}");
    }
    assert_eq!(summary["schema"], "corner-impact/simulate/1");
    assert_eq!(summary["revolutions"], 20.0);
    for field in ["cam_angle_rad", "position_m", "velocity_m_s"] {
        assert!(summary["final"][field].is_f64(), "{field}: {summary}");
    }
    assert_eq!(summary["final"]["cam_angle_rad"], 0.0);
    assert!(summary["wall_s"].as_f64().unwrap() > 0.0);
    let events = rows(&prints(&["simulate", MODEL, "--rpm", "183", "--revolutions", "20", "--events", "-"]), EVENTS);
    for (field, kind) in [("impacts", "impact"), ("sticks", "stick"), ("releases", "release")] {
        assert_eq!(summary[field], events.iter().filter(|row| row[3] == kind).count(), "{field}");
    }
    let page = prints(&arguments[..6]);
    assert!(page.contains("20 revolutions") && page.contains(&format!("impacts {}", summary["impacts"])), "{page}");
}

/// A run up to N impacts has N of them, the last one at its end.
#[test]
fn a_run_may_be_given_by_its_impacts() {
    for count in ["0", "1", "7", "5000"] {
        for rpm in ["183", "700"] {
            let arguments = ["simulate", MODEL, "--rpm", rpm, "--impacts", count];
            let events = rows(&prints(&[&arguments[..], &["--events", "-"]].concat()), EVENTS);
            let impacts: Vec<_> = events.iter().filter(|row| row[3] == "impact").collect();
            assert_eq!(impacts.len().to_string(), count, "{rpm} rpm");
            let summary = document(&[&arguments[..], &["--summary"]].concat());
            assert_eq!(summary["impacts"].to_string(), count);
            let Some(last) = impacts.last() else { continue };
            // Up to where infinitely many more end, if the last leads to that.
            let end = summary["final"]["cam_angle_rad"].as_f64().unwrap();
            assert!((end - number(&last[2])).abs() < 1e-6, "{rpm} rpm, {count}: {end} {last:?}");
        }
    }
}

#[test]
fn states_are_those_at_one_angle() {
    let strobe = ["--strobe", "1.25", "--strobe-out", "-"];
    let simulate = ["simulate", MODEL, "--rpm", "183", "--revolutions", "30"];
    let states = rows(&prints(&[&simulate[..], &strobe].concat()), STROBE);
    assert_eq!(states.len(), 30);
    for (index, row) in states.iter().enumerate() {
        assert_eq!(row[0], index.to_string());
        let [position, _, gap] = [1, 2, 3].map(|column| number(&row[column]));
        // The base circle.
        assert!((position - gap - 0.4).abs() < 1e-15 && gap >= 0.0, "{row:?}");
        assert_eq!(row[4], (gap == 0.0).to_string(), "{row:?}");
    }
    // Those of a diagram of one speed, to the last digit.
    let diagram = ["diagram", MODEL, "--rpm", "183:183:1", "--transient", "0", "--record", "30"];
    let section = ["--section", "strobe", "--strobe", "1.25", "--out", "-"];
    let table = prints(&[&diagram[..], &section].concat());
    let expected: Vec<_> = states.iter().map(|row| ["183", &row[0], &row[1], &row[2]].map(String::from)).collect();
    assert_eq!(rows(&table, "rpm,revolution,position_m,velocity_m_s"), expected);
}

#[test]
fn the_rows_of_a_diagram_are_the_events_of_its_runs() {
    let (low, high, count) = (64.1, 320.2, 7);
    let start = ["--relative-velocity", "1"];
    let diagram = ["diagram", MODEL, "--rpm", "64.1:320.2:7", "--transient", "0", "--record", "5", "--out", "-"];
    let found = rows(&prints(&[&diagram[..], &start].concat()), IMPACTS);
    let mut expected = Vec::new();
    for index in 0..count {
        let rpm = if index == 6 { high } else { low + (high - low) * (f64::from(index) / 6.0) };
        let rpm = format!("{rpm}");
        let simulate = ["simulate", MODEL, "--rpm", &rpm, "--revolutions", "5", "--events", "-"];
        let events = rows(&prints(&[&simulate[..], &start].concat()), EVENTS);
        let row = |row: Vec<String>| {
            let [revolution, _, angle, kind, position, before, after, _]: [String; 8] = row.try_into().unwrap();
            vec![rpm.clone(), revolution, angle, kind, position, before, after]
        };
        expected.extend(events.into_iter().map(row));
    }
    assert_eq!(found, expected);
    // Both ends of the range are speeds of it, as typed, though 64.1 + (320.2 - 64.1) is another number.
    assert_eq!((found[0][0].as_str(), found.last().unwrap()[0].as_str()), ("64.1", "320.2"));
}

#[test]
#[ignore = "slow"]
fn rows_are_the_same_for_every_number_of_threads() {
    for start in ["fixed", "up", "down"] {
        let table = |threads: &str| {
            let sweep = ["diagram", MODEL, "--rpm", "150:240:37", "--transient", "20", "--record", "20"];
            prints(&[&sweep[..], &["--start", start, "--threads", threads, "--out", "-"]].concat())
        };
        let one = table("1");
        assert!(one.lines().count() > 1000);
        assert_eq!(table("2"), one, "{start}");
        assert_eq!(table("5"), one, "{start}");
        let speeds: Vec<f64> = rows(&one, IMPACTS).iter().map(|row| number(&row[0])).collect();
        let ordered =
            speeds.windows(2).all(|pair| if start == "down" { pair[0] >= pair[1] } else { pair[0] <= pair[1] });
        assert!(ordered, "{start}");
    }
}

/// From where two orbits attract, a sweep up keeps to the one that it comes with, and a sweep down to the other.
#[test]
fn a_sweep_goes_on_from_its_neighbour() {
    let table = |start: &str| {
        let sweep = ["diagram", MODEL, "--rpm", "674:674.2:5", "--transient", "200", "--record", "1", "--out", "-"];
        rows(&prints(&[&sweep[..], &["--start", start]].concat()), IMPACTS)
    };
    let (fixed, up) = (table("fixed"), table("up"));
    let at = |rows: &[Vec<String>], rpm: &str| rows.iter().filter(|row| row[0] == rpm).cloned().collect::<Vec<_>>();
    // The first of the sweep starts as all do, the others do not.
    assert_eq!(at(&up, "674"), at(&fixed, "674"));
    assert_ne!(at(&up, "674.2"), at(&fixed, "674.2"));
}

/// Where the stable orbit and chaos attract, both are recorded whatever the start would have been; above that, one.
#[test]
fn a_diagram_of_attractors_has_each_of_them() {
    let sweep = ["diagram", MODEL, "--rpm", "678:690:2", "--transient", "50", "--record", "40"];
    let table = prints(&[&sweep[..], &["--attractors", "--out", "-"]].concat());
    let rows = rows(&table, &format!("{IMPACTS},attractor"));
    let angles = |rpm: &str, attractor: &str| -> Vec<f64> {
        let of = rows.iter().filter(|row| row[0] == rpm && row[7] == attractor && row[3] == "impact");
        of.map(|row| number(&row[2])).collect()
    };
    let spread = |angles: &[f64]| {
        angles.iter().fold(f64::NEG_INFINITY, |one, angle| one.max(*angle))
            - angles.iter().fold(TAU, |one, angle| one.min(*angle))
    };
    let both = [angles("678", "0"), angles("678", "1")];
    let [orbit, chaos] = if spread(&both[0]) < spread(&both[1]) {
        both
    } else {
        let [one, two] = both;
        [two, one]
    };
    // One impact a revolution, always at the same angle; and impacts all over the cam.
    assert_eq!(orbit.len(), 40);
    assert!(spread(&orbit) < 1e-6 && spread(&chaos) > 3.0, "{orbit:?} {chaos:?}");
    assert!(angles("678", "2").is_empty() && angles("690", "1").is_empty());
    assert_eq!(angles("690", "0").len(), 40);
    let summary = document(&[&sweep[..], &["--attractors", "--summary"]].concat());
    assert_eq!(summary["revolutions"], 3 * 90);
}

#[test]
fn a_diagram_has_a_summary() {
    let sweep = ["diagram", MODEL, "--rpm", "180:190:3", "--transient", "10", "--record", "20", "--threads", "2"];
    let summary = document(&[&sweep[..], &["--summary"]].concat());
    assert_eq!(summary["schema"], "corner-impact/diagram/1");
    assert_eq!(summary["revolutions"], 90);
    assert!(summary["wall_s"].as_f64().unwrap() > 0.0);
    assert_eq!(summary["threads"], 2);
    // One for each speed is as many as there is work for, and followed speeds have work for one.
    for (options, threads) in [(["--threads", "9"], 3), (["--start", "up"], 1)] {
        let sweep = [&sweep[..8], &options, &["--quiet"]].concat();
        assert_eq!(document(&[&sweep[..], &["--summary"]].concat())["threads"], threads, "{options:?}");
        let page = prints(&sweep);
        assert!(page.contains(if threads == 1 { " on 1 thread," } else { " on 3 threads," }), "{page}");
    }
    let table = rows(&prints(&[&sweep[..], &["--out", "-"]].concat()), IMPACTS);
    assert_eq!(summary["points"], table.len());
    assert_eq!(summary["impacts"], table.iter().filter(|row| row[3] == "impact").count());
}

#[test]
fn a_file_says_what_standard_output_says() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (events, states, rows) = (path("events.csv"), path("states.csv"), path("rows.csv"));
    let simulate = ["simulate", MODEL, "--rpm", "183"];
    let both = ["--events", &events, "--strobe", "1", "--strobe-out", &states, "--summary"];
    assert_eq!(document(&[&simulate[..], &both].concat())["schema"], "corner-impact/simulate/1");
    let strobe = ["--strobe", "1", "--strobe-out", "-"];
    assert_eq!(std::fs::read_to_string(&events).unwrap(), prints(&[&simulate[..], &["--events", "-"]].concat()));
    assert_eq!(std::fs::read_to_string(&states).unwrap(), prints(&[&simulate[..], &strobe].concat()));
    let diagram = ["diagram", MODEL, "--rpm", "180:190:3", "--lyapunov", "--out"];
    assert!(prints(&[&diagram[..], &[&rows]].concat()).contains("rows"), "a page for people");
    assert_eq!(std::fs::read_to_string(&rows).unwrap(), prints(&[&diagram[..], &["-"]].concat()));
    let mut names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["events.csv", "rows.csv", "states.csv"]);
}

#[track_caller]
fn is_picture(path: &Path) {
    let bytes = std::fs::read(path).unwrap();
    if path.extension().unwrap() == "svg" {
        let options = resvg::usvg::Options::default();
        let tree = resvg::usvg::Tree::from_data(&bytes, &options).unwrap_or_else(|error| panic!("{path:?}: {error}"));
        assert!(tree.size().width() > 100.0 && tree.root().has_children(), "{path:?}");
    } else {
        let reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        assert_eq!(reader.info().width, 2000, "{path:?}");
    }
}

#[test]
#[ignore = "slow"]
fn pictures_are_pictures() {
    let folder = TempDir::new().unwrap();
    for extension in ["svg", "png"] {
        let path = |name: &str| folder.path().join(format!("{name}.{extension}"));
        let [trace, plane, impacts, strobe] = ["trace", "plane", "impacts", "strobe"].map(path);
        let name = |path: &Path| path.to_str().unwrap().to_owned();
        prints(&["simulate", MODEL, "--rpm", "183", "--trace", &name(&trace), "--phase-plane", &name(&plane)]);
        let sweep = ["diagram", MODEL, "--rpm", "180:190:3", "--lyapunov", "--out"];
        prints(&[&sweep[..], &[&name(&impacts)]].concat());
        prints(&[&sweep[..], &[&name(&strobe), "--section", "strobe"]].concat());
        for path in [trace, plane, impacts, strobe] {
            is_picture(&path);
        }
    }
}

/// At 183 rpm the follower sticks in every revolution, at 700 rpm never.
#[test]
fn an_exponent_of_a_follower_that_sticks_is_minus_infinity() {
    let why = "it rests on the cam";
    let simulate = |rpm| ["simulate", MODEL, "--rpm", rpm, "--lyapunov"];
    let page = prints(&simulate("183"));
    assert!(page.contains("Lyapunov exponent -inf per revolution") && page.contains(why), "{page}");
    assert!(document(&[&simulate("183")[..], &["--summary"]].concat())["lyapunov_per_revolution"].is_null());
    let page = prints(&simulate("700"));
    assert!(page.contains("Lyapunov exponent -0.") && !page.contains(why), "{page}");
    // Of chaos the mean has an error, which falls with the root of the revolutions, more or less.
    let error = |record| {
        let chaos =
            ["simulate", MODEL, "--rpm", "672", "--lyapunov", "--summary", "--patience", "0", "--record", record];
        document(&chaos)["lyapunov_standard_error"].as_f64().unwrap()
    };
    let (short, long) = (error("1000"), error("16000"));
    assert!(short > 0.005 && short < 0.1 && long < 0.6 * short && long > 0.1 * short, "{short} {long}");
    let column = |rpm| {
        let sweep = ["diagram", MODEL, "--rpm", rpm, "--lyapunov", "--out", "-"];
        rows(&prints(&sweep), &format!("{IMPACTS},lyapunov_per_revolution,lyapunov_error"))
    };
    assert!(column("183:183:1").iter().all(|row| row[7] == "-inf"));
    // Where the motion repeats, its multipliers tell: both are 0.8 in modulus.
    let exact = |row: &Vec<String>| (number(&row[7]) - 0.8_f64.ln()).abs() < 1e-12 && row[8] == "0";
    assert!(column("700:700:1").iter().all(exact));
    let chaos = &column("672:672:1")[0];
    assert!(number(&chaos[7]) > 0.0 && number(&chaos[8]) > 0.0 && number(&chaos[8]) < number(&chaos[7]));
    // In a drawing it is said, not drawn.
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("out.svg");
    for (rpm, said) in [("183:184:2", true), ("700:701:2", false)] {
        let sweep = ["diagram", MODEL, "--rpm", rpm, "--record", "5", "--lyapunov", "--out", path.to_str().unwrap()];
        prints(&sweep);
        assert_eq!(std::fs::read_to_string(&path).unwrap().contains("λ = −∞, not drawn"), said, "{rpm}");
    }
}

/// At 183 rpm the follower hops, and rests in between: the force is that which holds it on the cam, 0 in flight and where the cam
/// lets go.
#[test]
fn a_trace_as_a_table_has_gap_and_force() {
    let trace = ["simulate", MODEL, "--rpm", "183", "--revolutions", "30", "--drawn", "1", "--trace", "-"];
    let header = "time_s,cam_angle_rad,position_m,velocity_m_s,gap_m,contact_force_n";
    let table = rows(&prints(&[&trace[..], &["--points-per-revolution", "720"]].concat()), header);
    let table: Vec<Vec<f64>> = table.iter().map(|row| row.iter().map(|cell| number(cell)).collect()).collect();
    assert!(table.len() > 720 && table.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    assert_relative_eq!(table[0][0], 29.0 * 60.0 / 183.0, max_relative = 1e-12);
    assert_relative_eq!(table[table.len() - 1][0], 30.0 * 60.0 / 183.0, max_relative = 1e-12);
    assert!(table.iter().all(|row| row[4] >= 0.0 && row[5] >= -1e-9 && (row[4] == 0.0 || row[5] == 0.0)));
    // On the base circle nothing accelerates: the spring alone presses, k (q - rest).
    let held: Vec<_> = table.iter().filter(|row| row[5] > 0.0 && row[1] < 1.5).collect();
    assert!(held.len() > 10);
    held.iter().for_each(|row| assert_relative_eq!(row[5], 1430.8 * (0.4 - 0.3), max_relative = 1e-9));
    // On the flank the cam's acceleration adds to it, and lets go where it takes all of it away.
    assert!(table.iter().any(|row| row[5] > 1.2 * 143.08));
    assert!(rows(&prints(&trace), header).len() > 360);
}

/// One row a speed: what the run comes to, as in a chart of one row.
#[test]
fn one_row_a_speed_is_a_row_of_a_chart() {
    let range = "660:750:10";
    let found = prints(&["diagram", MODEL, "--rpm", range, "--one-row", "--out", "-"]);
    let chart = ["chart", MODEL, "--x", "rpm=660:750:10", "--y", "restitution=0.8:0.8:1", "--out", "-"];
    let chart = prints(&chart);
    let without = |line: &str| line.split(',').skip(1).collect::<Vec<_>>().join(",");
    let of_chart: Vec<String> = chart.lines().map(|line| without(line).replacen("0.8,", "", 1)).collect();
    assert_eq!(found.lines().skip(1).map(without).collect::<Vec<_>>(), of_chart[1..]);
    assert_eq!(found.lines().nth(1).unwrap().split(',').next(), Some("660"));
    assert!(found.starts_with("rpm,class,revolutions,impacts,growth_rate,growth_error,impact_speed_m_s"));
}

/// `corner-impact … | head` is done with what it was asked for: no complaint, though what is left out is told by the code.
#[test]
fn a_reader_that_has_enough_gets_no_complaint() {
    use std::io::{BufRead, BufReader, Read};
    for arguments in [
        &["simulate", MODEL, "--rpm", "183", "--revolutions", "100000", "--events", "-"][..],
        &["diagram", MODEL, "--rpm", "180:190:1000", "--out", "-"],
    ] {
        let mut child = common::program(arguments)
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        assert!(line.contains("cam_angle_rad"), "{line}");
        let mut complaints = String::new();
        child.stderr.take().unwrap().read_to_string(&mut complaints).unwrap();
        assert_eq!((child.wait().unwrap().code(), complaints.as_str()), (Some(2), ""), "{arguments:?}");
    }
}

#[test]
fn a_cam_as_a_document() {
    for (name, law, corners) in [("osorio-2008", "arcs", 6), ("laws/rectified-sine", "rectified-sine", 2)] {
        let model = format!("models/{name}.toml");
        let cam = document(&["cam", &model, "--json"]);
        assert_eq!((&cam["schema"], &cam["law"]), (&"corner-impact/cam/1".into(), &law.into()));
        assert_eq!(cam["corners"].as_array().unwrap().len(), corners);
        let segments = cam["segments"].as_array().unwrap();
        assert_eq!((&segments[0]["start_deg"], &segments.last().unwrap()["end_deg"]), (&0.0.into(), &360.0.into()));
        for corner in cam["corners"].as_array().unwrap() {
            let (angle, degrees) = (corner["cam_angle_rad"].as_f64().unwrap(), corner["angle_deg"].as_f64().unwrap());
            assert!((0.0..TAU).contains(&angle) && (angle.to_degrees() - degrees).abs() < 1e-12);
        }
        let page = prints(&["cam", &model]);
        assert!(page.contains(&format!("Corners ({corners})")), "{page}");
    }
    // Its slopes jump at two angles; at order 0 nothing does.
    let none = document(&["cam", "models/laws/rectified-sine.toml", "--json", "--order", "0"]);
    assert_eq!(none["corners"].as_array().unwrap().len(), 0);
}
