//! What stands before the pipeline of wrenches: the weight of what the sensor carries, and a filter.

use fingertip::wrench::Real;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::ExportError;
use super::beside::Beside;
use super::template::Writer;
use crate::carried::Carried;
use crate::filter::Filter;
use crate::pipeline::Pipeline;

const PAYLOAD: &str = "
/// What the sensor carries.
///
/// # Errors
/// Never for the numbers below.
pub fn payload() -> Result<wrench::Payload<{T}>, BadTip> {{
    let body = wrench::Payload::new({mass}, {centre:v})?;
    Ok(body.with_inertia(nalgebra::Matrix3::from({inertia:a}))?)
}}

/// A wrench without what the sensor carries, and without what it reads of no load.
pub fn unloaded(
    payload: &wrench::Payload<{T}>,
    measured: wrench::Wrench<{T}>,
    motion: &wrench::Motion<{T}>,
) -> wrench::Wrench<{T}> {{
    let bias = wrench::Wrench::from_components(&nalgebra::Vector6::from({bias:a}));
    measured - bias - payload.load(motion)
}}
";

const FILTER: &str = "
/// A filter of second order on each component of the wrench: what changes slowly comes {delay} s late.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Filter {{
    /// The first wrench, from which all are counted, and what is held of those before.
    state: Option<[nalgebra::Vector6<{T}>; 3]>,
}}

impl Filter {{
    /// The next wrench, filtered. One that is not finite is given back as it is and forgotten.
    pub fn follow(&mut self, wrench: wrench::Wrench<{T}>) -> wrench::Wrench<{T}> {{
        if !wrench.is_finite() {{
            return wrench;
        }}
        let components = wrench.components();
        let fresh = [components, nalgebra::Vector6::zeros(), nalgebra::Vector6::zeros()];
        let [first, one, two] = self.state.get_or_insert(fresh);
        let entering = components - *first;
        let leaving = *one + entering * {b0};
        *one = *two + entering * {b1} - leaving * {a1};
        *two = entering * {b2} - leaving * {a2};
        let filtered = wrench::Wrench::from_components(&(leaving + *first));
        if filtered.is_finite() {{
            return filtered;
        }}
        // Differences of huge wrenches overflow.
        self.state = None;
        wrench
    }}

    /// As after a pause: the next wrench is the first.
    pub fn start_anew(&mut self) {{
        self.state = None;
    }}
}}
";

/// A list of numbers.
fn list<'a, T: Real>(numbers: impl IntoIterator<Item = &'a T>) -> Value {
    Value::Array(numbers.into_iter().map(|number| Value::Float(number.to_f64())).collect())
}

impl<T: Real + DeserializeOwned> Writer<T> {
    /// What stands between a wrench as it is reported and the stages; with the expression of the wrench that goes in. A
    /// pipeline that begins with gauges has no place for it.
    pub(super) fn before(
        &mut self,
        pipeline: &Pipeline<T>,
        of_gauges: bool,
    ) -> Result<(Vec<Beside>, String), ExportError> {
        let (carried, filter) = (pipeline.carried(), pipeline.filter());
        if of_gauges && (carried.is_some() || filter.is_some()) {
            let what = "a [payload] or a [filter] behind the gauges of a [sensor]".to_owned();
            return Err(ExportError::NoType { what });
        }
        let (mut parts, mut given) = (Vec::new(), "load(force, torque)".to_owned());
        if let Some(carried) = carried {
            parts.push(self.carried(carried)?);
            given = format!("unloaded(&payload, {given}, &motion)");
        }
        if let Some(filter) = filter {
            parts.push(self.filter(filter)?);
            given = format!("filter.follow({given})");
        }
        Ok((parts, given))
    }

    fn carried(&mut self, carried: &Carried<T>) -> Result<Beside, ExportError> {
        let (body, mut keys) = (carried.body(), Table::new());
        keys.insert("mass".to_owned(), Value::Float(body.mass().to_f64()));
        keys.insert("centre".to_owned(), list(body.centre_of_mass().iter()));
        let columns = body.inertia().data.0;
        keys.insert("inertia".to_owned(), Value::Array(columns.iter().map(|column| list(column)).collect()));
        keys.insert("bias".to_owned(), list(carried.bias().components().iter()));
        Ok(Beside {
            items: self.items(PAYLOAD, &keys)?,
            call: "`let payload = payload()?` is what the sensor carries, and `motion` a `wrench::Motion` that tells how it \
                   lies\nand moves. A zero that was taken with it on holds its weight as it hung then: take `payload.load` \
                   of the\nchange of gravity alone off, and no bias.\n"
                .to_owned(),
        })
    }

    fn filter(&mut self, filter: &Filter<T>) -> Result<Beside, ExportError> {
        let mut keys = Table::new();
        let ([a1, a2], [b0, b1, b2]) = filter.coefficients();
        let numbers = [("a1", a1), ("a2", a2), ("b0", b0), ("b1", b1), ("b2", b2), ("delay", filter.delay())];
        for (key, number) in numbers {
            keys.insert(key.to_owned(), Value::Float(number.to_f64()));
        }
        Ok(Beside {
            items: self.items(FILTER, &keys)?,
            call:
                "`let mut filter = Filter::default()` is the filter; after a pause, `filter.start_anew()`.\n"
                    .to_owned(),
        })
    }
}
