//! Point contacts of many wrenches at once, as structures of arrays that the compiler vectorises:
//! for simulation and learning.
//!
//! The loops are compiled with the program that calls them, which wants `codegen-units = 1` in its profile: in the sixteen
//! parts that Cargo takes for a release, those with a square root do not become vectors.
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

pub(crate) mod each;
pub(crate) mod kernel;
mod soft;
pub(crate) mod sweep;

pub use soft::SoftContacts;

use fingertip_surfaces::ForceParts;
use fingertip_wrench::Real;

/// Wrenches on the fingertip: one slice per component, x, y and z.
///
/// ```
/// use fingertip_contact::batch::{BatchSurface, Contacts, Wrenches};
/// use fingertip_surfaces::Sphere;
///
/// // Two forces through the centre of a sphere of 10 mm \[N\]: one down, one to the left.
/// let wrenches =
///     Wrenches { force: [&[0.0, -1.0], &[0.0, 0.0], &[-1.0, 0.0]], torque: [&[0.0; 2], &[0.0; 2], &[0.0; 2]] };
/// let mut answers = [[0.0_f64; 2]; 7];
/// let [x, y, z, nx, ny, nz, gap] = answers.each_mut().map(|column| &mut column[..]);
/// Sphere::centred(0.01)?.contacts(wrenches, Contacts { point: [x, y, z], normal: [nx, ny, nz], gap });
/// let [x, _, z, ..] = answers;
/// assert!((z[0] - 0.01).abs() < 1e-15 && (x[1] - 0.01).abs() < 1e-15);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Wrenches<'a, T> {
    /// Force \[N\].
    pub force: [&'a [T]; 3],
    /// Torque about the origin of the sensor frame \[N·m\].
    pub torque: [&'a [T]; 3],
}

/// Where the contacts are written: one slice per component.
///
/// ```
/// use fingertip_contact::batch::{BatchSurface, Contacts, Wrenches};
/// use fingertip_surfaces::Sphere;
///
/// // 1 N down, along a line that passes the axis of a sphere of 10 mm at 12 mm.
/// let wrenches = Wrenches { force: [&[0.0], &[0.0], &[-1.0]], torque: [&[0.0], &[0.012], &[0.0]] };
/// let ([mut x, mut y, mut z], [mut nx, mut ny, mut nz], mut gap) = ([[0.0_f64]; 3], [[0.0]; 3], [0.0]);
/// Sphere::centred(0.01)?.contacts(
///     wrenches,
///     Contacts { point: [&mut x, &mut y, &mut z], normal: [&mut nx, &mut ny, &mut nz], gap: &mut gap },
/// );
/// // It misses by 2 mm, and the closest point is at the side.
/// assert!((gap[0] - 2e-3).abs() < 1e-12 && (x[0] - 0.01).abs() < 1e-12);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
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
///
/// ```
/// use fingertip_contact::batch::{BatchSurface, Lines};
/// use fingertip_surfaces::Sphere;
///
/// // 1 N down at x = 12 mm misses a sphere of 10 mm.
/// let sphere = Sphere::centred(0.01_f64)?;
/// let (newtons, newton_metres) = ([0.0, 0.0, -1.0], [0.0, 0.012, 0.0]);
/// assert!(!sphere.enter(newtons, newton_metres, Lines::Meeting, false).certain);
/// // Whoever expects such lines is told how far it misses.
/// let missed = sphere.enter(newtons, newton_metres, Lines::Any, false);
/// assert!(missed.certain && (missed.gap - 2e-3).abs() < 1e-12);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lines {
    /// Those that meet the surface; of others, only that they may not.
    Meeting,
    /// Any.
    Any,
}

/// Where the line of a force enters a surface.
///
/// ```
/// use fingertip_contact::batch::{BatchSurface, Entered, Lines};
/// use fingertip_surfaces::Sphere;
///
/// // 1 N down and 0.3 N aside, at the top of a sphere of 10 mm.
/// let (newtons, newton_metres) = ([0.3, 0.0, -1.0], [0.0, 3e-3, 0.0]);
/// let entered: Entered<f64> = Sphere::centred(0.01)?.enter(newtons, newton_metres, Lines::Meeting, false);
/// assert!(entered.certain && (entered.point[2] - 0.01).abs() < 1e-12);
/// assert!((entered.parts.normal - 1.0).abs() < 1e-12 && (entered.parts.tangential - 0.3).abs() < 1e-12);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
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
///
/// ```
/// use fingertip_contact::batch::{BatchSurface, Contacts, Wrenches};
/// use fingertip_contact::{ContactModel, PointContact};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let sphere = Sphere::centred(0.01)?;
/// // A thousand forces of 2 N, to all sides of a sphere of 10 mm.
/// let turns: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.1).collect();
/// let (fx, fz): (Vec<f64>, Vec<f64>) = turns.iter().map(|turn| (2.0 * turn.cos(), 2.0 * turn.sin())).unzip();
/// let zero = [0.0; 1000];
/// let mut answers = [[0.0; 1000]; 7];
/// let [x, y, z, nx, ny, nz, gap] = answers.each_mut().map(|column| &mut column[..]);
/// sphere.contacts(
///     Wrenches { force: [&fx, &zero, &fz], torque: [&zero; 3].map(|column| &column[..]) },
///     Contacts { point: [x, y, z], normal: [nx, ny, nz], gap },
/// );
/// // Each is what a point contact makes of it.
/// let wrench = Wrench::on_fingertip(Vector3::new(fx[7], 0.0, fz[7]), Vector3::zeros());
/// let one = PointContact::new(0.0)?.resolve(&wrench, &sphere).into_result()?;
/// assert!((one.point.x - answers[0][7]).abs() < 1e-15 && (one.point.z - answers[2][7]).abs() < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
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
