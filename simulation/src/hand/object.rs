//! What a hand holds.

use fingertip_surfaces::{CappedCylinder, RoundedBox};
use nalgebra::Vector3;

use super::body::Inertial;
use crate::error::SimulationError;

/// A rigid object: its shape, what it is made of, and the places with which it stands on a table.
///
/// Any shape that knows the [distance of a point](fingertip_surfaces::SignedDistance) will do.
///
/// ```
/// use fingertip_simulation::hand::HeldObject;
///
/// let jar = HeldObject::cylinder(0.03, 0.05, 0.2)?;
/// assert_eq!(jar.made_of.mass, 0.2);
/// // It stands on the rim of its bottom, 5 cm below its origin.
/// assert!(jar.feet.iter().all(|foot| (foot.z + 0.05).abs() < 1e-15));
/// # Ok::<(), fingertip_simulation::SimulationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct HeldObject<Shape> {
    /// Its shape, in its own frame.
    pub shape: Shape,
    /// What it is made of before anything is poured in.
    pub made_of: Inertial,
    /// The places with which it stands \[m\].
    pub feet: Vec<Vector3<f64>>,
}

fn checked<Shape>(object: HeldObject<Shape>) -> Result<HeldObject<Shape>, SimulationError> {
    if object.made_of.is_good() && object.feet.iter().flatten().all(|x| x.is_finite()) {
        Ok(object)
    } else {
        let (parameter, requirement) = ("object", "of a positive mass and inertia, with finite places");
        Err(SimulationError::BadParameter { parameter, requirement })
    }
}

impl HeldObject<CappedCylinder<f64>> {
    /// A full upright cylinder of a radius, half its height \[m\] and a mass \[kg\]; it stands on eight places of its
    /// rim.
    ///
    /// # Errors
    /// [`SimulationError`] unless all are positive and finite.
    pub fn cylinder(radius: f64, half_height: f64, mass: f64) -> Result<Self, SimulationError> {
        let shape = CappedCylinder::new(Vector3::zeros(), Vector3::z(), radius, half_height)
            .map_err(|error| SimulationError::Hand { reason: error.to_string() })?;
        let rim = |i: u8| {
            let angle = f64::from(i) * core::f64::consts::FRAC_PI_4;
            Vector3::new(radius * angle.cos(), radius * angle.sin(), -half_height)
        };
        let made_of = Inertial::cylinder(radius, half_height, mass);
        checked(Self { shape, made_of, feet: (0..8).map(rim).collect() })
    }
}

impl HeldObject<RoundedBox<f64>> {
    /// A full box of half extents and edges of a radius \[m\], and a mass \[kg\] (its inertia is that of sharp edges);
    /// it stands on the four corners of the flat of its bottom.
    ///
    /// # Errors
    /// [`SimulationError`] unless the box is one and its mass positive and finite.
    pub fn cuboid(half_extents: Vector3<f64>, rounding: f64, mass: f64) -> Result<Self, SimulationError> {
        let shape = RoundedBox::new(half_extents, rounding)
            .map_err(|error| SimulationError::Hand { reason: error.to_string() })?;
        let flat = half_extents - Vector3::new(rounding, rounding, 0.0);
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        let feet = corners.map(|(x, y)| Vector3::new(x * flat.x, y * flat.y, -flat.z)).to_vec();
        checked(Self { shape, made_of: Inertial::cuboid(&half_extents, mass), feet })
    }
}

impl<Shape> HeldObject<Shape> {
    /// Of another shape, or made of something else.
    ///
    /// # Errors
    /// [`SimulationError`] unless the mass is positive, the inertia positive definite, and all finite.
    pub fn new(shape: Shape, made_of: Inertial, feet: Vec<Vector3<f64>>) -> Result<Self, SimulationError> {
        checked(Self { shape, made_of, feet })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Vector3};

    use super::HeldObject;

    /// Objects stand on all sides: each foot is on the bottom, as far out as it may be, and they lie about the middle.
    #[test]
    fn feet_are_all_around_the_bottom() {
        let cylinder = HeldObject::cylinder(0.03, 0.05, 0.2).unwrap();
        let cuboid = HeldObject::cuboid(Vector3::new(0.02, 0.03, 0.05), 0.004, 0.2).unwrap();
        assert_eq!((cylinder.feet.len(), cuboid.feet.len()), (8, 4));
        assert!(cylinder.feet.iter().all(|foot| (foot.xy().norm() - 0.03).abs() < 1e-15));
        let is_corner =
            |foot: &Vector3<f64>| (foot.xy().abs() - Vector3::new(0.016, 0.026, 0.0).xy()).norm() < 1e-15;
        assert!(cuboid.feet.iter().all(is_corner));
        for (feet, spread) in [
            (&cylinder.feet, [4.0 * 0.03 * 0.03; 2]),
            (&cuboid.feet, [4.0 * 0.016 * 0.016, 4.0 * 0.026 * 0.026]),
        ] {
            assert!(feet.iter().all(|foot| foot.z == -0.05));
            let middle: Vector3<f64> = feet.iter().sum();
            assert!(middle.xy().norm() < 1e-15);
            let squares: Matrix3<f64> = feet.iter().map(|foot| foot * foot.transpose()).sum();
            assert!(
                (squares[(0, 0)] - spread[0]).abs() < 1e-15 && (squares[(1, 1)] - spread[1]).abs() < 1e-15
            );
            assert!(squares[(0, 1)].abs() < 1e-15);
            let apart = feet.iter().enumerate().all(|(i, a)| feet[..i].iter().all(|b| (a - b).norm() > 0.01));
            assert!(apart);
        }
    }
}
