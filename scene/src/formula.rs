//! `shape = "formula"`: a shape of one's own without a line of code.

use alloc::collections::BTreeMap;

use exmex::{BinOp, Express, FlatEx, MakeOperators, MatchLiteral, Operator};
use fingertip::surfaces::{BadShape, DynSurface, Formula, FormulaStep, Implicit, Topology};
use fingertip::wrench::Real;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// `[surface]` with a formula.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FormulaSection {
    shape: String,
    /// Positive outside of the body, negative inside.
    outside: String,
    /// Numbers that the formula names.
    #[serde(default)]
    parameters: BTreeMap<String, f64>,
    /// A ball around the whole surface.
    #[serde(default)]
    centre_m: [f64; 3],
    reach_m: f64,
    #[serde(default)]
    convex: bool,
    /// No gradient is longer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    steepest_per_m: Option<f64>,
}

/// What is wrong with a formula.
///
/// ```
/// use fingertip_scene::{BadFormula, Scene, SceneProblem};
///
/// let text = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"formula\"\n\
///             outside = \"x^2 + y^2 + z^2 - r^2\"\nreach_m = 0.02\n";
/// let refused = Scene::from_text(text).unwrap_err();
/// assert!(matches!(&refused, SceneProblem::Formula(BadFormula::Unknown(name)) if name == "r"));
/// assert!(refused.to_string().contains("add it there"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum BadFormula {
    /// It cannot be read.
    #[error("`outside` of [surface] cannot be read: {0}")]
    Syntax(String),
    /// A sign before a power, which some read one way and some the other.
    #[error("`outside` of [surface]: write -(…^n) or (-…)^n for {0}, which can be read both ways")]
    SignedPower(String),
    /// A name that means nothing.
    #[error(
        "`outside` of [surface] names `{0}`, which is neither x, y, z nor one of [surface.parameters]; add it there"
    )]
    Unknown(String),
    /// A parameter that the formula does not name, or that is called as a coordinate.
    #[error("[surface.parameters] has `{0}`, which `outside` does not use; take it out, or use it")]
    Unused(String),
    /// Something that formulas do not know.
    #[error("`outside` of [surface]: {0}")]
    Operation(&'static str),
}

impl FormulaSection {
    pub(crate) fn build<T: Real>(&self) -> Result<DynSurface<T>, FormulaFault> {
        let steps = self.steps()?;
        let steps = steps.into_iter().map(|step| in_type(&step)).collect();
        let centre = Vector3::from(self.centre_m).map(T::literal);
        let formula = Formula::new(steps, centre, T::literal(self.reach_m))?;
        let formula = formula.with_topology(if self.convex { Topology::Convex } else { Topology::Unknown });
        let formula = match self.steepest_per_m {
            Some(steepest) => formula.with_steepest(T::literal(steepest)),
            None => formula,
        };
        Ok(DynSurface::Formula(Box::new(Implicit::new(formula)?)))
    }

    /// The formula as steps, the parameters put in.
    pub(crate) fn steps(&self) -> Result<Vec<FormulaStep<f64>>, BadFormula> {
        no_signed_power(&self.outside)?;
        let parsed = FlatEx::<Code, Operations, Decimal>::parse(&between(&self.outside))
            .map_err(|error| BadFormula::Syntax(error.to_string().replace('\n', " ")))?;
        let value_of = |name: &String| {
            let axis = ["x", "y", "z"].iter().zip(0_u8..).find(|(axis, _)| *axis == name);
            match (axis, self.parameters.get(name)) {
                (Some((_, axis)), _) => Ok(Code::of(FormulaStep::Coordinate(axis))),
                (None, Some(number)) => Ok(Code::of(FormulaStep::Number(*number))),
                (None, None) => Err(BadFormula::Unknown(name.clone())),
            }
        };
        let values = parsed.var_names().iter().map(value_of).collect::<Result<Vec<Code>, _>>()?;
        let unused =
            |name: &&String| !parsed.var_names().contains(name) || ["x", "y", "z"].contains(&name.as_str());
        if let Some(name) = self.parameters.keys().find(unused) {
            return Err(BadFormula::Unused(name.clone()));
        }
        let code =
            parsed.eval(&values).map_err(|error| BadFormula::Syntax(error.to_string().replace('\n', " ")))?;
        match code.wrong {
            Some(wrong) => Err(BadFormula::Operation(wrong)),
            None => Ok(code.steps),
        }
    }
}

/// What is wrong with a formula, or with the shape that it is of.
#[derive(Debug, Error)]
pub(crate) enum FormulaFault {
    #[error(transparent)]
    Formula(#[from] BadFormula),
    #[error(transparent)]
    Shape(#[from] BadShape),
}

fn in_type<T: Real>(step: &FormulaStep<f64>) -> FormulaStep<T> {
    match *step {
        FormulaStep::Coordinate(axis) => FormulaStep::Coordinate(axis),
        FormulaStep::Number(number) => FormulaStep::Number(T::literal(number)),
        FormulaStep::Add => FormulaStep::Add,
        FormulaStep::Subtract => FormulaStep::Subtract,
        FormulaStep::Multiply => FormulaStep::Multiply,
        FormulaStep::Divide => FormulaStep::Divide,
        FormulaStep::Min => FormulaStep::Min,
        FormulaStep::Max => FormulaStep::Max,
        FormulaStep::Power(exponent) => FormulaStep::Power(exponent),
        FormulaStep::Sqrt => FormulaStep::Sqrt,
        FormulaStep::Abs => FormulaStep::Abs,
        FormulaStep::Exp => FormulaStep::Exp,
        FormulaStep::Sin => FormulaStep::Sin,
        FormulaStep::Cos => FormulaStep::Cos,
        _ => FormulaStep::Negate,
    }
}

/// The parser's "number": what is to be done to get it. Numbers alone are worked out at once.
#[derive(Clone, Debug, Default, PartialEq)]
struct Code {
    steps: Vec<FormulaStep<f64>>,
    wrong: Option<&'static str>,
}

impl Code {
    fn of(step: FormulaStep<f64>) -> Self {
        Self { steps: vec![step], wrong: None }
    }

    fn number(&self) -> Option<f64> {
        match self.steps.as_slice() {
            [FormulaStep::Number(number)] => Some(*number),
            _ => None,
        }
    }

    fn one(mut self, step: FormulaStep<f64>, of_number: fn(f64) -> f64) -> Self {
        match self.number() {
            Some(number) => Self { steps: vec![FormulaStep::Number(of_number(number))], ..self },
            None => {
                self.steps.push(step);
                self
            }
        }
    }

    fn two(mut self, other: Self, step: FormulaStep<f64>, of_numbers: fn(f64, f64) -> f64) -> Self {
        let wrong = self.wrong.or(other.wrong);
        if let (Some(a), Some(b)) = (self.number(), other.number()) {
            return Self { steps: vec![FormulaStep::Number(of_numbers(a, b))], wrong };
        }
        self.steps.extend(other.steps);
        self.steps.push(step);
        Self { wrong, ..self }
    }

    fn power(mut self, exponent: Self) -> Self {
        let wrong = self.wrong.or(exponent.wrong);
        let number = exponent.number();
        if let (Some(base), Some(number)) = (self.number(), number) {
            return Self { steps: vec![FormulaStep::Number(base.powf(number))], wrong };
        }
        #[allow(clippy::cast_possible_truncation, reason = "checked to be whole and small")]
        let step = match number {
            Some(0.5) => Some(FormulaStep::Sqrt),
            Some(whole) if whole.fract() == 0.0 && whole.abs() <= 64.0 => {
                Some(FormulaStep::Power(whole as i32))
            }
            _ => None,
        };
        match step {
            Some(step) => {
                self.steps.push(step);
                Self { wrong, ..self }
            }
            None => Self { wrong: Some("an exponent must be a whole number up to 64, or 0.5"), ..self },
        }
    }
}

impl core::str::FromStr for Code {
    type Err = core::num::ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(|number| Self::of(FormulaStep::Number(number)))
    }
}

/// The operations of a formula.
#[derive(Clone, Debug)]
struct Operations;

impl MakeOperators<Code> for Operations {
    fn make<'a>() -> Vec<Operator<'a, Code>> {
        fn minus(a: Code, b: Code) -> Code {
            a.two(b, FormulaStep::Subtract, |a, b| a - b)
        }
        fn plus(a: Code, b: Code) -> Code {
            a.two(b, FormulaStep::Add, |a, b| a + b)
        }
        let two = |apply: fn(Code, Code) -> Code, prio: i64| BinOp { apply, prio, is_commutative: false };
        vec![
            Operator::make_bin("^", two(Code::power, 4)),
            Operator::make_bin("*", two(|a, b| a.two(b, FormulaStep::Multiply, |a, b| a * b), 2)),
            Operator::make_bin("/", two(|a, b| a.two(b, FormulaStep::Divide, |a, b| a / b), 3)),
            Operator::make_bin_unary("+", two(plus, 0), |a| a),
            Operator::make_bin_unary("-", two(minus, 1), |a| a.one(FormulaStep::Negate, |x| -x)),
            Operator::make_bin("min", two(|a, b| a.two(b, FormulaStep::Min, f64::min), 0)),
            Operator::make_bin("max", two(|a, b| a.two(b, FormulaStep::Max, f64::max), 0)),
            Operator::make_unary("sqrt", |a| a.one(FormulaStep::Sqrt, f64::sqrt)),
            Operator::make_unary("abs", |a| a.one(FormulaStep::Abs, f64::abs)),
            Operator::make_unary("exp", |a| a.one(FormulaStep::Exp, f64::exp)),
            Operator::make_unary("sin", |a| a.one(FormulaStep::Sin, f64::sin)),
            Operator::make_unary("cos", |a| a.one(FormulaStep::Cos, f64::cos)),
            Operator::make_constant("pi", Code::of(FormulaStep::Number(core::f64::consts::PI))),
        ]
    }
}

/// Numbers, with a power of ten or without, which the parser's own matcher does not know.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Decimal;

impl MatchLiteral for Decimal {
    fn is_literal(text: &str) -> Option<&str> {
        let digits = |from: usize| text.bytes().skip(from).take_while(u8::is_ascii_digit).count();
        let whole = digits(0);
        let fraction = if text.as_bytes().get(whole) == Some(&b'.') { 1 + digits(whole + 1) } else { 0 };
        let end = whole + fraction;
        if whole == 0 && fraction < 2 {
            return None;
        }
        let mut power = 0;
        if matches!(text.as_bytes().get(end), Some(b'e' | b'E')) {
            let signed = usize::from(matches!(text.as_bytes().get(end + 1), Some(b'+' | b'-')));
            let exponent = digits(end + 1 + signed);
            power = if exponent > 0 { 1 + signed + exponent } else { 0 };
        }
        text.get(..end + power)
    }
}

/// With `min(a, b)` and `max(a, b)` written between their operands, since the parser mistakes the comma of a call
/// within a call.
fn between(text: &str) -> String {
    let call = ["min", "max"].iter().filter_map(|name| Some((text.find(&format!("{name}("))?, *name))).min();
    let Some((at, name)) = call else { return text.to_owned() };
    let (before, call) = text.split_at(at);
    let inside = call.get(name.len() + 1..).unwrap_or_default();
    let (mut open, mut comma) = (0_usize, None);
    for (index, c) in inside.char_indices() {
        match c {
            '(' => open += 1,
            ')' if open > 0 => open -= 1,
            ',' if open == 0 => comma = comma.or(Some(index)),
            ')' => {
                let Some(comma) = comma else { break };
                let (first, second) = (inside.get(..comma), inside.get(comma + 1..index));
                let (Some(first), Some(second), Some(rest)) = (first, second, inside.get(index + 1..)) else {
                    break;
                };
                return format!(
                    "{before}(({}) {name} ({})){}",
                    between(first),
                    between(second),
                    between(rest)
                );
            }
            _ => {}
        }
    }
    // Not a call of two: the parser says what is wrong.
    text.to_owned()
}

/// That no power follows a signed operand, as in `-x^2`: the parser takes the sign first, mathematicians last.
fn no_signed_power(text: &str) -> Result<(), BadFormula> {
    let signs: Vec<char> = text.chars().filter(|c| !c.is_whitespace()).collect();
    let is_name = |c: &char| c.is_alphanumeric() || matches!(c, '_' | '.');
    for (at, sign) in signs.iter().enumerate() {
        let before = at.checked_sub(1).and_then(|before| signs.get(before));
        let is_sign =
            *sign == '-' && before.is_none_or(|c| matches!(c, '(' | ',' | '+' | '-' | '*' | '/' | '^'));
        if !is_sign {
            continue;
        }
        // Past the operand: a name or a number, then perhaps parentheses.
        let mut end = at + 1;
        while signs.get(end).is_some_and(is_name) {
            end += 1;
        }
        let mut open = 0_usize;
        while let Some(c) = signs.get(end) {
            match c {
                '(' => open += 1,
                ')' if open > 0 => open -= 1,
                _ if open == 0 => break,
                _ => {}
            }
            end += 1;
            if open == 0 {
                break;
            }
        }
        if signs.get(end) == Some(&'^') {
            let shown: String = signs.iter().skip(at).take(end + 2 - at).collect();
            return Err(BadFormula::SignedPower(shown));
        }
    }
    Ok(())
}
