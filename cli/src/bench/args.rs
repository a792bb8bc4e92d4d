//! The command line of `fingertip bench`, and what `fingertip design` has of it.

use std::path::PathBuf;

use clap::Args;
use fingertip_calibration::bench::Foil;
use fingertip_calibration::design::Placement;

use crate::output::Overwrite;

#[derive(Debug, Args)]
pub(crate) struct BenchArguments {
    /// The layout, as `fingertip design` writes it; bridges can be written into it by hand
    #[arg(value_name = "LAYOUT.toml")]
    pub(super) layout: PathBuf,
    /// Radius of the spherical fingertip, for the drawing
    #[arg(long, value_name = "MM")]
    pub(super) tip_radius_mm: Option<f64>,
    #[command(flatten)]
    pub(super) parts: Parts,
    #[command(flatten)]
    pub(super) files: BenchFiles,
    #[command(flatten)]
    pub(super) overwrite: Overwrite,
}

/// The gauges that are glued, how well, and what reads them.
#[derive(Clone, Debug, Args)]
pub(crate) struct Parts {
    /// Grid of a gauge, along and across what it feels
    #[arg(long, num_args = 2, value_names = ["ALONG", "ACROSS"], default_values_t = [1.5, 1.2])]
    grid_mm: Vec<f64>,
    /// Carrier of a gauge, along and across
    #[arg(long, num_args = 2, value_names = ["ALONG", "ACROSS"], default_values_t = [4.0, 2.5])]
    carrier_mm: Vec<f64>,
    /// Resistance of a gauge
    #[arg(long, value_name = "OHM", default_value_t = 350.0)]
    gauge_ohm: f64,
    /// Standard deviation of the angle of a glued gauge
    #[arg(long, value_name = "DEG", default_value_t = 0.5)]
    angle_tolerance_deg: f64,
    /// Standard deviation of the place of a glued gauge
    #[arg(long, value_name = "MM", default_value_t = 0.05)]
    position_tolerance_mm: f64,
    /// Thickness of the paper of the template, which is wrapped around the tube
    #[arg(long, value_name = "MM", default_value_t = 0.1)]
    pub(super) paper_mm: f64,
    /// What a bridge may be out of balance by at rest
    #[arg(long, value_name = "mV/V", default_value_t = 2.0)]
    pub(super) imbalance: f64,
    /// Samples a second that the converter shall give
    #[arg(long, value_name = "HZ", default_value_t = 200.0)]
    pub(super) sample_rate: f64,
}

/// What is written.
#[derive(Clone, Debug, Args)]
pub(crate) struct BenchFiles {
    /// Where to write the template of the unrolled tube, at 1:1
    #[arg(long, value_name = "FILE", default_value = "template.svg")]
    pub(super) template: PathBuf,
    /// Where to write what one needs at the bench: template, places, drawing, wiring, converters
    #[arg(long, value_name = "FILE", default_value = "bench.pdf")]
    pub(super) pages: PathBuf,
}

impl BenchFiles {
    pub(crate) fn paths(&self) -> [&PathBuf; 2] {
        [&self.template, &self.pages]
    }
}

impl Parts {
    pub(crate) fn foil(&self) -> Foil {
        let pair = |lengths: &[f64]| match lengths {
            [along, across] => [along * 1e-3, across * 1e-3],
            _ => [f64::NAN; 2],
        };
        Foil { grid: pair(&self.grid_mm), carrier: pair(&self.carrier_mm), resistance: self.gauge_ohm }
    }

    pub(crate) fn placement(&self) -> Placement {
        Placement {
            angle: self.angle_tolerance_deg.to_radians(),
            position: self.position_tolerance_mm * 1e-3,
        }
    }
}
