//! The elliptic paraboloid.

use fingertip_wrench::{Line, Real, stored};
use nalgebra::{Matrix3, Vector3};

use crate::numeric::quadratic::roots;
use crate::numeric::support;
use crate::numeric::twofold::Twofold;
use crate::numeric::vectors::{foot, length, unit_or};
use crate::{
    ActiveSurface, BadShape, ClosestApproach, Crossing, Extent, Level, Shortcuts, SmoothSurface, Topology,
};

/// A dome whose top is the origin, with the z axis pointing out of it:
/// `z = −x²/(2·R_x) − y²/(2·R_y)`; [`Posed`](crate::Posed) puts it elsewhere.
///
/// The radii of curvature at the top are what a calibration of a gently curved pad finds.
///
/// ```
/// use fingertip_surfaces::{ActiveSurface, Paraboloid};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// // A pad curved with 20 mm along x and 40 mm along y.
/// let pad = Paraboloid::new([0.02, 0.04])?.with_depth(0.003)?;
/// let line = Line { point: Vector3::new(0.004, 0.004, 0.05), direction: -Vector3::z() };
/// let mut heights = Vec::new();
/// pad.crossings(&line, |crossing| heights.push(crossing.point.z));
/// // −4² mm²/(2·20 mm) − 4² mm²/(2·40 mm)
/// assert!(heights.len() == 1 && (heights[0] + 0.0006_f64).abs() < 1e-15);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraboloid<T: Real> {
    radii: [T; 2],
    curvatures: [T; 2],
    depth: Option<T>,
}

impl<T: Real> Paraboloid<T> {
    /// From the radii of curvature at the top, in the x-z and the y-z plane \[m\].
    ///
    /// # Errors
    /// [`BadShape`] unless they are positive finite lengths, none more than `1/√ε` times the other.
    pub fn new(radii: [T; 2]) -> Result<Self, BadShape> {
        let shape = "paraboloid";
        let [a, b] = radii;
        BadShape::check_length(shape, "radii of curvature", a)?;
        BadShape::check_length(shape, "radii of curvature", b)?;
        BadShape::check(
            shape,
            "radii of curvature",
            "of comparable size",
            a.min(b) / a.max(b) >= T::EPSILON.root(),
        )?;
        Ok(Self { radii, curvatures: [T::one() / a, T::one() / b], depth: None })
    }

    /// Only the part down to `depth` \[m\] under the top is active.
    ///
    /// # Errors
    /// [`BadShape`] unless it is a positive finite length.
    pub fn with_depth(self, depth: T) -> Result<Self, BadShape> {
        Ok(Self { depth: Some(BadShape::check_length("paraboloid", "depth", depth)?), ..self })
    }

    /// Radii of curvature at the top \[m\].
    #[inline]
    #[must_use]
    pub const fn radii(&self) -> [T; 2] {
        self.radii
    }

    /// Their reciprocals \[1/m\].
    #[inline]
    #[doc(hidden)]
    pub const fn curvatures(&self) -> [T; 2] {
        self.curvatures
    }

    /// The same in double precision.
    #[doc(hidden)]
    #[must_use]
    pub fn in_double(&self) -> Option<Paraboloid<f64>> {
        let double = Paraboloid::new(self.radii.map(Real::to_f64)).ok()?;
        self.depth.map_or(Some(double), |depth| double.with_depth(depth.to_f64()).ok())
    }

    /// Depth of the active part \[m\]; `None` if unbounded.
    #[inline]
    #[must_use]
    pub const fn depth(&self) -> Option<T> {
        self.depth
    }

    #[inline]
    fn is_active(&self, z: T) -> bool {
        self.depth.is_none_or(|depth| -z <= depth)
    }

    #[inline]
    fn normal_at(&self, point: &Vector3<T>) -> Vector3<T> {
        let [a, b] = self.curvatures;
        unit_or(&Vector3::new(point.x * a, point.y * b, T::one()), Vector3::z)
    }
}

impl<T: Real> ActiveSurface<T> for Paraboloid<T> {
    #[inline]
    fn crossings(&self, line: &Line<T>, mut visit: impl FnMut(Crossing<T>)) {
        let (start, along) = foot(line, &Vector3::zeros());
        let ([ka, kb], direction) = (self.curvatures, &line.direction);
        let a = direction.x * direction.x * ka + direction.y * direction.y * kb;
        let b = start.x * direction.x * ka + start.y * direction.y * kb + direction.z;
        let c = start.x * start.x * ka + start.y * start.y * kb + start.z + start.z;
        let Some(ends) = roots(a, b, c) else { return };
        for t in ends {
            let point = start + direction * t;
            // A line along the axis leaves at infinity.
            if t.abs() < T::GREATEST.root() {
                visit(Crossing {
                    along: along + t,
                    point,
                    normal: self.normal_at(&point),
                    active: self.is_active(point.z),
                });
            }
        }
    }

    fn closest_approach(&self, line: &Line<T>) -> Option<ClosestApproach<T>> {
        let approach = support::closest_approach(line, |normal| {
            let [ra, rb] = self.radii;
            // Where the slope is so steep that the point lies beyond the range, as if it were vertical.
            let below = (T::GREATEST, Vector3::new(T::zero(), T::zero(), -T::GREATEST * T::literal(0.25)));
            if !(normal.z > T::EPSILON) {
                return below;
            }
            let (x, y) = (normal.x / normal.z * ra, normal.y / normal.z * rb);
            let height = (normal.x * x + normal.y * y) * T::literal(0.5);
            let z = -(x * x / ra + y * y / rb) * T::literal(0.5);
            let far = !(x + y + z).is_number() || !height.is_number();
            if far { below } else { (height, Vector3::new(x, y, z)) }
        });
        Some(ClosestApproach { active: self.is_active(approach.point.z), ..approach })
    }

    #[inline]
    fn normal(&self, point: &Vector3<T>) -> Vector3<T> {
        self.normal_at(point)
    }

    #[inline]
    fn contains(&self, point: &Vector3<T>) -> bool {
        let [a, b] = self.curvatures;
        point.x * point.x * a + point.y * point.y * b + point.z + point.z < T::zero()
            && self.is_active(point.z)
    }

    #[inline(always)]
    fn shortcuts(&self) -> impl Shortcuts<T> {
        self
    }
}

impl<T: Real> Shortcuts<T> for Paraboloid<T> {
    /// `(x²/a + y²/b + 2z)` over the length of its gradient.
    fn surface_residual(&self, point: &Vector3<T>) -> T {
        let [a, b] = self.radii;
        let part = |x: T, radius: T| Twofold::new(x).over(radius).times(Twofold::new(x));
        let excess = part(point.x, a).plus(part(point.y, b)).plus(Twofold::new(point.z + point.z)).value();
        let [ca, cb] = self.curvatures;
        let slope = Vector3::new(point.x * ca, point.y * cb, T::one());
        excess / (length(&slope) * T::literal(2.0))
    }
}

/// The extent of an unbounded paraboloid is a ball of its larger radius of curvature.
impl<T: Real> SmoothSurface<T> for Paraboloid<T> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let [a, b] = self.radii();
        let (x, y) = (point.x / a, point.y / b);
        Level {
            value: point.z + (point.x * x + point.y * y) * T::literal(0.5),
            gradient: Vector3::new(x, y, T::one()),
            hessian: Matrix3::from_diagonal(&Vector3::new(T::one() / a, T::one() / b, T::zero())),
        }
    }

    fn extent(&self) -> Extent<T> {
        let [a, b] = self.radii();
        Extent { centre: Vector3::zeros(), radius: a.max(b) }
    }

    fn topology(&self) -> Topology {
        Topology::Convex
    }
}

stored! {
    Paraboloid<T>, [T: Real],
    |paraboloid| {
        radii_m: [T; 2] = paraboloid.radii,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        depth_m: Option<T> = paraboloid.depth,
    },
    Paraboloid::new(radii_m)
        .and_then(|paraboloid| depth_m.map_or(Ok(paraboloid), |depth| paraboloid.with_depth(depth)))
}
