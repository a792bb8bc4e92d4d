//! What the sensor says of its counts per unit.

use thiserror::Error;

use crate::sensors::axis_counts::{AxisCounts, BadAxisCounts};

/// An answer that gives no sensitivities.
///
/// ```
/// use fingertip_drivers::sensors::dynpick::{Sensitivities, SensitivitiesError};
///
/// let refused = Sensitivities::parse(b"24.9,24.8,25.0\r\n").unwrap_err();
/// assert_eq!(refused, SensitivitiesError::Count { found: 3 });
/// assert_eq!(refused.to_string(), "the answer has 3 numbers between commas where six are needed");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SensitivitiesError {
    /// It is not ASCII text.
    #[error("the answer is no text")]
    NoText,
    /// It has not six numbers between commas.
    #[error("the answer has {found} numbers between commas where six are needed")]
    Count {
        /// How many there are.
        found: usize,
    },
    /// A number cannot be read.
    #[error("number {index} of the answer cannot be read")]
    Number {
        /// Which, from 0.
        index: usize,
    },
    /// A number cannot be a sensitivity.
    #[error(transparent)]
    Bad(#[from] BadAxisCounts),
}

/// Counts per newton and per newton metre of the six axes, as the sensor sends them: six decimal
/// numbers, commas between them, a line end.
///
/// ```
/// use fingertip_drivers::sensors::dynpick::{DynPickDecoder, Sensitivities};
/// use fingertip_wrench::Wrench;
///
/// let told = Sensitivities::parse(b"024.90,024.80,025.00,1664.0,1640.0,1660.0\r\n")?;
/// let wrench: Wrench<f64> = told.counts().wrench([0, 0, -50, 0, 0, 0]);
/// assert!((wrench.force().z + 2.0).abs() < 1e-12);
/// let decoder = DynPickDecoder::new(told.counts());
/// # let _ = decoder;
/// # Ok::<(), fingertip_drivers::sensors::dynpick::SensitivitiesError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivities(AxisCounts);

impl Sensitivities {
    /// Reads the answer.
    ///
    /// # Errors
    /// [`SensitivitiesError`].
    pub fn parse(answer: &[u8]) -> Result<Self, SensitivitiesError> {
        let text = core::str::from_utf8(answer).map_err(|_| SensitivitiesError::NoText)?;
        let text = text.trim_matches(|c: char| c.is_ascii_whitespace() || c == '\0');
        let found = text.split(',').count();
        if found != 6 {
            return Err(SensitivitiesError::Count { found });
        }
        let mut per_unit = [0.0; 6];
        for (index, (number, text)) in per_unit.iter_mut().zip(text.split(',')).enumerate() {
            *number = text.trim().parse().map_err(|_| SensitivitiesError::Number { index })?;
        }
        Ok(Self(AxisCounts::new(per_unit)?))
    }

    /// For a decoder.
    #[must_use]
    pub const fn counts(&self) -> AxisCounts {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fingertip_wrench::Wrench;
    use proptest::prelude::*;

    #[test]
    fn the_answer_of_a_sensor_is_read() {
        let answer = b"024.90,024.60,024.50,1664.7,1639.7,1638.0\r\n";
        let wrench: Wrench<f64> =
            Sensitivities::parse(answer).unwrap().counts().wrench([249, 0, 0, 0, 0, 1638]);
        assert!((wrench.force().x - 10.0).abs() < 1e-12 && (wrench.torque().z - 1.0).abs() < 1e-12);
        assert_eq!(Sensitivities::parse(b"1,2,3"), Err(SensitivitiesError::Count { found: 3 }));
        assert_eq!(Sensitivities::parse(b"1,2,3,4,5,x"), Err(SensitivitiesError::Number { index: 5 }));
        assert!(matches!(Sensitivities::parse(b"1,2,0,4,5,6"), Err(SensitivitiesError::Bad(_))));
        assert_eq!(Sensitivities::parse(&[255, 0]), Err(SensitivitiesError::NoText));
    }

    proptest! {
        #[test]
        fn any_bytes_are_sensitivities_or_none(answer in prop::collection::vec(any::<u8>(), 0..60), text in "[0-9.,einfa+-]{0,50}") {
            let _ = Sensitivities::parse(&answer);
            let _ = Sensitivities::parse(text.as_bytes());
        }
    }
}
