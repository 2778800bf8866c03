//! Plots of the verification tests.

use twintac_plot::{Ink, Scene};
use twintac_plot::{Panel, Panels, Series};

/// A line in the nth colour.
pub(crate) fn line(name: impl Into<String>, color: usize, points: Vec<[f64; 2]>) -> Series {
    Series {
        name: name.into(),
        points,
        ink: Ink::Series(color),
        width_px: 1.75,
        dashed: false,
    }
}

/// A dashed line in the nth colour.
pub(crate) fn dashes(name: impl Into<String>, color: usize, points: Vec<[f64; 2]>) -> Series {
    Series {
        dashed: true,
        ..line(name, color, points)
    }
}

/// Lines in a frame, with a logarithmic vertical axis if requested.
pub(crate) fn lines(
    title: &str,
    [x_label, y_label]: [&str; 2],
    logarithmic: bool,
    series: Vec<Series>,
) -> Scene {
    let panel = Panel {
        y_label: y_label.into(),
        series,
        ..Panel::default()
    };
    Panels {
        title: title.into(),
        x_label: x_label.into(),
        panels: vec![panel],
        panel_height_px: 190.0,
        logarithmic,
    }
    .scene()
}

/// A histogram of values, as steps.
pub(crate) fn histogram(name: &str, color: usize, values: &[f64], range: [f64; 2], n_bins: usize) -> Series {
    let [low, high] = range;
    let mut counts = vec![0_u32; n_bins];
    for value in values {
        let bin = (value - low) / (high - low) * n_bins as f64;
        counts[(bin.max(0.0) as usize).min(n_bins - 1)] += 1;
    }
    let edge = |bin: usize| low + (high - low) * bin as f64 / n_bins as f64;
    let mut points = vec![[low, 0.0]];
    for (bin, count) in counts.into_iter().enumerate() {
        points.extend([edge(bin), edge(bin + 1)].map(|x| [x, f64::from(count)]));
    }
    points.push([high, 0.0]);
    line(name, color, points)
}
