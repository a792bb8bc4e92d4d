//! Wrench to contact: error against run time per shape, and what spin and noise do to each model.

mod columns;
mod drawn;
mod many;
mod noise;
mod peers;
mod study;

use drawn::in_columns;
use many::{MESHES, batches, on_meshes};
use noise::over_noise;
use peers::beside_parry;
use study::{Figure, SCALE, SHAPES, Study};

use super::Part;
use crate::Failure;
use crate::page::Page;
use crate::plots::{Diagram, Series};
use crate::stability::shapes::each;
use crate::table::{Table, shown};
use crate::timing::{Effort, Timed};

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

/// A row for each shape: time and error of its contacts.
fn in_short(figures: &[Figure]) -> Table {
    let mut short = Table::new(&[
        "shape",
        "point f32 ns",
        "f64 ns",
        "error f32",
        "error f64",
        "in batches f32 ns",
        "f64 ns",
        "soft finger f64 ns",
        "error f64",
        "in batches f32 ns",
        "f64 ns",
        "error of the wrench axis with spin",
        "of the soft finger with noise of 1 %",
    ]);
    for shape in SHAPES.into_iter().chain(MESHES.map(|(name, ..)| name)) {
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
            ns(find("point contact, batch", "f32", "force")),
            ns(find("point contact, batch", "f64", "force")),
            ns(soft),
            worst(soft),
            ns(find("soft finger, batch", "f32", "spin")),
            ns(find("soft finger, batch", "f64", "spin")),
            middle(find("point", "f64", "spin")),
            middle(find("soft finger", "f64", "spin and noise of 1 %")),
        ]);
    }
    short
}

/// First crossings, of both libraries.
fn beside_parry_diagram(figures: &[Figure]) -> Diagram {
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
    Diagram {
        title: "First crossing of a half-line beside parry3d, f32 (hollow: parry3d)".to_owned(),
        x: "time per line, ns",
        y: "greatest error along the line over the size",
        series: peers,
        front: false,
    }
}

/// What the table of closed forms is measured on.
const ON_DRAWN: &str = "One wrench at a time and a column of wrenches on every convex shape with a closed form, \
                        each of eight proportions, poses and places that are drawn: the time of a contact, and how \
                        many times as many contacts columns give.";

pub(crate) fn report(page: &mut Page, effort: Effort) -> Result<Part, Failure> {
    page.heading("Wrench to contact");
    page.say(
        "Touches all over shapes of 13 mm, forces of 2 N within 60° of the normal, and spin torques of up to \
         0.03 of force times size. Without noise, errors are against the exact contact of the wrench as the \
         scalar type has it, in 220 bits; with noise of 1 % (of a newton, and of a newton times the size), \
         against the true contact. A point contact with spin is the wrench-axis method: its error is that of \
         the assumption, and more digits do not help. Meshes are balls of so many triangles, whose exact \
         contact is that on the plane of the facet; batches are of a thousand wrenches as columns.",
    );
    let mut figures = Vec::new();
    let mut study = Study { effort, scalar: "f32", figures: &mut figures };
    each::<f32>(SCALE, &mut study);
    batches::<f32>(&mut study)?;
    on_meshes::<f32>(&mut study)?;
    beside_parry(&mut study)?;
    study.scalar = "f64";
    each::<f64>(SCALE, &mut study);
    batches::<f64>(&mut study)?;
    on_meshes::<f64>(&mut study)?;
    for shape in SHAPES {
        let these: Vec<&Figure> = figures
            .iter()
            .filter(|f| {
                f.shape == shape && f.inputs == if f.method.starts_with("point") { "force" } else { "spin" }
            })
            .collect();
        let title = format!("Contact, {shape}: error over run time, without noise");
        page.diagram(&format!("contact_{shape}"), &diagram(title, &these))?;
    }
    let meshes = figures.iter().filter(|f| f.shape.starts_with("mesh") && f.inputs == "spin");
    let named: Vec<Figure> = meshes.map(Figure::with_shape).collect();
    let title = "Soft finger on meshes of a ball: error over run time, without noise".to_owned();
    page.diagram("contact_meshes", &diagram(title, &named.iter().collect::<Vec<_>>()))?;
    page.diagram("contact_parry", &beside_parry_diagram(&figures))?;
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

    let short = in_short(&figures);
    page.subheading("In short");
    page.table(&short);
    let said = format!(
        "Greatest errors of the point over the size of the shape; the last two columns are medians.\n\n{}",
        short.markdown()
    );
    let columns = in_columns(effort)?;
    page.subheading("One by one and in columns");
    page.say(ON_DRAWN);
    page.table(&columns);
    let said = format!("{said}\n{ON_DRAWN}\n\n{}", columns.markdown());
    Ok(("Wrench to contact".to_owned(), said))
}
