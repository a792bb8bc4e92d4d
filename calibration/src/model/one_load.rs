//! The load of one sample, for those who ask a million times with other coefficients each time.

use nalgebra::DMatrix;

use super::{Direction, SensorModel};
use crate::Axis;
use crate::fit::Change;

const MOST: usize = Axis::ALL.len();

/// What a linear model of as many gauges as axes tells of one reading, once its coefficients are changed by leaving out one
/// sample: by the inverse of its own matrix and one step of Sherman & Morrison (1950), without another inverse
/// (`docs/theory/calibration.md#least-squares`).
pub(crate) struct LoadOfOne {
    axes: usize,
    bias: bool,
    nominal: [f64; MOST],
    zero: [f64; MOST],
    /// Axes × gauges, in nominal loads per signal.
    inverse: [[f64; MOST]; MOST],
}

impl SensorModel {
    /// `None` of a model that is not linear from as many gauges as axes, or whose inverse would lose digits.
    pub(crate) fn load_of_one(&self) -> Option<LoadOfOne> {
        /// As much as columns of its size may be spread by the inverse: with more it would lose half of the digits that
        /// elimination loses.
        const GREATEST_SPREAD: f64 = 1e3;
        let (axes, theta) = (self.axes.len(), &self.fit.coefficients);
        if self.direction != Direction::SignalsFromLoads || theta.ncols() != axes || axes > MOST {
            return None;
        }
        let matrix = theta.rows(0, axes).transpose();
        let inverse = matrix.clone().try_inverse()?;
        for axis in 0..axes {
            let spread = matrix.column(axis).amax() * inverse.row(axis).amax();
            if !(spread < GREATEST_SPREAD) {
                return None;
            }
        }
        let mut one = LoadOfOne {
            axes,
            bias: self.bias,
            nominal: [0.0; MOST],
            zero: [0.0; MOST],
            inverse: [[0.0; MOST]; MOST],
        };
        for axis in 0..axes {
            one.nominal[axis] = self.nominal[axis];
            one.zero[axis] = if self.bias { theta[(axes, axis)] } else { 0.0 };
            for gauge in 0..axes {
                one.inverse[axis][gauge] = inverse[(axis, gauge)];
            }
        }
        Some(one)
    }
}

impl LoadOfOne {
    /// The load \[N, N·m\] that the reading of a sample tells of by the changed coefficients, as
    /// [`loads_with`](SensorModel::loads_with) tells it but for rounding; `false`, and nothing is said, where the change
    /// leaves a matrix that is nearly singular, or sizes do not fit.
    pub(crate) fn changed(
        &self,
        change: &Change<'_>,
        signals: &DMatrix<f64>,
        sample: usize,
        load: &mut [f64; MOST],
    ) -> bool {
        /// Less leaves a matrix that is nearly singular.
        const LEAST_LEFT: f64 = 1e-3;
        let axes = self.axes;
        if change.step.len() != axes || signals.ncols() != axes || sample >= signals.nrows() {
            return false;
        }
        let (mut reading, mut step, mut pull) = ([0.0; MOST], [0.0; MOST], [0.0; MOST]);
        for gauge in 0..axes {
            reading[gauge] = signals[(sample, gauge)] - self.zero[gauge];
        }
        step.iter_mut().zip(change.step).for_each(|(slot, step)| *slot = *step);
        pull.iter_mut().zip(change.pull).take(axes).for_each(|(slot, pull)| *slot = *pull);
        let of_constant = if self.bias { change.pull.get(axes).copied().unwrap_or(0.0) } else { 0.0 };
        let (mut plain, mut moved, mut pulled, mut left) = ([0.0; MOST], [0.0; MOST], of_constant, 1.0);
        for axis in 0..axes {
            let row = &self.inverse[axis];
            plain[axis] = row.iter().zip(&reading).map(|(inverse, reading)| inverse * reading).sum();
            moved[axis] = row.iter().zip(&step).map(|(inverse, step)| inverse * step).sum();
            pulled += pull[axis] * plain[axis];
            left -= pull[axis] * moved[axis];
        }
        if !(left.abs() > LEAST_LEFT) {
            return false;
        }
        for axis in 0..axes {
            load[axis] = (plain[axis] + moved[axis] * pulled / left) * self.nominal[axis];
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    use super::MOST;
    use crate::Axis;
    use crate::calibrate;
    use crate::file::SignalUnit;
    use crate::fit::Change;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use crate::loads::LoadTable;
    use crate::model::{Direction, Options, SensorModel};
    use crate::testing::Largest as _;

    fn fitted(axes: usize, gauges: usize, options: &Options) -> (SensorModel, DMatrix<f64>) {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(8);
        let mut loads = gaussian_matrix(&mut random, 60, axes);
        // Torques are smaller than forces, and signals are of any size.
        loads.column_mut(axes - 1).scale_mut(1e-4);
        let signals = &loads * sensor(&mut random, axes, gauges) * 1e-6
            + gaussian_matrix(&mut random, 60, gauges) * 1e-9;
        let table = LoadTable::new(&Axis::ALL[..axes], loads, signals.clone(), SignalUnit::Volt).unwrap();
        (calibrate(&table, options).unwrap().model, signals)
    }

    /// By the changed coefficients themselves, and their inverse.
    #[test]
    fn one_load_is_that_of_the_changed_coefficients() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(5);
        for (axes, bias) in [(6, true), (6, false), (3, true), (2, true)] {
            let (model, signals) = fitted(axes, axes, &Options { bias, ..Options::default() });
            let one = model.load_of_one().unwrap();
            let theta = &model.fit.coefficients;
            for size in [0.0, 1e-6, 1e-2, 0.3] {
                for sample in 0..60 {
                    let pull = gaussian_matrix(&mut random, theta.nrows(), 1);
                    let step = gaussian_matrix(&mut random, axes, 1) * (size * theta.amax());
                    let change = Change { pull: pull.as_slice(), step: step.as_slice() };
                    let mut load = [0.0; MOST];
                    if !one.changed(&change, &signals, sample, &mut load) {
                        assert!(size > 0.1);
                        continue;
                    }
                    let changed = theta - &pull * step.transpose();
                    let row = signals.rows(sample, 1).into_owned();
                    let Some(expected) = model.loads_with(&changed, &row) else { continue };
                    for axis in 0..axes {
                        let scale = expected[(0, axis)].abs().max(model.nominal[axis]);
                        let close = 1e-9 * scale;
                        assert!(
                            (load[axis] - expected[(0, axis)]).abs() < close,
                            "{axes} {bias} {size}: {load:?} {expected}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_told_so_is_not_told() {
        let (wide, _) = fitted(6, 7, &Options::default());
        assert!(wide.load_of_one().is_none());
        let inverse = Options { direction: Direction::LoadsFromSignals, ..Options::default() };
        let (backward, _) = fitted(6, 6, &inverse);
        assert!(backward.load_of_one().is_none());
        let (model, signals) = fitted(6, 6, &Options::default());
        let one = model.load_of_one().unwrap();
        let mut load = [0.0; MOST];
        let (pull, step) = ([0.0; 7], [0.0; 6]);
        assert!(one.changed(&Change { pull: &pull, step: &step }, &signals, 0, &mut load));
        assert!(
            (model.loads(&signals).unwrap().row(0) - DMatrix::from_row_slice(1, 6, &load).row(0)).amax()
                < 1e-9
        );
        assert!(!one.changed(&Change { pull: &pull, step: &step[..5] }, &signals, 0, &mut load));
        assert!(!one.changed(&Change { pull: &pull, step: &step }, &signals, 60, &mut load));
        // A change that takes a whole column away leaves no inverse.
        let column: Vec<f64> = model.fit.coefficients.row(2).iter().copied().collect();
        let pull = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
        assert!(!one.changed(&Change { pull: &pull, step: &column }, &signals, 0, &mut load));
        // Two gauges that read the same, nearly and wholly; and none that reads anything.
        for share in [1.0, 1.0 + 1e-6] {
            let mut alike = model.clone();
            let first = alike.fit.coefficients.column(0) * share;
            alike.fit.coefficients.set_column(3, &first);
            assert!(alike.load_of_one().is_none(), "{share}");
        }
        let mut none = model.clone();
        none.fit.coefficients.fill(0.0);
        assert!(none.load_of_one().is_none());
        assert!((model.loads(&signals).unwrap()).largest() > 0.0);
    }
}
