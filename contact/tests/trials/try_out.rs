//! A shape under random wrenches, and what came of them.

use core::fmt;

use fingertip_contact::{
    Contact, ContactModel, NoContact, PointContact, Resolution, SoftFinger, SoftFingerSurface,
};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::big::{Big, big3, cross, dot};
use crate::draw::Drawn;
use crate::exact::{Exact, distance, length, minus, number, plus, times, wide};
use crate::solve::{Load, Truth};
use crate::wrenches::Random;

/// How a contact was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    Point,
    Soft,
    /// A soft finger on an edge or a tip.
    Edge,
}

/// What came of the trials.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Count {
    pub(crate) trials: usize,
    /// Off by more than the goal.
    pub(crate) wrong: usize,
    /// Denied though there is one.
    pub(crate) lost: usize,
    /// Told though there is none.
    pub(crate) false_contacts: usize,
    /// Said to be unresolved.
    pub(crate) unsure: usize,
    /// Rounding of the wrench left it without a contact, and so it was said.
    pub(crate) none: usize,
    /// The equations hold, but of which contact they are was not found out: on a seam, where the curvature jumps, or
    /// where two contacts were about to merge, and rounding of the wrench took both.
    pub(crate) unjudged: usize,
    /// Errors of point, normal and spin torque, in units of the goal.
    pub(crate) worst: [f64; 3],
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            trials,
            wrong,
            lost,
            false_contacts,
            unsure,
            none,
            unjudged,
            worst: [point, normal, spin],
        } = self;
        write!(
            f,
            "{trials:8} {wrong:6} {lost:6} {false_contacts:6} {unsure:6} {none:6} {unjudged:6}   {point:8.2e} {normal:8.2e} {spin:8.2e}"
        )
    }
}

/// The size of the error that is allowed: of size plus distance.
pub(crate) fn goal<T: Real>() -> f64 {
    if T::EPSILON.to_f64() > f64::EPSILON { 1e-6 } else { 1e-13 }
}

pub(crate) struct Trial<T: Real, S> {
    pub(crate) surface: S,
    pub(crate) wrench: Wrench<T>,
    pub(crate) near: Vector3<f64>,
    pub(crate) size: f64,
}

/// A wrench of a contact on a random shape; `None` of one that has no edges.
pub(crate) fn draw<T: Real, S: Drawn>(random: &mut Random, asked: Asked) -> Option<Trial<T, S>> {
    let size = random.log_uniform(1e-6, 1e3);
    let (surface, near, normal) = match asked {
        Asked::Edge => S::draw_edge(random, size)?,
        _ => S::draw(random, size),
    };
    let magnitude = random.log_uniform(1e-12, 1e12);
    let cosine = if random.uniform(0.0, 1.0) < 0.5 {
        random.log_uniform(1e-3, 1.0)
    } else {
        random.uniform(1e-3, 1.0)
    };
    let any = random.direction();
    let across = (any - normal * any.dot(&normal)).normalize();
    let force = (across * (1.0 - cosine * cosine).sqrt() - normal * cosine) * magnitude;
    let spin = match asked {
        Asked::Point => 0.0,
        Asked::Soft => random.sign() * random.log_uniform(1e-16, 1e4) * magnitude * size,
        // On an edge the spin torque is what tells the normal: it must be more than rounding.
        Asked::Edge => random.sign() * random.log_uniform(1e-2, 1e4) * magnitude * size,
    };
    let torque = near.cross(&force) + normal * spin;
    let wrench = Wrench::on_fingertip(force.map(T::literal), torque.map(T::literal));
    Some(Trial { surface, wrench, near, size })
}

impl<T: Real, S: SoftFingerSurface<T> + Exact> Trial<T, S> {
    /// What forces are multiplied by, a power of two.
    fn unit(&self) -> Big {
        let magnitude = self.wrench.force().map(Real::to_f64).norm();
        number(2.0_f64.powi(-(magnitude.log2() as i32)))
    }

    /// The spin torque of a contact in that unit.
    fn spin(&self, found: &Contact<T>) -> Big {
        &number(found.spin_torque) * &self.unit()
    }

    /// The load to 31 digits; for a point contact without the torque along the force, which it takes for none.
    fn load(&self, asked: Asked) -> Load {
        let unit = self.unit();
        let force = times(&wide(&self.wrench.force()), &unit);
        let mut torque = times(&wide(&self.wrench.torque()), &unit);
        if asked == Asked::Point {
            let pitch = &dot(&force, &torque) / &dot(&force, &force);
            torque = minus(&torque, &times(&force, &pitch));
        }
        Load { force, torque, size: self.size }
    }

    pub(crate) fn resolve(&self, asked: Asked) -> Resolution<T> {
        let near = self.near.map(T::literal);
        match asked {
            Asked::Point => {
                PointContact::new(T::zero()).unwrap().resolve_near(&self.wrench, &self.surface, Some(&near))
            }
            Asked::Soft | Asked::Edge => {
                let model = SoftFinger::new(T::zero()).unwrap().without_friction_limit();
                model.resolve_near(&self.wrench, &self.surface, Some(&near))
            }
        }
    }

    /// Whether a contact can be meant by a truth.
    fn is_close(&self, truth: &Truth, found: &Contact<T>) -> bool {
        distance(&found.point, &truth.point) <= 1e-3 * self.size
    }

    /// What is exact of a load, next to a start.
    fn exactly(&self, asked: Asked, load: &Load, near: Vector3<f64>) -> Option<Truth> {
        if asked == Asked::Point {
            load.entry(&self.surface, near.into())
        } else {
            load.contact(&self.surface, near.into())
        }
    }

    /// The truth nearest to a contact.
    fn truth(&self, asked: Asked, load: &Load, found: &Contact<T>) -> Option<Truth> {
        let point = found.point.map(Real::to_f64);
        // Of a grazing line the equations of the soft finger hold with a spin torque, which a point does not bear.
        let lever = length(&load.torque) + length(&load.force) * number(self.size);
        let is_asked_for =
            |truth: &Truth| asked != Asked::Point || truth.spin.abs().to_f64() <= 1e-20 * lever.to_f64();
        let from_found = self.exactly(asked, load, point).filter(is_asked_for);
        if from_found.as_ref().is_some_and(|truth| self.is_close(truth, found)) {
            return from_found;
        }
        let from_start = self.exactly(asked, load, self.near).filter(is_asked_for);
        let off = |truth: &Option<Truth>| {
            truth.as_ref().map_or(f64::INFINITY, |truth| distance(&found.point, &truth.point))
        };
        if off(&from_found) < off(&from_start) { from_found } else { from_start }
    }

    /// Takes it into account; says what is amiss.
    pub(crate) fn judge(&self, asked: Asked, count: &mut Count) -> Option<&'static str> {
        count.trials += 1;
        let load = self.load(asked);
        match self.resolve(asked) {
            Resolution::Contact(found) => {
                let Some(truth) = self.truth(asked, &load, &found) else {
                    if self.solves(&load, &found) {
                        count.unjudged += 1;
                        return None;
                    }
                    count.false_contacts += 1;
                    return Some("false");
                };
                if !self.is_close(&truth, &found) && self.merges(&load, &found) {
                    count.unjudged += 1;
                    return None;
                }
                let errors = self.errors(&load, &truth, &found);
                let mut wrong = false;
                for (worst, error) in count.worst.iter_mut().zip(errors) {
                    *worst = worst.max(error);
                    wrong |= !(error <= 1.0);
                }
                count.wrong += usize::from(wrong);
                wrong.then_some("wrong")
            }
            Resolution::NoContact(NoContact::Unresolved) => {
                count.unsure += 1;
                None
            }
            Resolution::NoContact(reason) => {
                let Some(truth) = self.exactly(asked, &load, self.near) else {
                    count.none += 1;
                    return None;
                };
                // Rounding of the wrench took the line off the shape: where it is touched is in no digit.
                let is_off = matches!(reason, NoContact::Ambiguous { .. } | NoContact::Misses { .. });
                if is_off && load.grazes(&truth) <= goal::<T>() {
                    count.unjudged += 1;
                    return None;
                }
                count.lost += 1;
                Some("lost")
            }
        }
    }

    /// Whether a contact solves the equations where two contacts merge, and so rounding may have taken both.
    fn merges(&self, load: &Load, found: &Contact<T>) -> bool {
        let apart = load.apart(&self.surface, &wide(&found.point), &self.spin(found));
        // What rounding does has moved them by its root.
        apart <= 100.0 * goal::<T>() && self.solves(load, found)
    }

    /// Whether a contact solves the equations, and presses, but for the rounding of its own numbers.
    fn solves(&self, load: &Load, found: &Contact<T>) -> bool {
        let (point, normal) = (wide(&found.point), wide(&found.normal));
        let (height, exactly) = self.surface.height_and_normal(&point);
        let turning = times(&normal, &self.spin(found));
        let rest = minus(&minus(&load.torque, &cross(&point, &load.force)), &turning);
        let far = length(&point).to_f64() + self.size;
        let lever = length(&load.torque).to_f64() + length(&load.force).to_f64() * far;
        let steepest = load.turn(&self.surface, &point, &exactly).steepest();
        let turned = distance(&found.normal, &exactly) / (1.0 + steepest * far);
        // Where a line grazes a normal is known to the root of what a place is.
        let on_surface = height.abs().to_f64() <= goal::<T>() * far && turned <= goal::<T>().sqrt();
        let pulling = dot(&load.force, &normal).to_f64() / length(&load.force).to_f64();
        length(&rest).to_f64() <= goal::<T>() * lever && on_surface && pulling <= goal::<T>().sqrt()
    }

    /// Of point, normal and spin torque, in units of the goal.
    fn errors(&self, load: &Load, truth: &Truth, found: &Contact<T>) -> [f64; 3] {
        // Numbers of a pose are rounded where they are, though places of shape and frame may cancel.
        let far = length(&truth.point).to_f64() + self.size + self.surface.aside();
        let mut point = distance(&found.point, &truth.point) / far;
        if truth.normal.is_none() {
            // Along an edge a contact answers to the torque by as much as the spin torque is smaller than the force.
            let share = length(&minus(&load.torque, &cross(&truth.point, &load.force))).to_f64();
            point *= (share / (length(&load.force).to_f64() * far)).min(1.0) * 0.1;
        }
        // A point known to so much knows the normal to that times the curvature.
        let normal = truth
            .normal
            .as_ref()
            .map_or(0.0, |normal| distance(&found.normal, normal) / (1.0 + truth.steepest * far));
        let spin = self.spin(found);
        // Of an edge the magnitude is known.
        let turned = truth.normal.is_none() && !spin.is_positive();
        let known = if turned { -truth.spin } else { truth.spin };
        // Of the torque, which is what tells it.
        let lever = length(&load.torque).to_f64() + length(&load.force).to_f64() * far;
        let edge = if truth.normal.is_none() { 0.1 } else { 1.0 };
        let spin = (spin - known).abs().to_f64() / lever * edge;
        [point, normal, spin].map(|error| error / goal::<T>())
    }
}

/// A pure force whose line passes a shape by, beside a place of it.
pub(crate) fn draw_miss<T: Real, S: Drawn>(random: &mut Random) -> Trial<T, S> {
    let size = random.log_uniform(1e-6, 1e3);
    let (surface, near, normal) = S::draw(random, size);
    let magnitude = random.log_uniform(1e-12, 1e12);
    let any = random.direction();
    let across = (any - normal * any.dot(&normal)).normalize();
    let near = near + normal * (size * random.log_uniform(1e-5, 10.0));
    let wrench = Wrench::from_force_at(&near.map(T::literal), (across * magnitude).map(T::literal));
    Trial { surface, wrench, near, size }
}

impl<T: Real, S: SoftFingerSurface<T> + Exact> Trial<T, S> {
    /// Whether the line stays clear of the shape, by marching along it as far as nothing can be.
    pub(crate) fn is_clear(&self) -> bool {
        let load = self.load(Asked::Point);
        let (f, m) = (&load.force, &load.torque);
        let squared = dot(f, f);
        let foot = cross(f, m).map(|x| &x / &squared);
        let direction = times(f, &number(1.0 / squared.to_f64().sqrt()));
        let start = dot(&minus(&big3(self.near.into()), &foot), &direction).to_f64();
        // Clear of it by what rounding of the wrench may take.
        let least = 1e-6 * self.size + 64.0 * T::EPSILON.to_f64() * (self.near.norm() + self.size);
        [1.0, -1.0].into_iter().all(|way| {
            let mut t = start;
            for _ in 0..2000 {
                let point = plus(&foot, &times(&direction, &number(t)));
                let (height, _) = self.surface.height_and_normal(&point);
                let height = height.to_f64();
                if !(height > least) {
                    return false;
                }
                // What tells its height to first order only may be nearer than that.
                t += way * height.min(0.5 * self.size) * 0.4;
                if (t - start).abs() > 12.0 * self.size {
                    return true;
                }
            }
            false
        })
    }

    /// With the limit of friction that a soft finger has by default.
    pub(crate) fn judge_miss(&self, count: &mut Count) -> Option<&'static str> {
        count.trials += 1;
        match SoftFinger::new(T::zero()).unwrap().resolve(&self.wrench, &self.surface) {
            Resolution::Contact(_) => {
                count.false_contacts += 1;
                Some("false")
            }
            Resolution::NoContact(NoContact::Unresolved) => {
                count.unsure += 1;
                None
            }
            Resolution::NoContact(_) => {
                count.none += 1;
                None
            }
        }
    }
}
