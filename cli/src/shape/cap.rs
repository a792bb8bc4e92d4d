//! A sphere of which only a cap may touch.

use fingertip::surfaces::{ActiveSurface, ClosestApproach, Crossing};
use fingertip::wrench::Line;
use nalgebra::Vector3;

/// A surface whose active region is where its normal lies within an angle of the pole: on a
/// sphere, a cap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Capped<S> {
    inner: S,
    pole: Vector3<f64>,
    least_cosine: f64,
}

impl<S> Capped<S> {
    /// All of the surface.
    pub(crate) fn whole(inner: S, pole: Vector3<f64>) -> Self {
        // Below every cosine, rounding included.
        Self { inner, pole, least_cosine: -2.0 }
    }

    /// The part within `half_angle` \[rad\] of the unit vector `pole`.
    pub(crate) fn within(inner: S, pole: Vector3<f64>, half_angle: f64) -> Self {
        Self { inner, pole, least_cosine: half_angle.cos() }
    }

    /// The whole surface.
    pub(crate) const fn inner(&self) -> &S {
        &self.inner
    }

    fn is_active(&self, normal: &Vector3<f64>) -> bool {
        normal.dot(&self.pole) >= self.least_cosine
    }
}

impl<S: ActiveSurface<f64>> ActiveSurface<f64> for Capped<S> {
    #[inline]
    fn crossings(&self, line: &Line<f64>, mut visit: impl FnMut(Crossing<f64>)) {
        self.inner.crossings(line, |crossing| {
            let active = crossing.active && self.is_active(&crossing.normal);
            visit(Crossing { active, ..crossing });
        });
    }

    fn closest_approach(&self, line: &Line<f64>) -> ClosestApproach<f64> {
        let approach = self.inner.closest_approach(line);
        ClosestApproach { active: approach.active && self.is_active(&approach.normal), ..approach }
    }

    #[inline]
    fn normal(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.inner.normal(point)
    }
}

#[cfg(test)]
mod tests {
    use fingertip::contact::{ContactModel, NoContact, PointContact, Resolution};
    use fingertip::surfaces::Sphere;
    use fingertip::wrench::Wrench;
    use nalgebra::Vector3;

    use super::Capped;

    #[test]
    fn a_push_past_the_rim_is_outside_and_one_within_is_a_contact() {
        let sphere = Sphere::centred(0.013).unwrap();
        let cap = Capped::within(sphere, Vector3::x(), 100_f64.to_radians());
        let model = PointContact::new(0.1).unwrap();
        for (angle, inside) in [(0.0_f64, true), (60.0, true), (99.0, true), (101.0, false), (170.0, false)] {
            let normal = Vector3::new(angle.to_radians().cos(), angle.to_radians().sin(), 0.0);
            let wrench = Wrench::from_force_at(&(normal * 0.013), -normal);
            let resolution = model.resolve(&wrench, &cap);
            match resolution {
                Resolution::Contact(contact) => {
                    assert!(inside, "{angle}");
                    assert!((contact.point - normal * 0.013).norm() < 1e-12);
                }
                // The line enters outside the cap, and leaves, pulling, on it.
                Resolution::NoContact(
                    NoContact::OutsideActiveRegion { .. } | NoContact::OnlyPulling { .. },
                ) => {
                    assert!(!inside, "{angle}");
                }
                Resolution::NoContact(other) => panic!("{angle}: {other}"),
            }
            let whole = Capped::whole(sphere, Vector3::x());
            assert!(model.resolve(&wrench, &whole).contact().is_some(), "{angle}");
        }
    }
}
