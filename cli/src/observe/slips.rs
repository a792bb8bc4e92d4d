//! When the contact was seen to slip.

use fingertip::friction::SlipVerdict;

/// Most slips that are kept one by one.
const KEPT: usize = 1000;

/// A detector calls one slide again and again while the friction ratio still falls. Calls that
/// follow one another within this time are one slip \[s\].
const SAME_SLIP: f64 = 0.05;

/// The first sample of one slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slip {
    /// \[s\]
    pub(crate) time: f64,
    /// \[N\]
    pub(crate) normal_force: Option<f64>,
    pub(crate) ratio: Option<f64>,
}

/// The slips of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Slips {
    kept: Vec<Slip>,
    count: u64,
    last_call: Option<f64>,
}

impl Slips {
    /// Takes the verdict of the next sample.
    #[inline]
    pub(crate) fn follow(
        &mut self,
        time: f64,
        verdict: Option<SlipVerdict>,
        normal_force: Option<f64>,
        ratio: Option<f64>,
    ) {
        if verdict != Some(SlipVerdict::Slipping) {
            return;
        }
        let goes_on = self.last_call.is_some_and(|last| (time - last).abs() <= SAME_SLIP);
        self.last_call = Some(time);
        if !goes_on {
            self.count += 1;
            if self.kept.len() < KEPT {
                self.kept.push(Slip { time, normal_force, ratio });
            }
        }
    }

    /// The first thousand.
    pub(crate) fn kept(&self) -> &[Slip] {
        &self.kept
    }

    /// How many there were in all.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }
}

#[cfg(test)]
mod tests {
    use fingertip::friction::SlipVerdict;

    use super::{Slip, Slips};

    #[test]
    fn one_slide_is_one_slip_however_often_it_is_called() {
        let mut slips = Slips::default();
        for millisecond in 0..2000_u32 {
            let time = f64::from(millisecond) * 1e-3;
            // Called every 4 ms from 0.5 s to 0.6 s, without a break from 1.0 s to 1.2 s, and once at 1.9 s.
            let called = (500..=600).contains(&millisecond) && millisecond.is_multiple_of(4)
                || (1000..=1200).contains(&millisecond)
                || millisecond == 1900;
            let verdict = if called { SlipVerdict::Slipping } else { SlipVerdict::Holding };
            slips.follow(time, Some(verdict), Some(1.0), Some(0.5));
        }
        let times: Vec<f64> = slips.kept().iter().map(|slip| slip.time).collect();
        assert_eq!((slips.count(), times), (3, [500.0, 1000.0, 1900.0].map(|ms| ms * 1e-3).to_vec()));
        let mut off = Slips::default();
        off.follow(0.0, None, None, None);
        assert_eq!(off.count(), 0);
    }

    #[test]
    fn the_first_call_of_a_slip_is_kept_with_its_force_and_its_ratio() {
        let mut slips = Slips::default();
        let call = Some(SlipVerdict::Slipping);
        // Calls 50 ms apart are one slip, calls 51 ms apart are two.
        slips.follow(0.0, call, Some(2.0), Some(0.4));
        slips.follow(0.05, call, Some(2.5), Some(0.3));
        slips.follow(0.101, call, None, None);
        let first = Slip { time: 0.0, normal_force: Some(2.0), ratio: Some(0.4) };
        assert_eq!(slips.kept(), [first, Slip { time: 0.101, normal_force: None, ratio: None }]);
        // A recording that is put together may go back in time.
        slips.follow(-0.5, call, None, None);
        assert_eq!(slips.count(), 3);
    }

    #[test]
    fn all_slips_are_counted_and_a_thousand_are_kept() {
        let mut slips = Slips::default();
        for number in 0..1500 {
            slips.follow(f64::from(number), Some(SlipVerdict::Slipping), None, None);
        }
        assert_eq!((slips.count(), slips.kept().len()), (1500, 1000));
        assert_eq!(slips.kept()[999].time, 999.0);
    }
}
