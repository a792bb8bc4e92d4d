//! The circular cylinder, open at its ends.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix3, Vector3};

use super::axis::Axis;
use crate::numeric::vectors::{hypotenuse, is_finite, length, wide};
use crate::shortcuts::{LineInDouble, entry_near};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Entry, Extent, ForceLine, ForceParts, Level,
    Shortcuts, SmoothSurface, Topology,
};

/// The lateral surface of a circular cylinder, unbounded or with an active part of finite length.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Cylinder};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // Around z; what is more than 20 mm from its middle holds the sensor and may not touch.
/// let tip = Cylinder::new(Vector3::zeros(), Vector3::z(), 0.008)?.with_half_length(0.02)?;
/// for (height, active) in [(0.019, true), (0.021, false)] {
///     let line = Line { point: Vector3::new(-0.05, 0.0, height), direction: Vector3::x() };
///     tip.crossings(&line, |crossing| {
///         assert_eq!(f64::abs(crossing.point.x), 0.008);
///         assert_eq!(crossing.active, active);
///     });
/// }
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<T: Real> {
    centre: Vector3<T>,
    axis: Vector3<T>,
    radius: T,
    curvature: T,
    half_length: Option<T>,
    /// How far from the centre, along the axis, a place is active and surely in the range of the type \[m\].
    reach: T,
}

impl<T: Real> Cylinder<T> {
    /// Unbounded, around the axis through `centre` along `axis` (of any length), with a radius
    /// \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless the centre is finite, the axis has a direction and the radius is a
    /// positive finite length.
    pub fn new(centre: Vector3<T>, axis: Vector3<T>, radius: T) -> Result<Self, BadShape> {
        let radius = BadShape::check_length("cylinder", "radius", radius)?;
        let centre = BadShape::check_point("cylinder", "centre", centre)?;
        Ok(Self {
            centre,
            axis: BadShape::check_direction("cylinder", "axis", axis)?,
            radius,
            curvature: T::one() / radius,
            half_length: None,
            reach: reach(&centre, radius),
        })
    }

    /// Only the part within `half_length` \[m\] of the centre, along the axis, is active.
    ///
    /// # Errors
    /// [`BadShape`] unless it is a positive finite length.
    pub fn with_half_length(self, half_length: T) -> Result<Self, BadShape> {
        let half_length = BadShape::check_length("cylinder", "half length", half_length)?;
        let reach = reach(&self.centre, self.radius).min(half_length);
        Ok(Self { half_length: Some(half_length), reach, ..self })
    }

    /// A point of the axis, the middle of the active part \[m\].
    #[inline]
    #[must_use]
    pub const fn centre(&self) -> Vector3<T> {
        self.centre
    }

    /// Unit vector along the axis.
    #[inline]
    #[must_use]
    pub const fn axis(&self) -> Vector3<T> {
        self.axis
    }

    /// Radius \[m\].
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> T {
        self.radius
    }

    /// Half the length of the active part \[m\]; `None` if unbounded.
    #[inline]
    #[must_use]
    pub const fn half_length(&self) -> Option<T> {
        self.half_length
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<Cylinder<f64>> {
        let double = Cylinder::new(wide(&self.centre), wide(&self.axis), self.radius.to_f64()).ok()?;
        self.half_length.map_or(Some(double), |half| double.with_half_length(half.to_f64()).ok())
    }

    #[inline]
    fn around(&self) -> Axis<T> {
        Axis::new(self.centre, self.axis)
    }

    #[inline]
    fn is_active(&self, height: T) -> bool {
        self.half_length.is_none_or(|half| height.abs() <= half)
    }

    /// The point of the line closest to the axis: its position along the line \[m\], its offset
    /// from the axis in radii, and the part of the direction across the axis with its square.
    /// `None` for a line parallel to the axis.
    #[inline]
    fn foot(&self, line: &Line<T>) -> Option<(T, Vector3<T>, Vector3<T>, T)> {
        let from_centre = line.point - self.centre;
        let offset = from_centre - self.axis * from_centre.dot(&self.axis);
        let across = line.direction - self.axis * line.direction.dot(&self.axis);
        let squared = across.norm_squared();
        // A direction is a unit vector up to rounding: what is left of a parallel one is noise.
        if squared <= T::EPSILON * T::EPSILON * T::literal(16.0) {
            return None;
        }
        // Of the offset only what is square to the direction: then normals are unit vectors, however far off the
        // line's own point is, and with it the rounding of the offset.
        let aside = self.axis.cross(&across);
        let foot = aside * (offset.dot(&aside) / squared * self.curvature);
        Some((-offset.dot(&across) / squared, foot, across, squared))
    }

    #[inline]
    fn crossing(&self, line: &Line<T>, along: T, normal: Vector3<T>) -> Crossing<T> {
        let height = (line.point - self.centre).dot(&self.axis) + along * line.direction.dot(&self.axis);
        Crossing {
            along,
            point: self.centre + self.axis * height + normal * self.radius,
            normal,
            active: self.is_active(height),
        }
    }
}

/// How far along the axis a place is surely in the range of the type \[m\]: none of its components, nor their sum, is
/// then beyond. Negative for a shape that is itself at the end of the range.
fn reach<T: Real>(centre: &Vector3<T>, radius: T) -> T {
    T::GREATEST * T::literal(0.125) - centre.amax() - radius
}

impl<T: Real> ActiveSurface<T> for Cylinder<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let Some((along, foot, across, squared)) = self.foot(line) else { return };
        let remainder = T::one() - foot.norm_squared();
        if remainder >= T::zero() {
            let half_chord = (remainder / squared).root();
            for offset in [-half_chord, half_chord] {
                visit(self.crossing(line, along + offset * self.radius, foot + across * offset));
            }
        }
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (along, foot) = self.foot(line).map_or_else(
            || {
                // Parallel to the axis: of all its points, the one nearest to the middle.
                let from_centre = line.point - self.centre;
                let (_, across) = self.around().split(&from_centre);
                (-from_centre.dot(&line.direction), across * self.curvature)
            },
            |(along, foot, ..)| (along, foot),
        );
        let normal = self.around().outward(&foot);
        let crossing = self.crossing(line, along, normal);
        let gap = ((length(&foot) - T::one()).abs() * self.radius).min(T::GREATEST);
        let point =
            if is_finite(&crossing.point) { crossing.point } else { self.centre + normal * self.radius };
        Some(ClosestApproach { gap, point, normal, active: crossing.active })
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.around().outward(&self.around().split_point(point).1)
    }

    /// Between the ends, and closer to the axis than the radius.
    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        let (height, across) = self.around().split_point(point);
        self.is_active(height) && (across * self.curvature).norm_squared() < T::one()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Cylinder<T> {
    /// Before anything is normalised. With the parts of the force along and across the axis `f_a`, `f_⊥`, and the
    /// torque about the centre without its part along the force, `m`, of which `q = m_a/R` turns about the axis:
    ///
    /// ```text
    /// n = (q f_⊥ × a − s f_⊥)/|f_⊥|²,   s = −f·n = √(|f_⊥|² − q²),   z = (m·(a × f) − R f_a s)/|f_⊥|²
    /// ```
    ///
    /// What is tangential is `√(f_a² + q²)`, to the last digits even where that is small. `None` if the force is
    /// parallel to the axis, and beyond what is active or the range of the type.
    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let (force, torque) = (push.force(), push.torque_about(&self.centre));
        let along = force.dot(&self.axis);
        let across = force - self.axis * along;
        let aside = self.axis.cross(&across);
        let inverse_force = T::one() / push.squared();
        let pitch = force.dot(&torque) * inverse_force;
        let turning = (torque.dot(&self.axis) - pitch * along) * self.curvature;
        let squared = across.norm_squared();
        let pressing_squared = squared - turning * turning;
        // What is left across the axis of a force that is parallel to it is noise.
        let least_squared = push.squared() * (T::EPSILON * T::EPSILON * T::literal(16.0));
        if !(pressing_squared >= T::zero() && squared > least_squared) {
            return None;
        }
        let (pressing, inverse) = (pressing_squared.root(), T::one() / squared);
        let normal = (aside * -turning - across * pressing) * inverse;
        let height = (torque.dot(&aside) - self.radius * along * pressing) * inverse;
        (height.abs() <= self.reach).then_some(Entry {
            point: self.centre + normal * self.radius + self.axis * height,
            normal,
            incidence_squared: pressing_squared * inverse_force,
            parts: Some(ForceParts {
                normal: pressing,
                tangential: (along * along + turning * turning).root(),
            }),
            active: true,
        })
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        self.around().outside_by(point, self.radius)
    }

    fn posed_entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double()?, line, near)
    }
}

impl<T: Real> SmoothSurface<T> for Cylinder<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let axis = self.axis();
        let from_centre = point - self.centre();
        let across = from_centre - axis * from_centre.dot(&axis);
        let distance = length(&across);
        let normal = self.normal(point);
        let flat = Matrix3::identity() - normal * normal.transpose() - axis * axis.transpose();
        Level { value: distance - self.radius(), gradient: normal, hessian: flat / distance }
    }

    fn extent(&self) -> Extent<T> {
        Extent {
            centre: self.centre(),
            radius: self.half_length().map_or(self.radius(), |half| hypotenuse(half, self.radius())),
        }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

stored! {
    Cylinder<T>, [T: Real],
    |cylinder| {
        #[serde(default = "Vector3::zeros")] centre_m: Vector3<T> = cylinder.centre,
        #[serde(default = "Vector3::z")] axis: Vector3<T> = cylinder.axis,
        radius_m: T = cylinder.radius,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        half_length_m: Option<T> = cylinder.half_length,
    },
    Cylinder::new(centre_m, axis, radius_m).and_then(|cylinder| {
        half_length_m.map_or(Ok(cylinder), |half| cylinder.with_half_length(half))
    })
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::Line;
    use nalgebra::Vector3;

    use super::Cylinder;
    use crate::{ActiveSurface, ForceLine, Shortcuts};

    fn told_at(cylinder: &Cylinder<f64>, height: f64) -> bool {
        let line = Line { point: Vector3::new(0.02, 0.0, height), direction: -Vector3::x() };
        cylinder.shortcuts().sole_entry(&ForceLine::along(&line)).is_some()
    }

    #[test]
    fn the_short_way_reaches_as_far_as_the_last_half_length() {
        let unbounded = Cylinder::new(Vector3::zeros(), Vector3::z(), 0.01).unwrap();
        assert!(told_at(&unbounded, 0.03) && told_at(&unbounded, -1e6));
        let short = unbounded.with_half_length(0.02).unwrap();
        assert!(told_at(&short, 0.019) && told_at(&short, -0.019));
        assert!(!told_at(&short, 0.021) && !told_at(&short, -0.021));
        let longer = short.with_half_length(0.04).unwrap();
        assert!(told_at(&longer, 0.03) && !told_at(&longer, 0.041));
    }

    #[test]
    fn the_short_way_tells_no_place_beyond_the_range() {
        let unbounded = Cylinder::new(Vector3::new(1e300, 0.0, 0.0), Vector3::z(), 1e300).unwrap();
        assert!(!told_at(&unbounded, 1e308));
        assert!(told_at(&unbounded, 1e290));
        // So large that no height is sure to be in range.
        let huge = Cylinder::new(Vector3::repeat(1e308), Vector3::z(), 1e307).unwrap();
        assert!(!told_at(&huge, 0.0));
    }
}
