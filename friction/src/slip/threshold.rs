//! The paper's first mode: slip foretold from a known friction coefficient.

use fingertip_wrench::{ContactForce, Real, stored};

use crate::bad_parameter::positive;
use crate::{BadParameter, NormalForceGate, SlipDetector, SlipVerdict};

/// Warns when the friction ratio passes a safe share of the static coefficient, and says slip at
/// the coefficient itself.
///
/// ```
/// use fingertip_friction::{ForceNoise, NormalForceGate, RatioThreshold, SlipDetector, SlipVerdict};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.01)?);
/// let mut detector = RatioThreshold::new(gate, 0.5)?; // μ; it warns at four fifths of it
/// let force = ContactForce::new(2.0, Vector3::new(0.9, 0.0, 0.0), 0.0);
/// assert_eq!(detector.update(&force, 1e-3), SlipVerdict::Warning);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RatioThreshold<T> {
    gate: NormalForceGate<T>,
    warning: T,
    limit: T,
    share: T,
}

impl<T: Real> RatioThreshold<T> {
    /// From the gate on the normal force and the static friction coefficient, warning at four fifths of it.
    ///
    /// # Errors
    /// [`BadParameter`] unless the coefficient is positive and finite.
    pub fn new(gate: NormalForceGate<T>, static_coefficient: T) -> Result<Self, BadParameter> {
        let limit = positive(static_coefficient, "friction coefficient")?;
        let share = T::literal(0.8);
        Ok(Self { gate, warning: limit * share, limit, share })
    }

    /// With another share of the static coefficient at which to warn; 1 never warns.
    ///
    /// ```
    /// use fingertip_friction::{ForceNoise, NormalForceGate, RatioThreshold, SlipVerdict};
    ///
    /// let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.01)?);
    /// let usual = RatioThreshold::new(gate, 0.5)?;
    /// let early = usual.with_warning_share(0.6)?;
    /// assert_eq!(usual.verdict_of(1.0, 0.35), SlipVerdict::Holding);
    /// assert_eq!(early.verdict_of(1.0, 0.35), SlipVerdict::Warning);
    /// # Ok::<(), fingertip_friction::BadParameter>(())
    /// ```
    ///
    /// # Errors
    /// [`BadParameter`] unless the share is above 0 and at most 1.
    pub fn with_warning_share(self, share: T) -> Result<Self, BadParameter> {
        if !(share > T::zero() && share <= T::one()) {
            return Err(BadParameter { parameter: "warning share", requirement: "between 0 and 1" });
        }
        Ok(Self { warning: self.limit * share, share, ..self })
    }
}

impl<T: Real> RatioThreshold<T> {
    /// [`update`](SlipDetector::update) of many contacts at once, which is possible since this detector
    /// remembers nothing: from normal forces \[N\] and the magnitudes of tangential forces \[N\], as
    /// columns, which the compiler vectorises. Of columns of different lengths, the shortest counts.
    #[inline(always)]
    pub fn verdicts(&self, normal: &[T], tangential: &[T], verdicts: &mut [SlipVerdict]) {
        for ((&normal, &load), verdict) in normal.iter().zip(tangential).zip(verdicts) {
            *verdict = self.verdict_of(normal, load);
        }
    }

    /// [`update`](SlipDetector::update) without a branch, for loops over many contacts: from normal
    /// force \[N\] and magnitude of the tangential force \[N\].
    #[inline(always)]
    #[must_use]
    pub fn verdict_of(&self, normal: T, load: T) -> SlipVerdict {
        let verdict = self.verdict_in_contact(normal, load);
        let finite = (load >= T::zero()) & (load <= T::GREATEST) & (normal <= T::GREATEST);
        if finite { verdict } else { SlipVerdict::NotPressing }
    }

    /// The same where both are known to be finite.
    #[inline(always)]
    #[must_use]
    pub fn verdict_in_contact(&self, normal: T, load: T) -> SlipVerdict {
        let said = self.said(normal, load);
        if normal > self.gate.least() { said } else { SlipVerdict::NotPressing }
    }

    /// What the ratio says of a contact that presses. Products instead of a quotient: sooner known, and
    /// without a quotient's overflow. Choices between values, since a force near the limit makes a branch
    /// a gamble.
    #[inline(always)]
    fn said(&self, normal: T, load: T) -> SlipVerdict {
        let near = if load >= self.warning * normal { SlipVerdict::Warning } else { SlipVerdict::Holding };
        if load >= self.limit * normal { SlipVerdict::Slipping } else { near }
    }
}

impl<T: Real> SlipDetector<T> for RatioThreshold<T> {
    #[inline]
    fn update(&mut self, force: &ContactForce<T>, _time_step: T) -> SlipVerdict {
        let (normal, load) = (force.normal, force.tangential_magnitude());
        // As `verdict_of`, but with the branch that one sample foretells.
        // Of what is not finite nothing times is a NaN: one comparison for the three.
        let none = normal * T::zero() + load * T::zero() + force.spin * T::zero();
        if !(normal > self.gate.least() && none >= T::zero()) {
            return SlipVerdict::NotPressing;
        }
        self.said(normal, load)
    }

    #[inline]
    fn update_open(&mut self, _time_step: T) -> SlipVerdict {
        SlipVerdict::NotPressing
    }

    #[inline]
    fn reset(&mut self) {}
}

stored! {
    RatioThreshold<T>, [T: Real],
    |detector| {
        gate: NormalForceGate<T> = detector.gate,
        static_coefficient: T = detector.limit,
        warning_share: T = detector.share,
    },
    Self::new(gate, static_coefficient).and_then(|detector| detector.with_warning_share(warning_share))
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::ContactForce;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::RatioThreshold;
    use crate::{ForceNoise, NormalForceGate, SlipDetector, SlipVerdict};

    #[test]
    fn what_is_not_finite_does_not_press() {
        let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.02).unwrap());
        let mut detector = RatioThreshold::new(gate, 0.6).unwrap().with_warning_share(0.75).unwrap();
        let mut told = |normal, tangential, spin| {
            detector.update(&ContactForce::new(normal, Vector3::new(tangential, 0.0, 0.0), spin), 1e-3)
        };
        assert_eq!(told(1.0, 0.1, 0.1), SlipVerdict::Holding);
        assert_eq!(told(f64::MAX, f64::MAX, f64::MIN), SlipVerdict::Slipping);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for (normal, tangential, spin) in [(bad, 0.1, 0.1), (1.0, bad, 0.1), (1.0, 0.1, bad)] {
                assert_eq!(told(normal, tangential, spin), SlipVerdict::NotPressing, "{normal} {spin}");
            }
        }
    }

    proptest! {
        #[test]
        fn columns_are_as_single_samples(
            forces in prop::collection::vec((0.0..1.0, 0.0..1.0), 1..40),
            bits in prop::collection::vec((any::<f64>(), any::<f64>()), 1..20),
        ) {
            let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.02).unwrap());
            let mut detector = RatioThreshold::new(gate, 0.6).unwrap().with_warning_share(0.75).unwrap();
            let forces: Vec<_> = forces.into_iter().chain(bits.into_iter().map(|(n, t)| (n, t.abs())))
                .chain([(0.2, 0.0), (0.5, 0.3), (0.5, f64::NAN), (f64::NAN, 0.1), (f64::INFINITY, 1.0)]).collect();
            let (normal, tangential): (Vec<_>, Vec<_>) = forces.iter().copied().unzip();
            let mut verdicts = vec![SlipVerdict::NotPressing; forces.len()];
            detector.verdicts(&normal, &tangential, &mut verdicts);
            for ((normal, tangential), verdict) in forces.into_iter().zip(verdicts) {
                let force = ContactForce::new(normal, Vector3::new(0.0, tangential, 0.0), 0.0);
                prop_assert_eq!(verdict, detector.update(&force, 1e-3), "{} {}", normal, tangential);
            }
        }
    }
}
