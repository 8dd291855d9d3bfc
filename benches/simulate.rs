//! How long a revolution takes: the scan-and-bisect baseline and the simulator, one criterion measurement for each piece of
//! work, and the latency of one `sin_cos` in the same run. Ratios come from `benches/table.rs`, which interleaves.

mod baseline;
mod work;

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use work::Work;

fn latency(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("sin_cos");
    group.throughput(Throughput::Elements(u64::from(work::CHAIN)));
    group.bench_function("latency", |bencher| bencher.iter(|| work::chain(black_box(0.3))));
    group.finish();
}

fn simulate(criterion: &mut Criterion) {
    for work in Work::all() {
        let mut group = criterion.benchmark_group(work.name);
        group.throughput(Throughput::Elements(work.revolutions()));
        group.sample_size(10).warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(5));
        group.bench_function("baseline", |bencher| bencher.iter(|| work.by_baseline()));
        group.bench_function("simulator", |bencher| bencher.iter(|| work.by_simulator()));
        group.finish();
    }
}

fn threads(criterion: &mut Criterion) {
    let sweep = work::sweep();
    let mut group = criterion.benchmark_group("diagram of 2000 speeds");
    group.sample_size(10);
    for threads in [1, 2] {
        group.bench_function(format!("{threads} threads"), |bencher| bencher.iter(|| work::count(&sweep, threads)));
    }
    group.finish();
}

criterion_group!(benches, latency, simulate, threads);
criterion_main!(benches);
