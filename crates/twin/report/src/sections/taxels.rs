//! Errors by taxel and by depth.

use twintac_plot::page::{Block, Cell, Row, Table};
use twintac_plot::{Ink, short};

use super::parts::{
    ALL, NEAREST, badge, bar, errors, figure, head, largest_kpa, percent_cell, usable, words,
};
use crate::TwinReport;

/// Number of depth intervals.
const DEPTH_BINS: usize = 8;

/// Readings below this fraction of the largest do not count as contact.
const CONTACT_SHARE: f64 = 0.03;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let evaluation = report.evaluation;
    let taxels = || evaluation.taxels.iter().zip(&evaluation.twin.by_taxel);
    let nearest = taxels().filter(|(_, found)| found.nearest_in_contact.count > 0);
    let bars = nearest.map(|(name, found)| bar(name, found.nearest_in_contact.percent, Ink::Twin));
    let caption = "Frames in contact in which the taxel reads the most.";
    let mut pictures = vec![figure(errors("Error by taxel", bars), report.provenance, caption)];

    let depths = by_depth(report);
    if !depths.is_empty() {
        let frames: usize = depths.iter().map(|depth| depth.frames).sum();
        let bars = depths.iter().map(|depth| {
            let [from, to] = depth.between_mm.map(short);
            bar(format!("{from}–{to} mm"), depth.error_percent, Ink::Twin)
        });
        let caption = format!("Nearest taxel in contact, by the indenter's depth; {frames} frames.");
        pictures.push(figure(errors("Error by depth", bars), report.provenance, caption));
    }

    let rows = taxels().enumerate().map(|(index, (name, found))| -> Row {
        let described = report.sensor.taxels.iter().find(|taxel| taxel.name == *name);
        let note = described.and_then(|taxel| taxel.doubtful.clone());
        vec![
            words(name),
            percent_cell(found.nearest_in_contact.percent),
            percent_cell(found.all.percent),
            percent_cell(bias_percent(report, index)),
            words(note.unwrap_or_default()),
            Cell::Badge(badge(report.provenance)),
        ]
        .into()
    });
    let table = Table {
        caption: "Errors of each taxel".into(),
        head: head(["taxel", NEAREST, ALL, "bias, twin − sensor", "note", "source"]),
        rows: rows.collect(),
    };
    vec![Block::Figures(pictures), Block::Table(table)]
}

/// Mean signed error of a taxel, % of the largest reading of all presses; `None` without a usable
/// reading.
fn bias_percent(report: &TwinReport<'_>, taxel: usize) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for (_, [measured, predicted]) in usable(report.evaluation).filter(|(of, _)| *of == taxel) {
        sum += predicted - measured;
        count += 1.0;
    }
    let largest_kpa = largest_kpa(&report.evaluation.presses);
    (count > 0.0 && largest_kpa > 0.0).then(|| 100.0 * sum / count / largest_kpa)
}

/// Errors of the frames in an interval of depths.
struct DepthError {
    between_mm: [f64; 2],
    /// Nearest taxel in contact, % of the largest reading of all presses.
    error_percent: f64,
    frames: usize,
}

fn by_depth(report: &TwinReport<'_>) -> Vec<DepthError> {
    let presses = &report.evaluation.presses;
    let depths = presses.iter().flat_map(|press| &press.depth_mm);
    let deepest_mm = depths.fold(0.0, |deepest: f64, depth| deepest.max(*depth));
    if deepest_mm <= 0.0 || presses.iter().all(|press| press.time_s.len() == 1) {
        return Vec::new();
    }
    let largest_kpa = largest_kpa(presses).max(f64::MIN_POSITIVE);
    let mut bins = [(0.0, 0_usize); DEPTH_BINS];
    for press in presses {
        for (frame, depth_mm) in press.depth_mm.iter().enumerate() {
            let measured = &press.measured_kpa[frame];
            let is_usable = |taxel: &usize| press.valid[frame][*taxel] && !report.left_out.contains(taxel);
            let nearest = (0..measured.len())
                .filter(is_usable)
                .max_by(|&a, &b| measured[a].total_cmp(&measured[b]))
                .filter(|&taxel| *depth_mm > 0.0 && measured[taxel] > CONTACT_SHARE * largest_kpa);
            if let Some(taxel) = nearest {
                let bin = ((depth_mm / deepest_mm * DEPTH_BINS as f64) as usize).min(DEPTH_BINS - 1);
                bins[bin].0 += (press.predicted_kpa[frame][taxel] - measured[taxel]).abs();
                bins[bin].1 += 1;
            }
        }
    }
    let width_mm = deepest_mm / DEPTH_BINS as f64;
    let filled = bins.iter().enumerate().filter(|(_, (_, frames))| *frames > 0);
    filled
        .map(|(bin, (sum, frames))| DepthError {
            between_mm: [bin, bin + 1].map(|edge| edge as f64 * width_mm),
            error_percent: 100.0 * sum / *frames as f64 / largest_kpa,
            frames: *frames,
        })
        .collect()
}
