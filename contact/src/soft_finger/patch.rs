//! What a surface is near a point, to the last digit.

use fingertip_surfaces::numeric::twofold::Wide;
use fingertip_surfaces::numeric::vectors::tangents;
use fingertip_surfaces::{LocalSurface, SmoothSurface, Superquadric};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::three::unit;
pub(crate) use super::three::{Three, cross, dot, exactly, plus_times, rounded};

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
        let away_from = |origin: &Vector3<f64>| plus_times(point, exactly(origin), W::exactly(-1.0));
        let any = |normal: Three<W>| tangents(&rounded(normal)).0;
        match self {
            Self::Facets => {
                Seen { height: zero, normal: [zero; 3], around: Vector3::zeros(), curvatures: [0.0; 2] }
            }
            Self::Plane { point: origin, normal } => {
                let normal = unit(exactly(normal)).1;
                let height = dot(away_from(origin), normal);
                Seen { height, normal, around: any(normal), curvatures: [0.0; 2] }
            }
            Self::Ball { origin, axis, height, radius } => {
                let axis = unit(exactly(axis)).1;
                let (distance, normal) = unit(plus_times(away_from(origin), axis, W::exactly(-height)));
                let curvatures = [1.0 / radius; 2];
                let height = distance.minus(W::exactly(*radius));
                Seen { height, normal, around: any(normal), curvatures }
            }
            Self::Cone { origin, axis, radius, taper: [from, to, over] } => {
                let axis = unit(exactly(axis)).1;
                let from_origin = away_from(origin);
                let height = dot(from_origin, axis);
                let (distance, outward) = unit(plus_times(from_origin, axis, zero.minus(height)));
                let taper = W::exactly(*from).minus(W::exactly(*to)).over(W::exactly(*over));
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

/// A superquadric, of which the curvatures are those of double precision.
fn superquadric<W: Wide>(point: Three<W>, shape: &Superquadric<f64>) -> Seen<W> {
    let place = rounded(point);
    let level = shape.level(&place);
    let (normal, steepness) = level.normal().unwrap_or((Vector3::z(), 1.0));
    let (e1, e2) = tangents(&normal);
    let bend = shape.bend(&place, &normal, [&e1, &e2]);
    // Turned into the lines of curvature.
    let angle = Real::arctangent2(bend.m12 + bend.m21, bend.m11 - bend.m22) * 0.5;
    let (sine, cosine) = Real::sine_and_cosine(angle);
    let around = e1 * cosine + e2 * sine;
    let [c, s] = [cosine * cosine, sine * sine];
    let mixed = (bend.m12 + bend.m21) * cosine * sine;
    let (height, normal) = if W::BEYOND_DOUBLE {
        shape.height_and_normal(point)
    } else {
        (W::exactly(level.value / steepness), exactly(&normal))
    };
    Seen {
        height,
        normal,
        around,
        curvatures: [c * bend.m11 + s * bend.m22 + mixed, s * bend.m11 + c * bend.m22 - mixed],
    }
}

#[cfg(test)]
mod tests {
    use fingertip_surfaces::numeric::twofold::Twofold;
    use fingertip_surfaces::{LocalSurface, Superquadric};
    use nalgebra::Vector3;

    use fingertip_surfaces::numeric::twofold::Wide as _;

    use super::{Behind, Digits, Way, dot, exactly, rounded};

    type Wide = Twofold<f64>;

    /// Between the heights 5 and 5.25, of which a way leads out above, out below, or not.
    #[test]
    fn a_way_leaves_a_turned_part_at_its_end() {
        let part = |between| LocalSurface::Turned {
            origin: 5.0,
            radius: 2.0,
            slope: 0.3,
            turn: [0.1, -0.2],
            width: [5.0, 5.25],
            between,
        };
        let from = exactly::<Wide>(&Vector3::new(2.0, 0.0, 5.1));
        for (rise, share, end, away) in [(0.6, 0.25, 5.25, 1.0), (-0.4, 0.25, 5.0, -1.0)] {
            let Way::Leaves(found, Behind::Height(height)) =
                part([5.0, 5.25]).left_by(from, &Vector3::new(0.3, 0.1, rise))
            else {
                panic!("{rise} stays")
            };
            assert!((found - share).abs() < 1e-14, "{found}");
            // Behind the end, by less than any part is wide.
            let beyond = (height - end) * away;
            assert!(beyond > 0.0 && beyond < 1e-3, "{height}");
        }
        for rise in [0.15, 0.1499, -0.0999, 0.0, -0.0] {
            let way = part([5.0, 5.25]).left_by(from, &Vector3::new(0.3, 0.1, rise * 0.999));
            assert!(matches!(way, Way::Stays), "{rise}");
        }
        // Without an end it does not end.
        let open = part([f64::NEG_INFINITY, f64::INFINITY]);
        for rise in [1e3, -1e3] {
            assert!(matches!(open.left_by(from, &Vector3::new(0.0, 0.0, rise)), Way::Stays));
        }
    }

    /// On a box with round edges the first face plane that is crossed is the seam, and behind it that
    /// coordinate reaches beyond the box or no more.
    #[test]
    fn a_way_leaves_a_part_of_a_box_at_the_first_seam() {
        let half_extents = Vector3::new(3.0, 4.0, 5.0);
        let part = |beyond| LocalSurface::RoundedBox { half_extents, rounding: 1.0, beyond };
        // The box within is of half extents 2, 3 and 4.
        for (beyond, from, way, expected) in [
            ([true, false, false], [3.0, 1.0, 1.0], [0.0, 4.0, 4.0], Some((0.5, 1))),
            ([true, false, false], [3.0, 1.0, 1.0], [0.0, -8.0, 4.0], Some((0.5, 1))),
            ([true, false, false], [3.0, 1.0, 1.0], [0.0, 2.0, 6.0], Some((0.5, 2))),
            ([true, false, false], [3.0, 1.0, 1.0], [-0.5, 1.9, -4.9], None),
            ([true, false, false], [3.0, 1.0, 1.0], [-4.0, 0.0, 0.0], Some((0.25, 0))),
            ([true, true, false], [-2.6, 3.8, 1.0], [2.4, -0.1, 0.0], Some((0.25, 0))),
            ([true, true, false], [-2.6, 3.8, 1.0], [2.4, -8.0, 0.0], Some((0.1, 1))),
            ([true, true, false], [-2.6, 3.8, 1.0], [-2.4, 8.0, 2.9], None),
            ([true, true, true], [2.5, -3.5, -4.5], [-0.4, 0.4, 2.0], Some((0.25, 2))),
            ([true, true, true], [2.5, -3.5, -4.5], [-0.4, 1.0, 2.0], Some((0.25, 2))),
        ] {
            let left = part(beyond).left_by(exactly::<Wide>(&from.into()), &way.into());
            match (left, expected) {
                (Way::Stays, None) => {}
                (Way::Leaves(found, Behind::Part(behind)), Some((share, crossed))) => {
                    assert!((found - share).abs() < 1e-14, "{found} {share} {from:?} {way:?}");
                    let mut other = beyond;
                    other[crossed] ^= true;
                    assert_eq!(behind, part(other), "{from:?} {way:?}");
                }
                _ => panic!("{from:?} {way:?}"),
            }
        }
    }

    /// What a part says of a point: the height to first order, the normal as the slope of the height, and the
    /// curvatures as its turn, against differences over the surroundings.
    #[test]
    fn heights_normals_and_curvatures_belong_together() {
        let axis = Vector3::new(0.3, -0.2, 1.0);
        let origin = Vector3::new(0.1, 0.2, -0.1);
        let half_extents = Vector3::new(0.6, 0.7, 0.8);
        let rounded_box = |beyond| LocalSurface::RoundedBox { half_extents, rounding: 0.25, beyond };
        let superquadric = Superquadric::new(Vector3::new(0.5, 0.8, 0.6), [0.7, 1.2]).unwrap();
        let superquadric = LocalSurface::Superquadric(superquadric);
        for (name, part, near) in [
            ("plane", LocalSurface::Plane { point: origin, normal: axis }, [0.1, 0.5, -0.05]),
            ("ball", LocalSurface::Ball { origin, axis, height: 0.2, radius: 0.7 }, [0.6, -0.3, 0.4]),
            (
                "cone",
                LocalSurface::Cone { origin, axis, radius: 0.5, taper: [0.5, 0.3, 0.7] },
                [0.5, 0.5, 0.2],
            ),
            (
                "cylinder",
                LocalSurface::Cone { origin, axis, radius: 0.5, taper: [0.5, 0.5, 1.0] },
                [-0.4, 0.5, 0.2],
            ),
            (
                "turned",
                LocalSurface::Turned {
                    origin: 0.3,
                    radius: 0.6,
                    slope: 0.25,
                    turn: [0.2, -0.15],
                    width: [0.1, 0.7],
                    between: [0.1, 0.7],
                },
                [0.5, 0.4, 0.45],
            ),
            ("elliptic", LocalSurface::EllipticCylinder { semi_axes: [0.5, 0.8] }, [0.35, -0.55, 0.3]),
            ("torus", LocalSurface::Torus { ring: 0.9, tube: 0.3 }, [0.5, 0.9, 0.2]),
            ("inner torus", LocalSurface::Torus { ring: 0.9, tube: 0.3 }, [0.5, 0.4, 0.1]),
            ("corner", rounded_box([true; 3]), [-0.5, 0.6, 0.7]),
            ("edge along x", rounded_box([false, true, true]), [0.1, -0.6, 0.75]),
            ("edge along y", rounded_box([true, false, true]), [0.5, 0.1, -0.7]),
            ("edge along z", rounded_box([true, true, false]), [0.5, -0.6, 0.3]),
            ("face", rounded_box([false, true, false]), [0.1, -0.8, 0.3]),
            ("superquadric", superquadric, [0.35, 0.4, -0.3]),
        ] {
            let seen = |point: Vector3<f64>| part.seen(exactly::<Wide>(&point));
            // Onto it.
            let mut point = Vector3::from(near);
            for _ in 0..30 {
                let here = seen(point);
                point -= rounded(here.normal) * here.height.rounded();
            }
            let here = seen(point);
            assert!(here.height.rounded().abs() < 1e-14, "{name}");
            let normal = rounded(here.normal);
            assert!((dot(here.normal, here.normal).rounded() - 1.0).abs() < 1e-14, "{name}");
            assert!(
                (here.around.norm() - 1.0).abs() < 1e-14 && here.around.dot(&normal).abs() < 1e-14,
                "{name}"
            );
            let step = 1e-5;
            for k in 0..3 {
                let e = Vector3::ith(k, step);
                let slope = seen(point + e).height.rounded() - seen(point - e).height.rounded();
                assert!((slope / (step + step) - normal[k]).abs() < 1e-8, "{name} {k}");
            }
            let across = normal.cross(&here.around);
            for (way, curvature) in [here.around, across].into_iter().zip(here.curvatures) {
                let turned = |way: Vector3<f64>| rounded(seen(point + way * step).normal);
                let turn = (turned(way) - turned(-way)) / (step + step);
                let turn = turn - normal * turn.dot(&normal);
                assert!((turn - way * curvature).norm() < 1e-7, "{name}: {turn} {curvature}");
            }
        }
    }
}
