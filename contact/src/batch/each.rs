//! Columns of contacts by the shortcuts of shapes: a loop without a branch over the lines that a closed form answers, and the
//! rest one by one.

use fingertip_surfaces::{ActiveSurface, Entry, ForceLine, Shortcuts};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use super::{Contacts, Wrenches};
use crate::model::flat;
use crate::{ContactModel, NoContact, PointContact, Resolution};

/// How many wrenches are taken together.
const BLOCK: usize = 64;

/// A surface whose lines of action are met one like the other.
pub(crate) trait Entering<T: Real>: ActiveSurface<T> + Copy {
    /// Where a force enters, without a branch: `None`, always or of single forces, says nothing.
    #[inline(always)]
    fn enters(&self, push: &ForceLine<T>) -> Option<Entry<T>> {
        self.shortcuts().sole_entry(push)
    }
}

/// Gives a shape columns of point contacts by where forces enter it.
macro_rules! entering {
    ($shape:ident $(, |$this:ident, $push:ident| $entry:expr)?) => {
        impl<T: fingertip_wrench::Real> $crate::batch::each::Entering<T> for $shape<T> {
            $(#[inline(always)]
            fn enters(&self, $push: &fingertip_surfaces::ForceLine<T>) -> Option<fingertip_surfaces::Entry<T>> {
                let $this = self;
                $entry
            })?
        }

        impl<T: fingertip_wrench::Real> $crate::batch::BatchSurface<T> for $shape<T> {
            #[inline(always)]
            fn contacts_in_line(
                &self,
                wrenches: $crate::batch::Wrenches<'_, T>,
                contacts: $crate::batch::Contacts<'_, T>,
            ) {
                $crate::batch::each::run(wrenches, contacts, self);
            }
        }
    };
}

pub(crate) use entering;

/// Point contacts of all wrenches.
#[inline(always)]
pub(crate) fn run<T: Real, S: Entering<T>>(
    wrenches: Wrenches<'_, T>,
    contacts: Contacts<'_, T>,
    surface: &S,
) {
    let (least, least_steepness) = (ForceLine::least_squared(), flat::<T>().whole_power(2));
    let shape = *surface;
    let Contacts { point: [px, py, pz], normal: [nx, ny, nz], gap } = contacts;
    each(
        wrenches,
        [px, py, pz, nx, ny, nz, gap],
        #[inline(always)]
        move |wrench| {
            let (push, is_in_range) = ForceLine::tried(wrench, least);
            let entry = shape.enters(&push);
            let told = is_in_range
                & entry.is_some_and(|entry| entry.active & (entry.incidence_squared >= least_steepness));
            (entry.map_or_else(nothing, |entry| (entry.point, entry.normal, T::zero())), told)
        },
        &|wrench| entered(wrench, surface),
    );
}

/// Seven numbers of every wrench: as `shortcut` says, or else as `alone` does.
///
/// The shortcut holds copies of what it needs: what it would read from memory in a part of the loop that not every wrench
/// takes, the compiler takes to be too dear for vectors without masks, such as those of AVX2, and it makes none.
#[inline(always)]
pub(super) fn each<T: Real>(
    wrenches: Wrenches<'_, T>,
    found: [&mut [T]; 7],
    shortcut: impl Fn(&Wrench<T>) -> (Row<T>, bool),
    alone: &dyn Fn(&Wrench<T>) -> Row<T>,
) {
    let ([fx, fy, fz], [tx, ty, tz]) = (wrenches.force, wrenches.torque);
    let given = [fx, fy, fz, tx, ty, tz];
    let shortest = given.iter().map(|column| column.len()).fold(usize::MAX, usize::min);
    let count = found.iter().map(|column| column.len()).fold(shortest, usize::min);
    let [px, py, pz, nx, ny, nz, last] = found;
    let mut start = 0;
    while start < count {
        let block = start..count.min(start + BLOCK);
        start = block.end;
        let given = given.map(|column| &column[block.clone()]);
        let (px, py, pz) = (&mut px[block.clone()], &mut py[block.clone()], &mut pz[block.clone()]);
        let (nx, ny, nz) = (&mut nx[block.clone()], &mut ny[block.clone()], &mut nz[block.clone()]);
        let (last, told) = (&mut last[block.clone()], &mut [false; BLOCK][..block.len()]);
        if sweep(given, px, py, pz, nx, ny, nz, last, told, &shortcut) {
            continue;
        }
        for (k, _) in told.iter().enumerate().filter(|(_, told)| !**told) {
            let (point, normal, number) = alone(&wrench_at(&given, k));
            [px[k], py[k], pz[k]] = point.into();
            [nx[k], ny[k], nz[k]] = normal.into();
            last[k] = number;
        }
    }
}

/// Point, normal, and what else there is of a contact.
pub(super) type Row<T> = (Vector3<T>, Vector3<T>, T);

/// Of what is no contact.
#[inline(always)]
pub(super) fn nothing<T: Real>() -> Row<T> {
    (Vector3::zeros(), Vector3::zeros(), T::zero())
}

#[inline(always)]
fn wrench_at<T: Real>([fx, fy, fz, tx, ty, tz]: &[&[T]; 6], k: usize) -> Wrench<T> {
    Wrench::on_fingertip(Vector3::new(fx[k], fy[k], fz[k]), Vector3::new(tx[k], ty[k], tz[k]))
}

/// As many wrenches as the slices hold, which are equally long, and whether the shortcut told of each, and of all; what is
/// written of others means nothing.
///
/// Columns that are arguments of their own are known not to overlap, which the compiler would have to test otherwise.
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
    last: &mut [T],
    told: &mut [bool],
    shortcut: &impl Fn(&Wrench<T>) -> (Row<T>, bool),
) -> bool {
    let count = told.len();
    // Slices of one known length let the compiler drop every bounds check from the loop.
    let given = given.map(|column| &column[..count]);
    let (px, py, pz) = (&mut px[..count], &mut py[..count], &mut pz[..count]);
    let (nx, ny, nz) = (&mut nx[..count], &mut ny[..count], &mut nz[..count]);
    let last = &mut last[..count];
    let mut all = true;
    for k in 0..count {
        let ((point, normal, number), is_told) = shortcut(&wrench_at(&given, k));
        told[k] = is_told;
        all &= is_told;
        [px[k], py[k], pz[k]] = point.into();
        [nx[k], ny[k], nz[k]] = normal.into();
        last[k] = number;
    }
    all
}

/// What a point contact makes of a wrench: point, normal and gap.
#[cold]
#[inline(never)]
fn entered<T: Real, S: ActiveSurface<T>>(wrench: &Wrench<T>, surface: &S) -> Row<T> {
    let no_answer = (Vector3::zeros(), Vector3::zeros(), T::GREATEST);
    let in_range = ForceLine::new(wrench, ForceLine::least_squared());
    let (Some(_), Ok(model)) = (in_range, PointContact::new(T::zero())) else { return no_answer };
    match model.resolve(wrench, surface) {
        Resolution::Contact(contact) => (contact.point, contact.normal, T::zero()),
        Resolution::NoContact(NoContact::Misses { closest: Some(closest) }) => {
            (closest.point, closest.normal, closest.gap)
        }
        Resolution::NoContact(_) => no_answer,
    }
}
