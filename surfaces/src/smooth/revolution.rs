//! The surface of revolution.

use fingertip_wrench::Real;
use nalgebra::{Matrix3, Vector3};

use crate::{Extent, Knot, Level, Revolution, SmoothSurface, Topology};

/// `x² + y² − ρ²(z)`, piece by piece; beyond the ends of the profile `ρ²` goes on straight, which
/// keeps a convex profile convex. The curvature jumps where pieces meet; the flat ends are not part
/// of the level function.
impl<T: Real, K: AsRef<[Knot<T>]>> SmoothSurface<T> for Revolution<T, K> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let [squared, slope, curvature] = self.profile(point.z);
        let two = T::one() + T::one();
        Level {
            value: point.x * point.x + point.y * point.y - squared,
            gradient: Vector3::new(two * point.x, two * point.y, -slope),
            hessian: Matrix3::from_diagonal(&Vector3::new(two, two, -curvature)),
        }
    }

    fn extent(&self) -> Extent<T> {
        let (centre, radius) = self.bounds();
        Extent { centre, radius }
    }

    fn topology(&self) -> Topology {
        if self.is_convex() { Topology::Convex } else { Topology::Unknown }
    }
}
