//! What does the report's page do in a browser, opened from disk? Skipped, and said to be, where there is no Chromium.

pub mod devtools;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use corner_impact_cli::figures::through_corner::Moment;
use corner_impact_cli::report::through::ThroughCorner;
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

fn through() -> &'static ThroughCorner {
    papers().0.through.as_ref().unwrap()
}

fn ledger() -> &'static corner_impact::paper::Claims {
    papers().0.claims.as_ref().unwrap()
}

/// Open, with the slider's data unpacked.
fn open() -> Option<Page> {
    let mut page = Page::open(written())?;
    page.until("!document.getElementById('player').hidden");
    Some(page)
}

/// Nothing was said on the console, and nothing fetched.
fn assert_quiet(page: &Page) {
    assert_eq!(page.complaints(), Vec::<String>::new());
    let outside: Vec<String> =
        page.requests().into_iter().filter(|url| !url.starts_with("file://") && !url.starts_with("data:")).collect();
    assert_eq!(outside, Vec::<String>::new());
    assert!(page.requests().iter().any(|url| url.starts_with("file://")), "{:?}", page.requests());
}

fn shown_frame(page: &mut Page) -> usize {
    page.value("Number(document.getElementById('player').dataset.frame)").as_u64().unwrap() as usize
}

/// `toFixed` with the page's own minus.
fn fixed(value: f64, places: usize) -> String {
    format!("{value:.places$}").replace('-', "\u{2212}")
}

/// Readout, marks, slider and words are those of a frame of the document.
fn assert_shows(page: &mut Page, index: usize) {
    let frame = &through().frames[index];
    assert_eq!(shown_frame(page), index);
    let places = through().places;
    let speed = format!("{:.*} rpm", places.speed as usize, frame.rpm);
    assert_eq!(page.value("document.getElementById('speed').value"), index.to_string());
    assert_eq!(page.value("document.getElementById('speed').getAttribute('aria-valuetext')"), speed);
    assert_eq!(page.value("document.getElementById('speed-shown').textContent"), speed);
    let rows = page.value(
        "[...document.querySelectorAll('#readout tbody tr')].map((row) => [...row.cells].map((cell) => cell.textContent))",
    );
    let rows = rows.as_array().unwrap();
    assert_eq!(rows.len(), frame.orbits.len(), "frame {index}");
    for (row, orbit) in rows.iter().zip(&frame.orbits) {
        assert_eq!(row[0], if orbit.stable { "stable" } else { "unstable" });
        assert!(row[1].as_str().unwrap().starts_with(&orbit.place.to_string()), "{row}");
        assert_eq!(row[2], fixed(orbit.angle_deg, 4));
        assert_eq!(row[3], fixed(orbit.from_corner_deg, 4));
        assert_eq!(row[4], fixed(orbit.velocity_before_m_s, places.velocity as usize));
        assert_eq!(row[5], fixed(orbit.velocity_after_m_s, places.velocity as usize));
        let multipliers = row[6].as_str().unwrap();
        for multiplier in &orbit.multipliers {
            assert!(multipliers.contains(&fixed(multiplier.re, 6)), "{multipliers}");
            let imaginary = format!("{:.6}", multiplier.im.abs());
            assert!(multiplier.im == 0.0 || multipliers.contains(&imaginary), "{multipliers}");
        }
        assert_eq!(row[7], fixed(orbit.modulus, 6));
    }
    let marks = numbers(&page.value(
        "[...document.querySelectorAll('#plane .multiplier')].flatMap((mark) => [Number(mark.dataset.re), Number(mark.dataset.im)])",
    ));
    let expected: Vec<f64> =
        frame.orbits.iter().flat_map(|orbit| orbit.multipliers).flat_map(|value| [value.re, value.im]).collect();
    assert_eq!(marks, expected);
    let hits =
        numbers(&page.value("[...document.querySelectorAll('#near .impact')].map((hit) => Number(hit.dataset.angle))"));
    assert_eq!(hits, frame.orbits.iter().map(|orbit| orbit.angle_deg).collect::<Vec<_>>());
    assert_eq!(lines(page), drawn_lines(frame));
    let words = page.value("document.getElementById('summary').textContent");
    let words = words.as_str().unwrap();
    assert!(words.starts_with(&speed) && words.contains(&frame.slowing.words), "{words}");
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

/// Points of each orbit's line and of each run's in the picture of one revolution.
fn lines(page: &mut Page) -> Vec<f64> {
    numbers(&page.value(
        "[...document.querySelectorAll('#revolution path.run, #revolution path.stable, #revolution path.unstable')]
            .map((path) => path.getAttribute('d').split(/[ML]/).length - 1)",
    ))
}

fn drawn_lines(frame: &Moment) -> Vec<f64> {
    let runs = frame.slowing.paths.iter().map(|path| path.len() as f64);
    runs.chain(frame.orbits.iter().map(|orbit| orbit.path.len() as f64)).collect()
}

fn slide(page: &mut Page, index: usize) {
    page.value(&format!(
        "(() => {{ const s = document.getElementById('speed'); s.value = {index}; s.dispatchEvent(new Event('input', {{ bubbles: true }})); }})()"
    ));
}

#[test]
#[ignore = "slow"]
fn the_page_opens_from_disk_in_silence() {
    let Some(mut page) = open() else { return };
    assert_eq!(page.value("document.title"), "Corner impact of osorio-2008");
    assert_eq!(page.value("document.getElementById('player').hidden"), false);
    assert!(page.value("document.querySelectorAll('main svg').length").as_u64().unwrap() > 10);
    assert_shows(&mut page, through().at_corner);
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn the_slider_shows_the_documents_frames_and_two_orbits_become_none_at_the_corner() {
    let Some(mut page) = open() else { return };
    let (corner, last) = (through().at_corner, through().frames.len() - 1);
    for index in [0, corner / 2, corner - 1, corner, corner + 1, corner + 20, last] {
        slide(&mut page, index);
        assert_shows(&mut page, index);
    }
    let orbits = |index: usize| through().frames[index].orbits.len();
    assert_eq!((orbits(corner - 1), orbits(corner + 1)), (0, 2));
    slide(&mut page, corner + 1);
    assert!(page.value("document.getElementById('summary').textContent").as_str().unwrap().contains("2 orbits"));
    slide(&mut page, corner - 1);
    let words = page.value("document.getElementById('summary').textContent");
    assert!(words.as_str().unwrap().contains("there is no orbit"), "{words}");
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn keys_move_the_slider() {
    let Some(mut page) = open() else { return };
    let (corner, last) = (through().at_corner, through().frames.len() - 1);
    page.value("document.getElementById('speed').focus()");
    page.key("ArrowRight", 39);
    assert_shows(&mut page, corner + 1);
    page.key("ArrowLeft", 37);
    page.key("ArrowLeft", 37);
    assert_shows(&mut page, corner - 1);
    page.key("End", 35);
    assert_shows(&mut page, last);
    page.key("PageDown", 34);
    let paged = shown_frame(&mut page);
    assert!(paged < last - 1, "{paged}");
    assert_shows(&mut page, paged);
    page.key("Home", 36);
    assert_shows(&mut page, 0);
    page.click("#to-corner");
    assert_shows(&mut page, corner);
    let outline = page.value(
        "(() => { document.getElementById('play').focus(); document.getElementById('speed').focus({ focusVisible: true }); return getComputedStyle(document.getElementById('speed')).outlineStyle; })()",
    );
    assert_eq!(outline, "solid");
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn a_finger_moves_the_slider_and_the_diagram() {
    let Some(mut page) = open() else { return };
    page.window(360, 740, true);
    let last = through().frames.len() - 1;
    page.touch("#speed", [0.25, 0.5]);
    let touched = shown_frame(&mut page);
    assert!((touched as f64 / last as f64 - 0.25).abs() < 0.08, "{touched} of {last}");
    assert_shows(&mut page, touched);
    page.touch("#diagram svg", [0.9, 0.5]);
    let pointed = shown_frame(&mut page);
    assert!(pointed > through().at_corner + 20, "{pointed}");
    assert_shows(&mut page, pointed);
    assert_quiet(&page);
}

#[test]
#[ignore = "slow"]
fn play_moves_and_pauses_and_whoever_wants_no_motion_goes_step_by_step() {
    let Some(mut page) = open() else { return };
    let corner = through().at_corner;
    page.click("#play");
    page.until(&format!("Number(document.getElementById('player').dataset.frame) > {}", corner + 2));
    assert_eq!(page.value("document.getElementById('play').getAttribute('aria-pressed')"), "true");
    page.click("#play");
    let stopped = shown_frame(&mut page);
    std::thread::sleep(std::time::Duration::from_millis(400));
    assert_shows(&mut page, stopped);
    page.media("screen", &[("prefers-reduced-motion", "reduce")]);
    page.until("document.getElementById('play').textContent === 'Next speed'");
    page.click("#play");
    std::thread::sleep(std::time::Duration::from_millis(400));
    assert_shows(&mut page, stopped + 1);
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
        "document.querySelector('#maps [data-about=B_minus] data').click(), document.getElementById('explained').textContent",
    );
    let shown = shown.as_str().unwrap();
    for part in ["B_minus", "eq:PT", "src/corner/closed_form.rs", "derivations/corner_map.py", "variational"] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    assert_eq!(page.value("document.getElementById('explained').open"), true);
    // The number nearest to the click decides: what is allowed is another thing than the quantity.
    let other = page.value(
        "document.getElementById('explained').close(), document.querySelector('#maps [data-about=bound] data').click(),
         document.querySelector('#explained h3').textContent",
    );
    assert_eq!(other, "bound");
    page.value("document.getElementById('explained').close()");
    // Where the hand clicks, whatever lies over it: a tick of a figure, a cell and the speed of the slider.
    for (number, name) in [
        ("#plate-overview .broad svg text", "figure_data"),
        ("#readout tbody td:nth-child(3)", "through"),
        ("#speed-shown", "through"),
        ("#near svg text", "through"),
    ] {
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
    assert_eq!(page.value("[...document.querySelectorAll('.save')].every((e) => e.children.length === 2)"), true);
    page.value(
        "window.saved = []; URL.createObjectURL = (blob) => { blob.text().then((text) => window.saved.push(text)); return 'data:,'; }; true",
    );
    page.click("#plate-overview .save button:first-child");
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
    for hidden in ["nav", ".controls", ".filter", ".skip"] {
        let display = page.value(&format!("getComputedStyle(document.querySelector('{hidden}')).display"));
        assert_eq!(display, "none", "{hidden}");
    }
    assert_eq!(page.value("getComputedStyle(document.body).backgroundColor"), "rgb(255, 255, 255)");
    assert_eq!(page.value("getComputedStyle(document.body).color"), "rgb(0, 0, 0)");
    let paper = "getComputedStyle(document.querySelector('.drawing .paper')).fill";
    assert_eq!(page.value(paper), "rgb(255, 255, 255)");
    page.media("", &[]);
    let printed = page.call("Page.printToPDF", serde_json::json!({ "preferCSSPageSize": true }));
    assert!(printed["data"].as_str().unwrap().len() > 100_000);
    assert_quiet(&page);
}
