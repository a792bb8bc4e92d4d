//! How much of a fall is evidence. A sum at rest passes at once if the evidence of one sample is above
//! allowance and threshold together: so a bisection over the size of a drop measures the evidence.

use fingertip_friction::{
    Cusum, DropDetector, ForceNoise, LikelihoodRatio, LikelihoodRatioDetector, SlipDetector, SlipVerdict,
};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

const PERIOD: f64 = 1e-3;
/// Allowance and threshold together.
const THRESHOLD: f64 = 2.0;
const NOISE: ForceNoise<f64> = ForceNoise { normal: 0.05, tangential: 0.02 };

fn force(normal: f64, tangential: f64) -> ContactForce<f64> {
    ContactForce::new(normal, Vector3::new(0.6 * tangential, -0.8 * tangential, 0.0), 0.0)
}

fn detector() -> DropDetector<f64> {
    DropDetector::with_sum(NOISE, Cusum::new(0.5, THRESHOLD - 0.5).unwrap()).unwrap()
}

/// After a hold of so many samples, so short a time apart.
fn held(normal: f64, tangential: f64, count: usize, period: f64) -> DropDetector<f64> {
    let mut detector = detector();
    for index in 0..count {
        // No sample is that before.
        let change = if index % 2 == 0 { 1e-9 } else { 0.0 };
        let verdict = detector.update(&force(normal, tangential + change), period);
        assert_ne!(verdict, SlipVerdict::Slipping);
    }
    detector
}

/// The least size at which `slips` after it, by bisection; `None` if not even at `greatest`.
fn critical(greatest: f64, slips: impl Fn(f64) -> bool) -> Option<f64> {
    if !slips(greatest) {
        return None;
    }
    let (mut low, mut high) = (0.0, greatest);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if slips(middle) { high = middle } else { low = middle }
    }
    Some(high)
}

fn after(detector: &DropDetector<f64>, normal: f64, tangential: f64) -> bool {
    let mut detector = *detector;
    detector.update(&force(normal, tangential), PERIOD) == SlipVerdict::Slipping
}

/// The deviation of what a sample lies off its forecast by, over that of the sample: from the response of
/// an α-β tracker to one sample of 1 among zeros.
fn innovation_deviation() -> f64 {
    let alpha = 0.15;
    let beta = alpha * alpha / (2.0 - alpha);
    let (mut value, mut slope, mut variance) = (0.0_f64, 0.0_f64, 1.0);
    for index in 0..2000 {
        let forecast = value + slope;
        variance += forecast * forecast;
        let miss = if index == 0 { 1.0 } else { 0.0 } - forecast;
        value = forecast + alpha * miss;
        slope += beta * miss;
    }
    variance.sqrt()
}

/// Deviation of `|f_t| − R f_n`, by which a fall of the ratio at one normal force is measured.
fn across(ratio: f64) -> f64 {
    NOISE.tangential.hypot(ratio * NOISE.normal)
}

#[test]
fn a_drop_of_the_tangential_force_counts_in_deviations_of_the_ratio() {
    for (normal, tangential) in [(4.0, 1.6), (4.0, 0.4), (2.0, 3.0), (10.0, 1.0)] {
        let held = held(normal, tangential, 60, PERIOD);
        let found = critical(tangential, |drop| after(&held, normal, tangential - drop)).unwrap();
        let wanted = THRESHOLD * innovation_deviation() * across(tangential / normal);
        // The weight errs by less than its slack of 1/64.
        assert!((found / wanted - 1.0).abs() < 1.0 / 64.0, "{normal} {tangential}: {found} {wanted}");
        assert!(!after(&held, normal, tangential + 10.0 * wanted), "a rise is no slip");
    }
}

/// The weight goes with the ratio, up and down.
#[test]
fn a_drop_counts_by_the_ratio_of_the_day() {
    for (start, end) in [(0.4, 6.0), (6.0, 0.4)] {
        let mut detector = held(4.0, start, 60, PERIOD);
        for index in 0..3000 {
            // Slow, and then at rest.
            let share = (f64::from(index) / 2000.0).min(1.0);
            let change = if index % 2 == 0 { 1e-9 } else { 0.0 };
            detector.update(&force(4.0, start + (end - start) * share + change), PERIOD);
        }
        let found = critical(end, |drop| after(&detector, 4.0, end - drop)).unwrap();
        let wanted = THRESHOLD * innovation_deviation() * across(end / 4.0);
        assert!((found / wanted - 1.0).abs() < 1.0 / 32.0, "{start} to {end}: {found} {wanted}");
    }
}

/// Against a forecast that goes on along a line, over a step of any length.
#[test]
fn a_drop_counts_from_the_line_that_was_followed() {
    let mut detector = detector();
    for index in 0..100_i32 {
        detector.update(&force(4.0, 2.0 + 0.01 * f64::from(index - 99)), PERIOD);
    }
    for s in [0.7, 1.0, 3.0, 8.0] {
        let found = critical(1.0, |drop| {
            let sample = force(4.0, 2.0 + 0.01 * s - drop);
            detector.clone().update(&sample, s * PERIOD) == SlipVerdict::Slipping
        });
        let wanted = THRESHOLD * innovation_deviation() * across(0.5 + 0.0025 * s);
        assert!((found.unwrap() / wanted - 1.0).abs() < 1.0 / 32.0, "{s}: {found:?} {wanted}");
    }
}

/// Also after a step of the normal force, with which the ratio jumps, once its roughness is forgotten.
#[test]
fn a_drop_counts_by_the_ratio_after_a_jump() {
    for (before, after_it) in [(4.0, 60.0), (60.0, 4.0)] {
        let mut detector = held(before, 6.0, 60, PERIOD);
        for index in 0..2000 {
            let change = if index % 2 == 0 { 1e-9 } else { 0.0 };
            detector.update(&force(after_it, 6.0 + change), PERIOD);
        }
        let found = critical(6.0, |drop| after(&detector, after_it, 6.0 - drop)).unwrap();
        let unit = THRESHOLD * innovation_deviation() * across(6.0 / after_it);
        assert!((found / unit - 1.0).abs() < 1.0 / 32.0, "{before} to {after_it}: {found} {unit}");
    }
}

/// The lesser of two falls counts: a step of the normal force moves only the ratio of a contact that
/// holds, and only the force of one that slides.
#[test]
fn both_ratio_and_force_have_to_fall() {
    let held = held(4.0, 1.6, 60, PERIOD);
    assert_eq!(critical(100.0, |rise| after(&held, 4.0 + rise, 1.6)), None);
    assert_eq!(critical(3.0, |fall| after(&held, 4.0 - fall, 1.6 * (4.0 - fall) / 4.0)), None);
    // With the ratio far down, the force decides by its own deviation.
    let found = critical(1.6, |drop| after(&held, 8.0, 1.6 - drop)).unwrap();
    let wanted = THRESHOLD * innovation_deviation() * NOISE.tangential;
    // But for the billionth by which no sample is that before.
    assert!((found / wanted - 1.0).abs() < 1e-6, "{found} {wanted}");
    // With the force far down, the ratio does: 0.4·2 − drop off a load of 0.8.
    let found = critical(0.8, |drop| after(&held, 2.0, 0.8 - drop)).unwrap();
    let wanted = THRESHOLD * innovation_deviation() * across(0.4);
    assert!((found / wanted - 1.0).abs() < 1.0 / 64.0, "{found} {wanted}");
}

/// The mean of five samples has a deviation less by the root of five.
#[test]
fn a_mean_of_samples_counts_for_more() {
    let held = held(4.0, 1.6, 301, 1e-4);
    let slips = |drop: f64| {
        let mut detector = held;
        (0..5).any(|index| {
            let sample = force(4.0, 1.6 - drop - 1e-9 * f64::from(index));
            detector.update(&sample, 1e-4) == SlipVerdict::Slipping
        })
    };
    let found = critical(1.6, slips).unwrap();
    let wanted = THRESHOLD * innovation_deviation() * across(0.4) / 5.0_f64.sqrt();
    assert!((found / wanted - 1.0).abs() < 1.0 / 64.0, "{found} {wanted}");
}

/// After contact, after a gap and after an alarm, eight samples give no evidence, and the ninth does.
#[test]
fn the_first_eight_samples_give_no_evidence() {
    let after_contact = held(4.0, 1.6, 1, PERIOD);
    let mut after_gap = held(4.0, 1.6, 60, PERIOD);
    assert_eq!(after_gap.update(&force(4.0, 1.6), 0.1), SlipVerdict::Holding);
    let mut after_alarm = held(4.0, 1.6, 60, PERIOD);
    assert_eq!(after_alarm.update(&force(4.0, 0.8), PERIOD), SlipVerdict::Slipping);
    for (start, level) in [(after_contact, 1.6), (after_gap, 1.6), (after_alarm, 0.8)] {
        assert!((start.ratio().unwrap() - level / 4.0).abs() < 1e-9);
        for count in 2..=9 {
            let mut detector = start;
            for index in 2..count {
                let change = if index % 2 == 0 { 1e-9 } else { 0.0 };
                assert_eq!(detector.update(&force(4.0, level + change), PERIOD), SlipVerdict::Holding);
            }
            assert_eq!(after(&detector, 4.0, 0.1), count == 9, "sample {count}");
            if count == 9 {
                // Both lines have started from the level now held: each decides as in a long hold, but for the
                // forecast of a line through eight points, 1 + 34/56 times the variance of one.
                let by_ratio = critical(0.5, |drop| after(&detector, 4.0, level - drop)).unwrap();
                let by_force = critical(0.5, |drop| after(&detector, 8.0, level - drop)).unwrap();
                let unit = THRESHOLD * (1.0 + 34.0 / 56.0_f64).sqrt();
                // The drop that alarmed counts as roughness of a few per cent, still.
                let rough = if level < 1.0 { 1.0 / 16.0 } else { 1e-6 };
                assert!(
                    (by_ratio / (unit * across(level / 4.0)) - 1.0).abs() < 1.0 / 32.0 + rough,
                    "{by_ratio}"
                );
                assert!((by_force / (unit * NOISE.tangential) - 1.0).abs() < rough, "{by_force}");
            }
        }
    }
}

#[test]
fn evidence_adds_up_over_samples_and_a_repeated_sample_adds_none() {
    let unit = innovation_deviation() * across(0.4);
    let held = held(4.0, 1.6, 60, PERIOD);
    let mut detector = held;
    // Three quarters of it, and again, though the forecast comes down.
    let low = 1.6 - 0.75 * THRESHOLD * unit;
    assert_eq!(detector.update(&force(4.0, low), PERIOD), SlipVerdict::Holding);
    let mut repeated = detector;
    for _ in 0..5 {
        assert_eq!(repeated.update(&force(4.0, low), PERIOD), SlipVerdict::Holding);
    }
    assert_eq!(detector.update(&force(4.0, low - 1e-9), PERIOD), SlipVerdict::Slipping);
    // No time passes: the same sample again.
    let mut still = held;
    assert_eq!(still.update(&force(4.0, 0.1), 0.0), SlipVerdict::Holding);
    assert_eq!(still.update(&force(4.0, 0.1), -PERIOD), SlipVerdict::Holding);
    assert_eq!(still, held);
}

/// Noise above the stated costs sensitivity: the deviation is then that of the innovations themselves, each of which
/// counts for eight stated deviations at most.
#[test]
fn rougher_noise_than_stated_is_learnt() {
    let mut rng = Pcg64Mcg::seed_from_u64(71);
    let mut draw = || -> f64 { StandardNormal.sample(&mut rng) };
    // 40 deviations pass the allowance, so that noise never does.
    let quiet = DropDetector::with_sum(NOISE, Cusum::new(40.0, 1e-6).unwrap()).unwrap();
    let measured = |times: f64, draw: &mut dyn FnMut() -> f64| {
        let mut detector = quiet;
        let (mut sum, mut count) = (0.0, 0.0);
        for index in 0..60_000 {
            let (n, t) = (40.0 + times * NOISE.normal * draw(), 16.0 + times * NOISE.tangential * draw());
            detector.update(&force(n, t), PERIOD);
            if index > 2000 && index % 50 == 0 {
                sum += critical(16.0, |drop| after(&detector, 40.0, 16.0 - drop)).unwrap_or(f64::NAN);
                count += 1.0;
            }
        }
        sum / count
    };
    // E[min(t²x², 64)] of a normal x, by the mid-point rule.
    let clipped = |times: f64| {
        let h = 1e-3;
        let density = |x: f64| (-0.5 * x * x).exp() / core::f64::consts::TAU.sqrt();
        (0..20_000)
            .map(|k| h * (f64::from(k) + 0.5))
            .map(|x| 2.0 * h * density(x) * (times * times * x * x).min(64.0))
            .sum::<f64>()
    };
    let plain = measured(0.5, &mut draw);
    for times in [2.0, 5.0, 10.0] {
        let (rough, wanted) = (measured(times, &mut draw), clipped(times).sqrt() * plain);
        println!("noise of {times} times: drop of {rough:.3} N instead of {wanted:.3}");
        assert!((rough / wanted - 1.0).abs() < 0.03, "{times}: {rough} {wanted}");
    }
}

/// The rate of alarms on white noise is that of the sum on independent samples, or below: theory's run
/// length is a lower bound, since the lesser of two falls counts. With the normal force known well, the two
/// are one, and their innovations hang together but little.
#[test]
fn run_lengths_on_white_noise_are_those_of_theory() {
    let noise = ForceNoise { normal: 1e-4, tangential: 0.02 };
    let (allowance, threshold) = (0.75, 3.0);
    let told = fingertip_friction::run_length::cusum_run_length(allowance, threshold, 0.0);
    let mut rng = Pcg64Mcg::seed_from_u64(72);
    let mut detector = DropDetector::with_sum(noise, Cusum::new(allowance, threshold).unwrap()).unwrap();
    let (mut samples, mut alarms) = (0.0, 0.0);
    for _ in 0..400_000 {
        let t: f64 = StandardNormal.sample(&mut rng);
        samples += 1.0;
        if detector.update(&force(4.0, 1.6 + 0.02 * t), PERIOD) == SlipVerdict::Slipping {
            alarms += 1.0;
            // The start-up gives no evidence.
            samples -= 8.0;
        }
    }
    let found = samples / alarms;
    println!("run length {found:.0}, of independent samples {told:.0}, {alarms} alarms");
    assert!((0.9..2.0).contains(&(found / told)), "{found} {told}");
}

#[test]
fn the_likelihood_ratio_gets_the_same_evidence() {
    let ratio = LikelihoodRatio::<f64, 16>::new(0.5 * THRESHOLD * THRESHOLD).unwrap();
    let mut other = LikelihoodRatioDetector::with_ratio(NOISE, ratio).unwrap();
    for index in 0..60 {
        let change = if index % 2 == 0 { 1e-9 } else { 0.0 };
        other.update(&force(4.0, 1.6 + change), PERIOD);
    }
    let held = held(4.0, 1.6, 60, PERIOD);
    let own = critical(1.6, |drop| after(&held, 4.0, 1.6 - drop)).unwrap();
    let found = critical(1.6, |drop| {
        let mut detector = other;
        detector.update(&force(4.0, 1.6 - drop), PERIOD) == SlipVerdict::Slipping
    });
    // One sample above √(2·threshold), after sixteen of no evidence to speak of.
    assert!((found.unwrap() / own - 1.0).abs() < 1e-6, "{found:?} {own}");
}

#[test]
fn defaults_are_what_is_written() {
    let sum = Cusum::new(0.75, 7.0).unwrap();
    assert_eq!(DropDetector::new(NOISE).unwrap(), DropDetector::with_sum(NOISE, sum).unwrap());
}
