//! The plot of measured and fitted curves, and of their residuals.

use twintac_calibrate::{Fit, FittedSignal};
use twintac_plot::{Ink, Panel, Panels, Scene, Series};
use twintac_sensor::Sensor;

/// Most signals that get panels of their own; more would be illegible.
const MOST_SHOWN: usize = 6;

/// The plot of a fit: a panel for each signal, and one for its residuals below. `kinds` is the
/// provenance of the curves in words.
pub(super) fn scene(fit: &Fit, sensor: &Sensor, kinds: &str) -> Scene {
    let rises = |signal: &FittedSignal| signal.depth_mm.windows(2).all(|pair| pair[1] > pair[0]);
    let over_depth = fit.material.prony.is_empty() && fit.signals.iter().all(rises);
    let mut panels = Vec::new();
    for signal in fit.signals.iter().take(MOST_SHOWN) {
        let (quantity, unit) = match signal.taxel {
            None => ("force".to_owned(), "N"),
            Some(taxel) => (sensor.taxels[taxel].name.clone(), "kPa"),
        };
        let start_s = signal.time_s.first().copied().unwrap_or(0.0);
        let along = |row: usize| {
            if over_depth {
                signal.depth_mm[row]
            } else {
                signal.time_s[row] - start_s
            }
        };
        let series = |name: &str, ink: Ink, width_px: f64, value: &dyn Fn(usize) -> f64| Series {
            name: name.into(),
            points: (0..signal.measured.len())
                .map(|row| [along(row), value(row)])
                .collect(),
            ink,
            width_px,
            dashed: false,
        };
        panels.push(Panel {
            name: String::new(),
            y_label: format!("{quantity} ({unit})"),
            series: vec![
                series("measured", Ink::Sensor, 3.0, &|row| signal.measured[row]),
                series("fitted", Ink::Twin, 1.25, &|row| signal.fitted[row]),
            ],
            y_range: None,
        });
        panels.push(Panel {
            name: String::new(),
            y_label: format!("residual ({unit})"),
            series: vec![
                series("", Ink::Muted, 0.75, &|_| 0.0),
                series("fitted minus measured", Ink::Series(0), 1.0, &|row| {
                    signal.fitted[row] - signal.measured[row]
                }),
            ],
            y_range: None,
        });
    }
    Panels {
        title: format!("Calibration of {}, {kinds} curves", sensor.name),
        x_label: if over_depth { "depth (mm)" } else { "time (s)" }.into(),
        panels,
        panel_height_px: 110.0,
        logarithmic: false,
    }
    .scene()
}
