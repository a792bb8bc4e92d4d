//! A fitted sensor.

use alloc::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::{Direction, Options};
use crate::Axis;
use crate::curve::Terms;
use crate::file::{CalibrationFile, Covariance, Curve, FileError, Provenance, SignalUnit, of_pseudo_inverse};
use crate::fit::Fit;
use crate::linear::{Singular, less, pseudo_inverse, quick_inverse};
use crate::loads::LoadTable;

/// A fitted sensor: what turns readings into loads.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::calibrate;
/// use fingertip_calibration::model::{Options, SensorModel};
///
/// let model: SensorModel = calibrate(&table, &Options::default())?.model;
/// // Three gauges of 0.1 V/N, alike.
/// assert!(model.gauges() == 3 && (model.condition_number() - 1.0).abs() < 1e-2);
/// let newtons = model.loads(&DMatrix::from_row_slice(1, 3, &[0.2, 0.0, -0.4])).ok_or("singular")?;
/// assert!((newtons[(0, 0)] - 2.0).abs() < 0.01 && (newtons[(0, 2)] + 4.0).abs() < 0.01);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SensorModel {
    /// The components that it measures.
    pub axes: Vec<Axis>,
    /// Nominal loads \[N, N·m\].
    pub nominal: Vec<f64>,
    /// Unit of the readings.
    pub signal_unit: SignalUnit,
    /// Which way it was fitted.
    pub direction: Direction,
    /// Whether it has a constant.
    pub bias: bool,
    /// Its terms of higher order; none for a straight sensor.
    pub terms: Terms,
    /// The readings that count as signals of zero where loads are fitted to signals.
    pub origin: Vec<f64>,
    /// The fit, with loads in nominal loads. Rows of the coefficients are the regressors: loads or
    /// signals, then the terms, then the constant.
    pub fit: Fit,
}

/// The regressors of one way to fit: samples × regressors.
pub(crate) fn design(table: &LoadTable, options: &Options, nominal: &[f64]) -> DMatrix<f64> {
    let origin = options.curvature.origin(table.gauges());
    let linear = match options.direction {
        Direction::SignalsFromLoads => &table.loads,
        Direction::LoadsFromSignals => &table.signals,
    };
    let terms = options.curvature.terms(table.gauges());
    let (samples, k) = linear.shape();
    let mut design = DMatrix::from_element(samples, k + terms.len() + usize::from(options.bias), 1.0);
    for (column, mut slot) in linear.column_iter().zip(design.column_iter_mut()) {
        slot.copy_from(&column);
    }
    let columns = design.column_iter_mut().take(k);
    match options.direction {
        Direction::SignalsFromLoads => {
            columns.zip(nominal).for_each(|(mut column, nominal)| column /= *nominal);
        }
        Direction::LoadsFromSignals => {
            columns.zip(&origin).for_each(|(mut column, zero)| column.add_scalar_mut(-zero));
        }
    }
    if !terms.is_empty() {
        for i in 0..samples {
            let row: Vec<f64> = design.row(i).iter().take(k).copied().collect();
            for (j, value) in terms.values(&row).iter().enumerate() {
                design[(i, k + j)] = *value;
            }
        }
    }
    design
}

/// What is regressed on the design: samples × responses.
pub(crate) fn responses<'a>(
    table: &'a LoadTable,
    options: &Options,
    nominal: &[f64],
) -> Cow<'a, DMatrix<f64>> {
    match options.direction {
        Direction::SignalsFromLoads => Cow::Borrowed(&table.signals),
        Direction::LoadsFromSignals => Cow::Owned(normalised(&table.loads, nominal)),
    }
}

/// Loads in nominal loads.
pub(crate) fn normalised(loads: &DMatrix<f64>, nominal: &[f64]) -> DMatrix<f64> {
    let mut loads = loads.clone();
    for (mut column, nominal) in loads.column_iter_mut().zip(nominal) {
        column /= *nominal;
    }
    loads
}

impl SensorModel {
    /// How many gauges it has.
    #[must_use]
    pub fn gauges(&self) -> usize {
        match self.direction {
            Direction::SignalsFromLoads => self.fit.coefficients.ncols(),
            Direction::LoadsFromSignals => {
                self.fit.coefficients.nrows() - usize::from(self.bias) - self.terms.len()
            }
        }
    }

    /// The loads \[N, N·m\] that readings tell of, by these coefficients: samples × axes. `None` if
    /// the coefficients have deficient rank.
    #[must_use]
    pub fn loads_with(&self, coefficients: &DMatrix<f64>, signals: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let axes = self.axes.len();
        let mut loads = match self.direction {
            Direction::SignalsFromLoads => {
                let matrix = coefficients.rows(0, axes).transpose();
                let inverse = quick_inverse(&matrix)?;
                let mut signals = signals.clone();
                if self.bias {
                    for mut row in signals.row_iter_mut() {
                        row -= coefficients.row(axes);
                    }
                }
                signals * inverse.transpose()
            }
            Direction::LoadsFromSignals => {
                let (samples, gauges) = signals.shape();
                let signals = less(signals, &self.origin);
                let mut loads = &signals * coefficients.rows(0, gauges);
                if !self.terms.is_empty() {
                    let second = coefficients.rows(gauges, self.terms.len());
                    for i in 0..samples {
                        let row: Vec<f64> = signals.row(i).iter().copied().collect();
                        let mut target = loads.row_mut(i);
                        target += DVector::from_vec(self.terms.values(&row)).transpose() * second;
                    }
                }
                if self.bias {
                    let last = coefficients.nrows() - 1;
                    for mut row in loads.row_iter_mut() {
                        row += coefficients.row(last);
                    }
                }
                loads
            }
        };
        for (mut column, nominal) in loads.column_iter_mut().zip(&self.nominal) {
            column *= *nominal;
        }
        Some(loads)
    }

    /// The loads \[N, N·m\] that readings tell of: samples × axes.
    #[must_use]
    pub fn loads(&self, signals: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        self.loads_with(&self.fit.coefficients, signals)
    }

    /// The normalised sensor matrix, gauges × axes, and the readings without load.
    ///
    /// For a model of loads from signals the matrix is the pseudo-inverse of the fitted one, whose own
    /// least-squares inverse is the fitted one again; the zero is the reading nearest to the origin that gives no load,
    /// and of a curved sensor the matrix is that of small loads about this zero.
    ///
    /// # Errors
    /// [`FileError::Singular`] if the fitted matrix has deficient rank.
    pub fn matrix_and_zero(&self) -> Result<(DMatrix<f64>, DVector<f64>), FileError> {
        let theta = &self.fit.coefficients;
        let (axes, gauges) = (self.axes.len(), self.gauges());
        match self.direction {
            Direction::SignalsFromLoads => {
                let zero = if self.bias { theta.row(axes).transpose() } else { DVector::zeros(gauges) };
                Ok((theta.rows(0, axes).transpose(), zero))
            }
            Direction::LoadsFromSignals => {
                let mut inverse = theta.rows(0, gauges).transpose();
                let constant =
                    if self.bias { theta.row(theta.nrows() - 1).transpose() } else { DVector::zeros(axes) };
                let second = self.loads_of_terms();
                let mut zero = DVector::zeros(gauges);
                // Newton steps of least norm; one is exact for a straight sensor.
                for _ in 0..if self.terms.is_empty() { 1 } else { 50 } {
                    inverse = theta.rows(0, gauges).transpose();
                    let mut load = &inverse * &zero + &constant;
                    if !self.terms.is_empty() {
                        load += &second * DVector::from_vec(self.terms.values(zero.as_slice()));
                        inverse += &second * self.terms.slopes(zero.as_slice());
                    }
                    zero -= pseudo_inverse(&inverse).ok_or(FileError::Singular)? * load;
                }
                if !self.terms.is_empty() {
                    inverse = theta.rows(0, gauges).transpose() + second * self.terms.slopes(zero.as_slice());
                }
                let matrix = pseudo_inverse(&inverse).ok_or(FileError::Singular)?;
                Ok((matrix, zero + DVector::from_column_slice(&self.origin)))
            }
        }
    }

    /// The loads of one unit of each term, axes × terms.
    fn loads_of_terms(&self) -> DMatrix<f64> {
        self.fit.coefficients.rows(self.gauges(), self.terms.len()).transpose()
    }

    /// Condition number N_c of the normalised matrix.
    #[must_use]
    pub fn condition_number(&self) -> f64 {
        self.matrix_and_zero()
            .ok()
            .and_then(|(matrix, _)| Singular::new(&matrix))
            .map_or(f64::INFINITY, |singular| singular.condition_number())
    }

    /// Covariance of the normalised matrix; for a model of loads from signals carried over by the derivative of the
    /// pseudo-inverse (first order).
    #[must_use]
    pub fn covariance(&self) -> Option<Covariance> {
        let (axes, gauges) = (self.axes.len(), self.gauges());
        match self.direction {
            Direction::SignalsFromLoads => {
                let loads = self.fit.inverse_gram.view((0, 0), (axes, axes)).into_owned();
                let regressors = self.fit.coefficients.nrows();
                // Those of the loads among the regressors, gauge by gauge.
                let place = |entry: usize| (entry / axes) * regressors + entry % axes;
                let entries = self.fit.full_covariance.as_ref().map(|full| {
                    DMatrix::from_fn(gauges * axes, gauges * axes, |a, b| full[(place(a), place(b))])
                });
                Some(Covariance { signals: self.fit.residual_covariance.clone(), loads, entries })
            }
            Direction::LoadsFromSignals => {
                let (matrix, _) = self.matrix_and_zero().ok()?;
                let gram = self.fit.inverse_gram.view((0, 0), (gauges, gauges)).into_owned();
                let signals = &matrix * &self.fit.residual_covariance * matrix.transpose();
                if gauges == axes {
                    return Some(Covariance::product(signals, matrix.transpose() * gram * &matrix));
                }
                let fitted = pseudo_inverse(&matrix)?;
                let of_fitted = self.fit.residual_covariance.kronecker(&gram);
                Some(Covariance::of_entries(signals, of_pseudo_inverse(&fitted, &matrix, &of_fitted)))
            }
        }
    }

    /// Covariance of the load \[N, N·m\] that one reading tells of, at any load: that of one reading
    /// and that of the fit, `C⁺ (Σ_V + Cov(C x)) C⁺ᵀ` (`docs/theory/calibration.md#least-squares`). `None` if
    /// the matrix has deficient rank.
    #[must_use]
    pub fn load_covariance(&self) -> Option<LoadCovariance> {
        let (matrix, _) = self.matrix_and_zero().ok()?;
        let covariance = self.covariance()?;
        let mut inverse = pseudo_inverse(&matrix)?;
        for (mut row, nominal) in inverse.row_iter_mut().zip(&self.nominal) {
            row *= *nominal;
        }
        Some(LoadCovariance { inverse, covariance, nominal: self.nominal.clone() })
    }

    /// As a calibration file, its quality unchecked.
    ///
    /// # Errors
    /// [`FileError`] if the matrix has no inverse or a number is not finite.
    pub fn to_file(&self, method: &str) -> Result<CalibrationFile, FileError> {
        let (matrix, zero) = self.matrix_and_zero()?;
        let (axes, nominal, zero) = (self.axes.clone(), self.nominal.clone(), zero.as_slice().to_vec());
        let mut file = CalibrationFile::of_axes(axes, matrix, nominal, zero, self.signal_unit)?;
        if self.terms == Terms::pairs(self.gauges()) {
            file.quadratic = Some(self.loads_of_terms());
        } else if !self.terms.is_empty() {
            file.curve = Some(Curve::new(self.terms.clone(), self.loads_of_terms()));
        }
        file.covariance = self.covariance();
        file.provenance =
            Provenance { method: method.to_owned(), tool: crate::TOOL.to_owned(), ..Provenance::default() };
        file.validate()?;
        Ok(file)
    }
}

/// How surely a model tells a load: see [`SensorModel::load_covariance`].
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Three forces one after another, up to ±9.5 N; each has a gauge of 0.1 V/N, and they scatter by a millivolt.
/// # let loads = DMatrix::from_fn(60, 3, |i, j| if i % 3 == j { (i / 3) as f64 - 9.5 } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, newtons| 0.1 * newtons + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::FORCES, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::calibrate;
/// use fingertip_calibration::model::{LoadCovariance, Options};
///
/// let model = calibrate(&table, &Options::default())?.model;
/// let covariance: LoadCovariance = model.load_covariance().ok_or("singular")?;
/// // A sine of 1 mV has a deviation of 0.7 mV, and so 7 mN; far from the loads of the fit there is more.
/// let newtons = |load: &[f64; 3]| covariance.at(load)[(0, 0)].sqrt();
/// assert!((newtons(&[0.0; 3]) - 7.1e-3).abs() < 0.5e-3);
/// assert!(newtons(&[100.0, 0.0, 0.0]) > 1.5 * newtons(&[0.0; 3]));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LoadCovariance {
    /// Loads \[N, N·m\] per signal.
    inverse: DMatrix<f64>,
    covariance: Covariance,
    nominal: Vec<f64>,
}

impl LoadCovariance {
    /// At a load \[N, N·m\], of as many axes as the model has; those that are missing count as zero.
    #[must_use]
    pub fn at(&self, load: &[f64]) -> DMatrix<f64> {
        let load = DVector::from_fn(self.nominal.len(), |i, _| {
            load.get(i).copied().unwrap_or_default() / self.nominal[i]
        });
        let signals = &self.covariance.signals + self.covariance.of_signals(&load);
        &self.inverse * signals * self.inverse.transpose()
    }
}
