//! The response of the gel over time.

use twintac_depth_table::{MonotoneCubic, PressFrame};
use twintac_simulate::{Keyframe, PressHistory};

/// The response of the gel over time, interpolated between the computed moments.
pub(crate) struct Course {
    pressure_kpa: Vec<MonotoneCubic>,
    force_n: Option<MonotoneCubic>,
}

impl Course {
    pub(crate) fn new(history: &PressHistory, keyframes: &[Keyframe]) -> Self {
        let time_s: Vec<f64> = keyframes.iter().map(|keyframe| keyframe.time_s).collect();
        let curve = |value: &dyn Fn(&PressFrame) -> f64| {
            MonotoneCubic::new(time_s.clone(), history.frames.iter().map(value).collect())
        };
        let n_taxels = history
            .frames
            .first()
            .map_or(0, |frame| frame.port_pressure_kpa.len());
        Self {
            pressure_kpa: (0..n_taxels)
                .filter_map(|k| curve(&|frame| frame.port_pressure_kpa[k]))
                .collect(),
            force_n: curve(&|frame| frame.force_n),
        }
    }

    pub(crate) fn pressure_kpa(&self, taxel: usize, time_s: f64) -> f64 {
        self.pressure_kpa.get(taxel).map_or(0.0, |curve| curve.at(time_s))
    }

    pub(crate) fn force_n(&self, time_s: f64) -> f64 {
        self.force_n.as_ref().map_or(0.0, |curve| curve.at(time_s))
    }
}
