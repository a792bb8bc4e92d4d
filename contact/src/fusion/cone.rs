//! Friction cones as constraints of an estimate.

use fingertip_surfaces::ActiveSurface;
use fingertip_surfaces::numeric::vectors::length;
use fingertip_wrench::Real;
use nalgebra::{Matrix4, Vector3, Vector4, Vector5};

use super::prior::{Prior, State};

/// Where in its friction cone a force lies.
///
/// ```
/// use fingertip_contact::{ArrayContact, Fusion, Grip};
/// use fingertip_surfaces::Plane;
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix3, Matrix6, Vector3};
///
/// let pad = Plane::new(Vector3::zeros(), Vector3::z())?;
/// let reading = ArrayContact {
///     centroid: Vector3::zeros(),
///     centroid_covariance: Matrix3::identity() * 1e-8,
///     normal_force: 1.0,
///     normal_deviation: 0.1,
/// };
/// let sensor = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// let fusion = Fusion::new(sensor, 0.5)?;
/// // Friction of 0.5 holds 0.2 N aside under 1 N; 0.8 N it does not.
/// for (newtons_aside, grip) in [(0.2, Grip::Sticks), (0.8, Grip::Slides)] {
///     let wrench = Wrench::on_fingertip(Vector3::new(newtons_aside, 0.0, -1.0), Vector3::zeros());
///     assert_eq!(fusion.estimate(&pad, &wrench, &[reading])?.contacts[0].grip, grip);
/// }
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[repr(u8)]
pub enum Grip {
    /// Inside: the constraint does not matter.
    Sticks,
    /// On the cone: the measurements ask for as much tangential force as friction can hold, or more.
    Slides,
    /// At the tip: the measurements ask for no force, or for one that pulls.
    Lifted,
}

/// How a contact is held while the estimate is sought.
#[derive(Clone, Copy)]
pub(super) struct Held<T: Real> {
    pub(super) kind: Grip,
    /// By how much the cone's curvature adds to the second derivative of the cost across the force:
    /// multiplier over tangential force.
    pub(super) bend: T,
}

impl<T: Real> Held<T> {
    pub(super) fn free() -> Self {
        Self { kind: Grip::Sticks, bend: T::zero() }
    }

    /// After a step that gave this state with this multiplier of its wall. `asked` is the slope of the
    /// other parts of the cost, as a force that would be gained.
    pub(super) fn after(
        before: &Self,
        asked: &Vector3<T>,
        prior: &Prior<T>,
        state: &State<T>,
        multiplier: T,
        friction: T,
    ) -> Self {
        let split = |v: &Vector3<T>| {
            let pressing = -v.dot(&state.normal);
            (pressing, length(&(v + state.normal * pressing)))
        };
        if before.kind == Grip::Lifted {
            // It stays so if nothing in the cone gains: the slope lies in the polar cone.
            let (pressing, tangential) = split(&(asked + prior.asks_at_rest()));
            let released = Self { kind: Grip::Slides, bend: T::zero() };
            return if friction * tangential + pressing <= T::zero() { *before } else { released };
        }
        let (pressing, tangential) = split(&state.force);
        if friction * tangential + pressing <= T::zero() {
            return Self { kind: Grip::Lifted, bend: T::zero() };
        }
        let outside = tangential > friction * pressing;
        if outside || multiplier > T::zero() {
            let bend = multiplier / tangential;
            let bend = if bend.is_number() && bend > T::zero() { bend } else { T::zero() };
            return Self { kind: Grip::Slides, bend };
        }
        Self::free()
    }
}

/// The half-space that touches a contact's friction cone along the present force: `row·x ≤ level` for
/// shift and force `x`.
#[derive(Clone, Copy)]
pub(super) struct Wall<T: Real> {
    pub(super) exists: bool,
    pub(super) row: Vector5<T>,
    pub(super) level: T,
    /// Across force and normal.
    pub(super) lateral: Vector5<T>,
}

impl<T: Real> Wall<T> {
    pub(super) fn none() -> Self {
        Self { exists: false, row: Vector5::zeros(), level: T::zero(), lateral: Vector5::zeros() }
    }

    /// `g = |F_t| − μ N ≤ 0` with `∂g/∂F = t + μ n`, and as the normal turns with the shift,
    /// `dg = (N t + μ F)·dn`.
    pub(super) fn new<S: ActiveSurface<T>>(
        prior: &Prior<T>,
        surface: &S,
        state: &State<T>,
        friction: T,
    ) -> Self {
        let n = state.normal;
        let pressing = -state.force.dot(&n);
        let tangential = state.force + n * pressing;
        let magnitude = length(&tangential);
        let direction = tangential / magnitude;
        // Deep inside the cone its direction is noise, and it does not matter.
        if !(magnitude > friction * pressing.abs() * T::literal(1e-3)) || !direction.sum().is_number() {
            return Self::none();
        }
        let by_force = direction + n * friction;
        let by_turning = direction * pressing + state.force * friction;
        let [s1, s2] = prior.turning(surface, state).map(|turned| by_turning.dot(&turned));
        let lateral = n.cross(&direction);
        Self {
            exists: true,
            row: Vector5::new(s1, s2, by_force.x, by_force.y, by_force.z),
            level: s1 * state.shift.x + s2 * state.shift.y,
            lateral: Vector5::new(T::zero(), T::zero(), lateral.x, lateral.y, lateral.z),
        }
    }
}

/// The point of the friction cone at a state that is nearest to its force
/// (`docs/theory/friction.md#cone-over-a-norm`).
pub(super) fn project<T: Real>(state: &State<T>, friction: T, kind: Grip) -> Vector3<T> {
    let pressing = -state.force.dot(&state.normal);
    let tangential = state.force + state.normal * pressing;
    let magnitude = length(&tangential);
    if kind == Grip::Lifted || friction * magnitude <= -pressing {
        return Vector3::zeros();
    }
    if magnitude <= friction * pressing {
        return state.force;
    }
    let normal = (friction * magnitude + pressing) / (T::one() + friction * friction);
    tangential * (friction * normal / magnitude) - state.normal * normal
}

/// The multipliers `λ ≥ 0` of the quadratic program with the dual `½ λᵀQλ − bᵀλ`: of the sixteen sets
/// of constraints that may be active, the one with `λ ≥ 0` on it and `b − Qλ ≤ 0` off it. Where
/// rounding leaves none, the set that violates this least.
pub(super) fn cone_multipliers<T: Real>(
    matrix: &Matrix4<T>,
    beyond: &Vector4<T>,
    exists: &[bool],
) -> Vector4<T> {
    let mut best = (T::GREATEST, Vector4::zeros());
    for set in 0..1_u8 << exists.len().min(4) {
        let active = |i: usize| set >> i & 1 == 1;
        if exists.iter().enumerate().any(|(i, exists)| active(i) && !exists) {
            continue;
        }
        let (mut reduced, mut right) = (Matrix4::identity(), Vector4::zeros());
        for i in 0..4 {
            for j in 0..4 {
                if active(i) && active(j) {
                    reduced[(i, j)] = matrix[(i, j)];
                }
            }
            if active(i) {
                right[i] = beyond[i];
            }
        }
        let Some(factors) = reduced.cholesky() else { continue };
        let multipliers = factors.solve(&right);
        let left = beyond - matrix * multipliers;
        let mut violation = T::zero();
        for (i, exists) in exists.iter().enumerate() {
            if active(i) {
                violation = violation.max(-multipliers[i] * matrix[(i, i)]);
            } else if *exists {
                violation = violation.max(left[i]);
            }
        }
        if violation < best.0 {
            best = (violation, multipliers);
        }
        if !(violation > T::zero()) {
            break;
        }
    }
    best.1.map(|x| x.max(T::zero()))
}

#[cfg(test)]
mod tests {
    use nalgebra::{Vector2, Vector3};
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::{Grip, State, project};

    /// The nearest point of a cone: what is left is across the projection, and in the polar cone.
    #[test]
    fn a_projection_is_the_nearest_point_of_the_cone() {
        let mut random = Pcg64Mcg::seed_from_u64(51);
        let mut kinds = [0; 3];
        for _ in 0..2000 {
            let friction: f64 = random.random_range(0.05..2.0);
            let normal = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize();
            let force: Vector3<f64> =
                Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)) * random.random_range(0.01..50.0);
            let state = State { shift: Vector2::zeros(), force, point: Vector3::zeros(), normal };
            let found = project(&state, friction, Grip::Slides);
            let left = force - found;
            let size = force.norm();
            let parts = |v: &Vector3<f64>| (-v.dot(&normal), (v - normal * v.dot(&normal)).norm());
            let (pressing, tangential) = parts(&found);
            assert!(pressing >= 0.0 && tangential <= friction * pressing + 1e-14 * size);
            let (asks, aside) = parts(&left);
            assert!(friction * aside + asks <= 1e-13 * size, "{force} {found}");
            assert!(left.dot(&found).abs() <= 1e-13 * size * size, "{force} {found}");
            kinds[if found == force { 0 } else { 1 + usize::from(pressing.abs() <= 0.0) }] += 1;
            assert_eq!(project(&state, friction, Grip::Lifted), Vector3::zeros());
        }
        assert!(kinds.iter().all(|&count| count > 100), "{kinds:?}");
    }
}
