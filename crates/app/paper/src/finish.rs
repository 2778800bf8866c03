//! Runs all experiments, one after the other.

use twintac_store::write_json;
use twintac_work::WorkError;

use crate::experiments::Paper;
use crate::metrics::PaperMetrics;
use crate::page;

impl Paper {
    /// Makes everything, and writes `report.html` and `metrics.json`.
    ///
    /// # Errors
    /// Those of the stages.
    pub fn finish(&self) -> Result<PaperMetrics, WorkError> {
        let presses = self.presses()?;
        let level = self.level(&presses)?;
        let (fitted, material) = self.material(&level)?;
        let (data, twin, paper_twin) = self.data(&presses, fitted, &level)?;
        self.pairs(&data)?;
        let maps = self.maps(&data, &level)?;
        let sensor = self.characterize()?;
        let trials = self.trials()?.recordings()?;
        let simulated = self.simulated(&data, paper_twin, &level)?;
        let metrics = PaperMetrics {
            provenance: twin.provenance,
            effort: self.effort,
            seed: self.seed,
            tilt_rad: level.tilt_rad,
            material,
            twin,
            sensor,
            maps,
            shapes: self.classify(trials, simulated)?,
        };
        page::page(&metrics, &self.sensor.sensor, &self.caller.command).write(&self.report_path())?;
        write_json(&self.folder.join("metrics.json"), &metrics)?;
        Ok(metrics)
    }
}
