//! The shapes with closed forms.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::cone::on_cone;
use super::cylinder::on_cylinder;
use super::ellipsoid::{on_ellipsoid, on_sphere};
use super::frustum::{on_frustum, on_round_side};
use super::plane::on_plane;
use super::rim::on_rim;
use super::torus::on_torus;
use crate::{
    ActiveSurface, CappedCylinder, Capsule, Cone, Cylinder, CylinderEnds, Disk, Ellipsoid, EllipticCylinder,
    Frustum, Implicit, Paraboloid, Plane, Rectangle, RoundedBox, Search, SmoothImplicit, SoftContact,
    SoftFingerSurface, Sphere, SphericalCap, Superquadric, Torus, newton_soft_contacts,
};
use fingertip_wrench::Line;

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

/// About the sensor's origin.
#[inline(always)]
fn sphere_contact<T: Real>(
    sphere: &Sphere<T>,
    wrench: &Wrench<T>,
) -> Result<SoftContact<T>, [Vector3<T>; 2]> {
    let centre = sphere.centre();
    let torque = wrench.torque_about(&centre);
    on_sphere(sphere.radius(), sphere.curvature(), &wrench.force(), &torque)
        .map(|contact| SoftContact { point: contact.point + centre, ..contact })
        .map_err(|pair| pair.map(|point| point + centre))
}

impl<T: Real> SoftFingerSurface<T> for Sphere<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        report(sphere_contact(self, wrench), visit)
    }

    #[inline]
    fn sole_soft_contact(&self, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
        sphere_contact(self, wrench).ok()
    }
}

impl<T: Real> SoftFingerSurface<T> for Plane<T> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let origin = self.point();
        let normal = self.normal(&origin);
        if let Some(contact) = on_plane(&normal, &wrench.force(), &wrench.torque_about(&origin)) {
            visit(SoftContact { point: contact.point + origin, ..contact });
        }
        Search::Complete
    }

    #[inline]
    fn sole_soft_contact(&self, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
        let origin = self.point();
        on_plane(&self.outward(), &wrench.force(), &wrench.torque_about(&origin))
            .map(|contact| SoftContact { point: contact.point + origin, ..contact })
    }
}

impl<T: Real> SoftFingerSurface<T> for Cylinder<T> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let (centre, axis) = (self.centre(), self.axis());
        if let Some(contact) = on_round_side(&centre, &axis, self.radius(), wrench) {
            let height = (contact.point - centre).dot(&axis);
            let active = self.half_length().is_none_or(|half| height.abs() <= half);
            visit(SoftContact { active, ..contact });
        }
        Search::Complete
    }
}

impl<T: Real> SoftFingerSurface<T> for Frustum<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        on_frustum(self, wrench, visit);
        Search::Complete
    }
}

impl<T: Real> SoftFingerSurface<T> for CappedCylinder<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        on_frustum(self.solid(), wrench, visit);
        Search::Complete
    }
}

impl<T: Real> SoftFingerSurface<T> for Ellipsoid<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let (force, torque) = (wrench.force(), wrench.torque());
        report(on_ellipsoid(&self.semi_axes(), &self.curvatures(), &force, &torque), visit)
    }

    #[inline]
    fn sole_soft_contact(&self, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
        on_ellipsoid(&self.semi_axes(), &self.curvatures(), &wrench.force(), &wrench.torque()).ok()
    }
}

/// The side by the closed form; flat ends as planes, within their outline. On the edge between
/// them there is no normal and so no soft finger.
impl<T: Real> SoftFingerSurface<T> for EllipticCylinder<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let axes = self.semi_axes();
        let reciprocals = axes.map(|a| T::one() / a);
        let (force, torque) = (wrench.force(), wrench.torque());
        on_cylinder(axes, reciprocals, &force, &torque, |contact| match self.ends() {
            CylinderEnds::Unbounded => visit(contact),
            CylinderEnds::Open(half) => {
                visit(SoftContact { active: contact.point.z.abs() <= half, ..contact });
            }
            CylinderEnds::Capped(half) if contact.point.z.abs() <= half => visit(contact),
            CylinderEnds::Capped(_) => {}
        });
        if let CylinderEnds::Capped(half) = self.ends() {
            for normal in [Vector3::z(), -Vector3::z()] {
                let origin = normal * half;
                if let Some(contact) = on_plane(&normal, &force, &wrench.torque_about(&origin)) {
                    let (x, y) = (contact.point.x * reciprocals[0], contact.point.y * reciprocals[1]);
                    if x * x + y * y <= T::one() {
                        visit(SoftContact { point: contact.point + origin, ..contact });
                    }
                }
            }
        }
        Search::Complete
    }
}

impl<T: Real> SoftFingerSurface<T> for Cone<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        if let Some(contact) = on_cone(self, wrench) {
            visit(SoftContact { active: is_active(self, &contact), ..contact });
            return Search::Complete;
        }
        // On the tip any normal will do that is steeper than the side's.
        let (apex, tip) = (self.apex(), -self.axis());
        let least = self.half_angle().sin();
        on_rim(
            T::zero(),
            &tip,
            &wrench.force(),
            &wrench.torque_about(&apex),
            |normal, _| normal.dot(&tip) >= least,
            |contact| visit(SoftContact { point: apex, ..contact }),
        );
        Search::Complete
    }
}

/// The closed forms of the side and of the two round ends, each where it applies.
impl<T: Real> SoftFingerSurface<T> for Capsule<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let (centre, axis, half) = (self.centre(), self.axis(), self.half_length());
        let mut found = false;
        if let Ok(side) = Cylinder::new(centre, axis, self.radius()) {
            side.soft_contacts(wrench, None, |contact| {
                if (contact.point - centre).dot(&axis).abs() <= half {
                    found = true;
                    visit(contact);
                }
            });
        }
        let mut search = Search::Complete;
        for end in [axis, -axis] {
            // A convex surface has one contact at most; a point of the seam belongs to the side.
            if found {
                break;
            }
            if let Ok(ball) = Sphere::new(centre + end * half, self.radius()) {
                let round = ball.soft_contacts(wrench, None, |contact| {
                    if contact.normal.dot(&end) >= T::zero() {
                        found = true;
                        visit(contact);
                    }
                });
                if let Search::Grazing([first, second]) = round {
                    let outside = |point: &Vector3<T>| (point - ball.centre()).dot(&end) >= T::zero();
                    if outside(&first) && outside(&second) {
                        search = round;
                    }
                }
            }
        }
        search
    }
}

/// Shapes that are a part of another shape.
macro_rules! part_of {
    ($shape:ident, $whole:ident) => {
        impl<T: Real> SoftFingerSurface<T> for $shape<T> {
            #[inline]
            fn soft_contacts(
                &self,
                wrench: &Wrench<T>,
                last: Option<&Vector3<T>>,
                mut visit: impl FnMut(SoftContact<T>),
            ) -> Search<T> {
                self.$whole().soft_contacts(wrench, last, |contact| {
                    visit(SoftContact { active: is_active(self, &contact), ..contact });
                })
            }
        }
    };
}

part_of!(SphericalCap, sphere);
part_of!(Disk, plane);
part_of!(Rectangle, plane);

impl<T: Real> SoftFingerSurface<T> for Torus<T> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        on_torus(self, wrench, visit)
    }
}

/// Shapes without a closed form.
macro_rules! by_newton {
    ($shape:ident) => {
        impl<T: Real> SoftFingerSurface<T> for $shape<T> {
            #[inline]
            fn soft_contacts(
                &self,
                wrench: &Wrench<T>,
                last: Option<&Vector3<T>>,
                mut visit: impl FnMut(SoftContact<T>),
            ) -> Search<T> {
                newton_soft_contacts(self, wrench, last, |contact| {
                    visit(SoftContact { active: is_active(self, &contact), ..contact });
                })
            }
        }
    };
}

by_newton!(Superquadric);
by_newton!(RoundedBox);
by_newton!(Paraboloid);

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
