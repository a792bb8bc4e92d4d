//! The sphere and its cap.

#[cfg(feature = "batch")]
use fingertip_surfaces::ForceParts;
use fingertip_surfaces::numeric::vectors::{larger, largest, taming_factor};
use fingertip_surfaces::{ForceLine, Sphere, SphericalCap};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::cylinder::bears;
#[cfg(feature = "batch")]
use crate::batch::Lines;
#[cfg(feature = "batch")]
use crate::batch::kernel::{Answer, Chord, Kernel, Push, Versions, add, dot, pick, scale, split};
use crate::soft_finger::closed_form::{part_of, soft_finger, steady_levers, told};
use crate::soft_finger::unit_sphere::OnUnitSphere;
use crate::{GeometrySensitivity, Search, SoftContact};

/// The soft-finger contact on a sphere.
///
/// `f·m` is that of the wrench as it is given, about the sensor's origin: the same about any point,
/// but for the rounding that moving a torque takes. So a pure force stays one. `epsilon` is that of the type in which
/// the wrench was told.
///
/// # Errors
/// The pair of points that a pure force which misses would graze.
pub(super) fn on_sphere<T: Real>(
    sphere: &Sphere<T>,
    wrench: &Wrench<T>,
    epsilon: T,
) -> Result<SoftContact<T>, [Vector3<T>; 2]> {
    let (centre, radius, curvature) = (sphere.centre(), sphere.radius(), sphere.curvature());
    let lever = wrench.torque_about(&centre) * curvature;
    let scale = taming_factor(larger(largest(&wrench.force()), largest(&lever)));
    let (f, m) = (wrench.force() * scale, lever * scale);
    let power = f.dot(&(wrench.torque() * scale)) * curvature;
    let squared = f.norm_squared();
    let solved = OnUnitSphere::new(&f, &m, squared, power)
        .unless_grazing(&f, &m, squared.root(), epsilon)
        .map_err(|pair| pair.map(|point| point * radius + centre))?;
    let normal = solved.point();
    Ok(SoftContact {
        point: normal * radius + centre,
        normal,
        spin_torque: solved.spin * radius * scale.normalising_factor(),
        active: true,
    })
}

/// The same for a force that is tame and presses steeply.
#[inline(always)]
pub(super) fn steeply_on_sphere<T: Real>(sphere: &Sphere<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    steeply_on_ball(&sphere.centre(), sphere.radius(), sphere.curvature(), push)
}

/// The same on a sphere of which no more is known, with the reciprocal of its radius.
#[inline(always)]
pub(super) fn steeply_on_ball<T: Real>(
    centre: &Vector3<T>,
    radius: T,
    curvature: T,
    push: &ForceLine<T>,
) -> Option<SoftContact<T>> {
    let (f, m) = (push.force(), push.torque_about(centre) * curvature);
    let solved = OnUnitSphere::steep(&f, &m, push.squared(), f.dot(&push.torque()) * curvature)?;
    let normal = solved.point();
    Some(SoftContact {
        point: normal * radius + centre,
        normal,
        spin_torque: solved.spin * radius,
        active: true,
    })
}

/// The same on an end of a body, under a spin torque that a steady lever [`bears`].
#[inline(always)]
pub(super) fn steeply_on_round_end<T: Real>(
    centre: &Vector3<T>,
    radius: T,
    push: &ForceLine<T>,
) -> Option<SoftContact<T>> {
    steeply_on_ball(centre, radius, T::one() / radius, push).filter(|contact| {
        let pressing = push.force().dot(&contact.normal);
        bears(pressing * pressing, contact.spin_torque, radius * steady_levers())
    })
}

soft_finger!(
    Sphere,
    |shape, wrench, _, visit| told(on_sphere(shape, wrench, T::EPSILON).map_err(Search::Grazing), visit),
    sole | shape,
    push | steeply_on_sphere(shape, push),
    double | shape,
    wrench
        | shape
            .in_double()
            .map(|double| on_sphere(&double, wrench, T::EPSILON.to_f64()).map_err(Search::Grazing)),
    sizes | _,
    size,
    _ | (size == 0).then(GeometrySensitivity::offset)
);

part_of!(SphericalCap, sphere);

#[cfg(feature = "batch")]
crate::batch::sweep::swept!(Sphere);

#[cfg(feature = "batch")]
impl<T: Real> Kernel<T> for Sphere<T> {
    const VERSIONS: Versions = Versions::Two;

    #[inline(always)]
    fn centred(&self) -> bool {
        self.centre() == Vector3::zeros()
    }

    #[inline(always)]
    fn answer(&self, push: Push<T>, lines: Lines) -> Answer<T> {
        let (centre, radius) = (self.centre().into(), self.radius());
        // Then nothing can leave the range where a line meets.
        let has_room = self.centre().amax() + radius < T::GREATEST * T::literal(0.125);
        let foot = push.foot(centre, self.curvature());
        let sine_squared = dot(foot, foot);
        let chord = Chord::new(sine_squared, push.inverse, lines);
        let normal = add(scale(foot, chord.shrink), push.force, -chord.back);
        let (mut pressing, mut across) = (push.squared * chord.back, push.squared * sine_squared);
        if lines == Lines::Any {
            let (along, squared) = split(push.force, normal);
            pressing = pick(chord.meets, pressing, -along);
            across = pick(chord.meets, across, squared);
        }
        Answer {
            point: push.beyond(centre, normal, radius),
            normal,
            gap: chord.outside * radius,
            parts: Some(ForceParts { normal: pressing, tangential: across.root() }),
            certain: chord.meets & has_room,
        }
    }
}
