//! A motion as it was recorded.

use std::io::Read;

use fingertip_recordings::{RecordingError, RecordingReader};
use fingertip_wrench::InertialReading;
use nalgebra::Vector6;

/// What a moving sensor and the inertial unit on it read at one time.
///
/// ```
/// use fingertip_calibration::inertial::{MovingSample, moving_samples};
/// use fingertip_recordings::RecordingReader;
///
/// // 4 N of weight, and what an accelerometer and a gyroscope read beside it.
/// let text = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,ax_m_per_s2,ay_m_per_s2,az_m_per_s2,wx_rad_per_s,wy_rad_per_s,\
///             wz_rad_per_s\n0,0,0,-4,0,0,0,0,0,9.81,0,0,0.1\n";
/// let mut rows = RecordingReader::new("hand.csv", text.as_bytes())?;
/// let (samples, left_out) = moving_samples(&mut rows, None, None)?;
/// let at_rest: &MovingSample = samples.first().ok_or("no row")?;
/// assert_eq!((left_out, at_rest.wrench.z), (0, -4.0));
/// assert_eq!((at_rest.reading.acceleration.z, at_rest.reading.angular_velocity.z), (9.81, 0.1));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingSample {
    /// Time \[s\].
    pub time: f64,
    /// The wrench as the load on the sensor \[N, N·m\].
    pub wrench: Vector6<f64>,
    /// The inertial unit, along its own axes.
    pub reading: InertialReading<f64>,
}

/// The rows of a recording that have a time, the wrench of a sensor and an inertial unit, and how many had not.
///
/// `sensor` is a name that the columns have; `None` for the only one. Of a recording without time the rows are taken to be
/// `1/sample_rate` apart \[Hz\].
///
/// # Errors
/// [`RecordingError`], also if there is no such column or no time.
pub fn moving_samples<R: Read>(
    reader: &mut RecordingReader<R>,
    sensor: Option<&str>,
    sample_rate: Option<f64>,
) -> Result<(Vec<MovingSample>, usize), RecordingError> {
    let found = match sensor {
        Some(sensor) => reader.layout().wrench(sensor),
        None => reader.layout().only_wrench(),
    };
    let wrench = found.cloned().map_err(|problem| reader.header_error(problem))?;
    let unit = reader.watch_inertial_unit(wrench.name()).map_err(|problem| reader.header_error(problem))?;
    let (mut samples, mut left_out, mut rows) = (Vec::new(), 0, 0_u64);
    while let Some(row) = reader.next_row()? {
        let time = row.time().or(sample_rate.map(|rate| rows as f64 / rate));
        rows += 1;
        match (time, row.wrench(&wrench), row.inertial(&unit)) {
            (Some(time), Some(wrench), Some(reading)) => {
                samples.push(MovingSample { time, wrench: wrench.components(), reading });
            }
            _ => left_out += 1,
        }
    }
    Ok((samples, left_out))
}
