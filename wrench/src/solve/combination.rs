//! Combinations of signals that see (almost) one load each.

use nalgebra::{SVector, Vector6};

use crate::Real;

/// A sparse matrix **M** whose product with the sensor matrix is block-triangular (equation (19) of
/// Bicchi & Dario 1987): what a [`Decoupled`](crate::Decoupled) solver is made of.
///
/// It is a type, and the tables are constants, so that terms with a zero cost nothing and factors
/// of ±1 become additions.
///
/// # For users
/// [`BicchiDario`], [`ThreeRosettes`] and [`FourRosettes`] are here. For a sensor of your own,
/// write down `MATRIX` and `KEPT`:
///
/// ```
/// use fingertip_wrench::Combination;
///
/// /// Four gauges on a cross for Fx, Fy, Tx, Ty, two more for Fz and Tz.
/// struct Cross;
/// impl Combination<6> for Cross {
///     const MATRIX: [[f64; 6]; 6] = [
///         [1.0, 0.0, -1.0, 0.0, 0.0, 0.0],
///         [0.0, 1.0, 0.0, -1.0, 0.0, 0.0],
///         [0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
///         [0.0, 1.0, 0.0, 1.0, 0.0, 0.0],
///         [1.0, 0.0, 1.0, 0.0, 0.0, 0.0],
///         [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
///     ];
///     // Each sees its own load; the fifth feels the first as well.
///     const KEPT: [[bool; 6]; 6] = {
///         let mut kept = fingertip_wrench::diagonal_pattern();
///         kept[4][0] = true;
///         kept
///     };
/// }
/// // A force along x bends gauges 0 and 2 the opposite ways, a torque about y the same way.
/// use nalgebra::Vector6;
/// let force = Vector6::new(0.5, 0.0, -0.5, 0.0, 0.0, 0.0);
/// let torque = Vector6::new(0.5, 0.0, 0.5, 0.0, 0.0, 0.0);
/// assert_eq!(Cross::combine(&force), Vector6::new(1.0, 0.0, 0.0, 0.0, 0.0, 0.0));
/// assert_eq!(Cross::combine(&torque), Vector6::new(0.0, 0.0, 0.0, 0.0, 1.0, 0.0));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no pattern of {N} gauges",
    note = "take one of the patterns of `fingertip_wrench`, for as many signals as the sensor has"
)]
pub trait Combination<const N: usize> {
    /// Row `i` says how the signals are combined to see load `i` of Fx, Fy, Fz, Tx, Ty, Tz.
    const MATRIX: [[f64; N]; 6];

    /// `KEPT[i][j]`: combination `i` is meant to see load `j`. The diagonal must be kept, and the
    /// pattern must be closed: where `i` sees `j` and `j` sees `k`, `i` must be let see `k` (so that
    /// the inverse has the same pattern). Every other entry of the calibrated product is neglected,
    /// and its effect bounded.
    const KEPT: [[bool; 6]; 6];

    /// The product `M · signals`.
    ///
    /// # For implementers
    /// Override it where sums can be shared. The result shall be `MATRIX · signals` with at most
    /// `N + 1` roundings on the way of each term.
    #[inline(always)]
    #[must_use]
    fn combine<T: Real>(signals: &SVector<T, N>) -> Vector6<T> {
        let mut combined = Vector6::zeros();
        for i in 0..6 {
            let mut sum: Option<T> = None;
            for j in 0..N {
                let factor = Self::MATRIX[i][j];
                sum = match sum {
                    _ if factor == 0.0 => sum,
                    // A product with a constant 1 or -1 the compiler leaves out.
                    Some(sum) => Some(sum + signals[j] * T::literal(factor)),
                    None => Some(signals[j] * T::literal(factor)),
                };
            }
            combined[i] = sum.unwrap_or(T::zero());
        }
        combined
    }
}

/// Every combination sees its own load only: the start of a [`Combination::KEPT`].
#[must_use]
pub const fn diagonal_pattern() -> [[bool; 6]; 6] {
    let mut kept = [[false; 6]; 6];
    let mut i = 0;
    while i < 6 {
        kept[i][i] = true;
        i += 1;
    }
    kept
}

/// For the six gauges of the paper
/// ([`bicchi_dario_gauges`](crate::gauges::gauge_layout::GaugeLayout::bicchi_dario_gauges)): its equation
/// (19) with the misprinted last rows mended, V₂ − V₄ and V₁ − V₃, which feel a shear force as well
/// as their bending moment.
///
/// ```
/// use fingertip_wrench::gauge_layout::{GaugeLayout, ThinWalledBeam};
/// use fingertip_wrench::{BicchiDario, Combination};
///
/// let beam = ThinWalledBeam { radius: 5e-3, thickness: 2e-4, youngs_modulus: 70e9, poisson_ratio: 0.33 };
/// let gauges = GaugeLayout::<f64, 6>::bicchi_dario_gauges(14.0_f64.to_radians(), 0.01);
/// let strain = GaugeLayout::new(&beam, gauges)?.strain_matrix();
/// // An axial force strains all four gauges of the ring alike: only the first combination sees it.
/// let seen = BicchiDario::combine(&strain.column(0).into_owned());
/// assert!((seen[0] / strain[(0, 0)] - 4.0).abs() < 1e-12);
/// assert!(seen.rows(1, 5).amax() < 1e-12 * seen[0]);
/// # Ok::<(), fingertip_wrench::gauge_layout::LayoutError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BicchiDario;

impl Combination<6> for BicchiDario {
    const MATRIX: [[f64; 6]; 6] = [
        [1.0, 1.0, 1.0, 1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        [0.0, 1.0, 0.0, 0.0, 0.0, -1.0],
        [-1.0, 1.0, -1.0, 1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, -1.0, 0.0, 0.0],
        [1.0, 0.0, -1.0, 0.0, 0.0, 0.0],
    ];
    const KEPT: [[bool; 6]; 6] = {
        let mut kept = diagonal_pattern();
        kept[4][1] = true;
        kept[5][2] = true;
        kept
    };

    #[inline(always)]
    fn combine<T: Real>(signals: &Vector6<T>) -> Vector6<T> {
        let [v1, v2, v3, v4, v5, v6] = signals.data.0[0];
        let (odd, even) = (v1 + v3, v2 + v4);
        Vector6::new(odd + even, v5 - v1, -(v6 - v2), even - odd, v2 - v4, v1 - v3)
    }
}

/// For three crossed pairs ±Q at 0°, 120° and 240° in one ring
/// ([`three_rosettes`](crate::gauges::gauge_layout::GaugeLayout::three_rosettes)), signals in the order
/// +, −, +, −, +, −. The sums of the pairs see axial force and bending, their differences torsion
/// and shear; no coupling is left.
///
/// ```
/// use fingertip_wrench::gauge_layout::{GaugeLayout, ThinWalledBeam, isotropic_angle};
/// use fingertip_wrench::{Decoupled, ThreeRosettes};
/// use nalgebra::Vector6;
///
/// let beam = ThinWalledBeam { radius: 5e-3, thickness: 2e-4, youngs_modulus: 70e9, poisson_ratio: 0.33 };
/// let layout = GaugeLayout::new(&beam, GaugeLayout::three_rosettes(isotropic_angle(0.33)))?;
/// let sensor = layout.sensor_matrix(1e4, Vector6::new(30.0, 30.0, 30.0, 0.15, 0.15, 0.15))?;
/// let solver = Decoupled::<f64, ThreeRosettes, 6>::new(&sensor)?;
/// // On the sensor of the drawing no load feigns another.
/// assert!(solver.neglected().amax() < 1e-14);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThreeRosettes;

impl Combination<6> for ThreeRosettes {
    const MATRIX: [[f64; 6]; 6] = [
        [1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
        [0.0, 0.0, 1.0, -1.0, -1.0, 1.0],
        [2.0, -2.0, -1.0, 1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0, -1.0, 1.0, -1.0],
        [0.0, 0.0, 1.0, 1.0, -1.0, -1.0],
        [2.0, 2.0, -1.0, -1.0, -1.0, -1.0],
    ];
    const KEPT: [[bool; 6]; 6] = diagonal_pattern();

    #[inline(always)]
    fn combine<T: Real>(signals: &Vector6<T>) -> Vector6<T> {
        let [a, b, c, d, e, f] = signals.data.0[0];
        let (sum1, sum2, sum3) = (a + b, c + d, e + f);
        let (difference1, difference2, difference3) = (a - b, c - d, e - f);
        let (sums, differences) = (sum2 + sum3, difference2 + difference3);
        Vector6::new(
            sum1 + sums,
            difference2 - difference3,
            difference1 + difference1 - differences,
            difference1 + differences,
            sum2 - sum3,
            sum1 + sum1 - sums,
        )
    }
}

/// For four crossed pairs ±Q at 0°, 90°, 180° and 270° in one ring
/// ([`four_rosettes`](crate::gauges::gauge_layout::GaugeLayout::four_rosettes)), signals in the order
/// +, −, +, −, …
///
/// ```
/// use fingertip_wrench::{Combination, FourRosettes};
/// use nalgebra::{SVector, Vector6};
///
/// // An axial force strains all gauges alike; a torque about the axis strains those of a pair oppositely.
/// let axial = SVector::<f64, 8>::repeat(1.0);
/// let torsion = SVector::from_fn(|i, _| if i % 2 == 0 { 1.0 } else { -1.0 });
/// assert_eq!(FourRosettes::combine(&axial), Vector6::new(8.0, 0.0, 0.0, 0.0, 0.0, 0.0));
/// assert_eq!(FourRosettes::combine(&torsion), Vector6::new(0.0, 0.0, 0.0, 8.0, 0.0, 0.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FourRosettes;

impl Combination<8> for FourRosettes {
    const MATRIX: [[f64; 8]; 6] = [
        [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
        [0.0, 0.0, 1.0, -1.0, 0.0, 0.0, -1.0, 1.0],
        [1.0, -1.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0],
        [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0],
        [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, -1.0, -1.0],
        [1.0, 1.0, 0.0, 0.0, -1.0, -1.0, 0.0, 0.0],
    ];
    const KEPT: [[bool; 6]; 6] = diagonal_pattern();

    #[inline(always)]
    fn combine<T: Real>(signals: &SVector<T, 8>) -> Vector6<T> {
        let [a, b, c, d, e, f, g, h] = signals.data.0[0];
        let sums = [a + b, c + d, e + f, g + h];
        let differences = [a - b, c - d, e - f, g - h];
        Vector6::new(
            (sums[0] + sums[2]) + (sums[1] + sums[3]),
            differences[1] - differences[3],
            differences[0] - differences[2],
            (differences[0] + differences[2]) + (differences[1] + differences[3]),
            sums[1] - sums[3],
            sums[0] - sums[2],
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tables without the shared sums.
    struct ByTable<C>(C);
    impl<const N: usize, C: Combination<N>> Combination<N> for ByTable<C> {
        const MATRIX: [[f64; N]; 6] = C::MATRIX;
        const KEPT: [[bool; 6]; 6] = C::KEPT;
    }

    fn check<const N: usize, C: Combination<N>>() {
        // Powers of three: sums are exact in f64 and no two of them agree by accident.
        let signals = SVector::<f64, N>::from_fn(|i, _| 3.0_f64.powi(i as i32));
        assert_eq!(C::combine(&signals), ByTable::<C>::combine(&signals));
    }

    /// A table with factors of all kinds, and a row of zeros.
    struct AnyFactors;
    impl Combination<6> for AnyFactors {
        const MATRIX: [[f64; 6]; 6] = [
            [0.5, 0.0, -1.0, 1.0, 3.0, -0.25],
            [-1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, -2.0, 0.0, 0.0, 0.0, 1.0],
            [0.0, 0.0, 1.0, 0.0, -1.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 0.0, -8.0],
        ];
        const KEPT: [[bool; 6]; 6] = diagonal_pattern();
    }

    #[test]
    fn a_combination_is_the_product_with_its_table() {
        let signals = SVector::<f64, 6>::from_fn(|i, _| 3.0_f64.powi(i as i32));
        let table = nalgebra::Matrix6::from_fn(|i, j| AnyFactors::MATRIX[i][j]);
        assert_eq!(AnyFactors::combine(&signals), table * signals);
    }

    #[test]
    fn shared_sums_agree_with_the_tables() {
        check::<6, BicchiDario>();
        check::<6, ThreeRosettes>();
        check::<8, FourRosettes>();
    }
}
