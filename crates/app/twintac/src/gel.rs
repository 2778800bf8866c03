//! A sensor's gel, pressed.

use std::sync::Arc;

use twintac_simulate::{Keyframe, PressPlace, SimulateSettings};

use crate::{Error, Press, PressFrame, Sensor};

/// The gel of a sensor, ready to be pressed: a finite-element model with the material of the description.
#[derive(Clone, Debug)]
pub struct Gel {
    pub(crate) gel: twintac_simulate::Gel,
}

impl Gel {
    /// The gel of a sensor, simulated as finely as usual.
    #[must_use]
    pub fn of(sensor: &Sensor) -> Self {
        Self::with_settings(sensor, SimulateSettings::fine())
    }

    /// The gel of a sensor, simulated as finely as asked for.
    #[must_use]
    pub fn with_settings(sensor: &Sensor, settings: SimulateSettings) -> Self {
        let sensor = Arc::clone(&sensor.file().sensor);
        Self {
            gel: twintac_simulate::Gel::new(sensor, settings),
        }
    }

    /// Presses the gel down to the depth of the press: takes about a second. A gel whose material relaxes does so while it is pressed, at the
    /// speed of the press.
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a place beside the gel; a depth at which the solver finds no equilibrium.
    pub fn press(&self, press: &Press) -> Result<Pressed, Error> {
        let plan = &press.plan;
        let place = PressPlace {
            indenter: plan.indenter.clone(),
            shape: self.gel.shape(&plan.indenter)?.clone(),
            x_mm: plan.x_mm,
            y_mm: plan.y_mm,
            rotation: plan.rotation,
            depth_mm: plan.depth_mm,
            enough_force_n: None,
        };
        let in_time = |keyframe: Keyframe| Keyframe {
            time_s: keyframe.depth_mm / plan.speed_mm_per_s,
            ..keyframe
        };
        let keyframes: Vec<Keyframe> = self.gel.depths(&place).into_iter().map(in_time).collect();
        let pressed = self.gel.press(&place, &keyframes)?;
        match (pressed.failure, pressed.frames.last().cloned()) {
            (None, Some(deepest)) => Ok(Pressed {
                frames: pressed.frames,
                deepest,
            }),
            (failure, _) => Err(Error::Depth {
                depth_mm: plan.depth_mm,
                reason: failure.unwrap_or_default(),
            }),
        }
    }
}

/// A simulated press, from first touch to full depth.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressed {
    frames: Vec<PressFrame>,
    deepest: PressFrame,
}

impl Pressed {
    /// What every number here is: no sensor was read, and no twin was trained.
    pub const PROVENANCE: &'static str = "simulated";

    /// Hydrostatic pressure in the gel over each taxel's port at full depth, kPa; `[n_taxels]`. A barometer there would read this if it
    /// followed the gel without gain, delay and creep; what a real one makes of it, a trained twin tells.
    #[must_use]
    pub fn readings_kpa(&self) -> &[f64] {
        &self.deepest.port_pressure_kpa
    }

    /// Force of the indenter on the gel at full depth, N.
    #[must_use]
    pub fn force_n(&self) -> f64 {
        self.deepest.force_n
    }

    /// The press at increasing depths; the first frame is the untouched gel.
    #[must_use]
    pub fn frames(&self) -> &[PressFrame] {
        &self.frames
    }
}
