//! Soft fingers, their covariance, and error against run time of the methods.

#[path = "../../contact/tests/soft/pillow.rs"]
mod pillow;
#[path = "../../contact/tests/soft/wrenches.rs"]
#[allow(dead_code, reason = "shared with the tests, which use all of it")]
mod wrenches;

use core::hint::black_box;
use core::time::Duration;
use std::time::Instant;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fingertip_contact::{
    Auto, CompliantSoftFinger, ContactCovariance, ContactJacobian, ContactModel, ConvexBound, Hertz,
    PointContact, Resolution, Search, SoftContact, SoftFinger, SoftFingerSurface, WorstErrors, WrenchSpread,
    newton_soft_contacts,
};
use fingertip_surfaces::{
    ActiveSurface, CappedCylinder, Capsule, Cone, Cylinder, Ellipsoid, Heightfield, Implicit, Plane,
    SmoothSurface, Sphere, Superquadric, Torus,
};
use fingertip_wrench::{Line, Wrench};
use nalgebra::{Matrix2, Matrix6, Vector3, Vector6};
use pillow::Pillow;
use wrenches::{Case, Random};

/// How many wrenches each benchmark cycles through.
const COUNT: usize = 1024;
const SIZE: f64 = 0.017;

/// The same surface, with its closed form hidden.
struct ByNewton<S>(S);

impl<S: ActiveSurface<f64>> ActiveSurface<f64> for ByNewton<S> {
    fn crossings(&self, line: &Line<f64>, visit: impl FnMut(fingertip_surfaces::Crossing<f64>)) {
        self.0.crossings(line, visit);
    }

    fn closest_approach(&self, line: &Line<f64>) -> Option<fingertip_surfaces::ClosestApproach<f64>> {
        self.0.closest_approach(line)
    }

    fn normal(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.0.normal(point)
    }
}

impl<S: SmoothSurface<f64>> SoftFingerSurface<f64> for ByNewton<S> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<f64>,
        last: Option<&Vector3<f64>>,
        visit: impl FnMut(SoftContact<f64>),
    ) -> Search<f64> {
        newton_soft_contacts(&self.0, wrench, last, visit)
    }
}

/// A wrench, the contact that it comes from, and where the contact was a sample before.
struct Sample {
    wrench: Wrench<f64>,
    point: Vector3<f64>,
    /// Half a millimetre away.
    before: Vector3<f64>,
}

/// Contacts all over the surface, with forces within 60° of the normal and the given spin torque in
/// units of force times size.
fn samples<S: ActiveSurface<f64>>(surface: &S, spin: f64) -> Vec<Sample> {
    let mut random = Random::new(9);
    let sample = |_| {
        let (point, normal) = random.place(surface, SIZE);
        let force = random.force(&normal, 0.5, 2.0);
        let spin_torque = spin * SIZE * 2.0 * random.uniform(-1.0, 1.0);
        let before = point + random.direction().cross(&normal) * 5e-4;
        Sample { wrench: Case::new(point, normal, force, spin_torque).wrench, point, before }
    };
    (0..COUNT).map(sample).collect()
}

fn throughput(c: &mut Criterion, name: &str, cases: &[Sample], mut resolve: impl FnMut(&Sample) -> f64) {
    let mut group = c.benchmark_group("soft_finger");
    group.throughput(Throughput::Elements(COUNT as u64));
    group.bench_function(name, |b| {
        b.iter(|| {
            for case in cases {
                black_box(resolve(black_box(case)));
            }
        });
    });
    group.finish();
}

fn shape<S: SoftFingerSurface<f64>>(c: &mut Criterion, name: &str, surface: &S) {
    let cases = samples(surface, 0.3);
    let Ok(model) = SoftFinger::new(0.0) else { return };
    throughput(c, name, &cases, |case| {
        model.resolve(&case.wrench, surface).contact().map_or(0.0, |contact| contact.point.x)
    });
    throughput(c, &format!("{name}, near the last"), &cases, |case| {
        let contact = model.resolve_near(&case.wrench, surface, Some(&case.before));
        contact.contact().map_or(0.0, |contact| contact.point.x)
    });
}

fn resolution(c: &mut Criterion) {
    let Ok(sphere) = Sphere::centred(0.013) else { return };
    let Ok(ellipsoid) = Ellipsoid::new(Vector3::new(0.008, 0.011, 0.017)) else { return };
    let Ok(cylinder) = Cylinder::new(Vector3::zeros(), Vector3::new(0.2, -0.4, 1.0), 0.009) else { return };
    let Ok(plane) = Plane::new(Vector3::new(0.0, 0.0, 0.005), Vector3::new(0.1, 0.3, 1.0)) else { return };
    let Ok(cone) = Cone::new(Vector3::new(0.0, 0.0, 0.01), -Vector3::z(), 0.6) else { return };
    let Ok(capsule) = Capsule::new(Vector3::zeros(), Vector3::z(), 0.007, 0.006) else { return };
    let Ok(superquadric) = Superquadric::new(Vector3::new(0.008, 0.010, 0.013), [0.7, 0.8]) else { return };
    let Ok(torus) = Torus::new(0.010, 0.0035) else { return };
    let Ok(capped) = CappedCylinder::new(Vector3::zeros(), Vector3::new(0.2, 0.1, 1.0), 0.007, 0.011) else {
        return;
    };
    let heights = (0..33 * 33_u16).map(|k| {
        let (x, y) = (f64::from(k % 33) * 5e-4 - 0.008, f64::from(k / 33) * 5e-4 - 0.008);
        -(x * x / 0.010 + y * y / 0.015) / 2.0
    });
    let Ok(field) = Heightfield::new([-0.008; 2], [5e-4; 2], 33, heights.collect()) else { return };
    let Ok(pillow) = Implicit::<f64, _>::new(Pillow) else { return };
    shape(c, "sphere", &sphere);
    shape(c, "ellipsoid", &ellipsoid);
    shape(c, "cylinder", &cylinder);
    shape(c, "plane", &plane);
    shape(c, "cone", &cone);
    shape(c, "capsule", &capsule);
    shape(c, "implicit surface", &pillow);
    shape(c, "superquadric", &superquadric);
    shape(c, "capped cylinder", &capped);
    shape(c, "heightfield of 33 × 33", &field);
    shape(c, "ellipsoid by Newton", &ByNewton(ellipsoid));
    shape(c, "torus, all solutions", &torus);

    let cases = samples(&ellipsoid, 0.3);
    let (Ok(soft), Ok(point), Ok(hertz)) =
        (SoftFinger::new(0.0), PointContact::new(0.0), Hertz::sphere(0.012, 2e6))
    else {
        return;
    };
    throughput(c, "ellipsoid, point contact (wrench axis)", &cases, |case| {
        point.resolve(&case.wrench, &ellipsoid).contact().map_or(0.0, |contact| contact.point.x)
    });
    let noise = Matrix6::from_diagonal(&Vector6::new(1e-6, 1e-6, 1e-6, 1e-10, 1e-10, 1e-10));
    if let Ok(auto) = Auto::new(point, soft, noise) {
        throughput(c, "ellipsoid, auto", &cases, |case| {
            auto.resolve(&case.wrench, &ellipsoid).contact().map_or(0.0, |contact| contact.point.x)
        });
    }
    let skin = CompliantSoftFinger::new(soft, hertz);
    throughput(c, "ellipsoid, through a skin", &cases, |case| {
        skin.resolve(&case.wrench, &ellipsoid).contact().map_or(0.0, |contact| contact.point.x)
    });
    throughput(c, "ellipsoid, with position covariance", &cases, |case| {
        let Resolution::Contact(contact) = soft.resolve(&case.wrench, &ellipsoid) else { return 0.0 };
        ContactCovariance::soft_finger_position(&contact, &ellipsoid, &noise).map_or(0.0, |c| c.m11)
    });
    throughput(c, "ellipsoid, with the whole covariance", &cases, |case| {
        let Resolution::Contact(contact) = soft.resolve(&case.wrench, &ellipsoid) else { return 0.0 };
        ContactJacobian::of_soft_finger_on(&contact, &ellipsoid)
            .map_or(0.0, |jacobian| ContactCovariance::new(&jacobian, &noise).spin_variance())
    });
    let errors = WorstErrors::of_wrench(1e-3, 1e-5);
    throughput(c, "ellipsoid, rigorous bound", &cases, |case| {
        ConvexBound::new(&ellipsoid, &case.wrench, &errors, 0.02).map_or(0.0, |bound| bound.distance)
    });
}

/// Median and greatest error of a method, relative to the size, and its time, on the same wrenches.
fn row(name: &str, cases: &[Sample], mut resolve: impl FnMut(&Sample) -> Option<Vector3<f64>>) {
    let mut errors: Vec<f64> = cases
        .iter()
        .map(|case| resolve(case).map_or(f64::INFINITY, |point| (point - case.point).norm() / SIZE))
        .collect();
    errors.sort_by(f64::total_cmp);
    let mut best = Duration::MAX;
    for _ in 0..200 {
        let start = Instant::now();
        for case in cases {
            black_box(resolve(black_box(case)));
        }
        best = best.min(start.elapsed());
    }
    println!(
        "  {name:28} median error {:.1e}  greatest {:.1e}  {:7.1} ns",
        errors[errors.len() / 2],
        errors[errors.len() - 1],
        best.as_secs_f64() * 1e9 / cases.len() as f64
    );
}

/// Contacts of many wrenches, as one that plays a recording has them: point, normal and spin torque.
#[inline(never)]
fn all_contacts(
    model: &SoftFinger<f64>,
    surface: &Ellipsoid<f64>,
    cases: &[Sample],
    found: &mut [(Vector3<f64>, Vector3<f64>, f64)],
) {
    for (case, found) in cases.iter().zip(found) {
        if let Resolution::Contact(contact) = model.resolve(&case.wrench, surface) {
            *found = (contact.point, contact.normal, contact.spin_torque);
        }
    }
}

/// The same with the covariances of their positions.
#[inline(never)]
fn all_covariances(
    model: &SoftFinger<f64>,
    surface: &Ellipsoid<f64>,
    cases: &[Sample],
    noise: &Matrix6<f64>,
    found: &mut [(Vector3<f64>, Matrix2<f64>)],
) {
    for (case, found) in cases.iter().zip(found) {
        if let Resolution::Contact(contact) = model.resolve(&case.wrench, surface)
            && let Some(covariance) = ContactCovariance::soft_finger_position(&contact, surface, noise)
        {
            *found = (contact.point, covariance);
        }
    }
}

/// Both, one after the other.
fn over_a_recording(
    model: &SoftFinger<f64>,
    surface: &Ellipsoid<f64>,
    cases: &[Sample],
    noise: &Matrix6<f64>,
) {
    let mut contacts = vec![Default::default(); cases.len()];
    let mut covariances = vec![Default::default(); cases.len()];
    let mut best = [Duration::MAX; 2];
    for _ in 0..400 {
        let start = Instant::now();
        all_contacts(black_box(model), black_box(surface), black_box(cases), black_box(&mut contacts));
        best[0] = best[0].min(start.elapsed());
        let start = Instant::now();
        let cases = black_box(cases);
        all_covariances(
            black_box(model),
            black_box(surface),
            cases,
            black_box(noise),
            black_box(&mut covariances),
        );
        best[1] = best[1].min(start.elapsed());
    }
    let [alone, both] = best.map(|time| time.as_secs_f64() * 1e9 / cases.len() as f64);
    println!(
        "  ellipsoid, over a recording: {alone:.1} ns, with the covariance of the position {both:.1} ns"
    );
}

/// The fastest of many passes, which other work on the machine disturbs least: the figures that the
/// goals are about.
fn fastest(_: &mut Criterion) {
    let (Ok(sphere), Ok(ellipsoid), Ok(torus), Ok(pillow), Ok(soft)) = (
        Sphere::centred(0.013),
        Ellipsoid::new(Vector3::new(0.008, 0.011, 0.017)),
        Torus::new(0.010, 0.0035),
        Implicit::<f64, _>::new(Pillow),
        SoftFinger::new(0.0),
    ) else {
        return;
    };
    let noise = Matrix6::from_diagonal(&Vector6::new(1e-6, 1e-6, 1e-6, 1e-10, 1e-10, 1e-10));
    println!("soft finger, the fastest of 200 passes over {COUNT} wrenches:");
    let on_sphere = samples(&sphere, 0.3);
    row("sphere", &on_sphere, |case| soft.resolve(&case.wrench, &sphere).contact().map(|c| c.point));
    let on_ellipsoid = samples(&ellipsoid, 0.3);
    row("ellipsoid", &on_ellipsoid, |case| soft.resolve(&case.wrench, &ellipsoid).contact().map(|c| c.point));
    row("ellipsoid, covariance too", &on_ellipsoid, |case| {
        let contact = *soft.resolve(&case.wrench, &ellipsoid).contact()?;
        black_box(ContactCovariance::soft_finger_position(&contact, &ellipsoid, &noise)?);
        Some(contact.point)
    });
    over_a_recording(&soft, &ellipsoid, &on_ellipsoid, &noise);
    let independent = WrenchSpread::Independent(noise.diagonal());
    row("ellipsoid, independent noise", &on_ellipsoid, |case| {
        let contact = *soft.resolve(&case.wrench, &ellipsoid).contact()?;
        black_box(ContactCovariance::soft_finger_position(&contact, &ellipsoid, independent)?);
        Some(contact.point)
    });
    let isotropic = WrenchSpread::Isotropic { force: noise.m11, torque: noise.m44 };
    row("ellipsoid, isotropic noise", &on_ellipsoid, |case| {
        let contact = *soft.resolve(&case.wrench, &ellipsoid).contact()?;
        black_box(ContactCovariance::soft_finger_position(&contact, &ellipsoid, isotropic)?);
        Some(contact.point)
    });
    let on_pillow = samples(&pillow, 0.3);
    row("implicit surface", &on_pillow, |case| {
        soft.resolve(&case.wrench, &pillow).contact().map(|c| c.point)
    });
    row("implicit surface, near last", &on_pillow, |case| {
        soft.resolve_near(&case.wrench, &pillow, Some(&case.before)).contact().map(|c| c.point)
    });
    row("torus, nearest of all", &samples(&torus, 0.3), |case| {
        soft.resolve_near(&case.wrench, &torus, Some(&case.before)).contact().map(|c| c.point)
    });
}

/// Error against run time: closed form, Newton and the wrench's axis.
fn error_against_time(_: &mut Criterion) {
    let Ok(surface) = Ellipsoid::new(Vector3::new(0.008, 0.011, 0.017)) else { return };
    let (Ok(soft), Ok(point)) = (SoftFinger::new(0.0), PointContact::new(0.0)) else { return };
    let hidden = ByNewton(surface);
    for spin in [0.0, 1e-8, 1e-3, 0.1, 1.0, 10.0] {
        let cases = samples(&surface, spin);
        println!("ellipsoid 8 × 11 × 17 mm, spin torque up to {spin} |f| size:");
        row("closed form", &cases, |case| soft.resolve(&case.wrench, &surface).contact().map(|c| c.point));
        row("Newton", &cases, |case| soft.resolve(&case.wrench, &hidden).contact().map(|c| c.point));
        row("Newton near the last", &cases, |case| {
            soft.resolve_near(&case.wrench, &hidden, Some(&case.before)).contact().map(|c| c.point)
        });
        row("axis of the wrench", &cases, |case| {
            point.resolve(&case.wrench, &surface).contact().map(|c| c.point)
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(500))
        .sample_size(20);
    targets = fastest, resolution, error_against_time
}
criterion_main!(benches);
