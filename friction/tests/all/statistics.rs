//! The statistics for changes, at their edges and against their definitions; and the gate before them.

use fingertip_friction::{
    Cusum, ForceNoise, LikelihoodRatio, LikelihoodRatioDetector, NormalForceGate, RatioThreshold,
    SlipDetector, SlipVerdict,
};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

#[test]
fn a_sum_passes_above_its_threshold_and_comes_back_from_anything() {
    let mut sum = Cusum::new(0.5_f64, 5.0).unwrap();
    assert_eq!((sum.allowance(), sum.threshold(), sum.sum()), (0.5, 5.0, 0.0));
    assert!(!sum.add(5.5) && sum.sum() == 5.0);
    assert!(!sum.add(0.5) && sum.add(0.75) && sum.sum() == 5.25);
    // A NaN changes nothing, and the sum still stands above.
    assert!(sum.add(f64::NAN) && sum.sum() == 5.25);
    assert!(sum.add(f64::INFINITY) && sum.sum() == 10.0);
    assert!(sum.add(100.0) && sum.sum() == 10.0);
    assert!(!sum.add(-6.5) && sum.sum() == 3.0);
    assert!(!sum.add(-100.0) && sum.sum() == 0.0);
    assert!(!sum.add(0.25) && sum.sum() == 0.0);
    // A sample of zero lies below the allowance.
    assert!(!sum.add(2.0) && !sum.add(0.0) && sum.sum() == 1.0);
    sum.reset();
    assert!(!sum.add(f64::NEG_INFINITY) && sum.sum() == 0.0);
    for bad in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(Cusum::new(bad, 5.0).is_err() && Cusum::new(0.5, bad).is_err());
    }
    assert!(Cusum::new(0.5, 0.0).is_err() && Cusum::new(0.0, 5.0).is_ok());
}

/// The greatest sum of the last samples less the allowance, by all of them.
#[test]
fn a_sum_is_the_greatest_of_all_that_end_now() {
    let mut rng = Pcg64Mcg::seed_from_u64(121);
    let mut sum = Cusum::new(0.5, 6.0).unwrap();
    let mut all = Vec::new();
    for _ in 0..2000 {
        let x: f64 = StandardNormal.sample(&mut rng);
        all.push(x);
        let (mut tail, mut greatest) = (0.0, 0.0_f64);
        for x in all.iter().rev() {
            tail += x - 0.5;
            greatest = greatest.max(tail);
        }
        // It is bounded by twice the threshold, which is not reached here.
        assert!(greatest < 12.0);
        let passed = sum.add(x);
        assert!((sum.sum() - greatest).abs() < 1e-12);
        assert_eq!(passed, sum.sum() > 6.0);
    }
}

fn plain(all: &[f64], window: usize, threshold: f64) -> bool {
    let mut sum = 0.0;
    all.iter().rev().take(window).zip(1..).any(|(x, count)| {
        sum += x;
        sum > 0.0 && sum * sum > 2.0 * threshold * f64::from(count)
    })
}

/// On samples of all sizes, with changes of all lengths, and with the memory of all that came before.
#[test]
fn likelihood_ratio_is_its_definition_on_changes_of_all_sizes() {
    let mut rng = Pcg64Mcg::seed_from_u64(122);
    for (window, threshold) in [(2, 0.5), (3, 8.0), (5, 30.0), (15, 2.0), (16, 12.0)] {
        let mut ratio = LikelihoodRatio::<f64, 16>::with_window(window, threshold).unwrap();
        let (mut all, mut passed) = (Vec::new(), 0);
        for trial in 0..400 {
            // A change by so much for so long that some pass at one count only.
            let count = rng.random_range(1..=2 * window);
            let size = (2.0 * threshold / count as f64).sqrt() * rng.random_range(0.8..1.2);
            for index in 0..count + 20 {
                let noise: f64 = StandardNormal.sample(&mut rng);
                let x = if index < count { size } else { 0.1 * noise - 0.2 * size };
                all.push(x);
                let wanted = plain(&all, window, threshold);
                passed += u32::from(wanted);
                assert_eq!(ratio.add(x), wanted, "window {window}, trial {trial}, sample {index}");
                assert!(!ratio.add(f64::NAN) && !ratio.add(f64::INFINITY) && !ratio.add(f64::NEG_INFINITY));
            }
            if trial % 5 == 0 {
                ratio.reset();
                all.clear();
            }
        }
        assert!(passed > 50, "{passed}");
    }
    for (window, threshold) in
        [(1, 3.0), (17, 3.0), (0, 3.0), (8, 0.0), (8, -1.0), (8, f64::NAN), (8, f64::INFINITY)]
    {
        assert!(LikelihoodRatio::<f64, 16>::with_window(window, threshold).is_err(), "{window} {threshold}");
    }
    assert!(
        LikelihoodRatio::<f64, 2>::new(3.0).is_ok()
            && LikelihoodRatio::<f64, 16>::with_window(16, 3.0).is_ok()
    );
}

#[test]
fn a_likelihood_ratio_passes_above_its_threshold() {
    let mut ratio = LikelihoodRatio::<f64, 16>::new(2.0).unwrap();
    assert!(!ratio.add(2.0) && ratio.add(1.0));
}

/// Samples near the end of the range, which overflow sums and squares, come out as a change.
#[test]
fn huge_samples_pass_and_are_forgotten() {
    let mut ratio = LikelihoodRatio::<f64, 4>::new(3.0).unwrap();
    assert!(ratio.add(f64::MAX) && ratio.add(f64::MAX));
    for _ in 0..3 {
        ratio.add(-10.0);
    }
    assert!(!ratio.add(-10.0) && !ratio.add(0.0));
}

#[test]
fn detectors_refuse_what_they_cannot_use() {
    let noise = ForceNoise::isotropic(0.02).unwrap();
    let new = |noise, alarms, rate| LikelihoodRatioDetector::<f64, 16>::new(noise, alarms, rate);
    assert!(new(noise, 1.0, 1000.0).is_ok());
    assert!(new(noise, 0.0, 1000.0).is_err() && new(noise, 1.0, f64::NAN).is_err());
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-200, 1e200] {
        for bad in [ForceNoise { normal: bad, ..noise }, ForceNoise { tangential: bad, ..noise }] {
            let refused = new(bad, 1.0, 1000.0).unwrap_err();
            assert!(refused.parameter.starts_with("noise of the "), "{refused}");
            assert!(fingertip_friction::DropDetector::new(bad).is_err());
        }
    }
    let refused = |bad| fingertip_friction::DropDetector::new(bad).unwrap_err().parameter;
    assert_eq!(refused(ForceNoise { normal: 1e-200, ..noise }), "noise of the normal force");
    assert_eq!(refused(ForceNoise { tangential: 1e200, ..noise }), "noise of the tangential force");
    assert_eq!(refused(ForceNoise { normal: 0.0, ..noise }), "noise of the normal force");
    assert_eq!(refused(ForceNoise { tangential: f64::NAN, ..noise }), "noise of the tangential force");
}

#[test]
fn gate_is_at_ten_deviations() {
    let noise = ForceNoise { normal: 0.05, tangential: 0.2 };
    let gate = NormalForceGate::from_noise(&noise);
    assert_eq!(gate.least(), 0.5);
    let at =
        |normal: f64, load: f64| gate.ratio(&ContactForce::new(normal, Vector3::new(load, 0.0, 0.0), 0.0));
    assert_eq!((at(0.5, 0.1), at(0.512, 0.128), at(2.0, 3.0)), (None, Some(0.25), Some(1.5)));
    assert_eq!((at(f64::NAN, 1.0), at(2.0, f64::NAN), at(-2.0, 1.0)), (None, None, None));
}

/// The deviation of a ratio, by sampling.
#[test]
fn ratio_deviation_agrees_with_sampling() {
    let mut rng = Pcg64Mcg::seed_from_u64(123);
    let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
    for noise in
        [ForceNoise { normal: 0.02, tangential: 0.001 }, ForceNoise { normal: 0.001, tangential: 0.02 }]
    {
        for (normal, ratio) in [(2.0, 0.5), (4.0, 2.0)] {
            let count = 100_000;
            let sum: f64 = (0..count)
                .map(|_| {
                    let n = normal + noise.normal * draw();
                    let r = (ratio * normal + noise.tangential * draw()) / n - ratio;
                    r * r
                })
                .sum();
            let sampled = (sum / f64::from(count)).sqrt();
            // Sampling errs by 1/√(2·count), four times which is 0.9 %.
            assert!((noise.ratio_deviation(normal, ratio) / sampled - 1.0).abs() < 0.01);
        }
    }
}

/// At the limits themselves it warns and slips; at the gate it does not press.
#[test]
fn threshold_verdicts_at_the_limits_themselves() {
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.0625).unwrap());
    let mut detector = RatioThreshold::new(gate, 0.5).unwrap().with_warning_share(0.75).unwrap();
    for (normal, load, wanted) in [
        (2.0, 0.7499, SlipVerdict::Holding),
        (2.0, 0.75, SlipVerdict::Warning),
        (2.0, 0.9999, SlipVerdict::Warning),
        (2.0, 1.0, SlipVerdict::Slipping),
        (0.625, 0.0, SlipVerdict::NotPressing),
        (0.6251, 0.0, SlipVerdict::Holding),
        (-1.0, 0.5, SlipVerdict::NotPressing),
        (2.0, f64::INFINITY, SlipVerdict::NotPressing),
        (f64::NAN, 0.0, SlipVerdict::NotPressing),
        (f64::MAX, f64::MAX, SlipVerdict::Slipping),
    ] {
        let force = ContactForce::new(normal, Vector3::new(0.0, load, 0.0), 0.0);
        assert_eq!(detector.update(&force, 1e-3), wanted, "{normal} {load}");
        assert_eq!(detector.verdict_of(normal, load), wanted, "{normal} {load}");
        if load.is_finite() {
            assert_eq!(detector.verdict_in_contact(normal, load), wanted);
        }
    }
    assert_eq!(detector.verdict_of(2.0, f64::NAN), SlipVerdict::NotPressing);
    assert_eq!(detector.verdict_of(2.0, -0.1), SlipVerdict::NotPressing);
    assert!(
        RatioThreshold::new(gate, 0.5).and_then(|detector| detector.with_warning_share(1.0)).is_ok()
            && RatioThreshold::new(gate, f64::INFINITY)
                .and_then(|detector| detector.with_warning_share(0.5))
                .is_err()
    );
    // The shortest column counts.
    let mut verdicts = [SlipVerdict::NotPressing; 3];
    detector.verdicts(&[2.0, 2.0], &[0.0, 1.0, 1.0], &mut verdicts);
    assert_eq!(verdicts, [SlipVerdict::Holding, SlipVerdict::Slipping, SlipVerdict::NotPressing]);
}
