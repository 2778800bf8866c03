//! A thin body, known by samples, column by column from below: what is above it is inside it too.

use std::cell::RefCell;
use std::ops::Range;

use glam::{Mat3, Vec2, Vec3};

use crate::distance::{Body, Field, Form, REACH_MM};

/// Columns beside those that are asked for: how far a body reaches aside is told by what is beside it.
pub(crate) const AROUND: i32 = 2;

/// How far off columns tell how far a body reaches aside, in distances of columns.
const FARTHEST: i32 = 3;

/// Steps upward, mm: below a body at most, and in it or above it.
const LARGEST_MM: [f32; 2] = [0.5, 0.2];

/// The smallest step, mm, and steps as parts of the distance to the nearest face, likewise.
const SMALLEST_MM: f32 = 0.03;
const OF_DISTANCE: [f32; 2] = [0.9, 0.25];

/// How fast the distance grows upward from what is a side, and from what is a top. Sides lean by 20 degrees where shapes that were taught are tilted by as much.
const RISES: [f32; 2] = [0.35, 0.5];

/// Where columns stand.
#[derive(Clone, Debug)]
pub(crate) struct Columns {
    /// Place of the column in the column and row 0, mm.
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
    /// A height below it, mm.
    pub(crate) from_mm: f32,
}

/// Distances to a body at one level of a column, mm.
#[derive(Clone, Copy, Debug, Default)]
struct Level {
    /// To its nearest face.
    plain_mm: f32,
    /// The least of those here and below.
    least_mm: f32,
    /// As if it went on above its tops, however far it reaches aside.
    open_mm: f32,
    /// How far there is a top here or below, from 0 to 1.
    top: f32,
    /// Whether that is in the body, or above it.
    is_inside: bool,
}

thread_local! {
    /// What is known of the columns about a body, level by level. It is kept, so that readings allocate nothing.
    static KNOWN: RefCell<Vec<Level>> = const { RefCell::new(Vec::new()) };
}

impl Columns {
    /// Calls `put` with each column and row and the distances there, mm, to a body that goes on above its tops. `levels_mm`: heights in a column, falling.
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
            climb(levels_mm(at), standing.from_mm, |height_mm| {
                let point = Vec3::new(x_mm, y_mm, height_mm) - standing.origin;
                field.distance_mm((standing.body_from_gel * point).into())
            })
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

    /// How far a body at most reaches aside of a point in it: no farther than what is beside it leaves.
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

/// What is known of a column up to some height.
#[derive(Clone, Copy, Debug)]
struct Climb {
    height_mm: f32,
    plain_mm: f32,
    least_mm: f32,
    open_mm: f32,
    /// How fast the distance grew at most on the way.
    steepest: f32,
    /// How fast it fell where the body began; none below that.
    slope: Option<f32>,
}

impl Climb {
    /// How far it is to where the distance is asked for next, mm: what is asked depends on the body alone, and not on where the levels are.
    fn step_mm(&self) -> f32 {
        let place = usize::from(self.slope.is_some());
        (OF_DISTANCE[place] * self.plain_mm.abs()).clamp(SMALLEST_MM, LARGEST_MM[place])
    }

    /// As far as a height, no farther than the next step.
    fn up_to(&self, height_mm: f32, plain_mm: f32) -> Self {
        let way_mm = height_mm - self.height_mm;
        let more_mm = plain_mm - self.plain_mm;
        // What is farther away is known to be so, no more. A part of a step counts as such.
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

/// The levels of a column, from below.
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
