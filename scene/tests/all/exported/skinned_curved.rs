// skinned "tip": a fingertip as a type, in f64.
//
// Written by `fingertip export` (fingertip-scene 0.1.0). Change the scene and export it again rather than this.
//
//   input        convention = "reaction", rest_s = 1.0, sample_rate_Hz = 500.0
//   surface      compound, the union of several shapes; parts = [{ active_half_angle_deg = 140.0, pole =
//                [0.1, 0.7, 0.3], ra …
//   pose         rotation_deg = [10.0, 20.0, 30.0], translation_m = [0.001, 0.0, 0.002]
//   contact      soft_finger, a contact transmits a force and a torque about the normal, as a soft tip does;
//                skin_share = 0.5
//   contact.skin linear, depth in proportion to the force; radius_m = 0.013, stiffness_N_per_m = 8000
//   uncertainty  force_noise_N = 0.01, torque_noise_Nm = 0.0001
//   friction     soft_finger, tangential force and spin torque together; conservative = true,
//                static_coefficient = 0.5, torque_arm_m = 0.003
//   slip         drop, the friction ratio falls suddenly; false_alarms_per_minute = 2.0, noise_N = 0.01
//   grip         fall_N_per_s = 2.0, greatest_N = 20.0, least_N = 0.2, rise_N_per_s = 100.0
//
// It needs neither heap nor standard library, and in Cargo.toml:
//
//   fingertip = { version = "0.1.0", default-features = false, features = ["libm", "mixed-precision", "friction", "skin"] }
//
// With a standard library, "std" in the place of "libm".
//
// Once, and then for each sample, `time_step` seconds after the one before:
//
//     let (mut tip, mut last) = (tip()?, None);
//
//     let step = fingertip::Step::of(time_step).with_last(last);
//     let touch = tip.sense(&reading, step); // reading: fingertip::nalgebra::SVector<f64, 6>
//     last = touch.point();
//
// The sensor is unloaded for 1.0 s at the start: a `wrench::TareAccumulator` makes a zero of it, which `tip.set_zero` puts in place.
//
// After a pause, `last = None` and `friction::SlipDetector::<f64>::reset(&mut tip.detector_mut().0)`.
//
// With `let (noise, calibration) = (wrench_noise()?, calibration_uncertainty()?)`, the covariance of the contact is
//     covariance(&tip, &touch, before, &noise, &calibration)
// whose `ellipse(0.95)` is that of the scene; `before` is the last contact before this sample.
//
// With `let mut grip = grip()?`, the normal force to command next [N] is
//     match &touch.force {
//         Some(force) => grip.command(&tip.friction().0, force, touch.slip, time_step),
//         None => grip.present(),
//     }

use fingertip::nalgebra::{Matrix3, Matrix6, SVector, Vector3, Vector6};
use fingertip::{Fingertip, Present};
use fingertip::{contact, friction, surfaces, wrench};

/// The pipeline.
pub type Tip = Fingertip<
    wrench::WithinRegion<calibration::Curved, f64, 6>,
    surfaces::Posed<
        f64,
        surfaces::Compound<
            surfaces::Compound<surfaces::SphericalCap<f64>, surfaces::Posed<f64, surfaces::Cone<f64>>>,
            surfaces::Compound<surfaces::EllipticCylinder<f64>, surfaces::EllipticCylinder<f64>>,
        >,
    >,
    contact::Compliant<f64, contact::SoftFinger<f64>, contact::LinearStiffness<f64>>,
    Present<friction::SoftFingerLimit<f64>>,
    Present<friction::DropDetector<f64>>,
    wrench::Tare<f64, 6>,
>;

/// Makes the pipeline.
///
/// # Errors
/// Never for the numbers below.
#[allow(clippy::approx_constant)]
pub fn tip() -> Result<Tip, BadTip> {
    let surface = surfaces::Posed::new(
        surfaces::Compound::new(
            surfaces::Compound::new(
                surfaces::SphericalCap::new(
                    surfaces::Sphere::new(Vector3::zeros(), 0.01)?,
                    Vector3::new(0.1, 0.7, 0.3),
                    -0.7660444431189779,
                )?,
                surfaces::Posed::new(
                    surfaces::Cone::new(
                        Vector3::zeros(),
                        Vector3::z(),
                        0.5410520681182421,
                    )?.with_depth(0.02)?,
                    wrench::RigidTransform::from_matrix(
                        Matrix3::new(
                            0.838670567945424,
                            0.0,
                            0.544639035015027,
                            0.0,
                            1.0,
                            0.0,
                            -0.544639035015027,
                            0.0,
                            0.838670567945424,
                        ),
                        Vector3::new(0.0, 0.0, 0.0),
                    )?,
                ),
            ),
            surfaces::Compound::new(
                surfaces::EllipticCylinder::new([0.008, 0.01], surfaces::CylinderEnds::Unbounded)?,
                surfaces::EllipticCylinder::new([0.009, 0.007], surfaces::CylinderEnds::Open(0.012))?,
            ),
        ),
        wrench::RigidTransform::from_matrix(
            Matrix3::new(
                0.8089361145249915,
                -0.4577738486383615,
                0.3688705275839105,
                0.5165627364768257,
                0.8530277804038395,
                -0.07420609909483492,
                -0.28068719582621426,
                0.25057276261022743,
                0.9265138902019198,
            ),
            Vector3::new(0.001, 0.0, 0.002),
        )?,
    );
    let model = contact::Compliant::new(
        contact::SoftFinger::new(0.0)?,
        contact::LinearStiffness::new(8000.0, 0.013)?,
    ).with_share(0.5)?;
    Ok(Fingertip::builder()
        .zero(wrench::Tare::new(SVector::from(calibration::ZERO)))
        .solver(wrench::WithinRegion::new(calibration::curved_sensor(-1.0)?, calibration::region()?))
        .contact(surface, model)
        .friction(friction::SoftFingerLimit::conservative(0.5, 0.003)?)
        .slip_detector(
            friction::DropDetector::with_sum(
                friction::ForceNoise::isotropic(0.01)?,
                friction::Cusum::new(0.75, 5.339682943800724)?,
            )?,
        )
        .build())
}

/// How sure a wrench is: standard deviations at rest, and relative ones under load.
///
/// # Errors
/// Never for the numbers below.
pub fn wrench_noise() -> Result<contact::WrenchNoise<f64>, BadTip> {
    let noise = contact::WrenchNoise::new(Vector6::from([0.01, 0.01, 0.01, 0.0001, 0.0001, 0.0001]), 0.0)?;
    Ok(noise)
}

/// What the fit of the calibration leaves uncertain of a wrench.
///
/// # Errors
/// Never for the numbers below.
pub fn calibration_uncertainty() -> Result<contact::CalibrationUncertainty<f64>, BadTip> {
    Ok(contact::CalibrationUncertainty::new(
        Matrix6::from(
            [
                [
                    0.00442520668598828,
                    0.00018644852619003528,
                    0.0002396046156163629,
                    8.711456522318103e-7,
                    6.85909077816679e-7,
                    2.878295341521262e-7,
                ],
                [
                    0.00018644852619003528,
                    0.004412475449665489,
                    0.0006322537952959396,
                    1.8926024446966578e-6,
                    1.3122886943920066e-6,
                    4.984726985765321e-7,
                ],
                [
                    0.0002396046156163629,
                    0.0006322537952959396,
                    0.017669453914093063,
                    7.131773236422787e-6,
                    4.375053901152789e-6,
                    1.5416721534354491e-6,
                ],
                [
                    8.711456522318103e-7,
                    1.8926024446966578e-6,
                    7.131773236422787e-6,
                    4.4223579913754865e-7,
                    3.780274432661247e-8,
                    1.1827341792530599e-8,
                ],
                [
                    6.85909077816679e-7,
                    1.3122886943920066e-6,
                    4.375053901152789e-6,
                    3.780274432661247e-8,
                    4.426904064635549e-7,
                    1.9618630062661902e-8,
                ],
                [
                    2.878295341521262e-7,
                    4.984726985765321e-7,
                    1.5416721534354491e-6,
                    1.1827341792530599e-8,
                    1.9618630062661902e-8,
                    1.1079008196639808e-7,
                ],
            ],
        ),
        Matrix6::from(
            [
                [0.0003, 3e-5, 1e-5, 0.0015, 0.0012, 0.002],
                [3e-5, 0.0003, 1.5e-5, 0.002, 0.0015, 0.0024],
                [1e-5, 1.5e-5, 7.5e-5, 0.0015, 0.001, 0.0015],
                [0.0015, 0.002, 0.0015, 2.999999999999999, 0.29999999999999993, 0.3999999999999999],
                [0.0012, 0.0015, 0.001, 0.29999999999999993, 2.999999999999999, 0.5999999999999999],
                [0.002, 0.0024, 0.0015, 0.3999999999999999, 0.5999999999999999, 11.999999999999996],
            ],
        ),
    )?)
}

/// How sure the contact of a sample is; `None` without one, and where that cannot be said, as at grazing.
pub fn covariance<Reading, Verdict>(
    tip: &Tip,
    touch: &fingertip::Touch<f64, Reading, Verdict>,
    last: Option<&Vector3<f64>>,
    noise: &contact::WrenchNoise<f64>,
    calibration: &contact::CalibrationUncertainty<f64>,
) -> Option<contact::ContactCovariance<f64>> {
    let surface = tip.surface();
    let indented = tip.model().resolve_indented(&touch.wrench, surface, last).ok()?;
    let jacobian = tip.model().jacobian(&indented, surface)?;
    let covariance = contact::ContactCovariance::new(
        &jacobian,
        &(noise.covariance(&touch.wrench) + calibration.covariance(&touch.wrench)),
    );
    Some(covariance)
}

/// What commands the grip.
///
/// # Errors
/// Never for the numbers below.
pub fn grip() -> Result<friction::GripController<f64>, BadTip> {
    Ok(friction::GripController::new(friction::GripSettings {
        safety: 1.5,
        least: 0.2,
        greatest: 20.0,
        rise: 100.0,
        fall: 2.0,
        slip_boost: 1.25,
    })?)
}

/// Why the numbers of this module make nothing: never, unless they are edited into nonsense.
#[derive(Clone, Debug, PartialEq)]
pub enum BadTip {
    /// A shape, a contact model or an uncertainty.
    Shape(surfaces::BadShape),
    /// A friction, a detector or a grip.
    Friction(friction::BadParameter),
    /// A pose.
    Pose(wrench::TransformError),
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
            Self::Pose(bad) => bad.fmt(f),
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

impl From<wrench::TransformError> for BadTip {
    fn from(bad: wrench::TransformError) -> Self {
        Self::Pose(bad)
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
    // Calibration fnv1a64:73dc0cf50d35d66a, written by fingertip-calibration 0.1.0.
    // Quality: unchecked

    // A program that has `fingertip-wrench` and `nalgebra` instead of `fingertip` leaves this line out.
    use fingertip::{nalgebra, wrench as fingertip_wrench};

    /// Number of gauges.
    pub const GAUGES: usize = 6;

    /// Reading of each gauge without load.
    pub const ZERO: [f64; GAUGES] = [-0.02, -0.01, 0.0, 0.009999999999999998, 0.02, 0.030000000000000002];

    /// Load of one unit of each signal [N, N·m].
    pub const LINEAR: [[f64; GAUGES]; 6] = [
        [6.675524516288106, -0.14574028340802517, -0.08626813516916698, -0.06122042850164487, -0.04742947560596004, -0.03870333188744175],
        [-0.21907298627586821, 6.673746726277572, -0.07024976746163324, -0.052559150204348856, -0.0419846947251793, -0.034951520104588706],
        [-0.2875145239180934, -0.16917348214084207, 13.340830215817324, -0.09384690713490182, -0.07676532680224642, -0.06494407971832972],
        [-0.001068197846632112, -0.0007043248587600281, -0.0005290493037263356, 0.06669045191818276, -0.00035324567704374363, -0.00030290368419824134],
        [-0.0008489547492822035, -0.0006032840023473448, -0.00047082081942196224, -0.0003859654812157903, 0.06668332540294879, -0.00028362118043116275],
        [-0.0003519539862280542, -0.00026376369139155135, -0.00021203683909307966, -0.00017717707526929767, -0.00015212482913559626, 0.03333953892075214],
    ];

    /// The gauges of each product of signals, 255 where there is no third, and the load of one unit of it.
    pub const PRODUCTS: [([u8; 3], [f64; 6]); 24] = [
        ([0, 0, 255], [0.0, 0.014112000805986721, -0.055883099639785175, 0.00041211848524175666, -0.000536572918000435, 0.00032514392007855844]),
        ([0, 1, 255], [0.06569865987187891, -0.054402111088936986, 0.08403340736532817, -0.0002879033166650653, 0.00014987720966295234, -4.425654645201938e-6]),
        ([0, 2, 255], [0.09906073556948704, -0.09613974918795568, 0.1825890501455255, -0.0008462204041751707, 0.0007625584504796028, -0.0003318169421064838]),
        ([0, 3, 255], [0.0836655638536056, -0.09055783620066239, 0.1912751856809006, -0.000988031624092862, 0.0009999118601072673, -0.0004958894267215579]),
        ([0, 4, 255], [0.027090578830786905, -0.0404037645323065, 0.10581653722400478, -0.0006435381333569995, 0.0007451131604793489, -0.00041588737131429917]),
        ([0, 5, 255], [-0.0428182669496151, 0.029636857870938532, -0.031724533760941795, 1.7701925105413578e-5, 0.000123573122745224, -0.0001311874268519644]),
        ([1, 1, 255], [-0.09165215479156338, 0.08509035245341184, -0.15365093226473336, 0.0006702291758433747, -0.0005587890488516163, 0.00021808237762391248]),
        ([1, 2, 255], [-0.0953752652759472, 0.09866275920404854, -0.19995103467172398, 0.000992872648084537, -0.000966117770008393, 0.0004600130190983954]),
        ([1, 3, 255], [-0.052155100208691185, 0.06367380071391379, -0.14783613932984457, 0.0008268286794901034, -0.0008979276806892914, 0.0004755273266271874]),
        ([1, 4, 255], [0.016735570030280693, -0.0026551154023966798, -0.022956962756637448, 0.0002538233627620363, -0.0003877816354094305, 0.00025698922799376764]),
        ([1, 5, 255], [0.07738906815578891, -0.06767719568873076, 0.11322152737963607, -0.0004441126687075084, 0.00031322878243308515, -8.803780997429355e-5]),
        ([2, 2, 255], [0.09995201585807313, -0.09938886539233752, 0.19367289222003706, -0.0009234584470040598, 0.0008600694058124534, -0.0003897330348079024]),
        ([2, 3, 255], [0.07331903200732923, -0.08218178366308225, 0.17879933272011156, -0.0009482821412699473, 0.000983587745434345, -0.0004996034170931769]),
        ([2, 4, 255], [0.010598751175115684, -0.024525198546765433, 0.07592154780550435, -0.0005063656411097589, 0.0006229886314423489, -0.00036357125004042633]),
        ([2, 5, 255], [-0.05733818719904229, 0.045202578717835055, -0.06432448063250619, 0.00018478174456066748, -4.424267808507097e-5, -4.8590952946604514e-5]),
        ([3, 3, 255], [-0.09705352835374847, 0.0926818505417785, -0.17291028972212164, 0.0007849803886813105, -0.000689697940935389, 0.00029030559210615716]),
        ([3, 4, 255], [-0.08899956043668333, 0.09454353340247704, -0.1963904338088167, 0.0009988152247235797, -0.0009956869868891795, 0.00048631503362120404]),
        ([3, 5, 255], [-0.03714041014380902, 0.04987131538963941, -0.12320809183773129, 0.0007210377105017317, -0.0008116033871367005, 0.0004429624082299742]),
        ([4, 4, 255], [0.0329990825673782, -0.019347339203846847, 0.010616717429211648, 8.836868610400143e-5, -0.0002280522595008612, 0.0001815856826866295]),
        ([4, 5, 255], [0.08689657562142357, -0.07904332067228888, 0.1392160262449483, -0.0005877950071674065, 0.0004677451620451335, -0.00016916669716213827]),
        ([5, 5, 255], [0.09802396594403115, -0.09983453608739179, 0.19929383462435474, -0.0009746486480944948, 0.0009333205237488621, -0.00043665599138732384]),
        ([0, 0, 1], [0.0, 0.13139731974375782, 0.39624294227794815, 0.001673311277072112, 0.0005418115766157381, -0.00042818266949615105]),
        ([2, 3, 255], [0.028224001611973443, -0.10880422217787397, -0.3845589967518227, -0.001811156724013248, -0.0008080752906461301, 0.00029636857870938535]),
        ([5, 5, 5], [-0.055883099639785175, 0.08403340736532817, 0.365178100291051, 0.0019127518568090062, 0.0010581653722400478, -0.000158622668804709]),
    ];

    /// Widths of the bumps [signal].
    pub const WIDTHS: [f64; GAUGES] = [4.0, 4.0, 4.0, 4.0, 4.0, 4.0];

    /// The signals at which each bump is highest, and the load of one unit of it.
    pub const BUMPS: [([f64; GAUGES], [f64; 6]); 2] = [
        ([0.5, 0.5, 0.5, 0.5, 0.5, 0.5], [0.08242369704835133, -0.05758066333301306, -0.3384881616700683, -0.001976063248185724, -0.001287076266713999, 1.7701925105413578e-5]),
        ([-1.0, -1.0, -1.0, -1.0, -1.0, -1.0], [-0.107314583600087, 0.02997544193259047, 0.3050233801918411, 0.0019998237202145347, 0.0014902263209586979, 0.000123573122745224]),
    ];

    /// A solver of as many terms.
    pub type Curved = fingertip_wrench::CurvedInverse<
        f64,
        GAUGES,
        [fingertip_wrench::ProductTerm<f64>; PRODUCTS.len()],
        [fingertip_wrench::RadialTerm<f64, GAUGES>; BUMPS.len()],
    >;

    /// The curved sensor of these constants: of the load itself with `sign` 1, of the opposite one with -1.
    ///
    /// # Errors
    /// Never for the numbers above; only if they were edited into nonsense.
    pub fn curved_sensor(sign: f64) -> Result<Curved, fingertip_wrench::BadCurve> {
        let load = |load| nalgebra::Vector6::<f64>::from(load) * sign;
        let linear = nalgebra::SMatrix::<f64, 6, GAUGES>::from_fn(|axis, gauge| LINEAR[axis][gauge] * sign);
        let products = PRODUCTS.map(|([a, b, c], of)| fingertip_wrench::ProductTerm::of_three(a, b, c, load(of)));
        let bumps = BUMPS.map(|(centre, of)| fingertip_wrench::RadialTerm {
            centre: nalgebra::SVector::from(centre),
            load: load(of),
        });
        fingertip_wrench::CurvedInverse::new(linear, products)?
            .with_radial(nalgebra::SVector::from(WIDTHS), bumps)
    }

    /// The mean of the signals that the sensor was calibrated with.
    pub const CENTRE: [f64; GAUGES] = [-0.10249410742138475, -0.09111661445643245, -0.021320481121251494, -0.14644310705162922, 0.023089184055485146, 0.08697074778061296];

    /// What makes distances of signals from there [1/signal].
    pub const WHITENING: [[f64; GAUGES]; GAUGES] = [
        [-0.04382937007477737, -0.06344019034186868, -0.04158575132123702, -0.09923400135737007, -0.0019755370804729467, 0.061157911376790906],
        [0.03906322759965861, -0.08681154110723453, -0.06553536795923512, 0.13182028379534916, 0.02922757833233282, 0.06865966936467902],
        [0.07737361468931025, 0.05149053636708992, -0.07391509052489613, -0.045117576450799744, 0.08900093637217228, -0.006639687164574121],
        [-0.10204262703215562, 0.05620352332099085, 0.027476393545243286, 0.03300825960501723, 0.10255195420589136, 0.060136154653087956],
        [0.08707386249173023, -0.02114640321118799, 0.10675353248886815, -0.02972849696884317, 0.03208144311876603, 0.06921537817370817],
        [0.018578510738329713, 0.08621938980020838, -0.02907429787201639, 0.00886547888581188, -0.09123429808962298, 0.09170254653199218],
    ];

    /// Where the sensor was calibrated: beyond, it means little.
    ///
    /// # Errors
    /// Never for the numbers above; only if they were edited into nonsense.
    pub fn region() -> Result<fingertip_wrench::CalibratedRegion<f64, GAUGES>, fingertip_wrench::BadRegion> {
        fingertip_wrench::CalibratedRegion::new(
            nalgebra::SVector::from(CENTRE),
            nalgebra::SMatrix::<f64, GAUGES, GAUGES>::from_fn(|row, gauge| WHITENING[row][gauge]),
        )
    }
}
