//! From a table of loads to a calibration.

use nalgebra::{DMatrix, RowDVector};
use thiserror::Error;

use super::sensor_model::{design, normalised, responses};
use super::zeros::account_for_zeros;
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
    leave_out_distrusted(&mut table, &mut model, options, &mut excluded);
    let mut found = find_outliers(&table, options, &nominal);
    let mut influence = None;
    if options.reject_outliers && !found.is_empty() {
        for outlier in &found {
            excluded.push(Exclusion { sample: outlier.sample.clone(), reason: outlier.to_string() });
        }
        table = table.select(|i| found.iter().all(|outlier| outlier.index != i));
        model = fit_model(&table, options, &nominal)?;
        found = Vec::new();
    } else if !found.is_empty() {
        influence = influence_of(&found, &table, &model, options);
    }
    let left_out = left_out_loads(&table, &model, options)?;
    if options.quadratic {
        refuse_over_fitting(&table, options, &model, &left_out)?;
    }
    let mut report = Report::of_fit(&table, &model, options, &left_out, excluded, (found, influence))?;
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
    let mut fit = fit(table, options, nominal).map_err(|error| named(error, table, options))?;
    let squares = matches!(options.method, Method::LeastSquares | Method::Ransac { .. });
    if squares && options.direction == Direction::SignalsFromLoads {
        account_for_zeros(table, &design(table, options, nominal), &mut fit);
    }
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
        Method::Ransac { outliers, seed } => fit_agreeing(&x, &y, weights, *outliers, *seed),
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

/// Residuals of agreeing samples are less than so many standard deviations.
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
    let mut bulk: Vec<f64> = residuals
        .column_iter()
        .map(|residual| super::deviation(residual.iter().copied(), x.ncols()))
        .collect();
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

/// Takes the samples that RANSAC did not fit out of the table, by name: they are no part of the
/// calibration, so its errors are not those of it either.
fn leave_out_distrusted(
    table: &mut LoadTable,
    model: &mut SensorModel,
    options: &Options,
    excluded: &mut Vec<Exclusion>,
) {
    let trust = &model.fit.trust;
    let trusted: Vec<usize> =
        (0..trust.nrows()).filter(|i| trust.row(*i).iter().any(|trust| *trust > 0.0)).collect();
    if trusted.len() == trust.nrows() {
        return;
    }
    let residuals = responses(table, options, &model.nominal)
        - design(table, options, &model.nominal) * &model.fit.coefficients;
    let labels = response_names(table, options);
    for i in (0..trust.nrows()).filter(|i| trusted.binary_search(i).is_err()) {
        let deviations = |j: usize| {
            let deviation = model.fit.residual_covariance[(j, j)].sqrt().max(f64::MIN_POSITIVE);
            residuals[(i, j)].abs() / deviation
        };
        let worst = (0..residuals.ncols()).max_by(|a, b| deviations(*a).total_cmp(&deviations(*b)));
        let Some(worst) = worst else { continue };
        let reason = format!(
            "{}: {} is off by {:.1} standard deviations of the samples that agree",
            options.method.name(),
            labels[worst],
            deviations(worst)
        );
        excluded.push(Exclusion { sample: table.names[i].clone(), reason });
    }
    *table = table.select(|i| trusted.binary_search(&i).is_ok());
    model.fit.trust = model.fit.trust.select_rows(&trusted);
}

/// Gauges, or axes where loads are fitted to signals.
fn response_names(table: &LoadTable, options: &Options) -> Vec<String> {
    match options.direction {
        Direction::SignalsFromLoads => (1..=table.gauges()).map(|i| format!("gauge {i}")).collect(),
        Direction::LoadsFromSignals => table.axes.iter().map(ToString::to_string).collect(),
    }
}

/// Outliers are looked for in the linear least-squares fit whatever the method, so that a robust
/// method does not hide them.
fn find_outliers(table: &LoadTable, options: &Options, nominal: &[f64]) -> Vec<Outlier> {
    let x = design(table, options, nominal);
    let y = responses(table, options, nominal);
    outliers(&x, &y, table.weights.as_deref(), &table.names, &response_names(table, options))
}

/// By how much the other samples would be read otherwise without the outliers, at most, % of full scale.
/// `None` if the others do not determine the sensor.
fn influence_of(
    outliers: &[Outlier],
    table: &LoadTable,
    model: &SensorModel,
    options: &Options,
) -> Option<f64> {
    let rest = table.select(|i| outliers.iter().all(|outlier| outlier.index != i));
    let without = fit_model(&rest, options, &model.nominal).ok()?.loads(&rest.signals)?;
    let change = (model.loads(&rest.signals)? - without).abs();
    let sizes = change.column_iter().zip(&model.nominal).map(|(column, full)| column.max() / full);
    Some(100.0 * sizes.fold(0.0, f64::max))
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
