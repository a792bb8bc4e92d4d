//! How the sensor that is built differs from the one that was drawn, and its calibration from it.

use fingertip_wrench::SensorMatrix;
use fingertip_wrench::gauge_layout::GaugeLayout;
use nalgebra::SMatrix;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use crate::design::Design;
use crate::electronics::Electronics;
use crate::error::{SimulationError, not_negative};
use crate::thermal_drift::ThermalDrift;

/// Standard deviations of what goes wrong when gauges are glued and when the sensor is calibrated.
///
/// Gluing under a microscope: 0.1 mm along the beam, 1° around it (0.09 mm on a radius of 5 mm), 1°
/// of gauge angle; gauge factor with amplifier 0.5 % (what makers state for a lot). Bridges are
/// trimmed to 30 µV, 2.4 % of full scale.
///
/// A calibration takes gluing and gains out again, but for its own errors. Its loads share one scale,
/// that of the reference (spring balance or load cell): `calibration_scale`, whose sign the seed
/// draws. Each entry of the matrix has an error of its own from reading and placing the loads:
/// `calibration_entry`, a share of the row's largest entry under nominal loads. 2 % and 0.1 % give
/// the paper's 2 % in force. That its errors of *position* stay below 0.1 mm at 10 N, where an
/// independent error of 2 % would give 0.2 mm, shows that most of the 2 % is common to all entries.
///
/// ```
/// use fingertip_simulation::{Imperfections, Options, Script, SimulatedFingertip};
///
/// let matrices = |imperfections| {
///     let options = Options { imperfections, ..Options::default() };
///     let fingertip = SimulatedFingertip::new(&Script::default().rest(0.1), options)?;
///     Ok::<_, fingertip_simulation::SimulationError>((*fingertip.calibrated_matrix(), *fingertip.true_matrix()))
/// };
/// // Without any, the calibration is right; as it is by default, it is off by about 2 %.
/// let (calibrated, exact) = matrices(Imperfections::none())?;
/// assert_eq!(calibrated, exact);
/// let (calibrated, exact) = matrices(Imperfections::default())?;
/// assert_ne!(calibrated, exact);
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Imperfections {
    /// Of a gauge along the beam \[m\].
    pub axial_placement: f64,
    /// Of a gauge around the beam \[rad\].
    pub circumferential_placement: f64,
    /// Of a gauge's angle \[rad\].
    pub angle: f64,
    /// Of a channel's gain, relative.
    pub gain: f64,
    /// Of a bridge's unbalance \[V\].
    pub unbalance: f64,
    /// The error of the calibration that all entries share, relative.
    pub calibration_scale: f64,
    /// The error of each entry of the calibrated matrix, relative to the largest of its row.
    pub calibration_entry: f64,
}

impl Default for Imperfections {
    fn default() -> Self {
        Self {
            axial_placement: 0.1e-3,
            circumferential_placement: 1_f64.to_radians(),
            angle: 1_f64.to_radians(),
            gain: 5e-3,
            unbalance: 30e-6,
            calibration_scale: 0.02,
            calibration_entry: 0.001,
        }
    }
}

impl Imperfections {
    /// A sensor exactly as drawn, with an exact calibration.
    #[must_use]
    pub const fn none() -> Self {
        Self {
            axial_placement: 0.0,
            circumferential_placement: 0.0,
            angle: 0.0,
            gain: 0.0,
            unbalance: 0.0,
            calibration_scale: 0.0,
            calibration_entry: 0.0,
        }
    }
}

/// The sensor that was built.
#[derive(Clone, Debug)]
pub(super) struct BuiltSensor {
    /// Strain per newton and newton metre of the gauges where they are.
    pub(super) strains: SMatrix<f64, 6, 6>,
    /// Gain of each channel, relative; the dummy gauge last.
    pub(super) gains: [f64; 7],
    /// Unbalance of each bridge \[V\].
    pub(super) unbalance: [f64; 7],
    /// Feigned strain per kelvin of each gauge.
    pub(super) apparent_strain: [f64; 7],
    /// Drift of each amplifier's offset \[V/K\].
    pub(super) offset_drift: [f64; 7],
    /// Volts under nominal loads, linear.
    pub(super) true_matrix: SensorMatrix<f64, 6>,
    /// The same as the calibration found it.
    pub(super) calibrated_matrix: SensorMatrix<f64, 6>,
}

impl BuiltSensor {
    pub(super) fn new(
        design: &Design,
        electronics: &Electronics,
        drift: &ThermalDrift,
        imperfections: &Imperfections,
        random: &mut Pcg64Mcg,
    ) -> Result<Self, SimulationError> {
        for (value, parameter) in [
            (imperfections.axial_placement, "axial placement error"),
            (imperfections.circumferential_placement, "circumferential placement error"),
            (imperfections.angle, "gauge angle error"),
            (imperfections.gain, "gain error"),
            (imperfections.unbalance, "bridge unbalance"),
            (imperfections.calibration_scale, "scale error of the calibration"),
            (imperfections.calibration_entry, "entry error of the calibration"),
        ] {
            not_negative(value, parameter)?;
        }
        let mut normal = || -> f64 { StandardNormal.sample(random) };
        let mut gauges = design.layout()?.gauges;
        for gauge in &mut gauges {
            gauge.z += imperfections.axial_placement * normal();
            gauge.theta += imperfections.circumferential_placement * normal();
            gauge.q += imperfections.angle * normal();
        }
        let strains = GaugeLayout::new(&design.beam, gauges)?.strain_matrix();
        let mut channel = |mean: f64, deviation: f64| core::array::from_fn(|_| mean + deviation * normal());
        let gains: [f64; 7] = channel(1.0, imperfections.gain);
        let unbalance = channel(0.0, imperfections.unbalance);
        let apparent_strain = channel(drift.apparent_strain, drift.spread * drift.apparent_strain.abs());
        let offset_drift = channel(0.0, drift.offset_drift);

        let mut volts = strains * electronics.gain();
        for (mut row, gain) in volts.row_iter_mut().zip(gains) {
            row *= gain;
        }
        let nominal = design.nominal_loads();
        let matrix = |volts| {
            SensorMatrix::from_sensitivities(volts, nominal)
                .map_err(|error| SimulationError::Layout(error.into()))
        };
        let true_matrix = matrix(volts)?;
        let scale = 1.0 + imperfections.calibration_scale * if normal() < 0.0 { -1.0 } else { 1.0 };
        let mut calibrated = *true_matrix.normalised();
        for mut row in calibrated.row_iter_mut() {
            let largest = row.amax();
            for entry in row.iter_mut() {
                *entry = *entry * scale + imperfections.calibration_entry * largest * normal();
            }
        }
        let calibrated_matrix =
            SensorMatrix::new(calibrated, nominal).map_err(|error| SimulationError::Layout(error.into()))?;
        Ok(Self { strains, gains, unbalance, apparent_strain, offset_drift, true_matrix, calibrated_matrix })
    }
}
