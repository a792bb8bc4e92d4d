//! Is a heap of triangles a closed surface?

use alloc::vec;
use alloc::vec::Vec;
use core::cmp::Ordering;

use fingertip_wrench::Real;
use nalgebra::Vector3;
use thiserror::Error;

use crate::numeric::vectors::is_finite;

/// Why a mesh cannot be used.
///
/// ```
/// use fingertip_surfaces::{Mesh, MeshError};
///
/// // One of the four faces is missing.
/// let obj = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
/// let refused = Mesh::<f64>::from_obj(obj, 0.001).unwrap_err();
/// assert_eq!(refused, MeshError::BadEdges { open: 3, inconsistent: 0 });
/// let told = "the mesh has 3 open edges and 0 whose triangles face opposite ways";
/// assert_eq!(refused.to_string(), told);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} of the mesh is not finite")]
    NotFinite {
        /// Its index.
        vertex: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} of the mesh names a vertex that does not exist")]
    NoSuchVertex {
        /// Its index.
        triangle: usize,
    },
    /// The surface is not closed, or parts of it face the wrong way.
    #[error("the mesh has {open} open edges and {inconsistent} whose triangles face opposite ways")]
    BadEdges {
        /// Edges with too few triangles.
        open: usize,
        /// Edges between triangles of which one faces inward.
        inconsistent: usize,
    },
    /// There are no triangles, or they enclose no volume.
    #[error("the mesh encloses no volume")]
    NoVolume,
    /// More vertices or triangles than 32-bit indices can name.
    #[error("the mesh is too large: more than 2³² vertices or triangles, or a file of more than 512 MiB")]
    TooLarge,
    /// A line of a text file, or a part of a binary one, cannot be understood.
    #[error("line or record {line} of the mesh file is malformed")]
    Malformed {
        /// Counted from 1.
        line: usize,
    },
    /// What a file's unit is in metres is NaN, infinite, zero or negative.
    #[error(
        "the unit of the mesh file must be a positive, finite number of metres: 0.001 for a file in millimetres"
    )]
    BadUnit,
    /// The file is not UTF-8 text.
    #[error("the mesh file is not text")]
    NotText,
    /// The file cannot be read.
    #[cfg(feature = "std")]
    #[error("the mesh file cannot be read: {0}")]
    Unreadable(std::io::ErrorKind),
}

/// A closed mesh, moved to the origin and scaled to about 1.
pub(super) struct Parts<T: Real> {
    pub(super) centre: Vector3<T>,
    pub(super) scale: T,
    pub(super) vertices: Vec<Vector3<T>>,
    pub(super) triangles: Vec<[u32; 3]>,
}

fn order<T: Real>(a: &Vector3<T>, b: &Vector3<T>) -> Ordering {
    a.iter()
        .zip(b.iter())
        .map(|(x, y)| x.partial_cmp(y).unwrap_or(Ordering::Equal))
        .find(|o| *o != Ordering::Equal)
        .unwrap_or(Ordering::Equal)
}

/// The vertices without repetition, and the new index of each.
fn merge<T: Real>(vertices: &[Vector3<T>]) -> Result<(Vec<Vector3<T>>, Vec<u32>), MeshError> {
    let mut by_place: Vec<usize> = (0..vertices.len()).collect();
    let at = |k: usize| vertices.get(k).copied().unwrap_or_else(Vector3::zeros);
    by_place.sort_unstable_by(|a, b| order(&at(*a), &at(*b)));
    let mut merged: Vec<Vector3<T>> = Vec::with_capacity(vertices.len());
    let mut renamed = vec![0_u32; vertices.len()];
    for k in by_place {
        let vertex = at(k);
        if merged.last().is_none_or(|last| order(last, &vertex) != Ordering::Equal) {
            merged.push(vertex);
        }
        let name = u32::try_from(merged.len() - 1).map_err(|_| MeshError::TooLarge)?;
        if let Some(slot) = renamed.get_mut(k) {
            *slot = name;
        }
    }
    Ok((merged, renamed))
}

fn check_edges(triangles: &[[u32; 3]]) -> Result<(), MeshError> {
    let mut edges: Vec<(u32, u32, bool)> = triangles
        .iter()
        .flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)])
        .map(|(a, b)| (a.min(b), a.max(b), a < b))
        .collect();
    edges.sort_unstable();
    let (mut open, mut inconsistent) = (0, 0);
    for group in edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        let forward = group.iter().filter(|edge| edge.2).count();
        if group.len() % 2 == 1 {
            open += 1;
        } else if forward * 2 != group.len() {
            inconsistent += 1;
        }
    }
    if open + inconsistent > 0 { Err(MeshError::BadEdges { open, inconsistent }) } else { Ok(()) }
}

pub(super) fn check<T: Real>(vertices: &[Vector3<T>], triangles: &[[u32; 3]]) -> Result<Parts<T>, MeshError> {
    if let Some(vertex) = vertices.iter().position(|v| !is_finite(v)) {
        return Err(MeshError::NotFinite { vertex });
    }
    let exists = |k: &u32| (*k as usize) < vertices.len();
    if let Some(triangle) = triangles.iter().position(|t| !t.iter().all(exists)) {
        return Err(MeshError::NoSuchVertex { triangle });
    }
    if u32::try_from(triangles.len()).is_err() {
        return Err(MeshError::TooLarge);
    }
    let (merged, renamed) = merge(vertices)?;
    let name = |k: &u32| renamed.get(*k as usize).copied().unwrap_or(0);
    let mut kept: Vec<[u32; 3]> = triangles
        .iter()
        .map(|[a, b, c]| [name(a), name(b), name(c)])
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    check_edges(&kept)?;
    let (mut low, mut high) = match merged.first() {
        Some(first) if !kept.is_empty() => (*first, *first),
        _ => return Err(MeshError::NoVolume),
    };
    for vertex in &merged {
        low = low.inf(vertex);
        high = high.sup(vertex);
    }
    let half = T::literal(0.5);
    let centre = low * half + high * half;
    let extent = ((high - low) * half).amax();
    if !(extent >= T::LEAST_NORMAL && extent <= T::one() / T::LEAST_NORMAL) {
        return Err(MeshError::NoVolume);
    }
    let scale = extent.normalising_factor();
    let vertices: Vec<Vector3<T>> = merged.iter().map(|v| (v - centre) * scale).collect();
    // In double precision whatever the type: a sheet of triangles and the same turned over, which sum up to nothing, leave
    // rounding of some hundred epsilons.
    let at = |k: &u32| vertices.get(*k as usize).map_or_else(Vector3::zeros, |v| v.map(Real::to_f64));
    let six_volumes = kept.iter().fold(0.0, |sum, [a, b, c]| sum + at(a).dot(&at(b).cross(&at(c))));
    if !(six_volumes.abs() > T::EPSILON.to_f64().max(256.0 * f64::EPSILON)) {
        return Err(MeshError::NoVolume);
    }
    if six_volumes < 0.0 {
        for triangle in &mut kept {
            triangle.swap(1, 2);
        }
    }
    Ok(Parts { centre, scale, vertices, triangles: kept })
}
