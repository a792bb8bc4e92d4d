//! From a table of loads to a calibration.

use alloc::collections::BTreeSet;
use core::cell::RefCell;

use nalgebra::RowDVector;

use crate::Axis;
use crate::creep::{self, Creep, CreepFit};
use crate::curve::Region;
use crate::file::{CalibrationFile, FileError, Quality, Temperature, Verdict};
use crate::fit::{Change, leave_out_changes};
use crate::linear::less;
use crate::loads::{LoadTable, Zeros};
use crate::model::{
    CalibrationError, Curvature, Direction, FittedDrift, Method, Options, SensorModel, design, fit_at_rest,
    fit_model, responses, with_chosen_terms, worth_of_terms,
};
use crate::report::{
    CreepReport, CurveReport, Exclusion, LeftOut, Outlier, Report, axis_reports, outliers_of_fit,
};

/// A calibration, what it was fitted to, and how good it is.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::file::Verdict;
/// use fingertip_calibration::model::Options;
/// use fingertip_calibration::{Calibration, calibrate};
///
/// let calibration: Calibration = calibrate(&table, &Options::default())?;
/// assert_eq!(calibration.report.verdict, Verdict::Good);
/// // 0.5 V on the third gauge, of 0.1 V/N.
/// let newtons = calibration.to_file()?.load(&[0.0, 0.0, 0.5])?;
/// assert!((newtons[2] - 5.0).abs() < 0.01 && newtons[0].abs() < 0.01);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// The fitted sensor.
    pub model: SensorModel,
    /// The samples that it was fitted to: without those excluded, tared if that was asked for.
    pub table: LoadTable,
    /// How the readings creep, if that was asked for and they do; those of the table are without it.
    pub creep: Option<Creep>,
    /// How the readings drift with temperature, if that was asked for.
    pub temperature: Option<Temperature>,
    /// What can be said of it.
    pub report: Report,
}

/// Fits a sensor to known loads, and reports on it.
///
/// A calibration that is not worth having is refused (an error); one that misses the
/// [`Limits`](crate::model::Limits) is stamped as bad in its [`Report`].
///
/// # Errors
/// [`CalibrationError`].
pub fn calibrate(table: &LoadTable, options: &Options) -> Result<Calibration, CalibrationError> {
    calibrate_taking(table.clone(), options)
}

/// As [`calibrate`], of a table that nobody needs afterwards: one of a million samples takes some hundred megabytes.
///
/// # Errors
/// [`CalibrationError`].
pub fn calibrate_taking(mut table: LoadTable, options: &Options) -> Result<Calibration, CalibrationError> {
    table.validate()?;
    let oddities = oddities(&table)?;
    let mut excluded = Vec::new();
    if let Some(range) = options.range {
        let saturated = table.saturated(range);
        for (sample, gauge) in &saturated {
            excluded.push(Exclusion {
                sample: table.names.get(*sample).into_owned(),
                reason: format!(
                    "gauge {} saturated: reading {} is not between {} and {}",
                    gauge + 1,
                    table.signals[(*sample, *gauge)],
                    range[0],
                    range[1]
                ),
            });
        }
        if !saturated.is_empty() {
            let saturated: BTreeSet<usize> = saturated.iter().map(|(sample, _)| *sample).collect();
            table = table.select(|i| !saturated.contains(&i));
            table.validate()?;
        }
    }
    let crept = options.creep.then(|| take_off_creep(&mut table, options)).transpose()?;
    if options.tare_groups {
        table = table.tared_by_group()?;
    }
    let nominal = nominal(&table, options)?;
    let drift = match options.reference_celsius {
        Some(reference) => Some(take_off_drift(&mut table, &nominal, reference)?),
        None => None,
    };
    let (mut options, chosen) = with_chosen_terms(&table, options, &nominal)?;
    let mut model = fit_at_rest(&table, &mut options, &nominal)?;
    leave_out_distrusted(&mut table, &mut model, &options, &mut excluded);
    let mut found = find_outliers(&table, &options, &model);
    let mut influence = None;
    if options.reject_outliers && !found.is_empty() {
        for outlier in &found {
            excluded.push(Exclusion { sample: outlier.sample.clone(), reason: outlier.to_string() });
        }
        table = table.select(|i| found.iter().all(|outlier| outlier.index != i));
        model = fit_at_rest(&table, &mut options, &nominal)?;
        found = Vec::new();
    } else if !found.is_empty() {
        influence = influence_of(&found, &table, &model, &options);
    }
    if let Some(drift) = &drift {
        drift.account(&table, &options, &mut model)?;
    }
    let left_out = left_out_loads(&table, &model, &options)?;
    if !model.terms.is_empty() {
        refuse_over_fitting(&table, &options, &model, &left_out)?;
    }
    let mut report = Report::of_fit(&table, &model, &options, left_out, excluded, (found, influence))?;
    report.curve = match chosen {
        Some(chosen) => Some(CurveReport::new(&chosen, true)),
        // Nobody asked, and a straight sensor will not do.
        None if model.terms.is_empty() && report.verdict == Verdict::Bad => {
            worth_of_terms(&table, &options, &nominal)
                .map(|chosen| CurveReport::new(&chosen, false))
                .filter(CurveReport::is_worth_it)
        }
        None => None,
    };
    let creep = crept.as_ref().map(|(fit, _)| fit.creep.clone()).filter(|creep| !creep.times_s.is_empty());
    if let Some((fit, raw)) = crept {
        // A zero that was taken off since shifts all, which these figures do not mind.
        let predicted = model.loads(&raw.signals).ok_or(CalibrationError::Singular)?;
        let before = axis_reports(&raw, &nominal, &predicted, None);
        report.creep = Some(CreepReport::new(fit, &before, &report.axes));
    }
    if table.temperatures.is_some() && drift.is_none() {
        report.notes.push("temperatures are known but no drift was fitted".to_owned());
    }
    report.reasons.extend(oddities);
    if !report.reasons.is_empty() && report.verdict == Verdict::Good {
        report.verdict = Verdict::Suspect;
    }
    let temperature = drift.map(|drift| drift.fit().temperature.clone());
    Ok(Calibration { model, table, creep, temperature, report })
}

/// What is odd about the table itself: gauges that are dead, too few gauges, torques or forces in another unit.
fn oddities(table: &LoadTable) -> Result<Vec<String>, CalibrationError> {
    let mut found = Vec::new();
    let (gauges, axes, dead) = (table.gauges(), table.axes.len(), table.dead_gauges());
    if !dead.is_empty() {
        let names: Vec<String> = dead
            .iter()
            .map(|(gauge, reading)| format!("gauge {} is dead: it always reads {reading}", gauge + 1))
            .collect();
        let (left, dead) = (gauges - dead.len(), names.join("; "));
        if left < axes {
            return Err(CalibrationError::DeadGauges { dead, left, axes });
        }
        found.push(format!("{dead}; leave its column out"));
    }
    if gauges < axes {
        found.push(format!(
            "{gauges} gauges cannot tell {axes} components apart: leave some out, or add gauges"
        ));
    }
    found.extend(table.odd_lever_arms());
    found.extend(table.odd_sizes());
    Ok(found)
}

/// Finds how the readings creep, and takes it off them; gives the table as it was, too.
fn take_off_creep(
    table: &mut LoadTable,
    options: &Options,
) -> Result<(CreepFit, LoadTable), CalibrationError> {
    let found = creep::fit(table, options.curvature != Curvature::Straight)?;
    let without = found.creep.taken_off(table)?;
    Ok((found, core::mem::replace(table, without)))
}

/// Fits the drift with temperature and brings the readings to the reference temperature.
fn take_off_drift(
    table: &mut LoadTable,
    nominal: &[f64],
    reference: f64,
) -> Result<FittedDrift, CalibrationError> {
    let bad = |message: &str| CalibrationError::BadOption {
        option: "reference_celsius",
        message: message.to_owned(),
    };
    let celsius = table.temperatures.as_ref().ok_or_else(|| bad("the table has no temperatures"))?;
    let fitted = FittedDrift::new(table, nominal, celsius, reference)?;
    let (drift, zero) = (&fitted.fit().temperature, fitted.fit().zero.as_slice());
    for (i, celsius) in celsius.iter().enumerate() {
        let reading: Vec<f64> = table.signals.row(i).iter().copied().collect();
        let reading = drift
            .at_reference(&reading, zero, *celsius)
            .ok_or_else(|| bad("the fitted drift of the gain changes its sign"))?;
        table.signals.set_row(i, &RowDVector::from_vec(reading));
    }
    Ok(fitted)
}

impl Calibration {
    /// As a file, with the quality that the report found.
    ///
    /// # Errors
    /// [`FileError`] if a number is not finite.
    pub fn to_file(&self) -> Result<CalibrationFile, FileError> {
        let mut file = self.model.to_file(&self.report.method)?;
        file.temperature.clone_from(&self.temperature);
        file.creep.clone_from(&self.creep);
        if file.is_curved() {
            // Too few loads tell no more than the linear part.
            file.covariance = self.model.covariance_with_terms(&self.table).or(file.covariance);
            file.region = Region::of(&less(&self.table.signals, &file.zero));
        }
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
    let residuals = &*responses(table, options, &model.nominal)
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
        excluded.push(Exclusion { sample: table.names.get(i).into_owned(), reason });
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
fn find_outliers(table: &LoadTable, options: &Options, model: &SensorModel) -> Vec<Outlier> {
    let x = design(table, options, &model.nominal);
    let y = responses(table, options, &model.nominal);
    // Where zeros were taken off, the fit has been mended by what that did to it.
    let is_plain = options.method == Method::LeastSquares && table.zeros == Zeros::Kept;
    let fit = is_plain.then_some(&model.fit);
    outliers_of_fit(&x, &y, table.weights.as_deref(), fit, &table.names, &response_names(table, options))
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
) -> Result<LeftOut, CalibrationError> {
    let (alone, mut load) = (model.load_of_one(), [0.0; Axis::ALL.len()]);
    let x = design(table, options, &model.nominal);
    let y = responses(table, options, &model.nominal);
    let result = RefCell::new(LeftOut::new(table.samples(), table.axes.len()));
    let one = |sample: usize, change: &Change<'_>| {
        let is_told =
            alone.as_ref().is_some_and(|one| one.changed(change, &table.signals, sample, &mut load));
        if is_told {
            result.borrow_mut().tell(sample, load.iter().take(table.axes.len()));
        }
        is_told
    };
    leave_out_changes(
        &x,
        &y,
        table.weights.as_deref(),
        &model.fit,
        &table.cases,
        one,
        |_, samples, without| {
            let Some(without) = without else { return };
            let Some(loads) = model.loads_with(without, &table.signals.select_rows(samples)) else { return };
            for (row, sample) in samples.iter().enumerate() {
                result.borrow_mut().tell(*sample, loads.row(row).iter());
            }
        },
    )?;
    Ok(result.into_inner())
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
    left_out: &LeftOut,
) -> Result<(), CalibrationError> {
    let error = |left_out: &LeftOut, nominal: &[f64]| {
        left_out.all().map(|known| overall(table, nominal, |i, j| known[(i, j)]))
    };
    let linear_options = Options { curvature: Curvature::Straight, ..options.clone() };
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
