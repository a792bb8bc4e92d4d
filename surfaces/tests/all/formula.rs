//! Formulas that files bring, against what their steps give one by one.

use fingertip_surfaces::{Formula, FormulaStep, Implicit, ImplicitSurface, SmoothSurface, Topology};
use fingertip_wrench::Real;
use nalgebra::Vector3;

use FormulaStep::{
    Abs, Add, Coordinate, Cos, Divide, Exp, Max, Min, Multiply, Negate, Number, Power, Sin, Sqrt, Subtract,
};

const X: FormulaStep<f64> = Coordinate(0);
const Y: FormulaStep<f64> = Coordinate(1);
const Z: FormulaStep<f64> = Coordinate(2);

fn formula(steps: &[FormulaStep<f64>]) -> Formula<f64> {
    Formula::new(steps.to_vec(), Vector3::zeros(), 2.0).unwrap()
}

#[test]
fn every_step_is_worked_out_in_its_order() {
    let (a, b, c) = (0.7_f64, -0.4_f64, 1.3_f64);
    let cases: [(&[FormulaStep<f64>], f64); 17] = [
        (&[X], a),
        (&[Y], b),
        (&[Z], c),
        (&[Number(3.5)], 3.5),
        (&[X, Y, Add], a + b),
        (&[X, Y, Subtract], a - b),
        (&[X, Y, Multiply], a * b),
        (&[X, Y, Divide], a / b),
        (&[X, Y, Min], b),
        (&[X, Y, Max], a),
        (&[X, Negate], -a),
        (&[Y, Power(3)], b.powi(3)),
        (&[Z, Sqrt, Y, Abs, Add], c.sqrt() + b.abs()),
        (&[X, Exp, Y, Sin, Subtract, Z, Cos, Multiply], (a.exp() - b.sin()) * c.cos()),
        // From the right: every value is held until the last is there.
        (&[X, Y, Z, Number(2.0), Subtract, Divide, Add], a + b / (c - 2.0)),
        (
            &[X, Y, Subtract, Z, Number(2.0), Add, Divide, Number(0.5), Power(2), Subtract],
            (a - b) / (c + 2.0) - 0.25,
        ),
        (&[Number(1.0), X, Abs, Negate, Y, Max, Add, Sqrt], (1.0 + (-a).max(b)).sqrt()),
    ];
    for (steps, expected) in cases {
        let (formula, point) = (formula(steps), Vector3::new(a, b, c));
        assert!((formula.value(&point) - expected).abs() < 1e-15, "{steps:?}: {}", formula.value(&point));
        // The gradient by the terms, against differences of the value.
        let slope = formula.gradient(&point);
        let differences = Vector3::from_fn(|axis, _| {
            let step = Vector3::ith(axis, 1e-6);
            (formula.value(&(point + step)) - formula.value(&(point - step))) / 2e-6
        });
        assert!((slope - differences).amax() < 1e-8, "{steps:?}: {slope} {differences}");
    }
}

/// A value too few, too many, or more of them held at once than there is room for.
#[test]
fn steps_that_do_not_fit_together_are_refused() {
    let deep = |count: usize| [vec![X; count], vec![Add; count - 1]].concat();
    let made = |steps: Vec<FormulaStep<f64>>| Formula::new(steps, Vector3::zeros(), 1.0).is_ok();
    for steps in [vec![], vec![Add], vec![X, Add], vec![X, Y], vec![X, Sqrt, Y], vec![X, Y, Add, Add, Z]] {
        assert!(!made(steps.clone()), "{steps:?}");
    }
    assert!(made(deep(24)) && !made(deep(25)));
    assert!(!made(vec![Number(f64::NAN)]) && !made(vec![X, Number(f64::INFINITY), Subtract]));
    assert!(Formula::new(vec![X], Vector3::repeat(f64::NAN), 1.0).is_err());
    assert!(Formula::new(vec![X], Vector3::zeros(), 0.0).is_err());
}

#[test]
fn what_is_known_of_a_formula_is_handed_on() {
    fn check<T: Real>() {
        let n = T::literal;
        let mut steps = Vec::new();
        for (axis, size) in [(0, 0.008), (1, 0.011), (2, 0.017)] {
            steps.extend([Coordinate(axis), Number(n(size)), Divide, Power(2)]);
        }
        steps.extend([Add, Add, Number(n(1.0)), Subtract]);
        let centre = Vector3::new(n(0.0), n(0.0), n(0.001));
        let formula = Formula::new(steps, centre, n(0.02)).unwrap();
        assert_eq!(Implicit::new(formula.clone()).unwrap().topology(), Topology::Unknown);
        let known = Implicit::new(formula.with_topology(Topology::Convex)).unwrap();
        assert_eq!(known.topology(), Topology::Convex);
        assert!((known.extent().centre - centre).amax() <= n(0.0) && known.extent().radius == n(0.02));
    }
    check::<f64>();
    check::<f32>();
}
