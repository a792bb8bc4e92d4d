//! Skins, and the choice of a model.

use fingertip_surfaces::{
    Auto, Choice, CompliantPointContact, CompliantSoftFinger, Contact, ContactModel, Hertz, LinearStiffness,
    LocalHertz, NoContact, PointContact, PowerLaw, Resolution, SkinLaw, SmoothSurface, SoftFinger,
    SoftFingerSurface, Sphere, StiffnessLaw, Tabulated, contact_modulus,
};
use fingertip_wrench::Wrench;
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::common;
use crate::wrenches::Random;

/// A wrench from a contact on the parallel surface: known depth, place and spin torque.
fn through_skin<S, L>(name: &str, surface: &S, law: &L, spin: f64, count: usize)
where
    S: SoftFingerSurface<f64> + SmoothSurface<f64>,
    L: SkinLaw<f64, S> + Copy,
{
    let mut random = Random::new(61);
    let soft = CompliantSoftFinger::new(SoftFinger::new(0.0).unwrap(), *law);
    let point_model = CompliantPointContact::new(PointContact::new(0.0).unwrap(), *law);
    let (mut worst, mut deepest) = (0.0_f64, 0.0_f64);
    for _ in 0..count {
        let (place, normal) = random.place(surface, 0.017);
        let force = {
            let size = random_force(&mut random);
            random.force(&normal, 0.55, size)
        };
        let pressing = -force.dot(&normal);
        let at = |contact_spin: f64| Contact {
            point: place,
            normal,
            force,
            spin_torque: contact_spin,
            gap: 0.0,
            alternatives: 0,
        };
        let depth = law.indentation_at(surface, &at(0.0), pressing).depth;
        deepest = deepest.max(depth);
        let touched = place - normal * depth;
        let torque = spin * force.norm() * 0.013 * random.uniform(-1.0, 1.0);
        let wrench = Wrench::on_fingertip(force, touched.cross(&force) + normal * torque);
        let found = soft.resolve_indented(&wrench, surface, None).unwrap();
        worst = worst.max((found.contact.point - touched).norm() / 0.017);
        assert!((found.undeformed - place).norm() < 1e-12, "{name}");
        assert!((found.contact.spin_torque - torque).abs() < 1e-12 * force.norm());
        assert!((found.indentation.depth - depth).abs() < 1e-12);
        let pure = Wrench::from_force_at(&touched, force);
        let found = point_model.resolve(&pure, surface).into_result().unwrap();
        worst = worst.max((found.point - touched).norm() / 0.017);
    }
    println!("{name:28} through a skin: error/size {worst:.1e}, deepest {:.2} mm", deepest * 1e3);
    assert!(worst < 1e-12, "{name} {worst:e}");
}

fn random_force(random: &mut Random) -> f64 {
    random.log_uniform(0.05, 20.0)
}

#[test]
fn contacts_through_a_skin() {
    // 2.5 mm at 20 N.
    let spring = LinearStiffness::new(8000.0, 0.013).unwrap();
    let hertz = Hertz::sphere(0.013, 2e6).unwrap();
    let power = PowerLaw::new([0.003, 0.25], [0.0008, 0.4]).unwrap();
    let table = Tabulated::new([[1.0, 0.0004, 0.002], [5.0, 0.0009, 0.004], [20.0, 0.0016, 0.005]]).unwrap();
    through_skin("sphere, spring", &common::sphere::<f64>(), &spring, 0.3, 1000);
    through_skin("ellipsoid, spring", &common::ellipsoid::<f64>(), &spring, 0.3, 1000);
    through_skin("ellipsoid, Hertz", &common::ellipsoid::<f64>(), &hertz, 0.3, 1000);
    through_skin("cylinder, power law", &common::cylinder::<f64>(), &power, 0.3, 1000);
    through_skin("plane, table", &common::plane::<f64>(), &table, 0.3, 1000);
    through_skin("capsule, Hertz", &common::capsule::<f64>(), &hertz, 0.2, 1000);
    through_skin("superquadric, Hertz", &common::superquadric::<f64>(), &hertz, 0.2, 200);
    let local = LocalHertz::new(2e6, 0.0, 0.1).unwrap();
    through_skin("ellipsoid, local Hertz", &common::ellipsoid::<f64>(), &local, 0.2, 200);
}

#[test]
fn the_parallel_surface_of_a_sphere_is_a_sphere() {
    let sphere = Sphere::centred(0.013).unwrap();
    let spring = LinearStiffness::new(5000.0, 0.013).unwrap();
    let model = CompliantSoftFinger::new(SoftFinger::new(0.0).unwrap(), spring);
    let mut random = Random::new(67);
    for _ in 0..300 {
        let normal = random.direction();
        let force = random.force(&normal, 0.6, 3.0);
        let wrench = Wrench::on_fingertip(force, (normal * 0.0125).cross(&force) + normal * 0.004);
        let found = model.resolve_indented(&wrench, &sphere, None).unwrap();
        let shrunk = Sphere::centred(0.013 - found.indentation.depth).unwrap();
        let rigid = *SoftFinger::new(0.0).unwrap().resolve(&wrench, &shrunk).contact().unwrap();
        assert!((rigid.point - found.contact.point).norm() < 1e-14);
        assert!((rigid.spin_torque - found.contact.spin_torque).abs() < 1e-14);
        let patch = found.indentation.patch[0];
        assert!((patch * patch - 2.0 * 0.013 * found.indentation.depth).abs() < 1e-16);
    }
}

#[test]
fn hertz_of_a_round_patch_and_of_two_bodies() {
    // a³ = 3FR/(4E*), δ = a²/R.
    let modulus = contact_modulus([1e6, f64::INFINITY], [0.48, 0.3]).unwrap();
    assert!((modulus - 1e6 / (1.0 - 0.48 * 0.48)).abs() < 1e-6);
    let found = Hertz::sphere(0.013, modulus).unwrap().indentation(2.0);
    let a = (3.0 * 2.0 * 0.013 / (4.0 * modulus)).cbrt();
    assert!((found.patch[0] / a - 1.0).abs() < 1e-14 && (found.patch[1] / a - 1.0).abs() < 1e-14);
    assert!((found.depth / (a * a / 0.013) - 1.0).abs() < 1e-14);
    assert!(contact_modulus([1e6, -1.0], [0.3, 0.3]).is_err());
    assert!(contact_modulus([f64::INFINITY, f64::INFINITY], [0.3, 0.3]).is_err());
    assert!(Hertz::new([0.01, 0.01], f64::NAN).is_err());
    assert_eq!(Hertz::sphere(0.013, modulus).unwrap().indentation(0.0).depth, 0.0);
    // The order of the radii does not matter, and the patch is longer along the flatter side.
    let one = Hertz::new([0.05, 0.01], 1e6).unwrap();
    assert_eq!(one, Hertz::new([0.01, 0.05], 1e6).unwrap());
    for ratio in [1.000_001_f64, 2.0, 100.0, 1e6] {
        let law = Hertz::new([0.01 * ratio, 0.01], 1e6).unwrap();
        let [a, b] = law.indentation(1.0).patch;
        assert!(a > b && law.peak_pressure(1.0) > 0.0);
        // Known to 20 % at a ratio of 100 (theory 4.1).
        assert!(ratio > 1e3 || ((b / a) / ratio.powf(-2.0 / 3.0) - 1.0).abs() < 0.2);
    }
}

#[test]
fn a_skin_without_contact_says_why() {
    let sphere = Sphere::centred(0.013).unwrap();
    let spring = LinearStiffness::new(5000.0, 0.013).unwrap();
    let model = CompliantPointContact::new(PointContact::new(0.5).unwrap(), spring);
    let weak = Wrench::from_force_at(&Vector3::zeros(), Vector3::new(0.0, 0.0, -0.1));
    assert!(matches!(model.resolve(&weak, &sphere), Resolution::NoContact(NoContact::BelowThreshold { .. })));
    let far: Wrench<f64> = Wrench::from_force_at(&Vector3::new(0.1, 0.0, 0.0), Vector3::new(0.0, 0.0, -1.0));
    assert!(matches!(model.resolve(&far, &sphere), Resolution::NoContact(NoContact::Misses { .. })));
    // Softer than it is thick: whatever comes, it is no NaN.
    let mud = CompliantPointContact::new(
        PointContact::new(0.0).unwrap(),
        LinearStiffness::new(1.0, 0.013).unwrap(),
    );
    let hard: Wrench<f64> =
        Wrench::from_force_at(&Vector3::new(0.005, 0.0, 0.0), Vector3::new(0.3, 0.0, -10.0));
    if let Resolution::Contact(contact) = mud.resolve(&hard, &sphere) {
        assert!(contact.point.iter().all(|x: &f64| x.is_finite()));
    }
    assert!(model.with_share(1.5).is_err());
}

fn auto(deviations: &Vector6<f64>) -> Auto<f64> {
    let noise = Matrix6::from_diagonal(&deviations.component_mul(deviations));
    Auto::new(PointContact::new(0.0).unwrap(), SoftFinger::new(0.0).unwrap(), noise).unwrap()
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
