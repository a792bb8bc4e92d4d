//! The steepness that a formula states of itself, against dense sampling.

use fingertip_surfaces::*;
use fingertip_wrench::{Line, Real};
use nalgebra::Vector3;
use proptest::prelude::*;

/// A formula, in a ball about the origin.
struct Written<F> {
    formula: F,
    radius: f64,
    steepest: Option<f64>,
}

impl<T: Real, F: Fn([Term<T>; 3]) -> Term<T>> ImplicitSurface<T> for Written<F> {
    fn formula(&self, point: [Term<T>; 3]) -> Term<T> {
        (self.formula)(point)
    }

    fn ball(&self) -> (Vector3<T>, T) {
        (Vector3::zeros(), T::literal(self.radius))
    }

    fn steepest(&self) -> Option<T> {
        self.steepest.map(T::literal)
    }
}

fn written<F: Fn([Term<f64>; 3]) -> Term<f64>>(formula: F, radius: f64) -> Written<F> {
    Written { formula, radius, steepest: None }
}

/// The greatest gradient at points all over the ball, by the formula's own derivative and by differences of it;
/// where the value is within `below` only.
fn sampled<S: ImplicitSurface<f64>>(surface: &S, below: f64) -> f64 {
    let (centre, radius) = surface.ball();
    let mut steepest = 0.0_f64;
    let count = 8;
    for i in -count..=count {
        for j in -count..=count {
            for k in -count..=count {
                let point = centre + Vector3::new(i, j, k).map(f64::from) * (radius / f64::from(count));
                if (point - centre).norm() > radius || surface.value(&point).abs() > below {
                    continue;
                }
                let gradient = surface.gradient(&point);
                steepest = steepest.max(gradient.norm());
                let step = radius * 1e-6;
                let across = |axis: Vector3<f64>| {
                    let [ahead, behind] =
                        [point + axis * step, point - axis * step].map(|p| surface.value(&p));
                    (ahead - behind) / (2.0 * step)
                };
                let differences =
                    Vector3::new(across(Vector3::x()), across(Vector3::y()), across(Vector3::z()));
                // An edge, where the gradient jumps, lies between the two places.
                let apart = (differences - gradient).norm();
                assert!(apart <= 1e-4 * gradient.norm().max(1.0) || apart > 1e-2, "{point:?}");
            }
        }
    }
    steepest
}

/// All below a height, in a ball about a place far from the origin.
struct Ground;

impl ImplicitSurface<f64> for Ground {
    fn formula(&self, [_, _, z]: [Term<f64>; 3]) -> Term<f64> {
        z - 3.0
    }

    fn ball(&self) -> (Vector3<f64>, f64) {
        (Vector3::new(10.0, 20.0, 3.0), 1.0)
    }
}

#[test]
fn what_is_inside_is_in_the_ball_and_below() {
    let ground = Implicit::new(Ground).unwrap();
    for (place, is_inside) in [
        ([10.0, 20.0, 2.5], true),
        ([10.0, 20.0, 3.5], false),
        ([10.0, 20.9, 2.9], true),
        ([10.0, 21.1, 2.9], false),
        ([-10.0, -20.0, -3.0], false),
        ([0.0, 0.0, 0.0], false),
    ] {
        assert_eq!(ground.contains(&Vector3::from(place)), is_inside, "{place:?}");
    }
}

/// No sample is steeper than what is stated, nor is it stated steeper than `excess` times.
fn check<F: Fn([Term<f64>; 3]) -> Term<f64>>(formula: F, radius: f64, excess: f64) {
    let surface = Implicit::new(written(formula, radius)).unwrap();
    let (stated, seen) = (surface.steepest(), sampled(surface.inner(), f64::INFINITY));
    assert!(seen <= stated && stated <= seen * excess, "{seen} seen, {stated} stated");
}

#[test]
fn no_sample_is_steeper_than_the_formula_says() {
    check(|[x, y, z]| x.square() + y.square() + z.square() - 1.0, 1.1, 1.5);
    check(|[x, y, z]| x.powi(4) + y.powi(4) + z.powi(4) - 1.0, 1.32, 1.8);
    check(|[x, y, z]| (x / 0.01).square() + (y / 0.01).square() + (z / 0.014).powi(4) - 1.0, 0.0172, 1.8);
    check(|[x, y, z]| x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos(), 3.0, 3.0);
    check(|[x, y, z]| (x.square() * -2.0).exp() * 2.0 + y.square() + z.square() - 1.5, 1.5, 2.0);
    check(|[x, y, z]| (x.square() + y.square() + 0.5).sqrt() + z.abs() * 0.3 - 1.0, 1.5, 1.6);
    check(|[x, y, z]| (2.0 - x) / (y.square() + 1.0) + z.powi(3) * 0.1 - 1.0, 1.5, 2.5);
    check(|[x, y, z]| Term::length([x, y]).max(z - 0.3) - 1.0, 1.5, 1.8);
    check(|[x, y, z]| Term::length([x - 0.4, y, z]).min(Term::length([x + 0.4, y, z])) - 0.5, 1.0, 1.8);
    check(|[x, y, z]| x.through([-2.0, 2.0], [-1.0, 1.0]) + y * z * 3.0 + x.powi(0), 1.0, 2.5);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Of random polynomials of third degree with a wave on them.
    #[test]
    fn nor_of_random_formulas(c in prop::array::uniform10(-2.0_f64..2.0), radius in 0.01_f64..4.0) {
        let formula = move |[x, y, z]: [Term<f64>; 3]| {
            let cubic = x * x * y * c[0] + y.powi(3) * c[1] + z * x * y * c[2] + z.square() * x * c[3];
            let square = x.square() * c[4] + y * z * c[5] + z.square() * c[6];
            cubic + square + (x * c[7] + y).sin() * c[8] + z * c[9] + 0.1
        };
        let surface = Implicit::new(written(formula, radius)).unwrap();
        let (stated, seen) = (surface.steepest(), sampled(surface.inner(), f64::INFINITY));
        prop_assert!(seen <= stated, "{seen} seen, {stated} stated");
    }

    /// What a term says of a box holds at every point of it.
    #[test]
    fn ranges_hold_every_value(low in prop::array::uniform3(-3.0_f64..3.0), size in prop::array::uniform3(0.0_f64..3.0), at in prop::array::uniform3(0.0_f64..1.0)) {
        let formula = |[x, y, z]: [Term<f64>; 3]| {
            [x.sin(), y.cos(), x.powi(2) - y.powi(3), x.powi(-1), z.exp(), x.abs() * y, x.square().sqrt(), Term::length([x, y, z]), x.min(y).max(z), x / z, 1.0 - z]
        };
        let over = formula(Term::over([0, 1, 2].map(|k| [low[k], low[k] + size[k]])));
        let point = formula(Term::at([0, 1, 2].map(|k| low[k] + size[k] * at[k])));
        for (k, (over, point)) in over.iter().zip(point).enumerate() {
            let ([low, high], [value, same]) = (over.range(), point.range());
            prop_assert_eq!(value, same);
            let hair = 1e-12 * (1.0 + value.abs());
            prop_assert!(low - hair <= value && value <= high + hair, "{}: {} in {} to {}", k, value, low, high);
        }
    }
}

/// The slope of a distance has no bound at its centre, far from the surface: nothing is lost by that.
#[test]
fn a_root_that_is_zero_away_from_the_surface_does_no_harm() {
    let ball =
        Implicit::new(written(|[x, y, z]| (x.square() + y.square() + z.square()).sqrt() - 1.0, 1.1)).unwrap();
    let seen = sampled(ball.inner(), 0.5);
    assert!(seen <= ball.steepest() && ball.steepest() < 10.0, "{seen} {}", ball.steepest());
    let sphere = Sphere::centred(1.0).unwrap();
    for k in 0..200 {
        let (height, turn) = (f64::from(k) * 0.009, f64::from(k));
        let direction = Vector3::new(turn.cos(), turn.sin(), 0.0);
        let line = Line { point: Vector3::new(0.0, 0.0, height - 0.9), direction };
        let [mut found, mut expected] = [Vec::new(), Vec::new()];
        ball.crossings(&line, |crossing| found.push(crossing.point));
        sphere.crossings(&line, |crossing| expected.push(crossing.point));
        assert_eq!(found.len(), expected.len(), "{height}");
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).norm() < 1e-14));
    }
}

#[test]
fn a_steepness_without_a_bound_on_the_surface_and_one_that_is_exceeded_are_refused() {
    let root = written(|[x, y, z]| (x.square() + y.square()).sqrt() + z, 1.0);
    let error = Implicit::new(root).err().unwrap().to_string();
    assert!(
        error.contains("of an implicit surface must be known") && error.contains("`steepest`"),
        "{error}"
    );
    let stated = |steepest| {
        let formula = |[x, y, z]: [Term<f64>; 3]| x.powi(4) + y.powi(4) + z.powi(4) - 1.0;
        Implicit::new(Written { formula, radius: 1.32, steepest: Some(steepest) })
    };
    assert_eq!(stated(9.3).unwrap().steepest(), 9.3);
    for wrong in [3.0, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = stated(wrong).err().unwrap().to_string();
        assert!(error.contains("steepness"), "{error}");
    }
    assert!(Implicit::new(written(|[x, y, z]| x + y + z, f64::NAN)).is_err());
    assert!(Implicit::new(written(|[x, _, _]| x * 0.0, 1.0)).is_err());
}

/// A term at a point is the number that the formula gives there, and its derivatives by hand.
#[test]
fn terms_at_a_point_are_numbers_and_their_slopes() {
    let (a, b, c) = (0.7_f64, -0.4_f64, 1.3_f64);
    let at = |formula: &dyn Fn([Term<f64>; 3]) -> Term<f64>| {
        let surface = written(formula, 2.0);
        let point = Vector3::new(a, b, c);
        (surface.value(&point), surface.gradient(&point))
    };
    type Formula = fn([Term<f64>; 3]) -> Term<f64>;
    let length = (a * a + b * b).sqrt();
    let cases: [(&str, Formula, f64, [f64; 3]); 14] = [
        ("negative", |[x, _, _]| -x, -a, [-1.0, 0.0, 0.0]),
        ("sum", |[x, y, z]| x + y + z + 2.0, a + b + c + 2.0, [1.0, 1.0, 1.0]),
        ("difference", |[x, y, _]| x - y - 2.0, a - b - 2.0, [1.0, -1.0, 0.0]),
        ("from a number", |[x, _, _]| 2.0 - x, 2.0 - a, [-1.0, 0.0, 0.0]),
        ("product", |[x, y, _]| x * y * 3.0, a * b * 3.0, [3.0 * b, 3.0 * a, 0.0]),
        ("quotient", |[x, y, _]| x / y, a / b, [1.0 / b, -a / (b * b), 0.0]),
        ("by a number", |[x, _, _]| x / 4.0, a / 4.0, [0.25, 0.0, 0.0]),
        ("power", |[_, y, _]| y.powi(3), b.powi(3), [0.0, 3.0 * b * b, 0.0]),
        ("absolute", |[_, y, _]| y.abs(), -b, [0.0, -1.0, 0.0]),
        ("larger", |[x, y, _]| x.max(y), a, [1.0, 0.0, 0.0]),
        ("smaller", |[x, y, _]| x.min(y), b, [0.0, 1.0, 0.0]),
        ("waves", |[x, y, _]| x.sin() + y.cos(), a.sin() + b.cos(), [a.cos(), -b.sin(), 0.0]),
        ("growth", |[_, _, z]| z.exp() + z.sqrt(), c.exp() + c.sqrt(), [0.0, 0.0, c.exp() + 0.5 / c.sqrt()]),
        ("length", |[x, y, _]| Term::length([x, y]), length, [a / length, b / length, 0.0]),
    ];
    for (name, formula, value, slopes) in cases {
        let (found, gradient) = at(&formula);
        assert!((found - value).abs() < 1e-14, "{name}: {found}, not {value}");
        assert!((gradient - Vector3::from(slopes)).amax() < 1e-14, "{name}: {gradient}, not {slopes:?}");
    }
    // On the fold of an absolute value it is the mean of both sides; of two equal terms the first is the larger.
    let fold = written(|[x, y, _]: [Term<f64>; 3]| x.abs() + x + y, 1.0);
    assert_eq!(fold.gradient(&Vector3::zeros()), Vector3::new(1.0, 1.0, 0.0));
    let edge = written(|[x, y, _]: [Term<f64>; 3]| x.max(y * 3.0), 1.0);
    assert_eq!(edge.gradient(&Vector3::zeros()), Vector3::x());
}

/// Of monotone stretches a range has the values at the ends, and reaches one where it passes a crest.
#[test]
fn ranges_of_waves_end_where_the_waves_do() {
    let crests = |low: f64, high: f64, crest: f64| {
        let turn = core::f64::consts::TAU;
        ((low - crest) / turn).ceil() <= ((high - crest) / turn).floor()
    };
    for k in 0..400 {
        let low = f64::from(k) * 0.06 - 12.0;
        for width in [0.01, 0.3, 1.0, 2.5] {
            let high = low + width;
            let [x, ..] = Term::over([[low, high], [0.0; 2], [0.0; 2]]);
            for (found, ends, top) in [
                (x.sin().range(), [low.sin(), high.sin()], core::f64::consts::FRAC_PI_2),
                (x.cos().range(), [low.cos(), high.cos()], 0.0),
            ] {
                let greatest = if crests(low, high, top) { 1.0 } else { ends[0].max(ends[1]) };
                let least =
                    if crests(low, high, top + core::f64::consts::PI) { -1.0 } else { ends[0].min(ends[1]) };
                assert!((found[0] - least).abs() < 1e-12, "{low} to {high}: {found:?}, not {least}");
                assert!((found[1] - greatest).abs() < 1e-12, "{low} to {high}: {found:?}, not {greatest}");
            }
        }
    }
}

/// Where a formula has no gradient, the way from the middle of the ball is as good a normal as any.
#[test]
fn without_a_gradient_the_normal_leads_out_of_the_ball() {
    struct Shifted;
    impl ImplicitSurface<f64> for Shifted {
        fn formula(&self, [x, y, z]: [Term<f64>; 3]) -> Term<f64> {
            (x - 1.0).powi(4) + y.powi(4) + z.powi(4) - 1.0
        }
        fn ball(&self) -> (Vector3<f64>, f64) {
            (Vector3::new(1.0, 0.1, 0.0), 1.5)
        }
    }
    let surface = Implicit::new(Shifted).unwrap();
    assert_eq!(surface.normal(&Vector3::new(1.0, 0.0, 0.0)), -Vector3::y());
    assert_eq!(surface.normal(&Vector3::new(2.0, 0.0, 0.0)), Vector3::x());
}
