//! Touches of many samples at once, for simulation, learning and replay.

use core::any::Any;

use fingertip_contact::ContactModel;
use fingertip_friction::{SlipMargin, SlipVerdict};
use fingertip_surfaces::{Capsule, Cylinder, Ellipsoid, Plane, Sphere};
use fingertip_wrench::{Compensation, ContactForce, Real, Wrench, WrenchSolver};
use nalgebra::{SVector, Vector3};

use crate::columns::Vectorised;
use crate::{AnyTouch, Fingertip, GripStage, SlipStage, Step};

/// Where the touches are written: one slice per component.
///
/// ```
/// use fingertip::Touches;
/// use fingertip::prelude::*;
/// use nalgebra::Matrix6;
///
/// // Six gauges that give the components of the wrench themselves.
/// let sensor = SensorMatrix::new(Matrix6::identity(), Vector6::repeat(1.0))?;
/// let mut tip = Fingertip::builder()
///     .solver(GaussianElimination::new(&sensor)?)
///     .contact(Sphere::centred(13e-3)?, PointContact::new(0.1)?)
///     .friction(Coulomb::new(0.5)?)
///     .build();
///
/// // Three samples: 2 N on the top of a ball, dragged along x with more and more force.
/// let (none, drag) = ([0.0; 3], [0.0, 0.5, 1.5]);
/// let torque = drag.map(|force| 13e-3 * force);
/// let raw = [&drag[..], &none, &[-2.0; 3], &none, &torque, &none];
/// let [mut x, mut y, mut z, mut normal, mut fx, mut fy, mut fz, mut margin, mut used] = [[0.0; 3]; 9];
/// let mut slip = [SlipVerdict::NotPressing; 3];
/// let touches = Touches {
///     point: [&mut x, &mut y, &mut z],
///     normal_force: &mut normal,
///     tangential_force: [&mut fx, &mut fy, &mut fz],
///     margin: &mut margin,
///     utilisation: &mut used,
///     slip: &mut slip,
/// };
/// tip.sense_all(raw, 1e-3, touches);
/// // Friction holds 0.5 times 2 N.
/// assert!((used[1] - 0.5_f64).abs() < 1e-12 && (used[2] - 1.5).abs() < 1e-12);
/// assert!(margin[1] > 0.0 && margin[2] < 0.0);
/// # Ok::<(), Error>(())
/// ```
#[derive(Debug)]
pub struct Touches<'a, T> {
    /// Where the environment touches \[m\]; zero without contact.
    pub point: [&'a mut [T]; 3],
    /// Normal force \[N\]: positive in contact, zero without; zero, too, where a line that misses is
    /// [accepted](fingertip_contact::PointContact::with_greatest_gap).
    pub normal_force: &'a mut [T],
    /// Tangential force on the fingertip \[N\].
    pub tangential_force: [&'a mut [T]; 3],
    /// Signed distance to the friction limit \[N\]; zero without contact or friction model.
    pub margin: &'a mut [T],
    /// How much of the friction limit is used; zero without contact or friction model.
    pub utilisation: &'a mut [T],
    /// What the detector says; [`SlipVerdict::NotPressing`] without one.
    pub slip: &'a mut [SlipVerdict],
}

impl<T> Touches<'_, T> {
    /// How many samples there is room for.
    #[must_use]
    pub fn len(&self) -> usize {
        let columns = self.point.iter().chain(&self.tangential_force).map(|column| column.len());
        let rest = [self.normal_force.len(), self.margin.len(), self.utilisation.len(), self.slip.len()];
        columns.chain(rest).min().unwrap_or(0)
    }

    /// Whether there is room for none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The same columns, to be written and then written on.
    #[must_use]
    pub fn by_ref(&mut self) -> Touches<'_, T> {
        Touches {
            point: self.point.each_mut().map(|column| &mut **column),
            normal_force: self.normal_force,
            tangential_force: self.tangential_force.each_mut().map(|column| &mut **column),
            margin: self.margin,
            utilisation: self.utilisation,
            slip: self.slip,
        }
    }
}

impl<T: Real> Touches<'_, T> {
    /// Writes one sample; an index beyond the columns writes nothing.
    pub fn put(&mut self, index: usize, touch: &AnyTouch<T>) {
        self.put_parts(index, touch.point(), touch.force.as_ref(), touch.grip.flatten(), touch.slip);
    }

    /// The same of a touch in parts: where, the force, the margin and the verdict.
    #[doc(hidden)]
    pub fn put_parts(
        &mut self,
        index: usize,
        point: Option<Vector3<T>>,
        force: Option<&ContactForce<T>>,
        margin: Option<SlipMargin<T>>,
        slip: Option<SlipVerdict>,
    ) {
        fn write<A>(column: &mut [A], index: usize, value: A) {
            if let Some(place) = column.get_mut(index) {
                *place = value;
            }
        }
        let at = point.unwrap_or_else(Vector3::zeros);
        let (normal, tangential) = match force {
            Some(force) => (force.normal, force.tangential.vector()),
            None => (T::zero(), Vector3::zeros()),
        };
        for axis in 0..3 {
            write(self.point[axis], index, at[axis]);
            write(self.tangential_force[axis], index, tangential[axis]);
        }
        write(self.normal_force, index, normal);
        let none = SlipMargin { newtons: T::zero(), utilisation: T::zero() };
        let SlipMargin { newtons, utilisation } = margin.unwrap_or(none);
        write(self.margin, index, newtons);
        write(self.utilisation, index, utilisation);
        write(self.slip, index, slip.unwrap_or(SlipVerdict::NotPressing));
    }
}

impl<Solver, Surface, Model, Friction, Detector, Zero, Payload>
    Fingertip<Solver, Surface, Model, Friction, Detector, Zero, Payload>
{
    /// [`sense`](Self::sense) of many samples, one after the other in time: `raw` has a column for each gauge,
    /// and each sample's last contact is that of the sample before. Of columns of different lengths, the
    /// shortest counts; the rest is left as it was.
    ///
    /// Any scene can. A point contact on a sphere, ellipsoid, cylinder, capsule or plane with Coulomb friction
    /// and a ratio threshold is one loop without a branch that the compiler vectorises, with the widest vectors
    /// of the processor at hand if the feature `simd` is on; nothing is allocated. The answers are those of
    /// `sense`, but for three things. Rounding at a flat angle of incidence is not undone, and errors of the
    /// point grow there as the reciprocal cosine. Why there is no contact is not said. And the side of a
    /// cylinder is unbounded.
    pub fn sense_all<T, const N: usize>(&mut self, raw: [&[T]; N], time_step: T, touches: Touches<'_, T>)
    where
        T: Real,
        Zero: Compensation<SVector<T, N>, Raw = SVector<T, N>> + 'static,
        Solver: WrenchSolver<T, N> + 'static,
        Payload: Compensation<Wrench<T>, Raw = (Wrench<T>, ())> + 'static,
        Surface: 'static,
        Model: ContactModel<T, Surface> + 'static,
        Friction: GripStage<T> + 'static,
        Detector: SlipStage<T> + 'static,
    {
        // The types are known when this is compiled, and so one of these is left, or none.
        macro_rules! vectorised {
            ($($shape:ident),+) => {
                $(if let Some(scene) = (self as &dyn Any).downcast_ref::<Vectorised<T, $shape<T>, Solver, Zero, Payload>>() {
                    return scene.in_columns(raw, touches);
                })+
            };
        }
        vectorised!(Sphere, Ellipsoid, Cylinder, Capsule, Plane);
        self.one_by_one(raw, time_step, touches);
    }

    fn one_by_one<T, const N: usize>(&mut self, raw: [&[T]; N], time_step: T, mut touches: Touches<'_, T>)
    where
        T: Real,
        Zero: Compensation<SVector<T, N>, Raw = SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
        Payload: Compensation<Wrench<T>, Raw = (Wrench<T>, ())>,
        Model: ContactModel<T, Surface>,
        Friction: GripStage<T>,
        Detector: SlipStage<T>,
    {
        let count = raw.iter().map(|column| column.len()).fold(touches.len(), usize::min);
        let mut last = None;
        #[allow(clippy::needless_range_loop, reason = "of columns that are as many as there are gauges")]
        for k in 0..count {
            let sample = SVector::from_fn(|gauge, _| raw[gauge][k]);
            let touch = self.sense(&sample, Step::of(time_step).with_last(last)).any::<Friction, Detector>();
            last = touch.point();
            touches.put(k, &touch);
        }
    }
}
