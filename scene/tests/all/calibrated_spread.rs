//! How sure a contact is under a calibration that was fitted: its covariance counts beside noise and geometry.

use fingertip::contact::{ContactCovariance, ContactJacobian, SensorUncertainty};
use fingertip::surfaces::SmoothSurface;
use fingertip::wrench::GaussianElimination;
use fingertip_calibration::file::{CalibrationFile, Covariance};
use fingertip_scene::Scene;
use nalgebra::{DMatrix, Matrix6, Vector6};

use crate::front::Folder;
use crate::sensor::{NOMINAL, file};
use crate::{BALL, HEAD, NOISE, pushes};

/// A scene with a calibration of its own in the place of `[sensor]`.
pub(crate) fn calibrated(text: &str, file: &CalibrationFile) -> Scene {
    // A folder of its own for each thread that runs a test.
    let folder = Folder::new(&format!("{:?}", std::thread::current().id()));
    let path = folder.path().join("calibration.toml");
    std::fs::write(&path, file.to_toml().unwrap()).unwrap();
    Scene::from_text(text).unwrap().calibrated_by(&path).unwrap()
}

/// Residuals of 50 mV and more that are independent of each other, and loads of which some go together.
fn fitted() -> CalibrationFile {
    let residual = |i: usize| (0.05 * (1.0 + 0.2 * i as f64)).powi(2);
    let near = |i: usize, j: usize| if i == j { 1.0 } else { 0.3 / (1.0 + i.abs_diff(j) as f64) };
    let covariance = Covariance::product(
        DMatrix::from_fn(6, 6, |i, j| if i == j { residual(i) } else { 0.0 }),
        DMatrix::from_fn(6, 6, |i, j| 0.05 * near(i, j)),
    );
    CalibrationFile { covariance: Some(covariance), ..file(6) }
}

/// Against the covariance that the crate of contacts makes of rows of the sensor matrix that are uncertain each for itself.
#[test]
fn the_covariance_of_a_fit_is_in_the_ellipse_of_every_contact() {
    let file = fitted();
    let uncertain = format!("{HEAD}{BALL}{NOISE}");
    let (mut plain, mut pipeline) =
        (Scene::from_text(&uncertain).unwrap().pipeline(), calibrated(&uncertain, &file).pipeline());
    let without = uncertain.replace("[uncertainty]", "[uncertainty]\ncalibration = false");
    let mut left_out = calibrated(&without, &file).pipeline();
    let Covariance { signals, loads, .. } = file.covariance.as_ref().unwrap();
    let solver = GaussianElimination::new(&file.sensor_matrix::<6>().unwrap()).unwrap();
    let per_load = |i: usize, j: usize| loads[(i, j)] / (NOMINAL[i] * NOMINAL[j]);
    let rows = core::array::from_fn(|gauge| Matrix6::from_fn(per_load) * signals[(gauge, gauge)]);
    let sensor = SensorUncertainty::independent(&solver, &Vector6::zeros()).unwrap();
    let sensor = sensor.with_calibration(rows).unwrap();
    let noise = Matrix6::from_diagonal(&Vector6::new(1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8));
    let (mut told, mut greatest) = (0, 1.0);
    for push in pushes(5, 200) {
        let felt = *pipeline.sense(push, 1e-3);
        assert_eq!(plain.sense(push, 1e-3), left_out.sense(push, 1e-3));
        let Some((contact, spread)) = felt.contact().zip(felt.spread) else { continue };
        let curvature = pipeline.surface().shape_operator(&contact.point);
        let jacobian = ContactJacobian::of_point_contact(contact, &push, &curvature).unwrap();
        let covariance = ContactCovariance::new(&jacobian, &(noise + sensor.wrench_covariance(&push)));
        let expected = covariance.ellipse(0.95).unwrap();
        for (found, expected) in spread.ellipse.semi_axes.iter().zip(expected.semi_axes) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} for {expected}");
        }
        let normal = covariance.normal_force_variance().sqrt();
        assert!((spread.normal_force / normal - 1.0).abs() < 1e-9);
        let alone = plain.felt().spread.unwrap();
        assert!(spread.normal_force > alone.normal_force, "the fit tells nothing");
        greatest = f64::max(greatest, spread.normal_force / alone.normal_force);
        told += 1;
    }
    assert!(told > 50 && greatest > 1.005, "{told} contacts, at most {greatest} times as uncertain");
}

#[test]
fn what_is_asked_for_and_not_told_is_refused() {
    let asks = format!("{HEAD}{BALL}{NOISE}calibration = true\n");
    let error = Scene::from_text(&asks).unwrap_err().to_string();
    assert!(
        error.contains("`calibration = true` of [uncertainty] needs") && error.contains("[covariance]"),
        "{error}"
    );
    let folder = Folder::new("asked");
    let named = |file: &CalibrationFile| {
        std::fs::write(folder.path().join("s.toml"), file.to_toml().unwrap()).unwrap();
        let text = format!("{asks}[sensor]\ncalibration = \"s.toml\"\n");
        Scene::parse(&text, "named", folder.path()).map(|_| ()).map_err(|fault| fault.problem.to_string())
    };
    assert_eq!(named(&fitted()), Ok(()));
    assert!(named(&file(6)).unwrap_err().contains("[covariance]"));
    // Numbers that are none of a covariance.
    let mut twisted = fitted();
    twisted.covariance.as_mut().unwrap().loads[(2, 2)] = -1.0;
    let error = named(&twisted).unwrap_err();
    assert!(error.contains("covariance") && error.contains("negative variance"), "{error}");
}
