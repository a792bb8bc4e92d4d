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
    /// One over it.
    pub inverse: T,
    pub gradient: Vector3<T>,
    /// The Hessian is the sum of these vectors' outer products with themselves, times these numbers.
    pub bends: [(T, Vector3<T>); 2],
}

/// To how many digits the powers of a gauge are taken.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Powers {
    /// Those of the type.
    Exact,
    /// Those of double precision but for the last, by logarithms that several powers share: in half the time.
    Fine,
    /// Some eight, for the steps of a search but the last.
    Quick,
}

impl Powers {
    /// How fine a step with these powers is that is the last of them: of exact ones its square is nothing; of quick ones it
    /// is as fine as they are, or as what is nothing when squared once more.
    #[inline]
    #[must_use]
    pub fn fine<T: Real>(self) -> T {
        match self {
            Self::Exact | Self::Fine => T::EPSILON.root(),
            Self::Quick => T::EPSILON.root().root() * T::literal(0.25),
        }
    }

    /// Those of the last step of a search. Logarithms in single precision would lack digits.
    #[inline(always)]
    #[must_use]
    pub fn of_last_step<T: Real>() -> Self {
        if T::EPSILON.to_f64() > f64::EPSILON { Self::Exact } else { Self::Fine }
    }

    #[inline(always)]
    fn logarithm<T: Real>(self, x: T) -> T {
        if self == Self::Quick { x.quick_logarithm() } else { x.fine_logarithm() }
    }

    #[inline(always)]
    fn power_of_two<T: Real>(self, x: T) -> T {
        if self == Self::Quick { x.quick_power_of_two() } else { x.fine_power_of_two() }
    }
}

impl<T: Real> Superquadric<T> {
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
    pub fn gauge_near(&self, point: &Vector3<T>, powers: Powers) -> Gauge<T> {
        let v = point.component_mul(&self.curvatures);
        let Gauge { value, inverse, gradient, bends } = self.gauge_scaled(&v, powers);
        Gauge {
            value,
            inverse,
            gradient: gradient.component_mul(&self.curvatures),
            bends: bends.map(|(bend, way)| (bend, way.component_mul(&self.curvatures))),
        }
    }

    /// The same by the coordinates over the semi-axes.
    #[inline(always)]
    pub(super) fn gauge_scaled(&self, v: &Vector3<T>, powers: Powers) -> Gauge<T> {
        let (zero, one) = (T::zero(), T::one());
        let ([outer, inner], half) = (self.norms, T::literal(0.5));
        let [inverse_outer, inverse_inner] = self.exponents.map(|e| e * half);
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
        let (power, up, around) = match powers {
            Powers::Exact => {
                // These three do not wait for one another.
                let (power, up, most_power) = (share.power(inner), z.power(outer), most.power(outer));
                let sum = one + power;
                let bent = if outer == inner { sum } else { sum.power(outer * inverse_inner) };
                (power, up, most_power * bent)
            }
            Powers::Fine | Powers::Quick => {
                let [most, least, z] = [most, least, z].map(|x| powers.logarithm(x));
                let power = powers.power_of_two(inner * (least - most));
                let around = if outer == inner {
                    powers.power_of_two(outer * most) * (one + power)
                } else {
                    powers.power_of_two(outer * (most + powers.logarithm(one + power) * inverse_inner))
                };
                (power, powers.power_of_two(outer * z), around)
            }
        };
        let whole = around + up;
        // Of these divisions none waits for another.
        let ([value, inverse], per_whole) = (root_near_one(whole, inverse_outer, powers), one / whole);
        let (slope, weight) = (value * per_whole, one / (one + power));
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
        let rise = slope * (outer - one) * (around * per_whole) * steep(up, z, outer);
        Gauge { value, inverse, gradient, bends: [(bend, turn), (rise, lean)] }
    }

    /// On the third axis, where one part of the second derivatives is zero and the other infinite: their limit.
    #[cold]
    fn gauge_on_axis(&self, z: T) -> Gauge<T> {
        let zero = T::zero();
        let gradient = Vector3::new(zero, zero, T::one().copysign(z));
        let nothing = [(zero, Vector3::zeros()); 2];
        let aside = z * T::EPSILON;
        // In the centre, or so near that nothing is beside it.
        if !(aside.abs() > zero) {
            return Gauge { value: zero, inverse: T::GREATEST, gradient: Vector3::zeros(), bends: nothing };
        }
        let beside = self.gauge_scaled(&Vector3::new(aside, zero, z), Powers::Exact);
        Gauge { value: z.abs(), inverse: T::one() / z.abs(), gradient, bends: beside.bends }
    }
}

/// `x^a` for `a` between 0 and 1, sooner where `x` is near 1, and one over it.
#[inline(always)]
fn root_near_one<T: Real>(x: T, a: T, powers: Powers) -> [T; 2] {
    let one = T::one();
    let (d, half) = (x - one, T::literal(0.5));
    if powers == Powers::Quick {
        // Padé's, off by d³/31 at most, which is nothing where the search ends.
        return if d.abs() < T::literal(0.25) {
            let (above, below) = (one + d * half * (one + a), one + d * half * (one - a));
            [above / below, below / above]
        } else {
            let power = powers.logarithm(x) * a;
            [powers.power_of_two(power), powers.power_of_two(-power)]
        };
    }
    let root = if d.abs() < T::literal(1e-3) {
        // The binomial series, of which the sixth term is less than ε/2.
        let [third, quarter] = [1.0 / 3.0, 1.0 / 4.0].map(T::literal);
        let [two, three] = [2.0, 3.0].map(T::literal);
        let rest = one + d * quarter * (a - three);
        one + a * d * (one + d * half * (a - one) * (one + d * third * (a - two) * rest))
    } else if powers == Powers::Fine {
        powers.power_of_two(powers.logarithm(x) * a)
    } else {
        x.power(a)
    };
    [root, one / root]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Quick powers tell where to step: what they say is off by their digits, times the power; the value of what is
        /// off the surface by Padé's remainder.
        #[test]
        fn quick_powers_say_the_same_to_fewer_digits(
            v in [0.01_f64..1.0, 0.01..1.0, 0.01..1.0], exponents in [0.1_f64..1.99, 0.1..1.99],
        ) {
            let shape = Superquadric::new(Vector3::repeat(1.0), exponents).unwrap();
            let away = Vector3::from(v) / shape.gauge_near(&v.into(), Powers::Exact).value;
            for stretch in [1.0, 1.01] {
                let point = away * stretch;
                let [exact, quick] = [Powers::Exact, Powers::Quick].map(|powers| shape.gauge_near(&point, powers));
                let off = (stretch - 1.0).powi(3) * shape.norms[0].powi(3) / 31.0;
                prop_assert!((quick.value - exact.value).abs() < 1e-7 + off, "{} {}", quick.value, exact.value);
                prop_assert!((quick.gradient - exact.gradient).norm() < (1e-6 + off) * exact.gradient.norm());
                for ((k, way), (exact_k, exact_way)) in quick.bends.into_iter().zip(exact.bends) {
                    prop_assert!((k - exact_k).abs() <= (1e-6 + off) * exact_k.abs(), "{k} {exact_k}");
                    prop_assert!((way - exact_way).norm() <= 1e-6 * exact_way.norm());
                }
            }
        }
    }

    /// However near the centre, the gauge is told in one call.
    #[test]
    fn the_third_axis_ends_in_the_centre() {
        let shape = Superquadric::<f32>::new(Vector3::new(1.0, 2.0, 0.5), [0.7, 1.3]).unwrap();
        for z in [0.5, -1e-3, 1e-30, f32::MIN_POSITIVE, f32::from_bits(1), 0.0, f32::NAN, f32::INFINITY] {
            for powers in [Powers::Exact, Powers::Quick] {
                let gauge = shape.gauge_near(&Vector3::new(0.0, 0.0, z), powers);
                let near = z.abs() < 1e-40 || z.is_nan();
                let expected = if near { 0.0 } else { 2.0 * z.abs() };
                assert_eq!(gauge.value, expected, "{z}");
                assert_eq!(gauge.inverse, if near { f32::MAX } else { 1.0 / expected }, "{z}");
                assert_eq!(gauge.gradient.z, if near { 0.0 } else { 2.0_f32.copysign(z) }, "{z}");
            }
        }
    }
}
