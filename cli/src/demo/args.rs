//! The command line of `demo`.

use std::path::PathBuf;

use clap::Args;

use crate::output::Overwrite;

#[derive(Debug, Args)]
pub(crate) struct DemoArguments {
    /// Where to write the report
    #[arg(long, value_name = "FILE", default_value = "report.html")]
    pub(crate) out: PathBuf,
    /// Seed of the noise: the same seed gives the same report
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Simulate a hand of three fingertips that lifts, tilts, fills and hands over a jar
    #[arg(long, conflicts_with_all = ["recording", "calibration"])]
    pub(crate) hand: bool,
    /// Also write the simulated volts, a recording to try `analyze` on
    #[arg(long, value_name = "FILE")]
    pub(crate) recording: Option<PathBuf>,
    /// Also write the simulated sensor's calibration
    #[arg(long, value_name = "FILE")]
    pub(crate) calibration: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overwrite: Overwrite,
}
