//! Several partial sessions as one.

use nalgebra::DMatrix;

use super::{LoadError, LoadTable, Zeros};

impl LoadTable {
    /// Joins sessions with the same axes, gauges and unit: groups and cases stay apart, lists that only some have
    /// (times, temperatures, orientations) are dropped, missing weights are 1.
    ///
    /// Sessions of one sensor differ in their zero: follow with
    /// [`tared_by_group`](Self::tared_by_group) if each has an unloaded sample, or with
    /// [`centred_by_group`](Self::centred_by_group) if not.
    ///
    /// # Errors
    /// [`LoadError::Empty`] without a session, [`LoadError::WrongLength`] if they do not match,
    /// [`LoadError::MixedZeros`].
    pub fn merged(sessions: &[Self]) -> Result<Self, LoadError> {
        let Some(first) = sessions.first() else { return Err(LoadError::Empty { what: "sessions" }) };
        let mut result = first.clone();
        for session in &sessions[1..] {
            if session.axes != first.axes {
                return Err(LoadError::WrongLength {
                    field: "axes",
                    found: session.axes.len(),
                    expected: first.axes.len(),
                });
            }
            if session.gauges() != first.gauges() || session.signal_unit != first.signal_unit {
                return Err(LoadError::WrongLength {
                    field: "signals",
                    found: session.gauges(),
                    expected: first.gauges(),
                });
            }
            if session.zeros != first.zeros {
                return Err(LoadError::MixedZeros);
            }
            let next = |list: &[usize]| list.iter().max().map_or(0, |most| most + 1);
            let (cases, groups) = (next(&result.cases), next(&result.groups));
            let (before, added) = (result.samples(), session.samples());
            let join = |a: &DMatrix<f64>, b: &DMatrix<f64>| {
                DMatrix::from_fn(before + added, a.ncols(), |i, j| {
                    if i < before { a[(i, j)] } else { b[(i - before, j)] }
                })
            };
            result.loads = join(&result.loads, &session.loads);
            result.signals = join(&result.signals, &session.signals);
            result.names.append(&session.names);
            result.cases.extend(session.cases.iter().map(|case| case + cases));
            result.groups.extend(session.groups.iter().map(|group| group + groups));
            let both = |a: Option<Vec<f64>>, b: &Option<Vec<f64>>| match (a, b) {
                (Some(mut a), Some(b)) => {
                    a.extend(b);
                    Some(a)
                }
                _ => None,
            };
            result.times = both(result.times.take(), &session.times);
            result.temperatures = both(result.temperatures.take(), &session.temperatures);
            result.orientations = match (result.orientations.take(), &session.orientations) {
                (Some(mut a), Some(b)) => {
                    a.extend(b);
                    Some(a)
                }
                _ => None,
            };
            result.weights = match (result.weights.take(), &session.weights) {
                (None, None) => None,
                (a, b) => {
                    let mut all = a.unwrap_or_else(|| vec![1.0; before]);
                    all.extend(b.clone().unwrap_or_else(|| vec![1.0; added]));
                    Some(all)
                }
            };
        }
        result.validate()?;
        Ok(result)
    }

    /// Loads and readings less their mean (weighted) over the group: a fit without bias to these is
    /// the fit with a bias for each group. For the matrix only; errors in full-scale percent are then of
    /// differences.
    #[must_use]
    pub fn centred_by_group(&self) -> Self {
        let mut centred = Self { zeros: Zeros::OfMean, ..self.clone() };
        let mut groups = self.groups.clone();
        groups.sort_unstable();
        groups.dedup();
        for group in groups {
            let members: Vec<usize> = (0..self.samples()).filter(|i| self.groups[*i] == group).collect();
            let weight = |i: usize| self.weights.as_ref().map_or(1.0, |weights| weights[i]);
            let total: f64 = members.iter().map(|i| weight(*i)).sum();
            if !(total > 0.0) {
                continue;
            }
            for (source, target) in [(&self.loads, &mut centred.loads), (&self.signals, &mut centred.signals)]
            {
                for j in 0..source.ncols() {
                    let mean = members.iter().map(|i| weight(*i) * source[(*i, j)]).sum::<f64>() / total;
                    members.iter().for_each(|i| target[(*i, j)] -= mean);
                }
            }
        }
        centred
    }
}

#[cfg(test)]
mod tests {
    use super::LoadTable;
    use crate::Axis;
    use crate::calibrate;
    use crate::file::SignalUnit;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use crate::model::Options;
    use crate::testing::Largest as _;
    use rand::SeedableRng as _;

    /// Forces in one session, torques in another, a different zero in each: neither alone determines the
    /// sensor.
    #[test]
    fn partial_sessions_make_a_whole() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
        let truth = sensor(&mut random, 6, 6);
        let sessions: Vec<LoadTable> = [0, 3]
            .into_iter()
            .map(|blind| {
                let mut loads = gaussian_matrix(&mut random, 12, 6);
                loads.columns_mut(blind, 3).fill(0.0);
                let signals = (&loads * &truth).add_scalar(blind as f64 + 1.0);
                LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt).unwrap()
            })
            .collect();
        let options = Options { bias: false, nominal: Some(vec![1.0; 6]), ..Options::default() };
        assert!(calibrate(&sessions[0], &options).is_err());
        let merged = LoadTable::merged(&sessions).unwrap();
        assert_eq!((merged.samples(), merged.groups[23], merged.cases[23]), (24, 1, 23));
        let model = calibrate(&merged.centred_by_group(), &options).unwrap().model;
        assert!((model.fit.coefficients - truth).largest() < 1e-12);
        assert!(LoadTable::merged(&[]).is_err());
    }
}
