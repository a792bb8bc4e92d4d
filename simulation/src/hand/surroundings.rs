//! What touches the object beside the fingertips: a table, and another hand.

use nalgebra::{UnitQuaternion, Vector3};

use super::body::RigidBody;
use super::skin::{Approach, Skin, SkinForce, SkinSettings};
use crate::error::SimulationError;

/// A table at a height, on which the feet of the object stand.
#[derive(Clone, Debug)]
pub(super) struct Table {
    height: f64,
    feet: Vec<(Vector3<f64>, Skin)>,
    /// With what force it bears the object \[N\].
    pub(super) bears: f64,
}

impl Table {
    /// Just below the feet of an object that stands at the origin.
    pub(super) fn below(feet: &[Vector3<f64>]) -> Result<Self, SimulationError> {
        let settings = SkinSettings {
            stiffness: 20_000.0,
            damping: 20.0,
            static_friction: 0.4,
            kinetic_friction: 0.3,
            arm: 0.0,
            ..SkinSettings::default()
        };
        let skin =
            Skin::new(settings).map_err(|error| SimulationError::Hand { reason: error.to_string() })?;
        let lowest = feet.iter().map(|foot| foot.z).fold(f64::INFINITY, f64::min);
        let height = if lowest.is_finite() { lowest } else { 0.0 };
        Ok(Self { height, feet: feet.iter().map(|foot| (*foot, skin)).collect(), bears: 0.0 })
    }

    /// Force and torque about the centre of mass for a time step.
    pub(super) fn step(&mut self, body: &RigidBody, time_step: f64) -> (Vector3<f64>, Vector3<f64>) {
        let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
        for (foot, skin) in &mut self.feet {
            let at = body.place(foot);
            let approach = Approach {
                depth: self.height - at.z,
                normal: Vector3::z(),
                velocity: body.velocity_at(&at),
                spin: 0.0,
            };
            let SkinForce { force: on_table, .. } = skin.step(&approach, time_step);
            force -= on_table;
            torque -= (at - body.centre()).cross(&on_table);
        }
        self.bears = force.z;
        (force, torque)
    }

    pub(super) fn energy(&self) -> f64 {
        self.feet.iter().map(|(_, skin)| skin.energy()).sum()
    }
}

/// Another hand: it bears a share of the weight, and keeps the object where it was when it took hold, with springs
/// that become as stiff as it bears.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct OtherHand {
    held_at: Option<(Vector3<f64>, UnitQuaternion<f64>)>,
}

/// The springs of another hand \[N/m\], \[N·m/rad\], and their dampers \[N·s/m\], \[N·m·s/rad\].
const SPRINGS: (f64, f64) = (1000.0, 1.0);
const DAMPERS: (f64, f64) = (10.0, 0.01);

impl OtherHand {
    /// Force and torque about the centre of mass for a share of the weight.
    pub(super) fn act(
        &mut self,
        body: &RigidBody,
        weight: &Vector3<f64>,
        share: f64,
    ) -> (Vector3<f64>, Vector3<f64>) {
        if !(share > 0.0) {
            self.held_at = None;
            return (Vector3::zeros(), Vector3::zeros());
        }
        let (place, attitude) = *self.held_at.get_or_insert((body.centre(), body.attitude()));
        let moved = body.centre() - place;
        let turned = (body.attitude() * attitude.inverse()).scaled_axis();
        let velocity = body.velocity_at(&body.centre());
        let force = -weight - moved * SPRINGS.0 - velocity * DAMPERS.0;
        let torque = -turned * SPRINGS.1 - body.angular_velocity() * DAMPERS.1;
        (force * share, torque * share)
    }
}
