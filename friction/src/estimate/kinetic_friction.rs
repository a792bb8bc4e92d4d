//! The kinetic friction coefficient, learnt while it slides.

use fingertip_wrench::{ContactForce, Real, stored};

use crate::bad_parameter::positive;
use crate::{BadParameter, Cusum, ForceNoise, FrictionEstimate, NormalForceGate};

/// Fits `|f_t| = μ f_n` to the samples of a slide, with noise on both (Deming's regression through
/// the origin) and exponential forgetting (`docs/theory/friction.md#kinetic-friction`):
///
/// `μ = [S_tt − λS_nn + √((S_tt − λS_nn)² + 4λS_nt²)]/(2S_nt)`, `λ = σ_t²/σ_n²`.
///
/// Plain least squares is biased low (the noise of `f_n` attenuates it), the mean of ratios high.
/// A two-sided cumulative sum of the residuals notices another surface, whereupon the sums start
/// anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KineticFriction<T> {
    noise: ForceNoise<T>,
    gate: NormalForceGate<T>,
    memory: T,
    tangential: T,
    normal: T,
    product: T,
    /// Sum of `w² f_n²`, for the variance.
    squared_weights: T,
    samples: u32,
    above: Cusum<T>,
    below: Cusum<T>,
    changed: bool,
}

impl<T: Real> KineticFriction<T> {
    /// From the noise of the contact force and the time over which samples are forgotten \[s\].
    ///
    /// # Errors
    /// [`BadParameter`] unless all are positive and finite.
    pub fn new(noise: ForceNoise<T>, memory: T) -> Result<Self, BadParameter> {
        let noise = noise.checked()?;
        let memory = positive(memory, "memory")?;
        let sum = Cusum::new(T::one(), T::literal(8.0))?;
        Ok(Self {
            noise,
            gate: NormalForceGate::from_noise(&noise),
            memory,
            tangential: T::zero(),
            normal: T::zero(),
            product: T::zero(),
            squared_weights: T::zero(),
            samples: 0,
            above: sum,
            below: sum,
            changed: false,
        })
    }

    /// Takes a sample of a slide and the time since the one before \[s\]. Samples that do not press
    /// well, are not finite, or have a negative time count for nothing.
    #[inline]
    pub fn observe(&mut self, force: &ContactForce<T>, time_step: T) {
        if !(force.is_finite() && time_step >= T::zero() && time_step.is_number()) {
            return;
        }
        let normal = force.normal;
        if !(normal > self.gate.least()) {
            return;
        }
        let tangential = force.tangential_magnitude();
        if self.samples >= 16
            && let Some(known) = self.estimate()
        {
            let residual = tangential - known.coefficient * normal;
            let scaled = known.coefficient * self.noise.normal;
            let wide = known.deviation * normal;
            let deviation =
                (self.noise.tangential * self.noise.tangential + scaled * scaled + wide * wide).root();
            let standardised = (residual / deviation).clamp(T::literal(-4.0), T::literal(4.0));
            // Both sums are fed, whatever the first says.
            let (above, below) = (self.above.add(standardised), self.below.add(-standardised));
            if above || below {
                self.forget();
                self.changed = true;
            }
        }
        let keep = self.memory / (self.memory + time_step);
        let (t, n) = (tangential, normal);
        let sums = (
            self.tangential * keep + t * t,
            self.normal * keep + n * n,
            self.product * keep + t * n,
            self.squared_weights * keep * keep + n * n,
        );
        if sums.0.is_number() && sums.1.is_number() && sums.2.is_number() && sums.3.is_number() {
            (self.tangential, self.normal, self.product, self.squared_weights) = sums;
            self.samples = self.samples.saturating_add(1);
        }
    }

    /// The coefficient and its standard deviation from the noise; `None` before two samples of a
    /// loaded slide. `surface_changed` holds from a change until [`acknowledge`](Self::acknowledge).
    #[must_use]
    pub fn estimate(&self) -> Option<FrictionEstimate<T>> {
        if self.samples < 2 || !(self.product > T::zero()) {
            return None;
        }
        let lambda =
            (self.noise.tangential / self.noise.normal) * (self.noise.tangential / self.noise.normal);
        let unit = self.normal.max(self.tangential).normalising_factor();
        let (tt, nn, nt) = (self.tangential * unit, self.normal * unit, self.product * unit);
        let difference = tt - lambda * nn;
        let root = crate::limits::cone::hypot(difference, T::literal(2.0) * lambda.root() * nt);
        // The form without cancellation on either side.
        let coefficient = if difference >= T::zero() {
            (difference + root) / (nt + nt)
        } else {
            T::literal(2.0) * lambda * nt / (root - difference)
        };
        let scaled = coefficient * self.noise.normal;
        let spread = (self.noise.tangential * self.noise.tangential + scaled * scaled).root();
        let deviation = spread * self.squared_weights.root() / self.normal;
        (coefficient > T::zero() && coefficient.is_number() && deviation.is_number())
            .then_some(FrictionEstimate { coefficient, deviation, surface_changed: self.changed })
    }

    /// Takes note of a change of surface: the flag falls.
    pub fn acknowledge(&mut self) {
        self.changed = false;
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        self.forget();
        self.changed = false;
    }

    fn forget(&mut self) {
        self.tangential = T::zero();
        self.normal = T::zero();
        self.product = T::zero();
        self.squared_weights = T::zero();
        self.samples = 0;
        self.above.reset();
        self.below.reset();
    }
}

stored! {
    KineticFriction<T>, [T: Real],
    |friction| {
        noise: ForceNoise<T> = friction.noise,
        #[serde(rename = "memory_s")]
        memory: T = friction.memory,
    },
    Self::new(noise, memory)
}

#[cfg(test)]
mod tests {
    use super::KineticFriction;
    use crate::ForceNoise;
    use fingertip_wrench::{ContactForce, Real};
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64Mcg;

    fn slide<T: Real>(rng: &mut Pcg64Mcg, mu: f64, sigma: f64) -> ContactForce<T> {
        let normal = rng.random_range(0.5..3.0);
        let noise: (f64, f64) = (StandardNormal.sample(rng), StandardNormal.sample(rng));
        ContactForce::new(
            T::literal(normal + sigma * noise.0),
            Vector3::new(T::zero(), T::literal(mu * normal + sigma * noise.1), T::zero()),
            T::zero(),
        )
    }

    fn unbiased<T: Real>() {
        let mut rng = Pcg64Mcg::seed_from_u64(7);
        // The gate wants ten deviations: noise of 0.04 N against 0.5 to 3 N.
        let noise = ForceNoise::isotropic(T::literal(0.04)).unwrap();
        let (mut sum, mut squares, mut told, trials) = (0.0, 0.0, 0.0, 400);
        for _ in 0..trials {
            let mut friction = KineticFriction::new(noise, T::literal(1.0)).unwrap();
            for _ in 0..200 {
                friction.observe(&slide(&mut rng, 0.6, 0.04), T::literal(1e-3));
            }
            let estimate = friction.estimate().unwrap();
            let error = estimate.coefficient.to_f64() - 0.6;
            sum += error;
            squares += error * error;
            told += estimate.deviation.to_f64();
        }
        let trials = f64::from(trials);
        let (bias, deviation, told) = (sum / trials, (squares / trials).sqrt(), told / trials);
        println!("bias {bias:.6}, deviation {deviation:.6}, told {told:.6}");
        assert!(bias.abs() < 4.0 * deviation / trials.sqrt() + 1e-4, "{bias}");
        // The deviation of 400 trials is known to 3.5 %.
        assert!((told / deviation - 1.0).abs() < 0.1, "{told} {deviation}");
    }

    #[test]
    fn estimate_is_unbiased_and_knows_its_deviation() {
        unbiased::<f64>();
        unbiased::<f32>();
    }

    #[test]
    fn a_new_surface_is_noticed_and_an_old_one_is_not() {
        let mut rng = Pcg64Mcg::seed_from_u64(8);
        let noise = ForceNoise::isotropic(0.04).unwrap();
        let mut friction = KineticFriction::new(noise, 0.5).unwrap();
        for _ in 0..60_000 {
            friction.observe(&slide::<f64>(&mut rng, 0.6, 0.04), 1e-3);
        }
        assert!(!friction.estimate().unwrap().surface_changed);
        let mut noticed = None;
        for index in 0..1000 {
            friction.observe(&slide::<f64>(&mut rng, 0.45, 0.04), 1e-3);
            if noticed.is_none() && friction.estimate().is_some_and(|e| e.surface_changed) {
                noticed = Some(index);
            }
        }
        assert!(noticed.unwrap() < 50, "{noticed:?}");
        assert!((friction.estimate().unwrap().coefficient - 0.45).abs() < 0.01);
        friction.acknowledge();
        assert!(!friction.estimate().unwrap().surface_changed);
    }

    #[test]
    fn bad_input_counts_for_nothing() {
        let noise = ForceNoise::isotropic(0.04).unwrap();
        let mut friction = KineticFriction::<f64>::new(noise, 0.5).unwrap();
        let before = friction;
        for bad in [f64::NAN, f64::INFINITY, 0.0, -3.0] {
            let force = ContactForce::new(bad, Vector3::x(), 0.0);
            friction.observe(&force, 1e-3);
        }
        assert_eq!(friction, before);
        assert!(friction.estimate().is_none());
        assert!(KineticFriction::new(noise, 0.0).is_err());
        // Huge forces overflow no estimate.
        for _ in 0..10 {
            let force = ContactForce::new(1e200, Vector3::x() * 1e200, 0.0);
            friction.observe(&force, 1e-3);
        }
        assert!(friction.estimate().is_none());
    }
}
