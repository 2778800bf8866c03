//! Alignment of measured and simulated times.

use digitac::PairedPress;
use twintac_plot::page::Block;
use twintac_plot::{Ink, PALETTE, Panels, Scene, Series};

use super::parts::{chart, figure, line};
use crate::TwinReport;

/// Largest number of presses that are shown.
const MOST_SHOWN: usize = 6;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let shown = report.test.iter().take(MOST_SHOWN);
    let shown = shown.filter_map(|&index| report.presses.get(index));
    let shown = shown.filter(|press| press.features.time_s.len() > 1);
    let lines: Vec<Series> = shown
        .enumerate()
        .map(|(index, press)| Series {
            dashed: index >= PALETTE.len(),
            ..line(&press.name, shift(press, 0.0), Ink::Series(index), 1.75)
        })
        .collect();
    if lines.is_empty() {
        return Vec::new();
    }
    let chart = chart("Shift of the measurement", ["time, s", "shift, s"], lines);
    let caption = "Time of the measured frame that is matched to each simulated frame, minus that frame's own time. A flat \
                   line near zero means that the two clocks agree. A line that varies means that the matching distorts time and may hide an error.";
    vec![Block::Figures(vec![figure(
        chart.scene(),
        report.provenance,
        caption,
    )])]
}

/// The alignment of all presses as a picture.
#[must_use]
pub fn warp_plot(presses: &[PairedPress]) -> Scene {
    let lines = presses.iter().map(|press| {
        let begin_s = press.features.time_s.first().copied().unwrap_or(0.0);
        line("", shift(press, begin_s), Ink::Series(0), 0.8)
    });
    let labels = ["time since the press began, s", "shift, s"];
    Panels {
        panel_height_px: 220.0,
        ..chart(
            "How measured and simulated times were matched",
            labels,
            lines.collect(),
        )
    }
    .scene()
}

/// For each simulated frame: its time since `begin_s`, and the time of the matched measured frame
/// minus its own, s.
fn shift(press: &PairedPress, begin_s: f64) -> Vec<[f64; 2]> {
    let time_s = &press.features.time_s;
    let at = |index: f64| {
        let before = (index as usize).min(time_s.len() - 1);
        let after = (before + 1).min(time_s.len() - 1);
        time_s[before] + index.fract() * (time_s[after] - time_s[before])
    };
    let frames = press.warp.measured_index.iter().zip(time_s);
    frames
        .map(|(&index, now_s)| [now_s - begin_s, at(index) - now_s])
        .collect()
}
