//! The power of readings by their frequency.

use alloc::sync::Arc;
use core::fmt;

use realfft::{RealFftPlanner, RealToComplex};

/// Periodograms of stretches of a recording that overlap by half, through von Hann's window (Welch 1967).
#[derive(Clone)]
pub(super) struct Spectra {
    transform: Arc<dyn RealToComplex<f64>>,
    window: Vec<f64>,
    /// The readings of each channel that wait for the rest of their stretch.
    waiting: Vec<Vec<f64>>,
    start: u64,
    pub(super) segments: Vec<Segment>,
    joined: u32,
}

impl fmt::Debug for Spectra {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Spectra").field("segments", &self.segments.len()).finish_non_exhaustive()
    }
}

/// The mean of the periodograms of one channel.
pub(super) struct Mean {
    /// By frequency, as in a [`Segment`].
    pub(super) powers: Vec<f64>,
    pub(super) stretches: u32,
    /// Whether they lie in the span that was asked for.
    pub(super) is_of_span: bool,
}

/// The mean periodogram of some stretches.
#[derive(Clone, Debug)]
pub(super) struct Segment {
    /// The numbers of its samples.
    pub(super) from: u64,
    pub(super) to: u64,
    pub(super) stretches: u32,
    /// Of each channel: power by frequency, in squared units a sample⁻¹ (one-sided).
    pub(super) powers: Vec<Vec<f64>>,
}

impl Spectra {
    /// Readings of a stretch.
    pub(super) const LENGTH: usize = 1024;
    /// So many segments are kept; then neighbours are joined.
    const MOST: usize = 64;

    pub(super) fn new(channels: usize) -> Self {
        let transform = RealFftPlanner::new().plan_fft_forward(Self::LENGTH);
        let angle = core::f64::consts::TAU / Self::LENGTH as f64;
        let window = (0..Self::LENGTH).map(|i| 0.5 - 0.5 * (angle * (i as f64 + 0.5)).cos()).collect();
        Self {
            transform,
            window,
            waiting: vec![Vec::new(); channels],
            start: 0,
            segments: Vec::new(),
            joined: 1,
        }
    }

    /// Readings are missing: a stretch does not reach across.
    pub(super) fn interrupt(&mut self) {
        self.waiting.iter_mut().for_each(Vec::clear);
    }

    /// Takes sample number `at`. One that is not finite counts as missing.
    pub(super) fn add(&mut self, at: u64, readings: &[f64]) {
        if readings.iter().any(|reading| !reading.is_finite()) {
            return self.interrupt();
        }
        let is_first = self.waiting.first().is_none_or(Vec::is_empty);
        if is_first {
            self.start = at;
        }
        for (waiting, reading) in self.waiting.iter_mut().zip(readings) {
            waiting.push(*reading);
        }
        if self.waiting.first().is_some_and(|waiting| waiting.len() == Self::LENGTH) {
            let powers = self.waiting.iter().map(|readings| self.periodogram(readings)).collect();
            let to = self.start + Self::LENGTH as u64;
            self.keep(Segment { from: self.start, to, stretches: 1, powers });
            for waiting in &mut self.waiting {
                waiting.drain(..Self::LENGTH / 2);
            }
            self.start += Self::LENGTH as u64 / 2;
        }
    }

    fn keep(&mut self, segment: Segment) {
        match self.segments.last_mut() {
            Some(last) if last.stretches < self.joined => last.join(&segment),
            _ => self.segments.push(segment),
        }
        if self.segments.len() > Self::MOST {
            let mut joined: Vec<Segment> = Vec::with_capacity(Self::MOST);
            for (number, segment) in self.segments.drain(..).enumerate() {
                match joined.last_mut().filter(|_| number % 2 == 1) {
                    Some(last) => last.join(&segment),
                    None => joined.push(segment),
                }
            }
            self.segments = joined;
            self.joined *= 2;
        }
    }

    /// Of readings less the straight line through them.
    fn periodogram(&self, readings: &[f64]) -> Vec<f64> {
        let mut input = self.transform.make_input_vec();
        let mut output = self.transform.make_output_vec();
        let count = readings.len() as f64;
        let (mean, middle) = (readings.iter().sum::<f64>() / count, (count - 1.0) / 2.0);
        let off = |i: usize| i as f64 - middle;
        let with_time: f64 = readings.iter().enumerate().map(|(i, x)| off(i) * (x - mean)).sum();
        let slope = with_time / (count * (count * count - 1.0) / 12.0);
        for (i, ((place, reading), window)) in input.iter_mut().zip(readings).zip(&self.window).enumerate() {
            *place = (reading - mean - slope * off(i)) * window;
        }
        let mut powers = vec![0.0; output.len()];
        // It can fail for vectors of a wrong length only.
        if self.transform.process(&mut input, &mut output).is_ok() {
            let squares: f64 = self.window.iter().map(|window| window * window).sum();
            for (power, amplitude) in powers.iter_mut().zip(&output) {
                *power = 2.0 * amplitude.norm_sqr() / squares;
            }
        }
        powers
    }

    /// The mean over the stretches that lie between two samples, of one channel, and how many there are; over all if
    /// fewer than two lie there.
    pub(super) fn mean(&self, channel: usize, from: u64, to: u64) -> Option<Mean> {
        let inside = |segment: &&Segment| segment.from >= from && segment.to <= to;
        let stretches = |segments: &[&Segment]| segments.iter().map(|segment| segment.stretches).sum::<u32>();
        let mut chosen: Vec<&Segment> = self.segments.iter().filter(inside).collect();
        let is_of_span = stretches(&chosen) >= 2;
        if !is_of_span {
            chosen = self.segments.iter().collect();
        }
        let count = stretches(&chosen);
        let mut mean = vec![0.0; Self::LENGTH / 2 + 1];
        for segment in &chosen {
            let share = f64::from(segment.stretches) / f64::from(count);
            for (sum, power) in mean.iter_mut().zip(segment.powers.get(channel)?) {
                *sum += power * share;
            }
        }
        (count > 0).then_some(Mean { powers: mean, stretches: count, is_of_span })
    }
}

impl Segment {
    fn join(&mut self, next: &Self) {
        let (n, m) = (f64::from(self.stretches), f64::from(next.stretches));
        for (powers, more) in self.powers.iter_mut().zip(&next.powers) {
            for (power, other) in powers.iter_mut().zip(more) {
                *power = (*power * n + other * m) / (n + m);
            }
        }
        self.stretches += next.stretches;
        self.to = next.to;
    }
}

#[cfg(test)]
mod tests {
    use super::Spectra;
    use core::f64::consts::TAU;

    /// Parseval: the power over all frequencies is the variance, and that of a line half its squared amplitude.
    #[test]
    fn the_power_is_the_variance() {
        let mut spectra = Spectra::new(2);
        for i in 0..200_000_u64 {
            let white = f64::from((i as u32).wrapping_mul(0x9E37_79B9) >> 8) / f64::from(1_u32 << 24) - 0.5;
            spectra.add(i, &[white, 3.0 * (TAU * 0.123 * i as f64).sin() + 1e-3 * i as f64]);
        }
        assert!(spectra.segments.len() <= Spectra::MOST);
        let power = |channel| {
            let mean = spectra.mean(channel, 0, u64::MAX).unwrap();
            assert_eq!((mean.stretches, mean.is_of_span), (200_000 / 512 - 1, true));
            mean.powers.iter().sum::<f64>() / Spectra::LENGTH as f64
        };
        assert!((power(0) * 12.0 - 1.0).abs() < 0.02, "{}", power(0));
        assert!((power(1) / 4.5 - 1.0).abs() < 0.01, "{}", power(1));
    }

    #[test]
    fn what_is_missing_is_not_bridged() {
        let mut spectra = Spectra::new(1);
        for i in 0..3000_u64 {
            spectra.add(i, &[if i % 1000 == 999 { f64::NAN } else { 1.0 }]);
        }
        assert!(spectra.segments.is_empty() && spectra.mean(0, 0, u64::MAX).is_none());
        (3000..4100).for_each(|i| spectra.add(i, &[1.0]));
        assert_eq!((spectra.segments.len(), spectra.segments[0].from), (1, 3000));
    }
}
