//! Shapes made of shapes.

use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::{Matrix2, Matrix3, Vector3};

use crate::combinators::is_inside_along;
use crate::numeric::vectors::{length, tangents};
use crate::{
    ActiveSurface, Compound, Corner, Distance, Extent, ForceLine, Level, Offset, Patch, Posed, Region,
    Search, SignedDistance, SmoothSurface, SoftContact, SoftFingerSurface, Topology, Trimmed,
    hessian_by_differences, newton_soft_contacts,
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

impl<T: Real, S: SoftFingerSurface<T>> SoftFingerSurface<T> for Posed<T, S> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let pose = self.sensor_from_shape();
        let (rotation, origin) = (pose.rotation(), pose.origin());
        let inside = Wrench::on_fingertip(
            rotation.tr_mul(&wrench.force()),
            rotation.tr_mul(&wrench.torque_about(&origin)),
        );
        let last = last.map(|last| rotation.tr_mul(&(last - origin)));
        let search = self.inner().soft_contacts(&inside, last.as_ref(), |contact| {
            visit(SoftContact {
                point: rotation * contact.point + origin,
                normal: rotation * contact.normal,
                ..contact
            });
        });
        match search {
            Search::Grazing(pair) => Search::Grazing(pair.map(|point| rotation * point + origin)),
            other => other,
        }
    }

    #[inline]
    fn sole_soft_contact(&self, push: &ForceLine<T>) -> Option<SoftContact<T>> {
        let pose = self.sensor_from_shape();
        self.inner().sole_soft_contact(&push.seen_from(pose)).map(|contact| SoftContact {
            point: pose.transform_point(&contact.point),
            normal: pose.rotate(&contact.normal),
            ..contact
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

impl<T: Real, S: SoftFingerSurface<T>, R: Region<T>> SoftFingerSurface<T> for Trimmed<S, R> {
    #[inline]
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        self.inner().soft_contacts(wrench, last, |contact| {
            visit(SoftContact {
                active: contact.active && self.region().includes(&contact.point),
                ..contact
            });
        })
    }

    fn patch(&self, point: &Vector3<T>) -> Option<Patch> {
        self.inner().patch(point)
    }

    #[inline]
    fn sole_soft_contact(&self, push: &ForceLine<T>) -> Option<SoftContact<T>> {
        self.inner().sole_soft_contact(push).map(|contact| SoftContact {
            active: contact.active && self.region().includes(&contact.point),
            ..contact
        })
    }
}

/// `true` if a contact of one part lies inside another part, or on the seam and is not its own.
pub(crate) fn is_covered<T: Real>(part: &impl ActiveSurface<T>, contact: &SoftContact<T>, tie: bool) -> bool {
    let line = Line { point: contact.point, direction: contact.normal };
    is_inside_along(part, &line, T::zero(), &contact.point, tie)
}

/// What is known of a union from what is known of two parts; `seen` if there was a contact.
pub(crate) fn of_both<T: Real>(first: Search<T>, second: Search<T>, seen: bool) -> Search<T> {
    match (first, second) {
        (Search::Incomplete, _) | (_, Search::Incomplete) => Search::Incomplete,
        (Search::Grazing(pair), _) | (_, Search::Grazing(pair)) if !seen => Search::Grazing(pair),
        _ => Search::Complete,
    }
}

/// The contacts of both parts that do not lie inside the other. On the seam, which is a groove,
/// nothing flat can touch.
impl<T: Real, A: SoftFingerSurface<T>, B: SoftFingerSurface<T>> SoftFingerSurface<T> for Compound<A, B> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        mut visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        let (first, second) = self.parts();
        let mut seen = false;
        let of_first = first.soft_contacts(wrench, last, |contact| {
            if !is_covered(second, &contact, true) {
                seen = true;
                visit(contact);
            }
        });
        let of_second = second.soft_contacts(wrench, last, |contact| {
            if !is_covered(first, &contact, false) {
                seen = true;
                visit(contact);
            }
        });
        of_both(of_first, of_second, seen)
    }
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

impl<T: Real, S: SmoothSurface<T> + SignedDistance<T>> SoftFingerSurface<T> for Offset<T, S> {
    fn soft_contacts(
        &self,
        wrench: &Wrench<T>,
        last: Option<&Vector3<T>>,
        visit: impl FnMut(SoftContact<T>),
    ) -> Search<T> {
        newton_soft_contacts(self, wrench, last, visit)
    }
}
