//! Lines that pass far away: by as much as is stated, over a place of the shape.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::every_shape::{approach, crossings, every_shape, l};

/// Whatever the distance, the gap is that from the origin but for the size of the shape.
fn gaps_are_distances<T: Real>(powers: [i32; 5]) {
    let mut random = Pcg64Mcg::seed_from_u64(51);
    for shape in every_shape::<T>(T::one()).iter().filter(|shape| shape.bounded) {
        // A mesh is searched by the squares of distances, as far as these are numbers.
        let is_told = |power: &i32| shape.name != "mesh" || l::<T>(10_f64.powi(2 * power)) < T::GREATEST;
        for power in powers.into_iter().filter(is_told) {
            for _ in 0..12 {
                let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize();
                let (aside, direction) = (any(), any());
                let aside = (aside - direction * aside.dot(&direction)).normalize();
                let distance = 10_f64.powi(power);
                let (unit, direction) = (aside.map(T::literal), direction.map(T::literal));
                let line = Line { point: unit * l::<T>(distance), direction };
                let found = approach(&shape.surface, &line);
                let off = (found.gap / l::<T>(distance) - T::one()).abs().to_f64();
                let name = shape.name;
                assert!(off <= 2.5 / distance + 16.0 * T::EPSILON.to_f64(), "{name} {power}: {found:?}");
                // Rounding moves a place by as much as it does the line.
                let rounding = l::<T>(16.0 * distance) * T::EPSILON;
                assert!(found.point.amax() <= rounding + l(2.5), "{name} {power}: {found:?}");
                assert!((found.normal.norm() - T::one()).abs() <= l::<T>(16.0) * T::EPSILON);
                if shape.closed && shape.told_by_normal {
                    // It faces the line.
                    let faces = found.normal.dot(&unit);
                    assert!(
                        faces > T::one() - l::<T>(4.0 / distance) - T::EPSILON.root(),
                        "{name} {power}: {found:?} {unit}"
                    );
                    // No place is farther out towards the line.
                    let reached =
                        found.point.dot(&unit) + l::<T>(4.0 / distance) + T::EPSILON.root() + rounding;
                    for _ in 0..20 {
                        let through = Line { point: Vector3::zeros(), direction: any().map(T::literal) };
                        let beyond = |c: &fingertip_surfaces::Crossing<T>| c.point.dot(&unit) > reached;
                        let other = crossings(&shape.surface, &through).into_iter().find(beyond);
                        assert!(other.is_none(), "{name} {power}: {found:?} {other:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn gaps_are_distances_in_double_precision() {
    gaps_are_distances::<f64>([2, 8, 20, 160, 300]);
}

#[test]
fn gaps_are_distances_in_single_precision() {
    gaps_are_distances::<f32>([2, 5, 10, 20, 37]);
}

/// Beside a shape without an end too: straight away from it, as far as is stated.
#[test]
fn endless_shapes_are_as_far() {
    for shape in every_shape::<f64>(1.0) {
        let across = match shape.name {
            "cylinder" | "elliptic cylinder" | "open elliptic cylinder" => [Vector3::x(), Vector3::y()],
            "plane" => [Vector3::z(), -Vector3::z()],
            _ => continue,
        };
        for unit in across {
            for power in [2, 8, 20, 160, 300] {
                let distance = 10_f64.powi(power);
                let along = if shape.name == "plane" { Vector3::x() } else { Vector3::z() };
                let found = approach(&shape.surface, &Line { point: unit * distance, direction: along });
                assert!(
                    (found.gap / distance - 1.0).abs() <= 1.0 / distance + 1e-15,
                    "{} {found:?}",
                    shape.name
                );
                assert!(found.point.norm() <= 2.5 && found.normal.norm() == 1.0, "{} {found:?}", shape.name);
            }
        }
    }
}
