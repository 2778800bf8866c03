//! The plan: which settings of which engines run on which meshes.

use std::path::Path;

use anyhow::{Context, Result};
use serde::Deserialize;
use serde_json::{Map, Value, json};

/// Poisson's ratios of the block.
pub(super) const RATIOS: [f64; 2] = [0.45, 0.49];

/// The plan as people write it: `peers/plan.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plan {
    /// Python packages with their versions.
    pub(super) packages: Vec<String>,
    pub(super) engines: Vec<Engine>,
}

/// An engine with its settings.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Engine {
    pub(super) name: String,
    /// The package whose version is reported as the engine's.
    pub(super) package: String,
    /// Its script in `peers/`.
    pub(super) script: String,
    pub(super) settings: Vec<Setting>,
}

/// One way to run an engine.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Setting {
    /// Its purpose: fast, accurate, ...
    name: String,
    meshes: Vec<Mesh>,
    #[serde(rename = "poissons_ratios")]
    ratios: Vec<f64>,
    /// Parameters for the script.
    parameters: Map<String, Value>,
}

/// A mesh on which an engine runs.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
enum Mesh {
    /// The mesh of this project's solver.
    Ours,
    /// A box with this many cells along each side.
    Regular([usize; 3]),
}

/// One press of one engine.
#[derive(Clone)]
pub(super) struct Run {
    pub(super) engine: String,
    pub(super) version: String,
    pub(super) script: String,
    pub(super) setting: String,
    pub(super) mesh: String,
    pub(super) poissons_ratio: f64,
    /// The script's only argument.
    pub(super) parameters: Map<String, Value>,
    /// Processor time after which the press is cut, s.
    pub(super) limit_s: f64,
}

impl Plan {
    pub(super) fn read() -> Result<Self> {
        toml::from_str(include_str!("../../peers/plan.toml")).context("peers/plan.toml")
    }

    /// An engine's runs for these Poisson's ratios, each cut after `limit_s` of processor time, s.
    pub(super) fn runs(&self, engine: &Engine, mesh_file: &Path, ratios: &[f64], limit_s: f64) -> Vec<Run> {
        let pinned = format!("{}==", engine.package);
        let version = self
            .packages
            .iter()
            .find_map(|package| package.strip_prefix(&pinned));
        let mut runs = Vec::new();
        for setting in &engine.settings {
            for mesh in &setting.meshes {
                for &poissons_ratio in setting.ratios.iter().filter(|ratio| ratios.contains(ratio)) {
                    let mut parameters = setting.parameters.clone();
                    let mesh = match mesh {
                        Mesh::Ours => {
                            parameters.insert("mesh_file".into(), json!(mesh_file));
                            "TwinTac's".to_owned()
                        }
                        Mesh::Regular(cells) => {
                            parameters.insert("cells".into(), json!(cells));
                            format!("{} × {} × {}", cells[0], cells[1], cells[2])
                        }
                    };
                    parameters.insert("poissons_ratio".into(), json!(poissons_ratio));
                    parameters.insert("limit_s".into(), json!(limit_s));
                    runs.push(Run {
                        engine: engine.name.clone(),
                        version: version.unwrap_or("?").to_owned(),
                        script: engine.script.clone(),
                        setting: setting.name.clone(),
                        mesh,
                        poissons_ratio,
                        parameters,
                        limit_s,
                    });
                }
            }
        }
        runs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_engine_has_a_pinned_version_and_a_script() {
        let plan = Plan::read().unwrap();
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers");
        for engine in &plan.engines {
            let runs = plan.runs(engine, Path::new("mesh.json"), &RATIOS, 60.0);
            assert!(!runs.is_empty());
            for run in runs {
                assert!(
                    run.version.starts_with(|first: char| first.is_ascii_digit()),
                    "{}",
                    run.version
                );
                assert!(folder.join(&run.script).is_file(), "{}", run.script);
                assert_ne!(
                    run.parameters.contains_key("cells"),
                    run.parameters.contains_key("mesh_file")
                );
            }
        }
    }
}
