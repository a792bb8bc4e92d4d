//! The condition number of gauges on a tube.

use fingertip::wrench::gauge_layout::{GaugeLayout, ThinWalledBeam};
use fingertip::wrench::{Conditioning, Real};
use nalgebra::Vector6;

/// Volts per unit of strain, which do not change the condition number.
const GAIN: f64 = 2500.0;

/// `None` where the gauges make no sensor: two on one place, or a matrix that cannot be inverted.
pub(crate) fn condition(kind: u32, q: f64, d: f64, radius: f64, lever: f64) -> Option<f64> {
    // An aluminium tube; the wall and the modulus scale all signals alike.
    let beam = ThinWalledBeam { radius, thickness: radius * 0.03, youngs_modulus: 70e9, poisson_ratio: 0.33 };
    let gauges = match kind {
        0 => GaugeLayout::bicchi_dario_gauges(q, d),
        1 => GaugeLayout::three_rosettes(q),
        _ => return None,
    };
    let torque = 30.0 * lever;
    let nominal = Vector6::new(30.0, 30.0, 30.0, torque, torque, torque);
    let sensor = GaugeLayout::new(&beam, gauges).ok()?.sensor_matrix(GAIN, nominal).ok()?;
    let number = Conditioning::of(&sensor).condition_number();
    number.is_number().then_some(number)
}
