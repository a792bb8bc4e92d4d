//! The pipeline that a scene makes at run time, beside the same stages as types.

#![allow(missing_docs, reason = "criterion's macros")]
#![allow(clippy::unwrap_used, reason = "of constants")]

use core::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fingertip::contact::{PointContact, SoftFinger};
use fingertip::friction::{Coulomb, DropDetector, ForceNoise, SoftFingerLimit};
use fingertip::surfaces::{Capsule, Ellipsoid, Sphere};
use fingertip::wrench::Wrench;
use fingertip::{Fingertip, Step};
use fingertip_scene::Scene;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const COUNT: usize = 1013;

/// Pushes on the tip of a finger of about 10 mm.
fn pushes() -> Vec<Wrench<f64>> {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let mut vector = |size: f64| Vector3::from_fn(|_, _| random.random_range(-size..size));
    (0..COUNT)
        .map(|_| {
            let force = vector(0.3) - Vector3::z() * 2.0;
            Wrench::on_fingertip(force, vector(0.003).cross(&force) + vector(5e-4))
        })
        .collect()
}

fn scene(rest: &str) -> Scene {
    Scene::from_text(&format!("version = 2\n[input]\nconvention = \"on_fingertip\"\n{rest}")).unwrap()
}

fn run_time(c: &mut Criterion) {
    let pushes = pushes();
    let mut group = c.benchmark_group("run time");
    group.throughput(Throughput::Elements(COUNT as u64));
    macro_rules! compare {
        ($name:literal, $scene:expr, $typed:expr) => {
            let mut pipeline = scene($scene).pipeline();
            group.bench_function(concat!($name, ", scene"), |b| {
                b.iter(|| {
                    for push in &pushes {
                        black_box(pipeline.sense(*black_box(push), 1e-3));
                    }
                });
            });
            let mut typed = $typed.build();
            let mut last = None;
            group.bench_function(concat!($name, ", typed"), |b| {
                b.iter(|| {
                    for push in &pushes {
                        let touch = typed.sense_wrench(*black_box(push), Step::of(1e-3).with_last(last));
                        last = touch.point();
                        black_box(touch);
                    }
                });
            });
        };
    }
    let noise = ForceNoise::isotropic(0.02).unwrap();
    compare!(
        "A: sphere, point, Coulomb, drop",
        "[surface]\nshape = \"sphere\"\nradius_m = 0.013\n[contact]\nleast_force_N = 0.1\n\
         [friction]\nstatic_coefficient = 0.6\n[slip]\ndetector = \"drop\"\nnoise_N = 0.02\n",
        Fingertip::builder()
            .contact(Sphere::centred(0.013).unwrap(), PointContact::new(0.1).unwrap())
            .friction(Coulomb::new(0.6).unwrap())
            .slip_detector(DropDetector::new(noise).unwrap())
    );
    compare!(
        "B: ellipsoid, point, Coulomb",
        "[surface]\nshape = \"ellipsoid\"\nsemi_axes_m = [0.008, 0.010, 0.013]\n[contact]\nleast_force_N = 0.1\n\
         [friction]\nstatic_coefficient = 0.6\n",
        Fingertip::builder()
            .contact(
                Ellipsoid::new(Vector3::new(0.008, 0.010, 0.013)).unwrap(),
                PointContact::new(0.1).unwrap()
            )
            .friction(Coulomb::new(0.6).unwrap())
    );
    compare!(
        "C: capsule, soft finger, its limit",
        "[surface]\nshape = \"capsule\"\nradius_m = 0.008\nhalf_length_m = 0.010\n[contact]\nmodel = \"soft_finger\"\n\
         least_force_N = 0.1\n[friction]\nlimit = \"soft_finger\"\nstatic_coefficient = 0.6\ntorque_arm_m = 0.003\n",
        Fingertip::builder()
            .contact(
                Capsule::new(Vector3::zeros(), Vector3::z(), 0.008, 0.010).unwrap(),
                SoftFinger::new(0.1).unwrap()
            )
            .friction(SoftFingerLimit::new(0.6, 0.003).unwrap())
    );
}

criterion_group!(benches, run_time);
criterion_main!(benches);
