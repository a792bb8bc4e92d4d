//! Shapes that are given by an equation.

use fingertip_wrench::Real;
use nalgebra::{Matrix3, Vector3};

use super::smooth_surface::hessian_by_differences;
use crate::{Extent, Implicit, ImplicitSurface, Level, SmoothSurface, Topology};

/// An [`ImplicitSurface`] of which more is known. Nothing is required: the defaults take second
/// derivatives from differences of the gradient, and assume nothing about the surface.
///
/// To say [`Topology::Convex`] of a convex surface makes a soft-finger contact a hundred times
/// faster.
pub trait SmoothImplicit<T: Real>: ImplicitSurface<T> {
    /// Second derivatives of the value.
    fn hessian(&self, point: &Vector3<T>) -> Matrix3<T> {
        let step = self.bounds().radius * T::EPSILON.cbrt();
        hessian_by_differences(point, step, |p| self.gradient(p))
    }

    /// What is known of the surface as a whole.
    fn topology(&self) -> Topology {
        Topology::Unknown
    }
}

impl<T: Real, S: SmoothImplicit<T>> SmoothSurface<T> for Implicit<S> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let inner = self.inner();
        Level { value: inner.value(point), gradient: inner.gradient(point), hessian: inner.hessian(point) }
    }

    fn extent(&self) -> Extent<T> {
        let bounds = self.inner().bounds();
        Extent { centre: bounds.centre, radius: bounds.radius }
    }

    fn topology(&self) -> Topology {
        self.inner().topology()
    }
}
