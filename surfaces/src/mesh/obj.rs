//! Wavefront OBJ files.

use alloc::vec::Vec;

use fingertip_wrench::Real;

use super::stl::three;
use super::{MeshError, Parts};

pub(super) fn read<T: Real>(text: &str, metres_per_unit: T) -> Result<Parts<T>, MeshError> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (k, line) in text.lines().enumerate() {
        let bad = MeshError::Malformed { line: k + 1 };
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => vertices.push(three(&mut words, metres_per_unit).ok_or(bad)?),
            Some("f") => {
                let mut corners = words.map(|word| index(word, vertices.len()));
                let mut next = || corners.next().map(|corner| corner.ok_or(bad));
                let first = next().ok_or(bad)??;
                let mut last = next().ok_or(bad)??;
                let mut corner = next().ok_or(bad)??;
                loop {
                    triangles.push([first, last, corner]);
                    last = corner;
                    corner = match next() {
                        Some(corner) => corner?,
                        None => break,
                    };
                }
            }
            _ => {}
        }
    }
    Ok((vertices, triangles))
}

/// `7`, `7/1`, `7/1/3`, `7//3`; counted from 1, or backwards from the last vertex if negative.
fn index(word: &str, count: usize) -> Option<u32> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let index = if number < 0 { i64::try_from(count).ok()? + number } else { number - 1 };
    u32::try_from(index).ok()
}
