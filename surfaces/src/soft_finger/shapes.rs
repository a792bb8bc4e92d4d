//! The shapes with closed forms.

use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;

use super::cone::on_cone;
use super::cylinder::on_cylinder;
use super::ellipsoid::{on_ellipsoid, on_sphere, steeply_on_ellipsoid, steeply_on_sphere};
use super::frustum::{on_frustum, on_round_side};
use super::plane::on_plane;
use super::rim::{on_elliptic_rim, on_rim};
use super::torus::on_torus;
use crate::contact::flat;
use crate::numeric::vectors::largest;
use crate::{
    ActiveSurface, CappedCylinder, Capsule, Cone, Cylinder, CylinderEnds, Disk, Ellipsoid, EllipticCylinder,
    ForceLine, Frustum, Implicit, Paraboloid, Plane, Rectangle, RoundedBox, Search, SmoothImplicit,
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
        $(, sole |$only:ident, $load:ident| $sole:expr)?) => {
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
        }
    };
}

/// `true` if the force presses at no flat angle on what a shortcut found.
#[inline(always)]
fn is_steep<T: Real>(push: &ForceLine<T>, contact: &SoftContact<T>) -> bool {
    -push.force().dot(&contact.normal) >= flat::<T>() * push.squared().root()
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
    push | plane_contact(shape, &push.force(), |point| push.torque_about(point))
        .filter(|contact| is_steep(push, contact))
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

soft_finger!(
    Cylinder,
    |shape, wrench, _, visit| report_any(
        cylinder_contact(shape, &wrench.force(), |point| wrench.torque_about(point)),
        visit
    ),
    sole | shape,
    push | cylinder_contact(shape, &push.force(), |point| push.torque_about(point))
        .filter(|contact| is_steep(push, contact))
);

soft_finger!(Frustum, |shape, wrench, _, visit| report_one(on_frustum(shape, wrench), wrench, visit));

soft_finger!(CappedCylinder, |shape, wrench, _, visit| report_one(
    on_frustum(shape.solid(), wrench),
    wrench,
    visit
));

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
    }
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
        let mut search = match on_cone(shape, wrench) {
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
    }
);

soft_finger!(
    /// The closed forms of the side and of the two round ends, each where it applies.
    Capsule,
    |shape, wrench, _, visit| {
        let (centre, axis, half) = (shape.centre(), shape.axis(), shape.half_length());
        let torque = wrench.torque_about(&centre);
        if let Some(contact) = on_round_side(&centre, &axis, shape.radius(), &wrench.force(), &torque)
            && (contact.point - centre).dot(&axis).abs() <= half
        {
            visit(contact);
            return Search::Complete;
        }
        let mut search = Search::Complete;
        for end in [axis, -axis] {
            // A convex surface has one contact at most; a point of the seam belongs to the side.
            let Ok(ball) = Sphere::new(centre + end * half, shape.radius()) else { continue };
            match on_sphere(&ball, wrench) {
                Ok(contact) if contact.normal.dot(&end) >= T::zero() => {
                    visit(contact);
                    return Search::Complete;
                }
                Ok(_) => {}
                Err(pair) => {
                    let outside = |point: &Vector3<T>| (point - ball.centre()).dot(&end) >= T::zero();
                    if pair.iter().all(outside) {
                        search = Search::Grazing(pair);
                    }
                }
            }
        }
        match search {
            Search::Complete => report_one(None, wrench, visit),
            other => other,
        }
    }
);

/// Shapes that are a part of another shape.
macro_rules! part_of {
    ($shape:ident, $whole:ident) => {
        soft_finger!($shape, |shape, wrench, last, visit| {
            shape.$whole().soft_contacts(wrench, last, |contact| {
                visit(SoftContact { active: is_active(shape, &contact), ..contact });
            })
        });
    };
}

part_of!(SphericalCap, sphere);
part_of!(Disk, plane);
part_of!(Rectangle, plane);

soft_finger!(Torus, |shape, wrench, _, visit| on_torus(shape, wrench, visit));

// Shapes without a closed form; the first two are active all over.
soft_finger!(Superquadric, |shape, wrench, last, visit| newton_soft_contacts(shape, wrench, last, visit));
soft_finger!(RoundedBox, |shape, wrench, last, visit| newton_soft_contacts(shape, wrench, last, visit));
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
