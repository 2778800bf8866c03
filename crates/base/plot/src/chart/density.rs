//! Two quantities that should agree, as a density: the logarithm of the number of readings in each
//! cell.

use super::{BELOW, LABEL, RIGHT, WIDTH_PX};
use crate::axis::{Axis, extent, padded};
use crate::color::{Ink, viridis};
use crate::font::text_width;
use crate::scene::{Anchor, Mark, SMALL, Scene};

/// Number of cells along each axis.
const CELLS: usize = 72;

/// Pairs of numbers, which lie on the diagonal if they agree.
#[derive(Clone, Debug, Default)]
pub struct Density {
    /// Title.
    pub title: String,
    /// Quantity and unit of the horizontal axis.
    pub x_label: String,
    /// Quantity and unit of the vertical axis.
    pub y_label: String,
    /// Pairs of x and y in one unit.
    pub points: Vec<[f64; 2]>,
}

impl Density {
    /// Draws the pairs, with the diagonal of agreement.
    pub fn scene(&self) -> Scene {
        let range = extent(self.points.iter().flatten().copied()).unwrap_or([0.0, 1.0]);
        let range = padded(range, 0.02);
        let mut scene = Scene::new(&self.title, WIDTH_PX, 0.0);
        let key = scene.heading(&self.title) + 6.0;
        let right = WIDTH_PX - RIGHT;
        let left = LABEL + Axis::linear(range, [0.0, right]).left_room();
        let (top, bottom) = (key + 28.0, key + 28.0 + right - left);
        scene.height = bottom + BELOW;
        let (x_axis, y_axis) = (
            Axis::linear(range, [left, right]),
            Axis::linear(range, [bottom, top]),
        );
        x_axis.draw_below(&mut scene, top, bottom);
        y_axis.draw_left(&mut scene, left, right);

        let size = (right - left) / CELLS as f64;
        let cell =
            |pixel: f64, start: f64| ((pixel - start) / size).floor().clamp(0.0, (CELLS - 1) as f64) as usize;
        let mut counts = vec![0u32; CELLS * CELLS];
        for &[x, y] in self.points.iter().filter(|[x, y]| x.is_finite() && y.is_finite()) {
            counts[cell(y_axis.place(y), top) * CELLS + cell(x_axis.place(x), left)] += 1;
        }
        let most = f64::from(counts.iter().copied().max().unwrap_or(0).max(1));
        let shade = |count: f64| viridis(0.92 * (count.ln() / most.ln().max(1e-9)).clamp(0.0, 1.0));
        for (index, &count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let at = [
                left + (index % CELLS) as f64 * size,
                top + (index / CELLS) as f64 * size,
            ];
            scene.rectangle(at, [size, size], Ink::Rgb(shade(f64::from(count))), 1.0);
        }
        let diagonal = [range[0], range[1]].map(|value| [x_axis.place(value), y_axis.place(value)]);
        scene.dashes(diagonal, Ink::Text, 1.0);
        draw_key(&mut scene, [left, key], most, shade);
        let middle = [0.5 * (left + right), scene.height - 6.0];
        scene.centred(middle, &self.x_label, Ink::Muted);
        scene.upwards([12.0, 0.5 * (top + bottom)], &self.y_label);
        scene
    }
}

/// Draws the key from `at` to the right: the number of readings of each shade, and what the dashed
/// line is.
fn draw_key(scene: &mut Scene, [left, y]: [f64; 2], most: f64, shade: impl Fn(f64) -> [u8; 3]) {
    const STEPS: usize = 48;
    const WIDTH: f64 = 80.0;
    let mut x = left;
    let words = |scene: &mut Scene, x: &mut f64, text: &str| {
        scene.small([*x, y + 9.0], text, Ink::Muted, Anchor::Start);
        *x += text_width(text, SMALL) + 6.0;
    };
    words(scene, &mut x, "readings: 1");
    let pixels = (0..STEPS)
        .map(|step| shade(most.powf(step as f64 / (STEPS - 1) as f64)))
        .collect();
    scene.marks.push(Mark::Image {
        at: [x, y],
        size: [WIDTH, 10.0],
        columns: STEPS,
        pixels,
    });
    x += WIDTH + 6.0;
    words(scene, &mut x, &format!("{most:.0}"));
    x += 14.0;
    scene.dashes([[x, y + 5.0], [x + 20.0, y + 5.0]], Ink::Text, 1.0);
    x += 26.0;
    words(scene, &mut x, "agreement");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg;

    #[test]
    fn cells_hold_every_finite_pair_and_nothing_else() {
        let points = vec![[0.0, 0.0], [10.0, 10.0], [10.0, 0.0], [f64::NAN, 1.0]];
        let full = Density {
            points,
            ..Density::default()
        };
        let cells = |density: &Density| {
            let is_cell = |mark: &&Mark| matches!(mark, Mark::Area { ink: Ink::Rgb(_), .. });
            density.scene().marks.iter().filter(is_cell).count()
        };
        assert_eq!(cells(&full), 3);
        assert_eq!(cells(&Density::default()), 0);
        assert!(!svg(&full.scene()).contains("NaN"));
    }
}
