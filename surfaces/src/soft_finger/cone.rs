//! The cone.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::double::finely;
use super::newton::Problem;
use crate::numeric::vectors::tangents;
use crate::numeric::vectors::wide;
use crate::numeric::vectors::{length, unit_or};
use crate::{ActiveSurface, Cone, Extent, Search, SoftContact};

/// The soft-finger contact on the unbounded cone: the closed form of theory 3.2 for `D = diag(1,
/// 1, −tan² α)`, `s = 0`, in which the quadratic for `K²` is linear,
/// `h = −√(−mᵀ adj(D) m)`, `K = (f·m)/h`, `c = (K adj(D) m + (Df) × m + h f)/(K² det D + fᵀDf)`.
///
/// The denominator vanishes where the force is parallel to a side (then one of two crossings is at
/// infinity), and takes digits with it before it does. So a Newton step or two follow, which bring
/// them back; where they do not, they start on the side that the torque tells, and where nothing is
/// left, from where the line of action enters.
///
/// # Errors
/// How the search ended: [`Search::Complete`] if no rounding of the wrench gives the side a contact.
#[inline]
pub(super) fn on_cone<T: Real>(cone: &Cone<T>, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
    let (apex, axis) = (cone.apex(), cone.axis());
    let torque = wrench.torque_about(&apex);
    let force = wrench.force();
    // With the axis along z, where the direction away from it is known to the last digit: on a needle
    // under a large spin torque everything hangs on it.
    let (first, second) = tangents(&axis);
    let inward = |v: &Vector3<T>| Vector3::new(v.dot(&first), v.dot(&second), v.dot(&axis));
    let outward = |v: &Vector3<T>| first * v.x + second * v.y + axis * v.z;
    let upright =
        Cone::new(Vector3::zeros(), Vector3::z(), cone.half_angle()).map_err(|_| Search::Incomplete)?;
    // A cone has no size: the wrench brings one.
    let reach = length(&torque) / length(&force);
    let reach = if reach > T::LEAST_NORMAL { reach } else { T::one() };
    let extent = Extent { centre: Vector3::zeros(), radius: reach };
    let problem = Problem::with_extent(&upright, &extent, &inward(&force), &inward(&torque));
    let (f, m) = (problem.force, problem.torque);
    let (sine, cosine) = (cone.half_angle().sin(), cone.half_angle().cos());
    // D times cos² α, which stays in range: (cos², cos², −sin²).
    let (d1, d3) = (cosine * cosine, -(sine * sine));
    let adjugate = Vector3::new(d1 * d3 * m.x, d1 * d3 * m.y, d1 * d1 * m.z);
    let along = -m.dot(&adjugate);
    let eight = T::literal(8.0) * T::EPSILON;
    // Rounding of the torque about the apex, of `f·m`, and of what follows.
    let loose = eight * (m.amax() + f.amax() * (apex.amax() / reach) * problem.reach);
    let loose_power = loose * f.abs().sum();
    let loose_along = (adjugate.abs().sum() * T::literal(2.0) + loose * T::literal(3.0)) * loose;
    // A pure force either hits or misses.
    let pure = problem.power.abs() <= loose_power;
    let ended = |certain: bool| if certain || pure { Search::Complete } else { Search::Incomplete };
    if !(along > T::zero()) {
        return Err(ended(along < -loose_along));
    }
    let h = -along.root();
    let k = problem.power / h;
    let df = Vector3::new(d1 * f.x, d1 * f.y, d3 * f.z);
    let denominator = k * k * d1 * d1 * d3 + f.dot(&df);
    let closed = (adjugate * k + df.cross(&m) + f * h) / denominator;
    let finish = |point: Vector3<T>| {
        let place = problem.place(point)?;
        let state = problem.newton(place, problem.spin_at(&place)?, &problem.torque, 24)?;
        let found = state.converged && problem.presses(&state) && state.place.point.z > T::zero();
        found.then(|| {
            let contact = problem.contact(&state);
            SoftContact { point: outward(&contact.point) + apex, normal: outward(&contact.normal), ..contact }
        })
    };
    if closed.z > T::zero() {
        if let Some(contact) = finish(closed) {
            return Ok(contact);
        }
        // Under a large spin torque the torque tells better on which side the contact is.
        let rest = (m - closed.cross(&f)) * -problem.power;
        let across = unit_or(&Vector3::new(rest.x, rest.y, T::zero()), Vector3::x) * (sine / cosine);
        if let Some(contact) = finish((across + Vector3::z()) * closed.z) {
            return Ok(contact);
        }
    }
    let mut found = None;
    if let Ok(line) = wrench.line_of_action() {
        cone.crossings(&line.line, |crossing| {
            if found.is_none() && crossing.normal.dot(&line.line.direction) < T::zero() {
                found = finish(problem.inward(&inward(&(crossing.point - apex))));
            }
        });
    }
    found.ok_or_else(|| {
        // `c·a > 0` asks whether `(adj(D) m f·m + h (Df) × m − f mᵀadj(D) m)·a` and the denominator
        // times `h²` differ in sign.
        let aside = df.cross(&m).z;
        let over = adjugate.z * problem.power + h * aside + f.z * along;
        let under = problem.power * problem.power * d1 * d1 * d3 + f.dot(&df) * along;
        let (size, twice) = (f.amax(), problem.power.abs() * T::literal(2.0));
        let loose_over = adjugate.z.abs() * loose_power
            + loose * (problem.power.abs() + (h.abs() + h.abs()) * size)
            + ((aside / h).abs() + f.z.abs()) * loose_along;
        let loose_under = twice * loose_power + size * size * (loose_along + eight * along) * T::literal(3.0);
        let decided = along > loose_along && over.abs() > loose_over && under.abs() > loose_under;
        ended(decided && (over > T::zero()) == (under > T::zero()))
    })
}

/// The same, in double precision if the type is narrower and the spin torque rules.
///
/// # Errors
/// As [`on_cone`].
pub(super) fn on_cone_finely<T: Real>(
    cone: &Cone<T>,
    wrench: &Wrench<T>,
) -> Result<SoftContact<T>, Search<T>> {
    let force = length(&wrench.force());
    let is_steady = |contact: &SoftContact<T>| {
        let radius = length(&(contact.point - cone.apex())) * cone.half_angle().sin();
        contact.spin_torque.abs() <= force * radius
    };
    finely(on_cone(cone, wrench), is_steady, wrench, |wrench| {
        let double = Cone::new(wide(&cone.apex()), wide(&cone.axis()), cone.half_angle().to_f64());
        double.ok().map(|double| on_cone(&double, wrench))
    })
}
