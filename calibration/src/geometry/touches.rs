//! The shape of a fingertip from touches at known directions.

use fingertip_surfaces::{BadShape, Sphere};
use fingertip_wrench::Wrench;
use nalgebra::{DMatrix, DVector, Vector3};
use statrs::distribution::{ContinuousCDF as _, FisherSnedecor};
use thiserror::Error;

use crate::fit::{Fit, FitError, least_squares};
use crate::linear::Triangular;

/// A touch: what the sensor said, and the outward normal of the fingertip where it was touched, in
/// the sensor frame (known from how the fingertip was pressed on a plane, say).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Load on the fingertip.
    pub wrench: Wrench<f64>,
    /// Outward normal at the touched point; any length.
    pub normal: Vector3<f64>,
}

/// Why touches tell no shape.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// The touches do not determine the shape: the error says which part of it.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// What was fitted is no shape.
    #[error("the touches give no shape: {0}")]
    BadShape(#[from] BadShape),
    /// A normal or axis has no direction, or a number is not finite.
    #[error("touch {touch}: {what}")]
    BadTouch {
        /// Which touch, from 0.
        touch: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// The search for the shape did not come to rest.
    #[error("no convergence after {iterations} iterations")]
    NoConvergence {
        /// How many were made.
        iterations: usize,
    },
}

/// A fitted shape, and how sure it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted<S> {
    /// The shape.
    pub shape: S,
    /// Standard deviation of each parameter \[m\], in the order that the function tells.
    pub deviations: Vec<f64>,
    /// RMS of the torque that is left \[N·m\].
    pub rms: f64,
    /// What the touches cannot tell of the shape, in words; empty if they tell everything.
    pub unobserved: Vec<String>,
}

pub(super) fn directions(touches: &[Touch]) -> Result<Vec<Vector3<f64>>, GeometryError> {
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

/// Least squares of `m = Σ parameter · column × f`, three rows a touch; unobserved parameters by name.
pub(super) fn torque_fit(
    touches: &[Touch],
    columns: &[Vec<Vector3<f64>>],
    names: &[&str],
) -> Result<(DVector<f64>, Vec<f64>, f64, Fit), GeometryError> {
    let mut design = DMatrix::zeros(3 * touches.len(), columns.len());
    let mut torque = DMatrix::zeros(3 * touches.len(), 1);
    for (i, touch) in touches.iter().enumerate() {
        for (j, column) in columns.iter().enumerate() {
            design.view_mut((3 * i, j), (3, 1)).copy_from(&column[i].cross(&touch.wrench.force()));
        }
        torque.view_mut((3 * i, 0), (3, 1)).copy_from(&touch.wrench.torque());
    }
    for (j, column) in columns.iter().enumerate() {
        let sizes = column
            .iter()
            .zip(touches)
            .map(|(c, touch)| c.norm_squared() * touch.wrench.force().norm_squared());
        drop_rounding(&mut design, j, sizes.sum::<f64>().sqrt());
    }
    let fit = least_squares(&design, &torque, None).map_err(|error| named(error, names))?;
    let variance = fit.residual_covariance[(0, 0)];
    let deviations = fit.inverse_gram.diagonal().iter().map(|g| (g * variance).max(0.0).sqrt()).collect();
    let left = torque - design * &fit.coefficients;
    let rms = (left.norm_squared() / left.len().max(1) as f64).sqrt();
    Ok((fit.coefficients.column(0).into_owned(), deviations, rms, fit))
}

/// A column that is nothing but rounding observes nothing: it becomes zero.
pub(super) fn drop_rounding(design: &mut DMatrix<f64>, column: usize, size: f64) {
    if design.column(column).norm() <= 64.0 * f64::EPSILON * size {
        design.column_mut(column).fill(0.0);
    }
}

pub(super) fn named(error: FitError, names: &[&str]) -> FitError {
    let FitError::Unobserved(mut unobserved) = error else { return error };
    unobserved.names = names.iter().map(|name| (*name).to_owned()).collect();
    FitError::Unobserved(unobserved)
}

/// Sphere from touches at known directions: `m = ρ n × f + t × f`, linear in radius ρ and centre t
/// (`docs/theory/calibration.md#the-shape-of-the-tip`). Deviations: radius, centre x, y, z.
///
/// The touches need friction: where all forces point along the normals, every line of action passes
/// through the centre and the radius is not observable; the error says so.
///
/// # Errors
/// [`GeometryError`].
pub fn fit_sphere(touches: &[Touch]) -> Result<Fitted<Sphere<f64>>, GeometryError> {
    let normals = directions(touches)?;
    let constant = |axis: usize| vec![Vector3::ith(axis, 1.0); touches.len()];
    let columns = [normals, constant(0), constant(1), constant(2)];
    let names = ["radius", "centre x", "centre y", "centre z"];
    let (p, deviations, rms, _) = torque_fit(touches, &columns, &names)?;
    let shape = Sphere::new(Vector3::new(p[1], p[2], p[3]), p[0])?;
    Ok(Fitted { shape, deviations, rms, unobserved: Vec::new() })
}

/// The point through which the lines of action of all wrenches pass: a pivot on which the fingertip was held
/// still while the force turned, or the centre of a sphere touched without friction. Deviations: x, y, z.
///
/// # Errors
/// [`GeometryError`]: at least two forces that are not parallel are needed, with four equations to spare.
pub fn fit_meeting_point(wrenches: &[Wrench<f64>]) -> Result<Fitted<Vector3<f64>>, GeometryError> {
    meeting_point(wrenches).map(|(fitted, _)| fitted)
}

/// The point, and the regression behind it.
fn meeting_point(wrenches: &[Wrench<f64>]) -> Result<(Fitted<Vector3<f64>>, Fit), GeometryError> {
    let touches: Vec<Touch> =
        wrenches.iter().map(|wrench| Touch { wrench: *wrench, normal: Vector3::z() }).collect();
    directions(&touches)?;
    let columns: Vec<_> = (0..3).map(|axis| vec![Vector3::ith(axis, 1.0); touches.len()]).collect();
    let (p, deviations, rms, fit) = torque_fit(&touches, &columns, &["point x", "point y", "point z"])?;
    let shape = Vector3::new(p[0], p[1], p[2]);
    Ok((Fitted { shape, deviations, rms, unobserved: Vec::new() }, fit))
}

/// A plane `normal · x = offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneParameters {
    /// Unit normal.
    pub normal: Vector3<f64>,
    /// Distance from the origin along the normal \[m\].
    pub offset: f64,
}

/// The plane of a flat fingertip from pivots: at each of three or more points of it, the force was turned
/// while the contact held still. A single wrench tells nothing of the offset, since its line of action
/// crosses every plane. `outward` tells the side.
///
/// Deviations: offset \[m\], then the tilts of the normal \[rad\] along the two principal directions of the
/// points in the plane, the longer first. They carry over what is uncertain of the pivots, so that three
/// points, which leave nothing, have an error too. The noise of the torques is taken to be the same at all
/// pivots; where the points lie off the plane by more than it allows (one chance in a thousand), the
/// deviations grow by as much.
///
/// # Errors
/// [`GeometryError`]; the points must not lie on a line.
pub fn fit_plane(
    pivots: &[Vec<Wrench<f64>>],
    outward: &Vector3<f64>,
) -> Result<Fitted<PlaneParameters>, GeometryError> {
    let found = pivots.iter().map(|wrenches| meeting_point(wrenches)).collect::<Result<Vec<_>, _>>()?;
    let points: Vec<Vector3<f64>> = found.iter().map(|(fitted, _)| fitted.shape).collect();
    if points.len() < 3 {
        return Err(FitError::TooFewSamples { samples: points.len(), coefficients: 3 }.into());
    }
    let count = points.len() as f64;
    let mean = points.iter().sum::<Vector3<f64>>() / count;
    let spread = DMatrix::from_fn(points.len(), 3, |i, j| points[i][j] - mean[j]);
    let singular = crate::linear::Singular::new(&spread).ok_or(FitError::BadInput { what: "the pivots" })?;
    if !(singular.values[1] > 1e-3 * singular.values[0]) {
        return Err(GeometryError::BadTouch { touch: 0, what: "the pivots lie on a line" });
    }
    let axis = |k: usize| Vector3::from_fn(|i, _| singular.right[(i, k)]);
    let (first, second) = (axis(0), axis(1));
    let normal = first.cross(&second);
    // The heights over this plane, weighted by how well each is known, make it a better one.
    let mut plane = Triangular::new(3, 1);
    for (point, (_, fit)) in points.iter().zip(&found) {
        let from = point - mean;
        let across = DMatrix::from_column_slice(3, 1, normal.as_slice());
        let variance = (across.transpose() * &fit.inverse_gram * &across)[(0, 0)];
        plane.push_weighted(
            &[1.0, first.dot(&from), second.dot(&from)],
            &[normal.dot(&from)],
            1.0 / variance.max(f64::MIN_POSITIVE),
        );
    }
    let factors = plane.factors();
    let better = factors.coefficients().map_err(FitError::from)?;
    let gram = factors.inverse_gram().map_err(FitError::from)?;
    let point = mean + normal * better[0];
    let normal = (normal - first * better[1] - second * better[2]).normalize();
    let normal = if normal.dot(outward) < 0.0 { -normal } else { normal };
    let freedom = count - 3.0;
    let rest: f64 = pivots.iter().map(|wrenches| 3.0 * wrenches.len() as f64 - 3.0).sum();
    let squares = |(wrenches, (_, fit)): (&Vec<Wrench<f64>>, &(_, Fit))| {
        (3.0 * wrenches.len() as f64 - 3.0) * fit.residual_covariance[(0, 0)]
    };
    let noise = pivots.iter().zip(&found).map(squares).sum::<f64>() / rest;
    let ratio = factors.residual[(0, 0)].powi(2) / (freedom * noise);
    let inconsistent = freedom > 0.0
        && ratio.is_finite()
        && FisherSnedecor::new(freedom, rest).is_ok_and(|expected| expected.sf(ratio) < 1e-3);
    let variance = if inconsistent { noise * ratio } else { noise };
    // A tilt turns the plane about the mean of the points, which moves its foot by where that lies.
    let foot = DMatrix::from_column_slice(3, 1, &[1.0, -first.dot(&mean), -second.dot(&mean)]);
    let offset_variance = (foot.transpose() * &gram * &foot)[(0, 0)];
    let variances = [offset_variance, gram[(1, 1)], gram[(2, 2)]];
    Ok(Fitted {
        shape: PlaneParameters { normal, offset: normal.dot(&point) },
        deviations: variances.iter().map(|v| (v * variance).max(0.0).sqrt()).collect(),
        rms: (points.iter().map(|p| normal.dot(&(p - point)).powi(2)).sum::<f64>() / count).sqrt(),
        unobserved: Vec::new(),
    })
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
    use super::{GeometryError, Touch, fit_meeting_point, fit_plane, fit_sphere, least_radius};
    use crate::fit::FitError;
    use crate::fit::testing::gaussian;
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
    fn touch(random: &mut Pcg64Mcg, point: Vector3<f64>, normal: Vector3<f64>, friction: f64) -> Touch {
        let slide = vector(random).cross(&normal).normalize();
        let force = (slide * friction - normal) * (1.0 + gaussian(random).abs());
        Touch { wrench: Wrench::from_force_at(&point, force), normal: normal * 3.0 }
    }

    proptest! {
        #[test]
        fn shapes_come_back(seed in any::<u64>()) {
            let random = &mut Pcg64Mcg::seed_from_u64(seed);
            let centre = vector(random) * 0.01;
            let normals: Vec<_> = (0..15).map(|_| vector(random).normalize()).collect();
            let touches: Vec<_> =
                normals.iter().map(|n| touch(random, centre + n * 0.013, *n, 0.4)).collect();
            let sphere = fit_sphere(&touches).unwrap();
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
            let plane = fit_plane(&pivots, &normal).unwrap();
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
                Touch { wrench: Wrench::from_force_at(&(centre + n * 0.013), -n), normal: n }
            })
            .collect();
        let error = fit_sphere(&frictionless).unwrap_err();
        assert!(error.to_string().contains("unobserved: radius"), "{error}");
        // But the centre is.
        let wrenches: Vec<_> = frictionless.iter().map(|touch| touch.wrench).collect();
        assert!((fit_meeting_point(&wrenches).unwrap().shape - centre).largest() < 1e-12);
        let parallel = vec![wrenches[0]; 5];
        assert!(matches!(fit_meeting_point(&parallel), Err(GeometryError::Fit(_))));
        let mut bad = frictionless;
        bad[3].normal = Vector3::zeros();
        assert!(matches!(fit_sphere(&bad), Err(GeometryError::BadTouch { touch: 3, .. })));
    }

    #[test]
    fn a_plane_takes_three_pivots_that_are_not_in_a_line() {
        let random = &mut Pcg64Mcg::seed_from_u64(7);
        let mut pivot = |x: f64, y: f64| -> Vec<Wrench<f64>> {
            (0..5).map(|_| touch(random, Vector3::new(x, y, 0.01), Vector3::z(), 0.4).wrench).collect()
        };
        let [a, b, c] = [pivot(0.0, 0.0), pivot(0.01, 0.0), pivot(0.0, 0.01)];
        let plane = |pivots: &[&Vec<Wrench<f64>>]| {
            fit_plane(&pivots.iter().map(|pivot| (*pivot).clone()).collect::<Vec<_>>(), &Vector3::z())
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
        let below = fit_plane(&[a, b, c], &-Vector3::z()).unwrap().shape;
        assert!((below.normal.z + 1.0).abs() < 1e-9 && (below.offset + 0.01).abs() < 1e-9);
    }
}
