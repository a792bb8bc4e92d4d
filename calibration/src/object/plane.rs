//! The flat side of an object.

use fingertip_surfaces::Plane;
use nalgebra::Vector3;

use super::fit::{Concave, FittedObject, Model, Near, centred, settle};
use super::{ObjectError, ObjectPoint, PoseNoise};

struct Flat {
    normal: Vector3<f64>,
    tangents: [Vector3<f64>; 2],
    offset: f64,
}

/// Two unit vectors across one.
pub(super) fn across(normal: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let first = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
    [first, normal.cross(&first)]
}

impl Model<3> for Flat {
    const NAMES: [&'static str; 3] = ["offset", "tilt 1", "tilt 2"];

    fn near(&self, point: &Vector3<f64>) -> Near<3> {
        let along = self.tangents.map(|tangent| tangent.dot(point));
        Near {
            tangents: self.tangents,
            distance: self.normal.dot(point) - self.offset,
            distance_slope: [-1.0, along[0], along[1]],
            normal_slopes: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            bend: [0.0; 2],
        }
    }

    fn advance(&mut self, [offset, first, second]: &[f64; 3]) -> f64 {
        self.offset += offset;
        let [e1, e2] = self.tangents;
        self.normal = (self.normal + e1 * *first + e2 * *second).normalize();
        self.tangents = across(&self.normal);
        // An offset from the centroid has no size of its own: a millimetre.
        first.abs().max(second.abs()).max(offset.abs() / 1e-3)
    }
}

/// The plane on which an object was touched (`docs/theory/calibration.md#an-object-by-its-touches`); its normal leads out of
/// the object. Deviations: offset along the normal \[m\], then the two tilts of the normal \[rad\].
///
/// # Errors
/// [`ObjectError`].
pub fn fit_plane(touches: &[ObjectPoint], noise: PoseNoise) -> Result<FittedObject<Plane<f64>>, ObjectError> {
    let (touches, centroid) = centred(touches, 3)?;
    let normal: Vector3<f64> = touches.iter().map(|touch| touch.normal).sum();
    if !(normal.norm() > 0.1 * touches.len() as f64) {
        return Err(ObjectError::Undetermined {
            what: "the normal, as those of the touches disagree".to_owned(),
        });
    }
    let normal = normal.normalize();
    let mut flat = Flat { normal, tangents: across(&normal), offset: 0.0 };
    let settled = settle(&touches, noise, &mut flat, |_| [f64::INFINITY, 1.0, 1.0])?;
    let plane = Plane::new(centroid + flat.normal * flat.offset, flat.normal)?;
    Ok(settled.with(plane, Concave::No))
}
