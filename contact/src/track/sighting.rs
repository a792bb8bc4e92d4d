//! One contact and how sure it is, as a tracker takes it.

use fingertip_surfaces::SmoothSurface;
use fingertip_surfaces::numeric::vectors::{larger, tangents};
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix2, Vector2, Vector3};

use super::symmetric::Symmetric;
use crate::uncertainty::LineSpread;
use crate::{Contact, ContactCovariance, ContactJacobian, WrenchSpread};

/// Where one sample found the contact, with the covariance that it has under *this* force: noise of the position
/// grows as the force vanishes (`docs/theory/contact.md#errors-of-a-point-contact`).
///
/// ```
/// use fingertip_contact::{ContactModel, PointContact, Sighting, WrenchSpread};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let ball = Sphere::new(Vector3::zeros(), 0.013)?;
/// let noise = WrenchSpread::Isotropic { force: 1e-4, torque: 1e-8 };
/// let push = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.013), Vector3::new(0.0, 0.0, -0.5));
/// let found = PointContact::new(0.1)?.resolve(&push, &ball).into_result()?;
/// let sighting = Sighting::of_point_contact(&found, &push, noise).ok_or("it grazes")?;
/// // 0.1 N·mm, and 10 mN on an arm of 13 mm, over 0.5 N.
/// let variance: f64 = sighting.covariance().m11;
/// assert!((variance.sqrt() - 0.1_f64.hypot(0.13) * 1e-3 / 0.5).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting<T: Real> {
    pub(super) point: Vector3<T>,
    pub(super) normal: Vector3<T>,
    spread: Spread<T>,
}

/// What is known of the covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Spread<T: Real> {
    /// All, along two tangents that are right-handed with the normal.
    Along([Vector3<T>; 2], Symmetric<T>),
    /// What it is in whatever tangents: told in those of the track there is nothing to turn.
    OfLine(LineSpread<T>),
}

impl<T: Real> Sighting<T> {
    /// Of a point on the surface \[m\], its outward unit normal, two unit vectors in the tangent plane, and the
    /// covariance along them \[m²\].
    ///
    /// The normal is made of unit length to the last digit. Of tangents that are left-handed with it, the second is
    /// turned round, and the covariance with it.
    ///
    /// `None` if a number is not finite, the normal is no unit vector (within 1 %), a variance is negative, or the
    /// covariance larger than its variances allow.
    #[must_use]
    pub fn new(
        point: Vector3<T>,
        normal: Vector3<T>,
        tangents: [Vector3<T>; 2],
        covariance: Matrix2<T>,
    ) -> Option<Self> {
        let squared = normal.norm_squared();
        let straight = (squared - T::one()).abs() <= T::literal(0.02);
        let unit = normal / squared.root();
        let [e1, e2] = tangents;
        let (second, both) =
            if unit.cross(&e1).dot(&e2) < T::zero() { (-e2, -covariance.m12) } else { (e2, covariance.m12) };
        let covariance = Matrix2::new(covariance.m11, both, both, covariance.m22);
        Self::checked(point, unit, [e1, second], covariance).filter(|_| straight)
    }

    /// With a unit normal and tangents that are right-handed with it.
    #[inline(always)]
    fn checked(
        point: Vector3<T>,
        normal: Vector3<T>,
        tangents: [Vector3<T>; 2],
        covariance: Matrix2<T>,
    ) -> Option<Self> {
        let [e1, e2] = tangents;
        let (first, both, second) = (covariance.m11, covariance.m12, covariance.m22);
        let rounding = T::one() + T::EPSILON * T::literal(64.0);
        let both_alike = Symmetric { xx: first, xy: both, yy: second };
        let possible =
            first >= T::zero() && second >= T::zero() && both.abs() <= larger(first, second) * rounding;
        let finite = (e1.sum() + e2.sum() + normal.sum() + point.sum() + first + second).is_number();
        (possible && finite).then_some(Self { point, normal, spread: Spread::Along(tangents, both_alike) })
    }

    /// Of what [`PointContact`](crate::PointContact) found in a wrench. `None` where the force grazes.
    #[inline]
    #[must_use]
    pub fn of_point_contact<'a>(
        contact: &Contact<T>,
        wrench: &Wrench<T>,
        spread: impl Into<WrenchSpread<'a, T>>,
    ) -> Option<Self> {
        let line = LineSpread::new(contact, wrench, &spread.into());
        let (point, normal) = (contact.point, contact.normal);
        let place = (point.x + point.y + point.z) + (normal.x + normal.y + normal.z);
        (place + line.most()).is_number().then_some(Self { point, normal, spread: Spread::OfLine(line) })
    }

    /// Of what [`SoftFinger`](crate::SoftFinger) found on a surface. `None` where no derivative exists, as
    /// [`ContactJacobian::of_soft_finger_on`] says.
    #[inline]
    #[must_use]
    pub fn of_soft_finger<'a, S: SmoothSurface<T>>(
        contact: &Contact<T>,
        surface: &S,
        spread: impl Into<WrenchSpread<'a, T>>,
    ) -> Option<Self> {
        Self::of(contact, &ContactJacobian::of_soft_finger_on(contact, surface)?, spread)
    }

    /// Of any contact whose derivatives are known, such as one through a skin.
    #[inline]
    #[must_use]
    pub fn of<'a>(
        contact: &Contact<T>,
        jacobian: &ContactJacobian<T>,
        spread: impl Into<WrenchSpread<'a, T>>,
    ) -> Option<Self> {
        let covariance = ContactCovariance::position_only(jacobian, spread);
        Self::checked(contact.point, contact.normal, jacobian.tangents(), covariance)
    }

    /// Where it is \[m\].
    #[inline]
    #[must_use]
    pub const fn point(&self) -> &Vector3<T> {
        &self.point
    }

    /// The outward unit normal there.
    #[inline]
    #[must_use]
    pub const fn normal(&self) -> &Vector3<T> {
        &self.normal
    }

    /// The two unit vectors that the covariance refers to.
    #[inline(always)]
    #[must_use]
    pub fn tangents(&self) -> [Vector3<T>; 2] {
        match &self.spread {
            Spread::Along(tangents, _) => *tangents,
            Spread::OfLine(_) => tangents(&self.normal).into(),
        }
    }

    /// Covariance of the position along the tangents \[m²\].
    #[inline]
    #[must_use]
    pub fn covariance(&self) -> Matrix2<T> {
        match &self.spread {
            Spread::Along(_, covariance) => covariance.matrix(),
            Spread::OfLine(line) => {
                let covariance = Symmetric::new(line.along(&self.tangents(), T::one()));
                covariance.at_least([T::zero(); 2]).matrix()
            }
        }
    }

    /// The covariance along two other tangents, right-handed with the normal, in another unit: times a scale \[m²\]. Where
    /// one direction is beyond compare with another, rounding may leave less than no variance.
    #[inline(always)]
    pub(super) fn along(&self, others: &[Vector3<T>; 2], scale: T) -> Symmetric<T> {
        match &self.spread {
            Spread::Along([e1, _], covariance) => {
                covariance.turned(&Vector2::new(others[0].dot(e1), others[1].dot(e1))).scaled(scale)
            }
            Spread::OfLine(line) => Symmetric::new(line.along(others, scale)),
        }
    }
}
