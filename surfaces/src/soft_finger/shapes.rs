//! The shapes with closed forms.

use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::{ComplexField, Vector3};

use super::capsule::on_capsule_finely;
use super::cone::on_cone_finely;
use super::cylinder::on_cylinder;
use super::double::{finely, spins_little};
use super::ellipsoid::{on_ellipsoid, on_sphere, steeply_on_ellipsoid, steeply_on_sphere};
use super::frustum::{on_frustum, on_round_side};
use super::plane::on_plane;
use super::rim::{on_elliptic_rim, on_rim};
use super::torus::on_torus;
use crate::contact::flat;
use crate::numeric::vectors::largest;
use crate::numeric::vectors::wide;
use crate::{
    ActiveSurface, CappedCylinder, Capsule, Cone, Cylinder, CylinderEnds, Disk, Ellipsoid, EllipticCylinder,
    ForceLine, Frustum, Implicit, Paraboloid, Patch, Plane, Rectangle, RoundedBox, Search, SmoothImplicit,
    SoftContact, SoftFingerSurface, Sphere, SphericalCap, Superquadric, Torus, newton_soft_contacts,
};

/// Whether a point of the surface belongs to its active part: as the crossing of the normal there
/// says.
pub(super) fn is_active<T: Real, S: ActiveSurface<T>>(surface: &S, contact: &SoftContact<T>) -> bool {
    let mut nearest = T::GREATEST;
    let mut active = false;
    let line = Line { point: contact.point, direction: -contact.normal };
    surface.crossings(&line, |crossing| {
        let distance = crossing.along.abs();
        if distance < nearest {
            nearest = distance;
            active = crossing.active;
        }
    });
    active
}

/// Gives a shape its soft fingers: from the shape, the wrench and the last contact, to a search that
/// visits what it finds.
macro_rules! soft_finger {
    ($(#[$doc:meta])* $shape:ident, |$this:ident, $wrench:ident, $last:pat_param, $visit:ident| $search:expr
        $(, sole |$only:ident, $load:ident| $sole:expr)?
        $(, patch |$part:pat_param, $point:pat_param| $patch:expr)?) => {
        $(#[$doc])*
        impl<T: Real> SoftFingerSurface<T> for $shape<T> {
            #[inline]
            #[allow(unused_mut)]
            fn soft_contacts(
                &self,
                $wrench: &Wrench<T>,
                $last: Option<&Vector3<T>>,
                mut $visit: impl FnMut(SoftContact<T>),
            ) -> Search<T> {
                let $this = self;
                $search
            }

            $(#[inline(always)]
            fn sole_soft_contact(&self, $load: &ForceLine<T>) -> Option<SoftContact<T>> {
                let $only = self;
                $sole
            })?

            $(fn patch(&self, $point: &Vector3<T>) -> Option<Patch> {
                let $part = self;
                $patch
            })?
        }
    };
}

/// `true` if the force presses at no flat angle on what a shortcut found, and the spin torque is not more
/// than the force has at a lever of this length: otherwise rounding errors grow.
#[inline(always)]
fn is_steady<T: Real>(push: &ForceLine<T>, contact: &SoftContact<T>, lever: T) -> bool {
    let strength = push.squared().root();
    let steep = -push.force().dot(&contact.normal) >= flat::<T>() * strength;
    steep & (contact.spin_torque.abs() <= strength * lever)
}

/// What a closed form found, as a search.
#[inline]
fn report<T: Real>(
    found: Result<SoftContact<T>, [Vector3<T>; 2]>,
    mut visit: impl FnMut(SoftContact<T>),
) -> Search<T> {
    match found {
        Ok(contact) => {
            visit(contact);
            Search::Complete
        }
        Err(pair) => Search::Grazing(pair),
    }
}

/// The same for a closed form that finds a contact or none.
#[inline]
fn report_any<T: Real>(found: Option<SoftContact<T>>, visit: impl FnMut(SoftContact<T>)) -> Search<T> {
    found.into_iter().for_each(visit);
    Search::Complete
}

/// The same on a closed convex body, which has one contact wherever there is a spin torque: if none was
/// found, rounding hides it, unless the wrench is a pure force for all that its numbers say.
#[inline]
fn report_one<T: Real>(
    found: Option<SoftContact<T>>,
    wrench: &Wrench<T>,
    visit: impl FnMut(SoftContact<T>),
) -> Search<T> {
    let none = found.is_none();
    let search = report_any(found, visit);
    let power = wrench.force().dot(&wrench.torque()).abs();
    let largest_product = largest(&wrench.force()) * largest(&wrench.torque());
    // Half a unit in the last place of every number, and as much in three products and two sums.
    if none && power > largest_product * T::EPSILON * T::literal(8.0) { Search::Incomplete } else { search }
}

soft_finger!(
    Sphere,
    |shape, wrench, _, visit| report(on_sphere(shape, wrench), visit),
    sole | shape,
    push | steeply_on_sphere(shape, push)
);

soft_finger!(
    Ellipsoid,
    |shape, wrench, _, visit| report(on_ellipsoid(shape, wrench), visit),
    sole | shape,
    push | steeply_on_ellipsoid(shape, push)
);

#[inline(always)]
fn plane_contact<T: Real>(
    plane: &Plane<T>,
    force: &Vector3<T>,
    torque_about: impl FnOnce(&Vector3<T>) -> Vector3<T>,
) -> Option<SoftContact<T>> {
    let origin = plane.point();
    on_plane(&plane.outward(), force, &torque_about(&origin))
        .map(|contact| SoftContact { point: contact.point + origin, ..contact })
}

soft_finger!(
    Plane,
    |shape, wrench, _, visit| report_any(
        plane_contact(shape, &wrench.force(), |point| wrench.torque_about(point)),
        visit
    ),
    sole | shape,
    push | plane_contact(shape, &push.force(), |point| push.torque_about(point)).filter(|contact| is_steady(
        push,
        contact,
        largest(&contact.point)
    )),
    patch | shape,
    _ | Some(Patch::Plane { point: wide(&shape.point()), normal: wide(&shape.outward()) })
);

#[inline(always)]
fn cylinder_contact<T: Real>(
    shape: &Cylinder<T>,
    force: &Vector3<T>,
    torque_about: impl FnOnce(&Vector3<T>) -> Vector3<T>,
) -> Option<SoftContact<T>> {
    let (centre, axis) = (shape.centre(), shape.axis());
    let contact = on_round_side(&centre, &axis, shape.radius(), force, &torque_about(&centre))?;
    let height = (contact.point - centre).dot(&axis);
    Some(SoftContact { active: shape.half_length().is_none_or(|half| height.abs() <= half), ..contact })
}

/// In double precision if the type is narrower and the spin torque rules.
fn on_cylinder_finely<T: Real>(shape: &Cylinder<T>, wrench: &Wrench<T>) -> Result<SoftContact<T>, Search<T>> {
    let found = cylinder_contact(shape, &wrench.force(), |point| wrench.torque_about(point));
    finely(found.ok_or(Search::Complete), spins_little(wrench, shape.radius()), wrench, |wrench| {
        let double = Cylinder::new(wide(&shape.centre()), wide(&shape.axis()), shape.radius().to_f64());
        let double = match shape.half_length() {
            Some(half) => double.and_then(|double| double.with_half_length(half.to_f64())),
            None => double,
        };
        let found = cylinder_contact(&double.ok()?, &wrench.force(), |point| wrench.torque_about(point));
        Some(found.ok_or(Search::Complete))
    })
}

soft_finger!(
    Cylinder,
    |shape, wrench, _, visit| report_any(on_cylinder_finely(shape, wrench).ok(), visit),
    sole | shape,
    push | cylinder_contact(shape, &push.force(), |point| push.torque_about(point))
        .filter(|contact| is_steady(push, contact, shape.radius() * T::literal(0.5))),
    patch | shape,
    _ | Some(Patch::Cone {
        origin: wide(&shape.centre()),
        axis: wide(&shape.axis()),
        radius: shape.radius().to_f64(),
        taper: [0.0, 1.0],
    })
);

/// The side, or the plane of an end.
fn frustum_patch<T: Real>(solid: &Frustum<T>, point: &Vector3<T>) -> Patch {
    let (base, axis) = (wide(&solid.base_centre()), wide(&solid.axis()));
    let lean = solid.normal(point).dot(&solid.axis());
    let least = solid.taper() * solid.side_cosine();
    // Halfway between the side's normal and an end's.
    let half = T::literal(0.5);
    if lean > (T::one() + least) * half {
        Patch::Plane { point: base + axis * (solid.height().to_f64() / axis.norm()), normal: axis }
    } else if lean < (least - T::one()) * half {
        Patch::Plane { point: base, normal: -axis }
    } else {
        let [below, above] = [solid.base_radius(), solid.top_radius()].map(Real::to_f64);
        Patch::Cone { origin: base, axis, radius: below, taper: [below - above, solid.height().to_f64()] }
    }
}

soft_finger!(
    Frustum,
    |shape, wrench, _, visit| report_one(on_frustum(shape, wrench), wrench, visit),
    patch | shape,
    point | Some(frustum_patch(shape, point))
);

soft_finger!(
    CappedCylinder,
    |shape, wrench, _, visit| report_one(on_frustum(shape.solid(), wrench), wrench, visit),
    patch | shape,
    point | Some(frustum_patch(shape.solid(), point))
);

soft_finger!(
    /// The side by the closed form; flat ends as planes, within their outline; and the edges between
    /// them, with a normal between those of the faces that meet. A closed one is convex and has one
    /// contact, on one of these.
    EllipticCylinder,
    |shape, wrench, _, visit| {
        let axes = shape.semi_axes();
        let reciprocals = axes.map(|a| T::one() / a);
        let (force, torque) = (wrench.force(), wrench.torque());
        let mut found = None;
        on_cylinder(axes, reciprocals, &force, &torque, |contact| match shape.ends() {
            CylinderEnds::Unbounded => visit(contact),
            CylinderEnds::Open(half) => {
                visit(SoftContact { active: contact.point.z.abs() <= half, ..contact });
            }
            CylinderEnds::Capped(half) if contact.point.z.abs() <= half => found = Some(contact),
            CylinderEnds::Capped(_) => {}
        });
        if let CylinderEnds::Capped(half) = shape.ends() {
            for normal in [Vector3::z(), -Vector3::z()] {
                if found.is_some() {
                    break;
                }
                found = on_elliptic_end(axes, reciprocals, &normal, half, wrench);
            }
            return report_one(found, wrench, visit);
        }
        Search::Complete
    },
    patch | shape,
    point | Some(match shape.ends() {
        CylinderEnds::Capped(half) if !shape.normal(point).z.is_zero() => {
            let end = Vector3::z() * 1.0_f64.copysign(point.z.to_f64());
            Patch::Plane { point: end * half.to_f64(), normal: end }
        }
        _ => Patch::EllipticCylinder { semi_axes: shape.semi_axes().map(Real::to_f64) },
    })
);

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

soft_finger!(
    /// The side, or the tip, on which any normal will do that is steeper than the side's.
    Cone,
    |shape, wrench, _, visit| {
        let mut search = match on_cone_finely(shape, wrench) {
            Ok(contact) => {
                visit(SoftContact { active: is_active(shape, &contact), ..contact });
                return Search::Complete;
            }
            Err(search) => search,
        };
        let (apex, tip) = (shape.apex(), -shape.axis());
        let least = shape.half_angle().sin();
        on_rim(
            T::zero(),
            &tip,
            &wrench.force(),
            &wrench.torque_about(&apex),
            |normal, _| normal.dot(&tip) >= least,
            |contact| {
                search = Search::Complete;
                visit(SoftContact { point: apex, ..contact });
            },
        );
        search
    },
    patch | shape,
    _ | Some(Patch::Cone {
        origin: wide(&shape.apex()),
        axis: wide(&shape.axis()),
        radius: 0.0,
        taper: [-ComplexField::tan(shape.half_angle().to_f64()), 1.0],
    })
);

soft_finger!(
    /// The closed forms of the side and of the two round ends, each where it applies.
    Capsule,
    |shape, wrench, _, visit| {
        match on_capsule_finely(shape, wrench) {
            Ok(contact) => {
                visit(contact);
                Search::Complete
            }
            Err(Search::Complete) => report_one(None, wrench, visit),
            Err(other) => other,
        }
    },
    patch | shape,
    point | {
        let (origin, axis) = (wide(&shape.centre()), wide(&shape.axis()));
        let (height, half) = ((point - shape.centre()).dot(&shape.axis()), shape.half_length());
        let radius = shape.radius().to_f64();
        Some(if height.abs() <= half {
            Patch::Cone { origin, axis, radius, taper: [0.0, 1.0] }
        } else {
            Patch::Ball { origin, axis, height: half.copysign(height).to_f64(), radius }
        })
    }
);

/// Shapes that are a part of another shape.
macro_rules! part_of {
    ($shape:ident, $whole:ident) => {
        soft_finger!(
            $shape,
            |shape, wrench, last, visit| {
                shape.$whole().soft_contacts(wrench, last, |contact| {
                    visit(SoftContact { active: is_active(shape, &contact), ..contact });
                })
            },
            patch | shape,
            point | shape.$whole().patch(point)
        );
    };
}

part_of!(SphericalCap, sphere);
part_of!(Disk, plane);
part_of!(Rectangle, plane);

soft_finger!(
    Torus,
    |shape, wrench, _, visit| on_torus(shape, wrench, visit),
    patch | shape,
    _ | Some(Patch::Torus { ring: shape.ring_radius().to_f64(), tube: shape.tube_radius().to_f64() })
);

// Shapes without a closed form; the first two are active all over.
soft_finger!(
    Superquadric,
    |shape, wrench, last, visit| newton_soft_contacts(shape, wrench, last, visit),
    patch | shape,
    _ | {
        // Of a shape in double precision there is no more to be had.
        let narrow = T::EPSILON.to_f64() > f64::EPSILON;
        let double =
            narrow.then(|| Superquadric::new(wide(&shape.semi_axes()), shape.exponents().map(Real::to_f64)));
        double.and_then(Result::ok).map(Patch::Superquadric)
    }
);

/// By Newton's method; in double precision if the type is narrower and the spin torque rules: then rounding
/// decides between faces, edges and corners.
fn on_rounded_box<T: Real>(
    shape: &RoundedBox<T>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
) -> Result<SoftContact<T>, Search<T>> {
    let mut found = None;
    let search = newton_soft_contacts(shape, wrench, last, |contact| found = Some(contact));
    finely(found.ok_or(search), spins_little(wrench, shape.rounding()), wrench, |wrench| {
        let double = RoundedBox::new(wide(&shape.half_extents()), shape.rounding().to_f64()).ok()?;
        let (last, mut found) = (last.map(wide), None);
        let search = newton_soft_contacts(&double, wrench, last.as_ref(), |contact| found = Some(contact));
        Some(found.ok_or(search))
    })
}

soft_finger!(
    RoundedBox,
    |shape, wrench, last, visit| match on_rounded_box(shape, wrench, last) {
        Ok(contact) => {
            visit(contact);
            Search::Complete
        }
        Err(search) => search,
    },
    patch | shape,
    _ | Some(Patch::RoundedBox {
        half_extents: wide(&shape.half_extents()),
        rounding: shape.rounding().to_f64(),
    })
);
soft_finger!(Paraboloid, |shape, wrench, last, visit| {
    newton_soft_contacts(shape, wrench, last, |contact| {
        visit(SoftContact { active: is_active(shape, &contact), ..contact });
    })
});

impl<T: Real, S: SmoothImplicit<T>> SoftFingerSurface<T> for Implicit<S> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        newton_soft_contacts(self, wrench, last, visit)
    }
}
