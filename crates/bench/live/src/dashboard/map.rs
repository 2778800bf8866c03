//! The pressure map, with two pixels in each character.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Color;
use ratatui::widgets::Widget;
use twintac_plot::viridis;

use super::DashboardState;

/// The map of a state, as large as its proportions allow.
pub(super) struct Map<'a>(pub(super) &'a DashboardState);

impl Widget for Map<'_> {
    fn render(self, area: Rect, buffer: &mut Buffer) {
        let Self(state) = self;
        let rectangle = state.prepared.rectangle();
        let [width_mm, height_mm] = [0, 1].map(|axis| rectangle.max_mm[axis] - rectangle.min_mm[axis]);
        // A character is twice as high as wide. Its halves are the pixels.
        let pixels = [f64::from(area.width), 2.0 * f64::from(area.height)];
        let per_mm = (pixels[0] / width_mm).min(pixels[1] / height_mm);
        let [width, height] = [per_mm * width_mm, per_mm * height_mm].map(|length| length as u16);
        let (columns, lines) = (width, height / 2);
        if columns == 0 || lines == 0 {
            return;
        }
        let (left, top) = (
            area.x + (area.width - columns) / 2,
            area.y + (area.height - lines) / 2,
        );
        let scale_kpa = state.scale_kpa();
        let colour = |column: u16, pixel: u16| {
            let [grid_columns, grid_rows] = state.prepared.grid();
            let along = |at: u16, pixels: u16, cells: usize| {
                ((f64::from(at) + 0.5) / f64::from(pixels) * cells as f64) as usize
            };
            let row = grid_rows - 1 - along(pixel, 2 * lines, grid_rows); // y points up
            let pressure_kpa = state.map_kpa[row * grid_columns + along(column, columns, grid_columns)];
            let [red, green, blue] = viridis(pressure_kpa / scale_kpa);
            Color::Rgb(red, green, blue)
        };
        for line in 0..lines {
            for column in 0..columns {
                if let Some(cell) = buffer.cell_mut(Position::new(left + column, top + line)) {
                    cell.set_symbol("▀");
                    cell.set_fg(colour(column, 2 * line))
                        .set_bg(colour(column, 2 * line + 1));
                }
            }
        }
        for (place_mm, fault) in state.about.places_mm.iter().zip(state.faults()) {
            let part = |axis: usize| {
                (place_mm[axis] - rectangle.min_mm[axis]) / (rectangle.max_mm[axis] - rectangle.min_mm[axis])
            };
            let column = (part(0) * f64::from(columns)) as u16;
            let line = ((1.0 - part(1)) * f64::from(lines)) as u16;
            if let Some(cell) = buffer.cell_mut(Position::new(left + column, top + line)) {
                let (symbol, ink) = match fault {
                    None => ("•", Color::White),
                    Some(_) => ("×", Color::LightRed),
                };
                cell.set_symbol(symbol).set_fg(ink);
            }
        }
    }
}
