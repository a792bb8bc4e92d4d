//! All solutions on a surface that is not convex.

use fingertip_contact::{Search, SoftContact, SoftFingerSurface};
use fingertip_surfaces::{SmoothSurface, Torus};
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use crate::uniqueness::newton;
use crate::wrenches::{Case, Random};

fn all(torus: &Torus<f64>, wrench: &Wrench<f64>) -> (Vec<SoftContact<f64>>, Search<f64>) {
    let mut found = Vec::new();
    let search = torus.soft_contacts(wrench, None, |contact| found.push(contact));
    (found, search)
}

/// `τ²κ + (f·n)²`.
fn index(torus: &Torus<f64>, force: &Vector3<f64>, contact: &SoftContact<f64>) -> f64 {
    let bend = torus.shape_operator(&contact.point);
    // The Gaussian curvature: the sum of the principal minors, as one eigenvalue is zero.
    let minor = |i: usize, j: usize| bend[(i, i)] * bend[(j, j)] - bend[(i, j)] * bend[(j, i)];
    let curvature = minor(0, 1) + minor(1, 2) + minor(0, 2);
    contact.spin_torque.powi(2) * curvature + force.dot(&contact.normal).powi(2)
}

/// The true contact is among the solutions; all of them solve the equations; as many have a
/// positive as have a negative index, so their number is even.
///
/// A multi-start search of 300 such problems has been reported to find 1, 2, 3 or 4 contacts in 11, 256,
/// 3 and 30 of them. The contacts are the zeros of a continuous function on the circle of the ring, so
/// an odd number can only be a fold, of measure zero, or a search that missed one: with those that an
/// odd number lacks, these are 2 in 267 of 300 (89 %) and 4 in 33 (11 %). That is what is found here.
/// Only contacts that press are counted, all of the ring being active; those that pull are the
/// contacts of the opposite wrench.
#[test]
fn counts() {
    let torus = Torus::new(1.0, 0.35).unwrap();
    let mut random = Random::new(3);
    let mut counts = [0; 9];
    let count = 6000;
    for _ in 0..count {
        let spin = random.log_uniform(1e-3, 3.0);
        let case = Case::random(&mut random, &torus, 1.4, [spin / 1.4, spin / 1.4 * 1.0001], 1.0);
        let (found, search) = all(&torus, &case.wrench);
        assert!(matches!(search, Search::Complete), "{case:?} {found:?}");
        counts[found.len().min(8)] += 1;
        let force = case.wrench.force();
        let nearest = found.iter().map(|c| (c.point - case.point).norm()).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-6, "{nearest:e} {case:?} {found:?}");
        let mut sum = 0.0;
        for contact in &found {
            let residual =
                contact.point.cross(&force) + contact.normal * contact.spin_torque - case.wrench.torque();
            assert!(residual.norm() < 1e-12 * (1.0 + case.wrench.torque().norm()), "{residual}");
            assert!(torus.level(&contact.point).value.abs() < 1e-13);
            assert!(force.dot(&contact.normal) < 0.0);
            sum += index(&torus, &force, contact).signum();
        }
        assert!(sum.abs() < 0.5 && found.len() % 2 == 0, "{case:?} {found:?}");
    }
    println!("torus R = 1, r = 0.35: 0..8 contacts in {counts:?} of {count}");
    let share = |k: usize| f64::from(counts[k]) / f64::from(count);
    assert!((share(2) - 267.0 / 300.0).abs() < 0.03 && (share(4) - 33.0 / 300.0).abs() < 0.03);
    assert!(counts[0] + counts[1] + counts[3] + counts[5] == 0);
}

/// Newton's method from points all over the ring finds no contact that is missing. From fewer starts it
/// misses some, and then counts odd numbers: from forty about as many as have been reported.
#[test]
fn nothing_is_missed() {
    const STARTS: [usize; 3] = [8, 40, 300];
    let torus = Torus::new(1.0, 0.35).unwrap();
    let mut random = Random::new(5);
    let mut counts = [[0; 9]; 3];
    for _ in 0..300 {
        // Spin torques from almost none, where the wrench's axis rules, to such as bend it round.
        let spin = random.log_uniform(1e-6, 10.0);
        let case = Case::random(&mut random, &torus, 1.4, [spin / 1.4, spin / 1.4 * 1.0001], 1.0);
        let (ours, _) = all(&torus, &case.wrench);
        let mut distinct: Vec<Vector3<f64>> = Vec::new();
        for start in 1..=300 {
            let found = newton(&torus, &case.wrench, random.place(&torus, 1.4).0, &mut random);
            if let Some((point, true)) = found {
                let apart = |other: &Vector3<f64>| (other - point).norm();
                assert!(ours.iter().any(|c| apart(&c.point) < 1e-6), "{point} {case:?} {ours:?}");
                if distinct.iter().all(|other| apart(other) > 1e-6) {
                    distinct.push(point);
                }
            }
            for (counts, starts) in counts.iter_mut().zip(STARTS) {
                counts[distinct.len().min(8)] += usize::from(start == starts);
            }
        }
        assert!(distinct.len() <= ours.len());
    }
    println!("multi-start Newton, 0..8 contacts of 300 problems: {counts:?} from {STARTS:?} starts");
    let odd = counts.map(|counts| counts[1] + counts[3]);
    assert!(odd[0] > odd[1] && odd[1] > 0 && odd[2] == 0, "{odd:?}");
}
