//! The contact of a wrench on a surface that is known to 31 digits, by Newton's method.

use crate::big::{Big, Big3, big3, cross, dot};
use crate::exact::{Exact, length, minus, plus, times, unit};

/// A contact, and the steepest curvature there.
#[derive(Clone, Debug)]
pub(crate) struct Truth {
    pub(crate) point: Big3,
    /// Unknown on an edge or a tip.
    pub(crate) normal: Option<Big3>,
    pub(crate) spin: Big,
    pub(crate) steepest: f64,
}

/// Two ways across a normal, and how it turns along each.
pub(crate) struct Turn {
    ways: [Big3; 2],
    bends: [Big3; 2],
}

impl Turn {
    /// `EᵀWE`, row by row.
    fn matrix(&self) -> [Big; 4] {
        let ([e1, e2], [bend1, bend2]) = (&self.ways, &self.bends);
        [dot(e1, bend1), dot(e1, bend2), dot(e2, bend1), dot(e2, bend2)]
    }

    pub(crate) fn steepest(&self) -> f64 {
        let [bend1, bend2] = &self.bends;
        length(bend1).to_f64().max(length(bend2).to_f64())
    }
}

/// Force and torque in units of the size and of the force, and the size.
pub(crate) struct Load {
    pub(crate) force: Big3,
    pub(crate) torque: Big3,
    pub(crate) size: f64,
}

impl Load {
    fn magnitude(&self) -> Big {
        length(&self.force)
    }

    /// The contact nearest to a start, if Newton's method finds one that presses and that belongs to the shape.
    pub(crate) fn contact(&self, surface: &impl Exact, near: [f64; 3]) -> Option<Truth> {
        if let Some(point) = surface.elsewhere(&self.force, &self.torque) {
            let left = minus(&self.torque, &cross(&point, &self.force));
            return Some(Truth { point, normal: None, spin: length(&left), steepest: 0.0 });
        }
        self.on_what_it_holds(surface, near)
    }

    /// Where the line of action enters, next to a start.
    pub(crate) fn entry(&self, surface: &impl Exact, near: [f64; 3]) -> Option<Truth> {
        if let Some([point, normal]) = surface.through_end(&self.force, &self.torque) {
            return Some(Truth { point, normal: Some(normal), spin: Big::new(0.0), steepest: 0.0 });
        }
        self.on_what_it_holds(surface, near)
    }

    /// On the part of the smooth surface that belongs to the shape.
    fn on_what_it_holds(&self, surface: &impl Exact, near: [f64; 3]) -> Option<Truth> {
        self.on_smooth(surface, big3(near)).filter(|truth| surface.holds(&truth.point))
    }

    /// How the normal turns: central differences, exact to 1e-18.
    pub(crate) fn turn(&self, surface: &impl Exact, point: &Big3, normal: &Big3) -> Turn {
        let stride = Big::new(1e-9 * self.size);
        let along = |way: &Big3| {
            let step = times(way, &stride);
            let there = surface.height_and_normal(&plus(point, &step)).1;
            let back = surface.height_and_normal(&minus(point, &step)).1;
            times(&minus(&there, &back), &(&Big::new(0.5) / &stride))
        };
        let (e1, e2) = across(normal);
        let bends = [along(&e1), along(&e2)];
        Turn { ways: [e1, e2], bends }
    }

    /// How far two contacts are from merging at a place, `|τ²κ + (f·n)²|/|f|²`.
    pub(crate) fn apart(&self, surface: &impl Exact, point: &Big3, spin: &Big) -> f64 {
        let (_, n) = surface.height_and_normal(point);
        let [w11, w12, w21, w22] = self.turn(surface, point, &n).matrix();
        let (pressing, strength) = (dot(&self.force, &n), self.magnitude());
        let index = (w11 * w22 - w12 * w21) * *spin * *spin + pressing * pressing;
        (index / (strength * strength)).to_f64().abs()
    }

    /// The cosine of incidence; that of an edge is not told.
    pub(crate) fn grazes(&self, truth: &Truth) -> f64 {
        let along = |normal: &Big3| -(dot(&self.force, normal) / self.magnitude()).to_f64();
        truth.normal.as_ref().map_or(1.0, along)
    }

    /// On the surface without edges.
    pub(crate) fn on_smooth(&self, surface: &impl Exact, start: Big3) -> Option<Truth> {
        let (f, m) = (&self.force, &self.torque);
        let (_, normal) = surface.height_and_normal(&start);
        let mut spin = &dot(f, m) / &dot(f, &normal);
        let mut point = start;
        for taken in 0..240 {
            let (height, n) = surface.height_and_normal(&point);
            let rest = minus(&minus(m, &cross(&point, f)), &times(&n, &spin));
            let turn = self.turn(surface, &point, &n);
            let (steepest, [e1, e2]) = (turn.steepest(), &turn.ways);
            // τ W a + a × f = rest − (−h n) × f in the plane across n, a being the step along it.
            let rest_there = plus(&rest, &times(&cross(&n, f), &height));
            let [w11, w12, w21, w22] = turn.matrix().map(|w| w * spin);
            let (r1, r2, pressing) = (dot(e1, &rest_there), dot(e2, &rest_there), dot(f, &n));
            // e1·(a × f) = a₂ f·n, e2·(a × f) = −a₁ f·n but for the part of f along the plane, which n has.
            let [j12, j21] = [w12 + pressing, w21 - pressing];
            let determinant = w11 * w22 - j12 * j21;
            let a1 = (w22 * r1 - j12 * r2) / determinant;
            let a2 = (w11 * r2 - j21 * r1) / determinant;
            let step = minus(&plus(&times(e1, &a1), &times(e2, &a2)), &times(&n, &height));
            let twist = dot(&n, &minus(&rest, &cross(&step, f)));
            let longest = length(&step).to_f64() / self.size;
            if !longest.is_finite() {
                return None;
            }
            let far = 1.0 + length(&point).to_f64() / self.size;
            // Where patches meet full steps may go to and fro.
            let most = match taken % 40 {
                0..15 => 1.0,
                15..25 => 0.5,
                25..35 => 0.2,
                _ => 0.05,
            };
            let damping = Big::new((0.3 * far / longest).min(most));
            point = plus(&point, &times(&step, &damping));
            spin = spin + twist * damping;
            if longest < 1e-19 * far {
                let (_, normal) = surface.height_and_normal(&point);
                let found = Truth { point, normal: Some(normal), spin, steepest };
                return (self.grazes(&found) > 1e-22).then_some(found);
            }
        }
        None
    }
}

/// Two unit vectors across a third.
fn across(n: &Big3) -> (Big3, Big3) {
    let mut least = 0;
    for k in 1..3 {
        if n[k].abs() < n[least].abs() {
            least = k;
        }
    }
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let e1 = unit(&cross(n, &big3(axis)));
    let e2 = cross(n, &e1);
    (e1, e2)
}
