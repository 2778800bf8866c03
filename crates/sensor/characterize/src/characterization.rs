//! The whole characterization of a sensor.

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

/// The characterization of a sensor. Each figure states what it was found from, or why the
/// recordings do not give it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Characterization {
    /// The sensor's name.
    pub sensor: String,
    /// Provenance of the readings.
    pub provenance: Provenance,
    /// Names of the indenters.
    pub indenters: Vec<String>,
    /// Number of presses in the recordings.
    pub n_presses: usize,
    /// Number of presses with a known force and a contact. The figures that need a force use only
    /// these.
    pub n_used: usize,
    /// Number of frames outside of presses.
    pub n_frames_alone: usize,
    /// Number of windows of five seconds outside of presses that were left out of a taxel's noise,
    /// zero and temperature drift, because its readings jump there.
    pub n_leaps: usize,
    /// The options: which presses count as above a taxel, slow, fast and long.
    pub options: CharacterizeOptions,
    /// Noise of each taxel while nothing touches.
    pub noise: Finding<Vec<Noise>>,
    /// Mean sensitivity of the taxels.
    pub overall: Finding<MeanSensitivity>,
    /// Response of each taxel to force.
    pub sensitivity: Finding<Vec<Sensitivity>>,
    /// The smallest force that each taxel detects, from noise and sensitivity.
    pub detection_limit: Finding<Vec<DetectionLimit>>,
    /// Steps in reading from known weights.
    pub steps: Finding<Vec<KnownStep>>,
    /// The range of forces and readings that the data cover.
    pub range: Finding<CoveredRange>,
    /// Hysteresis of each taxel.
    pub hysteresis: Finding<Vec<Hysteresis>>,
    /// Rise time.
    pub rise_time: Finding<RiseTime>,
    /// Creep in each long hold above a taxel.
    pub creep: Finding<Vec<Creep>>,
    /// Readings of the other taxels relative to the pressed one.
    pub cross_talk: Finding<CrossTalk>,
    /// Repeatability of each taxel.
    pub repeatability: Finding<Vec<Repeatability>>,
    /// How closely each taxel returns to zero after a press.
    pub zero_return: Finding<Vec<ZeroReturn>>,
    /// Mean reading of each taxel while nothing touches it, and its drift over time.
    pub zero: Finding<Vec<ZeroOverTime>>,
    /// Drift of each taxel's zero with temperature.
    pub temperature_drift: Finding<Vec<TemperatureDrift>>,
    /// Frame rate and its jitter.
    pub timing: Finding<FrameTiming>,
    /// Resolution of the readings.
    pub quantum: Finding<Quantum>,
    /// Which taxels are dead, stuck, late or intermittent.
    pub conditions: Vec<Condition>,
}

/// Characterizes a sensor from recorded presses, and from frames outside of presses (`logs`), in
/// which nothing should touch it. Each log has a clock of its own. One of the two may be empty.
///
/// # Errors
/// The recordings are of another sensor, or there are neither presses nor frames.
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
    /// The temperature coefficients of the zeros, as a file for compensating readings, if the logs
    /// give them.
    #[must_use]
    pub fn compensation(&self) -> Option<Compensation> {
        drift::compensation(&self.sensor, self.provenance, &self.temperature_drift)
    }

    /// The detected step with the smallest force.
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
