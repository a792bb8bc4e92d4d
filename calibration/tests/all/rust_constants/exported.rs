// Calibration fnv1a64:3b7d9f580febf5bd, written by fingertip-calibration 0.1.0.
// Sensor: demo 1
// Quality: BAD
// - made up

/// Number of gauges.
pub const GAUGES: usize = 7;

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

/// Reading of each gauge without load.
pub const ZERO: [f32; GAUGES] = [-0.02, -0.01, 0.0, 0.01, 0.02, 0.03, 0.04];

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
