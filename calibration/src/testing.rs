//! What the tests of this crate share, those from inside and those from outside.

use fingertip_test_support::Worst;
use nalgebra::{Dim, Matrix, RawStorage};

/// The greatest of many errors.
pub(crate) trait Largest {
    /// The greatest magnitude of the entries; zero if there are none. nalgebra's `amax` passes over a NaN.
    ///
    /// # Panics
    /// If an entry is NaN.
    fn largest(&self) -> f64;
}

impl<R: Dim, C: Dim, S: RawStorage<f64, R, C>> Largest for Matrix<f64, R, C, S> {
    #[track_caller]
    fn largest(&self) -> f64 {
        let mut worst = Worst::new();
        for entry in self.iter() {
            worst.see(*entry);
        }
        worst.get()
    }
}
