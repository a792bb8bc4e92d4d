//! Friction that is known only with an uncertainty.

use fingertip_wrench::numeric::normal::{normal_distribution, normal_quantile};
use fingertip_wrench::{ContactForce, Real, stored};

use crate::bad_parameter::{not_negative, positive};
use crate::limits::cone::saturated;
use crate::{BadParameter, ForceNoise};

/// Coulomb friction with a standard deviation on its coefficient and noise on the force: how
/// probable is slip, and how hard to press for a wanted probability
/// (`docs/theory/friction.md#uncertain-friction`).
///
/// First order: `z = (μN − |f_t|)/√(σ_t² + μ²σ_n² + N²σ_μ²)`, and slip with probability Φ(−z).
///
/// ```
/// use fingertip_friction::UncertainCoulomb;
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let force = ContactForce::new(2.0, Vector3::new(0.5, 0.0, 0.0), 0.0); // 2 N of push, 0.5 N sideways
/// let friction = UncertainCoulomb::new(0.5, 0.05, None)?;
/// assert!(friction.slip_probability(&force) < 1e-3); // the ratio is 0.25, five deviations below
/// assert!(friction.quantile(0.01) < 0.5);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UncertainCoulomb<T> {
    coefficient: T,
    deviation: T,
    noise: Option<ForceNoise<T>>,
}

impl<T: Real> UncertainCoulomb<T> {
    /// From the friction coefficient, its standard deviation, and the noise of the force; `None`
    /// for a force known exactly.
    ///
    /// # Errors
    /// [`BadParameter`] unless the coefficient is positive and finite, its deviation finite and not
    /// negative, and the noise positive and finite.
    pub fn new(coefficient: T, deviation: T, noise: Option<ForceNoise<T>>) -> Result<Self, BadParameter> {
        let noise = noise.map(ForceNoise::checked).transpose()?;
        Ok(Self {
            coefficient: positive(coefficient, "friction coefficient")?,
            deviation: not_negative(deviation, "deviation of the coefficient")?,
            noise,
        })
    }

    /// The coefficient μ.
    #[inline]
    #[must_use]
    pub const fn coefficient(&self) -> T {
        self.coefficient
    }

    /// Its standard deviation.
    #[inline]
    #[must_use]
    pub const fn deviation(&self) -> T {
        self.deviation
    }

    /// The coefficient that is undercut with probability `probability` (a low quantile, for
    /// control); not below zero, and zero for a NaN.
    #[must_use]
    pub fn quantile(&self, probability: f64) -> T {
        if probability.is_nan() {
            return T::zero();
        }
        let coefficient = self.coefficient + self.deviation * T::literal(normal_quantile(probability));
        if coefficient > T::zero() { coefficient } else { T::zero() }
    }

    /// Probability that the contact slips under this force, between 0 and 1; 1 for a force that
    /// does not press or is not finite.
    #[must_use]
    pub fn slip_probability(&self, force: &ContactForce<T>) -> T {
        if !(force.normal > T::zero() && force.is_finite()) {
            return T::one();
        }
        // At unit scale, so that no square over- or underflows.
        let tangential = force.tangential_magnitude();
        let (of_normal, of_tangential) =
            self.noise.map_or((T::zero(), T::zero()), |noise| (noise.normal, noise.tangential));
        let greatest = force.normal.max(tangential).max(of_normal).max(of_tangential);
        let scale = greatest.normalising_factor();
        let margin = self.coefficient * (force.normal * scale) - tangential * scale;
        let (a, b, c) = (
            of_tangential * scale,
            self.coefficient * of_normal * scale,
            force.normal * scale * self.deviation,
        );
        let deviation = (a * a + b * b + c * c).root();
        let standardised = margin / deviation;
        if standardised.is_number() {
            T::literal(normal_distribution(-standardised.to_f64()))
        } else if margin >= T::zero() {
            // No uncertainty left.
            T::zero()
        } else {
            T::one()
        }
    }

    /// The least normal force \[N\] with a probability of slip of at most `probability`; saturates
    /// at the largest number where pressing harder can't reach it (σ_μ too great), and for a NaN.
    ///
    /// Solves `μN − |f_t| = z√(σ_t² + μ²σ_n² + N²σ_μ²)` for N.
    #[must_use]
    pub fn least_normal_force(&self, force: &ContactForce<T>, probability: f64) -> T {
        let z = T::literal(-normal_quantile(probability));
        let tangential = force.tangential_magnitude();
        if !tangential.is_number() || probability.is_nan() || z > T::GREATEST {
            return T::GREATEST;
        }
        if z < -T::GREATEST {
            // Slip is certain to be borne.
            return T::zero();
        }
        let noise = self.noise.map_or(T::zero(), |noise| {
            let (a, b) = (noise.tangential, self.coefficient * noise.normal);
            a * a + b * b
        });
        // (μ² − z²σ_μ²) N² − 2μ|f_t| N + |f_t|² − z²·noise = 0, at the scale of the load.
        let sure = self.coefficient - z.abs() * self.deviation;
        if z > T::zero() && !(sure > T::zero()) {
            return T::GREATEST;
        }
        let unit = tangential.max(noise.root()).normalising_factor();
        let (load, noise) = (tangential * unit, noise * unit * unit);
        let leading = sure * (self.coefficient + z.abs() * self.deviation);
        // Discriminant over 4: z²(σ_μ²|f_t|² + leading·noise), a sum of squares for z > 0.
        let spread = self.deviation * load;
        let root = z.abs() * (spread * spread + leading * noise).max(T::zero()).root();
        let sum = self.coefficient * load;
        let normal = if z >= T::zero() { (sum + root) / leading } else { (sum - root) / leading };
        saturated(normal / unit)
    }
}

stored! {
    UncertainCoulomb<T>, [T: Real],
    |model| {
        coefficient: T = model.coefficient,
        deviation: T = model.deviation,
        noise: Option<ForceNoise<T>> = model.noise,
    },
    Self::new(coefficient, deviation, noise)
}

#[cfg(test)]
mod tests {
    use super::UncertainCoulomb;
    use crate::ForceNoise;
    use fingertip_wrench::{ContactForce, Real};
    use nalgebra::Vector3;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    fn force<T: Real>(normal: f64, tangential: f64) -> ContactForce<T> {
        ContactForce::new(
            T::literal(normal),
            Vector3::new(T::zero(), T::literal(tangential), T::zero()),
            T::zero(),
        )
    }

    fn agree_with_sampling<T: Real>() {
        let noise = ForceNoise { normal: T::literal(0.05), tangential: T::literal(0.1) };
        let model = UncertainCoulomb::new(T::literal(0.5), T::literal(0.04), Some(noise)).unwrap();
        let mut rng = rand_pcg::Pcg64Mcg::seed_from_u64(3);
        let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
        for (normal, tangential) in [(5.0, 2.5), (5.0, 2.2), (5.0, 2.9), (3.0, 1.2)] {
            let count = 200_000;
            let slipped = (0..count)
                .filter(|_| {
                    let mu = 0.5 + 0.04 * draw();
                    tangential + 0.1 * draw() > mu * (normal + 0.05 * draw())
                })
                .count();
            let sampled = slipped as f64 / f64::from(count);
            let told = model.slip_probability(&force(normal, tangential)).to_f64();
            // Sampling error of three deviations and the first-order approximation.
            let bound = 3.0 * (sampled * (1.0 - sampled) / f64::from(count)).sqrt() + 2e-3;
            assert!((told - sampled).abs() < bound, "{told} {sampled}");
        }
    }

    #[test]
    fn probability_agrees_with_sampling() {
        agree_with_sampling::<f64>();
        agree_with_sampling::<f32>();
    }

    #[test]
    fn least_force_gives_the_wanted_probability() {
        let noise = ForceNoise { normal: 0.05, tangential: 0.1 };
        for noise in [None, Some(noise)] {
            let model = UncertainCoulomb::new(0.5_f64, 0.04, noise).unwrap();
            for wanted in [1e-6, 1e-3, 0.1, 0.5, 0.9] {
                for tangential in [0.5, 3.0, 1e3] {
                    let normal = model.least_normal_force(&force(0.0, tangential), wanted);
                    if normal > 0.0 {
                        let told = model.slip_probability(&force(normal, tangential));
                        assert!((told / wanted - 1.0).abs() < 1e-6, "{noise:?} {wanted} {told}");
                    }
                }
            }
            assert_eq!(model.least_normal_force(&force(0.0, 1.0), 0.0), f64::MAX);
            assert_eq!(model.least_normal_force(&force(0.0, f64::NAN), 0.1), f64::MAX);
        }
        let model = UncertainCoulomb::new(0.5_f64, 0.04, None).unwrap();
        assert_eq!(model.quantile(f64::NAN), 0.0);
        assert_eq!(model.least_normal_force(&force(0.0, 1.0), f64::NAN), f64::MAX);
        // Beyond 12.5 deviations no grip is enough.
        let model = UncertainCoulomb::new(0.5_f64, 0.04, None).unwrap();
        assert_eq!(model.least_normal_force(&force(0.0, 1.0), 1e-40), f64::MAX);
    }

    #[test]
    fn extremes_stay_probabilities() {
        let model = UncertainCoulomb::new(0.5_f64, 0.0, None).unwrap();
        assert_eq!(model.slip_probability(&force(2.0, 0.5)), 0.0);
        assert_eq!(model.slip_probability(&force(2.0, 1.5)), 1.0);
        let noise = ForceNoise { normal: 1e-300, tangential: 1e300 };
        let model = UncertainCoulomb::new(0.5_f64, 0.1, Some(noise)).unwrap();
        for normal in [f64::NAN, -1.0, 0.0, 5e-324, 1.0, f64::MAX, f64::INFINITY] {
            for tangential in [0.0, 5e-324, 1.0, f64::MAX, f64::NAN] {
                let p = model.slip_probability(&force(normal, tangential));
                assert!((0.0..=1.0).contains(&p));
                assert!(model.least_normal_force(&force(normal, tangential), 0.01) >= 0.0);
            }
        }
    }
}
