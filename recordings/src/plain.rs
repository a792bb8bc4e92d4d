//! Plain decimals, as nearly every cell of a recording holds one.

/// Bytes at the end of a text that are looked at at once.
pub(super) const WINDOW: usize = 16;
/// Digits that a double holds whatever they are.
const DIGITS: usize = 15;
const POWERS: [f64; WINDOW] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
/// A one in every byte.
const ONES: u128 = u128::MAX / 0xff;
/// The point, where every byte is the digit that it means.
const POINT: u128 = (b'.' ^ b'0') as u128;

/// Reads a number of at most 15 digits and 16 bytes, with or without a minus and a point, as the nearest double; `None` for
/// all else, which a whole parser may still know. The number is the last `length` bytes of the window, whatever stands before it.
///
/// The digits without their point are a whole number below 2⁵³, and so is the power of ten: both are exact, so that their
/// quotient is rounded once (Clinger, How to read floating point numbers accurately, 1990, section 3). All bytes are looked
/// at at once, as digits of one long number: for so short a number that takes a third of the instructions of a parser for
/// all of them.
#[inline]
pub(super) fn read_plain(window: &[u8; WINDOW], length: usize) -> Option<f64> {
    let is_negative = *window.get(WINDOW.checked_sub(length)?)? == b'-';
    let length = length - usize::from(is_negative);
    let (first, bits) = (WINDOW - length, |bytes: usize| 8 * bytes as u32);
    let digits = (u128::from_le_bytes(*window) ^ (ONES * 0x30)) & u128::MAX.checked_shl(bits(first))?;
    // The highest bit of every byte that is no digit.
    let others = (((digits & (ONES * 0x7f)) + ONES * (0x80 - 10)) | digits) & (ONES * 0x80);
    let (digits, count, places) = if others == 0 {
        (digits, length, 0)
    } else {
        let place = others.trailing_zeros() - 7;
        let before = !(u128::MAX << place);
        if others & (others - 1) != 0 || (digits >> place) & 0xff != POINT {
            return None;
        }
        // The digits before the point move to where it is.
        let joined = ((digits & before) << 8) | (digits & !((before << 8) | 0xff));
        (joined, length - 1, WINDOW - 1 - place as usize / 8)
    };
    if count == 0 || count > DIGITS {
        return None;
    }
    let whole = 100_000_000 * eight_digits(digits as u64) + eight_digits((digits >> 64) as u64);
    let number = whole as f64 / POWERS.get(places)?;
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

    /// Reads a text as the end of a window that begins with anything.
    fn read_plain(text: &[u8]) -> Option<f64> {
        let numbers = [&b"1.2-34,5;.67\t8\xff9"[..], text].concat();
        super::read_plain(numbers.last_chunk::<WINDOW>().unwrap(), text.len())
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
            let places = random.random_range(0..=digits);
            let mut text: String =
                (0..digits).map(|_| char::from(random.random_range(b'0'..=b'9'))).collect();
            if random.random() || places > 0 {
                text.insert(digits - places, '.');
            }
            if random.random() {
                text.insert(0, '-');
            }
            // The window holds no sign before 15 digits and a point.
            let text = if text.len() > WINDOW { &text[1..] } else { &*text };
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
