//! A fingertip of one's own: a moulded gel tip, round like a barrel below and flattened on top,
//! given by its equation and a ball around it. The laws check the surface; point contact then works as
//! on any other shape.
//!
//! `cargo run --example custom_surface`

use fingertip::contact::{ContactModel, PointContact};
use fingertip::nalgebra::Vector3;
use fingertip::surfaces::testing::SurfaceLaws;
use fingertip::surfaces::{Implicit, ImplicitSurface, Term};
use fingertip::wrench::Wrench;

/// `(x² + y²)/R² + (z/H)⁴ = 1`: radius R at the mount, height H, nearly flat on top \[m\].
struct GelTip {
    radius: f64,
    height: f64,
}

impl ImplicitSurface<f64> for GelTip {
    fn formula(&self, [x, y, z]: [Term<f64>; 3]) -> Term<f64> {
        (x / self.radius).square() + (y / self.radius).square() + (z / self.height).powi(4) - 1.0
    }

    fn ball(&self) -> (Vector3<f64>, f64) {
        // On the surface x² + y² and z are greatest at the mount and on top.
        (Vector3::zeros(), self.radius.hypot(self.height))
    }
}

fn main() -> Result<(), Box<dyn core::error::Error>> {
    let tip = Implicit::new(GelTip { radius: 0.010, height: 0.014 })?;

    SurfaceLaws::around(Vector3::zeros(), 0.0172).with_roundings(256.0).check(&tip)?;
    println!("The gel tip obeys the laws of surfaces.");

    let model = PointContact::new(0.05)?;
    for (name, at, force) in [
        ("on top", Vector3::new(0.0, 0.0, 0.014), Vector3::new(0.2, 0.0, -2.0)),
        ("on the side", Vector3::new(0.010, 0.0, 0.0), Vector3::new(-1.5, 0.3, 0.0)),
    ] {
        let wrench = Wrench::from_force_at(&at, force);
        let contact = model.resolve(&wrench, &tip).into_result()?;
        let error = (contact.point - at).norm();
        println!(
            "Pressed {name}: found {:.4} mm, off by {error:.1e} m, normal force {:.3} N, friction ratio {:.3}",
            contact.point.transpose() * 1000.0,
            contact.normal_force(),
            contact.contact_force().friction_ratio().unwrap_or(f64::NAN),
        );
        assert!(error < 1e-12);
    }
    Ok(())
}
