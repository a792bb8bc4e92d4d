//! Who tries a surface, and how strictly.

use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;

use super::collect::Crossings;
use super::law::{Law, Violation};
use super::random::Random;
use super::tried::Tried;
use crate::ActiveSurface;
use crate::numeric::vectors::{any_perpendicular, length, unit_or};

/// Tries a surface with random lines and checks every [`Law`].
///
/// ```
/// use fingertip_surfaces::testing::SurfaceLaws;
/// use fingertip_surfaces::{CappedCylinder, Plane};
/// use nalgebra::Vector3;
///
/// let cylinder = CappedCylinder::new(Vector3::zeros(), Vector3::z(), 0.006, 0.02)?;
/// let laws = SurfaceLaws::around(Vector3::zeros(), 0.021_f64).with_lines(200).with_seed(7);
/// assert_eq!(laws.with_edges().check(&cylinder), Ok(()));
/// // Not every line that enters the other side of a plane leaves it again.
/// let plane = Plane::new(Vector3::zeros(), Vector3::z())?;
/// assert!(laws.check(&plane).is_err());
/// assert_eq!(laws.without_inside().check(&plane), Ok(()));
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SurfaceLaws<T: Real> {
    pub(super) centre: Vector3<T>,
    pub(super) radius: T,
    pub(super) lines: u32,
    pub(super) seed: u64,
    pub(super) roundings: T,
    pub(super) gap_tolerance: T,
    closed: bool,
    pub(super) edges: bool,
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
    pub fn with_lines(self, lines: u32) -> Self {
        Self { lines, ..self }
    }

    /// Another stream of lines.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// How many rounding errors of the size of the ball a crossing may be off, at square incidence.
    #[must_use]
    pub fn with_roundings(self, roundings: T) -> Self {
        Self { roundings, ..self }
    }

    /// How many rounding errors of the size of the ball a closest approach may be off.
    #[must_use]
    pub fn with_gap_roundings(self, roundings: T) -> Self {
        Self { gap_tolerance: roundings, ..self }
    }

    /// The surface has no inside that every line leaves again: planes, open and unbounded shapes.
    #[must_use]
    pub fn without_inside(self) -> Self {
        Self { closed: false, ..self }
    }

    /// The surface has edges and corners, where normals jump; the ball's centre lies inside.
    #[must_use]
    pub fn with_edges(self) -> Self {
        Self { edges: true, ..self }
    }

    pub(super) fn size(&self) -> T {
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
            self.check_sole_entry(surface, &line, &crossings)?;
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
            let factor = T::literal(2.0).whole_power(power);
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

    /// How far the normals of a point that is known up to rounding may be apart, where curvature is great.
    pub(super) fn half_the_digits(&self) -> T {
        (self.roundings * T::EPSILON).root() * T::literal(4.0)
    }

    /// How far from the truth a line may be found to meet the surface near `point`.
    ///
    /// What is rounded off a direction turns the line, which passes a point by as much as that point is
    /// far: by `ε` times the size of a bounded shape, and by more where a line that is almost parallel
    /// to a side of an unbounded one meets it far away. Along the line that becomes longer by
    /// `1/incidence`; but a tangent line may be reported a root of the rounding away.
    pub(super) fn allowed_at(&self, point: &Vector3<T>, incidence: T, times: T) -> T {
        let flat = T::literal(0.05);
        let exact = self.roundings * T::EPSILON * self.size().max(length(point)) * times;
        if incidence > flat {
            exact / incidence
        } else {
            let reach = self.radius.max(length(&(point - self.centre)));
            exact / flat + (T::EPSILON * self.roundings).root() * reach
        }
    }

    pub(super) fn expect(&self, law: Law, line: &Line<T>, found: T, allowed: T) -> Result<(), Violation<T>> {
        if found <= allowed { Ok(()) } else { Err(Violation { law, line: *line, found, allowed }) }
    }

    /// The surface must be met within `allowed` of a point along a normal.
    pub(super) fn expect_on_surface(
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
}
