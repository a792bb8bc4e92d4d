//! Noticing that a calibration is no longer true, from ordinary touches.

use fingertip_wrench::Wrench;
use nalgebra::Matrix6;
use statrs::distribution::{ChiSquared, ContinuousCDF as _};

/// Watches the pitch of point contacts: `T = (f·m)² / (mᵀΣ_ff m + 2 mᵀΣ_fm f + fᵀΣ_mm f)` follows χ²
/// with one degree of freedom as long as contacts are points and the calibration holds
/// (`docs/theory/calibration.md#point-contacts-in-use`).
///
/// One contact of a soft pad proves nothing; that all of the last hundred have pitch does. The window
/// forgets exponentially, so a drift is noticed however long the monitor ran before.
///
/// ```
/// use fingertip_calibration::in_situ::DriftMonitor;
/// use fingertip_calibration::nalgebra::{Matrix6, Vector3, Vector6};
/// use fingertip_wrench::Wrench;
///
/// // 10 mN and 0.1 N·mm of noise; the last hundred touches count.
/// let noise = Matrix6::from_diagonal(&Vector6::new(1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8));
/// let mut monitor = DriftMonitor::new(noise, 100.0).ok_or("no covariance")?;
/// let touch = |k: i32| {
///     let normal = Vector3::new(f64::from(k).sin(), f64::from(k).cos(), 1.0).normalize();
///     Wrench::from_force_at(&(normal * 0.012), normal * -2.0)
/// };
/// (0..200).for_each(|k| assert!(monitor.push(&touch(k))));
/// assert!(!monitor.verdict().ok_or("no touch")?.drifted);
/// // From now on a torque about the force is read that no point contact has: 0.5 N·mm.
/// (0..200).for_each(|k| {
///     let push = touch(k);
///     monitor.push(&Wrench::on_fingertip(push.force(), push.torque() + push.force() * 2.5e-4));
/// });
/// assert!(monitor.verdict().ok_or("no touch")?.drifted);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DriftMonitor {
    covariance: Matrix6<f64>,
    memory: f64,
    sum: f64,
    weight: f64,
    squares: f64,
    touches: u64,
}

/// What a drift monitor says.
///
/// ```
/// use fingertip_calibration::in_situ::{DriftMonitor, DriftVerdict};
/// use fingertip_calibration::nalgebra::{Matrix6, Vector3, Vector6};
/// use fingertip_wrench::Wrench;
///
/// // Forces without noise to speak of, torques with 0.1 N·mm; each touch has 0.3 N·mm along its force.
/// let noise = Matrix6::from_diagonal(&Vector6::new(1e-16, 1e-16, 1e-16, 1e-8, 1e-8, 1e-8));
/// let mut monitor = DriftMonitor::new(noise, 100.0).ok_or("no covariance")?;
/// for _ in 0..50 {
///     monitor.push(&Wrench::on_fingertip(-Vector3::z(), Vector3::z() * 3e-4));
/// }
/// // Three deviations are 9 times the variance.
/// let verdict: DriftVerdict = monitor.verdict().ok_or("no touch")?;
/// assert!((verdict.mean - 9.0).abs() < 1e-3 && verdict.touches == 50);
/// assert!(verdict.drifted && verdict.chance < 1e-6);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriftVerdict {
    /// Mean of T over the window: 1 for a true calibration.
    pub mean: f64,
    /// Chance of a mean as large without drift.
    pub chance: f64,
    /// Touches seen in all.
    pub touches: u64,
    /// `chance` below one in a million: recalibrate, or the contacts are no points.
    pub drifted: bool,
}

impl DriftMonitor {
    /// From the covariance of a measured wrench (\[N²\], \[N²·m\], \[N²·m²\]) and how many touches the window
    /// remembers (100, say). `None` if the covariance is not finite and positive on its diagonal, or the
    /// memory is less than one touch.
    #[must_use]
    pub fn new(covariance: Matrix6<f64>, memory: f64) -> Option<Self> {
        let right = covariance.iter().all(|x| x.is_finite())
            && covariance.diagonal().iter().all(|x| *x > 0.0)
            && memory >= 1.0
            && memory.is_finite();
        right.then_some(Self { covariance, memory, sum: 0.0, weight: 0.0, squares: 0.0, touches: 0 })
    }

    /// Takes one touch; `false`, and it is left out, if the wrench is not finite or zero.
    pub fn push(&mut self, wrench: &Wrench<f64>) -> bool {
        let (f, m) = (wrench.force(), wrench.torque());
        let gradient = nalgebra::Vector6::new(m.x, m.y, m.z, f.x, f.y, f.z);
        let variance = gradient.dot(&(self.covariance * gradient));
        let product = f.dot(&m);
        let statistic = product * product / variance;
        if !(variance > 0.0 && statistic.is_finite()) {
            return false;
        }
        let keep = 1.0 - 1.0 / self.memory;
        self.sum = keep * self.sum + statistic;
        self.weight = keep * self.weight + 1.0;
        self.squares = keep * keep * self.squares + 1.0;
        self.touches += 1;
        true
    }

    /// What the touches say; `None` before the first. The weighted sum of χ² is matched in mean and
    /// variance by a χ² with `weight² / Σw²` degrees of freedom (Satterthwaite 1946).
    #[must_use]
    pub fn verdict(&self) -> Option<DriftVerdict> {
        if self.touches == 0 {
            return None;
        }
        let mean = self.sum / self.weight;
        let freedom = self.weight * self.weight / self.squares;
        let chance = ChiSquared::new(freedom).ok()?.sf(mean * freedom);
        Some(DriftVerdict { mean, chance, touches: self.touches, drifted: chance < 1e-6 })
    }
}

#[cfg(test)]
mod tests {
    use super::DriftMonitor;
    use crate::fit::testing::gaussian;
    use fingertip_wrench::Wrench;
    use nalgebra::{Matrix6, Vector3, Vector6};
    use rand::SeedableRng as _;
    use rand_pcg::Pcg64Mcg;

    fn touch(random: &mut Pcg64Mcg, gain: f64) -> Wrench<f64> {
        let mut vector = || Vector3::from_fn(|_, _| gaussian(random));
        let (point, force) = (vector() * 0.01, vector() * 2.0);
        let wrench = Wrench::<f64>::from_force_at(&point, force).components();
        let mut noisy =
            Vector6::from_fn(|i, _| wrench[i] + gaussian(random) * if i < 3 { 0.01 } else { 1e-4 });
        noisy[3] *= gain;
        Wrench::from_components(&noisy)
    }

    /// Two touches worked out by hand.
    #[test]
    fn figures_are_those_of_the_formulas() {
        let mut covariance = Matrix6::from_diagonal(&Vector6::new(0.1, 0.1, 0.1, 0.05, 0.05, 0.05));
        covariance[(0, 3)] = 0.02;
        covariance[(3, 0)] = 0.02;
        let mut monitor = DriftMonitor::new(covariance, 2.0).unwrap();
        // f·m = 2, and the variance 0.1·2 + 0.05·4 + 2·0.02·2.
        assert!(
            monitor.push(&Wrench::on_fingertip(Vector3::new(2.0, 0.0, 0.0), Vector3::new(1.0, 1.0, 0.0)))
        );
        let close = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        };
        let one = monitor.verdict().unwrap();
        close(one.mean, 4.0 / 0.48);
        // erfc √(T/2).
        close(one.chance, 0.003_892_417_122_778_627);
        // 9 over 0.1·9 + 0.05; the first counts half.
        assert!(monitor.push(&Wrench::on_fingertip(Vector3::z(), Vector3::z() * 3.0)));
        let two = monitor.verdict().unwrap();
        close(two.mean, (0.5 * 4.0 / 0.48 + 9.0 / 0.95) / 1.5);
        // χ² with 1.5²/1.25 degrees of freedom.
        close(two.chance, 0.000_209_297_068_913_026);
        assert_eq!((one.touches, two.touches, two.drifted), (1, 2, false));
        // One in a million is at T = 23.93 of one degree.
        for (statistic, drifted) in [(23.9_f64, false), (23.96, true)] {
            let covariance = Matrix6::identity();
            let mut monitor = DriftMonitor::new(covariance, 1.0).unwrap();
            let size = (2.0 * statistic).sqrt();
            for sign in [1.0, -1.0] {
                assert!(
                    monitor.push(&Wrench::on_fingertip(Vector3::y() * size, Vector3::y() * (sign * size)))
                );
                let verdict = monitor.verdict().unwrap();
                assert_eq!(verdict.drifted, drifted, "{verdict:?}");
            }
        }
    }

    #[test]
    fn bad_numbers_are_refused() {
        let good = Matrix6::identity();
        assert!(DriftMonitor::new(good, 1.0).is_some());
        for memory in [0.999, 0.0, -5.0, f64::NAN, f64::INFINITY] {
            assert!(DriftMonitor::new(good, memory).is_none(), "{memory}");
        }
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let mut covariance = good;
            covariance[(4, 4)] = bad;
            assert!(DriftMonitor::new(covariance, 10.0).is_none(), "{bad}");
        }
        let mut monitor = DriftMonitor::new(good, 10.0).unwrap();
        for bad in [f64::NAN, f64::INFINITY, 1e200] {
            assert!(!monitor.push(&Wrench::on_fingertip(Vector3::x() * bad, Vector3::x())));
        }
        assert_eq!(monitor.verdict(), None);
    }

    #[test]
    fn drift_is_noticed_and_truth_is_not_accused() {
        let random = &mut Pcg64Mcg::seed_from_u64(5);
        let covariance = Matrix6::from_diagonal(&Vector6::new(1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8));
        let mut monitor = DriftMonitor::new(covariance, 100.0).unwrap();
        assert!(monitor.verdict().is_none());
        for _ in 0..20_000 {
            assert!(monitor.push(&touch(random, 1.0)));
            assert!(!monitor.verdict().unwrap().drifted);
        }
        assert!((monitor.verdict().unwrap().mean - 1.0).abs() < 0.5);
        // One gain drifts by 5 %.
        let mut needed = 0;
        while !monitor.verdict().unwrap().drifted {
            monitor.push(&touch(random, 1.05));
            needed += 1;
            assert!(needed < 500);
        }
        assert!(!monitor.push(&Wrench::on_fingertip(Vector3::zeros(), Vector3::zeros())));
        assert!(DriftMonitor::new(Matrix6::zeros(), 100.0).is_none());
    }
}
