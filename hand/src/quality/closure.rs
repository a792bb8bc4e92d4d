//! Force closure.

use fingertip_wrench::{ContactForce, Frame, Real, Wrench};

use crate::{FingerLimits, Grasp, Reach};

impl<T: Real, const N: usize, F: Frame> Grasp<T, N, F> {
    /// Whether the contacts can bear any load at all, if only they press hard enough; `None` where that is closer
    /// than the scalar type can tell.
    ///
    /// That is so if the grasp map has rank 6 and internal forces exist that lie strictly within friction
    /// (`docs/theory/hand.md#force-closure`).
    ///
    /// ```
    /// use fingertip_hand::{Grasp, GraspContact};
    /// use nalgebra::Vector3;
    ///
    /// let at = |x: f64| GraspContact::<f64>::soft(Vector3::x() * x, -Vector3::x() * x, 0.5, 3e-3);
    /// assert_eq!(Grasp::new([Some(at(-0.02)?), Some(at(0.02)?)]).force_closure(), Some(true));
    /// assert_eq!(Grasp::new([Some(at(-0.02)?), None]).force_closure(), Some(false));
    /// # Ok::<(), fingertip_hand::BadContact>(())
    /// ```
    #[must_use]
    pub fn force_closure(&self) -> Option<bool> {
        if self.rank() < 6 {
            return Some(false);
        }
        // With all fingers pressing with 1 N beside what they choose to, up to 1 N: how much of that balances?
        let mut pressing = [ContactForce::zero(); N];
        for force in &mut pressing {
            force.normal = T::one();
        }
        let pressing = self.wrench(&pressing);
        let off = self.normalised(&pressing).amax();
        let small = T::EPSILON.root() * T::literal(16.0);
        if off <= small {
            return Some(true);
        }
        let limits = FingerLimits::<T, 1>::none().with_greatest_normal(T::one()).ok()?;
        // The load of the pressing forces is borne by the others: the reach along its opposite.
        match self.reach(&[limits; N], &Wrench::zero(), &-pressing) {
            Reach::Times(times) => Some(times > small),
            Reach::Unlimited => Some(true),
            Reach::NotHeld => Some(false),
            Reach::Unknown => None,
        }
    }
}
