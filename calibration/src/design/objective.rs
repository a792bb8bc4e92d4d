//! A criterion over a design space, in coordinates without bounds.

use core::cell::Cell;
use core::f64::consts::PI;

use nalgebra::{DVector, Vector6};

use super::criterion::gram;
use super::{Criterion, DesignSpace, NominalLoads, Parameter};

/// Differences of the response are taken over this part of a parameter's range.
const STEP: f64 = 1e-6;

/// The logarithm of a criterion as a function of coordinates `t` without bounds: a parameter is
/// `lower + span·(1 − cos πt)/2`, or `lower + span·t` if it is periodic, so that `t` from 0 to 1 is
/// its range.
pub(super) struct Objective<'a> {
    space: &'a dyn DesignSpace,
    criterion: &'a Criterion,
    nominal: Vector6<f64>,
    evaluations: Cell<u64>,
}

impl<'a> Objective<'a> {
    pub(super) fn new(space: &'a dyn DesignSpace, criterion: &'a Criterion, loads: &NominalLoads) -> Self {
        Self { space, criterion, nominal: loads.components(), evaluations: Cell::new(0) }
    }

    pub(super) fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    pub(super) fn values(&self, t: &[f64]) -> Vec<f64> {
        self.space.parameters().iter().zip(t).map(|(parameter, t)| value(parameter, *t)).collect()
    }

    fn rows(&self, values: &[f64]) -> Option<Vec<Vector6<f64>>> {
        self.evaluations.set(self.evaluations.get() + 1);
        let mut rows = vec![Vector6::zeros(); self.space.channels()];
        self.space.response(values, &mut rows).ok()?;
        Some(rows)
    }

    /// The criterion at values of the parameters; infinite where there is no sensor.
    pub(super) fn criterion(&self, values: &[f64]) -> f64 {
        self.rows(values).map_or(f64::INFINITY, |rows| self.criterion.of(&gram(&rows, &self.nominal)))
    }

    /// Logarithm of the criterion.
    pub(super) fn at(&self, t: &[f64]) -> f64 {
        self.criterion(&self.values(t)).ln()
    }

    /// Logarithm of the smoothed criterion and its slope in `t`. The criterion is differentiated
    /// with respect to the response exactly, the response by central differences.
    pub(super) fn smoothed(&self, t: &DVector<f64>, power: f64) -> Option<(f64, DVector<f64>)> {
        let parameters = self.space.parameters();
        let mut values = self.values(t.as_slice());
        let rows = self.rows(&values)?;
        let (log, by_gram) = self.criterion.smoothed(&gram(&rows, &self.nominal), power)?;
        // d(CᵀC) = dCᵀ C + Cᵀ dC, so the slope by a row c of C is 2·G·c.
        let by_rows: Vec<Vector6<f64>> = rows
            .iter()
            .map(|row| (by_gram * row.component_mul(&self.nominal)).component_mul(&self.nominal) * 2.0)
            .collect();
        let mut slope = DVector::zeros(t.len());
        for (index, parameter) in parameters.iter().enumerate() {
            let here = values[index];
            let step = STEP * parameter.span();
            let (low, high) = if parameter.periodic {
                (here - step, here + step)
            } else {
                ((here - step).max(parameter.lower), (here + step).min(parameter.upper))
            };
            values[index] = high;
            let above = self.rows(&values)?;
            values[index] = low;
            let below = self.rows(&values)?;
            values[index] = here;
            let change: f64 = above
                .iter()
                .zip(&below)
                .zip(&by_rows)
                .map(|((above, below), by_row)| (above - below).dot(by_row))
                .sum();
            slope[index] = change / (high - low) * derivative(parameter, t[index]);
        }
        Some((log, slope))
    }
}

fn value(parameter: &Parameter, t: f64) -> f64 {
    let part = if parameter.periodic { t } else { 0.5 * (1.0 - (PI * t).cos()) };
    parameter.admissible(parameter.lower + parameter.span() * part)
}

fn derivative(parameter: &Parameter, t: f64) -> f64 {
    parameter.span() * if parameter.periodic { 1.0 } else { 0.5 * PI * (PI * t).sin() }
}

#[cfg(test)]
mod tests {
    use super::Objective;
    use crate::design::test_spaces::{free, paper};
    use crate::design::{Criterion, DesignSpace, NominalLoads};
    use crate::testing::Largest as _;
    use nalgebra::DVector;
    use proptest::prelude::*;

    proptest! {
        // Of random designs more than half are bad ones, which have no slope to speak of: however many cases are asked for,
        // they are found.
        #![proptest_config(ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::default() })]

        #[test]
        fn slope_agrees_with_differences(t in proptest::collection::vec(0.05..0.95_f64, 18), power in 1.0..20.0_f64) {
            let loads = NominalLoads::equal(10.0, 0.1).unwrap();
            let criterion = Criterion::ConditionNumber;
            let spaces: [&dyn DesignSpace; 2] = [&paper(), &free()];
            for space in spaces {
                let objective = Objective::new(space, &criterion, &loads);
                let t = DVector::from_column_slice(&t[..space.parameters().len()]);
                prop_assume!(objective.at(t.as_slice()) < 4.0);
                let (_, slope) = objective.smoothed(&t, power).unwrap();
                for i in 0..t.len() {
                    let mut moved = t.clone();
                    let step = 1e-5;
                    moved[i] += step;
                    let above = objective.smoothed(&moved, power).unwrap().0;
                    moved[i] -= 2.0 * step;
                    let below = objective.smoothed(&moved, power).unwrap().0;
                    let difference = (above - below) / (2.0 * step);
                    prop_assert!((difference - slope[i]).abs() <= 2e-4 * slope.largest().max(1.0),
                        "{i} {difference} {}", slope[i]);
                }
            }
        }
    }
}
