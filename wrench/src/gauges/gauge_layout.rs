//! The forward model of strain gauges on a thin-walled cylindrical beam.
//!
//! Equations (16), (17) of Bicchi & Dario 1987 with their misprints mended:
//! `docs/theory/wrench.md#gauge-model`. The beam lies along the first axis, its tip at +X; the wrench is
//! taken about the origin (the centre of the paper's sphere). A gauge at axial distance `Z` behind the origin
//! sits at `(−Z, R cos θ, R sin θ)` and is turned by `Q` from the beam axis towards increasing `θ`.

use nalgebra::{SMatrix, Vector6};
use thiserror::Error;

use crate::{Real, SensorMatrix, SensorMatrixError};

/// Where one gauge is glued.
///
/// ```
/// use fingertip_wrench::gauge_layout::{Gauge, GaugeLayout, ThinWalledBeam};
///
/// let beam = ThinWalledBeam { radius: 5e-3, thickness: 2e-4, youngs_modulus: 70e9, poisson_ratio: 0.33 };
/// // One along the beam, one across it.
/// let along = Gauge { z: 0.0, theta: 0.0, q: 0.0 };
/// let across = Gauge { q: core::f64::consts::FRAC_PI_2, ..along };
/// let strain = GaugeLayout::new(&beam, [along, across])?.strain_matrix();
/// // What stretches the beam makes it thinner, by Poisson's ratio.
/// assert!(strain[(0, 0)] > 0.0);
/// assert!((strain[(1, 0)] / strain[(0, 0)] + 0.33).abs() < 1e-12);
/// # Ok::<(), fingertip_wrench::gauge_layout::LayoutError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gauge<T> {
    /// Axial distance behind the origin of the sensor frame \[m\].
    pub z: T,
    /// Angle around the beam from the second axis towards the third \[rad\].
    pub theta: T,
    /// Angle of the gauge from the beam axis towards increasing `theta` \[rad\].
    pub q: T,
}

/// A tube and its material.
///
/// ```
/// use core::f64::consts::PI;
/// use fingertip_wrench::gauge_layout::ThinWalledBeam;
///
/// // A tube of aluminium, 10 mm across, with a wall of 0.2 mm.
/// let beam = ThinWalledBeam { radius: 5e-3, thickness: 2e-4, youngs_modulus: 70e9, poisson_ratio: 0.33 };
/// // A newton along it is carried by 2πRs = 6.28 mm² of metal, and stretches that by 2.27 µm/m.
/// let by_hand = 1.0 / (70e9 * 2.0 * PI * 5e-3 * 2e-4);
/// assert!((beam.section_constants()?.axial / by_hand - 1.0).abs() < 1e-12);
/// # Ok::<(), fingertip_wrench::gauge_layout::LayoutError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ThinWalledBeam<T> {
    /// Mean radius of the wall R \[m\].
    pub radius: T,
    /// Wall thickness s \[m\], thin against the radius.
    pub thickness: T,
    /// Young's modulus E \[Pa\].
    pub youngs_modulus: T,
    /// Poisson's ratio μ.
    pub poisson_ratio: T,
}

/// The four section constants of equation (17): strain per unit load, before the angles.
///
/// ```
/// use fingertip_wrench::gauge_layout::ThinWalledBeam;
///
/// let beam = ThinWalledBeam { radius: 5e-3, thickness: 2e-4, youngs_modulus: 70e9, poisson_ratio: 0.25 };
/// let section = beam.section_constants()?;
/// // A newton at a lever of a radius strains the wall by bending twice as much as by pulling, by torsion
/// // 1 + μ times.
/// assert!((section.bending * 5e-3 / section.axial - 2.0_f64).abs() < 1e-12);
/// assert!((section.torsion * 5e-3 / section.axial - 1.25_f64).abs() < 1e-12);
/// # Ok::<(), fingertip_wrench::gauge_layout::LayoutError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SectionConstants<T> {
    /// Axial strain per newton, `1/(2πERs)`.
    pub axial: T,
    /// Bending strain per newton metre, `2/R` of the axial one.
    pub bending: T,
    /// Shear strain per newton at the neutral line (already halved for a gauge at 45°).
    pub shear: T,
    /// Torsion strain per newton metre.
    pub torsion: T,
}

/// What is wrong with a beam.
///
/// ```
/// use fingertip_wrench::gauge_layout::{GaugeLayout, LayoutError, ThinWalledBeam};
///
/// let beam = ThinWalledBeam { radius: 5e-3, thickness: 0.0, youngs_modulus: 70e9, poisson_ratio: 0.33 };
/// let refused = GaugeLayout::new(&beam, GaugeLayout::three_rosettes(0.3)).unwrap_err();
/// assert_eq!(refused, LayoutError::BadBeam { quantity: "wall thickness" });
/// assert_eq!(refused.to_string(), "the beam's wall thickness is out of range");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum LayoutError {
    /// A dimension or modulus is not a positive finite number, or Poisson's ratio not in (−1, 0.5].
    #[error("the beam's {quantity} is out of range")]
    BadBeam {
        /// Which quantity.
        quantity: &'static str,
    },
    /// The resulting matrix is unusable.
    #[error(transparent)]
    Matrix(#[from] SensorMatrixError),
}

impl<T: Real> ThinWalledBeam<T> {
    /// The corrected constants of equation (17): `W_h = 1/(2πERs)`, `W_f = 2W_h/R`,
    /// `W_s = 2(1+μ)W_h`, `W_t = (1+μ)W_h/R`.
    ///
    /// # Errors
    /// [`LayoutError::BadBeam`].
    pub fn section_constants(&self) -> Result<SectionConstants<T>, LayoutError> {
        let positive = |value: T, quantity| {
            if value > T::zero() && value.is_number() {
                Ok(value)
            } else {
                Err(LayoutError::BadBeam { quantity })
            }
        };
        let radius = positive(self.radius, "radius")?;
        let thickness = positive(self.thickness, "wall thickness")?;
        let modulus = positive(self.youngs_modulus, "Young's modulus")?;
        let mu = self.poisson_ratio;
        if !(mu > -T::one() && mu <= T::literal(0.5)) {
            return Err(LayoutError::BadBeam { quantity: "Poisson's ratio" });
        }
        let axial = T::one() / (T::two_pi() * modulus * radius * thickness);
        if !axial.is_number() {
            return Err(LayoutError::BadBeam { quantity: "stiffness" });
        }
        let two = T::literal(2.0);
        Ok(SectionConstants {
            axial,
            bending: two * axial / radius,
            shear: two * (T::one() + mu) * axial,
            torsion: (T::one() + mu) * axial / radius,
        })
    }

    /// The constants with which the paper's table of condition numbers was most likely computed:
    /// shear and torsion without the factor `(1+μ)`, and mean instead of peak shear, `W_s = W_h`,
    /// `W_t = W_h/R`.
    ///
    /// With equal nominal forces, nominal torques of 10 mm times that force and μ = 0.33 they give
    /// the printed 4.9, 3.7, 3.6, 4.2 to within 1.6 %, where equation (17) as printed cannot come
    /// closer than 20 %. That is an inference from the numbers, not something the paper says; for a
    /// sensor, use [`section_constants`](Self::section_constants).
    ///
    /// # Errors
    /// [`LayoutError::BadBeam`].
    pub fn section_constants_of_the_printed_table(&self) -> Result<SectionConstants<T>, LayoutError> {
        let constants = self.section_constants()?;
        Ok(SectionConstants { shear: constants.axial, torsion: constants.axial / self.radius, ..constants })
    }
}

/// `N` gauges on a beam.
///
/// ```
/// use fingertip_wrench::Conditioning;
/// use fingertip_wrench::gauge_layout::{GaugeLayout, ThinWalledBeam, isotropic_angle};
/// use nalgebra::Vector6;
///
/// let beam = ThinWalledBeam { radius: 5e-3, thickness: 2e-4, youngs_modulus: 70e9, poisson_ratio: 0.33 };
/// let layout = GaugeLayout::new(&beam, GaugeLayout::three_rosettes(isotropic_angle(0.33)))?;
/// // 10 kV per unit of strain; torques are rated at the forces times the radius.
/// let sensor = layout.sensor_matrix(1e4, Vector6::new(10.0, 10.0, 10.0, 0.05, 0.05, 0.05))?;
/// // No gauges on a tube do better than √2.
/// let condition_number = Conditioning::of(&sensor).condition_number();
/// assert!((condition_number - 2.0_f64.sqrt()).abs() < 1e-12);
/// # Ok::<(), fingertip_wrench::gauge_layout::LayoutError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: serde::Deserialize<'de> + Copy"))
)]
pub struct GaugeLayout<T, const N: usize> {
    /// Where the gauges are.
    #[cfg_attr(feature = "serde", serde(with = "crate::array_in_file"))]
    pub gauges: [Gauge<T>; N],
    /// Strain per unit load of the section.
    pub section: SectionConstants<T>,
    /// Poisson's ratio μ of the beam.
    pub poisson_ratio: T,
}

impl<T: Real, const N: usize> GaugeLayout<T, N> {
    /// Gauges on a beam whose constants follow from its dimensions.
    ///
    /// # Errors
    /// [`LayoutError::BadBeam`].
    pub fn new(beam: &ThinWalledBeam<T>, gauges: [Gauge<T>; N]) -> Result<Self, LayoutError> {
        Ok(Self { gauges, section: beam.section_constants()?, poisson_ratio: beam.poisson_ratio })
    }

    /// Strain of each gauge per newton and newton metre \[1/N, 1/(N·m)\]: the corrected (16).
    #[must_use]
    pub fn strain_matrix(&self) -> SMatrix<T, N, 6> {
        let mut strains = SMatrix::<T, N, 6>::zeros();
        for (mut row, gauge) in strains.row_iter_mut().zip(&self.gauges) {
            for (entry, value) in row.iter_mut().zip(self.strain_row(gauge).iter()) {
                *entry = *value;
            }
        }
        strains
    }

    fn strain_row(&self, gauge: &Gauge<T>) -> Vector6<T> {
        let section = &self.section;
        let (sin_q, cos_q) = gauge.q.sine_and_cosine();
        let (sin_theta, cos_theta) = gauge.theta.sine_and_cosine();
        let along = cos_q * cos_q - self.poisson_ratio * sin_q * sin_q;
        let across = T::literal(2.0) * sin_q * cos_q;
        let lever = gauge.z * along * section.bending;
        Vector6::new(
            along * section.axial,
            -lever * cos_theta - across * sin_theta * section.shear,
            -lever * sin_theta + across * cos_theta * section.shear,
            across * section.torsion,
            along * sin_theta * section.bending,
            -along * cos_theta * section.bending,
        )
    }

    /// The sensor matrix for a bridge that gives `gain` volts (or counts) per unit strain and
    /// gauge, and the nominal loads \[N, N, N, N·m, N·m, N·m\].
    ///
    /// # Errors
    /// [`LayoutError::Matrix`] if the layout cannot see an axis or an input is not finite.
    pub fn sensor_matrix(&self, gain: T, nominal: Vector6<T>) -> Result<SensorMatrix<T, N>, LayoutError> {
        Ok(SensorMatrix::from_sensitivities(self.strain_matrix() * gain, nominal)?)
    }
}

impl<T: Real> GaugeLayout<T, 6> {
    /// The paper's six gauges (its Figure 3): four around the ring at the origin, alternately
    /// turned by `∓q`, and two a distance `d` behind, at 180° and 90° \[rad, m\].
    #[must_use]
    pub fn bicchi_dario_gauges(q: T, d: T) -> [Gauge<T>; 6] {
        let quarter = T::frac_pi_2();
        let gauge = |z, quarters: f64, q| Gauge { z, theta: quarter * T::literal(quarters), q };
        let zero = T::zero();
        [
            gauge(zero, 2.0, -q),
            gauge(zero, 1.0, q),
            gauge(zero, 0.0, -q),
            gauge(zero, 3.0, q),
            gauge(d, 2.0, -q),
            gauge(d, 1.0, q),
        ]
    }

    /// Three crossed pairs `±q` \[rad\] at 0°, 120° and 240° in the ring at the origin, in the order
    /// +, −, +, −, +, −.
    ///
    /// With `(1+μ) sin 2q = cos² q − μ sin² q` ([`isotropic_angle`]) and all nominal forces `f`, all
    /// nominal torques `f·R`, the condition number is √2, the least that any gauges on a tube can
    /// have (`docs/theory/calibration.md#lower-bound-of-the-condition-number`); with the axial load and the
    /// torque about the axis rated √2 times higher it is exactly 1.
    #[must_use]
    pub fn three_rosettes(q: T) -> [Gauge<T>; 6] {
        rosettes(q)
    }
}

impl<T: Real> GaugeLayout<T, 8> {
    /// Four crossed pairs `±q` \[rad\] at 0°, 90°, 180° and 270° in the ring at the origin, in the
    /// order +, −, +, −, …: as [`three_rosettes`](GaugeLayout::three_rosettes), with two gauges to
    /// spare.
    #[must_use]
    pub fn four_rosettes(q: T) -> [Gauge<T>; 8] {
        rosettes(q)
    }
}

/// `N/2` crossed pairs, evenly around the ring at the origin.
fn rosettes<T: Real, const N: usize>(q: T) -> [Gauge<T>; N] {
    let step = T::two_pi() / T::literal((N / 2) as f64);
    core::array::from_fn(|i| Gauge {
        z: T::zero(),
        theta: step * T::literal((i / 2) as f64),
        q: if i % 2 == 0 { q } else { -q },
    })
}

/// The angle `q` \[rad\] at which crossed gauges see shear as strongly as axial strain:
/// `(1+μ) sin 2q = cos² q − μ sin² q`, that is `tan q = (√((1+μ)² + μ) − (1+μ))/μ`, 19.79° for
/// μ = 0.33 (`docs/theory/wrench.md#rosettes`). For Poisson's ratio in (−0.3, 0.5]; otherwise NaN may come
/// out.
#[must_use]
pub fn isotropic_angle<T: Real>(poisson_ratio: T) -> T {
    // μ t² + 2(1+μ) t − 1 = 0, in the form that does not cancel for small μ.
    let half = T::one() + poisson_ratio;
    (T::one() / (half + (half * half + poisson_ratio).root())).arctangent()
}
