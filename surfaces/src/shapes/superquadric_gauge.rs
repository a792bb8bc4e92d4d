//! The gauge of a superquadric, with its derivatives.

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::superquadric::Superquadric;

/// The gauge of a superquadric at a point, with its derivatives.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Gauge<T: Real> {
    /// 1 on the surface, and homogeneous: at `k` times the point it is `k` times as much, with the same gradient, and
    /// the Hessian is divided by `k`.
    pub value: T,
    pub gradient: Vector3<T>,
    /// The Hessian is the sum of these vectors' outer products with themselves, times these numbers.
    pub bends: [(T, Vector3<T>); 2],
}

impl<T: Real> Superquadric<T> {
    /// The same in single precision, as well as that has it.
    #[doc(hidden)]
    #[inline]
    pub fn rounded(&self) -> Superquadric<f32> {
        let narrow = |x: T| x.to_f64() as f32;
        Superquadric {
            semi_axes: self.semi_axes.map(narrow),
            curvatures: self.curvatures.map(narrow),
            norms: self.norms.map(narrow),
            duals: self.duals.map(narrow),
            exponents: self.exponents.map(narrow),
        }
    }

    /// The gauge at a point whose coordinates over the semi-axes are 2 at most, as they are near the surface.
    ///
    /// With `x ≥ y` and `z` for these coordinates' sizes, `p` and `P` for the norms `2/e₂` and `2/e₁`, it is `F^(1/P)`,
    /// `F = Q + z^P`, `Q = x^P (1 + t^p)^(P/p)`, `t = y/x`. Norms are homogeneous, and so their Hessians in two numbers
    /// have rank one: with `w = 1/(1 + t^p)` and its rest as the shares of `x` and `y` in the inner norm
    /// (`docs/theory/surfaces.md#convex-bodies-with-a-gauge`),
    ///
    /// ```text
    /// ∂g = g/F (Q w/x, Q (1 − w)/y, z^P/z)
    /// ∂²g = g Q/F (p − 1) w (1 − w)/(x y)² q qᵀ + g (P − 1) Q z^P/(F z)² s sᵀ
    /// q = (−y, x, 0),   s = (−z w/x, −z (1 − w)/y, 1)
    /// ```
    ///
    /// Where a second derivative is infinite (on an axis, for `p < 2`) a large finite number stands for it.
    #[doc(hidden)]
    #[inline(always)]
    pub fn gauge_near(&self, point: &Vector3<T>) -> Gauge<T> {
        let v = point.component_mul(&self.curvatures);
        let Gauge { value, gradient, bends } = self.gauge_scaled(&v);
        Gauge {
            value,
            gradient: gradient.component_mul(&self.curvatures),
            bends: bends.map(|(bend, way)| (bend, way.component_mul(&self.curvatures))),
        }
    }

    /// The same by the coordinates over the semi-axes.
    #[inline(always)]
    pub(super) fn gauge_scaled(&self, v: &Vector3<T>) -> Gauge<T> {
        let (zero, one) = (T::zero(), T::one());
        let ([outer, inner], half) = (self.norms, T::literal(0.5));
        let inverse_outer = self.exponents[0] * half;
        let [x, y, z] = [v.x.abs(), v.y.abs(), v.z.abs()];
        let swapped = y > x;
        let (most, least) = if swapped { (y, x) } else { (x, y) };
        if !(most > zero) {
            return self.gauge_on_axis(v.z);
        }
        let over = |a: T, b: T| if b > zero { a / b } else { zero };
        // (a/b²) for a = b^p.
        let steep =
            |a: T, b: T, p: T| if b > T::EPSILON { a / (b * b) } else { T::EPSILON.power(p - one - one) };
        let share = least / most;
        // These three do not wait for one another.
        let (power, up, most_power) = (share.power(inner), z.power(outer), most.power(outer));
        let sum = one + power;
        let bent = if outer == inner { sum } else { sum.power(outer * self.exponents[1] * half) };
        let around = most_power * bent;
        let whole = around + up;
        let value = root_near_one(whole, inverse_outer);
        let (slope, weight) = (value / whole, one / sum);
        // Of the larger coordinate and of the smaller, by these. An octahedron's is the one on its edges.
        let aside = if inner > one { over(power, share) } else { one };
        let (along, aside) = (weight / most, aside * weight / most);
        let (wx, wy) = if swapped { (aside, along) } else { (along, aside) };
        let (wx, wy) = (wx.copysign(v.x), wy.copysign(v.y));
        let up_slope = if outer > one { over(up, z) } else { one };
        let gradient =
            Vector3::new(slope * around * wx, slope * around * wy, (slope * up_slope).copysign(v.z));
        let (a, b) = if swapped { (share, one) } else { (one, share) };
        let turn = Vector3::new(-b.copysign(v.y), a.copysign(v.x), zero);
        let bend =
            slope * around * (inner - one) * steep(power, share, inner) * (weight / most) * (weight / most);
        let lean = Vector3::new(-v.z * wx, -v.z * wy, one);
        let rise = slope * (outer - one) * (around / whole) * steep(up, z, outer);
        Gauge { value, gradient, bends: [(bend, turn), (rise, lean)] }
    }

    /// On the third axis, where one part of the second derivatives is zero and the other infinite: their limit.
    #[cold]
    fn gauge_on_axis(&self, z: T) -> Gauge<T> {
        let zero = T::zero();
        let gradient = Vector3::new(zero, zero, T::one().copysign(z));
        let nothing = [(zero, Vector3::zeros()); 2];
        if !(z.abs() > zero) {
            return Gauge { value: zero, gradient: Vector3::zeros(), bends: nothing };
        }
        let beside = self.gauge_scaled(&Vector3::new(z * T::EPSILON, zero, z));
        Gauge { value: z.abs(), gradient, bends: beside.bends }
    }
}

/// `x^a` for `a` between 0 and 1, sooner where `x` is near 1.
#[inline(always)]
fn root_near_one<T: Real>(x: T, a: T) -> T {
    let one = T::one();
    let d = x - one;
    if !(d.abs() < T::literal(1e-3)) {
        return x.power(a);
    }
    // The binomial series, of which the sixth term is less than ε/2.
    let [half, third, quarter] = [1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0].map(T::literal);
    let [two, three] = [2.0, 3.0].map(T::literal);
    let rest = one + d * quarter * (a - three);
    one + a * d * (one + d * half * (a - one) * (one + d * third * (a - two) * rest))
}
