//! Geometry and material of the paper's prototype.

use fingertip_surfaces::Sphere;
use fingertip_wrench::gauge_layout::{Gauge, GaugeLayout, ThinWalledBeam};
use nalgebra::{Vector3, Vector6};

use crate::error::{SimulationError, positive};

/// The sensor of Bicchi & Dario 1987, the fourth column of its table: a tube along X, six gauges,
/// a sphere around the origin.
///
/// The wall thickness follows from the range of 30 N. The worst contact of 30 N on the active
/// surface, with friction up to 0.6, strains a gauge by 450 µm/m on a wall of 0.2 mm. That is a stress
/// of 32 MPa, a ninth of the yield of the aluminium alloy 6061-T6 (276 MPa), as one wants it for
/// overload and for gauges that last. A thinner wall would give more signal but no finer
/// resolution, since the converter's range grows with it; and 0.2 mm on a 10 mm tube is about what
/// a lathe can hold.
///
/// ```
/// use fingertip_simulation::Design;
/// use nalgebra::Vector3;
///
/// let design = Design::default();
/// assert_eq!(design.sphere()?.radius(), 13e-3);
/// // The top of the sphere can be touched, the opening where the beam enters cannot.
/// assert!(design.is_active(&Vector3::x()) && !design.is_active(&-Vector3::x()));
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Design {
    /// Radius of the sphere \[m\]: 13 mm.
    pub sphere_radius: f64,
    /// Radius of the opening at the root, where the beam enters \[m\]: 7 mm, which leaves 92 % of
    /// the sphere active.
    pub opening_radius: f64,
    /// The tube: 5 mm mean radius, 0.2 mm wall, aluminium (E = 70 GPa, μ = 0.33).
    pub beam: ThinWalledBeam<f64>,
    /// Where the gauges are: the paper's six with Q = 14° and d = 10 mm. Those of another design come
    /// from its layout file.
    pub gauges: [Gauge<f64>; 6],
    /// Range of the force \[N\]: 30 N.
    pub force_range: f64,
}

impl Default for Design {
    fn default() -> Self {
        Self {
            sphere_radius: 13e-3,
            opening_radius: 7e-3,
            beam: ThinWalledBeam {
                radius: 5e-3,
                thickness: 0.2e-3,
                youngs_modulus: 70e9,
                poisson_ratio: 0.33,
            },
            gauges: GaugeLayout::bicchi_dario_gauges(14_f64.to_radians(), 10e-3),
            force_range: 30.0,
        }
    }
}

impl Design {
    /// The sphere, whole; [`is_active`](Self::is_active) tells the opening.
    ///
    /// # Errors
    /// [`SimulationError::BadParameter`].
    pub fn sphere(&self) -> Result<Sphere<f64>, SimulationError> {
        let radius = positive(self.sphere_radius, "sphere radius")?;
        let bad = |_| SimulationError::BadParameter {
            parameter: "sphere radius",
            requirement: "positive and finite",
        };
        Sphere::centred(radius).map_err(bad)
    }

    /// The greatest angle from the top that is still active \[rad\].
    #[must_use]
    pub fn greatest_angle(&self) -> f64 {
        core::f64::consts::PI - (self.opening_radius / self.sphere_radius).clamp(0.0, 1.0).asin()
    }

    /// Whether the sphere is not cut away at a point (or direction) from its centre.
    #[must_use]
    pub fn is_active(&self, point: &Vector3<f64>) -> bool {
        point.y.hypot(point.z).atan2(point.x) <= self.greatest_angle()
    }

    /// The gauges as they are meant to be.
    ///
    /// # Errors
    /// [`SimulationError::Layout`] for a beam that is none.
    pub fn layout(&self) -> Result<GaugeLayout<f64, 6>, SimulationError> {
        Ok(GaugeLayout::new(&self.beam, self.gauges)?)
    }

    /// Nominal loads \[N, N·m\]: the force range, and the torque that it makes at 10 mm, as the
    /// paper's condition numbers have it (`docs/theory/wrench.md#condition-numbers-of-the-paper`).
    #[must_use]
    pub fn nominal_loads(&self) -> Vector6<f64> {
        let (force, torque) = (self.force_range, self.force_range * 10e-3);
        Vector6::new(force, force, force, torque, torque, torque)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SurfacePoint;
    use core::f64::consts::{FRAC_PI_2, PI};
    use fingertip_test_support::Worst;
    use fingertip_wrench::Wrench;

    #[test]
    fn ninety_two_hundredths_of_the_sphere_are_active() {
        // 11.58 sr of 4π, as the paper says.
        let angle = Design::default().greatest_angle();
        let share = (1.0 - angle.cos()) / 2.0;
        assert!((share * 4.0 * PI - 11.58).abs() < 0.005, "{share}");
        assert!(
            Design::default().is_active(&SurfacePoint { from_top: angle - 1e-9, azimuth: 1.0 }.direction())
        );
        assert!(
            !Design::default().is_active(&SurfacePoint { from_top: angle + 1e-9, azimuth: 1.0 }.direction())
        );
        assert!(angle > FRAC_PI_2);
    }

    #[test]
    fn thirty_newtons_strain_a_gauge_by_at_most_450_micrometres_a_metre() {
        let design = Design::default();
        let strains = design.layout().unwrap().strain_matrix();
        let mut greatest = Worst::new();
        let angles =
            |count: u32, range: f64| (0..=count).map(move |i| range * f64::from(i) / f64::from(count));
        for from_top in angles(40, design.greatest_angle()) {
            for azimuth in angles(48, 2.0 * PI) {
                let at = SurfacePoint { from_top, azimuth };
                for heading in angles(24, 2.0 * PI) {
                    // The force as large as its range, on the cone of a friction coefficient of 0.6.
                    let force = (at.tangent(heading) * 0.6 - at.direction()) * (30.0 / 1.36_f64.sqrt());
                    let wrench: Wrench<f64> =
                        Wrench::from_force_at(&(at.direction() * design.sphere_radius), force);
                    greatest.see((strains * wrench.components()).amax());
                }
            }
        }
        let greatest = greatest.get();
        println!("greatest strain {:.1} µm/m", 1e6 * greatest);
        assert!((440e-6..=450e-6).contains(&greatest), "{greatest}");
    }
}
