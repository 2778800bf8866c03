//! An imperfect sensor that an imperfect robot presses.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use twintac_material::Yeoh;
use twintac_protocol::PressPlan;
use twintac_random::{RandomStream, normal, stream};
use twintac_recording::{Control, Press, Provenance, Recording};
use twintac_sensor::Sensor;
use twintac_shape::{Pose, Solid};
use twintac_simulate::{Gel, PressPlace, SimulateSettings};
use twintac_softbody::{Material, PronyTerm, SolverSettings};

use crate::chain::Chain;
use crate::course::Course;
use crate::frames::{Frames, Moment};
use crate::keyframes::keyframes;
use crate::mounting::Mounting;
use crate::port::{Port, bubble_kpa};
use crate::{EmulatorConfiguration, LabError};

/// One cast of a sensor on one emulated bench.
pub struct Lab {
    pub(crate) drawing: Arc<Sensor>,
    gel: Gel,
    mounting: Mounting,
    /// The port of each taxel.
    ports: Vec<Port>,
    emulator: EmulatorConfiguration,
}

/// Relative height difference up to which a gel counts as made to its drawing.
const SAME_HEIGHT: f64 = 1e-12;

/// Number of iterations that find where a tilted sensor is touched. Each one multiplies the
/// remaining error by about the tilt.
const FOLLOWED: usize = 4;

impl Lab {
    /// Casts a sensor: draws the gains, offsets, bubbles and positions of its taxels at random.
    ///
    /// # Errors
    /// [`LabError::Height`]: the gel's shape comes from a file and the configuration asks for
    /// another height.
    pub fn new(drawing: Arc<Sensor>, emulator: EmulatorConfiguration) -> Result<Self, LabError> {
        let mut random = stream(emulator.seed, "cast");
        let mut cast = (*drawing).clone();
        let ratio = emulator.gel.height_ratio;
        if (ratio - 1.0).abs() > SAME_HEIGHT {
            cast.gel.solid = heightened(&cast.gel.solid, ratio).ok_or_else(|| LabError::Height {
                sensor: drawing.name.clone(),
                ratio,
            })?;
        }
        for taxel in &mut cast.taxels {
            taxel.position_mm.x += normal(&mut random, emulator.readout.position_deviation_mm);
            taxel.position_mm.y += normal(&mut random, emulator.readout.position_deviation_mm);
        }
        let readout = &emulator.readout;
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
        let mut random = stream(emulator.seed, "bubbles");
        for (port, taxel) in ports.iter_mut().zip(&drawing.taxels) {
            let volume_mm3 = readout.bubble_mm3 + normal(&mut random, readout.bubble_deviation_mm3);
            let shear_modulus_kpa = 2.0 * emulator.gel.yeoh_kpa[0];
            port.bubble_kpa = bubble_kpa(volume_mm3.max(0.0), taxel.port_radius_mm, shear_modulus_kpa);
        }
        let settings = SimulateSettings {
            edges_per_height: emulator.gel.edges_per_height,
            edges_per_contact_radius: emulator.gel.edges_per_contact_radius,
            max_nodes: usize::MAX,
            // The emulator never gives up early.
            solver: SolverSettings {
                tolerance: 1e-4,
                max_iterations: 100,
                min_substep: 1.0 / 16.0,
                friction: emulator.gel.friction,
                ..SolverSettings::default()
            },
            ..SimulateSettings::fine()
        };
        let gel = Gel::new(Arc::new(cast), settings).with_material(material(&emulator));
        let described_mm = drawing.gel.solid.bounds_mm(&drawing.surfaces).1.z;
        let mounting = Mounting::new(described_mm, gel.height_mm(), emulator.mounting.tilt_rad);
        Ok(Self {
            drawing,
            gel: gel.with_upwards(mounting.upwards()),
            mounting,
            ports,
            emulator,
        })
    }

    /// Performs one press and records it. The sensor has its temperature at power-up.
    pub fn press(&self, plan: &PressPlan) -> Result<Press, LabError> {
        let mut random = stream(self.emulator.seed, &plan.name);
        let robot = &self.emulator.robot;
        let place = self.true_place(plan, &mut random)?;
        let deeper_mm = self.depth_offset_mm(&mut random);

        let schedule = plan.trajectory(self.drawing.readout.rate_hz);
        let keyframes = keyframes(&schedule, deeper_mm, self.emulator.gel.depth_step_mm);
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
        let touched_mm = self.on_the_bench(&history.gel_from_indenter_at_touch).position_mm;
        for &(scheduled_s, depth_mm) in &schedule {
            let (time_s, raw_kpa) = chain.read(scheduled_s, &mut random, |taxel, time_s| {
                course.pressure_kpa(taxel, time_s)
            });
            let commanded = Pose {
                position_mm: touched_mm.with_x(plan.x_mm).with_y(plan.y_mm) - DVec3::Z * depth_mm,
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

    /// A recording of presses of this emulated bench.
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

    pub(crate) fn emulator(&self) -> &EmulatorConfiguration {
        &self.emulator
    }

    /// The gel without relaxation.
    pub(crate) fn instantaneous(&self) -> Gel {
        let material = Material {
            prony: Vec::new(),
            ..self.gel.material().clone()
        };
        self.gel.clone().with_material(material)
    }

    /// The ports of the taxels.
    pub(crate) fn ports(&self) -> &[Port] {
        &self.ports
    }

    /// How much deeper the indenter is in a press than the robot assumes, mm.
    pub(crate) fn depth_offset_mm(&self, random: &mut RandomStream) -> f64 {
        let robot = &self.emulator.robot;
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
        let robot = &self.emulator.robot;
        let x_mm = plan.x_mm + normal(random, robot.place_deviation_mm);
        let y_mm = plan.y_mm + normal(random, robot.place_deviation_mm);
        let rotation = self.mounting.turned(plan.rotation);
        let on_the_way = |height_mm: f64| self.mounting.on_the_way(DVec2::new(x_mm, y_mm), height_mm);
        let mut at_mm = on_the_way(self.gel.height_mm());
        if self.mounting.upwards() != DVec3::Z {
            for _ in 0..FOLLOWED {
                let above = Pose {
                    position_mm: at_mm,
                    rotation,
                };
                let touch = self.gel.touch(&indenter.shape, &above);
                let touch = touch.map_err(|source| LabError::Simulate {
                    press: plan.name.clone(),
                    source,
                })?;
                at_mm = on_the_way(touch.position_mm.z);
            }
        }
        Ok(PressPlace {
            enough_force_n: None,
            indenter: plan.indenter.clone(),
            shape: indenter.shape.clone(),
            x_mm: at_mm.x,
            y_mm: at_mm.y,
            rotation,
            depth_mm: plan.depth_mm,
        })
    }

    /// An indenter's pose in the bench's frame, from its pose in the gel's frame.
    pub(crate) fn on_the_bench(&self, gel_from_indenter: &Pose) -> Pose {
        Pose {
            position_mm: self.mounting.on_the_bench(gel_from_indenter.position_mm),
            rotation: self.mounting.as_recorded(gel_from_indenter.rotation),
        }
    }

    /// Whether the response of the gel differs between the way in and the way back.
    pub(crate) fn has_friction(&self, indenter: &str) -> bool {
        let described = self.drawing.indenter(indenter).and_then(|known| known.friction);
        described.unwrap_or(self.emulator.gel.friction) > 0.0
    }

    /// The read-out at the start of a press.
    pub(crate) fn chain(&self) -> Chain<'_> {
        Chain::new(
            &self.emulator.readout,
            &self.ports,
            self.drawing.readout.resolution_kpa,
        )
    }
}

/// A gel with its heights scaled by a ratio. `None` if its shape comes from a file.
fn heightened(solid: &Solid, ratio: f64) -> Option<Solid> {
    let mut solid = solid.clone();
    match &mut solid {
        Solid::Block { size_mm, .. } => size_mm[2] *= ratio,
        Solid::Dome(dome) => {
            dome.crown_mm *= ratio;
            let drops = dome.drop_x_mm.iter_mut().chain(&mut dome.drop_y_mm);
            drops.for_each(|drop_mm| *drop_mm *= ratio);
        }
        Solid::Stl { .. } => return None,
    }
    Some(solid)
}

fn material(emulator: &EmulatorConfiguration) -> Material {
    let [c10_kpa, c20_kpa, c30_kpa] = emulator.gel.yeoh_kpa;
    Material {
        model: Yeoh {
            c10_kpa,
            c20_kpa,
            c30_kpa,
        }
        .into(),
        bulk_modulus_kpa: emulator.gel.bulk_modulus_kpa,
        prony: emulator
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
