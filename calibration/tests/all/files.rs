//! What is read of files, and what they refuse.

use fingertip_calibration::Axis;
use fingertip_calibration::design::{Criterion, DesignError, NominalLoads, choose_sites};
use fingertip_calibration::file::{CalibrationFile, FileError, Scalar, SignalUnit};
use fingertip_calibration::gravity::{PayloadOptions, Pose, fit_payload};
use fingertip_calibration::loads::LoadTable;
use fingertip_calibration::nalgebra::{DMatrix, DVector, Vector3, Vector6};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::{gaussian, gaussians, turn};
use super::testing::Largest as _;

#[test]
fn every_column_of_a_table_is_read() {
    let text = "weight,v1_mV,qw,temperature_C,name,qx,fz_N,t_ms,group,qz,case,v2_mV,ty_Nm,qy\n\
                2,10,0.4,21,a,0.1,5,1000,left,0.3,up,20,0.5,0.2\n\
                0.5,30,-0.4,22.5,b,-0.1,-6,3000,right,-0.3,down,40,-0.25,-0.2\n\
                1,50,1,-3,c,0,7,2500,left,0,down,60,0,0\n";
    let (table, ignored) = LoadTable::from_csv(text.as_bytes()).unwrap();
    assert!(ignored.is_empty(), "{ignored:?}");
    assert_eq!(table.axes, [Axis::Fz, Axis::Ty]);
    assert_eq!(table.loads, DMatrix::from_row_slice(3, 2, &[5.0, 0.5, -6.0, -0.25, 7.0, 0.0]));
    let signals = DMatrix::from_row_slice(3, 2, &[0.01, 0.02, 0.03, 0.04, 0.05, 0.06]);
    assert!((&table.signals - signals).largest() < 1e-17);
    assert_eq!(table.temperatures, Some(vec![21.0, 22.5, -3.0]));
    assert_eq!(table.weights, Some(vec![2.0, 0.5, 1.0]));
    assert_eq!(table.times, Some(vec![1.0, 3.0, 2.5]));
    assert_eq!(
        (&table.names.iter().collect::<Vec<_>>()[..], &table.groups[..]),
        (&["a", "b", "c"].map(Into::into)[..], &[0, 1, 0][..])
    );
    assert_eq!(table.cases, [0, 1, 1]);
    let turns = vec![[0.1, 0.2, 0.3, 0.4], [-0.1, -0.2, -0.3, -0.4], [0.0, 0.0, 0.0, 1.0]];
    assert_eq!(table.orientations, Some(turns));
    // What has no column is not there.
    let (plain, _) = LoadTable::from_csv("fz_N,v1_V\n1,2\n-1,-2\n".as_bytes()).unwrap();
    assert_eq!(
        (plain.temperatures, plain.weights, plain.times, plain.orientations),
        (None, None, None, None)
    );
    assert_eq!(plain.groups, [0, 0]);
}

/// A sensor of three axes, or with quadratic terms, or whose zero drifts, is none for the hot path.
#[test]
fn what_is_no_linear_sensor_of_six_axes_is_refused() {
    let random = &mut Pcg64Mcg::seed_from_u64(231);
    let three =
        CalibrationFile::new(gaussians(random, 4, 3), vec![10.0; 3], vec![0.1; 4], SignalUnit::Volt).unwrap();
    assert!(matches!(three.sensor_matrix::<4>(), Err(FileError::NotSixAxes { found: 3 })));
    assert!(matches!(three.to_rust(Scalar::F64), Err(FileError::NotSixAxes { found: 3 })));
    let nominal: Vec<f64> = (1..=6).map(f64::from).collect();
    let (matrix, zero) = (gaussians(random, 6, 6), (0..6).map(|i| 0.1 * f64::from(i)).collect());
    let plain = CalibrationFile::new(matrix, nominal.clone(), zero, SignalUnit::Volt).unwrap();
    let sensor = plain.sensor_matrix::<6>().unwrap();
    assert_eq!(sensor.nominal().as_slice(), nominal);
    assert!(matches!(plain.sensor_matrix::<7>(), Err(FileError::WrongGauges { found: 6, expected: 7 })));
    assert!(matches!(plain.zero::<7>(), Err(FileError::WrongGauges { found: 6, expected: 7 })));
    assert!(plain.zero::<6>().is_ok());
    let mut bent = plain.clone();
    bent.quadratic = Some(gaussians(random, 6, 21));
    let error = bent.sensor_matrix::<6>().unwrap_err();
    assert!(matches!(&error, FileError::OutOfRange { field, .. } if field == "quadratic"), "{error}");
    // Its load: the inverse and the products of two signals each, in nominal loads.
    let reading = DVector::from_fn(6, |_, _| gaussian(random));
    let signals = DVector::from_fn(6, |i, _| reading[i] - bent.zero[i]);
    let linear = bent.matrix.clone().try_inverse().unwrap() * &signals;
    let products: Vec<f64> =
        (0..6).flat_map(|i| (i..6).map(move |j| (i, j))).map(|(i, j)| signals[i] * signals[j]).collect();
    let second = bent.quadratic.clone().unwrap() * DVector::from_vec(products);
    let found = bent.load(reading.as_slice()).unwrap();
    for i in 0..6 {
        assert!((found[i] - nominal[i] * (linear[i] + second[i])).abs() < 1e-9, "{found}");
        let straight = plain.load(reading.as_slice()).unwrap();
        assert!((straight[i] - nominal[i] * linear[i]).abs() < 1e-9, "{straight}");
    }
    let short = plain.load(&[0.0; 5]).unwrap_err().to_string();
    assert_eq!(short, "field `reading` has 5 entries; expected 6");
    let unstated = CalibrationFile::new(DMatrix::identity(6, 6), nominal, vec![0.0; 6], SignalUnit::Unstated);
    assert!(unstated.unwrap_err().to_string().starts_with("field `signal_unit` must be stated"));
}

#[test]
fn a_payload_says_how_it_was_found() {
    let random = &mut Pcg64Mcg::seed_from_u64(232);
    let poses: Vec<Pose> = (0..5)
        .map(|_| {
            let base_from_sensor = turn(random);
            let pull = base_from_sensor.tr_mul(&Vector3::new(0.0, 0.0, -3.0));
            let torque = Vector3::new(0.01, 0.02, 0.03).cross(&pull);
            let wrench = Vector6::new(pull.x, pull.y, pull.z, torque.x, torque.y, torque.z);
            Pose { base_from_sensor, wrench }
        })
        .collect();
    let file = fit_payload(&poses, &PayloadOptions::default()).unwrap().to_file(poses.len()).unwrap();
    assert_eq!((file.provenance.method.as_str(), file.quality.poses), ("gravity in several poses", 5));
}

/// Gauges that are blind to one combination of loads, however many: five directions are seen.
#[test]
fn sites_that_see_not_all_loads_are_refused() {
    let random = &mut Pcg64Mcg::seed_from_u64(233);
    let loads = NominalLoads::equal(10.0, 0.1).unwrap();
    let seen: Vec<Vector6<f64>> = (0..5).map(|_| Vector6::from_fn(|_, _| gaussian(random))).collect();
    let mut candidates: Vec<Vector6<f64>> =
        (0..12).map(|_| seen.iter().map(|direction| direction * gaussian(random)).sum()).collect();
    for count in [6, 8] {
        let error = choose_sites(&candidates, count, &Criterion::Trace, &loads).unwrap_err();
        assert!(matches!(error, DesignError::Singular { .. }), "{error}");
    }
    candidates[7] = Vector6::from_fn(|_, _| gaussian(random));
    assert!(choose_sites(&candidates, 6, &Criterion::Trace, &loads).unwrap().contains(&7));
    candidates[3][2] = f64::NAN;
    assert!(choose_sites(&candidates, 6, &Criterion::Trace, &loads).is_err());
}

/// The fields are public: a zero that was taken away makes an error of every load, and no panic.
#[test]
fn a_calibration_without_its_zero_reads_nothing() {
    let mut file =
        CalibrationFile::new(DMatrix::identity(6, 6), vec![1.0; 6], vec![0.0; 6], SignalUnit::Volt).unwrap();
    assert!(file.load(&[0.1; 6]).is_ok());
    for short in [5, 0] {
        file.zero.truncate(short);
        assert!(matches!(file.load(&[0.1; 6]), Err(FileError::Singular)), "{short} zeros");
    }
}
