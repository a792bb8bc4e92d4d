//! Objects pulled until they slip, and how a sensor reads them.

use fingertip_friction::{Bristle, Drive, ForceNoise, LuGre, Stribeck};
use fingertip_wrench::ContactForce;
use nalgebra::{Vector1, Vector3};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use crate::Failure;

/// Steps of the mechanics per second.
const MECHANICS: f64 = 50_000.0;
pub(crate) const RAMPS: usize = 1000;
const STRIBECK_SPEED: f64 = 1e-3;

/// One object pulled until it slips: the truth at 10 kHz.
#[derive(Clone)]
pub(crate) struct Ramp {
    pub(crate) normal: f64,
    pub(crate) static_coefficient: f64,
    pub(crate) tangential: Vec<f64>,
    /// When it passed the Stribeck speed \[s\].
    pub(crate) slip: f64,
    /// The noise, and the step of the converter, with which it is read.
    pub(crate) noise: f64,
    pub(crate) step: f64,
}

fn ramp(rng: &mut Pcg64Mcg, plain: bool) -> Result<Ramp, Failure> {
    let normal = rng.random_range(1.0..10.0);
    let static_coefficient = rng.random_range(0.4..1.0);
    let kinetic = static_coefficient * rng.random_range(0.6..0.85);
    // The parameters of Canudas de Wit et al. 1995, per newton of normal force.
    let curve = Stribeck::new(kinetic, static_coefficient, STRIBECK_SPEED)?;
    let mut friction = Bristle::<f64, _, 1>::new(LuGre::new(1e5, 1e5_f64.sqrt(), 0.4, curve)?);
    friction.set_load(normal);
    let mass = rng.random_range(0.02..0.3);
    let rate = normal * static_coefficient / rng.random_range(0.3..1.0);
    let (mut velocity, mut slip, mut index) = (Vector1::new(0.0), f64::NAN, 0_u32);
    let mut tangential = Vec::new();
    let h = 1.0 / MECHANICS;
    loop {
        let time = f64::from(index) * h;
        let drive = Drive { mass: Vector1::new(mass), force: Vector1::new(rate * time), stiffness: 0.0 };
        let end = friction.step_body(&velocity, &drive, h);
        velocity = end.velocity;
        if index.is_multiple_of(5) {
            tangential.push(end.friction[0]);
        }
        if slip.is_nan() && velocity[0] > STRIBECK_SPEED {
            slip = time;
        }
        if time > slip + 0.1 {
            break;
        }
        if time > 3.0 {
            return Err("a ramp did not slip".into());
        }
        index += 1;
    }
    let (noise, step) = if plain {
        (0.02, 0.0)
    } else {
        // 60 N of span at 12 or 16 bits, or no converter.
        let step = [0.0, 60.0 / 65536.0, 60.0 / 4096.0][rng.random_range(0..3)];
        (5e-3 * 10_f64.powf(rng.random_range(0.0..1.0)), step)
    };
    Ok(Ramp { normal, static_coefficient, tangential, slip, noise, step })
}

fn read(rng: &mut Pcg64Mcg, value: f64, noise: f64, step: f64) -> f64 {
    let draw: f64 = StandardNormal.sample(rng);
    let value = value + noise * draw;
    if step > 0.0 { (value / step).round() * step } else { value }
}

pub(crate) fn sample(
    rng: &mut Pcg64Mcg,
    normal: f64,
    tangential: f64,
    noise: f64,
    step: f64,
) -> ContactForce<f64> {
    ContactForce::new(
        read(rng, normal, noise, step),
        Vector3::new(read(rng, tangential, noise, step), 0.0, 0.0),
        0.0,
    )
}

/// What a user would state: the noise with that of the converter's steps.
pub(crate) fn stated(noise: f64, step: f64) -> Result<ForceNoise<f64>, Failure> {
    Ok(ForceNoise::isotropic((noise * noise + step * step / 12.0).sqrt())?)
}

/// The two sets of ramps: plain noise, and noise and converters of many kinds.
pub(crate) fn ramps() -> Result<[Vec<Ramp>; 2], Failure> {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let mut set = |plain: bool| (0..RAMPS).map(|_| ramp(&mut rng, plain)).collect::<Result<Vec<_>, _>>();
    Ok([set(true)?, set(false)?])
}
