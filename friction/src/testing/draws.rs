//! Forces to try a model with.

use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;

/// A fixed pseudo-random sequence (PCG-XSH-RR 32, O'Neill 2014).
///
/// ```
/// use fingertip_friction::testing::Draws;
///
/// // The same seed gives the same forces.
/// let (mut draws, mut again) = (Draws::new(7), Draws::new(7));
/// for _ in 0..100 {
///     let force = draws.force::<f64>(0.01);
///     assert_eq!(force, again.force(0.01));
///     assert!(force.normal.abs() <= 20.0 && force.spin.abs() <= 0.1);
/// }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Draws {
    state: u64,
}

impl Draws {
    /// From a seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self { state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1) }
    }

    /// Evenly in [0, 1).
    pub fn share(&mut self) -> f64 {
        let old = self.state;
        self.state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mixed = (((old >> 18) ^ old) >> 27) as u32;
        f64::from(mixed.rotate_right((old >> 59) as u32)) / 4_294_967_296.0
    }

    /// Evenly in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.share() - 1.0
    }

    /// From the normal distribution of deviation 1 (Box & Muller 1958).
    pub fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.share()));
        radius * libm::cos(core::f64::consts::TAU * self.share())
    }

    /// A contact force in the plane across the third axis: mostly pressing, now and then pulling
    /// or without tangential load, with components up to about 10 N and spin up to 10 N times
    /// `arm`.
    pub fn force<T: Real>(&mut self, arm: T) -> ContactForce<T> {
        let size = if self.share() < 0.1 { 0.0 } else { 10.0 * self.share() };
        let angle = core::f64::consts::TAU * self.share();
        let normal = if self.share() < 0.1 { -10.0 * self.share() } else { 10.0 * self.share() };
        let spin = if self.share() < 0.2 { 0.0 } else { 10.0 * self.signed() };
        ContactForce {
            normal: T::literal(normal),
            tangential: Vector3::new(
                T::literal(size * libm::cos(angle)),
                T::literal(size * libm::sin(angle)),
                T::zero(),
            )
            .into(),
            spin: T::literal(spin) * arm,
        }
    }
}
