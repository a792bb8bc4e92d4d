//! What is taken off readings, at the edges: few readings, readings that are none, ends of a range.

use fingertip_wrench::{
    BadTemperatureModel, Compensation, DummyGauge, DummyGaugeAccumulator, GaugesAndDummy,
    GaugesAndTemperature, Real, Tare, TareAccumulator, TareError, TemperatureCompensation, Uncompensated,
};
use nalgebra::SVector;

type Two<T> = SVector<T, 2>;

fn few_readings<T: Real>() {
    let l = T::literal;
    let mut rest = TareAccumulator::<T, 2>::default();
    assert_eq!((rest.samples(), *rest.mean()), (0, Two::zeros()));
    assert_eq!(rest.noise(), Err(TareError::TooFewSamples { samples: 0 }));
    assert!(rest.add(&Two::new(l(1.0), l(-4.0))));
    assert_eq!((rest.samples(), *rest.mean()), (1, Two::new(l(1.0), l(-4.0))));
    let one = TareError::TooFewSamples { samples: 1 };
    assert_eq!((rest.noise(), rest.finish()), (Err(one), Err(one)));
    // Two readings: their mean, and their difference over √2.
    assert!(rest.add(&Two::new(l(3.0), l(0.0))));
    let (tare, noise) = (rest.finish().expect("enough"), rest.noise().expect("enough"));
    assert_eq!(*tare.zero(), Two::new(l(2.0), l(-2.0)));
    let wanted = Two::new(l(2.0), l(4.0)).map(|x| x / l(2.0).root());
    assert!((noise - wanted).iter().all(|x| x.abs() <= T::EPSILON * l(4.0)));
    // What is no number changes nothing, whichever gauge it is.
    for gauge in 0..2 {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let before = rest;
            let mut reading = Two::repeat(T::one());
            reading[gauge] = l(bad);
            assert!(!rest.add(&reading));
            assert_eq!(rest, before);
        }
    }
    // Squares out of range leave a mean, and no noise; the gauge is named.
    let mut wide = TareAccumulator::<T, 2>::default();
    let huge = T::GREATEST.root() * l(4.0);
    for sign in [T::one(), -T::one()] {
        assert!(wide.add(&Two::new(l(1.0), huge * sign)));
    }
    assert_eq!(wide.noise(), Err(TareError::OutOfRange { gauge: 1 }));
    assert!(wide.finish().is_ok());
    // So does a mean that passes the range on its way.
    for sign in [T::one(), -T::one()] {
        assert!(wide.add(&Two::new(T::GREATEST * sign, T::one())));
    }
    assert!(matches!(wide.finish(), Err(TareError::OutOfRange { gauge: 0 })));
}

#[test]
fn tares_of_few_readings() {
    few_readings::<f32>();
    few_readings::<f64>();
}

#[test]
fn a_tare_is_subtracted() {
    let raw = Two::new(5.0, -1.0);
    assert_eq!(Tare::new(Two::new(2.0, -3.0)).compensate(&raw), Two::new(3.0, 2.0));
    assert_eq!(Uncompensated.compensate(&raw), raw);
}

#[test]
fn a_dummy_gauge_and_the_gauges_rest_together() {
    let reading = |gauges: [f64; 2], dummy: f64| GaugesAndDummy { gauges: Two::from(gauges), dummy };
    let mut rest = DummyGaugeAccumulator::default();
    assert!(rest.add(&reading([1.0, 2.0], 10.0)));
    assert_eq!(rest.finish(), Err(TareError::TooFewSamples { samples: 1 }));
    // A reading of which one part is none leaves no part behind.
    assert!(!rest.add(&reading([f64::NAN, 2.0], 1e6)));
    assert!(!rest.add(&reading([1e6, 1e6], f64::INFINITY)));
    assert!(rest.add(&reading([3.0, 6.0], 14.0)));
    let found = rest.finish().expect("enough");
    assert_eq!(found, DummyGauge::new(Tare::new(Two::new(2.0, 4.0)), 12.0));
    // Warmer by 3 at the dummy; the gauges feel one and half of it.
    let raw = reading([8.0, 8.0], 15.0);
    assert_eq!(found.compensate(&raw), Two::new(3.0, 1.0));
    assert_eq!(found.with_ratios(Two::new(1.0, 0.5)).compensate(&raw), Two::new(3.0, 2.5));
}

fn model(
    reference: f64,
    range: (f64, f64),
    zero: [[f64; 2]; 2],
    sensitivity: [[f64; 2]; 2],
) -> Result<TemperatureCompensation<f64, 2, 2>, BadTemperatureModel> {
    TemperatureCompensation::new(reference, range, zero.map(Two::from), sensitivity.map(Two::from))
}

const NONE: [[f64; 2]; 2] = [[0.0; 2]; 2];

#[test]
fn temperatures_at_the_ends_of_their_range() {
    let drift = [[1.0, 2.0], [0.5, -0.25]];
    let found = model(20.0, (10.0, 30.0), drift, [[0.01, 0.0], [0.0, 0.001]]).expect("a model");
    let at = |temperature| {
        let gauges = Two::new(8.0, 8.0);
        found.compensate(&GaugesAndTemperature { gauges, temperature })
    };
    // (8 − 1 − 0.5 ΔT)/(1 + 0.01 ΔT), (8 − 2 + 0.25 ΔT)/(1 + 0.001 ΔT²).
    for (temperature, wanted) in [
        (20.0, [7.0, 6.0]),
        (30.0, [2.0 / 1.1, 8.5 / 1.1]),
        (10.0, [12.0 / 0.9, 3.5 / 1.1]),
        (26.0, [4.0 / 1.06, 7.5 / 1.036]),
        (30.0 + 1e-9, [2.0 / 1.1, 8.5 / 1.1]),
        (10.0 - 1e-9, [12.0 / 0.9, 3.5 / 1.1]),
    ] {
        let off = at(temperature) - Two::from(wanted);
        assert!(off.iter().all(|x| x.abs() < 1e-14), "{temperature}: {off}");
    }
    let covered = [10.0 - 1e-9, 10.0, 20.0, 30.0, 30.0 + 1e-9, f64::NAN].map(|t| found.covers(t));
    assert_eq!(covered, [false, true, true, true, false, false]);
}

#[test]
fn temperature_models_that_are_none() {
    let bad_range = Some(BadTemperatureModel::BadRange);
    for reference_and_range in [
        (9.0, (10.0, 30.0)),
        (31.0, (10.0, 30.0)),
        (20.0, (30.0, 10.0)),
        (f64::NAN, (10.0, 30.0)),
        (20.0, (f64::NAN, 30.0)),
        (20.0, (10.0, f64::NAN)),
        (20.0, (f64::NEG_INFINITY, 30.0)),
        (20.0, (10.0, f64::INFINITY)),
        (f64::INFINITY, (10.0, f64::INFINITY)),
    ] {
        let (reference, range) = reference_and_range;
        assert_eq!(model(reference, range, NONE, NONE).err(), bad_range, "{reference_and_range:?}");
    }
    for (reference, range) in [(10.0, (10.0, 30.0)), (30.0, (10.0, 30.0)), (20.0, (20.0, 20.0))] {
        assert!(model(reference, range, NONE, NONE).is_ok());
    }
    for gauge in 0..2 {
        for power in 0..2 {
            for bad in [f64::NAN, f64::INFINITY] {
                let mut terms = NONE;
                terms[power][gauge] = bad;
                let refused = Some(BadTemperatureModel::NotFinite { gauge });
                assert_eq!(model(20.0, (10.0, 30.0), terms, NONE).err(), refused);
                assert_eq!(model(20.0, (10.0, 30.0), NONE, terms).err(), refused);
            }
        }
    }
    // |a| d + |b| d² must stay below 1 at the farther end, 10 K away on either side.
    for range in [(10.0, 25.0), (15.0, 30.0)] {
        for gauge in 0..2 {
            let vanishes = Some(BadTemperatureModel::SensitivityVanishes { gauge });
            for (a, b, refused) in [
                (0.0999, 0.0, None),
                (-0.0999, 0.0, None),
                (0.1, 0.0, vanishes),
                (-0.1001, 0.0, vanishes),
                (0.0, 0.00999, None),
                (0.0, -0.01001, vanishes),
                (0.05, 0.00499, None),
                (0.05, -0.00501, vanishes),
            ] {
                let mut terms = NONE;
                (terms[0][gauge], terms[1][gauge]) = (a, b);
                assert_eq!(model(20.0, range, NONE, terms).err(), refused, "{a} {b}");
            }
        }
    }
}
