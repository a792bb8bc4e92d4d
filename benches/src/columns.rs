//! Wrenches as columns, and room for what is found of them.

use core::hint::black_box;

use fingertip_contact::batch::{BatchSurface, Contacts, SoftContacts, Wrenches};
use fingertip_contact::{SoftFinger, SoftFingerSurface};
use fingertip_wrench::{Real, Wrench};

/// A column for each component of the wrenches, and for each number that is found of them.
///
/// ```
/// use fingertip_benches::Columns;
/// use fingertip_contact::SoftFinger;
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // 2 N down on a sphere of 10 mm, with 1.5 N·mm about the normal.
/// let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0_f64), Vector3::new(0.0, 0.0, 1.5e-3));
/// let mut columns = Columns::new([wrench; 3]);
/// columns.soft_contacts(&SoftFinger::new(0.1)?, &Sphere::centred(0.01)?);
/// let [x, .., spin_torque] = columns.found(2);
/// assert!(x == 0.0 && (spin_torque - 1.5e-3).abs() < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Columns<T> {
    given: [Vec<T>; 6],
    found: [Vec<T>; 7],
}

impl<T: Real> Columns<T> {
    /// Of wrenches.
    pub fn new(wrenches: impl IntoIterator<Item = Wrench<T>>) -> Self {
        let mut given: [Vec<T>; 6] = Default::default();
        for wrench in wrenches {
            for (column, component) in given.iter_mut().zip(wrench.components().iter()) {
                column.push(*component);
            }
        }
        let found = [(); 7].map(|()| vec![T::zero(); given[0].len()]);
        Self { given, found }
    }

    /// The point contacts, and the gap last.
    pub fn point_contacts(&mut self, surface: &impl BatchSurface<T>) {
        self.resolve(|wrenches, [px, py, pz, nx, ny, nz, gap]| {
            surface.contacts(wrenches, Contacts { point: [px, py, pz], normal: [nx, ny, nz], gap });
        });
    }

    /// The contacts of the soft finger, and their spin torque last.
    pub fn soft_contacts(&mut self, model: &SoftFinger<T>, surface: &impl SoftFingerSurface<T>) {
        self.resolve(|wrenches, [px, py, pz, nx, ny, nz, spin_torque]| {
            let contacts = SoftContacts { point: [px, py, pz], normal: [nx, ny, nz], spin_torque };
            model.resolve_all(surface, wrenches, contacts);
        });
    }

    /// What was found of a wrench: point, normal, and gap or spin torque.
    #[must_use]
    pub fn found(&self, index: usize) -> [T; 7] {
        self.found.each_ref().map(|column| column[index])
    }

    fn resolve(&mut self, resolve: impl Fn(Wrenches<'_, T>, [&mut [T]; 7])) {
        let Self { given, found } = self;
        let [fx, fy, fz, tx, ty, tz] = given.each_ref().map(|column| &column[..]);
        let wrenches = black_box(Wrenches { force: [fx, fy, fz], torque: [tx, ty, tz] });
        resolve(wrenches, found.each_mut().map(|column| &mut column[..]));
        black_box(found);
    }
}
