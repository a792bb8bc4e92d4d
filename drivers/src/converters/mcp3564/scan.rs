//! Cycles of inputs from single conversions.

use super::configuration::Channel;
use super::wire::Data;

/// Puts conversions together to cycles through `N` inputs.
///
/// The device goes through its list up or down; which of the two shows in the first `N` conversions that are
/// all different, and with it where a cycle begins. (With two inputs either order looks like the other: a cycle
/// begins with the first conversion then.) A conversion that is out of turn ends its cycle, and the next one
/// begins at the next beginning.
///
/// Conversions carry the number of their input and no count: if exactly `N` of them in a row are missed in the
/// midst of a cycle (or 2N …), the one after them is in turn again and the cycle is mixed from two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scan<const N: usize> {
    inputs: [u8; N],
    /// The order in which they come, once it is known.
    order: Option<[u8; N]>,
    /// Conversions of the cycle so far, in the order in which they came.
    cycle: [Data; N],
    count: usize,
}

const NONE: Data = Data { channel: 0xFF, counts: 0 };

impl<const N: usize> Scan<N> {
    pub(super) fn new(inputs: [Channel; N]) -> Self {
        Self { inputs: inputs.map(|channel| channel as u8), order: None, cycle: [NONE; N], count: 0 }
    }

    /// Gives up the cycle that is under way, and says of how many conversions it was.
    pub(super) const fn restart(&mut self) -> usize {
        core::mem::replace(&mut self.count, 0)
    }

    fn put(&mut self, data: Data) {
        if let Some(place) = self.cycle.get_mut(self.count) {
            *place = data;
            self.count += 1;
        }
    }

    /// Takes a conversion: the counts of a cycle if it completes one, in the order of the inputs, and how many
    /// conversions were passed over.
    pub(super) fn push(&mut self, data: Data) -> (Option<[i32; N]>, usize) {
        let Some(order) = self.order else { return (None, self.learn(data)) };
        let mut lost = 0;
        if order.get(self.count) != Some(&data.channel) {
            lost = self.restart();
            if order.first() != Some(&data.channel) {
                return (None, lost + 1);
            }
        }
        self.put(data);
        if self.count < N {
            return (None, lost);
        }
        self.count = 0;
        let counts = self
            .inputs
            .map(|input| self.cycle.iter().find(|data| data.channel == input).map_or(0, |data| data.counts));
        (Some(counts), lost)
    }

    /// Takes a conversion of the first cycle, which is not given.
    fn learn(&mut self, data: Data) -> usize {
        let seen = self.cycle.get(..self.count).unwrap_or_default();
        if seen.iter().any(|other| other.channel == data.channel) || !self.inputs.contains(&data.channel) {
            self.restart();
        }
        if !self.inputs.contains(&data.channel) {
            return 1;
        }
        self.put(data);
        if self.count == N {
            let mut order = self.cycle.map(|data| data.channel);
            let falls = order.iter().zip(order.iter().skip(1)).filter(|(one, two)| one > two).count();
            if N > 2 {
                // A list that runs up falls once at most where a cycle ends; one that runs down rises once.
                order.sort_unstable();
                if falls > 1 {
                    order.reverse();
                }
            }
            self.order = Some(order);
            self.restart();
        }
        1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const INPUTS: [Channel; 4] = [Channel::PairB, Channel::PairA, Channel::PairD, Channel::Pin2];

    proptest! {
        /// Conversions of which some are missing: no cycle is ever mixed from two, and all whole ones come.
        #[test]
        fn only_whole_cycles_are_given(down in any::<bool>(), missing in prop::collection::vec(prop::bool::weighted(0.1), 8..200)) {
            let mut order: Vec<u8> = INPUTS.map(|channel| channel as u8).to_vec();
            order.sort_unstable();
            if down { order.reverse(); }
            let mut scan = Scan::new(INPUTS);
            let (mut given, mut passed) = (Vec::new(), 0);
            let mut taken = 0;
            let mut whole = Vec::new();
            // Four in a row cannot be noticed, as is said above.
            let mut missing = missing;
            let mut run = 0;
            for one in &mut missing {
                *one &= run < 3;
                run = if *one { run + 1 } else { 0 };
            }
            for (cycle, missing) in missing.chunks_exact(4).enumerate() {
                // The first two cycles are whole, so that the order is known.
                let missing = if cycle < 2 { &[false; 4] } else { missing };
                if cycle > 0 && !missing.contains(&true) { whole.push(cycle as i32); }
                for (channel, missing) in order.iter().zip(missing) {
                    if *missing { continue; }
                    taken += 1;
                    let (counts, lost) = scan.push(Data { channel: *channel, counts: cycle as i32 * 16 + i32::from(*channel) });
                    passed += lost;
                    given.extend(counts);
                }
            }
            for counts in &given {
                let cycle = counts[0] / 16;
                let expected = INPUTS.map(|channel| cycle * 16 + channel as i32);
                prop_assert_eq!(*counts, expected);
            }
            prop_assert_eq!(given.iter().map(|counts| counts[0] / 16).collect::<Vec<_>>(), whole);
            prop_assert_eq!(passed + 4 * given.len() + scan.count, taken);
        }

        #[test]
        fn it_does_not_matter_where_in_a_cycle_one_begins(down in any::<bool>(), begin in 0_usize..4) {
            let mut order: Vec<u8> = INPUTS.map(|channel| channel as u8).to_vec();
            order.sort_unstable();
            if down { order.reverse(); }
            let mut scan = Scan::new(INPUTS);
            let mut given = 0;
            for number in begin..40 {
                let channel = order[number % 4];
                let (counts, _) = scan.push(Data { channel, counts: number as i32 / 4 });
                if let Some(counts) = counts {
                    prop_assert!(counts.iter().all(|count| *count == counts[0]));
                    given += 1;
                }
            }
            prop_assert!(given >= 8);
        }
    }

    #[test]
    fn one_input_and_two_are_cycles_as_well() {
        let mut one = Scan::new([Channel::Pin0]);
        assert_eq!(one.push(Data { channel: 0, counts: 1 }), (None, 1));
        assert_eq!(one.push(Data { channel: 0, counts: 2 }), (Some([2]), 0));
        assert_eq!(one.push(Data { channel: 1, counts: 2 }), (None, 1));
        let mut two = Scan::new([Channel::Pin0, Channel::Pin1]);
        for number in 0..6 {
            let counts = two.push(Data { channel: 1 - (number % 2) as u8, counts: number }).0;
            assert_eq!(counts, (number > 2 && number % 2 == 1).then_some([number, number - 1]));
        }
    }
    #[test]
    fn a_channel_that_was_not_asked_for_is_passed_over() {
        let mut scan = Scan::new([Channel::Pin0, Channel::Pin1]);
        // Before the order is known: it ends what was learnt so far.
        let seen: Vec<_> = [9, 0, 9, 0, 1, 0, 9, 0, 1]
            .map(|channel| scan.push(Data { channel, counts: i32::from(channel) }))
            .to_vec();
        let learnt = [(None, 1); 5];
        assert_eq!(seen[..5], learnt);
        assert_eq!(seen[5..], [(None, 0), (None, 2), (None, 0), (Some([0, 1]), 0)]);
    }
}
