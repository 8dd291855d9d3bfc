//! Are the report's figures there, in the paper's order, for any model; are their numbers the paper's; and does
//! `corner-impact figure` list them, draw one, and say why there is none?

use std::f64::consts::{PI, TAU};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::common::ROOT;
use approx::assert_relative_eq;
use corner_impact::cam::{Outline, Side};
use corner_impact::flight::State;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::orbit::Stability;
use corner_impact::simulate::EventKind;
use corner_impact_cli::cli::{Exit, run};
use corner_impact_cli::figures::{
    Effort, FigureContext, Neighbour, RenderedFigure, branches_figure, listed, plate, plates,
};
use corner_impact_plot::layout::Layout;
use corner_impact_plot::{Data, Figure, Look, Series, svg};
use rayon::prelude::*;

/// An independent computation's values for the paper's model.
const THETA_P: f64 = 2.62112450116623235;
const OMEGA_STAR: f64 = 673.234445003848821;
const X_STAR: f64 = 5.09700788184262174;
const LIFT_P: f64 = 0.531255562019001;
/// k/m, where the spring is slack, and r.
const SPRING: f64 = 1430.8 / 1.221;
const SLACK: f64 = 0.3;
const RESTITUTION: f64 = 0.8;

fn paper() -> FigureContext {
    FigureContext::new(&Model::parse("osorio-2008.toml", OSORIO_2008).unwrap(), None).unwrap()
}

fn drawn(subject: &FigureContext, id: &str) -> Figure {
    plate(subject, id).unwrap().drawn.unwrap().figure
}

fn points(data: &Data) -> &[[f64; 2]] {
    match data {
        Data::Line { points, .. } | Data::Area { points, .. } | Data::Arrow { points, .. } => points,
        Data::Points { points, .. } => points,
        Data::Words(_) | Data::Band { .. } | Data::Density(_) | Data::Region { .. } => &[],
    }
}

/// The points of the series of this name in a panel, without breaks.
fn series(figure: &Figure, panel: usize, label: &str) -> Vec<[f64; 2]> {
    let found = figure.panels[panel].series.iter().find(|series| series.label == label);
    let found = found.unwrap_or_else(|| panic!("{}: no series {label}", figure.title));
    points(&found.data).iter().copied().filter(|[x, _]| !x.is_nan()).collect()
}

/// Whether a figure can be read: numbers, or breaks; something to see in each panel; a small file.
fn check(plate: &RenderedFigure) {
    let figure = &plate.drawn.as_ref().unwrap().figure;
    let (id, layout) = (plate.id, Layout::new(figure, &Look::default()));
    for (panel, place) in figure.panels.iter().zip(&layout.panels) {
        let mut seen = false;
        for series in &panel.series {
            for [x, y] in points(&series.data) {
                assert!(x.is_nan() == y.is_nan() && !x.is_infinite() && !y.is_infinite(), "{id}: {x}, {y}");
                let across = (layout.panels[0].across.range[0]..=layout.panels[0].across.range[1]).contains(x);
                seen |= across && (place.range[0]..=place.range[1]).contains(y);
            }
            if let Data::Density(density) | Data::Region { cells: density, .. } = &series.data {
                seen |= density.occupied() > 0;
            }
            if let Data::Words(words) = &series.data {
                assert!(words.iter().all(|word| !word.text.is_empty() && word.at[0].is_finite()), "{id}: {words:?}");
            }
        }
        assert!(seen, "{id}: nothing to see in {}", panel.y.label);
    }
    let text = svg::render(figure, &Look::default()).unwrap();
    // In another font a whole label is set, heavier than those beside it.
    assert!(!text.contains('′'), "{}: a letter that the font does not have", plate.id);
    assert!(text.len() < 250_000, "{id}: {} bytes", text.len());
    let paths = text.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next());
    for path in paths {
        assert!(!path.contains("NaN") && !path.contains("inf"), "{id}: {path}");
    }
}

#[test]
fn the_figures_are_in_the_papers_order() {
    let found: Vec<(&str, &str)> = listed(&paper()).iter().map(|figure| (figure.id, figure.place)).collect();
    let wanted = [
        ("cam-shape", "Figures 3(a) and 9"),
        ("cam", "Figure 3(b)"),
        ("slow-trace", "Figure 4(a) and (b)"),
        ("slow-phase-plane", "Figure 4(c)"),
        ("slow-impacts", "Figure 5(a)"),
        ("interrupted-trace", "Figure 5(b)"),
        ("fast-impacts", "Figure 5(c)"),
        ("fast-section", "Figure 5(d)"),
        ("corner-orbit", "Figure 5(e)"),
        ("beyond-trace", "Figure 5(f)"),
        ("beyond-attractor", ""),
        ("chaotic-set", ""),
        ("composition", "Figure 6"),
        ("discontinuity-mapping", "Figure 7"),
        ("local-map", "Figure 8"),
    ];
    assert_eq!(found, wanted);
}

/// Orbits are looked for at speeds a fiftieth apart: one of these, 695.6 rpm, is shown, and the orbits that are found there, a stable one
/// and an unstable one, go on to both ends of what is shown.
#[test]
fn branches_are_drawn_from_end_to_end_of_speeds_that_hold_one_search() {
    let mut subject = paper();
    let range = [690.0, 701.0];
    subject.shown.fast.as_mut().unwrap().range = range;
    subject.fast_effort = Effort { speeds: 2, transient: 1, record: 1 };
    let figure = drawn(&subject, "fast-impacts");
    for label in ["stable", "unstable"] {
        let speeds: Vec<f64> = series(&figure, 0, label).iter().map(|[rpm, _]| *rpm).collect();
        let ends = [speeds.iter().copied().fold(f64::INFINITY, f64::min), speeds.iter().copied().fold(0.0, f64::max)];
        assert_eq!(ends, range, "{label}");
    }
}

#[test]
#[ignore = "slow"]
fn the_papers_model_has_every_figure() {
    let subject = paper();
    let mut steps = Vec::new();
    let plates = plates(&subject, &mut |done, of| steps.push((done, of)));
    assert_eq!(steps, (0..=plates.len()).map(|done| (done, plates.len())).collect::<Vec<_>>());
    let mut titles: Vec<&str> = plates.iter().map(|plate| plate.title.as_str()).collect();
    titles.sort_unstable();
    titles.dedup();
    assert_eq!(titles.len(), plates.len(), "two figures of one title");
    for plate in &plates {
        let caption = &plate.drawn.as_ref().unwrap_or_else(|why| panic!("{}: {why}", plate.id)).caption;
        let sentences = caption.matches(". ").count() + 1;
        assert!(caption.ends_with('.') && (1..=6).contains(&sentences), "{}: {caption}", plate.id);
        assert!(plate.command.starts_with("corner-impact figure ") && plate.command.contains(plate.id));
        check(plate);
    }
}

#[test]
#[ignore = "slow"]
fn every_model_has_its_figures_or_a_reason() {
    fn models(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                models(&path, found);
            } else if path.extension().is_some_and(|extension| extension == "toml") {
                found.push(path);
            }
        }
    }
    let mut files = Vec::new();
    models(&Path::new(crate::common::ROOT).join("models"), &mut files);
    assert!(files.len() >= 15, "{files:?}");
    files.par_iter().for_each(|file| {
        let model = Model::read(file).unwrap();
        let mut subject = FigureContext::new(&model, None).unwrap();
        // Whether there is a figure, and one that can be read, does not depend on how fine the sweeps are.
        subject.slow_effort.speeds = 80;
        subject.fast_effort = Effort { speeds: 60, transient: 100, record: 30 };
        let plates = plates(&subject, &mut |_, _| {});
        for plate in &plates {
            match &plate.drawn {
                Err(why) => assert!(why.len() > 20, "{}: {}: {why}", file.display(), plate.id),
                Ok(_) => check(plate),
            }
        }
        // What needs a corner impact is there exactly where there is one; the cam is there for all.
        let drawn = |id: &str| plates.iter().any(|plate| plate.id == id && plate.drawn.is_ok());
        assert!(drawn("cam") && drawn("cam-shape"));
        for id in ["corner-orbit", "fast-impacts", "composition", "local-map"] {
            assert_eq!(drawn(id), subject.found().is_ok(), "{}: {id}", file.display());
        }
    });
}

/// Without gravity a stiffness 1.21 times as large makes every speed 1.1 times as large.
#[test]
fn other_models_are_shown_at_speeds_in_the_papers_proportions() {
    let stiffer = OSORIO_2008
        .replace("stiffness = 1430.8", "stiffness = 1731.268")
        .replace("rpm_min = 600.0", "rpm_min = 660.0")
        .replace("rpm_max = 760.0", "rpm_max = 836.0");
    assert_ne!(stiffer, OSORIO_2008);
    let subject = FigureContext::new(&Model::parse("stiffer.toml", &stiffer).unwrap(), None).unwrap();
    assert!(!subject.is_paper);
    let slow = subject.shown.slow.unwrap();
    assert_eq!((slow.chattering, slow.range, slow.interrupted), (201.3, [126.5, 220.0], 192.5));
    let fast = subject.shown.fast.unwrap();
    assert_eq!((fast.range, fast.beyond), ([726.0, 825.0], 737.0));
}

#[test]
fn the_shape_is_the_papers_construction() {
    let outline = Outline::new(&paper().cam, None);
    assert_eq!(outline.added, 0.0);
    let length = |[x, y]: [f64; 2]| x.hypot(y);
    let (angle, corner) = outline.corners[1];
    assert_relative_eq!(angle, THETA_P, epsilon = 1e-12);
    // Seen with the follower above: what comes to it from the right has the larger angle.
    for (found, wanted) in corner.iter().zip([LIFT_P * THETA_P.sin(), LIFT_P * THETA_P.cos()]) {
        assert_relative_eq!(*found, wanted, epsilon = 1e-12);
    }
    // P, O2 and O1 are on one line, 0.15 and 0.85 from P.
    let [flank, nose] = [1, 2].map(|piece| outline.pieces[piece].centre.unwrap());
    assert_relative_eq!(length(flank), 0.45, epsilon = 1e-12);
    assert_relative_eq!(length(nose), 0.403933207238214137, epsilon = 1e-12);
    let from = |centre: [f64; 2]| [corner[0] - centre[0], corner[1] - centre[1]];
    assert_relative_eq!(length(from(flank)), 0.85, epsilon = 1e-12);
    assert_relative_eq!(length(from(nose)), 0.15, epsilon = 1e-12);
    // Every point of the flank is on its circle, though it was computed as a lift.
    for [x, y] in &outline.pieces[1].points {
        assert_relative_eq!(length([x - flank[0], y - flank[1]]), 0.85, epsilon = 1e-12);
    }
    let figure = drawn(&paper(), "cam-shape");
    let turns = |series: &&Series| matches!(&series.data, Data::Arrow { points, .. } if points.len() > 2);
    let turn = points(&figure.panels[0].series.iter().find(turns).unwrap().data);
    assert!(turn[turn.len() - 1][0] < turn[0][0], "the cam turns to the left");
    // On the page a circle is one.
    let layout = Layout::new(&figure, &Look::default());
    let (frame, range) = (layout.panels[0].frame, layout.panels[0].range);
    let [across, up] = [
        frame.width / (layout.panels[0].across.range[1] - layout.panels[0].across.range[0]),
        frame.height / (range[1] - range[0]),
    ];
    assert_relative_eq!(across, up, max_relative = 1e-9);
}

#[test]
#[ignore = "slow"]
fn corners_are_marked_where_the_paper_has_them() {
    let figure = drawn(&paper(), "cam");
    let at: Vec<f64> = figure.marks.iter().map(|mark| mark.at).collect();
    let p = THETA_P.to_degrees();
    for (found, wanted) in at.iter().zip([90.0, p, 160.0, 200.0, 360.0 - p, 270.0]) {
        assert_relative_eq!(*found, wanted, epsilon = 1e-9);
    }
    for id in ["slow-impacts", "fast-impacts"] {
        let horizontal: Vec<f64> = drawn(&paper(), id).panels[0].marks.iter().map(|mark| mark.at).collect();
        assert_eq!(horizontal, at, "{id}");
    }
}

#[test]
fn the_orbit_at_the_corner_is_the_papers() {
    let subject = paper();
    let run = subject.corner_orbit().unwrap();
    assert_relative_eq!(run.rpm, OMEGA_STAR, max_relative = 1e-12);
    let [event] = run.events.as_slice() else { panic!("{:?}", run.events) };
    assert_relative_eq!(event.cam_angle, THETA_P, epsilon = 1e-10);
    for sample in [run.samples.first().unwrap(), run.samples.last().unwrap()] {
        assert_relative_eq!(sample.state.position, SLACK + X_STAR, epsilon = 1e-10);
        assert_relative_eq!(sample.state.velocity, 0.0, epsilon = 1e-8);
    }
    let figure = drawn(&subject, "corner-orbit");
    let [impact] = series(&figure, 0, "impact at the corner P")[..] else { panic!("not one impact") };
    assert_relative_eq!(impact[0], 0.5, epsilon = 1e-10);
    assert_relative_eq!(impact[1], LIFT_P, epsilon = 1e-10);
}

#[test]
#[ignore = "slow"]
fn the_slow_motion_chatters_and_rests_and_its_impacts_begin_behind_p() {
    let subject = paper();
    let run = subject.settled(183.0, 2).unwrap();
    assert!(run.samples.iter().all(|sample| sample.gap > -1e-12));
    let count = |kind| run.events.iter().filter(|event| event.kind == kind).count();
    assert_eq!((count(EventKind::Stick), count(EventKind::Release)), (2, 2));
    assert!(count(EventKind::Impact) > 40, "{}", count(EventKind::Impact));
    let release = run.events.iter().find(|event| event.kind == EventKind::Release).unwrap();
    assert_relative_eq!(release.cam_angle, THETA_P, epsilon = 1e-9);
    // The follower leaves the cam at P from 114.979 rpm on.
    let impacts = subject.slow_impacts([114.97, 115.5]).unwrap();
    let slowest = impacts.iter().map(|[rpm, _]| *rpm).fold(f64::INFINITY, f64::min);
    assert!((slowest - 114.979).abs() < 1e-3, "{slowest}");
    assert!(impacts.iter().all(|[_, angle]| *angle > THETA_P));
}

#[test]
fn the_branches_end_at_the_corner_impact() {
    let subject = paper();
    let figure = drawn(&subject, "fast-section");
    for label in ["stable", "unstable"] {
        let line = series(&figure, 0, label);
        let slowest = line.iter().copied().min_by(|one, two| one[0].total_cmp(&two[0])).unwrap();
        assert_relative_eq!(slowest[0], OMEGA_STAR, max_relative = 1e-9);
        assert_relative_eq!(slowest[1], SLACK + X_STAR, max_relative = 1e-6);
    }
    let [ring] = series(&figure, 0, "corner impact")[..] else { panic!("not one ring") };
    assert_relative_eq!(ring[0], OMEGA_STAR, max_relative = 1e-9);
    assert_relative_eq!(ring[1], SLACK + X_STAR, max_relative = 1e-9);
    let figure = drawn(&subject, "fast-impacts");
    let slower = |label: &str| series(&figure, 0, label).into_iter().filter(|[rpm, _]| *rpm < 730.0);
    assert!(slower("stable").count() > 10 && slower("stable").all(|[_, angle]| angle > THETA_P.to_degrees() - 1e-5));
    assert!(
        slower("unstable").count() > 10 && slower("unstable").all(|[_, angle]| angle < THETA_P.to_degrees() + 1e-5)
    );
    let rings = series(&figure, 0, "corner impact");
    let near = |rpm: f64, angle: f64| rings.iter().any(|[x, y]| (x - rpm).abs() < 1e-5 && (y - angle).abs() < 1e-5);
    assert!(near(OMEGA_STAR, THETA_P.to_degrees()), "{rings:?}");
    // Of the orbit of two impacts the ring is at the one at Q.
    assert!(rings.iter().any(|[rpm, angle]| (rpm - 739.378).abs() < 0.01 && (angle - 160.0).abs() < 1e-5), "{rings:?}");
    // Runs repeat on the stable line, and nowhere else but by chance of a chaotic run.
    let stable = series(&figure, 0, "stable");
    let repeating: Vec<_> =
        series(&figure, 0, "runs that repeat").into_iter().filter(|[rpm, _]| *rpm > 690.0).collect();
    let regular = repeating.iter().filter(|[rpm, _]| *rpm < 735.0);
    assert!(regular.clone().count() > 200, "{}", repeating.len());
    for [rpm, angle] in regular {
        let beside = |[x, y]: &[f64; 2]| (x - rpm).abs() < 1.0 && (y - angle).abs() < 0.2;
        assert!(stable.iter().any(beside), "{rpm} {angle}");
    }
    // The flip at 739.32 rpm is not the paper's; the stable orbit is lost there.
    let flips = series(&figure, 0, "flip");
    assert!(flips.iter().any(|[rpm, _]| (rpm - 739.32).abs() < 0.01), "{flips:?}");
}

/// From 675 to 682 rpm runs that come from slower speeds are chaotic and those that come from faster ones periodic.
#[test]
fn runs_with_rising_and_with_falling_speed_are_shown() {
    let mut subject = paper();
    subject.fast_effort = Effort { speeds: 16, transient: 300, record: 20 };
    let range = [675.0, 690.0];
    let impacts = subject.fast_runs(range, false).unwrap();
    let slowest: Vec<f64> = impacts.iter().filter(|[rpm, _]| *rpm == range[0]).map(|[_, angle]| *angle).collect();
    let orbit = *slowest.last().unwrap();
    assert!(orbit > THETA_P && orbit < 160_f64.to_radians(), "{orbit}");
    let on_it = slowest.iter().filter(|angle| (**angle - orbit).abs() < 1e-5).count();
    assert!(on_it >= 20 && slowest.len() - on_it >= 10, "{on_it} of {}", slowest.len());
    let [rpm, position] = *subject.fast_runs(range, true).unwrap().last().unwrap();
    assert!(rpm == range[0] && position > 4.5 && position < SLACK + X_STAR, "{rpm}, {position}");
}

#[test]
fn chaos_stays_above_the_cam_and_does_not_repeat() {
    let subject = paper();
    let states = subject.section_states(670.0, 2000).unwrap();
    let section = subject.cam.lift(THETA_P + PI).value;
    assert!(states.iter().all(|state| state.position >= section - 1e-12));
    let mut bits: Vec<u64> = states.iter().map(|state| state.position.to_bits()).collect();
    bits.sort_unstable();
    bits.dedup();
    assert_eq!(bits.len(), states.len());
    let figure = drawn(&subject, "beyond-attractor");
    let Data::Density(density) = &figure.panels[0].series[0].data else { panic!("no states") };
    assert!(density.occupied() > 1000 && density.outside() == 0, "{}", density.occupied());
    // At the section: where the motion repeats, it is on the branch there.
    let settled = subject.section_states(700.0, 1).unwrap()[0];
    let branch = series(&drawn(&subject, "fast-section"), 0, "stable");
    let off = |[rpm, _]: &[f64; 2]| (rpm - 700.0).abs();
    let nearest = branch.iter().min_by(|one, other| off(one).total_cmp(&off(other))).unwrap();
    assert_relative_eq!(settled.position, nearest[1], max_relative = 0.05);
}

/// The undamped flight as the paper writes it, about the slack spring.
fn flown(State { position, velocity }: State, time: f64) -> State {
    let omega = SPRING.sqrt();
    let (sin, cos) = (omega * time).sin_cos();
    let x = position - SLACK;
    State { position: SLACK + x * cos + velocity / omega * sin, velocity: velocity * cos - x * omega * sin }
}

fn assert_same(one: State, other: State) {
    assert_relative_eq!(one.position, other.position, epsilon = 1e-9);
    assert_relative_eq!(one.velocity, other.velocity, epsilon = 1e-7);
}

#[test]
fn the_composition_is_the_papers_on_a_real_motion() {
    let subject = paper();
    let shown = subject.composition().unwrap();
    let half = 0.5 * 60.0 / OMEGA_STAR;
    let omega = OMEGA_STAR * PI / 30.0;
    assert_same(shown.states[0], State { position: SLACK + X_STAR, velocity: 0.0 });
    for near in shown.neighbours.iter().chain([&shown.far]) {
        let [first, minus, plus, last] = near.sections;
        let [before, after] = near.impact;
        assert_eq!(near.side == Side::Minus, near.time < 0.0);
        // P1, and the impact on the same flight, on the cam.
        assert_same(flown(first, half), minus);
        assert_same(flown(minus, near.time), before);
        let lift = subject.cam.lift(THETA_P + omega * near.time);
        assert_relative_eq!(before.position, lift.value, epsilon = 1e-9);
        // PD: v+ = (1 + r) c' - r v-, then the flight after it to time 0, and P2.
        let velocity = (1.0 + RESTITUTION) * omega * lift.slope - RESTITUTION * before.velocity;
        assert_same(after, State { velocity, ..before });
        assert_same(flown(plus, near.time), after);
        assert_same(flown(plus, half), last);
        // A real revolution does the same.
        assert_same(near.simulated, last);
        // Far enough away to be seen.
        assert!((omega * near.time).abs() > 0.05, "{}", near.time);
        let ends = |line: &[[f64; 2]]| (line[0], line[line.len() - 1]);
        assert_relative_eq!(ends(&near.coming[0]).0[1], first.position, epsilon = 1e-9);
        assert_relative_eq!(ends(&near.going[0]).1[1], last.position, epsilon = 1e-9);
        // One of the two flights goes on where no motion is, to the section.
        let unreal = if near.side == Side::Minus { &near.coming[1] } else { &near.going[1] };
        let other = if near.side == Side::Minus { &near.going[1] } else { &near.coming[1] };
        assert!(other.is_empty() && unreal.iter().any(|[time, _]| time.abs() < 1e-15));
    }
    // The orbit comes to the corner at -T, 0 and T.
    for time in [-2.0 * half, 0.0, 2.0 * half] {
        let nearest = shown.orbit.iter().min_by(|one, two| (one[0] - time).abs().total_cmp(&(two[0] - time).abs()));
        assert_relative_eq!(nearest.unwrap()[1], LIFT_P, epsilon = 1e-9);
    }
}

#[test]
fn the_composition_is_drawn_on_the_side_and_in_the_units_that_it_has() {
    let subject = paper();
    let shown = subject.composition().unwrap();
    let lift = |time: f64| subject.cam.lift(THETA_P + OMEGA_STAR * PI / 30.0 * time).value;
    for [time, height] in shown.cam.iter().filter(|[time, _]| time.abs() < 0.2 * shown.period) {
        assert_relative_eq!(*height, lift(*time), epsilon = 1e-9);
    }
    // Each law is the cam's on its own side and continued on the other, above the cam or below it.
    for [time, height] in shown.before[0].iter().chain(&shown.after[0]) {
        assert_relative_eq!(*height, lift(*time), epsilon = 1e-9);
    }
    assert!(shown.before[1].iter().filter(|[time, _]| *time > 1e-4).all(|[time, height]| *height > lift(*time)));
    assert!(shown.after[1].iter().filter(|[time, _]| *time < -1e-4).all(|[time, height]| *height < lift(*time)));
    let positions = |near: &Neighbour| near.sections.map(|state| state.position);
    let figure = drawn(&subject, "composition");
    let [first, minus, plus, _] = positions(&shown.far);
    assert_eq!(shown.far.side, Side::Minus);
    assert_eq!(series(&figure, 0, "discontinuity mapping"), [[0.0, minus], [0.0, plus]]);
    let start = series(&figure, 0, "neighbour")[0];
    assert_relative_eq!(start[0], -0.5, epsilon = 1e-12);
    assert_relative_eq!(start[1], first, epsilon = 1e-9);
    let figure = drawn(&subject, "discontinuity-mapping");
    assert_eq!(figure.x.unit, "ms");
    for (panel, near) in shown.neighbours.iter().enumerate() {
        let [_, minus, plus, _] = positions(near);
        assert_eq!(series(&figure, panel, "discontinuity mapping"), [[0.0, minus], [0.0, plus]]);
        let hit = [1e3 * near.time, near.impact[0].position];
        let is_hit = |[time, q]: &[f64; 2]| (time - hit[0]).abs() < 1e-9 && (q - hit[1]).abs() < 1e-9;
        assert!(series(&figure, panel, "neighbour").iter().any(is_hit), "{hit:?}");
    }
}

#[test]
fn both_fixed_points_of_the_local_map_are_on_the_faster_side() {
    let subject = paper();
    let shown = subject.next_to_corner().unwrap();
    let mut rays: Vec<(&str, f64, bool, f64, f64)> = shown
        .rays
        .iter()
        .map(|ray| {
            (ray.word.as_str(), ray.sign, ray.stability == Stability::Stable, ray.positions[0], ray.velocities[0])
        })
        .collect();
    rays.sort_by(|one, two| one.0.cmp(two.0));
    let [minus, plus] = rays[..] else { panic!("{rays:?}") };
    assert_eq!((minus.0, minus.1, minus.2), ("L", -1.0, false));
    assert_eq!((plus.0, plus.1, plus.2), ("R", -1.0, true));
    for (found, wanted) in
        [(minus.3, -44230.7307195), (minus.4, -592025.380881), (plus.3, -1626.27024460971), (plus.4, 4121.88460936384)]
    {
        assert_relative_eq!(found, wanted, max_relative = 1e-8);
    }
    // Drawn left of 0, which is faster, and the machine's own orbits come in along them.
    let figure = drawn(&subject, "local-map");
    for label in ["of the local map: stable", "unstable", "the machine's own orbits"] {
        let line = series(&figure, 0, label);
        assert!(line.len() > 1 && line.iter().all(|[change, _]| *change < 1e-6), "{label}");
    }
    assert_eq!(figure.x.unit, "µs");
    let machine = series(&figure, 0, "the machine's own orbits");
    assert!(machine.iter().any(|[change, _]| *change < -0.9e6 * shown.reach));
    // The names stand at their rays.
    let words = figure.panels[0].series.iter().find_map(|series| match &series.data {
        Data::Words(words) => Some(words),
        _ => None,
    });
    for (name, slope) in [("x^- before the corner", minus.3), ("x^+ after the corner", plus.3)] {
        let word = words.unwrap().iter().find(|word| word.text == name).unwrap();
        assert_relative_eq!(word.at[1] / word.at[0] * 1e6, -slope, max_relative = 1e-6);
    }
    for line in &shown.machine {
        let slope = if line.stability == Stability::Stable { -plus.3 } else { -minus.3 };
        let near = line.points.iter().filter(|[change, _]| *change < 0.0 && *change > -0.05 * shown.reach);
        for [change, position] in near.filter(|[change, _]| *change < -1e-3 * shown.reach) {
            assert_relative_eq!(position / change, slope, max_relative = 0.02);
        }
    }
}

/// What `corner-impact figure` does with these words.
fn command(words: &[&str]) -> (Exit, String, String) {
    let words = ["corner-impact", "figure"].iter().chain(words).map(OsString::from);
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let exit = run(words, &mut out, &mut err);
    (exit, String::from_utf8(out).unwrap(), String::from_utf8(err).unwrap())
}

fn file(name: &str) -> String {
    Path::new(ROOT).join("models").join(name).display().to_string()
}

#[test]
fn it_lists_the_figures_and_each_name_of_the_list_is_drawn() {
    let (exit, page, _) = command(&[]);
    assert_eq!(exit, Exit::Agrees);
    let first = page.lines().nth(3).unwrap().trim_start();
    assert!(first.starts_with("cam-shape ") && first.contains("Figures 3(a) and 9"), "{first}");
    let (_, document, _) = command(&["--json"]);
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    assert_eq!(document["schema"], "corner-impact/figure/1");
    let listed = listed(&paper());
    assert_eq!(document["figures"].as_array().unwrap().len(), listed.len());
    let told = crate::common::in_one_line(&page);
    for figure in document["figures"].as_array().unwrap() {
        let [id, title] = ["id", "title"].map(|part| figure[part].as_str().unwrap());
        let title = title.trim_start_matches("osorio-2008: ");
        assert!(page.lines().any(|line| line.trim_start().starts_with(id)) && told.contains(title), "{id}: {page}");
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
    assert!(crate::common::in_one_line(&page).contains("(as Figure 5(e) of the paper)"), "{page}");
    let (_, list, _) = command(&[&model]);
    assert!(list.contains("Figures of damped-heavy"), "{list}");
    // A command that goes on in the next line ends with a backslash.
    let typed = crate::common::in_one_line(&page.replace(" \\\n", " "));
    assert!(typed.contains(&format!("corner-impact figure {model} corner-orbit --out corner-orbit.svg")), "{page}");
    let (_, document, _) = command(&[&model, "corner-orbit", "--json"]);
    let document: serde_json::Value = serde_json::from_str(&document).unwrap();
    assert!(document["figure"]["panels"][0]["series"].is_array() && document["absent"].is_null());
}

/// Figures at speeds that are chosen are at those, and the command that draws one again has them.
#[test]
fn speeds_of_figures_can_be_chosen() {
    let model = file("laws/harmonic.toml");
    let (_, page, _) = command(&[&model, "slow-trace", "--rpm", "400:600"]);
    let page = crate::common::in_one_line(&page.replace(" \\\n", " "));
    assert!(page.contains("at 500 rpm") && page.contains("In 2 revolutions the follower hits"), "{page}");
    assert!(page.contains("slow-trace --rpm 400:600 --out slow-trace.svg") && !page.contains("the paper's"), "{page}");
    // What the paper says of its own speeds is not said of others.
    let (_, paper, _) = command(&["slow-trace", "--rpm", "130:150"]);
    assert!(paper.contains("the motion at 140 rpm") && !paper.contains("that the paper describes"), "{paper}");
    let (_, own, _) = command(&[&model, "slow-trace"]);
    assert!(!own.contains("--rpm") && !own.contains("500 rpm"), "{own}");
}

/// What changes has its unit on the axis, the model's where that says one; and a table names what a legend does not.
#[test]
fn axes_have_the_units_of_the_model() {
    let si = Model::built_in().unwrap().units;
    let units =
        Model::parse("mm.toml", &OSORIO_2008.replace("[follower]", "[units]\nstiffness = \"N/mm\"\n[follower]"));
    let units = units.unwrap().units;
    for (name, is, there) in [
        ("rpm", "rpm", "rpm"),
        ("follower.stiffness", "N/m", "N/mm"),
        ("stiffness", "N/m", "N/mm"),
        ("follower.mass", "kg", "kg"),
        ("follower.preload", "N", "N"),
        ("follower.rest_position", "m", "m"),
        ("restitution", "", ""),
    ] {
        assert_eq!((si.of_number(name).as_str(), units.of_number(name).as_str()), (is, there), "{name}");
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("chart.svg");
    let words = ["chart", "models/osorio-2008.toml", "--x", "rpm=700:710:2", "--y", "stiffness=1400:1450:2", "--out"];
    let output = crate::common::program(words).arg(&path).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let drawn = std::fs::read_to_string(&path).unwrap();
    assert!(drawn.contains("stiffness (N/m)"), "{drawn}");
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drawn.png");
    let out = path.display().to_string();
    let cases: [(&[&str], &str); 4] = [
        (&["chaos"], "no figure called \"chaos\"; there are: cam-shape, cam,"),
        (&[&file("laws/harmonic.toml"), "composition", "--out", &out], "[study]"),
        (&[&file("laws/rectified-sine.toml"), "slow-trace", "--out", &out], "does not begin to leave the cam"),
        (&["--out", &out], "--out writes one figure"),
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

/// A run whose impacts recur is drawn with each place once. One that recurs less than twice is drawn in full.
#[test]
fn impacts_that_recur_are_drawn_once() {
    let repeats: &[(f64, &[f64], usize)] = &[
        (600.0, &[1.0, 1.0], 1),
        (610.0, &[1.0, 2.0, 1.0, 2.0, 1.0], 2),
        (620.0, &[1.0, 1.0, 2.0, 1.0, 1.0, 2.0], 3),
        // A thousandth of a degree is none that a picture shows, and neither is the zero of the cam.
        (630.0, &[0.00001, TAU - 0.000005, 0.00001], 1),
    ];
    let others: &[(f64, &[f64])] =
        &[(640.0, &[1.0]), (650.0, &[1.0, 2.0]), (660.0, &[1.0, 2.0, 1.0]), (670.0, &[1.0, 1.001, 1.0, 1.002])];
    let impacts = |rpm: f64, angles: &[f64]| angles.iter().map(|angle| [rpm, *angle]).collect::<Vec<_>>();
    let settled: Vec<_> = repeats.iter().flat_map(|(rpm, angles, _)| impacts(*rpm, angles)).collect();
    let drawn = |settled: &[[f64; 2]]| branches_figure("runs", ("rpm", "rpm", [600.0, 700.0]), &[], settled, &[]);
    let once: Vec<[f64; 2]> =
        repeats.iter().flat_map(|(rpm, angles, count)| impacts(*rpm, &angles[..*count])).collect();
    let once: Vec<[f64; 2]> = once.into_iter().map(|[rpm, angle]| [rpm, angle.to_degrees()]).collect();
    assert_eq!(series(&drawn(&settled), 0, "runs that repeat"), once);
    for (rpm, angles) in others {
        let figure = drawn(&impacts(*rpm, angles));
        assert_eq!(
            figure.panels[0].series.iter().map(|it| it.label.as_str()).collect::<Vec<_>>(),
            ["other runs"],
            "{rpm}"
        );
    }
}
