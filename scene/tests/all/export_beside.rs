//! What stands beside the pipeline in exported modules: calibrations, uncertainty, friction that is learnt, grip.

use fingertip::Step;
use fingertip::contact::ContactCovariance;
use fingertip::friction::SlipVerdict;
use fingertip::surfaces::{DynSurface, Extent, SmoothSurface};
use fingertip::wrench::{GaugesAndTemperature, Real, Wrench};
use fingertip_calibration::file::{CalibrationFile, Covariance, SignalUnit, Temperature};
use fingertip_scene::Scene;
use nalgebra::{DMatrix, SVector, Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::calibrated_spread::calibrated;
use crate::export::example;
use crate::exported;

/// A soft tip under a skin that is known not quite, on a sensor that is turned and tells the reaction.
pub(crate) const SKINNED: &str = r#"
version = 2
name = "skinned\n\"tip\""
[input]
convention = "reaction"
sample_rate_Hz = 500.0
rest_s = 1.0
[surface]
shape = "compound"
parts = [
    { shape = "sphere", radius_m = 0.01, pole = [0.1, 0.7, 0.3], active_half_angle_deg = 140.0 },
    { shape = "posed", rotation_deg = [0.0, 33.0, 0.0], surface = { shape = "cone", half_angle_deg = 31.0, depth_m = 0.02 } },
    { shape = "elliptic_cylinder", semi_axes_m = [0.008, 0.01], ends_m = "unbounded" },
    { shape = "elliptic_cylinder", semi_axes_m = [0.009, 0.007], ends_m = { open = 0.012 } },
]
[pose]
translation_m = [0.001, 0.0, 0.002]
rotation_deg = [10.0, 20.0, 30.0]
[contact]
model = "soft_finger"
skin_share = 0.5
[contact.skin]
law = "linear"
stiffness_N_per_m = 8000
radius_m = 0.013
[uncertainty]
force_noise_N = 0.01
torque_noise_Nm = 0.0001
[friction]
limit = "soft_finger"
static_coefficient = 0.5
torque_arm_m = 0.003
conservative = true
[slip]
detector = "drop"
noise_N = 0.01
false_alarms_per_minute = 2.0
[grip]
least_N = 0.2
greatest_N = 20.0
rise_N_per_s = 100.0
fall_N_per_s = 2.0
"#;

/// Six gauges that drift with temperature, or eight that do not.
pub(crate) fn calibration(gauges: usize) -> CalibrationFile {
    let entry = |i: usize, j: usize| if i % 6 == j { 1.5 } else { 0.1 / (1.0 + (i + 2 * j) as f64) };
    let nominal = vec![10.0, 10.0, 20.0, 0.1, 0.1, 0.05];
    let zero = (0..gauges).map(|i| i as f64 * 0.01 - 0.02).collect();
    let matrix = DMatrix::from_fn(gauges, 6, entry);
    let mut file = CalibrationFile::new(matrix, nominal, zero, SignalUnit::Volt).unwrap();
    if gauges == 6 {
        let near = |i: usize, j: usize| if i == j { 1.0 } else { 0.2 / (1.0 + i.abs_diff(j) as f64) };
        file.covariance = Some(Covariance::product(
            DMatrix::from_fn(6, 6, |i, j| 1e-4 * near(i, j)),
            DMatrix::from_fn(6, 6, |i, j| 0.03 * near(i, j)),
        ));
        file.temperature = Some(Temperature {
            reference_celsius: 22.0,
            range_celsius: [15.0, 45.0],
            zero_drift: (0..6).map(|i| 1e-3 * f64::from(i)).collect(),
            zero_curvature: vec![1e-5; 6],
            gain_drift: vec![-2e-4; 6],
        });
    }
    file
}

/// Pushes from all sides on and beside a surface, one in ten too light to be a contact.
pub(crate) fn pushes_on<T: Real>(
    surface: &DynSurface<T>,
    count: usize,
) -> impl Iterator<Item = Wrench<T>> + use<T> {
    let Extent { centre, radius } = surface.extent();
    let reach = radius.to_f64().min(0.03) * 0.6;
    let mut random = Pcg64Mcg::seed_from_u64(23);
    (0..count).map(move |k| {
        let mut vector = |size: f64| Vector3::from_fn(|_, _| T::literal(random.random_range(-size..size)));
        let force = vector(4.0) * T::literal(if k % 10 == 9 { 1e-4 } else { 1.0 });
        let at = centre + vector(reach);
        Wrench::on_fingertip(force, at.cross(&force) + vector(2e-3))
    })
}

#[test]
fn readings_of_gauges_give_what_their_wrenches_give() {
    let wrench: Wrench<f64> =
        Wrench::from_force_at(&Vector3::new(0.001, 0.002, 0.005), Vector3::new(0.3, 0.1, -2.0));
    let loads = wrench.components();
    // The fingertip's load on the environment is recorded: the scene takes the opposite.
    let file = calibration(6);
    let matrix = file.sensor_matrix::<6>().unwrap();
    let gauges = matrix.normalised() * (-loads).component_div(matrix.nominal());
    let mut tip = exported::skinned_six_gauges::tip().unwrap();
    let gauges = gauges + Vector6::from_iterator(file.zero.iter().copied());
    let felt = tip.sense(&GaugesAndTemperature { gauges, temperature: 22.0 }, 1e-3);
    assert!((felt.wrench.components() - loads).amax() < 1e-12, "{:?}", felt.wrench);
    let direct = exported::skinned::tip()
        .unwrap()
        .sense_wrench(exported::skinned::load(-wrench.force(), -wrench.torque()), 1e-3);
    assert!((felt.point().unwrap() - direct.point().unwrap()).norm() < 1e-12);

    let file = calibration(8);
    let matrix = file.sensor_matrix_in::<f32, 8>().unwrap();
    let loads = loads.map(|x| x as f32);
    let zero = file.zero.iter().map(|zero| *zero as f32);
    let gauges =
        matrix.normalised() * loads.component_div(matrix.nominal()) + SVector::<f32, 8>::from_iterator(zero);
    let felt = exported::plane_eight_gauges_f32::tip().unwrap().sense(&gauges, 1e-3);
    assert!((felt.wrench.components() - loads).amax() < 1e-5, "{:?}", felt.wrench);
    assert!(felt.point().is_some());
}

/// What stands beside the pipeline, called as the header of its module says.
#[test]
fn what_stands_beside_the_pipeline_gives_its_bits() {
    macro_rules! spreads {
        ($scene:expr, $module:ident, $probability:expr, |$tip:ident, $touch:ident, $last:ident| $covariance:expr) => {
            let mut pipeline = $scene.pipeline();
            let ($tip, mut last, mut sure) = (exported::$module::tip(), None, 0);
            let mut $tip = $tip.unwrap();
            let pushes = pushes_on(pipeline.surface(), 200);
            for push in pushes {
                let felt = pipeline.sense(push, 1e-3);
                let $last = last;
                let $touch = $tip.sense_wrench(push, Step::of(1e-3).with_last(last));
                last = $touch.point();
                let ellipse = $covariance
                    .and_then(|covariance: ContactCovariance<f64>| covariance.ellipse($probability));
                assert_eq!(felt.spread.map(|spread| spread.ellipse), ellipse);
                sure += usize::from(ellipse.is_some());
            }
            assert!(sure > 20, "{sure}");
        };
    }
    {
        use exported::nano17_soft_finger::{covariance, geometry, wrench_noise};
        let (noise, geometry) = (wrench_noise().unwrap(), geometry().unwrap());
        spreads!(example("nano17_soft_finger"), nano17_soft_finger, 0.95, |tip, touch, _last| {
            covariance(&tip, &touch, &noise, &geometry)
        });
    }
    {
        use exported::auto_capsule::{covariance, geometry, wrench_noise};
        let (noise, geometry) = (wrench_noise().unwrap(), geometry().unwrap());
        spreads!(example("auto_capsule"), auto_capsule, 0.95, |tip, touch, _last| {
            covariance(&tip, &touch, &noise, &geometry)
        });
    }
    {
        use exported::skinned_six_gauges::{calibration_uncertainty, covariance, wrench_noise};
        let (noise, of_fit) = (wrench_noise().unwrap(), calibration_uncertainty().unwrap());
        spreads!(calibrated(SKINNED, &calibration(6)), skinned_six_gauges, 0.95, |tip, touch, last| {
            covariance(&tip, &touch, last.as_ref(), &noise, &of_fit)
        });
    }
    use exported::skinned::{covariance, wrench_noise};
    let noise = wrench_noise().unwrap();
    spreads!(Scene::from_text(SKINNED).unwrap(), skinned, 0.95, |tip, touch, last| {
        covariance(&tip, &touch, last.as_ref(), &noise)
    });
}

/// An array of two places beside the wrench, as the header of its module says.
#[test]
fn wrench_and_array_are_joined_as_at_run_time() {
    use exported::gripped_ball::{fused, tip, wrench_noise};
    let (mut tip, noise) = (tip().unwrap(), wrench_noise().unwrap());
    let mut pipeline = example("gripped_ball").pipeline();
    let mut random = Pcg64Mcg::seed_from_u64(31);
    let mut slid = 0;
    for _ in 0..200 {
        let mut vector = |size: f64| Vector3::from_fn(|_, _| random.random_range(-size..size));
        let places = [vector(1.0).normalize() * 0.013, vector(1.0).normalize() * 0.013];
        let forces = places.map(|at| vector(0.4) - at * (100.0 + 50.0 * vector(1.0).x));
        let load = |i: usize| {
            let push: Wrench<f64> = Wrench::from_force_at(&places[i], forces[i]);
            push.components()
        };
        let wrench = Wrench::from_components(&(load(0) + load(1)));
        let read = places.map(|at| (at + vector(5e-4), 1.3 + 0.2 * vector(1.0).x));
        let touch = tip.sense_wrench(wrench, 5e-3);
        let direct = fused(&tip, &touch, &noise, &read).unwrap();
        pipeline.sense(wrench, 5e-3);
        let reading = |(centroid, normal_force)| fingertip_scene::ArrayReading { centroid, normal_force };
        let told = pipeline.fuse(&read.map(reading)).unwrap();
        for (direct, told) in direct.contacts.iter().zip(&told.contacts) {
            assert_eq!(Some(*direct), *told);
            slid += usize::from(direct.grip == fingertip::contact::Grip::Slides);
        }
        assert_eq!((direct.disagreement, direct.settled), (told.disagreement, told.settled));
    }
    assert!(slid < 400, "all slide");
}

#[test]
fn friction_is_learnt_and_the_grip_commanded_as_at_run_time() {
    use exported::rubber_tip::{SLIDE_S, friction_model, grip, kinetic_friction, static_friction, tip};
    let mut pipeline = example("rubber_tip").pipeline();
    let (mut tip, mut last) = (tip().unwrap(), None);
    let (model, mut grip) = (friction_model().unwrap(), grip().unwrap());
    let (mut at_rest, mut sliding, mut left) = (static_friction().unwrap(), kinetic_friction().unwrap(), 0.0);
    let mut learnt = 0;
    for k in 0..4000_u32 {
        // A drag that sticks and slips.
        let (phase, noise) = (f64::from(k % 400) / 400.0, f64::from(k * 7919 % 101) * 1e-5);
        let ratio = if phase < 0.8 { phase * 0.7 } else { 0.4 };
        let push = Wrench::from_force_at(
            &Vector3::new(0.0, 0.0, 0.013),
            Vector3::new(ratio * 2.0 + noise, 0.0, -2.0),
        );
        let time_step = 1e-3;
        let felt = *pipeline.sense(push, time_step);
        let touch = tip.sense_wrench(push, Step::of(time_step).with_last(last));
        last = touch.point();
        let slips = touch.slip == SlipVerdict::Slipping;
        left = if slips { SLIDE_S } else { left - time_step };
        match &touch.force {
            Some(force) if left > 0.0 => {
                if slips {
                    let _ = at_rest.onset();
                }
                sliding.observe(force, time_step);
            }
            Some(force) => at_rest.observe(force),
            None => left = 0.0,
        }
        let command = match &touch.force {
            Some(force) => grip.command(&tip.friction().0, force, touch.slip, time_step),
            None => grip.present(),
        };
        assert_eq!(felt.grip_force, Some(command));
        assert_eq!(
            felt.friction.map(|told| (told.at_rest, told.sliding)),
            Some((at_rest.estimate(), sliding.estimate()))
        );
        assert_eq!(felt.slip_probability, touch.force.map(|force| model.slip_probability(&force)));
        learnt += usize::from(at_rest.estimate().is_some());
    }
    assert!(learnt > 100, "{learnt}");
}

/// A scene that names its calibration is exported with it; what only a rest tells, and what has no type, is refused.
#[test]
fn a_calibration_of_the_scene_goes_into_its_module() {
    let matrix: Vec<Vec<f64>> = (0..6)
        .map(|axis| {
            (0..6).map(|gauge| if axis == gauge { 5.0 } else { 0.1 * (axis + 2 * gauge) as f64 }).collect()
        })
        .collect();
    let head = "version = 2\n[input]\nconvention = \"on_fingertip\"\nsample_rate_Hz = 1000.0\nrest_s = 1.0\n";
    let ball = "[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
    let sensor = format!("[sensor]\nsignal_unit = \"V\"\nload_per_signal_N_Nm = {matrix:?}\n");
    let scene = |more: &str| Scene::from_text(&format!("{head}{ball}{more}")).unwrap();
    let own = scene(&sensor);
    let given = scene("").to_rust(fingertip_scene::Scalar::F32, own.calibration()).unwrap();
    let module = |text: String| text.split_once("pub type Tip").unwrap().1.to_owned();
    assert_eq!(module(own.to_rust(fingertip_scene::Scalar::F32, None).unwrap()), module(given));
    let clipped = scene(&format!("{sensor}range = [-5.0, 4.5]\n"));
    let text = clipped.to_rust(fingertip_scene::Scalar::F64, None).unwrap();
    assert!(text.contains("A gauge at or below -5.0, or at or above 4.5, is saturated"), "{text}");
    let limited =
        "[contact]\nmodel = \"soft_finger\"\ngreatest_friction_ratio = 10.0\ntorque_arm_m = 0.003\n";
    let text = scene(limited).to_rust(fingertip_scene::Scalar::F64, None).unwrap();
    assert!(text.contains(".with_greatest_friction(10.0)?.with_torque_arm(0.003)?"), "{text}");
    let doubted = "[contact]\nmodel = \"soft_finger\"\nspin_noise_Nm = 0.0002\n";
    let text = scene(doubted).to_rust(fingertip_scene::Scalar::F64, None).unwrap();
    assert!(text.contains("SoftFinger::new(0.0)?.with_torque_noise(0.0002)?"), "{text}");
    for (more, words) in [
        ("[contact]\nleast_force_deviations = 5.0\n", "that the rest tells"),
        ("[uncertainty]\n", "that the rest tells"),
        ("SENSOR[payload]\nmass_kg = 0.1\n", "a [payload] or a [filter] behind the gauges"),
        (
            "SENSOR[filter]\nkind = \"low_pass\"\ncutoff_Hz = 9.0\n",
            "a [payload] or a [filter] behind the gauges",
        ),
    ] {
        let more = &more.replace("SENSOR", &sensor);
        let error = scene(more).to_rust(fingertip_scene::Scalar::F64, None).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
        // As JSON all can be written, and read again.
        let json: toml::Value = serde_json::from_str(&scene(more).to_json().unwrap()).unwrap();
        Scene::from_text(&toml::to_string(&json).unwrap()).unwrap();
    }
}

/// An example that begins with volts: the module takes the readings that the pipeline takes.
#[test]
fn the_gauges_of_an_example_give_the_bits_of_the_pipeline() {
    let scene = example("gauges");
    let matrix = &scene.calibration().unwrap().matrix;
    let nominal = &scene.calibration().unwrap().nominal;
    let (mut tip, mut pipeline, mut last) = (exported::gauges::tip().unwrap(), scene.pipeline(), None);
    let mut touched = 0;
    for push in pushes_on(pipeline.surface(), 500) {
        // What the sensor would read under the opposite load, which it reports.
        let share = nalgebra::DVector::from_fn(6, |axis, _| -push.components()[axis] / nominal[axis]);
        let volts = matrix * share;
        let reading = SVector::<f64, 6>::from_iterator(volts.iter().copied());
        let touch = tip.sense(&reading, Step::of(1e-3).with_last(last));
        last = touch.point();
        let gauges: Vec<f64> = volts.iter().copied().collect();
        let felt = pipeline.sense_reading(&fingertip_scene::GaugeReading::of(&gauges), None, 1e-3).unwrap();
        assert_eq!((felt.touch.wrench, felt.touch.resolution), (touch.wrench, touch.resolution));
        assert!((touch.wrench - push).components().amax() < 1e-9);
        touched += usize::from(last.is_some());
    }
    assert!(touched > 100, "{touched}");
}

/// A light touch that wanders, jumps and lets go: followed by the exported module as by the scene, to the bit.
#[test]
fn the_contact_is_followed_as_at_run_time() {
    macro_rules! follow {
        ($module:ident, $t:ty) => {{
            use exported::$module::{contact_events, sighting, tip, tracker, wrench_noise};
            let mut pipeline = example("tracked_ball").pipeline_in::<$t>().unwrap();
            let (mut tip, mut last) = (tip().unwrap(), None);
            let (mut tracker, noise, mut events) =
                (tracker().unwrap(), wrench_noise().unwrap(), contact_events().unwrap());
            let (mut new, mut touches, mut releases) = (0, 0, 0);
            for k in 0..3000_u32 {
                let number = <$t as Real>::literal;
                let turn = f64::from(k) * 2e-3 + if k > 2000 { 1.0 } else { 0.0 };
                let normal = Vector3::new(turn.cos(), 0.4, turn.sin()).normalize().map(number);
                let jitter = number(f64::from(k * 7919 % 101) * 1e-4);
                let size = if k % 1000 < 900 { number(0.2) } else { number(0.0) };
                let push = Wrench::from_force_at(&(normal * number(0.013)), -normal * size)
                    + Wrench::on_fingertip(
                        Vector3::zeros(),
                        Vector3::new(jitter, -jitter, jitter) * number(1e-2),
                    );
                let time_step = number(1e-3);
                let felt = *pipeline.sense(push, time_step);
                let touch = tip.sense_wrench(push, Step::of(time_step).with_last(last));
                last = touch.point();
                let sighting = sighting(&tip, &touch, &noise);
                let tracked = tracker.follow(tip.surface(), sighting.as_ref(), time_step);
                assert_eq!(felt.tracked, tracked, "{k}");
                let happened = events.observe(&touch.wrench.force(), time_step);
                assert_eq!(felt.happened, Some(happened), "{k}");
                new += u32::from(tracked.is_some_and(|tracked| tracked.is_new()));
                touches += u32::from(happened.touch.is_some());
                releases += u32::from(happened.release.is_some());
            }
            // The jump at 2000 comes with the third touch.
            assert!(new >= 3, "{new}");
            assert_eq!((touches, releases), (3, 3));
        }};
    }
    follow!(tracked_ball, f64);
    follow!(tracked_ball_f32, f32);
}
