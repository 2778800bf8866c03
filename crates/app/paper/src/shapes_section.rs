//! The section of the page on shape classification.

use twintac_classify::Sampling;
use twintac_plot::page::{Block, Card, Cell, Fact, Row, Table};
use twintac_plot::{Ink, Panel, Panels, Scene, Series, fixed};
use twintac_sensor::Sensor;

use crate::blocks::{badge, figure, words};
use crate::effort::PAPER_SIMULATED;
use crate::metrics::PaperMetrics;
use crate::mixture::{Mixture, Simulated};
use crate::shapes::ShapesResult;

/// The compared training sets: the bench alone, with the paper's number of simulated trials of
/// either twin, and with all of this project's twin. Each has a name, the source and the number of
/// its simulated trials.
fn ways(results: &[ShapesResult]) -> Vec<(String, Simulated, usize)> {
    let of_twin = results
        .iter()
        .filter(|result| result.mixture.simulated == Simulated::Twin);
    let all = of_twin
        .map(|result| result.mixture.simulated_trials)
        .max()
        .unwrap_or(0);
    let papers = PAPER_SIMULATED.min(all);
    let mut ways = vec![
        ("bench only".to_owned(), Simulated::None, 0),
        (
            format!("and {papers} of the paper's twin"),
            Simulated::PaperTwin,
            papers,
        ),
        (format!("and {papers} of this twin"), Simulated::Twin, papers),
    ];
    if all > papers {
        ways.push((format!("and {all} of this twin"), Simulated::Twin, all));
    }
    ways
}

/// The section: training sets, and accuracies.
pub(super) fn shapes(metrics: &PaperMetrics, sensor: &Sensor) -> Vec<Block> {
    let by = |sampling: Sampling| {
        let results = metrics.shapes.iter();
        results.filter(move |result| result.mixture.sampling == sampling)
    };
    let results: Vec<ShapesResult> = by(Sampling::Load).cloned().collect();
    let most = results
        .iter()
        .map(|result| result.mixture.real_trials)
        .max()
        .unwrap_or(0);
    let ways = ways(&results);
    let of_way = |way: &(String, Simulated, usize)| {
        let (simulated, trials) = (way.1, way.2);
        results.iter().filter(move |result| {
            result.mixture.simulated == simulated && result.mixture.simulated_trials == trials
        })
    };
    let with_most = |way: &(String, Simulated, usize)| {
        let mut own = of_way(way);
        own.find(|result| result.mixture.real_trials == most)
    };
    let cards = ways.iter().filter_map(|way| {
        Some(Card {
            fact: Fact::new(way.0.clone(), text(with_most(way)?)),
            badge: badge(metrics.provenance),
        })
    });
    let line = |name: String, index: usize, points: Vec<[f64; 2]>| Series {
        name,
        points,
        ink: Ink::Series(index),
        width_px: 1.5,
        dashed: false,
    };
    let over_real = ways.iter().enumerate().map(|(index, way)| {
        let points = of_way(way).map(|result| [result.mixture.real_trials as f64, mean(result)]);
        line(way.0.clone(), index, points.collect())
    });
    let mut blocks = vec![
        Block::Cards(cards.collect()),
        Block::Figures(vec![figure(
            accuracies(
                "Classification of shapes, over trials on the bench",
                "trials of each shape on the bench",
                over_real.collect(),
            ),
            metrics.provenance,
            "",
            Some(table(&metrics.shapes)),
        )]),
    ];
    let mut counts: Vec<usize> = results.iter().map(|result| result.mixture.real_trials).collect();
    counts.sort_unstable();
    counts.dedup();
    let over_simulated = counts.iter().enumerate().filter_map(|(index, real)| {
        let own = results.iter().filter(|result| {
            result.mixture.real_trials == *real && result.mixture.simulated != Simulated::PaperTwin
        });
        let mut points: Vec<[f64; 2]> = own
            .map(|result| [result.mixture.simulated_trials as f64, mean(result)])
            .collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        (points.len() > 3).then(|| line(format!("{real} of the bench"), index, points))
    });
    let over_simulated: Vec<Series> = over_simulated.collect();
    if !over_simulated.is_empty() {
        let title = "Classification of shapes, over trials of this twin";
        let scene = accuracies(title, "simulated trials of each shape", over_simulated);
        blocks.push(Block::Figures(vec![figure(scene, metrics.provenance, "", None)]));
    }
    let over_time: Vec<String> = by(Sampling::Time)
        .map(|result| {
            let Mixture {
                real_trials,
                simulated_trials,
                ..
            } = result.mixture;
            format!(
                "{real_trials} of the bench and {simulated_trials} simulated: {}",
                text(result)
            )
        })
        .collect();
    blocks.push(Block::Text(format!(
        "A press is sampled at twelve equal steps of load, so that its speed and its hold have no effect. The same classifier on samples at equal steps of time: {}.",
        over_time.join("; ")
    ).into()));
    for way in [ways.first(), ways.last()].into_iter().flatten() {
        if let Some(result) = with_most(way) {
            blocks.push(Block::Table(confusion(result, &way.0, sensor)));
        }
    }
    blocks
}

fn accuracies(title: &str, x_label: &str, series: Vec<Series>) -> Scene {
    let panels = Panels {
        title: title.into(),
        x_label: x_label.into(),
        panels: vec![Panel {
            name: String::new(),
            y_label: "accuracy, %".into(),
            series,
            y_range: Some([0.0, 100.0]),
        }],
        panel_height_px: 220.0,
        logarithmic: false,
    };
    panels.scene()
}

fn table(results: &[ShapesResult]) -> Table {
    let row = |result: &ShapesResult| -> Row {
        let Mixture {
            real_trials,
            simulated,
            simulated_trials,
            sampling,
        } = result.mixture;
        let whose = match simulated {
            Simulated::None => "",
            Simulated::Twin => "this twin",
            Simulated::PaperTwin => "paper's twin",
        };
        vec![
            Cell::Number(real_trials.to_string()),
            Cell::Number(simulated_trials.to_string()),
            words(whose),
            words(sampling.to_string()),
            Cell::Number(text(result)),
        ]
        .into()
    };
    let head = ["bench", "simulated", "by", "samples over", "accuracy"];
    Table {
        caption: "Trials of each shape, and accuracy on held-out trials of the bench: mean and standard deviation over seeds. The paper has \
                  33.57 % with 20 real trials of each shape, and 95.0 % with 96 simulated ones as well."
            .into(),
        head: head.map(str::to_owned).to_vec(),
        rows: results.iter().map(row).collect(),
    }
}

fn confusion(result: &ShapesResult, name: &str, sensor: &Sensor) -> Table {
    let shapes = || sensor.indenters.iter().map(|indenter| indenter.name.clone());
    let rows = shapes().zip(&result.confusion.counts).map(|(shape, counts)| {
        let counts = counts.iter().map(|count| Cell::Number(count.to_string()));
        [words(shape)]
            .into_iter()
            .chain(counts)
            .collect::<Vec<_>>()
            .into()
    });
    Table {
        caption: format!(
            "Confusion matrix, true shape (row) and classified shape (column): {name}, all seeds."
        ),
        head: [String::new()].into_iter().chain(shapes()).collect(),
        rows: rows.collect(),
    }
}

fn mean(result: &ShapesResult) -> f64 {
    result.accuracy_percent.iter().sum::<f64>() / result.accuracy_percent.len() as f64
}

fn text(result: &ShapesResult) -> String {
    let (mean, n) = (mean(result), result.accuracy_percent.len());
    if n == 0 {
        return "none".to_owned();
    }
    if n < 2 {
        return format!("{} %", fixed(mean, 1));
    }
    let squares: f64 = result
        .accuracy_percent
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum();
    format!(
        "{} ± {} %",
        fixed(mean, 1),
        fixed((squares / (n - 1) as f64).sqrt(), 1)
    )
}
