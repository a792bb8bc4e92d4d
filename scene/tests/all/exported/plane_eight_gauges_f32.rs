// Flat pad: a fingertip as a type, in f32.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
//   surface      plane, a plane; normal = [0.0, 0.0, 1.0], point_m = [0.0, 0.0, 0.005]
//   contact      least_force_N = 0.2
//   friction     coulomb, one coefficient in all directions; static_coefficient = 0.5
//   slip         threshold, the friction ratio passes the coefficient of [friction]; noise_N = 0.01,
//                warning_share = 0.8
//
// It needs neither heap nor standard library, and in Cargo.toml:
//
//   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
//
// With a standard library, "std" in the place of "libm".
//
// Once, and then for each sample, `time_step` seconds after the one before:
//
//     let (mut tip, mut last) = (tip()?, None);
//
//     let step = fingertip::Step::of(time_step).with_last(last);
//     let touch = tip.sense(&reading, step); // reading: fingertip::nalgebra::SVector<f32, 8>
//     last = touch.point();
//
// After a pause, `last = None` and `friction::SlipDetector::<f32>::reset(&mut tip.detector_mut().0)`.

use fingertip::nalgebra::{SVector, Vector3};
use fingertip::{Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    wrench::LeastSquares<f32, 8>,
    surfaces::Plane<f32>,
    contact::PointContact<f32>,
    Present<friction::Coulomb<f32>>,
    Present<friction::RatioThreshold<f32>>,
    wrench::Tare<f32, 8>,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Plane::new(Vector3::new(0.0, 0.0, 0.005), Vector3::z())?;
    let model = contact::PointContact::new(0.2)?;
    Ok(Fingertip::builder()
        .zero(wrench::Tare::new(SVector::from(calibration::ZERO)))
        .solver(wrench::LeastSquares::new(&calibration::sensor_matrix()?)?)
        .contact(surface, model)
        .friction(friction::Coulomb::new(0.5)?)
        .slip_detector(
            friction::RatioThreshold::new(
                friction::NormalForceGate::from_noise(&friction::ForceNoise::isotropic(0.01)?),
                0.5,
            )?.with_warning_share(0.8)?,
        )
        .build())
}

/// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
#[derive(Clone, Debug, PartialEq)]
pub enum BadTip {
    /// A shape, a contact model or an uncertainty.
    Shape(surfaces::BadShape),
    /// A friction, a detector or a grip.
    Friction(friction::BadParameter),
    /// The sensor matrix.
    Sensor(wrench::SensorMatrixError),
    /// A sensor that does not tell all loads.
    Singular(wrench::LeastSquaresError),
}

impl core::fmt::Display for BadTip {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Shape(bad) => bad.fmt(f),
            Self::Friction(bad) => bad.fmt(f),
            Self::Sensor(bad) => bad.fmt(f),
            Self::Singular(bad) => bad.fmt(f),
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

impl From<wrench::SensorMatrixError> for BadTip {
    fn from(bad: wrench::SensorMatrixError) -> Self {
        Self::Sensor(bad)
    }
}

impl From<wrench::LeastSquaresError> for BadTip {
    fn from(bad: wrench::LeastSquaresError) -> Self {
        Self::Singular(bad)
    }
}

/// The calibration of the sensor.
pub mod calibration {
    // Calibration fnv1a64:8a1ca471024c78dd, written by fingertip-calibration 0.1.0.
    // Quality: unchecked

    // A program that has `fingertip-wrench` and `nalgebra` instead of `fingertip` leaves this line out.
    use fingertip::{nalgebra, wrench as fingertip_wrench};

    /// Number of gauges.
    pub const GAUGES: usize = 8;

    /// Reading of each gauge without load.
    pub const ZERO: [f32; GAUGES] = [-0.02, -0.01, 0.0, 0.01, 0.02, 0.03, 0.04, 0.05];

    /// Signal of each gauge under the nominal load of each axis.
    pub const NORMALISED: [[f32; 6]; GAUGES] = [
        [1.5, 0.033333335, 0.02, 0.014285714, 0.011111111, 0.009090909],
        [0.05, 1.5, 0.016666668, 0.0125, 0.01, 0.008333334],
        [0.033333335, 0.02, 1.5, 0.011111111, 0.009090909, 0.0076923077],
        [0.025, 0.016666668, 0.0125, 1.5, 0.008333334, 0.007142857],
        [0.02, 0.014285714, 0.011111111, 0.009090909, 1.5, 0.006666667],
        [0.016666668, 0.0125, 0.01, 0.008333334, 0.007142857, 1.5],
        [1.5, 0.011111111, 0.009090909, 0.0076923077, 0.006666667, 0.005882353],
        [0.0125, 1.5, 0.008333334, 0.007142857, 0.00625, 0.0055555557],
    ];

    /// Nominal loads [N, N, N, N·m, N·m, N·m].
    pub const NOMINAL: [f32; 6] = [10.0, 10.0, 20.0, 0.1, 0.1, 0.05];

    /// The sensor matrix of these constants.
    ///
    /// # Errors
    /// Never for the numbers above; only if they were edited into nonsense.
    pub fn sensor_matrix()
    -> Result<fingertip_wrench::SensorMatrix<f32, GAUGES>, fingertip_wrench::SensorMatrixError> {
        fingertip_wrench::SensorMatrix::new(
            nalgebra::SMatrix::<f32, GAUGES, 6>::from_fn(|gauge, axis| NORMALISED[gauge][axis]),
            nalgebra::Vector6::from(NOMINAL),
        )
    }
}
