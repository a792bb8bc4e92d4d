// Calibration fnv1a64:645eaf68c2f32513, written by fingertip-calibration 0.1.0.
// Sensor: demo 1
// Quality: BAD
// - made up

// A program that has `fingertip-wrench` and `nalgebra` instead of `fingertip` leaves this line out.
use fingertip::{nalgebra, wrench as fingertip_wrench};

/// Number of gauges.
pub const GAUGES: usize = 7;

/// Reading of each gauge without load.
pub const ZERO: [f32; GAUGES] = [-0.02, -0.01, 0.0, 0.01, 0.02, 0.03, 0.04];

/// Signal of each gauge under the nominal load of each axis.
pub const NORMALISED: [[f32; 6]; GAUGES] = [
    [1.5, 0.033333335, 0.02, 0.014285714, 0.011111111, 0.009090909],
    [0.05, 1.5, 0.016666668, 0.0125, 0.01, 0.008333334],
    [0.033333335, 0.02, 1.5, 0.011111111, 0.009090909, 0.0076923077],
    [0.025, 0.016666668, 0.0125, 1.5, 0.008333334, 0.007142857],
    [0.02, 0.014285714, 0.011111111, 0.009090909, 1.5, 0.006666667],
    [0.016666668, 0.0125, 0.01, 0.008333334, 0.007142857, 1.5],
    [0.014285714, 0.011111111, 0.009090909, 0.0076923077, 0.006666667, 0.005882353],
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

/// Reference temperature, least and greatest temperature of the calibration [°C].
pub const CELSIUS: [f32; 3] = [22.0, 15.0, 45.0];

/// Drift of each zero [signal/K].
pub const ZERO_DRIFT: [f32; GAUGES] = [0.0, 0.001, 0.002, 0.003, 0.004, 0.005, 0.006];

/// Curvature of each zero [signal/K²].
pub const ZERO_CURVATURE: [f32; GAUGES] = [1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5, 1e-5];

/// Drift of each gain [1/K].
pub const GAIN_DRIFT: [f32; GAUGES] = [-0.0002, -0.0002, -0.0002, -0.0002, -0.0002, -0.0002, -0.0002];

/// Takes zero and drift off a reading: use this, not `ZERO` alone.
///
/// # Errors
/// Never for the numbers above; only if they were edited into nonsense.
pub fn temperature_compensation() -> Result<
    fingertip_wrench::TemperatureCompensation<f32, GAUGES, 3>,
    fingertip_wrench::BadTemperatureModel,
> {
    let vector = nalgebra::SVector::<f32, GAUGES>::from;
    let [reference, least, greatest] = CELSIUS;
    fingertip_wrench::TemperatureCompensation::new(
        reference,
        (least, greatest),
        [vector(ZERO), vector(ZERO_DRIFT), vector(ZERO_CURVATURE)],
        [vector(GAIN_DRIFT), vector([0.0; GAUGES]), vector([0.0; GAUGES])],
    )
}
