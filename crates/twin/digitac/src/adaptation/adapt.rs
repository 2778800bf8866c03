//! Adaptation of a twin to another sensor of the same kind, by few presses.
//!
//! Two casts differ mainly in their gains, and two installations of an indenter in their contact
//! heights. All unknowns are fitted together, and regularized towards the learned values according
//! to how much casts usually differ. Values that few presses do not determine therefore stay. The
//! more presses, the weaker the regularization. Presses of prescribed force determine the
//! stiffness; without them, the gains absorb it.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use twintac_config::Problem;

use super::NewSensor;
use crate::bench_fit::{BenchEstimate, Estimate};
use crate::features::Sample;
use crate::physical_fit::Posterior;
use crate::{DigitacError, Features, Gains, Twin, Variant};

/// The adapted values with their uncertainty: standard deviations of what the presses leave
/// undetermined.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adaptation {
    /// The presses that were used, by number.
    pub used: Vec<usize>,
    /// True minus recorded depth of the tip, mm, by file.
    pub contact_offset_mm: BTreeMap<String, Estimate>,
    /// Ratio of the gel's stiffness to that of the simulated gel; `None` without presses of
    /// prescribed force, where the gains absorb it.
    pub stiffness: Option<Estimate>,
    /// Ratio of readings to port pressures; `[n_taxels]`.
    pub gain: Vec<Estimate>,
    /// Static nonlinearity of the ports: relative growth of a reading, 1/kPa; `[n_taxels]`, or
    /// empty if the twin has none.
    pub stiffening_per_kpa: Vec<Estimate>,
    /// Shares of the overstresses in the readings; `[n_taxels][n_time_constants]`.
    pub memory: Vec<Vec<Estimate>>,
    /// Time constants of the relaxation, s.
    pub time_constants_s: Vec<Estimate>,
    /// Whether the correction by the twin's perceptron was kept. It is dropped if it increases the
    /// error of these presses.
    pub keeps_correction: bool,
}

/// A twin adapted to another sensor, and the sensor's test setup.
#[derive(Clone, Debug)]
pub struct Adapted {
    /// The twin.
    pub twin: Twin,
    /// The test setup of the sensor's presses.
    pub bench: BenchEstimate,
    /// The adapted values.
    pub adaptation: Adaptation,
}

/// Adapts a twin and the estimate of its test setup to the presses `used` of another sensor.
///
/// # Errors
/// The paper's variant, which has no gains; no presses, or none that touches the gel; tables that
/// do not belong to the locations; damaged presses.
pub fn adapt(sensor: &NewSensor<'_>, used: &[usize]) -> Result<Adapted, DigitacError> {
    let twin = sensor.twin;
    if twin.variant() == Variant::Paper {
        let hint = "adapt a twin of another variant";
        return Err(Problem::new("variant", "is the paper's, whose network has no gains", hint).into());
    }
    if used.is_empty() {
        return Err(DigitacError::TooFew {
            expected: "presses to adapt with".into(),
            found: "none".into(),
        });
    }
    let chosen: BTreeSet<usize> = used.iter().copied().collect();
    let as_learned = sensor.features(sensor.bench)?;
    sensor.refuse_untouched(&as_learned, used.iter().copied())?;
    let (bench, posterior) = sensor.learned().fit(&chosen)?;
    let features = sensor.features(&bench)?;
    let with = twin.adapted(posterior.gains.clone(), true);
    let without = twin.adapted(posterior.gains.clone(), false);
    let deviation_kpa = |twin: &Twin| deviation_kpa(twin, sensor, &features, &chosen);
    let keeps_correction = twin.variant().has_perceptron() && deviation_kpa(&with) < deviation_kpa(&without);
    let adaptation = Adaptation {
        used: used.to_vec(),
        contact_offset_mm: bench.contact_offset_mm.clone(),
        stiffness: bench.stiffness,
        keeps_correction,
        ..barometers(&posterior)
    };
    Ok(Adapted {
        twin: if keeps_correction { with } else { without },
        bench,
        adaptation,
    })
}

/// The adapted barometers, with the uncertainty of each value.
fn barometers(posterior: &Posterior) -> Adaptation {
    let gains = &posterior.gains;
    let estimate = |value: &dyn Fn(&Gains) -> f64| Estimate {
        value: value(gains),
        uncertainty: posterior.uncertainty(&|_, gains| value(gains)),
    };
    let (taxels, constants) = (0..gains.gain.len(), 0..gains.time_constants_s.len());
    let has_port_law = gains.stiffening_per_kpa.iter().any(|growth| *growth != 0.0);
    Adaptation {
        used: Vec::new(),
        contact_offset_mm: BTreeMap::new(),
        stiffness: None,
        gain: taxels.clone().map(|k| estimate(&|gains| gains.gain[k])).collect(),
        stiffening_per_kpa: taxels
            .clone()
            .filter(|_| has_port_law)
            .map(|k| estimate(&|gains| gains.stiffening_per_kpa[k]))
            .collect(),
        memory: taxels
            .map(|k| {
                let constants = constants.clone();
                constants.map(|j| estimate(&|gains| gains.memory[k][j])).collect()
            })
            .collect(),
        time_constants_s: constants
            .clone()
            .map(|j| estimate(&|gains| gains.time_constants_s[j]))
            .collect(),
        keeps_correction: false,
    }
}

/// Sum of a twin's absolute deviations from the readings of some presses, kPa.
fn deviation_kpa(
    twin: &Twin,
    sensor: &NewSensor<'_>,
    features: &[Features],
    chosen: &BTreeSet<usize>,
) -> f64 {
    let predicted = twin.predict(&features.iter().collect::<Vec<_>>());
    let presses = sensor.recording.presses.iter().zip(&predicted).enumerate();
    let chosen = presses.filter(|(index, _)| chosen.contains(index));
    chosen
        .map(|(_, (press, predicted))| {
            let sample = Sample {
                readings_kpa: &press.taxels_kpa,
                valid: &press.valid,
            };
            sample.deviation_kpa(predicted, sensor.left_out)
        })
        .sum()
}
