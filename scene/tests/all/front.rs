//! `[sensor]`, `[payload]` and `[filter]` of a scene, and the pipeline from a reading on.

use std::fs;
use std::path::{Path, PathBuf};

use fingertip::wrench::{Motion, Wrench};
use fingertip_calibration::file::{AtiCalibration, PayloadFile};
use fingertip_scene::{GaugeReading, NoWrench, Scene};
use nalgebra::{Vector3, Vector6};

use crate::sensor::{NOMINAL, file, signals};
use crate::{BALL, HEAD};

/// A folder that is removed at the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("fingertip-front-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    fn scene(&self, text: &str) -> Result<Scene, String> {
        let path = self.0.join("scene.toml");
        fs::write(&path, text).unwrap();
        Scene::load(&path).map_err(|error| error.to_string())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The matrix from signals to loads, as rows of TOML.
fn rows() -> String {
    let inverse = file(6).matrix.try_inverse().unwrap();
    let row = |axis: usize| {
        let row: Vec<String> =
            (0..6).map(|gauge| format!("{:?}", inverse[(axis, gauge)] * NOMINAL[axis])).collect();
        format!("[{}]", row.join(", "))
    };
    let rows: Vec<String> = (0..6).map(row).collect();
    format!("[{}]", rows.join(", "))
}

const PUSH: [f64; 6] = [0.3, -0.1, -2.0, 0.002, 0.003, 0.0];

#[test]
fn a_sensor_is_a_calibration_a_certificate_or_a_matrix() {
    let folder = Folder::new("kinds");
    let calibration = file(6);
    calibration.write(folder.0.join("tip.toml")).unwrap();
    let ati = AtiCalibration::from_calibration(&calibration).unwrap();
    fs::write(folder.0.join("FT1.CAL"), ati.to_xml()).unwrap();
    let load = Vector6::from(PUSH);
    let reading = signals(&calibration, &load);
    let without_zero: Vec<f64> = reading.iter().zip(&calibration.zero).map(|(r, z)| r - z).collect();
    let matrix = format!("signal_unit = \"V\"\nload_per_signal_N_Nm = {}\n", rows());
    let zeroed = format!("{matrix}zero = {:?}\n", calibration.zero);
    for (section, reading) in [
        ("calibration = \"tip.toml\"\n", &reading),
        ("calibration = \"FT1.CAL\"\n", &without_zero),
        (matrix.as_str(), &without_zero),
        (zeroed.as_str(), &reading),
    ] {
        for (convention, sign) in [("on_fingertip", 1.0), ("reaction", -1.0)] {
            let head = HEAD.replace("on_fingertip", convention);
            let scene = folder.scene(&format!("{head}[sensor]\n{section}{BALL}")).unwrap();
            assert_eq!(scene.calibration().unwrap().gauges(), 6);
            let mut pipeline = scene.pipeline();
            let felt = *pipeline.sense_reading(&GaugeReading::of(reading), None, 1e-3).unwrap();
            let error = (felt.touch.wrench.components() * sign - load).amax();
            assert!(error < 1e-6, "{error:e} by {section}");
            // What comes behind the wrench is what the wrench alone gives, and so in single precision.
            let again = *scene.pipeline().sense(felt.touch.wrench, 1e-3);
            assert_eq!(felt, again);
            let narrow: Vec<f32> = reading.iter().map(|x| *x as f32).collect();
            let mut single = scene.pipeline_in::<f32>().unwrap();
            let felt = single.sense_reading(&GaugeReading::of(&narrow), None, 1e-3).unwrap();
            assert!((felt.touch.wrench.components().map(f64::from) * sign - load).amax() < 1e-5);
        }
    }
    // Another calibration in the place of the scene's.
    let scene = folder.scene(&format!("{HEAD}[sensor]\ntemperature_C = 21.0\n{matrix}{BALL}")).unwrap();
    let scene = scene.calibrated_by(folder.0.join("tip.toml")).unwrap();
    assert_eq!(scene.celsius(), Some(21.0));
    assert_eq!(scene.files(), [folder.0.join("tip.toml")]);
    let wrench = scene.pipeline().sense_reading(&GaugeReading::of(&reading), None, 0.0).unwrap().touch.wrench;
    assert!((wrench.components() - load).amax() < 1e-12);
}

#[test]
fn a_sensor_that_cannot_be_is_refused_in_a_sentence() {
    let folder = Folder::new("wrong");
    let short = "load_per_signal_N_Nm = [[1.0, 2.0]]\nsignal_unit = \"V\"\n".to_owned();
    let ragged =
        format!("signal_unit = \"V\"\nload_per_signal_N_Nm = {}\n", rows().replacen("[[", "[[1.0, ", 1));
    let zeros = format!("signal_unit = \"V\"\nload_per_signal_N_Nm = {:?}\n", [[0.0; 6]; 6]);
    let same = format!("signal_unit = \"V\"\nload_per_signal_N_Nm = {:?}\n", [[1.0; 6]; 6]);
    let five = format!("signal_unit = \"V\"\nload_per_signal_N_Nm = {:?}\n", [[1.0; 5]; 6]);
    let matrix = format!("load_per_signal_N_Nm = {}\n", rows());
    for (section, words) in [
        (String::new(), vec!["[sensor]", "`calibration`", "`load_per_signal_N_Nm`"]),
        ("calibration = \"none.toml\"\n".to_owned(), vec!["none.toml"]),
        (
            format!("calibration = \"a.toml\"\n{matrix}"),
            vec!["`load_per_signal_N_Nm`", "without `calibration`"],
        ),
        ("calibration = \"a.toml\"\nzero = [0.0]\n".to_owned(), vec!["`zero`", "[sensor]"]),
        ("calibration = \"a.toml\"\nrange = [0.0, 1.0]\n".to_owned(), vec!["`range`", "[sensor]"]),
        ("calibration = \"a.toml\"\nsignal_unit = \"V\"\n".to_owned(), vec!["`signal_unit`", "[sensor]"]),
        ("calibration = \"a.toml\"\ntemperature_C = inf\n".to_owned(), vec!["`temperature_C`", "finite"]),
        (matrix.clone(), vec!["`signal_unit`", "\"V\""]),
        (short, vec!["`load_per_signal_N_Nm` has 1 entries; expected 6"]),
        (ragged, vec!["`load_per_signal_N_Nm`", "expected 7"]),
        (zeros, vec!["[sensor]"]),
        (same, vec!["[sensor]"]),
        (five, vec!["[sensor]"]),
        (format!("{matrix}signal_unit = \"V\"\nzero = [1.0]\n"), vec!["`zero` has 1 entries; expected 6"]),
        (format!("{matrix}signal_unit = \"V\"\nrange = [1.0, 0.0]\n"), vec!["range"]),
        (format!("{matrix}signal_unit = \"furlong\"\n"), vec!["signal_unit"]),
    ] {
        let error = folder.scene(&format!("{HEAD}[sensor]\n{section}{BALL}")).unwrap_err();
        assert!(!error.contains('\n') && words.iter().all(|word| error.contains(word)), "{words:?}: {error}");
    }
}

#[test]
fn a_reading_needs_a_sensor_and_a_payload_a_motion() {
    let reading = GaugeReading::of(&[0.0; 6]);
    let mut bare = Scene::from_text(&format!("{HEAD}{BALL}")).unwrap().pipeline();
    assert_eq!(bare.sense_reading(&reading, None, 0.0).map(|_| ()), Err(NoWrench::NoSensor));
    assert!(bare.sensor().is_none() && bare.sensor_mut().is_none() && bare.carried().is_none());
    let text = format!(
        "{HEAD}[sensor]\nsignal_unit = \"V\"\nload_per_signal_N_Nm = {}\n[payload]\nmass_kg = 0.1\n{BALL}",
        rows()
    );
    let mut carrying = Scene::from_text(&text).unwrap().pipeline();
    assert_eq!(carrying.sense_reading(&reading, None, 0.0).map(|_| ()), Err(NoWrench::NoMotion));
    let falling = Motion::resting(Vector3::zeros());
    assert!(carrying.sense_reading(&reading, Some(&falling), 0.0).is_ok());
    assert!(carrying.sensor().is_some() && carrying.carried().is_some());
}

#[test]
fn the_temperature_of_the_scene_serves_where_a_reading_has_none() {
    let folder = Folder::new("warm");
    let mut warm = file(6);
    warm.temperature = Some(fingertip_calibration::file::Temperature {
        reference_celsius: 20.0,
        range_celsius: [0.0, 60.0],
        zero_drift: vec![0.01; 6],
        zero_curvature: vec![0.0; 6],
        gain_drift: vec![0.0; 6],
    });
    warm.write(folder.0.join("warm.toml")).unwrap();
    let scene = |more: &str| {
        folder
            .scene(&format!("{HEAD}[sensor]\ncalibration = \"warm.toml\"\n{more}{BALL}"))
            .unwrap()
            .pipeline()
    };
    let load = Vector6::from(PUSH);
    let gauges: Vec<f64> = signals(&warm, &load).iter().map(|signal| signal + 0.1).collect();
    let reading = GaugeReading::of(&gauges);
    assert_eq!(scene("").sense_reading(&reading, None, 0.0).map(|_| ()), Err(NoWrench::Incomplete));
    let mut known = scene("temperature_C = 30.0\n");
    let found = known.sense_reading(&reading, None, 0.0).unwrap().touch.wrench.components();
    assert!((found - load).amax() < 1e-12);
    // A reading that has one knows better.
    let hot = GaugeReading { celsius: Some(40.0), ..reading };
    let found = known.sense_reading(&hot, None, 0.0).unwrap().touch.wrench.components();
    assert!((found - load).amax() > 0.1);
}

/// The weight by hand: 0.2 kg with its centre 3 cm along z, the sensor upright, then lying on its side.
#[test]
fn a_payload_is_taken_off_as_it_hangs() {
    let folder = Folder::new("payload");
    let inline = "mass_kg = 0.2\ncentre_of_mass_m = [0.0, 0.0, 0.03]\ngravity_m_per_s2 = [0.0, 0.0, -10.0]\n";
    let mut known =
        PayloadFile::new(0.2, Vector3::new(0.0, 0.0, 0.03), Vector3::new(0.0, 0.0, -10.0)).unwrap();
    fs::write(folder.0.join("body.toml"), known.to_toml().unwrap()).unwrap();
    known.force_bias = [0.5, 0.0, 0.0];
    known.torque_bias = [0.0, 0.01, 0.0];
    fs::write(folder.0.join("biased.toml"), known.to_toml().unwrap()).unwrap();
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let push = Wrench::on_fingertip(Vector3::new(0.1, 0.0, -1.0), Vector3::new(0.0, 0.002, 0.0));
    let bias = Wrench::on_fingertip(Vector3::new(0.5, 0.0, 0.0), Vector3::new(0.0, 0.01, 0.0));
    let weight =
        |force: Vector3<f64>| Wrench::on_fingertip(force, Vector3::new(0.0, 0.0, 0.03).cross(&force));
    // Columns of the rotation are the sensor's axes: a quarter turn about x lays the sensor's −y along gravity.
    let poses = [
        ([0.0, 0.0, 0.0, 1.0], weight(Vector3::new(0.0, 0.0, -2.0))),
        ([half, 0.0, 0.0, half], weight(Vector3::new(0.0, -2.0, 0.0))),
    ];
    for (section, bias) in [
        (inline.to_owned(), Wrench::zero()),
        ("file = \"body.toml\"\n".to_owned(), Wrench::zero()),
        ("file = \"biased.toml\"\n".to_owned(), bias),
    ] {
        let scene = folder.scene(&format!("{HEAD}[payload]\n{section}{BALL}")).unwrap();
        let mut pipeline = scene.pipeline();
        for (quaternion, weight) in poses {
            let gravity = pipeline.carried().unwrap().gravity(quaternion).unwrap();
            let motion = Motion::resting(gravity);
            let felt = pipeline.sense_moving(push + weight + bias, &motion, 1e-3);
            assert!((felt.touch.wrench - push).components().amax() < 1e-14, "{section}");
        }
        // A zero taken with the body on and the sensor upright holds the weight and the bias.
        let carried = pipeline.carried_mut().unwrap();
        let upright = carried.gravity(poses[0].0).unwrap();
        (0..3).for_each(|_| carried.rest(&upright));
        carried.end_rest();
        for (quaternion, weight) in poses {
            let motion = Motion::resting(pipeline.carried().unwrap().gravity(quaternion).unwrap());
            let tared = push + weight - poses[0].1;
            let felt = pipeline.sense_moving(tared, &motion, 1e-3);
            assert!((felt.touch.wrench - push).components().amax() < 1e-14, "{section}");
        }
        assert_eq!(pipeline.carried().unwrap().gravity([0.0; 4]), None);
    }
    // Inertia, which the scene may say beside a file too: a turn that speeds up about z needs I·α.
    let inertia = [[2e-4, 0.0, 0.0], [0.0, 2e-4, 0.0], [0.0, 0.0, 5e-5]];
    for section in [inline, "file = \"body.toml\"\n"] {
        let text = format!("{HEAD}[payload]\n{section}inertia_kg_m2 = {inertia:?}\n{BALL}");
        let mut pipeline = folder.scene(&text).unwrap().pipeline();
        let angular_acceleration = Vector3::new(0.0, 0.0, 40.0);
        let motion = Motion { angular_acceleration, ..Motion::resting(Vector3::zeros()) };
        let inertial = Wrench::on_fingertip(Vector3::zeros(), -angular_acceleration * 5e-5);
        let felt = pipeline.sense_moving(push + inertial, &motion, 1e-3);
        assert!((felt.touch.wrench - push).components().amax() < 1e-15, "{section}");
    }
    // In the place of the scene's.
    let other =
        Scene::from_text(&format!("{HEAD}{BALL}")).unwrap().carrying(folder.0.join("body.toml")).unwrap();
    assert!(other.pipeline().carried().is_some());
    assert_eq!(other.files(), [folder.0.join("body.toml")]);
    for (section, words) in [
        ("", "[payload] needs `file`"),
        ("file = \"none.toml\"\n", "none.toml"),
        ("file = \"body.toml\"\nmass_kg = 1.0\n", "`mass_kg`"),
        ("file = \"body.toml\"\ncentre_of_mass_m = [0.0, 0.0, 0.0]\n", "`centre_of_mass_m`"),
        ("file = \"body.toml\"\ngravity_m_per_s2 = [0.0, 0.0, 0.0]\n", "`gravity_m_per_s2`"),
        ("mass_kg = -1.0\n", "mass_kg"),
        ("mass_kg = 1.0\ncentre_of_mass_m = [nan, 0.0, 0.0]\n", "centre_of_mass_m"),
        ("mass_kg = 1.0\ninertia_kg_m2 = [[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]\n", "inertia"),
    ] {
        let error = folder.scene(&format!("{HEAD}[payload]\n{section}{BALL}")).unwrap_err();
        assert!(error.contains(words) && !error.contains('\n'), "{words}: {error}");
    }
}

fn filtered(kind: &str) -> Result<Scene, String> {
    Scene::from_text(&format!("{HEAD}[filter]\n{kind}{BALL}")).map_err(|problem| problem.to_string())
}

/// What is left of a wave of one newton, and of the torque in proportion, long after it began.
fn left_of(kind: &str, frequency: f64) -> f64 {
    let mut pipeline = filtered(kind).unwrap().pipeline();
    let (mut force, mut torque) = (0.0_f64, 0.0_f64);
    // Whole periods of every frequency that is asked for.
    for i in 0..14_000 {
        let phase = core::f64::consts::TAU * frequency * f64::from(i) / 1000.0;
        let wave = Wrench::on_fingertip(Vector3::x() * phase.sin(), Vector3::y() * 1e-3 * phase.sin());
        let found = pipeline.sense(wave, 1e-3).touch.wrench;
        if i >= 4000 {
            force += found.force().x.powi(2) / 5000.0;
            torque += found.torque().y.powi(2) / 5000.0;
        }
    }
    let (force, torque) = (force.sqrt(), torque.sqrt());
    assert!((force - torque * 1e3).abs() < 1e-9, "{force} {torque}");
    force
}

#[test]
fn filters_leave_what_they_shall() {
    let low = "kind = \"low_pass\"\ncutoff_Hz = 50.0\n";
    // Butterworth of second order, its frequencies warped by the tangent: 1/√(1 + (tan f / tan c)⁴).
    for frequency in [1.0, 20.0, 50.0, 100.0, 300.0] {
        let warped = |f: f64| (core::f64::consts::PI * f / 1000.0).tan();
        let expected = 1.0 / (1.0 + (warped(frequency) / warped(50.0)).powi(4)).sqrt();
        let found = left_of(low, frequency);
        assert!((found - expected).abs() < 1e-6, "{found} for {expected} at {frequency} Hz");
    }
    let notch = "kind = \"notch\"\nfrequency_Hz = 50.0\nwidth_Hz = 10.0\n";
    assert!(left_of(notch, 50.0) < 1e-6);
    // At the edges half the power; far away all of it.
    for edge in [45.2, 55.2] {
        let found = left_of(notch, edge);
        assert!((found - 0.5_f64.sqrt()).abs() < 0.03, "{found} at {edge} Hz");
    }
    for far in [2.0, 300.0] {
        assert!((left_of(notch, far) - 1.0).abs() < 0.02, "{}", left_of(notch, far));
    }
}

/// What overflows in a filter is given back as it came and forgotten: the next wrench is the first again.
#[test]
fn a_filter_forgets_what_it_cannot_hold() {
    let mut pipeline = filtered("kind = \"low_pass\"\ncutoff_Hz = 20.0\n").unwrap().pipeline();
    let load = |force: f64| Wrench::on_fingertip(Vector3::z() * force, Vector3::zeros());
    for force in [-f64::MAX, f64::MAX, -2.0] {
        assert_eq!(pipeline.sense(load(force), 1e-3).touch.wrench.force().z, force);
    }
}

/// Of a load that grows steadily the filtered one lags by the delay that is stated.
#[test]
fn the_delay_of_a_filter_is_as_stated() {
    for kind in [
        "kind = \"low_pass\"\ncutoff_Hz = 20.0\n",
        "kind = \"low_pass\"\ncutoff_Hz = 200.0\n",
        "kind = \"notch\"\nfrequency_Hz = 50.0\nwidth_Hz = 20.0\n",
    ] {
        let scene = filtered(kind).unwrap();
        let (mut double, mut single) = (scene.pipeline(), scene.pipeline_in::<f32>().unwrap());
        assert!((f64::from(single.delay()) - double.delay()).abs() < 1e-6 * double.delay());
        for i in 0..3000 {
            let time = f64::from(i) * 1e-3;
            let found = double.sense(Wrench::on_fingertip(Vector3::z() * time, Vector3::zeros()), 1e-3);
            let narrow = Vector3::z() * time as f32;
            let narrow = *single.sense(Wrench::on_fingertip(narrow, Vector3::zeros()), 1e-3);
            if i > 2000 {
                let lag = time - found.touch.wrench.force().z;
                assert!((lag - double.delay()).abs() < 1e-9, "{lag} for {}: {kind}", double.delay());
                let lag = time - f64::from(narrow.touch.wrench.force().z);
                assert!((lag - double.delay()).abs() < 5e-5, "{lag} in f32 for {}", double.delay());
            }
        }
    }
    let unfiltered = Scene::from_text(&format!("{HEAD}{BALL}")).unwrap();
    assert_eq!(unfiltered.pipeline().delay(), 0.0);
    let meaning = filtered("kind = \"low_pass\"\ncutoff_Hz = 20.0\n").unwrap().meaning().join("\n");
    assert!(meaning.contains("11.2 ms late"), "{meaning}");
}

#[test]
fn a_filter_starts_where_the_load_is_and_forgets_what_is_no_number() {
    let scene = filtered("kind = \"low_pass\"\ncutoff_Hz = 5.0\n").unwrap();
    let mut pipeline = scene.pipeline();
    let push = Wrench::on_fingertip(Vector3::new(0.1, 0.2, -3.0), Vector3::new(1e-3, 2e-3, 0.0));
    // A step is there at once behind a pause, and slowly otherwise.
    for time_step in [0.0, 1e-3, 1e-3] {
        assert_eq!(pipeline.sense(push, time_step).touch.wrench, push);
    }
    let double = push + push;
    assert!((pipeline.sense(double, 1e-3).touch.wrench - push).components().amax() < 1e-2);
    assert_eq!(pipeline.sense(double, 0.6).touch.wrench, double);
    pipeline.reset();
    assert_eq!(pipeline.sense(push, 1e-3).touch.wrench, push);
    // NaN passes by; what overflows starts anew.
    let none = Wrench::on_fingertip(Vector3::repeat(f64::NAN), Vector3::zeros());
    assert!(!pipeline.sense(none, 1e-3).touch.wrench.is_finite());
    // What was held is kept: a step still comes slowly.
    assert!((pipeline.sense(double, 1e-3).touch.wrench - push).components().amax() < 1e-2);
    pipeline.reset();
    assert!((pipeline.sense(push, 1e-3).touch.wrench - push).components().amax() < 1e-12);
    for huge in [1e308, -1e308, 1e308] {
        let huge = Wrench::on_fingertip(Vector3::repeat(huge), Vector3::zeros());
        assert!(pipeline.sense(huge, 1e-3).touch.wrench.is_finite());
    }
    pipeline.sense(push, 1e-3);
    for _ in 0..10_000 {
        pipeline.sense(push, 1e-3);
    }
    let settled = pipeline.sense(push, 1e-3).touch.wrench;
    assert!(settled.is_finite(), "{settled:?}");
}

#[test]
fn a_filter_that_cannot_be_is_refused_in_a_sentence() {
    for (section, words) in [
        ("kind = \"low_pass\"\ncutoff_Hz = 0.0\n", "`cutoff_Hz` of [filter]"),
        ("kind = \"low_pass\"\ncutoff_Hz = 495.0\n", "0.49 of `sample_rate_Hz`"),
        ("kind = \"low_pass\"\ncutoff_Hz = nan\n", "`cutoff_Hz` of [filter]"),
        ("kind = \"low_pass\"\ncutoff_Hz = 0.01\n", "`cutoff_Hz` of [filter]"),
        ("kind = \"notch\"\nfrequency_Hz = 600.0\nwidth_Hz = 1.0\n", "`frequency_Hz` of [filter]"),
        ("kind = \"notch\"\nfrequency_Hz = 50.0\nwidth_Hz = 50.0\n", "`width_Hz` of [filter]"),
        ("kind = \"notch\"\nfrequency_Hz = 50.0\nwidth_Hz = 0.0\n", "`width_Hz` of [filter]"),
        ("kind = \"notch\"\nfrequency_Hz = 50.0\nwidth_Hz = nan\n", "`width_Hz` of [filter]"),
    ] {
        let error = filtered(section).unwrap_err();
        assert!(error.contains(words), "{words}: {error}");
    }
    for good in [0.06, 489.0] {
        assert!(filtered(&format!("kind = \"low_pass\"\ncutoff_Hz = {good:?}\n")).is_ok(), "{good}");
    }
    let without =
        "version = 2\n[input]\nconvention = \"reaction\"\n[filter]\nkind = \"low_pass\"\ncutoff_Hz = 9.0\n";
    let error = Scene::from_text(&format!("{without}{BALL}")).unwrap_err().to_string();
    assert!(error.contains("[filter] needs `sample_rate_Hz` of [input]"), "{error}");
}
