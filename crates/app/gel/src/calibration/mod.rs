//! Calibration: fits the gel's material to measured presses.
//!
//! [`curves_of_file`] and [`curve_of_csv`] read the measured curves, [`calibrate`] fits, and
//! [`Calibration::write`] writes the material as a file that sensor descriptions can name, with a
//! plot.

mod curves;
mod material;
mod plot;

use std::path::Path;

use serde::Serialize;
use twintac_calibrate::{Curve, Fit, FitSettings, Parameter, fit};
use twintac_plot::{png, svg};
use twintac_recording::Provenance;
use twintac_sensor::SensorFile;
use twintac_simulate::{Gel, SimulateSettings};
use twintac_store::{write_file, write_json};
use twintac_work::{Progress, Work, WorkError};

pub use curves::force_curves;
pub use curves::{CsvPlace, Measured, curve_of_csv, curves_of_file};

/// Pixels of the PNG for each unit of the plot.
const PNG_SCALE: f64 = 2.0;

/// A fit, with its inputs: `calibration.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Calibration {
    /// The sensor's name.
    pub sensor: String,
    /// Provenance of the curves, without repetition.
    pub provenance: Vec<Provenance>,
    /// The free constants, by the names of [`Parameter`].
    pub free: Vec<String>,
    /// Settings of the simulation.
    pub settings: SimulateSettings,
    /// Approximate number of simulated frames of each curve.
    pub most_frames: usize,
    /// The fit.
    #[serde(flatten)]
    pub fit: Fit,
    #[serde(skip)]
    n_curves: usize,
}

/// Fits constants of a gel's material, and unknowns of the bench, to curves. The fit starts from
/// the material of the gel. `free` names the free constants, by the names of [`Parameter`].
/// `fit_settings` say how many frames are simulated, and how many iterations are allowed.
///
/// # Errors
/// A name that is no constant of the material; curves that the gel cannot follow; too few curves;
/// fewer than two frames.
pub fn calibrate(
    sensor: &SensorFile,
    settings: SimulateSettings,
    measured: Vec<Measured>,
    free: &[String],
    fit_settings: FitSettings,
    progress: &dyn Progress,
) -> Result<Calibration, WorkError> {
    if fit_settings.most_frames < 2 {
        return Err(WorkError::Input(format!(
            "{} frames of each curve are too few, expected 2 or more",
            fit_settings.most_frames
        )));
    }
    let (curves, mut provenance): (Vec<Curve>, Vec<Provenance>) = measured.into_iter().unzip();
    provenance.sort_unstable();
    provenance.dedup();
    let parameters: Vec<Parameter> = free.iter().map(|name| Parameter::named(name)).collect();
    let gel = Gel::new(sensor.sensor.clone(), settings.clone());
    let work = Work::start(progress, "fitting", fit_settings.max_iterations as usize);
    let found = fit(&gel, &curves, &parameters, fit_settings, &mut |deviation| {
        work.step(&format!("deviation {:.3} %", 100.0 * deviation));
    })?;
    Ok(Calibration {
        sensor: sensor.sensor.name.clone(),
        provenance,
        free: free.to_vec(),
        settings,
        most_frames: fit_settings.most_frames,
        fit: found,
        n_curves: curves.len(),
    })
}

impl Calibration {
    /// Provenance of the curves, in words.
    #[must_use]
    pub fn kinds(&self) -> String {
        let kinds: Vec<String> = self.provenance.iter().map(ToString::to_string).collect();
        kinds.join(" and ")
    }

    /// The material as a TOML file that sensor descriptions can name.
    ///
    /// # Errors
    /// None is known; the TOML library can refuse a value that it cannot write.
    pub fn material_toml(&self) -> Result<String, WorkError> {
        let plural = if self.n_curves == 1 { "" } else { "s" };
        let measured = format!("{} {} curve{plural}", self.n_curves, self.kinds());
        Ok(material::material_file(&self.fit, &measured)?)
    }

    /// Writes `material.toml`, `calibration.json`, and the plot as SVG and PNG.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, folder: &Path, sensor: &SensorFile) -> Result<(), WorkError> {
        let plot = plot::scene(&self.fit, &sensor.sensor, &self.kinds());
        write_file(&folder.join("calibration.svg"), svg(&plot).as_bytes())?;
        write_file(&folder.join("calibration.png"), &png(&plot, PNG_SCALE)?)?;
        write_file(&folder.join("material.toml"), self.material_toml()?.as_bytes())?;
        Ok(write_json(&folder.join("calibration.json"), self)?)
    }
}
