//! Minimisation with derivatives, for the smooth surrogate.

use nalgebra::{DMatrix, DVector};

/// A point with its value and slope.
#[derive(Clone, Debug)]
struct Point {
    place: DVector<f64>,
    value: f64,
    slope: DVector<f64>,
}

/// Steps after which it stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// Most iterations.
    pub(super) iterations: usize,
    /// Done when the slope is no longer than this, or
    pub(super) slope: f64,
    /// the value no longer falls by more than this in three iterations together.
    pub(super) value: f64,
}

/// Local minimum by the method of Broyden, Fletcher, Goldfarb & Shanno (1970) with a bisecting
/// weak-Wolfe line search, which also behaves on functions with creases (Lewis & Overton 2013).
///
/// `f` gives value and slope, or `None` where it is not defined; the search keeps out of there. Returns
/// the place and its value, never worse than the start, or `None` if `f` is not defined at the start.
pub(super) fn quasi_newton(
    mut f: impl FnMut(&DVector<f64>) -> Option<(f64, DVector<f64>)>,
    start: &DVector<f64>,
    limits: Limits,
) -> Option<(DVector<f64>, f64)> {
    let mut evaluate = |place: DVector<f64>| -> Option<Point> {
        let (value, slope) = f(&place)?;
        (value.is_finite() && slope.iter().all(|x| x.is_finite())).then_some(Point { place, value, slope })
    };
    let n = start.len();
    let mut point = evaluate(start.clone())?;
    let mut inverse = DMatrix::identity(n, n);
    let mut scaled = false;
    let mut recent = [f64::INFINITY; 3];
    for iteration in 0..limits.iterations {
        if !(point.slope.norm() > limits.slope) || recent[iteration % 3] - point.value < limits.value {
            break;
        }
        recent[iteration % 3] = point.value;
        let mut direction = -(&inverse * &point.slope);
        if !(direction.dot(&point.slope) < 0.0) {
            inverse = DMatrix::identity(n, n);
            direction = -point.slope.clone();
            scaled = false;
        }
        // In units where parameters run from 0 to 1, a step beyond a quarter is a leap in the dark.
        let longest = direction.amax();
        let first = if longest > 0.25 { 0.25 / longest } else { 1.0 };
        let Some(next) = line_search(&mut evaluate, &point, &direction, first) else { break };
        let step = &next.place - &point.place;
        let change = &next.slope - &point.slope;
        let curvature = step.dot(&change);
        if curvature > 1e-14 * step.norm() * change.norm() {
            if !scaled {
                inverse *= curvature / change.norm_squared();
                scaled = true;
            }
            let rho = 1.0 / curvature;
            let projected = &inverse * &change;
            let factor = rho * (1.0 + rho * change.dot(&projected));
            inverse += &step * step.transpose() * factor
                - (&projected * step.transpose() + &step * projected.transpose()) * rho;
        }
        point = next;
    }
    Some((point.place, point.value))
}

/// A step that falls enough (Armijo, 1e-4) and after which the slope is less steep (0.9).
fn line_search(
    evaluate: &mut impl FnMut(DVector<f64>) -> Option<Point>,
    from: &Point,
    direction: &DVector<f64>,
    first: f64,
) -> Option<Point> {
    let steepness = from.slope.dot(direction);
    let (mut low, mut high, mut step) = (0.0, f64::INFINITY, first);
    let mut found = None;
    for _ in 0..40 {
        match evaluate(&from.place + direction * step) {
            Some(point) if point.value <= from.value + 1e-4 * step * steepness => {
                let flat_enough = point.slope.dot(direction) >= 0.9 * steepness;
                low = step;
                found = Some(point);
                if flat_enough {
                    break;
                }
            }
            _ => high = step,
        }
        step = if high.is_finite() { 0.5 * (low + high) } else { 2.0 * low };
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{Limits, quasi_newton};
    use nalgebra::DVector;

    const LIMITS: Limits = Limits { iterations: 500, slope: 1e-9, value: 0.0 };

    #[test]
    fn rosenbrock_in_ten_dimensions() {
        let f = |x: &DVector<f64>| {
            let mut slope = DVector::zeros(x.len());
            let mut value = 0.0;
            for i in 0..x.len() - 1 {
                let (a, b) = (1.0 - x[i], x[i + 1] - x[i] * x[i]);
                value += a * a + 100.0 * b * b;
                slope[i] += -2.0 * a - 400.0 * x[i] * b;
                slope[i + 1] += 200.0 * b;
            }
            Some((value, slope))
        };
        let (place, value) = quasi_newton(f, &DVector::from_element(10, 0.2), LIMITS).unwrap();
        assert!(value < 1e-15 && (place[9] - 1.0).abs() < 1e-6, "{value}");
    }

    #[test]
    fn stays_out_of_forbidden_places() {
        // −log x + x, not defined for x ≤ 0: least at 1.
        let f =
            |x: &DVector<f64>| (x[0] > 0.0).then(|| (x[0] - x[0].ln(), DVector::repeat(1, 1.0 - 1.0 / x[0])));
        for start in [1e-3, 40.0] {
            let (place, _) = quasi_newton(f, &DVector::repeat(1, start), LIMITS).unwrap();
            assert!((place[0] - 1.0).abs() < 1e-8);
        }
        assert!(quasi_newton(f, &DVector::repeat(1, -1.0), LIMITS).is_none());
    }

    #[test]
    fn ends_on_functions_without_a_minimum() {
        let falling = |x: &DVector<f64>| Some((-x[0], DVector::repeat(1, -1.0)));
        let (place, value) = quasi_newton(falling, &DVector::zeros(1), LIMITS).unwrap();
        assert!(place[0].is_finite() && value <= 0.0);
        let flat = |_: &DVector<f64>| Some((1.0, DVector::zeros(1)));
        assert_eq!(quasi_newton(flat, &DVector::zeros(1), LIMITS).unwrap().1, 1.0);
        let broken = |_: &DVector<f64>| Some((f64::NAN, DVector::zeros(1)));
        assert!(quasi_newton(broken, &DVector::zeros(1), LIMITS).is_none());
    }

    /// Places where (x − 8.9)² is asked for, and where the search ends.
    fn parabola(limits: Limits) -> (Vec<f64>, f64) {
        let mut places = Vec::new();
        let f = |x: &DVector<f64>| {
            places.push(x[0]);
            Some(((x[0] - 8.9).powi(2), DVector::repeat(1, 2.0 * (x[0] - 8.9))))
        };
        let (place, _) = quasi_newton(f, &DVector::zeros(1), limits).unwrap();
        (places, place[0])
    }

    /// A quarter at first, twice that as long as it is not flat enough: the slope falls to nine tenths. Near the end a
    /// step of the method is shorter.
    #[test]
    fn the_line_search_goes_where_the_method_says() {
        let (places, place) = parabola(LIMITS);
        let mut expected = vec![0.0];
        (0..4).for_each(|from| expected.extend([0.25, 0.5, 1.0].map(|step| f64::from(from) + step)));
        expected.extend((17..36).map(|quarters| 0.25 * f64::from(quarters)));
        expected.push(8.9);
        assert_eq!(places.len(), expected.len(), "{places:?}");
        assert!(places.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{places:?}");
        assert!((place - 8.9).abs() < 1e-12);
        // A step too far is halved.
        let mut places = Vec::new();
        let f = |x: &DVector<f64>| {
            places.push(x[0]);
            Some((x[0] * x[0], x * 2.0))
        };
        quasi_newton(f, &DVector::repeat(1, 0.1), LIMITS);
        assert_eq!(places, [0.1, -0.1, 0.0]);
    }

    #[test]
    fn it_ends_at_each_of_its_limits() {
        for (limits, end) in [
            (Limits { iterations: 0, ..LIMITS }, 0.0),
            (Limits { iterations: 3, ..LIMITS }, 3.0),
            // The slope is 2 (8.9 − x); it goes to 6.5, 6.75, 7.
            (Limits { slope: 3.9, ..LIMITS }, 7.0),
            (Limits { slope: 4.5, ..LIMITS }, 6.75),
            // By way of 5, 5.5 and 6 to 6.5 it falls by 9.45, from 5.5 to 6.75 by 6.94.
            (Limits { value: 10.0, ..LIMITS }, 6.5),
            (Limits { value: 9.0, ..LIMITS }, 6.75),
        ] {
            let (_, place) = parabola(limits);
            assert!((place - end).abs() < 1e-12, "{limits:?}: {place}");
        }
    }

    /// A method that learns the curvature needs a few steps a dimension where steepest descent needs hundreds.
    #[test]
    fn curvature_is_learnt() {
        let mut calls = 0;
        let sizes = DVector::from_fn(6, |i, _| 4.0_f64.powi(i as i32));
        let f = |x: &DVector<f64>| {
            calls += 1;
            // Turned, so that no axis is that of a coordinate.
            let turned = DVector::from_fn(6, |i, _| x[i] + 0.3 * x[(i + 1) % 6]);
            let slope = turned.component_mul(&sizes);
            let back = DVector::from_fn(6, |i, _| slope[i] + 0.3 * slope[(i + 5) % 6]);
            Some((0.5 * turned.dot(&slope), back))
        };
        let (place, value) =
            quasi_newton(f, &DVector::from_fn(6, |i, _| 0.1 + 0.05 * i as f64), LIMITS).unwrap();
        println!("{calls} calls, {value:e}");
        assert!(place.amax() < 1e-9 && calls < 60, "{calls} {place}");
    }
}
