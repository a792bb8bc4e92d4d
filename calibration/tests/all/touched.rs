//! Touches that a design is judged by, spread as is said, and gauges that are not where they should be.

use core::f64::consts::PI;

use fingertip_calibration::design::{
    DesignTouch, LoadedTube, Material, NominalLoads, Placement, TubeSpace, Wall,
};
use fingertip_calibration::nalgebra::{Vector3, Vector6};
use fingertip_surfaces::{Plane, Sphere};
use rand::SeedableRng as _;
use rand_pcg::Pcg64Mcg;

/// Mean of a figure over touches.
fn mean(touches: &[DesignTouch], figure: impl Fn(&DesignTouch) -> f64) -> f64 {
    touches.iter().map(figure).sum::<f64>() / touches.len() as f64
}

fn ratio(touch: &DesignTouch) -> f64 {
    let normal = -touch.force.dot(&touch.normal);
    (touch.force + touch.normal * normal).norm() / normal
}

#[test]
fn touches_of_a_tip_are_spread_evenly() {
    let half_angle = 1.1_f64;
    let touches = DesignTouch::on_sphere(13e-3, half_angle, 0.6, 2.5).unwrap();
    assert_eq!(touches.len(), 1600);
    for touch in &touches {
        assert!((touch.normal.norm() - 1.0).abs() < 1e-12 && (touch.force.norm() - 2.5).abs() < 1e-12);
        assert!((touch.point - touch.normal * 13e-3).norm() < 1e-15);
        assert!(
            touch.normal.x >= half_angle.cos() && ratio(touch) <= 0.6 && touch.force.dot(&touch.normal) < 0.0
        );
    }
    // Equal areas: the height is spread evenly, and no direction about the pole is preferred.
    let close = |found: f64, expected: f64, allowed: f64| {
        assert!((found - expected).abs() < allowed, "{found} instead of {expected}");
    };
    let low = half_angle.cos();
    close(mean(&touches, |t| t.normal.x), 0.5 * (1.0 + low), 1e-12);
    close(mean(&touches, |t| t.normal.x.powi(2)), (1.0 - low.powi(3)) / (3.0 * (1.0 - low)), 1e-4);
    let across = 1.0 - mean(&touches, |t| t.normal.x.powi(2));
    close(mean(&touches, |t| t.normal.y), 0.0, 0.01);
    close(mean(&touches, |t| t.normal.z), 0.0, 0.01);
    close(mean(&touches, |t| t.normal.y * t.normal.z), 0.0, 0.01);
    close(mean(&touches, |t| t.normal.y.powi(2)), 0.5 * across, 0.01);
    // Even over the disc of ratios: half of its square in the mean, and no direction preferred.
    close(mean(&touches, |t| ratio(t).powi(2)), 0.5 * 0.36, 1e-12);
    close(mean(&touches, |t| ratio(t).powi(4)), 0.36 * 0.36 / 3.0, 1e-3);
    let sideways = touches[..8].iter().map(|t| {
        let normal = -t.force.dot(&t.normal);
        (t.force + t.normal * normal) / normal
    });
    let sum: Vector3<f64> = sideways.sum();
    assert!(sum.norm() / 8.0 < 0.2, "{sum}");
    // Without friction there is one force, along the normal.
    let plain = DesignTouch::on_sphere(13e-3, half_angle, 0.0, 2.5).unwrap();
    assert_eq!(plain.len(), 200);
    assert!(plain.iter().all(|touch| (touch.force + touch.normal * 2.5).norm() < 1e-12));
    assert!(DesignTouch::on_sphere(13e-3, PI, 0.6, 2.5).is_ok());
    for (radius, angle, friction, force) in [
        (0.0, 1.0, 0.5, 1.0),
        (1e-3, 0.0, 0.5, 1.0),
        (1e-3, PI + 1e-9, 0.5, 1.0),
        (1e-3, 1.0, -0.1, 1.0),
        (1e-3, 1.0, 0.5, 0.0),
    ] {
        assert!(
            DesignTouch::on_sphere(radius, angle, friction, force).is_err(),
            "{radius} {angle} {friction} {force}"
        );
    }
}

#[test]
fn touches_of_a_surface_are_spread_by_its_area() {
    let (centre, radius) = (Vector3::new(0.01, -0.02, 0.03), 7e-3);
    let sphere = Sphere::new(centre, radius).unwrap();
    // The ball of lines is not about the sphere.
    let about = centre + Vector3::new(1e-3, 2e-3, -1e-3);
    let touches = DesignTouch::on_surface(&sphere, about, 12e-3, 0.0, 3.0).unwrap();
    assert!(touches.len() > 8_000, "{}", touches.len());
    for touch in &touches {
        assert!(((touch.point - centre).norm() - radius).abs() < 1e-12);
        assert!((touch.point - centre - touch.normal * radius).norm() < 1e-12);
        assert!((touch.force + touch.normal * 3.0).norm() < 1e-12);
    }
    for i in 0..3 {
        assert!(mean(&touches, |t| t.normal[i]).abs() < 0.02);
        for j in 0..3 {
            let expected = if i == j { 1.0 / 3.0 } else { 0.0 };
            assert!((mean(&touches, |t| t.normal[i] * t.normal[j]) - expected).abs() < 0.01, "{i} {j}");
        }
    }
    // Lines through a disc of 12 mm meet a sphere of 7 mm in the share of their areas, twice each.
    let share = touches.len() as f64 / 2.0 / 20_000.0;
    let around = DesignTouch::on_surface(&sphere, centre, 14e-3, 0.0, 3.0).unwrap();
    for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
        let expected = if i == j { 1.0 / 3.0 } else { 0.0 };
        assert!((mean(&around, |t| t.normal[i] * t.normal[j]) - expected).abs() < 1e-3, "{i} {j}");
    }
    assert!((0..3).all(|i| mean(&around, |t| t.normal[i]).abs() < 5e-3));
    let concentric = around.len() as f64 / 40_000.0;
    assert!((share - 49.0 / 144.0).abs() < 0.01 && (concentric - 0.25).abs() < 2e-3, "{share} {concentric}");
    let with_friction = DesignTouch::on_surface(&sphere, centre, 14e-3, 0.4, 3.0).unwrap();
    assert!(with_friction.len().is_multiple_of(8) && with_friction.iter().all(|touch| ratio(touch) <= 0.4));
    assert!(DesignTouch::on_surface(&sphere, centre, 0.0, 0.4, 3.0).is_err());
}

#[test]
fn of_an_unbounded_surface_the_part_within_the_ball_is_touched() {
    let plane = Plane::new(Vector3::new(0.0, 0.0, 5e-3), Vector3::z()).unwrap();
    let (about, reach) = (Vector3::new(1e-3, 0.0, 5e-3), 20e-3);
    let touches = DesignTouch::on_surface(&plane, about, reach, 0.0, 1.0).unwrap();
    let share = |r: f64| {
        let within = touches.iter().filter(|touch| (touch.point - about).norm() <= r);
        within.count() as f64 / touches.len() as f64
    };
    assert!(
        share(reach * (1.0 + 1e-9)) == 1.0 && (share(reach / 2.0) - 0.25).abs() < 0.02,
        "{}",
        share(0.01)
    );
}

#[test]
fn misplaced_gauges_are_off_by_what_is_stated() {
    let loads = NominalLoads::equal(10.0, 0.1).unwrap();
    let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 40e-3, loads };
    let space = TubeSpace::free(6, (-20e-3, 20e-3), tube, Wall::Fixed(0.2e-3)).unwrap();
    let values: Vec<f64> = (0..18).map(|i| 1e-3 + 0.01 * f64::from(i)).collect();
    let layout = space.layout(&values).unwrap();
    let placement = Placement { angle: 0.02, position: 0.1e-3 };
    let random = &mut Pcg64Mcg::seed_from_u64(131);
    let (mut sum, mut squares) = (Vector3::zeros(), Vector3::zeros());
    let mut together = Vector3::zeros();
    for _ in 0..2000 {
        let made = placement.misplace(&layout, random);
        for (gauge, drawn) in made.gauges.iter().zip(&layout.gauges) {
            let off = Vector3::new(
                (gauge.z - drawn.z) / 0.1e-3,
                (gauge.theta - drawn.theta) * 5e-3 / 0.1e-3,
                (gauge.q - drawn.q) / 0.02,
            );
            sum += off;
            squares += off.component_mul(&off);
            together += Vector3::new(off.x * off.y, off.y * off.z, off.z * off.x);
        }
        assert_eq!((made.beam, made.bridges.len()), (layout.beam, 0));
    }
    // Of 12 000 errors the mean is known to 0.01, the variance to 0.013.
    for i in 0..3 {
        assert!(sum[i].abs() < 12_000.0 * 0.04 && (squares[i] / 12_000.0 - 1.0).abs() < 0.06, "{squares}");
        assert!(together[i].abs() < 12_000.0 * 0.04, "{together}");
    }
    for bad in [-1e-9, f64::NAN, f64::INFINITY] {
        assert!(Placement { angle: bad, ..placement }.validate().is_err());
        assert!(Placement { position: bad, ..placement }.validate().is_err());
    }
    assert!(Placement { angle: 0.0, position: 0.0 }.validate().is_ok());
}

/// Two gauges on either side of the angle zero are near each other.
#[test]
fn the_closest_gauges_are_measured_around_the_wall() {
    let loads = NominalLoads::equal(10.0, 0.1).unwrap();
    let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 40e-3, loads };
    let space = TubeSpace::free(6, (-20e-3, 20e-3), tube, Wall::Fixed(0.2e-3)).unwrap();
    let places = [(0.0, 0.1), (3e-3, 6.2), (0.0, 0.1), (15e-3, 2.0), (-15e-3, 4.0), (9e-3, 3.0)];
    let values: Vec<f64> = places.iter().flat_map(|(z, theta)| [*z, *theta, 0.3]).collect();
    let layout = space.layout(&values).unwrap();
    let (distance, first, second) = layout.closest_gauges().unwrap();
    // 0.1 and 6.2 rad are 0.1832 apart the short way round. The first and the third are stacked, which does not count.
    let around = 5e-3 * (0.1 + 2.0 * PI - 6.2);
    assert!((distance - around.hypot(3e-3)).abs() < 1e-12, "{distance}");
    assert_eq!((first, second), (0, 1));
    // And in the other order.
    let values: Vec<f64> = places.iter().rev().flat_map(|(z, theta)| [*z, *theta, 0.3]).collect();
    let (distance, first, second) = space.layout(&values).unwrap().closest_gauges().unwrap();
    assert!((distance - around.hypot(3e-3)).abs() < 1e-12, "{distance}");
    assert_eq!((first, second), (3, 4));
    let stacked: Vec<f64> = (0..6).flat_map(|_| [1e-3, 0.2, 0.3]).collect();
    assert_eq!(space.layout(&stacked).unwrap().closest_gauges(), None);
    let strains = layout.normalised(2.0, &loads).unwrap();
    let single = layout.normalised(1.0, &loads).unwrap();
    assert_eq!(strains, single * 2.0);
    assert_eq!(loads.components(), Vector6::new(10.0, 10.0, 10.0, 0.1, 0.1, 0.1));
}

/// Where the gauges of each family stand: along, around and turned.
#[test]
fn families_of_tubes_have_their_gauges_where_they_say() {
    use core::f64::consts::{FRAC_PI_2, TAU};
    let loads = NominalLoads::equal(10.0, 0.1).unwrap();
    let tube = LoadedTube { material: Material::ALUMINIUM_7075_T6, radius: 5e-3, length: 40e-3, loads };
    let (wall, radius, z, angle) = (Wall::Fixed(0.2e-3), (2e-3, 15e-3), (-20e-3, 20e-3), (0.1, 1.5));
    let are = |space: &TubeSpace, values: &[f64], expected: &[(f64, f64, f64)]| {
        let layout = space.layout(values).unwrap();
        assert_eq!(layout.gauges.len(), expected.len());
        for (gauge, (z, theta, q)) in layout.gauges.iter().zip(expected) {
            let turns = (gauge.theta - theta) / TAU;
            assert!(
                (turns - turns.round()).abs() < 1e-12 && (gauge.z - z).abs() < 1e-15,
                "{gauge:?} {theta}"
            );
            assert!((gauge.q - q).abs() < 1e-15, "{gauge:?} {q}");
        }
        layout.beam.radius
    };
    for (count, alternating) in [(3, false), (4, true), (5, true)] {
        let space = TubeSpace::rings(2, count, alternating, radius, z, tube, wall).unwrap();
        let (first, second) = ([1e-3, 0.3, 0.7], [-4e-3, 2.0, 1.9]);
        let values = [&[6e-3][..], &first, &second].concat();
        let ring = |[z, theta, q]: [f64; 3]| {
            (0..count).map(move |place| {
                let sign = if alternating && place % 2 == 1 { -1.0 } else { 1.0 };
                (z, theta + TAU * place as f64 / count as f64, sign * q)
            })
        };
        let expected: Vec<_> = ring(first).chain(ring(second)).collect();
        assert_eq!(are(&space, &values, &expected), 6e-3);
    }
    let space = TubeSpace::rosettes(3, radius, angle, z, tube, wall).unwrap();
    let pairs = (0..3).flat_map(|place| [0.4, -0.4].map(|q| (5e-3, TAU * f64::from(place) / 3.0, q)));
    assert_eq!(are(&space, &[7e-3, 0.4, 5e-3], &pairs.collect::<Vec<_>>()), 7e-3);
    let space = TubeSpace::free(6, z, tube, wall).unwrap();
    let places: Vec<_> = (0..6).map(|i| f64::from(i) * 0.3).map(|x| (0.01 * x, 2.0 * x, x + 0.1)).collect();
    let values: Vec<f64> = places.iter().flat_map(|(z, theta, q)| [*z, *theta, *q]).collect();
    assert_eq!(are(&space, &values, &places), 5e-3);
    // Figure 3 of Bicchi & Dario 1987: four around the ring, and two behind.
    let space = TubeSpace::bicchi_dario(radius, angle, (2e-3, 20e-3), tube, wall).unwrap();
    let expected = [
        (0.0, 2.0, -0.5),
        (0.0, 1.0, 0.5),
        (0.0, 0.0, -0.5),
        (0.0, 3.0, 0.5),
        (9e-3, 2.0, -0.5),
        (9e-3, 1.0, 0.5),
    ]
    .map(|(z, quarters, q)| (z, quarters * FRAC_PI_2, q));
    assert_eq!(are(&space, &[4e-3, 0.5, 9e-3], &expected), 4e-3);
}
