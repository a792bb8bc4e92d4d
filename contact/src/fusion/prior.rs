//! What a tactile array says of one contact.

use fingertip_surfaces::numeric::vectors::tangents;
use fingertip_surfaces::numeric::vectors::unit_or;
use fingertip_surfaces::{ActiveSurface, BadShape};
use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix2, Matrix3, Matrix5, Matrix6x5, Vector2, Vector3, Vector5};

/// One contact as a tactile array in the skin reports it (extrinsic tactile sensing).
///
/// ```
/// use fingertip_contact::{ArrayContact, Fusion};
/// use fingertip_surfaces::Plane;
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix3, Matrix6, Vector3};
///
/// // A taxel array of 1 mm feels 1.2 N, 4 mm from the middle of the pad.
/// let reading = ArrayContact {
///     centroid: Vector3::new(0.004, 0.0, 0.0),
///     centroid_covariance: Matrix3::identity() * 1e-6,
///     normal_force: 1.2,
///     normal_deviation: 0.1,
/// };
/// // The wrench puts the force at 3.8 mm, and is surer: 10 mN, 0.1 N·mm.
/// let wrench = Wrench::from_force_at(&Vector3::new(0.0038, 0.0, 0.0), Vector3::new(0.0, 0.0, -1.2));
/// let noise = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// let pad = Plane::new(Vector3::zeros(), Vector3::z())?;
/// let fused = Fusion::new(noise, 0.5)?.estimate(&pad, &wrench, &[reading])?;
/// assert!((fused.contacts[0].point.x - 0.0038_f64).abs() < 2e-5);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArrayContact<T: Real> {
    /// Centroid of the pressure \[m\].
    pub centroid: Vector3<T>,
    /// Covariance of the centroid \[m²\]; only its part in the tangent plane counts.
    pub centroid_covariance: Matrix3<T>,
    /// Sum of the pressure: the normal force \[N\].
    pub normal_force: T,
    /// Standard deviation of the normal force \[N\].
    pub normal_deviation: T,
}

impl<T: Real> ArrayContact<T> {
    pub(super) fn is_valid(&self) -> bool {
        let numbers = self.centroid.sum() + self.centroid_covariance.sum() + self.normal_force;
        let spread = self.centroid_covariance.diagonal().min();
        numbers.is_number()
            && spread >= T::zero()
            && self.normal_deviation > T::zero()
            && self.normal_deviation.is_number()
    }
}

/// The reading as a Gaussian in the frame of the surface at the centroid: two shifts in the tangent
/// plane there, and the force.
#[derive(Clone, Copy)]
pub(super) struct Prior<T: Real> {
    origin: Vector3<T>,
    normal: Vector3<T>,
    tangents: [Vector3<T>; 2],
    shift_covariance: Matrix2<T>,
    pub(super) force: Vector3<T>,
    normal_variance: T,
    tangential_variance: T,
}

/// Where a contact is taken to be while the estimate is sought.
#[derive(Clone, Copy)]
pub(super) struct State<T: Real> {
    pub(super) shift: Vector2<T>,
    pub(super) force: Vector3<T>,
    pub(super) point: Vector3<T>,
    pub(super) normal: Vector3<T>,
}

impl<T: Real> State<T> {
    /// Shift and force.
    pub(super) fn vector(&self) -> Vector5<T> {
        Vector5::new(self.shift.x, self.shift.y, self.force.x, self.force.y, self.force.z)
    }
}

impl<T: Real> Prior<T> {
    pub(super) fn new<S: ActiveSurface<T>>(
        surface: &S,
        reading: &ArrayContact<T>,
        friction: T,
    ) -> Result<Self, BadShape> {
        let bad = |requirement| BadShape { shape: "array contact", parameter: "reading", requirement };
        if !reading.is_valid() {
            return Err(bad("finite, with variances that are not negative and a deviation above zero"));
        }
        let outward = surface.normal(&reading.centroid);
        let (point, normal) = nearest(surface, &reading.centroid, &outward).ok_or(bad("near the surface"))?;
        let (first, second) = tangents(&normal);
        let spread = |a: &Vector3<T>, b: &Vector3<T>| a.dot(&(reading.centroid_covariance * b));
        let mixed = (spread(&first, &second) + spread(&second, &first)) * T::literal(0.5);
        // Nothing is known of the tangential force but that friction holds it: of a disc of radius μ N
        // the variance along each axis is (μ N/2)².
        let radius = reading.normal_force.abs().max(reading.normal_deviation) * friction;
        let weight = radius * T::literal(0.5);
        Ok(Self {
            origin: point,
            normal,
            tangents: [first, second],
            shift_covariance: Matrix2::new(spread(&first, &first), mixed, mixed, spread(&second, &second)),
            force: -normal * reading.normal_force,
            normal_variance: reading.normal_deviation * reading.normal_deviation,
            tangential_variance: weight * weight,
        })
    }

    /// On the surface, straight above or below a shift in the tangent plane.
    pub(super) fn state<S: ActiveSurface<T>>(
        &self,
        surface: &S,
        shift: Vector2<T>,
        force: Vector3<T>,
    ) -> Option<State<T>> {
        let above = self.origin + self.tangents[0] * shift.x + self.tangents[1] * shift.y;
        let (point, normal) = nearest(surface, &above, &self.normal)?;
        (normal.dot(&self.normal) > T::zero()).then_some(State { shift, force, point, normal })
    }

    /// How the normal at a state turns with each of the two shifts.
    pub(super) fn turning<S: ActiveSurface<T>>(&self, surface: &S, state: &State<T>) -> [Vector3<T>; 2] {
        // Far less than where the contact may be, far more than rounding.
        let spread = self.shift_covariance.diagonal().amax().root();
        let size = spread.max(state.point.amax() * T::EPSILON.root());
        let step = size * T::EPSILON.cube_root() * T::literal(16.0);
        self.moved_tangents(state).map(|moved| {
            let (ahead, behind) = (state.point + moved * step, state.point - moved * step);
            let change = (surface.normal(&ahead) - surface.normal(&behind)) / (step + step);
            if change.sum().is_number() { change } else { Vector3::zeros() }
        })
    }

    /// What its own reading asks of the force, if it is to be none: minus the slope of the prior.
    pub(super) fn asks_at_rest(&self) -> Vector3<T> {
        let along = self.normal * self.force.dot(&self.normal);
        along / self.normal_variance + (self.force - along) / self.tangential_variance
    }

    /// A light force on the side of a state's friction cone on which a slope gains most.
    pub(super) fn lightest_on(&self, state: &State<T>, asked: &Vector3<T>, friction: T) -> Vector3<T> {
        let slope = asked + self.asks_at_rest();
        let across = slope - state.normal * slope.dot(&state.normal);
        let direction = unit_or(&across, || self.tangents[0]);
        (direction * friction - state.normal) * (self.normal_variance.root() * T::literal(0.1))
    }

    /// Covariance of shift and force.
    pub(super) fn covariance(&self) -> Matrix5<T> {
        let along = self.normal * self.normal.transpose();
        let force = along * self.normal_variance + (Matrix3::identity() - along) * self.tangential_variance;
        let mut whole = Matrix5::zeros();
        whole.fixed_view_mut::<2, 2>(0, 0).copy_from(&self.shift_covariance);
        whole.fixed_view_mut::<3, 3>(2, 2).copy_from(&force);
        whole
    }

    /// A root of that covariance, which times its transpose is the covariance.
    pub(super) fn root(&self) -> Matrix5<T> {
        let [x, y, z] = [self.normal, self.tangents[0], self.tangents[1]];
        let (normal, tangential) = (self.normal_variance.root(), self.tangential_variance.root());
        let force = Matrix3::from_columns(&[x * normal, y * tangential, z * tangential]);
        let spread = &self.shift_covariance;
        let first = spread[(0, 0)].root();
        let mixed = if first > T::zero() { spread[(1, 0)] / first } else { T::zero() };
        let second = (spread[(1, 1)] - mixed * mixed).max(T::zero()).root();
        let mut whole = Matrix5::zeros();
        whole.fixed_view_mut::<2, 2>(0, 0).copy_from(&Matrix2::new(first, T::zero(), mixed, second));
        whole.fixed_view_mut::<3, 3>(2, 2).copy_from(&force);
        whole
    }

    /// Derivatives of the contact's wrench by shift and force.
    pub(super) fn jacobian(&self, state: &State<T>) -> Matrix6x5<T> {
        let mut jacobian = Matrix6x5::zeros();
        jacobian.fixed_view_mut::<3, 3>(0, 2).copy_from(&Matrix3::identity());
        jacobian.fixed_view_mut::<3, 3>(3, 2).copy_from(&state.point.cross_matrix());
        for (column, moved) in self.moved_tangents(state).iter().enumerate() {
            jacobian.fixed_view_mut::<3, 1>(3, column).copy_from(&moved.cross(&state.force));
        }
        jacobian
    }

    /// The two tangents of the prior, carried to a state's tangent plane: along the tangent, then along the
    /// prior's normal back onto the surface.
    pub(super) fn moved_tangents(&self, state: &State<T>) -> [Vector3<T>; 2] {
        let rise = T::one() / state.normal.dot(&self.normal);
        self.tangents.map(|tangent| tangent - self.normal * (state.normal.dot(&tangent) * rise))
    }
}

/// The point of the surface nearest to `point` along `direction`, with its normal.
fn nearest<T: Real, S: ActiveSurface<T>>(
    surface: &S,
    point: &Vector3<T>,
    direction: &Vector3<T>,
) -> Option<(Vector3<T>, Vector3<T>)> {
    let mut best: Option<(T, Vector3<T>, Vector3<T>)> = None;
    surface.crossings(&Line { point: *point, direction: *direction }, |crossing| {
        let distance = crossing.along.abs();
        if best.is_none_or(|(least, ..)| distance < least) {
            best = Some((distance, crossing.point, crossing.normal));
        }
    });
    best.map(|(_, point, normal)| (point, normal))
}

#[cfg(test)]
mod tests {
    use fingertip_surfaces::Ellipsoid;
    use nalgebra::{Matrix3, Vector2, Vector3, Vector6};

    use super::{ArrayContact, Prior};

    /// A place that is known exactly is a place; of a force something must be unknown.
    #[test]
    fn variances_may_be_zero_and_deviations_may_not() {
        let reading = ArrayContact {
            centroid: Vector3::new(0.0, 0.0, 0.010),
            centroid_covariance: Matrix3::zeros(),
            normal_force: 2.0,
            normal_deviation: 0.1,
        };
        assert!(reading.is_valid());
        for axis in 0..3 {
            let mut bad = reading;
            bad.centroid_covariance[(axis, axis)] = -1e-12;
            assert!(!bad.is_valid());
        }
        for normal_deviation in [0.0, -0.1, f64::NAN, f64::INFINITY] {
            assert!(!ArrayContact { normal_deviation, ..reading }.is_valid());
        }
        assert!(!ArrayContact { normal_force: f64::NAN, ..reading }.is_valid());
    }

    /// Far from the prior, where the surface has turned by a third of a radian: against central differences.
    #[test]
    fn the_jacobian_is_that_of_the_wrench_of_a_state() {
        let surface = Ellipsoid::new(Vector3::new(0.010, 0.013, 0.016)).unwrap();
        let normal = Vector3::new(0.3, -0.5, 0.8_f64).normalize();
        let reading = ArrayContact {
            centroid: normal * 0.012,
            centroid_covariance: Matrix3::identity() * 1e-8,
            normal_force: 2.0,
            normal_deviation: 0.1,
        };
        let prior = Prior::new(&surface, &reading, 0.5).unwrap();
        let wrench = |shift, force: Vector3<f64>| {
            let state = prior.state(&surface, shift, force).unwrap();
            let torque = state.point.cross(&force);
            Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z)
        };
        let (shift, force) = (Vector2::new(0.005, -0.004), Vector3::new(0.4, 0.9, -1.7));
        let state = prior.state(&surface, shift, force).unwrap();
        assert!(state.normal.dot(&prior.normal) < 0.95);
        let jacobian = prior.jacobian(&state);
        let moved = prior.moved_tangents(&state);
        let h = 1e-7;
        for (column, tangent) in moved.iter().enumerate() {
            let step = Vector2::ith(column, h);
            let slope = (wrench(shift + step, force) - wrench(shift - step, force)) / (h + h);
            assert!((slope - jacobian.column(column)).norm() < 1e-6, "{column}: {slope}");
            let at = |shift| prior.state(&surface, shift, force).unwrap().point;
            let way = (at(shift + step) - at(shift - step)) / (h + h);
            assert!((way - tangent).norm() < 1e-6 && way.dot(&state.normal).abs() < 1e-6, "{way}");
        }
        for column in 0..3 {
            let step = Vector3::ith(column, h);
            let slope = (wrench(shift, force + step) - wrench(shift, force - step)) / (h + h);
            assert!((slope - jacobian.column(column + 2)).norm() < 1e-6, "{column}: {slope}");
        }
    }
}
