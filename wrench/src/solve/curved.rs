//! A sensor whose signals are not quite proportional to the load: terms of higher order beside the matrix.

use nalgebra::{SMatrix, SVector, Vector6};
use thiserror::Error;

use crate::{Real, Wrench, WrenchSolver};

/// Stands for a third signal where there is none; no sensor has as many gauges.
const NONE: u8 = u8::MAX;

/// A product of two or three signals, and the load of one unit of it.
///
/// See [`CurvedInverse`] for an example.
///
/// ```
/// use fingertip_wrench::{CurvedInverse, ProductTerm, WrenchSolver};
/// use nalgebra::{Matrix6, Vector6};
///
/// // 1 N per volt of the first gauge, and −0.2 N per volt of the first times volt of the third.
/// let coupling = ProductTerm::of_two(0, 2, Vector6::x() * -0.2);
/// let sensor = CurvedInverse::new(Matrix6::<f64>::identity(), [coupling])?;
/// let signals = Vector6::new(2.0, 0.0, 3.0, 0.0, 0.0, 0.0);
/// assert!((sensor.solve(&signals).force().x - 0.8).abs() < 1e-15); // 2 − 0.2·2·3
/// # Ok::<(), fingertip_wrench::BadCurve>(())
/// ```
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
///
/// ```
/// use fingertip_wrench::{CurvedInverse, RadialTerm, WrenchSolver};
/// use nalgebra::{Matrix6, Vector6};
///
/// let bump = RadialTerm { centre: Vector6::x(), load: Vector6::x() };
/// let linear = CurvedInverse::new(Matrix6::<f64>::identity(), [])?;
/// let sensor = linear.with_radial(Vector6::repeat(1.0), [bump])?;
/// assert_eq!(sensor.solve(&Vector6::zeros()).force().x, 0.0);
/// // At its centre the bump is 1, less 1/√2, its value without load, and 1/(2√2), its slope there.
/// let at_centre = sensor.solve(&Vector6::x()).force().x;
/// assert!((at_centre - (2.0 - 1.5 / 2.0_f64.sqrt())).abs() < 1e-15);
/// # Ok::<(), fingertip_wrench::BadCurve>(())
/// ```
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
///
/// ```
/// use fingertip_wrench::{BadCurve, CurvedInverse, ProductTerm};
/// use nalgebra::{Matrix6, Vector6};
///
/// let beyond = ProductTerm::of_two(0, 6, Vector6::x());
/// let refused = CurvedInverse::new(Matrix6::<f64>::identity(), [beyond]).unwrap_err();
/// assert_eq!(refused, BadCurve::NoSuchSignal { signal: 6, gauges: 6 });
/// let told = "a term of the curved sensor model is a product of gauge 7, but there are 6 gauges";
/// assert_eq!(refused.to_string(), told);
/// ```
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
#[path = "curved_tests.rs"]
mod tests;
