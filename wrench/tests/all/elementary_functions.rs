//! The elementary functions of `Real`: the same bits whatever the features, and the values that they are to have.

use fingertip_wrench::Real;
use proptest::prelude::*;

/// Each at numbers where the C library of the day that this was written rounded otherwise than `libm`: a function that is
/// the standard library's again shows here.
macro_rules! bits {
    ($float:ident: $($function:ident($x:literal $(, $other:literal)?) = $bits:literal),* $(,)?) => {
        $(
            let x = $float::from_bits($x);
            let found = Real::$function(x $(, $other)?);
            assert_eq!(found.to_bits(), $bits, "{} of {x}: {found}", stringify!($function));
        )*
    };
}

#[test]
fn elementary_functions_have_these_bits() {
    bits!(f64:
        power(0x3feb_e062_47aa_6e38, 1.7) = 0x3fe9_4f7a_3f74_1b60,
        power(0x4004_e59d_6cf9_3a48, 1.7) = 0x4014_7643_6a1c_6d30,
        exponential(0xc00b_eded_ccfe_f42a) = 0x3f9f_3238_b50e_18e2,
        exponential(0xc011_8ae4_c79a_b3dc) = 0x3f89_81f9_1375_5924,
        exponential_less_one(0x3fd6_baeb_b663_4ef8) = 0x3fdb_4a40_d6b2_5d70,
        exponential_less_one(0x3fd2_eae3_6afa_d638) = 0x3fd6_02b0_f76a_13c4,
        logarithm(0x3ffb_08d2_2f8d_eb6d) = 0x3fe0_c8e5_8d9c_a19a,
        logarithm(0x4021_2a49_7d55_809e) = 0x4001_32a8_c40c_68ee,
        sine(0xc00e_e9fa_bfc8_a4f0) = 0x3fe5_2a03_3d32_92fc,
        sine(0x400c_c0cc_7d39_ec98) = 0xbfdb_fc08_8f15_5179,
        cosine(0xc00f_5eee_805a_4788) = 0xbfe6_c12e_a939_0348,
        cosine(0xbff0_4a83_6144_b6a8) = 0x3fe0_cc07_9660_b780,
        tangent(0x3fea_4eb1_bec0_8960) = 0x3ff1_3851_42f2_1910,
        tangent(0x3ff5_35a7_ccd5_1e10) = 0x400f_f869_0ba5_b32b,
        arctangent(0x4009_7494_d845_fb68) = 0x3ff4_42be_8c91_e6e2,
        arctangent(0x4006_cb95_fda0_94fa) = 0x3ff3_bb7e_d70d_63c8,
        arctangent2(0x4011_180b_9f1f_d10e, 0.7) = 0x3ff6_88f5_8a6b_829e,
        arctangent2(0x4011_c2e0_6fa0_7880, 0.7) = 0x3ff6_a188_2702_92fc,
        arccosine(0x3fdf_80e0_f564_0328) = 0x3ff0_e5ec_89f3_628a,
        arccosine(0x3fdb_f439_54ba_5088) = 0x3ff1_e684_b049_aa16,
    );
    bits!(f32:
        power(0x3dd1_0b0b, 1.7) = 0x3ca9_4022,
        power(0x3f9c_831f, 1.7) = 0x3fb4_2bc8,
        exponential(0xc0d9_cff5) = 0x3a91_04f0,
        exponential(0xc0d2_8123) = 0x3ab6_396c,
        exponential_less_one(0x3ee1_e718) = 0x3f0d_fa0f,
        exponential_less_one(0xbe9c_9769) = 0xbe86_e926,
        logarithm(0x40ce_4d68) = 0x3fee_8aac,
        logarithm(0x4095_dcb8) = 0x3fc5_a124,
        sine(0xc076_77e7) = 0x3f26_c482,
        sine(0x4039_764a) = 0x3e77_2232,
        cosine(0xbf4f_0929) = 0x3f30_bf0c,
        cosine(0x400a_367d) = 0xbf0e_2b2e,
        tangent(0x3d97_4f9c) = 0x3d97_963e,
        tangent(0x3f02_e981) = 0x3f0f_a892,
        arctangent(0x4031_d454) = 0x3f9c_d7b9,
        arctangent(0x409a_e8d8) = 0x3fae_fcc9,
        arctangent2(0x3e94_d6d6, 0.7) = 0x3ec9_8803,
        arctangent2(0xc032_8bdf, 0.7) = 0xbfa9_982c,
        arccosine(0x3f57_a01d) = 0x3f11_bca1,
        arccosine(0x3f29_a531) = 0x3f58_ae3f,
    );
}

/// That a function is within units in the last place of the value in more digits.
fn is_near<T: Real>(found: T, truth: f64, places: f64) -> Result<(), TestCaseError> {
    let off = (found.to_f64() - truth).abs();
    prop_assert!(off <= places * T::EPSILON.to_f64() * truth.abs(), "{found} {truth}");
    Ok(())
}

/// Single precision against the standard library's double, double against itself: two sources for one number.
fn are_near<T: Real>(x: f64, angle: f64, exponent: f64) -> Result<(), TestCaseError> {
    let number = |x: f64| (T::literal(x), T::literal(x).to_f64());
    let ((p, x), (a, angle), (e, exponent)) = (number(x), number(angle), number(exponent));
    is_near(p.power(e), x.powf(exponent), 2.0)?;
    is_near(e.exponential(), exponent.exp(), 2.0)?;
    is_near(e.exponential_less_one(), exponent.exp_m1(), 2.0)?;
    is_near(p.logarithm(), x.ln(), 2.0)?;
    is_near(a.cube_root(), angle.cbrt(), 2.0)?;
    is_near(a.sine(), angle.sin(), 2.0)?;
    is_near(a.cosine(), angle.cos(), 2.0)?;
    is_near(a.tangent(), angle.tan(), 2.0)?;
    is_near(a.arctangent(), angle.atan(), 2.0)?;
    is_near(a.arctangent2(e), angle.atan2(exponent), 2.0)?;
    let cosine = T::literal(angle / 7.0);
    is_near(cosine.arccosine(), cosine.to_f64().acos(), 2.0)?;
    prop_assert_eq!(a.sine_and_cosine(), (a.sine(), a.cosine()));
    for whole in -4..9 {
        is_near(p.whole_power(whole), x.powi(whole), 10.0)?;
    }
    Ok(())
}

proptest! {
    #[test]
    fn elementary_functions_are_near_those_of_another_library(
        x in 1e-3_f64..1e3, angle in -7.0_f64..7.0, exponent in -3.0_f64..3.0,
    ) {
        are_near::<f32>(x, angle, exponent)?;
        are_near::<f64>(x, angle, exponent)?;
    }
}

fn ends<T: Real>() {
    let [nan, infinite, one] = [f64::NAN, f64::INFINITY, 1.0].map(T::literal);
    assert!((-one).power(T::literal(0.5)) != (-one).power(T::literal(0.5)));
    assert!(!(-one).logarithm().is_number() && !nan.power(one).is_number() && !infinite.sine().is_number());
    assert!(T::literal(1.5).arccosine() != T::literal(1.5).arccosine());
    assert_eq!(T::zero().power(T::literal(0.3)), T::zero());
    assert_eq!(T::zero().power(T::zero()), one);
    assert_eq!((-infinite).exponential(), T::zero());
    assert_eq!(T::literal(-8.0).cube_root(), T::literal(-2.0));
    assert_eq!(T::zero().whole_power(0), one);
    assert_eq!(T::literal(2.0).whole_power(-3), T::literal(0.125));
    assert_eq!(infinite.whole_power(i32::MIN), T::zero());
}

#[test]
fn elementary_functions_at_the_ends_of_the_range() {
    ends::<f32>();
    ends::<f64>();
}
