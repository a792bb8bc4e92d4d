// Flat pad: a fingertip as a type, in f32.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "on_fingertip", sample_rate_Hz = 1000.0
//   surface      plane, a plane; normal = [0.0, 0.0, 1.0], point_m = [0.0, 0.0, 0.005]
//   contact      least_force_N = 0.2
//   friction     coulomb, one coefficient in all directions; static_coefficient = 0.5
//   slip         threshold, the friction ratio passes the coefficient of [friction]; noise_N = 0.01,
//                warning_share = 0.8
//
// It needs neither heap nor standard library, and in Cargo.toml:
//
//   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction"] }
//
// With a standard library, "std" in the place of "libm".
//
// Once, and then for each sample, `time_step` seconds after the one before:
//
//     let (mut tip, mut last) = (tip()?, None);
//
//     let step = fingertip::Step::of(time_step).with_last(last);
//     let touch = tip.sense(&reading, step); // reading: fingertip::nalgebra::SVector<f32, 8>
//     last = touch.point();
//
// After a pause, `last = None` and `friction::SlipDetector::<f32>::reset(&mut tip.detector_mut().0)`.

use fingertip::nalgebra::{SVector, Vector3};
use fingertip::{Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    wrench::WithinRegion<calibration::Curved, f32, 8>,
    surfaces::Plane<f32>,
    contact::PointContact<f32>,
    Present<friction::Coulomb<f32>>,
    Present<friction::RatioThreshold<f32>>,
    wrench::Tare<f32, 8>,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Plane::new(Vector3::new(0.0, 0.0, 0.005), Vector3::z())?;
    let model = contact::PointContact::new(0.2)?;
    Ok(Fingertip::builder()
        .zero(wrench::Tare::new(SVector::from(calibration::ZERO)))
        .solver(wrench::WithinRegion::new(calibration::curved_sensor(1.0)?, calibration::region()?))
        .contact(surface, model)
        .friction(friction::Coulomb::new(0.5)?)
        .slip_detector(
            friction::RatioThreshold::new(
                friction::NormalForceGate::from_noise(&friction::ForceNoise::isotropic(0.01)?),
                0.5,
            )?.with_warning_share(0.8)?,
        )
        .build())
}

/// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
#[derive(Clone, Debug, PartialEq)]
pub enum BadTip {
    /// A shape, a contact model or an uncertainty.
    Shape(surfaces::BadShape),
    /// A friction, a detector or a grip.
    Friction(friction::BadParameter),
    /// The terms of a curved sensor.
    Curve(wrench::BadCurve),
    /// Where the sensor was calibrated.
    Region(wrench::BadRegion),
}

impl core::fmt::Display for BadTip {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Shape(bad) => bad.fmt(f),
            Self::Friction(bad) => bad.fmt(f),
            Self::Curve(bad) => bad.fmt(f),
            Self::Region(bad) => bad.fmt(f),
        }
    }
}

impl core::error::Error for BadTip {}

impl From<surfaces::BadShape> for BadTip {
    fn from(bad: surfaces::BadShape) -> Self {
        Self::Shape(bad)
    }
}

impl From<friction::BadParameter> for BadTip {
    fn from(bad: friction::BadParameter) -> Self {
        Self::Friction(bad)
    }
}

impl From<wrench::BadCurve> for BadTip {
    fn from(bad: wrench::BadCurve) -> Self {
        Self::Curve(bad)
    }
}

impl From<wrench::BadRegion> for BadTip {
    fn from(bad: wrench::BadRegion) -> Self {
        Self::Region(bad)
    }
}

/// The calibration of the sensor.
pub mod calibration {
    // Calibration fnv1a64:fb8c2deb865b9fef, written by fingertip-calibration 0.1.0.
    // Quality: unchecked

    // A program that has `fingertip-wrench` and `nalgebra` instead of `fingertip` leaves this line out.
    use fingertip::{nalgebra, wrench as fingertip_wrench};

    /// Number of gauges.
    pub const GAUGES: usize = 8;

    /// Reading of each gauge without load.
    pub const ZERO: [f32; GAUGES] = [-0.02, -0.01, 0.0, 0.01, 0.02, 0.03, 0.04, 0.05];

    /// Load of one unit of each signal [N, N·m].
    pub const LINEAR: [[f32; GAUGES]; 6] = [
        [3.333608, -0.0073621743, -0.063200206, -0.04749566, -0.03830307, -0.03219776, 3.3371139, -0.089433864],
        [-0.044040453, 3.3330727, -0.05362276, -0.04200197, -0.034689393, -0.02961878, -0.09218715, 3.3370144],
        [-0.09885326, -0.05292308, 13.338864, -0.09504138, -0.07756984, -0.06552249, -0.1914641, -0.11897265],
        [-0.00040387182, -0.00025455735, -0.0005361885, 0.06668611, -0.00035617285, -0.00030500922, -0.000675197, -0.00045933996],
        [-0.00034009843, -0.00023608531, -0.00047641064, -0.00038936868, 0.06668103, -0.00028527257, -0.0005177453, -0.0003745235],
        [-0.0001467054, -0.000108603905, -0.00021432922, -0.00017857361, -0.00015306698, 0.03333886, -0.00020900868, -0.00015811196],
    ];

    /// The gauges of each product of signals, 255 where there is no third, and the load of one unit of it.
    pub const PRODUCTS: [([u8; 3], [f32; 6]); 3] = [
        ([0, 0, 1], [0.0, 0.13139732, 0.39624295, 0.0016733112, 0.0005418116, -0.00042818266]),
        ([2, 3, 255], [0.028224, -0.10880422, -0.384559, -0.0018111567, -0.0008080753, 0.00029636858]),
        ([5, 5, 5], [-0.0558831, 0.08403341, 0.3651781, 0.0019127518, 0.0010581653, -0.00015862267]),
    ];

    /// Widths of the bumps [signal].
    pub const WIDTHS: [f32; GAUGES] = [4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0];

    /// The signals at which each bump is highest, and the load of one unit of it.
    pub const BUMPS: [([f32; GAUGES], [f32; 6]); 2] = [
        ([0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5], [0.082423694, -0.057580665, -0.33848816, -0.0019760632, -0.0012870763, 1.7701925e-5]),
        ([-1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0], [-0.10731459, 0.029975442, 0.30502337, 0.0019998236, 0.0014902264, 0.00012357312]),
    ];

    /// A solver of as many terms.
    pub type Curved = fingertip_wrench::CurvedInverse<
        f32,
        GAUGES,
        [fingertip_wrench::ProductTerm<f32>; PRODUCTS.len()],
        [fingertip_wrench::RadialTerm<f32, GAUGES>; BUMPS.len()],
    >;

    /// The curved sensor of these constants: of the load itself with `sign` 1, of the opposite one with -1.
    ///
    /// # Errors
    /// Never for the numbers above; only if they were edited into nonsense.
    pub fn curved_sensor(sign: f32) -> Result<Curved, fingertip_wrench::BadCurve> {
        let load = |load| nalgebra::Vector6::<f32>::from(load) * sign;
        let linear = nalgebra::SMatrix::<f32, 6, GAUGES>::from_fn(|axis, gauge| LINEAR[axis][gauge] * sign);
        let products = PRODUCTS.map(|([a, b, c], of)| fingertip_wrench::ProductTerm::of_three(a, b, c, load(of)));
        let bumps = BUMPS.map(|(centre, of)| fingertip_wrench::RadialTerm {
            centre: nalgebra::SVector::from(centre),
            load: load(of),
        });
        fingertip_wrench::CurvedInverse::new(linear, products)?
            .with_radial(nalgebra::SVector::from(WIDTHS), bumps)
    }

    /// The mean of the signals that the sensor was calibrated with.
    pub const CENTRE: [f32; GAUGES] = [-0.102494106, -0.091116615, -0.02132048, -0.14644311, 0.023089183, 0.08697075, -0.15812531, -0.04198203];

    /// What makes distances of signals from there [1/signal].
    pub const WHITENING: [[f32; GAUGES]; GAUGES] = [
        [-0.009401957, -0.033660103, -0.05528441, -0.08688413, 0.022057898, 0.047129363, -0.04151477, 0.0005275711],
        [0.045290194, 0.054636095, -0.042255424, 0.020710591, 0.042948104, -0.03847349, -0.049307205, 0.053002626],
        [0.04629123, -0.073657386, -0.057538114, 0.1058397, 0.030829603, 0.066613965, 0.030024977, 0.018304247],
        [-0.08379383, -0.023774141, -0.039375786, 0.0031613074, -0.02806891, -0.037212685, 0.02726842, 0.081318446],
        [-0.046405185, 0.012892867, -0.08309023, 0.035697453, 0.0042610494, -0.04942581, -0.0047315857, -0.10647836],
        [-0.0757504, 0.05842737, 0.018275661, 0.015563799, 0.098347664, 0.056799475, 0.022152867, 0.0027099056],
        [-0.054797463, -0.03466774, 0.04279092, 0.06188625, -0.015150901, 0.011884122, -0.10726646, -0.0003310677],
        [-0.004658689, 0.07197285, -0.03287445, 0.017406566, -0.09399839, 0.070302136, -0.0063291457, 0.0066958144],
    ];

    /// Where the sensor was calibrated: beyond, it means little.
    ///
    /// # Errors
    /// Never for the numbers above; only if they were edited into nonsense.
    pub fn region() -> Result<fingertip_wrench::CalibratedRegion<f32, GAUGES>, fingertip_wrench::BadRegion> {
        fingertip_wrench::CalibratedRegion::new(
            nalgebra::SVector::from(CENTRE),
            nalgebra::SMatrix::<f32, GAUGES, GAUGES>::from_fn(|row, gauge| WHITENING[row][gauge]),
        )
    }
}
