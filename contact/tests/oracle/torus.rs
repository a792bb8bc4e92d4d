//! Every crossing of the torus, counted by a Sturm sequence.

use fingertip_surfaces::*;
use fingertip_wrench::Line;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::big::{Big, big3, dot};

/// The quartic of the torus in `t`, lowest power first.
fn quartic(point: [f64; 3], direction: [f64; 3], ring: f64, tube: f64) -> Vec<Big> {
    let (p, u) = (big3(point), big3(direction));
    let (ring, tube) = (Big::new(ring), Big::new(tube));
    let (uu, pu, pp) = (dot(&u, &u), dot(&p, &u), dot(&p, &p));
    // (|x|² + R² − r²)² − 4·R²·(x² + y²), with |x|² = uu·t² + 2·pu·t + pp.
    let k = &pp + &(&(&ring * &ring) - &(&tube * &tube));
    let four = &Big::new(4.0) * &(&ring * &ring);
    let two = Big::new(2.0);
    let plane = |a: &[Big; 3], b: &[Big; 3]| &(&a[0] * &b[0]) + &(&a[1] * &b[1]);
    vec![
        &(&k * &k) - &(&four * &plane(&p, &p)),
        &(&(&Big::new(4.0) * &k) * &pu) - &(&(&two * &four) * &plane(&p, &u)),
        &(&(&(&two * &k) * &uu) + &(&Big::new(4.0) * &(&pu * &pu))) - &(&four * &plane(&u, &u)),
        &Big::new(4.0) * &(&uu * &pu),
        &uu * &uu,
    ]
}

fn remainder(a: &[Big], b: &[Big]) -> Vec<Big> {
    let mut rest = a.to_vec();
    while rest.len() >= b.len() {
        let factor = rest.last().unwrap() / b.last().unwrap();
        let shift = rest.len() - b.len();
        for (k, x) in b.iter().enumerate() {
            rest[k + shift] = &rest[k + shift] - &(&factor * x);
        }
        rest.pop();
    }
    rest
}

/// How many distinct real roots a polynomial has, by Sturm's theorem.
fn real_roots(polynomial: &[Big]) -> usize {
    let derivative: Vec<Big> =
        polynomial.iter().enumerate().skip(1).map(|(k, x)| x * &Big::new(k as f64)).collect();
    let mut chain = vec![polynomial.to_vec(), derivative];
    loop {
        let [.., a, b] = chain.as_slice() else { unreachable!() };
        if b.len() <= 1 {
            break;
        }
        let rest: Vec<Big> = remainder(a, b).into_iter().map(|x| -x).collect();
        if rest.is_empty() {
            break;
        }
        chain.push(rest);
    }
    let changes = |at_minus_infinity: bool| {
        let signs: Vec<bool> = chain
            .iter()
            .map(|p| p.last().unwrap().is_positive() != (at_minus_infinity && p.len() % 2 == 0))
            .collect();
        signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
    };
    changes(true) - changes(false)
}

/// Every line whose crossings are not within rounding of tangent has as many as it should.
fn none_is_missed(lines: usize) {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let mut counts = [0_usize; 5];
    let mut grazing = 0;
    for _ in 0..lines {
        let tube = random.random_range(0.05..0.95);
        let torus = Torus::new(1.0, tube).unwrap();
        let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.5..1.5));
        let (point, direction) = (any(), any().normalize());
        let mut found = Vec::new();
        torus.crossings(&Line { point, direction }, |c| found.push(c));
        let expected = real_roots(&quartic(point.into(), direction.into(), 1.0, tube));
        if found.len() != expected {
            // Allowed only if a line a hair aside has the other count.
            let closest = found.iter().map(|c| c.normal.dot(&direction).abs()).fold(1.0_f64, f64::min);
            let gap = if found.is_empty() {
                torus.closest_approach(&Line { point, direction }).unwrap().gap
            } else {
                closest
            };
            assert!(gap < 1e-6, "{expected} expected, {found:?}");
            grazing += 1;
            continue;
        }
        counts[found.len()] += 1;
        for crossing in &found {
            let p = crossing.point;
            let residual = (p.xy().norm() - 1.0).hypot(p.z) - tube;
            assert!(residual.abs() < 1e-14 / crossing.normal.dot(&direction).abs().max(1e-4));
        }
    }
    println!("torus: crossings counted {counts:?}, within rounding of tangent {grazing}");
    assert!(counts[0] > 0 && counts[2] > 0 && counts[4] > 0);
    assert!(grazing <= lines / 1000);
}

#[test]
fn none_is_missed_in_few_lines() {
    none_is_missed(4000);
}

#[test]
#[ignore = "a minute long"]
fn none_is_missed_in_a_hundred_thousand_lines() {
    none_is_missed(100_000);
}
