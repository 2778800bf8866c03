//! The bench that presses an imperfect sensor with an imperfect robot.

use std::sync::Arc;

use twintac_depth_table::{MonotoneCubic, PressFrame};
use twintac_emulate::{CHANNELS, Chance};
use twintac_material::Yeoh;
use twintac_protocol::PressPlan;
use twintac_recording::{Control, Press, Provenance, Recording};
use twintac_sensor::Sensor;
use twintac_shape::Pose;
use twintac_simulate::{Gel, Keyframe, PressHistory, PressPlace, SimulateError, SimulateSettings};
use twintac_softbody::{Material, PronyTerm, SolverSettings};

use crate::Reality;
use crate::chain::Chain;

/// Pressure of the air, kPa.
const ATMOSPHERE_KPA: f64 = 101.325;

/// Moments computed in a hold, as fractions of it: most happens early.
const HOLD_FRACTIONS: [f64; 4] = [0.05, 0.2, 0.5, 1.0];

/// The first of them comes at most this long after the hold begins, s; in long holds, others three times as early come before it.
const FIRST_IN_HOLD_S: f64 = 0.2;

/// What can go wrong on the emulated bench.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// The press could not be set up.
    #[error("press `{press}`: {source}")]
    Simulate {
        /// The press's name.
        press: String,
        /// Why.
        source: SimulateError,
    },
    /// The gel's own solver gave up before the press was over.
    #[error("press `{press}`: the emulated gel did not converge {why}")]
    NotConverged {
        /// The press's name.
        press: String,
        /// Where and why.
        why: String,
    },
    /// The plan asks for an indenter that the sensor's description lacks.
    #[error("press `{press}`: there is no indenter `{indenter}` in the sensor's description")]
    NoIndenter {
        /// The press's name.
        press: String,
        /// The indenter's name.
        indenter: String,
    },
}

/// One cast of a sensor on one bench.
pub struct Lab {
    pub(crate) drawing: Arc<Sensor>,
    gel: Gel,
    /// Of each taxel.
    pub(crate) ports: Vec<Port>,
    reality: Reality,
}

/// What becomes of the gel's pressure at a barometer's port.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Port {
    gain: f64,
    offset_kpa: f64,
    offset_kpa_per_k: f64,
}

impl Port {
    /// A perfect one.
    pub(crate) const PERFECT: Self = Self {
        gain: 1.0,
        offset_kpa: 0.0,
        offset_kpa_per_k: 0.0,
    };

    /// Absolute pressure in it, kPa, under a pressure of the gel, kPa, so much warmer than when it was cast, K.
    pub(crate) fn absolute_kpa(&self, gel_kpa: f64, warmed_k: f64) -> f64 {
        ATMOSPHERE_KPA + self.offset_kpa + self.offset_kpa_per_k * warmed_k + self.gain * gel_kpa
    }
}

impl Lab {
    /// Casts a sensor: draws the gains, offsets and places of its taxels.
    #[must_use]
    pub fn new(drawing: Arc<Sensor>, reality: Reality) -> Self {
        let mut chance = Chance::new(reality.seed, "cast");
        let mut cast = (*drawing).clone();
        for taxel in &mut cast.taxels {
            taxel.position_mm.x += chance.normal(reality.readout.position_deviation_mm);
            taxel.position_mm.y += chance.normal(reality.readout.position_deviation_mm);
        }
        let readout = &reality.readout;
        let mut ports = vec![Port::PERFECT; drawing.taxels.len()];
        for port in &mut ports {
            port.gain = readout.gain_mean * (1.0 + chance.normal(readout.gain_deviation));
        }
        for port in &mut ports {
            port.offset_kpa = chance.normal(readout.offset_deviation_kpa);
        }
        for port in &mut ports {
            port.offset_kpa_per_k =
                readout.offset_kpa_per_k + chance.normal(readout.offset_deviation_kpa_per_k);
        }
        let settings = SimulateSettings {
            edges_per_height: reality.gel.edges_per_height,
            edges_per_contact_radius: reality.gel.edges_per_contact_radius,
            max_nodes: usize::MAX,
            // Reality never ends early.
            solver: SolverSettings {
                tolerance: 1e-4,
                max_iterations: 100,
                min_substep: 1.0 / 16.0,
                ..SolverSettings::default()
            },
            ..SimulateSettings::default()
        };
        let gel = Gel::new(Arc::new(cast), settings).with_material(material(&reality));
        Self {
            drawing,
            gel,
            ports,
            reality,
        }
    }

    /// Performs one press and records it. The sensor is as warm as when it was switched on.
    pub fn press(&self, plan: &PressPlan) -> Result<Press, LabError> {
        let mut chance = Chance::new(self.reality.seed, &plan.name);
        let robot = &self.reality.robot;
        let place = self.true_place(plan, &mut chance)?;
        let deeper_mm = self.depth_offset_mm(&mut chance);

        let schedule = plan.trajectory(self.drawing.readout.rate_hz);
        let keyframes = keyframes(&schedule, deeper_mm, self.reality.gel.depth_step_mm);
        let history = self
            .gel
            .press(&place, &keyframes)
            .map_err(|source| LabError::Simulate {
                press: plan.name.clone(),
                source,
            })?;
        if let Some(why) = &history.failure {
            return Err(LabError::NotConverged {
                press: plan.name.clone(),
                why: why.clone(),
            });
        }

        let course = Course::new(&history, &keyframes);
        let mut chain = Chain::new(self);
        let mut frames = Frames::default();
        for &(scheduled_s, depth_mm) in &schedule {
            let (time_s, raw_kpa) = chain.read(scheduled_s, &mut chance, |taxel, time_s| {
                course.pressure_kpa(taxel, time_s)
            });
            let commanded = Pose {
                position_mm: history
                    .gel_from_indenter_at_touch
                    .position_mm
                    .with_x(plan.x_mm)
                    .with_y(plan.y_mm)
                    - glam::DVec3::Z * depth_mm,
                rotation: plan.rotation,
            };
            frames.push(Moment {
                time_s,
                commanded,
                is_touching: depth_mm >= -0.1,
                force_n: course.force_n(time_s - robot.force_lag_s) + chance.normal(robot.force_noise_n),
                raw_kpa,
            });
        }
        Ok(frames.into_press(&plan.name, &plan.indenter, Control::Pose, &self.drawing))
    }

    /// A recording of presses that this bench performed.
    #[must_use]
    pub fn recording(&self, presses: Vec<Press>) -> Recording {
        Recording {
            sensor: self.drawing.name.clone(),
            provenance: Provenance::Emulated,
            taxels: self
                .drawing
                .taxels
                .iter()
                .map(|taxel| taxel.name.clone())
                .collect(),
            presses,
        }
    }

    pub(crate) fn reality(&self) -> &Reality {
        &self.reality
    }

    /// The gel without what relaxes.
    pub(crate) fn instantaneous(&self) -> Gel {
        let material = Material {
            prony: Vec::new(),
            ..self.gel.material().clone()
        };
        self.gel.clone().with_material(material)
    }

    /// The taxels that have a channel of a switch, and it.
    pub(crate) fn taxel_channels(&self) -> impl Iterator<Item = (usize, usize)> {
        let channels = self.drawing.taxels.iter().map(|taxel| usize::from(taxel.channel));
        channels.enumerate().filter(|&(_, channel)| channel < CHANNELS)
    }

    /// The port of each channel; of one without a taxel, a perfect one.
    pub(crate) fn channels(&self) -> [Port; CHANNELS] {
        let mut channels = [Port::PERFECT; CHANNELS];
        for (taxel, channel) in self.taxel_channels() {
            channels[channel] = self.ports[taxel];
        }
        channels
    }

    /// How much deeper than the robot believes the indenter is in a press, mm.
    pub(crate) fn depth_offset_mm(&self, chance: &mut Chance) -> f64 {
        let robot = &self.reality.robot;
        robot.depth_offset_mm + chance.normal(robot.depth_deviation_mm)
    }

    pub(crate) fn true_place(&self, plan: &PressPlan, chance: &mut Chance) -> Result<PressPlace, LabError> {
        let indenter = self
            .drawing
            .indenters
            .iter()
            .find(|indenter| indenter.name == plan.indenter)
            .ok_or_else(|| LabError::NoIndenter {
                press: plan.name.clone(),
                indenter: plan.indenter.clone(),
            })?;
        let robot = &self.reality.robot;
        Ok(PressPlace {
            enough_force_n: None,
            indenter: plan.indenter.clone(),
            shape: indenter.shape.clone(),
            x_mm: plan.x_mm + chance.normal(robot.place_deviation_mm),
            y_mm: plan.y_mm + chance.normal(robot.place_deviation_mm),
            rotation: plan.rotation,
            depth_mm: plan.depth_mm,
        })
    }

    pub(crate) fn quantize(&self, kpa: f64) -> f64 {
        let step_kpa = self.drawing.readout.resolution_kpa;
        (kpa / step_kpa).round() * step_kpa
    }
}

fn material(reality: &Reality) -> Material {
    let [c10_kpa, c20_kpa, c30_kpa] = reality.gel.yeoh_kpa;
    Material {
        model: Yeoh {
            c10_kpa,
            c20_kpa,
            c30_kpa,
        }
        .into(),
        bulk_modulus_kpa: reality.gel.bulk_modulus_kpa,
        prony: reality
            .gel
            .relaxation
            .iter()
            .map(|term| PronyTerm {
                weight: term.weight,
                time_s: term.time_s,
            })
            .collect(),
    }
}

/// The moments to compute: where the depth has changed by a step, and some along a hold. All but the first gap is left out while the
/// indenter is well above the gel.
fn keyframes(schedule: &[(f64, f64)], deeper_mm: f64, step_mm: f64) -> Vec<Keyframe> {
    let mut chosen: Vec<Keyframe> = Vec::new();
    let mut at = 0;
    while at < schedule.len() {
        let (time_s, depth_mm) = schedule[at];
        let true_mm = depth_mm + deeper_mm;
        chosen.push(Keyframe {
            time_s,
            depth_mm: true_mm,
        });
        let hold_end = schedule[at..]
            .iter()
            .take_while(|(_, depth)| (depth - depth_mm).abs() < 1e-9)
            .count()
            + at
            - 1;
        if hold_end > at + 1 && true_mm > 0.0 {
            let hold = (hold_end - at) as f64;
            let hold_s = schedule[hold_end].0 - time_s;
            let mut last = at;
            for fraction in hold_fractions(hold_s) {
                let index = at + (fraction * hold).round() as usize;
                if index > last {
                    chosen.push(Keyframe {
                        time_s: schedule[index].0,
                        depth_mm: true_mm,
                    });
                    last = index;
                }
            }
            at = hold_end;
        }
        let from_mm = schedule[at].1;
        let next = schedule[at + 1..]
            .iter()
            .position(|(_, depth)| (depth - from_mm).abs() >= step_mm - 1e-9 || is_turn(schedule, *depth))
            .map(|offset| at + 1 + offset);
        match next {
            Some(index) => at = index,
            None if at + 1 < schedule.len() => at = schedule.len() - 1,
            None => break,
        }
    }
    chosen
}

/// When to compute in a hold of this length, as fractions of it.
fn hold_fractions(hold_s: f64) -> Vec<f64> {
    let mut fractions = HOLD_FRACTIONS.to_vec();
    while fractions[0] * hold_s > FIRST_IN_HOLD_S {
        fractions.insert(0, fractions[0] / 3.0);
    }
    fractions
}

/// Whether a depth is the deepest of the schedule, where the motion turns or holds.
fn is_turn(schedule: &[(f64, f64)], depth_mm: f64) -> bool {
    schedule.iter().all(|(_, other)| *other <= depth_mm + 1e-9)
}

/// The gel's answer over time, between the computed moments.
struct Course {
    pressure_kpa: Vec<MonotoneCubic>,
    force_n: Option<MonotoneCubic>,
}

impl Course {
    fn new(history: &PressHistory, keyframes: &[Keyframe]) -> Self {
        let time_s: Vec<f64> = keyframes.iter().map(|keyframe| keyframe.time_s).collect();
        let curve = |value: &dyn Fn(&PressFrame) -> f64| {
            MonotoneCubic::new(time_s.clone(), history.frames.iter().map(value).collect())
        };
        let n_taxels = history
            .frames
            .first()
            .map_or(0, |frame| frame.port_pressure_kpa.len());
        Self {
            pressure_kpa: (0..n_taxels)
                .filter_map(|k| curve(&|frame| frame.port_pressure_kpa[k]))
                .collect(),
            force_n: curve(&|frame| frame.force_n),
        }
    }

    fn pressure_kpa(&self, taxel: usize, time_s: f64) -> f64 {
        self.pressure_kpa.get(taxel).map_or(0.0, |curve| curve.at(time_s))
    }

    fn force_n(&self, time_s: f64) -> f64 {
        self.force_n.as_ref().map_or(0.0, |curve| curve.at(time_s))
    }
}

pub(crate) struct Moment {
    pub(crate) time_s: f64,
    pub(crate) commanded: Pose,
    /// Whether the gel may be touched.
    pub(crate) is_touching: bool,
    pub(crate) force_n: f64,
    pub(crate) raw_kpa: Vec<f64>,
}

#[derive(Default)]
pub(crate) struct Frames(Vec<Moment>);

impl Frames {
    pub(crate) fn push(&mut self, moment: Moment) {
        self.0.push(moment);
    }

    /// Zeroes each taxel on the frames above the gel, as a recorder does before each press.
    pub(crate) fn into_press(self, name: &str, indenter: &str, control: Control, sensor: &Sensor) -> Press {
        let n_before = self
            .0
            .iter()
            .take_while(|moment| !moment.is_touching)
            .count()
            .max(1);
        let baseline_kpa: Vec<f64> = (0..sensor.taxels.len())
            .map(|taxel| self.0[..n_before].iter().map(|m| m.raw_kpa[taxel]).sum::<f64>() / n_before as f64)
            .collect();
        let range = sensor.readout.min_kpa..=sensor.readout.max_kpa;
        Press {
            name: name.to_owned(),
            mounting: "lab".into(),
            indenter: indenter.to_owned(),
            control,
            time_s: self.0.iter().map(|m| m.time_s).collect(),
            gel_from_indenter: self.0.iter().map(|m| m.commanded).collect(),
            force_n: Some(self.0.iter().map(|m| m.force_n).collect()),
            taxels_kpa: self
                .0
                .iter()
                .map(|m| {
                    m.raw_kpa
                        .iter()
                        .zip(&baseline_kpa)
                        .map(|(raw, zero)| raw - zero)
                        .collect()
                })
                .collect(),
            valid: self
                .0
                .iter()
                .map(|m| m.raw_kpa.iter().map(|raw| range.contains(raw)).collect())
                .collect(),
            taxels_raw: self.0.into_iter().map(|m| m.raw_kpa).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keyframes_keep_turns_and_ends() {
        let mut schedule: Vec<(f64, f64)> = (0..=60)
            .map(|i| (f64::from(i) * 0.02, -0.2 + f64::from(i) * 0.02))
            .collect();
        schedule.extend((1..=50).map(|i| (1.2 + f64::from(i) * 0.02, 1.0)));
        schedule.extend((1..=60).map(|i| (2.2 + f64::from(i) * 0.02, 1.0 - f64::from(i) * 0.02)));
        let chosen = keyframes(&schedule, 0.05, 0.25);
        assert!(chosen.windows(2).all(|pair| pair[0].time_s < pair[1].time_s));
        assert!(chosen.len() < 25, "{}", chosen.len());
        let deepest = chosen.iter().filter(|k| (k.depth_mm - 1.05).abs() < 1e-9).count();
        assert!(deepest >= 5, "start, inside and end of the hold: {deepest}");
        assert!((chosen.last().unwrap().time_s - schedule.last().unwrap().0).abs() < 1e-12);
    }
}
