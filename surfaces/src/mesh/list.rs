//! Children that a line may cross.

use super::node::WIDTH;

const SETS: usize = 1 << WIDTH;

/// For each set of lanes, given as bits: the lanes in it, in front.
static LANES_IN: [[u8; WIDTH]; SETS] = {
    let mut lanes = [[0; WIDTH]; SETS];
    let mut set = 0;
    while set < SETS {
        let (mut lane, mut count) = (0, 0);
        while lane < WIDTH {
            if set >> lane & 1 == 1 {
                lanes[set][count] = lane as u8;
                count += 1;
            }
            lane += 1;
        }
        set += 1;
    }
    lanes
};

/// How many lanes are in each set.
static COUNT_IN: [u8; SETS] = {
    let mut counts = [0; SETS];
    let mut set = 0;
    while set < SETS {
        counts[set] = set.count_ones() as u8;
        set += 1;
    }
    counts
};

/// A list to which children of a node are added, whichever they are, without a branch: it cannot be foretold
/// which a line crosses. All lanes are written to its end, and it grows by those that count.
pub(super) struct List<const MOST: usize> {
    /// An index is the sum of two: so it costs two instructions to write eight of them.
    first: [u32; MOST],
    lane: [u8; MOST],
}

impl<const MOST: usize> List<MOST> {
    pub(super) const EMPTY: Self = Self { first: [0; MOST], lane: [0; MOST] };

    #[inline(always)]
    pub(super) fn get(&self, k: usize) -> Option<usize> {
        Some(self.first.get(k)?.wrapping_add(u32::from(*self.lane.get(k)?)) as usize)
    }

    /// Writes an item to another place too.
    #[cold]
    pub(super) fn repeat(&mut self, from: usize, to: usize) {
        let (Some(first), Some(lane)) = (self.first.get(from).copied(), self.lane.get(from).copied()) else {
            return;
        };
        if let (Some(first_there), Some(lane_there)) = (self.first.get_mut(to), self.lane.get_mut(to)) {
            (*first_there, *lane_there) = (first, lane);
        }
    }

    /// Writes `first + lane` for every lane of a set to the end of so many items, and returns how many there
    /// are then. There must be room for all lanes; otherwise nothing is added.
    #[inline(always)]
    pub(super) fn add(&mut self, count: usize, first: u32, set: u8) -> usize {
        let room = count..count + WIDTH;
        let set = usize::from(set);
        if let (Some(firsts), Some(lanes)) = (self.first.get_mut(room.clone()), self.lane.get_mut(room)) {
            firsts.fill(first);
            lanes.copy_from_slice(&LANES_IN[set]);
            count + usize::from(COUNT_IN[set])
        } else {
            count
        }
    }
}
