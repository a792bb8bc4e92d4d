//! Which vertices are neighbours.

use alloc::vec::Vec;

/// The neighbours of every vertex, one list after the other.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fans {
    /// Where each vertex's list begins; one more for the end of the last.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
}

impl Fans {
    /// In a closed mesh every edge runs both ways, so each triangle names one neighbour of each of
    /// its corners.
    pub(super) fn new(vertex_count: usize, triangles: &[[u32; 3]]) -> Self {
        let mut edges: Vec<(u32, u32)> =
            triangles.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)]).collect();
        edges.sort_unstable();
        edges.dedup();
        let mut starts = Vec::with_capacity(vertex_count + 1);
        let mut at = 0;
        for vertex in 0..=vertex_count {
            while edges.get(at).is_some_and(|edge| (edge.0 as usize) < vertex) {
                at += 1;
            }
            starts.push(u32::try_from(at).unwrap_or(u32::MAX));
        }
        Self { starts, neighbours: edges.into_iter().map(|edge| edge.1).collect() }
    }

    /// Every vertex with its neighbours.
    pub(super) fn iter(&self) -> impl Iterator<Item = (u32, &[u32])> + '_ {
        self.starts.iter().zip(self.starts.iter().skip(1)).zip(0..).filter_map(|((from, to), vertex)| {
            self.neighbours.get(*from as usize..*to as usize).map(|neighbours| (vertex, neighbours))
        })
    }
}
