//! The emulated gel as the emulated devices feel it while a robot moves.
//!
//! Each location of a plan is computed before the robot moves, as a table over depth of the gel's
//! instantaneous response; with friction there is one table for the way in and one for the way
//! back. Relaxation is added as a fading memory of the table's values,
//! `σ(t) = (1 - Σ wᵢ) σₑ(t) + Σ wᵢ ∫ exp(-(t - s)/τᵢ) dσₑ(s)`: quasi-linear viscoelasticity (Fung,
//! Biomechanics, 1981, section 7.6). It holds for any motion of the robot, as long as the indenter
//! pushes.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use serde::{Deserialize, Serialize};
use twintac_depth_table::PressFrame;
use twintac_emulate::{MOST_TAXELS, Physics, Sensed};
use twintac_protocol::PressPlan;
use twintac_random::{RandomStream, normal, stream};
use twintac_rig::{TcpPose, Wrench};
use twintac_shape::Pose;

use crate::port::Port;
use crate::ways::{Ways, way_back};
use crate::{EmulatedClimate, Lab, LabError, Relaxation};

/// Depth of the tables beyond the planned depth, mm.
const SPARE_MM: f64 = 0.5;

/// Values of a table: the force, and the pressures at the largest number of taxels.
const VALUES: usize = 1 + MOST_TAXELS;

/// One cast of a sensor, pressed at the locations of a plan, as the devices feel it.
pub struct LiveGel {
    base_from_gel: Pose,
    tool_from_indenter: Pose,
    tables: Vec<Curves>,
    selected: Arc<AtomicUsize>,
    relaxation: Vec<Relaxation>,
    climate: EmulatedClimate,
    /// The port of each taxel.
    ports: Vec<Port>,
    drift_kpa_per_sqrt_s: f64,
    random: RandomStream,
    memory: Memory,
}

/// Tells the gel which press of its plan comes next, and so its indenter and its location.
#[derive(Clone)]
pub struct Selector {
    names: Arc<Vec<String>>,
    selected: Arc<AtomicUsize>,
}

/// The gel's instantaneous response at the location of one press: a table over depth.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LiveTable {
    name: String,
    /// Height of the indenter's origin at first touch, mm, in the gel's frame.
    touch_mm: f64,
    /// How much deeper the indenter is than the robot assumes, mm.
    deeper_mm: f64,
    /// Depths, mm.
    depths_mm: Vec<f64>,
    /// Force at each depth, N.
    force_n: Vec<f64>,
    /// Pressure of every taxel at each depth, kPa.
    pressures_kpa: Vec<Vec<f64>>,
    /// The same for the way back, from the largest depth on. Empty without friction.
    depths_back_mm: Vec<f64>,
    force_back_n: Vec<f64>,
    pressures_back_kpa: Vec<Vec<f64>>,
}

/// A table that can be evaluated at any depth.
struct Curves {
    touch_mm: f64,
    deeper_mm: f64,
    of: [Option<Ways>; VALUES],
}

/// The history of the press.
struct Memory {
    time_s: f64,
    elastic: [f64; VALUES],
    /// Largest depth of this touch, mm. The way back begins there.
    turn_mm: f64,
    /// State of each relaxation term.
    fading: Vec<[f64; VALUES]>,
    walk_kpa: [f64; MOST_TAXELS],
}

impl Lab {
    /// Computes the gel's response at the location of a press.
    ///
    /// # Errors
    /// A location that cannot be pressed, or not to the planned depth.
    pub fn live_table(&self, plan: &PressPlan) -> Result<LiveTable, LabError> {
        let mut random = stream(self.emulator().seed, &plan.name);
        let place = self.true_place(plan, &mut random)?;
        let deeper_mm = self.depth_offset_mm(&mut random);
        let place = twintac_simulate::PressPlace {
            depth_mm: plan.depth_mm + deeper_mm.max(0.0) + SPARE_MM,
            ..place
        };
        let table = self
            .instantaneous()
            .depth_table(&place)
            .map_err(|source| LabError::Simulate {
                press: plan.name.clone(),
                source,
            })?;
        // The additional depth may be blocked by the shell.
        let deepest_mm = table.frames.last().map_or(0.0, |frame| frame.depth_mm);
        if let Some(why) = &table.failure
            && deepest_mm < plan.depth_mm + deeper_mm.max(0.0)
        {
            return Err(LabError::NotConverged {
                press: plan.name.clone(),
                why: why.clone(),
            });
        }
        let back = if self.has_friction(&plan.indenter) {
            way_back(&self.instantaneous(), &place, &table.frames, &plan.name)?
        } else {
            Vec::new()
        };
        Ok(LiveTable {
            name: plan.name.clone(),
            touch_mm: self.on_the_bench(&table.gel_from_indenter_at_touch).position_mm.z,
            deeper_mm,
            depths_mm: column(&table.frames, &|frame| frame.depth_mm),
            force_n: column(&table.frames, &|frame| frame.force_n),
            pressures_kpa: self.pressures_kpa(&table.frames),
            depths_back_mm: column(&back, &|frame| frame.depth_mm),
            force_back_n: column(&back, &|frame| frame.force_n),
            pressures_back_kpa: self.pressures_kpa(&back),
        })
    }

    /// Pressures of every taxel.
    fn pressures_kpa(&self, frames: &[PressFrame]) -> Vec<Vec<f64>> {
        let of = |taxel: usize| column(frames, &|frame| frame.port_pressure_kpa[taxel]);
        (0..self.ports().len()).map(of).collect()
    }

    /// The gel at a pose in the robot's base frame, under an indenter at a pose in the tool's
    /// frame.
    #[must_use]
    pub fn live(
        &self,
        tables: &[LiveTable],
        base_from_gel: Pose,
        tool_from_indenter: Pose,
    ) -> (LiveGel, Selector) {
        let emulator = self.emulator();
        let selected = Arc::new(AtomicUsize::new(usize::MAX));
        let selector = Selector {
            names: Arc::new(tables.iter().map(|table| table.name.clone()).collect()),
            selected: Arc::clone(&selected),
        };
        let gel = LiveGel {
            base_from_gel,
            tool_from_indenter,
            tables: tables.iter().map(LiveTable::curves).collect(),
            selected,
            memory: Memory {
                time_s: 0.0,
                elastic: [0.0; VALUES],
                turn_mm: 0.0,
                fading: vec![[0.0; VALUES]; emulator.gel.relaxation.len()],
                walk_kpa: [0.0; MOST_TAXELS],
            },
            relaxation: emulator.gel.relaxation.clone(),
            climate: emulator.climate.clone(),
            ports: self.ports().to_vec(),
            drift_kpa_per_sqrt_s: emulator.readout.drift_kpa_per_sqrt_s,
            random: stream(emulator.seed, "live"),
        };
        (gel, selector)
    }
}

impl LiveTable {
    fn curves(&self) -> Curves {
        let columns = std::iter::once(&self.force_n).chain(&self.pressures_kpa);
        let columns_back = std::iter::once(&self.force_back_n).chain(&self.pressures_back_kpa);
        let mut of = [const { None }; VALUES];
        for (ways, (column, column_back)) in of.iter_mut().zip(columns.zip(columns_back)) {
            *ways = Ways::new(
                points(&self.depths_mm, column),
                &points(&self.depths_back_mm, column_back),
            );
        }
        Curves {
            touch_mm: self.touch_mm,
            deeper_mm: self.deeper_mm,
            of,
        }
    }
}

fn column(frames: &[PressFrame], value: &dyn Fn(&PressFrame) -> f64) -> Vec<f64> {
    frames.iter().map(value).collect()
}

fn points(depths_mm: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    depths_mm
        .iter()
        .zip(values)
        .map(|(depth_mm, value)| [*depth_mm, *value])
        .collect()
}

impl Selector {
    /// Selects a press by its name, and with it its indenter. Returns false if the plan has no such
    /// press.
    #[must_use]
    pub fn select(&self, press: &str) -> bool {
        let found = self.names.iter().position(|name| name == press);
        if let Some(index) = found {
            self.selected.store(index, Ordering::Relaxed);
        }
        found.is_some()
    }
}

impl Physics for LiveGel {
    fn at(&mut self, tool: &TcpPose, time_s: f64) -> Sensed {
        let tip_mm = tool.position_mm + tool.base_from_tool() * self.tool_from_indenter.position_mm;
        let tip_mm = self.base_from_gel.inverse_transform_point(tip_mm);
        let elastic = match self.tables.get(self.selected.load(Ordering::Relaxed)) {
            Some(table) => table.at(tip_mm.z, &mut self.memory.turn_mm),
            None => [0.0; VALUES],
        };
        let step_s = time_s - self.memory.time_s;
        let felt = self.memory.advance(elastic, time_s, &self.relaxation);
        let force_n = self.base_from_gel.rotation * (DVec3::NEG_Z * felt[0]);
        let warmed_k = self.climate.warmed_k(time_s);
        let arm_mm = tool.position_mm - self.base_from_gel.position_mm;
        let deviation_kpa = self.drift_kpa_per_sqrt_s * step_s.max(0.0).sqrt();
        let mut taxel_pressures_kpa = [Port::PERFECT.absolute_kpa(0.0, warmed_k); MOST_TAXELS];
        for (taxel, port) in self.ports.iter().enumerate() {
            let walk_kpa = &mut self.memory.walk_kpa[taxel];
            *walk_kpa += normal(&mut self.random, deviation_kpa);
            taxel_pressures_kpa[taxel] = port.absolute_kpa(felt[1 + taxel], warmed_k) + *walk_kpa;
        }
        Sensed {
            taxel_pressures_kpa,
            temperature_c: self.climate.start_c + warmed_k,
            wrench: Wrench {
                force_n,
                torque_n_mm: arm_mm.cross(force_n),
            },
        }
    }
}

impl Curves {
    /// The values with the indenter's origin at a height, mm, in the bench's frame. `turn_mm` is
    /// the largest depth of this touch so far, mm.
    fn at(&self, height_mm: f64, turn_mm: &mut f64) -> [f64; VALUES] {
        let depth_mm = self.touch_mm - height_mm + self.deeper_mm;
        if depth_mm <= 0.0 {
            *turn_mm = 0.0;
            return [0.0; VALUES];
        }
        *turn_mm = depth_mm.max(*turn_mm);
        let share = self.of[0].as_ref().map_or(0.0, |force_n| {
            force_n.inwards(*turn_mm) / force_n.inwards(force_n.turn())
        });
        std::array::from_fn(|value| {
            let ways = self.of[value].as_ref();
            ways.map_or(0.0, |ways| ways.back(depth_mm, *turn_mm, share))
        })
    }
}

impl Memory {
    /// Advances by a step in which the elastic values change linearly. Returns the values at its
    /// end.
    fn advance(&mut self, elastic: [f64; VALUES], time_s: f64, terms: &[Relaxation]) -> [f64; VALUES] {
        let step_s = time_s - self.time_s;
        let weights: f64 = terms.iter().map(|term| term.weight).sum();
        let mut felt = elastic.map(|value| (1.0 - weights) * value);
        for (term, fading) in terms.iter().zip(&mut self.fading) {
            let part = step_s / term.time_s;
            let fade = (-part).exp();
            // The mean of the fading over the step.
            let share = if part > 0.0 { (1.0 - fade) / part } else { 1.0 };
            for value in 0..VALUES {
                fading[value] = fade * fading[value] + share * (elastic[value] - self.elastic[value]);
                felt[value] += term.weight * fading[value];
            }
        }
        (self.time_s, self.elastic) = (time_s, elastic);
        // The indenter pushes and never pulls. A gel that returns more slowly than the indenter has
        // lost contact, and has no load on its surface.
        if felt[0] > 0.0 { felt } else { [0.0; VALUES] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_felt_once_the_indenter_is_off() {
        let terms = [Relaxation {
            weight: 0.2,
            time_s: 4.0,
        }];
        let mut memory = Memory {
            time_s: 0.0,
            elastic: [0.0; VALUES],
            turn_mm: 0.0,
            fading: vec![[0.0; VALUES]],
            walk_kpa: [0.0; MOST_TAXELS],
        };
        for step in 0..2000 {
            memory.advance([5.0; VALUES], f64::from(step) * 1e-3, &terms);
        }
        for step in 2000..4000 {
            let felt = memory.advance([0.0; VALUES], f64::from(step) * 1e-3, &terms);
            assert_eq!(felt, [0.0; VALUES]);
        }
    }

    #[test]
    fn a_held_value_relaxes_as_its_terms_say() {
        let terms = [(0.1, 0.4), (0.2, 4.0)].map(|(weight, time_s)| Relaxation { weight, time_s });
        let mut memory = Memory {
            time_s: 0.0,
            elastic: [0.0; VALUES],
            turn_mm: 0.0,
            fading: vec![[0.0; VALUES]; 2],
            walk_kpa: [0.0; MOST_TAXELS],
        };
        let mut felt = memory.advance([5.0; VALUES], 1e-9, &terms)[0];
        assert!((felt - 5.0).abs() < 1e-6, "all of it at once: {felt}");
        for step in 1..=3000 {
            felt = memory.advance([5.0; VALUES], f64::from(step) * 1e-3, &terms)[0];
        }
        let expected = 5.0 * (0.7 + 0.1 * (-3.0_f64 / 0.4).exp() + 0.2 * (-3.0_f64 / 4.0).exp());
        assert!((felt - expected).abs() < 1e-6, "{felt} {expected}");
    }
}
