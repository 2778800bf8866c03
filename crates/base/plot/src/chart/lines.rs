//! Lines over a common horizontal axis, in one panel or several.

use super::{BELOW, LABEL, RIGHT, WIDTH_PX};
use crate::axis::{Axis, extent, padded};
use crate::color::Ink;
use crate::font::{fitted, widest};
use crate::scene::{Anchor, SMALL, Scene};

/// One line.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name in the legend. Series of the same name in several panels share an entry; an empty name
    /// has no entry.
    pub name: String,
    /// Points [x, y] in the units of the axes, in the order in which they are joined.
    pub points: Vec<[f64; 2]>,
    /// Colour.
    pub ink: Ink,
    /// Width of the line, px.
    pub width_px: f64,
    /// Whether the line is dashed.
    pub dashed: bool,
}

/// One box with lines.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// A short name at the right of the box.
    pub name: String,
    /// Quantity and unit of the vertical axis.
    pub y_label: String,
    /// Lines, from back to front.
    pub series: Vec<Series>,
    /// Range of the vertical axis; `None` takes it from the data.
    pub y_range: Option<[f64; 2]>,
}

/// Panels above one another that share the horizontal axis.
#[derive(Clone, Debug)]
pub struct Panels {
    /// Title.
    pub title: String,
    /// Quantity and unit of the horizontal axis.
    pub x_label: String,
    /// Boxes from top to bottom.
    pub panels: Vec<Panel>,
    /// Height of each box, px.
    pub panel_height_px: f64,
    /// Whether the vertical axes are logarithmic.
    pub logarithmic: bool,
}

impl Panels {
    /// Draws the panels, 380 px wide.
    pub fn scene(&self) -> Scene {
        const GAP: f64 = 12.0;
        const LONGEST_NAME: f64 = 110.0;
        let height = self.panel_height_px;
        let names = widest(self.panels.iter().map(|panel| panel.name.as_str()), SMALL).min(LONGEST_NAME);
        let ticks = self
            .panels
            .iter()
            .map(|panel| self.y_axis(panel, [0.0, height]).left_room());
        let left = LABEL + ticks.fold(0.0, f64::max);
        let right = WIDTH_PX - if names > 0.0 { names + 8.0 } else { RIGHT };

        let mut scene = Scene::new(&self.title, WIDTH_PX, 0.0);
        let below_title = scene.heading(&self.title);
        let legend = scene.legend([0.0, below_title + 14.0], &self.legend());
        let mut top = below_title + 8.0 + legend;
        let count = self.panels.len() as f64;
        scene.height = top + count * height + (count - 1.0).max(0.0) * GAP + BELOW;

        let points = self.series().flat_map(|series| &series.points);
        let x_range = extent(points.map(|point| point[0])).unwrap_or([0.0, 1.0]);
        let x_axis = Axis::linear(x_range, [left, right]);
        for (index, panel) in self.panels.iter().enumerate() {
            let bottom = top + height;
            self.draw_panel(&mut scene, panel, &x_axis, [left, right], [top, bottom]);
            let name = fitted(&panel.name, SMALL, LONGEST_NAME);
            let middle = 0.5 * (top + bottom);
            scene.small([right + 8.0, middle + 4.0], name, Ink::Text, Anchor::Start);
            // Neighbours with the same quantity share one label in their middle.
            let same = |other: &&Panel| other.y_label == panel.y_label;
            if index == 0 || self.panels[index - 1].y_label != panel.y_label {
                let run = self.panels[index..].iter().take_while(same).count() as f64;
                let room = run * (height + GAP) - GAP;
                let label = fitted(&panel.y_label, SMALL, room + GAP);
                scene.upwards([12.0, top + 0.5 * room], &label);
            }
            top = bottom + GAP;
        }
        let bottom = scene.height - BELOW;
        x_axis.draw_below(&mut scene, bottom, bottom);
        scene.centred(
            [0.5 * (left + right), scene.height - 6.0],
            &self.x_label,
            Ink::Muted,
        );
        scene
    }

    fn series(&self) -> impl Iterator<Item = &Series> {
        self.panels.iter().flat_map(|panel| &panel.series)
    }

    fn y_axis(&self, panel: &Panel, [top, bottom]: [f64; 2]) -> Axis {
        let points = panel.series.iter().flat_map(|series| &series.points);
        let values = points.map(|point| point[1]);
        if self.logarithmic {
            let positive = extent(values.filter(|value| *value > 0.0)).unwrap_or([0.1, 1.0]);
            Axis::logarithmic(panel.y_range.unwrap_or(positive), [bottom, top])
        } else {
            let data = extent(values).map_or([0.0, 1.0], |range| padded(range, 0.05));
            Axis::linear(panel.y_range.unwrap_or(data), [bottom, top])
        }
    }

    fn draw_panel(
        &self,
        scene: &mut Scene,
        panel: &Panel,
        x_axis: &Axis,
        [left, right]: [f64; 2],
        height: [f64; 2],
    ) {
        let y_axis = self.y_axis(panel, height);
        y_axis.draw_left(scene, left, right);
        for series in &panel.series {
            let pixels = thinned(&series.points, 2 * (right - left) as usize);
            let pixels = pixels
                .into_iter()
                .map(|[x, y]| [x_axis.place(x), y_axis.place(y)]);
            if series.dashed {
                scene.dashes(pixels, series.ink, series.width_px);
            } else {
                scene.line(pixels, series.ink, series.width_px);
            }
        }
    }

    fn legend(&self) -> Vec<(&str, Ink, bool)> {
        let mut entries: Vec<(&str, Ink, bool)> = Vec::new();
        for series in self.series() {
            let entry = (series.name.as_str(), series.ink, series.dashed);
            if !series.name.is_empty() && !entries.contains(&entry) {
                entries.push(entry);
            }
        }
        entries
    }
}

/// At most about `most` points that keep every peak: the lowest and the highest of each run of
/// neighbours.
fn thinned(points: &[[f64; 2]], most: usize) -> Vec<[f64; 2]> {
    let run = points.len().div_ceil(most.max(2) / 2).max(1);
    if run <= 2 {
        return points.to_vec();
    }
    let mut kept = Vec::with_capacity(most);
    for chunk in points.chunks(run) {
        if chunk.iter().any(|point| point[1].is_nan()) {
            kept.extend_from_slice(chunk);
            continue;
        }
        let by_height = |a: &usize, b: &usize| chunk[*a][1].total_cmp(&chunk[*b][1]);
        let low = (0..chunk.len()).min_by(by_height).unwrap_or(0);
        let high = (0..chunk.len()).max_by(by_height).unwrap_or(0);
        kept.push(chunk[low.min(high)]);
        if low != high {
            kept.push(chunk[low.max(high)]);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg;

    fn chart(points: Vec<[f64; 2]>) -> Panels {
        let series = Series {
            name: "a".into(),
            points,
            ink: Ink::Twin,
            width_px: 1.5,
            dashed: false,
        };
        let panel = Panel {
            y_label: "pressure, kPa".into(),
            series: vec![series],
            ..Panel::default()
        };
        Panels {
            title: "t".into(),
            x_label: "time, s".into(),
            panels: vec![panel],
            panel_height_px: 100.0,
            logarithmic: false,
        }
    }

    #[test]
    fn thinning_keeps_peaks_and_gaps() {
        let mut points: Vec<[f64; 2]> = (0..10_000).map(|i| [f64::from(i), 0.0]).collect();
        points[7777][1] = 5.0;
        points[3333][1] = f64::NAN;
        let kept = thinned(&points, 400);
        assert!(kept.len() < 500);
        assert!(kept.contains(&[7777.0, 5.0]));
        assert!(kept.iter().any(|point| point[1].is_nan()));
    }

    #[test]
    fn no_data_and_no_numbers_are_drawn_as_an_empty_box() {
        for points in [
            vec![],
            vec![[f64::NAN, f64::NAN]; 3],
            vec![[0.0, f64::INFINITY]; 2],
            vec![[1.0, 1.0]],
        ] {
            let text = svg(&chart(points).scene());
            assert!(text.contains("pressure, kPa") && !text.contains("NaN"));
        }
        let empty = Panels {
            panels: vec![],
            ..chart(vec![])
        };
        assert!(svg(&empty.scene()).contains("time, s"));
    }
}
