//! The columns that belong to one sensor.

use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use crate::error::HeaderProblem;
use crate::unit::SignalUnit;

/// The six columns of a wrench. Found by a [`Layout`](crate::Layout), used on its rows.
#[derive(Clone, Debug, PartialEq)]
pub struct WrenchColumns {
    pub(super) name: String,
    pub(super) slots: [usize; 6],
}

/// The columns of the signals of one sensor. Found by a [`Layout`](crate::Layout), used on its rows.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalColumns {
    pub(super) name: String,
    pub(super) unit: SignalUnit,
    pub(super) slots: Vec<usize>,
    pub(super) dummy: Option<usize>,
}

/// A column of plain numbers, such as a temperature or a part of an orientation. Found by
/// [`RecordingReader::watch`](crate::RecordingReader::watch), used on its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NumberColumn {
    pub(super) slot: usize,
}

/// The columns of an inertial unit. Found by
/// [`RecordingReader::watch_inertial_unit`](crate::RecordingReader::watch_inertial_unit), used on its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InertialColumns {
    pub(super) slots: [usize; 6],
}

/// The columns of the contacts. Found by a [`Layout`](crate::Layout), used on its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContactColumns {
    pub(super) slots: [usize; CONTACT_COLUMNS.len()],
}

/// Names of the columns of a contact. In a row without contact their cells are empty.
pub(super) const CONTACT_COLUMNS: [&str; 12] = [
    "contact_x_m",
    "contact_y_m",
    "contact_z_m",
    "contact_nx",
    "contact_ny",
    "contact_nz",
    "contact_load_x_N",
    "contact_load_y_N",
    "contact_load_z_N",
    "contact_spin_x_Nm",
    "contact_spin_y_Nm",
    "contact_spin_z_Nm",
];

/// A contact in a row of a recording, in the frame of the sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactCells {
    /// The contact point \[m\].
    pub position: Vector3<f64>,
    /// The outward normal.
    pub normal: Vector3<f64>,
    /// The load at the contact point: its force, and the spin torque as a vector.
    pub wrench: Wrench<f64>,
}

impl ContactCells {
    /// The numbers in the order of the columns.
    #[must_use]
    pub fn cells(&self) -> [f64; 12] {
        let Self { position, normal, wrench } = self;
        let (mut cells, load) = ([0.0; 12], wrench.components());
        let numbers = position.iter().chain(normal).chain(load.iter()).copied();
        for (cell, number) in cells.iter_mut().zip(numbers) {
            *cell = number;
        }
        cells
    }

    pub(super) fn from_cells(cells: [f64; 12]) -> Option<Self> {
        if !cells.iter().all(|cell| cell.is_finite()) {
            return None;
        }
        let [x, y, z, nx, ny, nz, wrench @ ..] = cells;
        let (position, normal) = (Vector3::new(x, y, z), Vector3::new(nx, ny, nz));
        Some(Self { position, normal, wrench: Wrench::from_components(&wrench.into()) })
    }
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
