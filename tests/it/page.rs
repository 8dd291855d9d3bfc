//! Is the report's page what its document says, whole in one file, and harmless whatever a model is called?

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::OnceLock;

use crate::common;
use crate::explain::all_are_explained;
use base64::Engine;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::progress::Unwatched;
use corner_impact::study::verify::External;
use corner_impact_cli::pages::report::html;
use corner_impact_cli::report::Report;
use corner_impact_plot::{Data, Figure};
use serde_json::Value;

/// The paper's report and its page, made once.
pub fn papers() -> &'static (Report, String) {
    static MADE: OnceLock<(Report, String)> = OnceLock::new();
    MADE.get_or_init(|| {
        let dossier = Report::of(&Model::built_in().unwrap(), External::LeftOut, None, &Unwatched).unwrap();
        let page = html::render(&dossier).unwrap();
        (dossier, page)
    })
}

/// The text between two others, once for each time that they stand in a page.
fn between<'a>(page: &'a str, from: &str, to: &str) -> Vec<&'a str> {
    page.split(from).skip(1).map(|rest| rest.split(to).next().unwrap()).collect()
}

/// A document that the page carries packed.
fn unpacked(packed: &str) -> Value {
    let bytes = base64::engine::general_purpose::STANDARD.decode(packed).unwrap();
    serde_json::from_reader(flate2::read::ZlibDecoder::new(&bytes[..])).unwrap()
}

fn numbers(value: &Value, found: &mut BTreeSet<u64>) {
    match value {
        // A zero has one sign on the page.
        Value::Number(number) => {
            found.insert((number.as_f64().unwrap() + 0.0).to_bits());
        }
        Value::Array(items) => items.iter().for_each(|item| numbers(item, found)),
        Value::Object(fields) => fields.values().for_each(|field| numbers(field, found)),
        _ => {}
    }
}

/// What a reader takes a number on the page for, and half a unit in its last place.
fn read(text: &str) -> (f64, f64) {
    let text: String = text.replace('\u{2212}', "-").replace("<u>", "").replace("</u>", "");
    let (mantissa, exponent) = match text.split_once("\u{202f}×\u{202f}10<sup>") {
        Some((mantissa, exponent)) => (mantissa.to_owned(), exponent.trim_end_matches("</sup>").parse().unwrap()),
        None => match text.split_once('e') {
            Some((mantissa, exponent)) => (mantissa.to_owned(), exponent.parse().unwrap()),
            None => (text.clone(), 0),
        },
    };
    let places = mantissa.split_once('.').map_or(0, |(_, places)| places.len()) as i32;
    let scale = 10_f64.powi(exponent);
    (mantissa.parse::<f64>().unwrap_or_else(|_| panic!("{text}")) * scale, 0.5 * 10_f64.powi(-places) * scale)
}

#[test]
#[ignore = "slow"]
fn every_number_on_the_page_is_one_of_the_document_and_shows_it() {
    let (dossier, page) = papers();
    let mut known = BTreeSet::new();
    numbers(&serde_json::to_value(dossier).unwrap(), &mut known);
    let cells = between(page, " data-value=\"", "</t");
    assert!(cells.len() > 500, "{} cells", cells.len());
    let shown = [between(page, "<data value=\"", "</data>"), cells].concat();
    assert!(shown.len() > 1000, "{} numbers", shown.len());
    for number in shown {
        let (value, text) = number.split_once("\">").unwrap();
        let value: f64 = value.parse().unwrap();
        assert!(known.contains(&(value + 0.0).to_bits()), "{number}: not in the document");
        let (read, half) = read(text);
        // The sign of an imaginary part stands before it.
        let apart = (read - value).abs().min((read - value.abs()).abs());
        assert!(
            apart <= half + 4.0 * f64::EPSILON * value.abs() || (read == 0.0 && value.abs() < 1e-12),
            "{number}: {read} within {half}"
        );
    }
    let at = &dossier.verification.as_ref().unwrap().at;
    for value in [at.period, at.speed_rpm(), at.x_star()[0], at.velocity_before] {
        assert!(page.contains(&format!("<data value=\"{value}\">")), "{value}");
    }
}

/// Figures that the page draws.
fn drawn(dossier: &Report) -> Vec<(&'static str, &Figure)> {
    let beside = [&dossier.overview, &dossier.loads, &dossier.attractors].into_iter().flatten();
    beside
        .chain(&dossier.plates)
        .filter_map(|plate| plate.drawn.as_ref().ok().map(|drawn| (plate.id, &drawn.figure)))
        .collect()
}

/// Whole multiples of a power of ten, each as its difference from the one before.
fn column(column: &Value) -> (Vec<f64>, f64) {
    let unit = 10_f64.powi(-column["places"].as_i64().unwrap() as i32);
    let mut sum = 0.0;
    let value = |step: &Value| {
        step.as_f64().map_or(f64::NAN, |step| {
            sum += step;
            sum * unit
        })
    };
    (column["steps"].as_array().unwrap().iter().map(value).collect(), unit)
}

/// Half a unit in the last place, and what a sum of units is off by.
fn shows(value: f64, shown: f64, unit: f64) -> bool {
    (value.is_nan() && shown.is_nan()) || (value - shown).abs() <= 0.5001 * unit + 1e-12 * value.abs()
}

#[test]
#[ignore = "slow"]
fn values_of_figures_are_the_documents() {
    let (dossier, page) = papers();
    let mut checked = [0; 3];
    for (id, figure) in drawn(dossier) {
        let part = between(page, &format!("<figure id=\"plate-{id}\""), "</figure>");
        let [part] = part.as_slice() else { panic!("{id}: {} figures", part.len()) };
        let values = unpacked(between(part, "class=\"save\" data-packed=\"", "\"")[0]);
        let panels = values["panels"].as_array().unwrap();
        assert_eq!(panels.len(), figure.panels.len(), "{id}");
        for (told, panel) in panels.iter().zip(&figure.panels) {
            assert_eq!(told["y"]["label"], panel.y.label);
            assert_eq!(told["y"]["unit"], panel.y.unit);
            for told in told["series"].as_array().unwrap() {
                let series = &panel.series[told["number"].as_u64().unwrap() as usize];
                let case = format!("{id}: {} {}", series.label, told["kind"]);
                match &series.data {
                    Data::Points { points, .. } => {
                        let [(x, across), (y, up)] = ["x", "y"].map(|part| column(&told[part]));
                        assert_eq!((x.len(), y.len()), (points.len(), points.len()), "{case}");
                        let told = x.iter().zip(&y).zip(points);
                        assert!(
                            told.clone().all(|((x, y), at)| shows(at[0], *x, across) && shows(at[1], *y, up)),
                            "{case}"
                        );
                        checked[0] += points.len();
                    }
                    Data::Line { points, .. } | Data::Area { points, .. } | Data::Arrow { points, .. } => {
                        let [(x, across), (y, up)] = ["x", "y"].map(|part| column(&told[part]));
                        assert!(x.len() <= points.len(), "{case}");
                        // Each is one of the line's own points, in order.
                        let mut rest = points.iter().filter(|at| !at[0].is_nan() && !at[1].is_nan());
                        let mut kept = x.iter().zip(&y).filter(|(x, _)| !x.is_nan());
                        let is_there =
                            |(x, y): (&f64, &f64)| rest.any(|at| shows(at[0], *x, across) && shows(at[1], *y, up));
                        assert!(kept.all(is_there), "{case}");
                        checked[1] += x.len();
                    }
                    Data::Density(cells) => {
                        let (gaps, counts) = (told["gaps"].as_array().unwrap(), told["counts"].as_array().unwrap());
                        let rows = told["rows"].as_u64().unwrap();
                        let mut cell = 0;
                        let told: BTreeSet<([usize; 2], u64)> = (gaps.iter().zip(counts))
                            .map(|(gap, count)| {
                                cell += gap.as_u64().unwrap();
                                ([(cell / rows) as usize, (cell % rows) as usize], count.as_u64().unwrap())
                            })
                            .collect();
                        let known = cells.occupied_cells().map(|(at, count)| (at, u64::from(count))).collect();
                        assert_eq!(told, known, "{case}");
                        checked[2] += told.len();
                    }
                    Data::Band { .. } | Data::Region { .. } | Data::Words(_) => {}
                }
            }
        }
    }
    assert!(checked[0] > 500 && checked[1] > 5000 && checked[2] > 50_000, "{checked:?}");
}

/// The module of the live page is in it if the program has one.
#[test]
#[ignore = "slow"]
fn the_page_needs_nothing_beside_it_and_is_small() {
    let (_, page) = papers();
    let most = if page.contains("id=\"explore-module\"") { 2_500_000 } else { 1_400_000 };
    assert!(page.len() < most, "{} bytes", page.len());
    let markup = page.split("<script>").next().unwrap();
    let elements = markup.matches('<').count() - markup.matches("</").count() - markup.matches("<!").count();
    assert!((5000..9500).contains(&elements), "{elements} elements");
    for loading in [
        "src=\"http",
        "href=\"http",
        "src=\"//",
        "url(http",
        "@import",
        "<link",
        "<iframe",
        "fetch(",
        "XMLHttpRequest",
        "import(",
    ] {
        assert!(!page.contains(loading), "{loading}");
    }
    for image in between(page, "<image", ">") {
        assert!(image.contains("href=\"data:image/png;base64,"), "{}", &image[..200.min(image.len())]);
    }
    // Addresses that are names, and nothing that is fetched.
    let addresses: BTreeSet<&str> = between(page, "http://", "\"").into_iter().collect();
    assert!(addresses.iter().all(|address| address.starts_with("www.w3.org/")), "{addresses:?}");
    assert!(!page.contains("https://"));
}

#[test]
#[ignore = "slow"]
fn every_link_leads_to_a_place_on_the_page_and_no_place_is_named_twice() {
    let (_, page) = papers();
    let markup = page.split("<script>").next().unwrap();
    let ids = between(markup, " id=\"", "\"");
    let known: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(known.len(), ids.len());
    let links = between(markup, "href=\"#", "\"");
    assert!(links.len() > 100, "{}", links.len());
    assert!(links.iter().all(|link| known.contains(link)), "{links:?}");
}

#[test]
#[ignore = "slow"]
fn claims_routes_and_figures_are_all_there() {
    let (dossier, page) = papers();
    let ledger = dossier.claims.as_ref().unwrap();
    assert_eq!(between(page, "<li class=\"claim ", ">").len(), ledger.claims.len());
    for verdict in ["holds", "definition", "in-part", "misprint", "refuted", "open"] {
        let expected = ledger.claims.iter().filter(|claim| claim.verdict.to_string() == verdict).count();
        assert_eq!(between(page, &format!("data-verdict=\"{verdict}\""), ">").len(), expected, "{verdict}");
    }
    for route in &dossier.verification.as_ref().unwrap().routes {
        let name = route.name.to_string().replace('_', " ");
        assert!(page.contains(&format!("<th class=\"n\" scope=\"col\">{name}</th>")), "{name}");
    }
    for plate in &dossier.plates {
        assert_eq!(page.matches(&format!("id=\"plate-{}\"", plate.id)).count(), 1, "{}", plate.id);
        assert!(page.contains(&format!("<code class=\"command\">{}</code>", plate.command)), "{}", plate.command);
    }
    let places: Vec<usize> = dossier
        .plates
        .iter()
        .filter(|plate| plate.id != "cam" && plate.id != "fast-impacts")
        .map(|plate| page.find(&format!("id=\"plate-{}\"", plate.id)).unwrap())
        .collect();
    assert!(places.is_sorted());
    // In whatever part of the page: of the verdict, and of the proof behind a claim.
    for set in ["meet at <i>ω</i><sup>*</sup>", "x = <i>W</i><sup>−1</sup> <i>x</i>\u{303} brings"] {
        assert!(page.contains(set), "{set}");
    }
}

/// A model file's texts are its author's: markup in them is text on the page, and nothing in them steers it.
#[test]
#[ignore = "slow"]
fn a_models_name_is_text_whatever_it_holds() {
    let evil = "</script><script>alert(1)</script><img src=x onerror=alert(2)> \\\" & 'x' \\u001b[31m\\u0000\\u202e";
    let text = OSORIO_2008.replacen("name = \"osorio-2008\"", &format!("name = \"{evil}\""), 1);
    let text = text.replacen("source = \"\"\"", &format!("source = \"\"\"{} a_1 ", evil.replace("\\\"", "'")), 1);
    let model = Model::parse("<b>evil</b>.toml", &text).unwrap();
    assert!(model.name.contains("<script>"));
    let dossier = Report::of(&model, External::LeftOut, Some([690.0, 700.0]), &Unwatched).unwrap();
    assert!(dossier.claims.is_some());
    let page = html::render(&dossier).unwrap();
    for raw in ["<script>alert", "<img src=x", "<b>evil"] {
        assert!(!page.contains(raw), "{raw}");
    }
    // What looks like a formula is one only in words of the program.
    assert!(page.contains(" a_1 "));
    assert!(page.contains("&lt;script&gt;alert(1)") && page.contains("\\u{1b}[31m\\u{0}\\u{202e}"));
    assert!(!page.contains(|letter: char| letter.is_control() && letter != '\n' || letter == '\u{202e}'));
    assert_eq!(page.matches("<script").count(), page.matches("</script>").count());
}

#[test]
#[ignore = "slow"]
fn what_disagrees_stands_in_the_headline() {
    let (dossier, page) = papers();
    assert!(page.contains("Everything that was checked agrees."));
    assert!(!page.contains("What does not agree"));
    let mut other = dossier.clone();
    other.agrees = false;
    let pair = &mut other.verification.as_mut().unwrap().comparisons[0];
    pair.agrees = false;
    let page = html::render(&other).unwrap();
    assert!(page.contains("Something that was checked does not agree."));
    assert!(page.contains("What does not agree"));
    assert!(!page.contains("Everything that was checked agrees."));
}

fn report(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let run = common::program(["report"]).args(arguments).current_dir(folder).output().unwrap();
    (run.status.code().unwrap(), common::text(run.stdout), common::text(run.stderr))
}

#[test]
#[ignore = "slow"]
fn a_model_without_a_corner_impact_has_a_page_that_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let model = Path::new(common::ROOT).join("models/laws/harmonic.toml");
    let model = model.to_str().unwrap();
    // One that does not bounce has few motions to look for.
    let (code, out, _) = report(folder.path(), &[model, "--set", "restitution=0"]);
    assert_eq!((code, out.as_str()), (0, "harmonic-follower.restitution-0-report.html\n"));
    let page = std::fs::read_to_string(folder.path().join(out.trim_end())).unwrap();
    assert!(page.contains(
        "No corner impact is verified here: the model file has no [study], the range of speeds in which to look for"
    ));
    assert!(!page.contains("study.rpm_min is needed"));
    let sections: Vec<&str> = between(&page, "<section id=\"", "\"").into_iter().collect();
    assert_eq!(sections, ["answer", "explore", "loads", "model", "speeds", "figures", "reproduce", "numbers"]);
    // In the place of the live page stands what there is to see of a machine without a corner impact.
    assert!(between(&page, "<section id=\"explore\"", "</section>")[0].contains("id=\"plate-attractors\""));
    all_are_explained(&page);
    for said in ["Separation.", "Impacts.", "Coexistence.", "What is proved.", "id=\"plate-overview\""] {
        let at = page.find(said).unwrap_or_else(|| panic!("{said}"));
        assert!(at < page.find("<section id=\"model\"").unwrap(), "{said} is not in the answer");
    }
    // Its own speeds: it separates at 315.57 rpm, and its spring's own speed is 191.
    assert!(
        page.contains("impacts from 250 to 640 rpm") && !page.contains("Not drawn"),
        "{:?}",
        between(&page, "<figcaption>", "</figcaption>")
    );
    assert!(!page.contains("id=\"plate-fast-impacts\"") && !page.contains("id=\"ledger-filter\""));
    assert!(page.contains("id=\"plate-cam\"") && page.contains("id=\"speeds\""));
}

#[test]
#[ignore = "slow"]
fn the_command_says_what_it_cannot_do() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, words) in [
        (&["--json", "--out", "-"][..], "both print to standard output"),
        (&["--out", "page.csv"][..], "must end in .html"),
        (&["--out", "nowhere/page.html"][..], "nowhere/page.html"),
        (&["nothing.toml"][..], "nothing.toml"),
    ] {
        let (code, out, err) = report(folder.path(), arguments);
        assert_eq!((code, out.as_str()), (2, ""), "{err}");
        assert!(err.contains(words), "{err}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// Two digits of a small number are two, with and without a power of ten.
#[test]
#[ignore = "slow"]
fn sizes_have_two_digits() {
    let mut dossier = papers().0.clone();
    let pairs = &mut dossier.verification.as_mut().unwrap().comparisons;
    let sizes =
        [(0.0149, "0.015"), (0.0251, "0.025"), (0.5, "0.5"), (1.2345e-4, "1.2\u{202f}×\u{202f}10<sup>\u{2212}4</sup>")];
    for (pair, (size, _)) in pairs.iter_mut().zip(sizes) {
        pair.max_abs_diff = size;
    }
    pairs[4].max_abs_diff = f64::NAN;
    let page = html::render(&dossier).unwrap();
    for (size, text) in sizes {
        assert!(page.contains(&format!(" data-value=\"{size}\">{text}</td>")), "{size} as {text}");
    }
    assert!(page.contains("NaN") && !page.contains("NaN\u{202f}×"));
}
