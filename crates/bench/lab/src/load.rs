//! A weight on the imperfect sensor.

use glam::DQuat;
use twintac_depth_table::{DepthTable, MonotoneCubic, PressFrame};
use twintac_protocol::{LoadPlan, PressPlan};
use twintac_random::stream;
use twintac_recording::{Control, Press};
use twintac_simulate::PressPlace;

use crate::frames::{Frames, Moment};
use crate::ways::{Ways, way_back};
use crate::{Lab, LabError};

/// Depth of the first trial for a weight, mm.
const FIRST_DEPTH_MM: f64 = 0.1;

/// A table reaches this factor beyond the weight.
const MARGIN: f64 = 1.05;

impl Lab {
    /// Puts a weight on the gel, takes it off again, and records it. The recorded force is the
    /// weight.
    ///
    /// The pressure under a constant force is read from the table of the gel's instantaneous
    /// response. Relaxation changes how deep a weight sinks. In a nearly incompressible gel it
    /// hardly changes the pressures that carry the weight. Therefore loads show no creep.
    ///
    /// # Errors
    /// A location that cannot be pressed, or a weight that the gel does not carry.
    pub fn load(&self, plan: &LoadPlan) -> Result<Press, LabError> {
        let mut random = stream(self.emulator().seed, &plan.name);
        let as_press = PressPlan {
            name: plan.name.clone(),
            indenter: plan.indenter.clone(),
            x_mm: plan.x_mm,
            y_mm: plan.y_mm,
            rotation: DQuat::IDENTITY,
            clearance_mm: 0.0,
            depth_mm: FIRST_DEPTH_MM,
            speed_mm_per_s: 1.0,
            hold_s: plan.hold_s,
        };
        let place = self.true_place(&as_press, &mut random)?;
        let (place, table) = self.depth_table_to(plan, place)?;
        let back = if self.has_friction(&plan.indenter) {
            way_back(&self.instantaneous(), &place, &table.frames, &plan.name)?
        } else {
            Vec::new()
        };
        let over_force = |taxel: usize| {
            let at = |frame: &PressFrame| [frame.force_n, frame.port_pressure_kpa[taxel]];
            let mut inwards: Vec<[f64; 2]> = table.frames.iter().map(at).collect();
            inwards[0][0] = 0.0;
            Ways::new(inwards, &back.iter().map(at).collect::<Vec<_>>())
        };
        let curves: Vec<Option<Ways>> = (0..self.drawing.taxels.len()).map(over_force).collect();
        let course = plan.course(self.drawing.readout.rate_hz);
        let force = MonotoneCubic::new(
            course.iter().map(|(time_s, _)| *time_s).collect(),
            course.iter().map(|(_, force_n)| *force_n).collect(),
        );
        let force_n = |time_s: f64| force.as_ref().map_or(0.0, |force| force.at(time_s));

        // From here on the weight is on the gel, or is being taken off.
        let heaviest_s = course
            .iter()
            .find(|(_, weight_n)| *weight_n >= plan.force_n)
            .map_or(f64::INFINITY, |(time_s, _)| *time_s);

        let mut chain = self.chain();
        let mut frames = Frames::default();
        for &(scheduled_s, weight_n) in &course {
            let (time_s, raw_kpa) = chain.read(scheduled_s, &mut random, |taxel, time_s| {
                curves[taxel].as_ref().map_or(0.0, |curve| {
                    let (force_n, weight_n) = (force_n(time_s), plan.force_n);
                    if time_s < heaviest_s {
                        curve.inwards(force_n)
                    } else {
                        curve.back(force_n, weight_n, weight_n / curve.turn())
                    }
                })
            });
            frames.push(Moment {
                time_s,
                commanded: self.on_the_bench(&table.gel_from_indenter_at_touch),
                is_touching: weight_n > 0.0,
                force_n: weight_n,
                raw_kpa,
            });
        }
        Ok(frames.into_press(&plan.name, &plan.indenter, Control::Force, &self.drawing))
    }

    /// A table that reaches the depth that the weight needs, and little more, because the mesh is
    /// finer for a smaller contact.
    fn depth_table_to(
        &self,
        plan: &LoadPlan,
        mut place: PressPlace,
    ) -> Result<(PressPlace, DepthTable), LabError> {
        let gel = self.instantaneous();
        place.enough_force_n = Some(MARGIN * plan.force_n);
        loop {
            let table = gel.depth_table(&place).map_err(|source| LabError::Simulate {
                press: plan.name.clone(),
                source,
            })?;
            if table
                .frames
                .last()
                .map_or(0.0, |frame: &PressFrame| frame.force_n)
                >= plan.force_n
            {
                return Ok((place, table));
            }
            let press = plan.name.clone();
            if let Some(why) = table.failure {
                return Err(LabError::NotConverged { press, why });
            }
            place.depth_mm *= 2.0;
            if place.depth_mm > gel.height_mm() {
                let why = format!("under {} N: it cannot carry this force", plan.force_n);
                return Err(LabError::NotConverged { press, why });
            }
        }
    }
}
