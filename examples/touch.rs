//! The smallest scene: six volts in, a contact and its slip margin out.
//!
//! `cargo run --example touch`

use fingertip::Fingertip;
use fingertip::contact::{PointContact, Resolution};
use fingertip::friction::Coulomb;
use fingertip::nalgebra::{Vector3, Vector6};
use fingertip::surfaces::Sphere;
use fingertip::wrench::gauge_layout::{GaugeLayout, ThinWalledBeam};
use fingertip::wrench::{GaussianElimination, Wrench};

fn main() -> Result<(), Box<dyn core::error::Error>> {
    // The sensor: here from its drawing (Bicchi & Dario 1987); usually from a calibration file.
    let beam = ThinWalledBeam { radius: 5e-3, thickness: 0.3e-3, youngs_modulus: 70e9, poisson_ratio: 0.33 };
    let gauges = GaugeLayout::bicchi_dario_gauges(14.0_f32.to_radians(), 10e-3);
    let nominal = Vector6::new(30.0, 30.0, 30.0, 0.3, 0.3, 0.3);
    let volts_per_strain = 2500.0;
    let sensor = GaugeLayout::new(&beam, gauges)?.sensor_matrix(volts_per_strain, nominal)?;

    // The scene: a 13 mm sphere, contacts above 0.1 N, friction coefficient 0.6.
    let mut fingertip = Fingertip::builder()
        .solver(GaussianElimination::new(&sensor)?)
        .contact(Sphere::centred(13e-3)?, PointContact::new(0.1)?)
        .friction(Coulomb::new(0.6)?)
        .build();

    // What the converter would have read while an object presses and pulls sideways.
    let load = Wrench::from_force_at(&Vector3::new(0.0, 0.0, 13e-3), Vector3::new(0.5, 0.0, -2.0));
    let volts = sensor.signals(&load);

    let touch = fingertip.sense(&volts, 1e-3);
    match touch.resolution {
        Resolution::Contact(contact) => {
            let [x, y, z] = (contact.point * 1e3).into();
            println!("touched at ({x:.2}, {y:.2}, {z:.2}) mm");
            println!("pressing with {:.3} N", contact.normal_force());
            println!("sideways with {:.3} N", contact.contact_force().tangential_magnitude());
        }
        Resolution::NoContact(reason) => println!("no contact: {reason}"),
    }
    if let Some(margin) = touch.grip {
        println!(
            "{:.3} N from slipping, {:.0} % of the limit used",
            margin.newtons,
            margin.utilisation * 100.0
        );
    }
    Ok(())
}
