//! What a surface is near a point, to the last digit.

use nalgebra::Vector3;

use crate::Superquadric;

/// The shape that a surface is a part of, near one of its points, by the very numbers that it stores: a
/// single-precision shape too is one of these, exactly.
///
/// What a shape of one's own, made of parts, tells of its points:
///
/// ```
/// use fingertip_surfaces::LocalSurface;
/// use nalgebra::Vector3;
///
/// /// A rod of 5 mm radius with round ends, 10 mm up and down its axis z.
/// fn part(point: &Vector3<f64>) -> LocalSurface {
///     let (origin, axis, radius) = (Vector3::zeros(), Vector3::z(), 0.005);
///     if point.z.abs() <= 0.01 {
///         LocalSurface::Cone { origin, axis, radius, taper: [radius, radius, 1.0] }
///     } else {
///         LocalSurface::Ball { origin, axis, height: 0.01_f64.copysign(point.z), radius }
///     }
/// }
///
/// assert!(matches!(part(&Vector3::new(0.005, 0.0, 0.0)), LocalSurface::Cone { .. }));
/// assert!(matches!(part(&Vector3::new(0.0, 0.0, -0.015)), LocalSurface::Ball { height: -0.01, .. }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LocalSurface {
    /// The plane through a point \[m\] across a normal of any length.
    Plane {
        /// A point of it \[m\].
        point: Vector3<f64>,
        /// Outward.
        normal: Vector3<f64>,
    },
    /// A ball around the point of an axis at a height.
    Ball {
        /// A point of the axis \[m\].
        origin: Vector3<f64>,
        /// Along the axis, of any length.
        axis: Vector3<f64>,
        /// From the origin to the centre \[m\].
        height: f64,
        /// Radius \[m\].
        radius: f64,
    },
    /// A circular cone around an axis; a cylinder if it does not taper.
    Cone {
        /// A point of the axis \[m\].
        origin: Vector3<f64>,
        /// Along the axis, of any length.
        axis: Vector3<f64>,
        /// The radius at the origin \[m\].
        radius: f64,
        /// From which radius it shrinks to which \[m\], over how much height \[m\].
        taper: [f64; 3],
    },
    /// A part of a surface of revolution around the third axis: `ρ² = r² + d (s + (t₁ − t₀) d/(w₁ − w₀))` at
    /// the height `d` over `r`.
    Turned {
        /// The height at which the numbers are taken \[m\].
        origin: f64,
        /// `r` \[m\].
        radius: f64,
        /// `s` \[m\].
        slope: f64,
        /// `t₀`, `t₁` \[m\].
        turn: [f64; 2],
        /// `w₀`, `w₁` \[m\].
        width: [f64; 2],
        /// The heights between which it is so \[m\].
        between: [f64; 2],
    },
    /// The elliptic cylinder around the third axis.
    EllipticCylinder {
        /// Along the first two axes \[m\].
        semi_axes: [f64; 2],
    },
    /// The torus around the third axis.
    Torus {
        /// From the axis to the middle of the tube \[m\].
        ring: f64,
        /// Radius of the tube \[m\].
        tube: f64,
    },
    /// A part of all points at one distance from a box about the origin: the face, the edge or the corner
    /// at which the same coordinates reach beyond the box.
    RoundedBox {
        /// Half extents, roundings included \[m\].
        half_extents: Vector3<f64>,
        /// That distance \[m\].
        rounding: f64,
        /// Which coordinates reach beyond the box.
        beyond: [bool; 3],
    },
    /// Flat facets, of which a shape finds contacts to the last digit by itself.
    Facets,
    /// A superquadric, for a type narrower than `f64`.
    Superquadric(Superquadric<f64>),
}
