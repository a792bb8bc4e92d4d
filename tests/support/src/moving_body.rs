//! A body of heavy points that a hand swings about: what loads the sensor under it, and what rides along reads.

use nalgebra::{Matrix3, Rotation3, Vector3, Vector6};

/// Heavy points on a sensor that moves as [`place`](Self::place) and [`turn`](Self::turn) say. Nothing here knows of
/// mass, centre or inertia: forces are those that each point needs to go its way through the world.
pub struct MovingBody {
    /// Masses \[kg\] and places in the sensor frame \[m\].
    pub points: Vec<(f64, Vector3<f64>)>,
    /// Where the accelerometer sits, in the sensor frame \[m\].
    pub unit: Vector3<f64>,
    /// The sensor's origin in the world \[m\] over time \[s\].
    pub place: fn(f64) -> Vector3<f64>,
    /// Rotation vector of the sensor's axes in the world \[rad\] over time \[s\].
    pub turn: fn(f64) -> Vector3<f64>,
}

/// What there is at one time, along the axes of the sensor.
pub struct Moved {
    /// Force \[N\] and torque about the sensor's origin \[N·m\] of the body on the sensor.
    pub wrench: Vector6<f64>,
    /// What the accelerometer reads \[m/s²\].
    pub acceleration: Vector3<f64>,
    /// What a gyroscope reads \[rad/s\].
    pub angular_velocity: Vector3<f64>,
}

/// Downwards \[m/s²\].
const GRAVITY: Vector3<f64> = Vector3::new(0.0, 0.0, -9.806_65);
/// Step of differences \[s\].
const STEP: f64 = 1e-3;

fn swung_place(t: f64) -> Vector3<f64> {
    Vector3::new((4.1 * t).sin(), (5.3 * t + 0.5).sin(), (6.7 * t + 1.0).sin()) * 0.08
}

fn swung_turn(t: f64) -> Vector3<f64> {
    Vector3::new(
        1.1 * (3.7 * t).sin() + 0.4 * (11.0 * t).sin(),
        0.9 * (2.9 * t + 0.7).sin() + 0.4 * (13.0 * t).cos(),
        1.3 * (1.9 * t).cos() + 0.5 * (9.0 * t + 0.2).sin(),
    )
}

/// Time that stands still for a second, and within another comes to go as fast as others, without a jump of its third
/// derivative.
fn after_a_rest(t: f64) -> f64 {
    let s = t - 1.0;
    if s <= 0.0 {
        0.0
    } else if s < 1.0 {
        s.powi(5) * (7.0 - 14.0 * s + 10.0 * s * s - 2.5 * s * s * s)
    } else {
        s - 0.5
    }
}

impl MovingBody {
    /// A body of 0.7 kg or so, lopsided, swung by hand at one to three turns a second through all directions.
    #[must_use]
    pub fn swung() -> Self {
        let points = vec![
            (0.3, Vector3::new(0.02, 0.01, 0.06)),
            (0.15, Vector3::new(-0.05, 0.02, 0.09)),
            (0.1, Vector3::new(0.03, -0.06, 0.02)),
            (0.12, Vector3::new(0.00, 0.05, 0.12)),
        ];
        Self { points, unit: Vector3::new(-0.01, 0.02, -0.015), place: swung_place, turn: swung_turn }
    }

    /// The same, which rests for a second and then sets out within another.
    #[must_use]
    pub fn swung_after_a_rest() -> Self {
        Self {
            place: |t| swung_place(after_a_rest(t)),
            turn: |t| swung_turn(after_a_rest(t)),
            ..Self::swung()
        }
    }

    /// Mass \[kg\], centre \[m\], and inertia about the centre \[kg·m²\], by adding the points up.
    #[must_use]
    pub fn mass_properties(&self) -> (f64, Vector3<f64>, Matrix3<f64>) {
        let mass: f64 = self.points.iter().map(|(mass, _)| mass).sum();
        let centre = self.points.iter().map(|(mass, at)| at * *mass).sum::<Vector3<f64>>() / mass;
        let inertia = self.points.iter().fold(Matrix3::zeros(), |sum, (mass, at)| {
            let arm = at - centre;
            sum + (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * *mass
        });
        (mass, centre, (inertia + inertia.transpose()) * 0.5)
    }

    fn axes(&self, time: f64) -> Matrix3<f64> {
        Rotation3::from_scaled_axis((self.turn)(time)).into_inner()
    }

    /// Acceleration of a point of the sensor frame in the world, by differences of fourth order of where it is.
    fn acceleration(&self, point: &Vector3<f64>, time: f64) -> Vector3<f64> {
        let at = |steps: f64| {
            let time = time + steps * STEP;
            (self.place)(time) + self.axes(time) * point
        };
        let near = at(1.0) + at(-1.0);
        let far = at(2.0) + at(-2.0);
        (near * 16.0 - far - at(0.0) * 30.0) / (12.0 * STEP * STEP)
    }

    /// All that is read at a time \[s\], to about eight digits.
    #[must_use]
    pub fn at(&self, time: f64) -> Moved {
        let sensor_from_world = self.axes(time).transpose();
        let mut wrench = Vector6::zeros();
        for (mass, at) in &self.points {
            let force = sensor_from_world * (GRAVITY - self.acceleration(at, time)) * *mass;
            let torque = at.cross(&force);
            wrench += Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z);
        }
        let acceleration = sensor_from_world * (self.acceleration(&self.unit, time) - GRAVITY);
        let axes = |steps: f64| self.axes(time + steps * STEP);
        let rate = ((axes(1.0) - axes(-1.0)) * 8.0 - (axes(2.0) - axes(-2.0))) / (12.0 * STEP);
        let spin = sensor_from_world * rate;
        let angular_velocity = Vector3::new(
            0.5 * (spin[(2, 1)] - spin[(1, 2)]),
            0.5 * (spin[(0, 2)] - spin[(2, 0)]),
            0.5 * (spin[(1, 0)] - spin[(0, 1)]),
        );
        Moved { wrench, acceleration, angular_velocity }
    }
}
