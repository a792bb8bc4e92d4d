//! Shapes as level functions in 220 bits: about the signed distance in metres, negative inside.
//! None of the crates' arithmetic is in here.

use nalgebra::Vector3;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::big::{Big, Big3, big3, dot};

/// A shape about the origin, with its axis along z; lengths as the shape under test has them.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Level {
    Plane,
    Sphere {
        radius: f64,
    },
    Ellipsoid {
        semi_axes: [f64; 3],
    },
    Cylinder {
        radius: f64,
    },
    Capsule {
        half_length: f64,
        radius: f64,
    },
    /// Apex at the origin, opening along −z.
    Cone {
        half_angle: f64,
    },
    Torus {
        ring: f64,
        tube: f64,
    },
    Superquadric {
        semi_axes: [f64; 3],
        exponents: [f64; 2],
    },
}

fn square(x: &Big) -> Big {
    x * x
}

fn hypotenuse(x: &Big, y: &Big) -> Big {
    (&square(x) + &square(y)).sqrt()
}

/// Sine and cosine by their series, for an angle below 2.
fn sine_cosine(angle: f64) -> (Big, Big) {
    let x = Big::new(angle);
    let (mut sine, mut cosine, mut term) = (Big::new(0.0), Big::new(0.0), Big::new(1.0));
    for k in 0..80_u32 {
        let signed = if k % 4 < 2 { term.clone() } else { -term.clone() };
        if k % 2 == 0 {
            cosine = &cosine + &signed;
        } else {
            sine = &sine + &signed;
        }
        term = &(&term * &x) / &Big::new(f64::from(k + 1));
    }
    (sine, cosine)
}

/// Uniform on the unit sphere.
pub(crate) fn direction(random: &mut Pcg64Mcg) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
        if v.norm() <= 1.0 && v.norm() > 0.1 {
            return v.normalize();
        }
    }
}

impl Level {
    /// Greatest extent of the part that is used \[m\].
    pub(crate) fn size(&self, scale: f64) -> f64 {
        match *self {
            Self::Sphere { radius } => 2.0 * radius,
            Self::Ellipsoid { semi_axes } | Self::Superquadric { semi_axes, .. } => {
                2.0 * semi_axes.into_iter().fold(0.0, f64::max)
            }
            Self::Cylinder { radius } => 4.0 * radius,
            Self::Capsule { half_length, radius } => 2.0 * (half_length + radius),
            Self::Torus { ring, tube } => 2.0 * (ring + tube),
            Self::Plane | Self::Cone { .. } => 2.0 * scale,
        }
    }

    pub(crate) fn value(&self, p: &Big3) -> Big {
        let [x, y, z] = p;
        let new = Big::new;
        match *self {
            Self::Plane => z.clone(),
            Self::Sphere { radius } => &dot(p, p).sqrt() - &new(radius),
            Self::Ellipsoid { semi_axes } => {
                let q = [0, 1, 2].map(|k| &p[k] / &new(semi_axes[k]));
                let gauge = dot(&q, &q).sqrt();
                &(&gauge - &new(1.0)) * &new(semi_axes.into_iter().fold(f64::INFINITY, f64::min))
            }
            Self::Cylinder { radius } => &hypotenuse(x, y) - &new(radius),
            Self::Capsule { half_length, radius } => {
                let half = new(half_length);
                let beyond = &z.abs() - &half;
                let along = if beyond.is_positive() { beyond } else { new(0.0) };
                &(&(&square(x) + &square(y)) + &square(&along)).sqrt() - &new(radius)
            }
            Self::Cone { half_angle } => {
                let (sine, cosine) = sine_cosine(half_angle);
                &(&hypotenuse(x, y) * &cosine) + &(z * &sine)
            }
            Self::Torus { ring, tube } => &hypotenuse(&(&hypotenuse(x, y) - &new(ring)), z) - &new(tube),
            Self::Superquadric { semi_axes, exponents: [e1, e2] } => {
                let two = new(2.0);
                let (e1, e2) = (new(e1), new(e2));
                let q = [0, 1, 2].map(|k| (&p[k] / &new(semi_axes[k])).abs());
                let plane = &q[0].powf(&(&two / &e2)) + &q[1].powf(&(&two / &e2));
                let sum = &plane.powf(&(&e2 / &e1)) + &q[2].powf(&(&two / &e1));
                let gauge = sum.powf(&(&e1 / &two));
                &(&gauge - &new(1.0)) * &new(semi_axes.into_iter().fold(f64::INFINITY, f64::min))
            }
        }
    }

    /// The gradient by central differences, which 220 bits make exact to some 35 digits.
    pub(crate) fn gradient(&self, p: &Big3, size: f64) -> Big3 {
        let h = &Big::new(size) * &Big::new(2.0_f64.powi(-60));
        let two_h = &h + &h;
        [0, 1, 2].map(|k| {
            let moved = |by: &Big| {
                let mut q = p.clone();
                q[k] = &q[k] + by;
                self.value(&q)
            };
            &(&moved(&h) - &moved(&-h.clone())) / &two_h
        })
    }

    /// The outward unit normal.
    pub(crate) fn normal(&self, p: &Big3, size: f64) -> Big3 {
        let gradient = self.gradient(p, size);
        let length = dot(&gradient, &gradient).sqrt();
        gradient.map(|x| &x / &length)
    }

    /// Distance from the surface, to first order.
    pub(crate) fn distance(&self, p: &Big3, size: f64) -> f64 {
        let gradient = self.gradient(p, size);
        (&self.value(p) / &dot(&gradient, &gradient).sqrt()).to_f64()
    }

    /// A point on the surface, but for rounding, and its outward normal.
    pub(crate) fn sample(&self, random: &mut Pcg64Mcg, scale: f64) -> (Vector3<f64>, Vector3<f64>) {
        let n = direction(random);
        let turn = |x: f64, z: f64| {
            let across = Vector3::new(n.x, n.y, 0.0).normalize();
            Vector3::new(across.x * x, across.y * x, z)
        };
        let point = match *self {
            Self::Plane => Vector3::new(n.x, n.y, 0.0) * scale,
            Self::Sphere { radius } => n * radius,
            Self::Ellipsoid { semi_axes } => Vector3::from_fn(|k, _| n[k] * semi_axes[k]),
            Self::Cylinder { radius } => turn(radius, n.z * 2.0 * radius),
            Self::Capsule { half_length, radius } if random.random_bool(0.5) => {
                n * radius + Vector3::z() * half_length.copysign(n.z)
            }
            Self::Capsule { half_length, radius } => turn(radius, n.z * half_length),
            Self::Cone { half_angle } => {
                let depth = scale * random.random_range(0.2..1.0);
                turn(depth * half_angle.tan(), -depth)
            }
            Self::Torus { ring, tube } => {
                let (sine, cosine) = random.random_range(0.0..core::f64::consts::TAU).sin_cos();
                turn(ring + tube * cosine, tube * sine)
            }
            Self::Superquadric { semi_axes, exponents: [e1, e2] } => {
                // Homogeneous, so that a direction is divided by its gauge. Away from the edges,
                // where powers of tiny numbers would make the second derivatives of the shape huge.
                let q = n.map(|x| x.abs().max(0.05).copysign(x));
                let plane = q.x.abs().powf(2.0 / e2) + q.y.abs().powf(2.0 / e2);
                let gauge = (plane.powf(e2 / e1) + q.z.abs().powf(2.0 / e1)).powf(e1 / 2.0);
                Vector3::from_fn(|k, _| q[k] / gauge * semi_axes[k])
            }
        };
        let normal = self.normal(&big3(point.into()), self.size(scale)).map(|x| x.to_f64());
        (point, Vector3::from(normal))
    }
}
