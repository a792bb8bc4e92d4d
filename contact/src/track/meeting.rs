//! Where the lines of action of several wrenches meet.

use fingertip_surfaces::numeric::vectors::is_finite;
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix3, Matrix6, Vector3};
use thiserror::Error;

use crate::WrenchSpread;

/// Beyond so many standard deviations the lines do not meet, and directions are no longer told from noise.
const DEVIATIONS: f64 = 4.0;

/// Finds a contact that rests without knowing any surface: where the lines of action of its wrenches meet
/// (`docs/theory/contact.md#where-lines-meet`).
///
/// The force must change its direction while the contact stays where it is, as when an object is dragged to and fro
/// without slipping. Whether it does, and whether one resting contact explains the wrenches at all, is told.
///
/// ```
/// use fingertip_contact::{LineMeeting, WrenchSpread};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let place = Vector3::new(0.004, -0.002, 0.012);
/// let noise = WrenchSpread::Isotropic { force: 1e-6, torque: 1e-10 };
/// let mut meeting = LineMeeting::new();
/// for k in 0..20 {
///     let side = f64::from(k % 5) * 0.2 - 0.4;
///     let force = Vector3::new(side, f64::from(k % 3) * 0.3, -1.0);
///     meeting.add(&Wrench::from_force_at(&place, force), noise);
/// }
/// let met = meeting.find()?;
/// assert!((met.point - place).norm() < met.deviation());
/// assert!(met.deviation() < 0.1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de>"))
)]
pub struct LineMeeting<T: Real> {
    /// About which the sums are taken \[m\]: near the first line.
    origin: Vector3<T>,
    count: u32,
    /// `Σ w (|f|² I − f fᵀ)`, `Σ w f × m`, `Σ w |m across f|²`, and `Σ w` times the covariances.
    matrix: Matrix3<T>,
    right: Vector3<T>,
    total: T,
    spread: Matrix6<T>,
}

/// Where lines meet.
///
/// ```
/// use fingertip_contact::{LineMeeting, Met, WrenchSpread};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // Two forces of 1 N that cross at right angles, 12 mm above the origin; 1 mN and 0.01 N·mm of noise.
/// let (place, noise) = (Vector3::new(0.0, 0.0, 0.012), WrenchSpread::Isotropic { force: 1e-6, torque: 1e-10 });
/// let mut meeting = LineMeeting::new();
/// meeting.add(&Wrench::from_force_at(&place, Vector3::new(1.0, 0.0, -1.0) / 2.0_f64.sqrt()), noise);
/// meeting.add(&Wrench::from_force_at(&place, Vector3::new(-1.0, 0.0, -1.0) / 2.0_f64.sqrt()), noise);
/// let met: Met<f64> = meeting.find()?;
/// assert!((met.point - place).norm() < met.deviation() && met.deviation() < 0.05e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met<T: Real> {
    /// The place \[m\].
    pub point: Vector3<T>,
    /// Its covariance \[m²\].
    pub covariance: Matrix3<T>,
    /// By how many standard deviations the lines are farther apart than their noise makes them; below zero if they are
    /// nearer.
    pub excess: T,
}

impl<T: Real> Met<T> {
    /// Standard deviation in the direction in which the place is known worst \[m\].
    #[must_use]
    pub fn deviation(&self) -> T {
        self.covariance.symmetric_eigenvalues().max().max(T::zero()).root()
    }
}

/// Why no place can be told.
///
/// ```
/// use fingertip_contact::{LineMeeting, NoMeeting, WrenchSpread};
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// let noise = WrenchSpread::Isotropic { force: 1e-6, torque: 1e-10 };
/// let push = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 0.012), Vector3::new(0.0, 0.0, -1.0));
/// let mut meeting = LineMeeting::<f64>::new();
/// meeting.add(&push, noise);
/// assert_eq!(meeting.find(), Err(NoMeeting::TooFew(1)));
/// // The same push again does not tell how high the place is.
/// meeting.add(&push, noise);
/// assert_eq!(meeting.find(), Err(NoMeeting::Parallel));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NoMeeting<T: Real> {
    /// Two lines are the least.
    #[error("{0} wrenches are too few: the lines of at least two have to meet")]
    TooFew(u32),
    /// The forces all have one direction, but for their noise: any place along it would do.
    #[error(
        "the forces have the same direction but for their noise, so that their lines do not tell where they meet"
    )]
    Parallel,
    /// One contact at rest does not explain the wrenches: it moves, or there are several.
    #[error("the lines pass each other {excess} standard deviations farther than their noise explains")]
    Apart {
        /// By how many standard deviations.
        excess: T,
    },
}

impl<T: Real> Default for LineMeeting<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real> LineMeeting<T> {
    /// Without any wrench.
    #[must_use]
    pub fn new() -> Self {
        Self {
            origin: Vector3::zeros(),
            count: 0,
            matrix: Matrix3::zeros(),
            right: Vector3::zeros(),
            total: T::zero(),
            spread: Matrix6::zeros(),
        }
    }

    /// Takes a wrench with its covariance; `false`, and nothing is taken, if it has no line of action, no noise, or
    /// numbers that are not finite.
    pub fn add<'a>(&mut self, wrench: &Wrench<T>, spread: impl Into<WrenchSpread<'a, T>>) -> bool {
        let (force, torque) = (wrench.force(), wrench.torque());
        let squared = force.norm_squared();
        let foot = force.cross(&torque) / squared;
        if !(squared >= T::LEAST_NORMAL && squared.is_number() && is_finite(&foot)) {
            return false;
        }
        let origin = if self.count == 0 { foot } else { self.origin };
        let about = shifted(&full(spread.into()), &origin);
        let moment = torque - origin.cross(&force);
        let weight = T::literal(3.0) / (about.m44 + about.m55 + about.m66);
        let across = moment - force * (force.dot(&moment) / squared);
        let next = Self {
            origin,
            count: self.count.saturating_add(1),
            matrix: self.matrix + (Matrix3::identity() * squared - force * force.transpose()) * weight,
            right: self.right + force.cross(&moment) * weight,
            total: self.total + across.norm_squared() * weight,
            spread: self.spread + about * weight,
        };
        let good = weight > T::zero()
            && (next.total + next.matrix.sum() + next.right.sum() + next.spread.sum()).is_number();
        if good {
            *self = next;
        }
        good
    }

    /// How many wrenches were taken.
    #[must_use]
    pub const fn count(&self) -> u32 {
        self.count
    }

    /// Where the lines meet, by least squares of their moments about the place, weighted by their noise. What noise of the
    /// force adds to the squares is taken off, so that the place has no bias towards the origin.
    ///
    /// # Errors
    /// [`NoMeeting`]: fewer than two lines, forces that are parallel but for noise, or lines that do not meet.
    pub fn find(&self) -> Result<Met<T>, NoMeeting<T>> {
        if self.count < 2 {
            return Err(NoMeeting::TooFew(self.count));
        }
        let number = T::literal;
        let count = number(f64::from(self.count));
        let forces: Matrix3<T> = self.spread.fixed_view::<3, 3>(0, 0).into_owned();
        let mixed: Matrix3<T> = self.spread.fixed_view::<3, 3>(0, 3).into_owned();
        let by_noise = Matrix3::identity() * forces.trace() - forces;
        let matrix = self.matrix - by_noise;
        let bias = Vector3::new(mixed.m23 - mixed.m32, mixed.m31 - mixed.m13, mixed.m12 - mixed.m21);
        // What is left in the worst direction must be more than the noise's own part is uncertain by.
        if !matrix.norm_squared().is_number() {
            return Err(NoMeeting::Parallel);
        }
        let eigen = matrix.symmetric_eigen();
        let (at, least) = eigen.eigenvalues.argmin();
        let worst: Vector3<T> = eigen.eigenvectors.column(at).into_owned();
        let uncertain = by_noise.trace() * (number(2.0) / count).root() * number(DEVIATIONS)
            + self.matrix.trace() * T::EPSILON * number(64.0);
        if !(least > uncertain) {
            return Err(NoMeeting::Parallel);
        }
        let inverse = matrix.try_inverse().ok_or(NoMeeting::Parallel)?;
        let away = inverse * (self.right - bias);
        // The noise of the moment about the place across the forces, which lie about in the worst direction: the mean of the
        // weighted squares of one component.
        let about = shifted(&self.spread, &away);
        let moments: Matrix3<T> = about.fixed_view::<3, 3>(3, 3).into_owned();
        let variance = (moments.trace() - worst.dot(&(moments * worst))) / (count * number(2.0));
        let squares = self.total - away.dot(&self.right) * number(2.0) + away.dot(&(self.matrix * away));
        let freedom = count * number(2.0) - number(3.0);
        // χ² as a Gaussian (Wilson & Hilferty 1931).
        let spread = number(2.0 / 9.0) / freedom;
        let ratio = (squares / variance / freedom).max(T::zero());
        let excess = (ratio.power(number(1.0 / 3.0)) - (T::one() - spread)) / spread.root();
        let point = self.origin + away;
        let covariance = inverse * variance;
        if !(is_finite(&point) && (covariance.sum() + excess).is_number()) {
            return Err(NoMeeting::Parallel);
        }
        if excess > number(DEVIATIONS) {
            return Err(NoMeeting::Apart { excess });
        }
        Ok(Met { point, covariance, excess })
    }

    /// Forgets all wrenches.
    pub fn reset(&mut self) {
        *self = Self::new();
    }
}

fn full<T: Real>(spread: WrenchSpread<'_, T>) -> Matrix6<T> {
    match spread {
        WrenchSpread::Full(full) => *full,
        WrenchSpread::Independent(variances) => Matrix6::from_diagonal(&variances),
        WrenchSpread::Isotropic { force, torque } => {
            Matrix6::from_diagonal(&nalgebra::Vector6::new(force, force, force, torque, torque, torque))
        }
    }
}

/// The covariance of force and torque about another point, `m − c × f`.
fn shifted<T: Real>(covariance: &Matrix6<T>, c: &Vector3<T>) -> Matrix6<T> {
    let mut transport = Matrix6::identity();
    transport.fixed_view_mut::<3, 3>(3, 0).copy_from(&-c.cross_matrix());
    transport * covariance * transport.transpose()
}
