//! What the gel is made of, from the force of a few presses.

use std::path::Path;

use serde::{Deserialize, Serialize};
use twintac_simulate::{Gel, SimulateSettings};

use super::experiments::Paper;
use super::level::Level;
use crate::built_in::{MATERIAL_PROTOCOL, reality};
use crate::calibration::{calibrate, force_curves};
use crate::files::{read_json, read_text, write_json};
use crate::{Planned, RunError, SensorFile};

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
        let settings = settings();
        let inputs = self
            .inputs()
            .settings("start", &start.text)?
            .settings("simulate", &settings)?
            .settings("level", level)?
            .stage(&run.stage("recordings"))?;
        self.run_stage("material", inputs, |folder| {
            let gel = Gel::new(start.sensor.clone(), settings.clone());
            let curves = force_curves(&level.recording(run.recording()?), &gel)?;
            let free = FREE.map(str::to_owned);
            let found = calibrate(
                &start,
                settings.clone(),
                curves,
                &free,
                MOST_FRAMES,
                self.progress(),
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
                presses: n_presses,
            };
            found.write(folder, &start)?;
            write_json(&folder.join("found.json"), &material)
        })?;
        let folder = self.folder.join("material");
        let material: GelMaterial = read_json(&folder.join("found.json"))?;
        let fitted = described.with_material(&read_text(&folder.join("material.toml"))?)?;
        Ok((fitted.with_friction(material.friction)?, material))
    }
}

/// How presses are simulated. Every step of the fit presses all curves again, with derivatives: coarser than the tables.
fn settings() -> SimulateSettings {
    SimulateSettings {
        edges_per_height: 5.0,
        edges_per_contact_radius: 4.0,
        ..SimulateSettings::default()
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use glam::{DQuat, DVec3};
    use twintac_calibrate::{Curve, FitSettings, Parameter, Quantity, Signal, fit};

    use super::*;
    use crate::paper::Effort;

    /// How the gel lies on the bench of reality `harder`, about; with the second turn, the cylinder's rim has a triangle below its middle.
    const TILTS_RAD: [DVec3; 2] = [DVec3::new(0.02, -0.015, 0.0), DVec3::new(0.018, -0.0135, 0.0)];

    /// Frames of a recorded press a second, about.
    const RATE_HZ: f64 = 55.0;

    /// Every shape, pressed as the fit presses it at first: its forces, and how they change with all that is fitted.
    fn presses(tilt_rad: DVec3, is_wanted: impl Fn(&str) -> bool) {
        let protocol = MATERIAL_PROTOCOL;
        let described = SensorFile::phystac().unwrap();
        let mut planned = Planned::parse(protocol.name, protocol.text, &described.sensor, 1).unwrap();
        planned.presses.truncate(Effort::Full.material_presses());
        let start = described.with_material(&yeoh(&described)).unwrap();
        let gel = Gel::new(start.sensor.clone(), settings());
        let turn = DQuat::from_scaled_axis(tilt_rad).inverse();
        let curves = planned
            .presses
            .iter()
            .filter(|plan| is_wanted(&plan.indenter))
            .map(|plan| {
                let (time_s, depth_mm): (Vec<f64>, Vec<f64>) = plan.trajectory(RATE_HZ).into_iter().unzip();
                Curve {
                    name: plan.name.clone(),
                    shape: gel.shape(&plan.indenter).unwrap().clone(),
                    friction: gel.friction(&plan.indenter),
                    x_mm: plan.x_mm,
                    y_mm: plan.y_mm,
                    rotation: turn * plan.rotation,
                    signals: vec![Signal {
                        quantity: Quantity::Force,
                        values: depth_mm
                            .iter()
                            .map(|depth_mm| depth_mm.max(0.0).powi(2))
                            .collect(),
                    }],
                    time_s,
                    depth_mm,
                }
            });
        let curves: Vec<Curve> = curves.collect();
        let settings = FitSettings {
            most_frames: MOST_FRAMES,
            max_iterations: 0,
        };
        let found = fit(&gel, &curves, &FREE.map(Parameter::named), settings, &mut |_| ()).unwrap();
        assert_eq!(found.signals.len(), curves.len());
        assert!(!curves.is_empty());
        for signal in &found.signals {
            let largest_n = signal.fitted.iter().copied().fold(0.0, f64::max);
            assert!(
                largest_n > 1.0 && largest_n < 60.0,
                "{}: {largest_n} N",
                signal.curve
            );
        }
    }

    #[test]
    fn every_shape_is_pressed_as_the_fit_does() {
        presses(TILTS_RAD[0], |_| true);
    }

    #[test]
    fn a_cylinder_is_pressed_whose_rim_has_a_triangle_below_its_middle() {
        presses(TILTS_RAD[1], |indenter| indenter == "cylinder");
    }
}
