//! Touches of many samples at once, for simulation, learning and replay.

use fingertip::surfaces::DynSurface;
use fingertip::wrench::{Real, Wrench, WrenchSolver};
use fingertip::{Fingertip, Touches};
use nalgebra::Vector6;

use crate::friction::Limit;
use crate::model::Model;
use crate::pipeline::Pipeline;
use crate::slip::Detector;

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
    /// [`Fingertip::sense_all`] for what its answers then leave out, next to that from those of `sense`.
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
        if self.in_vectors(wrenches, time_step, touches.by_ref()) {
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
}
