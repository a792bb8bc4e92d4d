//! Every `.cal` file of the data folder is read, and its two matrices agree.

use fingertip_calibration::Axis;
use fingertip_calibration::file::{AtiCalibration, CalibrationFile};

use fingertip_test_support::recording;

#[test]
fn all_files_are_read_and_their_matrices_agree() {
    for (folder, files) in [("ati_cal_files", 6), ("ati_cert_loads", 4), ("ati_delta_raw_1khz", 1)] {
        let mut read = 0;
        let Some(folder) = recording(folder) else { continue };
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "cal") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let ati = AtiCalibration::from_xml(&text).unwrap_or_else(|error| panic!("{path:?}: {error}"));
            assert_eq!(Some(ati.serial.as_str()), path.file_stem().and_then(|stem| stem.to_str()));
            assert_eq!(AtiCalibration::from_xml(&ati.to_xml()).unwrap(), ati);
            if let Some(user) = &ati.user_axes {
                let (transformed, published) =
                    (ati.transformed_axes().unwrap(), ati.loads_per_volt().unwrap());
                for (i, axis) in Axis::ALL.into_iter().enumerate() {
                    // The size of the file's unit in SI.
                    let unit = ati.full_scale()[i] / user[i].max;
                    for j in 0..6 {
                        let difference = (transformed[(i, j)] - published[(i, j)]).abs() / unit;
                        assert!(difference < 1.1e-4, "{path:?} {axis}, gauge {j}: {difference:e}");
                    }
                }
            }
            let file = ati.to_calibration().unwrap();
            let again = CalibrationFile::from_toml(&file.to_toml().unwrap()).unwrap();
            assert_eq!(again, file);
            assert!(again.sensor_matrix::<6>().is_ok());
            read += 1;
        }
        assert_eq!(read, files);
    }
}
