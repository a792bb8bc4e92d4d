//! Trials that were once wrong or lost among a million, each judged as there.

use fingertip_contact::SoftFingerSurface;
use fingertip_surfaces::{Capsule, Cone, Cylinder, Ellipsoid, Torus};
use fingertip_wrench::{Real, Wrench};
use nalgebra::Vector3;

use crate::exact::Exact;
use crate::try_out::{Asked, Count, Trial};

fn judged<T: Real, S: SoftFingerSurface<T> + Exact>(
    asked: Asked,
    surface: S,
    [force, torque]: [[T; 3]; 2],
    near: [f64; 3],
    size: f64,
) -> Count {
    let wrench = Wrench::on_fingertip(force.into(), torque.into());
    let trial = Trial { surface, wrench, near: near.into(), size };
    let mut count = Count::default();
    trial.judge(asked, &mut count);
    assert_eq!((count.wrong, count.lost, count.false_contacts), (0, 0, 0), "{count}");
    count
}

/// Single precision takes lines for tangents that enter at a cosine of a thousandth.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn grazing_forces_on_round_shapes() {
    let axes = Vector3::new(15.9128_f32, 4.121_548, 13.902_894);
    judged(
        Asked::Point,
        Ellipsoid::new(axes).unwrap(),
        [[-118_447.14, 748_926.2, -54_344.707], [6_641_898.5, 383_320.3, -9_193_817.0]],
        [-12.246_164_951_492_473, -0.188_632_285_757_598_7, -8.854_874_332_954_973],
        15.9,
    );
    let axes = Vector3::new(0.002_110_102_f32, 0.000_607_930_2, 0.001_159_656_9);
    judged(
        Asked::Soft,
        Ellipsoid::new(axes).unwrap(),
        [
            [0.001_283_377_5, 0.002_711_222_5, 0.001_197_345_1],
            [-1.041_748_8e-6, -1.944_250_2e-6, 5.519_087e-6],
        ],
        [0.001_979_605_835_325_079_7, -0.000_118_384_330_292_550_64, 0.000_331_956_399_413_587_55],
        0.002,
    );
    let origin = Vector3::new(332.923_52_f32, -250.312_56, -133.253_74);
    judged(
        Asked::Point,
        Capsule::new(origin, Vector3::z(), 497.648_68, 720.879_76).unwrap(),
        [
            [-0.000_180_582_05, 0.000_177_194_95, 0.000_121_985_37],
            [-0.226_504_28, -0.250_953_2, 0.029_225_068],
        ],
        [529.095_846_920_055_6, -357.333_657_421_902, 1_032.279_963_925_490_8],
        720.0,
    );
    let centre = Vector3::new(0.000_251_553_8_f32, 0.000_255_221, 0.000_126_410_96);
    let axis = Vector3::new(0.744_083_3, -0.099_905_33, -0.660_574_73);
    judged(
        Asked::Point,
        Cylinder::new(centre, axis, 0.000_132_124_48).unwrap(),
        [
            [-1.087_423e-9, 3.336_495_3e-9, -1.645_575e-9],
            [-1.419_600_8e-12, 1.582_627_5e-13, 1.258_982_1e-12],
        ],
        [0.000_269_875_119_562_531_2, 0.000_329_719_893_741_654_8, 0.000_262_857_236_814_434_5],
        0.000_132,
    );
    judged(
        Asked::Point,
        Torus::new(0.410_666_5_f32, 0.021_947_136).unwrap(),
        [[5.022_385e-6, 3.435_101_5e-7, -3.261_468_4e-5], [-6.291_037e-6, 1.263_751e-5, -8.356_633e-7]],
        [0.386_996_626_550_162_8, 0.192_856_705_874_691_14, 0.003_133_282_786_231_773_5],
        0.41,
    );
}

/// On the seam between side and end, to the last digit of single precision.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_large_spin_torque_next_to_a_seam() {
    let origin = Vector3::new(2.041_170_8_f32, -2.174_271_8, 2.141_409_6);
    let axis = Vector3::new(0.740_780_1, -0.598_949_9, -0.304_144_4);
    judged(
        Asked::Soft,
        Capsule::new(origin, axis, 1.990_495_8, 1.760_703_4).unwrap(),
        [[1.047_284_75e-8, -7.782_314e-9, -4.277_006_3e-9], [8.345_348e-7, -3.400_052_5e-6, 8.736_542e-6]],
        [2.026_068_196_144_811, -2.756_499_370_171_335, 4.060_645_185_016_838],
        2.0,
    );
}

/// Under a spin torque of 10⁵ times force times distance, at a cosine of a thousandth, rounding decides between the side
/// of a cone and its tip, and where on the side the contact is: that is said.
#[test]
fn a_cone_says_where_rounding_decides() {
    let axis = Vector3::new(-0.960_012_537_320_125_9, -0.010_869_229_405_547_682, -0.279_745_934_805_679_44);
    let count = judged(
        Asked::Soft,
        Cone::new(Vector3::zeros(), axis, 0.532_571_656_526_439_6).unwrap(),
        [
            [7.279_403_040_578_454e-9, 2.489_083_527_570_18e-8, 1.623_200_433_754_143_6e-8],
            [1.799_332_638_094_836_7e-6, 5.472_146_331_708_093e-7, -1.652_283_942_351_645_5e-6],
        ],
        [-0.000_810_413_329_377_736_4, 0.000_136_350_271_263_228_85, -0.000_837_380_461_529_627_8],
        0.001,
    );
    assert_eq!(count.unsure, 1, "{count}");
}
