//! Touch, release and blow: how soon, and how often by mistake.

use core::f64::consts::PI;

use fingertip_contact::{ContactEvents, Happened, Impact};
use nalgebra::Vector3;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

const NOISE: f64 = 0.01;
const LEAST: f64 = 0.06;

struct Sensor {
    random: Pcg64Mcg,
    events: ContactEvents<f64>,
}

impl Sensor {
    fn new(seed: u64, samples: f64) -> Self {
        let events = ContactEvents::new(NOISE, LEAST, samples).unwrap();
        Self { random: Pcg64Mcg::seed_from_u64(seed), events }
    }

    /// A force in some direction, with noise, 1 ms after the one before.
    fn feel(&mut self, force: f64) -> Happened<f64> {
        let noise: Vector3<f64> = Vector3::from_fn(|_, _| StandardNormal.sample(&mut self.random));
        self.events.observe(&(Vector3::new(0.6, 0.0, -0.8) * force + noise * NOISE), 1e-3)
    }
}

/// False touches at rest, and false releases of the smallest touch, are rarer than was asked for.
#[test]
fn false_events_are_rarer_than_asked_for() {
    let (asked, samples) = (1000.0, 300_000);
    let mut sensor = Sensor::new(1, asked);
    let mut false_touches = 0;
    for _ in 0..samples {
        if sensor.feel(0.0).touch.is_some() {
            false_touches += 1;
            sensor.events.reset();
        }
    }
    let mut false_releases = 0;
    for _ in 0..samples {
        if sensor.feel(LEAST).release.is_some() {
            false_releases += 1;
        }
    }
    assert!((1..=300).contains(&false_touches), "{false_touches}");
    assert!(false_releases <= 300, "{false_releases}");
}

/// The stronger the touch, the sooner; and the onset is told within two samples.
#[test]
fn events_are_called_as_soon_as_the_noise_allows() {
    let mean_delays = |force: f64| {
        let (mut touch, mut release, runs) = (0.0, 0.0, 200);
        for seed in 0..runs {
            let mut sensor = Sensor::new(seed, 1e6);
            for _ in 0..50 {
                assert!(!sensor.feel(0.0).touching);
            }
            let (delay, since) =
                (1..100).find_map(|k| sensor.feel(force).touch.map(|since| (k, since))).unwrap();
            touch += f64::from(delay);
            assert!((f64::from(delay) * 1e-3 - since).abs() < 4.1e-3, "{delay} {since}");
            for _ in 0..50 {
                assert!(sensor.feel(force).touching);
            }
            release += f64::from((1..100).find(|_| sensor.feel(0.0).release.is_some()).unwrap());
        }
        (touch / runs as f64, release / runs as f64)
    };
    let (touch, release) = mean_delays(LEAST);
    assert!(touch < 4.0 && release < 16.0, "{touch} {release}");
    let (touch, release) = mean_delays(0.2);
    assert!(touch < 1.1 && release < 16.0, "{touch} {release}");
}

/// However slowly the force rises and falls, it touches once and lets go once.
#[test]
fn a_slow_press_is_one_touch() {
    for seed in 0..50 {
        let mut sensor = Sensor::new(seed, 1e6);
        let (mut touches, mut releases) = (0, 0);
        for k in 0..8000 {
            let happened = sensor.feel(2.0 * LEAST * (PI * f64::from(k) / 8000.0).sin());
            touches += u32::from(happened.touch.is_some());
            releases += u32::from(happened.release.is_some());
            assert!(happened.impact.is_none());
        }
        for _ in 0..100 {
            releases += u32::from(sensor.feel(0.0).release.is_some());
        }
        assert_eq!((touches, releases), (1, 1), "{seed}");
    }
}

/// A blow of half a sine, and what stays afterwards.
fn blow(sensor: &mut Sensor, peak: f64, samples: u32, hold: f64) -> Option<Impact<f64>> {
    for _ in 0..20 {
        sensor.feel(0.0);
    }
    let mut found = None;
    for k in 0..200 {
        let pulse = if k < samples { peak * (PI * f64::from(k) / f64::from(samples)).sin() } else { 0.0 };
        let happened = sensor.feel(pulse + if k > samples / 2 { hold.min(peak) } else { 0.0 }.min(peak));
        if let Some(impact) = happened.impact {
            assert!(found.is_none());
            found = Some(impact);
        }
    }
    found
}

#[test]
fn a_blow_tells_its_peak_and_impulse() {
    for seed in 0..50 {
        let mut sensor = Sensor::new(seed, 1e6);
        let impact = blow(&mut sensor, 5.0, 20, 0.0).unwrap();
        assert!((impact.peak - 5.0).abs() < 0.06, "{impact:?}");
        // Of half a sine, 2/π of peak times duration.
        let exact = 5.0 * 20e-3 * 2.0 / PI;
        let along = impact.impulse.dot(&Vector3::new(0.6, 0.0, -0.8));
        assert!((along / exact - 1.0).abs() < 0.02, "{impact:?} {exact}");
        assert!((impact.impulse.norm() - along).abs() < 1e-3 * along);
        assert!((impact.duration - 20e-3).abs() < 6e-3, "{impact:?}");
        assert!(!sensor.events.is_touching());
    }
}

/// After a blow something may stay in touch: its weight is not part of the blow.
#[test]
fn what_stays_after_a_blow_is_not_part_of_it() {
    let mut sensor = Sensor::new(3, 1e6);
    let impact = blow(&mut sensor, 5.0, 20, 0.3).unwrap();
    assert!(sensor.events.is_touching());
    assert!(impact.duration < 50e-3 && impact.impulse.norm() < 5.0 * 20e-3 * 2.0 / PI * 1.15, "{impact:?}");
}

#[test]
fn a_press_is_no_blow() {
    let mut sensor = Sensor::new(3, 1e6);
    assert!(blow(&mut sensor, 5.0, 150, 0.0).is_none());
    let mut patient = Sensor::new(3, 1e6);
    patient.events = patient.events.with_longest_impact(0.2).unwrap();
    assert!(blow(&mut patient, 5.0, 150, 0.0).is_some());
}

fn is_sound(happened: &Happened<f32>) -> bool {
    let impact = happened.impact.is_none_or(|impact| {
        impact.peak.is_finite() && impact.duration.is_finite() && impact.impulse.iter().all(|x| x.is_finite())
    });
    impact && happened.touch.is_none_or(f32::is_finite) && happened.release.is_none_or(f32::is_finite)
}

proptest! {
    #[test]
    fn any_bits_of_force_and_time(samples in proptest::collection::vec(any::<[u32; 4]>(), 40)) {
        let mut events = ContactEvents::new(0.01_f32, 0.06, 1e6).unwrap();
        for bits in samples {
            let [x, y, z, time] = bits.map(f32::from_bits);
            prop_assert!(is_sound(&events.observe(&Vector3::new(x, y, z), time)));
        }
        // It still works.
        for _ in 0..40 {
            events.observe(&Vector3::zeros(), 1e-3);
        }
        prop_assert!(!events.is_touching());
        events.observe(&Vector3::new(0.0, 0.0, -1.0), 1e-3);
        prop_assert!(events.is_touching());
    }
}

#[test]
fn settings_out_of_range_are_named() {
    let message = |noise: f64, least: f64, samples: f64| {
        ContactEvents::new(noise, least, samples).unwrap_err().to_string()
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(message(bad, 0.1, 1e6), "the noise of events of a contact must be positive and finite");
        assert_eq!(
            message(0.1, bad, 1e6),
            "the least force of events of a contact must be positive and finite"
        );
        let events = ContactEvents::new(0.01, 0.1, 1e6).unwrap();
        let error = events.with_longest_impact(bad).unwrap_err().to_string();
        assert_eq!(error, "the longest impact of events of a contact must be positive and finite");
    }
    let expected = "the samples between false ones of events of a contact must be finite and more than one";
    for bad in [1.0, 0.0, f64::NAN, f64::INFINITY] {
        assert_eq!(message(0.01, 0.1, bad), expected);
    }
    let odd = "the least force over its noise of events of a contact must be of ordinary size";
    assert_eq!(message(1e-200, 1e200, 1e6), odd);
    assert_eq!(message(1e200, 1e-200, 1e6), odd);
}
