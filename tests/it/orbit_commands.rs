//! Do `orbit`, `continue`, `curve` and `speeds` keep their contract, say what they found, and refuse what they cannot do?

use std::process::Output;

use crate::common::{corner_impact, text};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use serde_json::{Value, json};
use tempfile::TempDir;

const MODEL: &str = "models/osorio-2008.toml";
const BRANCH: &str = "rpm,parameter,value,revolutions,impacts,cam_angle_rad,position_m,velocity_m_s,multiplier_1_re,\
    multiplier_1_im,multiplier_2_re,multiplier_2_im,stable,special";
/// omega*, rpm, of the paper's model.
const CORNER_IMPACT: f64 = 673.234_445_003_848_8;

/// Standard output and standard error of a command that is done.
#[track_caller]
fn done(arguments: &[&str]) -> (String, String) {
    let Output { status, stdout, stderr } = corner_impact(arguments);
    let (out, err) = (text(stdout), text(stderr));
    assert_eq!(status.code(), Some(0), "{arguments:?}: {err}");
    (out, err)
}

/// The complaint of a command that is refused; nothing is printed.
#[track_caller]
fn refused(arguments: &[&str]) -> String {
    let Output { status, stdout, stderr } = corner_impact(arguments);
    assert_eq!((status.code(), stdout.as_slice()), (Some(2), &[][..]), "{arguments:?}");
    text(stderr)
}

fn document(arguments: &[&str]) -> Value {
    serde_json::from_str(&done(arguments).0).unwrap()
}

/// The rows of a table by column name.
struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    #[track_caller]
    fn new(text: &str, starts_with: &str) -> Self {
        let mut lines = text.lines();
        let header = lines.next().unwrap();
        assert!(header.starts_with(starts_with), "{header}");
        let cells = |line: &str| line.split(',').map(String::from).collect::<Vec<_>>();
        let (columns, rows) = (cells(header), lines.map(cells).collect::<Vec<_>>());
        assert!(rows.iter().all(|row| row.len() == columns.len()));
        Self { columns, rows }
    }

    fn cell<'a>(&self, row: &'a [String], column: &str) -> &'a str {
        &row[self.columns.iter().position(|name| name == column).unwrap()]
    }

    fn number(&self, row: &[String], column: &str) -> f64 {
        self.cell(row, column).parse().unwrap()
    }

    /// Values of the parameter at the special points of a kind.
    fn special(&self, kind: &str) -> Vec<f64> {
        let rows = self.rows.iter().filter(|row| self.cell(row, "special") == kind);
        rows.map(|row| self.number(row, "value")).collect()
    }
}

#[test]
fn orbits_of_one_speed_have_the_contracts_fields() {
    let found = document(&["orbit", MODEL, "--rpm", "680", "--json"]);
    assert_eq!(found["schema"], "corner-impact/orbit/1");
    let orbits = found["orbits"].as_array().unwrap();
    // All of one impact and of two, with a proof.
    let proved = |impacts: u64| json!({ "revolutions": 1, "impacts": impacts, "known": "proved" });
    assert_eq!((&found["complete"], &found["undecided"]), (&json!([proved(1), proved(2)]), &json!([])));
    assert!(orbits.iter().all(|orbit| orbit["known"] == "proved"), "{found}");
    let stable: Vec<bool> = orbits.iter().map(|orbit| orbit["stable"].as_bool().unwrap()).collect();
    assert_eq!(stable, [false, true, false]);
    for orbit in orbits {
        assert_eq!(orbit["revolutions"], 1);
        assert_eq!(orbit["state"].as_array().unwrap().len(), 2);
        let product = |part: usize| {
            let multiplier = |index: usize, name: &str| orbit["multipliers"][index][name].as_f64().unwrap();
            let (a, b) = (multiplier(0, "re"), multiplier(0, "im"));
            let (c, d) = (multiplier(1, "re"), multiplier(1, "im"));
            [a * c - b * d, a * d + b * c][part]
        };
        // An impact multiplies areas by r^2, undamped flight by 1.
        let impacts = orbit["impacts"].as_array().unwrap();
        assert_relative_eq!(product(0), 0.8_f64.powi(2 * impacts.len() as i32), max_relative = 1e-10);
        assert_eq!(product(1), 0.0);
        for impact in impacts {
            let at = |name: &str| impact[name].as_f64().unwrap();
            assert!((0.0..std::f64::consts::TAU).contains(&at("cam_angle_rad")));
            assert!(at("velocity_after_m_s") > at("velocity_before_m_s"));
        }
    }
    let of_two = document(&["orbit", MODEL, "--rpm", "680", "--impacts", "2", "--json"]);
    assert_eq!((of_two["orbits"].as_array().unwrap().len(), &of_two["complete"]), (1, &json!([proved(2)])));
    let (page, _) = done(&["orbit", MODEL, "--rpm", "183"]);
    assert!(page.contains("sticks to the cam") && page.contains("stick   at 269.5137"), "{page}");
}

/// From the state of an orbit, rounded, Newton's method finds that orbit alone; from one that leads nowhere, none.
#[test]
fn a_guess_leads_to_one_orbit_or_none() {
    let near = document(&["orbit", MODEL, "--rpm", "680", "--guess", "2.13,-35.4", "--json"]);
    let orbits = near["orbits"].as_array().unwrap();
    assert_eq!(orbits.len(), 1);
    assert_relative_eq!(orbits[0]["state"][0].as_f64().unwrap(), 2.129_702_286_852, max_relative = 1e-9);
    let (page, _) = done(&["orbit", MODEL, "--rpm", "680", "--guess", "40,0"]);
    assert!(page.contains("no periodic orbit found"), "{page}");
}

#[test]
fn a_branch_has_the_contracts_columns_and_names_its_points() {
    let (table, account) = done(&["continue", MODEL, "--from-rpm", "700", "--parameter", "rpm=660:760"]);
    let table = Table::new(&table, BRANCH);
    assert_relative_eq!(table.special("corner")[0], CORNER_IMPACT, max_relative = 1e-12);
    assert_eq!(table.special("flip").len(), 2, "{account}");
    for row in &table.rows {
        assert_eq!(table.cell(row, "parameter"), "rpm");
        assert_eq!(table.cell(row, "rpm"), table.cell(row, "value"));
        let largest = ["1", "2"].map(|index| {
            let part = |name: &str| table.number(row, &format!("multiplier_{index}_{name}"));
            part("re").hypot(part("im"))
        });
        let stable = table.cell(row, "stable") == "true";
        // At a flip a multiplier is -1, on whichever side rounding has put it.
        let on_circle = ["fold", "flip"].contains(&table.cell(row, "special"));
        assert_eq!(stable, !on_circle && largest[0] < 1.0 && largest[1] < 1.0);
        let stability = if on_circle { "neutral" } else { ["unstable", "stable"][usize::from(stable)] };
        assert_eq!(table.cell(row, "stability"), stability);
    }
    // The one-impact branch goes round at the corner impact: no orbit of it is slower.
    let first = |row: &&Vec<String>| table.cell(row, "branch") == "1";
    let slowest = table.rows.iter().filter(first).map(|row| table.number(row, "rpm")).fold(f64::INFINITY, f64::min);
    assert_relative_eq!(slowest, CORNER_IMPACT, max_relative = 1e-12);
    assert!(account.contains("corner impact: impact 1 at 150.1794 deg, jump of order 2"), "{account}");
    assert!(account.contains("the end of the range"), "{account}");
}

#[test]
#[ignore = "slow"]
fn with_all_orbits_of_twice_the_period_are_in_the_table_too() {
    let followed = |all: &[&str]| {
        let line = ["continue", MODEL, "--from-rpm", "738", "--parameter", "rpm=730:745"];
        Table::new(&done(&[&line, all].concat()).0, BRANCH)
    };
    let longest = |table: &Table| table.rows.iter().map(|row| table.number(row, "revolutions") as u64).max();
    let (alone, once, thrice) = (followed(&[]), followed(&["--all=1"]), followed(&["--all"]));
    assert_eq!([&alone, &once, &thrice].map(longest), [Some(1), Some(2), Some(8)]);
    assert_eq!(alone.rows, once.rows[..alone.rows.len()]);
    // The stable orbit of two revolutions reaches the nose's end.
    assert!(once.special("corner").iter().any(|rpm| (rpm - 739.377_929_649).abs() < 1e-8));
}

/// The follower of a cam of two like lobes hits both alike, until that is lost: another branch crosses, of two orbits each
/// with two unlike impacts.
#[test]
fn a_crossing_of_branches_is_marked() {
    let model = "models/laws/rectified-sine.toml";
    let (table, account) = done(&["continue", model, "--from-rpm", "12", "--parameter", "rpm=10:20"]);
    let table = Table::new(&table, BRANCH);
    let [crossing] = table.special("branching")[..] else { panic!("{account}") };
    let orbits = |rpm: f64| {
        let found = document(&["orbit", model, "--rpm", &rpm.to_string(), "--impacts", "2", "--json"]);
        found["orbits"].as_array().unwrap().iter().filter(|orbit| orbit["stable"] == true).count()
    };
    assert_eq!([orbits(crossing - 0.05), orbits(crossing + 0.05)], [1, 2], "{crossing}");
    // With --all the branch of both is followed, through the crossing, where the two are one.
    let (all, account) = done(&["continue", model, "--from-rpm", "12", "--parameter", "rpm=10:20", "--all=1"]);
    let all = Table::new(&all, BRANCH);
    let beyond = |row: &&Vec<String>| {
        let is_other = all.cell(row, "branch") != "1" && all.cell(row, "revolutions") == "1";
        is_other && all.cell(row, "stable") == "true" && (all.number(row, "rpm") - crossing - 0.05).abs() < 0.05
    };
    assert!(all.rows.iter().filter(beyond).count() >= 4, "{account}");
    let slowest = all.rows.iter().filter(|row| all.cell(row, "branch") != "1" && all.cell(row, "revolutions") == "1");
    let slowest = slowest.map(|row| all.number(row, "rpm")).fold(f64::INFINITY, f64::min);
    let marked = table.rows.iter().find(|row| table.cell(row, "special") == "branching").unwrap();
    let [low, high] = ["bracket_low", "bracket_high"].map(|end| table.number(marked, end));
    assert!(low <= slowest && slowest <= high, "{low} {slowest} {high}");
}

#[test]
fn a_branch_in_another_number_ends_at_the_edge_with_a_plain_word() {
    // The nose would reach the top of the cam: the model refuses it, whatever range is asked for.
    let (table, account) =
        done(&["continue", MODEL, "--from-rpm", "700", "--parameter", "nose_end_deg=120:400", "--impacts", "1"]);
    let table = Table::new(&table, BRANCH);
    assert!(table.rows.iter().all(|row| table.cell(row, "parameter") == "cam.nose_end_deg"));
    assert!(table.rows.iter().all(|row| table.number(row, "rpm") == 700.0));
    let most = table.rows.iter().map(|row| table.number(row, "value")).fold(0.0, f64::max);
    assert!(179.0 < most && most <= 180.0, "{most}");
    let edge = "the largest possible value: cam.nose_end_deg must";
    assert!(account.contains(edge) && account.contains("the end of the range"), "{account}");
}

#[test]
fn pictures_and_tables_are_whole_files() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (svg, csv) = (path("b.svg"), path("b.csv"));
    let arguments = ["continue", MODEL, "--from-rpm", "700", "--parameter", "rpm=670:700", "--runs", "20", "--out"];
    done(&[&arguments[..], &[&svg]].concat());
    done(&[&arguments[..], &[&csv]].concat());
    let svg = std::fs::read_to_string(svg).unwrap();
    assert!(svg.contains("unstable") && svg.contains("corner impact"), "no legend");
    Table::new(&std::fs::read_to_string(csv).unwrap(), BRANCH);
    let curve = path("c.svg");
    done(&["curve", MODEL, "--rpm", "660:690", "--parameter", "restitution=0.7:0.9", "--out", &curve]);
    assert!(std::fs::read_to_string(curve).unwrap().contains("nonsmooth-fold"));
}

/// The corner impact at R is of three types, one after the other, as the restitution grows; the paper's is of one.
#[test]
#[ignore = "slow"]
fn the_type_changes_along_a_curve_of_corner_impacts() {
    let (table, account) = done(&["curve", MODEL, "--rpm", "600:760", "--parameter", "restitution=0.5:0.95"]);
    let table = Table::new(&table, "rpm,parameter,value,revolutions,impacts,cam_angle_rad,jump_order,scenario");
    let types = |curve: &str| {
        let mut types: Vec<&str> = Vec::new();
        for row in table.rows.iter().filter(|row| table.cell(row, "curve") == curve) {
            let kind = table.cell(row, "scenario");
            if types.last() != Some(&kind) && kind != "degenerate" {
                types.push(kind);
            }
        }
        types
    };
    assert_eq!(types("1"), ["nonsmooth-fold"], "{account}");
    assert_eq!(types("2"), ["persistence", "nonsmooth-flip", "nonsmooth-fold"], "{account}");
    // Where the model is as it is, the speed is that of verify.
    let here = table.rows.iter().find(|row| table.cell(row, "special") == "corner").unwrap();
    assert_relative_eq!(table.number(here, "rpm"), CORNER_IMPACT, max_relative = 1e-12);
    // Where the type changes, a multiplier of one side is 1 or -1.
    let changes: Vec<_> = table.rows.iter().filter(|row| table.cell(row, "special") == "type").collect();
    assert_eq!(changes.len(), 2);
    for row in changes {
        let names = ["minus_1", "minus_2", "plus_1", "plus_2"];
        let off = names.map(|name| (table.number(row, &format!("multiplier_{name}_re")).abs() - 1.0).abs());
        assert!(off.iter().any(|off| *off < 1e-9), "{off:?}");
    }
    let (empty, words) =
        done(&["curve", MODEL, "--rpm", "300:310", "--parameter", "restitution=0.5:0.95", "--event", "corner"]);
    assert_eq!(empty.lines().count(), 1);
    assert!(words.contains("no corner impact of an orbit of 1 revolution"), "{words}");
}

/// The attractors of a document: kind, revolutions and impacts.
fn motions(document: &Value) -> Vec<(&str, Option<u64>, Option<u64>)> {
    let one = |entry: &Value| (entry["revolutions"].as_u64(), entry["impacts"].as_u64());
    let all = document["attractors"].as_array().unwrap().iter();
    all.map(|entry| (entry["kind"].as_str().unwrap(), one(entry).0, one(entry).1)).collect()
}

#[test]
fn speeds_gives_the_short_answer() {
    let answer = document(&["speeds", MODEL, "--rpm", "100:130", "--step", "2", "--starts", "8", "--json"]);
    assert_eq!(answer["schema"], "corner-impact/speeds/1");
    assert_relative_eq!(answer["detachment_rpm"].as_f64().unwrap(), 114.979_326_743_998, max_relative = 1e-12);
    assert_eq!(motions(&answer), [("stays", Some(1), Some(0)), ("resting", Some(1), None)]);
    let [stays, rests] = [0, 1].map(|index| &answer["attractors"][index]);
    assert_eq!((&stays["birth"], &rests["death"], &answer["coexistence"]), (&Value::Null, &Value::Null, &json!([])));
    for end in [&stays["death"], &rests["birth"]] {
        assert_eq!((end["cause"].as_str(), end["located"].as_bool()), (Some("detachment"), Some(true)));
        assert_eq!(end["speed_rpm"], answer["detachment_rpm"]);
    }
    assert_eq!(
        (stays["id"].as_str(), stays["from_rpm"].as_f64(), rests["to_rpm"].as_f64()),
        (Some("A1"), Some(100.0), Some(130.0))
    );
    let shares = rests["shares"].as_array().unwrap();
    assert_eq!((shares[0]["speed_rpm"].as_f64(), shares[0]["share"].as_f64()), (Some(116.0), Some(1.0)));
    // All of a few starts are not certainly all.
    let error = shares[0]["error"].as_f64().unwrap();
    assert_relative_eq!(error, (0.9_f64 * 0.1 / 8.0).sqrt(), max_relative = 1e-12);
    assert_eq!(shares.len(), 8);
    let (page, _) = done(&["speeds", MODEL, "--rpm", "100:130", "--step", "10", "--starts", "4"]);
    assert!(page.contains("leaves the cam first at  114.979327 rpm"), "{page}");
    let (table, _) = done(&["speeds", MODEL, "--rpm", "100:130", "--step", "10", "--starts", "4", "--out", "-"]);
    assert!(
        table.starts_with(
            "rpm,attractor,kind,revolutions,impacts,growth_rate,growth_error,share,share_error,coexisting,followed\n"
        ),
        "{table}"
    );
    assert!(table.lines().any(|line| line.starts_with("110,A1,stays,1,0,-inf,0,1,0.186")), "{table}");
}

/// A flip and the corner impact after it, 0.06 rpm apart, between two speeds that are run.
#[test]
#[ignore = "slow"]
fn what_begins_and_ends_between_two_speeds_is_found() {
    let answer = document(&["speeds", MODEL, "--rpm", "735:745", "--step", "1", "--starts", "16", "--json"]);
    assert_eq!(motions(&answer)[..2], [("periodic", Some(1), Some(1)), ("periodic", Some(2), Some(2))]);
    let [one, two, chaos] = [0, 1, 2].map(|index| &answer["attractors"][index]);
    assert_eq!((chaos["kind"].as_str(), motions(&answer).len()), (Some("chaotic"), 3));
    let end = |end: &Value, cause: &str, rpm: f64| {
        assert_eq!((end["cause"].as_str(), end["located"].as_bool()), (Some(cause), Some(true)));
        assert_relative_eq!(end["speed_rpm"].as_f64().unwrap(), rpm, max_relative = 1e-10);
    };
    end(&one["death"], "flip", 739.319_780_216);
    end(&two["birth"], "flip", 739.319_780_216);
    end(&two["death"], "corner-impact", 739.377_929_649);
    assert_abs_diff_eq!(two["death"]["cam_angle_rad"].as_f64().unwrap().to_degrees(), 160.0, epsilon = 1e-9);
    // What only runs know is bracketed, and the bracket holds the corner impact.
    let (birth, bracket) = (&chaos["birth"], &chaos["birth"]["bracket_rpm"]);
    assert_eq!((birth["cause"].as_str(), birth["located"].as_bool()), (Some("runs"), Some(false)));
    let [low, high] = [0, 1].map(|side| bracket[side].as_f64().unwrap());
    assert!(low <= 739.378 && 739.377 <= high && high - low < 4e-3, "{bracket}");
}

#[test]
fn what_cannot_be_followed_is_refused_with_a_reason() {
    let followed = |parameter: &str| refused(&["continue", MODEL, "--from-rpm", "700", "--parameter", parameter]);
    assert!(followed("spring=1:2").contains("spring is not a number of this model; allowed are: rpm, cam.base_radius"));
    assert!(followed("restitution=0.9:0.95").contains("outside of 0.9:0.95"));
    assert!(followed("restitution=0.9").contains("must be NAME=LO:HI"));
    assert!(followed("restitution=0.9:0.95:3").contains("takes only a range"));
    assert!(followed("restitution=0.9:0.1").contains("is not below"));
    let none = refused(&["continue", MODEL, "--from-rpm", "700", "--parameter", "rpm=600:800", "--impacts", "9"]);
    assert!(none.contains("no periodic orbit of 1 revolution(s) found at 700 rpm"), "{none}");
    assert!(refused(&["orbit", MODEL, "--rpm", "0"]).contains("above 0"));
    assert!(refused(&["orbit", MODEL, "--rpm", "700", "--revolutions", "0"]).contains("0"));
    assert!(refused(&["curve", MODEL, "--rpm", "600:760", "--parameter", "rpm=1:2"]).contains("a number of the model"));
    assert!(refused(&["speeds", MODEL, "--rpm", "700:600"]).contains("700 is not below 600"));
    let nowhere = ["continue", MODEL, "--from-rpm", "700", "--parameter", "rpm=690:710", "--out", "/nowhere/b.csv"];
    assert!(refused(&nowhere).contains("/nowhere"));
}
