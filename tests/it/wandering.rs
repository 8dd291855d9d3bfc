//! How long are runs waited for that end on nothing, and what are they told to be beside others that rest?

use corner_impact::model::Model;
use corner_impact::orbit::long_run::{Budget, Kind};
use corner_impact::study::attractors::AttractorsAtValue;
use corner_impact::study::survey::{Sample, Wandering};

use crate::common;
use crate::orbit_numbers::{machine, model};

/// The motions that so many starts come to at a speed: kind, whether what tells it from chaos is rounding, and of how many starts.
fn parts(model: &Model, rpm: f64, starts: usize) -> (Vec<(Kind, bool, usize)>, Wandering) {
    let here = AttractorsAtValue::new(&machine(model, rpm), &Sample::Spread(starts), Budget::SURVEY).unwrap();
    let parts = here.attractors.iter().map(|part| (part.ending.kind(), part.ending.is_long(), here.count(part)));
    (parts.collect(), here.wandering)
}

/// They are given a hundred thousand revolutions together, a quarter of it at once, in equal parts of whole revolutions, of which 32 are
/// the least; the first two hundred of each do not count. A release that chaos follows has been followed for twenty thousand.
#[test]
fn runs_that_wander_share_a_hundred_thousand_revolutions() {
    let [paper, polynomial] = [common::osorio(), model("laws/polynomial")];
    for (of, rpm, starts, revolutions) in [
        // From two places where the cam lets go, 40,000; twice 3 x 8333, and 3 x 3334 of the 10,002 that are left.
        (&paper, 671.0, 3, 100_000),
        // From one place, 20,000; three times 3 x 8333, 3 x 1667 of 5003, and for the last two each of the three runs 32.
        (&polynomial, 588.0, 3, 99_998 + 96),
    ] {
        let (parts, wandering) = parts(of, rpm, starts);
        assert_eq!(parts, [(Kind::Chaotic, false, starts)], "{} {rpm}", of.name);
        assert_eq!(wandering, Wandering { revolutions, left: 0, rested: 0 }, "{} {rpm} {starts}", of.name);
    }
}

/// Of 64 starts 37 rest sooner or later, and where the last few do not in a hundred thousand revolutions that is chance: it is one
/// motion, which no run has left by resting.
#[test]
fn what_rests_as_seldom_as_it_did_at_first_is_one_motion() {
    for (rpm, rested) in [(524.0, 37), (643.0, 34), (307.0, 15)] {
        let (parts, wandering) = parts(&common::osorio(), rpm, 64);
        assert_eq!(parts, [(Kind::Resting, true, 64)], "{rpm}");
        assert_eq!((wandering.left, wandering.rested), (0, rested), "{rpm}");
    }
}

/// Of up to four rests it is not known that there are many: `n - 2 sqrt(n)` of them is none. So runs that do not rest are not told from
/// those few that did; beside a motion that rests in every few revolutions they are, however few starts come to either.
#[test]
fn a_few_rests_tell_no_motion_from_chaos() {
    for rpm in [476.0, 481.0] {
        let (parts, wandering) = parts(&common::osorio(), rpm, 3);
        assert_eq!((parts, wandering.rested), (vec![(Kind::Resting, true, 3)], 0), "{rpm}");
    }
    let (parts, _) = parts(&common::osorio(), 475.0, 3);
    assert_eq!(parts, [(Kind::Chaotic, false, 1), (Kind::Resting, false, 2)]);
}
