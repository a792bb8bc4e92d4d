//! Numbers of few digits without an exponent, which most cells of a recording hold.

/// Powers of ten that double precision holds exactly; more digits than the last has are not read here.
const POWERS: [f64; 16] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// The number of a text of an optional minus, one to fifteen digits and at most one point among or beside them; `None` for
/// what is written otherwise.
///
/// Digits and power of ten are exact, so that their one division rounds as the number itself would be rounded (Clinger 1990).
#[inline]
pub(super) fn read(text: &[u8]) -> Option<f64> {
    let (negative, digits) = match text {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, text),
    };
    if digits.len() > POWERS.len() {
        return None;
    }
    let (mut whole, mut behind, mut point) = (0_u64, 0, None);
    for (place, byte) in digits.iter().enumerate() {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            whole = 10 * whole + u64::from(digit);
        } else if *byte == b'.' && point.is_none() {
            point = Some(place);
        } else {
            return None;
        }
    }
    let count = digits.len() - usize::from(point.is_some());
    if count == 0 || count >= POWERS.len() {
        return None;
    }
    if let Some(place) = point {
        behind = digits.len() - 1 - place;
    }
    let number = whole as f64 / POWERS.get(behind)?;
    Some(if negative { -number } else { number })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::read;

    proptest! {
        /// The standard library rounds correctly.
        #[test]
        fn numbers_are_those_of_the_standard_library(text in "-?[0-9]{0,16}(\\.[0-9]{0,16})?") {
            let digits = text.bytes().filter(u8::is_ascii_digit).count();
            let expected: Option<f64> = text.parse().ok();
            match read(text.as_bytes()) {
                Some(number) => prop_assert_eq!(Some(number.to_bits()), expected.map(f64::to_bits)),
                None => prop_assert!(digits == 0 || digits > 15),
            }
        }

        #[test]
        fn nothing_else_is_read(text in "[-+.0-9eEinfax_ ]{0,8}") {
            if let Some(number) = read(text.as_bytes()) {
                prop_assert_eq!(Ok(number.to_bits()), text.parse().map(f64::to_bits));
            }
        }
    }

    #[test]
    fn forms_of_numbers() {
        for (text, expected) in [
            ("0", Some(0.0)),
            ("-0.0", Some(-0.0)),
            ("5.", Some(5.0)),
            (".5", Some(0.5)),
            ("-0.0072711", Some(-0.007_271_1)),
            ("999999999999999", Some(999_999_999_999_999.0)),
            ("0.99999999999999", Some(0.999_999_999_999_99)),
            ("0000000000000001", None),
            ("1.2.3", None),
            ("", None),
            ("-", None),
            (".", None),
            ("-.", None),
            ("+1", None),
            ("1e3", None),
            ("--1", None),
            (" 1", None),
        ] {
            assert_eq!(read(text.as_bytes()).map(f64::to_bits), expected.map(f64::to_bits), "“{text}”");
        }
    }
}
