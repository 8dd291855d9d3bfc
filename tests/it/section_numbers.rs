//! Are saddles, their curves, and starts on a section where their equations have them?

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::long_run::Budget;
use corner_impact::orbit::{Course, Search, search};
use corner_impact::progress::Unwatched;
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::{EventKind, angular_velocity};
use corner_impact::study::StudyError;
use corner_impact::study::basins::boundary::{approach, border};
use corner_impact::study::basins::{BasinSection, Curve, Extent, Grid, Reversed, Saddle, SectionStarts};
use serde_json::{Value, json};

use crate::attractors::ball;
use crate::common;
use crate::global::{SECTION as STROBE, saddle};
use crate::orbit_numbers::machine;

/// A budget within which runs are told that are not waited for.
const SOON: Budget = Budget { patience: 0, ..Budget::SURVEY };

fn map(model: &Model, rpm: f64, cam_angle: f64) -> StroboscopicMap {
    StroboscopicMap { machine: machine(model, rpm), cam_angle }
}

/// One multiplier on either side of 1, both above 0, each with its direction: of length 1 with the velocity over omega. And curves from it
/// begin there and go in small steps.
#[test]
fn a_saddle_has_two_directions_and_curves_along_them() {
    let paper = common::osorio();
    let map = map(&paper, 678.0, STROBE);
    let omega = map.machine.angular_velocity();
    let orbits = search(&map.machine, &Search { revolutions: 1, impacts: Some(1) }).unwrap();
    let mut saddles = Vec::new();
    for orbit in &orbits {
        let Course::Impacts(cycle) = &orbit.course else { continue };
        let found = Saddle::new(&map.machine, cycle, STROBE);
        assert_eq!(found.is_some(), !orbit.is_stable() && orbit.multipliers().iter().all(|it| it.re > 0.0));
        saddles.extend(found);
        // Twice the same orbit is none of one revolution.
        let mut twice = cycle.clone();
        twice.revolutions = 2;
        assert_eq!(Saddle::new(&map.machine, &twice, STROBE), None);
    }
    let [saddle] = saddles[..] else { panic!("{saddles:?}") };
    let (_, matrix) = map.carry(saddle.state, 1).unwrap();
    for (multiplier, along) in [saddle.stable, saddle.unstable] {
        assert_relative_eq!(along[0].hypot(along[1] / omega), 1.0, max_relative = 1e-12);
        let carried = matrix * along - along * multiplier;
        assert!(carried[0].hypot(carried[1] / omega) < 1e-6 * multiplier, "{carried}");
    }
    assert!(saddle.stable.0 < 1.0 && 1.0 < saddle.unstable.0);
    // The product of both is that of the impact, r^2 without a damper.
    assert_relative_eq!(saddle.stable.0 * saddle.unstable.0, 0.64, max_relative = 1e-6);
    // Past a flip both are below 0: no saddle whose halves stay apart.
    let flipped = machine(&paper, 742.0);
    let beyond = search(&flipped, &Search { revolutions: 1, impacts: Some(1) }).unwrap();
    let beyond =
        beyond.iter().filter_map(|it| if let Course::Impacts(cycle) = &it.course { Some((it, cycle)) } else { None });
    let mut seen = 0;
    for (orbit, cycle) in beyond {
        let is_saddle = orbit.multipliers().iter().all(|it| it.im == 0.0 && it.re > 0.0) && !orbit.is_stable();
        assert_eq!(Saddle::new(&flipped, cycle, 0.0).is_some(), is_saddle, "{orbit:?}");
        seen += usize::from(orbit.multipliers().iter().any(|it| it.re < -1.0));
    }
    assert!(seen > 0);
    let extent = Extent { stretches: 12, first: 1e-4, finest: 0.02, farthest: 1.0 };
    let curve = Curve::unstable(&map, &saddle, 1.0, &extent);
    let away = |one: State, two: State| (one.position - two.position).hypot((one.velocity - two.velocity) / omega);
    let points: Vec<State> = curve.points().collect();
    assert_eq!(points[0], saddle.state);
    assert!(points.iter().all(|it| away(*it, saddle.state) <= extent.farthest));
    for piece in &curve.pieces {
        assert!(!piece.is_empty() && piece.windows(2).all(|pair| away(pair[0], pair[1]) <= extent.finest));
    }
    let bounds = curve.bounds();
    assert!(points.iter().all(|it| bounds.distance(*it) == 0.0 && curve.distance(*it) < 1e-12));
    let far = State { position: saddle.state.position + 5.0, velocity: saddle.state.velocity };
    let nearest = points.iter().map(|it| away(*it, far)).fold(f64::INFINITY, f64::min);
    let distance = curve.distance(far);
    let rounding = 1e-12 * distance;
    assert!(distance <= nearest + rounding && nearest - distance < extent.finest, "{distance} {nearest}");
    assert!(bounds.distance(far) <= distance + rounding);
    assert!(bounds.distance(far) > 3.0);
    assert_eq!(curve.distance_below(distance + 1.0, far), distance);
    assert_eq!(curve.distance_below(0.5 * distance, far), 0.5 * distance);
    // An impact that keeps nothing cannot be run backwards.
    let mut dead = paper.follower;
    dead.restitution = 0.0;
    assert!(Reversed::new(&dead, &map).is_none() && Reversed::new(&paper.follower, &map).is_some());
}

/// From the cam to twice as far as any orbit; over three times the velocities of cam and orbits; or as they are given.
#[test]
fn starts_of_a_section_are_about_its_orbits() {
    let paper = common::osorio();
    let section = BasinSection::new(&paper, 700.0, STROBE).unwrap();
    let machine = &section.map.machine;
    let lift = machine.cam().lift(STROBE);
    let orbits = search(machine, &Search { revolutions: 1, impacts: Some(1) }).unwrap();
    let crossings: Vec<State> = orbits
        .iter()
        .map(|orbit| {
            machine.start(0.0, orbit.state).map(|mut motion| {
                let goal = motion.next(STROBE);
                let _ = machine.advance(&mut motion, goal, &mut |_: &corner_impact::simulate::Event| {
                    std::ops::ControlFlow::Continue(())
                });
                motion.state
            })
        })
        .map(Result::unwrap)
        .collect();
    assert!(crossings.len() > 1);
    let grid = section.grid([3, 2], None, None).unwrap();
    let highest = crossings.iter().map(|it| it.position).fold(machine.cam().top(), f64::max);
    assert_relative_eq!(grid.positions[0], lift.value, max_relative = 1e-12);
    assert_relative_eq!(grid.positions[1], lift.value + 2.0 * (highest - lift.value), max_relative = 1e-6);
    let of_cam = machine.angular_velocity() * lift.slope;
    let all = crossings.iter().map(|it| it.velocity).chain([of_cam, 0.0]);
    let [least, most] = all.fold([f64::MAX, f64::MIN], |[low, high], it| [low.min(it), high.max(it)]);
    assert_relative_eq!(grid.velocities[0], 2.0 * least - most, max_relative = 1e-6, epsilon = 1e-6);
    assert_relative_eq!(grid.velocities[1], 2.0 * most - least, max_relative = 1e-6, epsilon = 1e-6);
    let given = section.grid([1, 1], Some([1.0, 2.0]), Some([-3.0, 4.0])).unwrap();
    assert_eq!((given.positions, given.velocities, given.cam_angle), ([1.0, 2.0], [-3.0, 4.0], STROBE));
    let whole = [-f64::MAX, f64::MAX];
    for (positions, velocities) in [
        ([2.0, 2.0], [-3.0, 4.0]),
        ([1.0, 2.0], [4.0, 4.0]),
        ([1.0, f64::INFINITY], [-3.0, 4.0]),
        // Whose width is no double.
        (whole, [-3.0, 4.0]),
        ([1.0, 2.0], whole),
    ] {
        let none = section.grid([1, 1], Some(positions), Some(velocities));
        assert!(matches!(none, Err(StudyError::NoStarts)), "{none:?}");
    }
    // A cam at rest at its lowest, and a follower with no orbit of one impact: as fast as its height in a radian.
    let slow = BasinSection::new(&paper, 50.0, 0.0).unwrap();
    let (cam, omega) = (slow.map.machine.cam(), angular_velocity(50.0));
    let grid = slow.grid([1, 1], None, None).unwrap();
    let height = cam.top() - cam.lowest().value;
    assert_relative_eq!(grid.velocities[1], 3.0 * omega * height, max_relative = 1e-9);
    assert_relative_eq!(grid.velocities[0], -3.0 * omega * height, max_relative = 1e-9);
    assert_relative_eq!(grid.positions[1], cam.lowest().value + 2.0 * height, max_relative = 1e-9);
}

/// Cells are counted row by row from the lowest velocity up, each with its middle; what is below the cam is none.
#[test]
fn a_grid_of_starts_counts_its_cells() {
    let grid = Grid { cam_angle: STROBE, positions: [0.2, 1.0], velocities: [-6.0, 6.0], cells: [4, 3] };
    for (cell, position, velocity) in [(0, 0.3, -4.0), (3, 0.9, -4.0), (4, 0.3, 0.0), (11, 0.9, 4.0)] {
        let start = grid.start(cell);
        assert_relative_eq!(start.position, position, max_relative = 1e-12);
        assert_abs_diff_eq!(start.velocity, velocity, epsilon = 1e-12);
    }
    let paper = common::osorio();
    let machine = machine(&paper, 678.0);
    let lift = machine.cam().lift(STROBE).value;
    let found = SectionStarts::Grid(grid).basins(&machine, Budget::SURVEY, Some(1), &Unwatched).unwrap();
    for (cell, part) in found.cells.iter().enumerate() {
        assert_eq!(part.is_none(), grid.start(cell).position < lift, "{cell}");
    }
    let above = found.cells.iter().flatten().count();
    assert!(above == found.starts && (1..12).contains(&above));
    for (index, part) in found.parts.iter().enumerate() {
        assert_eq!(found.cells.iter().filter(|it| **it == Some(index)).count(), part.starts);
        assert_relative_eq!(part.share.value, part.starts as f64 / above as f64, max_relative = 1e-12);
    }
    assert!(found.parts.is_sorted_by(|one, two| one.starts >= two.starts));
    let map = map(&paper, 678.0, STROBE);
    let line = |from: f64, to: f64| [from, to].map(|position| State { position, velocity: 0.0 });
    // On one side of the saddle alone there is none.
    assert_eq!(border(&map, line(0.6, 0.6), SOON).unwrap(), None);
    let across = border(&map, line(0.6, 6.0), SOON).unwrap().unwrap();
    assert!(across.position > 0.6 && across.position < 6.0, "{across:?}");
}

/// On every section the directions are those that the map stretches by the multipliers, and where it carries a position to the velocity
/// alone, so that one row of the matrix says nothing, as well as elsewhere.
#[test]
fn directions_of_a_saddle_are_those_that_the_map_stretches() {
    let paper = common::osorio();
    let at = |cam_angle: f64| {
        let map = map(&paper, 678.0, cam_angle);
        let saddle = saddle(&map);
        let (_, matrix) = map.carry(saddle.state, 1).unwrap();
        (saddle, matrix, map.machine.angular_velocity())
    };
    let holds = |cam_angle: f64| {
        let (saddle, matrix, omega) = at(cam_angle);
        for (multiplier, along) in [saddle.stable, saddle.unstable] {
            assert_relative_eq!(along[0].hypot(along[1] / omega), 1.0, max_relative = 1e-12);
            let off = matrix * along - along * multiplier;
            assert!(off[0].hypot(off[1] / omega) < 1e-6, "at {cam_angle} rad: {off}");
        }
    };
    let angles: Vec<f64> = (0..24).map(|index| f64::from(index) * 0.26).collect();
    angles.iter().for_each(|angle| holds(*angle));
    // What a velocity does to the position a revolution later is 0 on some sections: the multipliers are on the diagonal there.
    let (mut found, row) = (0, |angle: f64| at(angle).1[(0, 1)]);
    for pair in angles.windows(2) {
        let [mut low, mut high] = [pair[0], pair[1]];
        let before = row(low) > 0.0;
        if before == (row(high) > 0.0) {
            continue;
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            *(if (row(middle) > 0.0) == before { &mut low } else { &mut high }) = middle;
        }
        // Across the impact it jumps.
        if row(low).abs() * at(low).2 < 1e-9 {
            holds(low);
            found += 1;
        }
    }
    assert!(found > 0);
}

/// A motion of two revolutions is no fixed point of the map of one.
#[test]
fn only_an_orbit_of_one_revolution_is_a_saddle() {
    // Holmes' ball a flight of n revolutions: a saddle beside each stable one where a omega^2 (1 + r) > n pi g (1 - r).
    let machine = machine(&ball(), 1000.0);
    for (revolutions, saddles) in [(1, 1), (2, 0)] {
        let all = search(&machine, &Search { revolutions, impacts: Some(1) }).unwrap();
        let cycles =
            all.iter().filter_map(|it| if let Course::Impacts(cycle) = &it.course { Some((it, cycle)) } else { None });
        let (mut told, mut grow) = (0, 0);
        for (orbit, cycle) in cycles {
            told += usize::from(Saddle::new(&machine, cycle, 0.0).is_some());
            grow += usize::from(orbit.multipliers().iter().all(|it| it.im == 0.0 && it.re > 0.0) && !orbit.is_stable());
        }
        assert_eq!((told, grow), (saddles, 1), "{revolutions}");
    }
}

/// From the saddle along its direction, each point farther than the one before, in one piece, and no farther than asked for.
#[test]
fn curves_go_away_from_the_saddle() {
    let paper = common::osorio();
    // On this section the directions are of position and velocity alike.
    let map = map(&paper, 678.0, 1.0);
    let (saddle, omega) = (saddle(&map), map.machine.angular_velocity());
    let reversed = Reversed::new(&paper.follower, &map).unwrap();
    let flat =
        |state: State| [state.position - saddle.state.position, (state.velocity - saddle.state.velocity) / omega];
    let extent = Extent { stretches: 5, first: 1e-5, finest: 1e-2, farthest: 1.0 };
    for sign in [1.0, -1.0] {
        let curves = |extent: &Extent| {
            let stable = Curve::stable(&reversed, &saddle, sign, extent);
            [(stable, saddle.stable), (Curve::unstable(&map, &saddle, sign, extent), saddle.unstable)]
        };
        for (curve, (multiplier, along)) in curves(&extent) {
            assert!(along[0].abs() > 0.1 && along[0].abs() < 0.95, "{along}");
            let [piece] = &curve.pieces[..] else { panic!("{curve:?}") };
            let away: Vec<f64> = piece.iter().map(|it| flat(*it)[0].hypot(flat(*it)[1])).collect();
            assert!(away.is_sorted_by(|one, two| one < two), "{away:?}");
            let first = flat(piece[1]);
            // What differences of states of 1 leave of 1e-5.
            assert_abs_diff_eq!(first[0], sign * extent.first * along[0], epsilon = 1e-12);
            assert_abs_diff_eq!(first[1], sign * extent.first * along[1] / omega, epsilon = 1e-12);
            // Almost five times the multiplier, but for how the curve bends.
            let grown = multiplier.max(1.0 / multiplier).powi(5) * extent.first;
            let last = *away.last().unwrap();
            assert!(last < 1.1 * grown && last > 0.5 * grown, "{last} {grown}");
        }
        for (curve, _) in curves(&Extent { farthest: 2e-5, ..extent }) {
            let away = curve.points().map(|it| flat(it)[0].hypot(flat(it)[1]));
            let farthest = away.fold(0.0, f64::max);
            assert!(farthest <= 2e-5 && farthest > 1.5e-5, "{farthest}");
        }
    }
    // A picture twice as large takes what is twice as far and as coarse.
    let [one, two] = [0.3, 0.6].map(Extent::of);
    assert_eq!(two, Extent { first: 2.0 * one.first, finest: 2.0 * one.finest, farthest: 2.0 * one.farthest, ..one });
    assert!(one.first < one.finest && one.finest < 0.3 && one.farthest > 0.3);
}

/// The distance from a line of points a known way apart, of which only those that may be nearer than a limit are looked at.
#[test]
fn the_distance_from_a_curve_is_that_from_its_lines() {
    let paper = common::osorio();
    let map = map(&paper, 678.0, STROBE);
    let extent = Extent { stretches: 1, first: 1e-6, finest: 10.0, farthest: 1.0 };
    let mut curve = Curve::unstable(&map, &saddle(&map), 1.0, &extent);
    let state = |position: f64| State { position, velocity: 0.0 };
    curve.pieces = vec![vec![state(0.0), state(10.0), state(20.0)]];
    let omega = map.machine.angular_velocity();
    for (position, height, distance) in [(5.0, 1.0, 1.0), (-3.0, 4.0, 5.0), (16.0, 2.0, 2.0), (23.0, -4.0, 5.0)] {
        let from = State { position, velocity: height * omega };
        assert_relative_eq!(curve.distance(from), distance, max_relative = 1e-12);
        assert_relative_eq!(curve.distance_below(1.5 * distance, from), distance, max_relative = 1e-12);
        assert_eq!(curve.distance_below(0.5 * distance, from), 0.5 * distance);
    }
}

/// The stable orbits that starts end on, the saddles, and of each saddle a curve to either side.
#[test]
fn what_parts_the_basins_is_told_with_the_orbits() {
    let paper = common::osorio();
    let section = BasinSection::new(&paper, 678.0, STROBE).unwrap();
    let saddle = saddle(&section.map);
    let orbits = search(&section.map.machine, &Search { revolutions: 1, impacts: Some(1) }).unwrap();
    let stable = orbits.iter().filter(|it| it.is_stable());
    let crossing = stable.filter_map(|it| match &it.course {
        Course::Impacts(cycle) => Some(cycle.at_section(&section.map.machine, STROBE).0),
        _ => None,
    });
    let [stable] = crossing.collect::<Vec<_>>()[..] else { panic!("{orbits:?}") };
    // One start, next to the stable orbit; the curves are followed as far as that picture is wide, twice.
    let around = |middle: f64, reach: f64| Some([middle - reach, middle + reach]);
    let grid = section.grid([1, 1], around(stable.position, 1e-3), around(stable.velocity, 1e-2)).unwrap();
    let basins = SectionStarts::Grid(grid).basins(&section.map.machine, Budget::SURVEY, Some(1), &Unwatched).unwrap();
    let found = section.border(&grid, &basins);
    let [told] = found.stable[..] else { panic!("{found:?}") };
    assert_abs_diff_eq!(told.position, stable.position, epsilon = 1e-9);
    assert_abs_diff_eq!(told.velocity, stable.velocity, epsilon = 1e-7);
    assert_eq!(found.saddles, [saddle.state]);
    let sides: Vec<f64> =
        found.curves.iter().map(|it| (it.pieces[0][1].position - saddle.state.position).signum()).collect();
    assert_eq!(sides.iter().sum::<f64>(), 0.0, "{sides:?}");
    assert_eq!(sides.len(), 2);
}

/// A run backwards needs a cam that is its own mirror image all round, to the digits that its numbers have whatever their size.
#[test]
fn a_cam_that_is_its_own_mirror_image_is_told_at_any_size() {
    let follower =
        json!({ "mass": 1, "damping": 0, "stiffness": 0, "gravity": 9.81, "rest_position": 0, "restitution": 0.5 });
    let is_mirrored = |cam: &Value| {
        let model = Model::of_document("cam", &json!({ "follower": follower, "cam": cam })).unwrap();
        Reversed::new(&model.follower, &map(&model, 60.0, 0.0)).is_some()
    };
    let harmonics = |size: f64, off: f64| {
        let amplitudes = [0.2, off].map(|part| part * size);
        json!({ "law": "harmonic", "offset": size, "amplitudes": amplitudes, "phases_deg": [0.0, 90.0] })
    };
    for size in [1e-6, 1.0, 1e3] {
        assert!(is_mirrored(&harmonics(size, 0.0)), "{size}");
        // A second harmonic that is a sine is the opposite of its own image.
        assert!(!is_mirrored(&harmonics(size, 1e-7)), "{size}");
    }
    // Rest at lift 0 up to 60 degrees on either side, and on either side of the nose.
    let program = |spans: [f64; 5]| {
        let [rest, rise, nose, fall, end] = spans;
        let segment = |motion: &str, span: f64, rise: f64| json!({ "motion": motion, "span_deg": span, "rise": rise });
        let all = [
            segment("dwell", rest, 0.0),
            segment("cycloidal", rise, 0.01),
            segment("dwell", nose, 0.0),
            segment("cycloidal", fall, -0.01),
            segment("dwell", end, 0.0),
        ];
        json!({ "law": "program", "base": 0.0, "segment": all })
    };
    assert!(is_mirrored(&program([60.0, 60.0, 120.0, 60.0, 60.0])));
    assert!(!is_mirrored(&program([60.0, 60.0, 80.0, 90.0, 70.0])));
}

/// A flight that never meets the cam, run backwards: found to the digits that its own size has, however large that is and whichever of
/// position and velocity it is of.
#[test]
fn a_run_backwards_is_as_exact_as_its_motion_is_large() {
    let (size, omega) = (1e9, 1e-6_f64);
    for swings in [0.31, 0.43, 0.57, 0.7, 0.83, 0.97, 1.21, 1.37] {
        // So many times a revolution, up to `size` on either side of its rest, above a cam that is lower.
        let stiffness = (swings * omega).powi(2);
        let follower = json!({
            "mass": 1, "damping": 0, "stiffness": stiffness, "gravity": 0, "rest_position": 0, "restitution": 0.5
        });
        let cam = json!({
            "law": "harmonic", "offset": -3.0 * size, "amplitudes": [0.1 * size], "phases_deg": [0.0]
        });
        let model = Model::of_document("floats", &json!({ "follower": follower, "cam": cam })).unwrap();
        let map = map(&model, omega * 60.0 / std::f64::consts::TAU, 0.0);
        let reversed = Reversed::new(&model.follower, &map).unwrap();
        let before = State { position: 0.0, velocity: swings * omega * size };
        let after = map.apply(before).unwrap().state;
        let found = reversed.apply(after).unwrap();
        assert_abs_diff_eq!(found.position, 0.0, epsilon = 1e-12 * size);
        assert_relative_eq!(found.velocity, before.velocity, max_relative = 1e-12);
    }
}

/// How far two states are from each other, m: velocities count over omega.
fn apart(one: State, two: State, omega: f64) -> f64 {
    (one.position - two.position).hypot((one.velocity - two.velocity) / omega)
}

/// A ball on a table has a saddle between the fold and the flip of its orbit. What parts the basins is followed in steps of a thousandth of the
/// picture's height, and twice that height away from the saddle, wherever the picture is.
#[test]
fn curves_are_as_fine_and_as_long_as_the_picture_is_high() {
    let ball = lifted_ball();
    let section = BasinSection::new(&ball, 700.0, 1.0).unwrap();
    let omega = section.map.machine.angular_velocity();
    let saddle = saddle(&section.map).state;
    let height = 0.001;
    let positions = [saddle.position - 0.5 * height, saddle.position + 0.5 * height];
    let grid = Grid { positions, ..section.grid([1, 1], None, None).unwrap() };
    let basins = SectionStarts::Grid(grid).basins(&section.map.machine, Budget::SURVEY, Some(1), &Unwatched).unwrap();
    let found = section.border(&grid, &basins);
    assert_eq!(found.curves.len(), 2);
    let all = found.curves.iter().flat_map(Curve::points);
    let farthest = all.map(|it| apart(it, saddle, omega)).fold(0.0, f64::max);
    let steps = found.curves.iter().flat_map(|it| &it.pieces).flat_map(|piece| piece.windows(2));
    let longest = steps.map(|pair| apart(pair[0], pair[1], omega)).fold(0.0, f64::max);
    assert!(longest <= 1e-3 * height && longest > 0.5e-3 * height, "{longest}");
    assert!(farthest <= 2.0 * height && farthest > 1.9 * height, "{farthest}");
}

/// Where the follower is damped, a run backwards gains what the run forwards lost; and whatever is said to have been a revolution before leads
/// here in flights and impacts, wherever on a section it is looked for.
#[test]
fn what_was_a_revolution_before_leads_here() {
    let text = "[follower]\nmass = 1.0\ndamping = 2.0\nstiffness = 100.0\ngravity = 9.81\nrest_position = 0.0\nrestitution = 0.8\n\
                [cam]\nlaw = \"polynomial\"\n\
                [[cam.segment]]\nstart_deg = 0.0\ncoefficients = [0.01, 0.0, 0.001]\n\
                [[cam.segment]]\nstart_deg = 180.0\ncoefficients = [0.019869604401089358, -0.006283185307179586, 0.001]\n";
    let model = Model::parse("damped.toml", text).unwrap();
    for (rpm, angle) in [(300.0, 0.0), (300.0, 2.0), (500.0, 1.0)] {
        let map = map(&model, rpm, angle);
        let reversed = Reversed::new(&model.follower, &map).unwrap();
        let omega = map.machine.angular_velocity();
        let cam = map.machine.cam().lift(angle);
        let (mut told, mut none) = (0, 0);
        for index in 0..2000 {
            let [row, column] = [f64::from(index / 40), f64::from(index % 40)];
            let state =
                State { position: cam.value + 2e-4 * row, velocity: omega * (cam.slope + 5e-4 * (column - 19.5)) };
            let Some(before) = reversed.apply(state) else {
                none += 1;
                continue;
            };
            told += 1;
            let again = map.apply(before).unwrap();
            assert!(again.events.iter().all(|event| event.kind == EventKind::Impact), "{state:?}");
            assert!(
                apart(again.state, state, omega) < 1e-9 * (before.position.abs() + (before.velocity / omega).abs()),
                "{state:?} {again:?}"
            );
        }
        assert!(told > 1800 && none > 10, "{told} {none}");
    }
}

/// However strongly it is damped, with a spring or without one; and of a cam whose lift is 0 on the way, which is its own mirror image, too.
#[test]
fn a_run_backwards_undoes_one_forwards_whatever_damps_it() {
    for (damping, stiffness) in [(0.0, 0.0), (0.1, 0.0), (2.0, 100.0), (20.0, 100.0), (21.0, 100.0)] {
        let text = format!(
            "[follower]\nmass = 1.0\ndamping = {damping:?}\nstiffness = {stiffness:?}\ngravity = 9.81\nrest_position = 0.0\n\
             restitution = 0.8\n[cam]\nlaw = \"harmonic\"\noffset = 0.0\namplitudes = [0.001]\nphases_deg = [0.0]\n"
        );
        let model = Model::parse("ball.toml", &text).unwrap();
        let map = map(&model, 700.0, 0.0);
        let reversed = Reversed::new(&model.follower, &map).unwrap();
        let cam = map.machine.cam().lift(0.0);
        let states = (0..400).map(|index| {
            let [row, column] = [f64::from(index / 20), f64::from(index % 20)];
            State { position: cam.value + 1e-4 * row, velocity: 0.01 * (column - 9.5) }
        });
        let undone = states.filter_map(|state| map.apply(state).ok().map(|image| (state, image.state)));
        let undone = undone.filter(|(state, image)| {
            let omega = map.machine.angular_velocity();
            reversed.apply(*image).is_some_and(|before| apart(before, *state, omega) < 1e-7)
        });
        let count = undone.count();
        assert!(count > 200, "{damping} {stiffness}: {count}");
    }
}

/// What comes nearest to the stable manifold is on the unstable one, and where it has just come as far away as asked for: both are straight there.
#[test]
fn what_comes_nearest_is_on_the_unstable_manifold() {
    let (ball, away) = (lifted_ball(), 1e-5);
    let extent = Extent { stretches: 20, first: 1e-9, finest: 1e-5, farthest: 4e-3 };
    for angle in [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0] {
        let map = map(&ball, 700.0, angle);
        let (saddle, omega) = (saddle(&map), map.machine.angular_velocity());
        let reversed = Reversed::new(&ball.follower, &map).unwrap();
        for sign in [1.0, -1.0] {
            let stable = Curve::stable(&reversed, &saddle, sign, &extent);
            let unstable = Curve::unstable(&map, &saddle, sign, &extent);
            let found = approach(&map, &saddle, sign, &stable, away, [20, 3]).unwrap();
            assert_relative_eq!(found.distance, stable.distance(found.nearest), max_relative = 1e-9);
            assert!(unstable.distance(found.nearest) < 1e-9, "{angle}: {found:?}");
            let from_saddle = apart(found.nearest, saddle.state, omega);
            assert!((away..=saddle.unstable.0.powi(2) * away).contains(&from_saddle), "{angle}: {found:?}");
        }
    }
}

/// A ball on a table that is above where lifts are 0.
fn lifted_ball() -> Model {
    ball().with_number("cam.offset", 0.01).unwrap()
}

/// A curve is broken where it goes too far away. Between two points on either side of that it is halved sixteen times, so that the last
/// point before it is nearer to the break than a stretch's 2^-16 of a sixteenth. The first stretch is carried by no map: with a multiplier
/// of 2, it is at `first 2^s` after `s` of it.
#[test]
fn a_break_of_a_curve_is_found_by_sixteen_halvings() {
    const POINTS: i32 = 16;
    const HALVINGS: i32 = 16;
    let map = map(&ball(), 700.0, 0.0);
    let along = nalgebra::Vector2::new(1.0, 0.0);
    let saddle = Saddle { state: State { position: 1.0, velocity: 0.0 }, stable: (0.5, along), unstable: (2.0, along) };
    let (width, first, before) = (f64::from(POINTS).recip(), 1e-3, 5);
    let shortest = width * 2.0_f64.powi(-HALVINGS);
    // Right before the point after it all midpoints are on this side of the break, and right behind the point before it none is.
    let places = [f64::from(before + 1) * width - shortest, f64::from(before) * width];
    for (last, within, midpoints) in [(places[0], 0.9, HALVINGS), (places[1], 0.1, 0)] {
        let farthest = first * (last + within * shortest).exp2();
        // As far apart as any two of the points to begin with.
        let extent = Extent { stretches: 1, first, finest: first, farthest };
        let curve = Curve::unstable(&map, &saddle, 1.0, &extent);
        let points: Vec<State> = curve.points().collect();
        assert_eq!(points.len() as i32, 2 + before + midpoints, "{points:?}");
        let reached = points.last().unwrap().position - saddle.state.position;
        assert_abs_diff_eq!((reached / first).log2(), last, epsilon = 1e-11);
    }
}

/// From the cam, which carries it and lets it go, a follower comes to a state that others come to as well, from wherever they begin to be
/// carried: none of these is the one before, and what is told to be it was not carried.
#[test]
fn what_was_carried_by_the_cam_has_no_one_state_before() {
    let ball = ball();
    let (mut seen, mut none) = (0, 0);
    for rpm in (960..1300).step_by(10) {
        for angle in [2.6, 3.2, 3.8] {
            let map = map(&ball, f64::from(rpm), angle);
            let reversed = Reversed::new(&ball.follower, &map).unwrap();
            let cam = map.machine.cam().lift(angle);
            let carried = State { position: cam.value, velocity: map.machine.angular_velocity() * cam.slope };
            let Ok(end) = map.apply(carried) else { continue };
            if end.events.iter().any(|event| event.kind == EventKind::Release) {
                seen += 1;
                let Some(before) = reversed.apply(end.state) else {
                    none += 1;
                    continue;
                };
                let again = map.apply(before).unwrap();
                assert!(again.events.iter().all(|event| event.kind == EventKind::Impact), "{rpm} {angle}: {again:?}");
            }
        }
    }
    assert!(seen > 10 && none > 5, "{seen} {none}");
}
