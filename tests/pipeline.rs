//! The whole pipeline against contacts that are known: signals in, touch out.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use fingertip::contact::batch::BatchSurface;
use fingertip::contact::{NoContact, PointContact, Resolution};
use fingertip::friction::{
    Coulomb, DropDetector, ForceNoise, NormalForceGate, RatioThreshold, SlipMargin, SlipVerdict,
};
use fingertip::surfaces::{ActiveSurface, Ellipsoid, Sphere};
use fingertip::wrench::gauge_layout::{GaugeLayout, ThinWalledBeam};
use fingertip::wrench::{
    Compensation, GaussianElimination, Real, SensorMatrix, Tare, Uncompensated, Wrench, WrenchSolver,
};
use fingertip::{Absent, Fingertip, Touches};
use nalgebra::{SVector, Vector3, Vector6};
use proptest::prelude::*;

/// The sensor of Bicchi & Dario 1987, in volts, with nominal loads of 30 N and 0.3 N·m.
fn paper_sensor<T: Real>() -> SensorMatrix<T, 6> {
    let l = T::literal;
    let beam = ThinWalledBeam {
        radius: l(5e-3),
        thickness: l(0.3e-3),
        youngs_modulus: l(70e9),
        poisson_ratio: l(0.33),
    };
    let gauges = GaugeLayout::bicchi_dario_gauges(l(14.0_f64.to_radians()), l(10e-3));
    let nominal = Vector6::new(l(30.0), l(30.0), l(30.0), l(0.3), l(0.3), l(0.3));
    GaugeLayout::new(&beam, gauges).unwrap().sensor_matrix(l(2500.0), nominal).unwrap()
}

const RADIUS: f64 = 13e-3;

/// A contact on the sphere: outward normal, and a force that presses on it.
fn contact() -> impl Strategy<Value = (Vector3<f64>, Vector3<f64>)> {
    let direction = prop::array::uniform3(-1.0..1.0_f64)
        .prop_map(Vector3::from)
        .prop_filter("has a direction", |v| v.norm() > 0.1);
    (direction.clone(), direction, 0.0..0.9_f64, 0.1..30.0_f64).prop_map(
        |(normal, other, friction, pressing)| {
            let normal = normal.normalize();
            let across = other.cross(&normal);
            let tangent = if across.norm() > 1e-3 { across.normalize() } else { Vector3::zeros() };
            (normal, -normal * pressing + tangent * (friction * pressing))
        },
    )
}

fn check_contact_is_found_again<T: Real>(normal: &Vector3<f64>, force: &Vector3<f64>) {
    let sensor = paper_sensor::<T>();
    let mut fingertip = Fingertip::builder()
        .solver(GaussianElimination::new(&sensor).unwrap())
        .contact(Sphere::centred(T::literal(RADIUS)).unwrap(), PointContact::new(T::literal(0.05)).unwrap())
        .friction(Coulomb::new(T::one()).unwrap())
        .build();
    let truth: Wrench<f64> = Wrench::from_force_at(&(normal * RADIUS), *force);
    let truth = truth.components().map(T::literal);
    let signals = sensor.signals(&Wrench::from_components(&truth));
    let touch = fingertip.sense(&signals, T::literal(1e-3));
    let contact = touch.resolution.into_result().expect("a pressing force is a contact");
    // The layout's condition number is 4.8 for normalised loads; a contact at |f_t| < 0.9 f_n
    // is seen at a cosine above 0.74. A factor of 200 on epsilon covers their product with the
    // few dozen roundings of the way.
    let tolerance = T::EPSILON.to_f64() * 200.0;
    let point = contact.point.map(Real::to_f64);
    assert!((point - normal * RADIUS).norm() < tolerance * RADIUS, "{point} instead of {}", normal * RADIUS);
    let found = contact.contact_force();
    assert!((found.normal.to_f64() + force.dot(normal)).abs() < tolerance * force.norm());
    let margin = touch.grip.expect("a contact has a margin").newtons.to_f64();
    let tangential = (force - normal * force.dot(normal)).norm();
    let expected = (-force.dot(normal) - tangential) / 2.0_f64.sqrt();
    assert!((margin - expected).abs() < tolerance * force.norm());
}

proptest! {
    #[test]
    fn a_contact_is_found_again((normal, force) in contact()) {
        check_contact_is_found_again::<f64>(&normal, &force);
        check_contact_is_found_again::<f32>(&normal, &force);
    }

    #[test]
    fn any_bits_as_signals_give_an_answer_without_nan(bits in prop::array::uniform6(any::<u32>())) {
        let mut fingertip = Fingertip::builder()
            .solver(GaussianElimination::new(&paper_sensor::<f32>()).unwrap())
            .contact(Sphere::centred(RADIUS as f32).unwrap(), PointContact::new(0.0).unwrap())
            .friction(Coulomb::new(0.5).unwrap())
            .build();
        let touch = fingertip.sense(&Vector6::from(bits.map(f32::from_bits)), 1e-3);
        if let Resolution::Contact(contact) = touch.resolution {
            prop_assert!(contact.point.iter().all(|x| x.is_finite()));
            prop_assert!((0.0..=1.0).contains(&contact.incidence()));
            let margin = touch.grip.unwrap();
            prop_assert!(!margin.newtons.is_nan() && !margin.utilisation.is_nan());
        }
    }
}

#[test]
fn the_tare_is_taken_off_before_solving() {
    let sensor = paper_sensor::<f64>();
    let bias = SVector::<f64, 6>::from_fn(|i, _| 0.01 * (i as f64 + 1.0));
    let mut fingertip = Fingertip::builder()
        .zero(Tare::new(bias))
        .solver(GaussianElimination::new(&sensor).unwrap())
        .contact(Sphere::centred(RADIUS).unwrap(), PointContact::new(0.1).unwrap())
        .build();
    let truth = Wrench::from_force_at(&Vector3::new(RADIUS, 0.0, 0.0), Vector3::new(-2.0, 0.0, 0.0));
    let touch = fingertip.sense(&(sensor.signals(&truth) + bias), 1e-3);
    let contact = touch.resolution.into_result().unwrap();
    assert!((contact.normal_force() - 2.0).abs() < 1e-12);
}

#[test]
fn no_load_is_no_contact_and_resets_the_detector() {
    let noise = ForceNoise::isotropic(0.02).unwrap();
    let mut fingertip = Fingertip::builder()
        .contact(Sphere::centred(RADIUS).unwrap(), PointContact::new(0.1).unwrap())
        .slip_detector(DropDetector::new(noise).unwrap())
        .build();
    let touch = fingertip.feel(Wrench::<f64>::zero(), 1e-3, None);
    assert!(matches!(touch.resolution, Resolution::NoContact(NoContact::BelowThreshold { .. })));
    assert_eq!(touch.slip, SlipVerdict::NotPressing);
    assert!(touch.grip.is_none());
}

#[test]
fn an_absent_stage_takes_no_memory() {
    type Solver = GaussianElimination<f32>;
    type Bare = Fingertip<Solver, Sphere<f32>, PointContact<f32>>;
    assert_eq!(size_of::<Absent>() + size_of::<Uncompensated>(), 0);
    assert_eq!(
        size_of::<Bare>(),
        size_of::<Solver>() + size_of::<Sphere<f32>>() + size_of::<PointContact<f32>>(),
    );
}

/// A user's own stages need nothing from this workspace but its traits.
#[test]
fn own_stages_plug_in() {
    struct Counts;
    impl Compensation<f64, 6> for Counts {
        type Raw = [i16; 6];
        fn compensate(&self, raw: &[i16; 6]) -> SVector<f64, 6> {
            SVector::from(raw.map(|count| f64::from(count) * 1e-3))
        }
    }
    struct Direct;
    impl WrenchSolver<f64, 6> for Direct {
        fn solve(&self, signals: &SVector<f64, 6>) -> Wrench<f64> {
            Wrench::from_components(signals)
        }
    }
    let mut fingertip = Fingertip::builder()
        .zero(Counts)
        .solver(Direct)
        .contact(Sphere::centred(RADIUS).unwrap(), PointContact::new(0.0).unwrap())
        .build();
    let touch = fingertip.sense(&[0, 0, -1500, 0, 0, 0], 1e-3);
    let contact = touch.resolution.into_result().unwrap();
    assert_eq!(contact.point, Vector3::new(0.0, 0.0, RADIUS));
    assert_eq!(contact.normal_force(), 1.5);
}

/// Signals of contacts on and near a sphere, and of what is none.
fn signals_of_all_kinds<T: Real>(sensor: &SensorMatrix<T, 6>, seed: u64) -> Vec<Vector6<T>> {
    use rand::{RngExt, SeedableRng};
    let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(seed);
    let mut signals: Vec<Vector6<T>> = (0..997)
        .map(|_| {
            let mut any = |size: f64| Vector3::from_fn(|_, _| random.random_range(-size..size));
            let (force, point) = (any(3.0), any(0.01));
            let truth: Wrench<f64> = Wrench::from_force_at(&point, force);
            sensor.signals(&Wrench::from_components(&truth.components().map(T::literal)))
        })
        .collect();
    let none = [T::zero(), T::literal(1e-9), T::literal(f64::NAN), T::literal(f64::INFINITY), T::GREATEST];
    signals.extend(none.map(Vector6::repeat));
    signals
}

fn many_at_once_are_as_one_at_a_time<T: Real, S>(surface: S, model: PointContact<T>)
where
    S: ActiveSurface<T> + BatchSurface<T>,
{
    let sensor = paper_sensor::<T>();
    let zero = Vector6::from_fn(|gauge, _| T::literal(0.01) * T::literal(f64::from(gauge as u32)));
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(T::literal(0.01)).unwrap());
    let mut fingertip = Fingertip::builder()
        .zero(Tare::new(zero))
        .solver(GaussianElimination::new(&sensor).unwrap())
        .contact(surface, model)
        .friction(Coulomb::new(T::literal(0.6)).unwrap())
        .slip_detector(RatioThreshold::new(gate, T::literal(0.6), T::literal(0.75)).unwrap())
        .build();
    let samples: Vec<_> = signals_of_all_kinds(&sensor, 5).into_iter().map(|s| s + zero).collect();
    let sense_all = |samples: &[Vector6<T>]| {
        let raw: [Vec<T>; 6] = core::array::from_fn(|gauge| samples.iter().map(|s| s[gauge]).collect());
        let mut columns: [Vec<T>; 9] = core::array::from_fn(|_| vec![T::one(); samples.len()]);
        let mut slip = vec![SlipVerdict::Warning; samples.len()];
        let [px, py, pz, normal, tx, ty, tz, margin, utilisation] = columns.each_mut().map(|c| &mut c[..]);
        fingertip.sense_all(
            raw.each_ref().map(|column| &column[..]),
            Touches {
                point: [px, py, pz],
                normal_force: normal,
                tangential_force: [tx, ty, tz],
                margin,
                utilisation,
                slip: &mut slip,
            },
        );
        (columns, slip)
    };
    let (columns, slip) = sense_all(&samples);
    // Blocks in which all samples press go another way, with the same operations.
    let pressing: Vec<_> = (0..samples.len()).filter(|&k| columns[3][k] > T::zero()).collect();
    let alone = sense_all(&pressing.iter().map(|&k| samples[k]).collect::<Vec<_>>());
    for (index, &k) in pressing.iter().enumerate() {
        assert!((0..9).all(|column| alone.0[column][index] == columns[column][k]));
        assert_eq!(alone.1[index], slip[k]);
    }
    let (mut contacts, mut others) = (0, 0);
    for (k, sample) in samples.iter().enumerate() {
        let one = fingertip.sense(sample, T::literal(1e-3));
        let found: [f64; 9] = core::array::from_fn(|column| columns[column][k].to_f64());
        assert!(found.iter().all(|x| x.is_finite()), "{found:?}");
        let Some(contact) = one.resolution.contact() else {
            others += 1;
            assert_eq!(found[..8], [0.0; 8], "{one:?}");
            assert_eq!(slip[k], SlipVerdict::NotPressing);
            continue;
        };
        contacts += 1;
        // Both solve alike; a dozen roundings of foot and point follow, which grow as the reciprocal
        // cosine, and tangential and normal forces change with the normal.
        let (force, size) = (contact.contact_force(), contact.point.norm().to_f64());
        let tolerance = 40.0 * T::EPSILON.to_f64() / contact.incidence().to_f64();
        let newtons = contact.force.norm().to_f64() * tolerance;
        let SlipMargin { newtons: margin, utilisation } = one.grip.unwrap();
        for i in 0..3 {
            assert!((found[i] - contact.point[i].to_f64()).abs() <= size * tolerance, "{found:?} {one:?}");
            assert!((found[4 + i] - force.tangential[i].to_f64()).abs() <= newtons, "{found:?} {one:?}");
        }
        assert!((found[3] - force.normal.to_f64()).abs() <= newtons, "{found:?} {one:?}");
        assert!((found[7] - margin.to_f64()).abs() <= 2.0 * newtons, "{found:?} {one:?}");
        let used = utilisation.to_f64();
        let relative = newtons * (1.0 + 1.0 / used) / force.normal.to_f64();
        assert!((found[8] / used - 1.0).abs() <= 4.0 * relative, "{found:?} {one:?}");
        // Unless a ratio lies on a threshold.
        if (used - 1.0).abs() > 4.0 * relative && (used - 0.75).abs() > 4.0 * relative {
            assert_eq!(slip[k], one.slip, "{found:?} {one:?}");
        }
    }
    assert!(contacts > 100 && others > 100, "{contacts} contacts, {others} others");
}

#[test]
fn batches_are_as_single_samples() {
    fn on<T: Real>() {
        let l = T::literal;
        let model = PointContact::new(l(0.5)).unwrap();
        let centre = Vector3::new(l(1e-3), l(0.0), l(2e-3));
        many_at_once_are_as_one_at_a_time(Sphere::new(centre, l(0.009)).unwrap(), model);
        many_at_once_are_as_one_at_a_time(Sphere::centred(l(0.009)).unwrap(), model);
        let shape = Ellipsoid::new(Vector3::new(l(0.012), l(0.009), l(0.007))).unwrap();
        many_at_once_are_as_one_at_a_time(shape, model);
        let model = model.with_greatest_friction(l(1.2)).unwrap();
        many_at_once_are_as_one_at_a_time(shape, model);
    }
    on::<f32>();
    on::<f64>();
}
