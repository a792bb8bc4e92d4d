//! What a surface is near a point, to the last digit.

use nalgebra::{ComplexField, RealField, Vector3};

use crate::numeric::twofold::Wide;
use crate::numeric::vectors::tangents;
use crate::{SmoothSurface, Superquadric};

/// The shape that a surface is a part of, near one of its points, by the very numbers that it stores: a
/// single-precision shape too is one of these, exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Patch {
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
        /// By how much the radius shrinks over how much height.
        taper: [f64; 2],
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
    /// All points at one distance from a box about the origin.
    RoundedBox {
        /// Half extents, roundings included \[m\].
        half_extents: Vector3<f64>,
        /// That distance \[m\].
        rounding: f64,
    },
    /// A superquadric, for a type narrower than `f64`.
    Superquadric(Superquadric<f64>),
}

pub(super) type Three<W> = [W; 3];

pub(super) fn exactly<W: Wide>(v: &Vector3<f64>) -> Three<W> {
    [W::exactly(v.x), W::exactly(v.y), W::exactly(v.z)]
}

pub(super) fn rounded<W: Wide>(v: Three<W>) -> Vector3<f64> {
    Vector3::from(v.map(W::rounded))
}

#[inline(never)]
pub(super) fn dot<W: Wide>(a: Three<W>, b: Three<W>) -> W {
    a[0].times(b[0]).plus(a[1].times(b[1])).plus(a[2].times(b[2]))
}

/// `a + b·t`.
#[inline(never)]
pub(super) fn plus_times<W: Wide>(a: Three<W>, b: Three<W>, t: W) -> Three<W> {
    [a[0].plus(b[0].times(t)), a[1].plus(b[1].times(t)), a[2].plus(b[2].times(t))]
}

pub(super) fn cross<W: Wide>(a: Three<W>, b: Three<W>) -> Three<W> {
    let part = |i: usize, j: usize| a[i].times(b[j]).minus(a[j].times(b[i]));
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// A vector's length, and the unit vector along it.
fn unit<W: Wide>(v: Three<W>) -> (W, Three<W>) {
    let length = dot(v, v).root();
    (length, v.map(|x| x.over(length)))
}

/// A surface at a point.
pub(super) struct Seen<W> {
    /// Distance from it, to first order \[m\].
    pub(super) height: W,
    /// Outward unit normal.
    pub(super) normal: Three<W>,
    /// A unit vector along a line of curvature, and the curvatures along it and across it \[1/m\].
    pub(super) around: Vector3<f64>,
    pub(super) curvatures: [f64; 2],
}

impl Patch {
    pub(super) fn seen<W: Wide>(&self, point: Three<W>) -> Seen<W> {
        let zero = W::exactly(0.0);
        let from = |origin: &Vector3<f64>| plus_times(point, exactly(origin), W::exactly(-1.0));
        let any = |normal: Three<W>| tangents(&rounded(normal)).0;
        match self {
            Self::Plane { point: origin, normal } => {
                let normal = unit(exactly(normal)).1;
                let height = dot(from(origin), normal);
                Seen { height, normal, around: any(normal), curvatures: [0.0; 2] }
            }
            Self::Ball { origin, axis, height, radius } => {
                let axis = unit(exactly(axis)).1;
                let (distance, normal) = unit(plus_times(from(origin), axis, W::exactly(-height)));
                let curvatures = [1.0 / radius; 2];
                let height = distance.minus(W::exactly(*radius));
                Seen { height, normal, around: any(normal), curvatures }
            }
            Self::Cone { origin, axis, radius, taper: [shrinks, over] } => {
                let axis = unit(exactly(axis)).1;
                let from_origin = from(origin);
                let height = dot(from_origin, axis);
                let (distance, outward) = unit(plus_times(from_origin, axis, zero.minus(height)));
                let taper = W::exactly(*shrinks).over(W::exactly(*over));
                let (long, normal) = unit(plus_times(outward, axis, taper));
                let excess = distance.minus(W::exactly(*radius)).plus(taper.times(height));
                let cosine = 1.0 / long.rounded();
                Seen {
                    height: excess.over(long),
                    normal,
                    around: rounded(axis).cross(&rounded(outward)),
                    curvatures: [cosine / distance.rounded(), 0.0],
                }
            }
            Self::EllipticCylinder { semi_axes: [a, b] } => {
                let (a, b) = (W::exactly(*a), W::exactly(*b));
                let (x, y) = (point[0].over(a), point[1].over(b));
                let (steepness, normal) = unit([x.over(a), y.over(b), zero]);
                let excess = x.times(x).plus(y.times(y)).minus(W::exactly(1.0));
                let n = rounded(normal);
                let (u, v) = (n.y / a.rounded(), n.x / b.rounded());
                Seen {
                    height: excess.over(steepness.plus(steepness)),
                    normal,
                    around: Vector3::new(-n.y, n.x, 0.0),
                    curvatures: [(u * u + v * v) / steepness.rounded(), 0.0],
                }
            }
            Self::Torus { ring, tube } => {
                let [x, y, z] = point;
                let (radial, outward) = unit([x, y, zero]);
                let beyond = radial.minus(W::exactly(*ring));
                let (distance, normal) = unit([outward[0].times(beyond), outward[1].times(beyond), z]);
                let out = rounded(outward);
                Seen {
                    height: distance.minus(W::exactly(*tube)),
                    normal,
                    around: Vector3::new(-out.y, out.x, 0.0),
                    curvatures: [out.dot(&rounded(normal)) / radial.rounded(), 1.0 / tube],
                }
            }
            Self::RoundedBox { half_extents, rounding } => {
                let distance = W::exactly(*rounding);
                let p = rounded(point);
                // Beyond the inner box on its own side of it, or not.
                let outside = [0, 1, 2].map(|k| {
                    let side = W::exactly(1.0_f64.copysign(p[k]));
                    let beyond = point[k].times(side).minus(W::exactly(half_extents[k])).plus(distance);
                    (beyond.rounded() > 0.0).then_some((beyond, side))
                });
                let (length, normal) =
                    unit(outside.map(|x| x.map_or(zero, |(beyond, side)| beyond.times(side))));
                let curvature = 1.0 / rounding;
                let n = rounded(normal);
                let along = |k: usize| Vector3::ith(k, 1.0).cross(&n);
                let (around, curvatures) = match outside.map(|x| x.is_some()) {
                    [true, true, true] => (any(normal), [curvature; 2]),
                    [false, true, true] => (along(0), [curvature, 0.0]),
                    [true, false, true] => (along(1), [curvature, 0.0]),
                    [true, true, false] => (along(2), [curvature, 0.0]),
                    _ => (any(normal), [0.0; 2]),
                };
                Seen { height: length.minus(distance), normal, around, curvatures }
            }
            Self::Superquadric(shape) => {
                let level = shape.level(&rounded(point));
                let (normal, steepness) = level.normal().unwrap_or((Vector3::z(), 1.0));
                let (e1, e2) = tangents(&normal);
                let bend = shape.bend(&rounded(point), &normal, [&e1, &e2]);
                // Turned into the lines of curvature.
                let angle = RealField::atan2(bend.m12 + bend.m21, bend.m11 - bend.m22) * 0.5;
                let (sine, cosine) = ComplexField::sin_cos(angle);
                let around = e1 * cosine + e2 * sine;
                let [c, s] = [cosine * cosine, sine * sine];
                let mixed = (bend.m12 + bend.m21) * cosine * sine;
                Seen {
                    height: W::exactly(level.value / steepness),
                    normal: exactly(&normal),
                    around,
                    curvatures: [c * bend.m11 + s * bend.m22 + mixed, s * bend.m11 + c * bend.m22 - mixed],
                }
            }
        }
    }
}
