//! The most probable contacts, given a wrench and a tactile array.

use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix3, Matrix5, Matrix6, Matrix6x5, Vector2, Vector3, Vector6};

use super::ArrayContact;
use super::prior::{Prior, State};
use crate::numeric::vectors::length;
use crate::{ActiveSurface, BadShape};

/// Estimates one to four contacts from one wrench and what a tactile array says of each.
///
/// A wrench has six numbers, two hard contacts have ten: the array is needed to tell them apart, the
/// wrench to give them tangential forces, which an array of pressures does not feel. The estimate
/// is the maximum of the posterior (theory 11.3)
///
/// ```text
/// min ‖w − Σ W(c_i) F_i‖²_Σ⁻¹ + Σ ‖c_i − ĉ_i‖²_R_i⁻¹ + Σ (N_i − N̂_i)²/σ_i² + Σ |F_t,i|²/(μ N̂_i)²
/// subject to c_i on the surface
/// ```
///
/// where the last sum stands for what friction says before any measurement. Since each contact's
/// prior is its own, and only the wrench couples them, each step of the Gauss-Newton iteration
/// solves a system of six equations, however many contacts there are. It knows no inequality: an
/// estimate may lie outside its friction cone, by noise or because a contact slides.
/// [`FusedContact::held`] is the nearest force that friction can hold.
///
/// **What cannot be told**: forces that cancel within the grip of one fingertip ([`Fused::internal_forces`]
/// of them). The wrench says nothing of these; what is reported there comes from the array and from
/// the friction prior alone, and [`FusedContact::share_from_wrench`] says how much of a force is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fusion<T: Real> {
    wrench_covariance: Matrix6<T>,
    friction: T,
}

/// One contact of the estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FusedContact<T: Real> {
    /// Where \[m\], on the surface.
    pub point: Vector3<T>,
    /// Outward unit normal there.
    pub normal: Vector3<T>,
    /// Force on the fingertip \[N\].
    pub force: Vector3<T>,
    /// Covariance of the point \[m²\], of rank 2, to first order.
    pub point_covariance: Matrix3<T>,
    /// Covariance of the force \[N²\].
    pub force_covariance: Matrix3<T>,
    /// How much of the variance of the force the wrench removed: 1, nearly all is known from the
    /// wrench; 0, nothing.
    pub share_from_wrench: T,
    /// The force that friction can hold which is nearest to it: the same, unless it lies outside the
    /// friction cone \[N\]. Forces changed so no longer add up to the wrench.
    pub held: Vector3<T>,
}

/// The estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fused<T: Real, const K: usize> {
    /// In the order of the readings.
    pub contacts: [FusedContact<T>; K],
    /// `yᵀS⁻¹y` for the difference between the wrench and what the array alone predicts: follows χ²
    /// with six degrees of freedom if the readings are right. Much more, and a contact is missing.
    pub disagreement: T,
    /// Dimension of the forces that the wrench cannot see: 0, 1, 3, 6 for one to four contacts, one
    /// more for three or four of them in a line.
    pub internal_forces: u8,
    /// `false` if the iteration ended at its bound, or where the readings contradict the wrench by so
    /// much that it found no rest: see [`disagreement`](Self::disagreement).
    pub settled: bool,
}

impl<T: Real> Fusion<T> {
    /// From the covariance of the wrench, which must be positive definite, and the friction
    /// coefficient.
    ///
    /// # Errors
    /// [`BadShape`] otherwise.
    pub fn new(wrench_covariance: Matrix6<T>, friction: T) -> Result<Self, BadShape> {
        let good = wrench_covariance.sum().is_number() && wrench_covariance.cholesky().is_some();
        BadShape::check("fusion", "covariance of the wrench", "positive definite", good)?;
        let good = friction > T::zero() && friction.is_number();
        BadShape::check("fusion", "friction coefficient", "positive and finite", good)?;
        Ok(Self { wrench_covariance, friction })
    }

    /// The most probable contacts.
    ///
    /// # Errors
    /// [`BadShape`] unless there are one to four readings, all of them finite and near the surface,
    /// and a finite wrench.
    pub fn estimate<S: ActiveSurface<T>, const K: usize>(
        &self,
        surface: &S,
        wrench: &Wrench<T>,
        readings: &[ArrayContact<T>; K],
    ) -> Result<Fused<T, K>, BadShape> {
        BadShape::check("fusion", "number of readings", "one to four", (1..=4).contains(&K))?;
        BadShape::check("fusion", "wrench", "finite", wrench.is_finite())?;
        let lost = BadShape { shape: "array contact", parameter: "reading", requirement: "near the surface" };
        let mut priors = [None; K];
        let mut states = [None; K];
        for ((prior, state), reading) in priors.iter_mut().zip(&mut states).zip(readings) {
            let made = Prior::new(surface, reading, self.friction)?;
            *state = made.state(surface, Vector2::zeros(), made.force);
            *prior = Some(made);
        }
        let mut priors_known = 0;
        for (prior, state) in priors.iter().zip(&states) {
            priors_known += usize::from(prior.is_some() && state.is_some());
        }
        if priors_known != K {
            return Err(lost);
        }
        let mut search = Search { fusion: self, wrench: wrench.components(), priors, states };
        let (mut settled, disagreement) = search.step(surface).ok_or(lost)?;
        for _ in 0..60 {
            if settled {
                break;
            }
            // Data that contradict each other by far may drive the estimate off the surface.
            let Some((rested, _)) = search.step(surface) else { break };
            settled = rested;
        }
        let (gain, covariances) = search.factors().ok_or(lost)?;
        let mut contacts = [FusedContact {
            point: Vector3::zeros(),
            normal: Vector3::zeros(),
            force: Vector3::zeros(),
            point_covariance: Matrix3::zeros(),
            force_covariance: Matrix3::zeros(),
            share_from_wrench: T::zero(),
            held: Vector3::zeros(),
        }; K];
        for (i, contact) in contacts.iter_mut().enumerate() {
            let (Some(prior), Some(state)) = (search.priors[i], search.states[i]) else { continue };
            let (covariance, jacobian) = covariances[i];
            let through = jacobian * covariance;
            let posterior: Matrix5<T> = covariance - through.transpose() * gain * through;
            let force_covariance = posterior.fixed_view::<3, 3>(2, 2).into_owned();
            let before = prior.covariance().fixed_view::<3, 3>(2, 2).trace();
            let [t1, t2] = prior.moved_tangents(&state);
            let shift = posterior.fixed_view::<2, 2>(0, 0);
            *contact = FusedContact {
                point: state.point,
                normal: state.normal,
                force: state.force,
                point_covariance: t1 * t1.transpose() * shift[(0, 0)]
                    + (t1 * t2.transpose() + t2 * t1.transpose()) * shift[(0, 1)]
                    + t2 * t2.transpose() * shift[(1, 1)],
                force_covariance,
                share_from_wrench: (T::one() - force_covariance.trace() / before)
                    .max(T::zero())
                    .min(T::one()),
                held: self.project(&state),
            };
        }
        let internal_forces = internal_forces(&contacts);
        Ok(Fused { contacts, disagreement, internal_forces, settled })
    }

    /// The point of the friction cone at a contact that is nearest to its force (theory 5).
    fn project(&self, state: &State<T>) -> Vector3<T> {
        let mu = self.friction;
        let pressing = -state.force.dot(&state.normal);
        let tangential = state.force + state.normal * pressing;
        let magnitude = length(&tangential);
        if magnitude <= mu * pressing {
            return state.force;
        }
        if mu * magnitude <= -pressing {
            return Vector3::zeros();
        }
        let normal = (mu * magnitude + pressing) / (T::one() + mu * mu);
        tangential * (mu * normal / magnitude) - state.normal * normal
    }
}

struct Search<'a, T: Real, const K: usize> {
    fusion: &'a Fusion<T>,
    wrench: Vector6<T>,
    priors: [Option<Prior<T>>; K],
    states: [Option<State<T>>; K],
}

/// Covariance of a contact before the wrench, and the derivatives of its wrench.
type Linear<T> = (Matrix5<T>, Matrix6x5<T>);

impl<T: Real, const K: usize> Search<'_, T, K> {
    /// The inverse covariance of the innovation at the present states, with each contact's
    /// covariance and Jacobian.
    fn factors(&self) -> Option<(Matrix6<T>, [Linear<T>; K])> {
        let mut linear = [(Matrix5::zeros(), Matrix6x5::zeros()); K];
        let mut total = self.fusion.wrench_covariance;
        for (i, slot) in linear.iter_mut().enumerate() {
            let (prior, state) = (self.priors[i].as_ref()?, self.states[i].as_ref()?);
            let covariance = prior.covariance();
            let jacobian = prior.jacobian(state);
            total += jacobian * covariance * jacobian.transpose();
            *slot = (covariance, jacobian);
        }
        Some((total.cholesky()?.inverse(), linear))
    }

    /// One step of Gauss and Newton; `true` if it changed nothing that matters. Also the square
    /// of the innovation.
    fn step<S: ActiveSurface<T>>(&mut self, surface: &S) -> Option<(bool, T)> {
        let (gain, linear) = self.factors()?;
        let mut innovation = self.wrench;
        let mut means = [Vector3::zeros(); K];
        for i in 0..K {
            let (prior, state) = (self.priors[i].as_ref()?, self.states[i].as_ref()?);
            let mean = prior.force;
            means[i] = mean;
            let torque = state.point.cross(&state.force);
            let (f, m) = (state.force, torque);
            innovation -= Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z);
            // Back to the prior's mean along the linear model.
            let back = mean - state.force;
            let offset = nalgebra::Vector5::new(-state.shift.x, -state.shift.y, back.x, back.y, back.z);
            innovation -= linear[i].1 * offset;
        }
        let weighted = gain * innovation;
        let mut calm = true;
        for i in 0..K {
            let (prior, state) = (self.priors[i].as_ref()?, self.states[i].as_ref()?);
            let (covariance, jacobian) = &linear[i];
            let update = covariance * (jacobian.transpose() * weighted);
            let force = means[i] + Vector3::new(update[2], update[3], update[4]);
            let mut shift = Vector2::new(update[0], update[1]);
            if !(force.sum() + shift.sum()).is_number() {
                return None;
            }
            // Not beyond the edge of the shape as seen from the prior.
            let mut next = prior.state(surface, shift, force);
            for _ in 0..12 {
                if next.is_some() {
                    break;
                }
                shift = (shift + state.shift) * T::literal(0.5);
                next = prior.state(surface, shift, force);
            }
            let next = next?;
            let small = T::EPSILON.root() * T::literal(1e-3);
            let deviation = |k: usize| covariance[(k, k)].root();
            calm &= (next.shift - state.shift).amax() <= small * deviation(0).max(deviation(1))
                && (next.force - state.force).amax()
                    <= small * deviation(2).max(deviation(3)).max(deviation(4));
            self.states[i] = Some(next);
        }
        Some((calm, innovation.dot(&weighted)))
    }
}

/// `3K` less the rank of the matrix that takes the forces to the wrench.
fn internal_forces<T: Real, const K: usize>(contacts: &[FusedContact<T>; K]) -> u8 {
    let longest = |from: &Vector3<T>| {
        contacts.iter().map(|c| c.point - from).fold(Vector3::zeros(), |best: Vector3<T>, v| {
            if v.norm_squared() > best.norm_squared() { v } else { best }
        })
    };
    let Some(first) = contacts.first() else { return 0 };
    let span = longest(&first.point);
    let size = span.norm_squared();
    let bent = contacts.iter().any(|c| {
        let across = span.cross(&(c.point - first.point)).norm_squared();
        across > size * size * T::EPSILON
    });
    let rank = match (K, bent, size > T::zero()) {
        (_, _, false) => 3,
        (_, true, _) => 6,
        _ => 5,
    };
    let forces = u8::try_from(3 * K).unwrap_or(u8::MAX);
    forces.saturating_sub(rank)
}
