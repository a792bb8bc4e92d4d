//! A general implicit surface, with analytic second derivatives. The benches share this file.

use fingertip_surfaces::{ImplicitSurface, Term, Topology};
use fingertip_wrench::Real;
use nalgebra::{Matrix3, Vector3};

/// `x⁴ + y⁴ + z⁴ + (x² + y² + z²)/2 = 1` in units of 10 mm, declared convex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pillow;

impl<T: Real> ImplicitSurface<T> for Pillow {
    fn formula(&self, point: [Term<T>; 3]) -> Term<T> {
        let [x, y, z] = point.map(|x| (x * T::literal(100.0)).square());
        let quartic = x.square() + y.square() + z.square();
        (quartic + (x + y + z) * T::literal(0.5) - T::one()) * T::literal(0.5)
    }

    fn ball(&self) -> (Vector3<T>, T) {
        (Vector3::zeros(), T::literal(0.0121))
    }

    fn steepest(&self) -> Option<T> {
        Some(T::literal(420.0))
    }

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

    fn hessian(&self, p: &Vector3<T>) -> Matrix3<T> {
        let q = p * T::literal(100.0);
        Matrix3::from_diagonal(&q.map(|x| (x * x * T::literal(6.0) + T::literal(0.5)) * T::literal(1e4)))
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}
