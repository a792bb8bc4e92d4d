//! When the contact was seen to slip.

use fingertip::friction::SlipVerdict;

/// Most slips that are kept one by one.
const KEPT: usize = 1000;

/// The first sample of one slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slip {
    /// \[s\]
    pub(crate) time: f64,
    /// \[N\]
    pub(crate) normal_force: Option<f64>,
    pub(crate) ratio: Option<f64>,
}

/// The slips of a run: every change from another verdict to [`SlipVerdict::Slipping`] begins one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Slips {
    kept: Vec<Slip>,
    count: u64,
    slipping: bool,
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
        let slipping = verdict == Some(SlipVerdict::Slipping);
        if slipping && !self.slipping {
            self.count += 1;
            if self.kept.len() < KEPT {
                self.kept.push(Slip { time, normal_force, ratio });
            }
        }
        self.slipping = slipping;
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
