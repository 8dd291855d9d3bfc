//! Verifies a model and prints what decides about it: the eigenvalues on either side of the corner, and the verdict.
//!
//! `cargo run --release --example eigenvalues -- models/osorio-2008.toml`; without a file, the paper's model.

use std::path::Path;

use corner_impact::model::{Model, OSORIO_2008};
use corner_impact::study::verify::{External, verify};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = match std::env::args().nth(1) {
        Some(file) => Model::read(Path::new(&file))?,
        None => Model::parse("osorio-2008.toml", OSORIO_2008)?,
    };
    let found = verify(&model, External::LeftOut)?;
    let map = &found.map;
    println!("{}: corner impact at {:.6} rpm", model.name, found.at.speed_rpm());
    for (side, matrices) in [("before", &map.minus), ("after", &map.plus)] {
        let [first, second] = matrices.eigenvalues();
        let written = |value: corner_impact::corner::map::Eigenvalue| format!("{:.6}{:+.6}i", value.re, value.im);
        println!("  impact {side} the corner: {}, {}", written(first), written(second));
    }
    match &found.classification {
        Ok(verdict) => println!("  {}", verdict.scenario),
        Err(refusal) => println!("  not classified: {refusal}"),
    }
    println!("  {} comparisons of routes, all agree: {}", found.tally().comparisons, found.agrees);
    Ok(())
}
