//! Points of an object as a file of points.

use core::fmt::Write as _;

use super::ObjectPoint;

/// Points and normals as text in the format PLY 1.0 (Turk 1994), which MeshLab, CloudCompare, Blender and Open3D read: `x`,
/// `y`, `z` \[m\], `nx`, `ny`, `nz` and `spread`, the greatest standard deviation of the place \[m\].
///
/// ```
/// use fingertip_calibration::object::{ObjectPoint, to_ply};
/// use nalgebra::{Matrix3, Vector3};
///
/// let covariance = Matrix3::from_diagonal(&Vector3::new(1e-8, 4e-8, 0.0));
/// let point = ObjectPoint { point: Vector3::x(), normal: Vector3::x() * 2.0, covariance, bend: Matrix3::zeros() };
/// assert!(to_ply(&[point]).ends_with("end_header\n1 0 0 1 0 0 0.0002\n"));
/// ```
#[must_use]
pub fn to_ply(points: &[ObjectPoint]) -> String {
    let mut text =
        String::from("ply\nformat ascii 1.0\ncomment touched points of an object [m], normals outward\n");
    let _ = writeln!(text, "element vertex {}", points.len());
    for name in ["x", "y", "z", "nx", "ny", "nz", "spread"] {
        let _ = writeln!(text, "property double {name}");
    }
    text.push_str("end_header\n");
    for point in points {
        let normal = point.normal / point.normal.norm();
        let spread = point.covariance.symmetric_eigenvalues().max().max(0.0).sqrt();
        for number in point.point.iter().chain(&normal) {
            let _ = write!(text, "{} ", rounded(*number));
        }
        let _ = writeln!(text, "{}", rounded(spread));
    }
    text
}

/// To nine digits, as single precision needs them.
fn rounded(number: f64) -> f64 {
    format!("{number:.8e}").parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::{ObjectPoint, to_ply};
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn a_line_for_each_point_behind_a_header_that_counts_them() {
        let point = ObjectPoint {
            point: Vector3::new(0.1, -1.0 / 3.0, 0.0),
            normal: Vector3::new(0.0, 0.0, -5.0),
            covariance: Matrix3::from_diagonal_element(1e-6),
            bend: Matrix3::zeros(),
        };
        let text = to_ply(&[point; 3]);
        let (header, body) = text.split_once("end_header\n").unwrap();
        assert!(
            header.starts_with("ply\nformat ascii 1.0\n") && header.contains("element vertex 3\n"),
            "{header}"
        );
        assert_eq!(header.matches("property double ").count(), 7);
        assert_eq!(body, "0.1 -0.333333333 0 0 0 -1 0.001\n".repeat(3));
        assert!(to_ply(&[]).ends_with("end_header\n"));
    }
}
