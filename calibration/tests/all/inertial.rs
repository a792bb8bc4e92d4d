//! Mass, centre, inertia and delay from a motion: against heavy points that go their way through the world.

use fingertip_calibration::file::{PayloadFile, Verdict};
use fingertip_calibration::inertial::{
    InertialError, InertialFit, InertialOptions, MovingSample, fit_inertial, moving_samples,
};
use fingertip_calibration::nalgebra::{Matrix3, Rotation3, Vector3, Vector6};
use fingertip_recordings::RecordingReader;
use fingertip_test_support::MovingBody;
use fingertip_wrench::{InertialReading, InertialUnit};
use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// How a motion is recorded.
#[derive(Clone, Copy)]
struct Recorded {
    rate: f64,
    seconds: f64,
    /// So much later than the wrench the inertial readings come \[s\].
    delay: f64,
    /// Deviations of forces \[N\], torques \[N·m\], accelerations \[m/s²\] and rates \[rad/s\].
    noise: [f64; 4],
    seed: u64,
}

const QUIET: Recorded = Recorded { rate: 1000.0, seconds: 8.0, delay: 0.0, noise: [0.0; 4], seed: 1 };
const NOISY: Recorded = Recorded { noise: [0.02, 4e-4, 0.02, 0.002], ..QUIET };

const BIAS: [f64; 6] = [0.4, -0.7, 1.1, 0.02, -0.01, 0.03];
const RESTING_RATE: [f64; 3] = [0.01, -0.02, 0.015];

fn turned() -> Rotation3<f64> {
    Rotation3::from_euler_angles(0.3, -1.1, 2.0)
}

fn options() -> InertialOptions {
    let unit = InertialUnit::new(turned().into_inner(), MovingBody::swung().unit).unwrap();
    InertialOptions { unit, rest: Some(0.95), ..InertialOptions::default() }
}

/// What a sensor, and the unit on it, read of a body that is swung.
fn recorded(body: &MovingBody, how: &Recorded) -> Vec<MovingSample> {
    let random = &mut Pcg64Mcg::seed_from_u64(how.seed);
    let mut normal = |deviation: f64| {
        let x: f64 = StandardNormal.sample(random);
        deviation * x
    };
    let count = (how.seconds * how.rate) as usize;
    (0..count)
        .map(|k| {
            let time = k as f64 / how.rate;
            let (load, ride) = (body.at(time), body.at(time - how.delay));
            let wrench = load.wrench + Vector6::from(BIAS);
            let wrench = Vector6::from_fn(|i, _| wrench[i] + normal(how.noise[i / 3]));
            let own = |v: Vector3<f64>| turned().inverse() * v;
            let reading = InertialReading {
                acceleration: own(ride.acceleration).map(|x| x + normal(how.noise[2])),
                angular_velocity: (own(ride.angular_velocity) + Vector3::from(RESTING_RATE))
                    .map(|x| x + normal(how.noise[3])),
            };
            MovingSample { time, wrench, reading }
        })
        .collect()
}

fn close(fit: &InertialFit, body: &MovingBody, tolerance: f64) {
    let (mass, centre, inertia) = body.mass_properties();
    assert!((fit.body.mass - mass).abs() < tolerance * mass, "{} {mass}", fit.body.mass);
    assert!((fit.body.centre - centre).norm() < tolerance * 0.1, "{} {centre}", fit.body.centre);
    let most = inertia.amax();
    assert!((fit.body.inertia - inertia).amax() < 10.0 * tolerance * most, "{} {inertia}", fit.body.inertia);
    assert_eq!(fit.body.inertia, fit.body.inertia.transpose());
}

#[test]
fn a_body_that_is_swung_comes_back() {
    let body = MovingBody::swung_after_a_rest();
    for delay in [0.0, 0.0173, -0.042] {
        let samples = recorded(&body, &Recorded { delay, ..QUIET });
        let fit = fit_inertial(&samples, &options()).unwrap();
        close(&fit, &body, 1e-3);
        let found = fit.delay.unwrap();
        assert!((found.seconds - delay).abs() < 2e-5, "{found:?} {delay}");
        assert!(fit.undetermined.is_empty() && fit.warnings.len() <= 1, "{fit:?}");
        assert!((fit.force_bias - Vector3::new(0.4, -0.7, 1.1)).norm() < 0.01, "{}", fit.force_bias);
        assert!((fit.torque_bias - Vector3::new(0.02, -0.01, 0.03)).norm() < 1e-3);
        assert!((fit.unit.resting_rate() - Vector3::from(RESTING_RATE)).norm() < 1e-9);
        assert!(fit.share_left() < 2e-3, "{}", fit.share_left());
    }
}

/// Whoever knows that the readings come together asks for no search.
#[test]
fn a_delay_that_is_known_to_be_none_is_not_sought() {
    let body = MovingBody::swung_after_a_rest();
    let together = InertialOptions { longest_delay: 0.0, ..options() };
    let fit = fit_inertial(&recorded(&body, &QUIET), &together).unwrap();
    close(&fit, &body, 1e-3);
    assert!(fit.delay.is_none() && fit.warnings.len() <= 1, "{fit:?}");
}

/// Half a swing and more, from where no step leads back: a search finds it.
#[test]
fn a_delay_of_more_than_half_a_swing_is_found() {
    let body = MovingBody::swung_after_a_rest();
    for delay in [0.31, -0.27] {
        let samples = recorded(&body, &Recorded { delay, rate: 500.0, ..QUIET });
        let fit = fit_inertial(&samples, &InertialOptions { longest_delay: 0.5, ..options() }).unwrap();
        let found = fit.delay.unwrap();
        assert!((found.seconds - delay).abs() < 1e-3, "{found:?} {delay}");
        close(&fit, &body, 1e-2);
    }
}

/// With noise, less than two deviations of it are left, and the body is as sure as is said.
#[test]
fn what_is_left_of_a_noisy_motion_is_noise_and_deviations_are_right() {
    let body = MovingBody::swung_after_a_rest();
    let (mass, centre, inertia) = body.mass_properties();
    let mut off: Vec<Vec<f64>> = Vec::new();
    for seed in 0..12 {
        let samples = recorded(&body, &Recorded { seed, delay: 0.006, ..NOISY });
        let fit = fit_inertial(&samples, &options()).unwrap();
        let over = fit.over_noise().unwrap();
        let noise = fit.noise.unwrap();
        assert!(over < 2.0, "{over}: {} {noise}", fit.left);
        // At rest there is the noise of the sensor, of which the smoothing leaves a part.
        for i in 0..6 {
            assert!((0.1..0.8).contains(&(noise[i] / NOISY.noise[i / 3])), "{noise}");
        }
        assert_eq!(fit.verdict(), Verdict::Good, "{:?}", fit.warnings);
        let delay = fit.delay.unwrap();
        let mut of_this =
            vec![(fit.body.mass - mass) / fit.mass_deviation, (delay.seconds - 0.006) / delay.deviation];
        for i in 0..3 {
            of_this.push((fit.body.centre[i] - centre[i]) / fit.centre_deviation[i]);
            of_this.push((fit.body.inertia[(i, i)] - inertia[(i, i)]) / fit.inertia_deviation[(i, i)]);
            of_this.push((fit.force_bias[i] - BIAS[i]) / fit.bias_deviation[i]);
        }
        off.push(of_this);
    }
    let count = off.len() as f64 * off[0].len() as f64;
    let squares: f64 = off.iter().flatten().map(|x| x * x).sum();
    let rms = (squares / count).sqrt();
    println!("errors over their deviations, RMS: {rms:.3}");
    assert!((0.75..1.35).contains(&rms), "{rms}");
}

/// A motion along one line tells the mass, and of the centre what lies across: the rest is named and does no harm.
#[test]
fn what_a_motion_does_not_excite_is_named() {
    let body = MovingBody {
        place: |t| Vector3::new(0.1 * (3.0 * (t - 1.0).max(0.0)).sin().powi(4), 0.0, 0.0),
        turn: |_| Vector3::zeros(),
        ..MovingBody::swung()
    };
    let (mass, centre, _) = body.mass_properties();
    let plain = |how: &Recorded| {
        let mut samples = recorded(&body, how);
        samples.iter_mut().for_each(|sample| sample.reading.angular_velocity = Vector3::zeros());
        samples
    };
    let fit = fit_inertial(&plain(&NOISY), &options()).unwrap();
    assert!((fit.body.mass - mass).abs() < 4.0 * fit.mass_deviation && fit.mass_deviation < 0.01 * mass);
    assert!((fit.body.centre.yz() - centre.yz()).norm() < 2e-3, "{}", fit.body.centre);
    let names = ["centre of mass x", "inertia xx", "inertia yy", "inertia zz"];
    assert!(names.iter().all(|name| fit.undetermined.contains(name)), "{:?}", fit.undetermined);
    assert!(!fit.undetermined.contains(&"centre of mass y"), "{:?}", fit.undetermined);
    assert!((fit.body.centre.x - centre.x).abs() < 3.0 * fit.centre_deviation.x, "{:?}", fit.body);
    assert!(fit.centre_deviation.x > 0.05 && fit.body.inertia.amax() < 2e-3, "{:?}", fit.body);
    // What is not told of the inertia is that of a point at the centre, of which nothing is negative.
    assert!(fit.least_moment.abs() < 5e-4, "{}", fit.least_moment);
    assert!(!fit.warnings.iter().any(|warning| warning.starts_with("no body has")), "{:?}", fit.warnings);
    assert_eq!(fit.verdict(), Verdict::Suspect);
    assert!(fit.share_left() < 0.05, "{}", fit.share_left());
}

#[test]
fn mistakes_are_named() {
    let body = MovingBody::swung_after_a_rest();
    let samples = recorded(&body, &Recorded { seconds: 4.0, ..NOISY });
    let changed = |change: &dyn Fn(&mut MovingSample)| {
        let mut samples = samples.clone();
        samples.iter_mut().for_each(change);
        fit_inertial(&samples, &options())
    };
    let reaction = changed(&|sample| sample.wrench.neg_mut()).unwrap_err();
    assert!(matches!(reaction, InertialError::NegativeMass { .. }), "{reaction}");
    let in_g = changed(&|sample| sample.reading.acceleration /= 9.806_65).unwrap();
    assert!(in_g.warnings.iter().any(|warning| warning.contains("in g")), "{:?}", in_g.warnings);
    // One that reads too much is told by what it reads at rest, and how far the mass is off; one that is right is not.
    let too_much = changed(&|sample| sample.reading.acceleration *= 1.05).unwrap();
    let told = |fit: &InertialFit, what: &str| fit.warnings.iter().any(|warning| warning.contains(what));
    assert!(told(&too_much, "the mass may be off by 5 %"), "{:?}", too_much.warnings);
    let right = fit_inertial(&samples, &options()).unwrap();
    assert!(!told(&right, "accelerometer"), "{:?}", right.warnings);
    // A fifth of the force that is left is bad, and so is a mass that is known to a tenth, each by itself.
    assert_ne!(right.verdict(), Verdict::Bad);
    let unsure = InertialFit { mass_deviation: 0.11 * right.body.mass, ..right.clone() };
    assert_eq!(unsure.verdict(), Verdict::Bad);
    let much_left = InertialFit { left: right.load * 0.21, ..right.clone() };
    assert!(much_left.mass_deviation < 0.1 * right.body.mass);
    assert_eq!(much_left.verdict(), Verdict::Bad);
    // Axes that are not as said leave much.
    let turned = InertialOptions { unit: InertialUnit::at_the_origin(), ..options() };
    match fit_inertial(&samples, &turned) {
        Ok(fit) => assert_eq!(fit.verdict(), Verdict::Bad, "{fit:?}"),
        Err(error) => {
            assert!(matches!(error, InertialError::NegativeMass { .. } | InertialError::NoMass { .. }))
        }
    }
    // A sensor that only rests tells no mass.
    let resting: Vec<MovingSample> = recorded(&body, &Recorded { seconds: 0.98, ..NOISY });
    let error = fit_inertial(&resting, &InertialOptions { rest: Some(0.98), ..options() }).unwrap_err();
    assert!(matches!(error, InertialError::NoMass { .. }), "{error}");
    let short = fit_inertial(&samples[..400], &options()).unwrap_err();
    assert!(matches!(short, InertialError::TooShort { .. }), "{short}");
    assert!(matches!(fit_inertial(&[], &options()), Err(InertialError::TooShort { .. })));
    let bad = changed(&|sample| {
        if sample.time == 1.5 {
            sample.reading.acceleration.y = f64::NAN;
        }
    });
    assert_eq!(bad, Err(InertialError::NotFinite { sample: 1500 }));
    for wrong in [
        InertialOptions { time_constant: 0.0, ..options() },
        InertialOptions { time_constant: f64::NAN, ..options() },
        InertialOptions { longest_delay: -1.0, ..options() },
        InertialOptions { reach: 0.0, ..options() },
        InertialOptions { rest: Some(f64::NAN), ..options() },
    ] {
        let error = fit_inertial(&samples, &wrong).unwrap_err();
        assert!(matches!(error, InertialError::Option { .. } | InertialError::Unit(_)), "{error}");
    }
}

/// What no body has is brought to what one has, and said if it is more than noise.
#[test]
fn an_inertia_that_no_body_has_is_said() {
    let body = MovingBody::swung_after_a_rest();
    let mut samples = recorded(&body, &Recorded { seconds: 6.0, ..QUIET });
    // Torques that a body with a negative moment would need: those of the body, less a lot about z.
    let step = 1e-3;
    let rates: Vec<Vector3<f64>> = samples
        .iter()
        .map(|sample| turned() * (sample.reading.angular_velocity - Vector3::from(RESTING_RATE)))
        .collect();
    for k in 1..samples.len() - 1 {
        let faster = (rates[k + 1].z - rates[k - 1].z) / (2.0 * step);
        let [x, y, z] = rates[k].into();
        // Jα + ω × Jω of a negative moment about z.
        let torque = Vector3::new(y * z, -x * z, faster) * 0.02;
        samples[k].wrench += Vector6::new(0.0, 0.0, 0.0, torque.x, torque.y, torque.z);
    }
    let fit = fit_inertial(&samples, &options()).unwrap();
    assert!(fit.least_moment < -1e-3, "{fit:#?}");
    assert!(fit.warnings.iter().any(|warning| warning.contains("no body has")), "{:?}", fit.warnings);
    let moments = Matrix3::identity() * (0.5 * fit.body.inertia.trace()) - fit.body.inertia;
    assert!(moments.symmetric_eigenvalues().min() > -1e-9);
}

/// The file has all that takes the load off, and a recording is read as it was written.
#[test]
fn a_file_and_a_recording_go_round() {
    let body = MovingBody::swung_after_a_rest();
    let samples = recorded(&body, &Recorded { rate: 200.0, delay: 0.01, ..NOISY });
    let mut csv = String::from("t_s");
    for name in ["fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm", "ax_m_per_s2", "ay_m_per_s2"] {
        csv += &format!(",{name}");
    }
    csv += ",az_m_per_s2,wx_rad_per_s,wy_rad_per_s,wz_rad_per_s\n";
    for sample in &samples {
        csv += &sample.time.to_string();
        let (a, w) = (&sample.reading.acceleration, &sample.reading.angular_velocity);
        for x in sample.wrench.iter().chain(a.iter()).chain(w.iter()) {
            csv += &format!(",{x}");
        }
        csv.push('\n');
    }
    let mut reader = RecordingReader::new("motion", csv.as_bytes()).unwrap();
    let (read, left_out) = moving_samples(&mut reader, None, None).unwrap();
    assert_eq!((read.len(), left_out), (samples.len(), 0));
    assert_eq!(read, samples);
    let fit = fit_inertial(&read, &options()).unwrap();
    let file = fit.to_file().unwrap();
    let again = PayloadFile::from_toml(&file.to_toml().unwrap()).unwrap();
    assert_eq!(again, file);
    let unit = again.inertial_unit.unwrap();
    assert!((unit.delay - 0.01).abs() < 1e-3 && unit.time_constant == 0.01);
    assert_eq!(again.payload::<f64>().unwrap().inertia(), fit.body.inertia);
    let lacking = csv.replacen("wz_rad_per_s", "wz", 1);
    let error = moving_samples(&mut RecordingReader::new("motion", lacking.as_bytes()).unwrap(), None, None);
    assert!(error.unwrap_err().to_string().contains("wz_rad_per_s"));
}
