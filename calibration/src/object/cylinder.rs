//! A rod, or a bore.

use fingertip_surfaces::Cylinder;
use nalgebra::{DMatrix, Vector3};

use super::fit::{Concave, FittedObject, Model, Near, centred, linear, settle};
use super::plane::across;
use super::{ObjectError, ObjectPoint, PoseNoise};
use crate::linear::Singular;

/// The axis shows if the normals spread in their weaker direction by at least this share of their stronger one.
const LEAST_SPREAD: f64 = 0.05;

struct Rod {
    axis: Vector3<f64>,
    across: [Vector3<f64>; 2],
    /// The point of the axis nearest to the centroid, across the axis.
    offset: Vector3<f64>,
    radius: f64,
    concave: Concave,
}

impl Model<5> for Rod {
    const NAMES: [&'static str; 5] =
        ["radius", "axis offset 1", "axis offset 2", "axis tilt 1", "axis tilt 2"];

    fn near(&self, point: &Vector3<f64>) -> Near<5> {
        let sign = self.concave.sign();
        let arm = point - self.offset;
        let height = self.axis.dot(&arm);
        let radial = arm - self.axis * height;
        let length = radial.norm();
        let normal = radial * (sign / length);
        let around = self.axis.cross(&normal);
        let [e1, e2] = &self.across;
        let (n1, n2) = (normal.dot(e1), normal.dot(e2));
        let turned = [e1, e2].map(|e| -sign * around.dot(e) / length);
        Near {
            tangents: [around, self.axis],
            distance: sign * (length - self.radius),
            distance_slope: [-sign, -n1, -n2, -height * n1, -height * n2],
            normal_slopes: [
                [0.0, turned[0], turned[1], height * turned[0], height * turned[1]],
                [0.0, 0.0, 0.0, -n1, -n2],
            ],
            bend: [sign / self.radius, 0.0],
        }
    }

    fn advance(&mut self, [radius, first, second, tilt1, tilt2]: &[f64; 5]) -> f64 {
        let shift = first.abs() + second.abs() + radius.abs();
        let length = (shift / self.radius).max(tilt1.abs()).max(tilt2.abs());
        let share = if length > 0.5 { 0.5 / length } else { 1.0 };
        let [e1, e2] = self.across;
        self.radius += radius * share;
        let offset = self.offset + (e1 * *first + e2 * *second) * share;
        self.axis = (self.axis + (e1 * *tilt1 + e2 * *tilt2) * share).normalize();
        self.across = across(&self.axis);
        self.offset = offset - self.axis * self.axis.dot(&offset);
        length
    }
}

/// The side of a cylinder that was touched, from without or (a bore) from within
/// (`docs/theory/calibration.md#an-object-by-its-touches`). Deviations: radius, the two of the offset of the axis \[m\], and its
/// two tilts \[rad\]. The position along the axis does not show.
///
/// # Errors
/// [`ObjectError`]; the axis does not show where all normals are parallel, or lie in no plane.
pub fn fit_cylinder(
    touches: &[ObjectPoint],
    noise: PoseNoise,
) -> Result<FittedObject<Cylinder<f64>>, ObjectError> {
    let (touches, centroid) = centred(touches, 5)?;
    let spread =
        DMatrix::from_fn(touches.len().max(3), 3, |i, j| touches.get(i).map_or(0.0, |t| t.normal[j]));
    let singular = Singular::new(&spread).filter(|singular| singular.values.len() == 3);
    let singular = singular.filter(|singular| singular.values[1] > LEAST_SPREAD * singular.values[0]);
    let Some(singular) = singular else {
        return Err(ObjectError::Undetermined { what: "the direction of the axis".to_owned() });
    };
    let axis = Vector3::from_fn(|i, _| singular.right[(i, 2)]).normalize();
    let [e1, e2] = across(&axis);
    // Across the axis p = q + r n, linear in both.
    let rows = touches.iter().flat_map(|touch| {
        [(e1, [1.0, 0.0]), (e2, [0.0, 1.0])]
            .map(|(e, [x, y])| ([touch.normal.dot(&e), x, y], touch.point.dot(&e)))
    });
    let [radius, x, y] = linear(rows, ["radius", "axis offset 1", "axis offset 2"])?;
    let mut rod = Rod {
        axis,
        across: [e1, e2],
        offset: e1 * x + e2 * y,
        radius: radius.abs(),
        concave: Concave::of(radius),
    };
    let settled = settle(&touches, noise, &mut rod, |rod| [rod.radius, rod.radius, rod.radius, 1.0, 1.0])?;
    Ok(settled.with(Cylinder::new(centroid + rod.offset, rod.axis, rod.radius)?, rod.concave))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{Concave, Model as _, Rod, across};

    /// A step is taken whole up to half of the radius and half a radian, and of a longer one so much.
    #[test]
    fn no_step_is_longer_than_half_of_the_radius_or_half_a_radian() {
        let axis = Vector3::z();
        for (step, told, share) in [
            ([0.5, 0.0, 0.0, 0.0, 0.1], 0.25, 1.0),
            ([0.2, 0.6, 0.0, 0.4, 0.0], 0.4, 1.0),
            ([-1.0, 2.0, -1.0, 0.0, 0.5], 2.0, 0.25),
            ([0.2, 0.0, 0.0, 0.5, -2.0], 2.0, 0.25),
        ] {
            let [e1, e2] = across(&axis);
            let mut rod = Rod {
                axis,
                across: [e1, e2],
                offset: Vector3::zeros(),
                radius: 2.0,
                concave: Concave::of(2.0),
            };
            let length = rod.advance(&step);
            assert!((length - told).abs() < 1e-12, "{length}");
            let [radius, first, second, tilt1, tilt2] = step.map(|x| x * share);
            assert!((rod.radius - 2.0 - radius).abs() < 1e-12, "{step:?}");
            let leaning = (axis + e1 * tilt1 + e2 * tilt2).normalize();
            assert!((rod.axis - leaning).norm() < 1e-12, "{step:?}");
            let offset = e1 * first + e2 * second;
            assert!((rod.offset - offset + leaning * leaning.dot(&offset)).norm() < 1e-12, "{step:?}");
        }
    }
}
