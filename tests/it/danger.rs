//! Is a border collision called dangerous where its basin shrinks to nothing, and nowhere else?

use crate::common;
use approx::assert_relative_eq;
use corner_impact::border_collision::danger::{Danger, DangerKind, Returns};
use corner_impact::border_collision::directions::Homogeneous;
use corner_impact::border_collision::feigin::{Scenario, Speeds};
use corner_impact::border_collision::{LocalMap, LocalOutcome, classify};
use corner_impact::corner::map::CornerMap;
use corner_impact::corner::{self, CornerImpact, SideMap, variational};
use corner_impact::interval::Interval;
use corner_impact::known::Evidence;
use corner_impact::model::{Model, Study};
use corner_impact::progress::Unwatched;
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::Machine;
use corner_impact::study::attractors::{Resolution, Step};
use corner_impact::study::locate::locate;
use corner_impact::study::verify::{External, verify};
use corner_impact_cli::show::Paged;
use nalgebra::{Matrix2, Vector2};

/// A follower without spring or damping on a cam of three polynomials, whose corner impact at 60 rpm has the traces -0.3 and -1.7 and the
/// determinant 0.9025 on both sides.
fn machine() -> Model {
    Model::parse("dangerous.toml", include_str!("../../crates/explore/src/page/dangerous.toml")).unwrap()
}

/// A period, s, of which a change by one second is a change by one rpm.
const PERIOD: f64 = 7.745_966_692_414_834;

fn danger(map: &LocalMap) -> Option<Danger> {
    map.danger(&map.outcomes(), PERIOD)
}

fn normal_form([l, r, d_l, d_r]: [f64; 4]) -> LocalMap {
    common::normal_form([l, r], [d_l, d_r])
}

/// The same map in other coordinates, with the sides exchanged.
fn turned(map: &LocalMap) -> LocalMap {
    let m = Matrix2::new(0.7, -40.0, 0.009, 1.6);
    let inverse = m.try_inverse().unwrap();
    let side = |side: SideMap| SideMap { a: inverse * side.a * m, b: inverse * side.b };
    let (e, f) = map.border;
    LocalMap { minus: side(map.plus), plus: side(map.minus), border: (-(e * m), -f) }
}

/// The size of a motion at mu = 0 after `steps`, the largest and the least over starts all round, as logarithms.
fn grown(map: &LocalMap, steps: u32) -> [f64; 2] {
    let one = |index: u32| {
        let angle = (f64::from(index) + 0.5) * std::f64::consts::TAU / 64.0;
        let (mut x, mut grown) = (Vector2::new(angle.cos(), angle.sin()), 0.0);
        for _ in 0..steps {
            x = if (map.border.0 * x)[0] < 0.0 { map.minus.a * x } else { map.plus.a * x };
            grown += x.norm().ln();
            x /= x.norm();
        }
        grown
    };
    (0..64).map(one).fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], it| [it.min(least), it.max(most)])
}

/// Both fixed points are stable. Whether motions diverge at mu = 0 is seen in long runs here.
#[test]
#[ignore = "slow"]
fn what_diverges_at_the_corner_impact_is_dangerous() {
    for [l, r, d_l, d_r] in [
        // Of the machine below.
        [-0.3, -1.7, 0.9025, 0.9025],
        [-1.79, 1.29, 0.96, 0.97],
        [-1.58, -0.44, 0.76, 0.84],
        [-1.25, 1.49, 0.84, 0.93],
        [-0.23, -1.55, 0.92, 0.8],
        [-1.47, 0.68, 0.92, 0.76],
    ] {
        let map = normal_form([l, r, d_l, d_r]);
        assert!(grown(&map, 400)[0] > 5.0);
        // The bound depends on the coordinates, and is not as close in oblique ones.
        for (map, least) in [(map, 0.98), (turned(&map), 0.5)] {
            let found = danger(&map).unwrap();
            assert_eq!(found.kind, DangerKind::Dangerous, "{l} {r}: {found:?}");
            let divergence = found.divergence.as_ref().unwrap();
            // In oblique coordinates no sector may be left that is certain: then the directions are sampled.
            let is_plain = least > 0.9;
            assert!(!is_plain || found.known == Evidence::Computed, "{l} {r}: {found:?}");
            // Along isolated rays motions may shrink.
            let is_all = divergence.share == 1.0 && divergence.known == Evidence::Sampled;
            assert!(is_all || divergence.share > least && divergence.share < 1.0, "{l} {r}: {divergence:?}");
            for speeds in [Speeds::Faster, Speeds::Slower] {
                assert!(found.at(speeds).any(|attractor| attractor.end.fixed_on().is_some()), "{l} {r}: {found:?}");
            }
            let kind = classify(&CornerMap { minus: map.minus, plus: map.plus }, map.border).unwrap();
            assert_eq!(kind.scenario, Scenario::Persistence);
        }
    }
}

#[test]
#[ignore = "slow"]
fn what_shrinks_at_the_corner_impact_is_not_dangerous() {
    for case in [
        [-1.17, 1.75, 0.65, 0.95],
        [-0.05, 1.43, 0.81, 0.49],
        [0.5, -0.5, 0.2, 0.3],
        [0.55, 0.56, -0.3, 0.02],
        [-0.13, 0.35, -0.13, 0.33],
        // A fold, a flip, and a fixed point that is stable on one side alone.
        [1.5, 0.5, 0.2, 0.3],
        [0.5, -1.5, 0.2, 0.3],
        [0.5, 1.9, 0.2, 1.2],
    ] {
        for map in [normal_form(case), turned(&normal_form(case))] {
            // Several attractors may meet there all the same.
            let found = danger(&map);
            let is_dangerous = found.as_ref().is_some_and(|danger| danger.divergence.is_some());
            assert!(!is_dangerous && found.is_none_or(|it| it.kind == DangerKind::MultipleAttractors), "{case:?}");
        }
    }
}

/// Attractors by solving for orbits in Python, of six steps or fewer.
#[test]
#[ignore = "slow"]
fn attractors_that_meet_at_the_corner_impact_are_told() {
    for (case, mu, words) in [
        ([0.19, -1.28, 0.64, 0.87], 1.0, ["R", "LLR"]),
        ([-1.16, -0.27, 0.82, 0.85], -1.0, ["L", "LRR"]),
        ([-0.19, -1.83, 0.52, 0.45], 1.0, ["LR", "LLR"]),
    ] {
        let found = danger(&normal_form(case)).unwrap();
        assert_eq!((found.kind, found.known), (DangerKind::MultipleAttractors, Evidence::Computed), "{case:?}");
        assert!(found.divergence.is_none(), "{found:?}");
        let at = found.at(Speeds::of(mu).unwrap());
        let seen: Vec<String> = at.filter_map(|attractor| Some(attractor.word()?.to_string())).collect();
        assert_eq!(seen, words, "{case:?}");
        // Each basin is bounded by the other.
        assert!(found.at(Speeds::of(mu).unwrap()).all(|attractor| attractor.returns.unwrap().any.is_some()));
    }
}

fn homogeneous(minus: Matrix2<f64>, plus: Matrix2<f64>, width: f64) -> Homogeneous {
    let around = |entry: f64| Interval::new(entry - width, entry + width);
    let rows = |a: Matrix2<f64>| [0, 1].map(|row| [0, 1].map(|column| around(a[(row, column)])));
    Homogeneous::new([rows(minus), rows(plus)], [1.0, 0.0].map(around), Vector2::new(1.0, 1.0))
}

/// Turned by an angle and stretched: every motion grows by the factor at each step, whatever its direction.
#[test]
fn a_direction_diverges_only_where_that_is_certain() {
    for (stretch, share) in [(1.02, 1.0), (1.0, 0.0), (0.98, 0.0)] {
        let turn = Matrix2::new(0.6, -0.8, 0.8, 0.6) * stretch;
        assert_eq!(homogeneous(turn, turn, 0.0).diverging(true), share, "{stretch}");
        // The same with the sense of turning reversed by each step.
        let flipped = turn * Matrix2::new(1.0, 0.0, 0.0, -1.0);
        assert_eq!(homogeneous(flipped, flipped, 0.0).diverging(true), share, "{stretch}");
    }
    // All that starts where x < 0 diverges along x; the rest, and the border itself, does not.
    let [minus, plus] = [1.5, 0.5].map(|slope| Matrix2::new(slope, 0.0, 0.0, 0.4));
    let share = homogeneous(minus, plus, 0.0).diverging(true);
    assert!(share > 0.49 && share < 0.5, "{share}");
    let share = homogeneous(plus, minus, 0.0).diverging(false);
    assert!(share > 0.49 && share < 0.5, "{share}");
    // A matrix without rank sends directions nowhere.
    let none = Matrix2::new(2.0, 0.0, 0.0, 0.0);
    assert_eq!(homogeneous(none, none, 0.0).diverging(true), 0.0);
    // For all matrices in intervals, as long as these are narrow.
    let map = normal_form([-0.3, -1.7, 0.9025, 0.9025]);
    let [narrow, wide] = [1e-6, 0.2].map(|width| homogeneous(map.minus.a, map.plus.a, width).diverging(true));
    assert!(narrow > 0.99 && wide == 0.0, "{narrow} {wide}");
}

#[test]
fn a_danger_is_proved_where_all_of_it_is() {
    let computed = danger(&normal_form([-0.3, -1.7, 0.9025, 0.9025])).unwrap();
    let with = |share, is_attracting| {
        let mut danger = computed.clone();
        danger.prove(share, is_attracting);
        (danger.known, danger.divergence.unwrap().known)
    };
    assert_eq!(with(1.0, true), (Evidence::Proved, Evidence::Proved));
    assert_eq!(with(1.0, false), (Evidence::Computed, Evidence::Proved));
    assert_eq!(with(0.0, true), (Evidence::Computed, Evidence::Computed));
    // Beside a stable orbit of several steps that no certificate has.
    let mut both = computed.clone();
    let several = danger(&normal_form([0.19, -1.28, 0.64, 0.87])).unwrap();
    both.attractors.extend(several.at(Speeds::Slower).filter(|attractor| attractor.end.fixed_on().is_none()).cloned());
    both.prove(1.0, true);
    assert_eq!(both.known, Evidence::Computed);
}

/// Whether a motion comes back to the fixed point of its side.
fn comes_back(map: &LocalMap, at: Vector2<f64>, off: Vector2<f64>, mu: f64) -> bool {
    let mut x = at + off;
    for _ in 0..4000 {
        x = map.apply(x, mu);
    }
    (x - at).norm() < 1e-6
}

#[test]
fn a_disturbance_returns_up_to_the_edge_that_is_told() {
    let map = normal_form([-0.3, -1.7, 0.9025, 0.9025]);
    let found = danger(&map).unwrap();
    let omega = std::f64::consts::TAU / PERIOD;
    for (speeds, mu) in [(Speeds::Faster, -1.0), (Speeds::Slower, 1.0)] {
        let attractor = found.at(speeds).next().unwrap();
        let side = map.of(attractor.end.fixed_on().unwrap());
        let at = (Matrix2::identity() - side.a).try_inverse().unwrap() * side.b * mu;
        let Returns { position, velocity, any } = attractor.returns.unwrap();
        let [position, velocity, any] = [position, velocity, any].map(Option::unwrap);
        for (edge, axis) in [(position, Vector2::x()), (velocity, Vector2::y())] {
            let returns = |size: f64| [1.0, -1.0].map(|sign| comes_back(&map, at, axis * (sign * size), mu));
            assert_eq!(returns(0.999 * edge), [true, true], "{speeds} {edge}");
            assert!(returns(1.001 * edge).contains(&false), "{speeds} {edge}");
        }
        assert!(any <= position && any <= velocity / omega, "{any} {position} {velocity}");
        let around = |size: f64| {
            (0..16).all(|index| {
                let angle = std::f64::consts::TAU * f64::from(index) / 16.0;
                comes_back(&map, at, Vector2::new(angle.cos(), omega * angle.sin()) * size, mu)
            })
        };
        assert!(around(0.999 * any) && !around(1.001 * any), "{any}");
        // Half the period: a quarter of it for each rpm, and velocities count half as much.
        let other = map.danger(&map.outcomes(), 0.5 * PERIOD).unwrap();
        let returns = other.at(speeds).next().unwrap().returns.unwrap();
        assert_relative_eq!(returns.velocity.unwrap(), 0.25 * velocity, max_relative = 1e-12);
    }
}

fn local(model: &Model) -> Option<(LocalMap, CornerImpact)> {
    let cam = common::cam(model);
    let (at, _) = corner::locate(model, &cam).ok()?;
    let map = variational::route(model, &cam, &at).map;
    let border = variational::border(model, &cam, &at);
    classify(&map, border).ok()?;
    Some((LocalMap::new(&map, border), at))
}

/// The follower is simulated on its cam, next to its periodic orbit. The local map leaves out what is of second order: its edge is off by
/// parts that fall with the distance from omega*.
#[test]
fn the_follower_regains_what_the_local_map_says() {
    let model = machine();
    let (map, at) = local(&model).unwrap();
    let found = map.danger(&map.outcomes(), at.period).unwrap();
    assert_relative_eq!(at.speed_rpm(), 60.0, max_relative = 1e-9);
    for (rpm, within) in [(59.9, 0.1), (59.99, 0.01), (59.999, 0.002), (60.1, 0.1), (60.01, 0.01), (60.001, 0.002)] {
        let distance = f64::abs(rpm - 60.0);
        let speeds = if rpm < 60.0 { Speeds::Slower } else { Speeds::Faster };
        let machine =
            Machine::new(common::cam(&model), &model.follower, corner_impact::simulate::angular_velocity(rpm));
        let section = StroboscopicMap { machine, cam_angle: at.section_angle() };
        let orbit = section.periodic(at.state, 1).unwrap().unwrap().state;
        let attractor = found.at(speeds).next().unwrap();
        let edge = attractor.returns.unwrap().velocity.unwrap() * distance;
        let returns = |velocity: f64| {
            let mut state = orbit;
            state.velocity += velocity;
            for _ in 0..300 {
                state = section.apply(state).unwrap().state;
            }
            (state.velocity - orbit.velocity).abs() < 1e-3 * edge
        };
        let both = |size: f64| [size, -size].map(returns);
        assert_eq!(both((1.0 - within) * edge), [true, true], "{rpm} {edge}");
        assert!(both((1.0 + within) * edge).contains(&false), "{rpm} {edge}");
    }
}

#[test]
fn no_model_of_the_project_is_called_dangerous() {
    let mut seen = 0;
    for file in common::model_files() {
        if let Some((map, at)) = local(&common::read(&file)) {
            let found = map.danger(&map.outcomes(), at.period);
            assert_eq!(found.map(|danger| danger.kind), None, "{}", file.display());
            seen += 1;
        }
    }
    assert!(seen > 4, "{seen}");
}

#[test]
#[ignore = "slow"]
fn every_command_tells_of_the_danger() {
    let model = machine();
    let verified = verify(&model, External::LeftOut).unwrap();
    let found = verified.danger.clone().unwrap();
    assert!(verified.agrees && found.kind == DangerKind::Dangerous);
    let document = serde_json::to_value(&verified).unwrap();
    let of = &document["classification"];
    assert_eq!(
        [&of["scenario"], &of["danger"]["kind"], &of["danger"]["known"]],
        ["persistence", "dangerous", "computed"]
    );
    let diverges = &of["danger"]["diverges"];
    assert_eq!([&diverges["word"], &diverges["known"]], ["LLR", "computed"]);
    assert!(diverges["share_of_directions"].as_f64().unwrap() > 0.99, "{diverges}");
    let page = |paged: &dyn Paged| paged.text().unwrap();
    let text = page(&verified);
    assert!(
        text.contains("persistence, dangerous")
            && crate::common::in_one_line(&text).contains("but its basin shrinks to nothing at omega*"),
        "{text}"
    );

    let range = Study { rpm_min: 59.0, rpm_max: 61.0 };
    let located = locate(&model, range, 1, &Unwatched).unwrap();
    let at = located.found.iter().find(|it| (it.at.speed_rpm() - 60.0).abs() < 1e-6).unwrap();
    let other = at.danger.as_ref().unwrap();
    let edge = |danger: &Danger| danger.at(Speeds::Slower).next().unwrap().returns.unwrap().velocity.unwrap();
    assert_eq!(other.kind, found.kind);
    assert_relative_eq!(edge(other), edge(&found), max_relative = 1e-3);
    let document = serde_json::to_value(&located).unwrap();
    let at_60 = |it: &&serde_json::Value| (it["speed_rpm"].as_f64().unwrap() - 60.0).abs() < 1e-6;
    let it = document["corner_impacts"].as_array().unwrap().iter().find(at_60).unwrap();
    assert_eq!(it["classification"]["danger"]["kind"], "dangerous");
    assert!(page(&located).contains("persistence, dangerous"));

    let resolution =
        Resolution::new(Step::for_values([59.98, 60.02], 4, corner_impact::study::survey::Spacing::Linear), 8);
    let surveyed = common::speeds(&model, [59.98, 60.02], &resolution, &Unwatched).unwrap();
    let [event] = surveyed.dangers.as_slice() else { panic!("{:?}", surveyed.dangers) };
    assert_relative_eq!(event.at.rpm, 60.0, max_relative = 1e-9);
    assert_eq!((event.danger.kind, event.attractors.len()), (DangerKind::Dangerous, 1));
    assert!(page(&surveyed).contains("dangerous"));
}

/// Motions diverge at the corner impact, and no orbit is stable on one of its sides: what is lost there is no basin.
#[test]
fn nothing_is_in_danger_where_one_side_has_no_attractor() {
    for numbers in [[0.5, 3.0, 0.5, 0.5], [3.0, 0.5, 0.5, 0.5]] {
        let map = normal_form(numbers);
        let stable = |outcome: &LocalOutcome| outcome.orbits.iter().filter(|orbit| orbit.stable()).count();
        let mut sides: Vec<usize> = map.outcomes().iter().filter(|it| it.mu != 0.0).map(stable).collect();
        sides.sort_unstable();
        assert!(sides == [0, 1] && map.divergence().is_some(), "{numbers:?}: {sides:?}");
        assert!(danger(&map).is_none(), "{numbers:?}");
    }
}

/// In units a million times smaller the disturbances that return are a million times larger numbers.
#[test]
fn disturbances_that_return_are_in_the_units_of_the_map() {
    let map = normal_form([-0.3, -1.7, 0.9025, 0.9025]);
    let returns = |map: &LocalMap| danger(map).unwrap().at(Speeds::Slower).next().unwrap().returns.unwrap().position;
    let scaled = |size: f64| {
        let side = |side: SideMap| SideMap { a: side.a, b: side.b * size };
        LocalMap { minus: side(map.minus), plus: side(map.plus), border: (map.border.0, map.border.1 * size) }
    };
    let own = returns(&map).unwrap();
    for size in [1e-6, 1e6] {
        assert_relative_eq!(returns(&scaled(size)).unwrap(), own * size, max_relative = 1e-3);
    }
}
