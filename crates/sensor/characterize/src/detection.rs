//! The detection limit: the smallest force that can be distinguished from noise.

use serde::Serialize;
use twintac_recording::Control;

use crate::recorded::Recorded;
use crate::statistics::mean;
use crate::{CharacterizeOptions, Finding, Noise, Sensitivity};

/// The detection limit of a taxel, from noise and sensitivity.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DetectionLimit {
    /// The taxel's name.
    pub taxel: String,
    /// Detection limit of a single reading, N: three times (or as set in the options) the noise
    /// floor, divided by the sensitivity.
    pub single_reading_n: f64,
    /// Detection limit of a mean over the averaging window, N.
    pub averaged_n: Option<f64>,
}

/// The response to a known weight put on above a taxel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KnownStep {
    /// The press's name.
    pub press: String,
    /// The taxel's name.
    pub taxel: String,
    /// The known force, N.
    pub force_n: f64,
    /// Mean reading in the window after the weight was put on, minus that in the window before,
    /// kPa.
    pub step_kpa: f64,
    /// The step divided by the noise floor of single readings.
    pub z_single: f64,
    /// The step divided by the standard deviation of such differences without a load.
    pub z_averaged: f64,
    /// Whether `z_averaged` is at least [`sigmas`](CharacterizeOptions::sigmas).
    pub is_detected: bool,
}

pub(crate) fn limits(
    noise: &Finding<Vec<Noise>>,
    sensitivity: &Finding<Vec<Sensitivity>>,
    options: &CharacterizeOptions,
) -> Finding<Vec<DetectionLimit>> {
    let (Finding::Found(noise), Finding::Found(sensitivity)) = (noise, sensitivity) else {
        return Finding::NotGiven("a noise floor and a sensitivity are required".to_owned());
    };
    let found = sensitivity.iter().filter_map(|response| {
        let noise = noise.iter().find(|noise| noise.taxel == response.taxel)?;
        let limit_n = |deviation_kpa: f64| options.sigmas * deviation_kpa / response.sensitivity_kpa_per_n;
        Some(DetectionLimit {
            taxel: response.taxel.clone(),
            single_reading_n: limit_n(noise.deviation_kpa),
            averaged_n: noise.window_deviation_kpa.map(limit_n),
        })
    });
    Finding::of_list(
        found.collect(),
        "no taxel has both a noise floor and a sensitivity",
    )
}

pub(crate) fn steps(
    recorded: &[Recorded<'_>],
    taxels: &[String],
    noise: &Finding<Vec<Noise>>,
    options: &CharacterizeOptions,
) -> Finding<Vec<KnownStep>> {
    let Finding::Found(noise) = noise else {
        return Finding::NotGiven("a noise floor is required".to_owned());
    };
    let loads = recorded
        .iter()
        .filter(|press| press.press.control == Control::Force);
    let found = loads.filter_map(|load| step(load, taxels, noise, options));
    let why = "no step of a known force (control `force`) is above a taxel and has rests and holds as long as the averaging window";
    Finding::of_list(found.collect(), why)
}

fn step(
    load: &Recorded<'_>,
    taxels: &[String],
    noise: &[Noise],
    options: &CharacterizeOptions,
) -> Option<KnownStep> {
    let taxel = load.taxel?;
    let noise = noise.iter().find(|noise| noise.taxel == taxels[taxel])?;
    let window_deviation_kpa = noise.window_deviation_kpa?;
    let (time_s, phases) = (&load.press.time_s, &load.phases);
    let [off_s, on_s] = [time_s[phases.rest.end.checked_sub(1)?], time_s[phases.hold.start]];
    let from = time_s.partition_point(|at_s| *at_s < off_s - options.window_s);
    let to = time_s.partition_point(|at_s| *at_s < on_s + options.window_s);
    if from == 0 || to > phases.hold.end {
        return None;
    }
    let before_kpa = mean(&load.readings_kpa(taxel, &(from..phases.rest.end)))?;
    let with_kpa = mean(&load.readings_kpa(taxel, &(phases.hold.start..to)))?;
    let step_kpa = with_kpa - before_kpa;
    let z_averaged = step_kpa / window_deviation_kpa;
    Some(KnownStep {
        press: load.press.name.clone(),
        taxel: taxels[taxel].clone(),
        force_n: load.peak_n(),
        step_kpa,
        z_single: step_kpa / noise.deviation_kpa,
        z_averaged,
        is_detected: z_averaged >= options.sigmas,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::noise;
    use crate::synthetic::{Shape, all, press, rests};
    use twintac_recording::Press;

    fn weight(force_n: f64) -> Shape {
        Shape {
            peak_n: force_n,
            loading_s: 0.1,
            hold_s: 4.0,
            rest_s: 10.0,
            control: Control::Force,
            noise_kpa: 0.02,
            ..Shape::default()
        }
    }

    fn all_steps(presses: &[Press]) -> Vec<KnownStep> {
        let (all, names) = (all(presses), ["a".to_owned(), "b".to_owned()]);
        let noise = noise(&rests(presses), &[], &names, &CharacterizeOptions::default());
        let steps = steps(&all, &names, &noise, &CharacterizeOptions::default());
        steps.found().unwrap().clone()
    }

    fn steps_of(force_n: f64) -> KnownStep {
        all_steps(&[press(&weight(force_n))])[0].clone()
    }

    #[test]
    fn a_step_is_as_high_as_it_was_made() {
        let step = steps_of(0.01);
        assert!((step.step_kpa - 0.07).abs() < 0.005, "{step:?}");
        assert!(
            (step.z_single - 3.5).abs() < 0.3 && step.z_averaged > 3.0 && step.is_detected,
            "{step:?}"
        );
    }

    #[test]
    fn what_is_far_below_the_noise_is_not_detected() {
        assert!(!steps_of(1e-6).is_detected);
    }

    #[test]
    fn a_weight_that_is_on_from_the_first_frame_makes_no_step() {
        let loaded = Shape {
            rest_s: 0.0,
            loading_s: 0.0,
            ..weight(2.0)
        };
        let steps = all_steps(&[press(&weight(1.0)), press(&loaded)]);
        let forces_n: Vec<f64> = steps.iter().map(|step| step.force_n).collect();
        assert_eq!(forces_n, [1.0]);
    }

    #[test]
    fn the_limit_is_three_deviations() {
        let noise = Finding::Found(vec![Noise {
            taxel: "a".into(),
            deviation_kpa: 0.02,
            window_deviation_kpa: None,
            n_windows: 0,
            n_readings: 99,
        }]);
        let response = Finding::Found(vec![Sensitivity {
            taxel: "a".into(),
            sensitivity_kpa_per_n: 6.0,
            offset_kpa: 0.0,
            linear_to_n: 1.0,
            is_linear_to_end: true,
            linearity_percent: 0.0,
            data_to_n: 1.0,
            n_presses: 1,
            response: Vec::new(),
        }]);
        let limits = limits(&noise, &response, &CharacterizeOptions::default());
        assert!((limits.found().unwrap()[0].single_reading_n - 0.01).abs() < 1e-12);
    }
}
