//! What becomes of a design when it is not made exactly as drawn.

use fingertip_wrench::Wrench;
use nalgebra::{DMatrix, Matrix3x6, Matrix6, Vector6};
use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::{Assessment, ContactWeight, DesignError, DesignTouch, NominalLoads, TubeLayout, TubeTheory};

/// How well gauges can be placed: the standard deviations of normally distributed errors.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::{Placement, tolerance};
///
/// // Gauges that are glued to half a degree and 0.05 mm, and ten times as carelessly.
/// let careful = Placement { angle: 0.5_f64.to_radians(), position: 0.05e-3 };
/// let careless = Placement { angle: 10.0 * careful.angle, position: 10.0 * careful.position };
/// let condition = |placement| tolerance(&layout, &loads, placement, None, 100, 1);
/// let (one, other) = (condition(careful)?.condition_number, condition(careless)?.condition_number);
/// assert!(one.quantile_99 < other.quantile_99 && one.nominal == other.nominal);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Of the angle Q of a gauge \[rad\].
    pub angle: f64,
    /// Of the place of its centre, along the axis and around the tube \[m\].
    pub position: f64,
}

impl Placement {
    /// # Errors
    /// [`DesignError::OutOfRange`] unless both are finite and not negative.
    pub fn validate(&self) -> Result<(), DesignError> {
        DesignError::check_not_negative("placement tolerance of angles", self.angle)?;
        DesignError::check_not_negative("placement tolerance of positions", self.position)?;
        Ok(())
    }

    /// The layout as it might be made.
    pub fn misplace(&self, layout: &TubeLayout, random: &mut Pcg64Mcg) -> TubeLayout {
        let mut made = layout.clone();
        let mut error = |size: f64| {
            let normal: f64 = StandardNormal.sample(random);
            size * normal
        };
        for gauge in &mut made.gauges {
            gauge.z += error(self.position);
            gauge.theta += error(self.position) / layout.beam.radius;
            gauge.q += error(self.angle);
        }
        made
    }
}

/// The mean of a figure over sensors as made, and what 99 % of them do not exceed.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::{Placement, Spread, tolerance};
///
/// let placement = Placement { angle: 0.5_f64.to_radians(), position: 0.05e-3 };
/// let spread: Spread = tolerance(&layout, &loads, placement, None, 200, 1)?.condition_number;
/// // 4.18 as drawn, and a little more as made.
/// assert!((spread.nominal - 4.183).abs() < 1e-2);
/// assert!(spread.quantile_99 > spread.mean && spread.quantile_99 < 5.0);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// As designed.
    pub nominal: f64,
    /// Mean over sensors as made.
    pub mean: f64,
    /// 99 % of the sensors are not worse.
    pub quantile_99: f64,
}

impl Spread {
    fn new(nominal: f64, mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let count = values.len();
        let mean = values.iter().sum::<f64>() / count.max(1) as f64;
        let last = (count * 99).div_ceil(100).saturating_sub(1);
        Self { nominal, mean, quantile_99: values.get(last).copied().unwrap_or(nominal) }
    }
}

/// How a layout bears placement errors.
///
/// ```
/// # use fingertip_calibration::design::{LoadedTube, Material, NominalLoads, TubeSpace, Wall};
/// # // The paper's six gauges for 10 N and 0.1 N·m, in the best places.
/// # let loads = NominalLoads::equal(10.0, 0.1)?;
/// # let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
/// # let angles = (1_f64.to_radians(), 59_f64.to_radians());
/// # let space = TubeSpace::bicchi_dario((2e-3, 15e-3), angles, (2e-3, 40e-3), tube, Wall::Fixed(0.2e-3))?;
/// # let layout = space.layout(&[6.55e-3, 14.45_f64.to_radians(), 13.46e-3])?;
/// use fingertip_calibration::design::{Placement, ToleranceReport, DesignTouch, Touches, tolerance};
///
/// // Gauges glued to half a degree and 0.05 mm; touches of 5 N on a half sphere of 13 mm, with friction up to 0.5.
/// let placement = Placement { angle: 0.5_f64.to_radians(), position: 0.05e-3 };
/// let touches = Touches::new(&DesignTouch::on_sphere(0.013, core::f64::consts::FRAC_PI_2, 0.5, 5.0)?)?;
/// let report: ToleranceReport = tolerance(&layout, &loads, placement, Some(&touches), 100, 1)?;
/// // As drawn the matrix of the design is exact; as made, contacts are off by some tenths of a millimetre.
/// let uncalibrated = report.uncalibrated_error.ok_or("no touches")?;
/// assert!(uncalibrated.nominal < 1e-9 && uncalibrated.mean > 0.05e-3 && uncalibrated.mean < 2e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToleranceReport {
    /// Condition number of the sensor as made.
    pub condition_number: Spread,
    /// Contact position error of the sensor as made *and calibrated* \[m per unit strain noise\]:
    /// only noise counts.
    pub calibrated_error: Option<Spread>,
    /// Contact position error by misplacement alone, if the sensor is used with the matrix *as
    /// designed*, without calibration \[m\]. It does not depend on the size of the force.
    pub uncalibrated_error: Option<Spread>,
}

/// Makes `sensors` sensors with placement errors and judges them. Deterministic by seed.
///
/// Without calibration the wrench found is `C₀⁺C w`, with `C` as made and `C₀` as designed: its error is
/// linear in the load, and so is that of the contact point, to first order.
///
/// # Errors
/// As [`TubeLayout::validate`]; [`DesignError::OutOfRange`] for a bad tolerance,
/// [`DesignError::WrongCount`] for no sensors, [`DesignError::Singular`] if the design itself cannot
/// be inverted.
pub fn tolerance(
    layout: &TubeLayout,
    loads: &NominalLoads,
    placement: Placement,
    touches: Option<&Touches>,
    sensors: usize,
    seed: u64,
) -> Result<ToleranceReport, DesignError> {
    placement.validate()?;
    loads.validate()?;
    if sensors == 0 {
        return Err(DesignError::WrongCount { what: "sensors", found: 0, expected: 1 });
    }
    let nominal = loads.components();
    let singular = DesignError::Singular { reason: "the design is blind to some load" };
    let weight = touches.map(|touches| touches.weight.normalised(&nominal));
    let matrix = |layout: &TubeLayout| -> Result<DMatrix<f64>, DesignError> {
        let rows = layout.strains(TubeTheory::Corrected)?;
        Ok(DMatrix::from_fn(rows.len(), 6, |i, j| rows[i][j] * nominal[j]))
    };
    let designed = matrix(layout)?;
    let inverse = crate::linear::pseudo_inverse(&designed).ok_or_else(|| singular.clone())?;
    let assessed = Assessment::new(&designed, weight.as_ref()).ok_or_else(|| singular.clone())?;
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let (mut conditions, mut calibrated, mut uncalibrated) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..sensors {
        let made = matrix(&placement.misplace(layout, &mut random))?;
        let found = Assessment::new(&made, weight.as_ref()).ok_or_else(|| singular.clone())?;
        conditions.push(found.condition_number);
        calibrated.extend(found.contact_error);
        if let Some(touches) = touches {
            let taken = &inverse * &made;
            let error = Matrix6::from_fn(|i, j| {
                let exact = if i == j { 1.0 } else { 0.0 };
                nominal[i] * (taken[(i, j)] - exact) / nominal[j]
            });
            uncalibrated.push(touches.error_of(&error));
        }
    }
    Ok(ToleranceReport {
        condition_number: Spread::new(assessed.condition_number, conditions),
        calibrated_error: assessed.contact_error.map(|error| Spread::new(error, calibrated)),
        uncalibrated_error: touches.map(|_| Spread::new(0.0, uncalibrated)),
    })
}

/// Touches, and what they add up to.
///
/// ```
/// use fingertip_calibration::design::{ContactWeight, DesignTouch, Touches};
///
/// // Touches of 1 N all over a half sphere of 10 mm weigh as that half sphere does.
/// let angle = core::f64::consts::FRAC_PI_2;
/// let touches = Touches::new(&DesignTouch::on_sphere(0.01, angle, 0.5, 1.0)?)?;
/// let weight = ContactWeight::on_sphere(0.01, angle, 0.5, 1.0)?;
/// assert!((touches.weight().matrix() - weight.matrix()).norm() < 1e-12 * weight.matrix().norm());
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Touches {
    /// Wrench of each touch, and how its point moves with the wrench.
    list: Vec<(Vector6<f64>, Matrix3x6<f64>)>,
    weight: ContactWeight,
}

impl Touches {
    /// # Errors
    /// As [`ContactWeight::over`].
    pub fn new(touches: &[DesignTouch]) -> Result<Self, DesignError> {
        let weight = ContactWeight::over(touches.iter().copied())?;
        let wrench =
            |touch: &DesignTouch| Wrench::<f64>::from_force_at(&touch.point, touch.force).components();
        Ok(Self { list: touches.iter().map(|touch| (wrench(touch), touch.jacobian())).collect(), weight })
    }

    /// Their weight, for wrenches in N and N·m.
    #[must_use]
    pub const fn weight(&self) -> &ContactWeight {
        &self.weight
    }

    /// Root mean square of the first-order position error \[m\] over the touches, when the error of
    /// the wrench is this matrix times the wrench.
    fn error_of(&self, error: &Matrix6<f64>) -> f64 {
        let square = |(wrench, jacobian): &(Vector6<f64>, Matrix3x6<f64>)| {
            (jacobian * (error * wrench)).norm_squared()
        };
        (self.list.iter().map(square).sum::<f64>() / self.list.len() as f64).sqrt()
    }
}
