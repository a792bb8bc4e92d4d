//! What a model says of itself.

/// Which of the laws a limit claims.
///
/// ```
/// use fingertip_friction::testing::{Claims, friction_laws};
/// use fingertip_friction::{Coulomb, LoadDependentLimit};
/// use fingertip_wrench::ContactForce;
///
/// let length = |change: &ContactForce<f64>| change.normal.hypot(change.tangential_magnitude());
/// let claims = Claims { homogeneous: true, convex: true, arm: 0.0, tolerance: 1e-12 };
/// friction_laws(&Coulomb::new(0.5)?, &claims, length, 100);
/// // A patch whose arm grows with the load makes no homogeneous limit, and is found out.
/// let (limit, claims) = (LoadDependentLimit::new(0.5, 3e-3, 1.0, 1.0 / 3.0)?, Claims { arm: 3e-3, ..claims });
/// assert!(std::panic::catch_unwind(|| friction_laws(&limit, &claims, length, 100)).is_err());
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Claims<T> {
    /// Margin and least normal force scale with the force.
    pub homogeneous: bool,
    /// The forces that hold form a convex set.
    pub convex: bool,
    /// Spin torque counts, with this arm \[m\]; zero where it doesn't.
    pub arm: T,
    /// Relative tolerance of the margin and of the projection, from the type's epsilon and the
    /// method.
    pub tolerance: T,
}
