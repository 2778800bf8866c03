//! The report of a run, from what its stages left.

use twintac_report::{Making, StageTime, TrainedVariant, TwinReport};

use crate::cache::read_record;
use crate::files::{read_json, write_file};
use crate::stages::training::VariantRecord;
use crate::{Run, RunError};

/// Stages in the order in which they run.
const STAGES: [&str; 6] = [
    "recordings",
    "mesh",
    "simulation",
    "pairs",
    "training",
    "evaluation",
];

impl Run {
    /// Writes `report.html`, and `metrics.json` beside it.
    ///
    /// # Errors
    /// The run is not evaluated yet; a file that cannot be written.
    pub fn report(&self) -> Result<(), RunError> {
        let (held_out, metrics) = (self.held_out()?, self.metrics()?);
        let recording = self.recording()?;
        let simulation = self.simulation(&recording)?;
        let presses = self.pairs()?;
        let variants: Vec<VariantRecord> = read_json(&self.stage("training").join("variants.json"))?;
        let report = TwinReport {
            sensor: &self.sensor.sensor,
            provenance: metrics.provenance,
            evaluation: &held_out.evaluation,
            certainty: metrics.certainty.as_ref(),
            repeatability: held_out.repeatability.as_ref(),
            left_out: &self.left_out(),
            presses: &presses,
            test: &simulation.split.test,
            variants: variants.iter().map(trained).collect(),
            bench: &simulation.bench,
            tables: &simulation.tables,
            making: self.making()?,
        };
        twintac_report::page(&report).write(&self.report_path())?;
        let figures = self.stage("evaluation").join("metrics.json");
        let figures = std::fs::read(&figures).map_err(RunError::file("reading", &figures))?;
        write_file(&self.folder.join("metrics.json"), &figures)
    }

    fn making(&self) -> Result<Making, RunError> {
        let settings =
            serde_json::to_string_pretty(&self.record.settings).map_err(|source| RunError::Json {
                what: "the settings".to_owned(),
                source,
            })?;
        let time = |name: &&str| {
            Some(StageTime {
                name: (*name).to_owned(),
                wall_s: read_record(&self.stage(name)).ok()?.wall_time_s,
            })
        };
        Ok(Making {
            command: self.caller.command.clone(),
            source: self.record.source.clone(),
            seed: self.record.seed,
            settings,
            stages: STAGES.iter().filter_map(time).collect(),
        })
    }
}

fn trained(record: &VariantRecord) -> TrainedVariant<'_> {
    TrainedVariant {
        variant: record.variant,
        is_chosen: record.chosen,
        validation: &record.validation,
        test: &record.test,
        history: &record.history,
    }
}
