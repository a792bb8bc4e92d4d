//! Vectors of numbers with more digits than a double has.

use super::Big;

/// Three of them.
pub(crate) type Big3 = [Big; 3];

pub(crate) fn big3(v: [f64; 3]) -> Big3 {
    v.map(Big::new)
}

pub(crate) fn dot(a: &Big3, b: &Big3) -> Big {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

pub(crate) fn cross(a: &Big3, b: &Big3) -> Big3 {
    [
        &(&a[1] * &b[2]) - &(&a[2] * &b[1]),
        &(&a[2] * &b[0]) - &(&a[0] * &b[2]),
        &(&a[0] * &b[1]) - &(&a[1] * &b[0]),
    ]
}

pub(crate) fn at(point: &Big3, direction: &Big3, t: &Big) -> Big3 {
    [0, 1, 2].map(|k| &point[k] + &(t * &direction[k]))
}

/// The line of action of a wrench: foot point and unit direction.
pub(crate) fn line_of_action(force: [f64; 3], torque: [f64; 3]) -> (Big3, Big3) {
    let (f, m) = (big3(force), big3(torque));
    let squared = dot(&f, &f);
    let length = squared.sqrt();
    (cross(&f, &m).map(|x| &x / &squared), f.map(|x| &x / &length))
}
