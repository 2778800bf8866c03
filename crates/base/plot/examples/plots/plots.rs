//! One plot of every kind, with labels that can be made long.

use twintac_plot::{Bar, Bars, Density, HeatMap, HeatMaps, Ink, Panel, Panels, Places, Scene, Series};

/// A label that is too long for every picture.
pub(crate) fn long(label: &str) -> String {
    format!(
        "{label} {}",
        "of the taxel that is nearest to the indenter ".repeat(3)
    )
}

/// Every kind of plot with its name; `label` makes the labels.
pub(crate) fn plots(label: fn(&str) -> String) -> Vec<(&'static str, Scene)> {
    vec![
        ("bars", bars(label).scene()),
        ("lines", lines(label, &[""]).scene()),
        (
            "panels",
            lines(label, &["sphere", "cylinder", "bar 0.49"]).scene(),
        ),
        ("density", density(label).scene()),
        ("maps", maps(label, [20.0, 24.0]).scene()),
        ("wide-maps", maps(label, [34.0, 18.0]).scene()),
        ("places", places(label).scene()),
    ]
}

fn bars(label: fn(&str) -> String) -> Bars {
    let bar = |(name, value, uncertainty, ink): (&str, f64, Option<f64>, Ink)| Bar {
        name: label(name),
        value,
        uncertainty,
        text: label(&format!("{value:.2} %")),
        ink,
    };
    let bars = [
        ("this twin", 1.27, None, Ink::Twin),
        ("static polynomial", 3.4, Some(0.6), Ink::Sensor),
        ("paper (its own sensor)", 5.95, None, Ink::Series(0)),
        ("pressure+memory+mlp", -0.8, Some(0.3), Ink::Series(2)),
    ];
    Bars {
        title: label("Error"),
        x_label: label("mean absolute error, % of the largest reading"),
        bars: bars.map(bar).to_vec(),
    }
}

fn lines(label: fn(&str) -> String, panels: &[&str]) -> Panels {
    let line = |name: &str, scale: f64, ink, dashed| Series {
        name: label(name),
        points: (0..200)
            .map(|step| f64::from(step) / 20.0)
            .map(|x| [x, scale * (x - 3.0).sin()])
            .collect(),
        ink,
        width_px: 2.0,
        dashed,
    };
    let panel = |(index, name): (usize, &&str)| Panel {
        name: if name.is_empty() {
            String::new()
        } else {
            label(name)
        },
        y_label: label(["pressure, kPa", "force, N"][index % 2]),
        series: vec![
            line("measured", 12_345.0, Ink::Sensor, false),
            line("predicted", 11_000.0, Ink::Twin, true),
        ],
        y_range: None,
    };
    Panels {
        title: label("Response over time"),
        x_label: label("time, s"),
        panels: panels.iter().enumerate().map(panel).collect(),
        panel_height_px: 90.0,
        logarithmic: false,
    }
}

fn density(label: fn(&str) -> String) -> Density {
    let point = |step: i32| {
        let x = f64::from(step % 977) / 4.0;
        [x, x + 6.0 * (f64::from(step) * 12.9898).sin()]
    };
    Density {
        title: label("Twin against sensor"),
        x_label: label("sensor, kPa"),
        y_label: label("twin, kPa"),
        points: (0..20_000).map(point).chain([[-1e5, -1e5]; 2]).collect(),
    }
}

fn maps(label: fn(&str) -> String, size_mm: [f64; 2]) -> HeatMaps {
    let max_mm = size_mm.map(|side| 0.5 * side);
    let map = |name: &str, scale: f64| HeatMap {
        name: label(name),
        min_mm: max_mm.map(|side| -side),
        max_mm,
        grid: [40, 40],
        values: (0..1600)
            .map(|cell| [f64::from(cell % 40) - 25.0, f64::from(cell / 40) - 15.0])
            .map(|[x, y]| scale * (-(x * x + y * y) / 90.0).exp())
            .collect(),
    };
    HeatMaps {
        title: label("Sphere, 2.2 mm deep"),
        maps: vec![map("sensor", 20_000.0), map("twin", 18_000.0)],
        unit: label("kPa"),
        marks_mm: vec![[-4.0, -4.0], [4.0, 4.0]],
        circle_mm: Some(([2.0, -2.0], 3.0)),
    }
}

fn places(label: fn(&str) -> String) -> Places {
    let places_mm: Vec<[f64; 2]> = (0..400)
        .map(|index| [1700.0 * f64::from(index % 20), f64::from(index / 20)])
        .collect();
    Places {
        title: label("Error over the gel"),
        unit: label("%"),
        values: (0..400).map(|index| 1000.0 * f64::from(index % 37)).collect(),
        places_mm,
        marks_mm: vec![[8000.0, 4.0], [16_000.0, 12.0]],
    }
}
