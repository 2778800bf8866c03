//! The frames of a press in which nothing touches the gel.

use std::ops::Range;

use twintac_recording::{Control, Press, Recording};
use twintac_sensor::Sensor;

use crate::phases::Phases;
use crate::statistics::mean;

/// Height above the described gel at which an indenter certainly does not touch it, mm. Contact
/// heights differ by less.
const CLEAR_MM: f64 = 0.5;

/// A press, and its unloaded frames.
pub(crate) struct Rest<'a> {
    pub(crate) press: &'a Press,
    /// Frames before contact.
    pub(crate) before: Range<usize>,
    /// Frames after contact.
    pub(crate) after: Range<usize>,
}

impl<'a> Rest<'a> {
    /// From the force if it is known, else from the pose.
    pub(crate) fn of(press: &'a Press, sensor: &Sensor) -> Option<Self> {
        if let Some(phases) = Phases::of(press) {
            return Some(Self {
                press,
                before: phases.rest,
                after: phases.rest_after,
            });
        }
        if press.force_n.is_some() || press.control == Control::Force {
            return None;
        }
        let is_clear = |frame: &usize| {
            let at_mm = press.gel_from_indenter[*frame].position_mm;
            let top_mm = sensor.gel.solid.top_height_mm(at_mm.x, at_mm.y, &sensor.surfaces);
            top_mm.is_none_or(|top_mm| at_mm.z > top_mm + CLEAR_MM)
        };
        let n = press.time_s.len();
        let touch = (0..n).find(|frame| !is_clear(frame))?;
        let last = (0..n).rev().find(|frame| !is_clear(frame))?;
        Some(Self {
            press,
            before: 0..touch,
            after: last + 1..n,
        })
    }

    pub(crate) fn all(recording: &'a Recording, sensor: &Sensor) -> Vec<Self> {
        let presses = recording.presses.iter();
        presses.filter_map(|press| Self::of(press, sensor)).collect()
    }

    /// A taxel's valid readings in a range of frames, kPa.
    pub(crate) fn readings_kpa(&self, taxel: usize, frames: &Range<usize>) -> Vec<f64> {
        let valid = frames.clone().filter(|&frame| self.press.valid[frame][taxel]);
        valid.map(|frame| self.press.taxels_kpa[frame][taxel]).collect()
    }

    /// A taxel's mean unloaded reading after the press minus that before, kPa.
    pub(crate) fn change_kpa(&self, taxel: usize) -> Option<f64> {
        let before_kpa = mean(&self.readings_kpa(taxel, &self.before))?;
        Some(mean(&self.readings_kpa(taxel, &self.after))? - before_kpa)
    }
}

#[cfg(test)]
mod tests {
    use twintac_sensor::SensorFile;

    use super::*;
    use crate::synthetic::{Shape, press};

    #[test]
    fn without_a_force_the_pose_tells() {
        let sensor = SensorFile::phystac().unwrap().sensor;
        let top_mm = sensor
            .gel
            .solid
            .top_height_mm(0.0, 0.0, &sensor.surfaces)
            .unwrap();
        let mut press = press(&Shape {
            rest_s: 2.0,
            ..Shape::default()
        });
        // From 1 mm above the gel to 1 mm inside, and back, in 8 s.
        let n = press.time_s.len();
        for (frame, pose) in press.gel_from_indenter.iter_mut().enumerate() {
            let part = (2.0 * frame as f64 / (n - 1) as f64 - 1.0).abs();
            pose.position_mm.z = top_mm - 1.0 + 2.0 * part;
        }
        press.force_n = None;
        let rest = Rest::of(&press, &sensor).unwrap();
        assert!(rest.before.start == 0 && rest.after.end == n);
        let z_mm = |frame: usize| press.gel_from_indenter[frame].position_mm.z - top_mm;
        assert!(z_mm(rest.before.end - 1) > 0.5 && z_mm(rest.before.end) <= 0.5);
        assert!(z_mm(rest.after.start) > 0.5 && z_mm(rest.after.start - 1) <= 0.5);
    }
}
