//! Known loads: the table that calibrations are fitted to, and its CSV.

mod carrying;
mod columns;
mod header;
mod merge;
mod plausible;
mod reader;
mod rest;
mod table;
mod text;

pub use columns::Columns;
pub use reader::{LoadReader, LoadRow};
pub use rest::{Rest, signals_from_csv};
pub use table::{LoadError, LoadTable, Zeros};
