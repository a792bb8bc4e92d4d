//! The state of dynamic friction and its steps.

use fingertip_wrench::Real;
use nalgebra::SVector;

use crate::{Advanced, BristleLaw, Coupled, Drive, Exponential, Integrator, StepForce};

/// A friction law with its state: the deflection z \[m\].
///
/// `D` is the number of dimensions: 1, 2 in the tangent plane, or 3 with spin, whose third
/// components are the spin rate times the torque arm, and the spin torque over the arm.
///
/// # Bounded and passive
/// `|z| ≤ F_s/σ₀` for every step, by the integrator and a radial clamp. The damping term `σ₁ż` is
/// taken as the mean over the step and limited, step by step, to what keeps
/// `h F·v ≥ ½σ₀(|z⁺|² − |z|²)`: with the plain term LuGre itself can give energy at speeds above
/// `4(σ₁+σ₂)g/σ₁²` (`docs/theory/friction.md#passivity`; on passivity also Barabanov & Ortega 2000).
///
/// ```
/// use fingertip_friction::{Bristle, Dahl};
/// use nalgebra::Vector2;
///
/// let mut friction = Bristle::<f64, _, 2>::new(Dahl::new(1e5, 0.5)?);
/// friction.set_load(2.0);
/// let force = friction.step(&Vector2::new(1e-3, 0.0), 1e-4).end;
/// assert!(force.x > 0.0 && force.y == 0.0 && friction.energy() > 0.0);
/// # Ok::<(), fingertip_friction::BadParameter>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bristle<T: Real, Law, const D: usize, Method = Exponential> {
    law: Law,
    deflection: SVector<T, D>,
    load: T,
    _method: core::marker::PhantomData<Method>,
}

/// Parts of a step in which the share that slides changes, beside the last.
const PARTS: u8 = 16;

impl<T: Real, Law: BristleLaw<T>, const D: usize> Bristle<T, Law, D> {
    /// Unstrained, with the exponential step.
    #[inline]
    #[must_use]
    pub fn new(law: Law) -> Self {
        Self::with_method(law)
    }
}

impl<T: Real, Law: BristleLaw<T>, const D: usize, Method: Integrator> Bristle<T, Law, D, Method> {
    /// Unstrained, with a chosen integrator.
    #[inline]
    #[must_use]
    pub fn with_method(law: Law) -> Self {
        Self { law, deflection: SVector::zeros(), load: T::one(), _method: core::marker::PhantomData }
    }

    /// The deflection z \[m\].
    #[inline]
    #[must_use]
    pub const fn deflection(&self) -> &SVector<T, D> {
        &self.deflection
    }

    /// The law.
    #[inline]
    #[must_use]
    pub const fn law(&self) -> &Law {
        &self.law
    }

    /// Sets the normal force \[N\] that multiplies all forces, for a law whose parameters are per
    /// newton of it. A force that does not press, or NaN, counts as zero: nothing then holds the deflection.
    #[inline]
    pub fn set_load(&mut self, normal_force: T) {
        self.load =
            if normal_force > T::zero() && normal_force.is_number() { normal_force } else { T::zero() };
    }

    /// Stored energy `½σ₀|z|²` \[J\].
    #[inline]
    #[must_use]
    pub fn energy(&self) -> T {
        T::literal(0.5) * self.load * self.law.stiffness() * self.deflection.norm_squared()
    }

    /// λ at a velocity, and the deflection `g/σ₀` of steady sliding.
    #[inline]
    fn slide(&self, speed: T, opposed: bool) -> (T, T) {
        let limit = self.law.steady(speed) / self.law.stiffness();
        let share = self.law.plastic_share(length(&self.deflection), opposed, speed);
        ((share * speed / limit).min(T::GREATEST), limit)
    }

    /// Moves by `velocity` over `time_step` and returns the friction force, along the motion that it opposes: a body
    /// that moves over the other feels minus this. The mean over the step is what moves a body and what does work; it is
    /// passive. The force at the end of the step is that of the law itself, for what is shown or compared.
    ///
    /// A motion or time that is not finite (or a negative time) changes nothing; the elastic force
    /// is returned.
    #[inline]
    pub fn step(&mut self, velocity: &SVector<T, D>, time_step: T) -> StepForce<T, D> {
        let path = velocity * time_step;
        let good = time_step >= T::zero()
            && time_step.is_number()
            && velocity.iter().chain(path.iter()).all(|x| x.is_number());
        if !good {
            return StepForce::constant(self.elastic_force());
        }
        if !(self.load > T::zero()) {
            self.deflection = SVector::zeros();
            return StepForce::constant(SVector::zeros());
        }
        let (before, speed) = (self.deflection, length(velocity));
        let Advanced { end: after, mean } = self.advanced(&path, speed, time_step);
        self.deflection = after;

        // The mean damping force over the step, no greater than passivity allows.
        let change = after - before;
        let stiffness = self.law.stiffness();
        let mut damping = self.law.damping() / (stiffness * time_step);
        let power = change.dot(&path);
        if power < T::zero() {
            let half = T::literal(0.5);
            let spare = mean.dot(&path) - half * change.dot(&(after + before));
            damping = damping.min(spare.max(T::zero()) / -power);
        }
        // A step of no time, or of next to none.
        if !damping.is_number() {
            damping = T::zero();
        }
        let viscous = velocity * self.law.viscous();
        let (rate, _) = self.slide(speed, after.dot(velocity) < T::zero());
        // At a rate without bound the deflection is that of steady sliding, which does not change.
        let pace = velocity - after * rate;
        let damped = pace * self.law.damping();
        let damped = if damped.iter().all(|x| x.is_number()) { damped } else { SVector::zeros() };
        StepForce {
            mean: ((mean + change * damping) * stiffness + viscous) * self.load,
            end: (after * stiffness + damped + viscous) * self.load,
        }
    }

    /// The deflection after a step. The share of the motion that slides is that of its start while it does not
    /// change, as in LuGre's law; where it does, the way is divided, and each part takes that of its middle.
    #[inline]
    fn advanced(&self, path: &SVector<T, D>, speed: T, time_step: T) -> Advanced<T, D> {
        let before = self.deflection;
        let (rate, limit) = self.slide(speed, before.dot(path) < T::zero());
        let slide = (rate * time_step).min(T::GREATEST);
        let mut whole = Method::advance(&before, path, slide, limit);
        whole.end = clamped(whole.end, self.greatest_deflection()).0;
        let share = |deflection: &SVector<T, D>| {
            self.law.plastic_share(length(deflection), deflection.dot(path) < T::zero(), speed)
        };
        let same = share(&before) == share(&whole.end);
        if same { whole } else { self.divided(path, speed, limit) }
    }

    /// The same in parts, each no longer than a sixteenth of the way after which the deflection is near that of steady
    /// sliding; the last takes what is left.
    #[inline(never)]
    fn divided(&self, path: &SVector<T, D>, speed: T, limit: T) -> Advanced<T, D> {
        let way = length(path);
        let settled = length(&self.deflection) + limit * T::literal(3.0);
        let part = (settled / way * T::literal(1.0 / f64::from(PARTS))).min(T::one());
        let (mut left, mut end, mut mean) = (T::one(), self.deflection, SVector::zeros());
        for index in 0..=PARTS {
            let taken = if index < PARTS { part.min(left) } else { left };
            let step = path * taken;
            let middle = clamped(end + step * T::literal(0.5), limit).0;
            let opposed = middle.dot(path) < T::zero();
            let share = self.law.plastic_share(length(&middle), opposed, speed);
            let slide = (share * (way * taken / limit)).min(T::GREATEST);
            let advanced = Method::advance(&end, &step, slide, limit);
            end = clamped(advanced.end, self.greatest_deflection()).0;
            mean += advanced.mean * taken;
            left -= taken;
            if !(left > T::zero()) {
                break;
            }
        }
        Advanced { end, mean }
    }

    /// Releases all deflection.
    #[inline]
    pub fn reset(&mut self) {
        self.deflection = SVector::zeros();
    }

    /// One step of a body of some mass under a drive, held by this friction: one linear solve, no
    /// iteration, passive for every step length: the energy `½mv² + ½σ₀z²` grows by no more than
    /// the work of the drive (`docs/theory/friction.md#a-body-held-by-friction`), thanks to `σ₁ ≤ 4σ₀/λ`. The
    /// friction rate is frozen first at the old and then at the foretold velocity. First order.
    ///
    /// Returns the old velocity and changes nothing where the input is not finite, the time step
    /// not positive or a mass not positive.
    #[inline]
    pub fn step_body(
        &mut self,
        velocity: &SVector<T, D>,
        drive: &Drive<T, D>,
        time_step: T,
    ) -> Coupled<T, D> {
        let finite = |v: &SVector<T, D>| v.iter().all(|x| x.is_number());
        let good = drive.mass.iter().all(|m| *m > T::zero() && m.is_number())
            && drive.stiffness >= T::zero()
            && drive.stiffness.is_number()
            && time_step > T::zero()
            && time_step.is_number();
        if !good {
            return Coupled { velocity: *velocity, friction: self.elastic_force() };
        }
        let foretold = self.solve(velocity, velocity, drive, time_step);
        let (end, keep, damping) = self.solve(velocity, &foretold.0, drive, time_step);
        // As it is where velocity or force were not.
        if !finite(&end) {
            return Coupled { velocity: *velocity, friction: self.elastic_force() };
        }
        let before = self.deflection;
        let after = (before + end * time_step) * keep;
        let friction = (after * self.law.stiffness()
            + (after - before) * (damping / time_step)
            + end * self.law.viscous())
            * self.load;
        self.deflection = clamped(after, self.greatest_deflection()).0;
        if self.load <= T::zero() {
            self.deflection = SVector::zeros();
        }
        Coupled { velocity: end, friction }
    }

    /// The velocity at the end, `1/(1+hλ)`, and the damping used, with λ at the velocity `at`.
    #[inline]
    fn solve(
        &self,
        velocity: &SVector<T, D>,
        at: &SVector<T, D>,
        drive: &Drive<T, D>,
        h: T,
    ) -> (SVector<T, D>, T, T) {
        let (rate, _) = self.slide(length(at), self.deflection.dot(at) < T::zero());
        let keep = T::one() / (T::one() + h * rate);
        let stiffness = self.law.stiffness();
        // Where nothing slides the bound is infinite.
        let damping = self.law.damping().min(T::literal(4.0) * stiffness / rate);
        let combined = h * stiffness + damping;
        let added = (h * combined * keep + h * self.law.viscous()) * self.load + h * h * drive.stiffness;
        let held = self.deflection * (self.load * (damping - combined * keep));
        let end = SVector::from_fn(|i, _| {
            (drive.mass[i] * velocity[i] + h * drive.force[i] + held[i]) / (drive.mass[i] + added)
        });
        (end, keep, damping)
    }

    #[inline]
    fn greatest_deflection(&self) -> T {
        self.law.greatest() / self.law.stiffness()
    }

    #[inline]
    fn elastic_force(&self) -> SVector<T, D> {
        self.deflection * (self.law.stiffness() * self.load)
    }
}

/// Euclidean length without over- or underflow.
#[inline]
fn length<T: Real, const D: usize>(v: &SVector<T, D>) -> T {
    let scale = v.amax().normalising_factor();
    (v * scale).norm_squared().root() / scale
}

/// The vector, shortened to `limit` where it is longer, and whether it was.
#[inline]
pub(super) fn clamped<T: Real, const D: usize>(v: SVector<T, D>, limit: T) -> (SVector<T, D>, bool) {
    let length = length(&v);
    if length <= limit {
        (v, false)
    } else {
        let scale = v.amax().normalising_factor();
        (v * scale * (limit / (length * scale)), true)
    }
}

/// How a state is written: its law, its deflection and its load. The integrator is a type, and is
/// not.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(
    deny_unknown_fields,
    bound(
        serialize = "T: serde::Serialize, Law: serde::Serialize",
        deserialize = "T: serde::Deserialize<'de>, Law: serde::Deserialize<'de>"
    )
)]
struct Parts<T: Real, Law, const D: usize> {
    law: Law,
    #[serde(rename = "deflection_m")]
    deflection: SVector<T, D>,
    load: T,
}

#[cfg(feature = "serde")]
impl<T, Law, const D: usize, Method> serde::Serialize for Bristle<T, Law, D, Method>
where
    T: Real + serde::Serialize,
    Law: Clone + serde::Serialize,
{
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (law, deflection, load) = (self.law.clone(), self.deflection, self.load);
        Parts { law, deflection, load }.serialize(serializer)
    }
}

#[cfg(feature = "serde")]
impl<'de, T, Law, const D: usize, Method> serde::Deserialize<'de> for Bristle<T, Law, D, Method>
where
    T: Real + serde::Deserialize<'de>,
    Law: BristleLaw<T> + serde::Deserialize<'de>,
    Method: Integrator,
{
    fn deserialize<S: serde::Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        let Parts::<T, Law, D> { law, deflection, load } = serde::Deserialize::deserialize(deserializer)?;
        let mut bristle = Self::with_method(law);
        if !(load >= T::zero() && load.is_number()) {
            return Err(serde::de::Error::custom("the load of a bristle must be finite and not negative"));
        }
        // What the steps keep, to rounding.
        let greatest = bristle.greatest_deflection() * (T::one() + T::literal(16.0) * T::EPSILON);
        if !(length(&deflection) <= greatest) {
            return Err(serde::de::Error::custom("the deflection of a bristle must be within its law"));
        }
        bristle.load = load;
        bristle.deflection = deflection;
        Ok(bristle)
    }
}
