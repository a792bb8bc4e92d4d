//! Soft fingers in instructions, which do not depend on what else the machine does. Needs valgrind
//! and `gungraun-runner` of the version of the library.
#![allow(missing_docs, unused_qualifications, clippy::unwrap_used)]

use core::hint::black_box;

use fingertip_contact::{ContactCovariance, ContactModel, PointContact, Resolution, SoftFinger};
use fingertip_surfaces::{Ellipsoid, Sphere};
use fingertip_wrench::Wrench;
use gungraun::{library_benchmark, library_benchmark_group, main};
use nalgebra::{Matrix6, Vector3, Vector6};

fn wrench() -> Wrench<f64> {
    let (point, force) = (Vector3::new(0.0045, -0.003, 0.0125), Vector3::new(-0.5, 0.7, -1.7));
    Wrench::on_fingertip(force, point.cross(&force) + Vector3::new(2e-3, -1e-3, 4e-3))
}

/// A model and a surface that outlive the bench, so that their copies and drops are not counted.
fn lasting<M, S>(model: M, surface: S) -> (&'static M, &'static S, Wrench<f64>) {
    (Box::leak(Box::new(model)), Box::leak(Box::new(surface)), wrench())
}

type With<M, S> = (&'static M, &'static S, Wrench<f64>);

fn sphere() -> With<SoftFinger<f64>, Sphere<f64>> {
    lasting(SoftFinger::new(0.01).unwrap(), Sphere::centred(0.013).unwrap())
}

fn ellipsoid() -> With<SoftFinger<f64>, Ellipsoid<f64>> {
    lasting(SoftFinger::new(0.01).unwrap(), Ellipsoid::new(Vector3::new(0.008, 0.011, 0.017)).unwrap())
}

fn hard_ellipsoid() -> With<PointContact<f64>, Ellipsoid<f64>> {
    lasting(PointContact::new(0.01).unwrap(), *ellipsoid().1)
}

#[library_benchmark]
#[bench::sphere(sphere())]
fn on_sphere((model, surface, wrench): With<SoftFinger<f64>, Sphere<f64>>) -> Resolution<f64> {
    model.resolve(black_box(&wrench), surface)
}

#[library_benchmark]
#[bench::ellipsoid(ellipsoid())]
fn on_ellipsoid((model, surface, wrench): With<SoftFinger<f64>, Ellipsoid<f64>>) -> Resolution<f64> {
    model.resolve(black_box(&wrench), surface)
}

#[library_benchmark]
#[bench::hard_ellipsoid(hard_ellipsoid())]
fn hard_on_ellipsoid((model, surface, wrench): With<PointContact<f64>, Ellipsoid<f64>>) -> Resolution<f64> {
    model.resolve(black_box(&wrench), surface)
}

#[library_benchmark]
#[bench::covariance(ellipsoid())]
fn covariance_on_ellipsoid((model, surface, wrench): With<SoftFinger<f64>, Ellipsoid<f64>>) -> f64 {
    let noise = Matrix6::from_diagonal(&Vector6::new(1e-6, 1e-6, 1e-6, 1e-10, 1e-10, 1e-10));
    let contact = *model.resolve(black_box(&wrench), surface).contact().unwrap();
    ContactCovariance::soft_finger_position(&contact, surface, black_box(&noise)).map_or(0.0, |c| c.m11)
}

library_benchmark_group!(
    name = instructions;
    benchmarks = on_sphere, on_ellipsoid, hard_on_ellipsoid, covariance_on_ellipsoid
);
main!(library_benchmark_groups = instructions);
