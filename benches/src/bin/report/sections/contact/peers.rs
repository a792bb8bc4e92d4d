//! Crossings of half-lines beside parry3d.

use core::hint::black_box;

use fingertip_surfaces::testing::ball_of_triangles;
use fingertip_surfaces::{ActiveSurface, Mesh, Sphere};
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;
use parry3d::query::{Ray, RayCast};
use parry3d::shape;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use super::study::{Errors, Study};
use crate::Failure;
use crate::stability::levels::direction;
use crate::timing::time;

fn first<T: Real>(surface: &impl ActiveSurface<T>, line: &Line<T>) -> Option<T> {
    let mut first = None;
    surface.crossings(line, |c| {
        if first.is_none_or(|t| c.along < t) {
            first = Some(c.along);
        }
    });
    first
}

/// Where a half-line first meets a shape of size 1, by us and by parry3d, both in f32; the truth is
/// ours in f64.
pub(super) fn beside_parry(study: &mut Study<'_>) -> Result<(), Failure> {
    type Vector = parry3d::math::Vector;
    let mut random = Pcg64Mcg::seed_from_u64(13);
    let rays: Vec<Ray> = (0..study.effort.choose(64, 500))
        .map(|_| {
            let (along, aim) = (direction(&mut random), direction(&mut random) * 0.5);
            let from = aim - along * 4.0;
            let to = |v: Vector3<f64>| Vector::new(v.x as f32, v.y as f32, v.z as f32);
            Ray::new(to(from), to(along))
        })
        .collect();
    let lines: Vec<Line<f32>> = rays
        .iter()
        .map(|ray| Line {
            point: Vector3::new(ray.origin.x, ray.origin.y, ray.origin.z),
            direction: Vector3::new(ray.dir.x, ray.dir.y, ray.dir.z),
        })
        .collect();
    macro_rules! pair {
        ($name:literal, $ours:expr, $exact:expr, $theirs:expr) => {{
            let (ours, exact, theirs) = ($ours, $exact, $theirs);
            let truth: Vec<Option<f64>> = lines
                .iter()
                .map(|l| first(&exact, &Line { point: l.point.cast::<f64>(), direction: l.direction.cast() }))
                .collect();
            let errors = |found: &dyn Fn(usize) -> Option<f32>| {
                Errors::of(truth.iter().enumerate().filter_map(|(k, truth)| {
                    let truth = (*truth)?;
                    Some(found(k).map(|t| (f64::from(t) - truth).abs() / 2.0))
                }))
            };
            let mine = errors(&|k| first(&ours, &lines[k]));
            let other = errors(&|k| theirs.cast_local_ray(&rays[k], 100.0, true));
            let timed = time(study.effort, lines.len(), || {
                for line in &lines {
                    black_box(first(&ours, black_box(line)));
                }
            });
            study.push($name, "fingertip, first crossing", "half-line", mine, Some(timed));
            let timed = time(study.effort, rays.len(), || {
                for ray in &rays {
                    black_box(theirs.cast_local_ray_and_get_normal(black_box(ray), 100.0, true));
                }
            });
            study.push($name, "parry3d, ray cast", "half-line", other, Some(timed));
        }};
    }
    use fingertip_surfaces::{CappedCylinder, Capsule, Frustum};
    fn capsule<T: Real>() -> Result<Capsule<T>, Failure> {
        Ok(Capsule::new(Vector3::zeros(), Vector3::y(), T::literal(0.75), T::literal(0.5))?)
    }
    fn cylinder<T: Real>() -> Result<CappedCylinder<T>, Failure> {
        Ok(CappedCylinder::new(Vector3::zeros(), Vector3::y(), T::literal(0.75), T::literal(0.5))?)
    }
    fn cone<T: Real>() -> Result<Frustum<T>, Failure> {
        let base = Vector3::y() * T::literal(-0.5);
        Ok(Frustum::new(base, Vector3::y(), T::literal(0.75), T::zero(), T::one())?)
    }
    pair!("sphere", Sphere::centred(1.0_f32)?, Sphere::centred(1.0_f64)?, shape::Ball::new(1.0));
    pair!("capsule", capsule::<f32>()?, capsule::<f64>()?, shape::Capsule::new_y(0.5, 0.75));
    pair!("cylinder", cylinder::<f32>()?, cylinder::<f64>()?, shape::Cylinder::new(0.5, 0.75));
    pair!("cone", cone::<f32>()?, cone::<f64>()?, shape::Cone::new(0.5, 0.75));
    let (vertices, triangles) = ball_of_triangles::<f32>(50, 51, None);
    let wide: Vec<Vector3<f64>> = vertices.iter().map(|v| v.cast()).collect();
    let points: Vec<Vector> = vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
    let soup = shape::TriMesh::new(points, triangles.clone()).map_err(|error| format!("{error:?}"))?;
    pair!("mesh of 5000", Mesh::new(&vertices, &triangles)?, Mesh::new(&wide, &triangles)?, soup);
    Ok(())
}
