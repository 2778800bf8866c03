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
        let presses = self.presses()?;
        let level = self.level(&presses)?;
        let (fitted, material) = self.material(&level)?;
        let data = self.data(&presses, fitted, &level)?;
        let twin = data.evaluate()?;
        self.pairs(&data)?;
        let maps = self.maps(&data, &level)?;
        let sensor = self.characterize()?;
        self.trials()?;
        self.simulated(&data, &level)?;
        let metrics = PaperMetrics {
            provenance: twin.provenance,
            effort: self.effort,
            seed: self.seed,
            tilt_rad: level.tilt_rad,
            material,
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
