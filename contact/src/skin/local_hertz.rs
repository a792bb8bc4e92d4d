//! Hertz's theory with the curvature where it touches.

use fingertip_surfaces::numeric::vectors::tangents;
use fingertip_surfaces::{BadShape, SmoothSurface};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::hertz::Hertz;
use super::{Indentation, IndentationSlope, SkinLaw};
use crate::Contact;

/// [`Hertz`] for a fingertip whose curvature changes from place to place, on flat objects or on
/// spherical ones. Solving for the patch at every sample costs a few microseconds.
///
/// Where the fingertip is flat or hollow against the object, Hertz's theory gives no patch; the
/// curvature is then taken as `1/largest radius`.
///
/// ```
/// use fingertip_contact::{Compliant, Hertz, LocalHertz, PointContact};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // A contact modulus of 1 MPa against flat objects; radii are believed up to 0.1 m.
/// let skin = Compliant::new(PointContact::new(0.05)?, LocalHertz::new(1e6_f64, 0.0, 0.1)?);
/// let push = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
/// let found = skin.resolve_indented(&push, &Sphere::centred(0.01)?, None)?;
/// // On a sphere it is what Hertz says of that sphere.
/// let expected = Hertz::sphere(0.01_f64, 1e6)?.indentation(1.0);
/// assert!((found.indentation.depth - expected.depth).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LocalHertz<T: Real> {
    modulus: T,
    object_curvature: T,
    largest_radius: T,
}

impl<T: Real> LocalHertz<T> {
    /// From the contact modulus \[Pa\], the curvature of the object \[1/m\] (zero if flat, negative
    /// if hollow), and the largest relative radius of curvature that is believed \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless modulus and radius are positive and finite and the curvature is finite.
    pub fn new(modulus: T, object_curvature: T, largest_radius: T) -> Result<Self, BadShape> {
        Hertz::sphere(largest_radius, modulus)?;
        BadShape::check("Hertz contact", "curvature of the object", "finite", object_curvature.is_number())?;
        Ok(Self { modulus, object_curvature, largest_radius })
    }

    /// The law at a place with these principal curvatures of the fingertip \[1/m\].
    fn law(&self, curvatures: [T; 2]) -> Option<Hertz<T>> {
        let least = T::one() / self.largest_radius;
        let radii = curvatures.map(|curvature| T::one() / (curvature + self.object_curvature).max(least));
        Hertz::new(radii, self.modulus).or_else(|_| Hertz::sphere(self.largest_radius, self.modulus)).ok()
    }
}

impl<T: Real> LocalHertz<T> {
    /// The law at a point of the surface \[m\] with this normal.
    fn law_at<S: SmoothSurface<T>>(
        &self,
        surface: &S,
        point: &Vector3<T>,
        normal: &Vector3<T>,
    ) -> Option<Hertz<T>> {
        let bend = surface.shape_operator(point);
        let (e1, e2): (Vector3<T>, Vector3<T>) = tangents(normal);
        let (b1, b2) = (bend * e1, bend * e2);
        let half = T::literal(0.5);
        let (w11, w12, w22) = (e1.dot(&b1), e1.dot(&b2), e2.dot(&b2));
        let (mean, apart) = ((w11 + w22) * half, (w11 - w22) * half);
        let spread = (apart * apart + w12 * w12).root();
        self.law([mean + spread, mean - spread])
    }
}

impl<T: Real, S: SmoothSurface<T>> SkinLaw<T, S> for LocalHertz<T> {
    fn indentation_at(&self, surface: &S, contact: &Contact<T>, normal_force: T) -> Indentation<T> {
        self.law_at(surface, &contact.point, &contact.normal)
            .map_or(Indentation { depth: T::zero(), patch: [T::zero(); 2] }, |law| {
                law.indentation(normal_force)
            })
    }

    /// From place to place by differences of the curvature over `ε^(1/3)` of the surface's extent.
    fn slope_at(&self, surface: &S, contact: &Contact<T>, normal_force: T) -> IndentationSlope<T> {
        let step = surface.extent().radius * T::EPSILON.cube_root();
        let (e1, e2) = tangents(&contact.normal);
        let depth_at = |point: &Vector3<T>| {
            let law = self.law_at(surface, point, &surface.normal(point));
            law.map_or(T::zero(), |law| law.indentation(normal_force).depth)
        };
        let along = [e1, e2].map(|e| {
            let (ahead, behind) = (contact.point + e * step, contact.point - e * step);
            e * ((depth_at(&ahead) - depth_at(&behind)) / (step + step))
        });
        let law = self.law_at(surface, &contact.point, &contact.normal);
        IndentationSlope {
            by_force: law.map_or(T::zero(), |law| law.compliance(normal_force)),
            along: along[0] + along[1],
        }
    }
}
