//! Writes `scenes/src/session.rs`: what four fingertips would report while one script is played.
//!
//! The first is the simulated fingertip of the paper. The others bear the loads of the same script
//! on other shapes and other gauges, through the same electronics.

use std::error::Error;
use std::fmt::Write;

use fingertip::wrench::gauge_layout::{GaugeLayout, isotropic_angle};
use fingertip::wrench::{SensorMatrix, Wrench};
use fingertip_simulation::{
    Design, Electronics, Imperfections, Options, Script, SimulatedFingertip, SurfacePoint, TrueContact,
};
use nalgebra::{SMatrix, SVector, Vector3};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// Rest for the tare, a press, a drag until it slips and on, release.
fn script() -> Script {
    Script::default()
        .rest(0.032)
        .press(SurfacePoint::degrees(35.0, 60.0), 4.0, 0.05)
        .hold(0.02)
        .drag(0.8, (0.5, 0.35), 0.06, 0.04)
        .release(0.03)
        .rest(0.008)
}

/// The point of an ellipsoid with these semi-axes at which the outward normal is this one.
fn on_ellipsoid(semi_axes: &Vector3<f64>, normal: &Vector3<f64>) -> Vector3<f64> {
    let scaled = normal.component_mul(semi_axes);
    scaled.component_mul(semi_axes) / scaled.norm()
}

/// The same for a capsule along the first axis.
fn on_capsule(half_length: f64, radius: f64, normal: &Vector3<f64>) -> Vector3<f64> {
    normal * radius + Vector3::x() * half_length.copysign(normal.x)
}

/// The same force at another point, and a spin torque of this arm \[m\] times the tangential force.
fn moved(contact: &TrueContact, point: &Vector3<f64>, arm: f64) -> Wrench<f64> {
    let spin = contact.normal * (contact.contact_force().tangential.norm() * arm);
    Wrench::from_force_at(point, contact.force) + Wrench::on_fingertip(Vector3::zeros(), spin)
}

/// Sixteen conversions of every channel, added up.
fn read<const N: usize>(
    electronics: &Electronics,
    strains: &SVector<f64, N>,
    unbalance: &SVector<f64, N>,
    random: &mut Pcg64Mcg,
) -> [u16; N] {
    std::array::from_fn(|gauge| {
        (0..electronics.conversions)
            .map(|_| {
                let noise: f64 = StandardNormal.sample(random);
                let input =
                    electronics.bridge(strains[gauge]) + unbalance[gauge] + noise * electronics.input_noise;
                counts(electronics.convert(input), electronics.step())
            })
            .sum()
    })
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 65 520")]
fn counts(volts: f64, step: f64) -> u16 {
    (volts / step).round() as u16
}

fn session<const N: usize>(name: &str, doc: &str, samples: &[[u16; N]]) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "\n/// {doc}");
    let _ = writeln!(text, "pub(crate) const {name}: [[u16; {N}]; {}] = [", samples.len());
    for sample in samples {
        let _ = writeln!(text, "    {sample:?},");
    }
    text + "];\n"
}

#[allow(clippy::cast_possible_truncation, reason = "to single precision")]
fn matrix<const N: usize>(name: &str, doc: &str, matrix: &SMatrix<f64, N, 6>) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "\n/// {doc}");
    let _ = writeln!(text, "pub(crate) const {name}: [[f32; 6]; {N}] = [");
    for row in matrix.row_iter() {
        let row: Vec<f32> = row.iter().map(|x| *x as f32).collect();
        let _ = writeln!(text, "    {row:?},");
    }
    text + "];\n"
}

fn main() -> Result<(), Box<dyn Error>> {
    let electronics = Electronics::default();
    let design = Design::default();
    let nominal = design.nominal_loads();
    let fingertip = SimulatedFingertip::new(&script(), Options::default())?;
    let of_paper = *fingertip.calibrated_matrix();
    let samples: Vec<_> = fingertip.collect();

    let six = design.layout()?;
    let eight = GaugeLayout::new(
        &design.beam,
        GaugeLayout::four_rosettes(isotropic_angle(design.beam.poisson_ratio)),
    )?;
    let six_gauges: SensorMatrix<f64, 6> = six.sensor_matrix(electronics.gain(), nominal)?;
    let eight_gauges: SensorMatrix<f64, 8> = eight.sensor_matrix(electronics.gain(), nominal)?;

    let mut random = Pcg64Mcg::seed_from_u64(2);
    let spread = Imperfections::default().unbalance;
    let mut draw = || -> f64 { spread * Distribution::<f64>::sample(&StandardNormal, &mut random) };
    let (of_six, of_eight) =
        (SVector::<f64, 6>::from_fn(|_, _| draw()), SVector::<f64, 8>::from_fn(|_, _| draw()));
    let (mut a, mut b, mut c, mut d) = (vec![], vec![], vec![], vec![]);
    for sample in &samples {
        let sums = sample.raw.fixed_rows::<6>(0) * f64::from(electronics.conversions);
        a.push(std::array::from_fn::<u16, 6, _>(|gauge| counts(sums[gauge], electronics.step())));
        let load = |place: &dyn Fn(&TrueContact) -> Wrench<f64>| {
            sample.truth.contact.as_ref().map_or_else(Wrench::zero, place).components()
        };
        let on_b = load(&|k| moved(k, &on_ellipsoid(&Vector3::new(14e-3, 11e-3, 9e-3), &k.normal), 1.5e-3));
        let on_c = load(&|k| moved(k, &on_capsule(4e-3, 9e-3, &k.normal), 0.0));
        let on_d = load(&|k| moved(k, &k.point, 0.0));
        b.push(read(&electronics, &(six.strain_matrix() * on_b), &of_six, &mut random));
        c.push(read(&electronics, &(eight.strain_matrix() * on_c), &of_eight, &mut random));
        d.push(read(&electronics, &(eight.strain_matrix() * on_d), &of_eight, &mut random));
    }

    println!("//! What the converters reported, as sums of sixteen conversions of 12 bits: written by");
    println!("//! `cargo run -p fingertip-scenes-record`.");
    let loads: Vec<f32> = nominal.iter().map(|x| *x as f32).collect();
    println!("\n/// Nominal loads [N, N·m].\npub(crate) const NOMINAL: [f32; 6] = {loads:?};");
    print!(
        "{}",
        matrix("PAPER", "The paper's sensor with six gauges, calibrated [V].", of_paper.normalised())
    );
    print!("{}", matrix("SIX", "The same as drawn [V].", six_gauges.normalised()));
    print!("{}", matrix("EIGHT", "Four rosettes [V].", eight_gauges.normalised()));
    print!("{}", session("A", "On a sphere of 13 mm.", &a));
    print!("{}", session("B", "On an ellipsoid, 14 × 11 × 9 mm, with spin torque.", &b));
    print!("{}", session("C", "On a capsule of 9 mm, eight gauges.", &c));
    print!("{}", session("D", "On a mesh of a sphere of 13 mm, eight gauges.", &d));
    Ok(())
}
