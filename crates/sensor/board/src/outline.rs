//! The board's outline: a rectangle under the gel and its rim, and at each end along x an ear with
//! a hole for a screw.

use glam::{DVec2, DVec3};
use twintac_sensor::Shell;

use crate::rules::{EDGE_CLEARANCE_MM, SCREW_DRILL_MM, SCREW_FREE_MM};
use crate::shapes::{Area, Shape, to_segment};

/// Thickness of a shell's wall, mm: three lines of a usual nozzle of 0.4 mm, and stiff enough.
pub(crate) const SHELL_WALL_MM: f64 = 2.0;
/// Rim of the board around a gel without a shell, mm. A mould stands on it.
const BARE_RIM_MM: f64 = 2.0;
/// From the screw's axis to the board's rectangle, mm: a screw head of 4 mm clears the shell's
/// wall.
const SCREW_BEYOND_MM: f64 = 2.6;
/// From the screw's axis to the end of its ear, mm.
const EAR_BEYOND_MM: f64 = 3.4;
/// Width of an ear and cut of its corners, mm.
const EAR_WIDTH_MM: f64 = 9.0;
const EAR_CUT_MM: f64 = 2.0;
/// Cut of the rectangle's corners, mm.
const CORNER_CUT_MM: f64 = 1.0;

/// The board seen from above.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Outline {
    /// Corners, counter-clockwise.
    pub(crate) corners: Vec<DVec2>,
    /// The rectangle without ears. All parts are in it.
    pub(crate) middle: Area,
    /// Centres of the holes.
    pub(crate) holes: [DVec2; 2],
}

impl Outline {
    /// The outline for a gel with these bounds and chips with these courtyards.
    pub(crate) fn new(gel: (DVec3, DVec3), shell: Option<&Shell>, chips: &[Area]) -> Self {
        let rim = shell.map_or(BARE_RIM_MM, |shell| shell.gap_mm + SHELL_WALL_MM);
        let gel = Area {
            min: gel.0.truncate(),
            max: gel.1.truncate(),
        };
        let chips = chips.iter().map(|chip| chip.grown(EDGE_CLEARANCE_MM));
        let middle = chips.fold(gel.grown(rim), |all, chip| all.joined(&chip));
        let middle = Area {
            min: round_out(middle.min, f64::floor),
            max: round_out(middle.max, f64::ceil),
        };
        let y = middle.center().y;
        let holes = [
            DVec2::new(middle.min.x - SCREW_BEYOND_MM, y),
            DVec2::new(middle.max.x + SCREW_BEYOND_MM, y),
        ];
        Self {
            corners: corners(&middle, y),
            middle,
            holes,
        }
    }

    /// Distance from a point to the edge, mm; positive on the board.
    pub(crate) fn inside_mm(&self, point: DVec2) -> f64 {
        let edges = || self.corners.iter().zip(self.corners.iter().cycle().skip(1));
        let nearest = edges()
            .map(|(from, to)| to_segment(point, *from, *to))
            .fold(f64::INFINITY, f64::min);
        let crossed = edges().filter(|(from, to)| {
            (from.y > point.y) != (to.y > point.y)
                && point.x < from.x + (point.y - from.y) / (to.y - from.y) * (to.x - from.x)
        });
        if crossed.count() % 2 == 1 {
            nearest
        } else {
            -nearest
        }
    }

    /// The areas around the screws that tracks keep free.
    pub(crate) fn screws(&self) -> [Shape; 2] {
        self.holes
            .map(|hole| Shape::disc(hole, SCREW_FREE_MM.max(0.5 * SCREW_DRILL_MM)))
    }

    /// The bounding box.
    pub(crate) fn bounds(&self) -> Area {
        let first = self.corners[0];
        self.corners.iter().fold(
            Area {
                min: first,
                max: first,
            },
            |area, corner| Area {
                min: area.min.min(*corner),
                max: area.max.max(*corner),
            },
        )
    }
}

/// Rounds to a tenth of a millimetre.
fn round_out(point: DVec2, round: fn(f64) -> f64) -> DVec2 {
    let tenth = |value: f64| round((value * 1e7).round() / 1e6) / 10.0;
    DVec2::new(tenth(point.x), tenth(point.y))
}

fn corners(middle: &Area, y: f64) -> Vec<DVec2> {
    let (min, max) = (middle.min, middle.max);
    let ear = 0.5 * EAR_WIDTH_MM.min(0.6 * (max.y - min.y));
    let beyond = SCREW_BEYOND_MM + EAR_BEYOND_MM;
    let half = [
        [min.x + CORNER_CUT_MM, min.y],
        [max.x - CORNER_CUT_MM, min.y],
        [max.x, min.y + CORNER_CUT_MM],
        [max.x, y - ear],
        [max.x + beyond - EAR_CUT_MM, y - ear],
        [max.x + beyond, y - ear + EAR_CUT_MM],
        [max.x + beyond, y + ear - EAR_CUT_MM],
        [max.x + beyond - EAR_CUT_MM, y + ear],
        [max.x, y + ear],
        [max.x, max.y - CORNER_CUT_MM],
    ];
    let turned = half.map(|[x, at_y]| [min.x + max.x - x, min.y + max.y - at_y]);
    half.into_iter().chain(turned).map(DVec2::from).collect()
}
