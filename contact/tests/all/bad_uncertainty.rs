//! Uncertainties that cannot be are refused, with a reason.

use fingertip_contact::*;
use fingertip_wrench::{GaussianElimination, SensorMatrix, Wrench};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

fn solver() -> GaussianElimination<f64> {
    GaussianElimination::new(&SensorMatrix::new(Matrix6::identity() * 2.0, Vector6::repeat(1.0)).unwrap())
        .unwrap()
}

/// Not symmetric, correlated more than fully, negative along the diagonal, not a number.
fn bad() -> [Matrix6<f64>; 5] {
    let with = |places: &[(usize, usize)], value: f64| {
        let mut matrix = Matrix6::identity();
        for place in places {
            matrix[*place] = value;
        }
        matrix
    };
    [
        with(&[(0, 1)], 0.5),
        with(&[(2, 4), (4, 2)], 1.5),
        with(&[(3, 3)], -1e-9),
        with(&[(1, 2), (2, 1)], f64::NAN),
        with(&[(5, 5)], f64::INFINITY),
    ]
}

#[test]
fn of_the_signals_and_the_calibration() {
    let sensor = SensorUncertainty::new(&solver(), &Matrix6::identity()).unwrap();
    for matrix in bad() {
        let error = SensorUncertainty::new(&solver(), &matrix).unwrap_err();
        assert_eq!(error.parameter, "covariance of the signals", "{matrix}");
        let mut rows = [Matrix6::identity(); 6];
        rows[4] = matrix;
        let error = sensor.with_calibration(rows).unwrap_err();
        assert_eq!(error.parameter, "covariance of the calibration", "{matrix}");
    }
    for deviation in [-1e-3, f64::NAN, f64::INFINITY] {
        let mut deviations = Vector6::repeat(1e-3);
        deviations[5] = deviation;
        let error = SensorUncertainty::independent(&solver(), &deviations).unwrap_err();
        assert_eq!(error.parameter, "noise of the signals", "{deviation}");
    }
    // Signals of 2 per newton: noise is halved.
    let quiet = SensorUncertainty::independent(&solver(), &Vector6::repeat(2e-3)).unwrap();
    let found = quiet.wrench_covariance(&Wrench::on_fingertip(Vector3::x(), Vector3::y()));
    assert!((found - Matrix6::identity() * 1e-6).norm() < 1e-20);
}

/// What a fit leaves uncertain; a wrench that is none has an uncertainty that is none.
#[test]
fn of_a_fit() {
    let good = Matrix6::identity();
    for matrix in bad() {
        let error = CalibrationUncertainty::new(matrix, good).unwrap_err();
        assert_eq!(error.parameter, "covariance of a reading", "{matrix}");
        let error = CalibrationUncertainty::new(good, matrix).unwrap_err();
        assert_eq!(error.parameter, "spread of the loads", "{matrix}");
    }
    let fit = CalibrationUncertainty::new(good, good).unwrap();
    assert_eq!(fit.covariance(&Wrench::<f64>::zero()), Matrix6::zeros());
    let nan = Wrench::<f64>::on_fingertip(Vector3::new(f64::NAN, 0.0, 0.0), Vector3::zeros());
    assert!(fit.covariance(&nan).iter().any(|x| x.is_nan()));
}

/// Of the pitch test and of fusion with an array; the latter divides by it.
#[test]
fn of_the_wrench() {
    let auto = |noise| Auto::new(PointContact::new(0.0).unwrap(), SoftFinger::new(0.0).unwrap(), noise);
    let mut flat = Matrix6::identity();
    flat[(3, 3)] = 0.0;
    assert!(auto(flat).is_ok() && Fusion::new(Matrix6::identity(), 0.5).is_ok());
    for matrix in bad() {
        assert_eq!(auto(matrix).unwrap_err().parameter, "covariance", "{matrix}");
        assert_eq!(Fusion::new(matrix, 0.5).unwrap_err().parameter, "covariance of the wrench", "{matrix}");
    }
    assert!(Fusion::new(flat, 0.5).is_err());
    for friction in [0.0, -0.5, f64::NAN, f64::INFINITY] {
        assert_eq!(Fusion::new(Matrix6::identity(), friction).unwrap_err().parameter, "friction coefficient");
    }
}

#[test]
fn of_a_data_sheet() {
    let floor = Vector6::repeat(0.1);
    let noise = WrenchNoise::new(floor, 0.01).unwrap();
    let wrench = Wrench::on_fingertip(Vector3::new(3.0, 0.0, 0.0), Vector3::zeros());
    let expected = Matrix6::from_diagonal(&Vector6::new(0.0109, 0.01, 0.01, 0.01, 0.01, 0.01));
    assert!((noise.covariance(&wrench) - expected).norm() < 1e-16);
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let mut floor = floor;
        assert!(WrenchNoise::new(floor, bad).is_err());
        floor[3] = bad;
        assert!(WrenchNoise::new(floor, 0.01).is_err());
    }
}

#[test]
fn of_a_geometry() {
    let good = GeometryUncertainty {
        offset: 1e-10,
        position: Matrix3::new(4e-10, 1e-10, 0.0, 1e-10, 2e-10, 0.0, 0.0, 0.0, 1e-10),
        attitude: Matrix3::from_diagonal(&Vector3::new(1e-6, 0.0, 1e-6)),
        pivot: Vector3::new(0.0, 0.0, -0.01),
    };
    assert_eq!(good.checked(), Ok(good));
    let crooked = Matrix3::new(1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    for (bad, parameter) in [
        (GeometryUncertainty { offset: -1e-10, ..good }, "offset"),
        (GeometryUncertainty { offset: f64::NAN, ..good }, "offset"),
        (GeometryUncertainty { offset: f64::INFINITY, ..good }, "offset"),
        (GeometryUncertainty { position: crooked, ..good }, "position"),
        (GeometryUncertainty { attitude: crooked, ..good }, "attitude"),
        (GeometryUncertainty { pivot: Vector3::new(0.0, f64::NAN, 0.0), ..good }, "pivot"),
    ] {
        assert_eq!(bad.checked().unwrap_err().parameter, parameter);
    }
}

/// A noise that cannot be does not come out of a file.
#[cfg(feature = "serde")]
#[test]
fn of_a_file() {
    let noise = WrenchNoise::new(Vector6::repeat(0.1), 0.01).unwrap();
    let written = toml::to_string(&noise).unwrap();
    assert_eq!(toml::from_str::<WrenchNoise<f64>>(&written).unwrap(), noise);
    let error = toml::from_str::<WrenchNoise<f64>>(&written.replace("0.01", "-0.01")).unwrap_err();
    assert!(error.to_string().contains("finite and not negative"), "{error}");
}
