//! Runs every routine of the hot path a thousand times, for `.ci/instructions` to count instructions
//! under callgrind. Each is a function of its own, by whose name it is found.

use core::hint::black_box;

use fingertip_benches::hand_written::{HandA, HandB};
use fingertip_benches::{Columns, paper_sensor, signals};
use fingertip_contact::{ContactModel, PointContact, SoftFinger};
use fingertip_friction::{
    Coulomb, DropDetector, ForceNoise, FrictionModel, LikelihoodRatioDetector, NormalForceGate, PowerLimit,
    RatioThreshold, SlipDetector, SoftFingerLimit,
};
use fingertip_hand::Hand;
use fingertip_scenes::{Felt, Grips, Scene, SceneA, SceneB, SceneC, SceneD, Volts};
use fingertip_surfaces::{
    CappedCylinder, Capsule, Cone, Cylinder, Ellipsoid, Frustum, Plane, Posed, RoundedBox, Sphere,
    Superquadric, Torus,
};
use fingertip_wrench::{
    BicchiDario, ContactForce, Decoupled, GaussianElimination, Inverse, LeastSquares, Refined,
    RigidTransform, SensorMatrix, Wrench, WrenchSolver,
};
use nalgebra::{Vector3, Vector6};

const CALLS: usize = 1000;

/// Defines a function that calls one routine, and calls it.
macro_rules! count {
    ($name:ident, $state:expr, $kind:ty, $inputs:expr, |$this:ident, $input:ident: $input_kind:ty| $call:expr) => {{
        #[inline(never)]
        fn $name($this: &mut $kind, $input: &$input_kind) {
            black_box($call);
        }
        let mut state: $kind = $state;
        for input in $inputs.iter().cycle().take(CALLS) {
            $name(black_box(&mut state), black_box(input));
        }
    }};
}

type Failure = Box<dyn core::error::Error>;

fn solvers() -> Result<(), Failure> {
    let paper: SensorMatrix<f64, 6> = paper_sensor()?;
    let narrow: SensorMatrix<f32, 6> = paper_sensor()?;
    let eight = SceneC::sensor().ok_or("no sensor")?;
    let (wide, volts) = ([signals::<f64>()], [signals::<f32>()]);
    let redundant = [Volts::<8>::from_fn(|gauge, _| volts[0][gauge % 6])];
    count!(gauss_f64, GaussianElimination::new(&paper)?, GaussianElimination<f64>, wide, |s,
                                                                                          v: Vector6<
        f64,
    >| s.solve(v));
    count!(gauss_f32, GaussianElimination::new(&narrow)?, GaussianElimination<f32>, volts, |s,
                                                                                            v: Vector6<
        f32,
    >| s.solve(v));
    count!(refined_f64, Refined::new(&paper)?, Refined<f64>, wide, |s, v: Vector6<f64>| s.solve(v));
    count!(inverse_f32, Inverse::new(&narrow)?, Inverse<f32>, volts, |s, v: Vector6<f32>| s.solve(v));
    count!(decoupled_f32, Decoupled::new(&narrow)?, Decoupled<f32, BicchiDario, 6>, volts, |s, v: Vector6<f32>| s.solve(v));
    count!(least_squares_f32, LeastSquares::new(&eight)?, LeastSquares<f32, 8>, redundant, |s, v: Volts<8>| s.solve(v));
    Ok(())
}

/// Pushes of 2 N straight and askew into a shape that encloses the origin or lies below it.
fn pushes() -> Vec<Wrench<f32>> {
    let targets = [(0.3, 0.2, 1.0), (-0.4, 0.5, 0.9), (0.1, -0.6, 1.2), (0.5, 0.4, 0.8)];
    targets
        .map(|(x, y, z)| {
            let from = Vector3::<f32>::new(x, y, z);
            let through = Vector3::new(y, z, x) * 1e-3;
            Wrench::from_force_at(&through, from * -(2.0 / from.norm()))
        })
        .to_vec()
}

/// The same with a spin torque of a tenth of a millimetre times the force.
fn twists() -> Vec<Wrench<f32>> {
    let twisted =
        |push: &Wrench<f32>| Wrench::on_fingertip(push.force(), push.torque() + push.force() * 1e-4);
    pushes().iter().map(twisted).collect()
}

/// Touches of a ring of 10 mm and tube of 3.5 mm, with as much spin torque.
fn ring_touches() -> Vec<Wrench<f32>> {
    let touch = |around: f32, across: f32, aside: [f32; 3]| {
        let outward = Vector3::new(around.cos(), around.sin(), 0.0);
        let normal = outward * across.cos() + Vector3::z() * across.sin();
        let (point, force) = (outward * 0.01 + normal * 0.0035, Vector3::from(aside) - normal * 2.0);
        Wrench::on_fingertip(force, point.cross(&force) + normal * 2e-4)
    };
    vec![
        touch(0.3, 0.2, [0.4, 0.1, -0.3]),
        touch(2.0, 1.4, [-0.2, 0.5, 0.1]),
        touch(4.1, -0.8, [0.3, 0.3, 0.2]),
        touch(5.5, 2.5, [-0.5, -0.1, 0.4]),
    ]
}

fn contacts() -> Result<(), Failure> {
    let (wrenches, twists, ring_touches) = (pushes(), twists(), ring_touches());
    let (point, soft) = (PointContact::new(0.1_f32)?, SoftFinger::new(0.1_f32)?);
    macro_rules! shapes {
        ($wrenches:ident; $($name:ident: $kind:ty, $model:ident = $shape:expr;)*) => { $(
            count!($name, ($shape, $model), $kind, $wrenches, |s, w: Wrench<f32>| s.1.resolve(w, &s.0));
        )* };
    }
    let (centre, up) = (Vector3::zeros(), Vector3::z());
    let axes = Vector3::new(0.014, 0.011, 0.009);
    shapes! { wrenches;
        point_on_sphere: (Sphere<f32>, PointContact<f32>), point = Sphere::centred(0.013)?;
        point_on_ellipsoid: (Ellipsoid<f32>, PointContact<f32>), point = Ellipsoid::new(axes)?;
        point_on_cylinder: (Cylinder<f32>, PointContact<f32>), point = Cylinder::new(centre, Vector3::x(), 0.009)?;
        point_on_plane: (Plane<f32>, PointContact<f32>), point = Plane::new(centre, up)?;
        point_on_capsule: (Capsule<f32>, PointContact<f32>), point = Capsule::new(centre, up, 0.009, 0.004)?;
        point_on_cone: (Cone<f32>, PointContact<f32>), point = Cone::new(Vector3::new(0.0, 0.0, 0.02), -up, 0.6)?;
        point_on_torus: (Torus<f32>, PointContact<f32>), point = Torus::new(0.01, 0.0035)?;
        point_on_capped_cylinder: (CappedCylinder<f32>, PointContact<f32>), point = CappedCylinder::new(centre, up, 0.009, 0.012)?;
        point_on_frustum: (Frustum<f32>, PointContact<f32>), point = Frustum::new(up * -0.012, up, 0.012, 0.005, 0.024)?;
        point_on_rounded_box: (RoundedBox<f32>, PointContact<f32>), point = RoundedBox::new(axes, 0.004)?;
        point_on_superquadric: (Superquadric<f32>, PointContact<f32>), point = Superquadric::new(axes, [0.7, 0.8])?;
        soft_on_sphere: (Sphere<f32>, SoftFinger<f32>), soft = Sphere::centred(0.013)?;
        soft_on_ellipsoid: (Ellipsoid<f32>, SoftFinger<f32>), soft = Ellipsoid::new(axes)?;
        soft_on_superquadric: (Superquadric<f32>, SoftFinger<f32>), soft = Superquadric::new(axes, [0.7, 0.8])?;
    }
    shapes! { twists;
        soft_on_cylinder: (Cylinder<f32>, SoftFinger<f32>), soft = Cylinder::new(centre, Vector3::x(), 0.009)?;
        soft_on_capsule: (Capsule<f32>, SoftFinger<f32>), soft = Capsule::new(centre, up, 0.009, 0.004)?;
        soft_on_capped_cylinder: (CappedCylinder<f32>, SoftFinger<f32>), soft = CappedCylinder::new(centre, up, 0.009, 0.012)?;
        soft_on_frustum: (Frustum<f32>, SoftFinger<f32>), soft = Frustum::new(up * -0.012, up, 0.012, 0.005, 0.024)?;
        soft_on_rounded_box: (RoundedBox<f32>, SoftFinger<f32>), soft = RoundedBox::new(axes, 0.004)?;
        soft_on_cone: (Cone<f32>, SoftFinger<f32>), soft = Cone::new(Vector3::new(0.0, 0.0, 0.02), -up, 0.6)?;
    }
    shapes! { ring_touches;
        soft_on_torus: (Torus<f32>, SoftFinger<f32>), soft = Torus::new(0.01, 0.0035)?;
    }
    Ok(())
}

/// Each of 64 wrenches. Where the compiler makes no vectors they take six times as many instructions.
fn columns() -> Result<(), Failure> {
    let (wrenches, twists, soft) = (pushes(), twists(), SoftFinger::new(0.1)?);
    let (centre, up, axes) = (Vector3::zeros(), Vector3::z(), Vector3::new(0.014, 0.011, 0.009));
    let (cone, capsule) =
        (Cone::new(Vector3::new(0.0, 0.0, 0.02), -up, 0.6)?, Capsule::new(centre, up, 0.009, 0.004)?);
    let place = RigidTransform::translation(Vector3::new(1e-3, 0.0, 0.0));
    macro_rules! columns {
        ($($name:ident: $kind:ty, $wrenches:ident = $shape:expr, |$state:ident| $call:expr;)*) => { $(
            count!(
                $name,
                ($shape, soft, Columns::new($wrenches.iter().cycle().take(64).copied())),
                ($kind, SoftFinger<f32>, Columns<f32>),
                [()],
                |$state, _none: ()| $call
            );
        )* };
    }
    columns! {
        point_column_on_cone: Cone<f32>, wrenches = cone, |s| s.2.point_contacts(&s.0);
        point_column_on_frustum: Frustum<f32>, wrenches = Frustum::new(up * -0.012, up, 0.012, 0.005, 0.024)?, |s| s.2.point_contacts(&s.0);
        soft_column_on_sphere: Sphere<f32>, wrenches = Sphere::centred(0.013)?, |s| s.2.soft_contacts(&s.1, &s.0);
        soft_column_on_plane: Plane<f32>, wrenches = Plane::new(centre, up)?, |s| s.2.soft_contacts(&s.1, &s.0);
        soft_column_on_cylinder: Cylinder<f32>, twists = Cylinder::new(centre, Vector3::x(), 0.009)?, |s| s.2.soft_contacts(&s.1, &s.0);
        soft_column_on_cone: Cone<f32>, twists = cone, |s| s.2.soft_contacts(&s.1, &s.0);
        soft_column_on_frustum: Frustum<f32>, twists = Frustum::new(up * -0.012, up, 0.012, 0.005, 0.024)?, |s| s.2.soft_contacts(&s.1, &s.0);
        soft_column_on_rounded_box: RoundedBox<f32>, twists = RoundedBox::new(axes, 0.003)?, |s| s.2.soft_contacts(&s.1, &s.0);
        soft_column_on_posed_capsule: Posed<f32, Capsule<f32>>, twists = Posed::new(capsule, place), |s| s.2.soft_contacts(&s.1, &s.0);
    }
    Ok(())
}

fn friction() -> Result<(), Failure> {
    let forces = [0.0_f32, 0.01, -0.02, 0.015, -0.005].map(|noise| {
        ContactForce::new(4.0 + noise, Vector3::new(1.2 - noise, 0.9 + noise, 1e-3 * noise), 1e-3)
    });
    let noise = ForceNoise::isotropic(0.02_f32)?;
    let gate = NormalForceGate::from_noise(&noise);
    count!(coulomb, Coulomb::new(0.6)?, Coulomb<f32>, forces, |s, f: ContactForce<f32>| s.slip_margin(f));
    count!(ellipse, SoftFingerLimit::new(0.6, 3e-3)?, SoftFingerLimit<f32>, forces, |s,
                                                                                     f: ContactForce<
        f32,
    >| s.slip_margin(f));
    count!(power_limit, PowerLimit::new(0.6, 3e-3, 1.72)?, PowerLimit<f32>, forces, |s,
                                                                                     f: ContactForce<
        f32,
    >| s.slip_margin(f));
    count!(
        ratio_threshold,
        RatioThreshold::new(gate, 0.6)?.with_warning_share(0.75)?,
        RatioThreshold<f32>,
        forces,
        |s, f: ContactForce<f32>| s.update(f, 1e-3)
    );
    count!(drop_detector, DropDetector::new(noise)?, DropDetector<f32>, forces, |s, f: ContactForce<f32>| s
        .update(f, 1e-3));
    count!(
        likelihood_ratio,
        LikelihoodRatioDetector::new(noise, 1.0, 1000.0)?,
        LikelihoodRatioDetector<f32, 16>,
        forces,
        |s, f: ContactForce<f32>| s.update(f, 1e-3)
    );
    Ok(())
}

/// The samples of a session that are in contact.
fn pressing<S: Scene<N>, const N: usize>() -> Vec<Volts<N>> {
    let session = S::session();
    session.iter().skip(60).take(session.len() - 90).map(|sums| S::volts(sums)).collect()
}

/// A yardstick that does something else is none: both shall feel the same, but for the rounding of a few
/// dozen operations at the condition number 5 of the sensors and the flattest angle of the sessions.
fn same(pipeline: &Felt, hand: &Felt) -> Result<(), Failure> {
    let tolerance = 1024.0 * f32::EPSILON;
    let close =
        |a: &[f32], b: &[f32], size: f32| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= size * tolerance);
    let force = pipeline.normal_force + pipeline.margin.abs();
    let all = (pipeline.contact, pipeline.slip) == (hand.contact, hand.slip)
        && close(&pipeline.point, &hand.point, 14e-3)
        && close(&pipeline.tangential_force, &hand.tangential_force, force)
        && close(&[pipeline.normal_force, pipeline.margin], &[hand.normal_force, hand.margin], force)
        && close(&[pipeline.spin_torque], &[hand.spin_torque], force * 14e-3)
        && close(&[pipeline.utilisation], &[hand.utilisation], 1.0);
    if all { Ok(()) } else { Err(format!("{hand:?} by hand, but {pipeline:?}").into()) }
}

fn scenes() -> Result<(), Failure> {
    let none = "a scene cannot be built";
    let (mut scene_a, hand_a) = (SceneA::new().ok_or(none)?, HandA::new().ok_or(none)?);
    for volts in pressing::<SceneA, 6>() {
        same(&scene_a.sense(&volts), &hand_a.sense(volts.as_ref()))?;
    }
    let (mut scene_b, hand_b) = (SceneB::new().ok_or(none)?, HandB::new().ok_or(none)?);
    for volts in pressing::<SceneB, 6>() {
        same(&scene_b.sense(&volts), &hand_b.sense(volts.as_ref()))?;
    }
    count!(scene_a, SceneA::new().ok_or(none)?, SceneA, pressing::<SceneA, 6>(), |s, v: Volts<6>| s.sense(v));
    count!(scene_b, SceneB::new().ok_or(none)?, SceneB, pressing::<SceneB, 6>(), |s, v: Volts<6>| s.sense(v));
    count!(scene_c, SceneC::new().ok_or(none)?, SceneC, pressing::<SceneC, 8>(), |s, v: Volts<8>| s.sense(v));
    count!(scene_d, SceneD::new().ok_or(none)?, SceneD, pressing::<SceneD, 8>(), |s, v: Volts<8>| s.sense(v));
    count!(hand_a, HandA::new().ok_or(none)?, HandA, pressing::<SceneA, 6>(), |s, v: Volts<6>| s
        .sense(v.as_ref()));
    count!(hand_b, HandB::new().ok_or(none)?, HandB, pressing::<SceneB, 6>(), |s, v: Volts<6>| s
        .sense(v.as_ref()));
    Ok(())
}

/// The least grip of five soft fingers, from nothing and from the sample before, with what it takes to read the grasp.
fn grips() -> Result<(), Failure> {
    let none = "a grasp cannot be built";
    macro_rules! each {
        ($($name:ident: $scalar:ty, $start:ident;)*) => { $(
            let mut loads = Grips::<$scalar>::new().ok_or(none)?;
            let loads: Vec<_> = (0..CALLS).map(|_| loads.next_load()).collect();
            count!($name, Grips::<$scalar>::new().ok_or(none)?, Grips<$scalar>, loads, |s, w: Wrench<$scalar, Hand>| s.$start(w));
        )* };
    }
    each! {
        least_grip_cold_f64: f64, cold;
        least_grip_warm_f64: f64, warm;
        least_grip_cold_f32: f32, cold;
        least_grip_warm_f32: f32, warm;
    }
    Ok(())
}

fn main() -> Result<(), Failure> {
    solvers()?;
    contacts()?;
    columns()?;
    friction()?;
    grips()?;
    scenes()
}
