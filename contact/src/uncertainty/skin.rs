//! First derivatives of a contact through a skin.

use fingertip_surfaces::SmoothSurface;
use fingertip_surfaces::numeric::vectors::tangents;
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix2, Vector2, Vector3, Vector6};

use super::sinking::Sinking;
use super::{ContactJacobian, GeometrySensitivity};
use crate::{CompliantContact, CompliantPointContact, CompliantSoftFinger, IndentationSlope, SkinLaw};

/// The parallel surface that a skin deforms to, at the contact.
struct Deformed<T: Real> {
    tangents: [Vector3<T>; 2],
    depth: T,
    /// Its shape operator in the tangent plane, `W (1 − δW)⁻¹`.
    bend: Matrix2<T>,
    /// From a way on it to that on the undeformed surface, `(1 − δW)⁻¹`.
    spread: Matrix2<T>,
}

impl<T: Real> Deformed<T> {
    /// `None` where the parallel surface has no curvature: as deep as the undeformed one is round, or on
    /// an edge of it.
    fn at<S: SmoothSurface<T>>(found: &CompliantContact<T>, surface: &S) -> Option<Self> {
        let normal = found.contact.normal;
        let (e1, e2) = tangents(&normal);
        let depth = (found.undeformed - found.contact.point).dot(&normal);
        let bend = surface.bend(&found.undeformed, &normal, [&e1, &e2]);
        let spread = (Matrix2::identity() - bend * depth).try_inverse()?;
        let deformed = bend * spread;
        let mixed = (deformed.m12 + deformed.m21) * T::literal(0.5);
        let bend = Matrix2::new(deformed.m11, mixed, mixed, deformed.m22);
        bend.sum().is_number().then_some(Self { tangents: [e1, e2], depth, bend, spread })
    }

    /// `rigid` is the contact on the parallel surface.
    fn sinking(&self, rigid: ContactJacobian<T>, slope: &IndentationSlope<T>) -> Option<ContactJacobian<T>> {
        let [e1, e2] = &self.tangents;
        let along = self.spread.tr_mul(&Vector2::new(slope.along.dot(e1), slope.along.dot(e2)));
        let (zero, by_force) = (T::zero(), slope.by_force);
        let row = Vector6::new(along.x, along.y, by_force, zero, zero, zero);
        let answer = rigid.answer_to(&GeometrySensitivity::offset());
        let feedback = row / (T::one() + row.dot(&answer));
        let good = (feedback.sum() + answer.sum()).is_number();
        let mut jacobian = rigid;
        jacobian.sinking = Some(Sinking { answer, feedback, depth: self.depth });
        good.then_some(jacobian)
    }
}

impl<T: Real, L> CompliantSoftFinger<T, L> {
    /// The first derivatives of a contact that this model found on a surface. `None` where they do not
    /// exist, as [`ContactJacobian::of_soft_finger_on`] says, and where the skin gives way without end or
    /// is as deep as the surface is round.
    ///
    /// Covariances and worst cases follow as for a rigid contact. The height along the normal varies too,
    /// [`ContactJacobian::height`].
    #[must_use]
    pub fn jacobian<S>(&self, found: &CompliantContact<T>, surface: &S) -> Option<ContactJacobian<T>>
    where
        L: SkinLaw<T, S>,
        S: SmoothSurface<T>,
    {
        let deformed = Deformed::at(found, surface)?;
        let rigid = ContactJacobian::soft_finger_bent(&found.contact, |_, _| deformed.bend)?;
        deformed.sinking(rigid, &self.slope(found, surface))
    }
}

impl<T: Real, L> CompliantPointContact<T, L> {
    /// The first derivatives of a contact that this model found in a wrench on a surface. `None` as for
    /// [`CompliantSoftFinger::jacobian`].
    #[must_use]
    pub fn jacobian<S>(
        &self,
        found: &CompliantContact<T>,
        wrench: &Wrench<T>,
        surface: &S,
    ) -> Option<ContactJacobian<T>>
    where
        L: SkinLaw<T, S>,
        S: SmoothSurface<T>,
    {
        let deformed = Deformed::at(found, surface)?;
        let ([e1, e2], bend) = (deformed.tangents, deformed.bend);
        let shape_operator = (e1 * bend.m11 + e2 * bend.m21) * e1.transpose()
            + (e1 * bend.m12 + e2 * bend.m22) * e2.transpose();
        let rigid = ContactJacobian::of_point_contact(&found.contact, wrench, &shape_operator)?;
        deformed.sinking(rigid, &self.slope(found, surface))
    }
}
