//! Touches as columns, and what was found of them.

use fingertip_contact::batch::BatchSurface;
use fingertip_contact::{SoftFinger, SoftFingerSurface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::study::{Errors, Touch};
use crate::reference::distance;
use crate::stability::big::Big3;

/// Touches, and their wrenches as columns.
pub(super) struct Columns<T: Real> {
    pub(super) touches: Vec<(Touch, Wrench<T>)>,
    columns: fingertip_benches::Columns<T>,
    pub(super) size: f64,
}

impl<T: Real> Columns<T> {
    /// Of touches and the wrenches that are read of them, on a shape of a size \[m\].
    pub(super) fn new(touches: Vec<(Touch, Wrench<T>)>, size: f64) -> Self {
        let columns = fingertip_benches::Columns::new(touches.iter().map(|(_, wrench)| *wrench));
        Self { touches, columns, size }
    }

    /// The point contacts, and the gap last.
    pub(super) fn point_contacts(&mut self, surface: &impl BatchSurface<T>) {
        self.columns.point_contacts(surface);
    }

    /// The contacts of the soft finger, and their spin torque last.
    pub(super) fn soft_contacts(&mut self, model: &SoftFinger<T>, surface: &impl SoftFingerSurface<T>) {
        self.columns.soft_contacts(model, surface);
    }

    /// Of the first touches, and of those alone that `is_contact` says of what was found: the others are lost.
    pub(super) fn errors(
        &self,
        is_contact: impl Fn([T; 7]) -> bool,
        exact: impl Fn(&Touch, &Wrench<T>) -> Option<Big3>,
    ) -> Errors {
        Errors::of(self.touches.iter().take(64).enumerate().filter_map(|(k, (touch, wrench))| {
            let found = self.columns.found(k);
            if !is_contact(found) {
                return Some(None);
            }
            let [x, y, z, ..] = found;
            Some(Some(distance(&Vector3::new(x, y, z), &exact(touch, wrench)?) / self.size))
        }))
    }
}
