//! A formula as Rust: a type of its own instead of a list of steps, and so without a heap.

use fingertip::surfaces::FormulaStep;
use fingertip::wrench::Real;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::ExportError;
use super::resolved::read;
use super::template::{Typed, Writer};
use crate::fault::SceneProblem;
use crate::formula::FormulaSection;

/// A part of a formula as Rust, and whether it stands for itself without parentheses.
struct Part {
    text: String,
    whole: bool,
}

impl Part {
    fn whole(text: String) -> Self {
        Self { text, whole: true }
    }

    fn operand(&self) -> String {
        if self.whole { self.text.clone() } else { format!("({})", self.text) }
    }
}

impl<T: Real + DeserializeOwned> Writer<T> {
    /// The type `Shape`, which is the formula of `[surface]`.
    pub(super) fn formula(&mut self, surface: &Table) -> Result<Typed, ExportError> {
        let section: FormulaSection = read(&Value::Table(surface.clone()))?;
        let steps = section.steps().map_err(SceneProblem::from)?;
        let (terms, numbers) = (Self::infix(&steps, true)?, Self::infix(&steps, false)?);
        let ball = self.fill("({centre_m:v}, {reach_m})", surface)?;
        let convex = surface.get("convex").and_then(Value::as_bool) == Some(true);
        let topology = if convex { "Convex" } else { "Unknown" };
        let steepest = match surface.get("steepest_per_m") {
            Some(_) => format!(
                "    fn steepest(&self) -> Option<{}> {{\n        Some({})\n    }}\n\n",
                Self::scalar(),
                self.fill("{steepest_per_m}", surface)?
            ),
            None => String::new(),
        };
        let names = [0, 1, 2].map(|axis| match steps.contains(&FormulaStep::Coordinate(axis)) {
            true => coordinate(axis),
            false => "_",
        });
        let (names, t) = (names.join(", "), Self::scalar());
        let has_numbers = steps.iter().any(|step| matches!(step, FormulaStep::Number(_)));
        let constant = if has_numbers { "        let number = surfaces::Term::constant;\n" } else { "" };
        self.statics.push(format!(
            "/// The shape: zero on the surface, negative inside.\n\
             #[derive(Clone, Copy, Debug, PartialEq)]\n\
             pub struct Shape;\n\n\
             #[allow(clippy::approx_constant)]\n\
             impl surfaces::ImplicitSurface<{t}> for Shape {{\n    \
                 fn formula(&self, [{names}]: [surfaces::Term<{t}>; 3]) -> surfaces::Term<{t}> {{\n\
             {constant}        {terms}\n    }}\n\n    \
                 fn ball(&self) -> (nalgebra::Vector3<{t}>, {t}) {{\n        {ball}\n    }}\n\n    \
                 fn value(&self, point: &nalgebra::Vector3<{t}>) -> {t} {{\n        \
                     let [{names}]: [{t}; 3] = (*point).into();\n        {numbers}\n    }}\n\n\
             {steepest}    fn topology(&self) -> surfaces::Topology {{\n        surfaces::Topology::{topology}\n    }}\n\
             }}\n"
        ));
        Ok(Typed {
            of: format!("surfaces::Implicit<{t}, Shape>"),
            make: "surfaces::Implicit::new(Shape)?".to_owned(),
        })
    }

    /// The steps as an expression of terms, or of numbers, whose methods the standard library alone has.
    fn infix(steps: &[FormulaStep<f64>], of_terms: bool) -> Result<String, ExportError> {
        let missing = || ExportError::Missing { key: "outside".to_owned() };
        let mut held: Vec<Part> = Vec::new();
        for step in steps {
            let part = match step {
                FormulaStep::Coordinate(axis) => Part::whole(coordinate(*axis).to_owned()),
                FormulaStep::Number(number) if of_terms => {
                    Part::whole(format!("number({})", Self::literal(*number)))
                }
                FormulaStep::Number(number) => Part::whole(Self::literal(*number)),
                FormulaStep::Add | FormulaStep::Subtract | FormulaStep::Multiply | FormulaStep::Divide => {
                    let (b, a) = (held.pop().ok_or_else(missing)?, held.pop().ok_or_else(missing)?);
                    let sign = match step {
                        FormulaStep::Add => '+',
                        FormulaStep::Subtract => '-',
                        FormulaStep::Multiply => '*',
                        _ => '/',
                    };
                    Part { text: format!("{} {sign} {}", a.operand(), b.operand()), whole: false }
                }
                FormulaStep::Min | FormulaStep::Max => {
                    let (b, a) = (held.pop().ok_or_else(missing)?, held.pop().ok_or_else(missing)?);
                    let name = if matches!(step, FormulaStep::Min) { "min" } else { "max" };
                    Part::whole(call("nalgebra::RealField", name, &a, Some(&b.text), of_terms))
                }
                FormulaStep::Negate => {
                    let a = held.pop().ok_or_else(missing)?;
                    Part { text: format!("-{}", a.operand()), whole: false }
                }
                other => {
                    let a = held.pop().ok_or_else(missing)?;
                    let complex = "nalgebra::ComplexField";
                    Part::whole(match other {
                        FormulaStep::Power(exponent) => {
                            call(complex, "powi", &a, Some(&exponent.to_string()), of_terms)
                        }
                        FormulaStep::Sqrt if of_terms => call("", "sqrt", &a, None, true),
                        FormulaStep::Sqrt => call("wrench::Real", "root", &a, None, false),
                        FormulaStep::Abs => call(complex, "abs", &a, None, of_terms),
                        FormulaStep::Exp => call(complex, "exp", &a, None, of_terms),
                        FormulaStep::Sin => call(complex, "sin", &a, None, of_terms),
                        FormulaStep::Cos => call(complex, "cos", &a, None, of_terms),
                        unknown => {
                            return Err(ExportError::NoType { what: format!("{unknown:?} of a formula") });
                        }
                    })
                }
            };
            held.push(part);
        }
        held.pop().map(|part| part.text).ok_or_else(missing)
    }
}

/// A method of terms, or a function of a trait of numbers.
fn call(of: &str, name: &str, first: &Part, second: Option<&str>, of_terms: bool) -> String {
    if of_terms {
        return format!("{}.{name}({})", first.operand(), second.unwrap_or_default());
    }
    let second = second.map_or_else(String::new, |second| format!(", {second}"));
    format!("{of}::{name}({}{second})", first.text)
}

const fn coordinate(axis: u8) -> &'static str {
    match axis {
        0 => "x",
        1 => "y",
        _ => "z",
    }
}
