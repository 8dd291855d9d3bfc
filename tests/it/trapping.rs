//! Is a motion of the local map called chaotic only where it stays?

use crate::common;
use corner_impact::border_collision::LocalMap;
use corner_impact::border_collision::long_run::{EscapeReason, LocalLongRun};
use corner_impact::border_collision::word::Word;
use corner_impact::corner::map::SideMap;
use nalgebra::{Matrix2, RowVector2, Vector2};

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
#[ignore = "slow"]
fn a_long_transient_is_not_called_chaos() {
    for ([l, r], determinant) in [([1.8, -1.954043], 0.3), ([1.645, -26.9063], 0.64)] {
        let map = common::normal_form([l, r], [determinant; 2]);
        let end = map.end(Vector2::zeros(), 1.0);
        assert!(matches!(end, LocalLongRun::Undecided(_)), "{end:?}");
        let after = leaves(&map, 10_000_000);
        assert!(after.is_some_and(|steps| steps > 200_000), "{after:?}");
    }
}

/// Where the saddle's manifold leaves (phi < 0), an attractor that does not reach as far as its fold stays all the same.
#[test]
#[ignore = "slow"]
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
            LocalLongRun::Chaotic(chaos) => assert_eq!(chaos.region.polygons, 2, "{chaos:?}"),
            end => panic!("{traces:?} {determinants:?}: {end:?}"),
        }
        assert_eq!(leaves(&map, 3_000_000), None, "{traces:?} {determinants:?}");
        let from_the_fold = map.end(Vector2::new(8.0, 0.0), 1.0);
        assert!(matches!(from_the_fold, LocalLongRun::Escapes(EscapeReason::Follows { .. })), "{from_the_fold:?}");
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

/// Around two points: the hat x -> 1 - s |x| leaves the segment between them at the right, and its mirror image at the left. Of slope 1.5 it
/// has one that holds it; of slope 2.1 it has none, and what is beyond one end of a segment is not in it.
#[test]
fn a_segment_is_a_region_where_both_of_its_ends_hold() {
    let points = [Vector2::new(-0.5, 0.0), Vector2::new(0.5, 0.0)];
    for (slope, holds) in [(1.5, true), (2.1, false)] {
        let hat = common::of_the_line([slope, -slope]).region(&points, 1.0);
        let mirrored = common::of_the_line([-slope, slope]).region(&points, -1.0);
        assert!(hat.is_some() == holds && mirrored.is_some() == holds, "{slope}: {hat:?} {mirrored:?}");
    }
}

/// Where one slope is 1 an end of the segment is sent onto itself, and so is any other that it is moved out to: none is sent inside.
#[test]
fn what_is_sent_onto_the_edge_is_not_inside() {
    let points = [Vector2::new(-1.0, 0.0), Vector2::new(1.0, 0.0)];
    for slopes in [[0.5, 1.0], [1.0, 0.5]] {
        assert_eq!(common::of_the_line(slopes).region(&points, 0.0), None, "{slopes:?}");
    }
    assert!(common::of_the_line([0.5; 2]).region(&points, 0.0).is_some());
}

/// A quarter of a turn takes a segment out of its own line, however near to its middle.
#[test]
fn what_is_beside_a_segment_is_not_in_it() {
    let side = SideMap { a: Matrix2::new(0.0, -0.5, 0.5, 0.0), b: Vector2::zeros() };
    let map = LocalMap { minus: side, plus: side, ..common::of_the_line([0.0; 2]) };
    let region = map.region(&[Vector2::new(-1.0, 0.0), Vector2::new(1.0, 0.0)], 0.0).unwrap();
    assert_eq!((region.polygons, region.corners), (1, 4));
}

/// From the hat's unstable fixed point at its edge, which rounding does not leave: it is a point of the attractor's basin.
#[test]
fn a_motion_on_an_unstable_fixed_point_is_taken_off_it_by_little() {
    let end = common::of_the_line([1.5, -1.5]).end(Vector2::new(-2.0, 0.0), 1.0);
    match end {
        LocalLongRun::Chaotic(chaos) => assert!((chaos.exponent.value - 1.5_f64.ln()).abs() < 1e-9, "{chaos:?}"),
        end => panic!("{end:?}"),
    }
}

/// One eigenvalue is 2, the other -3: a motion that begins along the first leaves the word by the second, however small that is.
#[test]
fn a_motion_follows_a_word_for_ever_only_along_its_largest_eigenvalue() {
    let along = |second: f64| {
        let side = SideMap { a: Matrix2::new(2.0, 0.0, 0.0, second), b: Vector2::new(1.0, 0.0) };
        LocalMap { minus: side, plus: side, border: (RowVector2::new(1.0, 1.0), 0.0) }
    };
    let (word, start) = (Word::read("L").unwrap(), Vector2::new(-9.0, 1e-3));
    assert_eq!(along(-1.5).follows_for_ever(&word, start, -1.0), Some(2.0));
    assert_eq!(along(-3.0).follows_for_ever(&word, start, -1.0), None);
}

/// A fixed point, an orbit of two, and chaos, by their documents' names.
#[test]
fn ends_of_the_hat_have_names() {
    for (slopes, name) in [([0.5, -0.5], "fixed-point"), ([0.5, -1.5], "periodic"), ([1.5, -1.5], "chaotic")] {
        let outcome = common::of_the_line(slopes).outcome(1.0);
        let names: Vec<&str> = outcome.fates.iter().map(|fate| fate.end.name()).collect();
        // All starts that stay come to one end.
        assert_eq!(names.iter().filter(|it| **it != "escapes").collect::<Vec<_>>(), [&name], "{slopes:?}");
    }
}

/// Spirals that decay by a millionth a turn and less wander for as long as is run, and end on their fixed point: no region is
/// sent into itself by as much as is asked for.
#[test]
#[ignore = "slow"]
fn slow_spirals_are_not_called_chaos() {
    for less in [1e-5, 1e-9, 0.0] {
        for traces in [[0.9, 0.8], [0.9, -0.7], [-0.4, 1.2], [1.7, -1.1], [0.3, 0.31]] {
            let map = common::normal_form(traces, [1.0 - less; 2]);
            for (index, start) in [[0.0, 0.0], [0.4, 0.1], [3.0, -2.0]].into_iter().enumerate() {
                let end = map.end(Vector2::from(start), 1.0);
                assert!(!matches!(end, LocalLongRun::Chaotic(..)), "{less:e} {traces:?} {index}: {end:?}");
            }
        }
    }
}
