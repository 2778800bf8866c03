//! Sections behind the result: training, the bench, alignment, the simulation, the sensor and how the page was made.

use twintac_plot::page::{Block, Card, Cell, Fact, Figure, Row, Section, Table};
use twintac_plot::{Bar, Bars, Ink, PALETTE, Panel, Panels, Series, fixed, short};

use super::{figure, head, section, words};
use crate::data::{BenchFit, Parameter, Provenance, ReportData};

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
    Panels {
        title: title.into(),
        x_label: x_label.into(),
        panels: vec![panel],
        panel_height_px: 200.0,
        logarithmic,
    }
}

/// Losses over steps, one chart a variant.
pub(super) fn training(data: &ReportData) -> Section {
    let pictures = data.training.iter().map(|curve| {
        let lines = vec![
            series("training", &curve.step, &curve.training_loss, Ink::Sensor, false),
            series("validation", &curve.step, &curve.validation_loss, Ink::Twin, false),
        ];
        let chart = single(&curve.name, "optimiser step", "loss", lines, true);
        let caption = "Where the validation loss rises while the training loss falls, the twin learns its examples by heart.";
        figure(chart.scene(), data.provenance.badge(), caption)
    });
    section("training", "Training", vec![Block::Figures(pictures.collect())])
}

/// What was fitted about the bench.
pub(super) fn bench(data: &ReportData) -> Section {
    let Some(BenchFit {
        parameters,
        gains,
        objective_by_radius,
    }) = &data.bench
    else {
        return Section::default();
    };
    let source = data.provenance.badge();
    let row = |parameter: &Parameter| -> Row {
        let value = short(parameter.value);
        let spread = parameter
            .uncertainty
            .map_or(String::new(), |half| format!(" ± {}", short(half)));
        let value = format!("{value}{spread} {}", parameter.unit);
        vec![
            words(&parameter.name),
            Cell::Number(value),
            Cell::Badge(source.clone()),
        ]
        .into()
    };
    let mut pictures = Vec::new();
    if !gains.is_empty() {
        let bars = gains.iter().map(|gain| Bar {
            name: gain.taxel.clone(),
            value: gain.value,
            uncertainty: gain.uncertainty,
            text: fixed(gain.value, 2),
            ink: Ink::Series(0),
        });
        let chart = Bars {
            title: "Gain of each taxel".into(),
            x_label: "measured over simulated pressure".into(),
            bars: bars.collect(),
        };
        let caption = "One number a taxel, with its uncertainty.";
        pictures.push(figure(chart.scene(), source.clone(), caption));
    }
    if !objective_by_radius.is_empty() {
        let line = Series {
            name: String::new(),
            points: objective_by_radius.clone(),
            ink: Ink::Series(0),
            width_px: 1.75,
            dashed: false,
        };
        let title = "Fit of the indenter's radius";
        let chart = single(title, "radius, mm", "objective, %", vec![line], false);
        let caption =
            "A sharp valley means that the data decide the radius; a flat one means that they do not.";
        pictures.push(figure(chart.scene(), source.clone(), caption));
    }
    let table = Table {
        caption: "Fitted quantities".into(),
        head: head(["quantity", "value", "source"]),
        rows: parameters.iter().map(row).collect(),
    };
    section(
        "bench",
        "Fit of the bench",
        vec![Block::Figures(pictures), Block::Table(table)],
    )
}

/// How simulated times were matched to measured ones.
pub(super) fn alignment(data: &ReportData) -> Section {
    let lines = data.warps.iter().enumerate().map(|(index, warp)| {
        series(
            &warp.name,
            &warp.time_s,
            &warp.shift_s,
            Ink::Series(index),
            index >= PALETTE.len(),
        )
    });
    let lines: Vec<Series> = lines.collect();
    if lines.is_empty() {
        return Section::default();
    }
    let chart = single("Shift of the simulation", "time, s", "shift, s", lines, false);
    let caption = "Simulated time matched to each measured frame, minus that frame's time. Flat and near zero: the \
                   two clocks agree. A wandering line: the match bends time to hide an error.";
    let picture = figure(chart.scene(), data.provenance.badge(), caption);
    section("alignment", "Alignment", vec![Block::Figures(vec![picture])])
}

/// How far the simulation can be trusted.
pub(super) fn simulation(data: &ReportData) -> Section {
    let Some(quality) = &data.simulation else {
        return Section::default();
    };
    let card = |value: String, name: &str| Card {
        fact: Fact::new(name, value),
        badge: Provenance::Simulated.badge(),
    };
    let cards = vec![
        card(quality.frames.to_string(), "frames solved"),
        card(short(quality.worst_residual), "worst relative residual"),
        card(
            format!("{} mm", short(quality.largest_penetration_mm)),
            "largest penetration",
        ),
        card(
            short(quality.smallest_volume_ratio),
            "smallest volume ratio of an element",
        ),
    ];
    let failures = if quality.failures.is_empty() {
        Block::Text("No simulated press failed.".into())
    } else {
        Block::Warnings("What failed", quality.failures.clone())
    };
    section(
        "simulation",
        "The simulation",
        vec![Block::Cards(cards), failures],
    )
}

/// The sensor's drawing and facts.
pub(super) fn sensor(data: &ReportData) -> Section {
    let Some(sensor) = &data.sensor else {
        return Section::default();
    };
    let mut blocks = Vec::new();
    if let Some(drawing) = &sensor.drawing {
        let caption = format!("{}, drawn from its description; dimensions in mm.", sensor.name);
        blocks.push(Block::Wide(Box::new(figure(drawing.clone(), None, caption))));
    }
    blocks.push(Block::Facts(sensor.facts.clone()));
    section("sensor", "The sensor", blocks)
}

/// Command line, versions, seed, settings and time.
pub(super) fn making_of(data: &ReportData) -> Section {
    let seed = data.seed.map(|seed| Fact::new("seed", seed.to_string()));
    let mut pictures: Vec<Figure> = Vec::new();
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
        pictures.push(figure(chart.scene(), None, caption));
    }
    let blocks = vec![
        Block::Command(data.command.clone()),
        Block::Facts(data.versions.iter().cloned().chain(seed).collect()),
        Block::Figures(pictures),
        Block::Details("Settings used", data.settings.clone()),
    ];
    section("making-of", "How it was made", blocks)
}
