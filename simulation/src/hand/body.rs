//! A rigid body in motion.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// What a body is made of, in its own axes.
///
/// ```
/// use fingertip_simulation::hand::Inertial;
/// use nalgebra::Vector3;
///
/// // A cup of 100 g, into which 50 g are poured 4 cm below its middle.
/// let cup = Inertial::cylinder(0.03, 0.05, 0.1);
/// let full = cup.with_point_mass(0.05, Vector3::new(0.0, 0.0, -0.04));
/// assert!((full.mass - 0.15).abs() < 1e-15);
/// assert!((full.centre.z + 0.04 / 3.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass, from the origin of the body \[m\].
    pub centre: Vector3<f64>,
    /// Inertia about the centre of mass \[kg·m²\].
    pub inertia: Matrix3<f64>,
}

impl Inertial {
    /// A full cylinder about the third axis, of a radius, half its length \[m\] and a mass \[kg\]: `m(3r² + 4h²)/12`
    /// and `mr²/2`.
    #[must_use]
    pub fn cylinder(radius: f64, half_length: f64, mass: f64) -> Self {
        let across = mass * (3.0 * radius * radius + 4.0 * half_length * half_length) / 12.0;
        let along = 0.5 * mass * radius * radius;
        let inertia = Matrix3::from_diagonal(&Vector3::new(across, across, along));
        Self { mass, centre: Vector3::zeros(), inertia }
    }

    /// A full box of half extents \[m\] and a mass \[kg\]: `m(a² + b²)/3`.
    #[must_use]
    pub fn cuboid(half_extents: &Vector3<f64>, mass: f64) -> Self {
        let square = half_extents.component_mul(half_extents);
        let inertia = Matrix3::from_diagonal(&(Vector3::repeat(square.sum()) - square)) * (mass / 3.0);
        Self { mass, centre: Vector3::zeros(), inertia }
    }

    /// With a small thing more at a place of the body; the theorem of parallel axes. A mass of zero changes nothing.
    #[must_use]
    pub fn with_point_mass(&self, mass: f64, place: Vector3<f64>) -> Self {
        let whole = self.mass + mass;
        let lever = place - self.centre;
        let reduced = self.mass * mass / whole;
        let inertia =
            self.inertia + (Matrix3::identity() * lever.norm_squared() - lever * lever.transpose()) * reduced;
        Self { mass: whole, centre: self.centre + lever * (mass / whole), inertia }
    }

    /// Whether it can be: a positive mass, an inertia that is positive definite, all finite.
    pub(super) fn is_good(&self) -> bool {
        self.mass > 0.0
            && self.mass.is_finite()
            && self.centre.iter().all(|x| x.is_finite())
            && self.inertia.cholesky().is_some()
    }
}

/// A rigid body that moves freely. Its momenta are the state, so that they stay to rounding while nothing acts on it;
/// steps are of second order in the attitude (the angular velocity of the middle of the step).
#[derive(Clone, Copy, Debug)]
pub(super) struct RigidBody {
    made_of: Inertial,
    /// Of the inertia, in the body's axes.
    inverse: Matrix3<f64>,
    /// Centre of mass \[m\].
    centre: Vector3<f64>,
    attitude: UnitQuaternion<f64>,
    /// \[kg·m/s\]
    momentum: Vector3<f64>,
    /// About the centre of mass \[kg·m²/s\].
    spin: Vector3<f64>,
}

impl RigidBody {
    /// At rest with its origin at a place, its axes those of the world.
    pub(super) fn at_rest(made_of: Inertial, origin: Vector3<f64>) -> Self {
        Self {
            made_of,
            inverse: made_of.inertia.try_inverse().unwrap_or_else(Matrix3::zeros),
            centre: origin + made_of.centre,
            attitude: UnitQuaternion::identity(),
            momentum: Vector3::zeros(),
            spin: Vector3::zeros(),
        }
    }

    pub(super) const fn mass(&self) -> f64 {
        self.made_of.mass
    }

    pub(super) const fn centre(&self) -> Vector3<f64> {
        self.centre
    }

    pub(super) const fn attitude(&self) -> UnitQuaternion<f64> {
        self.attitude
    }

    pub(super) const fn momentum(&self) -> Vector3<f64> {
        self.momentum
    }

    pub(super) const fn spin(&self) -> Vector3<f64> {
        self.spin
    }

    /// Where the origin of its axes is.
    pub(super) fn origin(&self) -> Vector3<f64> {
        self.centre - self.attitude * self.made_of.centre
    }

    /// Where a place of the body is.
    pub(super) fn place(&self, of_body: &Vector3<f64>) -> Vector3<f64> {
        self.centre + self.attitude * (of_body - self.made_of.centre)
    }

    pub(super) fn angular_velocity(&self) -> Vector3<f64> {
        self.turning(&self.attitude)
    }

    fn turning(&self, attitude: &UnitQuaternion<f64>) -> Vector3<f64> {
        attitude * (self.inverse * attitude.inverse_transform_vector(&self.spin))
    }

    /// The velocity of the body at a place in the world.
    pub(super) fn velocity_at(&self, place: &Vector3<f64>) -> Vector3<f64> {
        self.momentum / self.made_of.mass + self.angular_velocity().cross(&(place - self.centre))
    }

    /// \[J\]
    pub(super) fn kinetic_energy(&self) -> f64 {
        0.5 * (self.momentum.norm_squared() / self.made_of.mass + self.spin.dot(&self.angular_velocity()))
    }

    /// Gives it a velocity of its centre and an angular velocity.
    pub(super) fn set_motion(&mut self, velocity: &Vector3<f64>, turning: &Vector3<f64>) {
        self.momentum = velocity * self.made_of.mass;
        let of_body = self.attitude.inverse_transform_vector(turning);
        self.spin = self.attitude * (self.made_of.inertia * of_body);
    }

    /// It becomes more or less: what is added moves with it, so velocities stay and momenta do not.
    pub(super) fn set_made_of(&mut self, made_of: Inertial) {
        if made_of == self.made_of {
            return;
        }
        let turning = self.angular_velocity();
        let centre = self.place(&made_of.centre);
        let velocity = self.velocity_at(&centre);
        self.made_of = made_of;
        self.inverse = made_of.inertia.try_inverse().unwrap_or_else(Matrix3::zeros);
        self.centre = centre;
        self.set_motion(&velocity, &turning);
    }

    /// A step \[s\] under a force and a torque about the centre of mass: momenta first, then places.
    pub(super) fn step(&mut self, force: &Vector3<f64>, torque: &Vector3<f64>, time_step: f64) {
        self.momentum += force * time_step;
        self.spin += torque * time_step;
        self.centre += self.momentum * (time_step / self.made_of.mass);
        let half = UnitQuaternion::from_scaled_axis(self.angular_velocity() * (0.5 * time_step));
        let middle = self.turning(&(half * self.attitude));
        self.attitude = UnitQuaternion::from_scaled_axis(middle * time_step) * self.attitude;
        self.attitude.renormalize_fast();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tumbling() -> RigidBody {
        let brick = Inertial::cuboid(&Vector3::new(0.02, 0.03, 0.05), 0.2)
            .with_point_mass(0.03, Vector3::new(0.01, 0.02, -0.03));
        let mut body = RigidBody::at_rest(brick, Vector3::new(0.1, 0.2, 0.3));
        assert!((body.origin() - Vector3::new(0.1, 0.2, 0.3)).norm() < 1e-15);
        body.set_motion(&Vector3::new(0.3, -0.1, 0.2), &Vector3::new(0.1, 9.0, 0.2));
        body
    }

    #[test]
    fn a_body_alone_keeps_its_momenta_to_rounding_and_its_energy() {
        let mut body = tumbling();
        let (momentum, spin, energy) = (body.momentum(), body.spin(), body.kinetic_energy());
        let mut drift = 0.0_f64;
        // Ten seconds about the middle axis: it tumbles over and over.
        let mut overturned = false;
        for _ in 0..200_000 {
            body.step(&Vector3::zeros(), &Vector3::zeros(), 5e-5);
            drift = drift.max((body.kinetic_energy() / energy - 1.0).abs());
            overturned |= (body.attitude() * Vector3::y()).y < -0.9;
        }
        assert_eq!((body.momentum(), body.spin()), (momentum, spin));
        assert!(drift < 1e-6, "{drift}");
        assert!(overturned);
    }

    #[test]
    fn a_body_falls_and_turns_as_newton_and_euler_say() {
        let mut body = tumbling();
        let start = (body.centre(), body.velocity_at(&body.centre()));
        let gravity = Vector3::new(0.0, 0.0, -9.81);
        for _ in 0..20_000 {
            body.step(&(gravity * body.mass()), &Vector3::zeros(), 5e-5);
        }
        let fallen = start.0 + start.1 + gravity * 0.5;
        // Momentum first: a step too far of half a step's gravity.
        assert!((body.centre() - fallen).norm() < 3e-4, "{}", body.centre() - fallen);
        // A cylinder about its axis under a torque: ω = τ t/I.
        let mut wheel = RigidBody::at_rest(Inertial::cylinder(0.03, 0.01, 0.1), Vector3::zeros());
        for _ in 0..1000 {
            wheel.step(&Vector3::zeros(), &(Vector3::z() * 1e-3), 1e-4);
        }
        let expected = 1e-3 * 0.1 / (0.5 * 0.1 * 0.03 * 0.03);
        assert!((wheel.angular_velocity().z / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_poured_in_moves_with_the_body() {
        let mut body = tumbling();
        let place = Vector3::new(0.02, -0.01, 0.03);
        let (at, origin) = (body.place(&place), body.origin());
        let (velocity, turning) = (body.velocity_at(&at), body.angular_velocity());
        body.set_made_of(
            Inertial::cuboid(&Vector3::new(0.02, 0.03, 0.05), 0.2).with_point_mass(0.1, place * 0.5),
        );
        assert!((body.velocity_at(&at) - velocity).norm() < 1e-12);
        assert!((body.angular_velocity() - turning).norm() < 1e-12);
        assert!((body.origin() - origin).norm() < 1e-15 && (body.place(&place) - at).norm() < 1e-15);
    }

    #[test]
    fn inertia_is_that_of_many_small_things() {
        // A box of 40³ points against the formula; the sum lacks the inertia of each point's own cell.
        let half = Vector3::new(0.02, 0.03, 0.05);
        let cells = 40;
        let mut sum = Matrix3::zeros();
        let place = |i: i32, half: f64| half * (f64::from(2 * i + 1) / f64::from(cells) - 1.0);
        for i in 0..cells {
            for j in 0..cells {
                for k in 0..cells {
                    let r = Vector3::new(place(i, half.x), place(j, half.y), place(k, half.z));
                    sum += Matrix3::identity() * r.norm_squared() - r * r.transpose();
                }
            }
        }
        let sum = sum * (0.2 / f64::from(cells.pow(3)));
        let formula = Inertial::cuboid(&half, 0.2).inertia;
        assert!((sum - formula).norm() < 1e-3 * formula.norm());
        // Two halves of a rod are the rod: what is added has its parallel axes.
        let pair = Inertial { mass: 1.0, centre: Vector3::x(), inertia: Matrix3::identity() }
            .with_point_mass(1.0, -Vector3::x());
        assert!((pair.inertia - Matrix3::from_diagonal(&Vector3::new(1.0, 3.0, 3.0))).norm() < 1e-15);
        // Of two masses each about the centre of both: 2 kg at 1.2 m and 3 kg at 0.8 m.
        let lighter = Inertial { mass: 2.0, centre: Vector3::x(), inertia: Matrix3::identity() };
        let whole = lighter.with_point_mass(3.0, -Vector3::x());
        let across = 1.0 + 2.0 * 1.2 * 1.2 + 3.0 * 0.8 * 0.8;
        assert!((whole.inertia - Matrix3::from_diagonal(&Vector3::new(1.0, across, across))).norm() < 1e-14);
        assert!((whole.centre + Vector3::x() * 0.2).norm() < 1e-15 && whole.mass == 5.0);
        assert_eq!(lighter.with_point_mass(0.0, Vector3::z()), lighter);
        assert!(pair.centre.norm() < 1e-15 && pair.is_good());
        assert!(!Inertial { mass: -1.0, ..pair }.is_good());
    }
}
