//! Is a motion of the local map called chaotic only where it stays?

use crate::common;
use corner_impact::border_collision::LocalMap;
use corner_impact::border_collision::long_run::{End, Escape};
use nalgebra::Vector2;

/// Steps after which the motion from 0 is a million times the size of the map, of at most `most`.
fn leaves(map: &LocalMap, most: u64) -> Option<u64> {
    let mut x = Vector2::zeros();
    (0..most).find(|_| {
        x = map.apply(x, 1.0);
        x.amax() > 1e6
    })
}

/// Next to where the attractor ends, past it, motions stay for millions of steps: the second map has nearly the traces and
/// determinants of the paper's A-.
#[test]
fn a_long_transient_is_not_called_chaos() {
    for ([l, r], determinant) in [([1.8, -1.954043], 0.3), ([1.645, -26.9063], 0.64)] {
        let map = common::normal_form([l, r], [determinant; 2]);
        let end = map.end(Vector2::zeros(), 1.0);
        assert!(matches!(end, End::Undecided(_)), "{end:?}");
        let after = leaves(&map, 10_000_000);
        assert!(after.is_some_and(|steps| steps > 200_000), "{after:?}");
    }
}

/// Where the saddle's manifold leaves (phi < 0), an attractor that does not reach as far as its fold stays all the same.
#[test]
fn what_is_said_to_stay_stays() {
    for (traces, determinants) in [
        ([2.1, -1.4777777777777779], [0.4, 0.4]),
        ([2.7, -1.4777777777777779], [0.4, 0.4]),
        ([2.0, -1.4777777777777779], [0.7, 0.3]),
        ([2.3, -1.4777777777777779], [0.7, 0.3]),
    ] {
        let map = common::normal_form(traces, determinants);
        match map.end(Vector2::zeros(), 1.0) {
            // Two pieces, each of which is sent into the other.
            End::Chaotic(chaos) => assert_eq!(chaos.region.polygons, 2, "{chaos:?}"),
            end => panic!("{traces:?} {determinants:?}: {end:?}"),
        }
        assert_eq!(leaves(&map, 3_000_000), None, "{traces:?} {determinants:?}");
        let from_the_fold = map.end(Vector2::new(8.0, 0.0), 1.0);
        assert!(matches!(from_the_fold, End::Escapes(Escape::Follows { .. })), "{from_the_fold:?}");
    }
}

/// A region is none where the points around which it is made leave, or where there are none.
#[test]
fn what_leaves_has_no_region() {
    let map = common::normal_form([1.8, -1.954043], [0.3, 0.3]);
    let motion = |map: &LocalMap, mu: f64| {
        let mut x = Vector2::zeros();
        let mut step = || {
            x = map.apply(x, mu);
            x
        };
        (0..8192).map(|_| step()).collect::<Vec<_>>()
    };
    assert_eq!(map.region(&motion(&map, 1.0), 1.0), None);
    assert_eq!(map.region(&[], 1.0), None);
    let bounded = common::normal_form([1.8, -1.9], [0.3, 0.3]);
    let region = bounded.region(&motion(&bounded, 1.0), 1.0).unwrap();
    assert!(region.polygons == 1 && region.corners > 3, "{region:?}");
    // At the other sign of mu there is nothing to the left of the border, and the motion grows.
    assert_eq!(bounded.region(&motion(&bounded, 1.0), -1.0), None);
}

/// Spirals that decay by a millionth a turn and less wander for as long as is run, and end on their fixed point: no region is
/// sent into itself by as much as is asked for.
#[test]
#[ignore = "slow"]
fn slow_spirals_are_not_called_chaos() {
    for less in [1e-5, 1e-6, 1e-7, 1e-9, 1e-12, 0.0] {
        for traces in [[0.9, 0.8], [0.9, -0.7], [-0.4, 1.2], [1.7, -1.1], [0.3, 0.31]] {
            let map = common::normal_form(traces, [1.0 - less; 2]);
            for (index, start) in [[0.0, 0.0], [0.4, 0.1], [3.0, -2.0]].into_iter().enumerate() {
                let end = map.end(Vector2::from(start), 1.0);
                assert!(!matches!(end, End::Chaotic(..)), "{less:e} {traces:?} {index}: {end:?}");
            }
        }
    }
}
