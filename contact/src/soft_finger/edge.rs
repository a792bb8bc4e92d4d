//! A straight side or the edge that ends it, where rounding decides.

use fingertip_surfaces::LocalSurface;
use fingertip_surfaces::numeric::vectors::wide;
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use super::patch::Digits;
use super::placed::placed;
use super::refined::{answers, rounding_moves, scaled, settled};
use super::sure_rim::{Rim, next_to_rim};
use super::three::rounded;
use super::tip::is_found_anew;
use crate::{Search, SoftContact};

/// How far a normal may be from that of the side for it to be one that rounding made of it.
const HAIR: f64 = 1e-6;

/// What a search says of a solid with a straight side, found anew with twice the digits where it is on an edge with all but
/// the side's normal.
///
/// Where a force `f` presses on a straight side at a flat angle under a spin torque `τ`, rounding moves the contact along the
/// side by `(τ/(R f·n))²` times itself, and so past its end, on whose edge it is found then; its normal leans from that of the
/// side by no more than `ℓ f·n/τ`, `ℓ` being how far past. A convex body has one contact: if with twice the digits there is one
/// on the side, the one on the edge is none.
///
/// `side` is unbounded; of a place of it is asked whether it is on an edge, and whether it is between the ends; all in the frame
/// of the shape, of which the pose is told, too. A narrower type is answered in double precision, and a number that carries more than a value keeps what
/// was found.
pub(crate) fn surely_on_side<T: Real>(
    wrench: &Wrench<T>,
    pose: Option<&RigidTransform<T>>,
    side: LocalSurface,
    is_on_edge: impl Fn(&Vector3<T>) -> bool,
    holds: impl Fn(&Vector3<T>) -> bool,
    found: Result<SoftContact<T>, Search<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    if !is_found_anew::<T>() {
        return found;
    }
    let contact = found?;
    let Some(patch) = placed(side.into(), pose) else { return Ok(contact) };
    let point = wide(&contact.point);
    let normal = rounded(patch.seen::<f64>(point.into()).normal);
    let off = (normal - wide(&contact.normal)).amax();
    if !(off <= HAIR) || !is_on_edge(&patch.point_inside(&point).map(T::literal)) {
        return Ok(contact);
    }
    let normal = normal.map(T::literal);
    let spin_torque = wrench.torque_about(&contact.point).dot(&normal);
    let near = SoftContact { normal, spin_torque, ..contact };
    let settled = settled(wrench, &|_| Some(patch), &near);
    let is_there =
        |contact: &SoftContact<T>| holds(&patch.point_inside(&wide(&contact.point)).map(T::literal));
    Ok(settled.filter(is_there).unwrap_or(contact))
}

/// What a search says of a solid with a straight side, found anew with twice the digits where it is on the side, and rounding
/// may have moved it there from beyond an end: then it is on the edge.
///
/// The other way round than [`surely_on_side`]. `room` is how far the contact is from the nearer end, and `rim` that edge.
pub(crate) fn surely_beyond_side<T: Real>(
    wrench: &Wrench<T>,
    pose: Option<&RigidTransform<T>>,
    side: LocalSurface,
    holds: impl Fn(&Vector3<T>) -> bool,
    (room, rim): (f64, Rim),
    contact: SoftContact<T>,
) -> SoftContact<T> {
    let Some(patch) = placed(side.into(), pose) else { return contact };
    let (point, normal) = (wide(&contact.point), wide(&contact.normal));
    let (scale, [force, torque]) = scaled(wrench);
    let seen = patch.seen::<f64>(point.into());
    let (strength, spin) = (force.norm(), contact.spin_torque.to_f64().abs() * scale);
    let answers = answers(seen.curvatures, spin, strength, -force.dot(&normal) / strength);
    let moved = rounding_moves(T::EPSILON.to_f64(), point.amax(), torque.amax(), answers);
    if !((rounded(seen.normal) - normal).amax() <= HAIR && room <= moved) {
        return contact;
    }
    let is_beyond = settled(wrench, &|_| Some(patch), &contact)
        .is_some_and(|end| !holds(&patch.point_inside(&wide(&end.point)).map(T::literal)));
    if is_beyond { next_to_rim(wrench, pose, &rim, &contact).unwrap_or(contact) } else { contact }
}
