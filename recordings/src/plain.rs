//! Plain decimals, as nearly every cell of a recording holds one.

/// Bytes at the end of a text that are looked at at once.
pub(super) const WINDOW: usize = 8;
/// Digits that a double holds whatever they are.
const DIGITS: usize = 15;
const POWERS: [f64; WINDOW + 1] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8];
/// A one in every byte.
pub(super) const ONES: u64 = u64::MAX / 0xff;

/// Reads a number of at most 15 digits, of which at most eight stand behind a point, with or without a minus, as the nearest
/// double; `None` for all else, which a whole parser may still know. The window holds the last bytes of the text, with
/// whatever stands before it if it is shorter.
///
/// The digits without their point are a whole number below 2⁵³, and so is the power of ten: both are exact, so that their
/// quotient is rounded once (Clinger, How to read floating point numbers accurately, 1990, section 3). The digits behind
/// the point are looked at at once: for so short a number that takes half the instructions of a parser for all of them.
#[inline]
pub(super) fn read_plain(text: &[u8], window: &[u8; WINDOW]) -> Option<f64> {
    let (is_negative, text) = match text {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, text),
    };
    let (mut whole, mut behind) = (0_u64, text.iter());
    let places = loop {
        match behind.next() {
            Some(byte @ b'0'..=b'9') => whole = whole.wrapping_mul(10).wrapping_add(u64::from(byte & 0xf)),
            Some(b'.') => break Some(behind.len()),
            Some(_) => return None,
            None => break None,
        }
    };
    let digits = text.len() - usize::from(places.is_some());
    if digits == 0 || digits > DIGITS {
        return None;
    }
    let mut number = whole as f64;
    if let Some(places) = places {
        let power = POWERS.get(places)?;
        // Bytes before the point become zeros.
        let first = 8 * (WINDOW - places) as u32;
        let fraction = u64::from_le_bytes(*window) ^ (ONES * u64::from(b'0'));
        let fraction = fraction & u64::MAX.checked_shl(first).unwrap_or(0);
        // The highest bit of a byte that is no digit.
        if (fraction.wrapping_add(ONES * (0x80 - 10)) | fraction) & (ONES * 0x80) != 0 {
            return None;
        }
        number = (number * power + eight_digits(fraction) as f64) / power;
    }
    Some(if is_negative { -number } else { number })
}

/// The number of eight decimal digits, one in a byte, the first lowest: neighbours are put together to pairs, to fours, and to
/// all.
#[inline]
const fn eight_digits(digits: u64) -> u64 {
    let pairs = (digits * 10 + (digits >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs * 100 + (pairs >> 16)) & 0x0000_ffff_0000_ffff;
    (fours * 10_000 + (fours >> 32)) & 0xffff_ffff
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};

    use super::WINDOW;

    /// Reads a text at the end of a window that begins with anything.
    fn read_plain(text: &[u8]) -> Option<f64> {
        let row = [&b"1.2-34,5;.67\t8\xff9"[..], text].concat();
        super::read_plain(text, row.last_chunk::<WINDOW>().unwrap())
    }

    /// What the whole parser reads, by its bits.
    fn whole(text: &[u8]) -> Option<u64> {
        fast_float2::parse::<f64, _>(text).ok().map(f64::to_bits)
    }

    #[test]
    fn what_is_read_is_what_a_whole_parser_reads() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(3);
        let mut read = 0;
        for round in 0..400_000 {
            // Letters that numbers have, at random, most of them digits; every second text begins as a number does.
            let letters = if round % 2 == 0 {
                &b"0123456789012345678901234567890123456789.-"[..]
            } else {
                b"012345679.-+eE _nai"
            };
            let length = random.random_range(0..20);
            let text: Vec<u8> = (0..length).map(|_| letters[random.random_range(0..letters.len())]).collect();
            if let Some(number) = read_plain(&text) {
                read += 1;
                assert_eq!(Some(number.to_bits()), whole(&text), "{}", String::from_utf8_lossy(&text));
            }
        }
        assert!(read > 50_000, "{read} texts were numbers");
    }

    #[test]
    fn every_plain_number_is_read() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(4);
        for _ in 0..200_000 {
            let digits = random.random_range(1..=15);
            let places = random.random_range(0..=digits.min(WINDOW));
            let mut text: String =
                (0..digits).map(|_| char::from(random.random_range(b'0'..=b'9'))).collect();
            if random.random() || places > 0 {
                text.insert(digits - places, '.');
            }
            if random.random() {
                text.insert(0, '-');
            }
            let number = read_plain(text.as_bytes()).unwrap_or_else(|| panic!("{text} was not read"));
            assert_eq!(Some(number.to_bits()), whole(text.as_bytes()), "{text}");
        }
    }

    #[test]
    fn what_is_longer_or_none_is_left_to_the_parser() {
        let others = [
            "",
            "-",
            ".",
            "-.",
            "--1",
            "1-",
            "1.2.3",
            "+1",
            "1e3",
            "nan",
            "inf",
            " 1",
            "1 ",
            "0x1",
            "1,5",
            "\u{661}",
            "1234567890123456",
            "0.123456789012345",
            "-1234567890.1234567",
            "00000000000000000001",
        ];
        for text in others {
            assert_eq!(read_plain(text.as_bytes()), None, "{text}");
        }
        let ends = [
            ("0", 0.0),
            ("-0.0", -0.0),
            ("5.", 5.0),
            (".5", 0.5),
            ("999999999999999", 999_999_999_999_999.0),
        ];
        for (text, number) in ends {
            assert_eq!(read_plain(text.as_bytes()).map(f64::to_bits), Some(f64::to_bits(number)), "{text}");
        }
    }
}
