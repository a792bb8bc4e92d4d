//! How far a contact may be from the truth.

use fingertip_surfaces::Sphere;
use fingertip_surfaces::numeric::vectors::{hypotenuse, length};
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix3, Matrix3x6, Matrix6};

use super::Contact;
use crate::ConvexBound;

/// What is known about the errors behind a contact: the greatest they can be.
///
/// ```
/// use fingertip_contact::{ContactBound, WorstErrors};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let (sphere, wrench) = (Sphere::centred(0.013)?, Wrench::on_fingertip(-Vector3::z(), Vector3::zeros()));
/// // 10 mN and 0.1 N·mm at most; and a sphere that was measured to 0.05 mm.
/// let of_sensor = WorstErrors::of_wrench(0.01, 1e-4);
/// let of_all = WorstErrors { radius: 5e-5, ..of_sensor };
/// let bound = |errors| ContactBound::on_sphere(&sphere, &wrench, &errors).ok_or("no bound");
/// assert!(bound(of_all)?.distance > bound(of_sensor)?.distance);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WorstErrors<T: Real> {
    /// Length of the force's error \[N\].
    pub force: T,
    /// Length of the torque's error, about the origin of the sensor frame \[N·m\].
    pub torque: T,
    /// Error of the surface's radius \[m\].
    pub radius: T,
    /// Distance of the surface's true centre from the assumed one \[m\].
    pub centre: T,
}

impl<T: Real> WorstErrors<T> {
    /// Errors of the wrench only.
    #[inline]
    #[must_use]
    pub fn of_wrench(force: T, torque: T) -> Self {
        Self { force, torque, radius: T::zero(), centre: T::zero() }
    }
}

/// How far the true contact can be from the computed one.
///
/// ```
/// use fingertip_contact::{ContactBound, WorstErrors};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let (sphere, errors) = (Sphere::centred(0.01)?, WorstErrors::of_wrench(0.01, 1e-4));
/// // 1 N through the centre: to first order (0.1 N·mm + 10 mm · 10 mN)/1 N.
/// let straight = Wrench::on_fingertip(-Vector3::z(), Vector3::zeros());
/// let bound = ContactBound::on_sphere(&sphere, &straight, &errors).ok_or("no bound")?;
/// assert!(!bound.grazing && (bound.distance - 0.2e-3_f64).abs() < 0.02e-3);
/// // 9.95 mm from the centre the line may miss.
/// let at_the_side = Wrench::on_fingertip(-Vector3::z(), Vector3::new(0.0, 9.95e-3, 0.0));
/// let bound = ContactBound::on_sphere(&sphere, &at_the_side, &errors).ok_or("no bound")?;
/// assert!(bound.grazing && bound.distance > 1e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactBound<T: Real> {
    /// No point of contact that agrees with the measurement is farther away than this \[m\].
    pub distance: T,
    /// The line of action is so near to tangent that linear propagation of errors (covariances)
    /// is not to be trusted: `ε·sin φ > 0.1·R·cos² φ` (`docs/theory/contact.md#grazing`), or it misses the
    /// surface.
    pub grazing: bool,
}

impl<T: Real> ContactBound<T> {
    /// A rigorous bound of the error of a point contact with a sphere: it holds for errors of
    /// any size up to the whole force, at any incidence, for lines that graze or miss too
    /// (`docs/theory/contact.md#rigorous-bound-on-a-sphere`). Near grazing it grows as the root of the
    /// errors, where linear bounds would be infinite. Rounding in the scalar type is included.
    ///
    /// The computed contact is that of [`PointContact`](crate::PointContact), or for a line that misses the closest
    /// point of the sphere. `None` if the wrench has no line of action, or if the error of the force is not
    /// smaller than the force or that of the radius not smaller than the radius.
    #[must_use]
    pub fn on_sphere(sphere: &Sphere<T>, wrench: &Wrench<T>, errors: &WorstErrors<T>) -> Option<Self> {
        let zero = T::zero();
        let axis = wrench.line_of_action().ok()?;
        let radius = sphere.radius();
        let from_centre = axis.line.point - sphere.centre();
        let foot = from_centre - axis.line.direction * from_centre.dot(&axis.line.direction);
        let offset = length(&foot);
        // In units of the force, so that no product leaves the range of the type. Rounding acts as
        // an error of the wrench of a few units in the last place.
        let rounding = T::literal(16.0) * T::EPSILON;
        let arm = length(&sphere.centre());
        let force_error = errors.force / axis.force + rounding;
        let torque_error = errors.torque / axis.force
            + arm * (errors.force / axis.force)
            + rounding * (length(&axis.line.point) + arm + radius);
        let left = T::one() - force_error;
        if !(left > zero) || !(errors.radius < radius) {
            return None;
        }
        let shell = errors.radius + errors.centre;
        let tube = torque_error + (radius + shell) * force_error;
        let half_chord = |r: T, d: T| ((r - d).max(zero) * (r + d)).root();
        let longest = half_chord(radius + shell, (offset - tube).max(zero));
        let shortest =
            if radius > shell { half_chord(radius - shell, (offset + tube).min(radius)) } else { zero };
        let slack = (radius + errors.radius) * force_error + errors.centre;
        let (along, across, cosine);
        if offset < radius {
            // Rounding leaves the computed contact somewhere between these.
            let hair = rounding * (radius + length(&axis.line.point) + arm);
            let least = half_chord(radius, (offset + hair).min(radius));
            let most = half_chord(radius, (offset - hair).max(zero));
            let beyond = if shortest > slack {
                (most - shortest).max(shortest - least)
            } else {
                most + longest.min(slack)
            };
            along = (longest - least).max(most - longest).max(beyond);
            across = tube;
            cosine = half_chord(radius, offset) / radius;
        } else {
            along = longest;
            across = offset - radius + tube;
            cosine = zero;
        }
        let sine = (offset / radius).min(T::one());
        let distance = hypotenuse(along, across) * (T::one() + rounding);
        distance
            .is_number()
            .then_some(Self { distance, grazing: tube * sine > T::literal(0.1) * radius * cosine * cosine })
    }
}

/// For every convex shape: `grazing` is then set if it cannot be excluded that the true contact lies
/// past the silhouette, where the measured force would pull. ([`ContactBound::on_sphere`] is tighter on a
/// sphere.)
impl<T: Real> From<ConvexBound<T>> for ContactBound<T> {
    #[inline]
    fn from(bound: ConvexBound<T>) -> Self {
        Self { distance: bound.distance, grazing: bound.past_silhouette }
    }
}

impl<T: Real> Contact<T> {
    /// First-order bound of the error of a point contact on any smooth surface,
    /// `(|δm| + |c|·|δf|)/(|f|·cos φ)` \[m\] (`docs/theory/contact.md#errors-of-a-point-contact`), for errors
    /// of the force \[N\] and of the torque about the sensor's origin \[N·m\] up to the given lengths. `None`
    /// at an incidence of zero, where there is no such bound.
    #[must_use]
    pub fn first_order_bound(&self, force_error: T, torque_error: T) -> Option<T> {
        let force = length(&self.force);
        let bound = (torque_error / force + length(&self.point) * (force_error / force)) / self.incidence();
        bound.is_number().then_some(bound)
    }

    /// How the contact point moves with the wrench: the derivative of the point by force (first
    /// three columns \[m/N\]) and torque (last three \[1/N\]), by the implicit function theorem
    /// (`docs/theory/contact.md#errors-of-a-point-contact`). `wrench` is the one that the point contact was
    /// resolved from. `None` at an incidence of zero.
    ///
    /// ```text
    /// ∂c/∂m = Π[f]/|f|²,  ∂c/∂f = −Π[f]([c] + p·I)/|f|²,  Π = I − f·nᵀ/(f·n),  p = pitch
    /// ```
    #[must_use]
    pub fn sensitivity(&self, wrench: &Wrench<T>) -> Option<Matrix3x6<T>> {
        let axis = wrench.line_of_action().ok()?;
        let u = axis.line.direction;
        let projection = Matrix3::identity() - u * (self.normal / u.dot(&self.normal)).transpose();
        let by_torque = projection * u.cross_matrix() / axis.force;
        let arm = self.point.cross_matrix() + Matrix3::from_diagonal_element(axis.pitch);
        let by_force = -(by_torque * arm);
        let mut both = Matrix3x6::zeros();
        both.fixed_columns_mut::<3>(0).copy_from(&by_force);
        both.fixed_columns_mut::<3>(3).copy_from(&by_torque);
        both.iter().all(|x| x.is_number()).then_some(both)
    }

    /// First-order covariance of the contact point \[m²\] from that of the wrench
    /// `[fx fy fz tx ty tz]`; it has rank 2, in the tangent plane. `None` at an incidence of zero.
    #[must_use]
    pub fn covariance(&self, wrench: &Wrench<T>, of_wrench: &Matrix6<T>) -> Option<Matrix3<T>> {
        self.sensitivity(wrench).map(|by| by * of_wrench * by.transpose())
    }
}
