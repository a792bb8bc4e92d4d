//! What a surface is near a point, to the last digit.

use fingertip_surfaces::numeric::twofold::Wide;
use fingertip_surfaces::numeric::vectors::tangents;
use fingertip_surfaces::{LocalSurface, SmoothSurface, Superquadric};
use fingertip_wrench::Real;
use nalgebra::{ComplexField, RealField, Vector3};

pub(crate) type Three<W> = [W; 3];

pub(crate) fn exactly<W: Wide>(v: &Vector3<f64>) -> Three<W> {
    [W::exactly(v.x), W::exactly(v.y), W::exactly(v.z)]
}

pub(crate) fn rounded<W: Wide>(v: Three<W>) -> Vector3<f64> {
    Vector3::from(v.map(W::rounded))
}

#[inline(never)]
pub(crate) fn dot<W: Wide>(a: Three<W>, b: Three<W>) -> W {
    a[0].times(b[0]).plus(a[1].times(b[1])).plus(a[2].times(b[2]))
}

/// `a + b·t`.
#[inline(never)]
pub(crate) fn plus_times<W: Wide>(a: Three<W>, b: Three<W>, t: W) -> Three<W> {
    [a[0].plus(b[0].times(t)), a[1].plus(b[1].times(t)), a[2].plus(b[2].times(t))]
}

pub(crate) fn cross<W: Wide>(a: Three<W>, b: Three<W>) -> Three<W> {
    let part = |i: usize, j: usize| a[i].times(b[j]).minus(a[j].times(b[i]));
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// A vector's length, and the unit vector along it.
fn unit<W: Wide>(v: Three<W>) -> (W, Three<W>) {
    let length = dot(v, v).root();
    (length, v.map(|x| x.over(length)))
}

/// A surface at a point.
pub(crate) struct Seen<W> {
    /// Distance from it, to first order \[m\].
    pub(crate) height: W,
    /// Outward unit normal.
    pub(crate) normal: Three<W>,
    /// A unit vector along a line of curvature, and the curvatures along it and across it \[1/m\].
    pub(crate) around: Vector3<f64>,
    pub(crate) curvatures: [f64; 2],
}

/// What a part of a surface tells of its points, with more digits than a number has.
pub(crate) trait Digits {
    /// The part as it is next to a point.
    fn seen<W: Wide>(&self, point: Three<W>) -> Seen<W>;

    /// Where a way from a point leaves this part of a surface whose curvature jumps between parts: the share of
    /// the way up to there, and what is behind.
    fn left_by<W: Wide>(&self, point: Three<W>, way: &Vector3<f64>) -> Way;
}

impl Digits for LocalSurface {
    fn seen<W: Wide>(&self, point: Three<W>) -> Seen<W> {
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
            Self::Turned { origin, radius, slope, turn, width, .. } => {
                turned(point, *origin, *radius, *slope, *turn, *width)
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
            Self::RoundedBox { half_extents, rounding, beyond } => {
                rounded_box(point, half_extents, *rounding, *beyond)
            }
            Self::Superquadric(shape) => superquadric(point, shape),
        }
    }

    fn left_by<W: Wide>(&self, point: Three<W>, way: &Vector3<f64>) -> Way {
        match *self {
            Self::RoundedBox { half_extents, rounding, beyond } => {
                let mut first: Option<(f64, usize)> = None;
                for (k, reaches) in beyond.into_iter().enumerate() {
                    // Towards the end of the box that the point is beyond, or that the way leads to.
                    let side = if reaches { side_of(point[k]) } else { W::exactly(1.0_f64.copysign(way[k])) };
                    let half = W::exactly(half_extents[k]);
                    let over = point[k].times(side).minus(half).plus(W::exactly(rounding));
                    let (over, gain) = (over.rounded(), way[k] * side.rounded());
                    let leaves = if reaches { over + gain < 0.0 } else { over + gain > 0.0 };
                    if leaves {
                        let share = (-over / gain).clamp(0.0, 1.0);
                        if first.is_none_or(|(before, _)| share < before) {
                            first = Some((share, k));
                        }
                    }
                }
                first.map_or(Way::Stays, |(share, crossed)| {
                    let beyond = core::array::from_fn(|k| beyond[k] != (k == crossed));
                    Way::Leaves(share, Behind::Part(Self::RoundedBox { half_extents, rounding, beyond }))
                })
            }
            Self::Turned { between: [low, high], width, .. } => {
                let end = if way.z > 0.0 { high } else { low };
                let left = W::exactly(end).minus(point[2]).rounded();
                if !end.is_finite() || (way.z - left) * way.z <= 0.0 {
                    return Way::Stays;
                }
                let share = (left / way.z).clamp(0.0, 1.0);
                let hair = (width[1] - width[0]) * 1e-3;
                Way::Leaves(share, Behind::Height(end + hair.copysign(way.z)))
            }
            _ => Way::Open,
        }
    }
}

/// Where a way from a point of a part of a surface leads.
pub(crate) enum Way {
    /// No more is known than that the curvature does not jump there, or seldom.
    Open,
    /// To another point of the part.
    Stays,
    /// After a share of it, to what is behind a seam.
    Leaves(f64, Behind),
}

/// What is behind a seam.
pub(crate) enum Behind {
    /// This part.
    Part(LocalSurface),
    /// The part that the surface has at this height.
    Height(f64),
}

/// The sign of a coordinate.
fn side_of<W: Wide>(x: W) -> W {
    W::exactly(1.0_f64.copysign(x.rounded()))
}

/// A part of a surface of revolution, by the numbers of [`LocalSurface::Turned`].
fn turned<W: Wide>(
    [x, y, z]: Three<W>,
    origin: f64,
    radius: f64,
    slope: f64,
    [before, after]: [f64; 2],
    [low, high]: [f64; 2],
) -> Seen<W> {
    let exactly = W::exactly;
    let (way, radius) = (z.minus(exactly(origin)), exactly(radius));
    let turns = exactly(after).minus(exactly(before)).over(exactly(high).minus(exactly(low)));
    let (slope, bend) = (exactly(slope), turns.times(way));
    let squared = radius.times(radius).plus(way.times(slope.plus(bend)));
    // The gradient of half of x² + y² − ρ².
    let rise = slope.plus(bend).plus(bend).times(exactly(0.5));
    let (steepness, normal) = unit([x, y, exactly(0.0).minus(rise)]);
    let excess = x.times(x).plus(y.times(y)).minus(squared);
    let (x, y, steep) = (x.rounded(), y.rounded(), steepness.rounded());
    let distance = Real::root(x * x + y * y);
    let rise = rise.rounded();
    // κ = (ρ′² − (ρ²)″/2)/(ρ (1 + ρ′²)^{3/2}), ρ′ = (ρ²)′/2ρ, of which ρ (1 + ρ′²)^{1/2} is the steepness.
    let leaning = rise / distance;
    let straight = leaning * leaning - turns.rounded();
    Seen {
        height: excess.over(steepness.plus(steepness)),
        normal,
        around: Vector3::new(-y, x, 0.0) / distance,
        curvatures: [1.0 / steep, straight / (steep * (1.0 + leaning * leaning))],
    }
}

/// A face, an edge or a corner of a rounded box.
fn rounded_box<W: Wide>(
    point: Three<W>,
    half_extents: &Vector3<f64>,
    rounding: f64,
    beyond: [bool; 3],
) -> Seen<W> {
    let distance = W::exactly(rounding);
    let outside = [0, 1, 2].map(|k| {
        let (half, side) = (W::exactly(half_extents[k]), side_of(point[k]));
        let over = point[k].times(side).minus(half).plus(distance);
        if beyond[k] { over.times(side) } else { W::exactly(0.0) }
    });
    let (length, normal) = unit(outside);
    let curvature = 1.0 / rounding;
    let n = rounded(normal);
    let along = |k: usize| Vector3::ith(k, 1.0).cross(&n);
    let (around, curvatures) = match beyond {
        [true, true, true] => (tangents(&n).0, [curvature; 2]),
        [false, true, true] => (along(0), [curvature, 0.0]),
        [true, false, true] => (along(1), [curvature, 0.0]),
        [true, true, false] => (along(2), [curvature, 0.0]),
        _ => (tangents(&n).0, [0.0; 2]),
    };
    Seen { height: length.minus(distance), normal, around, curvatures }
}

/// A superquadric, which is known to the digits of a double only.
fn superquadric<W: Wide>(point: Three<W>, shape: &Superquadric<f64>) -> Seen<W> {
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
