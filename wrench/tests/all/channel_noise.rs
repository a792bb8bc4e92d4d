//! Allan variance and resolution against their definitions.

use fingertip_wrench::{AllanVariance, Real, Resolution};
use proptest::prelude::*;

use crate::support::{generator, normal};

/// By the definition: means of stretches that follow each other.
fn by_definition(readings: &[f64], octave: u32) -> Option<f64> {
    let length = 1 << octave;
    let means: Vec<f64> =
        readings.chunks_exact(length).map(|stretch| stretch.iter().sum::<f64>() / length as f64).collect();
    let squares: Vec<f64> = means.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).collect();
    (!squares.is_empty()).then(|| 0.5 * squares.iter().sum::<f64>() / squares.len() as f64)
}

proptest! {
    #[test]
    fn the_allan_variance_is_that_of_its_definition(readings in prop::collection::vec(-1e3_f64..1e3, 0..300)) {
        let mut allan = AllanVariance::default();
        readings.iter().for_each(|reading| allan.add(*reading));
        for octave in 0..10 {
            let expected = by_definition(&readings, octave);
            let found = allan.variance(octave as usize);
            prop_assert_eq!(found.is_some(), expected.is_some());
            if let (Some(found), Some(expected)) = (found, expected) {
                prop_assert!((found - expected).abs() <= 1e-9 * expected.max(1e-3), "{} for {}", found, expected);
            }
        }
    }

    #[test]
    fn steps_are_found_whatever_their_size(decade in -12_i32..9, offset in -1e3_f64..1e3, seed in 0_u64..1000) {
        let step = 10_f64.powi(decade) * 1.37;
        let mut random = generator(seed.into());
        let mut resolution = Resolution::default();
        for _ in 0..400 {
            resolution.add(step * (offset.round() + 1.5 * normal(&mut random)).round());
        }
        let found = resolution.step().expect("some hundred changes");
        prop_assert!((found / step - 1.0).abs() < 1e-3, "{} for {}", found, step);
    }
}

#[test]
fn white_noise_falls_with_the_time_and_a_walk_grows() {
    let mut random = generator(11);
    let (mut white, mut walk, mut place) =
        (AllanVariance::<f64>::default(), AllanVariance::<f64>::default(), 0.0);
    for _ in 0..1 << 16 {
        let step = normal(&mut random);
        place += step;
        white.add(1e3 + step);
        walk.add(place);
    }
    for octave in 0..9 {
        let length = f64::from(1_u32 << octave);
        // Scatter of the mean of so many squares.
        let scatter = 5.0 * (3.0 / f64::from(white.pairs(octave))).sqrt();
        let found = white.variance(octave).expect("enough") * length;
        assert!((found - 1.0).abs() < scatter, "octave {octave}: {found}");
        // Means of n steps of a walk differ by n (2n² + 1)/(3n²) in variance.
        let expected = 0.5 * (2.0 * length * length + 1.0) / (3.0 * length);
        let found = walk.variance(octave).expect("enough") / expected;
        assert!((found - 1.0).abs() < 1.5 * scatter, "octave {octave}: {found}");
    }
    assert_eq!((white.variance(15).is_some(), white.pairs(15)), (true, 1));
    assert_eq!((white.variance(16), white.pairs(16)), (None, 0));
}

#[test]
fn gaps_are_not_bridged() {
    let mut allan = AllanVariance::<f64>::default();
    for reading in [1.0, 1.0, f64::NAN, 9.0, 9.0, f64::INFINITY, 4.0] {
        allan.add(reading);
    }
    allan.interrupt();
    allan.add(7.0);
    assert_eq!((allan.variance(0), allan.pairs(0), allan.variance(1)), (Some(0.0), 2, None));
    // Means of large numbers stay within the range.
    let mut large = AllanVariance::<f32>::default();
    (0..8).for_each(|_| large.add(f32::MAX));
    assert_eq!(large.variance(2), Some(0.0));
}

#[test]
fn what_has_no_step_is_said_to_have_none() {
    fn check<T: Real>() {
        let mut random = generator(13);
        let mut resolution = Resolution::<T>::default();
        assert!(resolution.step().is_none() && !resolution.is_known());
        (0..20_000).for_each(|_| resolution.add(T::literal(normal(&mut random))));
        assert!(resolution.is_known());
        let step = resolution.step();
        assert!(step.is_none_or(|step| step.to_f64() < 1e-3), "{step:?}");
        // Text of four digits: a step of 0.3218 is written as 0.321 or 0.322 and 0.643 or 0.644.
        let mut written = Resolution::<T>::default();
        for _ in 0..500 {
            let exact = 0.3218 * (1.2 * normal(&mut random)).round();
            written.add(T::literal((exact * 1e3).round() / 1e3));
        }
        assert!((written.step().expect("a step").to_f64() / 0.3218 - 1.0).abs() < 3e-3);
        // No change tells nothing, nor does what is not finite.
        let mut still = Resolution::<T>::default();
        (0..100).for_each(|_| still.add(T::one()));
        [f64::NAN, f64::INFINITY].into_iter().for_each(|reading| still.add(T::literal(reading)));
        assert!(still.step().is_none() && !still.is_known());
    }
    check::<f64>();
    check::<f32>();
}
