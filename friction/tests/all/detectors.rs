//! Detectors on made signals whose truth is known.

use fingertip_friction::{
    Cusum, DropDetector, ForceNoise, IncipientSlip, LikelihoodRatio, LikelihoodRatioDetector,
    NormalForceGate, RatioThreshold, SlipDetector, SlipVerdict, StickSlipDetector,
};
use fingertip_test_support::Worst;
use fingertip_wrench::{ContactForce, Real};
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

fn force<T: Real>(normal: f64, tangential: f64) -> ContactForce<T> {
    ContactForce::new(
        T::literal(normal),
        Vector3::new(T::zero(), T::literal(tangential), T::zero()),
        T::zero(),
    )
}

struct Noise(Pcg64Mcg);

impl Noise {
    fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    fn draw(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }
}

#[test]
fn threshold_warns_before_it_slips() {
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.02).unwrap());
    let mut detector = RatioThreshold::new(gate, 0.5).unwrap().with_warning_share(0.9).unwrap();
    let mut verdict = |normal: f64, tangential: f64| detector.update(&force(normal, tangential), 1e-3);
    assert_eq!(verdict(2.0, 0.89), SlipVerdict::Holding);
    assert_eq!(verdict(2.0, 0.91), SlipVerdict::Warning);
    assert_eq!(verdict(2.0, 1.0), SlipVerdict::Slipping);
    assert_eq!(verdict(0.19, 1.0), SlipVerdict::NotPressing);
    assert_eq!(verdict(f64::NAN, 1.0), SlipVerdict::NotPressing);
    assert_eq!(verdict(2.0, f64::NAN), SlipVerdict::NotPressing);
    assert_eq!(verdict(f64::INFINITY, f64::INFINITY), SlipVerdict::NotPressing);
    for (mu, share) in [(0.0, 0.5), (f64::NAN, 0.5), (0.5, 0.0), (0.5, 1.1), (0.5, f64::NAN)] {
        assert!(
            RatioThreshold::new(gate, mu).and_then(|detector| detector.with_warning_share(share)).is_err()
        );
    }
}

#[test]
fn page_hinkley_is_the_same_statistic() {
    let mut noise = Noise::new(1);
    let mut sum = Cusum::new(0.5, 1e9).unwrap();
    let (mut walk, mut least) = (0.0_f64, 0.0_f64);
    for _ in 0..10_000 {
        let x = noise.draw();
        sum.add(x);
        walk += x - 0.5;
        least = least.min(walk);
        // The plain walk rounds at its own size.
        assert!((sum.sum() - (walk - least)).abs() < 1e-13 * (1.0 + walk.abs()) * 100.0);
    }
}

#[test]
fn cumulative_sum_bears_bad_samples() {
    let mut sum = Cusum::new(0.5_f64, 5.0).unwrap();
    sum.add(3.0);
    let before = sum;
    sum.add(f64::NAN);
    assert_eq!(sum, before);
    assert!(sum.add(f64::INFINITY) && sum.sum() <= 10.0);
    sum.add(f64::NEG_INFINITY);
    assert_eq!(sum.sum(), 0.0);
    assert!(Cusum::new(f64::NAN, 1.0).is_err() && Cusum::new(0.5, 0.0).is_err());
    assert!(Cusum::for_false_alarms(0.75_f32, 1.0, 1000.0).is_ok());
    assert!(Cusum::for_false_alarms(0.75_f32, 0.0, 1000.0).is_err());
}

/// The windowed maximum against the plain definition.
#[test]
fn likelihood_ratio_is_its_definition() {
    let mut noise = Noise::new(2);
    for window in [2, 7, 16] {
        let mut ratio = LikelihoodRatio::<f64, 16>::with_window(window, 3.0).unwrap();
        let mut all: Vec<f64> = Vec::new();
        for _ in 0..5000 {
            let x = noise.draw();
            all.push(x);
            let mut sum = 0.0;
            let plain = all.iter().rev().take(window).zip(1..).any(|(x, count)| {
                sum += x;
                sum > 0.0 && sum * sum > 6.0 * f64::from(count)
            });
            assert_eq!(ratio.add(x), plain);
        }
        assert!(!ratio.add(f64::NAN));
    }
    assert!(LikelihoodRatio::<f64, 16>::with_window(17, 3.0).is_err());
    assert!(LikelihoodRatio::<f64, 1>::new(3.0).is_err());
}

fn likelihood_detector<T: Real>() {
    let mut noise = Noise::new(3);
    let deviations = ForceNoise::isotropic(T::literal(0.02)).unwrap();
    let mut detector = LikelihoodRatioDetector::<T, 16>::new(deviations, 1.0, 1000.0).unwrap();
    let mut false_alarms = 0;
    for index in 0..300_000 {
        let ratio = 0.4 + 0.1 * (f64::from(index) * 1e-3).sin();
        let sample = force(4.0 + 0.02 * noise.draw(), 4.0 * ratio + 0.02 * noise.draw());
        false_alarms += usize::from(detector.update(&sample, T::literal(1e-3)) == SlipVerdict::Slipping);
    }
    println!("likelihood ratio: {false_alarms} false alarms in 5 min");
    assert!(false_alarms <= 5);
    let mut found = 0;
    for _ in 0..200 {
        detector.reset();
        for _ in 0..100 {
            detector.update(&force(4.0 + 0.02 * noise.draw(), 1.6 + 0.02 * noise.draw()), T::literal(1e-3));
        }
        // Six deviations.
        found += usize::from((0..4).any(|_| {
            let sample = force(4.0 + 0.02 * noise.draw(), 1.48 + 0.02 * noise.draw());
            detector.update(&sample, T::literal(1e-3)) == SlipVerdict::Slipping
        }));
    }
    assert!(found >= 190, "{found}");
}

#[test]
fn likelihood_ratio_detector_finds_drops() {
    likelihood_detector::<f64>();
    likelihood_detector::<f32>();
}

#[test]
fn stick_slip_is_named_with_its_period() {
    let mut noise = Noise::new(4);
    let drops = DropDetector::new(ForceNoise::isotropic(0.02).unwrap()).unwrap();
    let mut detector = StickSlipDetector::new(drops);
    let mut saw = |detector: &mut StickSlipDetector<f64>, period: f64, count: u32| {
        for index in 0..count {
            let phase = (f64::from(index) * 1e-3 / period).fract();
            let tangential = if phase < 0.97 { 1.0 + 0.5 * phase } else { 1.485 - 16.0 * (phase - 0.97) };
            detector.update(&force(4.0 + 0.02 * noise.draw(), tangential + 0.02 * noise.draw()), 1e-3);
        }
    };
    saw(&mut detector, 0.08, 150);
    assert!(detector.motion().is_none());
    saw(&mut detector, 0.08, 400);
    let motion = detector.motion().unwrap();
    assert!((motion.period - 0.08).abs() < 0.004 && motion.spread < 0.2, "{motion:?}");
    // It ends with the drops, and with the contact.
    for _ in 0..130 {
        detector.update(&force(4.0, 1.0), 1e-3);
    }
    assert!(detector.motion().is_none());
    saw(&mut detector, 0.08, 600);
    assert!(detector.motion().is_some());
    detector.update(&force(0.0, 0.0), 1e-3);
    assert!(detector.motion().is_none());
}

/// A pad on a rigid surface that lets go bit by bit, as Mindlin's contact does:
/// `F = μN (1 − (1 − x/x₀)^{3/2})`, moved at several rates and directions.
#[test]
fn incipient_slip_is_seen_before_gross_slip_at_any_rate() {
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.01).unwrap());
    let (limit, full) = (2.0, 100e-6);
    let mut warned_at = Vec::new();
    for (rate, direction) in [
        (10e-6, Vector3::new(1.0, 0.0, 0.0)),
        (100e-6, Vector3::new(0.6, 0.8, 0.0)),
        (2e-3, Vector3::new(0.0, -1.0, 0.0)),
    ] {
        let mut detector = IncipientSlip::<f64>::new(gate, 4e-6).unwrap();
        // Half a second of rest with a load that relaxes: nothing is judged.
        for _ in 0..500 {
            assert_eq!(detector.update(&force(4.0, 0.0), &Vector3::zeros()), SlipVerdict::Holding);
        }
        let (mut warned, mut slipped, mut x) = (None, None, 0.0);
        while x < 150e-6 {
            x += rate * 1e-3;
            let share = 1.0 - (1.0 - f64::min(x / full, 1.0)).powf(1.5);
            let sample = ContactForce::new(4.0, -direction * (limit * share), 0.0);
            match detector.update(&sample, &(direction * x)) {
                SlipVerdict::Warning => warned = warned.or(Some(x)),
                SlipVerdict::Slipping => slipped = slipped.or(Some(x)),
                _ => {}
            }
        }
        let (warned, slipped) = (warned.unwrap(), slipped.unwrap());
        println!("rate {rate:e}: warned at {warned:.2e} m, slip at {slipped:.2e} m of {full:.0e}");
        assert!(warned < 0.9 * full && slipped > warned && slipped < 1.1 * full);
        warned_at.push(warned);
        // Turning back starts anew.
        let back = ContactForce::new(4.0, -direction * limit * 0.9, 0.0);
        assert_eq!(detector.update(&back, &(direction * (x - 3e-6))), SlipVerdict::Holding);
    }
    // Up to one sample of the fastest motion and one place.
    let mut spread = Worst::new();
    warned_at.iter().for_each(|way| spread.see(way - warned_at[0]));
    assert!(warned_at.len() == 3 && spread.get() < 6e-6, "{warned_at:?}");
    assert!(IncipientSlip::<f64>::new(gate, f64::NAN).is_err());
    assert!(IncipientSlip::<f64>::new(gate, 1e-6).unwrap().with_warning_share(0.1).is_err());
}

/// A sample without contact is an update with no force, for every detector and at any time.
#[test]
fn an_open_contact_is_a_force_of_zero() {
    fn same<D: SlipDetector<f64> + Clone + PartialEq + core::fmt::Debug>(detector: &D) {
        let (mut one, mut other) = (detector.clone(), detector.clone());
        let steps = [1e-3, 1e-3, 1e-3, 0.0, 0.1, f64::NAN, -1e-3, f64::INFINITY];
        for k in 0..4000_u32 {
            let step = steps[if k % 97 == 0 { k as usize % steps.len() } else { 0 }];
            // Stretches of contact with drops, and others without.
            let verdicts = if k % 613 > 570 {
                (one.update_open(step), other.update(&ContactForce::zero(), step))
            } else {
                let load = force(4.0, 1.0 + 0.2 * f64::from(k % 80) / 80.0);
                (one.update(&load, step), other.update(&load, step))
            };
            assert_eq!(verdicts.0, verdicts.1, "sample {k}");
            assert_eq!(one, other, "sample {k}");
        }
    }
    let noise = ForceNoise::isotropic(0.02).unwrap();
    let drops = DropDetector::new(noise).unwrap();
    same(&drops);
    same(&StickSlipDetector::new(drops));
    same(&LikelihoodRatioDetector::<f64, 16>::new(noise, 1.0, 1000.0).unwrap());
    same(
        &RatioThreshold::new(NormalForceGate::from_noise(&noise), 0.6)
            .unwrap()
            .with_warning_share(0.75)
            .unwrap(),
    );
}
