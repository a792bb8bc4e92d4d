//! The cone.

use fingertip_surfaces::numeric::mixed_precision::is_refined_in_double;
use fingertip_surfaces::numeric::moved::point_inside;
use fingertip_surfaces::numeric::vectors::tangents;
use fingertip_surfaces::numeric::vectors::wide;
use fingertip_surfaces::numeric::vectors::{length, unit_or};
use fingertip_surfaces::{Cone, Extent, ForceLine, LocalSurface, SmoothSurface, rare_crossings};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use super::slanted_side::SlantedSide;
use crate::soft_finger::closed_form::{soft_finger, told};
use crate::soft_finger::double::{finely, is_steady};
use crate::soft_finger::newton::Problem;
use crate::soft_finger::refined::settled;
use crate::soft_finger::rim::on_rim;
use crate::soft_finger::tip::surely_on_cone;
use crate::{GeometrySensitivity, Search, SoftContact};

/// The soft-finger contact on the unbounded cone: the closed form of
/// `docs/theory/contact.md#central-quadrics` for `D = diag(1, 1, −tan² α)`, `s = 0`, in which the quadratic
/// for `K²` is linear, `h = −√(−mᵀ adj(D) m)`, `K = (f·m)/h`,
/// `c = (K adj(D) m + (Df) × m + h f)/(K² det D + fᵀDf)`.
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
    let upright = cone.upright();
    // A cone has no size: the wrench brings one.
    let reach = length(&torque) / length(&force);
    let reach = if reach > T::LEAST_NORMAL { reach } else { T::one() };
    let extent = Extent { centre: Vector3::zeros(), radius: reach };
    let problem = Problem::with_extent(&upright, &extent, &inward(&force), &inward(&torque));
    let side = SideOfACone::new(&problem, cone, reach);
    // A pure force either hits or misses.
    let pure = problem.power.abs() <= side.loose_power;
    let ended = |certain: bool| if certain || pure { Search::Complete } else { Search::Incomplete };
    if !(side.along > T::zero()) {
        return Err(ended(side.along < -side.loose_along));
    }
    let closed = side.closed();
    let to_sensor = |contact: &SoftContact<T>| SoftContact {
        point: outward(&contact.point) + apex,
        normal: outward(&contact.normal),
        ..*contact
    };
    let finish = |point: Vector3<T>| {
        let place = problem.place(point)?;
        let state = problem.newton(place, problem.spin_at(&place)?, &problem.torque, 24)?;
        let found = state.converged && problem.presses(&state) && state.place.point.z > T::zero();
        found.then(|| to_sensor(&problem.contact(&state)))
    };
    if closed.z > T::zero() {
        if let Some(contact) = finish(closed) {
            return Ok(contact);
        }
        // Under a large spin torque the torque tells better on which side the contact is.
        let rest = (problem.torque - closed.cross(&problem.force)) * -problem.power;
        let (sine, cosine) = cone.half_angle_sin_cos();
        let slope = sine / cosine;
        let across = unit_or(&Vector3::new(rest.x, rest.y, T::zero()), Vector3::x) * slope;
        let turned = (across + Vector3::z()) * closed.z;
        if let Some(contact) = finish(turned) {
            return Ok(contact);
        }
        // Next to the tip only more digits tell where the way ends.
        let roughs = if is_refined_in_double::<T>() { &[closed, turned][..] } else { &[] };
        for rough in roughs {
            let near = problem.place(*rough).and_then(|place| {
                let spin = problem.spin_at(&place)?;
                Some(to_sensor(&problem.contact(&problem.state(place, spin, &problem.torque))))
            });
            if let Some(contact) = near.and_then(|near| settled(wrench, cone, &near)) {
                return Ok(contact);
            }
        }
    }
    let mut found = None;
    if let Ok(line) = wrench.line_of_action() {
        rare_crossings(cone, &line.line, &mut |crossing| {
            if found.is_none() && crossing.normal.dot(&line.line.direction) < T::zero() {
                found = finish(problem.inward(&inward(&(crossing.point - apex))));
            }
        });
    }
    found.ok_or_else(|| ended(side.has_none()))
}

/// The closed form of the contact on the infinite cone with its apex at the origin and its axis along z
/// (`docs/theory/contact.md#central-quadrics`), `D` times cos² α being diagonal: (cos², cos², −sin²).
struct SideOfACone<T: Real> {
    force: Vector3<T>,
    torque: Vector3<T>,
    /// `f·m`.
    power: T,
    d1: T,
    d3: T,
    /// `adj(D) m`.
    adjugate: Vector3<T>,
    /// `−mᵀ adj(D) m`, the square of `h`.
    along: T,
    h: T,
    /// `D f`.
    df: Vector3<T>,
    /// Rounding of the torque about the apex, of `f·m`, and of `along`.
    loose: T,
    loose_power: T,
    loose_along: T,
}

impl<T: Real> SideOfACone<T> {
    /// In the units of a problem, of which a length is the wrench's reach \[m\].
    fn new(problem: &Problem<'_, T, Cone<T>>, cone: &Cone<T>, reach: T) -> Self {
        let (f, m) = (problem.force, problem.torque);
        let (sine, cosine) = cone.half_angle_sin_cos();
        // This stays in range.
        let (d1, d3) = (cosine * cosine, -(sine * sine));
        let adjugate = Vector3::new(d1 * d3 * m.x, d1 * d3 * m.y, d1 * d1 * m.z);
        let along = -m.dot(&adjugate);
        let eight = T::literal(8.0) * T::EPSILON;
        let loose = eight * (m.amax() + f.amax() * (cone.apex().amax() / reach) * problem.reach);
        Self {
            force: f,
            torque: m,
            power: problem.power,
            d1,
            d3,
            adjugate,
            along,
            h: -along.root(),
            df: Vector3::new(d1 * f.x, d1 * f.y, d3 * f.z),
            loose,
            loose_power: loose * f.abs().sum(),
            loose_along: (adjugate.abs().sum() * T::literal(2.0) + loose * T::literal(3.0)) * loose,
        }
    }

    /// The contact; on the half behind the apex, where z is negative, it is none.
    fn closed(&self) -> Vector3<T> {
        let (f, m, h, df) = (&self.force, &self.torque, self.h, &self.df);
        let k = self.power / h;
        let denominator = k * k * self.d1 * self.d1 * self.d3 + f.dot(df);
        (self.adjugate * k + df.cross(m) + f * h) / denominator
    }

    /// `true` if it is certain, beyond all rounding, that the contact lies behind the apex.
    ///
    /// `c·a > 0` asks whether `(adj(D) m f·m + h (Df) × m − f mᵀadj(D) m)·a` and the denominator
    /// times `h²` differ in sign.
    fn has_none(&self) -> bool {
        let &Self {
            force: f, power, d1, d3, adjugate, along, h, df, loose, loose_power, loose_along, ..
        } = self;
        let eight = T::literal(8.0) * T::EPSILON;
        let aside = df.cross(&self.torque).z;
        let over = adjugate.z * power + h * aside + f.z * along;
        let under = power * power * d1 * d1 * d3 + f.dot(&df) * along;
        let (size, twice) = (f.amax(), power.abs() * T::literal(2.0));
        let loose_over = adjugate.z.abs() * loose_power
            + loose * (power.abs() + (h.abs() + h.abs()) * size)
            + ((aside / h).abs() + f.z.abs()) * loose_along;
        let loose_under = twice * loose_power + size * size * (loose_along + eight * along) * T::literal(3.0);
        let decided = along > loose_along && over.abs() > loose_over && under.abs() > loose_under;
        decided && (over > T::zero()) == (under > T::zero())
    }
}

/// The contact on the side of a force that presses at no flat angle, counted from the apex.
#[inline(always)]
fn steeply_on_cone<T: Real>(cone: &Cone<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    let (sine, cosine) = cone.half_angle_sin_cos();
    let side = SlantedSide { origin: cone.apex(), axis: cone.axis(), radius: T::zero(), sine: -sine, cosine };
    let (contact, depth) = side.steep_contact(push)?;
    Some(SoftContact { active: cone.depth().is_none_or(|most| depth <= most), ..contact })
}

/// The contact on the side, or at the tip, on which any normal will do that is steeper than the side's.
fn on_side_or_tip<T: Real>(cone: &Cone<T>, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
    let mut found = on_cone(cone, wrench);
    if found.is_err() {
        let (apex, tip) = (cone.apex(), -cone.axis());
        let (least, _) = cone.half_angle_sin_cos();
        on_rim(
            T::zero(),
            &tip,
            &wrench.force(),
            &wrench.torque_about(&apex),
            |normal, _| normal.dot(&tip) >= least,
            |contact| found = Ok(SoftContact { point: apex, ..contact }),
        );
    }
    found
}

/// The same, in double precision if the type is narrower and the force meets the side at a flat angle or the spin
/// torque rules: then rounding moves the contact far along the side, and decides between the side and the tip.
///
/// # Errors
/// As [`on_cone`].
fn on_cone_finely<T: Real>(cone: &Cone<T>, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
    let is_steady = |contact: &SoftContact<T>| {
        let radius = length(&(contact.point - cone.apex())) * cone.half_angle_sin_cos().0;
        is_steady(wrench, radius)(contact)
    };
    finely(on_side_or_tip(cone, wrench), is_steady, wrench, |wrench| cone_in_double(cone, wrench))
}

/// The same where rounding decides between the side and the tip, or where on the side the contact is.
fn surely<T: Real>(
    cone: &Cone<T>,
    wrench: &Wrench<T>,
    pose: Option<&RigidTransform<T>>,
    found: Result<SoftContact<T>, Search<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    let side = || (side_of_cone(cone), Some(cone.apex()));
    let found = surely_on_cone(wrench, cone, pose, side, |_| true, found);
    found.map(|contact| if_active(cone, pose, contact))
}

fn cone_in_double<T: Real>(
    cone: &Cone<T>,
    wrench: &Wrench<f64>,
) -> Option<Result<SoftContact<f64>, Search<f64>>> {
    let double = cone.in_double()?;
    Some(on_side_or_tip(&double, wrench).map(|contact| if_active(&double, None, contact)))
}

fn side_of_cone<T: Real>(cone: &Cone<T>) -> LocalSurface {
    LocalSurface::Cone {
        origin: wide(&cone.apex()),
        axis: wide(&cone.axis()),
        radius: 0.0,
        taper: [0.0, Real::tangent(cone.half_angle().to_f64()), 1.0],
    }
}

/// With what the depth of the cone says, in this pose.
fn if_active<T: Real>(
    cone: &Cone<T>,
    pose: Option<&RigidTransform<T>>,
    contact: SoftContact<T>,
) -> SoftContact<T> {
    let place = pose.map_or(contact.point, |pose| point_inside(pose, &contact.point));
    let depth = (place - cone.apex()).dot(&cone.axis());
    SoftContact { active: cone.depth().is_none_or(|most| depth <= most), ..contact }
}

soft_finger!(
    /// The side, or the tip, on which any normal will do that is steeper than the side's.
    Cone,
    |shape, wrench, _, visit| told(
        surely(shape, wrench, None, on_cone_finely(shape, wrench)),
        visit
    ),
    sole | shape,
    push | steeply_on_cone(shape, push),
    double | shape,
    wrench | cone_in_double(shape, wrench),
    surely | shape,
    wrench,
    pose,
    found | surely(shape, wrench, pose, found),
    patch | shape,
    _ | Some(side_of_cone(shape)),
    sizes | shape, size, point | of_cone(shape, point).get(size).copied()
);

/// The half angle, per radian. With the level function `S = r cos α − h sin α` of the distance `r`
/// from the axis and the depth `h` under the apex.
fn of_cone<T: Real>(shape: &Cone<T>, point: &Vector3<T>) -> [GeometrySensitivity<T>; 1] {
    let level = shape.level(point);
    let (sine, cosine) = shape.half_angle_sin_cos();
    let from_apex = point - shape.apex();
    let depth = from_apex.dot(&shape.axis());
    // ρ = (g + a sin α)/cos α.
    let outward = (level.gradient + shape.axis() * sine) / cosine;
    let value = -(from_apex.dot(&outward) * sine + depth * cosine);
    let turned = -(outward * sine + shape.axis() * cosine);
    [GeometrySensitivity::of_level(value, &turned, &level.gradient, &level.hessian)]
}

#[cfg(feature = "batch")]
crate::batch::each::entering!(Cone);
