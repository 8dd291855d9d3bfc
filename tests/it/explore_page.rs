//! Does the live page work in a browser, opened from disk and from its server? Without Chromium its tests say that they are skipped.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::OnceLock;

use corner_impact_cli::live;
use corner_impact_explore::respond;
use serde_json::{Value, json};

use crate::browser::devtools::Page;
use crate::common::{osorio, program};
use crate::explore_server::client::Served;

/// The paper's page in one file, written once. A build without the module has none, which `make explore` mends.
fn written() -> Option<&'static Path> {
    static WRITTEN: OnceLock<Option<PathBuf>> = OnceLock::new();
    let written = WRITTEN.get_or_init(|| {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("explore-{}.html", std::process::id()));
        match live::page(&osorio()) {
            Ok(page) => std::fs::write(&file, page).unwrap(),
            // Where a browser is named, nothing is to be skipped.
            Err(error) if std::env::var_os("CORNER_IMPACT_BROWSER").is_none() => {
                eprintln!("SKIPPED: {error}");
                return None;
            }
            Err(error) => panic!("{error}"),
        }
        Some(file)
    });
    written.as_deref()
}

/// Open from disk, with every view in sight computed.
fn open() -> Option<Page> {
    let mut page = Page::open(written()?)?;
    settle(&mut page);
    Some(page)
}

/// Waits until nothing is being computed, and nothing is about to be.
fn settle(page: &mut Page) {
    page.until("Boolean(Explore.app && (Explore.app.model || Explore.app.reason))");
    page.value("new Promise((done) => setTimeout(done, 400))");
    page.until("Explore.app.transport.pending() === 0");
    page.value("new Promise((done) => setTimeout(done, 200))");
    page.until("Explore.app.transport.pending() === 0");
}

/// Sentences of complaint that stand on the page.
fn sentences(page: &mut Page) -> Value {
    page.value("[...document.querySelectorAll('.explore .sentence:not([hidden])')].map((each) => each.textContent)")
}

fn assert_quiet(page: &Page) {
    // A question that a newer one replaces is answered by a conflict.
    let complaints = page.complaints().into_iter().filter(|said| !said.contains("409 (Conflict)"));
    assert_eq!(complaints.collect::<Vec<_>>(), Vec::<String>::new());
    let is_outside =
        |url: &String| !["file://", "data:", "blob:", "http://127.0.0.1:"].iter().any(|own| url.starts_with(own));
    assert_eq!(page.requests().into_iter().filter(is_outside).collect::<Vec<_>>(), Vec::<String>::new());
}

/// A question of each view.
fn questions() -> Vec<Value> {
    let over = json!({ "name": "rpm", "low": 660.0, "high": 750.0, "count": 20 });
    let restitution = json!({ "name": "restitution", "low": 0.5, "high": 0.9, "count": 7 });
    let changed = json!({ "file": null, "text": null, "set": { "follower.restitution": 0.7 } });
    vec![
        json!({ "view": "model", "model": changed }),
        json!({ "view": "cam" }),
        json!({ "view": "template", "law": "contour" }),
        json!({ "view": "motion", "rpm": 670.0, "model": changed }),
        json!({ "view": "motion", "rpm": 670.0, "revolutions": 300, "samples": 0 }),
        json!({ "view": "long_run", "rpm": 670.0 }),
        json!({ "view": "diagram", "over": over }),
        json!({ "view": "diagram", "rpm": 700.0, "over": restitution }),
        json!({ "view": "speeds", "over": { "name": "rpm", "low": 685.0, "high": 745.0, "count": 4 }, "starts": 3 }),
        json!({ "view": "orbit", "rpm": 700.0 }),
        json!({ "view": "basins", "rpm": 678.0, "grid": [12, 9] }),
        json!({ "view": "verify", "model": changed }),
        json!({ "view": "local" }),
        json!({ "view": "design", "needs": ["no separation to 130 rpm"] }),
        json!({ "view": "motion", "rpm": 0.0 }),
    ]
}

/// Answers of the page's transport are those of the function, to the last digit.
fn assert_answers(page: &mut Page, questions: &[Value]) {
    for question in questions {
        let expected: Value = serde_json::from_str(&respond(&question.to_string())).unwrap();
        let found = page.value(&format!("Explore.app.transport.ask({question}, 'test', {{ slow: true }})"));
        assert_eq!(exactly(found), exactly(expected), "{question}");
    }
}

/// Without the fit by least squares, whose last digits are the processor's own: faer takes the fastest instructions that it finds.
fn exactly(mut answer: Value) -> Value {
    let is_of_fit =
        |compared: &Value| compared["routes"].as_array().is_some_and(|routes| routes.contains(&json!("least_squares")));
    if answer["view"] == "verify" {
        answer["found"]["routes"]["least_squares"] = Value::Null;
        answer["found"]["agreement"].as_array_mut().unwrap().retain(|compared| !is_of_fit(compared));
    }
    timeless(answer)
}

/// Drops what the clock says, which a browser's page has not. Numbers are doubles, as a browser has them: 90 is 90.0.
fn timeless(answer: Value) -> Value {
    match answer {
        Value::Object(fields) => fields
            .into_iter()
            .filter(|(name, _)| name != "wall_s")
            .map(|(name, value)| (name, timeless(value)))
            .collect(),
        Value::Array(values) => values.into_iter().map(timeless).collect(),
        Value::Number(number) => json!(number.as_f64()),
        other => other,
    }
}

#[test]
#[ignore = "slow"]
fn the_module_has_the_answers_of_the_program() {
    let Some(mut page) = open() else { return };
    assert_answers(&mut page, &questions());
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn the_server_has_the_answers_of_the_program() {
    let mut child = program(["explore", "--no-open"]).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    let mut address = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut address).unwrap();
    if let Some(mut page) = Page::visit(address.trim()) {
        settle(&mut page);
        assert_answers(&mut page, &questions());
        assert_eq!(sentences(&mut page), json!([]));
        assert_quiet(&page);
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

/// Moves the slider of a number, as a hand does: `input` while it moves, `change` when it is let go.
fn slide(page: &mut Page, path: &str, position: u32) {
    page.value(&format!(
        "(() => {{ const s = document.querySelector('[data-path=\"{path}\"] input[type=range]'); s.value = {position};
           s.dispatchEvent(new Event('input', {{ bubbles: true }})); s.dispatchEvent(new Event('change', {{ bubbles: true }})); }})()"
    ));
}

#[test]
#[ignore = "slow"]
fn every_number_has_a_slider_that_is_undone() {
    let Some(mut page) = open() else { return };
    let paths = page.value("['rpm', ...Explore.app.model.numbers.map(({ path }) => path)]");
    let before = page.value("JSON.stringify(Explore.app.store.state)");
    for path in paths.as_array().unwrap() {
        let path = path.as_str().unwrap();
        let is_there = page.value(&format!("document.querySelectorAll('[data-path=\"{path}\"] input').length"));
        assert_eq!(is_there, 2, "{path}: a slider and a field");
        let was = page.value(&format!("Explore.app.value('{path}')"));
        slide(&mut page, path, 260);
        let now = page.value(&format!("Explore.app.value('{path}')"));
        assert_ne!(was, now, "{path}");
        let field =
            page.value(&format!("Number(document.querySelector('[data-path=\"{path}\"] input[type=text]').value)"));
        assert!(
            (field.as_f64().unwrap() - now.as_f64().unwrap()).abs() <= 1e-3 * now.as_f64().unwrap().abs().max(1e-3),
            "{path}: {field} for {now}"
        );
        page.value("Explore.app.store.undo()");
        assert_eq!(page.value("JSON.stringify(Explore.app.store.state)"), before, "{path}");
        page.value("Explore.app.store.redo()");
        assert_eq!(page.value(&format!("Explore.app.value('{path}')")), now, "{path}");
        page.value("Explore.app.store.undo()");
    }
    settle(&mut page);
    assert_eq!(sentences(&mut page), json!([]));
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn a_hundred_quick_moves_leave_one_last_answer_and_no_backlog() {
    let Some(mut page) = open() else { return };
    let slider = "document.querySelector('[data-path=\"follower.restitution\"] input[type=range]')";
    page.value(&format!(
        "(async () => {{ for (let i = 0; i < 100; i += 1) {{ {slider}.value = 300 + i; {slider}.dispatchEvent(new Event('input', {{ bubbles: true }}));
           await new Promise((done) => setTimeout(done, 5)); }} {slider}.dispatchEvent(new Event('change', {{ bubbles: true }})); }})()"
    ));
    // No lane has more than one question that waits and one that runs.
    let lanes = page.value("Explore.app.views.panels.reduce((sum, { context }) => sum + context.lanes.size, 0) + 2");
    let pending = page.value("Explore.app.transport.pending()");
    assert!(pending.as_u64() <= Some(2 * lanes.as_u64().unwrap()), "{pending} questions of {lanes} lanes");
    settle(&mut page);
    let set = page.value("Explore.app.store.state.set");
    assert_eq!(set.as_object().unwrap().len(), 1, "{set}");
    let shown = page.value(
        "Explore.app.views.panels.find(({ view }) => view.name === 'machine').context.answer().found.position_m",
    );
    let rpm = page.value("Explore.app.store.state.rpm");
    let question = page.value("Explore.app.question()");
    let asked = page
        .value("Explore.app.views.panels.find(({ view }) => view.name === 'machine').context.lanes.get('machine').key");
    let asked: Value = serde_json::from_str(asked.as_str().unwrap()).unwrap();
    assert_eq!((&asked["model"], &asked["rpm"]), (&question, &rpm), "the last answer is of the last position");
    let expected: Value = serde_json::from_str(&respond(&asked.to_string())).unwrap();
    assert_eq!(shown, expected["found"]["position_m"]);
    // The whole drag is one step of undo.
    page.value("Explore.app.store.undo()");
    assert_eq!(page.value("Explore.app.store.state.set"), json!({}));
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn a_link_brings_the_state_back() {
    let Some(mut page) = open() else { return };
    page.value("Explore.app.assign('follower.restitution', 0.72)");
    page.value("Explore.app.assign('rpm', 690)");
    settle(&mut page);
    let (link, headline) =
        (page.value("Explore.app.store.link()"), page.value("document.querySelector('.headline').textContent"));
    let Some(mut other) = Page::visit(link.as_str().unwrap()) else { return };
    settle(&mut other);
    assert_eq!(other.value("Explore.app.store.state.set"), json!({ "follower.restitution": 0.72 }));
    assert_eq!(other.value("document.querySelector('.headline').textContent"), headline);
    other.click(".bar-buttons button:nth-child(3)");
    settle(&mut other);
    assert_eq!(other.value("Explore.app.store.state.set"), json!({}), "Reset");
    assert_quiet(&other);
}

#[test]
#[ignore = "slow"]
fn every_view_shows_something_and_has_its_command() {
    let Some(mut page) = open() else { return };
    let names = page.value("Explore.views.map(({ name }) => name)");
    assert!(names.as_array().unwrap().len() >= 6, "{names}");
    for name in names.as_array().unwrap() {
        let name = name.as_str().unwrap();
        page.value(&format!("document.getElementById('view-{name}').scrollIntoView({{ behavior: 'instant' }})"));
        settle(&mut page);
        let of = |what: &str| {
            format!(
                "(() => {{ const {{ panel, context, instance, view }} = Explore.app.views.panels.find(({{ view }}) => view.name === '{name}'); return {what}; }})()"
            )
        };
        assert_ne!(
            page.value(&of("panel.element.querySelector('h3').textContent === view.title ? null : 1")),
            Value::Null,
            "{name}: its heading says the result"
        );
        assert_ne!(
            page.value(&of("panel.element.querySelector('.known').textContent")),
            "",
            "{name} says how it is known"
        );
        let buttons = page.value(&of("[...panel.buttons.querySelectorAll('button')].map((each) => each.textContent)"));
        assert_eq!(buttons, json!(["Save SVG", "Save CSV", "Copy as command"]), "{name}");
        let command = page.value(&of("instance.command ? instance.command() : context.answer().command"));
        assert!(command.as_str().unwrap().starts_with("corner-impact "), "{name}: {command}");
        let csv = page.value(&of("instance.csv ? instance.csv() : Explore.csv(context.answer().found)"));
        assert!(csv.as_str().unwrap().lines().count() > 1, "{name}: {csv}");
        let svg = page.value(&of("instance.svg ? instance.svg() : context.plots.map((plot) => plot.svg()).join('')"));
        assert!(svg.as_str().unwrap().contains("<svg"), "{name}");
    }
    assert_eq!(sentences(&mut page), json!([]));
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn tours_go_through_without_a_complaint() {
    // From the server, which answers in a third of the module's time.
    let served = Served::start(&[]);
    let Some(mut page) = Page::visit(&format!("http://{}{}", served.address, served.page)) else { return };
    settle(&mut page);
    let tours = page.value("Explore.stories.map(({ name, steps }) => [name, steps.length])");
    assert_eq!(tours.as_array().unwrap().len(), 5);
    for tour in tours.as_array().unwrap() {
        let (name, steps) = (tour[0].as_str().unwrap(), tour[1].as_u64().unwrap());
        page.value(&format!("document.querySelector('[data-story=\"{name}\"]').click()"));
        for step in 1..=steps {
            settle(&mut page);
            assert_eq!(
                page.value("document.querySelector('.story .place').textContent"),
                format!("Step {step} of {steps}"),
                "{name}"
            );
            let text = page.value("document.querySelector('.story .text').textContent");
            let ends = text.as_str().unwrap().matches(|end| ".?!".contains(end)).count();
            assert!(ends >= 2, "{name}, step {step}: {text}");
            // Models without a range of speeds to search have no corner impact, and the view of the local map says so.
            let elsewhere = "[...document.querySelectorAll('.explore .panel:not(#view-local) .sentence:not([hidden])')].map((each) => each.textContent)";
            assert_eq!(page.value(elsewhere), json!([]), "{name}, step {step}");
            if step < steps {
                page.value("[...document.querySelectorAll('.story button')].find((each) => each.textContent === 'Next').click()");
            }
        }
    }
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn a_telephone_a_dark_screen_and_a_model_that_cannot_be_run() {
    let Some(mut page) = open() else { return };
    page.window(390, 844, true);
    settle(&mut page);
    assert_eq!(page.value("document.documentElement.scrollWidth"), 390, "nothing is wider than the screen");
    let small = page.value(
        "[...document.querySelectorAll('.explore button, .explore select, .explore input[type=text]')].filter((each) => each.getClientRects().length && each.getBoundingClientRect().height < 38).map((each) => each.textContent || each.id)",
    );
    assert_eq!(small, json!([]), "a finger can touch every control");
    let light = page.value("getComputedStyle(document.body).backgroundColor");
    page.media("screen", &[("prefers-color-scheme", "dark")]);
    assert_ne!(page.value("getComputedStyle(document.body).backgroundColor"), light);
    page.value("Explore.app.take('bad.toml', '[follower]\\nmass = -1')");
    settle(&mut page);
    let said = page.value("document.querySelector('.explore').textContent");
    assert!(
        said.as_str().unwrap().contains("bad.toml:2: follower.mass = -1: must be a finite number above 0"),
        "the program's own sentence"
    );
    page.value("Explore.app.store.undo()");
    settle(&mut page);
    assert_eq!(sentences(&mut page), json!([]));
    assert_quiet(&page);
}
