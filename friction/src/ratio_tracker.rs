//! What the change detectors look at: how far the friction ratio falls below its own forecast.

use fingertip_wrench::{ContactForce, Real};

use crate::{BadNoise, ForceNoise, NormalForceGate};

/// Gain of the tracker on the value, per sample at the nominal rate.
const ALPHA: f64 = 0.15;
/// Gain on the slope that goes with it: `α²/(2−α)` (Benedict & Bordner 1962), the best transient
/// response for a given noise reduction.
const BETA: f64 = ALPHA * ALPHA / (2.0 - ALPHA);
/// Standard deviation of the innovation over that of the measurement noise when the tracked value
/// lies on a line and the noise is white:
/// `√(1 + (2α² + 2β + αβ)/(α(4 − 2α − β)))`, the variance of the one-step prediction of an α-β
/// tracker (Kalata 1984).
const INNOVATION_VARIANCE: f64 =
    1.0 + (2.0 * ALPHA * ALPHA + 2.0 * BETA + ALPHA * BETA) / (ALPHA * (4.0 - 2.0 * ALPHA - BETA));
/// Samples of least-squares start-up that give no evidence.
const LEARNING: u8 = 8;
/// Samples after which the start-up gain `2(2n+1)/((n+1)(n+2))` has fallen to α.
const STEADY: u8 = 25;
/// Samples are averaged until they span this time \[s\]: a drop takes some milliseconds, and a tracker
/// that forgets faster than that would follow it down.
const SHORTEST_STEP: f64 = 0.45e-3;
/// A gap of more nominal sample times than this starts the tracker anew.
const GREATEST_GAP: f64 = 16.0;

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
/// The deviations come from [`ForceNoise`]; where the innovations prove rougher than that (mains
/// hum, vibration, coarse steps of a converter), a running estimate of their own variance takes
/// over, so that unexpected noise costs sensitivity, not false alarms. It never goes below the
/// stated noise.
///
/// # Time
/// Samples that come faster than some 2 kHz are averaged to that, with the noise that the mean has. The slope is carried in units of one nominal sample time, which is the running mean of the
/// steps. For a step of `s` nominal times the gain is `αs/(1−α+αs)`, which is α at `s = 1` and
/// tends to the continuous-time tracker for small `s` and to "forget all" for large `s`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct RatioTracker<T> {
    gate: NormalForceGate<T>,
    normal_variance: T,
    tangential_variance: T,
    /// 1/(standard deviation of the innovation of the tangential force).
    tangential_weight: T,
    state: Option<State<T>>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct State<T> {
    ratio: Line<T>,
    tangential: Line<T>,
    last_normal: T,
    last_tangential: T,
    /// Nominal sample time \[s\].
    period: T,
    block: Block<T>,
    /// One over the deviation of the ratio's innovation times the normal force, and the ratio for
    /// which it was worked out.
    weight: T,
    weighed_at: T,
    /// Variance of the standardised innovation, from below by the stated noise.
    roughness: T,
    /// Samples taken, up to `STEADY`.
    samples: u8,
}

/// Samples not yet taken.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Block<T> {
    normal: T,
    tangential: T,
    /// How many different ones.
    count: T,
    /// Time since the last taken, that of unusable samples included \[s\].
    elapsed: T,
}

impl<T: Real> Block<T> {
    fn empty() -> Self {
        Self { normal: T::zero(), tangential: T::zero(), count: T::zero(), elapsed: T::zero() }
    }
}

/// A value and its slope per nominal sample time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Line<T> {
    value: T,
    slope: T,
}

/// What a sample says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Evidence<T> {
    /// Nothing: not pressing, or not finite.
    NotPressing,
    /// Nothing yet: the tracker starts, or the time has not advanced.
    None,
    /// The sample repeats the one before; it is no independent evidence.
    Repeated,
    /// Standardised fall below the forecast: Gaussian with unit variance while nothing happens.
    Fall(T),
}

impl<T: Real> Line<T> {
    const fn at(value: T, zero: T) -> Self {
        Self { value, slope: zero }
    }

    #[inline]
    fn is_number(&self) -> bool {
        self.value.is_number() && self.slope.is_number()
    }

    /// Takes a measurement and returns its innovation.
    #[inline]
    fn take(&mut self, measured: T, step: &Step<T>) -> T {
        let predicted = self.value + self.slope * step.length;
        let innovation = measured - predicted;
        self.value = predicted + step.value_gain * innovation;
        self.slope += step.slope_gain * innovation;
        innovation
    }
}

/// The gains for one step.
struct Step<T> {
    /// In nominal sample times.
    length: T,
    value_gain: T,
    /// Already divided by the length.
    slope_gain: T,
}

impl<T: Real> Step<T> {
    #[inline]
    fn new(elapsed: T, period: T, samples: u8) -> Self {
        let regular = (elapsed - period).abs() <= period * T::literal(1.0 / 64.0);
        if regular && samples >= STEADY {
            return Self { length: T::one(), value_gain: T::literal(ALPHA), slope_gain: T::literal(BETA) };
        }
        let length = if regular { T::one() } else { elapsed / period };
        let scaled = length * T::literal(ALPHA);
        let steady = scaled / (T::literal(1.0 - ALPHA) + scaled);
        let (value_gain, slope_gain) = if samples >= STEADY {
            (steady, steady * steady / (T::literal(2.0) - steady))
        } else {
            // Least squares through all samples so far (the expanding-memory filter).
            let n = T::literal(f64::from(samples));
            let product = (n + T::one()) * (n + T::literal(2.0));
            let value = T::literal(2.0) * (n + n + T::one()) / product;
            (value.max(steady).min(T::one()), (T::literal(6.0) / product).min(T::one()))
        };
        Self { length, value_gain, slope_gain: slope_gain / length }
    }
}

impl<T: Real> RatioTracker<T> {
    /// From the noise of the contact force.
    ///
    /// # Errors
    /// [`BadNoise`] unless both deviations are positive and finite and so are their squares.
    pub(crate) fn new(noise: ForceNoise<T>) -> Result<Self, BadNoise> {
        let noise = noise.checked()?;
        let widening = T::literal(INNOVATION_VARIANCE);
        let squares = (noise.normal * noise.normal, noise.tangential * noise.tangential);
        if !(squares.0 >= T::LEAST_NORMAL && squares.0.is_number()) {
            return Err(BadNoise { component: "normal" });
        }
        if !(squares.1 >= T::LEAST_NORMAL && squares.1.is_number()) {
            return Err(BadNoise { component: "tangential" });
        }
        Ok(Self {
            gate: NormalForceGate::from_noise(&noise),
            normal_variance: squares.0 * widening,
            tangential_variance: squares.1 * widening,
            tangential_weight: T::one() / (noise.tangential * widening.root()),
            state: None,
        })
    }

    /// Takes a sample. One that is not finite, in force or time, leaves the state as it was, but
    /// for the time that has passed.
    #[inline]
    pub(crate) fn take(&mut self, force: &ContactForce<T>, time_step: T) -> Evidence<T> {
        if !(force.is_finite() && time_step.is_number()) {
            if let Some(state) = &mut self.state
                && time_step.is_number()
            {
                state.block.elapsed += time_step.max(T::zero());
            }
            return Evidence::NotPressing;
        }
        let square = force.tangential.norm_squared();
        let tangential = if square > T::LEAST_NORMAL / T::EPSILON && square < T::GREATEST {
            square.root()
        } else {
            force.tangential_magnitude()
        };
        let normal = force.normal;
        if !(normal > self.gate.least()) {
            self.state = None;
            return Evidence::NotPressing;
        }
        let ratio = tangential / normal;
        if !ratio.is_number() {
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
        let elapsed = block.elapsed;
        let repeated = block.count <= T::zero();
        // Noise of the mean, as a factor on the standardised values.
        let (normal, tangential, ratio, sharper) = if block.count > T::one() {
            let (normal, tangential) = (block.normal / block.count, block.tangential / block.count);
            (normal, tangential, tangential / normal, block.count.root())
        } else {
            (normal, tangential, ratio, T::one())
        };
        state.block = Block::empty();
        if state.period <= T::zero() {
            state.period = elapsed;
        }
        if elapsed > state.period * T::literal(GREATEST_GAP) {
            // Learn a slower rate, but only slowly believe in it.
            state.period *= T::literal(17.0 / 16.0);
            let period = state.period;
            self.start(normal, tangential, period);
            return Evidence::None;
        }
        let step = Step::new(elapsed, state.period, state.samples);
        state.period += (elapsed - state.period) * T::literal(1.0 / 16.0);

        let slow = state.ratio.value + state.ratio.slope * step.length;
        // Kept while the ratio stays within 1/64, which bounds its error by as much.
        if (slow - state.weighed_at).abs() > state.weighed_at.abs() * T::literal(1.0 / 64.0) {
            state.weighed_at = slow;
            state.weight = T::one() / (self.tangential_variance + slow * slow * self.normal_variance).root();
        }
        let of_ratio = state.ratio.take(ratio, &step) * normal * sharper * state.weight;
        let of_force = state.tangential.take(tangential, &step) * sharper * self.tangential_weight;
        if !(state.ratio.is_number() && state.tangential.is_number()) {
            // Forces near the end of the range: nothing to be followed.
            self.state = None;
            return Evidence::NotPressing;
        }
        if state.samples < STEADY {
            state.samples += 1;
            if state.samples <= LEARNING {
                return Evidence::None;
            }
        }
        let square = (of_ratio * of_ratio).min(T::literal(9.0));
        state.roughness += (square - state.roughness) * T::literal(1.0 / 256.0);
        if repeated {
            return Evidence::Repeated;
        }
        let fall = -of_ratio.max(of_force);
        let fall = if state.roughness > T::one() { fall / state.roughness.root() } else { fall };
        if fall.is_number() { Evidence::Fall(fall) } else { Evidence::None }
    }

    /// Starts anew from the last sample, keeping what is known of time and noise.
    #[inline]
    pub(crate) fn restart(&mut self) {
        if let Some(state) = &mut self.state {
            state.ratio = Line::at(state.last_tangential / state.last_normal, T::zero());
            state.tangential = Line::at(state.last_tangential, T::zero());
            state.block = Block::empty();
            state.samples = 1;
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
            weight: self.tangential_weight,
            weighed_at: T::zero(),
            roughness: T::one(),
            samples: 1,
        });
    }
}
