//! `fingertip geometry`: the shape of the fingertip's surface from touches, as a scene.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use fingertip::wrench::{RigidTransform, Wrench};
use fingertip_calibration::geometry::{
    Fitted, Touch, fit_aligned_ellipsoid, fit_cylinder, fit_cylinder_along, fit_ellipsoid, fit_meeting_point,
    fit_plane, fit_pose, fit_sphere,
};
use fingertip_calibration::loads::Columns;
use nalgebra::{Rotation3, Vector3};

use crate::calibrate::files::{bad, read_columns};
use crate::error::CliError;
use crate::output::{Outputs, Overwrite};

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
    /// The wrenches are what the fingertip does to the world, not the load on it
    #[arg(long)]
    reaction: bool,
    /// Where to write a scene with the surface
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
}

pub(crate) fn run(arguments: &GeometryArguments) -> Result<(), CliError> {
    let outputs = Outputs::guard(arguments.overwrite, "output", [&arguments.touches], &arguments.output)?;
    let path = &arguments.touches;
    let columns = read_columns("table of touches", path)?;
    let found = find(arguments, &columns).map_err(|message| bad(path, &message))?;
    let mut text = found.lines.join("\n");
    text.push_str(&format!("\n{} touches; {:.3e} N·m of torque are left (RMS)\n", columns.rows(), found.rms));
    for what in &found.unobserved {
        text.push_str(&format!("not observed: {what}\n"));
    }
    if let Some(output) = &arguments.output {
        let convention = if arguments.reaction { "reaction" } else { "on_fingertip" };
        let head = format!("version = 1\n\n[input]\nconvention = \"{convention}\"\n\n");
        let scene = if arguments.shape == FittedShape::Pose { found.scene } else { head + &found.scene };
        outputs.write("scene", output, &scene)?;
    }
    outputs.say(&text, &[])
}

fn find(arguments: &GeometryArguments, columns: &Columns) -> Result<Found, String> {
    let loads = columns.wrenches().map_err(text)?;
    let sign = if arguments.reaction { -1.0 } else { 1.0 };
    let wrenches: Vec<Wrench<f64>> =
        loads.iter().map(|load| Wrench::from_components(&(load * sign))).collect();
    let touches = || -> Result<Vec<Touch>, String> {
        let normals = columns.vectors(["nx", "ny", "nz"]).map_err(text)?;
        Ok(wrenches.iter().zip(normals).map(|(wrench, normal)| Touch { wrench: *wrench, normal }).collect())
    };
    match arguments.shape {
        FittedShape::Sphere => sphere(&touches()?),
        FittedShape::Ellipsoid => ellipsoid(&touches()?),
        FittedShape::AlignedEllipsoid => aligned_ellipsoid(&touches()?),
        FittedShape::Cylinder => cylinder(&touches()?, arguments.axis.as_deref()),
        FittedShape::Plane => plane(&by_pivot(columns, &wrenches)?, &arguments.outward),
        FittedShape::Pivot => pivot(&wrenches),
        FittedShape::Pose => {
            let points = columns.vectors(["px_m", "py_m", "pz_m"]).map_err(text)?;
            pose(&wrenches.iter().copied().zip(points).collect::<Vec<_>>())
        }
    }
}

fn text(error: impl core::fmt::Display) -> String {
    error.to_string()
}

fn sphere(touches: &[Touch]) -> Result<Found, String> {
    let fit = fit_sphere(touches).map_err(text)?;
    let (radius, centre) = (fit.shape.radius(), fit.shape.centre());
    let lines = vec![
        length("radius", radius, fit.deviations.first()),
        point("centre", &centre, fit.deviations.get(1..4)),
    ];
    let centre = list(&centre);
    let scene = format!("[surface]\nshape = \"sphere\"\nradius_m = {radius:?}\ncentre_m = {centre}\n");
    Ok(Found::of(&fit, lines, scene))
}

fn ellipsoid(touches: &[Touch]) -> Result<Found, String> {
    let fit = fit_ellipsoid(touches).map_err(text)?;
    let (axes, pose) = (fit.shape.semi_axes, fit.shape.sensor_from_ellipsoid);
    let turn = rotation_vector(&pose);
    let spread = fit.deviations.get(6..9).unwrap_or_default();
    let spread: Vec<String> = spread.iter().map(|s| format!("{:.2}", s.to_degrees())).collect();
    let lines = vec![
        point("semi-axes", &axes, fit.deviations.get(..3)),
        point("centre", &pose.origin(), fit.deviations.get(3..6)),
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

fn aligned_ellipsoid(touches: &[Touch]) -> Result<Found, String> {
    let fit = fit_aligned_ellipsoid(touches).map_err(text)?;
    let (axes, centre) = (fit.shape.semi_axes, fit.shape.centre);
    let lines = vec![
        point("semi-axes", &axes, fit.deviations.get(..3)),
        point("centre", &centre, fit.deviations.get(3..6)),
    ];
    let scene = format!(
        "[surface]\nshape = \"ellipsoid\"\nsemi_axes_m = {}\n\n[pose]\ntranslation_m = {}\n",
        list(&axes),
        list(&centre)
    );
    Ok(Found::of(&fit, lines, scene))
}

fn cylinder(touches: &[Touch], axis: Option<&[f64]>) -> Result<Found, String> {
    let fit = match axis {
        Some(axis) => fit_cylinder_along(touches, &direction("--axis", axis)?),
        None => fit_cylinder(touches),
    };
    let fit = fit.map_err(text)?;
    let (centre, axis, radius) = (fit.shape.centre(), fit.shape.axis(), fit.shape.radius());
    let tilt = tilt(fit.deviations.get(3..5)).unwrap_or_else(|| " (given)".to_owned());
    let lines = vec![
        length("radius", radius, fit.deviations.first()),
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

fn plane(pivots: &[Vec<Wrench<f64>>], outward: &[f64]) -> Result<Found, String> {
    let fit = fit_plane(pivots, &direction("--outward", outward)?).map_err(text)?;
    let (normal, offset) = (fit.shape.normal, fit.shape.offset);
    let tilt = tilt(fit.deviations.get(1..3)).unwrap_or_default();
    let lines = vec![
        length("offset", offset, fit.deviations.first()),
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
        let rms = fit_meeting_point(pivot).map_err(text)?.rms;
        found.rms = found.rms.hypot(rms / (pivots.len() as f64).sqrt());
    }
    Ok(found)
}

fn pivot(wrenches: &[Wrench<f64>]) -> Result<Found, String> {
    let fit = fit_meeting_point(wrenches).map_err(text)?;
    let lines = vec![point("pivot", &fit.shape, fit.deviations.get(..3))];
    let scene = format!("# pivot_m = {}\n", list(&fit.shape));
    Ok(Found::of(&fit, lines, scene))
}

fn pose(touches: &[(Wrench<f64>, Vector3<f64>)]) -> Result<Found, String> {
    let fit = fit_pose(touches).map_err(text)?;
    let turn = rotation_vector(&fit.shape);
    let spread = fit.deviations.get(..3).unwrap_or_default();
    let spread: Vec<String> = spread.iter().map(|s| format!("{:.3}", s.to_degrees())).collect();
    let lines = vec![
        format!(
            "rotation        {:+.4} {:+.4} {:+.4}° (rotation vector; ± {})",
            turn.x,
            turn.y,
            turn.z,
            spread.join(" ")
        ),
        point("origin", &fit.shape.origin(), fit.deviations.get(3..6)),
    ];
    let scene =
        format!("[pose]\ntranslation_m = {}\nrotation_deg = {}\n", list(&fit.shape.origin()), list(&turn));
    Ok(Found::of(&fit, lines, scene))
}

/// Axis times angle, in degrees.
fn rotation_vector(pose: &RigidTransform<f64>) -> Vector3<f64> {
    Rotation3::from_matrix_unchecked(pose.rotation()).scaled_axis().map(f64::to_degrees)
}

/// How well a direction is known, about two axes \[rad\].
fn tilt(deviations: Option<&[f64]>) -> Option<String> {
    let [a, b] = *deviations? else { return None };
    Some(format!(" (± {:.3} {:.3}°)", a.to_degrees(), b.to_degrees()))
}

impl Found {
    fn of<S>(fit: &Fitted<S>, lines: Vec<String>, scene: String) -> Self {
        Self { lines, scene, unobserved: fit.unobserved.clone(), rms: fit.rms }
    }
}

fn direction(option: &str, list: &[f64]) -> Result<Vector3<f64>, String> {
    match list {
        [x, y, z] => Ok(Vector3::new(*x, *y, *z)),
        other => Err(format!("{option} takes three numbers, not {}", other.len())),
    }
}

fn length(name: &str, metres: f64, deviation: Option<&f64>) -> String {
    let spread = deviation.map_or_else(String::new, |s| format!(" ± {:.4}", 1e3 * s));
    format!("{name:<15} {:.4}{spread} mm", 1e3 * metres)
}

fn point(name: &str, metres: &Vector3<f64>, deviations: Option<&[f64]>) -> String {
    let v = metres * 1e3;
    let spread = deviations.map_or_else(String::new, |list| {
        let list: Vec<String> = list.iter().map(|s| format!("{:.4}", 1e3 * s)).collect();
        format!(" (± {})", list.join(" "))
    });
    format!("{name:<15} {:+.4} {:+.4} {:+.4} mm{spread}", v.x, v.y, v.z)
}

/// As TOML has lists.
fn list(v: &Vector3<f64>) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}
