//! Point contacts on every shape. The answer is measured backward: how far it is from the exact line
//! of action and from the exact surface. An error of the contact point that exceeds these is the
//! conditioning of the case, 1/cos φ.

use fingertip_contact::{ContactModel, NoContact, PointContact, Resolution, SoftFingerSurface};
use fingertip_surfaces::testing::ball_of_triangles;
use fingertip_surfaces::{ActiveSurface, ClosestApproach, Mesh, SmoothSurface};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::big::{Big3, big3, cross, dot, line_of_action};
use super::levels::{Level, direction};
use super::matrix::Row;
use super::shapes::{Visitor, each};

/// Rounding units of the lengths involved that an answer may be off.
const UNITS: f64 = 16.0;

/// The same for the nearest point to a line that misses, which is found by iteration in the space
/// where a needle is a ball: 1e-13 of the size in `f64` (`docs/theory/README.md#stress-cases`).
const NEAR_MISS_UNITS: f64 = 450.0;

pub(crate) fn wide<T: Real>(v: &Vector3<T>) -> [f64; 3] {
    v.map(Real::to_f64).into()
}

pub(crate) fn length(v: &Big3) -> f64 {
    dot(v, v).sqrt().to_f64()
}

/// A unit vector at an angle of the given cosine to the inward normal.
pub(crate) fn pressing(normal: &Vector3<f64>, cosine: f64, random: &mut Pcg64Mcg) -> Vector3<f64> {
    let across = loop {
        let across = direction(random).cross(normal);
        if across.norm() > 0.1 {
            break across.normalize();
        }
    };
    across * (1.0 - cosine * cosine).max(0.0).sqrt() - normal * cosine
}

/// Distance of a point from a line.
fn off_line(point: &Big3, (foot, axis): &(Big3, Big3)) -> f64 {
    let arm = [0, 1, 2].map(|k| &point[k] - &foot[k]);
    length(&cross(&arm, axis))
}

/// Whether the answer names no number that is none.
pub(crate) fn sound<T: Real>(answer: &Resolution<T>) -> bool {
    let good = |v: &Vector3<T>| v.iter().all(|x| x.is_number());
    match answer {
        Resolution::Contact(c) => {
            good(&c.point) && good(&c.normal) && c.spin_torque.is_number() && c.gap.is_number()
        }
        Resolution::NoContact(NoContact::Misses {
            closest: Some(ClosestApproach { gap, point: closest, normal, .. }),
        }) => gap.is_number() && good(closest) && good(normal),
        Resolution::NoContact(NoContact::OnlyPulling { point }) => good(point),
        Resolution::NoContact(NoContact::Ambiguous { first, second }) => good(first) && good(second),
        Resolution::NoContact(_) => true,
    }
}

/// No load, couples, NaN and infinities.
pub(crate) fn no_force<T: Real, S, M: ContactModel<T, S>>(
    name: String,
    model: &M,
    surface: &S,
    couple: impl Fn(&NoContact<T>) -> bool,
) -> Row {
    let mut row = Row::new::<T>(name, "no force, NaN, infinities");
    let (o, x) = (Vector3::<T>::zeros(), Vector3::new(T::one(), T::literal(2.0), T::literal(-3.0)));
    let answer = |f, m| model.resolve(&Wrench::on_fingertip(f, m), surface);
    let none = answer(o, o);
    let below = matches!(none, Resolution::NoContact(NoContact::BelowThreshold { .. }));
    row.expect(below, || format!("no load: {none:?}"));
    let pair = answer(o, x);
    row.expect(matches!(&pair, Resolution::NoContact(reason) if couple(reason)), || format!("{pair:?}"));
    row.expect(sound(&answer(x, o)), || "no torque".to_owned());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for k in 0..3 {
            let mut v = x;
            v[k] = T::literal(bad);
            for found in [answer(v, x), answer(x, v)] {
                let typed = matches!(found, Resolution::NoContact(NoContact::NotFinite));
                row.expect(typed, || format!("{bad}: {found:?}"));
            }
        }
    }
    row
}

struct Contacts<'a> {
    case: &'static str,
    force: f64,
    cosine: [f64; 2],
    trials: usize,
    rows: &'a mut Vec<Row>,
}

impl<T: Real> Visitor<T> for Contacts<'_> {
    fn shape<S: SmoothSurface<T> + SoftFingerSurface<T>>(
        &mut self,
        name: &'static str,
        surface: S,
        level: Level,
        scale: f64,
    ) {
        let model = PointContact::new(T::zero()).expect("a model");
        let routine = format!("point contact, {name}");
        let mut row = Row::new::<T>(&routine, self.case);
        let mut random = Pcg64Mcg::seed_from_u64(33);
        let (size, epsilon) = (level.size(scale), T::EPSILON.to_f64());
        // Powers of large numbers take their time.
        let trials = if name.starts_with("superquadric") { self.trials.div_ceil(4) } else { self.trials };
        for _ in 0..trials {
            let (point, normal) = level.sample(&mut random, scale);
            let cosine = random.random_range(self.cosine[0]..=self.cosine[1]);
            let force = pressing(&normal, cosine, &mut random) * self.force;
            let torque = point.cross(&force);
            let wrench = Wrench::<T>::on_fingertip(force.map(T::literal), torque.map(T::literal));
            let line = line_of_action(wide(&wrench.force()), wide(&wrench.torque()));
            let found = model.resolve(&wrench, &surface);
            if !sound(&found) {
                row.error(f64::NAN, 1.0, || format!("{wrench:?}: {found:?}"));
                continue;
            }
            let place = match &found {
                Resolution::Contact(contact) => contact.point,
                // Rounding alone lifts a grazing line off the surface, and off the rim of a pancake.
                Resolution::NoContact(NoContact::Misses {
                    closest: Some(ClosestApproach { point: closest, .. }),
                }) => *closest,
                Resolution::NoContact(NoContact::OnlyPulling { point }) if self.cosine[0] < 1e-3 => *point,
                Resolution::NoContact(_) => {
                    row.expect(false, || format!("{wrench:?}: {found:?}"));
                    continue;
                }
            };
            let place = big3(wide(&place));
            let missed = matches!(found, Resolution::NoContact(NoContact::Misses { .. }));
            let units = if missed { NEAR_MISS_UNITS } else { UNITS };
            let bound = units * epsilon * (size + length(&place) + length(&line.0));
            let (aside, above) = (off_line(&place, &line), level.distance(&place, size));
            let note = || {
                format!(
                    "{aside:.1e} off the line, {above:.1e} off the surface, bound {bound:.1e}: {wrench:?}: {found:?}"
                )
            };
            row.error(aside, bound, note);
            row.error(above, bound, note);
        }
        self.rows.push(row);
        if self.case == "ordinary" {
            let row = no_force(routine, &model, &surface, |reason| {
                matches!(reason, NoContact::BelowThreshold { .. } | NoContact::PureCouple { .. })
            });
            self.rows.push(row);
        }
    }
}

/// Distance from the nearest plane of a triangle that the point projects into, but for a hair.
fn off_mesh(point: &Big3, vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> f64 {
    let rough = Vector3::from_fn(|k, _| point[k].to_f64());
    let mut nearest = f64::INFINITY;
    for triangle in triangles {
        let [a, b, c] = triangle.map(|k| vertices[k as usize]);
        let normal = (b - a).cross(&(c - a));
        let hair = 1e-4 * normal.norm();
        let inside = [(a, b), (b, c), (c, a)]
            .iter()
            .all(|(p, q)| (q - p).cross(&(rough - p)).dot(&normal) >= -hair * normal.norm());
        if inside && (rough - a).dot(&normal).abs() < 1e-3 * normal.norm() {
            let [a, b, c] = [a, b, c].map(|v| big3(v.into()));
            let minus = |x: &Big3, y: &Big3| [0, 1, 2].map(|k| &x[k] - &y[k]);
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            nearest = nearest.min((dot(&minus(point, &a), &normal).to_f64() / length(&normal)).abs());
        }
    }
    nearest
}

fn meshes<T: Real>(trials: usize, rows: &mut Vec<Row>) {
    let mut random = Pcg64Mcg::seed_from_u64(34);
    let model = PointContact::new(T::zero()).expect("a model");
    for (kind, sliver) in [("mesh", 0.5), ("mesh with slivers of 1e-6", 1e-6)] {
        let (vertices, triangles) = ball_of_triangles(9, 12, Some(sliver));
        let vertices: Vec<Vector3<T>> = vertices.iter().map(|v| v.map(T::literal)).collect();
        let exact: Vec<Vector3<f64>> = vertices.iter().map(|v| v.map(Real::to_f64)).collect();
        let name = format!("point contact, {kind}");
        let Ok(mesh) = Mesh::new(&vertices, &triangles) else {
            let mut row = Row::new::<T>(name, "construction");
            row.expect(false, || "refused".to_owned());
            rows.push(row);
            continue;
        };
        for case in ["faces", "edges", "vertices"] {
            let mut row = Row::new::<T>(&name, case);
            for _ in 0..trials * 4 {
                let corners = triangles[random.random_range(0..triangles.len())].map(|k| exact[k as usize]);
                let share = random.random_range(0.0..1.0);
                let target = match case {
                    "faces" => (corners[0] + corners[1] + corners[2]) / 3.0,
                    "edges" => corners[0] * share + corners[1] * (1.0 - share),
                    _ => corners[0],
                };
                let force = pressing(&target.normalize(), random.random_range(0.5..1.0), &mut random);
                let wrench =
                    Wrench::<T>::on_fingertip(force.map(T::literal), target.cross(&force).map(T::literal));
                let line = line_of_action(wide(&wrench.force()), wide(&wrench.torque()));
                let found = model.resolve(&wrench, &mesh);
                let Some(contact) = found.contact() else {
                    row.expect(false, || format!("a leak: {wrench:?}: {found:?}"));
                    continue;
                };
                let place = big3(wide(&contact.point));
                let bound = UNITS * T::EPSILON.to_f64() * 3.0;
                let (aside, above) = (off_line(&place, &line), off_mesh(&place, &exact, &triangles));
                let note = || {
                    format!(
                        "{aside:.1e} off the line, {above:.1e} off the mesh, bound {bound:.1e}: {wrench:?}: {found:?}"
                    )
                };
                row.error(aside, bound, note);
                row.error(above, bound, note);
            }
            rows.push(row);
        }
        rows.push(no_force(name, &model, &mesh, |reason| {
            matches!(reason, NoContact::BelowThreshold { .. } | NoContact::PureCouple { .. })
        }));
    }
}

/// Lines that no shape of an axis can be told apart from its own: along it, and far aside.
fn along_axis<T: Real, S: ActiveSurface<T>>(surface: &S, model: &PointContact<T>, row: &mut Row) {
    for (x, size) in [(0.0, 1.0), (0.5, 1.0), (1.0, 1.0), (1.0 + 1e-7, 1.0), (1e6, 1.0), (1.0, 1e20)] {
        let force = Vector3::z() * T::literal(-size);
        let wrench = Wrench::from_force_at(&(Vector3::x() * T::literal(x)), force);
        let found = model.resolve(&wrench, surface);
        row.expect(sound(&found), || format!("{wrench:?}: {found:?}"));
        let tilted =
            Wrench::on_fingertip(force + Vector3::y() * (T::LEAST_NORMAL * T::literal(4.0)), wrench.torque());
        let found = model.resolve(&tilted, surface);
        row.expect(sound(&found), || format!("{tilted:?}: {found:?}"));
    }
}

struct Axes<'a>(&'a mut Vec<Row>);

impl<T: Real> Visitor<T> for Axes<'_> {
    fn shape<S: SmoothSurface<T> + SoftFingerSurface<T>>(
        &mut self,
        name: &'static str,
        surface: S,
        _: Level,
        _: f64,
    ) {
        let model = PointContact::new(T::zero()).expect("a model");
        let mut row = Row::new::<T>(format!("point contact, {name}"), "force along the axis");
        along_axis(&surface, &model, &mut row);
        self.0.push(row);
    }
}

pub(crate) fn rows<T: Real>(trials: usize, rows: &mut Vec<Row>) {
    let far = if T::EPSILON.to_f64() > 1e-10 { 1e30 } else { 1e150 };
    for (case, scale, force, cosine) in [
        ("ordinary", 1.0, 1.0, [0.3, 1.0]),
        ("size 1 µm", 1e-6, 1.0, [0.3, 1.0]),
        ("size 1 km", 1e3, 1.0, [0.3, 1.0]),
        ("tiny force", 1.0, 1.0 / far, [0.3, 1.0]),
        ("huge force", 1.0, far, [0.3, 1.0]),
        ("flat, cos φ = 0.05", 1.0, 1.0, [0.05, 0.05]),
        ("grazing, cos φ = 1e-4", 1.0, 1.0, [1e-4, 1e-4]),
        ("grazing, cos φ = 1e-8", 1.0, 1.0, [1e-8, 1e-8]),
        ("tangent", 1.0, 1.0, [0.0, 0.0]),
    ] {
        each::<T>(scale, &mut Contacts { case, force, cosine, trials, rows });
    }
    each::<T>(1.0, &mut Axes(rows));
    meshes::<T>(trials, rows);
}
