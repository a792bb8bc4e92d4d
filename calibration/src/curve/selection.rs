//! Which terms a curved sensor is worth, by leaving out load cases.

use alloc::collections::BTreeSet;

use nalgebra::{DMatrix, DVector};
use rand::SeedableRng as _;
use rand::seq::SliceRandom as _;
use rand_pcg::Pcg64Mcg;

use super::Terms;
use super::forward::{Rows, Split, forward};
use crate::linear::less;
use crate::loads::LoadTable;

/// What was chosen, and what it is worth.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Chosen {
    /// The terms, of signals less the origin that they were chosen at.
    pub(crate) terms: Terms,
    /// RMS over all axes on load cases that neither choice nor fit has seen, % of full scale.
    pub(crate) left_out_percent: f64,
    /// The same without any of the terms.
    pub(crate) straight_percent: f64,
}

/// Terms are few, so that a microcontroller can do them.
const MOST_TERMS: usize = 40;
/// So many parts of the load cases are left out one after another.
const PARTS: usize = 10;
/// Places where bumps may sit.
const PLACES: usize = 40;
/// Widths of the bumps, in typical signals times the root of twice their number.
const WIDTHS: [f64; 3] = [0.5, 1.0, 2.0];
/// Fewer terms are as good if they are worse by no more than this, relative to the least error.
const AS_GOOD: f64 = 1.02;
/// Errors below this share of those without any terms are none: rounding chooses no terms.
const NOTHING: f64 = 1e-6;
/// Bumps are taken if they make the error of products smaller by this factor.
const WORTH_BUMPS: f64 = 0.9;

/// Chooses products of two and of three signals, and bumps, that make the errors of unseen load cases smallest.
///
/// Load cases are parted into ten; the choice is made by nine, one term after another (see [`forward`]), and tried on the
/// tenth, in turn. The number of terms with the least error, or the least number that is as good within 2 %, is then
/// chosen by all. So the stated error is that of cases which took part neither in the choice nor in the fit
/// (Hastie, Tibshirani & Friedman 2009, 7.10.2).
///
/// `loads` are in nominal loads; signals count from `origin`. `None` for fewer than four load cases, or where the loads
/// do not determine even a straight sensor.
pub(crate) fn choose(table: &LoadTable, loads: &DMatrix<f64>, origin: &[f64], bias: bool) -> Option<Chosen> {
    let signals = less(&table.signals, origin);
    let sizes: Vec<f64> = signals
        .column_iter()
        .map(|column| column.norm() / (table.samples() as f64).sqrt())
        .map(|size| if size > 0.0 { size } else { 1.0 })
        .collect();
    let (weights, parts) = (table.weights.clone(), parts(&table.cases)?);
    let problem = Problem { signals, loads: loads.clone(), sizes, weights, parts, bias };
    let gauges = problem.signals.ncols();
    let products = Terms { products: products(gauges), ..Terms::default() };
    let mut best = problem.best_of(&products)?;
    let places = problem.places();
    for width in WIDTHS {
        let scale = width * (2.0 * gauges as f64).sqrt();
        let widths = problem.sizes.iter().map(|size| scale * size).collect();
        let with_bumps = Terms { widths, centres: places.clone(), ..products.clone() };
        let Some(other) = problem.best_of(&with_bumps) else { continue };
        let bar = if best.terms.centres.is_empty() { WORTH_BUMPS } else { 1.0 };
        if other.left_out_percent < bar * best.left_out_percent {
            best = other;
        }
    }
    Some(best)
}

/// With more gauges than this, only products of three signals are tried of which two are the same: all are too many.
const FEW_GAUGES: usize = 8;

/// The products of two and of three signals that are tried.
fn products(gauges: usize) -> Vec<Vec<usize>> {
    let mut products = Terms::pairs(gauges).products;
    for i in 0..gauges {
        for j in i..gauges {
            let tried = |k: &usize| gauges <= FEW_GAUGES || i == j || j == *k;
            products.extend((j..gauges).filter(tried).map(|k| vec![i, j, k]));
        }
    }
    products
}

/// The part of each sample: cases stay together. `None` for fewer than four cases.
fn parts(cases: &[usize]) -> Option<Vec<usize>> {
    let mut known: Vec<usize> = cases.iter().copied().collect::<BTreeSet<_>>().into_iter().collect();
    if known.len() < 4 {
        return None;
    }
    // The same in every run.
    known.shuffle(&mut Pcg64Mcg::seed_from_u64(1));
    let count = PARTS.min(known.len());
    let mut of_case: Vec<(usize, usize)> =
        known.into_iter().enumerate().map(|(place, case)| (case, place % count)).collect();
    of_case.sort_unstable();
    cases
        .iter()
        .map(|case| of_case.binary_search_by_key(case, |(case, _)| *case).ok().map(|place| of_case[place].1))
        .collect()
}

struct Problem {
    signals: DMatrix<f64>,
    loads: DMatrix<f64>,
    /// Typical signal of each gauge.
    sizes: Vec<f64>,
    weights: Option<Vec<f64>>,
    parts: Vec<usize>,
    bias: bool,
}

impl Problem {
    /// The best choice among these terms.
    fn best_of(&self, terms: &Terms) -> Option<Chosen> {
        let rows = self.rows(terms);
        let samples = self.parts.len();
        let most = MOST_TERMS.min((samples * 9 / 10).checked_sub(rows.base.ncols())? / 2).min(terms.len());
        let mut left = vec![0.0; most + 1];
        let parts: BTreeSet<usize> = self.parts.iter().copied().collect();
        for part in parts {
            let (tried, known): (Vec<usize>, Vec<usize>) = (0..samples).partition(|i| self.parts[*i] == part);
            let taken = forward(Split { known: rows.select(&known), tried: rows.select(&tried) }, most)?;
            let last = *taken.left.last()?;
            let of_part = taken.left.iter().copied().chain(core::iter::repeat(last));
            left.iter_mut().zip(of_part).for_each(|(sum, left)| *sum += left);
        }
        let least = left.iter().copied().fold(f64::INFINITY, f64::min);
        let good = (AS_GOOD * AS_GOOD * least).max(NOTHING * NOTHING * left[0]);
        let count = left.iter().position(|left| *left <= good)?;
        let every: Vec<usize> = (0..samples).collect();
        let order =
            forward(Split { known: rows.select(&every), tried: rows.select(&every[..1]) }, count)?.order;
        let percent = |left: f64| 100.0 * (left / self.loads.len() as f64).sqrt();
        Some(Chosen {
            terms: selected(terms, order),
            left_out_percent: percent(left[count]),
            straight_percent: percent(left[0]),
        })
    }

    /// Regressors, candidates and responses, times the roots of the weights.
    fn rows(&self, terms: &Terms) -> Rows {
        let (samples, gauges) = self.signals.shape();
        let mut base = self.signals.clone().resize_horizontally(gauges + usize::from(self.bias), 1.0);
        for (mut column, size) in base.column_iter_mut().zip(&self.sizes) {
            column /= *size;
        }
        let mut candidates = DMatrix::zeros(samples, terms.len());
        for i in 0..samples {
            let signals: Vec<f64> = self.signals.row(i).iter().copied().collect();
            candidates.set_row(i, &DVector::from_vec(terms.values(&signals)).transpose());
        }
        let mut responses = self.loads.clone();
        for (i, weight) in self.weights.iter().flatten().enumerate() {
            for matrix in [&mut base, &mut candidates, &mut responses] {
                matrix.row_mut(i).scale_mut(weight.sqrt());
            }
        }
        // Of size one, whatever the unit of the signals: a cube of microvolts is small.
        for mut column in candidates.column_iter_mut() {
            let size = column.norm();
            if size > 0.0 {
                column /= size;
            }
        }
        Rows { base, candidates, responses }
    }

    /// Samples that lie far from each other: each is the farthest from those before and from no load
    /// (Gonzalez 1985).
    fn places(&self) -> Vec<Vec<f64>> {
        let scaled = |i: usize| -> Vec<f64> {
            self.signals.row(i).iter().zip(&self.sizes).map(|(signal, size)| signal / size).collect()
        };
        let points: Vec<Vec<f64>> = (0..self.signals.nrows()).map(scaled).collect();
        let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        let mut nearest: Vec<f64> =
            points.iter().map(|point| apart(point, &vec![0.0; point.len()])).collect();
        let mut places = Vec::new();
        while places.len() < PLACES {
            let farthest = (0..points.len()).max_by(|a, b| nearest[*a].total_cmp(&nearest[*b]));
            let Some(farthest) = farthest.filter(|place| nearest[*place] > 1e-6) else { break };
            places.push(self.signals.row(farthest).iter().copied().collect());
            for (distance, point) in nearest.iter_mut().zip(&points) {
                *distance = distance.min(apart(point, &points[farthest]));
            }
        }
        places
    }
}

/// Some of the terms, products before bumps.
fn selected(terms: &Terms, mut order: Vec<usize>) -> Terms {
    order.sort_unstable();
    let count = terms.products.len();
    let products = order.iter().filter_map(|place| terms.products.get(*place)).cloned().collect();
    let centres: Vec<Vec<f64>> =
        order.iter().filter_map(|place| terms.centres.get(place.checked_sub(count)?)).cloned().collect();
    let widths = if centres.is_empty() { Vec::new() } else { terms.widths.clone() };
    Terms { products, widths, centres }
}

#[cfg(test)]
mod tests {
    use alloc::collections::BTreeSet;

    use super::{PARTS, parts, products};

    /// Of up to eight gauges all products of two and of three signals, each once; of more gauges those of three of which
    /// two are the same.
    #[test]
    fn products_of_many_gauges_are_fewer() {
        for gauges in [1, 2, 6, 8, 9, 12] {
            let found = products(gauges);
            let distinct: BTreeSet<Vec<usize>> = found.iter().cloned().collect();
            assert_eq!(distinct.len(), found.len());
            let mut expected = BTreeSet::new();
            for i in 0..gauges {
                for j in 0..gauges {
                    for k in 0..gauges {
                        let mut three = vec![i, j, k];
                        three.sort_unstable();
                        if gauges <= 8 || three[0] == three[1] || three[1] == three[2] {
                            expected.insert(three);
                        }
                    }
                    expected.insert(vec![i.min(j), i.max(j)]);
                }
            }
            assert_eq!(distinct, expected, "{gauges} gauges");
        }
    }

    /// Samples of one case are in one part, and no part is much larger than another; three cases are too few.
    #[test]
    fn cases_are_parted_evenly() {
        for count in [0, 1, 3] {
            let cases: Vec<usize> =
                (0..30).map(|sample| if count == 0 { 0 } else { sample % count }).collect();
            assert_eq!(parts(&cases), None, "{count}");
        }
        for count in [4, 9, 10, 25] {
            // Cases need not be numbered from nought.
            let cases: Vec<usize> = (0..200).map(|sample| 7 + 3 * (sample % count)).collect();
            let parts = parts(&cases).unwrap();
            assert_eq!(parts.len(), 200);
            let pairs: BTreeSet<(usize, usize)> = cases.iter().copied().zip(parts.iter().copied()).collect();
            assert_eq!(pairs.len(), count, "{count}");
            let mut sizes = vec![0; PARTS.min(count)];
            pairs.iter().for_each(|(_, part)| sizes[*part] += 1);
            assert!(
                sizes.iter().all(|size| (count / sizes.len()..=count.div_ceil(sizes.len())).contains(size))
            );
        }
    }
}
