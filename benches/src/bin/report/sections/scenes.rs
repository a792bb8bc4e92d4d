//! What a scene costs: here, and on a microcontroller.

use core::hint::black_box;
use std::path::{Path, PathBuf};

use fingertip::wrench::{Real, Wrench};
use fingertip_scene::{Pipeline, Scene};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::Part;
use crate::Failure;
use crate::page::Page;
use crate::plots::{Diagram, Series};
use crate::table::{Table, shown};
use crate::timing::{Effort, time};

/// Seconds from a sample to the next.
const STEP: f64 = 1e-3;

/// A file of the project.
fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// So many forces of 2 N from all sides, on what is some centimetres large, that a scene calls a contact; fewer if they are
/// hard to find.
fn that_touch(scene: &Scene, count: usize) -> Vec<Wrench<f64>> {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    let mut vector = |size: f64| Vector3::from_fn(|_, _| random.random_range(-size..size));
    let pushes = core::iter::repeat_with(|| {
        let force = 2.0 * vector(1.0).normalize();
        Wrench::on_fingertip(force, vector(0.008).cross(&force) + vector(5e-4))
    });
    let mut pipeline = scene.pipeline();
    let touches = |push: &Wrench<f64>| {
        pipeline.reset();
        pipeline.sense(*push, STEP).contact().is_some()
    };
    pushes.take(40 * count).filter(touches).take(count).collect()
}

/// What a sample takes \[ns\].
fn cost<T: Real>(effort: Effort, mut pipeline: Pipeline<T>, pushes: &[Wrench<T>]) -> f64 {
    let step = T::literal(STEP);
    let timed = time(effort, pushes.len(), || {
        for push in pushes {
            black_box(pipeline.sense(*black_box(push), step));
        }
    });
    timed.median
}

/// The scenes of the examples, by their files.
fn examples() -> Result<Vec<PathBuf>, Failure> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(file("examples/scenes"))? {
        let path = entry?.path();
        if path.extension().is_some_and(|end| end == "toml") {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}

/// Each scene of the examples on this computer.
fn here(effort: Effort) -> Result<Table, Failure> {
    let mut table = Table::new(&["scene", "ns a sample, f64", "ns a sample, f32"]);
    for path in examples()? {
        let scene = Scene::load(&path)?;
        let double = that_touch(&scene, effort.choose(5, 251));
        if double.is_empty() {
            return Err(format!("no push touches the scene {}", path.display()).into());
        }
        let single: Vec<Wrench<f32>> = double
            .iter()
            .map(|push| Wrench::on_fingertip(push.force().map(|x| x as f32), push.torque().map(|x| x as f32)))
            .collect();
        table.row([
            path.file_stem().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
            shown(cost(effort, scene.pipeline(), &double)),
            shown(cost(effort, scene.pipeline_in::<f32>()?, &single)),
        ]);
    }
    Ok(table)
}

/// A row of the table of footprints.
struct Footprint {
    contact: String,
    posed: bool,
    instructions: f64,
    flash: f64,
}

/// The rows of a page of the book that is measured by the firmware.
fn footprints(page: &str) -> Result<Vec<Footprint>, Failure> {
    let rows: Option<Vec<Footprint>> = page
        .lines()
        .filter(|line| line.starts_with("| [`"))
        .map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            Some(Footprint {
                contact: (*cells.get(1)?).to_owned(),
                posed: *cells.get(2)? == "yes",
                instructions: cells.get(3)?.parse().ok()?,
                flash: cells.get(5)?.parse::<f64>().ok()? / 1e3,
            })
        })
        .collect();
    rows.filter(|rows| !rows.is_empty()).ok_or_else(|| "the page of footprints has another form".into())
}

pub(crate) fn report(page: &mut Page, effort: Effort) -> Result<Part, Failure> {
    let title = "The cost of a scene";
    page.heading(title);
    let rows = footprints(&std::fs::read_to_string(file("book/src/reference/footprint.md"))?)?;
    let mut series = Vec::new();
    for (contact, posed) in [("point", false), ("point", true), ("soft finger", false), ("soft finger", true)]
    {
        let of = rows.iter().filter(|row| row.contact == contact && row.posed == posed);
        let points: Vec<(f64, f64)> = of.map(|row| (row.instructions, row.flash)).collect();
        let name = format!("{contact}{}", if posed { ", posed" } else { "" });
        series.push(Series { name, points, ..Series::default() });
    }
    page.diagram(
        "scenes_footprint",
        &Diagram {
            title: "Shapes on a Cortex-M4F, single precision: flash over instructions a sample".to_owned(),
            x: "instructions a sample, median",
            y: "flash of a sample, kB",
            series,
            front: true,
        },
    )?;
    let table = here(effort)?;
    let said = "A sample of each scene of the examples on this computer, from wrench to all that the scene asks for, by the \
                pipeline that is made at run time, of loads that touch.";
    page.say(said);
    page.table(&table);
    page.data("scenes", &table);
    let short = format!(
        "{said}\n\n{}\nEach mark of the diagram is a row of [the table of footprints](../reference/footprint.md): a shape \
         with a contact model. Whole scenes on a microcontroller: [its firmware](../../../examples/cortex-m4/README.md).\n",
        table.markdown()
    );
    Ok((title.to_owned(), short))
}
