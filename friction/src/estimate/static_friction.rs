//! The static friction coefficient, learnt at each onset of slip.

use fingertip_wrench::numeric::normal::normal_quantile;
use fingertip_wrench::{ContactForce, Real, stored};

use crate::bad_parameter::not_negative;
use crate::{BadParameter, ForceNoise, NormalForceGate};

/// Half the width of the moving mean over the ratios.
const HALF: usize = 2;
/// Samples of the moving mean.
const MEAN: usize = 2 * HALF + 1;

/// A friction coefficient with its standard deviation.
///
/// ```
/// use fingertip_friction::{ForceNoise, FrictionEstimate, StaticFriction};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let noise = ForceNoise::isotropic(0.01)?;
/// let mut friction = StaticFriction::<f64>::with_noise(noise)?;
/// // Pulled ever harder, until it slips at a ratio of 0.5.
/// for step in 0..=100 {
///     friction.observe(&ContactForce::new(2.0, Vector3::x() * (0.01 * f64::from(step)), 0.0));
/// }
/// let Some(FrictionEstimate { coefficient, deviation, .. }) = friction.onset() else { panic!("it has slipped") };
/// assert!((coefficient - 0.5).abs() < 0.05 && deviation > 0.0);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrictionEstimate<T> {
    /// μ.
    pub coefficient: T,
    /// Its standard deviation.
    pub deviation: T,
    /// The last measurement did not fit what was known before: another surface. What was known
    /// has been given up.
    pub surface_changed: bool,
}

impl<T: Real> FrictionEstimate<T> {
    /// The coefficient that is undercut with probability `probability` (for control take a low
    /// one, such as 0.01), for a coefficient spread evenly in its logarithm; zero for a NaN.
    #[must_use]
    pub fn quantile(&self, probability: f64) -> T {
        if probability.is_nan() {
            return T::zero();
        }
        let relative = self.deviation / self.coefficient;
        let value = self.coefficient * (relative * T::literal(normal_quantile(probability))).exponential();
        if value.is_number() { value } else { T::zero() }
    }
}

/// Learns the static friction coefficient from the peak of the friction ratio before each slip
/// (`docs/theory/friction.md#static-friction`).
///
/// The last N ratios are kept. At an onset, the greatest of their five-sample means is taken; the
/// maximum of noisy means lies above the noise-free peak by about the expected maximum of as many
/// independent normal deviates as there are means not far below it, and that is taken off, as are the biases of a length
/// (Rice) and of a quotient. A steep ramp that ends in its peak is read low by two samples of its slope, on the safe side. Peaks of several onsets are fused in the logarithm of μ by a Kalman filter; one that misses
/// by more than four deviations starts anew.
///
/// Break-away falls with the rate of the force, so that peaks of one surface scatter by more than
/// the noise: `scatter` is that part.
///
/// ```
/// use fingertip_friction::{ForceNoise, StaticFriction};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let noise = ForceNoise::isotropic(0.01)?;
/// let mut friction = StaticFriction::<f64>::with_noise(noise)?;
/// // Pulled ever harder, until it slips at a ratio of 0.5.
/// for step in 0..=100 {
///     friction.observe(&ContactForce::new(2.0, Vector3::x() * (0.01 * f64::from(step)), 0.0));
/// }
/// assert!(friction.onset().is_some_and(|estimate| (estimate.coefficient - 0.5).abs() < 0.05));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticFriction<T, const N: usize = 64> {
    noise: ForceNoise<T>,
    gate: NormalForceGate<T>,
    scatter: T,
    wander: T,
    samples: [(T, T); N],
    next: usize,
    filled: usize,
    /// log μ and its variance.
    known: Option<(T, T)>,
}

impl<T: Real, const N: usize> StaticFriction<T, N> {
    /// From the noise of the contact force, the relative scatter of break-away on one surface (such
    /// as 0.05), and how much the surface may change, relatively, from one slip to the next (such
    /// as 0.01).
    ///
    /// # Errors
    /// [`BadParameter`] unless the noise is positive and finite and scatter and wander finite and not
    /// negative, or where N is below 5.
    pub fn new(noise: ForceNoise<T>, scatter: T, wander: T) -> Result<Self, BadParameter> {
        let noise = noise.checked()?;
        not_negative(scatter, "relative scatter of break-away")?;
        not_negative(wander, "relative change from slip to slip")?;
        if N < MEAN {
            return Err(BadParameter { parameter: "number of samples kept", requirement: "at least 5" });
        }
        Ok(Self {
            noise,
            gate: NormalForceGate::from_noise(&noise),
            scatter,
            wander,
            samples: [(T::zero(), T::zero()); N],
            next: 0,
            filled: 0,
            known: None,
        })
    }

    /// With what is known of the surface: log μ and its variance.
    #[cfg(feature = "serde")]
    fn knowing(self, known: Option<(T, T)>) -> Result<Self, BadParameter> {
        match known {
            Some((log, variance))
                if !(log.exponential().is_number() && variance >= T::zero() && variance.is_number()) =>
            {
                Err(BadParameter {
                    parameter: "known friction",
                    requirement: "finite, and its variance not negative",
                })
            }
            _ => Ok(Self { known, ..self }),
        }
    }

    /// Takes a sample; one that does not press forgets the window, one that is not finite counts
    /// for nothing.
    #[inline]
    pub fn observe(&mut self, force: &ContactForce<T>) {
        if !force.is_finite() {
            return;
        }
        let Some(ratio) = self.gate.ratio(force) else {
            self.filled = 0;
            return;
        };
        let deviation = self.noise.ratio_deviation(force.normal, ratio);
        // Without the bias of a length (Rice) and of a quotient.
        let of_length = self.noise.tangential / force.normal;
        let of_quotient = self.noise.normal / force.normal;
        let length = (ratio * ratio - of_length * of_length).max(T::zero()).root();
        let unbiased = length * (T::one() - of_quotient * of_quotient);
        if let Some(place) = self.samples.get_mut(self.next) {
            *place = (unbiased, deviation);
        }
        self.next = if self.next + 1 >= N { 0 } else { self.next + 1 };
        self.filled = (self.filled + 1).min(N);
    }

    /// The peak of the ratio in the window, with the bias of the maximum removed, and its standard
    /// deviation from the noise alone; `None` with fewer than five samples.
    #[must_use]
    pub fn peak(&self) -> Option<(T, T)> {
        if self.filled < MEAN {
            return None;
        }
        let at = |age: usize| {
            let index = (self.next + N - 1 - age) % N;
            self.samples.get(index).copied().unwrap_or((T::zero(), T::one()))
        };
        let means = self.filled - 2 * HALF;
        let smooth = |age: usize| {
            let (mut sum, mut variance) = (T::zero(), T::zero());
            for step in 0..MEAN {
                let (ratio, deviation) = at(age + step);
                sum += ratio;
                variance += deviation * deviation;
            }
            let count = T::literal(MEAN as f64);
            (sum / count, variance.root() / count)
        };
        let (mut peak, mut deviation) = smooth(0);
        for age in 1..means {
            let (mean, spread) = smooth(age);
            if mean > peak {
                (peak, deviation) = (mean, spread);
            }
        }
        // How many means compete with the greatest: those not far below the peak without its bias, which follows from
        // their number; twice is enough. Neighbours share samples.
        let mut bias = 0.0;
        for within in [2.0, 1.5] {
            let floor = peak - deviation * T::literal(bias + within);
            let rivals = (0..means).filter(|&age| smooth(age).0 > floor).count();
            let independent = (rivals as f64 / 2.0).max(1.0);
            // Blom's expectation of the greatest of n normal deviates.
            bias = normal_quantile((independent - 0.375) / (independent + 0.25)).max(0.0);
        }
        Some((peak - deviation * T::literal(bias), deviation))
    }

    /// Slip has just begun: measures the peak of the window, and fuses it with what is known. The
    /// window is forgotten, so that each onset counts once. `None` with too few samples.
    pub fn onset(&mut self) -> Option<FrictionEstimate<T>> {
        let (peak, deviation) = self.peak()?;
        self.filled = 0;
        if !(peak > T::zero() && deviation.is_number()) {
            return None;
        }
        let measured = peak.logarithm();
        let relative = deviation / peak;
        let uncertainty = relative * relative + self.scatter * self.scatter + T::LEAST_NORMAL;
        let mut surface_changed = false;
        let (log, variance) = match self.known {
            None => (measured, uncertainty),
            Some((log, variance)) => {
                let variance = variance + self.wander * self.wander;
                let total = variance + uncertainty;
                let miss = measured - log;
                if miss * miss > total * T::literal(16.0) {
                    surface_changed = true;
                    (measured, uncertainty)
                } else {
                    let gain = variance / total;
                    (log + gain * miss, variance * (T::one() - gain))
                }
            }
        };
        self.known = Some((log, variance));
        let coefficient = log.exponential();
        Some(FrictionEstimate { coefficient, deviation: coefficient * variance.root(), surface_changed })
    }

    /// What is known so far; `None` before the first onset.
    #[must_use]
    pub fn estimate(&self) -> Option<FrictionEstimate<T>> {
        self.known.map(|(log, variance)| {
            let coefficient = log.exponential();
            FrictionEstimate { coefficient, deviation: coefficient * variance.root(), surface_changed: false }
        })
    }

    /// Forgets the window and the surface.
    pub fn reset(&mut self) {
        self.filled = 0;
        self.known = None;
    }
}

impl<T: Real> StaticFriction<T, 64> {
    /// With a window of 64 samples, a scatter of 5 % and a wander of 1 %.
    ///
    /// # Errors
    /// [`BadParameter`] unless the noise is positive and finite.
    pub fn with_noise(noise: ForceNoise<T>) -> Result<Self, BadParameter> {
        Self::new(noise, T::literal(0.05), T::literal(0.01))
    }
}

stored! {
    StaticFriction<T, N>, [T: Real, const N: usize],
    |friction| {
        noise: ForceNoise<T> = friction.noise,
        scatter: T = friction.scatter,
        wander: T = friction.wander,
        /// What is known of the surface.
        log_coefficient_and_variance: Option<(T, T)> = friction.known,
    },
    Self::new(noise, scatter, wander).and_then(|new| new.knowing(log_coefficient_and_variance))
}

#[cfg(test)]
mod tests {
    use super::StaticFriction;
    use crate::ForceNoise;
    use fingertip_wrench::{ContactForce, Real};
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64Mcg;

    fn force<T: Real>(normal: f64, tangential: f64) -> ContactForce<T> {
        ContactForce::new(
            T::literal(normal),
            Vector3::new(T::literal(tangential), T::zero(), T::zero()),
            T::zero(),
        )
    }

    /// Ramps of several slopes and a plateau, each to a peak of 0.6 and then down.
    fn bias<T: Real>() {
        let mut rng = Pcg64Mcg::seed_from_u64(5);
        let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
        let (normal, sigma) = (2.0, 0.02);
        for slope in [0.0, 5e-4, 2e-3, 8e-3] {
            let (mut own, mut raw) = (0.0, 0.0);
            let count = 2000;
            for _ in 0..count {
                let noise = ForceNoise::isotropic(T::literal(sigma)).unwrap();
                let mut friction = StaticFriction::<T, 64>::with_noise(noise).unwrap();
                let mut greatest = 0.0_f64;
                for index in 0..64 {
                    let ratio = 0.6 - slope * f64::from(63 - index);
                    let sample = force::<T>(normal + sigma * draw(), ratio * normal + sigma * draw());
                    greatest = greatest.max(sample.friction_ratio().unwrap().to_f64());
                    friction.observe(&sample);
                }
                own += friction.peak().unwrap().0.to_f64() - 0.6;
                raw += greatest - 0.6;
            }
            let (own, raw) = (own / f64::from(count), raw / f64::from(count));
            println!("slope {slope}: bias {own:.5}, of the plain maximum {raw:.5}");
            // A deviation of the ratio is 0.0117; the moving mean loses two samples of slope.
            // On the low side more of a ramp is taken for rivals.
            assert!(own < 0.003 + slope && own > -0.003 - 4.0 * slope, "{own}");
            assert!(slope > 1e-3 || own.abs() < 0.25 * raw);
        }
    }

    #[test]
    fn the_bias_of_the_maximum_is_removed() {
        bias::<f64>();
        bias::<f32>();
    }

    /// Light plateaus: of 20 onsets each, at a normal force of 15 deviations of its noise.
    #[test]
    fn light_plateaus_are_not_read_high() {
        let mut rng = Pcg64Mcg::seed_from_u64(8);
        let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
        let noise = ForceNoise::isotropic(0.02).unwrap();
        for mu in [0.3, 0.5, 0.8] {
            let (mut sum, mut above) = (0.0, 0.0);
            for _ in 0..200 {
                let mut friction = StaticFriction::<f64>::with_noise(noise).unwrap();
                for _ in 0..20 {
                    for _ in 0..64 {
                        let normal = 0.3 + 0.02 * draw();
                        let tangential = Vector3::new(0.3 * mu + 0.02 * draw(), 0.02 * draw(), 0.0);
                        friction.observe(&ContactForce::new(normal, tangential, 0.0));
                    }
                    friction.onset();
                }
                let found = friction.estimate().unwrap();
                sum += (found.coefficient - mu) / 200.0;
                above += f64::from(u8::from(found.quantile(0.01) > mu)) / 200.0;
            }
            println!("{mu}: bias {sum:.4}, 1 % quantile above the truth in {:.1} %", 100.0 * above);
            assert!(sum.abs() < 0.015 * mu && above < 0.03, "{mu}: {sum} {above}");
        }
    }

    #[test]
    fn onsets_are_fused_and_a_new_surface_is_noticed() {
        let mut rng = Pcg64Mcg::seed_from_u64(6);
        let mut friction = StaticFriction::<f64>::with_noise(ForceNoise::isotropic(0.02).unwrap()).unwrap();
        let mut press = |mu: f64, friction: &mut StaticFriction<f64>| {
            let scatter: f64 = StandardNormal.sample(&mut rng);
            let peak: f64 = mu * (1.0 + 0.05 * scatter);
            let normal: f64 = rng.random_range(2.0..6.0);
            for index in 0..64 {
                let ratio = peak * (0.5 + 0.5 * f64::from(index) / 63.0);
                let noise: (f64, f64) = (StandardNormal.sample(&mut rng), StandardNormal.sample(&mut rng));
                friction.observe(&force(normal + 0.02 * noise.0, ratio * normal + 0.02 * noise.1));
            }
            friction.onset().unwrap()
        };
        let mut last = press(0.5, &mut friction);
        for _ in 0..20 {
            last = press(0.5, &mut friction);
            assert!(!last.surface_changed);
        }
        assert!((last.coefficient - 0.5).abs() < 4.0 * last.deviation && last.deviation < 0.012, "{last:?}");
        assert!(last.quantile(0.01) < last.coefficient - 2.0 * last.deviation);
        let changed = press(0.9, &mut friction);
        assert!(changed.surface_changed && (changed.coefficient - 0.9).abs() < 0.2, "{changed:?}");
        // The window counts once.
        assert!(friction.onset().is_none());
    }

    #[test]
    fn bad_input_counts_for_nothing() {
        let noise = ForceNoise::isotropic(0.02).unwrap();
        let mut friction = StaticFriction::<f64>::with_noise(noise).unwrap();
        for _ in 0..10 {
            friction.observe(&force(f64::NAN, 1.0));
            friction.observe(&force(1.0, f64::INFINITY));
        }
        assert!(friction.peak().is_none() && friction.onset().is_none() && friction.estimate().is_none());
        let known = crate::FrictionEstimate { coefficient: 0.5, deviation: 0.1, surface_changed: false };
        assert_eq!(known.quantile(f64::NAN), 0.0);
        assert!(StaticFriction::<f64, 64>::new(noise, f64::NAN, 0.0).is_err());
        assert!(StaticFriction::<f64, 4>::new(noise, 0.0, 0.0).is_err());
    }
}
