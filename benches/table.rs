//! `make bench`: work by work, the baseline's time, the simulator's, and their ratio, with the latency of one `sin_cos` as the
//! unit that travels between machines.
//!
//! Machines are shared and their clocks wander, so the three are measured in turn, round after round, and each ratio is the
//! median of the ratios within a round. The spread beside a time is half the range of the middle half of the rounds.

mod baseline;
mod work;

use std::hint::black_box;
use std::time::Instant;

use work::Work;

/// Rounds, and the least time that one measurement in a round takes, s.
const ROUNDS: usize = 31;
const LEAST_S: f64 = 0.01;

/// Runs `work` until [`LEAST_S`] have passed; seconds for one.
fn time<T>(work: impl Fn() -> T) -> f64 {
    let (began, mut runs) = (Instant::now(), 0.0);
    loop {
        black_box(work());
        runs += 1.0;
        let passed = began.elapsed().as_secs_f64();
        if passed >= LEAST_S {
            return passed / runs;
        }
    }
}

/// Median, and half the range of the middle half.
fn middle(mut values: Vec<f64>) -> (f64, f64) {
    values.sort_by(f64::total_cmp);
    let at = |part: usize| values[part * (values.len() - 1) / 4];
    (at(2), 0.5 * (at(3) - at(1)))
}

fn main() {
    // `cargo test --benches` asks whether it runs.
    let rounds = if std::env::args().any(|argument| argument == "--test") { 1 } else { ROUNDS };
    println!(
        "| work, a revolution of | events | sin_cos, ns | baseline, ns | in sin_cos | ours, ns | in sin_cos | ratio |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|");
    for work in Work::all() {
        let revolutions = work.revolutions() as f64;
        let (mut sin_cos, mut baseline, mut ours) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..rounds {
            sin_cos.push(1e9 * time(|| work::chain(black_box(0.3))) / f64::from(work::CHAIN));
            baseline.push(1e9 * time(|| work.by_baseline()) / revolutions);
            ours.push(1e9 * time(|| work.by_simulator()) / revolutions);
        }
        let ratios = |over: &[f64], under: &[f64]| middle(over.iter().zip(under).map(|(a, b)| a / b).collect()).0;
        let ((unit, unit_spread), (slow, slow_spread)) = (middle(sin_cos.clone()), middle(baseline.clone()));
        let events = work.by_baseline() as f64 / revolutions;
        print!("| {} | {events:.2} | {unit:.1} ± {unit_spread:.1} | {slow:.0} ± {slow_spread:.0} |", work.name);
        print!(" {:.0} |", ratios(&baseline, &sin_cos));
        let (fast, fast_spread) = middle(ours.clone());
        println!(" {fast:.0} ± {fast_spread:.0} | {:.1} | {:.1} |", ratios(&ours, &sin_cos), ratios(&baseline, &ours));
    }
    let sweep = work::sweep();
    let (mut one, mut two) = (Vec::new(), Vec::new());
    for _ in 0..rounds {
        one.push(time(|| work::count(&sweep, 1)));
        two.push(time(|| work::count(&sweep, 2)));
    }
    let ratio = middle(one.iter().zip(&two).map(|(one, two)| one / two).collect());
    println!(
        "\nA diagram of {} speeds on two threads is {:.2} ± {:.2} times as fast as on one.",
        sweep.over.count(),
        ratio.0,
        ratio.1
    );
}
