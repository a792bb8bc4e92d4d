//! Is the error as large as the tracker says? Normalised errors squared are χ² of two degrees of freedom.

use fingertip_contact::{Continuity, Tracker};
use fingertip_surfaces::testing::ball_of_triangles;
use fingertip_surfaces::{ActiveSurface, Capsule, Ellipsoid, Mesh, Sphere};
use nalgebra::Vector3;

use super::course::{Course, along};

const SPEED: f64 = 0.01;
const WITHIN: f64 = 0.1;

/// What many courses on a surface say.
#[derive(Debug)]
pub(super) struct Judged {
    /// Means of the normalised squares over the courses, of position, velocity and innovation; each is 2 if all is
    /// right.
    pub(super) position: f64,
    pub(super) velocity: f64,
    pub(super) innovation: f64,
    /// Half the width of the interval that holds such a mean with 95 %.
    pub(super) interval: f64,
    /// Tracks that were given up, of the samples.
    pub(super) lost: usize,
    pub(super) samples: usize,
    /// Medians of the error of the track and of single samples [m].
    pub(super) error: f64,
    pub(super) single: f64,
}

fn median(mut errors: Vec<f64>) -> f64 {
    errors.sort_by(f64::total_cmp);
    errors[errors.len() / 2]
}

/// `courses` courses of 0.3 s at 1 kHz, of which the last sample is judged: so the squares are independent.
pub(super) fn judged<S: ActiveSurface<f64>>(surface: &S, force: f64, courses: u32, seed: u64) -> Judged {
    let golden = 2.399_963;
    let (mut position, mut velocity, mut innovation) = (0.0, 0.0, 0.0);
    let (mut lost, mut samples) = (0, 0);
    let (mut errors, mut single) = (Vec::new(), Vec::new());
    for k in 0..courses {
        // Evenly over the sphere of directions.
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(courses);
        let (sin, cos) = f64::sin_cos(golden * f64::from(k));
        let side = (1.0 - z * z).sqrt();
        let from = Vector3::new(side * cos, side * sin, z) * 1e-3;
        let mut course = Course::new(surface, from, SPEED, WITHIN, seed + u64::from(k));
        let mut tracker = Tracker::new(SPEED, WITHIN).unwrap();
        let mut last = None;
        for sample in 0..300 {
            if sample > 0 {
                course.wait(1e-3);
            }
            let sighting = course.sighting(force);
            last = tracker.follow(surface, sighting.as_ref(), 1e-3);
            samples += 1;
            lost +=
                usize::from(sample > 0 && last.is_some_and(|tracked| tracked.continuity == Continuity::New));
            single.extend(sighting.map(|sighting| (sighting.point() - course.point).norm()));
            if let Some(tracked) = &last
                && sample > 100
            {
                errors.push((tracked.point - course.point).norm());
            }
        }
        let tracked = last.unwrap();
        let normalised = |error: Vector3<f64>, covariance: nalgebra::Matrix2<f64>| {
            let error = along(&tracked.tangents, &error);
            error.dot(&(covariance.try_inverse().unwrap() * error))
        };
        position += normalised(tracked.point - course.point, tracked.position_covariance);
        velocity += normalised(tracked.velocity - course.velocity, tracked.velocity_covariance);
        innovation += tracked.surprise;
    }
    let count = f64::from(courses);
    Judged {
        position: position / count,
        velocity: velocity / count,
        innovation: innovation / count,
        // χ² of two degrees of freedom has the variance 4.
        interval: 1.96 * 2.0 / count.sqrt(),
        lost,
        samples,
        error: median(errors),
        single: median(single),
    }
}

fn holds<S: ActiveSurface<f64>>(surface: &S, force: f64, courses: u32) {
    let judged = judged(surface, force, courses, 1);
    println!("{force} N: {judged:?}");
    // Three means in a row: wider than 95 % each.
    let allowed = judged.interval * 1.5;
    for mean in [judged.position, judged.velocity, judged.innovation] {
        assert!((mean - 2.0).abs() < allowed, "{judged:?}");
    }
    assert!(judged.error < 0.7 * judged.single, "{judged:?}");
    assert!(judged.lost * 10_000 <= judged.samples, "{judged:?}");
}

fn capsule() -> Capsule<f64> {
    Capsule::new(Vector3::zeros(), Vector3::z(), 0.009, 0.005).unwrap()
}

fn mesh() -> Mesh<f64> {
    let (vertices, triangles) = ball_of_triangles(12, 24, None);
    let vertices: Vec<Vector3<f64>> = vertices.iter().map(|vertex: &Vector3<f64>| vertex * 12e-3).collect();
    Mesh::new(&vertices, &triangles).unwrap()
}

#[test]
fn errors_are_as_large_as_is_said_on_a_sphere() {
    holds(&Sphere::new(Vector3::zeros(), 0.013).unwrap(), 0.5, 200);
}

#[test]
#[ignore = "a thousand courses on four shapes take minutes"]
fn errors_are_as_large_as_is_said_on_four_shapes() {
    for force in [0.2, 1.0, 5.0] {
        println!("sphere");
        holds(&Sphere::new(Vector3::zeros(), 0.013).unwrap(), force, 1000);
        println!("ellipsoid");
        holds(&Ellipsoid::new(Vector3::new(0.010, 0.012, 0.014)).unwrap(), force, 1000);
        println!("capsule");
        holds(&capsule(), force, 1000);
        println!("mesh");
        holds(&mesh(), force, 1000);
    }
}
