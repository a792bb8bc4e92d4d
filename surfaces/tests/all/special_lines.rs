//! Lines along axes, through centres and edges, in planes of symmetry: where cases are told apart.

use fingertip_surfaces::{ActiveSurface, Crossing, ForceLine, Shortcuts, each_surface};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;

use crate::every_shape::{Shape, approach, crossings, every_shape, l, v};

/// Through round points in round directions.
fn special_lines<T: Real>() -> Vec<Line<T>> {
    let mut lines = Vec::new();
    let points = [-1.0, -0.5, 0.0, 0.5, 1.0, 1.5];
    let round = (0..27).map(|k| [k % 3, k / 3 % 3, k / 9].map(|x| f64::from(x - 1)));
    // The last is along skew axes.
    let directions = round.chain([[1.0, -2.0, 2.0]]);
    for direction in directions.filter(|d| *d != [0.0; 3]) {
        let direction = Vector3::from(direction).normalize().map(T::literal);
        for k in 0..216 {
            let [x, y, z] = [k % 6, k / 6 % 6, k / 36].map(|k| points[k]);
            lines.push(Line { point: v(x, y, z), direction });
        }
    }
    // A part of them, spread over all.
    lines.into_iter().step_by(7).collect()
}

/// Lines beside it, by so little; turned too, which an endless shape would notice far away.
fn neighbours<T: Real>(line: &Line<T>, step: T, is_turned: bool) -> [Line<T>; 4] {
    let turned = if is_turned { step * l(0.25) } else { T::zero() };
    [[0.3, 0.7, -0.4], [-0.6, 0.2, 0.7], [0.4, -0.8, 0.3], [-0.2, -0.4, -0.6]].map(|[x, y, z]| {
        let (aside, turn) = (v::<T>(x, y, z) * step, v::<T>(-y, z, x) * turned);
        Line { point: line.point + aside, direction: (line.direction + turn).normalize() }
    })
}

struct Seen<T: Real> {
    crossings: Vec<Crossing<T>>,
    gap: T,
}

fn look<T: Real>(shape: &Shape<T>, line: &Line<T>) -> Seen<T> {
    let crossings = crossings(&shape.surface, line);
    let found = approach(&shape.surface, line);
    // Nothing is told of an endless side that the line comes ever nearer to.
    let is_apart = crossings.is_empty() && found.point.norm() < l(100.0);
    let gap = if is_apart { found.gap } else { T::zero() };
    Seen { crossings, gap }
}

/// The surface is met within `allowed` of a point, along one direction of several.
fn is_on_surface<T: Real>(shape: &Shape<T>, point: &Vector3<T>, normal: &Vector3<T>, allowed: T) -> bool {
    let directions = [
        *normal,
        normal + v(0.1, 0.0, 0.07),
        normal + v(-0.05, 0.1, -0.1),
        normal - point,
        v(1.0, -2.0, 2.0),
    ];
    directions.iter().any(|direction| {
        let direction = direction.normalize();
        let line = Line { point: *point, direction };
        crossings(&shape.surface, &line).iter().any(|c| c.along.abs() <= allowed)
    })
}

fn check_approach<T: Real>(shape: &Shape<T>, line: &Line<T>, off: T) {
    let found = approach(&shape.surface, line);
    let name = shape.name;
    if found.point.norm() > l(100.0) {
        // An endless side that the line comes ever nearer to.
        return;
    }
    let away = line.point - found.point;
    let away = away - line.direction * away.dot(&line.direction);
    assert!((away.norm() - found.gap).abs() <= off, "{name} {line:?}: {found:?}, {away:?} away");
    assert!(
        (found.normal.norm() - T::one()).abs() <= l::<T>(16.0) * T::EPSILON,
        "{name} {line:?}: {found:?}"
    );
    if found.gap <= T::EPSILON.root() * l(64.0) {
        // It touches, here or far away, where it comes ever nearer to an endless side.
        return;
    }
    let inside = found.point - found.normal * off;
    assert!(
        !shape.told_by_normal || is_on_surface(shape, &inside, &found.normal, off * l(8.0)),
        "{name} {line:?}: {found:?} is not on it"
    );
    if shape.told_by_normal {
        let beside = away - found.normal * found.normal.dot(&away);
        assert!(beside.norm() <= off * l(8.0), "{name} {line:?}: {found:?}, {beside:?} aside");
        let leans = found.normal.dot(&line.direction).abs();
        assert!(leans <= T::EPSILON.root().root() * l(2.0), "{name} {line:?}: {found:?} leans");
    }
}

/// Of a line that crosses squarely: the entry of closed forms is the entry of them all.
fn check_sole_entry<T: Real>(
    shape: &Shape<T>,
    line: &Line<T>,
    seen: &Seen<T>,
    beside: &[Seen<T>],
    off: T,
) -> bool {
    // The strength of the force changes nothing but the parts of it.
    let strength = l::<T>(0.375);
    let push = Wrench::from_force_at(&line.point, line.direction * strength);
    let push = ForceLine::new(&push, ForceLine::least_squared()).unwrap();
    let (entry, closed_convex) =
        each_surface!(&shape.surface, s => (s.shortcuts().sole_entry(&push), s.is_closed_convex()));
    let name = shape.name;
    if closed_convex && let Some(first) = seen.crossings.first() {
        assert_eq!(seen.crossings.len(), 2, "{name} {line:?}");
        let mut in_order = Vec::new();
        shape.surface.crossings(line, |c| in_order.push(c));
        assert_eq!(in_order[0], *first, "{name} {line:?}");
        assert!(in_order.iter().all(|c| c.active));
    }
    let Some(entry) = entry else { return false };
    let into: Vec<_> = seen.crossings.iter().filter(|c| c.normal.dot(&line.direction) < T::zero()).collect();
    if let [crossing] = into[..] {
        let incidence = crossing.normal.dot(&line.direction);
        assert!((entry.point - crossing.point).norm() <= off, "{name} {line:?}: {entry:?} {crossing:?}");
        let same = (entry.incidence_squared - incidence * incidence).abs() <= off;
        assert!(same, "{name} {line:?}: {entry:?} {crossing:?}");
        // Rounding decides on the bounds of what may touch.
        let is_clear =
            beside.iter().all(|b| b.crossings.iter().zip(&seen.crossings).all(|(a, b)| a.active == b.active));
        assert!(entry.active == crossing.active || !is_clear, "{name} {line:?}");
    } else if seen.crossings.is_empty() {
        assert!(!(entry.incidence_squared > off), "{name} {line:?}: {entry:?}");
    }
    true
}

/// What a shape promises by its type.
trait Promise<T: Real> {
    fn is_closed_convex(&self) -> bool;
}

impl<T: Real, S: ActiveSurface<T>> Promise<T> for S {
    fn is_closed_convex(&self) -> bool {
        fn promised<T: Real, K: Shortcuts<T>>(_: &K) -> bool {
            K::CLOSED_CONVEX
        }
        promised::<T, _>(&self.shortcuts())
    }
}

/// Between an entry and the next exit is the inside, and nowhere else.
fn check_inside<T: Real>(shape: &Shape<T>, line: &Line<T>, seen: &Seen<T>) {
    for pair in seen.crossings.windows(2) {
        let enters = pair[0].normal.dot(&line.direction) < T::zero();
        let middle = line.at((pair[0].along + pair[1].along) * l(0.5));
        assert_eq!(shape.surface.contains(&middle), enters, "{} {line:?}", shape.name);
    }
    if let (Some(first), Some(last)) = (seen.crossings.first(), seen.crossings.last()) {
        for along in [first.along - l(0.1), last.along + l(0.1)] {
            assert!(!shape.surface.contains(&line.at(along)), "{} {line:?}", shape.name);
        }
    }
}

fn compare<T: Real>(shape: &Shape<T>, lines: &[Line<T>]) {
    let step = T::EPSILON.root();
    let off = T::EPSILON.root() * T::EPSILON.root().root() * l(4.0);
    let (mut compared, mut entered, mut missed) = (0, 0, 0);
    for line in lines {
        let seen = look(shape, line);
        let beside = neighbours(line, step, shape.bounded).map(|line| look(shape, &line));
        let name = shape.name;
        for other in &beside {
            let far = if shape.bounded { T::zero() } else { l(1e-6) };
            assert!(
                (other.gap - seen.gap).abs() <= step * l(4.0) + far,
                "{name} {line:?}: {} {}",
                other.gap,
                seen.gap
            );
        }
        if seen.crossings.is_empty() {
            missed += 1;
            check_approach(shape, line, off);
        }
        let count = beside[0].crossings.len();
        let square = |c: &Crossing<T>| c.normal.dot(&line.direction).abs() > l(0.02);
        let alike =
            |one: &Crossing<T>, other: &Crossing<T>| (one.point - other.point).norm() <= step * l(256.0);
        let clear = beside.iter().all(|b| b.crossings.len() == count && b.crossings.iter().all(square))
            && (count > 0 || beside.iter().all(|b| b.gap > step * l(16.0)))
            && beside[0].crossings.windows(2).all(|pair| pair[1].along - pair[0].along > step * l(1024.0))
            && beside
                .iter()
                .all(|b| b.crossings.iter().zip(&beside[0].crossings).all(|(one, other)| alike(one, other)));
        if !clear {
            continue;
        }
        compared += 1;
        assert_eq!(
            seen.crossings.len(),
            count,
            "{name} {line:?}: {:?} {:?}",
            seen.crossings,
            beside[0].crossings
        );
        for (k, crossing) in seen.crossings.iter().enumerate() {
            assert!(beside.iter().all(|b| alike(&b.crossings[k], crossing)), "{name} {line:?}: {crossing:?}");
            // Bounds belong to what may touch.
            let touches = beside.iter().all(|b| b.crossings[k].active);
            assert!(crossing.active || !touches, "{name} {line:?}: {crossing:?}");
            let same_side = |b: &Seen<T>| {
                b.crossings[k].normal.dot(&line.direction) * crossing.normal.dot(&line.direction) > T::zero()
            };
            assert!(beside.iter().all(same_side), "{name} {line:?}: {crossing:?}");
            assert!(
                (line.at(crossing.along) - crossing.point).norm() <= off,
                "{name} {line:?}: {crossing:?}"
            );
        }
        let is_smooth = |(one, other): (&Crossing<T>, &Crossing<T>)| one.normal.dot(&other.normal) > l(0.99);
        if !beside.iter().all(|b| b.crossings.iter().zip(&seen.crossings).all(is_smooth)) {
            continue;
        }
        let is_unit = |c: &Crossing<T>| (c.normal.norm() - T::one()).abs() <= l::<T>(64.0) * T::EPSILON;
        assert!(seen.crossings.iter().all(is_unit), "{name} {line:?}: {:?}", seen.crossings);
        entered += usize::from(check_sole_entry(shape, line, &seen, &beside, off) && count > 0);
        if shape.closed {
            check_inside(shape, line, &seen);
        }
    }
    println!("{:25} {compared} compared, {missed} missed, {entered} entered", shape.name);
    assert!(compared * 2 > lines.len(), "{}", shape.name);
}

/// What is told of a special line is what is told of the lines beside it, of which the laws were asked.
fn special_lines_are_like_their_neighbours<T: Real>() {
    let lines = special_lines::<T>();
    let broken: Vec<_> = every_shape::<T>(T::one())
        .iter()
        .filter(|shape| {
            std::panic::catch_unwind(core::panic::AssertUnwindSafe(|| compare(shape, &lines))).is_err()
        })
        .map(|shape| shape.name)
        .collect();
    assert!(broken.is_empty(), "{broken:?}");
}

#[test]
fn special_lines_are_like_their_neighbours_in_double_precision() {
    special_lines_are_like_their_neighbours::<f64>();
}

#[test]
fn special_lines_are_like_their_neighbours_in_single_precision() {
    special_lines_are_like_their_neighbours::<f32>();
}

/// Forces whose square keeps all its digits are taken, from the least to the greatest.
#[test]
fn forces_are_taken_while_their_squares_keep_their_digits() {
    fn check<T: Real>(least: f64, greatest: f64) {
        let taken = |force: f64| {
            let wrench =
                Wrench::on_fingertip(Vector3::new(T::literal(force), T::zero(), T::zero()), Vector3::zeros());
            ForceLine::new(&wrench, ForceLine::least_squared()).is_some()
        };
        assert!(taken(least) && !taken(least * 0.9) && taken(greatest) && !taken(greatest * 1.1));
        assert!(!taken(0.0) && !taken(f64::NAN) && !taken(f64::INFINITY));
    }
    // √(2^-1022 / 2^-104), √((2 − 2^-52) 2^1023 · 2^-104), a hair beside them; so in single precision.
    check::<f64>(2_f64.powi(-459) * 1.0001, 2_f64.powi(460) * 0.9999);
    check::<f32>(2_f64.powi(-40) * 1.0001, 2_f64.powf(40.9999));
}
