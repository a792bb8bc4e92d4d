//! The stages of a pipeline: as types for the commonest scenes, chosen call by call for all others.

use fingertip::contact::{ContactModel, PointContact, SoftFinger};
use fingertip::surfaces::{Capsule, Cylinder, DynSurface, Ellipsoid, Plane, SphericalCap};
use fingertip::wrench::{Real, Uncompensated, Wrench};
use fingertip::{Absent, AnyTouch, Fingertip, Step};
use nalgebra::Vector3;

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
    PointOnCapsule: Capsule, PointContact;
    SoftFingerOnSphere: SphericalCap, SoftFinger;
    SoftFingerOnCylinder: Cylinder, SoftFinger;
    SoftFingerOnEllipsoid: Ellipsoid, SoftFinger;
    SoftFingerOnCapsule: Capsule, SoftFinger;
}

/// One sample, written where it is kept, of force and torque along `x`, `y` and `z`.
///
/// A processor works on the next sample while it ends this one, unless it has to read what was just stored in other pieces,
/// or has more to store than it can hold back: either makes a sample take twice as long. So the wrench comes in registers,
/// as pairs do, its copy in the touch is left to the caller, and nothing is returned to be copied.
// Not inlined: the compiler then knows that what is written is not what is read.
#[inline(never)]
fn sense_into<T: Real, Surface, Assumption: ContactModel<T, Surface>>(
    tip: &mut On<T, Surface, Assumption>,
    (fx, tx): (T, T),
    (fy, ty): (T, T),
    (fz, tz): (T, T),
    time_step: T,
    last: &mut Option<Vector3<T>>,
    touch: &mut AnyTouch<T>,
) {
    let wrench = Wrench::on_fingertip(Vector3::new(fx, fy, fz), Vector3::new(tx, ty, tz));
    let felt = tip.sense_wrench(wrench, Step::of(time_step).with_last(*last));
    *last = felt.point();
    (touch.resolution, touch.force) = (felt.resolution, felt.force);
    (touch.grip, touch.slip) = (felt.grip, felt.slip);
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
            (DynSurface::Capsule(capsule), Model::Point(point)) => of!(PointOnCapsule, capsule, point),
            (DynSurface::Sphere(cap), Model::SoftFinger(soft)) => of!(SoftFingerOnSphere, cap, soft),
            (DynSurface::Cylinder(cylinder), Model::SoftFinger(soft)) => {
                of!(SoftFingerOnCylinder, cylinder, soft)
            }
            (DynSurface::Ellipsoid(ellipsoid), Model::SoftFinger(soft)) => {
                of!(SoftFingerOnEllipsoid, ellipsoid, soft)
            }
            (DynSurface::Capsule(capsule), Model::SoftFinger(soft)) => {
                of!(SoftFingerOnCapsule, capsule, soft)
            }
            (surface, model) => of!(Any, surface, model),
        }
    }

    /// Takes a wrench and the time since the one before, and writes what is felt, and the contact in the place of the
    /// last one.
    #[inline]
    pub(crate) fn sense(
        &mut self,
        wrench: &Wrench<T>,
        time_step: T,
        last: &mut Option<Vector3<T>>,
        touch: &mut AnyTouch<T>,
    ) {
        touch.wrench = *wrench;
        let [x, y, z] = [0, 1, 2].map(|axis| (wrench.force()[axis], wrench.torque()[axis]));
        each!(self, tip => sense_into(tip, x, y, z, time_step, last, touch));
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
