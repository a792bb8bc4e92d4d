//! A wrist sensor in seven poses: the published weight and biases.

use fingertip_calibration::gravity::{PayloadOptions, Pose, fit_payload};
use fingertip_calibration::nalgebra::{Vector3, Vector6};

use fingertip_test_support::recording;

use super::common;

#[test]
fn published_weight_and_biases_come_back() {
    let Some(path) = recording("ati_axia80_gravity/poses7.csv") else { return };
    let table = common::csv(&path);
    let q = common::columns(&table, &["qx", "qy", "qz", "qw"]);
    let w = common::columns(&table, &["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"]);
    let poses: Vec<Pose> = (0..table.1.len())
        .map(|i| {
            // The recording's readings are in the axes of the base.
            let wrench = Vector6::from_fn(|j, _| w[(i, j)]);
            let pose = Pose::from_quaternion([q[(i, 0)], q[(i, 1)], q[(i, 2)], q[(i, 3)]], wrench).unwrap();
            pose.with_wrench_in_base(&wrench)
        })
        .collect();
    // The author knows that gravity is along −z and the centre of mass on the z axis.
    let options = PayloadOptions { centre_on: Some(Vector3::z()), ..PayloadOptions::default() };
    let fit = fit_payload(&poses, &options).unwrap();
    println!("{fit:#?}");
    let close = |found: f64, published: f64, tolerance: f64| {
        assert!((found - published).abs() < tolerance, "{found} instead of {published}");
    };
    close(fit.weight.z, -10.80391, 1e-4);
    close(fit.force_bias.x, -2.13583, 1e-4);
    close(fit.force_bias.y, -2.76399, 1e-4);
    close(fit.force_bias.z, -13.07675, 1e-4);
    for (found, published) in fit.rms_in_base.iter().zip([0.131, 0.110, 0.193, 0.0033, 0.0030, 0.0021]) {
        close(*found, published, if published > 0.05 { 6e-4 } else { 6e-5 });
    }
    close(fit.centre_of_mass.z, 0.05197, 1e-4);
    for (i, bias) in [-0.15658, -0.07939, 0.12979].into_iter().enumerate() {
        close(fit.torque_bias[i], bias, 1e-4);
    }
}
