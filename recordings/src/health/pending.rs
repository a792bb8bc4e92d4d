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
