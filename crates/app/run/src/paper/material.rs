//! What the gel is made of, from the force of a few presses.

use std::path::Path;

use serde::{Deserialize, Serialize};
use twintac_simulate::{Gel, SimulateSettings};
use twintac_store::{Finished, Keyed, Stage, read_json, write_json};

use super::experiments::{PAPER_COMMAND, Paper};
use super::level::Level;
use crate::built_in::{MATERIAL_PROTOCOL, reality};
use crate::calibration::{calibrate, force_curves};
use crate::files::read_text;
use crate::stages::recordings::{Change, read_recording};
use crate::{Planned, Progress, RunError, SensorFile};

/// What is fitted. Forces tell no more of a gel than how stiff it is, how that grows with strain, how it gives way when it is confined, and how much it sticks.
const FREE: [&str; 5] = [
    "c10_kpa",
    "c20_kpa",
    "poissons_ratio",
    "friction",
    "depth_offset_mm",
];

/// Frames of each press that are simulated.
const MOST_FRAMES: usize = 14;

/// A gel's material, as its presses tell it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GelMaterial {
    /// First constant of Yeoh's model, kPa: half the shear modulus at small strain.
    pub c10_kpa: f64,
    /// Second constant, kPa: how the gel stiffens.
    pub c20_kpa: f64,
    /// Poisson's ratio at small strain.
    pub poissons_ratio: f64,
    /// Coulomb's coefficient of friction between gel and indenters.
    pub friction: f64,
    /// What the fit leaves of the forces, % of the largest.
    pub residual_percent: f64,
    /// Presses that it was fitted to.
    pub presses: usize,
}

/// How presses are simulated for the fit. Every step of it presses all curves again, with derivatives: coarser than the tables.
fn fit_settings() -> SimulateSettings {
    SimulateSettings {
        edges_per_height: 5.0,
        edges_per_contact_radius: 4.0,
        ..SimulateSettings::default()
    }
}

/// The fit of the gel's material.
#[derive(Serialize)]
struct Fitting<'a> {
    start: &'a Keyed<SensorFile>,
    settings: SimulateSettings,
    level: &'a Level,
    recordings: Finished,
}

impl Stage for Fitting<'_> {
    const NAME: &'static str = "material";
    const MADE_BY: &'static str = PAPER_COMMAND;
    type Follower = dyn Progress;
    type Error = RunError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), RunError> {
        let recording = self.level.changed(read_recording(&self.recordings)?);
        let gel = Gel::new(self.start.sensor.clone(), self.settings.clone());
        let curves = force_curves(&recording, &gel)?;
        let free = FREE.map(str::to_owned);
        let found = calibrate(
            self.start,
            self.settings.clone(),
            curves,
            &free,
            MOST_FRAMES,
            progress,
        )?;
        let value = |name: &str| {
            let unknown = found.fit.unknowns.iter().find(|unknown| unknown.name == name);
            unknown.map_or(f64::NAN, |unknown| unknown.value)
        };
        let material = GelMaterial {
            c10_kpa: value("c10_kpa"),
            c20_kpa: value("c20_kpa"),
            poissons_ratio: value("poissons_ratio"),
            friction: value("friction"),
            residual_percent: found.fit.noise_percent,
            presses: recording.presses.len(),
        };
        found.write(folder, self.start)?;
        Ok(write_json(&folder.join("found.json"), &material)?)
    }
}

impl Paper {
    /// Presses every shape once, and fits the gel's material and its friction to the forces. The sensor with that gel, and what was found.
    pub(super) fn material(&self, level: &Level) -> Result<(SensorFile, GelMaterial), RunError> {
        let protocol = MATERIAL_PROTOCOL;
        let described = &self.sensor;
        let mut planned = Planned::parse(protocol.name, protocol.text, &described.sensor, self.seed)?;
        planned.presses.truncate(self.effort.material_presses());
        let n_presses = planned.presses.len();
        let run = self.run(
            "force-presses",
            &format!("{n_presses} presses on the emulated bench"),
        )?;
        run.emulate(&reality(Some(Path::new(self.effort.reality())))?, &planned)?;
        let start = described.with_material(&yeoh(described))?;
        let finished = self.run_stage(&Fitting {
            start: &Keyed::of_bytes(start.clone(), start.text.as_bytes()),
            settings: fit_settings(),
            level,
            recordings: run.recordings()?,
        })?;
        let material: GelMaterial = read_json(&finished.file("found.json"))?;
        let fitted = described.with_material(&read_text(&finished.file("material.toml"))?)?;
        Ok((fitted.with_friction(material.friction)?, material))
    }
}

/// The described gel as one of Yeoh's model that stiffens a little, without which a ring may buckle it (Yeoh, Rubber Chemistry and Technology 63, 1990).
fn yeoh(described: &SensorFile) -> String {
    let material = &described.sensor.gel.material;
    let shear_kpa = material.shear_modulus_kpa();
    format!(
        "model = \"yeoh\"\nc10_kpa = {}\nc20_kpa = {}\nc30_kpa = 0.0\npoissons_ratio = 0.49\nsource = \"the described gel, before the fit\"\n",
        0.5 * shear_kpa,
        0.1 * shear_kpa,
    )
}
