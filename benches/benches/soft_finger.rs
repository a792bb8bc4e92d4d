//! Soft fingers, their covariance, and error against run time of the methods.

use core::hint::black_box;
use core::time::Duration;
use std::time::Instant;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fingertip_surfaces::{
    ActiveSurface, Auto, CappedCylinder, Capsule, CompliantSoftFinger, Cone, ContactCovariance,
    ContactJacobian, ContactModel, ConvexBound, Cylinder, Ellipsoid, Heightfield, Hertz, Implicit,
    ImplicitBounds, ImplicitSurface, Plane, PointContact, Search, SmoothImplicit, SmoothSurface, SoftContact,
    SoftFinger, SoftFingerSurface, Sphere, Superquadric, Topology, Torus, WorstErrors, newton_soft_contacts,
};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// How many wrenches each benchmark cycles through.
const COUNT: usize = 1024;
const SIZE: f64 = 0.017;

/// `x⁴ + y⁴ + z⁴ + (x² + y² + z²)/2 = 1` in units of 10 mm: a general implicit surface, declared
/// convex.
struct Pillow;

impl<T: Real> ImplicitSurface<T> for Pillow {
    fn value(&self, p: &Vector3<T>) -> T {
        let q = p.component_mul(p) * T::literal(1e4);
        (q.norm_squared() + q.sum() * T::literal(0.5) - T::one()) * T::literal(0.5)
    }

    fn gradient(&self, p: &Vector3<T>) -> Vector3<T> {
        let q = p * T::literal(100.0);
        (q.map(|x| x * x * x) * T::literal(2.0) + q * T::literal(0.5)) * T::literal(100.0)
    }

    fn bounds(&self) -> ImplicitBounds<T> {
        ImplicitBounds { centre: Vector3::zeros(), radius: T::literal(0.0121), steepest: T::literal(420.0) }
    }
}

impl<T: Real> SmoothImplicit<T> for Pillow {
    fn hessian(&self, p: &Vector3<T>) -> Matrix3<T> {
        let q = p * T::literal(100.0);
        Matrix3::from_diagonal(&q.map(|x| (x * x * T::literal(6.0) + T::literal(0.5)) * T::literal(1e4)))
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

/// The same surface, with its closed form hidden.
struct ByNewton<S>(S);

impl<S: ActiveSurface<f64>> ActiveSurface<f64> for ByNewton<S> {
    fn crossings(&self, line: &Line<f64>, visit: impl FnMut(fingertip_surfaces::Crossing<f64>)) {
        self.0.crossings(line, visit);
    }

    fn closest_approach(&self, line: &Line<f64>) -> fingertip_surfaces::ClosestApproach<f64> {
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

#[derive(Clone, Copy)]
struct Case {
    wrench: Wrench<f64>,
    point: Vector3<f64>,
    /// The contact of the sample before, half a millimetre away.
    before: Vector3<f64>,
}

fn direction(random: &mut Pcg64Mcg) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| random.random::<f64>() * 2.0 - 1.0);
        if v.norm_squared() <= 1.0 && v.norm_squared() > 0.01 {
            return v.normalize();
        }
    }
}

/// Contacts all over the surface, with forces within 60° of the normal and the given spin torque in
/// units of force times size.
fn cases<S: ActiveSurface<f64>>(surface: &S, spin: f64) -> Vec<Case> {
    let mut random = Pcg64Mcg::seed_from_u64(9);
    let mut cases = Vec::with_capacity(COUNT);
    while cases.len() < COUNT {
        let line = Line { point: direction(&mut random) * 0.006, direction: direction(&mut random) };
        let mut found = None;
        surface.crossings(&line, |c| found = Some((c.point, c.normal)));
        let Some((point, normal)) = found else { continue };
        let force = direction(&mut random) * 2.0;
        if point.norm() > 0.05 || -force.dot(&normal) < 1.0 {
            continue;
        }
        let torque =
            point.cross(&force) + normal * (spin * SIZE * 2.0 * (random.random::<f64>() * 2.0 - 1.0));
        let before = point + direction(&mut random).cross(&normal) * 5e-4;
        cases.push(Case { wrench: Wrench::on_fingertip(force, torque), point, before });
    }
    cases
}

fn throughput(c: &mut Criterion, name: &str, cases: &[Case], mut resolve: impl FnMut(&Case) -> f64) {
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
    let cases = cases(surface, 0.3);
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
    let Ok(capsule) = Capsule::new(Vector3::zeros(), Vector3::z(), 0.006, 0.007) else { return };
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
    let Ok(pillow) = Implicit::new::<f64>(Pillow) else { return };
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

    let cases = cases(&ellipsoid, 0.3);
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
        let Some(contact) = soft.resolve(&case.wrench, &ellipsoid).contact().copied() else { return 0.0 };
        ContactJacobian::of_soft_finger_on(&contact, &ellipsoid)
            .map_or(0.0, |jacobian| ContactCovariance::position_only(&jacobian, &noise).m11)
    });
    throughput(c, "ellipsoid, with the whole covariance", &cases, |case| {
        let Some(contact) = soft.resolve(&case.wrench, &ellipsoid).contact().copied() else { return 0.0 };
        ContactJacobian::of_soft_finger_on(&contact, &ellipsoid)
            .map_or(0.0, |jacobian| ContactCovariance::new(&jacobian, &noise).spin_variance())
    });
    let errors = WorstErrors::of_wrench(1e-3, 1e-5);
    throughput(c, "ellipsoid, rigorous bound", &cases, |case| {
        ConvexBound::new(&ellipsoid, &case.wrench, &errors, 0.02).map_or(0.0, |bound| bound.distance)
    });
}

/// Median and greatest error of a method, relative to the size, and its time, on the same wrenches.
fn row(name: &str, cases: &[Case], mut resolve: impl FnMut(&Case) -> Option<Vector3<f64>>) {
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

/// The fastest of many passes, which other work on the machine disturbs least: the figures that the
/// goals are about.
fn fastest(_: &mut Criterion) {
    let (Ok(sphere), Ok(ellipsoid), Ok(torus), Ok(pillow), Ok(soft)) = (
        Sphere::centred(0.013),
        Ellipsoid::new(Vector3::new(0.008, 0.011, 0.017)),
        Torus::new(0.010, 0.0035),
        Implicit::new::<f64>(Pillow),
        SoftFinger::new(0.0),
    ) else {
        return;
    };
    let noise = Matrix6::from_diagonal(&Vector6::new(1e-6, 1e-6, 1e-6, 1e-10, 1e-10, 1e-10));
    println!("soft finger, the fastest of 200 passes over {COUNT} wrenches:");
    let on_sphere = cases(&sphere, 0.3);
    row("sphere", &on_sphere, |case| soft.resolve(&case.wrench, &sphere).contact().map(|c| c.point));
    let on_ellipsoid = cases(&ellipsoid, 0.3);
    row("ellipsoid", &on_ellipsoid, |case| soft.resolve(&case.wrench, &ellipsoid).contact().map(|c| c.point));
    row("ellipsoid, covariance too", &on_ellipsoid, |case| {
        let contact = *soft.resolve(&case.wrench, &ellipsoid).contact()?;
        let jacobian = ContactJacobian::of_soft_finger_on(&contact, &ellipsoid)?;
        black_box(ContactCovariance::position_only(&jacobian, &noise));
        Some(contact.point)
    });
    let on_pillow = cases(&pillow, 0.3);
    row("implicit surface", &on_pillow, |case| {
        soft.resolve(&case.wrench, &pillow).contact().map(|c| c.point)
    });
    row("implicit surface, near last", &on_pillow, |case| {
        soft.resolve_near(&case.wrench, &pillow, Some(&case.before)).contact().map(|c| c.point)
    });
    row("torus, nearest of all", &cases(&torus, 0.3), |case| {
        soft.resolve_near(&case.wrench, &torus, Some(&case.before)).contact().map(|c| c.point)
    });
}

/// Error against run time: closed form, Newton and the wrench's axis.
fn error_against_time(_: &mut Criterion) {
    let Ok(surface) = Ellipsoid::new(Vector3::new(0.008, 0.011, 0.017)) else { return };
    let (Ok(soft), Ok(point)) = (SoftFinger::new(0.0), PointContact::new(0.0)) else { return };
    let hidden = ByNewton(surface);
    for spin in [0.0, 1e-8, 1e-3, 0.1, 1.0, 10.0] {
        let cases = cases(&surface, spin);
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
