//! Signals to wrench in instructions, which do not depend on what else the machine does. Needs
//! valgrind and `gungraun-runner` of the version of the library.
#![allow(missing_docs, unused_qualifications, clippy::unwrap_used)]

use core::hint::black_box;

use fingertip_benches::{paper_sensor, signals};
use fingertip_wrench::{
    BicchiDario, Decoupled, GaussianElimination, Inverse, LeastSquares, Refined, Wrench, WrenchSolver,
};
use gungraun::{library_benchmark, library_benchmark_group, main};
use nalgebra::{Const, LU, Matrix6, Vector6};

/// A solver that outlives the bench, so that its copies and drops are not counted.
fn lasting<S, E: core::fmt::Debug>(solver: Result<S, E>) -> (&'static S, Vector6<f64>) {
    (Box::leak(Box::new(solver.unwrap())), signals())
}

fn gauss() -> (&'static GaussianElimination<f64>, Vector6<f64>) {
    lasting(GaussianElimination::new(&paper_sensor().unwrap()))
}

fn refined() -> (&'static Refined<f64>, Vector6<f64>) {
    lasting(Refined::new(&paper_sensor().unwrap()))
}

fn inverse() -> (&'static Inverse<f64>, Vector6<f64>) {
    lasting(Inverse::new(&paper_sensor().unwrap()))
}

fn decoupled() -> (&'static Decoupled<f64, BicchiDario, 6>, Vector6<f64>) {
    lasting(Decoupled::new(&paper_sensor().unwrap()))
}

fn least_squares() -> (&'static LeastSquares<f64, 6>, Vector6<f64>) {
    lasting(LeastSquares::new(&paper_sensor().unwrap()))
}

fn prefactored() -> (&'static LU<f64, Const<6>, Const<6>>, Vector6<f64>) {
    lasting(paper_sensor().map(|sensor| sensor.normalised().lu()))
}

fn matrix() -> (&'static Matrix6<f64>, Vector6<f64>) {
    lasting(paper_sensor().map(|sensor| *sensor.normalised()))
}

#[library_benchmark]
#[bench::gauss(gauss())]
#[bench::refined(refined())]
#[bench::inverse(inverse())]
#[bench::decoupled(decoupled())]
#[bench::least_squares(least_squares())]
fn fingertip<S: WrenchSolver<f64, 6>>((solver, signals): (&S, Vector6<f64>)) -> Wrench<f64> {
    black_box(solver).solve(black_box(&signals))
}

#[library_benchmark]
#[bench::prefactored(prefactored())]
fn nalgebra_prefactored(
    (factors, signals): (&LU<f64, Const<6>, Const<6>>, Vector6<f64>),
) -> Option<Vector6<f64>> {
    black_box(factors).solve(black_box(&signals))
}

#[library_benchmark]
#[bench::each_time(matrix())]
fn nalgebra_factoring((matrix, signals): (&Matrix6<f64>, Vector6<f64>)) -> Option<Vector6<f64>> {
    black_box(matrix).lu().solve(black_box(&signals))
}

#[library_benchmark]
#[bench::product(matrix())]
fn nalgebra_product((matrix, signals): (&Matrix6<f64>, Vector6<f64>)) -> Vector6<f64> {
    black_box(matrix) * black_box(&signals)
}

library_benchmark_group!(
    name = solvers,
    benchmarks = [fingertip, nalgebra_prefactored, nalgebra_factoring, nalgebra_product]
);
main!(library_benchmark_groups = solvers);
