//! What a calibration is worth.

mod contact;
mod contents;
mod curve;
mod html;
mod metrics;
mod outliers;
mod plot;
mod predicted;
mod residuals;
mod suspicion;
mod terminal;
mod words;

pub use contact::ContactReport;
pub use contents::{Exclusion, Report, SampleReport};
pub use curve::CurveReport;
pub use metrics::{AxisReport, LineReport};
pub use outliers::{Outlier, outliers};
pub use suspicion::{Mistake, Suspicion};
