//! Many samples at once against one at a time.

use fingertip::contact::PointContact;
use fingertip::contact::batch::BatchSurface;
use fingertip::friction::{Coulomb, ForceNoise, NormalForceGate, RatioThreshold, SlipMargin, SlipVerdict};
use fingertip::surfaces::{ActiveSurface, Ellipsoid, Sphere};
use fingertip::wrench::{GaussianElimination, Real, SensorMatrix, Tare, Wrench};
use fingertip::{Fingertip, Touches};
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
