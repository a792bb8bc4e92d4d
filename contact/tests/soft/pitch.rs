//! The pitch test: how often it is wrong, and what it refuses.

use fingertip_contact::{Auto, Choice, ContactModel, NoContact, PointContact, Resolution, SoftFinger};
use fingertip_wrench::Wrench;
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::common;
use crate::wrenches::Random;

fn auto(deviations: &Vector6<f64>) -> Auto<f64> {
    let noise = Matrix6::from_diagonal(&deviations.component_mul(deviations));
    Auto::new(PointContact::new(0.0).unwrap(), SoftFinger::new(0.0).unwrap().without_friction_limit(), noise)
        .unwrap()
}

#[test]
fn pitch_test_has_the_rate_it_claims_and_finds_spin() {
    let deviations = Vector6::new(2e-3, 3e-3, 2e-3, 2e-5, 3e-5, 1e-5);
    let sphere = common::sphere::<f64>();
    let mut random = Random::new(71);
    let mut exceeded = [0; 3];
    let mut softened = 0;
    let count = 40_000;
    for _ in 0..count {
        let (point, normal) = random.place(&sphere, 0.017);
        let force = random.force(&normal, 0.5, 2.0);
        let noise = Vector6::from_fn(|i, _| deviations[i] * random.normal());
        let clean: Wrench<f64> = Wrench::from_force_at(&point, force);
        let noisy = Wrench::from_components(&(clean.components() + noise));
        for (slot, threshold) in exceeded.iter_mut().zip([3.841, 6.635, 10.828]) {
            let test = auto(&deviations).with_threshold(threshold).unwrap().test(&noisy).unwrap();
            *slot += usize::from(test.choice == Choice::SoftFinger);
        }
        let spun = Wrench::on_fingertip(noisy.force(), noisy.torque() + normal * 2e-3);
        let (resolution, test) = auto(&deviations).resolve_with_test(&spun, &sphere, None);
        softened += usize::from(test.unwrap().choice == Choice::SoftFinger);
        assert!(resolution.contact().is_some());
    }
    let rates = exceeded.map(|n| f64::from(n as u32) / f64::from(count));
    println!("pitch test: {rates:?} at 5, 1, 0.1 %; spin of 2 mN·m found in {softened} of {count}");
    for (rate, expected) in rates.iter().zip([0.05, 0.01, 0.001]) {
        let allowed = 5.0 * (expected / f64::from(count)).sqrt();
        assert!((rate - expected).abs() < allowed, "{rate} {expected}");
    }
    assert!(softened == count as usize);
}

/// Contacts whose pitch is the greatest that one contact can have are refused as seldom as the number of
/// standard deviations says, one side of a normal distribution; and the reason carries the pitch and the
/// excess of the test.
#[test]
fn one_contact_is_seldom_refused() {
    let deviations = Vector6::new(2e-3, 3e-3, 2e-3, 2e-5, 3e-5, 1e-5);
    let sphere = common::sphere::<f64>();
    let mut random = Random::new(83);
    let greatest = 1e-3;
    let choosers = [1.0, 2.0, 3.0].map(|k| auto(&deviations).with_greatest_pitch(greatest, k).unwrap());
    let mut refused = [0; 3];
    let count = 40_000;
    for _ in 0..count {
        let (point, normal) = random.place(&sphere, 0.017);
        let force = random.force(&normal, 0.5, 2.0);
        let noise = Vector6::from_fn(|i, _| deviations[i] * random.normal());
        let pitch = random.sign() * greatest;
        let clean: Wrench<f64> = Wrench::on_fingertip(force, point.cross(&force) + force * pitch);
        let noisy = Wrench::from_components(&(clean.components() + noise));
        for (slot, chooser) in refused.iter_mut().zip(&choosers) {
            let test = chooser.test(&noisy).unwrap();
            *slot += usize::from(test.choice == Choice::NotOneContact);
            assert!((test.pitch - noisy.line_of_action().unwrap().pitch).abs() < 1e-15);
            match chooser.resolve(&noisy, &sphere) {
                Resolution::NoContact(NoContact::NotOneContact { pitch, excess }) => {
                    assert_eq!(
                        (pitch, excess, test.choice),
                        (test.pitch, test.excess, Choice::NotOneContact)
                    );
                }
                _ => assert!(test.choice != Choice::NotOneContact),
            }
        }
    }
    let rates = refused.map(|n| f64::from(n as u32) / f64::from(count));
    println!("one contact refused at 1, 2, 3 standard deviations: {rates:?}");
    for (rate, expected) in rates.iter().zip([0.158_655, 0.022_750, 0.001_350]) {
        assert!((rate - expected).abs() < 5.0 * (expected / f64::from(count)).sqrt(), "{rate} {expected}");
    }
}

#[test]
fn a_pitch_beyond_one_contact_is_refused() {
    let deviations = Vector6::repeat(1e-4);
    // e μ = 1 mm.
    let chooser = auto(&deviations).with_greatest_pitch(1e-3, 3.0).unwrap();
    let sphere = common::sphere::<f64>();
    let force = Vector3::new(0.0, 0.0, -2.0);
    let top = sphere.centre() + Vector3::new(0.0, 0.0, sphere.radius());
    let with = |pitch: f64| Wrench::on_fingertip(force, top.cross(&force) + force * pitch);
    let choice = |pitch| chooser.resolve_with_test(&with(pitch), &sphere, None);
    assert_eq!(choice(0.0).1.unwrap().choice, Choice::PointContact);
    let (soft, test) = choice(0.9e-3);
    assert_eq!(test.unwrap().choice, Choice::SoftFinger);
    assert!((soft.contact().unwrap().spin_torque + 2.0 * 0.9e-3).abs() < 1e-12, "{soft:?}");
    let (refused, test) = choice(3e-3);
    assert_eq!(test.unwrap().choice, Choice::NotOneContact);
    match refused {
        Resolution::NoContact(NoContact::NotOneContact { pitch, excess }) => {
            assert!((pitch - 3e-3).abs() < 1e-15 && excess > 3.0);
        }
        other => panic!("{other:?}"),
    }
    // Two contacts with a lever arm between them do that.
    let two = Wrench::from_force_at(&Vector3::new(0.01, 0.0, 0.0), Vector3::new(0.0, 1.0, -1.0))
        + Wrench::from_force_at(&Vector3::new(-0.01, 0.0, 0.0), Vector3::new(0.0, -1.0, -1.0));
    assert!(matches!(chooser.resolve(&two, &sphere), Resolution::NoContact(NoContact::NotOneContact { .. })));
    assert!(matches!(
        chooser.resolve(&Wrench::zero(), &sphere),
        Resolution::NoContact(NoContact::BelowThreshold { .. })
    ));
}
