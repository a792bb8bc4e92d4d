//! A tree of boxes over the triangles.

use alloc::vec::Vec;

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::crossing::Shear;
use super::fetch::fetch;
use super::list::List;
use super::node::{Grid, LEAF, Node, WIDTH};
use super::packet::{LANES, Packet};
use super::probe::Probe;
use super::split::{Group, Item};

/// Levels of nodes in any tree: enough for 2³² triangles by halves.
pub(super) const MOST_LEVELS: usize = 14;
/// Lists are cleared for every line: they are short where that is done word by word.
const IS_WIDE: bool = cfg!(target_pointer_width = "64");
/// Nodes on a line's list of those to be looked at: as long as there are no more, they are looked at in the
/// order in which they were found, level by level.
const MANY_OPEN: usize = if IS_WIDE { 128 } else { 16 };
/// Then the last comes first, so that one node of a level is exchanged for its children at a time.
const MOST_OPEN: usize = MANY_OPEN + WIDTH + (WIDTH - 1) * MOST_LEVELS + WIDTH;
/// Packets that are collected before they are looked at.
const MOST_LEAVES: usize = if IS_WIDE { 64 } else { 24 };
pub(super) const ROOT: u32 = 0;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bvh<T: Real> {
    /// The first is the root. Children of a node follow one another.
    nodes: Vec<Node>,
    grid: Grid,
    packets: Vec<Packet<T>>,
    /// Index of each packet's first triangle; the others follow. One more for the end of the last.
    firsts: Vec<u32>,
}

fn index(k: usize) -> u32 {
    u32::try_from(k).unwrap_or(u32::MAX)
}

/// Levels of nodes over so many triangles if each has equally many on each side.
fn levels_by_halves(mut count: usize) -> usize {
    let mut levels = 1;
    while count > WIDTH * LANES {
        count = count.div_ceil(WIDTH);
        levels += 1;
    }
    levels
}

/// Up to eight groups of one: the costliest is split as long as there is room.
fn children<T: Real>(group: Group<T>, items: &mut [Item<T>], careful: bool) -> Vec<Group<T>> {
    let mut groups = alloc::vec![group];
    while groups.len() < WIDTH {
        let weight = |group: &Group<T>| if careful { group.cost() } else { T::literal(group.count as f64) };
        let widest = groups
            .iter()
            .enumerate()
            .filter(|(_, group)| !group.is_leaf())
            .max_by(|(_, a), (_, b)| weight(a).partial_cmp(&weight(b)).unwrap_or(core::cmp::Ordering::Equal))
            .map(|(k, _)| k);
        let Some(k) = widest else { break };
        let Some(halves) = groups.get(k).and_then(|group| group.split(items, careful)) else { break };
        groups.splice(k..=k, halves);
    }
    groups
}

impl<T: Real> Bvh<T> {
    /// The tree, and the order in which it wants the triangles.
    pub(super) fn build(vertices: &[Vector3<T>], triangles: &[[u32; 3]]) -> (Self, Vec<u32>) {
        let at = |k: u32| vertices.get(k as usize).copied().unwrap_or_else(Vector3::zeros);
        let corners = |triangle: &[u32; 3]| triangle.map(at);
        let mut items: Vec<Item<T>> =
            (0_u32..).zip(triangles).map(|(k, triangle)| Item::new(corners(triangle), k)).collect();
        let all = Group::of(&items, 0);
        let grid = Grid::around(&all.bounds);
        let mut tree =
            Self { nodes: alloc::vec![Node::EMPTY], grid, packets: Vec::new(), firsts: Vec::new() };
        let mut order = Vec::with_capacity(items.len());
        // Depth first, so that what is near in space is near in memory.
        let mut open = alloc::vec![(ROOT as usize, all, 0_usize)];
        while let Some((k, group, level)) = open.pop() {
            let mut groups = children(group, &mut items, level + levels_by_halves(group.count) < MOST_LEVELS);
            groups.sort_by_key(Group::is_leaf);
            let inner = groups.iter().filter(|group| !group.is_leaf()).count();
            let mut node = Node::around(&group.bounds, grid);
            node.node = index(tree.nodes.len());
            node.packet = index(tree.packets.len()).wrapping_sub(index(inner));
            node.nodes = u8::MAX.checked_shr(index(WIDTH - inner.min(WIDTH))).unwrap_or(0);
            for (lane, group) in groups.iter().enumerate() {
                node.put(lane, &group.bounds, grid);
            }
            for group in groups.iter().skip(inner) {
                let in_group = items.get(group.first..group.first + group.count).unwrap_or(&[]);
                let all = in_group.iter().filter_map(|item| triangles.get(item.triangle as usize));
                tree.packets.push(Packet::new(all.map(corners)));
                tree.firsts.push(index(order.len()));
                order.extend(in_group.iter().map(|item| item.triangle));
            }
            let first = tree.nodes.len();
            tree.nodes.resize(first + inner, Node::EMPTY);
            let inner = groups.iter().enumerate().take(inner);
            open.extend(inner.rev().map(|(lane, group)| (first + lane, *group, level + 1)));
            if let Some(slot) = tree.nodes.get_mut(k) {
                *slot = node;
            }
        }
        tree.firsts.push(index(order.len()));
        (tree, order)
    }

    /// Calls `visit` for every triangle that the line crosses, with the position along the line and the
    /// triangle's normal.
    #[inline]
    pub(super) fn visit_line(
        &self,
        start: &Vector3<T>,
        direction: &Vector3<T>,
        mut visit: impl FnMut(T, &Vector3<T>),
    ) {
        let Some(shear) = Shear::new(start, direction) else { return };
        let probe = Probe::new(self.grid, start, direction);
        let mut open = List::<MOST_OPEN>::EMPTY;
        let mut leaves = List::<MOST_LEAVES>::EMPTY;
        let (mut open_count, mut leaf_count) = (open.add(0, ROOT, 1), 0);
        // In the order in which they were found, a node is known long before its turn.
        let mut next = 0;
        while next < open_count {
            let node = open.get(next).and_then(|k| self.nodes.get(k)).unwrap_or(&Node::EMPTY);
            next += 1;
            let crossed = probe.may_cross(node);
            open_count = open.add(open_count, node.node, crossed & node.nodes);
            leaf_count = leaves.add(leaf_count, node.packet, crossed & !node.nodes);
            // Those found last are on their way before it is their turn: seldom more than two at once.
            for back in 1..=2 {
                if let Some(node) = open.get(open_count.saturating_sub(back)).and_then(|k| self.nodes.get(k))
                {
                    fetch(node);
                }
            }
            if open_count > MANY_OPEN {
                // The last is next, in the place of this.
                next -= 1;
                open_count -= 1;
                open.repeat(open_count, next);
            }
            if leaf_count > MOST_LEAVES - WIDTH || next >= open_count {
                // What is not in the cache is waited for once, not packet by packet.
                for packet in (0..leaf_count).filter_map(|k| self.packets.get(leaves.get(k)?)) {
                    packet.fetch();
                }
                for packet in (0..leaf_count).filter_map(|k| self.packets.get(leaves.get(k)?)) {
                    packet.visit_line(&shear, &mut visit);
                }
                leaf_count = 0;
            }
        }
    }

    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    pub(super) fn packet_count(&self) -> usize {
        self.packets.len()
    }

    #[inline]
    pub(super) fn triangles_of(&self, packet: usize) -> core::ops::Range<usize> {
        match self.firsts.get(packet..packet + 2) {
            Some([first, next]) => *first as usize..*next as usize,
            _ => 0..0,
        }
    }

    /// Calls `visit` for the triangles that may be nearer than the least distance that it has
    /// returned so far; `distance` is that of a point from what is asked about.
    pub(super) fn visit_nearest(
        &self,
        distance: impl Fn(&Vector3<T>) -> T,
        mut visit: impl FnMut(usize) -> T,
    ) {
        let mut least = T::GREATEST;
        let mut stack = [(ROOT, -T::GREATEST); WIDTH * MOST_LEVELS];
        let mut depth = 1_usize;
        while depth > 0 {
            depth -= 1;
            let Some(&(child, at_least)) = stack.get(depth) else { return };
            if at_least > least {
                continue;
            }
            if child & LEAF != 0 {
                for triangle in self.triangles_of((child ^ LEAF) as usize) {
                    least = least.min(visit(triangle));
                }
                continue;
            }
            let Some(node) = self.nodes.get(child as usize) else { continue };
            let first = depth;
            for (child, centre, radius) in node.balls(self.grid) {
                let bound = distance(&centre) - radius;
                if bound <= least
                    && let Some(slot) = stack.get_mut(depth)
                {
                    *slot = (child, bound);
                    depth += 1;
                }
            }
            // The nearest on top. At most four: each sinks to its place, and nothing is asked of the order.
            for end in first + 1..depth {
                for place in (first + 1..=end).rev() {
                    if let Some([below, above]) = stack.get_mut(place - 1..=place)
                        && above.1 > below.1
                    {
                        core::mem::swap(below, above);
                    }
                }
            }
        }
    }
}
