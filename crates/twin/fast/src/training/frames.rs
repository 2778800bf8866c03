//! Training presses as inputs and targets of the networks.

use glam::{DVec2, DVec3};
use rand::Rng;
use twintac_random::RandomStream;
use twintac_shape::{Pose, ShapeError, Surfaces};

use crate::contact::ContactPoints;
use crate::layout::Layout;
use crate::{Body, FemPress};

/// Largest gaps between gel and shape of the two added frames without contact, mm: each training
/// press gets one gap up to each, evenly spread over the presses.
const HOVER_MM: [f64; 2] = [0.5, 2.0];

/// Fraction of the largest gap by which the gap grows from press to press (modulo 1): two numbers
/// whose multiples are evenly spread together (Roberts, 2018, "The unreasonable effectiveness of
/// quasirandom sequences").
const SPREAD: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// The scale of pressure errors is at least this fraction of the largest pressure at the base.
const LEAST_SHARE: f32 = 0.3;

/// One frame of a training press.
pub(crate) struct TrainingFrame {
    /// Number of its press.
    pub(crate) press: usize,
    /// `[n_points * N_CHANNELS]`
    pub(crate) inputs: Vec<f32>,
    /// Length of the mesh's edges, mm.
    pub(crate) edge_mm: f32,
    /// Pressure at each location, kPa.
    pub(crate) floor_kpa: Vec<f32>,
    /// Force, N, and torque about the centre of the top of the gel's bounding box, N mm.
    pub(crate) wrench: [f32; 6],
    /// Scale of the errors, kPa: the largest pressure at the ports during the whole press, but at
    /// least [`LEAST_SHARE`] of the largest at the base.
    pub(crate) largest_kpa: f32,
    /// The largest force of the whole press, N.
    pub(crate) largest_n: f32,
}

/// Training presses of one sensor.
pub(crate) struct Frames {
    pub(crate) frames: Vec<TrainingFrame>,
    /// Locations whose pressure is trained, those of the taxels first.
    pub(crate) places: Vec<TrainingLocation>,
    /// Number of taxels.
    pub(crate) n_taxels: usize,
}

/// A location of the base that is below a point of a grid.
pub(crate) struct TrainingLocation {
    /// Its number among the locations of the training presses.
    pub(crate) number: usize,
    /// The grid's number, and column and row of the point.
    pub(crate) grid: usize,
    pub(crate) cell: [i32; 2],
    /// Its position, mm.
    pub(crate) at: DVec2,
}

impl Frames {
    /// The index of a random location.
    pub(crate) fn any_place(&self, random: &mut RandomStream) -> usize {
        random.random_range(0..self.places.len())
    }

    /// The index of a random frame.
    pub(crate) fn any(&self, random: &mut RandomStream) -> usize {
        random.random_range(0..self.frames.len())
    }

    pub(crate) fn of(
        presses: &[FemPress],
        layout: &Layout,
        (places_mm, n_taxels): (&[DVec2], usize),
        center_mm: DVec3,
        surfaces: &Surfaces,
    ) -> Result<Self, ShapeError> {
        let points = ContactPoints::new(&layout.grids);
        let mut frames = Vec::new();
        for (number, press) in presses.iter().enumerate() {
            let body = Body::new(&press.shape, surfaces)?;
            let largest = |n: usize| {
                let floor = press.frames.iter().flat_map(|frame| &frame.floor_kpa[..n]);
                floor.copied().fold(f32::MIN_POSITIVE, f32::max)
            };
            // The errors of a press far from all ports are relative to the pressures at the ports,
            // but not to almost zero.
            let largest_kpa = largest(n_taxels).max(LEAST_SHARE * largest(places_mm.len()));
            let forces = press.frames.iter().map(|frame| frame.force_n.length() as f32);
            let largest_n = forces.fold(f32::MIN_POSITIVE, f32::max);
            let mut add = |gel_from_indenter: Pose, floor_kpa: Vec<f32>, wrench: [f32; 6]| {
                let mut inputs = vec![0.0; points.n_inputs()];
                points.fill([(&body, gel_from_indenter)].into_iter(), &mut inputs);
                frames.push(TrainingFrame {
                    press: number,
                    inputs,
                    edge_mm: press.edge_mm as f32,
                    floor_kpa,
                    wrench,
                    largest_kpa,
                    largest_n,
                });
            };
            for frame in &press.frames {
                let torque = frame.torque_n_mm - center_mm.cross(frame.force_n);
                let [fx, fy, fz] = frame.force_n.to_array();
                let wrench = [fx, fy, fz, torque.x, torque.y, torque.z].map(|value| value as f32);
                add(frame.gel_from_indenter, frame.floor_kpa.clone(), wrench);
            }
            // Frames without contact: their targets are zero.
            let Some(touch) = press.touch() else {
                continue;
            };
            for (most_mm, spread) in HOVER_MM.into_iter().zip(SPREAD) {
                let gap_mm = most_mm * (number as f64 * spread).fract();
                let hovering = Pose {
                    position_mm: touch.position_mm + gap_mm * DVec3::Z,
                    ..touch
                };
                add(hovering, vec![0.0; places_mm.len()], [0.0; 6]);
            }
        }
        let on_grid = places_mm.iter().enumerate().filter_map(|(number, at)| {
            let grid = layout.grid_at(*at)?;
            Some(TrainingLocation {
                number,
                grid,
                cell: layout.grids[grid].cell(*at).0,
                at: *at,
            })
        });
        Ok(Self {
            places: on_grid.collect(),
            frames,
            n_taxels,
        })
    }
}
