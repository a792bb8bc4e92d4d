//! The columns that belong to one sensor.

use super::error::HeaderProblem;
use super::unit::SignalUnit;

/// The six columns of a wrench. Found by a [`Layout`](super::Layout), used on its rows.
#[derive(Clone, Debug, PartialEq)]
pub struct WrenchColumns {
    pub(super) name: String,
    pub(super) slots: [usize; 6],
}

/// The columns of the signals of one sensor. Found by a [`Layout`](super::Layout), used on its rows.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalColumns {
    pub(super) name: String,
    pub(super) unit: SignalUnit,
    pub(super) slots: Vec<usize>,
    pub(super) dummy: Option<usize>,
}

/// A column of plain numbers, such as a temperature or a part of an orientation. Found by
/// [`RecordingReader::watch`](super::RecordingReader::watch), used on its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NumberColumn {
    pub(super) slot: usize,
}

impl WrenchColumns {
    /// Name of the sensor, lower case; empty if the header gives none.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl SignalColumns {
    /// Name of the sensor, lower case; empty if the header gives none.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How many signals there are, without the dummy gauge.
    #[must_use]
    pub fn count(&self) -> usize {
        self.slots.len()
    }

    /// What the numbers are.
    #[must_use]
    pub const fn unit(&self) -> SignalUnit {
        self.unit
    }

    /// Whether there is a dummy gauge.
    #[must_use]
    pub const fn has_dummy(&self) -> bool {
        self.dummy.is_some()
    }

    /// These columns, if they are as many as the sensor has gauges.
    ///
    /// # Errors
    /// [`HeaderProblem::WrongSignalCount`].
    pub fn expecting(&self, count: usize) -> Result<&Self, HeaderProblem> {
        if self.count() == count {
            return Ok(self);
        }
        Err(HeaderProblem::WrongSignalCount {
            sensor: of_sensor(&self.name),
            found: self.count(),
            expected: count,
        })
    }

    /// These columns, if they have a dummy gauge.
    ///
    /// # Errors
    /// [`HeaderProblem::NoDummy`].
    pub fn expecting_dummy(&self) -> Result<&Self, HeaderProblem> {
        if self.has_dummy() {
            Ok(self)
        } else {
            Err(HeaderProblem::NoDummy { sensor: of_sensor(&self.name) })
        }
    }
}

/// How errors name a sensor: nothing if it has no name.
pub(super) fn of_sensor(name: &str) -> String {
    if name.is_empty() { String::new() } else { format!(" of sensor {name}") }
}
