//! Shapes whose level function is a gauge (1 on the surface, growing in proportion along every ray
//! from the centre) or a polynomial.

use fingertip_wrench::Real;
use nalgebra::{Matrix2, Matrix3, Vector3};

use super::flat_ends::Face;
use crate::numeric::vectors::{hypotenuse, length};
use crate::{
    ActiveSurface, Corner, CylinderEnds, Ellipsoid, EllipticCylinder, Extent, Level, Paraboloid,
    SmoothSurface, Superquadric, Topology,
};

/// `|A⁻¹ r| − 1` with its derivatives: `g = A⁻² r/γ`, `H = (A⁻² − g gᵀ)/γ`.
#[inline]
fn elliptic_gauge<T: Real>(point: &Vector3<T>, curvatures: &Vector3<T>) -> Level<T> {
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

/// The level function is that of the side; flat ends are not part of it, but of the curvature.
impl<T: Real> SmoothSurface<T> for EllipticCylinder<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let [a, b] = self.semi_axes();
        elliptic_gauge(point, &Vector3::new(T::one() / a, T::one() / b, T::zero()))
    }

    fn extent(&self) -> Extent<T> {
        let [a, b] = self.semi_axes();
        let half = match self.ends() {
            CylinderEnds::Unbounded => T::zero(),
            CylinderEnds::Open(half) | CylinderEnds::Capped(half) => half,
        };
        // As far as the rims, which lie beyond both.
        Extent { centre: Vector3::zeros(), radius: hypotenuse(a.max(b), half) }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let level = self.level(point);
        Face::of(&Vector3::z(), &level, &self.normal(point)).shape_operator(&level)
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        let level = self.level(point);
        Face::of(&Vector3::z(), &level, normal).bend(&level, tangents)
    }

    /// On the ellipse of an end: with `c = (a cos θ, b sin θ)`, `c″ = −c` and `c′ = (−y a/b, x b/a)`.
    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        let [a, b] = self.semi_axes();
        let along = Vector3::new(-point.y * a / b, point.x * b / a, T::zero());
        let steepness = length(&along);
        let bend = (normal.x * point.x + normal.y * point.y) / steepness / steepness;
        Some(Corner::Edge { direction: along / steepness, bend })
    }
}

/// The extent of an unbounded paraboloid is a ball of its larger radius of curvature.
impl<T: Real> SmoothSurface<T> for Paraboloid<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let [a, b] = self.radii();
        let (x, y) = (point.x / a, point.y / b);
        Level {
            value: point.z + (point.x * x + point.y * y) * T::literal(0.5),
            gradient: Vector3::new(x, y, T::one()),
            hessian: Matrix3::from_diagonal(&Vector3::new(T::one() / a, T::one() / b, T::zero())),
        }
    }

    fn extent(&self) -> Extent<T> {
        let [a, b] = self.radii();
        Extent { centre: Vector3::zeros(), radius: a.max(b) }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
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
        let [px, py] = plane.first;
        let [wp, wz] = whole.first;
        let [wpp, wpz, wzz] = whole.second;
        let [pxx, pxy, pyy] = plane.second;
        let gradient = Vector3::new(wp * px, wp * py, wz).component_mul(&curvatures);
        let (xx, xy, yy) = (wpp * px * px + wp * pxx, wpp * px * py + wp * pxy, wpp * py * py + wp * pyy);
        let (xz, yz) = (wpz * px, wpz * py);
        let scale = Matrix3::from_diagonal(&curvatures);
        let hessian = scale * Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, wzz) * scale;
        Level { value: whole.value - T::one(), gradient, hessian }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: Vector3::zeros(), radius: length(&self.semi_axes()) }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}
