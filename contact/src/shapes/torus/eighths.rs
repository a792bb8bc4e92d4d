//! A trigonometric polynomial of degree 4 on the eighths of the circle, in Bernstein's basis.

use core::f64::consts::FRAC_1_SQRT_2;

use fingertip_wrench::Real;

/// `a₀ + Σ (a_k cos kθ + b_k sin kθ)`, `k` up to 4: `a₀, a₁, b₁, a₂ …`. Or nine coefficients in Bernstein's basis.
pub(super) type Fourth<T> = [T; 9];

/// `tan π/16`: where an eighth of the circle ends.
pub(super) const EDGE: f64 = 0.198_912_367_379_658;

/// The coefficients of `(1 + u²)⁴ cos kθ`, `u = tan θ/2`, in the Bernstein basis of degree 8 on the eighth of the circle
/// around `θ = 0`, from the middle one on; the others are the same the other way round.
const EVEN: [[f64; 5]; 5] = [
    [
        0.978_162_942_691_294_5,
        0.988_710_637_857_912_6,
        1.021_305_223_223_421_1,
        1.079_005_929_207_758_5,
        1.167_907_601_843_724_8,
    ],
    [
        0.988_710_637_857_912_6,
        0.994_341_297_890_842,
        1.011_284_460_695_374_1,
        1.039_630_520_550_959,
        1.079_005_929_207_758_5,
    ],
    [
        1.021_305_223_223_421_1,
        1.011_284_460_695_374_1,
        0.979_594_237_443_288_1,
        0.920_989_169_345_528_2,
        0.825_835_385_063_016_2,
    ],
    [
        1.079_005_929_207_758_5,
        1.039_630_520_550_959,
        0.920_989_169_345_528_2,
        0.722_605_961_930_139_2,
        0.446_938_889_758_837_3,
    ],
    [1.167_907_601_843_724_8, 1.079_005_929_207_758_5, 0.825_835_385_063_016_2, 0.446_938_889_758_837_3, 0.0],
];

/// The same of `(1 + u²)⁴ sin kθ`, from the one behind the middle on; the others have the opposite signs.
const ODD: [[f64; 4]; 4] = [
    [0.094_590_795_127_835_82, 0.195_418_294_157_766_5, 0.309_688_269_398_631_1, 0.446_938_889_758_837_3],
    [0.195_418_294_157_766_5, 0.395_640_436_521_425_7, 0.604_955_649_621_067_6, 0.825_835_385_063_016_2],
    [0.309_688_269_398_631_1, 0.604_955_649_621_067_6, 0.868_594_412_160_604_8, 1.079_005_929_207_758_5],
    [0.446_938_889_758_837_3, 0.825_835_385_063_016_2, 1.079_005_929_207_758_5, 1.167_907_601_843_724_8],
];

/// How many zeros a polynomial has between the ends of an interval, for what its signs say.
pub(super) enum Signs {
    None,
    /// The coefficients change their sign behind this one.
    One {
        from: usize,
    },
    Unknown,
}

/// By the coefficients in Bernstein's basis: the polynomial has no more zeros than they change signs, and one if they do
/// so once (Descartes' rule). What is not more than noise may have either sign, which changes nothing where it is alone
/// between the last of one sign and the first of the other.
#[inline(always)]
pub(super) fn signs<T: Real>(coefficients: &Fourth<T>, noise: T) -> Signs {
    const ALL: u32 = 0x1ff;
    let (mut above, mut below) = (0_u32, 0_u32);
    // A bit for each, without a branch.
    for (bit, x) in coefficients.iter().enumerate() {
        above |= u32::from(*x > noise) << bit;
        below |= u32::from(*x < -noise) << bit;
    }
    if above == ALL || below == ALL {
        return Signs::None;
    }
    if (above | below).count_ones() < 8 {
        return Signs::Unknown;
    }
    // The lowest bits, in a row, and the rest.
    let begins = |bits: u32| bits != 0 && bits & (bits + 1) == 0;
    let changes = |first: u32, last: u32| last != 0 && begins(first) && begins(!last & ALL);
    if changes(below, above) {
        Signs::One { from: below.trailing_ones() as usize - 1 }
    } else if changes(above, below) {
        Signs::One { from: above.trailing_ones() as usize - 1 }
    } else {
        Signs::Unknown
    }
}

/// The coefficients on both halves (de Casteljau's algorithm).
pub(super) fn halves<T: Real>(coefficients: &Fourth<T>) -> [Fourth<T>; 2] {
    let half = T::literal(0.5);
    let (mut first, mut second) = (*coefficients, *coefficients);
    for last in (1..9).rev() {
        for i in 0..last {
            second[i] = (second[i] + second[i + 1]) * half;
        }
        first[9 - last] = second[0];
    }
    [first, second]
}

/// The same, of the even part the middle and what follows it, and of the odd part what follows.
type Parts<T> = ([T; 5], [T; 4]);

fn combined<T: Real>((a, b): Parts<T>, (c, d): Parts<T>, sign: T) -> Parts<T> {
    (core::array::from_fn(|i| a[i] + c[i] * sign), core::array::from_fn(|i| b[i] + d[i] * sign))
}

/// One harmonic of the polynomial, `a cos kθ + b sin kθ`, on the eighth of the circle around `θ = 0`.
#[inline(always)]
fn harmonic<T: Real>(k: usize, a: T, b: T) -> Parts<T> {
    let even = EVEN[k].map(|x| a * T::literal(x));
    let odd = if k == 0 { [T::zero(); 4] } else { ODD[k - 1].map(|x| b * T::literal(x)) };
    (even, odd)
}

/// In Bernstein's basis on each eighth of the circle, the first being that around `θ = 0`.
///
/// A quarter turn changes nothing but signs of the harmonics, and a half turn those of the odd ones alone.
#[inline(always)]
pub(super) fn on_eighths<T: Real>([a0, a1, b1, a2, b2, a3, b3, a4, b4]: Fourth<T>) -> [Fourth<T>; 8] {
    let h = T::literal(FRAC_1_SQRT_2);
    let mut eighths = [[T::zero(); 9]; 8];
    for eighth in 0..2 {
        // Seen from the first eighth, or from the second.
        let [a1, b1, a2, b2, a3, b3, a4, b4] = if eighth == 0 {
            [a1, b1, a2, b2, a3, b3, a4, b4]
        } else {
            [h * (a1 + b1), h * (b1 - a1), b2, -a2, h * (b3 - a3), -h * (a3 + b3), -a4, -b4]
        };
        let one = T::one();
        let level = combined(harmonic(0, a0, T::zero()), harmonic(4, a4, b4), one);
        let second = harmonic(2, a2, b2);
        let odd = combined(harmonic(1, a1, b1), harmonic(3, a3, b3), one);
        let odd_turned = combined(harmonic(1, b1, -a1), harmonic(3, -b3, a3), one);
        for (quarter, even_sign, odd, odd_sign) in
            [(0, one, odd, one), (1, -one, odd_turned, one), (2, one, odd, -one), (3, -one, odd_turned, -one)]
        {
            let ([e0, e1, e2, e3, e4], [o1, o2, o3, o4]) =
                combined(combined(level, second, even_sign), odd, odd_sign);
            eighths[eighth + 2 * quarter] =
                [e4 - o4, e3 - o3, e2 - o2, e1 - o1, e0, e1 + o1, e2 + o2, e3 + o3, e4 + o4];
        }
    }
    eighths
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_4;

    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    fn value([a0, a1, b1, a2, b2, a3, b3, a4, b4]: Fourth<f64>, t: f64) -> f64 {
        let wave = |k: f64, a: f64, b: f64| a * (k * t).cos() + b * (k * t).sin();
        a0 + wave(1.0, a1, b1) + wave(2.0, a2, b2) + wave(3.0, a3, b3) + wave(4.0, a4, b4)
    }

    /// Between the ends of each eighth the coefficients tell the polynomial, and so do their halves of it.
    #[test]
    fn coefficients_tell_the_polynomial() {
        let mut random = Pcg64Mcg::seed_from_u64(53);
        for _ in 0..100 {
            let polynomial: Fourth<f64> = core::array::from_fn(|_| random.random_range(-1.0..1.0));
            for (k, coefficients) in on_eighths(polynomial).iter().enumerate() {
                let share: f64 = random.random_range(0.0..1.0);
                let there = |coefficients: &Fourth<f64>, share: f64| {
                    let binomials = [1.0, 8.0, 28.0, 56.0, 70.0, 56.0, 28.0, 8.0, 1.0];
                    let term = |i: usize| {
                        coefficients[i]
                            * binomials[i]
                            * share.powi(i as i32)
                            * (1.0 - share).powi(8 - i as i32)
                    };
                    (0..9).map(term).sum::<f64>()
                };
                let u = EDGE * (2.0 * share - 1.0);
                let truth = value(polynomial, k as f64 * FRAC_PI_4 + 2.0 * u.atan()) * (1.0 + u * u).powi(4);
                assert!((there(coefficients, share) - truth).abs() < 1e-13, "{k} {share}");
                let [first, second] = halves(coefficients);
                let half =
                    if share < 0.5 { there(&first, 2.0 * share) } else { there(&second, 2.0 * share - 1.0) };
                assert!((half - truth).abs() < 1e-13, "{k} {share}");
            }
        }
    }

    /// What is within noise counts with either sign.
    #[test]
    fn signs_within_noise_are_unknown() {
        let told = |coefficients: Fourth<f64>| match signs(&coefficients, 0.1) {
            Signs::None => "none",
            Signs::One { from: 3 } => "behind the fourth",
            Signs::One { .. } => "elsewhere",
            Signs::Unknown => "unknown",
        };
        let all = [1.0; 9];
        assert_eq!(told(all), "none");
        assert_eq!(told(all.map(|x: f64| -x)), "none");
        assert_eq!(told([1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0, -1.0]), "behind the fourth");
        assert_eq!(told([-1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0, 1.0]), "behind the fourth");
        // One in between may have the sign of the one before or of the one behind it; two might have both the other way.
        assert_eq!(told([1.0, 1.0, 1.0, 1.0, 0.05, -1.0, -1.0, -1.0, -1.0]), "behind the fourth");
        assert_eq!(told([1.0, 1.0, 1.0, 1.0, 0.05, -0.05, -1.0, -1.0, -1.0]), "unknown");
        // At an end, or between equal signs, it is no sign at all.
        assert_eq!(told([0.05, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]), "unknown");
        assert_eq!(told([1.0, 1.0, 1.0, 0.05, 1.0, 1.0, 1.0, 1.0, 1.0]), "unknown");
        assert_eq!(told([1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 0.05]), "unknown");
        assert_eq!(told([1.0, 1.0, -1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0]), "unknown");
        assert_eq!(told([f64::NAN; 9]), "unknown");
    }
}
