//! The torus: every contact, as a root of a function of one angle.

mod eighths;
mod ring;
mod spheres;
mod zeros;

use fingertip_surfaces::numeric::mixed_precision::is_asked_again;
use fingertip_surfaces::numeric::vectors::{larger, largest, unit_or};
use fingertip_surfaces::{ActiveSurface, LocalSurface, SmoothSurface, Torus};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use self::ring::{Ring, Touch};
use self::spheres::Around;
use self::zeros::{Doubts, MOST};
use crate::soft_finger::closed_form::{is_pure_force_of, is_surely_twisted, soft_finger};
use crate::soft_finger::double::{in_type, narrow, widened};
use crate::soft_finger::newton::Problem;
use crate::{GeometrySensitivity, Search, SoftContact};

/// The soft-finger contacts on a torus.
///
/// A contact has the place `c = R ρ + r n` with `ρ = (cos θ, sin θ, 0)` and a normal `n` across the
/// tangent `t = (−sin θ, cos θ, 0)` of the ring. So the equations `τ n + c × f = m` read
///
/// ```text
/// τ n + r n × f = m − R ρ(θ) × f,    n·t(θ) = 0
/// ```
///
/// of which the first is the soft finger on a sphere of radius `r` around a point of the ring: it has
/// one solution `n(θ)` that presses, in closed form, since `f·(m − R ρ × f) = f·m` is the same for
/// all `θ`. The contacts of the torus are therefore exactly the zeros of `F(θ) = n(θ)·t(θ)`, a
/// continuous function on a circle if `f·m ≠ 0`: **simple zeros come in an even number**. (If
/// `f·m = 0`, for all that the numbers of the wrench say, the contacts are where the line of action enters.)
///
/// Squared, that they press taken off, the equations are one polynomial in the angle ([`Ring`]), of which all zeros can be
/// told apart for certain; where two are too near to each other for that, an error, with what [`by_spheres`] begins with.
///
/// `epsilon` is by how much the numbers of the wrench are rounded, relative to them.
fn quickly<T: Real>(
    torus: &Torus<T>,
    wrench: &Wrench<T>,
    epsilon: T,
    visit: &mut dyn FnMut(SoftContact<T>),
) -> Result<(), Around<T>> {
    let (ring, tube) = (torus.ring_radius(), torus.tube_radius());
    // Powers of two, which round nothing.
    let unit = ring.normalising_factor();
    let lever = wrench.torque() * unit;
    let scale = larger(largest(&wrench.force()), largest(&lever)).normalising_factor();
    let (force, torque) = (wrench.force() * scale, lever * scale);
    if is_pure_force_of(&force, &torque, epsilon) {
        entries(torus, wrench, visit);
        return Ok(());
    }
    let mut touches = [Touch::nowhere(); MOST];
    let radii = [ring * unit, tube * unit];
    let narrow = T::EPSILON.to_f64() > f64::EPSILON;
    let mut doubts = if narrow { Doubts::unwanted() } else { Doubts::none() };
    let Some(count) = Ring::contacts(radii, &force, &torque, epsilon, &mut touches, &mut doubts) else {
        let (torque, tube) = (torque / radii[0], tube / ring);
        let power = force.dot(&torque) * tube;
        return Err(Around { force, torque, tube, power, epsilon, scale, doubts });
    };
    for touch in touches.iter().take(count) {
        let [outward, normal] = touch.directions();
        let point = outward * ring + normal * tube;
        visit(SoftContact { point, normal, spin_torque: touch.spin / (unit * scale), active: true });
    }
    Ok(())
}

/// Those of a pure force.
#[cold]
#[inline(never)]
fn entries<T: Real>(torus: &Torus<T>, wrench: &Wrench<T>, visit: &mut dyn FnMut(SoftContact<T>)) {
    let problem = Problem::new(torus, &wrench.force(), &wrench.torque());
    let Ok(axis) = wrench.line_of_action() else { return };
    torus.crossings(&axis.line, |crossing| {
        if crossing.normal.dot(&axis.line.direction) < T::zero() {
            let (point, normal) = (crossing.point, crossing.normal);
            let entry = SoftContact { point, normal, spin_torque: T::zero(), active: true };
            visit(problem.polished(&entry).unwrap_or(entry));
        }
    });
}

/// The same by a search that misses none, however near two of them are: by the spheres around the points of the ring.
///
/// Zeros of `F` are bracketed between samples of it and its derivative; the cells are refined where a
/// cubic through their ends does not tell their middle. `F` has kinks, in the limit of no spin
/// torque, where the line of action touches the sphere, `|m − R ρ × f| = r|f|`; these angles and
/// those at which the line passes the ring most closely are made ends of cells, and so are the ends of the intervals in
/// which the polynomial may have two zeros. Where `F` turns so near
/// zero that the rounding of the wrench reaches it, two contacts merge in a fold: that is one contact.
#[cold]
#[inline(never)]
fn by_spheres<T: Real>(
    torus: &Torus<T>,
    wrench: &Wrench<T>,
    around: &Around<T>,
    visit: &mut dyn FnMut(SoftContact<T>),
) -> Search<T> {
    let (ring, tube) = (torus.ring_radius(), around.tube);
    let problem = Problem::new(torus, &wrench.force(), &wrench.torque());
    let mut search = Search::Complete;
    around.roots(|angle, is_fold| {
        let at = around.at(angle);
        let found = SoftContact {
            point: (at.outward + at.normal * tube) * ring,
            normal: at.normal,
            spin_torque: at.spin * ring / around.scale,
            active: true,
        };
        // A last step on all equations at once takes the rounding of the angle away, and carries the
        // derivative of a dual number.
        match problem.polished(&found) {
            Some(contact) => visit(contact),
            None if is_fold || problem.explains(&found) => visit(found),
            None => search = Search::Incomplete,
        }
    });
    search
}

fn search<T: Real>(
    torus: &Torus<T>,
    wrench: &Wrench<T>,
    epsilon: T,
    visit: &mut dyn FnMut(SoftContact<T>),
) -> Search<T> {
    match quickly(torus, wrench, epsilon, visit) {
        Ok(()) => Search::Complete,
        Err(around) => by_spheres(torus, wrench, &around, visit),
    }
}

/// The same, in double precision if the type is narrower and two contacts are about to merge in a fold: how far
/// they are apart answers to the root of what rounding does. What rounding does to the wrench itself may have
/// made both vanish; then the fold is their contact still. So where the force is a pure one, whose line may graze.
fn on_torus<T: Real>(
    torus: &Torus<T>,
    wrench: &Wrench<T>,
    mut visit: impl FnMut(SoftContact<T>),
) -> Search<T> {
    if !is_asked_again::<T>() {
        return search(torus, wrench, T::EPSILON, &mut visit);
    }
    if is_pure_force_of(&wrench.force(), &wrench.torque(), T::EPSILON) {
        return again(torus, wrench, &mut visit);
    }
    let mut found = [None; MOST];
    let (mut count, mut steady) = (0, true);
    let told = quickly(torus, wrench, T::EPSILON, &mut |contact| {
        let slot = found.get_mut(count);
        steady &= slot.is_some() && !is_folding(torus, &wrench.force(), &contact);
        if let Some(slot) = slot {
            *slot = Some(contact);
            count += 1;
        }
    });
    if told.is_ok() && steady {
        found.into_iter().flatten().for_each(visit);
        return Search::Complete;
    }
    again(torus, wrench, &mut visit)
}

fn again<T: Real>(torus: &Torus<T>, wrench: &Wrench<T>, visit: &mut dyn FnMut(SoftContact<T>)) -> Search<T> {
    let (wide, epsilon) = (widened(wrench), T::EPSILON.to_f64());
    let mut told = |epsilon: f64| {
        let mut any = false;
        let ended = in_double(torus, &wide, epsilon, &mut |contact| {
            any = true;
            visit(narrow(&contact));
        });
        (ended, any)
    };
    let (mut ended, any) = told(epsilon);
    // Numbers as they were told, which no pose has moved.
    if !any && is_surely_twisted(&wide.force(), &wide.torque(), epsilon) {
        (ended, _) = told(f64::EPSILON);
    }
    ended.map_or(Search::Incomplete, in_type)
}

/// In double precision, under a wrench of which the numbers were rounded to so much of them.
#[cold]
#[inline(never)]
fn in_double<T: Real>(
    torus: &Torus<T>,
    wrench: &Wrench<f64>,
    epsilon: f64,
    visit: &mut dyn FnMut(SoftContact<f64>),
) -> Option<Search<f64>> {
    let double = torus.in_double()?;
    let mut any = false;
    let ended = search(&double, wrench, epsilon, &mut |contact| {
        any = true;
        visit(contact);
    });
    if any || !is_pure_force_of(&wrench.force(), &wrench.torque(), epsilon) {
        return Some(ended);
    }
    Some(grazing(&double, wrench, epsilon, visit))
}

/// The contacts of a pure force whose line misses by no more than rounding of its numbers, to so much of them: those that the
/// numbers have by all their digits, next to where the line is closest. Elsewhere a pure force has none.
fn grazing(
    torus: &Torus<f64>,
    wrench: &Wrench<f64>,
    epsilon: f64,
    visit: &mut dyn FnMut(SoftContact<f64>),
) -> Search<f64> {
    let Ok(axis) = wrench.line_of_action() else { return Search::Complete };
    let Some(closest) = torus.closest_approach(&axis.line) else { return Search::Complete };
    let size = torus.ring_radius() + torus.tube_radius();
    let hair = 32.0 * epsilon;
    if !(closest.gap <= hair * size) {
        return Search::Complete;
    }
    // A line that is so near passes as far along a round surface as the root of that.
    let near = size * hair.root() * 2.0;
    search(torus, wrench, f64::EPSILON, &mut |contact| {
        if (contact.point - closest.point).norm() <= near {
            visit(contact);
        }
    })
}

/// Whether `τ²κ + (f·n)²` is nearly nothing for the size of its parts.
fn is_folding<T: Real>(torus: &Torus<T>, force: &Vector3<T>, contact: &SoftContact<T>) -> bool {
    let (c, n) = (contact.point, contact.normal);
    let outward = (c.x * n.x + c.y * n.y) / (c.x * c.x + c.y * c.y);
    let scale = largest(force).normalising_factor();
    let (pressing, spin) = ((force * scale).dot(&n), contact.spin_torque * scale);
    let index = spin * (spin * outward) / torus.tube_radius() + pressing * pressing;
    !(index.abs() >= T::literal(64.0) * T::EPSILON.root() * pressing * pressing)
}

soft_finger!(
    Torus,
    |shape, wrench, _, visit| on_torus(shape, wrench, visit),
    all in double | shape,
    wrench,
    visit | in_double(shape, wrench, T::EPSILON.to_f64(), visit),
    patch | shape,
    _ | Some(LocalSurface::Torus { ring: shape.ring_radius().to_f64(), tube: shape.tube_radius().to_f64() }),
    sizes | shape,
    size,
    point | of_torus(shape, point).get(size).copied()
);

/// The radius of the ring, then that of the tube. A larger ring moves each section of the tube
/// outward.
fn of_torus<T: Real>(shape: &Torus<T>, point: &Vector3<T>) -> [GeometrySensitivity<T>; 2] {
    let normal = shape.normal(point);
    let outward = unit_or(&Vector3::new(point.x, point.y, T::zero()), Vector3::x);
    let level = shape.level(point);
    // The derivative across the tube; that around the ring stays out.
    let around = Vector3::new(-outward.y, outward.x, T::zero());
    let along = around.cross(&normal);
    let turned = -along * (along.dot(&outward) / shape.tube_radius());
    let ring = GeometrySensitivity::of_level(-normal.dot(&outward), &turned, &normal, &level.hessian);
    [ring, GeometrySensitivity::offset()]
}

#[cfg(test)]
mod tests {
    use fingertip_surfaces::numeric::vectors::wide;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    /// Wrenches of contacts on rings from wire to stout, and any at all, with spin torques from next to none to such as
    /// rule.
    fn draw(random: &mut Pcg64Mcg) -> (Torus<f64>, Wrench<f64>) {
        let mut log = |low: f64, high: f64| random.random_range(low.ln()..high.ln()).exp();
        let (ring, strength) = (log(1e-3, 10.0), log(1e-3, 1e3));
        let (tube, spin, any_torque) = (ring * log(0.01, 0.95), log(1e-12, 1e2), log(1e-2, 10.0));
        let mut angle = || random.random_range(0.0..core::f64::consts::TAU);
        let (around, across) = (angle(), angle());
        let outward = Vector3::new(around.cos(), around.sin(), 0.0);
        let normal = outward * across.cos() + Vector3::z() * across.sin();
        let point = outward * ring + normal * tube;
        let mut any = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)).normalize() * strength;
        let (force, other) = (any(), any());
        let force = if force.dot(&normal) > 0.0 { -force } else { force };
        let spin = spin * ring * strength * if other.x > 0.0 { 1.0 } else { -1.0 };
        let torque = if other.y > 0.3 * strength {
            other * (any_torque * ring)
        } else {
            point.cross(&force) + normal * spin
        };
        (Torus::new(ring, tube).unwrap(), Wrench::on_fingertip(force, torque))
    }

    fn all<T: Real>(search: impl FnOnce(&mut dyn FnMut(SoftContact<T>))) -> Vec<SoftContact<f64>> {
        let mut found = Vec::new();
        search(&mut |contact| {
            found.push(SoftContact {
                point: wide(&contact.point),
                normal: wide(&contact.normal),
                spin_torque: contact.spin_torque.to_f64(),
                active: contact.active,
            });
        });
        found
    }

    /// The search by the spheres, in double precision, of a wrench whose numbers are rounded to so much.
    fn by_spheres_alone(torus: &Torus<f64>, wrench: &Wrench<f64>, epsilon: f64) -> Vec<SoftContact<f64>> {
        let ring = torus.ring_radius();
        let (force, torque) = (wrench.force(), wrench.torque() / ring);
        let scale = larger(largest(&force), largest(&torque)).normalising_factor();
        let tube = torus.tube_radius() / ring;
        let (force, torque) = (force * scale, torque * scale);
        let power = force.dot(&torque) * tube;
        let around = Around { force, torque, tube, power, epsilon, scale, doubts: Doubts::none() };
        all(|visit| assert_eq!(by_spheres(torus, wrench, &around, visit), Search::Complete, "{wrench:?}"))
    }

    fn compare(torus: &Torus<f64>, wrench: &Wrench<f64>, found: &[SoftContact<f64>], epsilon: f64) {
        let theirs = by_spheres_alone(torus, wrench, epsilon);
        assert_eq!(found.len(), theirs.len(), "{torus:?} {wrench:?} {found:?} {theirs:?}");
        let size = torus.ring_radius();
        for (ours, theirs) in found.iter().zip(&theirs) {
            // As far as rounding moves a contact of this index; where it is small, two are about to merge.
            let pressing = wrench.force().dot(&theirs.normal).abs() / wrench.force().norm();
            let outward = theirs.point.xy().norm() - size;
            let kappa = outward / torus.tube_radius() / (torus.tube_radius() * theirs.point.xy().norm());
            let spin = theirs.spin_torque / wrench.force().norm();
            let index = (spin * spin * kappa + pressing * pressing).abs();
            let load =
                1.0 + (spin.abs() + wrench.torque().norm() / wrench.force().norm()) / torus.tube_radius();
            let off = (ours.point - theirs.point).norm() / size;
            let allowed = 64.0 * epsilon * load * load / index;
            assert!(
                off <= allowed || off * off <= 64.0 * epsilon * load * load,
                "{off:e} {allowed:e} {torus:?} {wrench:?} {ours:?} {theirs:?}"
            );
        }
    }

    /// How often the polynomial's zeros tell all, of so many wrenches.
    fn same_as_by_spheres(count: u32) -> u32 {
        let mut random = Pcg64Mcg::seed_from_u64(43);
        let mut told = 0;
        for _ in 0..count {
            let (torus, wrench) = draw(&mut random);
            if is_pure_force_of(&wrench.force(), &(wrench.torque() / torus.ring_radius()), f64::EPSILON) {
                continue;
            }
            let mut is_told = false;
            let found = all(|visit| is_told = quickly(&torus, &wrench, f64::EPSILON, visit).is_ok());
            if is_told {
                told += 1;
                compare(&torus, &wrench, &found, f64::EPSILON);
            }
        }
        told
    }

    #[test]
    fn the_polynomial_and_the_spheres_tell_the_same() {
        let told = same_as_by_spheres(30_000);
        println!("{told} of 30000");
        assert!(told > 29_500, "{told}");
    }

    #[test]
    #[ignore = "minutes"]
    fn the_polynomial_and_the_spheres_tell_the_same_of_many() {
        println!("{} of 300000", same_as_by_spheres(300_000));
    }

    fn same_in_single_precision(count: u32) {
        let mut random = Pcg64Mcg::seed_from_u64(47);
        for _ in 0..count {
            let (torus, wrench) = draw(&mut random);
            let single = Torus::new(torus.ring_radius() as f32, torus.tube_radius() as f32).unwrap();
            let narrow = Wrench::on_fingertip(wrench.force().cast::<f32>(), wrench.torque().cast::<f32>());
            let torus = Torus::new(single.ring_radius().into(), single.tube_radius().into()).unwrap();
            let wrench = widened(&narrow);
            // Single precision may take a wrench for a pure force, or not, where it is one nearly.
            if is_pure_force_of(&wrench.force(), &wrench.torque(), 4.0 * f64::from(f32::EPSILON)) {
                continue;
            }
            let found = all(|visit| assert_eq!(on_torus(&single, &narrow, visit), Search::Complete));
            compare(&torus, &wrench, &found, f64::from(f32::EPSILON));
        }
    }

    #[test]
    fn single_precision_finds_what_the_spheres_tell_in_double() {
        same_in_single_precision(30_000);
    }

    #[test]
    #[ignore = "minutes"]
    fn single_precision_finds_what_the_spheres_tell_in_double_of_many() {
        same_in_single_precision(300_000);
    }

    /// Next to where the force grazes a contact that presses and one that pulls are near to each other.
    #[test]
    fn what_pulls_next_to_it_is_not_taken_for_the_contact() {
        let torus = Torus::new(81.160_326_104_076_42_f64, 5.800_686_279_474_982).unwrap();
        let force =
            Vector3::new(3.645_249_858_271_588_7e-10, -1.294_527_456_556_825e-9, 9.818_551_003_683_044e-11);
        let torque =
            Vector3::new(-1.161_562_136_164_198e-8, -8.975_579_816_483_073e-9, -7.521_426_332_502_329e-8);
        let wrench = Wrench::on_fingertip(force, torque);
        // Where it was put, with a spin torque of 2.6e-14 N·m: to be found but for rounding.
        let put = Vector3::new(69.947_234_082_891_94, -42.066_738_435_809_57, -5.782_248_111_588_434);
        let found = all(|visit| assert_eq!(on_torus(&torus, &wrench, visit), Search::Complete));
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found.iter().all(|contact| contact.normal.dot(&force) < 0.0), "{found:?}");
        assert!(found.iter().any(|contact| (contact.point - put).norm() < 1e-11), "{found:?}");
    }
}
