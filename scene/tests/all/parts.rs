//! What each choice of a scene is made into: the library's own, with the numbers in their places.

use fingertip::contact::{
    Auto, Compliant, ContactCovariance, ContactJacobian, ContactModel, GeometryUncertainty, Hertz,
    LinearStiffness, LocalHertz, PointContact, PowerLaw, SkinLaw, SoftFinger, Tabulated, WrenchNoise,
    contact_modulus,
};
use fingertip::friction::{
    AdaptiveDropDetector, AnisotropicCoulomb, Coulomb, Cusum, DropDetector, ForceNoise, FrictionModel,
    LikelihoodRatioDetector, LoadDependentLimit, NormalForceGate, PowerLimit, PressureDistribution,
    RatioThreshold, SlipDetector, SlipVerdict, SoftFingerLimit, StickSlipDetector,
};
use fingertip::surfaces::{DynSurface, SmoothSurface, Sphere};
use fingertip::wrench::Wrench;
use fingertip_scene::{Pipeline, Scene};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::{BALL, HEAD, NOISE, pushes};

fn pipeline(rest: &str) -> Pipeline<f64> {
    let text = format!("{HEAD}{BALL}{rest}");
    Scene::from_text(&text).unwrap_or_else(|problem| panic!("{problem}\n{text}")).pipeline()
}

fn ball() -> Sphere<f64> {
    Sphere::centred(0.013).unwrap()
}

#[test]
fn skins_are_the_librarys() {
    fn same<L: SkinLaw<f64, DynSurface<f64>>>(text: &str, law: L) {
        let surface = DynSurface::from(ball());
        let mut ours =
            pipeline(&format!("[contact]\nleast_force_N = 0.01\nskin_share = 0.7\n[contact.skin]\n{text}"));
        let typed = Compliant::new(PointContact::new(0.01).unwrap(), law).with_share(0.7).unwrap();
        let mut seen = 0;
        for push in pushes(21, 60) {
            let found = ours.sense(push, 1e-3);
            assert_eq!(found.touch.resolution, typed.resolve(&push, &surface), "{text}");
            seen += usize::from(found.contact().is_some());
        }
        assert!(seen > 40, "{seen} {text}");
    }
    let modulus = contact_modulus([2e6, 5e7], [0.49, 0.3]).unwrap();
    let bodies = "young_moduli_Pa = [2.0e6, 5.0e7]\npoisson_ratios = [0.49, 0.3]\n";
    same(
        "law = \"linear\"\nstiffness_N_per_m = 8000.0\nradius_m = 0.012\n",
        LinearStiffness::new(8000.0, 0.012).unwrap(),
    );
    same(
        "law = \"power\"\npatch_at_1_N_m = 0.002\npatch_exponent = 0.3\ndepth_at_1_N_m = 0.0004\ndepth_exponent = 0.6\n",
        PowerLaw::new([0.002, 0.3], [0.0004, 0.6]).unwrap(),
    );
    same(
        &format!("law = \"hertz\"\nradii_m = [0.013, 0.02]\n{bodies}"),
        Hertz::new([0.013, 0.02], modulus).unwrap(),
    );
    same(
        &format!("law = \"local_hertz\"\nobject_curvature_per_m = 5.0\nlargest_radius_m = 0.1\n{bodies}"),
        LocalHertz::new(modulus, 5.0, 0.1).unwrap(),
    );
    same(
        "law = \"table\"\nforce_depth_patch_N_m_m = [[0.5, 0.0002, 0.001], [2.0, 0.0005, 0.002]]\n",
        Tabulated::new([[0.5, 0.0002, 0.001], [2.0, 0.0005, 0.002]]).unwrap(),
    );
}

#[test]
fn limits_are_the_librarys() {
    fn same(text: &str, flat: bool, coefficient: f64, limit: impl FrictionModel<f64>) {
        let surface = if flat {
            "[surface]\nshape = \"plane\"\n[pose]\nrotation_deg = [0.0, 0.0, 90.0]\n"
        } else {
            BALL
        };
        let scene = Scene::from_text(&format!("{HEAD}{surface}[friction]\n{text}")).unwrap();
        assert_eq!(scene.limit().unwrap().coefficient(), coefficient, "{text}");
        let mut ours = scene.pipeline();
        for push in pushes(22, 60) {
            let found = ours.sense(push, 1e-3);
            let expected = found.force().map(|force| limit.slip_margin(force));
            match (found.margin(), expected) {
                (Some(a), Some(b)) => {
                    assert!(
                        (a.newtons - b.newtons).abs() <= 1e-12 * (1.0 + b.newtons.abs()),
                        "{text} {a:?} {b:?}"
                    );
                }
                (a, b) => assert_eq!(a, b),
            }
        }
    }
    same("static_coefficient = 0.55\n", false, 0.55, Coulomb::new(0.55).unwrap());
    let soft = "limit = \"soft_finger\"\nstatic_coefficient = 0.5\ntorque_arm_m = 0.003\n";
    same(soft, false, 0.5, SoftFingerLimit::new(0.5, 0.003).unwrap());
    let rhombus = SoftFingerLimit::conservative(0.5, 0.003).unwrap();
    same(&format!("{soft}conservative = true\n"), false, rhombus.coefficient(), rhombus);
    for (name, pressure) in [
        ("uniform", PressureDistribution::Uniform),
        ("hertz", PressureDistribution::Hertz),
        ("winkler", PressureDistribution::Winkler),
    ] {
        let text = format!(
            "limit = \"power\"\nstatic_coefficient = 0.5\npatch_radius_m = 0.004\npressure = \"{name}\"\n"
        );
        same(&text, false, 0.5, PowerLimit::for_patch(0.5, 0.004, pressure).unwrap());
    }
    same(
        "limit = \"load_dependent\"\nstatic_coefficient = 0.5\ntorque_arm_m = 0.003\nreference_force_N = 2.0\ngrowth_exponent = 0.3\n",
        false,
        0.5,
        LoadDependentLimit::new(0.5, 0.003, 2.0, 0.3).unwrap(),
    );
    // The grain lies along the surface's own x, which the pose turns to y.
    same(
        "limit = \"anisotropic\"\ngrain = [2.0, 0.0, 0.0]\ncoefficient_along = 0.7\ncoefficient_across = 0.4\n",
        true,
        0.4,
        AnisotropicCoulomb::new([Vector3::y(), Vector3::x()], [0.7, 0.4]).unwrap(),
    );
}

/// A load that is held for so many samples, and then grows, drops at a slip, and does so again and again, with a
/// little noise.
fn ramps(held: u32) -> impl Iterator<Item = Wrench<f64>> {
    let top = Vector3::new(0.0, 0.0, 0.013);
    (0..held + 1200).map(move |k| {
        let phase = f64::from(k.saturating_sub(held) % 200) / 200.0;
        let noise = f64::from(k * 7919 % 101) / 101.0 - 0.5;
        let ratio = 0.2 + 0.3 * phase;
        Wrench::from_force_at(&top, Vector3::new(2.0 * ratio + 0.02 * noise, 0.0, -2.0))
    })
}

#[test]
fn detectors_are_the_librarys() {
    fn same(text: &str, mut typed: impl SlipDetector<f64>) {
        let mut ours = pipeline(&format!("[friction]\nstatic_coefficient = 0.47\n[slip]\n{text}"));
        let mut seen = [0; 4];
        // One that learns the noise takes a while.
        for push in ramps(if text.contains("adaptive") { 3000 } else { 0 }) {
            let found = ours.sense(push, 1e-3);
            let expected = typed.update(found.force().unwrap(), 1e-3);
            assert_eq!(found.touch.slip, Some(expected), "{text}");
            seen[expected as usize] += 1;
        }
        assert!(
            seen[SlipVerdict::Slipping as usize] > 0 && seen[SlipVerdict::Holding as usize] > 0,
            "{text} {seen:?}"
        );
    }
    let noise = ForceNoise::isotropic(0.01).unwrap();
    let drop = || DropDetector::new(noise).unwrap();
    same("detector = \"drop\"\nnoise_N = 0.01\n", drop());
    let sum = Cusum::for_false_alarms(0.75, 0.5, 1000.0).unwrap();
    same(
        "detector = \"drop\"\nnoise_N = 0.01\nfalse_alarms_per_minute = 0.5\n",
        DropDetector::with_sum(noise, sum).unwrap(),
    );
    let gate = NormalForceGate::from_noise(&noise);
    same("detector = \"threshold\"\nnoise_N = 0.01\n", RatioThreshold::new(gate, 0.47).unwrap());
    same(
        "detector = \"threshold\"\nnoise_N = 0.01\nwarning_share = 0.6\n",
        RatioThreshold::new(gate, 0.47).unwrap().with_warning_share(0.6).unwrap(),
    );
    same(
        "detector = \"likelihood_ratio\"\nnoise_N = 0.01\n",
        LikelihoodRatioDetector::<f64, 32>::new(noise, 1.0, 1000.0).unwrap(),
    );
    same("detector = \"stick_slip\"\nnoise_N = 0.01\n", StickSlipDetector::new(drop()));
    same(
        "detector = \"adaptive_drop\"\nnoise_N = 0.01\nfalse_alarms_per_minute = 2.0\n",
        AdaptiveDropDetector::new(noise, 2.0, 1000.0).unwrap(),
    );
}

/// Falls that come every 200 samples of 1 ms are told with their period, and only by the detector that looks for it.
#[test]
fn stick_slip_is_told_with_its_period() {
    for (detector, told) in [("stick_slip", true), ("drop", false)] {
        let mut ours = pipeline(&format!("[slip]\ndetector = \"{detector}\"\nnoise_N = 0.01\n"));
        let mut last = None;
        for push in ramps(0) {
            last = ours.sense(push, 1e-3).stick_slip;
        }
        assert_eq!(last.is_some(), told, "{detector}");
        if let Some(motion) = last {
            assert!((motion.period - 0.2).abs() < 0.01, "{motion:?}");
        }
    }
}

#[test]
fn auto_is_the_librarys() {
    let surface = DynSurface::from(ball());
    let text = "[contact]\nmodel = \"auto\"\nleast_force_N = 0.1\ngreatest_gap_m = 0.0001\ngreatest_pitch_m = 0.0003\nPITCH\n";
    for (pitch, deviations) in [("", 3.0), ("pitch_deviations = 1.0", 1.0)] {
        let mut ours = pipeline(&format!("{}{NOISE}", text.replace("PITCH", pitch)));
        let point = PointContact::new(0.1).unwrap().with_greatest_gap(0.0001).unwrap();
        let noise = Matrix6::from_diagonal(&Vector6::new(1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8));
        let typed = Auto::new(point, SoftFinger::new(0.1).unwrap(), noise)
            .unwrap()
            .with_greatest_pitch(0.0003, deviations)
            .unwrap();
        let mut kinds = [0; 3];
        for push in pushes(23, 300) {
            let found = ours.sense(push, 1e-3);
            assert_eq!(found.touch.resolution, typed.resolve(&push, &surface));
            match found.contact() {
                None => kinds[0] += 1,
                Some(contact) => kinds[1 + usize::from(contact.spin_torque.abs() > 0.0)] += 1,
            }
        }
        assert!(kinds.iter().all(|&count| count > 5), "{kinds:?}");
    }
}

/// The geometry's deviations are squared once, and turn about the origin of the surface's frame.
#[test]
fn an_uncertain_geometry_is_the_librarys() {
    let text = format!(
        "{HEAD}{BALL}[pose]\ntranslation_m = [0.001, 0.002, 0.003]\n{NOISE}relative = 0.02\noffset_m = 0.0002\n\
         position_m = 0.0003\nattitude_deg = 2.0\nprobability = 0.9\n"
    );
    let mut ours = Scene::from_text(&text).unwrap().pipeline();
    let sphere = Sphere::new(Vector3::new(0.001, 0.002, 0.003), 0.013).unwrap();
    let noise = WrenchNoise::new(Vector6::new(0.01, 0.01, 0.01, 1e-4, 1e-4, 1e-4), 0.02).unwrap();
    let geometry = GeometryUncertainty {
        offset: 4e-8,
        position: Matrix3::identity() * 9e-8,
        attitude: Matrix3::identity() * 2.0_f64.to_radians().powi(2),
        pivot: Vector3::new(0.001, 0.002, 0.003),
    };
    let mut seen = 0;
    for push in pushes(24, 100) {
        let found = ours.sense(push, 1e-3);
        let (Some(contact), Some(spread)) = (found.contact(), found.spread) else { continue };
        let bend = sphere.shape_operator(&contact.point);
        let jacobian = ContactJacobian::of_point_contact(contact, &push, &bend).unwrap();
        let covariance =
            ContactCovariance::new(&jacobian, &noise.covariance(&push)).with_geometry(&jacobian, &geometry);
        let ellipse = covariance.ellipse(0.9).unwrap();
        for (axis, expected) in spread.ellipse.semi_axes.iter().zip(ellipse.semi_axes) {
            assert!((axis / expected - 1.0).abs() < 1e-9);
        }
        let deviation = covariance.normal_force_variance().sqrt();
        assert!((spread.normal_force / deviation - 1.0).abs() < 1e-9);
        seen += 1;
    }
    assert!(seen > 50, "{seen}");
}

/// A force that misses says by its torque where it touches, unless that may be noise.
#[test]
fn a_torque_along_a_force_may_be_noise() {
    use fingertip::contact::{NoContact, Resolution};
    let soft = SoftFinger::new(0.0).unwrap().with_greatest_friction(1e6).unwrap();
    let typed = soft.with_torque_noise(2e-4).unwrap();
    let text = "[contact]\nmodel = \"soft_finger\"\ngreatest_friction_ratio = 1e6\n";
    let (mut sure, mut doubtful) = (pipeline(text), pipeline(&format!("{text}spin_noise_Nm = 0.0002\n")));
    // 2 N past the ball of 13 mm at 14 mm, with 0.1 N·mm along it, and with 0.3.
    for (torque, is_noise) in [(1e-4, true), (3e-4, false)] {
        let force = Vector3::new(0.0, 2.0, 0.0);
        let torque = Vector3::new(0.014, 0.0, 0.0).cross(&force) + Vector3::y() * torque;
        let push = Wrench::on_fingertip(force, torque);
        let told = doubtful.sense(push, 1e-3).touch.resolution;
        assert_eq!(told, typed.resolve(&push, &ball()));
        assert_eq!(matches!(told, Resolution::NoContact(NoContact::Ambiguous { .. })), is_noise, "{told:?}");
        assert!(sure.sense(push, 1e-3).touch.resolution.contact().is_some());
    }
}

#[test]
fn a_soft_finger_may_be_limited_by_friction() {
    let soft = SoftFinger::new(0.05).unwrap().with_greatest_friction(0.4).unwrap();
    for (text, typed) in [
        ("greatest_friction_ratio = 0.4\n", soft),
        ("greatest_friction_ratio = 0.4\ntorque_arm_m = 0.002\n", soft.with_torque_arm(0.002).unwrap()),
    ] {
        let mut ours = pipeline(&format!("[contact]\nmodel = \"soft_finger\"\nleast_force_N = 0.05\n{text}"));
        let (mut touched, mut beyond) = (0, 0);
        for push in pushes(31, 300) {
            let found = ours.sense(push, 1e-3).touch.resolution;
            assert_eq!(found, typed.resolve(&push, &ball()), "{text}");
            touched += usize::from(found.contact().is_some());
            let steep = matches!(
                found,
                fingertip::contact::Resolution::NoContact(
                    fingertip::contact::NoContact::BeyondFriction { .. }
                )
            );
            beyond += usize::from(steep);
        }
        assert!(touched > 50 && beyond > 50, "{touched} {beyond} {text}");
    }
}
