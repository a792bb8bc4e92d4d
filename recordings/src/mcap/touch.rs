//! All that was felt of one sample, as one message.

use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use super::cdr::{CdrError, CdrReader, CdrWriter};

/// What a fingertip felt, in the frame of its sensor. What there is none of is NaN.
///
/// ```
/// use fingertip_recordings::mcap::{Header, Recorded, RecordedTouch};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // Nothing touches: there is no point, and so on.
/// let none = Vector3::repeat(f64::NAN);
/// let touch = RecordedTouch {
///     number: 7,
///     time: 0.007,
///     status: "no force".into(),
///     load: Wrench::zero(),
///     point: none,
///     normal: none,
///     normal_force: f64::NAN,
///     tangential_force: none,
///     spin_torque: f64::NAN,
///     margin: f64::NAN,
///     utilisation: f64::NAN,
///     slip: 1,
/// };
/// let message = Recorded::Touch(touch).emit(&Header::default());
/// let (_, read) = Recorded::parse("fingertip_msgs/msg/Touch", &message)?;
/// assert!(matches!(read, Recorded::Touch(touch) if touch.number == 7 && touch.point.x.is_nan()));
/// # Ok::<(), fingertip_recordings::mcap::CdrError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedTouch {
    /// Counted from the start, so that a gap shows.
    pub number: u64,
    /// On the clock of the sensor \[s\].
    pub time: f64,
    /// `contact`, or why there is none, as in `contacts.csv`.
    pub status: String,
    /// The load on the fingertip \[N, N·m\].
    pub load: Wrench<f64>,
    /// The contact point \[m\].
    pub point: Vector3<f64>,
    /// The outward normal.
    pub normal: Vector3<f64>,
    /// Positive when pressing \[N\].
    pub normal_force: f64,
    /// On the fingertip \[N\].
    pub tangential_force: Vector3<f64>,
    /// Along the outward normal \[N·m\].
    pub spin_torque: f64,
    /// To the friction limit \[N\], positive while the contact holds.
    pub margin: f64,
    /// How much of the limit is used: 1 at slip.
    pub utilisation: f64,
    /// 0 no verdict, 1 not pressing, 2 holding, 3 warning, 4 slipping.
    pub slip: u8,
}

impl RecordedTouch {
    pub(super) fn write(&self, to: &mut CdrWriter) {
        to.u64(self.number);
        to.f64(self.time);
        to.string(&self.status);
        to.wrench(&self.load);
        to.f64s(self.point.iter().copied());
        to.f64s(self.normal.iter().copied());
        to.f64(self.normal_force);
        to.f64s(self.tangential_force.iter().copied());
        to.f64s([self.spin_torque, self.margin, self.utilisation]);
        to.u8(self.slip);
    }

    pub(super) fn read(from: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        Ok(Self {
            number: from.u64()?,
            time: from.f64()?,
            status: from.string()?.to_owned(),
            load: from.wrench()?,
            point: from.f64s::<3>()?.into(),
            normal: from.f64s::<3>()?.into(),
            normal_force: from.f64()?,
            tangential_force: from.f64s::<3>()?.into(),
            spin_torque: from.f64()?,
            margin: from.f64()?,
            utilisation: from.f64()?,
            slip: from.u8()?,
        })
    }
}
