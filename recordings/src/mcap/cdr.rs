//! The plain CDR of ROS 2 messages (OMG DDS-XTypes 1.3, section 7.4.1 "PLAIN_CDR", XCDR version 1).
//!
//! Four bytes say the encoding; behind them each number stands at a multiple of its size, counted from
//! there. A string is its length with the closing zero, and its bytes; a sequence its count, and its
//! elements.

use fingertip_wrench::Wrench;
use thiserror::Error;

/// Bytes that are not the message that is read.
///
/// ```
/// use fingertip_recordings::mcap::{CdrError, CdrReader, CdrWriter};
///
/// let mut writer = CdrWriter::default();
/// writer.u8(7);
/// let message = writer.into_message();
/// let mut reader = CdrReader::new(&message)?;
/// assert_eq!(reader.u8(), Ok(7));
/// let refused = reader.f64().unwrap_err();
/// assert!(matches!(refused, CdrError::Short { .. }));
/// assert!(refused.to_string().starts_with("the message ends at byte "));
/// # Ok::<(), CdrError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CdrError {
    /// The bytes end too soon, or a length in them is beyond them.
    #[error("the message ends at byte {at}, within a field")]
    Short {
        /// Where.
        at: usize,
    },
    /// Another encoding than plain CDR.
    #[error("{found:#06x} is not an encoding that is read (0 big-endian, 1 little-endian plain CDR)")]
    Encoding {
        /// What it says.
        found: u16,
    },
    /// A string is not UTF-8, or has no closing zero.
    #[error("the string that ends at byte {at} is none")]
    Text {
        /// Where.
        at: usize,
    },
}

/// Reads fields in their order.
///
/// ```
/// use fingertip_recordings::mcap::CdrReader;
///
/// // Little-endian plain CDR; a string of two letters, and a number at the next multiple of four.
/// let message = [0, 1, 0, 0, 3, 0, 0, 0, b'f', b'z', 0, 0, 42, 0, 0, 0];
/// let mut reader = CdrReader::new(&message)?;
/// assert_eq!(reader.string()?, "fz");
/// assert_eq!(reader.u32()?, 42);
/// # Ok::<(), fingertip_recordings::mcap::CdrError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CdrReader<'a> {
    body: &'a [u8],
    at: usize,
    big_endian: bool,
}

impl<'a> CdrReader<'a> {
    /// Over a message with its encoding.
    ///
    /// # Errors
    /// [`CdrError`].
    pub fn new(message: &'a [u8]) -> Result<Self, CdrError> {
        let (&[e0, e1, _, _], body) = message.split_first_chunk().ok_or(CdrError::Short { at: 0 })?;
        let big_endian = match u16::from_be_bytes([e0, e1]) {
            0 => true,
            1 => false,
            found => return Err(CdrError::Encoding { found }),
        };
        Ok(Self { body, at: 0, big_endian })
    }

    fn number<const SIZE: usize>(&mut self) -> Result<[u8; SIZE], CdrError> {
        let at = self.at.next_multiple_of(SIZE);
        let rest = self.body.get(at..).and_then(<[u8]>::first_chunk::<SIZE>);
        let mut bytes = *rest.ok_or(CdrError::Short { at })?;
        self.at = at + SIZE;
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// An `int32`.
    ///
    /// # Errors
    /// [`CdrError::Short`].
    pub fn i32(&mut self) -> Result<i32, CdrError> {
        self.number().map(i32::from_le_bytes)
    }

    /// A `uint32`.
    ///
    /// # Errors
    /// [`CdrError::Short`].
    pub fn u32(&mut self) -> Result<u32, CdrError> {
        self.number().map(u32::from_le_bytes)
    }

    /// A `uint8`.
    ///
    /// # Errors
    /// [`CdrError::Short`].
    pub fn u8(&mut self) -> Result<u8, CdrError> {
        self.number().map(u8::from_le_bytes)
    }

    /// A `uint64`.
    ///
    /// # Errors
    /// [`CdrError::Short`].
    pub fn u64(&mut self) -> Result<u64, CdrError> {
        self.number().map(u64::from_le_bytes)
    }

    /// A `float64`.
    ///
    /// # Errors
    /// [`CdrError::Short`].
    pub fn f64(&mut self) -> Result<f64, CdrError> {
        self.number().map(f64::from_le_bytes)
    }

    /// Some `float64` one after another.
    ///
    /// # Errors
    /// [`CdrError::Short`].
    pub fn f64s<const N: usize>(&mut self) -> Result<[f64; N], CdrError> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f64()?;
        }
        Ok(numbers)
    }

    /// A `geometry_msgs/Wrench`.
    pub(super) fn wrench(&mut self) -> Result<Wrench<f64>, CdrError> {
        let components: [f64; 6] = self.f64s()?;
        Ok(Wrench::from_components(&components.into()))
    }

    /// A sequence of `float64`.
    ///
    /// # Errors
    /// [`CdrError::Short`], before anything is allocated for a count that cannot be.
    pub fn f64_sequence(&mut self) -> Result<Vec<f64>, CdrError> {
        let count = self.u32()? as usize;
        if count > self.body.len().saturating_sub(self.at) / 8 {
            return Err(CdrError::Short { at: self.at });
        }
        (0..count).map(|_| self.f64()).collect()
    }

    /// A `string`.
    ///
    /// # Errors
    /// [`CdrError`].
    pub fn string(&mut self) -> Result<&'a str, CdrError> {
        let length = self.u32()? as usize;
        let end = self.at.saturating_add(length);
        let bytes = self.body.get(self.at..end).ok_or(CdrError::Short { at: self.at })?;
        self.at = end;
        // Some writers give an empty string as no bytes at all.
        let text = if bytes.is_empty() { Some(bytes) } else { bytes.strip_suffix(&[0]) };
        text.and_then(|text| core::str::from_utf8(text).ok()).ok_or(CdrError::Text { at: end })
    }
}

/// Writes fields in their order, little-endian.
///
/// ```
/// use fingertip_recordings::mcap::CdrWriter;
///
/// let mut writer = CdrWriter::default();
/// writer.u8(7);
/// writer.i32(-1); // from the next multiple of four on
/// assert_eq!(writer.into_message(), [0, 1, 0, 0, 7, 0, 0, 0, 255, 255, 255, 255]);
/// ```
#[derive(Clone, Debug)]
pub struct CdrWriter {
    message: Vec<u8>,
}

impl Default for CdrWriter {
    fn default() -> Self {
        Self { message: vec![0, 1, 0, 0] }
    }
}

impl CdrWriter {
    fn number<const SIZE: usize>(&mut self, bytes: [u8; SIZE]) {
        let body = self.message.len() - 4;
        self.message.resize(4 + body.next_multiple_of(SIZE), 0);
        self.message.extend(bytes);
    }

    /// An `int32`.
    pub fn i32(&mut self, number: i32) {
        self.number(number.to_le_bytes());
    }

    /// A `uint32`.
    pub fn u32(&mut self, number: u32) {
        self.number(number.to_le_bytes());
    }

    /// A `uint8`.
    pub fn u8(&mut self, number: u8) {
        self.number([number]);
    }

    /// A `uint64`.
    pub fn u64(&mut self, number: u64) {
        self.number(number.to_le_bytes());
    }

    /// A `float32`.
    pub fn f32(&mut self, number: f32) {
        self.number(number.to_le_bytes());
    }

    /// A `float64`.
    pub fn f64(&mut self, number: f64) {
        self.number(number.to_le_bytes());
    }

    /// A `geometry_msgs/Wrench`.
    pub(super) fn wrench(&mut self, wrench: &Wrench<f64>) {
        self.f64s(wrench.components().iter().copied());
    }

    /// Some `float64` one after another.
    pub fn f64s(&mut self, numbers: impl IntoIterator<Item = f64>) {
        for number in numbers {
            self.f64(number);
        }
    }

    /// A sequence of `float64`; what is beyond 2³² elements is left out.
    pub fn f64_sequence(&mut self, numbers: &[f64]) {
        let count = u32::try_from(numbers.len()).unwrap_or(u32::MAX);
        self.u32(count);
        self.f64s(numbers.iter().take(count as usize).copied());
    }

    /// A `string`; what is behind a zero in it is left out, since readers would not see it.
    pub fn string(&mut self, text: &str) {
        let text = text.split('\0').next().unwrap_or_default();
        self.u32(u32::try_from(text.len() + 1).unwrap_or(u32::MAX));
        self.message.extend(text.bytes().chain([0]));
    }

    /// The message.
    #[must_use]
    pub fn into_message(self) -> Vec<u8> {
        self.message
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn fields_are_aligned_behind_the_encoding() {
        let mut writer = CdrWriter::default();
        writer.string("ab");
        writer.f64(1.0);
        writer.i32(-1);
        let expected = [
            &[0, 1, 0, 0, 3, 0, 0, 0, b'a', b'b', 0, 0, 0, 0, 0, 0, 0, 0, 0, 0][..],
            &1.0_f64.to_le_bytes()[4..],
            &[255; 4],
        ];
        // A string of three bytes ends at 7; the next multiple of 8 is 8.
        let message = writer.into_message();
        assert_eq!(message[..12], [0, 1, 0, 0, 3, 0, 0, 0, b'a', b'b', 0, 0]);
        assert_eq!(message.len(), 4 + 8 + 8 + 4);
        assert_eq!(message[20..], *expected[2]);
    }

    #[test]
    fn both_orders_of_bytes_are_read() {
        let big = [0, 0, 0, 0, 0, 0, 0, 3, b'a', b'b', 0, 0, 0x3F, 0xF0, 0, 0, 0, 0, 0, 0];
        let mut reader = CdrReader::new(&big).unwrap();
        assert_eq!((reader.string(), reader.f64()), (Ok("ab"), Ok(1.0)));
        assert_eq!(reader.i32(), Err(CdrError::Short { at: 16 }));
        assert_eq!(CdrReader::new(&[0, 7, 0, 0]).map(|_| ()), Err(CdrError::Encoding { found: 7 }));
    }

    proptest! {
        #[test]
        fn fields_are_read_as_they_were_written(
            text in "[a-zα-ω]{0,20}", a in any::<i32>(), b in any::<u32>(), numbers in prop::collection::vec(-1e300..1e300, 0..20),
        ) {
            let mut writer = CdrWriter::default();
            writer.i32(a);
            writer.string(&text);
            writer.f64_sequence(&numbers);
            writer.u32(b);
            writer.u8(7);
            writer.u64(u64::from(b) << 32 | 5);
            writer.f64s([0.5, -2.0]);
            let message = writer.into_message();
            let mut reader = CdrReader::new(&message).unwrap();
            prop_assert_eq!(reader.i32(), Ok(a));
            prop_assert_eq!(reader.string(), Ok(text.as_str()));
            prop_assert_eq!(reader.f64_sequence(), Ok(numbers));
            prop_assert_eq!(reader.u32(), Ok(b));
            prop_assert_eq!((reader.u8(), reader.u64()), (Ok(7), Ok(u64::from(b) << 32 | 5)));
            prop_assert_eq!(reader.f64s(), Ok([0.5, -2.0]));
        }

        #[test]
        fn any_bytes_are_fields_or_none(mut message in prop::collection::vec(any::<u8>(), 0..80), headed in any::<bool>()) {
            if headed && message.len() > 1 {
                message[0] = 0;
                message[1] %= 2;
            }
            let Ok(mut reader) = CdrReader::new(&message) else { return Ok(()) };
            let _ = (reader.string(), reader.f64_sequence(), reader.u32(), reader.f64s::<3>(), reader.i32());
        }
    }
}
