//! Which gauge lies.

use nalgebra::SVector;
use thiserror::Error;

use crate::gauges::false_alarm::normal_threshold;
use crate::{LeastSquares, Real};

/// Watches the redundant gauges of an extended sensor: is there a load that explains all signals,
/// and if not, which one gauge is at fault?
///
/// Each residual is compared with what the noise of the signals makes of it. The threshold is such
/// that a sound sensor raises an alarm in at most the stated fraction of the samples (normal noise,
/// Bonferroni's bound over the gauges). A gauge is named when leaving it out restores consistency
/// and leaving out any other does not; with seven gauges all residuals are in proportion, so that a
/// fault is seen but cannot be located.
///
/// ```
/// use fingertip_wrench::gauge_layout::{GaugeLayout, ThinWalledBeam, isotropic_angle};
/// use fingertip_wrench::{ConsistencyCheck, LeastSquares, Verdict};
/// use nalgebra::{SVector, Vector6};
///
/// let beam = ThinWalledBeam { radius: 5e-3, thickness: 2e-4, youngs_modulus: 70e9, poisson_ratio: 0.33 };
/// let layout = GaugeLayout::new(&beam, GaugeLayout::four_rosettes(isotropic_angle(0.33)))?;
/// let sensor = layout.sensor_matrix(1e4, Vector6::new(30.0, 30.0, 30.0, 0.15, 0.15, 0.15))?;
/// let solver = LeastSquares::new(&sensor)?;
/// let check = ConsistencyCheck::new(&solver, &SVector::repeat(1e-3), 1e-4)?;
///
/// let mut signals = SVector::<f64, 8>::repeat(0.1);
/// assert_eq!(check.verdict(&solver, &signals), Verdict::Consistent);
/// signals[2] = 0.5;
/// // This layout is so regular that a fault of any of the gauges turned the same way looks alike.
/// let suspects = [true, false, true, false, true, false, true, false];
/// assert_eq!(check.verdict(&solver, &signals), Verdict::Ambiguous { suspects });
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConsistencyCheck<T: Real, const N: usize> {
    /// Largest residual of each gauge that noise explains, in signal units.
    residual_limit: SVector<T, N>,
    /// Smallest signal that is not zero for noise.
    signal_limit: SVector<T, N>,
    /// Signals at or beyond these are saturated.
    range: (SVector<T, N>, SVector<T, N>),
}

/// What the signals say about themselves. Gauges count from 0.
///
/// ```
/// use fingertip_wrench::{ConsistencyCheck, LeastSquares, SensorMatrix, Verdict};
/// use nalgebra::{SMatrix, SVector, Vector6};
///
/// // A gauge for each load, and two more that see all of them in different proportions.
/// let matrix = SMatrix::<f64, 8, 6>::from_fn(|gauge, axis| match gauge {
///     6 => 1.0,
///     7 => 1.0 + axis as f64,
///     _ => if gauge == axis { 1.0 } else { 0.0 },
/// });
/// let solver = LeastSquares::new(&SensorMatrix::new(matrix, Vector6::repeat(1.0))?)?;
/// let check = ConsistencyCheck::new(&solver, &SVector::repeat(1e-3), 1e-4)?;
///
/// let mut signals = matrix * Vector6::repeat(0.1);
/// assert_eq!(check.verdict(&solver, &signals), Verdict::Consistent);
/// signals[2] += 0.25;
/// let verdict = check.verdict(&solver, &signals);
/// assert!(matches!(verdict, Verdict::Faulty { gauge: 2, error, .. } if (error - 0.25).abs() < 1e-12));
/// signals[4] -= 0.5;
/// assert_eq!(check.verdict(&solver, &signals), Verdict::Inconsistent);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict<T: Real, const N: usize> {
    /// A load explains all signals to within their noise.
    Consistent,
    /// One gauge contradicts all others, which agree among themselves.
    Faulty {
        /// Which one.
        gauge: usize,
        /// How it fails.
        fault: Fault,
        /// What it reads less what it ought to read by the others, in signal units; NaN or infinite
        /// if its signal is.
        error: T,
    },
    /// Some gauge is at fault: any one of these would explain it.
    Ambiguous {
        /// `true` for each gauge without which the others agree.
        suspects: [bool; N],
    },
    /// More than one gauge is at fault, or the load is beyond the sensor's linear range.
    Inconsistent,
}

/// How a gauge fails.
///
/// ```
/// use fingertip_wrench::{ConsistencyCheck, Fault, LeastSquares, SensorMatrix, Verdict};
/// use nalgebra::{SMatrix, SVector, Vector6};
///
/// // A gauge for each load, and two more that see all of them in different proportions.
/// let matrix = SMatrix::<f64, 8, 6>::from_fn(|gauge, axis| match gauge {
///     6 => 1.0,
///     7 => 1.0 + axis as f64,
///     _ => if gauge == axis { 1.0 } else { 0.0 },
/// });
/// let solver = LeastSquares::new(&SensorMatrix::new(matrix, Vector6::repeat(1.0))?)?;
/// // Signals are linear between -5 V and 5 V.
/// let check = ConsistencyCheck::new(&solver, &SVector::repeat(1e-3), 1e-4)?
///     .with_range(SVector::repeat(-5.0), SVector::repeat(5.0));
///
/// let sound = matrix * Vector6::repeat(0.1);
/// for (reads, expected) in [
///     (0.0, Fault::Dead),
///     (5.0, Fault::Saturated),
///     (0.3, Fault::Deviating),
///     (f64::NAN, Fault::NotFinite),
/// ] {
///     let mut signals = sound;
///     signals[3] = reads;
///     let verdict = check.verdict(&solver, &signals);
///     assert!(matches!(verdict, Verdict::Faulty { gauge: 3, fault, .. } if fault == expected));
/// }
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Fault {
    /// It reads zero while the others say that it should not.
    Dead,
    /// It reads a value at the end of its range.
    Saturated,
    /// It reads a number, but not the right one.
    Deviating,
    /// It reads NaN or infinity.
    NotFinite,
}

/// Why there is no threshold.
///
/// ```
/// use fingertip_wrench::{BadCheck, ConsistencyCheck, LeastSquares, SensorMatrix};
/// use nalgebra::{Matrix6, Vector6};
///
/// let sensor = SensorMatrix::new(Matrix6::identity(), Vector6::repeat(1.0))?;
/// let solver = LeastSquares::new(&sensor)?;
/// let mut noise = Vector6::repeat(1e-3_f64);
/// noise[5] = 0.0;
/// let refused = ConsistencyCheck::new(&solver, &noise, 1e-4).unwrap_err();
/// assert_eq!(refused, BadCheck::BadNoise { gauge: 5 });
/// assert_eq!(refused.to_string(), "the noise of gauge 5 is not a positive finite standard deviation");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadCheck {
    /// A standard deviation is zero, negative, NaN or infinite.
    #[error("the noise of gauge {gauge} is not a positive finite standard deviation")]
    BadNoise {
        /// Which gauge.
        gauge: usize,
    },
    /// The rate of false alarms is not between 0 and 1, both excluded.
    #[error("the rate of false alarms must be between 0 and 1")]
    BadRate,
}

impl<T: Real, const N: usize> ConsistencyCheck<T, N> {
    /// For signals with these standard deviations, and at most this fraction of false alarms per
    /// sample.
    ///
    /// # Errors
    /// [`BadCheck`].
    pub fn new(
        solver: &LeastSquares<T, N>,
        noise: &SVector<T, N>,
        false_alarm_rate: f64,
    ) -> Result<Self, BadCheck> {
        if let Some(gauge) = noise.iter().position(|x| !(*x > T::zero() && x.is_number())) {
            return Err(BadCheck::BadNoise { gauge });
        }
        if !(false_alarm_rate > 0.0 && false_alarm_rate < 1.0) {
            return Err(BadCheck::BadRate);
        }
        let deviations = T::literal(normal_threshold(false_alarm_rate / (2.0 * N as f64)));
        let scale = noise.amax().normalising_factor();
        let matrix = solver.residual_matrix();
        let residual_limit = SVector::from_fn(|gauge, _| {
            let variance = (0..N).fold(T::zero(), |sum, other| {
                let part = matrix[(gauge, other)] * noise[other] * scale;
                sum + part * part
            });
            variance.root() / scale * deviations
        });
        let range = (SVector::repeat(-T::GREATEST), SVector::repeat(T::GREATEST));
        Ok(Self { residual_limit, signal_limit: noise * deviations, range })
    }

    /// The same, knowing that a signal at or below `least`, or at or above `greatest`, is
    /// saturated.
    #[must_use]
    pub fn with_range(self, least: SVector<T, N>, greatest: SVector<T, N>) -> Self {
        Self { range: (least, greatest), ..self }
    }

    /// The largest residual of each gauge that noise explains, in signal units.
    #[inline]
    #[must_use]
    pub const fn residual_limit(&self) -> &SVector<T, N> {
        &self.residual_limit
    }

    /// Judges one reading. Costs one N×N product if the signals are consistent, N² such products at
    /// most if not.
    #[must_use]
    pub fn verdict(&self, solver: &LeastSquares<T, N>, signals: &SVector<T, N>) -> Verdict<T, N> {
        let mut broken = signals.iter().enumerate().filter(|(_, x)| !x.is_number());
        if let Some((gauge, signal)) = broken.next() {
            let rest_agrees = broken.next().is_none()
                && solver.repaired(signals, gauge).is_some_and(|repaired| self.agrees(solver, &repaired));
            return if rest_agrees {
                Verdict::Faulty { gauge, fault: Fault::NotFinite, error: *signal }
            } else {
                Verdict::Inconsistent
            };
        }
        if self.agrees(solver, signals) { Verdict::Consistent } else { self.locate(solver, signals) }
    }

    /// Whether noise explains every residual.
    fn agrees(&self, solver: &LeastSquares<T, N>, signals: &SVector<T, N>) -> bool {
        // What rounding alone may leave.
        let rounding = signals.amax() * T::EPSILON * T::literal(4.0 * N as f64);
        let residual = solver.residual(signals);
        residual.iter().zip(self.residual_limit.iter()).all(|(r, limit)| r.abs() <= *limit + rounding)
    }

    #[cold]
    fn locate(&self, solver: &LeastSquares<T, N>, signals: &SVector<T, N>) -> Verdict<T, N> {
        let mut suspects = [false; N];
        let mut found = None;
        for (gauge, suspect) in suspects.iter_mut().enumerate() {
            if let Some(repaired) = solver.repaired(signals, gauge) {
                *suspect = self.agrees(solver, &repaired);
                if *suspect {
                    found = Some((gauge, repaired[gauge]));
                }
            }
        }
        match (suspects.iter().filter(|suspect| **suspect).count(), found) {
            (1, Some((gauge, expected))) => {
                let signal = signals[gauge];
                let fault = if signal <= self.range.0[gauge] || signal >= self.range.1[gauge] {
                    Fault::Saturated
                } else if signal.abs() <= self.signal_limit[gauge] {
                    Fault::Dead
                } else {
                    Fault::Deviating
                };
                Verdict::Faulty { gauge, fault, error: signal - expected }
            }
            (0, _) => Verdict::Inconsistent,
            _ => Verdict::Ambiguous { suspects },
        }
    }
}

/// Finds a gauge that drifts, by the slow part of what no load explains: the exponentially weighted
/// mean of the signals, whose residual is less noisy than that of one sample, so that a smaller
/// fault shows.
///
/// With weight `w`, noise that is independent from sample to sample is averaged down by
/// `√(w/(2−w))`; the memory is about `1/w` samples. (Noise at mains frequency is not independent:
/// choose a memory of many periods.)
///
/// ```
/// use fingertip_wrench::{DriftMonitor, LeastSquares, SensorMatrix, Verdict};
/// use nalgebra::{SMatrix, SVector, Vector6};
///
/// // A gauge for each load, and two more that see all of them in different proportions.
/// let matrix = SMatrix::<f64, 8, 6>::from_fn(|gauge, axis| match gauge {
///     6 => 1.0,
///     7 => 1.0 + axis as f64,
///     _ => if gauge == axis { 1.0 } else { 0.0 },
/// });
/// let solver = LeastSquares::new(&SensorMatrix::new(matrix, Vector6::repeat(1.0))?)?;
/// let mut monitor = DriftMonitor::new(&solver, &SVector::repeat(1e-3), 0.05, 1e-4)?;
///
/// let mut signals = matrix * Vector6::repeat(0.1);
/// assert_eq!(monitor.update(&solver, &signals), None); // too early to say
/// let mut verdict = None;
/// for _ in 0..2000 {
///     signals[3] += 1e-5; // 10 µV with each reading
///     verdict = monitor.update(&solver, &signals);
/// }
/// assert!(matches!(verdict, Some(Verdict::Faulty { gauge: 3, .. })));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriftMonitor<T: Real, const N: usize> {
    check: ConsistencyCheck<T, N>,
    mean: SVector<T, N>,
    weight: T,
    samples: u32,
}

impl<T: Real, const N: usize> DriftMonitor<T, N> {
    /// With the noise of single signals, the weight that each new sample gets, and the fraction of
    /// verdicts that may be false alarms.
    ///
    /// # Errors
    /// [`BadCheck`]; a weight outside (0, 1] counts as a bad rate.
    pub fn new(
        solver: &LeastSquares<T, N>,
        noise: &SVector<T, N>,
        weight: T,
        false_alarm_rate: f64,
    ) -> Result<Self, BadCheck> {
        if !(weight > T::zero() && weight <= T::one()) {
            return Err(BadCheck::BadRate);
        }
        let averaged = (weight / (T::literal(2.0) - weight)).root();
        let check = ConsistencyCheck::new(solver, &(noise * averaged), false_alarm_rate)?;
        Ok(Self { check, mean: SVector::zeros(), weight, samples: 0 })
    }

    /// Takes a reading and judges the mean; `None` until some `2/weight` readings have settled it.
    /// A reading that is not finite is left out.
    pub fn update(&mut self, solver: &LeastSquares<T, N>, signals: &SVector<T, N>) -> Option<Verdict<T, N>> {
        if signals.iter().all(|x| x.is_number()) {
            self.samples = self.samples.saturating_add(1);
            // A plain mean to begin with, so that the first sample does not linger.
            let share = (T::one() / T::literal(f64::from(self.samples))).max(self.weight);
            self.mean += (signals - self.mean) * share;
        }
        let settled = T::literal(f64::from(self.samples)) * self.weight >= T::literal(2.0);
        settled.then(|| self.check.verdict(solver, &self.mean))
    }
}
