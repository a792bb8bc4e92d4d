//! Wrenches drawn by sums, products and roots alone, so that they are the same on every system.

use fingertip_surfaces::{ActiveSurface, DynSurface};
use fingertip_wrench::{Line, Real};
use nalgebra::{Matrix6, Vector3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub(super) struct Draw(Pcg64Mcg);

impl Draw {
    pub(super) fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    pub(super) fn within(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.0.random::<f64>()
    }

    pub(super) fn vector(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.within(-1.0, 1.0))
    }

    pub(super) fn direction(&mut self) -> Vector3<f64> {
        let vector = self.vector();
        vector / vector.norm()
    }

    /// From `least` to one, most of them small.
    pub(super) fn small(&mut self, least: f64) -> f64 {
        let mut value = self.within(0.5, 1.0);
        while value > least && self.0.random_range(0..8) > 0 {
            value *= 0.25;
        }
        value
    }

    pub(super) fn aside(&mut self, normal: &Vector3<f64>) -> Vector3<f64> {
        let across = normal.cross(&self.direction());
        across / across.norm()
    }

    /// Where some line through the middle leaves the surface, and the normal there; anywhere if none does.
    pub(super) fn place(&mut self, surface: &DynSurface<f64>, size: f64) -> (Vector3<f64>, Vector3<f64>) {
        let line = Line { point: self.vector() * (0.5 * size), direction: self.direction() };
        let mut seen = Vec::new();
        surface.crossings(&line, |crossing| seen.push((crossing.point, crossing.normal)));
        match seen.len() {
            0 => (line.point, line.direction),
            count => seen[self.0.random_range(0..count)],
        }
    }

    /// A force with a torque and the contact that it comes from, in turn: of a place, steep and flat, with and
    /// without spin; a pure force anywhere; one that grazes, one that misses; any force and torque; the force
    /// along an axis, through the middle.
    pub(super) fn load(&mut self, surface: &DynSurface<f64>, kind: usize, size: f64) -> [Vector3<f64>; 3] {
        let (point, normal) = self.place(surface, size);
        let aside = self.aside(&normal);
        let (force, spin) = match kind % 8 {
            0 => (aside * self.within(0.0, 1.0) - normal, 0.0),
            1 => (aside * self.within(0.0, 1.0) - normal, self.within(-0.3, 0.3)),
            2 => (aside - normal * self.small(1e-6), 0.0),
            3 => (aside - normal * self.small(1e-6), self.within(-1.0, 1.0) * self.small(1e-9)),
            4 => (aside * self.within(0.0, 1.0) - normal, self.within(-40.0, 40.0)),
            5 => {
                let beside = point + normal * ((self.small(1e-9) - self.small(1e-9)) * size);
                return [aside, beside.cross(&aside), point];
            }
            6 => {
                let force = self.direction();
                let torque = self.vector() * (self.within(0.0, 2.0) * size);
                return [force, torque, point];
            }
            _ => {
                let mut force = Vector3::zeros();
                force[self.0.random_range(0..3)] = self.within(-1.0, 1.0);
                let through = self.vector() * (self.small(1e-9) * size);
                return [force, through.cross(&force), point];
            }
        };
        [force, point.cross(&force) + normal * (spin * size), point]
    }
}

/// Noise of some millinewtons and tens of micronewton metres, correlated.
pub(super) fn noise<T: Real>() -> Matrix6<T> {
    let mut draw = Draw::new(3);
    let scale = Vector6::new(2e-3, 1e-3, 3e-3, 2e-5, 3e-5, 1e-5);
    let mix =
        Matrix6::from_fn(|i, j| draw.within(-0.4, 0.4) * scale[i] + if i == j { scale[i] } else { 0.0 });
    let full = (mix * mix.transpose()).map(T::literal);
    (full + full.transpose()) * T::literal(0.5)
}
