//! A curve over time, thinned so that its peaks are kept.

/// Most bins of a trace; each draws at most two points of a curve.
const CAPACITY: usize = 480;

/// One value and when it was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) time: f64,
    pub(crate) value: f64,
}

#[derive(Clone, Copy, Debug)]
struct Extremes {
    least: Point,
    greatest: Point,
}

impl Extremes {
    fn joined(self, other: Self) -> Self {
        Self {
            least: if other.least.value < self.least.value { other.least } else { self.least },
            greatest: if other.greatest.value > self.greatest.value { other.greatest } else { self.greatest },
        }
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Bin {
    extremes: Option<Extremes>,
    /// A sample of this bin had no value: the curve breaks here.
    broken: bool,
}

impl Bin {
    fn joined(self, other: Self) -> Self {
        let extremes = match (self.extremes, other.extremes) {
            (Some(a), Some(b)) => Some(a.joined(b)),
            (a, b) => a.or(b),
        };
        Self { extremes, broken: self.broken || other.broken }
    }
}

/// A curve of any length in bounded memory.
///
/// Samples fall into bins of equally many samples; a bin keeps its least and its greatest value
/// with their times. When the bins are used up, neighbours join and every bin holds twice as many
/// samples. So no peak is lost, however long the recording.
#[derive(Clone, Debug)]
pub(crate) struct Trace {
    bins: Vec<Bin>,
    /// Samples of a full bin.
    stride: u64,
    /// Samples in the last bin.
    filled: u64,
}

impl Default for Trace {
    fn default() -> Self {
        Self { bins: Vec::with_capacity(CAPACITY), stride: 1, filled: 0 }
    }
}

impl Trace {
    /// Takes the next sample; `None` (or what is not finite) where there is no value.
    #[inline]
    pub(crate) fn add(&mut self, time: f64, value: Option<f64>) {
        let sample = match value {
            Some(value) if value.is_finite() && time.is_finite() => {
                let point = Point { time, value };
                Bin { extremes: Some(Extremes { least: point, greatest: point }), broken: false }
            }
            _ => Bin { extremes: None, broken: true },
        };
        if self.filled < self.stride
            && let Some(last) = self.bins.last_mut()
        {
            *last = last.joined(sample);
            self.filled += 1;
            return;
        }
        if self.bins.len() == CAPACITY {
            self.halve();
        }
        self.bins.push(sample);
        self.filled = 1;
    }

    fn halve(&mut self) {
        let joined = self.bins.chunks(2).map(|pair| match pair {
            [a, b] => a.joined(*b),
            [a, ..] => *a,
            [] => Bin::default(),
        });
        self.bins = joined.collect();
        self.bins.reserve_exact(CAPACITY - self.bins.len());
        self.stride *= 2;
    }

    /// The pieces of the curve between its gaps, in order of time.
    pub(crate) fn pieces(&self) -> Vec<Vec<Point>> {
        let mut pieces = Vec::new();
        let mut piece: Vec<Point> = Vec::new();
        for bin in &self.bins {
            if let Some(Extremes { least, greatest }) = bin.extremes {
                let (first, second) =
                    if least.time <= greatest.time { (least, greatest) } else { (greatest, least) };
                piece.push(first);
                if second != first {
                    piece.push(second);
                }
            }
            if bin.broken && !piece.is_empty() {
                pieces.push(core::mem::take(&mut piece));
            }
        }
        if !piece.is_empty() {
            pieces.push(piece);
        }
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::{CAPACITY, Point, Trace};

    fn points(trace: &Trace) -> Vec<Point> {
        trace.pieces().concat()
    }

    #[test]
    fn keeps_every_sample_of_a_short_recording() {
        let mut trace = Trace::default();
        for i in 0..CAPACITY {
            trace.add(i as f64, Some((i as f64).sin()));
        }
        assert_eq!(points(&trace).len(), CAPACITY);
    }

    #[test]
    fn keeps_a_single_spike_of_either_sign_in_a_long_one() {
        for spike_at in [0_usize, 1, 777, 123_456, 999_999] {
            let mut trace = Trace::default();
            for i in 0..1_000_000_usize {
                let value = if i == spike_at {
                    9.0
                } else if i == (spike_at + 500_001) % 1_000_000 {
                    -7.0
                } else {
                    (i as f64 * 0.001).sin()
                };
                trace.add(i as f64, Some(value));
            }
            let points = points(&trace);
            assert!(points.len() <= 2 * CAPACITY);
            assert!(points.contains(&Point { time: spike_at as f64, value: 9.0 }));
            assert!(points.iter().any(|point| point.value == -7.0));
            assert!(points.is_sorted_by(|a, b| a.time <= b.time));
        }
    }

    #[test]
    fn breaks_at_gaps_and_leaves_out_what_is_not_finite() {
        let mut trace = Trace::default();
        for (i, value) in [Some(1.0), Some(2.0), None, Some(f64::NAN), Some(3.0)].into_iter().enumerate() {
            trace.add(i as f64, value);
        }
        let lengths: Vec<usize> = trace.pieces().iter().map(Vec::len).collect();
        assert_eq!(lengths, [2, 1]);
    }
}
