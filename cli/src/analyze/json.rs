//! The summary of a recording for programs: one line of JSON, numbers in SI units.

use std::path::Path;

use fingertip_recordings::Quality;
use fingertip_scene::Scene;
use serde_json::{Map, Value, json};

use super::source::Source;
use crate::observe::{Observations, Quantiles, Status};
use crate::standard::shown;

/// What there is to tell.
pub(super) struct Told<'a> {
    pub(super) recording: &'a Path,
    pub(super) scene: &'a Scene,
    pub(super) source: &'a Source,
    pub(super) observations: &'a Observations,
    pub(super) quality: &'a Quality,
}

impl Told<'_> {
    /// The summary, and which files were written.
    pub(super) fn line(&self, written: &[String]) -> String {
        let Self { recording, scene, source, observations, quality } = self;
        let (first, last) = observations.time_range();
        let outcomes: Map<String, Value> = Status::ALL
            .into_iter()
            .map(|status| (status, observations.count_of(status)))
            .filter(|(_, samples)| *samples > 0)
            .map(|(status, samples)| (status.word().to_owned(), samples.into()))
            .collect();
        let faults: Map<String, Value> = quality
            .faults()
            .into_iter()
            .filter(|(_, fault)| fault.count() > 0)
            .map(|(name, fault)| {
                (name.to_owned(), json!({ "count": fault.count(), "first_lines": fault.first_lines() }))
            })
            .collect();
        let slips =
            scene.watches_for_slip().then(|| {
                let kept = observations.slips.kept().iter();
                let slips: Vec<Value> = kept
            .map(|slip| json!({ "time_s": slip.time, "normal_N": slip.normal_force, "ratio": slip.ratio }))
            .collect();
                json!({ "count": observations.slips.count(), "first": slips })
            });
        let summary = json!({
            "recording": shown(recording),
            "scene": scene.name(),
            "sensor": source.sensor(),
            "samples": observations.rows(),
            "first_time_s": first,
            "last_time_s": last,
            "outcomes": outcomes,
            "distributions": distributions(observations),
            "slips": slips,
            "beyond_friction_limit": scene.limit().map(|_| observations.beyond_limit),
            "faults": faults,
            "notes": source.notes(),
            "written": written,
        });
        format!("{summary}\n")
    }
}

/// Quantiles of what was seen at all.
fn distributions(observations: &Observations) -> Map<String, Value> {
    let of = |quantiles: &Quantiles| {
        let at = |share| quantiles.quantile(share);
        json!({
            "samples": quantiles.count(),
            "quantile_05": at(0.05),
            "median": at(0.5),
            "quantile_95": at(0.95),
            "greatest": quantiles.greatest(),
        })
    };
    [
        ("force_N", &observations.force),
        ("normal_N", &observations.normal),
        ("tangential_N", &observations.tangential),
        ("ratio", &observations.ratio),
        ("gap_m", &observations.gap),
    ]
    .into_iter()
    .filter(|(_, quantiles)| quantiles.count() > 0)
    .map(|(name, quantiles)| (name.to_owned(), of(quantiles)))
    .collect()
}
