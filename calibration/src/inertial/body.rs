//! Whether mass, centre and inertia can be those of a body.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};

use super::regressor::{ENTRIES, Parameters};

/// Mass, centre and inertia.
///
/// ```
/// use fingertip_calibration::inertial::Body;
/// use fingertip_calibration::nalgebra::{Matrix3, Vector3};
///
/// // A flat disc of 0.2 kg and 50 mm: m r²/4 across and m r²/2 about its axis.
/// let moment = 0.2 * 0.05_f64.powi(2);
/// let inertia = Matrix3::from_diagonal(&Vector3::new(moment / 4.0, moment / 4.0, moment / 2.0));
/// let disc = Body { mass: 0.2, centre: Vector3::zeros(), inertia };
/// assert!(disc.consistency().least_moment.abs() < 1e-12);
/// // Measured a little too small across, it could not be, and is mended.
/// let mut measured = disc;
/// measured.inertia[(0, 0)] *= 0.9;
/// assert!(measured.consistency().least_moment < -1e-6);
/// assert!(measured.made_consistent().consistency().least_moment > -1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// \[kg\].
    pub mass: f64,
    /// Centre of mass in the sensor frame \[m\].
    pub centre: Vector3<f64>,
    /// Inertia about the centre of mass, along the axes of the sensor \[kg·m²\].
    pub inertia: Matrix3<f64>,
}

/// Whether an inertia can be that of heavy points: no principal moment negative, none larger than the other two together
/// (Traversaro, Brossette, Escande & Nori 2016; Wensing, Kim & Slotine 2018).
///
/// ```
/// use fingertip_calibration::inertial::{Body, Consistency};
/// use fingertip_calibration::nalgebra::{Matrix3, Vector3};
///
/// // No body has a moment about z that is larger than those about x and y together.
/// let of = |diagonal: [f64; 3]| -> Consistency {
///     let inertia = Matrix3::from_diagonal(&Vector3::from(diagonal));
///     Body { mass: 0.2, centre: Vector3::zeros(), inertia }.consistency()
/// };
/// assert!(of([1e-4, 1e-4, 1.5e-4]).least_moment > 0.0);
/// assert!(of([1e-4, 1e-4, 2.5e-4]).least_moment < 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Consistency {
    /// The least second moment along any direction, `½(I₂ + I₃ − I₁)` of the principal moments \[kg·m²\]: negative if no
    /// body has such an inertia.
    pub least_moment: f64,
}

impl Body {
    pub(super) fn of(parameters: &Parameters) -> Self {
        let mass = parameters[0];
        let moment = parameters.fixed_rows::<3>(1).into_owned();
        let centre = moment / mass;
        let mut inertia = Matrix3::zeros();
        for (k, (i, j)) in ENTRIES.into_iter().enumerate() {
            inertia[(i, j)] = parameters[4 + k];
            inertia[(j, i)] = parameters[4 + k];
        }
        Self { mass, centre, inertia: inertia - of_a_point(mass, &centre) }
    }

    /// Whether its inertia can be.
    #[must_use]
    pub fn consistency(&self) -> Consistency {
        Consistency { least_moment: second_moments(&self.inertia).0.min() }
    }

    /// The same with the nearest inertia that a body can have: second moments that are negative become zero.
    #[must_use]
    pub fn made_consistent(&self) -> Self {
        let (values, axes) = second_moments(&self.inertia);
        let moments = axes * Matrix3::from_diagonal(&values.map(|value| value.max(0.0))) * axes.transpose();
        let inertia = Matrix3::identity() * moments.trace() - moments;
        Self { inertia: (inertia + inertia.transpose()) * 0.5, ..*self }
    }
}

/// The inertia about the origin of a point of this mass.
pub(super) fn of_a_point(mass: f64, centre: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * centre.norm_squared() - centre * centre.transpose()) * mass
}

/// Eigenvalues and axes of `∫ x xᵀ dm = ½ tr(J) 1 − J`.
fn second_moments(inertia: &Matrix3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let eigen = SymmetricEigen::new(Matrix3::identity() * (0.5 * inertia.trace()) - inertia);
    (eigen.eigenvalues, eigen.eigenvectors)
}

#[cfg(test)]
mod tests {
    use fingertip_test_support::MovingBody;

    use super::*;

    #[test]
    fn an_inertia_of_points_is_one_and_others_are_brought_to_one() {
        let (mass, centre, inertia) = MovingBody::swung().mass_properties();
        let body = Body { mass, centre, inertia };
        assert!(body.consistency().least_moment > 0.0);
        assert!((body.made_consistent().inertia - inertia).amax() < 1e-15);
        // A moment larger than the other two together; and a negative one.
        for moments in [Vector3::new(3.0, 1.0, 1.0), Vector3::new(1.0, 1.0, -0.5)] {
            let turn = nalgebra::Rotation3::from_euler_angles(0.4, 1.0, -2.0);
            let bad = Body { inertia: turn * Matrix3::from_diagonal(&moments) * turn.inverse(), ..body };
            assert!(bad.consistency().least_moment < -0.2);
            let good = bad.made_consistent();
            assert!(good.consistency().least_moment > -1e-12);
            let principal = SymmetricEigen::new(good.inertia).eigenvalues;
            assert!(principal.max() <= 0.5 * principal.sum() + 1e-12 && principal.min() > -1e-12);
            // No other body has second moments that are nearer.
            let moments_of = |inertia: Matrix3<f64>| Matrix3::identity() * (0.5 * inertia.trace()) - inertia;
            let distance = moments_of(good.inertia - bad.inertia).norm();
            for k in 0..200 {
                let k = f64::from(k);
                let point = Vector3::new((3.1 * k).sin(), (5.7 * k).cos(), (7.9 * k).sin()) * 0.3;
                let other = good.inertia * (0.6 + 0.8 * k.cos().abs()) + of_a_point(0.3, &point);
                assert!(moments_of(other - bad.inertia).norm() >= distance - 1e-12);
            }
        }
    }
}
