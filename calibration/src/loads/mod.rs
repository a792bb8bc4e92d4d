//! Known loads: the table that calibrations are fitted to, and its CSV.

mod carrying;
mod columns;
mod header;
mod merge;
mod names;
mod plausible;
mod reader;
mod rest;
mod spread;
mod table;
mod text;

pub use columns::Columns;
pub use names::Names;
pub use reader::{LoadReader, LoadRow};
pub use rest::{Rest, signals_from_csv};
pub(crate) use spread::spread;
pub use table::{LoadError, LoadTable, Zeros};
pub(crate) use text::same_loads;
