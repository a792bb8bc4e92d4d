//! Balls around shapes, and what shapes say of themselves as a whole.

use fingertip_surfaces::*;
use fingertip_wrench::Line;
use nalgebra::Vector3;

use crate::every_shape::{approach, crossings, every_shape, v};

fn extent(surface: &impl SmoothSurface<f64>) -> ([f64; 3], f64) {
    let Extent { centre, radius } = surface.extent();
    (centre.into(), radius)
}

/// What is stated of shapes without an end, and the least balls of others.
#[test]
fn balls_are_the_stated_ones() {
    let at = v(1.0, -2.0, 0.5);
    let z = Vector3::z();
    let centre = [1.0, -2.0, 0.5];
    assert_eq!(extent(&Plane::new(at, z).unwrap()), (centre, 1.0));
    assert_eq!(extent(&Cone::new(at, z, 0.5).unwrap()), (centre, 1.0));
    assert_eq!(extent(&Cylinder::new(at, z, 0.25).unwrap()), (centre, 0.25));
    let open = Cylinder::new(at, z, 3.0).unwrap().with_half_length(4.0).unwrap();
    assert_eq!(extent(&open), (centre, 5.0));
    assert_eq!(extent(&Paraboloid::new([1.0, 2.0]).unwrap()), ([0.0; 3], 2.0));
    assert_eq!(extent(&Paraboloid::new([3.0, 2.0]).unwrap()), ([0.0; 3], 3.0));
    for semi_axes in [[3.0, 1.0], [1.0, 3.0]] {
        let of = |ends| extent(&EllipticCylinder::new(semi_axes, ends).unwrap()).1;
        let radii = [of(CylinderEnds::Unbounded), of(CylinderEnds::Open(4.0)), of(CylinderEnds::Capped(4.0))];
        assert_eq!(radii, [3.0, 5.0, 5.0]);
    }
    assert_eq!(extent(&Disk::new(at, z, 2.0).unwrap()), (centre, 2.0));
    let rectangle = Rectangle::new(at, Vector3::x() * 3.0, Vector3::y() * 4.0).unwrap();
    assert_eq!(extent(&rectangle), (centre, 5.0));
    assert_eq!(extent(&Sphere::new(at, 2.0).unwrap()), (centre, 2.0));
    assert_eq!(extent(&Ellipsoid::new(v(1.0, 3.0, 2.0)).unwrap()), ([0.0; 3], 3.0));
    assert_eq!(extent(&Capsule::new(at, z, 2.0, 1.0).unwrap()), (centre, 3.0));
    assert_eq!(extent(&Torus::new(2.0, 0.5).unwrap()), ([0.0; 3], 2.5));
    assert_eq!(extent(&RoundedBox::new(v(1.0, 2.0, 2.0), 0.5).unwrap()), ([0.0; 3], 3.0));
    assert_eq!(extent(&Frustum::new(at, z, 1.0, 3.0, 8.0).unwrap()), ([1.0, -2.0, 4.5], 5.0));
    assert_eq!(extent(&Frustum::new(at, z, 3.0, 1.0, 8.0).unwrap()), ([1.0, -2.0, 4.5], 5.0));
    let offset = Offset::new(Sphere::new(at, 2.0).unwrap(), -0.5).unwrap();
    assert_eq!(extent(&offset), (centre, 1.5));
    let hills = vec![0.0, 1.0, 3.0, 1.0, 0.0, -1.0];
    let field = Heightfield::new([1.0, -2.0], [2.0, 4.0], 3, hills).unwrap();
    assert_eq!(extent(&field), ([3.0, 0.0, 1.0], (4.0_f64 + 4.0 + 4.0).sqrt()));
}

/// The least ball around two balls.
#[test]
fn two_balls_are_held_by_the_least() {
    let ball = |x: f64, radius: f64| Sphere::new(v(x, 1.0, 0.0), radius).unwrap();
    for (one, other, (centre, radius)) in [
        ((0.0, 1.0), (4.0, 1.0), (2.0, 3.0)),
        ((0.0, 1.0), (3.0, 2.0), (2.0, 3.0)),
        ((0.0, 3.0), (1.0, 1.0), (0.0, 3.0)),
        ((0.0, 3.0), (2.0, 1.0), (0.0, 3.0)),
        ((0.0, 3.0), (2.5, 1.0), (0.25, 3.25)),
        ((0.0, 1.0), (0.0, 1.0), (0.0, 1.0)),
    ] {
        for (one, other) in [(one, other), (other, one)] {
            let (first, second) = (ball(one.0, one.1), ball(other.0, other.1));
            let found = [
                Compound::new(first, second).extent(),
                DynSurface::union(vec![first.into(), second.into()]).unwrap().extent(),
            ];
            for Extent { centre: at, radius: found } in found {
                assert!((at - v(centre, 1.0, 0.0)).norm() < 1e-15 && (found - radius).abs() < 1e-15);
            }
        }
    }
}

#[test]
fn shapes_say_whether_they_are_convex() {
    for shape in every_shape(1.0_f64) {
        let expected = match shape.name {
            "torus" => Topology::Closed { euler_characteristic: 0 },
            "waist" | "heightfield" | "mesh" | "compound" => Topology::Unknown,
            _ => Topology::Convex,
        };
        assert_eq!(shape.surface.topology(), expected, "{}", shape.name);
    }
    let offset = |distance| Offset::new(Torus::new(1.0, 0.25_f64).unwrap(), distance).unwrap().topology();
    assert_eq!(offset(0.125), Topology::Closed { euler_characteristic: 0 });
    assert_eq!(Offset::new(Sphere::centred(1.0_f64).unwrap(), 0.5).unwrap().topology(), Topology::Convex);
    let turned = |points: &[[f64; 2]]| Revolution::from_points(points).unwrap().topology();
    // A cylinder and a cone are convex, and so is a sphere, but for rounding.
    assert_eq!(turned(&[[0.0, 1.0], [1.0, 1.0], [3.0, 1.0]]), Topology::Convex);
    assert_eq!(turned(&[[0.0, 3.0], [1.0, 2.0]]), Topology::Convex);
    let ball: Vec<_> = (0..=6).map(|k| f64::from(k) / 3.0 - 1.0).map(|z| [z, (1.0 - z * z).sqrt()]).collect();
    assert_eq!(turned(&ball), Topology::Convex);
    assert_eq!(turned(&[[0.0, 1.0], [1.0, 0.9999], [2.0, 1.0]]), Topology::Unknown);
}

/// A side that is straight up is told from the ends, wherever rounding has put a point.
#[test]
fn sides_and_ends_of_a_tube_are_told_apart() {
    let tube = Revolution::from_points(&[[-1.0, 1.0], [0.5, 1.0], [1.0, 1.0]]).unwrap();
    let [x, z] = [Vector3::<f64>::x(), Vector3::z()];
    for hair in [-1e-9, 0.0, 1e-9] {
        for height in [-0.9, -0.3, 0.0, 0.7, 0.99] {
            assert_eq!(tube.normal(&(x * (1.0 + hair) + z * height)), x, "{hair} {height}");
        }
        for aside in [0.0, 0.4, 0.9] {
            assert_eq!(tube.normal(&(x * aside + z * (1.0 + hair))), z);
            assert_eq!(tube.normal(&(x * aside - z * (1.0 + hair))), -z);
        }
    }
    // A line along the axis crosses the ends and nothing else.
    for aside in [0.0, 0.3, 0.9, 1.1] {
        for direction in [z, -z] {
            let found = crossings(&tube, &Line { point: x * aside, direction });
            assert_eq!(found.len(), if aside < 1.0 { 2 } else { 0 }, "{found:?}");
            assert!(found.iter().all(|c| c.point.z.abs() == 1.0 && !c.active));
        }
    }
}

/// A line over a field that is as steep as the line meets nothing.
#[test]
fn a_line_along_a_slope_meets_nothing() {
    for slope in [0.0_f64, 0.5] {
        let heights = (0..12).map(|k| slope * f64::from(k % 4)).collect();
        let field = Heightfield::new([0.0, 0.0], [1.0, 1.0], 4, heights).unwrap();
        let direction = v(1.0, 0.0, slope).normalize();
        for over in [-0.25_f64, 0.25, 5.0] {
            let line = Line { point: v(0.5, 0.75, 0.5 * slope + over), direction };
            assert_eq!(crossings(&field, &line), vec![]);
            let away = over.abs() * direction.x;
            // Under a field it is nearer to a side, or not.
            let gap = approach(&field, &line).gap;
            assert!((gap - away).abs() < 1e-14, "{slope} {over} {gap}");
        }
    }
}
