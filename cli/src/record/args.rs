//! The command line of `fingertip record`.

use std::path::PathBuf;

use clap::Args;

use crate::output::Overwrite;
use crate::recording_file::Packing;
use crate::sensor::{self, Address};

#[derive(Debug, Args)]
#[command(after_help = sensor::help())]
pub(crate) struct RecordArguments {
    /// Which sensor: see below; without it the simulated fingertip
    #[arg(value_name = "ADDRESS", default_value = "sim", value_parser = sensor::address)]
    pub(crate) address: Address,
    /// The file to write; its ending says what: .csv or .mcap (ROS 2 messages, for Foxglove and PlotJuggler)
    #[arg(short, long, value_name = "FILE", default_value = "recording.csv")]
    pub(crate) output: PathBuf,
    /// How to pack an MCAP file
    #[arg(long, value_enum, default_value_t = Packing::None)]
    pub(crate) compression: Packing,
    #[command(flatten)]
    pub(crate) overwrite: Overwrite,
    /// As --overwrite
    #[arg(long, hide = true)]
    pub(crate) force: bool,
    /// End after so many seconds of samples
    #[arg(long, value_name = "S")]
    pub(crate) duration: Option<f64>,
    /// End after so many samples
    #[arg(long, value_name = "N")]
    pub(crate) samples: Option<u64>,
    /// Take the mean of the first S seconds, in which nothing may touch, off all wrenches that are recorded;
    /// those seconds are not. Without it wrenches are recorded as the sensor gives them
    #[arg(long, value_name = "S")]
    pub(crate) tare: Option<f64>,
    /// A scene, so that contacts are recorded too (`sim` is that of the simulated fingertip); its rest_s gives their zero, unless there is --tare
    #[arg(long, value_name = "SCENE.toml")]
    pub(crate) scene: Option<PathBuf>,
    /// Times are those of the day (seconds since 1970), not since the first sample
    #[arg(long)]
    pub(crate) unix_time: bool,
    /// Connect anew when the sensor falls silent; without it the recording ends there
    #[arg(long)]
    pub(crate) reconnect: bool,
    /// How long a sensor may be silent before it is lost
    #[arg(long, value_name = "S", default_value_t = 3.0)]
    pub(crate) silence: f64,
}
