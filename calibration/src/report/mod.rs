//! What a calibration is worth.

mod contact;
mod contents;
mod creep;
mod curve;
mod exclusion;
mod html;
mod metrics;
mod outliers;
mod plot;
mod predicted;
mod residuals;
mod samples;
mod suspicion;
mod terminal;
mod words;

pub use contact::ContactReport;
pub use contents::Report;
pub use creep::{CreepReport, CycleFigures};
pub use curve::CurveReport;
pub use exclusion::Exclusion;
pub(crate) use metrics::axis_reports;
pub use metrics::{AxisReport, LineReport};
pub(crate) use outliers::outliers_of_fit;
pub use outliers::{Outlier, outliers};
pub use samples::{LeftOut, SampleReport, Samples};
pub use suspicion::{Mistake, Suspicion};
