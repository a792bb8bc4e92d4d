//! A general implicit surface, with analytic second derivatives. The benches share this file.

use fingertip_surfaces::{ImplicitBounds, ImplicitSurface, Topology};
use fingertip_wrench::Real;
use nalgebra::{Matrix3, Vector3};

/// `x⁴ + y⁴ + z⁴ + (x² + y² + z²)/2 = 1` in units of 10 mm, declared convex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pillow;

impl<T: Real> ImplicitSurface<T> for Pillow {
    fn value(&self, p: &Vector3<T>) -> T {
        let q = p.component_mul(p) * T::literal(1e4);
        (q.norm_squared() + q.sum() * T::literal(0.5) - T::one()) * T::literal(0.5)
    }

    fn gradient(&self, p: &Vector3<T>) -> Vector3<T> {
        let q = p * T::literal(100.0);
        (q.map(|x| x * x * x) * T::literal(2.0) + q * T::literal(0.5)) * T::literal(100.0)
    }

    /// In double precision, for a narrower type.
    fn value_left(&self, p: &Vector3<T>) -> T {
        if T::EPSILON.to_f64() <= f64::EPSILON {
            return T::zero();
        }
        T::literal(ImplicitSurface::<f64>::value(self, &p.map(Real::to_f64)))
    }

    fn bounds(&self) -> ImplicitBounds<T> {
        ImplicitBounds { centre: Vector3::zeros(), radius: T::literal(0.0121), steepest: T::literal(420.0) }
    }

    fn hessian(&self, p: &Vector3<T>) -> Matrix3<T> {
        let q = p * T::literal(100.0);
        Matrix3::from_diagonal(&q.map(|x| (x * x * T::literal(6.0) + T::literal(0.5)) * T::literal(1e4)))
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}
