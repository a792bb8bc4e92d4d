//! Where the true contact on any convex surface can be, whatever the size of the errors.

use fingertip_surfaces::ActiveSurface;
use fingertip_surfaces::numeric::vectors::{hypotenuse, length, tangents};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;

use crate::WorstErrors;

/// A region that certainly holds the true contact: a piece of the round tube about the measured
/// line of action.
///
/// # Theorem
/// Let `B` be a convex body (the model) and `B*` another (the truth) with `B ⊖ ε_s ⊂ B* ⊂ B ⊕ ε_s`
/// (nowhere further than `ε_s` inside or outside). Let `c` on `B*` bear the true force `f`, with
/// `f·n* ≤ 0` for the outward normal `n*` of `B*` at `c`, and `m = c × f`. Let `f' = f + δf`,
/// `m' = m + δm` be measured, `|δf| ≤ ε_f < |f'|`, `|δm| ≤ ε_m`, and `|c| ≤ r`. Count `t` along
/// `u = f'/|f'|` from the point `X` where the measured axis enters `B`; let `y` be the offset of
/// `c` from that axis. Then, with `σ = ε_f/|f'|`:
///
/// 1. `|y| ≤ ε := (ε_m + r ε_f)/|f'|`.
/// 2. If a parallel line with offset `o` enters `B` at `t = a` with normal `n_a` and leaves it at
///    `t = e` with normal `n_e`:
///    `a − (ε_s + ε |n_a × u| + n_a·o)/|n_a·u| ≤ t ≤ e + (ε_s + ε |n_e × u| + n_e·o)/|n_e·u|`.
///    And `−r − X·u ≤ t ≤ r − X·u`, which also serves where a line never leaves, as in a half-space.
/// 3. Let `T` be the upper limit of 2, and let `k` parallel lines through the corners of a regular
///    polygon around the axis, with in-radius `ρ`, all meet `B`, entering by `t = h` at the latest
///    (`h ≥ 0`) and leaving after `t = ê`. If `(ρ − ε_s − ε) √(1−σ²) > T σ` and
///    `h + 2ε_s ≤ ê`, then also
///    `t ≤ (ε/ρ) h + ε_s √(1 + (h/ρ)²)`, provided that this, with `ε_s` more, is below `ê`.
///
/// # Proof
/// 1. `c × f' − m' = c × δf − δm`, and for the point `a` of the axis closest to `c`,
///    `a × f' = m' − p' f'`. So `(c − a) × f' = c × δf − δm + p' f'`, and
///    `c − a = f' × ((c − a) × f')/|f'|² = f' × (c × δf − δm)/|f'|²`.
/// 2. `B` lies behind its supporting plane at the entry, `B*` by at most `ε_s` before it:
///    `n_a·(y − o) + (t − a)(n_a·u) ≤ ε_s`, where `n_a·u < 0` and `n_a·y ≥ −ε |n_a × u|`. At the
///    exit in the same way. And `|c·u| ≤ |c| ≤ r`.
/// 3. `B` is convex and holds the polygon's entries and exits and `X`; so it holds the prism
///    `{|y| ≤ ρ, h ≤ t ≤ ê}` and the cone from `X` to its front face, and `B*` holds both shrunk
///    by `ε_s`. Suppose first `0 < n*·u`. As `f'·n* ≤ δf·n* ≤ ε_f`, `n*·u ≤ σ`, so the part of `n*`
///    across `u` has length at least `√(1−σ²)`. Take the point `q` of the shrunk prism's front that
///    lies furthest in its direction: `0 ≥ n*·(q − c) ≥ (ρ − ε_s − ε)√(1−σ²) − (t − h − ε_s) σ`,
///    and `t ≤ T`: against the premise. The same holds at `n*·u = 0`. So `n*·u < 0`. If now `t`
///    exceeded the limit, the point `q` of the shrunk cone under `c` with that `t` would give
///    `n*·(q − c) = (t_q − t)(n*·u) > 0`, though `q` is in `B*`. ∎
///
/// Only entries of lines and normals are asked of the surface, so it holds for every convex
/// [`ActiveSurface`], with edges too (any normal of the edge will do in 2).
///
/// ```
/// use fingertip_contact::{ConvexBound, WorstErrors};
/// use fingertip_surfaces::Sphere;
/// use fingertip_wrench::Wrench;
/// use nalgebra::Vector3;
///
/// // 1 N through the centre of a sphere of 10 mm; at most 10 mN and 0.1 N·mm are wrong.
/// let wrench = Wrench::on_fingertip(Vector3::new(0.0, 0.0, -1.0), Vector3::zeros());
/// let errors = WorstErrors::of_wrench(0.01, 1e-4);
/// let bound = ConvexBound::new(&Sphere::centred(0.01)?, &wrench, &errors, 0.01).ok_or("no bound")?;
/// // (0.1 N·mm + 10 mm · 10 mN)/1 N across the line, and next to nothing along it.
/// assert!((bound.across - 0.2e-3_f64).abs() < 1e-6 && bound.distance < 0.25e-3 && !bound.past_silhouette);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvexBound<T: Real> {
    /// How far the true contact is at most from the measured line of action \[m\].
    pub across: T,
    /// Where along the force it may be, counted from the reported contact \[m\]; negative is
    /// against the force, outward.
    pub along: [T; 2],
    /// How far it is at most from the reported contact \[m\].
    pub distance: T,
    /// `true` if it cannot be excluded that the true contact lies past the silhouette, where the
    /// measured force would pull: grazing within the errors.
    pub past_silhouette: bool,
}

fn is_valid<T: Real>(errors: &WorstErrors<T>) -> bool {
    let WorstErrors { force, torque, radius, centre } = *errors;
    force.min(torque).min(radius).min(centre) >= T::zero() && (force + torque + radius + centre).is_number()
}

/// Corners of the polygon.
const CORNERS: usize = 8;

impl<T: Real> ConvexBound<T> {
    /// For a measured wrench on a convex surface whose contacts all lie within `reach` \[m\] of the
    /// origin of the sensor frame. Takes nine crossings of lines, or eighteen: a contact that was found to
    /// be nearer to the origin than `reach` has a shorter lever for the error of the force, and so the
    /// theorem is applied once more.
    ///
    /// The reported contact is the entry of the line of action or, if it misses, the point of the
    /// surface closest to it. The errors of radius and centre add up to `ε_s`.
    ///
    /// `None` if the errors are negative or not finite, or that of the force is not smaller than the
    /// force, the wrench is not finite, the line passes further from the surface than the errors explain,
    /// no line near it meets the surface, the line only leaves the body (a half space that is pulled), or
    /// no place is left: the truth is not what the theorem supposes.
    #[must_use]
    pub fn new<S: ActiveSurface<T>>(
        surface: &S,
        wrench: &Wrench<T>,
        errors: &WorstErrors<T>,
        reach: T,
    ) -> Option<Self> {
        let (first, reported) = Self::within(surface, wrench, errors, reach)?;
        let nearer = length(&reported) + first.distance;
        if !(nearer < reach * T::literal(0.9)) {
            return Some(first);
        }
        let (second, _) = Self::within(surface, wrench, errors, nearer)?;
        Some(if second.distance < first.distance { second } else { first })
    }

    /// By the theorem, with the reported contact.
    fn within<S: ActiveSurface<T>>(
        surface: &S,
        wrench: &Wrench<T>,
        errors: &WorstErrors<T>,
        reach: T,
    ) -> Option<(Self, Vector3<T>)> {
        let axis = wrench.line_of_action().ok()?;
        let good = is_valid(errors) && errors.force < axis.force;
        if !good || !reach.is_number() || reach < T::zero() {
            return None;
        }
        let shape = errors.radius + errors.centre;
        let turn = errors.force / axis.force;
        // Rounding moves the line by a few units in the last place of its distance and of the reach.
        let rounding = T::EPSILON * T::literal(16.0) * (reach + axis.line.point.amax());
        let epsilon = (errors.torque + reach * errors.force) / axis.force + rounding;
        let u = axis.line.direction;

        let (origin, reported, gap) = match chord(surface, &axis.line) {
            Met::Through(chord) => (chord.entry, chord.entry, T::zero()),
            Met::Outward => return None,
            Met::Not => {
                let approach = surface.closest_approach(&axis.line)?;
                if !(approach.gap <= epsilon + shape) {
                    return None;
                }
                let foot = axis.line.at((approach.point - axis.line.point).dot(&u));
                (foot, approach.point, approach.gap)
            }
        };
        let height = origin.dot(&u);
        let mut region = Region {
            low: None,
            high: reach - height,
            latest_entry: T::zero(),
            earliest_exit: T::GREATEST,
            epsilon,
            shape,
        };
        let mut all_hit = region.see(surface, &origin, &Vector3::zeros(), &u);
        // Wide enough for the third statement, if the lines meet the surface.
        let sine = turn;
        let cosine = ((T::one() - sine) * (T::one() + sine)).root();
        let depth = region.high.max(T::zero());
        let margin = epsilon + shape;
        let inner = (margin + depth * sine / cosine) * T::literal(1.0625) + rounding + gap;
        let (first, second) = tangents(&u);
        // 1/cos(π/8).
        let outer = inner * T::literal(1.082_392_200_292_394);
        for corner in 0..CORNERS {
            let angle = T::frac_pi_4() * T::literal(corner as f64);
            let offset = (first * angle.cosine() + second * angle.sine()) * outer;
            all_hit &= region.see(surface, &origin, &offset, &u);
        }
        let (low, mut high) = (region.low?.max(-reach - height), region.high);
        let (latest, exit) = (region.latest_entry, region.earliest_exit);
        let slope = latest / inner;
        let rise = slope * epsilon + shape * (T::one() + slope * slope).root();
        let deep_enough = rise + shape <= exit && latest + shape + shape <= exit;
        // Wide enough the polygon is by its making.
        let past_silhouette = !(all_hit && deep_enough && gap.is_zero());
        if !past_silhouette {
            high = high.min(rise);
        }
        let offset = (reported - origin).dot(&u);
        let along = [low - offset - rounding, high - offset + rounding];
        let furthest = along[0].abs().max(along[1].abs());
        let across = epsilon + gap;
        let distance = hypotenuse(furthest, across);
        let bound = Self { across: epsilon, along, distance, past_silhouette };
        (distance.is_number() && along[0] <= along[1]).then_some((bound, reported))
    }
}

/// How a line meets a convex surface.
enum Met<T: Real> {
    Through(Chord<T>),
    /// It leaves and never entered.
    Outward,
    Not,
}

struct Chord<T: Real> {
    entry: Vector3<T>,
    entry_normal: Vector3<T>,
    /// With its normal; none if the line never leaves.
    exit: Option<(Vector3<T>, Vector3<T>)>,
}

fn chord<T: Real, S: ActiveSurface<T>>(surface: &S, line: &Line<T>) -> Met<T> {
    let (mut entry, mut exit) = (None, None);
    surface.crossings(line, |crossing| {
        if crossing.normal.dot(&line.direction) < T::zero() {
            entry = Some((crossing.point, crossing.normal));
        } else {
            exit = Some((crossing.point, crossing.normal));
        }
    });
    match (entry, exit) {
        (Some((entry, entry_normal)), exit) => Met::Through(Chord { entry, entry_normal, exit }),
        (None, Some(_)) => Met::Outward,
        (None, None) => Met::Not,
    }
}

struct Region<T: Real> {
    low: Option<T>,
    high: T,
    latest_entry: T,
    earliest_exit: T,
    epsilon: T,
    shape: T,
}

impl<T: Real> Region<T> {
    /// What the parallel line at an offset tells; `false` if it does not meet the surface.
    fn see<S: ActiveSurface<T>>(
        &mut self,
        surface: &S,
        origin: &Vector3<T>,
        offset: &Vector3<T>,
        u: &Vector3<T>,
    ) -> bool {
        let Met::Through(chord) = chord(surface, &Line { point: origin + offset, direction: *u }) else {
            return false;
        };
        let slack = |normal: &Vector3<T>| {
            let reach =
                self.shape + self.epsilon * normal.cross(u).norm_squared().root() + normal.dot(offset);
            reach / normal.dot(u).abs()
        };
        let entry = (chord.entry - origin).dot(u);
        let low = entry - slack(&chord.entry_normal);
        self.latest_entry = self.latest_entry.max(entry);
        if let Some((exit, normal)) = chord.exit {
            let exit = (exit - origin).dot(u);
            let high = exit + slack(&normal);
            self.earliest_exit = self.earliest_exit.min(exit);
            if high.is_number() {
                self.high = self.high.min(high);
            }
        }
        if low.is_number() {
            self.low = Some(self.low.map_or(low, |known| known.max(low)));
        }
        true
    }
}
