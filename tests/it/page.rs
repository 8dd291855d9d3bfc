//! Is the report's page what its document says, whole in one file, and harmless whatever a model is called?

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::OnceLock;

use crate::common;
use crate::explain::all_are_explained;
use base64::Engine;
use corner_impact::border_collision::feigin::Speeds;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::orbit::eigenvalues;
use corner_impact::progress::Unwatched;
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::{Machine, angular_velocity};
use corner_impact::study::verify::{External, verify};
use corner_impact_cli::figures::through_corner::{ImpactSide, Moment, ShownOrbit, through_corner};
use corner_impact_cli::pages::report::html;
use corner_impact_cli::report::Report;
use corner_impact_cli::report::through::ThroughCorner;
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
    let shown = between(page, "<data value=\"", "</data>");
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

#[test]
#[ignore = "slow"]
fn the_sliders_data_are_the_documents() {
    let (dossier, page) = papers();
    let embedded = between(page, "id=\"through-data\">", "</script>");
    let [embedded] = embedded.as_slice() else { panic!("{} blocks of data", embedded.len()) };
    let embedded = unpacked(embedded);
    assert_eq!(embedded, serde_json::to_value(dossier.through.as_ref().unwrap()).unwrap());
}

#[test]
#[ignore = "slow"]
fn the_page_needs_nothing_beside_it_and_is_small() {
    let (_, page) = papers();
    assert!(page.len() < 5_000_000, "{} bytes", page.len());
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
        .filter(|plate| plate.id != "cam")
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
    assert!(dossier.through.is_ok() && dossier.claims.is_some());
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

/// The same text in the slider's data would end its element.
#[test]
#[ignore = "slow"]
fn text_in_the_sliders_data_does_not_end_it() {
    let mut dossier = papers().0.clone();
    dossier.through.as_mut().unwrap().corner = "</script><script>alert(1)</script><!--".into();
    let page = html::render(&dossier).unwrap();
    assert!(!page.contains("<script>alert"));
    let embedded = between(&page, "id=\"through-data\">", "</script>");
    let embedded = unpacked(embedded[0]);
    assert_eq!(embedded["corner"], "</script><script>alert(1)</script><!--");
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
        "No corner impact is verified here: the model file has no [study], which says at which speeds to look for"
    ));
    assert!(!page.contains("study.rpm_min is needed"));
    let sections: Vec<&str> = between(&page, "<section id=\"", "\"").into_iter().collect();
    assert_eq!(sections, ["answer", "loads", "model", "speeds", "figures", "reproduce", "numbers"]);
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
    assert!(!page.contains("id=\"through-data\"") && !page.contains("id=\"ledger-filter\""));
    assert!(page.contains("id=\"plate-cam\"") && page.contains("id=\"speeds\""));
}

#[test]
#[ignore = "slow"]
fn the_command_says_what_it_cannot_do() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, words) in [
        (&["--json", "--out", "-"][..], "both want standard output"),
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

/// The orbits next to the corner impact are those that Feigin's classification counts, for every model that has one.
#[test]
#[ignore = "slow"]
fn orbits_on_either_side_are_those_of_the_classification() {
    let mut checked = 0;
    for file in common::model_files() {
        let model = common::read(&file);
        let findings = verify(&model, External::LeftOut).unwrap();
        let Ok(kind) = &findings.classification else { continue };
        checked += 1;
        let cam = common::cam(&model);
        let (moments, at_corner) = through_corner(&model, &cam, &findings.at).unwrap().unwrap();
        let [slower, faster] = [&moments[at_corner - 1], &moments[at_corner + 1]];
        for (place, side) in [(ImpactSide::Before, &kind.minus), (ImpactSide::After, &kind.plus)] {
            let of = |moment: &Moment| {
                // Another orbit on the same segment, far from the corner, is none of the local map's.
                let beside = |orbit: &&ShownOrbit| orbit.from_corner_deg.to_radians().abs() < 0.05;
                let here = moment.orbits.iter().filter(|orbit| orbit.place == place).filter(beside);
                here.map(|orbit| orbit.stable).collect::<Vec<_>>()
            };
            let expected = |there: bool| if there { vec![side.stable] } else { vec![] };
            let (on_faster, on_slower) = match side.exists_for {
                Speeds::Faster => (true, false),
                Speeds::Slower => (false, true),
            };
            assert_eq!(of(faster), expected(on_faster), "{} {place:?} faster", file.display());
            assert_eq!(of(slower), expected(on_slower), "{} {place:?} slower", file.display());
            // At the corner impact the multipliers are the eigenvalues of that side's matrix.
            let at = moments[at_corner].orbits.iter().find(|orbit| orbit.place == place).unwrap();
            let map = &findings.map;
            let matrix = if place == ImpactSide::Before { map.minus.a } else { map.plus.a };
            for (one, other) in at.multipliers.iter().zip(eigenvalues(&matrix)) {
                assert!((one.re - other.re).hypot(one.im - other.im) < 1e-6, "{}: {one:?} {other:?}", file.display());
            }
        }
    }
    assert!(checked >= 8, "{checked}");
}

/// A machine ten thousand times smaller has the same slider, in its own numbers.
#[test]
#[ignore = "slow"]
fn the_slider_shows_a_machine_of_any_size() {
    const SMALLER: f64 = 1e-4;
    let lengths = ["follower.rest_position", "cam.base_radius", "cam.flank_radius", "cam.nose_radius"];
    let model = common::osorio();
    let mut small = model.clone();
    for name in lengths {
        let length = model.numbers().find(|(path, _)| *path == name).unwrap().1;
        small = small.with_number(name, SMALLER * length).unwrap();
    }
    let shown = |model: &Model| {
        let (cam, at) = (common::cam(model), verify(model, External::LeftOut).unwrap().at);
        ThroughCorner::new(through_corner(model, &cam, &at).unwrap().unwrap(), &cam, at.corner.angle).unwrap()
    };
    let (large, small) = (shown(&model), shown(&small));
    assert_eq!((large.corner.as_str(), small.corner.as_str()), ("P", "P"));
    assert_eq!(large.cam.len(), small.cam.len());
    // Half a step of the fifth digit of the travel, and as much of the other's.
    let near = |one: f64, other: f64, extent: f64| (SMALLER * one - other).abs() <= SMALLER * extent * 1.1e-4;
    for (one, other) in large.cam.iter().zip(&small.cam) {
        assert!(near(one[1], other[1], 0.154) && near(one[2], other[2], 2.2), "{one:?} {other:?}");
    }
    let speeds: Vec<f64> = large.frames.iter().map(|frame| frame.rpm).collect();
    assert!(speeds.windows(2).all(|pair| pair[0] < pair[1]), "{speeds:?}");
    for (one, other) in large.frames.iter().zip(&small.frames) {
        assert_eq!(one.orbits.len(), other.orbits.len());
        for (one, other) in one.orbits.iter().zip(&other.orbits) {
            assert!(near(one.velocity_before_m_s, other.velocity_before_m_s, 200.0), "{one:?} {other:?}");
            assert!(other.path.iter().all(|[_, position]| *position > 0.0));
        }
    }
    for axes in [&large.axes, &small.axes] {
        for axis in [&axes.position, &axes.acceleration, &axes.speed, &axes.near] {
            assert!(axis.range[0] < axis.range[1] && !axis.ticks.is_empty(), "{axis:?}");
        }
    }
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
        assert!(page.contains(&format!("<data value=\"{size}\">{text}</data>")), "{size} as {text}");
    }
    assert!(page.contains("NaN") && !page.contains("NaN\u{202f}×"));
}

/// Drawn orbits and multipliers against the simulator, which knows neither.
#[test]
#[ignore = "slow"]
fn drawn_orbits_are_those_of_the_simulator() {
    let model = common::osorio();
    let cam = common::cam(&model);
    let findings = verify(&model, External::LeftOut).unwrap();
    let (moments, at_corner) = through_corner(&model, &cam, &findings.at).unwrap().unwrap();
    let machine = Machine::new(cam, &model.follower, 1.0);
    let mut checked = 0;
    for moment in moments.iter().skip(at_corner + 1).step_by(10) {
        let machine = machine.at_speed(angular_velocity(moment.rpm));
        assert_eq!(moment.orbits.len(), 2, "{}", moment.rpm);
        for orbit in &moment.orbits {
            let angle = orbit.angle_deg.to_radians();
            let cam_velocity = machine.angular_velocity() * machine.cam().lift(angle).slope;
            let guess = machine.start_on_cam(angle, orbit.velocity_after_m_s - cam_velocity).unwrap();
            let map = StroboscopicMap { machine: machine.clone(), cam_angle: 0.0 };
            let mut motion = guess;
            let goal = motion.next(0.0);
            let _ = machine.advance(&mut motion, goal, &mut corner_impact::simulate::Unobserved).unwrap();
            let first = orbit.path[0];
            assert!((first[1] - motion.state.position).abs() < 1e-8, "{first:?} {:?}", motion.state);
            let (state, matrix) = map.carry(motion.state, 1).unwrap();
            assert!((state.position - motion.state.position).abs() < 1e-8);
            for (one, other) in orbit.multipliers.iter().zip(eigenvalues(&matrix)) {
                assert!((one.re - other.re).hypot(one.im - other.im) < 1e-6, "{}: {one:?} {other:?}", moment.rpm);
            }
            checked += 1;
            if orbit.stable {
                let run = moment.slowing.impacts_deg.last().unwrap();
                assert!((run.to_radians() - angle).abs() < 1e-3, "{}: {run} {}", moment.rpm, orbit.angle_deg);
            }
        }
    }
    assert!(checked >= 18, "{checked}");
    // Slower there is no such orbit; a run has other impacts, once it is far enough not to dwell where the orbit was.
    for moment in &moments[..at_corner] {
        assert!(moment.orbits.is_empty(), "{}", moment.rpm);
        let near = findings.at.speed_rpm() - moment.rpm < 1.0;
        let last = moment.slowing.impacts_deg.last().unwrap();
        assert!(near || moment.slowing.impacts_deg.iter().any(|angle| (angle - last).abs() > 10.0), "{}", moment.rpm);
    }
}
