//! Held-out presses that a reader moves through: sensor and twin at each frame.

use digitac::PressEvaluation;
use twintac_plot::fixed;
use twintac_plot::page::{Block, Replay, ReplayPress};
use twintac_recording::Provenance;

use super::parts::{badge, taxels_mm};
use crate::TwinReport;

/// Most presses, and most frames of each: the page stays below a megabyte.
const MOST_PRESSES: usize = 40;
const MOST_FRAMES: usize = 80;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let presses: Vec<&PressEvaluation> = report
        .evaluation
        .presses
        .iter()
        .filter(|press| press.time_s.len() > 1)
        .collect();
    if presses.is_empty() {
        return Vec::new();
    }
    let (low, high) = report.sensor.gel.solid.bounds_mm(&report.sensor.surfaces);
    let taxels = report.sensor.taxels.iter();
    let replay = Replay {
        unit: "kPa".into(),
        bounds_mm: [low, high].map(|corner| corner.truncate().to_array()),
        marks: taxels
            .map(|taxel| taxel.name.clone())
            .zip(taxels_mm(report.sensor))
            .collect(),
        sources: vec![
            ("Sensor".into(), badge(report.provenance)),
            ("Twin".into(), badge(Provenance::Simulated)),
        ],
        presses: spread(presses.len(), MOST_PRESSES)
            .map(|index| replayed(presses[index]))
            .collect(),
    };
    let text = "Presses that the twin has not seen. Choose one, and move the slider through its frames. Numbers \
         are the readings above the baseline; sensor and twin share a colour scale, from nothing to the largest \
         reading of the press. A dashed circle is around the press.";
    vec![Block::Text(text.into()), Block::Replay(replay)]
}

fn replayed(press: &PressEvaluation) -> ReplayPress {
    let frames: Vec<usize> = spread(press.time_s.len(), MOST_FRAMES).collect();
    let of = |readings: &[Vec<f64>]| frames.iter().map(|&frame| readings[frame].clone()).collect();
    let [x, y] = press.place_mm.map(|at_mm| fixed(at_mm, 1));
    ReplayPress {
        name: format!("{} at ({x}, {y}) mm", press.name),
        place_mm: press.place_mm,
        depth_mm: frames.iter().map(|&frame| press.depth_mm[frame]).collect(),
        values: vec![of(&press.measured_kpa), of(&press.predicted_kpa)],
    }
}

/// Indices of at most so many of `n`, evenly spread from the first to the last.
fn spread(n: usize, most: usize) -> impl Iterator<Item = usize> {
    let kept = n.min(most);
    (0..kept).map(move |index| index * (n - 1) / (kept.max(2) - 1))
}
