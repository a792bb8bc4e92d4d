//! A cube of triangles.

use alloc::vec::Vec;

use fingertip_wrench::Real;
use nalgebra::Vector3;

/// A cube about the origin, of edges twice as long as `half`, along the axes: its eight vertices, and twelve triangles
/// that face outward.
#[must_use]
pub fn cube_of_triangles<T: Real>(half: T) -> (Vec<Vector3<T>>, Vec<[u32; 3]>) {
    let vertex = |k: u8| Vector3::from_fn(|i, _| if k >> i & 1 == 1 { half } else { -half });
    let triangles = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    ((0..8).map(vertex).collect(), triangles.to_vec())
}
