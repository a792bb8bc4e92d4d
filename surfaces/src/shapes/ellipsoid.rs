//! The ellipsoid.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::numeric::ellipse::closest_point;
use crate::numeric::twofold::{Twofold, dot};
use crate::numeric::vectors::{
    any_perpendicular, foot, half_angle, hypotenuse, is_finite, length, unit_or, wide,
};
use crate::shortcuts::{LineInDouble, entry_near};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, Entry, Extent, ForceLine, Level, Shortcuts,
    SignedDistance, SmoothSurface, Topology,
};

/// An ellipsoid about the origin, its axes along x, y and z; [`Posed`](crate::Posed) puts it
/// elsewhere.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Ellipsoid};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// let tip = Ellipsoid::new(Vector3::new(0.010, 0.010, 0.015))?;
/// // 6 mm beside the axis, where z is 15 mm · √(1 − 0.6²).
/// let line = Line { point: Vector3::new(0.006, 0.0, 0.05), direction: -Vector3::z() };
/// let mut heights = Vec::new();
/// tip.crossings(&line, |crossing| heights.push(crossing.point.z));
/// assert!((heights[0] - 0.012_f64).abs() < 1e-15 && (heights[1] + 0.012).abs() < 1e-15);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid<T: Real> {
    semi_axes: Vector3<T>,
    curvatures: Vector3<T>,
    /// A power of two near the greatest semi-axis \[m\], and its reciprocal.
    unit: [T; 2],
    /// Reciprocals of the semi-axes in that unit.
    relative: Vector3<T>,
}

/// The part of a line within the ellipsoid, scaled to the unit sphere.
struct Chord<T: Real> {
    /// A power of two near the size of the ellipsoid \[m\].
    unit: T,
    /// Reciprocals of the semi-axes in that unit.
    curvatures: Vector3<T>,
    /// Its middle.
    foot: Vector3<T>,
    /// Scaled direction, not of unit length.
    direction: Vector3<T>,
    /// Where the middle is along the line, and half the length, in that unit.
    along: T,
    half: T,
}

impl<T: Real> Ellipsoid<T> {
    /// From the three semi-axes \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless they are positive finite lengths, none more than `1/√ε` times another.
    pub fn new(semi_axes: Vector3<T>) -> Result<Self, BadShape> {
        for axis in semi_axes.iter() {
            BadShape::check_length("ellipsoid", "semi-axes", *axis)?;
        }
        BadShape::check(
            "ellipsoid",
            "semi-axes",
            "of comparable size",
            semi_axes.min() / semi_axes.max() >= T::EPSILON.root(),
        )?;
        let curvatures = semi_axes.map(|a| T::one() / a);
        let per_unit = semi_axes.max().normalising_factor();
        let unit = T::one() / per_unit;
        Ok(Self { semi_axes, curvatures, unit: [unit, per_unit], relative: curvatures * unit })
    }

    /// The semi-axes \[m\].
    #[inline]
    #[must_use]
    pub const fn semi_axes(&self) -> Vector3<T> {
        self.semi_axes
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<Ellipsoid<f64>> {
        Ellipsoid::new(wide(&self.semi_axes)).ok()
    }

    /// Their reciprocals \[1/m\].
    #[inline]
    #[doc(hidden)]
    pub const fn curvatures(&self) -> Vector3<T> {
        self.curvatures
    }

    /// Lengths along the line count in a unit near the size of the ellipsoid, whatever the size.
    #[inline]
    fn chord(&self, line: &Line<T>) -> Option<Chord<T>> {
        let ([unit, _], curvatures) = (self.unit, self.relative);
        let point = line.point.component_mul(&self.curvatures);
        let direction = line.direction.component_mul(&curvatures);
        let inverse = T::one() / direction.norm_squared();
        let first = -point.dot(&direction) * inverse;
        let foot = point + direction * first;
        // Once more: of a flat shape's point, scaled up along its short axis, most has cancelled.
        let rest = -foot.dot(&direction) * inverse;
        let (foot, along) = (foot + direction * rest, first + rest);
        let squared = T::one() - foot.norm_squared();
        let half = (squared * inverse).root();
        (squared >= T::zero()).then_some(Chord { unit, curvatures, foot, direction, along, half })
    }

    #[inline]
    fn end(&self, chord: &Chord<T>, offset: T) -> Crossing<T> {
        let scaled = chord.foot + chord.direction * offset;
        let gradient = scaled.component_mul(&chord.curvatures);
        let steepness = gradient.norm_squared().root();
        Crossing {
            along: (chord.along + offset) * chord.unit,
            point: scaled.component_mul(&self.semi_axes),
            normal: gradient / steepness,
            active: true,
        }
    }

    /// From a point scaled to the unit sphere.
    #[inline]
    fn normal_at(&self, scaled: &Vector3<T>) -> Vector3<T> {
        unit_or(&scaled.component_mul(&self.curvatures), Vector3::z)
    }
}

impl<T: Real> ActiveSurface<T> for Ellipsoid<T> {
    /// Scaled to the unit sphere, the line is a line still, and `along` is kept (Bicchi, Salisbury
    /// & Brock 1993 for the case without local torque; `docs/theory/surfaces.md#ellipsoid`).
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        if let Some(chord) = self.chord(line) {
            visit(self.end(&chord, -chord.half));
            visit(self.end(&chord, chord.half));
        }
    }

    /// In the shadow along the line, the ellipsoid is an ellipse, the line a point
    /// (`docs/theory/surfaces.md#ellipses-and-ellipsoids`).
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (p, _) = foot(line, &Vector3::zeros());
        let p = if is_finite(&p) { p } else { Vector3::zeros() };
        let scale = self.semi_axes.max();
        let stretched = |v: &Vector3<T>| v.component_mul(&(self.semi_axes / scale));
        // The shadow is the ellipse with matrix Uᵀ A² U, for any two unit vectors U across the line;
        // a rotation by half the angle of `(m₁₁ − m₂₂, 2 m₁₂)` makes it diagonal.
        let first = any_perpendicular(&line.direction);
        let second = line.direction.cross(&first);
        let (s1, s2) = (stretched(&first), stretched(&second));
        let (m11, m12, m22) = (s1.norm_squared(), s1.dot(&s2), s2.norm_squared());
        let (cos, sin) = half_angle(m11 - m22, m12 + m12);
        let axes = [first * cos + second * sin, second * cos - first * sin];
        let [u, v] = axes;
        let lengths = [length(&stretched(&u)) * scale, length(&stretched(&v)) * scale];
        let [x, y] = closest_point(&lengths, &[p.dot(&u), p.dot(&v)]);
        // The normal of the shadow at that point is the surface's.
        let [a, b] = lengths;
        let normal = unit_or(&(u * (x / a * (scale / a)) + v * (y / b * (scale / b))), || u);
        // The point itself lies over that of the shadow, where a line parallel to the given one comes
        // deepest into the ellipsoid scaled to a sphere. (To take it from the normal would multiply its
        // rounding error with the aspect.)
        let over = u * x + v * y;
        let curvatures = self.curvatures * self.semi_axes.min();
        let inward = line.direction.component_mul(&curvatures);
        let near_one = inward.amax().normalising_factor();
        let inward = inward * near_one;
        let along = -over.component_mul(&curvatures).dot(&inward) * near_one / inward.norm_squared();
        let deepest = over + line.direction * along;
        let point = if is_finite(&deepest) { deepest } else { over };
        let gap = hypotenuse(p.dot(&u) - x, p.dot(&v) - y).min(T::GREATEST);
        Some(ClosestApproach { gap, point, normal, active: true })
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.normal_at(&point.component_mul(&self.curvatures))
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        point.component_mul(&self.curvatures).norm_squared() < T::one()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Ellipsoid<T> {
    const CLOSED_CONVEX: bool = true;

    /// As the crossings, without a branch: in units near the size of the ellipsoid no square leaves the range
    /// that the force's own is in by more than the aspect allows.
    #[inline]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let force = push.force();
        let direction = force.component_mul(&self.relative);
        let squared = direction.norm_squared();
        let (inverse_force, inverse) = (T::one() / push.squared(), T::one() / squared);
        let [_, per_unit] = self.unit;
        let point = force.cross(&(push.torque() * per_unit)).component_mul(&self.relative) * inverse_force;
        let foot = point - direction * (point.dot(&direction) * inverse);
        let remainder = T::one() - foot.norm_squared();
        let scaled = foot - direction * (remainder * inverse).root();
        let gradient = scaled.component_mul(&self.relative);
        let flatness = T::one() / gradient.norm_squared().root();
        Some(Entry {
            point: scaled.component_mul(&self.semi_axes),
            normal: gradient * flatness,
            // f·n = direction·scaled·flatness, and the foot is square to the direction.
            incidence_squared: remainder * (flatness * flatness) * (squared * inverse_force),
            parts: None,
            active: true,
        })
    }

    /// `(Σ xᵢ²/aᵢ² − 1)` over the length of its gradient.
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let scaled = |k: usize| Twofold::new(point[k]).over(self.semi_axes[k]);
        let scaled = [scaled(0), scaled(1), scaled(2)];
        let excess = dot(scaled, scaled).minus(Twofold::new(T::one())).value();
        let gradient = point.component_mul(&self.curvatures).component_mul(&self.curvatures);
        excess / (length(&gradient) * T::literal(2.0))
    }

    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double()?, line, near)
    }
}

impl<T: Real> SignedDistance<T> for Ellipsoid<T> {
    const CONVEX: bool = true;

    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T> {
        let closest = Vector3::from(closest_point::<T, 3>(&self.semi_axes.into(), &(*point).into()));
        let distance = length(&(point - closest));
        let normal = self.normal(&closest);
        Distance { distance: if self.contains(point) { -distance } else { distance }, normal }
    }

    fn bounds(&self) -> (Vector3<T>, T) {
        (Vector3::zeros(), self.semi_axes.max())
    }
}

/// `|A⁻¹ r| − 1` with its derivatives: `g = A⁻² r/γ`, `H = (A⁻² − g gᵀ)/γ`.
#[inline]
pub(super) fn elliptic_gauge<T: Real>(point: &Vector3<T>, curvatures: &Vector3<T>) -> Level<T> {
    let scaled = point.component_mul(curvatures);
    let gauge = length(&scaled);
    let gradient = scaled.component_mul(curvatures) / gauge;
    let squares = Matrix3::from_diagonal(&curvatures.component_mul(curvatures));
    Level { value: gauge - T::one(), gradient, hessian: (squares - gradient * gradient.transpose()) / gauge }
}

impl<T: Real> SmoothSurface<T> for Ellipsoid<T> {
    #[inline]
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        elliptic_gauge(point, &self.curvatures())
    }

    /// `eᵀA⁻²e/|A⁻²c|`, where `1/|A⁻²c| = c·n`: all terms of that sum are positive.
    #[inline]
    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        let (curvatures, inverse) = (self.curvatures(), point.dot(normal));
        let [e1, e2] = tangents.map(|e| e.component_mul(&curvatures));
        let mixed = e1.dot(&e2) * inverse;
        Matrix2::new(e1.norm_squared() * inverse, mixed, mixed, e2.norm_squared() * inverse)
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: Vector3::zeros(), radius: self.semi_axes().amax() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

stored! {
    Ellipsoid<T>, [T: Real],
    |ellipsoid| {
        semi_axes_m: Vector3<T> = ellipsoid.semi_axes,
    },
    Ellipsoid::new(semi_axes_m)
}

#[cfg(test)]
mod tests {
    use super::Ellipsoid;
    use crate::ActiveSurface;
    use fingertip_wrench::Line;
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    /// Against double precision. A line that runs along a needle is touched anywhere: as it tilts, the
    /// point slides by `a/u`, `u` being the cosine between the line and the plane across the axis.
    #[test]
    fn closest_points_of_needles_and_pancakes_in_single_precision() {
        let mut random = Pcg64Mcg::seed_from_u64(9);
        for axes in [[1.0, 1e-3, 1e-3], [1.0, 1.0, 1e-3], [1.0, 0.7, 0.4]] {
            let axes = Vector3::from(axes).cast::<f32>();
            let (narrow, wide) = (Ellipsoid::new(axes).unwrap(), Ellipsoid::new(axes.cast::<f64>()).unwrap());
            for _ in 0..2000 {
                let mut any = |reach: f32| Vector3::from_fn(|_, _| random.random_range(-reach..reach));
                let line = Line { point: any(1.2), direction: any(1.0).normalize() };
                let exact =
                    Line { point: line.point.cast(), direction: line.direction.cast::<f64>().normalize() };
                let mut meets = false;
                wide.crossings(&exact, |_| meets = true);
                if meets {
                    continue;
                }
                let (found, expected) =
                    (narrow.closest_approach(&line).unwrap(), wide.closest_approach(&exact).unwrap());
                let sliding = 1.0 / (line.direction.component_div(&axes).norm() * axes.z);
                let allowed = 16.0 * f32::EPSILON;
                let error = (found.point.cast::<f64>() - expected.point).norm();
                assert!(error <= f64::from(allowed * sliding), "{line:?} {found:?} {expected:?}");
                assert!((f64::from(found.gap) - expected.gap).abs() <= f64::from(allowed), "{line:?}");
            }
        }
    }
}
