//! What a row of a recording holds of one sensor, be it wrenches or volts.

use fingertip::wrench::{TareError, Wrench};
use fingertip_recordings::Row;
use fingertip_scene::Doubt;
use nalgebra::Vector6;

use crate::observe::Status;

/// What a row of a recording holds of one sensor.
pub(super) trait Recorded {
    /// Name of the sensor; empty if the recording gives none.
    fn sensor(&self) -> &str;

    /// The load as recorded, less the zero, or why there is none; and the time since the last that was read \[s\].
    fn read(&mut self, row: &Row<'_>, time_step: f64) -> Result<Wrench<f64>, Status>;

    /// Takes a row of the rest: [`Status::Rest`], or why it cannot be used.
    fn rest(&mut self, row: &Row<'_>) -> Status;

    /// The mean of the rest is the zero from now on.
    fn end_rest(&mut self) -> Result<(), TareError>;

    /// Standard deviation of each component of the wrench in the rest \[N, N·m\].
    fn noise(&self) -> Option<Vector6<f64>>;

    /// Why the rest may not have been one.
    fn doubt(&self) -> Option<Doubt>;
}
