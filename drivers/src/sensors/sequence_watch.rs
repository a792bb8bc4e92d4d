//! Loss, repetition and disorder of numbered records.

/// What the number of a record says about it.
///
/// ```
/// use fingertip_drivers::sensors::{Arrival, SequenceWatch};
///
/// let mut watch = SequenceWatch::default();
/// let arrivals = [5, 6, 9, 8, 9].map(|number| watch.arrive(number));
/// let expected = [
///     Arrival::Start,
///     Arrival::New { missing: 0 },
///     Arrival::New { missing: 2 },
///     Arrival::Late,
///     Arrival::Duplicate,
/// ];
/// assert_eq!(arrivals, expected);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// The first record, or the first after the sender began to count anew.
    Start,
    /// Newer than all before; this many between are missing (so far).
    New {
        /// How many numbers were passed over.
        missing: u32,
    },
    /// It was missing and comes late: older than one that has been seen.
    Late,
    /// It has been seen already.
    Duplicate,
    /// Its number lies so far off that it may be damaged. If the next one follows on it, the sender
    /// counts anew.
    Doubtful,
}

impl Arrival {
    /// `true` for a record that is newer than all before it.
    #[must_use]
    pub const fn is_news(self) -> bool {
        matches!(self, Self::Start | Self::New { .. })
    }
}

/// How a link has behaved so far.
///
/// ```
/// use fingertip_drivers::sensors::SequenceWatch;
///
/// let mut watch = SequenceWatch::default();
/// for number in [5, 6, 9, 8, 9] {
///     watch.arrive(number);
/// }
/// // Record 7 never came.
/// let statistics = watch.statistics();
/// assert_eq!((statistics.received, statistics.lost, statistics.late, statistics.duplicates), (5, 1, 1, 1));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LinkStatistics {
    /// Records that came, of every kind.
    pub received: u64,
    /// Records that never came: their numbers were passed over.
    pub lost: u64,
    /// Records that came behind a newer one.
    pub late: u64,
    /// Records that came more than once.
    pub duplicates: u64,
    /// Records whose number made no sense.
    pub doubtful: u64,
    /// How often the sender began to count anew.
    pub restarts: u64,
    /// Datagrams or frames that could not be read at all.
    pub corrupt: u64,
}

/// Follows the 32-bit numbers of records over their wrap-around.
///
/// A number up to [`FURTHEST`](Self::FURTHEST) ahead is taken as news after a loss; one up to
/// [`WINDOW`](Self::WINDOW) behind as late or repeated, and which of the two is known exactly. All
/// others are doubtful.
///
/// ```
/// use fingertip_drivers::sensors::{Arrival, SequenceWatch};
///
/// // Numbers wrap around.
/// let mut watch = SequenceWatch::default();
/// watch.arrive(u32::MAX);
/// assert_eq!(watch.arrive(1), Arrival::New { missing: 1 });
/// assert_eq!(watch.index(), 2);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct SequenceWatch {
    newest: Option<u32>,
    /// Bit `i`: the record `i` before the newest has come.
    seen: u64,
    /// Number of the newest record since the first one, the lost ones included.
    index: u64,
    doubtful: Option<u32>,
    statistics: LinkStatistics,
}

impl SequenceWatch {
    /// How far ahead a number may be: two and a half minutes at 7000 records per second.
    pub const FURTHEST: u32 = 1 << 20;
    /// How far behind a number may be.
    pub const WINDOW: u32 = 64;

    /// Takes the number of the next record.
    pub fn arrive(&mut self, number: u32) -> Arrival {
        self.statistics.received += 1;
        let Some(newest) = self.newest else {
            return self.start(number);
        };
        let ahead = number.wrapping_sub(newest);
        let behind = newest.wrapping_sub(number);
        if ahead == 0 {
            self.statistics.duplicates += 1;
            Arrival::Duplicate
        } else if ahead <= Self::FURTHEST {
            self.seen = self.seen.checked_shl(ahead).unwrap_or(0) | 1;
            self.newest = Some(number);
            self.index += u64::from(ahead);
            self.doubtful = None;
            let missing = ahead - 1;
            self.statistics.lost += u64::from(missing);
            Arrival::New { missing }
        } else if behind < Self::WINDOW && u64::from(behind) <= self.index {
            let bit = 1_u64 << behind;
            if self.seen & bit != 0 {
                self.statistics.duplicates += 1;
                return Arrival::Duplicate;
            }
            self.seen |= bit;
            self.statistics.late += 1;
            self.statistics.lost = self.statistics.lost.saturating_sub(1);
            Arrival::Late
        } else if self.doubtful == Some(number.wrapping_sub(1)) {
            self.statistics.restarts += 1;
            self.start(number)
        } else {
            self.doubtful = Some(number);
            self.statistics.doubtful += 1;
            Arrival::Doubtful
        }
    }

    fn start(&mut self, number: u32) -> Arrival {
        self.index += u64::from(self.newest.is_some());
        self.newest = Some(number);
        // Nothing before it is missed.
        self.seen = u64::MAX;
        Arrival::Start
    }

    /// Notes a datagram that could not be read.
    pub const fn corrupt(&mut self) {
        self.statistics.corrupt += 1;
    }

    /// How the link has behaved so far.
    #[must_use]
    pub const fn statistics(&self) -> &LinkStatistics {
        &self.statistics
    }

    /// How many records the sender numbered between the first one and the newest one.
    #[must_use]
    pub const fn index(&self) -> u64 {
        self.index
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn each_kind_is_told_apart_across_the_wrap_around() {
        let mut watch = SequenceWatch::default();
        let arrivals = [
            (u32::MAX - 2, Arrival::Start),
            (u32::MAX - 1, Arrival::New { missing: 0 }),
            (1, Arrival::New { missing: 2 }),
            (0, Arrival::Late),
            (0, Arrival::Duplicate),
            (1, Arrival::Duplicate),
            (2, Arrival::New { missing: 0 }),
            (1 << 31, Arrival::Doubtful),
            (3, Arrival::New { missing: 0 }),
            (u32::MAX, Arrival::Late),
            (5_000_000, Arrival::Doubtful),
            (5_000_001, Arrival::Start),
            (5_000_000, Arrival::Duplicate),
        ];
        for (number, expected) in arrivals {
            assert_eq!(watch.arrive(number), expected, "{number}");
        }
        let expected = LinkStatistics {
            received: 13,
            lost: 0,
            late: 2,
            duplicates: 3,
            doubtful: 2,
            restarts: 1,
            corrupt: 0,
        };
        assert_eq!(*watch.statistics(), expected);
    }

    /// What comes of numbers one after another.
    fn arrivals<const N: usize>(numbers: [u32; N]) -> (SequenceWatch, [Arrival; N]) {
        let mut watch = SequenceWatch::default();
        let arrivals = numbers.map(|number| watch.arrive(number));
        (watch, arrivals)
    }

    #[test]
    fn a_number_is_news_up_to_the_furthest_one_ahead() {
        let furthest = SequenceWatch::FURTHEST;
        let (watch, seen) = arrivals([5, 5 + furthest]);
        assert_eq!(seen[1], Arrival::New { missing: furthest - 1 });
        assert_eq!((watch.index(), watch.statistics().lost), (furthest.into(), u64::from(furthest) - 1));
        let (watch, seen) = arrivals([5, 6 + furthest]);
        assert_eq!(seen[1], Arrival::Doubtful);
        assert_eq!((watch.index(), watch.statistics().lost), (0, 0));
    }

    #[test]
    fn a_number_is_late_only_within_the_window_and_not_before_the_first_one() {
        // The first was 1000: what is before it never counted as lost.
        for (number, expected) in [(1000, Arrival::Duplicate), (999, Arrival::Doubtful)] {
            assert_eq!(arrivals([1000, 1002, number]).1[2], expected);
        }
        let window = SequenceWatch::WINDOW;
        for (behind, expected) in [(window - 1, Arrival::Late), (window, Arrival::Doubtful)] {
            let (watch, seen) = arrivals([1000, 1100, 1100 - behind]);
            assert_eq!(seen[2], expected);
            assert_eq!(watch.statistics().lost, 99 - u64::from(expected == Arrival::Late));
        }
        // What came before a jump is known for as long as the window reaches.
        let at_its_edge = arrivals([1000, 1000 + window - 1, 1000, 1001]).1;
        assert_eq!(at_its_edge[2..], [Arrival::Duplicate, Arrival::Late]);
        let beyond = arrivals([1000, 1000 + window, 1001, 1001, 1000]).1;
        assert_eq!(beyond[2..], [Arrival::Late, Arrival::Duplicate, Arrival::Doubtful]);
        // Nothing of what came before it is in the window.
        let far = arrivals([1000, 2000, 1990, 1990]).1;
        assert_eq!(far[2..], [Arrival::Late, Arrival::Duplicate]);
    }

    #[test]
    fn the_sender_counts_anew_if_a_doubtful_number_is_followed_by_the_next() {
        let far = 3_000_000_000;
        let (watch, seen) = arrivals([10, far, far + 1, far + 2]);
        assert_eq!(seen[1..], [Arrival::Doubtful, Arrival::Start, Arrival::New { missing: 0 }]);
        assert_eq!((watch.statistics().restarts, watch.index()), (1, 2));
        // Not by the same, nor by one that leaves one out, nor if news came between.
        assert_eq!(arrivals([10, far, far]).1[2], Arrival::Doubtful);
        assert_eq!(arrivals([10, far, far + 2, far + 3]).1[2..], [Arrival::Doubtful, Arrival::Start]);
        assert_eq!(arrivals([10, far, 11, far + 1]).1[3], Arrival::Doubtful);
        // What is before the new beginning was never counted as lost.
        let (watch, seen) = arrivals([10, 14, far, far + 1, far - 1]);
        assert_eq!((seen[4], watch.statistics().lost), (Arrival::Duplicate, 3));
    }

    #[test]
    fn news_is_what_is_newer_than_all_before() {
        assert!(Arrival::Start.is_news() && Arrival::New { missing: 3 }.is_news());
        let old = [Arrival::Late, Arrival::Duplicate, Arrival::Doubtful];
        assert!(!old.into_iter().any(Arrival::is_news));
    }

    proptest! {
        #[test]
        fn any_numbers_are_taken(numbers in prop::collection::vec(any::<u32>(), 0..200)) {
            let mut watch = SequenceWatch::default();
            for number in numbers {
                watch.arrive(number);
            }
        }

        /// Numbers sent in order, some lost, repeated or swapped with the next: counted against
        /// what was done to them.
        #[test]
        fn losses_and_repetitions_are_counted_exactly(
            first in any::<u32>(),
            fates in prop::collection::vec(prop::sample::select(b"....................lds".to_vec()), 1..500),
        ) {
            let mut sent = Vec::new();
            let (mut lost, mut repeated) = (0, 0);
            let mut fates = fates;
            // The last ones arrive, so that every loss can be seen.
            fates.extend(b"..");
            let mut number = first;
            for fate in fates {
                match fate {
                    // A loss before the first arrival is not one.
                    b'l' if !sent.is_empty() => lost += 1,
                    b'd' => { sent.extend([number, number]); repeated += 1; }
                    b's' if sent.len() > 1 => { let at = sent.len() - 1; sent.insert(at, number); }
                    _ => sent.push(number),
                }
                number = number.wrapping_add(1);
            }
            let mut watch = SequenceWatch::default();
            for number in &sent {
                watch.arrive(*number);
            }
            let statistics = watch.statistics();
            prop_assert_eq!(statistics.received, sent.len() as u64);
            prop_assert_eq!((statistics.lost, statistics.duplicates, statistics.doubtful), (lost, repeated, 0));
        }
    }
}
