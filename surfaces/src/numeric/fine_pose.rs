//! A pose that is stored in a narrower type, undone in double precision.

use fingertip_wrench::{Line, Real, RigidTransform, Wrench};
use nalgebra::{Matrix3, Vector3};

use super::vectors::wide;

/// Where a posed shape is, by all digits that its pose is stored with.
///
/// A rotation `R` that is stored in single precision is orthogonal to its digits only, and at a flat angle or under a
/// large spin torque a contact tells. A posed shape is the one of the points that `y = Rᵀ(x − o)` takes to the shape,
/// whatever `R` is, with normals along `R n`. For that map lines and wrenches are told exactly here
/// (`docs/theory/contact.md#shapes-in-a-pose`).
pub struct FinePose {
    rotation: Matrix3<f64>,
    inverse: Matrix3<f64>,
    determinant: f64,
    origin: Vector3<f64>,
}

impl FinePose {
    /// Of a pose from a shape's frame to the sensor's.
    #[must_use]
    pub fn new<T: Real>(pose: &RigidTransform<T>) -> Self {
        let rotation = pose.rotation().map(Real::to_f64);
        // Steps of Newton's method for the inverse: of one that is off by ε they leave ε², and ε⁴.
        let step = |back: Matrix3<f64>| back * (Matrix3::identity() * 2.0 - rotation * back);
        let inverse = step(step(rotation.transpose()));
        Self { rotation, inverse, determinant: rotation.determinant(), origin: wide(&pose.origin()) }
    }

    /// A point \[m\] in the frame of the shape.
    #[must_use]
    pub fn point_inside(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.rotation.tr_mul(&(point - self.origin))
    }

    /// A line in the frame of the shape.
    #[must_use]
    pub fn line_inside(&self, line: &Line<f64>) -> Line<f64> {
        let direction = self.rotation.tr_mul(&line.direction);
        Line { point: self.point_inside(&line.point), direction: direction / direction.norm() }
    }

    /// The wrench in the frame of the shape that has the contact there: `Rᵀf` and `det R · R⁻¹(m − o × f)`.
    #[must_use]
    pub fn wrench_inside(&self, wrench: &Wrench<f64>) -> Wrench<f64> {
        let torque = self.inverse * wrench.torque_about(&self.origin) * self.determinant;
        Wrench::on_fingertip(self.rotation.tr_mul(&wrench.force()), torque)
    }

    /// A point in the frame of the shape, in the sensor's \[m\].
    #[must_use]
    pub fn point_outside(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.inverse.tr_mul(point) + self.origin
    }

    /// A unit normal in the frame of the shape, in the sensor's, and by what a spin torque about the one is times that
    /// about the other.
    #[must_use]
    pub fn normal_outside(&self, normal: &Vector3<f64>) -> (Vector3<f64>, f64) {
        let turned = self.rotation * normal;
        let length = turned.norm();
        (turned / length, length / self.determinant)
    }
}
