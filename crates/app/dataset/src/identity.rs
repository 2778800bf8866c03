//! The inputs of a data set, read, and the text that identifies it.

use std::path::Path;

use digitac::{Model, Variant};
use serde::Serialize;
use sha2::{Digest as _, Sha256};
use twintac_fast::FastGel;
use twintac_gel::simulate_settings;
use twintac_model::{gel_like, gel_of};
use twintac_protocol::Protocol;
use twintac_recording::Provenance;
use twintac_sensor::SensorFile;
use twintac_sensors::SensorVariation;
use twintac_simulate::{Gel, SimulateSettings};
use twintac_store::{Digest, Keyed, StoreError};
use twintac_tables::FastTables;
use twintac_work::{WorkError, read_text, target};

use crate::plan::{DatasetPlan, FastSource};

/// The inputs that a plan names.
pub(super) struct Inputs {
    pub(super) sensor: SensorFile,
    pub(super) protocol: Protocol,
    pub(super) gel: Gel,
    /// Settings of the simulation.
    simulate: SimulateSettings,
    pub(super) fast: Option<Keyed<FastTables>>,
    pub(super) twin: Option<Model>,
    twin_sha256: Option<String>,
    pub(super) variation: Option<SensorVariation>,
}

/// The content of `dataset.toml`. Files are identified by their content, not by their path.
#[derive(Serialize)]
struct Identity<'a> {
    version: &'static str,
    provenance: Provenance,
    sensor: &'a str,
    /// SHA-256 of the description and of the surfaces that it names.
    sensor_sha256: String,
    n_presses: usize,
    seed: u64,
    /// `solved`, or `fast`.
    gel: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    fast_gel_sha256: Option<Digest>,
    /// `ports`, or `twin`.
    readings: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    twin_sha256: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    variation: Option<&'a SensorVariation>,
    /// With a surrogate these settings have no effect but on the depths of tables.
    simulate: &'a SimulateSettings,
    protocol: &'a Protocol,
}

impl Inputs {
    pub(super) fn read(plan: &DatasetPlan) -> Result<Self, WorkError> {
        let twin = plan.twin.as_deref().map(Model::load).transpose()?;
        let described = plan.sensor.as_deref().map(SensorFile::read).transpose()?;
        let (sensor, gel, simulate) = match (&twin, &plan.twin) {
            (Some(model), Some(folder)) => {
                if plan.settings.is_some() {
                    let problem = "--settings cannot be used with --twin: a twin's gel is simulated as it was for training";
                    return Err(WorkError::Input(problem.to_owned()));
                }
                of_twin(model, folder, described)?
            }
            _ => {
                let sensor = match described {
                    Some(sensor) => sensor,
                    None => SensorFile::phystac()?,
                };
                let simulate = simulate_settings(SimulateSettings::default(), plan.settings.as_deref())?;
                let gel = Gel::new(std::sync::Arc::clone(&sensor.sensor), simulate.clone());
                (sensor, gel, simulate)
            }
        };
        let protocol = match &plan.protocol {
            None => plan.at_random(&sensor.sensor)?,
            Some(file) => read_protocol(file)?,
        };
        protocol.plan_in_turn(&target(&sensor.sensor), plan.seed, 0..1)?; // An error names what the sensor does not have.
        let fast = plan.fast.as_ref().map(|source| fast_gel(source, &sensor));
        let fast = fast.transpose()?;
        let is_paper = twin
            .as_ref()
            .is_some_and(|model| model.twin.variant() == Variant::Paper);
        if fast.is_some() && is_paper {
            return Err(WorkError::Input(
                "the paper's network reads stresses, which a surrogate does not compute: leave --fast out"
                    .to_owned(),
            ));
        }
        let variation = plan.variation.as_deref().map(read_variation).transpose()?;
        if variation.is_some() && fast.is_none() {
            return Err(WorkError::Input(
                "--variation needs --fast: sensors with variation are computed with the surrogate of the gel"
                    .to_owned(),
            ));
        }
        Ok(Self {
            twin_sha256: plan.twin.as_deref().map(hash_of_twin).transpose()?,
            sensor,
            protocol,
            gel,
            simulate,
            fast,
            twin,
            variation,
        })
    }

    /// The text of `dataset.toml`.
    pub(super) fn identity(&self, n_presses: usize, seed: u64) -> Result<String, WorkError> {
        let sensor = &self.sensor.sensor;
        let mut described = Sha256::new();
        described.update(&self.sensor.text);
        for (name, surface) in &sensor.surfaces {
            described.update(format!("{name} {surface:?}"));
        }
        let identity = Identity {
            version: env!("CARGO_PKG_VERSION"),
            provenance: Provenance::Simulated,
            sensor: &sensor.name,
            sensor_sha256: hexadecimal(&described.finalize()),
            n_presses,
            seed,
            gel: if self.fast.is_some() { "fast" } else { "solved" },
            fast_gel_sha256: self.fast.as_ref().map(Keyed::digest),
            readings: if self.twin.is_some() { "twin" } else { "ports" },
            twin_sha256: self.twin_sha256.as_deref(),
            variation: self.variation.as_ref(),
            simulate: &self.simulate,
            protocol: &self.protocol,
        };
        let text = toml::to_string(&identity)?;
        Ok(format!(
            "# What this data set is made from, as `twintac dataset` wrote it. Shards of anything else are refused here.\n{text}"
        ))
    }
}

/// The gel of a twin, with the sensor of its training or with a described sensor that has the same
/// taxels.
fn of_twin(
    model: &Model,
    folder: &Path,
    described: Option<SensorFile>,
) -> Result<(SensorFile, Gel, SimulateSettings), WorkError> {
    let of_twin = SensorFile::parse(&folder.join("twin.json"), &model.record.sensor)?;
    let (sensor, gel) = match described {
        None => (of_twin, gel_of(model, folder)?),
        Some(sensor) => {
            let gel = gel_like(model, folder, &sensor)?;
            (sensor, gel)
        }
    };
    let taxels: Vec<&String> = sensor.sensor.taxels.iter().map(|taxel| &taxel.name).collect();
    if !taxels.iter().copied().eq(&model.record.taxels) {
        return Err(WorkError::Input(format!(
            "the twin in {} reads the taxels {}, not those of the sensor `{}`: leave --sensor out",
            folder.display(),
            model.record.taxels.join(", "),
            sensor.sensor.name
        )));
    }
    let settings = serde_json::from_value(model.record.simulation.clone());
    let simulate = settings.map_err(|source| StoreError::Damaged {
        path: folder.join("twin.json"),
        source,
    })?;
    Ok((sensor, gel, simulate))
}

fn fast_gel(source: &FastSource, sensor: &SensorFile) -> Result<Keyed<FastTables>, WorkError> {
    match source {
        FastSource::BuiltIn => {
            let tip = FastGel::phystac_tip()?;
            let fast = match tip.check(&sensor.sensor) {
                Ok(()) => tip,
                Err(_) if sensor.sensor.name == tip.sensor() => tip, // `FastTables::of` refuses it below, by its own name
                Err(_) => FastGel::phystac()?,
            };
            let bytes = fast.to_bytes()?;
            let tables = FastTables::of(fast, &sensor.sensor, "the built-in surrogate")?;
            Ok(Keyed::of_bytes(tables, &bytes))
        }
        FastSource::File(file) => Ok(FastTables::read(file, &sensor.sensor)?.0),
    }
}

fn read_protocol(file: &Path) -> Result<Protocol, WorkError> {
    let name = file.display().to_string();
    let protocol = Protocol::parse(&name, &read_text(file)?)?;
    if protocol.parts.is_empty() || !protocol.loads.is_empty() {
        let problem = "has weights, but a data set has only presses: give it parts, and no [[loads]]";
        return Err(WorkError::Input(format!("{name}: {problem}")));
    }
    Ok(protocol)
}

fn read_variation(file: &Path) -> Result<SensorVariation, WorkError> {
    Ok(SensorVariation::parse(
        &file.display().to_string(),
        &read_text(file)?,
    )?)
}

/// SHA-256 of the files in a twin's folder that determine its readings.
fn hash_of_twin(folder: &Path) -> Result<String, WorkError> {
    let mut digest = Sha256::new();
    for name in ["twin.json", "weights.safetensors"] {
        let path = folder.join(name);
        digest.update(std::fs::read(&path).map_err(WorkError::file("reading", &path))?);
    }
    Ok(hexadecimal(&digest.finalize()))
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
