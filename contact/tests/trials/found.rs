//! Trials that were once wrong or lost among a million, each judged as there.

use fingertip_contact::SoftFingerSurface;
use fingertip_surfaces::{Capsule, Torus};
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
