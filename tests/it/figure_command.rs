//! Does `corner-impact figure` list what there is, draw one figure, and say why there is none?

use std::ffi::OsString;
use std::path::Path;

use corner_impact::cli::{Exit, run};

fn command(words: &[&str]) -> (Exit, String, String) {
    let words = ["corner-impact", "figure"].iter().chain(words).map(OsString::from);
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let exit = run(words, &mut out, &mut err);
    (exit, String::from_utf8(out).unwrap(), String::from_utf8(err).unwrap())
}

fn file(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(name).display().to_string()
}

#[test]
fn it_lists_the_figures_and_each_name_of_the_list_is_drawn() {
    let (exit, page, _) = command(&[]);
    assert_eq!(exit, Exit::Agrees);
    assert_eq!(page.lines().count(), 14, "{page}");
    let first = page.lines().next().unwrap();
    assert!(first.starts_with("cam-shape ") && first.contains("Figures 3(a) and 9"), "{first}");
    let (_, listed, _) = command(&["--json"]);
    let listed: serde_json::Value = serde_json::from_str(&listed).unwrap();
    assert_eq!(listed["schema"], "corner-impact/figure/1");
    for (line, figure) in page.lines().zip(listed["figures"].as_array().unwrap()) {
        assert!(line.starts_with(figure["id"].as_str().unwrap()) && line.ends_with(figure["title"].as_str().unwrap()));
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drawn.svg").display().to_string();
    let (exit, page, err) = command(&["local-map", "--out", &path]);
    assert_eq!(exit, Exit::Agrees, "{err}");
    assert!(page.contains("Figure 8 of the paper"), "{page}");
    assert!(std::fs::read_to_string(&path).unwrap().contains("673.2344 rpm"));
}

#[test]
fn a_model_file_goes_before_the_name() {
    let model = file("damped-heavy.toml");
    let (exit, page, err) = command(&[&model, "corner-orbit"]);
    assert_eq!(exit, Exit::Agrees, "{err}");
    assert!(page.contains("706.478"), "{page}");
    assert!(page.contains("(as Figure 5(e) of the paper)"), "{page}");
    let (_, list, _) = command(&[&model]);
    assert!(list.lines().count() == 14 && list.contains("damped-heavy: the cam"), "{list}");
    assert!(page.contains(&format!("corner-impact figure {model} corner-orbit --out corner-orbit.svg")), "{page}");
    let (_, document, _) = command(&[&model, "corner-orbit", "--json"]);
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    assert!(document["figure"]["panels"][0]["series"].is_array() && document["absent"].is_null());
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drawn.png");
    let out = path.display().to_string();
    let cases: [(&[&str], &str); 4] = [
        (&["chaos"], "no figure called \"chaos\"; there are: cam-shape, cam,"),
        (&[&file("laws/harmonic.toml"), "composition", "--out", &out], "[study]"),
        (&[&file("laws/rectified-sine.toml"), "slow-trace", "--out", &out], "begins to leave the cam"),
        (&["--out", &out], "--out is for one figure"),
    ];
    for (words, wanted) in cases {
        let (exit, _, err) = command(words);
        assert_eq!(exit, Exit::BadInput, "{words:?}");
        assert!(err.contains(wanted), "{words:?}: {err}");
        assert!(!path.exists());
    }
    let (exit, document, _) = command(&[&file("laws/harmonic.toml"), "composition", "--json"]);
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    assert_eq!(exit, Exit::Agrees);
    assert!(document["figure"].is_null() && document["absent"].as_str().unwrap().contains("[study]"));
}
