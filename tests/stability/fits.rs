//! Calibration fits against least squares in 220 bits, and on data that a sensor explains exactly.

use fingertip_calibration::fit::{
    Fit, FitError, Ransac, gauss_helmert, huber, least_squares, ransac, ridge, total_least_squares,
};
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::big::Big;
use super::matrix::Row;
use super::solve;

const SAMPLES: usize = 24;
const LOADS: usize = 4;

struct Case {
    name: &'static str,
    /// Ratio of the greatest to the least singular value of the loads, columns of equal size.
    condition: f64,
    columns: [f64; LOADS],
    noise: f64,
    weights: f64,
    offset: f64,
}

fn normal(random: &mut Pcg64Mcg) -> f64 {
    StandardNormal.sample(random)
}

/// Loads of a given condition: the last column is the sum of the others but for its share.
fn loads(case: &Case, random: &mut Pcg64Mcg) -> DMatrix<f64> {
    let mut x = DMatrix::from_fn(SAMPLES, LOADS, |_, _| normal(random));
    for i in 0..SAMPLES {
        let sum: f64 = (0..LOADS - 1).map(|j| x[(i, j)]).sum();
        x[(i, LOADS - 1)] = sum * (1.0 - 1.0 / case.condition) + x[(i, LOADS - 1)] / case.condition;
        for j in 0..LOADS {
            x[(i, j)] = (x[(i, j)] + case.offset) * case.columns[j];
        }
    }
    x
}

/// Greatest difference of the coefficients, each in units of what its column contributes.
fn off(found: &Fit, exact: &[Big], columns: &[f64; LOADS]) -> (f64, f64) {
    let (mut error, mut size) = (0.0_f64, 0.0_f64);
    for (j, column) in columns.iter().enumerate() {
        let difference = (&Big::new(found.coefficients[(j, 0)]) - &exact[j]).to_f64() * column;
        // A NaN is not swallowed.
        error = if difference.abs() <= error { error } else { difference.abs() };
        size = size.max((exact[j].to_f64() * column).abs());
    }
    (error, size)
}

/// What a backward stable fit keeps (Wedin 1973): `κ + κ²·|r|/(|X||θ|)` rounding units, of which
/// sums over the samples take some.
fn allowed(case: &Case, size: f64) -> f64 {
    let condition = 8.0 * case.condition * (1.0 + case.offset.abs());
    let residual = case.noise / size.max(f64::MIN_POSITIVE);
    10.0 * f64::EPSILON * size * condition * (1.0 + condition * residual)
}

type Routine<'a> = &'a dyn Fn(&DMatrix<f64>, &DMatrix<f64>, &[f64]) -> Result<Fit, FitError>;

fn run(name: &str, case: &Case, trials: usize, rows: &mut Vec<Row>, fit: Routine<'_>) {
    let mut row = Row::new::<f64>(name, case.name);
    let mut random = Pcg64Mcg::seed_from_u64(38);
    for _ in 0..trials {
        let x = loads(case, &mut random);
        let weights: Vec<f64> =
            (0..SAMPLES).map(|_| case.weights.powf(random.random_range(-1.0..1.0))).collect();
        let truth: [f64; LOADS] =
            core::array::from_fn(|j| (1.0 + 0.2 * normal(&mut random)) / case.columns[j]);
        let y = DMatrix::from_fn(SAMPLES, 1, |i, _| {
            let clean: f64 = (0..LOADS).map(|j| x[(i, j)] * truth[j]).sum();
            clean + case.noise * normal(&mut random)
        });
        let data: Vec<_> =
            (0..SAMPLES).map(|i| (x.row(i).iter().copied().collect(), y[(i, 0)], weights[i])).collect();
        let exact = solve::least_squares(&data).expect("regular");
        match fit(&x, &y, &weights) {
            Ok(found) => {
                let (error, size) = off(&found, &exact, &case.columns);
                row.iterated(found.iterations);
                row.error(error, allowed(case, size), || format!("relative error {:.1e}", error / size));
            }
            Err(error) => row.expect(false, || error.to_string()),
        }
    }
    rows.push(row);
}

const EVEN: Case =
    Case { name: "ordinary", condition: 1.0, columns: [1.0; LOADS], noise: 0.01, weights: 1.0, offset: 0.0 };

pub(crate) fn rows(trials: usize, rows: &mut Vec<Row>) {
    let mixed = [1e-6, 1.0, 1e6, 1e3];
    let cases = [
        EVEN,
        Case { name: "condition 1e4", condition: 1e4, ..EVEN },
        Case { name: "condition 1e8", condition: 1e8, noise: 1e-8, ..EVEN },
        Case { name: "condition 1e11", condition: 1e11, noise: 0.0, ..EVEN },
        Case { name: "loads of 1e-6 to 1e6", columns: mixed, ..EVEN },
        Case { name: "common offset of 1e6", offset: 1e6, noise: 1e-6, ..EVEN },
        Case { name: "all loads 1e-150", columns: [1e-150; LOADS], ..EVEN },
        Case { name: "all loads 1e150", columns: [1e150; LOADS], ..EVEN },
        Case { name: "weights of 1e-4 to 1e4", weights: 1e4, ..EVEN },
    ];
    for case in &cases {
        run("least squares", case, trials, rows, &|x, y, w| least_squares(x, y, Some(w)));
    }
    // What no load is wrong about, every fit finds.
    for case in &cases[..7] {
        let exact = Case { noise: 0.0, ..*case };
        run("Huber", &exact, trials, rows, &|x, y, w| huber(x, y, Some(w)));
        if case.columns[0] < 1e-100 {
            // No prior is faint against such loads.
            continue;
        }
        run("ridge with a faint prior", &exact, trials, rows, &|x, y, w| {
            let prior = DMatrix::zeros(LOADS, 1);
            let precision = DMatrix::from_fn(LOADS, LOADS, |i, j| if i == j { 1e-60 } else { 0.0 });
            // Without a prior that outweighs 1e-60 of the data.
            ridge(x, y, Some(w), &prior, &precision)
        });
        let columns = case.columns;
        run("total least squares", &exact, trials, rows, &|x, y, _| {
            total_least_squares(x, y, &columns.map(|c| 1e-3 * c), &[1e-3], false)
        });
        if case.condition > 1e9 {
            // Loads that are so nearly dependent vary less than their errors; it says so.
            continue;
        }
        run("Gauss-Helmert", &exact, trials, rows, &|x, y, _| {
            let spread = DMatrix::from_fn(SAMPLES, LOADS, |_, j| 1e-3 * columns[j]);
            gauss_helmert(x, y, &spread, &DMatrix::from_element(SAMPLES, 1, 1e-3))
        });
        if case.condition > 1.0 || case.offset > 0.0 {
            // RANSAC draws samples whose loads are clear of each other by a thousandth, or none.
            continue;
        }
        run("RANSAC", &exact, trials.div_ceil(4), rows, &|x, y, w| {
            ransac(x, y, Some(w), &Ransac::new(vec![1e-2 * (1.0 + case.offset)]))
        });
    }
    let mut row = Row::new::<f64>("least squares", "NaN, infinities, dependent loads");
    let good = DMatrix::from_fn(SAMPLES, LOADS, |i, j| ((i * (j + 3)) % 7) as f64 + (i % (j + 2)) as f64);
    let y = DMatrix::from_fn(SAMPLES, 1, |i, _| i as f64);
    for bad in [f64::NAN, f64::INFINITY] {
        let mut x = good.clone();
        x[(3, 2)] = bad;
        row.expect(least_squares(&x, &y, None).is_err(), || format!("{bad} in the loads"));
        let mut z = y.clone();
        z[(3, 0)] = bad;
        row.expect(least_squares(&good, &z, None).is_err(), || format!("{bad} in the responses"));
    }
    let mut twice = good.clone();
    twice.set_column(1, &good.column(0).into_owned());
    row.expect(least_squares(&twice, &y, None).is_err(), || "two equal loads".to_owned());
    row.expect(
        least_squares(&good.rows(0, 3).into_owned(), &y.rows(0, 3).into_owned(), None).is_err(),
        || "fewer samples than loads".to_owned(),
    );
    rows.push(row);
}
