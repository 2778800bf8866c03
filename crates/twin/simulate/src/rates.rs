//! A press with its derivatives with respect to constants of the gel's material and to the position
//! of the indenter.

use glam::DVec3;
use twintac_shape::Pose;
use twintac_softbody::Direction;

use crate::{GelMesh, Keyframe, SimulateError};

/// One moment of a press, and its derivatives along each requested direction.
#[derive(Clone, Debug, PartialEq)]
pub struct RatedFrame {
    /// Time, s.
    pub time_s: f64,
    /// Depth below first touch, mm.
    pub depth_mm: f64,
    /// Force of the indenter on the gel along -z, N.
    pub force_n: f64,
    /// Derivatives of the force, N per unit of the direction's parameter; `[n_directions]`.
    pub force_rates_n: Vec<f64>,
    /// Hydrostatic pressure -tr(σ)/3, averaged over each taxel's port, kPa; `[n_taxels]`.
    pub port_pressure_kpa: Vec<f64>,
    /// Derivatives of the pressures, kPa per unit of the direction's parameter;
    /// `[n_directions][n_taxels]`.
    pub port_pressure_rates_kpa: Vec<Vec<f64>>,
}

impl GelMesh {
    /// Presses along the keyframes, each of them `deeper_mm` deeper than given. Unlike in a table,
    /// a press that fails is an error.
    ///
    /// # Errors
    /// A direction for another material, or a keyframe that cannot be reached.
    pub fn press_with_rates(
        &self,
        keyframes: &[Keyframe],
        deeper_mm: f64,
        directions: &[Direction],
    ) -> Result<Vec<RatedFrame>, SimulateError> {
        let mut state = self.body.rest_with_sensitivities(directions)?;
        let mut frames = Vec::with_capacity(keyframes.len());
        let mut previous_s = keyframes.first().map_or(0.0, |keyframe| keyframe.time_s);
        for keyframe in keyframes {
            let pose = Pose {
                position_mm: self.touch.position_mm - DVec3::Z * (keyframe.depth_mm + deeper_mm),
                ..self.touch
            };
            let time_step_s = keyframe.time_s - previous_s;
            previous_s = keyframe.time_s;
            let frame = self
                .body
                .advance(&mut state, self.indenter.as_ref(), &pose, time_step_s)
                .map_err(|error| SimulateError::Press {
                    depth_mm: keyframe.depth_mm,
                    error,
                })?;
            let at_ports = |nodal_kpa: &[f64]| self.ports.iter().map(|port| port.read(nodal_kpa)).collect();
            let rates = 0..directions.len();
            frames.push(RatedFrame {
                time_s: keyframe.time_s,
                depth_mm: keyframe.depth_mm,
                force_n: -frame.indenter_force_n.z,
                force_rates_n: state.force_sensitivities_n().iter().map(|rate| -rate.z).collect(),
                port_pressure_kpa: at_ports(&self.body.pressure_kpa(&state)),
                port_pressure_rates_kpa: rates
                    .map(|index| at_ports(&self.body.pressure_sensitivity_kpa(&state, index)))
                    .collect(),
            });
        }
        Ok(frames)
    }
}
