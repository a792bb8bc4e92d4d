//! The same of shapes in poses, where moving the wrench into the frame of the shape rounds it.

use fingertip_surfaces::{CappedCylinder, Capsule, Cone, Ellipsoid, Frustum, Posed, Sphere, Torus};
use fingertip_wrench::{Real, RigidTransform};
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::{judged, told};
use crate::try_out::Asked;

/// A pose of which the rows of the rotation are told.
pub(super) fn pose<T: Real>(rotation: [T; 9], origin: [T; 3]) -> RigidTransform<T> {
    let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_row_slice(&rotation));
    RigidTransform::from_parts(rotation, origin.into())
}

/// On the side of a posed cylinder, whose edge the rounding of the moved wrench takes it for.
#[test]
fn on_the_side_next_to_an_edge() {
    let cylinder = CappedCylinder::new(
        Vector3::new(-3.516_942_956_990_979, 3.593_152_741_052_695, -10.789_489_058_893_702),
        Vector3::new(-0.064_187_365_237_489_47, 0.808_222_579_760_054_4, -0.585_368_468_325_611),
        4.491_581_729_382_457,
        0.953_908_429_498_852_8,
    );
    let rotation = [
        -0.271_005_864_538_134_f64,
        0.762_654_702_234_786_5,
        -0.587_293_475_653_445_7,
        0.950_513_441_250_169_2,
        0.308_322_589_935_504_6,
        -0.038_227_981_090_072_97,
        0.151_921_095_930_408_12,
        -0.568_590_349_631_992_2,
        -0.808_470_775_548_920_1,
    ];
    let origin = [-0.035_634_977_910_977_13, 0.055_382_718_980_592_494, 0.119_258_122_395_462_25];
    told(
        Asked::Soft,
        Posed::new(cylinder.unwrap(), pose(rotation, origin)),
        [
            [-54_362.765_549_737_54, -13_710.791_135_107_8, -35_904.803_339_870_65],
            [-625_845_442.577_017_8, 2_908_493_747.728_846, -155_221_475.885_048_7],
        ],
        [8.173_641_733_520_393, 2.428_963_274_833_974_2, 6.027_313_048_645_156],
        4.5,
    );
}

/// Where moving a line to a posed sphere rounds it at an angle that is nearly flat.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_posed_sphere_at_a_middling_angle() {
    let sphere = Sphere::new(Vector3::new(0.000_794_278_46_f32, -0.048_035_8, 0.001_949_497_6), 0.019_273_89);
    let rotation = [
        0.686_054_05_f32,
        0.106_162_76,
        0.719_763_64,
        0.698_599_8,
        -0.372_422_1,
        -0.610_950_3,
        0.203_195_78,
        0.921_971_5,
        -0.329_666_85,
    ];
    told(
        Asked::Point,
        Posed::new(sphere.unwrap(), pose(rotation, [0.0; 3])),
        [
            [-2.732_493e-11, -4.463_603_5e-12, -1.941_943_5e-11],
            [-3.510_746e-13, 5.878_624_4e-13, 3.588_726_8e-13],
        ],
        [-0.007_323_716_757_981_129, 0.011_937_176_877_851_126, -0.026_718_636_602_641_458],
        0.019,
    );
}

/// On the edge of a posed cone with a normal that is all but along the axis: where on the edge.
#[test]
fn on_the_edge_of_a_cone_in_a_pose() {
    let base = Vector3::new(0.624_346_141_287_415_7, -0.375_421_123_113_151_5, -0.418_294_933_171_563_74);
    let axis = Vector3::new(0.579_857_521_402_202_5, 0.403_753_608_983_025_3, -0.707_635_695_896_184);
    let rotation = [
        -0.281_775_517_451_033_1,
        0.501_420_664_412_241_2,
        0.818_034_152_750_109,
        -0.781_159_437_575_252_2,
        0.375_169_359_801_779,
        -0.499_036_957_101_414_27,
        -0.557_128_791_979_303_4,
        -0.779_631_495_494_063_2,
        0.285_975_943_710_956_47,
    ];
    let origin = [-0.017_023_130_196_818_74, 0.008_894_088_698_222_672, 0.007_670_189_782_570_445];
    let tip = Frustum::new(base, axis, 0.316_866_440_651_917_8, 0.0, 0.250_408_301_478_575_6).unwrap();
    judged(
        Asked::Edge,
        Posed::new(tip, pose(rotation, origin)),
        [
            [-1.779_616_700_783_703_7e-5, -8.970_630_333_750_614e-7, 5.499_289_764_736_135e-6],
            [-2.173_869_964_766_159_6e-6, 8.440_033_499_288_315e-6, -5.719_820_873_976_349e-6],
        ],
        [-0.460_388_991_119_750_6, -0.347_719_809_149_302_06, -0.332_178_264_635_784_87],
        0.3,
    );
}

/// On the seam of a posed capsule, of which the rounding of the moved wrench is on the other side.
#[test]
fn a_large_spin_torque_next_to_a_seam_in_a_pose() {
    let axis = Vector3::new(0.349_430_768_951_095_7, -0.201_139_827_854_662_1, 0.915_117_974_558_932_4);
    let rotation = [
        -0.437_581_519_198_173_95_f64,
        0.535_178_213_499_746_9,
        -0.722_569_507_972_373_3,
        0.896_067_761_276_083_7,
        0.326_329_124_947_929_76,
        -0.300_951_606_429_317_3,
        0.074_732_732_171_959_53,
        -0.779_162_102_521_637_4,
        -0.622_351_537_907_777_5,
    ];
    told(
        Asked::Soft,
        Posed::new(
            Capsule::new(Vector3::zeros(), axis, 3.107_080_343_806_948, 1.601_742_681_851_226_8).unwrap(),
            pose(rotation, [-0.827_688_917_654_462_5, 6.500_178_167_563_638_5, 1.161_818_478_940_085_6]),
        ),
        [
            [-41_837_733_800.351_92, -4_613_928_396.402_772, -17_585_647_043.427_597],
            [541_174_597_753_228.4, -10_316_141_232_503.898, -1_289_259_158_060_157.8],
        ],
        [-3.486_700_858_445_796, 6.478_510_053_180_271, 3.415_672_332_464_531_7],
        3.0,
    );
}

/// One that misses a posed cone by less than single precision can tell, and touches at a tangent if it does not.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_line_that_all_but_grazes_a_posed_cone() {
    let apex = Vector3::new(79.564_16, 91.269_43, 196.115_13);
    let axis = Vector3::new(-0.129_454_6, -0.787_196_16, 0.602_962_43);
    let rotation = [
        -0.363_915_44_f32,
        0.461_986_72,
        0.808_785_5,
        -0.835_348_4,
        -0.545_983_14,
        -0.063_996_285,
        0.412_017_88,
        -0.698_906_9,
        0.584_611_65,
    ];
    let count = judged(
        Asked::Point,
        Posed::new(
            Cone::new(apex, axis, 0.514_013_23).unwrap(),
            pose(rotation, [24.241_041, -47.944_61, -99.738_36]),
        ),
        [[-48_124_800.0, -45_577_816.0, -309_647.97], [-360_447_000.0, 500_109_220.0, -17_592_386_000.0]],
        [201.011_077_108_141_68, -175.184_915_386_257_73, -9.098_563_531_043_936],
        100.0,
    );
    assert_eq!((count.unsure, count.none, count.unjudged), (0, 0, 1), "{count}");
}

/// Next to the tip of a posed cone, where a spin torque of many levers multiplies what moving the wrench rounds.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_large_spin_torque_next_to_the_tip_in_a_pose() {
    let axis = Vector3::new(0.432_265_46, -0.458_181_47, -0.776_670_04);
    let rotation = [
        -0.511_188_15_f32,
        0.686_780_2,
        -0.516_739_55,
        0.532_972_2,
        0.724_975_5,
        0.436_292_7,
        0.674_260_7,
        -0.052_380_13,
        -0.736_633_54,
    ];
    told(
        Asked::Soft,
        Posed::new(
            Cone::new(Vector3::zeros(), axis, 0.201_204_66).unwrap(),
            pose(rotation, [-2.708_344_8e-5, -0.000_216_990_21, 0.000_888_987_7]),
        ),
        [[0.048_145_976, 0.030_683_348, -0.017_819_53], [0.074_123_986, -0.108_942_114, -0.013_050_999]],
        [-0.000_105_944_864_549_603_23, -0.000_305_474_906_402_863_27, 0.001_179_639_114_091_152_9],
        1e-4,
    );
}

/// On a posed cylinder at a middling angle, where a spin torque multiplies what moving the wrench rounds.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_posed_capped_cylinder_at_a_middling_angle() {
    let centre = Vector3::new(-1.007_913e-5, 1.809_745_4e-6, -3.900_993_8e-6);
    let axis = Vector3::new(-0.216_278_1, 0.410_175_5, -0.885_990_86);
    let rotation = [
        0.216_104_21_f32,
        0.749_241_05,
        -0.626_049_04,
        0.328_623,
        -0.659_605_4,
        -0.675_964_36,
        -0.919_405_46,
        -0.059_655_517,
        -0.388_760_86,
    ];
    told(
        Asked::Soft,
        Posed::new(
            CappedCylinder::new(centre, axis, 4.149_604e-6, 1.811_782_8e-6).unwrap(),
            pose(rotation, [0.0, 0.0, 0.0]),
        ),
        [[30_486_916.0, 20_915_952.0, 2_322_784.8], [-319.209_78, 456.060_82, 82.994_24]],
        [8.336_266_394_404_124e-7, -2.150_373_808_305_249e-6, 1.502_274_407_467_490_7e-5],
        4e-6,
    );
}

/// A pure force that grazes a posed sphere, or passes by: single precision cannot tell, and double says so.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_force_that_grazes_a_posed_sphere_far_off() {
    let centre = Vector3::new(-0.000_415_500_8, -0.000_364_742_97, -0.000_534_706_17);
    let rotation = [
        -0.255_135_92_f32,
        -0.178_042_89,
        0.950_371_86,
        -0.916_053_4,
        -0.270_047_9,
        -0.296_513_7,
        0.309_438_14,
        -0.946_242_6,
        -0.094_197_69,
    ];
    let count = judged(
        Asked::Soft,
        Posed::new(
            Sphere::new(centre, 0.000_431_162_95).unwrap(),
            pose(rotation, [-0.000_937_789_1, 0.000_464_349_75, -4.883_966e-5]),
        ),
        [
            [-152_295_800_000.0, -967_246_400_000.0, -4_670_422_500.0],
            [1_643_661.5, -8_802_332.0, 1_769_369_100.0],
        ],
        [-0.001_646_327_068_987_165_3, 0.001_161_982_697_558_594_2, 7.310_043_446_002_692e-6],
        4e-4,
    );
    assert_eq!((count.unsure, count.none, count.unjudged), (0, 0, 1), "{count}");
}

/// A pure force that grazes a posed sphere, or passes by: single precision cannot tell, and double says so.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_force_that_grazes_a_posed_sphere_near_by() {
    let centre = Vector3::new(0.000_295_168_92, -0.000_309_351_22, 0.000_110_453_184);
    let rotation = [
        0.304_966_1_f32,
        0.143_494_37,
        0.941_491,
        0.948_681_5,
        -0.132_616_56,
        -0.287_082_8,
        0.083_662_54,
        0.980_725_4,
        -0.176_573_92,
    ];
    let count = judged(
        Asked::Soft,
        Posed::new(
            Sphere::new(centre, 0.000_156_762_34).unwrap(),
            pose(rotation, [3.429_696e-5, 3.157_062_4e-5, -5.802_897e-5]),
        ),
        [
            [0.020_619_316, -0.010_180_868, -0.012_264_061],
            [-8.311_727_5e-6, -2.710_041_1e-6, -1.172_462_9e-5],
        ],
        [0.000_275_226_432_335_715, 0.000_432_729_402_697_203_9, -0.000_295_132_717_462_345_64],
        1e-4,
    );
    assert_eq!((count.unsure, count.none, count.unjudged), (0, 0, 1), "{count}");
}

/// Pressed at a flat angle with next to no spin torque: moved in single precision, it only pulls.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_ring_in_a_pose_at_a_flat_angle() {
    let rotation = [
        0.920_929_1_f32,
        0.022_050_26,
        0.389_105_9,
        0.043_252_565,
        0.986_448,
        -0.158_270_48,
        -0.387_322_63,
        0.162_585_7,
        0.907_494_9,
    ];
    told(
        Asked::Soft,
        Posed::new(
            Torus::new(5.865_888_3e-5, 7.162_359_5e-6).unwrap(),
            pose(rotation, [0.000_107_431_63, 2.086_569_7e-5, -8.180_258e-5]),
        ),
        [[3.728_150_5e-5, -5.514_305e-5, 0.000_193_519_63], [2.327_967_5e-11, -3.365_212e-8, -9.593_593e-9]],
        [0.000_154_212_249_803_694_26, 2.923_323_804_273_205e-5, -0.000_102_169_283_250_405_12],
        5.865_888_3e-5,
    );
}

/// Two contacts that are about to merge in a fold, on a posed torus.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_fold_on_a_ring_in_a_pose() {
    let rotation = [
        -0.428_603_4_f32,
        0.227_615_12,
        0.874_351_5,
        -0.873_549_2,
        0.142_681_39,
        -0.465_353_73,
        -0.230_675_13,
        -0.963_241_2,
        0.137_679_34,
    ];
    told(
        Asked::Soft,
        Posed::new(
            Torus::new(0.090_185_03, 0.011_604_8).unwrap(),
            pose(rotation, [0.262_551_96, -0.112_954_52, -0.090_110_786]),
        ),
        [
            [-73_575_820_000.0, -20_348_936_000.0, -102_629_180_000.0],
            [1_829_707_000.0, 42_996_806_000.0, -9_836_982_000.0],
        ],
        [0.310_061_267_372_928_4, -0.047_944_630_824_066_234, -0.151_890_558_883_015_11],
        0.090_185_03,
    );
}

/// On the edge of a posed cylinder, which the rounding of the moved wrench takes for a place on the side next to it.
#[test]
fn on_the_edge_next_to_a_side() {
    let axis = Vector3::new(0.974_230_628_002_192_3, -0.214_361_264_413_592_18, 0.070_170_733_083_388_52);
    let cylinder =
        CappedCylinder::new(Vector3::zeros(), axis, 350.955_364_157_207_67, 349.235_389_138_127_74);
    let rotation = [
        0.049_737_812_782_002_754_f64,
        -0.783_472_295_686_828_1,
        0.619_433_056_811_528_3,
        0.933_999_402_988_309_9,
        0.256_182_667_764_003_67,
        0.249_029_227_109_589_05,
        -0.353_795_513_251_855_1,
        0.566_163_936_177_967_6,
        0.744_504_621_996_618,
    ];
    let origin = [136.361_797_414_373_14, 57.163_889_532_731_93, 464.082_454_346_801_74];
    told(
        Asked::Soft,
        Posed::new(cylinder.unwrap(), pose(rotation, origin)),
        [
            [7.434_756_030_909_559e-11, -1.479_449_151_841_072_5e-10, 1.409_143_353_558_418_6e-10],
            [-0.000_220_001_132_252_981_76, 0.000_240_898_628_954_745_54, 0.000_369_781_147_161_918_84],
        ],
        [381.219_340_532_715_9, 182.132_967_403_098_2, 60.324_788_105_246_34],
        350.0,
    );
}

/// A pure force that all but grazes a posed ellipsoid.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_force_that_grazes_an_ellipsoid_in_a_pose() {
    let ellipsoid = Ellipsoid::new(Vector3::new(7.644_482e-5_f32, 2.291_203_8e-5, 9.225_229_6e-5));
    let rotation = [
        -0.477_969_7_f32,
        -0.717_696_7,
        -0.506_415_3,
        -0.150_899_83,
        0.635_056_1,
        -0.757_583_9,
        0.865_317_4,
        -0.285_684_3,
        -0.411_837_76,
    ];
    told(
        Asked::Soft,
        Posed::new(ellipsoid.unwrap(), pose(rotation, [6.223_624e-6, 6.533_998_4e-5, 7.950_631e-6])),
        [[1_072_273.0, -473_246.53, -356_785.03], [-16.402_138, 82.062_12, -158.143_36]],
        [4.234_372_620_699_446_6e-5, 0.000_128_795_867_984_257_94, 6.244_166_072_180_52e-5],
        9e-5,
    );
}
