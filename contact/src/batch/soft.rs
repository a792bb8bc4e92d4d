//! Columns of soft fingers.

use fingertip_surfaces::ForceLine;
use fingertip_wrench::{Real, Wrench};

use super::Wrenches;
use super::each::{Row, each, nothing};
use crate::soft_finger::resolve::is_in_range as is_number;
use crate::{ContactModel, SoftFinger, SoftFingerSurface};

/// Where the contacts of soft fingers are written: one slice per component.
///
/// ```
/// use fingertip_contact::batch::{SoftContacts, Wrenches};
/// use fingertip_contact::SoftFinger;
/// use fingertip_surfaces::Sphere;
///
/// // 2 N down on a sphere of 10 mm, once with 1.5 N·mm about the normal; then 2 N that pull.
/// let wrenches = Wrenches {
///     force: [&[0.0; 3], &[0.0; 3], &[-2.0, -2.0, 0.0]],
///     torque: [&[0.0; 3], &[0.0; 3], &[0.0, 1.5e-3, 0.0]],
/// };
/// let ([mut x, mut y, mut z], [mut nx, mut ny, mut nz], mut spin) = ([[0.0_f64; 3]; 3], [[0.0; 3]; 3], [0.0; 3]);
/// SoftFinger::new(0.1)?.resolve_all(
///     &Sphere::centred(0.01)?,
///     wrenches,
///     SoftContacts { point: [&mut x, &mut y, &mut z], normal: [&mut nx, &mut ny, &mut nz], spin_torque: &mut spin },
/// );
/// assert!((z[1] - 0.01).abs() < 1e-15 && (spin[1] - 1.5e-3).abs() < 1e-15);
/// // No force is no contact.
/// assert_eq!((nx[2], ny[2], nz[2]), (0.0, 0.0, 0.0));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Debug)]
pub struct SoftContacts<'a, T> {
    /// The contact centroid \[m\]; zero where there is no contact.
    pub point: [&'a mut [T]; 3],
    /// Outward unit normal there; zero where there is no contact, which tells it.
    pub normal: [&'a mut [T]; 3],
    /// Spin torque about that normal \[N·m\]; zero where there is no contact.
    pub spin_torque: &'a mut [T],
}

impl<T: Real> SoftFinger<T> {
    /// Resolves all wrenches, each to what [`resolve`](crate::ContactModel::resolve) says of it, to the bit.
    ///
    /// On shapes with a closed form it is a loop with the widest vectors of the processor at hand, if the feature
    /// `simd` is on; where a force meets the surface at a flat angle, and on other shapes, wrenches are taken one by one.
    /// Of slices of different lengths, the shortest counts. An example is at [`SoftContacts`].
    #[inline]
    pub fn resolve_all<S: SoftFingerSurface<T>>(
        &self,
        surface: &S,
        wrenches: Wrenches<'_, T>,
        contacts: SoftContacts<'_, T>,
    ) {
        #[cfg(feature = "simd")]
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || self.resolve_all_in_line(surface, wrenches, contacts),
        );
        #[cfg(not(feature = "simd"))]
        self.resolve_all_in_line(surface, wrenches, contacts);
    }

    #[inline(always)]
    fn resolve_all_in_line<S: SoftFingerSurface<T>>(
        &self,
        surface: &S,
        wrenches: Wrenches<'_, T>,
        contacts: SoftContacts<'_, T>,
    ) {
        let SoftContacts { point: [px, py, pz], normal: [nx, ny, nz], spin_torque } = contacts;
        let (least_squared, sole) = (self.least_squared, surface.sole_soft_contacts_in_columns());
        each(
            wrenches,
            [px, py, pz, nx, ny, nz, spin_torque],
            #[inline(always)]
            move |wrench| {
                let (push, is_in_range) = ForceLine::tried(wrench, least_squared);
                let contact = sole(&push);
                let told = is_in_range & contact.is_some_and(|found| found.active & is_number(&found));
                (contact.map_or_else(nothing, |found| (found.point, found.normal, found.spin_torque)), told)
            },
            &|wrench| alone(self, wrench, surface),
        );
    }
}

#[cold]
#[inline(never)]
fn alone<T: Real, S: SoftFingerSurface<T>>(model: &SoftFinger<T>, wrench: &Wrench<T>, surface: &S) -> Row<T> {
    model
        .resolve(wrench, surface)
        .contact()
        .map_or_else(nothing, |contact| (contact.point, contact.normal, contact.spin_torque))
}
