//! `chart`: each point is what a run comes to, by whatever way the points are asked for.

use approx::assert_relative_eq;
use serde_json::Value;

use crate::common;

const MODEL: &str = "models/osorio-2008.toml";
const COLUMNS: &str = "x,y,class,revolutions,impacts,growth_rate,growth_error,impact_speed_m_s,impacts_per_revolution";

fn prints(arguments: &[&str]) -> String {
    let output = common::corner_impact(arguments);
    let complaints = common::text(output.stderr);
    assert_eq!((output.status.code(), complaints.as_str()), (Some(0), ""), "{arguments:?}");
    common::text(output.stdout)
}

fn refused(arguments: &[&str]) -> String {
    let output = common::corner_impact([&["chart", MODEL], arguments].concat());
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    common::text(output.stderr)
}

/// The rows of a chart, by cells.
fn chart(arguments: &[&str]) -> Vec<Vec<String>> {
    let table = prints(&[&["chart", MODEL, "--out", "-"], arguments].concat());
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some(COLUMNS));
    lines.map(|line| line.split(',').map(String::from).collect()).collect()
}

fn number(cell: &str) -> f64 {
    cell.parse().unwrap()
}

/// The fastest impact of revolutions that a simulation runs after others, of follower and cam against each other, m/s.
fn fastest(rpm: &str, after: u64) -> f64 {
    let events = prints(&["simulate", MODEL, "--rpm", rpm, "--revolutions", "400", "--events", "-"]);
    let rows = events.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    let impacts = rows.filter(|row| row[3] == "impact" && row[0].parse::<u64>().unwrap() >= after);
    impacts.map(|row| number(row[7]) - number(row[5])).fold(0.0, f64::max)
}

/// A stable orbit, chaos, a follower that rests in each turn and one that never leaves the cam.
#[test]
fn a_point_is_what_the_run_comes_to() {
    let row = |rpm: &str| {
        let [x, y] = [format!("rpm={rpm}:{rpm}:1"), "restitution=0.8:0.8:1".to_owned()];
        let rows = chart(&["--x", &x, "--y", &y]);
        assert_eq!(rows.len(), 1);
        assert_eq!([number(&rows[0][0]), number(&rows[0][1])], [number(rpm), 0.8]);
        rows[0][2..].to_vec()
    };
    let periodic = row("700");
    assert_eq!(periodic[..3], ["periodic", "1", "1"]);
    // Both multipliers have the modulus r, as their product is r^2.
    assert_relative_eq!(number(&periodic[3]), 0.8_f64.ln(), max_relative = 1e-10);
    assert_eq!(periodic[4], "0");
    assert_relative_eq!(number(&periodic[5]), fastest("700", 300), max_relative = 1e-9);
    assert_eq!(periodic[6], "1");
    let chaotic = row("670");
    assert_eq!(chaotic[..3], ["chaotic", "0", "0"]);
    let (growth, error) = (number(&chaotic[3]), number(&chaotic[4]));
    let long = prints(&["simulate", MODEL, "--rpm", "670", "--revolutions", "20000", "--lyapunov", "--summary"]);
    let long = serde_json::from_str::<Value>(&long).unwrap()["lyapunov_per_revolution"].as_f64().unwrap();
    assert!((growth - long).abs() < 4.0 * error && error < 0.2 * growth, "{growth} +- {error}, {long}");
    let resting = row("183");
    assert_eq!((&resting[0][..], &resting[1][..], &resting[3][..]), ("resting", "1", "-inf"));
    let impacts = prints(&["simulate", MODEL, "--rpm", "183", "--revolutions", "100", "--events", "-"]);
    let last = impacts.lines().filter(|line| line.starts_with("90,") && line.contains(",impact,")).count();
    assert_eq!(resting[2], last.to_string());
    assert_relative_eq!(number(&resting[5]), fastest("183", 90), max_relative = 1e-9);
    assert_eq!(row("50")[..6], ["stays", "1", "0", "-inf", "0", "0"]);
}

/// The points of a part of a chart, of one with its axes exchanged, and on another number of threads, are those of the whole.
#[test]
fn points_are_the_same_in_any_order_and_company() {
    let (x, y) = ("rpm=640:760:13", "restitution=0.5:0.95:10");
    let whole = chart(&["--x", x, "--y", y, "--threads", "1"]);
    assert_eq!(whole.len(), 130);
    assert_eq!(whole, chart(&["--x", x, "--y", y, "--threads", "2"]));
    let point = |row: &[String]| row[2..].to_vec();
    let exchanged = chart(&["--x", y, "--y", x]);
    for (index, row) in exchanged.iter().enumerate() {
        let there = &whole[(index % 10) * 13 + index / 10];
        assert_eq!((&row[0], &row[1], point(row)), (&there[1], &there[0], point(there)));
    }
    let part = chart(&["--x", "rpm=700:760:7", "--y", "restitution=0.95:0.95:1"]);
    let last_row: Vec<_> = whole[whole.len() - 7..].iter().map(|row| point(row)).collect();
    assert_eq!(part.iter().map(|row| point(row)).collect::<Vec<_>>(), last_row);
    let classes: std::collections::BTreeSet<&str> = whole.iter().map(|row| row[2].as_str()).collect();
    assert!(classes.is_superset(&["periodic", "chaotic", "resting"].into()), "{classes:?}");
}

/// Where the model cannot be, a point has failed, and the others are as they are; without a speed on an axis there is one for all.
#[test]
fn impossible_machines_are_points_of_their_own() {
    let sides = ["--x", "mass=1:1.5:2", "--y", "nose_end_deg=160:200:2", "--rpm", "700"];
    let rows = chart(&sides);
    let classes: Vec<&str> = rows.iter().map(|row| row[2].as_str()).collect();
    assert_eq!(classes[2..], ["failed", "failed"]);
    assert!(classes[..2].iter().all(|class| *class != "failed"), "{classes:?}");
    let summary: Value = serde_json::from_str(&prints(&[&["chart", MODEL, "--summary"], &sides[..]].concat())).unwrap();
    assert_eq!((&summary["schema"], &summary["points"]), (&"corner-impact/chart/1".into(), &4.into()));
    assert_eq!(summary["revolutions"], 4 * 400);
    assert_eq!(summary["classes"].as_array().unwrap().last().unwrap()["class"], "failed");
    assert!(summary["cpu_s"].as_f64().is_some() && summary["wall_s"].as_f64().is_some());
    let page = prints(&[&["chart", MODEL], &sides[..]].concat());
    assert!(page.contains("the first that failed: models/osorio-2008.toml: cam.nose_end_deg = 200: must be"), "{page}");
}

#[test]
fn what_is_no_chart_is_refused_with_a_reason() {
    let (x, y) = ("rpm=600:760:3", "restitution=0.5:0.95:3");
    assert!(refused(&["--x", x, "--y", x]).contains("a chart is over two numbers"));
    assert!(refused(&["--x", "mass=1:2:2", "--y", y]).contains("neither axis is rpm"));
    assert!(refused(&["--x", x, "--y", y, "--rpm", "700"]).contains("no axis is rpm"));
    assert!(refused(&["--x", x, "--y", "restitutoin=0:1:2"]).contains("did you mean restitution?"));
    assert!(refused(&["--x", "rpm=600:760", "--y", y]).contains("must be LO:HI:N"));
    assert!(refused(&["--x", "rpm=760:600:3", "--y", y]).contains("is below the lowest"));
    assert!(refused(&["--x", "rpm=-5:600:3", "--y", y]).contains("above 0"));
    assert!(refused(&["--x", "rpm=600:760:100000", "--y", "mass=1:2:100000"]).contains("100000000 or fewer"));
    assert!(refused(&["--x", x, "--y", y, "--out", "a.pdf"]).contains(".csv, .svg or .png"));
}
