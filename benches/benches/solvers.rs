//! Signals to wrench: our solvers beside nalgebra and faer.
#![allow(missing_docs, clippy::unwrap_used)]

use core::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main};
use faer::linalg::solvers::{PartialPivLu, Solve};
use fingertip_benches::{paper_sensor, signals};
use fingertip_wrench::{
    BicchiDario, Decoupled, ErrorBound, GaussianElimination, Inverse, LeastSquares, Real, Refined,
    Uncertainty, WrenchSolver,
};
use nalgebra::Vector6;

fn ours<T: Real>(group: &mut BenchmarkGroup<'_, WallTime>) {
    let sensor = paper_sensor::<T>().unwrap();
    let signals = signals::<T>();
    let gauss = GaussianElimination::new(&sensor).unwrap();
    group.bench_function("GaussianElimination", |b| b.iter(|| black_box(&gauss).solve(black_box(&signals))));
    let inverse = Inverse::new(&sensor).unwrap();
    group.bench_function("Inverse", |b| b.iter(|| black_box(&inverse).solve(black_box(&signals))));
    let decoupled = Decoupled::<T, BicchiDario, 6>::new(&sensor).unwrap();
    group.bench_function("Decoupled", |b| b.iter(|| black_box(&decoupled).solve(black_box(&signals))));
    let least_squares = LeastSquares::new(&sensor).unwrap();
    group.bench_function("LeastSquares", |b| b.iter(|| black_box(&least_squares).solve(black_box(&signals))));
    let refined = Refined::new(&sensor).unwrap();
    group.bench_function("Refined", |b| b.iter(|| black_box(&refined).solve(black_box(&signals))));
    let uncertainty = Uncertainty::of_signals(Vector6::repeat(T::literal(1e-3)));
    let bound = ErrorBound::new(&sensor, &gauss, &uncertainty).unwrap();
    group.bench_function("GaussianElimination with its error bound", |b| {
        b.iter(|| {
            let signals = black_box(&signals);
            let wrench = black_box(&gauss).solve(signals);
            (wrench, black_box(&bound).at(signals, &wrench))
        });
    });
}

fn nalgebra<T: Real>(group: &mut BenchmarkGroup<'_, WallTime>) {
    let sensor = paper_sensor::<T>().unwrap();
    let (matrix, signals) = (*sensor.normalised(), signals::<T>());
    let factors = matrix.lu();
    group.bench_function("nalgebra, prefactored", |b| {
        b.iter(|| black_box(&factors).solve(black_box(&signals)))
    });
    group.bench_function("nalgebra, factoring each time", |b| {
        b.iter(|| black_box(&matrix).lu().solve(black_box(&signals)));
    });
    group.bench_function("nalgebra, 6x6 product", |b| b.iter(|| black_box(&matrix) * black_box(&signals)));
}

fn double(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("solve f64");
    ours::<f64>(&mut group);
    nalgebra::<f64>(&mut group);
    let sensor = paper_sensor::<f64>().unwrap();
    let matrix = faer::Mat::from_fn(6, 6, |i, j| sensor.normalised()[(i, j)]);
    let signals = signals::<f64>();
    let signals = faer::Mat::from_fn(6, 1, |i, _| signals[i]);
    let factors = PartialPivLu::new(matrix.as_ref());
    group.bench_function("faer, prefactored", |b| b.iter(|| black_box(&factors).solve(black_box(&signals))));
    group.bench_function("faer, factoring each time", |b| {
        b.iter(|| PartialPivLu::new(black_box(&matrix).as_ref()).solve(black_box(&signals)));
    });
    group.finish();
}

fn single(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("solve f32");
    ours::<f32>(&mut group);
    nalgebra::<f32>(&mut group);
    group.finish();
}

fn construction(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("construct f64");
    let sensor = paper_sensor::<f64>().unwrap();
    group.bench_function("GaussianElimination", |b| b.iter(|| GaussianElimination::new(black_box(&sensor))));
    group.bench_function("Inverse", |b| b.iter(|| Inverse::new(black_box(&sensor))));
    group.bench_function("Decoupled", |b| {
        b.iter(|| Decoupled::<f64, BicchiDario, 6>::new(black_box(&sensor)))
    });
    group.bench_function("LeastSquares", |b| b.iter(|| LeastSquares::new(black_box(&sensor))));
    group.bench_function("Refined", |b| b.iter(|| Refined::new(black_box(&sensor))));
    group.finish();
}

criterion_group!(benches, double, single, construction);
criterion_main!(benches);
