//! Losses over epochs, one chart a variant.

use digitac::Epoch;
use twintac_plot::page::Block;
use twintac_plot::{Ink, Panels};

use super::parts::{chart, figure, line};
use crate::TwinReport;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let pictures = report.variants.iter().map(|trained| {
        let losses = |loss: fn(&Epoch) -> f64| -> Vec<[f64; 2]> {
            let epochs = trained.history.iter().enumerate();
            epochs
                .map(|(index, epoch)| [index as f64 + 1.0, loss(epoch)])
                .collect()
        };
        let lines = vec![
            line("training", losses(|epoch| epoch.loss), Ink::Sensor, 1.75),
            line(
                "validation",
                losses(|epoch| epoch.validation_loss),
                Ink::Twin,
                1.75,
            ),
        ];
        let chart = Panels {
            logarithmic: true,
            ..chart(trained.variant.name(), ["epoch", "loss"], lines)
        };
        let caption = "Where the validation loss rises while the training loss falls, the twin overfits.";
        figure(chart.scene(), report.provenance, caption)
    });
    vec![Block::Figures(pictures.collect())]
}
