//! Normals are unit vectors wherever a line comes from and wherever a shape lies.

use fingertip_surfaces::*;
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::every_shape::{crossings, every_shape, l};

fn is_unit<T: Real>(normal: &Vector3<T>) -> bool {
    let squared = normal.map(Real::to_f64).norm_squared();
    (squared - 1.0).abs() <= 16.0 * T::EPSILON.to_f64()
}

fn unit(random: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize()
}

/// Every normal that a shape tells of a line, by whichever way.
fn check<T: Real>(surface: &impl ActiveSurface<T>, line: &Line<T>, what: &str) -> usize {
    let found = crossings(surface, line);
    for crossing in &found {
        assert!(is_unit(&crossing.normal), "{what}: {line:?} {crossing:?}");
    }
    if let Some(entry) = surface.shortcuts().sole_entry(&ForceLine::along(line))
        && entry.incidence_squared > T::zero()
    {
        assert!(is_unit(&entry.normal), "{what}: {line:?} {entry:?}");
    }
    if found.is_empty()
        && let Some(approach) = surface.closest_approach(line)
    {
        assert!(is_unit(&approach.normal), "{what}: {line:?} {approach:?}");
    }
    found.len()
}

/// Lines whose own point is far away from every shape, and lines that meet endless shapes far out.
fn of_every_shape<T: Real>(powers: &[i32]) {
    let mut random = Pcg64Mcg::seed_from_u64(61);
    for shape in every_shape::<T>(l(0.013)) {
        let mut met = 0;
        for power in powers {
            for _ in 0..60 {
                let (away, aim) = (unit(&mut random) * 10_f64.powi(*power), unit(&mut random) * 0.01);
                let direction = unit(&mut random);
                let start = aim - direction * 10_f64.powi(*power);
                let line = Line { point: start.map(T::literal), direction: direction.map(T::literal) };
                met += check(&shape.surface, &line, shape.name);
                let line = Line { point: (aim + away).map(T::literal), direction: line.direction };
                check(&shape.surface, &line, shape.name);
                let out = Vector3::new(aim.x, aim.y, away.z);
                let line = Line { point: out.map(T::literal), direction: line.direction };
                met += check(&shape.surface, &line, shape.name);
            }
        }
        assert!(met > 40, "{}: {met}", shape.name);
    }
}

/// Shapes whose own place is far away from the origin about which torques are told.
fn of_far_shapes<T: Real>(powers: &[i32]) {
    let mut random = Pcg64Mcg::seed_from_u64(62);
    let mut met = 0;
    for power in powers {
        for _ in 0..400 {
            let centre = (unit(&mut random) * 10_f64.powi(*power)).map(T::literal);
            let axis = unit(&mut random).map(T::literal);
            let radius = l::<T>(random.random_range(0.003..0.03));
            let (direction, aim) = (unit(&mut random), unit(&mut random) * 0.002);
            // Of the line only what is nearest to the origin, as of a line of action.
            let through = centre.map(Real::to_f64) + aim;
            let foot = through - direction * through.dot(&direction);
            for point in [foot, through] {
                let line = Line { point: point.map(T::literal), direction: direction.map(T::literal) };
                met += check(&Sphere::new(centre, radius).unwrap(), &line, "sphere");
                met += check(&Cylinder::new(centre, axis, radius).unwrap(), &line, "cylinder");
            }
        }
    }
    assert!(met > 800, "{met}");
}

#[test]
fn normals_are_unit_vectors_in_double_precision() {
    of_every_shape::<f64>(&[0, 2, 4, 8, 12]);
    of_far_shapes::<f64>(&[-2, 0, 3, 8, 11]);
}

#[test]
fn normals_are_unit_vectors_in_single_precision() {
    of_every_shape::<f32>(&[0, 1, 2, 4]);
    of_far_shapes::<f32>(&[-2, 0, 2, 3]);
}
