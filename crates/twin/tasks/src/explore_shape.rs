//! ExploreShape: classify which of five shapes is pressed.
//!
//! A shape lies at an unknown position and rotation. In each step the robot gives the probability
//! of each shape and presses once more, at a location and depth of its choice. The last step has no
//! press. The reward is the logarithm of the probability of the right shape, relative to that of a
//! uniform guess.

use std::f64::consts::PI;

use glam::{DQuat, DVec2, DVec3};
use rand::Rng;
use twintac_fast::{Body, FastGel, Touch};
use twintac_random::RandomStream;
use twintac_shape::{Pose, Shape, ShapeError, Surfaces};

use crate::outline::outline_mm;
use crate::task::{Felt, Look, Outcome, READING_UNIT_KPA, Task, limited, part};

/// The possible shapes.
const N_SHAPES: usize = 5;
const NAMES: [&str; N_SHAPES] = ["ball", "cube", "ring", "triangle", "cross"];

/// Presses of an episode.
const N_PRESSES: usize = 4;

/// Time from the start of a press to its reading, s, and a further time in which late frames
/// arrive, s.
const FRAMES_S: [f64; 2] = [0.5, 0.04];

/// Largest distance of a shape from the middle along x and y, mm, and largest distance that the
/// robot moves.
const HIDDEN_MM: DVec2 = DVec2::new(5.0, 3.0);
const REACH_MM: DVec2 = DVec2::new(12.0, 7.0);

/// Range of depths, mm.
const DEPTH_MM: [f64; 2] = [0.4, 2.4];

/// Sharpness of the probabilities: they are `softmax(5 a)` of the actions.
const SHARPNESS: f64 = 5.0;

/// Observed numbers of a press beside its readings: location and depth.
const N_WHERE: usize = 3;

/// The task.
pub(crate) struct ExploreShape {
    shapes: Vec<Shape>,
    bodies: Vec<Body>,
    height_mm: f64,
}

/// The hidden state of an environment.
#[derive(Clone, Debug)]
pub(crate) struct Episode {
    shape: u32,
    place_mm: DVec2,
    yaw_rad: f64,
    n_steps: usize,
    /// Location and depth of the last press, mm; the depth is negative in a step without a press.
    at_mm: DVec2,
    depth_mm: f64,
    places_mm: Vec<DVec2>,
    /// Probability of the right shape, and the most probable shape.
    right: f64,
    guess: usize,
    /// The observation. `[n_observed]`
    observed: Vec<f32>,
}

impl ExploreShape {
    pub(crate) fn on(gel: &FastGel) -> Result<Self, ShapeError> {
        let (height_mm, edge_radius_mm) = (10.0, 0.8);
        let shapes = vec![
            Shape::Sphere { radius_mm: 6.0 },
            Shape::Box {
                size_mm: [10.0; 3],
                edge_radius_mm,
            },
            Shape::Ring {
                outer_radius_mm: 7.0,
                inner_radius_mm: 4.0,
                height_mm,
                edge_radius_mm,
            },
            Shape::Triangle {
                side_mm: 14.0,
                height_mm,
                edge_radius_mm,
            },
            Shape::X {
                length_mm: 14.0,
                width_mm: 4.0,
                height_mm,
                edge_radius_mm,
            },
        ];
        let bodies = shapes.iter().map(|shape| Body::new(shape, &Surfaces::new()));
        Ok(Self {
            bodies: bodies.collect::<Result<_, _>>()?,
            shapes,
            height_mm: gel.height_mm_at(DVec2::ZERO),
        })
    }
}

/// The probability of each shape. `[N_SHAPES]`
fn said(actions: &[f32]) -> [f64; N_SHAPES] {
    let weight: [f64; N_SHAPES] = std::array::from_fn(|shape| (SHARPNESS * part(actions[shape])).exp());
    let all: f64 = weight.iter().sum();
    weight.map(|weight| weight / all)
}

impl Task for ExploreShape {
    type Episode = Episode;
    const N_ACTIONS: usize = N_WHERE + N_SHAPES;
    const FIGURES: &'static [&'static str] = &["shape", "is_right", "probability_of_right"];
    const FRAMES_S: &'static [f64] = &FRAMES_S;
    const RESTS: bool = true;

    fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    fn n_observed(&self, n_taxels: usize) -> usize {
        N_PRESSES * (n_taxels + N_WHERE) + N_PRESSES + 1
    }

    fn begin(&self, n_taxels: usize, random: &mut RandomStream) -> Episode {
        let mut within = |most: f64| random.random_range(-most..most);
        let place_mm = DVec2::new(within(HIDDEN_MM.x), within(HIDDEN_MM.y));
        let yaw_rad = within(PI);
        let mut observed = vec![0.0; self.n_observed(n_taxels)];
        observed[N_PRESSES * (n_taxels + N_WHERE)] = 1.0;
        Episode {
            shape: random.random_range(0..N_SHAPES as u32),
            place_mm,
            yaw_rad,
            n_steps: 0,
            at_mm: DVec2::ZERO,
            depth_mm: -1.0,
            places_mm: Vec::with_capacity(N_PRESSES),
            right: 1.0 / N_SHAPES as f64,
            guess: 0,
            observed,
        }
    }

    fn act(&self, episode: &mut Episode, actions: &[f32]) {
        let (place, scores) = actions.split_at(N_WHERE);
        let said = said(scores);
        episode.right = said[episode.shape as usize];
        episode.guess = (1..N_SHAPES).fold(
            0,
            |best, shape| if said[shape] > said[best] { shape } else { best },
        );
        episode.depth_mm = -1.0;
        if episode.n_steps < N_PRESSES {
            episode.at_mm = REACH_MM * DVec2::new(part(place[0]), part(place[1]));
            let depth = 0.5 + 0.5 * part(place[2]);
            episode.depth_mm = DEPTH_MM[0] + depth * (DEPTH_MM[1] - DEPTH_MM[0]);
            episode.places_mm.push(episode.at_mm);
        }
    }

    fn touch(&self, episode: &Episode) -> Touch {
        let place_mm = episode.place_mm - episode.at_mm;
        Touch {
            body: episode.shape,
            gel_from_body: Pose {
                position_mm: place_mm.extend(self.height_mm - episode.depth_mm),
                rotation: DQuat::from_axis_angle(DVec3::Z, episode.yaw_rad),
            },
        }
    }

    fn feel(&self, episode: &mut Episode, felt: &Felt<'_>) -> Outcome {
        let n_taxels = felt.readings_kpa.len();
        let press = episode.n_steps;
        if press < N_PRESSES {
            let own = &mut episode.observed[press * (n_taxels + N_WHERE)..][..n_taxels + N_WHERE];
            for (observed, reading_kpa) in own.iter_mut().zip(felt.readings_kpa) {
                *observed = limited(reading_kpa / READING_UNIT_KPA);
            }
            let [shallow_mm, deep_mm] = DEPTH_MM;
            let depth = 2.0 * (episode.depth_mm - shallow_mm) / (deep_mm - shallow_mm) - 1.0;
            let place = episode.at_mm / REACH_MM;
            own[n_taxels..].copy_from_slice(&[place.x as f32, place.y as f32, depth as f32]);
        }
        episode.n_steps = (episode.n_steps + 1).min(N_PRESSES + 1);
        let number = &mut episode.observed[N_PRESSES * (n_taxels + N_WHERE)..];
        number.fill(0.0);
        number[episode.n_steps.min(N_PRESSES)] = 1.0;
        Outcome {
            reward: (episode.right * N_SHAPES as f64).ln(),
            terminated: episode.n_steps > N_PRESSES,
            truncated: false,
        }
    }

    fn observe(&self, episode: &Episode, _: &Felt<'_>, observed: &mut [f32]) {
        observed.copy_from_slice(&episode.observed);
    }

    fn figures(&self, episode: &Episode, figures: &mut [f32]) {
        let is_right = episode.guess == episode.shape as usize;
        figures.copy_from_slice(&[
            episode.shape as f32,
            f32::from(u8::from(is_right)),
            episode.right as f32,
        ]);
    }

    fn look(&self, episode: &Episode) -> Look {
        let pose = self.touch(episode).gel_from_body;
        let in_gel = |at: &DVec2| *at - episode.at_mm;
        Look {
            outlines_mm: outline_mm(&self.shapes[episode.shape as usize], &pose),
            places_mm: episode.places_mm.iter().map(in_gel).collect(),
            lines: vec![
                format!(
                    "shape: {}, estimate: {}",
                    NAMES[episode.shape as usize], NAMES[episode.guess]
                ),
                format!("probability of the true shape: {:.0} %", 100.0 * episode.right),
                format!(
                    "press {} of {N_PRESSES}, {:.1} mm deep",
                    episode.places_mm.len(),
                    episode.depth_mm.max(0.0)
                ),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knowing_nothing_is_worth_nothing_and_being_wrong_costs() {
        let of_right = |actions: [f32; N_SHAPES]| (said(&actions)[1] * N_SHAPES as f64).ln();
        assert!(of_right([0.3; N_SHAPES]).abs() < 1e-12);
        assert!(of_right([-1.0, 1.0, -1.0, -1.0, -1.0]) > 1.6);
        assert!(of_right([1.0, -1.0, -1.0, -1.0, -1.0]) < -8.0);
    }
}
