//! Gauges on a tube: one finished design.

use core::f64::consts::TAU;

use fingertip_wrench::SensorMatrix;
use fingertip_wrench::gauge_layout::{Gauge, GaugeLayout, SectionConstants, ThinWalledBeam};
use nalgebra::{DMatrix, Vector6};

use super::{Bridge, DesignError, NominalLoads};

/// Which constants relate load to strain.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::TubeTheory;
///
/// // The constants of 1987 differ from the corrected ones.
/// let corrected = layout.strains(TubeTheory::Corrected)?;
/// let of_1987 = layout.strains(TubeTheory::Reconstructed1987)?;
/// assert!(corrected.iter().zip(&of_1987).any(|(a, b)| (a - b).norm() > 0.01 * a.norm()));
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TubeTheory {
    /// Equation (17) of Bicchi & Dario 1987, which is right: peak transverse shear `2V/A`, and
    /// shear strain by `G = E/(2(1+μ))`.
    #[default]
    Corrected,
    /// What the program behind that paper's table seems to have used: `W_s = W_h`, `W_t = W_h/R`,
    /// that is mean shear `V/A` and no factors `(1+μ)`. It reproduces the four printed condition
    /// numbers to 1.6 %, which (17) as printed cannot by less than 19.6 %
    /// (`docs/theory/wrench.md#condition-numbers-of-the-paper`; an inference). Only for comparison with the
    /// paper.
    Reconstructed1987,
}

impl TubeTheory {
    pub(super) fn section(self, beam: &ThinWalledBeam<f64>) -> Result<SectionConstants<f64>, DesignError> {
        let section = beam.section_constants()?;
        Ok(match self {
            Self::Corrected => section,
            Self::Reconstructed1987 => {
                SectionConstants { shear: section.axial, torsion: section.axial / beam.radius, ..section }
            }
        })
    }
}

/// Strain of one gauge per newton and newton metre: the corrected (16).
pub(super) fn strain(gauge: Gauge<f64>, section: SectionConstants<f64>, poisson_ratio: f64) -> Vector6<f64> {
    GaugeLayout { gauges: [gauge], section, poisson_ratio }.strain_matrix().transpose()
}

/// A tube with gauges on it, and how they are wired.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::TubeLayout;
///
/// let layout: TubeLayout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// assert_eq!((layout.channels(), layout.beam.radius), (6, 6.55e-3));
/// // At 1250 V for each unit of strain, as the solvers take it.
/// let sensor = layout.sensor_matrix::<6>(1250.0, &loads)?;
/// assert!(sensor.normalised().amax() > 0.01 && sensor.normalised().amax() < 10.0);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TubeLayout {
    /// The tube.
    pub beam: ThinWalledBeam<f64>,
    /// Where the gauges are.
    pub gauges: Vec<Gauge<f64>>,
    /// How they are wired: one channel per bridge. Empty: each gauge in a quarter bridge.
    pub bridges: Vec<Bridge>,
}

impl TubeLayout {
    /// # Errors
    /// [`DesignError`] for a bad beam, fewer than six channels, a gauge that is not finite, or an
    /// arm of a bridge without its gauge.
    pub fn validate(&self) -> Result<(), DesignError> {
        self.beam.section_constants()?;
        for gauge in &self.gauges {
            for value in [gauge.z, gauge.theta, gauge.q] {
                if !value.is_finite() {
                    return Err(DesignError::OutOfRange {
                        quantity: "place of a gauge",
                        value,
                        requirement: "finite",
                    });
                }
            }
        }
        for bridge in &self.bridges {
            bridge.validate(self.gauges.len())?;
        }
        let channels = self.channels();
        if channels < 6 {
            return Err(DesignError::WrongCount { what: "channels", found: channels, expected: 6 });
        }
        Ok(())
    }

    /// How many signals the sensor gives.
    #[must_use]
    pub fn channels(&self) -> usize {
        if self.bridges.is_empty() { self.gauges.len() } else { self.bridges.len() }
    }

    /// Strain of each channel per newton and newton metre \[1/N, 1/(N·m)\].
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub fn strains(&self, theory: TubeTheory) -> Result<Vec<Vector6<f64>>, DesignError> {
        self.validate()?;
        let section = theory.section(&self.beam)?;
        let mu = self.beam.poisson_ratio;
        let gauges: Vec<_> = self.gauges.iter().map(|gauge| strain(*gauge, section, mu)).collect();
        if self.bridges.is_empty() {
            Ok(gauges)
        } else {
            self.bridges.iter().map(|bridge| bridge.response(&gauges)).collect()
        }
    }

    /// The normalised sensor matrix, one row per channel, signal per nominal load. `gain` is in volts (or
    /// counts) per unit strain.
    ///
    /// # Errors
    /// As [`validate`](Self::validate), and for bad loads or a bad gain.
    pub fn normalised(&self, gain: f64, loads: &NominalLoads) -> Result<DMatrix<f64>, DesignError> {
        loads.validate()?;
        DesignError::check_positive("gain", gain)?;
        let rows = self.strains(TubeTheory::Corrected)?;
        let nominal = loads.components();
        Ok(DMatrix::from_fn(rows.len(), 6, |i, j| gain * rows[i][j] * nominal[j]))
    }

    /// The sensor matrix that the solvers take.
    ///
    /// # Errors
    /// As [`normalised`](Self::normalised); [`DesignError::WrongCount`] if there are not `N`
    /// channels; [`DesignError::Matrix`] if the layout is blind to an axis.
    pub fn sensor_matrix<const N: usize>(
        &self,
        gain: f64,
        loads: &NominalLoads,
    ) -> Result<SensorMatrix<f64, N>, DesignError> {
        let matrix = self.normalised(gain, loads)?;
        let channels = self.channels();
        if channels != N {
            return Err(DesignError::WrongCount { what: "channels", found: channels, expected: N });
        }
        let fixed = matrix.fixed_view::<N, 6>(0, 0).into_owned();
        Ok(SensorMatrix::new(fixed, loads.components())?)
    }

    /// The gauges as `wrench` takes them (and the simulated fingertip).
    ///
    /// # Errors
    /// [`DesignError::WrongCount`] if there are not `N` gauges, or if they are wired otherwise than
    /// each for itself.
    pub fn gauge_layout<const N: usize>(&self) -> Result<GaugeLayout<f64, N>, DesignError> {
        self.validate()?;
        if !self.bridges.is_empty() {
            let found = self.bridges.len();
            return Err(DesignError::WrongCount { what: "half and full bridges", found, expected: 0 });
        }
        let found = self.gauges.len();
        let gauges = <[Gauge<f64>; N]>::try_from(self.gauges.as_slice())
            .map_err(|_| DesignError::WrongCount { what: "gauges", found, expected: N })?;
        Ok(GaugeLayout::new(&self.beam, gauges)?)
    }

    /// The least distance along the wall between the centres of two gauges \[m\], and which they
    /// are, leaving out pairs at the same place (stacked rosettes). `None` if there are no others.
    #[must_use]
    pub fn closest_gauges(&self) -> Option<(f64, usize, usize)> {
        let radius = self.beam.radius;
        let mut closest: Option<(f64, usize, usize)> = None;
        for (i, a) in self.gauges.iter().enumerate() {
            for (j, b) in self.gauges.iter().enumerate().skip(i + 1) {
                let turn = (a.theta - b.theta).rem_euclid(TAU);
                let distance = (a.z - b.z).hypot(radius * turn.min(TAU - turn));
                let nearer = closest.is_none_or(|(least, _, _)| distance < least);
                if distance > 1e-9 * radius && nearer {
                    closest = Some((distance, i, j));
                }
            }
        }
        closest
    }
}
