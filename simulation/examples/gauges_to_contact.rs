//! From the gauges of a fingertip to the contact, on the host, without hardware:
//! `cargo run --release -p fingertip-simulation --example gauges_to_contact`
//!
//! A simulated ADS131M08 converts six quarter bridges and, at the same moment, their excitation, which sags
//! when a load is switched on. Its frames go through the driver, the bridges' front end, the tare and
//! the sensor matrix to wrenches, and those to contacts. On a microcontroller the first three lines of
//! `main` are the pins and the bus of its HAL; all else stays as it is.

use core::error::Error;

use fingertip::Fingertip;
use fingertip::contact::PointContact;
use fingertip::friction::Coulomb;
use fingertip::wrench::{GaussianElimination, SensorMatrix, TareAccumulator, Wrench};
use fingertip_drivers::bridge::{
    BridgeChannel, BridgeCircuit, BridgeFrontEnd, Bridged, CountScale, Excitation,
};
use fingertip_drivers::converters::ads131m::{
    Ads131m, ChannelSetup, Configuration, Gain, Oversampling, SimulatedAds131m,
};
use fingertip_drivers::converters::{Patience, SimulatedBench, WireFaults};
use fingertip_drivers::middleware::Solved;
use fingertip_drivers::{Source, SourceError, SourceErrorKind};
use fingertip_simulation::{Design, SurfacePoint};
use nalgebra::{SMatrix, SVector, Vector3};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

const GAUGE_FACTOR: f64 = 2.0;
/// Volts at the bridges; a quarter of it is at channel 6.
const EXCITATION: f64 = 2.5;
const DIVIDER: f64 = 4.0;
/// Standard deviation of the noise at the inputs \[V\], for this example.
const NOISE: f64 = 0.3e-6;
/// Clock of the converter \[Hz\].
const CLOCK: f64 = 8.192e6;

/// One press, summed up over its samples.
#[derive(Default)]
struct Press {
    at: Vector3<f64>,
    force: f64,
    place: Vector3<f64>,
    /// Of the distance between the place and the true one.
    squares: f64,
    count: f64,
}

/// The load at a time \[s\]: at rest for half a second, then pressed at three places in turn.
fn load(design: &Design, time: f64) -> (Vector3<f64>, Wrench<f64>) {
    let places = [(0.0, 0.0, 0.5), (35.0, 40.0, 3.0), (80.0, 200.0, 12.0)];
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
    let place = places.get(((time - 0.5) / 0.2).max(0.0) as usize).filter(|_| time > 0.5);
    let Some((from_top, azimuth, force)) = place else { return (Vector3::zeros(), Wrench::zero()) };
    let at = SurfacePoint::degrees(*from_top, *azimuth);
    let point = at.direction() * design.sphere_radius;
    // With some friction to the side.
    let force = (at.tangent(0.3) * 0.3 - at.direction()) * *force;
    (point, Wrench::from_force_at(&point, force))
}

/// Volts at the eight inputs.
fn input(design: Design, strain_matrix: SMatrix<f64, 6, 6>) -> impl FnMut(f64) -> [f64; 8] + Send {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    move |time| {
        let strain = strain_matrix * load(&design, time).1.components();
        // It sags by 2 % half way.
        let excitation = if time > 0.8 { 0.98 * EXCITATION } else { EXCITATION };
        let mut volts = [0.0; 8];
        for (channel, (place, strain)) in volts.iter_mut().zip(strain.iter()).enumerate() {
            // Out of balance by some hundred µm/m at rest.
            let unbalance = 1e-4 * (channel as f64 - 2.5);
            *place = excitation * BridgeCircuit::quarter().ratio(GAUGE_FACTOR * (strain + unbalance));
        }
        if let Some(place) = volts.get_mut(6) {
            *place = excitation / DIVIDER;
        }
        volts.map(|volts| {
            let noise: f64 = StandardNormal.sample(&mut random);
            volts + NOISE * noise
        })
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    // The converter on its bus. One bit in a hundred frames is flipped on the way.
    let design = Design::default();
    let strain_matrix = design.layout()?.strain_matrix();
    let faults = WireFaults { answer_flip: 0.01, seed: 1, ..WireFaults::default() };
    let bench =
        SimulatedBench::new(SimulatedAds131m::<8>::new(input(design, strain_matrix)), WireFaults::default());
    let patience = Patience { limit: 20_000, pause: 20 };
    let mut converter = Ads131m::new(bench.spi(), bench.ready(), bench.delay(), patience);
    let mut channels = [ChannelSetup::with_gain(Gain::X128); 8];
    let [.., excitation, spare] = &mut channels;
    (*excitation, *spare) = (ChannelSetup::with_gain(Gain::X1), ChannelSetup::off());
    let configuration =
        Configuration { channels, oversampling: Oversampling::X4096, lock: true, ..Configuration::default() };
    converter.configure(&configuration)?;
    bench.set_faults(faults);

    // Six quarter bridges, and the excitation beside them.
    let reference = Configuration::<8>::REFERENCE;
    let full_scale = |channel| configuration.full_scale(channel, reference).ok_or("no such channel");
    let mut bridges =
        [BridgeChannel::new(0, BridgeCircuit::quarter(), GAUGE_FACTOR, CountScale::bits24(full_scale(0)?));
            6];
    let counts_of_noise = NOISE / full_scale(0)? * 8_388_608.0;
    for (input, bridge) in bridges.iter_mut().enumerate() {
        *bridge = BridgeChannel { input, ..bridge.noise(counts_of_noise) };
    }
    let excitation =
        Excitation::Measured { channel: 6, volts_per_count: DIVIDER * full_scale(6)? / 8_388_608.0 };
    let front_end = BridgeFrontEnd::<f64, 6, 8>::new(bridges, excitation)?;
    let counts =
        Source::<f64, SVector<f64, 8>>::next_sample(&mut converter)?.ok_or("the converter has ended")?;
    let at_rest = front_end.strain_with_bounds(&counts.value)?;
    println!(
        "strain: resolution {:.4} µm/m, noise {:.3} µm/m",
        at_rest.resolution.max() * 1e6,
        at_rest.noise.max() * 1e6
    );

    // The tare of 200 samples, and the wrenches.
    let mut strains = Bridged::new(converter, front_end);
    let mut tare = TareAccumulator::<f64, 6>::default();
    let mut damaged = 0;
    for _ in 0..200 {
        match strains.next_sample() {
            Ok(Some(sample)) => drop(tare.add(&sample.value)),
            Ok(None) => break,
            Err(error) if error.kind() == SourceErrorKind::Corrupt => damaged += 1,
            Err(error) => return Err(error.into()),
        }
    }
    let sensor = SensorMatrix::from_sensitivities(strain_matrix, design.nominal_loads())?;
    let mut wrenches = Solved::new(strains, tare.finish()?, GaussianElimination::new(&sensor)?);

    // And contacts.
    let mut fingertip = Fingertip::builder()
        .contact(design.sphere()?, PointContact::new(0.05)?)
        .friction(Coulomb::new(0.6)?)
        .build();
    let step = 1.0 / configuration.data_rate(CLOCK);
    #[allow(clippy::cast_precision_loss, reason = "a time")]
    let mut time = bench.now() as f64 * 1e-9;
    let mut presses: Vec<Press> = Vec::new();
    while time < 1.1 {
        let wrench = match wrenches.next_sample() {
            Ok(Some(sample)) => sample.value,
            Ok(None) => break,
            Err(error) if error.kind() == SourceErrorKind::Corrupt => {
                damaged += 1;
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        #[allow(clippy::cast_precision_loss, reason = "a time")]
        let now = bench.now() as f64 * 1e-9;
        time = now;
        // A conversion is older than its reading by up to a period: leave out the steps of the load.
        let (point, _) = load(&design, time - step);
        if time < 0.5 || (time - 0.5).rem_euclid(0.2) < 3.0 * step {
            continue;
        }
        let touch = fingertip.sense_wrench(wrench, step);
        let Ok(contact) = touch.resolution.into_result() else { continue };
        if presses.last().is_none_or(|press| press.at != point) {
            presses.push(Press { at: point, ..Press::default() });
        }
        if let Some(press) = presses.last_mut() {
            press.force += contact.force.norm();
            press.place += contact.point;
            press.squares += (contact.point - point).norm_squared();
            press.count += 1.0;
        }
    }
    for Press { at, force, place, squares, count } in &presses {
        let (error, scatter) = ((place / *count - at).norm(), (squares / count).sqrt());
        println!(
            "{:6.3} N, {count} samples: each within {:.3} mm (r.m.s.), their mean {:.3} mm off",
            force / count,
            scatter * 1e3,
            error * 1e3
        );
        // The mean of noise that is independent from sample to sample.
        if error > 5.0 * scatter / count.sqrt() {
            return Err("a contact is further off than noise makes it".into());
        }
    }
    println!("{damaged} samples were damaged on the way and left out");
    if presses.len() != 3 {
        return Err("a press was not felt".into());
    }
    Ok(())
}
