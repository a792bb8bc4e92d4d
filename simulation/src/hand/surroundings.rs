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
        let pulled_back = turned * SPRINGS.1;
        let torque = -pulled_back - body.angular_velocity() * DAMPERS.1;
        (force * share, torque * share)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, UnitQuaternion, Vector3};

    use super::super::body::{Inertial, RigidBody};
    use super::{OtherHand, Table};

    /// A body that turns about any axis alike, moved and turned by so much and now in motion.
    fn body(
        moved: Vector3<f64>,
        turned: Vector3<f64>,
        velocity: Vector3<f64>,
        turning: Vector3<f64>,
    ) -> RigidBody {
        let ball = Inertial { mass: 0.2, centre: Vector3::zeros(), inertia: Matrix3::identity() * 1e-4 };
        let mut body = RigidBody::at_rest(ball, Vector3::new(0.1, 0.2, 0.3));
        body.set_motion(&moved, &turned);
        body.step(&Vector3::zeros(), &Vector3::zeros(), 1.0);
        assert!((body.attitude() * UnitQuaternion::from_scaled_axis(turned).inverse()).angle() < 1e-9);
        body.set_motion(&velocity, &turning);
        body
    }

    /// The foot that is pressed into the table is pushed up again, which turns the object back.
    #[test]
    fn a_table_rights_what_stands_crooked() {
        let none = Vector3::zeros();
        let feet = [Vector3::new(0.03, 0.0, -0.02), Vector3::new(-0.03, 0.0, -0.02)];
        let start = Vector3::new(0.1, 0.2, 0.3);
        for lean in [1e-3, -1e-3] {
            let mut table = Table::below(&feet).unwrap();
            let crooked = body(-start, Vector3::y() * lean, none, none);
            let (force, torque) = table.step(&crooked, 1e-3);
            assert!(force.z > 0.1 && table.bears == force.z, "{force}");
            let expected = -force.z * 0.03_f64.copysign(lean);
            assert!((torque.y / expected - 1.0).abs() < 1e-2, "{torque} {expected}");
        }
    }

    #[test]
    fn another_hand_keeps_the_object_where_it_took_hold() {
        let none = Vector3::zeros();
        let weight = Vector3::new(0.0, 0.0, -1.962);
        let mut other = OtherHand::default();
        // It does nothing, and remembers nothing, before it is asked to.
        assert_eq!(other.act(&body(none, none, none, none), &weight, 0.0), (none, none));
        let (there, turned) = (Vector3::new(0.01, -0.02, 0.03), Vector3::new(0.1, 0.2, -0.3));
        let (force, torque) = other.act(&body(there, turned, none, none), &weight, 0.25);
        assert!((force + weight * 0.25).norm() < 1e-9 && torque.norm() < 1e-9, "{force} {torque}");
        // Springs of 1000 N/m and 1 N·m/rad, as stiff as the share that it bears.
        let on = Vector3::new(0.001, 0.002, -0.001);
        let (force, torque) = other.act(&body(there + on, turned * 1.5, none, none), &weight, 0.5);
        assert!((force - (-weight - on * 1000.0) * 0.5).norm() < 1e-9, "{force}");
        assert!((torque + turned * 0.5 * 0.5).norm() < 1e-9, "{torque}");
        // Dampers of 10 N·s/m and 0.01 N·m·s/rad.
        let (velocity, turning) = (Vector3::new(0.1, 0.0, -0.2), Vector3::new(1.0, 2.0, 3.0));
        let (force, torque) = other.act(&body(there, turned, velocity, turning), &weight, 1.0);
        assert!((force + weight + velocity * 10.0).norm() < 1e-9, "{force}");
        assert!((torque + turning * 0.01).norm() < 1e-9, "{torque}");
        // Once it has let go it takes hold where the object is then.
        assert_eq!(other.act(&body(there, none, none, none), &weight, 0.0), (none, none));
        let (force, torque) = other.act(&body(on, none, none, none), &weight, 1.0);
        assert!((force + weight).norm() < 1e-9 && torque.norm() < 1e-9, "{force} {torque}");
    }
}
