//! The shapes of the crate beside their levels, in a stated size.

use fingertip_surfaces::{Capsule, Cone, Cylinder, Ellipsoid, Plane, Sphere, Superquadric, Torus};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::levels::Level;

/// What is done with each shape.
pub(crate) trait Visitor<T: Real> {
    fn shape<S: fingertip_surfaces::SmoothSurface<T> + fingertip_contact::SoftFingerSurface<T>>(
        &mut self,
        name: &'static str,
        surface: S,
        level: Level,
        scale: f64,
    );
}

/// Every smooth shape, with lengths near `scale` \[m\].
pub(crate) fn each<T: Real>(scale: f64, visitor: &mut impl Visitor<T>) {
    let l = T::literal;
    let rounded = |x: f64| l(x * scale).to_f64();
    let (o, z) = (Vector3::zeros(), Vector3::z());
    let surface = Plane::new(o, z).expect("a shape");
    visitor.shape("plane", surface, Level::Plane, scale);
    let surface = Sphere::centred(l(scale)).expect("a shape");
    visitor.shape("sphere", surface, Level::Sphere { radius: rounded(1.0) }, scale);
    for (name, axes) in [
        ("ellipsoid", [1.0, 0.7, 0.4]),
        ("needle 1:1000", [1.0, 1e-3, 1e-3]),
        ("pancake 1:1000", [1.0, 1.0, 1e-3]),
    ] {
        let semi_axes = axes.map(rounded);
        let surface = Ellipsoid::new(Vector3::from(semi_axes.map(l))).expect("a shape");
        visitor.shape(name, surface, Level::Ellipsoid { semi_axes }, scale);
    }
    let surface = Cylinder::new(o, z, l(scale)).expect("a shape");
    visitor.shape("cylinder", surface, Level::Cylinder { radius: rounded(1.0) }, scale);
    let surface = Capsule::new(o, z, l(scale), l(1.5 * scale)).expect("a shape");
    let level = Level::Capsule { half_length: rounded(1.5), radius: rounded(1.0) };
    visitor.shape("capsule", surface, level, scale);
    for (name, half_angle) in [("cone", 0.7), ("cone, needle", 1e-2), ("cone, flat", 1.55)] {
        let half_angle = l(half_angle).to_f64();
        let surface = Cone::new(o, -z, l(half_angle)).expect("a shape");
        visitor.shape(name, surface, Level::Cone { half_angle }, scale);
    }
    for (name, tube) in [("torus", 0.3), ("torus, thin", 1e-3)] {
        let surface = Torus::new(l(scale), l(tube * scale)).expect("a shape");
        visitor.shape(name, surface, Level::Torus { ring: rounded(1.0), tube: rounded(tube) }, scale);
    }
    for (name, exponents) in [
        ("superquadric", [0.5, 0.7]),
        ("superquadric, boxy", [0.1, 0.1]),
        ("superquadric, pointed", [1.9, 1.9]),
    ] {
        let exponents = exponents.map(|e| l(e).to_f64());
        let semi_axes = [1.0, 0.8, 1.3].map(rounded);
        let surface = Superquadric::new(Vector3::from(semi_axes.map(l)), exponents.map(l)).expect("a shape");
        visitor.shape(name, surface, Level::Superquadric { semi_axes, exponents }, scale);
    }
}
