//! How one sample ended, as a word.

use fingertip::contact::{NoContact, Resolution};
use fingertip_scene::NoWrench;

/// Contact, or why not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Status {
    Contact,
    BelowThreshold,
    Misses,
    OnlyPulling,
    OutsideActiveRegion,
    NotFinite,
    /// The force is steeper than friction allows.
    BeyondFriction,
    /// A reason that this program has no word for yet.
    Other,
    /// Part of the rest at the start, from which the tare is taken.
    Rest,
    /// A gauge reads beyond the range that the calibration gives it.
    Saturated,
    /// The reading lies beyond what a curved sensor was calibrated for.
    Uncalibrated,
    /// The row repeats another one, its time does not advance, or a number is missing.
    UnusableRow,
}

impl Status {
    pub(crate) const ALL: [Self; 12] = [
        Self::Contact,
        Self::BelowThreshold,
        Self::Misses,
        Self::OnlyPulling,
        Self::OutsideActiveRegion,
        Self::NotFinite,
        Self::BeyondFriction,
        Self::Other,
        Self::Rest,
        Self::Saturated,
        Self::Uncalibrated,
        Self::UnusableRow,
    ];

    #[inline]
    pub(crate) fn of(resolution: &Resolution<f64>) -> Self {
        match resolution {
            Resolution::Contact(_) => Self::Contact,
            Resolution::NoContact(NoContact::BelowThreshold { .. }) => Self::BelowThreshold,
            Resolution::NoContact(NoContact::Misses { .. }) => Self::Misses,
            Resolution::NoContact(NoContact::OnlyPulling { .. }) => Self::OnlyPulling,
            Resolution::NoContact(NoContact::OutsideActiveRegion { .. }) => Self::OutsideActiveRegion,
            Resolution::NoContact(NoContact::NotFinite) => Self::NotFinite,
            Resolution::NoContact(NoContact::BeyondFriction { .. }) => Self::BeyondFriction,
            Resolution::NoContact(_) => Self::Other,
        }
    }

    /// Why a reading gave no wrench.
    pub(crate) const fn without_wrench(why: NoWrench) -> Self {
        match why {
            NoWrench::Saturated => Self::Saturated,
            NoWrench::Uncalibrated => Self::Uncalibrated,
            _ => Self::UnusableRow,
        }
    }

    /// The word in `contacts.csv`.
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::BelowThreshold => "below_threshold",
            Self::Misses => "misses",
            Self::OnlyPulling => "only_pulling",
            Self::OutsideActiveRegion => "outside_active_region",
            Self::NotFinite => "not_finite",
            Self::BeyondFriction => "beyond_friction",
            Self::Other => "other",
            Self::Rest => "rest",
            Self::Saturated => "saturated",
            Self::Uncalibrated => "uncalibrated",
            Self::UnusableRow => "unusable_row",
        }
    }

    /// What it means, for the summary.
    pub(crate) const fn meaning(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::BelowThreshold => "force below the threshold",
            Self::Misses => "line of action misses the surface",
            Self::OnlyPulling => "force pulls outward",
            Self::OutsideActiveRegion => "presses outside the active region",
            Self::NotFinite => "reading not finite",
            Self::BeyondFriction => "more tangential than friction allows",
            Self::Other => "another reason",
            Self::Rest => "rest at the start, for the tare",
            Self::Saturated => "a gauge is saturated",
            Self::Uncalibrated => "beyond what the curved sensor was calibrated for",
            Self::UnusableRow => "row repeated, out of time or incomplete",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Status;

    #[test]
    fn the_message_of_ros_names_every_status() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../bridges/ros/fingertip_msgs/msg/Touch.msg");
        let text = std::fs::read_to_string(path).unwrap();
        for status in Status::ALL {
            let word = status.word();
            let named = [format!("\"{word}\""), format!(" {word},"), format!(" {word}.")];
            assert!(named.iter().any(|named| text.contains(named)), "{word}");
        }
    }

    #[test]
    fn the_page_of_errors_explains_every_status_but_a_contact_and_no_other() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../book/src/how-to/errors.md");
        let text = std::fs::read_to_string(path).unwrap();
        let (_, table) = text.split_once("| `status` |").unwrap();
        let rows = table.lines().skip(2).take_while(|line| line.starts_with("| `"));
        let mut explained: Vec<_> = rows.map(|row| row.split('`').nth(1).unwrap()).collect();
        let mut all: Vec<_> = Status::ALL[1..].iter().map(|status| status.word()).collect();
        explained.sort_unstable();
        all.sort_unstable();
        assert_eq!(explained, all);
    }
}
