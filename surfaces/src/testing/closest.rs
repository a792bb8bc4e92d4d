//! The laws of closest approaches, and of lines of any bits.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::law::{Law, Violation};
use super::laws::SurfaceLaws;
use super::random::Random;
use super::tried::Tried;
use crate::ActiveSurface;
use crate::numeric::vectors::{any_perpendicular, is_finite, length};

impl<T: Real> SurfaceLaws<T> {
    pub(super) fn check_closest(
        &self,
        surface: Tried<'_, T>,
        line: &Line<T>,
        samples: &[Option<Vector3<T>>],
    ) -> Result<(), Violation<T>> {
        let allowed = self.gap_tolerance * T::EPSILON * self.size();
        let distance_from_line = |p: &Vector3<T>| {
            let away = p - line.point;
            length(&(away - line.direction * away.dot(&line.direction)))
        };
        let Some(found) = surface.closest_approach(line) else { return Ok(()) };
        let disagrees = (distance_from_line(&found.point) - found.gap).abs();
        self.expect(Law::ClosestOnSurface, line, disagrees, allowed)?;
        self.expect(Law::ClosestOnSurface, line, -found.gap, T::zero())?;
        let norm_error = (length(&found.normal) - T::one()).abs();
        self.expect(Law::UnitNormal, line, norm_error, self.roundings * T::EPSILON)?;
        // On an edge, any normal of it will do.
        if !self.edges {
            let turned = length(&(surface.normal(&found.point) - found.normal));
            self.expect(Law::NormalAgrees, line, turned, self.half_the_digits())?;
        }
        self.expect_on_surface(
            Law::ClosestOnSurface,
            surface,
            line,
            &(found.point - found.normal * (allowed / T::literal(4.0))),
            &found.normal,
            allowed,
        )?;
        // Nor does a parallel line meet it that is a little nearer than the gap, on whatever side.
        let within = found.gap * T::literal(0.98) - allowed;
        if within > T::zero() {
            let first = any_perpendicular(&line.direction);
            let second = line.direction.cross(&first);
            for k in 0..16_u8 {
                let angle = T::two_pi() * T::literal(f64::from(k) / 16.0);
                let aside = (first * angle.cosine() + second * angle.sine()) * within;
                let near = Line { point: line.point + aside, direction: line.direction };
                let mut met = T::zero();
                surface.crossings(&near, |_| met = T::one());
                self.expect(Law::NothingIsCloser, line, met, T::zero())?;
            }
        }
        for sample in samples.iter().flatten() {
            let closer = found.gap - distance_from_line(sample);
            self.expect(Law::NothingIsCloser, line, closer, allowed)?;
        }
        Ok(())
    }

    pub(super) fn check_any_bits(
        &self,
        surface: Tried<'_, T>,
        random: &mut Random,
    ) -> Result<(), Violation<T>> {
        for k in 0..self.lines {
            let any = |random: &mut Random| {
                let bits = random.bits();
                // Every fourth within the common range, the others anywhere.
                T::literal(if bits.is_multiple_of(4) {
                    random.symmetric()
                } else {
                    f64::from_bits(random.bits())
                })
            };
            let point = Vector3::new(any(random), any(random), any(random));
            let direction = if k % 8 == 0 {
                // Not a unit vector at all: no promise but to return.
                Vector3::new(any(random), any(random), any(random))
            } else if k % 8 == 1 {
                let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
                axes.get((random.bits() % 3) as usize).copied().unwrap_or_else(Vector3::x)
            } else {
                random.direction()
            };
            let line = Line { point, direction };
            let promised = is_finite(&point) && k % 8 != 0;
            let mut nan = 0_u32;
            let mut count = 0_u32;
            surface.crossings(&line, |c| {
                count += 1;
                nan += u32::from(!(c.along.is_number() && is_finite(&c.point) && is_finite(&c.normal)));
            });
            if let Some(approach) = surface.closest_approach(&line) {
                nan += u32::from(!(approach.gap.is_number() && is_finite(&approach.point)));
                nan += u32::from(!is_finite(&approach.normal));
            }
            nan += u32::from(!is_finite(&surface.normal(&point)));
            let _ = surface.contains(&point);
            if promised {
                self.expect(Law::NoNan, &line, T::literal(f64::from(nan)), T::zero())?;
            }
        }
        Ok(())
    }
}
