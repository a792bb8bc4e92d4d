//! What went missing on the way.

use core::fmt;

use fingertip_drivers::sensors::LinkStatistics;
use fingertip_drivers::sensors::line::LineStatistics;

use crate::table::count;

/// What a link lost or damaged. Some protocols number their samples, others do not: there a loss leaves
/// no trace.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Losses {
    /// Samples or datagrams that never came; `None` where the protocol does not tell.
    pub(crate) lost: Option<u64>,
    /// Came behind a newer one, and were not used.
    pub(crate) late: u64,
    /// Came more than once.
    pub(crate) duplicates: u64,
    /// Could not be read, or had a number that makes no sense.
    pub(crate) corrupt: u64,
    /// Bytes that belong to no frame.
    pub(crate) skipped_bytes: u64,
    /// How often the sensor began to count anew.
    pub(crate) restarts: u64,
}

impl Losses {
    pub(super) fn of_link(link: &LinkStatistics) -> Self {
        Self {
            lost: Some(link.lost),
            late: link.late,
            duplicates: link.duplicates,
            corrupt: link.corrupt + link.doubtful,
            skipped_bytes: 0,
            restarts: link.restarts,
        }
    }

    pub(super) fn of_line(line: LineStatistics, missing: Option<u64>) -> Self {
        Self { lost: missing, corrupt: line.failed, skipped_bytes: line.skipped, ..Self::default() }
    }

    /// Those of a connection before, and of this one.
    pub(super) fn and(self, other: Self) -> Self {
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

impl fmt::Display for Losses {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.lost {
            Some(lost) => {
                let [lost, late, duplicates] = [lost, self.late, self.duplicates].map(count);
                write!(out, "{lost} lost, {late} late, {duplicates} repeated")?;
            }
            // Whoever cannot tell what is lost cannot tell what comes late or twice, either.
            None => write!(out, "lost: not told")?,
        }
        write!(out, ", {} damaged", count(self.corrupt))?;
        if self.skipped_bytes > 0 {
            write!(out, ", {} bytes skipped", count(self.skipped_bytes))?;
        }
        if self.restarts > 0 {
            write!(out, ", counted anew {} times", count(self.restarts))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{LinkStatistics, Losses};

    #[test]
    fn losses_add_up_and_are_said_as_far_as_they_are_known() {
        let all =
            Losses { lost: Some(1200), late: 2, duplicates: 3, corrupt: 4, skipped_bytes: 5, restarts: 6 };
        let said = "1\u{202f}200 lost, 2 late, 3 repeated, 4 damaged, 5 bytes skipped, counted anew 6 times";
        assert_eq!(all.to_string(), said);
        let twice =
            Losses { lost: Some(2400), late: 4, duplicates: 6, corrupt: 8, skipped_bytes: 10, restarts: 12 };
        assert_eq!(all.and(all), twice);
        let untold = Losses { lost: None, corrupt: 1, ..Losses::default() };
        assert_eq!(untold.to_string(), "lost: not told, 1 damaged");
        assert_eq!((untold.and(untold).lost, untold.and(all).lost), (None, Some(1200)));
        assert_eq!(Losses { lost: Some(0), ..untold }.to_string(), "0 lost, 0 late, 0 repeated, 1 damaged");
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
