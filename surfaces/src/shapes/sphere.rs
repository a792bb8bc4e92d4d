//! The sphere.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::numeric::twofold::{difference, outside_ball};
use crate::numeric::vectors::{larger, largest, length, smaller, unit_or, wide};
use crate::shortcuts::{LineInDouble, entry_near};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, Entry, Extent, ForceLine, ForceParts,
    Level, Shortcuts, SignedDistance, SmoothSurface, Topology,
};

/// A sphere, its inside being the fingertip.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Sphere};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // A ball of 13 mm, 30 mm over the sensor.
/// let tip = Sphere::new(Vector3::new(0.0, 0.0, 0.03), 0.013)?;
/// // 5 mm beside the axis, where the surface is 12 mm over the centre: 5² + 12² = 13².
/// let line = Line { point: Vector3::new(0.005, 0.0, 0.1), direction: -Vector3::z() };
/// let mut heights = Vec::new();
/// tip.crossings(&line, |crossing| heights.push(crossing.point.z));
/// assert!((heights[0] - 0.042_f64).abs() < 1e-15 && (heights[1] - 0.018).abs() < 1e-15);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere<T: Real> {
    centre: Vector3<T>,
    radius: T,
    curvature: T,
    /// A power of two that brings the radius near 1.
    scale: T,
}

impl<T: Real> Sphere<T> {
    /// Centre in the sensor frame and radius \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless the centre is finite, the radius a positive finite length, and all of the
    /// sphere within the range of the type.
    pub fn new(centre: Vector3<T>, radius: T) -> Result<Self, BadShape> {
        let centre = BadShape::check_point("sphere", "centre", centre)?;
        let radius = BadShape::check_length("sphere", "radius", radius)?;
        let farthest = centre.amax() + radius;
        BadShape::check("sphere", "centre", "within the range of the type", farthest.is_number())?;
        Ok(Self { centre, radius, curvature: T::one() / radius, scale: radius.normalising_factor() })
    }

    /// Centred at the origin of the sensor frame.
    ///
    /// # Errors
    /// [`BadShape`] unless the radius is a positive finite length.
    pub fn centred(radius: T) -> Result<Self, BadShape> {
        Self::new(Vector3::zeros(), radius)
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<Sphere<f64>> {
        Sphere::new(wide(&self.centre), self.radius.to_f64()).ok()
    }

    /// Centre in the sensor frame \[m\].
    #[inline]
    #[must_use]
    pub const fn centre(&self) -> Vector3<T> {
        self.centre
    }

    /// Radius \[m\].
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> T {
        self.radius
    }

    /// Its reciprocal \[1/m\].
    #[inline]
    #[doc(hidden)]
    pub const fn curvature(&self) -> T {
        self.curvature
    }

    /// From the centre to the point of the line closest to it, in radii, and that point's position
    /// along the line \[m\].
    #[inline]
    fn foot(&self, line: &Line<T>) -> (Vector3<T>, T) {
        let from_centre = line.point - self.centre;
        let along = -from_centre.dot(&line.direction);
        // Square to the direction whatever rounding left of a long way: so normals are unit vectors.
        let foot = from_centre + line.direction * along;
        ((foot - line.direction * foot.dot(&line.direction)) * self.curvature, along)
    }
}

impl<T: Real> ActiveSurface<T> for Sphere<T> {
    /// Equation (2) of Bicchi & Dario 1987 with its signs mended (`docs/theory/surfaces.md#sphere`), in
    /// radii, so that nothing over- or underflows.
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let (foot, along) = self.foot(line);
        let squared = T::one() - foot.norm_squared();
        if squared >= T::zero() {
            let half_chord = squared.root();
            for offset in [-half_chord, half_chord] {
                let normal = foot + line.direction * offset;
                visit(Crossing {
                    along: along + offset * self.radius,
                    point: self.centre + normal * self.radius,
                    normal,
                    active: true,
                });
            }
        }
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let (foot, _) = self.foot(line);
        // Of a line that misses, the foot is a radius away or more: only overflow must be minded.
        let scale = largest(&foot).normalising_factor();
        let scaled = foot * scale;
        let distance = scaled.norm_squared().root();
        // A line through the centre is asked about only by mistake: it meets the surface here. One at
        // the end of the range is a guess.
        let unit = scaled / distance;
        let normal = if (unit.x + unit.y + unit.z).is_number() { unit } else { line.direction };
        let gap = smaller(larger((distance / scale - T::one()) * self.radius, T::zero()), T::GREATEST);
        Some(ClosestApproach { gap, point: self.centre + normal * self.radius, normal, active: true })
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        unit_or(&(point - self.centre), Vector3::z)
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        ((point - self.centre) * self.curvature).norm_squared() < T::one()
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Sphere<T> {
    const CLOSED_CONVEX: bool = true;

    /// In radii, too: the foot of the line seen from the centre, `f × m_c/(R·|f|²)`, and from there
    /// back against the force by half a chord. The foot's length is the sine of incidence: it gives the
    /// tangential force to the last digits even where that is small.
    #[inline]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let force = push.force();
        let inverse = T::one() / push.squared();
        let foot = force.cross(&(push.torque_about(&self.centre) * self.curvature)) * inverse;
        // The square of the cosine of incidence, and of half the chord.
        let sine_squared = foot.norm_squared();
        let squared = T::one() - sine_squared;
        let back = (squared * inverse).root();
        let normal = foot - force * back;
        Some(Entry {
            point: self.centre + normal * self.radius,
            normal,
            incidence_squared: squared,
            parts: Some(ForceParts {
                normal: push.squared() * back,
                tangential: (push.squared() * sine_squared).root(),
            }),
            active: true,
        })
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let from_centre = difference(&(point * self.scale), &(self.centre * self.scale));
        outside_ball(from_centre, self.radius * self.scale) / self.scale
    }

    fn posed_entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        entry_near(&self.in_double()?, line, near)
    }
}

impl<T: Real> SignedDistance<T> for Sphere<T> {
    const CONVEX: bool = true;

    fn signed_distance(&self, point: &Vector3<T>) -> Distance<T> {
        let distance = length(&(point - self.centre)) - self.radius;
        Distance { distance, normal: self.normal(point) }
    }

    fn bounds(&self) -> (Vector3<T>, T) {
        (self.centre, self.radius)
    }
}

impl<T: Real> SmoothSurface<T> for Sphere<T> {
    #[inline]
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let from_centre = point - self.centre();
        let distance = length(&from_centre);
        let normal = self.normal(point);
        Level {
            value: distance - self.radius(),
            gradient: normal,
            hessian: (Matrix3::identity() - normal * normal.transpose()) / distance,
        }
    }

    fn extent(&self) -> Extent<T> {
        Extent { centre: self.centre(), radius: self.radius() }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let normal = self.normal(point);
        (Matrix3::identity() - normal * normal.transpose()) / self.radius()
    }

    #[inline]
    fn bend(&self, _point: &Vector3<T>, _normal: &Vector3<T>, _tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        Matrix2::from_diagonal_element(self.curvature())
    }
}

stored! {
    Sphere<T>, [T: Real],
    |sphere| {
        #[serde(default = "Vector3::zeros")] centre_m: Vector3<T> = sphere.centre,
        radius_m: T = sphere.radius,
    },
    Sphere::new(centre_m, radius_m)
}
