//! What a calibration is worth.

mod contents;
mod html;
mod metrics;
mod outliers;
mod suspicion;
mod terminal;

pub use contents::{Exclusion, Report, SampleReport};
pub use metrics::{AxisReport, LineReport};
pub use outliers::{Outlier, outliers};
pub use suspicion::{Mistake, Suspicion};
