//! One table of the numbers of a model: documents, templates, limits and units are those of its rows.

use std::path::Path;

use corner_impact::model::{Dimension, MODEL_NUMBERS, Model, ModelNumber};

use crate::common;

fn read(path: &str) -> String {
    std::fs::read_to_string(Path::new(common::ROOT).join(path)).unwrap()
}

/// The sections of the page on model files that have the rows of a number.
fn sections(number: &ModelNumber) -> Vec<String> {
    match number.laws {
        [] => vec![format!("`[{}]`", number.path.split('.').next().unwrap())],
        _ if number.path.starts_with("cam.segment.span") || number.path.starts_with("cam.segment.rise") => {
            vec!["`[[cam.segment]]` of a program".into()]
        }
        _ if number.path.starts_with("cam.segment") => vec!["`[[cam.segment]]` of polynomials".into()],
        laws => laws.iter().map(|law| format!("`law = \"{law}\"`")).collect(),
    }
}

/// The cells of a number's row in a section.
fn row(page: &str, section: &str, name: &str) -> Vec<String> {
    let heading = |line: &&str| line.trim_start_matches('#').trim() == section && line.starts_with('#');
    let lines = page.lines().skip_while(|line| !heading(line)).skip(1).take_while(|line| !line.starts_with("## "));
    let row = lines.into_iter().find(|line| line.starts_with(&format!("| `{name}` |")));
    let row = row.unwrap_or_else(|| panic!("docs/model-file.md has no {name} in {section}"));
    row.trim_matches('|').split(" | ").map(|cell| cell.trim().to_owned()).collect()
}

#[test]
fn the_page_on_model_files_has_every_number_as_the_table_has_it() {
    let page = read("docs/model-file.md");
    for number in MODEL_NUMBERS.iter().filter(|number| number.path.contains('.')) {
        let allowed = number.allowed();
        let allowed = allowed.trim_start_matches("must be a finite number").trim_start_matches(',').trim();
        for section in sections(number) {
            let cells = row(&page, &section, number.name());
            let [_, _, says, what] = &cells[..] else { panic!("{cells:?}") };
            // Of a list the page says how many.
            if !says.ends_with(" numbers") {
                assert_eq!(says, if allowed.is_empty() { "any" } else { allowed }, "{}", number.path);
            }
            let unit = match number.dimension {
                // The name says it.
                Dimension::Pure | Dimension::Degrees => continue,
                Dimension::LengthPerPower => "m/radᵏ",
                dimension => dimension.si(),
            };
            let words: Vec<&str> = what.split([',', ';', ':', ' ']).collect();
            assert!(words.contains(&unit) || what.contains(unit) && unit.contains(' '), "{}: {what}", number.path);
        }
    }
}

#[test]
fn templates_have_every_number_of_their_law() {
    let of_law = |law: &str| read(&format!("src/model/templates/{law}.toml"));
    let everywhere = ["follower", "study", "arcs"].map(of_law).join("\n");
    for number in MODEL_NUMBERS.iter().filter(|number| number.path.contains('.')) {
        let has = |text: &str| {
            let names = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
            names.into_iter().any(|word| word == number.name())
        };
        match number.laws {
            // Left out of most models; the page tells of them.
            [] if ["cam.corner_rounding_deg", "cam.lever_ratio"].contains(&number.path) => {}
            [] => assert!(has(&everywhere), "{}", number.path),
            laws => laws.iter().for_each(|law| assert!(has(&of_law(law)), "{law}: {}", number.path)),
        }
    }
}

/// Templates that have a follower of their own name each of its numbers.
#[test]
fn templates_with_a_follower_have_all_its_numbers() {
    for template in ["follower", "table", "contour"] {
        let text = read(&format!("src/model/templates/{template}.toml"));
        for number in MODEL_NUMBERS.iter().filter(|number| number.path.starts_with("follower.")) {
            let names = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
            assert!(names.into_iter().any(|word| word == number.name()), "{template}: {}", number.path);
        }
    }
}

#[test]
fn every_number_of_a_model_has_its_row_and_is_held_to_it() {
    for file in common::model_files() {
        let model = common::read(&file);
        for (path, value) in model.numbers() {
            let number = ModelNumber::of(path).unwrap_or_else(|| panic!("{}: {path}", file.display()));
            assert!(path.starts_with(number.path.split('.').next().unwrap()));
            // What no number may be, and what this one may not.
            let refused = model.with_number(path, f64::NAN).unwrap_err().to_string();
            assert!(refused.contains(&number.allowed()), "{path}: {refused}");
            if number.allowed().contains("above 0") || number.allowed().contains("0 or more") {
                let refused = model.with_number(path, -1.0).unwrap_err().to_string();
                assert!(refused.contains(&number.allowed()), "{path} = {value}: {refused}");
            }
        }
    }
}

/// The unit of a number is that of the file, whether it is of the follower or of the cam.
#[test]
fn units_follow_from_what_a_number_measures() {
    let paper = common::osorio();
    let unit = |path: &str| paper.units.of_number(path);
    assert_eq!(["follower.mass", "follower.gravity", "cam.base_radius"].map(unit), ["kg", "m/s²", "m"]);
    assert_eq!(["follower.restitution", "cam.nose_end_deg", "rpm", "nothing"].map(unit), ["", "deg", "rpm", ""]);
    let inches = "[units]\nlength = \"in\"\nforce = \"lbf\"\ngravity = \"in/s^2\"\n\n[follower]";
    let text = read("models/osorio-2008.toml").replace("[follower]", inches);
    let model = Model::parse("inches.toml", &text).unwrap();
    let unit = |path: &str| model.units.of_number(path);
    assert_eq!(["follower.gravity", "follower.preload", "follower.rest_position"].map(unit), ["in/s^2", "lbf", "in"]);
    assert_eq!(["cam.segment[3].rise", "cam.segment[0].coefficients[2]"].map(unit), ["in", "in/rad^place"]);
    assert_eq!(
        ModelNumber::of("cam.segment[12].coefficients[3]").map(|it| it.dimension),
        Some(Dimension::LengthPerPower)
    );
}
