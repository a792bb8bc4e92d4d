//! The pose of a surface from touches at known points of it.

use fingertip_wrench::{RigidTransform, Wrench};
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::fitted::{check_widths, roots};
use super::torques::{Points, Step, step};
use super::touches::shifts;
use super::{Fitted, GeometryError, WrenchNoise};

/// Where a surface sits in the sensor frame, from touches at known points of the surface
/// (coordinates in its own frame): `min Σ |m − (Q y + t) × f|²` over rigid motions, weighted by the errors that
/// `noise` states (`docs/theory/calibration.md#the-shape-of-the-tip`).
///
/// Gauss-Newton with exact forces from the 24 rotations that map axes to axes; from the best, with the errors of
/// forces. Deviations: rotation about x, y, z of the sensor \[rad\], then the origin x, y, z \[m\]. Three touches
/// in general position are the least; four or more tell an error.
///
/// # Errors
/// [`GeometryError`]; directions of the pose that the touches do not show are named.
pub fn fit_pose(
    touches: &[(Wrench<f64>, Vector3<f64>)],
    noise: &WrenchNoise,
) -> Result<Fitted<RigidTransform<f64>>, GeometryError> {
    for (touch, (wrench, point)) in touches.iter().enumerate() {
        if !wrench.is_finite() || point.iter().any(|x| !x.is_finite()) {
            return Err(GeometryError::BadTouch { touch, what: "a number is not finite" });
        }
    }
    let exact = noise.without_forces();
    let mut best: Option<Solution> = None;
    let mut known: Vec<Matrix3<f64>> = Vec::new();
    let mut last = None;
    for start in axis_rotations() {
        match descend(touches, &exact, start, Vector3::zeros(), &known) {
            Ok(Some(solution)) => {
                known.push(solution.rotation);
                if best.as_ref().is_none_or(|other| solution.step.misfit < other.step.misfit) {
                    best = Some(solution);
                }
            }
            Ok(None) => {}
            Err(error) => last = Some(error),
        }
    }
    let Some(mut solution) = best else {
        return Err(last.unwrap_or(GeometryError::NoConvergence { iterations: MOST_ITERATIONS }));
    };
    if !noise.forces_are_exact() {
        let settled = descend(touches, noise, solution.rotation, solution.origin, &[])?;
        solution = settled.ok_or(GeometryError::NoConvergence { iterations: MOST_ITERATIONS })?;
    }
    let Solution { rotation, origin, step } = solution;
    let deviations = roots(&step.covariance(step.variance(), &NAMES)?);
    check_widths(&step, &deviations, &NAMES[..3], &[1.0; 3])?;
    let rotation = Rotation3::from_matrix_unchecked(rotation);
    Ok(Fitted::of(RigidTransform::from_parts(rotation, origin), &step, deviations))
}

const NAMES: [&str; 6] = ["turn about x", "turn about y", "turn about z", "shift x", "shift y", "shift z"];

struct Solution {
    rotation: Matrix3<f64>,
    origin: Vector3<f64>,
    step: Step,
}

const MOST_ITERATIONS: usize = 100;

/// The 24 rotations that take axes to axes.
fn axis_rotations() -> impl Iterator<Item = Matrix3<f64>> {
    let signed = |i: usize| Vector3::ith(i / 2, if i.is_multiple_of(2) { 1.0 } else { -1.0 });
    (0..6).flat_map(move |i| (0..6).filter(move |j| i / 2 != j / 2).map(move |j| (i, j))).map(
        move |(i, j)| {
            let (x, y) = (signed(i), signed(j));
            Matrix3::from_columns(&[x, y, x.cross(&y)])
        },
    )
}

/// So near to a solution \[rad\], the search ends there.
const SAME: f64 = 1e-4;

/// `None` if it comes to one of the known rotations.
fn descend(
    touches: &[(Wrench<f64>, Vector3<f64>)],
    noise: &WrenchNoise,
    start: Matrix3<f64>,
    mut origin: Vector3<f64>,
    known: &[Matrix3<f64>],
) -> Result<Option<Solution>, GeometryError> {
    let mut rotation = start;
    let wrenches: Vec<Wrench<f64>> = touches.iter().map(|(wrench, _)| *wrench).collect();
    let scale = touches.iter().map(|(_, y)| y.norm()).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let mut last = f64::INFINITY;
    for iteration in 0..MOST_ITERATIONS {
        let arms: Vec<Vector3<f64>> = touches.iter().map(|(_, point)| rotation * point).collect();
        // Turning by ω moves the point by ω × Qy.
        let turned = |axis: usize| arms.iter().map(|arm| Vector3::ith(axis, 1.0).cross(arm)).collect();
        let points = Points {
            at: arms.iter().map(|arm| arm + origin).collect(),
            slopes: (0..3).map(turned).chain(shifts(arms.len())).collect(),
            free: None,
        };
        let step = step(&wrenches, &points, noise, &NAMES)?;
        let turn: Vector3<f64> = step.change.fixed_rows::<3>(0).into_owned();
        let shift: Vector3<f64> = step.change.fixed_rows::<3>(3).into_owned();
        // A turn of more than a radian is out of the reach of the linearisation.
        let damp = (1.0 / turn.norm().max(f64::MIN_POSITIVE)).min(1.0);
        rotation = Rotation3::from_scaled_axis(turn * damp).into_inner() * rotation;
        origin += shift * damp;
        let size = turn.norm().max(shift.norm() / scale);
        // Steps that are small and no longer shrink are rounding.
        let stalled = size < 1e-9 && size > 0.1 * last;
        last = size;
        if iteration > 0 && (size < 1e-13 || stalled) {
            return Ok(Some(Solution { rotation, origin, step }));
        }
        if known.iter().any(|other| (other - rotation).amax() < SAME) {
            return Ok(None);
        }
    }
    Err(GeometryError::NoConvergence { iterations: MOST_ITERATIONS })
}

#[cfg(test)]
mod tests {
    use super::fit_pose;
    use crate::fit::testing::gaussian;
    use crate::geometry::{GeometryError, WrenchNoise};
    use crate::testing::Largest as _;
    use fingertip_wrench::Wrench;
    use nalgebra::{Rotation3, Vector3};
    use rand::SeedableRng as _;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn pose_comes_back() {
        let random = &mut Pcg64Mcg::seed_from_u64(3);
        for _ in 0..60 {
            let mut vector = || Vector3::from_fn(|_, _| gaussian(random));
            let rotation = Rotation3::from_scaled_axis(vector().normalize() * 2.5);
            let origin = vector() * 0.01;
            let touches: Vec<_> = (0..8)
                .map(|_| {
                    let y = vector() * 0.02;
                    (Wrench::from_force_at(&(rotation * y + origin), vector()), y)
                })
                .collect();
            let fit = fit_pose(&touches, &WrenchNoise::exact_forces()).unwrap();
            assert!((fit.shape.rotation() - rotation.matrix()).largest() < 1e-9, "{}", fit.rms);
            assert!((fit.shape.origin() - origin).largest() < 1e-10);
        }
    }

    #[test]
    fn touches_at_one_point_leave_the_rotation_open() {
        let random = &mut Pcg64Mcg::seed_from_u64(3);
        let point = Vector3::new(0.01, 0.0, 0.0);
        let touches: Vec<_> = (0..8)
            .map(|_| (Wrench::from_force_at(&point, Vector3::from_fn(|_, _| gaussian(random))), point))
            .collect();
        assert!(matches!(
            fit_pose(&touches, &WrenchNoise::exact_forces()),
            Err(GeometryError::Undetermined { .. } | GeometryError::NoConvergence { .. })
        ));
    }
}
