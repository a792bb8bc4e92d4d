//! How a contact gives way under its own load.

use fingertip_wrench::Real;
use nalgebra::{Matrix6, Vector2, Vector6};

use super::{ContactJacobian, GeometrySensitivity};

/// How the surface under a contact sinks with it.
///
/// A contact through a skin lies on the parallel surface at the depth `δ` below the undeformed one, and
/// there it is a rigid one, of which the derivatives `L` of the six local numbers by the wrench are known,
/// and the answer `a` to a surface that moves outward ([`GeometrySensitivity::offset`]). But the depth
/// follows the contact: `dδ = r·y` for the six local numbers `y`, with `r` from the skin's law. So
/// `dy = L dw − a dδ`, which is solved by `dδ = r·L dw/(1 + r·a)`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub(super) struct Sinking<T: Real> {
    /// `a`.
    pub(super) answer: Vector6<T>,
    /// `r/(1 + r·a)`.
    pub(super) feedback: Vector6<T>,
    pub(super) depth: T,
}

impl<T: Real> Sinking<T> {
    /// How fast the depth grows with the wrench, from what a rigid contact would do.
    #[inline]
    pub(super) fn deeper(&self, rigid: &Matrix6<T>) -> Vector6<T> {
        rigid.tr_mul(&self.feedback)
    }
}

impl<T: Real> ContactJacobian<T> {
    /// The change of the surface on which the contact lies, from that of the undeformed surface: through a
    /// skin these are not the same, as a turn `t` of the normal moves the parallel surface at the depth `δ`
    /// by `−δ t` along itself. Without a skin they are. (Moving and turning as a whole, taken at the
    /// contact, are changes of the deformed surface already.)
    ///
    /// A law that differs from place to place is supposed to keep its place in space.
    #[must_use]
    pub fn of_deformed(&self, change: &GeometrySensitivity<T>) -> GeometrySensitivity<T> {
        let Some(sinking) = &self.sinking else { return *change };
        let [e1, e2] = &self.tangents;
        let turned = self.bend * Vector2::new(e1.dot(&change.tilt), e2.dot(&change.tilt)) * sinking.depth;
        GeometrySensitivity { tilt: change.tilt + e1 * turned.x + e2 * turned.y, ..*change }
    }
}
