//! The page of the paper's experiments: the paper's figures beside those of this project.

use twintac_model::Figures;
use twintac_plot::page::{Block, Cell, Fact, Page, Row, Section, Table};
use twintac_plot::{Bar, Bars, Ink, fixed};
use twintac_report::pressure_maps;
use twintac_sensor::Sensor;

use crate::blocks::{badge, figure, percent, words};
use crate::effort::Effort;
use crate::metrics::PaperMetrics;
use crate::shapes_section::shapes;

/// The twin's error that the paper reports, %.
const PAPER_ERROR_PERCENT: f64 = 5.95;

pub(super) fn page(metrics: &PaperMetrics, sensor: &Sensor, command: &str) -> Page {
    Page {
        kind: "TwinTac report".into(),
        title: "The TwinTac paper's experiments".into(),
        badge: badge(metrics.provenance),
        lead: vec![
            "The measurements of the paper (arXiv 2509.10063) on its own sensor, beside the same experiments on an emulated bench and its twin.".into(),
            "The paper's figures are real. It describes its sensor and protocols only in part, so the two cannot be compared directly.".into(),
        ],
        warnings: warnings(metrics),
        sections: vec![
            section("twin", "The twin's error", twin(metrics)),
            section("sensor", "The sensor under a ball", under_a_ball(metrics)),
            section("maps", "Five shapes", maps(metrics, sensor)),
            section("shapes", "Shapes classified by touch", shapes(metrics, sensor)),
            section("making-of", "How it was made", making(metrics, command)),
        ],
        is_sheet: false,
    }
}

fn warnings(metrics: &PaperMetrics) -> Vec<String> {
    let quick = match metrics.effort {
        Effort::Full => None,
        Effort::Quick => Some("Made with --quick: few presses on a simple test setup. The figures only show that everything runs.".into()),
    };
    let fit = metrics.material.warnings.iter();
    let fit = fit.map(|warning| format!("The fit of the gel's material: {warning}."));
    quick.into_iter().chain(fit).collect()
}

fn section(id: &'static str, title: &'static str, blocks: Vec<Block>) -> Section {
    Section { id, title, blocks }
}

fn twin(metrics: &PaperMetrics) -> Vec<Block> {
    let found = &metrics.twin;
    let nearest = |name: &str| {
        found
            .variants
            .get(name)
            .and_then(|figures| figures.nearest_in_contact_percent)
    };
    let baseline = |figures: &Option<Figures>| figures.as_ref().and_then(|f| f.nearest_in_contact_percent);
    let compared = [
        (
            "this twin",
            found.twin.overall.nearest_in_contact_percent,
            Ink::Twin,
        ),
        ("paper's network, here", nearest("paper"), Ink::Series(1)),
        (
            "parametric baseline",
            baseline(&found.baselines.kernel),
            Ink::Sensor,
        ),
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
        title: format!("Error on {} held-out presses", found.held_out_presses),
        x_label: "mean absolute error, % of the largest reading".into(),
        bars: bars.collect(),
    };
    let caption =
        "Nearest taxel in contact. The paper does not say which frames and taxels its mean is over.";
    let material = &metrics.material;
    let [x_mrad, y_mrad] = metrics.tilt_rad.map(|tilt| fixed(1e3 * tilt, 1));
    let gel = format!(
        "First touches of the ball give the tilt of the sensor: {x_mrad} and {y_mrad} mrad about x and y. The gel was then fitted to the forces of {} other presses: Yeoh's c10 {} kPa, c20 {} kPa, Poisson's ratio {}, friction {}; the residual is {} of the largest force.",
        material.presses,
        fixed(material.c10_kpa, 1),
        fixed(material.c20_kpa, 1),
        fixed(material.poissons_ratio, 3),
        fixed(material.friction, 2),
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
            row("smallest weight detected", "0.007 N", value(own.smallest_step_n, "N", 4)),
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
        Block::Text("Pressure over the gel, interpolated between the taxels (dots). The difference is the mean over the taxels, relative to the sensor's largest reading.".into()),
        Block::Figures(pictures.collect()),
    ]
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
