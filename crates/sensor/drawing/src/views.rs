//! A sensor from above and in section.

use glam::DVec3;
use twintac_plot::fixed;
use twintac_sensor::Sensor;

use crate::sheet::{Dimension, Outline, Part, Shape, View};

/// Thickness of the shell's wall in the drawing, mm. Descriptions do not contain it.
const WALL_MM: f64 = 1.5;

/// Thickness of the board in the drawing, mm.
const BOARD_MM: f64 = 1.2;

/// Number of points along a gel's profile.
const PROFILE_POINTS: usize = 80;

fn bounds(sensor: &Sensor) -> (DVec3, DVec3) {
    sensor.gel.solid.bounds_mm(&sensor.surfaces)
}

fn shape(part: Part, outline: Outline) -> Shape {
    Shape {
        part,
        outline,
        name: None,
    }
}

fn rectangle(min_mm: [f64; 2], max_mm: [f64; 2]) -> Outline {
    Outline::Rectangle { min_mm, max_mm }
}

pub(crate) fn top(sensor: &Sensor) -> View {
    let (low, high) = bounds(sensor);
    let grown = |by: f64| rectangle([low.x - by, low.y - by], [high.x + by, high.y + by]);
    let mut shapes = Vec::new();
    if let Some(shell) = &sensor.shell {
        shapes.push(shape(Part::Shell, grown(shell.gap_mm + WALL_MM)));
        shapes.push(shape(Part::Board, grown(shell.gap_mm)));
    }
    shapes.push(shape(Part::Gel, grown(0.0)));
    for chip in &sensor.inclusions {
        shapes.push(shape(
            Part::Chip,
            rectangle([chip.min_mm.x, chip.min_mm.y], [chip.max_mm.x, chip.max_mm.y]),
        ));
    }
    for taxel in &sensor.taxels {
        let centre_mm = [taxel.position_mm.x, taxel.position_mm.y];
        let outline = Outline::Circle {
            centre_mm,
            radius_mm: taxel.port_radius_mm,
        };
        shapes.push(Shape {
            part: Part::Port,
            outline,
            name: Some(taxel.name.clone()),
        });
    }
    let mut dimensions = vec![
        Dimension {
            from_mm: [low.x, low.y],
            to_mm: [high.x, low.y],
        },
        Dimension {
            from_mm: [low.x, low.y],
            to_mm: [low.x, high.y],
        },
    ];
    if let [first, second, ..] = &sensor.taxels[..] {
        let (a, b) = (first.position_mm, second.position_mm);
        dimensions.push(if (a.x - b.x).abs() > (a.y - b.y).abs() {
            Dimension {
                from_mm: [a.x, a.y],
                to_mm: [b.x, a.y],
            }
        } else {
            Dimension {
                from_mm: [a.x, a.y],
                to_mm: [a.x, b.y],
            }
        });
    }
    View {
        name: "top".into(),
        shapes,
        dimensions,
    }
}

pub(crate) fn section(sensor: &Sensor) -> View {
    let (low, high) = bounds(sensor);
    let middle = 0.5 * (low + high).truncate();
    let nearest = sensor.taxels.iter().min_by(|a, b| {
        let distance = |taxel: &twintac_sensor::Taxel| taxel.position_mm.truncate().distance(middle);
        distance(a).total_cmp(&distance(b))
    });
    let y_mm = nearest.map_or(middle.y, |taxel| taxel.position_mm.y);
    let gap_mm = sensor.shell.as_ref().map_or(0.0, |shell| shell.gap_mm);
    let mut shapes = vec![shape(
        Part::Board,
        rectangle([low.x - gap_mm, -BOARD_MM], [high.x + gap_mm, 0.0]),
    )];
    if let Some(shell) = &sensor.shell {
        for (from_mm, to_mm) in [
            (low.x - gap_mm - WALL_MM, low.x - gap_mm),
            (high.x + gap_mm, high.x + gap_mm + WALL_MM),
        ] {
            shapes.push(shape(
                Part::Shell,
                rectangle([from_mm, -BOARD_MM], [to_mm, shell.height_mm]),
            ));
        }
    }
    shapes.push(shape(Part::Gel, profile(sensor, y_mm)));
    for chip in sensor
        .inclusions
        .iter()
        .filter(|chip| (chip.min_mm.y..=chip.max_mm.y).contains(&y_mm))
    {
        shapes.push(shape(
            Part::Chip,
            rectangle([chip.min_mm.x, 0.0], [chip.max_mm.x, chip.max_mm.z]),
        ));
    }
    for taxel in sensor
        .taxels
        .iter()
        .filter(|taxel| (taxel.position_mm.y - y_mm).abs() < 1.0)
    {
        let (x, z, r) = (taxel.position_mm.x, taxel.position_mm.z, taxel.port_radius_mm);
        let outline = rectangle([x - r, z - 0.15], [x + r, z + 0.15]);
        shapes.push(Shape {
            part: Part::Port,
            outline,
            name: Some(taxel.name.clone()),
        });
    }
    let dimensions = vec![Dimension {
        from_mm: [low.x, 0.0],
        to_mm: [low.x, high.z],
    }];
    View {
        name: format!("section at y = {} mm", fixed(y_mm, 1)),
        shapes,
        dimensions,
    }
}

/// The section of the gel at `y_mm`, as a closed line from the board over the top.
fn profile(sensor: &Sensor, y_mm: f64) -> Outline {
    let (low, high) = bounds(sensor);
    let x_mm = |i: usize| {
        // Slightly inside, so that the outermost points belong to the gel.
        let fraction = (i as f64 / PROFILE_POINTS as f64).clamp(1e-6, 1.0 - 1e-6);
        low.x + (high.x - low.x) * fraction
    };
    let height = |x_mm: f64| {
        sensor
            .gel
            .solid
            .top_height_mm(x_mm, y_mm, &sensor.surfaces)
            .map(|height_mm| [x_mm, height_mm])
    };
    let mut points_mm: Vec<[f64; 2]> = (0..=PROFILE_POINTS).filter_map(|i| height(x_mm(i))).collect();
    if let (Some(first), Some(last)) = (points_mm.first().copied(), points_mm.last().copied()) {
        points_mm.push([last[0], 0.0]);
        points_mm.push([first[0], 0.0]);
    }
    Outline::Polygon { points_mm }
}
