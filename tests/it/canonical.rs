//! Is the text of a model the model, whole, and does a document say what a file says?

use std::path::Path;

use corner_impact::cam::Cam;
use corner_impact::model::Model;
use serde_json::json;

use crate::common;

#[test]
fn a_text_is_read_as_the_same_model() {
    let root = Path::new(common::ROOT).join("models");
    let folders = [root.clone(), root.join("laws"), root.join("jump-order")];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap()).map(|entry| entry.unwrap().path());
    let files: Vec<_> = files.filter(|file| file.extension().is_some_and(|end| end == "toml")).collect();
    assert!(files.len() > 12, "{}", files.len());
    for model in files.iter().map(|file| common::read(file)) {
        let text = model.text();
        let again = Model::parse("a text", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(again.text(), text);
        assert_eq!((&again.name, &again.source, again.study), (&model.name, &model.source, model.study));
        assert_eq!((again.follower, Cam::new(&again).unwrap()), (model.follower, Cam::new(&model).unwrap()));
    }
}

#[test]
fn a_text_has_what_was_changed_and_any_letters() {
    let mut named = common::osorio().changed(&[("mass".into(), 1e-7), ("corner_rounding_deg".into(), 0.1)]).unwrap();
    named.name = "a \"name\" \\ of\n\t\u{7f}\u{1}ünusual letters".into();
    let again = Model::parse("a text", &named.text()).unwrap();
    assert_eq!((&again.name, again.follower.mass, &again.cam), (&named.name, 1e-7, &named.cam));
}

#[test]
fn a_document_is_a_file() {
    let follower = json!({ "mass": 1, "damping": 0, "stiffness": 400.0, "gravity": 9.81, "rest_position": 0.1, "restitution": 0.6 });
    let cam = json!({ "law": "table", "spline": "cubic", "rows": [[0, 0.1], [120.0, 0.12], [240, 0.11], [360, 0.1]] });
    let read = |cam| Model::of_document("a document", &json!({ "follower": follower, "cam": cam }));
    let model = read(cam.clone()).unwrap();
    assert_eq!(Model::parse("a text", &model.text()).unwrap().text(), model.text());
    let refused = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut cam = cam.clone();
        change(&mut cam);
        read(cam).unwrap_err().to_string()
    };
    let rows = |rows: serde_json::Value| refused(&|cam| cam["rows"] = rows.clone());
    assert!(rows(json!([[0, 0.1], [120, 0.2]])).contains("cam.rows has 2 rows; 3 to 1000000 are allowed"));
    assert!(rows(json!([[0, 0], [1, 0], [1, 1]])).contains("must be above 1, row 2"));
    assert!(
        rows(json!([[0, 0], [1, 0], [370, 0]]))
            .contains("angle_deg = 370: must be within a turn of the first row, from 0 to 360")
    );
    assert!(rows(json!([[0, 0], [1, 0, 2]])).contains("must be a list of rows"));
    assert!(refused(&|cam| cam["file"] = json!("lift.csv")).contains("must not be given together with cam.rows"));
    assert!(refused(&|cam| cam["a.b"] = json!(1)).contains("cam.a.b: a name must not have a dot"));
    assert!(refused(&|cam| cam["law"] = json!(null)).contains("cam.law = null: must be text in quotes"));
    assert!(Model::of_document("a document", &json!([])).unwrap_err().to_string().contains("must be a table"));
    let slip = json!({ "folower": follower, "cam": cam });
    let slip = Model::of_document("a document", &slip).unwrap_err();
    assert!(slip.to_string().contains("did you mean [follower] where it says [folower]?") && slip.line.is_none());
}
