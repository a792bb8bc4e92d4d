//! What can be wrong with poses.

use thiserror::Error;

use crate::fit::FitError;

/// Why poses do not tell the payload.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PayloadError {
    /// The poses do not determine it, or a number is not finite.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A direction of the options is zero.
    #[error("the {0} has no direction")]
    NoDirection(&'static str),
    /// The fitted weight pulls upward: the readings have the opposite sign, or are in another frame.
    #[error(
        "the mass would be {mass:.4} kg: the readings are those of the reaction (opposite sign), or in another \
         frame than said"
    )]
    NegativeMass {
        /// The mass as fitted \[kg\].
        mass: f64,
    },
    /// No weight stands out of the errors, so that no centre of mass can be told.
    #[error("the weight of {weight:.3} N does not stand out of its error of {deviation:.3} N")]
    NoWeight {
        /// The weight as fitted \[N\].
        weight: f64,
        /// Its standard deviation \[N\].
        deviation: f64,
    },
}

/// Names the unknowns in an error.
pub(super) fn named(error: FitError, stems: &[&str], unknowns: usize) -> PayloadError {
    let FitError::Unobserved(mut unobserved) = error else { return error.into() };
    for stem in stems {
        if unknowns == 1 {
            unobserved.names.push((*stem).to_owned());
        } else {
            unobserved.names.extend(["x", "y", "z"].map(|axis| format!("{stem} {axis}")));
        }
    }
    unobserved.names.extend(["x", "y", "z"].map(|axis| format!("bias {axis}")));
    FitError::Unobserved(unobserved).into()
}
