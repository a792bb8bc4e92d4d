//! What a surface has to obey.

use fingertip_wrench::{Line, Real};
use thiserror::Error;

/// What a surface has to obey.
///
/// ```
/// use fingertip_surfaces::testing::{Law, SurfaceLaws};
/// use fingertip_surfaces::{ActiveSurface, Crossing, Sphere};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// /// Forgets where a line leaves.
/// struct Entered(Sphere<f64>);
/// impl ActiveSurface<f64> for Entered {
///     fn crossings(&self, line: &Line<f64>, mut visit: impl FnMut(Crossing<f64>)) {
///         let enters = |crossing: &Crossing<f64>| crossing.normal.dot(&line.direction) < 0.0;
///         self.0.crossings(line, |crossing| if enters(&crossing) { visit(crossing) });
///     }
/// }
///
/// let laws = SurfaceLaws::around(Vector3::zeros(), 0.013);
/// let broken = laws.check(&Entered(Sphere::centred(0.013)?)).unwrap_err();
/// // A line along the normal leaves where it was entered, and is not seen there.
/// assert_eq!(broken.law, Law::CrossingOnSurface);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Law {
    /// A crossing lies on the line, at the position that it names.
    CrossingOnLine,
    /// A crossing lies on the surface: a line through it along its normal meets the surface there.
    CrossingOnSurface,
    /// `sole_entry`, if it answers, is the crossing at which the line enters, but for rounding.
    SoleEntry,
    /// What `sole_entry` says of the force's parts is what its normal says of them.
    ForceParts,
    /// A surface that is [`CLOSED_CONVEX`](crate::Shortcuts::CLOSED_CONVEX) is entered once and left once,
    /// both at active points, and reports where it is entered first.
    EnteredOnce,
    /// Normals have length 1.
    UnitNormal,
    /// `normal` agrees with the normals of crossings.
    NormalAgrees,
    /// Neighbouring crossings lie in the tangent plane: the normal is the gradient's direction.
    NormalIsGradient,
    /// The same line the other way round, or counted from another point, crosses in the same points.
    SameLineSamePoints,
    /// Crossings of a closed surface alternate, first in, then out.
    Alternation,
    /// The line is inside between entry and exit, and nowhere else.
    AllCrossingsFound,
    /// Turning and moving both shape and line turns and moves the crossings.
    RigidMotion,
    /// Scaling both shape and line scales the crossings.
    Scaling,
    /// The closest point of a line that misses is a point of the surface, as far from the line as
    /// the gap says.
    ClosestOnSurface,
    /// No other point of the surface is closer than the closest approach.
    NothingIsCloser,
    /// No NaN comes out of a finite line.
    NoNan,
    /// A wrapper answers as the shape inside does.
    WrapperKeepsAnswers,
    /// A wrapper passes on [`surface_residual`](crate::Shortcuts::surface_residual) and
    /// [`entry_in_double`](crate::Shortcuts::entry_in_double).
    WrapperKeepsResidual,
    /// A wrapper passes on [`sole_entry`](crate::Shortcuts::sole_entry).
    WrapperKeepsEntry,
    /// A wrapper passes on [`CLOSED_CONVEX`](crate::Shortcuts::CLOSED_CONVEX).
    WrapperKeepsPromise,
}

/// A law that a surface breaks, and the line on which it does.
///
/// ```
/// use fingertip_surfaces::testing::{Law, SurfaceLaws};
/// use fingertip_surfaces::{ActiveSurface, Crossing, Sphere};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// /// Normals as long as the radius.
/// struct Long(Sphere<f64>);
/// impl ActiveSurface<f64> for Long {
///     fn crossings(&self, line: &Line<f64>, mut visit: impl FnMut(Crossing<f64>)) {
///         let lengthened = |crossing: Crossing<f64>| Crossing { normal: crossing.normal * 0.013, ..crossing };
///         self.0.crossings(line, |crossing| visit(lengthened(crossing)));
///     }
/// }
///
/// let laws = SurfaceLaws::around(Vector3::zeros(), 0.013);
/// let broken = laws.check(&Long(Sphere::centred(0.013)?)).unwrap_err();
/// assert_eq!(broken.law, Law::UnitNormal);
/// assert!((broken.found - (1.0 - 0.013)).abs() < 1e-12);
/// assert!(broken.to_string().starts_with("UnitNormal is broken on the line through "));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{law:?} is broken on the line through {line:?}: {found} is more than {allowed}")]
pub struct Violation<T: Real> {
    /// The law.
    pub law: Law,
    /// The line on which it is broken.
    pub line: Line<T>,
    /// By how much; the count of lines for laws that allow some exceptions.
    pub found: T,
    /// How much was allowed.
    pub allowed: T,
}
