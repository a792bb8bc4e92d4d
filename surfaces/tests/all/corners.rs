//! Edges and tips: which way an edge runs and how fast it bends, and curvature beside them.

use fingertip_surfaces::*;
use fingertip_wrench::RigidTransform;
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::every_shape::v;

type Point = Vector3<f64>;

/// A circle or an ellipse in space, `centre + a·cos + b·sin`, the rim of a flat end.
#[derive(Clone, Copy)]
struct Rim {
    centre: Point,
    a: Point,
    b: Point,
    /// Outward, across the end.
    end: Point,
}

impl Rim {
    fn at(&self, angle: f64) -> Point {
        self.centre + self.a * angle.cos() + self.b * angle.sin()
    }

    /// Unit vector along it, and the change of that per length: the curve's second derivative.
    fn turns(&self, angle: f64) -> (Point, Point) {
        let rate = -self.a * angle.sin() + self.b * angle.cos();
        let second = -self.a * angle.cos() - self.b * angle.sin();
        let along = rate.normalize();
        (along, (second - along * second.dot(&along)) / rate.norm_squared())
    }

    /// Out of the rim, in the plane of the end.
    fn outward(&self, angle: f64) -> Point {
        let (along, bent) = self.turns(angle);
        let across = along.cross(&self.end);
        if across.dot(&bent) > 0.0 { -across } else { across }
    }
}

fn is_its_edge(name: &str, surface: &impl SmoothSurface<f64>, rim: &Rim, side: impl Fn(f64) -> Point) {
    for k in 0..12 {
        let angle = 0.1 + 0.5 * f64::from(k);
        let (point, (along, bent)) = (rim.at(angle), rim.turns(angle));
        // Of the side, of the end, and between them, where the normal turns.
        let (side, end) = (side(angle), rim.end);
        let e1 = along;
        for part in [0.2, 0.5, 0.8] {
            let normal = (side * part + end * (1.0 - part)).normalize();
            let Some(Corner::Edge { direction, bend }) = surface.corner(&point, &normal) else {
                panic!("{name} {angle}")
            };
            assert!((direction.dot(&along).abs() - 1.0).abs() < 1e-12, "{name} {angle}: {direction} {along}");
            assert!((direction.norm() - 1.0).abs() < 1e-14);
            let expected = -normal.dot(&bent);
            assert!((bend - expected).abs() < 1e-9 * bent.norm(), "{name} {angle}: {bend} {expected}");
            let tangents = surface.bend(&point, &normal, [&e1, &normal.cross(&e1)]);
            assert!(tangents.iter().any(|x| x.is_nan()), "{name} {angle}: {tangents}");
        }
        // The end is flat, the side bends around the axis only as far as it is told.
        let inward = point - rim.outward(angle) * 1e-3;
        assert!(surface.bend(&inward, &end, [&e1, &end.cross(&e1)]).norm() < 1e-12, "{name} {angle}");
        assert!(surface.shape_operator(&inward).norm() < 1e-12, "{name} {angle}");
        let below = point - side.cross(&along) * (1e-3 * side.cross(&along).dot(&end).signum());
        let operator = surface.shape_operator(&below);
        let across = side.cross(&along);
        let expected = Matrix2::new(along.dot(&(operator * along)), 0.0, 0.0, 0.0);
        let found = surface.bend(&below, &side, [&along, &across]);
        assert!(
            (found - expected).norm() < 1e-6 * found.norm() && found.m11 > 0.0,
            "{name}: {found} {expected}"
        );
        let [one, other] = [-1e-6, 1e-6].map(|step| surface.normal(&(below + along * step)));
        let by_differences = (other - one).dot(&along) / 2e-6;
        assert!((found.m11 - by_differences).abs() < 1e-3 * found.m11, "{name}: {found} {by_differences}");
    }
}

#[test]
fn rims_run_and_bend_as_circles_and_ellipses_do() {
    let at = v(0.3, -0.2, 0.1);
    let axis = v(1.0, 2.0, -2.0) / 3.0;
    let (e1, e2) = (v(2.0, 1.0, 2.0) / 3.0, v(-2.0, 2.0, 1.0) / 3.0);
    let frustum = Frustum::new(at, axis, 0.75, 0.5, 2.0).unwrap();
    let taper = 0.25 / 2.0;
    let slanted = |angle: f64| (e1 * angle.cos() + e2 * angle.sin() + axis * taper).normalize();
    let rim = |height: f64, radius: f64| Rim {
        centre: at + axis * height,
        a: e1 * radius,
        b: e2 * radius,
        end: axis * (height - 1.0).signum(),
    };
    is_its_edge("top", &frustum, &rim(2.0, 0.5), slanted);
    is_its_edge("base", &frustum, &rim(0.0, 0.75), slanted);
    let cylinder = CappedCylinder::new(at + axis, axis, 0.5, 1.0).unwrap();
    let straight = |angle: f64| e1 * angle.cos() + e2 * angle.sin();
    is_its_edge("cylinder", &cylinder, &rim(2.0, 0.5), straight);
    for [a, b] in [[1.0, 0.5], [0.25, 1.5]] {
        let elliptic = EllipticCylinder::new([a, b], CylinderEnds::Capped(0.5)).unwrap();
        let normal = |angle: f64| v(angle.cos() / a, angle.sin() / b, 0.0).normalize();
        for up in [1.0, -1.0] {
            let z = Vector3::z() * up;
            let rim = Rim { centre: z * 0.5, a: v(a, 0.0, 0.0), b: v(0.0, b, 0.0), end: z };
            is_its_edge("elliptic", &elliptic, &rim, normal);
        }
    }
    let pose = RigidTransform::from_axis_angle(v(0.3, -0.4, 0.5), v(1.0, 0.0, -1.0)).unwrap();
    let moved = Rim {
        centre: pose.transform_point(&rim(2.0, 0.5).centre),
        a: pose.rotate(&(e1 * 0.5)),
        b: pose.rotate(&(e2 * 0.5)),
        end: pose.rotate(&axis),
    };
    is_its_edge("posed", &Posed::new(frustum, pose), &moved, |angle| pose.rotate(&slanted(angle)));
    let all = HalfSpace::new(v(0.0, 0.0, -9.0), Vector3::z()).unwrap();
    is_its_edge("trimmed", &Trimmed::new(frustum, all), &rim(2.0, 0.5), slanted);
    let far = Sphere::new(v(9.0, 9.0, 9.0), 1.0).unwrap();
    is_its_edge("compound", &Compound::new(frustum, far), &rim(2.0, 0.5), slanted);
    is_its_edge("compound", &Compound::new(far, frustum), &rim(0.0, 0.75), slanted);
    let parts = DynSurface::union(vec![far.into(), frustum.into()]).unwrap();
    is_its_edge("parts", &parts, &rim(2.0, 0.5), slanted);
}

#[test]
fn tips_are_tips() {
    let at = v(0.3, -0.2, 0.1);
    let (down, z) = (-Vector3::z(), Vector3::z());
    let cone = Cone::new(at, down, 0.5).unwrap();
    assert_eq!(cone.corner(&at, &z), Some(Corner::Tip));
    let closed = Frustum::new(at - z, z, 0.5, 0.0, 1.0).unwrap();
    assert_eq!(closed.corner(&at, &z), Some(Corner::Tip));
    let widening = Frustum::new(at, z, 0.0, 0.5, 1.0).unwrap();
    assert_eq!(widening.corner(&at, &down), Some(Corner::Tip));
    assert_eq!(Posed::new(cone, RigidTransform::identity()).corner(&at, &z), Some(Corner::Tip));
    // None of those that are smooth knows of one.
    assert_eq!(Sphere::centred(1.0).unwrap().corner(&z, &z), None);
    assert_eq!(Torus::new(1.0, 0.5).unwrap().corner(&v(1.5, 0.0, 0.0), &Vector3::x()), None);
}

/// Over an edge or a tip, a parallel surface bends as a ring or a ball around it does.
#[test]
fn parallel_surfaces_are_round_over_edges() {
    let z = Vector3::z();
    let distance = 0.25;
    let cylinder =
        Offset::new(CappedCylinder::new(Vector3::zeros(), z, 1.0, 0.5).unwrap(), distance).unwrap();
    for angle in [0.3_f64, 0.8, 1.2] {
        let normal = Vector3::x() * angle.cos() + z * angle.sin();
        let place = Vector3::x() + z * 0.5 + normal * distance;
        // A torus of ring radius 1 around the rim: 1/r across, cos θ/(R + r cos θ) around.
        let around = Vector3::y();
        let across = normal.cross(&around);
        let expected = across * across.transpose() / distance
            + around * around.transpose() * (angle.cos() / (1.0 + distance * angle.cos()));
        let level = cylinder.level(&place);
        assert!((level.hessian - expected).norm() < 1e-12, "{angle}: {} {expected}", level.hessian);
        assert!(level.value.abs() < 1e-15 && (level.gradient - normal).norm() < 1e-14);
    }
    let cone = Offset::new(Frustum::new(-z, z, 1.0, 0.0, 1.0).unwrap(), distance).unwrap();
    let normal = v(0.2, 0.1, 1.0).normalize();
    let expected = (Matrix3::identity() - normal * normal.transpose()) / distance;
    assert!((cone.level(&(normal * distance)).hessian - expected).norm() < 1e-12);
    // Over the corner of a box, whose edges are not told, by differences.
    let corner = Offset::new(RoundedBox::new(v(1.0, 1.0, 1.0), 0.0).unwrap(), distance).unwrap();
    let normal = v(0.5, 0.6, 0.7).normalize();
    let level = corner.level(&(v(1.0, 1.0, 1.0) + normal * distance));
    let expected = (Matrix3::identity() - normal * normal.transpose()) / distance;
    assert!((level.hessian - expected).norm() < 1e-6, "{} {expected}", level.hessian);
    // Pressed in, a cylinder is one of less radius.
    let thin = Offset::new(CappedCylinder::new(Vector3::zeros(), z, 1.0, 0.5).unwrap(), -distance).unwrap();
    let level = thin.level(&v(0.75, 0.0, 0.1));
    let expected = Vector3::y() * Vector3::y().transpose() / 0.75;
    assert!((level.hessian - expected).norm() < 1e-12 && level.value.abs() < 1e-15, "{level:?}");
}
