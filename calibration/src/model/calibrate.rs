//! From a table of loads to a calibration.

use nalgebra::{DMatrix, RowDVector};
use thiserror::Error;

use super::sensor_model::{design, normalised, responses};
use super::{Direction, Method, Options, SensorModel};
use crate::file::{CalibrationFile, FileError, Quality, Temperature};
use crate::fit::{
    Fit, FitError, Ransac, fit_temperature, gauss_helmert, huber, least_squares, leave_out, ransac, ridge,
    total_least_squares,
};
use crate::loads::{LoadError, LoadTable};
use crate::report::{Exclusion, Outlier, Report, outliers};

/// A calibration, what it was fitted to, and how good it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// The fitted sensor.
    pub model: SensorModel,
    /// The samples that it was fitted to: without those excluded, tared if that was asked for.
    pub table: LoadTable,
    /// How the readings drift with temperature, if that was asked for.
    pub temperature: Option<Temperature>,
    /// What can be said of it.
    pub report: Report,
}

/// Why there is no calibration.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The table of loads is wrong.
    #[error(transparent)]
    Loads(#[from] LoadError),
    /// The fit has no answer.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The calibration file cannot be used with the table.
    #[error(transparent)]
    File(#[from] FileError),
    /// The options contradict each other or the table.
    #[error("option `{option}`: {message}")]
    BadOption {
        /// Which one.
        option: &'static str,
        /// What is wrong.
        message: String,
    },
    /// A model with more coefficients predicts loads that it has not seen worse than a simpler one.
    #[error(
        "over-fitted: {coefficients} coefficients an axis for {samples} samples leave {fitted:.3} % of full scale on \
         the loads of the fit but {} on loads left out of it; the linear model has {linear:.3} % there",
        percent(*.left_out)
    )]
    OverFitted {
        /// Coefficients per axis.
        coefficients: usize,
        /// Samples.
        samples: usize,
        /// RMS over all axes on the loads of the fit, % of full scale.
        fitted: f64,
        /// RMS over all axes on loads left out, % of full scale; `None` if it cannot be told since
        /// some loads are needed to determine the model at all.
        left_out: Option<f64>,
        /// The same for the linear model.
        linear: f64,
    },
    /// The fitted matrix cannot be inverted.
    #[error("the fitted matrix has no inverse: some load gives no signal")]
    Singular,
}

fn percent(value: Option<f64>) -> String {
    value.map_or_else(|| "an undetermined error".to_owned(), |value| format!("{value:.3} %"))
}

/// Fits a sensor to known loads, and reports on it.
///
/// A calibration that is not worth having is refused (an error); one that misses the
/// [`Limits`](super::Limits) is stamped as bad in its [`Report`].
///
/// # Errors
/// [`CalibrationError`].
pub fn calibrate(table: &LoadTable, options: &Options) -> Result<Calibration, CalibrationError> {
    table.validate()?;
    let mut excluded = Vec::new();
    let mut table = table.clone();
    if let Some(range) = options.range {
        let saturated = table.saturated(range);
        for (sample, gauge) in &saturated {
            excluded.push(Exclusion {
                sample: table.names[*sample].clone(),
                reason: format!(
                    "gauge {} saturated: reading {} is not between {} and {}",
                    gauge + 1,
                    table.signals[(*sample, *gauge)],
                    range[0],
                    range[1]
                ),
            });
        }
        table = table.select(|i| saturated.iter().all(|(sample, _)| *sample != i));
        table.validate()?;
    }
    if options.tare_groups {
        table = table.tared_by_group()?;
    }
    let nominal = nominal(&table, options)?;
    let temperature = match options.reference_celsius {
        Some(reference) => Some(take_off_drift(&mut table, &nominal, reference)?),
        None => None,
    };
    let mut model = fit_model(&table, options, &nominal)?;
    let mut found = find_outliers(&table, options, &nominal)?;
    if options.reject_outliers && !found.is_empty() {
        for outlier in &found {
            excluded.push(Exclusion { sample: outlier.sample.clone(), reason: outlier.to_string() });
        }
        table = table.select(|i| found.iter().all(|outlier| outlier.index != i));
        model = fit_model(&table, options, &nominal)?;
        found = Vec::new();
    }
    let left_out = left_out_loads(&table, &model, options)?;
    if options.quadratic {
        refuse_over_fitting(&table, options, &model, &left_out)?;
    }
    let mut report = Report::of_fit(&table, &model, options, &left_out, excluded, found)?;
    if table.temperatures.is_some() && temperature.is_none() {
        report.notes.push("temperatures are known but no drift was fitted".to_owned());
    }
    Ok(Calibration { model, table, temperature, report })
}

/// Fits the drift with temperature and brings the readings to the reference temperature.
fn take_off_drift(
    table: &mut LoadTable,
    nominal: &[f64],
    reference: f64,
) -> Result<Temperature, CalibrationError> {
    let bad = |message: &str| CalibrationError::BadOption {
        option: "reference_celsius",
        message: message.to_owned(),
    };
    let celsius = table.temperatures.as_ref().ok_or_else(|| bad("the table has no temperatures"))?;
    let fit = fit_temperature(&normalised(&table.loads, nominal), &table.signals, celsius, reference)?;
    let drift = fit.temperature;
    for (i, celsius) in celsius.iter().enumerate() {
        let reading: Vec<f64> = table.signals.row(i).iter().copied().collect();
        let reading = drift
            .at_reference(&reading, fit.zero.as_slice(), *celsius)
            .ok_or_else(|| bad("the fitted drift of the gain changes its sign"))?;
        table.signals.set_row(i, &RowDVector::from_vec(reading));
    }
    Ok(drift)
}

impl Calibration {
    /// As a file, with the quality that the report found.
    ///
    /// # Errors
    /// [`FileError`] if a number is not finite.
    pub fn to_file(&self) -> Result<CalibrationFile, FileError> {
        let mut file = self.model.to_file(&self.report.method)?;
        file.temperature.clone_from(&self.temperature);
        file.quality = Quality {
            verdict: self.report.verdict,
            reasons: self.report.reasons.clone(),
            samples: Some(self.table.samples() as u64),
            condition_number: self.report.condition_number,
            rms_percent: Some(self.report.axes.iter().map(|axis| axis.rms_percent).collect()),
            greatest_percent: Some(self.report.axes.iter().map(|axis| axis.greatest_percent).collect()),
            left_out_percent: self.report.axes.iter().map(|axis| axis.left_out_percent).collect(),
        };
        file.validate()?;
        Ok(file)
    }
}

fn nominal(table: &LoadTable, options: &Options) -> Result<Vec<f64>, CalibrationError> {
    let Some(nominal) = &options.nominal else { return Ok(table.greatest_loads()) };
    let right = nominal.len() == table.axes.len() && nominal.iter().all(|x| *x > 0.0 && x.is_finite());
    if right {
        Ok(nominal.clone())
    } else {
        Err(CalibrationError::BadOption {
            option: "nominal",
            message: format!("one positive load for each of the {} axes is needed", table.axes.len()),
        })
    }
}

fn fit_model(table: &LoadTable, options: &Options, nominal: &[f64]) -> Result<SensorModel, CalibrationError> {
    if options.quadratic && options.direction == Direction::SignalsFromLoads {
        return Err(CalibrationError::BadOption {
            option: "quadratic",
            message: "only loads from signals can have quadratic terms".to_owned(),
        });
    }
    let fit = fit(table, options, nominal).map_err(|error| named(error, table, options))?;
    Ok(SensorModel {
        axes: table.axes.clone(),
        nominal: nominal.to_vec(),
        signal_unit: table.signal_unit,
        direction: options.direction,
        bias: options.bias,
        quadratic: options.quadratic,
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
    if options.quadratic {
        let linear = names.clone();
        for (i, a) in linear.iter().enumerate() {
            names.extend(linear[i..].iter().map(|b| format!("{a}·{b}")));
        }
    }
    if options.bias {
        names.push("constant".to_owned());
    }
    unobserved.names = names;
    FitError::Unobserved(unobserved).into()
}

fn fit(table: &LoadTable, options: &Options, nominal: &[f64]) -> Result<Fit, FitError> {
    let x = design(table, options, nominal);
    let y = responses(table, options, nominal);
    let weights = table.weights.as_deref();
    let forward = options.direction == Direction::SignalsFromLoads;
    let relative =
        |deviations: &[f64]| -> Vec<f64> { deviations.iter().zip(nominal).map(|(s, n)| s / n).collect() };
    let backward = FitError::BadInput { what: "the direction (the method fits signals from loads only)" };
    match &options.method {
        Method::LeastSquares => least_squares(&x, &y, weights),
        Method::Huber => huber(&x, &y, weights),
        Method::Ransac { outliers, seed } => {
            let rough = huber(&x, &y, weights)?;
            let residuals = &y - &x * &rough.coefficients;
            let thresholds = residuals
                .column_iter()
                .zip(y.column_iter())
                .map(|(residual, response)| {
                    let scale = super::deviation(residual.iter().copied(), x.ncols());
                    // Rounding must not make good samples disagree where the fit is exact.
                    (3.5 * scale).max(1e3 * f64::EPSILON * response.amax()).max(f64::MIN_POSITIVE)
                })
                .collect();
            let settings = Ransac { outliers: *outliers, seed: *seed, ..Ransac::new(thresholds) };
            ransac(&x, &y, weights, &settings)
        }
        Method::Total { .. } | Method::GaussHelmert { .. } | Method::Prior { .. } if !forward => {
            Err(backward)
        }
        Method::Total { load_deviations, signal_deviations } => total_least_squares(
            &normalised(&table.loads, nominal),
            &y,
            &relative(load_deviations),
            signal_deviations,
            options.bias,
        ),
        Method::GaussHelmert { load_deviations, relative: share, signal_deviations } => {
            let fixed = relative(load_deviations);
            if fixed.len() != nominal.len() || signal_deviations.len() != y.ncols() {
                return Err(FitError::BadInput { what: "the list of standard deviations" });
            }
            let deviations = DMatrix::from_fn(x.nrows(), x.ncols(), |i, j| {
                // The constant is exact.
                if j < fixed.len() { fixed[j].hypot(share * x[(i, j)]) } else { 0.0 }
            });
            let noise = DMatrix::from_fn(y.nrows(), y.ncols(), |_, j| signal_deviations[j]);
            gauss_helmert(&x, &y, &deviations, &noise)
        }
        Method::Prior { prior, relative } => {
            fit_with_prior(&x, &y, weights, prior, *relative, nominal, options.bias)
        }
    }
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
    let mut variance = residuals.norm_squared() / residuals.len().max(1) as f64;
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

/// Outliers are looked for in the linear least-squares fit whatever the method, so that a robust
/// method does not hide them.
fn find_outliers(
    table: &LoadTable,
    options: &Options,
    nominal: &[f64],
) -> Result<Vec<Outlier>, CalibrationError> {
    let x = design(table, options, nominal);
    let y = responses(table, options, nominal);
    let labels: Vec<String> = match options.direction {
        Direction::SignalsFromLoads => (1..=table.gauges()).map(|i| format!("gauge {i}")).collect(),
        Direction::LoadsFromSignals => table.axes.iter().map(ToString::to_string).collect(),
    };
    Ok(outliers(&x, &y, table.weights.as_deref(), &table.names, &labels))
}

/// For each sample the load that a fit without its case tells of; `None` where the other cases do
/// not determine it.
fn left_out_loads(
    table: &LoadTable,
    model: &SensorModel,
    options: &Options,
) -> Result<Vec<Option<Vec<f64>>>, CalibrationError> {
    let x = design(table, options, &model.nominal);
    let y = responses(table, options, &model.nominal);
    let mut result = vec![None; table.samples()];
    leave_out(&x, &y, table.weights.as_deref(), &model.fit, &table.cases, |_, samples, without| {
        let Some(without) = without else { return };
        let Some(loads) = model.loads_with(without, &table.signals.select_rows(samples)) else { return };
        for (row, sample) in samples.iter().enumerate() {
            result[*sample] = Some(loads.row(row).iter().copied().collect());
        }
    })?;
    Ok(result)
}

/// RMS over all axes and samples, % of full scale.
fn overall(table: &LoadTable, nominal: &[f64], predicted: impl Fn(usize, usize) -> f64) -> f64 {
    let mut sum = 0.0;
    for i in 0..table.samples() {
        for (j, full_scale) in nominal.iter().enumerate() {
            sum += ((predicted(i, j) - table.loads[(i, j)]) / full_scale).powi(2);
        }
    }
    100.0 * (sum / (table.samples() * table.axes.len()) as f64).sqrt()
}

fn refuse_over_fitting(
    table: &LoadTable,
    options: &Options,
    model: &SensorModel,
    left_out: &[Option<Vec<f64>>],
) -> Result<(), CalibrationError> {
    let error = |left_out: &[Option<Vec<f64>>], nominal: &[f64]| {
        let known: Option<Vec<&Vec<f64>>> = left_out.iter().map(Option::as_ref).collect();
        known.map(|known| overall(table, nominal, |i, j| known[i][j]))
    };
    let linear_options = Options { quadratic: false, ..options.clone() };
    let linear = fit_model(table, &linear_options, &model.nominal)?;
    let linear_left_out = left_out_loads(table, &linear, &linear_options)?;
    let Some(linear) = error(&linear_left_out, &model.nominal) else { return Ok(()) };
    let quadratic = error(left_out, &model.nominal);
    if quadratic.is_some_and(|quadratic| quadratic < linear) {
        return Ok(());
    }
    let loads = model.loads(&table.signals).ok_or(CalibrationError::Singular)?;
    Err(CalibrationError::OverFitted {
        coefficients: model.fit.coefficients.nrows(),
        samples: table.samples(),
        fitted: overall(table, &model.nominal, |i, j| loads[(i, j)]),
        left_out: quadratic,
        linear,
    })
}
