//! The promise of a closed convex surface, broken.

use crate::laws_bite::*;
use fingertip_surfaces::testing::Law;
use fingertip_surfaces::*;
use fingertip_wrench::Line;
use nalgebra::Vector3;

/// A sphere that promises to be closed and convex, with crossings that do not keep the promise.
struct Promises<F>(F);

impl<F: Fn(Vec<Crossing<f64>>) -> Vec<Crossing<f64>>> ActiveSurface<f64> for Promises<F> {
    fn crossings(&self, line: &Line<f64>, visit: impl FnMut(Crossing<f64>)) {
        let mut found = Vec::new();
        ball().crossings(line, |crossing| found.push(crossing));
        (self.0)(found).into_iter().for_each(visit);
    }

    fn normal(&self, point: &Vector3<f64>) -> Vector3<f64> {
        ball().normal(point)
    }

    fn shortcuts(&self) -> impl Shortcuts<f64> {
        self
    }
}

impl<F> Shortcuts<f64> for Promises<F> {
    const CLOSED_CONVEX: bool = true;
}

#[test]
fn promises_of_closed_convex_surfaces() {
    assert_eq!(broken(&Promises(|found| found)), None);
    let exit_first = |found: Vec<Crossing<f64>>| found.into_iter().rev().collect();
    assert_eq!(broken(&Promises(exit_first)), Some(Law::EnteredOnce));
    for k in 0..2 {
        let inactive = move |mut found: Vec<Crossing<f64>>| {
            found.iter_mut().skip(k).take(1).for_each(|crossing| crossing.active = false);
            found
        };
        assert_eq!(broken(&Promises(inactive)), Some(Law::EnteredOnce));
        let sole = move |found: Vec<Crossing<f64>>| found.into_iter().skip(k).take(1).collect();
        // The missing one is missed by the line along the normal, too.
        assert!(matches!(broken(&Promises(sole)), Some(Law::EnteredOnce | Law::CrossingOnSurface)));
        let twice =
            move |found: Vec<Crossing<f64>>| found.get(k).into_iter().chain(&found).copied().collect();
        assert_eq!(broken(&Promises(twice)), Some(Law::EnteredOnce));
    }
}
