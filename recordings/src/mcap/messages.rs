//! The messages, to CDR and back.

use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use super::cdr::{CdrError, CdrReader, CdrWriter};
use super::definitions::{CONTACT, SIGNALS, TOUCH, WRENCH};
use super::touch::RecordedTouch;

/// When and where: the header of every message.
///
/// ```
/// use fingertip_recordings::mcap::Header;
///
/// let header = Header::stamped(12.25, "sensor").unwrap();
/// assert_eq!((header.seconds, header.nanoseconds), (12, 250_000_000));
/// assert_eq!(header.time(), 12.25);
/// assert_eq!(Header::stamped(-1.0, "sensor"), None);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Header {
    /// Seconds of the stamp.
    pub seconds: i32,
    /// Nanoseconds of the stamp.
    pub nanoseconds: u32,
    /// Name of the frame.
    pub frame: String,
}

impl Header {
    /// The stamp \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        let nanoseconds = i64::from(self.seconds) * 1_000_000_000 + i64::from(self.nanoseconds);
        if nanoseconds.unsigned_abs() < 1 << f64::MANTISSA_DIGITS {
            // Exact until it is divided: the number that is nearest to the stamp.
            #[allow(clippy::cast_precision_loss, reason = "checked to be none")]
            return nanoseconds as f64 / 1e9;
        }
        f64::from(self.seconds) + f64::from(self.nanoseconds) / 1e9
    }

    /// The stamp of a time \[s\], rounded to nanoseconds; `None` unless it is from 0 to 2147483647 s.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked to be in range")]
    pub fn stamped(time: f64, frame: &str) -> Option<Self> {
        if !(0.0..=f64::from(i32::MAX)).contains(&time) {
            return None;
        }
        // Rounded as a whole, so that 0.9999999999 s becomes a second.
        let whole = time.floor();
        let nanoseconds = ((time - whole) * 1e9).round() as u32;
        let carry = nanoseconds / 1_000_000_000;
        let seconds = (whole as i32).checked_add(i32::from(carry > 0))?;
        Some(Self { seconds, nanoseconds: nanoseconds % 1_000_000_000, frame: frame.to_owned() })
    }

    /// Nanoseconds since 0, as MCAP counts.
    pub(super) fn log_time(&self) -> u64 {
        u64::try_from(self.seconds).unwrap_or(0) * 1_000_000_000 + u64::from(self.nanoseconds)
    }

    /// Writes it, as the first field of a message.
    pub fn write(&self, to: &mut CdrWriter) {
        to.i32(self.seconds);
        to.u32(self.nanoseconds);
        to.string(&self.frame);
    }

    fn read(from: &mut CdrReader<'_>) -> Result<Self, CdrError> {
        Ok(Self { seconds: from.i32()?, nanoseconds: from.u32()?, frame: from.string()?.to_owned() })
    }
}

/// Signals of a sensor.
///
/// ```
/// use fingertip_recordings::mcap::{McapReader, McapWriter, Recorded, RecordedSignals};
/// use std::io::Cursor;
///
/// let signals = RecordedSignals { unit: "V".into(), values: vec![0.25, -0.5] };
/// let mut writer = McapWriter::new(Cursor::new(Vec::new()))?;
/// let topic = writer.signals("tip/signals", "sensor")?;
/// writer.write_signals(topic, 0.0, signals.clone())?;
/// let file = writer.finish()?.into_inner();
/// let entry = McapReader::new(&file[..])?.next_entry()?.unwrap();
/// assert_eq!(entry.recorded, Recorded::Signals(signals));
/// # Ok::<(), fingertip_recordings::mcap::McapError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordedSignals {
    /// What the numbers are: `V`, `counts`.
    pub unit: String,
    /// One number for each gauge.
    pub values: Vec<f64>,
}

/// A contact of a fingertip, in the frame of its sensor.
///
/// ```
/// use fingertip_recordings::mcap::{McapReader, McapWriter, Recorded, RecordedContact};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
/// use std::io::Cursor;
///
/// let contact = RecordedContact {
///     name: "thumb".into(),
///     position: Vector3::new(0.0, 0.0, 0.013),
///     normal: Vector3::z(),
///     wrench: Wrench::on_fingertip(Vector3::new(0.3, 0.0, -2.0), Vector3::zeros()),
/// };
/// let mut writer = McapWriter::new(Cursor::new(Vec::new()))?;
/// let topic = writer.contacts("thumb/contact", "thumb_sensor")?;
/// writer.write_contact(topic, 0.0, contact.clone())?;
/// let file = writer.finish()?.into_inner();
/// let entry = McapReader::new(&file[..])?.next_entry()?.unwrap();
/// assert_eq!(entry.recorded, Recorded::Contact(contact));
/// # Ok::<(), fingertip_recordings::mcap::McapError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedContact {
    /// Which fingertip.
    pub name: String,
    /// The contact point \[m\].
    pub position: Vector3<f64>,
    /// The outward normal.
    pub normal: Vector3<f64>,
    /// The load at the contact point: its force, and the spin torque as a vector.
    pub wrench: Wrench<f64>,
}

/// What one message holds.
///
/// ```
/// use fingertip_recordings::mcap::{Header, Recorded};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let wrench = Recorded::Wrench(Wrench::on_fingertip(Vector3::new(0.3, 0.0, -2.0), Vector3::zeros()));
/// let header = Header::stamped(0.5, "sensor").unwrap();
/// let message = wrench.emit(&header);
/// assert_eq!(Recorded::parse("geometry_msgs/msg/WrenchStamped", &message)?, (header, wrench));
/// assert_eq!(Recorded::parse("std_msgs/msg/String", &message)?.1, Recorded::Other);
/// # Ok::<(), fingertip_recordings::mcap::CdrError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Recorded {
    /// A wrench.
    Wrench(Wrench<f64>),
    /// Signals.
    Signals(RecordedSignals),
    /// A contact.
    Contact(RecordedContact),
    /// All that was felt.
    Touch(RecordedTouch),
    /// A message of another type, passed over.
    Other,
}

impl Recorded {
    /// The message in CDR; empty for another type.
    #[must_use]
    pub fn emit(&self, header: &Header) -> Vec<u8> {
        let mut to = CdrWriter::default();
        header.write(&mut to);
        match self {
            Self::Wrench(wrench) => to.wrench(wrench),
            Self::Signals(signals) => {
                to.string(&signals.unit);
                to.f64_sequence(&signals.values);
            }
            Self::Contact(contact) => {
                to.string(&contact.name);
                to.f64s(contact.position.iter().copied());
                to.f64s(contact.normal.iter().copied());
                to.wrench(&contact.wrench);
            }
            Self::Touch(touch) => touch.write(&mut to),
            Self::Other => return Vec::new(),
        }
        to.into_message()
    }

    /// Reads a message of a type by its name; [`Recorded::Other`] with an empty header for a type
    /// that is not known here.
    ///
    /// # Errors
    /// [`CdrError`].
    pub fn parse(name: &str, message: &[u8]) -> Result<(Header, Self), CdrError> {
        if ![WRENCH.name, SIGNALS.name, CONTACT.name, TOUCH.name].contains(&name) {
            return Ok((Header::default(), Self::Other));
        }
        let from = &mut CdrReader::new(message)?;
        let header = Header::read(from)?;
        let recorded = if name == WRENCH.name {
            Self::Wrench(from.wrench()?)
        } else if name == SIGNALS.name {
            Self::Signals(RecordedSignals { unit: from.string()?.to_owned(), values: from.f64_sequence()? })
        } else if name == TOUCH.name {
            Self::Touch(RecordedTouch::read(from)?)
        } else {
            Self::Contact(RecordedContact {
                name: from.string()?.to_owned(),
                position: from.f64s::<3>()?.into(),
                normal: from.f64s::<3>()?.into(),
                wrench: from.wrench()?,
            })
        };
        Ok((header, recorded))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn messages_are_read_as_they_were_written(
            time in 0.0..2e9, frame in "[a-z]{0,9}", numbers in prop::array::uniform12(-1e9..1e9_f64), values in prop::collection::vec(-1e9..1e9_f64, 0..9),
        ) {
            let header = Header::stamped(time, &frame).unwrap();
            prop_assert!((header.time() - time).abs() <= 0.5e-9 + time * f64::EPSILON);
            let [a, b, c, d, e, f, components @ ..] = numbers;
            let wrench = Wrench::from_components(&components.into());
            let contact = RecordedContact { name: frame.clone(), position: Vector3::new(a, b, c), normal: Vector3::new(d, e, f), wrench };
            let signals = RecordedSignals { unit: "V".to_owned(), values };
            let touch = RecordedTouch {
                number: 1 << 40, time, status: frame.clone(), load: wrench, point: contact.position, normal: contact.normal,
                normal_force: a, tangential_force: contact.normal, spin_torque: b, margin: c, utilisation: d, slip: 3,
            };
            for (name, recorded) in [(WRENCH.name, Recorded::Wrench(wrench)), (SIGNALS.name, Recorded::Signals(signals)), (CONTACT.name, Recorded::Contact(contact)), (TOUCH.name, Recorded::Touch(touch))] {
                let message = recorded.emit(&header);
                prop_assert_eq!(Recorded::parse(name, &message), Ok((header.clone(), recorded)));
                // Cut anywhere, it is none.
                for length in 0..message.len() {
                    prop_assert!(Recorded::parse(name, &message[..length]).is_err());
                }
            }
        }

        #[test]
        fn any_bytes_are_a_message_or_none(message in prop::collection::vec(any::<u8>(), 0..150), which in 0_usize..4) {
            let name = [WRENCH.name, SIGNALS.name, CONTACT.name, TOUCH.name][which];
            let _ = Recorded::parse(name, &message);
            let _ = Recorded::parse(name, &[&[0, 1, 0, 0][..], &message].concat());
        }
    }

    /// The time of a stamp is the number that its digits are nearest to, as long as nanoseconds can be told apart.
    #[test]
    fn times_of_stamps_are_right_to_the_last_digit() {
        for k in 0..1000_u32 {
            let (seconds, nanoseconds) =
                (k.wrapping_mul(7919) % 9_000_000, k.wrapping_mul(2_654_435_761) % 1_000_000_000);
            let header = Header { seconds: seconds as i32, nanoseconds, frame: String::new() };
            assert_eq!(header.time(), format!("{seconds}.{nanoseconds:09}").parse::<f64>().unwrap());
        }
        let late = Header { seconds: i32::MAX, nanoseconds: 500_000_000, frame: String::new() };
        assert_eq!(late.time(), 2_147_483_647.5);
    }

    #[test]
    fn times_that_a_stamp_cannot_hold_are_refused() {
        for time in [-1e-9, f64::NAN, f64::INFINITY, 2_147_483_648.0, 2_147_483_647.999_999_9] {
            let stamped = Header::stamped(time, "");
            assert_eq!(stamped, None, "{time}");
        }
        let nearly = Header::stamped(1.0 - 1e-12, "").unwrap();
        assert_eq!((nearly.seconds, nearly.nanoseconds), (1, 0));
    }
}
