//! What the tests of this crate share.
#![allow(dead_code, reason = "each program of tests uses its part")]

pub(crate) mod clarabel_oracle;

use fingertip_hand::{FingerLimits, Grasp, GraspContact};
use fingertip_wrench::{Frame, Real, Wrench};
use nalgebra::Vector3;
use rand::{Rng, RngExt};

/// A frame of the tests' own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TestHand;

impl Frame for TestHand {
    const NAME: &'static str = "test hand";
}

pub(crate) fn vector(rng: &mut impl Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.random_range(-1.0..1.0))
}

/// In every precision the same problem.
pub(crate) fn narrow<T: Real>(v: Vector3<f64>) -> Vector3<T> {
    v.map(T::literal)
}

/// Contacts on an object of random shape and size, as numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) point: Vector3<f64>,
    pub(crate) normal: Vector3<f64>,
    pub(crate) friction: f64,
    pub(crate) arm: Option<f64>,
}

impl Place {
    pub(crate) fn contact<T: Real>(&self) -> GraspContact<T, TestHand> {
        let (point, normal, friction) = (narrow(self.point), narrow(self.normal), T::literal(self.friction));
        match self.arm {
            Some(arm) => GraspContact::soft(point, normal, friction, T::literal(arm)).unwrap(),
            None => GraspContact::point(point, normal, friction).unwrap(),
        }
    }
}

/// `touching` of `N` fingers around an object of a few centimetres.
pub(crate) fn places<const N: usize>(rng: &mut impl Rng, touching: usize) -> [Option<Place>; N] {
    let axes = Vector3::from_fn(|_, _| rng.random_range(0.01..0.05));
    let centre = vector(rng) * 0.1;
    let mut places = [None; N];
    for place in places.iter_mut().take(touching) {
        let direction = loop {
            let v = vector(rng);
            if v.norm() > 0.1 && v.norm() < 1.0 {
                break v.normalize();
            }
        };
        let inward = -direction.component_div(&axes).normalize() + vector(rng) * 0.2;
        *place = Some(Place {
            point: centre + direction.component_mul(&axes),
            normal: inward,
            friction: rng.random_range(0.2..1.2),
            arm: (rng.random_range(0.0..1.0) < 0.6).then(|| rng.random_range(5e-4..5e-3)),
        });
    }
    places
}

/// A random grasp with limits and a load.
pub(crate) struct Problem<const N: usize> {
    pub(crate) grasp: Grasp<f64, N, TestHand>,
    pub(crate) limits: [FingerLimits<f64, 2>; N],
    pub(crate) load: Wrench<f64, TestHand>,
}

pub(crate) fn problem<const N: usize>(rng: &mut impl Rng) -> Problem<N> {
    let touching = rng.random_range(2..=N);
    let places = places::<N>(rng, touching);
    let grasp = Grasp::new(places.map(|place| place.map(|place| place.contact())));
    let force = vector(rng) * 3.0;
    let about = grasp.centre() + vector(rng) * 0.02;
    let load = Wrench::from_force_at(&about, force)
        + Wrench::on_fingertip(Vector3::zeros(), vector(rng) * rng.random_range(0.0..0.02));
    let mut limits = [FingerLimits::none(); N];
    for limits in &mut limits {
        if rng.random_range(0.0..1.0) < 0.3 {
            *limits = limits.with_greatest_normal(rng.random_range(1.0..30.0)).unwrap();
        }
        if rng.random_range(0.0..1.0) < 0.3 {
            *limits = limits.with_least_normal(rng.random_range(0.05..0.9)).unwrap();
        }
        *limits = limits.with_cost(rng.random_range(0.3..3.0)).unwrap();
    }
    Problem { grasp, limits, load }
}
