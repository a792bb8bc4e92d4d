//! Touches of many samples at once, for simulation, learning and replay.

use fingertip::contact::batch::{SoftContacts, Wrenches};
use fingertip::surfaces::DynSurface;
use fingertip::wrench::{ContactForce, Real, Wrench, WrenchSolver};
use fingertip::{Fingertip, GripStage, SlipStage, Touches};
use nalgebra::{Vector3, Vector6};

use crate::friction::{Friction, Limit};
use crate::model::Model;
use crate::pipeline::Pipeline;
use crate::slip::{Detector, SlipWatch};

/// A sensor that reports wrenches: its signals are their components.
#[derive(Clone, Copy, Debug)]
struct Reported;

impl<T: Real> WrenchSolver<T, 6> for Reported {
    #[inline(always)]
    fn solve(&self, signals: &Vector6<T>) -> Wrench<T> {
        Wrench::from_components(signals)
    }
}

impl<T: Real> Pipeline<T> {
    /// [`sense`](Self::sense) of many wrenches, one after the other in time: `wrenches` has a column for each
    /// component, forces first. Of columns of different lengths, the shortest counts; the rest is left as it was. What
    /// the last sample says stays, as behind `sense`.
    ///
    /// Any scene can. A point contact on a sphere, an ellipsoid, a cylinder without ends, a capsule or a plane, with
    /// Coulomb friction and the threshold detector and without filter, is one loop that the compiler vectorises: see
    /// [`Fingertip::sense_all`] for what its answers then leave out, next to that from those of `sense`. Of soft fingers on
    /// shapes with a closed form, with any friction limit and with the threshold detector or none, the contacts are found in
    /// such a loop ([`SoftFinger::resolve_all`](fingertip::contact::SoftFinger::resolve_all)), each to the bit that of `sense`.
    ///
    /// ```
    /// use fingertip::Touches;
    /// use fingertip::friction::SlipVerdict;
    /// use fingertip_scene::Scene;
    ///
    /// let scene = Scene::from_text(
    ///     "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n",
    /// )?;
    /// let down = [vec![0.0; 3], vec![0.0; 3], vec![-1.0, 0.0, -2.0], vec![0.0; 3], vec![0.0; 3], vec![0.0; 3]];
    /// let mut columns = vec![vec![0.0; 3]; 9];
    /// let mut slip = [SlipVerdict::Holding; 3];
    /// let [x, y, z, normal, sx, sy, sz, margin, used] = &mut columns[..] else { unreachable!() };
    /// let touches = Touches {
    ///     point: [x, y, z],
    ///     normal_force: normal,
    ///     tangential_force: [sx, sy, sz],
    ///     margin,
    ///     utilisation: used,
    ///     slip: &mut slip,
    /// };
    /// scene.pipeline().sense_all(down.each_ref().map(|column| &column[..]), 1e-3, touches);
    /// assert_eq!(columns[3], [1.0, 0.0, 2.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sense_all(&mut self, wrenches: [&[T]; 6], time_step: T, mut touches: Touches<'_, T>) {
        let count = wrenches.iter().map(|column| column.len()).fold(touches.len(), usize::min);
        let at = |index: usize| {
            Wrench::from_components(&Vector6::from_fn(|axis, _| {
                wrenches[axis].get(index).copied().unwrap_or_else(T::zero)
            }))
        };
        if self.in_vectors(wrenches, time_step, touches.by_ref())
            || self.by_soft_contacts(wrenches, time_step, touches.by_ref(), count)
        {
            // The last one again, for what stays.
            if let Some(last) = count.checked_sub(1) {
                self.sense(at(last), time_step);
            }
            return;
        }
        for index in 0..count {
            touches.put(index, &self.sense(at(index), time_step).touch);
        }
    }

    /// The samples as one loop, if the scene has stages without branches: `false`, and nothing done, if not.
    fn in_vectors(&self, wrenches: [&[T]; 6], time_step: T, touches: Touches<'_, T>) -> bool {
        let (Model::Point(model), None) = (self.model(), self.filter()) else { return false };
        let (Some(Limit::Coulomb(friction)), Some(Detector::Threshold(detector))) =
            (self.limit(), self.detector())
        else {
            return false;
        };
        macro_rules! vectors {
            ($shape:expr) => {{
                let tip = Fingertip::builder().solver(Reported).contact(*$shape, *model);
                tip.friction(*friction)
                    .slip_detector(*detector)
                    .build()
                    .sense_all(wrenches, time_step, touches);
                true
            }};
        }
        match self.surface() {
            DynSurface::Sphere(cap) if cap.active_fraction() >= T::one() => vectors!(cap.sphere()),
            DynSurface::Cylinder(cylinder) if cylinder.half_length().is_none() => vectors!(cylinder),
            DynSurface::Ellipsoid(ellipsoid) => vectors!(ellipsoid),
            DynSurface::Capsule(capsule) => vectors!(capsule),
            DynSurface::Plane(plane) => vectors!(plane),
            _ => false,
        }
    }

    /// Soft fingers, whose contacts are found in columns, block by block, and then judged one by one: `false`, and nothing
    /// done, if the scene has more to say of them, or a shape without a closed form.
    fn by_soft_contacts(
        &self,
        wrenches: [&[T]; 6],
        time_step: T,
        touches: Touches<'_, T>,
        count: usize,
    ) -> bool {
        let (Model::SoftFinger(model), None, false) = (self.model(), self.filter(), self.has_more()) else {
            return false;
        };
        let (None | Some(Detector::Threshold(_))) = self.detector() else { return false };
        let (friction, slip) = (Friction(self.limit().cloned()), SlipWatch(self.detector().cloned()));
        let mut judged = Judged { friction, slip, time_step, touches, count };
        macro_rules! columns {
            ($shape:expr) => {{
                judged.block_by_block(wrenches, |given, found| model.resolve_all($shape, given, found));
                true
            }};
        }
        match self.surface() {
            DynSurface::Sphere(cap) if cap.active_fraction() >= T::one() => columns!(&cap.sphere()),
            DynSurface::Cylinder(shape) => columns!(shape),
            DynSurface::Ellipsoid(shape) => columns!(shape),
            DynSurface::Capsule(shape) => columns!(shape),
            DynSurface::Plane(shape) => columns!(shape),
            DynSurface::Cone(shape) => columns!(shape),
            DynSurface::Frustum(shape) => columns!(shape),
            DynSurface::CappedCylinder(shape) => columns!(shape),
            DynSurface::EllipticCylinder(shape) => columns!(shape),
            DynSurface::Paraboloid(shape) => columns!(shape),
            _ => false,
        }
    }
}

/// How many contacts are found together.
const BLOCK: usize = 256;

/// What is made of contacts in columns.
struct Judged<'a, T: Real> {
    friction: Friction<T>,
    slip: SlipWatch<T>,
    time_step: T,
    touches: Touches<'a, T>,
    count: usize,
}

impl<T: Real> Judged<'_, T> {
    fn block_by_block(&mut self, all: [&[T]; 6], resolve: impl Fn(Wrenches<'_, T>, SoftContacts<'_, T>)) {
        let mut columns = [[T::zero(); BLOCK]; 7];
        let mut start = 0;
        while start < self.count {
            let block = start..self.count.min(start + BLOCK);
            let [fx, fy, fz, tx, ty, tz] = all.map(|column| column.get(block.clone()).unwrap_or_default());
            let [x, y, z, nx, ny, nz, spin_torque] = columns.each_mut().map(|column| &mut column[..]);
            resolve(
                Wrenches { force: [fx, fy, fz], torque: [tx, ty, tz] },
                SoftContacts { point: [x, y, z], normal: [nx, ny, nz], spin_torque },
            );
            let [x, y, z, nx, ny, nz, spins] = &columns;
            let points = x.iter().zip(y).zip(z).map(|((x, y), z)| Vector3::new(*x, *y, *z));
            let normals = nx.iter().zip(ny).zip(nz).map(|((x, y), z)| Vector3::new(*x, *y, *z));
            let forces = fx.iter().zip(fy).zip(fz).map(|((x, y), z)| Vector3::new(*x, *y, *z));
            let found = points.zip(normals).zip(spins.iter().zip(forces));
            for (index, ((point, normal), (spin, force))) in block.clone().zip(found) {
                let is_contact = normal != Vector3::zeros();
                let contact = is_contact.then(|| (point, ContactForce::split(&force, &normal, *spin)));
                self.put(index, contact.as_ref());
            }
            start = block.end;
        }
    }

    fn put(&mut self, index: usize, contact: Option<&(Vector3<T>, ContactForce<T>)>) {
        let force = contact.map(|(_, force)| force);
        let margin = force.and_then(|force| self.friction.judge(force));
        let slip = self.slip.follow(force, self.time_step);
        self.touches.put_parts(index, contact.map(|(point, _)| *point), force, margin, slip);
    }
}
