// ball on six gauges: a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "reaction", rest_s = 1.0, sample_rate_Hz = 1000.0
//   sensor       load_per_signal_N_Nm = [[0.02, 0.05, -0.08, -3.38, 0.06, 3.35], [-0.09, 4.1, 0.05,  …, range
//                = [-10.0, 10.0], signal_unit = "V"
//   surface      sphere, a sphere, or a part of it around a pole; centre_m = [0.0, 0.0, 0.012], radius_m =
//                0.01
//   contact      soft_finger, a contact transmits a force and a torque about the normal, as a soft tip does;
//                greatest_friction_ratio = 10.0, least_force_N = 0.1, torque_arm_m = 0.002
//   friction     soft_finger, tangential force and spin torque together; static_coefficient = 0.6,
//                torque_arm_m = 0.002
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
//     let touch = tip.sense(&reading, step); // reading: fingertip::nalgebra::SVector<f64, 6>
//     last = touch.point();
//
// A gauge at or below -10.0, or at or above 10.0, is saturated: leave such a reading out.
//
// The sensor is unloaded for 1.0 s at the start: a `wrench::TareAccumulator` makes a zero of it, which `tip.set_zero` puts in place.

use fingertip::nalgebra::{SVector, Vector3};
use fingertip::{Absent, Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    wrench::GaussianElimination<f64>,
    surfaces::Sphere<f64>,
    contact::SoftFinger<f64>,
    Present<friction::SoftFingerLimit<f64>>,
    Absent,
    wrench::Tare<f64, 6>,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Sphere::new(Vector3::new(0.0, 0.0, 0.012), 0.01)?;
    let model = contact::SoftFinger::new(0.1)?.with_greatest_friction(10.0)?.with_torque_arm(0.002)?;
    Ok(Fingertip::builder()
        .zero(wrench::Tare::new(SVector::from(calibration::ZERO)))
        .solver(wrench::GaussianElimination::new(&opposite(&calibration::sensor_matrix()?)?)?)
        .contact(surface, model)
        .friction(friction::SoftFingerLimit::new(0.6, 0.002)?)
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
    Singular(wrench::SingularMatrix),
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

impl From<wrench::SingularMatrix> for BadTip {
    fn from(bad: wrench::SingularMatrix) -> Self {
        Self::Singular(bad)
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
    // Calibration fnv1a64:2c3ebf55dbb6b578, written by fingertip-calibration 0.1.0.
    // Quality: unchecked

    // A program that has `fingertip-wrench` and `nalgebra` instead of `fingertip` leaves this line out.
    use fingertip::{nalgebra, wrench as fingertip_wrench};

    /// Number of gauges.
    pub const GAUGES: usize = 6;

    /// Reading of each gauge without load.
    pub const ZERO: [f64; GAUGES] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

    /// Signal of each gauge under the nominal load of each axis.
    pub const NORMALISED: [[f64; 6]; GAUGES] = [
        [-0.005004485039149104, 0.004608177741583267, 0.5850505732216458, 0.006121229339620492, -0.8090369690282392, 0.02147542825199429],
        [-0.006821035295098643, 0.809932441325164, 0.009438319927692562, -0.011599539065262145, -0.00553643706988649, -0.5553950443267491],
        [0.0067753095291450596, -0.00576734758828329, 0.5784516564669109, 0.7193982250214948, 0.42671238613939266, 0.024551383378915485],
        [-0.7089734336355885, -0.4082575497754804, -0.0005350015974121997, -0.012460788039318719, 0.011378489995198747, -0.5902826506682184],
        [0.017116932875680176, 0.007816214254990824, 0.5699374536156835, -0.6953430614772039, 0.4052630585992677, 0.017556038149166443],
        [0.7056289645954189, -0.4243073625446497, -0.0005675664357190643, 0.017197770293709336, 0.019324795460605095, -0.5871356320077363],
    ];

    /// Nominal loads [N, N, N, N·m, N·m, N·m].
    pub const NOMINAL: [f64; 6] = [4.760231086827613, 4.930557777777277, 6.651714064810664, 0.046184304693261326, 0.045608222942798364, 0.034186985827943356];

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
}
