//! The ellipsoid, through the unit sphere.

#[cfg(feature = "batch")]
use crate::batch::Lines;
#[cfg(feature = "batch")]
use crate::batch::kernel::{self, Answer, Chord, Kernel, Push, Versions, add, cross, scale, times};
use crate::uncertainty::geometry::stretched;
use fingertip_surfaces::numeric::twofold::{Twofold, dot, exactly};
use fingertip_surfaces::numeric::vectors::{larger, largest, taming_factor};
use fingertip_surfaces::{Ellipsoid, ForceLine, SmoothSurface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::soft_finger::closed_form::{soft_finger, told};
use crate::soft_finger::unit_sphere::OnUnitSphere;
use crate::{Search, SoftContact};

/// The soft-finger contact on an ellipsoid.
///
/// With `c = A y`, `A = diag(a)`, the equations become those of the unit sphere under the wrench
/// `(A⁻¹ f, A m / det A)`; the spin torque is `k |A⁻¹ y| · det A` in the scale of that wrench.
/// (`D = A⁻²` in `docs/theory/contact.md#central-quadrics`, where the identity is `(Df) × m = A(f̃ × m̃)`.)
/// `epsilon` is that of the type in which the wrench was told: a narrower one that asks in double precision does not need twice
/// the digits of it.
///
/// # Errors
/// The pair of points that a pure force which misses would graze.
#[inline(always)]
pub(super) fn on_ellipsoid<T: Real>(
    shape: &Ellipsoid<T>,
    wrench: &Wrench<T>,
    epsilon: T,
) -> Result<SoftContact<T>, [Vector3<T>; 2]> {
    let semi_axes = shape.semi_axes();
    // Lengths in units of the largest semi-axis, by a power of two; then the product of two
    // reciprocals is at least 1/4 and overflows only where the shape itself is not representable.
    let unit = largest(&semi_axes).normalising_factor();
    let length = unit.normalising_factor();
    let b = shape.curvatures() * length;
    let f = wrench.force().component_mul(&b);
    let m = wrench.torque().component_mul(&(across(&b) * unit));
    let scale = taming_factor(larger(largest(&f), largest(&m)));
    let [force, torque] = [wrench.force() * scale, wrench.torque() * unit * scale];
    let (f, m) = (f * scale, m * scale);
    let solved = if epsilon == T::EPSILON {
        finely(&(semi_axes * unit), [force, torque])
    } else {
        // As on the sphere: what is exactly zero before stretching shall be so after it.
        let power = force.dot(&torque) * (b.x * b.y * b.z);
        OnUnitSphere::new(&f, &m, f.norm_squared(), power)
    };
    let point = solved.point();
    let gradient = point.component_mul(&b);
    let steepness = gradient.norm_squared().root();
    // `h = f·c` of the stretched force is that part of the force itself along the normal, times the steepness.
    let whole = steepness * force.norm_squared().root();
    let solved = solved
        .unless_grazing(&f, &m, whole, epsilon)
        .map_err(|pair| pair.map(|point| point.component_mul(&semi_axes)))?;
    let volume = (semi_axes.x * unit) * (semi_axes.y * unit) * semi_axes.z;
    Ok(SoftContact {
        point: point.component_mul(&semi_axes),
        normal: gradient * (T::one() / steepness),
        spin_torque: solved.spin * volume * steepness * scale.normalising_factor(),
        active: true,
    })
}

/// On the unit sphere, stretched with twice the digits.
fn finely<T: Real>(semi_axes: &Vector3<T>, [force, torque]: [Vector3<T>; 2]) -> OnUnitSphere<T> {
    let [bx, by, bz] = <[T; 3]>::from(*semi_axes).map(|a| Twofold::new(T::one()).over(a));
    let (force, torque) = (exactly(&force), exactly(&torque));
    let (xy, power) = (bx.times(by), dot(force, torque));
    let ([fx, fy, fz], [mx, my, mz]) = (force, torque);
    let f = [fx.times(bx), fy.times(by), fz.times(bz)];
    let m = [mx.times(by.times(bz)), my.times(bz.times(bx)), mz.times(xy)];
    OnUnitSphere::finely(f, m, power.times(xy.times(bz)))
}

/// The same for a force that is tame and presses steeply, on an ellipsoid of which the same holds.
#[inline(always)]
pub(super) fn steeply_on_ellipsoid<T: Real>(
    shape: &Ellipsoid<T>,
    push: &ForceLine<T>,
) -> Option<SoftContact<T>> {
    let (a, b) = (shape.semi_axes(), shape.curvatures());
    let f = push.force().component_mul(&b);
    let m = push.torque().component_mul(&across(&b));
    let solved = OnUnitSphere::steep(&f, &m, f.norm_squared(), f.dot(&m))?;
    let point = solved.point();
    let gradient = point.component_mul(&b);
    let squared = gradient.norm_squared();
    if !((squared >= T::LEAST_NORMAL) & (squared <= T::GREATEST)) {
        return None;
    }
    let steepness = squared.root();
    Some(SoftContact {
        point: point.component_mul(&a),
        normal: gradient * (T::one() / steepness),
        // A force first, then a length: no product leaves the range that its result is in.
        spin_torque: (solved.spin * a.x) * (a.y * steepness) * a.z,
        active: true,
    })
}

/// The reciprocals of the areas that two semi-axes span: what takes `A m / det A` from a torque.
#[inline(always)]
fn across<T: Real>(b: &Vector3<T>) -> Vector3<T> {
    Vector3::new(b.y * b.z, b.z * b.x, b.x * b.y)
}

soft_finger!(
    Ellipsoid,
    |shape, wrench, _, visit| told(on_ellipsoid(shape, wrench, T::EPSILON).map_err(Search::Grazing), visit),
    sole | shape,
    push | steeply_on_ellipsoid(shape, push),
    double | shape,
    wrench
        | shape
            .in_double()
            .map(|double| { on_ellipsoid(&double, wrench, T::EPSILON.to_f64()).map_err(Search::Grazing) }),
    // The three semi-axes.
    sizes | shape,
    size,
    point | (size < 3).then(|| stretched(&shape.level(point), point, size, shape.semi_axes()[size]))
);

#[cfg(feature = "batch")]
crate::batch::sweep::swept!(Ellipsoid);

#[cfg(feature = "batch")]
impl<T: Real> Kernel<T> for Ellipsoid<T> {
    const VERSIONS: Versions = Versions::Two;

    /// Of a line that misses, the point is the one on which a scaled copy of the ellipsoid would be
    /// touched: close to the closest for small gaps, but not the same; the gap is the distance
    /// between the line and that point's tangent plane.
    #[inline(always)]
    fn answer(&self, push: Push<T>, lines: Lines) -> Answer<T> {
        let semi_axes: [T; 3] = self.semi_axes().into();
        let curvatures = semi_axes.map(|a| T::one() / a);
        let start = times(scale(cross(push.force, push.torque), push.inverse), curvatures);
        let direction = times(push.force, curvatures);
        let inverse = T::one() / kernel::dot(direction, direction);
        let foot = add(start, direction, -kernel::dot(start, direction) * inverse);
        let chord = Chord::new(kernel::dot(foot, foot), inverse, lines);
        let scaled = add(scale(foot, chord.shrink), direction, -chord.back);
        let gradient = times(scaled, curvatures);
        let flatness = T::one() / kernel::dot(gradient, gradient).root();
        let (point, normal) = (times(scaled, semi_axes), scale(gradient, flatness));
        Answer::of(point, normal, chord.outside * flatness, chord.meets)
    }
}
