//! What a mesh is near a point and near a line, against all of its triangles one by one.

use fingertip_surfaces::*;
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::every_shape::{approach, crossings};

type Point = Vector3<f64>;

/// A body of needles, slivers and wide facets: a ball of triangles, squeezed and pulled at random.
fn thorny(random: &mut Pcg64Mcg, rings: u32, stretch: Point) -> Mesh<f64> {
    let (mut vertices, triangles) = testing::ball_of_triangles::<f64>(rings, rings + 1, Some(0.01));
    for vertex in &mut vertices {
        *vertex =
            vertex.component_mul(&stretch) * random.random_range(0.4..1.0) + Vector3::new(3.0, 1.0, -2.0);
    }
    Mesh::new(&vertices, &triangles).unwrap()
}

fn facets(mesh: &Mesh<f64>) -> Vec<[Point; 3]> {
    let vertices: Vec<_> = mesh.vertices().collect();
    mesh.triangles().iter().map(|t| t.map(|k| vertices[k as usize])).collect()
}

fn to_segment(p: &Point, a: &Point, b: &Point) -> f64 {
    let way = b - a;
    let part = ((p - a).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
    (a + way * part - p).norm()
}

/// To its plane, where the foot is within, or else to the nearest of the edges.
fn to_facet(p: &Point, [a, b, c]: &[Point; 3]) -> f64 {
    let normal = (b - a).cross(&(c - a)).normalize();
    let height = (p - a).dot(&normal);
    let foot = p - normal * height;
    let within =
        [(a, b), (b, c), (c, a)].iter().all(|(a, b)| (*b - *a).cross(&(foot - *a)).dot(&normal) >= 0.0);
    let edges = to_segment(p, a, b).min(to_segment(p, b, c)).min(to_segment(p, c, a));
    if within { height.abs() } else { edges }
}

fn normal([a, b, c]: &[Point; 3]) -> Point {
    (b - a).cross(&(c - a)).normalize()
}

#[test]
fn a_point_belongs_to_the_nearest_facet() {
    let mut random = Pcg64Mcg::seed_from_u64(41);
    for (rings, stretch) in [(3, [1.0, 1.0, 1.0]), (8, [1.0, 0.3, 0.6]), (12, [0.02, 1.0, 1.0])] {
        let mesh = thorny(&mut random, rings, stretch.into());
        let facets = facets(&mesh);
        for _ in 0..1500 {
            let middle = Vector3::new(3.0, 1.0, -2.0);
            let p = middle + Vector3::from_fn(|k, _| random.random_range(-1.2..1.2) * stretch[k]);
            let distances: Vec<_> = facets.iter().map(|f| to_facet(&p, f)).collect();
            let least = distances.iter().copied().fold(f64::MAX, f64::min);
            let found = mesh.normal(&p);
            let level = mesh.level(&p);
            assert!((found.norm() - 1.0).abs() < 1e-14 && level.gradient == found);
            // Of facets that are equally near, as at an edge, any.
            let is_of = |(distance, facet): (&f64, &[Point; 3])| {
                let height = (p - facet[0]).dot(&normal(facet));
                *distance <= least + 1e-12
                    && (normal(facet) - found).norm() < 1e-9
                    && (height - level.value).abs() < 1e-9
            };
            assert!(distances.iter().zip(&facets).any(is_of), "{p}: {found} {level:?}");
        }
    }
}

#[test]
fn a_line_that_misses_is_nearest_to_an_edge() {
    let mut random = Pcg64Mcg::seed_from_u64(42);
    for (rings, stretch) in [(3, [1.0, 1.0, 1.0]), (8, [1.0, 0.3, 0.6]), (12, [0.02, 1.0, 1.0])] {
        let mesh = thorny(&mut random, rings, stretch.into());
        let facets = facets(&mesh);
        let mut missed = 0;
        for _ in 0..600 {
            let middle = Vector3::new(3.0, 1.0, -2.0);
            let mut any = || Vector3::from_fn(|k, _| random.random_range(-1.2..1.2) * stretch[k]);
            let line = Line { point: middle + any(), direction: any().normalize() };
            if !crossings(&mesh, &line).is_empty() {
                continue;
            }
            missed += 1;
            let across = |v: Point| v - line.direction * v.dot(&line.direction);
            let from = |p: &Point| across(p - line.point);
            let edges = facets.iter().flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]);
            let to = |(a, b): (&Point, &Point)| to_segment(&Vector3::zeros(), &from(a), &from(b));
            let least = edges.map(to).fold(f64::MAX, f64::min);
            let found = approach(&mesh, &line);
            assert!((found.gap - least).abs() < 1e-13, "{line:?}: {found:?} {least}");
            assert!((from(&found.point).norm() - least).abs() < 1e-13);
            let its = |f: &[Point; 3]| {
                to_facet(&found.point, f) < 1e-13 && (normal(f) - found.normal).norm() < 1e-9
            };
            assert!(facets.iter().any(its), "{line:?}: {found:?}");
        }
        assert!(missed > 100, "{missed}");
    }
}

/// The ball about the middle of the box around all vertices.
#[test]
fn a_mesh_is_within_its_ball() {
    let mut random = Pcg64Mcg::seed_from_u64(43);
    let mesh = thorny(&mut random, 6, Vector3::new(1.0, 0.5, 0.25));
    let Extent { centre, radius } = mesh.extent();
    let [low, high] =
        mesh.vertices().fold([Vector3::repeat(f64::MAX), Vector3::repeat(-f64::MAX)], |[low, high], v| {
            [low.inf(&v), high.sup(&v)]
        });
    assert!((centre - (low + high) * 0.5).norm() < 1e-14, "{centre}");
    let farthest = mesh.vertices().map(|v| (v - centre).norm()).fold(0.0, f64::max);
    assert!(radius >= farthest && radius <= farthest * 1.001, "{radius} {farthest}");
}

/// However thin: the normal is that of the two shorter edges, which know it best.
#[test]
fn slivers_face_where_their_corners_say() {
    let mut random = Pcg64Mcg::seed_from_u64(44);
    for trial in 0..300 {
        // In the plane across (1, 2, 2), wound so, with the long edge first, second or third.
        let (first, second) = (Vector3::new(2.0, 1.0, -2.0) / 3.0, Vector3::new(-2.0, 2.0, -1.0) / 3.0);
        let up = first.cross(&second);
        let place = |x: f64, y: f64| (first * x + second * y).map(|x| x as f32);
        let thin = 10_f64.powf(random.random_range(-2.0..0.0));
        let mut corners = [place(0.0, 0.0), place(1.0, 0.0), place(random.random_range(0.2..0.8), thin)];
        corners.rotate_left(trial % 3);
        let [a, b, c] = corners;
        let apex = (up * -1.0).map(|x| x as f32);
        let mesh = Mesh::new(&[a, b, c, apex], &[[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]]).unwrap();
        let exact = normal(&corners.map(|v| v.map(f64::from)));
        let middle = (a + b + c) / 3.0;
        let found = mesh.normal(&middle).map(Real::to_f64);
        // As far as rounding the stored corners turns it.
        assert!((found - exact).norm() < 1e-6 / thin, "{trial} {thin}: {found} {exact}");
    }
}
