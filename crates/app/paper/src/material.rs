//! Fits the gel's material to the forces of a few presses.

use std::path::Path;

use serde::{Deserialize, Serialize};
use twintac_calibrate::FitSettings;
use twintac_gel::calibration::{calibrate, force_curves};
use twintac_run::built_in::MATERIAL_PROTOCOL;
use twintac_run::{Change, read_recording};
use twintac_sensor::SensorFile;
use twintac_simulate::{Gel, SimulateSettings};
use twintac_store::{Finished, Keyed, Stage, read_json, write_json};
use twintac_work::{Planned, Progress, WorkError, read_text};

use crate::effort::Effort;
use crate::experiments::{PAPER_COMMAND, Paper};
use crate::level::Level;

/// The fitted constants. Forces determine no more of a gel than its stiffness, how that grows with
/// strain, how compressible it is when confined, and its friction.
const FREE: [&str; 5] = [
    "c10_kpa",
    "c20_kpa",
    "poissons_ratio",
    "friction",
    "depth_offset_mm",
];

/// Number of simulated frames of each press, and most iterations of the fit.
#[derive(Clone, Copy, Serialize)]
struct Search {
    most_frames: usize,
    max_iterations: u32,
}

impl Search {
    fn of(effort: Effort) -> Self {
        Self {
            most_frames: 14,
            max_iterations: effort.material_steps(),
        }
    }

    fn settings(self) -> FitSettings {
        FitSettings {
            most_frames: self.most_frames,
            max_iterations: self.max_iterations,
        }
    }
}

/// The fitted material of the gel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GelMaterial {
    /// First constant of Yeoh's model, kPa: half the shear modulus at small strain.
    pub c10_kpa: f64,
    /// Second constant, kPa: growth of the stiffness with strain.
    pub c20_kpa: f64,
    /// Poisson's ratio at small strain.
    pub poissons_ratio: f64,
    /// Coulomb's coefficient of friction between gel and indenters.
    pub friction: f64,
    /// Residual of the forces, % of the largest.
    pub residual_percent: f64,
    /// Number of presses that were fitted.
    pub presses: usize,
    /// Warnings of the fit, in words.
    pub warnings: Vec<String>,
}

/// Settings of the simulation for the fit. They are coarser than for tables, because every
/// iteration presses all curves again.
fn fit_settings(effort: Effort) -> SimulateSettings {
    let fine = SimulateSettings {
        edges_per_height: 5.0,
        edges_per_contact_radius: 4.0,
        ..SimulateSettings::default()
    };
    match effort {
        Effort::Full => fine,
        Effort::Quick => SimulateSettings {
            max_nodes: 2000,
            ..fine
        },
    }
}

/// The fit of the gel's material.
#[derive(Serialize)]
struct Fitting<'a> {
    start: &'a Keyed<SensorFile>,
    settings: SimulateSettings,
    fit: Search,
    level: &'a Level,
    recordings: Finished,
}

impl Stage for Fitting<'_> {
    const NAME: &'static str = "material";
    const MADE_BY: &'static str = PAPER_COMMAND;
    type Follower = dyn Progress;
    type Error = WorkError;

    fn make(&self, folder: &Path, progress: &dyn Progress) -> Result<(), WorkError> {
        let recording = self.level.changed(read_recording(&self.recordings)?);
        let gel = Gel::new(self.start.sensor.clone(), self.settings.clone());
        let curves = force_curves(&recording, &gel)?;
        let free = FREE.map(str::to_owned);
        let found = calibrate(
            self.start,
            self.settings.clone(),
            curves,
            &free,
            self.fit.settings(),
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
            warnings: found.fit.warnings.clone(),
        };
        found.write(folder, self.start)?;
        Ok(write_json(&folder.join("found.json"), &material)?)
    }
}

impl Paper {
    /// Presses every shape once on the bench, and fits the gel's material and friction to the
    /// forces. Returns the sensor with that gel, and the fitted values.
    pub(super) fn material(&self, level: &Level) -> Result<(SensorFile, GelMaterial), WorkError> {
        let protocol = MATERIAL_PROTOCOL;
        let described = &self.sensor;
        let mut planned = Planned::parse(protocol.name, protocol.text, &described.sensor, self.seed)?;
        planned.presses.truncate(self.effort.material_presses());
        let n_presses = planned.presses.len();
        let run = self.run(
            "force-presses",
            &format!("{n_presses} presses on the emulated bench"),
        )?;
        run.emulate(&self.effort.emulator()?, &planned)?;
        let start = described.with_material(&yeoh(described))?;
        let finished = self.run_stage(&Fitting {
            start: &Keyed::of_bytes(start.clone(), start.text.as_bytes()),
            settings: fit_settings(self.effort),
            fit: Search::of(self.effort),
            level,
            recordings: run.recordings()?,
        })?;
        let material: GelMaterial = read_json(&finished.file("found.json"))?;
        for warning in &material.warnings {
            self.progress()
                .note(&format!("the fit of the gel's material: {warning}"));
        }
        let fitted = described.with_material(&read_text(&finished.file("material.toml"))?)?;
        Ok((fitted.with_friction(material.friction)?, material))
    }
}

/// The described gel as a Yeoh material with slight stiffening; without it a ring can buckle the
/// gel (Yeoh, Rubber Chemistry and Technology 63, 1990).
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
    use twintac_calibrate::{Curve, Parameter, Quantity, Signal, fit};

    use super::*;

    /// Approximate tilt of the gel in the emulator configuration `harder`, rad.
    const TILT_RAD: DVec3 = DVec3::new(0.02, -0.015, 0.0);

    /// Approximate frame rate of a recorded press, Hz.
    const RATE_HZ: f64 = 55.0;

    /// A press of a cylinder in which, on the way back, a coarse triangle had a point deep inside
    /// the rounded rim: times, s, and depths, mm.
    const DEEP_INSIDE_A_RIM: [[f64; 2]; 17] = [
        [0.182_025, -0.245_265],
        [0.236_127, -0.136_202],
        [0.363_768, 0.118_279],
        [0.618_158, 0.627_241],
        [1.109_699, 1.608_811],
        [1.854_498, 3.099_342],
        [2.036_681, 3.462_887],
        [2.054_545, 3.490_153],
        [2.090_586, 3.490_153],
        [2.200_600, 3.490_153],
        [2.491_506, 3.490_153],
        [2.545_371, 3.490_153],
        [2.600_674, 3.390_178],
        [2.745_721, 3.099_342],
        [3.054_005, 2.481_317],
        [3.618_235, 1.354_330],
        [4.418_240, -0.245_265],
    ];

    /// The gel with which the fit starts.
    fn gel() -> Gel {
        let described = SensorFile::phystac().unwrap();
        let start = described.with_material(&yeoh(&described)).unwrap();
        Gel::new(start.sensor.clone(), fit_settings(Effort::Full))
    }

    /// A press with these depths, mm, over time, s. Its measured values are not used.
    fn curve(
        gel: &Gel,
        indenter: &str,
        [x_mm, y_mm]: [f64; 2],
        rotation: DQuat,
        depths: &[[f64; 2]],
    ) -> Curve {
        let depth_mm: Vec<f64> = depths.iter().map(|[_, depth_mm]| *depth_mm).collect();
        let values = depth_mm
            .iter()
            .map(|depth_mm| depth_mm.max(0.0).powi(2))
            .collect();
        Curve {
            name: indenter.to_owned(),
            shape: gel.shape(indenter).unwrap().clone(),
            friction: gel.friction(indenter),
            x_mm,
            y_mm,
            rotation,
            time_s: depths.iter().map(|[time_s, _]| *time_s).collect(),
            depth_mm,
            signals: vec![Signal {
                quantity: Quantity::Force,
                values,
            }],
        }
    }

    /// Simulates presses as in the first iteration of the fit, with the derivatives of the forces
    /// with respect to all free constants.
    fn press(gel: &Gel, curves: &[Curve], most_frames: usize) {
        let settings = FitSettings {
            most_frames,
            max_iterations: 0,
        };
        let free = FREE.map(Parameter::named);
        let found = fit(gel, curves, &free, settings, &mut |_| ()).unwrap();
        assert_eq!(found.signals.len(), curves.len());
        for signal in &found.signals {
            let largest_n = signal.fitted.iter().copied().fold(0.0, f64::max);
            let curve = &signal.curve;
            assert!((1.0..60.0).contains(&largest_n), "{curve}: {largest_n} N");
        }
    }

    #[test]
    fn every_shape_is_pressed_as_the_fit_does() {
        let (gel, protocol) = (gel(), MATERIAL_PROTOCOL);
        let mut planned = Planned::parse(protocol.name, protocol.text, gel.sensor(), 1).unwrap();
        planned.presses.truncate(Effort::Full.material_presses());
        let turn = DQuat::from_scaled_axis(TILT_RAD).inverse();
        let curves = planned.presses.iter().map(|plan| {
            let depths: Vec<[f64; 2]> = plan
                .trajectory(RATE_HZ)
                .into_iter()
                .map(|(time_s, depth_mm)| [time_s, depth_mm])
                .collect();
            let place_mm = [plan.x_mm, plan.y_mm];
            curve(&gel, &plan.indenter, place_mm, turn * plan.rotation, &depths)
        });
        let curves: Vec<Curve> = curves.collect();
        assert_eq!(curves.len(), gel.sensor().indenters.len());
        press(&gel, &curves, Search::of(Effort::Full).most_frames);
    }

    #[test]
    fn a_press_with_a_point_deep_inside_a_rim_has_rates() {
        let gel = gel();
        let turn = DQuat::from_xyzw(
            0.007_708_429_820_884_6,
            0.008_193_733_607_527_714,
            0.993_739_832_571_926_2,
            -0.111_151_194_321_902_78,
        );
        let place_mm = [2.678_616, -2.334_323];
        let mut smooth = curve(&gel, "cylinder", place_mm, turn, &DEEP_INSIDE_A_RIM);
        smooth.friction = 0.0;
        press(&gel, &[smooth], DEEP_INSIDE_A_RIM.len());
    }
}
