//! What drawings and axes say is held to ten digits, beside the oracles of the other tests: those say that a number is right,
//! these that each stroke and word stands where it stood.
//!
//! Sines are the system's and may differ in their last bits; ten digits do not see that. (Fits are not held so: their matrix
//! products add in the order of the machine's registers, and what is nought but for rounding is another number on each.)

mod sheets;

use core::fmt::Debug;

use fingertip_calibration::TOOL;
use fingertip_test_support::Unchanged;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

fn unchanged(file: &str) -> Unchanged {
    Unchanged::new(env!("CARGO_MANIFEST_DIR"), &format!("tests/unchanged/{file}.txt"))
}

/// Draws by sums and products alone, so that the numbers are the same on every system.
struct Draw(Pcg64Mcg);

impl Draw {
    fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    /// Evenly from −1 to 1.
    fn signed(&mut self) -> f64 {
        2.0 * self.0.random::<f64>() - 1.0
    }
}

/// An answer as `Debug` has it, its fractional numbers to ten digits.
fn to_ten_digits(answer: &impl Debug) -> String {
    // Whatever its version is.
    let said = format!("{answer:?}").replace(TOOL, "this tool");
    let mut told = String::with_capacity(said.len());
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | '-');
    for piece in said.split_inclusive(|c: char| !is_part(c)) {
        let number = piece.trim_end_matches(|c: char| !is_part(c));
        match number.parse::<f64>() {
            Ok(value) if number.contains(['.', 'e']) => told.push_str(&format!("{value:.9e}")),
            _ => told.push_str(number),
        }
        told.push_str(&piece[number.len()..]);
    }
    told
}

#[test]
fn digits_are_those_of_fractions() {
    let answer = (1_usize, -0.123_456_789_012_3, Some(1e-7), "x1.5", f64::NAN);
    assert_eq!(to_ten_digits(&answer), "(1, -1.234567890e-1, Some(1.000000000e-7), \"x1.500000000e0\", NaN)");
}
