//! `fingertip geometry`: the shape of the fingertip's surface from touches, as a scene.

pub(crate) mod lines;
mod written;

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use fingertip::wrench::{RigidTransform, Wrench};
use fingertip_calibration::geometry::{
    Fitted, ShapeTouch, WrenchNoise, fit_aligned_ellipsoid, fit_cylinder, fit_cylinder_along, fit_ellipsoid,
    fit_meeting_point, fit_plane, fit_pose, fit_sphere,
};
use fingertip_calibration::loads::Columns;
use nalgebra::{Rotation3, Vector3};

use crate::calibrate::files::{bad, read_columns};
use crate::error::CliError;
use crate::output::{Outputs, Overwrite};
use lines::{length, point, tilt};
use written::Known;

#[derive(Debug, Args)]
#[command(after_help = "Columns of TOUCHES.csv: fx_N … tz_Nm, the load on the sensor; and\n  \
    sphere, ellipsoid, cylinder: nx, ny, nz, the outward normal of the fingertip where it was touched\n  \
    plane: pivot, the name of the point that was held still while the force turned\n  \
    pivot: nothing more, all rows are of one point\n  \
    pose: px_m, py_m, pz_m, the touched point in the surface's own frame")]
pub(crate) struct GeometryArguments {
    #[command(flatten)]
    overwrite: Overwrite,
    /// What to find
    #[arg(value_enum)]
    shape: FittedShape,
    /// Touches: CSV with units in the column names
    #[arg(value_name = "TOUCHES.csv")]
    touches: PathBuf,
    /// Known direction of a cylinder's axis; found from the normals without it
    #[arg(long, value_delimiter = ',', value_name = "X,Y,Z", allow_negative_numbers = true)]
    axis: Option<Vec<f64>>,
    /// Roughly the outward direction of a plane
    #[arg(
        long,
        value_delimiter = ',',
        value_name = "X,Y,Z",
        allow_negative_numbers = true,
        default_value = "0,0,1"
    )]
    outward: Vec<f64>,
    /// The wrenches are what the fingertip does to the world, not the load on it; a --scene says it itself
    #[arg(long)]
    reaction: bool,
    /// Standard deviations of a force and of a torque; without them forces are taken as exact, and sizes come out
    /// too small where they are not
    #[arg(long, value_delimiter = ',', value_name = "N,N·m")]
    noise: Option<Vec<f64>>,
    /// A scene, from which -o takes all but the surface; of a pose all but that
    #[arg(long, value_name = "SCENE.toml")]
    scene: Option<PathBuf>,
    /// Where to write a scene with what was found
    #[arg(short, long, value_name = "SCENE.toml")]
    output: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FittedShape {
    /// Radius and centre
    Sphere,
    /// Semi-axes, centre and orientation
    Ellipsoid,
    /// An ellipsoid whose axes are those of the sensor
    AlignedEllipsoid,
    /// Radius, place and direction of the axis
    Cylinder,
    /// Offset and normal of a flat fingertip, from pivots
    Plane,
    /// The point that was held still
    Pivot,
    /// Pose of a known surface, from touches at known points of it
    Pose,
}

/// What was found: lines for the terminal, and the sections of a scene.
struct Found {
    lines: Vec<String>,
    scene: String,
    unobserved: Vec<String>,
    rms: f64,
    noise_scale: f64,
}

/// More than this times the stated noise is left: something is not as stated.
const TOO_NOISY: f64 = 2.0;

pub(crate) fn run(arguments: &GeometryArguments) -> Result<(), CliError> {
    let inputs = [Some(&arguments.touches), arguments.scene.as_ref()];
    let outputs =
        Outputs::guard(arguments.overwrite, "output", inputs.into_iter().flatten(), &arguments.output)?;
    let path = &arguments.touches;
    let known = arguments.scene.as_deref().map(|scene| Known::read(scene, &outputs)).transpose()?;
    let reaction = Known::reaction(known.as_ref(), arguments.reaction)?;
    let columns = read_columns("table of touches", path)?;
    let found = find(arguments, &columns, reaction).map_err(|message| bad(path, &message))?;
    let mut text = found.lines.join("\n");
    text.push_str("\n± is half of an interval of 95 %\n");
    text.push_str(&format!("{} touches; {:.3e} N·m of torque are left (RMS)\n", columns.rows(), found.rms));
    if arguments.noise.is_none() {
        text.push_str(
            "forces are taken as exact: if they are not, sizes come out too small; --noise says their errors\n",
        );
    } else if found.noise_scale > TOO_NOISY {
        text.push_str(&format!(
            "what is left is {:.1} times what --noise says: the shape, the normals or the noise are not as stated\n",
            found.noise_scale
        ));
    }
    for what in &found.unobserved {
        text.push_str(&format!("not observed: {what}\n"));
    }
    if let Some(output) = &arguments.output {
        let text = written::scene(arguments, known, reaction, &found.scene)?;
        outputs.write("scene", output, &text)?;
    }
    outputs.say(&text, &[])
}

fn find(arguments: &GeometryArguments, columns: &Columns, reaction: bool) -> Result<Found, String> {
    let loads = columns.wrenches().map_err(text)?;
    let sign = if reaction { -1.0 } else { 1.0 };
    let wrenches: Vec<Wrench<f64>> =
        loads.iter().map(|load| Wrench::from_components(&(load * sign))).collect();
    let touches = || -> Result<Vec<ShapeTouch>, String> {
        let normals = columns.vectors(["nx", "ny", "nz"]).map_err(text)?;
        Ok(wrenches
            .iter()
            .zip(normals)
            .map(|(wrench, normal)| ShapeTouch { wrench: *wrench, normal })
            .collect())
    };
    let noise = &match arguments.noise.as_deref() {
        None => WrenchNoise::exact_forces(),
        Some([force, torque]) => {
            WrenchNoise::new(*force, *torque).map_err(|error| format!("--noise: {error}"))?
        }
        Some(other) => return Err(format!("--noise takes two numbers, not {}", other.len())),
    };
    match arguments.shape {
        FittedShape::Sphere => sphere(&touches()?, noise),
        FittedShape::Ellipsoid => ellipsoid(&touches()?, noise),
        FittedShape::AlignedEllipsoid => aligned_ellipsoid(&touches()?, noise),
        FittedShape::Cylinder => cylinder(&touches()?, arguments.axis.as_deref(), noise),
        FittedShape::Plane => plane(&by_pivot(columns, &wrenches)?, &arguments.outward, noise),
        FittedShape::Pivot => pivot(&wrenches, noise),
        FittedShape::Pose => {
            let points = columns.vectors(["px_m", "py_m", "pz_m"]).map_err(text)?;
            pose(&wrenches.iter().copied().zip(points).collect::<Vec<_>>(), noise)
        }
    }
}

fn text(error: impl core::fmt::Display) -> String {
    error.to_string()
}

fn sphere(touches: &[ShapeTouch], noise: &WrenchNoise) -> Result<Found, String> {
    let fit = fit_sphere(touches, noise).map_err(text)?;
    let widths = fit.half_widths(0.95);
    let (radius, centre) = (fit.shape.radius(), fit.shape.centre());
    let lines = vec![length("radius", radius, widths.first()), point("centre", &centre, widths.get(1..4))];
    let centre = list(&centre);
    let scene = format!("[surface]\nshape = \"sphere\"\nradius_m = {radius:?}\ncentre_m = {centre}\n");
    Ok(Found::of(&fit, lines, scene))
}

fn ellipsoid(touches: &[ShapeTouch], noise: &WrenchNoise) -> Result<Found, String> {
    let fit = fit_ellipsoid(touches, noise).map_err(text)?;
    let widths = fit.half_widths(0.95);
    let (axes, pose) = (fit.shape.semi_axes, fit.shape.sensor_from_ellipsoid);
    let turn = rotation_vector(&pose);
    let spread = widths.get(6..9).unwrap_or_default();
    let spread: Vec<String> = spread.iter().map(|s| format!("{:.2}", s.to_degrees())).collect();
    let lines = vec![
        point("semi-axes", &axes, widths.get(..3)),
        point("centre", &pose.origin(), widths.get(3..6)),
        format!(
            "orientation     {:+.3} {:+.3} {:+.3}° (rotation vector; ± {}° about the principal axes)",
            turn.x,
            turn.y,
            turn.z,
            spread.join(" ")
        ),
    ];
    let scene = format!(
        "[surface]\nshape = \"ellipsoid\"\nsemi_axes_m = {}\n\n[pose]\ntranslation_m = {}\nrotation_deg = {}\n",
        list(&axes),
        list(&pose.origin()),
        list(&turn)
    );
    Ok(Found::of(&fit, lines, scene))
}

fn aligned_ellipsoid(touches: &[ShapeTouch], noise: &WrenchNoise) -> Result<Found, String> {
    let fit = fit_aligned_ellipsoid(touches, noise).map_err(text)?;
    let widths = fit.half_widths(0.95);
    let (axes, centre) = (fit.shape.semi_axes, fit.shape.centre);
    let lines = vec![point("semi-axes", &axes, widths.get(..3)), point("centre", &centre, widths.get(3..6))];
    let scene = format!(
        "[surface]\nshape = \"ellipsoid\"\nsemi_axes_m = {}\n\n[pose]\ntranslation_m = {}\n",
        list(&axes),
        list(&centre)
    );
    Ok(Found::of(&fit, lines, scene))
}

fn cylinder(touches: &[ShapeTouch], axis: Option<&[f64]>, noise: &WrenchNoise) -> Result<Found, String> {
    let fit = match axis {
        Some(axis) => fit_cylinder_along(touches, &direction("--axis", axis)?, noise),
        None => fit_cylinder(touches, noise),
    };
    let fit = fit.map_err(text)?;
    let widths = fit.half_widths(0.95);
    let (centre, axis, radius) = (fit.shape.centre(), fit.shape.axis(), fit.shape.radius());
    let tilt = tilt(widths.get(3..5)).unwrap_or_else(|| " (given)".to_owned());
    let lines = vec![
        length("radius", radius, widths.first()),
        point("point of axis", &centre, None),
        format!("axis            {:+.5} {:+.5} {:+.5}{tilt}", axis.x, axis.y, axis.z),
    ];
    let scene = format!(
        "[surface]\nshape = \"cylinder\"\nradius_m = {radius:?}\ncentre_m = {}\naxis = {}\n",
        list(&centre),
        list(&axis)
    );
    Ok(Found::of(&fit, lines, scene))
}

/// The wrenches of each point that was held still.
fn by_pivot(columns: &Columns, wrenches: &[Wrench<f64>]) -> Result<Vec<Vec<Wrench<f64>>>, String> {
    let names = columns.texts("pivot").map_err(text)?;
    let mut pivots: Vec<(&str, Vec<Wrench<f64>>)> = Vec::new();
    for (name, wrench) in names.iter().zip(wrenches) {
        match pivots.iter_mut().find(|(known, _)| known == name) {
            Some((_, list)) => list.push(*wrench),
            None => pivots.push((name, vec![*wrench])),
        }
    }
    Ok(pivots.into_iter().map(|(_, list)| list).collect())
}

fn plane(pivots: &[Vec<Wrench<f64>>], outward: &[f64], noise: &WrenchNoise) -> Result<Found, String> {
    let fit = fit_plane(pivots, &direction("--outward", outward)?, noise).map_err(text)?;
    let widths = fit.half_widths(0.95);
    let (normal, offset) = (fit.shape.normal, fit.shape.offset);
    let tilt = tilt(widths.get(1..3)).unwrap_or_default();
    let lines = vec![
        length("offset", offset, widths.first()),
        format!("normal          {:+.5} {:+.5} {:+.5}{tilt}", normal.x, normal.y, normal.z),
        format!("pivots lie within {:.4} mm of it (RMS)", 1e3 * fit.rms),
    ];
    let scene = format!(
        "[surface]\nshape = \"plane\"\npoint_m = {}\nnormal = {}\n",
        list(&(normal * offset)),
        list(&normal)
    );
    let mut found = Found::of(&fit, lines, scene);
    // What is left of the torques is asked of each pivot.
    found.rms = 0.0;
    for pivot in pivots {
        let rms = fit_meeting_point(pivot, noise).map_err(text)?.rms;
        found.rms = found.rms.hypot(rms / (pivots.len() as f64).sqrt());
    }
    Ok(found)
}

fn pivot(wrenches: &[Wrench<f64>], noise: &WrenchNoise) -> Result<Found, String> {
    let fit = fit_meeting_point(wrenches, noise).map_err(text)?;
    let widths = fit.half_widths(0.95);
    let lines = vec![point("pivot", &fit.shape, widths.get(..3))];
    Ok(Found::of(&fit, lines, String::new()))
}

fn pose(touches: &[(Wrench<f64>, Vector3<f64>)], noise: &WrenchNoise) -> Result<Found, String> {
    let fit = fit_pose(touches, noise).map_err(text)?;
    let widths = fit.half_widths(0.95);
    let turn = rotation_vector(&fit.shape);
    let spread = widths.get(..3).unwrap_or_default();
    let spread: Vec<String> = spread.iter().map(|s| format!("{:.3}", s.to_degrees())).collect();
    let lines = vec![
        format!(
            "rotation        {:+.4} {:+.4} {:+.4}° (rotation vector; ± {})",
            turn.x,
            turn.y,
            turn.z,
            spread.join(" ")
        ),
        point("origin", &fit.shape.origin(), widths.get(3..6)),
    ];
    let scene =
        format!("[pose]\ntranslation_m = {}\nrotation_deg = {}\n", list(&fit.shape.origin()), list(&turn));
    Ok(Found::of(&fit, lines, scene))
}

/// Axis times angle, in degrees.
fn rotation_vector(pose: &RigidTransform<f64>) -> Vector3<f64> {
    Rotation3::from_matrix_unchecked(pose.rotation()).scaled_axis().map(f64::to_degrees)
}

impl Found {
    fn of<S>(fit: &Fitted<S>, lines: Vec<String>, scene: String) -> Self {
        Self { lines, scene, unobserved: fit.unobserved.clone(), rms: fit.rms, noise_scale: fit.noise_scale }
    }
}

fn direction(option: &str, list: &[f64]) -> Result<Vector3<f64>, String> {
    match list {
        [x, y, z] => Ok(Vector3::new(*x, *y, *z)),
        other => Err(format!("{option} takes three numbers, not {}", other.len())),
    }
}

/// As TOML has lists.
fn list(v: &Vector3<f64>) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}
