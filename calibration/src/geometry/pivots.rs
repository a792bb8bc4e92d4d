//! Points that were held still, and planes through them.

use fingertip_wrench::Wrench;
use nalgebra::{DMatrix, Matrix3, Vector3};
use statrs::distribution::{ContinuousCDF as _, FisherSnedecor};

use super::fitted::roots;
use super::torques::{Points, Step, settle};
use super::touches::shifts;
use super::{Fitted, GeometryError, WrenchNoise};
use crate::fit::FitError;
use crate::linear::{Singular, Triangular};

const POINT: [&str; 3] = ["point x", "point y", "point z"];

/// The point through which the lines of action of all wrenches pass: a pivot on which the fingertip was held
/// still while the force turned, or the centre of a sphere touched without friction. Deviations: x, y, z.
///
/// # Errors
/// [`GeometryError`]: at least two forces that are not parallel are needed, with four equations to spare.
pub fn fit_meeting_point(
    wrenches: &[Wrench<f64>],
    noise: &WrenchNoise,
) -> Result<Fitted<Vector3<f64>>, GeometryError> {
    let (point, step) = meeting_point(wrenches, noise)?;
    let deviations = roots(&step.covariance(step.variance(), &POINT)?);
    Ok(Fitted::of(point, &step, deviations))
}

fn meeting_point(
    wrenches: &[Wrench<f64>],
    noise: &WrenchNoise,
) -> Result<(Vector3<f64>, Step), GeometryError> {
    if let Some(touch) = wrenches.iter().position(|wrench| !wrench.is_finite()) {
        return Err(GeometryError::BadTouch { touch, what: "the wrench is not finite" });
    }
    let points = |point: &Vector3<f64>| Points {
        at: vec![*point; wrenches.len()],
        slopes: shifts(wrenches.len()).collect(),
        free: None,
    };
    settle(wrenches, noise, &POINT, Vector3::zeros(), points, |point, step| {
        *point += step.change.fixed_rows::<3>(0);
        step.change.amax() / point.norm().max(f64::MIN_POSITIVE)
    })
}

/// A plane `normal · x = offset`.
///
/// ```
/// use fingertip_calibration::geometry::{Fitted, PlaneParameters, WrenchNoise, fit_plane};
/// use fingertip_calibration::nalgebra::Vector3;
/// use fingertip_wrench::Wrench;
///
/// // A pad 10 mm above the sensor, held at four places while 2 N turned about them.
/// let places = [(0.005, 0.0), (0.0, 0.005), (-0.005, 0.0), (0.0, -0.005)];
/// let pivots = places.map(|(x, y)| {
///     let place = Vector3::new(x, y, 0.01);
///     let turned = |k: i32| Vector3::new(f64::from(k).sin(), f64::from(k).cos(), -1.7);
///     (0..8).map(|k| Wrench::from_force_at(&place, turned(k))).collect()
/// });
/// let plane: Fitted<PlaneParameters> = fit_plane(&pivots, &Vector3::z(), &WrenchNoise::exact_forces())?;
/// assert!((plane.shape.normal - Vector3::z()).norm() < 1e-9 && (plane.shape.offset - 0.01).abs() < 1e-9);
/// # Ok::<(), fingertip_calibration::geometry::GeometryError>(())
/// ```
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
/// points, which leave nothing, have an error too. The noise of the wrenches is taken to be the same at all
/// pivots; where the points lie off the plane by more than it allows (one chance in a thousand), the
/// deviations grow by as much, with the degrees of freedom of that.
///
/// `rms` is that of the distances of the points from the plane \[m\].
///
/// # Errors
/// [`GeometryError`]; the points must not lie on a line.
pub fn fit_plane(
    pivots: &[Vec<Wrench<f64>>],
    outward: &Vector3<f64>,
    noise: &WrenchNoise,
) -> Result<Fitted<PlaneParameters>, GeometryError> {
    let found = pivots.iter().map(|list| meeting_point(list, noise)).collect::<Result<Vec<_>, _>>()?;
    if found.len() < 3 {
        return Err(FitError::TooFewSamples { samples: found.len(), coefficients: 3 }.into());
    }
    let misfit: f64 = found.iter().map(|(_, step)| step.misfit).sum();
    let rest: f64 = found.iter().map(|(_, step)| step.freedom).sum();
    let of_wrenches = misfit / rest;
    let known = |(point, step): &(Vector3<f64>, Step)| {
        let spread = step.covariance(of_wrenches, &POINT)?;
        Ok((*point, Matrix3::from_fn(|i, j| spread[(i, j)])))
    };
    let points = found.iter().map(known).collect::<Result<Vec<_>, GeometryError>>()?;
    let plane = Plane::through(&points)?;
    let freedom = points.len() as f64 - 3.0;
    let inconsistent = freedom > 0.0
        && plane.ratio.is_finite()
        && FisherSnedecor::new(freedom, rest).is_ok_and(|expected| expected.sf(plane.ratio) < 1e-3);
    let (variance, freedom) = if inconsistent { (plane.ratio, freedom) } else { (1.0, rest) };
    let deviations: Vec<f64> = plane.variances.iter().map(|v| (v * variance).max(0.0).sqrt()).collect();
    let normal = if plane.normal.dot(outward) < 0.0 { -plane.normal } else { plane.normal };
    let distances: f64 = points.iter().map(|(p, _)| normal.dot(&(p - plane.point)).powi(2)).sum();
    let fitted = Fitted {
        shape: PlaneParameters { normal, offset: normal.dot(&plane.point) },
        deviations,
        freedom,
        rms: (distances / points.len() as f64).sqrt(),
        noise_scale: of_wrenches.sqrt(),
        unobserved: Vec::new(),
    };
    for (name, width) in ["tilt", "tilt"].iter().zip(fitted.half_widths(0.95).iter().skip(1)) {
        GeometryError::check_width(name, *width, 1.0)?;
    }
    Ok(fitted)
}

/// A plane through points of known covariance.
struct Plane {
    point: Vector3<f64>,
    normal: Vector3<f64>,
    /// Of the offset \[m²\] and the two tilts.
    variances: [f64; 3],
    /// Variance of the heights over what the covariances let expect; NaN for three points.
    ratio: f64,
}

impl Plane {
    fn through(points: &[(Vector3<f64>, Matrix3<f64>)]) -> Result<Self, GeometryError> {
        let count = points.len() as f64;
        let mean = points.iter().map(|(point, _)| point).sum::<Vector3<f64>>() / count;
        let spread = DMatrix::from_fn(points.len(), 3, |i, j| points[i].0[j] - mean[j]);
        let singular = Singular::new(&spread).ok_or(FitError::BadInput { what: "the pivots" })?;
        if !(singular.values[1] > 1e-3 * singular.values[0]) {
            return Err(GeometryError::BadTouch { touch: 0, what: "the pivots lie on a line" });
        }
        let axis = |k: usize| Vector3::from_fn(|i, _| singular.right[(i, k)]);
        let (first, second) = (axis(0), axis(1));
        let normal = first.cross(&second);
        // The heights over this plane, weighted by how well each is known, make it a better one. Pivots without any
        // error count alike.
        let variances: Vec<f64> = points.iter().map(|(_, spread)| normal.dot(&(spread * normal))).collect();
        let largest = variances.iter().copied().fold(0.0, f64::max);
        let mut heights = Triangular::new(3, 1);
        for ((point, _), variance) in points.iter().zip(&variances) {
            let from = point - mean;
            let weight = if largest > 0.0 { largest / variance.max(1e-12 * largest) } else { 1.0 };
            heights.push_weighted(&[1.0, first.dot(&from), second.dot(&from)], &[normal.dot(&from)], weight);
        }
        let factors = heights.factors();
        let better = factors.coefficients().map_err(FitError::from)?;
        let gram = factors.inverse_gram().map_err(FitError::from)? * largest;
        // A tilt turns the plane about the mean of the points, which moves its foot by where that lies.
        let foot = DMatrix::from_column_slice(3, 1, &[1.0, -first.dot(&mean), -second.dot(&mean)]);
        let offset = (foot.transpose() * &gram * &foot)[(0, 0)];
        Ok(Self {
            point: mean + normal * better[0],
            normal: (normal - first * better[1] - second * better[2]).normalize(),
            variances: [offset, gram[(1, 1)], gram[(2, 2)]],
            ratio: factors.residual[(0, 0)].powi(2) / ((count - 3.0) * largest),
        })
    }
}
