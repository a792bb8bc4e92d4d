//! Known loads: the table that calibrations are fitted to, and its CSV.

mod table;
mod text;

pub use table::{LoadError, LoadTable};
