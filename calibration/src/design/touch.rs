//! Touches of a surface.

use core::f64::consts::{PI, TAU};

use fingertip_surfaces::ActiveSurface;
use fingertip_wrench::Line;
use nalgebra::{Matrix3, Matrix3x6, Vector3};

use super::DesignError;

/// A touch: where, with which outward normal, by which force on the fingertip \[m, –, N\].
///
/// ```
/// use fingertip_calibration::design::DesignTouch;
/// use fingertip_calibration::nalgebra::Vector3;
///
/// // 2 N straight down at the top of a tip of 10 mm.
/// let touch = DesignTouch { point: Vector3::z() * 0.01, normal: Vector3::z(), force: Vector3::z() * -2.0 };
/// // A torque about y moves the contact along x, by 1/2 N.
/// let jacobian = touch.jacobian();
/// assert!((jacobian[(0, 4)] - 0.5).abs() < 1e-12 && jacobian.row(2).norm() < 1e-12);
/// // A force of 1 N along x, on an arm of 10 mm, shifts it by −5 mm.
/// assert!((jacobian[(0, 0)] + 5e-3).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DesignTouch {
    /// Contact point in the sensor frame \[m\].
    pub point: Vector3<f64>,
    /// Outward unit normal of the surface.
    pub normal: Vector3<f64>,
    /// Force on the fingertip \[N\].
    pub force: Vector3<f64>,
}

impl DesignTouch {
    /// How the contact point moves with the six components of the wrench \[m/N, m/(N·m)\].
    #[must_use]
    pub fn jacobian(&self) -> Matrix3x6<f64> {
        let Self { point, normal, force } = self;
        let onto_surface = Matrix3::identity() - force * normal.transpose() / force.dot(normal);
        let by_torque = onto_surface * force.cross_matrix() / force.norm_squared();
        let by_force = -by_torque * point.cross_matrix();
        let mut jacobian = Matrix3x6::zeros();
        jacobian.fixed_columns_mut::<3>(0).copy_from(&by_force);
        jacobian.fixed_columns_mut::<3>(3).copy_from(&by_torque);
        jacobian
    }
}

impl DesignTouch {
    /// Touches all over a spherical tip: see [`ContactWeight::on_sphere`](super::ContactWeight::on_sphere).
    ///
    /// # Errors
    /// As there.
    pub fn on_sphere(
        radius: f64,
        half_angle: f64,
        friction: f64,
        force: f64,
    ) -> Result<Vec<Self>, DesignError> {
        DesignError::check_positive("radius of the tip", radius)?;
        DesignError::check_positive("force of a touch", force)?;
        DesignError::check_not_negative("friction ratio", friction)?;
        if !(half_angle > 0.0 && half_angle <= PI) {
            let requirement = "above 0 and at most π";
            return Err(DesignError::OutOfRange { quantity: "half angle", value: half_angle, requirement });
        }
        let cap = 1.0 - half_angle.cos();
        let mut touches = Vec::new();
        for i in 0..POINTS {
            // Archimedes: equal steps along the axis are equal areas.
            let x = 1.0 - cap * (f64::from(i) + 0.5) / f64::from(POINTS);
            let (sin, cos) = (f64::from(i) * GOLDEN_ANGLE).sin_cos();
            let across = (1.0 - x * x).max(0.0).sqrt();
            let normal = Vector3::new(x, across * cos, across * sin);
            let point = normal * radius;
            touches.extend(forces(normal, friction, force).map(|force| Self { point, normal, force }));
        }
        Ok(touches)
    }

    /// Touches all over the active part of any surface: lines of all directions through a ball
    /// about `centre` of radius `reach` \[m\] are crossed with it, which meets every part of the
    /// surface in proportion to its area (Cauchy). Of a surface that reaches farther than the ball, the part within
    /// it: lines that are nearly parallel to a plane would cross it far away, where nothing touches.
    /// Deterministic; none if no line meets it.
    ///
    /// # Errors
    /// [`DesignError::OutOfRange`] for bad numbers.
    pub fn on_surface<S: ActiveSurface<f64>>(
        surface: &S,
        centre: Vector3<f64>,
        reach: f64,
        friction: f64,
        force: f64,
    ) -> Result<Vec<Self>, DesignError> {
        DesignError::check_positive("reach", reach)?;
        DesignError::check_positive("force of a touch", force)?;
        DesignError::check_not_negative("friction ratio", friction)?;
        let mut touches = Vec::new();
        let lines = POINTS * 100;
        for i in 0..lines {
            // Direction on a sphere and place on a disc from four sequences of the R4 kind
            // (Roberts 2018): powers of the root of x⁵ = x + 1.
            let root = 1.167_303_978_261_418_7_f64;
            let [a, b, c, d] =
                [1, 2, 3, 4].map(|power| (0.5 + f64::from(i) * root.powi(-power)).rem_euclid(1.0));
            let along = 1.0 - 2.0 * a;
            let across = (1.0 - along * along).max(0.0).sqrt();
            let (sin, cos) = (TAU * b).sin_cos();
            let direction = Vector3::new(along, across * cos, across * sin);
            let helper = Vector3::ith(direction.iamin(), 1.0);
            let first = direction.cross(&helper).normalize();
            let second = direction.cross(&first);
            let (sin, cos) = (TAU * d).sin_cos();
            let point = centre + (first * cos + second * sin) * (reach * c.sqrt());
            surface.crossings(&Line { point, direction }, |crossing| {
                // The ball may be the surface itself, and rounding put a point beyond it.
                if crossing.active && (crossing.point - centre).norm() <= reach * (1.0 + 1e-9) {
                    touches.extend(forces(crossing.normal, friction, force).map(|force| Self {
                        point: crossing.point,
                        normal: crossing.normal,
                        force,
                    }));
                }
            });
        }
        Ok(touches)
    }
}

/// Directions of force per contact point.
const FORCES: u32 = 8;
/// Contact points over a surface.
const POINTS: u32 = 200;
/// Turn from one point of a sunflower spiral to the next: spreads evenly.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Forces of size `size` that press along `−normal` with a friction ratio up to `friction`, spread
/// evenly over the disc of ratios.
fn forces(normal: Vector3<f64>, friction: f64, size: f64) -> impl Iterator<Item = Vector3<f64>> {
    let helper = Vector3::ith(normal.iamin(), 1.0);
    let first = normal.cross(&helper).normalize();
    let second = normal.cross(&first);
    let count = if friction > 0.0 { FORCES } else { 1 };
    (0..count).map(move |i| {
        let ratio =
            if count == 1 { 0.0 } else { friction * ((f64::from(i) + 0.5) / f64::from(count)).sqrt() };
        let (sin, cos) = (f64::from(i) * GOLDEN_ANGLE).sin_cos();
        ((first * cos + second * sin) * ratio - normal).normalize() * size
    })
}

/// Touches of a surface, on which a report says what the calibration is worth.
///
/// ```
/// # use fingertip_calibration::{Axis, file::SignalUnit, loads::LoadTable, nalgebra::DMatrix};
/// # // Six loads one after another, up to ±9.5 N and ±95 N·mm; gauges of 0.1 V/N or 10 V/(N·m) that scatter.
/// # let size = [1.0, 1.0, 1.0, 0.01, 0.01, 0.01];
/// # let loads = DMatrix::from_fn(120, 6, |i, j| if i % 6 == j { ((i / 6) as f64 - 9.5) * size[j] } else { 0.0 });
/// # let signals = loads.map_with_location(|i, j, load| 0.1 * load / size[j] + 1e-3 * ((7 * i + 3 * j) as f64).sin());
/// # let table = LoadTable::new(&Axis::ALL, loads, signals, SignalUnit::Volt)?;
/// use fingertip_calibration::design::{DesignTouch, TouchSet};
/// use fingertip_calibration::{calibrate, model::Options};
///
/// // What is this calibration worth on a tip of 13 mm, touched with 5 N?
/// let set = TouchSet {
///     surface: "sphere of 13 mm".into(),
///     touches: DesignTouch::on_sphere(0.013, core::f64::consts::FRAC_PI_2, 0.5, 5.0)?,
/// };
/// let count = set.touches.len();
/// let report = calibrate(&table, &Options { touches: Some(set), ..Options::default() })?.report;
/// assert_eq!(report.contacts.ok_or("none")?.touches, count);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct TouchSet {
    /// What the surface is, in words: "a sphere of 10 mm about the origin".
    pub surface: String,
    /// The touches, such as [`DesignTouch::on_sphere`] or [`DesignTouch::on_surface`] gives.
    pub touches: Vec<DesignTouch>,
}

#[cfg(test)]
mod tests {
    use super::DesignTouch;
    use fingertip_contact::{ContactModel, PointContact};
    use fingertip_surfaces::Sphere;
    use fingertip_wrench::Wrench;
    use nalgebra::{Vector3, Vector6};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn jacobian_agrees_with_the_resolver(
            direction in proptest::array::uniform3(-1.0..1.0_f64),
            sideways in proptest::array::uniform3(-0.4..0.4_f64),
            change in proptest::array::uniform6(-1.0..1.0_f64),
        ) {
            let normal = Vector3::from(direction);
            prop_assume!(normal.norm() > 0.1);
            let normal = normal.normalize();
            let radius = 13e-3;
            let force = (Vector3::from(sideways) - normal) * 2.0;
            prop_assume!(force.dot(&normal) < -0.8);
            let touch = DesignTouch { point: normal * radius, normal, force };
            let sphere = Sphere::centred(radius).unwrap();
            let model = PointContact::new(0.0).unwrap();
            let wrench: Wrench<f64> = Wrench::from_force_at(&touch.point, force);
            let wrench = wrench.components();
            let change = Vector6::from(change).component_mul(&Vector6::new(1.0, 1.0, 1.0, 0.01, 0.01, 0.01));
            let at = |t: f64| {
                let wrench = Wrench::from_components(&(wrench + change * t));
                model.resolve(&wrench, &sphere).into_result().unwrap().point
            };
            let step = 1e-5;
            let difference = (at(step) - at(-step)) / (2.0 * step);
            let predicted = touch.jacobian() * change;
            prop_assert!((predicted - difference).norm() <= 1e-6 * predicted.norm().max(1e-3));
        }
    }
}
