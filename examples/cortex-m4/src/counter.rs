//! Instructions counted by a timer that advances by a fixed step with each.

use cortex_m::peripheral::{SYST, syst::SystClkSource};

/// SysTick, calibrated.
pub(crate) struct Counter {
    /// Ticks in which a thousand instructions are done.
    ticks_per_thousand: u32,
    /// Ticks between two readings with nothing between them.
    reading: u32,
}

const PERIOD: u32 = 0x00ff_ffff;

impl Counter {
    pub(crate) fn new(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(PERIOD);
        timer.clear_current();
        timer.enable_counter();
        let ticks = |turns: u32| {
            let start = SYST::get_current();
            // SAFETY: counts a register down, two instructions a turn.
            unsafe {
                core::arch::asm!("2:", "subs {turns}, #1", "bne 2b", turns = inout(reg) turns => _);
            }
            start.wrapping_sub(SYST::get_current()) & PERIOD
        };
        // The difference of two loops, so that what stands around them cancels.
        let ticks_per_thousand = (ticks(10_500) - ticks(500)) / 20;
        let reading = {
            let start = SYST::get_current();
            start.wrapping_sub(SYST::get_current()) & PERIOD
        };
        Self { ticks_per_thousand, reading }
    }

    pub(crate) const fn ticks_per_thousand(&self) -> u32 {
        self.ticks_per_thousand
    }

    /// How many instructions some work takes.
    #[inline(always)]
    pub(crate) fn instructions(&self, work: impl FnOnce()) -> u32 {
        let start = SYST::get_current();
        work();
        let ticks = start.wrapping_sub(SYST::get_current()) & PERIOD;
        let ticks = ticks.saturating_sub(self.reading);
        // Rounded to whole instructions.
        let found = (u64::from(ticks) * 1000 + u64::from(self.ticks_per_thousand / 2))
            / u64::from(self.ticks_per_thousand.max(1));
        u32::try_from(found).unwrap_or(u32::MAX)
    }
}
