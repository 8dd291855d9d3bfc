//! Does the live page get the answers of the command line, digit for digit?

use std::collections::BTreeMap;
use std::path::Path;

use corner_impact_explore::respond;
use serde_json::{Value, json};

use crate::common::{corner_impact, text};

/// The machines that are asked about: the paper's, others in other units, and measured ones.
const MACHINES: [&str; 4] = [
    "models/osorio-2008.toml",
    "models/damped-heavy.toml",
    "models/machines/harmonic-valve.toml",
    "models/machines/tangent-roller.toml",
];

fn model(file: &str) -> Value {
    json!({ "file": file, "text": std::fs::read_to_string(Path::new(crate::common::ROOT).join(file)).unwrap() })
}

fn asked(model: &Value, view: Value) -> Value {
    let mut question = view;
    question["model"] = model.clone();
    let answer: Value = serde_json::from_str(&respond(&question.to_string())).unwrap();
    assert!(answer.get("error").is_none(), "{question}: {answer}");
    answer
}

/// The words of a command line as a shell has them, with tables on standard output.
fn words(command: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), String::new(), None);
    for letter in command.chars() {
        match (letter, quote) {
            ('"' | '\'', None) => quote = Some(letter),
            (letter, Some(open)) if letter == open => quote = None,
            (' ', None) => words.push(std::mem::take(&mut word)),
            (letter, _) => word.push(letter),
        }
    }
    words.push(word);
    assert_eq!(words.remove(0), "corner-impact");
    words.iter_mut().filter(|word| word.ends_with(".csv")).for_each(|word| *word = "-".into());
    words
}

/// Output of the command of an answer.
fn printed(answer: &Value) -> String {
    let command = answer["command"].as_str().unwrap();
    let output = corner_impact(words(command).iter().map(String::as_str).chain(["--quiet"]));
    let (out, err) = (text(output.stdout), text(output.stderr));
    assert!(output.status.success() || !out.is_empty(), "{command}: {err}");
    out
}

/// Drops the fields that are not the same in two runs.
fn timeless(mut document: Value) -> Value {
    if let Some(fields) = document.as_object_mut() {
        fields.retain(|name, _| !["wall_s", "threads"].contains(&name.as_str()));
    }
    document
}

fn document(answer: &Value) -> Value {
    timeless(serde_json::from_str(&printed(answer)).unwrap())
}

/// Columns of a table by name.
fn columns(table: &str) -> BTreeMap<String, Vec<String>> {
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut columns: BTreeMap<String, Vec<String>> = names.iter().map(|name| ((*name).into(), Vec::new())).collect();
    for line in lines {
        for (name, cell) in names.iter().zip(line.split(',')) {
            columns.get_mut(*name).unwrap().push(cell.into());
        }
    }
    columns
}

/// The rows of impacts of a table of events.
fn impacts(table: &str) -> String {
    let is_kept = |line: &&str| !line.contains(",stick,") && !line.contains(",release,");
    table.lines().filter(is_kept).collect::<Vec<_>>().join("\n")
}

/// Asserts that columns of an answer are those of a table, digit for digit.
fn assert_columns(found: &Value, table: &BTreeMap<String, Vec<String>>, names: &[(&str, &str)]) {
    for (name, head) in names {
        let begins = |all: &str| all.starts_with(head) && (all.len() == head.len() || head.ends_with('_'));
        let (_, cells) =
            table.iter().find(|(all, _)| begins(all)).unwrap_or_else(|| panic!("{head}: {:?}", table.keys()));
        let own =
            found.as_object().unwrap().iter().find(|(all, _)| all.starts_with(name)).unwrap().1.as_array().unwrap();
        assert_eq!(own.len(), cells.len(), "{name}");
        for (own, cell) in own.iter().zip(cells) {
            match own.as_f64() {
                Some(number) => assert_eq!(number, cell.parse::<f64>().unwrap(), "{name}"),
                None => assert_eq!(own.as_str().unwrap(), cell, "{name}"),
            }
        }
    }
}

#[test]
#[ignore = "slow"]
fn documents_are_those_of_the_commands() {
    for file in MACHINES {
        let model = model(file);
        let page = asked(&model, json!({ "view": "model" }));
        let [low, high] = [0, 1].map(|end| page["found"]["speeds"][end].as_f64().unwrap());
        let middle = (0.5 * (low + high)).round();
        let over = json!({ "name": "rpm", "low": low.round(), "high": high.round(), "count": 2 });
        for view in [
            json!({ "view": "design", "count": 5 }),
            json!({ "view": "design", "rpm": [low.round(), high.round()], "count": 4, "needs": [format!("no separation to {middle} rpm")] }),
            json!({ "view": "orbit", "rpm": middle, "revolutions": 1, "impacts": 1 }),
            json!({ "view": "speeds", "over": over, "starts": 2 }),
        ] {
            let answer = asked(&model, view);
            assert_eq!(timeless(answer["found"].clone()), document(&answer), "{file}: {}", answer["command"]);
        }
        let cam = asked(&model, json!({ "view": "cam" }));
        assert_eq!(cam["found"]["sheet"], document(&cam), "{file}");
    }
}

#[test]
fn a_corner_impact_is_that_of_verify() {
    let model = model(MACHINES[0]);
    for set in
        [json!({}), json!({ "follower.restitution": 0.7 }), json!({ "restitution": 0.75, "follower.damping": 2.5 })]
    {
        let mut changed = model.clone();
        changed["set"] = set;
        let answer = asked(&changed, json!({ "view": "verify" }));
        assert_eq!(timeless(answer["found"].clone()), document(&answer), "{}", answer["command"]);
    }
}

#[test]
fn runs_and_diagrams_are_those_of_the_tables() {
    for file in MACHINES {
        let model = model(file);
        let page = asked(&model, json!({ "view": "model" }))["found"].clone();
        let [low, high] = [0, 1].map(|end| page["speeds"][end].as_f64().unwrap().round());
        let rpm = (0.3 * low + 0.7 * high).round();
        let lift = asked(&model, json!({ "view": "cam" }))["found"]["sheet"].clone();
        let top = lift.as_object().unwrap().iter().find(|(name, _)| name.starts_with("lift_")).unwrap().1[1]
            .as_f64()
            .unwrap();
        for start in [json!({}), json!({ "cam_angle_rad": 0.5, "position": 1.1 * top, "velocity": -0.25 })] {
            let run = asked(
                &model,
                json!({ "view": "motion", "rpm": rpm, "transient": 20, "revolutions": 3, "samples": 90, "start": start }),
            );
            let names =
                ["time_", "cam_angle_", "position_", "velocity_", "gap_", "contact_force_"].map(|name| (name, name));
            assert_columns(&run["found"], &columns(&printed(&run)), &names);
            let events = asked(
                &model,
                json!({ "view": "motion", "rpm": rpm, "transient": 0, "revolutions": 25, "samples": 0, "start": start }),
            );
            let names = [
                "revolution",
                "time_",
                "cam_angle_",
                "event",
                "position_",
                "velocity_before_",
                "velocity_after_",
                "cam_velocity_",
            ];
            assert_columns(&events["found"]["events"], &columns(&printed(&events)), &names.map(|name| (name, name)));
        }
        let restitution = json!({ "name": "restitution", "low": 0.2, "high": 0.8, "count": 4 });
        let speed = json!({ "name": "rpm", "low": low, "high": high, "count": 7 });
        for (over, rpm) in [(speed, Value::Null), (restitution, json!(rpm))] {
            let name = over["name"].as_str().unwrap().replace("restitution", "follower.restitution");
            let answer =
                asked(&model, json!({ "view": "diagram", "rpm": rpm, "over": over, "transient": 50, "record": 4 }));
            let names = [
                ("value", name.as_str()),
                ("cam_angle_", "cam_angle_"),
                ("position_", "position_"),
                ("velocity_before_", "velocity_before_"),
                ("velocity_after_", "velocity_after_"),
            ];
            // `values` stands before `value`.
            let mut found = answer["found"].clone();
            found.as_object_mut().unwrap().remove("values");
            assert_columns(&found, &columns(&impacts(&printed(&answer))), &names);
        }
    }
}

#[test]
fn attractors_basins_and_long_runs_are_those_of_the_commands() {
    let model = model(MACHINES[0]);
    let over = json!({ "name": "rpm", "low": 678.0, "high": 680.0, "count": 2 });
    let answer =
        asked(&model, json!({ "view": "diagram", "over": over, "transient": 200, "record": 2, "attractors": true }));
    let table = columns(&impacts(&printed(&answer)));
    assert_columns(&answer["found"], &table, &[("attractor", "attractor"), ("cam_angle_", "cam_angle_")]);
    assert!(answer["found"]["attractor"].as_array().unwrap().contains(&json!(1)), "two motions coexist at 678 rpm");

    let grid = json!({ "view": "basins", "rpm": 678.0, "cam_angle_rad": 0.25, "grid": [8, 6], "position": [0.5, 6.0], "velocity": [-60.0, 60.0] });
    let answer = asked(&model, grid);
    let table = columns(&printed(&answer));
    let parts: Vec<i64> = table["part"].iter().map(|part| part.parse().unwrap_or(-1)).collect();
    assert_eq!(answer["found"]["cell_endings"], json!(parts));

    for (rpm, kind) in [(700.0, "periodic"), (670.0, "chaotic"), (183.0, "resting")] {
        let answer = asked(&model, json!({ "view": "long_run", "rpm": rpm }));
        let (found, document) = (&answer["found"], document(&answer));
        assert_eq!(found["kind"], kind, "{rpm} rpm");
        for name in ["kind", "lyapunov_per_revolution", "lyapunov_standard_error", "followed"] {
            assert_eq!(found[name], document.get(name).cloned().unwrap_or(Value::Null), "{rpm} rpm: {name}");
        }
    }
}

#[test]
fn the_whole_model_file_is_the_changed_model() {
    for file in MACHINES {
        let mut changed = model(file);
        changed["set"] = json!({ "restitution": 0.375, "mass": 0.5 });
        let page = asked(&changed, json!({ "view": "model" }))["found"].clone();
        let number = |page: &Value, path: &str| {
            let numbers = page["numbers"].as_array().unwrap();
            numbers.iter().find(|number| number["path"] == path).unwrap()["value"].clone()
        };
        let whole = json!({ "file": "saved.toml", "text": page["text"] });
        let again = asked(&whole, json!({ "view": "model" }))["found"].clone();
        for path in ["follower.restitution", "follower.mass"] {
            assert_eq!(number(&page, path), number(&again, path), "{file}: {path}");
        }
        assert_eq!(number(&again, "follower.restitution"), 0.375);
        let motion =
            json!({ "view": "motion", "rpm": page["speeds"][1], "transient": 5, "revolutions": 2, "samples": 12 });
        assert_eq!(asked(&changed, motion.clone())["found"], asked(&whole, motion)["found"], "{file}");
    }
}

#[test]
fn sliders_hold_the_value_and_every_end_is_allowed() {
    for file in MACHINES {
        let given = model(file);
        let page = asked(&given, json!({ "view": "model" }))["found"].clone();
        for number in page["numbers"].as_array().unwrap() {
            let [low, high] = [0, 1].map(|end| number["slider"][end].as_f64().unwrap());
            let value = number["value"].as_f64().unwrap();
            assert!(low <= value && value <= high && low < high, "{file}: {number}");
            assert!(number["scale"] != "log" || low > 0.0, "{file}: {number}");
            // A cam may have no such shape; the number itself must be allowed.
            if number["path"].as_str().unwrap().starts_with("follower.") {
                for end in [low, high] {
                    let mut changed = given.clone();
                    changed["set"] = json!({ number["path"].as_str().unwrap(): end });
                    asked(&changed, json!({ "view": "model" }));
                }
            }
        }
    }
}

#[test]
#[ignore = "slow"]
fn each_law_has_a_template_that_is_a_whole_model() {
    let laws = asked(&json!({}), json!({ "view": "model" }))["found"]["laws"].clone();
    for law in laws.as_array().unwrap() {
        let template = asked(&json!({}), json!({ "view": "template", "law": law }))["found"]["text"].clone();
        let page =
            asked(&json!({ "file": "mine.toml", "text": template }), json!({ "view": "model" }))["found"].clone();
        assert_eq!(page["law"], *law);
    }
}

#[test]
fn what_cannot_be_answered_has_the_sentence_and_its_place() {
    let refused = |question: Value| -> Value {
        let answer: Value = serde_json::from_str(&respond(&question.to_string())).unwrap();
        assert!(answer.get("found").is_none(), "{answer}");
        answer["error"].clone()
    };
    let of = |error: &Value| error["sentence"].as_str().unwrap().to_owned();
    let bad = json!({ "file": "bad.toml", "text": "[follower]\nmass = -1" });
    let error = refused(json!({ "view": "model", "model": bad }));
    assert_eq!(
        (error["file"].as_str(), error["line"].as_u64(), error["field"].as_str()),
        (Some("bad.toml"), Some(2), Some("follower.mass"))
    );
    // A text that names a table gets no file of the machine that answers.
    let table = Path::new(crate::common::ROOT).join("models/laws/table-cubic.toml");
    let named = json!({ "file": table, "text": std::fs::read_to_string(&table).unwrap() });
    let error = refused(json!({ "view": "model", "model": named }));
    assert!(of(&error).contains("write its rows as cam.rows") && error["field"] == "cam.file", "{error}");
    assert!(
        of(&refused(json!({ "view": "model", "model": { "set": { "restitution": 1.5 } } }))).contains("from 0 to 1")
    );
    assert!(of(&refused(json!({ "view": "motion", "rpm": -3.0 }))).contains("forwards"));
    assert!(of(&refused(json!({ "view": "nonsense" }))).contains("nonsense"));
    assert!(of(&refused(json!({ "view": "template", "law": "round" }))).contains("must be one of arcs"));
    assert!(
        of(&refused(json!({ "view": "motion", "rpm": 700.0, "revolutions": 1_000_000_000_u64 }))).contains("at most")
    );
    let endless = json!({ "name": "rpm", "low": 600.0, "high": 700.0, "count": 10_000_000 });
    assert!(of(&refused(json!({ "view": "diagram", "over": endless }))).contains("at most"));
    let long = json!({ "name": "rpm", "low": 600.0, "high": 700.0, "count": 1000 });
    assert!(of(&refused(json!({ "view": "diagram", "over": long, "record": 1_000_000 }))).contains("at most"));
    assert!(of(&refused(json!({ "view": "basins", "rpm": 700.0, "grid": [100_000, 100_000] }))).contains("at most"));
    assert!(of(&refused(json!({ "view": "verify", "model": { "text": std::fs::read_to_string(Path::new(crate::common::ROOT).join("models/laws/harmonic.toml")).unwrap() } }))).contains("study"));
    for text in ["", "{", "[]", "null", "{\"view\":1}", "{\"view\":\"model\",\"model\":{\"tekst\":\"\"}}", "\u{0}"] {
        let answer: Value = serde_json::from_str(&respond(text)).unwrap();
        assert!(of(&answer["error"]).starts_with("question: "), "{text}: {answer}");
    }
}

/// Each step of the guided tours says what its command finds. Commands with VALVE or DANGEROUS are of the model of that tour.
#[test]
#[ignore = "slow"]
fn tours_say_what_the_commands_find() {
    let folder = tempfile::TempDir::new().unwrap();
    let models = corner_impact_explore::tour_models();
    for (name, text) in &models {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let file = |name: &str| folder.path().join(name).display().to_string();
    let facts: Vec<Value> = serde_json::from_str(include_str!("tours.json")).unwrap();
    let tours = include_str!("../../crates/explore/src/page/stories.js");
    for fact in &facts {
        assert!(tours.contains(&format!("name: \"{}\"", fact["story"].as_str().unwrap())), "{fact}");
        let command = format!("corner-impact {}", fact["command"].as_str().unwrap());
        let command = command.replace("VALVE", &file("valve.toml")).replace("DANGEROUS", &file("dangerous.toml"));
        let output = corner_impact(words(&command));
        let page = text(output.stdout);
        for has in fact["has"].as_array().unwrap() {
            assert!(page.contains(has.as_str().unwrap()), "{fact}: {has} is not in\n{page}");
        }
    }
}
