//! Which triangles meet at a vertex.

use alloc::vec::Vec;

/// The triangles around every vertex, one list after the other.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fans {
    /// Where each vertex's list begins; one more for the end of the last.
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Fans {
    pub(super) fn new(vertex_count: usize, triangles: &[[u32; 3]]) -> Self {
        let mut corners: Vec<(u32, u32)> =
            (0..).zip(triangles).flat_map(|(k, corners)| corners.map(|vertex| (vertex, k))).collect();
        corners.sort_unstable();
        let mut starts = Vec::with_capacity(vertex_count + 1);
        let mut at = 0;
        for vertex in 0..=vertex_count {
            while corners.get(at).is_some_and(|corner| (corner.0 as usize) < vertex) {
                at += 1;
            }
            starts.push(u32::try_from(at).unwrap_or(u32::MAX));
        }
        Self { starts, triangles: corners.into_iter().map(|corner| corner.1).collect() }
    }

    /// The triangles around a vertex.
    #[inline]
    pub(super) fn around(&self, vertex: u32) -> &[u32] {
        match self.starts.get(vertex as usize..vertex as usize + 2) {
            Some([from, to]) => self.triangles.get(*from as usize..*to as usize).unwrap_or(&[]),
            _ => &[],
        }
    }
}
