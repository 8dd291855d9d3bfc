//! Are the points of a branch orbits, and its special points where they are said to be, by routes that know nothing of
//! branches: the simulator, bisection on it, and numbers computed elsewhere?

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use crate::common;
use crate::properties::depth;
use corner_impact::cam::Cam;
use corner_impact::model::Model;
use corner_impact::orbit::branch::{Branch, BranchPoint, End, Following, SpecialKind};
use corner_impact::orbit::long_run::{Budget, LongRun};
use corner_impact::orbit::{Course, Eigenvalue, Parameter, PeriodicOrbit, Search, eigenvalues, search};
use corner_impact::progress::Unwatched;
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::{Event, EventKind, Machine, angular_velocity};
use corner_impact::study::continuation::branches;
use corner_impact::study::survey::long_run;

fn machine(model: &Model, rpm: f64) -> Machine {
    Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm))
}

fn orbits(model: &Model, rpm: f64, revolutions: u64) -> Vec<PeriodicOrbit> {
    search(&machine(model, rpm), &Search { revolutions, impacts: None }).unwrap()
}

fn follow(model: &Model, rpm: f64, orbit: &PeriodicOrbit, parameter: &str, range: [f64; 2]) -> Branch {
    let parameter = Parameter::named(model, parameter).unwrap();
    let following = Following { parameter, range, longest_step: 0.03, most_points: 600 };
    Branch::through(model, rpm, orbit, &following).unwrap()
}

/// The branch through the orbit of so many impacts that is stable, or not.
fn branch(model: &Model, rpm: f64, impacts: usize, stable: bool, range: [f64; 2]) -> Branch {
    let orbits = orbits(model, rpm, 1);
    let is_it = |orbit: &&PeriodicOrbit| orbit.impacts().count() == impacts && orbit.is_stable() == stable;
    follow(model, rpm, orbits.iter().find(is_it).unwrap(), "rpm", range)
}

fn specials(branch: &Branch) -> Vec<(f64, SpecialKind)> {
    branch.points.iter().filter_map(|point| Some((point.value, point.special?.kind))).collect()
}

#[track_caller]
fn special<'a>(branch: &'a Branch, name: &str, near: f64) -> &'a BranchPoint {
    let named = branch.points.iter().filter(|point| point.special.is_some_and(|special| special.kind.name() == name));
    let apart = |point: &&BranchPoint| (point.value - near).abs();
    let found = named.min_by(|one, two| apart(one).total_cmp(&apart(two)));
    found.unwrap_or_else(|| panic!("no {name} near {near}: {:?}, {:?}", specials(branch), branch.ends))
}

/// To ten digits.
#[track_caller]
fn is_at(point: &BranchPoint, value: f64) {
    assert!((point.value - value).abs() <= 1e-10 * value, "{:.12} for {value:.12}: {:?}", point.value, point.special);
}

/// Numbers of an independent computation with thirty digits, and of the claims' own bisections of simulated runs.
#[test]
fn the_papers_branch_has_its_corner_and_its_flip() {
    let model = common::osorio();
    for stable in [true, false] {
        let branch = branch(&model, 700.0, 1, stable, [600.0, 760.0]);
        let corner = special(&branch, "corner", 673.0);
        is_at(corner, 673.234445003848821);
        let is_at_p = |kind: SpecialKind| matches!(kind, SpecialKind::Corner { segment: 2, jump_order: 2, .. });
        assert!(corner.special.is_some_and(|special| is_at_p(special.kind)), "{:?}", corner.special);
        is_at(special(&branch, "flip", 739.0), by_bisection([735.0, 739.37], |rpm| flip(&model, rpm) > 0.0));
        assert_eq!(specials(&branch).len(), 2, "{:?}", specials(&branch));
        assert_eq!(branch.ends, [End::Range, End::Range]);
    }
}

/// det(I + A) of the simulated map at the one-impact orbit that runs settle on, or Newton's method finds.
fn flip(model: &Model, rpm: f64) -> f64 {
    let map = StroboscopicMap { machine: machine(model, rpm), cam_angle: 0.0 };
    let stable = orbits(model, 738.0, 1).into_iter().find(|orbit| orbit.is_stable()).unwrap();
    map.periodic(stable.state, 1).unwrap().unwrap().flip()
}

/// Where `holds` turns from true at the lower end to false.
fn by_bisection([mut low, mut high]: [f64; 2], holds: impl Fn(f64) -> bool) -> f64 {
    assert!(holds(low) && !holds(high));
    while high - low > 1e-12 * high {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// An impact that passes angle 0 changes the numbers of all. A line is one impact still: it goes from orbit to orbit without a
/// jump, along every impact of every orbit.
#[test]
fn a_line_is_one_impact() {
    let model = common::osorio();
    let mut passed = 0;
    for orbit in orbits(&model, 320.0, 1) {
        let branch = follow(&model, 320.0, &orbit, "rpm", [310.0, 340.0]);
        let lines = branch.lines();
        for line in &lines {
            let jump = line.points.windows(2).map(|two| (two[1][1] - two[0][1]).abs()).fold(0.0, f64::max);
            assert!(jump < 0.05, "{jump} rad in {line:?}");
        }
        for point in branch.points.iter().filter(|point| point.special.is_none()) {
            let drawn = lines.iter().flat_map(|line| &line.points).filter(|[value, _]| *value == point.value);
            assert!(drawn.count() >= point.orbit.impacts().count(), "{} rpm", point.value);
        }
        passed += usize::from(lines.iter().any(|line| line.points.iter().all(|point| point[1] > 6.0)));
    }
    assert!(passed > 0, "none passes angle 0");
}

/// The number moves the corner itself. The branch turns round there, and what a search finds beside the first orbit is on it
/// too.
#[test]
#[ignore = "slow"]
fn a_corner_that_moves_with_the_number_is_passed() {
    let model = common::osorio();
    let two = |model: &Model| {
        let found = orbits(model, 700.0, 1).into_iter().filter(|orbit| orbit.impacts().count() == 2);
        found.collect::<Vec<_>>()
    };
    let branch = follow(&model, 700.0, &two(&model)[0], "nose_end_deg", [90.0, 170.0]);
    let corner = special(&branch, "corner", 93.36);
    is_at(corner, 93.358406931957);
    let nearby = model.with_number("cam.nose_end_deg", 100.0).unwrap();
    let found = two(&nearby);
    let on_it = found.iter().filter(|orbit| branch.holds(100.0, orbit)).count();
    assert_eq!((found.len(), on_it), (2, 2), "{:?}", specials(&branch));
}

/// Where the simulated map has a multiplier 1 at an orbit of two impacts: Newton's method on the map finds it on one side.
#[test]
fn the_papers_two_impact_orbits_fold() {
    let model = common::osorio();
    let branch = branch(&model, 742.0, 2, false, [700.0, 760.0]);
    let fold = special(&branch, "fold", 743.0);
    let of_map = |rpm: f64| {
        let guess = branch.points.iter().filter(|point| point.orbit.impacts().count() == 2 && point.value <= rpm);
        let guess = guess.max_by(|one, two| one.value.total_cmp(&two.value)).unwrap().orbit.state;
        let map = StroboscopicMap { machine: machine(&model, rpm), cam_angle: 0.0 };
        map.periodic(guess, 1).unwrap()
    };
    let size =
        |rpm: f64| of_map(rpm).map(|orbit| orbit.matrix).map(|matrix| 1.0 - matrix.trace() + matrix.determinant());
    // 1 - trace + determinant falls as the root of the distance: its square is a straight line, to 0 at the fold.
    let [one, two] = [1e-3, 2e-3].map(|below| (fold.value - below, size(fold.value - below).unwrap().powi(2)));
    let zero = one.0 + one.1 * (one.0 - two.0) / (two.1 - one.1);
    assert!((zero - fold.value).abs() < 1e-5, "{zero} for {}", fold.value);
    // Beyond there is none nearby.
    let beyond = of_map(fold.value + 1e-6).map(|found| found.state.velocity - fold.orbit.state.velocity);
    assert!(beyond.is_none_or(|apart| apart.abs() > 0.1), "{beyond:?}");
    is_at(fold, 743.0832246629);
    assert!(fold.orbit.multipliers().iter().any(|one| (one.re - 1.0).abs() < 1e-6));
}

/// A branch of two revolutions ends where it came from: at the flip of the orbit of one, or at its graze.
#[test]
fn a_branch_of_two_revolutions_ends_on_the_orbit_of_one() {
    let model = common::osorio();
    let stable = orbits(&model, 739.35, 2).into_iter().find(PeriodicOrbit::is_stable).unwrap();
    let flips = follow(&model, 739.35, &stable, "rpm", [700.0, 760.0]);
    assert_eq!(flips.ends.iter().filter(|end| **end == End::Shorter).count(), 1, "{:?}", flips.ends);
    let flip = special(&flips, "flip", 739.0);
    is_at(flip, by_bisection([735.0, 739.37], |rpm| self::flip(&model, rpm) > 0.0));
    assert_eq!((flip.orbit.revolutions, flip.orbit.impacts().count()), (1, 1));
    let first_or_last = [&flips.points[0], &flips.points[flips.points.len() - 1]];
    assert!(first_or_last.contains(&flip));

    let three = orbits(&model, 760.0, 2).into_iter().find(|orbit| orbit.impacts().count() == 3).unwrap();
    let grazes = follow(&model, 760.0, &three, "rpm", [700.0, 850.0]);
    assert!(grazes.ends.contains(&End::Shorter), "{:?}", grazes.ends);
    let graze = special(&grazes, "graze", 786.7);
    assert_eq!((graze.orbit.revolutions, graze.orbit.impacts().count()), (1, 1));
    let map = StroboscopicMap { machine: machine(&model, graze.rpm), cam_angle: 0.0 };
    assert!(least_clearance(&map, &graze.orbit) < 1e-8);
}

/// The follower that sticks: where it first leaves the cam, and where it no longer comes to rest.
#[test]
fn the_papers_sticking_branch_ends_in_detachment_and_chattering() {
    let model = common::osorio();
    let orbits = orbits(&model, 150.0, 1);
    let sticking = orbits.iter().find(|orbit| matches!(orbit.course, Course::Sticking(_))).unwrap();
    let branch = follow(&model, 150.0, sticking, "rpm", [100.0, 250.0]);
    is_at(special(&branch, "detachment", 115.0), 114.979326743998);
    let sticks = |rpm: f64| {
        let mut sticks = 0;
        let machine = machine(&model, rpm);
        let mut motion = machine.start_on_cam(0.0, 0.0).unwrap();
        let goal = motion.after(3);
        let _ = machine.advance(&mut motion, goal, &mut |event: &Event| {
            sticks += u32::from(event.kind == EventKind::Stick);
            ControlFlow::Continue(())
        });
        sticks > 0
    };
    let chatter = special(&branch, "chatter", 198.0);
    is_at(chatter, by_bisection([190.0, 199.0], sticks));
    assert!((chatter.value - 198.5605).abs() < 1e-4);
    assert_eq!(branch.ends, [End::Range, End::Chatter]);
}

/// Either side of a graze Newton's method on the simulated map finds an orbit with another number of impacts.
#[test]
fn grazes_are_where_the_number_of_impacts_changes() {
    let model = common::osorio();
    let mut seen = Vec::new();
    for orbit in orbits(&model, 442.0, 1) {
        let branch = follow(&model, 442.0, &orbit, "rpm", [400.0, 480.0]);
        for (index, point) in branch.points.iter().enumerate() {
            let Some(SpecialKind::Graze { before, after, .. }) = point.special.map(|special| special.kind) else {
                continue;
            };
            seen.push(point.value);
            let near = [&branch.points[index - 1], &branch.points[index + 1]].map(simulated_impacts(&model));
            let mut expected = [before, after];
            if near[0] != expected[0] {
                expected.reverse();
            }
            assert_eq!(near, expected, "{point:?}");
            assert_eq!(before.abs_diff(after), 1);
            let map = StroboscopicMap { machine: machine(&model, point.rpm), cam_angle: 0.0 };
            assert!(least_clearance(&map, &point.orbit) < 1e-8, "{point:?}");
        }
    }
    assert!(seen.iter().any(|rpm| (rpm - 442.42226742495).abs() < 1e-9), "{seen:?}");
}

/// Impacts in one period of the simulated motion from a point's state.
fn simulated_impacts(model: &Model) -> impl Fn(&BranchPoint) -> usize + '_ {
    |point| {
        let map = StroboscopicMap { machine: machine(model, point.rpm), cam_angle: 0.0 };
        map.apply(point.orbit.state).unwrap().impacts().count()
    }
}

/// The least gap of simulated flights away from the impacts, or the least speed of an impact over omega: m.
fn least_clearance(map: &StroboscopicMap, orbit: &PeriodicOrbit) -> f64 {
    let machine = &map.machine;
    let slowest = orbit.impacts().map(|event| event.cam_velocity - event.velocity_before).fold(f64::INFINITY, f64::min);
    let motion = machine.start(0.0, orbit.state).unwrap();
    let (samples, events) = corner_impact::section::trace(machine, motion, 1, 20_000).unwrap();
    // Where the run takes the touch for an impact, it would have dipped so deep below the cam.
    let impacts = events.iter().filter(|event| event.kind == EventKind::Impact);
    let touches = impacts.map(|event| depth(machine, event));
    let mut least = touches.fold(slowest / machine.angular_velocity(), f64::min);
    for window in samples.windows(3) {
        let is_least = window[1].gap < window[0].gap && window[1].gap < window[2].gap;
        let at_impact = events.iter().any(|event| (event.turned_since(0.0) - window[1].turned).abs() < 1e-3);
        if is_least && !at_impact {
            // The bottom of the parabola through three samples.
            let [before, here, after] = [window[0].gap, window[1].gap, window[2].gap];
            let (slope, bend) = (0.5 * (after - before), after + before - 2.0 * here);
            least = least.min((here - 0.5 * slope * slope / bend).abs());
        }
    }
    least
}

fn models() -> Vec<(PathBuf, f64, &'static str, [f64; 2])> {
    let file = |name: &str| Path::new(common::ROOT).join("models").join(name);
    vec![
        (file("osorio-2008.toml"), 700.0, "rpm", [600.0, 800.0]),
        (file("osorio-2008.toml"), 442.0, "rpm", [400.0, 480.0]),
        (file("osorio-2008.toml"), 700.0, "restitution", [0.0, 1.0]),
        (file("osorio-2008.toml"), 700.0, "stiffness", [800.0, 2000.0]),
        (file("osorio-2008.toml"), 700.0, "nose_radius", [0.1, 0.25]),
        (file("osorio-2008.toml"), 700.0, "flank_start_deg", [70.0, 110.0]),
        (file("laws/harmonic.toml"), 500.0, "rpm", [400.0, 700.0]),
        (file("laws/polynomial.toml"), 800.0, "rpm", [500.0, 1000.0]),
        (file("laws/program.toml"), 2900.0, "rpm", [2000.0, 4000.0]),
        (file("laws/rectified-sine.toml"), 25.0, "rpm", [12.0, 50.0]),
        (file("laws/table-cubic.toml"), 850.0, "rpm", [600.0, 900.0]),
    ]
}

fn of_parameter(model: &Model, point: &BranchPoint, parameter: &str) -> Model {
    if parameter == "rpm" {
        return model.clone();
    }
    let Parameter::Field(path) = Parameter::named(model, parameter).unwrap() else { panic!("{parameter}") };
    model.with_number(&path, point.value).unwrap()
}

/// The turn of the shortest hop, at most 1 rad: the speed of a hop is known to the rounding of the lift over it.
fn shortest_turn(orbit: &PeriodicOrbit) -> f64 {
    let angles: Vec<f64> = orbit.impacts().map(|event| event.turned_since(0.0)).collect();
    angles.windows(2).map(|pair| pair[1] - pair[0]).fold(1.0, f64::min)
}

/// One simulated period leads back to the state, with the multipliers that are given.
fn is_an_orbit(model: &Model, point: &BranchPoint) {
    let map = StroboscopicMap { machine: machine(model, point.rpm), cam_angle: 0.0 };
    let (state, omega) = (point.orbit.state, map.machine.angular_velocity());
    let (end, matrix) = map.carry(state, point.orbit.revolutions).unwrap();
    let size = state.position.hypot(state.velocity / omega).max(0.01);
    let missed = (end.position - state.position).hypot((end.velocity - state.velocity) / omega);
    let [one, two] = eigenvalues(&matrix);
    // What rounding of the state grows by on the way.
    let growth = 1.0 + one.modulus().max(two.modulus());
    let rounding = 16.0 * f64::EPSILON * growth / shortest_turn(&point.orbit) * size;
    assert!(missed <= 1e-10 * size + rounding, "{missed:e} of {size}: {point:?}");
    // The saltation matrix of a slow impact moves with its speed.
    let approach = |event: &Event| event.cam_velocity - event.velocity_before;
    let slowest = point.orbit.impacts().map(approach).fold(f64::INFINITY, f64::min);
    let allowed = (1e-8 + rounding * omega / slowest) * growth;
    let apart = |one: &Eigenvalue, two: &Eigenvalue| (one.re - two.re).hypot(one.im - two.im);
    for (given, simulated) in point.orbit.multipliers().iter().zip([one, two]) {
        // Near a double one they have half the digits.
        assert!(apart(given, &simulated) <= allowed || (apart(&one, &two) < 1e-4), "{given:?} {simulated:?} {point:?}");
    }
    let Course::Impacts(cycle) = &point.orbit.course else { return };
    let (given, simulated) = (cycle.determinant(&map.machine), matrix.determinant());
    assert!((given - simulated).abs() <= allowed * matrix.norm(), "{given} {simulated} {point:?}");
}

/// At a special point rounding decides which of two motions the simulator sees.
fn is_ordinary(branch: &Branch, index: usize) -> bool {
    branch.points[index].special.is_none()
}

#[test]
#[ignore = "slow"]
fn every_point_of_a_branch_is_an_orbit_of_the_simulator() {
    let mut seen = 0;
    for (file, rpm, parameter, range) in models() {
        let model = common::read(&file);
        for orbit in orbits(&model, rpm, 1).iter().filter(|orbit| matches!(orbit.course, Course::Impacts(_))) {
            let branch = follow(&model, rpm, orbit, parameter, range);
            assert!(branch.points.len() > 5, "{file:?} {parameter}: {:?}", branch.ends);
            for index in (0..branch.points.len()).filter(|index| is_ordinary(&branch, *index)) {
                let point = &branch.points[index];
                is_an_orbit(&of_parameter(&model, point, parameter), point);
                seen += 1;
            }
            for (index, point) in branch.points.iter().enumerate() {
                let Some(special) = point.special else { continue };
                let [low, high] = special.bracket;
                // Hops of less than 1.4e-5 rad, at the end of a chattering sequence, leave no nine digits.
                let known = (64.0 * f64::EPSILON / shortest_turn(&point.orbit)).max(1e-9);
                assert!(low <= high && high - low <= known * point.value.abs(), "{file:?} {special:?}");
                assert!(low <= point.value && point.value <= high, "{index} {point:?}");
                assert!(special.residual <= 1e-7, "{file:?} {special:?}");
            }
        }
    }
    assert!(seen > 1000, "{seen}");
}

/// Two walks along a branch stop at other points on their way to a special point, and round otherwise there.
#[test]
#[ignore = "slow"]
fn the_bracket_of_a_special_point_holds_it_from_wherever_it_is_reached() {
    let (mut met, mut apart) = (0, Vec::new());
    for (file, rpm, parameter, range) in models() {
        let model = common::read(&file);
        for orbit in orbits(&model, rpm, 1).iter().filter(|orbit| matches!(orbit.course, Course::Impacts(_))) {
            let branch = follow(&model, rpm, orbit, parameter, range);
            let from = &branch.points[branch.points.len() / 3];
            if from.special.is_some() {
                continue;
            }
            let again = follow(&of_parameter(&model, from, parameter), from.rpm, &from.orbit, parameter, range);
            for point in &branch.points {
                let Some(one) = point.special else { continue };
                let brackets = again.points.iter().filter_map(|point| point.special);
                let near = brackets.filter(|two| {
                    two.kind.name() == one.kind.name()
                        && (two.bracket[0] - point.value).abs() <= 1e-6 * point.value.abs()
                });
                let gap = |two: [f64; 2]| (two[0] - one.bracket[1]).max(one.bracket[0] - two[1]);
                let Some(gap) = near.map(|two| gap(two.bracket)).min_by(f64::total_cmp) else { continue };
                met += 1;
                if gap > 8.0 * f64::EPSILON * point.value.abs() {
                    apart.push(format!("{} {parameter} {gap:e} {one:?}", file.display()));
                }
            }
        }
    }
    assert!(apart.is_empty(), "{} of {met}:\n{}", apart.len(), apart.join("\n"));
    assert!(met > 40, "{met}");
}

/// What runs settle on at a speed: an orbit of so many revolutions.
fn settled_orbit(model: &Model, rpm: f64, revolutions: u64) -> PeriodicOrbit {
    let machine = machine(model, rpm);
    let start = machine.start_on_cam(0.0, 0.0).unwrap();
    let budget = Budget { transient: 3000, record: 1600, longest: revolutions, patience: 0 };
    let LongRun::Orbit(orbit) = long_run(&machine, start, budget).unwrap().ending else { panic!("{rpm}") };
    assert_eq!(orbit.revolutions, revolutions);
    orbit
}

/// At the flip of the paper's orbit, and where the corner impact of another model sheds orbits of two and of four revolutions:
/// runs settle on what branches off.
#[test]
fn what_branches_off_with_twice_the_period_is_followed() {
    let flip = Path::new(common::ROOT).join("models/nonsmooth-flip.toml");
    for (model, from, range, doublings, settles, at) in [
        (common::osorio(), 700.0, [660.0, 750.0], 1, 739.36, 739.319_780_216_001_6),
        (common::read(&flip), 890.0, [840.0, 950.0], 2, 878.5, 877.655_930_381_899),
    ] {
        let wanted = Search { revolutions: 1, impacts: None };
        let following = Following { parameter: Parameter::Speed, range, longest_step: 0.02, most_points: 600 };
        let found = branches(&model, from, &wanted, following, doublings, &Unwatched).unwrap().branches;
        let revolutions = 1 << doublings;
        let orbit = settled_orbit(&model, settles, revolutions);
        let branch = found.iter().find(|branch| branch.holds(settles, &orbit));
        let branch = branch.unwrap_or_else(|| panic!("{}: {} branches", model.name, found.len()));
        let begins = [0, branch.points.len() - 1].map(|end| branch.points[end].value);
        assert!(begins.iter().any(|value| (value - at).abs() < 1e-9 * at), "{begins:?}");
        let longer =
            found.iter().filter(|branch| branch.points.iter().any(|point| point.orbit.revolutions == revolutions));
        for (branch, index) in longer.flat_map(|branch| (0..branch.points.len()).map(move |index| (branch, index))) {
            if is_ordinary(branch, index) {
                is_an_orbit(&model, &branch.points[index]);
            }
        }
        // Each branch once: what one holds in its middle no other does.
        for (index, branch) in found.iter().enumerate() {
            let middle = &branch.points[branch.points.len() / 2];
            let others = found.iter().enumerate().filter(|(other, _)| *other != index);
            assert!(!others.into_iter().any(|(_, other)| other.holds(middle.value, &middle.orbit)), "{}", model.name);
        }
    }
}

/// From an orbit at the other end of a branch, the same special points.
#[test]
fn a_branch_is_the_same_from_both_ends() {
    let model = common::osorio();
    let there = branch(&model, 700.0, 1, true, [600.0, 760.0]);
    for index in [0, there.points.len() / 3, there.points.len() - 1] {
        let from = &there.points[index];
        let back = follow(&model, from.rpm, &from.orbit, "rpm", [600.0, 760.0]);
        let (mut one, mut two) = (specials(&there), specials(&back));
        one.sort_by(|a, b| a.0.total_cmp(&b.0));
        two.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(one.len(), two.len(), "{one:?} {two:?}");
        for (one, two) in one.iter().zip(&two) {
            assert!((one.0 - two.0).abs() < 1e-9 && one.1.name() == two.1.name(), "{one:?} {two:?}");
        }
    }
}

/// Where the cam's velocity jumps the orbit has no continuation: it ends there, and says so.
#[test]
fn a_jump_of_the_cams_velocity_is_a_gap() {
    let file = Path::new(common::ROOT).join("models/laws/rectified-sine.toml");
    let model = common::read(&file);
    let mut gaps = 0;
    for orbit in orbits(&model, 25.0, 1).iter().filter(|orbit| orbit.impacts().count() > 0) {
        let branch = follow(&model, 25.0, orbit, "rpm", [12.0, 50.0]);
        for (end, point) in branch.ends.iter().zip([&branch.points[0], branch.points.last().unwrap()]) {
            if *end == End::Gap {
                gaps += 1;
                let special = point.special.unwrap();
                assert!(matches!(special.kind, SpecialKind::Corner { jump_order: 1, .. }), "{special:?}");
                let corner = point.orbit.impacts().map(|event| event.cam_angle % std::f64::consts::PI);
                assert!(
                    corner.fold(f64::INFINITY, |least, angle| least.min(angle.min(std::f64::consts::PI - angle)))
                        < 1e-9
                );
            }
        }
    }
    assert!(gaps > 0);
}

/// Each graze adds an impact, closer to the one before: the follower begins to chatter, which is what is said.
#[test]
#[ignore = "slow"]
fn a_cascade_of_grazes_ends_in_chattering() {
    for (file, rpm, range) in [("harmonic", 500.0, [350.0, 700.0]), ("polynomial", 800.0, [400.0, 1000.0])] {
        let model = common::read(&Path::new(common::ROOT).join(format!("models/laws/{file}.toml")));
        for orbit in orbits(&model, rpm, 1) {
            let parameter = Parameter::Speed;
            let following = Following { parameter, range, longest_step: 0.05, most_points: 2000 };
            let branch = Branch::through(&model, rpm, &orbit, &following).unwrap();
            assert!(branch.ends.contains(&End::Chatter), "{file}: {:?} {:?}", branch.ends, specials(&branch));
            let grazes: Vec<f64> =
                specials(&branch).iter().filter(|(_, kind)| kind.name() == "graze").map(|(value, _)| *value).collect();
            assert!(grazes.len() > 10, "{grazes:?}");
        }
    }
}
