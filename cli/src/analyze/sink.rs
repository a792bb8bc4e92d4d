//! Where the samples of a recording go.

use fingertip_scene::Felt;

use super::array::Fused;
use super::contacts::ContactWriter;
use crate::error::CliError;
use crate::observe::Status;

/// Takes every sample of a recording, in its order.
pub(super) trait Sink {
    /// What a wrench says, and what an array beside it, if the scene has one; the time is NaN where the recording has none.
    fn sample(&mut self, time: f64, felt: &Felt<f64>, fused: Option<&Fused>) -> Result<(), CliError>;

    /// A sample without a wrench.
    fn without_wrench(&mut self, time: f64, status: Status) -> Result<(), CliError>;
}

impl Sink for ContactWriter {
    #[inline]
    fn sample(&mut self, time: f64, felt: &Felt<f64>, fused: Option<&Fused>) -> Result<(), CliError> {
        self.write(time, felt, fused)
    }

    fn without_wrench(&mut self, time: f64, status: Status) -> Result<(), CliError> {
        self.write_without_wrench(time, status)
    }
}
