//! Exact answers in arithmetic of 220 bits.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::stability::big::{Big, Big3, at, big3, cross, dot, line_of_action};
use crate::stability::levels::Level;
use crate::stability::solve::solve;

fn wide<T: Real>(v: &Vector3<T>) -> [f64; 3] {
    v.map(Real::to_f64).into()
}

/// Where the exact line of action of a wrench meets the exact surface near a point.
pub(crate) fn point_contact<T: Real>(level: Level, wrench: &Wrench<T>, near: &Vector3<f64>) -> Option<Big3> {
    let (foot, axis) = line_of_action(wide(&wrench.force()), wide(&wrench.torque()));
    let start = big3((*near).into());
    let mut along = dot(&[0, 1, 2].map(|k| &start[k] - &foot[k]), &axis);
    let step = Big::new(near.norm() * 2.0_f64.powi(-70));
    for _ in 0..12 {
        let value = level.value(&at(&foot, &axis, &along));
        let moved = level.value(&at(&foot, &axis, &(&along + &step)));
        let slope = &(&moved - &value) / &step;
        if slope.to_f64() == 0.0 {
            return None;
        }
        let change = &value / &slope;
        along = &along - &change;
        if change.to_f64().abs() < near.norm() * 1e-30 {
            return Some(at(&foot, &axis, &along));
        }
    }
    None
}

/// The contact centroid of a soft finger near a point: `m = c × f + τ n(c)` with `c` on the surface,
/// by Newton's method with differences for derivatives.
pub(crate) fn soft_contact<T: Real>(
    level: Level,
    wrench: &Wrench<T>,
    near: &Vector3<f64>,
    spin: f64,
    size: f64,
) -> Option<Big3> {
    let (f, m) = (big3(wide(&wrench.force())), big3(wide(&wrench.torque())));
    let force = dot(&f, &f).sqrt();
    let unit = Big::new(size);
    let moment = &force * &unit;
    // Unknowns and equations near 1: c/size, τ/(|f| size).
    let equations = |x: &[Big; 4]| -> [Big; 4] {
        let place = [0, 1, 2].map(|k| &x[k] * &unit);
        let normal = level.normal(&place, size);
        let arm = cross(&place, &f);
        let rest = |k: usize| &(&(&m[k] - &arm[k]) / &moment) - &(&x[3] * &normal[k]);
        [&level.value(&place) / &unit, rest(0), rest(1), rest(2)]
    };
    let mut x = [0, 1, 2, 3].map(|k| match k {
        3 => &Big::new(spin) / &moment,
        _ => &Big::new(near[k]) / &unit,
    });
    let step = Big::new(2.0_f64.powi(-40));
    for _ in 0..12 {
        let value = equations(&x);
        let mut system: Vec<Vec<Big>> = (0..4).map(|_| Vec::with_capacity(5)).collect();
        for k in 0..4 {
            let mut moved = x.clone();
            moved[k] = &moved[k] + &step;
            for (row, (a, b)) in system.iter_mut().zip(equations(&moved).iter().zip(&value)) {
                row.push(&(a - b) / &step);
            }
        }
        for (row, b) in system.iter_mut().zip(value) {
            row.push(b);
        }
        let change = solve(system)?;
        let mut greatest = 0.0_f64;
        for (x, change) in x.iter_mut().zip(&change) {
            *x = &*x - change;
            greatest = greatest.max(change.to_f64().abs());
        }
        if greatest < 1e-24 {
            return Some([0, 1, 2].map(|k| &x[k] * &unit));
        }
    }
    None
}

/// Distance of a point from an exact one \[m\].
pub(crate) fn distance<T: Real>(found: &Vector3<T>, exact: &Big3) -> f64 {
    let found = big3(wide(found));
    (0..3).map(|k| (&found[k] - &exact[k]).to_f64().powi(2)).sum::<f64>().sqrt()
}
