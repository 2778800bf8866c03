//! What every recording promises.

use std::collections::BTreeSet;

use crate::{Press, Recording, RecordingError};

/// Largest distance of a rotation's length from 1.
const UNIT_TOLERANCE: f64 = 1e-6;

impl Recording {
    /// Checks that names are unique, vectors have their documented shapes, numbers are finite, rotations are unit quaternions,
    /// and times increase in every press. Writing and reading files check it too.
    ///
    /// # Errors
    ///
    /// The first press and frame where that does not hold.
    pub fn check(&self) -> Result<(), RecordingError> {
        let recording = || "recording".to_owned();
        let mut taxels = BTreeSet::new();
        for taxel in &self.taxels {
            let fresh = taxels.insert(taxel) && !taxel.is_empty();
            expect(fresh, recording, || {
                format!("taxel name `{taxel}` is empty or there twice")
            })?;
        }
        let mut names = BTreeSet::new();
        for press in &self.presses {
            expect(names.insert(&press.name), recording, || {
                format!("press name `{}` is there twice", press.name)
            })?;
            press.check(self.taxels.len())?;
        }
        Ok(())
    }
}

impl Press {
    pub(crate) fn check(&self, taxels: usize) -> Result<(), RecordingError> {
        let frames = self.time_s.len();
        let lengths = [
            ("gel_from_indenter", self.gel_from_indenter.len()),
            ("force_n", self.force_n.as_ref().map_or(frames, Vec::len)),
            ("taxels_kpa", self.taxels_kpa.len()),
            ("taxels_raw", self.taxels_raw.len()),
            ("valid", self.valid.len()),
        ];
        let press = || format!("press `{}`", self.name);
        expect(frames > 0, press, || "has no frames".to_owned())?;
        for (field, length) in lengths {
            expect(length == frames, press, || {
                format!("`{field}` has {length} frames, `time_s` {frames}")
            })?;
        }
        for frame in 0..frames {
            self.check_frame(frame, taxels)?;
        }
        Ok(())
    }

    fn check_frame(&self, frame: usize, taxels: usize) -> Result<(), RecordingError> {
        let place = || format!("press `{}`, frame {frame}", self.name);
        let widths = [
            self.taxels_kpa[frame].len(),
            self.taxels_raw[frame].len(),
            self.valid[frame].len(),
        ];
        expect(widths == [taxels; 3], place, || {
            format!("expected {taxels} taxels, found {widths:?} (kPa, raw, valid)")
        })?;
        let time_s = self.time_s[frame];
        expect(time_s.is_finite(), place, || {
            format!("`time_s` is {time_s}, expected a finite number")
        })?;
        let before_s = if frame == 0 {
            f64::NEG_INFINITY
        } else {
            self.time_s[frame - 1]
        };
        expect(time_s > before_s, place, || {
            format!("time {time_s} s follows {before_s} s, expected times to increase")
        })?;
        let pose = self.gel_from_indenter[frame];
        let finite = pose.position_mm.is_finite() && pose.rotation.is_finite();
        expect(finite, place, || "the pose is not finite".to_owned())?;
        let length = pose.rotation.length();
        let is_unit = (length - 1.0).abs() <= UNIT_TOLERANCE;
        expect(is_unit, place, || {
            format!("the rotation's quaternion has length {length}, expected 1")
        })?;
        let force = self.force_n.as_ref().map_or(0.0, |force_n| force_n[frame]);
        expect(force.is_finite(), place, || {
            format!("`force_n` is {force}, expected a finite number")
        })?;
        let mut readings = self.taxels_kpa[frame].iter().chain(&self.taxels_raw[frame]);
        expect(readings.all(|reading| reading.is_finite()), place, || {
            "a reading is not finite".to_owned()
        })
    }
}

fn expect(
    holds: bool,
    place: impl FnOnce() -> String,
    problem: impl FnOnce() -> String,
) -> Result<(), RecordingError> {
    if holds {
        Ok(())
    } else {
        Err(RecordingError::Inconsistent {
            place: place(),
            problem: problem(),
        })
    }
}
