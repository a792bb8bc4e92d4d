//! STL files.

use alloc::vec::Vec;

use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::MeshError;

const HEADER: usize = 84;
const RECORD: usize = 50;

/// The corners of all triangles, three each. The normals in the file are not used.
pub(super) fn read<T: Real>(bytes: &[u8], metres_per_unit: T) -> Result<Vec<Vector3<T>>, MeshError> {
    // A binary file may begin with `solid` too; its length tells.
    let count = bytes.get(80..HEADER).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    let binary = count.is_some_and(|n| bytes.len() as u64 == HEADER as u64 + u64::from(n) * RECORD as u64);
    if binary { read_binary(bytes, metres_per_unit) } else { read_text(bytes, metres_per_unit) }
}

fn read_binary<T: Real>(bytes: &[u8], unit: T) -> Result<Vec<Vector3<T>>, MeshError> {
    let records = bytes.get(HEADER..).unwrap_or(&[]);
    let mut corners = Vec::with_capacity(records.len() / RECORD * 3);
    for (k, record) in records.chunks_exact(RECORD).enumerate() {
        for corner in record.get(12..48).unwrap_or(&[]).chunks_exact(12) {
            let mut at = [T::zero(); 3];
            for (x, four) in at.iter_mut().zip(corner.chunks_exact(4)) {
                let four = four.try_into().map_err(|_| MeshError::Malformed { line: k + 1 })?;
                *x = T::literal(f64::from(f32::from_le_bytes(four))) * unit;
            }
            corners.push(Vector3::from(at));
        }
    }
    Ok(corners)
}

fn read_text<T: Real>(bytes: &[u8], unit: T) -> Result<Vec<Vector3<T>>, MeshError> {
    let text = core::str::from_utf8(bytes).map_err(|_| MeshError::NotText)?;
    let mut corners = Vec::new();
    let mut in_loop = 0_usize;
    let mut seen_solid = false;
    for (k, line) in text.lines().enumerate() {
        let bad = MeshError::Malformed { line: k + 1 };
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("vertex") if seen_solid => {
                corners.push(three(&mut words, unit).ok_or(bad)?);
                in_loop += 1;
            }
            Some("endloop") if in_loop == 3 => in_loop = 0,
            Some("endloop") => return Err(bad),
            Some("solid") => seen_solid = true,
            Some("facet" | "outer" | "endfacet" | "endsolid") if seen_solid => {}
            None => {}
            Some(_) => return Err(bad),
        }
    }
    if in_loop == 0 { Ok(corners) } else { Err(MeshError::Malformed { line: text.lines().count() }) }
}

/// Three numbers, the rest of a line's words.
pub(super) fn three<'a, T: Real>(words: &mut impl Iterator<Item = &'a str>, unit: T) -> Option<Vector3<T>> {
    let mut next = || words.next()?.parse().ok().map(|x: f64| T::literal(x) * unit);
    Some(Vector3::new(next()?, next()?, next()?))
}
