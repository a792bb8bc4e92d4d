//! Known loads: the table that calibrations are fitted to, and its CSV.

mod carrying;
mod columns;
mod merge;
mod table;
mod text;

pub use columns::Columns;
pub use table::{LoadError, LoadTable, Zeros};
pub use text::{LoadReader, LoadRow, Rest, signals_from_csv};
