//! The covariance of a contact.

use fingertip_surfaces::SmoothSurface;
use fingertip_surfaces::numeric::vectors::{larger, tangents};
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix2, Matrix3, Matrix6, Vector3, Vector6};

use super::{ContactJacobian, GeometrySensitivity, GeometryUncertainty, LineSpread, WrenchSpread};
use crate::Contact;

/// How noise of the wrench and of the geometry spreads a contact, to first order: the covariance
/// of its position along the two tangents \[m\], normal force, tangential force along the two
/// tangents \[N\] and spin torque \[N·m\].
///
/// ```
/// use fingertip_contact::{ContactCovariance, ContactJacobian, ContactModel, SoftFinger};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix6, Vector3};
///
/// // 1 N at the top of a sphere of 10 mm; 10 mN and 0.1 N·mm of noise.
/// let (sphere, wrench) = (Sphere::centred(0.01)?, Wrench::on_fingertip(-Vector3::z(), Vector3::zeros()));
/// let contact = SoftFinger::new(0.05)?.resolve(&wrench, &sphere).into_result()?;
/// let jacobian = ContactJacobian::of_soft_finger_on(&contact, &sphere).ok_or("it grazes")?;
/// let noise = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// let covariance = ContactCovariance::new(&jacobian, &noise);
/// // 0.1 mm from the torque, and 0.1 mm from the force on its arm.
/// assert!((covariance.position().m11 - 2e-8_f64).abs() < 1e-12);
/// assert!((covariance.normal_force_variance().sqrt() - 0.01).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct ContactCovariance<T: Real> {
    local: Matrix6<T>,
    tangents: [Vector3<T>; 2],
    normal: Vector3<T>,
    height: T,
}

/// The ellipse in the tangent plane that holds the contact with a given probability.
///
/// ```
/// # use fingertip_contact::{ContactJacobian, ContactModel, SoftFinger};
/// # use fingertip_surfaces::Sphere;
/// # use fingertip_wrench::Wrench;
/// # use nalgebra::{Matrix6, Vector3};
/// # let (sphere, wrench) = (Sphere::centred(0.01)?, Wrench::on_fingertip(-Vector3::z(), Vector3::zeros()));
/// # let contact = SoftFinger::new(0.05)?.resolve(&wrench, &sphere).into_result()?;
/// # let jacobian = ContactJacobian::of_soft_finger_on(&contact, &sphere).ok_or("it grazes")?;
/// # let noise = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// use fingertip_contact::{ConfidenceEllipse, ContactCovariance};
///
/// // Of a contact at the top of a sphere, known to √2 · 0.1 mm in each direction.
/// let covariance = ContactCovariance::new(&jacobian, &noise);
/// let ellipse: ConfidenceEllipse<f64> = covariance.ellipse(0.95).ok_or("no probability")?;
/// let expected = (-2.0 * 0.05_f64.ln()).sqrt() * 2.0_f64.sqrt() * 0.1e-3;
/// assert!(ellipse.semi_axes.iter().all(|metres| (metres - expected).abs() < 1e-9));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct ConfidenceEllipse<T: Real> {
    /// The longer and the shorter semi-axis \[m\].
    pub semi_axes: [T; 2],
    /// Unit vectors along them.
    pub directions: [Vector3<T>; 2],
}

impl<T: Real> ContactCovariance<T> {
    /// From the covariance of the wrench `[Fx … Tz]` \[N², N·N·m, (N·m)²\], symmetric.
    #[must_use]
    pub fn new(jacobian: &ContactJacobian<T>, wrench: &Matrix6<T>) -> Self {
        let (rows, height) = (jacobian.local(), jacobian.height());
        Self {
            local: rows * wrench * rows.transpose(),
            tangents: jacobian.tangents(),
            normal: jacobian.normal(),
            height: height.dot(&(wrench * height)),
        }
    }

    /// Only the covariance of the position, along the tangents: what a tracker needs at every
    /// sample, at a fraction of the cost. Noise that is the same in all directions, or independent in
    /// each, costs less again than a full covariance.
    #[inline]
    #[must_use]
    pub fn position_only<'a>(
        jacobian: &ContactJacobian<T>,
        wrench: impl Into<WrenchSpread<'a, T>>,
    ) -> Matrix2<T> {
        jacobian.position_covariance(wrench.into())
    }

    /// The same, straight from a contact that [`PointContact`](crate::PointContact) found in a wrench, on
    /// whatever surface: its curvature does not matter. `None` where the force grazes.
    #[inline(always)]
    #[must_use]
    pub fn point_contact_position<'a>(
        contact: &Contact<T>,
        wrench: &Wrench<T>,
        spread: impl Into<WrenchSpread<'a, T>>,
    ) -> Option<Matrix2<T>> {
        let (first, second) = tangents(&contact.normal);
        let [c11, c12, c22] =
            LineSpread::new(contact, wrench, &spread.into()).along(&[first, second], T::one());
        // Asked last: a question half way would cost more.
        let known = |variance| larger(variance, T::zero());
        (c11 + c22).is_number().then_some(Matrix2::new(known(c11), c12, c12, known(c22)))
    }

    /// The same, straight from a contact that [`SoftFinger`](crate::SoftFinger) found on a surface: the
    /// fastest way. `None` where the derivative does not exist, as
    /// [`ContactJacobian::of_soft_finger_on`] says.
    #[inline]
    #[must_use]
    pub fn soft_finger_position<'a, S: SmoothSurface<T>>(
        contact: &Contact<T>,
        surface: &S,
        wrench: impl Into<WrenchSpread<'a, T>>,
    ) -> Option<Matrix2<T>> {
        ContactJacobian::soft_position_covariance(contact, surface, wrench.into())
    }

    /// Adds an uncertain geometry, independent of the wrench.
    #[must_use]
    pub fn with_geometry(mut self, jacobian: &ContactJacobian<T>, geometry: &GeometryUncertainty<T>) -> Self {
        self.add(jacobian, &GeometrySensitivity::offset(), geometry.offset);
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let moved = axes.map(|axis| jacobian.answer_to_motion(&axis, &Vector3::zeros()));
        let turned = axes.map(|axis| jacobian.answer_to_motion(&geometry.pivot.cross(&axis), &axis));
        for (answers, covariance) in [(moved, geometry.position), (turned, geometry.attitude)] {
            for i in 0..3 {
                for j in 0..3 {
                    let ((one, rise), (other, other_rise)) = (&answers[i], &answers[j]);
                    self.local += one * other.transpose() * covariance[(i, j)];
                    self.height += *rise * *other_rise * covariance[(i, j)];
                }
            }
        }
        self
    }

    /// Adds one parameter of the surface with its variance, independent of all else. Through a skin the
    /// change is that of the deformed surface, [`ContactJacobian::of_deformed`].
    #[must_use]
    pub fn with_parameter(
        mut self,
        jacobian: &ContactJacobian<T>,
        change: &GeometrySensitivity<T>,
        variance: T,
    ) -> Self {
        self.add(jacobian, change, variance);
        self
    }

    fn add(&mut self, jacobian: &ContactJacobian<T>, change: &GeometrySensitivity<T>, variance: T) {
        let (answer, rise) = (jacobian.answer_to(change), jacobian.rise_with(change));
        self.local += answer * answer.transpose() * variance;
        self.height += rise * rise * variance;
    }

    /// The whole covariance, in the order of [`ContactJacobian::local`].
    #[inline]
    #[must_use]
    pub const fn local(&self) -> &Matrix6<T> {
        &self.local
    }

    /// Unit vectors in the tangent plane that the positions refer to.
    #[inline]
    #[must_use]
    pub const fn tangents(&self) -> [Vector3<T>; 2] {
        self.tangents
    }

    /// Covariance of the position along the tangents \[m²\].
    #[inline]
    #[must_use]
    pub fn position(&self) -> Matrix2<T> {
        self.local.fixed_view::<2, 2>(0, 0).into_owned()
    }

    /// Covariance of the position in the sensor frame \[m²\]: of rank 2, in the tangent plane, as
    /// the contact stays on the surface. (An uncertain surface and a skin also move along the normal:
    /// [`height_variance`](Self::height_variance).)
    #[must_use]
    pub fn point(&self) -> Matrix3<T> {
        let [e1, e2] = self.tangents;
        let p = self.position();
        let mixed = e1 * e2.transpose() + e2 * e1.transpose();
        e1 * e1.transpose() * p.m11 + mixed * p.m12 + e2 * e2.transpose() * p.m22
    }

    /// Variance of the contact's height along the normal \[m²\]; zero unless the geometry is uncertain or
    /// a skin gives way.
    #[inline]
    #[must_use]
    pub const fn height_variance(&self) -> T {
        self.height
    }

    /// Variance of the normal force \[N²\].
    #[inline]
    #[must_use]
    pub fn normal_force_variance(&self) -> T {
        self.local[(2, 2)]
    }

    /// Covariance of the tangential force along the tangents \[N²\].
    #[inline]
    #[must_use]
    pub fn tangential_force(&self) -> Matrix2<T> {
        self.local.fixed_view::<2, 2>(3, 3).into_owned()
    }

    /// Variance of the spin torque \[(N·m)²\].
    #[inline]
    #[must_use]
    pub fn spin_variance(&self) -> T {
        self.local[(5, 5)]
    }

    /// Covariance of normal force and magnitude of the tangential force \[N²\]: what the slip
    /// margin of a friction cone needs. Where there is no tangential force, its magnitude has no
    /// derivative; the larger of the two tangential variances stands for it.
    #[must_use]
    pub fn normal_and_tangential(&self, contact: &Contact<T>) -> Matrix2<T> {
        let [e1, e2] = self.tangents;
        let (t1, t2) = (contact.force.dot(&e1), contact.force.dot(&e2));
        let scale = t1.abs().max(t2.abs()).normalising_factor();
        let length = ((t1 * scale) * (t1 * scale) + (t2 * scale) * (t2 * scale)).root() / scale;
        if !(length > T::zero()) {
            let tangential = self.tangential_force();
            let largest = tangential.m11.max(tangential.m22);
            return Matrix2::new(self.normal_force_variance(), T::zero(), T::zero(), largest);
        }
        let row = Vector6::new(T::zero(), T::zero(), T::zero(), t1 / length, t2 / length, T::zero());
        let with_row = self.local * row;
        Matrix2::new(self.normal_force_variance(), with_row[2], with_row[2], row.dot(&with_row))
    }

    /// The ellipse that holds the contact with `probability` in (0, 1), for Gaussian noise; `None`
    /// for another probability. Its size is the root of `−2 ln(1 − probability)`, the quantile of
    /// χ² with two degrees of freedom.
    #[must_use]
    pub fn ellipse(&self, probability: T) -> Option<ConfidenceEllipse<T>> {
        if !(probability > T::zero() && probability < T::one()) {
            return None;
        }
        let size = (-(T::one() - probability).logarithm() * T::literal(2.0)).root();
        let p = self.position();
        let half = T::literal(0.5);
        let (mean, apart) = ((p.m11 + p.m22) * half, (p.m11 - p.m22) * half);
        let scale = apart.abs().max(p.m12.abs()).normalising_factor();
        let (x, y) = (apart * scale, p.m12 * scale);
        let spread = (x * x + y * y).root() / scale;
        let angle = p.m12.arctangent2(apart) * half;
        let (sin, cos) = (angle.sine(), angle.cosine());
        let [e1, e2] = self.tangents;
        let axis = |variance: T| variance.max(T::zero()).root() * size;
        Some(ConfidenceEllipse {
            semi_axes: [axis(mean + spread), axis(mean - spread)],
            directions: [e1 * cos + e2 * sin, e2 * cos - e1 * sin],
        })
    }
}
