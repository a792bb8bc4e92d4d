//! Ferrari and Canny's ball against closed forms, against cone programs of another's solver, against a search of its
//! own, and turned, moved and in other units.

use fingertip_hand::{FingerLimits, Grasp, GraspContact, GripOutcome, LeastGrip, Metric};
use fingertip_wrench::{RigidTransform, Wrench};
use nalgebra::{Matrix6, Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::support::clarabel_oracle::{self, Oracle, OracleReach};
use crate::support::{TestHand, places, vector};

type Contact = GraspContact<f64, TestHand>;

fn soft(point: Vector3<f64>, inward: Vector3<f64>, friction: f64, arm: f64) -> Option<Contact> {
    GraspContact::soft(point, inward, friction, arm).ok()
}

/// Soft fingers at both ends of each axis, `half` from the centre.
fn octahedron(half: f64, friction: f64, arm: f64) -> Grasp<f64, 6, TestHand> {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut contacts = [None; 6];
    for (i, contact) in contacts.iter_mut().enumerate() {
        let outward = axes[i / 2] * if i % 2 == 0 { 1.0 } else { -1.0 };
        *contact = soft(outward * half, -outward, friction, arm);
    }
    Grasp::new(contacts)
}

/// The load that a direction of the metric stands for.
fn load<const N: usize>(
    grasp: &Grasp<f64, N, TestHand>,
    u: &Vector6<f64>,
    length: f64,
) -> Wrench<f64, TestHand> {
    let (force, torque) = (Vector3::new(u[0], u[1], u[2]), Vector3::new(u[3], u[4], u[5]) * length);
    Wrench::on_fingertip(force, torque + grasp.centre().cross(&force))
}

/// How much of a unit load an effort of 1 N bears, by cone programs of another's solver.
fn radius<const N: usize>(grasp: &Grasp<f64, N, TestHand>, u: &Vector6<f64>, metric: Metric<f64>) -> f64 {
    let load = load(grasp, u, metric.length());
    match metric {
        Metric::Total { .. } => {
            match clarabel_oracle::solve(grasp, &[FingerLimits::<f64, 1>::none(); N], &load) {
                Oracle::Held { cost, .. } => 1.0 / cost,
                other => panic!("{other:?}"),
            }
        }
        Metric::Each { .. } => {
            let limits = [FingerLimits::<f64, 1>::none().with_greatest_normal(1.0).unwrap(); N];
            match clarabel_oracle::reach(grasp, &limits, &Wrench::zero(), &load) {
                OracleReach::Times(times) => times,
                other => panic!("{other:?}"),
            }
        }
    }
}

/// The most that 1 N of effort gives along a unit wrench on the object, by geometry, and the wrench that does.
fn support<const N: usize>(
    grasp: &Grasp<f64, N, TestHand>,
    u: &Vector6<f64>,
    metric: Metric<f64>,
) -> (f64, Vector6<f64>) {
    let length = metric.length();
    let (along, turn) = (Vector3::new(u[0], u[1], u[2]), Vector3::new(u[3], u[4], u[5]) / length);
    let (mut most, mut sum) = (0.0, Vector6::zeros());
    for contact in grasp.contacts().iter().flatten() {
        let (normal, arm) = (contact.normal(), contact.place() - grasp.centre());
        let velocity = along + turn.cross(&arm);
        let sideways = velocity - normal * velocity.dot(&normal);
        let spin = turn.dot(&normal) * contact.arm();
        let size = sideways.norm().hypot(spin).max(1e-300);
        let gain = velocity.dot(&normal) + contact.friction() * size;
        let force = normal + sideways * (contact.friction() / size);
        let torque = arm.cross(&force) + normal * (contact.friction() * spin / size * contact.arm());
        let wrench = Vector6::from_iterator(force.iter().chain((torque / length).iter()).copied());
        match metric {
            Metric::Total { .. } if gain > most => (most, sum) = (gain, wrench),
            Metric::Each { .. } if gain > 0.0 => (most, sum) = (most + gain, sum + wrench),
            _ => {}
        }
    }
    (most, sum)
}

/// The weakest load in the metric, which must be of unit length.
fn weakest<const N: usize>(grasp: &Grasp<f64, N, TestHand>, metric: Metric<f64>) -> Vector6<f64> {
    let found = grasp.ball(metric).unwrap().weakest;
    let torque = found.torque_about(&grasp.centre()) / metric.length();
    let u = Vector6::from_iterator(found.force().iter().chain(torque.iter()).copied());
    assert!((u.norm() - 1.0).abs() < 1e-9);
    u
}

/// Two soft fingers with 1 N for both: weakest is the torque about their line, `μe/ℓ`, and what they bear along the
/// axes is 1, μ, μ, μe/ℓ, μa/ℓ, μa/ℓ.
#[test]
fn two_soft_fingers_by_formula() {
    for (friction, arm, half, length) in
        [(0.5, 3e-3, 0.02, 0.02), (0.9, 5e-3, 0.04, 0.03), (0.2, 1e-3, 0.01, 0.05)]
    {
        let at = |side: f64| soft(Vector3::x() * (side * half), -Vector3::x() * side, friction, arm);
        let grasp = Grasp::new([at(-1.0), None, at(1.0)]);
        let ball = grasp.ball(Metric::Total { length }).unwrap();
        let radius = friction * arm / length;
        assert!((ball.found / radius - 1.0).abs() < 1e-6, "{} {radius}", ball.found);
        let radii = [1.0, friction, friction, radius, friction * half / length, friction * half / length];
        let certified = radii.map(|r| 1.0 / (r * r)).iter().sum::<f64>().powf(-0.5);
        assert!((ball.certified / certified - 1.0).abs() < 1e-5, "{} {certified}", ball.certified);
        let u = weakest(&grasp, Metric::Total { length });
        assert!((u[3].abs() - 1.0).abs() < 1e-9, "{u}");
        // Each 1 N: a push along the line takes from one what it gives the other, so a little of it comes free.
        let ball = grasp.ball(Metric::Each { length }).unwrap();
        let expected = 2.0 * radius / (1.0 + radius * radius).sqrt();
        assert!((ball.found / expected - 1.0).abs() < 5e-4, "{} {expected}", ball.found);
    }
}

/// Six soft fingers around a ball, each 1 N, by formula: torques are weakest, `μ(4a + 2e)/ℓ`, and forces `1 + 4μ`.
#[test]
fn six_soft_fingers_by_formula() {
    for (friction, arm, half, length) in [(0.5, 3e-3, 0.02, 0.06), (1.1, 6e-3, 0.03, 0.2)] {
        let grasp = octahedron(half, friction, arm);
        let ball = grasp.ball(Metric::Each { length }).unwrap();
        let (torque, force) = (friction * (4.0 * half + 2.0 * arm) / length, 1.0 + 4.0 * friction);
        assert!((ball.found / torque - 1.0).abs() < 1e-6, "{} {torque}", ball.found);
        let certified = (3.0 / (force * force) + 3.0 / (torque * torque)).powf(-0.5);
        assert!((ball.certified / certified - 1.0).abs() < 1e-5, "{} {certified}", ball.certified);
        let u = weakest(&grasp, Metric::Each { length });
        assert!((u.fixed_rows::<3>(3).amax() - 1.0).abs() < 1e-9, "{u}");
    }
}

/// What six axes certify is what cone programs of another's solver give for them, both ways: the axes into which a
/// reflection turns those of coordinates, with the first through the weakest load.
#[test]
fn the_certificate_is_that_of_its_axes() {
    let mut rng = Pcg64Mcg::seed_from_u64(54);
    let (mut closed, mut one_sided) = (0, 0);
    while closed < 12 {
        let grasp = Grasp::new(places::<4>(&mut rng, 4).map(|p| p.map(|p| p.contact::<f64>())));
        if grasp.force_closure() != Some(true) {
            continue;
        }
        for metric in [Metric::Total { length: 0.03 }, Metric::Each { length: 0.03 }] {
            closed += 1;
            let first = -weakest(&grasp, metric);
            // Of the two reflections the one that cancels no digits.
            let mirror = (first + Vector6::x() * first.x.signum()).normalize();
            let axes = Matrix6::identity() - mirror * mirror.transpose() * 2.0;
            let mut sum = 0.0;
            for axis in axes.column_iter() {
                let (one, other) =
                    (radius(&grasp, &axis.into_owned(), metric), radius(&grasp, &-axis.into_owned(), metric));
                one_sided += u32::from((one / other - 1.0).abs() > 0.1);
                sum += one.min(other).powi(-2);
            }
            let (certified, ball) = (sum.powf(-0.5), grasp.ball(metric).unwrap());
            assert!((ball.certified / certified - 1.0).abs() < 1e-4, "{} {certified}", ball.certified);
        }
    }
    assert!(one_sided > 25, "{one_sided}");
}

/// The same ball in the same metric, wherever the grasp is, however it is turned, and in any unit of length.
#[test]
fn ball_moves_with_its_grasp() {
    let mut rng = Pcg64Mcg::seed_from_u64(51);
    let mut closed = 0;
    for _ in 0..10 {
        let grasp = Grasp::new(places::<4>(&mut rng, 4).map(|p| p.map(|p| p.contact::<f64>())));
        let turn: RigidTransform<f64, TestHand, TestHand> =
            RigidTransform::from_axis_angle(vector(&mut rng) * 3.0, vector(&mut rng)).unwrap();
        let moved = Grasp::new(grasp.contacts().map(|c| c.map(|c| c.expressed_in(&turn))));
        let larger = Grasp::new(grasp.contacts().map(|c| {
            let c = c.unwrap();
            let (place, arm) = (c.place() * 8.0, c.arm() * 8.0);
            GraspContact::soft(place, c.normal(), c.friction(), arm)
                .or_else(|_| GraspContact::point(place, c.normal(), c.friction()))
                .ok()
        }));
        for make in [|length| Metric::Total { length }, |length| Metric::Each { length }] {
            let [here, there, large] = [(grasp, 0.03), (moved, 0.03), (larger, 0.24)]
                .map(|(grasp, length)| grasp.ball(make(length)).unwrap());
            assert!((here.found - there.found).abs() <= 1e-3 * here.found, "{} {}", here.found, there.found);
            assert!((here.found - large.found).abs() <= 1e-9 * here.found, "{} {}", here.found, large.found);
            assert!((here.certified - large.certified).abs() <= 1e-6 * here.certified);
            closed += u32::from(here.found > 0.0);
        }
    }
    assert!(closed > 5, "{closed}");
}

/// No search from other starts, by other steps, finds much less; the mean says how often it finds anything less.
#[test]
fn another_search_finds_nothing_less() {
    let mut rng = Pcg64Mcg::seed_from_u64(52);
    let (mut closed, mut sum) = (0, 0.0);
    while closed < 14 {
        let grasp = Grasp::new(places::<4>(&mut rng, 4).map(|p| p.map(|p| p.contact::<f64>())));
        for metric in [Metric::Total { length: 0.03 }, Metric::Each { length: 0.03 }] {
            let ball = grasp.ball(metric).unwrap();
            if !(ball.found > 1e-3) {
                continue;
            }
            closed += 1;
            let mut least = f64::MAX;
            for _ in 0..40 {
                let mut u = Vector6::from_fn(|_, _| rng.random_range(-1.0..1.0)).normalize();
                let mut step = 0.3;
                let mut here = support(&grasp, &u, metric);
                while step > 1e-6 {
                    let slope = here.1 - u * here.0;
                    let next = (u - slope * (step / slope.norm().max(1e-300))).normalize();
                    let there = support(&grasp, &next, metric);
                    if there.0 < here.0 { (u, here) = (next, there) } else { step *= 0.7 }
                }
                least = least.min(here.0);
            }
            assert!(ball.found <= 1.005 * least, "{} {least}", ball.found);
            sum += (ball.found / least - 1.0).max(0.0);
        }
    }
    println!("{closed} balls: what is found is {:.1e} too much in the mean", sum / f64::from(closed));
    assert!(sum < 2e-4 * f64::from(closed), "{}", sum / f64::from(closed));
}

/// Where there is no force closure the ball is nothing, and the load that is told cannot be held, however firmly.
#[test]
fn without_closure_a_load_is_told_that_none_holds() {
    let mut rng = Pcg64Mcg::seed_from_u64(53);
    let mut open = 0;
    for _ in 0..100 {
        let touching = rng.random_range(1..=4);
        let grasp = Grasp::new(places::<4>(&mut rng, touching).map(|p| p.map(|p| p.contact::<f64>())));
        if grasp.force_closure() != Some(false) {
            continue;
        }
        open += 1;
        let metric = Metric::Each { length: 0.03 };
        let ball = grasp.ball(metric).unwrap();
        assert_eq!((ball.found, ball.certified), (0.0, 0.0));
        let u = weakest(&grasp, metric);
        let load = load(&grasp, &u, metric.length());
        // What the fingers give along it is nothing, but for the solver's digits; with a little more they give less.
        assert!(support(&grasp, &-u, metric).0 < 1e-6, "{u}");
        let found = LeastGrip::new().solve(&grasp, &[FingerLimits::<f64, 0>::none(); 4], &load);
        assert!(matches!(found, GripOutcome::CannotHold(_)), "{found:?}");
    }
    assert!(open > 40, "{open}");
}

/// Rough fingers that all push the way a point of a turning object goes there: what nothing bears lies in a narrow cone
/// about that movement, and so in one orthant of loads: each axis is borne one way and not the other. In every orthant such a
/// hand is found out.
#[test]
fn what_is_not_borne_is_found_in_every_orthant() {
    let length = 0.03;
    let places = [Vector3::new(1.0, 1.0, 1.0), Vector3::new(-1.0, -1.0, 1.0)]
        .map(|p| [p, Vector3::new(p.y, -p.x, -p.z)])
        .as_flattened()
        .iter()
        .map(|p| p * (length / 3_f64.sqrt()))
        .collect::<Vec<_>>();
    for orthant in 0..64 {
        let sign = |axis: u32| if orthant >> axis & 1 == 1 { 1.0 } else { -1.0 };
        let velocity = Vector3::new(sign(0), sign(1), sign(2));
        let turning = Vector3::new(sign(3), sign(4), sign(5)) / length;
        let grasp = Grasp::<f64, 4, TestHand>::new([0, 1, 2, 3].map(|finger| {
            let place = places[finger];
            let goes = velocity + turning.cross(&place);
            soft(place, goes.normalize(), 10.0, 0.02 * length)
        }));
        assert!(grasp.contacts().iter().all(Option::is_some), "{orthant:b}");
        let ball = grasp.ball(Metric::Each { length }).unwrap();
        assert_eq!((ball.found, ball.certified), (0.0, 0.0), "{orthant:b}");
        let u = weakest(&grasp, Metric::Each { length });
        assert!(support(&grasp, &-u, Metric::Each { length }).0 < 1e-6, "{orthant:b}: {u}");
        for axis in Matrix6::identity().column_iter() {
            let is_held = |u: Vector6<f64>| {
                let load = load(&grasp, &u, length);
                let limits = [FingerLimits::<f64, 0>::none(); 4];
                matches!(LeastGrip::new().solve(&grasp, &limits, &load), GripOutcome::Held(_))
            };
            assert_ne!(is_held(axis.into_owned()), is_held(-axis), "{orthant:b}");
        }
    }
}

/// A certificate is never more than what is borne, friction without bound or without any: where its squares leave the
/// range of the type there is none.
#[test]
fn extreme_friction_is_not_overstated() {
    for friction in [1e-200, 1e-9, 1.0, 1e9, 1e200] {
        let (half, arm, length) = (0.02, 3e-3, 0.06);
        let ball = octahedron(half, friction, arm).ball(Metric::Each { length }).unwrap();
        let (torque, force) = (friction * (4.0 * half + 2.0 * arm) / length, 1.0 + 4.0 * friction);
        let certified = (3.0 / (force / torque).powi(2) + 3.0).powf(-0.5) * torque;
        assert!(ball.certified <= certified * (1.0 + 1e-5), "{friction}: {} {certified}", ball.certified);
        assert!(
            friction > 1e100 || ball.found <= torque * (1.0 + 1e-6),
            "{friction}: {} {torque}",
            ball.found
        );
        assert!(ball.certified >= 0.0 && ball.certified <= ball.found);
    }
}

/// In single precision as in double, to what half its digits tell.
#[test]
fn single_precision_finds_the_same_ball() {
    let mut rng = Pcg64Mcg::seed_from_u64(55);
    let (mut closed, mut certified) = (0, 0);
    for _ in 0..16 {
        let places = places::<4>(&mut rng, 4);
        let wide = Grasp::new(places.map(|p| p.map(|p| p.contact::<f64>())));
        let single = Grasp::new(places.map(|p| p.map(|p| p.contact::<f32>())));
        let balls = [
            (wide.ball(Metric::Total { length: 0.03 }), single.ball(Metric::Total { length: 0.03 })),
            (wide.ball(Metric::Each { length: 0.03 }), single.ball(Metric::Each { length: 0.03 })),
        ];
        for (wide, single) in balls.map(|(wide, single)| (wide.unwrap(), single.unwrap())) {
            // Nearer to none than that, single precision may not tell.
            if wide.found > 1e-2 {
                closed += 1;
                let off = (wide.found - f64::from(single.found)).abs() / wide.found;
                assert!(off < 1e-2, "{} {}", wide.found, single.found);
                certified += u32::from(single.certified > 0.0);
                assert!(single.certified <= single.found);
                assert!(f64::from(single.certified) < wide.found * 1.001);
            }
        }
    }
    // Where a program is not decided there is no certificate.
    assert!(closed > 4 && certified * 10 > closed * 7, "{certified} of {closed}");
}
