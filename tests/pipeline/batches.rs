//! Many samples at once against one at a time.

use fingertip::contact::PointContact;
use fingertip::friction::{
    Coulomb, DropDetector, ForceNoise, NormalForceGate, PowerLimit, PressureDistribution, RatioThreshold,
    SlipMargin, SlipVerdict,
};
use fingertip::surfaces::{ActiveSurface, Ellipsoid, Sphere, Torus};
use fingertip::wrench::{Compensation, GaussianElimination, Real, SensorMatrix, Tare, Wrench};
use fingertip::{Fingertip, GripStage, SlipStage, Step, Touches};
use nalgebra::{Vector3, Vector6};

use crate::paper_sensor;

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
    S: ActiveSurface<T> + 'static,
{
    let sensor = paper_sensor::<T>();
    let zero = Vector6::from_fn(|gauge, _| T::literal(0.01) * T::literal(f64::from(gauge as u32)));
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(T::literal(0.01)).unwrap());
    let mut fingertip = Fingertip::builder()
        .zero(Tare::new(zero))
        .solver(GaussianElimination::new(&sensor).unwrap())
        .contact(surface, model)
        .friction(Coulomb::new(T::literal(0.6)).unwrap())
        .slip_detector(
            RatioThreshold::new(gate, T::literal(0.6)).unwrap().with_warning_share(T::literal(0.75)).unwrap(),
        )
        .build();
    let samples: Vec<_> = signals_of_all_kinds(&sensor, 5).into_iter().map(|s| s + zero).collect();
    let mut sense_all = |samples: &[Vector6<T>]| {
        let raw: [Vec<T>; 6] = core::array::from_fn(|gauge| samples.iter().map(|s| s[gauge]).collect());
        let mut columns: [Vec<T>; 9] = core::array::from_fn(|_| vec![T::one(); samples.len()]);
        let mut slip = vec![SlipVerdict::Warning; samples.len()];
        let [px, py, pz, normal, tx, ty, tz, margin, utilisation] = columns.each_mut().map(|c| &mut c[..]);
        fingertip.sense_all(
            raw.each_ref().map(|column| &column[..]),
            T::literal(1e-3),
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

/// Takes a share of every wrench off, without being told a motion.
#[derive(Clone, Copy)]
struct Share(f64);

impl Compensation<Wrench<f64>> for Share {
    type Raw = (Wrench<f64>, ());

    fn compensate(&self, (measured, ()): &(Wrench<f64>, ())) -> Wrench<f64> {
        *measured * self.0
    }
}

/// Columns that a batch wrote, by what was in them before.
fn batch<Payload, Surface, Friction, Detector>(
    mut fingertip: Batched<Payload, Surface, Friction, Detector>,
    samples: &[Vector6<f64>],
) -> ([Vec<f64>; 9], Vec<SlipVerdict>)
where
    Payload: Compensation<Wrench<f64>, Raw = (Wrench<f64>, ())> + 'static,
    Surface: ActiveSurface<f64> + 'static,
    Friction: GripStage<f64> + 'static,
    Detector: SlipStage<f64> + 'static,
{
    let raw: [Vec<f64>; 6] = core::array::from_fn(|gauge| samples.iter().map(|s| s[gauge]).collect());
    // The last of the columns is shorter by one.
    let mut columns: [Vec<f64>; 9] = core::array::from_fn(|_| vec![7.0; samples.len()]);
    let mut slip = vec![SlipVerdict::Warning; samples.len() - 1];
    let [px, py, pz, normal_force, tx, ty, tz, margin, utilisation] = columns.each_mut().map(|c| &mut c[..]);
    fingertip.sense_all(
        raw.each_ref().map(|column| &column[..]),
        1e-3,
        Touches {
            point: [px, py, pz],
            normal_force,
            tangential_force: [tx, ty, tz],
            margin,
            utilisation,
            slip: &mut slip,
        },
    );
    (columns, slip)
}

type Batched<Payload, Surface, Friction, Detector> = Fingertip<
    GaussianElimination<f64>,
    Surface,
    PointContact<f64>,
    Friction,
    Detector,
    Tare<f64, 6>,
    Payload,
>;

/// What a scene without a branchless loop answers is what it answers one by one, each knowing the last contact.
#[test]
fn any_scene_senses_many() {
    let sensor = paper_sensor::<f64>();
    let mut samples = signals_of_all_kinds(&sensor, 6);
    // Along −x through the middle of the ring: which side is meant depends on the sample before.
    let at = |point: Vector3<f64>, force: Vector3<f64>| sensor.signals(&Wrench::from_force_at(&point, force));
    for _ in 0..20 {
        samples.push(at(Vector3::new(0.0, 0.0, 4e-3), Vector3::new(-1.0, 0.0, -0.7)));
        samples.push(at(Vector3::zeros(), Vector3::new(-2.0, 0.0, 0.0)));
    }
    let zero = Vector6::repeat(0.01);
    let samples: Vec<_> = samples.into_iter().map(|s| s + zero).collect();
    let noise = ForceNoise::isotropic(0.01).unwrap();
    let base = Fingertip::builder()
        .zero(Tare::new(zero))
        .solver(GaussianElimination::new(&sensor).unwrap())
        .payload(Share(0.5))
        .contact(Torus::new(10e-3, 3e-3).unwrap(), PointContact::new(0.1).unwrap());
    let full = base
        .friction(PowerLimit::for_patch(0.6, 2e-3, PressureDistribution::Hertz).unwrap())
        .slip_detector(DropDetector::new(noise).unwrap())
        .build();
    let (columns, slip) = batch(full, &samples);
    let (bare_columns, bare_slip) = batch(base.build(), &samples);
    let (mut one, mut last, mut through) = (full, None, 0);
    for k in 0..samples.len() - 1 {
        let touch = one.sense(&samples[k], Step::of(1e-3).with_last(last));
        if touch.point().is_some_and(|point| point.x < -0.005) && last.is_some_and(|last| last.x < -0.005) {
            through += 1;
        }
        last = touch.point();
        let found: [f64; 9] = core::array::from_fn(|column| columns[column][k]);
        let expected = match (touch.point(), touch.force, touch.grip) {
            (Some(p), Some(force), Some(grip)) => {
                let t = force.tangential.vector();
                [p.x, p.y, p.z, force.normal, t.x, t.y, t.z, grip.newtons, grip.utilisation]
            }
            _ => [0.0; 9],
        };
        assert_eq!((found, slip[k]), (expected, touch.slip), "{k}: {touch:?}");
        let found: [f64; 9] = core::array::from_fn(|column| bare_columns[column][k]);
        assert_eq!(found[..7], expected[..7]);
        assert_eq!((found[7], found[8], bare_slip[k]), (0.0, 0.0, SlipVerdict::NotPressing));
    }
    assert!(through >= 19 && slip.iter().any(|verdict| *verdict != SlipVerdict::NotPressing), "{through}");
    for column in columns.iter().chain(&bare_columns) {
        assert_eq!(*column.last().unwrap(), 7.0);
    }
}

/// A payload that needs no motion is taken off in the branchless loop, too.
#[test]
fn a_payload_is_taken_off_every_sample_of_a_batch() {
    let sensor = paper_sensor::<f64>();
    let samples = signals_of_all_kinds(&sensor, 7);
    let gate = NormalForceGate::from_noise(&ForceNoise::isotropic(0.01).unwrap());
    let with = |share: f64| {
        let fingertip = Fingertip::builder()
            .zero(Tare::new(Vector6::zeros()))
            .solver(GaussianElimination::new(&sensor).unwrap())
            .payload(Share(share))
            .contact(Sphere::centred(0.009).unwrap(), PointContact::new(0.1).unwrap())
            .friction(Coulomb::new(0.6).unwrap())
            .slip_detector(RatioThreshold::new(gate, 0.6).unwrap().with_warning_share(0.75).unwrap())
            .build();
        batch(fingertip, &samples).0
    };
    let (all, half) = (with(1.0), with(0.5));
    let mut contacts = 0;
    for k in 0..samples.len() - 1 {
        if all[3][k] > 0.3 && all[3][k] < 100.0 {
            contacts += 1;
            assert_eq!(half[3][k], 0.5 * all[3][k]);
        }
    }
    assert!(contacts > 50, "{contacts}");
}

/// Columns have room for as many samples as the shortest, and one beyond it is not written.
#[test]
fn a_sample_is_put_where_there_is_room() {
    use fingertip::Touch;
    use fingertip::contact::{NoContact, Resolution};

    let mut columns = vec![vec![7.0; 3]; 9];
    let mut slip = [SlipVerdict::Warning; 2];
    let resolution = Resolution::NoContact(NoContact::NotFinite);
    let grip = Some(Some(SlipMargin { newtons: 0.25, utilisation: 0.5 }));
    let touch = Touch {
        wrench: Wrench::zero(),
        resolution,
        force: None,
        grip,
        slip: Some(SlipVerdict::Slipping),
        tracked: (),
    };
    let [px, py, pz, normal, tx, ty, tz, margin, utilisation] = &mut columns[..] else { unreachable!() };
    let mut touches = Touches {
        point: [px, py, pz],
        normal_force: normal,
        tangential_force: [tx, ty, tz],
        margin,
        utilisation,
        slip: &mut slip,
    };
    assert_eq!((touches.len(), touches.is_empty()), (2, false));
    touches.by_ref().put(1, &touch);
    touches.put(3, &touch);
    touches.slip = &mut [];
    assert_eq!((touches.len(), touches.is_empty()), (0, true));
    for (column, written) in columns.iter().zip([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.25, 0.5]) {
        assert_eq!(column[..], [7.0, written, 7.0]);
    }
    assert_eq!(slip, [SlipVerdict::Warning, SlipVerdict::Slipping]);
}
