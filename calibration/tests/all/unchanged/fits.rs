//! Regressions, their errors, and what is said of single samples.

use core::fmt::Debug;

use fingertip_calibration::experiment::{Information, plan, plan_after};
use fingertip_calibration::fit::{
    Fit, Ransac, fit_temperature, gauss_helmert, gauss_helmert_correlated, huber, least_squares, leave_out,
    ransac, ridge, total_least_squares,
};
use fingertip_calibration::linear::{Singular, Triangular, pseudo_inverse};
use fingertip_calibration::nalgebra::{DMatrix, DVector};
use fingertip_calibration::report::outliers;

use super::{Draw, to_ten_digits, unchanged};

/// A table of a sensor: of few and of many samples, some with outliers, some whose last regressor is nearly another one.
struct Problem {
    design: DMatrix<f64>,
    responses: DMatrix<f64>,
    weights: Option<Vec<f64>>,
}

impl Problem {
    fn drawn(draw: &mut Draw, kind: usize) -> Self {
        let (regressors, gauges) = [(2, 3), (3, 3), (6, 6), (4, 2)][kind % 4];
        let samples = regressors + [4, 12, 40][kind / 4 % 3];
        let mut design = draw.matrix(samples, regressors);
        if kind % 5 == 3 {
            let nearly = design.column(0) + design.column(regressors - 1) * 1e-3;
            design.set_column(regressors - 1, &nearly);
        }
        let truth = draw.matrix(regressors, gauges);
        let mut responses = &design * truth + draw.noises(samples, gauges) * [0.01, 1e-6, 0.3][kind % 3];
        if kind % 2 == 1 {
            for place in 0..=samples / 20 {
                responses[(7 * place % samples, place % gauges)] += 3.0 + place as f64;
            }
        }
        let weight = |i: usize| [1.0, 0.25, 4.0, 0.0, 2.0, 1.0, 1.0, 1.0][i % 8];
        let weights = (kind % 3 == 2).then(|| (0..samples).map(weight).collect());
        Self { design, responses, weights }
    }
}

fn told<E: Debug>(fit: &Result<Fit, E>) -> String {
    match fit {
        Ok(fit) => to_ten_digits(&(fit, fit.deviations(), fit.half_widths(0.95))),
        Err(error) => format!("{error:?}"),
    }
}

#[test]
fn of_one_table_by_each_method() {
    let mut unchanged = unchanged("fits");
    let draw = &mut Draw::new(1);
    let problems: Vec<Problem> = (0..24).map(|kind| Problem::drawn(draw, kind)).collect();
    let each = |fit: &dyn Fn(&Problem) -> String| problems.iter().map(fit).collect::<Vec<_>>();
    let weights = |problem: &Problem| problem.weights.clone();
    unchanged.note(
        "least squares",
        each(&|p| told(&least_squares(&p.design, &p.responses, weights(p).as_deref()))),
    );
    unchanged.note("Huber", each(&|p| told(&huber(&p.design, &p.responses, weights(p).as_deref()))));
    unchanged.note(
        "ridge",
        each(&|p| {
            let prior = DMatrix::from_element(p.design.ncols(), p.responses.ncols(), 0.5);
            let precision = DMatrix::from_diagonal_element(p.design.ncols(), p.design.ncols(), 0.3);
            told(&ridge(&p.design, &p.responses, weights(p).as_deref(), &prior, &precision))
        }),
    );
    unchanged.note(
        "RANSAC",
        each(&|p| {
            let options = Ransac { outliers: 0.1, seed: 3, ..Ransac::new(vec![1.0; p.responses.ncols()]) };
            told(&ransac(&p.design, &p.responses, weights(p).as_deref(), &options))
        }),
    );
    for constant in [false, true] {
        unchanged.note(
            &format!("total least squares, constant: {constant}"),
            each(&|p| {
                let (of_loads, of_signals) = (vec![0.01; p.design.ncols()], vec![0.02; p.responses.ncols()]);
                told(&total_least_squares(&p.design, &p.responses, &of_loads, &of_signals, constant))
            }),
        );
    }
    unchanged.note(
        "Gauss-Helmert",
        each(&|p| {
            let errors = p.design.map(|x| 0.01 + 0.02 * x.abs());
            let noise = p.responses.map(|x| 0.02 + 0.01 * x.abs());
            told(&gauss_helmert(&p.design, &p.responses, &errors, &noise))
        }),
    );
    unchanged.note(
        "Gauss-Helmert, correlated",
        each(&|p| {
            let size = p.design.ncols() + p.responses.ncols();
            let of = |i: usize| {
                let root = DMatrix::from_fn(size, size, |k, l| {
                    0.02 * (if k == l { 2.0 } else { 0.0 } + ((i + 3 * k + 5 * l) % 7) as f64 / 7.0)
                });
                &root * root.transpose()
            };
            let errors: Vec<_> = (0..p.design.nrows()).map(of).collect();
            told(&gauss_helmert_correlated(&p.design, &p.responses, &errors))
        }),
    );
    unchanged.note(
        "left out",
        each(&|p| {
            let Ok(fit) = least_squares(&p.design, &p.responses, weights(p).as_deref()) else {
                return "none".to_owned();
            };
            let cases: Vec<usize> = (0..p.design.nrows()).map(|i| i / 2 % 9).collect();
            let mut seen = Vec::new();
            let visit = |case, rows: &[usize], left: Option<&DMatrix<f64>>| {
                seen.push((case, rows.to_vec(), left.cloned()));
            };
            let done = leave_out(&p.design, &p.responses, weights(p).as_deref(), &fit, &cases, visit);
            to_ten_digits(&(done, seen))
        }),
    );
    unchanged.note(
        "outliers",
        each(&|p| {
            let names: Vec<String> = (0..p.design.nrows()).map(|i| format!("sample {i}")).collect();
            let labels: Vec<String> = (0..p.responses.ncols()).map(|i| format!("gauge {i}")).collect();
            to_ten_digits(&outliers(&p.design, &p.responses, weights(p).as_deref(), &names, &labels))
        }),
    );
    unchanged.note(
        "temperature",
        each(&|p| {
            let celsius: Vec<f64> =
                (0..p.design.nrows()).map(|i| 20.0 + 3.0 * (i % 5) as f64 - (i % 3) as f64).collect();
            let signals = DMatrix::from_fn(p.responses.nrows(), p.responses.ncols(), |i, j| {
                let warmer = celsius[i] - 22.0;
                p.responses[(i, j)] * (1.0 + 2e-3 * warmer) + 0.01 * warmer + 1e-3 * warmer * warmer
            });
            to_ten_digits(&fit_temperature(&p.design, &signals, weights(p).as_deref(), &celsius, 22.0))
        }),
    );
    unchanged.check();
}

#[test]
fn of_factors_and_plans() {
    let mut unchanged = unchanged("plans");
    let draw = &mut Draw::new(2);
    let problems: Vec<Problem> = (0..16).map(|kind| Problem::drawn(draw, kind)).collect();
    let factors = problems.iter().map(|p| {
        let mut halves = [0, 1].map(|_| Triangular::new(p.design.ncols(), p.responses.ncols()));
        for i in 0..p.design.nrows() {
            let row = |matrix: &DMatrix<f64>| matrix.row(i).iter().copied().collect::<Vec<_>>();
            let weight = p.weights.as_ref().map_or(1.0, |weights| weights[i]);
            halves[i % 2].push_weighted(&row(&p.design), &row(&p.responses), weight);
        }
        let [mut all, other] = halves;
        let merged = all.merge(&other);
        let factors = all.factors();
        let told = (factors.coefficients(), factors.inverse_gram(), factors.residual_covariance());
        to_ten_digits(&(merged, all.samples(), all.refused(), factors.condition_number(), told))
    });
    unchanged.note("triangles", factors);
    let singular = problems.iter().map(|p| {
        let singular = Singular::new(&p.design).map(|s| (s.rank(), s.condition_number(), s.values));
        to_ten_digits(&(singular, pseudo_inverse(&p.design)))
    });
    unchanged.note("singular values", singular);
    for bias in [false, true] {
        let plans = problems.iter().map(|p| {
            let half = p.design.nrows() / 2;
            let (done, left) = (p.design.rows(0, half).into_owned(), p.design.rows(half, half).into_owned());
            let mut information = Information::new(p.design.ncols(), bias);
            for row in done.row_iter() {
                information.add(row.transpose().as_slice());
            }
            let load: DVector<f64> = p.design.row(half).transpose();
            to_ten_digits(&(
                plan(&p.design, bias, 0.3, 400),
                plan_after(&done, &left, bias, 1.0, 60),
                information.rank(&left),
                information.variance(load.as_slice()),
            ))
        });
        unchanged.note(&format!("plans, bias: {bias}"), plans.collect::<Vec<_>>());
    }
    unchanged.check();
}
