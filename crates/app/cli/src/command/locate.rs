//! `twintac locate`: where and how deep a sensor is touched, from its readings, by its trained twin.

use std::fmt::Write;

use anyhow::Result;
use twintac_run::fast::sensor_of_model;
use twintac_run::{
    Located, LocatedFrame, LocatedPress, LocationErrors, Locator, Progress, import_files, read_recordings,
};

use super::files::{expand, rename};
use crate::arguments::Locate;
use crate::output::print;
use crate::progress::Bars;

/// Finds what touches in each frame, and prints it; how far off that is goes to standard error.
pub(crate) fn run(arguments: &Locate) -> Result<()> {
    let files = expand(&arguments.recordings)?;
    let mut recording = match &arguments.import {
        Some(import) => import_files(import, &files)?.0,
        None => read_recordings(&files)?,
    };
    let recorded_as = arguments.recorded_as.as_deref();
    rename(&mut recording, recorded_as, &sensor_of_model(&arguments.model)?)?;
    let settings = Locator::settings(arguments.settings.as_deref())?;
    let bars = Bars::default();
    let locator = Locator::open(&arguments.model, &arguments.indenter, settings, &bars)?;
    let mut located = locator.locate(&recording)?;
    summary(&located).lines().for_each(|line| bars.note(line));
    if arguments.errors {
        located.presses.clear();
    }
    if arguments.json || arguments.errors {
        print(&serde_json::to_string_pretty(&located)?)
    } else {
        print(table(&located)?.trim_end())
    }
}

/// Comma-separated columns with their units. What was not found is empty.
fn table(located: &Located) -> Result<String> {
    let mut out = "provenance,press,taught,time_s,indenter,x_mm,y_mm,depth_mm,x_deviation_mm,y_deviation_mm,depth_deviation_mm,force_n,misfit,\
                   true_x_mm,true_y_mm,true_depth_mm\n"
        .to_owned();
    for press in &located.presses {
        for frame in &press.frames {
            row(&mut out, located, press, frame)?;
        }
    }
    Ok(out)
}

fn row(out: &mut String, located: &Located, press: &LocatedPress, frame: &LocatedFrame) -> Result<()> {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.4}"));
    let axis = |values: Option<[f64; 2]>, axis: usize| number(values.map(|values| values[axis]));
    writeln!(
        out,
        "{},{},{},{:.4},{},{},{},{},{},{},{},{},{},{:.4},{:.4},{}",
        located.provenance,
        press.name,
        press.taught,
        frame.time_s,
        frame.indenter.as_deref().unwrap_or_default(),
        axis(frame.place_mm, 0),
        axis(frame.place_mm, 1),
        number(frame.depth_mm),
        axis(frame.place_deviation_mm, 0),
        axis(frame.place_deviation_mm, 1),
        number(frame.depth_deviation_mm),
        number(frame.force_n),
        number(frame.misfit),
        frame.true_place_mm[0],
        frame.true_place_mm[1],
        number(frame.true_depth_mm),
    )?;
    Ok(())
}

/// How far off places and depths are, in a line for presses that taught the twin and one for those that did not.
fn summary(located: &Located) -> String {
    let line = |name: &str, errors: &Option<LocationErrors>| {
        let Some(errors) = errors else {
            return String::new();
        };
        format!(
            "{name}: {} presses, {} frames; place off by {:.2} mm (90 of 100: {:.2}), depth by {:.1} % of the deepest ({:.1}), at the deepest by {:.1} % ({:.1}); \
             within two deviations {:.0} and {:.0} %\n",
            errors.presses,
            errors.frames,
            errors.place_mm.median,
            errors.place_mm.of_90_percent,
            errors.depth_percent.median,
            errors.depth_percent.of_90_percent,
            errors.depth_at_peak_percent.median,
            errors.depth_at_peak_percent.of_90_percent,
            errors.place_within_two_deviations_percent,
            errors.depth_within_two_deviations_percent,
        )
    };
    format!(
        "{}, {:.3} ms a frame\n{}{}",
        located.provenance,
        located.frame_ms,
        line("presses that taught the twin", &located.taught),
        line("presses that it never saw", &located.unseen),
    )
}
