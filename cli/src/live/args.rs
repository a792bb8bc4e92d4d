//! The command line of `fingertip live`.

use std::path::PathBuf;

use clap::Args;

use super::bridges::BridgeArguments;
use crate::sensor::{self, Address};

#[derive(Debug, Args)]
#[command(after_help = sensor::help())]
#[command(
    long_about = "Watch a sensor, a simulation or a recording in the terminal.\n\nKeys: q or Esc ends, space \
    holds the picture, t takes a new zero over the next second, r forgets the trail and the scale."
)]
pub(crate) struct LiveArguments {
    /// Which sensor: see below; without it the simulated fingertip
    #[arg(value_name = "ADDRESS", default_value = "sim", value_parser = sensor::address, conflicts_with = "replay")]
    pub(crate) address: Address,
    /// Play a recording instead, CSV or MCAP
    #[arg(long, value_name = "FILE")]
    pub(crate) replay: Option<PathBuf>,
    /// How quickly to play it: 1 as recorded, 2 twice as fast
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, requires = "replay")]
    pub(crate) speed: f64,
    /// Which sensor of the recording: the prefix of its columns, or its topic
    #[arg(long, value_name = "NAME", requires = "replay")]
    pub(crate) sensor: Option<String>,
    /// The calibration, for readings of gauges: those of a recording (--replay), or of the simulated fingertip; in the
    /// place of [sensor] of the scene
    #[arg(long, value_name = "CAL.toml")]
    pub(crate) calibration: Option<PathBuf>,
    /// Temperature of the sensor, for a calibration that drifts with it and a recording without column
    /// temperature_C
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true)]
    pub(crate) celsius: Option<f64>,
    /// The scene, for contact and slip: book/src/reference/scene.md; `sim` is that of the simulated fingertip.
    /// Its rest_s gives the zero
    #[arg(long, value_name = "SCENE.toml")]
    pub(crate) scene: Option<PathBuf>,
    /// Take the mean of the first S seconds, in which nothing may touch, as zero; overrides the scene's rest_s
    #[arg(long, value_name = "S")]
    pub(crate) tare: Option<f64>,
    /// Pictures a second; fewer for a slow connection
    #[arg(long, value_name = "HZ", default_value_t = 20.0)]
    pub(crate) frames: f64,
    /// End when a lost sensor falls silent, instead of connecting anew
    #[arg(long)]
    pub(crate) no_reconnect: bool,
    #[command(flatten)]
    pub(crate) bridges: BridgeArguments,
}
