//! A tree of boxes over the triangles.

use alloc::vec::Vec;

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::crossing::Shear;
use super::node::{LEAF, Node, Probe, WIDTH};
use super::packet::{LANES, Packet};
use super::split::{Group, Item};

/// Levels of nodes in any tree: enough for 2³² triangles by halves.
const MOST_LEVELS: usize = 18;
/// Nodes that a line is tested against together.
const AT_ONCE: usize = 4;
/// Open nodes of a line, at most. They are sorted by level, and the deepest are taken first: so when
/// nodes of a level are added, none of that level is left. These are `AT_ONCE·WIDTH` at most, of which
/// `AT_ONCE` are gone before any of the next level is added.
const MOST_OPEN: usize = 256;
const _: () = assert!(MOST_OPEN >= (AT_ONCE * WIDTH - AT_ONCE) * MOST_LEVELS + AT_ONCE * WIDTH + AT_ONCE);
/// Packets that are collected before they are looked at.
const MOST_LEAVES: usize = 32;
/// Index of a node without children, and of the root.
const NOTHING: u32 = 0;
const ROOT: u32 = 1;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bvh<T: Real> {
    /// The first is nothing, the second the root.
    nodes: Vec<Node>,
    packets: Vec<Packet<T>>,
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

/// Up to four groups of one: the costliest is split as long as there is room.
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
        let mut tree = Self { nodes: alloc::vec![Node::EMPTY, Node::EMPTY], packets: Vec::new() };
        // Depth first, so that what is near in space is near in memory.
        let mut open = alloc::vec![(ROOT as usize, Group::of(&items, 0), 0_usize)];
        while let Some((k, group, level)) = open.pop() {
            let groups = children(group, &mut items, level + levels_by_halves(group.count) < MOST_LEVELS);
            let first_open = open.len();
            for (lane, group) in groups.iter().enumerate() {
                let child = if group.is_leaf() {
                    let in_group = items.get(group.first..group.first + group.count).unwrap_or(&[]);
                    let all = in_group.iter().filter_map(|item| triangles.get(item.triangle as usize));
                    tree.packets.push(Packet::new(all.map(corners), index(group.first)));
                    LEAF | index(tree.packets.len() - 1)
                } else {
                    tree.nodes.push(Node::EMPTY);
                    open.push((tree.nodes.len() - 1, *group, level + 1));
                    index(tree.nodes.len() - 1)
                };
                if let Some(node) = tree.nodes.get_mut(k) {
                    node.put(lane, &group.bounds, child);
                }
            }
            if let Some(new) = open.get_mut(first_open..) {
                new.reverse();
            }
        }
        (tree, items.iter().map(|item| item.triangle).collect())
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
        let probe = Probe::new(start, direction);
        // What is crossed cannot be foretold, so nothing branches on it: each child is written to the
        // end of its list, which then grows by one or not at all. Several nodes are tested together,
        // for the next ones are not known before. Below the root wait nodes that are nothing.
        let mut open = [NOTHING; MOST_OPEN];
        let mut leaves = [0_u32; MOST_LEAVES];
        let (mut depth, mut leaf_count) = (AT_ONCE, 0_usize);
        open[AT_ONCE - 1] = ROOT;
        while depth >= AT_ONCE {
            depth -= AT_ONCE;
            let nodes: [&Node; AT_ONCE] = core::array::from_fn(|k| {
                self.nodes.get(open[(depth + k) % MOST_OPEN] as usize).unwrap_or(&Node::EMPTY)
            });
            let crossed = nodes.map(|node| probe.may_cross(node));
            depth = depth.max(AT_ONCE - 1);
            for (node, crossed) in nodes.into_iter().zip(crossed) {
                let (inner, leaf) = (crossed & !node.leaves, crossed & node.leaves);
                for (lane, child) in node.child.into_iter().enumerate() {
                    open[depth % MOST_OPEN] = child;
                    leaves[leaf_count % MOST_LEAVES] = child;
                    depth += (inner >> lane & 1) as usize;
                    leaf_count += (leaf >> lane & 1) as usize;
                }
            }
            if leaf_count > MOST_LEAVES - AT_ONCE * WIDTH || depth < AT_ONCE {
                for k in leaves.iter().take(leaf_count) {
                    if let Some(packet) = self.packets.get(*k as usize) {
                        packet.visit_line(&shear, &mut visit);
                    }
                }
                leaf_count = 0;
            }
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
                for triangle in self.packets.get((child ^ LEAF) as usize).map_or(0..0, Packet::triangles) {
                    least = least.min(visit(triangle));
                }
                continue;
            }
            let Some(node) = self.nodes.get(child as usize) else { continue };
            let first = depth;
            for (child, centre, radius) in node.balls() {
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
