//! Sections of pictures: presses over time, maps at the peak, errors over places.

use twintac_map::{MapSettings, pitch_mm, pressure_map};
use twintac_plot::page::{Block, Figure, Section};
use twintac_plot::{HeatMap, HeatMaps, Ink, Panel, Panels, Places, Series, extent, padded};

use super::{figure, percent, section};
use crate::data::{PressPeak, PressSeries, ReportData};

/// Twin and sensor over time.
pub(super) fn presses(data: &ReportData) -> Section {
    let pictures: Vec<Figure> = data
        .presses
        .iter()
        .map(|press| {
            let error = percent(press.nearest_in_contact_percent);
            let caption = format!("{}: error {error}, nearest taxel in contact.", press.name);
            figure(press_panels(press).scene(), data.provenance.badge(), caption)
        })
        .collect();
    section(
        "presses",
        "Presses over time",
        explained(
            "Pressure above the baseline at every taxel. Where the thin line covers the broad one, the twin is right. \
             All taxels of a press share one scale.",
            pictures,
        ),
    )
}

fn press_panels(press: &PressSeries) -> Panels {
    let over_time = |values: &[f64]| {
        press
            .time_s
            .iter()
            .zip(values)
            .map(|(&time, &value)| [time, value])
            .collect()
    };
    let taxel_values = |frames: &[Vec<f64>], taxel: usize| -> Vec<f64> {
        frames
            .iter()
            .map(|frame| frame.get(taxel).copied().unwrap_or(f64::NAN))
            .collect()
    };
    let readings = press.sensor_kpa.iter().chain(&press.twin_kpa).flatten().copied();
    let y_range = extent(readings).map(|range| padded(range, 0.06));
    let sensor = |points| line("sensor", points, Ink::Sensor, 4.0);
    let twin = |points| line("twin", points, Ink::Twin, 1.5);

    let mut panels: Vec<Panel> = press
        .taxels
        .iter()
        .enumerate()
        .map(|(taxel, name)| Panel {
            name: name.clone(),
            y_label: "kPa".into(),
            series: vec![
                sensor(over_time(&taxel_values(&press.sensor_kpa, taxel))),
                twin(over_time(&taxel_values(&press.twin_kpa, taxel))),
            ],
            y_range,
        })
        .collect();
    if !(press.sensor_force_n.is_empty() && press.twin_force_n.is_empty()) {
        let series = vec![
            sensor(over_time(&press.sensor_force_n)),
            twin(over_time(&press.twin_force_n)),
        ];
        let series = series
            .into_iter()
            .filter(|series| !series.points.is_empty())
            .collect();
        panels.push(Panel {
            name: "force".into(),
            y_label: "N".into(),
            series,
            y_range: None,
        });
    }
    if !press.depth_mm.is_empty() {
        let series = vec![line("", over_time(&press.depth_mm), Ink::Series(0), 1.5)];
        panels.push(Panel {
            name: "depth".into(),
            y_label: "mm".into(),
            series,
            y_range: None,
        });
    }
    let label = match press.label.as_str() {
        "" => press.name.clone(),
        label => format!(
            "{}{} press",
            label[..first_letter(label)].to_uppercase(),
            &label[first_letter(label)..]
        ),
    };
    let panel_height_px = if panels.len() > 6 { 52.0 } else { 68.0 };
    Panels {
        title: label,
        x_label: "time, s".into(),
        panels,
        panel_height_px,
        logarithmic: false,
    }
}

fn first_letter(text: &str) -> usize {
    text.chars().next().map_or(0, char::len_utf8)
}

fn line(name: &str, points: Vec<[f64; 2]>, ink: Ink, width_px: f64) -> Series {
    Series {
        name: name.into(),
        points,
        ink,
        width_px,
        dashed: false,
    }
}

/// Pressure maps, sensor beside twin.
pub(super) fn peaks(data: &ReportData) -> Section {
    let pictures: Vec<Figure> = data
        .peaks
        .iter()
        .filter_map(|peak| {
            let chart = peak_maps(peak)?;
            Some(figure(
                chart.scene(),
                data.provenance.badge(),
                "Sensor and twin at the peak of the press.",
            ))
        })
        .collect();
    section(
        "maps",
        "Pressure maps",
        explained(
            "Pressure over the gel, interpolated between the taxels (dots) by Gaussian radial basis functions that \
             meet each reading. Sensor and twin share a colour scale; a dashed circle is the indenter.",
            pictures,
        ),
    )
}

fn peak_maps(peak: &PressPeak) -> Option<HeatMaps> {
    let baseline = vec![0.0; peak.taxels_mm.len()];
    let settings = map_settings(peak);
    let map = |name: &str, readings: &[f64]| {
        // A map that cannot be drawn (readings missing, two taxels at one place) is left out.
        let map = pressure_map(&peak.taxels_mm, readings, &baseline, peak.gel_mm, &settings).ok()?;
        Some(HeatMap {
            name: name.into(),
            min_mm: map.rectangle.min_mm,
            max_mm: map.rectangle.max_mm,
            grid: map.grid,
            values: map.pressure_kpa,
        })
    };
    let maps = vec![map("sensor", &peak.sensor_kpa)?, map("twin", &peak.twin_kpa)?];
    Some(HeatMaps {
        title: peak.name.clone(),
        maps,
        unit: "kPa".into(),
        marks_mm: peak.taxels_mm.clone(),
        circle_mm: peak.indenter_mm,
    })
}

/// Square cells, about 6000 in all.
fn map_settings(peak: &PressPeak) -> MapSettings {
    let [width, height] = [0, 1].map(|axis| peak.gel_mm.max_mm[axis] - peak.gel_mm.min_mm[axis]);
    let aspect = (width / height).clamp(0.05, 20.0);
    let columns = (6000.0 * if aspect.is_nan() { 1.0 } else { aspect })
        .sqrt()
        .ceil();
    let rows = (6000.0 / columns).ceil();
    MapSettings {
        grid: [columns as usize, rows as usize],
        width_mm: Some(0.5 * pitch_mm(&peak.taxels_mm)), // the same for sensor and twin
        ..MapSettings::default()
    }
}

/// Pictures with what they show; nothing without pictures.
fn explained(text: &str, pictures: Vec<Figure>) -> Vec<Block> {
    if pictures.is_empty() {
        Vec::new()
    } else {
        vec![Block::Text(text.into()), Block::Figures(pictures)]
    }
}

/// Errors over the places of static presses.
pub(super) fn places(data: &ReportData) -> Section {
    let Some(errors) = &data.places else {
        return Section::default();
    };
    let chart = |title: &str, values: &[f64]| Places {
        title: title.into(),
        unit: "%".into(),
        places_mm: errors.places_mm.clone(),
        values: values.to_vec(),
        marks_mm: errors.taxels_mm.clone(),
    };
    let mut pictures = Vec::new();
    for (title, values) in [
        ("Error, nearest taxel", &errors.nearest_percent),
        ("Error, all taxels", &errors.all_percent),
    ] {
        if !values.is_empty() {
            let caption = "Absolute error of each held-out press where it was made, % of the largest reading. \
                           Dots with a white rim are taxels; the scale ends at the 99th percentile.";
            pictures.push(figure(
                chart(title, values).scene(),
                data.provenance.badge(),
                caption,
            ));
        }
    }
    section("places", "Errors over the gel", vec![Block::Figures(pictures)])
}
