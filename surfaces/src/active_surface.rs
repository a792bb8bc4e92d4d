//! What a shape must be able to tell.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::numeric::vectors::in_range;
use crate::{NoShortcuts, Shortcuts};

/// Where a line passes through a surface.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Sphere};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // Down the z axis into a ball of 13 mm from 50 mm above its centre.
/// let line = Line { point: Vector3::new(0.0, 0.0, 0.05), direction: -Vector3::z() };
/// let mut crossings = Vec::new();
/// Sphere::centred(0.013)?.crossings(&line, |crossing| crossings.push(crossing));
/// let [entry, exit] = crossings[..] else { unreachable!("a ball is entered and left") };
/// assert!((entry.along - 0.037_f64).abs() < 1e-15 && (exit.along - 0.063_f64).abs() < 1e-15);
/// assert_eq!((entry.normal, exit.normal), (Vector3::z(), -Vector3::z()));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing<T: Real> {
    /// Signed distance from the line's point, along its direction \[m\].
    pub along: T,
    /// The point itself \[m\].
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// `false` where the point belongs to the shape but not to the part that may touch: beyond
    /// the rim of a disk, past the end of an open cylinder.
    pub active: bool,
}

/// Where a force enters a surface that its line enters only once.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, ForceLine, Shortcuts, Sphere};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // A force down, half a radius beside the axis of a ball: it meets the surface at 30° to the normal.
/// let line = Line { point: Vector3::new(0.0065, 0.0, 0.05), direction: -Vector3::z() };
/// let sphere = Sphere::centred(0.013)?;
/// let entry = sphere.shortcuts().sole_entry(&ForceLine::along(&line)).unwrap();
/// assert!((entry.normal.x - 0.5_f64).abs() < 1e-15);
/// assert!((entry.incidence_squared - 0.75_f64).abs() < 1e-15); // cos² 30°
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry<T: Real> {
    /// The point of the surface \[m\].
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// The square of the cosine of incidence, `(f·n)²/|f|²`. Closed forms know it before they know
    /// the normal; unless it is positive the line misses, and the other fields mean nothing.
    pub incidence_squared: T,
    /// What the force's parts along the normal and along the surface measure, where a closed form knows
    /// that before it knows the normal. `None` says nothing.
    pub parts: Option<ForceParts<T>>,
    /// `false` where the point belongs to the shape but not to the part that may touch.
    pub active: bool,
}

/// Magnitudes of a force's parts at a tangent plane.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, ForceLine, Shortcuts, Sphere};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // 2 N down, half a radius beside the axis of a ball: 30° to the normal.
/// let point = Vector3::new(0.0065, 0.0, 0.05);
/// let wrench: Wrench<f64> = Wrench::from_force_at(&point, Vector3::new(0.0, 0.0, -2.0));
/// let push = ForceLine::new(&wrench, ForceLine::least_squared()).unwrap();
/// let sphere = Sphere::centred(0.013)?;
/// let parts = sphere.shortcuts().sole_entry(&push).unwrap().parts.unwrap();
/// assert!((parts.normal - 3.0_f64.sqrt()).abs() < 1e-14); // 2 N · cos 30°
/// assert!((parts.tangential - 1.0).abs() < 1e-14); // 2 N · sin 30°
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceParts<T: Real> {
    /// Normal force \[N\], positive when pressing.
    pub normal: T,
    /// Magnitude of the tangential force \[N\].
    pub tangential: T,
}

impl<T: Real> Entry<T> {
    /// The line misses.
    #[inline(always)]
    #[must_use]
    pub fn none() -> Self {
        Self {
            point: Vector3::zeros(),
            normal: Vector3::zeros(),
            incidence_squared: T::zero(),
            parts: None,
            active: false,
        }
    }

    /// The crossing at which a line of this unit direction enters; none if it lies beyond the range of
    /// the type.
    #[inline(always)]
    pub fn at(crossing: &Crossing<T>, direction: &Vector3<T>) -> Self {
        let Crossing { point, normal, active, .. } = *crossing;
        let incidence = -normal.dot(direction);
        Self { point, normal, incidence_squared: incidence * incidence.abs(), parts: None, active }
            .within_range()
    }

    /// The same; none if it lies beyond the range of the type. That is said within the answer, since to
    /// take an answer back costs more than to find it.
    #[inline(always)]
    pub(crate) fn within_range(self) -> Self {
        let incidence_squared = if in_range(&self.point) { self.incidence_squared } else { T::zero() };
        Self { incidence_squared, ..self }
    }
}

/// The point of a surface closest to a line that misses it.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Sphere};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // Past a ball of 13 mm, 15 mm from its centre.
/// let line = Line { point: Vector3::new(0.015, 0.0, 0.05), direction: -Vector3::z() };
/// let nearest = Sphere::centred(0.013)?.closest_approach(&line).unwrap();
/// assert!((nearest.gap - 0.002_f64).abs() < 1e-15);
/// assert_eq!(nearest.point, Vector3::new(0.013, 0.0, 0.0));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct ClosestApproach<T: Real> {
    /// Distance between line and surface \[m\]; zero or more.
    pub gap: T,
    /// The closest point of the surface \[m\].
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// `false` where the point is not part of the active region.
    pub active: bool,
}

/// The part of the fingertip that may touch: a surface with an outside.
///
/// # For users
/// Coordinates are those of the sensor frame \[m\]. All calls are total: they return no NaN for a
/// finite line with unit direction.
///
/// # For implementers
/// [`crossings`](Self::crossings) is enough. It shall report *every* point where the line passes through the
/// surface, in any order, those outside the active region too (marked `active: false`). A tangent line may
/// report its point of tangency once, twice or not at all.
///
/// Everything else has a default that is right, and can be given to make it faster or more certain. A shape
/// with an equation `f(x) = 0` gets all from [`Implicit`](crate::Implicit). The module
/// [`testing`](crate::testing) checks an implementation.
///
/// ```
/// use fingertip_surfaces::testing::SurfaceLaws;
/// use fingertip_surfaces::{ActiveSurface, Crossing};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// /// The unit ball.
/// struct Ball;
///
/// impl ActiveSurface<f64> for Ball {
///     fn crossings(&self, line: &Line<f64>, mut visit: impl FnMut(Crossing<f64>)) {
///         let middle = -line.point.dot(&line.direction);
///         let foot = line.at(middle);
///         let squared = 1.0 - foot.norm_squared();
///         if squared >= 0.0 {
///             for half_chord in [-squared.sqrt(), squared.sqrt()] {
///                 let (along, point) = (middle + half_chord, foot + line.direction * half_chord);
///                 visit(Crossing { along, point, normal: point.normalize(), active: true });
///             }
///         }
///     }
/// }
///
/// SurfaceLaws::around(Vector3::zeros(), 1.0).check(&Ball)?;
/// assert!(Ball.contains(&Vector3::new(0.0, 0.9, 0.0)) && !Ball.contains(&Vector3::new(0.0, 1.1, 0.0)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no surface of `{T}`",
    note = "a shape of your own implements `ActiveSurface::crossings`; its scalar must be that of the wrench"
)]
pub trait ActiveSurface<T: Real> {
    /// Calls `visit` for every point where the line passes through the surface.
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>));

    /// The point of the surface closest to a line that misses it; `None`, as the default answers, if that is
    /// not known.
    ///
    /// Asked only for lines that [`crossings`](Self::crossings) reported nothing for, but an answer shall make
    /// sense for any. Without it a line that misses is no contact, however near it passes.
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let _ = line;
        None
    }

    /// Where a line first enters a surface that promises [`CLOSED_CONVEX`](Shortcuts::CLOSED_CONVEX), and whether it does;
    /// if not, as [`closest_approach`](Self::closest_approach). Wrappers that move a shape move the answer, once.
    #[doc(hidden)]
    #[inline(always)]
    fn entry_or_closest(&self, line: &Line<T>) -> (bool, Option<ClosestApproach<T>>) {
        let mut entry = None;
        self.crossings(line, |Crossing { point, normal, .. }| {
            if entry.is_none() {
                entry = Some(ClosestApproach { gap: T::zero(), point, normal, active: true });
            }
        });
        (entry.is_some(), entry.or_else(|| self.closest_approach(line)))
    }

    /// Whether a line enters the active surface, and a place where it leaves, the last that crossings tell.
    #[doc(hidden)]
    #[inline(always)]
    fn entered_and_left(&self, line: &Line<T>) -> (bool, Option<Vector3<T>>) {
        entered_and_left(line, |visit| self.crossings(line, visit))
    }

    /// The outward unit normal at a point on the surface, or within rounding of it.
    ///
    /// The default looks along seven fixed lines through the point, which cannot all be tangent, and then
    /// along the normal of the crossing that is nearest.
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        normal_by_crossings(self, point)
    }

    /// What the shape knows sooner, or to more digits, than its crossings tell.
    ///
    /// The default has none. A wrapper passes on those of the shape inside: see [`Shortcuts`].
    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        NoShortcuts
    }

    /// `true` if the point is inside the fingertip.
    ///
    /// The default looks along a fixed line at the crossing nearest to the point: the normal there
    /// tells on which side the point is. Shapes with an equation answer faster.
    fn contains(&self, point: &Vector3<T>) -> bool {
        let direction = Vector3::new(T::literal(0.48), T::literal(0.6), T::literal(0.64));
        let nearest = nearest_crossing(self, &Line { point: *point, direction });
        nearest.is_some_and(|c| c.along * c.normal.dot(&direction) > T::zero())
    }
}

/// The axes and diagonals of a cube that is turned such that each is well away from the planes between the
/// axes, in which shapes are likely to have tangents. No plane holds more than three of them.
const ASKEW: [[f64; 3]; 7] = [
    [0.9237732946279373, -0.22722975601436946, -0.3082361726240063],
    [0.3045483315074231, 0.9239051118304394, 0.23162395841023875],
    [0.23214911998172819, -0.3078408392582658, 0.9226813121422129],
    [0.8432031784142748, 0.22449371280486635, 0.48847822144201186],
    [0.5751404645871039, 0.5799576956315066, -0.5769423864410758],
    [0.4915410560601505, -0.842340017237085, 0.22102191196417575],
    [-0.2234783422329795, 0.4868760344104448, 0.8443986959189119],
];

/// The normal at the crossing nearest to a point, of lines through it along fixed directions and then along
/// the normal that these have found. A line that meets the surface at a flat angle meets it farther away, and
/// so does not count.
fn normal_by_crossings<T: Real, S: ActiveSurface<T> + ?Sized>(surface: &S, point: &Vector3<T>) -> Vector3<T> {
    let look = |direction: Vector3<T>| nearest_crossing(surface, &Line { point: *point, direction });
    let nearer = |a: Crossing<T>, b: Crossing<T>| if b.along.abs() < a.along.abs() { b } else { a };
    let askew = ASKEW.iter().filter_map(|direction| look(Vector3::from(direction.map(T::literal))));
    let Some(found) = askew.reduce(nearer) else { return Vector3::z() };
    look(found.normal).map_or(found, |straight| nearer(found, straight)).normal
}

/// [`ActiveSurface::entered_and_left`] by crossings.
#[inline(always)]
pub(crate) fn entered_and_left<T: Real>(
    line: &Line<T>,
    crossings: impl FnOnce(&mut dyn FnMut(Crossing<T>)),
) -> (bool, Option<Vector3<T>>) {
    let (mut entered, mut left) = (false, None);
    crossings(&mut |crossing| {
        let along = line.direction.dot(&crossing.normal);
        if along < T::zero() {
            entered |= crossing.active;
        } else if along >= T::zero() {
            left = Some(crossing.point);
        }
    });
    (entered, left)
}

/// The crossings of a line, out of line: for whoever asks for few samples, so that they are compiled once for all of them.
#[doc(hidden)]
#[inline(never)]
pub fn rare_crossings<T: Real, S: ActiveSurface<T> + ?Sized>(
    surface: &S,
    line: &Line<T>,
    visit: &mut dyn FnMut(Crossing<T>),
) {
    surface.crossings(line, visit);
}

/// The crossing of a line that is nearest to its point.
#[doc(hidden)]
pub fn nearest_crossing<T: Real, S: ActiveSurface<T> + ?Sized>(
    surface: &S,
    line: &Line<T>,
) -> Option<Crossing<T>> {
    let mut nearest: Option<Crossing<T>> = None;
    surface.crossings(line, |crossing| {
        if nearest.is_none_or(|n| crossing.along.abs() < n.along.abs()) {
            nearest = Some(crossing);
        }
    });
    nearest
}

impl<T: Real, S: ActiveSurface<T>> ActiveSurface<T> for &S {
    #[inline]
    fn crossings(&self, line: &Line<T>, visit: impl FnMut(Crossing<T>)) {
        (**self).crossings(line, visit);
    }

    #[inline]
    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        (**self).closest_approach(line)
    }

    #[inline(always)]
    fn entry_or_closest(&self, line: &Line<T>) -> (bool, Option<ClosestApproach<T>>) {
        (**self).entry_or_closest(line)
    }

    #[inline(always)]
    fn entered_and_left(&self, line: &Line<T>) -> (bool, Option<Vector3<T>>) {
        (**self).entered_and_left(line)
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        (**self).normal(point)
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        (**self).shortcuts()
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        (**self).contains(point)
    }
}
