//! The sphere.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::Vector3;

use crate::numeric::twofold::{difference, outside_ball};
use crate::numeric::vectors::{larger, largest, length, smaller, unit_or};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Distance, Entry, ForceLine, ForceParts,
    SignedDistance,
};

/// A sphere, its inside being the fingertip.
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
    pub(crate) const fn curvature(&self) -> T {
        self.curvature
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
    const CLOSED_CONVEX: bool = true;

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

    fn closest_approach(&self, line: &Line<T>) -> ClosestApproach<T> {
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
        ClosestApproach { gap, point: self.centre + normal * self.radius, normal, active: true }
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        unit_or(&(point - self.centre), Vector3::z)
    }

    fn outside_by(&self, point: &Vector3<T>) -> T {
        let from_centre = difference(&(point * self.scale), &(self.centre * self.scale));
        outside_ball(from_centre, self.radius * self.scale) / self.scale
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        ((point - self.centre) * self.curvature).norm_squared() < T::one()
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

stored! {
    Sphere<T>, [T: Real],
    |sphere| {
        #[serde(default = "Vector3::zeros")] centre_m: Vector3<T> = sphere.centre,
        radius_m: T = sphere.radius,
    },
    Sphere::new(centre_m, radius_m)
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::Wrench;
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use crate::{ActiveSurface, ContactModel, ForceLine, PointContact, Sphere};

    /// In double precision, by the vectors: where a single-precision force enters, and its parts there.
    fn by_vectors(force: &Vector3<f64>, torque: &Vector3<f64>, radius: f64) -> [f64; 2] {
        let square = force.norm_squared();
        let foot = force.cross(torque) / square;
        let point = foot - force * ((radius * radius - foot.norm_squared()) / square).sqrt();
        [-force.dot(&point) / radius, force.cross(&point).norm() / radius]
    }

    /// However squarely a force presses, its small tangential part has all its digits.
    #[test]
    fn parts_of_the_force_are_known_to_the_last_digits() {
        let mut random = Pcg64Mcg::seed_from_u64(12);
        let radius = 0.013_f32;
        let (sphere, model) = (Sphere::centred(radius).unwrap(), PointContact::new(0.0_f32).unwrap());
        for _ in 0..20_000 {
            let mut any = || Vector3::<f64>::from_fn(|_, _| random.random_range(-1.0..1.0));
            let (force, arm) = (any(), any());
            let sine = 10.0_f64.powf(random.random_range(-9.0..-0.05));
            let strength = 10.0_f64.powf(random.random_range(-5.0..5.0));
            let force = (force.normalize() * strength).map(|x| x as f32);
            let wide = force.map(f64::from);
            let arm = wide.cross(&arm).cross(&wide).normalize() * (sine * f64::from(radius));
            let torque = arm.cross(&wide).map(|x| x as f32);
            let wrench = Wrench::on_fingertip(force, torque);
            let push = ForceLine::new(&wrench, ForceLine::least_squared()).unwrap();
            let parts = sphere.sole_entry(&push).unwrap().parts.unwrap();
            let wanted = by_vectors(&wide, &torque.map(f64::from), f64::from(radius));
            let eps = f64::from(f32::EPSILON);
            // A part of the torque along the force, from its rounding, cancels in the cross product.
            let off = |found: f32, wanted: f64| (f64::from(found) - wanted).abs() / wanted;
            assert!(off(parts.tangential, wanted[1]) <= 16.0 * eps, "{wrench:?}: {parts:?} {wanted:?}");
            // Of the cosine the digits that the sine takes are lost.
            let cosine_squared = 1.0 - sine * sine;
            let allowed = 16.0 * eps / cosine_squared;
            assert!(off(parts.normal, wanted[0]) <= allowed, "{wrench:?}: {parts:?} {wanted:?}");
            let (resolution, felt) = model.feel_near(&wrench, &sphere, None);
            let (contact, felt) = (resolution.into_result().unwrap(), felt.unwrap());
            let (afterwards, newtons) = (contact.contact_force(), allowed * strength);
            assert!(f64::from((felt.normal - afterwards.normal).abs()) <= newtons);
            assert!(f64::from((felt.tangential.vector() - afterwards.tangential.vector()).norm()) <= newtons);
            assert!(f64::from((felt.tangential_magnitude() - felt.tangential.norm()).abs()) <= newtons);
        }
    }
}
