//! The creep of a sensor, as a file has it.

use fingertip_wrench::{CreepCompensation, Real};
use nalgebra::SVector;

use super::{CalibrationFile, FileError, validate};
use crate::creep::Creep;

/// Creep for the hot path. Times that a file does not have take nothing off.
pub type AnyCreep<T, const N: usize> = CreepCompensation<T, N, { Creep::MOST }>;

impl Creep {
    /// Checks it for a sensor of so many gauges.
    pub(super) fn validate(&self, gauges: usize) -> Result<(), FileError> {
        validate::finite_list("creep.times_s", &self.times_s, self.shares.len())?;
        if self.times_s.len() > Self::MOST {
            return Err(validate::out_of_range("creep.times_s", "three times at most"));
        }
        for (index, time) in self.times_s.iter().enumerate() {
            if !(*time > 0.0) {
                return Err(validate::out_of_range(&format!("creep.times_s[{index}]"), "positive"));
            }
            validate::finite_list(&format!("creep.shares[{index}]"), &self.shares[index], gauges)?;
        }
        for gauge in 0..gauges {
            if !(self.shares.iter().map(|shares| shares[gauge]).sum::<f64>() < 1.0) {
                return Err(validate::out_of_range("creep.shares", "below 1 for each gauge in all"));
            }
        }
        Ok(())
    }
}

impl CalibrationFile {
    /// What takes creep off signals in scalar type `T`, for the hot path: of readings whose zero and drift were taken off.
    /// `None` for a calibration without creep.
    ///
    /// # Errors
    /// [`FileError::WrongGauges`] if the sensor has not `N` gauges, [`FileError::OutOfRange`] for a time or a share that
    /// is none in that type.
    pub fn creep_compensation_in<T: Real, const N: usize>(
        &self,
    ) -> Result<Option<AnyCreep<T, N>>, FileError> {
        self.validate()?;
        let Some(creep) = &self.creep else { return Ok(None) };
        self.check_gauges::<N>()?;
        let (mut times, mut shares) = ([T::one(); Creep::MOST], [SVector::zeros(); Creep::MOST]);
        for (slot, time) in times.iter_mut().zip(&creep.times_s) {
            *slot = T::literal(*time);
        }
        for (slot, list) in shares.iter_mut().zip(&creep.shares) {
            *slot = SVector::from_fn(|gauge, _| T::literal(list[gauge]));
        }
        let compensation = CreepCompensation::new(times, shares);
        compensation
            .map(Some)
            .map_err(|_| validate::out_of_range("creep", "positive times and shares below 1"))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, Vector6};

    use super::super::{CalibrationFile, FileError, Scalar, SignalUnit};
    use crate::creep::Creep;

    fn file() -> CalibrationFile {
        let matrix = DMatrix::from_diagonal_element(6, 6, 2.0);
        let mut file = CalibrationFile::new(matrix, vec![10.0; 6], vec![0.5; 6], SignalUnit::Volt).unwrap();
        let shares = [0.01, -0.02].map(|share| vec![share; 6]).to_vec();
        file.creep = Some(Creep { times_s: vec![3.0, 40.0], shares });
        file
    }

    #[test]
    fn it_is_kept_in_the_fourth_version() {
        let text = file().to_toml().unwrap();
        assert!(text.contains("version = 4") && text.contains("[creep]"), "{text}");
        assert_eq!(CalibrationFile::from_toml(&text).unwrap(), file());
        // Constants alone cannot say it.
        let error = file().to_rust(Scalar::F64).unwrap_err();
        assert!(matches!(&error, FileError::OutOfRange { field, .. } if field == "creep"), "{error}");
        let none = CalibrationFile { creep: None, ..file() };
        assert!(!none.to_toml().unwrap().contains("creep"));
        assert!(none.creep_compensation_in::<f64, 6>().unwrap().is_none());
    }

    #[test]
    fn a_lasting_signal_loses_all_shares() {
        let mut creep = file().creep_compensation_in::<f32, 6>().unwrap().unwrap();
        let one = Vector6::repeat(1.0_f32);
        assert_eq!(creep.follow(&one, 0.0), Some(one));
        let lasting = creep.follow(&one, 1e6).unwrap();
        assert!((lasting - one * 1.01).amax() < 1e-6);
        assert!(matches!(file().creep_compensation_in::<f64, 7>(), Err(FileError::WrongGauges { .. })));
    }

    #[test]
    fn what_is_no_creep_is_named() {
        let refused = |change: &dyn Fn(&mut Creep)| {
            let mut file = file();
            change(file.creep.as_mut().unwrap());
            file.validate().unwrap_err().to_string()
        };
        assert!(refused(&|creep| creep.times_s[1] = 0.0).contains("creep.times_s[1]"));
        assert!(refused(&|creep| creep.times_s[0] = f64::NAN).contains("creep.times_s[0]"));
        assert!(refused(&|creep| creep.shares[1][5] = f64::INFINITY).contains("creep.shares[1][5]"));
        assert!(refused(&|creep| creep.shares[0][2] = 1.02).contains("creep.shares"));
        assert!(refused(&|creep| creep.shares.truncate(1)).contains("creep.times_s"));
        assert!(refused(&|creep| creep.shares[0].truncate(5)).contains("creep.shares[0]"));
        let many = |creep: &mut Creep| {
            (creep.times_s, creep.shares) = (vec![1.0, 2.0, 3.0, 4.0], vec![vec![0.0; 6]; 4]);
        };
        assert!(refused(&many).contains("three"));
        // A time that single precision has not.
        let mut tiny = file();
        tiny.creep.as_mut().unwrap().times_s[0] = 1e-50;
        assert!(tiny.creep_compensation_in::<f64, 6>().is_ok());
        assert!(matches!(tiny.creep_compensation_in::<f32, 6>(), Err(FileError::OutOfRange { .. })));
    }
}
