//! Which way the triangles of each part of the tree face: where a wrench may have a soft-finger contact.

use alloc::vec::Vec;
use core::ops::Range;

use fingertip_wrench::Real;
use nalgebra::Vector3;
use wide::f32x8;

use super::Mesh;
use super::bvh::{Bvh, MOST_LEVELS, ROOT};
use super::node::WIDTH;
use crate::numeric::vectors::{is_finite, largest};

/// Of each node of the tree, what its children hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Facings {
    nodes: Vec<Facing>,
    /// How many vertices the triangles before each packet use, and at the end how many there are.
    firsts: Vec<u32>,
}

/// A ball and a cone for each child. Every place of its triangles is in the ball, and their normals and those
/// of all triangles around the vertices that are first used there lie in the cone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
struct Facing {
    centre: [[f32; WIDTH]; 3],
    /// None at all where there is no child.
    radius: [f32; WIDTH],
    axis: [[f32; WIDTH]; 3],
    /// Of the cone's half angle; 1 if it is everything.
    sine: [f32; WIDTH],
    /// What rounding moves a torque by, in units of the wrench.
    rounding: [f32; WIDTH],
}

/// One of them.
struct Child {
    centre: Vector3<f32>,
    radius: f32,
    axis: Vector3<f32>,
    sine: f32,
    rounding: f32,
}

/// A wrench about the origin of the stored vertices, of which the larger part is about 1 long, eight times side by
/// side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    force: [f32x8; 3],
    torque: [f32x8; 3],
    /// `|f|`, and `|f| + |m|`.
    strength: f32x8,
    whole: f32x8,
    /// 1 if normals point along the torque that is left at a contact, −1 if against it; and whether they may do
    /// either, 1 and the other 0.
    side: f32x8,
    both: f32x8,
}

/// Half angles whose sine is greater are taken for everything: their cosine has few digits.
const WIDEST: f32 = 0.9;
/// What is rounded in one child's test, in epsilons of the wrench: a dozen roundings of numbers up to 3.
const TEST: f32 = 32.0 * f32::EPSILON;
/// What is rounded in the moment of a wrench about an edge, and three of these over an altitude.
const MOMENT: f64 = 64.0;

#[allow(clippy::cast_possible_truncation)]
fn narrow<T: Real>(v: &Vector3<T>) -> Vector3<f32> {
    v.map(|x| x.to_f64() as f32)
}

impl Facing {
    const EMPTY: Self = Self {
        centre: [[0.0; WIDTH]; 3],
        radius: [f32::NEG_INFINITY; WIDTH],
        axis: [[0.0; WIDTH]; 3],
        sine: [0.0; WIDTH],
        rounding: [0.0; WIDTH],
    };

    fn put(&mut self, lane: usize, child: &Child) {
        let rows = self.centre.iter_mut().zip(&child.centre).chain(self.axis.iter_mut().zip(&child.axis));
        let others = [
            (&mut self.radius, &child.radius),
            (&mut self.sine, &child.sine),
            (&mut self.rounding, &child.rounding),
        ];
        for (row, x) in rows.chain(others) {
            if let Some(slot) = row.get_mut(lane) {
                *slot = *x;
            }
        }
    }

    /// A bit for each child that may hold a contact.
    ///
    /// At a contact the torque that is left, `M(c) = m − c × f`, lies along the normal, to that side.
    /// Within the ball `M` is within `|f|` times its radius of what it is in the middle, and how far a torque
    /// is outside of a cone, `q cos α − p sin α` with `p` along the axis and `q` across it, changes by no more
    /// than the torque does (`docs/theory/surfaces.md#where-a-mesh-may-be-touched`).
    #[inline(always)]
    fn may_touch(&self, asked: &Asked) -> u8 {
        let row = |row: &[f32; WIDTH]| f32x8::new(*row);
        let dot = |[a, b, c]: [f32x8; 3], [x, y, z]: [f32x8; 3]| a * x + b * y + c * z;
        let [x, y, z] = self.centre.each_ref().map(row);
        let axis = self.axis.each_ref().map(row);
        let (sine, rounding) = (row(&self.sine), row(&self.rounding));
        let [fx, fy, fz] = asked.force;
        let [mx, my, mz] = asked.torque;
        let rest = [mx - (y * fz - z * fy), my - (z * fx - x * fz), mz - (x * fy - y * fx)];
        let p = dot(rest, axis);
        let q = [rest[0] - axis[0] * p, rest[1] - axis[1] * p, rest[2] - axis[2] * p];
        let along = asked.side * p + asked.both * p.abs();
        let room = along * sine + asked.strength * row(&self.radius) + asked.whole * rounding;
        let one = f32x8::splat(1.0);
        let near = (dot(q, q) * ((one - sine) * (one + sine))).simd_le(room * room.abs());
        let pressing = dot(asked.force, axis).simd_le(asked.strength * (sine + rounding));
        #[allow(clippy::cast_possible_truncation)]
        {
            (near & pressing).to_bitmask() as u8
        }
    }
}

impl Asked {
    pub(super) fn new<T: Real>(force: &Vector3<T>, torque: &Vector3<T>, side: T) -> Self {
        let unit = largest(force).max(largest(torque)).normalising_factor();
        let (force, torque) = (narrow(&(force * unit)), narrow(&(torque * unit)));
        let strength = force.norm_squared().root();
        let each = |v: &Vector3<f32>| [v.x, v.y, v.z].map(f32x8::splat);
        Self {
            force: each(&force),
            torque: each(&torque),
            strength: f32x8::splat(strength),
            whole: f32x8::splat(strength + torque.norm_squared().root()),
            side: f32x8::splat(narrow(&Vector3::repeat(side)).x),
            both: f32x8::splat(if side.is_zero() { 1.0 } else { 0.0 }),
        }
    }
}

impl Facings {
    pub(super) fn new<T: Real>(mesh: &Mesh<T>, tree: &Bvh<T>) -> Self {
        let mut used = 0;
        let mut firsts = alloc::vec![0];
        for packet in 0..tree.packet_count() {
            let triangles = mesh.triangles.get(tree.triangles_of(packet)).unwrap_or(&[]);
            used = triangles.as_flattened().iter().fold(used, |most, vertex| most.max(vertex + 1));
            firsts.push(used);
        }
        let mut facings = Self { nodes: Vec::new(), firsts };
        let facets = facets(mesh);
        // Children come after their node, and their packets follow one another.
        let mut packets = alloc::vec![0..0_usize; tree.nodes().len()];
        facings.nodes.resize(tree.nodes().len(), Facing::EMPTY);
        for (k, node) in tree.nodes().iter().enumerate().rev() {
            let mut all: Option<Range<usize>> = None;
            for (lane, child) in node.children() {
                let range = match child {
                    Ok(node) => packets.get(node as usize).cloned().unwrap_or(0..0),
                    Err(packet) => packet as usize..packet as usize + 1,
                };
                let held = facings.child(mesh, tree, &facets, &range);
                all = Some(match all {
                    Some(all) => all.start.min(range.start)..all.end.max(range.end),
                    None => range,
                });
                if let Some(facing) = facings.nodes.get_mut(k) {
                    facing.put(lane, &held);
                }
            }
            if let Some(slot) = packets.get_mut(k) {
                *slot = all.unwrap_or(0..0);
            }
        }
        facings
    }

    fn vertices_of(&self, packets: &Range<usize>) -> Range<u32> {
        let at = |k: usize| self.firsts.get(k).copied().unwrap_or(0);
        at(packets.start)..at(packets.end)
    }

    /// What so many packets hold.
    fn child<T: Real>(
        &self,
        mesh: &Mesh<T>,
        tree: &Bvh<T>,
        facets: &[Facet],
        packets: &Range<usize>,
    ) -> Child {
        let triangles =
            tree.triangles_of(packets.start).start..tree.triangles_of(packets.end.saturating_sub(1)).end;
        let around = self.vertices_of(packets).flat_map(|vertex| mesh.fans.around(vertex));
        let facets =
            || triangles.clone().chain(around.clone().map(|k| *k as usize)).filter_map(|k| facets.get(k));
        let corners = || {
            let triangles = mesh.triangles.get(triangles.clone()).unwrap_or(&[]);
            triangles.as_flattened().iter().filter_map(|k| mesh.stored(*k)).map(narrow)
        };
        let everywhere = Vector3::repeat(f32::MAX);
        let (low, high) =
            corners().fold((everywhere, -everywhere), |(low, high), v| (low.inf(&v), high.sup(&v)));
        let centre = (low + high) * 0.5;
        let radius = corners().fold(0.0, |r: f32, v| r.max((v - centre).norm_squared())).root();
        let axis = facets().fold(Vector3::zeros(), |sum, facet| sum + facet.normal);
        let axis = axis / axis.norm_squared().root();
        let (mut chord, mut rounding) = (0.0_f32, 0.0_f32);
        for facet in facets() {
            chord = chord.max((facet.normal - axis).norm_squared());
            rounding = rounding.max(facet.rounding);
        }
        // The sine from the chord, since a small angle is not seen in its cosine.
        let sine = (chord * (4.0 - chord).max(0.0)).root() * 0.5 * 1.00001;
        let narrow = chord < 2.0 && sine < WIDEST && is_finite(&axis);
        Child {
            centre,
            radius: radius * 1.00001,
            axis: if narrow { axis } else { Vector3::zeros() },
            sine: if narrow { sine } else { 1.0 },
            rounding: rounding + TEST,
        }
    }

    /// Calls `visit` with triangles, and with vertices, that may hold a contact, some at a time.
    #[inline]
    pub(super) fn visit<T: Real>(
        &self,
        tree: &Bvh<T>,
        asked: &Asked,
        mut visit: impl FnMut(Range<usize>, Range<u32>),
    ) {
        let mut stack = [ROOT; WIDTH * MOST_LEVELS];
        let mut depth = 1_usize;
        while depth > 0 {
            depth -= 1;
            let Some(k) = stack.get(depth).map(|k| *k as usize) else { return };
            let (Some(node), Some(facing)) = (tree.nodes().get(k), self.nodes.get(k)) else { continue };
            let touched = facing.may_touch(asked);
            let mut leaves = touched & !node.nodes;
            while leaves != 0 {
                let packet = node.packet.wrapping_add(leaves.trailing_zeros()) as usize;
                leaves &= leaves - 1;
                visit(tree.triangles_of(packet), self.vertices_of(&(packet..packet + 1)));
            }
            // The first on top, so that triangles come in their order.
            let mut inner = touched & node.nodes;
            while inner != 0 {
                let lane = u8::BITS - 1 - inner.leading_zeros();
                inner &= !(1 << lane);
                if let Some(slot) = stack.get_mut(depth) {
                    *slot = node.node.wrapping_add(lane);
                    depth += 1;
                }
            }
        }
    }
}

/// What a triangle adds to the cones that it is in.
struct Facet {
    normal: Vector3<f32>,
    rounding: f32,
}

#[allow(clippy::cast_possible_truncation)]
fn facets<T: Real>(mesh: &Mesh<T>) -> Vec<Facet> {
    let facet = |k: usize| {
        let normal = mesh.normal_of(k);
        let altitude = mesh.corners(k).map_or(0.0, |[a, b, c]| {
            let area = (b - a).cross(&(c - a)).norm_squared().root();
            let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
            (area / longest.root()).to_f64()
        });
        // Of a triangle without area nothing is known.
        let rounding = (MOMENT * T::EPSILON.to_f64() / altitude).min(1e3);
        Facet { normal: narrow(&normal), rounding: rounding as f32 }
    };
    (0..mesh.triangles.len()).map(facet).collect()
}
