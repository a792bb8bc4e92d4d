//! A force and a torque about the origin of a named frame.

use core::marker::PhantomData;
use core::ops::{Add, Mul, Neg, Sub};

use nalgebra::{Vector3, Vector6};

use crate::{Frame, Real, RigidTransform, Sensor};

/// The load that the environment applies **to the fingertip**: force \[N\] and torque \[N·m\]
/// about the origin of frame `F`.
///
/// Which of the two opposite loads of a contact is meant decides where a contact is found: the
/// wrong sign gives the antipode. So the constructors say it: [`on_fingertip`](Self::on_fingertip)
/// takes our convention, [`from_reaction`](Self::from_reaction) the opposite one.
///
/// ```
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // An object presses with 2 N on the top of a fingertip whose z axis points outward.
/// let pressed: Wrench<f64> = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::zeros());
/// // A sensor that reports what the finger does to the object says the opposite.
/// let reported = Wrench::from_reaction(Vector3::new(0.0, 0.0, 2.0), Vector3::zeros());
/// assert_eq!(pressed, reported);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct Wrench<T: Real, F: Frame = Sensor> {
    force: Vector3<T>,
    torque: Vector3<T>,
    #[cfg_attr(feature = "serde", serde(skip))]
    frame: PhantomData<F>,
}

impl<T: Real, F: Frame> Wrench<T, F> {
    /// From the load that the environment applies to the fingertip.
    #[inline]
    #[must_use]
    pub const fn on_fingertip(force: Vector3<T>, torque: Vector3<T>) -> Self {
        Self { force, torque, frame: PhantomData }
    }

    /// From the load that the fingertip applies to the environment: both vectors are negated.
    #[inline]
    #[must_use]
    pub fn from_reaction(force: Vector3<T>, torque: Vector3<T>) -> Self {
        Self::on_fingertip(-force, -torque)
    }

    /// From `[Fx, Fy, Fz, Tx, Ty, Tz]` of the load on the fingertip.
    #[inline]
    #[must_use]
    pub fn from_components(components: &Vector6<T>) -> Self {
        let [fx, fy, fz, tx, ty, tz] = (*components).into();
        Self::on_fingertip(Vector3::new(fx, fy, fz), Vector3::new(tx, ty, tz))
    }

    /// A pure force acting at a point of the frame: torque `point × force`.
    #[inline]
    #[must_use]
    pub fn from_force_at(point: &Vector3<T>, force: Vector3<T>) -> Self {
        Self::on_fingertip(force, point.cross(&force))
    }

    /// No load.
    #[inline]
    #[must_use]
    pub fn zero() -> Self {
        Self::on_fingertip(Vector3::zeros(), Vector3::zeros())
    }

    /// Force on the fingertip \[N\].
    #[inline]
    #[must_use]
    pub const fn force(&self) -> Vector3<T> {
        self.force
    }

    /// Torque on the fingertip about the origin of the frame \[N·m\].
    #[inline]
    #[must_use]
    pub const fn torque(&self) -> Vector3<T> {
        self.torque
    }

    /// `[Fx, Fy, Fz, Tx, Ty, Tz]`.
    #[inline]
    #[must_use]
    pub fn components(&self) -> Vector6<T> {
        let (f, m) = (&self.force, &self.torque);
        Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
    }

    /// Force \[N\] and torque \[N·m\] that the fingertip applies to the environment.
    #[inline]
    #[must_use]
    pub fn reaction(&self) -> (Vector3<T>, Vector3<T>) {
        (-self.force, -self.torque)
    }

    /// Torque of this load about another point of the same frame: `m − point × f`.
    #[inline]
    #[must_use]
    pub fn torque_about(&self, point: &Vector3<T>) -> Vector3<T> {
        self.torque - point.cross(&self.force)
    }

    /// The same load, expressed in frame `To` and with its torque about the origin of `To`:
    /// `f' = R f`, `m' = R m + t × R f` (`docs/theory/wrench.md#wrench-and-frames`).
    #[inline]
    #[must_use]
    pub fn expressed_in<To: Frame>(&self, to_from_here: &RigidTransform<T, To, F>) -> Wrench<T, To> {
        let force = to_from_here.rotate(&self.force);
        let torque = to_from_here.rotate(&self.torque) + to_from_here.origin().cross(&force);
        Wrench::on_fingertip(force, torque)
    }

    /// `true` if no component is NaN or infinite.
    #[inline]
    #[must_use]
    pub fn is_finite(&self) -> bool {
        // Zero times NaN or infinity is NaN. A sum of the components themselves might overflow.
        let (f, m) = (self.force * T::zero(), self.torque * T::zero());
        (f.x + f.y + f.z + m.x + m.y + m.z).is_number()
    }
}

impl<T: Real, F: Frame> Add for Wrench<T, F> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::on_fingertip(self.force + other.force, self.torque + other.torque)
    }
}

impl<T: Real, F: Frame> Sub for Wrench<T, F> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self::on_fingertip(self.force - other.force, self.torque - other.torque)
    }
}

impl<T: Real, F: Frame> Neg for Wrench<T, F> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::on_fingertip(-self.force, -self.torque)
    }
}

impl<T: Real, F: Frame> Mul<T> for Wrench<T, F> {
    type Output = Self;
    #[inline]
    fn mul(self, factor: T) -> Self {
        Self::on_fingertip(self.force * factor, self.torque * factor)
    }
}
