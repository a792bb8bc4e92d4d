//! Counts of six axes, and what they are in newtons and newton metres.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;
use thiserror::Error;

/// Counts per unit that cannot be.
///
/// ```
/// use fingertip_drivers::sensors::AxisCounts;
///
/// let told = AxisCounts::uniform(50.0, 0.0).unwrap_err().to_string();
/// assert_eq!(told, "axis 3: counts per newton or newton metre must be finite and not zero, and are 0");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("axis {axis}: counts per newton or newton metre must be finite and not zero, and are {found}")]
pub struct BadAxisCounts {
    /// Index of the axis: Fx, Fy, Fz, Tx, Ty, Tz from 0.
    pub axis: usize,
    /// The number.
    pub found: f64,
}

/// How many counts a newton (the first three axes) and a newton metre (the others) are. Negative ones
/// turn an axis round.
///
/// ```
/// use fingertip_drivers::sensors::AxisCounts;
/// use fingertip_wrench::Wrench;
///
/// let wrench: Wrench<f64> = AxisCounts::uniform(50.0, 2000.0)?.wrench([0, 0, -100, 0, 26, 0]);
/// assert!((wrench.force().z + 2.0).abs() < 1e-12 && (wrench.torque().y - 0.013).abs() < 1e-12);
/// # Ok::<(), fingertip_drivers::sensors::BadAxisCounts>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisCounts {
    per_count: [f64; 6],
}

impl AxisCounts {
    /// From counts per newton and per newton metre.
    ///
    /// # Errors
    /// [`BadAxisCounts`] for the first that is zero, not finite, or so small that its inverse is not.
    pub fn new(per_unit: [f64; 6]) -> Result<Self, BadAxisCounts> {
        let bad = per_unit.iter().position(|counts| !counts.is_finite() || !(1.0 / counts).is_finite());
        match bad {
            Some(axis) => Err(BadAxisCounts { axis, found: per_unit.get(axis).copied().unwrap_or(f64::NAN) }),
            None => Ok(Self { per_count: per_unit.map(|counts| 1.0 / counts) }),
        }
    }

    /// The same for three forces, and the same for three torques.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn uniform(per_newton: f64, per_newton_metre: f64) -> Result<Self, BadAxisCounts> {
        let (f, t) = (per_newton, per_newton_metre);
        Self::new([f, f, f, t, t, t])
    }

    /// Those of a data sheet, which are known to be finite and not zero.
    #[cfg(feature = "devices")]
    pub(crate) const fn of_data_sheet(per_newton: f64, per_newton_metre: f64) -> Self {
        let (f, t) = (1.0 / per_newton, 1.0 / per_newton_metre);
        Self { per_count: [f, f, f, t, t, t] }
    }

    /// The wrench of a reading, signs as the sensor has them.
    #[must_use]
    pub fn wrench<T: Real>(&self, counts: [i32; 6]) -> Wrench<T> {
        let mut si = [T::zero(); 6];
        for ((component, count), per_count) in si.iter_mut().zip(counts).zip(self.per_count) {
            *component = T::literal(f64::from(count) * per_count);
        }
        let [fx, fy, fz, tx, ty, tz] = si;
        Wrench::on_fingertip(Vector3::new(fx, fy, fz), Vector3::new(tx, ty, tz))
    }

    /// The nearest counts of a load \[N, N·m\], within the range of a converter of 16 bits.
    #[cfg(feature = "simulators")]
    #[expect(clippy::cast_possible_truncation, reason = "saturates, as a converter does")]
    pub(crate) fn of(&self, load: &[f64; 6]) -> [i16; 6] {
        let mut counts = [0; 6];
        for ((count, component), per_count) in counts.iter_mut().zip(load).zip(self.per_count) {
            *count = (component / per_count).round() as i16;
        }
        counts
    }

    /// Counts per newton and per newton metre.
    #[cfg(all(feature = "simulators", feature = "dynpick"))]
    pub(crate) fn per_unit(&self) -> [f64; 6] {
        self.per_count.map(f64::recip)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_become_newtons_or_are_refused() {
        let counts = AxisCounts::uniform(50.0, -2000.0).unwrap();
        let wrench: Wrench<f32> = counts.wrench([50, -100, 0, 1000, 0, i32::MIN]);
        assert_eq!(wrench.force(), Vector3::new(1.0, -2.0, 0.0));
        assert_eq!(wrench.torque(), Vector3::new(-0.5, 0.0, (2_147_483_648.0_f64 / 2000.0) as f32));
        for bad in [0.0, -0.0, f64::NAN, f64::INFINITY, 1e-310] {
            let error = AxisCounts::new([1.0, 1.0, 1.0, bad, 1.0, 1.0]).unwrap_err();
            assert_eq!(error.axis, 3);
        }
    }
}
