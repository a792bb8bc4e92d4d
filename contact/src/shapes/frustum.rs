//! Solids of revolution with flat ends: closed cylinder, cone, truncated cone.

use fingertip_surfaces::numeric::moved::point_inside;
use fingertip_surfaces::numeric::vectors::{length, wide};
use fingertip_surfaces::{ActiveSurface, CappedCylinder, ForceLine, Frustum, LocalSurface, SmoothSurface};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use super::cylinder::on_round_side;
use super::plane::on_plane;
use super::slanted_side::SlantedSide;
use crate::model::flat;
use crate::soft_finger::closed_form::{soft_finger, sole, told};
use crate::soft_finger::double::{finely, is_steady};
use crate::soft_finger::edge::{surely_beyond_side, surely_on_side};
use crate::soft_finger::rim::on_rim;
use crate::soft_finger::sure_rim::{Rim, surely_on_rim};
use crate::soft_finger::tip::{is_found_anew, surely_on_cone};
use crate::{GeometrySensitivity, Search, SoftContact};

/// The soft-finger contact on a frustum: of the side, by the closed form of its cone or cylinder; of
/// the flat ends, by that of the plane; of the edges between them and of a tip, with a normal between
/// those of the faces that meet. A convex solid has one contact, and it has it on one of these.
pub(super) fn on_frustum<T: Real>(
    solid: &Frustum<T>,
    wrench: &Wrench<T>,
    on_side: impl FnOnce(&Frustum<T>, &Wrench<T>) -> Option<SoftContact<T>>,
) -> Option<SoftContact<T>> {
    let (base, axis, height) = (solid.base_centre(), solid.axis(), solid.height());
    let force = wrench.force();
    if let Some(contact) = on_side(solid, wrench)
        && is_between_ends(solid, &contact.point)
    {
        return Some(contact);
    }
    let (sine, cosine) = (solid.taper() * solid.side_cosine(), solid.side_cosine());
    for (outward, origin, radius) in
        [(axis, base + axis * height, solid.top_radius()), (-axis, base, solid.base_radius())]
    {
        let torque = wrench.torque_about(&origin);
        if let Some(contact) = on_plane(&outward, &force, &torque)
            && contact.point.norm_squared() <= radius * radius
        {
            return Some(SoftContact { point: contact.point + origin, ..contact });
        }
        // The side's normal has this much along the end's.
        let lean = if outward == axis { sine } else { -sine };
        let mut found = None;
        on_rim(
            radius,
            &outward,
            &force,
            &torque,
            |normal, ring| {
                let up = normal.dot(&outward);
                let out = if radius.is_zero() {
                    (normal - outward * up).norm_squared().root()
                } else {
                    normal.dot(ring)
                };
                out >= T::zero() && cosine * up >= lean * out
            },
            |contact| found = Some(SoftContact { point: contact.point + origin, ..contact }),
        );
        if found.is_some() {
            return found;
        }
    }
    None
}

/// Whether a place of the unbounded side belongs to the solid.
fn is_between_ends<T: Real>(solid: &Frustum<T>, point: &Vector3<T>) -> bool {
    let above = (point - solid.base_centre()).dot(&solid.axis());
    above >= T::zero() && above <= solid.height()
}

/// On the side of a cylinder, unbounded.
fn on_straight_side<T: Real>(solid: &Frustum<T>, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
    let (base, axis) = (solid.base_centre(), solid.axis());
    let radius = (solid.base_radius() + solid.top_radius()) * T::literal(0.5);
    on_round_side(&base, &axis, radius, &wrench.force(), &wrench.torque_about(&base))
}

/// On the side, unbounded.
fn on_side<T: Real>(solid: &Frustum<T>, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
    narrow_side(solid).0.contact(wrench).ok()
}

/// The side, unbounded, from the narrower end, so that nothing cancels next to a tip; and how high over the base that is.
#[inline(always)]
fn narrow_side<T: Real>(solid: &Frustum<T>) -> (SlantedSide<T>, T) {
    let (sine, cosine) = (solid.taper() * solid.side_cosine(), solid.side_cosine());
    let (origin, start) = solid.narrow_end();
    let radius = solid.base_radius().min(solid.top_radius());
    (SlantedSide { origin, axis: solid.axis(), radius, sine, cosine }, start)
}

/// The contact of a force that presses steeply, on the side or within the end that it presses on: a convex body has
/// no other. Edges and tips, and what is near to them, take the long way.
#[inline(always)]
fn steeply_on_frustum<T: Real>(solid: &Frustum<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    let (base, axis, height) = (solid.base_centre(), solid.axis(), solid.height());
    let hair = hair(solid);
    let (side, start) = narrow_side(solid);
    if let Some((contact, along)) = side.steep_contact(push)
        && let above = start + along
        && above >= hair
        && above <= height - hair
    {
        return Some(contact);
    }
    let (force, rise) = (push.force(), push.force().dot(&axis));
    let (normal, origin, radius) = if rise < T::zero() {
        (axis, base + axis * height, solid.top_radius())
    } else {
        (-axis, base, solid.base_radius())
    };
    let share = T::one() / rise.abs();
    let spin_torque = -force.dot(&push.torque()) * share;
    let away = push.torque_about(&origin).cross(&normal) * share;
    let twist = spin_torque / radius;
    let steep = rise * rise >= flat::<T>() * flat::<T>() * (push.squared() + twist * twist);
    let inner = radius - hair;
    let inside = away.norm_squared() <= inner * inner.max(T::zero());
    (steep & inside).then(|| SoftContact { point: origin + away, normal, spin_torque, active: true })
}

/// On the side, for a narrower type.
fn exactly_on_frustum<T: Real>(solid: &Frustum<T>, wrench: &Wrench<f64>) -> Option<SoftContact<f64>> {
    let double = solid.in_double()?;
    let push = ForceLine::new(wrench, ForceLine::least_squared())?;
    let (side, start) = narrow_side(&double);
    let (contact, along) = side.contact_for_narrower(&push)?;
    let above = start + along;
    // Rounding is multiplied by as much there.
    let hair = hair(&double) * 1e6;
    (above >= hair && above <= double.height() - hair).then_some(contact)
}

/// As near to an edge as rounding brings a contact.
fn hair<T: Real>(solid: &Frustum<T>) -> T {
    (solid.height() + solid.base_radius() + solid.top_radius()) * (T::literal(64.0) * T::EPSILON)
}

/// Whether a place is on an edge or a tip, for all that the numbers say.
fn is_on_edge<T: Real>(solid: &Frustum<T>, point: &Vector3<T>) -> bool {
    let from_base = point - solid.base_centre();
    let above = from_base.dot(&solid.axis());
    let around = length(&(from_base - solid.axis() * above));
    let near = |height: T, radius: T| {
        (above - height).abs() <= hair(solid) && (around - radius).abs() <= hair(solid)
    };
    near(T::zero(), solid.base_radius()) || near(solid.height(), solid.top_radius())
}

/// In double precision if the type is narrower and rounding decides between the side, an end and an edge. So it does on
/// an edge, where the place answers to the torque by more the less that is.
fn on_frustum_finely<T: Real>(
    solid: &Frustum<T>,
    wrench: &Wrench<T>,
    on_side: impl FnOnce(&Frustum<T>, &Wrench<T>) -> Option<SoftContact<T>>,
    again: impl FnOnce(&Wrench<f64>) -> Option<Result<SoftContact<f64>, Search<f64>>>,
) -> Result<SoftContact<T>, Search<T>> {
    let lever = (solid.base_radius() + solid.top_radius()) * T::literal(0.5);
    let is_steady = is_steady(wrench, lever);
    let is_steady = |contact: &SoftContact<T>| is_steady(contact) && !is_on_edge(solid, &contact.point);
    finely(sole(on_frustum(solid, wrench, on_side), wrench), is_steady, wrench, again)
}

fn frustum_in_double<T: Real>(
    shape: &Frustum<T>,
    wrench: &Wrench<f64>,
) -> Option<Result<SoftContact<f64>, Search<f64>>> {
    shape.in_double().map(|double| sole(on_frustum(&double, wrench, on_side), wrench))
}

/// The same where rounding decides between the side and a tip, or where on the side the contact is.
fn surely_on_frustum<T: Real>(
    shape: &Frustum<T>,
    wrench: &Wrench<T>,
    pose: Option<&RigidTransform<T>>,
    found: Result<SoftContact<T>, Search<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    let base = shape.base_centre();
    let tip = || {
        if shape.top_radius().is_zero() {
            Some(base + shape.axis() * shape.height())
        } else {
            shape.base_radius().is_zero().then_some(base)
        }
    };
    let side = || (side_of_frustum(shape, &base), tip());
    let found = surely_on_cone(wrench, shape, pose, side, |point| is_between_ends(shape, point), found);
    surely_beside_edges(shape, (base, [0.0, shape.height().to_f64()]), wrench, pose, found)
}

/// The same where rounding decides between the side and an edge, or where on an edge the contact is.
///
/// Of the axis that point is told which the shape states, and the heights of the ends over it: the base of a capped cylinder
/// is rounded, and what rounds here may be multiplied by 1e13.
fn surely_beside_edges<T: Real>(
    solid: &Frustum<T>,
    (middle, ends): (Vector3<T>, [f64; 2]),
    wrench: &Wrench<T>,
    pose: Option<&RigidTransform<T>>,
    found: Result<SoftContact<T>, Search<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    if !is_found_anew::<T>() {
        return found;
    }
    let side = side_of_frustum(solid, &middle);
    let (on_edge, between) =
        (|point: &Vector3<T>| is_on_edge(solid, point), |point: &Vector3<T>| is_between_ends(solid, point));
    let found = surely_on_side(wrench, pose, side, on_edge, between, found)?;
    let inside = pose.map_or(found.point, |pose| point_inside(pose, &found.point));
    let above = (inside - solid.base_centre()).dot(&solid.axis());
    let is_above = above > solid.height() * T::literal(0.5);
    let (along, radius, room) = if is_above {
        (ends[1], solid.top_radius(), solid.height() - above)
    } else {
        (ends[0], solid.base_radius(), above)
    };
    let rim = Rim { origin: wide(&middle), axis: wide(&solid.axis()), along, radius: radius.to_f64() };
    if !is_on_edge(solid, &inside) {
        return Ok(surely_beyond_side(wrench, pose, side, between, (room.to_f64(), rim), found));
    }
    Ok(surely_on_rim(wrench, pose, &rim, found))
}

/// The centre that a capped cylinder states, and the heights of its ends over it.
fn middle_and_ends<T: Real>(shape: &CappedCylinder<T>) -> (Vector3<T>, [f64; 2]) {
    let half = shape.half_length().to_f64();
    (shape.centre(), [-half, half])
}

fn capped_in_double<T: Real>(
    shape: &CappedCylinder<T>,
    wrench: &Wrench<f64>,
) -> Option<Result<SoftContact<f64>, Search<f64>>> {
    shape.in_double().map(|double| sole(on_frustum(double.solid(), wrench, on_straight_side), wrench))
}

/// The side, or the plane of an end: which of them the normal of the surface is nearer to.
///
/// `middle` is a point of the axis, `below` and `above` the heights of the ends over it.
fn solid_patch<T: Real>(
    solid: &Frustum<T>,
    point: &Vector3<T>,
    middle: &Vector3<T>,
    ends: [f64; 2],
) -> LocalSurface {
    let (origin, axis) = (wide(middle), wide(&solid.axis()));
    let end = |height: f64| origin + axis * (height / axis.norm());
    let lean = solid.normal(point).dot(&solid.axis());
    let least = solid.taper() * solid.side_cosine();
    // Halfway between the side's normal and an end's.
    let half = T::literal(0.5);
    if lean > (T::one() + least) * half {
        LocalSurface::Plane { point: end(ends[1]), normal: axis }
    } else if lean < (least - T::one()) * half {
        LocalSurface::Plane { point: end(ends[0]), normal: -axis }
    } else {
        side_of_frustum(solid, middle)
    }
}

/// The side, unbounded, its base around this point of the axis.
fn side_of_frustum<T: Real>(solid: &Frustum<T>, middle: &Vector3<T>) -> LocalSurface {
    let [below, above] = [solid.base_radius(), solid.top_radius()].map(Real::to_f64);
    LocalSurface::Cone {
        origin: wide(middle),
        axis: wide(&solid.axis()),
        radius: below,
        taper: [below, above, solid.height().to_f64()],
    }
}

soft_finger!(
    Frustum,
    |shape, wrench, _, visit| {
        let found = on_frustum_finely(shape, wrench, on_side, |wrench| frustum_in_double(shape, wrench));
        told(surely_on_frustum(shape, wrench, None, found), visit)
    },
    sole | shape,
    push | steeply_on_frustum(shape, push),
    exactly | shape,
    wrench | exactly_on_frustum(shape, wrench),
    double | shape,
    wrench | frustum_in_double(shape, wrench),
    surely | shape,
    wrench,
    pose,
    found | surely_on_frustum(shape, wrench, pose, found),
    patch | shape,
    point | Some(solid_patch(shape, point, &shape.base_centre(), [0.0, shape.height().to_f64()])),
    sizes | shape,
    size,
    point | of_frustum(shape, point).get(size).copied()
);

soft_finger!(
    CappedCylinder,
    |shape, wrench, _, visit| {
        let solid = shape.solid();
        let found =
            on_frustum_finely(solid, wrench, on_straight_side, |wrench| capped_in_double(shape, wrench));
        told(surely_beside_edges(solid, middle_and_ends(shape), wrench, None, found), visit)
    },
    sole | shape,
    push | steeply_on_frustum(shape.solid(), push),
    double | shape,
    wrench | capped_in_double(shape, wrench),
    surely | shape,
    wrench,
    pose,
    found | surely_beside_edges(shape.solid(), middle_and_ends(shape), wrench, pose, found),
    patch | shape,
    point | {
        let (middle, ends) = middle_and_ends(shape);
        Some(solid_patch(shape.solid(), point, &middle, ends))
    },
    sizes | shape,
    size,
    point | of_capped_cylinder(shape, point).get(size).copied()
);

/// Height, base radius, top radius. With the level function `S = r − R + (R − R′) z/h` of the
/// distance `r` from the axis and the height `z` over the base.
fn of_frustum<T: Real>(shape: &Frustum<T>, point: &Vector3<T>) -> [GeometrySensitivity<T>; 3] {
    let (axis, taper, height) = (shape.axis(), shape.taper(), shape.height());
    let above = (point - shape.base_centre()).dot(&axis);
    let level = shape.level(point);
    // Which of the three faces is the outermost here.
    if above - height > level.value || -above > level.value {
        let top = if above > height * T::literal(0.5) {
            GeometrySensitivity::offset()
        } else {
            GeometrySensitivity::none()
        };
        return [top, GeometrySensitivity::none(), GeometrySensitivity::none()];
    }
    let steep = T::one() / shape.side_cosine();
    let gradient = level.gradient * steep;
    let hessian = level.hessian * steep;
    let share = above / height;
    let of = |value: T, slope: T| GeometrySensitivity::of_level(value, &(axis * slope), &gradient, &hessian);
    let one = T::one();
    [of(-taper * share, -taper / height), of(share - one, one / height), of(-share, -one / height)]
}

/// Radius, then half length; each moves the faces that it bounds.
fn of_capped_cylinder<T: Real>(shape: &CappedCylinder<T>, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
    if shape.normal(point).dot(&shape.axis()).abs() > T::literal(0.5) {
        [GeometrySensitivity::none(), GeometrySensitivity::offset()]
    } else {
        [GeometrySensitivity::offset(), GeometrySensitivity::none()]
    }
}

#[cfg(feature = "batch")]
crate::batch::each::entering!(Frustum);

#[cfg(feature = "batch")]
crate::batch::each::entering!(CappedCylinder);
