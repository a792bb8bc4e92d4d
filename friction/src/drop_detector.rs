//! The paper's second mode: slip seen in the sudden drop of the friction ratio.

use fingertip_wrench::{ContactForce, Real};

use crate::{BadNoise, ForceNoise, NormalForceGate, SlipDetector, SlipVerdict};

/// Finds the fall of the friction ratio from its static peak to its kinetic level, without knowing
/// either.
///
/// An α-β tracker follows the ratio; a one-sided cumulative sum of the standardised innovation
/// (theory 7.2) rises when the ratio falls faster than the tracker foretells, and calls slip when
/// it passes the threshold. The tracker works on the ratio and its rate per second, so that
/// irregular time steps are allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DropDetector<T> {
    noise: ForceNoise<T>,
    gate: NormalForceGate<T>,
    alpha: T,
    beta: T,
    allowance: T,
    threshold: T,
    state: Option<State<T>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct State<T> {
    ratio: T,
    /// Change of the ratio per sample.
    rate: T,
    sum: T,
}

impl<T: Real> DropDetector<T> {
    /// From the noise of the contact force, with the gains of theory 7.2: α = 0.2, β = 0.02,
    /// allowance 0.75, threshold 8.
    ///
    /// # Errors
    /// [`BadNoise`] unless both deviations are positive and finite.
    pub fn new(noise: ForceNoise<T>) -> Result<Self, BadNoise> {
        let noise = noise.checked()?;
        Ok(Self {
            noise,
            gate: NormalForceGate::from_noise(&noise),
            alpha: T::literal(0.2),
            beta: T::literal(0.02),
            allowance: T::literal(0.75),
            threshold: T::literal(8.0),
            state: None,
        })
    }
}

impl<T: Real> SlipDetector<T> for DropDetector<T> {
    #[inline]
    fn update(&mut self, force: &ContactForce<T>, _time_step: T) -> SlipVerdict {
        let Some(ratio) = self.gate.ratio(force) else {
            self.state = None;
            return SlipVerdict::NotPressing;
        };
        let Some(state) = &mut self.state else {
            self.state = Some(State { ratio, rate: T::zero(), sum: T::zero() });
            return SlipVerdict::Holding;
        };
        let predicted = state.ratio + state.rate;
        let innovation = ratio - predicted;
        state.ratio = predicted + self.alpha * innovation;
        state.rate += self.beta * innovation;
        let deviation = self.noise.ratio_deviation(force.normal, ratio);
        state.sum = (state.sum - innovation / deviation - self.allowance).max(T::zero());
        if state.sum > self.threshold {
            // Start anew from here, so that the next drop of a stick-slip motion is found too.
            *state = State { ratio, rate: T::zero(), sum: T::zero() };
            SlipVerdict::Slipping
        } else {
            SlipVerdict::Holding
        }
    }

    fn reset(&mut self) {
        self.state = None;
    }
}
