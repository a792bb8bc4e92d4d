//! Soft-finger contacts on every shape, in closed form where there is one and by Newton's method.
//! Measured backward: the moment equation, the surface, and the normal at the point found.

use core::cell::Cell;

use fingertip_contact::{
    ContactModel, NoContact, Resolution, Search, SoftContact, SoftFinger, SoftFingerSurface,
    newton_soft_contacts,
};
use fingertip_surfaces::{
    ActiveSurface, ClosestApproach, Crossing, Extent, Level as LevelAtPoint, SmoothSurface, Topology,
};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::big::{Big, big3, cross};
use super::contacts::{length, no_force, pressing, sound, wide};
use super::levels::Level;
use super::matrix::Row;
use super::shapes::{Visitor, each};

const UNITS: f64 = 16.0;

/// A surface by Newton's method, whatever closed form it has, that counts the evaluations.
pub(crate) struct Newton<'a, S> {
    pub(crate) surface: &'a S,
    pub(crate) evaluations: Cell<usize>,
}

impl<T: Real, S: ActiveSurface<T>> ActiveSurface<T> for Newton<'_, S> {
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>)) {
        self.surface.crossings(line, visit);
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        self.surface.closest_approach(line)
    }

    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.surface.normal(point)
    }
}

impl<T: Real, S: SmoothSurface<T>> SmoothSurface<T> for Newton<'_, S> {
    fn level(&self, point: &Vector3<T>) -> LevelAtPoint<T> {
        self.evaluations.set(self.evaluations.get() + 1);
        self.surface.level(point)
    }

    fn extent(&self) -> Extent<T> {
        self.surface.extent()
    }

    fn topology(&self) -> Topology {
        self.surface.topology()
    }
}

impl<T: Real, S: SmoothSurface<T>> SoftFingerSurface<T> for Newton<'_, S> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        newton_soft_contacts(self, wrench, last, visit)
    }
}

struct Contacts<'a> {
    case: &'static str,
    force: f64,
    cosine: f64,
    /// Spin torque over force and size.
    spin: f64,
    trials: usize,
    rows: &'a mut Vec<Row>,
}

impl Contacts<'_> {
    fn run<T: Real, S: SoftFingerSurface<T>>(
        &self,
        mut row: Row,
        surface: &S,
        level: Level,
        scale: f64,
        evaluations: Option<&Cell<usize>>,
    ) -> Row {
        let model = SoftFinger::new(T::zero()).expect("a model").without_friction_limit();
        let mut random = Pcg64Mcg::seed_from_u64(35);
        let (size, epsilon) = (level.size(scale), T::EPSILON.to_f64());
        // Newton's method in units in which a pancake is one: 1e-13 of the size in `f64`
        // (`docs/theory/README.md#stress-cases`).
        let flat = matches!(level, Level::Ellipsoid { semi_axes: [a, _, c] } if c < 0.01 * a);
        let units = if flat && evaluations.is_some() { 450.0 } else { UNITS };
        let slow = matches!(level, Level::Superquadric { .. });
        for _ in 0..if slow { self.trials.div_ceil(4) } else { self.trials } {
            let (point, normal) = level.sample(&mut random, scale);
            let cosine = random.random_range(self.cosine..=1.0).min(self.cosine * 4.0);
            let force = pressing(&normal, cosine, &mut random) * self.force;
            let spin = self.spin * self.force * size * random.random_range(-1.0..1.0);
            let torque = point.cross(&force) + normal * spin;
            let wrench = Wrench::<T>::on_fingertip(force.map(T::literal), torque.map(T::literal));
            if let Some(evaluations) = evaluations {
                evaluations.set(0);
            }
            let found = model.resolve(&wrench, surface);
            if let Some(evaluations) = evaluations {
                row.iterated(evaluations.get());
            }
            let note = || format!("{wrench:?}: {found:?}");
            if !sound(&found) {
                row.error(f64::NAN, 1.0, note);
                continue;
            }
            let Some(contact) = found.contact() else {
                // A search that ended at its bound, and says so, does not lie.
                let honest = matches!(found, Resolution::NoContact(NoContact::Unresolved));
                row.expect(honest && evaluations.is_some(), note);
                continue;
            };
            let (f, m) = (big3(wide(&wrench.force())), big3(wide(&wrench.torque())));
            let place = big3(wide(&contact.point));
            let normal = big3(wide(&contact.normal));
            let wide_spin = contact.spin_torque.to_f64().abs();
            let spin = Big::new(contact.spin_torque.to_f64());
            let arm = cross(&place, &f);
            let rest = [0, 1, 2].map(|k| &(&m[k] - &arm[k]) - &(&spin * &normal[k]));
            let lever = size + length(&place);
            let moments = length(&f) * lever + length(&m);
            // The normal, as far as rounding of the point leaves it known.
            let exact = level.normal(&place, size);
            let off = |a: &[Big; 3], b: &[Big; 3]| length(&[0, 1, 2].map(|k| &a[k] - &b[k]));
            let hair = &Big::new(UNITS * epsilon * size);
            let turned_by = |to: usize| {
                let moved = [0, 1, 2].map(|k| &place[k] + &(&exact[(k + to) % 3] * hair));
                off(&level.normal(&moved, size), &exact)
            };
            let unknown = turned_by(1).max(turned_by(2));
            // What rounding the point does to the normal, the spin torque sees.
            let turned = wide_spin * unknown;
            row.error(length(&rest), units * epsilon * moments + turned, || format!("moments: {}", note()));
            row.error(level.distance(&place, size), units * epsilon * lever, || {
                format!("off the surface: {}", note())
            });
            row.error(off(&normal, &exact), UNITS * epsilon + 4.0 * unknown, || {
                format!("normal: {}", note())
            });
        }
        row
    }
}

impl<T: Real> Visitor<T> for Contacts<'_> {
    fn shape<S: SmoothSurface<T> + SoftFingerSurface<T>>(
        &mut self,
        name: &'static str,
        surface: S,
        level: Level,
        scale: f64,
    ) {
        let routine = format!("soft finger, {name}");
        let row = self.run::<T, _>(Row::new::<T>(&routine, self.case), &surface, level, scale, None);
        self.rows.push(row);
        let newton = Newton { surface: &surface, evaluations: Cell::new(0) };
        let bounded = !matches!(level, Level::Plane | Level::Cylinder { .. } | Level::Cone { .. });
        if bounded {
            let row = Row::new::<T>(format!("soft finger by Newton (evaluations), {name}"), self.case);
            let row = self.run::<T, _>(row, &newton, level, scale, Some(&newton.evaluations));
            self.rows.push(row);
        }
        if self.case == "ordinary" {
            let model = SoftFinger::new(T::zero()).expect("a model").without_friction_limit();
            let row =
                no_force(routine, &model, &surface, |reason| matches!(reason, NoContact::PureCouple { .. }));
            self.rows.push(row);
        }
    }
}

/// A pure force that passes the shape by has no soft contact, and says so.
struct Misses<'a>(&'a mut Vec<Row>);

impl<T: Real> Visitor<T> for Misses<'_> {
    fn shape<S: SmoothSurface<T> + SoftFingerSurface<T>>(
        &mut self,
        name: &'static str,
        surface: S,
        level: Level,
        _: f64,
    ) {
        let unbounded = matches!(level, Level::Plane | Level::Cylinder { .. } | Level::Cone { .. });
        let model = SoftFinger::new(T::zero()).expect("a model").without_friction_limit();
        let mut row = Row::new::<T>(format!("soft finger, {name}"), "pure force that misses");
        for (x, y) in [(3.0, 0.0), (2.0, 2.5), (0.1, 7.0)] {
            let point = Vector3::new(T::literal(x), T::literal(y), T::zero());
            // Upward and across: neither meets a shape within a ball of radius 2.6 about the origin.
            for force in [Vector3::z(), Vector3::new(-point.y, point.x, T::zero())] {
                let wrench = Wrench::from_force_at(&point, force);
                let found = model.resolve(&wrench, &surface);
                let none = matches!(
                    found,
                    Resolution::NoContact(
                        NoContact::Misses { .. }
                            | NoContact::Ambiguous { .. }
                            | NoContact::OnlyPulling { .. }
                    )
                );
                row.expect(sound(&found) && (none || unbounded), || format!("{wrench:?}: {found:?}"));
            }
        }
        self.0.push(row);
    }
}

pub(crate) fn rows<T: Real>(trials: usize, rows: &mut Vec<Row>) {
    let far = if T::EPSILON.to_f64() > 1e-10 { 1e30 } else { 1e150 };
    for (case, scale, force, cosine, spin) in [
        ("ordinary", 1.0, 1.0, 0.3, 0.1),
        ("size 1 µm", 1e-6, 1.0, 0.3, 0.1),
        ("size 1 km", 1e3, 1.0, 0.3, 0.1),
        ("tiny force", 1.0, 1.0 / far, 0.3, 0.1),
        ("huge force", 1.0, far, 0.3, 0.1),
        ("no spin torque", 1.0, 1.0, 0.3, 0.0),
        ("spin torque 1e-16 |f| R", 1.0, 1.0, 0.3, 1e-16),
        ("spin torque 1e-8 |f| R", 1.0, 1.0, 0.3, 1e-8),
        ("spin torque 100 |f| R", 1.0, 1.0, 0.3, 100.0),
        ("flat, cos φ = 0.05 to 0.2", 1.0, 1.0, 0.05, 0.1),
    ] {
        each::<T>(scale, &mut Contacts { case, force, cosine, spin, trials, rows });
    }
    each::<T>(1.0, &mut Misses(rows));
}
