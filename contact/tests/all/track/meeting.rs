//! Lines of several wrenches meet in a contact that rests, and it is told whether they do.

use fingertip_contact::{LineMeeting, Met, NoMeeting, WrenchSpread};
use fingertip_wrench::Wrench;
use nalgebra::{Matrix3, Matrix6, Vector3};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

const FORCE_NOISE: f64 = 5e-3;
const TORQUE_NOISE: f64 = 5e-5;
const NOISE: WrenchSpread<'static, f64> =
    WrenchSpread::Isotropic { force: FORCE_NOISE * FORCE_NOISE, torque: TORQUE_NOISE * TORQUE_NOISE };

struct Contact {
    random: Pcg64Mcg,
    /// How far forces lean to the sides, of 1 N.
    lean: f64,
}

impl Contact {
    fn wrench(&mut self, at: Vector3<f64>) -> Wrench<f64> {
        let mut side = || self.random.random_range(-self.lean..=self.lean);
        let force = Vector3::new(side(), side(), -1.0);
        let mut noise = |size: f64| Vector3::from_fn(|_, _| StandardNormal.sample(&mut self.random)) * size;
        Wrench::from_force_at(&at, force) + Wrench::on_fingertip(noise(FORCE_NOISE), noise(TORQUE_NOISE))
    }

    fn meeting(&mut self, count: u32, at: impl Fn(u32) -> Vector3<f64>) -> Result<Met<f64>, NoMeeting<f64>> {
        let mut meeting = LineMeeting::new();
        for k in 0..count {
            assert!(meeting.add(&self.wrench(at(k)), NOISE));
        }
        assert_eq!(meeting.count(), count);
        meeting.find()
    }
}

/// The error is as large as is said, without bias, and lines that meet are seldom refused.
#[test]
fn the_error_is_as_large_as_is_said() {
    let place = Vector3::new(0.005, -0.003, 0.011);
    let (mut normalised, mut sum, mut excess, runs) = (0.0, Vector3::zeros(), 0.0, 500);
    let mut covariance = Matrix3::zeros();
    for seed in 0..runs {
        let mut contact = Contact { random: Pcg64Mcg::seed_from_u64(seed), lean: 0.3 };
        let met = contact.meeting(200, |_| place).unwrap();
        let error = met.point - place;
        normalised += error.dot(&(met.covariance.try_inverse().unwrap() * error));
        covariance += met.covariance / runs as f64;
        sum += error;
        excess += met.excess;
    }
    let (count, mean) = (runs as f64, sum / runs as f64);
    // χ² of three degrees of freedom: a mean of 3, a variance of 6.
    assert!((normalised / count - 3.0).abs() < 4.0 * (6.0 / count).sqrt(), "{}", normalised / count);
    assert!((excess / count).abs() < 4.0 / count.sqrt(), "{}", excess / count);
    for axis in 0..3 {
        let deviation = (covariance[(axis, axis)] / count).sqrt();
        assert!(mean[axis].abs() < 4.0 * deviation, "{mean} {deviation}");
    }
}

/// Least squares by brute force: the sum of squared distances of the lines, each weighted by its force, is least there.
#[test]
fn no_place_nearby_is_nearer_to_all_lines() {
    let place = Vector3::new(0.005, -0.003, 0.011);
    let mut contact = Contact { random: Pcg64Mcg::seed_from_u64(4), lean: 0.5 };
    let wrenches: Vec<_> = (0..50).map(|_| contact.wrench(place)).collect();
    // Noise of the torque alone, so that nothing is taken off.
    let noise = WrenchSpread::Isotropic { force: 0.0, torque: 1e-6 };
    let mut meeting = LineMeeting::new();
    wrenches.iter().for_each(|wrench| assert!(meeting.add(wrench, noise)));
    let met = meeting.find().unwrap();
    let cost = |x: Vector3<f64>| -> f64 {
        wrenches
            .iter()
            .map(|wrench| {
                let (f, m) = (wrench.force(), wrench.torque());
                let left = m - x.cross(&f);
                (left - f * (f.dot(&left) / f.norm_squared())).norm_squared()
            })
            .sum()
    };
    let best = cost(met.point);
    for axis in 0..3 {
        for way in [-1e-6, 1e-6] {
            assert!(cost(met.point + Vector3::ith(axis, way)) > best);
        }
    }
}

#[test]
fn what_does_not_meet_is_refused() {
    let place = Vector3::new(0.005, -0.003, 0.011);
    let contact = |lean: f64| Contact { random: Pcg64Mcg::seed_from_u64(8), lean };
    assert_eq!(contact(0.3).meeting(1, |_| place), Err(NoMeeting::TooFew(1)));
    assert_eq!(contact(0.0).meeting(200, |_| place), Err(NoMeeting::Parallel));
    // It moves by a millimetre.
    let moving = contact(0.3).meeting(200, |k| place + Vector3::x() * (f64::from(k) * 5e-6));
    assert!(matches!(moving, Err(NoMeeting::Apart { excess }) if excess > 5.0), "{moving:?}");
    // Two contacts in turn.
    let two = contact(0.3).meeting(200, |k| if k % 2 == 0 { place } else { -place });
    assert!(matches!(two, Err(NoMeeting::Apart { .. })), "{two:?}");
}

#[test]
fn a_full_covariance_counts_as_it_is() {
    let place = Vector3::new(0.005, -0.003, 0.011);
    let diagonal = nalgebra::Vector6::new(1.0, 1.0, 1.0, 1e-4, 1e-4, 1e-4) * 2.5e-5;
    let full = Matrix6::from_diagonal(&diagonal);
    let mut meetings = [LineMeeting::new(); 3];
    let mut contact = Contact { random: Pcg64Mcg::seed_from_u64(8), lean: 0.3 };
    for _ in 0..30 {
        let wrench = contact.wrench(place);
        meetings[0].add(&wrench, &full);
        meetings[1].add(&wrench, WrenchSpread::Independent(diagonal));
        meetings[2].add(&wrench, WrenchSpread::Isotropic { force: 2.5e-5, torque: 2.5e-9 });
    }
    assert_eq!(meetings[0].find(), meetings[1].find());
    assert_eq!(meetings[0].find(), meetings[2].find());
    meetings[0].reset();
    assert_eq!(meetings[0], LineMeeting::default());
}

proptest! {
    #[test]
    fn any_bits_of_wrench_and_noise(all in proptest::collection::vec(any::<[u32; 8]>(), 1..20)) {
        let mut meeting = LineMeeting::<f32>::new();
        let good = WrenchSpread::Isotropic { force: 1e-6, torque: 1e-10 };
        for bits in all {
            let [a, b, c, d, e, f, force, torque] = bits.map(f32::from_bits);
            let wrench = Wrench::on_fingertip(Vector3::new(a, b, c), Vector3::new(d, e, f));
            meeting.add(&wrench, WrenchSpread::Isotropic { force, torque });
            meeting.add(&wrench, good);
            if let Ok(met) = meeting.find() {
                prop_assert!(met.point.iter().chain(met.covariance.iter()).all(|x| x.is_finite()));
                prop_assert!(met.excess.is_finite());
            }
        }
    }
}
