use super::{fit_aligned_ellipsoid, fit_ellipsoid};
use crate::fit::testing::gaussian;
use crate::geometry::{GeometryError, ShapeTouch, WrenchNoise};
use crate::testing::Largest as _;
use fingertip_surfaces::ActiveSurface as _;
use fingertip_wrench::Wrench;
use nalgebra::{Matrix3, Rotation3, Vector3};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

fn vector(random: &mut Pcg64Mcg) -> Vector3<f64> {
    Vector3::from_fn(|_, _| gaussian(random))
}

/// Touches with friction of an ellipsoid.
fn touches(
    random: &mut Pcg64Mcg,
    semi_axes: Vector3<f64>,
    turn: &Rotation3<f64>,
    centre: Vector3<f64>,
    count: usize,
) -> Vec<ShapeTouch> {
    let squares = Matrix3::from_diagonal(&semi_axes.component_mul(&semi_axes));
    let shape = turn * squares * turn.inverse();
    (0..count)
        .map(|_| {
            let n = vector(random).normalize();
            let point = centre + shape * n / n.dot(&(shape * n)).sqrt();
            let slide = vector(random).cross(&n).normalize();
            let force = (slide * 0.4 - n) * (1.0 + gaussian(random).abs());
            ShapeTouch { wrench: Wrench::from_force_at(&point, force), normal: n * 3.0 }
        })
        .collect()
}

#[test]
fn ellipsoids_of_any_orientation_come_back() {
    let random = &mut Pcg64Mcg::seed_from_u64(21);
    let axes = Vector3::new(0.02, 0.015, 0.012);
    for _ in 0..100 {
        let (turn, centre) = (Rotation3::from_scaled_axis(vector(random)), vector(random) * 0.01);
        let touches = touches(random, axes, &turn, centre, 15);
        let fitted = fit_ellipsoid(&touches, &WrenchNoise::exact_forces()).unwrap();
        assert!((fitted.shape.semi_axes - axes).largest() < 1e-10, "{fitted:?}");
        assert!((fitted.shape.sensor_from_ellipsoid.origin() - centre).largest() < 1e-10);
        // Principal axes have no sign.
        let found = fitted.shape.sensor_from_ellipsoid.rotation().tr_mul(turn.matrix());
        assert!((found.abs() - Matrix3::identity()).largest() < 1e-8, "{found}");
        assert!(fitted.unobserved.is_empty() && fitted.deviations.len() == 9);
        // Touched points lie on the surface.
        let surface = fitted.shape.surface().unwrap();
        assert!(surface.contains(&(centre + turn * Vector3::x() * 0.0199)));
        assert!(!surface.contains(&(centre + turn * Vector3::x() * 0.0201)));
    }
}

#[test]
fn aligned_ellipsoids_come_back() {
    let random = &mut Pcg64Mcg::seed_from_u64(22);
    let axes = Vector3::new(0.012, 0.015, 0.02);
    for _ in 0..100 {
        let centre = vector(random) * 0.01;
        let touches = touches(random, axes, &Rotation3::identity(), centre, 15);
        let fitted = fit_aligned_ellipsoid(&touches, &WrenchNoise::exact_forces()).unwrap();
        assert!((fitted.shape.semi_axes - axes).largest() < 1e-10);
        assert!((fitted.shape.centre - centre).largest() < 1e-10);
    }
}

#[test]
fn what_a_spheroid_hides_is_said() {
    let random = &mut Pcg64Mcg::seed_from_u64(23);
    let turn = Rotation3::from_scaled_axis(vector(random));
    let touches = touches(random, Vector3::new(0.02, 0.01, 0.01), &turn, Vector3::zeros(), 30);
    let noisy: Vec<ShapeTouch> = touches
        .iter()
        .map(|touch| ShapeTouch {
            wrench: Wrench::on_fingertip(touch.wrench.force(), touch.wrench.torque() + vector(random) * 1e-5),
            ..*touch
        })
        .collect();
    let fitted = fit_ellipsoid(&noisy, &WrenchNoise::exact_forces()).unwrap();
    assert_eq!(fitted.unobserved.len(), 1, "{fitted:?}");
    assert!(fitted.unobserved[0].contains("longest") && fitted.deviations[6].is_infinite());
    assert!(fitted.deviations[7] < 0.01 && fitted.deviations[8] < 0.01);
    assert!((fitted.shape.semi_axes.x - 0.02).abs() < 5.0 * fitted.deviations[0]);
    assert!(matches!(fit_ellipsoid(&touches[..2], &WrenchNoise::exact_forces()), Err(GeometryError::Fit(_))));
}

/// Deviations of semi-axes, centre and turns against the spread of many fits, to 5 %.
#[test]
fn deviations_are_those_of_many_trials() {
    let random = &mut Pcg64Mcg::seed_from_u64(24);
    let axes = Vector3::new(0.02, 0.015, 0.011);
    let turn = Rotation3::from_scaled_axis(Vector3::new(0.3, -0.5, 0.2));
    let clean = touches(random, axes, &turn, Vector3::new(0.001, 0.002, 0.003), 20);
    let trials = 4000;
    let (mut found, mut stated) = ([0.0; 9], [0.0; 9]);
    for _ in 0..trials {
        let noisy: Vec<ShapeTouch> = clean
            .iter()
            .map(|t| ShapeTouch {
                wrench: Wrench::on_fingertip(t.wrench.force(), t.wrench.torque() + vector(random) * 1e-5),
                ..*t
            })
            .collect();
        let fitted = fit_ellipsoid(&noisy, &WrenchNoise::exact_forces()).unwrap();
        let mut errors = [0.0; 9];
        let origin = fitted.shape.sensor_from_ellipsoid.origin();
        let left = turn.matrix().tr_mul(&fitted.shape.sensor_from_ellipsoid.rotation());
        for k in 0..3 {
            errors[k] = fitted.shape.semi_axes[k] - axes[k];
            errors[3 + k] = origin[k] - [0.001, 0.002, 0.003][k];
            // Off-diagonal entries are the turns, whatever the signs of the axes.
            errors[6 + k] = left[((k + 1) % 3, (k + 2) % 3)];
        }
        for k in 0..9 {
            found[k] += errors[k] * errors[k] / f64::from(trials);
            stated[k] += fitted.deviations[k].powi(2) / f64::from(trials);
        }
    }
    // The mean over each kind, for which 4000 trials tell 5 % apart.
    for kind in 0..3 {
        let ratio = (0..3).map(|k| found[3 * kind + k] / stated[3 * kind + k]).sum::<f64>() / 3.0;
        println!("kind {kind}: {:+.2} %", 100.0 * (ratio - 1.0));
        assert!((ratio - 1.0).abs() < 0.05, "{kind}: {ratio}");
    }
}
