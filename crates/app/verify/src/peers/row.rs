//! One run's figures, and their errors against the reference.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::plan::Run;

/// Depths, mm, at which forces are compared, and the reference forces for ν = 0.45 and 0.49, N:
/// CalculiX 2.20, 10-node tetrahedra, Neo-Hookean, a quarter of the block. A finer mesh changes
/// them by less than 0.2 %.
const REFERENCE_N: [(&str, f64, f64); 3] = [
    ("0.5", 0.2110, 0.2243),
    ("1.0", 0.7113, 0.7588),
    ("2.0", 2.5517, 2.7141),
];

/// The line of JSON that a script prints.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub(super) struct Figures {
    pub(super) nodes: usize,
    /// Number of elements; hexahedra for an engine with a grid of them.
    pub(super) tets: usize,
    /// Real-time factor: simulated time divided by wall time, without start-up.
    pub(super) rtf: f64,
    /// Processor seconds of all threads for each simulated second.
    pub(super) cpu_s: f64,
    /// Time from the start of the process to the first step of the press, s.
    pub(super) start_up_s: f64,
    /// Depth that the press reached within its time, mm.
    pub(super) reached_mm: f64,
    /// Force, N, at depths, mm.
    pub(super) force_n: BTreeMap<String, f64>,
    /// Peak resident memory of the process, MiB.
    pub(super) memory_mib: f64,
}

/// A run and its result.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct Row {
    pub(super) engine: String,
    pub(super) version: String,
    pub(super) setting: String,
    pub(super) mesh: String,
    pub(super) poissons_ratio: f64,
    /// All parameters of the script.
    pub(super) parameters: Map<String, Value>,
    /// Time of the engine's very first start, with compilation, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) first_start_s: Option<f64>,
    /// The figures; `None` if the run failed.
    #[serde(flatten)]
    pub(super) figures: Option<Figures>,
    /// Error of the force, %, at depths, mm.
    pub(super) error_percent: BTreeMap<String, f64>,
    /// Why there are no figures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) failure: Option<String>,
}

impl Figures {
    /// Parses the last line that a script printed.
    pub(super) fn parse(printed: &str) -> Result<Self> {
        let line = printed.lines().last().context("it printed nothing")?;
        serde_json::from_str(line).with_context(|| format!("it printed `{line}`"))
    }

    fn error_percent(&self, poissons_ratio: f64) -> BTreeMap<String, f64> {
        REFERENCE_N
            .iter()
            .filter_map(|&(depth, soft, stiff)| {
                let reference = if poissons_ratio < 0.47 { soft } else { stiff };
                let force = self.force_n.get(depth)?;
                Some((depth.to_owned(), 100.0 * (force / reference - 1.0)))
            })
            .collect()
    }
}

impl Row {
    /// The row of a run with figures.
    pub(super) fn measured(run: &Run, figures: Figures, first_start_s: Option<f64>) -> Self {
        Row {
            error_percent: figures.error_percent(run.poissons_ratio),
            figures: Some(figures),
            first_start_s,
            failure: None,
            ..Row::failed(run, "")
        }
    }

    /// The row of a run without figures.
    pub(super) fn failed(run: &Run, why: &str) -> Self {
        Row {
            engine: run.engine.clone(),
            version: run.version.clone(),
            setting: run.setting.clone(),
            mesh: run.mesh.clone(),
            poissons_ratio: run.poissons_ratio,
            parameters: run.parameters.clone(),
            first_start_s: None,
            figures: None,
            error_percent: BTreeMap::new(),
            failure: Some(why.to_owned()),
        }
    }

    /// Largest error of the force over the depths that were reached, %.
    pub(super) fn worst_percent(&self) -> Option<f64> {
        self.error_percent
            .values()
            .map(|error| error.abs())
            .reduce(f64::max)
    }

    /// Whether the press ended before its full depth.
    pub(super) fn is_cut(&self) -> bool {
        self.figures
            .as_ref()
            .is_some_and(|figures| !figures.force_n.contains_key("2.0"))
    }

    /// The error at a depth, as tables show it.
    pub(super) fn shown_error(&self, depth: &str) -> String {
        self.error_percent
            .get(depth)
            .map_or("–".into(), |error| format!("{error:+.1} %"))
    }
}
