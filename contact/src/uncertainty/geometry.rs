//! How surfaces change with their parameters.

use fingertip_surfaces::numeric::vectors::is_finite;
use fingertip_surfaces::{BadShape, Level, SmoothSurface};
use fingertip_wrench::Real;
use nalgebra::{Matrix3, Vector3};

use super::is_covariance;

/// How a surface changes near a contact, per unit of one of its parameters.
///
/// ```
/// # use fingertip_contact::{ContactModel, SoftFinger};
/// # use fingertip_surfaces::Sphere;
/// # use fingertip_wrench::Wrench;
/// # use nalgebra::Vector3;
/// # let (sphere, wrench) = (Sphere::centred(0.01)?, Wrench::on_fingertip(-Vector3::z(), Vector3::zeros()));
/// # let contact = SoftFinger::new(0.05)?.resolve(&wrench, &sphere).into_result()?;
/// use fingertip_contact::{ContactJacobian, GeometrySensitivity};
///
/// // A contact at the top of a sphere moves up as its radius grows.
/// let jacobian = ContactJacobian::of_soft_finger_on(&contact, &sphere).ok_or("it grazes")?;
/// let by_radius = jacobian.point_answer_to(&GeometrySensitivity::<f64>::offset());
/// assert!((by_radius - Vector3::z()).norm() < 1e-12);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeometrySensitivity<T: Real> {
    /// How far the surface moves along its outward normal.
    pub displacement: T,
    /// How its normal turns at the point that moves so: a vector in the tangent plane.
    pub tilt: Vector3<T>,
}

impl<T: Real> GeometrySensitivity<T> {
    /// The parallel surface, outward: a sphere's or a cylinder's radius, the thickness of a coat.
    #[must_use]
    pub fn offset() -> Self {
        Self { displacement: T::one(), tilt: Vector3::zeros() }
    }

    /// A parameter that changes nothing here.
    #[must_use]
    pub fn none() -> Self {
        Self { displacement: T::zero(), tilt: Vector3::zeros() }
    }

    /// The whole surface moves along the unit vector `direction`.
    #[must_use]
    pub fn translation(direction: &Vector3<T>, normal: &Vector3<T>, shape_operator: &Matrix3<T>) -> Self {
        Self { displacement: direction.dot(normal), tilt: -(shape_operator * direction) }
    }

    /// The whole surface turns about the unit vector `axis` through `pivot` \[m\], per radian.
    #[must_use]
    pub fn rotation(
        axis: &Vector3<T>,
        pivot: &Vector3<T>,
        point: &Vector3<T>,
        normal: &Vector3<T>,
        shape_operator: &Matrix3<T>,
    ) -> Self {
        let moved = axis.cross(&(point - pivot));
        Self { displacement: moved.dot(normal), tilt: axis.cross(normal) - shape_operator * moved }
    }

    /// From a level function `S(x; θ)`: its derivative by the parameter, that of its gradient, and
    /// gradient and Hessian at the contact.
    #[must_use]
    pub fn of_level(
        value_change: T,
        gradient_change: &Vector3<T>,
        gradient: &Vector3<T>,
        hessian: &Matrix3<T>,
    ) -> Self {
        let steepness = gradient.norm_squared().root();
        let normal = gradient / steepness;
        let displacement = -value_change / steepness;
        let turned = (gradient_change + hessian * normal * displacement) / steepness;
        Self { displacement, tilt: turned - normal * normal.dot(&turned) }
    }
}

/// How well the place and the size of a surface are known, as a covariance.
///
/// ```
/// # use fingertip_contact::{ContactJacobian, ContactModel, SoftFinger};
/// # use fingertip_surfaces::Sphere;
/// # use fingertip_wrench::Wrench;
/// # use nalgebra::{Matrix6, Vector3};
/// # let (sphere, wrench) = (Sphere::centred(0.01)?, Wrench::on_fingertip(-Vector3::z(), Vector3::zeros()));
/// # let contact = SoftFinger::new(0.05)?.resolve(&wrench, &sphere).into_result()?;
/// # let jacobian = ContactJacobian::of_soft_finger_on(&contact, &sphere).ok_or("it grazes")?;
/// use fingertip_contact::{ContactCovariance, GeometryUncertainty};
/// use nalgebra::Matrix3;
///
/// // The radius is known to 0.05 mm, the centre to 0.03 mm in each direction, the wrench exactly.
/// let geometry = GeometryUncertainty {
///     offset: 0.05e-3_f64.powi(2),
///     position: Matrix3::identity() * 0.03e-3_f64.powi(2),
///     ..GeometryUncertainty::none()
/// }
/// .checked()?;
/// let covariance = ContactCovariance::new(&jacobian, &Matrix6::zeros()).with_geometry(&jacobian, &geometry);
/// // Of a contact at the top both move the height.
/// assert!((covariance.height_variance().sqrt() - 0.05e-3_f64.hypot(0.03e-3)).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeometryUncertainty<T: Real> {
    /// Variance of the surface's height along its normal \[m²\]: of a radius, of a coat, of the
    /// shape's departure from its model.
    pub offset: T,
    /// Covariance of its position \[m²\].
    pub position: Matrix3<T>,
    /// Covariance of its attitude, as a rotation vector about [`pivot`](Self::pivot) \[rad²\].
    pub attitude: Matrix3<T>,
    /// About what point it may be turned \[m\].
    pub pivot: Vector3<T>,
}

impl<T: Real> GeometryUncertainty<T> {
    /// Known exactly.
    #[must_use]
    pub fn none() -> Self {
        Self {
            offset: T::zero(),
            position: Matrix3::zeros(),
            attitude: Matrix3::zeros(),
            pivot: Vector3::zeros(),
        }
    }

    /// Itself, if it can be: for numbers that come from elsewhere.
    ///
    /// # Errors
    /// [`BadShape`] unless all numbers are finite, the variance is not negative, and the covariances are
    /// symmetric and have no negative variance in any direction, but for rounding.
    pub fn checked(self) -> Result<Self, BadShape> {
        let check = |parameter, good| {
            let requirement = "finite, symmetric and without a negative variance";
            BadShape::check("geometry's uncertainty", parameter, requirement, good)
        };
        check("offset", self.offset.is_number() && self.offset >= T::zero())?;
        check("position", is_covariance(&self.position))?;
        check("attitude", is_covariance(&self.attitude))?;
        BadShape::check("geometry's uncertainty", "pivot", "finite", is_finite(&self.pivot))?;
        Ok(self)
    }
}

/// Of a level function of the coordinates over the semi-axes, by one of these.
pub(crate) fn stretched<T: Real>(
    level: &Level<T>,
    point: &Vector3<T>,
    axis: usize,
    length: T,
) -> GeometrySensitivity<T> {
    let mut turned = level.hessian.column(axis) * (-point[axis] / length);
    turned[axis] -= level.gradient[axis] / length;
    let value = -level.gradient[axis] * point[axis] / length;
    GeometrySensitivity::of_level(value, &turned, &level.gradient, &level.hessian)
}

/// Moving and turning: what every surface has in common. Columns of the result are displacement
/// and tilt for the three translations, then the three rotations about `pivot`.
impl<T: Real> GeometrySensitivity<T> {
    /// How the surface changes at a point with the six rigid motions: translations along the axes
    /// of the sensor frame, rotations about them through `pivot`.
    #[must_use]
    pub fn rigid_motions<S: SmoothSurface<T>>(
        surface: &S,
        point: &Vector3<T>,
        pivot: &Vector3<T>,
    ) -> [Self; 6] {
        let normal = surface.normal(point);
        let bend = surface.shape_operator(point);
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        [0, 1, 2, 3, 4, 5].map(|i| match axes.get(i) {
            Some(axis) => Self::translation(axis, &normal, &bend),
            None => Self::rotation(&axes[i % 3], pivot, point, &normal, &bend),
        })
    }
}
