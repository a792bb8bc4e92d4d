//! What fits of shapes and mountings say of the residuals they leave.

use fingertip_calibration::design::{
    DesignTouch, LoadedTube, Material, MatrixUsed, NominalLoads, Placement, Trial, TubeSpace, Wall,
};
use fingertip_calibration::geometry::{
    ShapeTouch, WrenchNoise, fit_aligned_ellipsoid, fit_cylinder_along, fit_meeting_point, fit_pose,
    fit_sphere, least_radius,
};
use fingertip_calibration::gravity::{Pose, fit_orientation};
use fingertip_calibration::nalgebra::{Matrix3, Vector3, Vector6};
use fingertip_surfaces::Sphere;
use fingertip_wrench::Wrench;
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

use super::random::{turn, vector};

/// Noise of torques \[N·m\].
const NOISE: f64 = 1e-5;

/// The mean square of residuals with this noise is less than its own by the share of the parameters. Of 2000
/// trials with a dozen degrees of freedom its mean is known to 1 %.
fn agrees(what: &str, rows: f64, parameters: f64, noise: f64, mut trial: impl FnMut() -> f64) {
    let mean = (0..2000).map(|_| trial().powi(2) / 2000.0).sum::<f64>();
    let expected = noise * noise * (rows - parameters) / rows;
    assert!((mean / expected - 1.0).abs() < 0.05, "{what}: {mean:e} {expected:e}");
}

fn pressed(random: &mut Pcg64Mcg, normal: Vector3<f64>, point: Vector3<f64>) -> ShapeTouch {
    let slide = vector(random).cross(&normal).normalize();
    ShapeTouch { wrench: Wrench::from_force_at(&point, slide * 0.4 - normal), normal }
}

fn noisy(random: &mut Pcg64Mcg, wrench: &Wrench<f64>) -> Wrench<f64> {
    Wrench::on_fingertip(wrench.force(), wrench.torque() + vector(random) * NOISE)
}

fn all_noisy(random: &mut Pcg64Mcg, touches: &[ShapeTouch]) -> Vec<ShapeTouch> {
    touches.iter().map(|touch| ShapeTouch { wrench: noisy(random, &touch.wrench), ..*touch }).collect()
}

#[test]
fn of_shapes_are_the_noise() {
    let random = &mut Pcg64Mcg::seed_from_u64(111);
    let normals: Vec<_> = (0..12).map(|_| vector(random).normalize()).collect();
    let sphere: Vec<_> = normals.iter().map(|n| pressed(random, *n, n * 0.013)).collect();
    agrees("sphere", 36.0, 4.0, NOISE, || {
        fit_sphere(&all_noisy(random, &sphere), &WrenchNoise::exact_forces()).unwrap().rms
    });
    let axes = Vector3::new(1.44e-4, 2.25e-4, 4e-4);
    let squared = Matrix3::from_diagonal(&axes);
    let ellipsoid: Vec<_> =
        normals.iter().map(|n| pressed(random, *n, squared * n / n.dot(&(squared * n)).sqrt())).collect();
    agrees("ellipsoid", 36.0, 6.0, NOISE, || {
        fit_aligned_ellipsoid(&all_noisy(random, &ellipsoid), &WrenchNoise::exact_forces()).unwrap().rms
    });
    let cylinder: Vec<_> = normals
        .iter()
        .map(|n| {
            let n = Vector3::new(n.x, n.y, 0.0).normalize();
            pressed(random, n, n * 0.008)
        })
        .collect();
    // Two equations a touch: its place along the axis takes up one.
    agrees("cylinder", 24.0, 3.0, NOISE, || {
        fit_cylinder_along(&all_noisy(random, &cylinder), &Vector3::z(), &WrenchNoise::exact_forces())
            .unwrap()
            .rms
    });
    let pivot: Vec<_> =
        normals.iter().map(|n| Wrench::from_force_at(&Vector3::new(0.01, 0.0, 0.02), *n)).collect();
    agrees("pivot", 36.0, 3.0, NOISE, || {
        fit_meeting_point(
            &pivot.iter().map(|wrench| noisy(random, wrench)).collect::<Vec<_>>(),
            &WrenchNoise::exact_forces(),
        )
        .unwrap()
        .rms
    });
    let pose: Vec<_> = normals
        .iter()
        .map(|n| {
            let point = n * 0.02;
            (Wrench::from_force_at(&point, vector(random)), point)
        })
        .collect();
    agrees("pose", 36.0, 6.0, NOISE, || {
        let touches: Vec<_> = pose.iter().map(|(wrench, point)| (noisy(random, wrench), *point)).collect();
        fit_pose(&touches, &WrenchNoise::exact_forces()).unwrap().rms
    });
}

fn mounted(turns: &[Matrix3<f64>], map: Matrix3<f64>, mut noise: impl FnMut() -> Vector3<f64>) -> Vec<Pose> {
    let one = |base_from_sensor: &Matrix3<f64>| {
        let force = map * base_from_sensor.tr_mul(&-Vector3::z()) + noise();
        let wrench = Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
        Pose { base_from_sensor: *base_from_sensor, wrench }
    };
    turns.iter().map(one).collect()
}

#[test]
fn of_a_mounting_are_noise_and_distortion() {
    let random = &mut Pcg64Mcg::seed_from_u64(112);
    let turns: Vec<_> = (0..40).map(|_| turn(random)).collect();
    let mount = turn(random) * 4.0;
    // Seven parameters of 120 forces; the free linear map, from which they come, costs little more.
    agrees("mounting", 120.0, 7.0, 0.02, || {
        fit_orientation(&mounted(&turns, mount, || vector(random) * 0.02), &-Vector3::z()).unwrap().rms
    });
    // Gains of 1.3, 1 and 1: the nearest multiple of a rotation is 1.1 times none.
    let gains = Matrix3::from_diagonal(&Vector3::new(1.3, 1.0, 1.0));
    let fit = fit_orientation(&mounted(&turns, gains * 4.0, Vector3::zeros), &-Vector3::z()).unwrap();
    assert!((fit.sensor_from_flange - Matrix3::identity()).iter().all(|off| off.abs() < 1e-12));
    assert!((fit.weight - 4.4).abs() < 1e-12);
    let expected = (0.04_f64 + 0.01 + 0.01).sqrt() / (1.69_f64 + 1.0 + 1.0).sqrt();
    assert!((fit.distortion - expected).abs() < 1e-12, "{} {expected}", fit.distortion);
}

/// Rounding to counts of a converter is noise of a count over √12.
#[test]
fn of_a_converter_are_those_of_rounding() {
    let loads = NominalLoads::equal(10.0, 0.1).unwrap();
    let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 20e-3, loads };
    let angle = (1_f64.to_radians(), 59_f64.to_radians());
    let space =
        TubeSpace::rosettes(3, (2e-3, 15e-3), angle, (-20e-3, 20e-3), tube, Wall::Fixed(0.2e-3)).unwrap();
    let layout = space.layout(&[5e-3, 0.35, 0.0]).unwrap();
    let touches = DesignTouch::on_sphere(13e-3, 1.2, 0.4, 5.0).unwrap();
    let sphere = Sphere::centred(13e-3).unwrap();
    let run = |noise: f64, resolution: f64| {
        let placement = Placement { angle: 0.0, position: 0.0 };
        let matrix = MatrixUsed::AsDesigned;
        let trial = Trial { loads, placement, noise, resolution, matrix, sensors: 20, seed: 4 };
        trial.run(&layout, &sphere, &touches).unwrap()
    };
    let count = 2e-6;
    let (rounded, noisy) = (run(0.0, count), run(count / 12.0_f64.sqrt(), 0.0));
    assert!((rounded.force_rms / noisy.force_rms - 1.0).abs() < 0.1, "{rounded:?} {noisy:?}");
    assert!((rounded.position_rms / noisy.position_rms - 1.0).abs() < 0.1, "{rounded:?} {noisy:?}");
    // Both together add in squares.
    let both = run(count / 12.0_f64.sqrt(), count);
    assert!((both.force_rms / noisy.force_rms / 2.0_f64.sqrt() - 1.0).abs() < 0.1, "{both:?} {noisy:?}");
}

/// A pose whose origin is far off, where rounding keeps the last steps from vanishing.
#[test]
fn a_far_pose_is_found_to_rounding() {
    let random = &mut Pcg64Mcg::seed_from_u64(113);
    for _ in 0..10 {
        let (rotation, origin) = (turn(random), Vector3::new(300.0, -200.0, 500.0));
        let touches: Vec<_> = (0..12)
            .map(|_| {
                let point = vector(random) * 0.02;
                (Wrench::from_force_at(&(rotation * point + origin), vector(random)), point)
            })
            .collect();
        let found = fit_pose(&touches, &WrenchNoise::exact_forces()).unwrap().shape;
        assert!((found.origin() - origin).norm() < 1e-6, "{}", found.origin());
        assert!((found.rotation() - rotation).norm() < 1e-6);
    }
}

#[test]
fn a_radius_is_told_by_lines_of_action_only() {
    let line = |off: f64| Wrench::from_force_at(&Vector3::new(0.0, off, 0.0), Vector3::x() * 2.0);
    let told = |wrenches: &[Wrench<f64>], friction: f64| least_radius(&Vector3::zeros(), wrenches, friction);
    // The farthest line is 4 mm off; at friction 0.75 the sine is 0.6.
    let radius = told(&[line(1e-3), line(-4e-3), line(2e-3)], 0.75).unwrap();
    assert!((radius - 4e-3 / 0.6).abs() < 1e-15, "{radius}");
    let none = Wrench::on_fingertip(Vector3::zeros(), Vector3::z());
    assert_eq!(told(&[line(1e-3), none, line(2e-3)], 0.75), None);
    assert_eq!((told(&[line(1e-3)], 0.0), told(&[line(1e-3)], f64::NAN)), (None, None));
}
