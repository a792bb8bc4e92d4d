//! The surfaces that a scene can name, placed in the sensor frame, and how each is drawn flat.

mod cap;
mod projection;

pub(crate) use cap::Capped;
pub(crate) use projection::{MapKind, Projection};

use fingertip::surfaces::{Cylinder, DynSurface, Plane, Posed, Sphere};

/// A surface in the sensor frame. The choice is made once per file: what runs per sample is
/// generic over the shape (see [`crate::analyze`]).
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Plane(Plane<f64>),
    Sphere(Capped<Sphere<f64>>),
    Cylinder(Cylinder<f64>),
    /// Any other; which one is looked up at every call.
    Other(Box<Posed<f64, DynSurface<f64>>>),
}
