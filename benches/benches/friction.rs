//! What friction costs per sample.

#![allow(missing_docs, reason = "criterion's macros")]
#![allow(clippy::unwrap_used, reason = "benchmark")]

use core::hint::black_box;

use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main, measurement::WallTime};
use fingertip_friction::{
    AnisotropicCoulomb, Bristle, Coulomb, Drive, DropDetector, ElastoPlastic, Exponential, ForceNoise,
    FrictionModel, Implicit, KineticFriction, LikelihoodRatioDetector, LoadDependentLimit, LuGre,
    NormalForceGate, PowerLimit, RatioThreshold, ReturnMap, SlipDetector, SoftFingerLimit, StaticFriction,
    UncertainCoulomb,
};
use fingertip_wrench::{ContactForce, Real};
use nalgebra::{SVector, Vector1, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A thousand samples of a hold; each figure is for all of them.
fn samples<T: Real>() -> Vec<ContactForce<T>> {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    (0..1000)
        .map(|_| {
            let mut noise = || rng.random_range(-0.02..0.02);
            ContactForce::new(
                T::literal(4.0 + noise()),
                Vector3::new(
                    T::literal(1.2 + noise()),
                    T::literal(0.9 + noise()),
                    T::literal(noise() * 1e-3),
                ),
                T::literal(1e-3 * noise()),
            )
        })
        .collect()
}

fn limits<T: Real>(criterion: &mut Criterion, scalar: &str) {
    let samples = samples::<T>();
    let mut group = criterion.benchmark_group(format!("slip margin, 1000 forces, {scalar}"));
    let l = T::literal;
    let mut run = |name: &str, model: &dyn Fn(&ContactForce<T>) -> T| {
        group.bench_function(name, |b| {
            b.iter(|| samples.iter().fold(T::zero(), |sum, force| sum + model(black_box(force))));
        });
    };
    let model = Coulomb::new(l(0.6)).unwrap();
    run("Coulomb", &|f| model.slip_margin(f).newtons);
    let model = SoftFingerLimit::new(l(0.6), l(3e-3)).unwrap();
    run("soft finger, ellipse", &|f| model.slip_margin(f).newtons);
    let model = PowerLimit::new(l(0.6), l(3e-3), l(1.725)).unwrap();
    run("soft finger, power", &|f| model.slip_margin(f).newtons);
    let model = LoadDependentLimit::new(l(0.6), l(3e-3), l(5.0), l(0.33)).unwrap();
    run("load-dependent patch", &|f| model.slip_margin(f).newtons);
    let model = AnisotropicCoulomb::new([Vector3::x(), Vector3::y()], [l(0.5), l(0.8)]).unwrap();
    run("anisotropic", &|f| model.slip_margin(f).newtons);
    let noise = ForceNoise::isotropic(l(0.02)).unwrap();
    let model = UncertainCoulomb::new(l(0.6), l(0.05), Some(noise)).unwrap();
    run("probability of slip", &|f| model.slip_probability(f));
}

fn detectors<T: Real>(criterion: &mut Criterion, scalar: &str) {
    let samples = samples::<T>();
    let noise = ForceNoise::isotropic(T::literal(0.02)).unwrap();
    let step = T::literal(1e-3);
    let mut group = criterion.benchmark_group(format!("detector, 1000 updates, {scalar}"));
    fn run<T: Real>(
        group: &mut BenchmarkGroup<'_, WallTime>,
        name: &str,
        samples: &[ContactForce<T>],
        mut detector: impl SlipDetector<T>,
        step: T,
    ) {
        group.bench_function(name, |b| {
            b.iter(|| {
                for force in samples {
                    black_box(detector.update(black_box(force), step));
                }
            });
        });
    }
    let gate = NormalForceGate::from_noise(&noise);
    run(
        &mut group,
        "ratio threshold",
        &samples,
        RatioThreshold::new(gate, T::literal(0.6)).unwrap().with_warning_share(T::literal(0.9)).unwrap(),
        step,
    );
    run(&mut group, "drop", &samples, DropDetector::new(noise).unwrap(), step);
    let ratio = LikelihoodRatioDetector::<T, 16>::new(noise, 1.0, 1000.0).unwrap();
    run(&mut group, "likelihood ratio, 16", &samples, ratio, step);
    let ratio = LikelihoodRatioDetector::<T, 64>::new(noise, 1.0, 1000.0).unwrap();
    run(&mut group, "likelihood ratio, 64", &samples, ratio, step);

    let mut kinetic = KineticFriction::new(noise, T::one()).unwrap();
    group.bench_function("kinetic estimate", |b| {
        b.iter(|| {
            for force in &samples {
                kinetic.observe(black_box(force), step);
            }
        });
    });
    let mut peak = StaticFriction::<T, 64>::with_noise(noise).unwrap();
    group.bench_function("static estimate, observe", |b| {
        b.iter(|| {
            for force in &samples {
                peak.observe(black_box(force));
            }
        });
    });
}

fn dynamics(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("dynamic friction, 1000 steps, f64");
    let law = LuGre::<f64>::reference().unwrap();
    let plastic = ElastoPlastic::new(law, 0.5).unwrap();
    let speeds: Vec<f64> = (0..1000).map(|i| 2e-3 * (f64::from(i) * 0.05).sin()).collect();
    macro_rules! run {
        ($name:literal, $bristle:expr, $dimensions:literal) => {
            let mut bristle = $bristle;
            group.bench_function($name, |b| {
                b.iter(|| {
                    for v in &speeds {
                        let v = SVector::<f64, $dimensions>::repeat(*black_box(v));
                        black_box(bristle.step(&v, 1e-4));
                    }
                });
            });
        };
    }
    run!("LuGre, exponential, 1-D", Bristle::<f64, _, 1, Exponential>::with_method(law), 1);
    run!("LuGre, implicit, 1-D", Bristle::<f64, _, 1, Implicit>::with_method(law), 1);
    run!("LuGre, return map, 1-D", Bristle::<f64, _, 1, ReturnMap>::with_method(law), 1);
    run!("LuGre, exponential, 3-D", Bristle::<f64, _, 3, Exponential>::with_method(law), 3);
    run!("elasto-plastic, exponential, 1-D", Bristle::<f64, _, 1, Exponential>::with_method(plastic), 1);
    let mut bristle = Bristle::<f64, _, 1>::new(law);
    group.bench_function("LuGre with a mass, 1-D", |b| {
        let mut v = Vector1::new(0.0);
        b.iter(|| {
            for f in &speeds {
                let drive = Drive {
                    mass: Vector1::new(1.0),
                    force: Vector1::new(*black_box(f) * 700.0),
                    stiffness: 0.0,
                };
                v = bristle.step_body(&v, &drive, 1e-4).velocity;
            }
        });
    });
}

fn all(criterion: &mut Criterion) {
    limits::<f64>(criterion, "f64");
    limits::<f32>(criterion, "f32");
    detectors::<f64>(criterion, "f64");
    detectors::<f32>(criterion, "f32");
    dynamics(criterion);
}

criterion_group!(benches, all);
criterion_main!(benches);
