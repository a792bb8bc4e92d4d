//! Linear equations and least squares in 220 bits.

use super::big::Big;

/// `x` of `A x = b`, the last column of each row being `b`; `None` where `A` is singular.
pub(crate) fn solve(mut rows: Vec<Vec<Big>>) -> Option<Vec<Big>> {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|a, b| {
            rows[*a][k].abs().partial_cmp(&rows[*b][k].abs()).unwrap_or(core::cmp::Ordering::Equal)
        })?;
        rows.swap(k, pivot);
        if !rows[k][k].abs().is_positive() {
            return None;
        }
        let top = rows[k].clone();
        for row in rows.iter_mut().skip(k + 1) {
            let factor = &row[k] / &top[k];
            for j in k..=n {
                row[j] = &row[j] - &(&factor * &top[j]);
            }
        }
    }
    let mut x = vec![Big::new(0.0); n];
    for i in (0..n).rev() {
        let mut sum = rows[i][n].clone();
        for j in i + 1..n {
            sum = &sum - &(&rows[i][j] * &x[j]);
        }
        x[i] = &sum / &rows[i][i];
    }
    Some(x)
}

/// Least squares of rows `(regressors, response, weight)` by the normal equations, whose squared
/// condition 220 bits bear.
pub(crate) fn least_squares(rows: &[(Vec<f64>, f64, f64)]) -> Option<Vec<Big>> {
    let k = rows.first()?.0.len();
    let mut system = vec![vec![Big::new(0.0); k + 1]; k];
    for (x, y, weight) in rows {
        let weight = Big::new(*weight);
        let x: Vec<Big> = x.iter().map(|x| Big::new(*x)).collect();
        let y = Big::new(*y);
        for (i, row) in system.iter_mut().enumerate() {
            let left = &weight * &x[i];
            for j in 0..k {
                row[j] = &row[j] + &(&left * &x[j]);
            }
            row[k] = &row[k] + &(&left * &y);
        }
    }
    solve(system)
}
