//! The convex superquadrics: from boxes over ellipsoids to octahedra.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix3, Vector3};

use crate::numeric::roots::{bisected, first_of_convex};
use crate::numeric::support;
use crate::numeric::vectors::{length, unit_or, wide};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Extent, Level, Shortcuts, SmoothSurface, Topology,
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
    semi_axes: Vector3<T>,
    curvatures: Vector3<T>,
    /// Norms `2/e₁` and `2/e₂` and their duals.
    norms: [T; 2],
    duals: [T; 2],
    exponents: [T; 2],
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
    let (power_x, power_y) = (x.powf(p), y.powf(p));
    let value = (power_x + power_y).powf(T::one() / p);
    // d/dx = (x/N)^(p−1), from powers already known where x is not tiny.
    let derivative = |x: T, signed: T| {
        let ratio = (x / value).powf(p - T::one());
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
        let found = support::closest_approach(line, |normal| {
            let (height, gradient) = Self::nested(&normal.component_mul(&self.semi_axes), self.duals);
            (height, gradient.component_mul(&self.semi_axes))
        });
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

    /// In double precision, for a type that is narrower; of `f64` there is no more to be had.
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        if T::EPSILON.to_f64() <= f64::EPSILON {
            return T::zero();
        }
        let scaled = wide(point).component_div(&wide(&self.semi_axes));
        let norms = self.exponents.map(|e| 2.0 / e.to_f64());
        let (gauge, gradient) = Superquadric::nested(&scaled, norms);
        let steepness = length(&gradient.component_div(&wide(&self.semi_axes)));
        T::literal((gauge - 1.0) / steepness)
    }
}

/// `(|a|^p + |b|^p)^(1/p)` with its first and second derivatives. Where a second derivative is
/// infinite (on an axis, for `p < 2`) a large finite number stands for it.
struct Norm<T> {
    value: T,
    first: [T; 2],
    /// By a and a, a and b, b and b.
    second: [T; 3],
}

impl<T: Real> Norm<T> {
    fn new(a: T, b: T, p: T) -> Self {
        let (x, y) = (a.abs(), b.abs());
        let greatest = x.max(y);
        if !(greatest > T::zero()) {
            return Self { value: T::zero(), first: [T::zero(); 2], second: [T::zero(); 3] };
        }
        let (x, y) = (x / greatest, y / greatest);
        let (xp, yp) = (x.powf(p), y.powf(p));
        let sum = xp + yp;
        let relative = sum.powf(T::one() / p);
        let value = relative * greatest;
        // (x/N)^p and (y/N)^p add up to 1; lower powers follow by dividing.
        let (x, y) = (x / relative, y / relative);
        let (xp, yp) = (xp / sum, yp / sum);
        let over = |power: T, own: T| if own > T::zero() { power / own } else { T::zero() };
        let flat = p - T::one();
        let (dx, dy) = if flat > T::zero() { (over(xp, x), over(yp, y)) } else { (T::one(), T::one()) };
        let least = T::EPSILON;
        let steep = |own: T, power: T, other: T| {
            // (p − 1)/N · (x/N)^(p−2) · (y/N)^p
            if own > least { power / (own * own) * other } else { least.powf(flat - T::one()) * other }
        };
        let factor = flat / value;
        let (sa, sb) = (T::one().copysign(a), T::one().copysign(b));
        Self {
            value,
            first: [dx * sa, dy * sb],
            second: [factor * steep(x, xp, yp), -factor * dx * dy * sa * sb, factor * steep(y, yp, xp)],
        }
    }
}

impl<T: Real> SmoothSurface<T> for Superquadric<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let curvatures = self.semi_axes().map(|a| T::one() / a);
        let v = point.component_mul(&curvatures);
        let two = T::one() + T::one();
        let [outer, inner] = self.exponents().map(|e| two / e);
        let plane = Norm::new(v.x, v.y, inner);
        let whole = Norm::new(plane.value, v.z, outer);
        let gradient =
            Vector3::new(whole.first[0] * plane.first[0], whole.first[0] * plane.first[1], whole.first[1])
                .component_mul(&curvatures);
        let value = whole.value - T::one();
        let (plane, whole) = if plane.value.is_zero() {
            // On the z axis one part of the second derivatives is zero and the other infinite: their limit.
            let beside = Norm::new(v.z * T::EPSILON, T::zero(), inner);
            let whole = Norm::new(beside.value, v.z, outer);
            (beside, whole)
        } else {
            (plane, whole)
        };
        let [px, py] = plane.first;
        let [wp, _] = whole.first;
        let [wpp, wpz, wzz] = whole.second;
        let [pxx, pxy, pyy] = plane.second;
        let (xx, xy, yy) = (wpp * px * px + wp * pxx, wpp * px * py + wp * pxy, wpp * py * py + wp * pyy);
        let (xz, yz) = (wpz * px, wpz * py);
        let scale = Matrix3::from_diagonal(&curvatures);
        let hessian = scale * Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, wzz) * scale;
        Level { value, gradient, hessian }
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
