//! Crosses, platforms and tubes against structural mechanics worked out another way.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};

use fingertip_calibration::design::{
    DesignSpace, LoadedTube, MalteseCross, MalteseCrossSpace, Material, NominalLoads, Stewart, StrainSite,
};
use fingertip_calibration::nalgebra::{
    DMatrix, Matrix2, Matrix3x6, Matrix6, Rotation3, Vector2, Vector3, Vector6,
};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::testing::Largest as _;

const METAL: Material = Material::ALUMINIUM_7075_T6;

/// Torsion constant of a rectangle by its half sides (Roark, table 20).
fn torsion(width: f64, height: f64) -> f64 {
    let (a, b) = (0.5 * width.max(height), 0.5 * width.min(height));
    a * b.powi(3) * (16.0 / 3.0 - 3.36 * b / a * (1.0 - b.powi(4) / (12.0 * a.powi(4))))
}

/// The strains of a cross by the stiffness method: frame elements from the hub to a rim that is held, and the
/// strain by the shape functions of the element.
fn by_stiffness(cross: &MalteseCross) -> [Vector6<f64>; 16] {
    let (e, l, b, h) = (METAL.youngs_modulus, cross.length, cross.width, cross.height);
    let (about_z, about_y) = (h * b.powi(3) / 12.0, b * h.powi(3) / 12.0);
    let axial = 1.0 / (l / (e * b * h) + cross.membrane_compliance);
    let shear_modulus = e / (2.0 * (1.0 + METAL.poisson_ratio));
    let mut element = Matrix6::from_diagonal(&Vector6::new(
        axial,
        12.0 * e * about_z / l.powi(3),
        12.0 * e * about_y / l.powi(3),
        shear_modulus * torsion(b, h) / l,
        4.0 * e * about_y / l,
        4.0 * e * about_z / l,
    ));
    for ((i, j), value) in [((1, 5), 6.0 * e * about_z / (l * l)), ((2, 4), -6.0 * e * about_y / (l * l))] {
        element[(i, j)] = value;
        element[(j, i)] = value;
    }
    // Displacements of a spoke's end, in its frame, by those of the hub about the origin of the loads.
    let end = |spoke: usize| {
        let out = Rotation3::from_axis_angle(&Vector3::x_axis(), FRAC_PI_2 * spoke as f64) * Vector3::y();
        let frame = [out, Vector3::x().cross(&out), Vector3::x()];
        let place = out * cross.hub_radius - Vector3::x() * cross.height_of_origin;
        Matrix6::from_fn(|i, j| {
            let axis = Vector3::ith(j % 3, 1.0);
            match (i / 3, j / 3) {
                (0, 0) | (1, 1) => frame[i % 3].dot(&axis),
                (0, 1) => frame[i].dot(&axis.cross(&place)),
                _ => 0.0,
            }
        })
    };
    let whole =
        (0..4).fold(Matrix6::zeros(), |sum, spoke| sum + end(spoke).transpose() * element * end(spoke));
    let give = whole.try_inverse().unwrap();
    let at = cross.gauge_distance / l;
    let mut strains = [Vector6::zeros(); 16];
    for spoke in 0..4 {
        let moved = end(spoke) * give;
        let row = |i: usize| moved.row(i).transpose();
        let stretched = row(0) * (-axial / (e * b * h));
        let bent = |shift: Vector6<f64>, turn: Vector6<f64>| {
            shift * ((12.0 * at - 6.0) / (l * l)) + turn * ((6.0 * at - 4.0) / l)
        };
        let (across, up) = (bent(row(1), row(5)), bent(row(2), -row(4)));
        let faces = [-up * (0.5 * h), up * (0.5 * h), -across * (0.5 * b), across * (0.5 * b)];
        for (face, bending) in faces.into_iter().enumerate() {
            strains[4 * spoke + face] = stretched + bending;
        }
    }
    strains
}

#[test]
fn a_cross_strains_as_a_frame_of_beams() {
    let random = &mut Pcg64Mcg::seed_from_u64(121);
    for _ in 0..40 {
        let mut length = |low: f64, high: f64| random.random_range(low..high);
        let cross = MalteseCross {
            hub_radius: length(3e-3, 9e-3),
            length: length(8e-3, 20e-3),
            width: length(0.8e-3, 3e-3),
            height: length(0.8e-3, 3e-3),
            membrane_compliance: if length(0.0, 1.0) < 0.5 { 0.0 } else { length(0.0, 1e-6) },
            height_of_origin: length(-10e-3, 10e-3),
            gauge_distance: length(0.0, 8e-3),
        };
        let (found, expected) = (cross.strains(&METAL).unwrap(), by_stiffness(&cross));
        for axis in 0..6 {
            let size = expected.iter().fold(0.0_f64, |most, row| most.max(row[axis].abs()));
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found[axis] - expected[axis]).abs() < 1e-9 * size, "{axis}: {found} {expected}");
            }
        }
    }
}

#[test]
fn a_cross_is_wired_in_half_bridges_of_opposite_faces() {
    let fixed = MalteseCross {
        hub_radius: 5e-3,
        length: 12e-3,
        width: 2e-3,
        height: 1.5e-3,
        membrane_compliance: 1e-8,
        height_of_origin: 4e-3,
        gauge_distance: 12e-3,
    };
    // At the end of the spoke is still on it; beyond is not.
    assert!(fixed.strains(&METAL).is_ok());
    assert!(MalteseCross { gauge_distance: 12.001e-3, ..fixed }.strains(&METAL).is_err());
    for bad in [0.0, -1e-3] {
        assert!(MalteseCross { hub_radius: bad, ..fixed }.strains(&METAL).is_err());
        assert!(MalteseCross { width: bad, ..fixed }.strains(&METAL).is_err());
        assert!(MalteseCross { height: bad, ..fixed }.strains(&METAL).is_err());
    }
    let space = MalteseCrossSpace::new((6e-3, 20e-3), (0.8e-3, 4e-3), fixed, METAL).unwrap();
    let values = [10e-3, 1.2e-3, 2.5e-3, 0.3];
    let cross = space.cross(&values).unwrap();
    let expected =
        MalteseCross { length: 10e-3, width: 1.2e-3, height: 2.5e-3, gauge_distance: 3e-3, ..fixed };
    assert_eq!(cross, expected);
    assert!(space.cross(&values[..3]).is_err());
    let gauges = cross.strains(&METAL).unwrap();
    let mut rows = [Vector6::zeros(); 8];
    space.response(&values, &mut rows).unwrap();
    for (bridge, row) in rows.iter().enumerate() {
        assert!((row - (gauges[2 * bridge] - gauges[2 * bridge + 1])).largest() < 1e-20, "{bridge}");
    }
}

/// Lower and upper joint of each leg as the documentation has them: pairs of joints 120° apart, those of the
/// platform between those of the base.
fn legs(platform: &Stewart) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let joint = |below: f64, radius: f64, angle: f64| {
        Vector3::new(-platform.height_of_origin - below, radius * angle.cos(), radius * angle.sin())
    };
    (0..3)
        .flat_map(|pair| [(pair, 1.0), (pair, -1.0)])
        .map(|(pair, side)| {
            let middle = 2.0 * FRAC_PI_3 * f64::from(pair);
            let below = middle + side * platform.base_half_angle;
            let above = middle + side * FRAC_PI_3 - side * platform.platform_half_angle;
            (joint(platform.height, platform.base_radius, below), joint(0.0, platform.platform_radius, above))
        })
        .collect()
}

#[test]
fn the_legs_of_a_platform_balance_its_load_and_bear_it() {
    let platform = Stewart {
        base_radius: 20e-3,
        platform_radius: 12e-3,
        height: 15e-3,
        base_half_angle: 0.2,
        platform_half_angle: 0.15,
        height_of_origin: 8e-3,
    };
    let tensions = platform.tensions().unwrap();
    for axis in 0..6 {
        let mut rest = Vector6::ith(axis, 1.0);
        for ((below, above), tension) in legs(&platform).iter().zip(tensions.column(axis).iter()) {
            let pull = (below - above).normalize() * *tension;
            let torque = above.cross(&pull);
            rest += Vector6::new(pull.x, pull.y, pull.z, torque.x, torque.y, torque.z);
        }
        assert!(rest.largest() < 1e-12, "{axis}: {rest}");
    }
    let strains = platform.strains(&METAL, 2e-6).unwrap();
    for (leg, strain) in strains.iter().enumerate() {
        let expected = tensions.row(leg).transpose() / (METAL.youngs_modulus * 2e-6);
        assert!((strain - expected).largest() < 1e-15 * expected.largest());
    }
    // The worst signs of all loads together, by trying them.
    let loads = NominalLoads { force: [10.0, 20.0, 30.0], torque: [0.1, 0.2, 0.3] };
    let worst = (0..64_u32)
        .flat_map(|signs| {
            let load = loads.components();
            let load = Vector6::from_fn(|i, _| if signs >> i & 1 == 1 { -load[i] } else { load[i] });
            (tensions * load).iter().copied().collect::<Vec<_>>()
        })
        .fold(0.0, f64::max);
    let diameter = 1.2e-3_f64;
    let strength = platform.strength(&METAL, diameter, &loads).unwrap();
    let near =
        |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    near(strength.leg_force, worst);
    let area = PI * (0.5 * diameter).powi(2);
    near(strength.yield_ratio, worst / area / METAL.yield_strength);
    // Euler with hinged ends: π²EI/L², I = πr⁴/4.
    let length = legs(&platform).iter().map(|(below, above)| (above - below).norm()).fold(0.0, f64::max);
    let inertia = PI * (0.5 * diameter).powi(4) / 4.0;
    near(strength.buckling_ratio, worst * length * length / (PI * PI * METAL.youngs_modulus * inertia));
    for bad in [0.0, -1e-3, f64::NAN] {
        assert!(platform.strength(&METAL, bad, &loads).is_err() && platform.strains(&METAL, bad).is_err());
        assert!(Stewart { base_radius: bad, ..platform }.tensions().is_err());
        assert!(Stewart { platform_radius: bad, ..platform }.tensions().is_err());
    }
    for (angle, good) in [(0.0, true), (FRAC_PI_3, true), (-1e-9, false), (FRAC_PI_3 + 1e-9, false)] {
        let turned = Stewart { base_half_angle: angle, ..platform };
        assert_eq!(turned.tensions().is_ok(), good, "{angle}");
    }
}

#[test]
fn all_loads_of_a_tube_act_together() {
    let (wall, length) = (0.2e-3, 12e-3);
    let tube = |force: [f64; 3], torque: [f64; 3]| LoadedTube {
        material: METAL,
        radius: 5e-3,
        length,
        loads: NominalLoads { force, torque },
    };
    let of = |force, torque| tube(force, torque).strength(wall).unwrap();
    let (force, torque) = ([50.0, 70.0, 110.0], [0.4, 0.5, 0.7]);
    let found = of(force, torque);
    // Von Mises around the clamped section, over all signs of the six loads: a transverse force shears and bends.
    let area = TAU * 5e-3 * wall;
    let mut greatest = 0.0_f64;
    for signs in 0..64_u32 {
        let sign = |bit: u32| if signs >> bit & 1 == 1 { -1.0 } else { 1.0 };
        let [f2, f3] = [sign(0) * force[1], sign(1) * force[2]];
        let bend2 = sign(2) * torque[1] - length * f3;
        let bend3 = sign(3) * torque[2] + length * f2;
        for step in 0..1024_u32 {
            let (sin, cos) = (TAU * f64::from(step) / 1024.0).sin_cos();
            let normal = sign(4) * force[0] / area + (bend2 * sin - bend3 * cos) / (PI * 5e-3 * 5e-3 * wall);
            let transverse = 2.0 / area * (f3 * cos - f2 * sin);
            let shear = sign(5) * torque[0] / (2.0 * PI * 5e-3 * 5e-3 * wall) + transverse;
            greatest = greatest.max((normal * normal + 3.0 * shear * shear).sqrt());
        }
    }
    assert!((found.stress / greatest - 1.0).abs() < 1e-12, "{} {greatest}", found.stress);
    assert!((found.yield_ratio * METAL.yield_strength / greatest - 1.0).abs() < 1e-12);
    // Compression and bending add up with the square of the shear, whose parts add up before: at the load that
    // buckles the wall to one.
    let none = 1e-30;
    let compression = of([force[0], none, none], [none; 3]).wall_buckling_ratio;
    let bending = of([none; 3], [none, 1.0, none]).wall_buckling_ratio;
    let shear = of([none; 3], [1.0, none, none]).wall_buckling_ratio;
    let moment = (torque[1] + length * force[2]).hypot(torque[2] + length * force[1]);
    let twist = torque[0] + 2.0 * 5e-3 * force[1].hypot(force[2]);
    let buckling = 1.0 / found.wall_buckling_ratio;
    let sum = (compression + bending * moment) * buckling + (shear * twist * buckling).powi(2);
    assert!((sum - 1.0).abs() < 1e-12, "{found:?} {sum}");
}

/// The least wall that bears an axial force alone is that of yield or of the column, whichever is more.
#[test]
fn the_least_wall_is_that_of_the_first_way_to_fail() {
    let none = 1e-30;
    let loads = NominalLoads { force: [2000.0, none, none], torque: [none; 3] };
    for length in [12e-3, 80e-3] {
        let tube = LoadedTube { material: METAL, radius: 5e-3, length, loads };
        let by_yield = 2.0 * 2000.0 / (TAU * 5e-3 * METAL.yield_strength);
        let column = PI * PI * METAL.youngs_modulus * PI * 5e-3_f64.powi(3) / (4.0 * length * length);
        let expected = by_yield.max(2.0 * 2000.0 / column);
        let wall = tube.least_thickness(2.0).unwrap();
        // That no buckling of the wall decides here.
        assert!(tube.strength(wall).unwrap().wall_buckling_ratio < 0.5);
        assert!((wall / expected - 1.0).abs() < 1e-9, "{length}: {wall} {expected}");
    }
    let heavy = LoadedTube { material: METAL, radius: 5e-3, length: 12e-3, loads };
    assert!(heavy.least_thickness(20.0).is_err());
}

/// A matrix whose columns are the legs' pulls is singular where these pass through one line.
#[test]
fn a_platform_that_can_turn_is_refused() {
    let platform = Stewart {
        base_radius: 20e-3,
        platform_radius: 20e-3,
        height: 15e-3,
        base_half_angle: 0.3,
        platform_half_angle: FRAC_PI_3 - 0.3,
        height_of_origin: 0.0,
    };
    let pulls = legs(&platform);
    let matrix = DMatrix::from_fn(6, 6, |i, j| {
        let (below, above) = pulls[j];
        let along = (above - below).normalize();
        if i < 3 { along[i] } else { above.cross(&along)[i - 3] / 20e-3 }
    });
    assert!(matrix.singular_values().min() < 1e-12);
    assert!(platform.tensions().is_err());
    let nearly = Stewart { platform_half_angle: FRAC_PI_3 - 0.3 + 1e-3, ..platform };
    assert!(nearly.tensions().is_ok());
}

/// The strain along a direction is that of the tensor, `nᵀ E n`, whose shear is half of the angle.
#[test]
fn a_turned_gauge_reads_the_tensor_along_it() {
    let mut random = Pcg64Mcg::seed_from_u64(31);
    let strains = Matrix3x6::from_fn(|_, _| random.random_range(-1.0..1.0));
    for angle in [-2.0, -0.7, 0.0, 0.3, 1.1, FRAC_PI_2] {
        let along = Vector2::new(f64::cos(angle), f64::sin(angle));
        let read = StrainSite { strains }.gauge(angle);
        for load in 0..6 {
            let half = 0.5 * strains[(2, load)];
            let tensor = Matrix2::new(strains[(0, load)], half, half, strains[(1, load)]);
            assert!((read[load] - along.dot(&(tensor * along))).abs() < 1e-15, "{angle} {load}: {read}");
        }
    }
}
