//! Finds the periodic orbits of the paper's model at 700 rpm and follows the stable one in the speed.
//!
//! `cargo run --release --example branch`

use corner_impact::cam::Cam;
use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::orbit::branch::{Branch, Following};
use corner_impact::orbit::{Parameter, Search, search};
use corner_impact::simulate::{Machine, angular_velocity};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = Model::parse("osorio-2008.toml", OSORIO_2008)?;
    let machine = Machine::new(Cam::new(&model)?, &model.follower, angular_velocity(700.0));
    let orbits = search(&machine, &Search { revolutions: 1, impacts: None })?;
    for orbit in &orbits {
        let [first, second] = orbit.multipliers().map(|multiplier| multiplier.modulus());
        let stability = if orbit.is_stable() { "stable" } else { "unstable" };
        println!("{} impact(s), {stability}, |multipliers| {first:.4} and {second:.4}", orbit.impacts().count());
    }
    let stable = orbits.iter().find(|orbit| orbit.is_stable()).ok_or("no stable orbit")?;
    let following =
        Following { parameter: Parameter::Speed, range: [660.0, 750.0], longest_step: 0.02, most_points: 2000 };
    let branch = Branch::through(&model, 700.0, stable, &following)?;
    println!("the stable one, from 660 to 750 rpm:");
    for point in &branch.points {
        if let Some(special) = &point.special {
            println!("  {:.6} rpm: {}", point.rpm, special.kind.name());
        }
    }
    println!("  ends: {}; {}", branch.ends[0].words(), branch.ends[1].words());
    Ok(())
}
