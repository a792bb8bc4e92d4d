//! The curvature of solids with flat ends.

use fingertip_wrench::Real;
use nalgebra::{Matrix2, Matrix3, Vector3};

use super::smooth_surface::agree;
use crate::Level;
use crate::numeric::vectors::length;

/// What part of a solid with flat ends has a normal.
pub(crate) enum Face {
    Side,
    End,
    /// Between the two.
    Edge,
}

impl Face {
    /// The ends are across the unit vector `axis`; the level function is that of the side.
    pub(crate) fn of<T: Real>(axis: &Vector3<T>, level: &Level<T>, normal: &Vector3<T>) -> Self {
        let side = level.gradient / length(&level.gradient);
        let end = axis * T::one().copysign(axis.dot(normal));
        let beside = (side - normal).norm_squared() <= (end - normal).norm_squared();
        match (beside, agree(if beside { &side } else { &end }, normal, T::one())) {
            (true, true) => Self::Side,
            (false, true) => Self::End,
            (_, false) => Self::Edge,
        }
    }

    /// The shape operator; on an edge, that of the side.
    pub(crate) fn shape_operator<T: Real>(self, level: &Level<T>) -> Matrix3<T> {
        match self {
            Self::End => Matrix3::zeros(),
            Self::Side | Self::Edge => level.shape_operator(),
        }
    }

    /// The shape operator in the tangent plane; NaN on an edge.
    pub(crate) fn bend<T: Real>(self, level: &Level<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        match self {
            Self::Side => level.bend(length(&level.gradient), tangents),
            Self::End => Matrix2::zeros(),
            Self::Edge => Matrix2::repeat(T::zero() / T::zero()),
        }
    }
}
