//! Lines that follow the friction ratio and the tangential force, and what their innovations say.

use fingertip_wrench::Real;

use super::sample_block::Block;

/// Gain of the tracker on the value, per sample at the nominal rate.
const ALPHA: f64 = 0.15;
/// Gain on the slope that goes with it: `α²/(2−α)` (Benedict & Bordner 1962), the best transient
/// response for a given noise reduction.
const BETA: f64 = ALPHA * ALPHA / (2.0 - ALPHA);
/// Standard deviation of the innovation over that of the measurement noise when the tracked value
/// lies on a line and the noise is white:
/// `√(1 + (2α² + 2β + αβ)/(α(4 − 2α − β)))`, the variance of the one-step prediction of an α-β
/// tracker (Kalata 1984).
pub(super) const INNOVATION_VARIANCE: f64 =
    1.0 + (2.0 * ALPHA * ALPHA + 2.0 * BETA + ALPHA * BETA) / (ALPHA * (4.0 - 2.0 * ALPHA - BETA));
/// The greatest square of an innovation, in stated variances, by which the roughness grows: white noise of five times
/// the stated is known by it, and one drop makes a detector an eighth less sensitive at most.
const GREATEST_SQUARE: f64 = 64.0;
/// Samples after which the start-up gain `2(2n+1)/((n+1)(n+2))` has fallen to α.
const STEADY: u8 = 25;

/// Noise of the innovations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Variances<T> {
    pub(super) normal: T,
    pub(super) tangential: T,
    /// 1/√tangential.
    pub(super) tangential_weight: T,
}

/// In this order, since compilers join neighbouring lines into one vector of four `f32`, whose
/// shuffles cost more than they save.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(super) struct State<T> {
    pub(super) ratio: Line<T>,
    pub(super) last_normal: T,
    pub(super) last_tangential: T,
    /// Nominal sample time \[s\].
    pub(super) period: T,
    pub(super) block: Block<T>,
    pub(super) tangential: Line<T>,
    /// One over the deviation of the ratio's innovation times the normal force, and the range of
    /// ratios for which it is good.
    pub(super) weight: T,
    pub(super) weighed_from: T,
    pub(super) weighed_to: T,
    /// Variance of the standardised innovation, from below by the stated noise.
    pub(super) roughness: T,
    /// One over the root of the greater of roughness and 1.
    pub(super) smoothing: T,
    /// Samples taken, up to `STEADY`; 0 while the lines hold the first sample, which counts only if the samples
    /// are not averaged.
    pub(super) samples: u8,
}

/// A value and its slope per nominal sample time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line<T> {
    pub(super) value: T,
    pub(super) slope: T,
}

impl<T: Real> Line<T> {
    pub(super) const fn at(value: T, zero: T) -> Self {
        Self { value, slope: zero }
    }

    /// Takes a measurement and returns its innovation.
    #[inline]
    pub(super) fn take(&mut self, measured: T, step: &Step<T>) -> T {
        let predicted = self.value + self.slope * step.length;
        let innovation = measured - predicted;
        self.value = predicted + step.value_gain * innovation;
        self.slope += step.slope_gain * innovation;
        innovation
    }
}

/// The gains for one step.
pub(super) struct Step<T> {
    /// In nominal sample times.
    pub(super) length: T,
    pub(super) value_gain: T,
    /// Already divided by the length.
    pub(super) slope_gain: T,
}

/// Whether a time step is the nominal one, but for jitter.
#[inline]
pub(super) fn is_regular<T: Real>(elapsed: T, period: T) -> bool {
    (elapsed - period).abs() <= period * T::literal(1.0 / 64.0)
}

impl<T: Real> Step<T> {
    /// One nominal sample time, once started up.
    #[inline]
    pub(super) fn steady() -> Self {
        Self { length: T::one(), value_gain: T::literal(ALPHA), slope_gain: T::literal(BETA) }
    }

    pub(super) fn new(elapsed: T, period: T, samples: u8) -> Self {
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
pub(super) struct Sample<T> {
    pub(super) normal: T,
    pub(super) tangential: T,
    pub(super) ratio: T,
    /// By how much its noise is less than that of one sample.
    pub(super) sharper: T,
}

impl<T: Real> State<T> {
    #[inline]
    pub(super) fn is_steady(&self) -> bool {
        self.samples >= STEADY
    }

    /// Whether the lines hold a sample that may not be followed.
    #[inline]
    pub(super) fn is_provisional(&self) -> bool {
        self.samples == 0
    }

    /// Lets the lines start.
    pub(super) fn set(&mut self, tangential: T, ratio: T) {
        self.ratio = Line::at(ratio, T::zero());
        self.tangential = Line::at(tangential, T::zero());
        self.samples = 1;
    }

    /// Deviation of a steady tracker's innovation over that during start-up: the forecast by the line of least
    /// squares through `n` samples has the variance `(4n + 2)/(n(n − 1))` of one sample.
    #[inline]
    pub(super) fn start_up_share(&self) -> T {
        if self.is_steady() || self.samples < 2 {
            return T::one();
        }
        let n = T::literal(f64::from(self.samples));
        let forecast = (T::literal(4.0) * n + T::literal(2.0)) / (n * (n - T::one()));
        (T::literal(INNOVATION_VARIANCE) / (T::one() + forecast)).root()
    }

    /// Whether the lines are so far within the range that, on their way back to ordinary samples,
    /// they stay there: a slope adds to its value for some 1/α samples at most.
    pub(super) fn is_followed(&self) -> bool {
        let (ratio, tangential) = (&self.ratio, &self.tangential);
        let greatest = T::GREATEST * T::literal(1.0 / 1024.0);
        [ratio.value, ratio.slope, tangential.value, tangential.slope].iter().all(|x| x.abs() < greatest)
    }

    /// Takes in a sample; returns the standardised innovations of the ratio and of the force.
    #[inline(always)]
    pub(super) fn follow(&mut self, variances: &Variances<T>, sample: &Sample<T>, step: &Step<T>) -> (T, T) {
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
    pub(super) fn fall(&mut self, &(of_ratio, of_force): &(T, T)) -> T {
        let square = lesser(of_ratio * of_ratio, T::literal(GREATEST_SQUARE));
        self.roughness += (square - self.roughness) * T::literal(1.0 / 256.0);
        // By what was known before this sample.
        let fall = lesser(-of_ratio, -of_force) * self.smoothing;
        // One step of Newton's method for 1/√: since the roughness grows by at most a quarter a
        // sample, and far less but after a jump, this stays within 2 % of it, without a root, a division or a branch.
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
