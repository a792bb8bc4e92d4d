//! What the change detectors look at: how far the friction ratio falls below its own forecast.

use fingertip_wrench::{ContactForce, Real};

use super::change_test::ChangeTest;
use super::followed_lines::{INNOVATION_VARIANCE, Line, Sample, State, Step, Variances, is_regular};
use super::sample_block::Block;
use crate::{BadParameter, ForceNoise, NormalForceGate, SlipVerdict};

/// Samples of least-squares start-up that give no evidence.
const LEARNING: u8 = 8;
/// Samples are averaged until they span this time \[s\]: a drop takes some milliseconds, and a tracker
/// that forgets faster than that would follow it down.
const SHORTEST_STEP: f64 = 0.45e-3;
/// A gap of more nominal sample times than this starts the tracker anew.
const GREATEST_GAP: f64 = 16.0;

/// How many samples a second are taken of so many \[Hz\], which are averaged where there are more than some 2000.
pub(super) fn taken_rate(sample_rate: f64) -> f64 {
    let averaged = libm::ceil(SHORTEST_STEP * sample_rate);
    if averaged > 1.0 { sample_rate / averaged } else { sample_rate }
}

/// Follows the friction ratio and the tangential force with α-β trackers, and gives the part of
/// their innovations that speaks for slip.
///
/// # What counts as evidence
/// At slip the ratio `f_t/f_n` *and* the tangential force itself fall. A step of the normal force
/// alone moves only the ratio while the contact holds, and only the tangential force while it
/// slides. So the evidence is the lesser of the two standardised falls: steps of the normal force
/// give none, either way.
///
/// # Noise
/// The deviations come from [`ForceNoise`]; where the innovations prove rougher than that, a running estimate of their
/// own variance takes over within some hundred samples, so that white noise above the stated costs sensitivity more than
/// false alarms. It never goes below the stated noise. Noise that hangs together is another matter:
/// [`AdaptiveDropDetector`](crate::AdaptiveDropDetector).
///
/// # Time
/// Samples that come faster than some 2 kHz are averaged to that, with the noise that the mean has. The
/// slope is carried in units of one nominal sample time, which is the running mean of the steps. For a step of `s` nominal times the gain is `αs/(1−α+αs)`, which is α at `s = 1` and
/// tends to the continuous-time tracker for small `s` and to "forget all" for large `s`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RatioTracker<T> {
    noise: ForceNoise<T>,
    gate: NormalForceGate<T>,
    variances: Variances<T>,
    state: Option<State<T>>,
}

/// What a sample says.
enum Evidence<E> {
    /// Nothing: not pressing, or not finite.
    NotPressing,
    /// Nothing yet: the tracker starts, or the time has not advanced.
    None,
    /// Nothing, and what was said before no longer counts: the tracker starts anew after a gap.
    Anew,
    /// What the innovations say to the test.
    Some(E),
}

impl<T: Real> RatioTracker<T> {
    /// From the noise of the contact force.
    ///
    /// # Errors
    /// [`BadParameter`] unless both deviations are positive and finite and so are their squares.
    pub(crate) fn new(noise: ForceNoise<T>) -> Result<Self, BadParameter> {
        let noise = noise.checked()?;
        let widening = T::literal(INNOVATION_VARIANCE);
        let squared = |deviation: T, parameter| {
            let square = deviation * deviation;
            if square >= T::LEAST_NORMAL && square.is_number() {
                Ok(square)
            } else {
                Err(BadParameter { parameter, requirement: "in the range where its square is a number" })
            }
        };
        let squares = (
            squared(noise.normal, "noise of the normal force")?,
            squared(noise.tangential, "noise of the tangential force")?,
        );
        Ok(Self {
            noise,
            gate: NormalForceGate::from_noise(&noise),
            variances: Variances {
                normal: squares.0 * widening,
                tangential: squares.1 * widening,
                tangential_weight: T::one() / (noise.tangential * widening.root()),
            },
            state: None,
        })
    }

    /// The noise it was made for.
    #[cfg(feature = "serde")]
    pub(crate) const fn noise(&self) -> ForceNoise<T> {
        self.noise
    }

    /// Takes a sample and tells what `test` says of its evidence; after a slip both start anew. A
    /// sample that is not finite, in force or time, leaves the state as it was, but for the time
    /// that has passed.
    #[inline]
    pub(crate) fn update<Test: ChangeTest<T>>(
        &mut self,
        test: &mut Test,
        force: &ContactForce<T>,
        time_step: T,
    ) -> SlipVerdict {
        let plain = self.plain(force);
        let evidence = match plain.and_then(|(normal, load)| self.ordinary::<Test>(normal, load, time_step)) {
            Some(evidence) => evidence,
            None => match self.any::<Test>(plain, force, time_step) {
                Evidence::NotPressing => {
                    // What was seen of a contact that has opened says nothing of the next.
                    if self.state.is_none() {
                        test.restart();
                    }
                    return SlipVerdict::NotPressing;
                }
                Evidence::None => return SlipVerdict::Holding,
                Evidence::Anew => {
                    test.restart();
                    return SlipVerdict::Holding;
                }
                Evidence::Some(evidence) => evidence,
            },
        };
        if test.take(evidence) {
            test.restart();
            self.restart();
            SlipVerdict::Slipping
        } else {
            SlipVerdict::Holding
        }
    }

    /// A sample without contact: what a force of zero says.
    #[inline]
    pub(crate) fn update_open(&mut self, test: &mut impl ChangeTest<T>, time_step: T) -> SlipVerdict {
        // One at no known time leaves the state as it was.
        if time_step.is_number() {
            self.state = None;
            test.restart();
        }
        SlipVerdict::NotPressing
    }

    /// Normal and tangential force of a sample from which something may be learnt, in the range in which
    /// the lines cannot leave theirs.
    #[inline(always)]
    fn plain(&self, force: &ContactForce<T>) -> Option<(T, T)> {
        let normal = force.normal;
        let load = force.tangential_magnitude();
        let square = load * load;
        // In this range no product over- or underflows and, since the square of the gate is a
        // normal number, no ratio either; and no component is NaN or infinite.
        let plain = square > T::LEAST_NORMAL / T::EPSILON
            && square < T::GREATEST
            && normal > self.gate.least()
            && normal <= T::GREATEST
            && force.spin.is_number();
        plain.then_some((normal, load))
    }

    /// The same over the whole range.
    #[inline(never)]
    fn pressing_at_all(&mut self, force: &ContactForce<T>, time_step: T) -> Option<(T, T)> {
        if !(force.is_finite() && time_step.is_number()) {
            if let Some(state) = &mut self.state
                && time_step.is_number()
            {
                state.block.elapsed += time_step.max(T::zero());
            }
            return None;
        }
        let (normal, tangential) = (force.normal, force.tangential_magnitude());
        if !(normal > self.gate.least()) {
            self.state = None;
            return None;
        }
        // Else their ratio is not a number.
        (tangential < T::GREATEST * normal).then_some((normal, tangential))
    }

    /// The evidence of an ordinary sample: plain, new, of a started tracker, at an even rate below 2 kHz.
    /// Says and does nothing for others.
    #[inline(always)]
    fn ordinary<Test: ChangeTest<T>>(
        &mut self,
        normal: T,
        tangential: T,
        time_step: T,
    ) -> Option<Test::Evidence> {
        let state = self.state.as_mut()?;
        let even = state.is_steady()
            && state.block.is_empty()
            // The period is no less than the shortest step.
            && is_regular(time_step, state.period)
            && !(normal == state.last_normal && tangential == state.last_tangential);
        if !even {
            return None;
        }
        state.last_normal = normal;
        state.last_tangential = tangential;
        state.period += (time_step - state.period) * T::literal(1.0 / 16.0);
        // The reciprocal does not wait for the root.
        let ratio = tangential * (T::one() / normal);
        let sample = Sample { normal, tangential, ratio, sharper: T::one() };
        let innovations = state.follow(&self.variances, &sample, &Step::steady());
        Some(Test::evidence(state, &innovations))
    }

    /// The evidence of any sample; its forces, where they are `plain`.
    #[inline(never)]
    fn any<Test: ChangeTest<T>>(
        &mut self,
        plain: Option<(T, T)>,
        force: &ContactForce<T>,
        time_step: T,
    ) -> Evidence<Test::Evidence> {
        let Some((normal, tangential)) = plain.or_else(|| self.pressing_at_all(force, time_step)) else {
            return Evidence::NotPressing;
        };
        if !time_step.is_number() {
            return Evidence::NotPressing;
        }
        let Some(state) = &mut self.state else {
            self.start(normal, tangential, T::zero());
            return Evidence::None;
        };
        if time_step <= T::zero() {
            return Evidence::None;
        }
        let block = &mut state.block;
        block.elapsed += time_step;
        if !(normal == state.last_normal && tangential == state.last_tangential) {
            block.normal += normal;
            block.tangential += tangential;
            block.count += T::one();
        }
        state.last_normal = normal;
        state.last_tangential = tangential;
        if block.elapsed < T::literal(SHORTEST_STEP) {
            return Evidence::None;
        }
        let Block { elapsed, count, .. } = *block;
        let mut sample = if count > T::one() {
            // The noise of the mean is less.
            let (normal, tangential) = (block.normal / count, block.tangential / count);
            Sample { normal, tangential, ratio: tangential / normal, sharper: count.root() }
        } else {
            Sample { normal, tangential, ratio: tangential / normal, sharper: T::one() }
        };
        state.block = Block::empty();
        if state.period <= T::zero() {
            state.period = elapsed;
        }
        if elapsed > state.period * T::literal(GREATEST_GAP) {
            // Learn a slower rate, but only slowly believe in it.
            state.period *= T::literal(17.0 / 16.0);
            let period = state.period;
            self.start(sample.normal, sample.tangential, period);
            return Evidence::Anew;
        }
        if state.is_provisional() {
            if count > T::one() {
                // Samples are averaged: the lines start from a mean, not from the one sample before.
                state.set(sample.tangential, sample.ratio);
                if state.is_followed() {
                    return Evidence::None;
                }
                self.state = None;
                return Evidence::NotPressing;
            }
            state.samples = 1;
        }
        let step = Step::new(elapsed, state.period, state.samples);
        state.period += (elapsed - state.period) * T::literal(1.0 / 16.0);
        sample.sharper *= state.start_up_share();
        let innovations = state.follow(&self.variances, &sample, &step);
        if !state.is_followed() {
            // Forces near the end of the range: nothing to be followed.
            self.state = None;
            return Evidence::NotPressing;
        }
        if !state.is_steady() {
            state.samples += 1;
            if state.samples <= LEARNING {
                return Evidence::None;
            }
        }
        let evidence = Test::evidence(state, &innovations);
        // A repeated sample is no independent evidence.
        Evidence::Some(if count > T::zero() { evidence } else { Test::NOTHING() })
    }

    /// Starts anew from the last sample, keeping what is known of time and noise.
    #[inline]
    pub(crate) fn restart(&mut self) {
        if let Some(state) = &mut self.state {
            state.set(state.last_tangential, state.last_tangential / state.last_normal);
            state.block = Block::empty();
            state.samples = 0;
        }
    }

    /// Forgets everything.
    pub(crate) fn reset(&mut self) {
        self.state = None;
    }

    /// The followed friction ratio, once there is one.
    #[inline]
    pub(crate) fn ratio(&self) -> Option<T> {
        self.state.as_ref().map(|state| state.ratio.value)
    }

    #[inline]
    fn start(&mut self, normal: T, tangential: T, period: T) {
        self.state = Some(State {
            ratio: Line::at(tangential / normal, T::zero()),
            tangential: Line::at(tangential, T::zero()),
            last_normal: normal,
            last_tangential: tangential,
            period: period.max(T::zero()),
            block: Block::empty(),
            weight: self.variances.tangential_weight,
            weighed_from: T::zero(),
            weighed_to: T::zero(),
            roughness: T::one(),
            smoothing: T::one(),
            samples: 0,
        });
    }
}
