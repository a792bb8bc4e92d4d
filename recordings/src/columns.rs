//! The columns that belong to one sensor.

use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use crate::error::HeaderProblem;
use crate::unit::SignalUnit;

/// The six columns of a wrench. Found by a [`Layout`](crate::Layout), used on its rows.
///
/// ```
/// use fingertip_recordings::RecordingReader;
///
/// let file = "left_fx_N,left_fy_N,left_fz_N,left_tx_Nmm,left_ty_Nmm,left_tz_Nmm\n0,0,-2,0,0,5\n";
/// let mut reader = RecordingReader::new("hand.csv", file.as_bytes())?;
/// let left = reader.layout().wrench("left")?.clone();
/// assert_eq!(left.name(), "left");
/// let wrench = reader.next_row()?.and_then(|row| row.wrench(&left)).ok_or("no wrench")?;
/// assert_eq!(wrench.torque().z, 0.005); // newton metres
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct WrenchColumns {
    pub(super) name: String,
    pub(super) slots: [usize; 6],
}

/// The columns of the signals of one sensor. Found by a [`Layout`](crate::Layout), used on its rows.
///
/// ```
/// use fingertip_recordings::{RecordingReader, SignalUnit};
/// use nalgebra::Vector2;
///
/// let file = "t_s,v1_mV,v2_mV,dummy_mV\n0.0,250,-500,20\n";
/// let mut reader = RecordingReader::new("gauges.csv", file.as_bytes())?;
/// let gauges = reader.layout().only_signals()?.expecting(2)?.expecting_dummy()?.clone();
/// assert_eq!((gauges.count(), gauges.unit()), (2, SignalUnit::Volt));
/// let row = reader.next_row()?.ok_or("no row")?;
/// assert_eq!(row.signals::<2>(&gauges), Some(Vector2::new(0.25, -0.5)));
/// assert_eq!(row.dummy(&gauges), Some(0.02));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SignalColumns {
    pub(super) name: String,
    pub(super) unit: SignalUnit,
    pub(super) slots: Vec<usize>,
    pub(super) dummy: Option<usize>,
}

/// A column of plain numbers, such as a temperature or a part of an orientation. Found by
/// [`RecordingReader::watch`](crate::RecordingReader::watch), used on its rows.
///
/// ```
/// use fingertip_recordings::RecordingReader;
///
/// let file = "t_s,v1_V,temperature_C\n0.0,0.25,21.5\n";
/// let mut reader = RecordingReader::new("warm.csv", file.as_bytes())?;
/// let temperature = reader.watch("temperature_C").ok_or("no such column")?;
/// let row = reader.next_row()?.ok_or("no row")?;
/// assert_eq!(row.number(&temperature), Some(21.5));
/// assert_eq!(reader.watch("humidity"), None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NumberColumn {
    pub(super) slot: usize,
}

/// The columns of an inertial unit. Found by
/// [`RecordingReader::watch_inertial_unit`](crate::RecordingReader::watch_inertial_unit), used on its rows.
///
/// ```
/// use fingertip_recordings::RecordingReader;
/// use nalgebra::Vector3;
///
/// let file = "v1_V,ax_g,ay_g,az_g,wx_deg_per_s,wy_deg_per_s,wz_deg_per_s\n0.25,0,0,1,0,0,180\n";
/// let mut reader = RecordingReader::new("arm.csv", file.as_bytes())?;
/// let unit = reader.watch_inertial_unit("")?;
/// let reading = reader.next_row()?.and_then(|row| row.inertial(&unit)).ok_or("no reading")?;
/// assert_eq!(reading.acceleration, Vector3::new(0.0, 0.0, 9.80665));
/// assert!((reading.angular_velocity.z - std::f64::consts::PI).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InertialColumns {
    pub(super) slots: [usize; 6],
}

/// The columns of the contacts. Found by a [`Layout`](crate::Layout), used on its rows.
///
/// ```
/// use fingertip_recordings::{ContactCells, RecordingReader, RecordingWriter, Schema};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // A contact at the top of a ball of 13 mm, and a row without one.
/// let pressed = ContactCells {
///     position: Vector3::new(0.0, 0.0, 0.013),
///     normal: Vector3::z(),
///     wrench: Wrench::on_fingertip(Vector3::new(0.3, 0.0, -2.0), Vector3::zeros()),
/// };
/// let schema = Schema::default().time().signals("", 1, fingertip_recordings::SignalUnit::Volt).contact();
/// let mut writer = RecordingWriter::new(Vec::new(), &schema)?;
/// writer.write([0.0, 0.25].into_iter().chain(pressed.cells()))?;
/// writer.write([0.001, 0.0].into_iter().chain([f64::NAN; 12]))?;
///
/// let file = writer.finish()?;
/// let mut reader = RecordingReader::new("contacts.csv", &file[..])?;
/// let contacts = *reader.layout().contacts().ok_or("no contacts")?;
/// assert_eq!(reader.next_row()?.and_then(|row| row.contact(&contacts)), Some(pressed));
/// assert_eq!(reader.next_row()?.and_then(|row| row.contact(&contacts)), None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
///
/// ```
/// use fingertip_recordings::ContactCells;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let contact = ContactCells {
///     position: Vector3::new(0.0, 0.0, 0.013),
///     normal: Vector3::z(),
///     wrench: Wrench::on_fingertip(Vector3::new(0.3, 0.0, -2.0), Vector3::new(0.0, 0.0, 0.001)),
/// };
/// assert_eq!(contact.cells(), [0.0, 0.0, 0.013, 0.0, 0.0, 1.0, 0.3, 0.0, -2.0, 0.0, 0.0, 0.001]);
/// ```
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
