//! Elliptic integrals in Carlson's symmetric form.

use fingertip_wrench::Real;

/// Duplications: each brings the arguments four times closer together, so that 32 do for every
/// ratio that the types can hold.
const BOUND: u32 = 64;

/// A zero stays what it is: the root's slope there, which a number with a derivative would take, is
/// infinite.
fn root<T: Real>(x: T) -> T {
    if x > T::zero() { x.root() } else { x }
}

/// `R_F(x, y, z) = ½ ∫₀^∞ dt/√((t+x)(t+y)(t+z))`; at most one argument zero, none negative
/// (Carlson 1995; DLMF 19.36.1).
pub(super) fn r_f<T: Real>(x: T, y: T, z: T) -> T {
    let quarter = T::literal(0.25);
    // The series that ends the iteration is exact to the sixth power of this.
    let close = (T::EPSILON * quarter).power(T::literal(1.0 / 6.0)) * T::literal(0.5);
    let (mut x, mut y, mut z) = (x, y, z);
    let mut result = T::zero();
    for _ in 0..BOUND {
        let mean = (x + y + z) / T::literal(3.0);
        let (dx, dy) = (T::one() - x / mean, T::one() - y / mean);
        let dz = -(dx + dy);
        if dx.abs().max(dy.abs()).max(dz.abs()) <= close {
            let (e2, e3) = (dx * dy - dz * dz, dx * dy * dz);
            let series = T::one() - e2 * T::literal(0.1) + e3 / T::literal(14.0) + e2 * e2 / T::literal(24.0)
                - e2 * e3 * T::literal(3.0 / 44.0);
            result = series / mean.root();
            break;
        }
        let (a, b, c) = (root(x), root(y), root(z));
        let lambda = a * b + a * c + b * c;
        x = (x + lambda) * quarter;
        y = (y + lambda) * quarter;
        z = (z + lambda) * quarter;
    }
    result
}

/// `R_D(x, y, z) = 3/2 ∫₀^∞ dt/(√((t+x)(t+y)) (t+z)^{3/2})`; at most one of `x`, `y` zero, `z`
/// positive (Carlson 1995; DLMF 19.36.2).
pub(super) fn r_d<T: Real>(x: T, y: T, z: T) -> T {
    let quarter = T::literal(0.25);
    let close = (T::EPSILON * quarter).power(T::literal(1.0 / 6.0)) * T::literal(0.35);
    let (mut x, mut y, mut z) = (x, y, z);
    let (mut sum, mut factor) = (T::zero(), T::one());
    let mut result = T::zero();
    for _ in 0..BOUND {
        let mean = (x + y + z * T::literal(3.0)) * T::literal(0.2);
        let (dx, dy) = (T::one() - x / mean, T::one() - y / mean);
        let dz = -(dx + dy) / T::literal(3.0);
        if dx.abs().max(dy.abs()).max(dz.abs()) <= close {
            let (xy, zz) = (dx * dy, dz * dz);
            let e2 = xy - zz * T::literal(6.0);
            let e3 = (xy * T::literal(3.0) - zz * T::literal(8.0)) * dz;
            let e4 = (xy - zz) * zz * T::literal(3.0);
            let e5 = xy * zz * dz;
            let series = T::one() - e2 * T::literal(3.0 / 14.0)
                + e3 / T::literal(6.0)
                + e2 * e2 * T::literal(9.0 / 88.0)
                - e4 * T::literal(3.0 / 22.0)
                - e2 * e3 * T::literal(9.0 / 52.0)
                + e5 * T::literal(3.0 / 26.0);
            result = sum * T::literal(3.0) + factor * series / (mean * mean.root());
            break;
        }
        let (a, b, c) = (root(x), root(y), root(z));
        let lambda = a * b + a * c + b * c;
        sum += factor / (c * (z + lambda));
        factor *= quarter;
        x = (x + lambda) * quarter;
        y = (y + lambda) * quarter;
        z = (z + lambda) * quarter;
    }
    result
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::Real;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::{r_d, r_f};

    /// Values of Carlson (1995), "Numerical computation of real or complex elliptic integrals".
    #[test]
    fn published_values() {
        // To half a unit of the last of 14 printed digits.
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 5e-14, "{a} {b}");
        near(r_f(1.0, 2.0, 0.0), 1.311_028_777_146_1);
        near(r_f(2.0, 3.0, 4.0), 0.584_082_841_677_15);
        near(r_d(0.0, 2.0, 1.0), 1.797_210_352_103_4);
        near(r_d(2.0, 3.0, 4.0), 0.165_105_272_942_61);
    }

    #[test]
    fn homogeneous_and_known_at_equal_arguments() {
        for x in [1e-30, 1e-3, 1.0, 7.0, 1e20_f64] {
            assert!((r_f(x, x, x) * x.sqrt() - 1.0).abs() < 1e-15);
            assert!((r_d(x, x, x) * x.powf(1.5) - 1.0).abs() < 1e-14);
        }
        // A ratio as large as a shape can have.
        assert!((r_f(0.0_f64, 1e-16, 1.0) - (4e8_f64).ln()).abs() < 1e-13);
    }

    /// `R_D(x, y, z) + R_D(y, z, x) + R_D(z, x, y) = 3/√(x y z)` (DLMF 19.21.8), at arguments so near each
    /// other that the series does all, and so far apart that duplications do.
    #[test]
    fn the_sum_over_the_places_is_known() {
        fn check<T: Real>(spread: f64, tolerance: f64) {
            let mut random = Pcg64Mcg::seed_from_u64(1);
            let mut any = || random.random_range(-0.5..0.5);
            for _ in 0..200 {
                let [x, y, z] = [(); 3].map(|()| T::literal(2.0 * (spread * any()).exp()));
                let sum = (r_d(x, y, z) + r_d(y, z, x) + r_d(z, x, y)).to_f64();
                let known = 3.0 / (x.to_f64() * y.to_f64() * z.to_f64()).sqrt();
                assert!((sum / known - 1.0).abs() < tolerance, "{x} {y} {z}: {sum} {known}");
            }
        }
        for spread in [1e-4, 5e-4, 1e-3, 2e-3, 0.1, 1.0, 10.0] {
            check::<f64>(spread, 4e-15);
        }
        for spread in [1e-3, 0.01, 0.03, 0.1, 1.0, 10.0] {
            check::<f32>(spread, 2e-6);
        }
    }

    /// `R_F(x, y, y) = arctan √((y − x)/x)/√(y − x)`, or with the areatangent where `x` is the greater (DLMF
    /// 19.2.17 to 19.2.19), whichever argument stands alone.
    #[test]
    fn two_equal_arguments_give_an_angle() {
        for ratio in [1e-12, 1e-3, 0.2, 0.9, 1.1, 3.0, 1e3_f64] {
            let (x, y) = (0.7, 0.7 * ratio);
            let apart = (y - x).abs();
            let angle = match ratio {
                1.0.. => (apart / x).sqrt().atan(),
                0.5.. => (apart / x).sqrt().atanh(),
                _ => (x / y).sqrt().acosh(),
            };
            let known = angle / apart.sqrt();
            for found in [r_f(x, y, y), r_f(y, x, y), r_f(y, y, x)] {
                assert!((found / known - 1.0).abs() < 4e-15, "{ratio} {found} {known}");
            }
            let [x, y] = [x as f32, y as f32];
            for found in [r_f(x, y, y), r_f(y, x, y), r_f(y, y, x)] {
                assert!((f64::from(found) / known - 1.0).abs() < 2e-6, "{ratio} {found} {known}");
            }
        }
    }
}
