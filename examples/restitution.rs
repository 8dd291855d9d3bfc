//! The paper's corner impact with other coefficients of restitution: its speed, its eigenvalues, its verdict.
//!
//! `cargo run --release --example restitution`

use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::study::verify::{External, verify};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let paper = Model::parse("osorio-2008.toml", OSORIO_2008)?;
    println!("restitution   speed rpm  |eigenvalues| before    after               verdict");
    for hundredths in [50, 60, 70, 80, 90, 95] {
        let restitution = f64::from(hundredths) / 100.0;
        let model = paper.with_number("follower.restitution", restitution)?;
        let found = verify(&model, External::LeftOut)?;
        let map = &found.map;
        let moduli = |side: &corner_impact::corner::SideMap| {
            let [first, second] = side.eigenvalues().map(|value| value.modulus());
            format!("{first:.4}, {second:.4}")
        };
        let verdict = found.classification.as_ref().map_or("-".into(), |verdict| verdict.scenario.to_string());
        println!(
            "{restitution:11.2}  {:10.4}  {:>20}  {:>14}  {verdict:>16}",
            found.at.speed_rpm(),
            moduli(&map.minus),
            moduli(&map.plus),
        );
    }
    Ok(())
}
