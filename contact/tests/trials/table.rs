//! The table of wrong, lost and false contacts, a row for each shape, model and precision.

use core::fmt::Debug;

use fingertip_contact::SoftFingerSurface;
use fingertip_surfaces::{
    CappedCylinder, Capsule, Cone, Cylinder, Ellipsoid, EllipticCylinder, Frustum, Implicit, Knot,
    Paraboloid, Plane, Posed, Revolution, RoundedBox, Sphere, Superquadric, Torus,
};
use fingertip_wrench::Real;

use crate::draw::Drawn;
use crate::exact::Exact;
use crate::more::Quartic;
use crate::try_out::{Asked, Count, draw, draw_miss};
use crate::wrenches::Random;

/// How many trials: of the short table, or as the environment says, or a million.
fn trials(short: usize, long: bool) -> usize {
    let stated = std::env::var("FINGERTIP_TRIALS").ok().and_then(|count| count.parse().ok());
    if long { stated.unwrap_or(1_000_000) } else { short }
}

/// The state from which trials are drawn, or as the environment says: a long table may be made in parts.
fn seed() -> u64 {
    std::env::var("FINGERTIP_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(20)
}

fn rows<T: Real, S: SoftFingerSurface<T> + Exact + Drawn + Debug>(name: &str, count: usize) -> [Count; 4] {
    let precision = if T::EPSILON.to_f64() > f64::EPSILON { "f32" } else { "f64" };
    let shown = std::env::var_os("FINGERTIP_SHOW").is_some();
    let mut counts = [Count::default(); 4];
    let mut random = Random::new(seed());
    let mut told = 0;
    let mut tell = |what: Option<&str>, trial: &dyn Debug| {
        if let Some(what) = what
            && shown
            && told < 5
        {
            told += 1;
            println!("{what}: {trial:?}");
        }
    };
    for (asked, slot) in [(Asked::Point, 0), (Asked::Soft, 1), (Asked::Edge, 3)] {
        for _ in 0..count {
            let Some(trial) = draw::<T, S>(&mut random, asked) else { break };
            let what = trial.judge(asked, &mut counts[slot]);
            tell(what, &(asked, &trial.surface, &trial.wrench, &trial.near, trial.resolve(asked)));
        }
    }
    for _ in 0..count / 10 {
        let trial = draw_miss::<T, S>(&mut random);
        if trial.is_clear() {
            let what = trial.judge_miss(&mut counts[2]);
            tell(what, &("miss", &trial.surface, &trial.wrench, &trial.near, trial.resolve(Asked::Soft)));
        }
    }
    // Trials, wrong, lost, false, unsure, none, unjudged, and the worst errors in units of the goal.
    for (kind, count) in ["point", "soft", "miss", "edge"].into_iter().zip(counts) {
        if count.trials > 0 {
            println!("{name:18} {precision} {kind:6} {count}");
        }
    }
    counts
}

/// Both precisions of a shape, of numbers `T`.
macro_rules! table {
    ($($name:ident: $shape:ty;)*) => {
        $(#[test]
        fn $name() {
            type Of<T> = $shape;
            check(stringify!($name), &[
                rows::<f64, Of<f64>>(stringify!($name), trials(300, false)),
                rows::<f32, Of<f32>>(stringify!($name), trials(300, false)),
            ]);
        })*

        mod long {
            use super::*;
            $(#[test]
            #[ignore = "a million trials: minutes in release"]
            fn $name() {
                type Of<T> = $shape;
                check(stringify!($name), &[
                    rows::<f64, Of<f64>>(stringify!($name), trials(0, true)),
                    rows::<f32, Of<f32>>(stringify!($name), trials(0, true)),
                ]);
            })*
        }
    };
}

/// Nothing wrong, nothing lost, nothing false; but in single precision, the last, without the feature that refines it, where at
/// these angles and spin torques rounding decides some: of those one in three may be wrong, and one in a hundred lost or false.
fn check(name: &str, precisions: &[[Count; 4]]) {
    let (exact, single) = if cfg!(feature = "mixed-precision") {
        (precisions, &[][..])
    } else {
        precisions.split_at(precisions.len() - 1)
    };
    for count in single.iter().flatten() {
        let most = [count.trials / 3, count.trials / 100 + 1, count.trials / 100 + 1];
        let some = [count.wrong, count.lost, count.false_contacts];
        assert!(some.iter().zip(most).all(|(some, most)| *some <= most), "{name}: {count}");
    }
    for count in exact.iter().flatten() {
        assert_eq!((count.wrong, count.lost, count.false_contacts), (0, 0, 0), "{name}: {count}");
        assert!(count.unjudged * 50 <= count.trials && count.unsure * 50 <= count.trials, "{name}: {count}");
    }
}

table! {
    plane: Plane<T>;
    sphere: Sphere<T>;
    ellipsoid: Ellipsoid<T>;
    paraboloid: Paraboloid<T>;
    cylinder: Cylinder<T>;
    elliptic_cylinder: EllipticCylinder<T>;
    capped_cylinder: CappedCylinder<T>;
    frustum: Frustum<T>;
    capsule: Capsule<T>;
    cone: Cone<T>;
    torus: Torus<T>;
    rounded_box: RoundedBox<T>;
    revolution: Revolution<T, [Knot<T>; 2]>;
    superquadric: Superquadric<T>;
    quartic: Implicit<T, Quartic<T>>;
    posed_cylinder: Posed<T, Cylinder<T>>;
    posed_capsule: Posed<T, Capsule<T>>;
    posed_capped_cylinder: Posed<T, CappedCylinder<T>>;
    posed_elliptic_cylinder: Posed<T, EllipticCylinder<T>>;
    posed_frustum: Posed<T, Frustum<T>>;
    posed_cone: Posed<T, Cone<T>>;
    posed_plane: Posed<T, Plane<T>>;
    posed_sphere: Posed<T, Sphere<T>>;
    posed_ellipsoid: Posed<T, Ellipsoid<T>>;
    posed_paraboloid: Posed<T, Paraboloid<T>>;
    posed_torus: Posed<T, Torus<T>>;
    posed_rounded_box: Posed<T, RoundedBox<T>>;
    posed_revolution: Posed<T, Revolution<T, [Knot<T>; 2]>>;
    posed_superquadric: Posed<T, Superquadric<T>>;
}
