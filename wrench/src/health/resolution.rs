//! The steps in which a converter's readings come.

use crate::Real;

/// Finds the step of a channel from its readings alone.
///
/// The smallest change from reading to reading is taken for the step, and changes of a few steps are counted by whether
/// they are whole multiples of it. Readings that were written with a few digits come in steps of the last digit.
///
/// ```
/// use fingertip_wrench::Resolution;
///
/// let mut resolution = Resolution::<f64>::default();
/// for i in 0..40_i32 {
///     // A step of 0.25 V.
///     resolution.add(0.25 * f64::from(i * i % 7));
/// }
/// assert_eq!(resolution.step(), Some(0.25));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution<T: Real> {
    last: Option<T>,
    /// The mean of the changes of one step; zero before the first change.
    step: T,
    singles: u32,
    whole: u32,
    broken: u32,
    changes: u32,
}

impl<T: Real> Default for Resolution<T> {
    fn default() -> Self {
        Self { last: None, step: T::zero(), singles: 0, whole: 0, broken: 0, changes: 0 }
    }
}

impl<T: Real> Resolution<T> {
    /// Fewer small changes tell no step.
    const FEWEST: u32 = 12;
    /// Behind so many changes a step that does not show is finer than the noise.
    const MANY: u32 = 64;
    /// Changes of more steps than this tell nothing: the step is known to a few percent.
    const SMALL: f64 = 8.0;
    /// How far a change may be from a whole number of steps: text has rounded both readings.
    const SLACK: f64 = 0.12;

    /// Takes the next reading; one that is not finite is left out.
    pub fn add(&mut self, reading: T) {
        if !reading.is_number() {
            return;
        }
        let Some(last) = self.last.replace(reading) else { return };
        let change = (reading - last).abs();
        if !(change > T::zero() && change.is_number()) {
            return;
        }
        self.changes = self.changes.saturating_add(1);
        if !(change > self.step * T::literal(1.0 - 4.0 * Self::SLACK)) || self.singles == 0 {
            *self = Self { step: change, singles: 1, whole: 1, broken: 0, ..*self };
            return;
        }
        // Most changes are of more steps by far: told without a division.
        if change > self.step * T::literal(Self::SMALL + 1.0) {
            return;
        }
        let steps = change / self.step;
        if steps > T::literal(Self::SMALL) {
            return;
        }
        let nearest = steps.round();
        if (steps - nearest).abs() > T::literal(Self::SLACK) {
            self.broken = self.broken.saturating_add(1);
            return;
        }
        self.whole = self.whole.saturating_add(1);
        if nearest == T::one() {
            self.singles = self.singles.saturating_add(1);
            self.step += (change - self.step) / T::literal(f64::from(self.singles));
        }
    }

    /// The last reading, and a change from reading to reading beyond which it is of more steps than tell the step; `None`
    /// before there was any change.
    pub(super) fn tells_up_to(&self) -> Option<(T, T)> {
        let last = self.last.filter(|_| self.singles > 0)?;
        Some((last, self.step * T::literal(Self::SMALL + 1.0)))
    }

    /// Takes readings that are each farther than that from the one before.
    pub(super) fn add_far(&mut self, readings: &[T]) {
        self.last = readings.last().copied().or(self.last);
        self.changes = self.changes.saturating_add(u32::try_from(readings.len()).unwrap_or(u32::MAX));
    }

    /// The step; `None` while too few small changes are known, or if they are no multiples of one: the channel's
    /// steps do not show in its noise.
    #[must_use]
    pub fn step(&self) -> Option<T> {
        // Of numbers without any step one in four is within the slack of a whole one.
        let known = self.whole >= Self::FEWEST && self.broken <= self.whole / 16;
        known.then_some(self.step)
    }

    /// Whether the readings changed often enough to say that there is no step that shows, or which.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.changes >= Self::MANY || self.step().is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::Resolution;

    /// Of readings that go up by these.
    fn of_changes(changes: impl IntoIterator<Item = f64>) -> Resolution<f64> {
        let (mut resolution, mut reading) = (Resolution::default(), 0.0);
        resolution.add(reading);
        for change in changes {
            reading += change;
            resolution.add(reading);
        }
        resolution
    }

    #[test]
    fn a_reading_that_is_no_number_is_as_if_it_were_not_there() {
        let mut resolution = Resolution::default();
        for reading in [1.0, f64::NAN, 1.5] {
            resolution.add(reading);
        }
        assert_eq!(resolution.tells_up_to(), Some((1.5, 4.5)));
    }

    #[test]
    fn changes_of_many_steps_say_nothing_and_broken_ones_that_there_is_none() {
        let singles = [1.0; 16];
        assert_eq!(of_changes(singles.into_iter().chain([8.5; 20])).step(), Some(1.0));
        assert_eq!(of_changes(singles.into_iter().chain([2.5])).step(), Some(1.0));
        assert_eq!(of_changes(singles.into_iter().chain([2.5; 20])).step(), None);
    }

    #[test]
    fn the_step_is_the_mean_of_single_ones() {
        let step = of_changes([1.0, 1.05, 0.95, 1.05, 0.95, 1.05].repeat(4)).step().unwrap();
        assert!((step - 6.05 / 6.0).abs() < 1e-9, "{step}");
    }
}
