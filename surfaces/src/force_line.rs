//! The line of action before anything has been divided.

use fingertip_wrench::{Line, Real, RigidTransform, Wrench};
use nalgebra::Vector3;

/// The line along which a force acts, given by the force and its torque about the origin: what a
/// closed form needs of a wrench, without the division and the root that a unit direction and a
/// foot point cost.
///
/// The magnitude of the force lies between [`least_squared`](Self::least_squared) and
/// [`greatest_squared`](Self::greatest_squared), so that its square is as good as exact; the torque
/// may be anything, NaN included, and may have a part along the force.
///
/// ```
/// use fingertip_surfaces::ForceLine;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // 2 N down at x = 10 mm.
/// let point = Vector3::new(0.01, 0.0, 0.03);
/// let wrench: Wrench<f64> = Wrench::from_force_at(&point, Vector3::new(0.0, 0.0, -2.0));
/// let push = ForceLine::new(&wrench, ForceLine::least_squared()).unwrap();
/// assert_eq!(push.squared(), 4.0);
/// assert!((push.line().point - Vector3::new(0.01, 0.0, 0.0)).amax() < 1e-15);
/// assert!(push.torque_about(&point).amax() < 1e-15); // it turns nothing about its own point
/// // No load has no line.
/// assert_eq!(ForceLine::new(&Wrench::<f64>::zero(), ForceLine::least_squared()), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceLine<T: Real> {
    force: Vector3<T>,
    torque: Vector3<T>,
    squared: T,
}

impl<T: Real> ForceLine<T> {
    /// `ν/ε²`, ν being the least normal number: the square of 1e-12 N in single precision.
    /// Products that underflow then move the line by less than ε³ metres.
    #[inline]
    #[must_use]
    pub fn least_squared() -> T {
        T::LEAST_NORMAL / (T::EPSILON * T::EPSILON)
    }

    /// The force must not be larger, lest products overflow: the largest number times ε².
    #[inline]
    #[must_use]
    pub fn greatest_squared() -> T {
        T::GREATEST * (T::EPSILON * T::EPSILON)
    }

    /// `None` if the square of the force \[N²\] is below `least_squared` or beyond the range that this
    /// shortcut is for.
    #[inline]
    #[must_use]
    pub fn new(wrench: &Wrench<T>, least_squared: T) -> Option<Self> {
        let (line, is_in_range) = Self::tried(wrench, least_squared);
        is_in_range.then_some(line)
    }

    /// The same of any force, and whether it is in range: if not, nothing that the line says holds. For loops without a
    /// branch.
    #[doc(hidden)]
    #[inline(always)]
    pub fn tried(wrench: &Wrench<T>, least_squared: T) -> (Self, bool) {
        let force = wrench.force();
        let squared = force.norm_squared();
        let is_in_range = (squared >= least_squared) & !(squared > Self::greatest_squared());
        (Self { force, torque: wrench.torque(), squared }, is_in_range)
    }

    /// Along a line, with a force of 1 N.
    #[must_use]
    pub fn along(line: &Line<T>) -> Self {
        let torque = line.point.cross(&line.direction);
        Self { force: line.direction, torque, squared: line.direction.norm_squared() }
    }

    /// The force \[N\].
    #[inline]
    #[must_use]
    pub const fn force(&self) -> Vector3<T> {
        self.force
    }

    /// Its torque about the origin \[N·m\]; a part along the force says nothing of the line.
    #[inline]
    #[must_use]
    pub const fn torque(&self) -> Vector3<T> {
        self.torque
    }

    /// The torque about another point \[N·m\].
    #[inline]
    #[must_use]
    pub fn torque_about(&self, point: &Vector3<T>) -> Vector3<T> {
        self.torque + self.force.cross(point)
    }

    /// The square of the force \[N²\].
    #[inline]
    #[must_use]
    pub const fn squared(&self) -> T {
        self.squared
    }

    /// The line with its foot point and a unit direction, for shapes that work with these.
    #[inline]
    #[must_use]
    pub fn line(&self) -> Line<T> {
        let inverse = T::one() / self.squared;
        Line {
            point: self.force.cross(&self.torque) * inverse,
            direction: self.force * (inverse * self.squared.root()),
        }
    }

    /// Seen from a frame whose place in this one is `pose`.
    #[inline]
    #[must_use]
    pub fn seen_from(&self, pose: &RigidTransform<T>) -> Self {
        let back = |v: &Vector3<T>| pose.rotation().tr_mul(v);
        Self {
            force: back(&self.force),
            torque: back(&self.torque_about(&pose.origin())),
            squared: self.squared,
        }
    }
}
