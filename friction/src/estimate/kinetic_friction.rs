//! The kinetic friction coefficient, learnt while it slides.

use fingertip_wrench::{ContactForce, Real, stored};

use crate::bad_parameter::positive;
use crate::{BadParameter, Cusum, ForceNoise, FrictionEstimate, NormalForceGate};

/// Fits `|f_t| = μ f_n` to the samples of a slide, with noise of known size on both, and exponential forgetting
/// (`docs/theory/friction.md#kinetic-friction`), by the moments of functional regression (Fuller 1987):
///
/// `μ² = (S_tt − 2σ_t² S_w)/(S_nn − σ_n² S_w)`.
///
/// The square of the tangential force has the noise of both its components, which makes its length too great (Rice);
/// least squares is biased low (the noise of `f_n` attenuates it), the mean of ratios high. What was stated of the noise
/// is taken off: stated too great by `δ` (in variance), the coefficient is low by `δ/f_t²` of itself.
/// A two-sided cumulative sum of the residuals notices another surface, whereupon the sums start
/// anew.
///
/// ```
/// use fingertip_friction::{ForceNoise, KineticFriction};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let mut friction = KineticFriction::new(ForceNoise::isotropic(0.01)?, 0.1)?; // averaged over 0.1 s of sliding
/// for _ in 0..200 {
///     friction.observe(&ContactForce::new(2.0, Vector3::x() * 0.9, 0.0), 1e-3);
/// }
/// assert!(friction.estimate().is_some_and(|estimate| (estimate.coefficient - 0.45_f64).abs() < 0.01));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KineticFriction<T> {
    noise: ForceNoise<T>,
    gate: NormalForceGate<T>,
    memory: T,
    tangential: T,
    normal: T,
    /// Sum of the weights `w`, and those of `w²` and `w² f_n²`, for the variance.
    weights: T,
    squared_weights: T,
    weighted_normal: T,
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
            weights: T::zero(),
            squared_weights: T::zero(),
            weighted_normal: T::zero(),
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
            // The length of a vector with noise of its own: Rice's mean, to first order.
            let length = crate::limits::cone::hypot(known.coefficient * normal, self.noise.tangential);
            let residual = tangential - length;
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
            self.weighted_normal * keep * keep + n * n,
        );
        if sums.0.is_number() && sums.1.is_number() && sums.2.is_number() {
            (self.tangential, self.normal, self.weighted_normal) = sums;
            self.weights = self.weights * keep + T::one();
            self.squared_weights = self.squared_weights * keep * keep + T::one();
            self.samples = self.samples.saturating_add(1);
        }
    }

    /// The coefficient and its standard deviation from the noise; `None` before two samples of a
    /// loaded slide. `surface_changed` holds from a change until [`acknowledge`](Self::acknowledge).
    #[must_use]
    pub fn estimate(&self) -> Option<FrictionEstimate<T>> {
        if self.samples < 2 {
            return None;
        }
        // At unit scale, so that no product over- or underflows.
        let unit = self.normal.max(self.tangential).normalising_factor();
        let square = |deviation: T| deviation * unit * deviation;
        let (of_t, of_n) = (square(self.noise.tangential), square(self.noise.normal));
        let tangential = self.tangential * unit - of_t * self.weights * T::literal(2.0);
        let normal = self.normal * unit - of_n * self.weights;
        if !(tangential > T::zero() && normal > T::zero()) {
            return None;
        }
        let ratio = tangential / normal;
        let coefficient = ratio.root();
        // Of first order in the noise, and of second, which counts where the tangential force is small.
        let first = (of_t + ratio * of_n)
            * (self.weighted_normal * unit - of_n * self.squared_weights).max(T::zero());
        let second = (of_t / ratio * of_t + T::literal(0.5) * ratio * of_n * of_n) * self.squared_weights;
        let deviation = (first + second).root() / normal;
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
        self.weights = T::zero();
        self.squared_weights = T::zero();
        self.weighted_normal = T::zero();
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
        let across: f64 = StandardNormal.sample(rng);
        ContactForce::new(
            T::literal(normal + sigma * noise.0),
            Vector3::new(T::literal(sigma * across), T::literal(mu * normal + sigma * noise.1), T::zero()),
            T::zero(),
        )
    }

    /// Light touches, of which the tangential force is four or five deviations of its noise: the 95 % interval holds
    /// the truth in 93 to 97 % of 2000 slides.
    #[test]
    fn intervals_of_light_slides_hold() {
        let mut rng = Pcg64Mcg::seed_from_u64(9);
        let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
        let noise = ForceNoise::isotropic(0.02).unwrap();
        for (normal, mu) in [(0.4, 0.2), (1.0, 0.1), (0.4, 0.1), (3.0, 0.6)] {
            let (mut held, mut sum, mut changed, trials) = (0.0, 0.0, 0, 2000.0);
            for _ in 0..2000 {
                let mut friction = KineticFriction::new(noise, 1.0).unwrap();
                for _ in 0..200 {
                    let (n, t) = (normal + 0.02 * draw(), mu * normal + 0.02 * draw());
                    let force = ContactForce::new(n, Vector3::new(t, 0.02 * draw(), 0.0), 0.0);
                    friction.observe(&force, 1e-3);
                }
                let found = friction.estimate().unwrap();
                changed += u32::from(found.surface_changed);
                sum += found.coefficient;
                held += f64::from(u8::from((found.coefficient - mu).abs() < 1.96 * found.deviation));
            }
            let (bias, share) = (sum / trials / mu - 1.0, held / trials);
            println!(
                "{normal} N, {mu}: bias {:.2} %, {:.1} % held, {changed} changes",
                100.0 * bias,
                100.0 * share
            );
            assert!(bias.abs() < 0.004 && (0.93..0.97).contains(&share) && changed < 20, "{bias} {share}");
        }
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
