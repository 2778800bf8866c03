//! An environment as a picture: the readings, and the contact.

use glam::DVec2;
use twintac_fast::FastGel;
use twintac_map::{MapSettings, PreparedMap, Rectangle};
use twintac_plot::{Anchor, Ink, Mark, Scene, viridis};

use crate::TaskError;
use crate::task::Look;

/// Columns and rows of a picture's pixels.
pub const PICTURE_PX: [usize; 2] = [600, 240];

/// Size of both maps and of the margins around them, px.
const MAP_PX: [f64; 2] = [272.0, 144.0];
const LEFT_PX: [f64; 2] = [16.0, 312.0];
const TOP_PX: f64 = 34.0;
const LINE_PX: f64 = 15.0;

/// Columns and rows of the pressure map.
const GRID: [usize; 2] = [68, 36];

/// End of the colour scale, kPa, unless a reading is larger.
const FULL_KPA: f64 = 10.0;

/// Data that all pictures of a sensor share.
pub(crate) struct Shown {
    low_mm: DVec2,
    size_mm: DVec2,
    ports_mm: Vec<DVec2>,
    map: PreparedMap,
}

impl Shown {
    pub(crate) fn of(gel: &FastGel) -> Result<Self, TaskError> {
        let [low_mm, high_mm] = gel.bounds_mm();
        let ports_mm = gel.ports_mm().to_vec();
        let places: Vec<[f64; 2]> = ports_mm.iter().map(DVec2::to_array).collect();
        let rectangle = Rectangle {
            min_mm: low_mm.to_array(),
            max_mm: high_mm.to_array(),
        };
        let settings = MapSettings {
            grid: GRID,
            ..MapSettings::default()
        };
        Ok(Self {
            map: PreparedMap::new(&places, rectangle, &settings, &[])?,
            low_mm,
            size_mm: high_mm - low_mm,
            ports_mm,
        })
    }

    /// A position on the gel in one of both maps, px.
    fn at_px(&self, map: usize, at_mm: DVec2) -> [f64; 2] {
        let part = (at_mm - self.low_mm) / self.size_mm;
        [
            LEFT_PX[map] + part.x * MAP_PX[0],
            TOP_PX + (1.0 - part.y) * MAP_PX[1],
        ]
    }
}

/// Red, green and blue of each pixel, row by row from the top.
pub(crate) fn pixels(look: &Look, readings_kpa: &[f32], shown: &Shown) -> Result<Vec<u8>, TaskError> {
    let [width, height] = PICTURE_PX.map(|side| side as f64);
    let mut scene = Scene::new("What a sensor touches and reads", width, height);
    pressure(&mut scene, readings_kpa, shown)?;
    contact(&mut scene, look, shown);
    for (number, line) in look.lines.iter().enumerate() {
        let at = [LEFT_PX[1], TOP_PX + MAP_PX[1] + LINE_PX * (number as f64 + 1.2)];
        scene.small(at, line.as_str(), Ink::Text, Anchor::Start);
    }
    Ok(twintac_plot::pixels(&scene)?)
}

/// The map of the readings.
fn pressure(scene: &mut Scene, readings_kpa: &[f32], shown: &Shown) -> Result<(), TaskError> {
    let readings_kpa: Vec<f64> = readings_kpa.iter().map(|reading| f64::from(*reading)).collect();
    let most_kpa = readings_kpa
        .iter()
        .fold(FULL_KPA, |most, reading| most.max(*reading));
    let mut map_kpa = Vec::new();
    shown.map.fill(&readings_kpa, &mut map_kpa)?;
    let rows = map_kpa.chunks_exact(GRID[0]).rev();
    let pixels = rows
        .flatten()
        .map(|pressure_kpa| viridis(pressure_kpa / most_kpa))
        .collect();
    scene.small(
        [LEFT_PX[0], TOP_PX - 10.0],
        "readings of the taxels, simulated",
        Ink::Text,
        Anchor::Start,
    );
    scene.marks.push(Mark::Image {
        at: [LEFT_PX[0], TOP_PX],
        size: MAP_PX,
        columns: GRID[0],
        pixels,
    });
    for (place, reading_kpa) in shown.ports_mm.iter().zip(&readings_kpa) {
        let [x, y] = shown.at_px(0, *place);
        scene.ring([x, y], 3.0, Ink::Paper, None);
        scene.small(
            [x, y - 6.0],
            format!("{reading_kpa:.1}"),
            Ink::Paper,
            Anchor::Middle,
        );
    }
    let text = format!("kPa; yellow is {most_kpa:.0} kPa");
    let below = TOP_PX + MAP_PX[1] + 1.2 * LINE_PX;
    scene.small([LEFT_PX[0], below], text, Ink::Muted, Anchor::Start);
    Ok(())
}

/// The gel and the body over it.
fn contact(scene: &mut Scene, look: &Look, shown: &Shown) {
    let title = format!(
        "true contact; the gel has {} × {} mm",
        shown.size_mm.x, shown.size_mm.y
    );
    scene.small([LEFT_PX[1], TOP_PX - 10.0], title, Ink::Text, Anchor::Start);
    scene.rectangle([LEFT_PX[1], TOP_PX], MAP_PX, Ink::Grid, 1.0);
    for outline in &look.outlines_mm {
        let corners: Vec<[f64; 2]> = outline.iter().map(|at| shown.at_px(1, *at)).collect();
        let inside = within(&corners);
        scene.area(inside.clone(), Ink::Series(4), 0.5);
        scene.line(inside.iter().chain(inside.first()).copied(), Ink::Series(0), 1.5);
    }
    for place in &shown.ports_mm {
        scene.ring(shown.at_px(1, *place), 3.0, Ink::Muted, None);
    }
    for place in &look.places_mm {
        let at = shown.at_px(1, *place);
        if within(&[at])[0] == at {
            scene.dot(at, 4.0, Ink::Twin, 1.0);
        }
    }
}

/// Corners, moved to the border of the gel's picture where they lie outside.
fn within(corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let limited = |[x, y]: &[f64; 2]| {
        [
            x.clamp(LEFT_PX[1], LEFT_PX[1] + MAP_PX[0]),
            y.clamp(TOP_PX, TOP_PX + MAP_PX[1]),
        ]
    };
    corners.iter().map(limited).collect()
}
