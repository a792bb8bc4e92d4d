//! The most probable contacts, given a wrench and a tactile array.

use fingertip_surfaces::{ActiveSurface, BadShape};
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix3, Matrix4, Matrix5, Matrix6, Matrix6x5, Vector2, Vector3, Vector4, Vector5, Vector6};

use super::ArrayContact;
use super::cone::{Grip, Held, Wall, cone_multipliers, project};
use super::fused::{Fused, FusedContact};
use super::prior::{Prior, State};
use crate::uncertainty::is_covariance;

/// Estimates one to four contacts from one wrench and what a tactile array says of each.
///
/// A wrench has six numbers, two hard contacts have ten: the array is needed to tell them apart, the
/// wrench to give them tangential forces, which an array of pressures does not feel. The estimate
/// is the maximum of the posterior (`docs/theory/contact.md#fusion-with-an-array`)
///
/// ```text
/// min ‖w − Σ W(c_i) F_i‖²_Σ⁻¹ + Σ ‖c_i − ĉ_i‖²_R_i⁻¹ + Σ (N_i − N̂_i)²/σ_i² + Σ |F_t,i|²/(μ N̂_i/2)²
/// subject to c_i on the surface and F_i in its friction cone, |F_t,i| ≤ μ N_i
/// ```
///
/// where the last sum stands for what friction says of a tangential force before any measurement:
/// that it is somewhere in the disc of radius `μ N̂`, which has this variance along each axis.
///
/// Each step of the Gauss-Newton iteration solves a system of six equations, however many contacts
/// there are, since each contact's prior is its own and only the wrench couples them. The friction
/// cones come in as at most one linear inequality for each contact, tangent to its cone, which takes
/// part in a quadratic program with one multiplier per contact, solved exactly; the curvature of the
/// cone enters the step, so it converges as Newton's method does. A contact that would have to pull
/// ends at the tip of its cone: no force. The number of steps is bounded, and nothing is allocated.
///
/// **What cannot be told**: forces that cancel within the grip of one fingertip ([`Fused::internal_forces`]
/// of them). The wrench says nothing of these; what is reported there comes from the array and from
/// friction alone, and [`FusedContact::share_from_wrench`] says how much of a force is.
///
/// ```
/// use fingertip_contact::{ArrayContact, Fusion};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::{Matrix3, Matrix6, Vector3};
///
/// // A ball of 10 mm between two fingers: the array feels 2 N ± 0.2 N on either side.
/// let reading = |x: f64| ArrayContact {
///     centroid: Vector3::new(x, 0.0, 0.0),
///     centroid_covariance: Matrix3::identity() * 1e-8,
///     normal_force: 2.0,
///     normal_deviation: 0.2,
/// };
/// // The wrench, known to 10 mN and 0.1 N·mm, says that together they carry 1 N.
/// let noise = Matrix6::from_diagonal(&[1e-4, 1e-4, 1e-4, 1e-8, 1e-8, 1e-8].into());
/// let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
/// let readings = [reading(0.01), reading(-0.01)];
/// let [right, left] = Fusion::new(noise, 0.5)?.estimate(&Sphere::centred(0.01)?, &wrench, &readings)?.contacts;
/// assert!((right.force - Vector3::new(-2.0, 0.0, -0.5)).norm() < 1e-2);
/// assert!((left.force - Vector3::new(2.0, 0.0, -0.5)).norm() < 1e-2);
/// # Ok::<(), fingertip_surfaces::BadShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fusion<T: Real> {
    wrench_covariance: Matrix6<T>,
    friction: T,
}

impl<T: Real> Fusion<T> {
    /// From the covariance of the wrench, which must be positive definite, and the friction
    /// coefficient.
    ///
    /// # Errors
    /// [`BadShape`] otherwise.
    pub fn new(wrench_covariance: Matrix6<T>, friction: T) -> Result<Self, BadShape> {
        // Of the matrix, the factors see one half only.
        let good = is_covariance(&wrench_covariance) && wrench_covariance.cholesky().is_some();
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
        let grips = [Held::free(); K];
        let mut search = Search { fusion: self, wrench: wrench.components(), priors, states, grips };
        let (mut settled, mut disagreement) = search.step(surface).ok_or(lost)?;
        for _ in 0..60 {
            if settled {
                break;
            }
            // Data that contradict each other by far may drive the estimate off the surface.
            let Some((rested, left)) = search.step(surface) else { break };
            (settled, disagreement) = (rested, left);
        }
        let posteriors = search.posteriors().ok_or(lost)?;
        let mut contacts = [FusedContact {
            point: Vector3::zeros(),
            normal: Vector3::zeros(),
            force: Vector3::zeros(),
            point_covariance: Matrix3::zeros(),
            force_covariance: Matrix3::zeros(),
            share_from_wrench: T::zero(),
            grip: Grip::Sticks,
        }; K];
        for (i, contact) in contacts.iter_mut().enumerate() {
            let (Some(prior), Some(state)) = (search.priors[i], search.states[i]) else { continue };
            let posterior = posteriors[i];
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
                grip: search.grips[i].kind,
            };
        }
        let internal_forces = internal_forces(&contacts);
        Ok(Fused { contacts, disagreement, internal_forces, settled })
    }
}

struct Search<'a, T: Real, const K: usize> {
    fusion: &'a Fusion<T>,
    wrench: Vector6<T>,
    priors: [Option<Prior<T>>; K],
    states: [Option<State<T>>; K],
    grips: [Held<T>; K],
}

/// Covariance of a contact before the wrench, and the derivatives of its wrench.
type Linear<T> = (Matrix5<T>, Matrix6x5<T>);

/// Of all contacts these, their means and the walls that their cones are; and the innovation.
type Linearised<T, const K: usize> = ([Linear<T>; K], [Vector5<T>; K], [Wall<T>; K], Vector6<T>);

impl<T: Real, const K: usize> Search<'_, T, K> {
    /// Covariances of shifts and forces at the present states, with what the wrench says.
    ///
    /// With the gain `K = C Jᵀ S⁻¹`, the covariance is `(I − K J) C (I − K J)ᵀ + K R Kᵀ` for what `R` the innovation has of
    /// the wrench and of the other contacts (Joseph, in Bucy & Joseph 1968): sums of squares, which rounding makes no less
    /// than zero, and the truth for any gain, where `C − K J C` is right for the exact one alone. `None` without a prior or a
    /// state, or where they leave the range.
    fn posteriors(&self) -> Option<[Matrix5<T>; K]> {
        let mut linear = [(Matrix5::zeros(), Matrix6x5::zeros()); K];
        let mut roots = [Matrix5::zeros(); K];
        for i in 0..K {
            let (prior, state) = (self.priors[i].as_ref()?, self.states[i].as_ref()?);
            linear[i] = (prior.covariance(), prior.jacobian(state));
            roots[i] = prior.root();
        }
        let gain = self.gain(&linear)?;
        let wrench = self.fusion.wrench_covariance.cholesky()?.unpack();
        let mut posteriors = [Matrix5::zeros(); K];
        for (i, posterior) in posteriors.iter_mut().enumerate() {
            let (covariance, jacobian) = &linear[i];
            let own = covariance * jacobian.transpose() * gain;
            let of_wrench = own * wrench;
            *posterior = of_wrench * of_wrench.transpose();
            for (j, root) in roots.iter().enumerate() {
                let others = own * linear[j].1;
                let part = if i == j { (Matrix5::identity() - others) * root } else { others * root };
                *posterior += part * part.transpose();
            }
        }
        posteriors.iter().all(|posterior| posterior.sum().is_number()).then_some(posteriors)
    }

    /// The inverse covariance of the innovation.
    fn gain(&self, linear: &[Linear<T>; K]) -> Option<Matrix6<T>> {
        let mut total = self.fusion.wrench_covariance;
        for (covariance, jacobian) in linear {
            total += jacobian * covariance * jacobian.transpose();
        }
        Some(total.cholesky()?.inverse())
    }

    /// The priors about the present states, with the cones' bends in them, the walls that the cones are, and
    /// what the wrench has beyond them all. `None` without a prior or a state.
    fn linearised<S: ActiveSurface<T>>(&self, surface: &S) -> Option<Linearised<T, K>> {
        let mu = self.fusion.friction;
        let mut linear = [(Matrix5::zeros(), Matrix6x5::zeros()); K];
        let mut means = [Vector5::zeros(); K];
        let mut walls = [Wall::none(); K];
        let mut innovation = self.wrench;
        for i in 0..K {
            let (prior, state, held) = (self.priors[i].as_ref()?, self.states[i].as_ref()?, &self.grips[i]);
            let mean = prior.force;
            let (mut covariance, mut mean) =
                (prior.covariance(), Vector5::new(T::zero(), T::zero(), mean.x, mean.y, mean.z));
            if held.kind == Grip::Lifted {
                // No force, and no play in it.
                covariance.fixed_view_mut::<3, 3>(2, 2).fill(T::zero());
                mean.fixed_rows_mut::<3>(2).fill(T::zero());
            } else {
                walls[i] = Wall::new(prior, surface, state, mu);
                // The cone bends away from its tangent plane across the force.
                let lateral = walls[i].lateral * held.bend.root();
                let through = covariance * lateral;
                let gain = through / (T::one() + lateral.dot(&through));
                mean -= gain * lateral.dot(&mean);
                covariance -= gain * through.transpose();
            }
            let jacobian = prior.jacobian(state);
            let (f, m) = (state.force, state.point.cross(&state.force));
            innovation -= Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z) + jacobian * (mean - state.vector());
            linear[i] = (covariance, jacobian);
            means[i] = mean;
        }
        Some((linear, means, walls, innovation))
    }

    /// One step of Gauss and Newton; `true` if it changed nothing that matters. Also the square
    /// of the innovation.
    fn step<S: ActiveSurface<T>>(&mut self, surface: &S) -> Option<(bool, T)> {
        let (linear, means, walls, innovation) = self.linearised(surface)?;
        let gain = self.gain(&linear)?;
        let weighted = gain * innovation;
        // Without the cones; then what they add.
        let mut next = [Vector5::zeros(); K];
        let mut through = [(Vector5::zeros(), Vector6::zeros()); K];
        let (mut matrix, mut beyond) = (Matrix4::identity(), Vector4::zeros());
        for i in 0..K {
            let (covariance, jacobian) = &linear[i];
            next[i] = means[i] + covariance * (jacobian.transpose() * weighted);
            let along = covariance * walls[i].row;
            through[i] = (along, jacobian * along);
            beyond[i] = walls[i].row.dot(&next[i]) - walls[i].level;
            for j in 0..=i {
                let apart = -through[i].1.dot(&(gain * through[j].1));
                let own = if i == j { along.dot(&walls[i].row) } else { T::zero() };
                matrix[(i, j)] = own + apart;
                matrix[(j, i)] = own + apart;
            }
        }
        let exists: [bool; K] = walls.map(|wall| wall.exists);
        let multipliers = cone_multipliers(&matrix, &beyond, &exists);
        let mut pull = Vector6::zeros();
        for i in 0..K {
            pull += through[i].1 * multipliers[i];
        }
        let answer = gain * pull;
        let mut calm = true;
        // The forces that the rounding of the wrench and of the priors is in proportion to.
        let loads = self.priors.iter().flatten().map(|prior| prior.force.amax());
        let loads = loads.fold(self.wrench.fixed_rows::<3>(0).amax(), T::max);
        for i in 0..K {
            let (covariance, jacobian) = &linear[i];
            let update =
                next[i] - through[i].0 * multipliers[i] + covariance * (jacobian.transpose() * answer);
            // What the rest of the world asks of this contact: the slope of the cost by its force.
            let asked = jacobian.transpose() * (weighted + answer);
            let asked = Vector3::new(asked[2], asked[3], asked[4]);
            calm &= self.take(i, surface, &update, &asked, multipliers[i], loads)?;
        }
        Some((calm, innovation.dot(&weighted)))
    }

    /// Takes the update of one contact; `true` if it changes nothing that matters against what is uncertain and
    /// what rounds under these loads. `None` where it leaves the range or the shape.
    fn take<S: ActiveSurface<T>>(
        &mut self,
        i: usize,
        surface: &S,
        update: &Vector5<T>,
        asked: &Vector3<T>,
        multiplier: T,
        loads: T,
    ) -> Option<bool> {
        let mu = self.fusion.friction;
        let (prior, state) = (self.priors[i].as_ref()?, self.states[i].as_ref()?);
        let force = Vector3::new(update[2], update[3], update[4]);
        let mut shift = Vector2::new(update[0], update[1]);
        if !(force.sum() + shift.sum()).is_number() {
            return None;
        }
        // Not beyond the edge of the shape as seen from the prior.
        let mut found = prior.state(surface, shift, force);
        for _ in 0..12 {
            if found.is_some() {
                break;
            }
            shift = (shift + state.shift) * T::literal(0.5);
            found = prior.state(surface, shift, force);
        }
        let mut found = found?;
        let held = Held::after(&self.grips[i], asked, prior, &found, multiplier, mu);
        found.force = match (self.grips[i].kind, held.kind) {
            // Off the tip along the side that gains most, so that the next step knows where to.
            (Grip::Lifted, Grip::Slides) => prior.lightest_on(&found, asked, mu),
            (_, Grip::Sticks) => force,
            (_, kind) => project(&found, mu, kind),
        };
        // Far less than what is uncertain, but no less than what rounding leaves.
        let small = T::EPSILON.root() * T::literal(1e-3);
        let rounding = T::EPSILON * T::literal(64.0);
        let whole = prior.covariance();
        let deviation = |k: usize| whole[(k, k)].root();
        let shifts = deviation(0).max(deviation(1)) * small + found.point.amax() * rounding;
        let forces = deviation(2).max(deviation(3)).max(deviation(4)) * small + loads * rounding;
        let calm = (found.shift - state.shift).amax() <= shifts
            && (found.force - state.force).amax() <= forces
            && held.kind == self.grips[i].kind;
        self.grips[i] = held;
        self.states[i] = Some(found);
        Some(calm)
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
