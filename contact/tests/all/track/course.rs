//! Contacts that move over a surface at random, and what a noisy sensor sees of them.

use fingertip_contact::{ContactModel, PointContact, Sighting, WrenchSpread};
use fingertip_surfaces::{ActiveSurface, nearest_crossing};
use fingertip_wrench::{Line, Wrench};
use nalgebra::{Vector2, Vector3};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// A sensor of 2 mN and 30 µN·m.
pub(super) const FORCE_NOISE: f64 = 2e-3;
pub(super) const TORQUE_NOISE: f64 = 30e-6;
pub(super) const NOISE: WrenchSpread<'static, f64> =
    WrenchSpread::Isotropic { force: FORCE_NOISE * FORCE_NOISE, torque: TORQUE_NOISE * TORQUE_NOISE };

/// A contact with white acceleration in its tangent plane.
pub(super) struct Course<'a, S> {
    surface: &'a S,
    pub(super) point: Vector3<f64>,
    pub(super) normal: Vector3<f64>,
    pub(super) velocity: Vector3<f64>,
    random: Pcg64Mcg,
    density: f64,
}

impl<'a, S: ActiveSurface<f64>> Course<'a, S> {
    /// From a place of the surface out along `from`, with the velocity that a tracker of this speed expects.
    pub(super) fn new(surface: &'a S, from: Vector3<f64>, speed: f64, within: f64, seed: u64) -> Self {
        let start = nearest_crossing(surface, &Line { point: from, direction: from.normalize() }).unwrap();
        let mut course = Self {
            surface,
            point: start.point,
            normal: start.normal,
            velocity: Vector3::zeros(),
            random: Pcg64Mcg::seed_from_u64(seed),
            density: speed / within.sqrt(),
        };
        let drawn = course.drawn();
        course.velocity = course.in_plane(&drawn) * speed;
        course
    }

    fn number(&mut self) -> f64 {
        StandardNormal.sample(&mut self.random)
    }

    fn drawn(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.number())
    }

    fn in_plane(&self, v: &Vector3<f64>) -> Vector3<f64> {
        v - self.normal * v.dot(&self.normal)
    }

    /// Lets a time pass. The way over an edge is that of the unfolded faces.
    pub(super) fn wait(&mut self, time: f64) {
        let parts = 4;
        let step = time / f64::from(parts);
        for _ in 0..parts {
            let drawn = self.drawn();
            self.velocity += self.in_plane(&drawn) * (self.density * step.sqrt());
            let beside = self.point + self.velocity * step;
            // Straight back, as the steps are tiny.
            let straight = Line { point: beside, direction: self.normal.normalize() };
            let Some(back) = nearest_crossing(self.surface, &straight) else {
                panic!("nothing below {beside:?} along {:?}, from {:?}", self.normal, self.point)
            };
            let turned = self.velocity
                - (self.normal + back.normal)
                    * (back.normal.dot(&self.velocity) / (1.0 + self.normal.dot(&back.normal)));
            (self.point, self.normal, self.velocity) = (back.point, back.normal, turned);
        }
    }

    /// Places the contact elsewhere.
    pub(super) fn jump(&mut self, from: Vector3<f64>) {
        let there =
            nearest_crossing(self.surface, &Line { point: from, direction: from.normalize() }).unwrap();
        (self.point, self.normal, self.velocity) = (there.point, there.normal, Vector3::zeros());
    }

    /// What the sensor reports of a force of so many newtons straight in.
    pub(super) fn wrench(&mut self, force: f64) -> Wrench<f64> {
        let exact = Wrench::from_force_at(&self.point, -self.normal * force);
        let (f, m) = (self.drawn() * FORCE_NOISE, self.drawn() * TORQUE_NOISE);
        exact + Wrench::on_fingertip(f, m)
    }

    pub(super) fn sighting(&mut self, force: f64) -> Option<Sighting<f64>> {
        let wrench = self.wrench(force);
        let found = PointContact::new(1e-3).unwrap().resolve_near(&wrench, self.surface, Some(&self.point));
        Sighting::of_point_contact(found.contact()?, &wrench, NOISE)
    }
}

/// The components of a displacement along two tangents.
pub(super) fn along(tangents: &[Vector3<f64>; 2], v: &Vector3<f64>) -> Vector2<f64> {
    Vector2::new(tangents[0].dot(v), tangents[1].dot(v))
}
