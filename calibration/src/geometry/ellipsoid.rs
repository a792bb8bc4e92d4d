//! The shape of an ellipsoidal fingertip from touches at known directions.

use fingertip_surfaces::{BadShape, Ellipsoid, Posed, Sphere};
use fingertip_wrench::RigidTransform;
use nalgebra::{DMatrix, Matrix3, Rotation3, Vector3};

use super::fitted::{check_widths, roots};
use super::torques::{Points, Step, settle};
use super::touches::{directions, radius_and_centre, shifts, wrenches};
use super::{Fitted, GeometryError, ShapeTouch, WrenchNoise};

/// The semi-axes and centre of an ellipsoid whose axes are those of the sensor frame.
///
/// ```
/// # use fingertip_calibration::geometry::ShapeTouch;
/// # use fingertip_calibration::nalgebra::Vector3;
/// # use fingertip_wrench::Wrench;
/// # // 2 N inward and 0.5 N aside, at forty places of an ellipsoid.
/// # let touched = |semi_axes: Vector3<f64>, centre: Vector3<f64>| -> Vec<ShapeTouch> {
/// #     let touch = |k: i32| {
/// #         let (around, up) = (2.4 * f64::from(k), f64::from(k - 15) / 25.0);
/// #         let normal = Vector3::new(around.cos(), around.sin(), up).normalize();
/// #         let squared = semi_axes.component_mul(&semi_axes).component_mul(&normal);
/// #         let point = centre + squared / squared.dot(&normal).sqrt();
/// #         let aside = normal.cross(&Vector3::new(0.3, f64::from(k).sin(), 0.8)).normalize() * 0.5;
/// #         ShapeTouch { wrench: Wrench::from_force_at(&point, aside - normal * 2.0), normal }
/// #     };
/// #     (0..40).map(touch).collect()
/// # };
/// use fingertip_calibration::geometry::{EllipsoidParameters, Fitted, WrenchNoise, fit_aligned_ellipsoid};
///
/// // Touches on an ellipsoid of 8, 10 and 14 mm, 30 mm above the sensor.
/// let touches = touched(Vector3::new(0.008, 0.010, 0.014), Vector3::new(0.0, 0.0, 0.03));
/// let fitted: Fitted<EllipsoidParameters> = fit_aligned_ellipsoid(&touches, &WrenchNoise::exact_forces())?;
/// assert!((fitted.shape.semi_axes - Vector3::new(0.008, 0.010, 0.014)).norm() < 1e-6);
/// assert!((fitted.shape.centre - Vector3::new(0.0, 0.0, 0.03)).norm() < 1e-6);
/// # Ok::<(), fingertip_calibration::geometry::GeometryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidParameters {
    /// Semi-axes along x, y, z \[m\].
    pub semi_axes: Vector3<f64>,
    /// Centre \[m\].
    pub centre: Vector3<f64>,
}

/// Ellipsoid with axes along the sensor's, from touches at known directions: the point with outward
/// normal n is `t + A² n / √(nᵀA²n)`, A = diag(semi-axes). Gauss-Newton from the fitted sphere.
/// Deviations: semi-axes x, y, z, centre x, y, z.
///
/// # Errors
/// [`GeometryError`].
pub fn fit_aligned_ellipsoid(
    touches: &[ShapeTouch],
    noise: &WrenchNoise,
) -> Result<Fitted<EllipsoidParameters>, GeometryError> {
    let normals = directions(touches)?;
    let wrenches = wrenches(touches);
    let (radius, centre, _) = radius_and_centre(&wrenches, &normals, &noise.without_forces())?;
    let start = EllipsoidParameters { semi_axes: Vector3::from_element(positive(radius)?), centre };
    let names = ["semi-axis x", "semi-axis y", "semi-axis z", "centre x", "centre y", "centre z"];
    let points = |shape: &EllipsoidParameters| {
        let squares = shape.semi_axes.component_mul(&shape.semi_axes);
        let mut slopes: Vec<Vec<Vector3<f64>>> = vec![Vec::new(); 3];
        let mut at = Vec::with_capacity(normals.len());
        for n in &normals {
            let scaled = squares.component_mul(n);
            let width = n.dot(&scaled).sqrt();
            at.push(shape.centre + scaled / width);
            for (j, column) in slopes.iter_mut().enumerate() {
                // d(A²n/w)/da_j = 2 a_j n_j e_j / w − A²n · a_j n_j² / w³.
                let along = Vector3::ith(j, 2.0 * shape.semi_axes[j] * n[j] / width);
                column.push(along - scaled * (shape.semi_axes[j] * n[j] * n[j] / width.powi(3)));
            }
        }
        slopes.extend(shifts(normals.len()));
        Points { at, slopes, free: None }
    };
    let (shape, step) = settle(&wrenches, noise, &names, start, points, |shape, step| {
        // A semi-axis may shrink to a tenth of itself in one step, but not turn negative.
        for j in 0..3 {
            shape.semi_axes[j] = (shape.semi_axes[j] + step.change[j]).max(0.1 * shape.semi_axes[j]);
            shape.centre[j] += step.change[3 + j];
        }
        step.change.amax() / shape.semi_axes.amax()
    })?;
    let deviations = roots(&step.covariance(step.variance(), &names)?);
    let [x, y, z] = shape.semi_axes.into();
    check_widths(&step, &deviations, &names, &[x, y, z, x, y, z])?;
    Ok(Fitted::of(shape, &step, deviations))
}

/// The radius of a sphere to begin with.
fn positive(radius: f64) -> Result<f64, GeometryError> {
    if radius < 0.0 {
        return Err(GeometryError::negative("radius", radius));
    }
    Ok(Sphere::centred(radius)?.radius())
}

/// An ellipsoid anywhere in the sensor frame.
///
/// ```
/// # use fingertip_calibration::geometry::ShapeTouch;
/// # use fingertip_calibration::nalgebra::Vector3;
/// # use fingertip_wrench::Wrench;
/// # // 2 N inward and 0.5 N aside, at forty places of an ellipsoid.
/// # let touched = |semi_axes: Vector3<f64>, centre: Vector3<f64>| -> Vec<ShapeTouch> {
/// #     let touch = |k: i32| {
/// #         let (around, up) = (2.4 * f64::from(k), f64::from(k - 15) / 25.0);
/// #         let normal = Vector3::new(around.cos(), around.sin(), up).normalize();
/// #         let squared = semi_axes.component_mul(&semi_axes).component_mul(&normal);
/// #         let point = centre + squared / squared.dot(&normal).sqrt();
/// #         let aside = normal.cross(&Vector3::new(0.3, f64::from(k).sin(), 0.8)).normalize() * 0.5;
/// #         ShapeTouch { wrench: Wrench::from_force_at(&point, aside - normal * 2.0), normal }
/// #     };
/// #     (0..40).map(touch).collect()
/// # };
/// use fingertip_calibration::geometry::{Fitted, PosedEllipsoid, WrenchNoise, fit_ellipsoid};
///
/// // Touches on an ellipsoid of 8, 10 and 14 mm, of which nothing is known beforehand.
/// let touches = touched(Vector3::new(0.008, 0.010, 0.014), Vector3::new(0.0, 0.0, 0.03));
/// let fitted: Fitted<PosedEllipsoid> = fit_ellipsoid(&touches, &WrenchNoise::exact_forces())?;
/// // Its semi-axes from the longest, the first along z of the sensor.
/// assert!((fitted.shape.semi_axes - Vector3::new(0.014, 0.010, 0.008)).norm() < 1e-6);
/// assert!(fitted.shape.sensor_from_ellipsoid.rotation().column(0).z.abs() > 0.999_999);
/// assert!(fitted.shape.surface().is_ok());
/// # Ok::<(), fingertip_calibration::geometry::GeometryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PosedEllipsoid {
    /// Semi-axes from the longest to the shortest \[m\]: x, y, z of the ellipsoid's own frame.
    pub semi_axes: Vector3<f64>,
    /// The pose of the ellipsoid's own frame.
    pub sensor_from_ellipsoid: RigidTransform<f64>,
}

impl PosedEllipsoid {
    /// As a surface.
    ///
    /// # Errors
    /// [`BadShape`] only if the semi-axes were changed to ones that cannot be.
    pub fn surface(&self) -> Result<Posed<f64, Ellipsoid<f64>>, BadShape> {
        Ok(Posed::new(Ellipsoid::new(self.semi_axes)?, self.sensor_from_ellipsoid))
    }
}

/// Row and column of the six numbers of a symmetric matrix.
const ENTRIES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

fn symmetric(k: usize) -> Matrix3<f64> {
    let (i, j) = ENTRIES[k];
    let mut basis = Matrix3::zeros();
    basis[(i, j)] = 1.0;
    basis[(j, i)] = 1.0;
    basis
}

/// Ellipsoid of any orientation, from touches at known directions: the point with outward normal n is
/// `t + M n / √(nᵀMn)` with M = Q diag(semi-axes)² Qᵀ, nine unknowns. Gauss-Newton from the fitted
/// sphere, with steps that keep M positive definite; M is then taken apart into semi-axes and
/// orientation.
///
/// Deviations: semi-axes from the longest, centre x, y, z \[m\], turns about the three principal axes
/// \[rad\]. Where two semi-axes differ by less than three deviations of their difference, the turn about
/// the third principal axis is not observable: its deviation is infinite, and `unobserved` names it.
///
/// # Errors
/// [`GeometryError`]; without friction, sizes cannot be observed. Five generic touches are the least.
pub fn fit_ellipsoid(
    touches: &[ShapeTouch],
    noise: &WrenchNoise,
) -> Result<Fitted<PosedEllipsoid>, GeometryError> {
    let normals = directions(touches)?;
    let wrenches = wrenches(touches);
    let (radius, centre, _) = radius_and_centre(&wrenches, &normals, &noise.without_forces())?;
    // In units of the sphere's radius, so that all nine numbers are of one size.
    let unit = positive(radius)?;
    let names = [
        "shape xx", "shape yy", "shape zz", "shape xy", "shape xz", "shape yz", "centre x", "centre y",
        "centre z",
    ];
    let points = |(shape, centre): &(Matrix3<f64>, Vector3<f64>)| {
        let mut slopes: Vec<Vec<Vector3<f64>>> = vec![Vec::new(); 6];
        let mut at = Vec::with_capacity(normals.len());
        for n in &normals {
            let scaled = shape * n;
            let width = n.dot(&scaled).sqrt();
            at.push((centre + scaled / width) * unit);
            for (k, column) in slopes.iter_mut().enumerate() {
                let change = symmetric(k) * n;
                let slope = change / width - scaled * (n.dot(&change) / (2.0 * width.powi(3)));
                column.push(slope * unit);
            }
        }
        slopes.extend((0..3).map(|j| vec![Vector3::ith(j, unit); normals.len()]));
        Points { at, slopes, free: None }
    };
    let start = (Matrix3::identity(), centre / unit);
    let ((shape, centre), step) =
        settle(&wrenches, noise, &names, start, points, |(shape, centre), step| {
            let step = &step.change;
            let change = (0..6).fold(Matrix3::zeros(), |sum, k| sum + symmetric(k) * step[k]);
            // Shortened until no semi-axis shrinks to less than a third.
            let mut share = 1.0;
            while share > 1e-6 && least_eigenvalue(&(*shape + change * share)) < 0.1 * least_eigenvalue(shape)
            {
                share *= 0.5;
            }
            *shape += change * share;
            *centre += step.fixed_rows::<3>(6) * share;
            if share < 1.0 { f64::INFINITY } else { step.amax() / shape.amax() }
        })?;
    let covariance = step.covariance(step.variance(), &names)?;
    let fitted = taken_apart(&shape, &centre, unit, &covariance, &step);
    let [x, y, z] = fitted.shape.semi_axes.into();
    let names =
        ["longest semi-axis", "middle semi-axis", "shortest semi-axis", "centre x", "centre y", "centre z"];
    check_widths(&step, &fitted.deviations, &names, &[x, y, z, x, x, x])?;
    Ok(fitted)
}

fn least_eigenvalue(matrix: &Matrix3<f64>) -> f64 {
    matrix.symmetric_eigenvalues().min()
}

/// Semi-axes, orientation and their deviations from M, t and their covariance, lengths in `unit`.
fn taken_apart(
    shape: &Matrix3<f64>,
    centre: &Vector3<f64>,
    unit: f64,
    covariance: &DMatrix<f64>,
    step: &Step,
) -> Fitted<PosedEllipsoid> {
    let eigen = shape.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let squares = order.map(|k| eigen.eigenvalues[k]);
    let (x, y) =
        (eigen.eigenvectors.column(order[0]).into_owned(), eigen.eigenvectors.column(order[1]).into_owned());
    let axes = [x, y, x.cross(&y)];
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&axes));
    // Standard deviation of uᵀ dM v, plus that of another such form with a factor.
    let form = |u: &Vector3<f64>, v: &Vector3<f64>| {
        nalgebra::DVector::from_fn(9, |k, _| if k < 6 { u.dot(&(symmetric(k) * v)) } else { 0.0 })
    };
    let spread = |g: &nalgebra::DVector<f64>| (g.transpose() * covariance * g)[(0, 0)].max(0.0).sqrt();
    let semi_axes = squares.map(f64::sqrt);
    let mut result: Vec<f64> =
        (0..3).map(|k| unit * spread(&form(&axes[k], &axes[k])) / (2.0 * semi_axes[k])).collect();
    // The centre was fitted in units too.
    result.extend((6..9).map(|i| covariance[(i, i)].max(0.0).sqrt() * unit));
    let mut unobserved = Vec::new();
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let gap = (squares[i] - squares[j]).abs();
        let difference = form(&axes[i], &axes[i]) - form(&axes[j], &axes[j]);
        // First order: vᵢ turns towards vⱼ by vⱼᵀ dM vᵢ / (λᵢ − λⱼ).
        if gap > 3.0 * spread(&difference) && gap > 64.0 * f64::EPSILON * squares[0] {
            result.push(spread(&form(&axes[i], &axes[j])) / gap);
        } else {
            result.push(f64::INFINITY);
            let name = ["longest", "middle", "shortest"][k];
            unobserved.push(format!("turn about the {name} principal axis (the others are alike)"));
        }
    }
    let semi_axes = Vector3::from(semi_axes) * unit;
    let sensor_from_ellipsoid = RigidTransform::from_parts(rotation, centre * unit);
    let shape = PosedEllipsoid { semi_axes, sensor_from_ellipsoid };
    Fitted { unobserved, ..Fitted::of(shape, step, result) }
}

#[cfg(test)]
#[path = "ellipsoid_tests.rs"]
mod tests;
