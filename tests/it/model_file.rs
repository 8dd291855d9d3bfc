//! Is docs/model-file.md what the parser takes: every field, what it allows, and no field besides?

#[allow(dead_code)]
#[path = "../documents/page.rs"]
pub(crate) mod page;

use std::collections::BTreeSet;
use std::path::Path;

use crate::common;
use corner_impact::cam::Cam;
use corner_impact::model::{Model, ModelError};

use page::Page;

/// A section of the page with its table of fields.
struct Section {
    heading: String,
    rows: Vec<Row>,
}

struct Row {
    field: String,
    needed: bool,
    allowed: String,
}

fn page() -> Page {
    Page::read(Path::new(common::ROOT), Path::new("docs/model-file.md"))
}

fn sections(page: &Page) -> Vec<Section> {
    let mut sections: Vec<Section> = Vec::new();
    for (_, line) in &page.prose {
        if let Some(heading) = line.strip_prefix('#') {
            sections.push(Section { heading: heading.trim_start_matches('#').trim().into(), rows: Vec::new() });
        }
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        if let [_, field, needed, allowed, _, _] = cells[..]
            && field.starts_with('`')
        {
            let row = Row { field: field.trim_matches('`').into(), needed: needed == "yes", allowed: allowed.into() };
            sections.last_mut().unwrap().rows.push(row);
        }
    }
    sections.retain(|section| !section.rows.is_empty());
    sections
}

/// The page's own follower and study, with each of its cams, by law.
fn samples(page: &Page) -> Vec<(String, String)> {
    let plain = page.blocks.iter().filter(|block| block.file.is_none()).map(|block| &block.text);
    let plain: Vec<&String> = plain.collect();
    let first = |start: &str| plain.iter().find(|text| text.starts_with(start)).unwrap();
    let (units, follower, study) = (first("[units]"), first("[follower]"), first("[study]"));
    let law = |cam: &str| cam.split('"').nth(1).unwrap().to_owned();
    let cams = plain.iter().filter(|text| text.starts_with("[cam]"));
    cams.map(|cam| {
        (law(cam), format!("name = \"sample\"\nsource = \"the page\"\n\n{units}\n{follower}\n{study}\n{cam}"))
    })
    .collect()
}

/// A folder with the page's tables.
fn folder(page: &Page) -> tempfile::TempDir {
    let folder = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    for table in ["lift.csv", "contour.csv"] {
        let block = page.blocks.iter().find(|block| block.file.as_deref() == Some(table)).unwrap();
        std::fs::write(folder.path().join(table), &block.text).unwrap();
    }
    folder
}

fn parse(folder: &Path, text: &str) -> Result<Model, ModelError> {
    Model::parse(&folder.join("model.toml").display().to_string(), text)
}

/// The sample, and the header in it, that a section is about.
fn place(samples: &[(String, String)], heading: &str) -> (String, String) {
    let of = |law: &str| samples.iter().find(|(name, _)| name == law).unwrap().1.clone();
    match heading {
        "At the top" => (of("arcs"), String::new()),
        "`[follower]`" => (of("arcs"), "[follower]".into()),
        "`[units]`" => (of("arcs"), "[units]".into()),
        "`[study]`" => (of("arcs"), "[study]".into()),
        "`[cam]`" => (of("arcs"), "[cam]".into()),
        "`[cam.contact]` of a roller" => {
            (of("arcs") + "\n[cam.contact]\nroller_radius = 0.1\n", "[cam.contact]".into())
        }
        "`[[cam.segment]]` of a program" => (of("program"), "[[cam.segment]]".into()),
        "`[[cam.segment]]` of polynomials" => (of("polynomial"), "[[cam.segment]]".into()),
        other => (of(other.split('"').nth(1).unwrap_or_else(|| panic!("{other}?"))), "[cam]".into()),
    }
}

/// A line set in the first table with `header`, or taken out of it.
fn with_line(sample: &str, header: &str, field: &str, value: Option<&str>) -> String {
    let (before, rest) = if header.is_empty() { ("", sample) } else { sample.split_once(header).unwrap() };
    let (table, after) = rest.find("\n[").map_or((rest, ""), |end| rest.split_at(end));
    let others = table.lines().filter(|line| !line.starts_with(&format!("{field} =")));
    let mut lines: Vec<String> = others.map(String::from).collect();
    if let Some(value) = value {
        let at = usize::from(!header.is_empty());
        lines.insert(at.min(lines.len()), format!("{field} = {value}"));
    }
    format!("{before}{header}{}\n{after}", lines.join("\n"))
}

#[test]
fn every_sample_is_a_cam() {
    let page = page();
    let (samples, folder) = (samples(&page), folder(&page));
    for (law, text) in &samples {
        let model = parse(folder.path(), text).unwrap_or_else(|error| panic!("{law}: {error}"));
        assert_eq!(model.cam.law(), law);
        Cam::new(&model).unwrap_or_else(|error| panic!("{law}: {error}"));
    }
    // A law that the program has and the page has not would be in no row either.
    let wrong = with_line(&samples[0].1, "[cam]", "law", Some("\"none\""));
    let known = parse(folder.path(), &wrong).unwrap_err().allowed;
    let listed: BTreeSet<&str> = known.split('"').skip(1).step_by(2).collect();
    assert_eq!(listed, samples.iter().map(|(law, _)| law.as_str()).collect());
}

#[test]
fn every_law_has_a_model() {
    let root = Path::new(common::ROOT).join("models");
    let folders = [root.clone(), root.join("laws")];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path());
    let models = files.filter(|file| file.extension().is_some_and(|end| end == "toml"));
    let used: BTreeSet<&str> = models.map(|file| common::read(&file).cam.law()).collect();
    for (law, _) in samples(&page()) {
        assert!(used.contains(law.as_str()), "no model in models/ uses {law}");
    }
}

/// What the parser allows in a table is what it lists against an unknown field.
#[test]
fn the_page_has_every_field_and_no_other() {
    let page = page();
    let (samples, folder, sections) = (samples(&page), folder(&page), sections(&page));
    let rows = |wanted: &str| {
        let found = sections.iter().filter(|section| section.heading == wanted).flat_map(|section| &section.rows);
        found.map(|row| row.field.clone()).collect::<BTreeSet<_>>()
    };
    for section in &sections {
        let (sample, header) = place(&samples, &section.heading);
        let text = with_line(&sample, &header, "no_such_field", Some("1"));
        let complaint = parse(folder.path(), &text).unwrap_err().allowed;
        let list = complaint.split_once("allowed ").and_then(|(_, rest)| rest.split_once(": ")).unwrap().1;
        let allowed: BTreeSet<String> = list.split(", ").map(|word| word.trim().to_owned()).collect();
        let mut listed: BTreeSet<String> = section.rows.iter().map(|row| row.field.clone()).collect();
        match section.heading.as_str() {
            "At the top" => listed.extend(["follower", "cam", "study", "units"].map(String::from)),
            // The laws' own sections list what comes beside it.
            "`[cam]`" => listed.extend(rows("`law = \"arcs\"`")),
            heading if heading.starts_with("`law") => listed.extend(rows("`[cam]`")),
            _ => {}
        }
        assert_eq!(listed, allowed, "{}", section.heading);
    }
    assert!(sections.len() >= 12, "{}", sections.len());
}

#[test]
fn every_field_allows_what_the_page_says() {
    let page = page();
    let (samples, folder) = (samples(&page), folder(&page));
    for section in sections(&page) {
        let (sample, header) = place(&samples, &section.heading);
        for Row { field, needed, allowed } in &section.rows {
            let place = format!("{}: {field}", section.heading);
            let complaint = |value: Option<&str>| {
                parse(folder.path(), &with_line(&sample, &header, field, value)).err().map(|error| error.allowed)
            };
            if field == "segment" {
                let none = sample.split("[[cam.segment]]").next().unwrap();
                let empty = with_line(none, "[cam]", field, Some("[]"));
                let empty = parse(folder.path(), &empty).unwrap_err().allowed;
                assert!(empty.contains(&allowed.replace(" tables", " are allowed")), "{place}: {allowed}, not {empty}");
                let without = parse(folder.path(), none).unwrap_err().allowed;
                assert!(without.contains("is missing"), "{place}: {without}");
                continue;
            }
            let without = complaint(None);
            let is_missed = without.as_ref().is_some_and(|words| words.contains("is missing"));
            assert_eq!(is_missed, *needed, "{place}: {without:?}");
            let wrong = match allowed.as_str() {
                "text" => complaint(Some("1")),
                words if words.starts_with("one of") || words.starts_with("a ") => complaint(Some("\"none\"")),
                words if words.ends_with("numbers") || words.ends_with("rows") => complaint(Some("[]")),
                _ => complaint(Some("nan")),
            };
            let wrong = wrong.unwrap_or_else(|| panic!("{place} takes anything"));
            let says = match allowed.as_str() {
                "text" => "must be text in quotes".to_owned(),
                "any" => "must be a finite number".to_owned(),
                words if words.starts_with("one of: ") => {
                    let quoted: Vec<String> = words[8..].split(", ").map(|word| format!("\"{word}\"")).collect();
                    format!("must be one of: {}", quoted.join(", "))
                }
                words if words.starts_with("a ") || words.starts_with("the name") || words == "true or false" => {
                    format!("must be {words}")
                }
                words if words.ends_with(" rows") => {
                    format!("has 0 rows; {} are allowed", words.trim_end_matches(" rows"))
                }
                words if words.ends_with(" numbers") => {
                    format!("has 0 numbers; {} are allowed", words.trim_end_matches(" numbers"))
                }
                words if words.starts_with(char::is_numeric) => format!("must be a finite number, {words}"),
                words => format!("must be a finite number {words}"),
            };
            assert_eq!(wrong, says, "{place}");
        }
    }
}

/// The limits of a table of lifts, which are no fields.
#[test]
fn a_table_of_lifts_has_the_limits_of_the_page() {
    let page = page();
    let (samples, folder) = (samples(&page), folder(&page));
    std::fs::write(folder.path().join("lift.csv"), "angle_deg,lift\n0,1\n180,2\n").unwrap();
    let (_, sample) = samples.iter().find(|(law, _)| law == "table").unwrap();
    let complaint = parse(folder.path(), sample).unwrap_err().allowed;
    let limits = complaint.split_once("; ").unwrap().1.trim_end_matches(" are needed");
    assert!(page.text.contains(&format!("{limits} rows")), "{limits}");
}
