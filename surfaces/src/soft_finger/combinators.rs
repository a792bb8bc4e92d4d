//! Shapes made of shapes.

use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix3, Vector3};

use crate::{
    Extent, Level, Posed, Region, Search, SmoothSurface, SoftContact, SoftFingerSurface, Topology, Trimmed,
};

impl<T: Real, S: SmoothSurface<T>> SmoothSurface<T> for Posed<T, S> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let pose = self.sensor_from_shape();
        let rotation = pose.rotation();
        let level = self.inner().level(&rotation.tr_mul(&(point - pose.origin())));
        Level {
            value: level.value,
            gradient: rotation * level.gradient,
            hessian: rotation * level.hessian * rotation.transpose(),
        }
    }

    fn extent(&self) -> Extent<T> {
        let extent = self.inner().extent();
        Extent { centre: self.sensor_from_shape().transform_point(&extent.centre), ..extent }
    }

    fn topology(&self) -> Topology {
        self.inner().topology()
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let pose = self.sensor_from_shape();
        let rotation = pose.rotation();
        rotation
            * self.inner().shape_operator(&rotation.tr_mul(&(point - pose.origin())))
            * rotation.transpose()
    }
}

impl<T: Real, S: SoftFingerSurface<T>> SoftFingerSurface<T> for Posed<T, S> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let pose = self.sensor_from_shape();
        let (rotation, origin) = (pose.rotation(), pose.origin());
        let inside = Wrench::on_fingertip(
            rotation.tr_mul(&wrench.force()),
            rotation.tr_mul(&wrench.torque_about(&origin)),
        );
        let last = last.map(|last| rotation.tr_mul(&(last - origin)));
        let search = self.inner().soft_contacts(&inside, last.as_ref(), |contact| {
            visit(SoftContact {
                point: rotation * contact.point + origin,
                normal: rotation * contact.normal,
                ..contact
            });
        });
        match search {
            Search::Grazing(pair) => Search::Grazing(pair.map(|point| rotation * point + origin)),
            other => other,
        }
    }
}

impl<T: Real, S: SmoothSurface<T>, R: Region<T>> SmoothSurface<T> for Trimmed<S, R> {
    #[inline]
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.inner().level(point)
    }

    fn extent(&self) -> Extent<T> {
        self.inner().extent()
    }

    fn topology(&self) -> Topology {
        self.inner().topology()
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        self.inner().shape_operator(point)
    }
}

impl<T: Real, S: SoftFingerSurface<T>, R: Region<T>> SoftFingerSurface<T> for Trimmed<S, R> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        self.inner().soft_contacts(wrench, last, |contact| {
            visit(SoftContact {
                active: contact.active && self.region().includes(&contact.point),
                ..contact
            });
        })
    }
}
