//! All experiments, one after the other.

use super::experiments::Paper;
use super::metrics::PaperMetrics;
use super::page;
use crate::RunError;
use crate::files::write_json;

impl Paper {
    /// Makes all of it, and writes `report.html` and `metrics.json`.
    ///
    /// # Errors
    /// Those of the stages.
    pub fn finish(&self) -> Result<PaperMetrics, RunError> {
        let data = self.data()?;
        let twin = data.evaluate()?;
        self.pairs(&data)?;
        let maps = self.maps(&data)?;
        let sensor = self.characterize()?;
        self.trials()?;
        self.simulated(&data)?;
        let metrics = PaperMetrics {
            provenance: twin.provenance,
            effort: self.effort,
            seed: self.seed,
            twin,
            sensor,
            maps,
            shapes: self.classify()?,
        };
        page::page(&metrics, &self.sensor.sensor, &self.caller.command).write(&self.report_path())?;
        write_json(&self.folder.join("metrics.json"), &metrics)?;
        Ok(metrics)
    }
}
