//! Any bit pattern as wrench and shape: no panic, no NaN, no endless loop. The same as the fuzz
//! target, with fewer cases, the same in every run: what a new seed might find is the fuzz target's affair.

#[path = "../../fuzz/src/any_shape.rs"]
mod any_shape;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 4000, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default()
    })]

    #[test]
    fn nothing_breaks_in_double_precision(bits in proptest::array::uniform32(any::<u64>()), kind in any::<u8>()) {
        any_shape::check_f64(kind, &bits);
    }

    #[test]
    fn nothing_breaks_in_single_precision(bits in proptest::array::uniform32(any::<u32>()), kind in any::<u8>()) {
        any_shape::check_f32(kind, &bits);
    }

    /// Numbers of a usual size make valid shapes more often.
    #[test]
    fn nothing_breaks_with_usual_numbers(numbers in proptest::array::uniform32(-3.0_f64..3.0), kind in any::<u8>()) {
        any_shape::check_f64(kind, &numbers.map(f64::to_bits));
    }

    /// Small whole numbers meet every special case: parallel, tangent, coincident, equal.
    #[test]
    fn nothing_breaks_with_whole_numbers(numbers in proptest::array::uniform32(-2_i8..3), kind in any::<u8>()) {
        any_shape::check_f64(kind, &numbers.map(|n| f64::from(n).to_bits()));
        any_shape::check_f32(kind, &numbers.map(|n| f32::from(n).to_bits()));
    }
}
