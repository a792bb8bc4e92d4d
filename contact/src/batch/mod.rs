//! Point contacts of many wrenches at once, as structures of arrays that the compiler vectorises:
//! for simulation and learning.
//!
//! ```
//! use fingertip_surfaces::Sphere;
//! use fingertip_contact::batch::{BatchSurface, Contacts, Wrenches};
//!
//! let sphere = Sphere::centred(0.013_f32)?;
//! let force = [vec![0.0; 2], vec![0.0, 0.1], vec![-1.0, -2.0]];
//! let torque = [vec![0.001, 0.0], vec![0.0; 2], vec![0.0; 2]];
//! let [mut x, mut y, mut z] = [vec![0.0; 2], vec![0.0; 2], vec![0.0; 2]];
//! let [mut nx, mut ny, mut nz, mut gap] = [vec![0.0; 2], vec![0.0; 2], vec![0.0; 2], vec![0.0; 2]];
//! sphere.contacts(
//!     Wrenches { force: force.each_ref().map(|v| &v[..]), torque: torque.each_ref().map(|v| &v[..]) },
//!     Contacts { point: [&mut x, &mut y, &mut z], normal: [&mut nx, &mut ny, &mut nz], gap: &mut gap },
//! );
//! assert_eq!(gap, [0.0, 0.0]);
//! # Ok::<(), fingertip_surfaces::BadShape>(())
//! ```

pub(crate) mod kernel;
mod sweep;

use fingertip_surfaces::ForceParts;
use fingertip_wrench::Real;

/// Wrenches on the fingertip: one slice per component, x, y and z.
#[derive(Clone, Copy, Debug)]
pub struct Wrenches<'a, T> {
    /// Force \[N\].
    pub force: [&'a [T]; 3],
    /// Torque about the origin of the sensor frame \[N·m\].
    pub torque: [&'a [T]; 3],
}

/// Where the contacts are written: one slice per component.
#[derive(Debug)]
pub struct Contacts<'a, T> {
    /// Point of entry, or for a line that misses the closest point of the surface \[m\].
    pub point: [&'a mut [T]; 3],
    /// Outward unit normal there.
    pub normal: [&'a mut [T]; 3],
    /// Zero for a contact; for a line that misses, its distance from the surface \[m\]; the
    /// greatest finite number where there is no answer (no force, not finite, only pulling); point
    /// and normal are zero then.
    pub gap: &'a mut [T],
}

/// Which lines a loop has to expect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lines {
    /// Those that meet the surface; of others, only that they may not.
    Meeting,
    /// Any.
    Any,
}

/// Where the line of a force enters a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entered<T: Real> {
    /// Point of entry, or for a line that misses the closest point of the surface \[m\].
    pub point: [T; 3],
    /// Outward unit normal there.
    pub normal: [T; 3],
    /// What the force's parts along the normal and along the surface measure.
    pub parts: ForceParts<T>,
    /// As in [`Contacts`].
    pub gap: T,
    /// `false` if there is no answer, all else being zero then; of [`Lines::Meeting`] also if the line may
    /// not meet the surface, and then all else means nothing.
    pub certain: bool,
}

/// Surfaces that resolve point contacts in batches.
///
/// The outcome of each wrench is that of [`PointContact`](crate::PointContact) with no threshold, but
/// for rounding, and that forces whose square
/// [`ForceLine`](fingertip_surfaces::ForceLine) does not take (below 1e-12 N or above 1e12 N in single precision) have
/// no answer. Of slices of different lengths, the shortest counts.
///
/// Batches are fastest where all lines meet the surface, and where the columns do not begin at the same
/// place of a memory page: thirteen columns of a multiple of 4 KiB, one after another, compete for the
/// same lines of the cache and take up to three times as long. A few numbers of padding help.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no kernel for columns of `{T}`",
    note = "shapes of closed form have one; others take wrenches one by one, by `ContactModel::resolve`"
)]
pub trait BatchSurface<T: Real> {
    /// Resolves all wrenches, with the widest vectors of the processor at hand if the feature `simd` is
    /// on. Wider vectors do the same operations on more wrenches at once: nothing is fused or reordered.
    #[inline]
    fn contacts(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>) {
        #[cfg(feature = "simd")]
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || self.contacts_in_line(wrenches, contacts),
        );
        #[cfg(not(feature = "simd"))]
        self.contacts_in_line(wrenches, contacts);
    }

    /// [`contacts`](Self::contacts) compiled into the caller, with the vectors that the caller has: for
    /// those who have chosen theirs already. To be always in line.
    fn contacts_in_line(&self, wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>);

    /// `true` if the surface is centred at the origin of the sensor frame, so that [`enter`](Self::enter) may
    /// be told so.
    #[inline(always)]
    fn is_at_origin(&self) -> bool {
        false
    }

    /// Where the line of one force \[N\] and its torque about the origin \[N·m\] enters, for loops over
    /// many: in line, and without a branch, so that the loop can be vectorised. Where the line meets, both
    /// kinds of `lines` give the same bits; the fewer are expected, the less there is to choose.
    /// `at_origin` may be `true` only if [`is_at_origin`](Self::is_at_origin) is, and gives the same bits but
    /// for the signs of zeros: to be asked before the loop, lest it is asked for every line.
    ///
    /// The default looks at a batch of one.
    #[inline(always)]
    fn enter(&self, force: [T; 3], torque: [T; 3], lines: Lines, at_origin: bool) -> Entered<T> {
        let _ = at_origin;
        let mut found = [T::zero(); 7];
        let [px, py, pz, nx, ny, nz, gap] = found.each_mut().map(core::slice::from_mut);
        self.contacts_in_line(
            Wrenches {
                force: force.each_ref().map(core::slice::from_ref),
                torque: torque.each_ref().map(core::slice::from_ref),
            },
            Contacts { point: [px, py, pz], normal: [nx, ny, nz], gap },
        );
        let [px, py, pz, nx, ny, nz, gap] = found;
        let (point, normal) = ([px, py, pz], [nx, ny, nz]);
        let certain = if lines == Lines::Meeting { gap == T::zero() } else { gap < T::GREATEST };
        Entered { point, normal, parts: kernel::parts_at(force, normal), gap, certain }
    }
}
