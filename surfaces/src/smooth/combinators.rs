//! Shapes made of shapes.

use fingertip_wrench::Real;
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::numeric::vectors::{length, tangents};
use crate::{
    Compound, Corner, Distance, Extent, Level, Offset, Posed, Region, SignedDistance, SmoothSurface,
    Topology, Trimmed, hessian_by_differences,
};

impl<T: Real, S: SmoothSurface<T>> SmoothSurface<T> for Posed<T, S> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let pose = self.sensor_from_shape();
        let rotation = pose.rotation();
        let level = self.inner().level(&rotation.tr_mul(&(point - pose.origin())));
        Level {
            value: level.value,
            gradient: rotation * level.gradient,
            hessian: rotation * level.hessian * rotation.transpose(),
        }
    }

    fn extent(&self) -> Extent<T> {
        let extent = self.inner().extent();
        Extent { centre: self.sensor_from_shape().transform_point(&extent.centre), ..extent }
    }

    fn topology(&self) -> Topology {
        self.inner().topology()
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let pose = self.sensor_from_shape();
        let rotation = pose.rotation();
        rotation
            * self.inner().shape_operator(&rotation.tr_mul(&(point - pose.origin())))
            * rotation.transpose()
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, [e1, e2]: [&Vector3<T>; 2]) -> Matrix2<T> {
        let pose = self.sensor_from_shape();
        let inside = |v: &Vector3<T>| pose.rotation().tr_mul(v);
        self.inner().bend(&inside(&(point - pose.origin())), &inside(normal), [&inside(e1), &inside(e2)])
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        let pose = self.sensor_from_shape();
        let rotation = pose.rotation();
        let inside = rotation.tr_mul(&(point - pose.origin()));
        self.inner().corner(&inside, &rotation.tr_mul(normal)).map(|corner| match corner {
            Corner::Edge { direction, bend } => Corner::Edge { direction: rotation * direction, bend },
            Corner::Tip => Corner::Tip,
        })
    }
}

impl<T: Real, S: SmoothSurface<T>, R: Region<T>> SmoothSurface<T> for Trimmed<S, R> {
    #[inline]
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        self.inner().level(point)
    }

    fn extent(&self) -> Extent<T> {
        self.inner().extent()
    }

    fn topology(&self) -> Topology {
        self.inner().topology()
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        self.inner().shape_operator(point)
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        self.inner().bend(point, normal, tangents)
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        self.inner().corner(point, normal)
    }
}

/// That of the part whose surface is nearer; on the seam, that of either.
impl<T: Real, A: SmoothSurface<T>, B: SmoothSurface<T>> SmoothSurface<T> for Compound<A, B> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let (first, second) = self.parts();
        if self.is_of_first(point, None) { first.level(point) } else { second.level(point) }
    }

    fn extent(&self) -> Extent<T> {
        let (first, second) = self.parts();
        around_both(&first.extent(), &second.extent())
    }

    fn shape_operator(&self, point: &Vector3<T>) -> Matrix3<T> {
        let (first, second) = self.parts();
        if self.is_of_first(point, None) { first.shape_operator(point) } else { second.shape_operator(point) }
    }

    fn bend(&self, point: &Vector3<T>, normal: &Vector3<T>, tangents: [&Vector3<T>; 2]) -> Matrix2<T> {
        let (first, second) = self.parts();
        if self.is_of_first(point, Some(normal)) {
            first.bend(point, normal, tangents)
        } else {
            second.bend(point, normal, tangents)
        }
    }

    fn corner(&self, point: &Vector3<T>, normal: &Vector3<T>) -> Option<Corner<T>> {
        let (first, second) = self.parts();
        if self.is_of_first(point, Some(normal)) {
            first.corner(point, normal)
        } else {
            second.corner(point, normal)
        }
    }
}

/// The least ball around two balls.
pub(crate) fn around_both<T: Real>(one: &Extent<T>, other: &Extent<T>) -> Extent<T> {
    let apart = other.centre - one.centre;
    let distance = length(&apart);
    if distance + other.radius <= one.radius {
        return *one;
    }
    if distance + one.radius <= other.radius {
        return *other;
    }
    let radius = (distance + one.radius + other.radius) * T::literal(0.5);
    Extent { centre: one.centre + apart * ((radius - one.radius) / distance), radius }
}

/// The distance, with the curvature of the parallel surface, `W/(1 + δW)` at the distance `δ` over
/// a point of the inner surface with the shape operator `W`; over an edge or a tip, which the offset makes
/// round, from differences of the normal.
impl<T: Real, S: SmoothSurface<T> + SignedDistance<T>> SmoothSurface<T> for Offset<T, S> {
    fn level(&self, point: &Vector3<T>) -> Level<T> {
        let Distance { distance, normal } = self.inner().signed_distance(point);
        let (e1, e2) = tangents(&normal);
        let foot = point - normal * distance;
        let bend = self.inner().bend(&foot, &normal, [&e1, &e2]);
        let hessian = match (Matrix2::identity() + bend * distance).try_inverse() {
            Some(spread) if bend.sum().is_number() => {
                let bend = bend * spread;
                (e1 * bend.m11 + e2 * bend.m21) * e1.transpose()
                    + (e1 * bend.m12 + e2 * bend.m22) * e2.transpose()
            }
            // Around an edge or a tip of the inner surface.
            Some(_) if distance > T::zero() => match self.inner().corner(&foot, &normal) {
                Some(Corner::Edge { direction, bend }) => {
                    let across = normal.cross(&direction);
                    direction * direction.transpose() * (bend / (T::one() + bend * distance))
                        + across * across.transpose() / distance
                }
                Some(Corner::Tip) => (Matrix3::identity() - normal * normal.transpose()) / distance,
                None => {
                    let step = distance * T::EPSILON.cbrt();
                    hessian_by_differences(point, step, |p| self.inner().signed_distance(p).normal)
                }
            },
            _ => Matrix3::zeros(),
        };
        Level { value: distance - self.distance(), gradient: normal, hessian }
    }

    fn extent(&self) -> Extent<T> {
        let (centre, radius) = self.bounds();
        Extent { centre, radius }
    }

    fn topology(&self) -> Topology {
        if S::CONVEX { Topology::Convex } else { self.inner().topology() }
    }
}
