//! Does finding contacts take what it took? How often the gap is evaluated, how many steps of Newton's and Halley's methods
//! are taken and how many windows are marched over, at a speed of each kind: counts, so that a change that makes the
//! simulator slower is seen whatever the machine is doing.

use std::ops::ControlFlow;
use std::path::Path;

use corner_impact::simulate::{Event, Machine, Observer, Work, angular_velocity};
use serde_json::json;

use crate::common;
use crate::random::{cases_of_every_law, cases_of_many_segments, drawn};

#[derive(Default)]
struct Counted {
    work: Work,
    events: u64,
}

impl Observer for Counted {
    const COUNTS: bool = true;

    fn event(&mut self, _event: &Event) -> ControlFlow<()> {
        self.events += 1;
        ControlFlow::Continue(())
    }

    fn work(&mut self, Work { gaps, steps, marches, repeats }: Work) {
        self.work.gaps += gaps;
        self.work.steps += steps;
        self.work.marches += marches;
        self.work.repeats += repeats;
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
        let mut counted = Counted::default();
        let _ = machine.advance(&mut motion, goal, &mut counted).unwrap();
        let Counted { work: Work { gaps, steps, marches, repeats }, events } = counted;
        json!({
            "rpm": rpm, "revolutions": revolutions, "events": events, "gap_evaluations": gaps, "newton_steps": steps,
            "marches": marches, "repeats": repeats,
        })
    });
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../golden/snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_json_snapshot!("work", counts));
}

/// Over the 360 segments of a table a flight leaps to the segment that it comes down on, from wherever it is: a window of its own for what is
/// left of the segment that it begins on would take more than four evaluations for each contact.
#[test]
fn a_flight_over_many_segments_is_looked_at_where_it_comes_down() {
    let model = common::read(Path::new("models/laws/table-cubic.toml"));
    let machine = Machine::new(common::cam(&model), &model.follower, angular_velocity(670.0));
    let mut motion = machine.start_on_cam(0.0, 1.0).unwrap();
    let goal = motion.after(1000);
    let mut counted = Counted::default();
    let _ = machine.advance(&mut motion, goal, &mut counted).unwrap();
    let each = counted.work.gaps as f64 / counted.events as f64;
    assert!(each < 3.5, "{each} evaluations for each of {} contacts", counted.events);
}

/// What looking for contacts took: windows that were not marched over, and their gaps and steps; those that were, and their gaps.
#[derive(Default)]
struct Looks {
    taken: [u64; 5],
    events: u64,
}

impl Observer for Looks {
    const COUNTS: bool = true;

    fn event(&mut self, _event: &Event) -> ControlFlow<()> {
        self.events += 1;
        if self.events.is_multiple_of(50) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn work(&mut self, work: Work) {
        let [windows, gaps, steps, marches, marched] = &mut self.taken;
        if work.marches > 0 {
            *marches += work.marches;
            *marched += work.gaps;
        } else {
            *windows += 1;
            *gaps += work.gaps;
            *steps += work.steps;
        }
    }
}

/// Whatever the cam, the follower and the start, to the few that the last digits of a sine decide.
#[test]
fn any_machine_takes_what_it_took() {
    let taken = |cases: Vec<crate::random::Case>| {
        let mut looks = Looks::default();
        for case in cases {
            let mut motion = case.motion().unwrap();
            let goal = crate::properties::goal(&motion, case.turns(2.0));
            let _ = case.machine.advance(&mut motion, goal, &mut looks);
            looks.events = looks.events.next_multiple_of(50);
        }
        looks.taken
    };
    for (cases, took) in [
        (drawn(cases_of_every_law(), 500), [6394, 15443, 9471, 1583, 26979]),
        (drawn(cases_of_many_segments(), 150), [1756, 4017, 2677, 609, 5261]),
    ] {
        let takes = taken(cases);
        let is_more = takes.iter().zip(&took).any(|(takes, took)| *takes as f64 > 1.001 * *took as f64);
        assert!(!is_more, "{takes:?}, and it was {took:?}");
    }
}
