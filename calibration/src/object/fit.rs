//! Shapes to points and normals: weighted least squares.

use nalgebra::{DMatrix, Matrix2, Vector2, Vector3};

use super::{ObjectError, ObjectPoint, PoseNoise};
use crate::fit::student_factor;
use crate::linear::{Factors, Triangular, Unobserved};

/// An object's shape, and how sure it is.
///
/// ```
/// # use fingertip_calibration::object::{ObjectPoint, PoseNoise};
/// # use fingertip_calibration::nalgebra::{Matrix3, Vector3};
/// # // A touch of a sphere around the origin, from without (1) or within (−1), off by about 0.1 mm.
/// # let touched = |k: i32, radius: f64, side: f64| {
/// #     let (around, up) = (2.4 * f64::from(k), f64::from(k - 20) / 22.0);
/// #     let place = Vector3::new(around.cos(), around.sin(), 2.0 * up).normalize();
/// #     let error = Vector3::new((5.1 * f64::from(k)).sin(), (7.3 * f64::from(k)).cos(), (11.7 * f64::from(k)).sin());
/// #     ObjectPoint {
/// #         point: place * radius + error * 1e-4,
/// #         normal: place * side,
/// #         covariance: Matrix3::zeros(),
/// #         bend: Matrix3::zeros(),
/// #     }
/// # };
/// use fingertip_calibration::object::{FittedObject, fit_sphere};
/// use fingertip_surfaces::Sphere;
///
/// // A ball of 30 mm, touched from without; each pose is off by about 0.1 mm.
/// let touches: Vec<ObjectPoint> = (0..40).map(|k| touched(k, 0.03, 1.0)).collect();
/// let ball: FittedObject<Sphere<f64>> = fit_sphere(&touches, PoseNoise::new(1e-4, 1e-3)?)?;
/// assert!((ball.shape.radius() - 0.03).abs() < ball.half_widths(0.999)[0]);
/// assert!(ball.distance > 0.02e-3 && ball.distance < 0.2e-3);
/// # Ok::<(), fingertip_calibration::object::ObjectError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FittedObject<S> {
    /// The shape, in the frame of the object.
    pub shape: S,
    /// Which side of it is touched.
    pub concave: Concave,
    /// Standard deviation of each parameter \[m or rad\], in the order that the function tells.
    pub deviations: Vec<f64>,
    /// Degrees of freedom behind them.
    pub freedom: f64,
    /// RMS distance of the touches from the shape, along its normal \[m\].
    pub distance: f64,
    /// RMS angle between the normals of the touches and the shape's \[rad\].
    pub angle: f64,
    /// What is left over what the stated noise would leave (root mean squares); near 1 where both shape and noise are as
    /// stated.
    pub noise_scale: f64,
}

/// Whether an object is touched from within.
///
/// ```
/// # use fingertip_calibration::object::{ObjectPoint, PoseNoise};
/// # use fingertip_calibration::nalgebra::{Matrix3, Vector3};
/// # // A touch of a sphere around the origin, from without (1) or within (−1), off by about 0.1 mm.
/// # let touched = |k: i32, radius: f64, side: f64| {
/// #     let (around, up) = (2.4 * f64::from(k), f64::from(k - 20) / 22.0);
/// #     let place = Vector3::new(around.cos(), around.sin(), 2.0 * up).normalize();
/// #     let error = Vector3::new((5.1 * f64::from(k)).sin(), (7.3 * f64::from(k)).cos(), (11.7 * f64::from(k)).sin());
/// #     ObjectPoint {
/// #         point: place * radius + error * 1e-4,
/// #         normal: place * side,
/// #         covariance: Matrix3::zeros(),
/// #         bend: Matrix3::zeros(),
/// #     }
/// # };
/// use fingertip_calibration::object::{Concave, fit_sphere};
///
/// // The same sphere from without, and as a bowl from within.
/// let noise = PoseNoise::new(1e-4, 1e-3)?;
/// for (side, concave) in [(1.0, Concave::No), (-1.0, Concave::Yes)] {
///     let touches: Vec<ObjectPoint> = (0..40).map(|k| touched(k, 0.03, side)).collect();
///     assert_eq!(fit_sphere(&touches, noise)?.concave, concave);
/// }
/// # Ok::<(), fingertip_calibration::object::ObjectError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Concave {
    /// A ball, a rod, a flat side.
    No,
    /// A bowl, a bore.
    Yes,
}

impl Concave {
    /// By the sign of a radius along outward normals.
    pub(super) fn of(radius: f64) -> Self {
        if radius < 0.0 { Self::Yes } else { Self::No }
    }

    /// 1 where the normal leads away from the centre, −1 where it leads there.
    pub(super) const fn sign(self) -> f64 {
        match self {
            Self::No => 1.0,
            Self::Yes => -1.0,
        }
    }
}

impl<S> FittedObject<S> {
    /// Half the width of the interval around each parameter that holds the true one with this probability:
    /// [`deviations`](Self::deviations) times the quantile of Student's distribution. NaN for a probability that is not
    /// between 0 and 1.
    #[must_use]
    pub fn half_widths(&self, probability: f64) -> Vec<f64> {
        let factor = student_factor(probability, self.freedom);
        self.deviations.iter().map(|deviation| deviation * factor).collect()
    }
}

/// A shape at the place nearest to a point.
pub(super) struct Near<const P: usize> {
    /// Two tangents; their cross product is along the outward normal.
    pub(super) tangents: [Vector3<f64>; 2],
    /// How far outside the shape the point is \[m\], and how that follows the parameters.
    pub(super) distance: f64,
    pub(super) distance_slope: [f64; P],
    /// How the normal follows the parameters, along the tangents.
    pub(super) normal_slopes: [[f64; P]; 2],
    /// The shape's principal curvatures along the tangents \[1/m\].
    pub(super) bend: [f64; 2],
}

/// A shape with `P` parameters that is fitted.
pub(super) trait Model<const P: usize> {
    const NAMES: [&'static str; P];
    fn near(&self, point: &Vector3<f64>) -> Near<P>;
    /// Takes a step, and says how large it is in units of the shape's own size.
    fn advance(&mut self, change: &[f64; P]) -> f64;
}

/// What is known of the parameters once the shape no longer changes.
pub(super) struct Settled {
    pub(super) deviations: Vec<f64>,
    freedom: f64,
    distance: f64,
    angle: f64,
    noise_scale: f64,
}

impl Settled {
    pub(super) fn with<S>(self, shape: S, concave: Concave) -> FittedObject<S> {
        let Self { deviations, freedom, distance, angle, noise_scale } = self;
        FittedObject { shape, concave, deviations, freedom, distance, angle, noise_scale }
    }
}

/// The three residuals of a touch, whitened, with their slopes.
struct Weighed<const P: usize> {
    residuals: [f64; 3],
    slopes: [[f64; P]; 3],
    /// In SI units: along the normal \[m\], and the angle \[rad\].
    distance: f64,
    angle: f64,
}

/// What a touch at an uncertain place says (`docs/theory/calibration.md#an-object-by-its-touches`).
///
/// The fingertip and the object are tangent at the true place. At one that is off by δ in the tangent plane their normals
/// lean towards each other by `m = (K_f + K_o) δ`, and the point is `½ δᵀ(K_f + K_o)δ` outside the object. So m tells of δ what
/// its noise leaves, and what it tells is taken off the distance.
fn weigh<const P: usize>(touch: &ObjectPoint, near: &Near<P>, noise: PoseNoise) -> Option<Weighed<P>> {
    let [t1, t2] = &near.tangents;
    let in_plane = |m: &nalgebra::Matrix3<f64>| {
        let both = (t1.dot(&(m * t2)) + t2.dot(&(m * t1))) / 2.0;
        Matrix2::new(t1.dot(&(m * t1)), both, both, t2.dot(&(m * t2)))
    };
    let of_object = Matrix2::from_diagonal(&Vector2::from(near.bend));
    let bend = in_plane(&touch.bend) + of_object;
    let place = in_plane(&touch.covariance);
    let lean = Vector2::new(t1.dot(&touch.normal), t2.dot(&touch.normal)) * -1.0;
    // A fingertip that is beside where it is told to be has another part of the object before it.
    let beside = of_object * of_object * (noise.position * noise.position);
    let turn = Matrix2::from_diagonal_element(noise.turn * noise.turn);
    let of_lean = bend * place * bend + beside + turn;
    let factor = of_lean.cholesky()?;
    // What is known of δ by the lean: its mean and covariance.
    let gain = factor.solve(&(bend * place)).transpose();
    let (mean, left) = (gain * lean, place - gain * bend * place);
    let spread = bend * left;
    let outside = (mean.dot(&(bend * mean)) + spread.trace()) / 2.0;
    let variance = noise.position * noise.position + (spread * spread).trace() / 2.0;
    let weight = 1.0 / variance.sqrt();
    let white = factor.l().try_inverse()?;
    let leaned = white * lean;
    let [along, other] = near.normal_slopes;
    let leaning =
        |row: usize| core::array::from_fn(|k| white[(row, 0)] * along[k] + white[(row, 1)] * other[k]);
    let slopes = [near.distance_slope.map(|slope| slope * weight), leaning(0), leaning(1)];
    let distance = near.distance - outside;
    let residuals = [distance * weight, leaned.x, leaned.y];
    residuals.iter().all(|x| x.is_finite()).then_some(Weighed {
        residuals,
        slopes,
        distance,
        angle: lean.norm(),
    })
}

/// The touches with normals of unit length, their centroid taken off, and the centroid.
///
/// # Errors
/// [`ObjectError::TooFew`], [`ObjectError::BadPoint`].
pub(super) fn centred(
    touches: &[ObjectPoint],
    parameters: usize,
) -> Result<(Vec<ObjectPoint>, Vector3<f64>), ObjectError> {
    let least = parameters / 3 + 1;
    if touches.len() < least {
        return Err(ObjectError::TooFew { points: touches.len(), least });
    }
    let mut checked = Vec::with_capacity(touches.len());
    for (touch, point) in touches.iter().enumerate() {
        checked.push(point.checked(touch)?);
    }
    let centroid = checked.iter().map(|touch| touch.point).sum::<Vector3<f64>>() / checked.len() as f64;
    checked.iter_mut().for_each(|touch| touch.point -= centroid);
    Ok((checked, centroid))
}

/// Least squares of rows with `P` unknowns each, by orthogonal transformations.
///
/// # Errors
/// [`ObjectError::Undetermined`], with the names of what does not show.
pub(super) fn linear<const P: usize>(
    rows: impl Iterator<Item = ([f64; P], f64)>,
    names: [&str; P],
) -> Result<[f64; P], ObjectError> {
    let mut triangular = Triangular::new(P, 1);
    for (slopes, value) in rows {
        triangular.push(&slopes, &[value]);
    }
    solved(&triangular.factors(), names)
}

fn solved<const P: usize>(factors: &Factors, names: [&str; P]) -> Result<[f64; P], ObjectError> {
    let solution = factors.coefficients().map_err(|unobserved| undetermined(unobserved, &names))?;
    Ok(core::array::from_fn(|parameter| solution[(parameter, 0)]))
}

fn undetermined(mut unobserved: Unobserved, names: &[&str]) -> ObjectError {
    unobserved.names = names.iter().map(|name| (*name).to_owned()).collect();
    ObjectError::Undetermined { what: unobserved.described() }
}

const MOST_ITERATIONS: usize = 100;

/// Gauss-Newton from a shape until it no longer changes. Deviations are scaled by what is left.
///
/// # Errors
/// [`ObjectError::Undetermined`], also for a length whose interval of 95 % is wider than `size` \[m\];
/// [`ObjectError::NoConvergence`].
pub(super) fn settle<M: Model<P>, const P: usize>(
    touches: &[ObjectPoint],
    noise: PoseNoise,
    model: &mut M,
    sizes: impl Fn(&M) -> [f64; P],
) -> Result<Settled, ObjectError> {
    let mut last = f64::INFINITY;
    for iteration in 0..MOST_ITERATIONS {
        let mut triangular = Triangular::new(P, 1);
        let (mut misfit, mut distances, mut angles) = (0.0, 0.0, 0.0);
        for touch in touches {
            let weighed = weigh(touch, &model.near(&touch.point), noise)
                .ok_or(ObjectError::NoConvergence { iterations: iteration })?;
            for (slope, residual) in weighed.slopes.iter().zip(weighed.residuals) {
                triangular.push(slope, &[-residual]);
                misfit += residual * residual;
            }
            distances += weighed.distance * weighed.distance;
            angles += weighed.angle * weighed.angle;
        }
        let factors = triangular.factors();
        let change = solved(&factors, M::NAMES)?;
        let step = model.advance(&change);
        // Steps that are small and no longer shrink are rounding.
        if step <= 1e-12 || (step < 1e-8 && step > 0.1 * last) {
            let count = touches.len() as f64;
            let freedom = 3.0 * count - P as f64;
            let noise_scale = (misfit / freedom).sqrt();
            let root = factors.inverse_root().map_err(|unobserved| undetermined(unobserved, &M::NAMES))?;
            let deviations = deviations(&root, noise_scale);
            narrow(&deviations, &M::NAMES, &sizes(model), freedom)?;
            return Ok(Settled {
                deviations,
                freedom,
                distance: (distances / count).sqrt(),
                angle: (angles / count).sqrt(),
                noise_scale,
            });
        }
        if step.is_nan() {
            break;
        }
        last = step;
    }
    Err(ObjectError::NoConvergence { iterations: MOST_ITERATIONS })
}

fn deviations(root: &DMatrix<f64>, noise_scale: f64) -> Vec<f64> {
    root.row_iter().map(|row| row.norm() * noise_scale).collect()
}

fn narrow(deviations: &[f64], names: &[&str], sizes: &[f64], freedom: f64) -> Result<(), ObjectError> {
    let factor = student_factor(0.95, freedom);
    for ((deviation, name), size) in deviations.iter().zip(names).zip(sizes) {
        if !(deviation * factor < *size) {
            return Err(ObjectError::Undetermined { what: (*name).to_owned() });
        }
    }
    Ok(())
}
