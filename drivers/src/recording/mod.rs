//! Recordings in files: CSV with a header that names each column and its unit.
//!
//! # The schema
//!
//! | column | meaning | units understood |
//! |---|---|---|
//! | `t_s` | time | `s`, `ms`, `us`, `ns`, `min` |
//! | `fx_N` … `fz_N` | force | `N`, `mN`, `kN`, `lbf`, `klbf`, `ozf`, `gf`, `kgf` |
//! | `tx_Nm` … `tz_Nm` (or `mx` …) | torque | `Nm`, `Nmm`, `mNm`, `Ncm`, `kNm`, `lbf-in`, `lbf-ft`, `kgf-m`, `kgf-cm`, `gf-cm` |
//! | `v1_V` … `vN_V` (or `v0`, `s1`, `ch1`, `gauge1`) | signals | `V`, `mV`, `uV`, `counts` (`raw`, `lsb`, `adc`); none: taken as they are |
//! | `dummy_V` | the unloaded seventh gauge | as signals |
//!
//! Case does not matter, and `fx (N)`, `Fx[N]`, `force_x_N` are read as `fx_N`. What else stands in
//! a name tells sensors apart: `S1_Fx_N`, `S2_Fx_N`, `Fx_meas_N` belong to the sensors `s1`, `s2`
//! and `meas`. Everything is given in SI. A force or torque without a unit is never guessed.
//!
//! Lines that start with `#`, a byte-order mark, Windows line ends, quoted cells and empty lines
//! are allowed. Columns are separated by commas, or by semicolons or tabs where the header has no
//! comma.
//!
//! ```
//! use fingertip_drivers::recording::RecordingReader;
//!
//! let file = "t_s,Fx_N,Fy_N,Fz_N,Tx_Nmm,Ty_Nmm,Tz_Nmm\n0.000,0,0,-2,0,0,0\n0.001,0,0,,0,0,0\n";
//! let mut reader = RecordingReader::new("example.csv", file.as_bytes())?;
//! let sensor = reader.layout().only_wrench()?.clone();
//! let row = reader.next_row()?.ok_or("no row")?;
//! assert_eq!(row.wrench(&sensor).map(|wrench| wrench.force().z), Some(-2.0));
//! // The second row lacks a number: it is given, marked, without a wrench, and counted.
//! let row = reader.next_row()?.ok_or("no row")?;
//! assert_eq!((row.line(), row.wrench(&sensor)), (3, None));
//! assert_eq!(reader.quality().empty_cells.count(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bounded;
mod cell;
mod column_name;
mod columns;
mod error;
mod layout;
#[cfg(feature = "mcap")]
pub mod mcap;
mod playback;
mod quality;
mod reader;
mod row;
mod start;
mod time_watch;
mod unit;
mod writer;

pub use columns::{NumberColumn, SignalColumns, WrenchColumns};
pub use error::{HeaderProblem, RecordingError};
pub use fingertip_wrench::units::{ForceUnit, TorqueUnit};
pub use layout::{AssumedUnits, Layout, LeftOut};
pub use playback::{SignalPlayback, WrenchPlayback};
pub use quality::{FaultCount, Quality};
pub use reader::{ReaderOptions, RecordingReader};
pub use row::{Row, RowMarks};
pub use unit::SignalUnit;
pub use writer::{RecordingWriter, Schema};
