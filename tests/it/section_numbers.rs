//! Are saddles, their curves, and starts on a section where their equations have them?

use approx::{assert_abs_diff_eq, assert_relative_eq};
use corner_impact::flight::State;
use corner_impact::model::Model;
use corner_impact::orbit::{Course, Search, search};
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::angular_velocity;
use corner_impact::study::StudyError;
use corner_impact::study::attractors::Patience;
use corner_impact::study::basins::boundary::border;
use corner_impact::study::basins::{Curve, Extent, Grid, Reversed, Saddle, Section};

use crate::common;
use crate::global::SECTION as STROBE;
use crate::orbit_numbers::machine;

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
    let section = Section::new(&paper, 700.0, STROBE).unwrap();
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
    for (positions, velocities) in
        [([2.0, 2.0], [-3.0, 4.0]), ([1.0, 2.0], [4.0, 4.0]), ([1.0, f64::INFINITY], [-3.0, 4.0])]
    {
        let none = section.grid([1, 1], Some(positions), Some(velocities));
        assert!(matches!(none, Err(StudyError::NoStarts)), "{none:?}");
    }
    // A cam at rest at its lowest, and a follower with no orbit of one impact: as fast as its height in a radian.
    let slow = Section::new(&paper, 50.0, 0.0).unwrap();
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
    let found = grid.basins(&machine, Patience::default(), Some(1)).unwrap();
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
    assert_eq!(border(&map, line(0.6, 0.6), Patience::default()).unwrap(), None);
    let across = border(&map, line(0.6, 6.0), Patience::default()).unwrap().unwrap();
    assert!(across.position > 0.6 && across.position < 6.0, "{across:?}");
}
