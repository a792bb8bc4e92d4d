//! A link that loses, repeats, swaps and cuts datagrams.

use alloc::collections::VecDeque;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::sensors::LinkStatistics;

/// What the link does to datagrams: probabilities between 0 and 1.
///
/// ```
/// use fingertip_drivers::sensors::FaultPlan;
/// use fingertip_drivers::sensors::ati_rdt::{Command, Request, SimulatedNetFt};
///
/// // A link that loses one datagram in ten.
/// let mut sensor = SimulatedNetFt::new(FaultPlan { loss: 0.1, ..FaultPlan::default() });
/// sensor.request(&Request { command: Command::Stream, count: 0 }.emit());
/// let mut came = 0;
/// for _ in 0..1000 {
///     sensor.sample([0; 6]);
///     came += u64::from(sensor.datagram().is_some());
/// }
/// assert_eq!(came + sensor.injected().lost, 1000);
/// assert!((50..200).contains(&sensor.injected().lost));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaultPlan {
    /// A datagram does not arrive.
    pub loss: f64,
    /// It arrives twice.
    pub duplication: f64,
    /// It arrives behind the one after it.
    pub reorder: f64,
    /// It arrives cut short.
    pub truncation: f64,
    /// Seed of the chance.
    pub seed: u64,
}

/// Datagrams on their way.
#[derive(Clone, Debug)]
pub(crate) struct DatagramLink {
    faults: FaultPlan,
    random: Pcg64Mcg,
    held_back: Option<Vec<u8>>,
    out: VecDeque<Vec<u8>>,
    injected: LinkStatistics,
}

impl DatagramLink {
    pub(crate) fn new(faults: FaultPlan) -> Self {
        Self {
            faults,
            random: Pcg64Mcg::seed_from_u64(faults.seed),
            held_back: None,
            out: VecDeque::new(),
            injected: LinkStatistics::default(),
        }
    }

    pub(crate) fn send(&mut self, datagram: &[u8]) {
        let chance = self.random.random::<f64>();
        let FaultPlan { loss, duplication, reorder, truncation, .. } = self.faults;
        // Late only if the one before it on the link arrives whole.
        let held_back = self.held_back.take();
        if chance < loss {
            self.injected.lost += 1;
        } else if chance < loss + duplication {
            self.injected.duplicates += 1;
            self.injected.late += u64::from(held_back.is_some());
            self.out.extend([datagram.to_vec(), datagram.to_vec()]);
        } else if chance < loss + duplication + reorder {
            // While another one is held back, it arrives as it is.
            if held_back.is_none() {
                self.held_back = Some(datagram.to_vec());
                return;
            }
            self.injected.late += 1;
            self.out.push_back(datagram.to_vec());
        } else if chance < loss + duplication + reorder + truncation {
            self.injected.corrupt += 1;
            let length = self.random.random_range(0..datagram.len().max(1));
            self.out.push_back(datagram.iter().take(length).copied().collect());
        } else {
            self.injected.late += u64::from(held_back.is_some());
            self.out.push_back(datagram.to_vec());
        }
        self.out.extend(held_back);
    }

    /// The next datagram that arrives.
    pub(crate) fn receive(&mut self) -> Option<Vec<u8>> {
        self.out.pop_front()
    }

    /// What was done so far: `received` stays zero.
    pub(crate) const fn injected(&self) -> &LinkStatistics {
        &self.injected
    }
}
