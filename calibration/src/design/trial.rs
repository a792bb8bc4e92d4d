//! A design tried end to end, before it is built.

use fingertip_contact::{ContactModel, PointContact};
use fingertip_surfaces::ActiveSurface;
use fingertip_wrench::Wrench;
use nalgebra::{DMatrix, DVector, Vector6};
use rand::{RngExt as _, SeedableRng as _};
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::{DesignError, DesignTouch, NominalLoads, Placement, TubeLayout, TubeTheory};
use crate::linear::{Triangular, pseudo_inverse};

/// Which matrix turns the sensor's signals into wrenches.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// # use fingertip_calibration::design::{Placement, DesignTouch, Trial};
/// # let sphere = fingertip_surfaces::Sphere::centred(0.013).expect("a radius");
/// # let touches = DesignTouch::on_sphere(0.013, 1.0, 0.3, 5.0)?;
/// # let trial = |matrix: MatrixUsed| {
/// #     let placement = Placement { angle: 0.5_f64.to_radians(), position: 0.05e-3 };
/// #     let trial = Trial { loads, placement, noise: 1e-9, resolution: 0.0, matrix, sensors: 10, seed: 1 };
/// #     trial.run(&layout, &sphere, &touches)
/// # };
/// use fingertip_calibration::design::MatrixUsed;
///
/// // A sensor as it comes from the bench, and one that was calibrated with 50 loads known to 0.1 %.
/// let as_designed = trial(MatrixUsed::AsDesigned)?;
/// let calibrated = trial(MatrixUsed::Calibrated { loads: 50, load_error: 1e-3 })?;
/// assert!(calibrated.position_rms < 0.5 * as_designed.position_rms);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MatrixUsed {
    /// The one of the design: no calibration.
    AsDesigned,
    /// One fitted to known loads by least squares, one fit per sensor.
    Calibrated {
        /// How many loads, drawn evenly from plus or minus the nominal ones.
        loads: usize,
        /// Standard deviation of the error of the known loads, relative to nominal.
        load_error: f64,
    },
}

/// How a design is tried: sensors are made with placement errors, calibrated or not, touched, and
/// what the pipeline says is compared with the truth.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::{MatrixUsed, Placement, DesignTouch, Trial};
/// use fingertip_surfaces::Sphere;
///
/// // Ten sensors, glued to half a degree and 0.05 mm, calibrated; noise of a hundredth of a millionth of strain.
/// let trial = Trial {
///     loads,
///     placement: Placement { angle: 0.5_f64.to_radians(), position: 0.05e-3 },
///     noise: 1e-8,
///     resolution: 0.0,
///     matrix: MatrixUsed::Calibrated { loads: 50, load_error: 1e-3 },
///     sensors: 10,
///     seed: 1,
/// };
/// // A tip of 13 mm, touched with 5 N at friction ratios up to 0.3.
/// let touches = DesignTouch::on_sphere(0.013, 1.0, 0.3, 5.0)?;
/// let accuracy = trial.run(&layout, &Sphere::centred(0.013)?, &touches)?;
/// assert!(accuracy.position_rms < 1e-3 && accuracy.missed < 0.01);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// The nominal loads.
    pub loads: NominalLoads,
    /// Standard deviations of the places of the gauges.
    pub placement: Placement,
    /// Standard deviation of the noise of a channel \[strain\].
    pub noise: f64,
    /// One count of the converter \[strain\]; 0 for none.
    pub resolution: f64,
    /// Calibration.
    pub matrix: MatrixUsed,
    /// How many sensors are made.
    pub sensors: usize,
    /// Seed of all that is random.
    pub seed: u64,
}

/// What a trial found, over all sensors and touches.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// # use fingertip_calibration::design::{Placement, DesignTouch, Trial};
/// # let sphere = fingertip_surfaces::Sphere::centred(0.013).expect("a radius");
/// # let touches = DesignTouch::on_sphere(0.013, 1.0, 0.3, 5.0)?;
/// # let trial = |matrix: MatrixUsed| {
/// #     let placement = Placement { angle: 0.5_f64.to_radians(), position: 0.05e-3 };
/// #     let trial = Trial { loads, placement, noise: 1e-9, resolution: 0.0, matrix, sensors: 10, seed: 1 };
/// #     trial.run(&layout, &sphere, &touches)
/// # };
/// use fingertip_calibration::design::{Accuracy, MatrixUsed};
///
/// // Ten sensors, never calibrated: contacts are off by some tenths of a millimetre, forces by some per cent.
/// let accuracy: Accuracy = trial(MatrixUsed::AsDesigned)?;
/// assert!(accuracy.position_95 > accuracy.position_rms && accuracy.position_rms < 2e-3);
/// assert!(accuracy.force_rms < 0.1);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Root mean square of the distance between found and true contact \[m\].
    pub position_rms: f64,
    /// 95 % of the contacts are nearer to the truth \[m\].
    pub position_95: f64,
    /// Root mean square of the error of the force vector over the force.
    pub force_rms: f64,
    /// Share of touches that gave no contact.
    pub missed: f64,
}

impl Trial {
    fn validate(&self) -> Result<(), DesignError> {
        self.loads.validate()?;
        self.placement.validate()?;
        DesignError::check_not_negative("noise", self.noise)?;
        DesignError::check_not_negative("resolution", self.resolution)?;
        if self.sensors == 0 {
            return Err(DesignError::WrongCount { what: "sensors", found: 0, expected: 1 });
        }
        if let MatrixUsed::Calibrated { loads, load_error } = self.matrix {
            DesignError::check_not_negative("error of the calibration loads", load_error)?;
            if loads < 6 {
                let what = "calibration loads";
                return Err(DesignError::WrongCount { what, found: loads, expected: 6 });
            }
        }
        Ok(())
    }

    /// Runs the trial of a layout whose fingertip has this surface.
    ///
    /// # Errors
    /// [`DesignError`] for a bad number, a layout that is not one, or one that is blind to a load.
    pub fn run<S: ActiveSurface<f64>>(
        &self,
        layout: &TubeLayout,
        surface: &S,
        touches: &[DesignTouch],
    ) -> Result<Accuracy, DesignError> {
        self.validate()?;
        let model =
            PointContact::new(0.0).map_err(|_| DesignError::Singular { reason: "no contact model" })?;
        let designed = self.matrix_of(layout)?;
        let mut random = Pcg64Mcg::seed_from_u64(self.seed);
        let (mut errors, mut force_squares, mut missed) = (Vec::new(), 0.0, 0_usize);
        let nominal = self.loads.components();
        for _ in 0..self.sensors {
            let made = self.matrix_of(&self.placement.misplace(layout, &mut random))?;
            let used = match self.matrix {
                MatrixUsed::AsDesigned => designed.clone(),
                MatrixUsed::Calibrated { loads, load_error } => {
                    self.calibrate(&made, loads, load_error, &mut random)?
                }
            };
            let inverse = pseudo_inverse(&used)
                .ok_or(DesignError::Singular { reason: "the sensor is blind to some load" })?;
            for touch in touches {
                let truth: Wrench<f64> = Wrench::from_force_at(&touch.point, touch.force);
                let truth = truth.components();
                let signals = self.signals(&made, &truth.component_div(&nominal), &mut random);
                let load = &inverse * signals;
                let found = Vector6::from_fn(|i, _| load[i] * nominal[i]);
                let force_error = (found - truth).fixed_rows::<3>(0).norm() / touch.force.norm();
                force_squares += force_error * force_error;
                match model.resolve(&Wrench::from_components(&found), surface).into_result() {
                    Ok(contact) => errors.push((contact.point - touch.point).norm()),
                    Err(_) => missed += 1,
                }
            }
        }
        let count = (self.sensors * touches.len()).max(1) as f64;
        errors.sort_by(f64::total_cmp);
        let square: f64 = errors.iter().map(|error| error * error).sum();
        let last = (errors.len() * 95).div_ceil(100).saturating_sub(1);
        Ok(Accuracy {
            position_rms: (square / errors.len() as f64).sqrt(),
            position_95: errors.get(last).copied().unwrap_or(f64::NAN),
            force_rms: (force_squares / count).sqrt(),
            missed: missed as f64 / count,
        })
    }

    fn matrix_of(&self, layout: &TubeLayout) -> Result<DMatrix<f64>, DesignError> {
        let rows = layout.strains(TubeTheory::Corrected)?;
        let nominal = self.loads.components();
        Ok(DMatrix::from_fn(rows.len(), 6, |i, j| rows[i][j] * nominal[j]))
    }

    fn signals(&self, matrix: &DMatrix<f64>, load: &Vector6<f64>, random: &mut Pcg64Mcg) -> DVector<f64> {
        let mut signals = matrix * DVector::from_column_slice(load.as_slice());
        for signal in signals.iter_mut() {
            let normal: f64 = StandardNormal.sample(random);
            *signal += self.noise * normal;
            if self.resolution > 0.0 {
                *signal = (*signal / self.resolution).round() * self.resolution;
            }
        }
        signals
    }

    /// Least squares over random loads: the matrix that a calibration would find.
    fn calibrate(
        &self,
        made: &DMatrix<f64>,
        loads: usize,
        load_error: f64,
        random: &mut Pcg64Mcg,
    ) -> Result<DMatrix<f64>, DesignError> {
        let mut fit = Triangular::new(6, made.nrows());
        for _ in 0..loads {
            let load = Vector6::from_fn(|_, _| random.random_range(-1.0..=1.0));
            let signals = self.signals(made, &load, random);
            let said = load.map(|x| {
                let normal: f64 = StandardNormal.sample(random);
                x + load_error * normal
            });
            fit.push(said.as_slice(), signals.as_slice());
        }
        let coefficients = fit
            .factors()
            .coefficients()
            .map_err(|_| DesignError::Singular { reason: "the calibration loads do not span all axes" })?;
        Ok(coefficients.transpose())
    }
}
