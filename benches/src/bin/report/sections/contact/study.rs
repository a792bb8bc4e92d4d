//! Contact models on every shape, on shared touches.

use core::cell::Cell;
use core::hint::black_box;

use fingertip_contact::{ContactModel, PointContact, Resolution, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::SmoothSurface;
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use crate::reference::{distance, point_contact, soft_contact};
use crate::stability::big::Big3;
use crate::stability::contacts::pressing;
use crate::stability::levels::Level;
use crate::stability::shapes::Visitor;
use crate::stability::soft::Newton;
use crate::timing::{Effort, Timed, median, time};

pub(super) const SCALE: f64 = 0.013;
/// Greatest spin torque over force and size: that of a patch of 3 mm at a friction of 0.5.
pub(super) const SPIN: f64 = 0.03;

/// One touch: where, with what force and spin.
#[derive(Clone, Copy)]
pub(super) struct Touch {
    pub(super) point: Vector3<f64>,
    pub(super) force: Vector3<f64>,
    pub(super) normal: Vector3<f64>,
    pub(super) spin: f64,
}

impl Touch {
    /// Its wrench, of force alone or with the spin torque, read with some noise: that of the force in
    /// newtons, that of the torque by the size.
    pub(super) fn wrench<T: Real>(
        &self,
        spin: bool,
        noise: f64,
        size: f64,
        random: &mut Pcg64Mcg,
    ) -> Wrench<T> {
        let mut any = |by: f64| {
            Vector3::from_fn(|_, _| -> f64 { by * Distribution::<f64>::sample(&StandardNormal, random) })
        };
        let spin = if spin { self.normal * self.spin } else { Vector3::zeros() };
        let force = self.force + any(noise);
        let torque = self.point.cross(&self.force) + spin + any(noise * size);
        Wrench::on_fingertip(force.map(T::literal), torque.map(T::literal))
    }
}

/// The shapes of one formula that are looked at.
pub(super) const SHAPES: [&str; 7] =
    ["sphere", "ellipsoid", "cylinder", "capsule", "cone", "torus", "superquadric"];

/// What a soft finger is exactly, next to the touch.
pub(super) fn soft_exactly<T: Real>(
    level: Level,
    touch: &Touch,
    wrench: &Wrench<T>,
    size: f64,
) -> Option<Big3> {
    let spin = wrench.torque_about(&touch.point.map(T::literal)).dot(&touch.normal.map(T::literal));
    soft_contact(level, wrench, &touch.point, spin.to_f64(), size)
}

#[derive(Clone)]
pub(super) struct Figure {
    pub(super) shape: &'static str,
    pub(super) method: String,
    pub(super) scalar: &'static str,
    pub(super) inputs: &'static str,
    pub(super) median: f64,
    pub(super) worst: f64,
    pub(super) lost: usize,
    pub(super) count: usize,
    pub(super) timed: Option<Timed>,
}

impl Figure {
    /// For a diagram of several shapes.
    pub(super) fn with_shape(&self) -> Self {
        Self { method: format!("{}: {}", self.shape, self.method), ..self.clone() }
    }
}

pub(super) struct Study<'a> {
    pub(super) effort: Effort,
    pub(super) scalar: &'static str,
    pub(super) figures: &'a mut Vec<Figure>,
}

/// Errors over the size, with the worst and the median; a contact that was not found is lost.
pub(super) struct Errors {
    pub(super) values: Vec<f64>,
    pub(super) lost: usize,
}

impl Errors {
    pub(super) fn of(found: impl Iterator<Item = Option<f64>>) -> Self {
        let (mut values, mut lost) = (Vec::new(), 0);
        for error in found {
            match error {
                Some(error) => values.push(error),
                None => lost += 1,
            }
        }
        values.sort_by(f64::total_cmp);
        Self { values, lost }
    }
}

impl Study<'_> {
    pub(super) fn push(
        &mut self,
        shape: &'static str,
        method: impl Into<String>,
        inputs: &'static str,
        errors: Errors,
        timed: Option<Timed>,
    ) {
        let mut values = errors.values;
        self.figures.push(Figure {
            shape,
            method: method.into(),
            scalar: self.scalar,
            inputs,
            median: median(&mut values).max(1e-18),
            worst: values.last().copied().unwrap_or(f64::NAN).max(1e-18),
            lost: errors.lost,
            count: values.len() + errors.lost,
            timed,
        });
    }

    /// One model on one set of inputs: errors against the exact contact of what was read, or where
    /// there is noise or a model that neglects something, against the true contact.
    #[allow(clippy::too_many_arguments, reason = "what a study of one model consists of")]
    fn model<T: Real, S, M: ContactModel<T, S>>(
        &mut self,
        (shape, method): (&'static str, &str),
        surface: &S,
        model: &M,
        touches: &[Touch],
        (level, size): (Level, f64),
        exact: impl Fn(&Touch, &Wrench<T>) -> Option<Big3>,
        warm: bool,
    ) {
        for (inputs, spin, noise) in
            [("force", false, 0.0), ("spin", true, 0.0), ("spin and noise of 1 %", true, 0.01)]
        {
            let mut random = Pcg64Mcg::seed_from_u64(12);
            let read: Vec<Wrench<T>> =
                touches.iter().map(|touch| touch.wrench(spin, noise, size, &mut random)).collect();
            // The sample before was half a hundredth of the size away.
            let last: Vec<Vector3<T>> = touches
                .iter()
                .map(|t| (t.point + t.normal.cross(&t.force).normalize() * 0.005 * size).map(T::literal))
                .collect();
            let resolve = |index: usize| {
                let last = warm.then(|| &last[index]);
                model.resolve_near(black_box(&read[index]), surface, last)
            };
            let neglects = method.starts_with("point") && spin;
            let few = if matches!(level, Level::Superquadric { .. }) { 12 } else { touches.len() };
            let errors = Errors::of(touches.iter().zip(&read).enumerate().take(few).filter_map(
                |(index, (touch, wrench))| {
                    let Resolution::Contact(contact) = resolve(index) else { return Some(None) };
                    let found = if noise > 0.0 || neglects {
                        (contact.point.map(Real::to_f64) - touch.point).norm()
                    } else {
                        distance(&contact.point, &exact(touch, wrench)?)
                    };
                    Some(Some(found / size))
                },
            ));
            let timed = (noise == 0.0).then(|| {
                time(self.effort, touches.len(), || {
                    // By reference: a user's code has the answer in one place, too.
                    for index in 0..read.len() {
                        black_box(&resolve(index));
                    }
                })
            });
            self.push(shape, method, inputs, errors, timed);
        }
    }
}

impl<T: Real> Visitor<T> for Study<'_> {
    fn shape<S: SmoothSurface<T> + SoftFingerSurface<T>>(
        &mut self,
        name: &'static str,
        surface: S,
        level: Level,
        scale: f64,
    ) {
        let (Ok(point), Ok(soft)) = (PointContact::new(T::zero()), SoftFinger::new(T::zero())) else {
            return;
        };
        if !SHAPES.contains(&name) {
            return;
        }
        let size = level.size(scale);
        let mut random = Pcg64Mcg::seed_from_u64(11);
        let touches: Vec<Touch> = (0..self.effort.choose(16, 64))
            .map(|_| {
                let (point, normal) = level.sample(&mut random, scale);
                let force = pressing(&normal, random.random_range(0.5..1.0), &mut random) * 2.0;
                Touch { point, force, normal, spin: SPIN * 2.0 * size * random.random_range(-1.0..1.0) }
            })
            .collect();
        let place = (level, size);
        // Where several contacts explain a wrench, the one near the last is wanted.
        let several = name == "torus";
        let on_line = |touch: &Touch, wrench: &Wrench<T>| point_contact(level, wrench, &touch.point);
        self.model(
            (name, "point contact (wrench axis)"),
            &surface,
            &point,
            &touches,
            place,
            on_line,
            several,
        );
        // The exact answer to a force alone is that of the line; to a spin, that of all equations.
        let on_surface = |touch: &Touch, wrench: &Wrench<T>| soft_exactly(level, touch, wrench, size);
        let closed = matches!(name, "sphere" | "ellipsoid" | "cylinder" | "cone");
        let method = if closed { "soft finger, closed form" } else { "soft finger" };
        self.model((name, method), &surface, &soft, &touches, place, on_surface, several);
        let newton = Newton { surface: &surface, evaluations: Cell::new(0) };
        if !matches!(name, "cylinder" | "cone") {
            let name = (name, "soft finger, Newton from the last contact");
            self.model(name, &newton, &soft, &touches, place, on_surface, true);
        }
    }
}
