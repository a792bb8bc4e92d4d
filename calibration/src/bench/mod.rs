//! From the design to the bench: what one needs to turn, glue and wire a designed sensor.
//!
//! * [`template`]: the unrolled tube at 1:1, to print, check with its scales and wrap around the tube.
//! * [`placements`]: where each gauge goes, and how far off it may be.
//! * [`drawing`]: the tube with its dimensions.
//! * [`wiring`]: each bridge, arm by arm.
//!
//! Each gives [sheets](crate::sheet), for SVG and PDF.
//!
//! ```
//! use fingertip_calibration::bench::{Foil, Unrolled, template};
//! use fingertip_calibration::design::{LayoutFile, Placement};
//!
//! let file = LayoutFile::from_toml(r#"
//! version = 1
//! gauges = [
//!     { z_m = 0.0, theta_deg = 0.0, q_deg = 19.8 },   { z_m = 0.0, theta_deg = 0.0, q_deg = -19.8 },
//!     { z_m = 0.0, theta_deg = 120.0, q_deg = 19.8 }, { z_m = 0.0, theta_deg = 120.0, q_deg = -19.8 },
//!     { z_m = 0.0, theta_deg = 240.0, q_deg = 19.8 }, { z_m = 0.0, theta_deg = 240.0, q_deg = -19.8 },
//! ]
//! material = { youngs_modulus_Pa = 71.7e9, poisson_ratio = 0.33, yield_strength_Pa = 503e6 }
//! tube = { radius_m = 0.01, thickness_m = 0.0002, clamped_at_m = 0.02 }
//! loads = { force_N = [10.0, 10.0, 10.0], torque_Nm = [0.1, 0.1, 0.1] }
//! excitation = { supply_V = 5.0, gauge_factor = 2.0, amplifier_gain = 500.0 }
//! "#)?;
//! // On paper of 0.1 mm, so that the printed strip is 2π·10.15 mm long.
//! let unrolled = Unrolled::new(&file.layout(), 0.02, &Foil::default(), 1e-4)?;
//! assert!((unrolled.length() - 63.77e-3).abs() < 1e-5);
//! // Pairs of gauges are stacked; the carriers of different places do not touch.
//! assert_eq!((unrolled.stacked().len(), unrolled.overlapping().len()), (3, 0));
//! let placement = Placement { angle: 0.5_f64.to_radians(), position: 5e-5 };
//! assert!(template(&unrolled, placement).to_svg().contains("gauge-6-grid"));
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```

mod drawing;
mod foil;
#[cfg(test)]
mod label_tests;
mod template;
#[cfg(test)]
mod tests;
mod unrolled;
mod wiring;

pub use drawing::drawing;
pub use foil::Foil;
pub use template::{placements, template};
pub use unrolled::{Outline, Unrolled};
pub use wiring::{BridgeNode, wiring};

/// A length \[m\] in millimetres with so many digits behind the point, with a true minus and no "−0".
fn millimetres(length: f64, digits: usize) -> String {
    signed(length * 1e3, digits)
}

/// A number with so many digits behind the point, with a true minus and no "−0".
fn signed(number: f64, digits: usize) -> String {
    let text = format!("{:.digits$}", number.abs());
    let is_zero = text.bytes().all(|c| matches!(c, b'0' | b'.'));
    if number < 0.0 && !is_zero { format!("−{text}") } else { text }
}

/// The direction of a gauge between −90° and 90° \[°\].
fn direction(q: f64) -> f64 {
    (q.to_degrees() + 90.0).rem_euclid(180.0) - 90.0
}

/// Around the tube, from 0° to 360° \[°\], without "360.00".
fn around(theta: f64) -> f64 {
    let degrees = theta.to_degrees().rem_euclid(360.0);
    if degrees > 360.0 - 5e-3 { 0.0 } else { degrees }
}
