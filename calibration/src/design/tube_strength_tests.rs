//! Yield and buckling of tubes, by hand, by brute force, and by loads that grow.

use super::{LoadedTube, THICKEST_WALL, TubeFailure};
use crate::design::{Material, NominalLoads};
use core::f64::consts::PI;
use proptest::prelude::*;

fn tube(force: [f64; 3], torque: [f64; 3]) -> LoadedTube {
    LoadedTube {
        material: Material::ALUMINIUM_7075_T6,
        radius: 5e-3,
        length: 12e-3,
        loads: NominalLoads { force, torque },
    }
}

/// So small that it does not count in a sum with ordinary loads.
const NONE: f64 = 1e-30;

#[test]
fn single_loads_have_the_textbook_stress() {
    let (radius, wall, length) = (5e-3, 0.2e-3, 12e-3);
    let area = 2.0 * PI * radius * wall;
    let section_modulus = PI * radius * radius * wall;
    let cases = [
        (tube([100.0, NONE, NONE], [NONE; 3]), 100.0 / area),
        (tube([NONE; 3], [NONE, 1.0, NONE]), 1.0 / section_modulus),
        (tube([NONE; 3], [1.0, NONE, NONE]), 3.0_f64.sqrt() / (2.0 * section_modulus)),
        (tube([NONE, 100.0, NONE], [NONE; 3]), {
            let bending = 100.0 * length / section_modulus;
            let shear = 200.0 / area * 3.0_f64.sqrt();
            bending.max(shear)
        }),
    ];
    for (tube, stress) in cases {
        let found = tube.strength(wall).unwrap().stress;
        assert!((found - stress).abs() <= 1e-12 * stress, "{found} {stress}");
    }
}

proptest! {
    #[test]
    fn least_thickness_holds_and_less_does_not(
        force in 0.1..60.0_f64, torque in 1e-3..0.4_f64, safety in 1.0..4.0_f64, radius in 2e-3..20e-3_f64,
    ) {
        let mut tube = tube([force; 3], [torque; 3]);
        tube.radius = radius;
        match tube.least_thickness(safety) {
            Ok(wall) => {
                prop_assert!(tube.strength(wall * 1.000_001).unwrap().holds(safety)
                    || wall / radius > 0.099_999);
                prop_assert!(!tube.strength(wall * 0.999).unwrap().holds(safety));
            }
            Err(_) => prop_assert!(!tube.strength(radius * THICKEST_WALL).unwrap().holds(safety)),
        }
    }

    #[test]
    fn safety_grows_with_the_wall(wall in 1e-5..4e-4_f64, factor in 1.01..1.5_f64) {
        let tube = tube([30.0; 3], [0.3; 3]);
        let (thin, thick) = (tube.strength(wall).unwrap(), tube.strength(wall * factor).unwrap());
        prop_assert!(thick.stress < thin.stress);
        prop_assert!(thick.wall_buckling_ratio < thin.wall_buckling_ratio);
        prop_assert!(thick.column_buckling_ratio < thin.column_buckling_ratio);
    }
}

proptest! {
    /// Loads that grow by the safety just fail, by all of the criteria, each with its own powers of the load.
    #[test]
    fn loads_times_safety_just_fail(
        force in prop::array::uniform3(1e-3..60.0_f64), torque in prop::array::uniform3(1e-5..0.4_f64),
        wall in 2e-6..4e-4_f64,
    ) {
        let tube = tube(force, torque);
        let strength = tube.strength(wall).unwrap();
        let safety = strength.safety();
        let grown = |factor: f64| {
            let loads = NominalLoads {
                force: force.map(|f| f * factor * safety),
                torque: torque.map(|m| m * factor * safety),
            };
            LoadedTube { loads, ..tube }.strength(wall).unwrap()
        };
        prop_assert!((grown(1.0).worst_ratio() - 1.0).abs() < 1e-9);
        prop_assert!(grown(0.999).holds(1.0) || strength.wall_ratio > THICKEST_WALL);
        prop_assert!(!grown(1.001).holds(1.0));
        prop_assert_eq!(grown(1.0).failure(), strength.failure());
        // The formula of the interaction itself, of loads that each buckle alone at the ratio's reciprocal.
        let alone = |force: [f64; 3], torque: [f64; 3]| {
            let tube = LoadedTube { loads: NominalLoads { force, torque }, ..tube };
            tube.strength(wall).unwrap().wall_buckling_ratio
        };
        let shares = [
            alone([force[0], NONE, NONE], [NONE; 3]),
            alone([NONE; 3], [NONE, torque[1], torque[2]]),
            alone([NONE; 3], [torque[0], NONE, NONE]),
        ];
        let all = alone([force[0], NONE, NONE], torque);
        let sum = (shares[0] + shares[1]) / all + (shares[2] / all).powi(2);
        prop_assert!((sum - 1.0).abs() < 1e-9, "{} {}", sum, all);
    }

    /// Von Mises at every angle under every combination of signs.
    #[test]
    fn stress_is_that_of_the_worst_signs(
        force in prop::array::uniform3(1e-3..60.0_f64), torque in prop::array::uniform3(1e-5..0.4_f64),
    ) {
        let (tube, wall) = (tube(force, torque), 0.2e-3);
        let area = 2.0 * PI * tube.radius * wall;
        let mut worst = 0.0_f64;
        for signs in 0..64_u32 {
            let signed = |i: u32, size: f64| if signs >> i & 1 == 0 { size } else { -size };
            let [f1, f2, f3] = [signed(0, force[0]), signed(1, force[1]), signed(2, force[2])];
            let [m4, m5, m6] = [signed(3, torque[0]), signed(4, torque[1]), signed(5, torque[2])];
            for step in 0..1024 {
                let (sin, cos) = (2.0 * PI * f64::from(step) / 1024.0).sin_cos();
                // Moments at the clamp, behind the origin: those of a force at the origin with an arm of the length.
                let (about2, about3) = (m5 - tube.length * f3, m6 + tube.length * f2);
                let normal = f1 / area + 2.0 / (tube.radius * area) * (about2 * sin - about3 * cos);
                let shear = m4 / (tube.radius * area) + 2.0 / area * (f3 * cos - f2 * sin);
                worst = worst.max((normal * normal + 3.0 * shear * shear).sqrt());
            }
        }
        let found = tube.strength(wall).unwrap().stress;
        prop_assert!((found / worst - 1.0).abs() < 1e-12, "{} {}", found, worst);
    }
}

#[test]
fn very_thin_walls_buckle_before_they_yield() {
    let mut tube = tube([0.02; 3], [0.2e-3; 3]);
    tube.radius = 20e-3;
    let wall = tube.least_thickness(2.0).unwrap();
    let strength = tube.strength(wall).unwrap();
    assert!(strength.wall_buckling_ratio > strength.yield_ratio);
    assert!((strength.wall_buckling_ratio * 2.0 - 1.0).abs() < 1e-9);
}

/// The formulas of the documentation, worked out apart from this code for one tube of 20 mm and 0.2 mm: the
/// loads at which it buckles.
#[test]
fn single_loads_buckle_where_the_formulas_say() {
    let wall = 0.2e-3;
    let of = |force: [f64; 3], torque: [f64; 3], length: f64| {
        LoadedTube { radius: 20e-3, length, ..tube(force, torque) }.strength(wall).unwrap()
    };
    let near = |found: f64, expected: f64| {
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} instead of {expected}");
    };
    let compression = of([6_406.391_629_609_737, NONE, NONE], [NONE; 3], 12e-3);
    near(compression.wall_buckling_ratio, 1.0);
    near(compression.column_buckling_ratio, 6_406.391_629_609_737 / 6_175_416.772_159_714);
    near(compression.wall_ratio, 0.01);
    let moment = 72.771_402_724_899_87;
    near(of([NONE; 3], [NONE, moment, NONE], 12e-3).wall_buckling_ratio, 1.0);
    near(of([NONE; 3], [NONE, 0.6 * moment, 0.8 * moment], 12e-3).wall_buckling_ratio, 1.0);
    // Z is 34 here, and 0.5 for the short one, which counts as 1.
    near(of([NONE; 3], [74.066_459_694_494_2, NONE, NONE], 12e-3).wall_buckling_ratio, 1.0);
    near(of([NONE; 3], [2.0 * 336.784_633_990_464_6, NONE, NONE], 1.5e-3).wall_buckling_ratio, 2.0);
    // A transverse force F shears as a torque of 2RF does, and bends at the clamped end.
    let force = 100.0;
    let shear = force * 2.0 * 20e-3 / 336.784_633_990_464_6;
    // At λ times the loads aλ + (bλ)² = 1.
    let bending = force * 1.5e-3 / moment;
    let factor = ((bending * bending + 4.0 * shear * shear).sqrt() - bending) / (2.0 * shear * shear);
    let expected = 1.0 / factor;
    near(of([NONE, force, NONE], [NONE; 3], 1.5e-3).wall_buckling_ratio, expected);
    near(of([NONE, 0.6 * force, 0.8 * force], [NONE; 3], 1.5e-3).wall_buckling_ratio, expected);
}

/// What just holds, and a little less.
#[test]
fn a_tube_holds_up_to_its_limits() {
    let good = tube([10.0; 3], [0.1; 3]).strength(0.2e-3).unwrap();
    let safety = good.safety();
    assert!(good.holds(0.999_999 * safety) && !good.holds(1.000_001 * safety));
    let of_ratios = |yields: f64, wall: f64, column: f64| super::TubeStrength {
        yield_ratio: yields,
        wall_buckling_ratio: wall,
        column_buckling_ratio: column,
        ..good
    };
    for (strength, failure) in [
        (of_ratios(0.5, 0.2, 0.1), TubeFailure::Yield),
        (of_ratios(0.1, 0.5, 0.2), TubeFailure::WallBuckling),
        (of_ratios(0.2, 0.1, 0.5), TubeFailure::ColumnBuckling),
    ] {
        assert_eq!((strength.worst_ratio(), strength.safety()), (0.5, 2.0));
        assert_eq!(strength.failure(), failure);
        assert!(strength.holds(2.0) && !strength.holds(2.001));
        assert!(super::TubeStrength { wall_ratio: THICKEST_WALL, ..strength }.holds(2.0));
        assert!(!super::TubeStrength { wall_ratio: 1.01 * THICKEST_WALL, ..strength }.holds(1.0));
    }
}

#[test]
fn refuses_bad_numbers() {
    let good = tube([30.0; 3], [0.3; 3]);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(good.strength(bad).is_err());
        assert!(good.least_thickness(bad).is_err());
        assert!(LoadedTube { radius: bad, ..good }.strength(1e-4).is_err());
        assert!(LoadedTube { length: bad, ..good }.least_thickness(1.0).is_err());
    }
    assert!(tube([1e9; 3], [0.3; 3]).least_thickness(1.0).is_err());
}
