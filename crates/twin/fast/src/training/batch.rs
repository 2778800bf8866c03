//! Batches of random frames and locations, transformed by random symmetries.

use rand::Rng;
use twintac_learn::Matrix;
use twintac_random::RandomStream;

use super::Frames;
use crate::layout::Layout;
use crate::network::Turn;

/// A location of the base in a frame, and the symmetry that is applied.
pub(super) struct PressurePick {
    frame: usize,
    place: usize,
    turn: Turn,
}

/// A frame, and the axes that are mirrored.
pub(super) struct GridPick {
    frame: usize,
    mirrored: [bool; 2],
}

/// A batch for the network of pressures.
pub(super) struct PressureBatch {
    /// Inputs of the patches around locations of the base. `[n_picks][n_patch_inputs]`
    pub(super) inputs: Matrix,
    /// The pressure at the location, over the largest pressure of the press. `[n_picks]`
    pub(super) pressure: Vec<f32>,
    /// The largest pressure of each row's press, kPa. `[n_picks]`
    pub(super) largest_kpa: Vec<f32>,
}

/// A batch for the network of force and torque.
pub(super) struct WrenchBatch {
    /// Inputs of the whole grid. `[n_picks][n_field_inputs]`
    pub(super) inputs: Matrix,
    /// Force, N, and torque, N mm. `[n_picks]`
    pub(super) wrench: Vec<[f32; 6]>,
    /// The largest force of each press, N. `[n_picks]`
    pub(super) largest_n: Vec<f32>,
}

/// A batch for the network of all taxels.
pub(super) struct TaxelBatch {
    /// Inputs of the whole grid. `[n_picks][n_field_inputs]`
    pub(super) inputs: Matrix,
    /// The taxels' pressures over the largest pressure of the press. `[n_picks * n_taxels]`
    pub(super) pressure: Vec<f32>,
    /// The largest pressure of each press, kPa. `[n_picks]`
    pub(super) largest_kpa: Vec<f32>,
}

impl PressureBatch {
    /// Picks `n_places` locations of each of `n_frames` frames.
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

impl GridPick {
    /// Picks frames, mirrored across x and across y at random where the gel is symmetric.
    pub(super) fn picks(
        frames: &Frames,
        n_frames: usize,
        is_symmetric: [bool; 2],
        random: &mut RandomStream,
    ) -> Vec<Self> {
        let picks = (0..n_frames).map(|_| Self {
            frame: frames.any(random),
            mirrored: is_symmetric.map(|is| is && random.random_bool(0.5)),
        });
        picks.collect()
    }

    /// Inputs of the whole grid for each pick.
    fn inputs(frames: &Frames, layout: &Layout, picks: &[Self]) -> Matrix {
        let mut inputs = Matrix::zeros(0, layout.n_field_inputs());
        inputs.values.reserve(picks.len() * layout.n_field_inputs());
        for pick in picks {
            let frame = &frames.frames[pick.frame];
            layout.put_field(&frame.inputs, frame.edge_mm, pick.mirrored, &mut inputs.values);
        }
        inputs
    }
}

impl WrenchBatch {
    pub(super) fn of(frames: &Frames, layout: &Layout, picks: &[GridPick]) -> Self {
        let shown = |pick: &GridPick| mirror_wrench(frames.frames[pick.frame].wrench, pick.mirrored);
        Self {
            inputs: GridPick::inputs(frames, layout, picks),
            wrench: picks.iter().map(shown).collect(),
            largest_n: picks
                .iter()
                .map(|pick| frames.frames[pick.frame].largest_n)
                .collect(),
        }
    }
}

impl TaxelBatch {
    /// `mirrored_taxels`: for each taxel, the number of its mirror image across x and across y.
    pub(super) fn of(
        frames: &Frames,
        layout: &Layout,
        mirrored_taxels: &[Option<Vec<usize>>; 2],
        picks: &[GridPick],
    ) -> Self {
        let mut pressure = Vec::with_capacity(picks.len() * frames.n_taxels);
        for pick in picks {
            let frame = &frames.frames[pick.frame];
            let share = |mut taxel: usize| {
                for (mirrored, image) in pick.mirrored.into_iter().zip(mirrored_taxels) {
                    if let (true, Some(image)) = (mirrored, image) {
                        taxel = image[taxel];
                    }
                }
                frame.floor_kpa[taxel] / frame.largest_kpa
            };
            pressure.extend((0..frames.n_taxels).map(share));
        }
        Self {
            inputs: GridPick::inputs(frames, layout, picks),
            pressure,
            largest_kpa: picks
                .iter()
                .map(|pick| frames.frames[pick.frame].largest_kpa)
                .collect(),
        }
    }
}

/// A force and a torque, mirrored across x and across y.
fn mirror_wrench([fx, fy, fz, tx, ty, tz]: [f32; 6], mirrored: [bool; 2]) -> [f32; 6] {
    let [x, y] = mirrored.map(|is_mirrored| if is_mirrored { -1.0 } else { 1.0 });
    // A mirror reverses a torque, except for its component across the mirror.
    [x * fx, y * fy, fz, y * tx, x * ty, x * y * tz]
}
