//! What a stress case comes to.

use fingertip_wrench::Real;

/// One routine in one stress case and one precision.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) routine: String,
    pub(crate) case: String,
    pub(crate) scalar: &'static str,
    pub(crate) trials: usize,
    /// Greatest error over its bound.
    pub(crate) worst: f64,
    /// Answers of the wrong kind: no answer where there is one, or one where there is none.
    pub(crate) failures: usize,
    /// Answers that are not numbers.
    pub(crate) nan: usize,
    /// Most iterations (or evaluations, as the routine's name says), where they can be seen.
    pub(crate) iterations: Option<usize>,
    /// The first failure, or the worst error, in words.
    pub(crate) note: String,
}

impl Row {
    pub(crate) fn new<T: Real>(routine: impl Into<String>, case: impl Into<String>) -> Self {
        let scalar = if T::EPSILON.to_f64() > 1e-10 { "f32" } else { "f64" };
        Self {
            routine: routine.into(),
            case: case.into(),
            scalar,
            trials: 0,
            worst: 0.0,
            failures: 0,
            nan: 0,
            iterations: None,
            note: String::new(),
        }
    }

    /// One trial with an error and its bound.
    pub(crate) fn error(&mut self, error: f64, bound: f64, note: impl Fn() -> String) {
        self.trials += 1;
        let share = error.abs() / bound;
        if share.is_nan() {
            self.nan += 1;
            self.note = note();
        } else if share > self.worst {
            self.worst = share;
            if share > 1.0 && self.failures == 0 && self.nan == 0 {
                self.note = note();
            }
        }
    }

    /// One trial that either went as it should or did not.
    pub(crate) fn expect(&mut self, good: bool, note: impl Fn() -> String) {
        self.trials += 1;
        if !good {
            if self.failures == 0 {
                self.note = note();
            }
            self.failures += 1;
        }
    }

    pub(crate) fn iterated(&mut self, iterations: usize) {
        self.iterations = Some(self.iterations.unwrap_or(0).max(iterations));
    }

    /// Whether every trial kept its bound.
    pub(crate) fn good(&self) -> bool {
        self.worst <= 1.0 && self.failures == 0 && self.nan == 0 && self.trials > 0
    }
}
