//! The shape of a cylindrical fingertip from touches on its side.

use fingertip_surfaces::Cylinder;
use nalgebra::{DMatrix, Vector3};

use super::fitted::{check_widths, roots};
use super::torques::{Points, settle};
use super::touches::{directions, wrenches};
use super::{Fitted, GeometryError, ShapeTouch, WrenchNoise};
use crate::fit::FitError;
use crate::linear::{Singular, Unobserved};

/// The axis of a cylinder shows if the spread of the normals in their weaker direction is at least
/// this of that in their stronger one: a sector of about 10°.
const LEAST_SPREAD: f64 = 0.05;

/// Cylinder from touches on its side at known directions, nothing else being known: the axis is the
/// direction that the normals lie across (the right singular vector of their smallest singular value),
/// then radius and offset are those of [`fit_cylinder_along`] that axis.
///
/// Deviations: radius, the two of the offset across the axis \[m\], then the two tilts of the axis
/// \[rad\], about the directions of the second and the first singular vector. Not observable at all is
/// the position along the axis; `unobserved` says so.
///
/// # Errors
/// [`GeometryError`]; the axis is not observable where all normals are parallel, the radius not without
/// friction.
pub fn fit_cylinder(
    touches: &[ShapeTouch],
    noise: &WrenchNoise,
) -> Result<Fitted<Cylinder<f64>>, GeometryError> {
    let normals = directions(touches)?;
    let spread = DMatrix::from_fn(normals.len(), 3, |i, j| normals[i][j]);
    let singular = Singular::new(&spread).filter(|singular| singular.values.len() == 3);
    let Some(singular) = singular else {
        let samples = normals.len();
        return Err(FitError::TooFewSamples { samples, coefficients: 5 }.into());
    };
    if !(singular.values[1] > LEAST_SPREAD * singular.values[0]) {
        let directions = DMatrix::from_fn(3, 2, |i, j| singular.right[(i, 1 + j)]);
        let unobserved = Unobserved { regressors: 3, directions, names: Vec::new() };
        return Err(GeometryError::unobserved(unobserved, &["axis x", "axis y", "axis z"]));
    }
    let axis = Vector3::from_fn(|i, _| singular.right[(i, 2)]);
    let mut fitted = fit_cylinder_along(touches, &axis, noise)?;
    // What the normals leave along the axis is their error.
    let freedom = normals.len().saturating_sub(2).max(1) as f64;
    let error = singular.values[2] / freedom.sqrt();
    fitted.deviations.extend([error / singular.values[1], error / singular.values[0]]);
    Ok(fitted)
}

/// Cylinder with a known direction of its axis, from touches on its side at known directions: the
/// position of each touch along the axis is not needed. Deviations: radius, then the point of the axis
/// nearest to the origin along two directions across the axis.
///
/// In `m = (ρ n + a + s d) × f` the place s along the axis is where each touch fits best; the rest is linear in ρ
/// and `a`. The position along the axis is not observable; `unobserved` says so. Touches whose force is along the
/// axis tell nothing.
///
/// # Errors
/// [`GeometryError`]; the radius is not observable without friction.
pub fn fit_cylinder_along(
    touches: &[ShapeTouch],
    axis: &Vector3<f64>,
    noise: &WrenchNoise,
) -> Result<Fitted<Cylinder<f64>>, GeometryError> {
    let length = axis.norm();
    if !(length > 0.0 && length.is_finite()) {
        return Err(GeometryError::BadTouch { touch: 0, what: "the axis has no direction" });
    }
    let axis = axis / length;
    let across = match axis.iamin() {
        0 => Vector3::x(),
        1 => Vector3::y(),
        _ => Vector3::z(),
    };
    let first = axis.cross(&across).normalize();
    let second = axis.cross(&first);
    let radial: Vec<Vector3<f64>> =
        directions(touches)?.iter().map(|normal| normal - axis * normal.dot(&axis)).collect();
    let count = touches.len();
    // Radius, two of the offset; and the place of each touch along the axis.
    let start = (Vector3::zeros(), vec![0.0; count]);
    let points = |(p, along): &(Vector3<f64>, Vec<f64>)| Points {
        at: (radial.iter().zip(along))
            .map(|(radial, along)| radial * p[0] + first * p[1] + second * p[2] + axis * *along)
            .collect(),
        slopes: vec![radial.clone(), vec![first; count], vec![second; count]],
        free: Some(axis),
    };
    let names = ["radius", "axis offset 1", "axis offset 2"];
    let ((p, _), step) = settle(&wrenches(touches), noise, &names, start, points, |(p, along), step| {
        *p += step.change.fixed_rows::<3>(0);
        along.iter_mut().zip(&step.slide).for_each(|(along, slide)| *along += slide);
        step.change.amax() / p.norm().max(f64::MIN_POSITIVE)
    })?;
    let deviations = roots(&step.covariance(step.variance(), &names)?);
    check_widths(&step, &deviations, &names, &[p[0].abs(); 3])?;
    if p[0] < 0.0 {
        return Err(GeometryError::negative("radius", p[0]));
    }
    let shape = Cylinder::new(first * p[1] + second * p[2], axis, p[0])?;
    let unobserved = vec!["position along the axis".to_owned()];
    Ok(Fitted { unobserved, ..Fitted::of(shape, &step, deviations) })
}

#[cfg(test)]
mod tests {
    use super::{fit_cylinder, fit_cylinder_along};
    use crate::fit::testing::gaussian;
    use crate::geometry::{GeometryError, ShapeTouch, WrenchNoise};
    use crate::testing::Largest as _;
    use fingertip_wrench::Wrench;
    use nalgebra::Vector3;
    use rand::SeedableRng as _;
    use rand_pcg::Pcg64Mcg;

    fn vector(random: &mut Pcg64Mcg) -> Vector3<f64> {
        Vector3::from_fn(|_, _| gaussian(random))
    }

    /// Touches with friction on the side of a cylinder of 8 mm, and the point of its axis nearest to the
    /// origin.
    fn touches(random: &mut Pcg64Mcg, axis: Vector3<f64>, count: usize) -> (Vec<ShapeTouch>, Vector3<f64>) {
        let centre = vector(random) * 0.01;
        let base = centre - axis * centre.dot(&axis);
        let touches = (0..count)
            .map(|_| {
                let n = vector(random);
                let radial = (n - axis * n.dot(&axis)).normalize();
                let along = axis * (0.02 * gaussian(random));
                let slide = vector(random).cross(&radial).normalize();
                let force = (slide * 0.3 - radial) * (1.0 + gaussian(random).abs());
                ShapeTouch {
                    wrench: Wrench::from_force_at(&(base + radial * 0.008 + along), force),
                    normal: radial * 3.0,
                }
            })
            .collect();
        (touches, base)
    }

    #[test]
    fn shape_comes_back_with_and_without_its_axis() {
        let random = &mut Pcg64Mcg::seed_from_u64(11);
        for _ in 0..100 {
            let axis = vector(random).normalize();
            let (touches, base) = touches(random, axis, 15);
            for fitted in [
                fit_cylinder(&touches, &WrenchNoise::exact_forces()).unwrap(),
                fit_cylinder_along(&touches, &(axis * 2.0), &WrenchNoise::exact_forces()).unwrap(),
            ] {
                assert!((fitted.shape.radius() - 0.008).abs() < 1e-10);
                assert!((fitted.shape.centre() - base).largest() < 1e-10);
                assert!(fitted.shape.axis().cross(&axis).norm() < 1e-10);
                assert_eq!(fitted.unobserved, ["position along the axis"]);
            }
        }
    }

    #[test]
    fn an_axis_that_does_not_show_is_named() {
        let random = &mut Pcg64Mcg::seed_from_u64(12);
        let (mut touches, _) = touches(random, Vector3::z(), 15);
        for touch in &mut touches {
            touch.normal = Vector3::x();
        }
        let error = fit_cylinder(&touches, &WrenchNoise::exact_forces()).unwrap_err();
        assert!(error.to_string().contains("axis y") && error.to_string().contains("axis z"), "{error}");
        assert!(
            fit_cylinder(&touches[..2], &WrenchNoise::exact_forces()).is_err()
                && fit_cylinder(&[], &WrenchNoise::exact_forces()).is_err()
        );
        touches[4].normal.x = f64::NAN;
        assert!(matches!(
            fit_cylinder(&touches, &WrenchNoise::exact_forces()),
            Err(GeometryError::BadTouch { touch: 4, .. })
        ));
    }

    /// Torques that scatter: what is left of them is told as what scatters, less what the fit takes up. Each touch may
    /// slide along the axis, so that two of its three components count.
    #[test]
    fn what_is_left_is_told_as_the_noise_that_there_is() {
        let random = &mut Pcg64Mcg::seed_from_u64(14);
        let (axis, count, noise) = (vector(random).normalize(), 300, 2e-5);
        let (mut touches, _) = touches(random, axis, count);
        for touch in &mut touches {
            let torque = touch.wrench.torque() + vector(random) * noise;
            touch.wrench = Wrench::on_fingertip(touch.wrench.force(), torque);
        }
        let forces = WrenchNoise::new(1e-6, noise).unwrap();
        for stated in [WrenchNoise::exact_forces(), forces] {
            let fitted = fit_cylinder_along(&touches, &axis, &stated).unwrap();
            let components = 2.0 * count as f64;
            let expected = noise * ((components - 3.0) / components).sqrt();
            // The standard deviation of the ratio is 1/√(2·597), 2.9 %.
            assert!((fitted.rms / expected - 1.0).abs() < 0.12, "{} {expected}", fitted.rms);
            assert_eq!(fitted.freedom, components - 3.0);
        }
    }

    /// Normals that are known to 10 mrad: the tilt is as large as is said, within 5 %.
    #[test]
    fn tilt_is_as_uncertain_as_is_said() {
        let random = &mut Pcg64Mcg::seed_from_u64(13);
        let (clean, _) = touches(random, Vector3::z(), 20);
        let trials = 8000;
        let (mut found, mut stated) = (0.0, 0.0);
        for _ in 0..trials {
            let noisy: Vec<ShapeTouch> = clean
                .iter()
                .map(|touch| ShapeTouch {
                    normal: touch.normal.normalize() + vector(random) * 0.01,
                    ..*touch
                })
                .collect();
            let fitted = fit_cylinder(&noisy, &WrenchNoise::exact_forces()).unwrap();
            found += fitted.shape.axis().cross(&Vector3::z()).norm_squared() / f64::from(trials);
            stated += (fitted.deviations[3].powi(2) + fitted.deviations[4].powi(2)) / f64::from(trials);
        }
        assert!((found / stated - 1.0).abs() < 0.05, "{found:e} {stated:e}");
    }
}
