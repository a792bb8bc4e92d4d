//! A calibration of a million samples of six gauges, streamed: `cargo bench -p fingertip-benches --bench calibration`.
#![allow(missing_docs, reason = "criterion's macros make public items without documentation")]

use core::hint::black_box;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use fingertip_calibration::linear::Triangular;

const SAMPLES: usize = 1_000_000;

/// Samples from a small generator, so that the bench measures the fit and not the memory: loads with a
/// constant, and readings.
fn samples() -> Vec<([f64; 7], [f64; 6])> {
    let mut state = 1_u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..SAMPLES)
        .map(|_| {
            let x: [f64; 7] = core::array::from_fn(|i| if i < 6 { draw() } else { 1.0 });
            let y = core::array::from_fn(|i| 2.0 * x[i] + 0.2 * x[(i + 1) % 6] + 0.01 * draw());
            (x, y)
        })
        .collect()
}

fn fit(criterion: &mut Criterion) {
    let samples = samples();
    let mut group = criterion.benchmark_group("calibration");
    group.throughput(Throughput::Elements(SAMPLES as u64)).sample_size(10);
    group.bench_function("fit of 1e6 samples of 6 gauges, streamed", |bencher| {
        bencher.iter_batched(
            || Triangular::new(7, 6),
            |mut triangular| {
                for (x, y) in &samples {
                    triangular.push(x, y);
                }
                black_box(triangular.factors().coefficients())
            },
            BatchSize::SmallInput,
        );
    });
    group.finish();
}

criterion_group!(benches, fit);
criterion_main!(benches);
