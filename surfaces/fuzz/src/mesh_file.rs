//! Reads any bytes as a mesh, and tries what comes out.

use fingertip_surfaces::{ActiveSurface, Mesh};
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

/// A mesh that was accepted is closed: a line through it enters as often as it leaves, and its answers are
/// numbers.
pub(crate) fn check_mesh<T: Real>(mesh: &Mesh<T>) {
    assert!(mesh.triangle_count() >= 4, "{mesh:?}");
    let middle = mesh
        .vertices()
        .fold(Vector3::zeros(), |sum: Vector3<T>, v| sum + v / T::literal(mesh.vertices().count() as f64));
    for direction in [[0.48, 0.6, 0.64], [-0.6, 0.8, 0.0], [0.0, 0.0, 1.0]] {
        let line = Line { point: middle, direction: Vector3::from(direction.map(T::literal)) };
        let (mut count, mut finite) = (0, true);
        mesh.crossings(&line, |crossing| {
            count += 1;
            finite &= crossing.along.is_number() && crossing.point.iter().all(|x| x.is_number());
            finite &= crossing.normal.iter().all(|x| x.is_number());
        });
        assert!(count % 2 == 0 && finite, "{mesh:?} {line:?}");
        let approach = mesh.closest_approach(&line).unwrap();
        assert!(
            approach.gap.is_number() && approach.point.iter().all(|x| x.is_number()),
            "{mesh:?} {line:?}"
        );
    }
}

/// As an STL file, in both precisions.
pub(crate) fn check_stl(bytes: &[u8]) {
    if let Ok(mesh) = Mesh::<f64>::from_stl(bytes, 1e-3) {
        check_mesh(&mesh);
    }
    if let Ok(mesh) = Mesh::<f32>::from_stl(bytes, 1e-3) {
        check_mesh(&mesh);
    }
}

/// As an OBJ file, in both precisions.
pub(crate) fn check_obj(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    if let Ok(mesh) = Mesh::<f64>::from_obj(&text, 1e-3) {
        check_mesh(&mesh);
    }
    if let Ok(mesh) = Mesh::<f32>::from_obj(&text, 1e-3) {
        check_mesh(&mesh);
    }
}
