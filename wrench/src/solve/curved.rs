//! A sensor whose signals are not quite proportional to the load: terms of higher order beside the matrix.

use nalgebra::{SMatrix, SVector, Vector6};
use thiserror::Error;

use crate::{Real, Wrench, WrenchSolver};

/// Stands for a third signal where there is none; no sensor has as many gauges.
const NONE: u8 = u8::MAX;

/// A product of two or three signals, and the load of one unit of it.
///
/// See [`CurvedInverse`] for an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProductTerm<T: Real> {
    signals: [u8; 3],
    load: Vector6<T>,
}

impl<T: Real> ProductTerm<T> {
    /// Of two signals, by their numbers from 0 and not necessarily different; `load` in N and N·m per signal².
    #[must_use]
    pub const fn of_two(first: u8, second: u8, load: Vector6<T>) -> Self {
        Self { signals: [first, second, NONE], load }
    }

    /// Of three signals; `load` in N and N·m per signal³. A third signal of 255 is none: then it is one [of two](Self::of_two).
    #[must_use]
    pub const fn of_three(first: u8, second: u8, third: u8, load: Vector6<T>) -> Self {
        Self { signals: [first, second, third], load }
    }

    /// The product, and a signal that is not there counts as one.
    #[inline]
    fn value(&self, signals: &[T]) -> T {
        let [first, second, third] =
            self.signals.map(|index| signals.get(usize::from(index)).copied().unwrap_or_else(T::one));
        first * second * third
    }
}

/// A bump over the space of signals, `1/√(1 + r²)` with `r` the distance from its centre in widths, less its value
/// and its slope without load; and the load of one unit of it.
///
/// See [`CurvedInverse::with_radial`] for an example.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialTerm<T: Real, const N: usize> {
    /// Signals at which the bump is highest.
    pub centre: SVector<T, N>,
    /// Load of one unit of it \[N, N·m\].
    pub load: Vector6<T>,
}

/// The inverse regression of a sensor that is curved (`docs/theory/calibration.md#curved-sensors`):
///
/// ```text
/// wrench = L s + Σ q sᵢ sⱼ + Σ c sᵢ sⱼ sₖ + Σ e (φ(s − m) − φ(m) − s·∇φ(−m))
/// ```
///
/// `L` is 6 × N in N and N·m per signal; the products of two and of three signals are those that are given, each with a
/// load of six components; `φ(x) = 1/√(1 + Σ (xᵢ/wᵢ)²)` is the inverse multiquadric, a smooth correction about the
/// centre `m`. All terms but `L s` vanish to second order without load, so that a tare keeps its meaning and `L` is the
/// sensor's inverse for small loads.
///
/// Its answer is as good as the fit where that was made, and means little far beyond: see
/// [`CalibratedRegion`](crate::CalibratedRegion), which tells how far a reading is from there. A wrench that overflows is not
/// finite, and the contact then is "no contact: not finite".
///
/// The terms are arrays on a microcontroller, whose number is part of the type, and lists elsewhere. One product costs
/// eight multiplications, one bump `2N + 8`, a root and a division.
///
/// ```
/// use fingertip_wrench::{CurvedInverse, ProductTerm, WrenchSolver};
/// use nalgebra::{SMatrix, Vector6};
///
/// // 5 N/V along each axis, and a gauge that reads 2 % less than that at 1 V: 0.1 N/V² more.
/// let straight = SMatrix::<f64, 6, 6>::from_diagonal_element(5.0);
/// let sensor = CurvedInverse::new(straight, [ProductTerm::of_two(0, 0, Vector6::x() * 0.1)])?;
/// let wrench = sensor.solve(&Vector6::new(1.0, 0.0, 2.0, 0.0, 0.0, 0.0));
/// assert_eq!(wrench.force().x, 5.1);
/// assert_eq!(wrench.force().z, 10.0);
/// // What one more volt would say.
/// assert!((sensor.jacobian(&Vector6::x())[(0, 0)] - 5.2).abs() < 1e-15);
/// # Ok::<(), fingertip_wrench::BadCurve>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedInverse<T: Real, const N: usize, P = [ProductTerm<T>; 0], R = [RadialTerm<T, N>; 0]> {
    /// Less the slopes of the bumps without load.
    slope: SMatrix<T, 6, N>,
    products: P,
    radial: R,
    /// Reciprocals of the widths.
    per_width: SVector<T, N>,
    /// What the bumps are without load.
    at_rest: Vector6<T>,
}

/// Why terms are no curved sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadCurve {
    /// A coefficient is NaN or infinite.
    #[error("a coefficient of the curved sensor model is not a finite number")]
    NotFinite,
    /// A product is of a signal that the sensor does not have.
    #[error("a term of the curved sensor model is a product of gauge {}, but there are {gauges} gauges", .signal + 1)]
    NoSuchSignal {
        /// Its number, from 0.
        signal: u8,
        /// How many there are.
        gauges: usize,
    },
    /// A width of the bumps is zero, negative or not finite.
    #[error("the widths of the radial terms of the sensor model must be positive")]
    Width,
}

impl<T: Real, const N: usize, P: AsRef<[ProductTerm<T>]>> CurvedInverse<T, N, P> {
    /// From the linear part, in N and N·m per signal, and products of signals.
    ///
    /// # Errors
    /// [`BadCurve::NotFinite`], [`BadCurve::NoSuchSignal`].
    pub fn new(linear: SMatrix<T, 6, N>, products: P) -> Result<Self, BadCurve> {
        for term in products.as_ref() {
            let [first, second, third] = term.signals;
            let lacking = |index: &u8| usize::from(*index) >= N;
            let last = (third != NONE).then_some(third);
            if let Some(signal) = [first, second].into_iter().chain(last).find(lacking) {
                return Err(BadCurve::NoSuchSignal { signal, gauges: N });
            }
        }
        let mut coefficients =
            linear.iter().chain(products.as_ref().iter().flat_map(|term| term.load.iter()));
        if !coefficients.all(|x| x.is_number()) {
            return Err(BadCurve::NotFinite);
        }
        Ok(Self {
            slope: linear,
            products,
            radial: [],
            per_width: SVector::repeat(T::one()),
            at_rest: Vector6::zeros(),
        })
    }

    /// With bumps beside the products. `widths` are in signals, one for each gauge.
    ///
    /// # Errors
    /// [`BadCurve::Width`], [`BadCurve::NotFinite`].
    ///
    /// ```
    /// use fingertip_wrench::{CurvedInverse, RadialTerm, WrenchSolver};
    /// use nalgebra::{SMatrix, Vector6};
    ///
    /// let bump = RadialTerm { centre: Vector6::x(), load: Vector6::z() };
    /// let sensor = CurvedInverse::new(SMatrix::<f64, 6, 6>::identity(), [])?
    ///     .with_radial(Vector6::repeat(1.0), [bump])?;
    /// // Without load it says none.
    /// assert_eq!(sensor.solve(&Vector6::zeros()).force().z, 0.0);
    /// // At the centre: 1 less what it was without load, 1/√2, and its slope there, 1/√8.
    /// let expected = 1.0 - 0.5_f64.sqrt() - 0.125_f64.sqrt();
    /// assert!((sensor.solve(&Vector6::x()).force().z - expected).abs() < 1e-15);
    /// # Ok::<(), fingertip_wrench::BadCurve>(())
    /// ```
    pub fn with_radial<R: AsRef<[RadialTerm<T, N>]>>(
        self,
        widths: SVector<T, N>,
        radial: R,
    ) -> Result<CurvedInverse<T, N, P, R>, BadCurve> {
        let per_width = widths.map(|width| T::one() / width);
        let usable = |x: &T| *x > T::zero() && x.is_number();
        if !(widths.iter().all(usable) && per_width.iter().all(usable)) {
            return Err(BadCurve::Width);
        }
        let (mut slope, mut at_rest) = (self.slope, Vector6::zeros());
        for term in radial.as_ref() {
            let (height, fall) = bump(&per_width, &SVector::zeros(), &term.centre);
            at_rest += term.load * height;
            slope -= term.load * fall.transpose();
        }
        if !slope.iter().chain(&at_rest).all(|x| x.is_number()) {
            return Err(BadCurve::NotFinite);
        }
        Ok(CurvedInverse { slope, products: self.products, radial, per_width, at_rest })
    }
}

/// Height and gradient of a bump at some signals.
#[inline]
fn bump<T: Real, const N: usize>(
    per_width: &SVector<T, N>,
    signals: &SVector<T, N>,
    centre: &SVector<T, N>,
) -> (T, SVector<T, N>) {
    let away = (signals - centre).component_mul(per_width);
    let height = T::one() / (T::one() + away.norm_squared()).root();
    // Far away the cube of the height is zero before the distance overflows.
    let fall = away.component_mul(per_width) * -(height * height * height);
    (height, fall)
}

impl<T: Real, const N: usize, P, R> CurvedInverse<T, N, P, R>
where
    P: AsRef<[ProductTerm<T>]>,
    R: AsRef<[RadialTerm<T, N>]>,
{
    /// How the wrench changes with the signals: 6 × N, in N and N·m per signal. With the covariance `Σ` of the signals,
    /// that of the wrench is `J Σ Jᵀ` (first order). Without load it is the linear part. Not finite if the signals are
    /// not.
    #[must_use]
    pub fn jacobian(&self, signals: &SVector<T, N>) -> SMatrix<T, 6, N> {
        let mut jacobian = self.slope;
        for term in self.products.as_ref() {
            for place in 0..3 {
                let Some(varied) = term.signals.get(place).map(|index| usize::from(*index)) else { continue };
                if varied >= N {
                    continue;
                }
                let mut others = *term;
                // A signal that is not there counts as one, and so does the one that varies.
                others.signals.iter_mut().skip(place).take(1).for_each(|index| *index = NONE);
                let slope = others.value(signals.as_slice());
                jacobian.column_mut(varied).axpy(slope, &term.load, T::one());
            }
        }
        for term in self.radial.as_ref() {
            let (_, fall) = bump(&self.per_width, signals, &term.centre);
            jacobian += term.load * fall.transpose();
        }
        jacobian
    }
}

impl<T: Real, const N: usize, P, R> WrenchSolver<T, N> for CurvedInverse<T, N, P, R>
where
    P: AsRef<[ProductTerm<T>]>,
    R: AsRef<[RadialTerm<T, N>]>,
{
    #[inline]
    fn solve(&self, signals: &SVector<T, N>) -> Wrench<T> {
        let mut wrench = self.slope * signals - self.at_rest;
        for term in self.products.as_ref() {
            wrench.axpy(term.value(signals.as_slice()), &term.load, T::one());
        }
        for term in self.radial.as_ref() {
            let away = (signals - term.centre).component_mul(&self.per_width);
            let height = T::one() / (T::one() + away.norm_squared()).root();
            wrench.axpy(height, &term.load, T::one());
        }
        Wrench::from_components(&wrench)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{SMatrix, SVector, Vector6};
    use proptest::prelude::*;

    use super::{BadCurve, CurvedInverse, ProductTerm, RadialTerm};
    use crate::{Real, WrenchSolver as _};

    /// Different in every coefficient.
    fn coefficient<T: Real>(axis: usize, i: usize, j: usize) -> T {
        T::literal(((1 + axis) as f64 * 1.3 + (3 + i) as f64 * 0.7 + (5 + j) as f64 * 2.9).sin())
    }

    fn linear<T: Real, const N: usize>() -> SMatrix<T, 6, N> {
        SMatrix::from_fn(|axis, gauge| coefficient::<T>(axis, 17, gauge) * T::literal(10.0))
    }

    fn load<T: Real>(i: usize, j: usize) -> Vector6<T> {
        Vector6::from_fn(|axis, _| coefficient(axis, i, j))
    }

    const CUBES: [[u8; 3]; 4] = [[0, 0, 0], [0, 1, 2], [3, 3, 5], [7, 4, 4]];

    /// All pairs, and some products of three.
    fn products<T: Real>() -> Vec<ProductTerm<T>> {
        let pairs = (0..8_u8).flat_map(|i| (i..8).map(move |j| (i, j)));
        let pairs = pairs.map(|(i, j)| ProductTerm::of_two(i, j, load(usize::from(i), usize::from(j))));
        let cubes =
            CUBES.iter().enumerate().map(|(k, [a, b, c])| ProductTerm::of_three(*a, *b, *c, load(20 + k, 3)));
        pairs.chain(cubes).collect()
    }

    fn widths() -> [f64; 8] {
        core::array::from_fn(|i| 0.5 + 0.3 * i as f64)
    }

    fn centres() -> [[f64; 8]; 3] {
        core::array::from_fn(|k| core::array::from_fn(|i| coefficient::<f64>(k, 31, i)))
    }

    type Sensor<T> = CurvedInverse<T, 8, Vec<ProductTerm<T>>, Vec<RadialTerm<T, 8>>>;

    fn sensor<T: Real>() -> Sensor<T> {
        let radial = centres().into_iter().enumerate().map(|(k, centre)| RadialTerm {
            centre: SVector::from(centre.map(T::literal)),
            load: load(40 + k, 5),
        });
        let curved = CurvedInverse::new(linear(), products()).unwrap();
        curved.with_radial(SVector::from(widths().map(T::literal)), radial.collect()).unwrap()
    }

    /// The sum as the formula has it, component by component; the slope of the bumps by differences of the eighth digit.
    fn by_formula(signals: &[f64; 8], axis: usize) -> f64 {
        let linear = linear::<f64, 8>();
        let mut expected: f64 = (0..8).map(|i| linear[(axis, i)] * signals[i]).sum();
        for i in 0..8 {
            for j in i..8 {
                expected += coefficient::<f64>(axis, i, j) * signals[i] * signals[j];
            }
        }
        for (k, factors) in CUBES.iter().enumerate() {
            let product: f64 = factors.iter().map(|i| signals[usize::from(*i)]).product();
            expected += coefficient::<f64>(axis, 20 + k, 3) * product;
        }
        for (k, centre) in centres().iter().enumerate() {
            let height = |at: &dyn Fn(usize) -> f64| {
                let square: f64 = (0..8).map(|i| ((at(i) - centre[i]) / widths()[i]).powi(2)).sum();
                1.0 / (1.0 + square).sqrt()
            };
            let along = |step: f64| height(&|i| step * signals[i]);
            let slope = (along(1e-4) - along(-1e-4)) / 2e-4;
            expected += coefficient::<f64>(axis, 40 + k, 5) * (along(1.0) - along(0.0) - slope);
        }
        expected
    }

    proptest! {
        #[test]
        fn every_term_counts_once(signals in proptest::array::uniform8(-3.0..3.0_f64)) {
            let found = sensor::<f64>().solve(&SVector::from(signals)).components();
            let narrow = sensor::<f32>().solve(&SVector::from(signals.map(|x| x as f32))).components();
            for axis in 0..6 {
                let expected = by_formula(&signals, axis);
                prop_assert!((found[axis] - expected).abs() < 1e-6, "{} for {expected}", found[axis]);
                prop_assert!((f64::from(narrow[axis]) - expected).abs() < 3e-3);
            }
        }

        /// Against differences, which err by the third derivative.
        #[test]
        fn the_jacobian_is_the_slope(signals in proptest::array::uniform8(-3.0..3.0_f64), gauge in 0..8_usize) {
            let (sensor, at) = (sensor::<f64>(), SVector::from(signals));
            let step = SVector::<f64, 8>::ith(gauge, 1e-4);
            let away = |step| sensor.solve(&(at + step)).components();
            let slope = (away(step) - away(-step)) / 2e-4;
            let difference = sensor.jacobian(&at).column(gauge) - slope;
            prop_assert!(difference.amax() < 1e-6, "{difference}");
        }
    }

    /// A tare keeps its meaning, and the linear part is the sensor of small loads.
    #[test]
    fn without_load_only_the_linear_part_is_left() {
        let sensor = sensor::<f64>();
        assert!(sensor.solve(&SVector::zeros()).components().amax() < 1e-15);
        assert!((sensor.jacobian(&SVector::zeros()) - linear::<f64, 8>()).amax() < 1e-14);
        let straight =
            CurvedInverse::new(linear::<f64, 7>(), [ProductTerm::of_two(0, 6, Vector6::zeros())]).unwrap();
        let signals = SVector::from_fn(|i, _| 0.1 * i as f64 - 0.3);
        let difference = straight.solve(&signals).components() - linear::<f64, 7>() * signals;
        assert!(difference.amax() < 1e-13);
    }

    #[test]
    fn terms_that_are_none_are_refused() {
        for bad in [f64::NAN, f64::INFINITY] {
            let broken = |place: usize| {
                let load = Vector6::from_fn(|i, _| if i == place { bad } else { 1.0 });
                CurvedInverse::<f64, 6, _>::new(
                    linear(),
                    [ProductTerm::of_two(0, 0, Vector6::x()), ProductTerm::of_two(0, 5, load)],
                )
            };
            assert!((0..6).all(|place| broken(place).err() == Some(BadCurve::NotFinite)));
            assert!(broken(6).is_ok());
            let crooked = SMatrix::<f64, 6, 6>::repeat(bad);
            assert!(CurvedInverse::new(crooked, [ProductTerm::of_two(0, 0, Vector6::zeros())]).is_err());
            let radial = |centre, load| {
                let curved =
                    CurvedInverse::new(linear::<f64, 6>(), [ProductTerm::of_two(0, 0, Vector6::zeros())]);
                curved.unwrap().with_radial(Vector6::repeat(1.0), [RadialTerm { centre, load }])
            };
            assert!(radial(Vector6::repeat(0.1), Vector6::y()).is_ok());
            for (centre, load) in [(Vector6::repeat(bad), Vector6::y()), (Vector6::y(), Vector6::repeat(bad))]
            {
                assert_eq!(radial(centre, load).err(), Some(BadCurve::NotFinite));
            }
        }
        for (term, signal) in [
            (ProductTerm::of_two(0, 6, Vector6::<f64>::x()), 6),
            (ProductTerm::of_two(7, 0, Vector6::x()), 7),
            (ProductTerm::of_three(5, 5, 9, Vector6::x()), 9),
        ] {
            let error = CurvedInverse::new(linear::<f64, 6>(), [term]).unwrap_err();
            assert_eq!(error, BadCurve::NoSuchSignal { signal, gauges: 6 });
            assert!(error.to_string().contains(&format!("gauge {}", signal + 1)), "{error}");
        }
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-320] {
            let curved = CurvedInverse::new(linear::<f64, 8>(), products()).unwrap();
            let widths = SVector::from_fn(|i, _| if i == 3 { bad } else { 1.0 });
            assert_eq!(curved.with_radial(widths, Vec::new()).unwrap_err(), BadCurve::Width, "{bad}");
        }
    }

    #[test]
    fn extremes_overflow_and_do_not_panic() {
        for size in [0.0, 1e-320, 1e90, 1e200, f64::MAX, f64::INFINITY, f64::NAN] {
            let wrench = sensor::<f64>().solve(&SVector::repeat(size));
            assert_eq!(wrench.is_finite(), size < 1e100, "{size}: {wrench:?}");
            let slopes = sensor::<f64>().jacobian(&SVector::repeat(size));
            assert_eq!(slopes.iter().all(|x| x.is_finite()), size < 1e100, "{size}");
        }
    }
}
