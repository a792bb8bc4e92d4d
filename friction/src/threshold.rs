//! The paper's first mode: slip foretold from a known friction coefficient.

use fingertip_wrench::{ContactForce, Real};

use crate::stored::stored;
use crate::{BadFriction, NormalForceGate, SlipDetector, SlipVerdict};

/// Warns when the friction ratio passes a safe share of the static coefficient, and says slip at
/// the coefficient itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RatioThreshold<T> {
    gate: NormalForceGate<T>,
    warning: T,
    limit: T,
    share: T,
}

impl<T: Real> RatioThreshold<T> {
    /// From the static friction coefficient and the share of it, between 0 and 1, at which to warn.
    ///
    /// # Errors
    /// [`BadFriction`] unless the coefficient is positive and finite and the share in (0, 1].
    pub fn new(
        gate: NormalForceGate<T>,
        static_coefficient: T,
        warning_share: T,
    ) -> Result<Self, BadFriction> {
        if !(static_coefficient > T::zero() && static_coefficient.is_number()) {
            return Err(BadFriction {
                parameter: "friction coefficient",
                requirement: "positive and finite",
            });
        }
        if !(warning_share > T::zero() && warning_share <= T::one()) {
            return Err(BadFriction { parameter: "warning share", requirement: "between 0 and 1" });
        }
        Ok(Self {
            gate,
            warning: static_coefficient * warning_share,
            limit: static_coefficient,
            share: warning_share,
        })
    }
}

impl<T: Real> SlipDetector<T> for RatioThreshold<T> {
    #[inline]
    fn update(&mut self, force: &ContactForce<T>, _time_step: T) -> SlipVerdict {
        match self.gate.ratio(force) {
            None => SlipVerdict::NotPressing,
            Some(ratio) if ratio >= self.limit => SlipVerdict::Slipping,
            Some(ratio) if ratio >= self.warning => SlipVerdict::Warning,
            Some(_) => SlipVerdict::Holding,
        }
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
    Self::new(gate, static_coefficient, warning_share)
}
