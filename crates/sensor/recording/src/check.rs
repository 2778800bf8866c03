//! Conditions that every recording meets.

use std::collections::BTreeSet;

use crate::{Press, Recording, RecordingError};

/// Largest deviation of a quaternion's length from 1.
const UNIT_TOLERANCE: f64 = 1e-6;

/// Largest distance of an indenter from the gel's origin, mm: ten times the reach of a robot arm.
const FARTHEST_MM: f64 = 10_000.0;

/// Largest temperature of a chip, °C, of either sign: solder melts below it.
const HOTTEST_C: f64 = 300.0;

impl Recording {
    /// Checks that names are unique, that vectors have their documented shapes, that numbers are
    /// finite (missing readings are NaN and not valid), that indenters are within ten metres of the
    /// gel, that rotations are unit quaternions, and that times increase in every press. Writing
    /// and reading files check it too.
    ///
    /// # Errors
    ///
    /// The first press and frame where a condition is not met.
    pub fn check(&self) -> Result<(), RecordingError> {
        let recording = || "recording".to_owned();
        let mut taxels = BTreeSet::new();
        for taxel in &self.taxels {
            let fresh = taxels.insert(taxel) && !taxel.is_empty();
            expect(fresh, recording, || {
                format!("taxel name `{taxel}` is empty or given twice")
            })?;
        }
        let mut names = BTreeSet::new();
        for press in &self.presses {
            expect(names.insert(&press.name), recording, || {
                format!("press name `{}` is given twice", press.name)
            })?;
            press.check(&self.taxels)?;
        }
        Ok(())
    }
}

impl Press {
    pub(crate) fn check(&self, taxels: &[String]) -> Result<(), RecordingError> {
        let frames = self.time_s.len();
        let lengths = [
            ("gel_from_indenter", self.gel_from_indenter.len()),
            ("force_n", self.force_n.as_ref().map_or(frames, Vec::len)),
            ("taxels_kpa", self.taxels_kpa.len()),
            ("taxels_raw", self.taxels_raw.len()),
            (
                "temperature_c",
                self.temperature_c.as_ref().map_or(frames, Vec::len),
            ),
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

    fn check_frame(&self, frame: usize, taxels: &[String]) -> Result<(), RecordingError> {
        let place = || format!("press `{}`, frame {frame}", self.name);
        let widths = [
            self.taxels_kpa[frame].len(),
            self.taxels_raw[frame].len(),
            self.valid[frame].len(),
        ];
        let n_taxels = taxels.len();
        expect(widths == [n_taxels; 3], place, || {
            format!("expected {n_taxels} taxels, found {widths:?} (kPa, raw, valid)")
        })?;
        if let Some(temperature_c) = &self.temperature_c {
            let row = &temperature_c[frame];
            let is_good = row.len() == n_taxels && row.iter().all(|c| c.is_nan() || c.abs() <= HOTTEST_C);
            expect(is_good, place, || {
                format!(
                    "temperatures are {row:?} °C, expected {n_taxels} within {HOTTEST_C} °C; one that is missing is NaN"
                )
            })?;
        }
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
        let farthest_mm = pose.position_mm.abs().max_element();
        expect(farthest_mm <= FARTHEST_MM, place, || {
            format!(
                "the indenter is {farthest_mm} mm from the gel, expected {FARTHEST_MM} at most; are its lengths in mm?"
            )
        })?;
        let length = pose.rotation.length();
        let is_unit = (length - 1.0).abs() <= UNIT_TOLERANCE;
        expect(is_unit, place, || {
            format!("the rotation's quaternion has length {length}, expected 1")
        })?;
        let force = self.force_n.as_ref().map_or(0.0, |force_n| force_n[frame]);
        expect(force.is_finite(), place, || {
            format!("`force_n` is {force}, expected a finite number")
        })?;
        for (taxel, name) in taxels.iter().enumerate() {
            let [kpa, raw] = [&self.taxels_kpa, &self.taxels_raw].map(|rows| rows[frame][taxel]);
            expect(!kpa.is_infinite() && !raw.is_infinite(), place, || {
                format!("the reading of `{name}` is infinite; one that is missing is NaN")
            })?;
            let is_there = !kpa.is_nan() && !raw.is_nan();
            expect(is_there || !self.valid[frame][taxel], place, || {
                format!("the reading of `{name}` is missing, but marked as valid")
            })?;
        }
        Ok(())
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
