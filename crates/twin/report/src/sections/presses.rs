//! Twin and sensor over time: the best press, the median and the worst.

use digitac::{PairedPress, PressEvaluation};
use twintac_plot::page::Block;
use twintac_plot::{Ink, Panel, Panels, Series, extent, padded};

use super::parts::{explained, figure, line, percent, three};
use crate::TwinReport;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let shown = three(report.evaluation).into_iter();
    let shown = shown.filter(|(_, (press, _))| press.time_s.len() > 1);
    let pictures = shown.map(|(label, (press, error))| {
        let paired = report.presses.iter().find(|paired| paired.name == press.name);
        let panels = panels(label, press, paired, &report.evaluation.taxels);
        let error = percent(error);
        let caption = format!("{}: error {error}, nearest taxel in contact.", press.name);
        figure(panels.scene(), report.provenance, caption)
    });
    explained(
        "Pressure above the baseline at every taxel. Where the thin line covers the broad one, the twin equals the sensor. \
         All taxels of a press share one scale.",
        pictures.collect(),
    )
}

fn panels(label: &str, press: &PressEvaluation, paired: Option<&PairedPress>, taxels: &[String]) -> Panels {
    let readings = press.measured_kpa.iter().chain(&press.predicted_kpa).flatten();
    let y_range = extent(readings.copied()).map(|range| padded(range, 0.06));
    let of_taxel = |frames: &[Vec<f64>], taxel: usize| -> Vec<f64> {
        let reading = |frame: &Vec<f64>| frame.get(taxel).copied().unwrap_or(f64::NAN);
        frames.iter().map(reading).collect()
    };
    let panel = |name: &str, y_label: &str, series, y_range| Panel {
        name: name.into(),
        y_label: y_label.into(),
        series,
        y_range,
    };
    let mut panels: Vec<Panel> = taxels
        .iter()
        .enumerate()
        .map(|(taxel, name)| {
            let sensor = sensor(press, &of_taxel(&press.measured_kpa, taxel));
            let twin = twin(press, &of_taxel(&press.predicted_kpa, taxel));
            panel(name, "kPa", vec![sensor, twin], y_range)
        })
        .collect();
    if let Some(paired) = paired {
        let measured = paired.measured_force_n.as_ref();
        let mut series: Vec<Series> = measured
            .map(|force_n| sensor(press, force_n))
            .into_iter()
            .collect();
        series.push(twin(press, &paired.features.force_n));
        panels.push(panel("force", "N", series, None));
    }
    let depth = line("", over_time(press, &press.depth_mm), Ink::Series(0), 1.5);
    panels.push(panel("depth", "mm", vec![depth], None));
    Panels {
        title: format!("{label} press"),
        x_label: "time, s".into(),
        panel_height_px: if panels.len() > 6 { 52.0 } else { 68.0 },
        panels,
        logarithmic: false,
    }
}

fn sensor(press: &PressEvaluation, values: &[f64]) -> Series {
    line("sensor", over_time(press, values), Ink::Sensor, 4.0)
}

fn twin(press: &PressEvaluation, values: &[f64]) -> Series {
    line("twin", over_time(press, values), Ink::Twin, 1.5)
}

fn over_time(press: &PressEvaluation, values: &[f64]) -> Vec<[f64; 2]> {
    let pairs = press.time_s.iter().zip(values);
    pairs.map(|(&time_s, &value)| [time_s, value]).collect()
}
