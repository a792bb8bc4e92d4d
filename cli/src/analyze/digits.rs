//! Numbers as text: of eight significant digits, and times of nine decimals.

use core::ops::Range;

/// What is written without an exponent.
const RANGE: Range<f64> = 1e-7..9_999_999.95;
/// Bytes that are written, of which the first are the text.
pub(super) const ROOM: usize = 32;
/// 2⁵²: a smaller number that is added to it is rounded to a whole one, which its fraction then holds.
const WHOLE: f64 = 4_503_599_627_370_496.0;
const FRACTION: u64 = (1 << 52) - 1;
/// Below 2⁵², where half a unit can be added \[ns\].
const LONGEST: f64 = 4.5e15;
const ZEROS: u64 = u64::from_le_bytes([b'0'; 8]);

/// How numbers of a decade are written.
#[derive(Clone, Copy)]
struct Decade {
    begin: f64,
    /// What such a number is multiplied by to have eight digits before its point: exact, so that the product is rounded
    /// once.
    scale: f64,
    /// Where the digits begin.
    start: u8,
    /// Where the point is.
    point: u8,
    /// Where the digits behind the point begin, which are all but the first `whole_bits / 8`.
    behind: u8,
    whole_bits: u8,
}

impl Decade {
    #[expect(clippy::cast_possible_truncation, reason = "exponents have one digit")]
    const fn new(exponent: i32, begin: f64, scale: f64) -> Self {
        if exponent < 0 {
            let start = 1 + exponent.unsigned_abs() as u8;
            Self { begin, scale, start, point: 1, behind: start, whole_bits: 0 }
        } else {
            let point = exponent.unsigned_abs() as u8 + 1;
            Self { begin, scale, start: 0, point, behind: point + 1, whole_bits: 8 * point }
        }
    }

    const ALL: [Self; 16] = [
        // Numbers from 10⁻⁷ on are estimated to be a decade lower.
        Self::new(-7, 1e-7, 1e14),
        Self::new(-7, 1e-7, 1e14),
        Self::new(-6, 1e-6, 1e13),
        Self::new(-5, 1e-5, 1e12),
        Self::new(-4, 1e-4, 1e11),
        Self::new(-3, 1e-3, 1e10),
        Self::new(-2, 1e-2, 1e9),
        Self::new(-1, 1e-1, 1e8),
        Self::new(0, 1e0, 1e7),
        Self::new(1, 1e1, 1e6),
        Self::new(2, 1e2, 1e5),
        Self::new(3, 1e3, 1e4),
        Self::new(4, 1e4, 1e3),
        Self::new(5, 1e5, 1e2),
        Self::new(6, 1e6, 1e1),
        Self::new(7, 1e7, 1e0),
    ];
}

/// Writes a comma and a number of which the size is zero or from 10⁻⁷ to below 10⁷, rounded to eight significant digits
/// whose trailing zeros are left out, but for one behind the point; of NaN the comma alone. Says how many bytes the text
/// has; `None` for what is beyond. Half a unit of the last digit is 5·10⁻⁸ of the number at most: no force sensor comes
/// near.
///
/// Pieces of fixed length are stored over each other: to put text together from pieces of any length takes longer than to
/// find its digits.
#[inline]
pub(super) fn write_cell(number: f64, to: &mut [u8; ROOM]) -> Option<usize> {
    let (magnitude, before) = (number.abs(), 1 + usize::from(number.is_sign_negative()));
    *to.first_chunk_mut()? = *b",-";
    let to = to.get_mut(before..)?;
    if !RANGE.contains(&magnitude) {
        if number.is_nan() {
            return Some(1);
        }
        *to.first_chunk_mut()? = *b"0.0";
        return (number == 0.0).then_some(before + 3);
    }
    // 0.301 of the binary exponent is the decimal one or one too low.
    let binary = i32::from((magnitude.to_bits() >> 52) as u16) - 1023;
    let next = usize::try_from(((binary * 78_913) >> 18) + 9).ok()?;
    let place = next - usize::from(magnitude < Decade::ALL.get(next)?.begin);
    let mut decade = Decade::ALL.get(place)?;
    let mut whole = (magnitude * decade.scale + WHOLE).to_bits() & FRACTION;
    // Rounded up to the next decade.
    if whole >= 100_000_000 {
        (whole, decade) = (10_000_000, Decade::ALL.get(place + 1)?);
    }
    let digits = digits(whole);
    let zeros = digits.swap_bytes().trailing_zeros() / 8;
    let digits = digits | ZEROS;
    let [start, point, behind] =
        [decade.start, decade.point, decade.behind].map(|place| usize::from(place) % 16);
    *to.first_chunk_mut()? = *b"0.000000";
    *to.get_mut(start..)?.first_chunk_mut()? = digits.to_le_bytes();
    *to.get_mut(behind..)?.first_chunk_mut()? = (digits >> (decade.whole_bits % 64)).to_le_bytes();
    *to.get_mut(point)? = b'.';
    let length = start + 8 - zeros as usize + usize::from(start == 0);
    if length < point + 2 {
        *to.get_mut(point + 1)? = b'0';
        return Some(before + point + 2);
    }
    Some(before + length)
}

/// Writes a time \[s\] from 0 to 4.5·10⁶ s, rounded to nanoseconds of which trailing zeros are left out, but for one behind
/// the point, and says how many bytes its text has; `None` for what is beyond, for NaN and for the negative zero.
///
/// So many nanoseconds are a whole number that is exact, so that the text is the shortest that is read as this time.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number within its range"
)]
pub(super) fn write_time(time: f64, to: &mut [u8; ROOM]) -> Option<usize> {
    let nanoseconds = time * 1e9 + 0.5;
    if time.is_sign_negative() || !(nanoseconds < LONGEST) {
        return None;
    }
    let nanoseconds = nanoseconds as u64;
    let (seconds, behind) = (nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000);
    // Seven digits at most, without the zeros before them.
    let whole = digits(seconds);
    let zeros = (whole.trailing_zeros() / 8).min(7);
    *to.first_chunk_mut()? = ((whole >> (8 * zeros)) | ZEROS).to_le_bytes();
    let point = 8 - zeros as usize;
    let (first, last) = (behind / 10, behind % 10);
    let first = digits(first);
    let places = if last > 0 { 9 } else { (8 - first.swap_bytes().trailing_zeros() / 8).max(1) as usize };
    let to = to.get_mut(point..)?.first_chunk_mut::<10>()?;
    let [dot, decimals @ .., ninth] = to;
    (*dot, *ninth) = (b'.', b'0' + last as u8);
    *decimals = (first | ZEROS).to_le_bytes();
    Some(point + 1 + places)
}

/// The eight decimal digits of a number below 10⁸, one in a byte, the first lowest: halves, quarters and digits are parted
/// all at once, divisions being multiplications that are exact for so few digits.
#[inline]
const fn digits(number: u64) -> u64 {
    let half = (number * 109_951_163) >> 40;
    let halves = half | ((number - 10_000 * half) << 32);
    let hundreds = ((halves * 10_486) >> 20) & 0x0000_007f_0000_007f;
    let pairs = hundreds | ((halves - 100 * hundreds) << 16);
    let tens = ((pairs * 103) >> 10) & 0x000f_000f_000f_000f;
    tens | ((pairs - 10 * tens) << 8)
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};

    use super::{ROOM, digits, write_cell, write_time};

    fn text(number: f64) -> Option<String> {
        let mut bytes = [0; ROOM];
        let length = write_cell(number, &mut bytes)?;
        let text = core::str::from_utf8(&bytes[..length]).unwrap();
        Some(text.strip_prefix(',').unwrap().to_owned())
    }

    #[test]
    fn eight_digits_are_those_of_the_number() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(7);
        let many = (0..20_000).map(|_| random.random_range(0..100_000_000));
        for number in many.collect::<Vec<u32>>().into_iter().chain([0, 1, 9, 99, 9_999, 10_000, 99_999_999]) {
            let bytes = digits(number.into()).to_le_bytes().map(|digit| b'0' + digit);
            assert_eq!(core::str::from_utf8(&bytes), Ok(&*format!("{number:08}")));
        }
    }

    /// The standard library rounds exactly; beside it only what lies at half a digit may fall to the other side.
    #[test]
    fn text_is_the_number_to_eight_digits_in_its_shortest_form() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(8);
        for _ in 0..100_000 {
            let number: f64 = 10.0_f64.powf(random.random_range(-7.0..7.0));
            // Few digits as well as many.
            let digits = random.random_range(0..12);
            let number: f64 = format!("{number:.digits$e}").parse().unwrap();
            let Some(text) = text(number) else {
                assert!(!(1e-7..9_999_999.95).contains(&number), "{number} has no text");
                continue;
            };
            let exact: f64 = format!("{number:.7e}").parse().unwrap();
            // Without an exponent, and with a point.
            let plain = |number: f64| format!("{number}{}", if number.fract() == 0.0 { ".0" } else { "" });
            if text != plain(exact) {
                let unit = 10.0_f64.powi(number.log10().floor() as i32 - 7);
                let read: f64 = text.parse().unwrap();
                let off = (read - number).abs() / unit;
                assert!((0.499_999_9..0.500_000_1).contains(&off), "{text} for {number}");
                assert_eq!(text, plain(read));
            }
        }
    }

    #[test]
    fn times_are_those_of_the_standard_library() {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(11);
        let ends =
            [0.0, 4e-10, 6e-10, 1e-9, 0.1 + 0.2, 1.0, 0.999_999_999_6, 9.999_999_999, 4_499_999.999_999_999];
        let few = (0..2000).map(|k| f64::from(k) * 1e-3);
        let many = (0..100_000).map(|k| random.random_range(0.0..4.4) * 10.0_f64.powi(k % 16 - 9));
        for time in ends.into_iter().chain(few).chain(many.collect::<Vec<f64>>()) {
            let mut bytes = [0; ROOM];
            let length = write_time(time, &mut bytes).unwrap();
            let rounded = (time * 1e9).round() / 1e9;
            let expected = format!("{rounded}{}", if rounded.fract() == 0.0 { ".0" } else { "" });
            assert_eq!(core::str::from_utf8(&bytes[..length]), Ok(&*expected), "{time:e}");
        }
        for beyond in
            [-1.0, -0.0, -5e-324, 4.6e6, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, -f64::NAN]
        {
            assert_eq!(write_time(beyond, &mut [0; ROOM]), None, "{beyond}");
        }
    }

    #[test]
    fn ends_and_carries_are_right() {
        for (number, expected) in [
            (1e-7, "0.0000001"),
            (9.999_999_96e-7, "0.000001"),
            (0.123_456_785_1, "0.12345679"),
            (0.999_999_999, "1.0"),
            (1.0, "1.0"),
            (9.999_999_9, "9.9999999"),
            (9.999_999_99, "10.0"),
            (100.5, "100.5"),
            (1_234_567.0, "1234567.0"),
            (9_999_999.94, "9999999.9"),
            (1_000_000.0, "1000000.0"),
            (1_200_000.5, "1200000.5"),
        ] {
            assert_eq!(text(number).as_deref(), Some(expected));
        }
        for (number, expected) in
            [(0.0, "0.0"), (-0.0, "-0.0"), (f64::NAN, ""), (-f64::NAN, ""), (-1.5e-3, "-0.0015")]
        {
            assert_eq!(text(number).as_deref(), Some(expected));
        }
        let beyond = [5e-324, 9.9e-8, 1e7, 9_999_999.96, 1e308, f64::INFINITY];
        for number in beyond.into_iter().flat_map(|number| [number, -number]) {
            assert_eq!(text(number), None, "{number}");
        }
    }
}
