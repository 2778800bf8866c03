//! The page of the paper's experiments: what the paper reports beside what was found here.

use twintac_classify::Sampling;
use twintac_plot::page::{Badge, Block, Card, Cell, Fact, Figure, Page, Row, Section, Table};
use twintac_plot::{Bar, Bars, Ink, Panel, Panels, Scene, Series, fixed};
use twintac_recording::Provenance;
use twintac_report::pressure_maps;
use twintac_sensor::Sensor;

use super::effort::{Effort, PAPER_SIMULATED};
use super::metrics::PaperMetrics;
use super::mixture::{Mixture, Simulated};
use super::shapes::ShapesResult;

/// The twin's error that the paper reports, %.
const PAPER_ERROR_PERCENT: f64 = 5.95;

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
    let material = &metrics.material;
    let [x_mrad, y_mrad] = metrics.tilt_rad.map(|tilt| fixed(1e3 * tilt, 1));
    let gel = format!(
        "First touches of the ball say how the sensor lies: turned by {x_mrad} and {y_mrad} mrad about x and y. The gel was then fitted to the forces of {} other presses: Yeoh's c10 {} kPa, c20 {} kPa, Poisson's ratio {}; {} of the largest force is left.",
        material.presses,
        fixed(material.c10_kpa, 1),
        fixed(material.c20_kpa, 1),
        fixed(material.poissons_ratio, 3),
        percent(material.residual_percent)
    );
    vec![
        Block::Text(gel.into()),
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

/// Training on the bench alone, with the paper's number of simulated trials of either twin, and with all of this one: a name, whose they are, and which.
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
        ("bench alone".to_owned(), Simulated::None, 0),
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

fn shapes(metrics: &PaperMetrics, sensor: &Sensor) -> Vec<Block> {
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
                "Shapes told, over trials on the bench",
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
        let title = "Shapes told, over trials of this twin";
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
        "A press is seen at twelve equal steps of load, so that its speed and its hold do not matter. The same classifier on samples at equal steps of time: {}.",
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
        caption: "Trials of each shape, and accuracy on trials of the bench that nothing was trained with: mean and standard deviation over seeds. The paper has \
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
