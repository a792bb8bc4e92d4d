//! The elliptic cylinder, with its ends.

#[cfg(feature = "batch")]
use core::hint::select_unpredictable;

use crate::uncertainty::geometry::stretched;
#[cfg(feature = "batch")]
use fingertip_surfaces::Entry;
use fingertip_surfaces::numeric::vectors::smaller;
use fingertip_surfaces::{
    ActiveSurface, CylinderEnds, EllipticCylinder, ForceLine, LocalSurface, SmoothSurface,
};
use fingertip_wrench::{Real, RigidTransform, Wrench};
use nalgebra::Vector3;

use super::cylinder::on_cylinder;
use super::plane::on_plane;
use super::slanted_side::is_steep;
use crate::soft_finger::closed_form::{soft_finger, sole, told};
use crate::soft_finger::double::{finely, is_steady};
use crate::soft_finger::edge::surely_on_side;
use crate::soft_finger::rim::on_elliptic_rim;
use crate::{GeometrySensitivity, Search, SoftContact};

/// The soft-finger contact on the side by the closed form; on flat ends as on planes, within their outline;
/// and on the edges between them, with a normal between those of the faces that meet. A closed one is convex
/// and has one contact, on one of these.
///
/// # Errors
/// How the search ended without one.
fn on_elliptic_cylinder<T: Real>(
    shape: &EllipticCylinder<T>,
    wrench: &Wrench<T>,
) -> Result<SoftContact<T>, Search<T>> {
    let axes = shape.semi_axes();
    let reciprocals = shape.curvatures();
    let mut side = None;
    on_cylinder(axes, reciprocals, &wrench.force(), &wrench.torque(), |contact| side = Some(contact));
    let within = |half: T| move |contact: &SoftContact<T>| contact.point.z.abs() <= half;
    match shape.ends() {
        CylinderEnds::Unbounded => side.ok_or(Search::Complete),
        CylinderEnds::Open(half) => side
            .map(|contact| SoftContact { active: within(half)(&contact), ..contact })
            .ok_or(Search::Complete),
        CylinderEnds::Capped(half) => {
            let on_end = |normal| on_elliptic_end(axes, reciprocals, &normal, half, wrench);
            let found = side
                .filter(within(half))
                .or_else(|| [Vector3::z(), -Vector3::z()].into_iter().find_map(on_end));
            sole(found, wrench)
        }
    }
}

/// On a flat end with an elliptic outline, or on the edge around it.
fn on_elliptic_end<T: Real>(
    axes: [T; 2],
    reciprocals: [T; 2],
    normal: &Vector3<T>,
    half: T,
    wrench: &Wrench<T>,
) -> Option<SoftContact<T>> {
    let origin = normal * half;
    let (force, torque) = (wrench.force(), wrench.torque_about(&origin));
    let mut found = on_plane(normal, &force, &torque).filter(|contact| {
        let (x, y) = (contact.point.x * reciprocals[0], contact.point.y * reciprocals[1]);
        x * x + y * y <= T::one()
    });
    if found.is_none() {
        // The side's normal at `A ρ` is along `A⁻¹ ρ`.
        let outward = |n: &Vector3<T>, ring: &Vector3<T>| {
            n.x * ring.x * reciprocals[0] + n.y * ring.y * reciprocals[1] >= T::zero()
        };
        on_elliptic_rim(
            axes,
            normal,
            &force,
            &torque,
            |n, ring| n.dot(normal) >= T::zero() && outward(n, ring),
            |contact| found = Some(contact),
        );
    }
    found.map(|contact| SoftContact { point: contact.point + origin, ..contact })
}

/// The contact of a force that presses steeply, on the side or within the flat end that it presses on. Edges, and what
/// is near to them, take the long way.
#[inline(always)]
fn steeply_on_elliptic_cylinder<T: Real>(
    shape: &EllipticCylinder<T>,
    push: &ForceLine<T>,
) -> Option<SoftContact<T>> {
    let ([a, b], [ka, kb], [active_to, half]) = (shape.semi_axes(), shape.curvatures(), shape.heights());
    let hair = hair([a, b], half);
    if let Some(contact) = steeply_on_side(shape, push)
        && contact.point.z.abs() <= half - hair
    {
        return Some(SoftContact { active: contact.point.z.abs() <= active_to, ..contact });
    }
    let (force, torque) = (push.force(), push.torque());
    let normal = -Vector3::z() * force.z.signum();
    let share = T::one() / force.z.abs();
    let spin_torque = -force.dot(&torque) * share;
    let away = (torque - normal.cross(&force) * half).cross(&normal) * share;
    let inner = T::one() - hair / smaller(a, b);
    let (x, y) = (away.x * ka, away.y * kb);
    let steep = is_steep(push, force.z, spin_torque * (ka + kb));
    let inside = (inner > T::zero()) & (x * x + y * y <= inner * inner);
    (steep & inside).then(|| SoftContact { point: away + normal * half, normal, spin_torque, active: true })
}

/// As near to an edge as rounding brings a contact.
fn hair<T: Real>([a, b]: [T; 2], half: T) -> T {
    (half + a + b) * (T::literal(64.0) * T::EPSILON)
}

/// On the side, unbounded, for a force that presses at no flat angle and a spin torque that does not rule.
///
/// Over the semi-axes it is round: `y` of [`on_cylinder`] is where on the unit circle. As for round sides
/// (`docs/theory/contact.md#straight-sides`) the rest follows from the normal, with `ρ` the point of the outline there and
/// `a` along the axis:
///
/// ```text
/// p = −f·n,   τ = −f·m/p,   z = (m·(n × a) − (ρ·n) f·a)/p
/// ```
#[inline(always)]
fn steeply_on_side<T: Real>(shape: &EllipticCylinder<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    let ([a, b], [ka, kb]) = (shape.semi_axes(), shape.curvatures());
    let (f, m) = (push.force(), push.torque());
    let (fx, fy, turning) = (f.x * ka, f.y * kb, m.z * ka * kb);
    let squared = fx * fx + fy * fy;
    let root_squared = squared - turning * turning;
    // Not where the torque hides the force, and the root loses digits. False for a NaN, too.
    let wide = root_squared >= squared * T::literal(0.06);
    if !(wide & (squared >= T::LEAST_NORMAL) & (squared <= T::GREATEST)) {
        return None;
    }
    let (root, inverse) = (root_squared.root(), T::one() / squared);
    let (x, y) = ((fy * turning - fx * root) * inverse, (-fx * turning - fy * root) * inverse);
    let (gx, gy) = (x * ka, y * kb);
    // How far the tangent is from the axis: `ρ·n`.
    let support = T::one() / (gx * gx + gy * gy).root();
    let (nx, ny) = (gx * support, gy * support);
    let pressing = -(f.x * nx + f.y * ny);
    let share = T::one() / pressing;
    let spin_torque = -f.dot(&m) * share;
    let height = (m.x * ny - m.y * nx - support * f.z) * share;
    // What rounding does is multiplied by no more than `(1 + |τ κ|/|f|)²/(f·n/|f|)²`, with the curvature of the outline.
    let bend = ka * kb * support;
    let twist = spin_torque * (bend * bend * support);
    let is_steady = is_steep(push, pressing, twist);
    let point = Vector3::new(x * a, y * b, height);
    (is_steady & (pressing > T::zero()) & height.is_number()).then(|| SoftContact {
        point,
        normal: Vector3::new(nx, ny, T::zero()),
        spin_torque,
        active: true,
    })
}

/// In double precision if the type is narrower and rounding decides between the side and an end.
fn on_elliptic_cylinder_finely<T: Real>(
    shape: &EllipticCylinder<T>,
    wrench: &Wrench<T>,
) -> Result<SoftContact<T>, Search<T>> {
    let [a, b] = shape.semi_axes();
    finely(on_elliptic_cylinder(shape, wrench), is_steady(wrench, smaller(a, b)), wrench, |wrench| {
        elliptic_in_double(shape, wrench)
    })
}

fn elliptic_in_double<T: Real>(
    shape: &EllipticCylinder<T>,
    wrench: &Wrench<f64>,
) -> Option<Result<SoftContact<f64>, Search<f64>>> {
    shape.in_double().map(|double| on_elliptic_cylinder(&double, wrench))
}

/// The same where rounding decides between the side and an edge.
fn surely_beside_edges<T: Real>(
    shape: &EllipticCylinder<T>,
    wrench: &Wrench<T>,
    pose: Option<&RigidTransform<T>>,
    found: Result<SoftContact<T>, Search<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    let [_, half] = shape.heights();
    if half >= T::GREATEST {
        return found;
    }
    let hair = hair(shape.semi_axes(), half);
    let on_edge = |point: &Vector3<T>| (point.z.abs() - half).abs() <= hair;
    let between = |point: &Vector3<T>| point.z.abs() <= half;
    surely_on_side(wrench, pose, side_of(shape), on_edge, between, found)
}

/// The side, unbounded.
fn side_of<T: Real>(shape: &EllipticCylinder<T>) -> LocalSurface {
    LocalSurface::EllipticCylinder { semi_axes: shape.semi_axes().map(Real::to_f64) }
}

soft_finger!(
    EllipticCylinder,
    |shape, wrench, _, visit| {
        let found = on_elliptic_cylinder_finely(shape, wrench);
        told(surely_beside_edges(shape, wrench, None, found), visit)
    },
    sole | shape,
    push | steeply_on_elliptic_cylinder(shape, push),
    double | shape,
    wrench | elliptic_in_double(shape, wrench),
    surely | shape,
    wrench,
    pose,
    found | surely_beside_edges(shape, wrench, pose, found),
    patch | shape,
    point
        | Some(match shape.ends() {
            CylinderEnds::Capped(half) if !shape.normal(point).z.is_zero() => {
                let end = Vector3::z() * 1.0_f64.copysign(point.z.to_f64());
                LocalSurface::Plane { point: end * half.to_f64(), normal: end }
            }
            _ => side_of(shape),
        }),
    sizes | shape,
    size,
    point | of_elliptic_cylinder(shape, point).get(size).copied()
);

/// The two semi-axes; on a flat end they change nothing.
fn of_elliptic_cylinder<T: Real>(
    shape: &EllipticCylinder<T>,
    point: &Vector3<T>,
) -> [GeometrySensitivity<T>; 2] {
    if shape.normal(point).z.abs() > T::literal(0.5) {
        return [GeometrySensitivity::none(); 2];
    }
    [0, 1].map(|i| stretched(&shape.level(point), point, i, shape.semi_axes()[i]))
}

#[cfg(feature = "batch")]
crate::batch::each::entering!(EllipticCylinder, |cylinder, push| Some(entry_of_elliptic(cylinder, push)));

/// Where the line of a force enters: through the flat end that it comes from, within its outline, or else through the side.
///
/// Over the semi-axes the side is round: with the foot `s` and the force `f` so scaled, and what is across the axis of both,
/// `|f|² t² + 2 s·f t + |s|² = 1`.
#[cfg(feature = "batch")]
#[inline(always)]
fn entry_of_elliptic<T: Real>(shape: &EllipticCylinder<T>, push: &ForceLine<T>) -> Entry<T> {
    let ([ka, kb], f) = (shape.curvatures(), push.force());
    let [active_to, half] = shape.heights();
    let s = f.cross(&push.torque()) * (T::one() / push.squared());
    let (fx, fy, sx, sy) = (f.x * ka, f.y * kb, s.x * ka, s.y * kb);
    let (a, b) = (fx * fx + fy * fy, sx * fx + sy * fy);
    // What the line is beside the axis, in radii, times the force across it: no square of a far foot is taken from another.
    let aside = sx * fy - sy * fx;
    let root = (a - aside * aside).root();
    let end = half.copysign(-f.z);
    let to_end = (end - s.z) / f.z;
    let (x, y) = (sx + fx * to_end, sy + fy * to_end);
    let through_end = (half < T::GREATEST) & (x * x + y * y < T::one());
    let along = select_unpredictable(through_end, to_end, -(b + root) / a);
    let z = select_unpredictable(through_end, end, s.z + f.z * along);
    let point = Vector3::new(s.x + f.x * along, s.y + f.y * along, z);
    let (gx, gy) = ((sx + fx * along) * ka, (sy + fy * along) * kb);
    let steepness = gx * gx + gy * gy;
    let inverse = T::one() / steepness.root();
    let pressing = select_unpredictable(through_end, f.z * f.z, root * root / steepness);
    let on_side = select_unpredictable(through_end, T::zero(), inverse);
    let on_end = select_unpredictable(through_end, T::one().copysign(end), T::zero());
    // Beside a closed one the line may enter the side that it does not have.
    let is_there = through_end | (z.abs() <= half);
    Entry {
        point,
        normal: Vector3::new(gx * on_side, gy * on_side, on_end),
        incidence_squared: select_unpredictable(is_there, pressing / push.squared(), T::zero()),
        parts: None,
        active: z.abs() <= active_to,
    }
}
