//! A motion behind one filter for all of its channels.

use fingertip_wrench::{InertialUnit, StateFilter};
use nalgebra::{Matrix3, SVector, Vector3, Vector6};

use super::error::InertialError;
use super::samples::MovingSample;

/// A longer step is a pause, behind which the filter begins anew \[s\].
const PAUSE: f64 = 0.5;
/// So many time constants behind a beginning, what it was taken for is forgotten: `11 e⁻¹⁰` of it is left.
const SETTLING: f64 = 10.0;
/// Wrench, acceleration, angular velocity, and the six products of the angular velocity with itself.
const CHANNELS: usize = 18;

/// What the load of a body depends on, filtered: everything the load is linear in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moving {
    /// Of the accelerometer where it sits, along the axes of the sensor \[m/s²\].
    pub(super) acceleration: Vector3<f64>,
    /// `ω ωᵀ` \[rad²/s²\].
    pub(super) products: Matrix3<f64>,
    /// \[rad/s²\].
    pub(super) angular_acceleration: Vector3<f64>,
}

/// One sample behind the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Smooth {
    pub(super) time: f64,
    pub(super) wrench: Vector6<f64>,
    pub(super) moving: Moving,
    /// Whether the filter has settled.
    pub(super) settled: bool,
}

impl Moving {
    fn between(&self, other: &Self, share: f64) -> Self {
        Self {
            acceleration: self.acceleration.lerp(&other.acceleration, share),
            products: self.products + (other.products - self.products) * share,
            angular_acceleration: self.angular_acceleration.lerp(&other.angular_acceleration, share),
        }
    }
}

/// The whole motion, filtered with one time constant \[s\].
pub(super) fn smoothed(
    samples: &[MovingSample],
    unit: &InertialUnit<f64>,
    time_constant: f64,
) -> Result<Vec<Smooth>, InertialError> {
    let mut filter = StateFilter::<f64, CHANNELS>::new(time_constant)?;
    let mut smooth = Vec::with_capacity(samples.len());
    let (mut before, mut begun) = (f64::NAN, f64::NAN);
    for (number, sample) in samples.iter().enumerate() {
        let step = sample.time - before;
        if !(0.0..=PAUSE).contains(&step) {
            filter.start_anew();
            begun = sample.time;
        }
        let acceleration = unit.sensor_from_unit() * sample.reading.acceleration;
        let turning = unit.turning(&sample.reading);
        let [x, y, z] = turning.into();
        let products = [x * x, x * y, x * z, y * y, y * z, z * z];
        let mut input = SVector::<f64, CHANNELS>::zeros();
        input.fixed_rows_mut::<6>(0).copy_from(&sample.wrench);
        input.fixed_rows_mut::<3>(6).copy_from(&acceleration);
        input.fixed_rows_mut::<3>(9).copy_from(&turning);
        input.fixed_rows_mut::<6>(12).copy_from_slice(&products);
        let given = filter.follow(&input, step).filter(|_| sample.time.is_finite());
        let (value, slope) = given.ok_or(InertialError::NotFinite { sample: number })?;
        let p = |k: usize| value[12 + k];
        smooth.push(Smooth {
            time: sample.time,
            wrench: value.fixed_rows::<6>(0).into_owned(),
            moving: Moving {
                acceleration: value.fixed_rows::<3>(6).into_owned(),
                products: Matrix3::new(p(0), p(1), p(2), p(1), p(3), p(4), p(2), p(4), p(5)),
                angular_acceleration: slope.fixed_rows::<3>(9).into_owned(),
            },
            settled: sample.time - begun >= SETTLING * time_constant,
        });
        before = sample.time;
    }
    Ok(smooth)
}

/// How the sensor moved at a time, by a straight line between samples; `None` outside, across a pause, and where the filter
/// had not settled.
pub(super) fn moving_at(smooth: &[Smooth], time: f64) -> Option<Moving> {
    let behind = smooth.partition_point(|sample| sample.time < time);
    let (before, after) = (smooth.get(behind.checked_sub(1)?)?, smooth.get(behind)?);
    let step = after.time - before.time;
    if !(before.settled && after.settled && step > 0.0 && step <= PAUSE) {
        return None;
    }
    Some(before.moving.between(&after.moving, (time - before.time) / step))
}
