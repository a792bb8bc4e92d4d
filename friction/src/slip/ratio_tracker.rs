//! What the change detectors look at: how far the friction ratio falls below its own forecast.

use fingertip_wrench::{ContactForce, Real};

use crate::{BadNoise, ForceNoise, NormalForceGate, SlipVerdict};

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
pub(crate) struct RatioTracker<T> {
    noise: ForceNoise<T>,
    gate: NormalForceGate<T>,
    variances: Variances<T>,
    state: Option<State<T>>,
}

/// Noise of the innovations.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Variances<T> {
    normal: T,
    tangential: T,
    /// 1/√tangential.
    tangential_weight: T,
}

/// In this order, since compilers join neighbouring lines into one vector of four `f32`, whose
/// shuffles cost more than they save.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
struct State<T> {
    ratio: Line<T>,
    last_normal: T,
    last_tangential: T,
    /// Nominal sample time \[s\].
    period: T,
    block: Block<T>,
    tangential: Line<T>,
    /// One over the deviation of the ratio's innovation times the normal force, and the range of
    /// ratios for which it is good.
    weight: T,
    weighed_from: T,
    weighed_to: T,
    /// Variance of the standardised innovation, from below by the stated noise.
    roughness: T,
    /// One over the root of the greater of roughness and 1.
    smoothing: T,
    /// Samples taken, up to `STEADY`.
    samples: u8,
}

/// Samples not yet taken.
#[derive(Clone, Copy, Debug, PartialEq)]
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

    /// No sample waits, and no time: what waits has taken time.
    #[inline]
    fn is_empty(&self) -> bool {
        self.elapsed <= T::zero()
    }
}

/// A value and its slope per nominal sample time.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line<T> {
    value: T,
    slope: T,
}

/// What a sample says.
enum Evidence<T> {
    /// Nothing: not pressing, or not finite.
    NotPressing,
    /// Nothing yet: the tracker starts, or the time has not advanced.
    None,
    /// Standardised fall below the forecast: Gaussian with unit variance while nothing happens.
    Fall(T),
}

/// A test for a change of the mean, from zero, of a sequence of unit variance.
pub(crate) trait ChangeTest<T> {
    /// Takes one sample, unless it is NaN, and tells whether the mean has grown.
    fn add(&mut self, sample: T) -> bool;

    /// Forgets all samples.
    fn reset(&mut self);
}

impl<T: Real> Line<T> {
    const fn at(value: T, zero: T) -> Self {
        Self { value, slope: zero }
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

/// Whether a time step is the nominal one, but for jitter.
#[inline]
fn is_regular<T: Real>(elapsed: T, period: T) -> bool {
    (elapsed - period).abs() <= period * T::literal(1.0 / 64.0)
}

impl<T: Real> Step<T> {
    /// One nominal sample time, once started up.
    #[inline]
    fn steady() -> Self {
        Self { length: T::one(), value_gain: T::literal(ALPHA), slope_gain: T::literal(BETA) }
    }

    fn new(elapsed: T, period: T, samples: u8) -> Self {
        let regular = is_regular(elapsed, period);
        if regular && samples >= STEADY {
            return Self::steady();
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

/// What is taken in at one step: a sample, or the mean of some.
struct Sample<T> {
    normal: T,
    tangential: T,
    ratio: T,
    /// By how much its noise is less than that of one sample.
    sharper: T,
}

impl<T: Real> State<T> {
    #[inline]
    fn is_steady(&self) -> bool {
        self.samples >= STEADY
    }

    /// Whether the lines are so far within the range that, on their way back to ordinary samples,
    /// they stay there: a slope adds to its value for some 1/α samples at most.
    fn is_followed(&self) -> bool {
        let (ratio, tangential) = (&self.ratio, &self.tangential);
        let greatest = T::GREATEST * T::literal(1.0 / 1024.0);
        [ratio.value, ratio.slope, tangential.value, tangential.slope].iter().all(|x| x.abs() < greatest)
    }

    /// Takes in a sample; returns the standardised innovations of the ratio and of the force.
    #[inline(always)]
    fn follow(&mut self, variances: &Variances<T>, sample: &Sample<T>, step: &Step<T>) -> (T, T) {
        let slow = self.ratio.value + self.ratio.slope * step.length;
        if slow < self.weighed_from || slow > self.weighed_to {
            self.weigh(slow, variances);
        }
        // Times the normal force, without waiting for the quotient.
        let innovation = sample.tangential - slow * sample.normal;
        self.ratio.take(sample.ratio, step);
        let of_ratio = innovation * sample.sharper * self.weight;
        let of_force =
            self.tangential.take(sample.tangential, step) * sample.sharper * variances.tangential_weight;
        (of_ratio, of_force)
    }

    /// The part of the innovations that speaks for slip, in deviations.
    #[inline(always)]
    fn fall(&mut self, &(of_ratio, of_force): &(T, T)) -> T {
        let square = lesser(of_ratio * of_ratio, T::literal(9.0));
        self.roughness += (square - self.roughness) * T::literal(1.0 / 256.0);
        // By what was known before this sample.
        let fall = lesser(-of_ratio, -of_force) * self.smoothing;
        // One step of Newton's method for 1/√: since the roughness moves by at most 3 % a sample,
        // this stays within 1e-3 of it, without a root, a division or a branch.
        let half = T::literal(0.5) * greater(self.roughness, T::one()) * self.smoothing;
        self.smoothing *= T::literal(1.5) - half * self.smoothing;
        fall
    }

    #[inline(never)]
    fn weigh(&mut self, ratio: T, variances: &Variances<T>) {
        // The error of the weight is below that of the ratio.
        let slack = ratio.abs() * T::literal(1.0 / 64.0);
        self.weighed_from = ratio - slack;
        self.weighed_to = ratio + slack;
        self.weight = T::one() / (variances.tangential + ratio * ratio * variances.normal).root();
    }
}

/// The lesser of two, and the second where the first is NaN: one instruction.
#[inline]
fn lesser<T: Real>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// The greater of two, and the second where the first is NaN.
#[inline]
fn greater<T: Real>(a: T, b: T) -> T {
    if a > b { a } else { b }
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
    pub(crate) fn update(
        &mut self,
        test: &mut impl ChangeTest<T>,
        force: &ContactForce<T>,
        time_step: T,
    ) -> SlipVerdict {
        let plain = self.plain(force);
        let fall = match plain.and_then(|(normal, load)| self.ordinary(normal, load, time_step)) {
            Some(fall) => fall,
            None => {
                let Some((normal, load)) = plain.or_else(|| self.pressing_at_all(force, time_step)) else {
                    return SlipVerdict::NotPressing;
                };
                match self.any(normal, load, time_step) {
                    Evidence::NotPressing => return SlipVerdict::NotPressing,
                    Evidence::None => return SlipVerdict::Holding,
                    Evidence::Fall(fall) => fall,
                }
            }
        };
        if test.add(fall) {
            test.reset();
            self.restart();
            SlipVerdict::Slipping
        } else {
            SlipVerdict::Holding
        }
    }

    /// A sample without contact: what a force of zero says.
    #[inline]
    pub(crate) fn update_open(&mut self, time_step: T) -> SlipVerdict {
        // One at no known time leaves the state as it was.
        if time_step.is_number() {
            self.state = None;
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
    fn ordinary(&mut self, normal: T, tangential: T, time_step: T) -> Option<T> {
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
        Some(state.fall(&innovations))
    }

    /// The evidence of any sample.
    #[inline(never)]
    fn any(&mut self, normal: T, tangential: T, time_step: T) -> Evidence<T> {
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
        let sample = if count > T::one() {
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
            return Evidence::None;
        }
        let step = Step::new(elapsed, state.period, state.samples);
        state.period += (elapsed - state.period) * T::literal(1.0 / 16.0);
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
        let fall = state.fall(&innovations);
        // A repeated sample is no independent evidence.
        Evidence::Fall(if count > T::zero() { fall } else { T::zero() })
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
            weight: self.variances.tangential_weight,
            weighed_from: T::zero(),
            weighed_to: T::zero(),
            roughness: T::one(),
            smoothing: T::one(),
            samples: 1,
        });
    }
}
