//! Points of the sphere by two angles.

use nalgebra::{UnitQuaternion, UnitVector3, Vector3};

/// A point of the sphere, seen from its centre.
///
/// ```
/// use fingertip_simulation::SurfacePoint;
///
/// let side = SurfacePoint::degrees(90.0, 0.0);
/// let direction = side.direction(); // the beam is along x, the azimuth counts from y
/// assert!(direction.x.abs() < 1e-15 && (direction.y - 1.0).abs() < 1e-15);
/// // A heading of 0 leads away from the top.
/// assert!((side.tangent(0.0).x + 1.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SurfacePoint {
    /// Angle from the tip of the beam axis (+X, the top of the fingertip) \[rad\].
    pub from_top: f64,
    /// Angle around the beam axis, from +Y towards +Z \[rad\].
    pub azimuth: f64,
}

impl SurfacePoint {
    /// The top of the fingertip.
    pub const TOP: Self = Self { from_top: 0.0, azimuth: 0.0 };

    /// From two angles in degrees.
    #[must_use]
    pub const fn degrees(from_top: f64, azimuth: f64) -> Self {
        Self { from_top: from_top.to_radians(), azimuth: azimuth.to_radians() }
    }

    /// The outward direction at the point.
    #[must_use]
    pub fn direction(&self) -> Vector3<f64> {
        let ((sin, cos), (sin_azimuth, cos_azimuth)) = (self.from_top.sin_cos(), self.azimuth.sin_cos());
        Vector3::new(cos, sin * cos_azimuth, sin * sin_azimuth)
    }

    /// The point where an outward direction pierces the sphere; the top for no direction.
    #[must_use]
    pub fn from_direction(direction: &Vector3<f64>) -> Self {
        Self {
            from_top: direction.y.hypot(direction.z).atan2(direction.x),
            azimuth: direction.z.atan2(direction.y),
        }
    }

    /// The direction in the tangent plane that leads away from the top along a meridian, turned by
    /// `heading` towards increasing azimuth \[rad\].
    #[must_use]
    pub fn tangent(&self, heading: f64) -> Vector3<f64> {
        let ((sin, cos), (sin_azimuth, cos_azimuth)) = (self.from_top.sin_cos(), self.azimuth.sin_cos());
        let meridian = Vector3::new(-sin, cos * cos_azimuth, cos * sin_azimuth);
        let parallel = Vector3::new(0.0, -sin_azimuth, cos_azimuth);
        meridian * heading.cos() + parallel * heading.sin()
    }
}

/// The rotation about the centre that carries one direction to another along the great circle,
/// as a vector of axis times angle; between opposite directions through the tangent of the first.
pub(super) fn great_circle(from: &SurfacePoint, to: &SurfacePoint) -> Vector3<f64> {
    let (start, end) = (from.direction(), to.direction());
    let across = start.cross(&end);
    let angle = across.norm().atan2(start.dot(&end));
    let axis = UnitVector3::try_new(across, f64::EPSILON)
        .map_or_else(|| start.cross(&from.tangent(0.0)), UnitVector3::into_inner);
    axis * angle
}

/// Turns a vector by a share of a rotation vector.
pub(super) fn turned(vector: &Vector3<f64>, rotation: &Vector3<f64>, share: f64) -> Vector3<f64> {
    UnitQuaternion::from_scaled_axis(rotation * share) * vector
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn directions_are_unit_and_tangents_across(
            from_top in 0.0_f64..3.0, azimuth in -3.0_f64..3.0, heading in -3.0_f64..3.0,
        ) {
            let point = SurfacePoint { from_top, azimuth };
            let (direction, tangent) = (point.direction(), point.tangent(heading));
            prop_assert!((direction.norm() - 1.0).abs() < 4.0 * f64::EPSILON);
            prop_assert!((tangent.norm() - 1.0).abs() < 4.0 * f64::EPSILON);
            prop_assert!(direction.dot(&tangent).abs() < 4.0 * f64::EPSILON);
            let back = SurfacePoint::from_direction(&direction).direction();
            prop_assert!((back - direction).norm() < 8.0 * f64::EPSILON);
        }

        #[test]
        fn the_great_circle_leads_there(a in 0.0_f64..3.1, b in -3.1_f64..3.1, c in 0.0_f64..3.1, d in -3.1_f64..3.1) {
            let (from, to) = (SurfacePoint { from_top: a, azimuth: b }, SurfacePoint { from_top: c, azimuth: d });
            let rotation = great_circle(&from, &to);
            prop_assert!((turned(&from.direction(), &rotation, 1.0) - to.direction()).norm() < 1e-7);
            let half = turned(&from.direction(), &rotation, 0.5);
            prop_assert!((half.dot(&from.direction()) - half.dot(&to.direction())).abs() < 1e-7);
        }
    }
}
