//! Exact limit curves by quadrature: oracle and table maker.

use crate::PressureDistribution;

/// One point of a limit curve: tangential force over `μN` and spin torque over `μN` times the
/// torque arm, and the place of the centre of rotation that belongs to it.
///
/// ```
/// use fingertip_friction::{LimitCurve, LimitPoint, PressureDistribution};
///
/// // A patch that turns about its own middle holds all its torque, and no force.
/// let LimitPoint { force, torque, .. } = LimitCurve::new(PressureDistribution::Uniform).point(0.0);
/// assert!(force.abs() < 1e-6 && (torque - 1.0).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitPoint {
    /// `|f_t|/(μN)`, 0 to 1.
    pub force: f64,
    /// `|τ|/(μNe)`, 0 to 1.
    pub torque: f64,
    /// Distance of the centre of rotation from the centre of the patch, over the patch radius.
    pub centre: f64,
}

/// The exact limit curve of an axially symmetric pressure with Coulomb's law at every point of
/// the patch (Goyal, Ruina & Papadopoulos 1991; Howe & Cutkosky 1996).
///
/// Sliding is a rotation about a centre at distance `d` from the middle of the patch. A ring of
/// radius `r` then carries the mean force `∂D/∂d` and the mean torque `r ∂D/∂r`, where
/// `D(r, d) = (2/π)(r+d) E(m)`, `m = 4rd/(r+d)²`, is the mean distance of the ring from the centre
/// of rotation. With complete elliptic integrals by the arithmetic-geometric mean these are
///
/// `F = [(d−r)K + (d+r)E]/(πd)`, `G = [(r−d)K + (r+d)E]/π`,
///
/// and one integral over the radius is left, done by the double-exponential rule on both sides of
/// `r = d`, where `K` has its logarithmic singularity. Errors are below 1e-9.
///
/// ```
/// use fingertip_friction::{LimitCurve, PressureDistribution};
///
/// let curve = LimitCurve::new(PressureDistribution::Hertz).table(9);
/// assert_eq!(curve.len(), 9);
/// // More torque, less force.
/// assert!(curve.is_sorted_by(|a, b| (a.torque <= b.torque) == (a.force >= b.force)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitCurve {
    pressure: PressureDistribution,
}

impl LimitCurve {
    /// The curve of a pressure distribution.
    #[must_use]
    pub const fn new(pressure: PressureDistribution) -> Self {
        Self { pressure }
    }

    /// The point for a centre of rotation at `centre` patch radii; 0 is pure spin, infinity pure
    /// sliding. A negative or NaN centre counts as 0.
    #[must_use]
    pub fn point(&self, centre: f64) -> LimitPoint {
        if centre == f64::INFINITY {
            return LimitPoint { force: 1.0, torque: 0.0, centre };
        }
        let centre = centre.max(0.0);
        let integrand = |r: f64| {
            let weight = 2.0 * r * self.pressure.relative(r);
            let (force, torque) = ring(r, centre);
            (weight * force, weight * torque)
        };
        let inner = double_exponential(0.0, centre.min(1.0), integrand);
        let outer = if centre < 1.0 { double_exponential(centre, 1.0, integrand) } else { (0.0, 0.0) };
        LimitPoint {
            force: inner.0 + outer.0,
            torque: (inner.1 + outer.1) / self.pressure.relative_arm(),
            centre,
        }
    }

    /// The point on the ray `force : torque = cos angle : sin angle`, for an angle from 0 (pure
    /// sliding) to π/2 (pure spin), clamped to that; found by bisection over the centre of rotation.
    #[must_use]
    pub fn at_angle(&self, angle: f64) -> LimitPoint {
        let angle = angle.clamp(0.0, core::f64::consts::FRAC_PI_2);
        if angle == 0.0 {
            return self.point(f64::INFINITY);
        }
        let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
        // The centre as tan of an angle, so that it runs over a finite range.
        let (mut low, mut high) = (0.0_f64, core::f64::consts::FRAC_PI_2);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let point = self.point(libm::tan(middle));
            if point.force * sine < point.torque * cosine {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.point(libm::tan(0.5 * (low + high)))
    }

    /// `count` points at even angles from pure sliding to pure spin.
    #[must_use]
    pub fn table(&self, count: usize) -> Vec<LimitPoint> {
        let last = count.saturating_sub(1).max(1) as f64;
        (0..count).map(|index| self.at_angle(core::f64::consts::FRAC_PI_2 * index as f64 / last)).collect()
    }
}

/// Mean force and torque of a ring of radius `r` turning about a centre at distance `d`.
fn ring(r: f64, d: f64) -> (f64, f64) {
    let sum = r + d;
    if sum <= 0.0 {
        return (0.0, 0.0);
    }
    let difference = (r - d).abs();
    let (first, second) = elliptic(difference / sum);
    let pi = core::f64::consts::PI;
    let of_difference = if difference > 0.0 { (r - d) * first } else { 0.0 };
    // For a far centre or a small ring both terms of F nearly cancel: F = d/dd of D, expanded.
    let force = if d <= 0.0 {
        0.0
    } else if r < 1e-3 * d {
        let x = (r / d) * (r / d);
        1.0 - 0.25 * x
    } else if d < 1e-3 * r {
        let x = d / r;
        0.5 * x * (1.0 + 0.125 * x * x)
    } else {
        (sum * second - of_difference) / (pi * d)
    };
    let torque = if r < 1e-3 * d {
        let x = r / d;
        0.5 * r * x * (1.0 + 0.125 * x * x)
    } else {
        (of_difference + sum * second) / pi
    };
    (force, torque)
}

/// Complete elliptic integrals K and E for the complementary modulus `k' = √(1−m)`, by the
/// arithmetic-geometric mean (Abramowitz & Stegun 17.6). K is infinite at 0; there the caller's
/// factor is zero, and 0 is returned for it.
fn elliptic(complement: f64) -> (f64, f64) {
    if complement <= 0.0 {
        return (0.0, 1.0);
    }
    let (mut a, mut b) = (1.0_f64, complement);
    let mut squares = 0.5 * (1.0 - complement * complement);
    let mut power = 0.5;
    for _ in 0..40 {
        let c = 0.5 * (a - b);
        let mean = 0.5 * (a + b);
        b = (a * b).sqrt();
        a = mean;
        power *= 2.0;
        squares += power * c * c;
        if c.abs() <= f64::EPSILON * a {
            break;
        }
    }
    let first = core::f64::consts::FRAC_PI_2 / a;
    (first, first * (1.0 - squares))
}

/// Integral of a pair of functions over `[low, high]` by the double-exponential (tanh-sinh) rule
/// of Takahasi & Mori (1974), which bears singular ends.
fn double_exponential(low: f64, high: f64, f: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
    let (step, half) = (1.0 / 16.0, 0.5 * (high - low));
    let mut sum = (0.0, 0.0);
    for index in -56..=56 {
        let t = step * f64::from(index);
        let argument = core::f64::consts::FRAC_PI_2 * libm::sinh(t);
        let width = libm::cosh(argument);
        let weight = core::f64::consts::FRAC_PI_2 * libm::cosh(t) / (width * width);
        // The distance from the nearer end keeps its digits.
        let from_end = half * libm::exp(-argument.abs()) / width;
        let x = if argument < 0.0 { low + from_end } else { high - from_end };
        let (first, second) = f(x);
        sum.0 += weight * first;
        sum.1 += weight * second;
    }
    (sum.0 * step * half, sum.1 * step * half)
}

#[cfg(test)]
mod tests {
    use super::{LimitCurve, elliptic};
    use crate::{PowerLimit, PressureDistribution};

    const ALL: [PressureDistribution; 7] = [
        PressureDistribution::Uniform,
        PressureDistribution::Hertz,
        PressureDistribution::Winkler,
        PressureDistribution::PowerLaw(1.5),
        PressureDistribution::PowerLaw(3.0),
        PressureDistribution::PowerLaw(4.0),
        PressureDistribution::PowerLaw(8.0),
    ];

    #[test]
    fn elliptic_integrals_match_closed_forms() {
        // K(1/2) = Γ(1/4)²/(4√π), and Legendre's relation E K' + E' K − K K' = π/2.
        let (first, _) = elliptic(0.5_f64.sqrt());
        let gamma = libm::tgamma(0.25);
        assert!((first - gamma * gamma / (4.0 * core::f64::consts::PI.sqrt())).abs() < 1e-14);
        for modulus in [0.01_f64, 0.3, 0.7, 0.999] {
            let (k, e) = elliptic((1.0 - modulus * modulus).sqrt());
            let (kc, ec) = elliptic(modulus);
            assert!((e * kc + ec * k - k * kc - core::f64::consts::FRAC_PI_2).abs() < 1e-12);
        }
    }

    /// A brute-force sum over the patch in polar coordinates, without elliptic integrals.
    #[test]
    fn points_match_a_sum_over_the_patch() {
        let (rings, sectors) = (2000, 512);
        for pressure in [PressureDistribution::Uniform, PressureDistribution::Hertz] {
            for centre in [0.2, 0.9, 2.5] {
                let (mut force, mut torque) = (0.0, 0.0);
                for i in 0..rings {
                    let r = ((f64::from(i) + 0.5) / f64::from(rings)).sqrt();
                    let share = pressure.relative(r) / f64::from(rings) / f64::from(sectors);
                    for j in 0..sectors {
                        let angle = core::f64::consts::TAU * (f64::from(j) + 0.5) / f64::from(sectors);
                        let (x, y) = (r * angle.cos() - centre, r * angle.sin());
                        let length = x.hypot(y);
                        // The velocity is (−y, x) about the centre of rotation.
                        force += share * -x / length;
                        torque += share * (r * angle.cos() * x + r * angle.sin() * y) / length;
                    }
                }
                let exact = LimitCurve::new(pressure).point(centre);
                assert!((exact.force - force).abs() < 1e-4, "{} {force}", exact.force);
                let torque = torque / pressure.relative_arm();
                assert!((exact.torque - torque).abs() < 1e-4, "{} {torque}", exact.torque);
            }
        }
    }

    #[test]
    fn ends_are_pure_spin_and_pure_sliding() {
        for pressure in ALL {
            let curve = LimitCurve::new(pressure);
            let spin = curve.point(0.0);
            assert!(spin.force.abs() < 1e-12 && (spin.torque - 1.0).abs() < 1e-9, "{pressure:?} {spin:?}");
            let sliding = curve.point(1e6);
            assert!((sliding.force - 1.0).abs() < 1e-9 && sliding.torque < 2e-6);
            assert!(curve.point(f64::NAN).force.abs() < 1e-12);
            assert_eq!(curve.at_angle(0.0), curve.point(f64::INFINITY));
            assert_eq!(curve.at_angle(-1.0).torque, 0.0);
            assert!(curve.at_angle(2.0).force < 1e-9);
        }
    }

    /// Near the middle `|f| = d ∫p dr`, far away `τ = ⟨r²⟩/2d + ⟨r⁴⟩/16d³` and `1 − |f| = ⟨r²⟩/4d²`, to the
    /// next order in d: the moments are known.
    #[test]
    fn near_and_far_centres_follow_their_series() {
        for (pressure, across, second, fourth) in [
            (PressureDistribution::Uniform, 1.0, 1.0 / 2.0, 1.0 / 3.0),
            (PressureDistribution::Hertz, 3.0 * core::f64::consts::PI / 8.0, 2.0 / 5.0, 8.0 / 35.0),
            (PressureDistribution::Winkler, 4.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0),
        ] {
            let curve = LimitCurve::new(pressure);
            for d in [1e-8, 1e-6, 1e-5, 1e-4, 1e-3] {
                let point = curve.point(d);
                // The next term is of the order of d² but for a logarithm.
                let error = point.force / (across * d) - 1.0;
                assert!(error.abs() < 10.0 * d * d + 1e-7, "{pressure:?} {d} {error}");
                assert!((point.torque - 1.0).abs() < 4.0 * d * d + 1e-9, "{pressure:?} {d} {point:?}");
            }
            for d in [100.0, 500.0, 999.0, 1001.0, 3000.0, 1e5] {
                let point = curve.point(d);
                let torque = (second / (2.0 * d) + fourth / (16.0 * d * d * d)) / pressure.relative_arm();
                assert!((point.torque / torque - 1.0).abs() < 1e-8, "{pressure:?} {d} {point:?} {torque}");
                let short = second / (4.0 * d * d);
                assert!(
                    (1.0 - point.force - short).abs() < 1e-4 * short + 1e-11,
                    "{pressure:?} {d} {point:?}"
                );
            }
        }
    }

    /// Where the centre of rotation lies moves the work rate nowhere down: the exact point is the
    /// one of greatest dissipation in its own direction (the limit surface is convex and smooth).
    #[test]
    fn curve_is_convex() {
        for pressure in ALL {
            let table = LimitCurve::new(pressure).table(41);
            for three in table.windows(3) {
                let (a, b, c) = (three[0], three[1], three[2]);
                let turn =
                    (b.force - a.force) * (c.torque - b.torque) - (b.torque - a.torque) * (c.force - b.force);
                assert!(turn > 0.0, "{pressure:?} {three:?}");
            }
        }
    }

    #[test]
    fn power_limit_is_within_one_percent() {
        for pressure in ALL {
            let limit = PowerLimit::for_patch(1.0_f64, 1.0, pressure).unwrap();
            let (mut least, mut greatest) = (f64::INFINITY, fingertip_test_support::Worst::new());
            for point in LimitCurve::new(pressure).table(91) {
                let q = limit.exponent();
                let gauge = (point.force.powf(q) + point.torque.powf(q)).powf(1.0 / q);
                let ellipse = point.force.hypot(point.torque);
                assert!(!ellipse.is_nan());
                least = least.min(ellipse);
                greatest.see(gauge - 1.0);
            }
            let greatest = greatest.get();
            println!("{pressure:?}: power limit within {greatest:.4}, least exact/ellipse {least:.4}");
            assert!(greatest <= 0.01, "{pressure:?} {greatest}");
            assert!(least >= 0.9335, "{pressure:?} {least}");
        }
    }
}
