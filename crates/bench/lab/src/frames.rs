//! The frames of a press as they are recorded.

use twintac_recording::{Control, Press};
use twintac_sensor::Sensor;
use twintac_shape::Pose;

/// One frame.
pub(crate) struct Moment {
    pub(crate) time_s: f64,
    pub(crate) commanded: Pose,
    /// Whether the gel may be touched.
    pub(crate) is_touching: bool,
    pub(crate) force_n: f64,
    pub(crate) raw_kpa: Vec<f64>,
}

/// The frames of a press, in order.
#[derive(Default)]
pub(crate) struct Frames(Vec<Moment>);

impl Frames {
    pub(crate) fn push(&mut self, moment: Moment) {
        self.0.push(moment);
    }

    /// Subtracts from each taxel its mean over the frames above the gel, as a recorder does before
    /// each press.
    pub(crate) fn into_press(self, name: &str, indenter: &str, control: Control, sensor: &Sensor) -> Press {
        let n_before = self
            .0
            .iter()
            .take_while(|moment| !moment.is_touching)
            .count()
            .max(1);
        let baseline_kpa: Vec<f64> = (0..sensor.taxels.len())
            .map(|taxel| self.0[..n_before].iter().map(|m| m.raw_kpa[taxel]).sum::<f64>() / n_before as f64)
            .collect();
        let range = sensor.readout.min_kpa..=sensor.readout.max_kpa;
        Press {
            name: name.to_owned(),
            mounting: "lab".into(),
            indenter: indenter.to_owned(),
            control,
            time_s: self.0.iter().map(|m| m.time_s).collect(),
            gel_from_indenter: self.0.iter().map(|m| m.commanded).collect(),
            force_n: Some(self.0.iter().map(|m| m.force_n).collect()),
            taxels_kpa: self
                .0
                .iter()
                .map(|m| {
                    m.raw_kpa
                        .iter()
                        .zip(&baseline_kpa)
                        .map(|(raw, zero)| raw - zero)
                        .collect()
                })
                .collect(),
            valid: self
                .0
                .iter()
                .map(|m| m.raw_kpa.iter().map(|raw| range.contains(raw)).collect())
                .collect(),
            temperature_c: None,
            taxels_raw: self.0.into_iter().map(|m| m.raw_kpa).collect(),
        }
    }
}
