//! The load of a body in motion as a linear function of its mass, first moment and inertia.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::smoothed::Moving;

/// Mass, first moment (3), inertia about the origin (xx, xy, xz, yy, yz, zz), force and torque at rest (3 + 3).
pub(super) const PARAMETERS: usize = 16;

/// Wrench of the load by the parameters.
pub(super) type Regressor = SMatrix<f64, 6, PARAMETERS>;
/// The parameters, in SI.
pub(super) type Parameters = SVector<f64, PARAMETERS>;

/// What messages call them.
pub(super) const NAMES: [&str; PARAMETERS] = [
    "mass",
    "centre of mass x",
    "centre of mass y",
    "centre of mass z",
    "inertia xx",
    "inertia xy",
    "inertia xz",
    "inertia yy",
    "inertia yz",
    "inertia zz",
    "force at rest x",
    "force at rest y",
    "force at rest z",
    "torque at rest x",
    "torque at rest y",
    "torque at rest z",
];

/// Rows and columns of the six entries of an inertia.
pub(super) const ENTRIES: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// The load on the sensor, linear in the parameters (Atkeson, An & Hollerbach 1986): with an accelerometer at `r`,
/// `A = a − α × r − S r`, `S = ωωᵀ − |ω|² 1`,
///
/// `f = −m A − (α × + S) mc + b_f`, `m = −J α − ω × J ω − mc × A + b_m`.
///
/// It is linear in `a`, `α` and `ωωᵀ` as well, so that it holds between filtered sides
/// (`docs/theory/calibration.md#a-payload-from-a-motion`).
pub(super) fn regressor(moving: &Moving, place: &Vector3<f64>) -> Regressor {
    let (faster, products) = (&moving.angular_acceleration, &moving.products);
    let swing = products - Matrix3::identity() * products.trace();
    let at_origin = moving.acceleration - faster.cross(place) - swing * place;
    let of_moment = faster.cross_matrix() + swing;
    let mut x = Regressor::zeros();
    x.fixed_view_mut::<3, 1>(0, 0).copy_from(&-at_origin);
    x.fixed_view_mut::<3, 3>(0, 1).copy_from(&-of_moment);
    // mc × A = −[A]× mc.
    x.fixed_view_mut::<3, 3>(3, 1).copy_from(&at_origin.cross_matrix());
    for (k, (i, j)) in ENTRIES.into_iter().enumerate() {
        let mut entry = Matrix3::zeros();
        entry[(i, j)] = 1.0;
        entry[(j, i)] = 1.0;
        let turned = entry * products;
        // ω × (E ω), of the products.
        let gyroscopic = Vector3::new(
            turned[(2, 1)] - turned[(1, 2)],
            turned[(0, 2)] - turned[(2, 0)],
            turned[(1, 0)] - turned[(0, 1)],
        );
        x.fixed_view_mut::<3, 1>(3, 4 + k).copy_from(&-(entry * faster + gyroscopic));
    }
    x.fixed_view_mut::<6, 6>(0, 10).fill_with_identity();
    x
}

#[cfg(test)]
mod tests {
    use fingertip_test_support::MovingBody;
    use nalgebra::{Matrix3, Vector3};

    use super::*;

    /// Against heavy points that go their way through the world.
    #[test]
    fn the_load_is_that_of_heavy_points() {
        let body = MovingBody::swung();
        let (mass, centre, inertia) = body.mass_properties();
        let about_origin =
            inertia + (Matrix3::identity() * centre.norm_squared() - centre * centre.transpose()) * mass;
        let bias = [0.3, -0.2, 0.1, 0.01, 0.02, -0.03];
        let mut parameters = Parameters::zeros();
        parameters[0] = mass;
        parameters.fixed_rows_mut::<3>(1).copy_from(&(centre * mass));
        for (k, (i, j)) in ENTRIES.into_iter().enumerate() {
            parameters[4 + k] = about_origin[(i, j)];
        }
        parameters.fixed_rows_mut::<6>(10).copy_from_slice(&bias);
        for k in 0..40 {
            let time = 0.13 * f64::from(k);
            let (moved, step) = (body.at(time), 1e-4);
            let rate = |steps: f64| body.at(time + steps * step).angular_velocity;
            let faster: Vector3<f64> = (rate(1.0) - rate(-1.0)) / (2.0 * step);
            let moving = Moving {
                acceleration: moved.acceleration,
                products: moved.angular_velocity * moved.angular_velocity.transpose(),
                angular_acceleration: faster,
            };
            let predicted = regressor(&moving, &body.unit) * parameters;
            let expected = moved.wrench + nalgebra::Vector6::from(bias);
            assert!((predicted - expected).amax() < 2e-5, "{time}: {predicted} {expected}");
        }
    }
}
