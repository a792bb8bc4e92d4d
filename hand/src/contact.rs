//! A contact of a grasp, as a value.

use core::marker::PhantomData;

use fingertip_wrench::{ContactForce, ContactFrame, Frame, Real, RigidTransform, Wrench};
use nalgebra::{Matrix6x4, Vector3, Vector4};

use crate::{BadContact, ContactFriction};

/// The frame in which the fingertips of a hand are told: that of the palm, or of the object. The default of every
/// type of this crate that names a frame.
///
/// ```
/// use fingertip_hand::Hand;
/// use fingertip_wrench::Frame;
///
/// assert_eq!(Hand::NAME, "hand");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hand;

impl Frame for Hand {
    const NAME: &'static str = "hand";
}

/// Where a fingertip touches the object, and what friction allows there: `|f_t|² + (τ/e)² ≤ (μ f_n)²`.
///
/// A point contact carries no spin torque; a soft finger has a torque arm `e`. Any sensor and any surface may have
/// told the place; a fingertip of this project tells it by its contact's point and normal.
///
/// ```
/// use fingertip_hand::GraspContact;
/// use nalgebra::Vector3;
///
/// // The fingertip presses along +x into an object; friction 0.6, torque arm 2 mm.
/// let place = Vector3::new(-0.03, 0.0, 0.0);
/// let contact: GraspContact<f64> = GraspContact::soft(place, Vector3::x(), 0.6, 2e-3)?;
/// assert_eq!(contact.normal(), Vector3::x());
/// # Ok::<(), fingertip_hand::BadContact>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GraspContact<T: Real, F: Frame = Hand> {
    frame: ContactFrame<T>,
    friction: ContactFriction<T>,
    of: PhantomData<F>,
}

impl<T: Real, F: Frame> GraspContact<T, F> {
    /// From its point \[m\], the fingertip's outward normal there (into the object; of any length) and its friction.
    ///
    /// # Errors
    /// [`BadContact::BadPlace`] if the point is not finite or the normal has no direction.
    pub fn new(
        point: Vector3<T>,
        outward: Vector3<T>,
        friction: impl Into<ContactFriction<T>>,
    ) -> Result<Self, BadContact> {
        let frame = ContactFrame::new(point, outward).map_err(|_| BadContact::BadPlace)?;
        Ok(Self { frame, friction: friction.into(), of: PhantomData })
    }

    /// A point contact, from its friction coefficient.
    ///
    /// # Errors
    /// [`BadContact`] as [`new`](Self::new), or if the coefficient is not positive and finite.
    pub fn point(point: Vector3<T>, outward: Vector3<T>, friction: T) -> Result<Self, BadContact> {
        Self::new(point, outward, ContactFriction::point(friction)?)
    }

    /// A soft finger, from its friction coefficient and [torque arm](ContactFriction::soft) \[m\].
    ///
    /// # Errors
    /// [`BadContact`] as [`point`](Self::point), or if the arm is not positive and finite.
    pub fn soft(point: Vector3<T>, outward: Vector3<T>, friction: T, arm: T) -> Result<Self, BadContact> {
        Self::new(point, outward, ContactFriction::soft(friction, arm)?)
    }

    /// The same with friction divided by a factor of safety, at least 1.
    ///
    /// # Errors
    /// [`BadContact::BadSafety`].
    pub fn with_safety(self, safety: T) -> Result<Self, BadContact> {
        match self.with_friction(self.friction() / safety) {
            Some(contact) if safety >= T::one() && safety.is_number() => Ok(contact),
            _ => Err(BadContact::BadSafety),
        }
    }

    /// With another friction coefficient; `None` unless it is positive and finite.
    pub(crate) fn with_friction(self, coefficient: T) -> Option<Self> {
        Some(Self { friction: self.friction.with_coefficient(coefficient)?, ..self })
    }

    /// As a sensor tells it that is in the object and not in the fingertip: the other side of the same contact.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let frame = ContactFrame::new(self.place(), -self.normal()).unwrap_or(self.frame);
        Self { frame, ..*self }
    }

    /// The contact in another frame.
    #[must_use]
    pub fn expressed_in<To: Frame>(&self, to_from_here: &RigidTransform<T, To, F>) -> GraspContact<T, To> {
        let point = to_from_here.transform_point(&self.frame.point());
        let normal = to_from_here.rotate(&self.frame.normal());
        // Rotation keeps the direction; a place out of range stays what it was and is refused by the grasp.
        let frame = ContactFrame::new(point, normal).unwrap_or(self.frame);
        GraspContact { frame, friction: self.friction, of: PhantomData }
    }

    /// The point \[m\].
    #[inline]
    #[must_use]
    pub const fn place(&self) -> Vector3<T> {
        self.frame.point()
    }

    /// The fingertip's outward unit normal: into the object.
    #[inline]
    #[must_use]
    pub const fn normal(&self) -> Vector3<T> {
        self.frame.normal()
    }

    /// The friction coefficient μ, after any factor of safety.
    #[inline]
    #[must_use]
    pub const fn friction(&self) -> T {
        self.friction.coefficient()
    }

    /// The torque arm e \[m\]; zero for a point contact.
    #[inline]
    #[must_use]
    pub const fn arm(&self) -> T {
        self.friction.arm()
    }

    /// What a contact force is as a wrench on the fingertip, about the origin of the frame.
    #[inline]
    #[must_use]
    pub fn wrench(&self, force: &ContactForce<T>) -> Wrench<T, F> {
        let (point, normal) = (self.frame.point(), self.frame.normal());
        let on_tip = force.tangential.vector() - normal * force.normal;
        Wrench::on_fingertip(on_tip, point.cross(&on_tip) + normal * force.spin)
    }

    /// The columns of the grasp map for forces `[f_n, f_t1/μ, f_t2/μ, τ/(μe)]` on the object, torques about `origin`
    /// and divided by `length`.
    #[inline]
    pub(crate) fn columns(&self, origin: &Vector3<T>, length: T) -> Matrix6x4<T> {
        let arm = (self.frame.point() - origin) / length;
        let normal = self.frame.normal();
        let [first, second] = self.frame.tangents();
        let mut map = Matrix6x4::zeros();
        let directions = [normal, first * self.friction(), second * self.friction()];
        for (mut column, direction) in map.column_iter_mut().zip(&directions) {
            column.fixed_rows_mut::<3>(0).copy_from(direction);
            column.fixed_rows_mut::<3>(3).copy_from(&arm.cross(direction));
        }
        let spin = normal * (self.friction() * (self.arm() / length));
        map.fixed_view_mut::<3, 1>(3, 3).copy_from(&spin);
        map
    }

    /// The force on the fingertip of forces on the object as [`columns`](Self::columns) takes them.
    #[inline]
    pub(crate) fn force(&self, scaled: &Vector4<T>) -> ContactForce<T> {
        let [first, second] = self.frame.tangents();
        let tangential = (first * scaled.y + second * scaled.z) * -self.friction();
        ContactForce::new(scaled.x, tangential, -scaled.w * self.friction() * self.arm())
    }

    /// The reverse of [`force`](Self::force).
    #[inline]
    pub(crate) fn scaled(&self, force: &ContactForce<T>) -> Vector4<T> {
        let [first, second] = self.frame.tangents();
        let on_object = force.tangential.vector() / -self.friction();
        let spin = self.friction() * self.arm();
        let spin = if spin > T::zero() { -force.spin / spin } else { T::zero() };
        Vector4::new(force.normal, first.dot(&on_object), second.dot(&on_object), spin)
    }
}
