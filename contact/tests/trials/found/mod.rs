//! Trials that were once wrong or lost among a million, each judged as there.

mod boxes;
mod posed;
mod revolutions;
mod superquadrics;

use fingertip_contact::{ContactModel, SoftFinger, SoftFingerSurface};
use fingertip_surfaces::{CappedCylinder, Capsule, Cone, Cylinder, Ellipsoid, Frustum, Superquadric, Torus};
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

/// The same of one that must be told.
fn told<T: Real, S: SoftFingerSurface<T> + Exact>(
    asked: Asked,
    surface: S,
    load: [[T; 3]; 2],
    near: [f64; 3],
    size: f64,
) {
    let count = judged(asked, surface, load, near, size);
    assert_eq!((count.unsure, count.none, count.unjudged), (0, 0, 0), "{count}");
}

/// A line that misses by the rounding of its wrench, and touches but for that.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_grazing_force_on_a_ring() {
    let count = judged(
        Asked::Point,
        Torus::new(0.410_666_5_f32, 0.021_947_136).unwrap(),
        [[5.022_385e-6, 3.435_101_5e-7, -3.261_468_4e-5], [-6.291_037e-6, 1.263_751e-5, -8.356_633e-7]],
        [0.386_996_626_550_162_8, 0.192_856_705_874_691_14, 0.003_133_282_786_231_773_5],
        0.41,
    );
    assert_eq!(count.unjudged, 1, "{count}");
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

/// On the side of a cone, where the torque leans away from the normals of the side by half a rounding. The place is that of
/// Newton's method with 31 digits, which from some starts does not lead there.
#[test]
fn on_the_side_of_a_cone_next_to_the_tip() {
    let axis = Vector3::new(-0.960_012_537_320_125_9, -0.010_869_229_405_547_682, -0.279_745_934_805_679_44);
    let cone = Cone::new(Vector3::zeros(), axis, 0.532_571_656_526_439_6).unwrap();
    let wrench = Wrench::on_fingertip(
        Vector3::new(7.279_403_040_578_454e-9, 2.489_083_527_570_18e-8, 1.623_200_433_754_143_6e-8),
        Vector3::new(1.799_332_638_094_836_7e-6, 5.472_146_331_708_093e-7, -1.652_283_942_351_645_5e-6),
    );
    let model = SoftFinger::new(0.0).unwrap().without_friction_limit();
    let found = model.resolve(&wrench, &cone).into_result().unwrap();
    let expected =
        Vector3::new(-0.000_537_378_840_503_056_7, 9.041_281_810_612_626e-5, -0.000_555_260_537_325_715_7);
    assert!((found.point - expected).amax() < 1e-16, "{found:?}");
}

/// Where on the side, for a torque as near to its normals.
#[test]
fn far_along_the_side_of_a_cone() {
    let axis = Vector3::new(0.918_932_561_269_947_9, 0.184_948_379_348_249_56, -0.348_363_380_415_205_76);
    let count = judged(
        Asked::Soft,
        Cone::new(Vector3::zeros(), axis, 0.199_221_234_947_965_23).unwrap(),
        [
            [3_777.891_452_107_373_f64, 769.837_757_945_351_5, 596.551_652_946_510_6],
            [-328_503.850_947_853_8, 2_491_234.683_879_466_7, -1_102_914.613_490_806_7],
        ],
        [0.007_946_542_059_666_283, 4.455_478_179_919_371_6e-5, -0.002_266_243_660_202_862_7],
        1e-3,
    );
    assert_eq!((count.unsure, count.none), (0, 0), "{count}");
}

/// On the side of a frustum that is a whole cone, blunt, and with its tip elsewhere than the origin.
#[test]
fn on_the_side_of_a_pointed_frustum() {
    let base = Vector3::new(-1.371_151_021_484_341_4, 4.862_892_264_269_302, 3.201_492_185_631_757_5);
    told(
        Asked::Soft,
        Frustum::new(base, Vector3::z(), 3.509_270_938_519_971, 0.0, 1.282_302_156_338_404_5).unwrap(),
        [
            [-1.960_702_483_413_843_6e-7, -2.555_515_035_091_498_4e-7, -9.064_566_506_216_464e-8],
            [-0.000_171_240_963_503_099_05, 0.004_019_136_481_755_459, -0.011_010_654_859_008_337],
        ],
        [-1.362_800_364_042_643_8, 4.667_651_928_683_183, 4.412_387_488_143_836],
        1.0,
    );
}

/// A line that single precision takes for a tangent of the side.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_line_that_grazes_the_side_of_a_capsule() {
    let origin = Vector3::new(0.046_054_266_f32, 0.049_467_735, -0.021_025_078);
    let count = judged(
        Asked::Point,
        Capsule::new(origin, Vector3::z(), 0.028_168_712, 0.011_191_642).unwrap(),
        [[6.019_013e-8, -7.895_908e-8, -2.528_550_9e-8], [-3.142_969_9e-9, 6.177_327_5e-10, -9.410_584e-9]],
        [0.068_437_788_773_409_28, 0.066_569_026_723_800_66, -0.018_487_274_186_617_185],
        0.03,
    );
    assert_eq!((count.none, count.unjudged), (0, 0), "{count}");
}

/// One along the axis, which rounding lets enter by the cap.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_line_along_the_side_of_a_capsule() {
    let origin = Vector3::new(1.163_328_3_f32, -4.117_909_4, -2.469_259_7);
    let axis = Vector3::new(0.398_461_13, -0.855_951, 0.329_509_62);
    let count = judged(
        Asked::Point,
        Capsule::new(origin, axis, 21.541_548, 40.427_578).unwrap(),
        [
            [-0.000_583_408_2, 0.001_255_585_5, -0.000_487_287_38],
            [-0.022_289_684, -0.005_273_67, 0.013_097_902],
        ],
        [5.526_339_541_255_674, 10.557_118_275_798_524, 13.655_249_520_484_02],
        40.0,
    );
    assert_eq!((count.none, count.unjudged), (0, 0), "{count}");
}

/// One that single precision takes for a tangent of a cylinder.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_line_that_grazes_a_cylinder() {
    let centre = Vector3::new(0.000_251_553_8_f32, 0.000_255_221, 0.000_126_410_96);
    let axis = Vector3::new(0.744_083_3, -0.099_905_33, -0.660_574_73);
    let count = judged(
        Asked::Point,
        Cylinder::new(centre, axis, 0.000_132_124_48).unwrap(),
        [
            [-1.087_423e-9, 3.336_495_3e-9, -1.645_575e-9],
            [-1.419_600_8e-12, 1.582_627_5e-13, 1.258_982_1e-12],
        ],
        [0.000_269_875_119_562_531_2, 0.000_329_719_893_741_654_4, 0.000_262_857_236_814_434_5],
        1e-4,
    );
    assert_eq!((count.none, count.unjudged), (0, 0), "{count}");
}

/// Next to a plane of two axes, where the surface is bent so sharply that the rounding of a place turned its normal away
/// from a line that misses by 34 fm.
#[test]
fn a_force_that_all_but_grazes_a_superquadric() {
    let axes = Vector3::new(1.423_449_6e-6_f32, 2.237_971e-6, 1.004_115_7e-6);
    let count = judged(
        Asked::Point,
        Superquadric::new(axes, [1.189_344_6, 1.585_035_8]).unwrap(),
        [[-2_915.305_7, -573.132_93, 544.371_9], [0.001_132_081_3, 0.000_339_785_27, 0.006_420_437]],
        [-2.358_817_4e-9, 2.201_856_7e-6, -1.161_117_5e-7],
        2.2e-6,
    );
    assert_eq!((count.unsure, count.none), (0, 1), "{count}");
}

/// One all but along the axis, which rounding lets miss the ball of the end next to which it enters by the side.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_line_all_but_along_the_axis_of_a_capsule() {
    let centre = Vector3::new(-0.000_132_988_13_f32, 0.000_173_550_61, -0.000_168_694_4);
    let axis = Vector3::new(-0.481_469_4, -0.079_203_94, -0.872_876_8);
    told(
        Asked::Point,
        Capsule::new(centre, axis, 0.000_141_352_11, 0.000_275_942_85).unwrap(),
        [[-9.911_006e-7, -1.662_489_4e-7, -1.793_119_7e-6], [-4.324_628e-10, 2.020_286e-10, 2.203_015_7e-10]],
        [8.632_2e-5, 0.000_236_76, -4.766_6e-5],
        3e-4,
    );
}

/// One all but along the axis of a cone, far from its tip.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_line_all_but_along_the_axis_of_a_cone() {
    let axis = Vector3::new(-0.588_598_1_f32, 0.755_138_8, 0.288_648_04);
    told(
        Asked::Point,
        Cone::new(Vector3::zeros(), axis, 0.435_960_9).unwrap(),
        [[-7.388_388e-9, 9.434_181e-9, 3.497_917_5e-9], [-6.788_536e-8, -2.344_911_4e-7, 4.890_535e-7]],
        [-20.015_304_057_962_062, 91.749_574_463_317_93, 41.213_727_271_881_42],
        100.0,
    );
}

/// On an edge where the axis of its spin torque is all but square to the force.
#[test]
fn on_the_edge_of_a_capped_cylinder_at_a_flat_angle() {
    let centre = Vector3::new(715.632_454_329_584_7, 233.954_519_231_402_06, -71.882_625_748_803_46);
    let axis = Vector3::new(-0.971_532_084_558_638_7, -0.188_840_349_727_761_84, 0.143_054_992_879_811_3);
    told(
        Asked::Edge,
        CappedCylinder::new(centre, axis, 361.386_227_156_026_96, 633.113_605_661_952_6).unwrap(),
        [
            [5.007_917_006_383_839e-5, 0.000_186_870_145_195_250_28, 0.000_521_761_342_137_113_6],
            [0.055_210_568_244_605_93, -0.054_976_739_190_135_945, 0.014_328_207_377_224_794],
        ],
        [73.761_433_250_797_98, -5.330_180_222_515_253, -321.236_325_859_449_7],
        361.0,
    );
}

/// One that passes an ellipsoid by the rounding of its wrench, and touches but for that.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_line_that_grazes_an_ellipsoid() {
    told(
        Asked::Point,
        Ellipsoid::new(Vector3::new(19.138_712_f32, 63.404_556, 32.997_673)).unwrap(),
        [[519.5118, 32.572_144, 127.905_25], [-7_837.676_3, -2_761.791_5, 32_537.545]],
        [0.775_700_241_859_731, -62.582_368_104_309_7, -5.125_148_886_105_851],
        63.0,
    );
}

/// A force that all but grazes a ring.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_soft_finger_that_grazes_a_ring() {
    told(
        Asked::Soft,
        Torus::new(46.400_425_f32, 2.466_054).unwrap(),
        [
            [0.000_281_062_76, 7.536_252e-5, 1.165_776_7e-6],
            [-0.000_132_525_44, 0.000_704_255_9, -0.013_578_445],
        ],
        [-13.782_970_534_305_825, 44.650_009_780_181_18, 2.444_074_772_076_167],
        46.0,
    );
}
