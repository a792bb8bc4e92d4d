//! `[filter]`: noise or a hum taken off the wrench, before the contact is looked for.

use biquad::{Coefficients, Q_BUTTERWORTH_F64, Type};
use fingertip::wrench::{Real, Wrench};
use nalgebra::Vector6;
use serde::{Deserialize, Serialize};

use crate::fault::SceneProblem;

/// `[filter]` of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum FilterSection {
    /// Butterworth, of second order.
    LowPass {
        #[serde(rename = "cutoff_Hz")]
        cutoff: f64,
    },
    /// One frequency is taken out.
    Notch {
        #[serde(rename = "frequency_Hz")]
        frequency: f64,
        /// Where less than half the power is left, from edge to edge.
        #[serde(rename = "width_Hz")]
        width: f64,
    },
}

impl FilterSection {
    pub(crate) fn build<T: Real>(&self, sample_rate: Option<f64>) -> Result<Filter<T>, SceneProblem> {
        let Some(rate) = sample_rate else {
            return Err(SceneProblem::Needs { what: "[filter]", needed: "`sample_rate_Hz` of [input]" });
        };
        let (kind, key, frequency, quality) = match *self {
            Self::LowPass { cutoff } => (Type::LowPass, "cutoff_Hz", cutoff, Q_BUTTERWORTH_F64),
            Self::Notch { frequency, width } => {
                if !(width > 0.0 && width < frequency) {
                    return Err(SceneProblem::Range {
                        key: "width_Hz",
                        section: "filter",
                        requirement: "positive and below `frequency_Hz`",
                    });
                }
                (Type::Notch, "frequency_Hz", frequency, frequency / width)
            }
        };
        // Closer to half the rate, or this far below it, rounding is larger than what is filtered.
        let share = 2.0 * frequency / rate;
        if !(1e-4..0.98).contains(&share) {
            return Err(SceneProblem::Range {
                key,
                section: "filter",
                requirement: "between 1/20000 and 0.49 of `sample_rate_Hz`",
            });
        }
        let shaped = Coefficients::from_normalized_params(kind, share, quality);
        let Coefficients { a1, a2, b0, b1, b2 } = shaped.map_err(|_| SceneProblem::Range {
            key,
            section: "filter",
            requirement: "below half of `sample_rate_Hz`",
        })?;
        // The slope of the phase at frequency zero: (Σ k bₖ)/(Σ bₖ) − (Σ k aₖ)/(Σ aₖ) samples.
        let samples = (b1 + 2.0 * b2) / (b0 + b1 + b2) - (a1 + 2.0 * a2) / (1.0 + a1 + a2);
        let [a1, a2, b0, b1, b2] = [a1, a2, b0, b1, b2].map(T::literal);
        Ok(Filter { a: [a1, a2], b: [b0, b1, b2], delay: T::literal(samples / rate), state: None })
    }
}

/// A filter of second order, on each component of the wrench.
///
/// It starts where the first wrench is, as if that had been there for ever, so that nothing swings in.
///
/// ```
/// # const BALL: &str = "version = 2\n[input]\nconvention = \"on_fingertip\"\n[surface]\nshape = \"sphere\"\nradius_m = 0.013\n";
/// use fingertip_scene::Scene;
///
/// // 1000 samples a second, of which what is faster than 50 Hz is taken off.
/// let input = BALL.replace("[surface]", "sample_rate_Hz = 1000.0\n[surface]");
/// let scene = Scene::from_text(&format!("{input}[filter]\nkind = \"low_pass\"\ncutoff_Hz = 50.0\n"))?;
/// // What changes slowly comes 1/(√2·π·50 Hz) late.
/// assert!((scene.delay() - 4.5e-3).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Filter<T: Real> {
    a: [T; 2],
    b: [T; 3],
    delay: T,
    state: Option<State<T>>,
}

/// Departures from the first wrench, which keeps digits in single precision.
#[derive(Clone, Copy, Debug, PartialEq)]
struct State<T: Real> {
    first: Vector6<T>,
    held: [Vector6<T>; 2],
}

impl<T: Real> Filter<T> {
    /// By how much what changes slowly comes late \[s\].
    pub const fn delay(&self) -> T {
        self.delay
    }

    /// Those of what left, and of what entered.
    pub(crate) const fn coefficients(&self) -> ([T; 2], [T; 3]) {
        (self.a, self.b)
    }

    /// The next wrench, filtered. A wrench that is not finite is given back as it is and forgotten.
    #[inline]
    pub(crate) fn follow(&mut self, wrench: Wrench<T>) -> Wrench<T> {
        if !wrench.is_finite() {
            return wrench;
        }
        let components = wrench.components();
        let fresh = State { first: components, held: [Vector6::zeros(); 2] };
        let State { first, held: [one, two] } = self.state.get_or_insert(fresh);
        let ([a1, a2], [b0, b1, b2]) = (self.a, self.b);
        let entering = components - *first;
        // Transposed direct form II.
        let leaving = *one + entering * b0;
        *one = *two + entering * b1 - leaving * a1;
        *two = entering * b2 - leaving * a2;
        let filtered = Wrench::from_components(&(leaving + *first));
        if filtered.is_finite() {
            return filtered;
        }
        // Differences of huge wrenches overflow, and what is held would never be a number again.
        self.state = None;
        wrench
    }

    /// The next wrench is the first.
    pub(crate) fn start_anew(&mut self) {
        self.state = None;
    }
}
