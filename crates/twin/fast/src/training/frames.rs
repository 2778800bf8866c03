//! Lessons as a network sees them.

use glam::{DVec2, DVec3};
use rand::Rng;
use twintac_random::RandomStream;
use twintac_shape::{Pose, ShapeError, Surfaces};

use crate::contact::ContactPoints;
use crate::layout::Layout;
use crate::{Body, Lesson};

/// Gaps between gel and shape at which nothing is felt are evenly spread up to these, mm: one each for each lesson.
const HOVER_MM: [f64; 2] = [0.5, 2.0];

/// By which part of them the gap grows from lesson to lesson: two numbers whose multiples spread evenly together (Roberts, 2018, "The unreasonable effectiveness
/// of quasirandom sequences").
const SPREAD: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

/// Least share of the floor's largest pressure by which errors are weighed.
const LEAST_SHARE: f32 = 0.3;

/// One moment of a lesson.
pub(crate) struct TaughtFrame {
    /// The number of its lesson.
    pub(crate) lesson: usize,
    /// `[n_points * N_CHANNELS]`
    pub(crate) inputs: Vec<f32>,
    /// Length of the mesh's edges, mm.
    pub(crate) edge_mm: f32,
    /// Pressure at each place, kPa.
    pub(crate) floor_kpa: Vec<f32>,
    /// Force, N, and torque about the top of the gel's middle, N mm.
    pub(crate) wrench: [f32; 6],
    /// Largest pressure that ports read during the whole press, kPa.
    pub(crate) largest_kpa: f32,
    /// Largest force of the whole press, N.
    pub(crate) largest_n: f32,
}

/// Lessons of one sensor.
pub(crate) struct Frames {
    pub(crate) frames: Vec<TaughtFrame>,
    /// Places whose pressure is taught, those of the taxels first.
    pub(crate) places: Vec<TaughtPlace>,
    /// How many of them are a taxel's.
    pub(crate) n_taxels: usize,
}

/// A place of the floor that is below a point of a grid.
pub(crate) struct TaughtPlace {
    /// Its number among the lessons' places.
    pub(crate) number: usize,
    /// The grid's number, and column and row of the point.
    pub(crate) grid: usize,
    pub(crate) cell: [i32; 2],
    /// Where it is, mm.
    pub(crate) at: DVec2,
}

impl Frames {
    /// A place at random.
    pub(crate) fn any_place(&self, random: &mut RandomStream) -> usize {
        random.random_range(0..self.places.len())
    }

    /// The number of a frame at random.
    pub(crate) fn any(&self, random: &mut RandomStream) -> usize {
        random.random_range(0..self.frames.len())
    }

    pub(crate) fn of(
        lessons: &[Lesson],
        layout: &Layout,
        (places_mm, n_taxels): (&[DVec2], usize),
        center_mm: DVec3,
        surfaces: &Surfaces,
    ) -> Result<Self, ShapeError> {
        let points = ContactPoints::new(&layout.grids);
        let mut frames = Vec::new();
        for (number, lesson) in lessons.iter().enumerate() {
            let body = Body::new(&lesson.shape, surfaces)?;
            let largest = |n: usize| {
                let floor = lesson.frames.iter().flat_map(|frame| &frame.floor_kpa[..n]);
                floor.copied().fold(f32::MIN_POSITIVE, f32::max)
            };
            // A press far from all ports is judged by what they read, but not by next to nothing.
            let largest_kpa = largest(n_taxels).max(LEAST_SHARE * largest(places_mm.len()));
            let forces = lesson.frames.iter().map(|frame| frame.force_n.length() as f32);
            let largest_n = forces.fold(f32::MIN_POSITIVE, f32::max);
            let mut teach = |gel_from_indenter: Pose, floor_kpa: Vec<f32>, wrench: [f32; 6]| {
                let mut inputs = vec![0.0; points.n_inputs()];
                points.fill([(&body, gel_from_indenter)].into_iter(), &mut inputs);
                frames.push(TaughtFrame {
                    lesson: number,
                    inputs,
                    edge_mm: lesson.edge_mm as f32,
                    floor_kpa,
                    wrench,
                    largest_kpa,
                    largest_n,
                });
            };
            for frame in &lesson.frames {
                let torque = frame.torque_n_mm - center_mm.cross(frame.force_n);
                let [fx, fy, fz] = frame.force_n.to_array();
                let wrench = [fx, fy, fz, torque.x, torque.y, torque.z].map(|value| value as f32);
                teach(frame.gel_from_indenter, frame.floor_kpa.clone(), wrench);
            }
            // What only hovers is not felt.
            let Some(touch) = lesson.touch() else {
                continue;
            };
            for (most_mm, spread) in HOVER_MM.into_iter().zip(SPREAD) {
                let gap_mm = most_mm * (number as f64 * spread).fract();
                let hovering = Pose {
                    position_mm: touch.position_mm + gap_mm * DVec3::Z,
                    ..touch
                };
                teach(hovering, vec![0.0; places_mm.len()], [0.0; 6]);
            }
        }
        let on_grid = places_mm.iter().enumerate().filter_map(|(number, at)| {
            let grid = layout.grid_at(*at)?;
            Some(TaughtPlace {
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
