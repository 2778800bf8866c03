//! `twintac predict`: predicts a sensor's readings by its trained twin.

use anyhow::{Context, Result, bail};
use twintac_model::{Predicted, Predictor};

use crate::arguments::Predict;
use crate::output::{print, print_csv};
use crate::progress::Bars;

/// Predicts along a path or a protocol, and prints the result.
pub(crate) fn run(arguments: &Predict) -> Result<()> {
    let mut predictor = Predictor::open(&arguments.model, arguments.indenter.as_deref())?;
    if let Some(warmer_k) = arguments.warmer_k {
        predictor = predictor.warmer(warmer_k)?;
    }
    let bars = Bars::default();
    let predicted = match (&arguments.path, &arguments.protocol) {
        (Some(path), _) => predictor.follow(path, &bars)?,
        (None, protocol) => {
            let protocol = protocol.as_ref().context("give --path or --protocol")?;
            predictor.press(protocol, arguments.seed, &bars)?
        }
    };
    if let Some(file) = &arguments.plot {
        predicted.scene().write(file)?;
    }
    if arguments.json {
        print(&serde_json::to_string_pretty(&predicted)?)?;
    } else {
        print_csv(table(&predicted))?;
    }
    if let Some(failure) = &predicted.failure {
        bail!("the path could not be followed to its end: {failure}; the printed frames are valid");
    }
    Ok(())
}

/// Columns with their units, and rows. If the twin has intervals, their bounds (90 %) and a flag of
/// out-of-distribution contacts follow the readings.
fn table(predicted: &Predicted) -> Vec<Vec<String>> {
    let columns = [
        "provenance",
        "press",
        "indenter",
        "time_s",
        "x_mm",
        "y_mm",
        "depth_mm",
        "force_n",
    ];
    let mut head: Vec<String> = columns.map(str::to_owned).to_vec();
    head.extend(predicted.taxels.iter().map(|taxel| format!("{taxel}_kpa")));
    let is_sure = predicted.presses.iter().all(|press| press.certainty.is_some());
    if is_sure {
        for taxel in &predicted.taxels {
            head.extend([format!("{taxel}_low_kpa"), format!("{taxel}_high_kpa")]);
        }
        head.extend(["ood_score", "is_out_of_distribution"].map(str::to_owned));
    }
    let mut rows = vec![head];
    for press in &predicted.presses {
        for (frame, readings_kpa) in press.readings_kpa.iter().enumerate() {
            let [x_mm, y_mm] = press.place_mm[frame];
            let mut row = vec![
                predicted.provenance.to_string(),
                press.name.clone(),
                press.indenter.clone(),
                format!("{:.4}", press.time_s[frame]),
                format!("{x_mm:.4}"),
                format!("{y_mm:.4}"),
                format!("{:.4}", press.depth_mm[frame]),
                format!("{:.5}", press.force_n[frame]),
            ];
            row.extend(readings_kpa.iter().map(|reading_kpa| format!("{reading_kpa:.5}")));
            if let (Some(sure), true) = (&press.certainty, is_sure) {
                for (reading_kpa, half_kpa) in readings_kpa.iter().zip(&sure.half_width_kpa[frame]) {
                    row.push(format!("{:.5}", reading_kpa - half_kpa));
                    row.push(format!("{:.5}", reading_kpa + half_kpa));
                }
                row.push(format!("{:.3}", sure.ood_score[frame]));
                row.push(sure.is_out_of_distribution[frame].to_string());
            }
            rows.push(row);
        }
    }
    rows
}
