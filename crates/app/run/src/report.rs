//! The report of a run, from the results of its stages.

use twintac_report::{Making, StageTime, TrainedVariant, TwinReport};
use twintac_store::{Finished, StoreError, read_json, write_file};
use twintac_work::WorkError;

use crate::stages::evaluation::HeldOut;
use crate::stages::pairs::read_pairs;
use crate::stages::simulation::Simulation;
use crate::stages::training::VariantRecord;
use crate::{Metrics, Run};

impl Run {
    /// Writes `report.html`, and `metrics.json` beside it.
    ///
    /// # Errors
    /// The run is not evaluated yet; a file that cannot be written.
    pub fn report(&self) -> Result<(), WorkError> {
        let stages = [
            ("recordings", self.recordings()?),
            ("simulation", self.simulation()?),
            ("pairs", self.pairs()?),
            ("training", self.training()?),
            ("evaluation", self.evaluation()?),
        ];
        let [_, (_, simulation), (_, pairs), (_, training), (_, evaluation)] = &stages;
        let held_out: HeldOut = read_json(&evaluation.file("evaluation.json"))?;
        let figures = evaluation.file("metrics.json");
        let metrics: Metrics = read_json(&figures)?;
        let simulation = Simulation::read(simulation)?;
        let presses = read_pairs(pairs)?;
        let variants: Vec<VariantRecord> = read_json(&training.file("variants.json"))?;
        let report = TwinReport {
            sensor: &self.sensor().sensor,
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
            making: self.making(&stages)?,
        };
        twintac_report::page(&report).write(&self.report_path())?;
        let figures = std::fs::read(&figures).map_err(WorkError::file("reading", &figures))?;
        Ok(write_file(&self.folder().join("metrics.json"), &figures)?)
    }

    fn making(&self, stages: &[(&str, Finished)]) -> Result<Making, WorkError> {
        let settings =
            serde_json::to_string_pretty(&self.record().settings).map_err(|source| StoreError::Json {
                what: "the settings".to_owned(),
                source,
            })?;
        let time = |(name, stage): &(&str, Finished)| StageTime {
            name: (*name).to_owned(),
            wall_s: stage.wall_time_s(),
        };
        Ok(Making {
            command: self.caller().command.clone(),
            source: self.record().source.clone(),
            seed: self.record().seed,
            settings,
            stages: stages.iter().map(time).collect(),
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
