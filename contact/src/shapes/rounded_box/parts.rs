//! The faces, edges and corners of a rounded box, and the closed form of the one that a contact is on.

use core::hint::select_unpredictable;

use fingertip_surfaces::{ForceLine, RoundedBox};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use crate::SoftContact;
use crate::model::flat;
use crate::shapes::cylinder::bears;
use crate::soft_finger::closed_form::steady_levers;
use crate::soft_finger::unit_sphere::{Parted, is_steep};

/// Faces, edges and corners that are tried before the long way is taken.
const PARTS: usize = 5;

/// The contact of a force that presses steeply, by the closed form of a plane, a cylinder or a ball: of the face through whose
/// plane the line of action comes last, and then of the part that the contact lies on whose place the part before does not
/// hold. A convex body has no other. On edges and corners, `levers` say how many radii the lever is at which the force
/// [`bears`] the spin torque.
#[inline(always)]
pub(super) fn steeply_on_rounded_box<T: Real>(
    shape: &RoundedBox<T>,
    push: &ForceLine<T>,
    levers: T,
) -> Option<SoftContact<T>> {
    let parts = Parts::new(shape, levers);
    let mut side = parts.entered(push);
    for _ in 0..PARTS {
        let is_flat = side.norm_squared() <= T::one();
        let (found, is_told) = if is_flat { parts.on_face(&side, push) } else { parts.on_round(&side, push) };
        // A face that is pressed at a flat angle may lead to an edge that is not.
        if !(is_told | is_flat) {
            return None;
        }
        let next = parts.side_of(&side, &found);
        if next == side {
            return (is_told & parts.is_sure(&side, &found)).then_some(found);
        }
        side = next;
    }
    None
}

/// On an edge, of a force that on its way there misses the ball of a corner, so that [`steeply_on_rounded_box`] does not come
/// to it.
pub(super) fn steeply_on_an_edge<T: Real>(
    shape: &RoundedBox<T>,
    push: &ForceLine<T>,
    levers: T,
) -> Option<SoftContact<T>> {
    let parts = Parts::new(shape, levers);
    let signs = [T::one(), -T::one()];
    let around = |k: usize| signs.into_iter().flat_map(move |a| signs.map(|b| (k, a, b)));
    (0..3).flat_map(around).find_map(|(k, a, b)| {
        let mut side = Vector3::zeros();
        (side[(k + 1) % 3], side[(k + 2) % 3]) = (a, b);
        let (found, is_one) = parts.on_round(&side, push);
        (is_one & (parts.side_of(&side, &found) == side) & parts.is_sure(&side, &found)).then_some(found)
    })
}

/// [`steeply_on_rounded_box`] without a branch, of a face and of the edge or corner behind it. A second one, which few need,
/// would take longer for all than these few do one by one.
#[inline(always)]
pub(super) fn steeply_in_columns<T: Real>(
    shape: &RoundedBox<T>,
    push: &ForceLine<T>,
) -> Option<SoftContact<T>> {
    let one = T::one();
    let parts = Parts::new(shape, steady_levers());
    let face = parts.entered(push);
    let (on_face, is_on_face) = parts.on_face(&face, push);
    let first = parts.side_of(&face, &on_face);
    let (on_first, is_on_first) = parts.on_round(&first, push);
    let second = parts.side_of(&first, &on_first);
    let (flat, settled) = (first == face, second == first);
    let found = pick(flat, &on_face, &on_first);
    let side_at = |k: usize| select_unpredictable(flat, face[k], second[k]);
    let side = Vector3::new(side_at(0), side_at(1), side_at(2));
    let is_round = is_on_first & settled;
    let is_found = (face.norm_squared() <= one) & ((flat & is_on_face) | (!flat & is_round));
    (is_found & parts.is_sure(&side, &found)).then_some(found)
}

/// One of two, without a branch. Component by component: of `zip_map` the compiler makes no vectors here.
#[inline(always)]
fn pick<T: Real>(first: bool, a: &SoftContact<T>, b: &SoftContact<T>) -> SoftContact<T> {
    let of = |a: T, b: T| select_unpredictable(first, a, b);
    SoftContact {
        point: Vector3::new(of(a.point.x, b.point.x), of(a.point.y, b.point.y), of(a.point.z, b.point.z)),
        normal: Vector3::new(
            of(a.normal.x, b.normal.x),
            of(a.normal.y, b.normal.y),
            of(a.normal.z, b.normal.z),
        ),
        spin_torque: of(a.spin_torque, b.spin_torque),
        active: true,
    }
}

/// The faces, edges and corners of a rounded box, each on its side of the core: −1, 0 or 1 along each axis.
struct Parts<T: Real> {
    half: Vector3<T>,
    core: Vector3<T>,
    /// As near to a sharp edge as rounding brings a contact.
    inner: Vector3<T>,
    rounding: T,
    curvature: T,
    /// Of edges and corners: how many radii the lever is at which the force [`bears`] the spin torque.
    levers: T,
}

impl<T: Real> Parts<T> {
    #[inline(always)]
    fn new(shape: &RoundedBox<T>, levers: T) -> Self {
        let (half, rounding) = (shape.half_extents(), shape.rounding());
        let core = half.map(|half| half - rounding);
        let inner = core.map(|core| core - half.sum() * (T::literal(64.0) * T::EPSILON));
        Self { half, core, inner, rounding, curvature: T::one() / rounding, levers }
    }

    /// The face through whose plane the line of action comes last: what it enters, but for edges, corners and spin.
    #[inline(always)]
    fn entered(&self, push: &ForceLine<T>) -> Vector3<T> {
        let f = push.force();
        // How far it goes to each, times |f|² and the force along the axis, so that nothing is divided.
        let foot = f.cross(&push.torque());
        let to = |k: usize| -self.half[k] * push.squared() - foot[k].copysign(foot[k] * f[k]);
        let is_later = |k: usize, l: usize| to(k) * f[l].abs() >= to(l) * f[k].abs();
        let which = [
            is_later(0, 1) & is_later(0, 2),
            is_later(1, 0) & is_later(1, 2),
            is_later(2, 0) & is_later(2, 1),
        ];
        let part = |k: usize| select_unpredictable(which[k], T::one().copysign(-f[k]), T::zero());
        Vector3::new(part(0), part(1), part(2))
    }

    #[inline(always)]
    fn on_face(&self, side: &Vector3<T>, push: &ForceLine<T>) -> (SoftContact<T>, bool) {
        on_face(&self.half.component_mul(side), side, push)
    }

    /// On the edge or corner on this side, for a force that presses at no flat angle and a spin torque that its levers
    /// [`bear`](bears); and whether it is one, which under others, and of a NaN, it is not.
    ///
    /// The closed form of `docs/theory/contact.md#central-quadrics` with `D = diag(s²)` around the part's centre, in units of
    /// its radius: a cylinder where one of the three sides is zero, of which `det D = 0`, and a ball where none is.
    #[inline(always)]
    fn on_round(&self, side: &Vector3<T>, push: &ForceLine<T>) -> (SoftContact<T>, bool) {
        let centre = self.core.component_mul(side);
        let (f, m) = (push.force(), push.torque_about(&centre) * self.curvature);
        let power = f.dot(&push.torque()) * self.curvature;
        let d = side.abs();
        let adjugate = Vector3::new(d.y * d.z, d.z * d.x, d.x * d.y);
        let (across, turning) = (f.component_mul(&d), m.component_mul(&adjugate));
        let (force, torque) = (across.norm_squared(), turning.norm_squared());
        let parted = Parted::new([force, torque], torque - force, power, adjugate.x * d.x);
        let place = (turning * parted.spin + across.cross(&m) - f * parted.along) * parted.inverse;
        let (point, spin_torque) = (centre + place * self.rounding, parted.spin * self.rounding);
        let is_steep = is_steep(parted.squares, parted.along, push.squared());
        let is_borne = bears(parted.along * parted.along, spin_torque, self.rounding * self.levers);
        let found = SoftContact { point, normal: place.component_mul(&d), spin_torque, active: true };
        (found, is_steep & is_borne)
    }

    /// The side of the part that a contact on another part's whole plane, cylinder or ball is beside.
    #[inline(always)]
    fn side_of(&self, side: &Vector3<T>, found: &SoftContact<T>) -> Vector3<T> {
        let part = |k: usize| part_of(side[k], found.normal[k], found.point[k], self.core[k]);
        Vector3::new(part(0), part(1), part(2))
    }

    /// Whether a contact on its own part is not next to a sharp edge, and made of numbers.
    #[inline(always)]
    fn is_sure(&self, side: &Vector3<T>, found: &SoftContact<T>) -> bool {
        let inside = |k: usize| (side[k] != T::zero()) | (found.point[k].abs() <= self.inner[k]);
        let clear = (side.norm_squared() > T::one()) | (inside(0) & inside(1) & inside(2));
        clear & (found.point.sum() + found.spin_torque).is_number()
    }
}

/// On which side of the core a contact is along an axis: where the part that it was found on is beside the core, that or none,
/// as its normal says; where it is not, as its place says.
#[inline(always)]
pub(super) fn part_of<T: Real>(side: T, normal: T, place: T, core: T) -> T {
    let kept = select_unpredictable(normal * side >= T::zero(), side, T::zero());
    select_unpredictable(side == T::zero(), beyond(place, core), kept)
}

/// On the plane through a point with a normal: `docs/theory/contact.md#central-quadrics`. `false` where the force presses
/// at a flat angle, and where the spin torque is more than the force has at a lever as long as the place is far: a plane
/// answers to what rounding of the wrench makes of it in the other torques, and a pose that turns the wrench rounds it.
#[inline(always)]
fn on_face<T: Real>(origin: &Vector3<T>, normal: &Vector3<T>, push: &ForceLine<T>) -> (SoftContact<T>, bool) {
    let force = push.force();
    let pressing = -force.dot(normal);
    let share = T::one() / pressing;
    let point = origin + push.torque_about(origin).cross(normal) * share;
    let spin_torque = -force.dot(&push.torque()) * share;
    let is_steep =
        (pressing > T::zero()) & (pressing * pressing >= flat::<T>() * flat::<T>() * push.squared());
    let is_steady = spin_torque * spin_torque <= push.squared() * point.norm_squared();
    (SoftContact { point, normal: *normal, spin_torque, active: true }, is_steep & is_steady)
}

/// On which side a coordinate is beyond the core: −1 or 1, or 0 if it is not.
#[inline(always)]
pub(super) fn beyond<T: Real>(coordinate: T, core: T) -> T {
    select_unpredictable(coordinate.abs() > core, T::one().copysign(coordinate), T::zero())
}
