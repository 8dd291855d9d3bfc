//! x
use corner_impact::*;
fn main() {
    let m = model::Model::parse("m", model::OSORIO_2008).map_err(|e| println!("{e}")).ok();
    let Some(m) = m else { return };
    let c = cam::Cam::new(&m).map_err(|e| println!("{e}")).ok();
    let Some(c) = c else { return };
    for k in c.corners() { println!("{k:?}"); }
    match corner::locate(&m, &c) {
        Ok(v) => for at in v {
            println!("{at:#?} {} {}", at.x_star(), at.speed_rpm());
            println!("{:?}", corner::closed_form::route(&m, &at));
            println!("{:?}", corner::closed_form::orbit(&m, &at, at.period*1.001));
            println!("{:?}", corner::simulated_orbit::orbit(&m, &c, &at));
            let t = std::time::Instant::now();
            println!("{:?}", corner::finite_difference::route(&m, &c, &at));
            println!("{:?} ", t.elapsed());
            println!("{:?}", corner::least_squares::route(&m, &c, &at));
            println!("{:?} ", t.elapsed());
        },
        Err(e) => println!("{e}"),
    }
}
