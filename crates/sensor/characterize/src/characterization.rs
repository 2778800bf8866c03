//! Everything that is found.

use serde::Serialize;
use twintac_recording::{Provenance, Recording};
use twintac_sensor::Sensor;

use crate::recorded::Recorded;
use crate::rest::Rest;
use crate::{
    CharacterizeError, CharacterizeOptions, Condition, CoveredRange, Creep, CrossTalk, DetectionLimit,
    Finding, FrameTiming, Hysteresis, KnownStep, MeanSensitivity, Noise, Quantum, Repeatability, RiseTime,
    Sensitivity, TemperatureDrift, UnloadedCourse, ZeroReturn, condition, creep, cross_talk, detection,
    drift, hysteresis, noise, quantum, range, repeatability, rise, sensitivity, timing,
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
    /// How each taxel's zero moves with temperature.
    pub temperature_drift: Finding<Vec<TemperatureDrift>>,
    /// How often frames come, and how evenly.
    pub timing: Finding<FrameTiming>,
    /// The smallest step between readings.
    pub quantum: Finding<Quantum>,
    /// Which taxels are dead, stuck or late.
    pub conditions: Vec<Condition>,
}

/// Characterizes a sensor from recorded presses. `unloaded` are unloaded readings with temperatures, where there are any.
///
/// # Errors
/// Recordings of another sensor, or without presses.
pub fn characterize(
    recording: &Recording,
    unloaded: &[UnloadedCourse],
    sensor: &Sensor,
    options: &CharacterizeOptions,
) -> Result<Characterization, CharacterizeError> {
    check(recording, sensor)?;
    let taxels = &recording.taxels;
    let recorded = Recorded::all(recording, sensor, options);
    let rests = Rest::all(recording, sensor);
    let noise = noise::noise(&rests, taxels, options);
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
        temperature_drift: drift::with_temperature(unloaded),
        timing: timing::timing(recording),
        quantum: quantum::quantum(recording),
        conditions: condition::conditions(recording),
        noise,
        sensitivity,
        detection_limit,
    })
}

impl Characterization {
    /// The step of the smallest force that was detected.
    #[must_use]
    pub(crate) fn smallest_step(&self) -> Option<&KnownStep> {
        let detected = self.steps.found()?.iter().filter(|step| step.is_detected);
        detected.min_by(|a, b| a.force_n.total_cmp(&b.force_n))
    }
}

fn check(recording: &Recording, sensor: &Sensor) -> Result<(), CharacterizeError> {
    let described: Vec<&str> = sensor.taxels.iter().map(|taxel| taxel.name.as_str()).collect();
    let is_same = recording.taxels.iter().eq(described.iter().copied());
    if recording.sensor != sensor.name || !is_same {
        return Err(CharacterizeError::OtherSensor {
            found: recording.sensor.clone(),
            found_taxels: recording.taxels.join(", "),
            expected: sensor.name.clone(),
            expected_taxels: described.join(", "),
        });
    }
    if recording.presses.is_empty() {
        return Err(CharacterizeError::NoPresses);
    }
    Ok(())
}
