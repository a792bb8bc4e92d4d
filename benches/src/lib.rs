//! Benchmarks of the fingertip workspace; see the `benches` folder. This library holds the inputs
//! that they share.

mod columns;
mod hand_batch;
pub mod hand_written;

pub use columns::Columns;

use fingertip_wrench::gauge_layout::{GaugeLayout, LayoutError, ThinWalledBeam};
use fingertip_wrench::{Real, SensorMatrix};
use nalgebra::Vector6;

/// The paper's sensor: six gauges on an aluminium tube of 10 mm, 30 N.
///
/// # Errors
/// Never, for `f32` and `f64`.
pub fn paper_sensor<T: Real>() -> Result<SensorMatrix<T, 6>, LayoutError> {
    let literal = T::literal;
    let beam = ThinWalledBeam {
        radius: literal(5e-3),
        thickness: literal(2e-4),
        youngs_modulus: literal(70e9),
        poisson_ratio: literal(0.33),
    };
    let gauges =
        GaugeLayout::bicchi_dario_gauges(literal(14.0 / 180.0 * core::f64::consts::PI), literal(0.01));
    let nominal = Vector6::new(30.0, 30.0, 30.0, 0.3, 0.3, 0.3).map(literal);
    GaugeLayout::new(&beam, gauges)?.sensor_matrix(literal(1e4), nominal)
}

/// Signals of an ordinary touch.
#[must_use]
pub fn signals<T: Real>() -> Vector6<T> {
    Vector6::new(-0.83, 0.12, 0.4, -0.31, -0.77, 0.25).map(T::literal)
}
