//! The pipeline from outside, as one program: each program more is linked again.
#![cfg(feature = "friction")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::needless_range_loop,
    reason = "tests"
)]

use fingertip::wrench::gauge_layout::{GaugeLayout, ThinWalledBeam};
use fingertip::wrench::{Real, SensorMatrix};
use nalgebra::Vector6;

mod any_fingertip;
mod batches;
mod batches_at_the_edges;
mod contacts;
mod stages;

/// The sensor of Bicchi & Dario 1987, in volts, with nominal loads of 30 N and 0.3 N·m.
fn paper_sensor<T: Real>() -> SensorMatrix<T, 6> {
    let l = T::literal;
    let beam = ThinWalledBeam {
        radius: l(5e-3),
        thickness: l(0.3e-3),
        youngs_modulus: l(70e9),
        poisson_ratio: l(0.33),
    };
    let gauges = GaugeLayout::bicchi_dario_gauges(l(14.0_f64.to_radians()), l(10e-3));
    let nominal = Vector6::new(l(30.0), l(30.0), l(30.0), l(0.3), l(0.3), l(0.3));
    GaugeLayout::new(&beam, gauges).unwrap().sensor_matrix(l(2500.0), nominal).unwrap()
}
