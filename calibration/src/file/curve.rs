//! The terms of higher order of a sensor, as a file has them.

use fingertip_wrench::{CurvedInverse, ProductTerm, RadialTerm, Real};
use nalgebra::{DMatrix, DVector, SMatrix, SVector, Vector6};
use serde::{Deserialize, Serialize};

use super::{CalibrationFile, FileError, rows, validate};
use crate::Axis;
use crate::curve::Terms;

/// A curved sensor for the hot path, with as many terms as a file has.
pub type AnyCurve<T, const N: usize> = CurvedInverse<T, N, Vec<ProductTerm<T>>, Vec<RadialTerm<T, N>>>;

/// Terms of higher order in the signals: see [`Terms`] and [`CalibrationFile::load`].
///
/// ```
/// # use fingertip_calibration::{file::SignalUnit, nalgebra::DMatrix};
/// # // 2 V on one gauge each under 10 N or 0.1 N·m.
/// # let file = fingertip_calibration::file::CalibrationFile::new(
/// #     DMatrix::from_diagonal_element(6, 6, 2.0),
/// #     vec![10.0, 10.0, 10.0, 0.1, 0.1, 0.1],
/// #     vec![0.0; 6],
/// #     SignalUnit::Volt,
/// # )?;
/// # let mut file = file;
/// use fingertip_calibration::file::Curve;
///
/// // The product of the first two signals \[V²\] adds a tenth of the nominal 10 N to Fz.
/// let mut loads = DMatrix::zeros(6, 1);
/// loads[(2, 0)] = 0.1;
/// file.curve = Some(Curve { products: vec![vec![0, 1]], widths: vec![], centres: vec![], loads });
/// // 0.5 V and 0.4 V: 0.2 N on Fz, beside 2.5 N on Fx and 2 N on Fy.
/// let load = file.load(&[0.5, 0.4, 0.0, 0.0, 0.0, 0.0])?;
/// assert!((load[2] - 0.2).abs() < 1e-12 && (load[0] - 2.5).abs() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Curve {
    /// The gauges of each product of signals, two or three, counted from 0.
    pub products: Vec<Vec<usize>>,
    /// The widths of all bumps, one for each gauge \[signal\]; empty without bumps.
    pub widths: Vec<f64>,
    /// The signals at which the bumps are highest.
    pub centres: Vec<Vec<f64>>,
    /// The load of one unit of each term, products before bumps, in nominal loads: one row per axis, one column per term.
    #[serde(with = "rows")]
    pub loads: DMatrix<f64>,
}

impl Curve {
    /// Of terms, and the load of one unit of each, axes × terms.
    pub(crate) fn new(terms: Terms, loads: DMatrix<f64>) -> Self {
        let Terms { products, widths, centres } = terms;
        Self { products, widths, centres, loads }
    }

    /// Its terms without their loads.
    #[must_use]
    pub fn terms(&self) -> Terms {
        Terms { products: self.products.clone(), widths: self.widths.clone(), centres: self.centres.clone() }
    }

    /// What it adds to the load, in nominal loads.
    pub(super) fn load(&self, signals: &[f64]) -> DVector<f64> {
        &self.loads * DVector::from_vec(self.terms().values(signals))
    }

    /// Checks it for a sensor of so many gauges and axes.
    pub(super) fn validate(&self, gauges: usize, axes: usize) -> Result<(), FileError> {
        for (index, product) in self.products.iter().enumerate() {
            let sound = (2..=3).contains(&product.len()) && product.iter().all(|gauge| *gauge < gauges);
            if !sound || u8::try_from(gauges).is_err() {
                let requirement = "two or three gauges of the sensor, counted from 0";
                return Err(validate::out_of_range(&format!("curve.products[{index}]"), requirement));
            }
        }
        if !(self.centres.is_empty() && self.widths.is_empty()) {
            validate::finite_list("curve.widths", &self.widths, gauges)?;
        }
        if let Some(index) = self.widths.iter().position(|width| !(*width > 0.0)) {
            return Err(validate::out_of_range(&format!("curve.widths[{index}]"), "positive"));
        }
        for (index, centre) in self.centres.iter().enumerate() {
            validate::finite_list(&format!("curve.centres[{index}]"), centre, gauges)?;
        }
        validate::finite_matrix("curve.loads", &self.loads)?;
        validate::shape("curve.loads", &self.loads, axes, self.products.len() + self.centres.len())
    }
}

impl CalibrationFile {
    /// Whether it has terms of higher order: then it has no sensor matrix for the hot path, but a
    /// [curved inverse](Self::curved_inverse_in).
    #[must_use]
    pub const fn is_curved(&self) -> bool {
        self.quadratic.is_some() || self.curve.is_some()
    }

    /// The terms of higher order and the load of one unit of each \[N, N·m\]: products, then bumps. First all pairs of
    /// `quadratic`, then those of `curve`.
    pub(super) fn terms(&self) -> (Terms, DMatrix<f64>) {
        let pairs =
            self.quadratic.as_ref().map(|loads| Curve::new(Terms::pairs(self.gauges()), loads.clone()));
        let none = Terms::default();
        let (mut terms, mut columns) = (none, Vec::new());
        for curve in pairs.iter().chain(&self.curve) {
            // Bumps come after all products, and only `curve` has any.
            columns.extend(curve.loads.column_iter().map(|column| column.into_owned()));
            terms.products.extend(curve.products.iter().cloned());
            terms.widths.clone_from(&curve.widths);
            terms.centres.clone_from(&curve.centres);
        }
        let loads = DMatrix::from_fn(self.axes.len(), columns.len(), |axis, column| {
            columns[column][axis] * self.nominal[axis]
        });
        (terms, loads)
    }

    /// The curved sensor in scalar type `T`, for the hot path; one without terms of higher order is straight. Of signals,
    /// that is of readings whose zero and drift were taken off.
    ///
    /// # Errors
    /// [`FileError::WrongGauges`] if the sensor has not `N` gauges, [`FileError::NotSixAxes`] if it
    /// measures fewer components, [`FileError::Singular`] if its matrix has no inverse,
    /// [`FileError::NotFinite`] if a coefficient is none in that type.
    pub fn curved_inverse_in<T: Real, const N: usize>(&self) -> Result<AnyCurve<T, N>, FileError> {
        self.validate()?;
        if self.axes != Axis::ALL {
            return Err(FileError::NotSixAxes { found: self.axes.len() });
        }
        self.check_gauges::<N>()?;
        let inverse = crate::linear::pseudo_inverse(&self.matrix).ok_or(FileError::Singular)?;
        let linear = SMatrix::from_fn(|axis, gauge| T::literal(self.nominal[axis] * inverse[(axis, gauge)]));
        let (terms, loads) = self.terms();
        let load = |column: usize| Vector6::from_fn(|axis, _| T::literal(loads[(axis, column)]));
        let short = |gauge: &usize| u8::try_from(*gauge).unwrap_or(u8::MAX);
        let product = |(column, gauges): (usize, &Vec<usize>)| match gauges.as_slice() {
            [a, b] => Some(ProductTerm::of_two(short(a), short(b), load(column))),
            [a, b, c] => Some(ProductTerm::of_three(short(a), short(b), short(c), load(column))),
            _ => None,
        };
        let products: Vec<_> = terms.products.iter().enumerate().filter_map(product).collect();
        let bump = |(index, centre): (usize, &Vec<f64>)| RadialTerm {
            centre: SVector::from_fn(|gauge, _| T::literal(centre[gauge])),
            load: load(terms.products.len() + index),
        };
        let bumps: Vec<_> = terms.centres.iter().enumerate().map(bump).collect();
        let widths = SVector::from_fn(|gauge, _| T::literal(terms.widths.get(gauge).copied().unwrap_or(1.0)));
        CurvedInverse::new(linear, products)
            .and_then(|curved| curved.with_radial(widths, bumps))
            .map_err(|_| FileError::NotFinite { field: "curve".to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::WrenchSolver as _;
    use nalgebra::{DMatrix, SVector};
    use proptest::prelude::*;
    use rand::SeedableRng as _;

    use super::super::{CalibrationFile, FileError, SignalUnit};
    use super::Curve;
    use crate::curve::Region;
    use crate::fit::testing::{gaussian_matrix, sensor};

    fn file() -> CalibrationFile {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(14);
        let nominal = vec![10.0, 20.0, 30.0, 0.1, 0.2, 0.3];
        let zero = (0..7).map(|i| 0.1 * f64::from(i)).collect();
        let matrix = sensor(&mut random, 7, 6);
        let mut file = CalibrationFile::new(matrix, nominal, zero, SignalUnit::Volt).unwrap();
        file.quadratic = Some(gaussian_matrix(&mut random, 6, 28) * 0.01);
        file.curve = Some(Curve {
            products: vec![vec![0, 0, 1], vec![2, 4], vec![6, 6, 6]],
            widths: vec![3.0; 7],
            centres: vec![vec![1.0; 7], vec![-0.5; 7]],
            loads: gaussian_matrix(&mut random, 6, 5) * 0.02,
        });
        let signals = gaussian_matrix(&mut random, 30, 7);
        file.region = Region::of(&signals);
        file
    }

    /// The hot path has six components, and none of them may be made up.
    #[test]
    fn a_sensor_of_fewer_axes_has_no_curved_inverse() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(15);
        let three = CalibrationFile {
            axes: vec![crate::Axis::Fx, crate::Axis::Fy, crate::Axis::Fz],
            nominal: vec![10.0; 3],
            matrix: sensor(&mut random, 7, 3),
            quadratic: None,
            curve: None,
            ..file()
        };
        let said = three.curved_inverse_in::<f64, 7>().unwrap_err();
        assert!(matches!(said, FileError::NotSixAxes { found: 3 }), "{said}");
    }

    #[test]
    fn text_gives_back_the_very_same() {
        let file = file();
        let text = file.to_toml().unwrap();
        assert!(
            text.contains("\nversion = 3\n") && text.contains("\n[curve]\n") && text.contains("\n[region]\n"),
            "{text}"
        );
        assert_eq!(CalibrationFile::from_toml(&text).unwrap(), file);
        // Either of them alone is news to readers of the first versions.
        for alone in [
            CalibrationFile { quadratic: None, curve: None, ..file.clone() },
            CalibrationFile { region: None, ..file.clone() },
        ] {
            assert!(alone.to_toml().unwrap().contains("\nversion = 3\n"));
        }
        let straight = CalibrationFile { quadratic: None, curve: None, region: None, ..file };
        assert!(straight.to_toml().unwrap().contains("\nversion = 1\n"));
        assert!(!straight.is_curved());
    }

    proptest! {
        /// The hot path against the file's own load.
        #[test]
        fn both_ways_say_the_same(reading in proptest::array::uniform7(-2.0..2.0_f64)) {
            let file = file();
            let (double, single) = (file.curved_inverse_in::<f64, 7>().unwrap(), file.curved_inverse_in::<f32, 7>().unwrap());
            let load = file.load(&reading).unwrap();
            let signals = SVector::<f64, 7>::from_fn(|i, _| reading[i] - file.zero[i]);
            let (wide, narrow) = (double.solve(&signals).components(), single.solve(&signals.map(|x| x as f32)).components());
            for axis in 0..6 {
                let close = 1e-13 * file.nominal[axis];
                prop_assert!((wide[axis] - load[axis]).abs() < close, "{axis}: {} {}", wide[axis], load[axis]);
                prop_assert!((f64::from(narrow[axis]) - load[axis]).abs() < 1e-5 * file.nominal[axis]);
            }
        }
    }

    #[test]
    fn what_is_no_term_is_named() {
        let said = |spoil: &dyn Fn(&mut Curve)| {
            let mut file = file();
            spoil(file.curve.as_mut().unwrap());
            file.validate().unwrap_err().to_string()
        };
        for (text, field) in [
            (said(&|curve| curve.products[1] = vec![2]), "curve.products[1]"),
            (said(&|curve| curve.products[1] = vec![2, 3, 4, 5]), "curve.products[1]"),
            (said(&|curve| curve.products[2][2] = 7), "curve.products[2]"),
            (said(&|curve| curve.widths[3] = 0.0), "curve.widths[3]"),
            (said(&|curve| curve.widths[3] = f64::NAN), "curve.widths[3]"),
            (said(&|curve| curve.widths.clear()), "curve.widths"),
            (said(&|curve| curve.centres[1][6] = f64::INFINITY), "curve.centres[1][6]"),
            (said(&|curve| curve.centres[0].truncate(6)), "curve.centres[0]"),
            (said(&|curve| curve.loads = DMatrix::zeros(6, 4)), "curve.loads[0]"),
            (said(&|curve| curve.loads = DMatrix::zeros(5, 5)), "curve.loads"),
            (said(&|curve| curve.loads[(5, 4)] = f64::NAN), "curve.loads[5][4]"),
        ] {
            assert!(text.contains(field), "{field}: {text}");
        }
        let mut file = file();
        file.region.as_mut().unwrap().centre[2] = f64::NAN;
        assert!(file.validate().unwrap_err().to_string().contains("region.centre[2]"));
        file.region.as_mut().unwrap().centre.truncate(2);
        assert!(file.validate().unwrap_err().to_string().contains("region.centre"));
    }

    #[test]
    fn it_is_no_matrix_for_the_hot_path() {
        let file = CalibrationFile { quadratic: None, ..file() };
        assert!(
            matches!(file.sensor_matrix::<7>(), Err(FileError::OutOfRange { field, .. }) if field == "curve")
        );
        assert!(matches!(file.curved_inverse_in::<f64, 6>(), Err(FileError::WrongGauges { .. })));
    }
}
