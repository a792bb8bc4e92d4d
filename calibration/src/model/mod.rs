//! What is fitted.

mod pairs;
pub use pairs::pairs;
