//! The numbers of docs/global-picture.md, for the paper's model.
//!
//! `cargo run --release --example global_picture -- exponents | endings | distance | passage`

use corner_impact::border_collision::{LocalMap, passage};
use corner_impact::cam::Cam;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::orbit::long_run::{Budget, LongRun};
use corner_impact::orbit::{Course, Search, search};
use corner_impact::section::StroboscopicMap;
use corner_impact::simulate::Record;
use corner_impact::simulate::{Machine, angular_velocity};
use corner_impact::study::basins::boundary::approach;
use corner_impact::study::basins::{Curve, Extent, Reversed, Saddle};
use corner_impact::study::survey::Values;
use corner_impact::study::survey::long_run;
use corner_impact::study::verify::{External, Verification, verify};

type Done = Result<(), Box<dyn std::error::Error>>;

fn main() -> Done {
    let model = Model::parse("osorio-2008.toml", OSORIO_2008)?;
    let findings = verify(&model, External::LeftOut)?;
    match std::env::args().nth(1).as_deref() {
        Some("exponents") => exponents(&model, &findings),
        Some("endings") => endings(&model, &findings),
        Some("distance") => distances(&model, &findings),
        Some("passage") => passages(&model, &findings),
        _ => Err("one of exponents, endings, distance, passage".into()),
    }
}

fn map(model: &Model, findings: &Verification, rpm: f64) -> Result<StroboscopicMap, Box<dyn std::error::Error>> {
    let machine = Machine::new(Cam::new(model)?, &model.follower, angular_velocity(rpm));
    Ok(StroboscopicMap { machine, cam_angle: findings.at.section_angle() })
}

/// Lyapunov exponents from a start at rest on the cam, by blocks of 250 revolutions.
fn exponents(model: &Model, findings: &Verification) -> Done {
    println!("rpm exponent standard_error blocks rests");
    let speeds = Values::linear(660.0, 682.0, 23);
    for rpm in speeds.all() {
        let machine = map(model, findings, rpm)?.machine;
        let mut motion = machine.start_on_cam(0.0, 0.0)?;
        let goal = motion.after(300);
        let _ = machine.advance(&mut motion, goal, &mut |_: &corner_impact::simulate::Event| {
            std::ops::ControlFlow::Continue(())
        })?;
        let mut record = Record::over(250);
        record.take(&machine, &mut motion, 20 * 250)?;
        let growth = record.growth();
        println!("{rpm} {:.4} {:.4} {} {}", growth.value, growth.error, record.revolutions, record.rests());
    }
    Ok(())
}

/// Speeds at which a start at rest on the cam does not end on chaos, as far as 3000 revolutions show.
fn endings(model: &Model, findings: &Verification) -> Done {
    let speeds = Values::linear(660.0, 682.0, 441);
    let (mut orbits, mut resting) = (0, 0);
    for rpm in speeds.all() {
        let machine = map(model, findings, rpm)?.machine;
        let budget = Budget { transient: 3000, longest: 64, patience: 0, ..Budget::SURVEY };
        match long_run(&machine, machine.start_on_cam(0.0, 0.0)?, budget)?.ending {
            LongRun::Orbit(orbit) => {
                orbits += 1;
                let [first, second] = orbit.multipliers().map(|multiplier| multiplier.modulus());
                let impacts = orbit.impacts().count();
                println!(
                    "{rpm:.2}: {} revolutions, {impacts} impacts, |multipliers| {first:.3} {second:.3}",
                    orbit.revolutions
                );
            }
            LongRun::Sticking(_) => resting += 1,
            LongRun::PermanentContact | LongRun::Chaotic(_) | LongRun::Undecided(_) => {}
        }
    }
    println!("of {} speeds: {orbits} on an orbit, {resting} on one with rests", speeds.count);
    Ok(())
}

/// The least distance between the saddle's manifolds.
fn distances(model: &Model, findings: &Verification) -> Done {
    for rpm in [674.0, 676.0, 678.0, 680.0, 681.0, 681.5, 682.0, 682.1, 682.15, 682.18, 682.2] {
        let map = map(model, findings, rpm)?;
        let orbits = search(&map.machine, &Search { revolutions: 1, impacts: Some(1) })?;
        let saddle = orbits.iter().find_map(|orbit| match &orbit.course {
            Course::Impacts(cycle) => Saddle::new(&map.machine, cycle, map.cam_angle),
            _ => None,
        });
        let saddle = saddle.ok_or("no saddle")?;
        let reversed = Reversed::new(&model.follower, &map).ok_or("the cam is not its mirror image")?;
        let extent = Extent { stretches: 28, first: 1e-6, finest: 0.01, farthest: 2.0 };
        let curve = Curve::stable(&reversed, &saddle, -saddle.stable.1[0].signum(), &extent);
        let found = approach(&map, &saddle, -saddle.unstable.1[0].signum(), &curve, 0.3, [2000, 40])?;
        let multiplier = saddle.unstable.0;
        println!("{rpm} rpm: {:.6} m, multiplier {multiplier:.4}", found.distance);
    }
    Ok(())
}

/// Revolutions until the motion has left x*, by the piecewise-linear map and by runs.
fn passages(model: &Model, findings: &Verification) -> Done {
    let local = LocalMap::new(&findings.map, findings.border);
    println!("revolutions for each factor of ten: {:?}", passage::revolutions_per_decade(&local));
    for decade in 1..=9 {
        let rpm = findings.at.speed_rpm() - 10f64.powi(-decade);
        let dt = 60.0 / rpm - findings.at.period;
        let linear = passage::linear(&local, dt, 1e-3, 100_000);
        let run = passage::simulated(&map(model, findings, rpm)?, findings.at.state, 1e-3, 100_000)?;
        println!("1e-{decade} rpm below: map {linear:?}, run {run:?}");
    }
    Ok(())
}
