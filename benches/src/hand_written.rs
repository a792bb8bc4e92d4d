//! The yardstick of the scenes: what one would write by hand for just this sensor, this shape and
//! this friction, in single precision, with nothing general about it.
//!
//! It keeps the contract of the pipeline: a wrench that is weak, misses, pulls or is not finite is no
//! contact. It does without the rescaling against over- and underflow, and without the care that the
//! library takes at flat incidence.

use fingertip_scenes::{Felt, Scene, SceneA, SceneB};
use fingertip_wrench::{BicchiDario, Combination, Decoupled, WrenchSolver};
use nalgebra::{Matrix6, Vector6};

type V = [f32; 3];

#[inline(always)]
pub(crate) fn dot(a: V, b: V) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(crate) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(crate) fn add(a: V, b: V, k: f32) -> V {
    [a[0] + b[0] * k, a[1] + b[1] * k, a[2] + b[2] * k]
}

/// Friction coefficient, when to warn and when to say slip, and the least forces.
#[derive(Clone, Copy, Debug)]
pub struct Friction {
    /// μ.
    pub coefficient: f32,
    /// `1/√(1 + μ²)`.
    pub cosine: f32,
    /// Ratio to warn at.
    pub warning: f32,
    /// Least normal force of which the detector makes anything \[N\].
    pub gate: f32,
    /// Reciprocal of the torque arm of the limit surface \[1/m\].
    pub inverse_arm: f32,
}

impl Friction {
    /// That of the scenes.
    #[must_use]
    pub fn of_scenes() -> Self {
        Self { coefficient: 0.6, cosine: 1.0 / 1.36_f32.sqrt(), warning: 0.45, gate: 0.2, inverse_arm: 500.0 }
    }

    #[inline(always)]
    fn judge(&self, point: V, normal: V, force: V, spin: f32) -> Felt {
        let along = dot(force, normal);
        let tangential_force = add(force, normal, -along);
        let squared = dot(tangential_force, tangential_force);
        let spinning = spin * self.inverse_arm;
        let load = (squared + spinning * spinning).sqrt();
        let felt = Felt { contact: 1, point, tangential_force, spin_torque: spin, ..Felt::default() };
        self.with(felt, -along, squared.sqrt(), load)
    }

    /// With the normal force, the tangential force's magnitude, and what both of it and the spin torque
    /// ask of friction.
    #[inline(always)]
    fn with(&self, felt: Felt, normal_force: f32, tangential: f32, load: f32) -> Felt {
        let holding = self.coefficient * normal_force;
        let slip = if normal_force <= self.gate {
            0
        } else if tangential >= holding {
            3
        } else if tangential >= self.warning * normal_force {
            2
        } else {
            1
        };
        Felt {
            normal_force,
            margin: (holding - load) * self.cosine,
            utilisation: load / holding,
            slip,
            ..felt
        }
    }
}

/// Scene A: tare, five additions, eight products, a sphere around the origin, Coulomb.
#[derive(Clone, Copy, Debug)]
pub struct HandA {
    /// Readings at rest \[V\].
    pub zero: [f32; 6],
    /// Newtons or newton metres per combined signal.
    pub diagonal: [f32; 6],
    /// What the shear forces put into the bending moments.
    pub coupling: [f32; 2],
    /// Of the sphere \[m\].
    pub radius: f32,
    /// Its reciprocal \[1/m\].
    pub curvature: f32,
    /// The square of the least force \[N²\].
    pub least_squared: f32,
    /// Friction and detector.
    pub friction: Friction,
}

/// Where a force enters the sphere, and its parts there.
#[derive(Clone, Copy, Debug)]
struct Touch {
    point: V,
    tangential_force: V,
    normal_force: f32,
    load: f32,
}

/// Column `j`: what a solver makes of a volt at gauge `j`.
fn columns(solver: &impl WrenchSolver<f32, 6>) -> Matrix6<f32> {
    let mut columns = Matrix6::zeros();
    for gauge in 0..6 {
        let mut unit = Vector6::zeros();
        unit[gauge] = 1.0;
        columns.set_column(gauge, &solver.solve(&unit).components());
    }
    columns
}

impl HandA {
    /// For the sensor and the session of scene A.
    #[must_use]
    pub fn new() -> Option<Self> {
        let solver: Decoupled<f32, BicchiDario, 6> = Decoupled::new(&SceneA::sensor()?).ok()?;
        let combination = Matrix6::from_fn(|i, j| BicchiDario::MATRIX[i][j]);
        let inverse = columns(&solver).cast::<f64>() * combination.try_inverse()?;
        #[allow(clippy::cast_possible_truncation)]
        let entry = |i: usize, j: usize| inverse[(i, j)] as f32;
        Some(Self {
            zero: (*SceneA::tare()?.zero()).into(),
            diagonal: core::array::from_fn(|i| entry(i, i)),
            coupling: [entry(4, 1), entry(5, 2)],
            radius: 13e-3,
            curvature: 1.0 / 13e-3,
            least_squared: 0.01,
            friction: Friction::of_scenes(),
        })
    }

    /// The wrench.
    #[inline(always)]
    pub(crate) fn wrench(&self, volts: &[f32; 6]) -> (V, V) {
        let v: [f32; 6] = core::array::from_fn(|i| volts[i] - self.zero[i]);
        let (odd, even) = (v[0] + v[2], v[1] + v[3]);
        let c = [odd + even, v[4] - v[0], v[1] - v[5], even - odd, v[1] - v[3], v[0] - v[2]];
        let d = &self.diagonal;
        (
            [c[0] * d[0], c[1] * d[1], c[2] * d[2]],
            [c[3] * d[3], c[4] * d[4] + c[1] * self.coupling[0], c[5] * d[5] + c[2] * self.coupling[1]],
        )
    }

    /// One sample.
    #[inline(always)]
    #[must_use]
    pub fn sense(&self, volts: &[f32; 6]) -> Felt {
        let (f, m) = self.wrench(volts);
        let squared = dot(f, f);
        let Some(touch) = self.touch(f, m, squared) else { return Felt::default() };
        let Touch { point, tangential_force, normal_force, load } = touch;
        let felt = Felt { contact: 1, point, tangential_force, ..Felt::default() };
        self.friction.with(felt, normal_force, load, load)
    }

    /// In radii the foot of the line is the sine of incidence: both parts of the force follow from it.
    #[inline(always)]
    fn touch(&self, f: V, m: V, squared: f32) -> Option<Touch> {
        let inverse = 1.0 / squared;
        let scale = inverse * self.curvature;
        let foot = cross(f, m).map(|x| x * scale);
        let sine_squared = dot(foot, foot);
        let cosine_squared = 1.0 - sine_squared;
        // A NaN fails both.
        if !(squared >= self.least_squared && cosine_squared > 0.0) {
            return None;
        }
        let back = (cosine_squared * inverse).sqrt();
        let normal = add(foot, f, -back);
        let normal_force = squared * back;
        Some(Touch {
            point: normal.map(|x| x * self.radius),
            tangential_force: add(f, normal, normal_force),
            normal_force,
            load: (squared * sine_squared).sqrt(),
        })
    }
}

/// Scene B: tare, triangular factors, an ellipsoid around the origin, soft finger, limit surface.
#[derive(Clone, Copy, Debug)]
pub struct HandB {
    /// Readings at rest \[V\].
    pub zero: [f32; 6],
    /// Which gauge each row of the factors belongs to.
    pub order: [usize; 6],
    /// The factor below the diagonal, whose diagonal is 1.
    pub lower: [[f32; 6]; 6],
    /// The factor above it \[V/N, V/(N·m)\].
    pub upper: [[f32; 6]; 6],
    /// Reciprocals of its diagonal.
    pub pivots: [f32; 6],
    /// Semi-axes \[m\].
    pub semi_axes: V,
    /// Their reciprocals \[1/m\].
    pub reciprocals: V,
    /// The square of the least force \[N²\].
    pub least_squared: f32,
    /// Friction and detector.
    pub friction: Friction,
}

impl HandB {
    /// For the sensor and the session of scene B.
    #[must_use]
    pub fn new() -> Option<Self> {
        let semi_axes = [14e-3, 11e-3, 9e-3];
        let sensor = SceneB::sensor()?;
        let per_load = Matrix6::from_diagonal(&sensor.nominal().map(|x| 1.0 / x));
        let (permutation, lower, upper) = (sensor.normalised() * per_load).lu().unpack();
        let mut rows = Vector6::from_fn(|gauge, _| gauge);
        permutation.permute_rows(&mut rows);
        let order: [usize; 6] = rows.into();
        Some(Self {
            zero: (*SceneB::tare()?.zero()).into(),
            order,
            lower: lower.transpose().data.0,
            upper: upper.transpose().data.0,
            pivots: upper.diagonal().map(|x| 1.0 / x).into(),
            semi_axes,
            reciprocals: semi_axes.map(|a| 1.0 / a),
            least_squared: 0.01,
            friction: Friction::of_scenes(),
        })
    }

    /// One sample.
    #[inline(always)]
    #[must_use]
    pub fn sense(&self, volts: &[f32; 6]) -> Felt {
        let mut w: [f32; 6] = self.order.map(|gauge| volts[gauge] - self.zero[gauge]);
        for i in 1..6 {
            for j in 0..i {
                w[i] -= self.lower[i][j] * w[j];
            }
        }
        for i in (0..6).rev() {
            for j in i + 1..6 {
                w[i] -= self.upper[i][j] * w[j];
            }
            w[i] *= self.pivots[i];
        }
        let (force, torque) = ([w[0], w[1], w[2]], [w[3], w[4], w[5]]);
        let force_squared = dot(force, force);
        if !(force_squared >= self.least_squared && dot(torque, torque) < 1e6) {
            return Felt::default();
        }
        let (a, b) = (self.semi_axes, self.reciprocals);
        let f = [force[0] * b[0], force[1] * b[1], force[2] * b[2]];
        let m = [torque[0] * b[1] * b[2], torque[1] * b[2] * b[0], torque[2] * b[0] * b[1]];
        let (squared, power) = (dot(f, f), dot(f, m));
        let sigma = dot(m, m) - squared;
        let root = (sigma * sigma + 4.0 * power * power).sqrt();
        let (spin, along);
        if sigma < 0.0 {
            along = -((root - sigma) * 0.5).sqrt();
            spin = power / along;
        } else if power == 0.0 {
            return Felt::default();
        } else {
            spin = -((root + sigma) * 0.5).sqrt().copysign(power);
            along = power / spin;
        }
        let inverse = 1.0 / (spin * spin + squared);
        let y = add(add(cross(f, m), m, spin), f, along).map(|x| x * inverse);
        let gradient = [y[0] * b[0], y[1] * b[1], y[2] * b[2]];
        let steepness = dot(gradient, gradient).sqrt();
        let flat = 1.0 / steepness;
        let spin_torque = spin * (a[0] * a[1] * a[2]) * steepness;
        let point = [y[0] * a[0], y[1] * a[1], y[2] * a[2]];
        self.friction.judge(point, gradient.map(|x| x * flat), force, spin_torque)
    }
}
