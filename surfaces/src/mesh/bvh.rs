//! A tree of boxes over the triangles.

use alloc::vec;
use alloc::vec::Vec;

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::crossing::Shear;

/// Fewer triangles than this are not split.
const LEAF: usize = 3;
const BINS: usize = 12;
/// Beyond this depth the triangles are halved instead, so that the depth is bounded by
/// `32 + log₂ 2³²`.
const CAREFUL_DEPTH: u32 = 32;
/// More than the depth of any tree.
pub(super) const STACK: usize = 72;

/// A box with either two children, next to each other, or some triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Node<T: Real> {
    pub(super) centre: Vector3<T>,
    pub(super) half: Vector3<T>,
    /// First triangle of a leaf, or first child.
    pub(super) first: u32,
    /// Triangles of a leaf; zero for an inner node.
    pub(super) count: u32,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bvh<T: Real> {
    nodes: Vec<Node<T>>,
}

#[derive(Clone, Copy)]
struct Bounds<T: Real> {
    low: Vector3<T>,
    high: Vector3<T>,
}

impl<T: Real> Bounds<T> {
    fn empty() -> Self {
        Self { low: Vector3::repeat(T::GREATEST), high: Vector3::repeat(-T::GREATEST) }
    }

    fn with(self, other: &Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    fn area(&self) -> T {
        let e = self.high - self.low;
        if e.x < T::zero() { T::zero() } else { e.x * e.y + e.y * e.z + e.z * e.x }
    }

    fn node(&self, first: u32, count: u32) -> Node<T> {
        let half = T::literal(0.5);
        // The mesh has size 1 to 2, and lines start within that: this covers all rounding of the
        // tests on the box.
        let slack = Vector3::repeat(T::EPSILON * T::literal(32.0));
        Node {
            centre: (self.low + self.high) * half,
            half: (self.high - self.low) * half + slack,
            first,
            count,
        }
    }
}

struct Item<T: Real> {
    bounds: Bounds<T>,
    middle: Vector3<T>,
    triangle: u32,
}

/// Where to split: how many items go left once sorted into bins by the surface area heuristic, or by
/// halves where that finds nothing.
fn split<T: Real>(items: &mut [Item<T>], careful: bool) -> usize {
    let mut middles = Bounds::empty();
    for item in items.iter() {
        middles = middles.with(&Bounds { low: item.middle, high: item.middle });
    }
    let extent = middles.high - middles.low;
    let axis = extent.imax();
    let (low, width) = (middles.low[axis], extent[axis]);
    let half = items.len() / 2;
    if careful && width > T::zero() {
        let bins = T::literal(BINS as f64);
        let bin_of = |item: &Item<T>| {
            let place = ((item.middle[axis] - low) / width * bins).to_f64();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let place = place as usize;
            place.min(BINS - 1)
        };
        let mut bounds = [Bounds::empty(); BINS];
        let mut counts = [0_usize; BINS];
        for item in items.iter() {
            let bin = bin_of(item);
            if let (Some(b), Some(n)) = (bounds.get_mut(bin), counts.get_mut(bin)) {
                *b = b.with(&item.bounds);
                *n += 1;
            }
        }
        let cost = |range: core::ops::Range<usize>| {
            let all = bounds.get(range.clone()).unwrap_or(&[]);
            let total = all.iter().fold(Bounds::empty(), |sum, b| sum.with(b));
            let count: usize = counts.get(range).unwrap_or(&[]).iter().sum();
            (total.area() * T::literal(count as f64), count)
        };
        let mut best: Option<(T, usize)> = None;
        for cut in 1..BINS {
            let ((left, n), (right, m)) = (cost(0..cut), cost(cut..BINS));
            if n > 0 && m > 0 && best.is_none_or(|(least, _)| left + right < least) {
                best = Some((left + right, cut));
            }
        }
        if let Some((_, cut)) = best {
            items.sort_unstable_by_key(|item| bin_of(item) >= cut);
            return items.iter().filter(|item| bin_of(item) < cut).count();
        }
    }
    items.select_nth_unstable_by(half, |a, b| {
        a.middle[axis].partial_cmp(&b.middle[axis]).unwrap_or(core::cmp::Ordering::Equal)
    });
    half
}

impl<T: Real> Bvh<T> {
    /// The tree, and the order in which it wants the triangles.
    pub(super) fn build(vertices: &[Vector3<T>], triangles: &[[u32; 3]]) -> (Self, Vec<u32>) {
        let at = |k: &u32| vertices.get(*k as usize).copied().unwrap_or_else(Vector3::zeros);
        let mut items: Vec<Item<T>> = (0_u32..)
            .zip(triangles)
            .map(|(triangle, corners)| {
                let [a, b, c] = [at(&corners[0]), at(&corners[1]), at(&corners[2])];
                let bounds = Bounds { low: a.inf(&b).inf(&c), high: a.sup(&b).sup(&c) };
                Item { bounds, middle: (bounds.low + bounds.high) * T::literal(0.5), triangle }
            })
            .collect();
        let bounds_of =
            |items: &[Item<T>]| items.iter().fold(Bounds::empty(), |sum, item| sum.with(&item.bounds));
        let index = |k: usize| u32::try_from(k).unwrap_or(u32::MAX);
        let mut nodes = vec![bounds_of(&items).node(0, index(items.len()))];
        let mut open = vec![(0_usize, 0_u32)];
        while let Some((k, depth)) = open.pop() {
            let Some(node) = nodes.get(k).copied() else { continue };
            let (first, count) = (node.first as usize, node.count as usize);
            let Some(range) = items.get_mut(first..first + count) else { continue };
            if count <= LEAF {
                continue;
            }
            let left = split(range, depth < CAREFUL_DEPTH).clamp(1, count - 1);
            let (a, b) = range.split_at(left);
            let children = [
                bounds_of(a).node(index(first), index(left)),
                bounds_of(b).node(index(first + left), index(count - left)),
            ];
            let child = nodes.len();
            nodes.extend(children);
            if let Some(node) = nodes.get_mut(k) {
                (node.first, node.count) = (index(child), 0);
            }
            open.push((child, depth + 1));
            open.push((child + 1, depth + 1));
        }
        (Self { nodes }, items.iter().map(|item| item.triangle).collect())
    }

    #[inline]
    pub(super) fn node(&self, k: usize) -> Option<&Node<T>> {
        self.nodes.get(k)
    }

    /// Calls `visit` for every triangle in a box that the line crosses.
    #[inline]
    pub(super) fn visit_line(&self, shear: &Shear<T>, mut visit: impl FnMut(usize)) {
        let mut stack = [0_u32; STACK];
        let mut depth = 0_usize;
        let mut k = 0_usize;
        loop {
            let Some(node) = self.nodes.get(k) else { return };
            if node.count > 0 {
                for triangle in node.first..node.first + node.count {
                    visit(triangle as usize);
                }
            } else {
                let child = node.first as usize;
                let (Some(a), Some(b)) = (self.nodes.get(child), self.nodes.get(child + 1)) else { return };
                let (left, right) =
                    (shear.may_cross(&a.centre, &a.half), shear.may_cross(&b.centre, &b.half));
                if left {
                    if right && let Some(slot) = stack.get_mut(depth) {
                        *slot = node.first + 1;
                        depth += 1;
                    }
                    k = child;
                    continue;
                }
                if right {
                    k = child + 1;
                    continue;
                }
            }
            if depth == 0 {
                return;
            }
            depth -= 1;
            k = stack.get(depth).copied().unwrap_or(0) as usize;
        }
    }

    /// Calls `visit` for the triangles that may be nearer than the least distance that it has
    /// returned so far; `bound` is the distance from a ball around a box's centre.
    pub(super) fn visit_nearest(
        &self,
        distance: impl Fn(&Vector3<T>) -> T,
        mut visit: impl FnMut(usize) -> T,
    ) {
        let bound = |node: &Node<T>| distance(&node.centre) - node.half.norm_squared().root();
        let mut least = T::GREATEST;
        let mut stack = [(0_u32, -T::GREATEST); STACK];
        let mut depth = 1_usize;
        while depth > 0 {
            depth -= 1;
            let Some(&(k, at_least)) = stack.get(depth) else { return };
            if at_least > least {
                continue;
            }
            let Some(node) = self.nodes.get(k as usize) else { continue };
            if node.count > 0 {
                for triangle in node.first..node.first + node.count {
                    least = least.min(visit(triangle as usize));
                }
                continue;
            }
            let children =
                [node.first, node.first + 1].map(|k| (k, self.node(k as usize).map_or(T::GREATEST, bound)));
            let [a, b] = children;
            // The nearer one on top.
            for child in if a.1 < b.1 { [b, a] } else { [a, b] } {
                if child.1 <= least
                    && let Some(slot) = stack.get_mut(depth)
                {
                    *slot = child;
                    depth += 1;
                }
            }
        }
    }
}
