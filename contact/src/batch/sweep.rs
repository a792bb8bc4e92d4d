//! Runs a kernel over columns.

use fingertip_surfaces::ForceParts;
use fingertip_wrench::Real;

use super::kernel::{Answer, Kernel, Push, Versions, parts_at, pick};
use super::{Contacts, Entered, Lines, Wrenches};

/// How many wrenches are taken together.
const BLOCK: usize = 64;

/// Runs a kernel over all wrenches.
#[inline(always)]
pub(crate) fn run<T: Real, K: Kernel<T>>(wrenches: Wrenches<'_, T>, contacts: Contacts<'_, T>, kernel: &K) {
    let Contacts { point: [px, py, pz], normal: [nx, ny, nz], gap } = contacts;
    let [fx, fy, fz] = wrenches.force;
    let [tx, ty, tz] = wrenches.torque;
    let (given, found) = ([fx, fy, fz, tx, ty, tz], [px, py, pz, nx, ny, nz, gap]);
    let shortest = given.iter().map(|column| column.len()).fold(usize::MAX, usize::min);
    let count = found.iter().map(|column| column.len()).fold(shortest, usize::min);
    if K::VERSIONS == Versions::One {
        let [px, py, pz, nx, ny, nz, gap] = found.map(|column| &mut column[..count]);
        sweep(given, px, py, pz, nx, ny, nz, gap, kernel, Lines::Any, false);
        return;
    }
    let [px, py, pz, nx, ny, nz, gap] = found;
    let (mut start, centred) = (0, kernel.centred());
    while start < count {
        let block = start..count.min(start + BLOCK);
        start = block.end;
        let given = given.map(|column| &column[block.clone()]);
        let (px, py, pz) = (&mut px[block.clone()], &mut py[block.clone()], &mut pz[block.clone()]);
        let (nx, ny, nz) = (&mut nx[block.clone()], &mut ny[block.clone()], &mut nz[block.clone()]);
        let gap = &mut gap[block];
        let all = if centred {
            sweep(given, px, py, pz, nx, ny, nz, gap, kernel, Lines::Meeting, true)
        } else {
            sweep(given, px, py, pz, nx, ny, nz, gap, kernel, Lines::Meeting, false)
        };
        if !all {
            sweep(given, px, py, pz, nx, ny, nz, gap, kernel, Lines::Any, false);
        }
    }
}

/// As many lines as the slices hold, which are equally long: `false` if there is no answer to one of them, and
/// then, of lines that were expected to meet, what is written means nothing.
///
/// Columns that are arguments of their own are known not to overlap, which the compiler would have to
/// test otherwise, and would rather not vectorise.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn sweep<T: Real>(
    given: [&[T]; 6],
    px: &mut [T],
    py: &mut [T],
    pz: &mut [T],
    nx: &mut [T],
    ny: &mut [T],
    nz: &mut [T],
    gap: &mut [T],
    kernel: &impl Kernel<T>,
    lines: Lines,
    at_origin: bool,
) -> bool {
    let count = gap.len();
    // Slices of one known length let the compiler drop every bounds check from the loop.
    let [fx, fy, fz, tx, ty, tz] = given.map(|column| &column[..count]);
    let (px, py, pz) = (&mut px[..count], &mut py[..count], &mut pz[..count]);
    let (nx, ny, nz) = (&mut nx[..count], &mut ny[..count], &mut nz[..count]);
    let mut all = true;
    for k in 0..count {
        let entered = enter(kernel, [fx[k], fy[k], fz[k]], [tx[k], ty[k], tz[k]], lines, at_origin);
        all &= entered.certain;
        [px[k], py[k], pz[k]] = entered.point;
        [nx[k], ny[k], nz[k]] = entered.normal;
        gap[k] = entered.gap;
    }
    all
}

/// Where one line enters, as a kernel says.
#[inline(always)]
pub(crate) fn enter<T: Real, K: Kernel<T>>(
    kernel: &K,
    force: [T; 3],
    torque: [T; 3],
    lines: Lines,
    at_origin: bool,
) -> Entered<T> {
    let (push, in_range) = Push::new(force, torque, at_origin);
    let answer = kernel.answer(push, lines);
    let parts = answer.parts.unwrap_or_else(
        #[inline(always)]
        || parts_at(force, answer.normal),
    );
    if lines == Lines::Meeting {
        let Answer { point, normal, certain, .. } = answer;
        return Entered { point, normal, parts, gap: T::zero(), certain: certain & in_range };
    }
    let certain = in_range & answer.is_finite();
    let keep = |x: T| pick(certain, x, T::zero());
    let parts = ForceParts { normal: keep(parts.normal), tangential: keep(parts.tangential) };
    let gap = pick(certain, answer.gap, T::GREATEST);
    Entered { point: answer.point.map(keep), normal: answer.normal.map(keep), parts, gap, certain }
}

/// Gives a shape that has a kernel its columns.
macro_rules! swept {
    ($shape:ident) => {
        impl<T: fingertip_wrench::Real> $crate::batch::BatchSurface<T> for $shape<T> {
            #[inline(always)]
            fn contacts_in_line(
                &self,
                wrenches: $crate::batch::Wrenches<'_, T>,
                contacts: $crate::batch::Contacts<'_, T>,
            ) {
                $crate::batch::sweep::run(wrenches, contacts, self);
            }

            #[inline(always)]
            fn is_at_origin(&self) -> bool {
                $crate::batch::kernel::Kernel::<T>::centred(self)
            }

            #[inline(always)]
            fn enter(
                &self,
                force: [T; 3],
                torque: [T; 3],
                lines: $crate::batch::Lines,
                at_origin: bool,
            ) -> $crate::batch::Entered<T> {
                $crate::batch::sweep::enter(self, force, torque, lines, at_origin)
            }
        }
    };
}

pub(crate) use swept;
