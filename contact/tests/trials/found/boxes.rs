//! The same of rounded boxes in poses.

use fingertip_contact::{ContactModel, NoContact, Resolution, SoftFinger};
use fingertip_surfaces::{ActiveSurface, Posed, RoundedBox};
use fingertip_wrench::Wrench;
use nalgebra::Vector3;

use super::posed::pose;
use super::{judged, told};
use crate::try_out::Asked;

/// On an edge of a posed box, under a spin torque of 50 000 radii.
#[test]
fn a_very_large_spin_torque_on_a_box_in_a_pose() {
    let half =
        Vector3::new(1.481_801_170_410_778_7e-5, 2.792_618_069_641_970_7e-5, 2.841_833_675_902_361_2e-5);
    let rotation = [
        0.647_309_362_134_261_9_f64,
        0.037_396_218_794_465_697,
        0.761_309_472_234_000_3,
        0.698_124_621_187_161,
        -0.430_008_754_984_736_1,
        -0.572_463_521_919_746_7,
        0.305_961_767_195_867_76,
        0.902_049_884_128_562_9,
        -0.304_455_913_981_036,
    ];
    told(
        Asked::Soft,
        Posed::new(
            RoundedBox::new(half, 4.354_392_080_142_508_5e-6).unwrap(),
            pose(rotation, [0.0, 0.0, -0.0]),
        ),
        [
            [0.004_904_392_184_082_318, -0.025_857_326_525_155_027, 0.011_739_964_652_547_067],
            [0.004_118_403_274_606_427, 0.002_938_714_907_848_8, 0.004_774_663_911_975_041],
        ],
        [-2.709_301_613_891_353_6e-5, 1.366_967_975_548_915_1e-5, -2.071_020_896_496_624_5e-5],
        3e-5,
    );
}

/// A force that is pure for all that its numbers say, and presses on a corner at a cosine of 2e-6: more than that of a touch.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_force_that_all_but_grazes_a_small_box_in_a_pose() {
    let rotation = [
        0.895_296_8_f32,
        -0.213_883_12,
        -0.390_765_6,
        -1.482_665_5e-5,
        0.877_183_7,
        -0.480_155,
        0.445_470_27,
        0.429_887,
        0.785_336_55,
    ];
    told(
        Asked::Soft,
        Posed::new(
            RoundedBox::new(Vector3::new(1.119_236_5e-6, 6.397_577_3e-7, 1.094_565_7e-6), 6.586_025e-8)
                .unwrap(),
            pose(rotation, [8.845_806e-8, 2.166_444_3e-7, -2.265_322_4e-7]),
        ),
        [[1.570_122_5e-12, 4.514_143_4e-12, 3.364_945e-12], [8.706_945e-18, 7.363_263_5e-19, -5.050_564e-18]],
        [-7.248_706_985_661_952e-7, 1.132_477_601_098_518_5e-6, -1.084_938_030_721_884_1e-6],
        1.1e-6,
    );
}

/// The same of one that spins as much.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_force_that_all_but_grazes_a_box_in_a_pose() {
    let rotation = [
        0.495_463_85_f32,
        0.548_842_9,
        -0.673_266,
        0.848_643_54,
        -0.471_162_9,
        0.240_436_48,
        -0.185_256_14,
        -0.690_490_37,
        -0.699_216_2,
    ];
    told(
        Asked::Soft,
        Posed::new(
            RoundedBox::new(Vector3::new(1.969_991_7, 1.585_997, 0.950_888_5), 0.382_668_02).unwrap(),
            pose(rotation, [-0.163_837_06, -3.590_993, -3.059_318_8]),
        ),
        [[-12_124_081.0, 16_039_735.0, 949_601.44], [71_164_330.0, 54_337_056.0, -9_214_049.0]],
        [1.334_125_413_253_587_8, -2.525_455_808_104_751, -4.586_787_861_547_9],
        2.0,
    );
}

/// A pure force for all that its numbers say: of the two places where it grazes none is told from the other. Newton's method
/// with 31 digits leads to the first.
#[test]
#[cfg_attr(not(feature = "mixed-precision"), ignore = "single precision alone does not tell")]
fn a_force_that_grazes_a_box_in_a_pose() {
    let rotation = [
        0.551_005_7_f32,
        0.440_288_4,
        -0.708_899_9,
        -0.402_400_7,
        -0.604_018_33,
        -0.687_921_2,
        -0.731_072_25,
        0.664_310_3,
        -0.155_645_07,
    ];
    let posed = Posed::new(
        RoundedBox::new(Vector3::new(0.227_719_19, 0.098_047_48, 0.108_219_69), 0.011_772_703).unwrap(),
        pose(rotation, [0.247_992_35, -0.085_158_184, 0.012_746_323]),
    );
    let load = [[0.393_534_93, -0.637_795_15, 0.846_568_47], [-0.067_739_01, -0.078_655_295, -0.027_768_925]];
    let near = [0.090_547_189_956_472_48, -0.076_185_443_257_131_9, -0.005_084_417_309_364_167];
    let count = judged(Asked::Soft, posed, load, near, 0.23);
    assert_eq!((count.unsure, count.none, count.unjudged), (0, 0, 1), "{count}");

    let wrench = Wrench::on_fingertip(load[0].into(), load[1].into());
    let found = SoftFinger::new(0.0).unwrap().without_friction_limit().resolve(&wrench, &posed);
    let Resolution::NoContact(NoContact::Ambiguous { first, second }) = found else { panic!("{found:?}") };
    let grazed = Vector3::new(0.252_150_5, -0.194_210_1, -0.219_478_02);
    assert!((first - grazed).amax() < 1e-7, "{first}");
    // Either bears the torque that is left of the wrench along its normal, and the two turn against each other.
    let spin = |point: Vector3<f32>| {
        let normal = posed.normal(&point);
        let left = wrench.torque_about(&point);
        assert!((left - normal * left.dot(&normal)).norm() < 1e-5 * left.norm(), "{left} {normal}");
        left.dot(&normal)
    };
    assert!(spin(first) * spin(second) < 0.0, "{first} {second}");
}
