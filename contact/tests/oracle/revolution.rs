//! Closest approaches to surfaces of revolution against dense samples of the surface, the best refined.

use core::f64::consts::{PI, TAU};

use fingertip_surfaces::testing::SurfaceLaws;
use fingertip_surfaces::{ActiveSurface, Knot, Revolution, SmoothSurface};
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;
use rand::RngExt;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use crate::quadrics::direction;

/// The side, by two angles: around the axis, and one that runs along it ever slower towards its ends.
struct Side<'a> {
    solid: &'a Revolution<f64, Vec<Knot<f64>>>,
    ends: [f64; 2],
}

impl Side<'_> {
    fn height(&self, angle: f64) -> f64 {
        let [low, high] = self.ends;
        let part = 0.5 * (1.0 - angle.clamp(0.0, PI).cos());
        (low + (high - low) * part).clamp(low, high)
    }

    fn radius(&self, z: f64) -> f64 {
        (-self.solid.level(&Vector3::new(0.0, 0.0, z)).value).max(0.0).sqrt()
    }
}

fn distance(line: &Line<f64>, point: &Vector3<f64>) -> f64 {
    let away = point - line.point;
    (away - line.direction * away.dot(&line.direction)).norm()
}

/// The least value in an interval with a single one, by golden section.
fn golden(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut low, mut high) = (low, high);
    let mut inner = [high - ratio * (high - low), low + ratio * (high - low)];
    let mut values = inner.map(&f);
    for _ in 0..50 {
        if values[0] < values[1] {
            high = inner[1];
            inner = [high - ratio * (high - low), inner[0]];
            values = [f(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + ratio * (high - low)];
            values = [values[1], f(inner[1])];
        }
    }
    f(low).min(f(high)).min(values[0]).min(values[1])
}

/// The least value of a function of an interval, told apart by so many samples, its neighbours' too if it
/// is periodic.
fn least<const N: usize>(low: f64, high: f64, periodic: bool, f: impl Fn(f64) -> f64) -> f64 {
    let step = (high - low) / N as f64;
    let at = |k: usize| low + step * k as f64;
    let samples: [f64; N] = core::array::from_fn(|k| f(at(k)));
    let last = f(high);
    let mut best = last;
    for k in 0..N {
        let before = if k > 0 {
            samples[k - 1]
        } else if periodic {
            samples[N - 1]
        } else {
            f64::MAX
        };
        let after = if k + 1 < N { samples[k + 1] } else { last };
        if samples[k] <= before && samples[k] <= after {
            let from = if k > 0 || periodic { at(k) - step } else { low };
            best = best.min(golden(from, at(k) + step, &f));
        }
    }
    if periodic { best } else { best.min(golden(high - step, high, &f)) }
}

/// The least distance of a line from the side: from each circle, and of all those.
fn from_side(side: &Side<'_>, line: &Line<f64>) -> f64 {
    least::<120>(0.0, PI, false, |along| {
        let z = side.height(along);
        let radius = side.radius(z);
        least::<16>(0.0, TAU, true, |around| {
            let (sine, cosine) = around.sin_cos();
            distance(line, &Vector3::new(radius * cosine, radius * sine, z))
        })
    })
}

/// Profiles with several inward bends, thin necks, hourglasses, straight stretches, tips, needles, pancakes.
fn profile(random: &mut Pcg64Mcg, kind: usize) -> Vec<[f64; 2]> {
    let many = random.random_range(2..9);
    let mut z = -0.5;
    let mut points: Vec<[f64; 2]> = (0..many)
        .map(|_| {
            z += random.random_range(0.05..0.4);
            [z, random.random_range(0.3..0.6)]
        })
        .collect();
    match kind % 6 {
        // Tips.
        0 => (points[0][1], points[many - 1][1]) = (0.0, 0.0),
        // A thin neck.
        1 => points[many / 2][1] = 0.02,
        // Straight.
        2 => points.iter_mut().for_each(|point| point[1] = 0.5),
        // An hourglass.
        3 => points = vec![[-0.5, 0.5], [0.0, random.random_range(0.1..0.4)], [0.5, 0.5]],
        // Sharp corners.
        4 => {
            points.iter_mut().enumerate().for_each(|(k, point)| point[1] = if k % 2 == 0 { 0.3 } else { 0.4 })
        }
        // Needles and pancakes.
        _ => {
            let stretch = 10_f64.powf(random.random_range(-3.0..3.0));
            points.iter_mut().for_each(|point| point[0] *= stretch);
        }
    }
    points
}

fn line(random: &mut Pcg64Mcg, side: &Side<'_>, kind: usize) -> Line<f64> {
    let mut toward = direction(random);
    let mut point = direction(random) * random.random_range(0.0..1.5);
    match kind % 8 {
        0 => toward = Vector3::z(),
        1 => toward = Vector3::x(),
        // Through the axis.
        2 => point = Vector3::z() * random.random_range(-0.5..1.5),
        3 => point = toward.cross(&direction(random)) * 1e6,
        // Nearly along the axis.
        4 => toward = (Vector3::z() + toward * 10_f64.powf(random.random_range(-17.0..-1.0))).normalize(),
        // Near a place of the surface, across its normal.
        _ => {
            let (z, angle) = (side.height(random.random_range(0.0..PI)), random.random_range(0.0..TAU));
            let radius = side.radius(z);
            let place = Vector3::new(radius * angle.cos(), radius * angle.sin(), z);
            let normal = side.solid.normal(&place);
            toward = normal.cross(&toward).normalize();
            point = place + normal * 10_f64.powf(random.random_range(-9.0..0.0));
        }
    }
    Line { point: point + toward * random.random_range(-1.0..1.0), direction: toward }
}

/// The place found is on the side, as far from the line as the gap says, and no other is nearer; all but
/// for what rounding takes from the profile and from the line where it passes.
fn none_is_nearer<T: Real>(trials: usize, size: f64) {
    let mut random = Pcg64Mcg::seed_from_u64(17);
    let (mut missing, mut as_near, mut crossing, mut inward) = (0, 0, 0, 0);
    for trial in 0..trials {
        let given =
            profile(&mut random, trial).iter().map(|p| p.map(|x| T::literal(x * size))).collect::<Vec<_>>();
        let points: Vec<_> = given.iter().map(|p| p.map(|x| x.to_f64() / size)).collect();
        let (Ok(solid), Ok(exact)) = (Revolution::from_points(&given), Revolution::from_points(&points))
        else {
            continue;
        };
        let reach = 1.0 + points[0][0].abs().max(points[points.len() - 1][0].abs());
        let side = Side { solid: &exact, ends: [points[0][0], points[points.len() - 1][0]] };
        for k in 0..6 {
            let aim = line(&mut random, &side, trial / 6 + k);
            let rounded = |v: &Vector3<f64>| v.map(T::literal);
            let given = Line { point: rounded(&(aim.point * size)), direction: rounded(&aim.direction) };
            let wide = |v: &Vector3<T>| v.map(Real::to_f64);
            let aim =
                Line { point: wide(&given.point) / size, direction: wide(&given.direction).normalize() };
            let mut crosses = false;
            exact.crossings(&aim, |_| crosses = true);
            solid.crossings(&given, |_| crosses = true);
            let found = solid.closest_approach(&given).unwrap();
            if crosses {
                // A place of the outline all the same, and the normal out of the solid.
                let step = found.normal * T::literal(size * 1e-3);
                inward += i32::from(solid.contains(&(found.point + step)) && found.gap.is_zero());
                crossing += 1;
                continue;
            }
            missing += 1;
            let (gap, point) = (found.gap.to_f64() / size, wide(&found.point) / size);
            let allowed = 64.0 * T::EPSILON.to_f64() * (reach + aim.point.norm());
            let level = exact.level(&point);
            let off = level.value.abs() / level.gradient.norm();
            assert!(off <= 64.0 * T::EPSILON.to_f64() * reach, "{trial} {k}: {off:e} off the surface");
            let apart = distance(&aim, &point);
            assert!((apart - gap).abs() <= allowed, "{trial} {k}: {gap:e} told, {apart:e} away");
            assert!(found.active && (found.normal.norm().to_f64() - 1.0).abs() < 8.0 * T::EPSILON.to_f64());
            // The normal points to the line; where that is near, half of the digits tell.
            let half_the_digits = T::EPSILON.to_f64().sqrt() * 8.0;
            if gap > half_the_digits.sqrt() {
                let away = aim.point - point;
                let away = (away - aim.direction * away.dot(&aim.direction)) / apart;
                let turned = (wide(&found.normal) - away).norm();
                assert!(turned <= half_the_digits, "{trial} {k}: {turned:e} off the normal, {gap:e} away");
            }
            let least = from_side(&side, &aim);
            assert!(gap <= least + allowed, "{trial} {k}: {gap:e} told, {least:e} found: {points:?} {aim:?}");
            as_near += i32::from(gap >= least - allowed);
        }
    }
    println!(
        "{inward} of {crossing} inward; {missing} lines that miss, of which samples found the nearest place for {as_near}"
    );
    assert!(as_near * 100 > missing * 99);
    // A step out of a narrow hollow may end on its other side.
    assert!(inward * 100 <= crossing, "{inward} of {crossing}");
}

#[test]
fn no_place_of_a_revolution_is_nearer() {
    none_is_nearer::<f64>(360, 1.0);
    none_is_nearer::<f32>(180, 1.0);
    none_is_nearer::<f64>(60, 1e-6);
    none_is_nearer::<f32>(60, 1e-6);
    none_is_nearer::<f64>(60, 1e3);
    none_is_nearer::<f32>(60, 1e3);
}

/// An hourglass, a thin neck, waves, sharp corners.
#[test]
fn revolutions_that_bend_inward_obey_the_laws() {
    fn check<T: Real, const N: usize>(points: [[f64; 2]; N]) {
        let [low, high] = [points[0][0], points[N - 1][0]];
        let centre = Vector3::new(0.0, 0.0, 0.5 * (low + high)).map(T::literal);
        let laws = SurfaceLaws::around(centre, T::literal(1.0)).with_edges().with_lines(400);
        let make = |scale: T| {
            Revolution::from_profile(points.map(|point| point.map(|x| T::literal(x) * scale))).ok()
        };
        laws.check(&make(T::one()).unwrap()).unwrap();
        laws.check_scaling(make).unwrap();
    }
    fn both<const N: usize>(points: [[f64; 2]; N]) {
        check::<f64, N>(points);
        check::<f32, N>(points);
    }
    both([[0.0, 0.5], [0.5, 0.25], [1.0, 0.5]]);
    both([[0.0, 0.5], [0.45, 0.1], [0.5, 0.05], [0.55, 0.1], [1.0, 0.5]]);
    both([[0.0, 0.5], [0.2, 0.35], [0.4, 0.5], [0.6, 0.35], [0.8, 0.5], [1.0, 0.35], [1.2, 0.0]]);
    both([[0.0, 0.0], [0.3, 0.4], [0.35, 0.3], [0.7, 0.45]]);
}
