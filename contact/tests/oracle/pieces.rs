//! Point contacts on shapes that are put together of pieces of quadrics, against the quadric of the
//! piece that is touched.

use fingertip_surfaces::*;
use fingertip_wrench::Real;
use nalgebra::Vector3;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use crate::big::{Big, big3};
use crate::quadrics::{Case, Quadric, accurate, direction, rounded};

fn square(x: f64) -> Big {
    &Big::new(x) * &Big::new(x)
}

/// Below the plane `normal·x = level`.
fn below(normal: [f64; 3], level: f64) -> Quadric {
    Quadric { d: big3([0.0; 3]), xy: Big::new(0.0), e: big3(normal), s: Big::new(-2.0 * level) }
}

/// Within a radius of a centre, along the axes that count.
fn round(axes: [f64; 3], centre: [f64; 3], radius: f64) -> Quadric {
    let e = [0, 1, 2].map(|k| Big::new(-centre[k] * axes[k]));
    let squared = [0, 1, 2].map(|k| &square(centre[k]) * &Big::new(axes[k]));
    let s = &(&(&squared[0] + &squared[1]) + &squared[2]) - &square(radius);
    Quadric { d: big3(axes), xy: Big::new(0.0), e, s }
}

/// `x² + y² ≤ k²·(z − apex)²`, with `k = radius/depth` at `z = apex + depth`.
fn cone(radius: f64, depth: f64, apex: Big) -> Quadric {
    let slope = &square(radius) / &square(depth);
    let e = [Big::new(0.0), Big::new(0.0), &slope * &apex];
    let s = -(&slope * &(&apex * &apex));
    Quadric { d: [Big::new(1.0), Big::new(1.0), -slope], xy: Big::new(0.0), e, s }
}

fn around(random: &mut Pcg64Mcg) -> Vector3<f64> {
    let angle: f64 = random.random_range(0.0..core::f64::consts::TAU);
    Vector3::new(angle.cos(), angle.sin(), 0.0)
}

fn up<T: Real>(z: f64) -> Vector3<T> {
    Vector3::new(T::zero(), T::zero(), T::literal(z))
}

/// A point on a flat end, well within its rim.
fn on_end(random: &mut Pcg64Mcg, radius: f64, z: f64) -> (Vector3<f64>, Vector3<f64>, Quadric) {
    let point = around(random) * (radius * random.random_range(0.0..0.99)) + Vector3::z() * z;
    let normal = Vector3::z() * z.signum();
    (point, normal, below(normal.into(), z.abs()))
}

fn capped_cylinder<T: Real>() -> impl FnMut(&mut Pcg64Mcg, f64) -> Case<CappedCylinder<T>> {
    |random, scale| {
        let (r, half) = (rounded::<T>(scale), rounded::<T>(scale * random.random_range(0.2..2.0)));
        let (point, normal, quadric) = match random.random_range(0..3) {
            0 => on_end(random, r, half),
            1 => on_end(random, r, -half),
            _ => {
                let n = around(random);
                let z = half * random.random_range(-0.99..0.99);
                (n * r + Vector3::z() * z, n, round([1.0, 1.0, 0.0], [0.0; 3], r))
            }
        };
        let surface =
            CappedCylinder::new(Vector3::zeros(), Vector3::z(), T::literal(r), T::literal(half)).unwrap();
        Case { surface, quadric, point, normal, size: 2.0 * r.max(half) }
    }
}

fn capsule<T: Real>() -> impl FnMut(&mut Pcg64Mcg, f64) -> Case<Capsule<T>> {
    |random, scale| {
        let (r, half) = (rounded::<T>(scale), rounded::<T>(scale * random.random_range(0.2..2.0)));
        let (point, normal, quadric) = if random.random_bool(0.5) {
            let n = direction(random);
            let z = half.copysign(n.z);
            (n * r + Vector3::z() * z, n, round([1.0; 3], [0.0, 0.0, z], r))
        } else {
            let n = around(random);
            let z = half * random.random_range(-0.99..0.99);
            (n * r + Vector3::z() * z, n, round([1.0, 1.0, 0.0], [0.0; 3], r))
        };
        let surface = Capsule::new(Vector3::zeros(), Vector3::z(), T::literal(r), T::literal(half)).unwrap();
        Case { surface, quadric, point, normal, size: 2.0 * (r + half) }
    }
}

/// Its base centred at the origin.
fn frustum<T: Real>(least_ratio: f64) -> impl FnMut(&mut Pcg64Mcg, f64) -> Case<Frustum<T>> {
    move |random, scale| {
        let base = rounded::<T>(scale);
        let height = rounded::<T>(scale * random.random_range(0.3..3.0));
        let top =
            if least_ratio > 0.0 { rounded::<T>(scale * random.random_range(least_ratio..0.9)) } else { 0.0 };
        let taper = (base - top) / height;
        let (point, normal, quadric) = match random.random_range(0..4) {
            0 => {
                let point = around(random) * (base * random.random_range(0.0..0.99));
                (point, -Vector3::z(), below([0.0, 0.0, -1.0], 0.0))
            }
            1 if top > 0.0 => on_end(random, top, height),
            _ => {
                let n = around(random);
                let z = height * random.random_range(0.01..0.99);
                // x² + y² = (base − taper·z)²; the apex is where that is zero.
                let shrink = &Big::new(base) - &Big::new(top);
                let apex = &(&Big::new(base) * &Big::new(height)) / &shrink;
                let mut side = cone(base, 1.0, apex.clone());
                let slope = &(&shrink * &shrink) / &square(height);
                side.d[2] = -slope.clone();
                side.e[2] = &slope * &apex;
                side.s = -(&slope * &(&apex * &apex));
                (n * (base - taper * z) + Vector3::z() * z, (n + Vector3::z() * taper).normalize(), side)
            }
        };
        let surface = Frustum::new(
            Vector3::zeros(),
            Vector3::z(),
            T::literal(base),
            T::literal(top),
            T::literal(height),
        )
        .unwrap();
        Case { surface, quadric, point, normal, size: height.max(2.0 * base) }
    }
}

/// With the apex at the origin and its side at 45°, whose tangent every type has exactly.
fn open_cone<T: Real>() -> impl FnMut(&mut Pcg64Mcg, f64) -> Case<Cone<T>> {
    |random, scale| {
        let depth = scale * random.random_range(0.01..1.0);
        let n = around(random);
        Case {
            surface: Cone::new(Vector3::zeros(), -Vector3::z(), T::frac_pi_4()).unwrap(),
            quadric: cone(1.0, 1.0, Big::new(0.0)),
            point: n * depth - Vector3::z() * depth,
            normal: (n + Vector3::z()).normalize(),
            size: 2.0 * scale,
        }
    }
}

fn elliptic_cylinder<T: Real>() -> impl FnMut(&mut Pcg64Mcg, f64) -> Case<EllipticCylinder<T>> {
    |random, scale| {
        let [a, b] = [rounded::<T>(scale), rounded::<T>(scale * random.random_range(0.3..3.0))];
        let half = rounded::<T>(scale * random.random_range(0.3..2.0));
        let (point, normal, quadric) = if random.random_bool(0.3) {
            on_end(random, a.min(b), half)
        } else {
            let n = around(random);
            let d = [&Big::new(1.0) / &square(a), &Big::new(1.0) / &square(b), Big::new(0.0)];
            let side = Quadric { d, xy: Big::new(0.0), e: big3([0.0; 3]), s: Big::new(-1.0) };
            let z = half * random.random_range(-0.99..0.99);
            (Vector3::new(n.x * a, n.y * b, z), Vector3::new(n.x / a, n.y / b, 0.0).normalize(), side)
        };
        let ends = CylinderEnds::Capped(T::literal(half));
        let surface = EllipticCylinder::new([T::literal(a), T::literal(b)], ends).unwrap();
        Case { surface, quadric, point, normal, size: 2.0 * a.max(b).max(half) }
    }
}

/// Touched on a face, an edge or a corner.
fn rounded_box<T: Real>() -> impl FnMut(&mut Pcg64Mcg, f64) -> Case<RoundedBox<T>> {
    |random, scale| {
        let rounding = rounded::<T>(scale * 0.25);
        // Sums that the type has exactly.
        let core = [0; 3].map(|_| rounding * f64::from(random.random_range(2_u8..5)));
        let half = core.map(|x| x + rounding);
        let mut n = direction(random);
        let flat = [0, 1, 2].map(|_| random.random_bool(0.5));
        for k in 0..3 {
            if flat[k] {
                n[k] = 0.0;
            }
        }
        if n.norm() < 0.1 {
            n = Vector3::x();
        }
        let n = n.normalize();
        let counts = [0, 1, 2].map(|k| if n[k] == 0.0 { 0.0 } else { 1.0 });
        let nearest = [0, 1, 2].map(|k| core[k].copysign(n[k]) * counts[k]);
        let point = Vector3::from_fn(|k, _| {
            if counts[k] == 0.0 {
                core[k] * random.random_range(-0.99..0.99)
            } else {
                nearest[k] + n[k] * rounding
            }
        });
        let single = counts.iter().sum::<f64>() < 1.5;
        let quadric = if single {
            let axis = n.iamax();
            below(n.into(), half[axis])
        } else {
            round(counts, nearest, rounding)
        };
        let surface = RoundedBox::new(Vector3::from(half).map(T::literal), T::literal(rounding)).unwrap();
        Case { surface, quadric, point, normal: n, size: 2.0 * half.iter().fold(0.0_f64, |a, b| a.max(*b)) }
    }
}

fn spherical_cap<T: Real>() -> impl FnMut(&mut Pcg64Mcg, f64) -> Case<SphericalCap<T>> {
    |random, scale| {
        let r = rounded::<T>(scale);
        let mut n = direction(random);
        n.z = n.z.abs().max(0.01);
        let n = n.normalize();
        let sphere = Sphere::centred(T::literal(r)).unwrap();
        Case {
            surface: SphericalCap::new(sphere, Vector3::z(), T::zero()).unwrap(),
            quadric: round([1.0; 3], [0.0; 3], r),
            point: n * r,
            normal: n,
            size: 2.0 * r,
        }
    }
}

fn flat<T: Real, S: ActiveSurface<T>>(
    make: impl Fn(Vector3<T>, T) -> S,
) -> impl FnMut(&mut Pcg64Mcg, f64) -> Case<S> {
    move |random, scale| {
        let (r, height) = (rounded::<T>(scale), rounded::<T>(scale * 0.5));
        let (point, normal, quadric) = on_end(random, r, height);
        Case { surface: make(up(height), T::literal(r)), quadric, point, normal, size: 2.0 * r }
    }
}

/// Between two points of the profile the square of the radius is linear.
fn revolution<T: Real>() -> impl FnMut(&mut Pcg64Mcg, f64) -> Case<Revolution<T, [Knot<T>; 2]>> {
    |random, scale| {
        let r0 = rounded::<T>(scale);
        let r1 = rounded::<T>(scale * random.random_range(0.2..0.9));
        let z1 = rounded::<T>(scale * random.random_range(0.5..2.0));
        let rise = (r1 - r0) * (r1 + r0) / z1;
        let z = z1 * random.random_range(0.01..0.99);
        let n = around(random);
        let exact = &(&square(r1) - &square(r0)) / &Big::new(z1);
        let half = &exact / &Big::new(-2.0);
        let points = [[T::zero(), T::literal(r0)], [T::literal(z1), T::literal(r1)]];
        let r = (r0 * r0 + rise * z).sqrt();
        Case {
            surface: Revolution::from_profile(points).unwrap(),
            quadric: Quadric {
                d: big3([1.0, 1.0, 0.0]),
                xy: Big::new(0.0),
                e: [Big::new(0.0), Big::new(0.0), half],
                s: -square(r0),
            },
            point: n * r + Vector3::z() * z,
            normal: (n * r - Vector3::z() * (rise * 0.5)).normalize(),
            size: z1.max(2.0 * r0),
        }
    }
}

/// A gently twisted patch: `z = 2·k·x·y` on four cells, `k = 1/(16·spacing)`.
fn heightfield<T: Real>() -> impl FnMut(&mut Pcg64Mcg, f64) -> Case<Heightfield<T>> {
    |random, scale| {
        let step = rounded::<T>(scale);
        let heights = (0..9).map(|k| (f64::from(k % 3) - 1.0) * (f64::from(k / 3) - 1.0) * step / 8.0);
        let corner = [T::literal(-step); 2];
        let spacing = [T::literal(step); 2];
        let (x, y) = (random.random_range(-0.99..0.99), random.random_range(-0.99..0.99));
        let k = &Big::new(1.0) / &(&Big::new(16.0) * &Big::new(step));
        Case {
            surface: Heightfield::new(corner, spacing, 3, heights.map(T::literal).collect()).unwrap(),
            quadric: Quadric {
                d: big3([0.0; 3]),
                xy: -k,
                e: [Big::new(0.0), Big::new(0.0), Big::new(0.5)],
                s: Big::new(0.0),
            },
            point: Vector3::new(x, y, x * y / 8.0) * step,
            normal: Vector3::new(-y / 8.0, -x / 8.0, 1.0).normalize(),
            size: 2.0 * step,
        }
    }
}

accurate!(capped_cylinders, capped_cylinder::<f64>(), capped_cylinder::<f32>());
accurate!(capsules, capsule::<f64>(), capsule::<f32>());
accurate!(frustums, frustum::<f64>(0.1), frustum::<f32>(0.1));
accurate!(closed_cones, frustum::<f64>(0.0), frustum::<f32>(0.0));
accurate!(open_cones, open_cone::<f64>(), open_cone::<f32>());
accurate!(elliptic_cylinders, elliptic_cylinder::<f64>(), elliptic_cylinder::<f32>());
accurate!(rounded_boxes, rounded_box::<f64>(), rounded_box::<f32>());
accurate!(spherical_caps, spherical_cap::<f64>(), spherical_cap::<f32>());
accurate!(
    disks,
    flat(|centre, r| Disk::<f64>::new(centre, Vector3::z(), r).unwrap()),
    flat(|centre, r| Disk::<f32>::new(centre, Vector3::z(), r).unwrap())
);
accurate!(
    rectangles,
    flat(|centre, r| Rectangle::<f64>::new(centre, Vector3::x() * r, Vector3::y() * r).unwrap()),
    flat(|centre, r| Rectangle::<f32>::new(centre, Vector3::x() * r, Vector3::y() * r).unwrap())
);
accurate!(revolutions, revolution::<f64>(), revolution::<f32>());
accurate!(heightfields, heightfield::<f64>(), heightfield::<f32>());
