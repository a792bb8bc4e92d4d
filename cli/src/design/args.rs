//! The command line of `fingertip design`.

use std::path::PathBuf;

use clap::builder::RangedU64ValueParser;
use clap::{Args, ValueEnum};
use fingertip_calibration::design::Material;
use thiserror::Error;

use crate::bench::args::{BenchFiles, Parts};
use crate::output::Overwrite;

/// Families of layouts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum LayoutFamily {
    /// The six gauges of Bicchi & Dario 1987, with radius, angle and distance free
    Paper,
    /// Pairs of gauges at plus and minus one angle, equally spaced in one ring
    Rosettes,
    /// Every gauge free, on a tube of the greatest radius
    Free,
}

/// What to make small.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CriterionName {
    /// N_c, the ratio of the singular values, as the paper does
    ConditionNumber,
    /// The rms error of the contact position over the fingertip
    ContactError,
    /// The noise of the worst of the six components
    WorstAxis,
    /// The noise of all components together
    Trace,
    /// The volume of the error ellipsoid
    LogDeterminant,
}

#[derive(Debug, Args)]
pub(crate) struct DesignArguments {
    /// Range of the force on every axis, in newtons
    #[arg(long, value_name = "N", default_value_t = 30.0)]
    pub(crate) force: f64,
    /// Range of the torque about every axis, in newton metres
    #[arg(long, value_name = "N·m", default_value_t = 0.3)]
    pub(crate) torque: f64,
    /// Radius of the spherical fingertip
    #[arg(long, value_name = "MM", default_value_t = 13.0)]
    pub(crate) tip_radius_mm: f64,
    /// Least and greatest mean radius of the tube
    #[arg(long, num_args = 2, value_names = ["MIN", "MAX"], default_values_t = [4.0, 10.0])]
    pub(crate) radius_mm: Vec<f64>,
    /// Where the tube is clamped, behind the centre of the tip
    #[arg(long, value_name = "MM", default_value_t = 20.0)]
    pub(crate) length_mm: f64,
    /// Family of layouts
    #[arg(long, value_enum, default_value_t = LayoutFamily::Rosettes)]
    pub(crate) layout: LayoutFamily,
    /// Number of gauges (even for rosettes; the paper's layout has six)
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = RangedU64ValueParser::<usize>::new().range(..=64))]
    pub(crate) gauges: usize,
    /// What to make small
    #[arg(long, value_enum, default_value_t = CriterionName::ConditionNumber)]
    pub(crate) criterion: CriterionName,
    /// Material: aluminium-7075-t6, aluminium-6061-t6, titanium-6al-4v or steel-17-4-ph
    #[arg(long, value_name = "NAME", default_value = "aluminium-7075-t6", value_parser = material)]
    pub(crate) material: Material,
    /// Failing load over full load; the wall is as thin as that allows
    #[arg(long, value_name = "RATIO", default_value_t = 3.0, conflicts_with = "wall_mm")]
    pub(crate) safety: f64,
    /// Thickness of the wall, instead of the thinnest that is safe
    #[arg(long, value_name = "MM")]
    pub(crate) wall_mm: Option<f64>,
    /// Noise of a channel, in µm/m of strain
    #[arg(long, value_name = "µm/m", default_value_t = 1.0)]
    pub(crate) noise_microstrain: f64,
    /// Friction ratio up to which touches are expected
    #[arg(long, value_name = "RATIO", default_value_t = 0.5)]
    pub(crate) friction: f64,
    #[command(flatten)]
    pub(crate) parts: Parts,
    /// Supply of the bridges
    #[arg(long, value_name = "V", default_value_t = 5.0)]
    pub(crate) supply: f64,
    /// Gauge factor: about 2 for metal foil
    #[arg(long, value_name = "K", default_value_t = 2.0)]
    pub(crate) gauge_factor: f64,
    /// Gain of the amplifiers
    #[arg(long, value_name = "GAIN", default_value_t = 500.0)]
    pub(crate) gain: f64,
    /// Random starts of the search
    #[arg(long, value_name = "N", default_value_t = 40)]
    pub(crate) starts: usize,
    /// Seed: the same seed gives the same design
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seed: u64,
    /// Where to write the layout
    #[arg(long, value_name = "FILE", default_value = "layout.toml")]
    pub(crate) out: PathBuf,
    /// Where to write the calibration that a perfect specimen would have
    #[arg(long, value_name = "FILE")]
    pub(crate) calibration: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) files: BenchFiles,
    /// Where to write the report
    #[arg(long, value_name = "FILE", default_value = "design.html")]
    pub(crate) report: PathBuf,
    #[command(flatten)]
    pub(crate) overwrite: Overwrite,
}

fn material(name: &str) -> Result<Material, UnknownMaterial> {
    Material::from_name(name).ok_or(UnknownMaterial)
}

/// A material without a name here.
#[derive(Debug, Error)]
#[error("known are {}", Material::NAMED.map(|(name, _)| name).join(", "))]
struct UnknownMaterial;
