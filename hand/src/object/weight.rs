//! Mass and centre of mass of what is held, learnt while it is held.

use fingertip_wrench::{Frame, Real, Wrench};
use nalgebra::{Matrix3, Matrix4, Matrix6, Matrix6x4, SMatrix, Vector3, Vector4};

use crate::UncertainWrench;
use crate::triangle::add_row;

/// Mass and centre of mass, with how sure they are.
///
/// ```
/// use fingertip_hand::{Hand, ObjectWeight, UncertainWrench};
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix6, Vector3};
///
/// let covariance = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// let mut weight = ObjectWeight::<f64>::new();
/// // 100 g, 20 mm above the origin, upright and then a little tilted: its height is known less well than its place aside.
/// for gravity in [Vector3::new(0.0, 0.0, -9.81), Vector3::new(1.0, 1.0, -9.7)] {
///     let wrench = Wrench::<f64, Hand>::from_force_at(&Vector3::new(0.0, 0.0, 0.02), gravity * 0.1);
///     weight.observe(&UncertainWrench { wrench, covariance }, &gravity);
/// }
/// let found = weight.estimate().ok_or("tilted once")?;
/// assert!((found.mass - 0.1).abs() < 1e-12 && (found.centre.z - 0.02).abs() < 1e-12);
/// assert!(found.centre_covariance.m33 > 20.0 * found.centre_covariance.m11);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct WeightEstimate<T: Real> {
    /// The mass \[kg\].
    pub mass: T,
    /// Its standard deviation \[kg\].
    pub mass_deviation: T,
    /// The centre of mass in the frame of the loads \[m\].
    pub centre: Vector3<T>,
    /// Its covariance \[m²\]: large along gravity until the object has been turned.
    pub centre_covariance: Matrix3<T>,
}

/// Learns mass and centre of mass from what the fingertips feel: recursive least squares on `(m c, m)`, weighed by the
/// covariance of each load, in square-root form so that no rounding makes it indefinite
/// (`docs/theory/hand.md#weight-of-the-object`).
///
/// ```
/// use fingertip_hand::{Hand, ObjectWeight, UncertainWrench};
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix6, Vector3};
///
/// let noise = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// let centre = Vector3::new(0.01, 0.0, 0.02);
/// let mut weight = ObjectWeight::<f64>::new();
/// // Two orientations: gravity along −z of the hand, then along −x.
/// for gravity in [Vector3::new(0.0, 0.0, -9.81), Vector3::new(-9.81, 0.0, 0.0)] {
///     let wrench = Wrench::<f64, Hand>::from_force_at(&centre, gravity * 0.2);
///     assert!(weight.observe(&UncertainWrench { wrench, covariance: noise }, &gravity));
/// }
/// let found = weight.estimate().expect("turned once");
/// assert!((found.mass - 0.2).abs() < 1e-12 && (found.centre - centre).norm() < 1e-12);
/// // 10 mN of noise, twice: 0.7 g.
/// assert!((found.mass_deviation - 0.01 / 9.81 / 2.0_f64.sqrt()).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct ObjectWeight<T: Real> {
    /// `triangle · (m c, m) = right` with errors of unit variance.
    triangle: Matrix4<T>,
    right: Vector4<T>,
}

impl<T: Real> Default for ObjectWeight<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real> ObjectWeight<T> {
    /// Nothing is known.
    #[must_use]
    pub fn new() -> Self {
        Self { triangle: Matrix4::zeros(), right: Vector4::zeros() }
    }

    /// Takes a load of the fingertips in while nothing else touches the object. `gravity` \[m/s²\] is in the frame of
    /// the load, less the acceleration of the centre of mass where it is known; the object must not turn fast. The
    /// frame is one that moves with the object.
    ///
    /// Samples count as independent: take them as far apart as their errors last (a tare's error lasts).
    /// `false`, and nothing learnt, if a number is NaN or infinite or the covariance is not positive definite.
    pub fn observe<F: Frame>(&mut self, load: &UncertainWrench<T, F>, gravity: &Vector3<T>) -> bool {
        let Some(whitener) = Whitener::new(&load.covariance) else { return false };
        let rows = whitener.apply(&map(gravity));
        let values = whitener.apply(&load.wrench.components());
        if !rows.iter().chain(values.iter()).all(|x| x.is_number()) {
            return false;
        }
        let (mut triangle, mut right) = (self.triangle, self.right);
        for (row, value) in rows.row_iter().zip(values.iter()) {
            let mut value = *value;
            add_row(&mut triangle, row.into_owned(), |j, cos, sin| {
                let (x, y) = (right[j], value);
                right[j] = cos * x + sin * y;
                value = cos * y - sin * x;
            });
        }
        if !triangle.iter().chain(right.iter()).all(|x| x.is_number()) {
            return false;
        }
        *self = Self { triangle, right };
        true
    }

    /// The mass and its standard deviation \[kg\]: known from the first sample under gravity on.
    #[must_use]
    pub fn mass(&self) -> Option<(T, T)> {
        // The mass is the last unknown: its row of the triangle holds what is known of it alone.
        let (diagonal, right) = (self.triangle.m44, self.right.w);
        let (mass, deviation) = (right / diagonal, T::one() / diagonal.abs());
        (mass.is_number() && deviation.is_number()).then_some((mass, deviation))
    }

    /// Mass and centre; `None` until the object was felt in two orientations, or if the mass is not positive.
    #[must_use]
    pub fn estimate(&self) -> Option<WeightEstimate<T>> {
        let inverse = self.inverse()?;
        let found = inverse * self.right;
        let (mass, first) = (found.w, found.xyz());
        if !(mass > T::zero()) {
            return None;
        }
        let centre = first / mass;
        // c = (m c)/m: its derivative is [1 | −c]/m.
        let mut slope = nalgebra::Matrix3x4::zeros();
        slope.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        slope.set_column(3, &-centre);
        let root = slope * inverse / mass;
        let centre_covariance = root * root.transpose();
        let mass_deviation = inverse.row(3).norm_squared().root();
        let finite = centre.iter().chain(centre_covariance.iter()).all(|x| x.is_number());
        (finite && mass.is_number()).then_some(WeightEstimate {
            mass,
            mass_deviation,
            centre,
            centre_covariance,
        })
    }

    /// The load of the weight alone on the fingertips, with its covariance; `None` as
    /// [`estimate`](Self::estimate).
    #[must_use]
    pub fn load<F: Frame>(&self, gravity: &Vector3<T>) -> Option<UncertainWrench<T, F>> {
        let inverse = self.inverse()?;
        let map = map(gravity);
        let root = map * inverse;
        let wrench = Wrench::from_components(&(root * self.right));
        let covariance = root * root.transpose();
        let finite = wrench.is_finite() && covariance.iter().all(|x| x.is_number());
        finite.then_some(UncertainWrench { wrench, covariance })
    }

    /// The inverse of the triangle.
    fn inverse(&self) -> Option<Matrix4<T>> {
        let inverse = self.triangle.solve_upper_triangular(&Matrix4::identity())?;
        inverse.iter().all(|x| x.is_number()).then_some(inverse)
    }
}

/// The load of a weight as a linear map of `(m c, m)`: force `m g`, torque `m c × g`.
fn map<T: Real>(gravity: &Vector3<T>) -> Matrix6x4<T> {
    let mut map = Matrix6x4::zeros();
    map.fixed_view_mut::<3, 1>(0, 3).copy_from(gravity);
    map.fixed_view_mut::<3, 3>(3, 0).copy_from(&-gravity.cross_matrix());
    map
}

/// `L⁻¹` of a covariance `L Lᵀ`.
pub(crate) struct Whitener<T: Real> {
    lower: Matrix6<T>,
}

impl<T: Real> Whitener<T> {
    /// `None` unless positive definite: beyond rounding, in each direction that the ones before leave.
    pub(crate) fn new(covariance: &Matrix6<T>) -> Option<Self> {
        let lower = covariance.cholesky()?.l();
        let left = |i: usize| lower[(i, i)] * lower[(i, i)] > covariance[(i, i)] * T::EPSILON;
        ((0..6).all(left) && lower.iter().all(|x| x.is_number())).then_some(Self { lower })
    }

    /// A column, or the columns of a map.
    pub(crate) fn apply<const C: usize>(&self, right: &SMatrix<T, 6, C>) -> SMatrix<T, 6, C> {
        self.lower.solve_lower_triangular(right).unwrap_or_else(SMatrix::zeros)
    }
}
