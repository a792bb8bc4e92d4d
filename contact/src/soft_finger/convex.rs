//! The one contact on a convex surface, by following a path that cannot end.

use fingertip_surfaces::SmoothSurface;
use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::newton::{Place, Problem, State};
use super::unit_sphere::OnUnitSphere;

impl<T: Real, S: SmoothSurface<T>> Problem<'_, T, S> {
    /// The contact that presses, on a convex surface: Newton from the start, and if that does not
    /// end in it, along a path of problems that begins with one whose solution is the start.
    ///
    /// At the start `c₀` the force presses, and with `τ₀ = f·m/f·n₀` it solves the problem with
    /// the torque `m₀ = c₀ × f + τ₀ n₀`, for which `f·m₀ = f·m`. On the way from `m₀` to `m`
    /// along a straight line, `f·m` stays what it is. If it is not zero, no solution on the way
    /// can leave the side that presses (there `f·n = 0` and so `f·m = τ f·n = 0`), none can run
    /// to infinity (the surface is bounded, and `|τ| ≤ |m| + |c||f|`), and the Jacobian is
    /// regular, since `τ²κ + (f·n)² > 0` for `κ ≥ 0`. So the solution continues along the whole
    /// line, and as a convex surface has only one that presses, its end is the answer
    /// (`docs/theory/contact.md#uniqueness`). If `f·m = 0` the torques of lines that hit the body form a
    /// convex set, and the same holds from an entry to an entry.
    pub(crate) fn on_convex(&self, start: Place<T>) -> Option<State<T>> {
        let spin = self.spin_at(&start)?;
        if let Some(state) = self.newton(start, spin, &self.torque, 24)
            && state.converged
            && self.presses(&state)
        {
            return Some(state);
        }
        self.follow(start, spin)
    }

    /// The contact, if Newton finds it from where it would be if the surface were the ball around it.
    pub(crate) fn starting_on_ball(&self) -> Option<State<T>> {
        let direction = direction_on_ball(&self.force, &self.torque);
        // Onto the surface along the ray from the centre, roughly.
        let mut place = self.place(direction * self.reach)?;
        for _ in 0..2 {
            let drop = place.height / place.normal.dot(&direction);
            if !(drop.abs() > T::literal(0.05)) {
                break;
            }
            place = self.place(place.point - direction * drop)?;
        }
        let state = self.newton(place, self.spin_at(&place)?, &self.torque, 12)?;
        // What a level function does beyond its extent is not known.
        let near = state.place.point.norm_squared() <= self.reach * self.reach * T::literal(1.01);
        (state.converged && near && self.presses(&state)).then_some(state)
    }

    fn follow(&self, start: Place<T>, spin: T) -> Option<State<T>> {
        let half = T::literal(0.5);
        let torque_at_start = start.point.cross(&self.force) + start.normal * spin;
        let way = self.torque - torque_at_start;
        let mut done = T::zero();
        let mut stride = half;
        let mut at: (Place<T>, T) = (start, spin);
        for _ in 0..192 {
            let next = (done + stride).min(T::one());
            let torque = if next < T::one() { torque_at_start + way * next } else { self.torque };
            match self.newton(at.0, at.1, &torque, if next < T::one() { 8 } else { 16 }) {
                Some(state) if state.converged && self.presses(&state) => {
                    if !(next < T::one()) {
                        return Some(state);
                    }
                    at = (state.place, state.spin);
                    done = next;
                    stride += stride;
                }
                _ => {
                    stride *= half;
                    if stride < T::EPSILON {
                        return None;
                    }
                }
            }
        }
        None
    }
}

/// The place where the unit sphere's closed form would put the contact, seen from the centre: a
/// start that is good where the spin torque rules, and exact on a sphere.
pub(crate) fn direction_on_ball<T: Real>(force: &Vector3<T>, torque: &Vector3<T>) -> Vector3<T> {
    let squared = force.norm_squared();
    OnUnitSphere::new(force, torque, squared, force.dot(torque))
        .unless_grazing(force, torque, squared.root(), T::EPSILON)
        .map_or_else(|[point, _]| point, |solved| solved.point())
}

#[cfg(test)]
mod tests {
    use fingertip_wrench::Wrench;
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::Problem;
    use fingertip_surfaces::{ActiveSurface, Ellipsoid};

    use crate::{ContactModel, SoftFinger};

    /// From any place where the force presses the path leads to the contact, as far as it may be.
    #[test]
    fn the_path_leads_to_the_contact_from_anywhere() {
        let mut random = Pcg64Mcg::seed_from_u64(41);
        let surface = Ellipsoid::new(Vector3::new(0.5, 0.7, 1.0)).unwrap();
        let mut followed = 0;
        for _ in 0..300 {
            let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
            let (force, torque, from): (Vector3<f64>, Vector3<f64>, Vector3<f64>) = (any(), any(), any());
            let wrench = Wrench::on_fingertip(force, torque);
            let contact = *SoftFinger::new(0.0)
                .unwrap()
                .without_friction_limit()
                .resolve(&wrench, &surface)
                .contact()
                .unwrap();
            let problem = Problem::new(&surface, &force, &torque);
            // Onto the ellipsoid, and to the side on which the force presses.
            let start = from.component_mul(&surface.semi_axes()) / from.norm();
            let start = if surface.normal(&start).dot(&force) < 0.0 { start } else { -start };
            if surface.normal(&start).dot(&force) > -0.2 * force.norm() || force.dot(&torque).abs() < 1e-2 {
                continue;
            }
            let start = problem.place(problem.inward(&start)).unwrap();
            let state = problem.follow(start, problem.spin_at(&start).unwrap()).unwrap();
            let found = problem.contact(&state);
            assert!((found.point - contact.point).norm() < 1e-12, "{wrench:?} {found:?} {contact:?}");
            followed += 1;
        }
        assert!(followed > 150, "{followed}");
    }
}
