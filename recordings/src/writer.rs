//! Writes a recording in our schema.

use core::fmt;
use std::io::Write;

use fingertip_wrench::Wrench;

use crate::columns::CONTACT_COLUMNS;
use crate::error::RecordingError;
use crate::layout::FRAME_OF;
use crate::unit::SignalUnit;

/// The columns of a recording to write, in SI units.
///
/// ```
/// use fingertip_recordings::{Schema, SignalUnit};
///
/// let schema = Schema::default().time().signals("", 6, SignalUnit::Volt).dummy("", SignalUnit::Volt);
/// assert_eq!(schema.names().join(","), "t_s,v1_V,v2_V,v3_V,v4_V,v5_V,v6_V,dummy_V");
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[must_use]
pub struct Schema {
    names: Vec<String>,
    frames: Vec<String>,
}

impl Schema {
    /// Adds the time \[s\].
    pub fn time(self) -> Self {
        self.column("t_s")
    }

    /// Adds the six columns of a wrench \[N, N·m\] of a sensor; an empty name for the only one.
    pub fn wrench(mut self, sensor: &str) -> Self {
        for axis in ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"] {
            self = self.column(&prefixed(sensor, axis));
        }
        self
    }

    /// Adds `count` signals of a sensor, numbered from 1.
    pub fn signals(mut self, sensor: &str, count: usize, unit: SignalUnit) -> Self {
        for number in 1..=count {
            self = self.column(&prefixed(sensor, &format!("v{number}{}", unit.suffix())));
        }
        self
    }

    /// Adds the dummy gauge of a sensor.
    pub fn dummy(self, sensor: &str, unit: SignalUnit) -> Self {
        self.column(&prefixed(sensor, &format!("dummy{}", unit.suffix())))
    }

    /// Adds the columns of a contact: write [`ContactCells::cells`](crate::ContactCells::cells), or NaN
    /// where there is none.
    pub fn contact(self) -> Self {
        CONTACT_COLUMNS.into_iter().fold(self, |schema, name| schema.column(name))
    }

    /// Adds a column of another meaning, with the unit in its name; commas, quotes and line ends
    /// become underscores.
    pub fn column(mut self, name: &str) -> Self {
        self.names.push(name.replace([',', ';', '"', '\n', '\r', '\t'], "_"));
        self
    }

    /// Names the frame of a sensor, in a comment above the header; names with control characters are left out.
    pub fn frame(mut self, sensor: &str, frame: &str) -> Self {
        if !frame.chars().chain(sensor.chars()).any(char::is_control) {
            let of = if sensor.is_empty() { String::new() } else { format!(" of {sensor}") };
            self.frames.push(format!("# {FRAME_OF}{of}: {frame}\n"));
        }
        self
    }

    /// The names of the columns.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }
}

fn prefixed(sensor: &str, name: &str) -> String {
    if sensor.is_empty() { name.to_owned() } else { format!("{sensor}_{name}") }
}

/// Writes rows of numbers under a header. Numbers are written with as many digits as it takes to
/// read them back exactly.
///
/// ```
/// use fingertip_recordings::{RecordingWriter, Schema};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let mut writer = RecordingWriter::new(Vec::new(), &Schema::default().time().wrench(""))?;
/// let load = Wrench::on_fingertip(Vector3::new(0.3, 0.0, -2.0), Vector3::zeros());
/// writer.write_wrench(0.001, &load)?;
/// writer.write([0.002, 0.0, 0.0, f64::NAN, 0.0, 0.0, 0.0])?; // a number is missing
/// let file = String::from_utf8(writer.finish()?)?;
/// let expected = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n0.001,0.3,0.0,-2.0,0.0,0.0,0.0\n0.002,0.0,0.0,,0.0,0.0,0.0\n";
/// assert_eq!(file, expected);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct RecordingWriter<W> {
    out: W,
    columns: usize,
    line: String,
    digits: ryu::Buffer,
}

impl<W> fmt::Debug for RecordingWriter<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RecordingWriter").field("columns", &self.columns).finish_non_exhaustive()
    }
}

impl<W: Write> RecordingWriter<W> {
    /// Writes the header. Put a [`std::io::BufWriter`] around a file.
    ///
    /// # Errors
    /// [`RecordingError::Write`].
    pub fn new(mut out: W, schema: &Schema) -> Result<Self, RecordingError> {
        writeln!(out, "{}{}", schema.frames.concat(), schema.names.join(",")).map_err(failed)?;
        Ok(Self { out, columns: schema.names.len(), line: String::new(), digits: ryu::Buffer::new() })
    }

    /// Writes one row: one number for every column, in the order of the schema. NaN stands for a
    /// missing one and leaves its cell empty; infinities are written as `inf`.
    ///
    /// # Errors
    /// [`RecordingError::WrongRow`] if there are too few or too many numbers, otherwise
    /// [`RecordingError::Write`].
    pub fn write(&mut self, values: impl IntoIterator<Item = f64>) -> Result<(), RecordingError> {
        self.line.clear();
        let mut found = 0;
        for value in values {
            if found > 0 {
                self.line.push(',');
            }
            found += 1;
            if !value.is_nan() {
                // The shortest number that reads back exactly, with an exponent where it is very
                // large or small.
                self.line.push_str(self.digits.format(value));
            }
        }
        if found != self.columns {
            return Err(RecordingError::WrongRow { expected: self.columns, found });
        }
        self.line.push('\n');
        self.out.write_all(self.line.as_bytes()).map_err(failed)
    }

    /// Writes a row of a recording with the schema time, one wrench.
    ///
    /// # Errors
    /// As [`write`](Self::write).
    pub fn write_wrench(&mut self, time: f64, wrench: &Wrench<f64>) -> Result<(), RecordingError> {
        self.write(core::iter::once(time).chain(wrench.components().iter().copied()))
    }

    /// What is written to.
    #[must_use]
    pub const fn get_mut(&mut self) -> &mut W {
        &mut self.out
    }

    /// Writes out what is buffered, and gives the output back.
    ///
    /// # Errors
    /// [`RecordingError::Write`].
    pub fn finish(mut self) -> Result<W, RecordingError> {
        self.out.flush().map_err(failed)?;
        Ok(self.out)
    }
}

fn failed(source: std::io::Error) -> RecordingError {
    RecordingError::Write { source }
}
