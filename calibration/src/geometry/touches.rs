//! Touches, and the sphere that they tell of.

use fingertip_surfaces::Sphere;
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use super::fitted::{check_widths, roots};
use super::torques::{Points, Step, settle};
use super::{Fitted, GeometryError, WrenchNoise};

/// A touch: what the sensor said, and the outward normal of the fingertip where it was touched, in
/// the sensor frame (known from how the fingertip was pressed on a plane, say).
///
/// ```
/// use fingertip_calibration::geometry::{ShapeTouch, WrenchNoise, fit_sphere};
/// use fingertip_calibration::nalgebra::Vector3;
/// use fingertip_wrench::Wrench;
///
/// // A tip of 12 mm is pressed with 2 N and rubbed with 0.5 N where it looks up, to the right, and so on.
/// let normals = [Vector3::x(), Vector3::y(), Vector3::z(), -Vector3::x(), -Vector3::y()];
/// let touches = normals.map(|normal| {
///     let aside = normal.yzx() * 0.5;
///     ShapeTouch { wrench: Wrench::from_force_at(&(normal * 0.012), aside - normal * 2.0), normal }
/// });
/// let sphere = fit_sphere(&touches, &WrenchNoise::exact_forces())?.shape;
/// assert!((sphere.radius() - 0.012).abs() < 1e-9);
/// # Ok::<(), fingertip_calibration::geometry::GeometryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeTouch {
    /// Load on the fingertip.
    pub wrench: Wrench<f64>,
    /// Outward normal at the touched point; any length. It is taken as exact.
    pub normal: Vector3<f64>,
}

pub(super) fn directions(touches: &[ShapeTouch]) -> Result<Vec<Vector3<f64>>, GeometryError> {
    touches
        .iter()
        .enumerate()
        .map(|(touch, t)| {
            if !t.wrench.is_finite() {
                return Err(GeometryError::BadTouch { touch, what: "the wrench is not finite" });
            }
            let norm = t.normal.norm();
            if norm > 0.0 && norm.is_finite() {
                Ok(t.normal / norm)
            } else {
                Err(GeometryError::BadTouch { touch, what: "the normal has no direction" })
            }
        })
        .collect()
}

pub(super) fn wrenches(touches: &[ShapeTouch]) -> Vec<Wrench<f64>> {
    touches.iter().map(|touch| touch.wrench).collect()
}

/// Columns of points that move along the axes of the sensor.
pub(super) fn shifts(count: usize) -> impl Iterator<Item = Vec<Vector3<f64>>> {
    (0..3).map(move |axis| vec![Vector3::ith(axis, 1.0); count])
}

/// Radius and centre \[m\] by the torques, and the last step towards them.
pub(super) fn radius_and_centre(
    wrenches: &[Wrench<f64>],
    normals: &[Vector3<f64>],
    noise: &WrenchNoise,
) -> Result<(f64, Vector3<f64>, Step), GeometryError> {
    let points = |(radius, centre): &(f64, Vector3<f64>)| Points {
        at: normals.iter().map(|n| n * *radius + centre).collect(),
        slopes: core::iter::once(normals.to_vec()).chain(shifts(normals.len())).collect(),
        free: None,
    };
    let start = (0.0, Vector3::zeros());
    let ((radius, centre), step) =
        settle(wrenches, noise, &SPHERE, start, points, |(radius, centre), step| {
            *radius += step.change[0];
            *centre += step.change.fixed_rows::<3>(1);
            step.change.amax() / (radius.abs() + centre.norm()).max(f64::MIN_POSITIVE)
        })?;
    Ok((radius, centre, step))
}

const SPHERE: [&str; 4] = ["radius", "centre x", "centre y", "centre z"];

/// Sphere from touches at known directions: `m = ρ n × f + t × f`, linear in radius ρ and centre t
/// (`docs/theory/calibration.md#the-shape-of-the-tip`), forces and torques having the errors that `noise` states.
/// Deviations: radius, centre x, y, z.
///
/// The touches need friction: where all forces point along the normals, every line of action passes
/// through the centre and the radius is not observable; the error says so.
///
/// # Errors
/// [`GeometryError`]; [`GeometryError::Undetermined`] also where an interval of 95 % is wider than the radius.
pub fn fit_sphere(touches: &[ShapeTouch], noise: &WrenchNoise) -> Result<Fitted<Sphere<f64>>, GeometryError> {
    let normals = directions(touches)?;
    let (radius, centre, step) = radius_and_centre(&wrenches(touches), &normals, noise)?;
    let deviations = roots(&step.covariance(step.variance(), &SPHERE)?);
    check_widths(&step, &deviations, &SPHERE, &[radius.abs(); 4])?;
    if radius < 0.0 {
        return Err(GeometryError::negative("radius", radius));
    }
    Ok(Fitted::of(Sphere::new(centre, radius)?, &step, deviations))
}

/// What touches at unknown places say of a sphere's radius: with friction coefficient at most `friction`,
/// `R ≥ greatest distance of a line of action from the centre / sin(atan μ)`
/// (`docs/theory/calibration.md#the-shape-of-the-tip`). `None` for a friction that is not positive or a
/// wrench without line of action.
#[must_use]
pub fn least_radius(centre: &Vector3<f64>, wrenches: &[Wrench<f64>], friction: f64) -> Option<f64> {
    let mut greatest = 0.0_f64;
    for wrench in wrenches {
        let force = wrench.force();
        let distance = force.cross(&wrench.torque_about(centre)).norm() / force.norm_squared();
        if !distance.is_finite() {
            return None;
        }
        greatest = greatest.max(distance);
    }
    (friction > 0.0).then(|| greatest / friction.atan().sin())
}

#[cfg(test)]
mod tests {
    use super::{fit_sphere, least_radius};
    use crate::fit::FitError;
    use crate::fit::testing::gaussian;
    use crate::geometry::{GeometryError, ShapeTouch, WrenchNoise, fit_meeting_point, fit_plane};
    use crate::testing::Largest as _;
    use fingertip_wrench::Wrench;
    use nalgebra::Vector3;
    use proptest::prelude::*;
    use rand::SeedableRng as _;
    use rand_pcg::Pcg64Mcg;

    fn vector(random: &mut Pcg64Mcg) -> Vector3<f64> {
        Vector3::from_fn(|_, _| gaussian(random))
    }

    /// Pressing with friction at a point.
    fn touch(random: &mut Pcg64Mcg, point: Vector3<f64>, normal: Vector3<f64>, friction: f64) -> ShapeTouch {
        let slide = vector(random).cross(&normal).normalize();
        let force = (slide * friction - normal) * (1.0 + gaussian(random).abs());
        ShapeTouch { wrench: Wrench::from_force_at(&point, force), normal: normal * 3.0 }
    }

    proptest! {
        #[test]
        fn shapes_come_back(seed in any::<u64>()) {
            let random = &mut Pcg64Mcg::seed_from_u64(seed);
            let centre = vector(random) * 0.01;
            let normals: Vec<_> = (0..15).map(|_| vector(random).normalize()).collect();
            let touches: Vec<_> =
                normals.iter().map(|n| touch(random, centre + n * 0.013, *n, 0.4)).collect();
            let sphere = fit_sphere(&touches, &WrenchNoise::exact_forces()).unwrap();
            prop_assert!((sphere.shape.radius() - 0.013).abs() < 1e-12);
            prop_assert!((sphere.shape.centre() - centre).largest() < 1e-12);
            let wrenches: Vec<_> = touches.iter().map(|touch| touch.wrench).collect();
            // All touches have friction 0.4, so the bound is sharp.
            prop_assert!((least_radius(&centre, &wrenches, 0.4).unwrap() - 0.013).abs() < 1e-12);
            // Without friction, or with one that is no number, nothing is said.
            for friction in [0.0, -0.4, f64::NAN] {
                prop_assert_eq!(least_radius(&centre, &wrenches, friction), None);
            }
        }

        #[test]
        fn pivots_and_planes(seed in any::<u64>()) {
            let random = &mut Pcg64Mcg::seed_from_u64(seed);
            let normal = vector(random).normalize();
            let pivots: Vec<Vec<_>> = (0..5)
                .map(|_| {
                    let point = normal * 0.01 + vector(random).cross(&normal) * 0.005;
                    (0..5).map(|_| touch(random, point, normal, 0.4).wrench).collect()
                })
                .collect();
            let plane = fit_plane(&pivots, &normal, &WrenchNoise::exact_forces()).unwrap();
            prop_assert!((plane.shape.offset - 0.01).abs() < 1e-10 && (plane.shape.normal - normal).largest() < 1e-8);
        }
    }

    #[test]
    fn what_cannot_be_observed_is_said() {
        let random = &mut Pcg64Mcg::seed_from_u64(1);
        let centre = Vector3::new(0.001, 0.002, 0.003);
        let frictionless: Vec<_> = (0..20)
            .map(|_| {
                let n = vector(random).normalize();
                ShapeTouch { wrench: Wrench::from_force_at(&(centre + n * 0.013), -n), normal: n }
            })
            .collect();
        let error = fit_sphere(&frictionless, &WrenchNoise::exact_forces()).unwrap_err();
        assert!(error.to_string().contains("do not determine radius: "), "{error}");
        // But the centre is.
        let wrenches: Vec<_> = frictionless.iter().map(|touch| touch.wrench).collect();
        assert!(
            (fit_meeting_point(&wrenches, &WrenchNoise::exact_forces()).unwrap().shape - centre).largest()
                < 1e-12
        );
        let parallel = vec![wrenches[0]; 5];
        assert!(matches!(
            fit_meeting_point(&parallel, &WrenchNoise::exact_forces()),
            Err(GeometryError::Undetermined { .. })
        ));
        let mut bad = frictionless;
        bad[3].normal = Vector3::zeros();
        assert!(matches!(
            fit_sphere(&bad, &WrenchNoise::exact_forces()),
            Err(GeometryError::BadTouch { touch: 3, .. })
        ));
    }

    #[test]
    fn a_plane_takes_three_pivots_that_are_not_in_a_line() {
        let random = &mut Pcg64Mcg::seed_from_u64(7);
        let mut pivot = |x: f64, y: f64| -> Vec<Wrench<f64>> {
            (0..5).map(|_| touch(random, Vector3::new(x, y, 0.01), Vector3::z(), 0.4).wrench).collect()
        };
        let [a, b, c] = [pivot(0.0, 0.0), pivot(0.01, 0.0), pivot(0.0, 0.01)];
        let plane = |pivots: &[&Vec<Wrench<f64>>]| {
            fit_plane(
                &pivots.iter().map(|pivot| (*pivot).clone()).collect::<Vec<_>>(),
                &Vector3::z(),
                &WrenchNoise::exact_forces(),
            )
        };
        assert!((plane(&[&a, &b, &c]).unwrap().shape.offset - 0.01).abs() < 1e-9);
        assert_eq!(
            plane(&[&a, &b]).unwrap_err(),
            FitError::TooFewSamples { samples: 2, coefficients: 3 }.into()
        );
        for in_a_line in [[&a, &b, &a], [&a, &a, &a]] {
            assert!(
                matches!(plane(&in_a_line), Err(GeometryError::BadTouch { what, .. }) if what.contains("line"))
            );
        }
        // The side is that of `outward`.
        let below = fit_plane(&[a, b, c], &-Vector3::z(), &WrenchNoise::exact_forces()).unwrap().shape;
        assert!((below.normal.z + 1.0).abs() < 1e-9 && (below.offset + 0.01).abs() < 1e-9);
    }
}
