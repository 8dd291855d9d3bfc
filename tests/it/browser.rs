//! What does the report's page do in a browser, opened from disk? Skipped, and said to be, where there is no Chromium.

pub mod devtools;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use corner_impact_plot::Data;
use devtools::Page;
use serde_json::Value;

use crate::page::papers;

/// The paper's report, written once, where the build has what it makes on its way: several runs of the tests may be at it.
fn written() -> &'static Path {
    static WRITTEN: OnceLock<PathBuf> = OnceLock::new();
    WRITTEN.get_or_init(|| {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{}.html", std::process::id()));
        std::fs::write(&file, &papers().1).unwrap();
        // For whoever wants to look at it.
        if let Some(copy) = std::env::var_os("CORNER_IMPACT_PAGE") {
            std::fs::copy(&file, Path::new(&copy)).unwrap();
        }
        file
    })
}

fn ledger() -> &'static corner_impact::paper::Claims {
    papers().0.claims.as_ref().unwrap()
}

fn open() -> Option<Page> {
    let mut page = Page::open(written())?;
    // What stands below the live page moves when it comes.
    page.until(
        "!document.getElementById('explore-module') || (typeof Explore !== 'undefined' && Boolean(Explore.app))",
    );
    Some(page)
}

/// Nothing was said on the console, and nothing fetched.
fn assert_quiet(page: &Page) {
    assert_eq!(page.complaints(), Vec::<String>::new());
    // The live page's workers are made of its own text.
    let is_own = |url: &String| ["file://", "data:", "blob:"].iter().any(|own| url.starts_with(own));
    let outside: Vec<String> = page.requests().into_iter().filter(|url| !is_own(url)).collect();
    assert_eq!(outside, Vec::<String>::new());
    assert!(page.requests().iter().any(|url| url.starts_with("file://")), "{:?}", page.requests());
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

#[test]
#[ignore = "slow"]
fn the_page_opens_from_disk_in_silence() {
    let Some(mut page) = open() else { return };
    assert_eq!(page.value("document.title"), "Corner impact of osorio-2008");
    assert!(page.value("document.querySelectorAll('main svg').length").as_u64().unwrap() > 10);
    assert_quiet(&page);
}

/// Claims that take room on the page.
fn visible(page: &mut Page) -> usize {
    let count = "[...document.querySelectorAll('.claim')].filter((claim) => claim.getClientRects().length > 0).length";
    page.value(count).as_u64().unwrap() as usize
}

#[test]
#[ignore = "slow"]
fn the_ledger_is_filtered_by_verdict_and_words_and_linked_to() {
    let Some(mut page) = open() else { return };
    let ledger = ledger();
    assert_eq!(visible(&mut page), ledger.claims.len());
    for verdict in ["holds", "definition", "in-part", "misprint", "refuted", "open"] {
        page.click(&format!("#verdict-{verdict}"));
        let expected = ledger.claims.iter().filter(|claim| claim.verdict.to_string() == verdict).count();
        assert_eq!(visible(&mut page), expected, "{verdict}");
        let others = format!(
            "[...document.querySelectorAll('.claim')].filter((claim) => claim.getClientRects().length && claim.dataset.verdict !== '{verdict}').length"
        );
        assert_eq!(page.value(&others), 0);
        let said = page.value("document.getElementById('ledger-count').textContent");
        assert_eq!(said, format!("{expected} of {} shown", ledger.claims.len()));
        let label = page.value(&format!("document.getElementById('verdict-{verdict}').parentElement.textContent"));
        assert!(label.as_str().unwrap().contains(&format!("({expected})")), "{label}");
    }
    page.click("#verdict-all");
    page.click("#ledger-search");
    page.call("Input.insertText", serde_json::json!({ "text": "detach" }));
    let about = |claim: &corner_impact::paper::Held| {
        let correct = claim.correct.clone().unwrap_or_default();
        let text =
            [&claim.id, &claim.place, &claim.statement, &correct, &claim.evidence].map(|part| part.to_lowercase());
        text.iter().any(|part| part.contains("detach"))
    };
    let expected = ledger.claims.iter().filter(|claim| about(claim)).count();
    assert!((1..20).contains(&expected), "{expected}");
    assert_eq!(visible(&mut page), expected);
    // A link to a claim that is filtered away shows it.
    let hidden = page.value("document.querySelector('.claim[hidden]').id");
    page.value(&format!("location.hash = '#' + {hidden}"));
    page.until(&format!("document.getElementById({hidden}).getClientRects().length > 0"));
    assert_eq!(visible(&mut page), ledger.claims.len());
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn a_click_on_a_number_shows_what_it_stands_for() {
    let Some(mut page) = open() else { return };
    let shown = page.value(
        "document.querySelector('#maps [data-about=B_minus][data-value]').click(), document.getElementById('explained').textContent",
    );
    let shown = shown.as_str().unwrap();
    for part in ["B_minus", "eq:PT", "src/corner/closed_form.rs", "derivations/corner_map.py", "variational"] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    assert_eq!(page.value("document.getElementById('explained').open"), true);
    // The number nearest to the click decides: what is allowed is another thing than the quantity.
    let other = page.value(
        "document.getElementById('explained').close(), document.querySelector('#maps [data-about=bound][data-value]').click(),
         document.querySelector('#explained h3').textContent",
    );
    assert_eq!(other, "bound");
    page.value("document.getElementById('explained').close()");
    // Where the hand clicks, whatever lies over it: a tick of a figure, and a number in a cell.
    for (number, name) in
        [("#plate-overview .broad svg text", "figure_data"), ("#maps tbody tr:first-child td:nth-child(2)", "A_minus")]
    {
        page.click(number);
        let open = page.value("document.getElementById('explained').open");
        assert_eq!(open, true, "{number}");
        assert_eq!(page.value("document.querySelector('#explained h3').textContent"), name, "{number}");
        page.click("#explained button");
        assert_eq!(page.value("document.getElementById('explained').open"), false, "{number}");
    }
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn a_narrow_screen_is_not_scrolled_sideways() {
    let Some(mut page) = open() else { return };
    for (width, height) in [(390, 844), (320, 568), (768, 1024), (1600, 900)] {
        page.window(width, height, width < 700);
        page.value("document.querySelectorAll('details').forEach((fold) => { fold.open = true; })");
        let widest = page.value("document.documentElement.scrollWidth").as_u64().unwrap();
        assert!(widest <= u64::from(width), "{width}: the page is {widest} wide");
        let shift =
            page.value("(() => { window.scrollTo({ left: 500, behavior: 'instant' }); return window.scrollX; })()");
        assert_eq!(shift, 0, "{width}");
        // On a telephone nothing scrolls by itself either, and figures are drawn for it.
        if width < 400 {
            page.until("[...document.querySelectorAll('.narrow')].every((drawing) => drawing.querySelector('svg'))");
            let images = "[...document.querySelectorAll('.narrow image')].map((image) => image.getAttribute('href').slice(0, 15))";
            let images = page.value(images);
            let images = images.as_array().unwrap();
            assert!(images.len() > 5 && images.iter().all(|image| *image == "data:image/png;"), "{images:?}");
            let scrolled = "[...document.querySelectorAll('main *')].filter((e) => e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).overflowX === 'auto').map((e) => e.outerHTML.slice(0, 300))";
            assert_eq!(page.value(scrolled), serde_json::json!([]), "{width}");
            assert_eq!(page.value("getComputedStyle(document.querySelector('.broad')).display"), "none");
        }
    }
    assert_quiet(&page);
}

/// The first screen is the answer, whose five sentences it holds; the contents stay in sight, and each figure can be saved.
#[test]
#[ignore = "slow"]
fn the_answer_is_the_first_screen() {
    let Some(mut page) = open() else { return };
    page.window(1280, 800, false);
    let bottom = "document.querySelector('#answer > ul').getBoundingClientRect().bottom";
    assert!(page.value(bottom).as_f64().unwrap() < 800.0);
    assert_eq!(page.value("document.querySelectorAll('#answer > ul > li').length"), 5);
    assert_eq!(page.value("document.querySelectorAll('#answer .broad > svg').length"), 1);
    page.value("window.scrollTo({ top: 5000, behavior: 'instant' })");
    let contents = page.value("(() => { const box = document.querySelector('nav').getBoundingClientRect(); return [box.top, box.bottom]; })()");
    let contents = numbers(&contents);
    assert!(contents[0] >= 0.0 && contents[1] <= 800.0, "{contents:?}");
    assert_eq!(
        page.value("[...document.querySelectorAll('figure .save')].every((e) => e.children.length === 3)"),
        true
    );
    page.value(
        "window.saved = []; URL.createObjectURL = (blob) => { blob.text().then((text) => window.saved.push(text)); return 'data:,'; }; true",
    );
    page.click("#plate-overview .save button:nth-child(2)");
    page.click("#plate-overview .save button:last-child");
    page.until("window.saved.length === 2");
    assert_eq!(
        page.value("window.saved.map((text) => text.slice(0, 5)).sort()"),
        serde_json::json!(["<svg ", "panel"])
    );
    let named = r#"window.saved.find((text) => text.startsWith("panel")).split("\n").filter((row) => /^"cam speed ω .rpm., cam angle at impact φ .deg.","A\d+",point,/.test(row)).length > 9"#;
    assert_eq!(page.value(named), true, "{}", page.value("window.saved.map((text) => text.slice(0, 300))"));
    assert_quiet(&page);
}

/// Numbers in a text, with the page's own minus.
fn numbers_in(text: &str) -> Vec<f64> {
    let text = text.replace('\u{2212}', "-");
    text.split([' ', ',']).filter_map(|word| word.parse().ok()).collect()
}

#[test]
#[ignore = "slow"]
fn pointing_at_a_figure_shows_the_nearest_value_and_a_figure_can_be_zoomed_into() {
    let Some(mut page) = open() else { return };
    let dossier = &papers().0;
    let figure = &dossier.attractors.as_ref().unwrap().drawn.as_ref().unwrap().figure;
    let (index, points) = (figure.panels[0].series.iter().enumerate())
        .find_map(|(index, series)| match &series.data {
            Data::Points { points, .. } => Some((index, points)),
            _ => None,
        })
        .unwrap();
    let ([x, y], series) = (points[points.len() / 2], &figure.panels[0].series[index]);
    page.place("#plate-attractors .broad", [0.5, 0.0]);
    // A place in the window from the ranges that the frame says.
    let at = page.value(&format!(
        "(() => {{ const svg = document.querySelector('#plate-attractors .broad > svg'); const frame = svg.querySelector('svg[data-x]');
           const [left, top, width, height] = ['x', 'y', 'width', 'height'].map((name) => Number(frame.getAttribute(name)));
           const [[a, b], [c, d]] = [frame.dataset.x, frame.dataset.y].map((ends) => ends.split(' ').map(Number));
           const at = new DOMPoint(left + width * ({x} - a) / (b - a), top + height * (d - {y}) / (d - c)).matrixTransform(svg.getScreenCTM());
           return [at.x, at.y]; }})()"
    ));
    let at: [f64; 2] = numbers(&at).try_into().unwrap();
    page.mouse("mouseMoved", at);
    page.until("document.querySelector('.value')?.hidden === false");
    let shown = page.value("document.querySelector('.value').textContent");
    let shown = shown.as_str().unwrap();
    let name = if series.label.is_empty() { &series.name } else { &series.label };
    let values =
        shown.strip_prefix(&format!("{name}: {} ", figure.x.label)).unwrap_or_else(|| panic!("{name}: {shown}"));
    let [across, up] = numbers_in(values)[..] else { panic!("{shown}") };
    assert!((across - x).abs() < 1e-3 && (up - y).abs() < 1e-2, "{shown}: {x} {y}");
    // Beside all data nothing is shown.
    page.mouse("mouseMoved", [at[0], 1.0]);
    page.until("document.querySelector('.value').hidden");
    page.click("#plate-attractors .save button:first-child");
    assert_eq!(page.value("document.querySelector('dialog.large').open"), true);
    let view = "document.querySelector('dialog.large svg').getAttribute('viewBox')";
    let whole = page.value(view);
    let [from, to] = [[0.3, 0.3], [0.6, 0.5]].map(|part| page.place("dialog.large svg", part));
    page.mouse("mousePressed", from);
    page.mouse("mouseMoved", to);
    page.mouse("mouseReleased", to);
    let zoomed = numbers_in(page.value(view).as_str().unwrap());
    let all = numbers_in(whole.as_str().unwrap());
    assert!(zoomed[2] < 0.7 * all[2] && zoomed[3] < 0.7 * all[3] && zoomed[0] > 0.0, "{zoomed:?} in {all:?}");
    page.click("dialog.large .save button:nth-child(2)");
    assert_eq!(page.value(view), whole);
    page.key("Escape", 27);
    page.until("document.querySelector('dialog.large') === null");
    // A finger does it on a telephone. Between the points through which a line is drawn it shows the line's own values.
    page.window(390, 844, true);
    page.until("document.querySelector('#plate-cam .narrow svg') !== null");
    let line = &dossier.plates.iter().find(|plate| plate.id == "cam").unwrap().drawn.as_ref().unwrap().figure.panels[0];
    let lowest = line.series[0].data.points().unwrap().iter().map(|at| at[1]).fold(f64::INFINITY, f64::min);
    page.touch("#plate-cam .narrow svg[data-x]", [0.1, 0.935]);
    page.until("document.querySelector('.value')?.hidden === false");
    let shown = page.value("document.querySelector('.value').textContent");
    let shown = numbers_in(shown.as_str().unwrap());
    let [angle, lift] = shown[shown.len() - 2..] else { panic!("{shown:?}") };
    assert!((lift - lowest).abs() < 1e-5 && (30.0..42.0).contains(&angle), "{shown:?}: {lowest}");
    assert_quiet(&page);
}

/// The least contrast of any text on the page with what is behind it, and where.
const CONTRAST: &str = "(() => {
  const parts = (text) => text.match(/[\\d.]+/g).map(Number);
  const light = ([r, g, b]) => [r, g, b].map((c) => c / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const behind = (e) => { for (; e; e = e.parentElement) { const c = parts(getComputedStyle(e).backgroundColor); if (c.length < 4 || c[3] > 0) return c; } return [255, 255, 255]; };
  let worst = [99, ''];
  for (const e of document.querySelectorAll('body *')) {
    if (e.closest('svg') && e.tagName !== 'text') continue;
    if (![...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()) || !e.getClientRects().length || ['SCRIPT', 'STYLE', 'NOSCRIPT'].includes(e.tagName)) continue;
    const style = getComputedStyle(e);
    const paper = e.closest('svg')?.querySelector('.paper');
    const back = paper ? parts(getComputedStyle(paper).fill) : behind(e);
    const [a, b] = [light(parts(e.tagName === 'text' ? style.fill : style.color)), light(back)];
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < worst[0]) worst = [ratio, e.outerHTML.slice(0, 200)];
  }
  return worst;
})()";

#[test]
#[ignore = "slow"]
fn text_can_be_read_on_light_and_dark_screens() {
    let Some(mut page) = open() else { return };
    let mut papers = Vec::new();
    for scheme in ["light", "dark"] {
        page.media("screen", &[("prefers-color-scheme", scheme)]);
        let worst = page.value(CONTRAST);
        assert!(worst[0].as_f64().unwrap() >= 4.5, "{scheme}: {worst}");
        papers.push(page.value("getComputedStyle(document.body).backgroundColor"));
    }
    assert_eq!(papers[0], "rgb(255, 255, 255)");
    assert_ne!(papers[0], papers[1]);
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn paper_has_no_controls_and_dark_ink() {
    let Some(mut page) = open() else { return };
    page.media("print", &[("prefers-color-scheme", "dark")]);
    for hidden in ["nav", ".filter", ".save", ".skip"] {
        let display = page.value(&format!("getComputedStyle(document.querySelector('{hidden}')).display"));
        assert_eq!(display, "none", "{hidden}");
    }
    assert_eq!(page.value("getComputedStyle(document.body).backgroundColor"), "rgb(255, 255, 255)");
    assert_eq!(page.value("getComputedStyle(document.body).color"), "rgb(0, 0, 0)");
    let paper = "getComputedStyle(document.querySelector('.drawing .paper')).fill";
    assert_eq!(page.value(paper), "rgb(255, 255, 255)");
    page.media("", &[]);
    let printed = page.call("Page.printToPDF", serde_json::json!({ "preferCSSPageSize": true }));
    let printed = STANDARD.decode(printed["data"].as_str().unwrap()).unwrap();
    let pages =
        String::from_utf8_lossy(&printed).split("/Type /Page").filter(|rest| !rest.starts_with('s')).count() - 1;
    assert!((8..=20).contains(&pages), "{pages} pages");
    assert_quiet(&page);
}

/// The live page stands in the place of its still picture, if the program has its module.
#[test]
#[ignore = "slow"]
fn a_section_of_the_report_is_live() {
    let Some(mut page) = open() else { return };
    if page.value("Boolean(document.getElementById('explore-module'))") != true {
        assert_eq!(page.value("document.getElementById('explore-live').hidden"), true);
        assert!(std::env::var_os("CORNER_IMPACT_BROWSER").is_none(), "`make explore` builds the module");
        return;
    }
    page.until("typeof Explore !== 'undefined' && Explore.app && Explore.app.model !== null");
    page.value("document.getElementById('explore-live').scrollIntoView({ behavior: 'instant' })");
    page.until("document.querySelector('#explore-live .headline').textContent.includes(' rpm: ')");
    assert_eq!(page.value("getComputedStyle(document.getElementById('explore-still')).display"), "none");
    assert_eq!(page.value("Explore.app.model.name"), "osorio-2008");
    // A click into the picture of the answer is a speed.
    page.media("screen", &[("prefers-reduced-motion", "reduce")]);
    page.click("#answer .broad > svg");
    page.until("Explore.app.store.state.rpm > 300 && Explore.app.store.state.rpm < 600");
    page.until("document.querySelector('#explore-live').getBoundingClientRect().top < innerHeight");
    page.value("Explore.app.assign('rpm', 183)");
    page.until("document.querySelector('#explore-live .headline').textContent.startsWith('183 rpm: ')");
    page.until("Explore.app.transport.pending() === 0");
    assert_eq!(page.value("[...document.querySelectorAll('#explore-live .sentence:not([hidden])')].length"), 0);
    page.window(390, 844, true);
    page.until("Explore.app.transport.pending() === 0");
    assert_eq!(page.value("document.documentElement.scrollWidth"), 390);
    assert_quiet(&page);
}
