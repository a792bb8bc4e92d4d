//! Minimisation without derivatives, for functions with creases.

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// Most evaluations of the function.
    pub(super) evaluations: usize,
    /// The simplex is done when its values differ by no more than this, and
    pub(super) value: f64,
    /// its corners by no more than this.
    pub(super) place: f64,
}

/// Least value found by the simplex method of Nelder & Mead 1965 from a simplex of size `size` at
/// `start`, with the coefficients for many dimensions of Gao & Han 2012. It is begun anew, with a
/// fresh simplex, as long as that improves: a single simplex may collapse on a crease.
///
/// A value that is NaN counts as infinite. Returns the place, its value and the evaluations used;
/// never a place worse than the start.
pub(super) fn nelder_mead(
    mut f: impl FnMut(&[f64]) -> f64,
    start: &[f64],
    size: f64,
    limits: Limits,
) -> (Vec<f64>, f64, usize) {
    let mut used = 0;
    let mut f = |x: &[f64]| {
        used += 1;
        let value = f(x);
        if value.is_nan() { f64::INFINITY } else { value }
    };
    let mut best = start.to_vec();
    let mut best_value = f(&best);
    let mut left = limits.evaluations;
    let mut size = size;
    let mut failures = 0;
    while left > 0 && failures < 2 {
        let (place, value, spent) =
            descend(&mut f, &best, best_value, size, Limits { evaluations: left, ..limits });
        left = left.saturating_sub(spent.max(1));
        if best_value - value > limits.value {
            failures = 0;
        } else {
            failures += 1;
        }
        if value < best_value {
            (best, best_value) = (place, value);
        }
        // The other way round and smaller, so that no simplex is like the one before.
        size *= -0.5;
    }
    (best, best_value, used)
}

fn descend(
    f: &mut impl FnMut(&[f64]) -> f64,
    start: &[f64],
    start_value: f64,
    size: f64,
    limits: Limits,
) -> (Vec<f64>, f64, usize) {
    let n = start.len();
    if n == 0 {
        return (Vec::new(), start_value, 0);
    }
    let dimension = n as f64;
    let (expand, contract, shrink) = if n == 1 {
        (2.0, 0.5, 0.5)
    } else {
        (1.0 + 2.0 / dimension, 0.75 - 0.5 / dimension, 1.0 - 1.0 / dimension)
    };
    let mut corners = vec![(start.to_vec(), start_value)];
    for i in 0..n {
        let mut corner = start.to_vec();
        if let Some(x) = corner.get_mut(i) {
            *x += size;
        }
        let value = f(&corner);
        corners.push((corner, value));
    }
    let mut spent = n;
    loop {
        corners.sort_by(|a, b| a.1.total_cmp(&b.1));
        let spread = corners[n].1 - corners[0].1;
        let extent = corners[1..]
            .iter()
            .flat_map(|corner| corner.0.iter().zip(&corners[0].0).map(|(a, b)| (a - b).abs()))
            .fold(0.0, f64::max);
        if spent >= limits.evaluations
            || (extent <= limits.place && !(spread > limits.value))
            || extent < 1e-14
        {
            let (place, value) = corners.swap_remove(0);
            return (place, value, spent);
        }
        let centre: Vec<f64> =
            (0..n).map(|i| corners[..n].iter().map(|corner| corner.0[i]).sum::<f64>() / dimension).collect();
        let worst = corners[n].clone();
        let along = |factor: f64| -> Vec<f64> {
            centre.iter().zip(&worst.0).map(|(c, w)| c + factor * (c - w)).collect()
        };
        let reflected = along(1.0);
        let value = f(&reflected);
        spent += 1;
        if value < corners[0].1 {
            let expanded = along(expand);
            let further = f(&expanded);
            spent += 1;
            corners[n] = if further < value { (expanded, further) } else { (reflected, value) };
        } else if value < corners[n - 1].1 {
            corners[n] = (reflected, value);
        } else {
            let outside = value < worst.1;
            let contracted = along(if outside { contract } else { -contract });
            let nearer = f(&contracted);
            spent += 1;
            if nearer < value.min(worst.1) {
                corners[n] = (contracted, nearer);
            } else {
                let first = corners[0].0.clone();
                for corner in &mut corners[1..] {
                    for (x, best) in corner.0.iter_mut().zip(&first) {
                        *x = best + shrink * (*x - best);
                    }
                    corner.1 = f(&corner.0);
                    spent += 1;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Limits, nelder_mead};

    const LIMITS: Limits = Limits { evaluations: 20_000, value: 1e-13, place: 1e-9 };

    #[test]
    fn rosenbrock_valley() {
        let f = |x: &[f64]| (1.0 - x[0]).powi(2) + 100.0 * (x[1] - x[0] * x[0]).powi(2);
        let (place, value, used) = nelder_mead(f, &[-1.2, 1.0], 0.5, LIMITS);
        assert!(value < 1e-12 && (place[0] - 1.0).abs() < 1e-5, "{place:?} {value}");
        assert!(used < 20_000);
    }

    #[test]
    fn crease_on_which_coordinate_search_jams() {
        // Least at (1, 1), on the crease x = y, along which both coordinates must move together.
        let f = |x: &[f64]| 10.0 * (x[0] - x[1]).abs() + (x[0] - 1.0).abs() + x[2].abs();
        let (place, value, _) = nelder_mead(f, &[-3.0, -3.0, 2.0], 0.3, LIMITS);
        assert!(value < 1e-7, "{place:?} {value}");
    }

    #[test]
    fn many_dimensions() {
        let f = |x: &[f64]| x.iter().enumerate().map(|(i, x)| (1.0 + i as f64) * (x - 0.3).powi(2)).sum();
        let (_, value, _) = nelder_mead(f, &[1.0; 12], 0.5, LIMITS);
        assert!(value < 1e-10, "{value}");
    }

    #[test]
    fn never_worse_than_the_start_and_never_endless() {
        for f in [|_: &[f64]| f64::NAN, |_: &[f64]| f64::INFINITY, |_: &[f64]| 1.0] {
            let (place, _, used) = nelder_mead(f, &[0.5, 0.5], 0.1, LIMITS);
            assert!(place.iter().all(|x| x.is_finite()) && used <= 20_010);
        }
        let (place, value, used) =
            nelder_mead(|x| x[0].abs(), &[1.0], 0.1, Limits { evaluations: 5, ..LIMITS });
        assert!(value <= 1.0 && place[0].is_finite() && used <= 10);
        assert_eq!(nelder_mead(|_| 2.0, &[], 0.1, LIMITS).1, 2.0);
    }
}
