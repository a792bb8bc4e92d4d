//! Dual numbers as scalars.

use num_dual::Dual64;

use crate::Real;

/// A number and its derivative: every routine of the workspace, run on it, differentiates itself.
/// The tests hold the analytic Jacobians against it; users can take derivatives that we do not
/// offer.
///
/// Comparisons look at the value only, so the derivative is that of the branch taken. Scale
/// factors are constants, because they cancel.
impl Real for Dual64 {
    const EPSILON: Self = Self { re: f64::EPSILON, eps: 0.0 };
    const LEAST_NORMAL: Self = Self { re: f64::MIN_POSITIVE, eps: 0.0 };
    const GREATEST: Self = Self { re: f64::MAX, eps: 0.0 };
    const CARRIES_MORE: bool = true;

    #[inline]
    fn literal(value: f64) -> Self {
        Self::from_re(value)
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self.re
    }

    #[inline]
    fn normalising_factor(self) -> Self {
        Self::from_re(self.re.normalising_factor())
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use num_dual::Dual64;

    use crate::{Real, Wrench};

    #[test]
    fn a_line_of_action_differentiates_itself() {
        let number = Dual64::literal;
        // A force of 2 N along −z at the height x = 0.1 m: doubling the torque doubles the arm.
        let force = Vector3::new(number(0.0), number(0.0), number(-2.0));
        let torque = Vector3::new(number(0.0), Dual64::new(0.2, 1.0), number(0.0));
        let axis = Wrench::<Dual64>::on_fingertip(force, torque).line_of_action().unwrap();
        assert!((axis.line.point.x.re - 0.1).abs() < 1e-15);
        assert!((axis.line.point.x.eps - 0.5).abs() < 1e-15);
    }
}
