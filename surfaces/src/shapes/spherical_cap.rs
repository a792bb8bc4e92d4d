//! The sphere with an opening.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix3, Vector3};

#[cfg(feature = "serde")]
use crate::numeric::vectors::{from_degrees, to_degrees};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Extent, Level, Shortcuts, SmoothSurface, Sphere,
    Topology,
};

/// Below every cosine, rounding included: the whole sphere has no rim.
const EVERYWHERE: f64 = -2.0;

/// A sphere that is active around a pole only: a dome, or, if the active part is more than half,
/// a sphere with an opening for its support.
///
/// The sensorised fingertip of Bicchi & Dario 1987 is a sphere of 13 mm with an opening of 7 mm
/// radius for the stem, which leaves 92 % of the directions:
///
/// ```
/// use fingertip_surfaces::{Sphere, SphericalCap};
/// use nalgebra::Vector3;
///
/// let sphere = Sphere::centred(0.013)?;
/// let tip = SphericalCap::with_opening(sphere, Vector3::x(), 0.007)?;
/// assert!((tip.active_fraction() - 0.92_f64).abs() < 0.005);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalCap<T: Real> {
    sphere: Sphere<T>,
    pole: Vector3<T>,
    least_cosine: T,
}

impl<T: Real> SphericalCap<T> {
    /// The part of a sphere whose normal is within an angle of the direction to the pole; given
    /// is the cosine of that angle: 0 for a hemisphere, −1 for the whole sphere.
    ///
    /// # Errors
    /// [`BadShape`] unless the pole has a direction and the cosine lies within [−1, 1).
    pub fn new(sphere: Sphere<T>, pole: Vector3<T>, least_cosine: T) -> Result<Self, BadShape> {
        BadShape::check(
            "spherical cap",
            "least cosine",
            "at least -1 and below 1",
            least_cosine >= -T::one() && least_cosine < T::one(),
        )?;
        let pole = BadShape::check_direction("sphere", "pole", pole)?;
        let least_cosine = if least_cosine > -T::one() { least_cosine } else { T::literal(EVERYWHERE) };
        Ok(Self { sphere, pole, least_cosine })
    }

    /// All of a sphere but a round opening, of a radius \[m\], opposite to the pole.
    ///
    /// # Errors
    /// [`BadShape`] unless the pole has a direction and the opening's radius is between zero and
    /// that of the sphere.
    pub fn with_opening(sphere: Sphere<T>, pole: Vector3<T>, opening: T) -> Result<Self, BadShape> {
        let ratio = opening / sphere.radius();
        BadShape::check(
            "sphere",
            "opening",
            "between zero and the sphere's radius",
            ratio >= T::zero() && ratio <= T::one(),
        )?;
        Self::new(sphere, pole, -((T::one() - ratio) * (T::one() + ratio)).root())
    }

    /// The whole sphere.
    #[inline]
    #[must_use]
    pub const fn sphere(&self) -> &Sphere<T> {
        &self.sphere
    }

    /// The unit vector from the centre to the middle of the active part.
    #[inline]
    #[must_use]
    pub const fn pole(&self) -> Vector3<T> {
        self.pole
    }

    /// The cosine of the greatest angle between the pole and an active normal: −1 if all of the sphere is active.
    #[inline]
    #[must_use]
    pub fn least_cosine(&self) -> T {
        self.least_cosine.max(-T::one())
    }

    /// The part of the sphere that is active, between 0 and 1.
    #[inline]
    #[must_use]
    pub fn active_fraction(&self) -> T {
        (T::one() - self.least_cosine()) * T::literal(0.5)
    }

    #[inline]
    fn is_active(&self, normal: &Vector3<T>) -> bool {
        normal.dot(&self.pole) >= self.least_cosine
    }
}

impl<T: Real> ActiveSurface<T> for SphericalCap<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        self.sphere.crossings(line, |c| visit(Crossing { active: self.is_active(&c.normal), ..c }));
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let approach = self.sphere.closest_approach(line)?;
        Some(ClosestApproach { active: self.is_active(&approach.normal), ..approach })
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.sphere.normal(point)
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        self.sphere.contains(point)
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self.sphere.shortcuts().within(|entry| self.is_active(&entry.normal))
    }
}

impl<T: Real> SmoothSurface<T> for SphericalCap<T> {
    #[inline]
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.sphere().level(point)
    }

    fn extent(&self) -> Extent<T> {
        self.sphere().extent()
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        self.sphere().shape_operator(point)
    }
}

/// All of it.
impl<T: Real> From<Sphere<T>> for SphericalCap<T> {
    fn from(sphere: Sphere<T>) -> Self {
        Self { sphere, pole: Vector3::z(), least_cosine: T::literal(EVERYWHERE) }
    }
}

/// In degrees.
#[cfg(feature = "serde")]
fn half_a_turn<T: Real>() -> T {
    T::literal(180.0)
}

stored! {
    SphericalCap<T>, [T: Real],
    |cap| {
        #[serde(default = "Vector3::zeros")]
        centre_m: Vector3<T> = cap.sphere.centre(),
        radius_m: T = cap.sphere.radius(),
        #[serde(default = "Vector3::z")] pole: Vector3<T> = cap.pole,
        #[serde(default = "half_a_turn")]
        active_half_angle_deg: T = to_degrees(cap.least_cosine().arccosine()),
    },
    Sphere::new(centre_m, radius_m).and_then(|sphere| {
        let angle = active_half_angle_deg;
        let good = angle > T::zero() && angle <= half_a_turn();
        BadShape::check("sphere", "active_half_angle_deg", "above 0 and at most 180", good)?;
        SphericalCap::new(sphere, pole, from_degrees(angle).cosine())
    })
}
