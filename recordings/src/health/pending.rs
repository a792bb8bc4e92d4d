//! Samples that wait until there are enough to be looked at together.

/// Samples of some channels, channel by channel.
#[derive(Clone, Debug)]
pub(super) struct Pending {
    count: usize,
    /// When each came \[s\].
    times: [f64; Self::MOST],
    columns: Vec<Column>,
}

/// The readings of a channel, with the one before them.
pub(super) type Column = [f64; Pending::MOST + 1];

impl Pending {
    /// So many at most.
    pub(super) const MOST: usize = 64;

    pub(super) fn new(channels: usize) -> Self {
        Self { count: 0, times: [f64::NAN; Self::MOST], columns: vec![[f64::NAN; Self::MOST + 1]; channels] }
    }

    /// Takes one, if there is room. A channel without a reading has NaN.
    #[inline]
    pub(super) fn push(&mut self, time: f64, readings: &[f64]) {
        let Some(place) = self.times.get_mut(self.count) else { return };
        *place = time;
        self.count += 1;
        for (channel, column) in self.columns.iter_mut().enumerate() {
            if let Some(place) = column.get_mut(self.count) {
                *place = readings.get(channel).copied().unwrap_or(f64::NAN);
            }
        }
    }

    pub(super) fn times(&self) -> &[f64] {
        self.times.get(..self.count).unwrap_or_default()
    }

    /// For each channel the reading before, NaN if there is none, and the readings.
    pub(super) fn columns(&self) -> impl Iterator<Item = &[f64]> {
        self.columns.iter().map(|column| column.get(..=self.count).unwrap_or_default())
    }

    /// The readings of a channel.
    pub(super) fn readings(&self, channel: usize) -> Option<&[f64]> {
        self.columns.get(channel)?.get(1..=self.count)
    }

    pub(super) const fn is_full(&self) -> bool {
        self.count == Self::MOST
    }

    pub(super) const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Forgets all but the last one, as the one before what comes.
    pub(super) fn clear(&mut self) {
        for column in &mut self.columns {
            let last = column.get(self.count).copied();
            if let (Some(first), Some(last)) = (column.first_mut(), last) {
                *first = last;
            }
        }
        self.count = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::Pending;

    /// Bits, so that a NaN equals itself.
    fn columns(pending: &Pending) -> Vec<Vec<u64>> {
        pending.columns().map(|column| column.iter().map(|x| x.to_bits()).collect()).collect()
    }

    fn bits(columns: &[&[f64]]) -> Vec<Vec<u64>> {
        columns.iter().map(|column| column.iter().map(|x| x.to_bits()).collect()).collect()
    }

    #[test]
    fn the_last_reading_of_a_piece_comes_before_those_of_the_next() {
        let mut pending = Pending::new(2);
        assert!(pending.is_empty() && !pending.is_full());
        assert_eq!(columns(&pending), bits(&[&[f64::NAN], &[f64::NAN]]));
        pending.push(0.1, &[1.0, 10.0]);
        // A channel without a reading.
        pending.push(0.2, &[2.0]);
        assert_eq!(pending.times(), [0.1, 0.2]);
        assert_eq!(columns(&pending), bits(&[&[f64::NAN, 1.0, 2.0], &[f64::NAN, 10.0, f64::NAN]]));
        assert_eq!(pending.readings(0), Some(&[1.0, 2.0][..]));
        assert!(pending.readings(2).is_none());
        pending.clear();
        assert!(pending.is_empty() && pending.times().is_empty());
        assert_eq!(columns(&pending), bits(&[&[2.0], &[f64::NAN]]));
        pending.push(0.3, &[3.0, 30.0]);
        assert_eq!(columns(&pending), bits(&[&[2.0, 3.0], &[f64::NAN, 30.0]]));
        assert_eq!(pending.readings(1), Some(&[30.0][..]));
    }

    #[test]
    fn there_is_room_for_so_many_and_no_more() {
        let mut pending = Pending::new(1);
        for count in 0..Pending::MOST {
            assert!(!pending.is_full());
            pending.push(count as f64, &[count as f64]);
        }
        let full = columns(&pending);
        pending.push(-1.0, &[-1.0]);
        assert!(pending.is_full() && columns(&pending) == full);
        assert_eq!(pending.times().len(), Pending::MOST);
        pending.clear();
        assert_eq!(columns(&pending), bits(&[&[(Pending::MOST - 1) as f64]]));
    }
}
