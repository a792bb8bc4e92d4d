//! The crossings of one line, gathered and sorted.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::{ActiveSurface, Crossing};

/// More than any shape here has.
const MOST: usize = 64;

pub(super) struct Crossings<T: Real> {
    found: [Crossing<T>; MOST],
    count: usize,
}

impl<T: Real> Crossings<T> {
    pub(super) fn of(surface: &impl ActiveSurface<T>, line: &Line<T>) -> Self {
        let nowhere =
            Crossing { along: T::zero(), point: Vector3::zeros(), normal: Vector3::zeros(), active: false };
        let mut all = Self { found: [nowhere; MOST], count: 0 };
        surface.crossings(line, |crossing| {
            if let Some(place) = all.found.get_mut(all.count) {
                *place = crossing;
            }
            all.count += 1;
        });
        all.count = all.count.min(MOST);
        if let Some(found) = all.found.get_mut(..all.count) {
            found
                .sort_unstable_by(|a, b| a.along.partial_cmp(&b.along).unwrap_or(core::cmp::Ordering::Equal));
        }
        all
    }

    pub(super) fn as_slice(&self) -> &[Crossing<T>] {
        self.found.get(..self.count).unwrap_or(&[])
    }

    /// The least angle with the surface, as a cosine to its normals.
    pub(super) fn least_incidence(&self, line: &Line<T>) -> T {
        self.as_slice().iter().fold(T::one(), |least, c| least.min(c.normal.dot(&line.direction).abs()))
    }

    /// The crossing nearest to a position along the line that faces the same way.
    pub(super) fn nearest(&self, line: &Line<T>, to: &Crossing<T>) -> Option<&Crossing<T>> {
        let faces = |c: &Crossing<T>| c.normal.dot(&line.direction) > T::zero();
        let distance = |c: &Crossing<T>| (c.point - to.point).norm_squared();
        self.as_slice()
            .iter()
            .filter(|c| faces(c) == faces(to))
            .min_by(|a, b| distance(a).partial_cmp(&distance(b)).unwrap_or(core::cmp::Ordering::Equal))
    }
}
