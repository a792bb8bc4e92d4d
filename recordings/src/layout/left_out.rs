//! Columns that are of no use.

use crate::error::HeaderProblem;

/// Columns that look like a sensor's but cannot be used, and why.
///
/// ```
/// use fingertip_recordings::{AssumedUnits, HeaderProblem, Layout};
///
/// // The left sensor gives its torques, the right one forgot one.
/// let header = [
///     "left_fx_N", "left_fy_N", "left_fz_N", "left_tx_Nm", "left_ty_Nm", "left_tz_Nm", //
///     "right_fx_N", "right_fy_N", "right_fz_N", "right_tx_Nm", "right_ty_Nm",
/// ];
/// let layout = Layout::from_header(&header, AssumedUnits::default())?;
/// let left_out = &layout.left_out()[0];
/// assert_eq!(left_out.sensor, "right");
/// assert!(matches!(&left_out.problem, HeaderProblem::MissingAxis { missing, .. } if missing == "tz"));
/// # Ok::<(), HeaderProblem>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Name of the sensor; empty if it has none.
    pub sensor: String,
    /// Why its columns cannot be used.
    pub problem: HeaderProblem,
}
