//! FollowEdge: slide along the edge of an object by touch alone.
//!
//! An object with a flat face and a vertical side lies still at an unknown position; its size and
//! rotation are unknown too. The robot moves the sensor over it. It is to move the gel's middle
//! along the edge of the face as far as possible, in a wanted sense and with a moderate force.

use std::f64::consts::PI;

use glam::{DQuat, DVec2, DVec3};
use rand::Rng;
use twintac_fast::{Body, FastGel, Touch};
use twintac_random::RandomStream;
use twintac_shape::{Pose, Shape, ShapeError, Surfaces};

use crate::edge::{Edge, Nearest};
use crate::outline::outline_mm;
use crate::task::{Felt, Look, Outcome, RATE_HZ, Task, limited, part};

/// Time of a step, s: one frame of the sensor.
const STEP_S: f64 = 1.0 / RATE_HZ;

/// Steps of an episode: six seconds.
const N_STEPS: usize = 330;

/// Largest speeds of the robot, mm/s: along the surface, and down.
const SPEED_MM_S: f64 = 20.0;
const DOWN_MM_S: f64 = 5.0;

/// Height above the face at the start, largest distance from the edge at the start, and range of
/// depths, mm.
const ABOVE_MM: [f64; 2] = [0.2, 0.8];
const BESIDE_MM: f64 = 2.0;
const DEPTH_MM: [f64; 2] = [-1.0, 3.0];

/// Distance from the edge at which progress no longer counts, and at which the edge counts as lost,
/// mm.
const WIDE_MM: f64 = 3.0;
const LOST_MM: f64 = 8.0;

/// Range of forces at which progress counts, N, and force at which the episode ends, N.
const FORCE_N: [f64; 2] = [0.3, 6.0];
const LIMIT_N: f64 = 15.0;

/// Cost of each newton above that range, and cost of losing the edge or of exceeding the largest
/// force, mm of progress.
const COST_MM_PER_N: f64 = 0.1;
const LOSS_MM: f64 = 5.0;

/// Largest progress along the edge for each millimetre of the sensor's own motion: slightly more
/// than 1, because on the inside of a curve the edge passes faster.
const MOST_OF_WAY: f64 = 1.5;

/// Units of observations, mm.
const PLACE_UNIT_MM: f64 = 10.0;
const DEPTH_UNIT_MM: f64 = 2.0;

/// The task.
pub(crate) struct FollowEdge {
    shapes: Vec<Shape>,
    bodies: Vec<Body>,
    /// Edge of each shape, in its own frame.
    edges: Vec<Edge>,
    height_mm: f64,
}

/// The hidden state of an environment.
#[derive(Clone, Debug)]
pub(crate) struct Episode {
    body: u32,
    /// Position of the object and of the sensor's middle in the robot's frame, mm; its origin is
    /// where the sensor begins.
    object_mm: DVec2,
    yaw_rad: f64,
    at_mm: DVec2,
    moved_mm: f64,
    start_mm: f64,
    depth_mm: f64,
    /// Velocity of the robot, as a fraction of the largest.
    velocity: DVec3,
    /// 1 counterclockwise, -1 clockwise, as seen from the gel.
    sense: f64,
    nearest: Nearest,
    force_n: f64,
    followed_mm: f64,
    n_steps: usize,
}

impl FollowEdge {
    pub(crate) fn on(gel: &FastGel) -> Result<Self, ShapeError> {
        let (height_mm, edge_radius_mm) = (10.0, 0.8);
        let discs = [8.0, 9.5, 11.0].map(|radius_mm| Shape::Cylinder {
            radius_mm,
            height_mm,
            edge_radius_mm,
        });
        let boxes = [13.0, 15.0].map(|side_mm| Shape::Box {
            size_mm: [side_mm, side_mm, height_mm],
            edge_radius_mm,
        });
        let triangles = [20.0, 25.0].map(|side_mm| Shape::Triangle {
            side_mm,
            height_mm,
            edge_radius_mm,
        });
        let shapes: Vec<Shape> = discs.into_iter().chain(boxes).chain(triangles).collect();
        let bodies = shapes.iter().map(|shape| Body::new(shape, &Surfaces::new()));
        let edges = shapes.iter().map(|shape| {
            let outlines = outline_mm(shape, &Pose::IDENTITY);
            Edge::of(outlines.into_iter().next().unwrap_or_default())
        });
        Ok(Self {
            bodies: bodies.collect::<Result<_, _>>()?,
            edges: edges.collect(),
            shapes,
            height_mm: gel.height_mm_at(DVec2::ZERO),
        })
    }

    fn nearest(&self, episode: &Episode) -> Nearest {
        let in_body = DVec2::from_angle(-episode.yaw_rad).rotate(episode.at_mm - episode.object_mm);
        self.edges[episode.body as usize].nearest(in_body)
    }

    /// Progress of the sensor along the edge since the nearest point `before`, mm, in the wanted
    /// sense.
    fn way_mm(&self, episode: &Episode, before: Nearest) -> f64 {
        let length_mm = self.edges[episode.body as usize].length_mm();
        let ahead_mm = episode.nearest.along_mm - before.along_mm;
        let ahead_mm = ahead_mm - length_mm * (ahead_mm / length_mm).round();
        let most_mm = MOST_OF_WAY * episode.moved_mm;
        episode.sense * ahead_mm.clamp(-most_mm, most_mm)
    }
}

impl Task for FollowEdge {
    type Episode = Episode;
    const N_ACTIONS: usize = 3;
    const FIGURES: &'static [&'static str] = &["followed_mm", "beside_mm", "force_n", "depth_mm"];
    const FRAMES_S: &'static [f64] = &[STEP_S];
    const RESTS: bool = false;

    fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    fn n_observed(&self, n_taxels: usize) -> usize {
        2 * n_taxels + 7
    }

    fn begin(&self, _: usize, random: &mut RandomStream) -> Episode {
        let body = random.random_range(0..self.bodies.len());
        let yaw_rad = random.random_range(-PI..PI);
        let (edge_mm, outward) = self.edges[body].at(random.random());
        let start_mm = edge_mm + random.random_range(-BESIDE_MM..BESIDE_MM) * outward;
        let above_mm = random.random_range(ABOVE_MM[0]..ABOVE_MM[1]);
        let mut episode = Episode {
            body: body as u32,
            object_mm: -DVec2::from_angle(yaw_rad).rotate(start_mm),
            yaw_rad,
            at_mm: DVec2::ZERO,
            moved_mm: 0.0,
            start_mm: -above_mm,
            depth_mm: -above_mm,
            velocity: DVec3::ZERO,
            sense: if random.random_bool(0.5) { 1.0 } else { -1.0 },
            nearest: Nearest::default(),
            force_n: 0.0,
            followed_mm: 0.0,
            n_steps: 0,
        };
        episode.nearest = self.nearest(&episode);
        episode
    }

    fn act(&self, episode: &mut Episode, actions: &[f32]) {
        let along = DVec2::new(part(actions[0]), part(actions[1])).clamp_length_max(1.0);
        episode.velocity = along.extend(part(actions[2]));
        let by_mm = SPEED_MM_S * STEP_S * along;
        episode.at_mm += by_mm;
        episode.moved_mm = by_mm.length();
        let depth_mm = episode.depth_mm + DOWN_MM_S * STEP_S * episode.velocity.z;
        episode.depth_mm = depth_mm.clamp(DEPTH_MM[0], DEPTH_MM[1]);
    }

    fn touch(&self, episode: &Episode) -> Touch {
        let place_mm = episode.object_mm - episode.at_mm;
        Touch {
            body: episode.body,
            gel_from_body: Pose {
                position_mm: place_mm.extend(self.height_mm - episode.depth_mm),
                rotation: DQuat::from_axis_angle(DVec3::Z, episode.yaw_rad),
            },
        }
    }

    fn feel(&self, episode: &mut Episode, felt: &Felt<'_>) -> Outcome {
        let before = episode.nearest;
        episode.nearest = self.nearest(episode);
        episode.force_n = felt.force_n;
        episode.n_steps += 1;
        let [least_n, most_n] = FORCE_N;
        let aside = episode.nearest.beside_mm / WIDE_MM;
        let counts = felt.force_n >= least_n && felt.force_n <= most_n;
        let share = if counts {
            (1.0 - aside * aside).max(0.0)
        } else {
            0.0
        };
        let followed_mm = share * self.way_mm(episode, before);
        episode.followed_mm += followed_mm;
        let terminated = felt.force_n > LIMIT_N || episode.nearest.beside_mm.abs() > LOST_MM;
        let cost_mm = COST_MM_PER_N * (felt.force_n - most_n).max(0.0);
        Outcome {
            reward: followed_mm - cost_mm - if terminated { LOSS_MM } else { 0.0 },
            terminated,
            truncated: episode.n_steps >= N_STEPS && !terminated,
        }
    }

    fn observe(&self, episode: &Episode, felt: &Felt<'_>, observed: &mut [f32]) {
        let (readings, rest) = observed.split_at_mut(2 * felt.readings_kpa.len());
        felt.observe(readings);
        let known = [
            episode.at_mm.x / PLACE_UNIT_MM,
            episode.at_mm.y / PLACE_UNIT_MM,
            (episode.depth_mm - episode.start_mm) / DEPTH_UNIT_MM,
            episode.velocity.x,
            episode.velocity.y,
            episode.velocity.z,
            episode.sense,
        ];
        for (observed, known) in rest.iter_mut().zip(known) {
            *observed = limited(known as f32);
        }
    }

    fn figures(&self, episode: &Episode, figures: &mut [f32]) {
        let told = [
            episode.followed_mm,
            episode.nearest.beside_mm,
            episode.force_n,
            episode.depth_mm,
        ];
        for (figure, told) in figures.iter_mut().zip(told) {
            *figure = told as f32;
        }
    }

    fn look(&self, episode: &Episode) -> Look {
        let pose = self.touch(episode).gel_from_body;
        let sense = if episode.sense > 0.0 {
            "counterclockwise"
        } else {
            "clockwise"
        };
        Look {
            outlines_mm: outline_mm(&self.shapes[episode.body as usize], &pose),
            places_mm: vec![DVec2::ZERO],
            lines: vec![
                format!("{:.1} mm followed {sense}", episode.followed_mm),
                format!("{:.1} mm beside the edge", episode.nearest.beside_mm),
                format!("{:.2} mm deep, {:.2} N", episode.depth_mm, episode.force_n),
            ],
        }
    }
}

#[cfg(test)]
mod tests;
