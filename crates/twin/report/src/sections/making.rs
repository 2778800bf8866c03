//! Command line, version, seed, settings and time.

use twintac_plot::page::{Block, Fact};
use twintac_plot::{Bar, Bars, Ink, short};

use super::parts::figure;
use crate::TwinReport;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let making = &report.making;
    let facts = vec![
        Fact::new("twintac", env!("CARGO_PKG_VERSION")),
        Fact::new("presses", &making.source),
        Fact::new("seed", making.seed.to_string()),
    ];
    let mut pictures = Vec::new();
    if !making.stages.is_empty() {
        let bars = making.stages.iter().map(|stage| Bar {
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
        let caption = "Measured while the stages ran; it depends on the machine.";
        pictures.push(figure(chart.scene(), None, caption));
    }
    vec![
        Block::Command(making.command.clone()),
        Block::Facts(facts),
        Block::Figures(pictures),
        Block::Details("Settings used", making.settings.clone()),
    ]
}
