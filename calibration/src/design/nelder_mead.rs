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

    /// What is asked of a function that answers so, one after another.
    fn asked(answers: &[f64], start: &[f64], size: f64, limits: Limits) -> (Vec<Vec<f64>>, (Vec<f64>, f64)) {
        let mut places = Vec::new();
        let mut answer = answers.iter();
        let f = |x: &[f64]| {
            places.push(x.to_vec());
            *answer.next().unwrap()
        };
        let (place, value, used) = nelder_mead(f, start, size, limits);
        assert_eq!((used, answer.next()), (places.len(), None));
        (places, (place, value))
    }

    /// Every way to go on, one after another, in four dimensions: expansion by 3/2, contraction by 5/8, shrinking
    /// to 3/4 (Gao & Han 2012). `beyond` is on the line from the worst corner through the middle of the others.
    #[test]
    fn the_simplex_goes_where_the_method_says() {
        let corner = |i: usize| (0..4).map(|j| if i == j { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        let beyond = |others: [&Vec<f64>; 4], worst: &[f64], factor: f64| -> Vec<f64> {
            let middle = |j: usize| others.iter().map(|other| other[j]).sum::<f64>() / 4.0;
            (0..4).map(|j| middle(j) + factor * (middle(j) - worst[j])).collect()
        };
        let origin = vec![0.0; 4];
        let [a, b, c, d] = [0, 1, 2, 3].map(corner);
        let mut expected = vec![origin.clone(), a.clone(), b.clone(), c.clone(), d.clone()];
        let mut answers = vec![0.0, 1.0, 2.0, 3.0, 4.0];
        let mut next = |place: Vec<f64>, answer: f64| {
            expected.push(place.clone());
            answers.push(answer);
            place
        };
        // Better than the best: further.
        next(beyond([&origin, &a, &b, &c], &d, 1.0), -1.0);
        let far = next(beyond([&origin, &a, &b, &c], &d, 1.5), -2.0);
        // Better than the second worst: taken.
        let taken = next(beyond([&far, &origin, &a, &b], &c, 1.0), 1.5);
        // Better than the worst only: half way back, on this side.
        next(beyond([&far, &origin, &a, &taken], &b, 1.0), 1.75);
        let near = next(beyond([&far, &origin, &a, &taken], &b, 0.625), 1.6);
        // Worse than all: on the side of the worst; and as that is worse, too, all draw near to the best.
        next(beyond([&far, &origin, &a, &taken], &near, 1.0), 5.0);
        next(beyond([&far, &origin, &a, &taken], &near, -0.625), 7.0);
        for (corner, answer) in [(&origin, -1.5), (&a, 2.0), (&taken, 3.0), (&near, 4.0)] {
            next(far.iter().zip(corner).map(|(best, x)| best + 0.75 * (x - best)).collect(), answer);
        }
        let limits = Limits { evaluations: answers.len() - 1, value: 0.0, place: 0.0 };
        let (found, best) = asked(&answers, &origin, 1.0, limits);
        for (found, expected) in found.iter().zip(&expected) {
            let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15);
            assert!(near, "{found:?} instead of {expected:?}");
        }
        assert_eq!((found.len(), best), (expected.len(), (far, -2.0)));
    }

    #[test]
    fn a_simplex_of_one_dimension_doubles_and_halves() {
        let mut places = Vec::new();
        let f = |x: &[f64]| {
            places.push(x[0]);
            x[0] * x[0]
        };
        nelder_mead(f, &[1.0], 0.5, LIMITS);
        assert_eq!(places[..8], [1.0, 1.5, 0.5, 0.0, -1.0, 0.5, -0.5, 0.25]);
    }

    /// Nothing gets better: from the start again, the other way round and half as large, twice in all.
    #[test]
    fn it_begins_anew_as_long_as_that_helps() {
        let limits = Limits { evaluations: 100, value: 0.0, place: 0.2 };
        let (places, best) = asked(&[1.0; 12], &[0.0], 0.5, limits);
        let first = [0.0, 0.5, -0.5, 0.25, 0.25, -0.25, 0.125, 0.125];
        let places: Vec<f64> = places.concat();
        assert_eq!(places, [&first[..], &[-0.25, 0.25, -0.125, -0.125]].concat());
        assert_eq!(best, (vec![0.0], 1.0));
        // The second finds something better, by more than counts: two more follow it.
        let limits = Limits { value: 1.0, ..limits };
        let answers = [&[1.0; 8][..], &[-0.5, 1.0, 1.0, 0.4], &[0.0, 0.0]].concat();
        let (places, best) = asked(&answers, &[0.0], 0.5, limits);
        assert_eq!(best, (vec![-0.25], -0.5));
        assert_eq!(places[8..].concat(), [-0.25, -0.5, -0.125, -0.125, -0.125, -0.3125]);
    }
}
