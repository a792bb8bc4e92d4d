//! The file of a finished design.

use fingertip_wrench::SensorMatrix;
use fingertip_wrench::gauge_layout::{Gauge, GaugeLayout};
use serde::{Deserialize, Serialize};

use super::{Bridge, Decoupling, DesignError, Excitation, LoadedTube, Material, NominalLoads, TubeLayout};
use crate::file::{CalibrationFile, Provenance, SignalUnit, Verdict};

/// The version of the format that this program reads and writes.
pub const LAYOUT_VERSION: u32 = 1;

/// A designed sensor as TOML: what to make, where to glue, how to wire, and what the signals will be.
///
/// Lengths are in metres, angles in degrees, loads in N and N·m. Unknown fields are refused, and so
/// is a layout that would not work as a sensor.
///
/// ```
/// use fingertip_calibration::design::LayoutFile;
/// use fingertip_wrench::GaussianElimination;
///
/// let file = LayoutFile::from_toml(r#"
/// version = 1
/// gauges = [ # three pairs at ±19.8°
///     { z_m = 0.0, theta_deg = 0.0, q_deg = 19.8 },   { z_m = 0.0, theta_deg = 0.0, q_deg = -19.8 },
///     { z_m = 0.0, theta_deg = 120.0, q_deg = 19.8 }, { z_m = 0.0, theta_deg = 120.0, q_deg = -19.8 },
///     { z_m = 0.0, theta_deg = 240.0, q_deg = 19.8 }, { z_m = 0.0, theta_deg = 240.0, q_deg = -19.8 },
/// ]
/// material = { youngs_modulus_Pa = 71.7e9, poisson_ratio = 0.33, yield_strength_Pa = 503e6 }
/// tube = { radius_m = 0.01, thickness_m = 0.0002, clamped_at_m = 0.02 }
/// loads = { force_N = [10.0, 10.0, 10.0], torque_Nm = [0.1, 0.1, 0.1] }
/// excitation = { supply_V = 5.0, gauge_factor = 2.0, amplifier_gain = 500.0 }
/// "#)?;
/// let solver = GaussianElimination::new(&file.sensor_matrix::<6>()?)?;
/// assert_eq!(file.find_decoupling()?.map(|found| found.couplings()), Some(0));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LayoutFile {
    version: u32,
    /// What the tube is made of.
    pub material: Material,
    tube: TubeSection,
    /// Nominal loads.
    pub loads: NominalLoads,
    /// What turns strain into volts.
    pub excitation: Excitation,
    gauges: Vec<GaugeEntry>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    bridges: Vec<Bridge>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    decoupling: Option<DecouplingSection>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TubeSection {
    #[serde(rename = "radius_m")]
    radius: f64,
    #[serde(rename = "thickness_m")]
    thickness: f64,
    #[serde(rename = "clamped_at_m")]
    clamped_at: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct GaugeEntry {
    #[serde(rename = "z_m")]
    z: f64,
    #[serde(rename = "theta_deg")]
    theta: f64,
    #[serde(rename = "q_deg")]
    q: f64,
}

/// `M`, and the order in which the loads are found; for information, it follows from the layout.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DecouplingSection {
    rows: Vec<Vec<i8>>,
    order: [usize; 6],
}

impl LayoutFile {
    /// The file of a layout. `tube` gives material, loads and clamped length. Lengths are rounded to
    /// picometres, angles to 10⁻⁹ degrees.
    ///
    /// # Errors
    /// [`DesignError`] if something of it is out of range, or the layout is blind to a load.
    pub fn new(layout: &TubeLayout, tube: &LoadedTube, excitation: Excitation) -> Result<Self, DesignError> {
        let gauges = layout
            .gauges
            .iter()
            .map(|gauge| GaugeEntry {
                z: rounded(gauge.z, 1e12),
                theta: rounded(gauge.theta.to_degrees(), 1e9),
                q: rounded(gauge.q.to_degrees(), 1e9),
            })
            .collect();
        let mut file = Self {
            version: LAYOUT_VERSION,
            material: tube.material,
            tube: TubeSection {
                radius: rounded(layout.beam.radius, 1e12),
                thickness: rounded(layout.beam.thickness, 1e12),
                clamped_at: tube.length,
            },
            loads: tube.loads,
            excitation,
            gauges,
            bridges: layout.bridges.clone(),
            decoupling: None,
        };
        file.validate()?;
        file.decoupling =
            file.find_decoupling()?.map(|found| DecouplingSection { rows: found.rows, order: found.order });
        Ok(file)
    }

    fn validate(&self) -> Result<(), DesignError> {
        if self.version != LAYOUT_VERSION {
            let message = format!("version {} is not {LAYOUT_VERSION}, the one known here", self.version);
            return Err(DesignError::Syntax(message));
        }
        self.loaded_tube().validate()?;
        self.excitation.validate()?;
        self.layout().validate()?;
        let matrix = self.layout().normalised(self.excitation.gain(), &self.loads)?;
        if crate::linear::pseudo_inverse(&matrix).is_none() {
            return Err(DesignError::Singular { reason: "the gauges are blind to some load" });
        }
        Ok(())
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`DesignError::Syntax`] for text that is not such a file, and what [`new`](Self::new) refuses.
    pub fn from_toml(text: &str) -> Result<Self, DesignError> {
        let file: Self = toml::from_str(text).map_err(|error| DesignError::Syntax(error.to_string()))?;
        file.validate()?;
        Ok(file)
    }

    /// The text of the file.
    ///
    /// # Errors
    /// [`DesignError::Syntax`] if a number cannot be written, which no valid layout has.
    pub fn to_toml(&self) -> Result<String, DesignError> {
        toml::to_string(self).map_err(|error| DesignError::Syntax(error.to_string()))
    }

    /// The tube with its loads.
    #[must_use]
    pub const fn loaded_tube(&self) -> LoadedTube {
        LoadedTube {
            material: self.material,
            radius: self.tube.radius,
            length: self.tube.clamped_at,
            loads: self.loads,
        }
    }

    /// The gauges on their tube.
    #[must_use]
    pub fn layout(&self) -> TubeLayout {
        let gauges = self.gauges.iter().map(|entry| Gauge {
            z: entry.z,
            theta: entry.theta.to_radians(),
            q: entry.q.to_radians(),
        });
        TubeLayout {
            beam: self.loaded_tube().beam(self.tube.thickness),
            gauges: gauges.collect(),
            bridges: self.bridges.clone(),
        }
    }

    /// The gauges as `wrench` and the simulated fingertip take them.
    ///
    /// # Errors
    /// As [`TubeLayout::gauge_layout`].
    pub fn gauge_layout<const N: usize>(&self) -> Result<GaugeLayout<f64, N>, DesignError> {
        self.layout().gauge_layout()
    }

    /// The sensor matrix in volts, for the solvers.
    ///
    /// # Errors
    /// As [`TubeLayout::sensor_matrix`].
    pub fn sensor_matrix<const N: usize>(&self) -> Result<SensorMatrix<f64, N>, DesignError> {
        self.layout().sensor_matrix(self.excitation.gain(), &self.loads)
    }

    /// The combinations that untangle the signals, if there are any.
    ///
    /// # Errors
    /// As [`TubeLayout::normalised`].
    pub fn find_decoupling(&self) -> Result<Option<Decoupling>, DesignError> {
        Ok(Decoupling::find(&self.layout().normalised(self.excitation.gain(), &self.loads)?))
    }

    /// What a calibration of a perfect specimen would find, as a calibration file, to work with until
    /// there is a real one. Its verdict is "unchecked", and it says that it is computed.
    ///
    /// # Errors
    /// As [`TubeLayout::normalised`].
    pub fn predicted_calibration(&self) -> Result<CalibrationFile, DesignError> {
        let matrix = self.layout().normalised(self.excitation.gain(), &self.loads)?;
        let channels = matrix.nrows();
        let condition_number = crate::linear::Singular::new(&matrix).map(|found| found.condition_number());
        let nominal = self.loads.components().iter().copied().collect();
        let file = CalibrationFile::new(matrix, nominal, vec![0.0; channels], SignalUnit::Volt);
        let mut file = file.map_err(|error| DesignError::Syntax(error.to_string()))?;
        file.provenance =
            Provenance { method: "computed from a gauge layout, not measured".to_owned(), ..file.provenance };
        file.quality.verdict = Verdict::Unchecked;
        file.quality.reasons = vec!["this is the design, not a calibration".to_owned()];
        file.quality.condition_number = condition_number;
        Ok(file)
    }
}

/// What no workshop can tell from the value, but a reader can: `0` for `1.2e-17`.
fn rounded(value: f64, parts: f64) -> f64 {
    // Adding zero makes `−0` `0`.
    (value * parts).round() / parts + 0.0
}

#[cfg(test)]
mod tests {
    use super::LayoutFile;
    use crate::design::test_spaces::{paper, rosettes};
    use crate::design::{Assessment, Bridge, Excitation, LoadedTube, Material, NominalLoads};
    use crate::testing::Largest as _;

    fn excitation() -> Excitation {
        Excitation { supply: 5.0, gauge_factor: 2.0, amplifier_gain: 400.0 }
    }

    fn tube() -> LoadedTube {
        let loads = NominalLoads::equal(10.0, 0.1).unwrap();
        LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 8e-3, length: 20e-3, loads }
    }

    #[test]
    fn round_trip_gives_the_same_sensor() {
        for layout in [paper().layout(&[5e-3, 0.25, 10e-3]), rosettes(3).layout(&[8e-3, 0.3, 0.0])] {
            let file = LayoutFile::new(&layout.unwrap(), &tube(), excitation()).unwrap();
            let text = file.to_toml().unwrap();
            let again = LayoutFile::from_toml(&text).unwrap();
            assert_eq!(again, file, "{text}");
            assert!(again.find_decoupling().unwrap().is_some() && text.contains("[decoupling]"));
            let sensor = again.sensor_matrix::<6>().unwrap();
            let direct = again.gauge_layout::<6>().unwrap();
            let direct = direct.sensor_matrix(excitation().gain(), tube().loads.components()).unwrap();
            let off = (sensor.normalised() - direct.normalised()).largest();
            assert!(off <= 1e-14 * direct.normalised().largest());
            let predicted = again.predicted_calibration().unwrap();
            let off = predicted.sensor_matrix::<6>().unwrap().normalised() - sensor.normalised();
            assert_eq!(off.largest(), 0.0);
            let number = predicted.quality.condition_number.unwrap();
            let judged =
                Assessment::new(&again.layout().normalised(1.0, &again.loads).unwrap(), None).unwrap();
            assert!((number / judged.condition_number - 1.0).abs() < 1e-12, "{number}");
            assert_eq!(predicted.quality.reasons, ["this is the design, not a calibration"]);
            assert!(predicted.provenance.method.contains("not measured"));
        }
    }

    #[test]
    fn bridges_are_kept() {
        let mut layout = rosettes(6).layout(&[8e-3, 0.3, 0.0]).unwrap();
        layout.bridges = (0..6).map(|i| Bridge::half_opposite(2 * i, 2 * i + 1)).collect();
        layout.gauges[3].z = 4e-3;
        let refused = LayoutFile::new(&layout, &tube(), excitation());
        // Sums of ±Q pairs do not see torsion or shear: blind.
        assert!(refused.is_err() || refused.unwrap().sensor_matrix::<6>().is_ok());
        layout.bridges = (0..6).map(|i| Bridge::quarter(2 * i + i % 2)).collect();
        let file = LayoutFile::new(&layout, &tube(), excitation()).unwrap();
        let again = LayoutFile::from_toml(&file.to_toml().unwrap()).unwrap();
        assert_eq!(again.layout().bridges, layout.bridges);
        assert!(again.gauge_layout::<12>().is_err());
    }

    #[test]
    fn refuses_bad_files() {
        let layout = paper().layout(&[5e-3, 0.25, 10e-3]).unwrap();
        let text = LayoutFile::new(&layout, &tube(), excitation()).unwrap().to_toml().unwrap();
        for (from, to) in [
            ("version = 1", "version = 2"),
            ("radius_m = 0.005", "radius_m = -0.005"),
            ("radius_m = 0.005", "radius_mm = 5"),
            ("supply_V = 5.0", "supply_V = nan"),
            ("z_m = 0.01", "z_m = 0.0"),
        ] {
            assert!(text.contains(from), "{text}");
            assert!(LayoutFile::from_toml(&text.replace(from, to)).is_err(), "{to}");
        }
    }
}
