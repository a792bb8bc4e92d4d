//! Superquadrics with exponents from 0.1 to 2.

use fingertip_surfaces::*;
use fingertip_wrench::Line;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::big::Big;

/// `((|x/a|^(2/e2) + |y/b|^(2/e2))^(e2/e1) + |z/c|^(2/e1))^(e1/2) − 1`, in 220 bits.
fn excess(point: [Big; 3], axes: [f64; 3], [e1, e2]: [f64; 2]) -> Big {
    let two = Big::new(2.0);
    let (e1, e2) = (Big::new(e1), Big::new(e2));
    let [x, y, z] = [0, 1, 2].map(|k| (&point[k] / &Big::new(axes[k])).abs());
    let plane = &x.powf(&(&two / &e2)) + &y.powf(&(&two / &e2));
    let sum = &plane.powf(&(&e2 / &e1)) + &z.powf(&(&two / &e1));
    &sum.powf(&(&e1 / &two)) - &Big::new(1.0)
}

fn random_shape(random: &mut Pcg64Mcg) -> ([f64; 3], [f64; 2], Line<f64>) {
    let axes = [0; 3].map(|_| random.random_range(0.3..1.0));
    let exponents = [0; 2].map(|_| random.random_range(0.1..2.0));
    let mut any = |reach: f64| Vector3::from_fn(|_, _| random.random_range(-reach..reach));
    let line = Line { point: any(1.0), direction: any(1.0).normalize() };
    (axes, exponents, line)
}

/// The exact crossing lies within 1e-12 of the size, since the value changes its sign there.
#[test]
fn crossings_are_exact() {
    let mut random = Pcg64Mcg::seed_from_u64(11);
    let mut checked = 0;
    for _ in 0..120 {
        let (axes, exponents, line) = random_shape(&mut random);
        let shape = Superquadric::new(axes.into(), exponents).unwrap();
        let mut found = Vec::new();
        shape.crossings(&line, |c| found.push(c));
        for crossing in found.iter().filter(|c| c.normal.dot(&line.direction).abs() > 0.05) {
            let value = |nudge: f64| {
                let t = &Big::new(crossing.along) + &Big::new(nudge);
                let point =
                    [0, 1, 2].map(|k| &Big::new(line.point[k]) + &(&t * &Big::new(line.direction[k])));
                excess(point, axes, exponents).is_positive()
            };
            assert_ne!(value(-1e-12), value(1e-12), "{axes:?} {exponents:?} {line:?} {crossing:?}");
            checked += 1;
        }
    }
    assert!(checked > 60, "{checked}");
}

/// A line that is said to miss has no point inside, by dense sampling; one that hits has one.
fn none_is_missed(lines: usize) {
    let mut random = Pcg64Mcg::seed_from_u64(12);
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..lines {
        let (axes, [e1, e2], line) = random_shape(&mut random);
        let shape = Superquadric::new(axes.into(), [e1, e2]).unwrap();
        let mut ends = Vec::new();
        shape.crossings(&line, |c| ends.push(c.along));
        let inside = |t: f64| {
            let p = line.at(t);
            let plane = (p.x / axes[0]).abs().powf(2.0 / e2) + (p.y / axes[1]).abs().powf(2.0 / e2);
            plane.powf(e2 / e1) + (p.z / axes[2]).abs().powf(2.0 / e1) < 1.0
        };
        if let &[entry, exit] = ends.as_slice() {
            assert!(exit - entry < 1e-6 || inside((entry + exit) / 2.0));
            let (before, after) = (entry - 1e-9, exit + 1e-9);
            assert!(!inside(before) && !inside(after));
            hits += 1;
        } else {
            assert!(ends.is_empty());
            assert!((-400..=400).all(|k| !inside(f64::from(k) * 0.01)), "{axes:?} {e1} {e2} {line:?}");
            misses += 1;
        }
    }
    println!("superquadric: {hits} lines hit, {misses} missed");
    assert!(hits > 0 && misses > 0);
}

#[test]
fn none_is_missed_in_few_lines() {
    none_is_missed(5000);
}

#[test]
#[ignore = "a minute long"]
fn none_is_missed_in_a_hundred_thousand_lines() {
    none_is_missed(100_000);
}
