//! What went missing on the way from a sensor.

use crate::sensors::LinkStatistics;
use crate::sensors::line::LineStatistics;

/// What a link lost or damaged. Some protocols number their samples, others do not: there a loss leaves
/// no trace.
///
/// ```
/// use fingertip_drivers::devices::Losses;
///
/// let before = Losses { lost: Some(2), ..Losses::default() };
/// let since = Losses { lost: Some(1), corrupt: 1, ..Losses::default() };
/// assert_eq!(before.and(since), Losses { lost: Some(3), corrupt: 1, ..Losses::default() });
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Losses {
    /// Samples or datagrams that never came; `None` where the protocol does not tell.
    pub lost: Option<u64>,
    /// Came behind a newer one, and were not used.
    pub late: u64,
    /// Came more than once.
    pub duplicates: u64,
    /// Could not be read, or had a number that makes no sense.
    pub corrupt: u64,
    /// Bytes that belong to no frame.
    pub skipped_bytes: u64,
    /// How often the sensor began to count anew.
    pub restarts: u64,
}

impl Losses {
    pub(crate) fn of_link(link: &LinkStatistics) -> Self {
        Self {
            lost: Some(link.lost),
            late: link.late,
            duplicates: link.duplicates,
            corrupt: link.corrupt + link.doubtful,
            skipped_bytes: 0,
            restarts: link.restarts,
        }
    }

    pub(crate) fn of_line(line: LineStatistics, missing: Option<u64>) -> Self {
        Self { lost: missing, corrupt: line.failed, skipped_bytes: line.skipped, ..Self::default() }
    }

    /// Those of a connection before, and of this one.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            lost: match (self.lost, other.lost) {
                (Some(a), Some(b)) => Some(a + b),
                (a, b) => a.or(b),
            },
            late: self.late + other.late,
            duplicates: self.duplicates + other.duplicates,
            corrupt: self.corrupt + other.corrupt,
            skipped_bytes: self.skipped_bytes + other.skipped_bytes,
            restarts: self.restarts + other.restarts,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LinkStatistics, Losses};

    #[test]
    fn losses_add_up_as_far_as_they_are_known() {
        let all =
            Losses { lost: Some(1200), late: 2, duplicates: 3, corrupt: 4, skipped_bytes: 5, restarts: 6 };
        let twice =
            Losses { lost: Some(2400), late: 4, duplicates: 6, corrupt: 8, skipped_bytes: 10, restarts: 12 };
        assert_eq!(all.and(all), twice);
        let untold = Losses { lost: None, corrupt: 1, ..Losses::default() };
        assert_eq!((untold.and(untold).lost, untold.and(all).lost), (None, Some(1200)));
    }

    #[test]
    fn what_a_link_says_is_taken_over() {
        let mut link = LinkStatistics::default();
        (link.lost, link.late, link.duplicates, link.restarts) = (1, 2, 3, 4);
        (link.corrupt, link.doubtful) = (5, 60);
        let expected =
            Losses { lost: Some(1), late: 2, duplicates: 3, corrupt: 65, skipped_bytes: 0, restarts: 4 };
        assert_eq!(Losses::of_link(&link), expected);
    }
}
