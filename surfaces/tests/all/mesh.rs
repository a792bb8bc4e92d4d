//! Meshes: watertight, refused when open, read from files.

use fingertip_surfaces::testing::{SurfaceLaws, ball_of_triangles};
use fingertip_surfaces::*;
use fingertip_wrench::{Line, Real};
use nalgebra::{Rotation3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

fn mesh<T: Real>(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Mesh<T> {
    let vertices: Vec<_> = vertices.iter().map(|v| v.map(T::literal)).collect();
    Mesh::new(&vertices, triangles).unwrap()
}

/// Lines aimed at edges and vertices cross the ball once in and once out, never more, never less.
fn no_leak<T: Real>(lines: usize) {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let (vertices, triangles) = ball_of_triangles(20, 30, None);
    // An odd rotation, so that nothing is aligned; for half the lines, everything is.
    let turn = Rotation3::from_euler_angles(0.3, 0.5, 0.7);
    let turned: Vec<_> = vertices.iter().map(|v| turn * v).collect();
    for vertices in [vertices, turned] {
        let surface = mesh::<T>(&vertices, &triangles);
        let vertices: Vec<Vector3<T>> = surface.vertices().collect();
        for k in 0..lines / 2 {
            let triangle = surface.triangles()[random.random_range(0..triangles.len())];
            let [a, b] = [vertices[triangle[0] as usize], vertices[triangle[1] as usize]];
            let target = match k % 3 {
                0 => a,
                1 => (a + b) * T::literal(0.5),
                _ => a + (b - a) * T::literal(random.random_range(0.0..1.0)),
            };
            let from = match k % 2 {
                0 => vertices[random.random_range(0..vertices.len())],
                _ => Vector3::from_fn(|_, _| T::literal(random.random_range(-0.5..0.5))),
            };
            let direction = target - from;
            let length = direction.norm();
            if length < T::literal(0.3) {
                continue;
            }
            let direction = direction / length;
            let (mut inward, mut outward) = (0, 0);
            surface.crossings(&Line { point: from, direction }, |c| {
                if c.normal.dot(&direction) > T::zero() { outward += 1 } else { inward += 1 }
            });
            // From a point inside or on the ball, the line passes through its inside.
            assert_eq!((inward, outward), (1, 1), "line {k} from {from:?} to {target:?}");
        }
    }
}

#[test]
fn no_leak_in_single_precision() {
    no_leak::<f32>(100_000);
}

#[test]
fn no_leak_in_double_precision() {
    no_leak::<f64>(100_000);
}

fn laws<T: Real>() {
    let (vertices, triangles) = ball_of_triangles(12, 16, None);
    let laws = SurfaceLaws::around(Vector3::zeros(), T::one()).with_edges().with_roundings(T::literal(128.0));
    laws.check(&mesh::<T>(&vertices, &triangles)).unwrap();
    laws.check_scaling(|scale| {
        let vertices: Vec<_> = vertices.iter().map(|v| v.map(T::literal) * scale).collect();
        Mesh::new(&vertices, &triangles).ok()
    })
    .unwrap();
}

#[test]
fn laws_in_single_precision() {
    laws::<f32>();
}

#[test]
fn laws_in_double_precision() {
    laws::<f64>();
}

/// A fine ball is nearly a sphere.
#[test]
fn fine_mesh_agrees_with_the_sphere() {
    let (vertices, triangles) = ball_of_triangles(100, 200, None);
    let surface = mesh::<f64>(&vertices, &triangles);
    let sphere = Sphere::centred(1.0).unwrap();
    let mut random = Pcg64Mcg::seed_from_u64(6);
    let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
    for _ in 0..2000 {
        let line = Line { point: any() * 0.5, direction: any().normalize() };
        let sorted = |found: &mut Vec<f64>| found.sort_by(f64::total_cmp);
        let (mut a, mut b) = (Vec::new(), Vec::new());
        surface.crossings(&line, |c| a.push(c.along));
        sphere.crossings(&line, |c| b.push(c.along));
        sorted(&mut a);
        sorted(&mut b);
        assert_eq!((a.len(), b.len()), (2, 2));
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 2e-3), "{a:?} {b:?}");
    }
}

/// A ball of spikes, so that a line crosses dozens of triangles: the tree leaves none out.
#[test]
fn tree_finds_what_trying_every_triangle_finds() {
    let mut random = Pcg64Mcg::seed_from_u64(8);
    let (mut vertices, triangles) = ball_of_triangles(60, 90, None);
    for vertex in &mut vertices {
        *vertex *= 10_f64.powf(random.random_range(-1.0..0.0));
    }
    let surface = mesh::<f64>(&vertices, &triangles);
    let mut most = 0;
    for _ in 0..1000 {
        let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
        let line = Line { point: any() * 0.3, direction: any().normalize() };
        // The line passes all three edges on the same side.
        let passes = |[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|k| vertices[*k as usize] - line.point);
            let sides = [(a, b), (b, c), (c, a)].map(|(a, b)| line.direction.dot(&a.cross(&b)) > 0.0);
            sides == [true; 3] || sides == [false; 3]
        };
        let expected = triangles.iter().filter(|triangle| passes(triangle)).count();
        let (mut found, mut sum) = (0, 0);
        surface.crossings(&line, |c| {
            found += 1;
            sum += if c.normal.dot(&line.direction) > 0.0 { 1 } else { -1 };
        });
        assert_eq!((found, sum), (expected, 0), "{line:?}");
        most = most.max(found);
    }
    assert!(most > 40, "{most}");
}

fn tetrahedron() -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
    let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    (vertices.map(Vector3::from).to_vec(), vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
}

#[test]
fn open_and_inconsistent_meshes_are_refused_with_a_count() {
    let (vertices, triangles) = tetrahedron();
    assert!(Mesh::new(&vertices, &triangles).is_ok());
    assert_eq!(Mesh::new(&vertices, &triangles[..3]), Err(MeshError::BadEdges { open: 3, inconsistent: 0 }));
    let mut flipped = triangles.clone();
    flipped[1].swap(0, 1);
    assert_eq!(Mesh::new(&vertices, &flipped), Err(MeshError::BadEdges { open: 0, inconsistent: 3 }));
    assert_eq!(Mesh::new(&vertices, &[[0, 1, 9]]), Err(MeshError::NoSuchVertex { triangle: 0 }));
    assert_eq!(Mesh::<f64>::new(&[], &[]), Err(MeshError::NoVolume));
    let mut broken = vertices;
    broken[2].y = f64::NAN;
    assert_eq!(Mesh::new(&broken, &triangles), Err(MeshError::NotFinite { vertex: 2 }));
}

#[test]
fn a_mesh_that_faces_inward_is_turned() {
    let (vertices, triangles) = tetrahedron();
    let inward: Vec<_> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    let surface = Mesh::new(&vertices, &inward).unwrap();
    assert!(surface.contains(&Vector3::repeat(0.1)) && !surface.contains(&Vector3::repeat(0.5)));
}

/// Every triangle with vertices of its own, and slivers between them.
#[test]
fn duplicate_vertices_and_slivers_are_tolerated() {
    let (vertices, triangles) = ball_of_triangles(12, 16, None);
    let mut loose: Vec<Vector3<f64>> = Vec::new();
    let mut split = Vec::new();
    for [a, b, c] in &triangles {
        let [a, b, c] = [a, b, c].map(|k| vertices[*k as usize]);
        // A vertex a millionth of the edge away from a corner makes slivers.
        let near = a + (b + c - a - a) * 0.5e-6;
        let first = loose.len() as u32;
        loose.extend([a, b, near, b, c, near, c, a, near]);
        split.extend([0, 3, 6].map(|k| [first + k, first + k + 1, first + k + 2]));
        // One without any area.
        loose.extend([a, a, b]);
        split.push([first + 9, first + 10, first + 11]);
    }
    let surface = Mesh::new(&loose, &split).unwrap();
    assert_eq!(surface.triangle_count(), 3 * triangles.len());
    SurfaceLaws::around(Vector3::zeros(), 1.0).with_edges().with_roundings(1e7).check(&surface).unwrap();
}

fn stl_text(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> String {
    let mut text = String::from("solid test\n");
    for triangle in triangles {
        text += "facet normal 0 0 0\n outer loop\n";
        for k in triangle {
            let v = vertices[*k as usize];
            text += &format!("  vertex {:e} {:e} {:e}\n", v.x, v.y, v.z);
        }
        text += " endloop\nendfacet\n";
    }
    text + "endsolid test\n"
}

fn stl_binary(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Vec<u8> {
    // A header that begins like a text file, as some programs write it.
    let mut bytes = b"solid but binary".to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        for k in triangle {
            bytes.extend(vertices[*k as usize].iter().flat_map(|x| (*x as f32).to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn files_are_read() {
    let (vertices, triangles) = tetrahedron();
    let expected = mesh::<f64>(&vertices.iter().map(|v| v * 0.001).collect::<Vec<_>>(), &triangles);
    let text = Mesh::from_stl(stl_text(&vertices, &triangles).as_bytes(), 0.001).unwrap();
    let binary = Mesh::from_stl(&stl_binary(&vertices, &triangles), 0.001).unwrap();
    let obj =
        "# mm\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1/1 2/1 4/1\nf 2//1 3//1 4//1\nf -2 -4 -1\n";
    let obj = Mesh::from_obj(obj, 0.001).unwrap();
    for found in [text, binary, obj] {
        assert_eq!(found.triangle_count(), 4);
        let line = Line { point: Vector3::repeat(0.0001), direction: Vector3::x() };
        let ends = |mesh: &Mesh<f64>| {
            let mut ends = Vec::new();
            mesh.crossings(&line, |c| ends.push(c.along));
            ends.sort_by(f64::total_cmp);
            ends
        };
        assert!(ends(&found).iter().zip(ends(&expected)).all(|(a, b)| (a - b).abs() < 1e-15));
        assert_eq!(ends(&found).len(), 2);
    }
}

#[test]
fn malformed_files_are_refused_with_the_line() {
    let bad = |text: &str| Mesh::<f64>::from_stl(text.as_bytes(), 1.0).unwrap_err();
    assert_eq!(bad("solid\nfacet\nouter loop\nvertex 0 0\n"), MeshError::Malformed { line: 4 });
    assert_eq!(bad("solid\nfacet\nouter loop\nvertex 0 0 0\nendloop\n"), MeshError::Malformed { line: 5 });
    assert_eq!(bad("hello"), MeshError::Malformed { line: 1 });
    assert_eq!(Mesh::<f64>::from_stl(&[0xff; 90], 1.0), Err(MeshError::NotText));
    assert_eq!(Mesh::<f64>::from_obj("v 0 0 0\nf 1 2\n", 1.0), Err(MeshError::Malformed { line: 2 }));
    assert_eq!(Mesh::<f64>::from_obj("v 0 zero 0\n", 1.0), Err(MeshError::Malformed { line: 1 }));
    assert!(matches!(Mesh::<f64>::from_file("/no/such/file.stl", 1.0), Err(MeshError::Unreadable(_))));
    // What has no end, or is none: a folder, and where there are such a device.
    assert!(matches!(Mesh::<f64>::from_file(env!("CARGO_MANIFEST_DIR"), 1.0), Err(MeshError::NoFile)));
    #[cfg(target_os = "linux")]
    assert!(matches!(Mesh::<f64>::from_file("/dev/zero", 1.0), Err(MeshError::NoFile)));
}

/// The name tells how a file is read.
#[test]
fn files_are_told_apart_by_their_names() {
    let (vertices, triangles) = tetrahedron();
    let folder = std::env::temp_dir().join(format!("fingertip-mesh-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    let [text, binary] = [stl_text(&vertices, &triangles).into_bytes(), stl_binary(&vertices, &triangles)];
    let files = [("a.obj", obj.as_bytes()), ("b.OBJ", obj.as_bytes()), ("c.stl", &text), ("d.STL", &binary)];
    for (name, bytes) in files {
        let path = folder.join(name);
        std::fs::write(&path, bytes).unwrap();
        let mesh = Mesh::<f64>::from_file(&path, 0.001).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(mesh.triangle_count(), 4, "{name}");
        assert!(mesh.contains(&Vector3::repeat(1e-4)), "{name}");
    }
    let path = folder.join("e.obj");
    std::fs::write(&path, [0xff; 90]).unwrap();
    assert_eq!(Mesh::<f64>::from_file(&path, 0.001), Err(MeshError::NotText));
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Of a fine ball, a wrench may touch few triangles, all of them near where its force enters.
#[test]
fn a_wrench_is_asked_of_few_triangles() {
    let (vertices, triangles) = ball_of_triangles(60, 61, None);
    let ball = mesh::<f64>(&vertices, &triangles);
    let mut random = Pcg64Mcg::seed_from_u64(9);
    for _ in 0..200 {
        let place = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize();
        let force = -place + Vector3::from_fn(|_, _| random.random_range(-0.3..0.3));
        let (mut asked, mut is_there) = (0, false);
        ball.may_be_touched(&force, &place.cross(&force), 0.0, |range, _| {
            asked += range.len();
            for triangle in range {
                is_there |= ball.normal_of(triangle).dot(&place) > 0.998;
            }
        });
        assert!(is_there && asked < triangles.len() / 20, "{asked} of {}", triangles.len());
    }
}
