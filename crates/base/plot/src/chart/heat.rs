//! Maps side by side, with one colour scale.

use crate::axis::{Axis, extent};
use crate::color::{Ink, viridis};
use crate::font::{fitted, text_width, widest};
use crate::scene::{Anchor, Mark, SMALL, Scene};

/// One map with its name.
#[derive(Clone, Debug)]
pub struct HeatMap {
    /// Name above the map.
    pub name: String,
    /// Corner with the smallest x and y of the rectangle that the grid fills, mm.
    pub min_mm: [f64; 2],
    /// Corner with the largest x and y, mm.
    pub max_mm: [f64; 2],
    /// Columns and rows of the grid.
    pub grid: [usize; 2],
    /// A value for each cell, `[rows][columns]` flattened; the row with the smallest y comes first.
    pub values: Vec<f64>,
}

/// Maps that share the colour scale, with points and a circle marked.
#[derive(Clone, Debug)]
pub struct HeatMaps {
    /// Title.
    pub title: String,
    /// Maps over rectangles of the same size.
    pub maps: Vec<HeatMap>,
    /// Unit of the values, above the colour scale.
    pub unit: String,
    /// Points to mark on every map, such as taxels, mm.
    pub marks_mm: Vec<[f64; 2]>,
    /// Centre and radius of a circle to mark, such as an indenter, mm.
    pub circle_mm: Option<([f64; 2], f64)>,
}

impl HeatMaps {
    /// Draws the maps beside each other, or above each other if they are long.
    pub fn scene(&self) -> Scene {
        const WIDTH: f64 = super::WIDTH_PX;
        const GAP: f64 = 16.0;
        let count = self.maps.len().max(1);
        let aspect = self.maps.first().map_or(1.0, |heat| {
            let [width, height] = size_mm(heat);
            if width > 0.0 && height > 0.0 {
                width / height
            } else {
                1.0
            }
        });
        let columns = if aspect > 1.6 { 1 } else { count };
        let rows = count.div_ceil(columns);
        let range = self.range();
        let room = WIDTH - 12.0 - color_bar_room(range, &self.unit);
        let tall = if columns == 1 { 180.0 } else { 260.0 };
        let width = ((room - GAP * (columns - 1) as f64) / columns as f64).min(tall * aspect);
        let height = (width / aspect).max(12.0);
        let mut scene = Scene::new(&self.title, WIDTH, 0.0);
        let (top, pitch_y) = (scene.heading(&self.title) + 20.0, height + 34.0);
        scene.height = top + pitch_y * rows as f64 - 30.0;
        for (index, heat) in self.maps.iter().enumerate() {
            let at = [
                (index % columns) as f64 * (width + GAP),
                top + (index / columns) as f64 * pitch_y,
            ];
            let name = fitted(&heat.name, SMALL, width);
            scene.small([at[0], at[1] - 6.0], name, Ink::Muted, Anchor::Start);
            self.draw_map(&mut scene, heat, range, at, [width, height]);
        }
        let right = columns as f64 * (width + GAP) - GAP;
        let bottom = top + pitch_y * (rows - 1) as f64 + height;
        draw_color_bar(
            &mut scene,
            range,
            &self.unit,
            right + 12.0,
            [top, bottom.max(top + 60.0)],
        );
        scene.height = scene.height.max(bottom.max(top + 60.0) + 8.0);
        scene
    }

    fn range(&self) -> [f64; 2] {
        let values = self.maps.iter().flat_map(|heat| heat.values.iter().copied());
        extent(values.chain([0.0])).unwrap_or([0.0, 1.0])
    }

    fn draw_map(&self, scene: &mut Scene, map: &HeatMap, range: [f64; 2], at: [f64; 2], size: [f64; 2]) {
        let [columns, rows] = map.grid;
        let shade = |value: f64| viridis((value - range[0]) / (range[1] - range[0]).max(1e-12));
        // The first row of the picture is at the top, where y is largest.
        let flipped = (0..rows)
            .rev()
            .filter_map(|row| map.values.get(row * columns..(row + 1) * columns));
        let pixels = flipped.flatten().map(|&value| shade(value)).collect();
        scene.marks.push(Mark::Image {
            at,
            size,
            columns,
            pixels,
        });

        let [width_mm, height_mm] = size_mm(map);
        let scale = size[0] / width_mm;
        let place = |point: [f64; 2]| {
            let from_left = (point[0] - map.min_mm[0]) / width_mm;
            let from_top = (map.max_mm[1] - point[1]) / height_mm;
            [at[0] + from_left * size[0], at[1] + from_top * size[1]]
        };
        for &mark in &self.marks_mm {
            scene.ring(place(mark), 3.0, Ink::Rgb([255; 3]), Some(Ink::Rgb([0; 3])));
        }
        if let Some((centre, radius_mm)) = self.circle_mm {
            let circle = (0..=72)
                .map(|step| f64::from(step) * std::f64::consts::TAU / 72.0)
                .map(|angle| {
                    place([
                        centre[0] + radius_mm * angle.cos(),
                        centre[1] + radius_mm * angle.sin(),
                    ])
                });
            // The parts of the circle outside of the map are not drawn.
            let inside = |[x, y]: [f64; 2]| {
                (at[0]..=at[0] + size[0]).contains(&x) && (at[1]..=at[1] + size[1]).contains(&y)
            };
            let clipped = circle.map(|point| if inside(point) { point } else { [f64::NAN; 2] });
            if scale.is_finite() {
                scene.dashes(clipped, Ink::Rgb([255; 3]), 1.5);
            }
        }
    }
}

fn size_mm(map: &HeatMap) -> [f64; 2] {
    [0, 1].map(|axis| map.max_mm[axis] - map.min_mm[axis])
}

/// Approximate distance between the tick texts of a colour bar, px.
const TICK_GAP: f64 = 28.0;
/// Width of the longest unit that is written in full, px.
const LONGEST_UNIT: f64 = 90.0;

/// Width of a colour bar with its texts, px.
pub(crate) fn color_bar_room(range: [f64; 2], unit: &str) -> f64 {
    // The texts of a short bar are not wider than those of a long one.
    let ticks = Axis::linear(range, [600.0, 0.0]).ticks(TICK_GAP);
    let ticks = 15.0 + widest(ticks.iter().map(|(_, text)| text.as_str()), SMALL);
    ticks.max(text_width(unit, SMALL).min(LONGEST_UNIT))
}

/// Draws a vertical colour bar with ticks on its right.
pub(crate) fn draw_color_bar(
    scene: &mut Scene,
    range: [f64; 2],
    unit: &str,
    x: f64,
    [top, bottom]: [f64; 2],
) {
    const STEPS: usize = 64;
    let pixels = (0..STEPS)
        .rev()
        .map(|step| viridis(step as f64 / (STEPS - 1) as f64))
        .collect();
    scene.marks.push(Mark::Image {
        at: [x, top],
        size: [10.0, bottom - top],
        columns: 1,
        pixels,
    });
    let axis = Axis::linear(range, [bottom, top]);
    for (value, text) in axis.ticks(TICK_GAP) {
        let at = [x + 15.0, axis.place(value) + 4.0];
        scene.small(at, text, Ink::Muted, Anchor::Start);
    }
    let unit = fitted(unit, SMALL, LONGEST_UNIT);
    scene.small([x, top - 10.0], unit, Ink::Muted, Anchor::Start);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg;

    #[test]
    fn maps_without_extent_or_numbers_are_drawn() {
        let map = HeatMap {
            name: "sensor".into(),
            min_mm: [0.0; 2],
            max_mm: [0.0; 2],
            grid: [2, 2],
            values: vec![f64::NAN; 4],
        };
        let heat = HeatMaps {
            title: "t".into(),
            maps: vec![map],
            unit: "kPa".into(),
            marks_mm: vec![[0.0; 2]],
            circle_mm: Some(([0.0; 2], f64::NAN)),
        };
        let text = svg(&heat.scene());
        assert!(text.contains("<image") && !text.contains("NaN"));
        let empty = HeatMaps {
            maps: vec![],
            marks_mm: vec![],
            circle_mm: None,
            ..heat
        };
        assert!(svg(&empty.scene()).ends_with("</svg>"));
    }
}
