#![doc = include_str!("../README.md")]

#[cfg(any(feature = "health", feature = "mcap"))]
extern crate alloc;

mod bounded;
mod cell;
mod column_name;
mod columns;
mod error;
#[cfg(feature = "health")]
pub mod health;
mod layout;
#[cfg(feature = "mcap")]
pub mod mcap;
mod options;
mod plain;
mod quality;
mod reader;
mod record;
mod row;
mod row_block;
mod shortened;
mod start;
mod table;
mod time_watch;
mod timing;
mod unit;
mod writer;

pub use column_name::{ColumnMeaning, ColumnName};
pub use columns::{
    ContactCells, ContactColumns, InertialColumns, NumberColumn, SignalColumns, WrenchColumns,
};
pub use error::{HeaderProblem, RecordingError};
pub use fingertip_wrench::units::{ForceUnit, TorqueUnit};
pub use layout::{Layout, LeftOut};
pub use options::{AssumedUnits, ReaderOptions, RenamedColumn};
pub use quality::{FaultCount, Quality};
pub use reader::RecordingReader;
pub use row::{Row, RowMarks};
pub use row_block::RowBlock;
pub use table::TableReader;
pub use timing::Timing;
pub use unit::{SignalUnit, acceleration_unit, turning_unit};
pub use writer::{RecordingWriter, Schema};
