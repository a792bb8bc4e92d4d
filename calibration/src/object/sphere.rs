//! A round object.

use fingertip_surfaces::Sphere;
use nalgebra::Vector3;

use super::fit::{Concave, FittedObject, Model, Near, centred, linear, settle};
use super::plane::across;
use super::{ObjectError, ObjectPoint, PoseNoise};

struct Round {
    centre: Vector3<f64>,
    radius: f64,
    concave: Concave,
}

impl Model<4> for Round {
    const NAMES: [&'static str; 4] = ["radius", "centre x", "centre y", "centre z"];

    fn near(&self, point: &Vector3<f64>) -> Near<4> {
        let sign = self.concave.sign();
        let arm = point - self.centre;
        let length = arm.norm();
        let normal = arm * (sign / length);
        let tangents = across(&normal);
        let leaning =
            |t: &Vector3<f64>| [0.0, -sign * t.x / length, -sign * t.y / length, -sign * t.z / length];
        Near {
            tangents,
            distance: sign * (length - self.radius),
            distance_slope: [-sign, -normal.x, -normal.y, -normal.z],
            normal_slopes: [leaning(&tangents[0]), leaning(&tangents[1])],
            bend: [sign / self.radius; 2],
        }
    }

    fn advance(&mut self, [radius, x, y, z]: &[f64; 4]) -> f64 {
        // No farther than half of what it has, as the normals turn with the way.
        let shift = Vector3::new(*x, *y, *z);
        let length = (shift.norm() + radius.abs()) / self.radius;
        let share = if length > 0.5 { 0.5 / length } else { 1.0 };
        self.radius += radius * share;
        self.centre += shift * share;
        length
    }
}

/// The sphere that was touched, from without or (a bowl) from within
/// (`docs/theory/calibration.md#an-object-by-its-touches`). Deviations: radius, then centre x, y, z \[m\]. Two touches on
/// different sides are the least.
///
/// ```
/// use fingertip_calibration::object::{ObjectPoint, PoseNoise, fit_sphere};
/// use nalgebra::{Matrix3, Vector3};
///
/// let normals = [Vector3::x(), Vector3::y(), Vector3::new(0.6, 0.0, 0.8)];
/// let touches = normals.map(|normal| ObjectPoint {
///     point: Vector3::new(0.0, 0.1, 0.0) + normal * 0.03,
///     normal,
///     covariance: Matrix3::zeros(),
///     bend: Matrix3::zeros(),
/// });
/// let ball = fit_sphere(&touches, PoseNoise::new(1e-4, 1e-3)?)?;
/// assert!((ball.shape.radius() - 0.03).abs() < 1e-12);
/// # Ok::<(), fingertip_calibration::object::ObjectError>(())
/// ```
///
/// # Errors
/// [`ObjectError`].
pub fn fit_sphere(
    touches: &[ObjectPoint],
    noise: PoseNoise,
) -> Result<FittedObject<Sphere<f64>>, ObjectError> {
    let (touches, centroid) = centred(touches, 4)?;
    // p = c + r n, linear in both; the radius is negative within a bowl.
    let rows = touches.iter().flat_map(|touch| {
        (0..3).map(|axis| {
            let mut row = [touch.normal[axis], 0.0, 0.0, 0.0];
            row[1 + axis] = 1.0;
            (row, touch.point[axis])
        })
    });
    let [radius, x, y, z] = linear(rows, Round::NAMES)?;
    let mut round =
        Round { centre: Vector3::new(x, y, z), radius: radius.abs(), concave: Concave::of(radius) };
    let settled = settle(&touches, noise, &mut round, |round| [round.radius; 4])?;
    Ok(settled.with(Sphere::new(centroid + round.centre, round.radius)?, round.concave))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{Concave, Model as _, Round};

    /// A step is taken whole up to half of the radius, and of a longer one so much.
    #[test]
    fn no_step_is_longer_than_half_of_the_radius() {
        for (step, told, radius, x) in [
            ([0.5, 0.0, 0.0, 0.0], 0.25, 2.5, 0.0),
            ([-0.4, 0.6, 0.0, 0.0], 0.5, 1.6, 0.6),
            ([2.0, -4.0, 0.0, 0.0], 3.0, 2.0 + 1.0 / 3.0, -2.0 / 3.0),
        ] {
            let mut ball = Round { centre: Vector3::zeros(), radius: 2.0, concave: Concave::of(2.0) };
            let length = ball.advance(&step);
            assert!((length - told).abs() < 1e-12, "{length}");
            assert!((ball.radius - radius).abs() < 1e-12 && (ball.centre.x - x).abs() < 1e-12, "{step:?}");
        }
    }
}
