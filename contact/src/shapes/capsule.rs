//! The capsule.

use fingertip_surfaces::numeric::vectors::wide;
use fingertip_surfaces::{ActiveSurface, Capsule, ForceLine, LocalSurface, SmoothSurface, Sphere};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use super::cylinder::{on_round_side, steeply_on_round_side};
use super::sphere::{on_sphere, steeply_on_round_end};
#[cfg(feature = "batch")]
use crate::batch::Lines;
#[cfg(feature = "batch")]
use crate::batch::kernel::{Answer, Kernel, Push, Versions, add, dot, pick, scale};
use crate::soft_finger::closed_form::{soft_finger, sole, told};
use crate::soft_finger::double;
use crate::soft_finger::double::{finely, spins_little};
use crate::soft_finger::edge::surely_on_side;
use crate::soft_finger::refined::refined;
use crate::{GeometrySensitivity, Search, SoftContact};

/// The soft-finger contact on a capsule: of the side, or of the round ends, each by its closed form where
/// it applies.
///
/// # Errors
/// That there is none: [`Search::Complete`], or the pair of points of an end that a pure force grazes.
fn on_capsule<T: Real>(shape: &Capsule<T>, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
    let (centre, axis, half) = (shape.centre(), shape.axis(), shape.half_length());
    let torque = wrench.torque_about(&centre);
    // Rounding under a large spin torque, or at a flat angle, moves a contact along the side, and past its
    // ends.
    let is_steady = double::is_steady(wrench, shape.radius());
    if let Some(contact) = on_round_side(&centre, &axis, shape.radius(), &wrench.force(), &torque)
        && let contact =
            if is_steady(&contact) { contact } else { refined(wrench, &shape.without_ends(), &contact) }
        && (contact.point - centre).dot(&axis).abs() <= half
    {
        return Ok(contact);
    }
    let mut search = Search::Complete;
    for end in [axis, -axis] {
        match on_end(shape, &end, wrench) {
            Err(Search::Complete) => {}
            Err(pair) => search = pair,
            found => return found,
        }
    }
    Err(search)
}

/// On the round end that lies this way.
///
/// # Errors
/// As [`on_capsule`].
#[inline(never)]
fn on_end<T: Real>(
    shape: &Capsule<T>,
    end: &Vector3<T>,
    wrench: &Wrench<T>,
) -> Result<SoftContact<T>, Search<T>> {
    // A convex surface has one contact at most; a point of the seam belongs to the side.
    let ball = Sphere::new(shape.centre() + end * shape.half_length(), shape.radius())
        .map_err(|_| Search::Complete)?;
    match on_sphere(&ball, wrench, T::EPSILON) {
        Ok(contact) if contact.normal.dot(end) >= T::zero() => Ok(contact),
        Err(pair) if pair.iter().all(|point| (point - ball.centre()).dot(end) >= T::zero()) => {
            Err(Search::Grazing(pair))
        }
        _ => Err(Search::Complete),
    }
}

/// The same, in double precision if the type is narrower and the spin torque rules: then rounding decides
/// between the side and an end.
fn on_capsule_finely<T: Real>(shape: &Capsule<T>, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
    finely(on_capsule(shape, wrench), spins_little(wrench, shape.radius()), wrench, |wrench| {
        capsule_in_double(shape, wrench)
    })
}

/// The same where rounding of a wrench that a pose has moved takes the contact past the side's end.
fn surely<T: Real>(
    shape: &Capsule<T>,
    wrench: &Wrench<T>,
    pose: Option<&RigidTransform<T>>,
    found: Result<SoftContact<T>, Search<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    let above = |point: &Vector3<T>| (point - shape.centre()).dot(&shape.axis()).abs() - shape.half_length();
    let hair = (shape.half_length() + shape.radius()) * T::literal(1e-6);
    let (on_end, on_side) =
        (|point: &Vector3<T>| above(point) >= -hair, |point: &Vector3<T>| above(point) <= T::zero());
    surely_on_side(wrench, pose, side(shape), on_end, on_side, found)
}

fn side<T: Real>(shape: &Capsule<T>) -> LocalSurface {
    let (origin, axis) = (wide(&shape.centre()), wide(&shape.axis()));
    LocalSurface::Cone { origin, axis, radius: shape.radius().to_f64(), taper: [0.0, 0.0, 1.0] }
}

fn capsule_in_double<T: Real>(
    shape: &Capsule<T>,
    wrench: &Wrench<f64>,
) -> Option<Result<SoftContact<f64>, Search<f64>>> {
    shape.in_double().map(|double| on_capsule(&double, wrench))
}

/// The contact of a force that presses steeply, on the side or on the end that the side's contact lies beyond: a
/// convex body has no other.
#[inline(always)]
fn steeply_on_capsule<T: Real>(shape: &Capsule<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    let (centre, axis, half, radius) = (shape.centre(), shape.axis(), shape.half_length(), shape.radius());
    let end = match steeply_on_round_side((&centre, &axis), radius, push) {
        Some((contact, height)) if height.abs() <= half => return Some(contact),
        Some((_, height)) => axis * height.signum(),
        // Along the axis.
        None => -axis * push.force().dot(&axis).signum(),
    };
    let centre = centre + end * half;
    let contact = steeply_on_round_end(&centre, radius, push)?;
    (contact.normal.dot(&end) >= T::zero()).then_some(contact)
}

soft_finger!(
    /// The closed forms of the side and of the two round ends, each where it applies.
    Capsule,
    |shape, wrench, _, visit| told(
        on_capsule_finely(shape, wrench).or_else(|search| match search {
            Search::Complete => sole(None, wrench),
            other => Err(other),
        }),
        visit
    ),
    sole | shape,
    push | steeply_on_capsule(shape, push),
    double | shape,
    wrench | capsule_in_double(shape, wrench),
    surely | shape,
    wrench,
    pose,
    found | surely(shape, wrench, pose, found),
    patch | shape,
    point | {
        let (height, half) = ((point - shape.centre()).dot(&shape.axis()), shape.half_length());
        Some(if height.abs() <= half {
            side(shape)
        } else {
            let (origin, axis) = (wide(&shape.centre()), wide(&shape.axis()));
            let (height, radius) = (half.copysign(height).to_f64(), shape.radius().to_f64());
            LocalSurface::Ball { origin, axis, height, radius }
        })
    },
    sizes | shape, size, point | of_capsule(shape, point).get(size).copied()
);

/// Half length, then radius. A longer capsule moves its ends and leaves its side.
fn of_capsule<T: Real>(shape: &Capsule<T>, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
    let axis = shape.axis();
    let height = (point - shape.centre()).dot(&axis);
    let longer = if height.abs() > shape.half_length() {
        let outward = axis * T::one().copysign(height);
        GeometrySensitivity::translation(&outward, &shape.normal(point), &shape.shape_operator(point))
    } else {
        GeometrySensitivity::none()
    };
    [longer, GeometrySensitivity::offset()]
}

#[cfg(feature = "batch")]
crate::batch::sweep::swept!(Capsule);

#[cfg(feature = "batch")]
impl<T: Real> Kernel<T> for Capsule<T> {
    const VERSIONS: Versions = Versions::One;

    #[inline(always)]
    fn answer(&self, push: Push<T>, _: Lines) -> Answer<T> {
        let (centre, core): ([T; 3], [T; 3]) = (self.centre().into(), self.axis().into());
        let (half, radius) = (self.half_length(), self.radius());
        let curvature = T::one() / radius;
        let u = scale(push.force, push.inverse.root());
        let start = push.foot(centre, T::one());
        let (height, rise) = (dot(start, core), dot(u, core));
        let across = add(start, core, -height);
        let drift = add(u, core, -rise);
        // Where the line enters the unbounded side, or comes closest to it; from infinitely far
        // along the axis if it never does.
        let inverse = T::one() / dot(drift, drift).max(T::LEAST_NORMAL.root());
        let nearest = -dot(across, drift) * inverse;
        let foot = scale(add(across, drift, nearest), curvature);
        let left = T::one() - dot(foot, foot);
        let side = nearest - (left.max(T::zero()) * inverse).root() * radius;
        // The end of the segment that governs: where the entry is beyond one, that.
        let entry = height + side * rise;
        let middle = entry.max(-half).min(half);
        let inside = entry == middle;
        // On the ball about the end.
        let from_end = add(start, core, -middle);
        let to_end = -dot(from_end, u);
        let ball_foot = scale(add(from_end, u, to_end), curvature);
        let ball_left = T::one() - dot(ball_foot, ball_foot);
        let ball = to_end - ball_left.max(T::zero()).root() * radius;
        let point = add(start, u, pick(inside, side, ball));
        let reached = dot(point, core).max(-half).min(half);
        let outward = add(point, core, -reached);
        let distance = dot(outward, outward).root();
        let normal = scale(outward, T::one() / distance);
        let hit = pick(inside, left, ball_left) >= T::zero();
        let gap = pick(hit, T::zero(), (distance - radius).max(T::zero()));
        Answer::new(add(add(centre, core, reached), normal, radius), normal, gap)
    }
}
