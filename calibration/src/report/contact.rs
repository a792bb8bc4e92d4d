//! What the uncertainty of a calibration does to contact points.

use fingertip_wrench::Wrench;
use nalgebra::{DMatrix, DVector, Matrix6};
use serde::Serialize;

use crate::Axis;
use crate::design::TouchSet;
use crate::file::Covariance;
use crate::linear::pseudo_inverse;

/// How far contact points are off because of the sensor: root mean squares over the touches of a
/// surface, of the distance along the surface between the true contact point and the one that is
/// resolved \[mm\].
///
/// First order: the covariance of the wrench, `C⁺ (Σ_V + Cov(C x)) C⁺ᵀ`, carried to the contact point by
/// the derivative of the crossing of the line of action with the surface. Too small, therefore, near
/// grazing. The zero is taken to be tared, and the surface to be known exactly.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Six loads one after another, up to ±9.5 N and ±95 N·mm; gauges of 0.1 V/N or 10 V/(N·m) that scatter.
/// # let size = [1.0, 1.0, 1.0, 0.01, 0.01, 0.01];
/// # let loads = DMatrix::from_fn(120, 6, |i, j| if i % 6 == j { ((i / 6) as f64 - 9.5) * size[j] } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, load| 0.1 * load / size[j] + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::design::{DesignTouch, TouchSet};
/// use fingertip_calibration::report::ContactReport;
/// use fingertip_calibration::{calibrate, model::Options};
///
/// let touches = DesignTouch::on_sphere(0.013, core::f64::consts::FRAC_PI_2, 0.5, 5.0)?;
/// let options = Options {
///     touches: Some(TouchSet { surface: "sphere of 13 mm".into(), touches }),
///     ..Options::default()
/// };
/// let contacts: ContactReport = calibrate(&table, &options)?.report.contacts.ok_or("not six axes")?;
/// // 0.07 N·mm and 7 mN on 13 mm, over 5 N: some hundredths of a millimetre, nearly all by the reading.
/// assert!(contacts.reading_mm > 0.01 && contacts.reading_mm < 0.1 && (contacts.force - 5.0).abs() < 0.01);
/// assert!((contacts.together_mm - contacts.reading_mm.hypot(contacts.calibration_mm)).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContactReport {
    /// What the surface is.
    pub surface: String,
    /// How many touches of it were taken.
    pub touches: usize,
    /// Force of the touches \[N\] (mean).
    pub force: f64,
    /// By the error of the matrix: the same at every reading of a load, however often it is read.
    pub calibration_mm: f64,
    /// By the noise of one reading, which averaging makes smaller.
    pub reading_mm: f64,
    /// Both together.
    pub together_mm: f64,
    /// Both together, for the worst of the touches.
    pub worst_mm: f64,
}

/// `None` unless all six axes are there, the matrix can be inverted and there are touches.
pub(crate) fn contact_report(
    axes: &[Axis],
    matrix: &DMatrix<f64>,
    nominal: &[f64],
    covariance: &Covariance,
    set: &TouchSet,
) -> Option<ContactReport> {
    if axes != Axis::ALL || set.touches.is_empty() {
        return None;
    }
    let mut inverse = pseudo_inverse(matrix)?;
    for (mut row, nominal) in inverse.row_iter_mut().zip(nominal) {
        row *= *nominal;
    }
    // From a covariance of signals to that of the wrench.
    let carried = |signals: &DMatrix<f64>| {
        let wrench = &inverse * signals * inverse.transpose();
        Matrix6::from_fn(|i, j| wrench[(i, j)])
    };
    let noise = carried(&covariance.signals);
    let (mut by_reading, mut by_matrix, mut worst, mut force) = (0.0, 0.0, 0.0_f64, 0.0);
    for touch in &set.touches {
        let jacobian = touch.jacobian();
        let load = Wrench::<f64>::from_force_at(&touch.point, touch.force).components();
        let load = DVector::from_fn(6, |i, _| load[i] / nominal[i]);
        let squared = |noise: Matrix6<f64>| (jacobian * noise * jacobian.transpose()).trace().max(0.0);
        let (of_reading, of_matrix) = (squared(noise), squared(carried(&covariance.of_signals(&load))));
        by_reading += of_reading;
        by_matrix += of_matrix;
        worst = worst.max(of_reading + of_matrix);
        force += touch.force.norm();
    }
    let count = set.touches.len() as f64;
    let millimetres = |squares: f64| 1e3 * squares.max(0.0).sqrt();
    let report = ContactReport {
        surface: set.surface.clone(),
        touches: set.touches.len(),
        force: force / count,
        calibration_mm: millimetres(by_matrix / count),
        reading_mm: millimetres(by_reading / count),
        together_mm: millimetres((by_matrix + by_reading) / count),
        worst_mm: millimetres(worst),
    };
    (report.worst_mm.is_finite() && report.calibration_mm.is_finite()).then_some(report)
}

#[cfg(test)]
mod tests {
    use super::contact_report;
    use crate::Axis;
    use crate::design::{DesignTouch, TouchSet};
    use crate::file::Covariance;
    use crate::fit::least_squares;
    use crate::fit::testing::{gaussian_matrix, sensor};
    use fingertip_contact::{ContactModel as _, PointContact};
    use fingertip_surfaces::Sphere;
    use fingertip_wrench::Wrench;
    use nalgebra::{DVector, Vector6};
    use rand::SeedableRng as _;

    /// The same sensor calibrated many times and used: the contact points of the resolver are off by as
    /// much as is said.
    #[test]
    fn contact_points_are_off_by_as_much_as_is_said() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(31);
        let truth = sensor(&mut random, 6, 7);
        let loads = gaussian_matrix(&mut random, 12, 6) * 0.5;
        let nominal = [5.0, 5.0, 5.0, 0.05, 0.05, 0.05];
        let touches = DesignTouch::on_sphere(0.01, 1.2, 0.3, 5.0).unwrap();
        let touches: Vec<DesignTouch> = touches.into_iter().step_by(80).collect();
        let set = TouchSet { surface: "a sphere".to_owned(), touches: touches.clone() };
        let model = PointContact::new(0.1).unwrap();
        let sphere = Sphere::centred(0.01).unwrap();
        let (mut found, mut by_matrix, mut stated, trials) = (0.0, 0.0, 0.0, 1500);
        for _ in 0..trials {
            let signals = &loads * &truth + gaussian_matrix(&mut random, 12, 7) * 1e-3;
            let fit = least_squares(&loads, &signals, None).unwrap();
            let matrix = fit.coefficients.transpose();
            let covariance = Covariance::product(fit.residual_covariance.clone(), fit.inverse_gram.clone());
            let report = contact_report(&Axis::ALL, &matrix, &nominal, &covariance, &set).unwrap();
            assert!((report.force - 5.0).abs() < 1e-12 && report.touches == touches.len());
            let both = report.calibration_mm.hypot(report.reading_mm);
            assert!((report.together_mm / both - 1.0).abs() < 1e-12);
            stated += report.together_mm.powi(2) / f64::from(trials);
            by_matrix += report.calibration_mm.powi(2) / f64::from(trials);
            let inverse = crate::linear::pseudo_inverse(&matrix).unwrap();
            for touch in &touches {
                let load = Wrench::<f64>::from_force_at(&touch.point, touch.force).components();
                let load = DVector::from_fn(6, |i, _| load[i] / nominal[i]);
                let reading = truth.tr_mul(&load) + gaussian_matrix(&mut random, 7, 1).column(0) * 1e-3;
                let read = &inverse * reading;
                let wrench = Wrench::from_components(&Vector6::from_fn(|i, _| read[i] * nominal[i]));
                let contact = model.resolve(&wrench, &sphere);
                let point = contact.contact().unwrap().point;
                found += 1e6 * (point - touch.point).norm_squared() / (trials as f64 * touches.len() as f64);
            }
        }
        assert!((found / stated - 1.0).abs() < 0.05, "{found} {stated}");
        // Twelve loads make the matrix worth so much.
        assert!(by_matrix > 0.05 * stated && by_matrix < 0.5 * stated, "{by_matrix} {stated}");
    }
    /// Without all six axes, or without touches, nothing is said of contact points.
    #[test]
    fn what_is_not_known_is_not_said() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(32);
        let signals = sensor(&mut random, 7, 7);
        let covariance = |axes: usize| {
            Covariance::product(&signals * signals.transpose(), nalgebra::DMatrix::identity(axes, axes))
        };
        let touches = DesignTouch::on_sphere(0.01, 1.2, 0.3, 5.0).unwrap();
        let set = TouchSet { surface: "a sphere".to_owned(), touches };
        let none = TouchSet { touches: Vec::new(), ..set.clone() };
        let matrix = sensor(&mut random, 7, 6);
        let of = |axes: &[Axis], set: &TouchSet| {
            let matrix = matrix.columns(0, axes.len()).into_owned();
            contact_report(axes, &matrix, &vec![1.0; axes.len()], &covariance(axes.len()), set)
        };
        assert!(of(&Axis::ALL, &set).is_some());
        assert_eq!(of(&Axis::ALL, &none), None);
        assert_eq!(of(&Axis::FORCES, &set), None);
        let mut other = Axis::ALL;
        other.swap(0, 5);
        assert_eq!(of(&other, &set), None);
    }
}
