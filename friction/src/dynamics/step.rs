//! What goes into a step of friction in motion, and what comes out.

use fingertip_wrench::Real;
use nalgebra::SVector;

/// Friction over one step of a prescribed motion \[N\], along the motion that it opposes.
///
/// ```
/// use fingertip_friction::{Bristle, Dahl, StepForce};
/// use nalgebra::Vector1;
///
/// let mut friction = Bristle::<f64, _, 1>::new(Dahl::new(1e5, 0.5)?);
/// friction.set_load(2.0);
/// let StepForce { mean, end } = friction.step(&Vector1::new(1e-3), 1e-4);
/// assert!(mean[0] > 0.0 && mean[0] < end[0]); // it grows over the step
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepForce<T: Real, const D: usize> {
    /// The mean over the step, its damping limited to what keeps it passive.
    pub mean: SVector<T, D>,
    /// At the end of the step, `σ₀z + σ₁ż + σ₂v` of the law.
    pub end: SVector<T, D>,
}

impl<T: Real, const D: usize> StepForce<T, D> {
    pub(super) const fn constant(force: SVector<T, D>) -> Self {
        Self { mean: force, end: force }
    }
}

/// What acts on a body that friction holds, besides friction.
///
/// ```
/// use fingertip_friction::{Bristle, Dahl, Drive};
/// use nalgebra::Vector1;
///
/// let mut friction = Bristle::<f64, _, 1>::new(Dahl::new(1e5, 0.5)?);
/// friction.set_load(4.0);
/// // A cup of 100 g that hangs on 2 N of friction stays.
/// let drive = Drive { mass: Vector1::new(0.1), force: Vector1::new(0.981), stiffness: 0.0 };
/// let mut velocity = Vector1::zeros();
/// for _ in 0..10_000 {
///     velocity = friction.step_body(&velocity, &drive, 1e-4).velocity;
/// }
/// assert!(velocity[0].abs() < 1e-3, "{velocity}");
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive<T: Real, const D: usize> {
    /// Mass \[kg\] in each direction (for spin: inertia over the arm squared).
    pub mass: SVector<T, D>,
    /// Force \[N\] at the end of the step, were the body to stay where it is.
    pub force: SVector<T, D>,
    /// Stiffness of the spring that this force comes from \[N/m\], so that it is taken implicitly;
    /// zero for a force that does not depend on the position.
    pub stiffness: T,
}

/// The end of a step of a body held by friction.
///
/// ```
/// use fingertip_friction::{Bristle, Coupled, Dahl, Drive};
/// use nalgebra::Vector1;
///
/// let mut friction = Bristle::<f64, _, 1>::new(Dahl::new(1e5, 0.5)?);
/// friction.set_load(1.0);
/// // Ten newtons on 100 g, half a newton of friction: it goes.
/// let drive = Drive { mass: Vector1::new(0.1), force: Vector1::new(10.0), stiffness: 0.0 };
/// let mut velocity = Vector1::zeros();
/// for _ in 0..100 {
///     let Coupled { velocity: next, friction } = friction.step_body(&velocity, &drive, 1e-4);
///     assert!(friction[0] > 0.0); // it opposes the motion
///     velocity = next;
/// }
/// assert!(velocity[0] > 0.09);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupled<T: Real, const D: usize> {
    /// Velocity at the end of the step.
    pub velocity: SVector<T, D>,
    /// Friction force, along the motion that it opposes.
    pub friction: SVector<T, D>,
}
