// skinned "tip": a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "reaction", rest_s = 1.0, sample_rate_Hz = 500.0
//   surface      compound, the union of several shapes; parts = [{ active_half_angle_deg = 140.0, pole =
//                [0.1, 0.7, 0.3], ra …
//   pose         rotation_deg = [10.0, 20.0, 30.0], translation_m = [0.001, 0.0, 0.002]
//   contact      soft_finger, a contact transmits a force and a torque about the normal, as a soft tip does;
//                skin_share = 0.5
//   contact.skin linear, depth in proportion to the force; radius_m = 0.013, stiffness_N_per_m = 8000
//   uncertainty  force_noise_N = 0.01, torque_noise_Nm = 0.0001
//   friction     soft_finger, tangential force and spin torque together; conservative = true,
//                static_coefficient = 0.5, torque_arm_m = 0.003
//   slip         drop, the friction ratio falls suddenly; false_alarms_per_minute = 2.0, noise_N = 0.01
//   grip         fall_N_per_s = 2.0, greatest_N = 20.0, least_N = 0.2, rise_N_per_s = 100.0
//
// It needs neither heap nor standard library, and in Cargo.toml:
//
//   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction", "skin"] }
//
// With a standard library, "std" in the place of "libm".
//
// Once, and then for each sample, `time_step` seconds after the one before:
//
//     let (mut tip, mut last) = (tip()?, None);
//
//     let step = fingertip::Step::of(time_step).with_last(last);
//     let touch = tip.sense(&reading, step); // reading: wrench::GaugesAndTemperature { gauges, temperature }
//     last = touch.point();
//
// The sensor is unloaded for 1.0 s at the start: the zero stays that of the calibration at its temperature.
//
// After a pause, `last = None` and `friction::SlipDetector::<f64>::reset(&mut tip.detector_mut().0)`.
//
// With `let (noise, calibration) = (wrench_noise()?, calibration_uncertainty()?)`, the covariance of the contact is
//     covariance(&tip, &touch, before, &noise, &calibration)
// whose `ellipse(0.95)` is that of the scene; `before` is the last contact before this sample.
//
// With `let mut grip = grip()?`, the normal force to command next [N] is
//     match &touch.force {
//         Some(force) => grip.command(&tip.friction().0, force, touch.slip, time_step),
//         None => grip.present(),
//     }

use fingertip::nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use fingertip::{Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    wrench::GaussianElimination<f64>,
    surfaces::Posed<
        f64,
        surfaces::Compound<
            surfaces::Compound<surfaces::SphericalCap<f64>, surfaces::Posed<f64, surfaces::Cone<f64>>>,
            surfaces::Compound<surfaces::EllipticCylinder<f64>, surfaces::EllipticCylinder<f64>>,
        >,
    >,
    contact::Compliant<f64, contact::SoftFinger<f64>, contact::LinearStiffness<f64>>,
    Present<friction::SoftFingerLimit<f64>>,
    Present<friction::DropDetector<f64>>,
    wrench::TemperatureCompensation<f64, 6, 3>,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Posed::new(
        surfaces::Compound::new(
            surfaces::Compound::new(
                surfaces::SphericalCap::new(
                    surfaces::Sphere::new(Vector3::zeros(), 0.01)?,
                    Vector3::new(0.1, 0.7, 0.3),
                    -0.7660444431189779,
                )?,
                surfaces::Posed::new(
                    surfaces::Cone::new(
                        Vector3::zeros(),
                        Vector3::z(),
                        0.5410520681182421,
                    )?.with_depth(0.02)?,
                    wrench::RigidTransform::from_matrix(
                        Matrix3::new(
                            0.838670567945424,
                            0.0,
                            0.544639035015027,
                            0.0,
                            1.0,
                            0.0,
                            -0.544639035015027,
                            0.0,
                            0.838670567945424,
                        ),
                        Vector3::new(0.0, 0.0, 0.0),
                    )?,
                ),
            ),
            surfaces::Compound::new(
                surfaces::EllipticCylinder::new([0.008, 0.01], surfaces::CylinderEnds::Unbounded)?,
                surfaces::EllipticCylinder::new([0.009, 0.007], surfaces::CylinderEnds::Open(0.012))?,
            ),
        ),
        wrench::RigidTransform::from_matrix(
            Matrix3::new(
                0.8089361145249915,
                -0.4577738486383615,
                0.3688705275839105,
                0.5165627364768257,
                0.8530277804038395,
                -0.07420609909483492,
                -0.28068719582621426,
                0.25057276261022743,
                0.9265138902019198,
            ),
            Vector3::new(0.001, 0.0, 0.002),
        )?,
    );
    let model = contact::Compliant::new(
        contact::SoftFinger::new(0.0)?,
        contact::LinearStiffness::new(8000.0, 0.013)?,
    ).with_share(0.5)?;
    Ok(Fingertip::builder()
        .zero(calibration::temperature_compensation()?)
        .solver(wrench::GaussianElimination::new(&opposite(&calibration::sensor_matrix()?)?)?)
        .contact(surface, model)
        .friction(friction::SoftFingerLimit::conservative(0.5, 0.003)?)
        .slip_detector(
            friction::DropDetector::with_sum(
                friction::ForceNoise::isotropic(0.01)?,
                friction::Cusum::new(0.75, 5.339682943800724)?,
            )?,
        )
        .build())
}

/// How sure a wrench is: standard deviations at rest, and relative ones under load.
///
/// # Errors
/// Never for the numbers below.
pub fn wrench_noise() -> Result<contact::WrenchNoise<f64>, BadTip> {
    let noise = contact::WrenchNoise::new(Vector6::from([0.01, 0.01, 0.01, 0.0001, 0.0001, 0.0001]), 0.0)?;
    Ok(noise)
}

/// What the fit of the calibration leaves uncertain of a wrench.
///
/// # Errors
/// Never for the numbers below.
pub fn calibration_uncertainty() -> Result<contact::CalibrationUncertainty<f64>, BadTip> {
    Ok(contact::CalibrationUncertainty::new(
        Matrix6::from(
            [
                [
                    0.00442520668598828,
                    0.00018644852619003528,
                    0.0002396046156163629,
                    8.711456522318103e-7,
                    6.85909077816679e-7,
                    2.878295341521262e-7,
                ],
                [
                    0.00018644852619003528,
                    0.004412475449665489,
                    0.0006322537952959396,
                    1.8926024446966578e-6,
                    1.3122886943920066e-6,
                    4.984726985765321e-7,
                ],
                [
                    0.0002396046156163629,
                    0.0006322537952959396,
                    0.017669453914093063,
                    7.131773236422787e-6,
                    4.375053901152789e-6,
                    1.5416721534354491e-6,
                ],
                [
                    8.711456522318103e-7,
                    1.8926024446966578e-6,
                    7.131773236422787e-6,
                    4.4223579913754865e-7,
                    3.780274432661247e-8,
                    1.1827341792530599e-8,
                ],
                [
                    6.85909077816679e-7,
                    1.3122886943920066e-6,
                    4.375053901152789e-6,
                    3.780274432661247e-8,
                    4.426904064635549e-7,
                    1.9618630062661902e-8,
                ],
                [
                    2.878295341521262e-7,
                    4.984726985765321e-7,
                    1.5416721534354491e-6,
                    1.1827341792530599e-8,
                    1.9618630062661902e-8,
                    1.1079008196639808e-7,
                ],
            ],
        ),
        Matrix6::from(
            [
                [0.0003, 3e-5, 1e-5, 0.0015, 0.0012, 0.002],
                [3e-5, 0.0003, 1.5e-5, 0.002, 0.0015, 0.0024],
                [1e-5, 1.5e-5, 7.5e-5, 0.0015, 0.001, 0.0015],
                [0.0015, 0.002, 0.0015, 2.999999999999999, 0.29999999999999993, 0.3999999999999999],
                [0.0012, 0.0015, 0.001, 0.29999999999999993, 2.999999999999999, 0.5999999999999999],
                [0.002, 0.0024, 0.0015, 0.3999999999999999, 0.5999999999999999, 11.999999999999996],
            ],
        ),
    )?)
}

/// How sure the contact of a sample is; `None` without one, and where that cannot be said, as at grazing.
pub fn covariance<Reading, Verdict>(
    tip: &Tip,
    touch: &fingertip::Touch<f64, Reading, Verdict>,
    last: Option<&Vector3<f64>>,
    noise: &contact::WrenchNoise<f64>,
    calibration: &contact::CalibrationUncertainty<f64>,
) -> Option<contact::ContactCovariance<f64>> {
    let surface = tip.surface();
    let indented = tip.model().resolve_indented(&touch.wrench, surface, last).ok()?;
    let jacobian = tip.model().jacobian(&indented, surface)?;
    let covariance = contact::ContactCovariance::new(
        &jacobian,
        &(noise.covariance(&touch.wrench) + calibration.covariance(&touch.wrench)),
    );
    Some(covariance)
}

/// What commands the grip.
///
/// # Errors
/// Never for the numbers below.
pub fn grip() -> Result<friction::GripController<f64>, BadTip> {
    Ok(friction::GripController::new(friction::GripSettings {
        safety: 1.5,
        least: 0.2,
        greatest: 20.0,
        rise: 100.0,
        fall: 2.0,
        slip_boost: 1.25,
    })?)
}

/// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
#[derive(Clone, Debug, PartialEq)]
pub enum BadTip {
    /// A shape, a contact model or an uncertainty.
    Shape(surfaces::BadShape),
    /// A friction, a detector or a grip.
    Friction(friction::BadParameter),
    /// A pose.
    Pose(wrench::TransformError),
    /// The sensor matrix.
    Sensor(wrench::SensorMatrixError),
    /// A sensor that does not tell all loads.
    Singular(wrench::SingularMatrix),
    /// The drift with temperature.
    Temperature(wrench::BadTemperatureModel),
}

impl core::fmt::Display for BadTip {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Shape(bad) => bad.fmt(f),
            Self::Friction(bad) => bad.fmt(f),
            Self::Pose(bad) => bad.fmt(f),
            Self::Sensor(bad) => bad.fmt(f),
            Self::Singular(bad) => bad.fmt(f),
            Self::Temperature(bad) => bad.fmt(f),
        }
    }
}

impl core::error::Error for BadTip {}

impl From<surfaces::BadShape> for BadTip {
    fn from(bad: surfaces::BadShape) -> Self {
        Self::Shape(bad)
    }
}

impl From<friction::BadParameter> for BadTip {
    fn from(bad: friction::BadParameter) -> Self {
        Self::Friction(bad)
    }
}

impl From<wrench::TransformError> for BadTip {
    fn from(bad: wrench::TransformError) -> Self {
        Self::Pose(bad)
    }
}

impl From<wrench::SensorMatrixError> for BadTip {
    fn from(bad: wrench::SensorMatrixError) -> Self {
        Self::Sensor(bad)
    }
}

impl From<wrench::SingularMatrix> for BadTip {
    fn from(bad: wrench::SingularMatrix) -> Self {
        Self::Singular(bad)
    }
}

impl From<wrench::BadTemperatureModel> for BadTip {
    fn from(bad: wrench::BadTemperatureModel) -> Self {
        Self::Temperature(bad)
    }
}

/// The scene says `convention = "reaction"`: what the calibration calls a load is the fingertip's on the
/// environment, and the pipeline wants the opposite.
fn opposite(
    matrix: &wrench::SensorMatrix<f64, 6>,
) -> Result<wrench::SensorMatrix<f64, 6>, wrench::SensorMatrixError> {
    wrench::SensorMatrix::new(-matrix.normalised(), *matrix.nominal())
}

/// The calibration of the sensor.
pub mod calibration {
    // Calibration fnv1a64:c36bbdec38de87c3, written by fingertip-calibration 0.1.0.
    // Quality: unchecked

    // A program that has `fingertip-wrench` and `nalgebra` instead of `fingertip` leaves this line out.
    use fingertip::{nalgebra, wrench as fingertip_wrench};

    /// Number of gauges.
    pub const GAUGES: usize = 6;

    /// Reading of each gauge without load.
    pub const ZERO: [f64; GAUGES] = [-0.02, -0.01, 0.0, 0.009999999999999998, 0.02, 0.030000000000000002];

    /// Signal of each gauge under the nominal load of each axis.
    pub const NORMALISED: [[f64; 6]; GAUGES] = [
        [1.5, 0.03333333333333333, 0.02, 0.014285714285714287, 0.011111111111111112, 0.009090909090909092],
        [0.05, 1.5, 0.016666666666666666, 0.0125, 0.01, 0.008333333333333333],
        [0.03333333333333333, 0.02, 1.5, 0.011111111111111112, 0.009090909090909092, 0.007692307692307693],
        [0.025, 0.016666666666666666, 0.0125, 1.5, 0.008333333333333333, 0.0071428571428571435],
        [0.02, 0.014285714285714287, 0.011111111111111112, 0.009090909090909092, 1.5, 0.006666666666666667],
        [0.016666666666666666, 0.0125, 0.01, 0.008333333333333333, 0.0071428571428571435, 1.5],
    ];

    /// Nominal loads [N, N, N, N·m, N·m, N·m].
    pub const NOMINAL: [f64; 6] = [10.0, 10.0, 20.0, 0.1, 0.1, 0.05];

    /// The sensor matrix of these constants.
    ///
    /// # Errors
    /// Never for the numbers above; only if they were edited into nonsense.
    pub fn sensor_matrix()
    -> Result<fingertip_wrench::SensorMatrix<f64, GAUGES>, fingertip_wrench::SensorMatrixError> {
        fingertip_wrench::SensorMatrix::new(
            nalgebra::SMatrix::<f64, GAUGES, 6>::from_fn(|gauge, axis| NORMALISED[gauge][axis]),
            nalgebra::Vector6::from(NOMINAL),
        )
    }

    /// Reference temperature, least and greatest temperature of the calibration [°C].
    pub const CELSIUS: [f64; 3] = [22.0, 15.0, 45.0];

    /// Drift of each zero [signal/K].
    pub const ZERO_DRIFT: [f64; GAUGES] = [0.0, 0.001, 0.002, 0.003, 0.004, 0.005];

    /// Curvature of each zero [signal/K²].
    pub const ZERO_CURVATURE: [f64; GAUGES] = [1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5];

    /// Drift of each gain [1/K].
    pub const GAIN_DRIFT: [f64; GAUGES] = [-0.0002, -0.0002, -0.0002, -0.0002, -0.0002, -0.0002];

    /// Takes zero and drift off a reading: use this, not `ZERO` alone.
    ///
    /// # Errors
    /// Never for the numbers above; only if they were edited into nonsense.
    pub fn temperature_compensation() -> Result<
        fingertip_wrench::TemperatureCompensation<f64, GAUGES, 3>,
        fingertip_wrench::BadTemperatureModel,
    > {
        let vector = nalgebra::SVector::<f64, GAUGES>::from;
        let [reference, least, greatest] = CELSIUS;
        fingertip_wrench::TemperatureCompensation::new(
            reference,
            (least, greatest),
            [vector(ZERO), vector(ZERO_DRIFT), vector(ZERO_CURVATURE)],
            [vector(GAIN_DRIFT), vector([0.0; GAUGES]), vector([0.0; GAUGES])],
        )
    }
}
