//! Everything that is found.

use serde::Serialize;
use twintac_recording::{Frames, Provenance, Recording};
use twintac_sensor::Sensor;
use twintac_temperature::Compensation;

use crate::recorded::Recorded;
use crate::rest::Rest;
use crate::untouched::Untouched;
use crate::{
    CharacterizeError, CharacterizeOptions, Condition, CoveredRange, Creep, CrossTalk, DetectionLimit,
    Finding, FrameTiming, Hysteresis, KnownStep, MeanSensitivity, Noise, Quantum, Repeatability, RiseTime,
    Sensitivity, TemperatureDrift, ZeroOverTime, ZeroReturn, condition, creep, cross_talk, detection, drift,
    hysteresis, noise, quantum, range, repeatability, rise, sensitivity, timing, zero,
};

/// A sensor's characterization. Each figure says by itself what it is of, and is missing with a reason where the presses do not give it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Characterization {
    /// The sensor's name.
    pub sensor: String,
    /// Where the readings come from.
    pub provenance: Provenance,
    /// Names of the indenters.
    pub indenters: Vec<String>,
    /// Presses in the recordings.
    pub n_presses: usize,
    /// Those of them whose force is known and that touch.
    pub n_used: usize,
    /// Frames outside of presses.
    pub n_frames_alone: usize,
    /// Of those, spans of five seconds that were left out of a taxel's noise, zero and temperature because its readings leap there.
    pub n_leaps: usize,
    /// What counted as above, slow, fast and long.
    pub options: CharacterizeOptions,
    /// Unloaded noise of each taxel.
    pub noise: Finding<Vec<Noise>>,
    /// What taxels' sensitivities have in common.
    pub overall: Finding<MeanSensitivity>,
    /// Response of each taxel.
    pub sensitivity: Finding<Vec<Sensitivity>>,
    /// Forces that stand out of the noise.
    pub detection_limit: Finding<Vec<DetectionLimit>>,
    /// Weights put on.
    pub steps: Finding<Vec<KnownStep>>,
    /// The range that the data cover.
    pub range: Finding<CoveredRange>,
    /// Hysteresis of each taxel.
    pub hysteresis: Finding<Vec<Hysteresis>>,
    /// Rise time.
    pub rise_time: Finding<RiseTime>,
    /// Creep in each long hold.
    pub creep: Finding<Vec<Creep>>,
    /// What other taxels read.
    pub cross_talk: Finding<CrossTalk>,
    /// How well each taxel repeats itself.
    pub repeatability: Finding<Vec<Repeatability>>,
    /// How far each taxel comes back to zero.
    pub zero_return: Finding<Vec<ZeroReturn>>,
    /// What each taxel reads while nothing touches it, and how that moves with time.
    pub zero: Finding<Vec<ZeroOverTime>>,
    /// How each taxel's zero moves with temperature.
    pub temperature_drift: Finding<Vec<TemperatureDrift>>,
    /// How often frames come, and how evenly.
    pub timing: Finding<FrameTiming>,
    /// The smallest step between readings.
    pub quantum: Finding<Quantum>,
    /// Which taxels are dead, stuck or late.
    pub conditions: Vec<Condition>,
}

/// Characterizes a sensor from recorded presses, and from frames outside of presses, in which nothing should touch it: each of `logs` is on a clock of its
/// own. One of both may be empty.
///
/// # Errors
/// Recordings of another sensor, or neither presses nor frames.
pub fn characterize(
    recording: &Recording,
    logs: &[Frames],
    sensor: &Sensor,
    options: &CharacterizeOptions,
) -> Result<Characterization, CharacterizeError> {
    check(recording, logs, sensor)?;
    let taxels = &recording.taxels;
    let untouched = Untouched::all(logs, taxels.len());
    let recorded = Recorded::all(recording, sensor, options);
    let rests = Rest::all(recording, sensor);
    let noise = noise::noise(&rests, &untouched, taxels, options);
    let sensitivity = sensitivity::sensitivity(&recorded, taxels, options);
    let detection_limit = detection::limits(&noise, &sensitivity, options);
    let mut indenters: Vec<String> = recording
        .presses
        .iter()
        .map(|press| press.indenter.clone())
        .collect();
    indenters.sort_unstable();
    indenters.dedup();
    Ok(Characterization {
        sensor: recording.sensor.clone(),
        provenance: recording.provenance,
        indenters,
        n_presses: recording.presses.len(),
        n_used: recorded.len(),
        n_frames_alone: logs.iter().map(|log| log.time_s.len()).sum(),
        n_leaps: untouched.iter().map(|of_taxel| of_taxel.n_leaps).sum(),
        options: options.clone(),
        overall: sensitivity::overall(&sensitivity),
        steps: detection::steps(&recorded, taxels, &noise, options),
        range: range::covered(&recorded, taxels, &detection_limit),
        hysteresis: hysteresis::hysteresis(&recorded, taxels, options),
        rise_time: rise::rise_time(&recorded, options),
        creep: creep::creep(&recorded, taxels, options),
        cross_talk: cross_talk::cross_talk(&recorded, taxels, options),
        repeatability: repeatability::repeatability(&recorded, taxels, options),
        zero_return: drift::zero_return(&rests, taxels),
        zero: zero::zeros(&untouched, taxels),
        temperature_drift: drift::with_temperature(&untouched, taxels),
        timing: timing::timing(recording, logs),
        quantum: quantum::quantum(recording, logs),
        conditions: condition::conditions(recording, logs),
        noise,
        sensitivity,
        detection_limit,
    })
}

impl Characterization {
    /// How zeros move with temperature, as a file that readings are compensated with, if the logs tell.
    #[must_use]
    pub fn compensation(&self) -> Option<Compensation> {
        drift::compensation(&self.sensor, self.provenance, &self.temperature_drift)
    }

    /// The step of the smallest force that was detected.
    #[must_use]
    pub(crate) fn smallest_step(&self) -> Option<&KnownStep> {
        let detected = self.steps.found()?.iter().filter(|step| step.is_detected);
        detected.min_by(|a, b| a.force_n.total_cmp(&b.force_n))
    }
}

fn check(recording: &Recording, logs: &[Frames], sensor: &Sensor) -> Result<(), CharacterizeError> {
    let described: Vec<&str> = sensor.taxels.iter().map(|taxel| taxel.name.as_str()).collect();
    let of_logs = logs.iter().map(|log| (&log.sensor, &log.taxels));
    for (name, taxels) in of_logs.chain([(&recording.sensor, &recording.taxels)]) {
        let is_same = taxels.iter().eq(described.iter().copied());
        if *name != sensor.name || !is_same {
            return Err(CharacterizeError::OtherSensor {
                found: name.clone(),
                found_taxels: taxels.join(", "),
                expected: sensor.name.clone(),
                expected_taxels: described.join(", "),
            });
        }
    }
    if recording.presses.is_empty() && logs.iter().all(|log| log.time_s.is_empty()) {
        return Err(CharacterizeError::NothingRecorded);
    }
    Ok(())
}
