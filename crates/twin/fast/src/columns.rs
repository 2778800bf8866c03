//! A thin body that is known by samples, followed upward in columns: everything above the body
//! counts as inside it.

use std::cell::RefCell;
use std::ops::Range;

use glam::{Mat3, Vec2, Vec3};

use crate::distance::{Body, Field, Form, REACH_MM};
use crate::surface::BASE_MM;

/// Extra columns on each side of those that are asked for: the lateral extent of a body follows
/// from its neighbouring columns.
pub(crate) const AROUND: i32 = 2;

/// Distance up to which columns are searched for the lateral extent of a body, in column spacings.
const FARTHEST: i32 = 3;

/// Largest step upward, mm: below a body, and in it or above it.
const LARGEST_MM: [f32; 2] = [0.5, 0.2];

/// Smallest step, mm; and step as a fraction of the distance to the nearest face, below a body and
/// in it or above it.
const SMALLEST_MM: f32 = 0.03;
const OF_DISTANCE: [f32; 2] = [0.9, 0.25];

/// Rate at which the distance grows upward from a face that is a side, and from one that is a top.
/// Training shapes are tilted so that their sides lean by up to 20 degrees.
const RISES: [f32; 2] = [0.35, 0.5];

/// Rate at which the distance grows upward from the base of the gel, from which a body is below it.
const LEAVES: f32 = 0.1;

/// A grid of vertical columns.
#[derive(Clone, Debug)]
pub(crate) struct Columns {
    /// Position of the column with index 0 in row 0, mm.
    pub(crate) first_mm: [f32; 2],
    pub(crate) spacing_mm: f32,
    pub(crate) columns: Range<i32>,
    pub(crate) rows: Range<i32>,
}

/// A body in the gel's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Standing<'a> {
    pub(crate) body: &'a Body,
    pub(crate) body_from_gel: Mat3,
    pub(crate) origin: Vec3,
    /// The height from which columns are followed, mm: below the body, or at the base of the gel if
    /// the body reaches below it.
    from_mm: f32,
    reaches_base: bool,
}

impl<'a> Standing<'a> {
    /// `low_mm`: height of the body's lowest point, mm.
    pub(crate) fn new(body: &'a Body, body_from_gel: Mat3, origin: Vec3, low_mm: f32) -> Self {
        Self {
            body,
            body_from_gel,
            origin,
            from_mm: low_mm.max(BASE_MM),
            reaches_base: low_mm < BASE_MM,
        }
    }
}

/// Distances to a body at one level of a column, mm.
#[derive(Clone, Copy, Debug, Default)]
struct Level {
    /// To the nearest face.
    plain_mm: f32,
    /// The smallest distance to the nearest face, here and below.
    least_mm: f32,
    /// Distance to the body continued upward above its tops, without regard to its lateral extent.
    open_mm: f32,
    /// Degree to which there is a top here or below, from 0 to 1.
    top: f32,
    /// Whether the level is in the body or above it.
    is_inside: bool,
}

impl Level {
    /// Where no body is.
    const FAR: Self = Self {
        plain_mm: REACH_MM,
        least_mm: REACH_MM,
        open_mm: REACH_MM,
        top: 0.0,
        is_inside: false,
    };
}

thread_local! {
    /// Levels of all columns around a body. The memory is kept, so that evaluations do not
    /// allocate.
    static KNOWN: RefCell<Vec<Level>> = const { RefCell::new(Vec::new()) };
}

impl Columns {
    /// Calls `put` with each column and row and the distances there, mm, to a body that is
    /// continued upward above its tops. `levels_mm`: heights in a column, decreasing.
    pub(crate) fn open<const N: usize>(
        &self,
        standing: &Standing<'_>,
        levels_mm: impl Fn([i32; 2]) -> [f32; N],
        put: impl FnMut([i32; 2], [f32; N]),
    ) {
        match &standing.body.form {
            Form::Ball(ball) => self.open_field(standing, ball, levels_mm, put),
            Form::Box(rounded) => self.open_field(standing, rounded, levels_mm, put),
            Form::Cylinder(rounded) => self.open_field(standing, rounded, levels_mm, put),
            Form::Sampled(samples) => self.open_field(standing, samples, levels_mm, put),
        }
    }

    fn open_field<const N: usize>(
        &self,
        standing: &Standing<'_>,
        field: &impl Field,
        levels_mm: impl Fn([i32; 2]) -> [f32; N],
        mut put: impl FnMut([i32; 2], [f32; N]),
    ) {
        let all = || {
            self.rows
                .clone()
                .flat_map(|j| self.columns.clone().map(move |i| [i, j]))
        };
        let climbed = all().map(|at| {
            let [x_mm, y_mm] = [0, 1].map(|axis| self.first_mm[axis] + self.spacing_mm * at[axis] as f32);
            let distance_mm = |height_mm: f32| {
                let point = Vec3::new(x_mm, y_mm, height_mm) - standing.origin;
                field.distance_mm((standing.body_from_gel * point).into())
            };
            let (levels_mm, from_mm) = (levels_mm(at), standing.from_mm);
            // What is below the base has not come through the gel: it is behind the sensor.
            if standing.reaches_base && is_left(from_mm, distance_mm) {
                return levels_mm.map(|_| Level::FAR);
            }
            climb(levels_mm, from_mm, distance_mm)
        });
        KNOWN.with_borrow_mut(|known| {
            known.clear();
            known.extend(climbed.flatten());
            for (at, levels) in all().zip(known.chunks_exact(N)) {
                let mut found_mm = [0.0; N];
                for (number, (level, found_mm)) in levels.iter().zip(&mut found_mm).enumerate() {
                    let mut open_mm = level.open_mm;
                    if level.is_inside && level.top > 0.0 {
                        let aside_mm = self.reach_aside_mm(at, |column| known[column * N + number]);
                        open_mm = open_mm.max(-aside_mm.max(-level.least_mm));
                    }
                    *found_mm = level.plain_mm + level.top * (open_mm - level.plain_mm).min(0.0);
                }
                put(at, found_mm);
            }
        });
    }

    /// Upper limit of the lateral extent of a body at a point inside it, mm, from the neighbouring
    /// columns that are outside.
    fn reach_aside_mm(&self, [i, j]: [i32; 2], level_of: impl Fn(usize) -> Level) -> f32 {
        let n_columns = self.columns.len();
        let mut least_mm = f32::INFINITY;
        for row in (j - FARTHEST).max(self.rows.start)..(j + FARTHEST + 1).min(self.rows.end) {
            for column in (i - FARTHEST).max(self.columns.start)..(i + FARTHEST + 1).min(self.columns.end) {
                let place =
                    (row - self.rows.start) as usize * n_columns + (column - self.columns.start) as usize;
                let level = level_of(place);
                if !level.is_inside {
                    let away_mm = self.spacing_mm * Vec2::new((column - i) as f32, (row - j) as f32).length();
                    least_mm = least_mm.min(away_mm - level.open_mm);
                }
            }
        }
        least_mm
    }
}

/// State of the way up a column.
#[derive(Clone, Copy, Debug)]
struct Climb {
    height_mm: f32,
    plain_mm: f32,
    least_mm: f32,
    open_mm: f32,
    /// The largest rate at which the distance grew on the way.
    steepest: f32,
    /// Rate at which the distance fell where the body began; `None` below the body.
    slope: Option<f32>,
}

impl Climb {
    /// Distance to the height at which the distance is evaluated next, mm. It depends on the body
    /// alone, not on where the levels are.
    fn step_mm(&self) -> f32 {
        let place = usize::from(self.slope.is_some());
        (OF_DISTANCE[place] * self.plain_mm.abs()).clamp(SMALLEST_MM, LARGEST_MM[place])
    }

    /// Continues to a height that is no farther than the next step.
    fn up_to(&self, height_mm: f32, plain_mm: f32) -> Self {
        let way_mm = height_mm - self.height_mm;
        let more_mm = plain_mm - self.plain_mm;
        // Distances beyond the reach are only known to be beyond it. An incomplete step counts as a
        // fraction of a step.
        let rise = if self.plain_mm < REACH_MM {
            more_mm / self.step_mm()
        } else {
            0.0
        };
        let falls = || (-more_mm / way_mm.max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        let onward_mm = self.open_mm - self.slope.unwrap_or(0.0) * way_mm;
        Self {
            height_mm,
            plain_mm,
            least_mm: plain_mm.min(self.least_mm),
            open_mm: plain_mm.min(onward_mm),
            steepest: self.steepest.max(rise),
            slope: self.slope.or_else(|| (plain_mm < 0.0).then(falls)),
        }
    }
}

/// Whether the way up from a height leaves a body that is below it.
fn is_left(from_mm: f32, distance_mm: impl Fn(f32) -> f32) -> bool {
    let [here_mm, above_mm] = [0.0, SMALLEST_MM].map(|up_mm| distance_mm(from_mm + up_mm));
    here_mm >= 0.0 && above_mm - here_mm > LEAVES * SMALLEST_MM
}

/// The levels of a column, computed from below.
fn climb<const N: usize>(levels_mm: [f32; N], from_mm: f32, distance_mm: impl Fn(f32) -> f32) -> [Level; N] {
    let plain_mm = distance_mm(from_mm);
    let mut climb = Climb {
        height_mm: from_mm,
        plain_mm,
        least_mm: plain_mm,
        open_mm: plain_mm,
        steepest: 0.0,
        slope: None,
    };
    let mut levels = [Level::default(); N];
    for (level, level_mm) in levels.iter_mut().zip(levels_mm).rev() {
        loop {
            let next_mm = climb.height_mm + climb.step_mm();
            if next_mm > level_mm {
                break;
            }
            climb = climb.up_to(next_mm, distance_mm(next_mm));
        }
        let plain_mm = distance_mm(level_mm);
        let there = if level_mm > climb.height_mm {
            climb.up_to(level_mm, plain_mm)
        } else {
            climb
        };
        *level = Level {
            plain_mm,
            least_mm: there.least_mm,
            open_mm: there.open_mm,
            top: ((there.steepest - RISES[0]) / (RISES[1] - RISES[0])).clamp(0.0, 1.0),
            is_inside: there.slope.is_some(),
        };
    }
    levels
}
