//! The plots, in the paper's order: time, small and large force, sensitivity. Then the plots that
//! the paper does not have.

use twintac_plot::{Anchor, Bar, Bars, Ink, Panel, Panels, SMALL, Scene, Series, text_width, viridis};
use twintac_recording::{Control, Recording};

use super::words::number;
use crate::creep::BEGINS_S;
use crate::phases::duration_s;
use crate::recorded::{Recorded, above};
use crate::statistics::mean;
use crate::{Characterization, CrossTalk};

/// A plot with its caption.
pub(super) type Plot = (Scene, String);

/// Largest number of presses in the plot over time.
const MOST_SHOWN: usize = 8;

/// Longest press in the plot over time, s.
const LONGEST_SHOWN_S: f64 = 8.0;

fn line(name: &str, points: Vec<[f64; 2]>, ink: Ink, width_px: f64) -> Series {
    Series {
        name: name.into(),
        points,
        ink,
        width_px,
        dashed: false,
    }
}

fn dashed(name: &str, points: Vec<[f64; 2]>, ink: Ink) -> Series {
    Series {
        dashed: true,
        ..line(name, points, ink, 1.5)
    }
}

fn panel(y_label: &str, series: Vec<Series>) -> Panel {
    Panel {
        y_label: y_label.into(),
        series,
        ..Panel::default()
    }
}

fn panels(title: &str, x_label: &str, panels: Vec<Panel>) -> Scene {
    let panel_height_px = if panels.len() > 1 { 110.0 } else { 230.0 };
    Panels {
        title: title.into(),
        x_label: x_label.into(),
        panels,
        panel_height_px,
        logarithmic: false,
    }
    .scene()
}

/// Force, N, and reading of a taxel, kPa, over time, s, in a range of frames. Times count from
/// `zero_s`.
fn courses(
    press: &Recorded<'_>,
    taxel: usize,
    frames: std::ops::Range<usize>,
    zero_s: f64,
) -> [Vec<[f64; 2]>; 2] {
    let time_s = |frame: usize| press.press.time_s[frame] - zero_s;
    [
        frames
            .clone()
            .map(|frame| [time_s(frame), press.force_n(frame)])
            .collect(),
        frames
            .map(|frame| [time_s(frame), press.press.taxels_kpa[frame][taxel]])
            .collect(),
    ]
}

fn force_and_reading(title: &str, name: &str, [force, reading]: [Vec<[f64; 2]>; 2]) -> Scene {
    let above = panel("force, N", vec![line("force", force, Ink::Series(0), 1.5)]);
    let below = panel("pressure, kPa", vec![line(name, reading, Ink::Twin, 1.5)]);
    panels(title, "time, s", vec![above, below])
}

/// Force and reading over time for one taxel, press after press, at several amplitudes and speeds.
pub(super) fn over_time(recording: &Recording, recorded: &[Recorded<'_>]) -> Option<Plot> {
    let touched_s = |press: &Recorded<'_>| {
        let end = press.phases.unloading.end.min(press.press.time_s.len() - 1);
        press.press.time_s[end] - press.press.time_s[press.phases.loading.start]
    };
    let is_shown =
        |press: &&Recorded<'_>| press.press.control == Control::Pose && touched_s(press) <= LONGEST_SHOWN_S;
    let of_taxel = |taxel: usize| above(recorded, taxel).filter(is_shown);
    let taxel = (0..recording.taxels.len())
        .rev()
        .max_by_key(|&taxel| of_taxel(taxel).count())
        .filter(|&taxel| of_taxel(taxel).next().is_some())?;
    // Sorts presses by their loading rate and takes evenly spaced ones, so that they differ most;
    // shows them in the order of recording.
    let mut order: Vec<(usize, &Recorded<'_>)> = of_taxel(taxel).enumerate().collect();
    let rate =
        |press: &Recorded<'_>| press.peak_n() / duration_s(press.press, &press.phases.loading).max(1e-3);
    order.sort_by(|a, b| rate(a.1).total_cmp(&rate(b.1)));
    let n_shown = order.len().min(MOST_SHOWN);
    let mut chosen: Vec<_> = (0..n_shown)
        .map(|index| order[index * order.len() / n_shown])
        .collect();
    chosen.sort_by_key(|(index, _)| *index);
    let mut all = [Vec::new(), Vec::new()];
    let mut behind_s = 0.0;
    for (_, press) in &chosen {
        let time_s = &press.press.time_s;
        let (from_s, to_s) = (time_s[press.phases.loading.start] - 0.3, touched_s(press) + 0.6);
        let first = time_s.partition_point(|at_s| *at_s < from_s);
        let last = time_s.partition_point(|at_s| *at_s < from_s + to_s);
        let parts = courses(press, taxel, first..last, from_s - behind_s);
        for (whole, part) in all.iter_mut().zip(parts) {
            whole.extend(part);
            whole.push([f64::NAN; 2]);
        }
        behind_s += to_s;
    }
    let name = &recording.taxels[taxel];
    let caption = format!(
        "Force on the gel and reading of taxel {name}, in {} presses of various amplitude and speed, one after the other.",
        chosen.len()
    );
    Some((force_and_reading("Response over time", name, all), caption))
}

/// The smallest known step of force, with the two means that it is computed from.
pub(super) fn smallest_step(found: &Characterization, recorded: &[Recorded<'_>]) -> Option<Plot> {
    let step = found.smallest_step().or(found.steps.found()?.first())?;
    let press = recorded.iter().find(|press| press.press.name == step.press)?;
    let (taxel, phases, time_s) = (press.taxel?, &press.phases, &press.press.time_s);
    let n = time_s.len();
    let [force, reading] = courses(press, taxel, 0..n, 0.0);
    let force_mn = force
        .into_iter()
        .map(|[time_s, force_n]| [time_s, 1000.0 * force_n])
        .collect();
    let level = |frames: &std::ops::Range<usize>| -> Option<Vec<[f64; 2]>> {
        let level_kpa = mean(&press.readings_kpa(taxel, frames))?;
        Some(vec![
            [time_s[frames.start], level_kpa],
            [time_s[frames.end - 1], level_kpa],
        ])
    };
    let means: Vec<[f64; 2]> = [&phases.rest, &phases.hold, &phases.rest_after]
        .into_iter()
        .filter(|frames| !frames.is_empty())
        .filter_map(level)
        .flat_map(|mut ends| {
            ends.push([f64::NAN; 2]);
            ends
        })
        .collect();
    let readings = vec![
        line("readings", reading, Ink::Sensor, 1.0),
        line("means", means, Ink::Twin, 2.0),
    ];
    let scene = panels(
        &format!("A  Step of {} N", number(step.force_n, 2)),
        "time, s",
        vec![
            panel("force, mN", vec![line("force", force_mn, Ink::Series(0), 1.5)]),
            panel("pressure, kPa", readings),
        ],
    );
    let caption = format!(
        "A weight of {} N above taxel {}: a step of {} kPa, {} standard deviations of a single reading, {} of a mean over {} s.",
        number(step.force_n, 2),
        step.taxel,
        number(step.step_kpa, 2),
        number(step.z_single, 2),
        number(step.z_averaged, 2),
        found.options.window_s
    );
    Some((scene, caption))
}

/// The press with the largest force.
pub(super) fn largest_force(
    found: &Characterization,
    recording: &Recording,
    recorded: &[Recorded<'_>],
) -> Option<Plot> {
    let range = found.range.found()?;
    let press = recorded.iter().find(|press| press.press.name == range.press)?;
    let taxel = recording.taxels.iter().position(|taxel| *taxel == range.taxel)?;
    let n = press.press.time_s.len();
    let scene = force_and_reading(
        &format!("B  Up to {} N", number(range.force_n, 3)),
        &range.taxel,
        courses(press, taxel, 0..n, 0.0),
    );
    let caption = format!(
        "The largest force in the data, {} N, and the taxel with the largest reading at it, {}. Larger forces were not measured.",
        number(range.force_n, 3),
        range.taxel
    );
    Some((scene, caption))
}

/// Responses of all taxels, and the mean line.
pub(super) fn responses(found: &Characterization) -> Option<Plot> {
    let (taxels, overall) = (found.sensitivity.found()?, found.overall.found()?);
    let common_n = taxels
        .iter()
        .map(|taxel| taxel.data_to_n)
        .fold(f64::INFINITY, f64::min);
    let shown = |response: &[[f64; 2]]| {
        response
            .iter()
            .copied()
            .filter(|point| point[0] <= common_n)
            .collect()
    };
    let mut series: Vec<Series> = taxels
        .iter()
        .map(|taxel| line("taxels", shown(&taxel.response), Ink::Sensor, 1.5))
        .collect();
    let name = format!("{} kPa/N", number(overall.mean_kpa_per_n, 3));
    let end_n = overall.linear_to_n.min(common_n);
    let offset_kpa = mean(&taxels.iter().map(|taxel| taxel.offset_kpa).collect::<Vec<_>>())?;
    series.push(line(
        &name,
        [0.0, end_n]
            .map(|force_n| [force_n, offset_kpa + overall.mean_kpa_per_n * force_n])
            .to_vec(),
        Ink::Twin,
        2.5,
    ));
    let scene = panels("C  Sensitivity", "force, N", vec![panel("pressure, kPa", series)]);
    let caption = format!(
        "Slow loadings above each taxel, and the mean of the {} taxels’ lines over the range in which all are linear, to {} N.",
        taxels.len(),
        number(overall.linear_to_n, 2)
    );
    Some((scene, caption))
}

/// Deviation of each response from its line.
pub(super) fn linearity(found: &Characterization) -> Option<Plot> {
    let taxels = found.sensitivity.found()?;
    let limit = found.options.linear_percent;
    let mut end_n: f64 = 0.0;
    let mut series = Vec::new();
    for taxel in taxels {
        let span_kpa = taxel.sensitivity_kpa_per_n * taxel.linear_to_n;
        let shown = taxel
            .response
            .iter()
            .filter(|point| point[0] <= 1.5 * taxel.linear_to_n);
        let points: Vec<[f64; 2]> = shown
            .map(|[force_n, kpa]| {
                let line_kpa = taxel.offset_kpa + taxel.sensitivity_kpa_per_n * force_n;
                [*force_n, 100.0 * (kpa - line_kpa) / span_kpa]
            })
            .collect();
        end_n = points.last().map_or(end_n, |point| end_n.max(point[0]));
        series.push(line("taxels", points, Ink::Sensor, 1.5));
    }
    for (name, level) in [(format!("± {} %", limit), limit), (String::new(), -limit)] {
        series.push(dashed(&name, vec![[0.0, level], [end_n, level]], Ink::Twin));
    }
    let scene = panels(
        "Distance from the line",
        "force, N",
        vec![panel("% of the range’s end", series)],
    );
    let caption = format!(
        "Response minus the taxel’s own line, in % of the response at the end of its linear range: the range ends where no line stays within {} %.",
        limit
    );
    Some((scene, caption))
}

/// One figure for each taxel as bars; `None` without figures.
pub(super) fn bars(
    title: &str,
    x_label: &str,
    values: impl Iterator<Item = (String, f64)>,
    caption: &str,
) -> Option<Plot> {
    let bar = |(name, value): (String, f64)| Bar {
        name,
        value,
        uncertainty: None,
        text: number(value, 2),
        ink: Ink::Series(0),
    };
    let bars = Bars {
        title: title.into(),
        x_label: x_label.into(),
        bars: values.map(bar).collect(),
    };
    (!bars.bars.is_empty()).then(|| (bars.scene(), caption.to_owned()))
}

/// The widest hysteresis loop.
pub(super) fn hysteresis(found: &Characterization) -> Option<Plot> {
    let taxels = found.hysteresis.found()?;
    let widest = taxels
        .iter()
        .max_by(|a, b| a.percent.abs().total_cmp(&b.percent.abs()))?;
    let series = vec![
        line("loading", widest.loading.clone(), Ink::Series(0), 2.0),
        line("unloading", widest.unloading.clone(), Ink::Twin, 1.5),
    ];
    let scene = panels("Hysteresis", "force, N", vec![panel("pressure, kPa", series)]);
    let caption = format!(
        "Taxel {}, which has the widest loop: {} % of full scale. Force and taxels are stamped by clocks that may differ by tens of ms: each 10 ms \
         widens or narrows the loop by 0.02 s times the loading rate, 2 % of full scale where loading takes 1 s, and 0.2 % where it takes 10 s.",
        widest.taxel,
        number(widest.percent, 2)
    );
    Some((scene, caption))
}

/// A fast press: force and reading in % of their largest value.
pub(super) fn rise(found: &Characterization, recorded: &[Recorded<'_>]) -> Option<Plot> {
    let rise = found.rise_time.found()?;
    let press = recorded.iter().find(|press| press.press.name == rise.example)?;
    let (taxel, time_s) = (press.taxel?, &press.press.time_s);
    let zero_s = time_s[press.phases.loading.start];
    let from = time_s.partition_point(|at_s| *at_s < zero_s - 0.1);
    let to = time_s.partition_point(|at_s| *at_s < zero_s + 0.4);
    let percent = |points: Vec<[f64; 2]>| {
        let most = points
            .iter()
            .map(|point| point[1])
            .fold(f64::MIN_POSITIVE, f64::max);
        points
            .into_iter()
            .map(|[time_s, value]| [time_s, 100.0 * value / most])
            .collect()
    };
    let [force, reading] = courses(press, taxel, from..to, zero_s);
    let series = vec![
        line("force", percent(force), Ink::Series(0), 2.0),
        line("pressure", percent(reading), Ink::Twin, 1.5),
    ];
    let scene = panels("Rise", "time, s", vec![panel("% of the largest", series)]);
    let caption = format!(
        "A fast press. The time between frames is {} s: a shorter rise time cannot be measured.",
        number(rise.frame_s, 2)
    );
    Some((scene, caption))
}

/// A long hold, in % of its first window.
pub(super) fn creep(found: &Characterization, recorded: &[Recorded<'_>]) -> Option<Plot> {
    let creep = found.creep.found()?.first()?;
    let press = recorded.iter().find(|press| press.press.name == creep.press)?;
    let (taxel, hold) = (press.taxel?, press.phases.hold.clone());
    let zero_s = press.press.time_s[hold.start];
    let [force, reading] = courses(press, taxel, hold, zero_s);
    let ratio: Vec<[f64; 2]> = force
        .iter()
        .zip(&reading)
        .map(|(force, reading)| [force[0], reading[1] / force[1]])
        .collect();
    let percent = |points: &[[f64; 2]]| -> Option<Vec<[f64; 2]>> {
        let begins: Vec<f64> = points
            .iter()
            .filter(|point| (BEGINS_S[0]..BEGINS_S[1]).contains(&point[0]))
            .map(|point| point[1])
            .collect();
        let begin = mean(&begins)?;
        Some(
            points
                .iter()
                .map(|[time_s, value]| [*time_s, 100.0 * (value / begin - 1.0)])
                .collect(),
        )
    };
    let series = vec![
        line("force", percent(&force)?, Ink::Series(0), 1.25),
        line("pressure", percent(&reading)?, Ink::Twin, 1.25),
        line("pressure / force", percent(&ratio)?, Ink::Series(2), 1.25),
    ];
    let scene = panels("Creep", "time held, s", vec![panel("change, %", series)]);
    let caption = format!(
        "A hold at one depth, above taxel {}: the gel relaxes, and force and pressure with it; the change of their ratio is creep.",
        creep.taxel
    );
    Some((scene, caption))
}

/// Unloaded pressure over temperature.
pub(super) fn drift(found: &Characterization) -> Option<Plot> {
    let taxels = found.temperature_drift.found()?;
    let series = (0..).zip(taxels).map(|(index, taxel)| {
        let (name, course) = (&taxel.taxel, taxel.course.clone());
        // There are more taxels than distinguishable colours.
        match index < 6 {
            true => line(name, course, Ink::Series(index), 1.25),
            false => dashed(name, course, Ink::Series(index)),
        }
    });
    let scene = panels(
        "Drift with temperature",
        "temperature, °C",
        vec![panel("unloaded pressure, kPa", series.collect())],
    );
    let caption = "Unloaded pressure against the barometers' own temperature, relative to the start of each taxel's line; drift with time is included.";
    Some((scene, caption.to_owned()))
}

/// Readings of all taxels while each one is pressed.
pub(super) fn cross_talk(talk: &CrossTalk) -> Plot {
    const CELL: f64 = 36.0;
    let widest = |names: &[String]| {
        let widths = names.iter().map(|name| text_width(name, SMALL));
        widths.fold(0.0, f64::max)
    };
    let (columns, rows) = (talk.taxels.len(), talk.pressed.len());
    let cell = CELL.max(widest(&talk.taxels) + 6.0);
    let (width, height) = (cell * columns as f64, CELL * rows as f64);
    let left = 26.0 + widest(&talk.pressed);
    let mut scene = Scene::new("Cross-talk", (left + width + 8.0).max(120.0), 0.0);
    let top = scene.heading("Cross-talk, %") + 24.0;
    scene.height = top + height + 30.0;
    for (row, name) in talk.pressed.iter().enumerate() {
        let y = top + CELL * (row as f64 + 0.5) + 4.0;
        scene.small([left - 6.0, y], name, Ink::Text, Anchor::End);
        for (column, percent) in talk.percent[row].iter().enumerate() {
            let percent = percent.unwrap_or(f64::NAN); // shown as a dash
            let ink = Ink::Rgb(if percent > 55.0 { [0; 3] } else { [255; 3] });
            let x = left + cell * (column as f64 + 0.5);
            let corner = [x - 0.5 * cell, top + CELL * row as f64];
            scene.rectangle(corner, [cell, CELL], Ink::Rgb(viridis(percent / 100.0)), 1.0);
            scene.small(
                [x, y],
                number(percent, if percent.abs() < 10.0 { 1 } else { 2 }),
                ink,
                Anchor::Middle,
            );
        }
    }
    for (column, name) in talk.taxels.iter().enumerate() {
        let x = left + cell * (column as f64 + 0.5);
        scene.small([x, top - 6.0], name, Ink::Text, Anchor::Middle);
    }
    scene.upwards([12.0, top + 0.5 * height], "pressed taxel");
    scene.centred(
        [left + 0.5 * width, top + height + 18.0],
        "read taxel",
        Ink::Muted,
    );
    let caption = format!(
        "Reading of each taxel in % of that of the pressed one, at {} N. A load spreads in the gel, so cross-talk is not a fault.",
        number(talk.force_n, 2)
    );
    (scene, caption)
}
