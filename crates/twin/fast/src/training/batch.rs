//! Random frames and places, turned at random.

use rand::Rng;
use twintac_learn::Matrix;
use twintac_random::RandomStream;

use super::Frames;
use crate::layout::Layout;
use crate::network::Turn;

/// What one step learns of the pressure.
pub(super) struct PressureBatch {
    /// What touches around places of the floor. `[n_frames * n_places][n_patch_inputs]`
    pub(super) inputs: Matrix,
    /// The pressure there, over the largest of the press. `[n_frames * n_places]`
    pub(super) pressure: Vec<f32>,
    /// The largest pressure of each row's press, kPa.
    pub(super) largest_kpa: Vec<f32>,
}

/// What one step learns of force and torque.
pub(super) struct WrenchBatch {
    /// What touches anywhere. `[n_frames][n_field_inputs]`
    pub(super) inputs: Matrix,
    /// `[n_frames]`
    pub(super) wrench: Vec<[f32; 6]>,
    /// The largest force of each press, N. `[n_frames]`
    pub(super) largest_n: Vec<f32>,
}

impl PressureBatch {
    pub(super) fn draw(
        frames: &Frames,
        layout: &Layout,
        [n_frames, n_places]: [usize; 2],
        random: &mut RandomStream,
    ) -> Self {
        let n_rows = n_frames * n_places;
        let mut batch = Self {
            inputs: Matrix::zeros(0, layout.patch.n_inputs()),
            pressure: Vec::with_capacity(n_rows),
            largest_kpa: Vec::with_capacity(n_rows),
        };
        batch.inputs.values.reserve(n_rows * layout.patch.n_inputs());
        for _ in 0..n_frames {
            let frame = frames.any(random);
            for _ in 0..n_places {
                let place = &frames.places[random.random_range(0..frames.places.len())];
                let turn = Turn::number(random.random_range(0..8));
                let point = (place.grid, place.cell);
                let inputs = &mut batch.inputs.values;
                layout.put_patch(&frame.inputs, point, place.at, frame.edge_mm, turn, inputs);
                batch
                    .pressure
                    .push(frame.floor_kpa[place.number] / frame.largest_kpa);
                batch.largest_kpa.push(frame.largest_kpa);
            }
        }
        batch
    }
}

impl WrenchBatch {
    pub(super) fn draw(
        frames: &Frames,
        layout: &Layout,
        n_frames: usize,
        is_symmetric: bool,
        random: &mut RandomStream,
    ) -> Self {
        let mut batch = Self {
            inputs: Matrix::zeros(0, layout.n_field_inputs()),
            wrench: Vec::with_capacity(n_frames),
            largest_n: Vec::with_capacity(n_frames),
        };
        batch.inputs.values.reserve(n_frames * layout.n_field_inputs());
        for _ in 0..n_frames {
            let frame = frames.any(random);
            let mirrored = [0, 1].map(|_| is_symmetric && random.random_bool(0.5));
            layout.put_field(&frame.inputs, frame.edge_mm, mirrored, &mut batch.inputs.values);
            batch.wrench.push(mirror_wrench(frame.wrench, mirrored));
            batch.largest_n.push(frame.largest_n);
        }
        batch
    }
}

/// A force and a torque seen in mirrors across x and across y.
fn mirror_wrench([fx, fy, fz, tx, ty, tz]: [f32; 6], mirrored: [bool; 2]) -> [f32; 6] {
    let [x, y] = mirrored.map(|is_mirrored| if is_mirrored { -1.0 } else { 1.0 });
    // A torque turns the other way in a mirror, but for its component across the mirror.
    [x * fx, y * fy, fz, y * tx, x * ty, x * y * tz]
}
