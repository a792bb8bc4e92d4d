//! The stages that are one loop without a branch, over columns.

use fingertip_contact::PointContact;
use fingertip_contact::batch::{BatchSurface, Entered, Lines};
use fingertip_friction::{Coulomb, RatioThreshold, SlipVerdict};
use fingertip_surfaces::ForceParts;
use fingertip_wrench::{Compensation, Real, Wrench, WrenchSolver};
use nalgebra::SVector;

use crate::{Fingertip, Present, Touches};

/// How many samples are taken together: if one of them is no contact, all of them are done again, by the
/// loop that expects any sample.
const BLOCK: usize = 256;

/// At least as many samples as the widest vectors hold.
const VECTOR: usize = 16;

/// A scene whose stages have no branch and remember nothing.
pub(crate) type Vectorised<T, Surface, Solver, Zero, Payload> = Fingertip<
    Solver,
    Surface,
    PointContact<T>,
    Present<Coulomb<T>>,
    Present<RatioThreshold<T>>,
    Zero,
    Payload,
>;

impl<T, Surface, Solver, Zero, Payload> Vectorised<T, Surface, Solver, Zero, Payload>
where
    T: Real,
    Payload: Compensation<Wrench<T>, Raw = (Wrench<T>, ())>,
    Surface: BatchSurface<T>,
{
    /// All samples, with the widest vectors of the processor at hand if the feature `simd` is on.
    pub(crate) fn in_columns<const N: usize>(&self, raw: [&[T]; N], touches: Touches<'_, T>)
    where
        Zero: Compensation<SVector<T, N>, Raw = SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
    {
        #[cfg(feature = "simd")]
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || self.in_blocks(raw, touches),
        );
        #[cfg(not(feature = "simd"))]
        self.in_blocks(raw, touches);
    }

    #[inline(always)]
    fn in_blocks<const N: usize>(&self, raw: [&[T]; N], touches: Touches<'_, T>)
    where
        Zero: Compensation<SVector<T, N>, Raw = SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
    {
        let count = raw.iter().map(|column| column.len()).fold(touches.len(), usize::min);
        let Touches { mut point, normal_force, mut tangential_force, margin, utilisation, slip } = touches;
        let (mut start, mut all_press) = (0, true);
        while start < count {
            let end = count.min(start + BLOCK);
            // Whole vectors: a few samples of the block before are done twice, which costs less than the
            // rest of a vector would one by one.
            let block = end.saturating_sub((end - start).next_multiple_of(VECTOR))..end;
            start = end;
            all_press = self.block(
                all_press,
                raw.map(|column| &column[block.clone()]),
                Touches {
                    point: point.each_mut().map(|column| &mut column[block.clone()]),
                    normal_force: &mut normal_force[block.clone()],
                    tangential_force: tangential_force.each_mut().map(|column| &mut column[block.clone()]),
                    margin: &mut margin[block.clone()],
                    utilisation: &mut utilisation[block.clone()],
                    slip: &mut slip[block],
                },
            );
        }
    }

    /// At most [`BLOCK`] samples, every column of `raw` and `touches` having as many, and whether they are
    /// all contacts: what is tried first with the next.
    #[inline(always)]
    fn block<const N: usize>(&self, all_press: bool, raw: [&[T]; N], touches: Touches<'_, T>) -> bool
    where
        Zero: Compensation<SVector<T, N>, Raw = SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
    {
        let Touches { point, normal_force, tangential_force, margin, utilisation, slip } = touches;
        let ([px, py, pz], [sx, sy, sz]) = (point, tangential_force);
        // `at_origin` is a constant in each call, so that the loop does not ask it for every sample.
        macro_rules! sweep {
            ($which:ident $(, $at_origin:expr)?) => {
                self.$which(
                    raw, px, py, pz, sx, sy, sz, normal_force, margin, utilisation, slip $(, $at_origin)?
                )
            };
        }
        if all_press {
            let at_origin = self.surface.is_at_origin();
            let pressed = if at_origin { sweep!(all_press, true) } else { sweep!(all_press, false) };
            if pressed {
                return true;
            }
        }
        sweep!(any);
        normal_force.iter().fold(true, |all, &normal| all & (normal > T::zero()))
    }

    /// Samples that all are contacts: `false` if one may not be, and then what is written means nothing.
    /// The same operations as of any samples, without the choices.
    ///
    /// Columns that are arguments of their own are known not to overlap, which the compiler would have to
    /// test otherwise, and would rather not vectorise.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn all_press<const N: usize>(
        &self,
        raw: [&[T]; N],
        px: &mut [T],
        py: &mut [T],
        pz: &mut [T],
        sx: &mut [T],
        sy: &mut [T],
        sz: &mut [T],
        pressing: &mut [T],
        margin: &mut [T],
        utilisation: &mut [T],
        slip: &mut [SlipVerdict],
        at_origin: bool,
    ) -> bool
    where
        Zero: Compensation<SVector<T, N>, Raw = SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
    {
        let accepted = Accepted::by(&self.model);
        let count = pressing.len();
        // Slices of one known length let the compiler drop every bounds check from the loop.
        let raw = raw.map(|column| &column[..count]);
        let (px, py, pz) = (&mut px[..count], &mut py[..count], &mut pz[..count]);
        let (sx, sy, sz) = (&mut sx[..count], &mut sy[..count], &mut sz[..count]);
        let (margin, utilisation, slip) =
            (&mut margin[..count], &mut utilisation[..count], &mut slip[..count]);
        let mut all = true;
        for k in 0..count {
            let signals = self.zero.compensate(&SVector::from_fn(|gauge, _| raw[gauge][k]));
            let wrench = self.payload.compensate(&(self.solver.solve(&signals), ()));
            let (f, torque): ([T; 3], [T; 3]) = (wrench.force().into(), wrench.torque().into());
            let Entered { point, normal: n, parts, certain, .. } =
                self.surface.enter(f, torque, Lines::Meeting, at_origin);
            let ForceParts { normal, tangential: load } = parts;
            all &= certain & accepted.touches(dot(f, f), parts, T::zero());
            [px[k], py[k], pz[k]] = point;
            [sx[k], sy[k], sz[k]] = [f[0] + n[0] * normal, f[1] + n[1] * normal, f[2] + n[2] * normal];
            let (newtons, used, ordinary) = self.friction.0.margin_in_contact(normal, load);
            (pressing[k], margin[k], utilisation[k]) = (normal, newtons, used);
            all &= ordinary;
            slip[k] = self.detector.0.verdict_in_contact(normal, load);
        }
        all
    }

    /// Any samples.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn any<const N: usize>(
        &self,
        raw: [&[T]; N],
        px: &mut [T],
        py: &mut [T],
        pz: &mut [T],
        sx: &mut [T],
        sy: &mut [T],
        sz: &mut [T],
        pressing: &mut [T],
        margin: &mut [T],
        utilisation: &mut [T],
        slip: &mut [SlipVerdict],
    ) where
        Zero: Compensation<SVector<T, N>, Raw = SVector<T, N>>,
        Solver: WrenchSolver<T, N>,
    {
        let accepted = Accepted::by(&self.model);
        let count = pressing.len();
        // Slices of one known length let the compiler drop every bounds check from the loop.
        let raw = raw.map(|column| &column[..count]);
        let (px, py, pz) = (&mut px[..count], &mut py[..count], &mut pz[..count]);
        let (sx, sy, sz) = (&mut sx[..count], &mut sy[..count], &mut sz[..count]);
        let (margin, utilisation, slip) =
            (&mut margin[..count], &mut utilisation[..count], &mut slip[..count]);
        for k in 0..count {
            let signals = self.zero.compensate(&SVector::from_fn(|gauge, _| raw[gauge][k]));
            let wrench = self.payload.compensate(&(self.solver.solve(&signals), ()));
            let (f, torque): ([T; 3], [T; 3]) = (wrench.force().into(), wrench.torque().into());
            let Entered { point, normal: n, parts, gap, .. } =
                self.surface.enter(f, torque, Lines::Any, false);
            let ForceParts { normal, tangential: load } = parts;
            // NaN times zero would stay NaN below.
            let f = f.map(|x| if x.abs() <= T::GREATEST { x } else { T::zero() });
            // A factor, since the compiler makes branches of eight choices by one condition.
            let keep = if accepted.touches(dot(f, f), parts, gap) { T::one() } else { T::zero() };
            // Of a line that misses, rounding gives it either sign.
            let normal = if normal > T::zero() { normal * keep } else { T::zero() };
            let load = load * keep;
            [px[k], py[k], pz[k]] = point.map(|x| x * keep);
            let along = |axis: usize| f[axis] * keep + n[axis] * normal;
            [sx[k], sy[k], sz[k]] = [along(0), along(1), along(2)];
            pressing[k] = normal;
            (margin[k], utilisation[k]) = self.friction.0.margin_of(normal, load);
            slip[k] = self.detector.0.verdict_of(normal, load);
        }
    }
}

/// What a point contact asks of a wrench before it believes the contact.
#[derive(Clone, Copy)]
struct Accepted<T> {
    least_squared: T,
    /// Zero if friction is limited: a line that misses asks for infinite friction.
    greatest_gap: T,
    greatest_ratio: T,
}

impl<T: Real> Accepted<T> {
    fn by(model: &PointContact<T>) -> Self {
        Self {
            least_squared: model.least_force() * model.least_force(),
            greatest_gap: if model.greatest_friction().is_some() { T::zero() } else { model.greatest_gap() },
            greatest_ratio: model.greatest_friction().unwrap_or(T::GREATEST),
        }
    }

    /// Whether it is a contact: square of the force, its parts, and the gap.
    #[inline(always)]
    fn touches(&self, squared: T, parts: ForceParts<T>, gap: T) -> bool {
        let enters = (gap <= T::zero())
            & (parts.normal > T::zero())
            & (parts.tangential <= self.greatest_ratio * parts.normal);
        // The greatest number is no gap: it stands for no answer.
        let misses = (gap > T::zero()) & (gap <= self.greatest_gap) & (gap < T::GREATEST);
        (squared >= self.least_squared) & (enters | misses)
    }
}

#[inline(always)]
fn dot<T: Real>([a, b, c]: [T; 3], [x, y, z]: [T; 3]) -> T {
    a * x + b * y + c * z
}
