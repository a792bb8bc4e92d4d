//! What a skin does under a force.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::{Hertz, LinearStiffness, PowerLaw, Tabulated};
use crate::Contact;

/// How a skin gives way to a normal force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Indentation<T: Real> {
    /// How far the skin and what presses on it approach each other \[m\].
    pub depth: T,
    /// Semi-axes of the contact patch, the longer first \[m\].
    pub patch: [T; 2],
}

/// The derivative at a positive number, from central differences.
fn slope<T: Real>(at: T, of: impl Fn(T) -> T) -> T {
    let step = at * T::EPSILON.cube_root();
    let (high, low) = (at + step, at - step);
    (of(high) - of(low)) / (high - low)
}

/// How the depth of an indentation changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndentationSlope<T: Real> {
    /// With the normal force \[m/N\].
    pub by_force: T,
    /// From place to place, per metre along the undeformed surface: a vector in the tangent plane.
    pub along: Vector3<T>,
}

/// Depth and patch under a normal force, which may also depend on the place: on the curvature, or on a skin
/// that is thicker here than there. What [`Compliant`](crate::Compliant) takes.
///
/// # For implementers
/// Depth and patch shall be finite, not negative and not falling with the force, and the depth
/// zero at a force of zero. The force given is finite and not negative.
pub trait SkinLaw<T: Real, S> {
    /// The indentation under a contact on the undeformed surface that presses with a normal force
    /// \[N\].
    fn indentation_at(&self, surface: &S, contact: &Contact<T>, normal_force: T) -> Indentation<T>;

    /// How the depth changes with force and place: what the covariance of a contact needs. The default
    /// takes differences over the force and supposes that the place does not matter.
    fn slope_at(&self, surface: &S, contact: &Contact<T>, normal_force: T) -> IndentationSlope<T> {
        let by_force = slope(normal_force, |force| self.indentation_at(surface, contact, force).depth);
        IndentationSlope { by_force, along: Vector3::zeros() }
    }
}

/// The same law everywhere. (A blanket implementation would shut out laws that depend on the
/// place.)
macro_rules! same_everywhere {
    ($law:ident $(, $points:ident)?) => {
        impl<T: Real, S $(, $points: AsRef<[[T; 3]]>)?> SkinLaw<T, S> for $law<T $(, $points)?> {
            #[inline]
            fn indentation_at(&self, _surface: &S, _contact: &Contact<T>, normal_force: T) -> Indentation<T> {
                self.indentation(normal_force)
            }

            #[inline]
            fn slope_at(
                &self,
                _surface: &S,
                _contact: &Contact<T>,
                normal_force: T,
            ) -> IndentationSlope<T> {
                IndentationSlope { by_force: self.compliance(normal_force), along: Vector3::zeros() }
            }
        }
    };
}

same_everywhere!(Hertz);
same_everywhere!(LinearStiffness);
same_everywhere!(PowerLaw);
same_everywhere!(Tabulated, P);
