//! How a tree over triangles divides them: the surface area heuristic (MacDonald & Booth 1990; in
//! bins, Wald 2007).

use core::cmp::Ordering;
use core::ops::Range;

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::packet::LANES;

const BINS: usize = 16;

/// A box along the axes.
#[derive(Clone, Copy)]
pub(super) struct Bounds<T: Real> {
    pub(super) low: Vector3<T>,
    pub(super) high: Vector3<T>,
}

impl<T: Real> Bounds<T> {
    fn empty() -> Self {
        Self { low: Vector3::repeat(T::GREATEST), high: Vector3::repeat(-T::GREATEST) }
    }

    fn with(self, other: &Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    fn middle(&self) -> Vector3<T> {
        (self.low + self.high) * T::literal(0.5)
    }

    fn area(&self) -> T {
        let e = self.high - self.low;
        if e.x < T::zero() { T::zero() } else { e.x * e.y + e.y * e.z + e.z * e.x }
    }
}

/// A triangle to be placed in the tree.
#[derive(Clone, Copy)]
pub(super) struct Item<T: Real> {
    bounds: Bounds<T>,
    middle: Vector3<T>,
    pub(super) triangle: u32,
}

impl<T: Real> Item<T> {
    pub(super) fn new([a, b, c]: [Vector3<T>; 3], triangle: u32) -> Self {
        let bounds = Bounds { low: a.inf(&b).inf(&c), high: a.sup(&b).sup(&c) };
        Self { bounds, middle: bounds.middle(), triangle }
    }
}

/// Triangles next to each other in the order of the tree, and the box around them.
#[derive(Clone, Copy)]
pub(super) struct Group<T: Real> {
    pub(super) first: usize,
    pub(super) count: usize,
    pub(super) bounds: Bounds<T>,
}

impl<T: Real> Group<T> {
    pub(super) fn of(items: &[Item<T>], first: usize) -> Self {
        let bounds = items.iter().fold(Bounds::empty(), |sum, item| sum.with(&item.bounds));
        Self { first, count: items.len(), bounds }
    }

    /// What a line that meets its box must test, times how likely that is.
    pub(super) fn cost(&self) -> T {
        self.bounds.area() * packets::<T>(self.count)
    }

    /// `true` if it fits in one packet.
    pub(super) fn is_leaf(&self) -> bool {
        self.count <= LANES
    }

    /// Two groups of it, its items sorted accordingly; by halves unless `careful`.
    pub(super) fn split(&self, items: &mut [Item<T>], careful: bool) -> Option<[Self; 2]> {
        let items = items.get_mut(self.first..self.first + self.count)?;
        let left = divide(items, careful).clamp(1, self.count.checked_sub(1)?);
        let (a, b) = items.split_at(left);
        Some([Self::of(a, self.first), Self::of(b, self.first + left)])
    }
}

/// Packets that so many triangles fill: what a line that meets their box must test.
fn packets<T: Real>(count: usize) -> T {
    T::literal(count.div_ceil(LANES) as f64)
}

/// How many items go left, once sorted into bins by the surface area heuristic, or into halves
/// where that finds nothing.
fn divide<T: Real>(items: &mut [Item<T>], careful: bool) -> usize {
    let mut middles = Bounds::empty();
    for item in items.iter() {
        middles = middles.with(&Bounds { low: item.middle, high: item.middle });
    }
    let extent = middles.high - middles.low;
    let mut best: Option<(T, usize, usize)> = None;
    if careful {
        for axis in 0..3 {
            if let Some((cost, cut)) = cheapest_cut(items, axis, middles.low[axis], extent[axis])
                && best.is_none_or(|(least, ..)| cost < least)
            {
                best = Some((cost, axis, cut));
            }
        }
    }
    if let Some((_, axis, cut)) = best {
        let goes_right = |item: &Item<T>| bin(item, axis, middles.low[axis], extent[axis]) >= cut;
        items.sort_unstable_by_key(goes_right);
        return items.partition_point(|item| !goes_right(item));
    }
    let axis = extent.imax();
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| {
        a.middle[axis].partial_cmp(&b.middle[axis]).unwrap_or(Ordering::Equal)
    });
    half
}

fn bin<T: Real>(item: &Item<T>, axis: usize, low: T, width: T) -> usize {
    let place = ((item.middle[axis] - low) / width * T::literal(BINS as f64)).to_f64();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let place = place as usize;
    place.min(BINS - 1)
}

/// The cost of the best cut between two bins, and the first bin beyond it.
fn cheapest_cut<T: Real>(items: &[Item<T>], axis: usize, low: T, width: T) -> Option<(T, usize)> {
    if !(width > T::zero()) {
        return None;
    }
    let mut bins = [(Bounds::empty(), 0_usize); BINS];
    for item in items {
        if let Some((bounds, count)) = bins.get_mut(bin(item, axis, low, width)) {
            *bounds = bounds.with(&item.bounds);
            *count += 1;
        }
    }
    let cost = |range: Range<usize>| {
        let (bounds, count) = bins
            .get(range)
            .unwrap_or(&[])
            .iter()
            .fold((Bounds::empty(), 0), |(all, sum), (bounds, count)| (all.with(bounds), sum + count));
        (count > 0).then(|| bounds.area() * packets::<T>(count))
    };
    let mut best: Option<(T, usize)> = None;
    for cut in 1..BINS {
        if let (Some(left), Some(right)) = (cost(0..cut), cost(cut..BINS))
            && best.is_none_or(|(least, _)| left + right < least)
        {
            best = Some((left + right, cut));
        }
    }
    best
}
