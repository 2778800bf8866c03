//! Random frames and places, turned at random.

use rand::Rng;
use twintac_learn::Matrix;
use twintac_random::RandomStream;

use super::Frames;
use crate::layout::Layout;
use crate::network::Turn;

/// A place of the floor in a frame, as it is shown.
pub(super) struct PressurePick {
    frame: usize,
    place: usize,
    turn: Turn,
}

/// A frame, as it is shown.
pub(super) struct WrenchPick {
    frame: usize,
    mirrored: [bool; 2],
}

/// What is learned of the pressure.
pub(super) struct PressureBatch {
    /// What touches around places of the floor. `[n_picks][n_patch_inputs]`
    pub(super) inputs: Matrix,
    /// The pressure there, over the largest of the press. `[n_picks]`
    pub(super) pressure: Vec<f32>,
    /// The largest pressure of each row's press, kPa. `[n_picks]`
    pub(super) largest_kpa: Vec<f32>,
}

/// What is learned of force and torque.
pub(super) struct WrenchBatch {
    /// What touches anywhere. `[n_picks][n_field_inputs]`
    pub(super) inputs: Matrix,
    /// `[n_picks]`
    pub(super) wrench: Vec<[f32; 6]>,
    /// The largest force of each press, N. `[n_picks]`
    pub(super) largest_n: Vec<f32>,
}

impl PressureBatch {
    /// So many places of each of so many frames.
    pub(super) fn picks(
        frames: &Frames,
        [n_frames, n_places]: [usize; 2],
        random: &mut RandomStream,
    ) -> Vec<PressurePick> {
        let mut picks = Vec::with_capacity(n_frames * n_places);
        for _ in 0..n_frames {
            let frame = frames.any(random);
            picks.extend((0..n_places).map(|_| PressurePick {
                frame,
                place: frames.any_place(random),
                turn: Turn::number(random.random_range(0..8)),
            }));
        }
        picks
    }

    pub(super) fn of(frames: &Frames, layout: &Layout, picks: &[PressurePick]) -> Self {
        let mut batch = Self {
            inputs: Matrix::zeros(0, layout.patch.n_inputs()),
            pressure: Vec::with_capacity(picks.len()),
            largest_kpa: Vec::with_capacity(picks.len()),
        };
        let inputs = &mut batch.inputs.values;
        inputs.reserve(picks.len() * layout.patch.n_inputs());
        for pick in picks {
            let (frame, place) = (&frames.frames[pick.frame], &frames.places[pick.place]);
            let point = (place.grid, place.cell);
            layout.put_patch(&frame.inputs, point, place.at, frame.edge_mm, pick.turn, inputs);
            batch
                .pressure
                .push(frame.floor_kpa[place.number] / frame.largest_kpa);
            batch.largest_kpa.push(frame.largest_kpa);
        }
        batch
    }
}

impl WrenchBatch {
    /// So many frames, mirrored where the gel is symmetric.
    pub(super) fn picks(
        frames: &Frames,
        n_frames: usize,
        is_symmetric: bool,
        random: &mut RandomStream,
    ) -> Vec<WrenchPick> {
        let picks = (0..n_frames).map(|_| WrenchPick {
            frame: frames.any(random),
            mirrored: [0, 1].map(|_| is_symmetric && random.random_bool(0.5)),
        });
        picks.collect()
    }

    pub(super) fn of(frames: &Frames, layout: &Layout, picks: &[WrenchPick]) -> Self {
        let mut batch = Self {
            inputs: Matrix::zeros(0, layout.n_field_inputs()),
            wrench: Vec::with_capacity(picks.len()),
            largest_n: Vec::with_capacity(picks.len()),
        };
        let inputs = &mut batch.inputs.values;
        inputs.reserve(picks.len() * layout.n_field_inputs());
        for WrenchPick { frame, mirrored } in picks {
            let frame = &frames.frames[*frame];
            layout.put_field(&frame.inputs, frame.edge_mm, *mirrored, inputs);
            batch.wrench.push(mirror_wrench(frame.wrench, *mirrored));
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
