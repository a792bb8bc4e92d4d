//! What ordinary point contacts tell of a sensor: the form that vanishes on their signals.

use nalgebra::{DMatrix, DVector};

use crate::fit::FitError;
use crate::linear::{Singular, Triangular};

/// Gathers signals of point contacts, in bounded memory, and finds the symmetric form that vanishes on
/// them.
///
/// Every point contact has a wrench without pitch, `f·m = 0`. With `wrench = B · signals` that is
/// `Vᵀ S V = 0`, `S = Bᵀ J B`, J the matrix that exchanges forces and torques. Touches that nobody
/// measured thus determine S up to a factor: 20 of the 36 numbers in B
/// (`docs/theory/calibration.md#point-contacts-in-use`). The other 16 (the group O(3,3) and a scale) need
/// known loads: see [`super::refine`].
///
/// ```
/// # use fingertip_calibration::nalgebra::{DMatrix, DVector, Vector3, Vector6};
/// # // What a touch at a place of a ball of 12 mm reads: N, and N·m times 100.
/// # let touch = |k: i32| -> Vector6<f64> {
/// #     let at = f64::from(k);
/// #     let normal = Vector3::new((2.4 * at).cos(), (2.4 * at).sin(), (1.3 * at).sin()).normalize();
/// #     let force = Vector3::new((3.1 * at).sin(), (1.7 * at).cos(), (0.9 * at).sin()) - normal * 2.0;
/// #     let torque = (normal * 0.012 + Vector3::new(0.0, 0.0, 0.005)).cross(&force) * 100.0;
/// #     Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
/// # };
/// use fingertip_calibration::in_situ::{PointContactForm, angle_between, form_of};
///
/// // What 200 touches at unknown places say of a sensor that reads 1 per newton and 100 per newton metre.
/// let mut gathered = PointContactForm::new(6);
/// for k in 0..200 {
///     assert!(gathered.push(touch(k).as_slice()));
/// }
/// let found = gathered.solve()?;
/// let loads_per_signal = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 1.0, 1.0, 0.01, 0.01, 0.01]));
/// assert!(angle_between(&found.matrix, &form_of(&loads_per_signal)) < 1e-6);
/// # Ok::<(), fingertip_calibration::fit::FitError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PointContactForm {
    gauges: usize,
    triangular: Triangular,
}

/// The form of a sensor, up to a factor.
///
/// ```
/// # use fingertip_calibration::nalgebra::{DMatrix, DVector, Vector3, Vector6};
/// # // What a touch at a place of a ball of 12 mm reads: N, and N·m times 100.
/// # let touch = |k: i32| -> Vector6<f64> {
/// #     let at = f64::from(k);
/// #     let normal = Vector3::new((2.4 * at).cos(), (2.4 * at).sin(), (1.3 * at).sin()).normalize();
/// #     let force = Vector3::new((3.1 * at).sin(), (1.7 * at).cos(), (0.9 * at).sin()) - normal * 2.0;
/// #     let torque = (normal * 0.012 + Vector3::new(0.0, 0.0, 0.005)).cross(&force) * 100.0;
/// #     Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
/// # };
/// use fingertip_calibration::in_situ::{Form, PointContactForm};
///
/// let mut gathered = PointContactForm::new(6);
/// (0..200).for_each(|k| assert!(gathered.push(touch(k).as_slice())));
/// // Point contacts and nothing else, of a true sensor of six gauges.
/// let form: Form = gathered.solve()?;
/// assert!(form.contacts == 200 && form.signature == (3, 3) && form.ambiguity < 1e-6);
/// assert!((form.matrix.norm() - 1.0).abs() < 1e-9);
/// # Ok::<(), fingertip_calibration::fit::FitError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// Symmetric, gauges × gauges, of Frobenius norm 1; its sign is chosen so that its trace, or else its
    /// first entry that is not zero, is positive.
    pub matrix: DMatrix<f64>,
    /// How many contacts stand behind it.
    pub contacts: u64,
    /// Standard deviation of the form as an angle \[rad\] (see [`angle_between`]), to first order, from what
    /// the touches leave, which is taken to be alike in all of them.
    pub deviation: f64,
    /// Smallest over second smallest singular value: near zero if the contacts determine the form and
    /// are point contacts; near 1 if they do not.
    pub ambiguity: f64,
    /// Eigenvalues above and below zero: (3, 3) for any true sensor of six gauges.
    pub signature: (usize, usize),
}

impl PointContactForm {
    /// For a sensor with this number of gauges.
    #[must_use]
    pub fn new(gauges: usize) -> Self {
        Self { gauges, triangular: Triangular::new(0, numbers(gauges)) }
    }

    /// Takes the signals (tared) of one touch; `false` if they are not finite or of the wrong number. The size of
    /// the touch does not matter: signals are brought to unit length.
    pub fn push(&mut self, signals: &[f64]) -> bool {
        if signals.len() != self.gauges {
            return false;
        }
        let norm = DVector::from_column_slice(signals).norm();
        if !(norm > 0.0 && norm.is_finite()) {
            return false;
        }
        let mut row = Vec::with_capacity(numbers(self.gauges));
        for i in 0..self.gauges {
            for j in i..self.gauges {
                // √2 off the diagonal makes the norm of the coefficients that of the matrix.
                let twice = if i == j { 1.0 } else { core::f64::consts::SQRT_2 };
                row.push(twice * signals[i] * signals[j] / (norm * norm));
            }
        }
        self.triangular.push(&[], &row)
    }

    /// The form that vanishes on the touches so far.
    ///
    /// # Errors
    /// [`FitError::TooFewSamples`] with fewer touches than numbers to find.
    pub fn solve(&mut self) -> Result<Form, FitError> {
        let unknowns = numbers(self.gauges);
        let contacts = self.triangular.samples();
        if contacts < unknowns as u64 {
            return Err(FitError::TooFewSamples {
                samples: usize::try_from(contacts).unwrap_or(usize::MAX),
                coefficients: unknowns,
            });
        }
        let factors = self.triangular.factors();
        let singular = Singular::new(&factors.residual).ok_or(FitError::BadInput { what: "the signals" })?;
        let last = unknowns - 1;
        let mut matrix = DMatrix::zeros(self.gauges, self.gauges);
        let mut k = 0;
        for i in 0..self.gauges {
            for j in i..self.gauges {
                let value = singular.right[(k, last)];
                matrix[(i, j)] = if i == j { value } else { value / core::f64::consts::SQRT_2 };
                matrix[(j, i)] = matrix[(i, j)];
                k += 1;
            }
        }
        let (matrix, signature) = canonical(matrix);
        let ambiguity = match singular.values.get(last.saturating_sub(1)) {
            Some(next) if *next > 0.0 => singular.values[last] / next,
            _ => 1.0,
        };
        let (least, others) = (singular.values[last], singular.values.rows(0, last));
        let sum: f64 = others.iter().map(|value| (least / value).powi(2)).sum();
        let deviation = (sum / (contacts as f64 - last as f64)).sqrt();
        Ok(Form { matrix, contacts, deviation, ambiguity, signature })
    }
}

/// How many numbers a symmetric form of so many gauges has.
const fn numbers(gauges: usize) -> usize {
    gauges * (gauges + 1) / 2
}

/// Fixes norm and sign, and counts the signs of the eigenvalues.
fn canonical(matrix: DMatrix<f64>) -> (DMatrix<f64>, (usize, usize)) {
    let norm = matrix.norm();
    let first = matrix.iter().copied().find(|x| x.abs() > 1e-6 * norm).unwrap_or(1.0);
    let sign = if matrix.trace().abs() > 1e-6 * norm { matrix.trace().signum() } else { first.signum() };
    let matrix = matrix * (sign / norm.max(f64::MIN_POSITIVE));
    let eigenvalues = matrix.clone().symmetric_eigenvalues();
    let least = 1e-9 * eigenvalues.amax();
    let above = eigenvalues.iter().filter(|x| **x > least).count();
    let below = eigenvalues.iter().filter(|x| **x < -least).count();
    (matrix, (above, below))
}

/// The form that a calibrated sensor should have: `Bᵀ J B` for B from signals to wrench, 6 × gauges.
#[must_use]
pub fn form_of(loads_per_signal: &DMatrix<f64>) -> DMatrix<f64> {
    let force = loads_per_signal.rows(0, 3);
    let torque = loads_per_signal.rows(3, 3);
    let product = force.transpose() * torque;
    canonical(&product + product.transpose()).0
}

/// Angle between two forms \[rad\]: 0 if they are the same up to a factor.
#[must_use]
pub fn angle_between(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    if a.shape() != b.shape() {
        return core::f64::consts::FRAC_PI_2;
    }
    let cosine = (a.dot(b) / (a.norm() * b.norm())).abs();
    let sine = (a / a.norm() - b * (a.dot(b).signum() / b.norm())).norm() / 2.0;
    // The arc sine is the accurate one for small angles.
    if cosine > 0.9 { 2.0 * sine.min(1.0).asin() } else { cosine.min(1.0).acos() }
}

#[cfg(test)]
mod tests {
    use super::{PointContactForm, angle_between, form_of};
    use crate::fit::testing::{gaussian, sensor};
    use nalgebra::{DMatrix, DVector, Vector3};
    use rand::SeedableRng as _;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn touches_determine_twenty_numbers() {
        let random = &mut Pcg64Mcg::seed_from_u64(2);
        for _ in 0..20 {
            // From signals to wrench.
            let b = sensor(random, 6, 6);
            let c = b.clone().try_inverse().unwrap();
            let mut gathered = PointContactForm::new(6);
            for _ in 0..60 {
                let mut vector = || Vector3::from_fn(|_, _| gaussian(random));
                let (f, r) = (vector() * 3.0, vector());
                let m = r.cross(&f);
                let load = DVector::from_column_slice(&[f.x, f.y, f.z, m.x, m.y, m.z]);
                assert!(gathered.push((&c * load).as_slice()));
            }
            let form = gathered.solve().unwrap();
            assert!(angle_between(&form.matrix, &form_of(&b)) < 1e-10);
            assert!(form.ambiguity < 1e-10 && form.signature == (3, 3));
        }
    }

    #[test]
    fn what_is_no_touch_is_left_out() {
        let mut gathered = PointContactForm::new(2);
        for bad in [&[0.0, 0.0][..], &[1.0], &[1.0, f64::NAN], &[f64::INFINITY, 1.0]] {
            assert!(!gathered.push(bad), "{bad:?}");
        }
        assert!(gathered.push(&[1e-150, 0.0]));
    }

    /// Of more eigenvalues than six the others are none: they have no sign.
    #[test]
    fn signs_are_counted_apart() {
        for (diagonal, signs) in [
            (vec![1.0, 2.0, -1.0, 0.0, 0.0], (2, 1)),
            (vec![-3.0, 1.0, 2.5, 1.0, 0.0, 1e-12], (3, 1)),
            (vec![1.0, -1.0, -1.0, 3.0, 4.0], (3, 2)),
        ] {
            let (_, found) = super::canonical(DMatrix::from_diagonal(&DVector::from_vec(diagonal)));
            assert_eq!(found, signs);
        }
    }

    #[test]
    fn angles_between_forms_are_those_of_their_entries() {
        let at = |angle: f64| DMatrix::from_row_slice(2, 2, &[angle.cos(), 0.0, 0.0, angle.sin()]) * 3.0;
        for angle in [0.0, 1e-12, 1e-3, 0.4, 0.5, 1.0, 1.57] {
            for (sign, size) in [(1.0, 1.0), (-1.0, 1e-3)] {
                let found = angle_between(&at(0.0), &(at(angle) * (sign * size)));
                assert!((found - angle).abs() < 1e-14, "{found} {angle}");
            }
        }
        let right = core::f64::consts::FRAC_PI_2;
        assert_eq!(angle_between(&at(0.1), &DMatrix::identity(3, 3)), right);
        assert!((angle_between(&at(0.0), &at(right)) - right).abs() < 1e-14);
    }

    /// Norm 1, a positive trace, or else a positive first entry.
    #[test]
    fn forms_have_one_size_and_sign() {
        let random = &mut Pcg64Mcg::seed_from_u64(4);
        let b = sensor(random, 6, 6);
        let form = form_of(&b);
        assert!((form.norm() - 1.0).abs() < 1e-14 && form.trace() >= 0.0);
        // Reversed torques reverse the form.
        let mut reversed = b.clone();
        reversed.rows_mut(3, 3).neg_mut();
        assert!((form_of(&reversed) - &form).iter().all(|off| off.abs() < 1e-14));
        // Of a sensor that reads wrenches the trace is zero.
        for sign in [1.0, -1.0] {
            let mut plain = DMatrix::identity(6, 6);
            plain.rows_mut(3, 3).scale_mut(sign);
            let form = form_of(&plain);
            let expected = 1.0 / 6.0_f64.sqrt();
            assert!((form[(0, 3)] - expected).abs() < 1e-15 && (form[(5, 2)] - expected).abs() < 1e-15);
        }
    }

    /// In whatever units a sensor reads, its form is the same: of small numbers and of large ones.
    #[test]
    fn units_of_the_readings_do_not_change_the_form() {
        let random = &mut Pcg64Mcg::seed_from_u64(5);
        let mut wrenches = DMatrix::identity(6, 6);
        wrenches.rows_mut(3, 3).neg_mut();
        let sensors = (0..20).map(|_| sensor(random, 6, 6)).chain([wrenches]);
        for (number, b) in sensors.enumerate() {
            let form = form_of(&b);
            for unit in [1e-6, 1e-3, 1e3, 1e6] {
                let off = (form_of(&(&b * unit)) - &form).norm();
                assert!(off < 1e-12, "{off}: sensor {number} in a unit of {unit}");
            }
        }
        // A trace that is nothing but rounding gives no sign.
        for rounding in [1e-10, -1e-10] {
            for unit in [1e-3, 1.0, 1e3] {
                let bare = DMatrix::from_row_slice(2, 2, &[rounding, 1.0, 1.0, 0.0]) * unit;
                assert!(super::canonical(bare).0[(0, 1)] > 0.0, "{rounding} {unit}");
                // Nor does a first entry that is.
                let bare = DMatrix::from_row_slice(2, 2, &[rounding, 1.0, 1.0, -rounding]) * unit;
                assert!(super::canonical(bare).0[(0, 1)] > 0.0, "{rounding} {unit}");
            }
        }
    }

    #[test]
    fn what_is_not_enough_is_said() {
        let mut gathered = PointContactForm::new(6);
        assert!(!gathered.push(&[0.0; 6]) && !gathered.push(&[f64::NAN; 6]) && !gathered.push(&[1.0; 5]));
        let random = &mut Pcg64Mcg::seed_from_u64(2);
        // Loads with arbitrary pitch: no form vanishes on them.
        for _ in 0..20 {
            let signals: Vec<f64> = (0..6).map(|_| gaussian(random)).collect();
            gathered.push(&signals);
        }
        assert!(gathered.solve().is_err());
        for _ in 0..2000 {
            let signals: Vec<f64> = (0..6).map(|_| gaussian(random)).collect();
            gathered.push(&signals);
        }
        assert!(gathered.solve().unwrap().ambiguity > 0.5);
    }
}
