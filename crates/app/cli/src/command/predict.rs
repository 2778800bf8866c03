//! `twintac predict`: what a sensor would read, by its trained twin.

use std::fmt::Write;

use anyhow::{Context, Result, bail};
use twintac_run::{Predicted, Predictor};

use crate::arguments::Predict;
use crate::output::print;
use crate::progress::Bars;

/// Predicts along a path or a protocol, and prints what comes of it.
pub(crate) fn run(arguments: &Predict) -> Result<()> {
    let predictor = Predictor::open(&arguments.model, arguments.indenter.as_deref())?;
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
        print(table(&predicted)?.trim_end())?;
    }
    if let Some(failure) = &predicted.failure {
        bail!("the path could not be followed to its end: {failure}; the frames printed are good");
    }
    Ok(())
}

/// Comma-separated columns with their units. A twin that knows how sure it is has the bounds of the 90 % intervals after the readings, and whether the contact is
/// unlike what taught.
fn table(predicted: &Predicted) -> Result<String> {
    let mut out = String::new();
    write!(out, "provenance,press,indenter,time_s,x_mm,y_mm,depth_mm,force_n")?;
    for taxel in &predicted.taxels {
        write!(out, ",{taxel}_kpa")?;
    }
    let is_sure = predicted.presses.iter().all(|press| press.certainty.is_some());
    if is_sure {
        for taxel in &predicted.taxels {
            write!(out, ",{taxel}_low_kpa,{taxel}_high_kpa")?;
        }
        write!(out, ",unlikeness,is_unlike")?;
    }
    writeln!(out)?;
    for press in &predicted.presses {
        for (frame, readings_kpa) in press.readings_kpa.iter().enumerate() {
            let [x_mm, y_mm] = press.place_mm[frame];
            write!(
                out,
                "{},{},{},{:.4},{x_mm:.4},{y_mm:.4},{:.4},{:.5}",
                predicted.provenance,
                press.name,
                press.indenter,
                press.time_s[frame],
                press.depth_mm[frame],
                press.force_n[frame]
            )?;
            for reading_kpa in readings_kpa {
                write!(out, ",{reading_kpa:.5}")?;
            }
            if let (Some(sure), true) = (&press.certainty, is_sure) {
                for (reading_kpa, half_kpa) in readings_kpa.iter().zip(&sure.half_width_kpa[frame]) {
                    write!(
                        out,
                        ",{:.5},{:.5}",
                        reading_kpa - half_kpa,
                        reading_kpa + half_kpa
                    )?;
                }
                write!(out, ",{:.3},{}", sure.unlikeness[frame], sure.is_unlike[frame])?;
            }
            writeln!(out)?;
        }
    }
    Ok(out)
}
