//! The surface on which a report says what a calibration is worth.

use std::path::PathBuf;

use clap::Args;
use fingertip::surfaces::{ActiveSurface, DynSurface};
use fingertip_calibration::Axis;
use fingertip_calibration::design::{DesignError, DesignTouch, TouchSet};
use nalgebra::Vector3;

use crate::error::CliError;
use crate::output::Outputs;
use crate::scene;

/// A little more than what most fingers need to hold: the touches press with friction up to this.
const FRICTION: f64 = 0.3;
/// Touches are thinned to about so many.
const TOUCHES: usize = 1600;
/// How far around its origin a surface of unknown extent is touched \[m\].
const REACH: f64 = 0.02;

#[derive(Debug, Args)]
pub(crate) struct TouchArguments {
    /// Say what the calibration does to contact points on a sphere of this radius about the origin
    #[arg(long, value_name = "METRES", default_value_t = 0.01)]
    pub(crate) tip_radius: f64,
    /// … or on the surface of this scene
    #[arg(long, value_name = "SCENE.toml", conflicts_with = "tip_radius")]
    pub(crate) scene: Option<PathBuf>,
    /// … under this force; half of the least full scale of a force without it
    #[arg(long, value_name = "NEWTONS")]
    pub(crate) touch_force: Option<f64>,
}

impl TouchArguments {
    /// Touches of the surface; none for a sensor that does not measure all six components. The outputs spare what the scene
    /// names.
    pub(super) fn set(
        &self,
        axes: &[Axis],
        full_scale: &[f64],
        outputs: &Outputs,
    ) -> Result<Option<TouchSet>, CliError> {
        if axes != Axis::ALL {
            return Ok(None);
        }
        let least = full_scale.iter().take(3).copied().fold(f64::INFINITY, f64::min);
        let force = self.touch_force.unwrap_or(0.5 * least);
        let fault = |error: DesignError| CliError::Design { message: error.to_string() };
        let (surface, touches) = match &self.scene {
            None => {
                let touches = DesignTouch::on_sphere(self.tip_radius, core::f64::consts::PI, FRICTION, force);
                let name = format!("a sphere of {} mm about the origin", 1e3 * self.tip_radius);
                (name, touches.map_err(fault)?)
            }
            Some(path) => {
                let scene = scene::load(path)?;
                outputs.spare(scene.files())?;
                scene::warn_of_doubts(&scene);
                (format!("the surface of {}", path.display()), on(scene.surface(), force).map_err(fault)?)
            }
        };
        let step = touches.len() / TOUCHES + 1;
        let touches: Vec<DesignTouch> = touches.into_iter().step_by(step).collect();
        Ok(Some(TouchSet { surface, touches }))
    }
}

fn on(surface: &DynSurface<f64>, force: f64) -> Result<Vec<DesignTouch>, DesignError> {
    fn all<S: ActiveSurface<f64>>(
        surface: &S,
        centre: Vector3<f64>,
        reach: f64,
        force: f64,
    ) -> Result<Vec<DesignTouch>, DesignError> {
        DesignTouch::on_surface(surface, centre, reach, FRICTION, force)
    }
    match surface {
        DynSurface::Plane(plane) => all(plane, plane.point(), REACH, force),
        DynSurface::Sphere(cap) => all(cap, cap.sphere().centre(), cap.sphere().radius(), force),
        DynSurface::Cylinder(cylinder) => {
            let reach = cylinder.radius().hypot(cylinder.half_length().unwrap_or(REACH));
            all(cylinder, cylinder.centre(), reach, force)
        }
        DynSurface::Disk(disk) => all(disk, disk.plane().point(), REACH, force),
        DynSurface::CappedCylinder(cylinder) => all(cylinder, cylinder.centre(), REACH, force),
        DynSurface::Capsule(capsule) => all(capsule, capsule.centre(), REACH, force),
        DynSurface::Cone(cone) => all(cone, cone.apex(), REACH, force),
        DynSurface::Frustum(frustum) => all(frustum, frustum.base_centre(), REACH, force),
        DynSurface::Posed(other) => all(other.as_ref(), other.sensor_from_shape().origin(), REACH, force),
        other => all(other, Vector3::zeros(), REACH, force),
    }
}
