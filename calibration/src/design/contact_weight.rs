//! From the error of the wrench to the error of the contact.

use fingertip_surfaces::ActiveSurface;
use nalgebra::{Matrix6, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::{DesignError, DesignTouch};

/// How errors of the six components add up to the error of the contact point, averaged over the
/// touches that a fingertip is made for: `E|δc|² = tr(W Σ)` with `Σ` the covariance of the wrench
/// and `W` the mean of `JᵀJ`.
///
/// For a point contact at `c` with outward normal `n` and force `f` on the fingertip,
/// `J = Π[ −[f][c], [f] ]/|f|²` with `Π = I − f nᵀ/(f·n)`: the implicit function theorem on the
/// crossing of the line of action with the surface (`docs/theory/contact.md#errors-of-a-point-contact`; the
/// shape enters by its normal only). With channels of independent noise of standard deviation s,
/// `Σ = s²(CᵀC)⁻¹`, and the rms error of the position is `s·√(tr(W(CᵀC)⁻¹))`: first order in the noise, hence
/// too small near grazing and near the threshold of force.
///
/// ```
/// use fingertip_calibration::design::ContactWeight;
/// use fingertip_calibration::nalgebra::{Matrix6, Vector6};
///
/// // Touches of 1 N without friction, all over a half sphere of 10 mm.
/// let weight = ContactWeight::on_sphere(0.01, core::f64::consts::FRAC_PI_2, 0.0, 1.0)?;
/// // Torques of 0.1 N·mm make 0.1 mm in each of the two directions along the surface.
/// let torques = Matrix6::from_diagonal(&Vector6::new(0.0, 0.0, 0.0, 1e-8, 1e-8, 1e-8));
/// assert!((weight.position_error(&torques) - 2.0_f64.sqrt() * 1e-4).abs() < 1e-9);
/// # Ok::<(), fingertip_calibration::design::DesignError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactWeight {
    matrix: Matrix6<f64>,
}

impl ContactWeight {
    /// The mean over these touches.
    ///
    /// # Errors
    /// [`DesignError::WrongCount`] without touches, [`DesignError::Singular`] if a force is zero,
    /// not finite or does not press.
    pub fn over(touches: impl IntoIterator<Item = DesignTouch>) -> Result<Self, DesignError> {
        let (mut sum, mut count) = (Matrix6::zeros(), 0_u32);
        for touch in touches {
            if !(touch.force.dot(&touch.normal) < 0.0) {
                return Err(DesignError::Singular { reason: "a touch does not press on the surface" });
            }
            let jacobian = touch.jacobian();
            sum += jacobian.transpose() * jacobian;
            count += 1;
        }
        if count == 0 {
            return Err(DesignError::WrongCount { what: "touches", found: 0, expected: 1 });
        }
        let matrix = sum / f64::from(count);
        if matrix.iter().all(|x| x.is_finite()) {
            Ok(Self { matrix })
        } else {
            Err(DesignError::Singular { reason: "a touch is not finite" })
        }
    }

    /// Touches all over a spherical tip about the origin, from its pole on the first axis to
    /// `half_angle` \[rad\], with forces of `force` newtons at friction ratios up to `friction`.
    ///
    /// # Errors
    /// [`DesignError::OutOfRange`] for a radius or a force that is not positive, a negative ratio,
    /// or an angle not in (0, π].
    pub fn on_sphere(radius: f64, half_angle: f64, friction: f64, force: f64) -> Result<Self, DesignError> {
        Self::over(DesignTouch::on_sphere(radius, half_angle, friction, force)?)
    }

    /// Touches all over the active part of any surface: the mean over [`DesignTouch::on_surface`].
    ///
    /// # Errors
    /// As there, and [`DesignError::WrongCount`] if no line meets the active surface.
    pub fn on_surface<S: ActiveSurface<f64>>(
        surface: &S,
        centre: Vector3<f64>,
        reach: f64,
        friction: f64,
        force: f64,
    ) -> Result<Self, DesignError> {
        Self::over(DesignTouch::on_surface(surface, centre, reach, friction, force)?)
    }

    /// The same for a wrench in nominal loads: `W` of `wrench/nominal`.
    #[must_use]
    pub fn normalised(&self, nominal: &Vector6<f64>) -> Self {
        let scale = Matrix6::from_diagonal(nominal);
        Self { matrix: scale * self.matrix * scale }
    }

    /// `W` \[m² per squared unit of the components\].
    #[must_use]
    pub const fn matrix(&self) -> &Matrix6<f64> {
        &self.matrix
    }

    /// Root mean square of the position error \[m\] for a covariance of the wrench in the same units.
    #[must_use]
    pub fn position_error(&self, covariance: &Matrix6<f64>) -> f64 {
        self.matrix.component_mul(covariance).sum().max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::{ContactWeight, DesignTouch};
    use crate::testing::Largest as _;
    use core::f64::consts::PI;
    use fingertip_surfaces::Sphere;
    use nalgebra::{Matrix6, Vector3, Vector6};

    #[test]
    fn frictionless_sphere_has_its_closed_form() {
        // Force error of covariance a, torque error of covariance b, normal forces of size F on a
        // sphere of radius R about the origin: E|δc|² = 2(b + R² a)/F² (two tangent directions).
        let (radius, force, a, b) = (13e-3, 2.0, 4e-4, 9e-8);
        let covariance = Matrix6::from_diagonal(&Vector6::new(a, a, a, b, b, b));
        let weight = ContactWeight::on_sphere(radius, 1.0, 0.0, force).unwrap();
        let expected = (2.0 * (b + radius * radius * a)).sqrt() / force;
        assert!((weight.position_error(&covariance) / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn shooting_lines_agrees_with_the_cap() {
        let sphere = Sphere::centred(13e-3).unwrap();
        let by_lines = ContactWeight::on_surface(&sphere, Vector3::zeros(), 20e-3, 0.3, 1.0).unwrap();
        let by_points = ContactWeight::on_sphere(13e-3, PI, 0.3, 1.0).unwrap();
        let scale = Vector6::new(1.0, 1.0, 1.0, 0.013, 0.013, 0.013);
        let (a, b) = (by_lines.normalised(&scale), by_points.normalised(&scale));
        let off = (a.matrix() - b.matrix()).largest() / b.matrix().largest();
        assert!(off < 0.02, "{off} {} {}", a.matrix(), b.matrix());
    }

    #[test]
    fn refuses_touches_that_do_not_press() {
        let pole = DesignTouch { point: Vector3::x() * 0.013, normal: Vector3::x(), force: Vector3::x() };
        assert!(ContactWeight::over([pole]).is_err());
        for along in [Vector3::repeat(f64::NAN), Vector3::y(), Vector3::zeros()] {
            assert!(ContactWeight::over([DesignTouch { force: along, ..pole }]).is_err());
        }
        assert!(ContactWeight::over([]).is_err());
        assert!(ContactWeight::on_sphere(f64::NAN, 1.0, 0.5, 1.0).is_err());
        assert!(ContactWeight::on_sphere(0.013, 4.0, 0.5, 1.0).is_err());
    }
}
