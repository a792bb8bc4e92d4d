//! A contact on a circular edge, where rounding moves it along.

use fingertip_surfaces::LocalSurface;
use fingertip_surfaces::numeric::twofold::{Twofold, Wide};
use fingertip_surfaces::numeric::vectors::wide;
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use super::placed::{Patch, placed};
use super::refined::scaled;
use super::three::{Three, cross, dot, exactly, plus_times, rounded, unit};
use crate::SoftContact;

/// What of the torque holds the place, of what rounds, below which it is found anew: rounding moves it by itself over this, and
/// the spin torque, a small difference there, with it.
const HAIR: f64 = 0.02;

/// A circular edge, in the frame of its shape.
pub(crate) struct Rim {
    pub(crate) centre: Vector3<f64>,
    pub(crate) axis: Vector3<f64>,
    pub(crate) radius: f64,
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
    let plane = LocalSurface::Plane { point: rim.centre, normal: rim.axis };
    placed(plane.into(), pose).and_then(|frame| anew(wrench, &frame, rim, &contact)).unwrap_or(contact)
}

/// `None` where it is as found.
fn anew<T: Real>(
    wrench: &Wrench<T>,
    frame: &Patch,
    rim: &Rim,
    contact: &SoftContact<T>,
) -> Option<SoftContact<T>> {
    let (scale, load) = scaled(wrench);
    let point = wide(&contact.point);
    let outward = frame.point_inside(&point) - rim.centre;
    let found = Around::<f64>::of(rim, frame.load_inside(load));
    let sine = dot(cross(exactly(&rim.axis), exactly(&outward)), found.aside) / outward.norm();
    let [force, torque] = load;
    if !((found.length * sine).abs() <= (torque.norm() + force.norm() * point.norm()) * HAIR) {
        return None;
    }
    let surely = Around::<Twofold<f64>>::of(rim, frame.load_inside(load));
    let (arm, spin, normal) = surely.solved(rim.radius, sine)?;
    let point = frame.point_outside(&(rim.centre + arm));
    let normal = frame.direction_outside(&normal);
    // Anything else is another contact.
    (normal.dot(&wide(&contact.normal)) > 0.5).then(|| SoftContact {
        point: point.map(T::literal),
        normal: normal.map(T::literal),
        spin_torque: T::literal(spin / scale),
        ..*contact
    })
}

/// What tells where on the edge: the force, the torque about the centre, the length of what is across the axis of it, its
/// direction and the other, and the cosine of the angle of the tangent from it.
struct Around<W> {
    force: Three<W>,
    torque: Three<W>,
    axis: Three<W>,
    length: W,
    along: Three<W>,
    aside: Three<W>,
    cosine: W,
}

impl<W: Wide> Around<W> {
    fn of(rim: &Rim, [force, torque]: [Three<W>; 2]) -> Self {
        let minus = W::exactly(-1.0);
        let (_, axis) = unit(exactly(&rim.axis));
        let torque = plus_times(torque, cross(exactly(&rim.centre), force), minus);
        let (length, along) = unit(plus_times(torque, axis, minus.times(dot(torque, axis))));
        let cosine = minus.times(W::exactly(rim.radius)).times(dot(force, axis)).over(length);
        Self { force, torque, axis, length, along, aside: cross(axis, along), cosine }
    }

    /// Arm, spin torque and normal of the solution on this side.
    fn solved(self, radius: f64, side: f64) -> Option<(Vector3<f64>, f64, Vector3<f64>)> {
        let one = W::exactly(1.0);
        let squared = one.minus(self.cosine).times(one.plus(self.cosine));
        if !(squared.rounded() >= 0.0) {
            return None;
        }
        let sine = W::exactly(1.0_f64.copysign(side)).times(squared.root());
        let none = [W::exactly(0.0); 3];
        let tangent = plus_times(plus_times(none, self.along, self.cosine), self.aside, sine);
        let arm = cross(tangent, self.axis).map(|x| x.times(W::exactly(radius)));
        let rest = plus_times(self.torque, cross(arm, self.force), W::exactly(-1.0));
        let (spin, normal) = unit(rest);
        let sign = if dot(self.force, self.torque).rounded() > 0.0 { -1.0 } else { 1.0 };
        let (spin, normal) = (spin.rounded() * sign, rounded(normal) * sign);
        (spin + normal.sum()).is_number().then(|| (rounded(arm), spin, normal))
    }
}
