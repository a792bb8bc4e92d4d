//! What a report says in words.

use core::fmt::Write as _;

use crate::model::{Curvature, Direction, Options};

/// How a fit was made.
pub(super) fn describe(options: &Options) -> String {
    let mut text = options.method.name().to_owned();
    text.push_str(match options.direction {
        Direction::SignalsFromLoads => " of signals on loads",
        Direction::LoadsFromSignals => " of loads on signals",
    });
    match &options.curvature {
        Curvature::Straight => {}
        Curvature::Quadratic => text.push_str(", quadratic"),
        Curvature::Chosen => text.push_str(", curved"),
        Curvature::Given { terms, .. } => {
            let _ = write!(text, ", curved by {} terms", terms.len());
        }
    }
    text.push_str(if options.bias { ", with bias" } else { ", without bias" });
    if options.tare_groups {
        text.push_str(", tared by group");
    }
    if options.reference_celsius.is_some() {
        text.push_str(", drift with temperature taken off");
    }
    if options.reject_outliers {
        text.push_str(", outliers rejected");
    }
    text
}

/// Reasons, those that miss by most first.
pub(super) fn worst_first(mut found: Vec<(f64, String)>) -> Vec<String> {
    found.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    found.into_iter().map(|(_, text)| text).collect()
}
