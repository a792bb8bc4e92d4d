//! Random wrenches with the contacts that they come from. The benches share this file.

use fingertip_surfaces::ActiveSurface;
use fingertip_wrench::{Line, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub(crate) struct Random(pub(crate) Pcg64Mcg);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    pub(crate) fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        self.uniform(low.ln(), high.ln()).exp()
    }

    pub(crate) fn sign(&mut self) -> f64 {
        if self.0.random::<bool>() { 1.0 } else { -1.0 }
    }

    pub(crate) fn direction(&mut self) -> Vector3<f64> {
        let z = self.uniform(-1.0, 1.0);
        let angle = self.uniform(0.0, core::f64::consts::TAU);
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * angle.cos(), r * angle.sin(), z)
    }

    pub(crate) fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.0.random::<f64>(), self.0.random::<f64>());
        (-2.0 * u.ln()).sqrt() * (core::f64::consts::TAU * v).cos()
    }

    /// A point of the surface within a ball around the origin, with its normal.
    pub(crate) fn place<S: ActiveSurface<f64>>(
        &mut self,
        surface: &S,
        reach: f64,
    ) -> (Vector3<f64>, Vector3<f64>) {
        loop {
            let point = self.direction() * self.uniform(0.0, reach);
            let line = Line { point, direction: self.direction() };
            let mut seen = Vec::new();
            surface.crossings(&line, |c| {
                if c.point.norm() <= reach * 1.8 && c.active {
                    seen.push((c.point, c.normal));
                }
            });
            if !seen.is_empty() {
                return seen[self.0.random_range(0..seen.len())];
            }
        }
    }

    /// A force that presses on a normal, with an incidence of at least `least`.
    pub(crate) fn force(&mut self, normal: &Vector3<f64>, least: f64, magnitude: f64) -> Vector3<f64> {
        loop {
            let direction = self.direction();
            if -direction.dot(normal) >= least {
                return direction * magnitude;
            }
        }
    }
}

/// A wrench with the contact that it came from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) wrench: Wrench<f64>,
    pub(crate) point: Vector3<f64>,
    pub(crate) normal: Vector3<f64>,
    pub(crate) spin: f64,
    pub(crate) incidence: f64,
}

impl Case {
    pub(crate) fn new(point: Vector3<f64>, normal: Vector3<f64>, force: Vector3<f64>, spin: f64) -> Self {
        Self {
            wrench: Wrench::on_fingertip(force, point.cross(&force) + normal * spin),
            point,
            normal,
            spin,
            incidence: -force.dot(&normal) / force.norm(),
        }
    }

    /// With a relative spin torque between the bounds, in units of force times size.
    pub(crate) fn random<S: ActiveSurface<f64>>(
        random: &mut Random,
        surface: &S,
        size: f64,
        spins: [f64; 2],
        magnitude: f64,
    ) -> Self {
        let (point, normal) = random.place(surface, size);
        let force = random.force(&normal, 0.05, magnitude);
        let spin = random.sign() * random.log_uniform(spins[0], spins[1]) * magnitude * size;
        Self::new(point, normal, force, spin)
    }
}
