//! The contacts on a torus as the zeros of a trigonometric polynomial.

use fingertip_surfaces::numeric::vectors::larger;
use fingertip_wrench::Real;
use nalgebra::Vector3;

use super::eighths::Fourth;
use super::zeros::{Cell, Doubts, MOST, approach, isolated};
use crate::soft_finger::refined::renewed;

/// `a₀ + a₁ cos θ + b₁ sin θ`.
type Wave<T> = [T; 3];

/// `a₀ + a₁ cos θ + b₁ sin θ + a₂ cos 2θ + b₂ sin 2θ`.
type Second<T> = [T; 5];

/// Cosine and sine of the angle of the middle of the first eighth, before the first axis, where `zeros` cuts the circle first.
const MIDDLE: [f64; 2] = [0.882_303_549_132_722_9, 0.470_680_833_673_733_4];

/// How often Newton's method is repeated at most.
const STEPS: usize = 6;

/// And how far its first step may lead, in radians.
const NEAR: f64 = 0.02;

/// The equations of the contacts on a torus with a ring of radius `R` and a tube of radius `r`.
///
/// At the angle `θ` around the ring let `ρ`, `t`, `z` be the directions outward, along and up, and `φ` the angle around
/// the tube, `n = ρ cos φ + z sin φ`. With `A = m_t + R f_z` and `B = m_z − R f_t` the equations `τ n + c × f = m` read
///
/// ```text
/// A = r (f_ρ sin φ − f_z cos φ),   m_ρ sin φ − B cos φ = −r f_t,   τ = (m_ρ + c_z f_t) cos φ + (m_z − c_ρ f_t) sin φ
/// ```
///
/// The first two are linear in `cos φ` and `sin φ`: these are `N_c/Δ` and `N_s/Δ` with
///
/// ```text
/// N_s = A B + r² f_t f_z,   N_c = A m_ρ + r² f_t f_ρ,   Δ = r (f_ρ B − f_z m_ρ)
/// ```
///
/// and so every contact, pressing or pulling, is a zero of `G(θ) = N_s² + N_c² − Δ²`, which has nine coefficients
/// (`docs/theory/contact.md#torus`).
pub(super) struct Ring<T: Real> {
    force: Vector3<T>,
    torque: Vector3<T>,
    radius: T,
    tube: T,
    /// `N_s`, `N_c` and `Δ` by the angle from the middle of the first eighth.
    sine: Second<T>,
    cosine: Second<T>,
    common: Second<T>,
    /// As much as the equations of both angles bend, times as steep as they are.
    bend: T,
}

/// A contact by its angles.
#[derive(Clone, Copy)]
pub(super) struct Touch<T: Real> {
    /// Cosine and sine of `θ` and of `φ`.
    around: [T; 2],
    normal: [T; 2],
    pub(super) spin: T,
    /// `−f·n`.
    pressing: T,
}

/// Whether a force presses, and what tells it.
struct Side<T> {
    presses: bool,
    magnitude: T,
}

impl<T: Real> Touch<T> {
    pub(super) fn nowhere() -> Self {
        let zero = T::zero();
        Self { around: [zero; 2], normal: [zero; 2], spin: zero, pressing: zero }
    }

    /// The direction outward from the axis, and the normal.
    pub(super) fn directions(&self) -> [Vector3<T>; 2] {
        let ([c, s], [across, up]) = (self.around, self.normal);
        let outward = Vector3::new(c, s, T::zero());
        [outward, outward * across + Vector3::z() * up]
    }
}

fn product<T: Real>(p: Wave<T>, q: Wave<T>) -> Second<T> {
    let half = T::literal(0.5);
    [
        p[0] * q[0] + half * (p[1] * q[1] + p[2] * q[2]),
        p[0] * q[1] + p[1] * q[0],
        p[0] * q[2] + p[2] * q[0],
        half * (p[1] * q[1] - p[2] * q[2]),
        half * (p[1] * q[2] + p[2] * q[1]),
    ]
}

fn square<T: Real>([a0, a1, b1, a2, b2]: Second<T>) -> Fourth<T> {
    let (half, two) = (T::literal(0.5), T::literal(2.0));
    [
        a0 * a0 + half * (a1 * a1 + b1 * b1 + a2 * a2 + b2 * b2),
        two * a0 * a1 + a1 * a2 + b1 * b2,
        two * a0 * b1 + a1 * b2 - b1 * a2,
        two * a0 * a2 + half * (a1 * a1 - b1 * b1),
        two * a0 * b2 + a1 * b1,
        a1 * a2 - b1 * b2,
        a1 * b2 + b1 * a2,
        half * (a2 * a2 - b2 * b2),
        a2 * b2,
    ]
}

/// `p + k q`, and the greatest that it may be.
fn sum<T: Real>(p: Second<T>, q: Second<T>, k: T) -> (Second<T>, T) {
    let bound = |v: &Second<T>| v.iter().fold(T::zero(), |sum, x| sum + x.abs());
    (core::array::from_fn(|i| p[i] + q[i] * k), bound(&p) + bound(&q) * k.abs())
}

impl<T: Real> Ring<T> {
    /// From the radii of ring and tube, force and torque all of about 1; the coefficients of `G`, and the greatest that
    /// `N_s`, `N_c` and `Δ` may be.
    fn new([radius, tube]: [T; 2], force: &Vector3<T>, torque: &Vector3<T>) -> (Self, Fourth<T>, [T; 3]) {
        let [c, s] = MIDDLE.map(T::literal);
        let turned = |v: &Vector3<T>| Vector3::new(v.x * c + v.y * s, v.y * c - v.x * s, v.z);
        let (f, m) = (turned(force), turned(torque));
        let zero = T::zero();
        let (out, along) = ([zero, f.x, f.y], [zero, f.y, -f.x]);
        let (m_out, lever) = ([zero, m.x, m.y], f * radius);
        let (a, b) = ([lever.z, m.y, -m.x], [m.z, -lever.y, lever.x]);
        let level = |v: Wave<T>| [v[0] * f.z, v[1] * f.z, v[2] * f.z, zero, zero];
        let squared = tube * tube;
        let (sine, most_sine) = sum(product(a, b), level(along), squared);
        let (cosine, most_cosine) = sum(product(a, m_out), product(along, out), squared);
        let (common, most_common) = sum(product(out, b), level(m_out), -T::one());
        let (common, most_common) = (common.map(|x| x * tube), most_common * tube);
        let (p, q, r) = (square(sine), square(cosine), square(common));
        let steep = larger(f.amax(), m.amax()) * T::literal(2.0);
        let ring =
            Self { force: *force, torque: *torque, radius, tube, sine, cosine, common, bend: steep * steep };
        (ring, core::array::from_fn(|i| p[i] + q[i] - r[i]), [most_sine, most_cosine, most_common])
    }

    /// Force and torque outward and along the ring.
    fn parts(&self, [c, s]: [T; 2]) -> [T; 4] {
        let (f, m) = (&self.force, &self.torque);
        [f.x * c + f.y * s, f.y * c - f.x * s, m.x * c + m.y * s, m.y * c - m.x * s]
    }

    /// What is at a zero, of which cosine and sine are given from the middle of the first eighth.
    #[inline(always)]
    fn touch(&self, [c, s]: [T; 2]) -> Touch<T> {
        let [n, m, d] = self.values([c, s]);
        let inverse = T::one() / (n * n + m * m).root().copysign(d);
        let [c0, s0] = MIDDLE.map(T::literal);
        self.loaded([c * c0 - s * s0, c * s0 + s * c0], [m * inverse, n * inverse])
    }

    /// With the spin torque and the force along the normal that belong to the angles.
    #[inline(always)]
    fn loaded(&self, around: [T; 2], [across, up]: [T; 2]) -> Touch<T> {
        let (r, [f_out, f_along, m_out, _]) = (self.tube, self.parts(around));
        let aside = self.torque.z - (self.radius + r * across) * f_along;
        let spin = (m_out + r * up * f_along) * across + aside * up;
        Touch { around, normal: [across, up], spin, pressing: -(f_out * across + self.force.z * up) }
    }

    /// By Newton's method in both angles: it takes the rounding of the zero away, and carries the derivative of a dual
    /// number. And a number with the sign of `τ²κ + (f·n)²`. `None` unless it settles near where it begins.
    #[inline(always)]
    fn polished(&self, touch: &Touch<T>) -> Option<(Touch<T>, T)> {
        let (r, f_up, m_up) = (self.tube, self.force.z, self.torque.z);
        let (mut around, mut normal) = (touch.around, touch.normal);
        let mut most = T::literal(NEAR);
        let mut was_fine = false;
        for _ in 0..STEPS {
            let ([across, up], [f_out, f_along, m_out, m_along]) = (normal, self.parts(around));
            let (c_out, c_up) = (self.radius + r * across, r * up);
            let (e1, e2) = (
                m_along + c_out * f_up - c_up * f_out,
                (m_out + c_up * f_along) * up - (m_up - c_out * f_along) * across,
            );
            let b = m_up - self.radius * f_along;
            let (j11, j12) = (-m_out - r * up * f_along, -r * (f_out * across + f_up * up));
            let (j21, j22) = (m_along * up - (self.radius * across + r) * f_out, m_out * across + b * up);
            let determinant = j11 * j22 - j12 * j21;
            let inverse = T::one() / determinant;
            let turns = [(j12 * e2 - j22 * e1) * inverse, (j21 * e1 - j11 * e2) * inverse];
            let size = larger(turns[0].abs(), turns[1].abs());
            if !(size <= most) {
                return None;
            }
            let (before, lean) = (around, normal);
            (around, normal) = (turned(around, turns[0]), turned(normal, turns[1]));
            if was_fine {
                // A derivative is so one step later than the value, and keeps that.
                let derived = |now: [T; 2], value: [T; 2]| [0, 1].map(|k| renewed(now[k], value[k].to_f64()));
                return Some((self.loaded(derived(around, before), derived(normal, lean)), determinant));
            }
            // What a step leaves is its square, times as much as the equations bend.
            if size * size * self.bend <= T::EPSILON * determinant.abs() {
                if !T::CARRIES_MORE {
                    return Some((self.loaded(around, normal), determinant));
                }
                was_fine = true;
            }
            most = larger(size * T::literal(0.25), T::EPSILON * T::literal(64.0));
        }
        None
    }

    /// Every contact that presses, in the order of the angle, and how many there are; `None` where rounding may have a
    /// say in that.
    ///
    /// `epsilon` is by how much the numbers of the wrench are rounded, if by more than those of the type: then no two
    /// contacts may have vanished by that. Where two zeros may be too near to be told apart, `doubts` says.
    pub(super) fn contacts(
        radii: [T; 2],
        force: &Vector3<T>,
        torque: &Vector3<T>,
        epsilon: T,
        found: &mut [Touch<T>; MOST],
        doubts: &mut Doubts<T>,
    ) -> Option<usize> {
        let (ring, polynomial, bounds) = Self::new(radii, force, torque);
        let bound = bounds.iter().fold(T::zero(), |sum, x| sum + *x * *x);
        // Of the coefficients, of turning and of halving them, and of the wrench.
        let rounding = T::literal(64.0);
        let noise = bound * T::EPSILON * rounding;
        let doubtful = if epsilon > T::EPSILON { bound * epsilon * rounding } else { T::zero() };
        let is_clear =
            |least: T, around: [T; 2], width: T| ring.is_clear(least, around, width, bounds, epsilon);
        let mut cells = [Cell::nowhere(); MOST];
        let count = isolated(polynomial, [noise, doubtful], is_clear, &mut cells, doubts)?;
        let cells = cells.get_mut(..count)?;
        // Where Newton's method in two angles does not settle, it has to begin nearer.
        [1e-3, 1e-6].into_iter().find_map(|fine| {
            approach(polynomial, cells, T::literal(fine))?;
            ring.pressing(cells, found)
        })
    }

    /// On which side the force is, for `f·m > 0` or not: `τ f·n = f·m`, of which the larger factor tells the sign.
    #[inline(always)]
    fn side(&self, touch: &Touch<T>, pulls: bool) -> Side<T> {
        let (spin, along) = (touch.spin, touch.pressing * self.tube);
        let by_spin = spin.abs() > along.abs();
        let presses = if by_spin { (spin > T::zero()) != pulls } else { along > T::zero() };
        Side { presses, magnitude: larger(spin.abs(), along.abs()) }
    }

    /// Of the zeros those that press.
    #[inline(always)]
    fn pressing(&self, cells: &[Cell<T>], found: &mut [Touch<T>; MOST]) -> Option<usize> {
        let pulls = self.force.dot(&self.torque) > T::zero();
        let least = T::EPSILON.root().root() * self.tube * self.force.amax();
        // Without a branch, which no one could foretell.
        let (mut count, mut certain) = (0, true);
        for cell in cells {
            let touch = self.touch(cell.around());
            let side = self.side(&touch, pulls);
            certain &= side.magnitude >= least;
            let presses = side.presses;
            *found.get_mut(count)? = touch;
            count += usize::from(presses);
        }
        let mut sum = 0;
        for touch in found.get_mut(..count)? {
            let (polished, index) = self.polished(touch)?;
            // Next to a grazing force the steps may lead to the neighbour, which pulls.
            certain &= self.side(&polished, pulls).presses;
            *touch = polished;
            sum += if index > T::zero() { 1 } else { -1 };
        }
        // As many of either index, on a ring.
        (certain && sum == 0).then_some(count)
    }

    /// Whether rounding of the wrench makes no zero of `G` on an interval where it is at least `least`, however near it
    /// is: `|N|` and `|Δ|` have to differ by more than that does to them.
    #[cold]
    fn is_clear(&self, least: T, around: [T; 2], width: T, bounds: [T; 3], epsilon: T) -> bool {
        let steepest = bounds.iter().fold(T::zero(), |most, x| larger(most, *x));
        let [n, m, d] = self.values(around);
        // A polynomial of degree 2 changes by no more than twice the sum of its coefficients, an angle by twice `u`.
        let both = n.abs() + m.abs() + d.abs() + steepest * width * T::literal(6.0);
        least > both * steepest * epsilon * T::literal(16.0)
    }

    /// `N_s`, `N_c` and `Δ`.
    #[inline(always)]
    fn values(&self, [c, s]: [T; 2]) -> [T; 3] {
        let (c2, s2) = (c * c - s * s, T::literal(2.0) * c * s);
        [self.sine, self.cosine, self.common]
            .map(|[a0, a1, b1, a2, b2]| a0 + a1 * c + b1 * s + a2 * c2 + b2 * s2)
    }
}

/// A direction turned by a small angle.
#[inline(always)]
fn turned<T: Real>([c, s]: [T; 2], angle: T) -> [T; 2] {
    let squared = angle * angle;
    // The series to the sixth power, of an angle below a hundredth.
    let cosine = T::one()
        - squared
            * (T::literal(0.5) - squared * (T::literal(1.0 / 24.0) - squared * T::literal(1.0 / 720.0)));
    let sine = angle * (T::one() - squared * (T::literal(1.0 / 6.0) - squared * T::literal(1.0 / 120.0)));
    unit([c * cosine - s * sine, s * cosine + c * sine])
}

/// Of length 1 again, of which rounding has taken or to which it has given.
#[inline(always)]
fn unit<T: Real>([c, s]: [T; 2]) -> [T; 2] {
    let share = (T::literal(3.0) - (c * c + s * s)) * T::literal(0.5);
    [c * share, s * share]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of `|N_s| + |N_c| + |Δ| = 12`, which change by 6 times 2 times the width, rounding makes as many times twice their
    /// greatest coefficient.
    #[test]
    fn an_interval_is_clear_above_what_rounding_makes() {
        let level = |value: f64| [value, 0.0, 0.0, 0.0, 0.0];
        let nothing = Vector3::zeros();
        let ring = Ring {
            force: nothing,
            torque: nothing,
            radius: 1.0,
            tube: 0.5,
            sine: level(3.0),
            cosine: level(-4.0),
            common: level(-5.0),
            bend: 0.0,
        };
        let made = (12.0 + 6.0 * 2.0 * 0.1) * 2.0 * 16.0 * f64::EPSILON;
        for (least, clear) in [(1.001 * made, true), (0.999 * made, false)] {
            assert_eq!(
                ring.is_clear(least, [0.6, 0.8], 0.1, [1.0, 2.0, 0.5], f64::EPSILON),
                clear,
                "{least}"
            );
        }
    }
}
