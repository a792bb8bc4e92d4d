//! Wrench to contact: error against run time per shape, and what spin and noise do to each model.

use core::cell::Cell;
use core::hint::black_box;

use fingertip_surfaces::{
    ActiveSurface, ContactModel, Ellipsoid, Mesh, PointContact, Resolution, SmoothSurface, SoftFinger,
    SoftFingerSurface, Sphere,
};
use fingertip_wrench::{Line, Real, Wrench};
use nalgebra::Vector3;
use parry3d::query::{Ray, RayCast};
use parry3d::shape;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::Part;
use crate::Failure;
use crate::page::Page;
use crate::plots::{Diagram, Series};
use crate::reference::{distance, point_contact, soft_contact};
use crate::stability::contacts::pressing;
use crate::stability::levels::{Level, direction};
use crate::stability::shapes::{Visitor, each};
use crate::stability::soft::Newton;
use crate::table::{Table, shown};
use crate::timing::{Effort, Timed, median, time};

const SCALE: f64 = 0.013;
/// Greatest spin torque over force and size: that of a patch of 3 mm at a friction of 0.5.
const SPIN: f64 = 0.03;

/// One touch: where, with what force and spin.
#[derive(Clone, Copy)]
struct Touch {
    point: Vector3<f64>,
    force: Vector3<f64>,
    normal: Vector3<f64>,
    spin: f64,
}

impl Touch {
    /// Its wrench, of force alone or with the spin torque, read with some noise: that of the force in
    /// newtons, that of the torque by the size.
    fn wrench<T: Real>(&self, spin: bool, noise: f64, size: f64, random: &mut Pcg64Mcg) -> Wrench<T> {
        let mut any = |by: f64| {
            Vector3::from_fn(|_, _| -> f64 { by * Distribution::<f64>::sample(&StandardNormal, random) })
        };
        let spin = if spin { self.normal * self.spin } else { Vector3::zeros() };
        let force = self.force + any(noise);
        let torque = self.point.cross(&self.force) + spin + any(noise * size);
        Wrench::on_fingertip(force.map(T::literal), torque.map(T::literal))
    }
}

struct Figure {
    shape: &'static str,
    method: String,
    scalar: &'static str,
    inputs: &'static str,
    median: f64,
    worst: f64,
    lost: usize,
    count: usize,
    timed: Option<Timed>,
}

struct Study<'a> {
    effort: Effort,
    scalar: &'static str,
    figures: &'a mut Vec<Figure>,
}

/// Errors over the size, with the worst and the median; a contact that was not found is lost.
struct Errors {
    values: Vec<f64>,
    lost: usize,
}

impl Errors {
    fn of(found: impl Iterator<Item = Option<f64>>) -> Self {
        let (mut values, mut lost) = (Vec::new(), 0);
        for error in found {
            match error {
                Some(error) => values.push(error),
                None => lost += 1,
            }
        }
        values.sort_by(f64::total_cmp);
        Self { values, lost }
    }
}

impl Study<'_> {
    fn push(
        &mut self,
        shape: &'static str,
        method: impl Into<String>,
        inputs: &'static str,
        errors: Errors,
        timed: Option<Timed>,
    ) {
        let mut values = errors.values;
        self.figures.push(Figure {
            shape,
            method: method.into(),
            scalar: self.scalar,
            inputs,
            median: median(&mut values).max(1e-18),
            worst: values.last().copied().unwrap_or(f64::NAN).max(1e-18),
            lost: errors.lost,
            count: values.len() + errors.lost,
            timed,
        });
    }

    /// One model on one set of inputs: errors against the exact contact of what was read, or where
    /// there is noise or a model that neglects something, against the true contact.
    fn model<T: Real, S, M: ContactModel<T, S>>(
        &mut self,
        (shape, method): (&'static str, &str),
        surface: &S,
        model: &M,
        touches: &[Touch],
        (level, size): (Level, f64),
        exact: impl Fn(&Touch, &Wrench<T>) -> Option<[crate::stability::big::Big; 3]>,
        warm: bool,
    ) {
        for (inputs, spin, noise) in
            [("force", false, 0.0), ("spin", true, 0.0), ("spin and noise of 1 %", true, 0.01)]
        {
            let mut random = Pcg64Mcg::seed_from_u64(12);
            let read: Vec<Wrench<T>> =
                touches.iter().map(|touch| touch.wrench(spin, noise, size, &mut random)).collect();
            // The sample before was half a hundredth of the size away.
            let last: Vec<Vector3<T>> = touches
                .iter()
                .map(|t| (t.point + t.normal.cross(&t.force).normalize() * 0.005 * size).map(T::literal))
                .collect();
            let resolve = |index: usize| {
                let last = warm.then(|| &last[index]);
                model.resolve_near(black_box(&read[index]), surface, last)
            };
            let neglects = method.starts_with("point") && spin;
            let few = if matches!(level, Level::Superquadric { .. }) { 12 } else { touches.len() };
            let errors = Errors::of(touches.iter().zip(&read).enumerate().take(few).filter_map(
                |(index, (touch, wrench))| {
                    let Resolution::Contact(contact) = resolve(index) else { return Some(None) };
                    let found = if noise > 0.0 || neglects {
                        (contact.point.map(Real::to_f64) - touch.point).norm()
                    } else {
                        distance(&contact.point, &exact(touch, wrench)?)
                    };
                    Some(Some(found / size))
                },
            ));
            let timed = (noise == 0.0).then(|| {
                time(self.effort, touches.len(), || {
                    for index in 0..read.len() {
                        black_box(resolve(index));
                    }
                })
            });
            self.push(shape, method, inputs, errors, timed);
        }
    }
}

impl<T: Real> Visitor<T> for Study<'_> {
    fn shape<S: SmoothSurface<T> + SoftFingerSurface<T>>(
        &mut self,
        name: &'static str,
        surface: S,
        level: Level,
        scale: f64,
    ) {
        const SHAPES: [&str; 7] =
            ["sphere", "ellipsoid", "cylinder", "capsule", "cone", "torus", "superquadric"];
        let (Ok(point), Ok(soft)) = (PointContact::new(T::zero()), SoftFinger::new(T::zero())) else {
            return;
        };
        if !SHAPES.contains(&name) {
            return;
        }
        let size = level.size(scale);
        let mut random = Pcg64Mcg::seed_from_u64(11);
        let touches: Vec<Touch> = (0..self.effort.choose(16, 64))
            .map(|_| {
                let (point, normal) = level.sample(&mut random, scale);
                let force = pressing(&normal, random.random_range(0.5..1.0), &mut random) * 2.0;
                Touch { point, force, normal, spin: SPIN * 2.0 * size * random.random_range(-1.0..1.0) }
            })
            .collect();
        let place = (level, size);
        // Where several contacts explain a wrench, the one near the last is wanted.
        let several = name == "torus";
        let on_line = |touch: &Touch, wrench: &Wrench<T>| point_contact(level, wrench, &touch.point);
        self.model(
            (name, "point contact (wrench axis)"),
            &surface,
            &point,
            &touches,
            place,
            on_line,
            several,
        );
        // The exact answer to a force alone is that of the line; to a spin, that of all equations.
        let on_surface = |touch: &Touch, wrench: &Wrench<T>| {
            let spin = wrench.torque_about(&touch.point.map(T::literal)).dot(&touch.normal.map(T::literal));
            soft_contact(level, wrench, &touch.point, spin.to_f64(), size)
        };
        let closed = matches!(name, "sphere" | "ellipsoid" | "cylinder" | "cone");
        let method = if closed { "soft finger, closed form" } else { "soft finger" };
        self.model((name, method), &surface, &soft, &touches, place, on_surface, several);
        let newton = Newton { surface: &surface, evaluations: Cell::new(0) };
        if !matches!(name, "cylinder" | "cone") {
            let name = (name, "soft finger, Newton from the last contact");
            self.model(name, &newton, &soft, &touches, place, on_surface, true);
        }
    }
}

/// A ball of triangles.
fn ball(rings: u32, sectors: u32) -> (Vec<Vector3<f32>>, Vec<[u32; 3]>) {
    let mut vertices = vec![Vector3::z()];
    for i in 1..rings {
        let (sine, cosine) = (core::f32::consts::PI * i as f32 / rings as f32).sin_cos();
        for j in 0..sectors {
            let (s, c) = (core::f32::consts::TAU * j as f32 / sectors as f32).sin_cos();
            vertices.push(Vector3::new(sine * c, sine * s, cosine));
        }
    }
    vertices.push(-Vector3::z());
    let last = 1 + (rings - 1) * sectors;
    let at = |i: u32, j: u32| 1 + (i - 1) * sectors + j % sectors;
    let mut triangles = Vec::new();
    for j in 0..sectors {
        triangles.push([0, at(1, j), at(1, j + 1)]);
        triangles.push([last, at(rings - 1, j + 1), at(rings - 1, j)]);
        for i in 1..rings - 1 {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    (vertices, triangles)
}

fn first<T: Real>(surface: &impl ActiveSurface<T>, line: &Line<T>) -> Option<T> {
    let mut first = None;
    surface.crossings(line, |c| {
        if first.is_none_or(|t| c.along < t) {
            first = Some(c.along);
        }
    });
    first
}

/// Where a half-line first meets a shape of size 1, by us and by parry3d, both in f32; the truth is
/// ours in f64.
fn beside_parry(study: &mut Study<'_>) -> Result<(), Failure> {
    type Vector = parry3d::math::Vector;
    let mut random = Pcg64Mcg::seed_from_u64(13);
    let rays: Vec<Ray> = (0..study.effort.choose(64, 500))
        .map(|_| {
            let (along, aim) = (direction(&mut random), direction(&mut random) * 0.5);
            let from = aim - along * 4.0;
            let to = |v: Vector3<f64>| Vector::new(v.x as f32, v.y as f32, v.z as f32);
            Ray::new(to(from), to(along))
        })
        .collect();
    let lines: Vec<Line<f32>> = rays
        .iter()
        .map(|ray| Line {
            point: Vector3::new(ray.origin.x, ray.origin.y, ray.origin.z),
            direction: Vector3::new(ray.dir.x, ray.dir.y, ray.dir.z),
        })
        .collect();
    macro_rules! pair {
        ($name:literal, $ours:expr, $exact:expr, $theirs:expr) => {{
            let (ours, exact, theirs) = ($ours, $exact, $theirs);
            let truth: Vec<Option<f64>> = lines
                .iter()
                .map(|l| first(&exact, &Line { point: l.point.cast::<f64>(), direction: l.direction.cast() }))
                .collect();
            let errors = |found: &dyn Fn(usize) -> Option<f32>| {
                Errors::of(truth.iter().enumerate().filter_map(|(k, truth)| {
                    let truth = (*truth)?;
                    Some(found(k).map(|t| (f64::from(t) - truth).abs() / 2.0))
                }))
            };
            let mine = errors(&|k| first(&ours, &lines[k]));
            let other = errors(&|k| theirs.cast_local_ray(&rays[k], 100.0, true));
            let timed = time(study.effort, lines.len(), || {
                for line in &lines {
                    black_box(first(&ours, black_box(line)));
                }
            });
            study.push($name, "fingertip, first crossing", "half-line", mine, Some(timed));
            let timed = time(study.effort, rays.len(), || {
                for ray in &rays {
                    black_box(theirs.cast_local_ray_and_get_normal(black_box(ray), 100.0, true));
                }
            });
            study.push($name, "parry3d, ray cast", "half-line", other, Some(timed));
        }};
    }
    use fingertip_surfaces::{CappedCylinder, Capsule, Frustum};
    fn capsule<T: Real>() -> Result<Capsule<T>, Failure> {
        Ok(Capsule::new(Vector3::zeros(), Vector3::y(), T::literal(0.5), T::literal(0.75))?)
    }
    fn cylinder<T: Real>() -> Result<CappedCylinder<T>, Failure> {
        Ok(CappedCylinder::new(Vector3::zeros(), Vector3::y(), T::literal(0.75), T::literal(0.5))?)
    }
    fn cone<T: Real>() -> Result<Frustum<T>, Failure> {
        let base = Vector3::y() * T::literal(-0.5);
        Ok(Frustum::new(base, Vector3::y(), T::one(), T::literal(0.75), T::zero())?)
    }
    pair!("sphere", Sphere::centred(1.0_f32)?, Sphere::centred(1.0_f64)?, shape::Ball::new(1.0));
    pair!("capsule", capsule::<f32>()?, capsule::<f64>()?, shape::Capsule::new_y(0.5, 0.75));
    pair!("cylinder", cylinder::<f32>()?, cylinder::<f64>()?, shape::Cylinder::new(0.5, 0.75));
    pair!("cone", cone::<f32>()?, cone::<f64>()?, shape::Cone::new(0.5, 0.75));
    let (vertices, triangles) = ball(50, 51);
    let wide: Vec<Vector3<f64>> = vertices.iter().map(|v| v.cast()).collect();
    let points: Vec<Vector> = vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
    let soup = shape::TriMesh::new(points, triangles.clone()).map_err(|error| format!("{error:?}"))?;
    pair!("mesh of 5000", Mesh::new(&vertices, &triangles)?, Mesh::new(&wide, &triangles)?, soup);
    Ok(())
}

/// Error over the noise on one ellipsoid: where f32 stops being good enough.
fn over_noise(effort: Effort) -> Result<Vec<Series>, Failure> {
    fn course<T: Real>(effort: Effort, soft: bool, name: &str, single: bool) -> Result<Series, Failure> {
        let semi_axes = [SCALE, 0.7 * SCALE, 0.4 * SCALE];
        let surface = Ellipsoid::new(Vector3::from(semi_axes).map(T::literal))?;
        let (level, size) = (Level::Ellipsoid { semi_axes }, 2.0 * SCALE);
        let (point, finger) = (PointContact::new(T::zero())?, SoftFinger::new(T::zero())?);
        let mut points = Vec::new();
        for decade in (-18..=-1).step_by(effort.choose(4, 1)) {
            let noise = 10_f64.powi(decade);
            let mut random = Pcg64Mcg::seed_from_u64(14);
            let mut errors: Vec<f64> = (0..effort.choose(32, 256))
                .filter_map(|_| {
                    let (at, normal) = level.sample(&mut random, SCALE);
                    let force = pressing(&normal, random.random_range(0.5..1.0), &mut random);
                    let spin = if soft { SPIN * size * random.random_range(-1.0..1.0) } else { 0.0 };
                    let touch = Touch { point: at, force, normal, spin };
                    let wrench: Wrench<T> = touch.wrench(true, noise, size, &mut random);
                    let found = if soft {
                        finger.resolve(&wrench, &surface)
                    } else {
                        point.resolve(&wrench, &surface)
                    };
                    let contact = found.contact()?;
                    Some((contact.point.map(Real::to_f64) - at).norm() / size)
                })
                .collect();
            points.push((noise, median(&mut errors).max(1e-18)));
        }
        Ok(Series { name: name.to_owned(), points, joined: true, single, ..Series::default() })
    }
    Ok(vec![
        course::<f32>(effort, false, "point contact f32", true)?,
        course::<f64>(effort, false, "point contact f64", false)?,
        course::<f32>(effort, true, "soft finger f32", true)?,
        course::<f64>(effort, true, "soft finger f64", false)?,
    ])
}

fn diagram(title: String, figures: &[&Figure]) -> Diagram {
    let series = figures
        .iter()
        .filter_map(|f| {
            let timed = f.timed?;
            Some(Series {
                name: format!("{} {}", f.method, f.scalar),
                points: vec![(timed.median, f.median)],
                spread: vec![(timed.lower_quartile, timed.upper_quartile)],
                joined: false,
                single: f.scalar == "f32",
            })
        })
        .collect();
    Diagram {
        title,
        x: "time per contact, ns",
        y: "median error of the point over the size",
        series,
        front: true,
    }
}

fn data(figures: &[Figure]) -> Table {
    let head = [
        "shape",
        "method",
        "scalar",
        "inputs",
        "median error over size",
        "greatest error over size",
        "lost",
        "of",
        "median ns",
        "lower quartile ns",
        "upper quartile ns",
    ];
    let mut table = Table::new(&head);
    for f in figures {
        let ns = |pick: fn(&Timed) -> f64| {
            f.timed.as_ref().map_or_else(|| "-".to_owned(), |t| format!("{:.1}", pick(t)))
        };
        table.row([
            f.shape.to_owned(),
            f.method.clone(),
            f.scalar.to_owned(),
            f.inputs.to_owned(),
            format!("{:.2e}", f.median),
            format!("{:.2e}", f.worst),
            f.lost.to_string(),
            f.count.to_string(),
            ns(|t| t.median),
            ns(|t| t.lower_quartile),
            ns(|t| t.upper_quartile),
        ]);
    }
    table
}

pub(crate) fn report(page: &mut Page, effort: Effort) -> Result<Part, Failure> {
    page.heading("Wrench to contact");
    page.say(
        "Touches all over shapes of 13 mm, forces of 2 N within 60° of the normal, and spin torques of up to \
         0.03 of force times size. Without noise, errors are against the exact contact of the wrench as the \
         scalar type has it, in 220 bits; with noise of 1 % (of a newton, and of a newton times the size), \
         against the true contact. A point contact with spin is the wrench-axis method: its error is that of \
         the assumption, and more digits do not help.",
    );
    let mut figures = Vec::new();
    let mut study = Study { effort, scalar: "f32", figures: &mut figures };
    each::<f32>(SCALE, &mut study);
    beside_parry(&mut study)?;
    study.scalar = "f64";
    each::<f64>(SCALE, &mut study);
    for shape in ["sphere", "ellipsoid", "cylinder", "capsule", "cone", "torus", "superquadric"] {
        let these: Vec<&Figure> = figures
            .iter()
            .filter(|f| {
                f.shape == shape && f.inputs == if f.method.starts_with("point") { "force" } else { "spin" }
            })
            .collect();
        let title = format!("Contact on a {shape}, without noise: error over run time");
        page.diagram(&format!("contact_{shape}"), &diagram(title, &these))?;
    }
    let mut peers: Vec<Series> = Vec::new();
    for f in figures.iter().filter(|f| f.inputs == "half-line") {
        let Some(timed) = f.timed else { continue };
        peers.push(Series {
            name: format!("{}: {}", f.shape, f.method),
            points: vec![(timed.median, f.worst)],
            spread: vec![(timed.lower_quartile, timed.upper_quartile)],
            joined: false,
            single: f.method.starts_with("parry"),
        });
    }
    page.diagram(
        "contact_parry",
        &Diagram {
            title: "First crossing of a half-line beside parry3d, f32 (hollow: parry3d)".to_owned(),
            x: "time per line, ns",
            y: "greatest error along the line over the size",
            series: peers,
            front: false,
        },
    )?;
    page.subheading("Where numerical error stops mattering");
    page.say(
        "On an ellipsoid, with noise from 1e-18 to 0.1 of the force: an error that does not rise with the \
         noise is that of the arithmetic.",
    );
    page.diagram(
        "contact_noise",
        &Diagram {
            title: "Error of the contact point over the noise of the wrench".to_owned(),
            x: "noise of the wrench, relative to the force",
            y: "median error of the point over the size",
            series: over_noise(effort)?,
            front: false,
        },
    )?;
    page.data("contact", &data(&figures));

    let mut short = Table::new(&[
        "shape",
        "point f32 ns",
        "f64 ns",
        "error f32",
        "error f64",
        "soft finger f64 ns",
        "error f64",
        "error of the wrench axis with spin",
        "of the soft finger with noise of 1 %",
    ]);
    for shape in ["sphere", "ellipsoid", "cylinder", "capsule", "cone", "torus", "superquadric"] {
        let find = |method: &str, scalar: &str, inputs: &str| {
            figures.iter().find(|f| {
                f.shape == shape && f.method.starts_with(method) && f.scalar == scalar && f.inputs == inputs
            })
        };
        let ns =
            |f: Option<&Figure>| f.and_then(|f| f.timed).map_or_else(|| "-".to_owned(), |t| shown(t.median));
        let worst = |f: Option<&Figure>| f.map_or_else(|| "-".to_owned(), |f| shown(f.worst));
        let middle = |f: Option<&Figure>| f.map_or_else(|| "-".to_owned(), |f| shown(f.median));
        let (single, double) = (find("point", "f32", "force"), find("point", "f64", "force"));
        let soft = find("soft finger", "f64", "spin");
        short.row([
            shape.to_owned(),
            ns(single),
            ns(double),
            worst(single),
            worst(double),
            ns(soft),
            worst(soft),
            middle(find("point", "f64", "spin")),
            middle(find("soft finger", "f64", "spin and noise of 1 %")),
        ]);
    }
    page.subheading("In short");
    page.table(&short);
    let said = format!(
        "Greatest errors of the point over the size of the shape; the last two columns are medians.\n\n{}",
        short.markdown()
    );
    Ok(("Wrench to contact".to_owned(), said))
}
