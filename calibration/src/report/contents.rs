//! What can be said of a calibration.

use alloc::borrow::Cow;
use alloc::collections::BTreeMap;

use nalgebra::DMatrix;
use serde::Serialize;

use super::contact::{ContactReport, contact_report};
use super::creep::CreepReport;
use super::curve::CurveReport;
use super::exclusion::Exclusion;
use super::metrics::{AxisReport, LineReport, axis_reports, cross_talk, lines};
use super::outliers::{Outlier, outliers};
use super::predicted::{beyond, predicted};
use super::samples::{LeftOut, Samples};
use super::suspicion::{Suspicion, suspicions};
use super::words::{describe, worst_first};
use crate::design::TouchSet;
use crate::file::{CalibrationFile, Verdict};
use crate::linear::{Singular, pseudo_inverse};
use crate::loads::LoadTable;
use crate::model::{CalibrationError, Curvature, Limits, Options, SensorModel};

/// Loads that reach less of full scale than this are said to.
const COVERED: f64 = 0.75;

/// What can be said of a calibration: written to a terminal by `Display`, as HTML with plots by
/// [`to_html`](Self::to_html), as JSON by [`to_json`](Self::to_json).
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::file::Verdict;
/// use fingertip_calibration::report::Report;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// let report: Report = calibrate(&table, &Options::default())?.report;
/// assert_eq!((report.verdict, report.samples, report.axes.len()), (Verdict::Good, 60, 3));
/// assert!(report.condition_number.is_some_and(|number| number < 1.01) && report.outliers.is_empty());
/// // For the terminal, as a page, and for programs.
/// assert!(report.to_string().contains("condition number"));
/// assert!(report.to_html("Force sensor", &[("serial", "FT-0042".into())]).contains("FT-0042"));
/// assert!(report.to_json()?.contains("\"verdict\""));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// How the calibration was fitted.
    pub method: String,
    /// Whether it can be trusted.
    pub verdict: Verdict,
    /// Why not.
    pub reasons: Vec<String>,
    /// What to mind although it can.
    pub notes: Vec<String>,
    /// How many samples and load cases stand behind it.
    pub samples: usize,
    /// How many load cases.
    pub cases: usize,
    /// Coefficients per gauge (or per axis, for loads from signals).
    pub coefficients: usize,
    /// Condition number N_c of the normalised sensor matrix; `None` if infinite.
    pub condition_number: Option<f64>,
    /// Errors axis by axis.
    pub axes: Vec<AxisReport>,
    /// Cross-talk, % of full scale: row = axis that reads falsely, column = axis loaded alone.
    pub cross_talk_percent: Vec<Vec<Option<f64>>>,
    /// The normalised matrix, gauges × axes, in signals.
    pub matrix: Option<Vec<Vec<f64>>>,
    /// Standard deviation of its entries.
    pub matrix_deviations: Option<Vec<Vec<f64>>>,
    /// How the readings creep, if that was asked for: all else is said of readings without it.
    pub creep: Option<CreepReport>,
    /// What terms of higher order are worth, if they were chosen, or if the sensor is bad without.
    pub curve: Option<CurveReport>,
    /// How well lines of action are found.
    pub lines: Option<LineReport>,
    /// What the uncertainty of the calibration does to contact points of a given surface.
    pub contacts: Option<ContactReport>,
    /// Samples that were left out, and why.
    pub excluded: Vec<Exclusion>,
    /// Samples that do not fit the others but were kept.
    pub outliers: Vec<Outlier>,
    /// By how much the loads that this calibration tells of would change at most if the outliers were
    /// left out, % of full scale, over the other samples; `None` if there are no outliers, if it is no
    /// fit, or if the loads without them do not determine the sensor.
    pub outlier_influence_percent: Option<f64>,
    /// Cases without which the fit would not be determined, so that nothing can be said of their error.
    pub needed_cases: Vec<String>,
    /// Mistakes that would explain the errors.
    pub suspicions: Vec<Suspicion>,
    /// Every sample: what it was and what the sensor says.
    pub details: Samples,
}

impl Report {
    /// Of a fit, on the loads that it was fitted to.
    pub(crate) fn of_fit(
        table: &LoadTable,
        model: &SensorModel,
        options: &Options,
        left_out: LeftOut,
        excluded: Vec<Exclusion>,
        (outliers, influence): (Vec<Outlier>, Option<f64>),
    ) -> Result<Self, CalibrationError> {
        let predicted = model.loads(&table.signals).ok_or(CalibrationError::Singular)?;
        let mut report = Self::of_loads(table, &model.nominal, predicted, Some(left_out));
        report.method = describe(options);
        report.coefficients = model.fit.coefficients.nrows();
        report.condition_number = Some(model.condition_number()).filter(|number| number.is_finite());
        report.excluded = excluded;
        report.outliers = outliers;
        report.outlier_influence_percent = influence;
        let covariance = model.load_covariance();
        report.lines = lines(table, &model.nominal, &report.details.measured, |load| {
            Some(covariance.as_ref()?.at(load))
        });
        if let Some(covariance) = &covariance {
            let covariance = covariance.at(&[]);
            for (j, axis) in report.axes.iter_mut().enumerate() {
                axis.deviation_percent = Some(100.0 * covariance[(j, j)].max(0.0).sqrt() / axis.full_scale);
            }
        }
        if let (Some(set), Some(covariance)) = (&options.touches, model.covariance()) {
            let matrix = model.matrix_and_zero()?.0;
            report.contacts = contact_report(&model.axes, &matrix, &model.nominal, &covariance, set);
        }
        report.matrix = model
            .matrix_and_zero()
            .ok()
            .map(|(matrix, _)| matrix.row_iter().map(|row| row.iter().copied().collect()).collect());
        report.matrix_deviations = model.covariance().map(|covariance| {
            let entry = |i: usize, j: usize| {
                covariance.between((i, j), (i, j)).map_or(f64::NAN, |variance| variance.max(0.0).sqrt())
            };
            (0..model.gauges()).map(|i| (0..table.axes.len()).map(|j| entry(i, j)).collect()).collect()
        });
        // Terms that were chosen by what they say of loads left out are not too many, whatever they say of the others.
        let over_fitting = match options.curvature {
            Curvature::Given { .. } => f64::INFINITY,
            _ => options.limits.over_fitting,
        };
        report.judge(&Limits { over_fitting, ..options.limits });
        Ok(report)
    }

    /// Of a calibration on loads that it was not fitted to: the true test.
    ///
    /// The readings are used as they stand, less the file's zero; tare the table first
    /// ([`LoadTable::tared_by_group`]) if the sensor was tared, and set the file's zero to zeros.
    ///
    /// # Errors
    /// [`CalibrationError::BadOption`] if sensor and table have not the same gauges and axes,
    /// [`CalibrationError::Loads`] for a bad table, [`CalibrationError::File`] if the calibration needs
    /// the temperature of the samples and the table has none, [`CalibrationError::Singular`].
    pub fn of_check(
        file: &CalibrationFile,
        table: &LoadTable,
        limits: &Limits,
        touches: Option<&TouchSet>,
    ) -> Result<Self, CalibrationError> {
        table.validate()?;
        if file.gauges() != table.gauges() || file.axes != table.axes {
            return Err(CalibrationError::BadOption {
                option: "table",
                message: format!(
                    "it has {} gauges and {} axes, the calibration {} and {}",
                    table.gauges(),
                    table.axes.len(),
                    file.gauges(),
                    file.axes.len()
                ),
            });
        }
        let saturated = table.saturated(file.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]));
        let saturated =
            saturated.into_iter().map(|(sample, gauge)| (sample, format!("gauge {} saturated", gauge + 1)));
        let unusable: BTreeMap<usize, String> = beyond(file, table)?.into_iter().chain(saturated).collect();
        let excluded = unusable
            .iter()
            .map(|(sample, reason)| Exclusion {
                sample: table.names.get(*sample).into_owned(),
                reason: reason.clone(),
            })
            .collect();
        let mut kept = Cow::Borrowed(table);
        if !unusable.is_empty() {
            kept = Cow::Owned(table.select(|i| !unusable.contains_key(&i)));
            kept.validate()?;
        }
        let table = &*kept;
        let inverse = pseudo_inverse(&file.matrix).ok_or(CalibrationError::Singular)?;
        let predicted = predicted(file, table, &inverse)?;
        let mut report = Self::of_loads(table, &file.nominal, predicted, None);
        let predicted = &report.details.measured;
        report.method = format!("check of a calibration by {}", file.provenance.method);
        report.excluded = excluded;
        report.condition_number =
            Singular::new(&file.matrix).map(|s| s.condition_number()).filter(|number| number.is_finite());
        report.lines = lines(table, &file.nominal, predicted, |_| None);
        if let (Some(set), Some(covariance)) = (touches, &file.covariance) {
            report.contacts = contact_report(&file.axes, &file.matrix, &file.nominal, covariance, set);
        }
        if table.temperatures.is_some() && file.temperature.is_none() {
            report.notes.push("temperatures are known, but the calibration has no terms for them".to_owned());
        }
        report.suspicions = suspicions(file, table, predicted);
        // A sample that stands out of the errors of the others, whatever these have in common.
        let labels: Vec<String> = table.axes.iter().map(ToString::to_string).collect();
        let constant = DMatrix::from_element(table.samples(), 1, 1.0);
        report.outliers =
            outliers(&constant, &(predicted - &table.loads), table.weights.as_deref(), &table.names, &labels);
        report.judge(limits);
        if matches!(file.quality.verdict, Verdict::Bad | Verdict::Suspect) {
            report.notes.push(format!(
                "the file itself is stamped as {}: {}",
                file.quality.verdict.name(),
                file.quality.reasons.join("; ")
            ));
        }
        Ok(report)
    }

    /// What holds of any predictions.
    fn of_loads(
        table: &LoadTable,
        full_scale: &[f64],
        predicted: DMatrix<f64>,
        left_out: Option<LeftOut>,
    ) -> Self {
        let mut cases = table.cases.clone();
        cases.sort_unstable();
        cases.dedup();
        let untold =
            |list: &LeftOut| list.untold().map(|sample| table.names.get(sample).into_owned()).collect();
        Self {
            method: String::new(),
            verdict: Verdict::Unchecked,
            reasons: Vec::new(),
            notes: Vec::new(),
            samples: table.samples(),
            cases: cases.len(),
            coefficients: 0,
            condition_number: None,
            axes: axis_reports(table, full_scale, &predicted, left_out.as_ref()),
            cross_talk_percent: cross_talk(table, full_scale, &predicted),
            matrix: None,
            matrix_deviations: None,
            creep: None,
            curve: None,
            lines: None,
            contacts: None,
            excluded: Vec::new(),
            outliers: Vec::new(),
            outlier_influence_percent: None,
            needed_cases: left_out.as_ref().map_or_else(Vec::new, untold),
            suspicions: Vec::new(),
            details: Samples {
                names: table.names.clone(),
                applied: table.loads.clone(),
                measured: predicted,
                left_out,
            },
        }
    }

    /// Good, suspect or bad, and why.
    fn judge(&mut self, limits: &Limits) {
        self.reasons = worst_first(self.shortfalls(limits));
        match self.excluded.len() {
            0 => {}
            1 => self.notes.push("1 sample was left out".to_owned()),
            number => self.notes.push(format!("{number} samples were left out")),
        }
        for (j, axis) in self.axes.iter().enumerate() {
            let greatest = self.details.applied.column(j).amax();
            if greatest < COVERED * axis.full_scale {
                self.notes.push(format!(
                    "{}: the loads reach {:.0} % of full scale, beyond which nothing is checked",
                    axis.axis,
                    100.0 * greatest / axis.full_scale
                ));
            }
        }
        for suspicion in &self.suspicions {
            self.reasons.push(suspicion.to_string());
        }
        self.verdict = if self.reasons.is_empty() { Verdict::Good } else { Verdict::Bad };
        self.doubt(limits);
    }

    /// What misses a limit, and by how many times.
    fn shortfalls(&self, limits: &Limits) -> Vec<(f64, String)> {
        let mut found = Vec::new();
        for axis in &self.axes {
            let (error, kind) = match axis.left_out_percent {
                Some(error) => (error, "on loads left out of the fit"),
                None => (axis.rms_percent, "on these loads"),
            };
            let times = error / limits.left_out_percent;
            if !(error <= limits.left_out_percent) {
                let text = format!(
                    "{}: {error:.2} % of full scale {kind}; {} % is allowed",
                    axis.axis, limits.left_out_percent
                );
                found.push((times, text));
            }
            if let Some(left_out) = axis.left_out_percent
                && left_out > limits.over_fitting * axis.rms_percent
                // Below a tenth of what is allowed nobody minds.
                && left_out > 0.1 * limits.left_out_percent
            {
                let text = format!(
                    "{}: over-fitted: {left_out:.2} % on loads left out of the fit, {:.2} % on those in it",
                    axis.axis, axis.rms_percent
                );
                found.push((times, text));
            }
        }
        match self.condition_number {
            Some(number) if number <= limits.condition_number => {}
            Some(number) => {
                let text =
                    format!("ill-conditioned: N_c = {number:.0}; {:.0} is allowed", limits.condition_number);
                found.push((number / limits.condition_number, text));
            }
            None => found.push((f64::INFINITY, "the sensor matrix is singular".to_owned())),
        }
        if !self.needed_cases.is_empty() {
            let text = format!(
                "nothing checks {}: without it, the other loads do not determine the sensor",
                self.needed_cases.join(", ")
            );
            found.push((1.0, text));
        }
        found
    }

    /// What the outliers that were kept make of a good calibration: a gross one may be a bad reading or a
    /// bad sensor, and the RMS over many samples shows neither.
    fn doubt(&mut self, limits: &Limits) {
        let mut doubts = Vec::new();
        for outlier in &self.outliers {
            let text = format!("{}: {outlier}", outlier.sample);
            let error = self.details.get(outlier.index).map_or(0.0_f64, |sample| {
                let errors = sample.measured.iter().zip(&sample.applied).zip(&self.axes);
                errors.fold(0.0_f64, |most, ((m, a), axis)| most.max(100.0 * (m - a).abs() / axis.full_scale))
            });
            if error <= limits.left_out_percent {
                self.notes.push(text);
            } else {
                doubts.push(format!(
                    "{text}; it is read wrong by {error:.2} % of full scale, {} % is allowed",
                    limits.left_out_percent
                ));
            }
        }
        // An outlier of high leverage draws the fit to itself, so that its own error is small.
        if let Some(influence) = self.outlier_influence_percent {
            let text = format!(
                "without the {} the sensor would read otherwise by up to {influence:.2} % of full scale",
                if self.outliers.len() == 1 { "outlier" } else { "outliers" }
            );
            if influence <= limits.left_out_percent { self.notes.push(text) } else { doubts.push(text) }
        }
        if !doubts.is_empty() && self.verdict == Verdict::Good {
            self.verdict = Verdict::Suspect;
        }
        self.reasons.extend(doubts);
    }

    /// As JSON.
    ///
    /// # Errors
    /// Only if memory runs out; every number is finite or `null`.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self)
    }
}
