//! Are rests, the hardest impact and the smallest basin of a range of speeds what the counts make them?

use approx::assert_relative_eq;
use corner_impact::estimate::{ErrorIs, Estimate};
use corner_impact::orbit::ending::{Ending, Kind, Resting};
use corner_impact::progress::Unwatched;
use corner_impact::study::attractors::Wandering;
use corner_impact::study::speeds::{At, Attractor, Speeds, speeds};

use crate::orbit_numbers::model;
use crate::study_numbers::resolution;

fn attractor(at: Vec<At>) -> Attractor {
    Attractor {
        id: "A1".into(),
        kind: Kind::Chaotic,
        revolutions: None,
        impacts: None,
        rpm: [1.0, 2.0],
        birth: None,
        death: None,
        at,
    }
}

/// Once in so many revolutions of runs that wandered, with the error of a count; of none the bound that chance passes once in twenty times.
#[test]
fn rests_of_chaos_are_counted_where_runs_were_long_enough() {
    let growth = Estimate { value: 1.0, error: 0.1, error_is: ErrorIs::Standard };
    let wanders = |revolutions: u64, rested: u64| At {
        rpm: 1.0,
        share: growth,
        ending: Ending::Chaotic(growth),
        wandering: Wandering { revolutions, left: 0, rested },
        impact_angles: Vec::new(),
        impact_speed: None,
    };
    assert_eq!(attractor(vec![wanders(99_999, 3)]).rests(), None);
    let found = attractor(vec![wanders(99_999, 3), wanders(1, 1)]).rests().unwrap();
    assert_eq!((found.rests, found.revolutions, found.rate, found.rate_error), (4, 100_000, 4e-5, Some(2e-5)));
    let found = attractor(vec![wanders(100_000, 0)]).rests().unwrap();
    assert_eq!((found.rests, found.rate_error), (0, None));
    assert_relative_eq!(found.rate, -(0.05_f64.ln()) * 1e-5, max_relative = 1e-12);
    // What rests often is not chaos that rests.
    let rests = |growth: f64| {
        let resting = Resting { releases: vec![1.0], revolutions: 7, impacts: 5, impact_speed: 1.0, growth };
        At { ending: Ending::Resting(resting), ..wanders(100_000, 1) }
    };
    assert_eq!(attractor(vec![rests(1.0)]).rests(), None);
    assert_eq!(attractor(vec![rests(60.0), wanders(1, 0)]).rests().unwrap().revolutions, 100_001);
}

#[test]
fn the_hardest_impact_and_the_smallest_basin_are_told() {
    let found = speeds(&model("laws/polynomial"), [420.0, 422.0], resolution(0.5, 3), &Unwatched).unwrap();
    let fastest: Vec<[f64; 2]> =
        found.attractors.iter().flat_map(|it| &it.at).filter_map(|at| Some([at.impact_speed?, at.rpm])).collect();
    let [speed, rpm] = found.hardest().unwrap();
    assert!(fastest.contains(&[speed, rpm]) && fastest.iter().all(|it| it[0] <= speed));
    let missed = |starts: usize| Speeds { starts, attractors: Vec::new(), ..found.clone() }.missed();
    // exp(-3 %) of 100 starts.
    assert_relative_eq!((-missed(100) * 100.0).exp(), 0.05, max_relative = 1e-12);
    assert_eq!([missed(1), missed(2)], [1.0, 1.0]);
    assert!(missed(3) < 1.0);
    assert_eq!(Speeds { attractors: Vec::new(), ..found }.hardest(), None);
}
