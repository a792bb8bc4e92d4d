//! Numbers of few digits without an exponent, which nearly all cells of a recording hold, all digits at once.

/// Powers of ten; double precision holds each exactly.
const POWERS: [f64; 17] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16];
/// Up to here double precision holds every whole number.
const EXACT: u64 = 1 << 53;
/// A byte in each of sixteen places.
const fn each(byte: u8) -> u128 {
    u128::from_be_bytes([byte; 16])
}

/// The number of a text of an optional minus, digits, and at most one point before, among or behind them, sixteen bytes without
/// the minus at most; `None` for what is written otherwise, or has more digits than are exact.
///
/// Digits and power of ten are exact, so that their one division rounds as the number itself would be rounded (Clinger 1990).
#[inline]
pub(super) fn read(text: &[u8]) -> Option<f64> {
    let (negative, text) = match text {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, text),
    };
    let letters = letters(text)?;
    // The lowest byte that is a point has its high bit set here, and none below it: what is behind the point.
    let points = letters ^ each(b'.');
    let points = points.wrapping_sub(each(1)) & !points & each(0x80);
    let (digits, behind, count) = if points == 0 {
        (letters, 0, text.len())
    } else {
        let behind = points.trailing_zeros() & !7;
        let below = (1_u128 << behind) - 1;
        // The point goes, and what stands before it takes its place.
        ((letters & below) | ((letters >> 8) & !below), behind / 8, text.len() - 1)
    };
    if count == 0 {
        return None;
    }
    let digits = digits ^ (each(b'0') >> (8 * (16 - count)));
    // A byte above nine reaches the high bit, or had it.
    if (digits | digits.wrapping_add(each(0x76))) & each(0x80) != 0 {
        return None;
    }
    let whole = 100_000_000 * eight((digits >> 64) as u64) + eight(digits as u64);
    if whole > EXACT {
        return None;
    }
    let number = whole as f64 / POWERS.get(behind as usize)?;
    Some(if negative { -number } else { number })
}

/// One to sixteen bytes, the last one lowest: pieces of fixed length, which may overlap.
#[inline]
fn letters(text: &[u8]) -> Option<u128> {
    let bits = 8 * text.len();
    Some(match text.len() {
        8..=16 => {
            let (first, last) = (text.first_chunk()?, text.last_chunk()?);
            u128::from(u64::from_be_bytes(*first)) << (bits - 64) | u128::from(u64::from_be_bytes(*last))
        }
        4..=7 => {
            let (first, last) = (text.first_chunk()?, text.last_chunk()?);
            u128::from(u32::from_be_bytes(*first)) << (bits - 32) | u128::from(u32::from_be_bytes(*last))
        }
        1..=3 => text.iter().fold(0, |letters, byte| letters << 8 | u128::from(*byte)),
        _ => return None,
    })
}

/// The number of eight digits, a byte each, the last one lowest: pairs, fours and all.
#[inline]
const fn eight(digits: u64) -> u64 {
    let pairs = 10 * ((digits >> 8) & 0x00ff_00ff_00ff_00ff) + (digits & 0x00ff_00ff_00ff_00ff);
    let fours = 100 * ((pairs >> 16) & 0x0000_ffff_0000_ffff) + (pairs & 0x0000_ffff_0000_ffff);
    10_000 * (fours >> 32) + (fours & 0xffff_ffff)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::read;

    /// Of the standard library, which rounds correctly.
    fn parsed(text: &str) -> Option<u64> {
        text.parse().ok().map(f64::to_bits)
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_standard_library(text in "-?[0-9]{0,17}(\\.[0-9]{0,17})?") {
            match read(text.as_bytes()) {
                Some(number) => prop_assert_eq!(Some(number.to_bits()), parsed(&text)),
                // Too long, too many digits, or none.
                None => prop_assert!(text.len() > 15 || !text.bytes().any(|byte| byte.is_ascii_digit())),
            }
        }

        #[test]
        fn nothing_else_is_read(text in "[-+.0-9eEinfax_, ]{0,17}", bytes: [u8; 16], length in 0..17_usize) {
            if let Some(number) = read(text.as_bytes()) {
                prop_assert_eq!(Some(number.to_bits()), parsed(&text));
            }
            let number = read(&bytes[..length]);
            let text = core::str::from_utf8(&bytes[..length]).unwrap_or_default();
            prop_assert!(number.is_none() || number.map(f64::to_bits) == parsed(text));
        }

        /// Every byte in every place.
        #[test]
        fn one_letter_that_is_no_digit_is_seen(digits in "[0-9]{1,15}", place in 0..15_usize, letter: u8) {
            let mut text = digits.into_bytes();
            let place = place % text.len();
            text[place] = letter;
            let expected = core::str::from_utf8(&text).ok().filter(|text| !text.contains(['e', 'E', '+']));
            prop_assert_eq!(read(&text).map(f64::to_bits), expected.and_then(parsed));
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
            ("9007199254740992", Some(9_007_199_254_740_992.0)),
            ("9007199254740993", None),
            ("0.99999999999999", Some(0.999_999_999_999_99)),
            (".000000000000001", Some(1e-15)),
            ("00000000000000001", None),
            ("1.2.3", None),
            ("..", None),
            ("", None),
            ("-", None),
            (".", None),
            ("-.", None),
            ("+1", None),
            ("1e3", None),
            ("--1", None),
            (" 1", None),
            ("1:", None),
            ("1/", None),
            ("\u{b1}1", None),
        ] {
            assert_eq!(read(text.as_bytes()).map(f64::to_bits), expected.map(f64::to_bits), "“{text}”");
        }
    }
}
