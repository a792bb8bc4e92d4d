//! Contact resolution: throughput per shape, against a hand-written kernel and against parry3d on
//! the same lines, with the errors of both side by side (printed before the measurements).
//!
//! `cargo bench -p fingertip-benches --bench surfaces`
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use core::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fingertip::contact::*;
use fingertip::surfaces::testing::ball_of_triangles;
use fingertip::surfaces::*;
use fingertip::wrench::{Line, Real, Wrench};
use fingertip_benches::Columns;
use nalgebra::Vector3;
use parry3d::query::{Ray, RayCast};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Not a power of two: columns that lie a multiple of 4 KiB apart fight for the same cache lines.
const COUNT: usize = 1000;

/// Lines that pass a ball of this radius about the origin within 0.9 of it.
fn lines(radius: f64) -> Vec<Line<f64>> {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
    (0..COUNT)
        .map(|_| {
            let direction = any().normalize();
            let aim = any().normalize() * radius * 0.5;
            let point = aim - direction * direction.dot(&aim);
            Line { point, direction }
        })
        .collect()
}

fn wrenches<T: Real>(radius: f64) -> Vec<Wrench<T>> {
    lines(radius)
        .iter()
        .map(|line| {
            let force = line.direction * 2.0;
            Wrench::on_fingertip(force.map(T::literal), line.point.cross(&force).map(T::literal))
        })
        .collect()
}

/// Contact points and normals, which every candidate stores.
type Found<T> = [(Vector3<T>, Vector3<T>)];

/// A sphere anywhere, as one would write it by hand: no threshold, no range, no reason why not.
#[inline]
fn sphere_by_hand<T: Real>(
    (f, m): (Vector3<T>, Vector3<T>),
    centre: &Vector3<T>,
    (radius, curvature): (T, T),
) -> Option<(Vector3<T>, Vector3<T>)> {
    let inverse = T::one() / f.norm_squared();
    let foot = f.cross(&(m + f.cross(centre))) * (inverse * curvature);
    let squared = T::one() - foot.norm_squared();
    if squared < T::zero() {
        return None;
    }
    let normal = foot - f * (squared * inverse).root();
    Some((centre + normal * radius, normal))
}

/// The same for an ellipsoid.
#[inline]
fn ellipsoid_by_hand<T: Real>(
    (f, m): (Vector3<T>, Vector3<T>),
    semi_axes: &Vector3<T>,
    curvatures: &Vector3<T>,
) -> Option<(Vector3<T>, Vector3<T>)> {
    let direction = f.component_mul(curvatures);
    let squared = direction.norm_squared();
    let inverse = T::one() / (squared * f.norm_squared());
    let point = f.cross(&m).component_mul(curvatures);
    let foot = (point * squared - direction * point.dot(&direction)) * inverse;
    let remainder = T::one() - foot.norm_squared();
    if remainder < T::zero() {
        return None;
    }
    let scaled = foot - direction * (remainder / squared).root();
    let gradient = scaled.component_mul(curvatures);
    Some((scaled.component_mul(semi_axes), gradient * (T::one() / gradient.norm_squared().root())))
}

#[inline(never)]
fn all_by_hand<T: Real>(
    wrenches: &[Wrench<T>],
    found: &mut Found<T>,
    one: impl Fn((Vector3<T>, Vector3<T>)) -> Option<(Vector3<T>, Vector3<T>)>,
) {
    for (wrench, found) in wrenches.iter().zip(found) {
        if let Some(contact) = one((wrench.force(), wrench.torque())) {
            *found = contact;
        }
    }
}

#[inline(never)]
fn resolve_all<T: Real, S: ActiveSurface<T>>(
    model: &PointContact<T>,
    surface: &S,
    wrenches: &[Wrench<T>],
    found: &mut Found<T>,
) {
    for (wrench, found) in wrenches.iter().zip(found) {
        if let Resolution::Contact(Contact { point, normal, .. }) = model.resolve(wrench, surface) {
            // By components: as one block of memory they would be written, read and written again.
            *found = (Vector3::new(point.x, point.y, point.z), Vector3::new(normal.x, normal.y, normal.z));
        }
    }
}

fn point_contact<T: Real>(c: &mut Criterion, scalar: &str) {
    let l = T::literal;
    let model = PointContact::new(l(0.1)).unwrap();
    let small = wrenches::<T>(0.013);
    let mut group = c.benchmark_group(format!("point contact {scalar}"));
    group.throughput(Throughput::Elements(COUNT as u64));
    let radius = l(0.013);
    let mut found = vec![(Vector3::zeros(), Vector3::zeros()); COUNT];
    let (centre, size) = black_box((Vector3::zeros(), (radius, T::one() / radius)));
    group.bench_function("sphere by hand", |b| {
        b.iter(|| {
            all_by_hand(black_box(&small), black_box(&mut found), |w| sphere_by_hand(w, &centre, size));
        });
    });
    let semi_axes = black_box(Vector3::new(l(0.013), l(0.011), l(0.017)));
    let curvatures = semi_axes.map(|a| T::one() / a);
    group.bench_function("ellipsoid by hand", |b| {
        b.iter(|| {
            let one = |w| ellipsoid_by_hand(w, &semi_axes, &curvatures);
            all_by_hand(black_box(&small), black_box(&mut found), one);
        });
    });
    macro_rules! shape {
        ($name:literal, $shape:expr) => {
            let surface = $shape.unwrap();
            group.bench_function($name, |b| {
                b.iter(|| resolve_all(&model, &surface, black_box(&small), black_box(&mut found)));
            });
        };
    }
    let z = Vector3::z();
    let o = Vector3::zeros();
    shape!("sphere", Sphere::centred(radius));
    shape!("ellipsoid", Ellipsoid::new(Vector3::new(l(0.013), l(0.011), l(0.017))));
    shape!("cylinder", Cylinder::new(o, z, radius));
    shape!("plane", Plane::new(o, z));
    shape!("capped cylinder", CappedCylinder::new(o, z, radius, radius));
    shape!("capsule", Capsule::new(o, z, radius, l(0.02)));
    shape!("cone", Cone::new(z * l(0.02), -z, l(0.7)));
    shape!("frustum", Frustum::new(-z * radius, z, radius, l(0.004), l(0.026)));
    shape!("paraboloid", Paraboloid::new([radius, l(0.02)]));
    shape!("torus", Torus::new(radius, l(0.004)));
    shape!("rounded box", RoundedBox::new(Vector3::new(l(0.013), l(0.013), l(0.013)), l(0.003)));
    shape!("superquadric", Superquadric::new(Vector3::new(l(0.013), l(0.011), l(0.017)), [l(0.5), l(0.7)]));
    shape!(
        "offset ellipsoid",
        Ellipsoid::new(Vector3::new(l(0.013), l(0.011), l(0.017)))
            .and_then(|inner| Offset::new(inner, l(0.001)))
    );
    shape!(
        "revolution of 5 points",
        Revolution::from_profile([
            [l(-0.014), radius],
            [l(-0.006), radius],
            [l(0.004), l(0.012)],
            [l(0.010), l(0.008)],
            [l(0.014), l(0.0)],
        ])
    );
    group.finish();
}

fn batch<T: Real>(c: &mut Criterion, scalar: &str) {
    let mut columns = Columns::new(wrenches::<T>(0.013));
    let mut group = c.benchmark_group(format!("batch {scalar}"));
    group.throughput(Throughput::Elements(COUNT as u64));
    let l = T::literal;
    macro_rules! shape {
        ($name:literal, $shape:expr) => {
            let surface = $shape.unwrap();
            group.bench_function($name, |b| b.iter(|| columns.point_contacts(&surface)));
        };
    }
    shape!("sphere", Sphere::centred(l(0.013)));
    shape!("ellipsoid", Ellipsoid::new(Vector3::new(l(0.013), l(0.011), l(0.017))));
    shape!("plane", Plane::new(Vector3::zeros(), Vector3::z()));
    shape!("cylinder", Cylinder::new(Vector3::zeros(), Vector3::z(), l(0.013)));
    shape!("capsule", Capsule::new(Vector3::zeros(), Vector3::z(), l(0.013), l(0.02)));
    group.finish();
}

fn mesh<T: Real>(rings: u32, sectors: u32) -> Mesh<T> {
    let (vertices, triangles) = ball_of_triangles::<f32>(rings, sectors, None);
    let vertices: Vec<_> = vertices.iter().map(|v| v.map(|x| T::literal(f64::from(x)))).collect();
    Mesh::new(&vertices, &triangles).unwrap()
}

/// What is found is used, all of it: otherwise none would wait for the normals.
#[inline(never)]
fn all_crossings<T: Real>(mesh: &Mesh<T>, lines: &[Line<T>]) -> T {
    let mut sum = T::zero();
    for line in lines {
        mesh.crossings(line, |c| sum += c.along + c.point.x + c.normal.x);
    }
    sum
}

/// Balls of more and more triangles, crossed by the same lines: they may take no longer than the logarithm
/// of the number grows.
fn meshes<T: Real>(c: &mut Criterion, scalar: &str) {
    let mut group = c.benchmark_group(format!("mesh {scalar}"));
    let narrow = |v: Vector3<f64>| v.map(T::literal);
    let lines: Vec<Line<T>> = lines(1.0)
        .into_iter()
        .map(|line| Line { point: narrow(line.point), direction: narrow(line.direction) })
        .collect();
    for (rings, sectors) in [(50, 51), (100, 101), (224, 224), (707, 708)] {
        let mesh = mesh::<T>(rings, sectors);
        let count = mesh.triangle_count();
        // All over the mesh, so that the cache cannot hold what they need of a large one; and so few that
        // it can: what is computed, without what is waited for.
        for (name, lines) in [("", &lines[..]), (", in cache", &lines[..20])] {
            group.throughput(Throughput::Elements(lines.len() as u64));
            group.bench_function(format!("{count} triangles{name}"), |b| {
                b.iter(|| all_crossings(&mesh, black_box(lines)));
            });
        }
    }
    group.finish();
}

/// Point and normal where a line enters first, and the square of the cosine of incidence; without a
/// positive one it misses.
type First<T> = (Vector3<T>, Vector3<T>, T);

#[inline(always)]
fn first<T: Real>(surface: &impl ActiveSurface<T>, (push, line): &(ForceLine<T>, Line<T>)) -> First<T> {
    let keep = |entry: Entry<T>| (entry.point, entry.normal, entry.incidence_squared);
    if let Some(entry) = surface.shortcuts().sole_entry(push) {
        return keep(entry);
    }
    let mut first: Option<Crossing<T>> = None;
    surface.crossings(line, |c| {
        if first.is_none_or(|known| c.along < known.along) {
            first = Some(c);
        }
    });
    keep(first.map_or_else(Entry::none, |c| Entry::at(&c, &line.direction)))
}

/// One answer after the other is stored. Where nothing branches on what is found, the compiler takes
/// several lines at a time.
#[inline(never)]
fn first_of_all<T: Real>(
    surface: &impl ActiveSurface<T>,
    lines: &[(ForceLine<T>, Line<T>)],
    kept: &mut [First<T>],
) {
    for (line, kept) in lines.iter().zip(kept) {
        *kept = first(surface, line);
    }
}

/// The same, but the compiler does not see that there is a next line.
#[inline(never)]
fn first_of_each<T: Real>(
    surface: &impl ActiveSurface<T>,
    lines: &[(ForceLine<T>, Line<T>)],
    kept: &mut [First<T>],
) {
    for (line, kept) in lines.iter().zip(kept) {
        *kept = first(surface, black_box(line));
    }
}

/// Where each of the lines enters, as [`against_parry`] asks, for shapes of which parry has no like and in
/// both precisions.
fn entries<T: Real>(c: &mut Criterion, scalar: &str) {
    let lines: Vec<(ForceLine<T>, Line<T>)> = lines(0.013)
        .iter()
        .map(|line| Line { point: line.point.map(T::literal), direction: line.direction.map(T::literal) })
        .map(|line| (ForceLine::along(&line), line))
        .collect();
    let mut group = c.benchmark_group(format!("entries {scalar}"));
    group.throughput(Throughput::Elements(COUNT as u64));
    let mut kept = vec![(Vector3::zeros(), Vector3::zeros(), T::zero()); COUNT];
    macro_rules! shape {
        ($name:literal, $shape:expr) => {
            let surface = $shape.unwrap();
            group.bench_function($name, |b| {
                b.iter(|| first_of_all(&surface, black_box(&lines), black_box(&mut kept)));
            });
            group.bench_function(concat!($name, ", one at a time"), |b| {
                b.iter(|| first_of_each(&surface, black_box(&lines), black_box(&mut kept)));
            });
        };
    }
    let l = T::literal;
    shape!("sphere", Sphere::centred(l(0.013)));
    shape!("ellipsoid", Ellipsoid::new(Vector3::new(l(0.013), l(0.011), l(0.017))));
    group.finish();
}

/// By parry: position along the line, negative if it misses, and normal.
#[inline(never)]
fn first_of_all_by_parry(shape: &impl RayCast, rays: &[Ray], kept: &mut [(f32, parry3d::math::Vector)]) {
    for (ray, kept) in rays.iter().zip(kept) {
        *kept = shape
            .cast_local_ray_and_get_normal(ray, 100.0, true)
            .map_or((-1.0, ray.dir), |hit| (hit.time_of_impact, hit.normal));
    }
}

/// The first point at which a half-line meets a shape and the normal there, by both, in f32.
fn against_parry(c: &mut Criterion) {
    type Vector = parry3d::math::Vector;
    let lines = lines(1.0);
    let to = |v: &Vector3<f64>| Vector::new(v.x as f32, v.y as f32, v.z as f32);
    let rays: Vec<Ray> =
        lines.iter().map(|l| Ray::new(to(&(l.point - l.direction * 4.0)), to(&l.direction))).collect();
    let ours: Vec<Line<f32>> = rays
        .iter()
        .map(|ray| Line {
            point: Vector3::new(ray.origin.x, ray.origin.y, ray.origin.z),
            direction: Vector3::new(ray.dir.x, ray.dir.y, ray.dir.z),
        })
        .collect();
    // A line is to us what a ray is to them: known beforehand, with what each needs of it.
    let pushes: Vec<(ForceLine<f32>, Line<f32>)> =
        ours.iter().map(|line| (ForceLine::along(line), *line)).collect();
    let mut group = c.benchmark_group("against parry3d f32");
    group.throughput(Throughput::Elements(COUNT as u64));
    macro_rules! pair {
        ($name:literal, $ours:expr, $exact:expr, $theirs:expr) => {{
            let (surface, exact, theirs) = ($ours, $exact, $theirs);
            let (mut worst, mut worst_theirs, mut wrong, mut wrong_theirs) = (0.0_f64, 0.0_f64, 0, 0);
            let mut hits = 0;
            for (given, ray) in pushes.iter().zip(&rays) {
                let (_, line) = given;
                let wide = Line { point: line.point.cast::<f64>(), direction: line.direction.cast::<f64>() };
                let along = |point: Vector3<f64>| (point - wide.point).dot(&wide.direction);
                let (point, _, square) = first(&exact, &(ForceLine::along(&wide), wide));
                let truth = (square > 0.0).then(|| along(point));
                hits += i32::from(truth.is_some());
                let (point, _, square) = first(&surface, given);
                match (truth, square > 0.0) {
                    (Some(truth), true) => worst = worst.max((along(point.cast::<f64>()) - truth).abs()),
                    (truth, found) => wrong += i32::from(truth.is_some() != found),
                }
                match (truth, theirs.cast_local_ray(ray, 100.0, true)) {
                    (Some(truth), Some(t)) => worst_theirs = worst_theirs.max((f64::from(t) - truth).abs()),
                    (truth, found) => wrong_theirs += i32::from(truth.is_some() != found.is_some()),
                }
            }
            println!(
                "{:<10} {hits} of {COUNT} hit; greatest error along the line [m], size 1 m: ours {worst:.1e} \
                 ({wrong} wrongly hit or missed), parry3d {worst_theirs:.1e} ({wrong_theirs})",
                $name
            );
            let mut kept = vec![(Vector3::zeros(), Vector3::zeros(), 0.0); COUNT];
            group.bench_function(concat!($name, ", ours"), |b| {
                b.iter(|| first_of_all(&surface, black_box(&pushes), black_box(&mut kept)));
            });
            group.bench_function(concat!($name, ", ours, one at a time"), |b| {
                b.iter(|| first_of_each(&surface, black_box(&pushes), black_box(&mut kept)));
            });
            let mut kept = vec![(0.0, Vector::ZERO); COUNT];
            group.bench_function(concat!($name, ", parry3d"), |b| {
                b.iter(|| first_of_all_by_parry(&theirs, black_box(&rays), black_box(&mut kept)));
            });
        }};
    }
    use parry3d::shape;
    pair!(
        "ball",
        Sphere::centred(1.0_f32).unwrap(),
        Sphere::centred(1.0_f64).unwrap(),
        shape::Ball::new(1.0)
    );
    fn capsule<T: Real>() -> Capsule<T> {
        Capsule::new(Vector3::zeros(), Vector3::y(), T::literal(0.75), T::literal(0.5)).unwrap()
    }
    pair!("capsule", capsule::<f32>(), capsule::<f64>(), shape::Capsule::new_y(0.5, 0.75));
    fn cylinder<T: Real>() -> CappedCylinder<T> {
        CappedCylinder::new(Vector3::zeros(), Vector3::y(), T::literal(0.75), T::literal(0.5)).unwrap()
    }
    pair!("cylinder", cylinder::<f32>(), cylinder::<f64>(), shape::Cylinder::new(0.5, 0.75));
    fn cone<T: Real>() -> Frustum<T> {
        Frustum::new(Vector3::y() * T::literal(-0.5), Vector3::y(), T::literal(0.75), T::zero(), T::one())
            .unwrap()
    }
    pair!("cone", cone::<f32>(), cone::<f64>(), shape::Cone::new(0.5, 0.75));
    let (vertices, triangles) = ball_of_triangles::<f32>(50, 51, None);
    let points: Vec<Vector> = vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
    let hull = shape::ConvexPolyhedron::from_convex_mesh(points.clone(), &triangles).unwrap();
    pair!("convex", mesh::<f32>(50, 51), mesh::<f64>(50, 51), hull);
    let soup = shape::TriMesh::new(points, triangles).unwrap();
    pair!("mesh", mesh::<f32>(50, 51), mesh::<f64>(50, 51), soup);
    group.finish();
}

fn all(c: &mut Criterion) {
    point_contact::<f64>(c, "f64");
    point_contact::<f32>(c, "f32");
    batch::<f32>(c, "f32");
    batch::<f64>(c, "f64");
    entries::<f32>(c, "f32");
    entries::<f64>(c, "f64");
    against_parry(c);
    meshes::<f64>(c, "f64");
    meshes::<f32>(c, "f32");
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(core::time::Duration::from_millis(300))
        .measurement_time(core::time::Duration::from_secs(1))
        .sample_size(30);
    targets = all
}
criterion_main!(benches);
