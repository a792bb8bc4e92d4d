//! The load of one sample, for those who ask a million times with other coefficients each time.

use nalgebra::DMatrix;

use super::{Direction, SensorModel};
use crate::Axis;

impl SensorModel {
    /// The load that the reading of one sample tells of by these coefficients, as [`loads_with`](Self::loads_with) tells
    /// it but for rounding, at a tenth of its price: by elimination, without an inverse. `false`, and nothing is said,
    /// of a model that is not linear from as many gauges as axes, and where a pivot is small, so that it would lose digits.
    pub(crate) fn load_of_one(
        &self,
        coefficients: &DMatrix<f64>,
        signals: &DMatrix<f64>,
        sample: usize,
        load: &mut [f64],
    ) -> bool {
        const MOST: usize = Axis::ALL.len();
        /// Smaller, in sizes of its column, a pivot is not trusted.
        const LEAST_PIVOT: f64 = 1e-3;
        let axes = self.axes.len();
        let square = self.direction == Direction::SignalsFromLoads && signals.ncols() == axes && axes <= MOST;
        if !square || load.len() != axes {
            return false;
        }
        // A row for each gauge, what it reads behind its coefficients; columns of size 1.
        let (mut rows, mut sizes) = ([[0.0; MOST + 1]; MOST], [0.0; MOST]);
        for (gauge, row) in rows.iter_mut().take(axes).enumerate() {
            for (axis, size) in sizes.iter_mut().take(axes).enumerate() {
                row[axis] = coefficients[(axis, gauge)];
                *size = f64::max(*size, row[axis].abs());
            }
            let zero = if self.bias { coefficients[(axes, gauge)] } else { 0.0 };
            row[MOST] = signals[(sample, gauge)] - zero;
        }
        for pivot in 0..axes {
            let size = |row: &[f64; MOST + 1]| row[pivot].abs();
            let best = (pivot..axes).max_by(|a, b| size(&rows[*a]).total_cmp(&size(&rows[*b])));
            rows.swap(pivot, best.unwrap_or(pivot));
            let head = rows[pivot];
            if !(head[pivot].abs() > LEAST_PIVOT * sizes[pivot]) {
                return false;
            }
            for row in rows.iter_mut().take(axes).skip(pivot + 1) {
                let share = row[pivot] / head[pivot];
                row.iter_mut().zip(head).for_each(|(slot, head)| *slot -= share * head);
            }
        }
        for axis in (0..axes).rev() {
            let known: f64 = (axis + 1..axes).map(|other| rows[axis][other] * load[other]).sum();
            load[axis] = (rows[axis][MOST] - known) / rows[axis][axis];
        }
        load.iter_mut().zip(&self.nominal).for_each(|(load, nominal)| *load *= nominal);
        true
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;
    use rand::SeedableRng as _;

    use crate::Axis;
    use crate::calibrate;
    use crate::file::SignalUnit;
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

    #[test]
    fn one_load_is_that_of_all() {
        for (axes, bias) in [(6, true), (6, false), (3, true), (2, true)] {
            let (model, signals) = fitted(axes, axes, &Options { bias, ..Options::default() });
            let all = model.loads(&signals).unwrap();
            let mut load = vec![0.0; axes];
            for sample in 0..60 {
                assert!(model.load_of_one(&model.fit.coefficients, &signals, sample, &mut load));
                let row = DMatrix::from_row_slice(1, axes, &load);
                for axis in 0..axes {
                    let close = 1e-11 * all.column(axis).amax();
                    assert!((row[axis] - all[(sample, axis)]).abs() < close, "{axes} {bias}: {row}");
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_told_so_is_not_told() {
        let mut load = vec![0.0; 6];
        let (wide, signals) = fitted(6, 7, &Options::default());
        assert!(!wide.load_of_one(&wide.fit.coefficients, &signals, 0, &mut load));
        let inverse = Options { direction: Direction::LoadsFromSignals, ..Options::default() };
        let (backward, signals) = fitted(6, 6, &inverse);
        assert!(!backward.load_of_one(&backward.fit.coefficients, &signals, 0, &mut load));
        let (model, signals) = fitted(6, 6, &Options::default());
        assert!(!model.load_of_one(&model.fit.coefficients, &signals, 0, &mut [0.0; 5]));
        // Two gauges that read the same, nearly and wholly; and none that reads anything.
        for share in [1.0, 1.0 + 1e-6] {
            let mut alike = model.fit.coefficients.clone();
            let first = alike.column(0) * share;
            alike.set_column(3, &first);
            assert!(!model.load_of_one(&alike, &signals, 0, &mut load), "{share}");
        }
        let none = DMatrix::zeros(7, 6);
        assert!(!model.load_of_one(&none, &signals, 0, &mut load));
        assert!((model.loads(&signals).unwrap()).largest() > 0.0);
    }
}
