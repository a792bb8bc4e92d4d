//! What the readings at rest tell: the zero and the noise.

use fingertip::wrench::{
    Compensation, DummyGauge, DummyGaugeAccumulator, GaugesAndDummy, GaussianElimination, TareError,
    WrenchSolver,
};
use nalgebra::Vector3;

/// Zero and noise of the unloaded sensor.
pub(super) struct Rest {
    pub(super) zero: DummyGauge<f64, 6>,
    /// Standard deviation of a force component, the largest of the three \[N\].
    pub(super) force_noise: f64,
    pub(super) samples: usize,
}

impl Rest {
    pub(super) fn of(
        readings: &[GaugesAndDummy<f64, 6>],
        solver: &GaussianElimination<f64>,
    ) -> Result<Self, TareError> {
        let mut accumulator = DummyGaugeAccumulator::default();
        for reading in readings {
            accumulator.add(reading);
        }
        let zero = accumulator.finish()?;
        let squares: Vector3<f64> = readings
            .iter()
            .map(|reading| solver.solve(&zero.compensate(reading)).force())
            .map(|force| force.component_mul(&force))
            .sum();
        let force_noise = (squares.max() / (readings.len() as f64 - 1.0)).sqrt();
        Ok(Self { zero, force_noise, samples: readings.len() })
    }
}
