//! Touches of many samples at once, for simulation, learning and replay.

use fingertip_friction::{Coulomb, RatioThreshold, SlipVerdict};
use fingertip_surfaces::PointContact;
use fingertip_surfaces::batch::{BatchSurface, Contacts, Wrenches};
use fingertip_wrench::{Compensation, Real, WrenchSolver};
use nalgebra::SVector;

use crate::{Fingertip, Present};

/// Where the touches are written: one slice per component.
#[derive(Debug)]
pub struct Touches<'a, T> {
    /// Where the environment touches \[m\]; zero without contact.
    pub point: [&'a mut [T]; 3],
    /// Normal force \[N\]: positive in contact, zero without.
    pub normal_force: &'a mut [T],
    /// Tangential force on the fingertip \[N\].
    pub tangential_force: [&'a mut [T]; 3],
    /// Signed distance to the friction limit \[N\].
    pub margin: &'a mut [T],
    /// How much of the friction limit is used.
    pub utilisation: &'a mut [T],
    /// What the detector says.
    pub slip: &'a mut [SlipVerdict],
}

impl<T> Touches<'_, T> {
    fn len(&self) -> usize {
        let columns = self.point.iter().chain(&self.tangential_force).map(|column| column.len());
        let rest = [self.normal_force.len(), self.margin.len(), self.utilisation.len(), self.slip.len()];
        columns.chain(rest).min().unwrap_or(0)
    }
}

/// So many samples go through one stage before the next takes them: what they need in between stays in
/// the nearest cache.
const BLOCK: usize = 256;

/// A little longer, lest columns lie a power of two apart and fight for the same lines of the cache.
const COLUMN: usize = BLOCK + 16;

/// What is known between the stages, of a block of samples. It begins with a line of the cache, lest
/// every vector lies across two.
#[repr(align(64))]
struct Between<T> {
    wrench: [[T; COLUMN]; 6],
    normal: [[T; COLUMN]; 3],
    gap: [T; COLUMN],
    tangential: [T; COLUMN],
}

impl<Solver, Surface, T, Zero>
    Fingertip<Solver, Surface, PointContact<T>, Present<Coulomb<T>>, Present<RatioThreshold<T>>, Zero>
where
    T: Real,
{
    /// [`sense`](Self::sense) of many samples: `raw` has a column for each gauge. Of columns of
    /// different lengths, the shortest counts; the rest is left as it was.
    ///
    /// Each stage is a loop without a branch that the compiler vectorises, with the widest vectors of
    /// the processor at hand if the feature `simd` is on; nothing is allocated. The answers are those of
    /// `sense`, but for three things. Rounding at a flat angle of incidence is not undone, and errors of
    /// the point grow there as the reciprocal cosine. Why there is no contact is not said. And of a
    /// [`BatchSurface`] whose ends are not looked at, the side is unbounded.
    pub fn sense_all<const N: usize>(&self, raw: [&[T]; N], touches: Touches<'_, T>)
    where
        Zero: Compensation<T, N, Raw = SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
        Surface: BatchSurface<T>,
    {
        #[cfg(feature = "simd")]
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || self.sweep(raw, touches),
        );
        #[cfg(not(feature = "simd"))]
        self.sweep(raw, touches);
    }

    #[inline(always)]
    fn sweep<const N: usize>(&self, raw: [&[T]; N], touches: Touches<'_, T>)
    where
        Zero: Compensation<T, N, Raw = SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
        Surface: BatchSurface<T>,
    {
        let count = raw.iter().map(|column| column.len()).fold(touches.len(), usize::min);
        let mut between = Between {
            wrench: [[T::zero(); COLUMN]; 6],
            normal: [[T::zero(); COLUMN]; 3],
            gap: [T::zero(); COLUMN],
            tangential: [T::zero(); COLUMN],
        };
        let Touches { mut point, normal_force, mut tangential_force, margin, utilisation, slip } = touches;
        let mut start = 0;
        while start < count {
            let block = start..count.min(start + BLOCK);
            start = block.end;
            self.block(
                raw.map(|column| &column[block.clone()]),
                Touches {
                    point: point.each_mut().map(|column| &mut column[block.clone()]),
                    normal_force: &mut normal_force[block.clone()],
                    tangential_force: tangential_force.each_mut().map(|column| &mut column[block.clone()]),
                    margin: &mut margin[block.clone()],
                    utilisation: &mut utilisation[block.clone()],
                    slip: &mut slip[block],
                },
                &mut between,
            );
        }
    }

    /// The first two stages. Columns that are arguments of their own are known not to overlap, which the
    /// compiler would have to test otherwise, and would rather not vectorise.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn wrenches<const N: usize>(
        &self,
        raw: [&[T]; N],
        fx: &mut [T],
        fy: &mut [T],
        fz: &mut [T],
        tx: &mut [T],
        ty: &mut [T],
        tz: &mut [T],
    ) where
        Zero: Compensation<T, N, Raw = SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
    {
        let count = fx.len();
        let raw = raw.map(|column| &column[..count]);
        let (fy, fz) = (&mut fy[..count], &mut fz[..count]);
        let (tx, ty, tz) = (&mut tx[..count], &mut ty[..count], &mut tz[..count]);
        for k in 0..count {
            let signals = self.zero.compensate(&SVector::from_fn(|gauge, _| raw[gauge][k]));
            let wrench = self.solver.solve(&signals);
            let (force, torque) = (wrench.force(), wrench.torque());
            (fx[k], fy[k], fz[k]) = (force.x, force.y, force.z);
            (tx[k], ty[k], tz[k]) = (torque.x, torque.y, torque.z);
        }
    }

    /// All stages of at most [`BLOCK`] samples; every column of `raw` and `touches` has as many.
    #[inline(always)]
    fn block<const N: usize>(&self, raw: [&[T]; N], touches: Touches<'_, T>, between: &mut Between<T>)
    where
        Zero: Compensation<T, N, Raw = SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
        Surface: BatchSurface<T>,
    {
        let Touches { point, normal_force, tangential_force, margin, utilisation, slip } = touches;
        let count = normal_force.len().min(BLOCK);
        let raw = raw.map(|column| &column[..count]);
        let [fx, fy, fz, tx, ty, tz] = between.wrench.each_mut().map(|column| &mut column[..count]);
        self.wrenches(raw, fx, fy, fz, tx, ty, tz);
        let force: [&[T]; 3] = [fx, fy, fz];
        let [px, py, pz] = point.map(|column| &mut column[..count]);
        let [nx, ny, nz] = between.normal.each_mut().map(|column| &mut column[..count]);
        let gap = &mut between.gap[..count];
        self.surface.contacts_in_line(
            Wrenches { force, torque: [tx, ty, tz] },
            Contacts { point: [px, py, pz], normal: [nx, ny, nz], gap },
        );
        let [sx, sy, sz] = tangential_force;
        let normal: [&[T]; 3] = [nx, ny, nz];
        let accepted = Accepted::by(&self.model);
        let all =
            self.all_press(accepted, force, normal, gap, sx, sy, sz, normal_force, margin, utilisation, slip);
        if !all {
            let tangential = &mut between.tangential[..count];
            accepted.split(force, normal, gap, px, py, pz, sx, sy, sz, normal_force, tangential);
            self.friction.0.slip_margins(normal_force, tangential, margin, utilisation);
            self.detector.0.verdicts(normal_force, tangential, slip);
        }
    }

    /// The last stages of samples that all are contacts: `false` if one is not, and then what is written
    /// means nothing. The same operations as in the general loops, without the choices.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn all_press(
        &self,
        accepted: Accepted<T>,
        force: [&[T]; 3],
        normal: [&[T]; 3],
        gap: &[T],
        sx: &mut [T],
        sy: &mut [T],
        sz: &mut [T],
        pressing: &mut [T],
        margin: &mut [T],
        utilisation: &mut [T],
        slip: &mut [SlipVerdict],
    ) -> bool {
        let count = pressing.len();
        let ([fx, fy, fz], [nx, ny, nz]) =
            (force.map(|column| &column[..count]), normal.map(|column| &column[..count]));
        let (sx, sy, sz) = (&mut sx[..count], &mut sy[..count], &mut sz[..count]);
        let (gap, slip) = (&gap[..count], &mut slip[..count]);
        let (margin, utilisation) = (&mut margin[..count], &mut utilisation[..count]);
        let mut all = true;
        for k in 0..count {
            let (f, n) = ([fx[k], fy[k], fz[k]], [nx[k], ny[k], nz[k]]);
            let (squared, along) = (dot(f, f), dot(f, n));
            all &= accepted.touches(squared, along, gap[k]) & (squared <= T::GREATEST);
            let [x, y, z] = [f[0] - n[0] * along, f[1] - n[1] * along, f[2] - n[2] * along];
            let load = dot([x, y, z], [x, y, z]).root();
            (sx[k], sy[k], sz[k], pressing[k]) = (x, y, z, -along);
            let (newtons, used, ordinary) = self.friction.0.margin_in_contact(-along, load);
            (margin[k], utilisation[k]) = (newtons, used);
            all &= ordinary;
            slip[k] = self.detector.0.verdict_of(-along, load);
        }
        all
    }
}

/// What a point contact asks of a wrench before it believes the contact.
#[derive(Clone, Copy)]
struct Accepted<T> {
    least_squared: T,
    greatest_gap: T,
    /// The square of the least cosine of incidence.
    least_steepness: T,
}

impl<T: Real> Accepted<T> {
    fn by(model: &PointContact<T>) -> Self {
        let steepness = |mu: T| T::one() / (T::one() + mu * mu);
        Self {
            least_squared: model.least_force() * model.least_force(),
            greatest_gap: model.greatest_gap(),
            least_steepness: model.greatest_friction().map_or(T::zero(), steepness),
        }
    }

    /// Whether it is a contact: square of the force, its part along the normal, and the gap.
    #[inline(always)]
    fn touches(&self, squared: T, along: T, gap: T) -> bool {
        (squared >= self.least_squared)
            & (gap <= self.greatest_gap)
            & (along < T::zero())
            & (along * along >= self.least_steepness * squared)
    }

    /// Splits the forces at the tangent planes; takes back the points that are no contact.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn split(
        &self,
        force: [&[T]; 3],
        normal: [&[T]; 3],
        gap: &[T],
        px: &mut [T],
        py: &mut [T],
        pz: &mut [T],
        sx: &mut [T],
        sy: &mut [T],
        sz: &mut [T],
        pressing: &mut [T],
        tangential: &mut [T],
    ) {
        let count = tangential.len();
        let ([fx, fy, fz], [nx, ny, nz]) =
            (force.map(|column| &column[..count]), normal.map(|column| &column[..count]));
        let (px, py, pz) = (&mut px[..count], &mut py[..count], &mut pz[..count]);
        let (sx, sy, sz) = (&mut sx[..count], &mut sy[..count], &mut sz[..count]);
        let (gap, pressing) = (&gap[..count], &mut pressing[..count]);
        for k in 0..count {
            // Without what is no number, of which nothing times zero makes one.
            let f = [fx[k], fy[k], fz[k]].map(|x| if x.abs() <= T::GREATEST { x } else { T::zero() });
            let n = [nx[k], ny[k], nz[k]];
            let (squared, along) = (dot(f, f), dot(f, n));
            // A factor, since the compiler makes branches of eight choices by one condition.
            let keep = if self.touches(squared, along, gap[k]) { T::one() } else { T::zero() };
            let [x, y, z] =
                [(f[0] - n[0] * along) * keep, (f[1] - n[1] * along) * keep, (f[2] - n[2] * along) * keep];
            (px[k], py[k], pz[k]) = (px[k] * keep, py[k] * keep, pz[k] * keep);
            (sx[k], sy[k], sz[k]) = (x, y, z);
            pressing[k] = -along * keep;
            tangential[k] = dot([x, y, z], [x, y, z]).root();
        }
    }
}

#[inline(always)]
fn dot<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> T {
    a * x + b * y + c * z
}
