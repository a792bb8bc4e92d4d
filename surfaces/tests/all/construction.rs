//! What constructors take, to the last number, and what they refuse.

use fingertip_surfaces::*;
use nalgebra::Vector3;

use crate::every_shape::v;

const LEAST: f64 = f64::MIN_POSITIVE;
const GREATEST: f64 = 1.0 / f64::MIN_POSITIVE;
/// `√ε`, a power of two.
const THIN: f64 = 1.0 / 67_108_864.0;

/// Takes the first numbers, the last of which differs from one that is refused by rounding, and not the others.
#[track_caller]
fn takes<S>(make: impl Fn(f64) -> Result<S, BadShape>, good: &[f64], bad: &[f64], parameter: &str) {
    for x in good {
        assert!(make(*x).is_ok(), "{x:e}: {}", make(*x).err().unwrap());
    }
    for x in bad {
        let refused = make(*x).err().unwrap_or_else(|| panic!("{x:e} as {parameter}"));
        assert_eq!(refused.parameter, parameter, "{x:e}: {refused}");
        assert!(refused.to_string().contains(refused.shape) && !refused.requirement.is_empty());
    }
}

#[track_caller]
fn takes_lengths<S>(make: impl Fn(f64) -> Result<S, BadShape>, parameter: &str) {
    let bad = [LEAST.next_down(), GREATEST.next_up(), 0.0, -1.0, f64::NAN, f64::INFINITY];
    takes(make, &[LEAST, 1e-3, 1.0, GREATEST], &bad, parameter);
}

fn o() -> Vector3<f64> {
    Vector3::zeros()
}

#[test]
fn lengths_are_normal_numbers_with_a_reciprocal() {
    let z = Vector3::z();
    takes_lengths(Sphere::centred, "radius");
    takes_lengths(|r| Disk::new(o(), z, r), "radius");
    takes_lengths(|r| Cylinder::new(o(), z, r), "radius");
    takes_lengths(|h| Cylinder::new(o(), z, 1.0).and_then(|c| c.with_half_length(h)), "half length");
    takes_lengths(|r| Capsule::new(o(), z, r, 1.0), "radius");
    takes_lengths(|h| Capsule::new(o(), z, 1.0, h), "half length");
    takes_lengths(|d| Cone::new(o(), z, 0.5).and_then(|c| c.with_depth(d)), "depth");
    takes_lengths(|d| Paraboloid::new([1.0, 1.0]).and_then(|p| p.with_depth(d)), "depth");
    for ends in [CylinderEnds::Open, CylinderEnds::Capped] {
        takes_lengths(|h| EllipticCylinder::new([1.0, 1.0], ends(h)), "half length");
    }
    let bad = [LEAST.next_down(), GREATEST.next_up(), 0.0, f64::NAN, f64::INFINITY];
    let good = [LEAST, 1.0, GREATEST, -GREATEST];
    takes(|x| Rectangle::new(o(), v(x, 0.0, 0.0), Vector3::y()), &good, &bad, "first half edge");
    takes(|x| Rectangle::new(o(), Vector3::y(), v(x, 0.0, 0.0)), &good, &bad, "second half edge");
    takes_lengths(|x| Heightfield::new([0.0; 2], [1.0, x], 2, vec![0.0; 4]), "spacing");
    takes_lengths(|x| Heightfield::new([0.0; 2], [x, 1.0], 2, vec![0.0; 4]), "spacing");
    let offset = |distance| Offset::new(Sphere::centred(1.0).unwrap(), distance);
    takes(offset, &[(-1.0_f64).next_up(), 0.0, 1e300], &[-1.0, -2.0, 1e308], "size left");
    takes(offset, &[], &[f64::NAN, f64::INFINITY, f64::NEG_INFINITY], "distance");
}

#[test]
fn a_shape_keeps_within_the_range_of_the_type() {
    let at = |x: f64| Sphere::new(v(x, 0.0, 0.0), GREATEST);
    takes(at, &[0.0, 1e308], &[f64::MAX, -f64::MAX, f64::NAN], "centre");
    let frustum = |h: f64| Frustum::new(o(), Vector3::z(), 1e10, 1.0, h);
    takes(frustum, &[1e-290, 1.0], &[1e-300], "height");
    for make in
        [|r| Frustum::new(o(), Vector3::z(), r, 0.5, 1.0), |r| Frustum::new(o(), Vector3::z(), 0.5, r, 1.0)]
    {
        assert!(make(0.0).is_ok() && make(LEAST).is_ok());
        assert!([-0.5, LEAST.next_down(), f64::NAN].iter().all(|r| make(*r).is_err()));
    }
    assert_eq!(Frustum::new(o(), Vector3::z(), 0.0, 0.0, 1.0).unwrap_err().parameter, "greater radius");
}

#[test]
fn semi_axes_may_be_so_far_apart() {
    let good = [THIN, 1.0, 1.0 / THIN];
    let bad = [THIN.next_down(), (1.0 / THIN).next_up()];
    for k in 0..3 {
        let axes = |x: f64| {
            let mut axes = Vector3::repeat(1.0);
            axes[k] = x;
            axes
        };
        takes(|x| Ellipsoid::new(axes(x)), &good, &bad, "semi-axes");
        takes(|x| Superquadric::new(axes(x), [1.0, 1.0]), &good, &bad, "semi-axes");
    }
    takes(|x| EllipticCylinder::new([x, 1.0], CylinderEnds::Unbounded), &good, &bad, "semi-axes");
    takes(|x| EllipticCylinder::new([1.0, x], CylinderEnds::Unbounded), &good, &bad, "semi-axes");
    takes(|x| Paraboloid::new([x, 1.0]), &good, &bad, "radii of curvature");
    takes(|x| Paraboloid::new([1.0, x]), &good, &bad, "radii of curvature");
}

#[test]
fn proportions_have_their_bounds() {
    let cap = |cosine| SphericalCap::new(Sphere::centred(2.0).unwrap(), Vector3::z(), cosine);
    takes(cap, &[-1.0, 0.0, 1.0_f64.next_down()], &[1.0, (-1.0_f64).next_down(), f64::NAN], "least cosine");
    let opening = |r| SphericalCap::with_opening(Sphere::centred(2.0).unwrap(), Vector3::z(), r);
    takes(opening, &[0.0, 1.0, 2.0], &[2.0_f64.next_up(), -LEAST, f64::NAN], "opening");
    let fractions = [0.0, 1.2, 2.0].map(|r| opening(r).unwrap().active_fraction());
    assert!(fractions.iter().zip([1.0, 0.9, 0.5]).all(|(found, exact)| (found - exact).abs() < 1e-15));
    takes(|t| Torus::new(1.0, t), &[0.5, 1.0_f64.next_down()], &[1.0, 2.0], "tube radius");
    let rounded = |r| RoundedBox::new(v(1.0, 0.5, 2.0), r);
    takes(rounded, &[0.0, 0.25, 0.5], &[0.5_f64.next_up(), -LEAST, f64::NAN], "rounding radius");
    for exponents in [|e| [e, 1.0], |e| [1.0, e]] {
        let shaped = |e| Superquadric::new(v(1.0, 1.0, 1.0), exponents(e));
        let bad = [0.05_f64.next_down(), 2.0_f64.next_up(), -1.0, f64::NAN];
        takes(shaped, &[0.05, 1.0, 2.0], &bad, "exponents");
    }
    let right = core::f64::consts::FRAC_PI_2;
    let cone = |angle| Cone::new(o(), Vector3::z(), angle);
    // The sine of so small an angle is the angle.
    let bad = [THIN.next_down(), 0.0, -0.5, right, right - THIN * 0.5, right + 1.0, 7.0, f64::NAN];
    takes(cone, &[THIN, 0.5, right - THIN * 2.0], &bad, "half angle");
    let steep = |x| Rectangle::new(o(), Vector3::x(), v(x, 1.0, 0.0));
    takes(steep, &[0.0, -1e-8, 1e-8], &[1e-7, -1e-7, 1.0], "second half edge");
}

#[test]
fn places_and_directions_are_numbers() {
    let bad = [v(f64::NAN, 0.0, 0.0), v(0.0, f64::INFINITY, 0.0), v(0.0, 0.0, f64::NEG_INFINITY)];
    let z = Vector3::z();
    for at in bad {
        assert_eq!(Plane::new(at, z).unwrap_err().parameter, "point");
        assert_eq!(Disk::new(at, z, 1.0).unwrap_err().shape, "disk");
        assert_eq!(HalfSpace::new(at, z).unwrap_err().parameter, "point");
        assert_eq!(Cylinder::new(at, z, 1.0).unwrap_err().parameter, "centre");
        assert_eq!(Capsule::new(at, z, 1.0, 1.0).unwrap_err().parameter, "centre");
        assert_eq!(Cone::new(at, z, 0.5).unwrap_err().parameter, "apex");
        assert_eq!(Frustum::new(at, z, 1.0, 1.0, 1.0).unwrap_err().parameter, "base centre");
        assert_eq!(CappedCylinder::new(at, z, 1.0, 1.0).unwrap_err().shape, "capped cylinder");
        let edges = (Vector3::x(), Vector3::y());
        assert_eq!(Rectangle::new(at, edges.0, edges.1).unwrap_err().shape, "rectangle");
    }
    for axis in bad.into_iter().chain([o()]) {
        assert_eq!(Plane::new(o(), axis).unwrap_err().parameter, "normal");
        assert_eq!(HalfSpace::new(o(), axis).unwrap_err().parameter, "inward direction");
        assert_eq!(Cylinder::new(o(), axis, 1.0).unwrap_err().parameter, "axis");
        assert_eq!(Capsule::new(o(), axis, 1.0, 1.0).unwrap_err().parameter, "axis");
        assert_eq!(Cone::new(o(), axis, 0.5).unwrap_err().parameter, "axis");
        assert_eq!(
            SphericalCap::new(Sphere::centred(1.0).unwrap(), axis, 0.0).unwrap_err().parameter,
            "pole"
        );
    }
    // A direction of any length has one.
    for size in [5e-324, 1e-200, 1e200] {
        let plane = Plane::new(o(), v(0.0, size, 0.0)).unwrap();
        assert_eq!(plane.outward(), Vector3::y());
    }
}

#[test]
fn profiles_are_curves_beside_the_axis() {
    let of = |points: &[[f64; 2]]| Revolution::from_points(points);
    let refused = |points: &[[f64; 2]]| of(points).unwrap_err().requirement;
    assert_eq!(refused(&[]), "at least two points");
    assert_eq!(refused(&[[0.0, 1.0]]), "at least two points");
    assert_eq!(refused(&[[0.0, 1.0], [f64::NAN, 1.0]]), "finite");
    assert_eq!(refused(&[[0.0, 1.0], [1.0, f64::INFINITY]]), "finite");
    assert_eq!(refused(&[[0.0, -1e-9], [1.0, 1.0]]), "clear of the axis but for its ends");
    assert_eq!(refused(&[[0.0, 1.0], [1.0, 0.0], [2.0, 1.0]]), "clear of the axis but for its ends");
    assert_eq!(refused(&[[0.0, 1.0], [0.0, 1.0]]), "ascending in z");
    assert_eq!(refused(&[[0.0, 1.0], [1.0, 1.0], [0.5, 1.0]]), "ascending in z");
    assert_eq!(refused(&[[0.0, 0.0], [1.0, 0.0]]), "neither tiny nor huge");
    assert!(refused(&[[0.0, 1.0], [0.1, 0.01], [1.0, 1.0]]).starts_with("smooth"));
    assert!(refused(&[[0.0, 1.0], [0.9, 0.01], [1.0, 1.0]]).starts_with("smooth"));
    for good in [[[0.0, 0.0], [1.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]], [[-2.0, 1.0], [-1.0, 1.0]]] {
        assert!(of(&good).is_ok(), "{good:?}");
    }
    // The ranges in which squares of radii, and ε of them, are numbers.
    let [least, greatest] = [LEAST.sqrt() / f64::EPSILON, f64::MAX.sqrt() * f64::EPSILON];
    let sized = |r: f64| of(&[[0.0, r], [r, r]]);
    takes(sized, &[least, 1.0, greatest], &[least.next_down(), greatest.next_up()], "profile");
}

#[test]
fn grids_are_full() {
    let of = |columns, heights: &[f64]| Heightfield::new([0.0; 2], [1.0; 2], columns, heights.to_vec());
    assert_eq!(of(2, &[0.0; 4]).unwrap().size(), [2, 2]);
    assert_eq!(of(3, &[0.0; 12]).unwrap().size(), [3, 4]);
    for (columns, count) in [(0, 4), (1, 4), (2, 5), (2, 2), (4, 4), (5, 4), (2, 0)] {
        assert_eq!(of(columns, &vec![0.0; count]).unwrap_err().parameter, "grid", "{columns} {count}");
    }
    assert_eq!(of(2, &[0.0, 0.0, f64::NAN, 0.0]).unwrap_err().parameter, "corner and heights");
    let corner = Heightfield::new([0.0, f64::INFINITY], [1.0; 2], 2, vec![0.0; 4]);
    assert_eq!(corner.unwrap_err().parameter, "corner and heights");
}

/// A plane that slopes every way.
struct Slope {
    radius: f64,
    steepest: f64,
}

impl ImplicitSurface<f64> for Slope {
    fn formula(&self, [x, y, z]: [Term<f64>; 3]) -> Term<f64> {
        x * 0.6 + y * 0.64 + z * 0.48
    }

    fn ball(&self) -> (Vector3<f64>, f64) {
        (o(), self.radius)
    }

    fn steepest(&self) -> Option<f64> {
        Some(self.steepest)
    }
}

#[test]
fn equations_come_with_bounds() {
    takes_lengths(|radius| Implicit::new(Slope { radius, steepest: 2.0 }), "radius");
    let steep = |steepest| Implicit::new(Slope { radius: 1.0, steepest });
    // The plane's own is one.
    takes(steep, &[1.0 + 1e-9, 2.0, f64::MAX], &[0.99, 0.0, -1.0, f64::NAN, f64::INFINITY], "steepness");
}

/// A tetrahedron, its corners so far apart.
fn tetrahedron(size: f64) -> Result<Mesh<f64>, MeshError> {
    let corners = [o(), v(size, 0.0, 0.0), v(0.0, size, 0.0), v(0.0, 0.0, size)];
    Mesh::new(&corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
}

#[test]
fn meshes_are_of_any_size() {
    for size in [2.0 * LEAST, 1.0, GREATEST, 2.0 * GREATEST] {
        assert_eq!(tetrahedron(size).unwrap().triangle_count(), 4, "{size:e}");
    }
    for size in [LEAST, 1.5 * LEAST, (2.0 * GREATEST).next_up()] {
        assert_eq!(tetrahedron(size).unwrap_err(), MeshError::NoVolume, "{size:e}");
    }
}
