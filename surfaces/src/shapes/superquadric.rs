//! The convex superquadrics: from boxes over ellipsoids to octahedra.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::Vector3;

use super::superquadric_entry::{finely, quickly};
use super::superquadric_gauge::{Gauge, Powers};
use crate::numeric::roots::{bisected, first_of_convex};
use crate::numeric::support;
use crate::numeric::twofold::{Twofold, Wide};
use crate::numeric::vectors::{length, unit_or, wide};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Entry, Extent, ForceLine, Level, LineInDouble,
    Shortcuts, SmoothSurface, Topology,
};

/// A superellipsoid about the origin, its axes along x, y and z:
/// `((|x/a|^(2/e₂) + |y/b|^(2/e₂))^(e₂/e₁) + |z/c|^(2/e₁)) = 1` (Barr 1981);
/// [`Posed`](crate::Posed) puts it elsewhere.
///
/// Exponents of 1 make an ellipsoid, small ones a box with round edges, 2 an octahedron.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Superquadric};
/// use nalgebra::Vector3;
///
/// // Exponents of 1 make a ball, of 0.5 a box with round edges: |x|⁴ + |y|⁴ + |z|⁴ = (10 mm)⁴.
/// let corner = Vector3::repeat(0.0075);
/// assert!(!Superquadric::new(Vector3::repeat(0.01), [1.0, 1.0])?.contains(&corner));
/// assert!(Superquadric::new(Vector3::repeat(0.01), [0.5, 0.5])?.contains(&corner)); // 3 · 0.75⁴ = 0.95
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Superquadric<T: Real> {
    pub(super) semi_axes: Vector3<T>,
    pub(super) curvatures: Vector3<T>,
    /// Norms `2/e₁` and `2/e₂` and their duals.
    pub(super) norms: [T; 2],
    pub(super) duals: [T; 2],
    pub(super) exponents: [T; 2],
}

/// `(|a|^p + |b|^p)^(1/p)` and its derivatives by `a` and `b`, without over- or underflow.
#[inline]
fn norm<T: Real>(a: T, b: T, p: T) -> (T, T, T) {
    let (x, y) = (a.abs(), b.abs());
    let greatest = x.max(y);
    if !(greatest > T::zero()) {
        return (T::zero(), T::zero(), T::zero());
    }
    if !p.is_number() {
        // The greatest component.
        return if x >= y {
            (x, T::one().copysign(a), T::zero())
        } else {
            (y, T::zero(), T::one().copysign(b))
        };
    }
    let (x, y) = (x / greatest, y / greatest);
    let (power_x, power_y) = (x.power(p), y.power(p));
    let value = (power_x + power_y).power(T::one() / p);
    // d/dx = (x/N)^(p−1), from powers already known where x is not tiny.
    let derivative = |x: T, signed: T| {
        let ratio = (x / value).power(p - T::one());
        if x > T::zero() { ratio.copysign(signed) } else { T::zero() }
    };
    (value * greatest, derivative(x, a), derivative(y, b))
}

impl<T: Real> Superquadric<T> {
    /// From the three semi-axes \[m\] and the exponents `[e₁, e₂]`: `e₁` shapes the outline seen
    /// from the side, `e₂` the outline seen along z.
    ///
    /// # Errors
    /// [`BadShape`] unless the semi-axes are positive finite lengths, none more than `1/√ε` times
    /// another, and the exponents between 0.05 and 2 (beyond 2 the shape would not be convex).
    pub fn new(semi_axes: Vector3<T>, exponents: [T; 2]) -> Result<Self, BadShape> {
        let shape = "superquadric";
        for axis in semi_axes.iter() {
            BadShape::check_length(shape, "semi-axes", *axis)?;
        }
        let comparable = semi_axes.min() / semi_axes.max() >= T::EPSILON.root();
        BadShape::check(shape, "semi-axes", "of comparable size", comparable)?;
        let two = T::one() + T::one();
        for exponent in exponents {
            let good = exponent >= T::literal(0.05) && exponent <= two;
            BadShape::check(shape, "exponents", "between 0.05 and 2", good)?;
        }
        let norms = exponents.map(|e| two / e);
        Ok(Self {
            semi_axes,
            curvatures: semi_axes.map(|a| T::one() / a),
            norms,
            duals: norms.map(|p| if p > T::one() { p / (p - T::one()) } else { T::one() / T::zero() }),
            exponents,
        })
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<Superquadric<f64>> {
        Superquadric::new(wide(&self.semi_axes), self.exponents.map(Real::to_f64)).ok()
    }

    /// The same in another unit of length: all lengths times a power of two.
    #[doc(hidden)]
    #[inline]
    #[must_use]
    pub fn scaled(&self, by: T) -> Self {
        Self { semi_axes: self.semi_axes * by, curvatures: self.curvatures / by, ..*self }
    }

    /// The semi-axes \[m\].
    #[inline]
    #[must_use]
    pub const fn semi_axes(&self) -> Vector3<T> {
        self.semi_axes
    }

    /// The exponents `[e₁, e₂]`.
    #[inline]
    #[must_use]
    pub const fn exponents(&self) -> [T; 2] {
        self.exponents
    }

    /// The nested norm of a vector, and its gradient.
    #[inline]
    fn nested(v: &Vector3<T>, [outer, inner]: [T; 2]) -> (T, Vector3<T>) {
        let (plane, dx, dy) = norm(v.x, v.y, inner);
        let (value, d_plane, dz) = norm(plane, v.z, outer);
        (value, Vector3::new(d_plane * dx, d_plane * dy, dz))
    }

    /// How far the body reaches along a direction, and the point where it does so: where it is the outward normal.
    #[doc(hidden)]
    #[must_use]
    pub fn farthest_along(&self, direction: &Vector3<T>) -> (T, Vector3<T>) {
        let (height, gradient) = Self::nested(&direction.component_mul(&self.semi_axes), self.duals);
        (height, gradient.component_mul(&self.semi_axes))
    }

    /// The gauge of a scaled point: 1 on the surface, less inside, convex along every line
    /// (`docs/theory/surfaces.md#convex-bodies-with-a-gauge`).
    #[inline]
    fn gauge(&self, scaled: &Vector3<T>) -> (T, Vector3<T>) {
        Self::nested(scaled, self.norms)
    }
}

impl<T: Real> Superquadric<T> {
    /// Compiled once, not once for each caller: a call through a pointer costs little beside what is done here.
    fn each_crossing(&self, line: &Line<T>, visit: &mut dyn FnMut(Crossing<T>)) {
        let point = line.point.component_mul(&self.curvatures);
        let direction = line.direction.component_mul(&self.curvatures);
        let squared = direction.norm_squared();
        let along = -point.dot(&direction) / squared;
        let start = point + direction * along;
        // Scaled, the solid lies within a cube of half edge 1, that within a ball.
        let reach_squared = T::literal(3.03) - start.norm_squared();
        if !(reach_squared > T::zero()) {
            return;
        }
        let reach = (reach_squared / squared).root();
        let excess = |t: T| {
            let (gauge, gradient) = self.gauge(&(start + direction * t));
            (gauge - T::one(), gradient.dot(&direction))
        };
        let Some(entry) = first_of_convex(-reach, T::one(), excess) else { return };
        let Some(exit) = first_of_convex(reach, -T::one(), excess) else { return };
        for t in [entry, exit] {
            let scaled = start + direction * t;
            visit(Crossing {
                along: along + t,
                point: scaled.component_mul(&self.semi_axes),
                normal: unit_or(&self.gauge(&scaled).1.component_mul(&self.curvatures), Vector3::z),
                active: true,
            });
        }
    }
}

impl<T: Real> ActiveSurface<T> for Superquadric<T> {
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.each_crossing(line, &mut visit);
    }

    /// By the support function, which is the dual norm of the scaled normal.
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let found = support::closest_approach(line, |normal| self.farthest_along(normal));
        // On a nearly flat side the support point is ill-conditioned, but the closest point lies on
        // the line parallel to the given one that just touches: where the gauge is least on it.
        let reach = self.semi_axes.max() * T::literal(4.0);
        let direction = line.direction.component_mul(&self.curvatures);
        let slide = bisected(-reach, reach, |t| {
            let point = (found.point + line.direction * t).component_mul(&self.curvatures);
            self.gauge(&point).1.dot(&direction) < T::zero()
        });
        Some(ClosestApproach { point: found.point + line.direction * slide, ..found })
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        let (_, gradient) = self.gauge(&point.component_mul(&self.curvatures));
        unit_or(&gradient.component_mul(&self.curvatures), Vector3::z)
    }

    fn contains(&self, point: &Vector3<T>) -> bool {
        self.gauge(&point.component_mul(&self.curvatures)).0 < T::one()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Superquadric<T> {
    const CLOSED_CONVEX: bool = true;

    /// In few steps, where the force presses steeply.
    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        quickly(self, push)
    }

    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        finely(self, line, near)
    }

    /// In double precision, for a type that is narrower; of `f64` with twice the digits.
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let (axes, exponents) = (wide(&self.semi_axes()), self.exponents().map(Real::to_f64));
        let point: [f64; 3] = wide(point).into();
        T::literal(if T::EPSILON.to_f64() > f64::EPSILON {
            height_and_normal(&axes, exponents, point).0
        } else {
            height_and_normal(&axes, exponents, point.map(Twofold::new)).0.value()
        })
    }
}

impl Superquadric<f64> {
    /// The height over the surface, to first order, and the unit normal, with the digits of a wider number.
    #[doc(hidden)]
    #[inline]
    pub fn height_and_normal<W: Wide>(&self, point: [W; 3]) -> (W, [W; 3]) {
        height_and_normal(&self.semi_axes, self.exponents, point)
    }
}

/// The same. Kept out of line, and apart from the type of the shape.
#[inline(never)]
fn height_and_normal<W: Wide>(axes: &Vector3<f64>, exponents: [f64; 2], point: [W; 3]) -> (W, [W; 3]) {
    let [zero, one, two] = [0.0, 1.0, 2.0].map(W::exactly);
    let axes = [axes.x, axes.y, axes.z].map(W::exactly);
    let [outer, inner] = exponents.map(|e| two.over(W::exactly(e)));
    let sign = |k: usize| W::exactly(1.0_f64.copysign(point[k].rounded()));
    let scaled = |k: usize| point[k].times(sign(k)).over(axes[k]);
    // The norm and its derivatives; relative to the larger number, so that no power leaves the range.
    let norm = |a: W, b: W, p: W| {
        let swapped = b.rounded() > a.rounded();
        let (most, least) = if swapped { (b, a) } else { (a, b) };
        if !(most.rounded() > 0.0) {
            return (zero, [zero; 2]);
        }
        let share = least.over(most);
        let power = share.power(p);
        let sum = one.plus(power);
        let long = sum.power(one.over(p));
        let along = long.over(sum);
        let aside = if share.rounded() > 0.0 { power.over(share).times(along) } else { zero };
        (most.times(long), if swapped { [aside, along] } else { [along, aside] })
    };
    let (plane, [dx, dy]) = norm(scaled(0), scaled(1), inner);
    let (gauge, [d_plane, dz]) = norm(plane, scaled(2), outer);
    let slopes = [d_plane.times(dx), d_plane.times(dy), dz];
    let gradient: [W; 3] = core::array::from_fn(|k| slopes[k].times(sign(k)).over(axes[k]));
    let squared = gradient.iter().fold(zero, |sum, g| sum.plus(g.times(*g)));
    let steepness = squared.root();
    (gauge.minus(one).over(steepness), gradient.map(|g| g.over(steepness)))
}

impl<T: Real> SmoothSurface<T> for Superquadric<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        // Brought near the surface, where no power leaves the range.
        let most = point.component_mul(&self.curvatures).amax();
        let shrink = if most > T::zero() { T::one() / most } else { T::one() };
        let Gauge { value, gradient, bends: [(around, q), (along, s)], .. } =
            self.gauge_near(&(point * shrink), Powers::Exact);
        let hessian = q * q.transpose() * (around * shrink) + s * s.transpose() * (along * shrink);
        Level { value: value / shrink - T::one(), gradient, hessian }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: Vector3::zeros(), radius: length(&self.semi_axes()) }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

stored! {
    Superquadric<T>, [T: Real],
    |superquadric| {
        semi_axes_m: Vector3<T> = superquadric.semi_axes,
        exponents: [T; 2] = superquadric.exponents,
    },
    Superquadric::new(semi_axes_m, exponents)
}
