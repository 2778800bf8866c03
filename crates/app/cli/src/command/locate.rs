//! `twintac locate`: estimates where and how deep a sensor is touched, from its readings by its
//! trained twin.

use anyhow::Result;
use twintac_model::{Located, LocatedFrame, LocatedPress, LocationErrors, Locator, sensor_of_model};
use twintac_run::read_recordings;
use twintac_work::Progress;

use super::files::{expand, import_aloud, rename};
use crate::arguments::Locate;
use crate::output::{print, print_csv};
use crate::progress::Bars;

/// Prints the estimated contact of each frame. The errors go to standard error.
pub(crate) fn run(arguments: &Locate) -> Result<()> {
    let files = expand(&arguments.recordings)?;
    let mut recording = match &arguments.import {
        Some(import) => import_aloud(import, &files)?,
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
        print_csv(table(&located))
    }
}

/// Columns with their units, and rows. A cell is empty if no contact was found.
fn table(located: &Located) -> impl Iterator<Item = Vec<String>> {
    const HEAD: [&str; 16] = [
        "provenance",
        "press",
        "trained_on",
        "time_s",
        "indenter",
        "x_mm",
        "y_mm",
        "depth_mm",
        "x_deviation_mm",
        "y_deviation_mm",
        "depth_deviation_mm",
        "force_n",
        "misfit",
        "true_x_mm",
        "true_y_mm",
        "true_depth_mm",
    ];
    let rows = located.presses.iter().flat_map(|press| {
        let frames = press.frames.iter();
        frames.map(|frame| row(located, press, frame))
    });
    std::iter::once(HEAD.map(str::to_owned).to_vec()).chain(rows)
}

fn row(located: &Located, press: &LocatedPress, frame: &LocatedFrame) -> Vec<String> {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.4}"));
    let axis = |values: Option<[f64; 2]>, axis: usize| number(values.map(|values| values[axis]));
    vec![
        located.provenance.to_string(),
        press.name.clone(),
        press.trained_on.to_string(),
        number(Some(frame.time_s)),
        frame.indenter.clone().unwrap_or_default(),
        axis(frame.place_mm, 0),
        axis(frame.place_mm, 1),
        number(frame.depth_mm),
        axis(frame.place_deviation_mm, 0),
        axis(frame.place_deviation_mm, 1),
        number(frame.depth_deviation_mm),
        number(frame.force_n),
        number(frame.misfit),
        number(Some(frame.true_place_mm[0])),
        number(Some(frame.true_place_mm[1])),
        number(frame.true_depth_mm),
    ]
}

/// Errors of locations and depths: one line for presses that the twin was trained on, and one for
/// the others.
fn summary(located: &Located) -> String {
    let told = |value: Option<f64>, decimals: usize| match value {
        Some(value) => format!("{value:.decimals$}"),
        None => "none".to_owned(),
    };
    let line = |name: &str, errors: &Option<LocationErrors>| {
        let Some(errors) = errors else {
            return String::new();
        };
        format!(
            "{name}: {} presses, {} frames; median error of the location {} mm (90th percentile {}), of the depth {} % of the largest ({}), at the largest depth {} % ({}); \
             within two standard deviations {} and {} %\n",
            errors.presses,
            errors.frames,
            told(errors.place_mm.median, 2),
            told(errors.place_mm.of_90_percent, 2),
            told(errors.depth_percent.median, 1),
            told(errors.depth_percent.of_90_percent, 1),
            told(errors.depth_at_peak_percent.median, 1),
            told(errors.depth_at_peak_percent.of_90_percent, 1),
            told(errors.place_within_two_deviations_percent, 0),
            told(errors.depth_within_two_deviations_percent, 0),
        )
    };
    format!(
        "{}, {:.3} ms a frame\n{}{}",
        located.provenance,
        located.frame_ms,
        line("training presses", &located.trained_on),
        line("held-out presses", &located.unseen),
    )
}
