//! What zeros that were taken from the readings themselves do to the covariance of a fit.

use nalgebra::{DMatrix, DVector};

use crate::fit::Fit;
use crate::loads::{LoadTable, Zeros};

/// Mends the covariance of a least-squares fit of signals on loads (`design`, samples × regressors) whose
/// signals had a zero of each group taken off: these share its error.
///
/// With a mean over the group taken off loads and readings ([`Zeros::OfMean`]) only the degrees of freedom
/// change. With the mean of its readings at rest ([`Zeros::OfRest`]) the readings become `T V`, and the
/// coefficients `G Xᵀ W T V`, so that `inverse_gram` becomes `G Xᵀ W T W⁻¹ Tᵀ W X G`, and the sum of the squares
/// that the fit leaves stands for `tr(T W⁻¹ Tᵀ (W − W X G Xᵀ W))` degrees of freedom.
pub(super) fn account_for_zeros(table: &LoadTable, design: &DMatrix<f64>, fit: &mut Fit) {
    let (samples, k) = design.shape();
    let weight = |i: usize| table.weights.as_ref().map_or(1.0, |weights| weights[i]);
    let counted: Vec<usize> = (0..samples).filter(|i| weight(*i) > 0.0 && fit.trust[(*i, 0)] > 0.0).collect();
    let before = counted.len() as f64 - k as f64;
    let mut groups: Vec<usize> = counted.iter().map(|i| table.groups[*i]).collect();
    groups.sort_unstable();
    groups.dedup();
    let freedom = match table.zeros {
        Zeros::Kept => return,
        Zeros::OfMean => before - groups.len() as f64,
        Zeros::OfRest => {
            let mut spread = DMatrix::zeros(k, k);
            let mut traces = counted.len() as f64;
            for group in groups {
                let members = || counted.iter().copied().filter(|i| table.groups[*i] == group);
                let rest: Vec<usize> = members().filter(|i| table.loads.row(*i).amax() == 0.0).collect();
                let pull =
                    members().fold(DVector::zeros(k), |sum, i| sum + design.row(i).transpose() * weight(i));
                let total: f64 = members().map(weight).sum();
                // Readings at rest that were left out since count as one.
                let count = rest.len().max(1) as f64;
                let of_zero = rest.iter().map(|i| 1.0 / weight(*i)).sum::<f64>() / (count * count);
                traces += total * if rest.is_empty() { 1.0 } else { of_zero };
                if rest.is_empty() {
                    spread += &pull * pull.transpose();
                } else {
                    traces -= 2.0;
                }
                for i in members() {
                    let mut share = design.row(i).transpose() * weight(i);
                    if rest.contains(&i) {
                        share -= &pull / count;
                    }
                    spread += &share * share.transpose() / weight(i);
                }
            }
            let freedom = traces - (&fit.inverse_gram * &spread).trace();
            fit.inverse_gram = &fit.inverse_gram * spread * &fit.inverse_gram;
            freedom
        }
    };
    // Without a degree of freedom to spare nothing is known; the fit's own figure is then the least bad.
    if freedom > 0.0 {
        fit.residual_covariance *= before / freedom;
        fit.freedom = freedom;
    }
}

#[cfg(test)]
mod tests {
    use super::account_for_zeros;
    use crate::fit::least_squares;
    use crate::loads::LoadTable;

    /// The mean of a group is one number more that is fitted. Where that leaves no degree of freedom, nothing is known of
    /// the noise, and what the fit says stays.
    #[test]
    fn a_mean_that_is_taken_off_costs_a_degree_of_freedom_if_there_is_one() {
        for (text, factor, freedom) in [
            ("fz_N,v1_V\n1,1.1\n-2,-1.9\n", 1.0, 1.0),
            ("fz_N,v1_V\n1,1.1\n-2,-1.9\n3,2.7\n", 2.0, 1.0),
            ("fz_N,v1_V\n1,1.1\n-2,-1.9\n3,2.7\n0,0.2\n", 1.5, 2.0),
        ] {
            let (table, _) = LoadTable::from_csv(text.as_bytes()).unwrap();
            let table = table.centred_by_group();
            let mut fit = least_squares(&table.loads, &table.signals, None).unwrap();
            let own = fit.residual_covariance[(0, 0)];
            account_for_zeros(&table, &table.loads, &mut fit);
            let found = fit.residual_covariance[(0, 0)];
            assert!((found - factor * own).abs() <= 1e-12 * own, "{text}: {found} of {own}");
            assert_eq!(fit.freedom, freedom, "{text}");
        }
    }
}
