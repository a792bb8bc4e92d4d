//! Reading and writing calibration files.

use std::path::Path;

use toml::{Table, Value};

use super::bounded::read_text;
use super::document::{checksum_of, compare, malformed, open, write};
use super::{CalibrationFile, FileError, Verdict, write_whole};

/// What is said of a file without a checksum.
const UNSEALED: &str = "the file has no checksum: it was written by hand, and nobody knows how good it is";

impl CalibrationFile {
    /// Reads a calibration file.
    ///
    /// # Errors
    /// [`FileError`], naming the field, if the file cannot be read, is no calibration, has an
    /// unknown version, a number that is not finite, a list of the wrong length or a checksum that
    /// is not that of its contents.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, FileError> {
        let path = path.as_ref();
        let text =
            read_text(path).map_err(|source| FileError::Io { path: path.display().to_string(), source })?;
        Self::from_toml(&text)
    }

    /// Writes a calibration file; [`read`](Self::read) gives back the very same numbers. It appears whole or not at all: one
    /// that is there stays until then, and gives the new one its rights.
    ///
    /// # Errors
    /// [`FileError`] if the calibration is not valid or the file cannot be written; then what was there is still there.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), FileError> {
        let path = path.as_ref();
        write_whole(path, self.to_toml()?)
            .map_err(|source| FileError::Io { path: path.display().to_string(), source })
    }

    /// Reads the text of a calibration file. One without a checksum, written by hand, is taken for unchecked, and says so
    /// among the reasons of its quality; it needs `version`, `axes`, `signal_unit`, `nominal`, `matrix` and `zero`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn from_toml(text: &str) -> Result<Self, FileError> {
        let (table, found) = open(text)?;
        let mut file = field_by_field(table)?;
        file.validate()?;
        match found {
            Some(found) => compare(&file, found)?,
            None => {
                // Nobody has checked what somebody wrote by hand, whatever they say of it.
                file.quality.verdict = Verdict::Unchecked;
                file.quality.reasons.push(UNSEALED.to_owned());
            }
        }
        Ok(file)
    }

    /// The text of the calibration file: rows of matrices one to a line.
    ///
    /// # Errors
    /// [`FileError`] if the calibration is not valid.
    pub fn to_toml(&self) -> Result<String, FileError> {
        self.validate()?;
        write("Calibration of a force/torque sensor", self.version(), self)
    }

    /// The first version of the format that has what is in this file.
    fn version(&self) -> i64 {
        let entries = self.covariance.as_ref().is_some_and(|covariance| covariance.entries.is_some());
        if self.creep.is_some() {
            return 4;
        }
        match (self.curve.is_some() || self.region.is_some(), entries) {
            (true, _) => 3,
            (false, true) => 2,
            (false, false) => 1,
        }
    }

    /// The checksum of the contents: FNV-1a, 64 bits, of one line `path=type:value` per value,
    /// tables in the order of their keys, floats by their bits. It guards against accidents.
    ///
    /// # Errors
    /// [`FileError::Malformed`] if the contents cannot be represented.
    pub fn checksum(&self) -> Result<String, FileError> {
        checksum_of(self)
    }
}

/// Deserialises, and names the field if that fails: serde alone tells only of the type.
fn field_by_field(table: Table) -> Result<CalibrationFile, FileError> {
    serde_path_to_error::deserialize(Value::Table(table)).map_err(|error| {
        let field = error.path().to_string();
        let message = error.into_inner();
        // A field that is missing has no path; the message names it.
        if field == "." { malformed(message) } else { malformed(format!("field `{field}`: {message}")) }
    })
}

#[cfg(test)]
mod tests {
    use super::super::{Covariance, Quality, SignalUnit, Temperature, Verdict};
    use super::{CalibrationFile, FileError};
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    /// Uses every field.
    fn example(entry: impl Fn(usize) -> f64, gauges: usize) -> CalibrationFile {
        let list = |length: usize, from: usize| (0..length).map(|i| entry(from + i)).collect::<Vec<_>>();
        let positive =
            |length, from| list(length, from).iter().map(|x| x.abs().max(1e-300)).collect::<Vec<_>>();
        let matrix = |r, c, from| DMatrix::from_fn(r, c, |i, j| entry(from + i * c + j));
        let mut file = CalibrationFile::new(
            matrix(gauges, 6, 0),
            positive(6, 7),
            list(gauges, 40),
            SignalUnit::MillivoltPerVolt,
        )
        .unwrap();
        file.noise = Some(positive(gauges, 50));
        file.range = Some([-10.0, 10.0]);
        file.quadratic = Some(matrix(6, gauges * (gauges + 1) / 2, 60));
        let entries = (gauges != 7).then(|| matrix(6 * gauges, 6 * gauges, 5));
        file.covariance =
            Some(Covariance { signals: matrix(gauges, gauges, 3), loads: matrix(6, 6, 9), entries });
        file.temperature = Some(Temperature {
            reference_celsius: 22.5,
            range_celsius: [10.0, 40.0],
            zero_drift: list(gauges, 1),
            zero_curvature: list(gauges, 2),
            gain_drift: list(gauges, 5),
        });
        file.provenance.serial = "FT \"1\"\n[matrix]\nversion = 2 = é".to_owned();
        file.quality = Quality {
            verdict: Verdict::Bad,
            reasons: vec!["gauge 3 saturated".to_owned(), String::new()],
            samples: Some(7),
            condition_number: Some(4.5),
            rms_percent: Some(list(6, 11)),
            greatest_percent: Some(list(6, 12)),
            left_out_percent: None,
        };
        file
    }

    proptest! {
        // Of 97 numbers each; a case writes and reads some two thousand, which takes long.
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn round_trip_is_exact(bits in proptest::collection::vec(any::<u64>(), 97), gauges in 6..9_usize) {
            let number = |i: usize| {
                let x = f64::from_bits(bits[i % bits.len()]);
                if x.is_finite() { x } else { 0.1 * i as f64 }
            };
            let file = example(number, gauges);
            let text = file.to_toml().unwrap();
            let again = CalibrationFile::from_toml(&text).unwrap();
            prop_assert_eq!(&again, &file);
            // Equality forgives the sign of zero; the text does not.
            prop_assert_eq!(again.to_toml().unwrap(), text);
        }
    }

    fn text() -> String {
        example(|i| 1.0 + i as f64, 7).to_toml().unwrap()
    }

    /// What programs of before know is written as they know it.
    #[test]
    fn entries_of_the_covariance_make_it_the_second_version() {
        for (gauges, version) in [(7, "\nversion = 1\n"), (6, "\nversion = 2\n")] {
            let file = example(|i| 1.0 + i as f64, gauges);
            let text = file.to_toml().unwrap();
            assert!(text.contains(version), "{text}");
            assert_eq!(text.contains("\nentries = ["), gauges == 6);
            assert_eq!(CalibrationFile::from_toml(&text).unwrap(), file);
        }
        for none in ["version = 0", "version = -1"] {
            let error = CalibrationFile::from_toml(&text().replacen("version = 1", none, 1)).unwrap_err();
            assert!(matches!(error, FileError::UnknownVersion { .. }), "{error}");
        }
    }

    #[test]
    fn unknown_version_is_named() {
        let error =
            CalibrationFile::from_toml(&text().replacen("version = 1", "version = 5", 1)).unwrap_err();
        assert!(matches!(error, FileError::UnknownVersion { found: 5, known: 4 }));
        assert!(error.to_string().contains("`version`"));
    }

    /// Whatever it says of itself: this one says that it is bad.
    #[test]
    fn what_has_no_checksum_is_unchecked() {
        let unsealed: String = text()
            .lines()
            .filter(|line| !line.starts_with("checksum"))
            .map(|line| format!("{line}\n"))
            .collect();
        let file = CalibrationFile::from_toml(&unsealed).unwrap();
        assert_eq!(file.quality.verdict, Verdict::Unchecked);
        assert_eq!(file.quality.reasons, ["gauge 3 saturated", "", super::UNSEALED]);
    }

    #[test]
    fn wrong_checksum_tells_both() {
        let edited = text().replacen("reference_celsius = 22.5", "reference_celsius = 22.0", 1);
        let error = CalibrationFile::from_toml(&edited).unwrap_err();
        let FileError::WrongChecksum { found, expected } = &error else { panic!("{error}") };
        let mended = edited.replace(found.as_str(), expected);
        assert_eq!(CalibrationFile::from_toml(&mended).unwrap().temperature.unwrap().reference_celsius, 22.0);
    }

    #[test]
    fn entry_that_is_not_finite_is_named() {
        for (from, to, field) in [
            ("    [13.0,", "    [nan,", "matrix[2][0]"),
            ("nominal = [8.0, 9.0", "nominal = [8.0, inf", "nominal[1]"),
            ("reference_celsius = 22.5", "reference_celsius = -inf", "temperature.reference_celsius"),
        ] {
            let broken = text().replacen(from, to, 1);
            assert!(broken != text(), "{from}");
            let error = CalibrationFile::from_toml(&broken).unwrap_err();
            assert!(matches!(&error, FileError::NotFinite { field: f } if f == field), "{error}");
            assert!(error.to_string().contains(field));
        }
    }

    #[test]
    fn wrong_shape_type_missing_and_unknown_fields_are_named() {
        for (from, to, field) in [
            ("nominal = [8.0, ", "nominal = [", "nominal"),
            ("nominal = [8.0, ", "nominal = [-8.0, ", "nominal[0]"),
            ("    [13.0, ", "    [", "matrix"),
            ("nominal = ", "nominale = ", "nominal"),
            ("range = [-10.0, 10.0]", "range = \"wide\"", "range"),
            ("samples = 7", "samples = 7\nluck = 3", "quality"),
            ("axes = [\"fx\", \"fy\"", "axes = [\"fy\", \"fx\"", "axes"),
        ] {
            let broken = text().replacen(from, to, 1);
            assert!(broken != text(), "{from}");
            let error = CalibrationFile::from_toml(&broken).unwrap_err().to_string();
            assert!(error.contains(field), "{field}: {error}");
        }
        for nonsense in ["", "version = 1", "version = 1\nchecksum = 3", "=", "version = \"one\""] {
            assert!(CalibrationFile::from_toml(nonsense).is_err());
        }
    }

    #[test]
    fn comments_and_layout_are_free() {
        let relaid = text().replace("    [", "[").replace("range", "# a note\nrange");
        assert_eq!(CalibrationFile::from_toml(&relaid).unwrap(), example(|i| 1.0 + i as f64, 7));
    }

    #[test]
    fn gauges_and_axes_are_checked_against_the_type() {
        let mut file = example(|i| 1.0 + ((i * i) % 17) as f64, 7);
        assert!(matches!(file.sensor_matrix::<7>(), Err(FileError::OutOfRange { .. })));
        file.quadratic = None;
        assert_eq!(
            *file.sensor_matrix::<7>().unwrap().normalised(),
            nalgebra::SMatrix::<f64, 7, 6>::from_fn(|i, j| file.matrix[(i, j)])
        );
        assert!(matches!(file.sensor_matrix::<6>(), Err(FileError::WrongGauges { found: 7, expected: 6 })));
        file.temperature = None;
        assert_eq!(file.zero::<7>().unwrap().zero()[3], file.zero[3]);
        assert_eq!(file.sensor_matrix_in::<f32, 7>().unwrap().nominal()[0], file.nominal[0] as f32);
    }
}
