//! The stages of a pipeline: as types for the commonest scenes, chosen call by call for all others.

use fingertip::contact::{PointContact, SoftFinger};
use fingertip::surfaces::{Cylinder, DynSurface, Ellipsoid, Plane, SphericalCap};
use fingertip::wrench::{Real, Uncompensated, Wrench};
use fingertip::{Absent, AnyTouch, Fingertip, Step};

use crate::friction::Friction;
use crate::model::Model;
use crate::slip::SlipWatch;

/// A fingertip whose friction and detector are chosen at run time.
type On<T, Surface, Assumption> =
    Fingertip<Absent, Surface, Assumption, Friction<T>, SlipWatch<T>, Uncompensated, Absent>;

macro_rules! stages {
    ($($name:ident: $shape:ident, $assumption:ident;)*) => {
        /// The typed pipeline over choices at run time: the same stages in the same order, so the same bits.
        // A pipeline is one value that stays where it is.
        #[allow(clippy::large_enum_variant)]
        #[derive(Clone, Debug, PartialEq)]
        pub(crate) enum Stages<T: Real> {
            $($name(On<T, $shape<T>, $assumption<T>>),)*
            Any(On<T, DynSurface<T>, Model<T>>),
        }

        macro_rules! each {
            ($stages:expr, $tip:ident => $call:expr) => {
                match $stages {
                    $(Stages::$name($tip) => $call,)*
                    Stages::Any($tip) => $call,
                }
            };
        }
    };
}

stages! {
    PointOnPlane: Plane, PointContact;
    PointOnSphere: SphericalCap, PointContact;
    PointOnCylinder: Cylinder, PointContact;
    PointOnEllipsoid: Ellipsoid, PointContact;
    SoftFingerOnSphere: SphericalCap, SoftFinger;
    SoftFingerOnCylinder: Cylinder, SoftFinger;
    SoftFingerOnEllipsoid: Ellipsoid, SoftFinger;
}

impl<T: Real> Stages<T> {
    pub(crate) fn new(
        surface: DynSurface<T>,
        model: Model<T>,
        friction: Friction<T>,
        slip: SlipWatch<T>,
    ) -> Self {
        macro_rules! of {
            ($name:ident, $surface:expr, $model:expr) => {
                Self::$name(
                    Fingertip::builder()
                        .contact($surface, $model)
                        .friction_stage(friction)
                        .slip_stage(slip)
                        .build(),
                )
            };
        }
        match (surface, model) {
            (DynSurface::Plane(plane), Model::Point(point)) => of!(PointOnPlane, plane, point),
            (DynSurface::Sphere(cap), Model::Point(point)) => of!(PointOnSphere, cap, point),
            (DynSurface::Cylinder(cylinder), Model::Point(point)) => of!(PointOnCylinder, cylinder, point),
            (DynSurface::Ellipsoid(ellipsoid), Model::Point(point)) => {
                of!(PointOnEllipsoid, ellipsoid, point)
            }
            (DynSurface::Sphere(cap), Model::SoftFinger(soft)) => of!(SoftFingerOnSphere, cap, soft),
            (DynSurface::Cylinder(cylinder), Model::SoftFinger(soft)) => {
                of!(SoftFingerOnCylinder, cylinder, soft)
            }
            (DynSurface::Ellipsoid(ellipsoid), Model::SoftFinger(soft)) => {
                of!(SoftFingerOnEllipsoid, ellipsoid, soft)
            }
            (surface, model) => of!(Any, surface, model),
        }
    }

    #[inline]
    pub(crate) fn sense(&mut self, wrench: Wrench<T>, step: Step<T>) -> AnyTouch<T> {
        each!(self, tip => tip.sense_wrench(wrench, step))
    }

    pub(crate) const fn friction(&self) -> &Friction<T> {
        each!(self, tip => tip.friction())
    }

    pub(crate) const fn slip(&self) -> &SlipWatch<T> {
        each!(self, tip => tip.detector())
    }

    pub(crate) const fn slip_mut(&mut self) -> &mut SlipWatch<T> {
        each!(self, tip => tip.detector_mut())
    }
}
