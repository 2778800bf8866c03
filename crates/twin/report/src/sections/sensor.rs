//! The sensor's drawing and facts.

use twintac_plot::page::Block;

use super::parts::figure;
use crate::TwinReport;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let sensor = report.sensor;
    let caption = format!("{}, drawn from its description; dimensions in mm.", sensor.name);
    let drawing = figure(twintac_drawing::drawing(sensor), None, caption);
    vec![
        Block::Wide(Box::new(drawing)),
        Block::Facts(twintac_drawing::facts(sensor)),
    ]
}
