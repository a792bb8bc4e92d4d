//! The cone.

use fingertip_surfaces::numeric::moved::point_inside;
use fingertip_surfaces::numeric::vectors::{length, wide};
use fingertip_surfaces::{Cone, ForceLine, LocalSurface, SmoothSurface};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use super::slanted_side::SlantedSide;
use crate::soft_finger::closed_form::{soft_finger, told};
use crate::soft_finger::double::{finely, is_steady};
use crate::soft_finger::rim::on_rim;
use crate::soft_finger::tip::surely_on_cone;
use crate::{GeometrySensitivity, Search, SoftContact};

/// The side, unbounded, from its apex.
#[inline(always)]
fn slanted_side<T: Real>(cone: &Cone<T>) -> SlantedSide<T> {
    let (sine, cosine) = cone.half_angle_sin_cos();
    SlantedSide { origin: cone.apex(), axis: cone.axis(), radius: T::zero(), sine: -sine, cosine }
}

/// The contact on the side of a force that presses at no flat angle, counted from the apex.
#[inline(always)]
fn steeply_on_cone<T: Real>(cone: &Cone<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    let (contact, depth) = slanted_side(cone).steep_contact(push)?;
    Some(SoftContact { active: cone.depth().is_none_or(|most| depth <= most), ..contact })
}

/// The contact on the side, or at the tip, on which any normal will do that is steeper than the side's.
fn on_side_or_tip<T: Real>(cone: &Cone<T>, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
    let mut found = slanted_side(cone).contact(wrench);
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
/// As [`SlantedSide::contact`].
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
    Some(surely(&double, wrench, None, on_side_or_tip(&double, wrench)))
}

/// On the side, for a narrower type.
fn exactly_on_cone<T: Real>(cone: &Cone<T>, wrench: &Wrench<f64>) -> Option<SoftContact<f64>> {
    let double = cone.in_double()?;
    let push = ForceLine::new(wrench, ForceLine::least_squared())?;
    let (contact, _) = slanted_side(&double).contact_for_narrower(&push)?;
    Some(if_active(&double, None, contact))
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
    exactly | shape,
    wrench | exactly_on_cone(shape, wrench),
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
