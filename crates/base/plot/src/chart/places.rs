//! A number at each pressed location, as colour over the gel.

use super::heat::{color_bar_room, draw_color_bar};
use super::{BELOW, LABEL, WIDTH_PX};
use crate::axis::{Axis, extent, padded};
use crate::color::{Ink, viridis};
use crate::scene::Scene;

/// Locations on the gel with one value each.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// Title.
    pub title: String,
    /// Unit of the values.
    pub unit: String,
    /// The locations, mm.
    pub places_mm: Vec<[f64; 2]>,
    /// The value at each location.
    pub values: Vec<f64>,
    /// Points to mark, such as taxels, mm.
    pub marks_mm: Vec<[f64; 2]>,
}

impl Places {
    /// Draws the locations in true proportions; the colour scale ends at the 99th percentile.
    pub fn scene(&self) -> Scene {
        const HEIGHT: f64 = 340.0;
        let shown = || {
            let pairs = self.places_mm.iter().copied().zip(self.values.iter().copied());
            pairs.filter(|(place, value)| place.iter().all(|x| x.is_finite()) && value.is_finite())
        };
        let range = |axis: usize| {
            let all = shown()
                .map(|(place, _)| place[axis])
                .chain(self.marks_mm.iter().map(|mark| mark[axis]));
            padded(extent(all).unwrap_or([0.0, 1.0]), 0.04)
        };
        let (x_range, y_range) = (range(0), range(1));
        let length = |range: [f64; 2]| (range[1] - range[0]).max(1e-9);
        let mut sorted: Vec<f64> = shown().map(|(_, value)| value).collect();
        sorted.sort_by(f64::total_cmp);
        let highest = sorted
            .get(sorted.len().saturating_sub(1) * 99 / 100)
            .copied()
            .unwrap_or(1.0);
        let lowest = sorted.first().copied().unwrap_or(0.0).min(0.0);
        let left = LABEL + Axis::linear(y_range, [HEIGHT, 0.0]).left_room();
        let bar = 14.0 + color_bar_room([lowest, highest], &self.unit);
        let scale = ((WIDTH_PX - left - bar) / length(x_range)).min(HEIGHT / length(y_range));
        let mut scene = Scene::new(&self.title, WIDTH_PX, 0.0);
        let top = scene.heading(&self.title) + 14.0;
        let right = left + (scale * length(x_range)).max(40.0);
        let bottom = top + (scale * length(y_range)).max(40.0);
        scene.height = bottom + BELOW;

        let (x_axis, y_axis) = (
            Axis::linear(x_range, [left, right]),
            Axis::linear(y_range, [bottom, top]),
        );
        x_axis.draw_below(&mut scene, top, bottom);
        y_axis.draw_left(&mut scene, left, right);
        let area = length(x_range) * length(y_range);
        let radius = (0.45 * scale * (area / sorted.len().max(1) as f64).sqrt()).clamp(1.0, 6.0);
        for (place, value) in shown() {
            let ink = Ink::Rgb(viridis((value - lowest) / (highest - lowest).max(1e-12)));
            scene.dot([x_axis.place(place[0]), y_axis.place(place[1])], radius, ink, 1.0);
        }
        for mark in &self.marks_mm {
            let at = [x_axis.place(mark[0]), y_axis.place(mark[1])];
            scene.ring(at, 4.0, Ink::Rgb([255; 3]), Some(Ink::Rgb([0; 3])));
        }
        draw_color_bar(
            &mut scene,
            [lowest, highest],
            &self.unit,
            right + 14.0,
            [top, bottom],
        );
        scene.centred([0.5 * (left + right), scene.height - 6.0], "x, mm", Ink::Muted);
        scene.upwards([12.0, 0.5 * (top + bottom)], "y, mm");
        scene
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Mark;
    use crate::svg;

    #[test]
    fn places_without_numbers_are_left_out() {
        let places_mm = vec![[0.0, 0.0], [1.0, 1.0], [f64::NAN, 0.0]];
        let places = Places {
            places_mm,
            values: vec![1.0, f64::NAN, 2.0],
            ..Places::default()
        };
        let dots = places
            .scene()
            .marks
            .iter()
            .filter(|mark| matches!(mark, Mark::Circle { .. }))
            .count();
        assert_eq!(dots, 1);
        assert!(!svg(&Places::default().scene()).contains("NaN"));
    }
}
