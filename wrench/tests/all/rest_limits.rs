//! The limits of the test of rest: what just keeps them is at rest, what just exceeds them is refused, for
//! the reason that exceeds.
//!
//! Statistics are computed here from all readings at once, by their definitions; critical values of
//! Student's t, of Grubbs' distance and of χ² were computed from the distribution functions with 40
//! digits.

use fingertip_wrench::{NotAtRest, Real, RestTest, Rested};
use nalgebra::SVector;

/// One gauge's readings in numbers.
struct Statistics {
    mean: f64,
    /// Standard deviation of one reading.
    deviation: f64,
    /// Distance of the farthest reading from the mean.
    farthest: f64,
    /// How far the fitted line moves from the first reading to the last.
    moved: f64,
    /// Standard error of that, by the scatter about the line; `spread` in place of the deviation.
    moved_error: f64,
    /// Variance of the means of full stretches, times their length.
    by_stretches: f64,
    stretch: f64,
}

/// `spread` is the standard deviation in which distances count, a converter's steps included.
fn statistics(readings: &[f64], step: f64) -> (Statistics, f64) {
    let n = readings.len() as f64;
    let mean = readings.iter().sum::<f64>() / n;
    let deviation = (readings.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
    let spread = deviation.hypot(step / 12.0_f64.sqrt());
    let farthest = readings.iter().map(|x| (x - mean).abs()).fold(0.0, f64::max);
    let times = || (0..readings.len()).map(|i| i as f64 - (n - 1.0) / 2.0);
    let of_times: f64 = times().map(|t| t * t).sum();
    let slope = times().zip(readings).map(|(t, x)| t * (x - mean)).sum::<f64>() / of_times;
    let about_line = ((n - 1.0) * spread * spread - slope * slope * of_times) / (n - 2.0);
    let mut length = 1;
    while readings.len() > 32 * length {
        length *= 2;
    }
    let means: Vec<f64> =
        readings.chunks_exact(length).map(|s| s.iter().sum::<f64>() / length as f64).collect();
    let (count, stretch) = (means.len() as f64, length as f64);
    let middle = means.iter().sum::<f64>() / count;
    let by_stretches = means.iter().map(|x| (x - middle).powi(2)).sum::<f64>() / (count - 1.0) * stretch;
    let moved_error = (about_line.max(0.0) / of_times).sqrt() * (n - 1.0);
    let moved = slope * (n - 1.0);
    (Statistics { mean, deviation, farthest, moved, moved_error, by_stretches, stretch }, spread)
}

/// Critical values for a number of readings, gauges and a rate of false alarms.
struct Critical {
    readings: usize,
    /// So many make a stretch.
    stretch: usize,
    rate: f64,
    /// Student's t of the slope.
    slope: f64,
    /// Grubbs' distance.
    distance: f64,
    /// χ² over its degrees of freedom, of the stretches.
    stretches: f64,
    /// The same of all readings.
    readings_variance: f64,
}

/// For one gauge.
const ONE: [Critical; 2] = [
    Critical {
        readings: 100,
        stretch: 4,
        rate: 0.03,
        slope: 2.62693109576,
        distance: 3.7540043721,
        stretches: 1.89827133069,
        readings_variance: 1.40390690354,
    },
    // The last five readings fill no stretch.
    Critical {
        readings: 205,
        stretch: 8,
        rate: 0.003,
        slope: 3.33909700002,
        distance: 4.46012727965,
        stretches: 2.22828128216,
        readings_variance: 1.35822033944,
    },
];

/// For each of two gauges, which share the rate.
const OF_TWO: Critical = Critical {
    readings: 100,
    stretch: 4,
    rate: 0.03,
    slope: 2.87197747266,
    distance: 3.90045366666,
    stretches: 2.00140362296,
    readings_variance: 1.44539229929,
};

/// Noise without drift, and of which every stretch of four has the same mean.
fn noise(i: usize) -> f64 {
    [1.0, -1.0, -1.0, 1.0][i % 4]
}

/// What a test is told besides the readings.
#[derive(Clone, Copy, Default)]
struct Told {
    step: f64,
    tolerance: f64,
    known: Option<f64>,
}

fn judge(readings: &[f64], rate: f64, told: Told) -> Result<Rested<f64, 1>, NotAtRest> {
    let one = SVector::<f64, 1>::new;
    let mut test = RestTest::new(rate)
        .and_then(|test| test.with_resolution(one(told.step)))
        .and_then(|test| test.with_tolerance(one(told.tolerance)))
        .expect("valid");
    if let Some(known) = told.known {
        test = test.with_known_noise(one(known)).expect("valid");
    }
    readings.iter().for_each(|x| assert!(test.add(&one(*x))));
    test.finish()
}

/// Where a growing function reaches zero.
fn root(growing: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (1e-6, 1e3);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if growing(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The readings of `motion`, so large that `excess` (of its statistics over the limit) is zero, times
/// `1 ∓ hair`: the first are at rest, the second are refused as returned. The hair is a few times what the
/// approximations of the critical values state.
fn at_the_limit(
    critical: &Critical,
    (told, hair): (Told, f64),
    motion: impl Fn(usize, f64) -> f64,
    excess: impl Fn(&Statistics, f64) -> f64,
) -> (NotAtRest, Statistics, f64) {
    let all = |size: f64| -> Vec<f64> { (0..critical.readings).map(|i| motion(i, size)).collect() };
    let size = root(|size| {
        let (found, spread) = statistics(&all(size), told.step);
        excess(&found, spread)
    });
    let within = judge(&all(size * (1.0 - hair)), critical.rate, told);
    let rested = within.unwrap_or_else(|error| panic!("{error} below the limit {size}"));
    // The tare of what is at rest, with its errors.
    let (wanted, _) = statistics(&all(size * (1.0 - hair)), told.step);
    let close = |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-12 * (1.0 + wanted.abs()));
    close(rested.tare.zero()[0], wanted.mean);
    close(rested.noise[0], wanted.deviation);
    let counted = (critical.readings as f64).sqrt();
    close(rested.tare_noise[0], wanted.deviation.max(wanted.by_stretches.sqrt()) / counted);
    assert_eq!(rested.samples as usize, critical.readings);
    let beyond = all(size * (1.0 + hair));
    let (found, spread) = statistics(&beyond, told.step);
    let error = judge(&beyond, critical.rate, told).expect_err("beyond the limit");
    (error, found, spread)
}

/// Alone, on a converter with steps of two standard deviations, and with a motion that is put up with.
const TOLD: [Told; 4] = [
    Told { step: 0.0, tolerance: 0.0, known: None },
    Told { step: 2.0, tolerance: 0.0, known: None },
    Told { step: 0.0, tolerance: 1.5, known: None },
    Told { step: 1.0, tolerance: 1.5, known: None },
];

#[test]
fn a_reading_too_far_from_the_mean_is_an_outlier() {
    for critical in &ONE {
        for told in TOLD {
            for side in [1.0, -1.0] {
                // In the middle, where it makes no drift.
                let knock = |i: usize, size: f64| {
                    noise(i) + if i == critical.readings / 2 { side * size } else { 0.0 }
                };
                let (error, found, spread) = at_the_limit(critical, (told, 1e-4), knock, |found, spread| {
                    found.farthest - told.step / 2.0 - critical.distance * spread
                });
                let NotAtRest::Outlier { gauge: 0, over_noise } = error else { panic!("{error:?}") };
                assert!((over_noise / (found.farthest / spread) - 1.0).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn a_slope_that_noise_does_not_explain_is_drift_up_or_down() {
    for critical in &ONE {
        for told in TOLD {
            for side in [1.0, -1.0] {
                let drift = |i: usize, size: f64| noise(i) + side * size * i as f64 * 0.01;
                let forgiven = told.step.max(told.tolerance);
                let (error, found, spread) = at_the_limit(critical, (told, 1e-4), drift, |found, _| {
                    found.moved.abs() - forgiven - critical.slope * found.moved_error
                });
                let NotAtRest::Drifts { gauge: 0, over_noise } = error else { panic!("{error:?}") };
                assert!((over_noise / (found.moved.abs() / spread) - 1.0).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn stretches_that_differ_more_than_their_readings_are_unsteady() {
    for critical in &ONE {
        for told in TOLD {
            // The same noise on the means of stretches, whose length is four or eight.
            let swing = |i: usize, size: f64| noise(i) + size * noise(i / critical.stretch);
            let forgiven = told.step.max(told.tolerance);
            let (error, ..) = at_the_limit(critical, (told, 5e-3), swing, |found, spread| {
                let expected = spread * spread + found.stretch * forgiven * forgiven;
                found.by_stretches - critical.stretches * expected
            });
            assert_eq!(error, NotAtRest::Unsteady { gauge: 0 });
        }
    }
}

#[test]
fn noise_wider_than_it_is_known_to_be_is_unsteady() {
    for critical in &ONE {
        for told in TOLD {
            let told = Told { known: Some(0.75), ..told };
            let known = 0.75 * 0.75 + told.step * told.step / 12.0;
            let (error, ..) = at_the_limit(
                critical,
                (told, 1e-3),
                |i, size| size * noise(i),
                |_, spread| spread * spread - critical.readings_variance * known,
            );
            assert_eq!(error, NotAtRest::Unsteady { gauge: 0 });
        }
    }
}

/// Two gauges, the second of which drifts or is knocked: each gets half of the false alarms.
#[test]
fn gauges_share_the_false_alarms() {
    let judge = |motion: &dyn Fn(usize) -> f64| {
        let mut test = RestTest::<f64, 2>::new(OF_TWO.rate).expect("valid");
        for i in 0..OF_TWO.readings {
            test.add(&SVector::from([noise(i), noise(i) + motion(i)]));
        }
        test.finish()
    };
    let of = |motion: &dyn Fn(usize) -> f64| {
        let readings: Vec<f64> = (0..OF_TWO.readings).map(|i| noise(i) + motion(i)).collect();
        statistics(&readings, 0.0)
    };
    let drift = |size: f64| move |i: usize| size * i as f64 * 0.01;
    let size = root(|size| {
        let (found, _) = of(&drift(size));
        found.moved - OF_TWO.slope * found.moved_error
    });
    assert!(judge(&drift(0.99 * size)).is_ok());
    assert!(matches!(judge(&drift(1.01 * size)), Err(NotAtRest::Drifts { gauge: 1, .. })));
    let knock = |size: f64| move |i: usize| if i == 50 { size } else { 0.0 };
    let size = root(|size| {
        let (found, spread) = of(&knock(size));
        found.farthest - OF_TWO.distance * spread
    });
    assert!(judge(&knock(0.99 * size)).is_ok());
    assert!(matches!(judge(&knock(1.01 * size)), Err(NotAtRest::Outlier { gauge: 1, .. })));
    let swing = |size: f64| move |i: usize| size * noise(i / OF_TWO.stretch);
    let size = root(|size| {
        let (found, spread) = of(&swing(size));
        found.by_stretches - OF_TWO.stretches * spread * spread
    });
    assert!(judge(&swing(0.99 * size)).is_ok());
    assert_eq!(judge(&swing(1.01 * size)), Err(NotAtRest::Unsteady { gauge: 1 }));
}

/// A ramp without noise leaves nothing about its line but rounding, of either sign.
#[test]
fn a_ramp_without_noise_is_drift() {
    for readings in [32, 33, 64, 100, 1_000] {
        for slope in [1.0, -1.0, 1.0 / 3.0, -0.1, 1e-7, 7e3] {
            let ramp: Vec<f64> = (0..readings).map(|i| f64::from(i) * slope).collect();
            let error = judge(&ramp, 0.01, Told::default()).expect_err("a ramp");
            let NotAtRest::Drifts { gauge: 0, over_noise } = error else { panic!("{error:?}") };
            // Of n numbers in a row the variance is n(n + 1)/12.
            let n = f64::from(readings);
            let wanted = (n - 1.0) / (n * (n + 1.0) / 12.0).sqrt();
            assert!((over_noise / wanted - 1.0).abs() < 1e-10, "{over_noise} {wanted}");
        }
    }
}

/// Offsets leave the moments of what varies alone: sums start from the first reading.
fn far_from_zero<T: Real>(offset: f64, grain: f64) {
    let one = |x: f64| SVector::<T, 1>::new(T::literal(x));
    let readings: Vec<f64> = (0..205).map(|i| noise(i) + 2.0 * noise(i / 16)).collect();
    let mut test =
        RestTest::<T, 1>::new(1e-9).and_then(|test| test.with_tolerance(one(10.0 * grain))).expect("valid");
    readings.iter().for_each(|x| assert!(test.add(&one(offset + grain * x))));
    let rested = test.finish().expect("at rest");
    let (wanted, _) = statistics(&readings, 0.0);
    // Means are known to the rounding of the offset.
    let rounding = 8.0 * T::EPSILON.to_f64() * offset / grain;
    let close = |found: f64, wanted: f64| {
        assert!((found / grain - wanted).abs() < rounding, "{} {wanted}", found / grain);
    };
    close(rested.tare.zero()[0].to_f64() - offset, wanted.mean);
    close(rested.noise[0].to_f64(), wanted.deviation);
    assert!(wanted.by_stretches.sqrt() > wanted.deviation);
    close(rested.tare_noise[0].to_f64() * 205.0_f64.sqrt(), wanted.by_stretches.sqrt());
}

#[test]
fn rest_is_judged_far_from_zero() {
    far_from_zero::<f64>(1e6, 2.0_f64.powi(-20));
    far_from_zero::<f32>(4096.0, 2.0_f64.powi(-6));
}

/// Sums of stretches do not grow with the offset: what they say is as exact as the readings are.
#[test]
fn stretches_are_summed_from_the_first_reading() {
    let one = |x: f64| SVector::<f32, 1>::new(x as f32);
    // A place of the sum of eight readings would be worth four grains, of a reading half of one.
    let (offset, grain) = (65_536.0, 2.0_f64.powi(-6));
    let readings: Vec<f64> =
        (0..205).map(|i| noise(i) + 2.0 * noise(i / 16) + f64::from(u8::from(i % 24 == 0))).collect();
    let mut test =
        RestTest::<f32, 1>::new(1e-9).and_then(|test| test.with_tolerance(one(1e3))).expect("valid");
    readings.iter().for_each(|x| assert!(test.add(&one(offset + grain * x))));
    let found = f64::from(test.finish().expect("at rest").tare_noise[0]) / grain * 205.0_f64.sqrt();
    let (wanted, _) = statistics(&readings, 0.0);
    assert!((found / wanted.by_stretches.sqrt() - 1.0).abs() < 1e-6, "{found}");
}

/// As many stretches as there are to be, whatever the number of readings: by what they say of the tare.
#[test]
fn stretches_are_joined_as_readings_come() {
    for count in [32, 33, 34, 63, 64, 65, 66, 127, 128, 129, 131, 1_000, 2_049] {
        // A slow swing that all stretches see.
        let readings: Vec<f64> =
            (0..count).map(|i| noise(i) + 3.0 * (i as f64 / count as f64 * 12.566).sin()).collect();
        let generous = Told { tolerance: 1e3, ..Told::default() };
        let rested = judge(&readings, 1e-9, generous).expect("put up with");
        let (wanted, _) = statistics(&readings, 0.0);
        let wanted = wanted.deviation.max(wanted.by_stretches.sqrt()) / (count as f64).sqrt();
        assert!((rested.tare_noise[0] / wanted - 1.0).abs() < 1e-12, "{count}: {rested:?}");
    }
}

#[test]
fn parameters_at_the_edge() {
    let test = || RestTest::<f64, 2>::new(0.01).expect("valid");
    let pair = |x: f64| SVector::from([1.0, x]);
    for fine in [0.0, 1e-3] {
        assert!(test().with_resolution(pair(fine)).is_ok() && test().with_tolerance(pair(fine)).is_ok());
    }
    assert!(test().with_known_noise(pair(1e-3)).is_ok());
    for bad in [-1e-3, f64::NAN, f64::INFINITY] {
        assert_eq!(test().with_resolution(pair(bad)), Err(NotAtRest::BadParameter));
        assert_eq!(test().with_tolerance(pair(bad)), Err(NotAtRest::BadParameter));
        assert_eq!(test().with_known_noise(pair(bad)), Err(NotAtRest::BadParameter));
    }
    assert_eq!(test().with_known_noise(pair(0.0)), Err(NotAtRest::BadParameter));
    // The least number of readings, and one fewer.
    for (count, enough) in [(31, false), (32, true)] {
        let readings: Vec<f64> = (0..count).map(noise).collect();
        assert_eq!(judge(&readings, 0.01, Told::default()).is_ok(), enough);
    }
    assert_eq!(RestTest::<f64, 2>::LEAST_SAMPLES, 32);
    // All readings alike: no noise, no motion. Of a converter with steps, too.
    for step in [0.0, 1.0] {
        let rested = judge(&[0.1; 40], 0.01, Told { step, ..Told::default() }).expect("at rest");
        assert!(rested.noise[0] < 1e-15 && rested.tare_noise[0] < 1e-15);
    }
    // What is not finite is counted, each reading once.
    let mut broken = test();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(!broken.add(&pair(bad)));
    }
    (0..100).for_each(|i| assert!(broken.add(&pair(noise(i)))));
    assert_eq!(broken.finish(), Err(NotAtRest::NotFinite { rejected: 3 }));
}

#[test]
fn readings_out_of_range_are_no_rest() {
    let huge: Vec<f64> = (0..100).map(|i| 1e200 * noise(i)).collect();
    assert_eq!(judge(&huge, 0.01, Told::default()), Err(NotAtRest::OutOfRange { gauge: 0 }));
    let fine: Vec<f64> = (0..100).map(noise).collect();
    let told = Told { step: 1e200, ..Told::default() };
    assert_eq!(judge(&fine, 0.01, told), Err(NotAtRest::OutOfRange { gauge: 0 }));
}
