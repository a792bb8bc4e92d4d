//! What every shape tells of lines and points is held bit for bit.

use fingertip_surfaces::testing::ball_of_triangles;
use fingertip_surfaces::*;
use fingertip_test_support::Unchanged;
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::every_shape::every_shape;

/// Draws by sums, products and roots alone, so that the lines are the same on every system.
struct Draw(Pcg64Mcg);

impl Draw {
    fn new() -> Self {
        Self(Pcg64Mcg::seed_from_u64(71))
    }

    fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| 2.0 * self.0.random::<f64>() - 1.0)
    }

    fn direction(&mut self) -> Vector3<f64> {
        let vector = self.vector();
        vector / vector.norm()
    }

    fn small(&mut self) -> f64 {
        (0..self.0.random_range(0..24)).fold(1.0, |value, _| value * 0.25)
    }

    /// Through a ball of the size of the shape, in turn: any line, one along an axis, one through the middle, one
    /// from far away, one that grazes the surface, one a little aside of its normal.
    fn line(&mut self, surface: &DynSurface<f64>, kind: usize, size: f64) -> Line<f64> {
        let (point, direction) = (self.vector() * (1.6 * size), self.direction());
        let place = |line: &Line<f64>| {
            let mut last = None;
            surface.crossings(line, |crossing| last = Some((crossing.point, crossing.normal)));
            last.unwrap_or((line.point, line.direction))
        };
        match kind % 6 {
            0 => Line { point, direction },
            1 => {
                let mut axis = Vector3::zeros();
                axis[kind / 6 % 3] = if kind % 5 < 2 { 1.0 } else { -1.0 };
                // On a grid of quarters, on which the edges lie, and beside it.
                let rounded = (point / size * 4.0).map(f64::round) * (0.25 * size);
                Line { point: if (kind / 18).is_multiple_of(2) { rounded } else { point }, direction: axis }
            }
            2 => Line { point: direction * (self.small() * size), direction },
            3 => Line { point: point - direction * (size / self.small()), direction },
            4 => {
                let (at, normal) = place(&Line { point: point * 0.3, direction });
                let across = normal.cross(&self.direction());
                let aside = (self.small() - self.small()) * size;
                Line { point: at + normal * aside, direction: across / across.norm() }
            }
            _ => {
                let (at, normal) = place(&Line { point: point * 0.3, direction });
                let tilted = normal + self.vector() * self.small();
                Line { point: at + tilted * size, direction: -tilted / tilted.norm() }
            }
        }
    }
}

fn narrowed<T: Real>(line: &Line<f64>) -> Line<T> {
    Line { point: line.point.map(T::literal), direction: line.direction.map(T::literal) }
}

fn of_lines<T: Real>(surface: &DynSurface<T>, lines: &[Line<f64>]) -> Vec<impl core::fmt::Debug + use<T>> {
    let each = lines.iter().map(|line| {
        let line = narrowed(line);
        let mut found = Vec::new();
        surface.crossings(&line, |crossing| found.push(crossing));
        let wrench = Wrench::on_fingertip(line.direction, line.point.cross(&line.direction));
        let push = ForceLine::new(&wrench, ForceLine::least_squared());
        let entry = push.and_then(|push| surface.shortcuts().sole_entry(&push));
        (
            found,
            surface.closest_approach(&line),
            entry,
            surface.shortcuts().sole_entry(&ForceLine::along(&line)),
        )
    });
    each.collect()
}

/// On the surface, a little beside it, and anywhere.
fn of_points<T: Real>(
    surface: &DynSurface<T>,
    points: &[Vector3<f64>],
) -> Vec<impl core::fmt::Debug + use<T>> {
    let each = points.iter().map(|point| {
        let point = point.map(T::literal);
        let normal = surface.normal(&point);
        let (e1, e2) = fingertip_wrench::tangents(&normal);
        let bends = (surface.shape_operator(&point), surface.bend(&point, &normal, [&e1, &e2]));
        let residual = surface.shortcuts().surface_residual(&point);
        (
            (normal, surface.contains(&point), residual),
            surface.level(&point),
            bends,
            surface.corner(&point, &normal),
        )
    });
    each.collect()
}

fn of_shape<T: Real>(
    unchanged: &mut Unchanged,
    name: &str,
    surface: &DynSurface<T>,
    double: &DynSurface<f64>,
    size: f64,
) {
    let mut draw = Draw::new();
    let lines: Vec<_> = (0..600).map(|kind| draw.line(double, kind, size)).collect();
    let mut points = Vec::new();
    for line in &lines {
        let beside = line.direction * (draw.small() * size);
        double.crossings(line, |crossing| points.extend([crossing.point, crossing.point + beside]));
        points.push(draw.vector() * (1.5 * size));
    }
    points.truncate(900);
    unchanged.note(&format!("{name} lines"), of_lines(surface, &lines));
    unchanged.note(&format!("{name} points"), of_points(surface, &points));
    unchanged.note(&format!("{name} whole"), [(surface.extent(), surface.topology())]);
}

#[test]
fn every_shape_in_both_precisions() {
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/shapes.txt");
    for size in [1.0, 0.0137] {
        for (double, single) in every_shape(size).iter().zip(every_shape(size as f32)) {
            let name = format!("{} {size}", double.name);
            of_shape(&mut unchanged, &format!("{name} f64"), &double.surface, &double.surface, size);
            of_shape(&mut unchanged, &format!("{name} f32"), &single.surface, &double.surface, size);
        }
    }
    unchanged.check();
}

/// Distances to convex shapes, and what is grown by them.
#[test]
fn distances() {
    fn note<T: Real, S: SignedDistance<T> + SmoothSurface<T> + Clone>(
        unchanged: &mut Unchanged,
        name: &str,
        inner: S,
    ) {
        let n = T::literal;
        let grown = Offset::new(inner.clone(), n(0.004)).unwrap();
        let mut draw = Draw::new();
        let answers = (0..500).map(|kind| {
            let point = draw.vector() * if kind % 3 == 0 { 0.05 } else { 0.018 };
            let line = Line { point: point.map(n), direction: draw.direction().map(n) };
            let mut found = Vec::new();
            grown.crossings(&line, |crossing| found.push(crossing));
            let told = (inner.signed_distance(&line.point), grown.signed_distance(&line.point));
            let bent =
                (grown.shape_operator(&line.point), grown.level(&line.point), grown.contains(&line.point));
            (told, found, grown.closest_approach(&line), bent)
        });
        unchanged.note(name, answers);
    }
    fn of<T: Real>(unchanged: &mut Unchanged, kind: &str) {
        let n = T::literal;
        let v = |x, y, z| Vector3::new(n(x), n(y), n(z));
        note(unchanged, &format!("sphere {kind}"), Sphere::new(v(0.001, -0.002, 0.003), n(0.013)).unwrap());
        note(unchanged, &format!("ellipsoid {kind}"), Ellipsoid::new(v(0.008, 0.011, 0.017)).unwrap());
        let capsule = Capsule::new(v(0.0, 0.001, 0.0), v(0.3, 0.1, 1.0), n(0.007), n(0.006)).unwrap();
        note(unchanged, &format!("capsule {kind}"), capsule);
        let capped =
            CappedCylinder::new(v(0.001, 0.0, -0.001), v(0.2, -0.4, 1.0), n(0.009), n(0.010)).unwrap();
        note(unchanged, &format!("capped cylinder {kind}"), capped);
    }
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/distances.txt");
    of::<f64>(&mut unchanged, "f64");
    of::<f32>(&mut unchanged, "f32");
    unchanged.check();
}

/// Meshes of more triangles than a leaf of their tree holds.
#[test]
fn meshes() {
    let mut unchanged = Unchanged::new(env!("CARGO_MANIFEST_DIR"), "tests/unchanged/meshes.txt");
    for (rings, sectors) in [(9, 14), (40, 60)] {
        let (vertices, triangles) = ball_of_triangles::<f64>(rings, sectors, None);
        let mesh = |scale: f64| {
            let stretched = |v: &Vector3<f64>| Vector3::new(v.x, v.y * 0.8, v.z * 1.3) * scale;
            vertices.iter().map(stretched).collect::<Vec<_>>()
        };
        let double: DynSurface<f64> = Mesh::new(&mesh(0.0121), &triangles).unwrap().into();
        let single: Vec<_> = mesh(0.0121).iter().map(|v| v.map(|x| x as f32)).collect();
        let single: DynSurface<f32> = Mesh::new(&single, &triangles).unwrap().into();
        of_shape(&mut unchanged, &format!("{rings} f64"), &double, &double, 0.0137);
        of_shape(&mut unchanged, &format!("{rings} f32"), &single, &double, 0.0137);
    }
    unchanged.check();
}
