//! Shapes and poses from touches.

use fingertip_calibration::geometry::{
    Touch, WrenchNoise, fit_aligned_ellipsoid, fit_cylinder, fit_cylinder_along, fit_ellipsoid,
    fit_meeting_point, fit_plane, fit_pose, fit_sphere, least_radius,
};
use fingertip_calibration::nalgebra::{Matrix3, Matrix6, Rotation3, Vector3};
use fingertip_wrench::Wrench;

use super::{Draw, to_ten_digits, unchanged};

/// Touches with friction of an ellipsoid with these semi-axes, or of the side of a cylinder if the last is infinite.
fn touches(draw: &mut Draw, axes: Vector3<f64>, count: usize, noise: f64) -> Vec<Touch> {
    let centre = draw.vector() * 0.01;
    let finite = axes.z.is_finite();
    let squares = Matrix3::from_diagonal(&axes.map(|axis| if axis.is_finite() { axis * axis } else { 0.0 }));
    (0..count)
        .map(|_| {
            let mut normal = draw.direction();
            if !finite {
                normal = Vector3::new(normal.x, normal.y, 0.0).normalize();
            }
            let mut point = centre + squares * normal / normal.dot(&(squares * normal)).sqrt();
            if !finite {
                point.z += 0.02 * draw.signed();
            }
            let slide = draw.vector().cross(&normal).normalize();
            let force = (slide * 0.4 - normal) * (1.5 + draw.signed());
            let torque = point.cross(&force) + Vector3::from_fn(|_, _| draw.noise()) * noise;
            Touch { wrench: Wrench::on_fingertip(force, torque), normal: normal * 2.0 }
        })
        .collect()
}

fn noises() -> [WrenchNoise; 3] {
    let mut mixed = Matrix6::from_diagonal(&[4e-4, 1e-4, 9e-4, 1e-10, 4e-10, 1e-10].into());
    for (i, j, both) in [(0, 3, 5e-8), (1, 2, 1e-4), (4, 5, 1e-10)] {
        mixed[(i, j)] = both;
        mixed[(j, i)] = both;
    }
    [
        WrenchNoise::exact_forces(),
        WrenchNoise::new(0.01, 1e-5).unwrap(),
        WrenchNoise::with_covariance(&mixed).unwrap(),
    ]
}

#[test]
fn of_shapes() {
    let mut unchanged = unchanged("shapes");
    let draw = &mut Draw::new(3);
    let ellipsoids = [[13e-3; 3], [12e-3, 15e-3, 20e-3], [20e-3, 10e-3, 10.2e-3], [5e-3, 9e-3, 30e-3]];
    let cases: Vec<Vec<Touch>> = ellipsoids
        .into_iter()
        .flat_map(|axes| [(6, 1e-7), (9, 1e-5), (30, 3e-5)].map(|how| (axes, how)))
        .map(|(axes, (count, noise))| touches(draw, axes.into(), count, noise))
        .collect();
    let rods: Vec<Vec<Touch>> = [(4, 1e-7), (9, 1e-5), (30, 3e-5)]
        .map(|(count, noise)| touches(draw, Vector3::new(8e-3, 8e-3, f64::INFINITY), count, noise))
        .into();
    for (number, noise) in noises().iter().enumerate() {
        let mut note = |name: &str, of: &[Vec<Touch>], fit: &dyn Fn(&[Touch]) -> String| {
            unchanged.note(&format!("{name}, noise {number}"), of.iter().map(|touches| fit(touches)));
        };
        note("sphere", &cases, &|t| {
            to_ten_digits(&fit_sphere(t, noise).map(|fit| (fit.half_widths(0.9), fit)))
        });
        note("ellipsoid along the axes", &cases, &|t| to_ten_digits(&fit_aligned_ellipsoid(t, noise)));
        note("ellipsoid", &cases, &|t| to_ten_digits(&fit_ellipsoid(t, noise)));
        note("cylinder", &rods, &|t| to_ten_digits(&fit_cylinder(t, noise)));
        note("cylinder along z", &rods, &|t| to_ten_digits(&fit_cylinder_along(t, &Vector3::z(), noise)));
    }
    unchanged.check();
}

#[test]
fn of_pivots_and_poses() {
    let mut unchanged = unchanged("poses");
    let draw = &mut Draw::new(4);
    for (number, noise) in noises().iter().enumerate() {
        for (count, error) in [(3, 1e-7), (5, 1e-5), (20, 3e-5)] {
            let at = |point: Vector3<f64>, draw: &mut Draw| {
                let force = draw.vector() * 3.0;
                Wrench::on_fingertip(force, point.cross(&force) + draw.vector() * error)
            };
            let pivots: Vec<Vec<Wrench<f64>>> = (0..4)
                .map(|_| {
                    let point = Vector3::new(0.02 * draw.signed(), 0.02 * draw.signed(), 0.013);
                    (0..count).map(|_| at(point, draw)).collect()
                })
                .collect();
            let (turn, origin) = (draw.direction() * 1.3, draw.vector() * 0.1);
            let turn = Rotation3::from_scaled_axis(turn);
            let known: Vec<(Wrench<f64>, Vector3<f64>)> = (0..count + 2)
                .map(|_| {
                    let point = draw.vector() * 0.03;
                    (at(turn * point + origin, draw), point)
                })
                .collect();
            unchanged.note(
                &format!("{count} forces, noise {number}"),
                [
                    to_ten_digits(&fit_meeting_point(&pivots[0], noise)),
                    to_ten_digits(&fit_plane(&pivots, &Vector3::z(), noise)),
                    to_ten_digits(&fit_pose(&known, noise)),
                    to_ten_digits(&least_radius(&Vector3::new(1e-3, 0.0, 2e-3), &pivots[1], 0.7)),
                ],
            );
        }
    }
    unchanged.check();
}
