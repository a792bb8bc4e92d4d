//! What a skin does under a force.

use fingertip_wrench::Real;

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

/// Depth and patch as functions of the normal force alone.
///
/// # For implementers
/// Depth and patch shall be finite, not negative and not falling with the force, and the depth
/// zero at a force of zero. The force given is finite and not negative.
pub trait StiffnessLaw<T: Real> {
    /// The indentation under a normal force \[N\].
    fn indentation(&self, normal_force: T) -> Indentation<T>;
}

/// Depth and patch where they also depend on the place: on the curvature, or on a skin that is
/// thicker here than there. What [`Compliant`](crate::Compliant) takes; every law of ours is one.
pub trait SkinLaw<T: Real, S> {
    /// The indentation under a contact on the undeformed surface that presses with a normal force
    /// \[N\].
    fn indentation_at(&self, surface: &S, contact: &Contact<T>, normal_force: T) -> Indentation<T>;
}

/// The same law everywhere. (A blanket implementation would shut out laws that depend on the
/// place.)
macro_rules! same_everywhere {
    ($law:ident $(, $parameter:ident)?) => {
        impl<T: Real, S $(, const $parameter: usize)?> SkinLaw<T, S> for $law<T $(, $parameter)?> {
            #[inline]
            fn indentation_at(&self, _surface: &S, _contact: &Contact<T>, normal_force: T) -> Indentation<T> {
                self.indentation(normal_force)
            }
        }
    };
}

same_everywhere!(Hertz);
same_everywhere!(LinearStiffness);
same_everywhere!(PowerLaw);
same_everywhere!(Tabulated, N);
