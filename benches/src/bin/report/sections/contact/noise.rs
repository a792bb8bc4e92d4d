//! Where numerical error stops mattering.

use fingertip_contact::{ContactModel, PointContact, SoftFinger};
use fingertip_surfaces::Ellipsoid;
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::study::{SCALE, SPIN, Touch};
use crate::Failure;
use crate::plots::Series;
use crate::stability::contacts::pressing;
use crate::stability::levels::Level;
use crate::timing::{Effort, median};

/// Error over the noise on one ellipsoid: where f32 stops being good enough.
pub(super) fn over_noise(effort: Effort) -> Result<Vec<Series>, Failure> {
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
