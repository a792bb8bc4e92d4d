//! The laws of crossings: on line and surface, all of them, the same however one looks.

use fingertip_wrench::{Line, Real, RigidTransform};
use nalgebra::Vector3;

use super::collect::Crossings;
use super::law::{Law, Violation};
use super::laws::SurfaceLaws;
use super::random::Random;
use super::tried::Tried;
use crate::numeric::vectors::{any_perpendicular, length};
use crate::{ActiveSurface, Crossing, ForceLine, Posed, Shortcuts};

impl<T: Real> SurfaceLaws<T> {
    pub(super) fn check_sole_entry(
        &self,
        surface: Tried<'_, T>,
        line: &Line<T>,
        crossings: &Crossings<T>,
    ) -> Result<(), Violation<T>> {
        let Some(entry) = surface.shortcuts().sole_entry(&ForceLine::along(line)) else { return Ok(()) };
        if !(entry.incidence_squared > T::zero()) {
            return Ok(());
        }
        let incidence = entry.incidence_squared.root();
        let error = crossings
            .as_slice()
            .iter()
            .filter(|c| c.active == entry.active && c.normal.dot(&line.direction) <= T::EPSILON)
            .map(|c| length(&(c.point - entry.point)))
            .fold(T::GREATEST, |least, error| if error < least { error } else { least });
        self.expect(Law::SoleEntry, line, error, self.allowed_at(&entry.point, incidence, T::literal(4.0)))?;
        let Some(parts) = entry.parts else { return Ok(()) };
        // Of a force of 1 N. Rounding moves sine and cosine as it does the point, in radii.
        let rounding = self.roundings * T::EPSILON;
        let allowed = T::literal(4.0) * rounding / incidence.max(rounding.root());
        let pressing = -entry.normal.dot(&line.direction);
        let across = length(&(line.direction + entry.normal * pressing));
        self.expect(Law::ForceParts, line, (parts.normal - pressing).abs(), allowed)?;
        self.expect(Law::ForceParts, line, (parts.tangential - across).abs(), allowed)
    }

    pub(super) fn check_entered_once(
        &self,
        surface: Tried<'_, T>,
        line: &Line<T>,
        crossings: &Crossings<T>,
    ) -> Result<(), Violation<T>> {
        let mut first = None;
        surface.crossings(line, |crossing| first = first.or(Some(crossing)));
        let kept = match (first, crossings.as_slice()) {
            (None, []) => true,
            (Some(first), [entry, exit]) => {
                first == *entry
                    && entry.active
                    && exit.active
                    && entry.normal.dot(&line.direction) < T::zero()
                    && exit.normal.dot(&line.direction) > T::zero()
            }
            _ => false,
        };
        self.expect(Law::EnteredOnce, line, if kept { T::zero() } else { T::one() }, T::zero())
    }

    pub(super) fn check_crossing(
        &self,
        surface: Tried<'_, T>,
        line: &Line<T>,
        crossing: &Crossing<T>,
    ) -> Result<(), Violation<T>> {
        let incidence = crossing.normal.dot(&line.direction).abs();
        let off = length(&(crossing.point - line.at(crossing.along)));
        let allowed = self.allowed_at(&crossing.point, incidence, T::one());
        self.expect(Law::CrossingOnLine, line, off, allowed)?;
        let norm_error = (length(&crossing.normal) - T::one()).abs();
        self.expect(Law::UnitNormal, line, norm_error, self.roundings * T::EPSILON)?;
        let normal = surface.normal(&crossing.point);
        let norm_error = (length(&normal) - T::one()).abs();
        self.expect(Law::UnitNormal, line, norm_error, T::literal(8.0) * T::EPSILON)?;
        let turned = length(&(normal - crossing.normal));
        // On an edge, any normal of it will do.
        if !self.edges {
            self.expect(Law::NormalAgrees, line, turned, self.half_the_digits())?;
        }
        self.expect_on_surface(
            Law::CrossingOnSurface,
            surface,
            line,
            &crossing.point,
            &crossing.normal,
            allowed,
        )
    }

    pub(super) fn compare(
        &self,
        law: Law,
        line: &Line<T>,
        expected: &Crossings<T>,
        found: &Crossings<T>,
        allowed: T,
        back: impl Fn(&Vector3<T>) -> Vector3<T>,
    ) -> Result<(), Violation<T>> {
        let grazes = found.least_incidence(line) < T::literal(0.05);
        let (expected, found) = (expected.as_slice(), found.as_slice());
        if expected.len() != found.len() {
            // Rounding decides whether a line that is nearly tangent crosses.
            if grazes {
                return Ok(());
            }
            return Err(Violation { law, line: *line, found: T::GREATEST, allowed });
        }
        for (a, b) in expected.iter().zip(found) {
            self.expect(law, line, length(&(a.point - back(&b.point))), allowed)?;
        }
        Ok(())
    }

    pub(super) fn check_sameness(
        &self,
        surface: Tried<'_, T>,
        line: &Line<T>,
        crossings: &Crossings<T>,
        random: &mut Random,
    ) -> Result<(), Violation<T>> {
        let incidence = crossings.least_incidence(line);
        let allowed = self.roundings * T::EPSILON * self.size() * T::literal(4.0) / incidence;
        let slid = Line { point: line.at(random.symmetric::<T>() * self.radius), direction: line.direction };
        let same = Crossings::of(&surface, &slid);
        self.compare(Law::SameLineSamePoints, line, crossings, &same, allowed, |p| *p)?;
        let reversed = Line { point: line.point, direction: -line.direction };
        let same = Crossings::of(&surface, &reversed);
        for crossing in crossings.as_slice() {
            let nearest = same
                .as_slice()
                .iter()
                .fold(T::GREATEST, |least, c| least.min(length(&(c.point - crossing.point))));
            self.expect(Law::SameLineSamePoints, line, nearest, allowed)?;
        }
        Ok(())
    }

    pub(super) fn check_rigid_motion(
        &self,
        surface: Tried<'_, T>,
        line: &Line<T>,
        crossings: &Crossings<T>,
        random: &mut Random,
    ) -> Result<(), Violation<T>> {
        let incidence = crossings.least_incidence(line);
        let pose: RigidTransform<T> =
            RigidTransform::from_parts(random.rotation(), random.in_ball() * self.radius);
        let moved =
            Line { point: pose.transform_point(&line.point), direction: pose.rotate(&line.direction) };
        let there = Crossings::of(&Posed::new(surface, pose), &moved);
        let back = pose.inverse();
        let allowed = self.roundings * T::EPSILON * self.size() * T::literal(8.0) / incidence;
        self.compare(Law::RigidMotion, line, crossings, &there, allowed, |p| back.transform_point(p))
    }

    pub(super) fn check_inside(
        &self,
        surface: Tried<'_, T>,
        line: &Line<T>,
        crossings: &Crossings<T>,
    ) -> Result<(), Violation<T>> {
        let found = crossings.as_slice();
        let wrong = found
            .iter()
            .enumerate()
            .filter(|(k, c)| (c.normal.dot(&line.direction) > T::zero()) != (k % 2 == 1))
            .count()
            + found.len() % 2;
        #[allow(clippy::cast_precision_loss)]
        self.expect(Law::Alternation, line, T::literal(wrong as f64), T::zero())?;
        let reach = self.radius * T::literal(1.3);
        let middle = (self.centre - line.point).dot(&line.direction);
        let margin = self.radius * T::EPSILON.root();
        for k in -50_i32..=50 {
            let along = middle + reach * T::literal(f64::from(k) / 50.0);
            if found.iter().any(|c| (c.along - along).abs() < margin) {
                continue;
            }
            let before = found.iter().filter(|c| c.along < along).count();
            if surface.contains(&line.at(along)) != (before % 2 == 1) {
                let found = T::literal(f64::from(k));
                return Err(Violation {
                    law: Law::AllCrossingsFound,
                    line: *line,
                    found,
                    allowed: T::zero(),
                });
            }
        }
        Ok(())
    }

    /// `true` if neighbouring crossings do not lie in the tangent plane.
    pub(super) fn is_tilted(&self, surface: Tried<'_, T>, line: &Line<T>, crossing: &Crossing<T>) -> bool {
        let step = T::EPSILON.cube_root();
        let first = any_perpendicular(&line.direction);
        for aside in [first, line.direction.cross(&first)] {
            let near = Line { point: line.point + aside * (step * self.radius), direction: line.direction };
            if let Some(neighbour) = Crossings::of(&surface, &near).nearest(&near, crossing) {
                let chord = neighbour.point - crossing.point;
                if chord.dot(&crossing.normal).abs() > step * T::literal(20.0) * length(&chord) {
                    return true;
                }
            }
        }
        false
    }
}
