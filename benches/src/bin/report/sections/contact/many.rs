//! Soft fingers on meshes of more and more triangles, and contacts of many wrenches at once.

use core::hint::black_box;

use fingertip_contact::batch::BatchSurface;
use fingertip_contact::{ContactModel, Resolution, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::testing::ball_of_triangles;
use fingertip_surfaces::{Capsule, Cone, Cylinder, Ellipsoid, Mesh, Sphere};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::columns::Columns;
use super::study::{Errors, SCALE, SPIN, Study, Touch, soft_exactly};
use crate::Failure;
use crate::reference::{distance, point_contact};
use crate::stability::big::{Big3, big3, cross, dot};
use crate::stability::contacts::pressing;
use crate::stability::levels::Level;
use crate::timing::{Effort, time};

/// A name, and the circles of latitude and of longitude of a ball of so many triangles.
pub(super) const MESHES: [(&str, u32, u32); 3] =
    [("mesh of 320", 9, 20), ("mesh of 5000", 50, 51), ("mesh of 82000", 203, 203)];

/// The contact on the plane of a facet, exactly: `c = a + N × m_a/(f·N)` with the torque about the corner `a`.
fn on_facet<T: Real>(corners: [Vector3<T>; 3], wrench: &Wrench<T>) -> Big3 {
    let exactly = |v: Vector3<T>| big3(v.map(Real::to_f64).into());
    let [a, b, c] = corners.map(exactly);
    let (force, torque) = (exactly(wrench.force()), exactly(wrench.torque()));
    let minus = |x: &Big3, y: &Big3| [0, 1, 2].map(|k| &x[k] - &y[k]);
    let normal = cross(&minus(&b, &a), &minus(&c, &a));
    let slope = dot(&force, &normal);
    let across = cross(&normal, &minus(&torque, &cross(&a, &force)));
    [0, 1, 2].map(|k| &a[k] + &(&across[k] / &slope))
}

/// Touches with spin in the facets of a ball, which one takes its size of.
pub(super) fn on_meshes<T: Real>(study: &mut Study<'_>) -> Result<(), Failure> {
    let model = SoftFinger::new(T::zero())?;
    let size = 2.0 * SCALE;
    for (name, rings, sectors) in MESHES.into_iter().take(study.effort.choose(2, 3)) {
        let (ball, triangles) = ball_of_triangles::<T>(rings, sectors, None);
        let vertices: Vec<Vector3<T>> = ball.iter().map(|vertex| vertex * T::literal(SCALE)).collect();
        let mesh = Mesh::new(&vertices, &triangles)?;
        let mut random = Pcg64Mcg::seed_from_u64(14);
        let touches: Vec<_> = (0..study.effort.choose(16, 256))
            .map(|_| {
                let corners =
                    triangles[random.random_range(0..triangles.len())].map(|k| vertices[k as usize]);
                let [a, b, c] = corners.map(|corner| corner.map(Real::to_f64));
                let [u, v] = [0; 2].map(|_| random.random_range(0.1..0.4));
                let (point, normal) = (a + (b - a) * u + (c - a) * v, (b - a).cross(&(c - a)).normalize());
                let force = pressing(&normal, random.random_range(0.5..1.0), &mut random) * 2.0;
                let spin = SPIN * 2.0 * size * random.random_range(-1.0..1.0);
                (corners, Touch { point, force, normal, spin }.wrench::<T>(true, 0.0, size, &mut random))
            })
            .collect();
        let errors = Errors::of(touches.iter().map(|(corners, wrench)| {
            let Resolution::Contact(found) = model.resolve(wrench, &mesh) else { return None };
            Some(distance(&found.point, &on_facet(*corners, wrench)) / size)
        }));
        let timed = time(study.effort, touches.len(), || {
            for (_, wrench) in &touches {
                black_box(&model.resolve(black_box(wrench), &mesh));
            }
        });
        study.push(name, "soft finger", "spin", errors, Some(timed));
    }
    Ok(())
}

/// Touches all over a shape.
fn touches<T: Real>(effort: Effort, level: Level, spins: bool) -> Columns<T> {
    let size = level.size(SCALE);
    let mut random = Pcg64Mcg::seed_from_u64(15);
    // No multiple of a page, whose columns would compete for the lines of the cache.
    let touches = (0..effort.choose(72, 1000)).map(|_| {
        let (point, normal) = level.sample(&mut random, SCALE);
        let force = pressing(&normal, random.random_range(0.5..1.0), &mut random) * 2.0;
        let spin = if spins { SPIN * 2.0 * size * random.random_range(-1.0..1.0) } else { 0.0 };
        let touch = Touch { point, force, normal, spin };
        (touch, touch.wrench(spins, 0.0, size, &mut random))
    });
    Columns::new(touches.collect(), size)
}

/// Point contacts as columns.
fn batch<T: Real>(study: &mut Study<'_>, name: &'static str, surface: &impl BatchSurface<T>, level: Level) {
    let mut columns = touches(study.effort, level, false);
    let timed = time(study.effort, columns.touches.len(), || columns.point_contacts(surface));
    let enters = |[.., gap]: [T; 7]| gap.is_zero();
    let errors = columns.errors(enters, |touch, wrench| point_contact(level, wrench, &touch.point));
    study.push(name, "point contact, batch", "force", errors, Some(timed));
}

/// Soft fingers as columns.
fn soft_batch<T: Real>(
    study: &mut Study<'_>,
    name: &'static str,
    surface: &impl SoftFingerSurface<T>,
    level: Level,
) -> Result<(), Failure> {
    let model = SoftFinger::new(T::zero())?;
    let mut columns = touches(study.effort, level, true);
    let timed = time(study.effort, columns.touches.len(), || columns.soft_contacts(&model, surface));
    let has_normal = |[_, _, _, nx, ny, nz, _]: [T; 7]| Vector3::new(nx, ny, nz) != Vector3::zeros();
    let exact = |touch: &Touch, wrench: &Wrench<T>| soft_exactly(level, touch, wrench, columns.size);
    let errors = columns.errors(has_normal, exact);
    study.push(name, "soft finger, batch", "spin", errors, Some(timed));
    Ok(())
}

/// On shapes with a closed form.
pub(super) fn batches<T: Real>(study: &mut Study<'_>) -> Result<(), Failure> {
    let (l, scale) = (T::literal, SCALE);
    let rounded = |x: f64| l(x * scale).to_f64();
    let (o, z) = (Vector3::zeros(), Vector3::z());
    macro_rules! both {
        ($name:literal, $shape:expr, $level:expr) => {
            let (shape, level) = ($shape, $level);
            batch(study, $name, &shape, level);
            soft_batch(study, $name, &shape, level)?;
        };
    }
    let radius = rounded(1.0);
    both!("sphere", Sphere::<T>::centred(l(scale))?, Level::Sphere { radius });
    let semi_axes = [1.0, 0.7, 0.4].map(rounded);
    both!("ellipsoid", Ellipsoid::new(Vector3::from(semi_axes.map(l)))?, Level::Ellipsoid { semi_axes });
    both!("cylinder", Cylinder::new(o, z, l(scale))?, Level::Cylinder { radius });
    let capsule = Capsule::new(o, z, l(scale), l(1.5 * scale))?;
    both!("capsule", capsule, Level::Capsule { half_length: rounded(1.5), radius });
    let half_angle = l(HALF_ANGLE).to_f64();
    both!("cone", Cone::new(o, -z, l(half_angle))?, Level::Cone { half_angle });
    Ok(())
}

/// Of the cone \[rad\].
const HALF_ANGLE: f64 = 0.7;
