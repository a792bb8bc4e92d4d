//! The side of a cone or its tip, where the torque is all but along a normal of the side.

use fingertip_surfaces::LocalSurface;
use fingertip_surfaces::numeric::mixed_precision::{is_asked_again, is_refined_in_double};
use fingertip_surfaces::numeric::moved::point_inside;
use fingertip_surfaces::numeric::twofold::{Twofold, Wide};
use fingertip_surfaces::numeric::vectors::{largest, length, wide};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use super::patch::Digits;
use super::placed::{Patch, placed};
use super::refined::{PartAt, scaled, settled};
use super::rim::touching;
use super::three::{Three, cross, dot, exactly, plus_times, rounded, unit};
use crate::{Search, SoftContact, SoftFingerSurface};

/// A lean of the torque by less than so many roundings is found anew.
const HAIR: f64 = 1_048_576.0 * f64::EPSILON;

/// What a search says of a shape whose side is a cone, found anew with twice the digits where those of the type tell
/// neither the side from the tip, nor where on the side the contact is.
///
/// Under a spin torque `τ` the torque about the tip leans away from the normals of the side by `(ℓ f·n/τ)²/2`, `ℓ` being
/// how far the contact is from the tip: at 10⁷ times what the force has there as a torque that is less than rounding.
/// The wrench and the cone are exact for all that their numbers say. So the lean is found with twice their digits, and
/// the contact refined from where it says. For a narrower type the same is asked of the shape in double precision, whose
/// own digits do not always do, either; a number that carries more than a value keeps what was found, which knows the
/// derivative.
///
/// `side` tells the cone, and the tip if it belongs to the shape; `holds` whether a place of the cone does; both in the
/// frame of the shape, of which the pose is told, too.
#[inline]
pub(crate) fn surely_on_cone<T: Real, S: SoftFingerSurface<T>>(
    wrench: &Wrench<T>,
    shape: &S,
    pose: Option<&RigidTransform<T>>,
    side: impl FnOnce() -> (LocalSurface, Option<Vector3<T>>),
    holds: impl Fn(&Vector3<T>) -> bool,
    found: Result<SoftContact<T>, Search<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    if !is_found_anew::<T>() || matches!(found, Err(Search::Complete)) {
        return found;
    }
    let (side, tip) = side();
    let Some(patch) = placed(side.into(), pose) else { return found };
    let part_at = |point: &Vector3<T>| {
        let inside = pose.map_or(*point, |pose| point_inside(pose, point));
        placed(shape.patch(&inside)?, pose)
    };
    let holds = |point: &Vector3<f64>| holds(&patch.point_inside(point).map(T::literal));
    surely(wrench, &patch, tip, &part_at, &holds, found)
}

/// Whether what rounding decides is found anew with twice the digits: in double precision, of a number that carries no more than
/// a value.
#[inline(always)]
pub(crate) fn is_found_anew<T: Real>() -> bool {
    is_refined_in_double::<T>() && !is_asked_again::<T>() && !T::CARRIES_MORE
}

/// Compiled once for every shape.
fn surely<T: Real>(
    wrench: &Wrench<T>,
    patch: &Patch,
    tip: Option<Vector3<T>>,
    part_at: PartAt<'_, T>,
    holds: &dyn Fn(&Vector3<f64>) -> bool,
    found: Result<SoftContact<T>, Search<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    let (scale, load) = scaled(wrench);
    if let Ok(contact) = &found {
        let (point, normal) = (wide(&contact.point), wide(&contact.normal));
        let (point, normal) = (patch.point_inside(&point), patch.direction_inside(&normal));
        let spin = contact.spin_torque.to_f64() * scale;
        let cone = Straight::<f64>::of(&patch.surface);
        if !cone.is_some_and(|cone| {
            cone.hangs(patch.load_inside::<f64>(load).map(Vector3::from), spin, &point, &normal)
        }) {
            return found;
        }
    }
    let inside = patch.load_inside(load);
    let place = Straight::<Twofold<f64>>::of(&patch.surface).and_then(|cone| cone.place(inside));
    match (place, tip) {
        (Some(Place::Tip(torque)), Some(tip)) => {
            let force = rounded(inside[0]);
            let at_tip = touching(Vector3::zeros(), &force, &torque, force.dot(&torque));
            let point = patch.point_outside(&wide(&tip)).map(T::literal);
            let normal = patch.direction_outside(&at_tip.normal).map(T::literal);
            let spin_torque = T::literal(at_tip.spin_torque / scale);
            Ok(SoftContact { point, normal, spin_torque, active: true })
        }
        (Some(Place::Side(point)), _) => {
            let point = patch.point_outside(&point);
            let normal = rounded(patch.seen::<f64>(point.into()).normal);
            let (point, normal) = (point.map(T::literal), normal.map(T::literal));
            let spin_torque = wrench.torque_about(&point).dot(&normal);
            let near = SoftContact { point, normal, spin_torque, active: true };
            let settled = settled(wrench, part_at, &near);
            settled.filter(|contact| holds(&wide(&contact.point))).map_or(found, Ok)
        }
        _ => found,
    }
}

/// Where on a cone a contact is.
#[derive(Debug, PartialEq)]
enum Place {
    /// With the torque about it.
    Tip(Vector3<f64>),
    /// About there.
    Side(Vector3<f64>),
}

/// A cone from its tip.
struct Straight<W> {
    tip: Three<W>,
    /// The unit vector into it.
    into: Three<W>,
    /// The tangent of the half angle.
    slope: W,
}

impl<W: Wide> Straight<W> {
    /// `None` of a cylinder, and of what is no cone.
    fn of(side: &LocalSurface) -> Option<Self> {
        let LocalSurface::Cone { origin, axis, radius, taper: [from, to, over] } = *side else { return None };
        let (_, axis) = unit::<W>(exactly(&axis));
        let shrink = W::exactly(from).minus(W::exactly(to)).over(W::exactly(over));
        let narrows = shrink.rounded() > 0.0;
        if !narrows && !(shrink.rounded() < 0.0) {
            return None;
        }
        let tip = plus_times(exactly(&origin), axis, W::exactly(radius).over(shrink));
        let zero = W::exactly(0.0);
        let slope = if narrows { shrink } else { zero.minus(shrink) };
        Some(Self { tip, into: if narrows { axis.map(|x| zero.minus(x)) } else { axis }, slope })
    }

    /// Whether rounding of force and torque has a say in where a contact is.
    fn hangs(
        &self,
        [f, m]: [Vector3<f64>; 2],
        spin: f64,
        point: &Vector3<f64>,
        normal: &Vector3<f64>,
    ) -> bool {
        let tip = rounded(self.tip);
        let known = HAIR * (largest(&m) + largest(&tip) * largest(&f)) / spin.abs();
        let lever = length(&(point - tip)) * f.dot(normal) / spin;
        // Of the sine and cosine of the half angle.
        let slope = self.slope.rounded();
        let beyond = -normal.dot(&rounded(self.into)) * Real::root(1.0 + slope * slope) - slope;
        // At the tip the normal leans beyond that of the side.
        if beyond > HAIR { beyond <= known } else { lever * lever <= known }
    }

    /// Where the contact is, by the closed form of `docs/theory/contact.md#central-quadrics`: on the side if the torque
    /// about the tip leans further from the axis than a normal of the side.
    ///
    /// `None` where no place of this half of the cone is pressed on.
    fn place(&self, [force, torque]: [Three<W>; 2]) -> Option<Place> {
        let torque = plus_times(torque, cross(self.tip, force), W::exactly(-1.0));
        let rise = dot(torque, self.into);
        let squared = rise.times(rise);
        let across = dot(torque, torque).minus(squared);
        let lean = across.times(self.slope.times(self.slope)).minus(squared).rounded();
        let (power, f) = (dot(force, torque).rounded(), rounded(force));
        if !(lean > 0.0) {
            // The normal is against the torque if the power is positive, and out of the tip.
            return ((rise.rounded() > 0.0) == (power > 0.0)).then(|| Place::Tip(rounded(torque)));
        }
        let (into, slope) = (rounded(self.into), self.slope.rounded());
        let cosine_squared = 1.0 / (1.0 + slope * slope);
        let (d1, d3) = (cosine_squared, -cosine_squared * slope * slope);
        let (rise, torque) = (rise.rounded(), rounded(torque));
        let adjugate = (torque - into * rise) * (d1 * d3) + into * (d1 * d1 * rise);
        let fall = f.dot(&into);
        let df = (f - into * fall) * d1 + into * (d3 * fall);
        let h = -cosine_squared * Real::root(lean);
        let k = power / h;
        let from_tip = (adjugate * k + df.cross(&torque) + f * h) / (k * k * d1 * d1 * d3 + f.dot(&df));
        (from_tip.dot(&into) > 0.0).then(|| Place::Side(rounded(self.tip) + from_tip))
    }
}
