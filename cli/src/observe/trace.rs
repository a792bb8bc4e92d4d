//! Curves over time, thinned so that their peaks are kept.

/// Most bins of a trace; each draws at most two points of a curve.
const CAPACITY: usize = 480;

/// One value and when it was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) time: f64,
    pub(crate) value: f64,
}

impl From<Point> for (f64, f64) {
    fn from(point: Point) -> Self {
        (point.time, point.value)
    }
}

/// A curve between its gaps.
pub(crate) type Pieces = Vec<Vec<Point>>;

#[derive(Clone, Copy, Debug)]
struct Bin {
    /// Infinite as long as there is none.
    least: Point,
    greatest: Point,
    /// A sample of this bin had no value: the curve breaks here.
    broken: bool,
}

impl Bin {
    const EMPTY: Self = Self {
        least: Point { time: 0.0, value: f64::INFINITY },
        greatest: Point { time: 0.0, value: f64::NEG_INFINITY },
        broken: false,
    };

    #[inline]
    fn add(&mut self, time: f64, value: f64) {
        if !(value.is_finite() && time.is_finite()) {
            self.broken = true;
            return;
        }
        if value < self.least.value {
            self.least = Point { time, value };
        }
        if value > self.greatest.value {
            self.greatest = Point { time, value };
        }
    }

    /// With one that came later.
    fn joined(&self, other: &Self) -> Self {
        Self {
            least: if other.least.value < self.least.value { other.least } else { self.least },
            greatest: if other.greatest.value > self.greatest.value { other.greatest } else { self.greatest },
            broken: self.broken || other.broken,
        }
    }
}

/// Some curves of any length in bounded memory.
///
/// Samples fall into bins of equally many samples; a bin keeps the least and the greatest value of each curve
/// with their times. When the bins are used up, neighbours join and every bin holds twice as many
/// samples. So no peak is lost, however long the recording.
#[derive(Clone, Debug)]
pub(crate) struct Trace<const N: usize> {
    bins: Vec<[Bin; N]>,
    /// Samples of a full bin.
    stride: u64,
    /// Samples in the last bin.
    filled: u64,
}

impl<const N: usize> Default for Trace<N> {
    fn default() -> Self {
        Self { bins: Vec::with_capacity(CAPACITY), stride: 1, filled: 0 }
    }
}

impl<const N: usize> Trace<N> {
    /// Takes the next sample, a value for each curve; NaN (or what is not finite) where there is none.
    #[inline]
    pub(crate) fn add(&mut self, time: f64, values: &[f64; N]) {
        if self.filled >= self.stride || self.bins.is_empty() {
            if self.bins.len() == CAPACITY {
                self.halve();
            }
            self.bins.push([Bin::EMPTY; N]);
            self.filled = 0;
        }
        self.filled += 1;
        if let Some(last) = self.bins.last_mut() {
            for (bin, value) in last.iter_mut().zip(values) {
                bin.add(time, *value);
            }
        }
    }

    fn halve(&mut self) {
        let joined = self.bins.chunks(2).map(|pair| match pair {
            [a, b] => core::array::from_fn(|curve| match (a.get(curve), b.get(curve)) {
                (Some(a), Some(b)) => a.joined(b),
                _ => Bin::EMPTY,
            }),
            [a, ..] => *a,
            [] => [Bin::EMPTY; N],
        });
        self.bins = joined.collect();
        self.stride *= 2;
    }

    /// The pieces of a curve between its gaps, in order of time.
    pub(crate) fn pieces(&self, curve: usize) -> Pieces {
        let mut pieces = Vec::new();
        let mut piece: Vec<Point> = Vec::new();
        for Bin { least, greatest, broken } in self.bins.iter().filter_map(|bins| bins.get(curve)) {
            if least.value <= greatest.value {
                let (first, second) =
                    if least.time <= greatest.time { (least, greatest) } else { (greatest, least) };
                piece.push(*first);
                if second != first {
                    piece.push(*second);
                }
            }
            if *broken && !piece.is_empty() {
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
    use rand::{RngExt, SeedableRng};

    use super::{CAPACITY, Point, Trace};

    fn points(trace: &Trace<1>) -> Vec<Point> {
        trace.pieces(0).concat()
    }

    #[test]
    fn keeps_every_sample_of_a_short_recording() {
        let mut trace = Trace::<1>::default();
        for i in 0..CAPACITY {
            trace.add(i as f64, &[(i as f64).sin()]);
        }
        assert_eq!(points(&trace).len(), CAPACITY);
    }

    #[test]
    fn keeps_a_single_spike_of_either_sign_in_a_long_one() {
        for spike_at in [0_usize, 1, 777, 123_456, 999_999] {
            let mut trace = Trace::<1>::default();
            for i in 0..1_000_000_usize {
                let value = if i == spike_at {
                    9.0
                } else if i == (spike_at + 500_001) % 1_000_000 {
                    -7.0
                } else {
                    (i as f64 * 0.001).sin()
                };
                trace.add(i as f64, &[value]);
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
        let mut trace = Trace::<1>::default();
        for (i, value) in [Some(1.0), Some(2.0), None, Some(f64::NAN), Some(3.0)].into_iter().enumerate() {
            trace.add(i as f64, &[value.unwrap_or(f64::NAN)]);
        }
        let lengths: Vec<usize> = trace.pieces(0).iter().map(Vec::len).collect();
        assert_eq!(lengths, [2, 1]);
    }

    /// What the documentation says, from all samples at once: bins of equally many samples, as few to a bin as
    /// fit; the first least and the first greatest value of each, in order of time; a piece ends with a bin that
    /// has a gap.
    fn by_hand(samples: &[(f64, Option<f64>)]) -> Vec<Vec<Point>> {
        let stride = (0..).map(|k| 1 << k).find(|stride| samples.len() <= CAPACITY * stride).unwrap();
        let (mut pieces, mut piece) = (Vec::new(), Vec::new());
        for bin in samples.chunks(stride) {
            let good = || bin.iter().filter_map(|(time, value)| value.map(|value| (*time, value)));
            let extreme = |sign: f64| {
                good().fold(None, |best: Option<(f64, f64)>, next| match best {
                    Some(best) if sign * best.1 <= sign * next.1 => Some(best),
                    _ => Some(next),
                })
            };
            if let (Some(least), Some(greatest)) = (extreme(1.0), extreme(-1.0)) {
                let mut ends = vec![least, greatest];
                ends.sort_by(|a, b| a.0.total_cmp(&b.0));
                ends.dedup();
                piece.extend(ends.into_iter().map(|(time, value)| Point { time, value }));
            }
            if bin.iter().any(|(_, value)| value.is_none()) && !piece.is_empty() {
                pieces.push(core::mem::take(&mut piece));
            }
        }
        pieces.extend((!piece.is_empty()).then_some(piece));
        pieces
    }

    #[test]
    fn bins_are_those_of_the_whole_recording_however_it_grew() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        for length in [0, 1, 2, 479, 480, 481, 959, 960, 961, 1919, 1921, 5000] {
            for gaps in [0.0, 0.002, 0.3] {
                let mut trace = Trace::<2>::default();
                let (mut samples, mut others) = (Vec::new(), Vec::new());
                for i in 0..length {
                    // Few different values, so that extremes are met more than once.
                    let value = f64::from(random.random_range(-20..20_i32));
                    let value = (random.random::<f64>() >= gaps).then_some(value);
                    // Another curve beside it, which is without gaps.
                    let beside = f64::from(i % 7);
                    trace.add(f64::from(i) * 0.5, &[beside, value.unwrap_or(f64::INFINITY)]);
                    others.push((f64::from(i) * 0.5, Some(beside)));
                    samples.push((f64::from(i) * 0.5, value));
                }
                assert_eq!(trace.pieces(0), by_hand(&others), "{length} samples without gaps");
                assert_eq!(trace.pieces(1), by_hand(&samples), "{length} samples, {gaps} of them gaps");
            }
        }
    }
}
