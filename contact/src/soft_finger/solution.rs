//! What a search for soft-finger contacts finds.

use fingertip_surfaces::{ActiveSurface, ForceLine};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use super::placed::Patch;
use crate::GeometrySensitivity;

/// One solution of the soft-finger equations `m = c × f + τ n(c)` with `f·n ≤ 0` and `c` on the
/// surface.
///
/// ```
/// use fingertip_contact::{SoftContact, SoftFingerSurface};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // 2 N at the top of a sphere of 10 mm, with 1.5 N·mm of spin.
/// let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::new(0.0, 0.0, 1.5e-3));
/// let mut all: Vec<SoftContact<f64>> = Vec::new();
/// Sphere::centred(0.01)?.soft_contacts(&wrench, None, |contact| all.push(contact));
/// let [contact] = all[..] else { panic!("{all:?}") };
/// // It fulfils m = c × f + τ n.
/// let torque = contact.point.cross(&wrench.force()) + contact.normal * contact.spin_torque;
/// assert!(contact.active && (torque - wrench.torque()).norm() < 1e-12);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftContact<T: Real> {
    /// The contact centroid `c` \[m\].
    pub point: Vector3<T>,
    /// Outward unit normal `n` there.
    pub normal: Vector3<T>,
    /// Spin torque `τ` on the fingertip about the outward normal \[N·m\].
    pub spin_torque: T,
    /// `false` where the point belongs to the shape but not to the part that may touch.
    pub active: bool,
}

/// How a search for soft-finger contacts ended.
///
/// ```
/// use fingertip_contact::{Search, SoftFingerSurface};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // On a sphere a closed form finds all contacts.
/// let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::new(0.0, 0.0, 1.5e-3));
/// let mut contacts = 0;
/// let search = Sphere::centred(0.01)?.soft_contacts(&wrench, None, |_| contacts += 1);
/// assert!(matches!(search, Search::<f64>::Complete) && contacts == 1);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Search<T: Real> {
    /// Every contact that presses has been visited.
    Complete,
    /// The wrench is a pure force whose line misses the surface. The equations hold at these two
    /// points, where the force grazes and the two spin torques are opposite: nothing tells which.
    Grazing([Vector3<T>; 2]),
    /// What was found has been visited, and the surface says too little of itself
    /// ([`Topology::Unknown`](fingertip_surfaces::Topology::Unknown)) to know that there is nothing else.
    Uncertified,
    /// The iteration ended at its bound, or rounding decides: contacts may be missing.
    Incomplete,
}

/// A surface that knows the soft-finger contacts of a wrench.
///
/// # For users
/// [`SoftFinger`](crate::SoftFinger) asks this of a surface; there is no need to call it directly,
/// except to see all solutions on a shape that is not convex.
///
/// # For implementers
/// Shapes with a level function implement [`SmoothSurface`](fingertip_surfaces::SmoothSurface) and forward to
/// [`newton_soft_contacts`](crate::newton_soft_contacts).
///
/// `visit` shall be called once for every solution that presses, those outside the active region
/// too. The wrench is finite, its force is not zero, and its largest component lies between the roots
/// of the least and of the greatest number of the type. Solutions shall be accurate for spin
/// torques down to zero.
///
/// ```
/// use fingertip_contact::SoftFingerSurface;
/// use fingertip_surfaces::{Ellipsoid, Sphere};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// /// How many contacts explain a wrench.
/// fn contacts(surface: &impl SoftFingerSurface<f64>, wrench: &Wrench<f64>) -> usize {
///     let mut count = 0;
///     surface.soft_contacts(wrench, None, |_| count += 1);
///     count
/// }
///
/// // 2 N down, with a torque of 1 N·mm about the line of the force, on a sphere and on an ellipsoid.
/// let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -2.0), Vector3::new(0.0, 0.0, 1e-3));
/// assert_eq!(contacts(&Sphere::centred(0.01)?, &wrench), 1);
/// assert!(contacts(&Ellipsoid::new(Vector3::new(0.008, 0.009, 0.012))?, &wrench) >= 1);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not know the soft contacts of a wrench of `{T}`",
    note = "a shape with `SmoothSurface` implements `SoftFingerSurface` by `newton_soft_contacts`; a `PointContact` takes any `ActiveSurface`"
)]
pub trait SoftFingerSurface<T: Real>: ActiveSurface<T> {
    /// Calls `visit` for every solution that presses. `last`, the contact point of the sample
    /// before, may be used as a start.
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T>;

    /// What the surface is near one of its points, to the last digit.
    ///
    /// Where a surface is straight one way, a contact under a large spin torque answers to the last digit
    /// of its normal; shapes that tell it so have contacts to the last digit. `None`, as the default
    /// answers, takes normals at their word.
    #[inline]
    fn patch(&self, point: &Vector3<T>) -> Option<Patch> {
        let _ = point;
        None
    }

    /// The contact, for shapes that have but one and know it in closed form: a shortcut past
    /// [`soft_contacts`](Self::soft_contacts) that [`SoftFinger`](crate::SoftFinger) takes first.
    ///
    /// `None`, as the default answers, says nothing; an answer shall be the only contact that
    /// `soft_contacts` would visit. Where the force presses at so flat an angle that rounding errors
    /// grow, leave it at `None`: what [`soft_contacts`](Self::soft_contacts) visits is then mended.
    #[inline]
    fn sole_soft_contact(&self, push: &ForceLine<T>) -> Option<SoftContact<T>> {
        let _ = push;
        None
    }

    /// The same without a branch, for loops over columns, as a function that holds copies of the numbers of the surface, which
    /// the compiler then reads once for a column: to the bit what [`sole_soft_contact`](Self::sole_soft_contact) answers, or
    /// `None`. The default is that one, which reads them for every wrench.
    #[doc(hidden)]
    #[inline(always)]
    fn sole_soft_contacts_in_columns(&self) -> impl Fn(&ForceLine<T>) -> Option<SoftContact<T>> {
        #[inline(always)]
        |push| self.sole_soft_contact(push)
    }

    /// The same by the closed form in double precision, for a narrower type, of which it is right to the last digit: what
    /// double precision's own rounding may show in it is `None`, as the default answers. [`SoftFinger`](crate::SoftFinger)
    /// asks for it after [`sole_soft_contact`](Self::sole_soft_contact).
    #[doc(hidden)]
    #[inline]
    fn sole_soft_contact_in_double(&self, wrench: &Wrench<f64>) -> Option<SoftContact<f64>> {
        let _ = wrench;
        None
    }

    /// The contacts of the shape in this pose in double precision, for a narrower type. `None`, as the default answers,
    /// says nothing.
    ///
    /// A pose asks for it before [`soft_contacts`](Self::soft_contacts): it would round the wrench.
    #[doc(hidden)]
    #[inline]
    fn posed_soft_contacts_in_double(
        &self,
        wrench: &Wrench<f64>,
        pose: &RigidTransform<T>,
        visit: &mut dyn FnMut(SoftContact<f64>),
    ) -> Option<Search<f64>> {
        let _ = (wrench, pose, visit);
        None
    }

    /// What a search says of the shape in this pose, found anew where the digits of the type do not decide; as it is, by
    /// default. A pose asks for it after [`soft_contacts`](Self::soft_contacts): it has rounded the wrench.
    #[doc(hidden)]
    #[inline]
    fn with_more_digits(
        &self,
        wrench: &Wrench<T>,
        pose: Option<&RigidTransform<T>>,
        found: Result<SoftContact<T>, Search<T>>,
    ) -> Result<SoftContact<T>, Search<T>> {
        let _ = (wrench, pose);
        found
    }

    /// How the surface changes at one of its points, per unit of the shape's size of this number: its radii,
    /// semi-axes and lengths, counted from 0 in the order of its constructor. `None`, as the default answers, if
    /// there is no such size. (Moving and turning need no such knowledge:
    /// [`GeometrySensitivity::translation`], [`GeometrySensitivity::rotation`].)
    ///
    /// ```
    /// use fingertip_contact::{GeometrySensitivity, SoftFingerSurface};
    /// use fingertip_surfaces::Sphere;
    /// use nalgebra::Vector3;
    ///
    /// let sphere = Sphere::centred(0.013)?;
    /// // A larger radius moves every point outward by as much.
    /// let change = sphere.sensitivity(0, &Vector3::new(0.0, 0.0, 0.013));
    /// assert_eq!(change, Some(GeometrySensitivity::offset()));
    /// assert_eq!(sphere.sensitivity(1, &Vector3::z()), None);
    /// # Ok::<(), fingertip_surfaces::BadShape>(())
    /// ```
    fn sensitivity(&self, size: usize, point: &Vector3<T>) -> Option<GeometrySensitivity<T>> {
        let _ = (size, point);
        None
    }
}

impl<T: Real, S: SoftFingerSurface<T>> SoftFingerSurface<T> for &S {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        (**self).soft_contacts(wrench, last, visit)
    }

    #[inline]
    fn patch(&self, point: &Vector3<T>) -> Option<Patch> {
        (**self).patch(point)
    }

    #[inline]
    fn sole_soft_contact(&self, push: &ForceLine<T>) -> Option<SoftContact<T>> {
        (**self).sole_soft_contact(push)
    }

    #[inline(always)]
    fn sole_soft_contacts_in_columns(&self) -> impl Fn(&ForceLine<T>) -> Option<SoftContact<T>> {
        (**self).sole_soft_contacts_in_columns()
    }

    #[inline]
    fn sole_soft_contact_in_double(&self, wrench: &Wrench<f64>) -> Option<SoftContact<f64>> {
        (**self).sole_soft_contact_in_double(wrench)
    }

    #[inline]
    fn posed_soft_contacts_in_double(
        &self,
        wrench: &Wrench<f64>,
        pose: &RigidTransform<T>,
        visit: &mut dyn FnMut(SoftContact<f64>),
    ) -> Option<Search<f64>> {
        (**self).posed_soft_contacts_in_double(wrench, pose, visit)
    }

    #[inline]
    fn with_more_digits(
        &self,
        wrench: &Wrench<T>,
        pose: Option<&RigidTransform<T>>,
        found: Result<SoftContact<T>, Search<T>>,
    ) -> Result<SoftContact<T>, Search<T>> {
        (**self).with_more_digits(wrench, pose, found)
    }

    fn sensitivity(&self, size: usize, point: &Vector3<T>) -> Option<GeometrySensitivity<T>> {
        (**self).sensitivity(size, point)
    }
}
