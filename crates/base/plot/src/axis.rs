//! Axes: round tick values on linear and logarithmic scales.

use crate::color::Ink;
use crate::font;
use crate::number::{fixed, short};
use crate::scene::{Anchor, SMALL, Scene};

/// Approximate distance between the tick texts of a vertical axis, px.
const LEFT_GAP: f64 = 26.0;

/// Maps a range of values to a range of pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    range: [f64; 2],
    pixels: [f64; 2],
    logarithmic: bool,
}

impl Axis {
    /// Maps `range` linearly to `pixels`. A range of length zero is widened, so that every axis can
    /// be drawn.
    pub(crate) fn linear(range: [f64; 2], pixels: [f64; 2]) -> Self {
        Axis {
            range: widen(range),
            pixels,
            logarithmic: false,
        }
    }

    /// Like [`Axis::linear`], but maps the logarithm; only positive numbers have a pixel.
    pub(crate) fn logarithmic(range: [f64; 2], pixels: [f64; 2]) -> Self {
        let [low, high] = range;
        let range = if low > 0.0 && high.is_finite() {
            if high > low {
                [low, high]
            } else {
                [low / 2.0, low * 2.0]
            }
        } else {
            [0.1, 10.0]
        };
        Axis {
            range,
            pixels,
            logarithmic: true,
        }
    }

    /// The pixel of a value; NaN if the value has none.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        let fraction = if self.logarithmic {
            (value / low).ln() / (high / low).ln()
        } else {
            (value - low) / (high - low)
        };
        self.pixels[0] + fraction * (self.pixels[1] - self.pixels[0])
    }

    /// Round values within the range with their texts, at least `gap_px` apart on average.
    pub(crate) fn ticks(&self, gap_px: f64) -> Vec<(f64, String)> {
        let length = (self.pixels[1] - self.pixels[0]).abs();
        let most = (length / gap_px).max(2.0);
        if self.logarithmic {
            let ticks = decades(self.range, most);
            // The range is short compared with a decade.
            if ticks.len() < 2 {
                round_values(self.range, most)
            } else {
                ticks
            }
        } else {
            round_values(self.range, most)
        }
    }

    /// Draws horizontal grid lines, and tick texts on the left of the box `[left, right]`.
    pub(crate) fn draw_left(&self, scene: &mut Scene, left: f64, right: f64) {
        for (value, text) in self.ticks(LEFT_GAP) {
            let y = self.place(value);
            scene.line([[left, y], [right, y]], Ink::Grid, 1.0);
            scene.small([left - 6.0, y + 0.35 * SMALL], text, Ink::Muted, Anchor::End);
        }
    }

    /// Width of the tick texts that [`draw_left`](Self::draw_left) draws, px.
    pub(crate) fn left_room(&self) -> f64 {
        let ticks = self.ticks(LEFT_GAP);
        font::widest(ticks.iter().map(|(_, text)| text.as_str()), SMALL) + 6.0
    }

    /// Draws tick texts below `bottom`, and grid lines up to `top`.
    pub(crate) fn draw_below(&self, scene: &mut Scene, top: f64, bottom: f64) {
        for (value, text) in self.ticks(56.0) {
            let x = self.place(value);
            scene.line([[x, top], [x, bottom]], Ink::Grid, 1.0);
            scene.centred([x, bottom + 5.0 + SMALL], &text, Ink::Muted);
        }
    }
}

/// The smallest range that contains all finite values; `None` if there are none.
pub fn extent(values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
    values
        .into_iter()
        .filter(|value| value.is_finite())
        .fold(None, |range, value| {
            let [low, high] = range.unwrap_or([value, value]);
            Some([low.min(value), high.max(value)])
        })
}

/// The range with a margin of `fraction` of its length at both ends.
pub fn padded([low, high]: [f64; 2], fraction: f64) -> [f64; 2] {
    let margin = fraction * (high - low);
    [low - margin, high + margin]
}

fn widen([low, high]: [f64; 2]) -> [f64; 2] {
    if !(low.is_finite() && high.is_finite()) {
        [0.0, 1.0]
    } else if high - low > 1e-12 * low.abs().max(high.abs()).max(1e-290) {
        [low, high]
    } else {
        let half = if low == 0.0 { 0.5 } else { 0.1 * low.abs() };
        [low - half, high + half]
    }
}

/// Multiples of the smallest round step that gives at most `most` intervals, or of the next one
/// with two values.
fn round_values([low, high]: [f64; 2], most: f64) -> Vec<(f64, String)> {
    let rough = (high - low) / most;
    let power = 10f64.powf(rough.log10().floor());
    let bounds = |step: f64| ((low / step - 1e-6).ceil(), (high / step + 1e-6).floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|head| head * power);
    let coarse = steps
        .into_iter()
        .find(|&step| step >= rough * 0.999)
        .unwrap_or(10.0 * power);
    let finer = [1.0, 0.5, 0.4, 0.2]
        .map(|part| part * coarse)
        .into_iter()
        .filter(|&step| is_round(step));
    let step = finer
        .clone()
        .find(|&step| bounds(step).1 > bounds(step).0)
        .unwrap_or(coarse);
    let decimals = (-(step * 1.001).log10().floor()).clamp(0.0, 9.0) as usize;
    let (first, last) = bounds(step);
    let count = (last - first).clamp(0.0, 1000.0) as usize;
    (0..=count)
        .map(|index| (first + index as f64) * step)
        .map(|value| (value, fixed(value, decimals)))
        .collect()
}

/// Whether a step is 1, 2 or 5 times a power of ten.
fn is_round(step: f64) -> bool {
    let head = step / 10f64.powf((step * 1.001).log10().floor());
    [1.0, 2.0, 5.0]
        .into_iter()
        .any(|round| (head - round).abs() < 0.01)
}

fn decades([low, high]: [f64; 2], most: f64) -> Vec<(f64, String)> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let powers = (high / low).log10();
    let heads: &[f64] = if powers < 1.2 && most >= 4.0 {
        &[1.0, 2.0, 3.0, 5.0, 7.0]
    } else {
        &[1.0]
    };
    let heads = if powers < 2.2 && heads.len() == 1 {
        &[1.0, 3.0][..]
    } else {
        heads
    };
    let skip = ((powers / most).ceil() as i32).max(1);
    (first..=last)
        .filter(|power| power.rem_euclid(skip) == 0)
        .flat_map(|power| heads.iter().map(move |head| head * 10f64.powi(power)))
        .filter(|value| *value >= low * 0.999 && *value <= high * 1.001)
        .map(|value| (value, short(value)))
        .collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn texts(axis: Axis, gap_px: f64) -> Vec<String> {
        axis.ticks(gap_px).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(
            texts(Axis::linear([0.0, 1.0], [0.0, 300.0]), 60.0),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(texts(Axis::linear([-3.0, 9.0], [0.0, 150.0]), 50.0), ["0", "5"]);
        assert_eq!(
            texts(Axis::logarithmic([0.01, 100.0], [0.0, 400.0]), 60.0),
            ["0.01", "0.1", "1", "10", "100"]
        );
    }

    proptest! {
        #[test]
        fn any_range_has_a_few_ticks_inside(low in -1e6..1e6f64, length in 0.0..1e6f64) {
            let axis = Axis::linear([low, low + length], [0.0, 200.0]);
            let ticks = axis.ticks(40.0);
            prop_assert!((1..=7).contains(&ticks.len()), "{} ticks", ticks.len());
            prop_assert!(ticks.iter().all(|(value, _)| (-0.5..=200.5).contains(&axis.place(*value))));
        }
    }

    proptest! {
        #[test]
        fn any_logarithmic_range_has_two_ticks_inside(power in -9.0..6.0f64, ratio in 1.01..1e6f64) {
            let low = 10f64.powf(power);
            let axis = Axis::logarithmic([low, low * ratio], [0.0, 200.0]);
            let ticks = axis.ticks(LEFT_GAP);
            prop_assert!(ticks.len() >= 2, "{} ticks", ticks.len());
            prop_assert!(ticks.iter().all(|(value, _)| (-0.5..=200.5).contains(&axis.place(*value))));
        }
    }

    #[test]
    fn a_range_without_numbers_can_still_be_drawn() {
        for range in [
            [f64::NAN, f64::NAN],
            [f64::INFINITY, f64::NEG_INFINITY],
            [0.0, 0.0],
            [3.0, 3.0],
        ] {
            assert!(!Axis::linear(range, [0.0, 100.0]).ticks(30.0).is_empty());
            assert!(!Axis::logarithmic(range, [0.0, 100.0]).ticks(30.0).is_empty());
        }
        assert_eq!(extent([f64::NAN, 2.0, -1.0]), Some([-1.0, 2.0]));
        assert_eq!(extent([f64::NAN]), None);
    }
}
