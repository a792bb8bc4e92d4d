//! The fit of a sensor to a table of loads, by each of the methods.

use nalgebra::DMatrix;

use super::sensor_model::{design, normalised, responses};
use super::zeros::account_for_zeros;
use super::{CalibrationError, Direction, Method, Options, SensorModel};
use crate::file::CalibrationFile;
use crate::fit::{
    Fit, FitError, Ransac, deviation, gauss_helmert_of_shares, huber, least_squares, ransac, ridge,
    total_least_squares,
};
use crate::loads::{LoadTable, Zeros};

/// Fits a sensor to a table, by the method of the options.
pub(crate) fn fit_model(
    table: &LoadTable,
    options: &Options,
    nominal: &[f64],
) -> Result<SensorModel, CalibrationError> {
    let gauges = table.gauges();
    options.check_curvature()?;
    let (terms, origin) = (options.curvature.terms(gauges), options.curvature.origin(gauges));
    if origin.len() != gauges || terms.values(&origin).iter().any(|value| !value.is_finite()) {
        return Err(CalibrationError::BadOption {
            option: "curvature",
            message: format!("its terms are not those of {gauges} gauges"),
        });
    }
    let mut fit = fit(table, options, nominal).map_err(|error| named(error, table, options))?;
    let squares = matches!(options.method, Method::LeastSquares | Method::Ransac { .. });
    if squares && options.direction == Direction::SignalsFromLoads && table.zeros != Zeros::Kept {
        account_for_zeros(table, &design(table, options, nominal), &mut fit);
    }
    Ok(SensorModel {
        axes: table.axes.clone(),
        nominal: nominal.to_vec(),
        signal_unit: table.signal_unit,
        direction: options.direction,
        bias: options.bias,
        terms,
        origin,
        fit,
    })
}

/// Gives unobserved directions the names of the axes or gauges.
fn named(error: FitError, table: &LoadTable, options: &Options) -> CalibrationError {
    let FitError::Unobserved(mut unobserved) = error else { return error.into() };
    let mut names: Vec<String> = match options.direction {
        Direction::SignalsFromLoads => table.axes.iter().map(ToString::to_string).collect(),
        Direction::LoadsFromSignals => (1..=table.gauges()).map(|i| format!("v{i}")).collect(),
    };
    names.extend(options.curvature.terms(table.gauges()).names());
    if options.bias {
        names.push("constant".to_owned());
    }
    unobserved.names = names;
    FitError::Unobserved(unobserved).into()
}

fn fit(table: &LoadTable, options: &Options, nominal: &[f64]) -> Result<Fit, FitError> {
    let x = design(table, options, nominal);
    let responses = responses(table, options, nominal);
    let y = &*responses;
    let weights = table.weights.as_deref();
    let forward = options.direction == Direction::SignalsFromLoads;
    let deviations = FitError::BadInput { what: "the list of standard deviations" };
    let relative = |list: &[f64]| -> Result<Vec<f64>, FitError> {
        if list.len() != nominal.len() {
            return Err(deviations.clone());
        }
        Ok(list.iter().zip(nominal).map(|(s, n)| s / n).collect())
    };
    let backward = FitError::BadInput { what: "the direction (the method fits signals from loads only)" };
    match &options.method {
        Method::LeastSquares => least_squares(&x, y, weights),
        Method::Huber => huber(&x, y, weights),
        Method::Ransac { outliers, seed } => fit_agreeing(&x, y, weights, *outliers, *seed),
        Method::Total { .. } | Method::GaussHelmert { .. } | Method::Prior { .. } if !forward => {
            Err(backward)
        }
        Method::Total { load_deviations, signal_deviations } => total_least_squares(
            &normalised(&table.loads, nominal),
            y,
            &relative(load_deviations)?,
            signal_deviations,
            options.bias,
        ),
        Method::GaussHelmert { load_deviations, relative: share, signal_deviations } => {
            let fixed = relative(load_deviations)?;
            if signal_deviations.len() != y.ncols() {
                return Err(deviations);
            }
            // The constant, behind the loads, is exact.
            let own = |of: &dyn Fn(usize) -> f64| {
                DMatrix::from_fn(x.nrows(), x.ncols(), |_, j| if j < fixed.len() { of(j) } else { 0.0 })
            };
            let noise = DMatrix::from_fn(y.nrows(), y.ncols(), |_, j| signal_deviations[j]);
            gauss_helmert_of_shares(&x, y, (&own(&|j| fixed[j]), &own(&|_| *share)), &noise)
        }
        Method::Prior { prior, relative } => {
            fit_with_prior(&x, y, weights, prior, *relative, nominal, options.bias)
        }
    }
}

/// Samples agree whose residuals are below this number of standard deviations.
const AGREEING: f64 = 3.5;

/// RANSAC whose thresholds come from the data: first the least multiple of the bulk's deviation at which as
/// many samples agree as are said to be good, then those that agree within the deviation of these (Rousseeuw &
/// Leroy 1987). The deviation of the bulk alone is too small where few samples have most of the errors, as with
/// loads along one axis after another.
fn fit_agreeing(
    x: &DMatrix<f64>,
    y: &DMatrix<f64>,
    weights: Option<&[f64]>,
    outliers: f64,
    seed: u64,
) -> Result<Fit, FitError> {
    const WIDEST: f64 = 8.0;
    // Rounding must not make good samples disagree where the fit is exact.
    let floors: Vec<f64> = y
        .column_iter()
        .map(|response| (1e3 * f64::EPSILON * response.amax()).max(f64::MIN_POSITIVE))
        .collect();
    let agreeing = |deviations: &[f64]| {
        let thresholds = deviations.iter().zip(&floors).map(|(s, floor)| (AGREEING * s).max(*floor));
        ransac(x, y, weights, &Ransac { outliers, seed, ..Ransac::new(thresholds.collect()) })
    };
    let residuals = y - x * &huber(x, y, weights)?.coefficients;
    let counts = |i: usize| weights.is_none_or(|weights| weights[i] > 0.0);
    let of_counted = |residual: nalgebra::DVectorView<'_, f64>| {
        let counted = residual.iter().enumerate().filter(|(i, _)| counts(*i)).map(|(_, r)| *r);
        deviation(counted, x.ncols())
    };
    let mut bulk: Vec<f64> = residuals.column_iter().map(of_counted).collect();
    let mut widened = 1.0;
    let fit = loop {
        match agreeing(&bulk) {
            Err(FitError::NoConsensus { .. }) if widened < WIDEST => {
                widened *= core::f64::consts::SQRT_2;
                bulk.iter_mut().for_each(|deviation| *deviation *= core::f64::consts::SQRT_2);
            }
            answer => break answer?,
        }
    };
    let own: Vec<f64> = fit.residual_covariance.diagonal().iter().map(|variance| variance.sqrt()).collect();
    Ok(agreeing(&own).unwrap_or(fit))
}

/// The noise that scales the prior is taken from the residuals of the fit itself.
fn fit_with_prior(
    x: &DMatrix<f64>,
    y: &DMatrix<f64>,
    weights: Option<&[f64]>,
    prior: &CalibrationFile,
    relative: f64,
    nominal: &[f64],
    bias: bool,
) -> Result<Fit, FitError> {
    let axes = nominal.len();
    if prior.matrix.shape() != (y.ncols(), axes) || !(relative > 0.0) {
        return Err(FitError::BadInput { what: "the earlier calibration" });
    }
    let mut center =
        DMatrix::from_fn(axes, y.ncols(), |i, j| prior.matrix[(j, i)] * nominal[i] / prior.nominal[i]);
    let entry = center.norm() / (center.len() as f64).sqrt();
    if bias {
        center = center.insert_row(axes, 0.0);
        for (j, zero) in prior.zero.iter().enumerate() {
            center[(axes, j)] = *zero;
        }
    }
    let residuals = y - x * &center;
    let mut variance = residuals.norm_squared() / residuals.len() as f64;
    let mut fit = None;
    for _ in 0..20 {
        let mut precision =
            DMatrix::from_diagonal_element(x.ncols(), x.ncols(), variance / (relative * entry).powi(2));
        if bias {
            // Nobody expects a zero to stay: its prior is a hundred times as wide.
            precision[(axes, axes)] *= 1e-4;
        }
        precision.iter_mut().step_by(x.ncols() + 1).for_each(|p| *p = p.max(f64::MIN_POSITIVE * 1e20));
        let next = ridge(x, y, weights, &center, &precision)?;
        variance = next.residual_covariance.trace() / y.ncols() as f64;
        fit = Some(next);
    }
    fit.ok_or(FitError::BadInput { what: "the earlier calibration" })
}
