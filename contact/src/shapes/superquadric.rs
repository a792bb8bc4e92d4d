//! The superquadric.

use crate::uncertainty::geometry::stretched;
use fingertip_surfaces::numeric::mixed_precision::is_asked_again;
use fingertip_surfaces::numeric::vectors::{larger, largest, length, smaller, tangents, unit_or, wide};
use fingertip_surfaces::{
    ActiveSurface, ForceLine, Gauge, LocalSurface, Powers, Shortcuts, SmoothSurface, Superquadric,
};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::model::flat;
use crate::soft_finger::closed_form::soft_finger;
use crate::soft_finger::double::{in_type, is_steady, narrow, widened};
use crate::soft_finger::unit_sphere::OnUnitSphere;
use crate::{Search, SoftContact, newton_soft_contacts};

/// Steps of [`quickly`].
const QUICK_STEPS: usize = 12;

/// By how much rounding may grow where [`quickly`] answers; beyond, the contact is refined to the last digit.
const STEADY: f64 = 8.0;

/// Starts, and steps from each, of [`by_normals`].
const STARTS: usize = 4;
const STEPS: usize = 60;

/// The contact on a superquadric: by Newton's method in its point, and where that does not settle, in its normal.
fn search<T: Real>(
    shape: &Superquadric<T>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
    visit: &mut dyn FnMut(SoftContact<T>),
) -> Search<T> {
    let ended = newton_soft_contacts(shape, wrench, last, &mut *visit);
    if matches!(ended, Search::Incomplete)
        && let Some(contact) = by_normals(shape, wrench)
    {
        visit(contact);
        return Search::Complete;
    }
    ended
}

/// The same, in double precision if the type is narrower and the force meets the surface at a flat angle or the spin
/// torque rules: where the surface is bent sharply one way and hardly the other, the digits of a place in single
/// precision do not tell its normal.
fn search_finely<T: Real>(
    shape: &Superquadric<T>,
    wrench: &Wrench<T>,
    last: Option<&Vector3<T>>,
    visit: &mut dyn FnMut(SoftContact<T>),
) -> Search<T> {
    if !is_asked_again::<T>() {
        return search(shape, wrench, last, visit);
    }
    let steady = is_steady(wrench, shape.semi_axes().min());
    let mut found = None;
    let ended = search(shape, wrench, last, &mut |contact| found = Some(contact));
    if let Some(contact) = found.filter(steady) {
        visit(contact);
        return ended;
    }
    let Some(double) = shape.in_double() else { return ended };
    let last = last.map(wide);
    in_type(search(&double, &widened(wrench), last.as_ref(), &mut |contact| visit(narrow(&contact))))
}

/// The contact of a force that presses steeply, by Newton's method on the surface.
///
/// It begins where the contact would be on the ellipsoid with the same semi-axes
/// (`docs/theory/contact.md#central-quadrics`), and where the force pulls there, where the normal is the one that it would
/// have on the ellipsoid. Where steps from there lead to where the force pulls, it begins once more where the line of action
/// enters. The last step, of which the square is nothing, is not evaluated. On a convex body any contact that presses is the
/// only one; `None` where the steps do not settle, where rounding grows, and of numbers that carry more than a value, such as
/// dual ones: the steps that are enough for the value are too few for its derivative.
#[inline(never)]
fn quickly<T: Real>(shape: &Superquadric<T>, push: &ForceLine<T>) -> Option<SoftContact<T>> {
    if T::CARRIES_MORE {
        return None;
    }
    // In units of its size and of the force no square leaves the range.
    let (force, torque) = (push.force(), push.torque());
    let (strength, unit) = (force.amax().normalising_factor(), shape.semi_axes().amax().normalising_factor());
    let (scaled, f, m) = (shape.scaled(unit), force * strength, torque * (strength * unit));
    let arrival =
        from_ellipsoid(&scaled, &f, &m).or_else(|| from_entry(shape, push, unit, (&scaled, &f, &m)))?;
    let place = arrival.place + arrival.step;
    let turned = arrival.normal + arrival.turn;
    let normal = turned / turned.norm_squared().root();
    let (spin, pressing) = (normal.dot(&(m - place.cross(&f))), -f.dot(&normal));
    // By how much the contact answers to a torque, times the torque that rounding of a place makes.
    let (whole, twist) = (f.norm_squared().root(), (spin * arrival.steepest).abs());
    let growth = (twist + pressing) * (twist + whole) * arrival.inverse;
    let steep = pressing >= larger(whole, twist) * flat();
    let spins_little = spin.abs() <= whole * place.amax();
    // A determinant beyond the range makes steps of zero.
    let steady = steep & spins_little & (growth <= T::literal(STEADY)) & (arrival.inverse > T::zero());
    let point = place / unit;
    let spin_torque = normal.dot(&(torque - point.cross(&force)));
    steady.then_some(SoftContact { point, normal, spin_torque, active: true })
}

/// A place of the surface, the last step away from it, and how the normal turns on that.
struct Arrival<T: Real> {
    place: Vector3<T>,
    step: Vector3<T>,
    normal: Vector3<T>,
    turn: Vector3<T>,
    /// One over the determinant of the equations; zero of one that is beyond the range.
    inverse: T,
    /// The sum of the curvatures.
    steepest: T,
}

/// From the place of the contact on the ellipsoid with the same semi-axes, or of its normal.
#[inline(always)]
fn from_ellipsoid<T: Real>(shape: &Superquadric<T>, f: &Vector3<T>, m: &Vector3<T>) -> Option<Arrival<T>> {
    let axes = shape.semi_axes();
    let on_sphere = on_ellipsoid(&axes, f, m);
    let with_its_normal = || shape.farthest_along(&on_sphere.component_div(&axes)).1;
    arrive(shape, f, m, on_sphere.component_mul(&axes), Some(with_its_normal))
}

/// From where the line of action enters: there the force presses, and little spin is left.
#[cold]
#[inline(never)]
fn from_entry<T: Real>(
    shape: &Superquadric<T>,
    push: &ForceLine<T>,
    unit: T,
    (scaled, f, m): (&Superquadric<T>, &Vector3<T>, &Vector3<T>),
) -> Option<Arrival<T>> {
    let entry = shape.shortcuts().sole_entry(push)?;
    arrive(scaled, f, m, entry.point * unit, None::<fn() -> Vector3<T>>)
}

/// Steps to the contact, until one is so fine that its square is nothing, of the size, of the radius of curvature, and of
/// each coordinate; from the start, and where they lead to where the force pulls, once from elsewhere. Powers are quick ones,
/// until a step of these is so fine of the first two that the next one will be.
///
/// At a place `c` of the surface `M = m − c × f` shall be along the normal `n`; a step `a` across it has
/// `(τ W + f·n n×) a = M` in the plane across, with `τ = n·M` (`docs/theory/contact.md#general-surfaces`). The Hessian of
/// the gauge, over the gradient's length, is `W = k₁ q qᵀ + k₂ s sᵀ`, and so
///
/// ```text
/// a = (τ Σ kᵢ (n × qᵢ)(n × qᵢ)·M + f·n n × M)/(τ² k₁ k₂ (n·(q × s))² + (f·n)²)
/// ```
///
/// which is written here for the gradient `g` in place of `n`. Behind a step the place is brought back along the ray from
/// the centre, which takes no evaluation: of a gauge the gradient is the same there, and the Hessian as much larger as the
/// place is nearer.
#[inline(always)]
fn arrive<T: Real>(
    shape: &Superquadric<T>,
    f: &Vector3<T>,
    m: &Vector3<T>,
    start: Vector3<T>,
    mut elsewhere: Option<impl FnOnce() -> Vector3<T>>,
) -> Option<Arrival<T>> {
    let mut c = start;
    let (mut powers, mut fine) = (Powers::Quick, Powers::Quick.fine());
    for _ in 0..QUICK_STEPS {
        let Gauge { value, inverse: shrink, gradient: g, bends: [(k1, q), (k2, s)] } =
            shape.gauge_near(&c, powers);
        c *= shrink;
        let rest = m - c.cross(f);
        let (pulling, turning) = (f.dot(&g), g.dot(&rest) * value);
        if pulling > T::zero() {
            c = elsewhere.take()?();
            continue;
        }
        // With the spin times the square of g, for which then no division is waited.
        let square = g.norm_squared();
        let (beside_q, beside_s) = (g.cross(&q), g.cross(&s));
        let volume = g.dot(&q.cross(&s));
        let across = beside_q * (k1 * beside_q.dot(&rest)) + beside_s * (k2 * beside_s.dot(&rest));
        let pulling = pulling * square;
        let determinant = (turning * k1 * volume) * (turning * k2 * volume) + pulling * pulling;
        let step = (across * turning + g.cross(&rest) * pulling) * (square / determinant);
        let per_square = T::one() / square;
        let inverse = per_square.root();
        let trace = k1 * beside_q.norm_squared() + k2 * beside_s.norm_squared();
        let steepest = trace * value * per_square * inverse;
        let size_squared = step.norm_squared();
        let reach = c.amax();
        // Next to a plane of two axes the curvature changes within as much as the place is away from it.
        let within = (0..3).fold(true, |within, k| within & (step[k].abs() <= c[k].abs() * fine));
        let finest = smaller(reach, T::one() / steepest) * fine;
        let settled = size_squared <= finest * finest;
        if settled & (powers == Powers::Quick) {
            powers = Powers::of_last_step::<T>();
            fine = powers.fine();
        } else if settled & within {
            let n = g * inverse;
            let bend = value * inverse;
            let turn = q * (k1 * bend * q.dot(&step)) + s * (k2 * bend * s.dot(&step));
            return Some(Arrival {
                place: c,
                step,
                normal: n,
                turn: turn - n * n.dot(&turn),
                inverse: square * square * square / determinant,
                steepest,
            });
        }
        // A long step would lead to where the surface is another one. False for a NaN, too.
        let most = reach * T::literal(0.5);
        c += if size_squared <= most * most { step } else { step * (most / size_squared.root()) };
    }
    None
}

/// The normal on the unit sphere that the ellipsoid with these semi-axes is brought to.
#[inline(always)]
fn on_ellipsoid<T: Real>(axes: &Vector3<T>, f: &Vector3<T>, m: &Vector3<T>) -> Vector3<T> {
    let product = axes.x * axes.y * axes.z;
    let (force, torque) = (f.component_div(axes), m.component_mul(axes) / product);
    let scale = larger(largest(&force), largest(&torque)).normalising_factor();
    let (force, torque) = (force * scale, torque * scale);
    OnUnitSphere::new(&force, &torque, force.norm_squared(), force.dot(&torque)).point()
}

/// The contact, by Newton's method in its normal `n`: the point is the gradient of the support function `h(n)`, and
/// `M = m − ∇h(n) × f` shall be along `n`.
///
/// With a turn `d` across `n` the point moves by `H d`, `H` being the Hessian of `h`, so that in the plane across `n`
/// `(τ + f·n J₂ H) d = M`, `τ = n·M`, `J₂` turning by a right angle. Its determinant `τ² + (f·n)² det H` is not small
/// where the surface is bent so sharply that its own curvature is infinite, and `H` zero: there Newton's method in
/// the point has no step to take (`docs/theory/contact.md#general-surfaces`). The support function of a superquadric is the gauge of the one with the reciprocal
/// semi-axes and the exponents `2 − e` (the dual norms). `None` unless the equations hold up to rounding, and the
/// force presses.
#[cold]
#[inline(never)]
fn by_normals<T: Real>(shape: &Superquadric<T>, wrench: &Wrench<T>) -> Option<SoftContact<T>> {
    let unit = largest(&shape.semi_axes()).normalising_factor();
    let two = T::one() + T::one();
    let axes = shape.semi_axes() * unit;
    let polar = Superquadric::new(axes.map(|a| T::one() / a), shape.exponents().map(|e| two - e)).ok()?;
    let lever = wrench.torque() * unit;
    let scale = largest(&wrench.force()).max(largest(&lever)).normalising_factor();
    let (f, m) = (wrench.force() * scale, lever * scale);
    let power = f.dot(&m);
    // Of the torque, towards the side that presses.
    let by_torque = m * -power.signum();
    let starts = [by_torque, -f, by_torque - f * largest(&axes), f.cross(&m)];
    let size = length(&m) + length(&f) * largest(&axes);
    for start in starts.into_iter().take(STARTS) {
        let mut n = unit_or(&start, Vector3::z);
        let mut before = T::GREATEST;
        for _ in 0..STEPS {
            let level = polar.level(&n);
            let rest = m - level.gradient.cross(&f);
            let spin = n.dot(&rest);
            let aside = rest - n * spin;
            let left = length(&aside);
            let pressing = f.dot(&n);
            if left <= size * T::EPSILON * T::literal(16.0) && pressing < T::zero() {
                return Some(SoftContact {
                    point: level.gradient / unit,
                    normal: n,
                    spin_torque: spin / scale / unit,
                    active: true,
                });
            }
            let (e1, e2) = tangents(&n);
            let (h1, h2) = (level.hessian * e1, level.hessian * e2);
            let (h11, h12, h22) = (e1.dot(&h1), e1.dot(&h2), e2.dot(&h2));
            let (r1, r2) = (e1.dot(&aside), e2.dot(&aside));
            // (H d) × f across n: f·n times (e1·… = (H d)₂, e2·… = −(H d)₁).
            let (j11, j12) = (spin + pressing * h12, pressing * h22);
            let (j21, j22) = (-pressing * h11, spin - pressing * h12);
            let determinant = j11 * j22 - j12 * j21;
            let turn = (e1 * (j22 * r1 - j12 * r2) + e2 * (j11 * r2 - j21 * r1)) / determinant;
            let angle = length(&turn);
            if !angle.is_number() {
                break;
            }
            // Half a radian at most, and less where the last step did not help.
            let most = if left < before { T::literal(0.5) } else { T::literal(0.1) };
            before = left;
            n = unit_or(&(n + turn * (most / angle).min(T::one())), Vector3::z);
        }
    }
    None
}

soft_finger!(
    Superquadric,
    |shape, wrench, last, visit| search_finely(shape, wrench, last, &mut visit),
    sole | shape,
    push | quickly(shape, push),
    all in double | shape,
    wrench,
    visit | Some(search(&shape.in_double()?, wrench, None, visit)),
    patch | shape,
    _ | shape.in_double().map(LocalSurface::Superquadric),
    // The three semi-axes (its exponents are chosen, not measured). As for any level function of `x/a`:
    // `∂S/∂a_i = −g_i x_i/a_i`, `∂g/∂a_i = −(g_i + x_i H) e_i/a_i`.
    sizes | shape,
    size,
    point | (size < 3).then(|| stretched(&shape.level(point), point, size, shape.semi_axes()[size]))
);
