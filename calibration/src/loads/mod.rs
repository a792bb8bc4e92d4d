//! Known loads: the table that calibrations are fitted to, and its CSV.

mod carrying;
mod merge;
mod table;
mod text;

pub use table::{LoadError, LoadTable};
pub use text::{Rest, signals_from_csv};
