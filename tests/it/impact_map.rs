//! Is what is proved of a box of impacts so of the impacts in it, as they are simulated?

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use approx::assert_abs_diff_eq;
use corner_impact::cam::Cam;
use corner_impact::covering::{HSet, HSetFrame, Image, ImpactMap, Strip, UnprovedFlight};
use corner_impact::interval::Interval;
use corner_impact::model::Model;
use corner_impact::section::{next_impact, trace};
use corner_impact::simulate::{Event, EventKind, Machine, angular_velocity};

use crate::common;

/// Angle, degrees, and velocity of the impact that is so many after one, simulated; none where the follower rests before.
fn simulated(machine: &Machine, [angle, velocity, omega]: [f64; 3], impacts: u64) -> Option<[f64; 2]> {
    let machine = machine.at_speed(omega);
    let turns = (angle / 360.0).floor();
    let mut motion = machine.start_on_cam((angle - 360.0 * turns).to_radians(), velocity).unwrap();
    let mut found = (0, None);
    let mut see = |event: &Event| {
        let at = 360.0 * (event.revolution as f64 + turns) + event.cam_angle.to_degrees();
        found = (found.0 + 1, Some([at, event.velocity_after - event.cam_velocity]));
        if event.kind == EventKind::Impact && found.0 < impacts {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    };
    let goal = motion.after(40);
    let _ = machine.advance(&mut motion, goal, &mut see).unwrap();
    if found.0 == impacts { found.1 } else { None }
}

/// The image of a box about a centre, in degrees, m/s and rad/s, and what some of its starts come to, corners first.
type Looked = (Result<Image, UnprovedFlight>, Vec<([f64; 3], Option<[f64; 2]>)>);

fn look(machine: &Machine, centre: [f64; 3], half: [f64; 3], impacts: u64) -> Looked {
    let set = HSet {
        rpm: [0.0; 2],
        centre: [0.0; 2],
        unstable: [1.0, 0.0],
        stable: [0.0, 1.0],
        x: [0.0; 2],
        y: [0.0; 2],
        cone_slope: None,
        strips: Vec::new(),
    };
    let place = [0, 1, 2].map(|side| Interval::new(centre[side] - half[side], centre[side] + half[side]));
    let strip = Strip { impacts, revolutions: 0, x: [0.0; 2] };
    let image = HSetFrame::new(&set).image(&ImpactMap::new(machine), &strip, &place);
    let start = |index: u32| -> [f64; 3] {
        std::array::from_fn(|side| match index {
            0..8 => [place[side].low(), place[side].high()][usize::from(index & (1 << side) != 0)],
            _ => centre[side] + half[side] * (2.0 * part(index, side + 5) - 1.0),
        })
    };
    let starts = (0..24).map(start).map(|start| (start, simulated(machine, start, impacts)));
    (image, starts.collect())
}

/// A number from 0 to 1 that is the same in every run, of several that go through all places alike.
fn part(index: u32, which: usize) -> f64 {
    let primes = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0];
    (f64::from(index + 1) * f64::sqrt(primes[which])).fract()
}

/// Of boxes everywhere, one to three impacts on, with corners and grazes in them, each the widest of its shape that is proved.
fn check(model: &Model, rpm: f64, boxes: u32) -> u32 {
    let machine = Machine::new(Cam::new(model).unwrap(), &model.follower, angular_velocity(rpm));
    let mut proved = 0;
    for index in 0..boxes {
        let velocity = 10.0_f64.powf(1.0 - 3.0 * part(index, 1));
        let centre = [360.0 * part(index, 0), velocity, angular_velocity(rpm)];
        let shape = [20.0 * part(index, 3), velocity * part(index, 4), 0.05 * f64::from(index % 2)];
        let impacts = 1 + u64::from(index % 3);
        let boxes = (0..14).map(|step| shape.map(|side| 0.6 * side * 0.6_f64.powi(step)));
        let found =
            boxes.map(|half| (half, look(&machine, centre, half, impacts))).find(|(_, (image, _))| image.is_ok());
        let Some((half, (Ok(image), starts))) = found else { continue };
        proved += 1;
        let case = format!("{} {centre:?} {half:?} {impacts}: {image:?}", model.name);
        // What the simulation rounds is stretched from impact to impact.
        let room =
            |side: usize| 1e-9 * image.by[side].iter().fold(1.0, |sum, by| sum + by.low().abs().max(by.high().abs()));
        for (start, end) in &starts {
            let end = end.unwrap_or_else(|| panic!("{start:?} rests: {case}"));
            for side in 0..2 {
                let range = image.value[side];
                let is_in = range.low() - room(side) <= end[side] && end[side] <= range.high() + room(side);
                assert!(is_in, "{start:?} {end:?} {case}");
            }
        }
        for pair in starts.windows(2) {
            let [(one, Some(to)), (two, Some(there))] = pair else { unreachable!() };
            for side in 0..2 {
                let change = (0..3).fold(Interval::from(0.0), |sum, by| sum + image.by[side][by] * (two[by] - one[by]));
                let off = there[side] - to[side];
                assert!(
                    change.low() - room(side) <= off && off <= change.high() + room(side),
                    "{one:?} {two:?} {case}"
                );
            }
        }
    }
    proved
}

/// A cam that does not let go throws nobody; and what is no velocity leaves nothing.
#[test]
fn an_impact_that_never_comes_is_none() {
    let machine =
        |rpm: f64| Machine::new(common::cam(&common::osorio()), &common::osorio().follower, angular_velocity(rpm));
    for angle in [0.0, 1.0, 2.79, 3.5, 6.0] {
        assert_eq!(next_impact(&machine(50.0), angle, 0.0).unwrap(), None, "{angle}");
        assert!(next_impact(&machine(50.0), angle, 1e-3).unwrap().is_some(), "{angle}");
        let thrown = next_impact(&machine(670.0), angle, 0.0).unwrap();
        // The cam may have to let go before.
        assert!(thrown.is_some_and(|event| event.kind == EventKind::Impact), "{angle} {thrown:?}");
        for velocity in [-1e-3, f64::NAN] {
            assert_eq!(next_impact(&machine(670.0), angle, velocity).unwrap(), None, "{angle} {velocity}");
        }
    }
}

/// Right before and right after each event of a trace: whether the follower touches the cam, and whether that presses.
#[test]
fn a_trace_presses_where_it_sticks() {
    let machine = Machine::new(common::cam(&common::osorio()), &common::osorio().follower, angular_velocity(183.0));
    let start = machine.start_on_cam(1.0, 0.0).unwrap();
    let (samples, events) = trace(&machine, start, 4, 360).unwrap();
    assert!(samples.iter().all(|sample| sample.contact || sample.pressing == 0.0));
    let moments: Vec<_> =
        samples.iter().filter(|sample| events.iter().all(|event| event.turned_since(0.0) != sample.turned)).collect();
    assert_eq!(moments.len(), 4 * 360 + 1);
    for (index, sample) in moments.iter().enumerate() {
        assert_abs_diff_eq!(sample.turned, 1.0 + TAU * index as f64 / 360.0, epsilon = 1e-12);
        // On the cam the follower has its velocity.
        assert!(!sample.contact || (sample.state.velocity - sample.cam_velocity).abs() < 1e-9, "{sample:?}");
    }
    let mut met = [0; 3];
    for event in &events {
        let here: Vec<_> = samples.iter().filter(|sample| sample.turned == event.turned_since(0.0)).collect();
        let told = |index: usize| (here[index].contact, here[index].pressing > 0.0);
        let (which, expected) = match event.kind {
            EventKind::Impact => (0, [(false, false), (false, false)]),
            EventKind::Stick => (1, [(false, false), (true, true)]),
            EventKind::Release => (2, [(true, false), (false, false)]),
        };
        assert_eq!([told(0), told(1)], expected, "{event:?}");
        met[which] += 1;
    }
    assert!(met.iter().all(|count| *count > 2), "{met:?}");
}

#[test]
#[ignore = "slow"]
fn what_is_proved_of_a_box_is_so_of_the_impacts_in_it() {
    let proved = check(&common::osorio(), 670.0, 800);
    assert!(proved > 600, "{proved}");
    // On a soft spring it flies for some turns, past the nose of the cam, and may touch that shortly before it lands.
    let proved = check(&common::osorio_with(&[("stiffness", "20.0")]), 670.0, 300);
    assert!(proved > 200, "{proved}");
    for name in ["damped-heavy", "laws/polynomial", "laws/rectified-sine"] {
        let model = common::read(&std::path::Path::new(common::ROOT).join(format!("models/{name}.toml")));
        let proved = check(&model, 670.0, 100);
        assert!(proved > 10, "{name}: {proved}");
    }
}
