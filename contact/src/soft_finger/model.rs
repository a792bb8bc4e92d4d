//! The soft finger as a contact model.

use fingertip_surfaces::numeric::vectors::larger;
use fingertip_surfaces::{BadShape, ForceLine};
use fingertip_wrench::{Real, stored};

use crate::model::flat;

/// A contact that transmits a force and a torque about the normal: `m = c × f + τ n`, `c` on the
/// surface, `f·n < 0` (Bicchi, Salisbury & Brock 1990, 1993).
///
/// The point is the contact centroid: for a patch on a plane, or one that is small against the
/// radius of curvature, the centre of pressure, whatever the friction (on a sphere, up to
/// 0.06 a²/R for a patch of radius `a` at a friction coefficient of 0.5;
/// `docs/theory/contact.md#contact-centroid`).
///
/// On a convex surface there is at most one such point; a shape that is not convex may have
/// several, and [`Contact::alternatives`](crate::Contact::alternatives) counts the others. Those that would need more friction than
/// [`with_greatest_friction`](Self::with_greatest_friction) allows are set aside. Of the rest the one
/// nearest to the last contact is taken if one is given, otherwise the one where the force presses most
/// squarely.
///
/// Where a body has a round edge of no thickness, a corner or a tip, a contact there has a normal
/// between those of the faces that meet, such that something flat could touch. Meshes and heightfields
/// are taken for the bodies of facets that they are.
///
/// Against [`PointContact`](crate::PointContact): it is right where there is a spin torque, and
/// noisier where there is none, since it takes every torque along the force for spin
/// (`docs/theory/contact.md#errors-of-a-soft-finger`; the factor is the tangent of the angle between force
/// and normal). [`Auto`](crate::Auto) chooses.
///
/// What is no contact is said by type: [`NoContact::PureCouple`](crate::NoContact::PureCouple) where there is a torque but no
/// force, [`NoContact::Ambiguous`](crate::NoContact::Ambiguous) where a force whose line misses could touch at either of two points, and its
/// torque along the force is too small to tell which ([`with_torque_noise`](Self::with_torque_noise)),
/// [`NoContact::BeyondFriction`](crate::NoContact::BeyondFriction) where friction holds no contact,
/// [`NoContact::Unresolved`](crate::NoContact::Unresolved) where a search ended at its bound, or rounding of the wrench hides whether
/// there is a contact, as of a needle under a large spin torque.
///
/// ```
/// use fingertip_contact::{ContactModel, SoftFinger};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // Noise below 50 mN; a patch with a torque arm of 2 mm.
/// let model = SoftFinger::new(0.05)?.with_torque_arm(2e-3)?;
/// let (sphere, normal) = (Sphere::centred(0.01)?, Vector3::new(0.6, 0.0, 0.8));
/// // 2 N on the side of a sphere of 10 mm, and 1.5 N·mm about the normal there.
/// let push: Wrench<f64> = Wrench::from_force_at(&(normal * 0.01), Vector3::new(-1.2, 0.3, -1.6));
/// let wrench = Wrench::on_fingertip(push.force(), push.torque() + normal * 1.5e-3);
/// let contact = model.resolve(&wrench, &sphere).into_result()?;
/// assert!((contact.point - normal * 0.01).norm() < 1e-9 && (contact.spin_torque - 1.5e-3_f64).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftFinger<T: Real> {
    pub(super) least_force: T,
    /// The least square of a force that takes the short way.
    pub(crate) least_squared: T,
    pub(super) greatest_friction: Option<T>,
    pub(super) torque_arm: Option<T>,
    pub(super) torque_noise: T,
}

impl<T: Real> SoftFinger<T> {
    /// The friction ratio that no contact may exceed unless another limit is stated: several times that of soft
    /// rubber on glass, so that no contact of a finger that does not stick is refused.
    pub const GREATEST_FRICTION: f64 = 10.0;

    /// Forces below `least_force` \[N\] are no contact. Take it from the noise of the sensor: three
    /// to five standard deviations of the force at rest. Zero accepts every force but zero.
    ///
    /// # Errors
    /// [`BadShape`] unless the threshold is finite and not negative.
    pub fn new(least_force: T) -> Result<Self, BadShape> {
        let good = least_force >= T::zero() && least_force.is_number();
        let unlimited = Self {
            least_force,
            least_squared: T::GREATEST,
            greatest_friction: Some(T::literal(Self::GREATEST_FRICTION)),
            torque_arm: None,
            torque_noise: T::zero(),
        };
        BadShape::check("soft finger", "least force", "finite and not negative", good)
            .map(|()| unlimited.taking_the_short_way())
    }

    /// With the short way open to the forces of which it answers nothing that a limit would refuse: it takes
    /// none at an angle as flat as 1 in [`flat`], and knows no torque arm and no noise.
    fn taking_the_short_way(self) -> Self {
        let flattest = T::one() / flat::<T>();
        let no_limit =
            self.greatest_friction.is_none_or(|friction| friction >= flattest && self.torque_arm.is_none());
        let open = no_limit && self.torque_noise.is_zero();
        let least_force = self.least_force;
        let least = larger(least_force * least_force, ForceLine::least_squared());
        Self { least_squared: if open { least } else { T::GREATEST }, ..self }
    }

    /// No contact needs a friction ratio above `greatest_friction`, instead of
    /// [10](Self::GREATEST_FRICTION), and with a [torque arm](Self::with_torque_arm) none needs more for its force
    /// and spin torque together: `√(|f_t|² + (τ/e)²) ≤ μ f_n` (`docs/theory/friction.md#soft-finger-limit`).
    ///
    /// A pure force whose line misses has noise along it, which looks like a spin torque; the only contacts that
    /// explain it are such that next to nothing presses. A force of 2 N that passes the centre of a sphere of 13 mm
    /// at 14 mm, with 1e-9 N·m along it, would press with 2e-7 N and spin with 10 mN·m. So the answer follows from
    /// what friction can hold, and not from the last digits of `f·m`.
    ///
    /// Below a ratio of 3.4, and with a torque arm, the shorter way to simple shapes is not taken.
    ///
    /// # Errors
    /// [`BadShape`] unless it is finite and not negative.
    pub fn with_greatest_friction(self, greatest_friction: T) -> Result<Self, BadShape> {
        let good = greatest_friction >= T::zero() && greatest_friction.is_number();
        BadShape::check("soft finger", "greatest friction", "finite and not negative", good)
            .map(|()| Self { greatest_friction: Some(greatest_friction), ..self }.taking_the_short_way())
    }

    /// Every solution of the equations at which the force presses is a contact, however little it does: for
    /// whoever looks at friction later. Wrenches that miss are then explained by contacts that no friction holds.
    #[must_use]
    pub fn without_friction_limit(self) -> Self {
        Self { greatest_friction: None, ..self }.taking_the_short_way()
    }

    /// The torque arm `e` \[m\] of the contact, by which a spin torque counts as a tangential force: `3πa/16` for
    /// Hertz's patch of radius `a`, and never more than the radius of the patch. It has no say
    /// [without a friction limit](Self::without_friction_limit).
    ///
    /// # Errors
    /// [`BadShape`] unless it is positive and finite.
    pub fn with_torque_arm(self, torque_arm: T) -> Result<Self, BadShape> {
        let good = torque_arm > T::zero() && torque_arm.is_number();
        BadShape::check("soft finger", "torque arm", "positive and finite", good)
            .map(|()| Self { torque_arm: Some(torque_arm), ..self }.taking_the_short_way())
    }

    /// A torque along the force of at most `torque_noise` \[N·m\] may be noise: three standard deviations of the
    /// torque, say. Zero, unless it is stated, and then nothing but its rounding is.
    ///
    /// It decides where a line of action misses. The spin torque then tells on which of two sides the contact is,
    /// by its sign; one that is within the noise tells nothing, and the answer is [`NoContact::Ambiguous`](crate::NoContact::Ambiguous), with
    /// both places. Where the line meets the surface the sign decides nothing, and the answer is the contact.
    ///
    /// With it, the shorter way to simple shapes is not taken.
    ///
    /// # Errors
    /// [`BadShape`] unless it is finite and not negative.
    pub fn with_torque_noise(self, torque_noise: T) -> Result<Self, BadShape> {
        let good = torque_noise >= T::zero() && torque_noise.is_number();
        BadShape::check("soft finger", "torque noise", "finite and not negative", good)
            .map(|()| Self { torque_noise, ..self }.taking_the_short_way())
    }

    /// How much torque along a force may be noise \[N·m\].
    #[inline]
    #[must_use]
    pub const fn torque_noise(&self) -> T {
        self.torque_noise
    }

    /// The greatest friction ratio that a contact may need, if there is a limit.
    #[inline]
    #[must_use]
    pub const fn greatest_friction(&self) -> Option<T> {
        self.greatest_friction
    }

    /// The torque arm \[m\], if one is stated.
    #[inline]
    #[must_use]
    pub const fn torque_arm(&self) -> Option<T> {
        self.torque_arm
    }

    /// The least force that counts as a contact \[N\].
    #[inline]
    #[must_use]
    pub const fn least_force(&self) -> T {
        self.least_force
    }
}

stored! {
    SoftFinger<T>, [T: Real],
    |model| {
        #[serde(rename = "least_force_N", default = "T::zero")]
        least_force: T = model.least_force,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        greatest_friction: Option<T> = model.greatest_friction,
        #[serde(default, skip_serializing_if = "core::ops::Not::not")]
        no_friction_limit: bool = model.greatest_friction.is_none(),
        #[serde(default, skip_serializing_if = "Option::is_none")]
        torque_arm_m: Option<T> = model.torque_arm,
        #[serde(rename = "torque_noise_N_m", default = "T::zero")]
        torque_noise: T = model.torque_noise,
    },
    SoftFinger::new(least_force)
        .and_then(|model| match greatest_friction {
            Some(friction) => model.with_greatest_friction(friction),
            None if no_friction_limit => Ok(model.without_friction_limit()),
            None => Ok(model),
        })
        .and_then(|model| model.with_torque_noise(torque_noise))
        .and_then(|model| match torque_arm_m {
            Some(arm) => model.with_torque_arm(arm),
            None => Ok(model),
        })
}
