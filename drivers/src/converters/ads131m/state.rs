//! What both faces know and decide, without I/O.

use super::configuration::Configuration;
use super::wire::{Answer, Request, Status};
use crate::converters::{Conversion, ConverterFault, ConverterStatistics, Patience};

/// Frames to throw away after a pause: as many as the device holds.
const HELD: u8 = 2;

#[derive(Clone, Copy, Debug)]
pub(super) struct Core<const N: usize> {
    pub(super) patience: Patience,
    pub(super) statistics: ConverterStatistics,
    enabled: Option<u8>,
    drain: u8,
}

impl<const N: usize> Core<N> {
    const CHIP: () = assert!(matches!(N, 2 | 3 | 4 | 6 | 8), "there are chips of 2, 3, 4, 6 and 8 channels");
    #[allow(clippy::cast_possible_truncation, reason = "at most 8")]
    pub(super) const CHANNELS: u8 = N as u8;

    pub(super) fn new(patience: Patience) -> Self {
        // An other number of channels does not compile.
        let () = Self::CHIP;
        Self { patience, statistics: ConverterStatistics::default(), enabled: None, drain: HELD }
    }

    pub(super) const fn forget(&mut self) {
        self.enabled = None;
    }

    pub(super) fn configured(&mut self, configuration: &Configuration<N>) {
        self.enabled = Some(configuration.enabled());
        self.restart();
    }

    pub(super) const fn restart(&mut self) {
        self.drain = HELD;
    }

    /// Whether frames are being thrown away: there is nothing to wait for.
    pub(super) const fn drains(&self) -> bool {
        self.drain > 0
    }

    pub(super) fn fault(&mut self, fault: ConverterFault) -> ConverterFault {
        self.statistics.note(&fault);
        match fault {
            ConverterFault::Timeout => self.restart(),
            ConverterFault::Reset => self.forget(),
            _ => {}
        }
        fault
    }

    /// What the device answered to a command, if it is what it must be.
    pub(super) fn acknowledged(&mut self, request: Request, response: u16) -> Result<(), ConverterFault> {
        match request.acknowledgement(Self::CHANNELS) {
            Some(expected) if expected != response => Err(self
                .fault(ConverterFault::Answer { expected: u32::from(expected), found: u32::from(response) })),
            _ => Ok(()),
        }
    }

    pub(super) fn ready_to_read(&self) -> Result<(), ConverterFault> {
        self.enabled.map(|_| ()).ok_or(ConverterFault::NotConfigured)
    }

    /// Takes the answer to NULL: `None` if it holds nothing new.
    pub(super) fn accept(&mut self, answer: &Answer<N>) -> Result<Option<Conversion<N>>, ConverterFault> {
        let enabled = self.enabled.ok_or(ConverterFault::NotConfigured)?;
        let status = Status(answer.response);
        // Data are whole all the same: the command that was refused said nothing.
        self.statistics.rejected += u64::from(status.has(Status::REJECTED));
        if status.has(Status::RESET) || (status.has(Status::REGISTERS) && !self.drains()) {
            return Err(self.fault(ConverterFault::Reset));
        }
        if self.drain > 0 {
            self.drain -= 1;
            return Ok(None);
        }
        if status.fresh() & enabled != enabled || enabled == 0 {
            self.statistics.stale += 1;
            return Ok(None);
        }
        let mut conversion = Conversion::clipped(answer.counts, -(1 << 23), (1 << 23) - 1);
        for (index, saturated) in conversion.saturated.iter_mut().enumerate() {
            *saturated &= enabled >> index & 1 == 1;
        }
        self.statistics.converted(&conversion);
        Ok(Some(conversion))
    }
}
