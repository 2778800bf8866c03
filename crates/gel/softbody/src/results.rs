//! Pressure, stress and reaction forces of a state.

use glam::DVec3;

use crate::MPA_PER_KPA;
use crate::body::SoftBody;
use crate::element::{self, Forces, Response};
use crate::nodal::moved;
use crate::state::State;

impl SoftBody {
    /// Hydrostatic pressure `-tr(σ)/3` at each node, kPa, positive in compression; `[n_nodes]`. At
    /// bonded nodes it is more accurate than elsewhere, because there it follows from the forces
    /// that hold them, except for [`Element::Composite`](crate::Element::Composite).
    #[must_use]
    pub fn pressure_kpa(&self, state: &State) -> Vec<f64> {
        let response = self.response(state);
        self.nodal_pressure_kpa(&response, &state.displacements_mm, &state.pressures_mpa)
    }

    /// The hydrostatic pressure at each node, from the parts of a state.
    fn nodal_pressure_kpa(
        &self,
        response: &Response,
        displacements_mm: &[DVec3],
        solved_mpa: &[f64],
    ) -> Vec<f64> {
        let shares = element::hydrostatic_shares(&self.elements, response, displacements_mm);
        // Averaged in the same way as the volume changes that give the rest of the pressure.
        let pressures_mpa = shares.map_or(solved_mpa.to_vec(), |shares| {
            let shares = shares.as_flattened();
            let modulus_mpa = MPA_PER_KPA * self.material.volume_modulus_kpa();
            let nodes = solved_mpa.iter().zip(&self.volume_stiffness);
            nodes
                .zip(self.volume_sources.from(0))
                .map(|((pressure, stiffness), sources)| {
                    let share: f64 = sources.iter().map(|&source| shares[source as usize]).sum();
                    pressure + share * stiffness / modulus_mpa
                })
                .collect()
        });
        let at = |node: u32| pressures_mpa[node as usize];
        let ends = self.ends.iter();
        let mut nodal_mpa: Vec<f64> = ends.map(|&[a, b]| 0.5 * (at(a) + at(b))).collect();
        if let Some(surface) = &self.bonded_surface {
            let mut corners = Vec::new();
            self.corner_pressures(solved_mpa, &mut corners);
            surface.set_pressures(
                &self.elements,
                response,
                displacements_mm,
                &corners,
                &mut nodal_mpa,
            );
        }
        nodal_mpa.iter().map(|mpa| mpa / MPA_PER_KPA).collect()
    }

    /// Derivatives of the hydrostatic pressure at each node along a state's direction, kPa per unit
    /// of the parameter; `[n_nodes]`.
    #[must_use]
    pub fn pressure_sensitivity_kpa(&self, state: &State, direction: usize) -> Vec<f64> {
        let rates = &state.sensitivities[direction];
        let [before, after] = rates.direction().sides().map(|(material, times)| {
            let history = state.history.combined(1.0, rates.history(), times);
            let response = Response::new(material, 0.0, &history);
            let displacements_mm = moved(&state.displacements_mm, rates.displacements_mm(), times);
            let pressures_mpa = moved(&state.pressures_mpa, rates.pressures_mpa(), times);
            self.nodal_pressure_kpa(&response, &displacements_mm, &pressures_mpa)
        });
        let over = 2.0 * rates.direction().step;
        after
            .iter()
            .zip(before)
            .map(|(after, before)| (after - before) / over)
            .collect()
    }

    /// Von Mises stress at each node, kPa. It is that of the mean Cauchy stress over the deformed
    /// volume of the tetrahedra around the node, including its relaxing part; `[n_nodes]`.
    #[must_use]
    pub fn von_mises_kpa(&self, state: &State) -> Vec<f64> {
        let response = self.response(state);
        element::mean_deviators(&self.elements, &response, &state.displacements_mm)
            .into_iter()
            .map(|([xx, yy, zz, yz, xz, xy], volume)| {
                let square = xx * xx + yy * yy + zz * zz + 2.0 * (yz * yz + xz * xz + xy * xy);
                (1.5 * square).sqrt() / (MPA_PER_KPA * volume)
            })
            .collect()
    }

    /// The forces that hold the bonded nodes, N, in the order of these nodes; `[n_bonded]`.
    #[must_use]
    pub fn bonded_forces_n(&self, state: &State) -> Vec<DVec3> {
        let response = self.response(state);
        let (mut forces, mut corners) = (Forces::default(), Vec::new());
        self.corner_pressures(&state.pressures_mpa, &mut corners);
        self.elements
            .forces(&response, &state.displacements_mm, &corners, &mut forces);
        let forces = forces.forces_n.as_flattened();
        self.mesh()
            .sets
            .bonded
            .iter()
            .map(|&node| {
                let sources = self.force_sources.of(node).iter();
                sources.map(|&source| forces[source as usize]).sum()
            })
            .collect()
    }

    /// The response of the material at the end of the last step: that of a step without duration,
    /// or of the step that a deadline has ended, whose history is not that of its end yet.
    fn response<'a>(&'a self, state: &'a State) -> Response<'a> {
        let time_step_s = state.unfinished.as_ref().map_or(0.0, |step| step.time_step_s);
        Response::new(&self.material, time_step_s, &state.history)
    }
}
