//! The fit of a curved sensor: which terms, and of which origin.

use alloc::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::fitting::fit_model;
use super::sensor_model::normalised;
use super::{CalibrationError, Curvature, Direction, Options, SensorModel};
use crate::curve::{Chosen, choose};
use crate::file::Covariance;
use crate::fit::least_squares;
use crate::linear::less;
use crate::loads::{LoadTable, spread};

/// With [`Curvature::Chosen`], the options of the terms that are chosen, and what they are worth.
///
/// # Errors
/// [`CalibrationError::BadOption`] if signals are fitted to loads, or there are too few load cases; as [`fit_model`].
pub(crate) fn with_chosen_terms(
    table: &LoadTable,
    options: &Options,
    nominal: &[f64],
) -> Result<(Options, Option<Chosen>), CalibrationError> {
    let mut options = options.clone();
    if options.curvature != Curvature::Chosen {
        return Ok((options, None));
    }
    let bad =
        |message: &str| CalibrationError::BadOption { option: "curvature", message: message.to_owned() };
    options.check_curvature()?;
    let many = table.samples() > MOST_SAMPLES;
    let table = &*match many {
        true => Cow::Owned(table.rows(&spread(table.samples(), MOST_SAMPLES))),
        false => Cow::Borrowed(table),
    };
    let mut origin = match options.bias {
        true => fit_model(table, &options, nominal)?.matrix_and_zero()?.1.as_slice().to_vec(),
        false => vec![0.0; table.gauges()],
    };
    let loads = normalised(&table.loads, nominal);
    let mut left = ROUNDS;
    loop {
        let chosen = choose(table, &loads, &origin, options.bias).ok_or_else(|| {
            bad("the terms of a curved sensor are chosen by leaving out load cases, and there are too few")
        })?;
        left -= 1;
        if chosen.terms.is_empty() {
            options.curvature = Curvature::Straight;
            return Ok((options, Some(chosen)));
        }
        options.curvature =
            Curvature::Given { terms: Box::new(chosen.terms.clone()), origin: origin.clone() };
        fit_at_rest(table, &mut options, nominal)?;
        let settled = options.curvature.origin(table.gauges());
        // A product of signals about another origin is that product and others.
        if left == 0 || !has_moved(table, &origin, &settled, MOVED) {
            return Ok((options, Some(chosen)));
        }
        origin = settled;
    }
}

/// Of more samples than this, as many that are spread over all are chosen by.
const MOST_SAMPLES: usize = 2_000;
/// The terms are chosen so many times at most, each time about the zero that the last choice tells.
const ROUNDS: usize = 6;
/// An origin has moved if it did by this share of what a gauge read.
const MOVED: f64 = 1e-6;

/// Whether an origin has moved for any gauge by more than a share of the span of its readings.
fn has_moved(table: &LoadTable, before: &[f64], now: &[f64], share: f64) -> bool {
    let steps = before.iter().zip(now).map(|(before, now)| (now - before).abs());
    let spans = table.signals.column_iter().map(|readings| readings.max() - readings.min());
    steps.zip(spans).any(|(step, span)| !(step <= share * span))
}

/// What chosen terms would be worth, for a sensor that was fitted without.
pub(crate) fn worth_of_terms(table: &LoadTable, options: &Options, nominal: &[f64]) -> Option<Chosen> {
    let curved =
        Options { direction: Direction::LoadsFromSignals, curvature: Curvature::Chosen, ..options.clone() };
    with_chosen_terms(table, &curved, nominal).ok()?.1.filter(|chosen| !chosen.terms.is_empty())
}

/// Fits the sensor. That of given terms is fitted again and again, each time from the reading without load that the last
/// fit tells as the origin, until that stays where it is: then the terms vanish without load, as a tare wants it. The places
/// of bumps stay where they are among the readings.
///
/// # Errors
/// As [`fit_model`]; [`CalibrationError::BadOption`] if the origin does not come to rest.
pub(crate) fn fit_at_rest(
    table: &LoadTable,
    options: &mut Options,
    nominal: &[f64],
) -> Result<SensorModel, CalibrationError> {
    const STEPS: usize = 60;
    const CLOSE: f64 = 1e-10;
    let mut model = fit_model(table, options, nominal)?;
    for _ in 0..STEPS {
        let Curvature::Given { terms, origin } = &mut options.curvature else { return Ok(model) };
        if !options.bias {
            return Ok(model);
        }
        let zero = model.matrix_and_zero()?.1;
        if !has_moved(table, origin, zero.as_slice(), CLOSE) {
            return Ok(model);
        }
        for centre in &mut terms.centres {
            let moves = zero.iter().zip(&*origin).map(|(zero, origin)| zero - origin);
            centre.iter_mut().zip(moves).for_each(|(place, step)| *place -= step);
        }
        *origin = zero.as_slice().to_vec();
        model = fit_model(table, options, nominal)?;
    }
    Err(CalibrationError::BadOption {
        option: "curvature",
        message: "the curved sensor has no reading without load near those of the table".to_owned(),
    })
}

impl SensorModel {
    /// Covariance of the normalised matrix of a curved sensor, as a product that says of loads what the fit of all its terms
    /// leaves uncertain of them.
    ///
    /// The variance of a load by the fit is that of one reading times `tᵀ G t`, with `t` signals and terms and `G` the inverse
    /// of their sum of squares, which no product of loads is; the product has the quadratic form of the loads that comes
    /// nearest, relative to the squared load, over the loads of the table. `None` for too few of them.
    pub(crate) fn covariance_with_terms(&self, table: &LoadTable) -> Option<Covariance> {
        let (axes, regressors) = (self.axes.len(), self.gauges() + self.terms.len());
        let gram = self.fit.inverse_gram.view((0, 0), (regressors, regressors));
        let loads = normalised(&table.loads, &self.nominal);
        let signals = less(&table.signals, &self.origin);
        let (mut products, mut leverages) = (Vec::new(), Vec::new());
        for (load, signals) in loads.row_iter().zip(signals.row_iter()) {
            let size = load.norm_squared();
            if size < LEAST_LOAD * LEAST_LOAD {
                continue;
            }
            let signals: Vec<f64> = signals.iter().copied().collect();
            let all: Vec<f64> = signals.iter().copied().chain(self.terms.values(&signals)).collect();
            let all = DVector::from_vec(all);
            leverages.push(all.dot(&(gram * &all)) / size);
            for a in 0..axes {
                // Both halves of a symmetric form.
                products.extend((a..axes).map(|b| load[a] * load[b] * if a == b { 1.0 } else { 2.0 } / size));
            }
        }
        let samples = leverages.len();
        let entries = axes * (axes + 1) / 2;
        let products = DMatrix::from_row_slice(samples, entries, &products);
        let form = least_squares(&products, &DMatrix::from_vec(samples, 1, leverages), None).ok()?;
        let mut of_loads = DMatrix::zeros(axes, axes);
        let places = (0..axes).flat_map(|a| (a..axes).map(move |b| (a, b)));
        for ((a, b), entry) in places.zip(form.coefficients.iter()) {
            (of_loads[(a, b)], of_loads[(b, a)]) = (*entry, *entry);
        }
        // No variance is negative.
        let mut eigen = of_loads.symmetric_eigen();
        eigen.eigenvalues.apply(|value| *value = value.max(0.0));
        let (matrix, _) = self.matrix_and_zero().ok()?;
        let signals = &matrix * &self.fit.residual_covariance * matrix.transpose();
        Some(Covariance::product(signals, eigen.recompose()))
    }
}

/// Loads below this share of full scale say nothing of how a variance grows with them.
const LEAST_LOAD: f64 = 0.05;
