//! Is what long work tells of how far it has come between nothing and all of it, and does it come to all?

use std::sync::Mutex;

use corner_impact::flight::State;
use corner_impact::model::Study;
use corner_impact::progress::Watch;
use corner_impact::study::StudyError;
use corner_impact::study::chaos::chaos;
use corner_impact::study::chart::store::{Shard, Store};
use corner_impact::study::design::design;
use corner_impact::study::design::needs::Lever;
use corner_impact::study::locate::locate;
use corner_impact::study::simulate::{RunRequest, Sight, Simulation, Until};
use corner_impact::study::survey::{Placed, Start};

use crate::chart_store::chart;
use crate::common;
use crate::design_numbers::{OWN, asked, ball};
use crate::orbit_numbers::model;
use crate::study_numbers::resolution;

/// All that is told, in order.
#[derive(Default)]
struct Told(Mutex<Vec<(String, u64, u64)>>);

impl Watch for Told {
    fn at(&self, what: &str, done: u64, total: u64) {
        self.0.lock().unwrap().push((what.into(), done, total));
    }
}

impl Told {
    /// Done and total of what is told of `what`.
    fn of(&self, what: &str) -> Vec<[u64; 2]> {
        let told = self.0.lock().unwrap();
        told.iter().filter(|(said, ..)| said == what).map(|(_, done, total)| [*done, *total]).collect()
    }
}

/// A bar that runs past its end, or backwards by more than the threads that work at once, says nothing.
#[test]
#[ignore = "slow"]
fn as_much_is_told_to_be_done_as_there_is_at_most() {
    let (paper, told) = (common::osorio(), Told::default());
    let narrow = Study { rpm_min: 679.0, rpm_max: 681.0 };
    locate(&paper, narrow, 1, &told).unwrap();
    common::speeds(&ball(""), [300.0, 303.0], resolution(1.0, 4), &told).unwrap();
    chart(&paper, 8).run(Some(1), &told).unwrap();
    chaos(&paper, [100.0, 100.05], false, &told).unwrap();
    let all = told.0.lock().unwrap().clone();
    assert!(all.iter().any(|(_, done, total)| done == total && *total > 0));
    for (what, done, total) in &all {
        assert!(*total == 0 || done <= total, "{what}: {done} of {total}");
    }
    assert_eq!(told.of("rows"), [1, 2, 3, 4].map(|done| [done, 4]));
    // Whole revolutions a minute, of which there is none; asked for all of the range, and for each half.
    assert_eq!(told.of("h-sets that cover themselves: rpm"), [[0, 0]; 3]);
}

/// In thousandths of a revolution, or impacts, from where the run begins on; and events are shown as soon as there are 4096.
#[test]
fn a_run_tells_how_far_it_has_turned() {
    let paper = common::osorio();
    let start = Start { cam_angle: 1.0, follower: Placed::At(State { position: 1.2, velocity: 0.0 }) };
    let simulation = Simulation::new(&paper, 700.0, start).unwrap();
    let told = |wanted: RunRequest| {
        let (told, mut shown) = (Told::default(), Vec::new());
        let see = |sight: Sight<'_>| -> Result<(), StudyError> {
            if let Sight::Events(events) = sight {
                shown.push(events.len());
            }
            Ok(())
        };
        simulation.run(wanted, &told, see).unwrap();
        (told.of(""), shown)
    };
    let wanted =
        RunRequest { until: Until::Revolutions(2), events: false, strobe: Some(1.0 + 1.5), drawn: 0, long_run: None };
    // 1.5 rad are 238.7 thousandths of a turn.
    assert_eq!(told(wanted).0, [238, 1238, 2000].map(|done| [done, 2000]));
    let (told, shown) = told(RunRequest { until: Until::Impacts(5000), events: true, strobe: None, ..wanted });
    assert_eq!((told.last(), shown.iter().sum::<usize>()), (Some(&[4_096_000, 5_000_000]), 5000));
    assert!(shown.iter().all(|shown| *shown <= 4096) && shown.contains(&4096), "{shown:?}");
    assert!(told.iter().all(|[done, total]| done <= total), "{told:?}");
}

/// Of each need that each number could meet, one piece of work.
#[test]
fn needs_are_counted_by_the_numbers_that_could_meet_them() {
    let (told, mut asked) = (Told::default(), asked("no separation to 400 rpm"));
    asked.needs.push(asked.needs[0].clone());
    design(&OWN.model(true, false), &asked, &told).unwrap();
    let of = |lever: Lever| told.of(&format!("the {lever} for \"no separation to 400 rpm\""));
    for (index, lever) in (0..).zip(Lever::ALL) {
        assert_eq!(of(lever), [index, 4 + index].map(|done| [done, 8]), "{lever}");
    }
}

/// Each block of a part, as it begins.
#[test]
fn blocks_of_a_store_are_counted_over_all_of_it() {
    let (folder, chart, told) = (tempfile::TempDir::new().unwrap(), chart(&model("osorio-2008"), 8), Told::default());
    let store = Store::open(folder.path(), &chart, [2, 3]).unwrap();
    store.fill(Shard { index: 2, of: 4 }, Some(1), &told).unwrap();
    assert_eq!(told.of("blocks"), [[1, 6], [5, 6]]);
}
