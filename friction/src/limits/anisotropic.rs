//! Friction that differs with direction, as on ridged skin or brushed metal.

use fingertip_wrench::{ContactForce, Real, stored};
use nalgebra::Vector3;

use crate::bad_parameter::positive;
use crate::limits::cone::{hypot, saturated};
use crate::{BadParameter, FrictionLimit, FrictionModel, SlipDirection, SlipMargin};

/// The elliptic cone `(f₁/μ₁)² + (f₂/μ₂)² ≤ f_n²` (`docs/theory/friction.md#anisotropic-limit`), with
/// coefficients along two perpendicular directions of the tangent plane.
///
/// The margin is the signed Euclidean distance of the contact force to the cone, found as the least
/// distance to its supporting planes (a bounded search in one variable, some 40 steps of a square
/// root and two divisions). The spin torque is not limited. A tangential force outside the plane of
/// the two directions (there should be none) counts against the lower coefficient.
///
/// ```
/// use fingertip_friction::{AnisotropicCoulomb, FrictionLimit};
/// use fingertip_wrench::ContactForce;
/// use nalgebra::Vector3;
///
/// // Along the grain of wood, and across it.
/// let wood = AnisotropicCoulomb::new([Vector3::x(), Vector3::y()], [0.3, 0.6])?;
/// let pulled = |sideways| ContactForce::new(2.0, sideways, 0.0);
/// assert!(!wood.holds(&pulled(Vector3::new(1.0, 0.0, 0.0))) && wood.holds(&pulled(Vector3::new(0.0, 1.0, 0.0))));
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnisotropicCoulomb<T: Real> {
    /// The direction of the lower coefficient first.
    directions: [Vector3<T>; 2],
    coefficients: [T; 2],
}

/// The supporting plane nearest to a force: its outward normal has the components
/// `(along.0, along.1, −support)/√(1 + support²)` in (f₁, f₂, f_n).
struct Plane<T> {
    along: (T, T),
    support: T,
    distance: T,
}

impl<T: Real> AnisotropicCoulomb<T> {
    /// From two perpendicular unit vectors of the tangent plane, in the frame of the contact
    /// force, and the coefficient along each.
    ///
    /// # Errors
    /// [`BadParameter`] unless the directions are orthonormal to rounding and the coefficients
    /// positive and finite.
    pub fn new(directions: [Vector3<T>; 2], coefficients: [T; 2]) -> Result<Self, BadParameter> {
        let rounding = T::literal(16.0) * T::EPSILON;
        let unit = |v: &Vector3<T>| (v.norm_squared() - T::one()).abs() <= rounding;
        let [first, second] = directions;
        if !(unit(&first) && unit(&second) && first.dot(&second).abs() <= rounding) {
            return Err(BadParameter { parameter: "directions", requirement: "perpendicular unit vectors" });
        }
        let [one, two] = coefficients;
        let (one, two) = (positive(one, "friction coefficient")?, positive(two, "friction coefficient")?);
        Ok(if one <= two {
            Self { directions, coefficients: [one, two] }
        } else {
            Self { directions: [second, first], coefficients: [two, one] }
        })
    }

    /// The coefficients, the lower first.
    #[inline]
    #[must_use]
    pub const fn coefficients(&self) -> [T; 2] {
        self.coefficients
    }

    /// The directions that go with [`coefficients`](Self::coefficients).
    #[inline]
    #[must_use]
    pub const fn directions(&self) -> [Vector3<T>; 2] {
        self.directions
    }

    /// Components along the directions; what lies outside their plane is added to the first.
    #[inline]
    fn split(&self, force: &ContactForce<T>) -> (T, T) {
        let [first, second] = &self.directions;
        let (one, two) = (force.tangential.dot(first), force.tangential.dot(second));
        let rest = force.tangential.vector() - first * one - second * two;
        let outside = rest.amax();
        if outside <= T::literal(8.0) * T::EPSILON * force.tangential.amax() {
            (one, two)
        } else {
            (hypot(one, outside * T::literal(3.0).root()).copysign(one), two)
        }
    }

    /// The normal force at which the tangential force just slips.
    #[inline]
    fn gauge(&self, (one, two): (T, T)) -> T {
        hypot(one / self.coefficients[0], two / self.coefficients[1])
    }

    /// Distance from the plane with normal direction `((1−t²), 2t)/(1+t²)` in the tangent plane.
    #[inline]
    fn plane(&self, (one, two): (T, T), normal: T, t: T) -> Plane<T> {
        let square = t * t;
        let along = ((T::one() - square) / (T::one() + square), (t + t) / (T::one() + square));
        let support = hypot(self.coefficients[0] * along.0, self.coefficients[1] * along.1);
        let length = hypot(T::one(), support);
        let distance = normal * (support / length) - one * (along.0 / length) - two * (along.1 / length);
        Plane { along, support, distance }
    }

    /// The nearest supporting plane. Components must not be negative. In this quadrant the distance
    /// has one minimum (the projection on a quadric cone; Eberly's point-to-ellipse problem), which
    /// a golden section finds; the error of the distance is of second order in that of the angle.
    fn nearest(&self, components: (T, T), normal: T) -> Plane<T> {
        let golden = T::literal(0.618_033_988_749_894_9);
        let (mut low, mut high) = (T::zero(), T::one());
        let mut left = high - golden * (high - low);
        let mut right = low + golden * (high - low);
        let mut at_left = self.plane(components, normal, left).distance;
        let mut at_right = self.plane(components, normal, right).distance;
        for _ in 0..44 {
            if at_left <= at_right {
                high = right;
                right = left;
                at_right = at_left;
                left = high - golden * (high - low);
                at_left = self.plane(components, normal, left).distance;
            } else {
                low = left;
                left = right;
                at_left = at_right;
                right = low + golden * (high - low);
                at_right = self.plane(components, normal, right).distance;
            }
        }
        // The ends are not reached by the search.
        [T::zero(), T::one()].into_iter().map(|t| self.plane(components, normal, t)).fold(
            self.plane(components, normal, (low + high) * T::literal(0.5)),
            |best, end| {
                if end.distance < best.distance { end } else { best }
            },
        )
    }

    /// `true` where the apex is the nearest point of the cone.
    #[inline]
    fn in_polar_cone(&self, (one, two): (T, T), normal: T) -> bool {
        normal <= T::zero() && hypot(self.coefficients[0] * one, self.coefficients[1] * two) <= -normal
    }

    fn distance(&self, components: (T, T), normal: T) -> T {
        // At unit scale, so that nothing over- or underflows between.
        let scale = components.0.abs().max(components.1.abs()).max(normal.abs()).normalising_factor();
        let scaled = (components.0.abs() * scale, components.1.abs() * scale);
        let normal = normal * scale;
        let distance = if self.in_polar_cone(scaled, normal) {
            -hypot(hypot(scaled.0, scaled.1), normal)
        } else {
            self.nearest(scaled, normal).distance
        };
        distance / scale
    }
}

impl<T: Real> FrictionModel<T> for AnisotropicCoulomb<T> {
    fn slip_margin(&self, force: &ContactForce<T>) -> SlipMargin<T> {
        let components = self.split(force);
        let gauge = self.gauge(components);
        let newtons = self.distance(components, force.normal);
        let utilisation = if gauge <= T::zero() && force.normal >= T::zero() {
            T::zero()
        } else if force.normal > T::zero() {
            (gauge / force.normal).min(T::GREATEST)
        } else {
            T::GREATEST
        };
        if newtons.is_number() { SlipMargin { newtons, utilisation } } else { SlipMargin::unknown() }
    }

    #[inline]
    fn least_normal_force(&self, force: &ContactForce<T>, safety: T) -> T {
        saturated(self.gauge(self.split(force)) * safety)
    }
}

impl<T: Real> FrictionLimit<T> for AnisotropicCoulomb<T> {
    /// By the sign of the gauge, which is exact to rounding.
    fn holds(&self, force: &ContactForce<T>) -> bool {
        self.gauge(self.split(force)) <= force.normal && force.normal.is_number()
    }

    /// By bisection: the distance grows with the normal force.
    fn normal_force_keeping(&self, force: &ContactForce<T>, margin: T) -> T {
        let components = self.split(force);
        let least = self.gauge(components);
        // In the direction of the lower coefficient the wall is steepest and nearest.
        let margin = margin.max(T::zero());
        let lower = self.coefficients[0];
        let mut high = saturated(least + margin * (hypot(T::one(), lower) / lower));
        if !(high < T::GREATEST) {
            return T::GREATEST;
        }
        let mut low = least;
        for _ in 0..64 {
            let middle = low + (high - low) * T::literal(0.5);
            if middle <= low || middle >= high {
                break;
            }
            if self.distance(components, middle) >= margin {
                high = middle;
            } else {
                low = middle;
            }
        }
        high
    }

    /// The spin torque is set to zero: a point contact carries none.
    fn project(&self, force: &ContactForce<T>) -> ContactForce<T> {
        let components = self.split(force);
        if !(force.is_finite() && self.gauge(components).is_number()) {
            return ContactForce::zero();
        }
        if self.holds(force) {
            return ContactForce { spin: T::zero(), ..*force };
        }
        let scale = force.tangential.amax().max(force.normal.abs()).normalising_factor();
        let scaled = (components.0.abs() * scale, components.1.abs() * scale);
        let normal = force.normal * scale;
        if self.in_polar_cone(scaled, normal) {
            return ContactForce::zero();
        }
        let plane = self.nearest(scaled, normal);
        let step = plane.distance / hypot(T::one(), plane.support);
        let one = ((scaled.0 + step * plane.along.0).max(T::zero()) / scale).copysign(components.0);
        let two = ((scaled.1 + step * plane.along.1).max(T::zero()) / scale).copysign(components.1);
        // The search errs in the angle; the gauge puts the result on the cone all the same.
        let normal = self.gauge((one, two)) * (T::one() + T::literal(4.0) * T::EPSILON);
        let tangential = self.directions[0] * one + self.directions[1] * two;
        ContactForce::new(normal, tangential, T::zero())
    }

    fn slip_direction(&self, force: &ContactForce<T>) -> Option<SlipDirection<T>> {
        let (one, two) = self.split(force);
        let (one, two) = (one / self.coefficients[0], two / self.coefficients[1]);
        let scale = one.abs().max(two.abs()).normalising_factor();
        let gradient = self.directions[0] * (one * scale / self.coefficients[0])
            + self.directions[1] * (two * scale / self.coefficients[1]);
        let length = gradient.norm_squared().root();
        let velocity = -gradient / length;
        // Without a load the quotient is not a number.
        let known = force.is_finite() && velocity.iter().all(|x| x.is_number());
        known.then_some(SlipDirection { velocity, spin: T::zero() })
    }
}

stored! {
    AnisotropicCoulomb<T>, [T: Real],
    |model| {
        directions: [[T; 3]; 2] = model.directions.map(Into::into),
        coefficients: [T; 2] = model.coefficients,
    },
    Self::new(directions.map(Into::into), coefficients)
}
