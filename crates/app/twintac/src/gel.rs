//! A sensor's gel, pressed by finite elements.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use twintac_protocol::PressPath;
use twintac_simulate::{Followed, GelState, Keyframe, PressPlace, SimulateSettings};

use crate::{Error, Pose, Press, PressFrame, Sensor};

/// Number of locations between two poses of [`Gel::state`] at which the mesh is refined.
const PLACES_BETWEEN: f64 = 16.0;

/// The gel of a sensor, ready to be pressed: a finite-element model with the material of the
/// description.
#[derive(Clone, Debug)]
pub struct Gel {
    pub(crate) gel: twintac_simulate::Gel,
}

impl Gel {
    /// The gel of a sensor with the default settings for single presses.
    #[must_use]
    pub fn of(sensor: &Sensor) -> Self {
        Self::with_settings(sensor, SimulateSettings::fine())
    }

    /// The gel of a sensor with other settings of the simulation.
    #[must_use]
    pub fn with_settings(sensor: &Sensor, settings: SimulateSettings) -> Self {
        let sensor = Arc::clone(&sensor.file().sensor);
        Self {
            gel: twintac_simulate::Gel::new(sensor, settings),
        }
    }

    /// The same gel with a limit of the wall time of each frame along paths and of [`Gel::state`].
    /// A frame is returned at the limit even if it has not converged: `converged` says so,
    /// `quality.residual` is what is left, and `behind_mm` how far the indenter is behind its pose.
    /// Frames with a prescribed force ignore the limit. Such results are not reproducible.
    #[must_use]
    pub fn with_deadline(mut self, deadline: Duration) -> Self {
        self.gel = self.gel.with_deadline(deadline);
        self
    }

    /// Presses the gel down to the depth of the press: takes about a second. If the material
    /// relaxes, it does so during the press, at the speed of the press.
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a location beside the gel; a depth at which the
    /// solver finds no equilibrium.
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

    /// The pose at which an indenter first touches the undeformed gel, when it is lowered from the
    /// pose `above` in the gel's frame (whose height is ignored).
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a location beside the gel.
    pub fn touch(&self, indenter: &str, above: &Pose) -> Result<Pose, Error> {
        Ok(self.gel.touch(self.gel.shape(indenter)?, above)?)
    }

    /// The gel at rest, to be pressed frame by frame with poses as they come. `poses`, in the gel's
    /// frame, outline where the indenter will go; give at least one. The mesh is fine along the
    /// straight lines between them, and for the deepest of them. Takes about a second.
    ///
    /// ```
    /// use twintac::{Error, Gel, Pose, Sensor, SimulateSettings};
    ///
    /// let settings = SimulateSettings { max_path_nodes: 2000, ..SimulateSettings::default() };
    /// let gel = Gel::with_settings(&Sensor::phystac()?, settings);
    /// let touch = gel.touch("sphere-25", &Pose::from_position([-4.0, 4.0, 0.0].into()))?;
    /// let moved = |x_mm: f64, depth_mm: f64| Pose { position_mm: touch.position_mm + glam::dvec3(x_mm, 0.0, -depth_mm), ..touch };
    /// let mut state = gel.state("sphere-25", &[moved(0.0, 1.0), moved(2.0, 1.0)])?;
    /// state.step(0.018, &moved(0.0, 1.0))?;
    /// let frame = state.step(0.018, &moved(2.0, 1.0))?; // slid aside
    /// println!("{:.2} N, {:.2} N mm, {:.2} kPa at t5", frame.force_n, frame.torque_n_mm, frame.pressure_kpa["t5"]);
    /// assert!(frame.force_n.z < -0.3);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a first pose beside the gel.
    ///
    /// # Panics
    /// If `poses` is empty.
    pub fn state(&self, indenter: &str, poses: &[Pose]) -> Result<GelState, Error> {
        assert!(!poses.is_empty(), "at least one pose");
        let path = PressPath {
            rate_hz: Some(PLACES_BETWEEN),
            ..PressPath::through(indenter, (0..).map(f64::from).zip(poses.iter().copied()))
        };
        Ok(self.gel.state_along(self.gel.shape(indenter)?, &path)?)
    }

    /// Moves an indenter along a path, frame by frame. `advanced` is called after each frame and
    /// says whether to continue. A path that cannot be followed to its end is no error: its frames
    /// end early, and [`Followed::failure`] says why.
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a first pose beside the gel; a point outside the
    /// gel, or with the name of a taxel.
    pub fn follow(
        &self,
        path: &PressPath,
        advanced: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Result<Followed, Error> {
        Ok(self.gel.follow(self.gel.shape(&path.indenter)?, path, advanced)?)
    }
}

/// A simulated press, from first contact to full depth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pressed {
    frames: Vec<PressFrame>,
    deepest: PressFrame,
}

impl Pressed {
    /// Provenance of every number of this type: no sensor was read, and no twin was trained.
    pub const PROVENANCE: &'static str = "simulated";

    /// Hydrostatic pressure in the gel over each taxel's port at full depth, kPa; `[n_taxels]`. An
    /// ideal barometer, without gain, delay and relaxation, would read this. A trained
    /// [`Twin`](crate::Twin) predicts what a real one reads.
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
