//! Known loads: the table that calibrations are fitted to, and its CSV.

mod merge;
mod table;
mod text;

pub use table::{LoadError, LoadTable};
pub use text::signals_from_csv;
