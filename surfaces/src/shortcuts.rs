//! What a shape knows sooner, or to more digits, than its crossings tell.

use fingertip_wrench::{Line, Real, RigidTransform};
use nalgebra::Vector3;

use crate::numeric::fine_pose::FinePose;
use crate::{ActiveSurface, Crossing, Entry, ForceLine};

/// What a shape knows sooner, or to more digits, than its crossings tell. Point contact asks here first.
///
/// A shape that has shortcuts returns itself from [`ActiveSurface::shortcuts`](crate::ActiveSurface::shortcuts).
/// A wrapper passes on those of the shape inside, whole: as they are, [`within`](Self::within) a part of it, or
/// [`posed`](Self::posed); or it drops them by returning [`NoShortcuts`].
/// [`SurfaceLaws::check_wrapper`](crate::testing::SurfaceLaws::check_wrapper) fails for a wrapper that forgot
/// them.
///
/// ```
/// use fingertip_surfaces::testing::{Kept, SurfaceLaws};
/// use fingertip_surfaces::{ActiveSurface, ClosestApproach, Crossing, Shortcuts, Sphere};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// /// Counts the lines that took the long way.
/// struct Counted<S>(S, core::cell::Cell<u32>);
///
/// impl<S: ActiveSurface<f64>> ActiveSurface<f64> for Counted<S> {
///     fn crossings(&self, line: &Line<f64>, visit: impl FnMut(Crossing<f64>)) {
///         self.1.set(self.1.get() + 1);
///         self.0.crossings(line, visit);
///     }
///     fn closest_approach(&self, line: &Line<f64>) -> Option<ClosestApproach<f64>> {
///         self.0.closest_approach(line)
///     }
///     fn shortcuts(&self) -> impl Shortcuts<f64> {
///         self.0.shortcuts()
///     }
/// }
///
/// let sphere = Sphere::centred(0.013)?;
/// let counted = Counted(sphere, 0.into());
/// SurfaceLaws::around(Vector3::zeros(), 0.013).check_wrapper(&sphere, &counted, Kept::All)?;
/// // Where a force enters is known without looking for crossings.
/// use fingertip_surfaces::ForceLine;
/// let asked = counted.1.get();
/// let down = Line { point: Vector3::new(0.0, 0.0, 0.05), direction: -Vector3::z() };
/// let entry = counted.shortcuts().sole_entry(&ForceLine::along(&down)).unwrap();
/// assert_eq!((entry.point.z, counted.1.get()), (0.013, asked));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no shortcut of a surface of `{T}`",
    note = "`ActiveSurface::shortcuts` returns `NoShortcuts`, or what implements `Shortcuts`"
)]
pub trait Shortcuts<T: Real>: Sized {
    /// `true` promises that the surface bounds a convex body and may touch everywhere: a line that
    /// passes through it enters once, at an active point, and leaves once, and
    /// [`crossings`](crate::ActiveSurface::crossings) reports where it enters first. Point contact then compiles
    /// without what other shapes need, such as a choice between entries. The default promises nothing.
    const CLOSED_CONVEX: bool = false;

    /// `true` if a pose has moved the shape: moving a line rounds it once more, and point contact in a narrower type then asks
    /// double precision at angles that are a little less flat.
    #[doc(hidden)]
    #[inline(always)]
    fn is_moved(&self) -> bool {
        false
    }

    /// Where a force enters, for shapes that no line enters twice.
    ///
    /// `None`, as the default answers, says nothing. An answer with a positive square of the
    /// incidence shall be finite and agree, but for rounding, with the one crossing that has a normal
    /// against the force; one without says that there is none, but for rounding.
    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let _ = push;
        None
    }

    /// How far a point that should be on the surface is outside it by rounding \[m\], to first order
    /// and with twice the digits of the type.
    ///
    /// Point contact asks for it where a force meets the surface at a flat angle, and such errors
    /// grow. The default, zero, takes crossings at their word.
    #[inline(always)]
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let _ = point;
        T::zero()
    }

    /// Where a line enters near a point, in double precision.
    ///
    /// Point contact asks for it in a narrower type, where a force meets the surface at a flat angle, and moves the
    /// crossing by rounding alone if there is no answer. `None`, as the default answers, suits all shapes whose normal
    /// the digits of a point tell; it is for those that are bent sharply one way.
    #[inline(always)]
    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        let _ = (line, near);
        None
    }

    /// The same, of a shape that a pose puts in place: its rounding in a narrower type is none that a residual undoes.
    /// The default is [`entry_in_double`](Self::entry_in_double).
    #[inline(always)]
    fn posed_entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        self.entry_in_double(line, near)
    }

    /// The shortcuts of the part of this surface to which `is_part` says that an entry belongs. They no longer
    /// promise that it may touch everywhere.
    #[inline(always)]
    fn within(self, is_part: impl Fn(&Entry<T>) -> bool) -> impl Shortcuts<T> {
        Within { whole: self, is_part }
    }

    /// The shortcuts of this surface in another place. Moving a point rounds it, which the residual does not
    /// undo.
    #[inline(always)]
    fn posed(self, pose: &RigidTransform<T>) -> impl Shortcuts<T> {
        Moved { inner: self, pose }
    }
}

/// No shortcuts: everything is told by crossings.
///
/// ```
/// use fingertip_surfaces::{ForceLine, NoShortcuts, Shortcuts};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// let push = ForceLine::along(&Line { point: Vector3::<f64>::zeros(), direction: Vector3::z() });
/// assert_eq!(NoShortcuts.sole_entry(&push), None);
/// assert!(!<NoShortcuts as Shortcuts<f64>>::CLOSED_CONVEX);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoShortcuts;

impl<T: Real> Shortcuts<T> for NoShortcuts {}

impl<T: Real, S: Shortcuts<T>> Shortcuts<T> for &S {
    const CLOSED_CONVEX: bool = S::CLOSED_CONVEX;

    #[inline(always)]
    fn is_moved(&self) -> bool {
        (**self).is_moved()
    }

    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        (**self).sole_entry(push)
    }

    #[inline(always)]
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        (**self).surface_residual(point)
    }

    #[inline(always)]
    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        (**self).entry_in_double(line, near)
    }

    #[inline(always)]
    fn posed_entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        (**self).posed_entry_in_double(line, near)
    }
}

struct Within<S, F> {
    whole: S,
    is_part: F,
}

impl<T: Real, S: Shortcuts<T>, F: Fn(&Entry<T>) -> bool> Shortcuts<T> for Within<S, F> {
    #[inline(always)]
    fn is_moved(&self) -> bool {
        self.whole.is_moved()
    }

    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        self.whole
            .sole_entry(push)
            .map(|entry| Entry { active: entry.active && (self.is_part)(&entry), ..entry })
    }

    #[inline(always)]
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        self.whole.surface_residual(point)
    }

    #[inline(always)]
    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        self.whole.entry_in_double(line, near)
    }

    #[inline(always)]
    fn posed_entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        self.whole.posed_entry_in_double(line, near)
    }
}

struct Moved<'a, T: Real, S> {
    inner: S,
    pose: &'a RigidTransform<T>,
}

impl<T: Real, S: Shortcuts<T>> Shortcuts<T> for Moved<'_, T, S> {
    const CLOSED_CONVEX: bool = S::CLOSED_CONVEX;

    #[inline(always)]
    fn is_moved(&self) -> bool {
        true
    }

    #[inline(always)]
    fn sole_entry(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        let pose = self.pose;
        // The frame of a shape may lie so far away that the shape leaves the range of the type.
        self.inner.sole_entry(&push.seen_from(pose)).map(|e| {
            Entry { point: pose.transform_point(&e.point), normal: pose.rotate(&e.normal), ..e }
                .within_range()
        })
    }

    fn surface_residual(&self, point: &Vector3<T>) -> T {
        self.inner.surface_residual(&self.pose.rotation().tr_mul(&(point - self.pose.origin())))
    }

    fn entry_in_double(&self, line: &Line<f64>, near: &Vector3<f64>) -> Option<LineInDouble> {
        let pose = FinePose::new(self.pose);
        Some(match self.inner.posed_entry_in_double(&pose.line_inside(line), &pose.point_inside(near))? {
            LineInDouble::Enters { point, normal } => LineInDouble::Enters {
                point: pose.point_outside(&point),
                normal: pose.normal_outside(&normal).0,
            },
            LineInDouble::Misses => LineInDouble::Misses,
        })
    }
}

/// What double precision says of a line: [`Shortcuts::entry_in_double`].
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Cone, LineInDouble, Shortcuts};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// let cone = Cone::<f32>::new(Vector3::zeros(), Vector3::z(), 0.5)?;
/// let along = |y: f64| Line { point: Vector3::new(0.0, y, 0.01), direction: Vector3::x() };
/// let ask = |line| cone.shortcuts().entry_in_double(&line, &Vector3::new(-0.005, 0.0, 0.01));
/// assert!(matches!(ask(along(0.0)), Some(LineInDouble::Enters { normal, .. }) if normal.x < -0.8));
/// assert_eq!(ask(along(0.006)), Some(LineInDouble::Misses));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineInDouble {
    /// It enters there.
    Enters {
        /// On the surface \[m\].
        point: Vector3<f64>,
        /// The outward unit normal.
        normal: Vector3<f64>,
    },
    /// It does not, whatever rounding in a narrower type has made of it.
    Misses,
}

/// Of the places where a line enters a shape the one nearest to a point.
#[cold]
pub(crate) fn entry_near(
    shape: &impl ActiveSurface<f64>,
    line: &Line<f64>,
    near: &Vector3<f64>,
) -> Option<LineInDouble> {
    let mut best: Option<(f64, Crossing<f64>)> = None;
    shape.crossings(line, |crossing| {
        let away = (crossing.point - near).norm_squared();
        let enters = crossing.active && crossing.normal.dot(&line.direction) < 0.0;
        if enters && best.is_none_or(|(least, _)| away < least) {
            best = Some((away, crossing));
        }
    });
    let Some((_, Crossing { point, normal, .. })) = best else { return Some(LineInDouble::Misses) };
    (point.sum() + normal.sum()).is_number().then_some(LineInDouble::Enters { point, normal })
}

/// [`Shortcuts::CLOSED_CONVEX`] of the shortcuts of a surface, whose type has no name.
#[doc(hidden)]
#[inline(always)]
pub const fn is_closed_convex<T: Real, S: Shortcuts<T>>(_: &S) -> bool {
    S::CLOSED_CONVEX
}
