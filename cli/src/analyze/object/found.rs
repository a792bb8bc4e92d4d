//! What is told of an object.

use fingertip_calibration::object::{
    Concave, FittedObject, ObjectError, ObjectPoint, PoseNoise, fit_cylinder, fit_plane, fit_sphere,
};

use super::ObjectShape;
use crate::geometry::lines::{length, point, tilt};
use crate::table::count;

/// More than this times the stated noise is left: something is not as stated.
const TOO_NOISY: f64 = 2.0;

pub(super) fn counted(samples: u64, touches: usize, apart: f64) -> String {
    format!(
        "{} samples in contact: {} touches, with poses more than {} mm apart\n",
        count(samples),
        count(touches as u64),
        1e3 * apart
    )
}

/// The shape, and how well the touches lie on it.
pub(super) fn fitted(
    shape: ObjectShape,
    points: &[ObjectPoint],
    noise: PoseNoise,
) -> Result<String, ObjectError> {
    match shape {
        ObjectShape::Plane => {
            let fit = fit_plane(points, noise)?;
            let widths = fit.half_widths(0.95);
            let (place, normal) = (fit.shape.point(), fit.shape.outward());
            let tilt = tilt(widths.get(1..3)).unwrap_or_default();
            let lines = [
                "a flat side".to_owned(),
                point("point", &place, None),
                format!("normal          {:+.5} {:+.5} {:+.5}{tilt}", normal.x, normal.y, normal.z),
                length("along it", normal.dot(&place), widths.first()),
            ];
            Ok(told(&lines, &fit))
        }
        ObjectShape::Sphere => {
            let fit = fit_sphere(points, noise)?;
            let widths = fit.half_widths(0.95);
            let side = if fit.concave == Concave::Yes { "a bowl, touched from within" } else { "a ball" };
            let lines = [
                side.to_owned(),
                length("radius", fit.shape.radius(), widths.first()),
                point("centre", &fit.shape.centre(), widths.get(1..4)),
            ];
            Ok(told(&lines, &fit))
        }
        ObjectShape::Cylinder => {
            let fit = fit_cylinder(points, noise)?;
            let widths = fit.half_widths(0.95);
            let axis = fit.shape.axis();
            let side = if fit.concave == Concave::Yes { "a bore, touched from within" } else { "a rod" };
            let tilt = tilt(widths.get(3..5)).unwrap_or_default();
            let lines = [
                side.to_owned(),
                length("radius", fit.shape.radius(), widths.first()),
                point("point of axis", &fit.shape.centre(), None),
                format!("axis            {:+.5} {:+.5} {:+.5}{tilt}", axis.x, axis.y, axis.z),
            ];
            Ok(told(&lines, &fit))
        }
    }
}

fn told<S>(lines: &[String], fit: &FittedObject<S>) -> String {
    let mut text = lines.join("\n");
    text.push_str(&format!(
        "\n± is half of an interval of 95 %\nthe touches lie within {:.3} mm of it, and lean by {:.2}° (RMS): {:.2} times what \
         contacts and poses are said to be off by\n",
        1e3 * fit.distance,
        fit.angle.to_degrees(),
        fit.noise_scale
    ));
    if fit.noise_scale > TOO_NOISY {
        text.push_str("the object is of another shape, or --pose-noise is too small\n");
    }
    text
}
