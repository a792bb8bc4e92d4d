//! The greatest of many errors.

/// The greatest error seen. A NaN is refused, where `f64::max` would pass over it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst(f64);

impl Worst {
    /// None seen yet.
    pub const fn new() -> Self {
        Self(0.0)
    }

    /// Of all these errors.
    ///
    /// # Panics
    ///
    /// If one is NaN.
    #[track_caller]
    pub fn of(errors: impl IntoIterator<Item = f64>) -> Self {
        let mut worst = Self::new();
        for error in errors {
            worst.see(error);
        }
        worst
    }

    /// Takes the absolute value of one more error.
    ///
    /// # Panics
    ///
    /// If it is NaN.
    #[track_caller]
    pub fn see(&mut self, error: f64) {
        assert!(!error.is_nan(), "an error is NaN");
        self.0 = self.0.max(error.abs());
    }

    /// The greatest so far; zero if none was seen.
    pub const fn get(self) -> f64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::Worst;

    #[test]
    fn the_greatest_magnitude_is_kept() {
        let mut worst = Worst::of([0.5, -2.0, 1.0]);
        assert_eq!(worst.get(), 2.0);
        worst.see(-3.0);
        assert_eq!(worst.get(), 3.0);
    }

    #[test]
    #[should_panic(expected = "NaN")]
    fn a_nan_is_refused() {
        Worst::new().see(f64::NAN);
    }
}
