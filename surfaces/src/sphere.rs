//! The sphere.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::{ActiveSurface, BadShape, ClosestApproach, Crossing};

/// A sphere, its inside being the fingertip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        try_from = "Parts<T>",
        into = "Parts<T>",
        bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>")
    )
)]
pub struct Sphere<T: Real> {
    centre: Vector3<T>,
    radius: T,
    curvature: T,
}

impl<T: Real> Sphere<T> {
    /// Centre in the sensor frame and radius \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless the centre is finite and the radius a positive finite length.
    pub fn new(centre: Vector3<T>, radius: T) -> Result<Self, BadShape> {
        let centre = BadShape::check_point("sphere", "centre", centre)?;
        let radius = BadShape::check_length("sphere", "radius", radius)?;
        Ok(Self { centre, radius, curvature: T::one() / radius })
    }

    /// Centred at the origin of the sensor frame.
    ///
    /// # Errors
    /// [`BadShape`] unless the radius is a positive finite length.
    pub fn centred(radius: T) -> Result<Self, BadShape> {
        Self::new(Vector3::zeros(), radius)
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

    /// From the centre to the point of the line closest to it, in radii, and that point's position
    /// along the line \[m\].
    #[inline]
    fn foot(&self, line: &Line<T>) -> (Vector3<T>, T) {
        let from_centre = line.point - self.centre;
        let along = -from_centre.dot(&line.direction);
        ((from_centre + line.direction * along) * self.curvature, along)
    }
}

impl<T: Real> ActiveSurface<T> for Sphere<T> {
    /// Equation (2) of Bicchi & Dario 1987 with its signs mended (theory 1, E1), in radii, so that
    /// nothing over- or underflows.
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

    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T> {
        let (foot, _) = self.foot(line);
        let scale = foot.amax().normalising_factor();
        let scaled = foot * scale;
        let length = scaled.norm_squared().root();
        // A line through the centre is asked about only by mistake: any point of the circle
        // across it is then as good.
        let normal = if length > T::zero() { scaled / length } else { any_perpendicular(&line.direction) };
        let distance = length / scale;
        ClosestApproach {
            gap: ((distance - T::one()) * self.radius).max(T::zero()).min(T::GREATEST),
            point: self.centre + normal * self.radius,
            normal,
            active: true,
        }
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        let from_centre = point - self.centre;
        let scaled = from_centre * from_centre.amax().normalising_factor();
        let length = scaled.norm_squared().root();
        if length > T::zero() { scaled / length } else { Vector3::z() }
    }
}

/// A unit vector across a unit vector.
pub(crate) fn any_perpendicular<T: Real>(direction: &Vector3<T>) -> Vector3<T> {
    let axis = match direction.iamin() {
        0 => Vector3::x(),
        1 => Vector3::y(),
        _ => Vector3::z(),
    };
    let across = direction.cross(&axis);
    let length = across.norm_squared().root();
    if length > T::zero() { across / length } else { axis }
}

/// How a sphere is written in a file; reading one validates it again.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))]
struct Parts<T: Real> {
    centre: Vector3<T>,
    radius: T,
}

#[cfg(feature = "serde")]
impl<T: Real> From<Sphere<T>> for Parts<T> {
    fn from(sphere: Sphere<T>) -> Self {
        Self { centre: sphere.centre, radius: sphere.radius }
    }
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Parts<T>> for Sphere<T> {
    type Error = BadShape;
    fn try_from(parts: Parts<T>) -> Result<Self, BadShape> {
        Self::new(parts.centre, parts.radius)
    }
}
