//! Where two bodies touch: skin that yields, and friction.

use fingertip_friction::{BadParameter, Bristle, BristleLaw, LuGre, Stribeck};
use nalgebra::Vector3;

/// What a touch is made of: a skin that yields along the normal, and LuGre friction (Canudas de Wit & al. 1995) of
/// force and spin together across it.
///
/// ```
/// use fingertip_simulation::hand::SkinSettings;
///
/// // Wet: it holds less, and grips the spin less.
/// let wet = SkinSettings { static_friction: 0.3, kinetic_friction: 0.2, arm: 1e-3, ..SkinSettings::default() };
/// assert!(wet.static_friction < SkinSettings::default().static_friction);
/// assert_eq!(wet.stiffness, 5000.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinSettings {
    /// Force for a depth \[N/m\]: 5000, a millimetre at 5 N.
    pub stiffness: f64,
    /// Force for a rate of depth \[N·s/m\]: 10. Both together never pull.
    pub damping: f64,
    /// Friction coefficient that holds: 0.6.
    pub static_friction: f64,
    /// Friction coefficient while it slides: 0.45.
    pub kinetic_friction: f64,
    /// The Stribeck speed, at which most of the way from one to the other is done \[m/s\]: 10 mm/s. While the bristles
    /// bend the law knows no static friction at this speed, so it is faster than what bends them in a slow pull.
    pub stribeck_speed: f64,
    /// Stiffness of the bristles for a newton of normal force \[1/m\]: 30 000, so that a contact gives by 20 µm before
    /// it slips.
    pub bristle_stiffness: f64,
    /// Their damping for a newton of normal force \[s/m\]: 10.
    pub bristle_damping: f64,
    /// The greatest spin torque over the greatest tangential force \[m\]: 3 mm. Zero for a point contact.
    pub arm: f64,
}

impl Default for SkinSettings {
    fn default() -> Self {
        Self {
            stiffness: 5000.0,
            damping: 10.0,
            static_friction: 0.6,
            kinetic_friction: 0.45,
            stribeck_speed: 10e-3,
            bristle_stiffness: 3e4,
            bristle_damping: 10.0,
            arm: 3e-3,
        }
    }
}

/// How two bodies move at the place where they touch, in the frame of the one that is felt (the fingertip).
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach {
    /// How deep they are in each other \[m\]; not positive where they do not touch.
    pub(super) depth: f64,
    /// The outward unit normal of the fingertip.
    pub(super) normal: Vector3<f64>,
    /// Velocity of the object at the place less that of the fingertip \[m/s\].
    pub(super) velocity: Vector3<f64>,
    /// Angular velocity of the object less that of the fingertip, about the normal \[rad/s\].
    pub(super) spin: f64,
}

/// What the fingertip feels of a touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SkinForce {
    /// Force on the fingertip \[N\].
    pub(super) force: Vector3<f64>,
    /// Torque on it about its outward normal \[N·m\].
    pub(super) spin: f64,
}

/// A touch with its memory.
#[derive(Clone, Copy, Debug)]
pub(super) struct Skin {
    settings: SkinSettings,
    bristle: Bristle<f64, LuGre<f64>, 3>,
    /// The first tangent, carried along so that the bristles turn with the contact and no more.
    tangent: Vector3<f64>,
    depth: f64,
    slipping: bool,
}

/// From what share of the Stribeck speed on a sliding contact counts as slipping. Below, it creeps: friction has fallen
/// by less than a quarter of what it falls by, and may still grow.
const SLIPPING: f64 = 0.5;

impl Skin {
    pub(super) fn new(settings: SkinSettings) -> Result<Self, BadParameter> {
        let good = |value: f64, parameter, least: f64| {
            let requirement = "finite and not negative";
            if value >= least && value.is_finite() {
                Ok(())
            } else {
                Err(BadParameter { parameter, requirement })
            }
        };
        good(settings.stiffness, "stiffness of the skin", f64::MIN_POSITIVE)?;
        good(settings.damping, "damping of the skin", 0.0)?;
        good(settings.arm, "torque arm of the skin", 0.0)?;
        let (kinetic, holds) = (settings.kinetic_friction, settings.static_friction);
        let curve = Stribeck::new(kinetic, holds, settings.stribeck_speed)?;
        let law = LuGre::new(settings.bristle_stiffness, settings.bristle_damping, 0.0, curve)?;
        let bristle = Bristle::new(law);
        Ok(Self { settings, bristle, tangent: Vector3::zeros(), depth: 0.0, slipping: false })
    }

    /// Moves for a time step \[s\] and tells what the fingertip feels.
    ///
    /// Along the normal `max(0, kδ + cδ̇)`; across it the mean of the bristles over the step, which is passive.
    pub(super) fn step(&mut self, approach: &Approach, time_step: f64) -> SkinForce {
        let Approach { depth, normal, velocity, spin } = *approach;
        if !(depth > 0.0) {
            self.bristle.reset();
            (self.tangent, self.depth, self.slipping) = (Vector3::zeros(), 0.0, false);
            return SkinForce { force: Vector3::zeros(), spin: 0.0 };
        }
        self.depth = depth;
        let pressing =
            (self.settings.stiffness * depth - self.settings.damping * velocity.dot(&normal)).max(0.0);
        let first = self.carried(&normal);
        let second = normal.cross(&first);
        let arm = self.settings.arm;
        let sliding = Vector3::new(velocity.dot(&first), velocity.dot(&second), spin * arm);
        self.bristle.set_load(pressing);
        let dragged = self.bristle.step(&sliding, time_step).mean;
        let speed = sliding.norm();
        let law = self.bristle.law();
        let used = self.bristle.deflection().norm() * law.stiffness() / law.steady(speed);
        let slides = speed > SLIPPING * self.settings.stribeck_speed;
        self.slipping = slides && used > 0.9 && sliding.dot(self.bristle.deflection()) > 0.0;
        SkinForce { force: first * dragged.x + second * dragged.y - normal * pressing, spin: dragged.z * arm }
    }

    /// The first tangent at a normal, from that of the step before.
    fn carried(&mut self, normal: &Vector3<f64>) -> Vector3<f64> {
        let along = self.tangent - normal * normal.dot(&self.tangent);
        let tangent = along.try_normalize(1e-6).unwrap_or_else(|| {
            let axis = if normal.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
            (axis - normal * normal.dot(&axis)).normalize()
        });
        self.tangent = tangent;
        tangent
    }

    /// Whether it slides: the bristles are bent as far as they go, and the object moves on.
    pub(super) const fn slipping(&self) -> bool {
        self.slipping
    }

    /// Stored in skin and bristles \[J\].
    pub(super) fn energy(&self) -> f64 {
        0.5 * self.settings.stiffness * self.depth * self.depth + self.bristle.energy()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slide(depth: f64, velocity: Vector3<f64>, spin: f64, steps: u32) -> (SkinForce, Skin) {
        let mut skin = Skin::new(SkinSettings::default()).unwrap();
        let normal = Vector3::new(0.6, 0.0, 0.8);
        let mut felt = SkinForce { force: Vector3::zeros(), spin: 0.0 };
        for _ in 0..steps {
            felt = skin.step(&Approach { depth, normal, velocity, spin }, 5e-5);
        }
        (felt, skin)
    }

    #[test]
    fn a_touch_presses_and_drags_as_coulomb_says_once_it_slides() {
        let (felt, skin) = slide(4e-4, Vector3::y() * 0.05, 0.0, 2000);
        let normal = Vector3::new(0.6, 0.0, 0.8);
        assert!((felt.force.dot(&normal) + 2.0).abs() < 1e-12);
        // Dragged along with the object, by the kinetic friction.
        assert!((felt.force.y - 0.45 * 2.0).abs() < 1e-6 && skin.slipping());
        assert!(felt.spin.abs() < 1e-12);
        // Spin alone: the torque is that of the arm.
        let (felt, skin) = slide(4e-4, Vector3::zeros(), 20.0, 4000);
        assert!((felt.spin - 0.45 * 2.0 * 3e-3).abs() < 1e-8 && skin.slipping());
        // A creep far below the limit does not slip.
        let (felt, skin) = slide(4e-4, Vector3::y() * 2e-4, 0.0, 200);
        assert!(!skin.slipping() && felt.force.y > 0.0 && felt.force.y < 0.3);
        assert!(skin.energy() > 0.5 * 5000.0 * 16e-8);
    }

    #[test]
    fn a_touch_never_pulls_and_forgets_when_it_opens() {
        let (felt, _) = slide(1e-5, Vector3::new(0.6, 0.0, 0.8) * 1.0, 0.0, 3);
        assert_eq!(felt.force.norm(), 0.0);
        let (_, mut skin) = slide(4e-4, Vector3::y() * 0.05, 0.0, 2000);
        let apart = Approach { depth: 0.0, normal: Vector3::x(), velocity: Vector3::y(), spin: 0.0 };
        assert_eq!(skin.step(&apart, 5e-5), SkinForce { force: Vector3::zeros(), spin: 0.0 });
        assert_eq!(skin.energy(), 0.0);
    }

    #[test]
    fn settings_that_are_none_are_refused_by_name() {
        let bad = SkinSettings { stiffness: -1.0, ..SkinSettings::default() };
        assert!(Skin::new(bad).unwrap_err().to_string().contains("stiffness of the skin"));
        let bad = SkinSettings { kinetic_friction: 0.7, ..SkinSettings::default() };
        assert!(Skin::new(bad).unwrap_err().to_string().contains("static friction"));
    }
}
