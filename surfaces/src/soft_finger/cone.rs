//! The cone.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::newton::{Problem, tangents};
use crate::numeric::vectors::length;
use crate::{Cone, Extent, SoftContact};

/// The soft-finger contact on the unbounded cone: the closed form of theory 3.2 for `D = diag(1,
/// 1, −tan² α)`, `s = 0`, in which the quadratic for `K²` is linear,
/// `h = −√(−mᵀ adj(D) m)`, `K = (f·m)/h`, `c = (K adj(D) m + (Df) × m + h f)/(K² det D + fᵀDf)`.
///
/// The denominator vanishes where the force is parallel to a side (then one of two crossings is at
/// infinity), and takes digits with it before it does. So a Newton step or two follow, which bring
/// them back; and where nothing is left, Newton starts from where the line of action enters.
#[inline]
pub(super) fn on_cone<T: Real>(cone: &Cone<T>, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
    let (apex, axis) = (cone.apex(), cone.axis());
    let torque = wrench.torque_about(&apex);
    let force = wrench.force();
    // A cone has no size: the wrench brings one.
    let reach = length(&torque) / length(&force);
    let extent = Extent { centre: apex, radius: if reach > T::LEAST_NORMAL { reach } else { T::one() } };
    let problem = Problem::with_extent(cone, &extent, &force, &torque);
    let (first, second) = tangents(&axis);
    let inward = |v: &Vector3<T>| Vector3::new(v.dot(&first), v.dot(&second), v.dot(&axis));
    let (f, m) = (inward(&problem.force), inward(&problem.torque));
    let (sine, cosine) = (cone.half_angle().sin(), cone.half_angle().cos());
    // D times cos² α, which stays in range: (cos², cos², −sin²).
    let (d1, d3) = (cosine * cosine, -(sine * sine));
    let adjugate = Vector3::new(d1 * d3 * m.x, d1 * d3 * m.y, d1 * d1 * m.z);
    let along = -m.dot(&adjugate);
    if !(along > T::zero()) {
        return None;
    }
    let h = -along.root();
    let k = problem.power / h;
    let df = Vector3::new(d1 * f.x, d1 * f.y, d3 * f.z);
    let denominator = k * k * d1 * d1 * d3 + f.dot(&df);
    let c = (adjugate * k + df.cross(&m) + f * h) / denominator;
    let closed = first * c.x + second * c.y + axis * c.z;
    let finish = |point: Vector3<T>| {
        let place = problem.place(point)?;
        let state = problem.newton(place, problem.spin_at(&place)?, &problem.torque, 24)?;
        let height = state.place.point.dot(&axis);
        (state.converged && problem.presses(&state) && height > T::zero()).then(|| problem.contact(&state))
    };
    if c.z > T::zero()
        && let Some(contact) = finish(closed)
    {
        return Some(contact);
    }
    let mut found = None;
    if let Ok(line) = wrench.line_of_action() {
        use crate::ActiveSurface;
        cone.crossings(&line.line, |crossing| {
            if found.is_none() && crossing.normal.dot(&line.line.direction) < T::zero() {
                found = finish(problem.inward(&crossing.point));
            }
        });
    }
    found
}
