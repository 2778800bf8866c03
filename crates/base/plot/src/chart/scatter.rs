//! Points over two quantities; a third quantity is shown as colour.

use super::heat::{color_bar_room, draw_color_bar};
use super::{BELOW, LABEL};
use crate::axis::{Axis, extent, padded};
use crate::color::{Ink, viridis};
use crate::font::fitted;
use crate::scene::{Anchor, SMALL, Scene};

/// Size of the chart, px.
const SIZE: [f64; 2] = [560.0, 360.0];

/// Ratio of the largest to the smallest value above which an axis of positive numbers is
/// logarithmic.
const WIDE: f64 = 20.0;

/// One point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScatterPoint {
    /// Position, in the units of the axes.
    pub at: [f64; 2],
    /// The value that its colour shows.
    pub value: f64,
    /// Whether the point is emphasized; other points are small and pale.
    pub is_ringed: bool,
    /// A label beside the point; none if empty.
    pub name: String,
}

/// Points over two quantities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scatter {
    /// Title.
    pub title: String,
    /// Quantity and unit of the horizontal axis.
    pub x_label: String,
    /// Quantity and unit of the vertical axis.
    pub y_label: String,
    /// Quantity and unit of the colour.
    pub value_label: String,
    /// The points.
    pub points: Vec<ScatterPoint>,
}

impl Scatter {
    /// Draws the points; emphasized points come last, on top of the others. An axis is logarithmic
    /// if its numbers are positive and span more than a factor of 20.
    pub fn scene(&self) -> Scene {
        let is_number = |point: &&ScatterPoint| {
            point.value.is_finite() && point.at.iter().all(|coordinate| coordinate.is_finite())
        };
        let points: Vec<&ScatterPoint> = self.points.iter().filter(is_number).collect();
        let along = |axis: usize, pixels: [f64; 2]| {
            let [low, high] = extent(points.iter().map(|point| point.at[axis])).unwrap_or([0.0, 1.0]);
            if low > 0.0 && high > WIDE * low {
                Axis::logarithmic([low / 1.1, 1.1 * high], pixels)
            } else {
                Axis::linear(padded([low, high], 0.06), pixels)
            }
        };
        let values = extent(points.iter().map(|point| point.value)).unwrap_or([0.0, 1.0]);
        let [width, height] = SIZE;
        let left = LABEL + along(1, [height, 0.0]).left_room();
        let right = width - 14.0 - color_bar_room(values, "");
        let mut scene = Scene::new(&self.title, width, 0.0);
        let top = scene.heading(&self.title) + SMALL + 12.0;
        let bottom = top + height;
        scene.height = bottom + BELOW;
        let (x, y) = (along(0, [left, right - 14.0]), along(1, [bottom, top]));
        x.draw_below(&mut scene, top, bottom);
        y.draw_left(&mut scene, left, right - 14.0);
        let place = |point: &ScatterPoint| [x.place(point.at[0]), y.place(point.at[1])];
        let color = |value: f64| Ink::Rgb(viridis((value - values[0]) / (values[1] - values[0]).max(1e-12)));
        for point in points.iter().filter(|point| !point.is_ringed) {
            scene.dot(place(point), 3.0, color(point.value), 0.45);
        }
        for point in points.iter().filter(|point| point.is_ringed) {
            scene.ring(place(point), 5.0, Ink::Text, Some(color(point.value)));
        }
        for point in points.iter().filter(|point| !point.name.is_empty()) {
            let [x, y] = place(point);
            let (aside, anchor) = if x < 0.5 * (left + right) {
                (9.0, Anchor::Start)
            } else {
                (-9.0, Anchor::End)
            };
            scene.text(
                [x + aside, y - 6.0],
                point.name.clone(),
                SMALL,
                Ink::Text,
                anchor,
                true,
            );
        }
        let bar_label = fitted(&self.value_label, SMALL, width - left);
        scene.small([width, top - 8.0], bar_label, Ink::Muted, Anchor::End);
        draw_color_bar(&mut scene, values, "", right, [top, bottom]);
        scene.centred(
            [0.5 * (left + right), scene.height - 6.0],
            &self.x_label,
            Ink::Muted,
        );
        scene.upwards([12.0, 0.5 * (top + bottom)], &self.y_label);
        scene
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Mark;
    use crate::svg;

    fn point(x: f64, y: f64, value: f64) -> ScatterPoint {
        ScatterPoint {
            at: [x, y],
            value,
            ..ScatterPoint::default()
        }
    }

    #[test]
    fn what_is_not_a_number_is_left_out() {
        let scatter = Scatter {
            points: vec![
                point(1.0, 1.0, 1.0),
                point(f64::NAN, 1.0, 1.0),
                point(1.0, 2.0, f64::INFINITY),
                point(300.0, 0.0, 2.0),
            ],
            ..Scatter::default()
        };
        let dots = scatter
            .scene()
            .marks
            .iter()
            .filter(|mark| matches!(mark, Mark::Circle { .. }))
            .count();
        assert_eq!(dots, 2);
        assert!(!svg(&Scatter::default().scene()).contains("NaN"));
    }

    #[test]
    fn all_text_fits() {
        let mut best = point(0.001, 5.0, 0.2);
        best.name = "best: design 17".to_owned();
        best.is_ringed = true;
        let scatter = Scatter {
            title: "phystac: 200 designs".to_owned(),
            x_label: "range, N".to_owned(),
            y_label: "smallest force, N".to_owned(),
            value_label: "localization error, mm".to_owned(),
            points: vec![best, point(50.0, 400.0, 0.7)],
        };
        assert_eq!(scatter.scene().overflow(), Vec::<&str>::new());
    }
}
