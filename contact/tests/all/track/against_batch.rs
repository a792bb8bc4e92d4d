//! On a plane the tracker is a linear filter: least squares over all samples at once gives the same answer.

use fingertip_contact::{Sighting, Tracker};
use fingertip_surfaces::Plane;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix4, Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// The last state `(x, y, ẋ, ẏ)` and its covariance by all sightings `(place, covariance, time step)` at once: unknown
/// are the states at all times; the equations are those of the motion, of the sightings, and of the first velocity.
fn all_at_once(
    sightings: &[(Vector2<f64>, Matrix2<f64>, f64)],
    speed: f64,
    within: f64,
) -> (DVector<f64>, DMatrix<f64>) {
    let count = sightings.len();
    let density = speed * speed / within;
    let mut information = DMatrix::<f64>::zeros(4 * count, 4 * count);
    let mut right = DVector::<f64>::zeros(4 * count);
    for axis in 2..4 {
        information[(axis, axis)] += 1.0 / (speed * speed);
    }
    for (k, (place, covariance, time)) in sightings.iter().enumerate() {
        let weight = covariance.try_inverse().unwrap();
        let at = 4 * k;
        let mut here = information.view_mut((at, at), (2, 2));
        here += weight;
        let mut rows = right.rows_mut(at, 2);
        rows += weight * place;
        if k == 0 {
            continue;
        }
        let t = *time;
        let (q11, q12, q22) = (density * t.powi(3) / 3.0, density * t * t / 2.0, density * t);
        #[rustfmt::skip]
        let noise = Matrix4::new(
            q11, 0.0, q12, 0.0,
            0.0, q11, 0.0, q12,
            q12, 0.0, q22, 0.0,
            0.0, q12, 0.0, q22,
        );
        #[rustfmt::skip]
        let step = Matrix4::new(
            1.0, 0.0, t, 0.0,
            0.0, 1.0, 0.0, t,
            0.0, 0.0, 1.0, 0.0,
            0.0, 0.0, 0.0, 1.0,
        );
        let weight = noise.try_inverse().unwrap();
        let before = at - 4;
        for (row, column, part) in [
            (before, before, step.transpose() * weight * step),
            (before, at, -step.transpose() * weight),
            (at, before, -weight * step),
            (at, at, weight),
        ] {
            let mut view = information.view_mut((row, column), (4, 4));
            view += part;
        }
    }
    let inverse = information.cholesky().unwrap().inverse();
    let states = &inverse * right;
    let last = 4 * (count - 1);
    (states.rows(last, 4).into_owned(), inverse.view((last, last), (4, 4)).into_owned())
}

#[test]
fn on_a_plane_it_is_least_squares_over_all_samples() {
    let mut random = Pcg64Mcg::seed_from_u64(24);
    let mut draw = move |least: f64, most: f64| random.random_range(least..most);
    for _ in 0..20 {
        let normal = Vector3::new(draw(-1.0, 1.0), draw(-1.0, 1.0), draw(0.1, 1.0)).normalize();
        let plane = Plane::new(normal * 0.02, normal).unwrap();
        let first = normal.cross(&Vector3::y()).normalize();
        let second = normal.cross(&first);
        let (speed, within) = (draw(0.005, 0.05), draw(0.05, 0.2));
        let mut tracker = Tracker::new(speed, within).unwrap().with_gate(1e-12).unwrap();
        let mut sightings = Vec::new();
        for k in 0..25 {
            let time = draw(0.5e-3, 5e-3);
            // Whatever the noise, and in tangents that turn from sample to sample.
            let root = Matrix2::new(draw(0.1, 1.0), 0.0, draw(-1.0, 1.0), draw(0.1, 1.0)) * 1e-3;
            let covariance = root * root.transpose();
            let along = f64::from(k) * 3e-3;
            let place = Vector2::new(along * 0.01, along * -0.02)
                + root * Vector2::new(draw(-1.0, 1.0), draw(-1.0, 1.0));
            sightings.push((place, covariance, time));
            let turn = draw(-3.0, 3.0);
            let (sin, cos) = f64::sin_cos(turn);
            let tangents = [first * cos + second * sin, second * cos - first * sin];
            let back = Matrix2::new(cos, sin, -sin, cos);
            let point = normal * 0.02 + first * place.x + second * place.y;
            let sighting =
                Sighting::new(point, normal, tangents, back * covariance * back.transpose()).unwrap();
            let tracked = tracker.follow(&plane, Some(&sighting), time).unwrap();
            if k < 1 {
                continue;
            }
            let (state, exact) = all_at_once(&sightings, speed, within);
            let offset = tracked.point - normal * 0.02;
            let found = [
                offset.dot(&first),
                offset.dot(&second),
                tracked.velocity.dot(&first),
                tracked.velocity.dot(&second),
            ];
            for (axis, found) in found.into_iter().enumerate() {
                let deviation = exact[(axis, axis)].sqrt();
                assert!(
                    (found - state[axis]).abs() < 1e-7 * deviation,
                    "{k} {axis}: {found} {}",
                    state[axis]
                );
            }
            // Covariances in the tangents of the track.
            let [t1, t2] = tracked.tangents;
            let turn = Matrix2::new(t1.dot(&first), t1.dot(&second), t2.dot(&first), t2.dot(&second));
            for (found, at) in [(tracked.position_covariance, 0), (tracked.velocity_covariance, 2)] {
                let exact: Matrix2<f64> = exact.fixed_view::<2, 2>(at, at).into_owned();
                let exact = turn * exact * turn.transpose();
                assert!((found - exact).norm() < 1e-7 * exact.norm(), "{k}: {found} {exact}");
            }
        }
    }
}

/// The steady state of one axis for small gains: gain `√2 (q T^{3/2}/r)^{1/2}`, deviation `r √gain`.
#[test]
fn the_steady_state_is_that_of_the_theory() {
    let plane = Plane::new(Vector3::zeros(), Vector3::z()).unwrap();
    let (speed, within, step, noise) = (0.01, 0.1, 1e-3, 2e-3);
    let mut tracker = Tracker::<f64>::new(speed, within).unwrap();
    let covariance = Matrix2::identity() * (noise * noise);
    let sighting =
        Sighting::new(Vector3::zeros(), Vector3::z(), [Vector3::x(), Vector3::y()], covariance).unwrap();
    let mut last = None;
    for _ in 0..3000 {
        last = tracker.follow(&plane, Some(&sighting), step);
    }
    let density = speed / f64::sqrt(within);
    let gain = (2.0 * density * step.powf(1.5) / noise).sqrt();
    let deviation = last.unwrap().deviation();
    assert!((deviation / (noise * gain.sqrt()) - 1.0).abs() < 0.02, "{deviation}");
}
