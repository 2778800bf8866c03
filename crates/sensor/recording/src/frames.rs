//! Frames of a sensor in memory, without poses.

use crate::{Provenance, RecordingError};

/// Frames of a sensor without poses: a log of readings, whatever touched the sensor. All vectors
/// have the same length, `n_frames`.
#[derive(Clone, Debug)]
pub struct Frames {
    /// Name of the sensor description that the frames belong to.
    pub sensor: String,
    /// Provenance of the numbers.
    pub provenance: Provenance,
    /// Taxel names, in the order of every row.
    pub taxels: Vec<String>,
    /// Time stamps, s, increasing; `[n_frames]`.
    pub time_s: Vec<f64>,
    /// Whether frames are known to be missing before this one; `[n_frames]`.
    pub gap_before: Vec<bool>,
    /// Pressure as in the source, kPa; absolute for barometers. NaN if it is missing or cannot be
    /// used; `[n_frames][n_taxels]`.
    pub readings_kpa: Vec<Vec<f64>>,
    /// Temperatures of the chips, °C; NaN if missing; `[n_frames][n_taxels]`.
    pub temperature_c: Vec<Vec<f64>>,
}

impl Frames {
    /// A log without frames.
    #[must_use]
    pub fn new(sensor: &str, provenance: Provenance, taxels: &[String]) -> Self {
        Self {
            sensor: sensor.to_owned(),
            provenance,
            taxels: taxels.to_vec(),
            time_s: Vec::new(),
            gap_before: Vec::new(),
            readings_kpa: Vec::new(),
            temperature_c: Vec::new(),
        }
    }

    /// Checks that rows have their documented shapes, that numbers are finite or missing (NaN), and
    /// that times increase.
    ///
    /// # Errors
    /// [`RecordingError::Inconsistent`]: the first frame where a condition is not met.
    pub fn check(&self) -> Result<(), RecordingError> {
        let (n_frames, n_taxels) = (self.time_s.len(), self.taxels.len());
        let wrong = |frame: usize, problem: String| {
            Err(RecordingError::Inconsistent {
                place: format!("frame {frame}"),
                problem,
            })
        };
        let lengths = [
            self.gap_before.len(),
            self.readings_kpa.len(),
            self.temperature_c.len(),
        ];
        if lengths != [n_frames; 3] {
            return wrong(
                0,
                format!("expected {n_frames} frames, found {lengths:?} (gaps, readings, temperatures)"),
            );
        }
        for (frame, time_s) in self.time_s.iter().enumerate() {
            let rows = [&self.readings_kpa[frame], &self.temperature_c[frame]];
            if rows.iter().any(|row| row.len() != n_taxels) {
                return wrong(frame, format!("expected {n_taxels} taxels"));
            }
            if !time_s.is_finite() || rows.into_iter().flatten().any(|number| number.is_infinite()) {
                return wrong(
                    frame,
                    "a number is not finite; one that is missing is NaN".to_owned(),
                );
            }
            if let Some(before_s) = frame.checked_sub(1).map(|before| self.time_s[before])
                && *time_s <= before_s
            {
                return wrong(
                    frame,
                    format!("time {time_s} s follows {before_s} s, expected times to increase"),
                );
            }
        }
        Ok(())
    }
}
