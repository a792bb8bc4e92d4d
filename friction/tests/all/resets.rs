//! What a reset forgets: a detector or estimator that was used and reset says what a new one says.

use core::fmt::Debug;

use fingertip_friction::{
    AdaptiveDropDetector, Cusum, DropDetector, ForceNoise, IncipientSlip, KineticFriction, LikelihoodRatio,
    LikelihoodRatioDetector, NormalForceGate, RatioThreshold, SlipDetector, SlipVerdict, StaticFriction,
    StickSlipDetector,
};
use fingertip_wrench::ContactForce;
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

const NOISE: ForceNoise<f64> = ForceNoise { normal: 0.02, tangential: 0.02 };

struct Noise(Pcg64Mcg);

impl Noise {
    fn draw(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    fn force(&mut self, tangential: f64) -> ContactForce<f64> {
        let (n, t) = (4.0 + 0.02 * self.draw(), tangential + 0.02 * self.draw());
        ContactForce::new(n, Vector3::new(t, 0.0, 0.0), 0.0)
    }
}

/// Reset at many places of a stream with drops. Each copy of the detector that was not reset has to part
/// from the new one somewhere, or the stream shows nothing.
fn forgets<D: SlipDetector<f64> + Clone + Debug>(new: &D) {
    let mut noise = Noise(Pcg64Mcg::seed_from_u64(81));
    let mut used = new.clone();
    let mut parted = 0;
    for trial in 0..300 {
        for index in 0..(10 + trial % 37) {
            used.update(&noise.force(1.0 + 0.01 * f64::from(index % 20)), 1e-3);
        }
        let (mut fresh, mut kept) = (new.clone(), used.clone());
        used.reset();
        // By way of a reference, too.
        let mut by_reference = kept.clone();
        reset_through_a_reference(&mut by_reference);
        let mut differs = false;
        for index in 0..40 {
            let force = noise.force(if index < 12 { 1.2 } else { 1.13 });
            let wanted = fresh.update(&force, 1e-3);
            assert_eq!(used.update(&force, 1e-3), wanted, "trial {trial}, sample {index}");
            assert_eq!(update_through_a_reference(&mut by_reference, &force), wanted);
            differs |= kept.update(&force, 1e-3) != wanted;
        }
        parted += u32::from(differs);
    }
    assert!(parted > 10, "{parted} of 300 {new:?}");
}

fn update_through_a_reference(
    mut detector: impl SlipDetector<f64>,
    force: &ContactForce<f64>,
) -> SlipVerdict {
    detector.update(force, 1e-3)
}

fn reset_through_a_reference(mut detector: impl SlipDetector<f64>) {
    detector.reset();
}

#[test]
fn detectors_forget_all_samples() {
    let drops = DropDetector::with_sum(NOISE, Cusum::new(0.5, 2.0).unwrap()).unwrap();
    forgets(&drops);
    forgets(&StickSlipDetector::new(drops));
    let ratio = LikelihoodRatio::<f64, 16>::new(2.5).unwrap();
    forgets(&LikelihoodRatioDetector::with_ratio(NOISE, ratio).unwrap());
}

#[test]
fn a_reset_drop_detector_is_a_new_one() {
    let new = DropDetector::new(NOISE).unwrap();
    let mut used = new;
    let mut noise = Noise(Pcg64Mcg::seed_from_u64(82));
    for _ in 0..100 {
        used.update(&noise.force(1.0), 1e-3);
    }
    // So that its sum is not zero.
    while used.update(&noise.force(0.99), 1e-3) != SlipVerdict::Slipping {
        let mut reset = used;
        reset.reset();
        assert_eq!(reset, new);
        assert_eq!(reset.ratio(), None);
        assert_ne!(used, new);
        if noise.draw() < -2.5 {
            return;
        }
    }
}

/// What was seen of one contact is no evidence in the next, nor what was seen before a gap: 1.83 N and, later,
/// 1.95 N are too little each.
fn starts_anew<D: SlipDetector<f64> + Clone + Debug>(new: &D) {
    let force =
        |normal: f64, tangential: f64| ContactForce::new(normal, Vector3::new(tangential, 0.0, 0.0), 0.0);
    let mut used = new.clone();
    for index in 0..1000_u32 {
        used.update(&force(5.0, 2.0 + 1e-9 * f64::from(index % 7)), 1e-3);
    }
    assert_eq!(used.update(&force(5.0, 1.83), 1e-3), SlipVerdict::Holding, "{new:?}");
    let last = |mut detector: D| {
        for index in 0..8_u32 {
            detector.update(&force(5.0, 2.0 + 1e-9 * f64::from(index % 7)), 1e-3);
        }
        detector.update(&force(5.0, 1.95), 1e-3)
    };
    let (mut open, mut let_go, mut gone, mut out) = (used.clone(), used.clone(), used.clone(), used.clone());
    open.update_open(1e-3);
    let_go.update(&force(0.0, 0.0), 1e-3);
    gone.update(&force(5.0, 2.0), 10.0);
    out.update(&force(5.0, f64::MAX / 2.0), 1e-3);
    for (name, detector) in [("open", open), ("let go", let_go), ("gap", gone), ("out of range", out)] {
        assert_eq!(last(detector), SlipVerdict::Holding, "{name}: {new:?}");
    }
}

#[test]
fn what_was_seen_before_a_lift_off_or_a_gap_does_not_count() {
    let drops = DropDetector::new(NOISE).unwrap();
    starts_anew(&drops);
    starts_anew(&StickSlipDetector::new(drops));
    // A sum that forgets nothing by itself.
    starts_anew(&DropDetector::with_sum(NOISE, Cusum::new(0.0, 8.5).unwrap()).unwrap());
    let ratio = LikelihoodRatio::<f64, 16>::new(33.0).unwrap();
    starts_anew(&LikelihoodRatioDetector::with_ratio(NOISE, ratio).unwrap());
    let mut noise = Noise(Pcg64Mcg::seed_from_u64(87));
    let mut learnt = AdaptiveDropDetector::new(NOISE, 1.0, 1000.0).unwrap();
    for _ in 0..3000 {
        learnt.update(&noise.force(2.0), 1e-3);
    }
    // All but what it knows of the noise.
    learnt.update_open(1e-3);
    let fresh = learnt;
    for _ in 0..100 {
        learnt.update(&noise.force(2.0), 1e-3);
    }
    learnt.update(&noise.force(1.9), 1e-3);
    assert_eq!(learnt.threshold(), fresh.threshold());
    learnt.update_open(1e-3);
    for index in 0..40 {
        let force = noise.force(2.0);
        assert_eq!(learnt.update(&force, 1e-3), SlipVerdict::Holding, "{index}");
    }
}

/// A sum without allowance, so that it is not zero.
#[test]
fn an_opened_contact_leaves_nothing_in_the_sum() {
    let new = DropDetector::with_sum(NOISE, Cusum::new(0.0, 50.0).unwrap()).unwrap();
    let mut used = new;
    let mut noise = Noise(Pcg64Mcg::seed_from_u64(83));
    for index in 0..100 {
        used.update(&noise.force(if index < 90 { 1.0 } else { 0.8 }), 1e-3);
    }
    assert_ne!(used, new);
    // A sample at no known time is no lift-off.
    let kept = used;
    used.update_open(f64::NAN);
    assert_eq!(used, kept);
    used.update_open(1e-3);
    assert_eq!(used, new);
}

/// Touches of a few hundred samples at 10 kHz: the start of each follows the mean of its samples, not the first.
#[test]
fn starts_at_ten_kilohertz_give_no_false_alarms() {
    let mut noise = Noise(Pcg64Mcg::seed_from_u64(88));
    let mut detector = DropDetector::new(NOISE).unwrap();
    let mut alarms = 0;
    for _ in 0..3000 {
        for _ in 0..150 {
            alarms += u32::from(detector.update(&noise.force(2.0), 1e-4) == SlipVerdict::Slipping);
        }
        detector.update_open(1e-4);
    }
    assert_eq!(alarms, 0);
}

#[test]
fn open_contacts_are_told_through_a_reference() {
    fn open(mut detector: impl SlipDetector<f64>) -> SlipVerdict {
        detector.update_open(1e-3)
    }
    let new = DropDetector::new(NOISE).unwrap();
    let mut used = new;
    used.update(&Noise(Pcg64Mcg::seed_from_u64(84)).force(1.0), 1e-3);
    assert!(used.ratio().is_some());
    assert_eq!(open(&mut used), SlipVerdict::NotPressing);
    assert_eq!(used, new);
    // The default says the same: here of a detector that says what it was given.
    struct Given(f64);
    impl SlipDetector<f64> for Given {
        fn update(&mut self, force: &ContactForce<f64>, time_step: f64) -> SlipVerdict {
            assert_eq!(*force, ContactForce::zero());
            self.0 += time_step;
            SlipVerdict::Warning
        }
        fn reset(&mut self) {}
    }
    let mut given = Given(0.0);
    assert_eq!(open(&mut given), SlipVerdict::Warning);
    assert_eq!(given.0, 1e-3);
    let gate = NormalForceGate::from_noise(&NOISE);
    assert_eq!(
        open(RatioThreshold::new(gate, 0.5).unwrap().with_warning_share(0.9).unwrap()),
        SlipVerdict::NotPressing
    );
}

#[test]
fn statistics_forget_all_samples() {
    let mut noise = Noise(Pcg64Mcg::seed_from_u64(85));
    let new = Cusum::new(0.5, 3.0).unwrap();
    let mut sum = new;
    sum.add(2.0);
    assert_ne!(sum, new);
    sum.reset();
    assert_eq!((sum, sum.sum()), (new, 0.0));

    let new = LikelihoodRatio::<f64, 8>::new(2.0).unwrap();
    let mut used = new;
    let mut parted = 0;
    for trial in 0..500 {
        for _ in 0..(trial % 11) {
            used.add(noise.draw() + 0.7);
        }
        let (mut fresh, mut kept) = (new, used);
        used.reset();
        for index in 0..12 {
            let x = noise.draw();
            let wanted = fresh.add(x);
            assert_eq!(used.add(x), wanted, "trial {trial}, sample {index}");
            parted += u32::from(kept.add(x) != wanted);
        }
    }
    assert!(parted > 20, "{parted}");
}

#[test]
fn estimators_forget_surface_and_samples() {
    let mut noise = Noise(Pcg64Mcg::seed_from_u64(86));
    let mut learnt = StaticFriction::<f64, 64>::with_noise(NOISE).unwrap();
    for _ in 0..70 {
        learnt.observe(&noise.force(1.0));
    }
    learnt.onset().unwrap();
    for _ in 0..70 {
        learnt.observe(&noise.force(1.0));
    }
    assert!(learnt.estimate().is_some() && learnt.peak().is_some());
    learnt.reset();
    assert_eq!((learnt.estimate(), learnt.peak(), learnt.onset()), (None, None, None));

    let new = KineticFriction::new(NOISE, 0.5).unwrap();
    let mut learnt = new;
    for index in 0..100 {
        learnt.observe(&noise.force(if index < 50 { 1.0 } else { 3.0 }), 1e-3);
    }
    assert!(learnt.estimate().unwrap().surface_changed);
    learnt.reset();
    assert_eq!(learnt, new);
    assert_eq!(learnt.estimate(), None);

    let gate = NormalForceGate::from_noise(&NOISE);
    let new = IncipientSlip::new(gate, 4e-6).unwrap().with_warning_share(0.65).unwrap();
    let mut used = new;
    for index in 0..100 {
        let x = 1e-6 * f64::from(index);
        used.update(
            &ContactForce::new(4.0, Vector3::new(-1e3 * x, 0.0, 0.0), 0.0),
            &Vector3::new(x, 0.0, 0.0),
        );
    }
    assert!(used.stiffness().is_some());
    used.reset();
    assert_eq!(used, new);
    assert_eq!(used.stiffness(), None);
}
