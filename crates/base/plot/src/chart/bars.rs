//! Horizontal bars with their values, and whiskers for uncertainty.

use super::{BELOW, RIGHT, WIDTH_PX};
use crate::axis::{Axis, extent};
use crate::color::Ink;
use crate::font::{fitted, widest};
use crate::scene::{Anchor, SMALL, Scene};

/// One bar.
#[derive(Clone, Debug)]
pub struct Bar {
    /// Name on the left.
    pub name: String,
    /// Length in the unit of the axis; for NaN a dash is shown.
    pub value: f64,
    /// Half the length of the whisker, if there is one.
    pub uncertainty: Option<f64>,
    /// The value as text.
    pub text: String,
    /// Colour.
    pub ink: Ink,
}

/// Bars from zero, one below another.
#[derive(Clone, Debug, Default)]
pub struct Bars {
    /// Title.
    pub title: String,
    /// Quantity and unit.
    pub x_label: String,
    /// From top to bottom.
    pub bars: Vec<Bar>,
}

impl Bars {
    /// Draws the bars, 380 px wide.
    pub fn scene(&self) -> Scene {
        const ROW: f64 = 24.0;
        const LONGEST_NAME: f64 = 170.0;
        const LONGEST_VALUE: f64 = 100.0;
        let names = widest(self.bars.iter().map(|bar| bar.name.as_str()), SMALL).min(LONGEST_NAME);
        let values = widest(self.bars.iter().map(|bar| bar.text.as_str()), SMALL).min(LONGEST_VALUE);
        let (left, right) = (names + 8.0, WIDTH_PX - RIGHT - values - 8.0);
        let mut scene = Scene::new(&self.title, WIDTH_PX, 0.0);
        let top = scene.heading(&self.title) + 6.0;
        let bottom = top + ROW * self.bars.len() as f64;
        scene.height = bottom + BELOW;

        let ends = self.bars.iter().flat_map(|bar| {
            let half = bar.uncertainty.unwrap_or(0.0);
            [bar.value, bar.value - half, bar.value + half]
        });
        let [low, high] = extent(ends.chain([0.0])).unwrap_or([0.0, 1.0]);
        let axis = Axis::linear([low.min(0.0), if high > low { high } else { 1.0 }], [left, right]);
        axis.draw_below(&mut scene, top, bottom);
        for (index, bar) in self.bars.iter().enumerate() {
            let y = top + ROW * index as f64;
            let middle = y + 0.5 * ROW;
            let (zero, end) = (axis.place(0.0), axis.place(bar.value));
            scene.rectangle(
                [zero.min(end), y + 4.0],
                [(end - zero).abs(), ROW - 8.0],
                bar.ink,
                1.0,
            );
            let mut text_at = zero.max(if end.is_finite() { end } else { zero });
            if let Some(half) = bar.uncertainty.filter(|half| half.is_finite()) {
                let (from, to) = (axis.place(bar.value - half), axis.place(bar.value + half));
                scene.line([[from, middle], [to, middle]], Ink::Text, 1.25);
                for x in [from, to] {
                    scene.line([[x, middle - 4.0], [x, middle + 4.0]], Ink::Text, 1.25);
                }
                text_at = text_at.max(to);
            }
            let baseline = middle + 0.35 * SMALL;
            scene.small(
                [left - 8.0, baseline],
                fitted(&bar.name, SMALL, LONGEST_NAME),
                Ink::Text,
                Anchor::End,
            );
            let value = fitted(&bar.text, SMALL, LONGEST_VALUE);
            scene.small([text_at + 6.0, baseline], value, Ink::Text, Anchor::Start);
        }
        scene.line(
            [[axis.place(0.0), top], [axis.place(0.0), bottom]],
            Ink::Muted,
            1.0,
        );
        let middle = [0.5 * (left + right), bottom + BELOW - 6.0];
        scene.centred(middle, &self.x_label, Ink::Muted);
        scene
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg;

    #[test]
    fn bars_without_numbers_keep_their_names() {
        let bar = |value| Bar {
            name: "long name ".repeat(9),
            value,
            uncertainty: Some(f64::NAN),
            text: "–".into(),
            ink: Ink::Twin,
        };
        let bars = Bars {
            bars: vec![bar(f64::NAN), bar(f64::INFINITY), bar(-1.0)],
            ..Bars::default()
        };
        let text = svg(&bars.scene());
        assert!(
            text.contains("long name")
                && text.contains('…')
                && !text.contains("NaN")
                && !text.contains("inf")
        );
        assert!(svg(&Bars::default().scene()).starts_with("<svg"));
    }
}
