//! Convex solids as the common part of simpler ones: a line is clipped by each in turn.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use crate::Crossing;

/// One end of the part of a line inside a convex solid.
#[derive(Clone, Copy)]
pub(crate) struct End<T: Real> {
    pub(crate) along: T,
    pub(crate) normal: Vector3<T>,
    pub(crate) active: bool,
}

/// The part of a line inside a convex solid.
#[derive(Clone, Copy)]
pub(crate) struct Inside<T: Real> {
    pub(crate) entry: End<T>,
    pub(crate) exit: End<T>,
}

impl<T: Real> Inside<T> {
    /// What is left inside the half-space below the plane at `level` along the unit vector
    /// `normal`, for a line that starts at `height` over the origin; `None` if nothing is.
    #[inline]
    pub(crate) fn below(
        self,
        level: T,
        height: T,
        slope: T,
        normal: Vector3<T>,
        active: bool,
    ) -> Option<Self> {
        let along = (level - height) / slope;
        let end = End { along, normal, active };
        let clipped = if slope > T::zero() && along < T::GREATEST {
            if along < self.exit.along { Self { exit: end, ..self } } else { self }
        } else if slope < T::zero() && along > -T::GREATEST {
            if along > self.entry.along { Self { entry: end, ..self } } else { self }
        } else if height <= level {
            self
        } else {
            return None;
        };
        (clipped.entry.along <= clipped.exit.along).then_some(clipped)
    }

    /// Reports both ends, `offset` being the position along the line of the point that the
    /// distances count from, `start`.
    #[inline]
    pub(crate) fn report(
        self,
        line: &Line<T>,
        start: &Vector3<T>,
        offset: T,
        mut visit: impl FnMut(Crossing<T>),
    ) {
        for end in [self.entry, self.exit] {
            if end.along.abs() < T::GREATEST {
                visit(Crossing {
                    along: offset + end.along,
                    point: start + line.direction * end.along,
                    normal: end.normal,
                    active: end.active,
                });
            }
        }
    }
}
