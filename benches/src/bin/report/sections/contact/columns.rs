//! Touches as columns, and what was found of them.

use core::hint::black_box;

use fingertip_contact::batch::{BatchSurface, Contacts, SoftContacts, Wrenches};
use fingertip_contact::{SoftFinger, SoftFingerSurface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::study::{Errors, Touch};
use crate::reference::distance;
use crate::stability::big::Big3;

/// Touches, and their wrenches as columns.
pub(super) struct Columns<T: Real> {
    pub(super) touches: Vec<(Touch, Wrench<T>)>,
    force: [Vec<T>; 3],
    torque: [Vec<T>; 3],
    found: [Vec<T>; 7],
    pub(super) size: f64,
}

impl<T: Real> Columns<T> {
    /// Of touches and the wrenches that are read of them, on a shape of a size \[m\].
    pub(super) fn new(touches: Vec<(Touch, Wrench<T>)>, size: f64) -> Self {
        let column = |k: usize, pick: fn(&Wrench<T>) -> Vector3<T>| -> Vec<T> {
            touches.iter().map(|(_, wrench)| pick(wrench)[k]).collect()
        };
        let force = [0, 1, 2].map(|k| column(k, Wrench::force));
        let torque = [0, 1, 2].map(|k| column(k, Wrench::torque));
        let found = [(); 7].map(|()| vec![T::zero(); touches.len()]);
        Self { touches, force, torque, found, size }
    }

    /// The point contacts, and the gap last.
    pub(super) fn point_contacts(&mut self, surface: &impl BatchSurface<T>) {
        self.resolve(|wrenches, [px, py, pz, nx, ny, nz, gap]| {
            surface.contacts(wrenches, Contacts { point: [px, py, pz], normal: [nx, ny, nz], gap });
        });
    }

    /// The contacts of the soft finger, and their spin torque last.
    pub(super) fn soft_contacts(&mut self, model: &SoftFinger<T>, surface: &impl SoftFingerSurface<T>) {
        self.resolve(|wrenches, [px, py, pz, nx, ny, nz, spin_torque]| {
            let contacts = SoftContacts { point: [px, py, pz], normal: [nx, ny, nz], spin_torque };
            model.resolve_all(surface, wrenches, contacts);
        });
    }

    fn resolve(&mut self, resolve: impl Fn(Wrenches<'_, T>, [&mut [T]; 7])) {
        let Self { force, torque, found, .. } = self;
        let wrenches =
            Wrenches { force: force.each_ref().map(|v| &v[..]), torque: torque.each_ref().map(|v| &v[..]) };
        resolve(wrenches, found.each_mut().map(|column| &mut column[..]));
        black_box(found);
    }

    /// Of the first touches, and of those alone that `is_contact` says of what was found: the others are lost.
    pub(super) fn errors(
        &self,
        is_contact: impl Fn([T; 7]) -> bool,
        exact: impl Fn(&Touch, &Wrench<T>) -> Option<Big3>,
    ) -> Errors {
        Errors::of(self.touches.iter().take(64).enumerate().filter_map(|(k, (touch, wrench))| {
            let found = self.found.each_ref().map(|column| column[k]);
            if !is_contact(found) {
                return Some(None);
            }
            let [x, y, z, ..] = found;
            Some(Some(distance(&Vector3::new(x, y, z), &exact(touch, wrench)?) / self.size))
        }))
    }
}
