//! The shapes with closed forms.

use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::cylinder::on_cylinder;
use super::ellipsoid::on_sphere;
use super::newton::tangents;
use super::plane::on_plane;
use crate::{ActiveSurface, Cylinder, Plane, Search, SoftContact, SoftFingerSurface, Sphere};

impl<T: Real> SoftFingerSurface<T> for Sphere<T> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let centre = self.centre();
        let torque = wrench.torque_about(&centre);
        let search = on_sphere(self.radius(), T::one() / self.radius(), &wrench.force(), &torque, |contact| {
            visit(SoftContact { point: contact.point + centre, ..contact });
        });
        match search {
            Search::Grazing(pair) => Search::Grazing(pair.map(|point| point + centre)),
            other => other,
        }
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
}

impl<T: Real> SoftFingerSurface<T> for Cylinder<T> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        _last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let (centre, axis, radius) = (self.centre(), self.axis(), self.radius());
        let (first, second) = tangents(&axis);
        let inward = |v: &Vector3<T>| Vector3::new(v.dot(&first), v.dot(&second), v.dot(&axis));
        let outward = |v: &Vector3<T>| first * v.x + second * v.y + axis * v.z;
        let force = inward(&wrench.force());
        let torque = inward(&wrench.torque_about(&centre));
        let curvature = T::one() / radius;
        on_cylinder([radius; 2], [curvature; 2], &force, &torque, |contact| {
            visit(SoftContact {
                point: outward(&contact.point) + centre,
                normal: outward(&contact.normal),
                active: self.half_length().is_none_or(|half| contact.point.z.abs() <= half),
                ..contact
            });
        })
    }
}
