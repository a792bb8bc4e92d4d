//! Shapes and poses from touches: errors as stated, and the same in any units, order and frame.

use fingertip_calibration::geometry::{
    GeometryError, ShapeTouch, WrenchNoise, fit_aligned_ellipsoid, fit_cylinder, fit_cylinder_along,
    fit_ellipsoid, fit_meeting_point, fit_plane, fit_pose, fit_sphere,
};
use fingertip_calibration::nalgebra::{Matrix3, Rotation3, Vector3};
use fingertip_wrench::Wrench;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::random::{gaussian, turn, vector};
use super::spread::Spread;
use super::testing::Largest as _;

const CENTRE: Vector3<f64> = Vector3::new(0.003, -0.002, 0.004);

/// Pressing with friction at a point.
fn pressed(random: &mut Pcg64Mcg, point: Vector3<f64>, normal: Vector3<f64>) -> ShapeTouch {
    let slide = vector(random).cross(&normal).normalize();
    let force = (slide * 0.4 - normal) * (1.0 + gaussian(random).abs());
    ShapeTouch { wrench: Wrench::from_force_at(&point, force), normal }
}

/// Touches of a body whose point with normal n is this.
fn touches(
    random: &mut Pcg64Mcg,
    count: usize,
    across: Option<Vector3<f64>>,
    point: impl Fn(&Vector3<f64>) -> Vector3<f64>,
) -> Vec<ShapeTouch> {
    (0..count)
        .map(|_| {
            let n = vector(random);
            let n = across.map_or(n, |axis| n - axis * n.dot(&axis)).normalize();
            pressed(random, point(&n), n)
        })
        .collect()
}

/// Torques wrong by 10 µN·m.
fn noisy(random: &mut Pcg64Mcg, wrench: &Wrench<f64>) -> Wrench<f64> {
    Wrench::on_fingertip(wrench.force(), wrench.torque() + vector(random) * 1e-5)
}

fn all_noisy(random: &mut Pcg64Mcg, touches: &[ShapeTouch]) -> Vec<ShapeTouch> {
    touches.iter().map(|touch| ShapeTouch { wrench: noisy(random, &touch.wrench), ..*touch }).collect()
}

fn squares(deviations: &[f64]) -> Vec<f64> {
    deviations.iter().map(|deviation| deviation * deviation).collect()
}

#[test]
fn errors_of_sphere_ellipsoid_and_cylinder_are_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(61);
    let clean = touches(random, 12, None, |n| CENTRE + n * 0.013);
    let spread = Spread::over(10_000, || {
        let fit = fit_sphere(&all_noisy(random, &clean), &WrenchNoise::exact_forces()).unwrap();
        let centre = fit.shape.centre() - CENTRE;
        (vec![fit.shape.radius() - 0.013, centre.x, centre.y, centre.z], squares(&fit.deviations))
    });
    spread.agrees("sphere");

    let axes = Vector3::new(0.012, 0.015, 0.02);
    let squared = Matrix3::from_diagonal(&axes.component_mul(&axes));
    let clean = touches(random, 15, None, |n| CENTRE + squared * n / n.dot(&(squared * n)).sqrt());
    let spread = Spread::over(8_000, || {
        let fit = fit_aligned_ellipsoid(&all_noisy(random, &clean), &WrenchNoise::exact_forces()).unwrap();
        let (axes, centre) = (fit.shape.semi_axes - axes, fit.shape.centre - CENTRE);
        (axes.iter().chain(centre.iter()).copied().collect(), squares(&fit.deviations))
    });
    spread.agrees("aligned ellipsoid");

    let clean = touches(random, 15, Some(Vector3::z()), |n| CENTRE + n * 0.008);
    let spread = Spread::over(10_000, || {
        let fit = fit_cylinder_along(&all_noisy(random, &clean), &Vector3::z(), &WrenchNoise::exact_forces())
            .unwrap();
        let error = fit.shape.centre() - CENTRE;
        // Its two offsets are along −y and x for an axis along z.
        (vec![fit.shape.radius() - 0.008, error.y, error.x], squares(&fit.deviations))
    });
    spread.agrees("cylinder");
}

#[test]
fn errors_of_pivot_and_pose_are_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(62);
    let forces: Vec<_> = (0..6).map(|_| Wrench::from_force_at(&CENTRE, vector(random))).collect();
    let spread = Spread::over(10_000, || {
        let wrenches: Vec<_> = forces.iter().map(|wrench| noisy(random, wrench)).collect();
        let fit = fit_meeting_point(&wrenches, &WrenchNoise::exact_forces()).unwrap();
        ((fit.shape - CENTRE).iter().copied().collect(), squares(&fit.deviations))
    });
    spread.agrees("pivot");

    let rotation = Rotation3::from_scaled_axis(Vector3::new(0.7, -1.1, 0.4));
    let clean: Vec<_> = (0..8)
        .map(|_| {
            let point = vector(random) * 0.02;
            (Wrench::from_force_at(&(rotation * point + CENTRE), vector(random) * 2.0), point)
        })
        .collect();
    let spread = Spread::over(1_900, || {
        let touches: Vec<_> = clean.iter().map(|(wrench, point)| (noisy(random, wrench), *point)).collect();
        let fit = fit_pose(&touches, &WrenchNoise::exact_forces()).unwrap();
        let turned = Rotation3::from_matrix_unchecked(fit.shape.rotation() * rotation.matrix().transpose());
        let errors =
            turned.scaled_axis().iter().chain((fit.shape.origin() - CENTRE).iter()).copied().collect();
        (errors, squares(&fit.deviations))
    });
    spread.agrees_in_the_mean("pose");
}

/// Pivots on a plane at 10 mm that is not centred over the origin: three, which leave nothing, and five.
#[test]
fn errors_of_a_plane_are_as_stated() {
    let random = &mut Pcg64Mcg::seed_from_u64(63);
    for count in [3, 5] {
        let points: Vec<_> = (0..count)
            .map(|i| {
                let angle = core::f64::consts::TAU * f64::from(i) / f64::from(count);
                Vector3::new(0.004 + 0.006 * angle.cos(), 0.004 * angle.sin() - 0.002, 0.01)
            })
            .collect();
        let clean: Vec<Vec<_>> = points
            .iter()
            .enumerate()
            .map(|(i, point)| {
                (0..5 + 4 * (i % 2)).map(|_| pressed(random, *point, Vector3::z()).wrench).collect()
            })
            .collect();
        let spread = Spread::over(8_000, || {
            let pivots: Vec<Vec<_>> =
                clean.iter().map(|list| list.iter().map(|wrench| noisy(random, wrench)).collect()).collect();
            let fit = fit_plane(&pivots, &Vector3::z(), &WrenchNoise::exact_forces()).unwrap();
            // The longer direction of the points is x, the shorter y.
            let normal = fit.shape.normal;
            (vec![fit.shape.offset - 0.01, normal.x, normal.y], squares(&fit.deviations))
        });
        spread.agrees(&format!("plane through {count} pivots"));
    }
}

/// Of pivots that lie off every plane by more than the noise of wrenches explains, the spread is what they show, not
/// what the wrenches say.
#[test]
fn pivots_that_lie_on_no_plane_say_so_of_it() {
    let random = &mut Pcg64Mcg::seed_from_u64(64);
    let spread = |random: &mut Pcg64Mcg, off: f64| {
        let pivots: Vec<Vec<_>> = (0..8)
            .map(|i| {
                let angle = core::f64::consts::TAU * f64::from(i) / 8.0;
                // One up, one down: no plane goes nearer.
                let height = 0.01 + if i % 2 == 0 { off } else { -off };
                let point = Vector3::new(0.006 * angle.cos(), 0.006 * angle.sin(), height);
                let wrenches: Vec<_> = (0..9).map(|_| pressed(random, point, Vector3::z()).wrench).collect();
                wrenches.iter().map(|wrench| noisy(random, wrench)).collect()
            })
            .collect();
        fit_plane(&pivots, &Vector3::z(), &WrenchNoise::exact_forces()).unwrap()
    };
    let flat = spread(random, 0.0);
    // Eight heights of ±1 mm, of which three say where the plane is: the mean is known to 1 mm/√5.
    let rough = spread(random, 1e-3);
    assert_eq!(rough.freedom, 5.0);
    let [offset, ..] = rough.deviations[..] else { panic!() };
    assert!((offset / (1e-3 / 5.0_f64.sqrt()) - 1.0).abs() < 0.1, "{offset:e}");
    assert!(flat.deviations[0] < 0.05 * offset && flat.freedom > 100.0, "{:e}", flat.deviations[0]);
}

/// Normals that point into the fingertip ask for a radius below zero, which is said as it is.
#[test]
fn normals_the_wrong_way_round_are_named() {
    let random = &mut Pcg64Mcg::seed_from_u64(65);
    let noise = WrenchNoise::exact_forces();
    let ask = |error: GeometryError| {
        let said = error.to_string();
        assert!(said.contains("radius: the torques ask for -13.00 mm"), "{said}");
    };
    let turned = |touches: Vec<ShapeTouch>| -> Vec<ShapeTouch> {
        touches.iter().map(|touch| ShapeTouch { normal: -touch.normal, ..*touch }).collect()
    };
    let ball = touches(random, 20, None, |n| CENTRE + n * 0.013);
    let inward = turned(ball);
    ask(fit_sphere(&inward, &noise).unwrap_err());
    ask(fit_aligned_ellipsoid(&inward, &noise).unwrap_err());
    ask(fit_ellipsoid(&inward, &noise).unwrap_err());
    let rod = touches(random, 20, Some(Vector3::z()), |n| CENTRE + n * 0.013);
    ask(fit_cylinder_along(&turned(rod), &Vector3::z(), &noise).unwrap_err());
}

/// The same load in other units, its frame turned and moved.
#[derive(Clone, Copy)]
struct Change {
    turn: Matrix3<f64>,
    origin: Vector3<f64>,
    newton: f64,
    metre: f64,
}

impl Change {
    fn new(random: &mut Pcg64Mcg) -> Self {
        let mut power = |most: i32| 10_f64.powi(random.random_range(-most..=most));
        let (newton, metre) = (power(5), power(3));
        Self { turn: turn(random), origin: vector(random) * 0.02, newton, metre }
    }

    fn point(&self, point: &Vector3<f64>) -> Vector3<f64> {
        (self.turn * point + self.origin) * self.metre
    }

    fn wrench(&self, wrench: &Wrench<f64>) -> Wrench<f64> {
        let force = self.turn * wrench.force();
        let torque = self.turn * wrench.torque() + self.origin.cross(&force);
        Wrench::on_fingertip(force * self.newton, torque * (self.newton * self.metre))
    }

    /// In another order too.
    fn touches(&self, touches: &[ShapeTouch]) -> Vec<ShapeTouch> {
        let change = |touch: &ShapeTouch| ShapeTouch {
            wrench: self.wrench(&touch.wrench),
            normal: self.turn * touch.normal,
        };
        touches.iter().rev().map(change).collect()
    }

    /// Lengths agree to so much \[m\]: rounding of positions of 30 mm, times what conditions them, or for
    /// searches where they end.
    fn close(&self, changed: &Vector3<f64>, point: &Vector3<f64>, allowed: f64) {
        let off = (changed / self.metre - (self.turn * point + self.origin)).largest();
        assert!(off < allowed, "{off:e}");
    }
}

#[test]
fn shapes_do_not_mind_units_order_and_frames() {
    let random = &mut Pcg64Mcg::seed_from_u64(64);
    // 1e4 roundings of 30 mm for what is linear.
    let allowed = 0.03 * 1e4 * f64::EPSILON;
    for _ in 0..40 {
        let change = Change::new(random);
        let same = |changed: f64, value: f64, allowed: f64| {
            assert!((changed / change.metre - value).abs() < allowed, "{changed:e} {value:e}");
        };
        let made = touches(random, 20, None, |n| CENTRE + n * 0.013);
        let made = all_noisy(random, &made);
        let (one, two) = (
            fit_sphere(&made, &WrenchNoise::exact_forces()).unwrap(),
            fit_sphere(&change.touches(&made), &WrenchNoise::exact_forces()).unwrap(),
        );
        same(two.shape.radius(), one.shape.radius(), allowed);
        change.close(&two.shape.centre(), &one.shape.centre(), allowed);
        same(two.deviations[0], one.deviations[0], allowed);

        let axis = vector(random).normalize();
        let made = touches(random, 20, Some(axis), |n| CENTRE + n * 0.008);
        let made = all_noisy(random, &made);
        let (one, two) = (
            fit_cylinder(&made, &WrenchNoise::exact_forces()).unwrap(),
            fit_cylinder(&change.touches(&made), &WrenchNoise::exact_forces()).unwrap(),
        );
        same(two.shape.radius(), one.shape.radius(), allowed);
        assert!(two.shape.axis().cross(&(change.turn * one.shape.axis())).norm() < 1e4 * f64::EPSILON);
        // Its centre is the point of the axis nearest to the origin, which has moved.
        let from = two.shape.centre() / change.metre - (change.turn * one.shape.centre() + change.origin);
        assert!(from.cross(&(change.turn * one.shape.axis())).norm() < allowed);

        let squared = Matrix3::from_diagonal(&Vector3::new(4e-4, 2.25e-4, 1.4e-4));
        let turned = turn(random);
        let squared = turned * squared * turned.transpose();
        let made = touches(random, 25, None, |n| CENTRE + squared * n / n.dot(&(squared * n)).sqrt());
        let made = all_noisy(random, &made);
        // Gauss-Newton ends at steps of 1e-12 of the size.
        let settled = 0.03 * 1e-10;
        let (one, two) = (
            fit_ellipsoid(&made, &WrenchNoise::exact_forces()).unwrap(),
            fit_ellipsoid(&change.touches(&made), &WrenchNoise::exact_forces()).unwrap(),
        );
        for k in 0..3 {
            same(two.shape.semi_axes[k], one.shape.semi_axes[k], settled);
        }
        let pose = |fit: &fingertip_calibration::geometry::PosedEllipsoid| fit.sensor_from_ellipsoid;
        change.close(&pose(&two.shape).origin(), &pose(&one.shape).origin(), settled);
        let found = pose(&two.shape).rotation().tr_mul(&(change.turn * pose(&one.shape).rotation()));
        assert!((found.abs() - Matrix3::identity()).largest() < 1e-8, "{found}");
        // Its axes stay along those of the frame, so only units, order and place may change.
        let moved = Change { turn: Matrix3::identity(), ..change };
        let (one, two) = (
            fit_aligned_ellipsoid(&made, &WrenchNoise::exact_forces()).unwrap(),
            fit_aligned_ellipsoid(&moved.touches(&made), &WrenchNoise::exact_forces()).unwrap(),
        );
        for k in 0..3 {
            same(two.shape.semi_axes[k], one.shape.semi_axes[k], settled);
        }
        moved.close(&two.shape.centre, &one.shape.centre, settled);
    }
}

#[test]
fn pivots_planes_and_poses_do_not_mind_units_order_and_frames() {
    let random = &mut Pcg64Mcg::seed_from_u64(65);
    let allowed = 0.03 * 1e4 * f64::EPSILON;
    for _ in 0..20 {
        let change = Change::new(random);
        let normal = vector(random).normalize();
        let pivots: Vec<Vec<_>> = (0..5)
            .map(|_| {
                let point = normal * 0.01 + vector(random).cross(&normal) * 0.005;
                (0..5)
                    .map(|_| {
                        let wrench = pressed(random, point, normal).wrench;
                        noisy(random, &wrench)
                    })
                    .collect()
            })
            .collect();
        let changed: Vec<Vec<_>> = pivots
            .iter()
            .rev()
            .map(|list| list.iter().rev().map(|wrench| change.wrench(wrench)).collect())
            .collect();
        let (one, two) = (
            fit_meeting_point(&pivots[0], &WrenchNoise::exact_forces()).unwrap(),
            fit_meeting_point(&changed[4], &WrenchNoise::exact_forces()).unwrap(),
        );
        change.close(&two.shape, &one.shape, 10.0 * allowed);
        let Ok(one) = fit_plane(&pivots, &normal, &WrenchNoise::exact_forces()) else { continue };
        let two = fit_plane(&changed, &(change.turn * normal), &WrenchNoise::exact_forces()).unwrap();
        assert!((two.shape.normal - change.turn * one.shape.normal).largest() < 1e-9);
        // The foot of the plane moves with the origin.
        let offset = one.shape.offset + two.shape.normal.dot(&change.origin);
        assert!((two.shape.offset / change.metre - offset).abs() < 1e-10, "{offset}");
        assert!((two.deviations[1] / one.deviations[1] - 1.0).abs() < 1e-6);

        let rotation = turn(random);
        let touches: Vec<_> = (0..8)
            .map(|_| {
                let point = vector(random) * 0.02;
                let wrench = Wrench::from_force_at(&(rotation * point + CENTRE), vector(random));
                (noisy(random, &wrench), point)
            })
            .collect();
        let changed: Vec<_> = touches
            .iter()
            .rev()
            .map(|(wrench, point)| (change.wrench(wrench), point * change.metre))
            .collect();
        let (one, two) = (
            fit_pose(&touches, &WrenchNoise::exact_forces()).unwrap(),
            fit_pose(&changed, &WrenchNoise::exact_forces()).unwrap(),
        );
        // The search ends at turns of 1e-13, or of 1e-10 if rounding lets it come no nearer.
        assert!((two.shape.rotation() - change.turn * one.shape.rotation()).largest() < 1e-9);
        change.close(&two.shape.origin(), &one.shape.origin(), 1e-10);
        assert!((change.point(&one.shape.origin()) - two.shape.origin()).largest() < 1e-10 * change.metre);
    }
}

/// From a sphere to shapes as flat as coins and as long as needles: the first steps would go far past them.
#[test]
fn flat_and_long_ellipsoids_come_back() {
    let random = &mut Pcg64Mcg::seed_from_u64(67);
    for axes in [[20.0, 18.0, 2.0], [20.0, 3.0, 2.0], [30.0, 12.0, 1.0], [15.0, 14.0, 13.0]] {
        let axes = Vector3::from(axes) * 1e-3;
        let squares = Matrix3::from_diagonal(&axes.component_mul(&axes));
        for _ in 0..10 {
            let turn = turn(random);
            let shape = turn * squares * turn.transpose();
            let point =
                |n: &Vector3<f64>, shape: &Matrix3<f64>| CENTRE + shape * n / n.dot(&(shape * n)).sqrt();
            let touched = touches(random, 40, None, |n| point(n, &shape));
            let fit = fit_ellipsoid(&touched, &WrenchNoise::exact_forces()).unwrap();
            assert!((fit.shape.semi_axes - axes).largest() < 1e-9, "{axes} {:?}", fit.shape);
            let found = fit.shape.sensor_from_ellipsoid;
            assert!((found.origin() - CENTRE).largest() < 1e-9 && fit.rms < 1e-12);
            let found = found.rotation() * squares * found.rotation().transpose();
            assert!((found - shape).largest() < 1e-9 * shape.largest());
            let aligned = touches(random, 40, None, |n| point(n, &squares));
            let fit = fit_aligned_ellipsoid(&aligned, &WrenchNoise::exact_forces()).unwrap();
            assert!((fit.shape.semi_axes - axes).largest() < 1e-9, "{axes} {:?}", fit.shape);
            assert!((fit.shape.centre - CENTRE).largest() < 1e-9 && fit.rms < 1e-12);
        }
    }
}

/// Rounding of a far origin is more than a step that is small: it ends all the same.
#[test]
fn a_pose_far_away_comes_back() {
    let random = &mut Pcg64Mcg::seed_from_u64(68);
    for distance in [1.0, 100.0, 1e4] {
        for _ in 0..10 {
            let rotation = turn(random);
            let origin = vector(random).normalize() * distance;
            let touches: Vec<_> = (0..10)
                .map(|_| {
                    let point = vector(random) * 0.02;
                    (Wrench::from_force_at(&(rotation * point + origin), vector(random)), point)
                })
                .collect();
            let fit = fit_pose(&touches, &WrenchNoise::exact_forces()).unwrap();
            let rounding = 1e3 * f64::EPSILON * distance;
            assert!((fit.shape.origin() - origin).largest() < rounding, "{distance}");
            assert!((fit.shape.rotation() - rotation).largest() < rounding / 0.02, "{distance}");
        }
    }
}

/// Under a force along the axis, the line of action tells nothing of where the axis lies.
#[test]
fn forces_along_the_axis_tell_nothing_of_a_cylinder() {
    let random = &mut Pcg64Mcg::seed_from_u64(69);
    let mut touches = touches(random, 12, Some(Vector3::z()), |n| CENTRE + n * 0.008);
    let without = fit_cylinder_along(&touches, &Vector3::z(), &WrenchNoise::exact_forces()).unwrap().shape;
    touches.push(ShapeTouch {
        wrench: Wrench::from_force_at(&(CENTRE + Vector3::y() * 0.05), -Vector3::z()),
        normal: Vector3::y(),
    });
    let with = fit_cylinder_along(&touches, &Vector3::z(), &WrenchNoise::exact_forces()).unwrap().shape;
    assert!((with.radius() - without.radius()).abs() < 1e-14 && (with.radius() - 0.008).abs() < 1e-12);
    assert!((with.centre() - without.centre()).largest() < 1e-14);
}

/// A touch with a number that is none is named, whether of its wrench or of its point.
#[test]
fn touches_of_a_pose_are_finite() {
    let random = &mut Pcg64Mcg::seed_from_u64(70);
    let good: Vec<_> = (0..6)
        .map(|_| {
            let point = vector(random) * 0.02;
            (Wrench::from_force_at(&point, vector(random)), point)
        })
        .collect();
    assert!(fit_pose(&good, &WrenchNoise::exact_forces()).is_ok());
    for bad in [f64::NAN, f64::INFINITY] {
        let mut touches = good.clone();
        touches[2].1.y = bad;
        assert!(matches!(
            fit_pose(&touches, &WrenchNoise::exact_forces()),
            Err(GeometryError::BadTouch { touch: 2, .. })
        ));
        let mut touches = good.clone();
        touches[2].0 = Wrench::on_fingertip(Vector3::new(bad, 0.0, 0.0), Vector3::zeros());
        assert!(matches!(
            fit_pose(&touches, &WrenchNoise::exact_forces()),
            Err(GeometryError::BadTouch { touch: 2, .. })
        ));
    }
}
