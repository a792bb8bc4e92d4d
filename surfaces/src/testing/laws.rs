//! The laws and who breaks them.

use fingertip_wrench::{Line, Real, RigidTransform};
use nalgebra::Vector3;
use thiserror::Error;

use super::collect::Crossings;
use super::random::Random;
use super::tried::Tried;
use crate::numeric::vectors::{any_perpendicular, is_finite, length, unit_or};
use crate::{ActiveSurface, Crossing, ForceLine, Posed};

/// What a surface has to obey.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Law {
    /// A crossing lies on the line, at the position that it names.
    CrossingOnLine,
    /// A crossing lies on the surface: a line through it along its normal meets the surface there.
    CrossingOnSurface,
    /// `sole_entry`, if it answers, is the crossing at which the line enters, but for rounding.
    SoleEntry,
    /// A surface that is [`CLOSED_CONVEX`](ActiveSurface::CLOSED_CONVEX) is entered once and left once,
    /// both at active points, and reports where it is entered first.
    EnteredOnce,
    /// Normals have length 1.
    UnitNormal,
    /// `normal` agrees with the normals of crossings.
    NormalAgrees,
    /// Neighbouring crossings lie in the tangent plane: the normal is the gradient's direction.
    NormalIsGradient,
    /// The same line the other way round, or counted from another point, crosses in the same points.
    SameLineSamePoints,
    /// Crossings of a closed surface alternate, first in, then out.
    Alternation,
    /// The line is inside between entry and exit, and nowhere else.
    AllCrossingsFound,
    /// Turning and moving both shape and line turns and moves the crossings.
    RigidMotion,
    /// Scaling both shape and line scales the crossings.
    Scaling,
    /// The closest point of a line that misses is a point of the surface, as far from the line as
    /// the gap says.
    ClosestOnSurface,
    /// No other point of the surface is closer than the closest approach.
    NothingIsCloser,
    /// No NaN comes out of a finite line.
    NoNan,
}

/// A law that a surface breaks, and the line on which it does.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{law:?} is broken on the line through {line:?}: {found} is more than {allowed}")]
pub struct Violation<T: Real> {
    /// The law.
    pub law: Law,
    /// The line on which it is broken.
    pub line: Line<T>,
    /// By how much; the count of lines for laws that allow some exceptions.
    pub found: T,
    /// How much was allowed.
    pub allowed: T,
}

/// Tries a surface with random lines and checks every [`Law`].
#[derive(Clone, Copy, Debug)]
pub struct SurfaceLaws<T: Real> {
    centre: Vector3<T>,
    radius: T,
    lines: u32,
    seed: u64,
    roundings: T,
    gap_tolerance: T,
    closed: bool,
    edges: bool,
}

impl<T: Real> SurfaceLaws<T> {
    /// For a surface within a ball about `centre`, or of which that ball shows the part of interest.
    #[must_use]
    pub fn around(centre: Vector3<T>, radius: T) -> Self {
        Self {
            centre,
            radius,
            lines: 400,
            seed: 1,
            roundings: T::literal(64.0),
            gap_tolerance: T::literal(4096.0),
            closed: true,
            edges: false,
        }
    }

    /// How many lines are tried.
    #[must_use]
    pub fn lines(self, lines: u32) -> Self {
        Self { lines, ..self }
    }

    /// Another stream of lines.
    #[must_use]
    pub fn seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// How many rounding errors of the size of the ball a crossing may be off, at square incidence.
    #[must_use]
    pub fn roundings(self, roundings: T) -> Self {
        Self { roundings, ..self }
    }

    /// How many rounding errors of the size of the ball a closest approach may be off.
    #[must_use]
    pub fn gap_roundings(self, roundings: T) -> Self {
        Self { gap_tolerance: roundings, ..self }
    }

    /// The surface has no inside that every line leaves again: planes, open and unbounded shapes.
    #[must_use]
    pub fn open(self) -> Self {
        Self { closed: false, ..self }
    }

    /// The surface has edges and corners, where normals jump; the ball's centre lies inside.
    #[must_use]
    pub fn with_edges(self) -> Self {
        Self { edges: true, ..self }
    }

    fn size(&self) -> T {
        self.radius + length(&self.centre)
    }

    /// Checks all laws but [`Law::Scaling`].
    ///
    /// # Errors
    /// The first [`Violation`].
    pub fn check<S: ActiveSurface<T>>(&self, surface: &S) -> Result<(), Violation<T>> {
        self.check_tried(Tried::new(surface))
    }

    fn check_tried(&self, surface: Tried<'_, T>) -> Result<(), Violation<T>> {
        let mut random = Random::new(self.seed);
        let mut tilted = 0_u32;
        let mut compared = 0_u32;
        let mut samples = [None; 256];
        let mut known = 0_usize;
        for _ in 0..self.lines {
            let line = random.line(&self.centre, self.radius);
            let crossings = Crossings::of(&surface, &line);
            if let Some(entry) = surface.sole_entry(&ForceLine::along(&line))
                && entry.incidence_squared > T::zero()
            {
                let allowed = self.allowed_at(&entry.point, entry.incidence_squared.root(), T::literal(4.0));
                let error = crossings
                    .as_slice()
                    .iter()
                    .filter(|c| c.active == entry.active && c.normal.dot(&line.direction) <= T::EPSILON)
                    .map(|c| length(&(c.point - entry.point)))
                    .fold(T::GREATEST, |least, error| if error < least { error } else { least });
                self.expect(Law::SoleEntry, &line, error, allowed)?;
            }
            for crossing in crossings.as_slice() {
                self.check_crossing(surface, &line, crossing)?;
                if let Some(place) = samples.get_mut(known % 256) {
                    *place = Some(crossing.point);
                    known += 1;
                }
            }
            if crossings.least_incidence(&line) < T::literal(0.05) {
                continue;
            }
            if surface.closed_convex {
                self.check_entered_once(surface, &line, &crossings)?;
            }
            self.check_sameness(surface, &line, &crossings, &mut random)?;
            self.check_rigid_motion(surface, &line, &crossings, &mut random)?;
            if self.closed {
                self.check_inside(surface, &line, &crossings)?;
            }
            if let Some(first) = crossings.as_slice().first() {
                compared += 1;
                tilted += u32::from(self.is_tilted(surface, &line, first));
            }
        }
        // Where the neighbours lie across an edge, or on a strongly curved spot, this cannot hold.
        let allowed = compared / if self.edges { 10 } else { 20 } + 2;
        self.expect(
            Law::NormalIsGradient,
            &Line { point: self.centre, direction: Vector3::z() },
            T::literal(f64::from(tilted)),
            T::literal(f64::from(allowed)),
        )?;
        for _ in 0..self.lines / 4 {
            let line = random.line(&self.centre, self.radius);
            if Crossings::of(&surface, &line).as_slice().is_empty() {
                self.check_closest(surface, &line, &samples)?;
            }
        }
        self.check_any_bits(surface, &mut random)
    }

    /// Checks [`Law::Scaling`] on the shape that `make` returns for a factor (1, 2⁻⁴, 2⁷, …; `None` for a
    /// factor beyond what the shape allows), which shall be the shape of factor 1 scaled about the
    /// origin.
    ///
    /// # Errors
    /// The first [`Violation`].
    pub fn check_scaling<S: ActiveSurface<T>>(
        &self,
        make: impl Fn(T) -> Option<S>,
    ) -> Result<(), Violation<T>> {
        let Some(original) = make(T::one()) else { return Ok(()) };
        let original = Tried::new(&original);
        for power in [-12, -4, 3, 7, 15] {
            let factor = T::literal(2.0).powi(power);
            if let Some(scaled) = make(factor) {
                self.check_scaled(original, Tried::new(&scaled), factor)?;
            }
        }
        Ok(())
    }

    fn check_scaled(
        &self,
        original: Tried<'_, T>,
        scaled: Tried<'_, T>,
        factor: T,
    ) -> Result<(), Violation<T>> {
        let mut random = Random::new(self.seed);
        for _ in 0..self.lines / 4 {
            let line = random.line(&self.centre, self.radius);
            let here = Crossings::of(&original, &line);
            let incidence = here.least_incidence(&line);
            if incidence < T::literal(0.05) {
                continue;
            }
            let there =
                Crossings::of(&scaled, &Line { point: line.point * factor, direction: line.direction });
            let allowed = self.roundings * T::EPSILON * self.size() / incidence;
            self.compare(Law::Scaling, &line, &here, &there, allowed, |p| p / factor)?;
        }
        Ok(())
    }

    fn check_entered_once(
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

    /// How far from the truth a line may be found to meet the surface near `point`.
    ///
    /// What is rounded off a direction turns the line, which passes a point by as much as that point is
    /// far: by `ε` times the size of a bounded shape, and by more where a line that is almost parallel
    /// to a side of an unbounded one meets it far away. Along the line that becomes longer by
    /// `1/incidence`; but a tangent line may be reported a root of the rounding away.
    fn allowed_at(&self, point: &Vector3<T>, incidence: T, times: T) -> T {
        let flat = T::literal(0.05);
        let exact = self.roundings * T::EPSILON * self.size().max(length(point)) * times;
        if incidence > flat {
            exact / incidence
        } else {
            let reach = self.radius.max(length(&(point - self.centre)));
            exact / flat + (T::EPSILON * self.roundings).root() * reach
        }
    }

    fn expect(&self, law: Law, line: &Line<T>, found: T, allowed: T) -> Result<(), Violation<T>> {
        if found <= allowed { Ok(()) } else { Err(Violation { law, line: *line, found, allowed }) }
    }

    fn check_crossing(
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
        let half_the_digits = (self.roundings * T::EPSILON).root() * T::literal(4.0);
        if !self.edges || turned < half_the_digits {
            self.expect(Law::NormalAgrees, line, turned, half_the_digits)?;
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

    /// The surface must be met within `allowed` of a point along a normal.
    fn expect_on_surface(
        &self,
        law: Law,
        surface: Tried<'_, T>,
        line: &Line<T>,
        point: &Vector3<T>,
        normal: &Vector3<T>,
        allowed: T,
    ) -> Result<(), Violation<T>> {
        let mut nearest = T::GREATEST;
        // Slightly tilted too, in case an edge or a tip is met by rounding only.
        let aside = any_perpendicular(normal) * T::literal(0.1);
        let inward = if self.edges { self.centre - point } else { *normal };
        for direction in [*normal, normal + aside, normal - aside, inward] {
            let direction = unit_or(&direction, Vector3::x);
            surface.crossings(&Line { point: *point, direction }, |c| nearest = nearest.min(c.along.abs()));
        }
        self.expect(law, line, nearest, allowed)
    }

    fn compare(
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

    fn check_sameness(
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

    fn check_rigid_motion(
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

    fn check_inside(
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
    fn is_tilted(&self, surface: Tried<'_, T>, line: &Line<T>, crossing: &Crossing<T>) -> bool {
        let step = T::EPSILON.cbrt();
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

    fn check_closest(
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
        let found = surface.closest_approach(line);
        let disagrees = (distance_from_line(&found.point) - found.gap).abs();
        self.expect(Law::ClosestOnSurface, line, disagrees, allowed)?;
        self.expect(Law::ClosestOnSurface, line, -found.gap, T::zero())?;
        self.expect_on_surface(
            Law::ClosestOnSurface,
            surface,
            line,
            &(found.point - found.normal * (allowed / T::literal(4.0))),
            &found.normal,
            allowed,
        )?;
        for sample in samples.iter().flatten() {
            let closer = found.gap - distance_from_line(sample);
            self.expect(Law::NothingIsCloser, line, closer, allowed)?;
        }
        Ok(())
    }

    fn check_any_bits(&self, surface: Tried<'_, T>, random: &mut Random) -> Result<(), Violation<T>> {
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
            let approach = surface.closest_approach(&line);
            let normal = surface.normal(&point);
            nan += u32::from(!(approach.gap.is_number() && is_finite(&approach.point)));
            nan += u32::from(!(is_finite(&approach.normal) && is_finite(&normal)));
            let _ = surface.contains(&point);
            if promised {
                self.expect(Law::NoNan, &line, T::literal(f64::from(nan)), T::zero())?;
            }
        }
        Ok(())
    }
}
