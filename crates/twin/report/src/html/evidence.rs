//! Sections behind the result: training, the bench, alignment, the simulation, the sensor and the making of.

use std::fmt::Write as _;

use super::elements::{Cell, Section, cards, figure, figures, paragraph, table, wide_figure};
use crate::axis::{fixed, short};
use crate::color::Ink;
use crate::data::{BenchFit, Fact, Provenance, ReportData};
use crate::plot::{Bar, Bars, Panel, Panels, Series};
use crate::svg::escape;

fn series(name: &str, x: &[f64], y: &[f64], ink: Ink, dashed: bool) -> Series {
    let points = x.iter().zip(y).map(|(&x, &y)| [x, y]).collect();
    Series {
        name: name.into(),
        points,
        ink,
        width_px: 1.75,
        dashed,
    }
}

fn single(title: &str, x_label: &str, y_label: &str, series: Vec<Series>, logarithmic: bool) -> Panels {
    let panel = Panel {
        y_label: y_label.into(),
        series,
        ..Panel::default()
    };
    let (title, x_label) = (title.into(), x_label.into());
    Panels {
        title,
        x_label,
        panels: vec![panel],
        panel_height_px: 200.0,
        logarithmic,
    }
}

/// Losses over steps, one chart a variant.
pub(super) fn training(data: &ReportData) -> Option<Section> {
    let pictures: Vec<String> = data
        .training
        .iter()
        .map(|curve| {
            let lines = vec![
                series("training", &curve.step, &curve.training_loss, Ink::Sensor, false),
                series("validation", &curve.step, &curve.validation_loss, Ink::Twin, false),
            ];
            let chart = single(&curve.name, "optimiser step", "loss", lines, true);
            let caption = "Where the validation loss rises while the training loss falls, the twin learns its examples by heart.";
            figure(&chart.scene(), data.provenance, caption)
        })
        .collect();
    Section::new("training", "Training", figures(&pictures))
}

/// What was fitted about the bench.
pub(super) fn bench(data: &ReportData) -> Option<Section> {
    let BenchFit {
        parameters,
        gains,
        objective_by_radius,
    } = data.bench.as_ref()?;
    let source = data.provenance;
    let rows: Vec<_> = parameters
        .iter()
        .map(|parameter| {
            let value = short(parameter.value);
            let spread = parameter
                .uncertainty
                .map_or(String::new(), |half| format!(" ± {}", short(half)));
            let cells = vec![
                Cell::words(&parameter.name),
                Cell::Number(format!("{value}{spread} {}", parameter.unit)),
                Cell::Source(source),
            ];
            (false, cells)
        })
        .collect();
    let mut pictures = Vec::new();
    if !gains.is_empty() {
        let bars = gains.iter().map(|gain| Bar {
            name: gain.taxel.clone(),
            value: gain.value,
            uncertainty: gain.uncertainty,
            text: fixed(gain.value, 2),
            ink: Ink::Series(0),
        });
        let (title, x_label) = (
            "Gain of each taxel".into(),
            "measured over simulated pressure".into(),
        );
        let chart = Bars {
            title,
            x_label,
            bars: bars.collect(),
        };
        pictures.push(figure(
            &chart.scene(),
            source,
            "One number a taxel, with its uncertainty.",
        ));
    }
    if !objective_by_radius.is_empty() {
        let points = objective_by_radius.clone();
        let line = Series {
            name: String::new(),
            points,
            ink: Ink::Series(0),
            width_px: 1.75,
            dashed: false,
        };
        let chart = single(
            "Fit of the indenter's radius",
            "radius, mm",
            "objective, %",
            vec![line],
            false,
        );
        let caption =
            "A sharp valley means that the data decide the radius; a flat one means that they do not.";
        pictures.push(figure(&chart.scene(), source, caption));
    }
    let body = figures(&pictures) + &table("Fitted quantities", &["quantity", "value", "source"], &rows);
    Section::new("bench", "Fit of the bench", body)
}

/// How simulated times were matched to measured ones.
pub(super) fn alignment(data: &ReportData) -> Option<Section> {
    if data.warps.is_empty() {
        return None;
    }
    let lines = data.warps.iter().enumerate().map(|(index, warp)| {
        series(
            &warp.name,
            &warp.time_s,
            &warp.shift_s,
            Ink::Series(index),
            index >= crate::PALETTE.len(),
        )
    });
    let chart = single(
        "Shift of the simulation",
        "time, s",
        "shift, s",
        lines.collect(),
        false,
    );
    let caption = "Simulated time matched to each measured frame, minus that frame's time. Flat and near zero: the \
                   two clocks agree. A wandering line: the match bends time to hide an error.";
    Section::new(
        "alignment",
        "Alignment",
        figures(&[figure(&chart.scene(), data.provenance, caption)]),
    )
}

/// How far the simulation can be trusted.
pub(super) fn simulation(data: &ReportData) -> Option<Section> {
    let quality = data.simulation.as_ref()?;
    let source = Provenance::Simulated;
    let mut body = cards(&[
        (quality.frames.to_string(), "frames solved", source),
        (short(quality.worst_residual), "worst relative residual", source),
        (
            format!("{} mm", short(quality.largest_penetration_mm)),
            "largest penetration",
            source,
        ),
        (
            short(quality.smallest_volume_ratio),
            "smallest volume ratio of an element",
            source,
        ),
    ]);
    if quality.failures.is_empty() {
        body += &paragraph("No simulated press failed.");
    } else {
        body += "<aside class=\"warnings\"><b>What failed</b><ul>\n";
        for failure in &quality.failures {
            let _ = writeln!(body, "<li>{}</li>", escape(failure));
        }
        body += "</ul></aside>\n";
    }
    Section::new("simulation", "The simulation", body)
}

/// The sensor's drawing and facts.
pub(super) fn sensor(data: &ReportData) -> Option<Section> {
    let sensor = data.sensor.as_ref()?;
    let mut body = String::new();
    if let Some(drawing) = &sensor.drawing {
        let caption = format!("{}, drawn from its description; dimensions in mm.", sensor.name);
        body += &wide_figure(&drawing.scene(), &caption);
    }
    body += &fact_list(&sensor.facts);
    Section::new("sensor", "The sensor", body)
}

/// Command line, versions, seed, settings and time.
pub(super) fn making_of(data: &ReportData) -> Option<Section> {
    let mut body = String::new();
    if !data.command.is_empty() {
        let _ = writeln!(
            body,
            "<pre class=\"command\"><code>{}</code></pre>",
            escape(&data.command)
        );
    }
    let seed = data.seed.map(|seed| Fact::new("seed", seed.to_string()));
    let facts: Vec<Fact> = data.versions.iter().cloned().chain(seed).collect();
    body += &fact_list(&facts);
    if !data.stages.is_empty() {
        let bars = data.stages.iter().map(|stage| Bar {
            name: stage.name.clone(),
            value: stage.wall_s,
            uncertainty: None,
            text: format!("{} s", short(stage.wall_s)),
            ink: Ink::Series(0),
        });
        let chart = Bars {
            title: "Time by stage".into(),
            x_label: "wall time, s".into(),
            bars: bars.collect(),
        };
        let caption = "Measured while this report was made; it depends on the machine.";
        body += &figures(&[figure(&chart.scene(), None, caption)]);
    }
    if !data.settings.is_empty() {
        let settings = escape(&data.settings);
        let _ = writeln!(
            body,
            "<details><summary>Settings used</summary><pre><code>{settings}</code></pre></details>"
        );
    }
    Section::new("making-of", "How it was made", body)
}

pub(super) fn fact_list(facts: &[Fact]) -> String {
    if facts.is_empty() {
        return String::new();
    }
    let mut out = String::from("<dl class=\"facts\">\n");
    for fact in facts {
        let _ = writeln!(
            out,
            "<div><dt>{}</dt><dd>{}</dd></div>",
            escape(&fact.name),
            escape(&fact.value)
        );
    }
    out.push_str("</dl>\n");
    out
}
