//! Cylinders without flat ends: the ellipsoid's closed form with the third axis at infinity.

use fingertip_surfaces::numeric::vectors::{tangents, wide};
use fingertip_surfaces::{Cylinder, ForceLine, LocalSurface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

#[cfg(feature = "batch")]
use crate::batch::Lines;
#[cfg(feature = "batch")]
use crate::batch::kernel::{Answer, Chord, Kernel, Push, Versions, add, cross, dot, scale};
use crate::model::flat;
use crate::soft_finger::closed_form::{soft_finger, steady_levers, told};
use crate::soft_finger::double::{finely, spins_little};
use crate::{GeometrySensitivity, Search, SoftContact};

/// The soft-finger contact on the unbounded cylinder around the third axis with semi-axes `a` (and
/// their reciprocals) along the first two, for a wrench in the same frame.
///
/// `D = diag(1/a₁², 1/a₂², 0)` in `docs/theory/contact.md#central-quadrics`: `h = −√(fᵀDf − (m₃/(a₁a₂))²)`,
/// `K = (f·m)/h`, `c = (K adj(D) m + (Df) × m + h f)/(fᵀDf)`. There is a contact only where the
/// line of action hits the lateral surface: a spin torque does not bend a line back to a surface
/// that is straight.
#[inline]
pub(super) fn on_cylinder<T: Real>(
    a: [T; 2],
    b: [T; 2],
    force: &Vector3<T>,
    torque: &Vector3<T>,
    mut visit: impl FnMut(SoftContact<T>),
) -> Search<T> {
    let length = a[0].max(a[1]);
    let unit = length.normalising_factor();
    let lever = torque * unit;
    let scale = force.amax().max(lever.amax()).normalising_factor();
    let f = force * scale;
    let m = lever * scale;
    let length = T::one() / unit;
    let b = [b[0] * length, b[1] * length];
    let (fx, fy) = (f.x * b[0], f.y * b[1]);
    // The wrench may have been all spin: bring what counts near 1 again before squaring.
    let across = fx.abs().max(fy.abs());
    let zoom = across.normalising_factor();
    let (fx, fy) = (fx * zoom, fy * zoom);
    let squared = fx * fx + fy * fy;
    let total = squared.root();
    let mz = m.z * b[0] * b[1] * zoom;
    // The direction of a force along the axis is noise.
    let noise = T::literal(4.0) * T::EPSILON * f.amax() * b[0].max(b[1]);
    if !(across > noise) || !(mz.abs() < total) {
        return Search::Complete;
    }
    let h = -((total - mz) * (total + mz)).root();
    // All of these carry the factor `zoom`, h too; K does not.
    let k = f.dot(&m) * zoom / h;
    let inverse = T::one() / squared;
    // In the affine frame: y = (f̃ × m̃ + h f̃)/|f̃|².
    let (x, y) = ((fy * mz + h * fx) * inverse, (h * fy - fx * mz) * inverse);
    let (gx, gy) = (fx * b[0], fy * b[1]);
    let z = (k * m.z * (b[0] * b[1]) * (b[0] * b[1]) * zoom * zoom
        + (gx * m.y - gy * m.x) * zoom
        + h * zoom * f.z)
        * inverse;
    let gradient = Vector3::new(x * b[0], y * b[1], T::zero());
    let steepness = gradient.norm_squared().root();
    let point = Vector3::new(x / b[0], y / b[1], z) * length;
    let spin_torque = k * steepness / scale * length;
    if (point.x + point.y + point.z + spin_torque).is_number() {
        visit(SoftContact { point, normal: gradient / steepness, spin_torque, active: true });
    }
    Search::Complete
}

/// On the side of an unbounded circular cylinder, for the torque about its centre.
pub(super) fn on_round_side<T: Real>(
    centre: &Vector3<T>,
    axis: &Vector3<T>,
    radius: T,
    force: &Vector3<T>,
    torque: &Vector3<T>,
) -> Option<SoftContact<T>> {
    let (first, second) = tangents(axis);
    let inward = |v: &Vector3<T>| Vector3::new(v.dot(&first), v.dot(&second), v.dot(axis));
    let outward = |v: &Vector3<T>| first * v.x + second * v.y + axis * v.z;
    let (force, torque) = (inward(force), inward(torque));
    let mut found = None;
    on_cylinder([radius; 2], [T::one() / radius; 2], &force, &torque, |contact| {
        found = Some(SoftContact {
            point: outward(&contact.point) + centre,
            normal: outward(&contact.normal),
            ..contact
        });
    });
    found
}

/// On the side of an unbounded circular cylinder, with the height along its axis from its centre, for a force that
/// presses at no flat angle and a spin torque that a steady lever [`bears`].
///
/// The closed form of [`on_cylinder`] for equal semi-axes, without a frame: with the parts of force and torque along
/// the axis `f_a`, `m_a` and across it, `q = m_a/R` and `s = √(|f_⊥|² − q²)`,
///
/// ```text
/// n = (q f_⊥ × a − s f_⊥)/|f_⊥|²,   f·n = −s,   τ = −f·m/s,
/// c = R n + z a,   z = (m·(a × f) − R f_a s + τ q)/|f_⊥|²
/// ```
#[inline(always)]
pub(super) fn steeply_on_round_side<T: Real>(
    (centre, axis): (&Vector3<T>, &Vector3<T>),
    radius: T,
    push: &ForceLine<T>,
) -> Option<(SoftContact<T>, T)> {
    let (force, torque) = (push.force(), push.torque_about(centre));
    let (along, turning) = (force.dot(axis), torque.dot(axis) / radius);
    let across = force - axis * along;
    let aside = axis.cross(&across);
    let squared = across.norm_squared();
    let pressing_squared = squared - turning * turning;
    // False for a NaN, too.
    if !(pressing_squared >= flat::<T>() * flat::<T>() * push.squared()) {
        return None;
    }
    let (pressing, inverse) = (pressing_squared.root(), T::one() / squared);
    let spin_torque = -force.dot(&torque) / pressing;
    if !bears(pressing_squared, spin_torque, radius * steady_levers()) {
        return None;
    }
    let normal = (aside * -turning - across * pressing) * inverse;
    let height = (torque.dot(&aside) - radius * along * pressing + spin_torque * turning) * inverse;
    let point = centre + normal * radius + axis * height;
    Some((SoftContact { point, normal, spin_torque, active: true }, height))
}

/// Whether a spin torque is no more than the force has at this lever, which is as much longer as the force presses more than at
/// the flattest angle that a shortcut takes: rounding grows with the one as with the other. False for a NaN.
#[inline(always)]
pub(super) fn bears<T: Real>(pressing_squared: T, spin_torque: T, lever: T) -> bool {
    let at_flattest = spin_torque * flat::<T>();
    at_flattest * at_flattest <= pressing_squared * (lever * lever)
}

#[inline(always)]
fn cylinder_contact<T: Real>(
    shape: &Cylinder<T>,
    force: &Vector3<T>,
    torque_about: impl FnOnce(&Vector3<T>) -> Vector3<T>,
) -> Option<SoftContact<T>> {
    let (centre, axis) = (shape.centre(), shape.axis());
    let contact = on_round_side(&centre, &axis, shape.radius(), force, &torque_about(&centre))?;
    let height = (contact.point - centre).dot(&axis);
    Some(SoftContact { active: shape.half_length().is_none_or(|half| height.abs() <= half), ..contact })
}

/// In double precision if the type is narrower and the spin torque rules.
fn on_cylinder_finely<T: Real>(shape: &Cylinder<T>, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
    let found = cylinder_contact(shape, &wrench.force(), |point| wrench.torque_about(point));
    finely(found.ok_or(Search::Complete), spins_little(wrench, shape.radius()), wrench, |wrench| {
        cylinder_in_double(shape, wrench)
    })
}

fn cylinder_in_double<T: Real>(
    shape: &Cylinder<T>,
    wrench: &Wrench<f64>,
) -> Option<Result<SoftContact<f64>, Search<f64>>> {
    let found = cylinder_contact(&shape.in_double()?, &wrench.force(), |point| wrench.torque_about(point));
    Some(found.ok_or(Search::Complete))
}

soft_finger!(
    Cylinder,
    |shape, wrench, _, visit| told(on_cylinder_finely(shape, wrench), visit),
    sole | shape,
    push | steeply_on_round_side((&shape.centre(), &shape.axis()), shape.radius(), push).map(
        |(contact, height)| SoftContact {
            active: shape.half_length().is_none_or(|half| height.abs() <= half),
            ..contact
        }
    ),
    double | shape,
    wrench | cylinder_in_double(shape, wrench),
    patch | shape,
    _ | Some(LocalSurface::Cone {
        origin: wide(&shape.centre()),
        axis: wide(&shape.axis()),
        radius: shape.radius().to_f64(),
        taper: [0.0, 0.0, 1.0],
    }),
    sizes | _,
    size,
    _ | (size == 0).then(GeometrySensitivity::offset)
);

#[cfg(feature = "batch")]
crate::batch::sweep::swept!(Cylinder);

#[cfg(feature = "batch")]
impl<T: Real> Kernel<T> for Cylinder<T> {
    const VERSIONS: Versions = Versions::Two;

    /// The ends are not looked at: the side is unbounded here.
    #[inline(always)]
    fn answer(&self, push: Push<T>, lines: Lines) -> Answer<T> {
        let (centre, core, radius) = (self.centre().into(), self.axis().into(), self.radius());
        let curvature = T::one() / radius;
        let start = push.foot(centre, T::one());
        let (height, rise) = (dot(start, core), dot(push.force, core));
        let across = add(start, core, -height);
        let drift = add(push.force, core, -rise);
        let inverse = T::one() / dot(drift, drift);
        let along = -dot(across, drift) * inverse;
        let aside = cross(core, drift);
        let foot = scale(aside, dot(across, aside) * inverse * curvature);
        let chord = Chord::new(dot(foot, foot), inverse, lines);
        let normal = add(scale(foot, chord.shrink), drift, -chord.back);
        let height = height + (along - chord.back * radius) * rise;
        let point = add(add(centre, core, height), normal, radius);
        Answer::of(point, normal, chord.outside * radius, chord.meets)
    }
}
