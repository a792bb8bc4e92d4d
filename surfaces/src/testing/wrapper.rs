//! The laws of wrappers: a shape inside another type answers as it does alone, and in the same way.

use fingertip_wrench::{Line, Real};

use super::collect::Crossings;
use super::law::{Law, Violation};
use super::laws::SurfaceLaws;
use super::random::Random;
use super::tried::Tried;
use crate::numeric::vectors::{length, wide};
use crate::{ActiveSurface, Entry, ForceLine, LineInDouble, Shortcuts};

/// What a wrapper keeps of the shape inside, beside its answers; each includes those before.
///
/// ```
/// use fingertip_surfaces::testing::{Kept, SurfaceLaws};
/// use fingertip_surfaces::{ActiveSurface, ClosestApproach, Crossing, Sphere};
/// use fingertip_wrench::Line;
/// use nalgebra::Vector3;
///
/// /// Answers as the sphere does, and has no shortcuts.
/// struct Slow(Sphere<f64>);
/// impl ActiveSurface<f64> for Slow {
///     fn crossings(&self, line: &Line<f64>, visit: impl FnMut(Crossing<f64>)) {
///         self.0.crossings(line, visit);
///     }
///     fn closest_approach(&self, line: &Line<f64>) -> Option<ClosestApproach<f64>> {
///         self.0.closest_approach(line)
///     }
/// }
///
/// let (sphere, laws) = (Sphere::centred(0.013)?, SurfaceLaws::around(Vector3::zeros(), 0.013));
/// assert_eq!(laws.check_wrapper(&sphere, &Slow(sphere), Kept::Answers), Ok(()));
/// assert!(laws.check_wrapper(&sphere, &Slow(sphere), Kept::All).is_err());
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kept {
    /// None of its [`Shortcuts`].
    Answers,
    /// [`surface_residual`](Shortcuts::surface_residual) and [`entry_in_double`](Shortcuts::entry_in_double).
    Residual,
    /// [`sole_entry`](Shortcuts::sole_entry).
    Entry,
    /// [`CLOSED_CONVEX`](Shortcuts::CLOSED_CONVEX).
    All,
}

impl<T: Real> SurfaceLaws<T> {
    /// Checks that a wrapper that should not change `surface` does not: no answer, and of the way to it, what
    /// the wrapper is said to keep.
    ///
    /// ```
    /// use fingertip_surfaces::testing::{Kept, SurfaceLaws};
    /// use fingertip_surfaces::{Sphere, Trimmed};
    /// use nalgebra::Vector3;
    ///
    /// let sphere = Sphere::centred(0.013)?;
    /// // What may touch only in part no longer promises to touch everywhere.
    /// let all_of_it = Trimmed::new(sphere, |_: &Vector3<f64>| true);
    /// let laws = SurfaceLaws::around(Vector3::zeros(), 0.013);
    /// laws.check_wrapper(&sphere, &all_of_it, Kept::Entry)?;
    /// assert!(laws.check_wrapper(&sphere, &all_of_it, Kept::All).is_err());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The first [`Violation`].
    pub fn check_wrapper<S: ActiveSurface<T>, W: ActiveSurface<T>>(
        &self,
        surface: &S,
        wrapper: &W,
        kept: Kept,
    ) -> Result<(), Violation<T>> {
        self.check_wrapped(Tried::new(surface), Tried::new(wrapper), kept)
    }

    fn check_wrapped(
        &self,
        surface: Tried<'_, T>,
        wrapper: Tried<'_, T>,
        kept: Kept,
    ) -> Result<(), Violation<T>> {
        let mut random = Random::new(self.seed);
        for _ in 0..self.lines {
            let line = random.line(&self.centre, self.radius);
            let crossings = Crossings::of(&surface, &line);
            let incidence = crossings.least_incidence(&line);
            if incidence < T::literal(0.05) {
                continue;
            }
            let allowed = self.roundings * T::EPSILON * self.size() * T::literal(8.0) / incidence;
            self.check_same_answers(surface, wrapper, &line, &crossings, allowed)?;
            if kept >= Kept::Residual {
                for crossing in crossings.as_slice() {
                    // So far off the surface that a residual that is dropped is missed.
                    let off = crossing.point + crossing.normal * (self.radius * T::EPSILON.root());
                    let [inner, outer] = [surface, wrapper].map(|s| s.surface_residual(&off));
                    self.expect(Law::WrapperKeepsResidual, &line, (inner - outer).abs(), allowed)?;
                    let exactly = Line { point: wide(&line.point), direction: wide(&line.direction) };
                    let near = wide(&crossing.point);
                    let apart = match [surface, wrapper].map(|s| s.entry_in_double(&exactly, &near)) {
                        [
                            Some(LineInDouble::Enters { point: p, normal: n }),
                            Some(LineInDouble::Enters { point, normal }),
                        ] => T::literal((p - point).norm() + (n - normal).norm()),
                        // A pose tells more than its shape.
                        [a, b] => count(a.is_some() && a != b),
                    };
                    self.expect(Law::WrapperKeepsResidual, &line, apart, allowed)?;
                }
            }
            if kept >= Kept::Entry {
                let push = ForceLine::along(&line);
                let apart = apart(surface.sole_entry(&push), wrapper.sole_entry(&push));
                self.expect(Law::WrapperKeepsEntry, &line, apart, allowed)?;
            }
            if kept == Kept::All {
                let lost = surface.closed_convex != wrapper.closed_convex;
                self.expect(Law::WrapperKeepsPromise, &line, count(lost), T::zero())?;
            }
        }
        Ok(())
    }

    fn check_same_answers(
        &self,
        surface: Tried<'_, T>,
        wrapper: Tried<'_, T>,
        line: &Line<T>,
        expected: &Crossings<T>,
        allowed: T,
    ) -> Result<(), Violation<T>> {
        let law = Law::WrapperKeepsAnswers;
        let found = Crossings::of(&wrapper, line);
        self.compare(law, line, expected, &found, allowed, |p| *p)?;
        for (a, b) in expected.as_slice().iter().zip(found.as_slice()) {
            self.expect(law, line, length(&(a.normal - b.normal)), self.half_the_digits())?;
            self.expect(law, line, count(a.active != b.active), T::zero())?;
            if !self.edges {
                let turned = length(&(surface.normal(&a.point) - wrapper.normal(&a.point)));
                self.expect(law, line, turned, self.half_the_digits())?;
            }
        }
        if expected.as_slice().is_empty() {
            let [inner, outer] = [surface, wrapper].map(|s| s.closest_approach(line));
            let allowed = self.gap_tolerance * T::EPSILON * self.size();
            let apart = match (inner, outer) {
                (Some(a), Some(b)) => (a.gap - b.gap).abs() + count(a.active != b.active),
                (a, b) => count(a.is_some() != b.is_some()),
            };
            self.expect(law, line, apart, allowed)?;
        }
        // Well away from the surface, unless by chance.
        let middle = line.at((self.centre - line.point).dot(&line.direction));
        let away = |c: &crate::Crossing<T>| length(&(c.point - middle)) > self.radius * T::EPSILON.root();
        let differs = surface.contains(&middle) != wrapper.contains(&middle);
        let differs = differs && expected.as_slice().iter().all(away);
        self.expect(law, line, count(differs), T::zero())
    }
}

/// How far apart two entries are, in metres and units of the force: 1 or more if only one is known.
fn apart<T: Real>(a: Option<Entry<T>>, b: Option<Entry<T>>) -> T {
    let (Some(a), Some(b)) = (a, b) else { return count(a.is_some() != b.is_some()) };
    let enters = |e: &Entry<T>| e.incidence_squared > T::zero();
    if !(enters(&a) && enters(&b)) {
        return count(enters(&a) != enters(&b));
    }
    let parts = match (a.parts, b.parts) {
        (Some(a), Some(b)) => (a.normal - b.normal).abs() + (a.tangential - b.tangential).abs(),
        (a, b) => count(a.is_some() != b.is_some()),
    };
    let of_point = length::<T>(&(a.point - b.point)) + length::<T>(&(a.normal - b.normal));
    of_point + (a.incidence_squared - b.incidence_squared).abs() + count(a.active != b.active) + parts
}

fn count<T: Real>(condition: bool) -> T {
    if condition { T::one() } else { T::zero() }
}
