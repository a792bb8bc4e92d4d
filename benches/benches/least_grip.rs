//! What the least grip of five soft fingers costs: cold, from nothing, and warm, from the solution of the sample before,
//! under a load that moves as at 1 kHz. Run with `--no-default-features` it needs no peers.

#![allow(missing_docs, reason = "criterion's macros")]
#![allow(clippy::unwrap_used, reason = "benchmark")]

use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use fingertip_hand::{FingerLimits, Grasp, GraspContact, GripOutcome, Hand, LeastGrip};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

/// Fingers of the hand.
const FINGERS: usize = 5;
/// Samples of a load that turns once; each figure is for one of them.
const SAMPLES: usize = 1000;

/// A thumb and four fingers around a jar of 4 cm radius.
fn grasp<T: Real>() -> Grasp<T, FINGERS> {
    let angles = [0.0, 2.2, 2.8, 3.5, 4.1_f64];
    let heights = [0.0, 0.02, 0.01, -0.01, -0.02];
    let mut contacts = [None; FINGERS];
    for (contact, (angle, height)) in contacts.iter_mut().zip(angles.into_iter().zip(heights)) {
        let outward = Vector3::new(angle.cos(), angle.sin(), 0.0);
        let place = (outward * 0.04 + Vector3::z() * height).map(T::literal);
        let normal = (-outward).map(T::literal);
        *contact = Some(GraspContact::soft(place, normal, T::literal(0.6), T::literal(2e-3)).unwrap());
    }
    Grasp::new(contacts)
}

fn loads<T: Real>() -> Vec<Wrench<T, Hand>> {
    (0..SAMPLES)
        .map(|sample| {
            let turn = core::f64::consts::TAU * sample as f64 / SAMPLES as f64;
            let force = Vector3::new(0.8 * turn.sin(), 0.5 * turn.cos(), -2.9);
            Wrench::from_force_at(&Vector3::new(5e-3, 0.0, -0.02).map(T::literal), force.map(T::literal))
        })
        .collect()
}

fn least_grip<T: Real>(criterion: &mut Criterion, scalar: &str) {
    let (grasp, loads) = (grasp::<T>(), loads::<T>());
    let limits = [FingerLimits::<T, 1>::none().with_greatest_normal(T::literal(15.0)).unwrap(); FINGERS];
    let mut program = LeastGrip::new();
    let all_held =
        loads.iter().all(|load| matches!(program.solve(&grasp, &limits, load), GripOutcome::Held(_)));
    assert!(all_held, "a load of the benchmark is not held");
    let mut group = criterion.benchmark_group("least grip of five soft fingers");
    for (name, warm) in [("cold", false), ("warm", true)] {
        let mut program = LeastGrip::new();
        let mut turn = loads.iter().cycle();
        group.bench_function(format!("{name}, {scalar}"), |bencher| {
            bencher.iter(|| {
                if !warm {
                    program.forget();
                }
                let load = turn.next().unwrap();
                black_box(program.solve(black_box(&grasp), black_box(&limits), black_box(load)))
            });
        });
    }
    group.finish();
}

fn all(criterion: &mut Criterion) {
    least_grip::<f64>(criterion, "f64");
    least_grip::<f32>(criterion, "f32");
}

criterion_group!(benches, all);
criterion_main!(benches);
