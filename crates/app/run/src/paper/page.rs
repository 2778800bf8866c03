//! The page of the paper's experiments: what the paper reports beside what was found here.

use twintac_plot::page::{Badge, Block, Card, Cell, Fact, Figure, Page, Row, Section, Table};
use twintac_plot::{Bar, Bars, Ink, Panel, Panels, Scene, Series, fixed};
use twintac_recording::Provenance;
use twintac_report::pressure_maps;
use twintac_sensor::Sensor;

use super::effort::Effort;
use super::metrics::PaperMetrics;
use super::shapes::{ShapesResult, Simulated};

/// The twin's error that the paper reports, %.
const PAPER_ERROR_PERCENT: f64 = 5.95;
/// Accuracies that the paper reports: real trials alone, and with simulated ones, %.
const PAPER_ACCURACY_PERCENT: [f64; 2] = [33.57, 95.0];

pub(super) fn page(metrics: &PaperMetrics, sensor: &Sensor, command: &str) -> Page {
    Page {
        kind: "TwinTac report".into(),
        title: "The TwinTac paper's experiments".into(),
        badge: badge(metrics.provenance),
        lead: vec![
            "What the paper (arXiv 2509.10063) measured on its own sensor, beside the same experiments on an emulated bench and its twin.".into(),
            "The paper's figures are real, of a sensor and protocols that it describes in part; the numbers are not of the same thing.".into(),
        ],
        warnings: match metrics.effort {
            Effort::Full => Vec::new(),
            Effort::Quick => vec!["Made with --quick: few presses of a simple bench. The figures show that everything runs, and nothing else.".into()],
        },
        sections: vec![
            section("twin", "The twin's error", twin(metrics)),
            section("sensor", "The sensor under a ball", under_a_ball(metrics)),
            section("maps", "Five shapes", maps(metrics, sensor)),
            section("shapes", "Shapes told by touch", shapes(metrics, sensor)),
            section("making-of", "How it was made", making(metrics, command)),
        ],
        is_sheet: false,
    }
}

fn section(id: &'static str, title: &'static str, blocks: Vec<Block>) -> Section {
    Section { id, title, blocks }
}

fn badge(provenance: Provenance) -> Badge {
    Badge(provenance.to_string())
}

fn percent(value: f64) -> String {
    format!("{} %", fixed(value, 2))
}

fn words(text: impl Into<String>) -> Cell {
    Cell::Words(text.into())
}

fn figure(scene: Scene, provenance: Provenance, caption: &str, table: Option<Table>) -> Figure {
    Figure {
        scene,
        badge: Some(badge(provenance)),
        caption: caption.into(),
        table,
    }
}

fn twin(metrics: &PaperMetrics) -> Vec<Block> {
    let found = &metrics.twin;
    let nearest = |name: &str| {
        found
            .variants
            .get(name)
            .map(|figures| figures.nearest_in_contact_percent)
    };
    let baseline = |figures: &Option<crate::Figures>| figures.as_ref().map(|f| f.nearest_in_contact_percent);
    let compared = [
        (
            "this twin",
            Some(found.twin.overall.nearest_in_contact_percent),
            Ink::Twin,
        ),
        ("paper's network, here", nearest("paper"), Ink::Series(1)),
        ("fitted curve", baseline(&found.baselines.kernel), Ink::Sensor),
        (
            "static polynomial",
            baseline(&found.baselines.polynomial),
            Ink::Sensor,
        ),
        ("paper, its sensor", Some(PAPER_ERROR_PERCENT), Ink::Series(0)),
    ];
    let bars = compared.into_iter().filter_map(|(name, value, ink)| {
        Some(Bar {
            name: name.into(),
            value: value?,
            uncertainty: None,
            text: percent(value?),
            ink,
        })
    });
    let chart = Bars {
        title: format!(
            "Error on {} presses that nothing was trained with",
            found.held_out_presses
        ),
        x_label: "mean absolute error, % of the largest reading".into(),
        bars: bars.collect(),
    };
    let caption =
        "Nearest taxel in contact. The paper does not say which frames and taxels its mean is over.";
    vec![
        Block::Text(found.definition.as_str().into()),
        Block::Figures(vec![figure(chart.scene(), metrics.provenance, caption, None)]),
    ]
}

fn under_a_ball(metrics: &PaperMetrics) -> Vec<Block> {
    let own = &metrics.sensor;
    let value = |value: Option<f64>, unit: &str, decimals: usize| {
        Cell::Number(value.map_or("not given".into(), |value| {
            format!("{} {unit}", fixed(value, decimals))
        }))
    };
    let row = |name: &str, paper: &str, own: Cell| -> Row {
        vec![
            words(name),
            Cell::Number(paper.into()),
            own,
            Cell::Badge(badge(metrics.provenance)),
        ]
        .into()
    };
    vec![Block::Table(Table {
        caption: "A 25 mm ball above single taxels. The mean gain of the emulated taxels is tuned to the paper's sensitivity.".into(),
        head: ["", "paper (real)", "here", ""].map(str::to_owned).to_vec(),
        rows: vec![
            row("sensitivity", "7.24 kPa/N", value(own.sensitivity_kpa_per_n, "kPa/N", 2)),
            row("linear to", "the whole range", value(own.linear_to_n, "N", 1)),
            row("largest force", "212 N", value(own.largest_force_n, "N", 1)),
            row("smallest weight found", "0.007 N", value(own.smallest_step_n, "N", 4)),
        ],
    })]
}

fn maps(metrics: &PaperMetrics, sensor: &Sensor) -> Vec<Block> {
    let pictures = metrics.maps.iter().filter_map(|map| {
        let title = format!(
            "{}: they differ by {}",
            map.indenter,
            percent(map.difference_percent)
        );
        let maps = pressure_maps(
            sensor,
            title,
            &[("sensor", &map.sensor_kpa), ("twin", &map.twin_kpa)],
            None,
        )?;
        Some(figure(maps.scene(), metrics.provenance, "", None))
    });
    vec![
        Block::Text("Pressure over the gel, interpolated between the taxels (dots). The difference is the taxels' mean, over the sensor's largest reading.".into()),
        Block::Figures(pictures.collect()),
    ]
}

fn shapes(metrics: &PaperMetrics, sensor: &Sensor) -> Vec<Block> {
    let results = &metrics.shapes;
    let most = results.iter().map(|result| result.real_trials).max().unwrap_or(0);
    let find = |simulated: Simulated| {
        results
            .iter()
            .find(move |result| result.real_trials == most && result.simulated == simulated)
    };
    let named = [
        (Simulated::None, "bench alone", PAPER_ACCURACY_PERCENT[0]),
        (Simulated::Twin, "and this twin", PAPER_ACCURACY_PERCENT[1]),
        (
            Simulated::PaperTwin,
            "and paper's twin",
            PAPER_ACCURACY_PERCENT[1],
        ),
    ];
    let cards = named[..2].iter().filter_map(|(simulated, name, _)| {
        Some(Card {
            fact: Fact::new(*name, text(find(*simulated)?)),
            badge: badge(metrics.provenance),
        })
    });
    let lines = named
        .iter()
        .enumerate()
        .map(|(index, (simulated, name, _))| Series {
            name: (*name).into(),
            points: results
                .iter()
                .filter(|result| result.simulated == *simulated)
                .map(|result| [result.real_trials as f64, mean(result)])
                .collect(),
            ink: Ink::Series(index),
            width_px: 1.5,
            dashed: *simulated == Simulated::PaperTwin,
        });
    let curve = Panels {
        title: "Shapes told, over trials on the bench".into(),
        x_label: "trials of each shape on the bench".into(),
        panels: vec![Panel {
            name: String::new(),
            y_label: "accuracy, %".into(),
            series: lines.collect(),
            y_range: Some([0.0, 100.0]),
        }],
        panel_height_px: 220.0,
        logarithmic: false,
    };
    let row = |result: &ShapesResult| -> Row {
        let (_, name, _) = named[result.simulated as usize];
        vec![
            Cell::Number(result.real_trials.to_string()),
            words(name),
            Cell::Number(result.simulated_trials.to_string()),
            Cell::Number(text(result)),
        ]
        .into()
    };
    let table = Table {
        caption: "Accuracy on trials of the bench that nothing was trained with: mean and standard deviation over seeds. The paper has 33.57 % with 20 real \
                  trials of each shape, and 95.0 % with 96 simulated ones as well."
            .into(),
        head: ["bench", "", "simulated", "accuracy"].map(str::to_owned).to_vec(),
        rows: results.iter().map(row).collect(),
    };
    let mut blocks = vec![
        Block::Cards(cards.collect()),
        Block::Figures(vec![figure(curve.scene(), metrics.provenance, "", Some(table))]),
    ];
    for (simulated, name, _) in &named[..2] {
        if let Some(result) = find(*simulated) {
            blocks.push(Block::Table(confusion(result, name, sensor)));
        }
    }
    blocks
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
        caption: format!("Which shape (row) was taken for which (column): {name}, all seeds."),
        head: [String::new()].into_iter().chain(shapes()).collect(),
        rows: rows.collect(),
    }
}

fn mean(result: &ShapesResult) -> f64 {
    result.accuracy_percent.iter().sum::<f64>() / result.accuracy_percent.len() as f64
}

fn text(result: &ShapesResult) -> String {
    let (mean, n) = (mean(result), result.accuracy_percent.len());
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

fn making(metrics: &PaperMetrics, command: &str) -> Vec<Block> {
    vec![
        Block::Command(command.into()),
        Block::Facts(vec![
            Fact::new("twintac", env!("CARGO_PKG_VERSION")),
            Fact::new("seed", metrics.seed.to_string()),
        ]),
    ]
}
