//! An imperfect sensor, pressed by an imperfect robot.

use std::sync::Arc;

use twintac_emulate::CHANNELS;
use twintac_material::Yeoh;
use twintac_protocol::PressPlan;
use twintac_random::{RandomStream, normal, stream};
use twintac_recording::{Control, Press, Provenance, Recording};
use twintac_sensor::Sensor;
use twintac_shape::Pose;
use twintac_simulate::{Gel, PressPlace, SimulateSettings};
use twintac_softbody::{Material, PronyTerm, SolverSettings};

use crate::chain::Chain;
use crate::course::Course;
use crate::frames::{Frames, Moment};
use crate::keyframes::keyframes;
use crate::port::Port;
use crate::{LabError, Reality};

/// One cast of a sensor on one bench.
pub struct Lab {
    pub(crate) drawing: Arc<Sensor>,
    gel: Gel,
    /// Of each taxel.
    ports: Vec<Port>,
    reality: Reality,
}

impl Lab {
    /// Casts a sensor: draws the gains, offsets and places of its taxels.
    #[must_use]
    pub fn new(drawing: Arc<Sensor>, reality: Reality) -> Self {
        let mut random = stream(reality.seed, "cast");
        let mut cast = (*drawing).clone();
        for taxel in &mut cast.taxels {
            taxel.position_mm.x += normal(&mut random, reality.readout.position_deviation_mm);
            taxel.position_mm.y += normal(&mut random, reality.readout.position_deviation_mm);
        }
        let readout = &reality.readout;
        let mut ports = vec![Port::PERFECT; drawing.taxels.len()];
        for port in &mut ports {
            port.gain = readout.gain_mean * (1.0 + normal(&mut random, readout.gain_deviation));
        }
        for port in &mut ports {
            port.offset_kpa = normal(&mut random, readout.offset_deviation_kpa);
        }
        for port in &mut ports {
            port.offset_kpa_per_k =
                readout.offset_kpa_per_k + normal(&mut random, readout.offset_deviation_kpa_per_k);
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
            ..SimulateSettings::fine()
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
        let mut random = stream(self.reality.seed, &plan.name);
        let robot = &self.reality.robot;
        let place = self.true_place(plan, &mut random)?;
        let deeper_mm = self.depth_offset_mm(&mut random);

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
        let mut chain = self.chain();
        let mut frames = Frames::default();
        for &(scheduled_s, depth_mm) in &schedule {
            let (time_s, raw_kpa) = chain.read(scheduled_s, &mut random, |taxel, time_s| {
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
                force_n: course.force_n(time_s - robot.force_lag_s)
                    + normal(&mut random, robot.force_noise_n),
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
    pub(crate) fn depth_offset_mm(&self, random: &mut RandomStream) -> f64 {
        let robot = &self.reality.robot;
        robot.depth_offset_mm + normal(random, robot.depth_deviation_mm)
    }

    pub(crate) fn true_place(
        &self,
        plan: &PressPlan,
        random: &mut RandomStream,
    ) -> Result<PressPlace, LabError> {
        let indenter = self
            .drawing
            .indenter(&plan.indenter)
            .ok_or_else(|| LabError::NoIndenter {
                press: plan.name.clone(),
                indenter: plan.indenter.clone(),
            })?;
        let robot = &self.reality.robot;
        Ok(PressPlace {
            enough_force_n: None,
            indenter: plan.indenter.clone(),
            shape: indenter.shape.clone(),
            x_mm: plan.x_mm + normal(random, robot.place_deviation_mm),
            y_mm: plan.y_mm + normal(random, robot.place_deviation_mm),
            rotation: plan.rotation,
            depth_mm: plan.depth_mm,
        })
    }

    /// The read-out of a press that begins.
    pub(crate) fn chain(&self) -> Chain<'_> {
        Chain::new(
            &self.reality.readout,
            &self.ports,
            self.drawing.readout.resolution_kpa,
        )
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
