//! How narrow a body is where it presses: a body much narrower than the grid spacing lies between
//! the points, and its prediction depends on where it lies relative to them.

use glam::{Mat3, Vec2};
use twintac_shape::Pose;

use crate::Body;
use crate::columns::{Columns, Standing};
use crate::contact::box_in_gel;
use crate::distance::REACH_MM;
use crate::surface::SurfaceGrid;

/// Smallest width with good predictions, in grid spacings: the error for narrower bars and walls is
/// up to a fifth.
const LEAST_WIDTH: f32 = 1.25;

/// Spacing of the locations at which the width is measured, as a fraction of half of that width.
const STEP: f32 = 1.0 / 3.0;

/// Height above the gel's surface at which the width of a body is measured, as a fraction of half
/// of that width: edges and ends are narrow by themselves.
const ABOVE: f32 = 1.5;

/// Distance from a location within which the body has to be wide, as a fraction of half of that
/// width: a sharp corner may belong to a wide body.
const CORNER: f32 = 2.0;

/// Fraction of the width that has to be measured, because locations lie beside the body's middle.
const MEASURED: f32 = 0.9;

/// Fraction of the pressed locations that may be narrow.
const NARROW: f32 = 0.05;

/// By which factor a body is narrower, where it presses, than the smallest width with good
/// predictions: above 1 if it is, else 0.
pub(crate) fn narrowness(grid: &SurfaceGrid, body: &Body, gel_from_body: &Pose) -> f32 {
    let spacing_mm = grid.spacing_mm as f32;
    let half_mm = 0.5 * LEAST_WIDTH * spacing_mm;
    if body.half_thickness_mm() >= half_mm {
        return 0.0;
    }
    let step_mm = STEP * half_mm;
    let (rotation, origin) = (
        gel_from_body.rotation.as_quat(),
        gel_from_body.position_mm.as_vec3(),
    );
    let [low, high] = box_in_gel(body, &Mat3::from_quat(rotation), origin);
    let range = |axis: usize| {
        let size_mm = spacing_mm * (grid.n[axis] - 1) as f32;
        let first_mm = grid.first_mm[axis] as f32;
        let [low_mm, high_mm] = [low[axis], high[axis]].map(|at| at.clamp(first_mm, first_mm + size_mm));
        0..((high_mm - low_mm) / step_mm).ceil() as i32
    };
    let first_mm = [0, 1].map(|axis| low[axis].max(grid.first_mm[axis] as f32));
    let columns = Columns {
        first_mm,
        spacing_mm: step_mm,
        columns: range(0),
        rows: range(1),
    };
    let body_from_gel = Mat3::from_quat(rotation.inverse());
    let standing = Standing::new(body, body_from_gel, origin, low.z + REACH_MM);
    let levels_mm = |[i, j]: [i32; 2]| {
        let at = [(0, i), (1, j)].map(|(axis, n)| f64::from(first_mm[axis] + step_mm * n as f32));
        let top_mm = grid.height_mm_at(at.into()) as f32;
        [top_mm + ABOVE * half_mm, top_mm, top_mm]
    };
    let mut places: Vec<[f32; 2]> = Vec::new();
    columns.open(&standing, levels_mm, |_, [above_mm, on_mm, _]| {
        places.push([-above_mm, on_mm])
    });
    narrowest(&places, columns.columns.len(), half_mm, step_mm)
}

/// `places`: for each location, row by row, how far it lies inside a body above the gel, and how
/// far outside on the gel, mm.
fn narrowest(places: &[[f32; 2]], n_columns: usize, half_mm: f32, step_mm: f32) -> f32 {
    let reach = (CORNER * half_mm / step_mm) as i32;
    let place = |at: i32| (at % n_columns as i32, at / n_columns as i32);
    let widest_near = |own: usize| {
        if places[own][0] >= MEASURED * half_mm {
            return half_mm;
        }
        let (i, j) = place(own as i32);
        let mut widest_mm = 0.0f32;
        for row in (j - reach).max(0)..=j + reach {
            for column in (i - reach).max(0)..=(i + reach).min(n_columns as i32 - 1) {
                let is_near = Vec2::new((column - i) as f32, (row - j) as f32).length() <= reach as f32;
                let other = places.get(row as usize * n_columns + column as usize);
                if let Some(other) = other.filter(|_| is_near) {
                    widest_mm = widest_mm.max(other[0]);
                }
            }
        }
        widest_mm
    };
    let pressed = (0..places.len()).filter(|own| places[*own][1] < 0.7 * step_mm);
    let mut halves_mm: Vec<f32> = pressed.map(widest_near).collect();
    halves_mm.sort_by(f32::total_cmp);
    let Some(narrow_mm) = halves_mm.get((NARROW * halves_mm.len() as f32) as usize) else {
        return 0.0;
    };
    let times = MEASURED * half_mm / narrow_mm.max(0.1 * step_mm);
    if times > 1.0 { times } else { 0.0 }
}
