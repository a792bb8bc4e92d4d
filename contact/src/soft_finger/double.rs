//! The second opinion of double precision.

use fingertip_surfaces::numeric::fine_pose::FinePose;
use fingertip_surfaces::numeric::mixed_precision::is_asked_again;
use fingertip_surfaces::numeric::vectors::{length, wide};
use fingertip_wrench::{Real, RigidTransform, Wrench};

use super::closed_form::is_steady_under;
use crate::{Search, SoftContact};

/// What a search says, asked again in double precision if the type is narrower and the answer hangs by
/// its last digits.
pub(crate) fn finely<T: Real>(
    found: Result<SoftContact<T>, Search<T>>,
    is_steady: impl FnOnce(&SoftContact<T>) -> bool,
    wrench: &Wrench<T>,
    again: impl FnOnce(&Wrench<f64>) -> Option<Result<SoftContact<f64>, Search<f64>>>,
) -> Result<SoftContact<T>, Search<T>> {
    if !is_asked_again::<T>() || found.as_ref().is_ok_and(is_steady) {
        return found;
    }
    match again(&widened(wrench)) {
        Some(Ok(contact)) => Ok(narrow(&contact)),
        Some(Err(pair @ Search::Grazing(_))) => Err(in_type(pair)),
        // There is none, or double precision does not find it; what the rounding of the wrench could make of it is for the
        // narrower type to say.
        Some(Err(Search::Complete | Search::Incomplete | Search::Uncertified)) => {
            found.and(Err(Search::Incomplete))
        }
        None => found,
    }
}

/// Whether the spin torque of a contact is not more than the force has at a lever of this length: beyond it
/// the torque rules, and rounding decides.
pub(crate) fn spins_little<T: Real>(wrench: &Wrench<T>, lever: T) -> impl Fn(&SoftContact<T>) -> bool {
    let torque = length(&wrench.force()) * lever;
    move |contact| contact.spin_torque.abs() <= torque
}

/// Whether besides that the force presses at no flat angle, which multiplies rounding too.
pub(crate) fn is_steady<T: Real>(wrench: &Wrench<T>, lever: T) -> impl Fn(&SoftContact<T>) -> bool {
    let (force, strength) = (wrench.force(), length(&wrench.force()));
    move |contact| is_steady_under(&force, strength, contact, lever)
}

/// Contacts of a shape in a pose by those of the shape, under the wrench that has them there
/// (`docs/theory/contact.md#shapes-in-a-pose`).
pub(crate) struct Moved(FinePose);

impl Moved {
    pub(crate) fn new<T: Real>(pose: &RigidTransform<T>) -> Self {
        Self(FinePose::new(pose))
    }

    fn outside(&self, contact: &SoftContact<f64>) -> SoftContact<f64> {
        let (normal, share) = self.0.normal_outside(&contact.normal);
        let (point, spin_torque) = (self.0.point_outside(&contact.point), contact.spin_torque * share);
        SoftContact { point, normal, spin_torque, active: contact.active }
    }

    fn ended(&self, search: Search<f64>) -> Search<f64> {
        match search {
            Search::Grazing(pair) => Search::Grazing(pair.map(|point| self.0.point_outside(&point))),
            ended => ended,
        }
    }

    /// Of a shape that has but one.
    pub(crate) fn sole(
        &self,
        wrench: &Wrench<f64>,
        of_shape: impl FnOnce(&Wrench<f64>) -> Option<Result<SoftContact<f64>, Search<f64>>>,
    ) -> Option<Result<SoftContact<f64>, Search<f64>>> {
        let found = of_shape(&self.0.wrench_inside(wrench))?;
        Some(found.map(|contact| self.outside(&contact)).map_err(|search| self.ended(search)))
    }

    /// Of any shape.
    pub(crate) fn all(
        &self,
        wrench: &Wrench<f64>,
        of_shape: impl FnOnce(&Wrench<f64>, &mut dyn FnMut(SoftContact<f64>)) -> Option<Search<f64>>,
        visit: &mut dyn FnMut(SoftContact<f64>),
    ) -> Option<Search<f64>> {
        let search = of_shape(&self.0.wrench_inside(wrench), &mut |contact| visit(self.outside(&contact)))?;
        Some(self.ended(search))
    }
}

/// A wrench in double precision.
pub(crate) fn widened<T: Real>(wrench: &Wrench<T>) -> Wrench<f64> {
    Wrench::on_fingertip(wide(&wrench.force()), wide(&wrench.torque()))
}

/// How a search ended, in the narrower type.
pub(crate) fn in_type<T: Real>(search: Search<f64>) -> Search<T> {
    match search {
        Search::Grazing(pair) => Search::Grazing(pair.map(|point| point.map(T::literal))),
        Search::Complete => Search::Complete,
        Search::Uncertified => Search::Uncertified,
        Search::Incomplete => Search::Incomplete,
    }
}

/// A contact in the narrower type.
pub(crate) fn narrow<T: Real>(contact: &SoftContact<f64>) -> SoftContact<T> {
    SoftContact {
        point: contact.point.map(T::literal),
        normal: contact.normal.map(T::literal),
        spin_torque: T::literal(contact.spin_torque),
        active: contact.active,
    }
}
