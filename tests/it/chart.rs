//! `chart`: each point is what a run comes to, by whatever way the points are asked for.

use std::path::Path;

use approx::assert_relative_eq;
use serde_json::Value;

use crate::common;

const MODEL: &str = "models/osorio-2008.toml";
const COLUMNS: &str =
    "x,y,class,revolutions,impacts,growth_rate,growth_error,impact_speed_m_s,impacts_per_revolution,followed";

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
    // What rests again after more than the transient is seen to in what is recorded.
    let late = ["--x", "rpm=500:500:1", "--y", "restitution=0.55:0.55:1"];
    for transient in ["4", "300"] {
        assert_eq!(chart(&[&late[..], &["--transient", transient]].concat())[0][2..5], ["resting", "9", "45"]);
    }
}

/// Nothing draws it down from above the cam, where it swings for ever.
#[test]
fn a_follower_that_floats_has_an_orbit_without_impacts() {
    let point = ["--x", "rpm=700:700:1", "--y", "restitution=0.8:0.8:1"];
    let floats = [&point[..], &["--set", "rest_position=3", "--state", "3.1,0"]].concat();
    assert_eq!(chart(&floats)[0][2..5], ["periodic", "1", "0"]);
}

/// Chaos that rests now and then is told from what is recorded since the last rest.
#[test]
fn chaos_that_rests_now_and_then_is_chaos() {
    let axes = ["--x", "rpm=580:640:12", "--y", "restitution=0.5:0.6:12", "--transient", "4"];
    let rows = chart(&axes);
    let count = |class: &str| rows.iter().filter(|row| row[2] == class).count();
    let (chaotic, undecided) = (count("chaotic"), count("undecided"));
    assert!(chaotic > 120 && undecided < 12, "{chaotic} {undecided}");
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
    let output = common::corner_impact([&["chart", MODEL, "--out", "-"], &sides[..]].concat());
    let table = common::text(output.stdout);
    let classes: Vec<&str> = table.lines().skip(1).map(|row| row.split(',').nth(2).unwrap()).collect();
    assert_eq!(classes[2..], ["failed", "failed"]);
    let said = common::text(output.stderr);
    assert!(said.contains("2 of 4 points could not be run") && said.contains("cam.nose_end_deg = 200"), "{said}");
    assert!(classes[..2].iter().all(|class| *class != "failed"), "{classes:?}");
    let summary: Value = serde_json::from_str(&prints(&[&["chart", MODEL, "--summary"], &sides[..]].concat())).unwrap();
    assert_eq!((&summary["schema"], &summary["points"]), (&"corner-impact/chart/1".into(), &4.into()));
    assert_eq!(summary["revolutions"], 4 * 400);
    assert_eq!(summary["classes"].as_array().unwrap().last().unwrap()["class"], "failed");
    assert!(summary["cpu_s"].as_f64().is_some() && summary["wall_s"].as_f64().is_some());
    let page = prints(&[&["chart", MODEL], &sides[..]].concat());
    assert!(
        common::in_one_line(&page)
            .contains("the first that failed: models/osorio-2008.toml: cam.nose_end_deg = 200: must be"),
        "{page}"
    );
}

/// The numbers of a variable in the four blocks of a store of 120 x 110 points, row by row.
fn stored<const BYTES: usize>(folder: &Path, name: &str, number: fn([u8; BYTES]) -> f64) -> Vec<f64> {
    let block = |row: usize, column: usize| std::fs::read(folder.join(format!("{name}/c/{row}/{column}"))).unwrap();
    let point = |index: usize| {
        let (x, y) = (index % 120, index / 120);
        let at = ((y % 100) * 100 + x % 100) * BYTES;
        number(block(y / 100, x / 100)[at..at + BYTES].try_into().unwrap())
    };
    // Every seventh is enough, and reads each block a few thousand times.
    (0..120 * 110).step_by(7).map(point).collect()
}

/// A store has the numbers of the table; in parts, and with files that are lost or cut off and run again, the same bytes.
#[test]
#[ignore = "slow"]
fn a_store_is_the_table_in_blocks() {
    let folder = tempfile::TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let axes = ["--x", "rpm=90:190:120", "--y", "restitution=0:0.9:110", "--transient", "5", "--record", "2"];
    let into = |store: &str, more: &[&str]| {
        let out = ["--out", store, "--summary"];
        serde_json::from_str::<Value>(&prints(&[&["chart", MODEL], &axes[..], &out, more].concat())).unwrap()
    };
    let whole = path("whole.zarr");
    let blocks = |computed: u64, done: u64| serde_json::json!({ "computed": computed, "done": done, "total": 4 });
    assert_eq!(into(&whole, &[])["blocks"], blocks(4, 4));
    let rows = chart(&axes);
    let column = |index: usize| rows.iter().step_by(7).map(move |row| row[index].clone());
    let names = ["stays", "periodic", "resting", "chaotic", "undecided", "failed"];
    let class = |name: &str| names.iter().position(|known| *known == name).unwrap() as f64;
    let classes: Vec<f64> = column(2).map(|name| class(&name)).collect();
    assert_eq!(stored(whole.as_ref(), "class", |[byte]: [u8; 1]| f64::from(byte as i8)), classes);
    assert!(classes.contains(&0.0) && classes.contains(&2.0));
    let impacts: Vec<f64> = column(4).map(|cell| number(&cell)).collect();
    assert_eq!(stored(whole.as_ref(), "impacts", |bytes| f64::from(i32::from_le_bytes(bytes))), impacts);
    let same = |(one, other): (f64, f64)| one == other || (one.is_nan() && other.is_nan());
    let speeds = stored(whole.as_ref(), "impact_speed", f64::from_le_bytes);
    assert!(speeds.into_iter().zip(column(7).map(|cell| number(&cell))).all(same));
    let rpm = std::fs::read(folder.path().join("whole.zarr/rpm/c/0")).unwrap();
    assert_eq!(f64::from_le_bytes(rpm[119 * 8..120 * 8].try_into().unwrap()), 190.0);
    // Two parts, in any order, and then what was lost.
    let parts = path("parts.zarr");
    assert_eq!(into(&parts, &["--shard", "2/2"])["blocks"], blocks(2, 2));
    assert_eq!(prints(&["chart", "--status", &parts]).trim(), "2 of 4 blocks are done");
    assert_eq!(into(&parts, &["--shard", "1/2", "--threads", "1"])["blocks"], blocks(2, 4));
    std::fs::remove_file(folder.path().join("parts.zarr/impacts/c/0/1")).unwrap();
    std::fs::write(folder.path().join("parts.zarr/class/c/1/0"), [0; 7]).unwrap();
    assert_eq!(into(&parts, &[])["blocks"], blocks(2, 4));
    let mut compared = 0;
    for entry in ["zarr.json", "class/zarr.json", "class/c/0/0", "class/c/1/0", "impacts/c/0/1", "growth_rate/c/1/1"] {
        let [one, other] = [&whole, &parts].map(|store| std::fs::read(Path::new(store).join(entry)).unwrap());
        assert!(one == other, "{entry}");
        compared += one.len();
    }
    assert!(compared > 100_000);
    // Another chart does not go there, and is told by what.
    let longer = [&axes[..4], &["--transient", "5", "--record", "3"]].concat();
    let ([fewer, elsewhere], upwards) = (["rpm=90:190:119", "rpm=90:191:120"], axes[3]);
    let lengths = &axes[4..];
    for (other, how) in [
        (longer.clone(), "its record is 2, and not 3"),
        (
            [&["--x", fewer, "--y", upwards], lengths].concat(),
            "its number of rows and columns is [110,120], and not [110,119]",
        ),
        ([&["--x", elsewhere, "--y", upwards], lengths].concat(), "other values of rpm"),
        ([&["--x", upwards, "--y", axes[1]], lengths].concat(), "its pair of axes, upwards and across, is"),
        (
            [&axes[..], &["--set", "mass=2"]].concat(),
            "its model is \"osorio-2008\", and not \"osorio-2008 with follower.mass = 2\"",
        ),
        ([&axes[..], &["--start-angle", "1"]].concat(), "its start is {\"cam_angle_rad\":0.0"),
    ] {
        let said = refused(&[&other[..], &["--out", &whole]].concat());
        assert!(said.contains("holds another chart: ") && said.contains(how), "{how}: {said}");
    }
    let none = common::corner_impact(["chart", "--status", "nowhere.zarr"]);
    assert!(none.status.code() == Some(2) && common::text(none.stderr).contains("no store of a chart"));
    assert!(refused(&[&axes[..], &["--shard", "3/2"]].concat()).contains("must be I/N"));
    assert!(refused(&[&axes[..], &["--shard", "1/2", "--out", "a.csv"]].concat()).contains("must end in .zarr"));
}

/// Where a block cannot be written, none of it counts as done, and what was done stays; whoever can write goes on.
#[test]
#[cfg(unix)]
fn a_store_that_cannot_be_written_loses_nothing() {
    use std::fs::{Permissions, set_permissions};
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    use std::os::unix::process::CommandExt;
    fn each_folder(folder: &Path, mode: u32) {
        set_permissions(folder, Permissions::from_mode(mode)).unwrap();
        let inside = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        inside.filter(|path| path.is_dir()).for_each(|path| each_folder(&path, mode));
    }
    let folder = tempfile::TempDir::new().unwrap();
    let [store, model, program] = ["c.zarr", "model.toml", "corner-impact"].map(|name| folder.path().join(name));
    // The superuser may write everywhere: another user tries, with copies of what that user may not come to.
    std::fs::copy(Path::new(common::ROOT).join(MODEL), &model).unwrap();
    common::copy_program(&program);
    let [store, model] = [&store, &model].map(|path| path.to_str().unwrap());
    let axes = ["--x", "rpm=90:190:120", "--y", "restitution=0:0.9:3", "--transient", "5", "--record", "2"];
    let whole = [&["chart", model], &axes[..], &["--out", store]].concat();
    prints(&[&whole[..], &["--shard", "2/2"]].concat());
    each_folder(folder.path(), 0o555);
    let mut other = std::process::Command::new(&program);
    if std::fs::metadata(folder.path()).unwrap().uid() == 0 {
        other.uid(65_534);
    }
    let output = other.current_dir("/").args(&whole).output().unwrap();
    each_folder(folder.path(), 0o755);
    let complaint = common::text(output.stderr);
    assert!(output.status.code() == Some(2) && complaint.contains("c.zarr/revolutions/c/0"), "{complaint}");
    assert!(complaint.contains("Permission denied"), "{complaint}");
    let status = ["chart", "--status", store];
    assert_eq!(prints(&status).trim(), "1 of 2 blocks are done");
    prints(&whole);
    assert_eq!(prints(&status).trim(), "2 of 2 blocks are done");
}

/// On a disk that has room for what is said of a store, and for none of its blocks, none counts as done, nothing of one is there, and
/// whoever has room goes on.
#[test]
#[cfg(unix)]
fn a_store_without_room_counts_nothing_as_done() {
    let folder = tempfile::TempDir::new().unwrap();
    let store = folder.path().join("c.zarr");
    let store = store.to_str().unwrap();
    let axes = ["--x", "rpm=90:190:100", "--y", "restitution=0:0.9:100", "--transient", "2", "--record", "1"];
    let whole = [&["chart", MODEL], &axes[..], &["--out", store]].concat();
    // In blocks of 512 bytes; past the limit there would be a signal, and without that an error.
    let limited = "trap '' XFSZ; ulimit -f 40; exec \"$@\"";
    let mut shell = std::process::Command::new("sh");
    let shell = shell.current_dir(common::ROOT).args(["-c", limited, "sh", common::PROGRAM]);
    let output = shell.args(&whole).output().unwrap();
    let complaint = common::text(output.stderr);
    assert!(output.status.code() == Some(2) && complaint.contains("c.zarr/revolutions/c/0"), "{complaint}");
    assert!(complaint.contains("File too large"), "{complaint}");
    let blocks = Path::new(store).join("revolutions/c/0");
    assert_eq!(std::fs::read_dir(blocks).unwrap().count(), 0);
    let status = ["chart", "--status", store];
    assert_eq!(prints(&status).trim(), "0 of 1 blocks are done");
    prints(&whole);
    assert_eq!(prints(&status).trim(), "1 of 1 blocks are done");
}

#[test]
fn what_is_no_chart_is_refused_with_a_reason() {
    let (x, y) = ("rpm=600:760:3", "restitution=0.5:0.95:3");
    assert!(refused(&["--x", x, "--y", x]).contains("a chart needs two different numbers"));
    assert!(refused(&["--x", "mass=1:2:2", "--y", y]).contains("neither axis is rpm"));
    assert!(refused(&["--x", x, "--y", y, "--rpm", "700"]).contains("leave it out where rpm is an axis"));
    assert!(refused(&["--x", x, "--y", "restitutoin=0:1:2"]).contains("did you mean restitution?"));
    assert!(refused(&["--over", x]).contains("a chart has two axes"));
    assert!(refused(&["--over", x, "--over", y, "--over", "mass=1:2"]).contains("given 3 times"));
    assert!(refused(&["--x", "rpm=760:600:3", "--y", y]).contains("is below the lowest"));
    assert!(refused(&["--x", "rpm=-5:600:3", "--y", y]).contains("above 0"));
    assert!(refused(&["--x", "rpm=600:760:100000", "--y", "mass=1:2:100000"]).contains("1 to 100000000"));
    for sides in [["--x", x, "--y", y], ["--x", y, "--y", x]] {
        let said = refused(&[&sides[..], &["--set", "follower.restitution=0.7"]].concat());
        assert!(said.contains("--set follower.restitution: --"), "{said}");
    }
    assert!(refused(&["--x", x, "--y", y, "--out", "a.eps"]).contains(".csv, .zarr, .svg, .png or .pdf"));
}

/// The nonsmooth fold of the paper goes over the chart at omega* where the restitution is the paper's, whichever axis is which.
#[test]
#[ignore = "slow"]
fn curves_go_over_the_chart() {
    let folder = tempfile::TempDir::new().unwrap();
    let (speeds, restitutions) = ("rpm=660:740:5", "restitution=0.7:0.8:5");
    // Half a cell further on each side than the middles of the outermost cells.
    let share = |at: f64, [low, high]: [f64; 2]| (at - low) / (high - low);
    let (along, beside) = (share(673.234_445, [650.0, 750.0]), share(0.8, [0.6875, 0.8125]));
    for (name, x, y, [right, up]) in
        [("a", speeds, restitutions, [along, beside]), ("b", restitutions, speeds, [beside, along])]
    {
        let out = folder.path().join(name).with_extension("svg");
        prints(&["chart", MODEL, "--x", x, "--y", y, "--with-curves", "--out", out.to_str().unwrap()]);
        let svg = std::fs::read_to_string(out).unwrap();
        let quoted = |after: &str, name: &str| -> f64 {
            let from = svg.find(after).unwrap();
            let rest = &svg[from + svg[from..].find(&format!(" {name}=\"")).unwrap() + name.len() + 3..];
            number(&rest[..rest.find('"').unwrap()])
        };
        let panel = "<svg x=";
        let place = [right * quoted(panel, "width"), (1.0 - up) * quoted(panel, "height")];
        // Corner impacts are the thick curves.
        let is_thick = |line: &&str| line.contains("stroke-width=\"4.5\"") && line.contains("s-ink");
        let line = svg.lines().filter(|line| line.starts_with("<path")).find(is_thick).unwrap();
        let line = &line[line.find(" d=\"M").unwrap() + 5..];
        let line = line[..line.find('"').unwrap()].replace('-', " -");
        let points = line.split('M').flat_map(|run| {
            let mut at = [0.0; 2];
            // The first point of a run, then the steps from each point to the next.
            let parts: Vec<f64> = run.split(['l', ' ']).filter(|part| !part.is_empty()).map(number).collect();
            let steps = parts.chunks(2).map(|step| {
                at = [at[0] + step[0], at[1] + step[1]];
                (at[0] - place[0]).hypot(at[1] - place[1])
            });
            steps.collect::<Vec<_>>()
        });
        let nearest = points.fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.02, "{name}: {nearest} from {place:?} in {line}");
        assert!(svg.contains(">flip</text>"));
    }
    let folded = ["--x", "mass=1:1.5:2", "--y", "restitution=0.7:0.8:2", "--rpm", "700", "--with-curves"];
    assert!(refused(&[&folded[..], &["--out", "none.svg"]].concat()).contains("one axis must be rpm"));
    let table = ["--x", speeds, "--y", restitutions, "--with-curves", "--out", "none.csv"];
    assert!(refused(&table).contains("is for a picture"));
}
