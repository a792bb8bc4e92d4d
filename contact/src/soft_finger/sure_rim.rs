//! A contact on a circular edge, where rounding moves it along.

use fingertip_surfaces::LocalSurface;
use fingertip_surfaces::numeric::twofold::Twofold;
use fingertip_surfaces::numeric::vectors::wide;
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use super::placed::placed;
use super::refined::scaled;
use super::three::{Three, cross, dot, exactly, plus_times, rounded, unit};
use crate::SoftContact;

/// What of the torque holds the place, of what rounds, below which it is found anew: rounding moves it by itself over this, and
/// the spin torque, a small difference there, with it.
const HAIR: f64 = 0.02;

/// A circular edge, in the frame of its shape, around a point of the axis that lies so far along it from the origin: where that
/// is, said in double precision, would be rounded already.
pub(crate) struct Rim {
    pub(crate) origin: Vector3<f64>,
    pub(crate) axis: Vector3<f64>,
    pub(crate) along: f64,
    pub(crate) radius: f64,
}

impl Rim {
    fn centre(&self) -> Vector3<f64> {
        self.origin + self.axis * (self.along / self.axis.norm())
    }
}

/// A contact on an edge, found anew with twice the digits of double precision where rounding moves it along the edge.
///
/// With the torque `m` about the centre, the force `f`, the axis `a` and the tangent `t = a × ρ`, the place `R ρ` is where
/// `m·t + R f·a = 0` ([`on_rim`](super::rim::on_rim)). Going along the edge by an angle changes that by `m·ρ` times it, which is
/// the part of `M = τ n` along `ρ`: little where the spin torque is, and where the normal is along the axis and the two
/// solutions fall together. For double precision ([`is_found_anew`](super::tip::is_found_anew)).
pub(crate) fn surely_on_rim<T: Real>(
    wrench: &Wrench<T>,
    pose: Option<&RigidTransform<T>>,
    rim: &Rim,
    contact: SoftContact<T>,
) -> SoftContact<T> {
    anew(wrench, pose, rim, &contact, HAIR).unwrap_or(contact)
}

/// The contact on an edge next to one beside it. `None` if there is none.
pub(super) fn next_to_rim<T: Real>(
    wrench: &Wrench<T>,
    pose: Option<&RigidTransform<T>>,
    rim: &Rim,
    contact: &SoftContact<T>,
) -> Option<SoftContact<T>> {
    anew(wrench, pose, rim, contact, f64::INFINITY)
}

/// `None` where it is as found: the place is held by more than this share of the torque that rounds, or no place is near.
fn anew<T: Real>(
    wrench: &Wrench<T>,
    pose: Option<&RigidTransform<T>>,
    rim: &Rim,
    contact: &SoftContact<T>,
    most: f64,
) -> Option<SoftContact<T>> {
    let centre = rim.centre();
    let frame = placed(LocalSurface::Plane { point: centre, normal: rim.axis }.into(), pose)?;
    let (scale, load) = scaled(wrench);
    let point = wide(&contact.point);
    let from_centre = frame.point_inside(&point) - centre;
    let outward = from_centre - rim.axis * (from_centre.dot(&rim.axis) / rim.axis.norm_squared());
    let [inside, about] = frame.load_inside::<f64>(load).map(Vector3::from);
    let held = (about - centre.cross(&inside)).dot(&outward) / outward.norm();
    let [force, torque] = load;
    if !(held.abs() <= (torque.norm() + force.norm() * point.norm()) * most) {
        return None;
    }
    let (arm, spin, normal) = solved(rim, frame.load_inside(load), held)?;
    let point = frame.point_outside(&(centre + arm));
    let normal = frame.direction_outside(&normal);
    // Anything else is another contact.
    (normal.dot(&wide(&contact.normal)) > 0.5).then(|| SoftContact {
        point: point.map(T::literal),
        normal: normal.map(T::literal),
        spin_torque: T::literal(spin / scale),
        ..*contact
    })
}

/// Arm, spin torque and normal of the solution where `m·ρ` has the sign of `held`: with the tangent at an angle from the part of
/// the torque across the axis whose cosine is `−R f·a` over that part, and whose sine has the sign of `m·ρ`.
fn solved(
    rim: &Rim,
    [force, torque]: [Three<Twofold<f64>>; 2],
    held: f64,
) -> Option<(Vector3<f64>, f64, Vector3<f64>)> {
    let [one, minus, radius] = [1.0, -1.0, rim.radius].map(Twofold::new);
    let (_, axis) = unit(exactly(&rim.axis));
    let centre = plus_times(exactly(&rim.origin), axis, Twofold::new(rim.along));
    let torque = plus_times(torque, cross(centre, force), minus);
    let (length, along) = unit(plus_times(torque, axis, minus.times(dot(torque, axis))));
    let cosine = minus.times(radius).times(dot(force, axis)).divided_by(length);
    let squared = one.minus(cosine).times(one.plus(cosine));
    if !(squared.value() >= 0.0) {
        return None;
    }
    let sine = Twofold::new(1.0_f64.copysign(held)).times(squared.root());
    let tangent = plus_times(along.map(|x| x.times(cosine)), cross(axis, along), sine);
    let arm = cross(tangent, axis).map(|x| x.times(radius));
    let (spin, normal) = unit(plus_times(torque, cross(arm, force), minus));
    let sign = if dot(force, torque).value() > 0.0 { -1.0 } else { 1.0 };
    let (spin, normal) = (spin.value() * sign, rounded(normal) * sign);
    (spin + normal.sum()).is_number().then(|| (rounded(arm), spin, normal))
}
