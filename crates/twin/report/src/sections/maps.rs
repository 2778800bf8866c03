//! Pressure maps at the peak of a press, of sensor and twin.

use digitac::PressEvaluation;
use twintac_map::{MapSettings, Rectangle, pitch_mm, pressure_map};
use twintac_plot::page::Block;
use twintac_plot::{HeatMap, HeatMaps, fixed};
use twintac_sensor::Sensor;

use super::parts::{explained, figure, taxels_mm, three};
use crate::TwinReport;

/// Radius of the circle that marks the indenter's place, mm.
const MARK_MM: f64 = 1.0;

pub(super) fn blocks(report: &TwinReport<'_>) -> Vec<Block> {
    let shown = three(report.evaluation).into_iter();
    let maps = shown.filter_map(|(label, (press, _))| peak(label, press, report.sensor));
    let caption = "Sensor and twin at the peak of the press.";
    let pictures = maps.map(|maps| figure(maps.scene(), report.provenance, caption));
    explained(
        "Pressure over the gel, interpolated between the taxels (dots) by Gaussian radial basis functions that \
         meet each reading. Sensor and twin share a colour scale; a dashed circle is around the press.",
        pictures.collect(),
    )
}

/// A map that cannot be drawn (two taxels at one place) is left out.
fn peak(label: &str, press: &PressEvaluation, sensor: &Sensor) -> Option<HeatMaps> {
    let total = |frame: &usize| press.measured_kpa[*frame].iter().sum::<f64>();
    let frames = (0..press.time_s.len()).filter(|frame| total(frame).is_finite());
    let frame = frames.max_by(|a, b| total(a).total_cmp(&total(b)))?;
    let (measured, predicted) = (&press.measured_kpa[frame], &press.predicted_kpa[frame]);
    let depth_mm = fixed(press.depth_mm[frame], 2);
    let title = format!("{label}: {}, {depth_mm} mm deep", press.name);
    pressure_maps(
        sensor,
        title,
        &[("sensor", measured), ("twin", predicted)],
        Some((press.place_mm, MARK_MM)),
    )
}

/// Maps of readings above the baseline, kPa, each with its name, with one colour scale.
/// `circle_mm`: centre and radius of a circle to mark. `None` if the maps cannot be drawn, because
/// two taxels are at one location.
#[must_use]
pub fn pressure_maps(
    sensor: &Sensor,
    title: String,
    readings_kpa: &[(&str, &[f64])],
    circle_mm: Option<([f64; 2], f64)>,
) -> Option<HeatMaps> {
    let taxels_mm = taxels_mm(sensor);
    let (rectangle, baseline) = (window(sensor), vec![0.0; taxels_mm.len()]);
    let settings = settings(rectangle, &taxels_mm);
    let map = |(name, readings): &(&str, &[f64])| {
        let map = pressure_map(&taxels_mm, readings, &baseline, rectangle, &settings).ok()?;
        Some(HeatMap {
            name: (*name).into(),
            min_mm: rectangle.min_mm,
            max_mm: rectangle.max_mm,
            grid: map.grid,
            values: map.pressure_kpa,
        })
    };
    Some(HeatMaps {
        title,
        maps: readings_kpa.iter().map(map).collect::<Option<_>>()?,
        unit: "kPa".into(),
        marks_mm: taxels_mm,
        circle_mm,
    })
}

/// The part of the gel around the taxels, because a long strip would be too small if shown whole.
fn window(sensor: &Sensor) -> Rectangle {
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let (margin_mm, taxels_mm) = (high.z, taxels_mm(sensor));
    let side = |axis: usize, low: f64, high: f64| {
        let places = taxels_mm.iter().map(|taxel| taxel[axis]);
        let (from, to) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(from, to), x| {
            (from.min(x), to.max(x))
        });
        [(from - margin_mm).max(low), (to + margin_mm).min(high)]
    };
    let ([x0, x1], [y0, y1]) = (side(0, low.x, high.x), side(1, low.y, high.y));
    Rectangle {
        min_mm: [x0, y0],
        max_mm: [x1, y1],
    }
}

/// Square cells, about 6000 in all.
fn settings(rectangle: Rectangle, taxels_mm: &[[f64; 2]]) -> MapSettings {
    let [width, height] = [0, 1].map(|axis| rectangle.max_mm[axis] - rectangle.min_mm[axis]);
    let aspect = (width / height).clamp(0.05, 20.0);
    let columns = (6000.0 * if aspect.is_nan() { 1.0 } else { aspect })
        .sqrt()
        .ceil();
    let rows = (6000.0 / columns).ceil();
    MapSettings {
        grid: [columns as usize, rows as usize],
        width_mm: Some(0.5 * pitch_mm(taxels_mm)), // the same for sensor and twin
        ..MapSettings::default()
    }
}
