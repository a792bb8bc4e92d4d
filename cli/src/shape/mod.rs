//! The surface of a scene, placed in the sensor frame, and how it is drawn flat.

mod projection;

pub(crate) use projection::{MapKind, Projection};

use fingertip::surfaces::{Cylinder, DynSurface, Plane, Posed, SphericalCap};

/// A surface in the sensor frame. The choice is made once per file, for the commonest shapes: what runs per
/// sample is generic over the shape (see [`crate::analyze`]).
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Plane(Plane<f64>),
    Sphere(SphericalCap<f64>),
    Cylinder(Cylinder<f64>),
    /// Any other; which one is looked up at every call.
    Other(Box<Posed<f64, DynSurface<f64>>>),
}
