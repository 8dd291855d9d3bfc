//! Does finding contacts take what it took? How often the gap is evaluated, how many steps of Newton's and Halley's methods
//! are taken and how many windows are marched over, at a speed of each kind: counts, so that a change that makes the
//! simulator slower is seen whatever the machine is doing.

use std::ops::ControlFlow;
use std::path::Path;

use corner_impact::simulate::{Event, Machine, Observer, Work, angular_velocity};
use serde_json::json;

use crate::common;
use crate::properties::goal;
use crate::random::{cases_of_every_law, cases_of_many_segments, drawn};
use crate::snapshots;

/// What all looks for a contact took, and those alone that marched, up to so many events.
struct Counted {
    work: Work,
    marched: Work,
    windows: u64,
    events: u64,
    most: u64,
}

impl Counted {
    fn up_to(most: u64) -> Self {
        let none = Work::default();
        Self { work: none, marched: none, windows: 0, events: 0, most }
    }
}

fn add(all: &mut Work, Work { gaps, steps, marches, repeats }: Work) {
    all.gaps += gaps;
    all.steps += steps;
    all.marches += marches;
    all.repeats += repeats;
}

impl Observer for Counted {
    const COUNTS: bool = true;

    fn event(&mut self, _event: &Event) -> ControlFlow<()> {
        self.events += 1;
        if self.events == self.most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn work(&mut self, work: Work) {
        add(&mut self.work, work);
        self.windows += 1;
        if work.marches > 0 {
            add(&mut self.marched, work);
        }
    }
}

/// At 700 rpm the motion settles on an orbit of one impact, at 670 rpm it is chaotic, at 183 rpm it chatters and sticks. Of
/// chaos only as many revolutions as the last digits of a machine's sine need to make a difference.
#[test]
fn finding_contacts_takes_what_it_took() {
    let model = common::osorio();
    let counts = [(700.0, 1000), (670.0, 40), (183.0, 200)].map(|(rpm, revolutions)| {
        let machine = Machine::new(common::cam(&model), &model.follower, angular_velocity(rpm));
        let mut motion = machine.start_on_cam(0.0, 1.0).unwrap();
        let goal = motion.after(revolutions);
        let mut counted = Counted::up_to(u64::MAX);
        let _ = machine.advance(&mut motion, goal, &mut counted).unwrap();
        let Counted { work: Work { gaps, steps, marches, repeats }, events, .. } = counted;
        json!({
            "rpm": rpm, "revolutions": revolutions, "events": events, "gap_evaluations": gaps, "newton_steps": steps,
            "marches": marches, "repeats": repeats,
        })
    });
    snapshots::settings().bind(|| insta::assert_json_snapshot!("work", counts));
}

/// Over the 360 segments of a table a flight leaps to the segment that it comes down on, from wherever it is: a window of its own for what is
/// left of the segment that it begins on would take more than four evaluations for each contact.
#[test]
fn a_flight_over_many_segments_is_looked_at_where_it_comes_down() {
    let model = common::read(Path::new("models/laws/table-cubic.toml"));
    let machine = Machine::new(common::cam(&model), &model.follower, angular_velocity(670.0));
    let mut motion = machine.start_on_cam(0.0, 1.0).unwrap();
    let goal = motion.after(1000);
    let mut counted = Counted::up_to(u64::MAX);
    let _ = machine.advance(&mut motion, goal, &mut counted).unwrap();
    let each = counted.work.gaps as f64 / counted.events as f64;
    assert!(each < 3.5, "{each} evaluations for each of {} contacts", counted.events);
}

/// Whatever the cam, the follower and the start, to the few that the last digits of a sine decide: looks that do not march, their
/// gaps and steps; those that do, and their gaps.
#[test]
#[ignore = "slow"]
fn any_machine_takes_what_it_took() {
    for (cases, took) in [
        (drawn(cases_of_every_law(), 500), [6380, 15417, 9450, 1597, 29285]),
        (drawn(cases_of_many_segments(), 150), [1756, 4017, 2677, 609, 5261]),
    ] {
        let mut takes = [0; 5];
        for case in cases {
            let mut motion = case.motion().unwrap();
            let goal = goal(&motion, case.turns(2.0));
            let mut counted = Counted::up_to(50);
            // A run may end early, as others of these machines do.
            let _ = case.machine.advance(&mut motion, goal, &mut counted);
            let Counted { work, marched, windows, .. } = counted;
            let [gaps, steps] = [work.gaps - marched.gaps, work.steps - marched.steps];
            let these = [windows - marched.marches, gaps, steps, marched.marches, marched.gaps];
            takes.iter_mut().zip(these).for_each(|(takes, more)| *takes += more);
        }
        let is_more = takes.iter().zip(&took).any(|(takes, took)| *takes as f64 > 1.001 * f64::from(*took));
        assert!(!is_more, "{takes:?}, and it was {took:?}");
    }
}

/// The tests are compiled without optimisation, six times as fast: `cargo remove` once took these lines of the manifest away, and a build of all
/// took two minutes more.
#[test]
fn tests_are_compiled_without_optimisation() {
    let manifest: toml::Table =
        common::text(std::fs::read(Path::new(common::ROOT).join("Cargo.toml")).unwrap()).parse().unwrap();
    let levels = &manifest["profile"]["release"]["package"];
    for name in ["corner-impact-tests", "proptest", "gemm-c64", "regex-automata"] {
        assert_eq!(levels[name]["opt-level"].as_integer(), Some(0), "{name}");
    }
}
