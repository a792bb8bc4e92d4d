//! Wrench and array together: what the pipeline says, to the bit, and what is refused.

use core::ptr;

use fingertip::wrench::Wrench;
use fingertip_c::{
    FT_MAX_PLACES, ft_array_reading, ft_fuse, ft_fused, ft_sense_wrench, ft_status, ft_touch, ft_wrench,
};
use fingertip_scene::ArrayReading;
use nalgebra::Vector3;

use crate::{BALL, HEAD, Tip, scene, written};

const FUSION: &str = "[uncertainty]\nforce_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n[fusion]\nposition_deviation_m = 0.001\n\
    normal_deviation_N = 0.1\nstatic_coefficient = 0.5\nplaces = 3\n";

fn fuse(tip: &Tip, readings: &[ft_array_reading]) -> Result<ft_fused, ft_status> {
    written(|fused| unsafe { ft_fuse(tip.0, readings.as_ptr(), readings.len(), fused) })
}

#[test]
fn two_sides_of_a_fingertip_are_told_as_by_the_pipeline() {
    let text = format!("{HEAD}{BALL}{FUSION}");
    let (tip, mut pipeline) = (Tip::new(&text), scene(&text).pipeline());
    let places =
        [Vector3::new(-0.013, 0.0, 0.0), Vector3::new(0.0091, 0.0, 0.0092), Vector3::new(0.0, 0.013, 0.0)];
    let forces = [Vector3::new(1.0, 0.2, 0.0), Vector3::new(-0.8, 0.2, -0.7), Vector3::new(0.0, -0.5, 0.1)];
    let load = places.iter().zip(&forces).map(|(at, force)| {
        let push: Wrench<f64> = Wrench::from_force_at(at, *force);
        push.components()
    });
    let wrench: Wrench<f64> = Wrench::from_components(&load.sum());
    let reported = ft_wrench { force: wrench.force().into(), torque: wrench.torque().into() };
    written(|touch: *mut ft_touch| unsafe { ft_sense_wrench(tip.0, &raw const reported, 1e-3, touch) })
        .unwrap();
    pipeline.sense(wrench, 1e-3);
    for count in 1..=places.len() {
        let readings: Vec<ArrayReading<f64>> = places
            .iter()
            .zip([1.05, 1.0, 0.52])
            .take(count)
            .map(|(centroid, normal_force)| ArrayReading { centroid: *centroid, normal_force })
            .collect();
        let given: Vec<ft_array_reading> = readings
            .iter()
            .map(|reading| ft_array_reading {
                centroid: reading.centroid.into(),
                normal_force: reading.normal_force,
            })
            .collect();
        let (told, expected) = (fuse(&tip, &given).unwrap(), pipeline.fuse(&readings).unwrap());
        assert_eq!(told.count as usize, count);
        assert_eq!(told.disagreement.to_bits(), expected.disagreement.to_bits());
        assert_eq!(
            (told.internal_forces, told.settled),
            (expected.internal_forces.into(), expected.settled.into())
        );
        for (told, expected) in told.contacts.iter().zip(expected.contacts.iter().flatten()) {
            let own: [[f64; 3]; 3] = expected.force_covariance.transpose().into();
            assert_eq!((told.point, told.force), (expected.point.into(), expected.force.into()));
            assert_eq!((told.normal, told.grip), (expected.normal.into(), expected.grip as u32));
            assert_eq!(told.share_from_wrench, expected.share_from_wrench);
            assert_eq!(told.force_covariance, own);
        }
        assert!(told.contacts[count..].iter().all(|contact| *contact == Default::default()));
    }
}

#[test]
fn what_cannot_be_fused_has_its_status() {
    let tip = Tip::new(&format!("{HEAD}{BALL}{FUSION}"));
    let reading = ft_array_reading { centroid: [0.0, 0.0, 0.013], normal_force: 1.0 };
    let refused = |readings: &[ft_array_reading]| fuse(&tip, readings).unwrap_err();
    assert_eq!(refused(&[]), ft_status::FT_WRONG_SIZE);
    assert_eq!(refused(&[reading; FT_MAX_PLACES + 1]), ft_status::FT_WRONG_SIZE);
    assert_eq!(refused(&[ft_array_reading { normal_force: f64::NAN, ..reading }]), ft_status::FT_BAD_NUMBER);
    let none = written(|fused: *mut ft_fused| unsafe { ft_fuse(tip.0, ptr::null(), 1, fused) });
    assert_eq!(none, Err(ft_status::FT_NULL));
    let nowhere = unsafe { ft_fuse(tip.0, &raw const reading, 1, ptr::null_mut()) };
    assert_eq!(nowhere, ft_status::FT_NULL);
    assert_eq!(fuse(&Tip::new(&format!("{HEAD}{BALL}")), &[reading]).unwrap_err(), ft_status::FT_BAD_SCENE);
    let waits = FUSION.replace("force_noise_N = 0.01\ntorque_noise_Nm = 0.0001\n", "");
    let waits = Tip::new(&format!("{HEAD}rest_s = 1.0\n{BALL}{waits}"));
    assert_eq!(fuse(&waits, &[reading]).unwrap_err(), ft_status::FT_NO_REST);
}
