//! The contact that a wrench has to the last digit, in arithmetic of 220 bits: where a surface is
//! straight one way and the spin torque large, double precision is not enough.

use fingertip_surfaces::{Capsule, Cone, Cylinder, Plane, RoundedBox, SmoothSurface, Torus};
use fingertip_test_support::Worst;
use fingertip_wrench::{Real, Wrench};
use nalgebra::{Matrix4, Vector3, Vector4};

use crate::big::{Big, Big3, big3, cross, dot};

pub(crate) fn wide<T: Real>(v: &Vector3<T>) -> Big3 {
    big3(v.map(Real::to_f64).into())
}

pub(crate) fn minus(a: &Big3, b: &Big3) -> Big3 {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

pub(crate) fn times(a: &Big3, t: &Big) -> Big3 {
    [0, 1, 2].map(|k| &a[k] * t)
}

pub(crate) fn plus(a: &Big3, b: &Big3) -> Big3 {
    [0, 1, 2].map(|k| &a[k] + &b[k])
}

pub(crate) fn length(a: &Big3) -> Big {
    dot(a, a).sqrt()
}

pub(crate) fn unit(a: &Big3) -> Big3 {
    let length = length(a);
    if length.is_positive() { [0, 1, 2].map(|k| &a[k] / &length) } else { a.clone() }
}

pub(crate) fn number<T: Real>(x: T) -> Big {
    Big::new(x.to_f64())
}

/// A shape as the numbers say that it stores.
pub(crate) trait Exact {
    /// The distance from the surface, positive outside, and the outward unit normal.
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3);

    /// Whether a point of that surface, which may be larger, belongs to the shape.
    fn holds(&self, point: &Big3) -> bool {
        let _ = point;
        true
    }

    /// How far off the frame is in which it is told \[m\].
    #[allow(dead_code, reason = "the trials ask")]
    fn aside(&self) -> f64 {
        0.0
    }

    /// Where a line of action enters through a flat end, if it does: the point and the outward normal.
    #[allow(dead_code, reason = "the trials ask")]
    fn through_end(&self, force: &Big3, torque: &Big3) -> Option<[Big3; 2]> {
        let _ = (force, torque);
        None
    }

    /// The contact on an end, an edge or a tip, if the wrench has one there.
    fn elsewhere(&self, force: &Big3, torque: &Big3) -> Option<Big3> {
        let _ = (force, torque);
        None
    }
}

impl<T: Real> Exact for Plane<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let normal = unit(&wide(&self.outward()));
        (dot(&minus(point, &wide(&self.point())), &normal), normal)
    }
}

/// Height along an axis, and what is across it.
pub(crate) fn split<T: Real>(point: &Big3, origin: &Vector3<T>, axis: &Vector3<T>) -> (Big, Big3, Big3) {
    let (from_origin, axis) = (minus(point, &wide(origin)), unit(&wide(axis)));
    let height = dot(&from_origin, &axis);
    let across = minus(&from_origin, &times(&axis, &height));
    (height, across, axis)
}

impl<T: Real> Exact for Cylinder<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let (_, across, _) = split(point, &self.centre(), &self.axis());
        (&length(&across) - &number(self.radius()), unit(&across))
    }
}

impl<T: Real> Exact for Cone<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let (height, across, axis) = split(point, &self.apex(), &self.axis());
        let slope = Big::new(Real::tangent(self.half_angle().to_f64()));
        let cosine = &Big::new(1.0) / &(&Big::new(1.0) + &(&slope * &slope)).sqrt();
        let slanted = minus(&unit(&across), &times(&axis, &slope));
        (&(&length(&across) - &(&height * &slope)) * &cosine, times(&slanted, &cosine))
    }

    /// At the tip, whose normals are those that lean away from the axis by less than the side's.
    fn elsewhere(&self, force: &Big3, torque: &Big3) -> Option<Big3> {
        let (apex, axis) = (wide(&self.apex()), unit(&wide(&self.axis())));
        let rest = minus(torque, &cross(&apex, force));
        let away = if dot(force, &rest).is_positive() { dot(&rest, &axis) } else { -dot(&rest, &axis) };
        let across = minus(&rest, &times(&axis, &dot(&rest, &axis)));
        let slope = Big::new(Real::tangent(self.half_angle().to_f64()));
        (&away - &(&length(&across) * &slope)).is_positive().then_some(apex)
    }
}

impl<T: Real> Exact for Capsule<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let (height, across, axis) = split(point, &self.centre(), &self.axis());
        let half = number(self.half_length());
        let beyond = &height.abs() - &half;
        let over = if beyond.is_positive() {
            if height.is_positive() { beyond } else { -beyond }
        } else {
            Big::new(0.0)
        };
        let from_segment = plus(&across, &times(&axis, &over));
        (&length(&from_segment) - &number(self.radius()), unit(&from_segment))
    }
}

impl<T: Real> Exact for RoundedBox<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let rounding = number(self.rounding());
        let outside = [0, 1, 2].map(|k| {
            let beyond = &(&point[k].abs() - &number(self.half_extents()[k])) + &rounding;
            let beyond = if beyond.is_positive() { beyond } else { Big::new(0.0) };
            if point[k].is_positive() { beyond } else { -beyond }
        });
        (&length(&outside) - &rounding, unit(&outside))
    }
}

impl<T: Real> Exact for Torus<T> {
    fn height_and_normal(&self, point: &Big3) -> (Big, Big3) {
        let [x, y, z] = point;
        let radial = (&(x * x) + &(y * y)).sqrt();
        let share = &(&radial - &number(self.ring_radius())) / &radial;
        let from_ring = [x * &share, y * &share, z.clone()];
        (&length(&from_ring) - &number(self.tube_radius()), unit(&from_ring))
    }
}

/// The contact of a wrench that is near a point: residual in 220 bits, steps in 53, until they are
/// shorter than 1e-24 of the size. `smooth` is the surface, but for rounding.
pub(crate) fn contact<T: Real>(
    surface: &impl Exact,
    smooth: &impl SmoothSurface<f64>,
    wrench: &Wrench<T>,
    near: &Vector3<f64>,
    size: f64,
) -> Option<Big3> {
    let (f, m) = (wide(&wrench.force()), wide(&wrench.torque()));
    let force = wrench.force().map(Real::to_f64);
    let mut point = big3((*near).into());
    let mut spin: Option<Big> = None;
    let magnitude = force.norm();
    for taken in 0..200 {
        let (height, normal) = surface.height_and_normal(&point);
        // The torque along the force tells the spin torque to begin with.
        let known = spin.take().unwrap_or_else(|| &dot(&f, &m) / &dot(&f, &normal));
        let arm = cross(&point, &f);
        let rest = minus(&minus(&m, &arm), &times(&normal, &known));
        let place = Vector3::from_fn(|k, _| point[k].to_f64());
        let n = Vector3::from_fn(|k, _| normal[k].to_f64());
        // Lengths in units of the size, torques in those of force times size.
        let block =
            smooth.shape_operator(&place) * (known.to_f64() / magnitude) - force.cross_matrix() / magnitude;
        let mut jacobian = Matrix4::zeros();
        jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(&block);
        jacobian.fixed_view_mut::<3, 1>(0, 3).copy_from(&n);
        jacobian.fixed_view_mut::<1, 3>(3, 0).copy_from(&n.transpose());
        let unit = magnitude * size;
        let right = Vector4::new(
            rest[0].to_f64() / unit,
            rest[1].to_f64() / unit,
            rest[2].to_f64() / unit,
            -height.to_f64() / size,
        );
        let step = jacobian.lu().solve(&right)?;
        let longest = step.xyz().amax();
        // Where patches meet full steps may go to and fro.
        let most = if taken % 40 < 20 { 1.0 } else { 0.5 };
        let damping = (0.2 / longest).min(most);
        point = [0, 1, 2].map(|k| &point[k] + &Big::new(step[k] * size * damping));
        spin = Some(&known + &Big::new(step.w * unit * damping));
        if !longest.is_finite() {
            return None;
        }
        if longest < 1e-24 {
            return (f.iter().zip(&normal).map(|(a, b)| (a * b).to_f64()).sum::<f64>() < 0.0)
                .then_some(point);
        }
    }
    None
}

/// How far a point is from an exact one, by the largest coordinate.
pub(crate) fn distance<T: Real>(found: &Vector3<T>, exact: &Big3) -> f64 {
    let off = minus(&wide(found), exact);
    Worst::of(off.iter().map(|x| x.to_f64())).get()
}
